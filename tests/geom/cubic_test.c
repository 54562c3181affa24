// Cubic splines, Hermite segments, blends, joints, and hulls, compared with numbers of the
// reference (05a) and identities.

#include "geom/curve/cubic.h"
#include "geom/curve/hulls.h"
#include "geom/curve/joint.h"
#include "geom/curve/nurbs_ops.h"
#include "random.h"
#include "support.h"

// The points of the reference's examples 2, 3, 5 and 6.
static const CagVec3 zigzag[4] = {{0, 0, 0}, {1, 1, 0}, {2, -1, 0}, {3, 0, 0}};
static const CagVec3 loop[5] = {{0, 0, 0}, {2, 1, 0}, {3, 3, 0}, {1, 4, 0}, {0, 0, 0}};
static const CagCubicEnds relaxed = {.closing = CAG_CUBIC_ENDS};
static const CagCubicEnds diagonal = {
    .closing = CAG_CUBIC_ENDS, .clamped = {true, true}, .tangent = {{1, 1, 0}, {1, 1, 0}}};

static CagVec3 at(const CagCurve *c, double t) {
  CagVec3 p;
  OK(cag_curve_point(c, t, &p, &err));
  return p;
}

static CagVec3 derived(const CagCurve *c, double t, int order, CagSide side) {
  CagVec3 d[4];
  OK(cag_curve_eval(c, t, order, side, d, &err));
  return d[order];
}

static void clamped_splines_have_the_tangents_of_the_reference(void **state) {
  (void)state;
  double u[4];
  CagVec3 d[4];
  OK(cag_spacing_parameters(zigzag, 4, CAG_SPACING_CHORD, u, &err));
  OK(cag_cubic_tangents(zigzag, 4, u, &diagonal, NULL, d, &err));
  // The reference prints five decimals.
  near_vec(d[1], cag_vec3(0.50543, -0.14772, 0), 1e-5);
  near_vec(d[2], cag_vec3(0.50543, -0.14772, 0), 1e-5);
  OK(cag_spacing_parameters(zigzag, 4, CAG_SPACING_UNIFORM, u, &err));
  OK(cag_cubic_tangents(zigzag, 4, u, &diagonal, NULL, d, &err));
  near_vec(d[1], cag_vec3(1, -0.8, 0), 1e-14);
  near_vec(d[2], cag_vec3(1, -0.8, 0), 1e-14);
}

static void splines_pass_their_points_and_are_smooth(void **state) {
  (void)state;
  const CagSpacing spacings[] = {CAG_SPACING_CHORD, CAG_SPACING_UNIFORM, CAG_SPACING_CENTRIPETAL};
  const CagCubicEnds ends[] = {
      relaxed, diagonal, {.closing = CAG_CUBIC_CYCLIC}, {.closing = CAG_CUBIC_ANTICYCLIC}};
  for (int s = 0; s < 3; s++)
    for (int e = 0; e < 4; e++) {
      double u[5];
      CagCurve *c;
      OK(cag_spacing_parameters(loop, 5, spacings[s], u, &err));
      OK(cag_curve_cubic_spline(loop, 5, u, &ends[e], NULL, 2, &c, &err));
      assert_int_equal(c->dimension, 2);
      for (int i = 0; i < 5; i++) near_vec(at(c, u[i]), loop[i], 1e-13);
      for (int i = 1; i < 4; i++)
        near_vec(derived(c, u[i], 2, CAG_SIDE_LEFT), derived(c, u[i], 2, CAG_SIDE_RIGHT), 1e-11);
      for (int k = 1; k <= 2; k++) {
        CagVec3 first = derived(c, c->start, k, CAG_SIDE_RIGHT);
        CagVec3 last = derived(c, c->end, k, CAG_SIDE_LEFT);
        if (ends[e].closing == CAG_CUBIC_CYCLIC) near_vec(first, last, 1e-11);
        if (ends[e].closing == CAG_CUBIC_ANTICYCLIC) near_vec(first, cag_scaled(last, -1), 1e-11);
      }
      if (e == 0) near_vec(derived(c, c->start, 2, CAG_SIDE_RIGHT), cag_vec3(0, 0, 0), 1e-12);
      cag_curve_release(c);
    }
}

// For n = 2 and n = 3, the system has no inner rows.
static void the_shortest_splines_are_the_reference_s(void **state) {
  (void)state;
  const CagVec3 two[2] = {{0, 0, 0}, {3, 4, 0}};
  const double u[2] = {0, 5};
  CagVec3 d[5];
  CagCubicEnds ends = {.closing = CAG_CUBIC_CYCLIC};
  OK(cag_cubic_tangents(two, 2, u, &ends, NULL, d, &err));
  near_vec(d[1], cag_vec3(0.6, 0.8, 0), 1e-15);
  ends.closing = CAG_CUBIC_ANTICYCLIC;
  OK(cag_cubic_tangents(two, 2, u, &ends, NULL, d, &err));
  near_vec(d[0], cag_vec3(0, 0, 0), 0);
  OK(cag_cubic_tangents(two, 2, u, &relaxed, NULL, d, &err));
  near_vec(d[0], cag_vec3(0.6, 0.8, 0), 1e-15);
  ends = (CagCubicEnds){.closing = CAG_CUBIC_ENDS, .clamped = {true}, .tangent = {{1, 0, 0}}};
  OK(cag_cubic_tangents(two, 2, u, &ends, NULL, d, &err));
  near_vec(d[1], cag_vec3(1.5 * 0.6 - 0.5, 1.5 * 0.8, 0), 1e-15);
  // Three points: P'_2 by hand from the two rows of the cyclic system, with lengths 1 and 2.
  const double v[3] = {0, 1, 3};
  const CagVec3 three[3] = {{0, 0, 0}, {1, 3, 0}, {0, 0, 0}};
  ends = (CagCubicEnds){.closing = CAG_CUBIC_CYCLIC};
  CagCurve *c;
  OK(cag_curve_cubic_spline(three, 3, v, &ends, NULL, 2, &c, &err));
  for (int k = 1; k <= 2; k++) {
    near_vec(derived(c, 0, k, CAG_SIDE_RIGHT), derived(c, 3, k, CAG_SIDE_LEFT), 1e-13);
    near_vec(derived(c, 1, k, CAG_SIDE_RIGHT), derived(c, 1, k, CAG_SIDE_LEFT), 1e-13);
  }
  cag_curve_release(c);
  // Anticyclic: P'_1 = 81/70 P_2 and P'_2 = 39/70 P_2 make the second derivatives equal at P_2,
  // -51/35 P_2, and opposite at the ends, 9/35 P_2.
  ends.closing = CAG_CUBIC_ANTICYCLIC;
  OK(cag_cubic_tangents(three, 3, v, &ends, NULL, d, &err));
  near_vec(d[0], cag_scaled(three[1], 81.0 / 70), 1e-14);
  near_vec(d[1], cag_scaled(three[1], 39.0 / 70), 1e-14);
  near_vec(d[2], cag_scaled(three[1], -81.0 / 70), 1e-14);
}

