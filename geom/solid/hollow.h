// Shells of solids as meshes: walls that remain inside of the faces, or stand outside of them.

#ifndef CAG_GEOM_SOLID_HOLLOW_H
#define CAG_GEOM_SOLID_HOLLOW_H

#include "geom/solid/face_mesh.h"

// The points of the solid that are at most a distance from its faces, or (outside) the points
// outside of it that are: by offsets of the mesh (convolve.h).
//
//   thickness  mm, positive
//   open       n faces of a solid of the kind EXACT that have no wall: the cavity reaches them.
//              NULL for n = 0, with a solid of any kind
//   tolerance  mm, positive: the distance of the result from the shell
//
// The result has the kind MESH. Fails with "no-boundary" if no cavity remains, or if walls outside
// have open faces, because their rims are not defined.
CagStatus cag_solid_hollow(const CagSolid *s, double thickness, bool outside,
                           const CagSolidFace *open, size_t n, double tolerance, CagSolid **out,
                           CagError *err);

#endif
