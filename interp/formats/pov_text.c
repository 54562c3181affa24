// Writes numbers, vectors, comments, and names in POV-Ray's language.

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "base/memory.h"
#include "interp/formats/pov_write.h"

void cag_pov_text(CagPovWriter *w, const char *text) {
  // Lines within another object are indented.
  for (const char *end; w->depth > 0 && (end = strchr(text, '\n')) != NULL; text = end + 1) {
    cag_atomic_file_write(w->file, text, (size_t)(end + 1 - text));
    for (int i = 0; i < w->depth; i++) cag_atomic_file_text(w->file, "  ");
  }
  cag_atomic_file_text(w->file, text);
}

void cag_pov_printf(CagPovWriter *w, const char *format, ...) {
  char text[1024]; // callers format names and short numbers
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  cag_pov_text(w, text);
}

void cag_pov_number(CagPovWriter *w, double x) {
  char text[32];
  if (!isfinite(x) && !w->failure.status)
    cag_fail(&w->failure, CAG_E_DEGENERATE, CAG_ERR_not_finite, "", -1,
             "%s has a number in the file that overflows or is undefined",
             w->item ? w->item->name : "the scene");
  cag_pov_text(w, cag_number_text(x == 0 ? 0 : x, text)); // no -0
}

static void list_of_numbers(CagPovWriter *w, const double *x, size_t n) {
  cag_pov_text(w, "<");
  for (size_t i = 0; i < n; i++) {
    if (i > 0) cag_pov_text(w, ", ");
    cag_pov_number(w, x[i]);
  }
  cag_pov_text(w, ">");
}

void cag_pov_vec(CagPovWriter *w, CagVec3 v) {
  list_of_numbers(w, (const double[]){v.x, v.y, v.z}, 3);
}

static void put_unit(CagPovWriter *w) {
  if (w->unit != 1) cag_pov_text(w, "unit*");
}

void cag_pov_place_vec(CagPovWriter *w, CagVec3 v) {
  put_unit(w);
  cag_pov_vec(w, v);
}

void cag_pov_length(CagPovWriter *w, double x) {
  put_unit(w);
  cag_pov_number(w, x);
}

void cag_pov_equation(CagPovWriter *w, const double q[10]) {
  cag_pov_text(w, "quadric {\n  ");
  cag_pov_vec(w, cag_vec3(q[0], q[1], q[2]));
  cag_pov_text(w, ", ");
  cag_pov_vec(w, cag_vec3(q[3], q[5], q[4]));
  cag_pov_text(w, ", ");
  cag_pov_vec(w, cag_vec3(q[6], q[7], q[8]));
  cag_pov_text(w, ", ");
  cag_pov_number(w, q[9]);
  cag_pov_text(w, "\n");
}

void cag_pov_vec2(CagPovWriter *w, double x, double y) {
  list_of_numbers(w, (const double[]){x, y}, 2);
}

double cag_pov_round(double x, double unit) {
  double rounded = round(x / unit);
  // Dividing by the integer 1/unit gives the double nearest to the decimal.
  return unit < 1 ? rounded / round(1 / unit) : rounded * unit;
}

void cag_pov_color(CagPovWriter *w, CagColor c) {
  const double unit = 1e-5; // finer than the steps of any display
  cag_pov_text(w, "rgb ");
  cag_pov_vec(
      w, cag_vec3(cag_pov_round(c.r, unit), cag_pov_round(c.g, unit), cag_pov_round(c.b, unit)));
}

void cag_pov_comment(CagPovWriter *w, const char *indent, const char *text) {
  cag_pov_text(w, indent);
  cag_pov_text(w, "// ");
  for (const char *at = text; *at; at++) {
    char c = (unsigned char)*at < ' ' ? ' ' : *at;
    cag_atomic_file_write(w->file, &c, 1);
  }
  cag_pov_text(w, "\n");
}

static bool is_identity(const CagTransform *t, bool *moved) {
  *moved = t->m[0][3] != 0 || t->m[1][3] != 0 || t->m[2][3] != 0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      if (t->m[i][j] != (i == j ? 1 : 0)) return false;
  return true;
}