static void a_cubic_is_its_own_clamped_spline(void **state) {
  (void)state;
  const double u[6] = {0, 0.2, 0.25, 1, 3, 3.5};
  CagVec3 p[6], d[6];
  for (int i = 0; i < 6; i++) {
    const double t = u[i];
    p[i] = cag_vec3(t * t * t - t, 2 * t * t, 5 - t);
    d[i] = cag_vec3(3 * t * t - 1, 4 * t, -1);
  }
  const CagCubicEnds ends = {
      .closing = CAG_CUBIC_ENDS, .clamped = {true, true}, .tangent = {d[0], d[5]}};
  CagCurve *c;
  OK(cag_curve_cubic_spline(p, 6, u, &ends, NULL, 3, &c, &err));
  for (int k = 0; k <= 20; k++) {
    const double t = 3.5 * k / 20;
    near_vec(at(c, t), cag_vec3(t * t * t - t, 2 * t * t, 5 - t), 1e-12);
  }
  cag_curve_release(c);
}

static void chords_of_any_ratio_keep_the_points(void **state) {
  (void)state;
  const CagVec3 p[5] = {{0, 0, 0}, {1e-5, 1e-5, 0}, {1, 0, 0}, {1.000001, 0, 0}, {100, 3, 0}};
  double u[5];
  CagCurve *c;
  OK(cag_spacing_parameters(p, 5, CAG_SPACING_CHORD, u, &err));
  OK(cag_curve_cubic_spline(p, 5, u, &relaxed, NULL, 2, &c, &err));
  for (int i = 0; i < 5; i++) near_vec(at(c, u[i]), p[i], 1e-12);
  cag_curve_release(c);
}

static void tension_jumps_the_second_derivative_along_the_tangent(void **state) {
  (void)state;
  const double u[4] = {0, 1, 3, 4}, nu[2] = {2, 5};
  CagCurve *c;
  OK(cag_curve_cubic_spline(zigzag, 4, u, &relaxed, nu, 2, &c, &err));
  for (int i = 1; i < 3; i++) {
    CagVec3 jump = cag_sub(derived(c, u[i], 2, CAG_SIDE_RIGHT), derived(c, u[i], 2, CAG_SIDE_LEFT));
    near_vec(jump, cag_scaled(derived(c, u[i], 1, CAG_SIDE_RIGHT), nu[i - 1]), 1e-12);
  }
  cag_curve_release(c);
  const double negative[2] = {0, -1};
  FAILS_AT(cag_curve_cubic_spline(zigzag, 4, u, &relaxed, negative, 2, &c, &err), "bad-tension", 1);
}

static void bad_splines_are_told(void **state) {
  (void)state;
  const CagVec3 repeated[3] = {{0, 0, 0}, {1, 1, 0}, {1, 1, 0}};
  const double still[4] = {0, 1, 1, 2};
  double u[4];
  CagCurve *c;
  FAILS_AT(cag_spacing_parameters(repeated, 3, CAG_SPACING_CHORD, u, &err), "coincident-points", 2);
  OK(cag_spacing_parameters(repeated, 3, CAG_SPACING_UNIFORM, u, &err));
  FAILS(cag_spacing_parameters(repeated, 1, CAG_SPACING_UNIFORM, u, &err), "too-few-points");
  FAILS_AT(cag_curve_cubic_spline(zigzag, 4, still, &relaxed, NULL, 2, &c, &err),
           "bad-parameter-length", 2);
}

static void blends_have_the_points_of_the_reference(void **state) {
  (void)state;
  const double half[2] = {0.5, 0.5};
  CagCurve *c;
  OK(cag_curve_parabolic_blend(zigzag, 4, half, 1, CAG_BLEND_OPEN, 2, &c, &err));
  near_vec(at(c, 1.0 / 3), cag_vec3(4.0 / 3, 4.0 / 9, 0), 1e-14);
  near_vec(at(c, 2.0 / 3), cag_vec3(5.0 / 3, -4.0 / 9, 0), 1e-14);
  cag_curve_release(c);
  OK(cag_curve_parabolic_blend(zigzag, 4, NULL, 1, CAG_BLEND_OPEN, 2, &c, &err));
  NEAR(c->end, sqrt(5), 1e-15);
  near_vec(at(c, c->end / 3), cag_vec3(1.35970, 0.49583, 0), 1e-5);
  near_vec(at(c, c->end * 2 / 3), cag_vec3(1.64030, -0.49583, 0), 1e-5);
  cag_curve_release(c);
}

// Three points on a parabola: both arcs are on that parabola, regardless of the blend.
static void arcs_at_the_ends_are_parabolas(void **state) {
  (void)state;
  const CagVec3 p[3] = {{0, 0, 0}, {1, 1, 0}, {2, 4, 0}};
  const double half[1] = {0.5};
  CagCurve *c;
  OK(cag_curve_parabolic_blend(p, 3, half, 1, CAG_BLEND_PARABOLA, 2, &c, &err));
  for (int k = 0; k <= 20; k++) near_vec(at(c, 0.1 * k), cag_vec3(0.1 * k, 0.01 * k * k, 0), 1e-14);
  cag_curve_release(c);
}

static void closed_blends_meet_with_one_tangent(void **state) {
  (void)state;
  CagCurve *c;
  OK(cag_curve_parabolic_blend(loop, 4, NULL, 1, CAG_BLEND_CLOSED, 2, &c, &err));
  assert_true(c->closed);
  near_vec(derived(c, c->start, 1, CAG_SIDE_RIGHT), derived(c, c->end, 1, CAG_SIDE_LEFT), 1e-13);
  cag_curve_release(c);
  const double bad[2] = {0.5, 1};
  FAILS_AT(cag_curve_parabolic_blend(zigzag, 4, bad, 1, CAG_BLEND_OPEN, 2, &c, &err),
           "bad-blend-parameter", 1);
  FAILS_AT(cag_curve_parabolic_blend(loop, 5, NULL, 1, CAG_BLEND_CLOSED, 2, &c, &err),
           "coincident-points", 0);
}

