// Conics: parabolas and hyperbolas as curves, the general equation, conditions, tangent circles and
// lines, fillets; and formulas fitted to points. Numbers are closed forms or those of the reference
// on plane curves.

#include "geom/basis/regression.h"
#include "geom/curve/circles.h"
#include "geom/curve/conic.h"
#include "geom/curve/family.h"
#include "random.h"
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

// --- Random conics ---

// A conic by its standard position: alpha u^2 + beta v^2 + delta u = kappa along the axes u, v,
// which are turned and moved.
typedef struct Standard {
  double alpha, beta, delta, kappa, angle, factor;
  CagVec3 center;
} Standard;

static CagVec3 placed(const Standard *s, double u, double v) {
  const double c = cos(s->angle), n = sin(s->angle);
  return cag_vec3(s->center.x + u * c - v * n, s->center.y + u * n + v * c, 0);
}

// u = c (x - m) + n (y - k), v = c (y - k) - n (x - m), multiplied out.
static CagConic equation(const Standard *s) {
  const double c = cos(s->angle), n = sin(s->angle), m = s->center.x, k = s->center.y;
  const double a = s->alpha * c * c + s->beta * n * n, d = s->alpha * n * n + s->beta * c * c;
  const double b = 2 * c * n * (s->alpha - s->beta);
  const double p = s->delta * c, q = s->delta * n;
  CagConic out = {{a, b, d, p - 2 * a * m - b * k, q - 2 * d * k - b * m,
                   a * m * m + b * m * k + d * k * k - p * m - q * k - s->kappa}};
  for (int i = 0; i < 6; i++) out.c[i] *= s->factor;
  return out;
}

static Standard random_standard(double alpha, double beta, double delta, double kappa) {
  Standard s = {alpha, beta, delta, kappa, 0, 0, {0, 0, 0}};
  s.angle = uniform(-M_PI, M_PI);
  s.center.x = uniform(-3, 3);
  s.center.y = uniform(-3, 3);
  s.factor = uniform(-1, 1) < 0 ? -uniform(0.01, 100) : uniform(0.01, 100);
  return s;
}

// Angles of lines differ by a multiple of a half turn, those of directions by one of a turn.
static void near_angle(double a, double b, double period, double tolerance) {
  NEAR(remainder(a - b, period), 0, tolerance);
}

// The parts of the answer that hold for every conic.
static void check_book_axes(const CagConic *c, const CagConicClass *k) {
  const double cosine = cos(k->book_angle), sine = sin(k->book_angle);
  double size = 0;
  for (int i = 0; i < 6; i++) size = fmax(size, fabs(c->c[i]));
  assert_true(fabs(k->book_angle) <= M_PI / 4 + 1e-15);
  const CagConic rotated = {
      {k->rotated[0], k->rotated[1], k->rotated[2], k->rotated[3], k->rotated[4], k->rotated[5]}};
  assert_true(k->rotated[1] == 0);
  for (int i = 0; i < 6; i++) {
    const double x = uniform(-3, 3), y = uniform(-3, 3);
    const CagVec3 p = {x * cosine - y * sine, x * sine + y * cosine, 0};
    NEAR(cag_conic_value(&rotated, cag_vec3(x, y, 0)), cag_conic_value(c, p), 1e-13 * 40 * size);
    if (!k->has_center) continue;
    NEAR(k->standard[0] * x * x + k->standard[1] * y * y - k->standard[2],
         cag_conic_value(c, cag_add(k->center, p)), 1e-12 * 100 * size);
  }
  NEAR(k->discriminant, c->c[1] * c->c[1] - 4 * c->c[0] * c->c[2], 1e-13 * size * size);
}

static void random_ellipses_and_hyperbolas_are_classified(void **state) {
  (void)state;
  seed = 4711;
  for (int i = 0; i < 400; i++) {
    const double a = uniform(0.3, 3), b = i % 8 == 2 ? a : uniform(0.3, 3);
    const bool hyperbola = i % 2;
    const Standard s = random_standard(1 / (a * a), (hyperbola ? -1 : 1) / (b * b), 0, 1);
    const CagConic c = equation(&s);
    CagConicClass k;
    OK(cag_conic_classify(&c, &k, &err));
    check_book_axes(&c, &k);
    assert_string_equal(k.name, hyperbola ? "hyperbola" : a == b ? "circle" : "ellipse");
    assert_true(k.has_center && k.line_count == 0);
    near_vec(k.center, s.center, 1e-11);
    NEAR(k.a, hyperbola ? a : fmax(a, b), 1e-11);
    NEAR(k.b, hyperbola ? b : fmin(a, b), 1e-11);
    assert_true(k.angle > -M_PI / 2 && k.angle <= M_PI / 2);
    if (a == b) {
      assert_true(k.angle == 0 && k.eccentricity == 0 && k.focus_count == 1);
      near_vec(k.foci[0], s.center, 1e-11);
      continue;
    }
    near_angle(k.angle, hyperbola || a > b ? s.angle : s.angle + M_PI / 2, M_PI,
               1e-12 / fabs(a - b) + (hyperbola ? 1e-12 : 0));
    const double square = hyperbola ? 1 + b * b / (a * a) : 1 - k.b * k.b / (k.a * k.a);
    NEAR(k.eccentricity * k.eccentricity, square, 1e-11);
    // The sum of the distances of a point from the foci, or their difference, is the major axis.
    assert_int_equal(k.focus_count, 2);
    assert_true(cag_dot(cag_sub(k.foci[0], k.center), cag_vec3(cos(k.angle), sin(k.angle), 0)) > 0);
    const double t = uniform(-2, 2), u = hyperbola ? cosh(t) : cos(t),
                 v = hyperbola ? sinh(t) : sin(t);
    const CagVec3 p = placed(&s, a * u, b * v);
    const double one = cag_norm(cag_sub(p, k.foci[0])), two = cag_norm(cag_sub(p, k.foci[1]));
    NEAR(hyperbola ? fabs(one - two) : one + two, 2 * k.a, 1e-10);
  }
}

static void random_parabolas_are_classified(void **state) {
  (void)state;
  seed = 815;
  for (int i = 0; i < 200; i++) {
    const double p = uniform(0.1, 3);
    const Standard s = random_standard(0, 1, -4 * p, 0);
    const CagConic c = equation(&s);
    CagConicClass k;
    OK(cag_conic_classify(&c, &k, &err));
    check_book_axes(&c, &k);
    assert_string_equal(k.name, "parabola");
    assert_true(!k.has_center && k.line_count == 0 && k.focus_count == 1 && k.eccentricity == 1);
    near_vec(k.center, s.center, 1e-10);
    near_vec(k.foci[0], placed(&s, p, 0), 1e-10);
    NEAR(k.a, p, 1e-11);
    assert_true(k.angle > -M_PI && k.angle <= M_PI);
    near_angle(k.angle, s.angle, 2 * M_PI, 1e-11);
  }
  // Into its opening: along -X it is 180deg.
  for (int sign = -1; sign <= 1; sign += 2) {
    const CagConic c = {{0, 0, 1.0 * sign, 4.0 * sign, 0, 0}};
    CagConicClass k;
    OK(cag_conic_classify(&c, &k, &err));
    NEAR(k.angle, M_PI, 0);
  }
}

// One of the conic's lines is that through the point with the normal.
static void has_line(const CagConicClass *k, CagVec3 through, double normal, size_t i) {
  const double *line = k->lines[i];
  NEAR(hypot(line[0], line[1]), 1, 1e-14);
  assert_true(line[0] > 0 || (line[0] == 0 && line[1] > 0));
  NEAR(line[0] * through.x + line[1] * through.y + line[2], 0, 1e-5);
  NEAR(line[0] * sin(normal) - line[1] * cos(normal), 0, 1e-6);
}

static void random_lines_and_nothing_are_classified(void **state) {
  (void)state;
  seed = 99;
  for (int i = 0; i < 300; i++) {
    const double a = uniform(0.3, 3), b = uniform(0.3, 3);
    const double alpha = i % 6 == 0 || i % 6 >= 4 ? 1 / (a * a) : 0;
    const double beta = (i % 6 == 0 ? -1 : 1) / (b * b);
    static const double kappas[6] = {0, 1, 0, -1, 0, -1};
    static const char *const names[6] = {
        "intersecting_lines", "parallel_lines", "double_line", "empty", "point", "empty"};
    static const size_t lines[6] = {2, 2, 1, 0, 0, 0};
    const Standard s = random_standard(alpha, beta, 0, kappas[i % 6]);
    CagConic c = equation(&s);
    if (i % 6 == 2) { // the square of a line, without digits lost in its constant
      const double p = -sin(s.angle), q = cos(s.angle), r = -p * s.center.x - q * s.center.y;
      c = (CagConic){{p * p, 2 * p * q, q * q, 2 * p * r, 2 * q * r, r * r}};
    }
    CagConicClass k;
    OK(cag_conic_classify(&c, &k, &err));
    check_book_axes(&c, &k);
    assert_string_equal(k.name, names[i % 6]);
    assert_int_equal(k.line_count, lines[i % 6]);
    assert_true(k.has_center == (alpha != 0) && k.focus_count == 0);
    if (k.has_center) near_vec(k.center, s.center, 1e-11);
    if (i % 6 == 0) {
      // u / a = +-v / b; in either order.
      const double turn = atan2(1 / b, 1 / a);
      const bool swapped =
          fabs(sin(s.angle + turn) * k.lines[0][0] - cos(s.angle + turn) * k.lines[0][1]) > 1e-6;
      has_line(&k, s.center, s.angle + turn, swapped);
      has_line(&k, s.center, s.angle - turn, !swapped);
    } else if (i % 6 == 1) {
      const bool swapped = fabs(k.lines[0][0] * placed(&s, 0, b).x +
                                k.lines[0][1] * placed(&s, 0, b).y + k.lines[0][2]) > 1e-6;
      has_line(&k, placed(&s, 0, b), s.angle + M_PI / 2, swapped);
      has_line(&k, placed(&s, 0, -b), s.angle + M_PI / 2, !swapped);
    } else if (i % 6 == 2) {
      has_line(&k, s.center, s.angle + M_PI / 2, 0);
    }
  }
}

