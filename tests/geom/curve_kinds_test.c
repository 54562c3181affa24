// The functions that every kind of curve provides, for random curves of all kinds, compared with
// dense samples.

#include "geom/curve/family.h"
#include "geom/curve/nurbs.h"
#include "geom/curve/range.h"
#include "tests/geom/curve_random.h"
#include "tests/geom/support.h"

static double from_segment(CagVec3 p, CagVec3 a, CagVec3 b) {
  const CagVec3 d = cag_sub(b, a), r = cag_sub(p, a);
  const double u = cag_dot(d, d) > 0 ? cag_dot(r, d) / cag_dot(d, d) : 0;
  return cag_norm(cag_madd(r, -fmin(1, fmax(0, u)), d));
}

// A random part of a random smooth piece.
static void random_part(const CagCurve *c, double *a, double *b) {
  double *cuts;
  size_t n;
  OK(cag_curve_cuts(c, &cuts, &n, &err));
  assert_true(n >= 2 && cuts[0] == c->start && cuts[n - 1] == c->end);
  const size_t i = (size_t)uniform(0, (double)(n - 1));
  const double low = cuts[i], range = cuts[i + 1] - low;
  const double share = pow(2, uniform(-9, 0)), from = uniform(0, 1 - share);
  *a = low + range * from;
  *b = fmin(cuts[i + 1], low + range * (from + share));
  free(cuts);
}

// --- Bounds of parts ---

// How far the point is outside the box, in the coordinate with the largest excess.
static double excess(const CagBounds *b, CagVec3 p) {
  const double x = fmax(b->min.x - p.x, p.x - b->max.x), y = fmax(b->min.y - p.y, p.y - b->max.y);
  return fmax(fmax(x, y), fmax(b->min.z - p.z, p.z - b->max.z));
}

// For slightly curved parts: their number, and the sum of the ratios between bound and true value.
static double looseness;
static int bent_little;

static void check_sag(const CagCurve *c) {
  enum { SAMPLES = 60 };
  for (int part = 0; part < 6; part++) {
    double a, b, most = 0;
    random_part(c, &a, &b);
    const CagVec3 p = at(c, a), q = at(c, b);
    const CagBounds hull = c->kind->hull(c, a, b);
    const double sag = cag_curve_sag(c, a, b), chord = cag_norm(cag_sub(p, q));
    for (int i = 0; i <= SAMPLES; i++) {
      const CagVec3 x = at(c, fmin(b, a + (b - a) * i / SAMPLES));
      most = fmax(most, from_segment(x, p, q));
      assert_true(excess(&hull, x) <= 1e-13);
    }
    assert_true(sag >= most * (1 - 1e-9) - 1e-14);
    if (!(most < 0.02 * chord)) continue;
    assert_true(cag_norm(cag_sub(hull.max, hull.min)) <= 3 * chord + 1e-12);
    if (most < 1e-9) continue;
    looseness += sag / most;
    bent_little++;
  }
}

static void parts_stay_within_their_bounds(void **state) {
  (void)state;
  seed = 201;
  for (Kind kind = 0; kind < KINDS; kind++) {
    looseness = 0;
    bent_little = 0;
    for (int round = 0; round < 60; round++) {
      CagCurve *c = random_curve(kind);
      check_sag(c);
      cag_curve_release(c);
    }
    // Straight kinds have none. The bound of an ellipse is that of its larger axis.
    if (kind <= RING) assert_int_equal(bent_little, 0);
    else assert_true(bent_little > 100);
    assert_true(looseness <= (kind == ELLIPSE ? 2 : 1.45) * bent_little);
  }
}

static void check_interval(CagInterval range, double value, double size) {
  assert_true(range.lo <= value + 1e-11 * size && range.hi >= value - 1e-11 * size);
}