// Figure 10 of the reference: both tangents at 45 degrees to a chord of length 1.
static void the_magnitude_of_tangents_decides_the_shape(void **state) {
  (void)state;
  const CagVec3 p = {0, 0, 0}, q = {1, 0, 0};
  CagHermiteShape s;
  OK(cag_hermite_shape(p, q, cag_vec3(0.5, 0.5, 0), cag_vec3(0.5, -0.5, 0), &s, &err));
  assert_true(s.inflections == 0 && !s.has_cusp && !s.has_loop && s.within_limit);
  OK(cag_hermite_shape(p, q, cag_vec3(2, 2, 0), cag_vec3(2, -2, 0), &s, &err));
  assert_int_equal(s.inflections, 2);
  OK(cag_hermite_shape(p, q, cag_vec3(3, 3, 0), cag_vec3(3, -3, 0), &s, &err));
  assert_true(s.has_cusp && !s.has_loop);
  NEAR(s.cusp, 0.5, 1e-12);
  const double m = 5 / sqrt(2);
  OK(cag_hermite_shape(p, q, cag_vec3(m, m, 0), cag_vec3(m, -m, 0), &s, &err));
  assert_true(s.has_loop && !s.within_limit);
  // s^2 = (m cos a - 3 l) / (4 (m cos a - l)) about 1/2
  const double half = sqrt((m - 3) / (4 * (m - 1)));
  NEAR(s.loop[0], 0.5 - half, 1e-12);
  NEAR(s.loop[1], 0.5 + half, 1e-12);
  OK(cag_hermite_shape(p, q, cag_vec3(1, 0, 0), cag_vec3(1, 0, 0), &s, &err));
  assert_true(s.inflections == 0 && !s.has_cusp && !s.has_loop);
  FAILS(cag_hermite_shape(p, p, q, q, &s, &err), "coincident-points");
}

static double signed_curvature(const CagCurve *c, double t) {
  const CagVec3 v = derived(c, t, 1, CAG_SIDE_LEFT), a = derived(c, t, 2, CAG_SIDE_LEFT);
  return (v.x * a.y - v.y * a.x) / pow(cag_norm(v), 3);
}

// The curvatures of a known segment are among those that lead back to it, and all other solutions
// have the same curvatures.
static void end_curvatures_are_those_asked_for(void **state) {
  (void)state;
  const CagVec3 points[2] = {{0, 0, 0}, {2, 1, 0}}, dp = {1, 0, 0}, dq = {0.6, 0.8, 0};
  const CagVec3 known[2] = {cag_scaled(dp, 2), cag_scaled(dq, 1.5)};
  const double unit[2] = {0, 1};
  CagCurve *c;
  OK(cag_curve_hermite(points, known, 2, unit, 2, &c, &err));
  const double wanted[2] = {signed_curvature(c, 0), signed_curvature(c, 1)};
  cag_curve_release(c);
  double lengths[4][2];
  const size_t n = cag_hermite_by_curvature(points[0], points[1], dp, dq, wanted, lengths);
  bool found = false;
  for (size_t i = 0; i < n; i++) {
    const CagVec3 d[2] = {cag_scaled(dp, lengths[i][0]), cag_scaled(dq, lengths[i][1])};
    OK(cag_curve_hermite(points, d, 2, unit, 2, &c, &err));
    for (int e = 0; e < 2; e++) NEAR(signed_curvature(c, e), wanted[e], 1e-9);
    cag_curve_release(c);
    found = found || (fabs(lengths[i][0] - 2) < 1e-9 && fabs(lengths[i][1] - 1.5) < 1e-9);
  }
  assert_true(found);
}

static void polynomials_and_their_coefficients_are_one_curve(void **state) {
  (void)state;
  const CagVec3 a[5] = {{1, 2, 3}, {-1, 0, 2}, {0, 4, 1}, {2, -2, 0.5}, {0.25, 1, -1}};
  CagCurve *c;
  CagVec3 *found;
  size_t pieces;
  int degree;
  OK(cag_curve_polynomial(a, 5, 2.5, 3, &c, &err));
  const double t = 1.7;
  CagVec3 sum = a[4];
  for (int k = 3; k >= 0; k--) sum = cag_madd(a[k], t, sum);
  near_vec(at(c, t), sum, 1e-12);
  OK(cag_curve_coefficients(c, &found, &pieces, &degree, &err));
  assert_true(pieces == 1 && degree == 4);
  for (int k = 0; k < 5; k++) near_vec(found[k], a[k], 1e-12);
  free(found);
  cag_curve_release(c);
  FAILS(cag_curve_polynomial(a, 5, 0, 3, &c, &err), "bad-parameter-length");
}

static void joined_beziers_go_on_as_asked(void **state) {
  (void)state;
  const CagVec3 b[4] = {{1, 1, 0}, {2, 3, 0}, {4, 3, 0}, {3, 1, 0}};
  CagCurve *c, *next;
  CagVec3 q[4];
  CagJoint j;
  OK(cag_curve_bezier(b, NULL, 4, 2, &c, &err));
  // The worked example of reference 05a, 6: the C2 continuation by a cubic.
  OK(cag_bezier_join(c, 3, 2, 1, q, &err));
  near_vec(q[0], cag_vec3(3, 1, 0), 1e-14);
  near_vec(q[1], cag_vec3(2, -1, 0), 1e-14);
  near_vec(q[2], cag_vec3(-2, -5, 0), 1e-13);
  q[3] = cag_vec3(0, 0, 0);
  OK(cag_curve_bezier(q, NULL, 4, 2, &next, &err));
  OK(cag_curve_joint(c, next, 1e-9, &j, &err));
  assert_string_equal(cag_joint_class(&j), "C2");
  cag_curve_release(next);
  // The first side has twice the speed: G2, but not C1.
  OK(cag_bezier_join(c, 3, 2, 2, q, &err));
  OK(cag_curve_bezier(q, NULL, 4, 2, &next, &err));
  OK(cag_curve_joint(c, next, 1e-9, &j, &err));
  assert_string_equal(cag_joint_class(&j), "G2");
  assert_false(j.c1);
  NEAR(j.ratio, 0.5, 1e-13);
  cag_curve_release(next);
  // A reversed continuation: opposite tangents are not G1.
  OK(cag_curve_reverse(c, &next, &err));
  OK(cag_curve_joint(c, next, 1e-9, &j, &err));
  assert_string_equal(cag_joint_class(&j), "C0");
  NEAR(j.angle, 3.141592653589793, 1e-12);
  cag_curve_release(next);
  FAILS(cag_bezier_join(c, 1, 2, 1, q, &err), "bad-order");
  FAILS(cag_bezier_join(c, 3, 1, 0, q, &err), "bad-parameter");
  cag_curve_release(c);
}

