// The table of the kinds of solids.

#include "geom/solid/kind.h"

#include <math.h>
#include <stdio.h>

#include "geom/solid/csg.h"
#include "geom/solid/exact.h"

// --- Bounds of round bodies ---

// The largest value of w . p for the points p of a body in its own coordinates.
typedef double Support(const CagSolid *s, CagVec3 w);

static CagStatus bounds_by_support(const CagSolid *s, Support *support, CagBounds *out) {
  double low[3], high[3];
  for (int i = 0; i < 3; i++) {
    const double *row = s->placement.m[i];
    const CagVec3 w = cag_vec3(row[0], row[1], row[2]);
    high[i] = row[3] + support(s, w);
    low[i] = row[3] - support(s, cag_scaled(w, -1));
  }
  *out = (CagBounds){cag_vec3(low[0], low[1], low[2]), cag_vec3(high[0], high[1], high[2])};
  return CAG_OK;
}

// --- Box ---

static CagSolidBody box_body(const CagSolid *s) {
  double v = s->a * s->b * s->c;
  CagSolidBody b = {.volume = v, .area = 2 * (s->a * s->b + s->b * s->c + s->c * s->a)};
  b.moment[0] = v * s->a * s->a / 12;
  b.moment[1] = v * s->b * s->b / 12;
  b.moment[2] = v * s->c * s->c / 12;
  if (!s->centered) b.centroid = cag_vec3(s->a / 2, s->b / 2, s->c / 2);
  b.area_centroid = b.centroid;
  return b;
}

static double box_beyond(const CagSolid *s, CagVec3 p) {
  CagVec3 half = cag_vec3(s->a / 2, s->b / 2, s->c / 2);
  if (!s->centered) p = cag_sub(p, half);
  return fmax(fabs(p.x) - half.x, fmax(fabs(p.y) - half.y, fabs(p.z) - half.z));
}

// Bounds of the corners.
static CagStatus box_bounds(const CagSolid *s, CagBounds *out, CagError *err) {
  (void)err;
  const CagVec3 size = cag_vec3(s->a, s->b, s->c);
  const CagVec3 low = s->centered ? cag_scaled(size, -0.5) : cag_vec3(0, 0, 0);
  *out = CAG_BOUNDS_EMPTY;
  for (int k = 0; k < 8; k++) {
    const CagVec3 step = cag_vec3(k & 1 ? size.x : 0, k & 2 ? size.y : 0, k & 4 ? size.z : 0);
    cag_bounds_add(out, cag_transform_point(&s->placement, cag_add(low, step)));
  }
  return CAG_OK;
}

static bool is_centered(const CagSolid *s) { return s->centered; }

static void describe_box(const CagSolid *s, const double size[3], char *buffer, size_t n) {
  char x[3][32];
  for (int i = 0; i < 3; i++) cag_number_text(size[i], x[i]);
  snprintf(buffer, n, "box, %s x %s x %s%s", x[0], x[1], x[2], s->centered ? ", centered" : "");
}

// --- Sphere ---

static bool always(const CagSolid *s) {
  (void)s;
  return true;
}

static CagSolidBody sphere_body(const CagSolid *s) {
  double r = s->a;
  CagSolidBody b = {.volume = 4 * M_PI / 3 * r * r * r, .area = 4 * M_PI * r * r};
  for (int k = 0; k < 3; k++) b.moment[k] = b.volume * r * r / 5;
  return b;
}

static double sphere_support(const CagSolid *s, CagVec3 w) { return s->a * cag_norm(w); }

static CagStatus sphere_bounds(const CagSolid *s, CagBounds *out, CagError *err) {
  (void)err;
  return bounds_by_support(s, sphere_support, out);
}

static double sphere_beyond(const CagSolid *s, CagVec3 p) { return cag_norm(p) - s->a; }

static void describe_sphere(const CagSolid *s, const double size[3], char *buffer, size_t n) {
  (void)s;
  char radius[32];
  snprintf(buffer, n, "sphere, radius %s", cag_number_text(size[0], radius));
}

