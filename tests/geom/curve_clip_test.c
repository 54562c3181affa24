// Clipping of Bezier pieces to the part that may be close to another one.

#include "geom/curve/intersect_clip.h"
#include "geom/curve/nurbs.h"
#include "tests/geom/curve_random.h"

// Kinds whose smooth pieces have control points.
static const Kind kinds[] = {LINE,   POLYLINE, RING,     BEZIER,   RATIONAL,
                             SPLINE, NURBS,    PERIODIC, COMPOSITE};
enum { KIND_COUNT = sizeof kinds / sizeof *kinds };

// A Bezier curve of degree 1 to 5 in the plane.
static CagCurve *flat_curve(bool rational) {
  CagVec3 p[6];
  double w[6];
  const size_t n = 2 + (size_t)uniform(0, 5);
  for (size_t i = 0; i < n; i++) {
    p[i] = random_point(4);
    p[i].z = 0;
    w[i] = uniform(0.4, 2.5);
  }
  CagCurve *c;
  OK(cag_curve_bezier(p, rational ? w : NULL, n, 2, &c, &err));
  return c;
}

static void smooth_part(const CagCurve *c, double *from, double *to) {
  double *cuts;
  size_t n;
  OK(cag_curve_cuts(c, &cuts, &n, &err));
  const size_t i = (size_t)uniform(0, (double)(n - 1));
  const double range = cuts[i + 1] - cuts[i], low = uniform(-0.3, 0.5), high = uniform(0.5, 1.3);
  *from = low > 0 ? cuts[i] + low * range : cuts[i];
  *to = high < 1 ? cuts[i] + high * range : cuts[i + 1];
  free(cuts);
}

// Parameters at which the curves are within the slack are kept.
static void what_is_near_enough_stays(void **state) {
  (void)state;
  seed = 511;
  int narrower = 0, apart = 0;
  for (int round = 0; round < 4000; round++) {
    const bool flat = round % 2;
    CagCurve *a = flat ? flat_curve(round / 2 % 2) : random_curve(kinds[round / 2 % KIND_COUNT]);
    CagCurve *b =
        flat ? flat_curve(round / 4 % 2) : random_curve(kinds[round / 2 / KIND_COUNT % KIND_COUNT]);
    double a0, a1, b0, b1;
    smooth_part(a, &a0, &a1);
    smooth_part(b, &b0, &b1);
    for (int k = 0; k < 4; k++) {
      const double t = uniform(a0, a1), u = uniform(b0, b1);
      const double gap = cag_norm(cag_sub(at(a, t), at(b, u)));
      double from = b0, to = b1;
      assert_true(cag_curve_clip_parameters(a, a0, a1, b, gap * (1 + 1e-12), &from, &to));
      assert_true(b0 <= from && from <= u && u <= to && to <= b1);
      narrower += to - from < 0.9 * (b1 - b0);
    }
    double from = b0, to = b1;
    apart += !cag_curve_clip_parameters(a, a0, a1, b, 0, &from, &to);
    cag_curve_release(a);
    cag_curve_release(b);
  }
  assert_true(narrower > 1000 && apart > 1000);
}

// The control points of a part of a Bezier curve.
static int part_points(const CagCurve *c, double from, double to, double points[4 * 6]) {
  CagCurve *part, *exact;
  OK(cag_curve_trim(c, from, to, &part, &err));
  OK(cag_curve_to_nurbs(part, &exact, &err));
  const CagNurbs *n = cag_nurbs_data(exact);
  memcpy(points, n->homogeneous, sizeof(double) * 4 * n->count);
  const int degree = n->degree;
  cag_curve_release(part);
  cag_curve_release(exact);
  return degree;
}

// The lower side of the hull of the points (i / n, e[i]) at x.
static double lower_side(const double *e, int n, double x) {
  double least = INFINITY;
  for (int i = 0; i <= n; i++)
    for (int k = i; k <= n; k++) {
      const double from = (double)i / n, to = (double)k / n;
      if (from > x || to < x) continue;
      const double y = i == k ? e[i] : e[i] + (e[k] - e[i]) * (x - from) / (to - from);
      least = fmin(least, y);
    }
  return least;
}

