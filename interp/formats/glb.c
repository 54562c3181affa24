// Binary glTF 2.0: a glTF document and its data as two chunks of one file.

#include "interp/formats/gltf.h"

enum { GLB_HEADER = 12, CHUNK_HEADER = 8 };

static CagStatus write_file(const CagGltfPlan *p, const CagGltfText *json, CagAtomicFile *file,
                            CagError *err) {
  const uint32_t magic = 0x46546c67, version = 2, json_chunk = 0x4e4f534a,
                 binary_chunk = 0x004e4942;
  uint64_t data = p->data_bytes;
  uint64_t total = GLB_HEADER + CHUNK_HEADER + json->length + (data ? CHUNK_HEADER + data : 0);
  if (total > UINT32_MAX)
    return cag_fail(
        err, CAG_E_LIMIT, CAG_ERR_file_too_large, "", -1,
        "a GLB file can have at most 4 GB, but the scene needs %.1f GB; use a larger tolerance or PLY",
        (double)total / 1e9);
  const uint32_t header[] = {magic, version, (uint32_t)total, (uint32_t)json->length, json_chunk};
  const uint32_t data_header[] = {(uint32_t)data, binary_chunk};
  cag_atomic_file_expect(file, total);
  cag_mesh_write_words(file, header, 5);
  cag_atomic_file_write(file, json->at, json->length);
  if (data > 0) cag_mesh_write_words(file, data_header, 2);
  cag_gltf_write_data(p, file);
  return CAG_OK;
}

CagStatus cag_export_glb(const CagMeshPart *parts, size_t n, CagAtomicFile *file, CagError *err) {
  CagGltfPlan plan;
  CagGltfText json;
  CagStatus status = cag_gltf_plan(parts, n, &plan, err);
  if (status) return status;
  status = cag_gltf_text(&plan, NULL, &json, err);
  if (!status) {
    status = write_file(&plan, &json, file, err);
    cag_gltf_text_free(&json);
  }
  cag_gltf_plan_free(&plan);
  return status;
}
