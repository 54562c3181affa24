// Intersections of Bezier curves: all of them must be found.

#include "tests/geom/support.h"

#include "geom/curve/family.h"
#include "geom/curve/function.h"
#include "geom/curve/intersect.h"

static double binomial(int n, int k) {
  double b = 1;
  for (int i = 1; i <= k; i++) b *= (double)(n - k + i) / i;
  return b;
}

// The graph of the Chebyshev polynomial T_n over [-1, 1], whose Bernstein coefficients are (-1)^(n
// - i) C(2n, 2i) / C(n, i). If `turned` is set, x and y are exchanged.
static CagCurve *chebyshev(int n, bool turned) {
  CagVec3 p[16];
  CagCurve *c;
  for (int i = 0; i <= n; i++) {
    const double x = -1 + 2.0 * i / n,
                 y = ((n - i) % 2 ? -1 : 1) * binomial(2 * n, 2 * i) / binomial(n, i);
    p[i] = turned ? cag_vec3(y, x, 0) : cag_vec3(x, y, 0);
  }
  OK(cag_curve_bezier(p, NULL, (size_t)n + 1, 2, &c, &err));
  return c;
}

static void chebyshev_graphs_meet_their_mirror_images_n_squared_times(void **state) {
  (void)state;
  // x = cos a, T_n(x) = cos na = y, T_n(y) = cos nna = x: nn a = +-a + 2 pi k.
  for (int n = 2; n <= 7; n++) {
    CagCurve *a = chebyshev(n, false), *b = chebyshev(n, true);
    CagMeeting *m;
    size_t count;
    OK(cag_curve_intersect(a, b, &m, &count, &err));
    assert_int_equal(count, n * n);
    for (size_t i = 0; i < count; i++) {
      const double angle = acos(fmin(1, fmax(-1, m[i].point.x)));
      NEAR(m[i].point.y, cos(n * angle), 1e-7);
      NEAR(cos(n * n * angle), m[i].point.x, 1e-6);
    }
    free(m);
    cag_curve_release(a);
    cag_curve_release(b);
  }
}

static void a_line_meets_a_chebyshev_graph_n_times_or_touches_it(void **state) {
  (void)state;
  const int n = 9;
  CagCurve *c = chebyshev(n, false), *line;
  CagMeeting *m;
  size_t count;
  OK(cag_curve_line(cag_vec3(-2, 0, 0), cag_vec3(2, 0, 0), 2, &line, &err));
  OK(cag_curve_intersect(line, c, &m, &count, &err));
  assert_int_equal(count, n);
  for (int i = 0; i < n; i++) NEAR(m[i].point.x, -cos((2 * i + 1) * M_PI / (2 * n)), 1e-12);
  free(m);
  cag_curve_release(line);
  // y = 1 touches the maxima, and meets the end.
  OK(cag_curve_line(cag_vec3(-2, 1, 0), cag_vec3(2, 1, 0), 2, &line, &err));
  OK(cag_curve_intersect(line, c, &m, &count, &err));
  assert_int_equal(count, (n + 1) / 2);
  for (size_t i = 0; i < count; i++)
    NEAR(m[i].point.x, cos(2 * M_PI * (double)(count - 1 - i) / n), 1e-5);
  free(m);
  cag_curve_release(line);
  cag_curve_release(c);
}

static void rational_circles_meet_like_circles(void **state) {
  (void)state;
  CagTransform frame = cag_translate(cag_vec3(1, 0, 0));
  frame.planar = true;
  CagCurve *a, *b, *p, *q;
  CagMeeting *m;
  size_t count;
  OK(cag_curve_arc(1, 1, 0, 2 * M_PI, &frame, &b, &err));
  frame.m[0][3] = 0;
  OK(cag_curve_arc(1, 1, 0, 2 * M_PI, &frame, &a, &err));
  OK(cag_curve_to_nurbs(a, &p, &err));
  OK(cag_curve_to_nurbs(b, &q, &err));
  OK(cag_curve_intersect(p, q, &m, &count, &err));
  assert_int_equal(count, 2);
  near_vec(m[0].point, cag_vec3(0.5, sqrt(0.75), 0), 1e-14);
  near_vec(m[1].point, cag_vec3(0.5, -sqrt(0.75), 0), 1e-14);
  free(m);
  FAILS(cag_curve_intersect(p, p, &m, &count, &err), "overlap");
  cag_curve_release(a);
  cag_curve_release(b);
  cag_curve_release(p);
  cag_curve_release(q);
}

// --- Random comparisons ---

static double uniform(uint64_t *seed, double low, double high) {
  *seed = *seed * 6364136223846793005u + 1442695040888963407u;
  return low + (high - low) * (double)(*seed >> 11) / 9007199254740992.0;
}

static CagCurve *circle_at(double x, double y, double radius) {
  CagTransform frame = cag_translate(cag_vec3(x, y, 0));
  CagCurve *c;
  frame.planar = true;
  OK(cag_curve_arc(radius, radius, 0, 2 * M_PI, &frame, &c, &err));
  return c;
}

static CagCurve *as_spline(CagCurve *c) {
  CagCurve *spline;
  OK(cag_curve_to_nurbs(c, &spline, &err));
  cag_curve_release(c);
  return spline;
}

// Intersects a and b, and releases them.
static size_t meet(CagCurve *a, CagCurve *b, CagMeeting **out) {
  size_t n;
  OK(cag_curve_intersect(a, b, out, &n, &err));
  cag_curve_release(a);
  cag_curve_release(b);
  return n;
}

