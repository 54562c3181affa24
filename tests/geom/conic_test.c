// Conics: parabolas and hyperbolas as curves, the general equation, conditions, tangent circles and
// lines, fillets; and formulas fitted to points. Numbers are closed forms or those of the reference
// on plane curves.

#include "geom/basis/regression.h"
#include "geom/curve/circles.h"
#include "geom/curve/conic.h"
#include "support.h"

static CagTransform plane_frame(double x, double y, double angle) {
  CagTransform t = cag_translate(cag_vec3(x, y, 0));
  t.m[0][0] = t.m[1][1] = cos(angle);
  t.m[1][0] = sin(angle);
  t.m[0][1] = -sin(angle);
  t.planar = true;
  return t;
}

static CagVec3 at(const CagCurve *c, double t) {
  CagVec3 p;
  OK(cag_curve_point(c, t, &p, &err));
  return p;
}

// --- Parabola and hyperbola as curves ---

// One of each form, turned and moved.
static size_t arcs(CagCurve *out[5]) {
  const CagTransform f = plane_frame(3, -2, 0.7);
  OK(cag_curve_parabola(1.5, CAG_FORM_QUADRATIC, -1, 2, &f, &out[0], &err));
  OK(cag_curve_parabola(1.5, CAG_FORM_TANGENT, -0.5, 1, &f, &out[1], &err));
  OK(cag_curve_hyperbola(2, 1, CAG_FORM_HYPERBOLIC, -1, 3, &f, &out[2], &err));
  OK(cag_curve_hyperbola(2, 1, CAG_FORM_SECANT, -1, 1.2, &f, &out[3], &err));
  OK(cag_curve_hyperbola(2, 1, CAG_FORM_SECANT, 2, 4, &f, &out[4], &err));
  return 5;
}

static void forms_have_the_points_of_the_text(void **state) {
  (void)state;
  const CagTransform f = plane_frame(0, 0, 0);
  CagCurve *c;
  OK(cag_curve_parabola(2.25, CAG_FORM_TANGENT, 0, 1.2, &f, &c, &err));
  near_vec(at(c, M_PI / 3), cag_vec3(3, 5.19615242270663, 0), 1e-13);
  cag_curve_release(c);
  OK(cag_curve_hyperbola(2, 1, CAG_FORM_SECANT, 0, 1.2, &f, &c, &err));
  near_vec(at(c, M_PI / 3), cag_vec3(4, sqrt(3), 0), 1e-14);
  cag_curve_release(c);
  OK(cag_curve_hyperbola(2, 1, CAG_FORM_SECANT, 2, 4, &f, &c, &err));
  near_vec(at(c, M_PI), cag_vec3(-2, 0, 0), 1e-15);
  cag_curve_release(c);
}

// Richardson's extrapolation of central differences; what it loses is h^4 and rounding / h.
static void derivatives_are_those_of_the_points(void **state) {
  (void)state;
  CagCurve *c[5];
  size_t n = arcs(c);
  for (size_t i = 0; i < n; i++) {
    const double t = c[i]->start + 0.4 * (c[i]->end - c[i]->start), h = 1e-3;
    CagVec3 d[7], e[4][6];
    OK(cag_curve_eval(c[i], t, 6, CAG_SIDE_RIGHT, d, &err));
    for (int k = 0; k < 4; k++) {
      static const double steps[4] = {-2, -1, 1, 2};
      OK(cag_curve_eval(c[i], t + steps[k] * h, 5, CAG_SIDE_RIGHT, e[k], &err));
    }
    for (int k = 0; k < 6; k++) {
      CagVec3 wide = cag_scaled(cag_sub(e[3][k], e[0][k]), -1 / (12 * h));
      CagVec3 slope = cag_madd(wide, 8 / (12 * h), cag_sub(e[2][k], e[1][k]));
      near_vec(slope, d[k + 1], 1e-7 * (1 + cag_norm(d[k + 1])));
    }
    cag_curve_release(c[i]);
  }
}

