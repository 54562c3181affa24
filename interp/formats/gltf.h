// Internals of .gltf and .glb: a plan of meshes and nodes, the JSON, and the data of a glTF 2.0
// document.

#ifndef CAG_INTERP_FORMATS_GLTF_H
#define CAG_INTERP_FORMATS_GLTF_H

#include "interp/formats/mesh_copies.h"
#include "interp/formats/mesh_write.h"

// The growing JSON. Nothing is added after memory ran out.
typedef struct CagGltfText {
  char *at;
  size_t length, capacity;
  size_t data_at; // where the URI of the data can be inserted
  bool failed;
} CagGltfText;

typedef struct CagGltfPart {
  bool shown; // false: empty in single precision
  size_t mesh, mesh_of,
      material; // indices in the file; mesh_of: the part that contains its mesh
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
  CagHashIndex told; // parts that have a mesh, by original and material
  uint64_t data_bytes;
} CagGltfPlan;

CagStatus cag_gltf_plan(const CagMeshPart *parts, size_t n, CagGltfPlan *p, CagError *err);
void cag_gltf_plan_free(CagGltfPlan *p);
// uri: of the data; NULL: none, as in a GLB. The length is a multiple of 4.
CagStatus cag_gltf_text(const CagGltfPlan *p, const char *uri, CagGltfText *t, CagError *err);
void cag_gltf_text_free(CagGltfText *t);
void cag_gltf_write_data(const CagGltfPlan *p, CagAtomicFile *file);

#endif