static void hulls_are_apart_by_their_gap(void **state) {
  (void)state;
  CagVec3 a[8], b[8];
  for (int i = 0; i < 8; i++) {
    a[i] = cag_vec3(i & 1, i >> 1 & 1, i >> 2);
    b[i] = cag_add(a[i], cag_vec3(1.5, 2, 0.5));
  }
  // Unit cubes: 0.5 apart along x, 1 along y, overlapping along z.
  NEAR(cag_norm(cag_hulls_gap(a, 8, b, 8)), hypot(0.5, 1), 1e-14);
  assert_true(cag_hulls_disjoint(a, 8, b, 8));
  for (int i = 0; i < 8; i++) b[i] = cag_add(a[i], cag_vec3(1, 0.3, 0));
  assert_false(cag_hulls_disjoint(a, 8, b, 8)); // they touch
  const CagVec3 inside[1] = {{0.4, 0.5, 0.6}}, beside[1] = {{0.5, 0.5, 1.0625}};
  assert_false(cag_hulls_disjoint(a, 8, inside, 1));
  NEAR(cag_norm(cag_hulls_gap(a, 8, beside, 1)), 0.0625, 1e-15);
}

static CagVec3 random_space(double size) {
  const double x = uniform(-size, size), y = uniform(-size, size), z = uniform(-size, size);
  return cag_vec3(x, y, z);
}

// The gap is the difference of points of both hulls, and no difference is shorter along it.
static void gaps_of_random_hulls_are_the_nearest_differences(void **state) {
  (void)state;
  seed = 403;
  int apart = 0;
  for (int round = 0; round < 600; round++) {
    CagVec3 a[9], b[9];
    const size_t n = 1 + (size_t)uniform(0, 8.9), m = 1 + (size_t)uniform(0, 8.9);
    const bool flat = round % 3 == 0;
    const CagVec3 away = cag_scaled(cag_unit(random_space(1)), uniform(0, 4));
    for (size_t i = 0; i < n; i++) a[i] = random_space(1);
    for (size_t i = 0; i < m; i++) b[i] = cag_add(random_space(1), away);
    for (size_t i = 0; i < 9 && flat; i++) {
      if (i < n) a[i].z = 0.5;
      if (i < m) b[i].z = 0.5;
    }
    // Every fourth pair has a common point: the means of the corners.
    CagVec3 mean = {0, 0, 0};
    for (size_t i = 0; i < n; i++) mean = cag_madd(mean, 1.0 / (double)n, a[i]);
    for (size_t i = 0; i < m; i++) mean = cag_madd(mean, -1.0 / (double)m, b[i]);
    for (size_t i = 0; i < m && round % 4 == 0; i++) b[i] = cag_add(b[i], mean);
    const CagVec3 v = cag_hulls_gap(a, n, b, m);
    const double gap = cag_norm(v);
    if (round % 4 == 0) {
      assert_true(gap <= 1e-7);
      continue;
    }
    for (int k = 0; k < 30; k++) {
      const CagVec3 way = cag_unit(random_space(1));
      double most = -INFINITY;
      for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < m; j++) most = fmax(most, cag_dot(cag_sub(a[i], b[j]), way));
      assert_true(cag_dot(v, way) <= most + 1e-12);
    }
    if (gap < 1e-6) continue;
    double least = INFINITY;
    for (size_t i = 0; i < n; i++)
      for (size_t j = 0; j < m; j++) least = fmin(least, cag_dot(cag_sub(a[i], b[j]), v));
    assert_true(least >= gap * gap * (1 - 1e-9));
    assert_true(cag_hulls_disjoint(a, n, b, m));
    apart++;
  }
  assert_true(apart > 150);
}

static CagCurve *quadratic(CagVec3 p, CagVec3 q, CagVec3 r) {
  const CagVec3 v[3] = {p, q, r};
  CagCurve *c;
  OK(cag_curve_bezier(v, NULL, 3, 2, &c, &err));
  return c;
}

static CagVec3 curvature_vector(const CagCurve *c, double t) {
  CagFrenet f;
  OK(cag_curve_frenet(c, t, &f, &err));
  return cag_scaled(f.normal, f.curvature);
}

static void joints_are_told_by_the_derivatives_of_both_sides(void **state) {
  (void)state;
  seed = 404;
  for (int round = 0; round < 60; round++) {
    CagCurve *a, *b;
    CagVec3 p[4], q[4], da[3], db[3];
    for (int i = 0; i < 4; i++) {
      p[i] = random_space(3);
      q[i] = random_space(3);
    }
    OK(cag_curve_bezier(p, NULL, 4, 3, &a, &err));
    OK(cag_curve_bezier(q, NULL, 4, 3, &b, &err));
    CagJoint j;
    OK(cag_curve_joint(a, b, 1e-6, &j, &err));
    OK(cag_curve_eval(a, 1, 2, CAG_SIDE_LEFT, da, &err));
    OK(cag_curve_eval(b, 0, 2, CAG_SIDE_RIGHT, db, &err));
    NEAR(j.gap, cag_norm(cag_sub(q[0], p[3])), 1e-14);
    NEAR(j.first_jump, cag_norm(cag_sub(da[1], db[1])), 1e-12);
    NEAR(j.second_jump, cag_norm(cag_sub(da[2], db[2])), 1e-12);
    NEAR(j.ratio, cag_norm(db[1]) / cag_norm(da[1]), 1e-12 * j.ratio);
    NEAR(cos(j.angle), cag_dot(cag_unit(da[1]), cag_unit(db[1])), 1e-12);
    const double jump = cag_norm(cag_sub(curvature_vector(a, 1), curvature_vector(b, 0)));
    NEAR(j.curvature_jump, jump, 1e-10 * (1 + jump));
    assert_string_equal(cag_joint_class(&j), "none");
    cag_curve_release(a);
    cag_curve_release(b);
  }
}

