// Curve theory compared with closed forms: the twisted cubic, cusps, waves, and knots.

#include "geom/curve/frenet.h"
#include "geom/curve/function.h"
#include "random.h"
#include "support.h"

// The derivatives 1..3 of the curve (t, t^2, t^3) at t.
static void twisted(double t, CagVec3 d[3]) {
  d[0] = cag_vec3(1, 2 * t, 3 * t * t);
  d[1] = cag_vec3(0, 2, 6 * t);
  d[2] = cag_vec3(0, 0, 6);
}

// Curvature 2 sqrt(9 t^4 + 9 t^2 + 1) / (9 t^4 + 4 t^2 + 1)^(3/2), torsion 3 / (9 t^4 + 9 t^2 + 1).
static void the_twisted_cubic_has_its_curvature_and_torsion(void **state) {
  (void)state;
  for (double t = -2; t <= 2; t += 0.25) {
    CagVec3 d[3];
    CagFrenet f;
    double speed;
    const double bend = 9 * t * t * t * t + 9 * t * t + 1, run = 9 * t * t * t * t + 4 * t * t + 1;
    twisted(t, d);
    OK(cag_frenet_of(d, &speed, &f, &err));
    NEAR(speed, sqrt(run), 1e-14 * sqrt(run));
    NEAR(f.curvature, 2 * sqrt(bend) / pow(run, 1.5), 1e-14);
    NEAR(f.torsion, 3 / bend, 1e-14);
    NEAR(cag_dot(f.normal, f.tangent), 0, 1e-15);
    near_vec(cag_cross(f.tangent, f.normal), f.binormal, 1e-15);
  }
}

static void frames_of_lines_and_of_nothing(void **state) {
  (void)state;
  CagVec3 d[3] = {{2, -1, 2}, {4, -2, 4}, {1, 0, 0}};
  CagFrenet f;
  double speed;
  OK(cag_frenet_of(d, &speed, &f, &err));
  assert_false(f.has_normal);
  assert_true(f.curvature == 0 && speed == 3);
  d[0] = cag_vec3(0, 0, 0);
  FAILS_AT(cag_frenet_of(d, &speed, &f, &err), "singular-point", 0);
}

// C(t) = t e with t = sin u has the derivatives of sin u. C = t^4 with t = u^2, at u = 1, is u^8.
static void the_chain_rule_holds_to_any_order(void **state) {
  (void)state;
  CagVec3 d[8] = {{0, 0, 0}}, out[8];
  const double f[8] = {2, 2, 0, 0, 0, 0, 0, 0};
  const double fourth[4] = {4, 12, 24, 24};
  for (int k = 0; k < 4; k++) d[k] = cag_vec3(fourth[k], 0, k == 0);
  OK(cag_chain_derivatives(d, f, 8, out, &err));
  double expected = 1;
  for (int k = 0; k < 8; k++) {
    expected *= 8 - k;
    NEAR(out[k].x, expected, 0);
    NEAR(out[k].z, k < 2 ? 2 : 0, 0);
  }
  const double still[1] = {0};
  FAILS_AT(cag_chain_derivatives(d, still, 1, out, &err), "parameter-stands-still", 0);
}

static void a_triad_that_turns_has_a_skew_derivative(void **state) {
  (void)state;
  // Rotated by t about z, and then by 2 t about its own x axis. The rates are those of the angular
  // velocity (2, sin 2t, cos 2t) in the triad.
  const double t = 0.7, c = cos(t), s = sin(t), C = cos(2 * t), S = sin(2 * t);
  const CagVec3 m[3] = {{c, s, 0}, {-s * C, c * C, S}, {s * S, -c * S, C}};
  CagVec3 dm[3] = {{-s, c, 0},
                   {-c * C + 2 * s * S, -s * C - 2 * c * S, 2 * C},
                   {c * S + 2 * s * C, s * S - 2 * c * C, -2 * S}};
  double a[3][3];
  OK(cag_triad_derivative(m, dm, a, &err));
  const double w[3] = {2, S, C};
  NEAR(a[0][1], w[2], 1e-15);
  NEAR(a[1][2], w[0], 1e-15);
  NEAR(a[2][0], w[1], 1e-15);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) NEAR(a[i][j] + a[j][i], 0, 1e-15);
  dm[0] = m[0];
  FAILS_AT(cag_triad_derivative(m, dm, a, &err), "triad-not-rigid", 0);
  const CagVec3 skew[3] = {{1, 0, 0}, {0, 1, 0}, {0, 1e-3, 1}};
  FAILS_AMONG(cag_triad_derivative(skew, dm, a, &err), "frame-not-orthonormal", 1, 2);
}

