// Which parts of an output are another part moved, so that formats with instances write one mesh.

#ifndef CAG_INTERP_FORMATS_MESH_COPIES_H
#define CAG_INTERP_FORMATS_MESH_COPIES_H

#include "interp/formats/mesh_formats.h"

// Part i is the mesh of part `original` (<= i, itself an original) turned and carried by `place`.
typedef struct CagMeshCopy {
  size_t original;
  CagTransform place; // rigid, no mirror; exactly the identity of an original
} CagMeshCopy;

// However the copies were made: the meshes are compared. Copies agree in parameters and, moved, in
// positions and normals, within what single precision does not show, and in their triangles but for
// the diagonals of quads, which rounding may choose. same_material: they agree in that as well.
// *out from malloc, an element a part.
CagStatus cag_mesh_find_copies(const CagMeshPart *parts, size_t n, bool same_material,
                               CagMeshCopy **out, CagError *err);

#endif
