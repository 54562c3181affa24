// A glTF 2.0 document as .gltf and .glb share it: a plan of meshes and nodes, the JSON, the data.

#ifndef CAG_INTERP_FORMATS_GLTF_H
#define CAG_INTERP_FORMATS_GLTF_H

#include "interp/formats/mesh_copies.h"
#include "interp/formats/mesh_write.h"

// The JSON as it grows. After memory ran out nothing is added.
typedef struct CagGltfText {
  char *at;
  size_t length, capacity;
  size_t data_at; // where the uri of the data can stand
  bool failed;
} CagGltfText;

typedef struct CagGltfPart {
  bool shown; // false: single precision leaves nothing of it
  size_t mesh, mesh_of,
      material; // numbers in the file; mesh_of: the part that its mesh is told for
  // Of originals:
  float *positions;
  float least[3], most[3];
  size_t triangles, first_view;
} CagGltfPart;

typedef struct CagGltfPlan {
  const CagMeshPart *meshes;
  size_t count;
  CagMeshCopy *copies;
  CagGltfPart *parts;
  CagMaterialList materials;
  CagHashIndex told; // parts that a mesh is told for, by original and material
  uint64_t data_bytes;
} CagGltfPlan;

CagStatus cag_gltf_plan(const CagMeshPart *parts, size_t n, CagGltfPlan *p, CagError *err);
void cag_gltf_plan_free(CagGltfPlan *p);
// uri: of the data; NULL: none, as in a GLB. The length is a multiple of 4.
CagStatus cag_gltf_text(const CagGltfPlan *p, const char *uri, CagGltfText *t, CagError *err);
void cag_gltf_text_free(CagGltfText *t);
void cag_gltf_write_data(const CagGltfPlan *p, CagAtomicFile *file);

#endif
