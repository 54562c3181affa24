// Conics from conditions, points, and tangents, and arcs in triangles. The expected values are
// closed forms, or those of the reference on plane curves.

#include "conic_support.h"
#include "geom/curve/conic.h"
#include "geom/curve/family.h"

// --- From conditions ---

static void five_conditions_make_each_kind_of_conic(void **state) {
  (void)state;
  const CagConicTangent tangents[2] = {{{0, 0, 0}, {1, 1, 0}}, {{4, 0, 0}, {1, -1, 0}}};
  static const struct {
    double y;
    CagConic k;
    const char *name;
  } cases[] = {{0.8, {{0.8, 0, 1, -3.2, 3.2, 0}}, "ellipse"},
               {1, {{1, 0, 0, -4, 4, 0}}, "parabola"},
               {1.2, {{-1.8, 0, 1, 7.2, -7.2, 0}}, "hyperbola"}};
  for (int i = 0; i < 3; i++) {
    const CagVec3 points[3] = {{0, 0, 0}, {4, 0, 0}, {2, cases[i].y, 0}};
    CagConic k;
    CagConicClass class;
    OK(cag_conic_from_conditions(points, 3, tangents, 2, CAG_CONIC_GENERAL, &k, &err));
    for (int j = 0; j < 6; j++) NEAR(k.c[j], cases[i].k.c[j], 1e-12);
    OK(cag_conic_classify(&k, &class, &err));
    assert_string_equal(class.name, cases[i].name);
    // The points of the tangents need not be among the given points.
    OK(cag_conic_from_conditions(points + 2, 1, tangents, 2, CAG_CONIC_GENERAL, &k, &err));
    for (int j = 0; j < 6; j++) NEAR(k.c[j], cases[i].k.c[j], 1e-12);
  }
}

// With u and v along the axes: u^2 / a^2 + v^2 / b^2 = 1; the sign is - for a hyperbola.
static void turned_conics_away_from_the_origin_have_their_equations(void **state) {
  (void)state;
  for (int i = 0; i < 24; i++) {
    const double sign = i % 2 ? -1 : 1, turn = 0.26 * i + 0.1, c = cos(turn), s = sin(turn);
    const double a = 1 + 0.2 * (i % 5), b = 2.5 - 0.3 * (i % 4);
    const double x = 0.9 * (i % 7) - 2, y = 3 - 0.8 * (i % 6), p = 1 / (a * a), q = sign / (b * b);
    CagVec3 points[5];
    for (int k = 0; k < 5; k++) {
      const double t = (sign > 0 ? 1.2 : 0.5) * (k - 2), side = k % 2 ? -1 : 1;
      const double u = a * (sign > 0 ? cos(t) : side * cosh(t)),
                   v = b * (sign > 0 ? sin(t) : sinh(t));
      points[k] = cag_vec3(x + u * c - v * s, y + u * s + v * c, 0);
    }
    const double A = p * c * c + q * s * s, B = 2 * (p - q) * c * s, C = p * s * s + q * c * c;
    const double expected[6] = {
        A, B, C, -2 * A * x - B * y, -2 * C * y - B * x, A * x * x + B * x * y + C * y * y - 1};
    CagConic k;
    OK(cag_conic_from_conditions(points, 5, NULL, 0, CAG_CONIC_GENERAL, &k, &err));
    for (int j = 0; j < 6; j++) NEAR(k.c[j], expected[j] / C, 1e-10 * (1 + fabs(expected[j] / C)));
  }
}

static void points_far_away_lose_no_conic(void **state) {
  (void)state;
  CagVec3 points[5];
  CagConic k;
  CagConicClass class;
  for (int i = 0; i < 5; i++) points[i] = cag_vec3(1000 + 2 * cos(i * 1.3), -500 + sin(i * 1.3), 0);
  OK(cag_conic_from_conditions(points, 5, NULL, 0, CAG_CONIC_GENERAL, &k, &err));
  OK(cag_conic_classify(&k, &class, &err));
  assert_string_equal(class.name, "ellipse");
  near_vec(class.center, cag_vec3(1000, -500, 0), 1e-6);
  NEAR(class.a, 2, 1e-6);
  NEAR(class.b, 1, 1e-6);
}