// Three perpendicular unit vectors, from random rotations about each axis.
static void random_triad(CagVec3 m[3]) {
  const CagVec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int i = 0; i < 3; i++) m[i] = axes[i];
  for (int i = 0; i < 3; i++) {
    const double turn = uniform(-M_PI, M_PI), c = cos(turn), s = sin(turn);
    const CagVec3 a = m[i], b = m[(i + 1) % 3];
    m[i] = cag_madd(cag_scaled(a, c), s, b);
    m[(i + 1) % 3] = cag_madd(cag_scaled(b, c), -s, a);
  }
}

// The derivatives w x m of a rotating triad, and the same with one entry changed: the error names
// the larger index of the first pair that does not agree. Also all ways in which vectors are not a
// triad.
static void any_derivative_that_is_no_turn_is_refused(void **state) {
  (void)state;
  seed = 61;
  for (int round = 0; round < 300; round++) {
    CagVec3 m[3], dm[3];
    double a[3][3];
    random_triad(m);
    CagVec3 turn;
    turn.x = uniform(-3, 3);
    turn.y = uniform(-3, 3);
    turn.z = uniform(-3, 3);
    for (int i = 0; i < 3; i++) dm[i] = cag_cross(turn, m[i]);
    OK(cag_triad_derivative(m, dm, a, &err));
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) NEAR(a[i][j], cag_dot(turn, cag_cross(m[i], m[j])), 1e-14);
    const int i = round % 3, j = round / 3 % 3, sign = round / 9 % 2 ? -1 : 1;
    const CagVec3 kept = dm[i];
    dm[i] = cag_madd(dm[i], sign * uniform(1e-3, 2), m[j]);
    FAILS_AT(cag_triad_derivative(m, dm, a, &err), "triad-not-rigid", i > j ? i : j);
    dm[i] = cag_madd(kept, sign * 1e-13, m[j]);
    OK(cag_triad_derivative(m, dm, a, &err));
    dm[i] = kept;
    m[i] = cag_madd(m[i], sign * uniform(1e-3, 0.5), m[j]);
    FAILS_AMONG(cag_triad_derivative(m, dm, a, &err), "frame-not-orthonormal", i < j ? i : j,
                i > j ? i : j);
  }
}

// --- Curves of polynomials by Bezier points ---

static CagCurve *bezier(const CagVec3 *points, size_t n, int dimension) {
  CagCurve *c;
  OK(cag_curve_bezier(points, NULL, n, dimension, &c, &err));
  return c;
}

// (t, t^2, t^3) over 0..1.
static CagCurve *twisted_cubic(void) {
  static const CagVec3 p[4] = {{0, 0, 0}, {1.0 / 3, 0, 0}, {2.0 / 3, 1.0 / 3, 0}, {1, 1, 1}};
  return bezier(p, 4, 3);
}