// Each kind of continuity is accepted up to the tolerance, but not beyond.
static void joints_are_judged_to_the_tolerance(void **state) {
  (void)state;
  const double tolerance = 1e-3;
  for (int i = 0; i < 2; i++) {
    const double off = (i ? 1.05 : 0.95) * tolerance;
    const CagVec3 o = {0, 0, 0}, m = {-1, 0, 0}, l = {-2, 1, 0};
    CagCurve *a = quadratic(l, m, o), *b; // derivatives at o: [2, 0], [0, 2]
    CagJoint j;
    // A continuation with the same derivatives, but shifted. The box is 4 + off wide and 1 high.
    b = quadratic(cag_vec3(off * hypot(4, 1), 0, 0), cag_vec3(1 + off * hypot(4, 1), 0, 0),
                  cag_vec3(2, 1, 0));
    OK(cag_curve_joint(a, b, tolerance, &j, &err));
    assert_int_equal(j.c0, i == 0);
    assert_int_equal(j.c1, i == 0);
    assert_int_equal(j.g1, i == 0);
    cag_curve_release(b);
    // The first derivative is longer by a fraction.
    b = quadratic(o, cag_vec3(1 + off, 0, 0), cag_vec3(2 + 2 * off, 1, 0));
    OK(cag_curve_joint(a, b, tolerance, &j, &err));
    assert_true(j.c0 && j.g1);
    assert_int_equal(j.c1, i == 0);
    cag_curve_release(b);
    // The tangent is rotated.
    b = quadratic(o, cag_vec3(cos(off), sin(off), 0), cag_vec3(2 * cos(off), 1 + 2 * sin(off), 0));
    OK(cag_curve_joint(a, b, tolerance, &j, &err));
    assert_true(j.c0);
    NEAR(j.angle, off, 1e-12);
    assert_int_equal(j.g1, i == 0);
    cag_curve_release(b);
    // The second derivative is longer by a fraction.
    b = quadratic(o, cag_vec3(1, 0, 0), cag_vec3(2, 1 + off, 0));
    OK(cag_curve_joint(a, b, tolerance, &j, &err));
    assert_true(j.c1 && j.g1);
    assert_int_equal(j.c2, i == 0);
    assert_int_equal(j.g2, i == 0);
    assert_string_equal(cag_joint_class(&j), i ? "C1" : "C2");
    cag_curve_release(b);
    cag_curve_release(a);
  }
  // A segment whose derivative at the joint is 0 has no ratio or curvature there.
  const CagVec3 o = {0, 0, 0}, p = {-1, 0, 0}, q = {1, 1, 0};
  CagCurve *a = quadratic(p, o, o), *b = quadratic(o, cag_vec3(1, 0, 0), q);
  CagJoint j;
  OK(cag_curve_joint(a, b, 1e-9, &j, &err));
  assert_true(isnan(j.ratio) && isnan(j.curvature_jump));
  assert_string_equal(cag_joint_class(&j), "G1");
  NEAR(j.angle, 0, 1e-12);
  cag_curve_release(a);
  a = quadratic(p, p, p);
  OK(cag_curve_joint(a, b, 1e-9, &j, &err));
  assert_true(isnan(j.angle) && isnan(j.ratio) && !j.c0 && !j.g1);
  cag_curve_release(a);
  cag_curve_release(b);
}

// --- Random blends ---

// The parabola through three points at 0, a and 1.
static CagVec3 parabola_at(CagVec3 p, CagVec3 q, CagVec3 r, double a, double x) {
  const double f = (x - a) * (x - 1) / a, g = x * (x - 1) / (a * (a - 1)),
               h = x * (x - a) / (1 - a);
  return cag_madd(cag_madd(cag_scaled(p, f), g, q), h, r);
}

// Between two points, the curve is a linear blend of two parabolas.
static void random_blends_mix_two_parabolas(void **state) {
  (void)state;
  enum { MOST = 8 };
  seed = 405;
  for (int round = 0; round < 120; round++) {
    const CagBlendEnds ends = round % 3 == 0   ? CAG_BLEND_OPEN
                              : round % 3 == 1 ? CAG_BLEND_PARABOLA
                                               : CAG_BLEND_CLOSED;
    const bool closed = ends == CAG_BLEND_CLOSED, open = ends == CAG_BLEND_OPEN;
    const size_t n = (open ? 4 : 3) + (size_t)uniform(0, 4.9);
    const bool given = round / 3 % 2;
    const double power = round % 4 ? 1 : 0.5;
    CagVec3 p[MOST];
    double ratios[MOST], length[MOST], a[MOST];
    for (size_t i = 0; i < n; i++) {
      p[i] = random_space(3);
      ratios[i] = round % 5 == 0 ? 0.5 : uniform(0.2, 0.8);
    }
    for (size_t i = 0; i < n; i++)
      length[i] = given ? 1 : pow(cag_norm(cag_sub(p[(i + 1) % n], p[i])), power);
    // The parameter at which the parabola about point i passes it.
    for (size_t i = 0; i < n; i++)
      a[i] = !given   ? length[(i + n - 1) % n] / (length[(i + n - 1) % n] + length[i])
             : closed ? ratios[i]
                      : ratios[i > 0 ? i - 1 : 0];
    CagCurve *c;
    OK(cag_curve_parabolic_blend(p, n, given ? ratios : NULL, power, ends, 3, &c, &err));
    double u = 0;
    for (size_t i = open; i < (closed ? n : n - 1 - (size_t)open); i++) {
      const bool first = !closed && i == 0, last = !closed && i + 2 == n;
      for (int k = 0; k <= 8; k++) {
        const double s = k / 8.0;
        const size_t j = (i + 1) % n;
        const CagVec3 before =
                          parabola_at(p[(i + n - 1) % n], p[i], p[j], a[i], a[i] + s * (1 - a[i])),
                      after = parabola_at(p[i], p[j], p[(i + 2) % n], a[j], s * a[j]);
        near_vec(at(c, fmin(c->end, u + s * length[i])),
                 first  ? after
                 : last ? before
                        : cag_lerp(before, after, s),
                 1e-11);
      }
      u += length[i];
    }
    NEAR(c->end - c->start, u, 1e-13 * u);
    assert_int_equal(c->closed, closed);
    cag_curve_release(c);
  }
  CagCurve *c;
  const CagVec3 p[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 0}};
  FAILS(cag_curve_parabolic_blend(p, 3, NULL, 1, CAG_BLEND_OPEN, 2, &c, &err), "too-few-points");
  FAILS(cag_curve_parabolic_blend(p, 2, NULL, 1, CAG_BLEND_CLOSED, 2, &c, &err), "too-few-points");
  FAILS(cag_curve_parabolic_blend(p, 2, NULL, 1, CAG_BLEND_PARABOLA, 2, &c, &err),
        "too-few-points");
  FAILS_AT(cag_curve_parabolic_blend(p, 4, NULL, 1, CAG_BLEND_OPEN, 2, &c, &err),
           "coincident-points", 3);
  const double zero[2] = {0, 0.5}, right[2] = {0.5, 0.5};
  FAILS_AT(cag_curve_parabolic_blend(p, 4, zero, 1, CAG_BLEND_OPEN, 2, &c, &err),
           "bad-blend-parameter", 0);
  OK(cag_curve_parabolic_blend(p, 4, right, 1, CAG_BLEND_OPEN, 2, &c, &err));
  cag_curve_release(c);
}