static void assert_one_touch(CagCurve *a, CagCurve *b, CagVec3 at) {
  CagMeeting *m;
  assert_int_equal(meet(a, b, &m), 1);
  assert_int_equal(m[0].multiplicity, 2);
  near_vec(m[0].point, at, 1e-7);
  free(m);
}

static void circles_that_touch_meet_once(void **state) {
  (void)state;
  uint64_t seed = 1;
  for (int i = 0; i < 300; i++) {
    const double x = uniform(&seed, -9, 9), y = uniform(&seed, -9, 9), r = uniform(&seed, 1, 5),
                 angle = uniform(&seed, 0, 2 * M_PI), other = uniform(&seed, 0.1, 0.95) * r,
                 way = i % 2 ? r - other : r + other, c = cos(angle), s = sin(angle);
    CagCurve *a = circle_at(x, y, r), *b = circle_at(x + way * c, y + way * s, other);
    if (i % 3 == 0) a = as_spline(a);
    if (i % 5 == 0) b = as_spline(b);
    assert_one_touch(a, b, cag_vec3(x + r * c, y + r * s, 0));
  }
}

static void tangents_of_a_circle_meet_it_once(void **state) {
  (void)state;
  uint64_t seed = 2;
  for (int i = 0; i < 720; i++) {
    const double r = i < 360 ? 5 : uniform(&seed, 0.5, 7), before = uniform(&seed, 1, 30),
                 after = uniform(&seed, 1, 30), angle = i % 360 * M_PI / 180, c = cos(angle),
                 s = sin(angle);
    const CagVec3 at = cag_vec3(r * c, r * s, 0);
    CagCurve *line, *circle = circle_at(0, 0, r);
    OK(cag_curve_line(cag_madd(at, -before, cag_vec3(-s, c, 0)),
                      cag_madd(at, after, cag_vec3(-s, c, 0)), 2, &line, &err));
    if (i % 2) circle = as_spline(circle);
    assert_one_touch(line, circle, at);
  }
}

static void the_order_of_contact_is_told(void **state) {
  (void)state;
  // At a parabola's vertex, the circle of curvature has contact of order 4. At the inflection of a
  // cubic, the tangent has contact of order 3.
  const CagVec3 parabola[] = {{-1, 1, 0}, {0, -1, 0}, {1, 1, 0}};
  const CagVec3 cubic[] = {{-1, -1, 0}, {-1.0 / 3, 1, 0}, {1.0 / 3, -1, 0}, {1, 1, 0}};
  CagCurve *c, *line;
  CagMeeting *m;
  OK(cag_curve_bezier(parabola, NULL, 3, 2, &c, &err));
  assert_int_equal(meet(c, circle_at(0, 0.5, 0.5), &m), 1);
  assert_int_equal(m[0].multiplicity, 4);
  free(m);
  OK(cag_curve_bezier(cubic, NULL, 4, 2, &c, &err));
  OK(cag_curve_line(cag_vec3(-2, 0, 0), cag_vec3(2, 0, 0), 2, &line, &err));
  assert_int_equal(meet(c, line, &m), 1);
  assert_int_equal(m[0].multiplicity, 3);
  near_vec(m[0].point, cag_vec3(0, 0, 0), 1e-7);
  free(m);
}

// y = x^n over [-1, 1] meets y = 0 with order n, at any size, location, and domain.
static void orders_of_contact_do_not_depend_on_scale_place_and_domain(void **state) {
  (void)state;
  uint64_t seed = 94;
  for (int i = 0; i < 120; i++) {
    const int n = 1 + i % 4;
    CagVec3 p[5];
    // The coefficients of (-1 (1 - t) + t)^n have alternating signs.
    for (int k = 0; k <= n; k++) p[k] = cag_vec3(-1 + 2.0 * k / n, (n - k) % 2 ? -1 : 1, 0);
    const double size = pow(10, uniform(&seed, -3, 3)), angle = uniform(&seed, 0, 6),
                 range = pow(10, uniform(&seed, -2, 3)), start = uniform(&seed, -range, range),
                 away = i % 2 ? 0 : 300;
    CagTransform t = cag_transform_identity();
    t.m[0][0] = t.m[1][1] = size * cos(angle);
    t.m[1][0] = size * sin(angle);
    t.m[0][1] = -t.m[1][0];
    t.m[0][3] = away * size * uniform(&seed, -1, 1);
    t.m[1][3] = away * size * uniform(&seed, -1, 1);
    t.planar = true;
    CagCurve *graph, *line, *c, *d, *e;
    OK(cag_curve_bezier(p, NULL, (size_t)n + 1, 2, &graph, &err));
    OK(cag_curve_line(cag_vec3(-1.5, 0, 0), cag_vec3(2, 0, 0), 2, &line, &err));
    OK(cag_curve_transform(graph, &t, &c, &err));
    OK(cag_curve_transform(line, &t, &d, &err));
    OK(cag_curve_reparametrize(c, start, start + range, &e, &err));
    const CagVec3 zero = cag_vec3(t.m[0][3], t.m[1][3], 0);
    CagMeeting *m;
    size_t count;
    OK(cag_curve_intersect(e, d, &m, &count, &err));
    assert_int_equal(count, 1);
    assert_int_equal(m[0].multiplicity, n);
    near_vec(m[0].point, zero, 1e-5 * size);
    NEAR((m[0].t - start) / range, 0.5, 1e-5);
    NEAR(m[0].t2, 1.5 / 3.5, 1e-5);
    free(m);
    OK(cag_curve_intersect(d, e, &m, &count, &err));
    assert_int_equal(count, 1);
    assert_int_equal(m[0].multiplicity, n);
    free(m);
    CagPlane plane;
    OK(cag_plane(zero, cag_vec3(-sin(angle), cos(angle), 0), &plane, &err));
    OK(cag_curve_intersect_plane(e, &plane, &m, &count, &err));
    assert_int_equal(count, 1);
    assert_int_equal(m[0].multiplicity, n);
    near_vec(m[0].point, zero, 1e-5 * size);
    free(m);
    cag_curve_release(graph);
    cag_curve_release(line);
    cag_curve_release(c);
    cag_curve_release(d);
    cag_curve_release(e);
  }
}

