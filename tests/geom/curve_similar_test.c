// Curves of all kinds, scaled and with another domain, must behave the same: lengths are scaled,
// and all other results are unchanged. Powers of two preserve all digits, so absolute tolerances
// would show.

#include "geom/curve/approximate.h"
#include "tests/geom/curve_random.h"

static double scale, from, range;

// The scaled curve, over [from, from + range].
static CagCurve *image_of(const CagCurve *c) {
  CagTransform t;
  CagCurve *scaled, *out;
  OK(cag_scale(cag_vec3(scale, scale, scale), cag_vec3(0, 0, 0), &t, &err));
  OK(cag_curve_transform(c, &t, &scaled, &err));
  OK(cag_curve_reparametrize(scaled, from, from + range, &out, &err));
  cag_curve_release(scaled);
  return out;
}

static double domain_fraction(const CagCurve *c, double t) {
  return (t - c->start) / (c->end - c->start);
}

static void each_image(int rounds, void (*check)(const CagCurve *c, const CagCurve *image)) {
  static const int powers[] = {-18, 15, -7, 9};
  for (int round = 0; round < rounds; round++) {
    scale = ldexp(1, powers[round % 4]);
    range = ldexp(1, powers[(round + 1 + round / 4) % 4]);
    from = round % 3 * range;
    for (Kind kind = 0; kind < KINDS; kind++) {
      CagCurve *c = random_curve(kind), *image = image_of(c);
      check(c, image);
      cag_curve_release(c);
      cag_curve_release(image);
    }
  }
}

static void check_lengths(const CagCurve *c, const CagCurve *image) {
  double a = uniform(0, 1), b = uniform(0, 1), before, after, t, u;
  if (a > b) {
    t = a;
    a = b;
    b = t;
  }
  OK(cag_curve_length(c, c->start + a * (c->end - c->start), c->start + b * (c->end - c->start),
                      &before, &err));
  OK(cag_curve_length(image, from + a * range, from + b * range, &after, &err));
  NEAR(after / scale, before, 1e-11 * before);
  OK(cag_curve_parameter_at_length(c, before, &t, &err));
  OK(cag_curve_parameter_at_length(image, after, &u, &err));
  CagVec3 p, q;
  OK(cag_curve_point(c, t, &p, &err));
  OK(cag_curve_point(image, u, &q, &err));
  near_vec(cag_scaled(q, 1 / scale), p, 1e-10 * (1 + cag_norm(p)));
}

static void lengths_are_scaled(void **state) {
  (void)state;
  seed = 501;
  each_image(24, check_lengths);
}

static void check_bounds(const CagCurve *c, const CagCurve *image) {
  CagBounds before, after;
  OK(cag_curve_bounds(c, &before, &err));
  OK(cag_curve_bounds(image, &after, &err));
  const double size = cag_norm(cag_sub(before.max, before.min));
  near_vec(cag_scaled(after.min, 1 / scale), before.min, 1e-10 * size);
  near_vec(cag_scaled(after.max, 1 / scale), before.max, 1e-10 * size);
}

static void boxes_are_scaled(void **state) {
  (void)state;
  seed = 502;
  each_image(24, check_bounds);
}

static void check_closest(const CagCurve *c, const CagCurve *image) {
  const CagVec3 p = random_point(6);
  CagVec3 foot, there;
  double t, u, distance, away;
  OK(cag_curve_closest(c, p, &t, &foot, &distance, &err));
  OK(cag_curve_closest(image, cag_scaled(p, scale), &u, &there, &away, &err));
  NEAR(away / scale, distance, 1e-12 * (1 + distance));
  near_vec(cag_scaled(there, 1 / scale), foot, 1e-6);
  NEAR(domain_fraction(image, u), domain_fraction(c, t), 1e-6);
}

static void nearest_points_are_scaled(void **state) {
  (void)state;
  seed = 503;
  each_image(24, check_closest);
}

static void check_steps(const CagCurve *c, const CagCurve *image) {
  const double tolerance = pow(10, uniform(-5, -1)), angle = uniform(0.1, 1);
  double *t, *u;
  size_t n, m;
  OK(cag_curve_discretize(c, tolerance, angle, &t, &n, &err));
  OK(cag_curve_discretize(image, scale * tolerance, angle, &u, &m, &err));
  // A step close to the limit may be halved or not, depending on the rounding of a parameter.
  assert_true(n <= m + 2 && m <= n + 2);
  for (size_t i = 0; n == m && i < n; i++)
    NEAR(domain_fraction(image, u[i]), domain_fraction(c, t[i]), 1e-9);
  free(t);
  free(u);
}

static void steps_are_the_same(void **state) {
  (void)state;
  seed = 504;
  each_image(24, check_steps);
}

static void check_frames(const CagCurve *c, const CagCurve *image) {
  const double at = uniform(0, 1);
  CagFrenet before, after;
  OK(cag_curve_frenet(c, c->start + at * (c->end - c->start), &before, &err));
  OK(cag_curve_frenet(image, from + at * range, &after, &err));
  near_vec(after.tangent, before.tangent, 1e-12);
  assert_int_equal(after.has_normal, before.has_normal);
  NEAR(after.curvature * scale, before.curvature, 1e-10 * (1 + before.curvature));
  if (!before.has_normal) return;
  near_vec(after.normal, before.normal, 1e-9);
  near_vec(after.binormal, before.binormal, 1e-9);
  NEAR(after.torsion * scale, before.torsion, 1e-8 * (1 + fabs(before.torsion)));
}

