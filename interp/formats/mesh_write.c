// Internals of the writers of mesh formats: numbers as text and as bytes, and vertices in single
// precision.

#include "interp/formats/mesh_write.h"

#include <float.h>
#include <stdio.h>

#include "base/array.h"
#include "base/decimal.h"
#include "base/memory.h"

enum { DIGITS = 9 };

// Returns the number of decimals of x < 10^9 for DIGITS significant digits.
static int decimals_of(double x) {
  static const double bound[] = {1e8, 1e7, 1e6, 1e5, 1e4, 1e3, 1e2, 1e1, 1, 1e-1, 1e-2, 1e-3, 1e-4};
  int k = 0;
  while (k < (int)(sizeof bound / sizeof *bound) && x < bound[k]) k++;
  return k;
}

// Writes the digits of a fraction with `decimals` digits, without trailing zeros, starting from the
// end.
static char *write_fraction(char *at, uint64_t fraction, int decimals) {
  while (decimals > 0 && fraction % 10 == 0) fraction /= 10, decimals--;
  for (char *to = at + decimals; to > at; fraction /= 10) *--to = (char)('0' + fraction % 10);
  return at + decimals;
}

char *cag_mesh_write_number(char *at, double x) {
  static const double power[] = {1,   1e1, 1e2, 1e3,  1e4,  1e5,  1e6,
                                 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13};
  static const uint64_t whole_power[] = {
      1,        10,        100,        1000,        10000,        100000,        1000000,
      10000000, 100000000, 1000000000, 10000000000, 100000000000, 1000000000000, 10000000000000};
  const double least_plain = 1e-5, most_plain = 999999999.4;
  double size = x < 0 ? -x : x;
  if (size == 0) {
    *at++ = '0';
    return at;
  }
  if (!(size >= least_plain && size < most_plain)) return at + snprintf(at, 24, "%.9g", x);
  int decimals = decimals_of(size);
  uint64_t scaled = (uint64_t)(size * power[decimals] + 0.5);
  uint64_t whole = scaled / whole_power[decimals], fraction = scaled % whole_power[decimals];
  if (x < 0) *at++ = '-';
  at = cag_decimal_index(at, whole);
  if (fraction == 0) return at;
  *at++ = '.';
  return write_fraction(at, fraction, decimals);
}

char *cag_mesh_write_word(char *at, const char *name, size_t room) {
  if (!*name && room > 0) *at++ = '_';
  for (; *name && room > 0; name++, room--) {
    unsigned char c = (unsigned char)*name;
    *at++ = c <= ' ' || c == 0x7f ? '_' : (char)c;
  }
  return at;
}

void cag_mesh_write_words(CagAtomicFile *file, const void *words, size_t n) {
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
  cag_atomic_file_write(file, words, 4 * n);
#else
  for (size_t k = 0; k < n; k++) {
    uint32_t word;
    memcpy(&word, (const char *)words + 4 * k, 4);
    char *at = cag_atomic_file_reserve(file, 4);
    cag_atomic_file_advance(file, cag_mesh_put_u32(at, word));
  }
#endif
}

static CagStatus fail_range(const CagMeshPart *part, CagError *err) {
  const CagMesh *m = part->mesh;
  for (size_t v = 0; v < m->vertex_count; v++) {
    CagVec3 p = m->positions[v];
    if (fabs(p.x) <= FLT_MAX && fabs(p.y) <= FLT_MAX && fabs(p.z) <= FLT_MAX) continue;
    return cag_fail(
        err, CAG_E_DEGENERATE, CAG_ERR_mesh_empty, "", (long)v,
        "`%s` has a vertex at [%g, %g, %g], too far away for the single precision of the format; use OBJ",
        part->name ? part->name : "part", p.x, p.y, p.z);
  }
  return CAG_OK;
}

// Numbers are processed as one row of 3 n, in steps of 12, so that the compiler can vectorize.
enum { LANES = 12 };

static void widen(const double *x, float least[LANES], float most[LANES], int n) {
  for (int k = 0; k < n; k++) {
    float f = (float)x[k];
    least[k] = f < least[k] ? f : least[k];
    most[k] = f > most[k] ? f : most[k];
  }
}

CagStatus cag_mesh_floats(const CagMeshPart *part, float **out, float least[3], float most[3],
                          CagError *err) {
  const CagMesh *m = part->mesh;
  size_t n = 3 * m->vertex_count, k = 0;
  const double *x = (const double *)m->positions;
  float low[LANES], high[LANES], *p = cag_malloc((n + 3) * sizeof *p);
  *out = NULL;
  if (!p) return cag_fail_memory(err);
  for (int j = 0; j < LANES; j++) low[j] = INFINITY, high[j] = -INFINITY;
  int good = 1;
  for (; k + LANES <= n; k += LANES) {
    // + 0: makes a negative zero positive.
    for (int j = 0; j < LANES; j++) p[k + (size_t)j] = (float)x[k + (size_t)j] + 0.0f;
    for (int j = 0; j < LANES; j++) good &= fabs(x[k + (size_t)j]) <= FLT_MAX;
    widen(x + k, low, high, LANES);
  }
  for (size_t j = k; j < n; j++) {
    p[j] = (float)x[j] + 0.0f;
    good &= fabs(x[j]) <= FLT_MAX;
  }
  if (n > k) widen(x + k, low, high, (int)(n - k));
  if (!good) {
    cag_free(p);
    return fail_range(part, err);
  }
  for (int j = 0; least && j < LANES; j++) {
    int axis = j % 3;
    least[axis] = j < 3 ? low[j] : fminf(least[axis], low[j]);
    most[axis] = j < 3 ? high[j] : fmaxf(most[axis], high[j]);
  }
  *out = p;
  return CAG_OK;
}

size_t cag_mesh_kept_triangles(const CagMesh *m, const float *positions) {
  size_t kept = 0;
  for (size_t t = 0; t < m->triangle_count; t++)
    kept += !cag_mesh_shrinks(positions, m->triangles + 3 * t);
  return kept;
}

bool cag_material_list_add(CagMaterialList *l, const CagMaterial *material, size_t *number) {
  const uint64_t hash = cag_hash_word(CAG_HASH_START, (uintptr_t)material);
  for (CagHashWalk w = cag_hash_walk(&l->index, hash); cag_hash_next(&w, number);)
    if (l->items[*number] == material) return true;
  if (!CAG_RESERVE(l->items, l->capacity, l->count + 1)) return false;
  if (!cag_hash_add(&l->index, hash, l->count)) return false;
  l->items[l->count] = material;
  *number = l->count++;
  return true;
}

void cag_material_list_free(CagMaterialList *l) {
  cag_free(l->items);
  cag_hash_free(&l->index);
  *l = (CagMaterialList){0};
}