static void an_arc_satisfies_its_equation_and_so_does_its_rational_form(void **state) {
  (void)state;
  CagCurve *c[5], *exact;
  CagConic k;
  size_t n = arcs(c);
  for (size_t i = 0; i < n; i++) {
    OK(cag_conic_of_curve(c[i], &k, &err));
    OK(cag_curve_to_nurbs(c[i], &exact, &err));
    near_vec(at(exact, exact->start), at(c[i], c[i]->start), 1e-13);
    near_vec(at(exact, exact->end), at(c[i], c[i]->end), 1e-12);
    for (int s = 0; s <= 20; s++) {
      CagVec3 p = at(c[i], c[i]->start + (c[i]->end - c[i]->start) * s / 20);
      CagVec3 q = at(exact, exact->start + (exact->end - exact->start) * s / 20);
      NEAR(cag_conic_value(&k, p), 0, 1e-11 * (1 + cag_dot(p, p)));
      NEAR(cag_conic_value(&k, q), 0, 1e-11 * (1 + cag_dot(q, q)));
    }
    cag_curve_release(exact);
    cag_curve_release(c[i]);
  }
}

static void reversed_cut_and_stretched_arcs_have_the_same_points(void **state) {
  (void)state;
  CagCurve *c[5], *r, *p, *s;
  size_t n = arcs(c);
  for (size_t i = 0; i < n; i++) {
    const double a = c[i]->start, b = c[i]->end;
    OK(cag_curve_reverse(c[i], &r, &err));
    OK(cag_curve_trim(r, a + 0.25 * (b - a), b, &p, &err));
    OK(cag_curve_reparametrize(p, 10, 12, &s, &err));
    for (int k = 0; k <= 8; k++) {
      near_vec(at(r, a + (b - a) * k / 8), at(c[i], b - (b - a) * k / 8), 1e-12);
      near_vec(at(s, 10 + 2 * k / 8.0), at(c[i], b - (b - a) * (0.25 + 0.75 * k / 8)), 1e-12);
    }
    assert_true(r->angular == c[i]->angular && !s->angular);
    cag_curve_release(s);
    cag_curve_release(p);
    cag_curve_release(r);
    cag_curve_release(c[i]);
  }
}

static void boxes_hold_the_arc_and_touch_it(void **state) {
  (void)state;
  CagCurve *c[5];
  size_t n = arcs(c);
  for (size_t i = 0; i < n; i++) {
    CagBounds box = c[i]->kind->hull(c[i], c[i]->start, c[i]->end), seen = CAG_BOUNDS_EMPTY;
    enum { SAMPLES = 20000 };
    for (int k = 0; k <= SAMPLES; k++)
      cag_bounds_add(&seen, at(c[i], fmin(c[i]->end, c[i]->start + (c[i]->end - c[i]->start) * k /
                                                                       (double)SAMPLES)));
    // An extreme between two samples is missed by the square of their distance.
    near_vec(box.min, seen.min, 1e-6);
    near_vec(box.max, seen.max, 1e-6);
    assert_true(box.min.x <= seen.min.x + 1e-13 && box.max.y >= seen.max.y - 1e-13);
    cag_curve_release(c[i]);
  }
}

// Arc length of y^2 = 4 a x from the vertex to parameter t: a (t sqrt(1 + t^2) + asinh t).
static void a_parabola_has_its_known_length(void **state) {
  (void)state;
  const CagTransform f = plane_frame(1, 1, 0.3);
  CagCurve *c;
  double length;
  OK(cag_curve_parabola(2, CAG_FORM_QUADRATIC, 0, 3, &f, &c, &err));
  OK(cag_curve_length(c, 0, 3, &length, &err));
  NEAR(length, 2 * (3 * sqrt(10) + asinh(3)), 1e-9);
  cag_curve_release(c);
}

static void ranges_that_reach_infinity_are_refused(void **state) {
  (void)state;
  const CagTransform f = plane_frame(0, 0, 0);
  CagCurve *c;
  FAILS(cag_curve_hyperbola(2, 1, CAG_FORM_SECANT, 0, M_PI / 2, &f, &c, &err), "domain");
  FAILS(cag_curve_hyperbola(2, 1, CAG_FORM_SECANT, 1, 2, &f, &c, &err), "domain");
  FAILS(cag_curve_parabola(2, CAG_FORM_TANGENT, -M_PI / 2, 0, &f, &c, &err), "domain");
  FAILS(cag_curve_hyperbola(2, 1, CAG_FORM_HYPERBOLIC, 0, 800, &f, &c, &err), "domain");
  FAILS(cag_curve_parabola(2, CAG_FORM_QUADRATIC, 1, 1, &f, &c, &err), "empty-range");
  FAILS(cag_curve_parabola(0, CAG_FORM_QUADRATIC, 0, 1, &f, &c, &err), "radius-not-positive");
  FAILS(cag_curve_hyperbola(1, NAN, CAG_FORM_HYPERBOLIC, 0, 1, &f, &c, &err), "not-finite");
}