// --- Cylinder, frustum, and cone: height a, radius b, radius c at the top ---

// A frustum on z = 0: integrals of powers of the radius R (1 - t) + r t over t = z / h.
static CagSolidBody frustum_body(const CagSolid *s) {
  double h = s->a, R = s->b, r = s->c;
  double square = (R * R + R * r + r * r) / 3;
  double first = (R * R + 2 * R * r + 3 * r * r) / 12, second = R * R / 30 + R * r / 10 + r * r / 5;
  double fourth =
      (R * R * R * R + R * R * R * r + R * R * r * r + R * r * r * r + r * r * r * r) / 5;
  CagSolidBody b = {.volume = M_PI * h * square, .centroid = {0, 0, h * first / square}};
  b.moment[0] = b.moment[1] = M_PI / 4 * h * fourth;
  b.moment[2] = M_PI * h * h * h * second - b.volume * b.centroid.z * b.centroid.z;
  double side = M_PI * (R + r) * hypot(h, R - r), foot = M_PI * R * R, top = M_PI * r * r;
  b.area = side + foot + top;
  double side_z = h * (R + 2 * r) / (3 * (R + r));
  b.area_centroid = cag_vec3(0, 0, (side * side_z + top * h) / b.area);
  return b;
}

// Of its two circles.
static double frustum_support(const CagSolid *s, CagVec3 w) {
  const double across = hypot(w.x, w.y);
  return fmax(s->b * across, s->a * w.z + s->c * across);
}

static CagStatus frustum_bounds(const CagSolid *s, CagBounds *out, CagError *err) {
  (void)err;
  return bounds_by_support(s, frustum_support, out);
}

static double frustum_beyond(const CagSolid *s, CagVec3 p) {
  double height = s->a, radius = s->b, top = s->c, slope = (top - radius) / height;
  double side = (hypot(p.x, p.y) - radius - slope * p.z) / hypot(1, slope);
  return fmax(side, fmax(-p.z, p.z - height));
}

static void describe_frustum(const CagSolid *s, const double size[3], char *buffer, size_t n) {
  (void)s;
  char height[32], radius[32], top[32];
  cag_number_text(size[0], height);
  cag_number_text(size[1], radius);
  cag_number_text(size[2], top);
  const bool other = size[2] != 0 && size[1] != size[2];
  snprintf(buffer, n, "%s, height %s, radius %s%s%s", size[2] == 0 ? "cone" : "cylinder", height,
           radius, other ? ", top " : "", other ? top : "");
}

// --- Torus ---

static CagSolidBody torus_body(const CagSolid *s) {
  double R = s->a, r = s->b;
  CagSolidBody b = {.volume = 2 * M_PI * M_PI * R * r * r, .area = 4 * M_PI * M_PI * R * r};
  b.moment[0] = b.moment[1] = b.volume * (R * R / 2 + 3 * r * r / 8);
  b.moment[2] = b.volume * r * r / 4;
  return b;
}

static double torus_support(const CagSolid *s, CagVec3 w) {
  return s->a * hypot(w.x, w.y) + s->b * cag_norm(w);
}

static CagStatus torus_bounds(const CagSolid *s, CagBounds *out, CagError *err) {
  (void)err;
  return bounds_by_support(s, torus_support, out);
}

static double torus_beyond(const CagSolid *s, CagVec3 p) {
  return hypot(hypot(p.x, p.y) - s->a, p.z) - s->b;
}

static void describe_torus(const CagSolid *s, const double size[3], char *buffer, size_t n) {
  (void)s;
  char major[32], minor[32];
  snprintf(buffer, n, "torus, major %s, minor %s", cag_number_text(size[0], major),
           cag_number_text(size[1], minor));
}

// --- Other kinds ---

static void describe_tube(const CagSolid *s, const double size[3], char *buffer, size_t n) {
  (void)s;
  char radius[32];
  snprintf(buffer, n, "tube, radius %s", cag_number_text(size[0], radius));
}