static void lines_of_axes_are_exact(void **state) {
  (void)state;
  static const struct {
    CagConic c;
    double lines[2][3];
  } cases[] = {{{{1, 0, 0, 0, 0, -4}}, {{1, 0, 2}, {1, 0, -2}}},
               {{{0, 0, 1, 0, 0, -4}}, {{0, 1, 2}, {0, 1, -2}}},
               {{{0, 1, 0, 0, 0, 0}}, {{1, 0, 0}, {0, 1, 0}}},
               {{{0, 0, 0, 0, -2, 4}}, {{0, 1, -2}, {0, 0, 0}}},
               {{{0, 0, 0, -2, 0, 4}}, {{1, 0, -2}, {0, 0, 0}}},
               {{{0, 0, 0, -2e9, 1e-4, 4e9}}, {{1, 0, -2}, {0, 0, 0}}},
               {{{0, 0, 0, 1e-4, -2e9, 4e9}}, {{0, 1, -2}, {0, 0, 0}}}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    CagConicClass k;
    OK(cag_conic_classify(&cases[i].c, &k, &err));
    check_book_axes(&cases[i].c, &k);
    const bool swapped = k.line_count == 2 && fabs(k.lines[0][2] - cases[i].lines[0][2]) +
                                                      fabs(k.lines[0][0] - cases[i].lines[0][0]) >
                                                  1e-9;
    for (size_t j = 0; j < k.line_count; j++)
      for (int m = 0; m < 3; m++) {
        const double x = k.lines[swapped ? 1 - j : j][m];
        NEAR(x, cases[i].lines[j][m], 1e-15);
        assert_false(signbit(x) && x == 0);
        if (m < 2) assert_true(x == cases[i].lines[j][m]);
      }
  }
}

// The axis of a conic lies in (-90deg, 90deg], and parts of zero are positive.
static void upright_axes_are_at_90_degrees(void **state) {
  (void)state;
  static const CagConic upright[] = {{{4, 0, 1, 0, 0, -4}},
                                     {{-1, 0, 1, 0, 0, -1}},
                                     {{4, -1e-15, 1, 0, 0, -4}},
                                     {{4, 1e-15, 1, 0, 0, -4}},
                                     {{-4, 0, -1, 0, 0, 4}}};
  for (size_t i = 0; i < sizeof upright / sizeof *upright; i++) {
    CagConicClass k;
    OK(cag_conic_classify(&upright[i], &k, &err));
    NEAR(k.angle, M_PI / 2, 1e-15);
    assert_false(signbit(k.center.x) || signbit(k.center.y) ||
                 signbit(k.standard[2]) != (k.standard[2] < 0));
  }
  CagConicClass k;
  // A part of 5e-7 is no rounding, however small the coefficients.
  OK(cag_conic_classify(&(CagConic){{0, 0, 0, 2e-9, 1e-15, 4e-9}}, &k, &err));
  NEAR(k.lines[0][1], 5e-7, 1e-12);
  OK(cag_conic_classify(&(CagConic){{0, 0, 0, 1e-15, 2e-9, 4e-9}}, &k, &err));
  NEAR(k.lines[0][0], 5e-7, 1e-12);
  OK(cag_conic_classify(&(CagConic){{1, 2, 1, 0, 0, -4}}, &k, &err));
  NEAR(k.book_angle, M_PI / 4, 0);
  OK(cag_conic_classify(&(CagConic){{1, -2, 1, 0, 0, -4}}, &k, &err));
  NEAR(k.book_angle, -M_PI / 4, 0);
}

