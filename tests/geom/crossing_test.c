// Surfaces that cross themselves: found where simple measures of random profiles, paths and tubes
// tell so, and only there.

#include "geom/meet/crossing.h"

#include <stdio.h>

#include "geom/surface/swept.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

static char what[300];

// Where the segments ab and cd cross, as fractions of both.
static bool cut(CagVec3 a, CagVec3 b, CagVec3 c, CagVec3 d, double part[2]) {
  const CagVec3 u = cag_sub(b, a), v = cag_sub(d, c), w = cag_sub(c, a);
  const double det = u.x * v.z - u.z * v.x;
  part[0] = (w.x * v.z - w.z * v.x) / det;
  part[1] = (w.x * u.z - w.z * u.x) / det;
  return part[0] > 0 && part[0] < 1 && part[1] > 0 && part[1] < 1;
}

// Three segments in the half plane y = 0, x > 0: the first and the last cross or not. The surface
// is anywhere in space.
static void profiles_cross_where_their_segments_do(void **state) {
  (void)state;
  seed = 11;
  int crossing = 0, clear = 0;
  for (int round = 0; round < 400; round++) {
    CagVec3 p[4], axis, through;
    for (int i = 0; i < 4; i++) {
      const double x = uniform(1, 9), z = uniform(-5, 5);
      p[i] = cag_vec3(x, 0, z);
    }
    double part[2];
    const bool crosses = cut(p[0], p[1], p[2], p[3], part);
    // Decided by more than the spacing of the samples.
    const double off = fmax(fmax(-part[0], part[0] - 1), fmax(-part[1], part[1] - 1));
    if (fabs(off) < 0.05) continue;
    CagTransform map;
    const double angle = uniform(0, 3);
    axis.x = uniform(-1, 1);
    axis.y = uniform(-1, 1);
    axis.z = uniform(-1, 1);
    through.x = uniform(-9, 9);
    through.y = uniform(-9, 9);
    through.z = uniform(-9, 9);
    OK(cag_rotate(axis, angle, cag_vec3(0, 0, 0), &map, &err));
    for (int i = 0; i < 4; i++) p[i] = cag_add(cag_transform_point(&map, p[i]), through);
    CagCurve *profile;
    CagSurface *s;
    OK(cag_curve_polyline(p, 4, false, 3, &profile, &err));
    OK(cag_surface_revolve(profile, cag_transform_vector(&map, cag_vec3(0, 0, uniform(0.5, 2))),
                           through, 0, 2 * M_PI, &s, &err));
    const bool found = cag_surface_crosses_itself(s, what, sizeof what);
    if (found != crosses) fail_msg("round %d: crosses %d, found %d", round, crosses, found);
    crosses ? crossing++ : clear++;
    if (found) {
      // The place of the crossing, to the length of a sample.
      double x, z;
      assert_int_equal(
          sscanf(what, "its profile crosses itself near %lf from the axis, %lf", &x, &z), 2);
      const CagVec3 at = cag_lerp(p[0], p[1], part[0]);
      const CagVec3 out = cag_sub(at, through);
      const double height = cag_dot(out, cag_transform_vector(&map, cag_vec3(0, 0, 1)));
      const double sample = cag_norm(cag_sub(p[1], p[0])) * 3 / 400 + 0.005;
      NEAR(x, sqrt(cag_dot(out, out) - height * height), sample);
      NEAR(z, height, sample);
    }
    cag_surface_release(s);
    cag_curve_release(profile);
  }
  assert_true(crossing > 40 && clear > 40);
}

static CagCurve *ellipse(double a, double b, double from, double to, CagVec3 center) {
  CagCurve *c;
  CagTransform frame = cag_transform_identity();
  frame.m[0][3] = center.x;
  frame.m[1][3] = center.y;
  frame.m[2][3] = center.z;
  OK(cag_curve_arc(a, b, from, to, &frame, &c, &err));
  return c;
}

static CagSurface *swept(const CagCurve *section, const CagCurve *path, const CagAlong *scale) {
  const CagPathMotion how = {.orient = CAG_ORIENT_RMF,
                             .twist = {0, 0, NULL},
                             .scale = scale ? *scale : (CagAlong){1, 1, NULL}};
  CagMotion *motion;
  CagSurface *s;
  OK(cag_motion_along(path, &how, &motion, &err));
  OK(cag_surface_sweep(section, motion, &s, &err));
  cag_motion_release(motion);
  return s;
}

static CagCurve *in_space(CagCurve *c) {
  CagTransform turn;
  CagCurve *out;
  OK(cag_rotate(cag_vec3(1, 2, 2), 0.8, cag_vec3(1, 0, 3), &turn, &err));
  OK(cag_curve_transform(c, &turn, &out, &err));
  cag_curve_release(c);
  return out;
}