static void contact_with_planes(void **state) {
  (void)state;
  CagCurve *c = twisted_cubic();
  CagPlaneContact k;
  OK(cag_curve_contact(c, 0, cag_vec3(2, 0, 0), &k, &err));
  assert_true(k.order == 0 && k.after == 1 && k.before == -1 && k.c[1] == 1);
  OK(cag_curve_contact(c, 0, cag_vec3(0, 1, 0), &k, &err));
  assert_true(k.order == 1 && k.after == 1 && k.before == 1);
  NEAR(k.c[2], 1, 1e-15);
  OK(cag_curve_contact(c, 0, cag_vec3(0, 0, -3), &k, &err));
  assert_true(k.order == 2 && k.after == -1 && k.before == 1);
  NEAR(k.c[3], -1, 1e-15);
  // The osculating plane at 1/2 has the normal (3 t^2, -3 t, 1); the distance from it is (t -
  // 1/2)^3.
  OK(cag_curve_contact(c, 0.5, cag_vec3(0.75, -1.5, 1), &k, &err));
  assert_true(k.order == 2 && k.after == 1 && k.before == -1);
  NEAR(k.c[3], 1 / sqrt(0.75 * 0.75 + 1.5 * 1.5 + 1), 1e-14);
  cag_curve_release(c);
  // A circle is planar.
  CagTransform frame = cag_transform_identity();
  OK(cag_curve_arc(2, 2, 0, 2 * M_PI, &frame, &c, &err));
  OK(cag_curve_contact(c, 1, cag_vec3(0, 0, 1), &k, &err));
  assert_true(k.order == -1 && k.before == 0 && k.after == 0);
  cag_curve_release(c);
}

static void expect_points(const CagParameters *list, const double *t, size_t n, double tolerance) {
  assert_int_equal(list->count, n);
  for (size_t i = 0; i < n; i++) NEAR(list->t[i], t[i], tolerance);
}

// The cusp (x^2, x^3), x = 2 t - 1. The twisted cubic has no special points.
static void a_cusp_is_singular_and_nothing_else(void **state) {
  (void)state;
  static const CagVec3 cusp[4] = {{1, -1, 0}, {-1.0 / 3, 1, 0}, {-1.0 / 3, -1, 0}, {1, 1, 0}};
  CagCurve *c = bezier(cusp, 4, 2);
  CagSpecialPoints s;
  const double half = 0.5;
  OK(cag_curve_special_points(c, &s, &err));
  expect_points(&s.points[CAG_STANDS], &half, 1, 1e-12);
  assert_true(s.points[CAG_STRAIGHT].count == 0 && s.stretches[CAG_STRAIGHT].count == 0);
  assert_int_equal(s.stretches[CAG_FLAT].count, 2);
  cag_special_points_free(&s);
  cag_curve_release(c);
  c = twisted_cubic();
  OK(cag_curve_special_points(c, &s, &err));
  for (int k = 0; k < CAG_VANISHINGS; k++)
    assert_true(s.points[k].count == 0 && s.stretches[k].count == 0);
  cag_special_points_free(&s);
  cag_curve_release(c);
}

// (t, sin 40 t) is straight where sin 40 t = 0. (t, t^2, sin 9 t) has torsion 0 where the third
// derivative of the last coordinate is 0, that is, cos 9 t = 0, and is never straight there.
static CagStatus wave(void *context, double t, int order, CagVec3 *out, CagError *e) {
  (void)e;
  const int dimension = *(const int *)context;
  const double w = dimension == 2 ? 40 : 9;
  double power = 1;
  for (int k = 0; k <= order; k++, power *= w) {
    const double y = power * sin(w * t + k * M_PI / 2), x = k == 0 ? t : k == 1;
    const double square = k == 0 ? t * t : k == 1 ? 2 * t : k == 2 ? 2 : 0;
    out[k] = dimension == 2 ? cag_vec3(x, y, 0) : cag_vec3(x, square, y);
  }
  return CAG_OK;
}

static void forget(void *context) { (void)context; }

static void waves_are_straight_at_their_zeros_and_flat_where_they_twist_back(void **state) {
  (void)state;
  CagCurve *c;
  CagSpecialPoints s;
  int dimension = 2;
  double t[64];
  const CagCurveFunction function = {.eval = wave, .release = forget, .context = &dimension};
  OK(cag_curve_function(&function, 2, 0.01, 4, false, &c, &err));
  OK(cag_curve_special_points(c, &s, &err));
  for (int i = 0; i < 50; i++) t[i] = (i + 1) * M_PI / 40;
  expect_points(&s.points[CAG_STRAIGHT], t, 50, 1e-12);
  assert_int_equal(s.points[CAG_STANDS].count, 0);
  cag_special_points_free(&s);
  cag_curve_release(c);
  dimension = 3;
  OK(cag_curve_function(&function, 3, 0, 4, false, &c, &err));
  OK(cag_curve_special_points(c, &s, &err));
  for (int i = 0; i < 11; i++) t[i] = (i + 0.5) * M_PI / 9;
  expect_points(&s.points[CAG_FLAT], t, 11, 1e-12);
  assert_true(s.points[CAG_STRAIGHT].count == 0 && s.points[CAG_STANDS].count == 0);
  cag_special_points_free(&s);
  cag_curve_release(c);
}

