// Sheets of quadrics between random planes: the parameters of the remaining parts, compared with
// the planes themselves, and their outlines.

#include "geom/surface/quadric_within.h"
#include "geom/surface/trimmed.h"
#include "quadric_support.h"

enum { SHAPES = 9, ROUNDS = 20, MOST_SURFACES = 64 };

static bool is_about_axis(CagQuadricShape s) {
  return s <= CAG_SHAPE_ELLIPTIC_PARABOLOID || s == CAG_SHAPE_ELLIPTIC_CYLINDER;
}

static bool is_cylinder(CagQuadricShape s) { return s >= CAG_SHAPE_ELLIPTIC_CYLINDER; }

// A sheet in a random position, and a patch of it, whose points the tests evaluate.
typedef struct Subject {
  CagQuadricSheet sheet;
  CagQuadricSide sides[CAG_QUADRIC_SIDES];
  size_t count;
  CagSurface *list[MOST_SURFACES];
  size_t n;
} Subject;

// In a fixed order, because the order in which compilers evaluate arguments differs.
static CagVec3 random_vector(void) {
  CagVec3 v;
  v.z = random_in(-1, 1);
  v.y = random_in(-1, 1);
  v.x = random_in(-1, 1);
  return v;
}

static void set_sheet(Subject *s, CagQuadricShape shape, int half, bool moved) {
  CagTransform frame = cag_transform_identity(), turn;
  frame.planar = false;
  if (moved) {
    for (int i = 0; i < 3; i++) frame.m[i][i] = random_in(0.5, 2);
    const CagVec3 through = random_vector();
    const double angle = random_in(0, 3);
    MUST(cag_rotate(random_vector(), angle, through, &turn, err));
    frame = cag_transform_multiply(&turn, &frame);
  }
  s->sheet = (CagQuadricSheet){shape, frame, -3, 2.5, -INFINITY, INFINITY, 1};
  if (is_about_axis(shape)) s->sheet.u0 = 0, s->sheet.u1 = 2 * M_PI;
  if (is_about_axis(shape) && !is_cylinder(shape) && shape != CAG_SHAPE_HYPERBOLOID_ONE)
    s->sheet.v0 = 0;
  if (shape == CAG_SHAPE_ELLIPSOID) s->sheet.v1 = M_PI;
  if (shape == CAG_SHAPE_CONE && half) s->sheet.v0 = -INFINITY, s->sheet.v1 = 0;
}

static CagVec3 point_of(const Subject *s, double u, double v) {
  const double c = cos(u), d = sin(u);
  const CagVec3 units[SHAPES] = {{c * sin(v), d * sin(v), cos(v)},
                                 {c * cosh(v), d * cosh(v), sinh(v)},
                                 {c * sinh(v), d * sinh(v), cosh(v)},
                                 {c * v, d * v, v},
                                 {c * v, d * v, v * v},
                                 {u, v, u * u - v * v},
                                 {c, d, v},
                                 {u * u, 2 * u, v},
                                 {cosh(u), sinh(u), v}};
  return cag_transform_point(&s->sheet.frame, units[s->sheet.shape]);
}

// Adds the half space n . x <= d of the unit form.
static void add_side(Subject *s, CagVec3 n, double d) {
  CagTransform back;
  MUST(cag_transform_inverse(&s->sheet.frame, &back, err));
  double k[4];
  for (int j = 0; j < 4; j++) k[j] = n.x * back.m[0][j] + n.y * back.m[1][j] + n.z * back.m[2][j];
  const CagVec3 world = cag_vec3(k[0], k[1], k[2]);
  const double size = cag_norm(world);
  s->sides[s->count++] = (CagQuadricSide){cag_scaled(world, 1 / size), (d - k[3]) / size};
}

static double beyond(const CagQuadricSide *side, CagVec3 p) {
  return cag_dot(side->n, p) - side->d;
}

