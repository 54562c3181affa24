// Boundaries of solids, found from their meshes: without the kernel, and for meshes.

#ifndef CAG_GEOM_SOLID_RECOGNIZED_H
#define CAG_GEOM_SOLID_RECOGNIZED_H

#include "geom/solid/solid.h"

// A solid of the kind EXACT, with one boundary that is found from the mesh of s. The carriers of its
// faces are those of the operands: planes, cylinders, cones, spheres, tori, and NURBS surfaces. The
// faces of meshes end at creases of more than 25 degrees; those with other carriers are left out,
// and so are their edges. Edges are curves between the carriers (recognized_curve.h). Corners, edges,
// and faces are sorted by location (recognized_order.h). The mesh belongs to the boundary, which is
// measured and meshed by it.
//
//   tolerance  mm, positive: of the mesh. Faces that are narrower are left out
//
// Fails with "no-boundary" if the solid is empty, and as cag_solid_tessellate.
CagStatus cag_solid_recognized(const CagSolid *s, double tolerance, CagSolid **out, CagError *err);

#endif
