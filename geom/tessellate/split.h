// Subdivides triangles until no edge is longer than a limit.

#ifndef CAG_GEOM_TESSELLATE_SPLIT_H
#define CAG_GEOM_TESSELLATE_SPLIT_H

#include "geom/mesh/mesh.h"

// Bisects long edges repeatedly. New vertices are midpoints, so the mesh keeps its shape, and a
// closed mesh stays closed. Normals and parameters of new vertices are the means of their edge's.
//
//   longest         > 0
//   max_triangles   exceeding it fails with CAG_E_LIMIT "triangle-limit"
CagStatus cag_mesh_split_edges(const CagMesh *m, double longest, size_t max_triangles,
                               CagMesh **out, CagError *err);

#endif
