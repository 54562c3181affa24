// Minkowski sums of meshes with convex bodies, and offsets of meshes by balls.

#ifndef CAG_GEOM_SOLID_CONVOLVE_H
#define CAG_GEOM_SOLID_CONVOLVE_H

#include "geom/mesh/mesh.h"

// All sums of a point of the solid that the mesh bounds and a point of a convex body, which is the
// hull of its vertices (a closed mesh).
//
//   interrupt  nonzero stops with CAG_E_CALLBACK; may be NULL
//
// Fails like cag_mesh_boolean.
CagStatus cag_mesh_minkowski(const CagMesh *m, const CagMesh *body, const volatile int *interrupt,
                             CagMesh **out, CagError *err);
// Whether a closed mesh bounds a convex body, to rounding.
CagStatus cag_mesh_is_convex(const CagMesh *m, bool *out, CagError *err);

// The points at most d > 0 from the solid, or (d < 0) the points of the solid at least -d from the
// outside. The mesh has no triangles if nothing is left. The ball is replaced by a polyhedron with
// its vertices on the sphere, which is within the tolerance; the normals of the largest flat faces
// are among them, so these faces move by exactly d.
//
// Fails with "ball-too-fine" if the tolerance needs more vertices than are practical.
CagStatus cag_mesh_offset(const CagMesh *m, double d, double tolerance,
                          const volatile int *interrupt, CagMesh **out, CagError *err);

#endif