// A quadratic B-spline with four collinear points and a bend has a straight piece. Natural ends and
// zeros of fourth order, as of (t, t^5), count.
static void pieces_and_ends(void **state) {
  (void)state;
  static const CagVec3 p[5] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 1, 0}, {3, 3, 0}};
  static const double knots[8] = {0, 0, 0, 1, 2, 3, 3, 3};
  CagCurve *c;
  CagSpecialPoints s;
  OK(cag_curve_nurbs(p, NULL, 5, 2, knots, 2, &c, &err));
  OK(cag_curve_special_points(c, &s, &err));
  assert_int_equal(s.stretches[CAG_STRAIGHT].count, 2);
  assert_true(s.stretches[CAG_STRAIGHT].t[0] == 0 && s.stretches[CAG_STRAIGHT].t[1] == 1);
  assert_int_equal(s.points[CAG_STRAIGHT].count, 0);
  cag_special_points_free(&s);
  cag_curve_release(c);
  // (t, t^4): at the start, the curvature is 0, but does not change sign.
  static const CagVec3 quartic[5] = {{0, 0, 0}, {.25, 0, 0}, {.5, 0, 0}, {.75, 0, 0}, {1, 1, 0}};
  const double zero = 0;
  c = bezier(quartic, 5, 2);
  OK(cag_curve_special_points(c, &s, &err));
  expect_points(&s.points[CAG_STRAIGHT], &zero, 1, 0);
  cag_special_points_free(&s);
  cag_curve_release(c);
  // A line is straight everywhere. It is planar, so its torsion is not reported separately.
  OK(cag_curve_line(cag_vec3(1, 2, 3), cag_vec3(4, 6, 8), 3, &c, &err));
  OK(cag_curve_special_points(c, &s, &err));
  assert_true(s.stretches[CAG_STRAIGHT].count == 2 && s.points[CAG_STRAIGHT].count == 0);
  cag_special_points_free(&s);
  cag_curve_release(c);
}

// --- Powers ---

enum { DEGREE = 6 };

static double binomial(int n, int k) {
  double b = 1;
  for (int i = 1; i <= k; i++) b = b * (n - k + i) / i;
  return b;
}

// Bernstein coefficients of f s^power with s = low + (high - low) t.
static void power_coefficients(double f, int power, double low, double high, double *out) {
  for (int i = 0; i <= DEGREE; i++) {
    double sum = 0;
    for (int j = 0; j <= i && j <= power; j++) // for t^j
      sum += binomial(i, j) / binomial(DEGREE, j) * binomial(power, j) * pow(low, power - j) *
             pow(high - low, j);
    out[i] = f * sum;
  }
}

// The curve (f[0] s^power[0], ...) in the axes of the frame, over s in [low, high].
static CagCurve *powers(const double f[3], const int power[3], double low, double high,
                        const CagTransform *frame) {
  double x[3][DEGREE + 1];
  CagVec3 p[DEGREE + 1];
  CagCurve *c, *scaled;
  for (int k = 0; k < 3; k++) power_coefficients(f[k], power[k], low, high, x[k]);
  for (int i = 0; i <= DEGREE; i++)
    p[i] = cag_transform_point(frame, cag_vec3(x[0][i], x[1][i], x[2][i]));
  OK(cag_curve_bezier(p, NULL, DEGREE + 1, 3, &c, &err));
  OK(cag_curve_reparametrize(c, low, high, &scaled, &err));
  cag_curve_release(c);
  return scaled;
}