// Eigenvalues with a ratio of 1e-10 belong to an ellipse, with 1e-12 to a parabola; semi-axes with
// a difference of 1e-10 to a circle, with 1e-8 not. Sums of 1e-13 of their terms are 0, of 1e-10
// not.
static void limits_of_classes_are_relative(void **state) {
  (void)state;
  static const struct {
    CagConic c;
    const char *name;
  } cases[] = {{{{1, 0, 1e-10, 0, 0, -1}}, "ellipse"},
               {{{1, 0, 1e-12, 0, 1, -1}}, "parabola"},
               {{{1e-10, 0, -1, 0, 0, -1}}, "hyperbola"},
               {{{1, 0, 1 + 4e-10, 0, 0, -1}}, "circle"},
               {{{1, 0, 1 + 4e-8, 0, 0, -1}}, "ellipse"},
               {{{1, 0, 1, 200, 0, 1e4 + 1e-9}}, "point"},
               {{{1, 0, 1, 200, 0, 1e4 - 1e-5}}, "circle"},
               {{{1, 0, 1, 0, -200, 1e4 - 1e-5}}, "circle"},
               {{{1, 0, 1, 200, 0, 1e4 + 1e-5}}, "empty"},
               {{{1, 0, 0, 200, 0, 1e4 + 1e-9}}, "double_line"},
               {{{1, 0, 0, 200, 0, 1e4 - 1e-5}}, "parallel_lines"},
               {{{1, 0, 0, 200, 0, 1e4 + 1e-5}}, "empty"},
               {{{1, 0, 0, 200, 1e-10, 1e4 + 1e-9}}, "double_line"},
               {{{1, 0, 0, 200, 1e-7, 1e4}}, "parabola"},
               {{{1, 0, 0, 0, 1e-12, -1}}, "parallel_lines"},
               {{{1, 0, 0, 0, 1e-9, -1}}, "parabola"}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    for (int sign = -1; sign <= 1; sign += 2) {
      CagConic c = cases[i].c;
      CagConicClass k;
      for (int j = 0; j < 6; j++) c.c[j] *= sign;
      OK(cag_conic_classify(&c, &k, &err));
      assert_string_equal(k.name, cases[i].name);
    }
  for (int i = 0; i < 6; i++) {
    CagConic c = {{1, 2, 3, 4, 5, 6}};
    CagConicClass k;
    c.c[i] = i % 2 ? NAN : -INFINITY;
    FAILS_AT(cag_conic_classify(&c, &k, &err), "not-finite", i);
  }
}

// The value of the image at the image of a point, with the homogeneous weight squared, is that of
// the conic at the point.
static void images_under_random_maps_keep_the_value(void **state) {
  (void)state;
  seed = 31;
  for (int i = 0; i < 200; i++) {
    CagTransform t = cag_transform_identity();
    CagConic c, image;
    static const int place[3] = {0, 1, 3};
    for (int r = 0; r < 3; r++)
      for (int k = 0; k < 3; k++)
        t.m[place[r]][place[k]] = (r == k) + uniform(-0.4, 0.4) * (r == 2 && k < 2 ? 0.2 : 1);
    for (int k = 0; k < 6; k++) c.c[k] = uniform(-1, 1);
    OK(cag_conic_transform(&c, &t, &image, &err));
    for (int k = 0; k < 8; k++) {
      const double x = uniform(-1, 1), y = uniform(-1, 1);
      const double in[4] = {x, y, 0, 1};
      double h[4];
      cag_transform_homogeneous(&t, in, h);
      const double value = cag_conic_value(&image, cag_vec3(h[0] / h[3], h[1] / h[3], 0));
      NEAR(value * h[3] * h[3], cag_conic_value(&c, cag_vec3(x, y, 0)), 1e-11);
    }
  }
  // A flat map is refused, however it is turned; one that is only small is not.
  for (int i = 0; i < 50; i++) {
    CagTransform t = plane_frame(uniform(-2, 2), 1, uniform(-3, 3));
    const CagConic c = {{1, 0, 1, 0, 0, -1}};
    const double slope = ldexp(i % 2 ? 1 : -1, i % 7 - 3);
    CagConic image;
    for (int r = 0; r < 2; r++)
      for (int k = 0; k < 2; k++) t.m[r][k] *= 1e-7;
    OK(cag_conic_transform(&c, &t, &image, &err));
    for (int r = 0; r < 2; r++) t.m[r][1] = slope * t.m[r][0];
    FAILS(cag_conic_transform(&c, &t, &image, &err), "singular-transform");
  }
}

static void polars_are_half_the_gradient(void **state) {
  (void)state;
  seed = 5;
  for (int i = 0; i < 50; i++) {
    CagConic c;
    CagVec3 p = {0, 0, 0}, q = {0, 0, 0};
    double line[3], other[3];
    for (int k = 0; k < 6; k++) c.c[k] = uniform(-1, 1);
    p.x = uniform(-2, 2);
    p.y = uniform(-2, 2);
    q.x = uniform(-2, 2);
    q.y = uniform(-2, 2);
    cag_conic_polar(&c, p, line);
    cag_conic_polar(&c, q, other);
    // Differences of a quadratic form are exact.
    const CagVec3 x = {1, 0, 0}, y = {0, 1, 0};
    NEAR(4 * line[0], cag_conic_value(&c, cag_add(p, x)) - cag_conic_value(&c, cag_sub(p, x)),
         1e-13);
    NEAR(4 * line[1], cag_conic_value(&c, cag_add(p, y)) - cag_conic_value(&c, cag_sub(p, y)),
         1e-13);
    NEAR(line[0] * p.x + line[1] * p.y + line[2], cag_conic_value(&c, p), 1e-13);
    NEAR(line[0] * q.x + line[1] * q.y + line[2], other[0] * p.x + other[1] * p.y + other[2],
         1e-13);
  }
}

static void branches_run_as_documented(void **state) {
  (void)state;
  seed = 12;
  for (int i = 0; i < 100; i++) {
    const double a = uniform(0.5, 3), b = uniform(0.3, a - 0.1);
    static const double alphas[5] = {1, 1, 0, 1, 0}, betas[5] = {1, -1, 1, -1, 1};
    static const double kappas[5] = {1, 1, 0, 0, 1};
    const int kind = i % 5; // ellipse, hyperbola, parabola, crossing lines, parallel lines
    const Standard s = random_standard(alphas[kind] / (a * a), betas[kind] / (b * b),
                                       kind == 2 ? -4 * a / (b * b) : 0, kappas[kind]);
    const CagConic c = equation(&s);
    const double from = uniform(-2, 0.5), to = from + uniform(0.1, 2);
    CagConicClass k;
    CagCurve *out[2];
    size_t n;
    OK(cag_conic_classify(&c, &k, &err));
    OK(cag_conic_branches(&c, from, to, out, &n, &err));
    assert_int_equal(n, kind == 0 || kind == 2 ? 1 : 2);
    for (size_t j = 0; j < n; j++) {
      for (int m = 0; m <= 8; m++) {
        const double t = out[j]->start + (out[j]->end - out[j]->start) * m / 8;
        const double end = kind == 0 ? 2 * M_PI * m / 8 : from + (to - from) * m / 8;
        const CagVec3 p = at(out[j], t), e1 = {cos(k.angle), sin(k.angle), 0};
        const CagVec3 e2 = {-e1.y, e1.x, 0}, d = cag_sub(p, k.center);
        double u = 0, v = 0;
        if (kind == 0) u = a * cos(end), v = b * sin(end);
        if (kind == 1) u = (j ? -a : a) * cosh(end), v = b * sinh(end);
        if (kind == 2) u = a * end * end, v = 2 * a * end;
        if (kind < 3) {
          NEAR(cag_dot(d, e1), u, 1e-9);
          NEAR(cag_dot(d, e2), v, 1e-9);
          continue;
        }
        // From the point of the line that is nearest to the center.
        const double *line = k.lines[j];
        NEAR(line[0] * p.x + line[1] * p.y + line[2], 0, 1e-13);
        NEAR(line[0] * d.y - line[1] * d.x, end, 1e-12);
      }
      cag_curve_release(out[j]);
    }
  }
  const CagConic circle = {{1, 0, 1, 0, 0, -1}};
  CagCurve *out[2];
  size_t n;
  FAILS(cag_conic_branches(&circle, 1, 1, out, &n, &err), "empty-range");
  FAILS(cag_conic_branches(&circle, 1, INFINITY, out, &n, &err), "empty-range");
  FAILS(cag_conic_branches(&circle, -INFINITY, 1, out, &n, &err), "empty-range");
  // The second branch cannot be made: the first is given back.
  FAILS(cag_conic_branches(&(CagConic){{1, 0, -1, 0, 0, -1}}, 0, 400, out, &n, &err), "domain");
  assert_int_equal(n, 0);
}

// Proportional to the expected coefficients.
static void same_conic(const CagConic *k, const CagConic *expected, double tolerance) {
  double dot = 0, one = 0, two = 0;
  for (int i = 0; i < 6; i++) {
    dot += k->c[i] * expected->c[i];
    one += k->c[i] * k->c[i];
    two += expected->c[i] * expected->c[i];
  }
  for (int i = 0; i < 6; i++)
    NEAR(k->c[i] / sqrt(one), (dot < 0 ? -1 : 1) * expected->c[i] / sqrt(two), tolerance);
}

static void curves_have_the_equation_that_they_were_made_from(void **state) {
  (void)state;
  seed = 1234;
  for (int i = 0; i < 60; i++) {
    const double a = uniform(0.5, 3), b = uniform(0.5, 3), delta = -4 * a;
    const int kind = i % 3;
    const Standard s = kind == 0   ? random_standard(1 / (a * a), 1 / (b * b), 0, 1)
                       : kind == 1 ? random_standard(1 / (a * a), -1 / (b * b), 0, 1)
                                   : random_standard(0, 1, delta, 0);
    const CagTransform f = plane_frame(s.center.x, s.center.y, s.angle);
    const CagConic expected = equation(&s);
    const double from = uniform(-1, 0.4), to = uniform(0.5, 1.2);
    CagCurve *c, *exact, *moved, *joined;
    CagConic k;
    if (kind == 0) OK(cag_curve_arc(a, b, from, to, &f, &c, &err));
    else if (kind == 1)
      OK(cag_curve_hyperbola(a, b, i % 2 ? CAG_FORM_SECANT : CAG_FORM_HYPERBOLIC, from, to, &f, &c,
                             &err));
    else
      OK(cag_curve_parabola(a, i % 2 ? CAG_FORM_TANGENT : CAG_FORM_QUADRATIC, from, to, &f, &c,
                            &err));
    OK(cag_conic_of_curve(c, &k, &err));
    same_conic(&k, &expected, 1e-12);
    OK(cag_curve_to_nurbs(c, &exact, &err));
    OK(cag_conic_of_curve(exact, &k, &err));
    same_conic(&k, &expected, 1e-9);
    // In a plane of space: the frame carries the equation's points to those of the curve.
    CagTransform frame, tilt, shift = cag_translate(cag_vec3(1, 2, 3));
    CagVec3 axis = {0, 0, 0};
    axis.x = uniform(-1, 1);
    axis.y = uniform(-1, 1);
    axis.z = i % 4 == 0 ? 0 : uniform(-1, 1);
    OK(cag_rotate(axis, i % 4 == 0 ? M_PI : uniform(-3, 3), cag_vec3(0, 0, 0), &tilt, &err));
    tilt = cag_transform_multiply(&shift, &tilt);
    FAILS(cag_conic_of_space_curve(c, &frame, &k, &err), "not-a-conic");
    OK(cag_curve_transform(c, &tilt, &moved, &err));
    FAILS(cag_conic_of_curve(moved, &k, &err), "not-a-conic");
    OK(cag_conic_of_space_curve(moved, &frame, &k, &err));
    const CagVec3 x = cag_transform_vector(&frame, cag_vec3(1, 0, 0));
    const CagVec3 y = cag_transform_vector(&frame, cag_vec3(0, 1, 0));
    const CagVec3 z = cag_transform_vector(&frame, cag_vec3(0, 0, 1));
    const CagVec3 origin = cag_transform_point(&frame, cag_vec3(0, 0, 0));
    NEAR(x.z, 0, 1e-12);
    assert_true(z.z > 0);
    // The way uphill is y.
    if (fabs(z.z) < 1 - 1e-9) assert_true(y.z > 0);
    else near_vec(x, cag_vec3(1, 0, 0), 1e-12);
    near_vec(origin, cag_scaled(z, cag_dot(origin, z)), 1e-9);
    for (int m = 0; m <= 4; m++) {
      const CagVec3 p = cag_sub(at(moved, from + (to - from) * m / 4), origin);
      NEAR(cag_dot(p, z), 0, 1e-9);
      const CagVec3 flat = {cag_dot(p, x), cag_dot(p, y), 0};
      double size = 0;
      for (int j = 0; j < 6; j++) size = fmax(size, fabs(k.c[j]));
      NEAR(cag_conic_value(&k, flat), 0, 1e-8 * size * (1 + cag_dot(flat, flat)));
    }
    // Two pieces are the conic if both belong to it.
    const CagVec3 end = at(exact, exact->end), start = at(exact, exact->start);
    CagVec3 bend[3] = {end, cag_lerp(start, end, 2), cag_vec3(9, 9, 0)};
    CagCurve *parts[2] = {exact, NULL}, *as_nurbs;
    OK(cag_curve_bezier(bend, NULL, 3, 2, &parts[1], &err));
    OK(cag_curve_join(parts, 2, &joined, &err));
    OK(cag_curve_to_nurbs(joined, &as_nurbs, &err));
    FAILS(cag_conic_of_curve(as_nurbs, &k, &err), "not-a-conic");
    cag_curve_release(as_nurbs);
    cag_curve_release(joined);
    cag_curve_release(parts[1]);
    cag_curve_release(moved);
    cag_curve_release(exact);
    cag_curve_release(c);
  }
}

// A vertical plane has its upward y, and its normal in the half plane y > 0, or along X.
static void frames_of_vertical_planes_are_level(void **state) {
  (void)state;
  for (int i = 0; i < 16; i++) {
    const double angle = 2 * M_PI * i / 16;
    const CagVec3 normal = {cos(angle), sin(angle), 0}, x = {-sin(angle), cos(angle), 0};
    const CagVec3 points[3] = {cag_scaled(normal, 2), cag_madd(cag_scaled(normal, 2), 1, x),
                               cag_add(cag_scaled(normal, 2), cag_vec3(0, 0, 3))};
    CagCurve *c;
    CagConic k;
    CagTransform frame;
    OK(cag_curve_bezier(points, NULL, 3, 3, &c, &err));
    OK(cag_conic_of_space_curve(c, &frame, &k, &err));
    const bool turned = i > 8;
    near_vec(cag_transform_vector(&frame, cag_vec3(0, 1, 0)), cag_vec3(0, 0, 1), 1e-12);
    near_vec(cag_transform_point(&frame, cag_vec3(0, 0, 0)), points[0], 1e-9);
    if (i % 8)
      near_vec(cag_transform_vector(&frame, cag_vec3(0, 0, 1)), cag_scaled(normal, turned ? -1 : 1),
               1e-12);
    cag_curve_release(c);
  }
  const CagVec3 bent[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}};
  CagCurve *c;
  CagConic k;
  CagTransform frame;
  OK(cag_curve_bezier(bent, NULL, 4, 3, &c, &err));
  FAILS(cag_conic_of_space_curve(c, &frame, &k, &err), "not-a-conic");
  cag_curve_release(c);
}

static void lines_and_other_curves_have_their_equation_or_none(void **state) {
  (void)state;
  seed = 8;
  for (int i = 0; i < 20; i++) {
    CagVec3 p[4] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    CagCurve *c;
    CagConic k;
    for (int j = 0; j < 4; j++) {
      p[j].x = uniform(-3, 3);
      p[j].y = uniform(-3, 3);
    }
    OK(cag_curve_line(p[0], p[1], 2, &c, &err));
    OK(cag_conic_of_curve(c, &k, &err));
    NEAR(cag_conic_value(&k, p[0]), 0, 1e-13);
    NEAR(cag_conic_value(&k, p[1]), 0, 1e-13);
    const CagVec3 d = cag_sub(p[1], p[0]), left = {p[0].x - d.y, p[0].y + d.x, 0};
    NEAR(cag_conic_value(&k, left), -cag_dot(d, d), 1e-12);
    for (int j = 0; j < 3; j++) assert_true(k.c[j] == 0);
    cag_curve_release(c);
    OK(cag_curve_polyline(p, 3, false, 2, &c, &err));
    FAILS(cag_conic_of_curve(c, &k, &err), "not-a-conic");
    cag_curve_release(c);
    OK(cag_curve_bezier(p, NULL, 4, 2, &c, &err));
    FAILS(cag_conic_of_curve(c, &k, &err), "not-a-conic");
    cag_curve_release(c);
  }
}

