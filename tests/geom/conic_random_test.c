// Random conics in any position: classes, branches, images, segments, and lines, compared with
// their definitions.

#include "conic_support.h"
#include "geom/curve/conic.h"
#include "geom/curve/family.h"

// --- Random conics ---

// Angles of lines are equal modulo a half turn, and those of directions modulo a full turn.
static void near_angle(double a, double b, double period, double tolerance) {
  NEAR(remainder(a - b, period), 0, tolerance);
}

// Checks the fields that every conic has.
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
    // The sum or difference of the distances of a point from the foci is the length of the major
    // axis.
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
  // The angle is that of the opening: 180deg along -X.
  for (int sign = -1; sign <= 1; sign += 2) {
    const CagConic c = {{0, 0, 1.0 * sign, 4.0 * sign, 0, 0}};
    CagConicClass k;
    OK(cag_conic_classify(&c, &k, &err));
    NEAR(k.angle, M_PI, 0);
  }
}

// Checks that one of the conic's lines passes through the point with the given normal.
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
    if (i % 6 == 2) { // the square of a line, avoiding cancellation in the constant
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
      // u / a = +-v / b, in either order.
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

// The angle of an axis is in (-90deg, 90deg], and zero components are positive.
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
  // A term of 5e-7 of the largest never counts as rounding, no matter how small the coefficients
  // are.
  OK(cag_conic_classify(&(CagConic){{0, 0, 0, 2e-9, 1e-15, 4e-9}}, &k, &err));
  NEAR(k.lines[0][1], 5e-7, 1e-12);
  OK(cag_conic_classify(&(CagConic){{0, 0, 0, 1e-15, 2e-9, 4e-9}}, &k, &err));
  NEAR(k.lines[0][0], 5e-7, 1e-12);
  OK(cag_conic_classify(&(CagConic){{1, 2, 1, 0, 0, -4}}, &k, &err));
  NEAR(k.book_angle, M_PI / 4, 0);
  OK(cag_conic_classify(&(CagConic){{1, -2, 1, 0, 0, -4}}, &k, &err));
  NEAR(k.book_angle, -M_PI / 4, 0);
}

// Conics with a ratio of eigenvalues of 1e-10 are ellipses, with 1e-12 parabolas. Semi-axes that
// differ by 1e-10 belong to a circle, by 1e-8 not. Sums of 1e-13 of their terms count as 0, of
// 1e-10 not.
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

// The value of the image at the image of a point, multiplied by the square of the homogeneous
// weight, is the value of the conic at the point.
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
  // A singular map is rejected, however it is rotated; a map that only scales down is not.
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
    // Finite differences of a quadratic form are exact.
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
        // Measured from the point of the line that is closest to the center.
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
  // The second branch cannot be made; the first is released.
  FAILS(cag_conic_branches(&(CagConic){{1, 0, -1, 0, 0, -1}}, 0, 400, out, &n, &err), "domain");
  assert_int_equal(n, 0);
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
    // In a plane of space, the frame maps points of the equation to those of the curve.
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
    // The y axis points uphill.
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
    // Two pieces together are the conic if both lie on it.
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

// In a vertical plane, y points upward, and the normal is in the half plane y > 0, or along X.
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

// y from the quadratic equation C y^2 + (B x + E) y + A x^2 + D x + F = 0.
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
  // Where the tangent is vertical, the rounding error of the larger terms is tolerated, but not
  // more.
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

// A segment runs from one end to the other with monotone x, on the conic, and on the side of the
// upper or lower root.
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
      // At the center, the upper root changes from one line to the other.
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

// Tangency is judged by the rounding of the terms, even far from the origin: a deviation of 1e-13
// of the radius touches, and 1e-9 does not.
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
    // A distant point of the line leads to the same result.
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
    // Parallel lines, along a direction with the rounding error of an angle.
    const Standard lines = {0, 1, 0, 1, s.angle, s.factor, s.center};
    const CagConic parallel = equation(&lines);
    const CagVec3 way = {cos(s.angle + 3e-14), sin(s.angle + 3e-14), 0};
    OK(cag_conic_line(&parallel, placed(&lines, 0.5, 0.3), way, &kind, at, &err));
    assert_int_equal(kind, CAG_LINE_NONE);
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

// Random affine images, reversed, trimmed, and with other domains: checks points, derivatives, and
// boxes, which are exact.
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
    // The rational form has the same image, and the derivatives for the new domain.
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

int main(void) {
  const struct CMUnitTest tests[] = {
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
      cmocka_unit_test(ranges_of_open_conics_have_their_limits),
      cmocka_unit_test(random_open_conics_keep_their_points),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