static void frames_are_the_same_and_curvatures_divided(void **state) {
  (void)state;
  seed = 505;
  each_image(24, check_frames);
}

// A curve that is flattened to 1e-11 of its size is planar, and with two directions flattened, it
// is straight. Flattened to 1e-4, it is neither, unless it was so before.
static void check_flatness(const CagCurve *c, const CagCurve *image) {
  bool planar, straight;
  CagPlane plane;
  OK(cag_curve_is_planar(c, &planar, NULL, &err));
  OK(cag_curve_is_straight(c, &straight, &err));
  for (int i = 0; i < 4; i++) {
    const double flat = i % 2 ? 1e-11 : 1e-4, across = i / 2 ? flat : 1;
    CagTransform squeeze, turn = random_frame();
    CagCurve *squeezed, *turned;
    for (int k = 0; k < 3; k++) turn.m[k][3] *= scale;
    OK(cag_scale(cag_vec3(1, across, flat), cag_vec3(0, 0, 0), &squeeze, &err));
    OK(cag_curve_transform(image, &squeeze, &squeezed, &err));
    OK(cag_curve_transform(squeezed, &turn, &turned, &err));
    bool now;
    OK(cag_curve_is_planar(turned, &now, &plane, &err));
    // With two directions squeezed to 1e-4, the deviation from the plane may be less than 1e-9 or
    // not.
    if (i != 2) assert_int_equal(now, planar || flat < 1e-9);
    if (now) {
      NEAR(cag_norm(plane.normal), 1, 1e-14);
      for (int k = 0; k <= 20; k++) {
        CagVec3 p;
        OK(cag_curve_point(turned, from + range * k / 20, &p, &err));
        NEAR(cag_dot(cag_sub(p, plane.point), plane.normal), 0, 1e-7 * scale);
      }
    }
    OK(cag_curve_is_straight(turned, &now, &err));
    assert_int_equal(now, straight || (i / 2 && flat < 1e-9));
    cag_curve_release(squeezed);
    cag_curve_release(turned);
  }
}

static void flat_and_straight_curves_are_known(void **state) {
  (void)state;
  seed = 506;
  each_image(24, check_flatness);
}

// Closed curves in a random plane. The expected area is that of fine chords, scaled.
static void check_area(const CagCurve *c, const CagCurve *image) {
  if (!c->closed) return;
  CagTransform squeeze, turn = random_frame();
  CagCurve *flat, *image_flat, *turned, *image_turned;
  OK(cag_scale(cag_vec3(1, 1, 1e-12), cag_vec3(0, 0, 0), &squeeze, &err));
  OK(cag_curve_transform(c, &squeeze, &flat, &err));
  OK(cag_curve_transform(image, &squeeze, &image_flat, &err));
  OK(cag_curve_transform(flat, &turn, &turned, &err));
  for (int k = 0; k < 3; k++) turn.m[k][3] *= scale;
  OK(cag_curve_transform(image_flat, &turn, &image_turned, &err));
  enum { CHORDS = 20000 };
  double sum = 0, area, scaled_area;
  CagVec3 last, moment = {0, 0, 0}, center, scaled_center, first;
  OK(cag_curve_point(flat, flat->start, &last, &err));
  first = last;
  for (int i = 1; i <= CHORDS; i++) {
    CagVec3 p;
    OK(cag_curve_point(
        flat, i == CHORDS ? flat->end : flat->start + (flat->end - flat->start) * i / CHORDS, &p,
        &err));
    const CagVec3 a = cag_sub(last, first), b = cag_sub(p, first);
    const double twice = a.x * b.y - a.y * b.x;
    sum += twice / 2;
    moment = cag_madd(moment, twice / 6, cag_add(a, b));
    last = p;
  }
  OK(cag_curve_area(turned, &area, &center, &err));
  OK(cag_curve_area(image_turned, &scaled_area, &scaled_center, &err));
  NEAR(area, fabs(sum), 1e-5 * (1 + fabs(sum)));
  NEAR(scaled_area / (scale * scale), area, 1e-10 * (1 + area));
  for (int k = 0; k < 3; k++) turn.m[k][3] /= scale;
  if (fabs(sum) > 0.5) {
    const CagVec3 g = cag_madd(first, 1 / sum, moment);
    near_vec(center,
             cag_vec3(turn.m[0][0] * g.x + turn.m[0][1] * g.y + turn.m[0][3],
                      turn.m[1][0] * g.x + turn.m[1][1] * g.y + turn.m[1][3],
                      turn.m[2][0] * g.x + turn.m[2][1] * g.y + turn.m[2][3]),
             1e-4);
    near_vec(cag_scaled(scaled_center, 1 / scale), center, 1e-9);
  }
  cag_curve_release(flat);
  cag_curve_release(image_flat);
  cag_curve_release(turned);
  cag_curve_release(image_turned);
}

static void areas_are_those_of_fine_chords_and_scaled(void **state) {
  (void)state;
  seed = 507;
  each_image(16, check_area);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lengths_are_scaled),
      cmocka_unit_test(boxes_are_scaled),
      cmocka_unit_test(nearest_points_are_scaled),
      cmocka_unit_test(steps_are_the_same),
      cmocka_unit_test(frames_are_the_same_and_curvatures_divided),
      cmocka_unit_test(flat_and_straight_curves_are_known),
      cmocka_unit_test(areas_are_those_of_fine_chords_and_scaled),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