static void check_ranges(const CagCurve *c) {
  enum { ORDER = 4, SAMPLES = 8 };
  CagInterval3 r[ORDER + 1];
  for (int part = 0; part < 6; part++) {
    double a, b, size = 1;
    random_part(c, &a, &b);
    const bool narrow = part >= 3;
    if (narrow) b = a + (b - a) * 1e-7;
    if (!(a < b) || !cag_curve_ranges(c, a, b, ORDER, r)) continue;
    for (int i = 0; i <= SAMPLES; i++) {
      CagVec3 d[ORDER + 1];
      OK(cag_curve_eval(c, i == SAMPLES ? b : a + (b - a) * i / SAMPLES, ORDER,
                        i == SAMPLES ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, d, &err));
      double factorial = 1;
      for (int k = 0; k <= ORDER; k++) {
        if (k > 0) factorial *= k;
        const CagVec3 v = cag_scaled(d[k], 1 / factorial);
        size = fmax(size, cag_norm(v));
        check_interval(r[k].x, v.x, size);
        check_interval(r[k].y, v.y, size);
        check_interval(r[k].z, v.z, size);
        if (!narrow) continue;
        // Only rounding contributes to the width.
        assert_true(r[k].x.hi - r[k].x.lo <= 1e-4 * size);
        assert_true(r[k].y.hi - r[k].y.lo <= 1e-4 * size);
        assert_true(r[k].z.hi - r[k].z.lo <= 1e-4 * size);
      }
    }
  }
}

static void ranges_hold_the_derivatives_and_are_narrow(void **state) {
  (void)state;
  seed = 202;
  each_kind(40, check_ranges);
  // Functions have no bounds.
  CagInterval3 r[2];
  CagCurve *c = random_curve(FUNCTION);
  assert_false(cag_curve_ranges(c, c->start, c->end, 1, r));
  cag_curve_release(c);
}

// --- Boxes, closest points, lengths ---

enum { DENSE = 1200 };

static void check_box(const CagCurve *c) {
  CagBounds box, found = CAG_BOUNDS_EMPTY;
  OK(cag_curve_bounds(c, &box, &err));
  double *cuts, step = 0;
  size_t n;
  OK(cag_curve_cuts(c, &cuts, &n, &err));
  for (size_t i = 0; i < n; i++) cag_bounds_add(&found, at(c, cuts[i]));
  free(cuts);
  CagVec3 last = at(c, c->start);
  for (int i = 1; i <= DENSE; i++) {
    const CagVec3 p = at(c, i == DENSE ? c->end : c->start + (c->end - c->start) * i / DENSE);
    cag_bounds_add(&found, p);
    step = fmax(step, cag_norm(cag_sub(p, last)));
    last = p;
  }
  const double size = cag_norm(cag_sub(box.max, box.min));
  assert_true(excess(&box, found.min) <= 1e-10 * size);
  assert_true(excess(&box, found.max) <= 1e-10 * size);
  // A peak between samples exceeds them by the square of their step divided by the radius.
  const double most = 8 * step * step / fmin(size, 1) + 1e-10 * size;
  NEAR(box.min.x, found.min.x, most);
  NEAR(box.min.y, found.min.y, most);
  NEAR(box.min.z, found.min.z, most);
  NEAR(box.max.x, found.max.x, most);
  NEAR(box.max.y, found.max.y, most);
  NEAR(box.max.z, found.max.z, most);
}

static void boxes_are_those_of_dense_samples(void **state) {
  (void)state;
  seed = 203;
  each_kind(12, check_box);
}

static double distance_at(const CagCurve *c, CagVec3 p, double t) {
  return cag_norm(cag_sub(at(c, fmin(c->end, fmax(c->start, t))), p));
}