// Closed curves that touch a line, and each other, at their seams.
static void touches_at_a_seam_are_one(void **state) {
  (void)state;
  uint64_t seed = 95;
  for (int i = 0; i < 40; i++) {
    const double a = uniform(&seed, 0.5, 3), b = uniform(&seed, 0.5, 3), x = uniform(&seed, -5, 5);
    const bool spline = i % 2, second = i / 2 % 2;
    CagTransform frame = cag_translate(cag_vec3(x, 0, 0));
    frame.planar = true;
    CagCurve *c, *line;
    OK(cag_curve_arc(a, b, 0, 2 * M_PI, &frame, &c, &err)); // begins at [x + a, 0]
    if (spline) c = as_spline(c);
    OK(cag_curve_line(cag_vec3(x + a, -2, 0), cag_vec3(x + a, 3, 0), 2, &line, &err));
    const double start = c->start, at_line = 0.4;
    CagMeeting *m;
    assert_int_equal(second ? meet(line, c, &m) : meet(c, line, &m), 1);
    assert_int_equal(m[0].multiplicity, 2);
    NEAR(second ? m[0].t : m[0].t2, at_line, 1e-7);
    const double t = second ? m[0].t2 : m[0].t;
    assert_true(fabs(t - start) < 1e-6 || fabs(t - start - 2 * M_PI) < 1e-6 || spline);
    near_vec(m[0].point, cag_vec3(x + a, 0, 0), 1e-7);
    free(m);
    CagPlane plane;
    size_t n;
    OK(cag_curve_arc(a, b, 0, 2 * M_PI, &frame, &c, &err));
    OK(cag_plane(cag_vec3(x + a, 0, 0), cag_vec3(1, 0, 0), &plane, &err));
    OK(cag_curve_intersect_plane(c, &plane, &m, &n, &err));
    assert_int_equal(n, 1);
    assert_int_equal(m[0].multiplicity, 2);
    near_vec(m[0].point, cag_vec3(x + a, 0, 0), 1e-7);
    free(m);
    // The line across the seam meets the curve at two points.
    OK(cag_plane(cag_vec3(x, 0, 0), cag_vec3(0, 1, 0), &plane, &err));
    OK(cag_curve_intersect_plane(c, &plane, &m, &n, &err));
    assert_int_equal(n, 2);
    assert_true(m[0].t == 0 && m[0].multiplicity == 1 && m[1].multiplicity == 1);
    NEAR(m[1].t, M_PI, 1e-12);
    free(m);
    cag_curve_release(c);
  }
}

