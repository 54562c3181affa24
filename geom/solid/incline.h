// Drafts of solids as meshes.

#ifndef CAG_GEOM_SOLID_INCLINE_H
#define CAG_GEOM_SOLID_INCLINE_H

#include "geom/solid/face_mesh.h"

// Inclines flat faces that are parallel to the pull by an angle, such that the solid becomes
// narrower along the pull. They keep their sections with the plane through `at` perpendicular to
// it. The points of their edges move along the other faces: exactly on flat ones, and on the
// triangles of curved ones.
//
//   s          a solid of the kind EXACT
//   angle      radians, between -pi/2 and pi/2
//   pull       unit
//   tolerance  mm, positive: of the mesh
//
// The result has the kind MESH. Fails with "no-boundary" if a face is not flat or not parallel to
// the pull, or if the moved faces would intersect others.
CagStatus cag_solid_incline(const CagSolid *s, const CagSolidFace *faces, size_t n, double angle,
                            CagVec3 at, CagVec3 pull, double tolerance, CagSolid **out,
                            CagError *err);

#endif
