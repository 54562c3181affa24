// Clips curves, surfaces, and open meshes to a solid.

#ifndef CAG_GEOM_SOLID_CLIP_H
#define CAG_GEOM_SOLID_CLIP_H

#include "geom/solid/solid.h"
#include "geom/tessellate/tessellate.h"

// The pieces of the curve within the solid, boundary included, in order. Their ends are accurate to
// rounding if the solid consists of exact primitives, else to its mesh. Pieces outside that are
// shorter than 1/256 of a stretch between breaks may be missed. *out is malloc'd and may be empty.
CagStatus cag_curve_clip(const CagCurve *c, const CagSolid *by, const volatile int *interrupt,
                         CagCurve ***out, size_t *n, CagError *err);
// The part of the surface within the solid as a mesh, to the tolerance; its cut edges lie on both.
// The mesh has no triangles if the part is empty.
CagStatus cag_surface_clip(const CagSurface *s, const CagSolid *by, const CagTessellation *how,
                           CagMesh **out, CagError *err);
// The same for the triangles of a mesh.
CagStatus cag_mesh_clip(const CagMesh *m, const CagSolid *by, const CagTessellation *how,
                        CagMesh **out, CagError *err);

#endif
