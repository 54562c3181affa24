// Internals of the writers of mesh formats: numbers as text and as bytes, and vertices in single
// precision.

#ifndef CAG_INTERP_FORMATS_MESH_WRITE_H
#define CAG_INTERP_FORMATS_MESH_WRITE_H

#include <string.h>

#include "base/hash.h"
#include "interp/formats/mesh_formats.h"

// Writes x with 9 significant digits, which preserve a float, without trailing zeros, in at most 24
// bytes. Uses plain decimals between 1e-5 and 1e9. Returns the end.
char *cag_mesh_write_number(char *at, double x);
// Writes a name as a single word: white space and control characters become '_'. Writes up to
// `room` bytes, without a zero. Returns the end.
char *cag_mesh_write_word(char *at, const char *name, size_t room);

// Files are little-endian on every machine.
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

// Appends words of 4 bytes, integers or floats.
void cag_mesh_write_words(CagAtomicFile *file, const void *words, size_t n);

// Returns the positions in single precision, 3 numbers per vertex, allocated with malloc, and their
// bounds (either may be NULL). Fails with "mesh-empty" if a coordinate overflows.
CagStatus cag_mesh_floats(const CagMeshPart *part, float **out, float least[3], float most[3],
                          CagError *err);
// Tests whether two corners of the triangle coincide in single precision.
static inline bool cag_mesh_shrinks(const float *p, const uint32_t *k) {
  const float *a = p + 3 * (size_t)k[0], *b = p + 3 * (size_t)k[1], *c = p + 3 * (size_t)k[2];
  return (a[0] == b[0] && a[1] == b[1] && a[2] == b[2]) ||
         (b[0] == c[0] && b[1] == c[1] && b[2] == c[2]) ||
         (c[0] == a[0] && c[1] == a[1] && c[2] == a[2]);
}
size_t cag_mesh_kept_triangles(const CagMesh *m, const float *positions);

// The used materials, each once, numbered in the order of addition. A zeroed list is empty.
typedef struct CagMaterialList {
  const CagMaterial **items;
  size_t count, capacity;
  CagHashIndex index; // by address
} CagMaterialList;

// Finds a material or adds it. Returns false if memory ran out.
bool cag_material_list_add(CagMaterialList *l, const CagMaterial *material, size_t *number);
void cag_material_list_free(CagMaterialList *l);

#endif
