// Vertex normals of meshes whose parts lack them.

#ifndef CAG_GEOM_MESH_SMOOTH_H
#define CAG_GEOM_MESH_SMOOTH_H

#include "geom/mesh/mesh.h"

// A copy with normals that are continuous across edges at which triangles turn by less than an angle.
// Where a triangle has other normals than its own one, they come from an exact surface, and its
// neighbors take them over. Elsewhere a normal is the mean of those of flat faces, weighted by their
// angles and the squares of their areas, so that large flat faces keep theirs. Parameters are left out.
//
//   crease  radians
CagStatus cag_mesh_smooth(const CagMesh *m, double crease, CagMesh **out, CagError *err);

#endif