// How far a point is beyond the side that it violates most; negative inside all sides.
static double most_beyond(const Subject *s, CagVec3 p) {
  double most = -INFINITY;
  for (size_t i = 0; i < s->count; i++) most = fmax(most, beyond(&s->sides[i], p));
  return most;
}

static double random_v(const Subject *s, double reach) {
  return random_in(fmax(s->sheet.v0, -reach), fmin(s->sheet.v1, reach));
}

// The number of results that contain these parameters.
static int covering(const Subject *s, double u, double v) {
  int covers = 0;
  const int turns = is_about_axis(s->sheet.shape) ? 1 : 0;
  for (size_t i = 0; i < s->n; i++) {
    const CagSurface *piece = s->list[i];
    const CagRegion *region = NULL;
    cag_surface_trimmed_view(piece, NULL, &region);
    for (int turn = 0; turn <= turns; turn++) {
      const double at = u + 2 * M_PI * turn;
      bool in = at >= piece->u0 && at <= piece->u1 && v >= piece->v0 && v <= piece->v1;
      if (in && region) MUST(cag_region_contains(region, cag_vec3(at, v, 0), &in, err));
      covers += in;
    }
  }
  return covers;
}

// Checks that points well inside all planes are on one of the results, and others on none. Returns
// the number of inner points.
static int check_parameters(const Subject *s, int samples) {
  int within = 0;
  for (int i = 0; i < samples; i++) {
    const double u = random_in(s->sheet.u0, s->sheet.u1), v = random_v(s, i % 4 ? 2 : 6);
    const CagVec3 p = point_of(s, u, v);
    const double most = most_beyond(s, p);
    if (fabs(most) < 1e-7 * (1 + cag_norm(p))) continue;
    const int expected = most < 0, found = covering(s, u, v);
    if (found != expected)
      fail_msg("shape %d: (%g, %g) is on %d surfaces, not %d", s->sheet.shape, u, v, found,
               expected);
    within += expected;
  }
  return within;
}

// The sine of the angle between a plane and the sheet at a point of its unit form.
static double crossing(const Subject *s, const CagQuadricSide *side, CagVec3 p) {
  const double *c = UNITS[s->sheet.shape];
  CagTransform back;
  MUST(cag_transform_inverse(&s->sheet.frame, &back, err));
  const CagVec3 x = cag_transform_point(&back, p);
  const double by[3] = {2 * c[0] * x.x + c[6], 2 * c[1] * x.y + c[7], 2 * c[2] * x.z + c[8]};
  double n[3];
  for (int j = 0; j < 3; j++)
    n[j] = by[0] * back.m[0][j] + by[1] * back.m[1][j] + by[2] * back.m[2][j];
  return cag_norm(cag_cross(side->n, cag_unit(cag_vec3(n[0], n[1], n[2]))));
}

// Checks that every point of an outline is on a plane or at an end of the sheet, and beyond no
// plane, within the tolerance along the sheet. Returns the number of control points.
static size_t check_outline(const Subject *s, const CagCurve *loop) {
  const CagQuadricSheet *sheet = &s->sheet;
  CagNurbsView view;
  assert_true(cag_curve_nurbs_view(loop, &view));
  const int samples = 200;
  for (int i = 0; i < samples; i++) {
    const double t = loop->start + (loop->end - loop->start) * (i + 0.37) / samples;
    CagVec3 at;
    MUST(cag_curve_point(loop, t, &at, err));
    const CagVec3 p = point_of(s, at.x, at.y);
    bool on = at.y == sheet->v0 || at.y == sheet->v1 || at.x == sheet->u0 || at.x == sheet->u1;
    for (size_t k = 0; k < s->count; k++) {
      const double off = beyond(&s->sides[k], p), slack = 1e-14 * (1 + cag_norm(p));
      const double enough = 2e-11 * crossing(s, &s->sides[k], p) + slack;
      on = on || fabs(off) <= enough;
      if (off > enough)
        fail_msg("shape %d: (%g, %g) is %g beyond a plane", sheet->shape, at.x, at.y, off);
    }
    if (!on) fail_msg("shape %d: (%g, %g) is not on a plane", sheet->shape, at.x, at.y);
  }
  return view.count;
}