static void check_closest(const CagCurve *c) {
  const CagVec3 p = random_point(6);
  double t, distance, least = INFINITY, best = 0;
  CagVec3 foot;
  OK(cag_curve_closest(c, p, &t, &foot, &distance, &err));
  near_vec(at(c, t), foot, 1e-14);
  NEAR(cag_norm(cag_sub(foot, p)), distance, 1e-14);
  const double step = (c->end - c->start) / DENSE;
  for (int i = 0; i <= DENSE; i++)
    if (distance_at(c, p, c->start + step * i) < least) {
      least = distance_at(c, p, c->start + step * i);
      best = c->start + step * i;
    }
  // Golden-section search between the neighbors.
  double low = best - step, high = best + step;
  for (int i = 0; i < 60; i++) {
    const double x = low + 0.382 * (high - low), y = low + 0.618 * (high - low);
    if (distance_at(c, p, x) < distance_at(c, p, y)) high = y;
    else low = x;
  }
  least = fmin(least, distance_at(c, p, low));
  assert_true(distance <= least + 1e-12);
  assert_true(distance >= least - 1e-6);
  // Perpendicular, unless the closest point is an end or a corner.
  CagVec3 right[2], left[2];
  if (t <= c->start || t >= c->end) return;
  OK(cag_curve_eval(c, t, 1, CAG_SIDE_RIGHT, right, &err));
  OK(cag_curve_eval(c, t, 1, CAG_SIDE_LEFT, left, &err));
  if (cag_norm(cag_sub(right[1], left[1])) > 1e-9) return;
  NEAR(cag_dot(cag_unit(right[1]), cag_unit(cag_sub(p, foot))), 0, 1e-9);
}

static void closest_points_are_nearer_than_dense_samples(void **state) {
  (void)state;
  seed = 204;
  each_kind(12, check_closest);
}

// Gauss's rule with 3 points on each part of the smooth pieces.
static double length_by_parts(const CagCurve *c, double a, double b) {
  enum { PARTS = 60 };
  static const double node[3] = {0.1127016653792583, 0.5, 0.8872983346207417},
                      weight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  double *cuts, sum = 0;
  size_t n;
  OK(cag_curve_cuts(c, &cuts, &n, &err));
  for (size_t i = 0; i + 1 < n; i++) {
    const double from = fmax(a, cuts[i]), to = fmin(b, cuts[i + 1]), h = (to - from) / PARTS;
    for (int k = 0; from < to && k < 3 * PARTS; k++) {
      CagVec3 d[2];
      derivatives(c, from + h * (k / 3 + node[k % 3]), 1, d);
      sum += h * weight[k % 3] * cag_norm(d[1]);
    }
  }
  free(cuts);
  return sum;
}

static void check_length(const CagCurve *c) {
  double all, part, before, t, u;
  OK(cag_curve_length(c, c->start, c->end, &all, &err));
  NEAR(all / length_by_parts(c, c->start, c->end), 1, 1e-7);
  double a = uniform(c->start, c->end), b = uniform(c->start, c->end);
  if (a > b) {
    t = a;
    a = b;
    b = t;
  }
  OK(cag_curve_length(c, a, b, &part, &err));
  NEAR(part / length_by_parts(c, a, b), 1, 1e-7);
  OK(cag_curve_length(c, c->start, a, &before, &err));
  OK(cag_curve_parameter_at_length(c, before, &t, &err));
  OK(cag_curve_parameter_at_length(c, before + part, &u, &err));
  near_vec(at(c, t), at(c, a), 1e-9 * all);
  near_vec(at(c, u), at(c, b), 1e-9 * all);
  OK(cag_curve_parameter_at_length(c, 0, &t, &err));
  assert_true(t == c->start);
  OK(cag_curve_parameter_at_length(c, all * (1 + 0.9e-12), &t, &err));
  assert_true(t == c->end);
  FAILS(cag_curve_parameter_at_length(c, all * (1 + 1e-11), &t, &err), "parameter-range");
  FAILS(cag_curve_parameter_at_length(c, -1e-9, &t, &err), "parameter-range");
  FAILS(cag_curve_length(c, b, a, &part, &err), "empty-range");
  OK(cag_curve_length(c, a, a, &part, &err));
  assert_true(part == 0);
}

static void lengths_are_those_of_gauss_rules(void **state) {
  (void)state;
  seed = 205;
  each_kind(12, check_length);
}