// Twice the area of a triangle with integer coordinates, which is exact.
static double turn(CagVec3 a, CagVec3 b, CagVec3 c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Counts the crossings of two polylines. Returns -1 if three points are collinear.
static int count_crossings(const CagVec3 *p, size_t np, const CagVec3 *q, size_t nq) {
  int count = 0;
  for (size_t i = 0; i + 1 < np; i++)
    for (size_t k = 0; k + 1 < nq; k++) {
      const double a = turn(p[i], p[i + 1], q[k]), b = turn(p[i], p[i + 1], q[k + 1]),
                   c = turn(q[k], q[k + 1], p[i]), d = turn(q[k], q[k + 1], p[i + 1]);
      if (a == 0 || b == 0 || c == 0 || d == 0) return -1;
      count += (a < 0) != (b < 0) && (c < 0) != (d < 0);
    }
  return count;
}

// A polyline as a rational B-spline of degree 1 with very different weights and uneven knots.
static CagCurve *rational_polyline(const CagVec3 *p, size_t n, uint64_t *seed) {
  double weights[8], knots[10];
  knots[0] = 0;
  for (size_t i = 0; i < n; i++) {
    weights[i] = pow(10, uniform(seed, -2, 2));
    knots[i + 1] = i ? knots[i] + pow(10, uniform(seed, -2, 0)) : 0;
  }
  knots[n + 1] = knots[n];
  CagCurve *c;
  OK(cag_curve_nurbs(p, weights, n, 1, knots, 2, &c, &err));
  return c;
}

static void polylines_with_any_weights_cross_as_segments_do(void **state) {
  (void)state;
  uint64_t seed = 3;
  for (int i = 0; i < 400; i++) {
    CagVec3 p[2][6];
    for (int k = 0; k < 12; k++)
      p[k / 6][k % 6] = cag_vec3(floor(uniform(&seed, -20, 21)), floor(uniform(&seed, -20, 21)), 0);
    const int wanted = count_crossings(p[0], 6, p[1], 6);
    if (wanted < 0) continue;
    CagMeeting *m;
    const size_t n = meet(rational_polyline(p[0], 6, &seed), rational_polyline(p[1], 6, &seed), &m);
    assert_int_equal(n, wanted);
    for (size_t f = 0; f < n; f++) assert_int_equal(m[f].multiplicity, 1);
    free(m);
  }
}

// Multiplying the weights by powers of a number changes only the parametrization of a Bezier curve.
static void rational_beziers_meet_alike_however_they_are_run_through(void **state) {
  (void)state;
  uint64_t seed = 4;
  for (int i = 0; i < 300; i++) {
    CagCurve *c[2][2];
    for (int k = 0; k < 2; k++) {
      CagVec3 p[4];
      double weights[4], uneven[4], factor = pow(10, uniform(&seed, -2, 2));
      for (int j = 0; j < 4; j++) {
        p[j] = cag_vec3(uniform(&seed, -5, 5), uniform(&seed, -5, 5), 0);
        weights[j] = uniform(&seed, 0.5, 2);
        uneven[j] = weights[j] * pow(factor, j);
      }
      OK(cag_curve_bezier(p, weights, 4, 2, &c[k][0], &err));
      OK(cag_curve_bezier(p, uneven, 4, 2, &c[k][1], &err));
    }
    CagMeeting *m[2];
    const size_t n = meet(c[0][0], c[1][0], &m[0]);
    assert_int_equal(meet(c[0][1], c[1][1], &m[1]), n);
    for (size_t f = 0; f < n; f++) near_vec(m[0][f].point, m[1][f].point, 1e-7);
    free(m[0]);
    free(m[1]);
  }
}

// With very different weights, the first curve turns back near its fourth control point and crosses
// the second one twice there. The expected number of intersections is from polygons with 4000
// sides.
static void curves_that_turn_back_meet_on_both_ways(void **state) {
  (void)state;
  const CagVec3 p[5] = {{4.204739901153635, 1.8536574175198615, 0},
                        {4.140281188460394, 2.616908406284293, 0},
                        {0.701602378821188, 2.1918740908627976, 0},
                        {3.6169920467331025, -3.310261711462136, 0},
                        {1.5190287435722185, 3.618894421587701, 0}};
  const double wp[5] = {0.05, 0.5, 0.5, 5, 0.05};
  const CagVec3 q[3] = {{4.090266637352903, 0.9907178120087146, 0},
                        {-4.372583054025826, -2.6139898002163466, 0},
                        {4.868434286803538, -2.712808698050689, 0}};
  const double wq[3] = {0.5, 5, 0.05};
  for (int swapped = 0; swapped < 2; swapped++) {
    CagMeeting *m;
    CagCurve *a, *b;
    OK(cag_curve_bezier(p, wp, 5, 2, &a, &err));
    OK(cag_curve_bezier(q, wq, 3, 2, &b, &err));
    assert_int_equal(swapped ? meet(b, a, &m) : meet(a, b, &m), 4);
    free(m);
  }
}

// Arcs of two circles in one plane of space. The expected points are constructed from one point of
// the first circle: points at the distance of the second radius from the second center.
static void arcs_meet_where_both_circles_pass(void **state) {
  (void)state;
  uint64_t seed = 5;
  for (int i = 0; i < 2000; i++) {
    CagTransform plane = cag_rpy(uniform(&seed, -3, 3), 0.4, 1.1), frame;
    // Every third pair nearly coincides.
    const double near = i % 3 ? 1 : 1e-6, r = uniform(&seed, 1, 5),
                 angle = uniform(&seed, 0, 2 * M_PI), other = i % 3 ? uniform(&seed, 1, 5) : r,
                 d = near * uniform(&seed, 0.5, 9);
    const double from[2] = {uniform(&seed, 0, 6), uniform(&seed, 0, 6)};
    const double sweep[2] = {uniform(&seed, 0.5, 6.2), i % 3 ? 2 * M_PI : 6.1};
    const double gap = fmin(fabs(d - (r + other)), fabs(d - fabs(r - other)));
    if (gap < 1e-3 * near) continue;
    CagCurve *c[2];
    CagTransform shift = cag_translate(cag_vec3(d * cos(angle), d * sin(angle), 0));
    OK(cag_curve_arc(r, r, from[0], from[0] + sweep[0], &plane, &c[0], &err));
    frame = cag_transform_multiply(&plane, &shift);
    OK(cag_curve_arc(other, other, from[1], from[1] + sweep[1], &frame, &c[1], &err));
    // The law of cosines in the triangle of the two centers and a common point.
    const double cosine = (d * d + r * r - other * other) / (2 * d * r);
    size_t wanted = 0;
    bool unsure = false;
    for (int side = -1; side <= 1 && fabs(cosine) < 1; side += 2) {
      const double at = angle + side * acos(cosine), x = r * cos(at) - d * cos(angle),
                   y = r * sin(at) - d * sin(angle), turn[2] = {at, atan2(y, x)};
      bool on = true;
      for (int k = 0; k < 2; k++) {
        const double past = turn[k] - from[k] - 2 * M_PI * floor((turn[k] - from[k]) / (2 * M_PI));
        on = on && past <= sweep[k];
        unsure = unsure || (fabs(past - sweep[k]) < 1e-3 && sweep[k] < 6.28);
        unsure = unsure || ((past < 1e-3 || past > 6.28) && sweep[k] < 6.28);
      }
      wanted += on;
    }
    // Arcs that nearly coincide without crossing count as overlapping.
    if (unsure || (i % 3 == 0 && wanted < 2)) {
      cag_curve_release(c[0]);
      cag_curve_release(c[1]);
      continue;
    }
    CagMeeting *m;
    const size_t n = meet(cag_curve_retain(c[0]), cag_curve_retain(c[1]), &m);
    assert_int_equal(n, wanted);
    for (size_t f = 0; f < n; f++) {
      CagVec3 p[2];
      OK(cag_curve_point(c[0], m[f].t, &p[0], &err));
      OK(cag_curve_point(c[1], m[f].t2, &p[1], &err));
      near_vec(m[f].point, p[0], 1e-13 / near);
      near_vec(m[f].point, p[1], 1e-13 / near);
      assert_int_equal(m[f].multiplicity, 1);
      if (f) assert_true(m[f - 1].t < m[f].t);
    }
    free(m);
    cag_curve_release(c[0]);
    cag_curve_release(c[1]);
  }
}

// --- Random curves ---

static CagVec3 random_location(uint64_t *seed, double size, bool space) {
  CagVec3 p = {0, 0, 0};
  p.x = uniform(seed, -size, size);
  p.y = uniform(seed, -size, size);
  if (space) p.z = uniform(seed, -size, size);
  return p;
}

enum { KINDS = 8 };
static CagCurve *random_curve(uint64_t *seed, int kind, bool space) {
  CagVec3 p[7];
  double w[7], knots[11];
  const int dimension = space ? 3 : 2;
  CagCurve *c = NULL, *parts[2];
  for (int i = 0; i < 7; i++) {
    p[i] = random_location(seed, 3, space);
    w[i] = uniform(seed, 0.5, 2);
  }
  const double turn = uniform(seed, -3, 3), a = uniform(seed, 0.5, 3), b = uniform(seed, 0.5, 3);
  CagTransform f = cag_rpy(space ? a : 0, space ? b : 0, turn), shift = cag_translate(p[0]);
  f = cag_transform_multiply(&shift, &f);
  f.planar = !space;
  switch (kind) {
  case 0: OK(cag_curve_bezier(p, NULL, 4, dimension, &c, &err)); break;
  case 1: OK(cag_curve_bezier(p, w, 4, dimension, &c, &err)); break;
  case 2:
    for (int i = 0; i < 11; i++) knots[i] = i < 4 ? 0 : i < 7 ? i - 3 + 0.3 * w[i - 4] : 5;
    OK(cag_curve_nurbs(p, w, 7, 3, knots, dimension, &c, &err));
    break;
  case 3: OK(cag_curve_nurbs_closed(p, NULL, 6, 3, dimension, &c, &err)); break;
  case 4: OK(cag_curve_polyline(p, 5, false, dimension, &c, &err)); break;
  case 5: OK(cag_curve_arc(a, b, turn, turn + 4, &f, &c, &err)); break;
  case 6: OK(cag_curve_arc(a, b, turn, turn + 2 * M_PI, &f, &c, &err)); break;
  default:
    OK(cag_curve_bezier(p, NULL, 3, dimension, &parts[0], &err));
    OK(cag_curve_line(p[2], p[3], dimension, &parts[1], &err));
    OK(cag_curve_join(parts, 2, &c, &err));
    cag_curve_release(parts[0]);
    cag_curve_release(parts[1]);
  }
  return c;
}

static CagVec3 curve_point(const CagCurve *c, double t) {
  CagVec3 p;
  OK(cag_curve_point(c, fmin(c->end, fmax(c->start, t)), &p, &err));
  return p;
}

// A plane meets a curve where the signed distance of dense samples changes sign.
static void random_planes_meet_where_signs_change(void **state) {
  (void)state;
  uint64_t seed = 91;
  for (int i = 0; i < 160; i++) {
    CagCurve *c = random_curve(&seed, i % KINDS, i % 3 != 0);
    CagPlane plane;
    const CagVec3 normal = random_location(&seed, 1, true);
    OK(cag_plane(random_location(&seed, 1, true), normal, &plane, &err));
    CagMeeting *m;
    size_t n, wanted = 0;
    OK(cag_curve_intersect_plane(c, &plane, &m, &n, &err));
    enum { STEPS = 3000 };
    double last = cag_dot(cag_sub(curve_point(c, c->start), plane.point), plane.normal);
    for (int k = 1; k <= STEPS; k++) {
      const double t = c->start + (c->end - c->start) * k / STEPS;
      const double here = cag_dot(cag_sub(curve_point(c, t), plane.point), plane.normal);
      if (last * here < 0) {
        assert_true(wanted < n);
        // The intersection is within the same step.
        assert_true(fabs(m[wanted].t - t) <= 1.001 * (c->end - c->start) / STEPS);
        wanted++;
      }
      last = here;
    }
    assert_int_equal(n, wanted);
    for (size_t k = 0; k < n; k++) {
      near_vec(curve_point(c, m[k].t), m[k].point, 1e-12);
      NEAR(cag_dot(cag_sub(m[k].point, plane.point), plane.normal), 0, 1e-10);
      assert_true(m[k].multiplicity == 1 && m[k].t2 == 0);
    }
    free(m);
    cag_curve_release(c);
  }
}

// Plane curves meet where dense polylines do.
static void random_curves_meet_where_polylines_cross(void **state) {
  (void)state;
  uint64_t seed = 92;
  enum { STEPS = 300 };
  static CagVec3 p[2][STEPS + 1];
  size_t all = 0;
  for (int i = 0; i < 128; i++) {
    CagCurve *c[2] = {random_curve(&seed, i % KINDS, false), NULL};
    c[1] = random_curve(&seed, i / KINDS % KINDS, false);
    for (int k = 0; k < 2; k++)
      for (int j = 0; j <= STEPS; j++)
        p[k][j] = curve_point(c[k], c[k]->start + (c[k]->end - c[k]->start) * j / STEPS);
    CagMeeting *m;
    size_t n, wanted = 0;
    OK(cag_curve_intersect(c[0], c[1], &m, &n, &err));
    for (int j = 0; j < STEPS; j++)
      for (int k = 0; k < STEPS; k++) {
        const CagVec3 u = cag_sub(p[0][j + 1], p[0][j]), v = cag_sub(p[1][k + 1], p[1][k]);
        const CagVec3 d = cag_sub(p[1][k], p[0][j]);
        if (fabs(d.x) + fabs(d.y) > 1.5) continue;
        const double det = u.x * v.y - u.y * v.x, s = (d.x * v.y - d.y * v.x) / det;
        const double t = (d.x * u.y - d.y * u.x) / det;
        wanted += s >= 0 && s < 1 && t >= 0 && t < 1;
      }
    assert_int_equal(n, wanted);
    all += n;
    for (size_t k = 0; k < n; k++) {
      near_vec(curve_point(c[0], m[k].t), m[k].point, 1e-9);
      near_vec(curve_point(c[1], m[k].t2), m[k].point, 1e-9);
      assert_true(m[k].multiplicity == 1 && (k == 0 || m[k - 1].t <= m[k].t));
    }
    // Exchanged curves meet at the same points.
    CagMeeting *other;
    size_t again;
    OK(cag_curve_intersect(c[1], c[0], &other, &again, &err));
    assert_int_equal(again, n);
    for (size_t k = 0; k < n; k++) {
      bool found = false;
      for (size_t j = 0; j < n; j++)
        found = found || (fabs(other[j].t2 - m[k].t) < 1e-7 && fabs(other[j].t - m[k].t2) < 1e-7);
      assert_true(found);
    }
    free(other);
    free(m);
    cag_curve_release(c[0]);
    cag_curve_release(c[1]);
  }
  assert_true(all > 150);
}

// Space curves, one of which is translated to pass through a point of the other, meet there.
static void curves_of_space_meet_where_they_were_put(void **state) {
  (void)state;
  uint64_t seed = 93;
  for (int i = 0; i < 2 * KINDS * KINDS; i++) {
    CagCurve *c[2] = {random_curve(&seed, i % KINDS, true), NULL}, *moved;
    c[1] = random_curve(&seed, i / KINDS % KINDS, true);
    double t[2];
    for (int k = 0; k < 2; k++)
      t[k] = c[k]->start + (c[k]->end - c[k]->start) * uniform(&seed, 0.05, 0.95);
    const CagVec3 p = curve_point(c[0], t[0]);
    const CagTransform shift = cag_translate(cag_sub(p, curve_point(c[1], t[1])));
    OK(cag_curve_transform(c[1], &shift, &moved, &err));
    CagMeeting *m;
    size_t n;
    OK(cag_curve_intersect(c[0], moved, &m, &n, &err));
    assert_int_equal(n, 1);
    near_vec(m[0].point, p, 1e-9);
    NEAR(m[0].t, t[0], 1e-7);
    NEAR(m[0].t2, t[1], 1e-7);
    assert_int_equal(m[0].multiplicity, 1);
    free(m);
    // At a distance of 1e-6, they do not meet.
    CagVec3 u, v;
    OK(cag_curve_tangent(c[0], t[0], CAG_SIDE_RIGHT, &u, &err));
    OK(cag_curve_tangent(c[1], t[1], CAG_SIDE_RIGHT, &v, &err));
    const CagTransform off = cag_translate(cag_scaled(cag_unit(cag_cross(u, v)), 1e-6));
    CagCurve *apart;
    OK(cag_curve_transform(moved, &off, &apart, &err));
    OK(cag_curve_intersect(c[0], apart, &m, &n, &err));
    assert_int_equal(n, 0);
    free(m);
    cag_curve_release(apart);
    cag_curve_release(moved);
    cag_curve_release(c[0]);
    cag_curve_release(c[1]);
  }
}

// A part of a curve overlaps with it. Parts that have only an end in common meet there.
static void parts_of_a_curve_overlap_or_meet_at_their_ends(void **state) {
  (void)state;
  uint64_t seed = 94;
  for (int i = 0; i < 2 * KINDS; i++) {
    CagCurve *c = random_curve(&seed, i % KINDS, i >= KINDS), *part[3];
    static const double shares[4] = {0.1, 0.4, 0.7, 0.9};
    double t[4];
    for (int k = 0; k < 4; k++) t[k] = c->start + (c->end - c->start) * shares[k];
    OK(cag_curve_trim(c, t[0], t[2], &part[0], &err));
    OK(cag_curve_trim(c, t[1], t[3], &part[1], &err));
    OK(cag_curve_trim(c, t[2], t[3], &part[2], &err));
    CagMeeting *m;
    size_t n;
    // The proof takes long, so three kinds must suffice.
    if (i == 0 || i == 4 || i == 5)
      FAILS(cag_curve_intersect(part[0], part[1], &m, &n, &err), "overlap");
    if (i == 0) FAILS(cag_curve_intersect(c, part[2], &m, &n, &err), "overlap");
    if (i >= KINDS) { // in space, nothing else meets
      OK(cag_curve_intersect(part[0], part[2], &m, &n, &err));
      assert_int_equal(n, 1);
      near_vec(m[0].point, curve_point(c, t[2]), 1e-8);
      free(m);
    }
    for (int k = 0; k < 3; k++) cag_curve_release(part[k]);
    cag_curve_release(c);
  }
}

// The graph of x^2 + 3 x^3 over [from, to], in either direction, in the plane or in space.
static CagCurve *graph_of_a_cubic(double from, double to, bool back) {
  // Blossoms: the mean for x, the mean of pairwise products for x^2, and the product for x^3.
  CagVec3 p[4];
  for (int i = 0; i < 4; i++) {
    const double u[3] = {i > 2 ? to : from, i > 1 ? to : from, i > 0 ? to : from};
    p[back ? 3 - i : i] =
        cag_vec3((u[0] + u[1] + u[2]) / 3,
                 (u[0] * u[1] + u[1] * u[2] + u[2] * u[0]) / 3 + 3 * u[0] * u[1] * u[2], 0);
  }
  CagCurve *c;
  OK(cag_curve_bezier(p, NULL, 4, 2, &c, &err));
  return c;
}

static void touches_just_outside_of_an_end_are_found_at_the_end(void **state) {
  (void)state;
  CagPlane floor;
  CagCurve *line;
  CagMeeting *m;
  size_t n;
  OK(cag_plane(cag_vec3(0, 0, 0), cag_vec3(0, 1, 0), &floor, &err));
  // The vertex is 1e-6 before or inside the domain, or at its end.
  for (int i = 0; i < 12; i++) {
    const double off = (i % 3 - 1) * 1e-6;
    const bool back = i / 3 % 2, left = i / 6;
    CagCurve *c = left ? graph_of_a_cubic(-0.3, off, back) : graph_of_a_cubic(off, 1, back);
    const double end = back != left ? 1 : 0;
    OK(cag_curve_intersect_plane(c, &floor, &m, &n, &err));
    assert_int_equal(n, 1);
    NEAR(m[0].t, end, 1e-4);
    near_vec(m[0].point, curve_point(c, m[0].t), 1e-14);
    near_vec(m[0].point, cag_vec3(0, 0, 0), 1e-4);
    free(m);
    for (int turned = 0; turned < 2; turned++) {
      OK(cag_curve_line(cag_vec3(turned ? 2 : -2, 0, 0), cag_vec3(turned ? -1 : 1, 0, 0), 2, &line,
                        &err));
      OK(cag_curve_intersect(turned ? c : line, turned ? line : c, &m, &n, &err));
      assert_int_equal(n, 1);
      NEAR(turned ? m[0].t : m[0].t2, end, 1e-4);
      NEAR(turned ? m[0].t2 : m[0].t, 2.0 / 3, 1e-4);
      free(m);
      cag_curve_release(line);
    }
    cag_curve_release(c);
  }
}

static void shallow_crossings_are_where_the_lines_cross(void **state) {
  (void)state;
  uint64_t seed = 93;
  for (int i = 0; i < 60; i++) {
    CagPlane floor;
    CagCurve *line, *level;
    CagMeeting *m;
    size_t n;
    const double slope = (i % 2 ? -1 : 1) * pow(10, uniform(&seed, -5.7, -2)),
                 at = uniform(&seed, 0.1, 0.9), length = 10, y = uniform(&seed, -3, 3);
    OK(cag_plane(cag_vec3(0, y, 0), cag_vec3(0, i % 4 < 2 ? 1 : -1, 0), &floor, &err));
    OK(cag_curve_line(cag_vec3(0, y - at * length * slope, 0),
                      cag_vec3(length, y + (1 - at) * length * slope, 0), 2, &line, &err));
    OK(cag_curve_intersect_plane(line, &floor, &m, &n, &err));
    assert_int_equal(n, 1);
    assert_int_equal(m[0].multiplicity, 1);
    NEAR(m[0].t, at, 1e-15 / fabs(slope));
    free(m);
    OK(cag_curve_line(cag_vec3(-1, y, 0), cag_vec3(length + 1, y, 0), 2, &level, &err));
    OK(cag_curve_intersect(line, level, &m, &n, &err));
    assert_int_equal(n, 1);
    assert_int_equal(m[0].multiplicity, 1);
    NEAR(m[0].t, at, 1e-15 / fabs(slope));
    NEAR(m[0].t2, (1 + at * length) / (length + 2), 1e-15 / fabs(slope));
    free(m);
    cag_curve_release(level);
    cag_curve_release(line);
  }
}

static void curves_that_lie_in_a_plane_or_run_along_each_other_are_refused(void **state) {
  (void)state;
  CagPlane floor;
  CagMeeting *m;
  size_t n;
  OK(cag_plane(cag_vec3(0, 0, 1), cag_vec3(0, 0, 1), &floor, &err));
  // A piece of a polyline of length 2e-3 relative to a domain of 1, or a tenth of that, lies in the
  // plane.
  for (int i = 0; i < 2; i++) {
    const double reach = i ? 2e-4 : 2e-3;
    const CagVec3 p[4] = {{0, 0, 0}, {1, 0, 1}, {1 + 3 * reach, 0, 1}, {2, 0, 2}};
    const double t[4] = {0, 0.5, 0.5 + reach, 1};
    CagCurve *c;
    OK(cag_curve_polyline_over(p, t, 4, 3, &c, &err));
    if (i == 0) FAILS(cag_curve_intersect_plane(c, &floor, &m, &n, &err), "overlap");
    cag_curve_release(c);
  }
  // An arc in the plane, and one that leaves the plane.
  for (int i = 0; i < 2; i++) {
    CagTransform frame = cag_translate(cag_vec3(3, 2, 1));
    if (i) frame.m[2][0] = 1e-3;
    CagCurve *c;
    OK(cag_curve_arc(2, 2, 0.5, 5, &frame, &c, &err));
    if (i == 0) {
      FAILS(cag_curve_intersect_plane(c, &floor, &m, &n, &err), "overlap");
    } else {
      OK(cag_curve_intersect_plane(c, &floor, &m, &n, &err));
      assert_int_equal(n, 2); // cos t = 0
      NEAR(m[0].t, M_PI / 2, 1e-9);
      NEAR(m[1].t, 3 * M_PI / 2, 1e-9);
      free(m);
    }
    cag_curve_release(c);
  }
}

// --- Curves defined by functions ---

// The graph of sin(rate t), or of 1 - 2 exp(-((t - middle) / width)^2) if there is a width.
typedef struct Graph {
  double rate, middle, width;
} Graph;

static CagStatus graph_eval(void *context, double t, int order, CagVec3 *out, CagError *e) {
  (void)e;
  const Graph *g = context;
  double dip[CAG_MAX_DERIVATIVE + 1] = {0};
  const double x = t - g->middle;
  for (int k = 0; k <= order && g->width > 0; k++) {
    // (exp(-x^2))' = -2 x exp(-x^2), and the Leibniz rule.
    dip[k] =
        k == 0 ? -2 * exp(-x * x / (g->width * g->width))
               : -2 / (g->width * g->width) * (x * dip[k - 1] + (k > 1 ? (k - 1) * dip[k - 2] : 0));
  }
  for (int k = 0; k <= order; k++)
    out[k] = cag_vec3(
        k == 0 ? t : k == 1,
        g->width > 0 ? (k == 0) + dip[k] : pow(g->rate, k) * sin(g->rate * t + k * M_PI / 2), 0);
  return CAG_OK;
}

static CagCurve *graph_of(Graph *g) {
  const CagCurveFunction f = {.eval = graph_eval, .release = NULL, .context = g};
  CagCurve *c;
  OK(cag_curve_function(&f, 2, 0, 1, false, &c, &err));
  return c;
}

static void waves_meet_their_axis_at_their_zeros(void **state) {
  (void)state;
  CagPlane floor;
  CagCurve *axis;
  OK(cag_plane(cag_vec3(0, 0, 0), cag_vec3(0, 1, 0), &floor, &err));
  OK(cag_curve_line(cag_vec3(0, 0, 0), cag_vec3(1, 0, 0), 2, &axis, &err));
  for (int half_waves = 1; half_waves <= 40; half_waves++) {
    Graph g = {.rate = half_waves * M_PI};
    CagCurve *c = graph_of(&g);
    for (int other = 0; other < 2; other++) {
      CagMeeting *m;
      size_t n;
      if (other) OK(cag_curve_intersect(axis, c, &m, &n, &err));
      else OK(cag_curve_intersect_plane(c, &floor, &m, &n, &err));
      assert_int_equal(n, half_waves + 1);
      for (size_t i = 0; i < n; i++) {
        NEAR(m[i].t, (double)i / half_waves, 1e-11);
        assert_int_equal(m[i].multiplicity, 1);
      }
      free(m);
    }
    cag_curve_release(c);
  }
  cag_curve_release(axis);
}

static void dips_of_a_formula_are_found_wherever_they_are(void **state) {
  (void)state;
  uint64_t seed = 117;
  CagPlane floor;
  CagCurve *axis;
  OK(cag_plane(cag_vec3(0, 0, 0), cag_vec3(0, 1, 0), &floor, &err));
  OK(cag_curve_line(cag_vec3(0, 0, 0), cag_vec3(1, 0, 0), 2, &axis, &err));
  for (int i = 0; i < 200; i++) {
    Graph g = {.middle = uniform(&seed, 0.1, 0.9)};
    g.width = uniform(&seed, 0.03, 0.1);
    CagCurve *c = graph_of(&g);
    for (int other = 0; other < 2; other++) {
      CagMeeting *m;
      size_t n;
      if (other) OK(cag_curve_intersect(axis, c, &m, &n, &err));
      else OK(cag_curve_intersect_plane(c, &floor, &m, &n, &err));
      assert_int_equal(n, 2);
      for (int k = 0; k < 2; k++)
        NEAR(m[k].t, g.middle + (k ? 1 : -1) * g.width * sqrt(log(2)), 1e-11);
      free(m);
    }
    cag_curve_release(c);
  }
  cag_curve_release(axis);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(random_planes_meet_where_signs_change),
      cmocka_unit_test(random_curves_meet_where_polylines_cross),
      cmocka_unit_test(curves_of_space_meet_where_they_were_put),
      cmocka_unit_test(parts_of_a_curve_overlap_or_meet_at_their_ends),
      cmocka_unit_test(chebyshev_graphs_meet_their_mirror_images_n_squared_times),
      cmocka_unit_test(a_line_meets_a_chebyshev_graph_n_times_or_touches_it),
      cmocka_unit_test(rational_circles_meet_like_circles),
      cmocka_unit_test(arcs_meet_where_both_circles_pass),
      cmocka_unit_test(circles_that_touch_meet_once),
      cmocka_unit_test(tangents_of_a_circle_meet_it_once),
      cmocka_unit_test(the_order_of_contact_is_told),
      cmocka_unit_test(orders_of_contact_do_not_depend_on_scale_place_and_domain),
      cmocka_unit_test(touches_at_a_seam_are_one),
      cmocka_unit_test(polylines_with_any_weights_cross_as_segments_do),
      cmocka_unit_test(rational_beziers_meet_alike_however_they_are_run_through),
      cmocka_unit_test(curves_that_turn_back_meet_on_both_ways),
      cmocka_unit_test(touches_just_outside_of_an_end_are_found_at_the_end),
      cmocka_unit_test(shallow_crossings_are_where_the_lines_cross),
      cmocka_unit_test(curves_that_lie_in_a_plane_or_run_along_each_other_are_refused),
      cmocka_unit_test(waves_meet_their_axis_at_their_zeros),
      cmocka_unit_test(dips_of_a_formula_are_found_wherever_they_are),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