// y by the quadratic equation C y^2 + (B x + E) y + A x^2 + D x + F = 0.
static void points_at_an_abscissa_solve_the_equation(void **state) {
  (void)state;
  seed = 77;
  CagVec3 p;
  for (int i = 0; i < 400; i++) {
    CagConic c;
    for (int j = 0; j < 6; j++) c.c[j] = uniform(-1, 1);
    if (i % 5 == 0) c.c[2] = 0;
    if (i % 7 == 0) c.c[4] = c.c[1] = 0;
    const double x = uniform(-2, 2), a = c.c[2], b = c.c[1] * x + c.c[4];
    const double e = c.c[0] * x * x + c.c[3] * x + c.c[5], disc = b * b - 4 * a * e;
    for (int upper = 0; upper < 2; upper++) {
      if (a == 0 ? b == 0 : disc < 0) {
        FAILS(cag_conic_point_at(&c, x, upper, &p, &err), "domain");
        continue;
      }
      OK(cag_conic_point_at(&c, x, upper, &p, &err));
      assert_true(p.x == x && p.z == 0);
      if (a == 0) {
        NEAR(p.y, -e / b, 1e-12 * (1 + fabs(p.y)));
        continue;
      }
      const double one = (-b + sqrt(disc)) / (2 * a), two = (-b - sqrt(disc)) / (2 * a);
      const double y = upper ? fmax(one, two) : fmin(one, two);
      NEAR(p.y, y, 1e-9 * (1 + fabs(y)));
      NEAR(cag_conic_value(&c, p), 0, 1e-13 * (1 + p.y * p.y));
    }
  }
  // Where the tangent is upright, rounding of the larger terms is allowed for, and no more.
  const CagConic far[2] = {{{1, 0, 1, -2000, 0, 1e6 - 1}}, {{1, 0, 1, 0, -2000, 1e6 - 1}}};
  OK(cag_conic_point_at(&far[0], 1001 + 1e-10, true, &p, &err));
  near_vec(p, cag_vec3(1001, 0, 0), 1e-4);
  FAILS(cag_conic_point_at(&far[0], 1001 + 1e-5, true, &p, &err), "domain");
  OK(cag_conic_point_at(&far[1], 1 + 1e-8, false, &p, &err));
  near_vec(p, cag_vec3(1, 1000, 0), 1e-2);
  FAILS(cag_conic_point_at(&far[1], 1 + 1e-5, false, &p, &err), "domain");
  OK(cag_conic_point_at(&(CagConic){{0, 0, 1, 0, 0, 0}}, 3, true, &p, &err));
  near_vec(p, cag_vec3(3, 0, 0), 0);
  FAILS(cag_conic_point_at(&(CagConic){{1, 0, 0, 0, 0, -1}}, 1, true, &p, &err), "domain");
}

// From one end to the other, with x monotone, on the conic and on the side of the upper or lower
// root.
static void random_segments_stay_on_their_side(void **state) {
  (void)state;
  seed = 2024;
  int made[4] = {0};
  for (int i = 0; i < 600; i++) {
    const double a = uniform(0.5, 3), b = uniform(0.5, 3);
    const int kind = i % 4; // ellipse, hyperbola, parabola, lines
    const Standard s = kind == 0   ? random_standard(1 / (a * a), 1 / (b * b), 0, 1)
                       : kind == 1 ? random_standard(1 / (a * a), -1 / (b * b), 0, 1)
                       : kind == 2 ? random_standard(0, 1, -4 * a, 0)
                                   : random_standard(1 / (a * a), -1 / (b * b), 0, 0);
    const CagConic c = equation(&s);
    const double from = s.center.x + uniform(-3, 3), to = s.center.x + uniform(-3, 3);
    const bool upper = i % 8 < 4;
    CagVec3 p, q;
    CagCurve *curve;
    bool whole = true, gap = false; // real everywhere between
    for (int k = 0; k <= 50; k++) {
      const bool real = !cag_conic_point_at(&c, from + (to - from) * k / 50, upper, &p, &err);
      whole = whole && real;
      gap = gap || !real;
    }
    if (cag_conic_point_at(&c, from, upper, &p, &err) ||
        cag_conic_point_at(&c, to, upper, &q, &err)) {
      FAILS(cag_conic_segment(&c, from, to, upper, &curve, &err), "domain");
      continue;
    }
    if (kind == 1 && gap) {
      FAILS(cag_conic_segment(&c, from, to, upper, &curve, &err), "domain");
      continue;
    }
    if (kind == 3 && (from < s.center.x) != (to < s.center.x)) {
      // The upper root changes lines at the center.
      FAILS(cag_conic_segment(&c, from, to, upper, &curve, &err), "domain");
      continue;
    }
    if (!whole) continue;
    OK(cag_conic_segment(&c, from, to, upper, &curve, &err));
    made[kind]++;
    near_vec(at(curve, curve->start), p, 1e-9);
    near_vec(at(curve, curve->end), q, 1e-9);
    double last = from;
    for (int k = 1; k < 16; k++) {
      const CagVec3 r = at(curve, curve->start + (curve->end - curve->start) * k / 16);
      CagVec3 expected;
      assert_true((r.x - last) * (to - from) > 0);
      last = r.x;
      OK(cag_conic_point_at(&c, r.x, upper, &expected, &err));
      NEAR(r.y, expected.y, 1e-6 * (1 + fabs(r.y)));
    }
    cag_curve_release(curve);
  }
  for (int kind = 0; kind < 4; kind++) assert_true(made[kind] >= 15);
  CagCurve *curve;
  const CagConic circle = {{1, 0, 1, 0, 0, -25}};
  FAILS(cag_conic_segment(&circle, 3, 3, true, &curve, &err), "empty-range");
  FAILS(cag_conic_segment(&(CagConic){{1, 0, 1, 0, 0, 0}}, 0, 1, true, &curve, &err), "domain");
  OK(cag_conic_segment(&circle, -5, 5, false, &curve, &err));
  near_vec(at(curve, curve->start), cag_vec3(-5, 0, 0), 1e-12);
  near_vec(at(curve, (curve->start + curve->end) / 2), cag_vec3(0, -5, 0), 1e-12);
  cag_curve_release(curve);
}

static void random_lines_meet_random_conics(void **state) {
  (void)state;
  seed = 606;
  int counts[5] = {0};
  for (int i = 0; i < 600; i++) {
    CagConic c;
    CagVec3 p = {0, 0, 0}, d = {0, 0, 0};
    CagLineConic kind;
    double t[2];
    for (int k = 0; k < 6; k++) c.c[k] = uniform(-1, 1);
    if (i % 6 == 0) c.c[0] = c.c[1] = c.c[2] = 0;
    p.x = uniform(-3, 3);
    p.y = uniform(-3, 3);
    d.x = uniform(-2, 2);
    d.y = uniform(-2, 2);
    if (i % 3 == 1) { // the tangent at a point of the conic
      if (cag_conic_point_at(&c, p.x, i % 2, &p, &err)) continue;
      double line[3];
      cag_conic_polar(&c, p, line);
      const double scale = uniform(0.5, 3) / hypot(line[0], line[1]);
      d = cag_vec3(-scale * line[1], scale * line[0], 0);
      p = cag_madd(p, -2, d);
      OK(cag_conic_line(&c, p, d, &kind, t, &err));
      if (c.c[0] == 0 && c.c[1] == 0) {
        assert_int_equal(kind, CAG_LINE_WITHIN);
      } else {
        assert_int_equal(kind, CAG_LINE_TANGENT);
        NEAR(t[0], 2, 1e-6);
        NEAR(t[1], 2, 1e-6);
      }
      counts[kind]++;
      continue;
    }
    const bool asymptote = i % 6 == 2 && c.c[1] * c.c[1] > 4 * c.c[0] * c.c[2];
    if (asymptote) {
      const double root = sqrt(c.c[1] * c.c[1] - 4 * c.c[0] * c.c[2]);
      d = cag_vec3((-c.c[1] + root) / (2 * c.c[0]), 1, 0);
    }
    const double q2 = c.c[0] * d.x * d.x + c.c[1] * d.x * d.y + c.c[2] * d.y * d.y;
    const double q0 = cag_conic_value(&c, p);
    double line[3];
    cag_conic_polar(&c, p, line);
    const double q1 = 2 * (line[0] * d.x + line[1] * d.y), disc = q1 * q1 - 4 * q2 * q0;
    OK(cag_conic_line(&c, p, d, &kind, t, &err));
    counts[kind]++;
    if (asymptote || i % 6 == 0) {
      assert_int_equal(kind, CAG_LINE_ONE);
      NEAR(t[0], -q0 / q1, 1e-9 * (1 + fabs(t[0])));
      assert_true(t[0] == t[1]);
    } else if (disc < 0) {
      assert_int_equal(kind, CAG_LINE_NONE);
    } else {
      assert_int_equal(kind, CAG_LINE_TWO);
      assert_true(t[0] < t[1]);
      const double low = (-q1 - sqrt(disc)) / (2 * q2), high = (-q1 + sqrt(disc)) / (2 * q2);
      NEAR(t[0], fmin(low, high), 1e-9 * (1 + t[0] * t[0]));
      NEAR(t[1], fmax(low, high), 1e-9 * (1 + t[1] * t[1]));
    }
  }
  for (int kind = CAG_LINE_NONE; kind <= CAG_LINE_TWO; kind++) assert_true(counts[kind] >= 40);
}

