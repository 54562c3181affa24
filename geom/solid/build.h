// What the makers of solids share; users of solids do not need it.

#ifndef CAG_GEOM_SOLID_BUILD_H
#define CAG_GEOM_SOLID_BUILD_H

#include "geom/solid/solid.h"

// A solid with room for `faces` faces and none yet.
CagStatus cag_solid_block(CagSolidKind kind, size_t faces, CagSolid **out, CagError *err);
// Takes the reference to the face.
void cag_solid_add(CagSolid *s, CagSurface *face);
// Takes the reference to the face, whose other side faces outward where `flip`.
CagStatus cag_solid_add_turned(CagSolid *s, CagSurface *face, bool flip, CagError *err);
// Adds the region in its frame as a flat face.
CagStatus cag_solid_add_cap(CagSolid *s, const CagRegion *r, const CagTransform *frame, bool flip,
                            CagError *err);
// Adds an edge; the sides as in CagFaceEdge.
CagStatus cag_solid_add_edge(CagSolid *s, size_t face_a, int side_a, size_t face_b, int side_b,
                             bool reversed, CagError *err);
// Adds all edges that two faces run along with the same fractions of their parameters, either way.
CagStatus cag_solid_match_edges(CagSolid *s, CagError *err);

// Number of boundary curves of a face: 4 sides (closed and collapsed ones count but are no edges),
// or the loops of a planar one, whose sides are numbered from 4.
bool cag_solid_side_is_edge(const CagSurface *face, int side);
int cag_solid_first_side(const CagSurface *face);
int cag_solid_side_end(const CagSurface *face);
// Point at a fraction of the side's parameter range.
CagStatus cag_solid_side_point(const CagSurface *face, int side, double fraction, CagVec3 *out,
                               CagError *err);

// Lets go of what a solid without faces is made of (csg.c); NULL is allowed.
void cag_solid_core_release(CagSolidCore *core);

// Fails with "size-not-positive" and, where powers of it would leave the range of numbers,
// "size-out-of-range".
CagStatus cag_solid_check_size(double size, const char *name, long index, CagError *err);
// A disk of the XY plane about the origin.
CagStatus cag_solid_disk(double radius, CagRegion **out, CagError *err);

// Tells which faces of a closed shell to turn so that its parts look outward, and inward where they
// are within an odd number of others. part[f], below `parts`: the part of face f; the faces of one
// agree.
CagStatus cag_solid_nest(CagSurface *const *faces, size_t n, const size_t *part, size_t parts,
                         bool *turn, CagError *err);

#endif
