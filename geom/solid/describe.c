// Descriptions of solids: their kind, their sizes, and their location.
//
// If the columns of the linear part of a placement are orthogonal, it is a scale along the solid's
// own axes followed by a rotation. A scale that preserves the kind of a primitive changes the
// reported sizes; the rest of the placement follows, in the order in which it is applied.

#include "geom/solid/kind.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "geom/linalg/tolerance.h"
#include "geom/solid/csg.h"

// Values equal within this fraction are equal, and further digits are rounding: placements are
// products of a few transforms.
#define ALIKE CAG_ROUNDING
#define DIGITS 12

typedef struct Text {
  char *buffer;
  size_t size, length;
} Text;

static void add(Text *t, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void add(Text *t, const char *format, ...) {
  if (t->length + 1 >= t->size) return;
  va_list args;
  va_start(args, format);
  int n = vsnprintf(t->buffer + t->length, t->size - t->length, format, args);
  va_end(args);
  if (n > 0) t->length += (size_t)n;
}

static void add_number(Text *t, const char *before, double x) {
  char number[32];
  add(t, "%s%s", before, cag_number_text(x, number));
}

// Removes digits that are rounding relative to numbers as large as `largest`.
static double tidy(double x, double largest) {
  char digits[40];
  if (!isfinite(x)) return x;
  if (fabs(x) <= ALIKE * largest) return 0;
  snprintf(digits, sizeof digits, "%.*g", DIGITS, x);
  return strtod(digits, NULL);
}

static void add_vector(Text *t, CagVec3 v) {
  double largest = fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z)));
  add_number(t, "[", tidy(v.x, largest));
  add_number(t, ", ", tidy(v.y, largest));
  add_number(t, ", ", tidy(v.z, largest));
  add(t, "]");
}

// --- Decomposition of placements ---

typedef struct Placed {
  bool square;     // scale, then rotation; otherwise only `map` is valid
  double scale[3]; // along the solid's own axes, one of them negative for reflections
  CagTransform turn;
  CagTransform map;
} Placed;

static CagVec3 column(const CagTransform *t, int j) {
  return cag_vec3(t->m[0][j], t->m[1][j], t->m[2][j]);
}

// The axis that a reflection reverses: the one that points most opposite to itself.
static int mirrored_axis(const Placed *p) {
  int axis = 0;
  double least = p->map.m[0][0] / p->scale[0];
  for (int j = 1; j < 3; j++)
    if (p->map.m[j][j] / p->scale[j] < least) {
      least = p->map.m[j][j] / p->scale[j];
      axis = j;
    }
  return axis;
}

static Placed take_apart(const CagSolid *s) {
  Placed p = {.square = true, .turn = cag_transform_identity(), .map = s->placement};
  const double w = p.map.m[3][3];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++) p.map.m[i][j] /= w;
  for (int j = 0; j < 3; j++) {
    CagVec3 here = column(&p.map, j), next = column(&p.map, (j + 1) % 3);
    p.scale[j] = cag_norm(here);
    p.square &= fabs(cag_dot(here, next)) <= ALIKE * cag_norm(here) * cag_norm(next);
  }
  bool mirrors = cag_transform_mirrors(&p.map);
  const CagSolidKindRow *kind = &cag_solid_kinds[s->kind];
  const int axis = kind->scaling == CAG_SCALES_UPRIGHT ? 0 : mirrored_axis(&p);
  if (mirrors) p.scale[axis] *= -1;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) p.turn.m[i][j] = p.map.m[i][j] / p.scale[j];
  if (mirrors && kind->is_symmetric && kind->is_symmetric(s)) p.scale[axis] *= -1;
  return p;
}

static bool alike(double a, double b) { return fabs(a - b) <= ALIKE * fmax(fabs(a), fabs(b)); }

// Whether the scale preserves the kind of a primitive, and only multiplies its sizes.
static bool scales_sizes(const CagSolid *s, const Placed *p) {
  const double *k = p->scale;
  bool round = alike(k[0], k[1]), uniform = round && alike(k[1], k[2]);
  switch (cag_solid_kinds[s->kind].scaling) {
  case CAG_SCALES_NOT: return false;
  case CAG_SCALES_EACH_AXIS: return p->square && k[0] > 0 && k[1] > 0 && k[2] > 0;
  case CAG_SCALES_UPRIGHT: return p->square && round;
  case CAG_SCALES_EVENLY: return p->square && uniform;
  case CAG_SCALES_MIRRORED:
    return p->square && alike(fabs(k[0]), fabs(k[1])) && alike(fabs(k[1]), fabs(k[2]));
  }
  return false;
}