// --- Random segments ---

static CagVec3 random_flat(double size) {
  CagVec3 v = {0, 0, 0};
  v.x = uniform(-size, size);
  v.y = uniform(-size, size);
  return v;
}

static double across(CagVec3 a, CagVec3 b) { return a.x * b.y - a.y * b.x; }

// Inflections are sign changes of C' x C'', and loops are points that the segment passes twice.
static void random_segments_have_their_shape(void **state) {
  (void)state;
  seed = 401;
  int seen[4] = {0};
  for (int round = 0; round < 300; round++) {
    const CagVec3 ends[2] = {random_flat(2), random_flat(2)};
    const CagVec3 tangents[2] = {random_flat(12), random_flat(12)};
    const CagVec3 d = cag_sub(ends[1], ends[0]);
    const double unit[2] = {0, 1}, chord = cag_norm(d);
    CagHermiteShape s;
    CagCurve *c;
    OK(cag_hermite_shape(ends[0], ends[1], tangents[0], tangents[1], &s, &err));
    NEAR(s.chord, chord, 1e-14);
    bool within = true;
    for (int i = 0; i < 2; i++) {
      const double speed = cag_norm(tangents[i]);
      NEAR(s.speed[i], speed, 1e-13);
      NEAR(s.ratio[i], speed / chord, 1e-12 * speed / chord);
      NEAR(s.projection[i], cag_dot(tangents[i], d) / (chord * chord), 1e-11 * speed / chord);
      within = within && speed <= 3 * chord;
    }
    assert_true(s.within_limit == within);
    OK(cag_curve_hermite(ends, tangents, 2, unit, 2, &c, &err));
    size_t turns = 0;
    double last = 0;
    for (int k = 0; k <= 2000; k++) {
      const double t = (k + 0.5) / 2001;
      const double bend = across(derived(c, t, 1, CAG_SIDE_LEFT), derived(c, t, 2, CAG_SIDE_LEFT));
      turns += last * bend < 0;
      last = bend;
    }
    assert_int_equal(s.inflections, turns);
    assert_false(s.has_cusp);
    for (size_t i = 0; i < s.inflections; i++) {
      const double t = s.inflection[i];
      assert_true(t > 0 && t < 1 && (i == 0 || s.inflection[i - 1] < t));
      const CagVec3 v = derived(c, t, 1, CAG_SIDE_LEFT), a = derived(c, t, 2, CAG_SIDE_LEFT);
      NEAR(across(v, a), 0, 1e-8 * cag_norm(v) * cag_norm(a));
    }
    // If the segment intersects itself, so do two chords of a dense polyline.
    enum { STEPS = 120 };
    CagVec3 p[STEPS + 1];
    bool crosses = false;
    for (int k = 0; k <= STEPS; k++) p[k] = at(c, k / (double)STEPS);
    for (int i = 0; i < STEPS; i++)
      for (int j = i + 2; j < STEPS; j++) {
        const CagVec3 u = cag_sub(p[i + 1], p[i]), v = cag_sub(p[j + 1], p[j]);
        crosses =
            crosses || (across(u, cag_sub(p[j], p[i])) * across(u, cag_sub(p[j + 1], p[i])) < 0 &&
                        across(v, cag_sub(p[i], p[j])) * across(v, cag_sub(p[i + 1], p[j])) < 0);
      }
    assert_true(s.has_loop || !crosses);
    if (s.has_loop) {
      assert_true(0 <= s.loop[0] && s.loop[0] < s.loop[1] && s.loop[1] <= 1);
      near_vec(at(c, s.loop[0]), at(c, s.loop[1]), 1e-9 * (1 + 10 * chord));
    }
    // The result does not depend on the size.
    const double scale = round % 2 ? 1e-4 : 1e4;
    CagHermiteShape large;
    OK(cag_hermite_shape(cag_scaled(ends[0], scale), cag_scaled(ends[1], scale),
                         cag_scaled(tangents[0], scale), cag_scaled(tangents[1], scale), &large,
                         &err));
    assert_true(large.has_loop == s.has_loop && !large.has_cusp);
    assert_int_equal(large.inflections, s.inflections);
    for (size_t i = 0; i < s.inflections; i++) NEAR(large.inflection[i], s.inflection[i], 1e-9);
    seen[s.has_loop ? 3 : s.inflections]++;
    cag_curve_release(c);
  }
  for (int i = 0; i < 4; i++) assert_true(seen[i] > 10);
  // Tangents of 3 chords are below the limit.
  CagHermiteShape s;
  OK(cag_hermite_shape(cag_vec3(0, 0, 0), cag_vec3(2, 0, 0), cag_vec3(6, 0, 0), cag_vec3(0, 6, 0),
                       &s, &err));
  assert_true(s.within_limit);
  OK(cag_hermite_shape(cag_vec3(0, 0, 0), cag_vec3(2, 0, 0), cag_vec3(6, 0, 0), cag_vec3(0, 6.1, 0),
                       &s, &err));
  assert_false(s.within_limit);
  OK(cag_hermite_shape(cag_vec3(0, 0, 0), cag_vec3(2, 0, 0), cag_vec3(6.1, 0, 0), cag_vec3(0, 6, 0),
                       &s, &err));
  assert_false(s.within_limit);
  // Cusps before the start and after the end do not count. The curve is [(t - m)^2, (t - m)^3],
  // moved.
  for (int k = -1; k <= 3; k++) {
    const double m = 0.5 * k; // C = [(t - m)^2, (t - m)^3]
    const CagVec3 p = {m * m, -m * m * m, 0}, q = {(1 - m) * (1 - m), pow(1 - m, 3), 0};
    const CagVec3 dp = {-2 * m, 3 * m * m, 0}, dq = {2 * (1 - m), 3 * (1 - m) * (1 - m), 0};
    OK(cag_hermite_shape(p, q, dp, dq, &s, &err));
    assert_true(s.has_cusp == (m >= 0 && m <= 1) && s.inflections == 0 && !s.has_loop);
    if (s.has_cusp) NEAR(s.cusp, m, 1e-7);
  }
}

