// Quadrics in boxes and ranges of z: random quadrics of all classes, compared with the points found
// by rays, and areas compared with closed forms and sums over grids.

#include "geom/surface/trimmed.h"
#include "quadric_support.h"

// The (u, v) of a point of a quadric patch, from the patch's frame.
static CagVec3 parameters_of(const CagSurface *patch, CagVec3 p) {
  CagTransform frame, back;
  CagQuadric q;
  assert_true(cag_surface_quadric_frame(patch, &frame));
  assert_true(cag_surface_quadric_view(patch, &q));
  MUST(cag_transform_inverse(&frame, &back, err));
  const CagVec3 x = cag_transform_point(&back, p);
  const double angle = atan2(x.y, x.x), r = hypot(x.x, x.y);
  char text[64];
  patch->kind->describe(patch, text, sizeof text);
  if (strstr(text, "ellipsoid")) return cag_vec3(angle, atan2(r, x.z), 0);
  if (strstr(text, "one sheet")) return cag_vec3(angle, asinh(x.z), 0);
  if (strstr(text, "sheet")) return cag_vec3(angle, x.z > 0 ? asinh(r) : NAN, 0);
  if (strstr(text, "cone")) return cag_vec3(x.z < 0 ? angle + M_PI : angle, x.z, 0);
  if (strstr(text, "elliptic paraboloid")) return cag_vec3(angle, r, 0);
  if (strstr(text, "hyperbolic paraboloid")) return cag_vec3(x.x, x.y, 0);
  if (strstr(text, "elliptic cylinder")) return cag_vec3(angle, x.z, 0);
  if (strstr(text, "parabolic cylinder")) return cag_vec3(x.y / 2, x.z, 0);
  return cag_vec3(x.x > 0 ? asinh(x.y) : NAN, x.z, 0);
}

static bool is_on_plane(const CagRegion *region, const CagTransform *frame, CagVec3 p) {
  CagTransform back;
  bool in;
  MUST(cag_transform_inverse(frame, &back, err));
  const CagVec3 x = cag_transform_point(&back, p);
  if (fabs(x.z) > 1e-6) return false;
  MUST(cag_region_contains(region, cag_vec3(x.x, x.y, 0), &in, err));
  return in;
}

static bool is_on(const CagSurface *s, CagVec3 p) {
  const CagRegion *region = NULL;
  const CagSurface *whole = s;
  CagTransform frame;
  if (cag_surface_planar_view(s, &region, &frame)) return is_on_plane(region, &frame, p);
  cag_surface_trimmed_view(s, &whole, &region);
  CagVec3 uv = parameters_of(whole, p);
  if (isnan(uv.x) || isnan(uv.y)) return false;
  for (int turn = whole->angular_u ? -2 : 0; turn <= (whole->angular_u ? 2 : 0); turn++) {
    const CagVec3 at = cag_vec3(uv.x + 2 * M_PI * turn, uv.y, 0);
    bool in = at.x >= s->u0 && at.x <= s->u1 && at.y >= s->v0 && at.y <= s->v1;
    if (in && region) MUST(cag_region_contains(region, at, &in, err));
    if (in) return true;
  }
  return false;
}

static double entry_of(CagVec3 p, int i) { return i == 0 ? p.x : i == 1 ? p.y : p.z; }

static bool lies_in(const CagBounds *box, CagVec3 p, double slack) {
  for (int i = 0; i < 3; i++)
    if (entry_of(p, i) < entry_of(box->min, i) - slack ||
        entry_of(p, i) > entry_of(box->max, i) + slack)
      return false;
  return true;
}

// Checks that bounds, and points of the patches within their outlines, are in the box and satisfy
// the equation.
static void check_points(CagSurface *const *list, size_t n, const CagQuadric *q,
                         const CagBounds *box, bool bounds_too) {
  double largest = 0;
  for (int i = 0; i < 10; i++) largest = fmax(largest, fabs(q->c[i]));
  for (size_t k = 0; k < n; k++) {
    const CagRegion *region = NULL;
    CagBounds b;
    const bool flat = cag_surface_planar_view(list[k], NULL, NULL);
    cag_surface_trimmed_view(list[k], NULL, &region);
    if (bounds_too) {
      MUST(cag_surface_bounds(list[k], &b, err));
      assert_true(lies_in(box, b.min, 1e-9) && lies_in(box, b.max, 1e-9));
    }
    for (int i = 0; !flat && i < 36; i++) {
      const double u = random_in(list[k]->u0, list[k]->u1), v = random_in(list[k]->v0, list[k]->v1);
      bool in = true;
      if (region) MUST(cag_region_contains(region, cag_vec3(u, v, 0), &in, err));
      if (!in) continue;
      const CagVec3 p = surface_at(list[k], u, v);
      assert_true(lies_in(box, p, 1e-9));
      assert_near(cag_quadric_value(q, p) / (largest * (1 + cag_dot(p, p))), 0, 1e-9, "equation");
    }
  }
}

