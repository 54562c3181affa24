// The mesh of a body below a field of heights.

#ifndef CAG_GEOM_MESH_HEIGHT_FIELD_H
#define CAG_GEOM_MESH_HEIGHT_FIELD_H

#include "geom/mesh/mesh.h"

// Heights on a grid of `columns` x `rows` nodes, at least 2 each, which spans [0, size.x] x
// [0, size.y]. The first row is at y = size.y, and the first column at x = 0. The values are at
// least 0; value 1 is at z = size.z.
typedef struct CagHeightField {
  const double *values;
  size_t columns, rows;
  CagVec3 size;
  double base; // thickness below z = 0, at least 0
} CagHeightField;

// The closed mesh of the body between z = -base and the heights, which are linear within triangles.
// Without a base, the body is divided where its height is 0, so that each edge has two triangles.
// The mesh is empty if all heights are.
CagStatus cag_mesh_height_field(const CagHeightField *f, CagMesh **out, CagError *err);

#endif