static void conditions_that_do_not_fix_a_conic_are_named(void **state) {
  (void)state;
  const CagVec3 row[6] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {0, 1, 0}, {5, 5, 0}};
  const CagVec3 square[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {7, 7, 0}};
  const CagConicTangent none = {{0, 0, 0}, {0, 0, 0}};
  CagConic k;
  FAILS(cag_conic_from_conditions(row, 5, NULL, 0, CAG_CONIC_GENERAL, &k, &err),
        "conditions-dependent");
  FAILS(cag_conic_from_conditions(row, 3, NULL, 0, CAG_CONIC_GENERAL, &k, &err),
        "too-few-conditions");
  FAILS(cag_conic_from_conditions(square, 4, NULL, 0, CAG_CONIC_CIRCLE, &k, &err),
        "conditions-contradict");
  FAILS_AT(cag_conic_from_conditions(square, 4, &none, 1, CAG_CONIC_CIRCLE, &k, &err),
           "zero-vector", 0);
}

static void an_arc_of_a_triangle_bulges_as_its_weight_says(void **state) {
  (void)state;
  const CagVec3 p = {1, 0, 0}, apex = {1, 1, 0}, q = {0, 1, 0};
  CagCurve *c;
  double weight;
  OK(cag_conic_shoulder_weight(p, apex, q, cag_vec3(sqrt(0.5), sqrt(0.5), 0), &weight, &err));
  NEAR(weight, sqrt(0.5), 1e-14);
  // A point of the unit circle away from the middle results in the same weight.
  OK(cag_conic_shoulder_weight(p, apex, q, cag_vec3(0.8, 0.6, 0), &weight, &err));
  NEAR(weight, sqrt(0.5), 1e-14);
  OK(cag_conic_arc(p, apex, q, weight, 2, &c, &err));
  for (int i = 0; i <= 10; i++) NEAR(cag_norm(at(c, i / 10.0)), 1, 1e-14);
  cag_curve_release(c);
  FAILS(cag_conic_shoulder_weight(p, apex, q, cag_vec3(2, 2, 0), &weight, &err),
        "shoulder-outside");
  FAILS(cag_conic_arc(p, cag_lerp(p, q, 0.5), q, 1, 2, &c, &err), "collinear-points");
  FAILS(cag_conic_arc(p, apex, q, -1, 2, &c, &err), "negative-weight");
  OK(cag_conic_arc(p, apex, q, 0, 2, &c, &err)); // the chord
  near_vec(at(c, 0.25), cag_vec3(0.75, 0.25, 0), 0);
  cag_curve_release(c);
}

// --- Random conditions ---

