// Descriptions of solids: their kind, their sizes, and their location.
//
// If the columns of the linear part of a placement are orthogonal, it is a scale along the solid's
// own axes followed by a rotation. A scale that preserves the kind of a primitive changes the
// reported sizes; the rest of the placement follows, in the order in which it is applied.

#include "geom/solid/solid.h"

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

// Whether reflections across the solid's own axes map it to itself: all of them for a sphere,
// torus, and centered box, those across x and y for a cylinder.
static bool has_mirror_planes(const CagSolid *s) {
  return s->kind == CAG_SOLID_SPHERE || s->kind == CAG_SOLID_CYLINDER ||
         s->kind == CAG_SOLID_TORUS || (s->kind == CAG_SOLID_BOX && s->centered);
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
  const int axis = s->kind == CAG_SOLID_CYLINDER ? 0 : mirrored_axis(&p);
  if (mirrors) p.scale[axis] *= -1;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) p.turn.m[i][j] = p.map.m[i][j] / p.scale[j];
  if (mirrors && has_mirror_planes(s)) p.scale[axis] *= -1;
  return p;
}

static bool alike(double a, double b) { return fabs(a - b) <= ALIKE * fmax(fabs(a), fabs(b)); }

// Whether the scale preserves the kind of a primitive, and only multiplies its sizes.
static bool scales_sizes(const CagSolid *s, const Placed *p) {
  const double *k = p->scale;
  bool round = alike(k[0], k[1]), uniform = round && alike(k[1], k[2]);
  switch (s->kind) {
  case CAG_SOLID_BOX: return p->square && k[0] > 0 && k[1] > 0 && k[2] > 0;
  case CAG_SOLID_CYLINDER: return p->square && round;
  case CAG_SOLID_SPHERE:
  case CAG_SOLID_TORUS: return p->square && uniform;
  case CAG_SOLID_TUBE:
    return p->square && alike(fabs(k[0]), fabs(k[1])) && alike(fabs(k[1]), fabs(k[2]));
  default: return false;
  }
}

// --- What it is ---

static double scaled_size(double size, double scale) {
  return alike(fabs(scale), 1) ? size : tidy(size * fabs(scale), 0);
}

static void add_cylinder(Text *t, const double size[3]) {
  add_number(t, size[2] == 0 ? "cone, height " : "cylinder, height ", size[0]);
  add_number(t, ", radius ", size[1]);
  if (size[2] != 0 && size[1] != size[2]) add_number(t, ", top ", size[2]);
}

static void add_box(Text *t, const CagSolid *s, const double size[3]) {
  add_number(t, "box, ", size[0]);
  add_number(t, " x ", size[1]);
  add_number(t, " x ", size[2]);
  if (s->centered) add(t, ", centered");
}

// A half space has no size. It is described by its plane after all transforms.
static void add_half_space(Text *t, const CagSolid *s) {
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
  // A cylinder's height is along z, its radii across.
  const bool upright = s->kind == CAG_SOLID_CYLINDER;
  const double size[3] = {scaled_size(s->a, scale[upright ? 2 : 0]), scaled_size(s->b, scale[1]),
                          scaled_size(s->c, scale[upright ? 0 : 2])};
  switch (s->kind) {
  case CAG_SOLID_BOX: add_box(t, s, size); return;
  case CAG_SOLID_SPHERE: add_number(t, "sphere, radius ", size[0]); return;
  case CAG_SOLID_CYLINDER: add_cylinder(t, size); return;
  case CAG_SOLID_TORUS:
    add_number(t, "torus, major ", size[0]);
    add_number(t, ", minor ", size[1]);
    return;
  case CAG_SOLID_EXTRUSION:
  case CAG_SOLID_REVOLUTION:
  case CAG_SOLID_SWEEP:
  case CAG_SOLID_LOFT:
  case CAG_SOLID_SHELL:
    add(t, "%s, %zu %s", cag_solid_kind_name(s->kind), s->face_count,
        s->face_count == 1 ? "face" : "faces");
    return;
  case CAG_SOLID_TUBE: add_number(t, "tube, radius ", size[0]); return;
  case CAG_SOLID_MESH: add(t, "polyhedron, %zu triangles", s->core->mesh->triangle_count); return;
  case CAG_SOLID_HALF_SPACE: add_half_space(t, s); return;
  case CAG_SOLID_QUADRIC: add(t, "%s", cag_solid_kind_name(s->kind)); return;
  case CAG_SOLID_UNION:
  case CAG_SOLID_DIFFERENCE:
  case CAG_SOLID_INTERSECTION:
    if (s->core->count == 0) add(t, "empty solid");
    else add(t, "%s of %zu solids", cag_solid_kind_name(s->kind), s->core->count);
    return;
  }
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
  bool about_z = s->kind == CAG_SOLID_CYLINDER || s->kind == CAG_SOLID_TORUS;
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

const char *cag_solid_kind_name(CagSolidKind kind) {
  static const char *const names[] = {
      [CAG_SOLID_BOX] = "box",
      [CAG_SOLID_SPHERE] = "sphere",
      [CAG_SOLID_CYLINDER] = "cylinder",
      [CAG_SOLID_TORUS] = "torus",
      [CAG_SOLID_EXTRUSION] = "extrusion",
      [CAG_SOLID_REVOLUTION] = "revolution",
      [CAG_SOLID_TUBE] = "tube",
      [CAG_SOLID_SWEEP] = "sweep",
      [CAG_SOLID_LOFT] = "loft",
      [CAG_SOLID_SHELL] = "shell",
      [CAG_SOLID_MESH] = "polyhedron",
      [CAG_SOLID_HALF_SPACE] = "half_space",
      [CAG_SOLID_QUADRIC] = "quadric",
      [CAG_SOLID_UNION] = "union",
      [CAG_SOLID_DIFFERENCE] = "difference",
      [CAG_SOLID_INTERSECTION] = "intersection",
  };
  return names[kind];
}