// --- Polylines through curves ---

static void check_steps(const CagCurve *c) {
  const double tolerance = pow(10, uniform(-4, -1)), angle = uniform(0.1, 1);
  double *t, *cuts;
  size_t n, cut_count;
  OK(cag_curve_discretize(c, tolerance, angle, &t, &n, &err));
  OK(cag_curve_cuts(c, &cuts, &cut_count, &err));
  assert_true(t[0] == c->start && t[n - 1] == c->end);
  size_t cut = 0, needed = 0;
  for (size_t i = 0; i + 1 < n; i++) {
    CagVec3 right[2], left[2];
    assert_true(t[i] < t[i + 1]);
    while (cut + 1 < cut_count && cuts[cut + 1] <= t[i]) cut++;
    assert_true(t[i + 1] <= cuts[cut + 1]); // breaks are included
    const CagVec3 p = at(c, t[i]), q = at(c, t[i + 1]);
    double most = 0;
    for (int k = 1; k < 8; k++)
      most = fmax(most, from_segment(at(c, t[i] + (t[i + 1] - t[i]) * k / 8), p, q));
    assert_true(most <= tolerance);
    OK(cag_curve_eval(c, t[i], 1, CAG_SIDE_RIGHT, right, &err));
    OK(cag_curve_eval(c, t[i + 1], 1, CAG_SIDE_LEFT, left, &err));
    const double turn = atan2(cag_norm(cag_cross(right[1], left[1])), cag_dot(right[1], left[1]));
    assert_true(turn <= angle * (1 + 1e-9) ||
                cag_norm(cag_sub(q, p)) <= 0.25 * tolerance * (1 + 1e-9));
    needed +=
        most > tolerance / 16 || turn > angle / 5 || t[i + 1] == cuts[cut + 1] || t[i] == cuts[cut];
  }
  // Bisection produces steps that are up to twice too short, and few shorter ones.
  assert_true(needed * 4 >= n);
  free(t);
  free(cuts);
}

static void steps_keep_tolerance_and_angle_and_are_not_too_many(void **state) {
  (void)state;
  seed = 206;
  each_kind(25, check_steps);
}

// --- Images and parts ---

static void check_parts(const CagCurve *c) {
  CagCurve *made;
  const double middle = c->start + (c->end - c->start) / 2;
  const double a = uniform(c->start, middle), b = uniform(middle, c->end);
  if (b - a < 0.1 * (c->end - c->start)) return;
  // A part has the same parameters, or new ones at the same rate.
  OK(cag_curve_trim(c, a, b, &made, &err));
  assert_int_equal(made->angular, c->angular);
  for (int i = 0; i <= 12; i++) {
    CagVec3 p[4], q[4];
    const double t = i == 12 ? b : a + (b - a) * i / 12;
    const CagSide side = i == 12 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
    OK(cag_curve_eval(c, t, 3, side, p, &err));
    OK(cag_curve_eval(made, fmin(made->end, fmax(made->start, t)), 3, side, q, &err));
    for (int k = 0; k < 4; k++) near_vec(q[k], p[k], 1e-8 * (1 + cag_norm(p[k])));
  }
  cag_curve_release(made);
  // The reversed curve.
  OK(cag_curve_reverse(c, &made, &err));
  assert_true(made->start == c->start && made->end == c->end);
  assert_int_equal(made->angular, c->angular);
  assert_int_equal(made->closed, c->closed);
  for (int i = 0; i <= 12; i++) {
    CagVec3 p[4], q[4];
    const double s = (i + (i > 0 && i < 12 ? 0.013 : 0)) / 12;
    OK(cag_curve_eval(c, c->start + (c->end - c->start) * s, 3, i ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT,
                      p, &err));
    OK(cag_curve_eval(made, c->end - (c->end - c->start) * s, 3, i ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT,
                      q, &err));
    for (int k = 0; k < 4; k++)
      near_vec(cag_scaled(q[k], k % 2 ? -1 : 1), p[k], 1e-9 * (1 + cag_norm(p[k])));
  }
  cag_curve_release(made);
  // Over another domain, the derivatives are scaled.
  const double from = uniform(-3, 3), rate = uniform(0.3, 3);
  OK(cag_curve_reparametrize(c, from, from + (c->end - c->start) / rate, &made, &err));
  assert_int_equal(made->closed, c->closed);
  for (int i = 0; i < 12; i++) {
    CagVec3 p[4], q[4];
    const double s = (i + 0.017) / 12;
    derivatives(c, c->start + (c->end - c->start) * s, 3, p);
    derivatives(made, from + (made->end - from) * s, 3, q);
    for (int k = 0; k < 4; k++)
      near_vec(q[k], cag_scaled(p[k], pow(rate, k)), 1e-9 * (1 + cag_norm(q[k])));
  }
  cag_curve_release(made);
}