// Finds all pairs of lengths that a search over one of the lengths finds.
static void random_end_curvatures_have_all_their_lengths(void **state) {
  (void)state;
  seed = 402;
  int seen[5] = {0};
  for (int round = 0; round < 300; round++) {
    const CagVec3 p = random_flat(2), q = random_flat(2), d = cag_sub(q, p);
    const double one = uniform(-3, 3), two = round % 10 ? uniform(-3, 3) : one;
    const CagVec3 dp = {cos(one), sin(one), 0}, dq = {cos(two), sin(two), 0};
    double k[2], lengths[4][2];
    // k0 x^2 = 6 dp x d - 2 c y, k1 y^2 = 6 d x dq - 2 c x with c = dp x dq.
    const double a = 6 * across(dp, d), b = 6 * across(d, dq), c = across(dp, dq);
    k[0] = uniform(-2, 2);
    k[1] = uniform(-2, 2);
    if (round % 3) { // the curvatures of a segment
      const double x = uniform(0.5, 9), y = uniform(0.5, 9);
      k[0] = (a - 2 * c * y) / (x * x);
      k[1] = (b - 2 * c * x) / (y * y);
    }
    if (round % 7 < 2 && round % 10) k[round % 7] = 0; // a straight end
    const size_t n = cag_hermite_by_curvature(p, q, dp, dq, k, lengths);
    for (size_t i = 0; i < n; i++) {
      const double x = lengths[i][0], y = lengths[i][1];
      const CagVec3 ends[2] = {p, q}, tangents[2] = {cag_scaled(dp, x), cag_scaled(dq, y)};
      const double unit[2] = {0, 1};
      CagCurve *curve;
      assert_true(x > 0 && y > 0);
      OK(cag_curve_hermite(ends, tangents, 2, unit, 2, &curve, &err));
      for (int e = 0; e < 2; e++) NEAR(signed_curvature(curve, e), k[e], 1e-6);
      cag_curve_release(curve);
    }
    size_t count = 0;
    if (round % 10 == 0) {
      count = a / k[0] > 0 && b / k[1] > 0;
    } else {
      double last = NAN, last_y = 0;
      for (int i = 0; i < 60000; i++) {
        // From 1e-6 to 1e6.
        const double x = pow(10, -6 + 12.0 * i / 60000), y = (a - k[0] * x * x) / (2 * c);
        const double f = k[1] * y * y + 2 * c * x - b;
        if (i > 0 && last * f < 0 && y > 0 && last_y > 0) count++;
        last = f;
        last_y = y;
      }
    }
    assert_int_equal(n, count);
    seen[n]++;
  }
  assert_true(seen[0] > 20 && seen[1] > 20 && seen[2] > 0);
  // Whole coefficients: x^2 = 2 - y, y^2 = 3 - 2 x, that is x^4 - 4 x^2 + 2 x + 1 = 0.
  const CagVec3 zero = {0, 0, 0}, q = {0.5, 2.0 / 3, 0};
  const double k[2] = {2, 1};
  double lengths[4][2];
  const size_t n =
      cag_hermite_by_curvature(zero, q, cag_vec3(1, 0, 0), cag_vec3(0, 1, 0), k, lengths);
  size_t ones = 0;
  for (size_t i = 0; i < n; i++) {
    const double x = lengths[i][0], y = lengths[i][1];
    NEAR(x * x, 2 - y, 1e-14);
    NEAR(y * y, 3 - 2 * x, 1e-14);
    ones += fabs(x - 1) + fabs(y - 1) < 1e-14;
  }
  assert_int_equal(ones, 1);
  // x^2 = 1.5 - y, y^2 = 2.25 - 2 x has (1, 0.5) twice.
  const size_t m = cag_hermite_by_curvature(zero, cag_vec3(0.375, 0.5, 0), cag_vec3(1, 0, 0),
                                            cag_vec3(0, 1, 0), k, lengths);
  assert_int_equal(m, 1);
  NEAR(lengths[0][0], 1, 1e-7);
  NEAR(lengths[0][1], 0.5, 1e-7);
}

static void random_polynomials_are_their_sums(void **state) {
  (void)state;
  seed = 403;
  for (int round = 0; round < 60; round++) {
    const size_t n = 2 + (size_t)(round % 6);
    CagVec3 a[8], *found;
    CagCurve *c, *fine;
    size_t pieces;
    int degree;
    const double length = uniform(0.3, 3);
    for (size_t i = 0; i < n; i++) {
      a[i] = random_flat(2);
      a[i].z = uniform(-2, 2);
    }
    OK(cag_curve_polynomial(a, n, length, 3, &c, &err));
    assert_true(c->start == 0 && c->end == length);
    for (int k = 0; k <= 6; k++) {
      const double t = fmin(length, length * k / 6);
      CagVec3 sum = {0, 0, 0};
      for (size_t i = n; i-- > 0;) sum = cag_madd(a[i], t, sum);
      near_vec(at(c, t), sum, 1e-10);
    }
    // If a segment is split, each piece has the coefficients relative to its own start.
    const double cut = length * uniform(0.2, 0.8);
    OK(cag_curve_insert_knots(c, &cut, 1, &fine, &err));
    OK(cag_curve_coefficients(fine, &found, &pieces, &degree, &err));
    assert_true(pieces == 2 && degree == (int)n - 1);
    for (size_t i = 0; i < n; i++) near_vec(found[i], a[i], 1e-8 / pow(fmin(cut, 1), (double)i));
    for (int k = 0; k <= 4; k++) {
      const double s = (length - cut) * k / 4;
      CagVec3 sum = {0, 0, 0};
      for (size_t i = n; i-- > 0;) sum = cag_madd(found[n + i], s, sum);
      near_vec(sum, at(c, fmin(length, cut + s)), 1e-9);
    }
    free(found);
    cag_curve_release(fine);
    cag_curve_release(c);
  }
  const CagVec3 points[3] = {{0, 0, 0}, {1, 2, 0}, {3, 1, 0}};
  const double w[3] = {1, 2, 1};
  CagCurve *c;
  CagVec3 *found;
  size_t pieces;
  int degree;
  OK(cag_curve_bezier(points, w, 3, 2, &c, &err));
  FAILS(cag_curve_coefficients(c, &found, &pieces, &degree, &err), "not-polynomial");
  cag_curve_release(c);
  FAILS(cag_curve_polynomial(points, 1, 1, 2, &c, &err), "too-few-points");
  FAILS(cag_curve_polynomial(points, 3, INFINITY, 2, &c, &err), "bad-parameter-length");
  FAILS(cag_curve_polynomial(points, 3, -1, 2, &c, &err), "bad-parameter-length");
  const CagVec3 broken[2] = {{0, 0, 0}, {0, NAN, 0}};
  FAILS_AT(cag_curve_polynomial(broken, 2, 1, 2, &c, &err), "not-finite", 1);
}

