// Shared by the constructors of solids; not for users of solids.

#ifndef CAG_GEOM_SOLID_BUILD_H
#define CAG_GEOM_SOLID_BUILD_H

#include "geom/solid/solid.h"

// A solid with room for `faces` faces, and no faces yet.
CagStatus cag_solid_block(CagSolidKind kind, size_t faces, CagSolid **out, CagError *err);
// Takes ownership of the reference to the face.
void cag_solid_add(CagSolid *s, CagSurface *face);
// Takes ownership of the reference to the face, and reverses its normal if `flip`.
CagStatus cag_solid_add_turned(CagSolid *s, CagSurface *face, bool flip, CagError *err);
// Adds the region in its frame as a flat face.
CagStatus cag_solid_add_cap(CagSolid *s, const CagRegion *r, const CagTransform *frame, bool flip,
                            CagError *err);
// Adds an edge; sides are numbered as in CagFaceEdge.
CagStatus cag_solid_add_edge(CagSolid *s, size_t face_a, int side_a, size_t face_b, int side_b,
                             bool reversed, CagError *err);
// Adds all edges along which two faces coincide at equal fractions of their parameters, in either
// direction.
CagStatus cag_solid_match_edges(CagSolid *s, CagError *err);

// The boundary curves of a face: 4 sides (closed and collapsed ones are counted but are not edges),
// or the loops of a planar face, numbered from 4.
bool cag_solid_side_is_edge(const CagSurface *face, int side);
int cag_solid_first_side(const CagSurface *face);
int cag_solid_side_end(const CagSurface *face);
// Point at a fraction of the side's parameter range.
CagStatus cag_solid_side_point(const CagSurface *face, int side, double fraction, CagVec3 *out,
                               CagError *err);

// Releases the core of a solid without faces (csg.c); NULL is allowed.
void cag_solid_core_release(CagSolidCore *core);

// Fails with "size-not-positive", and with "size-out-of-range" if powers of the size would overflow
// or underflow.
CagStatus cag_solid_check_size(double size, const char *name, long index, CagError *err);
// A disk in the XY plane about the origin.
CagStatus cag_solid_disk(double radius, CagRegion **out, CagError *err);

// Determines which faces of a closed shell to reverse so that its parts face outward, or inward if
// they are nested in an odd number of others. part[f], below `parts`: the part of face f; the faces
// of a part must agree in orientation.
CagStatus cag_solid_nest(CagSurface *const *faces, size_t n, const size_t *part, size_t parts,
                         bool *turn, CagError *err);

#endif