// Finds the simple points of the quadric on a line parallel to an axis.
static int ray(const CagQuadric *q, CagVec3 from, int axis, CagVec3 out[2]) {
  const CagVec3 e = cag_vec3(axis == 0, axis == 1, axis == 2);
  const double at = cag_quadric_value(q, from), up = cag_quadric_value(q, cag_add(from, e));
  const double down = cag_quadric_value(q, cag_sub(from, e));
  const double a = (up + down) / 2 - at, b = (up - down) / 2, rest = b * b - 4 * a * at;
  if (!(rest > 1e-12)) return 0;
  if (fabs(a) < 1e-12 * fabs(b)) {
    out[0] = cag_madd(from, -at / b, e);
    return 1;
  }
  out[0] = cag_madd(from, (-b - sqrt(rest)) / (2 * a), e);
  out[1] = cag_madd(from, (-b + sqrt(rest)) / (2 * a), e);
  return 2;
}

// Checks that points found by rays are on the result if they are well inside the box, and not if
// they are well outside. Returns the number of points inside.
static int check_rays(CagSurface *const *list, size_t n, const CagQuadric *q, const CagBounds *box,
                      const CagBounds *cast) {
  int within = 0;
  for (int i = 0; i < 40; i++) {
    CagVec3 hits[2];
    const CagVec3 from =
        cag_vec3(random_in(cast->min.x, cast->max.x), random_in(cast->min.y, cast->max.y),
                 random_in(cast->min.z, cast->max.z));
    const int count = ray(q, from, i % 3, hits);
    for (int k = 0; k < count; k++) {
      const bool in = lies_in(box, hits[k], -1e-6), out = !lies_in(box, hits[k], 1e-6);
      bool on = false;
      for (size_t s = 0; s < n; s++) on = on || is_on(list[s], hits[k]);
      if (in && !on)
        fail_msg("[%g, %g, %g] is in the box, but not on the result", hits[k].x, hits[k].y,
                 hits[k].z);
      if (out && on) fail_msg("[%g, %g, %g] is on the result", hits[k].x, hits[k].y, hits[k].z);
      within += in;
    }
  }
  return within;
}

static void release(CagSurface **list, size_t n) {
  for (size_t i = 0; i < n; i++) cag_surface_release(list[i]);
  free(list);
}

#ifndef ROUNDS
#define ROUNDS 4
#endif

static void boxes_cut_quadrics_of_all_classes(void **state) {
  (void)state;
  int cut = 0, outside = 0;
  for (int i = 0; i < ROUNDS * CLASSES; i++) {
    state_of_random = 1000 + (uint64_t)i;
    const int class_id = i % CLASSES;
    const CagQuadric q = random_quadric(UNITS[class_id], i / CLASSES % 3 != 0);
    const CagVec3 corner = cag_vec3(random_in(-3, 0.5), random_in(-3, 0.5), random_in(-3, 0.5));
    const CagBounds box = {
        corner, cag_add(corner, cag_vec3(random_in(0.3, 4), random_in(0.3, 4), random_in(0.3, 4)))};
    CagSurface **list = NULL;
    size_t n = 0;
    CagError why;
    if (cag_quadric_patches(&q, &box, false, &list, &n, &why)) {
      assert_string_equal(cag_error_info(why.id)->reason,
                          class_id < REAL ? "quadric-outside" : "quadric-imaginary");
      if (class_id < REAL) assert_int_equal(check_rays(NULL, 0, &q, &box, &box), 0);
      outside += class_id < REAL;
      continue;
    }
    check_points(list, n, &q, &box, i / CLASSES % 4 == 0);
    // Double planes have no simple points on rays.
    cut += check_rays(list, n, &q, &box, &box) > 0 || class_id == REAL - 1;
    const CagBounds around = {cag_sub(box.min, cag_vec3(1, 1, 1)),
                              cag_add(box.max, cag_vec3(1, 1, 1))};
    check_rays(list, n, &q, &box, &around);
    release(list, n);
  }
  assert_true(cut > ROUNDS * REAL / 2 && outside > 0);
}

