// Conics: parabolas and hyperbolas as curves, and the general equation. The expected values are
// closed forms, or those of the reference on plane curves.

#include "conic_support.h"
#include "geom/curve/conic.h"
#include "geom/curve/family.h"
#include "geom/curve/nurbs.h"

// --- Parabola and hyperbola as curves ---

// One curve of each form, rotated and translated.
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

// Richardson's extrapolation of central differences, whose error is of the order h^4 plus rounding
// / h.
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

// A rational piece spans at most 2 of the hyperbolic parameter, and the number of pieces is
// minimal.
static void rational_hyperbolas_have_as_few_pieces_as_their_weights_allow(void **state) {
  (void)state;
  seed = 91;
  const CagTransform f = plane_frame(2, -1, 0.4);
  for (int i = 0; i < 60; i++) {
    const int pieces = 1 + i % 10;
    const double way = i % 2 ? 2.0 * pieces : 2 * (pieces - uniform(0.01, 0.99));
    const double from = uniform(-12, -8);
    CagCurve *c, *exact;
    OK(cag_curve_hyperbola(2, 1, CAG_FORM_HYPERBOLIC, from, from + way, &f, &c, &err));
    OK(cag_curve_to_nurbs(c, &exact, &err));
    const CagNurbs *n = cag_nurbs_data(exact);
    assert_non_null(n);
    assert_int_equal((int)n->count, 2 * pieces + 1);
    for (size_t k = 0; k < n->count; k++)
      assert_true(n->homogeneous[4 * k + 3] >= 1 && n->homogeneous[4 * k + 3] <= cosh(1) + 1e-12);
    cag_curve_release(exact);
    cag_curve_release(c);
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
    // The samples miss an extremum by the square of their distance.
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

// The types of the reference's table. Each keeps its type when rotated by several angles and
// translated.
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
  // Radius 1 about (1e5, 1e5): only 5 digits of 1 remain in the constant.
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
  // Both branches over -2..2: x = cosh t or -cosh t, y = sinh t.
  CagBounds box = c->kind->hull(c, 0, 1);
  near_vec(box.min, cag_vec3(-cosh(2), -sinh(2), 0), 1e-12);
  near_vec(box.max, cag_vec3(cosh(2), sinh(2), 0), 1e-12);
  cag_curve_release(c);
  // The lines y = x and y = -x.
  const CagConic lines = {{1, 0, -1, 0, 0, 0}};
  OK(cag_curve_conic(&lines, &c, &err));
  box = c->kind->hull(c, 0, 1);
  near_vec(box.min, cag_vec3(-sqrt(2), -sqrt(2), 0), 1e-12);
  near_vec(box.max, cag_vec3(sqrt(2), sqrt(2), 0), 1e-12);
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
  // Clockwise above and counter-clockwise below, and reversed if x decreases.
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

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(forms_have_the_points_of_the_text),
      cmocka_unit_test(derivatives_are_those_of_the_points),
      cmocka_unit_test(an_arc_satisfies_its_equation_and_so_does_its_rational_form),
      cmocka_unit_test(rational_hyperbolas_have_as_few_pieces_as_their_weights_allow),
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
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