// --- Points by recurrences ---

static void recurrences_give_the_points_of_equal_parameters(void **state) {
  (void)state;
  const CagTransform f = plane_frame(3, -2, 0.7);
  enum { POINTS = 1001 };
  static CagVec3 p[POINTS];
  CagCurve *c[7];
  arcs(c);
  OK(cag_curve_arc(4, 1, 0, 2 * M_PI, &f, &c[5], &err));
  OK(cag_curve_arc(2, 2, -1, 2, &f, &c[6], &err));
  for (int i = 0; i < 7; i++) {
    OK(cag_conic_points(c[i], POINTS, p, &err));
    for (int k = 0; k < POINTS; k++)
      near_vec(p[k],
               at(c[i], fmin(c[i]->end, c[i]->start + (c[i]->end - c[i]->start) * k / 1000.0)),
               1e-12);
    if (i == 5) assert_memory_equal(&p[0], &p[POINTS - 1], sizeof *p);
    cag_curve_release(c[i]);
  }
  OK(cag_curve_line(cag_vec3(0, 0, 0), cag_vec3(1, 0, 0), 2, &c[0], &err));
  FAILS(cag_conic_points(c[0], 5, p, &err), "not-a-conic");
  cag_curve_release(c[0]);
}

// --- The general conic ---