static void parts_and_reversals_keep_points_and_derivatives(void **state) {
  (void)state;
  seed = 207;
  each_kind(25, check_parts);
}

static void check_image(const CagCurve *c) {
  CagTransform t = random_frame();
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) t.m[i][j] += uniform(-0.4, 0.4);
  CagCurve *made;
  OK(cag_curve_transform(c, &t, &made, &err));
  assert_int_equal(made->dimension, 3);
  assert_int_equal(made->closed, c->closed);
  for (int i = 0; i <= 20; i++) {
    CagVec3 p[4], q[4];
    const double s = (i + (i < 20 ? 0.019 : 0)) / 20;
    derivatives(c, c->start + (c->end - c->start) * s, 3, p);
    if (made->start != c->start || made->end != c->end)
      break; // a NURBS curve with a parametrization of its own
    derivatives(made, c->start + (c->end - c->start) * s, 3, q);
    near_vec(q[0], cag_transform_point(&t, p[0]), 1e-12);
    for (int k = 1; k < 4; k++)
      near_vec(q[k], cag_transform_vector(&t, p[k]), 1e-9 * (1 + cag_norm(q[k])));
  }
  cag_curve_release(made);
}

static void images_have_the_points_and_derivatives_of_the_map(void **state) {
  (void)state;
  seed = 208;
  each_kind(20, check_image);
}

static void check_derivatives(const CagCurve *c) {
  enum { ORDER = 5 };
  for (int i = 0; i < 5; i++) {
    double a, b;
    random_part(c, &a, &b);
    const double t = a + (b - a) / 2, h = fmin(1e-4, (b - a) / 3);
    if (h < 1e-6) continue;
    CagVec3 d[ORDER + 4], left[ORDER + 1], right[ORDER + 1], many[2 * (ORDER + 1)];
    derivatives(c, t, ORDER + 3, d);
    derivatives(c, t - h, ORDER, left);
    derivatives(c, t + h, ORDER, right);
    for (int k = 0; k <= ORDER; k++) {
      const CagVec3 slope = cag_scaled(cag_sub(right[k], left[k]), 1 / (2 * h));
      // The error of the difference is h^2 / 6 times the third derivative, plus rounding divided by
      // h.
      near_vec(slope, d[k + 1],
               h * h * (cag_norm(d[k + 3]) + cag_norm(d[k + 1])) +
                   1e-12 * (1 + cag_norm(d[k])) / h);
    }
    const double both[2] = {t, t + h};
    OK(cag_curve_eval_many(c, both, 2, ORDER, many, &err));
    for (int k = 0; k <= ORDER; k++) {
      near_vec(many[k], d[k], 1e-9 * (1 + cag_norm(d[k])));
      near_vec(many[ORDER + 1 + k], right[k], 1e-9 * (1 + cag_norm(d[k])));
    }
  }
}

static void derivatives_are_the_slopes_of_those_before(void **state) {
  (void)state;
  seed = 209;
  each_kind(20, check_derivatives);
}

// --- Over the seam ---

