// A parsed glTF document: its JSON, its buffers, and typed views of them.

#ifndef CAG_INTERP_FORMATS_GLTF_DOCUMENT_H
#define CAG_INTERP_FORMATS_GLTF_DOCUMENT_H

#include <cjson/cJSON.h>

#include "interp/formats/mesh_draft.h"

// An array of the document, with access by index.
typedef struct CagGltfArray {
  const cJSON **items;
  size_t count;
} CagGltfArray;

typedef struct CagGltfBuffer {
  char *bytes;
  size_t size;
  bool owned;
} CagGltfBuffer;

typedef struct CagGltf {
  CagMeshDraft *draft;
  cJSON *json;
  CagGltfArray nodes, meshes, accessors, views;
  CagGltfBuffer *buffers;
  size_t buffer_count;
} CagGltf;

// Elements of `width` numbers of one component type, some of which may be replaced (sparse).
typedef struct CagGltfAccessor {
  const unsigned char *data; // NULL: zeros
  size_t count, stride;
  int component, width;
  bool normalized;
  size_t sparse_count;
  const unsigned char *sparse_index, *sparse_data;
  int sparse_component;
} CagGltfAccessor;

// Reads JSON and buffers. Call cag_gltf_close even after a failure.
CagStatus cag_gltf_open(CagGltf *g, CagMeshDraft *d, CagError *err);
void cag_gltf_close(CagGltf *g);
// Checks accessor `number` against its buffers. width: the required count of numbers in an element.
CagStatus cag_gltf_accessor(const CagGltf *g, size_t number, int width, CagGltfAccessor *out,
                            CagError *err);
// Returns number k of element i, without sparse replacements.
double cag_gltf_number(const CagGltfAccessor *a, size_t i, int k);
uint32_t cag_gltf_index(const unsigned char *data, int component, size_t i);
// Returns number k of the replacement of sparse element i.
double cag_gltf_sparse_number(const CagGltfAccessor *a, size_t i, int k);

// Reads a nonnegative integer under a key, or `fallback` if the key is missing. Returns false for
// another value.
bool cag_gltf_whole(const cJSON *object, const char *key, size_t fallback, size_t *out);
CagStatus cag_gltf_fail(const CagGltf *g, CagError *err, CagErrorId id, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
#define cag_gltf_fail(...) cag_never_ok((cag_gltf_fail)(__VA_ARGS__))

#endif