// Touching is judged by the rounding of the terms, also far from the origin: 1e-13 of the radius
// off is a touch, 1e-9 off is not.
static void lines_near_a_touch(void **state) {
  (void)state;
  seed = 3;
  for (int i = 0; i < 100; i++) {
    const double a = uniform(0.5, 3), b = uniform(0.5, 3), t = uniform(-3, 3);
    Standard s = random_standard(1 / (a * a), 1 / (b * b), 0, 1);
    if (i % 2) s.center = cag_scaled(s.center, 100);
    const double off = i % 2 ? 1e-6 : 1e-9;
    const CagConic c = equation(&s);
    const CagVec3 p = placed(&s, a * cos(t), b * sin(t));
    const CagVec3 d = cag_sub(placed(&s, -a * sin(t), b * cos(t)), s.center);
    const CagVec3 outward = cag_unit(cag_vec3(d.y, -d.x, 0));
    CagLineConic kind;
    double at[2];
    OK(cag_conic_line(&c, p, d, &kind, at, &err));
    assert_int_equal(kind, CAG_LINE_TANGENT);
    OK(cag_conic_line(&c, cag_madd(p, off, outward), d, &kind, at, &err));
    assert_int_equal(kind, CAG_LINE_NONE);
    OK(cag_conic_line(&c, cag_madd(p, -off, outward), d, &kind, at, &err));
    assert_int_equal(kind, CAG_LINE_TWO);
    // From far along the line the answer is the same.
    OK(cag_conic_line(&c, cag_madd(p, 100, d), d, &kind, at, &err));
    assert_int_equal(kind, CAG_LINE_TANGENT);
    NEAR(at[0], -100, 1e-4);
    if (i % 2) continue;
    // The asymptotes of a hyperbola, and lines of a pair.
    const double sign = i % 4 < 2 ? 1 : -1;
    s.beta = -s.beta;
    const CagVec3 along = cag_sub(placed(&s, a, sign * b), s.center);
    const CagVec3 aside = cag_sub(placed(&s, a, -sign * b), s.center);
    const CagConic h = equation(&s);
    OK(cag_conic_line(&h, cag_madd(s.center, 0.7, along), along, &kind, at, &err));
    assert_int_equal(kind, CAG_LINE_NONE);
    s.kappa = 0;
    const CagConic pair = equation(&s);
    OK(cag_conic_line(&pair, cag_madd(s.center, 0.7, along), along, &kind, at, &err));
    assert_int_equal(kind, CAG_LINE_WITHIN);
    OK(cag_conic_line(&pair, cag_madd(s.center, 0.3, aside), along, &kind, at, &err));
    assert_int_equal(kind, CAG_LINE_ONE);
    // q0 + q1 t = 0 with u / a = 0.3 + t, v / b = sign (t - 0.3)
    NEAR(at[0], 0, 1e-9);
    // Parallel lines, along a direction that is off by rounding of an angle.
    const Standard lines = {0, 1, 0, 1, s.angle, s.factor, s.center};
    const CagConic parallel = equation(&lines);
    const CagVec3 way = {cos(s.angle + 3e-14), sin(s.angle + 3e-14), 0};
    OK(cag_conic_line(&parallel, placed(&lines, 0.5, 0.3), way, &kind, at, &err));
    assert_int_equal(kind, CAG_LINE_NONE);
  }
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

// --- Random conditions ---

// Points and tangents of a random conic lead back to it.
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
    // As many tangents as i says, each of which is two conditions; their points are among the
    // points or not. The rest are points, and sometimes one more than needed.
    const size_t m = (size_t)(i / 4 % 3) % (needed[shape] / 2 + 1);
    const bool listed = i % 3 == 0;
    const size_t extra = (size_t)(i / 12 % 2);
    CagConicTangent tangents[2];
    CagVec3 points[8];
    size_t n = 0;
    for (size_t k = 0; k < needed[shape] - m + extra; k++) {
      // The parameters are spread over both branches of a hyperbola.
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
    // C is 1, or what is first without it.
    int unit = shape == CAG_CONIC_LINE ? 3 : 2;
    if (shape == CAG_CONIC_LINE && fabs(k.c[3]) < 1e-12) unit = 4;
    NEAR(k.c[unit], 1, 0);
    if (shape != CAG_CONIC_GENERAL) assert_true(k.c[1] == 0);
    if (shape == CAG_CONIC_CIRCLE) NEAR(k.c[0], k.c[2], 1e-12);
    if (shape == CAG_CONIC_LINE) assert_true(k.c[0] == 0 && k.c[2] == 0);
    // One condition less is too few.
    if (extra == 0 && n > 0 && !(listed && m > 0))
      FAILS(cag_conic_from_conditions(points, n - 1, tangents, m, shape, &k, &err),
            "too-few-conditions");
    // A point off the conic contradicts.
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

// Coefficients that only rounding makes are 0, and the first that is none is 1.
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
    // b0 p + b1 w apex + b2 q over the sum.
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
    // Points beyond each side, and off the plane.
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

// --- Ranges and hulls of open conics ---

static void ranges_of_open_conics_have_their_limits(void **state) {
  (void)state;
  const CagTransform f = plane_frame(0, 0, 0);
  CagCurve *c;
  OK(cag_curve_hyperbola(2, 1, CAG_FORM_HYPERBOLIC, -229, 229, &f, &c, &err));
  cag_curve_release(c);
  FAILS(cag_curve_hyperbola(2, 1, CAG_FORM_HYPERBOLIC, -231, 0, &f, &c, &err), "domain");
  FAILS(cag_curve_hyperbola(2, 1, CAG_FORM_HYPERBOLIC, 0, 231, &f, &c, &err), "domain");
  OK(cag_curve_parabola(2, CAG_FORM_QUADRATIC, -1000, 1000, &f, &c, &err));
  cag_curve_release(c);
  for (int turn = -2; turn <= 2; turn++) {
    const double pole = (turn + 0.5) * M_PI;
    OK(cag_curve_parabola(2, CAG_FORM_TANGENT, pole + 1e-8, pole + 3, &f, &c, &err));
    cag_curve_release(c);
    OK(cag_curve_hyperbola(2, 1, CAG_FORM_SECANT, pole - 3, pole - 1e-8, &f, &c, &err));
    cag_curve_release(c);
    FAILS(cag_curve_parabola(2, CAG_FORM_TANGENT, pole + 1e-10, pole + 3, &f, &c, &err), "domain");
    FAILS(cag_curve_parabola(2, CAG_FORM_TANGENT, pole - 3, pole - 1e-10, &f, &c, &err), "domain");
    FAILS(cag_curve_hyperbola(2, 1, CAG_FORM_SECANT, pole - 0.1, pole + 0.1, &f, &c, &err),
          "domain");
  }
  FAILS(cag_curve_hyperbola(2, -1, CAG_FORM_SECANT, 0, 1, &f, &c, &err), "radius-not-positive");
  FAILS(cag_curve_hyperbola(0, 1, CAG_FORM_SECANT, 0, 1, &f, &c, &err), "radius-not-positive");
  FAILS(cag_curve_parabola(1, CAG_FORM_QUADRATIC, NAN, 1, &f, &c, &err), "not-finite");
  FAILS(cag_curve_parabola(1, CAG_FORM_QUADRATIC, 0, INFINITY, &f, &c, &err), "not-finite");
  FAILS(cag_curve_parabola(1, CAG_FORM_QUADRATIC, 1, 0, &f, &c, &err), "empty-range");
  CagTransform bad = f;
  bad.m[3][0] = 0.1;
  FAILS(cag_curve_parabola(1, CAG_FORM_QUADRATIC, 0, 1, &bad, &c, &err), "not-affine");
  bad = f;
  bad.m[1][3] = NAN;
  FAILS(cag_curve_parabola(1, CAG_FORM_QUADRATIC, 0, 1, &bad, &c, &err), "not-finite");
}

// Random affine images, reversed, cut and with other domains: points, derivatives, and boxes, which
// are exact.
static void random_open_conics_keep_their_points(void **state) {
  (void)state;
  seed = 503;
  for (int i = 0; i < 120; i++) {
    CagTransform f = cag_transform_identity();
    for (int r = 0; r < 3; r++)
      for (int k = 0; k < 4; k++) f.m[r][k] = uniform(-2, 2);
    f.planar = i % 2;
    if (f.planar)
      for (int k = 0; k < 4; k++) f.m[2][k] = f.m[k][2] = k == 2;
    const double w = i % 5 ? 1 : uniform(0.5, 2);
    f.m[3][3] = w;
    const int form = i / 2 % 4;
    const double a = uniform(0.3, 2), b = uniform(0.3, 2);
    const bool left = form == CAG_FORM_SECANT && i % 3 == 0;
    const double start = (left ? M_PI : 0) + uniform(-1.3, 0.3), end = start + uniform(0.1, 0.9);
    CagCurve *c, *back, *other;
    if (form == CAG_FORM_QUADRATIC || form == CAG_FORM_TANGENT)
      OK(cag_curve_parabola(a, (CagConicForm)form, start, end, &f, &c, &err));
    else OK(cag_curve_hyperbola(a, b, (CagConicForm)form, start, end, &f, &c, &err));
    assert_int_equal(c->dimension, f.planar ? 2 : 3);
    assert_true(c->angular == (form == CAG_FORM_TANGENT || form == CAG_FORM_SECANT));
    OK(cag_curve_reverse(c, &back, &err));
    OK(cag_curve_reparametrize(back, 2, 7, &other, &err));
    CagBounds seen = CAG_BOUNDS_EMPTY;
    for (int k = 0; k <= 400; k++) {
      const double t = fmin(end, start + (end - start) * k / 400);
      double x = 0, y = 0;
      if (form == CAG_FORM_QUADRATIC) x = a * t * t, y = 2 * a * t;
      if (form == CAG_FORM_TANGENT) x = tan(t) * tan(t), y = 2 * sqrt(a) * tan(t);
      if (form == CAG_FORM_HYPERBOLIC) x = a * cosh(t), y = b * sinh(t);
      if (form == CAG_FORM_SECANT) x = a / cos(t), y = b * tan(t);
      const CagVec3 p = cag_transform_point(&f, cag_vec3(x, y, 0));
      cag_bounds_add(&seen, at(c, t));
      near_vec(at(c, t), p, 1e-12 * (1 + cag_norm(p)));
      near_vec(at(back, fmin(end, start + end - t)), p, 1e-11 * (1 + cag_norm(p)));
      near_vec(at(other, fmin(7, 2 + 5 * (end - t) / (end - start))), p, 1e-11 * (1 + cag_norm(p)));
    }
    const CagBounds box = c->kind->hull(c, start, end);
    const double size = cag_norm(cag_sub(seen.max, seen.min));
    near_vec(box.min, seen.min, 1e-4 * size);
    near_vec(box.max, seen.max, 1e-4 * size);
    assert_true(box.min.x <= seen.min.x + 1e-12 * size && box.max.x >= seen.max.x - 1e-12 * size);
    assert_true(box.min.y <= seen.min.y + 1e-12 * size && box.max.y >= seen.max.y - 1e-12 * size);
    assert_true(box.min.z <= seen.min.z + 1e-12 * size && box.max.z >= seen.max.z - 1e-12 * size);
    // The rational form has the same image, and derivatives those of the other domain.
    CagCurve *exact;
    OK(cag_curve_to_nurbs(c, &exact, &err));
    for (int k = 0; k <= 6; k++) {
      double t, distance;
      CagVec3 nearest;
      const CagVec3 p =
          at(exact, fmin(exact->end, exact->start + (exact->end - exact->start) * k / 6));
      OK(cag_curve_closest(c, p, &t, &nearest, &distance, &err));
      NEAR(distance, 0, 1e-9 * (1 + size));
    }
    const double rate = -(end - start) / 5, t = start + 0.3 * (end - start);
    CagVec3 d[4], e[4];
    OK(cag_curve_eval(c, t, 3, CAG_SIDE_RIGHT, d, &err));
    OK(cag_curve_eval(other, 2 + 5 * 0.7, 3, CAG_SIDE_RIGHT, e, &err));
    double scale = 1;
    for (int k = 0; k < 4; k++, scale *= rate)
      near_vec(e[k], cag_scaled(d[k], scale), 1e-10 * (1 + cag_norm(d[k])));
    cag_curve_release(exact);
    cag_curve_release(other);
    cag_curve_release(back);
    cag_curve_release(c);
  }
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

// --- Random circles and lines ---

static CagVec3 random_place(double size) {
  CagVec3 p = {0, 0, 0};
  p.x = uniform(-size, size);
  p.y = uniform(-size, size);
  return p;
}

static double distance_from(const CagTouched *t, CagVec3 p) {
  const CagVec3 d = cag_sub(p, t->p);
  if (t->radius > 0) return cag_norm(d);
  return fabs(t->d.x * d.y - t->d.y * d.x) / cag_norm(t->d);
}

static double side_of(const CagTouched *line, CagVec3 p) {
  return line->d.x * (p.y - line->p.y) - line->d.y * (p.x - line->p.x);
}

// All choices, with the distances that touching means, and the side that was chosen.
static void random_circles_touch_as_chosen(void **state) {
  (void)state;
  seed = 17;
  int none[4] = {0}, made[4] = {0};
  for (int i = 0; i < 400; i++) {
    const double radius = uniform(0.2, 3);
    const int kind = i % 4; // lines; line and circle; circle and line; circles
    CagTouched t[2];
    for (int k = 0; k < 2; k++) {
      const bool round = k == 0 ? kind >= 2 : kind % 2;
      t[k].p = random_place(3);
      t[k].d = round ? cag_vec3(0, 0, 0) : random_place(2);
      t[k].radius = round ? uniform(0.3, 2) : 0;
    }
    CagVec3 found[2][2], touch[2]; // by .right, .near
    for (int code = 0; code < 16; code++) {
      const CagTouchChoice c = {code & 1, code & 2, {code & 4, code & 8}};
      CagVec3 center = {0, 0, 0};
      double reach[2];
      for (int k = 0; k < 2; k++)
        reach[k] = t[k].radius == 0 ? radius
                   : c.inside[k]    ? fabs(t[k].radius - radius)
                                    : t[k].radius + radius;
      // Whether there is a center: two circles about the centers meet, or the parallel meets one.
      bool exists = true;
      double spare = 1;
      if (kind == 3) {
        const double d = cag_norm(cag_sub(t[1].p, t[0].p));
        spare = fmin(reach[0] + reach[1] - d, d - fabs(reach[0] - reach[1]));
      } else if (kind > 0) {
        const CagTouched *line = &t[kind - 1], *circle = &t[2 - kind];
        const double height = side_of(line, circle->p) / cag_norm(line->d);
        spare = reach[2 - kind] - fabs(height - (c.right ? -radius : radius));
      }
      exists = spare > 0;
      if (fabs(spare) < 1e-6) continue;
      if (!exists) {
        FAILS(cag_tangent_circle(&t[0], &t[1], radius, c, &center, touch, &err),
              "no-tangent-circle");
        none[kind]++;
        continue;
      }
      OK(cag_tangent_circle(&t[0], &t[1], radius, c, &center, touch, &err));
      made[kind]++;
      for (int k = 0; k < 2; k++) {
        NEAR(distance_from(&t[k], center), reach[k], 1e-9);
        NEAR(distance_from(&t[k], touch[k]), t[k].radius, 1e-9);
        NEAR(cag_norm(cag_sub(touch[k], center)), radius, 1e-7);
      }
      assert_true(center.z == 0);
      found[c.right][c.near] = center;
      const CagTouched *line = kind == 2 ? &t[1] : &t[0];
      const CagTouched between = {t[0].p, cag_sub(t[1].p, t[0].p), 0};
      assert_true((side_of(kind == 3 ? &between : line, center) < 0) == c.right);
      // The near side of the second line is that from which the first comes.
      if (kind == 0) {
        const double before = side_of(&t[1], cag_madd(t[0].p, -1e6, t[0].d));
        assert_true((side_of(&t[1], center) * before > 0) == c.near);
      }
      // The earlier place of two.
      if ((kind == 1 || kind == 2) && c.near)
        assert_true(cag_dot(cag_sub(found[c.right][0], center), line->d) >= 0);
    }
  }
  for (int kind = 0; kind < 4; kind++)
    assert_true(made[kind] > 200 && (kind == 0 || none[kind] > 100));
}

// Touching that rounding would undo is kept: the center lies between.
static void circles_that_just_reach_are_found(void **state) {
  (void)state;
  seed = 18;
  for (int i = 0; i < 100; i++) {
    const double angle = uniform(-3, 3), radius = uniform(0.5, 2), r = uniform(0.5, 2);
    const CagVec3 p = random_place(100), e = {cos(angle), sin(angle), 0}, n = {-e.y, e.x, 0};
    const double s = uniform(0.5, 2);
    const CagTouched a = {p, {0, 0, 0}, r};
    const CagTouched b = {cag_madd(p, r + 2 * radius + s, e), {0, 0, 0}, s};
    const CagTouched line = {cag_madd(p, r + 2 * radius, n), e, 0};
    CagVec3 center, touch[2];
    for (int right = 0; right < 2; right++) {
      const CagTouchChoice c = {.right = right};
      OK(cag_tangent_circle(&a, &b, radius, c, &center, touch, &err));
      near_vec(center, cag_madd(p, r + radius, e), 1e-4);
      const CagTouched far = {cag_madd(b.p, 1e-6, e), {0, 0, 0}, s};
      FAILS(cag_tangent_circle(&a, &far, radius, c, &center, touch, &err), "no-tangent-circle");
    }
    const CagTouchChoice c = {.right = true};
    OK(cag_tangent_circle(&line, &a, radius, c, &center, touch, &err));
    near_vec(center, cag_madd(p, r + radius, n), 1e-4);
    const CagTouched far = {cag_madd(line.p, 1e-6, n), e, 0};
    FAILS(cag_tangent_circle(&far, &a, radius, c, &center, touch, &err), "no-tangent-circle");
  }
  const CagTouched a = {{1, 2, 0}, {0, 0, 0}, 1}, b = {{1, 2, 0}, {0, 0, 0}, 2};
  const CagTouched l = {{0, 0, 0}, {1, 0, 0}, 0}, point = {{0, 0, 0}, {0, 0, 0}, 0};
  const CagTouchChoice c = {0};
  CagVec3 center, touch[2];
  FAILS(cag_tangent_circle(&a, &b, 1, c, &center, touch, &err), "no-tangent-circle");
  FAILS_AT(cag_tangent_circle(&point, &l, 1, c, &center, touch, &err), "zero-vector", 0);
  FAILS_AT(cag_tangent_circle(&l, &point, 1, c, &center, touch, &err), "zero-vector", 1);
  FAILS_AT(cag_tangent_circle(&a, &point, 1, c, &center, touch, &err), "zero-vector", 1);
  FAILS(cag_tangent_circle(&a, &l, INFINITY, c, &center, touch, &err), "radius-not-positive");
  FAILS(cag_tangent_circle(&a, &l, -1, c, &center, touch, &err), "radius-not-positive");
  const CagTouched slanted = {{0, 1, 0}, {1, 1e-13, 0}, 0}, steeper = {{0, 1, 0}, {1, 1e-11, 0}, 0};
  FAILS(cag_tangent_circle(&l, &slanted, 1, c, &center, touch, &err), "parallel-lines");
  OK(cag_tangent_circle(&l, &steeper, 1, c, &center, touch, &err));
}

// --- Random tangent lines ---

// Changes of sign of C' x (C - p) at dense samples.
static size_t count_tangents(const CagCurve *c, CagVec3 p) {
  size_t count = 0;
  double last = 0;
  for (int i = 0; i <= 4000; i++) {
    CagVec3 d[2];
    OK(cag_curve_eval(c, c->start + (c->end - c->start) * (i + 0.5) / 4001, 1, CAG_SIDE_RIGHT, d,
                      &err));
    const CagVec3 e = cag_sub(d[0], p);
    const double value = d[1].x * e.y - d[1].y * e.x;
    count += last * value < 0;
    last = value;
  }
  return count;
}

static void tangents_from_random_points(void **state) {
  (void)state;
  seed = 41;
  for (int i = 0; i < 40; i++) {
    CagVec3 net[5];
    CagCurve *c;
    CagTangentLine *lines;
    size_t n;
    const CagTransform f = plane_frame(1, 0.5, 0.3);
    for (int k = 0; k < 5; k++) net[k] = random_place(3);
    if (i % 2) OK(cag_curve_bezier(net, NULL, 5, 2, &c, &err));
    else OK(cag_curve_arc(2, 1, uniform(-3, 0), uniform(0.1, 3), &f, &c, &err));
    const CagVec3 p = random_place(4);
    OK(cag_tangents_from_point(c, p, &lines, &n, &err));
    assert_int_equal(n, count_tangents(c, p));
    for (size_t k = 0; k < n; k++) {
      CagVec3 tangent;
      near_vec(lines[k].p, at(c, lines[k].t), 0);
      near_vec(lines[k].q, p, 0);
      OK(cag_curve_tangent(c, lines[k].t, CAG_SIDE_RIGHT, &tangent, &err));
      near_vec(cag_cross(tangent, cag_sub(p, lines[k].p)), cag_vec3(0, 0, 0), 1e-9);
      assert_true(k == 0 || lines[k - 1].t < lines[k].t);
    }
    free(lines);
    // In a point of the curve its own tangent is one of them.
    const double t = c->start + (c->end - c->start) * uniform(0.2, 0.8);
    OK(cag_tangents_from_point(c, at(c, t), &lines, &n, &err));
    bool own = false;
    for (size_t k = 0; k < n; k++) own = own || fabs(lines[k].t - t) < 1e-6;
    assert_true(own);
    free(lines);
    cag_curve_release(c);
  }
  CagCurve *line, *space;
  CagTangentLine *lines;
  size_t n;
  OK(cag_curve_line(cag_vec3(0, 0, 0), cag_vec3(1, 1, 0), 2, &line, &err));
  OK(cag_tangents_from_point(line, cag_vec3(3, 3, 0), &lines, &n, &err));
  assert_int_equal(n, 0);
  free(lines);
  OK(cag_tangents_from_point(line, cag_vec3(3, 2, 0), &lines, &n, &err));
  assert_int_equal(n, 0);
  free(lines);
  OK(cag_curve_to_space(line, &space, &err));
  FAILS(cag_tangents_from_point(space, cag_vec3(3, 2, 0), &lines, &n, &err), "not-planar");
  FAILS(cag_tangents_of_two(space, line, &lines, &n, &err), "not-planar");
  FAILS(cag_tangents_of_two(line, space, &lines, &n, &err), "not-planar");
  cag_curve_release(space);
  cag_curve_release(line);
}

// The largest n . x over an ellipse with axes along X and Y.
static double support(CagVec3 center, double a, double b, double angle) {
  return center.x * cos(angle) + center.y * sin(angle) + hypot(a * cos(angle), b * sin(angle));
}

// A line with normal n touches an ellipse on either side. Two ellipses with one line on one side
// have equal supports, else opposite ones.
static size_t count_common(const CagVec3 c[2], const double a[2], const double b[2]) {
  size_t count = 0;
  double last[2] = {0, 0};
  enum { STEPS = 20000 };
  for (int i = 0; i <= STEPS; i++) {
    const double angle = 2 * M_PI * (i + 0.3) / STEPS;
    const double here = support(c[0], a[0], b[0], angle);
    const double value[2] = {here - support(c[1], a[1], b[1], angle),
                             here + support(c[1], a[1], b[1], angle + M_PI)};
    for (int k = 0; k < 2; k++) {
      count += last[k] * value[k] < 0;
      last[k] = value[k];
    }
  }
  return count;
}

static void random_ellipses_have_their_common_tangents(void **state) {
  (void)state;
  seed = 42;
  int seen[5] = {0};
  for (int i = 0; i < 24; i++) {
    CagVec3 c[2];
    double a[2], b[2];
    CagCurve *e[2];
    CagTangentLine *lines;
    size_t n;
    for (int k = 0; k < 2; k++) {
      c[k] = random_place(2);
      a[k] = uniform(0.4, 2);
      b[k] = i % 2 ? a[k] : uniform(0.4, 2);
      const CagTransform f = plane_frame(c[k].x, c[k].y, 0);
      OK(cag_curve_arc(a[k], b[k], 0, 2 * M_PI, &f, &e[k], &err));
    }
    OK(cag_tangents_of_two(e[0], e[1], &lines, &n, &err));
    assert_int_equal(n, count_common(c, a, b));
    seen[n]++;
    for (size_t k = 0; k < n; k++) {
      CagVec3 one, two;
      near_vec(lines[k].p, at(e[0], lines[k].t), 1e-12);
      near_vec(lines[k].q, at(e[1], lines[k].t2), 1e-12);
      OK(cag_curve_tangent(e[0], lines[k].t, CAG_SIDE_RIGHT, &one, &err));
      OK(cag_curve_tangent(e[1], lines[k].t2, CAG_SIDE_RIGHT, &two, &err));
      const CagVec3 d = cag_sub(lines[k].q, lines[k].p);
      near_vec(cag_cross(one, d), cag_vec3(0, 0, 0), 1e-8);
      near_vec(cag_cross(two, d), cag_vec3(0, 0, 0), 1e-8);
      assert_true(k == 0 || lines[k - 1].t <= lines[k].t);
      for (size_t j = 0; j < k; j++)
        assert_true(cag_norm(cag_sub(lines[j].p, lines[k].p)) > 1e-6 ||
                    cag_norm(cag_sub(lines[j].q, lines[k].q)) > 1e-6);
    }
    free(lines);
    // Of arcs those that touch within them.
    if (i % 2) {
      CagCurve *part;
      CagTangentLine *fewer;
      size_t m, expected = 0;
      OK(cag_curve_trim(e[0], 1, 4, &part, &err));
      OK(cag_tangents_of_two(e[0], e[1], &lines, &n, &err));
      for (size_t k = 0; k < n; k++) expected += lines[k].t > 1 && lines[k].t < 4;
      OK(cag_tangents_of_two(part, e[1], &fewer, &m, &err));
      assert_int_equal(m, expected);
      free(fewer);
      OK(cag_tangents_of_two(e[1], part, &fewer, &m, &err));
      assert_int_equal(m, expected);
      for (size_t k = 0; k < m; k++) assert_true(fewer[k].t2 > 1 && fewer[k].t2 < 4);
      free(fewer);
      free(lines);
      cag_curve_release(part);
    }
    cag_curve_release(e[0]);
    cag_curve_release(e[1]);
  }
  assert_true(seen[0] > 0 && seen[2] > 0 && seen[4] > 0);
}

// Circles that touch have three tangents from outside and one from within; those of one center
// have none.
static void touching_circles_have_the_tangent_of_their_point(void **state) {
  (void)state;
  static const struct {
    double x, r;
    size_t n;
  } cases[] = {{3, 2, 3}, {1, 2, 1}, {0, 2, 0}, {-3, 2, 3}, {3.001, 2, 4}, {2.999, 2, 2}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const CagTransform f = plane_frame(0, 0, 0), g = plane_frame(cases[i].x, 0, 0);
    CagCurve *a, *b;
    CagTangentLine *lines;
    size_t n;
    OK(cag_curve_arc(1, 1, -1, 2 * M_PI - 1, &f, &a, &err));
    OK(cag_curve_arc(cases[i].r, cases[i].r, -1, 2 * M_PI - 1, &g, &b, &err));
    OK(cag_tangents_of_two(a, b, &lines, &n, &err));
    assert_int_equal(n, cases[i].n);
    for (size_t k = 0; k < n; k++) {
      const CagVec3 d = cag_sub(lines[k].q, lines[k].p);
      assert_true(cag_norm(d) > 1e-3);
      NEAR(cag_dot(d, lines[k].p), 0, 1e-9);
    }
    free(lines);
    cag_curve_release(a);
    cag_curve_release(b);
  }
}

// --- Random fillets ---

// Between two lines: the arc leaves at radius tan(turn / 2) from the corner.
static void fillets_of_lines_are_closed_forms(void **state) {
  (void)state;
  seed = 51;
  for (int i = 0; i < 100; i++) {
    const CagVec3 corner = random_place(3), before = random_place(3), after = random_place(3);
    const CagVec3 a = cag_sub(corner, before), b = cag_sub(after, corner);
    const double across = a.x * b.y - a.y * b.x, turn = atan2(fabs(across), cag_dot(a, b));
    const double room = fmin(cag_norm(a), cag_norm(b)) / tan(turn / 2),
                 radius = room * uniform(0.1, 0.95);
    const double back = radius * tan(turn / 2);
    // A third of the pairs cross before the end of the first and after the start of the second.
    const CagVec3 end = i % 3 ? corner : cag_madd(corner, 0.2, a);
    const CagVec3 start = i % 3 ? corner : cag_madd(corner, -0.3, b);
    CagCurve *p, *q, *arc;
    CagVec3 in, out;
    double t, u, bend;
    OK(cag_curve_line(before, end, 2, &p, &err));
    OK(cag_curve_line(start, after, 2, &q, &err));
    OK(cag_fillet(p, q, radius, &arc, &t, &u, &err));
    near_vec(at(p, t), cag_madd(corner, -back, cag_unit(a)), 1e-9);
    near_vec(at(q, u), cag_madd(corner, back, cag_unit(b)), 1e-9);
    near_vec(at(arc, arc->start), at(p, t), 1e-9);
    near_vec(at(arc, arc->end), at(q, u), 1e-9);
    OK(cag_curve_tangent(arc, arc->start, CAG_SIDE_RIGHT, &in, &err));
    OK(cag_curve_tangent(arc, arc->end, CAG_SIDE_LEFT, &out, &err));
    near_vec(in, cag_unit(a), 1e-9);
    near_vec(out, cag_unit(b), 1e-9);
    OK(cag_curve_length(arc, arc->start, arc->end, &bend, &err));
    NEAR(bend, radius * turn, 1e-9 * (1 + bend));
    assert_int_equal(arc->dimension, 2);
    cag_curve_release(arc);
    FAILS(cag_fillet(p, q, room * 1.01, &arc, &t, &u, &err), "radius-too-large");
    FAILS(cag_fillet(p, q, 0, &arc, &t, &u, &err), "radius-not-positive");
    FAILS(cag_fillet(p, q, INFINITY, &arc, &t, &u, &err), "radius-not-positive");
    cag_curve_release(p);
    cag_curve_release(q);
  }
}

// From a line to a circle and from a circle to a circle: the center has the right distances.
static void fillets_of_arcs_touch_both(void **state) {
  (void)state;
  seed = 52;
  for (int i = 0; i < 60; i++) {
    const double r = uniform(1, 3), start = uniform(-1, 1), turn = uniform(0.4, 1.5);
    const bool left = i % 2, two = i % 4 >= 2;
    const double radius = uniform(0.05, 0.25), sign = left ? 1 : -1;
    // b begins at angle `start` and runs counter-clockwise; a arrives there, turned by `turn`.
    const CagTransform f = plane_frame(0, 0, 0);
    const CagVec3 corner = {r * cos(start), r * sin(start), 0};
    const double way = start + M_PI / 2 - sign * turn;
    const CagVec3 d = {cos(way), sin(way), 0}, n = {-d.y, d.x, 0};
    CagCurve *a, *b, *arc;
    CagVec3 p[2], q[2], tangent, last;
    double t, u;
    OK(cag_curve_arc(r, r, start, start + 2, &f, &b, &err));
    const CagVec3 center_a = cag_madd(corner, 1.5, n); // to the left of a
    if (two) {
      const CagTransform g = plane_frame(center_a.x, center_a.y, way - M_PI / 2 - 1);
      OK(cag_curve_arc(1.5, 1.5, 0, 1, &g, &a, &err));
    } else {
      OK(cag_curve_line(cag_madd(corner, -2, d), corner, 2, &a, &err));
    }
    OK(cag_fillet(a, b, radius, &arc, &t, &u, &err));
    OK(cag_curve_eval(arc, arc->start, 1, CAG_SIDE_RIGHT, p, &err));
    OK(cag_curve_eval(arc, arc->end, 1, CAG_SIDE_LEFT, q, &err));
    near_vec(p[0], at(a, t), 1e-10);
    near_vec(q[0], at(b, u), 1e-10);
    OK(cag_curve_tangent(a, t, CAG_SIDE_LEFT, &tangent, &err));
    OK(cag_curve_tangent(b, u, CAG_SIDE_RIGHT, &last, &err));
    near_vec(cag_unit(p[1]), tangent, 1e-9);
    near_vec(cag_unit(q[1]), last, 1e-9);
    const CagVec3 u1 = cag_unit(p[1]);
    const CagVec3 center = cag_madd(p[0], sign * radius, cag_vec3(-u1.y, u1.x, 0));
    NEAR(cag_norm(center), left ? r - radius : r + radius, 1e-10);
    if (two) NEAR(cag_norm(cag_sub(center, center_a)), left ? 1.5 - radius : 1.5 + radius, 1e-10);
    else NEAR(cag_dot(cag_sub(center, corner), n), sign * radius, 1e-10);
    NEAR(cag_norm(cag_sub(at(arc, (arc->start + arc->end) / 2), center)), radius, 1e-12);
    double length;
    OK(cag_curve_length(arc, arc->start, arc->end, &length, &err));
    assert_true(length < M_PI * radius);
    cag_curve_release(arc);
    cag_curve_release(a);
    cag_curve_release(b);
  }
}

static void what_has_no_corner_is_refused(void **state) {
  (void)state;
  CagCurve *a, *b, *arc, *space;
  double t, u;
  OK(cag_curve_line(cag_vec3(0, 0, 0), cag_vec3(2, 0, 0), 2, &a, &err));
  OK(cag_curve_line(cag_vec3(2, 0, 0), cag_vec3(4, 1e-10, 0), 2, &b, &err));
  FAILS(cag_fillet(a, b, 1, &arc, &t, &u, &err), "no-corner");
  cag_curve_release(b);
  OK(cag_curve_line(cag_vec3(2, 0, 0), cag_vec3(1, 1e-10, 0), 2, &b, &err));
  FAILS(cag_fillet(a, b, 1e-3, &arc, &t, &u, &err), "no-corner");
  cag_curve_release(b);
  OK(cag_curve_line(cag_vec3(2, 1, 0), cag_vec3(4, 1, 0), 2, &b, &err));
  FAILS(cag_fillet(a, b, 1, &arc, &t, &u, &err), "curves-do-not-meet");
  OK(cag_curve_to_space(b, &space, &err));
  FAILS(cag_fillet(a, space, 1, &arc, &t, &u, &err), "not-planar");
  FAILS(cag_fillet(space, b, 1, &arc, &t, &u, &err), "not-planar");
  cag_curve_release(space);
  cag_curve_release(b);
  cag_curve_release(a);
}

// A polyline in the plane or in space: each corner loses 2 r tan(turn / 2) and gains r turn.
static void random_polylines_are_rounded(void **state) {
  (void)state;
  seed = 53;
  for (int i = 0; i < 60; i++) {
    CagVec3 p[6];
    const bool closed = i % 2, space = i % 4 >= 2;
    const size_t n = 6;
    for (size_t k = 0; k < n; k++) {
      const double angle = 2 * M_PI * (double)k / 6;
      p[k] = cag_add(cag_vec3(4 * cos(angle), 4 * sin(angle), 0), random_place(0.8));
      if (space) p[k].z = uniform(-1, 1);
    }
    if (i % 3 == 0) p[2] = cag_lerp(p[1], p[3], 0.4); // straight on
    const double radius = uniform(0.1, 0.5);
    double expected = 0, length;
    CagVec3 corner_in = {0, 0, 0};
    for (size_t k = 0; k < n; k++) {
      if (!closed && k + 1 == n) break;
      expected += cag_norm(cag_sub(p[(k + 1) % n], p[k]));
    }
    for (size_t k = 0; k < n; k++) {
      if (!closed && (k == 0 || k + 1 == n)) continue;
      const CagVec3 a = cag_unit(cag_sub(p[k], p[(k + n - 1) % n]));
      const CagVec3 b = cag_unit(cag_sub(p[(k + 1) % n], p[k]));
      const double turn = atan2(cag_norm(cag_cross(a, b)), cag_dot(a, b));
      expected += radius * (turn - 2 * tan(turn / 2));
      if (k == 1) corner_in = cag_madd(p[k], -radius * tan(turn / 2), a);
    }
    CagCurve *c, *r;
    OK(cag_curve_polyline(p, n, closed, space ? 3 : 2, &c, &err));
    OK(cag_curve_rounded(c, radius, &r, &err));
    assert_true(r->closed == closed && r->dimension == c->dimension);
    OK(cag_curve_length(r, r->start, r->end, &length, &err));
    NEAR(length, expected, 1e-9);
    // Smooth, and through the first point of the corner's arc.
    double *cuts, distance, t;
    size_t count;
    CagVec3 nearest;
    OK(cag_curve_cuts(r, &cuts, &count, &err));
    for (size_t k = 1; k + 1 < count; k++) {
      CagVec3 before, after;
      OK(cag_curve_tangent(r, cuts[k], CAG_SIDE_LEFT, &before, &err));
      OK(cag_curve_tangent(r, cuts[k], CAG_SIDE_RIGHT, &after, &err));
      near_vec(before, after, 1e-9);
    }
    OK(cag_curve_closest(r, corner_in, &t, &nearest, &distance, &err));
    NEAR(distance, 0, 1e-9);
    if (!closed) {
      near_vec(at(r, r->start), p[0], 0);
      near_vec(at(r, r->end), p[n - 1], 0);
    }
    free(cuts);
    cag_curve_release(r);
    cag_curve_release(c);
  }
}

// A half disc: its two corners are right angles between a line and an arc.
static void corners_of_other_curves_are_rounded(void **state) {
  (void)state;
  const double R = 3, r = 0.5;
  // The center is at height r above the diameter and R - r from the disc's center.
  const double x = sqrt((R - r) * (R - r) - r * r);
  const double expected = 2 * x + 2 * r * (M_PI - acos(r / (R - r))) + R * 2 * acos(r / (R - r));
  for (int first = 0; first < 3; first++) {
    const CagTransform f = plane_frame(1, 2, 0);
    CagCurve *parts[3], *c, *rounded;
    double length;
    const CagVec3 a = {1 - R, 2, 0}, b = {1 + R, 2, 0}, middle = {1.3, 2, 0};
    size_t n = 0;
    // The seam is at a corner, or within the line.
    if (first == 2) OK(cag_curve_line(middle, b, 2, &parts[n++], &err));
    if (first == 1) OK(cag_curve_line(a, b, 2, &parts[n++], &err));
    OK(cag_curve_arc(R, R, 0, M_PI, &f, &parts[n++], &err));
    if (first == 2) OK(cag_curve_line(a, middle, 2, &parts[n++], &err));
    if (first == 0) OK(cag_curve_line(a, b, 2, &parts[n++], &err));
    OK(cag_curve_join(parts, n, &c, &err));
    OK(cag_curve_rounded(c, r, &rounded, &err));
    OK(cag_curve_length(rounded, rounded->start, rounded->end, &length, &err));
    NEAR(length, expected, 1e-9);
    assert_true(rounded->closed);
    cag_curve_release(rounded);
    assert_int_not_equal(cag_curve_rounded(c, 1.6, &rounded, &err), CAG_OK);
    assert_string_equal(err.reason, "radius-too-large");
    while (n > 0) cag_curve_release(parts[--n]);
    cag_curve_release(c);
  }
  const CagVec3 bend[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}};
  CagCurve *c, *rounded;
  OK(cag_curve_bezier(bend, NULL, 4, 3, &c, &err));
  FAILS(cag_curve_rounded(c, 0.1, &rounded, &err), "not-planar");
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
      cmocka_unit_test(random_conditions_have_their_conic),
      cmocka_unit_test(conditions_leave_no_rounding),
      cmocka_unit_test(random_shoulders_have_their_weight),
      cmocka_unit_test(ranges_of_open_conics_have_their_limits),
      cmocka_unit_test(random_open_conics_keep_their_points),
      cmocka_unit_test(random_circles_touch_as_chosen),
      cmocka_unit_test(circles_that_just_reach_are_found),
      cmocka_unit_test(tangents_from_random_points),
      cmocka_unit_test(random_ellipses_have_their_common_tangents),
      cmocka_unit_test(touching_circles_have_the_tangent_of_their_point),
      cmocka_unit_test(fillets_of_lines_are_closed_forms),
      cmocka_unit_test(fillets_of_arcs_touch_both),
      cmocka_unit_test(what_has_no_corner_is_refused),
      cmocka_unit_test(random_polylines_are_rounded),
      cmocka_unit_test(corners_of_other_curves_are_rounded),
      cmocka_unit_test(random_ellipses_and_hyperbolas_are_classified),
      cmocka_unit_test(random_parabolas_are_classified),
      cmocka_unit_test(random_lines_and_nothing_are_classified),
      cmocka_unit_test(lines_of_axes_are_exact),
      cmocka_unit_test(upright_axes_are_at_90_degrees),
      cmocka_unit_test(limits_of_classes_are_relative),
      cmocka_unit_test(images_under_random_maps_keep_the_value),
      cmocka_unit_test(polars_are_half_the_gradient),
      cmocka_unit_test(branches_run_as_documented),
      cmocka_unit_test(curves_have_the_equation_that_they_were_made_from),
      cmocka_unit_test(frames_of_vertical_planes_are_level),
      cmocka_unit_test(lines_and_other_curves_have_their_equation_or_none),
      cmocka_unit_test(points_at_an_abscissa_solve_the_equation),
      cmocka_unit_test(random_segments_stay_on_their_side),
      cmocka_unit_test(random_lines_meet_random_conics),
      cmocka_unit_test(lines_near_a_touch),
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