static CagCurve *random_loop(int kind) {
  CagCurve *c, *parts[2];
  if (kind == 0) return random_curve(RING);
  if (kind == 1) return random_curve(PERIODIC);
  if (kind == 2) return random_curve(ELLIPSE);
  if (kind == 3) { // a half circle and its chord
    CagTransform frame = random_frame();
    CagVec3 p, q;
    OK(cag_curve_arc(2, 2, 0, M_PI, &frame, &parts[0], &err));
    OK(cag_curve_point(parts[0], M_PI, &p, &err));
    OK(cag_curve_point(parts[0], 0, &q, &err));
    OK(cag_curve_line(p, q, 3, &parts[1], &err));
    OK(cag_curve_join(parts, 2, &c, &err));
    for (int i = 0; i < 2; i++) cag_curve_release(parts[i]);
    return c;
  }
  CagVec3 points[6];
  for (int i = 0; i < 5; i++) points[i] = random_point(3);
  points[5] = points[0];
  OK(cag_curve_bezier(points, NULL, 6, 3, &c, &err));
  return c;
}

static void closed_curves_of_all_kinds_go_on_over_the_seam(void **state) {
  (void)state;
  seed = 210;
  for (int round = 0; round < 200; round++) {
    CagCurve *c = random_loop(round % 5), *other, *part;
    const double from = uniform(-3, 3), rate = uniform(0.5, 2);
    OK(cag_curve_reparametrize(c, from, from + (c->end - c->start) * rate, &other, &err));
    if (round / 5 % 2) {
      cag_curve_release(c);
      c = cag_curve_retain(other);
    }
    cag_curve_release(other);
    assert_true(c->closed);
    const double period = c->end - c->start;
    double a = c->start + period * uniform(-3, 3), b = a + period * uniform(0.05, 1);
    if (round % 7 == 0) a = c->start + period * floor(uniform(-3, 3)); // from the seam
    if (round % 7 == 0) b = a + period * uniform(0.05, 1);
    if (round % 7 == 1) b = a + period; // a whole turn
    if (round % 7 == 2) b = c->start + period * (1 + floor((a - c->start) / period)); // to the seam
    if (!(b - a > 0.01 * period)) b = a + 0.5 * period;
    OK(cag_curve_trim(c, a, b, &part, &err));
    NEAR(part->start, a, 1e-13 * (1 + fabs(a)));
    NEAR(part->end, b, 1e-13 * (1 + fabs(b)));
    assert_int_equal(part->angular, c->angular);
    for (int i = 0; i <= 40; i++) {
      const double t = a + (b - a) * i / 40, turns = floor((t - c->start) / period);
      near_vec(at(part, fmin(part->end, fmax(part->start, t))),
               at(c, fmin(c->end, fmax(c->start, t - turns * period))), 1e-11);
    }
    const CagVec3 *v;
    size_t n;
    bool ring;
    assert_int_equal(cag_curve_vertices(part, &v, &n, &ring), round % 5 == 0);
    if (round % 5 == 1 || round % 5 == 4) assert_non_null(cag_nurbs_data(part));
    cag_curve_release(part);
    cag_curve_release(c);
  }
}

// --- Many parameters at once ---

