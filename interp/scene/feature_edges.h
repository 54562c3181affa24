// The edges of a mesh that a drawing of it shows: its borders, and the edges at which it is creased.

#ifndef CAG_INTERP_SCENE_FEATURE_EDGES_H
#define CAG_INTERP_SCENE_FEATURE_EDGES_H

#include "geom/mesh/mesh.h"

// Finds the edges with one triangle only, and those between triangles whose shading or planes differ
// by more than about 20 degrees. A mesh without normals has creases where its triangles differ. Sets
// *out to pairs of vertices, malloc'd, and *n to the number of pairs.
CagStatus cag_feature_edges(const CagMesh *m, uint32_t **out, size_t *n, CagError *err);

#endif