// With u = s^m, (a u, b u^2, c u^3) has the curvature 2 b / a^2 and the torsion 3 c / (a b) at 0.
static void frames_of_powers_have_their_limits(void **state) {
  (void)state;
  seed = 501;
  int cusps = 0, twisted = 0, straight = 0;
  for (int m = 1; m <= 3; m++)
    for (int n = m + 1; n <= 5; n++)
      for (int q = n + 1; q <= 6; q++)
        for (int where = 0; where < (m < 3 ? 3 : 1); where++) { // at the start, inside, at the end
          const CagTransform frame = cag_rpy(0.7 * n, 0.3 * m, 0.9 * q + where);
          const double a = uniform(0.5, 2), b = uniform(0.5, 2), c = uniform(0.5, 2);
          const double f[3] = {a, b, c};
          const int power[3] = {m, n, q};
          CagCurve *curve = powers(f, power, where == 0 ? 0 : -1, where == 2 ? 0 : 1, &frame);
          const CagVec3 x = cag_transform_vector(&frame, cag_vec3(1, 0, 0)),
                        y = cag_transform_vector(&frame, cag_vec3(0, 1, 0)),
                        z = cag_transform_vector(&frame, cag_vec3(0, 0, 1));
          // From the left, an even power runs backward.
          const double sense = where == 2 && m % 2 == 0 ? -1 : 1;
          CagVec3 tangent;
          OK(cag_curve_tangent(curve, 0, where == 2 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, &tangent,
                               &err));
          near_vec(tangent, cag_scaled(x, sense), 1e-9);
          CagFrenet frenet;
          if (n < 2 * m) {
            FAILS(cag_curve_frenet(curve, 0, &frenet, &err), "curvature-undefined");
            cusps++;
          } else if (n == 2 * m && q < 3 * m) {
            FAILS(cag_curve_frenet(curve, 0, &frenet, &err), "torsion-undefined");
          } else {
            OK(cag_curve_frenet(curve, 0, &frenet, &err));
            near_vec(frenet.tangent, cag_scaled(x, sense), 1e-9);
            const bool bent = n == 2 * m;
            assert_int_equal(frenet.has_normal, bent);
            NEAR(frenet.curvature, bent ? 2 * b / (a * a) : 0, 1e-8);
            if (bent) {
              near_vec(frenet.normal, y, 1e-8);
              near_vec(frenet.binormal, cag_scaled(z, sense), 1e-8);
              NEAR(frenet.torsion, q == 3 * m ? 3 * c / (a * b) : 0, 1e-7);
              twisted += q == 3 * m;
            } else {
              straight++;
            }
          }
          // Contact with the planes of each two of the axes.
          const CagVec3 normals[3] = {x, y, z};
          for (int k = 0; k < 3; k++) {
            const int sign = (m + n + q + k) % 2 ? -1 : 1;
            CagPlaneContact contact;
            OK(cag_curve_contact(curve, 0, cag_scaled(normals[k], 3 * sign), &contact, &err));
            assert_int_equal(contact.order, power[k] - 1);
            assert_int_equal(contact.after, sign);
            assert_int_equal(contact.before, power[k] % 2 ? -sign : sign);
            for (int d = 1; d <= 3; d++) NEAR(contact.c[d], power[k] == d ? sign * f[k] : 0, 1e-9);
          }
          cag_curve_release(curve);
        }
  assert_true(cusps >= 10 && twisted >= 6 && straight >= 15);
}