static void describe_faces(const CagSolid *s, const double size[3], char *buffer, size_t n) {
  (void)size;
  snprintf(buffer, n, "%s, %zu %s", cag_solid_kind_name(s->kind), s->face_count,
           s->face_count == 1 ? "face" : "faces");
}

static void describe_exact(const CagSolid *s, const double size[3], char *buffer, size_t n) {
  (void)size;
  snprintf(buffer, n, "exact solid, %zu %s", s->face_count, s->face_count == 1 ? "face" : "faces");
}

static void describe_mesh(const CagSolid *s, const double size[3], char *buffer, size_t n) {
  (void)size;
  snprintf(buffer, n, "polyhedron, %zu triangles", s->core->mesh->triangle_count);
}

static void describe_name(const CagSolid *s, const double size[3], char *buffer, size_t n) {
  (void)size;
  snprintf(buffer, n, "%s", cag_solid_kind_name(s->kind));
}

static void describe_operation(const CagSolid *s, const double size[3], char *buffer, size_t n) {
  (void)size;
  if (s->core->count == 0) snprintf(buffer, n, "empty solid");
  else snprintf(buffer, n, "%s of %zu solids", cag_solid_kind_name(s->kind), s->core->count);
}

const CagSolidKindRow cag_solid_kinds[] = {
    [CAG_SOLID_BOX] = {.name = "box",
                       .scaling = CAG_SCALES_EACH_AXIS,
                       .size_axes = {0, 1, 2},
                       .is_symmetric = is_centered,
                       .describe = describe_box,
                       .body = box_body,
                       .beyond = box_beyond,
                       .bounds = box_bounds},
    [CAG_SOLID_SPHERE] = {.name = "sphere",
                          .scaling = CAG_SCALES_EVENLY,
                          .is_symmetric = always,
                          .describe = describe_sphere,
                          .body = sphere_body,
                          .beyond = sphere_beyond,
                          .bounds = sphere_bounds},
    [CAG_SOLID_CYLINDER] = {.name = "cylinder",
                            .scaling = CAG_SCALES_UPRIGHT,
                            .size_axes = {2, 1, 0},
                            .turns_about_z = true,
                            .is_symmetric = always,
                            .describe = describe_frustum,
                            .body = frustum_body,
                            .beyond = frustum_beyond,
                            .bounds = frustum_bounds},
    [CAG_SOLID_TORUS] = {.name = "torus",
                         .scaling = CAG_SCALES_EVENLY,
                         .turns_about_z = true,
                         .is_symmetric = always,
                         .describe = describe_torus,
                         .body = torus_body,
                         .beyond = torus_beyond,
                         .bounds = torus_bounds},
    [CAG_SOLID_EXTRUSION] = {.name = "extrusion", .describe = describe_faces},
    [CAG_SOLID_REVOLUTION] = {.name = "revolution", .describe = describe_faces},
    [CAG_SOLID_TUBE] = {.name = "tube", .scaling = CAG_SCALES_MIRRORED, .describe = describe_tube},
    [CAG_SOLID_SWEEP] = {.name = "sweep", .describe = describe_faces},
    [CAG_SOLID_LOFT] = {.name = "loft", .describe = describe_faces},
    [CAG_SOLID_SHELL] = {.name = "shell", .describe = describe_faces},
    [CAG_SOLID_EXACT] = {.name = "exact", .describe = describe_exact, .bounds = cag_exact_bounds},
    [CAG_SOLID_MESH] = {.name = "polyhedron", .describe = describe_mesh},
    [CAG_SOLID_HALF_SPACE] = {.name = "half_space", .describe = cag_describe_half_space},
    [CAG_SOLID_QUADRIC] = {.name = "quadric", .describe = describe_name},
    [CAG_SOLID_UNION] = {.name = "union", .describe = describe_operation},
    [CAG_SOLID_DIFFERENCE] = {.name = "difference", .describe = describe_operation},
    [CAG_SOLID_INTERSECTION] = {.name = "intersection", .describe = describe_operation},
};

const char *cag_solid_kind_name(CagSolidKind kind) { return cag_solid_kinds[kind].name; }