// The types of the reference's table; each turned by several angles and moved keeps its type.
static void types_do_not_depend_on_the_place(void **state) {
  (void)state;
  static const struct {
    CagConic k;
    const char *name;
  } cases[] = {{{{2, 0, 3, 0, 0, -6}}, "ellipse"},
               {{{2, 0, 2, 0, 0, -6}}, "circle"},
               {{{2, 0, -3, 0, 0, -6}}, "hyperbola"},
               {{{0, 0, 2, -3, 0, 0}}, "parabola"},
               {{{-1, 0, -2, 0, 0, -3}}, "empty"},
               {{{2, 0, 3, 0, 0, 0}}, "point"},
               {{{2, 0, -3, 0, 0, 0}}, "intersecting_lines"},
               {{{2, 0, 0, 0, 0, -8}}, "parallel_lines"},
               {{{-2, 0, 0, 0, 0, -8}}, "empty"},
               {{{2, 0, 0, 0, 0, 0}}, "double_line"},
               {{{0, 0, 0, 1, 2, 3}}, "line"},
               {{{0, 0, 0, 0, 0, 3}}, "empty"},
               {{{0, 0, 0, 0, 0, 0}}, "plane"}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    for (int a = 0; a < 24; a++) {
      const CagTransform t = plane_frame(a % 3, -2 * (a % 5), a * 0.31);
      CagConic image;
      CagConicClass k;
      OK(cag_conic_transform(&cases[i].k, &t, &image, &err));
      for (int j = 0; j < 6; j++) image.c[j] *= a % 2 ? -1e-7 : 1e6;
      OK(cag_conic_classify(&image, &k, &err));
      assert_string_equal(k.name, cases[i].name);
    }
}

// Example 7 of the reference.
static void a_hyperbola_comes_to_its_standard_form(void **state) {
  (void)state;
  const CagConic c = {{2, -72, 23, 140, -20, 50}};
  CagConicClass k;
  OK(cag_conic_classify(&c, &k, &err));
  assert_string_equal(k.name, "hyperbola");
  NEAR(k.discriminant, 5000, 0);
  near_vec(k.center, cag_vec3(1, 2, 0), 1e-14);
  NEAR(k.a, 2, 1e-14);
  NEAR(k.b, sqrt(2), 1e-14);
  NEAR(k.angle, atan2(3, 4), 1e-14);
  NEAR(k.book_angle, atan2(3, 4), 1e-14);
  NEAR(k.standard[0], -25, 1e-13);
  NEAR(k.standard[1], 50, 1e-13);
  NEAR(k.standard[2], -100, 1e-12);
  NEAR(k.eccentricity, sqrt(6) / 2, 1e-14);
  near_vec(k.foci[0], cag_vec3(1 + 0.8 * sqrt(6), 2 + 0.6 * sqrt(6), 0), 1e-13);
}

static void a_parabola_comes_to_its_standard_form(void **state) {
  (void)state;
  const CagConic c = {{9, -24, 16, -20, -15, 0}};
  CagConicClass k;
  OK(cag_conic_classify(&c, &k, &err));
  assert_string_equal(k.name, "parabola");
  NEAR(k.a, 0.25, 1e-15);
  NEAR(k.angle, atan2(3, 4), 1e-14);
  near_vec(k.center, cag_vec3(0, 0, 0), 1e-14);
  near_vec(k.foci[0], cag_vec3(0.2, 0.15, 0), 1e-14);
}

static void small_and_far_conics_keep_their_type(void **state) {
  (void)state;
  // Radius 1 about (1e5, 1e5): the constant has lost all but 5 digits of 1.
  const CagConic far = {{1, 0, 1, -2e5, -2e5, 2e10 - 1}};
  const CagConic small = {{1, 0, 1, 0, 0, -1e-18}};
  const CagConic thin = {{1, 0, 1e10, 0, 0, -1e10}};
  CagConicClass k;
  OK(cag_conic_classify(&far, &k, &err));
  assert_string_equal(k.name, "circle");
  NEAR(k.a, 1, 1e-5);
  OK(cag_conic_classify(&small, &k, &err));
  assert_string_equal(k.name, "circle");
  OK(cag_conic_classify(&thin, &k, &err));
  assert_string_equal(k.name, "ellipse");
  NEAR(k.a, 1e5, 1e-9);
}

static void branches_satisfy_the_equation(void **state) {
  (void)state;
  static const struct {
    CagConic k;
    size_t count;
  } cases[] = {{{{2, -72, 23, 140, -20, 50}}, 2}, {{{9, -24, 16, -20, -15, 0}}, 1},
               {{{5, 4, 8, -32, -56, 80}}, 1},    {{{1, -1, -2, 0, 0, 0}}, 2},
               {{{1, 4, 4, 0, 0, -9}}, 2},        {{{1, 2, 1, -2, -2, 1}}, 1},
               {{{0, 0, 0, 1, 2, 3}}, 1},         {{{2, 0, 3, 0, 0, 0}}, 0},
               {{{1, 0, 1, 0, 0, 1}}, 0}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    CagCurve *c[2];
    size_t n;
    OK(cag_conic_branches(&cases[i].k, -1, 2, c, &n, &err));
    assert_int_equal(n, cases[i].count);
    while (n > 0) {
      n--;
      for (int s = 0; s <= 10; s++) {
        CagVec3 p = at(c[n], c[n]->start + (c[n]->end - c[n]->start) * s / 10);
        NEAR(cag_conic_value(&cases[i].k, p), 0, 1e-11 * (1 + 100 * cag_dot(p, p)));
      }
      cag_curve_release(c[n]);
    }
  }
}

static void images_satisfy_the_image_of_the_equation(void **state) {
  (void)state;
  const CagConic c = {{5, 4, 8, -32, -56, 80}};
  CagTransform t = plane_frame(1, 2, 0.4);
  CagConic image;
  CagCurve *b[2];
  size_t n;
  t.m[3][0] = 0.03; // projective
  t.m[3][1] = -0.02;
  OK(cag_conic_transform(&c, &t, &image, &err));
  OK(cag_conic_branches(&c, -1, 1, b, &n, &err));
  for (int s = 0; s <= 10; s++) {
    CagVec3 p = cag_transform_point(&t, at(b[0], 2 * M_PI * s / 10));
    NEAR(cag_conic_value(&image, p), 0, 1e-10);
  }
  cag_curve_release(b[0]);
  t.m[0][0] = t.m[1][0] = t.m[3][0] = 0;
  FAILS(cag_conic_transform(&c, &t, &image, &err), "singular-transform");
}

static void a_conic_value_is_its_one_branch(void **state) {
  (void)state;
  const CagConic ellipse = {{1, 0, 4, 0, 0, -4}}, hyperbola = {{1, 0, -1, 0, 0, -1}};
  const CagTransform t = plane_frame(10, 0, M_PI / 2);
  CagCurve *c, *moved;
  CagConic k;
  CagVec3 p;
  double area;
  OK(cag_curve_conic(&ellipse, &c, &err));
  OK(cag_curve_area(c, &area, &p, &err));
  NEAR(area, 2 * M_PI, 1e-12);
  OK(cag_curve_transform(c, &t, &moved, &err));
  assert_true(cag_curve_conic_view(moved, &k));
  NEAR(cag_conic_value(&k, cag_vec3(10, 2, 0)), 0, 1e-12);
  cag_curve_release(moved);
  cag_curve_release(c);
  OK(cag_curve_conic(&hyperbola, &c, &err));
  FAILS(cag_curve_point(c, 0.5, &p, &err), "no-single-curve");
  cag_curve_release(c);
}

static void a_line_meets_a_conic_in_every_way(void **state) {
  (void)state;
  const CagConic circle = {{1, 0, 1, 0, 0, -1}}, parabola = {{0, 0, 1, -4, 0, 0}};
  const CagConic lines = {{1, 0, -1, 0, 0, 0}}, far = {{1, 0, 1, -2e6, 0, 1e12 - 1}};
  CagLineConic kind;
  double t[2];
  OK(cag_conic_line(&circle, cag_vec3(-5, 0.6, 0), cag_vec3(2, 0, 0), &kind, t, &err));
  assert_int_equal(kind, CAG_LINE_TWO);
  NEAR(t[0], 2.1, 1e-14);
  NEAR(t[1], 2.9, 1e-14);
  OK(cag_conic_line(&circle, cag_vec3(3, 1, 0), cag_vec3(1, 0, 0), &kind, t, &err));
  assert_int_equal(kind, CAG_LINE_TANGENT);
  NEAR(t[0], -3, 1e-14);
  OK(cag_conic_line(&circle, cag_vec3(3, 1.0001, 0), cag_vec3(1, 0, 0), &kind, t, &err));
  assert_int_equal(kind, CAG_LINE_NONE);
  OK(cag_conic_line(&parabola, cag_vec3(0, 4, 0), cag_vec3(1, 0, 0), &kind, t, &err));
  assert_int_equal(kind, CAG_LINE_ONE);
  NEAR(t[0], 4, 1e-14);
  OK(cag_conic_line(&lines, cag_vec3(1, 1, 0), cag_vec3(1, 1, 0), &kind, t, &err));
  assert_int_equal(kind, CAG_LINE_WITHIN);
  OK(cag_conic_line(&far, cag_vec3(0, 0, 0), cag_vec3(1, 0, 0), &kind, t, &err));
  assert_int_equal(kind, CAG_LINE_TWO);
  NEAR(t[1] - t[0], 2, 1e-3);
  FAILS(cag_conic_line(&circle, cag_vec3(0, 0, 0), cag_vec3(0, 0, 0), &kind, t, &err),
        "zero-vector");
}

// Example 7: 3 <= x <= 5, lower branch.
static void a_segment_runs_between_its_abscissas(void **state) {
  (void)state;
  const CagConic c = {{2, -72, 23, 140, -20, 50}}, circle = {{1, 0, 1, 0, 0, -25}};
  CagCurve *s;
  CagVec3 p[10];
  OK(cag_conic_segment(&c, 3, 5, false, &s, &err));
  OK(cag_conic_points(s, 10, p, &err));
  near_vec(p[0], cag_vec3(3, 2.871238077084073, 0), 1e-12);
  near_vec(p[1], cag_vec3(3.1396920299483977, 2.805381039715971, 0), 1e-12);
  near_vec(p[8], cag_vec3(4.678871044730245, 2.501566417909783, 0), 1e-12);
  near_vec(p[9], cag_vec3(5, 2.4764631758043167, 0), 1e-12);
  cag_curve_release(s);
  // Clockwise above, counter-clockwise below, and the other way round when x falls.
  static const struct {
    double from, to;
    bool upper;
    double y;
  } ways[] = {{-3, 3, true, 5}, {-3, 3, false, -5}, {3, -3, true, 5}, {3, -3, false, -5}};
  for (int i = 0; i < 4; i++) {
    OK(cag_conic_segment(&circle, ways[i].from, ways[i].to, ways[i].upper, &s, &err));
    near_vec(at(s, s->start), cag_vec3(ways[i].from, 0.8 * ways[i].y, 0), 1e-13);
    near_vec(at(s, (s->start + s->end) / 2), cag_vec3(0, ways[i].y, 0), 1e-13);
    near_vec(at(s, s->end), cag_vec3(ways[i].to, 0.8 * ways[i].y, 0), 1e-13);
    cag_curve_release(s);
  }
  FAILS(cag_conic_segment(&circle, 3, 6, true, &s, &err), "domain");
  FAILS(cag_conic_segment(&(CagConic){{1, 0, -1, 0, 0, -1}}, -2, 2, true, &s, &err), "domain");
}

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
    // The tangents' points need not be among the points.
    OK(cag_conic_from_conditions(points + 2, 1, tangents, 2, CAG_CONIC_GENERAL, &k, &err));
    for (int j = 0; j < 6; j++) NEAR(k.c[j], cases[i].k.c[j], 1e-12);
  }
}