static void ranges_of_z_are_those_of_the_equation(void **state) {
  (void)state;
  int bounded = 0, unbounded = 0;
  for (int i = 0; i < ROUNDS * REAL; i++) {
    state_of_random = 5000 + (uint64_t)i;
    const CagQuadric q = random_quadric(UNITS[i % REAL], true);
    const double z = random_in(-2, 0.5), high = z + random_in(0.3, 3);
    const CagBounds range = {{0, 0, z}, {0, 0, high}};
    const CagBounds slab = {{-INFINITY, -INFINITY, z}, {INFINITY, INFINITY, high}};
    const CagBounds cast = {{-4, -4, z}, {4, 4, high}};
    CagSurface **list = NULL;
    size_t n = 0;
    CagError why;
    if (cag_quadric_patches(&q, &range, true, &list, &n, &why)) {
      const bool ends = strcmp(cag_error_info(why.id)->reason, "quadric-outside") == 0;
      if (ends) assert_int_equal(check_rays(NULL, 0, &q, &slab, &cast), 0);
      else assert_string_equal(cag_error_info(why.id)->reason, "quadric-unbounded");
      unbounded += !ends;
      continue;
    }
    bounded++;
    check_points(list, n, &q, &slab, i % 4 == 0);
    check_rays(list, n, &q, &slab, &cast);
    release(list, n);
  }
  assert_true(bounded > ROUNDS && unbounded > ROUNDS);
}

static size_t outline_points(const CagSurface *s) {
  const CagRegion *region;
  size_t sum = 0;
  if (!cag_surface_trimmed_view(s, NULL, &region)) return 0;
  for (size_t i = 0; i < region->count; i++) {
    CagNurbsView v;
    assert_true(cag_curve_nurbs_view(region->loops[i], &v));
    sum += v.count;
  }
  return sum;
}

// A paraboloid r^2 = t about an axis at a small angle a to the horizontal. With w perpendicular to
// the axis, z = t sin a + w cos a and y = w sin a - t cos a. The planes z = 1 and z = -1 cut it in
// circles of (x, w) with center - cot a / 2 and radius sqrt(cot^2 a / 4 +- 1 / sin a). The largest
// y is sin^2 a / (4 cos a), at w = tan a / 2. The smallest y is at the far side of the larger
// circle.
static void outlines_that_are_nearly_level_stay_small(void **state) {
  (void)state;
  const double angles[] = {0.1, 0.01, 0.001};
  for (int i = 0; i < 3; i++) {
    const double a = angles[i], c = cos(a), s = sin(a);
    // t = z s - y c and w = y s + z c.
    const CagQuadric q = {{1, s * s, c * c, 0, 2 * s * c, 0, 0, c, -s, 0}};
    const CagBounds range = {{0, 0, -1}, {0, 0, 1}};
    CagSurface **list = NULL;
    size_t n = 0;
    CagBounds b;
    MUST(cag_quadric_patches(&q, &range, true, &list, &n, err));
    assert_int_equal(n, 1);
    const size_t count = outline_points(list[0]);
    assert_true(count > 0 && count < 20000);
    MUST(cag_surface_bounds(list[0], &b, err));
    const double r = sqrt(c * c / (4 * s * s) + 1 / s), far = -c / (2 * s) - r;
    // Accurate up to the rounding of the largest coordinate.
    const double size = far * far, slack = 1e-11 + 1e-14 * size;
    assert_near(b.max.x, r, slack, "x");
    assert_near(b.min.x, -r, slack, "-x");
    assert_near(b.max.y, s * s / (4 * c), slack, "y");
    assert_near(b.min.y, far * s - (1 - far * c) / s * c, slack, "-y");
    assert_near(b.max.z, 1, slack, "z");
    assert_near(b.min.z, -1, slack, "-z");
    release(list, n);
  }
}

static double area_of(const double c[10], const CagBounds *box, bool z_only) {
  CagQuadric q;
  CagSurface **list = NULL;
  size_t n = 0;
  double sum = 0, one = 0;
  memcpy(q.c, c, sizeof q.c);
  MUST(cag_quadric_patches(&q, box, z_only, &list, &n, err));
  for (size_t i = 0; i < n; i++) {
    MUST(cag_surface_area(list[i], &one, NULL, err));
    sum += one;
  }
  release(list, n);
  return sum;
}