// Each tangent is shortened to at most `limit` times the mean speed of the slower adjacent segment.
static void long_tangents_are_shortened(void **state) {
  (void)state;
  seed = 404;
  for (int round = 0; round < 40; round++) {
    const size_t n = 2 + (size_t)(round % 4);
    CagVec3 p[6], v[6], before[6];
    double t[6] = {0};
    for (size_t i = 0; i < n; i++) {
      p[i] = random_flat(2);
      before[i] = v[i] = random_flat(9);
      if (i > 0) t[i] = t[i - 1] + uniform(0.3, 2);
    }
    const double limit = uniform(0.5, 3);
    cag_hermite_limit(p, v, n, t, limit);
    for (size_t i = 0; i < n; i++) {
      double most = INFINITY;
      if (i > 0) most = limit * cag_norm(cag_sub(p[i], p[i - 1])) / (t[i] - t[i - 1]);
      if (i + 1 < n)
        most = fmin(most, limit * cag_norm(cag_sub(p[i + 1], p[i])) / (t[i + 1] - t[i]));
      const double speed = cag_norm(before[i]);
      near_vec(v[i], cag_scaled(before[i], fmin(1, most / speed)), 1e-12);
    }
  }
}

// The derivatives at the joint are the requested ones, for all orders and degrees.
static void random_joints_go_on_as_asked(void **state) {
  (void)state;
  seed = 405;
  for (int round = 0; round < 60; round++) {
    CagVec3 net[5], q[6];
    CagCurve *c, *next;
    const int m = 2 + round % 4, order = round % 3;
    const double ratio = uniform(0.4, 2.5), knots[8] = {1, 1, 1, 2, 3.5, 3.5, 3.5, 0};
    for (int i = 0; i < 4; i++) net[i] = random_flat(2);
    OK(cag_curve_nurbs(net, NULL, 4, 2, knots, 2, &c, &err));
    for (int i = 0; i <= m; i++) q[i] = random_flat(2);
    OK(cag_bezier_join(c, m, order, ratio, q, &err));
    OK(cag_curve_bezier(q, NULL, (size_t)m + 1, 2, &next, &err));
    double scale = 1;
    for (int k = 0; k <= order; k++, scale *= ratio) {
      const CagVec3 d = cag_scaled(derived(next, 0, k, CAG_SIDE_RIGHT), scale);
      near_vec(d, derived(c, c->end, k, CAG_SIDE_LEFT), 1e-11);
    }
    cag_curve_release(next);
    FAILS(cag_bezier_join(c, m, 3, 1, q, &err), "bad-order");
    FAILS(cag_bezier_join(c, m, -1, 1, q, &err), "bad-order");
    FAILS(cag_bezier_join(c, 0, 0, 1, q, &err), "bad-order");
    FAILS(cag_bezier_join(c, 1, 2, 1, q, &err), "bad-order");
    OK(cag_bezier_join(c, 1, 1, 1, q, &err));
    OK(cag_bezier_join(c, 2, 2, 1, q, &err));
    FAILS(cag_bezier_join(c, m, 1, 0, q, &err), "bad-parameter");
    FAILS(cag_bezier_join(c, m, 1, INFINITY, q, &err), "bad-parameter");
    cag_curve_release(c);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(random_segments_have_their_shape),
      cmocka_unit_test(random_end_curvatures_have_all_their_lengths),
      cmocka_unit_test(random_polynomials_are_their_sums),
      cmocka_unit_test(long_tangents_are_shortened),
      cmocka_unit_test(random_joints_go_on_as_asked),
      cmocka_unit_test(clamped_splines_have_the_tangents_of_the_reference),
      cmocka_unit_test(splines_pass_their_points_and_are_smooth),
      cmocka_unit_test(the_shortest_splines_are_the_reference_s),
      cmocka_unit_test(a_cubic_is_its_own_clamped_spline),
      cmocka_unit_test(chords_of_any_ratio_keep_the_points),
      cmocka_unit_test(tension_jumps_the_second_derivative_along_the_tangent),
      cmocka_unit_test(bad_splines_are_told),
      cmocka_unit_test(blends_have_the_points_of_the_reference),
      cmocka_unit_test(arcs_at_the_ends_are_parabolas),
      cmocka_unit_test(closed_blends_meet_with_one_tangent),
      cmocka_unit_test(the_magnitude_of_tangents_decides_the_shape),
      cmocka_unit_test(end_curvatures_are_those_asked_for),
      cmocka_unit_test(polynomials_and_their_coefficients_are_one_curve),
      cmocka_unit_test(joined_beziers_go_on_as_asked),
      cmocka_unit_test(hulls_are_apart_by_their_gap),
      cmocka_unit_test(gaps_of_random_hulls_are_the_nearest_differences),
      cmocka_unit_test(joints_are_told_by_the_derivatives_of_both_sides),
      cmocka_unit_test(joints_are_judged_to_the_tolerance),
      cmocka_unit_test(random_blends_mix_two_parabolas),
  };
  return cmocka_run_group_tests_name("cubic", tests, NULL, NULL);
}