static bool reaches_far(const Subject *s) {
  for (int k = 0; k < 2; k++)
    for (int i = 0; isinf(k ? s->sheet.v1 : s->sheet.v0) && i < 4000; i++) {
      const double u = s->sheet.u0 + (s->sheet.u1 - s->sheet.u0) * (i + 0.5) / 4000;
      if (most_beyond(s, point_of(s, u, k ? 40 : -40)) < 0) return true;
    }
  return false;
}

typedef struct Count {
  int within, unbounded, trimmed;
  size_t loops, points[SHAPES];
} Count;

static void check(Subject *s, int samples, Count *sum) {
  CagError why = {0};
  s->n = 0;
  if (cag_quadric_sheet_within(&s->sheet, s->sides, s->count, s->list, MOST_SURFACES, &s->n,
                               &why)) {
    assert_string_equal(cag_error_info(why.id)->reason, "quadric-unbounded");
    assert_true(reaches_far(s));
    sum->unbounded++;
    return;
  }
  sum->within += check_parameters(s, samples);
  for (size_t i = 0; i < s->n; i++) {
    const CagRegion *region = NULL;
    if (!cag_surface_trimmed_view(s->list[i], NULL, &region)) continue;
    sum->trimmed++;
    for (size_t k = 0; k < region->count; k++, sum->loops++)
      sum->points[s->sheet.shape] += check_outline(s, region->loops[k]);
  }
}

static void release_all(Subject *s) {
  for (size_t i = 0; i < s->n; i++) cag_surface_release(s->list[i]);
}

static void planes_leave_what_is_within_them(void **state) {
  (void)state;
  Count sum = {0};
  for (int round = 0; round < ROUNDS * SHAPES; round++) {
    state_of_random = 300 + (uint64_t)round;
    Subject s = {.n = 0};
    set_sheet(&s, (CagQuadricShape)(round % SHAPES), round / SHAPES % 2, round / SHAPES % 3 > 0);
    const int sides = (int)random_in(1, CAG_QUADRIC_SIDES + 0.99);
    for (int i = 0; i < sides; i++) {
      const CagVec3 n = random_vector();
      add_side(&s, n, random_in(-0.3, 1.3));
    }
    check(&s, 150, &sum);
    release_all(&s);
  }
  // Limits of the number of control points. A piece of degree 7 adds seven.
  static const size_t ENOUGH[SHAPES] = {11920, 2576, 4663, 9151, 7956, 5933, 1050, 638, 1574};
  for (int i = 0; i < SHAPES; i++)
    assert_near((double)sum.points[i] / (double)ENOUGH[i], 1, 0.03, "control points");
  assert_true(sum.within > 200 * ROUNDS && sum.unbounded > 2 * ROUNDS);
}

// Boxes whose sides pass through the center, contain the axis or rulings, or are tangent.
static void boxes_in_special_positions_leave_what_is_within_them(void **state) {
  (void)state;
  static const double ACROSS[][3][3] = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                        {{1, 1, 0}, {1, -1, 0}, {0, 0, 1}},
                                        {{1, 0, 1}, {1, 0, -1}, {0, 1, 0}},
                                        {{0, 1, 1}, {0, 1, -1}, {1, 0, 0}}};
  Count sum = {0};
  for (int round = 0; round < ROUNDS * SHAPES; round++) {
    state_of_random = 900 + (uint64_t)round;
    Subject s = {.n = 0};
    set_sheet(&s, (CagQuadricShape)(round % SHAPES), round / SHAPES % 2, round / SHAPES % 3 > 0);
    const int way = (int)random_in(0, 3.99);
    for (int i = 0; i < 3; i++) {
      const double *n = ACROSS[way][i], low = floor(random_in(-4, 2)) / 2;
      add_side(&s, cag_vec3(n[0], n[1], n[2]), low + floor(random_in(1, 5)) / 2);
      add_side(&s, cag_vec3(-n[0], -n[1], -n[2]), -low);
    }
    check(&s, 150, &sum);
    release_all(&s);
  }
  assert_true(sum.within > 20 * ROUNDS && sum.unbounded == 0);
}