// With u and v along the axes: u^2 / a^2 + v^2 / b^2 = 1, and with - for a hyperbola.
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
  // A point of the unit circle off the middle gives the same weight.
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

// --- Circles and lines that touch ---

static void a_corner_has_four_circles(void **state) {
  (void)state;
  const CagTouched a = {{1, 1, 0}, {4, 1, 0}, 0}, b = {{2, 5, 0}, {2, -6, 0}, 0};
  static const CagVec3 centers[2][2] = {
      {{3.645731058560915, 2.43451506944354, 0}, {2.186218292329355, 2.06963687788565, 0}},
      {{4.121474015362952, 1.0072861990374267, 0}, {2.6619612491313926, 0.6424080074795367, 0}}};
  for (int right = 0; right < 2; right++)
    for (int near = 0; near < 2; near++) {
      const CagTouchChoice choice = {.right = right, .near = near};
      CagVec3 center, touch[2];
      OK(cag_tangent_circle(&a, &b, 0.75, choice, &center, touch, &err));
      near_vec(center, centers[right][near], 1e-13);
      for (int i = 0; i < 2; i++) NEAR(cag_norm(cag_sub(center, touch[i])), 0.75, 1e-13);
    }
  const CagTouched c = {{0, 9, 0}, {-8, -2, 0}, 0};
  CagVec3 center, touch[2];
  FAILS(cag_tangent_circle(&a, &c, 1, (CagTouchChoice){0}, &center, touch, &err), "parallel-lines");
  FAILS(cag_tangent_circle(&a, &b, 0, (CagTouchChoice){0}, &center, touch, &err),
        "radius-not-positive");
}

