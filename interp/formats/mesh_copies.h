// Finds parts of an output that are congruent, so that formats with instances contain their mesh
// only once.

#ifndef CAG_INTERP_FORMATS_MESH_COPIES_H
#define CAG_INTERP_FORMATS_MESH_COPIES_H

#include "interp/formats/mesh_formats.h"

// Part i is the mesh of part `original` (<= i, itself an original), transformed by `place`.
typedef struct CagMeshCopy {
  size_t original;
  CagTransform place; // a rigid motion; exactly the identity for an original
} CagMeshCopy;

// Compares the meshes, regardless of how the copies were made. Copies agree in parameters and,
// after the transform, in positions and normals, up to single precision. Their triangles agree
// except for the diagonals of quads, which may depend on rounding. same_material: their materials
// must agree, too. *out is allocated with malloc and has an element for each part.
CagStatus cag_mesh_find_copies(const CagMeshPart *parts, size_t n, bool same_material,
                               CagMeshCopy **out, CagError *err);

#endif