// Planes perpendicular to the axis, and planes that contain it or rulings.
static void pieces_between_lines_of_constant_parameters_are_patches(void **state) {
  (void)state;
  Count sum = {0};
  size_t patches = 0;
  for (int round = 0; round < ROUNDS * SHAPES; round++) {
    state_of_random = 1500 + (uint64_t)round;
    Subject s = {.n = 0};
    const CagQuadricShape shape = (CagQuadricShape)(round % SHAPES);
    set_sheet(&s, shape, round / SHAPES % 2, round / SHAPES % 3 > 0);
    const bool saddle = shape == CAG_SHAPE_HYPERBOLIC_PARABOLOID;
    const CagVec3 along = cag_vec3(0, saddle, !saddle);
    const double high = random_in(-0.5, 2), low = random_in(-1, 0.5);
    if (round % 5) add_side(&s, along, high);
    if (round % 7) add_side(&s, cag_scaled(along, -1), -low);
    for (int i = (int)random_in(0, 2.99); i > 0; i--) {
      const CagVec3 across = cag_vec3(random_in(-1, 1), saddle ? 0 : random_in(-1, 1), 0);
      add_side(&s, across, is_cylinder(shape) || saddle ? random_in(-0.5, 1) : 0);
    }
    check(&s, 150, &sum);
    patches += s.n;
    release_all(&s);
  }
  assert_int_equal(sum.trimmed, 0);
  assert_true(patches > 4 * ROUNDS && sum.unbounded > ROUNDS);
}

// A plane tangent to a saddle or hyperboloid meets it in two crossing lines.
static void pieces_that_touch_in_a_point_stay_apart(void **state) {
  (void)state;
  for (int round = 0; round < 8; round++) {
    state_of_random = 2100 + (uint64_t)round;
    const bool saddle = round % 2, above = round / 2 % 2;
    Subject s = {.n = 0};
    Count sum = {0};
    set_sheet(&s, saddle ? CAG_SHAPE_HYPERBOLIC_PARABOLOID : CAG_SHAPE_HYPERBOLOID_ONE, 0,
              round >= 4);
    if (saddle) {
      add_side(&s, cag_vec3(1, 0, 0), 1);
      add_side(&s, cag_vec3(-1, 0, 0), 1.5);
      add_side(&s, cag_vec3(0, 1, 0), 1);
      add_side(&s, cag_vec3(0, -1, 0), 1.5);
    } else {
      add_side(&s, cag_vec3(0, 0, 1), 1);
      add_side(&s, cag_vec3(0, 0, -1), 1.5);
    }
    const double sign = above ? -1 : 1;
    add_side(&s, saddle ? cag_vec3(0, 0, sign) : cag_vec3(sign, 0, 0), saddle ? 0 : sign);
    check(&s, 400, &sum);
    // The part of a hyperboloid below its tangent plane surrounds it.
    assert_int_equal(s.n, saddle || above ? 2 : 1);
    assert_int_equal(sum.loops, s.n);
    release_all(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(planes_leave_what_is_within_them),
      cmocka_unit_test(boxes_in_special_positions_leave_what_is_within_them),
      cmocka_unit_test(pieces_that_touch_in_a_point_stay_apart),
      cmocka_unit_test(pieces_between_lines_of_constant_parameters_are_patches),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