static void circles_touch_from_outside_and_inside(void **state) {
  (void)state;
  const CagTouched a = {{0, 0, 0}, {0, 0, 0}, 3}, b = {{8, 0, 0}, {0, 0, 0}, 2};
  const CagTouched l = {{0, -5, 0}, {1, 0, 0}, 0};
  for (int in_a = 0; in_a < 2; in_a++)
    for (int in_b = 0; in_b < 2; in_b++)
      for (int right = 0; right < 2; right++) {
        const double radius = 7.5;
        CagVec3 center, touch[2];
        const CagTouchChoice choice = {.right = right, .inside = {in_a, in_b}};
        OK(cag_tangent_circle(&a, &b, radius, choice, &center, touch, &err));
        assert_true(right == (center.y < 0));
        NEAR(cag_norm(center), in_a ? 4.5 : 10.5, 1e-12);
        NEAR(cag_norm(cag_sub(center, b.p)), in_b ? 5.5 : 9.5, 1e-12);
        NEAR(cag_norm(touch[0]), 3, 1e-13);
        NEAR(cag_norm(cag_sub(touch[0], center)), radius, 1e-12);
        NEAR(cag_norm(cag_sub(touch[1], center)), radius, 1e-12);
      }
  CagVec3 center, touch[2];
  // Above the line y = -5 and outside the circle: center at height -4, 4 from the origin.
  OK(cag_tangent_circle(&l, &a, 1, (CagTouchChoice){0}, &center, touch, &err));
  near_vec(center, cag_vec3(0, -4, 0), 1e-12);
  near_vec(touch[1], cag_vec3(0, -3, 0), 1e-12);
  FAILS(cag_tangent_circle(&l, &a, 0.5, (CagTouchChoice){0}, &center, touch, &err),
        "no-tangent-circle");
}

static void tangents_from_a_point_touch(void **state) {
  (void)state;
  const CagTransform f = plane_frame(0, 0, 0);
  CagCurve *c;
  CagTangentLine *lines;
  size_t n;
  OK(cag_curve_arc(3, 1, 0, 2 * M_PI, &f, &c, &err));
  // The polar of (5, 0): x = 9/5.
  OK(cag_tangents_from_point(c, cag_vec3(5, 0, 0), &lines, &n, &err));
  assert_int_equal(n, 2);
  near_vec(lines[0].p, cag_vec3(1.8, 0.8, 0), 1e-12);
  near_vec(lines[1].p, cag_vec3(1.8, -0.8, 0), 1e-12);
  free(lines);
  OK(cag_tangents_from_point(c, cag_vec3(1, 0.2, 0), &lines, &n, &err));
  assert_int_equal(n, 0);
  free(lines);
  OK(cag_tangents_from_point(c, cag_vec3(0, 1, 0), &lines, &n, &err));
  assert_int_equal(n, 1);
  near_vec(cag_cross(cag_sub(lines[0].q, lines[0].p), cag_vec3(1, 0, 0)), cag_vec3(0, 0, 0), 1e-12);
  free(lines);
  cag_curve_release(c);
}