// The results for many parameters are those for each one, and a failure is that of the first that
// fails.
static void many_parameters_are_like_one(void **state) {
  (void)state;
  enum { MANY = 6, ORDER = 2, EACH = ORDER + 1 };
  seed = 219;
  int refused = 0;
  for (int round = 0; round < 12; round++)
    for (Kind kind = 0; kind < KINDS; kind++) {
      CagCurve *c = random_curve(kind);
      double t[MANY];
      CagVec3 many[MANY * EACH], one[EACH];
      for (int i = 0; i < MANY; i++) t[i] = c->start + uniform(0, 1) * (c->end - c->start);
      // In most rounds, one parameter is outside the domain.
      const int at = (int)uniform(0, MANY - 1e-9);
      if (round % 3 == 1) t[at] = c->start - uniform(0.1, 2) * (c->end - c->start);
      if (round % 3 == 2) t[at] = c->end + uniform(0.1, 2) * (c->end - c->start);
      const CagStatus status = cag_curve_eval_many(c, t, MANY, ORDER, many, &err);
      const long index = err.index;
      CagStatus first = CAG_OK;
      for (int i = 0; first == CAG_OK && i < MANY; i++) {
        first = cag_curve_eval(c, t[i], ORDER, CAG_SIDE_RIGHT, one, &err);
        if (first) assert_int_equal(index, i);
        for (int k = 0; status == CAG_OK && k < EACH; k++)
          near_vec(many[i * EACH + k], one[k], 1e-9 * (1 + cag_norm(one[k])));
      }
      assert_int_equal(status, first);
      refused += first != CAG_OK;
      cag_curve_release(c);
    }
  assert_true(refused > 60);
}

// --- Stationary points ---

static void stops_are_taken_in_by_what_moves_after_them(void **state) {
  (void)state;
  enum { MOST = 12 };
  seed = 211;
  int changed = 0;
  for (int round = 0; round < 200; round++) {
    CagVec3 p[MOST];
    double t[MOST];
    bool stop[MOST] = {false};
    const size_t n = 2 + (size_t)uniform(0, MOST - 2);
    size_t moving = 0;
    t[0] = uniform(-2, 2);
    p[0] = random_point(2);
    for (size_t i = 1; i < n; i++) {
      t[i] = t[i - 1] + uniform(0.2, 1.5);
      stop[i - 1] = uniform(0, 1) < 0.4;
      moving += !stop[i - 1];
      p[i] = random_point(2);
      if (stop[i - 1]) p[i] = p[i - 1];
    }
    CagCurve *c, *out;
    OK(cag_curve_polyline_over(p, t, n, 3, &c, &err));
    OK(cag_curve_without_stops(c, &out, &err));
    if (moving == 0 || moving == n - 1) {
      assert_ptr_equal(out, c);
    } else {
      assert_true(out->start == t[0]);
      NEAR(out->end, t[n - 1], 1e-14);
      // Runs of moving parts are stretched over the stops before them; the last one also covers
      // those after it.
      double from = t[0];
      for (size_t i = 0; i + 1 < n;) {
        if (stop[i]) {
          i++;
          continue;
        }
        size_t j = i;
        while (j + 1 < n && !stop[j]) j++;
        size_t next = j;
        while (next + 1 < n && stop[next]) next++;
        const double to = next + 1 < n ? t[j] : t[n - 1];
        for (int k = 0; k <= 10; k++) {
          const double x = k / 10.0;
          near_vec(at(out, fmin(out->end, from + (to - from) * x)),
                   at(c, fmin(t[n - 1], t[i] + (t[j] - t[i]) * x)), 1e-12);
        }
        from = to;
        i = j;
      }
      changed++;
    }
    cag_curve_release(out);
    cag_curve_release(c);
  }
  assert_true(changed > 100);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(parts_stay_within_their_bounds),
      cmocka_unit_test(ranges_hold_the_derivatives_and_are_narrow),
      cmocka_unit_test(boxes_are_those_of_dense_samples),
      cmocka_unit_test(closest_points_are_nearer_than_dense_samples),
      cmocka_unit_test(lengths_are_those_of_gauss_rules),
      cmocka_unit_test(steps_keep_tolerance_and_angle_and_are_not_too_many),
      cmocka_unit_test(parts_and_reversals_keep_points_and_derivatives),
      cmocka_unit_test(images_have_the_points_and_derivatives_of_the_map),
      cmocka_unit_test(derivatives_are_the_slopes_of_those_before),
      cmocka_unit_test(closed_curves_of_all_kinds_go_on_over_the_seam),
      cmocka_unit_test(many_parameters_are_like_one),
      cmocka_unit_test(stops_are_taken_in_by_what_moves_after_them),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