// --- What it is ---

static double scaled_size(double size, double scale) {
  return alike(fabs(scale), 1) ? size : tidy(size * fabs(scale), 0);
}

void cag_describe_half_space(const CagSolid *s, const double size[3], char *buffer, size_t n) {
  (void)size;
  Text text = {buffer, n, 0}, *t = &text;
  CagQuadric form;
  add(t, "half space");
  if (!cag_solid_form(s, &form)) return;
  const CagVec3 row = cag_vec3(form.c[6], form.c[7], form.c[8]);
  const double length = cag_norm(row), offset = form.c[9] / length;
  const CagVec3 normal = cag_scaled(row, 1 / length);
  add(t, " behind the plane through ");
  add_vector(t, cag_scaled(normal, -offset));
  add(t, ", normal ");
  add_vector(t, normal);
}

static void add_form(Text *t, const CagSolid *s, const double scale[3]) {
  const CagSolidKindRow *kind = &cag_solid_kinds[s->kind];
  const double own[3] = {s->a, s->b, s->c};
  double size[3];
  char text[200];
  for (int i = 0; i < 3; i++) size[i] = scaled_size(own[i], scale[kind->size_axes[i]]);
  kind->describe(s, size, text, sizeof text);
  add(t, "%s", text);
}

// --- What was done to it ---

static void add_scale(Text *t, const double k[3]) {
  if (alike(k[0], 1) && alike(k[1], 1) && alike(k[2], 1)) return;
  add(t, ", scaled by ");
  if (alike(k[0], k[1]) && alike(k[1], k[2])) add_number(t, "", tidy(k[0], 0));
  else add_vector(t, cag_vec3(k[0], k[1], k[2]));
}

// Omitted if the solid looks the same after the rotation.
static void add_turn(Text *t, const CagSolid *s, const CagTransform *turn, bool sized) {
  CagVec3 axis;
  double angle;
  bool none;
  CagError ignored;
  const bool about_z = cag_solid_kinds[s->kind].turns_about_z;
  if (sized && s->kind == CAG_SOLID_SPHERE) return;
  if (sized && about_z && alike(turn->m[2][2], 1)) return;
  if (cag_axis_angle_of(turn, &axis, &angle, &none, &ignored) || fabs(angle) <= ALIKE) return;
  add_number(t, ", turned by ", tidy(angle * 180 / M_PI, 0));
  add(t, "deg about ");
  add_vector(t, axis);
}

static void add_map(Text *t, const CagTransform *map) {
  add(t, ", mapped by [");
  for (int i = 0; i < 3; i++) {
    if (i > 0) add(t, ", ");
    add_vector(t, cag_vec3(map->m[i][0], map->m[i][1], map->m[i][2]));
  }
  add(t, "]");
}

static void add_placement(Text *t, const CagSolid *s, const Placed *p, bool sized) {
  if (p->square) {
    if (!sized) add_scale(t, p->scale);
    add_turn(t, s, &p->turn, sized);
  } else {
    add_map(t, &p->map);
  }
  CagVec3 at = column(&p->map, 3);
  const double *k = p->scale;
  double size = fmax(fabs(s->a * k[0]), fmax(fabs(s->b * k[1]), fabs(s->c * k[2])));
  if (cag_norm(at) <= ALIKE * size) return;
  add(t, ", at ");
  add_vector(t, at);
}

static void describe(const CagSolid *s, bool placed, char *buffer, size_t size) {
  static const double as_made[3] = {1, 1, 1};
  Text t = {buffer, size, 0};
  const Placed p = take_apart(s);
  bool sized = scales_sizes(s, &p);
  if (size > 0) buffer[0] = '\0';
  add_form(&t, s, sized ? p.scale : as_made);
  if (placed && s->kind != CAG_SOLID_HALF_SPACE) add_placement(&t, s, &p, sized);
}

void cag_solid_describe(const CagSolid *s, char *buffer, size_t size) {
  describe(s, true, buffer, size);
}

void cag_solid_describe_form(const CagSolid *s, char *buffer, size_t size) {
  describe(s, false, buffer, size);
}