// At a joint of two powers, the lower order of contact counts, and each side has its own sign.
static void contact_at_a_joint_is_the_looser_of_both(void **state) {
  (void)state;
  const CagTransform frame = cag_transform_identity();
  for (int left = 2; left <= 4; left++)
    for (int right = 2; right <= 4; right++)
      for (int flip = 0; flip < 3; flip++) {
        // flip 2: the left side is a line.
        const double f[3] = {1, flip == 2 ? 0 : 2, 0}, g[3] = {1, flip ? -1 : 1, 0};
        const int p[3] = {1, left, 1}, q[3] = {1, right, 1};
        CagCurve *parts[2] = {powers(f, p, -1, 0, &frame), powers(g, q, 0, 1, &frame)}, *c, *r;
        CagPlaneContact k;
        OK(cag_curve_join(parts, 2, &c, &err));
        const double joint = c->start + (c->end - c->start) / 2;
        OK(cag_curve_contact(c, joint, cag_vec3(0, 1, 0), &k, &err));
        const int order = flip == 2 || right < left ? right - 1 : left - 1;
        assert_int_equal(k.order, order);
        assert_int_equal(k.after, flip ? -1 : 1);
        assert_int_equal(k.before, flip == 2 ? 0 : left % 2 ? -1 : 1);
        OK(cag_curve_reverse(c, &r, &err)); // exchanges the sides
        OK(cag_curve_contact(r, joint, cag_vec3(0, 1, 0), &k, &err));
        assert_int_equal(k.order, order);
        assert_int_equal(k.before, flip ? -1 : 1);
        assert_int_equal(k.after, flip == 2 ? 0 : left % 2 ? -1 : 1);
        cag_curve_release(r);
        cag_curve_release(c);
        for (int i = 0; i < 2; i++) cag_curve_release(parts[i]);
      }
}

// At regular points, from projections; the torsion is a determinant of three derivatives.
static void random_frames_are_those_of_the_derivatives(void **state) {
  (void)state;
  seed = 502;
  for (int round = 0; round < 200; round++) {
    CagVec3 p[6], d[4];
    double w[6];
    for (int i = 0; i < 6; i++) {
      p[i].x = uniform(-3, 3);
      p[i].y = uniform(-3, 3);
      p[i].z = round % 2 ? uniform(-3, 3) : 0;
      w[i] = uniform(0.5, 2);
    }
    CagCurve *c;
    OK(cag_curve_bezier(p, round % 3 ? w : NULL, 6, round % 2 ? 3 : 2, &c, &err));
    const double t = round % 20 == 0 ? 0 : round % 20 == 1 ? 1 : uniform(0, 1);
    CagFrenet f;
    OK(cag_curve_eval(c, t, 3, t >= 1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, d, &err));
    OK(cag_curve_frenet(c, t, &f, &err));
    const CagVec3 tangent = cag_unit(d[1]), side = cag_madd(d[2], -cag_dot(d[2], tangent), tangent);
    const double speed = cag_norm(d[1]), bend = cag_norm(side) / (speed * speed);
    if (speed < 0.2 || bend < 1e-3) {
      cag_curve_release(c);
      continue;
    }
    assert_true(f.has_normal);
    near_vec(f.point, d[0], 0);
    near_vec(f.tangent, tangent, 1e-13);
    near_vec(f.normal, cag_unit(side), 1e-10);
    near_vec(f.binormal, cag_cross(tangent, cag_unit(side)), 1e-10);
    NEAR(f.curvature, bend, 1e-11 * (1 + bend));
    const double area = pow(speed, 6) * bend * bend;
    const double twist = cag_dot(cag_cross(d[1], d[2]), d[3]) / area;
    NEAR(f.torsion, round % 2 ? twist : 0, 1e-9 * (1 + fabs(twist)));
    cag_curve_release(c);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_twisted_cubic_has_its_curvature_and_torsion),
      cmocka_unit_test(frames_of_lines_and_of_nothing),
      cmocka_unit_test(the_chain_rule_holds_to_any_order),
      cmocka_unit_test(a_triad_that_turns_has_a_skew_derivative),
      cmocka_unit_test(any_derivative_that_is_no_turn_is_refused),
      cmocka_unit_test(contact_with_planes),
      cmocka_unit_test(a_cusp_is_singular_and_nothing_else),
      cmocka_unit_test(waves_are_straight_at_their_zeros_and_flat_where_they_twist_back),
      cmocka_unit_test(pieces_and_ends),
      cmocka_unit_test(frames_of_powers_have_their_limits),
      cmocka_unit_test(contact_at_a_joint_is_the_looser_of_both),
      cmocka_unit_test(random_frames_are_those_of_the_derivatives),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