static void areas_within_boxes_have_closed_forms(void **state) {
  (void)state;
  // A sphere of radius 5 in a cube of 8 loses six caps of height 1.
  const double sphere[10] = {1, 1, 1, 0, 0, 0, 0, 0, 0, -25};
  const CagBounds cube = {{-4, -4, -4}, {4, 4, 4}};
  assert_near(area_of(sphere, &cube, false), 2 * M_PI * 5 * (10 - 6), 1e-9, "sphere");
  // A cone of 45 degrees over a rectangle of 4 by 6: sqrt 2 times its area, for each nappe.
  const double cone[10] = {1, 1, -1, 0, 0, 0, 0, 0, 0, 0};
  const CagBounds shaft = {{-2, -3, -9}, {2, 3, 9}};
  assert_near(area_of(cone, &shaft, false), 2 * sqrt(2) * 24, 1e-9, "cone");
  // A cylinder of radius 1 along X, z from 0 to 1 / 2 and 0 <= x <= 3: two strips of 30 degrees.
  const double pipe[10] = {0, 1, 1, 0, 0, 0, 0, 0, 0, -1};
  const CagBounds half = {{0, -2, 0}, {3, 2, 0.5}};
  assert_near(area_of(pipe, &half, false), 3 * M_PI / 3, 1e-9, "pipe");
  // y^2 = 4 x from x = 1 to x = 4, on both sides: arcs of length [t sqrt(1 + t^2) + asinh t].
  const double parabolic[10] = {0, 1, 0, 0, 0, 0, -4, 0, 0, 0};
  const CagBounds slice = {{1, -9, 0}, {4, 9, 2}};
  const double arc = 2 * sqrt(5) + asinh(2) - sqrt(2) - asinh(1);
  assert_near(area_of(parabolic, &slice, false), 2 * 2 * arc, 1e-9, "parabolic cylinder");
  // A cylinder of radius 1 whose axis is inclined by 45 degrees. Horizontal planes bound a range of
  // z of 2, so all rulings are 2 sqrt 2 long.
  const double leaning[10] = {1, 0.5, 0.5, 0, -1, 0, 0, 0, 0, -1};
  const CagBounds range = {{0, 0, -1}, {0, 0, 1}};
  assert_near(area_of(leaning, &range, true), 2 * M_PI * 2 * sqrt(2), 1e-9, "leaning cylinder");
}

// A cone or hyperboloid with the semi-axes a, b, c, rotated by an angle about its second or first
// axis. Planes of constant z meet it in ellipses if the tangent of the angle is below c / a or c /
// b.
static void ranges_of_z_bound_what_is_less_tilted_than_its_cone(void **state) {
  (void)state;
  state_of_random = 77;
  int bounded = 0;
  for (int round = 0; round < 90; round++) {
    const double *unit = UNITS[1 + round % 3];
    double semi[3];
    for (int k = 0; k < 3; k++) semi[k] = random_in(0.5, 2.5);
    const bool about_y = round % 2;
    const double limit = atan(semi[2] / semi[about_y ? 0 : 1]);
    const double angle = random_in(0.3, 1.9) * limit;
    if (fabs(angle / limit - 1) < 0.01 || angle > 1.5) continue;
    CagQuadric q, scaled;
    memcpy(q.c, unit, sizeof q.c);
    CagTransform size = cag_transform_identity(), turn;
    size.planar = false;
    for (int k = 0; k < 3; k++) size.m[k][k] = semi[k];
    MUST(cag_rotate(about_y ? cag_vec3(0, 1, 0) : cag_vec3(1, 0, 0), angle, cag_vec3(0, 0, 0),
                    &turn, err));
    MUST(cag_quadric_transform(&q, &size, &scaled, err));
    MUST(cag_quadric_transform(&scaled, &turn, &q, err));
    const CagBounds within = {cag_vec3(-INFINITY, -INFINITY, -7), cag_vec3(INFINITY, INFINITY, 9)};
    CagSurface **list;
    size_t n;
    if (angle < limit) {
      MUST(cag_quadric_patches(&q, &within, true, &list, &n, err));
      for (size_t i = 0; i < n; i++) cag_surface_release(list[i]);
      free(list);
      bounded++;
    } else {
      MUST_FAIL(cag_quadric_patches(&q, &within, true, &list, &n, err), "quadric-unbounded");
    }
  }
  assert_true(bounded > 20 && bounded < 70);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(boxes_cut_quadrics_of_all_classes),
      cmocka_unit_test(ranges_of_z_are_those_of_the_equation),
      cmocka_unit_test(ranges_of_z_bound_what_is_less_tilted_than_its_cone),
      cmocka_unit_test(outlines_that_are_nearly_level_stay_small),
      cmocka_unit_test(areas_within_boxes_have_closed_forms),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