static size_t common_tangents(double x, double r, double s) {
  CagCurve *a, *b;
  CagTangentLine *lines;
  size_t n;
  CagTransform f = plane_frame(0, 0, 0), g = plane_frame(x, 0.5, 0);
  OK(cag_curve_arc(r, r, 0, 2 * M_PI, &f, &a, &err));
  OK(cag_curve_arc(s, s, 0, 2 * M_PI, &g, &b, &err));
  OK(cag_tangents_of_two(a, b, &lines, &n, &err));
  for (size_t i = 0; i < n; i++) {
    const CagVec3 d = cag_sub(lines[i].q, lines[i].p);
    NEAR(cag_dot(d, lines[i].p), 0, 1e-10);
    NEAR(cag_dot(d, cag_sub(lines[i].q, cag_vec3(x, 0.5, 0))), 0, 1e-10);
  }
  free(lines);
  cag_curve_release(a);
  cag_curve_release(b);
  return n;
}

static void two_circles_have_up_to_four_tangents(void **state) {
  (void)state;
  assert_int_equal(common_tangents(5, 1, 2), 4);
  assert_int_equal(common_tangents(2, 1, 2), 2);
  assert_int_equal(common_tangents(0.1, 1, 2), 0);
}

// The four tangents of two crossing ellipses with swapped axes
// are symmetric: x + y = +-sqrt(5), x - y = +-sqrt(5) (a^2 + b^2 = 5).
static void two_ellipses_have_their_tangents(void **state) {
  (void)state;
  const CagTransform f = plane_frame(0, 0, 0);
  CagCurve *a, *b;
  CagTangentLine *lines;
  size_t n;
  OK(cag_curve_arc(2, 1, 0, 2 * M_PI, &f, &a, &err));
  OK(cag_curve_arc(1, 2, 0, 2 * M_PI, &f, &b, &err));
  OK(cag_tangents_of_two(a, b, &lines, &n, &err));
  assert_int_equal(n, 4);
  for (size_t i = 0; i < n; i++) {
    NEAR(fabs(lines[i].p.x) + fabs(lines[i].p.y), sqrt(5), 1e-12);
    NEAR(fabs(lines[i].q.x) + fabs(lines[i].q.y), sqrt(5), 1e-12);
  }
  free(lines);
  cag_curve_release(a);
  cag_curve_release(b);
}

static void a_fillet_leaves_and_enters_along_the_tangents(void **state) {
  (void)state;
  const CagVec3 bend[3] = {{0, 0, 0}, {6, 7, 0}, {10, 0, 0}};
  const CagTransform f = plane_frame(15, 0, 0);
  CagCurve *a, *b, *arc;
  CagVec3 in, out, first, last;
  double t, u;
  OK(cag_curve_bezier(bend, NULL, 3, 2, &a, &err));
  OK(cag_curve_arc(5, 5, -M_PI, 0, &f, &b, &err));
  OK(cag_fillet(a, b, 0.7, &arc, &t, &u, &err));
  near_vec(at(arc, arc->start), at(a, t), 1e-11);
  near_vec(at(arc, arc->end), at(b, u), 1e-11);
  OK(cag_curve_tangent(a, t, CAG_SIDE_LEFT, &in, &err));
  OK(cag_curve_tangent(b, u, CAG_SIDE_RIGHT, &out, &err));
  OK(cag_curve_tangent(arc, arc->start, CAG_SIDE_RIGHT, &first, &err));
  OK(cag_curve_tangent(arc, arc->end, CAG_SIDE_LEFT, &last, &err));
  near_vec(in, first, 1e-10);
  near_vec(out, last, 1e-10);
  cag_curve_release(arc);
  FAILS(cag_fillet(a, b, 100, &arc, &t, &u, &err), "radius-too-large");
  cag_curve_release(a);
  cag_curve_release(b);
}

