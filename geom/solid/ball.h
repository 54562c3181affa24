// Polyhedral balls for offsets.

#ifndef CAG_GEOM_SOLID_BALL_H
#define CAG_GEOM_SOLID_BALL_H

#include "geom/mesh/mesh.h"

// A convex polyhedron about the origin with its vertices on the sphere of this radius and its faces
// within the tolerance of it. The normals of the largest flat faces of the mesh, which has two
// triangles at each edge, point to vertices, and points along the arcs between those of neighboring
// faces are vertices. Fails with "ball-too-fine".
CagStatus cag_ball_for(const CagMesh *m, double radius, double tolerance, CagMesh **out,
                       CagError *err);

#endif