void cag_pov_placement(CagPovWriter *w, const char *indent, const CagTransform *t) {
  double scale = 1 / t->m[3][3]; // affine, but perhaps not normalized
  CagTransform n = *t;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++) n.m[i][j] *= scale;
  bool moved;
  if (is_identity(&n, &moved)) {
    if (!moved) return;
    cag_pov_text(w, indent);
    cag_pov_text(w, "translate ");
    cag_pov_vec(w, cag_vec3(n.m[0][3], n.m[1][3], n.m[2][3]));
    cag_pov_text(w, "\n");
    return;
  }
  // POV-Ray expects the images of x, y, z, and the origin in sequence.
  cag_pov_text(w, indent);
  cag_pov_text(w, "matrix <");
  for (int j = 0; j < 4; j++)
    for (int i = 0; i < 3; i++) {
      if (i + j > 0) cag_pov_text(w, i == 0 ? ",  " : ", ");
      cag_pov_number(w, n.m[i][j]);
    }
  cag_pov_text(w, ">\n");
}

// The minimum volume of the image of a unit cube, relative to the cube of its longest edge. The
// renderer's tolerances apply in the thinnest direction of the transformed body.
#define FLATTEST 1e-6

bool cag_pov_takes(const CagTransform *map) {
  if (!cag_transform_is_affine(map)) return false;
  double largest = 0;
  for (int j = 0; j < 3; j++)
    largest = fmax(largest, cag_norm(cag_vec3(map->m[0][j], map->m[1][j], map->m[2][j])));
  double w = map->m[3][3], volume = cag_transform_determinant(map) / w;
  return isfinite(largest) && fabs(volume) > FLATTEST * largest * largest * largest;
}

const CagSurface *cag_pov_unplaced(const CagSurface *s, CagTransform *map) {
  const CagSurface *inner;
  *map = cag_transform_identity();
  map->planar = false;
  return cag_surface_placed_view(s, &inner, map) ? inner : s;
}

// Reserved words of POV-Ray 3.7 that consist only of lower-case letters, digits, and _, sorted.
static const char *const reserved[] = {
#include "interp/formats/pov_words.def"
};

static int compare_words(const void *a, const void *b) {
  return strcmp(*(const char *const *)a, *(const char *const *)b);
}

static bool is_reserved(const char *name) {
  return bsearch(&name, reserved, sizeof reserved / sizeof *reserved, sizeof *reserved,
                 compare_words) != NULL;
}

static bool is_word_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

// Leaves room for a number that makes the name unique.
#define BASE_MAX 30

static void make_identifier(const char *prefix, const char *name, CagPovName out) {
  size_t n = 0;
  for (const char *p = prefix; *p && n < BASE_MAX; p++) out[n++] = *p;
  if (n == 0 && !((name[0] | 32) >= 'a' && (name[0] | 32) <= 'z')) out[n++] = '_';
  for (const char *p = name; *p && n < BASE_MAX; p++) {
    char c = is_word_character(*p) ? *p : '_';
    if (c == '_' && n > 0 && out[n - 1] == '_') continue;
    out[n++] = c;
  }
  out[n] = 0;
  if (is_reserved(out)) strcpy(out + n, "_");
}

static bool is_taken(const CagHashIndex *taken, const CagPovName *names, uint64_t hash,
                     const char *name) {
  size_t k;
  for (CagHashWalk w = cag_hash_walk(taken, hash); cag_hash_next(&w, &k);)
    if (strcmp(names[k], name) == 0) return true;
  return false;
}

bool cag_pov_names(const char *prefix, const char *const *names, size_t n, CagPovName **out) {
  CagHashIndex taken = {0};
  CagPovName *made = cag_malloc((n ? n : 1) * sizeof *made);
  if (!made || !cag_hash_reserve(&taken, n)) {
    cag_free(made);
    return false;
  }
  for (size_t i = 0; i < n; i++) {
    make_identifier(prefix, names[i], made[i]);
    const size_t base = strlen(made[i]);
    uint64_t hash = cag_hash_text(CAG_HASH_START, made[i]);
    // After the first thousand names, numbers start higher, so that they are rarely taken.
    for (size_t k = 2; is_taken(&taken, made, hash, made[i]); k++) {
      snprintf(made[i] + base, sizeof made[i] - base, "_%zu", i > 1000 ? i + k : k);
      hash = cag_hash_text(CAG_HASH_START, made[i]);
    }
    cag_hash_add(&taken, hash, i);
  }
  cag_hash_free(&taken);
  *out = made;
  return true;
}