// In the plane, the remaining part is where the hull of the distances from both sides of the strip
// along the chord of a includes 0.
static void what_is_left_is_where_the_hull_reaches_the_strip(void **state) {
  (void)state;
  seed = 512;
  int cut[4] = {0}, apart = 0;
  for (int round = 0; round < 600; round++) {
    CagCurve *a = flat_curve(round % 2), *b = flat_curve(round / 2 % 2);
    double a0, a1, b0, b1, p[24], q[24], low = 0, high = 1;
    smooth_part(a, &a0, &a1);
    smooth_part(b, &b0, &b1);
    const double slack = round % 3 ? uniform(0, 1) : 0;
    const int m = part_points(a, a0, a1, p), n = part_points(b, b0, b1, q);
    const CagVec3 start = at(a, a0), chord = cag_unit(cag_sub(at(a, a1), start));
    double least = INFINITY, most = -INFINITY;
    for (int i = 0; i <= m; i++) {
      const CagVec3 d =
          cag_sub(cag_scaled(cag_vec3(p[4 * i], p[4 * i + 1], 0), 1 / p[4 * i + 3]), start);
      least = fmin(least, cag_cross(chord, d).z - slack);
      most = fmax(most, cag_cross(chord, d).z + slack);
    }
    bool left = true;
    for (int side = 0; left && side < 2; side++) {
      double e[6];
      for (int i = 0; i <= n; i++) {
        const CagVec3 h = {q[4 * i], q[4 * i + 1], 0};
        const double w = q[4 * i + 3], d = cag_cross(chord, cag_madd(h, -w, start)).z;
        e[i] = side ? least * w - d : d - most * w;
      }
      // A convex function: searches from its minimum to either end.
      double place = 0, ends[2] = {0, 1};
      for (int i = 1; i <= n; i++)
        if (e[i] < lower_side(e, n, place)) place = (double)i / n;
      left = lower_side(e, n, place) <= 0;
      for (int k = 0; left && k < 2; k++) {
        double in = place, out = k;
        if (lower_side(e, n, out) <= 0) continue;
        for (int i = 0; i < 60; i++) {
          const double middle = (in + out) / 2;
          if (lower_side(e, n, middle) <= 0) in = middle;
          else out = middle;
        }
        ends[k] = in;
      }
      low = fmax(low, ends[0]);
      high = fmin(high, ends[1]);
      left = left && low <= high;
    }
    double from = b0, to = b1;
    assert_int_equal(cag_curve_clip_parameters(a, a0, a1, b, slack, &from, &to), left);
    if (left) {
      NEAR(from, b0 + (b1 - b0) * low, 1e-10);
      NEAR(to, b0 + (b1 - b0) * high, 1e-10);
      // Ends that are not clipped stay bit for bit.
      assert_true(low > 0 || from == b0);
      assert_true(high < 1 || to == b1);
      cut[(low > 0) + 2 * (high < 1)]++;
    }
    apart += !left;
    cag_curve_release(a);
    cag_curve_release(b);
  }
  for (int i = 0; i < 4; i++) assert_true(cut[i] > 40);
  assert_true(apart > 40);
}

// A line in space is clipped to a square prism about another one, but the common point always
// remains.
static void lines_are_cut_to_a_prism(void **state) {
  (void)state;
  seed = 513;
  for (int round = 0; round < 500; round++) {
    const bool flat = round % 2;
    CagVec3 d = random_point(1), e = random_point(1), p = random_point(3);
    if (flat) d.z = e.z = p.z = 0;
    const double slack = round % 3 ? uniform(1e-4, 0.01) : 1e-13;
    const double x = uniform(0.1, 0.9), y = uniform(0.1, 0.9);
    CagCurve *a, *b;
    OK(cag_curve_line(cag_madd(p, -x, d), cag_madd(p, 1 - x, d), flat ? 2 : 3, &a, &err));
    OK(cag_curve_line(cag_madd(p, -y, e), cag_madd(p, 1 - y, e), flat ? 2 : 3, &b, &err));
    double from = 0, to = 1;
    assert_true(cag_curve_clip_parameters(a, 0, 1, b, slack, &from, &to));
    assert_true(from <= y && y <= to);
    const double wide = slack / cag_norm(cag_cross(cag_unit(d), e)); // as far as the strip
    for (int k = 0; k < 2; k++) {
      const double way = k ? to - y : y - from;
      const double most = (flat ? 1 : sqrt(2)) * wide;
      assert_true(way <= most + 1e-10 && way >= fmin(wide, k ? 1 - y : y) - 1e-10);
    }
    cag_curve_release(a);
    cag_curve_release(b);
  }
}