// The smallest radius of curvature of an ellipse is b^2 / a. A circle reaches its radius towards
// the center of curvature, an open arc no farther than its points.
static void sweeps_fold_beyond_the_center_of_curvature(void **state) {
  (void)state;
  seed = 12;
  for (int round = 0; round < 120; round++) {
    const double a = uniform(5, 9), b = uniform(3, 5), tightest = b * b / a;
    const double beyond = round % 2 ? uniform(1.02, 2.5) : uniform(0.3, 0.98);
    const double scale = uniform(0.5, 2);
    CagCurve *path = in_space(ellipse(a, b, -0.5, 0.7, cag_vec3(0, 0, 0)));
    CagCurve *section = ellipse(beyond * tightest / scale, beyond * tightest / scale, 0, 2 * M_PI,
                                cag_vec3(0, 0, 0));
    CagSurface *s = swept(section, path, &(CagAlong){scale, scale, NULL});
    const bool folds = cag_surface_crosses_itself(s, what, sizeof what);
    assert_int_equal(folds, beyond > 1);
    if (folds) {
      double times;
      assert_int_equal(sscanf(what, "its section reaches %lf times as far", &times), 1);
      // The first place that folds, before the tightest one: at most as far, and by samples.
      assert_true(times > 0.99 && times < beyond * 1.006);
    }
    cag_surface_release(s);
    cag_curve_release(section);
    cag_curve_release(path);
  }
  // On a circle all places are alike: 64 samples of the section meet its farthest point to 0.12 %.
  for (int round = 0; round < 40; round++) {
    const double radius = uniform(2, 6), beyond = uniform(1.02, 3);
    CagCurve *path = in_space(ellipse(radius, radius, 0, 2, cag_vec3(0, 0, 0)));
    const double r = beyond * radius;
    CagCurve *section = ellipse(r, r, 0, 2 * M_PI, cag_vec3(0, 0, 0));
    CagSurface *s = swept(section, path, NULL);
    double times, at;
    assert_true(cag_surface_crosses_itself(s, what, sizeof what));
    assert_int_equal(
        sscanf(
            what,
            "its section reaches %lf times as far as the center of curvature of the path at v = %lf",
            &times, &at),
        2);
    NEAR(times, beyond, 0.01 * beyond);
    NEAR(at, 0, 0);
    cag_surface_release(s);
    cag_curve_release(section);
    cag_curve_release(path);
  }
}

// The distance of a point of a helix from the next turn, over all of that turn.
static double turn_distance(double radius, double pitch) {
  double least = INFINITY;
  for (int i = 0; i <= 20000; i++) {
    const double angle = M_PI + 2 * M_PI * i / 20000;
    const double chord = 2 * radius * sin(angle / 2), rise = pitch * angle / (2 * M_PI);
    least = fmin(least, hypot(chord, rise));
  }
  return least;
}

static void tubes_meet_where_turns_are_nearer_than_they_are_thick(void **state) {
  (void)state;
  seed = 13;
  for (int round = 0; round < 60; round++) {
    const double radius = uniform(5, 9), pitch = uniform(1, 4);
    const double half = turn_distance(radius, pitch) / 2;
    const double thick = half * (round % 2 ? uniform(1.01, 1.3) : uniform(0.5, 0.985));
    CagCurve *path;
    CagSurface *s;
    OK(cag_curve_helix(radius, pitch, 2.5, 0, &path, &err));
    path = in_space(path);
    // As a tube, and as a circle swept along and scaled.
    if (round % 3 == 0) {
      OK(cag_surface_tube(path, thick, &s, &err));
    } else {
      const double scale = uniform(0.5, 2);
      CagCurve *section = ellipse(thick / scale, thick / scale, 0, 2 * M_PI, cag_vec3(0, 0, 0));
      s = swept(section, path, &(CagAlong){scale, scale, NULL});
      cag_curve_release(section);
    }
    const bool meets = cag_surface_crosses_itself(s, what, sizeof what);
    if (meets != (thick > half)) fail_msg("round %d: %g of %g: %d", round, thick, half, meets);
    if (meets) {
      double v, apart, other, thickness;
      assert_int_equal(
          sscanf(what,
                 "its path at v = %lfdeg is %lf from that at v = %lfdeg, where the tube is %lf", &v,
                 &apart, &other, &thickness),
          4);
      NEAR(thickness, 2 * thick, 1e-3 * thick);
      assert_true(apart < thickness);
      const double angle = (other - v) * M_PI / 180;
      NEAR(apart, hypot(2 * radius * sin(angle / 2), pitch * angle / (2 * M_PI)), 0.02 * apart);
    }
    cag_surface_release(s);
    cag_curve_release(path);
  }
}

// Two straight parts beside each other, joined by a wide bend: a tube that gets thicker meets
// itself where both radii together are the distance.
static void tapering_tubes_meet_where_they_are_thick(void **state) {
  (void)state;
  seed = 14;
  for (int round = 0; round < 40; round++) {
    const double apart = uniform(2, 4);
    const CagVec3 p[] = {{0, 0, 0},      {15, 0, 0},         {30, 0, 0},
                         {40, -6, 0},    {50, apart / 2, 0}, {40, apart + 6, 0},
                         {30, apart, 0}, {15, apart, 0},     {0, apart, 0}};
    CagCurve *path, *section;
    const double knots[] = {0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 7, 7};
    OK(cag_curve_nurbs(p, NULL, 9, 2, knots, 3, &path, &err));
    // Constant but for a taper that ends at less: the sum of both radii is the same along it.
    const double both = apart * (round % 2 ? 1.03 : 0.97), end = uniform(0.2, 0.5) * both;
    section = ellipse(1, 1, 0, 2 * M_PI, cag_vec3(0, 0, 0));
    CagSurface *s = swept(section, path, &(CagAlong){both - end, end, NULL});
    const bool meets = cag_surface_crosses_itself(s, what, sizeof what);
    assert_int_equal(meets, both > apart);
    cag_surface_release(s);
    cag_curve_release(section);
    cag_curve_release(path);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(profiles_cross_where_their_segments_do),
      cmocka_unit_test(sweeps_fold_beyond_the_center_of_curvature),
      cmocka_unit_test(tubes_meet_where_turns_are_nearer_than_they_are_thick),
      cmocka_unit_test(tapering_tubes_meet_where_they_are_thick),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
