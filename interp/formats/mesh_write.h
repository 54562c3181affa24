// What the mesh formats share: numbers as text and as bytes, vertices in single precision.

#ifndef CAG_INTERP_FORMATS_MESH_WRITE_H
#define CAG_INTERP_FORMATS_MESH_WRITE_H

#include <string.h>

#include "base/hash.h"
#include "interp/formats/mesh_formats.h"

// Writes x with 9 significant digits (a float reads back the same), without trailing zeros, at most
// 24 bytes; gives the end. Plain decimals between 1e-5 and 1e9.
char *cag_mesh_write_number(char *at, double x);
// Decimal digits of n, at most 20 bytes; gives the end.
char *cag_mesh_write_index(char *at, uint64_t n);
// A name for formats of words: white space and control characters become '_'. Up to `room` bytes
// without a zero; gives the end.
char *cag_mesh_write_word(char *at, const char *name, size_t room);

// Files are little-endian whatever the machine.
static inline char *cag_mesh_put_u32(char *at, uint32_t x) {
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
  memcpy(at, &x, 4);
#else
  for (int k = 0; k < 4; k++) at[k] = (char)(x >> 8 * k & 0xff);
#endif
  return at + 4;
}
static inline char *cag_mesh_put_float(char *at, float x) {
  uint32_t bits;
  memcpy(&bits, &x, 4);
  return cag_mesh_put_u32(at, bits);
}

// Appends words of 4 bytes, whole numbers or floats.
void cag_mesh_write_words(CagAtomicFile *file, const void *words, size_t n);

// Positions in single precision, 3 a vertex, from malloc, and their bounds (either may be NULL).
// Fails with "mesh-empty" where a coordinate is beyond single precision.
CagStatus cag_mesh_floats(const CagMeshPart *part, float **out, float least[3], float most[3],
                          CagError *err);
// Do two corners of the triangle lie on one point in single precision?
static inline bool cag_mesh_shrinks(const float *p, const uint32_t *k) {
  const float *a = p + 3 * (size_t)k[0], *b = p + 3 * (size_t)k[1], *c = p + 3 * (size_t)k[2];
  return (a[0] == b[0] && a[1] == b[1] && a[2] == b[2]) ||
         (b[0] == c[0] && b[1] == c[1] && b[2] == c[2]) ||
         (c[0] == a[0] && c[1] == a[1] && c[2] == a[2]);
}
size_t cag_mesh_kept_triangles(const CagMesh *m, const float *positions);

// The materials in use, each once, numbered in the order in which they were added. A list of zeros
// is empty.
typedef struct CagMaterialList {
  const CagMaterial **items;
  size_t count, capacity;
  CagHashIndex index; // by address
} CagMaterialList;

// Finds a material or adds it. Returns false if memory ran out.
bool cag_material_list_add(CagMaterialList *l, const CagMaterial *material, size_t *number);
void cag_material_list_free(CagMaterialList *l);

#endif