// Points and tangents of a random conic determine it.
static void random_conditions_have_their_conic(void **state) {
  (void)state;
  seed = 501;
  for (int i = 0; i < 240; i++) {
    const double a = uniform(0.5, 3), b = uniform(0.5, 3);
    const CagConicShape shape = (CagConicShape)(i % 4);
    Standard s = random_standard(1 / (a * a), (i % 8 < 4 ? 1 : -1) / (b * b), 0, 1);
    if (shape == CAG_CONIC_AXIS) s.angle = 0;
    if (shape == CAG_CONIC_CIRCLE) s.beta = s.alpha;
    if (shape == CAG_CONIC_LINE) s = random_standard(0, 0, 1, 0);
    if (i % 5 == 0) s.center = cag_scaled(s.center, 10);
    const CagConic expected = equation(&s);
    static const size_t needed[4] = {5, 4, 3, 2};
    // The number of tangents depends on i. Each of them is two conditions, and its point may be
    // among the given points. The rest are points, sometimes one more than needed.
    const size_t m = (size_t)(i / 4 % 3) % (needed[shape] / 2 + 1);
    const bool listed = i % 3 == 0;
    const size_t extra = (size_t)(i / 12 % 2);
    CagConicTangent tangents[2];
    CagVec3 points[8];
    size_t n = 0;
    for (size_t k = 0; k < needed[shape] - m + extra; k++) {
      // The parameters are distributed over both branches of a hyperbola.
      const double t = 0.5 + 1.1 * (double)k + uniform(-0.2, 0.2);
      double u = 0, v = 0, du = 0, dv = 0;
      if (shape == CAG_CONIC_LINE) v = t - 1, dv = 1;
      else if (s.beta > 0) u = cos(t) / sqrt(s.alpha), v = sin(t) / sqrt(s.beta);
      else u = (k % 2 ? -1 : 1) * cosh(t - 2) / sqrt(s.alpha), v = sinh(t - 2) / sqrt(-s.beta);
      if (shape != CAG_CONIC_LINE) du = -s.beta * v, dv = s.alpha * u; // along the tangent
      const CagVec3 p = placed(&s, u, v);
      if (k < m) {
        tangents[k].point = p;
        tangents[k].direction =
            cag_scaled(cag_sub(placed(&s, u + du, v + dv), p), uniform(-3, -0.1));
        if (listed) points[n++] = p;
      } else {
        points[n++] = p;
      }
    }
    CagConic k;
    OK(cag_conic_from_conditions(points, n, tangents, m, shape, &k, &err));
    same_conic(&k, &expected, 1e-8);
    // C is 1, or the first coefficient that does not vanish.
    int unit = shape == CAG_CONIC_LINE ? 3 : 2;
    if (shape == CAG_CONIC_LINE && fabs(k.c[3]) < 1e-12) unit = 4;
    NEAR(k.c[unit], 1, 0);
    if (shape != CAG_CONIC_GENERAL) assert_true(k.c[1] == 0);
    if (shape == CAG_CONIC_CIRCLE) NEAR(k.c[0], k.c[2], 1e-12);
    if (shape == CAG_CONIC_LINE) assert_true(k.c[0] == 0 && k.c[2] == 0);
    // With one condition fewer, the conic is undetermined.
    if (extra == 0 && n > 0 && !(listed && m > 0))
      FAILS(cag_conic_from_conditions(points, n - 1, tangents, m, shape, &k, &err),
            "too-few-conditions");
    // A point off the conic contradicts the other conditions.
    if (extra == 1) {
      points[n - 1] = cag_add(points[n - 1], cag_vec3(1e-4, 2e-4, 0));
      FAILS(cag_conic_from_conditions(points, n, tangents, m, shape, &k, &err),
            "conditions-contradict");
    }
  }
  const CagVec3 same[5] = {{1, 2, 0}, {1, 2, 0}, {1, 2, 0}, {1, 2, 0}, {1, 2, 0}};
  CagConic k;
  FAILS(cag_conic_from_conditions(same, 5, NULL, 0, CAG_CONIC_GENERAL, &k, &err),
        "coincident-points");
  FAILS(cag_conic_from_conditions(same, 0, NULL, 0, CAG_CONIC_LINE, &k, &err),
        "too-few-conditions");
}

// Coefficients due to rounding are 0, and the first that does not vanish is 1.
static void conditions_leave_no_rounding(void **state) {
  (void)state;
  const CagVec3 upright[2] = {{0.1, 0.3, 0}, {0.1, 7.7, 0}},
                level[2] = {{0.2, 0.3, 0}, {9, 0.3, 0}};
  CagConic k;
  OK(cag_conic_from_conditions(upright, 2, NULL, 0, CAG_CONIC_LINE, &k, &err));
  assert_true(k.c[3] == 1 && k.c[4] == 0);
  NEAR(k.c[5], -0.1, 1e-14);
  OK(cag_conic_from_conditions(level, 2, NULL, 0, CAG_CONIC_LINE, &k, &err));
  assert_true(k.c[3] == 0 && k.c[4] == 1);
  NEAR(k.c[5], -0.3, 1e-14);
  // x^2 = y with a fifth point: no term in y^2, and A becomes 1. xy = 1: B becomes 1.
  CagVec3 parabola[5], hyperbola[5];
  for (int i = 0; i < 5; i++) {
    const double x = 0.7 * i - 1.3;
    parabola[i] = cag_vec3(x, x * x, 0);
    hyperbola[i] = cag_vec3(x, 1 / x, 0);
  }
  OK(cag_conic_from_conditions(parabola, 5, NULL, 0, CAG_CONIC_GENERAL, &k, &err));
  const double expected[6] = {1, 0, 0, 0, -1, 0};
  for (int i = 0; i < 6; i++) NEAR(k.c[i], expected[i], 1e-12);
  assert_true(k.c[0] == 1 && k.c[2] == 0);
  OK(cag_conic_from_conditions(hyperbola, 5, NULL, 0, CAG_CONIC_GENERAL, &k, &err));
  const double product[6] = {0, 1, 0, 0, 0, -1};
  for (int i = 0; i < 6; i++) NEAR(k.c[i], product[i], 1e-11);
  assert_true(k.c[1] == 1 && k.c[2] == 0 && k.c[0] == 0);
}