// Circles have no control points, the strip along a chord of length 0 has no direction, and a
// control point of weight 0 has no location.
static void what_cannot_be_clipped_stays(void **state) {
  (void)state;
  const CagTransform f = cag_transform_identity();
  const CagVec3 ring[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
  CagCurve *c[3];
  OK(cag_curve_arc(1, 1, 0, 1, &f, &c[0], &err));
  OK(cag_curve_line(cag_vec3(5, 5, 0), cag_vec3(6, 7, 0), 2, &c[1], &err));
  OK(cag_curve_bezier(ring, NULL, 4, 2, &c[2], &err));
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 2; k++) {
      const CagCurve *a = c[k ? i : (i + 1) % 3], *b = c[k ? (i + 1) % 3 : i];
      double from = 0.25, to = 0.75;
      const bool clips = a == c[1] && b == c[2];
      assert_int_equal(cag_curve_clip_parameters(a, 0, 1, b, 0, &from, &to), !clips);
      assert_true(clips || (from == 0.25 && to == 0.75));
    }
  const double weights[3] = {1, 0, 1};
  CagCurve *half, *across;
  OK(cag_curve_bezier(ring, weights, 3, 2, &half, &err));
  OK(cag_curve_line(cag_vec3(-1, 0.4, 0), cag_vec3(1, 0.6, 0), 2, &across, &err));
  for (int k = 0; k < 2; k++) {
    double from = 0, to = 1;
    assert_true(
        cag_curve_clip_parameters(k ? half : across, 0, 1, k ? across : half, 0, &from, &to));
    assert_true(from == 0 && to == 1);
  }
  cag_curve_release(half);
  cag_curve_release(across);
  for (int i = 0; i < 3; i++) cag_curve_release(c[i]);
}

// The strip along a line is closed: if another line ends on it, its end is kept.
static void ends_on_the_strip_stay(void **state) {
  (void)state;
  CagCurve *a, *b;
  OK(cag_curve_line(cag_vec3(0, 0, 0), cag_vec3(1, 0, 0), 2, &a, &err));
  for (int k = 0; k < 4; k++) {
    const double far = k < 2 ? 1 : -1;
    OK(cag_curve_line(cag_vec3(0.5, k % 2 ? far : 0, 0), cag_vec3(0.25, k % 2 ? 0 : far, 0), 2, &b,
                      &err));
    double from = 0, to = 1;
    assert_true(cag_curve_clip_parameters(a, 0, 1, b, 0, &from, &to));
    if (k % 2) assert_true(from > 1 - 1e-11 && from <= 1 && to == 1);
    else assert_true(from == 0 && to >= 0 && to < 1e-11);
    cag_curve_release(b);
  }
  cag_curve_release(a);
}

static void curves_of_the_greatest_degree_are_clipped(void **state) {
  (void)state;
  enum { N = CAG_MAX_DEGREE + 1 }; // odd
  CagVec3 p[N], q[N];
  for (int i = 0; i < N; i++) {
    p[i] = cag_vec3((double)i / (N - 1), i % 2, 0);
    q[i] = cag_vec3(0.5, 4.0 * i / (N - 1) - 2, 0);
  }
  CagCurve *a, *b;
  OK(cag_curve_bezier(p, NULL, N, 2, &a, &err));
  OK(cag_curve_bezier(q, NULL, N, 2, &b, &err));
  double from = 0, to = 1;
  assert_true(cag_curve_clip_parameters(a, 0, 1, b, 0, &from, &to));
  // The strip holds the heights from 0 to 1.
  NEAR(from, 0.5, 1e-11);
  NEAR(to, 0.75, 1e-11);
  cag_curve_release(a);
  cag_curve_release(b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_is_near_enough_stays),
      cmocka_unit_test(what_is_left_is_where_the_hull_reaches_the_strip),
      cmocka_unit_test(lines_are_cut_to_a_prism),
      cmocka_unit_test(what_cannot_be_clipped_stays),
      cmocka_unit_test(ends_on_the_strip_stay),
      cmocka_unit_test(curves_of_the_greatest_degree_are_clipped),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