static void rounding_shortens_by_what_the_arcs_save(void **state) {
  (void)state;
  const CagVec3 square[4] = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
  CagCurve *c, *r;
  CagVec3 center;
  double x;
  OK(cag_curve_polyline(square, 4, true, 2, &c, &err));
  OK(cag_curve_rounded(c, 1, &r, &err));
  assert_true(r->closed);
  OK(cag_curve_length(r, r->start, r->end, &x, &err));
  NEAR(x, 8 + 2 * M_PI, 1e-12);
  OK(cag_curve_area(r, &x, &center, &err));
  NEAR(x, 12 + M_PI, 1e-12);
  cag_curve_release(r);
  // The arcs of radius 2 meet: a circle.
  OK(cag_curve_rounded(c, 2, &r, &err));
  OK(cag_curve_area(r, &x, &center, &err));
  NEAR(x, 4 * M_PI, 1e-12);
  cag_curve_release(r);
  FAILS_AT(cag_curve_rounded(c, 2.1, &r, &err), "radius-too-large", 0);
  FAILS(cag_curve_rounded(c, 0, &r, &err), "radius-not-positive");
  cag_curve_release(c);
}

// --- Formulas ---

static void formulas_fit_in_the_least_squares_sense(void **state) {
  (void)state;
  const double x[5] = {0, 1, 2, 3, 4}, y[5] = {1, 2, 2, 4, 3};
  const double px[4] = {1, 2, 3, 4}, py[4] = {2, 5.656854249492381, 10.392304845413264, 16};
  double c[6], rest;
  OK(cag_fit_formula(x, y, 5, CAG_MODEL_POLYNOMIAL, 2, c, &rest, &err));
  NEAR(c[0], 32.0 / 35, 1e-13);
  NEAR(c[1], 41.0 / 35, 1e-13);
  NEAR(c[2], -1.0 / 7, 1e-13);
  NEAR(rest, 46.0 / 35, 1e-13);
  OK(cag_fit_formula(px, py, 4, CAG_MODEL_POWER, 0, c, &rest, &err));
  NEAR(c[0], 2, 1e-12);
  NEAR(c[1], 1.5, 1e-12);
  FAILS_AT(cag_fit_formula(x, y, 5, CAG_MODEL_POWER, 0, c, &rest, &err), "domain", 0);
  FAILS(cag_fit_formula(x, y, 2, CAG_MODEL_POLYNOMIAL, 2, c, &rest, &err), "underdetermined");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(forms_have_the_points_of_the_text),
      cmocka_unit_test(derivatives_are_those_of_the_points),
      cmocka_unit_test(an_arc_satisfies_its_equation_and_so_does_its_rational_form),
      cmocka_unit_test(reversed_cut_and_stretched_arcs_have_the_same_points),
      cmocka_unit_test(boxes_hold_the_arc_and_touch_it),
      cmocka_unit_test(a_parabola_has_its_known_length),
      cmocka_unit_test(ranges_that_reach_infinity_are_refused),
      cmocka_unit_test(recurrences_give_the_points_of_equal_parameters),
      cmocka_unit_test(types_do_not_depend_on_the_place),
      cmocka_unit_test(a_hyperbola_comes_to_its_standard_form),
      cmocka_unit_test(a_parabola_comes_to_its_standard_form),
      cmocka_unit_test(small_and_far_conics_keep_their_type),
      cmocka_unit_test(branches_satisfy_the_equation),
      cmocka_unit_test(images_satisfy_the_image_of_the_equation),
      cmocka_unit_test(a_conic_value_is_its_one_branch),
      cmocka_unit_test(a_line_meets_a_conic_in_every_way),
      cmocka_unit_test(a_segment_runs_between_its_abscissas),
      cmocka_unit_test(five_conditions_make_each_kind_of_conic),
      cmocka_unit_test(turned_conics_away_from_the_origin_have_their_equations),
      cmocka_unit_test(points_far_away_lose_no_conic),
      cmocka_unit_test(conditions_that_do_not_fix_a_conic_are_named),
      cmocka_unit_test(an_arc_of_a_triangle_bulges_as_its_weight_says),
      cmocka_unit_test(a_corner_has_four_circles),
      cmocka_unit_test(circles_touch_from_outside_and_inside),
      cmocka_unit_test(tangents_from_a_point_touch),
      cmocka_unit_test(two_circles_have_up_to_four_tangents),
      cmocka_unit_test(two_ellipses_have_their_tangents),
      cmocka_unit_test(a_fillet_leaves_and_enters_along_the_tangents),
      cmocka_unit_test(rounding_shortens_by_what_the_arcs_save),
      cmocka_unit_test(formulas_fit_in_the_least_squares_sense)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