// --- Random arcs of triangles ---

static void random_shoulders_have_their_weight(void **state) {
  (void)state;
  seed = 502;
  for (int i = 0; i < 150; i++) {
    CagVec3 t[3];
    for (int k = 0; k < 3; k++) {
      t[k].x = uniform(-3, 3);
      t[k].y = uniform(-3, 3);
      t[k].z = i % 2 ? uniform(-3, 3) : 0;
    }
    const double weight = i % 7 ? uniform(0.1, 4) : 1, s = uniform(0.1, 0.9);
    CagCurve *c;
    double found;
    OK(cag_conic_arc(t[0], t[1], t[2], weight, i % 2 ? 3 : 2, &c, &err));
    // (b0 p + b1 w apex + b2 q) / sum.
    const double b0 = (1 - s) * (1 - s), b1 = 2 * s * (1 - s) * weight, b2 = s * s;
    const CagVec3 expected = cag_scaled(
        cag_madd(cag_madd(cag_scaled(t[0], b0), b1, t[1]), b2, t[2]), 1 / (b0 + b1 + b2));
    const CagVec3 p = at(c, s);
    near_vec(p, expected, 1e-13);
    CagNurbsView v;
    assert_true(cag_curve_nurbs_view(c, &v) && v.rational == (weight != 1));
    OK(cag_conic_shoulder_weight(t[0], t[1], t[2], p, &found, &err));
    NEAR(found, weight, 1e-9 * weight);
    cag_curve_release(c);
    // Points beyond each side, and outside the plane.
    const CagVec3 inside = cag_scaled(cag_add(cag_add(t[0], t[1]), t[2]), 1.0 / 3);
    for (int k = 0; k < 3; k++) {
      const CagVec3 side = cag_lerp(t[k], t[(k + 1) % 3], 0.4);
      FAILS(cag_conic_shoulder_weight(t[0], t[1], t[2], cag_lerp(inside, side, 1.01), &found, &err),
            "shoulder-outside");
      OK(cag_conic_shoulder_weight(t[0], t[1], t[2], cag_lerp(inside, side, 0.99), &found, &err));
    }
    const CagVec3 a = cag_sub(t[1], t[0]), b = cag_sub(t[2], t[0]);
    const CagVec3 n = cag_unit(cag_cross(a, b));
    const double size = cag_norm(a) + cag_norm(b);
    for (int sign = -1; sign <= 1; sign += 2) {
      FAILS(cag_conic_shoulder_weight(t[0], t[1], t[2], cag_madd(inside, sign * 3e-9 * size, n),
                                      &found, &err),
            "shoulder-outside");
      OK(cag_conic_shoulder_weight(t[0], t[1], t[2], cag_madd(inside, sign * 3e-10 * size, n),
                                   &found, &err));
    }
    FAILS(cag_conic_arc(t[0], t[0], t[2], 1, 3, &c, &err), "collinear-points");
    FAILS(cag_conic_arc(t[0], t[1], t[1], 1, 3, &c, &err), "collinear-points");
    FAILS(cag_conic_shoulder_weight(t[0], t[0], t[2], inside, &found, &err), "collinear-points");
    FAILS(cag_conic_arc(t[0], t[1], t[2], INFINITY, 3, &c, &err), "negative-weight");
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(five_conditions_make_each_kind_of_conic),
      cmocka_unit_test(turned_conics_away_from_the_origin_have_their_equations),
      cmocka_unit_test(points_far_away_lose_no_conic),
      cmocka_unit_test(conditions_that_do_not_fix_a_conic_are_named),
      cmocka_unit_test(an_arc_of_a_triangle_bulges_as_its_weight_says),
      cmocka_unit_test(random_conditions_have_their_conic),
      cmocka_unit_test(conditions_leave_no_rounding),
      cmocka_unit_test(random_shoulders_have_their_weight),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
