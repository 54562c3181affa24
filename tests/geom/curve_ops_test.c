// Splitting, elevating, refining and intersecting curves.

#include "geom/curve/intersect.h"
#include "geom/curve/nurbs_ops.h"
#include "random.h"
#include "support.h"

static const CagVec3 zigzag[6] = {{0, 1, 0},  {1, 2, 1}, {2.5, 0, 0.5},
                                  {4, 2, -1}, {5, 0, 0}, {6, 3, 1}};
static const double weights[6] = {1, 2, 0.5, 3, 1, 1.5};

static CagVec3 at(const CagCurve *c, double t) {
  CagVec3 p;
  OK(cag_curve_point(c, t, &p, &err));
  return p;
}

static void same_curve(const CagCurve *a, const CagCurve *b) {
  assert_true(a->start == b->start && a->end == b->end);
  for (int k = 0; k <= 40; k++) {
    double t = k == 40 ? a->end : a->start + (a->end - a->start) * k / 40.0;
    near_vec(at(a, t), at(b, t), 1e-12);
  }
}

static size_t splines(CagCurve *out[6]) {
  static const double uneven[10] = {0, 0, 0, 0, 0.3, 0.3, 1, 1, 1, 1};
  double knots[16];
  OK(cag_curve_bezier(zigzag, weights, 6, 3, &out[0], &err));
  OK(cag_curve_nurbs(zigzag, NULL, 6, 3, uneven, 3, &out[1], &err));
  OK(cag_curve_nurbs(zigzag, weights, 6, 3, uneven, 3, &out[2], &err));
  OK(cag_knots_make("periodic", 6, 2, NULL, knots, &err));
  OK(cag_curve_nurbs(zigzag, weights, 6, 2, knots, 3, &out[3], &err));
  OK(cag_curve_nurbs_closed(zigzag, NULL, 6, 3, 3, &out[4], &err));
  OK(cag_curve_polyline(zigzag, 6, false, 3, &out[5], &err));
  return 6;
}

static void splitting_keeps_the_points(void **state) {
  (void)state;
  CagCurve *c[6], *half[2];
  size_t n = splines(c);
  for (size_t i = 0; i < n; i++) {
    double t = c[i]->start + 0.3 * (c[i]->end - c[i]->start);
    OK(cag_curve_split(c[i], t, half, &err));
    for (int k = 0; k < 2; k++)
      for (int s = 0; s < 10; s++) {
        double u = half[k]->start + (half[k]->end - half[k]->start) * s / 10.0;
        near_vec(at(half[k], u), at(c[i], u), 1e-12);
      }
    FAILS(cag_curve_split(c[i], c[i]->start, half, &err), "parameter-range");
    cag_curve_release(half[0]);
    cag_curve_release(half[1]);
    cag_curve_release(c[i]);
  }
}

static void elevating_keeps_the_points_and_the_smoothness(void **state) {
  (void)state;
  CagCurve *c[6], *up;
  size_t n = splines(c);
  for (size_t i = 0; i < n; i++) {
    for (int times = 0; times < 4; times++) {
      CagNurbsView v;
      OK(cag_curve_elevate(c[i], times, &up, &err));
      same_curve(up, c[i]);
      assert_true(cag_curve_nurbs_view(up, &v));
      CagCurve *exact;
      CagNurbsView w;
      OK(cag_curve_to_nurbs(c[i], &exact, &err));
      cag_curve_nurbs_view(exact, &w);
      assert_int_equal(v.degree, w.degree + times);
      cag_curve_release(exact);
      cag_curve_release(up);
    }
    cag_curve_release(c[i]);
  }
}

// Reference 05b, 5: example 18's curve elevated.
static void elevation_of_a_spline_is_that_of_the_reference(void **state) {
  (void)state;
  static const CagVec3 b[4] = {{0, 0, 0}, {1, 1, 0}, {2, 1, 0}, {3, 0, 0}};
  static const double knots[7] = {0, 0, 0, 1, 2, 2, 2};
  static const double z[10] = {0, 0, 0, 0, 1, 1, 2, 2, 2, 2};
  static const double q[6][2] = {{0, 0},        {2.0 / 3, 2.0 / 3}, {7.0 / 6, 1},
                                 {11.0 / 6, 1}, {7.0 / 3, 2.0 / 3}, {3, 0}};
  CagCurve *c, *up;
  CagNurbsView v;
  OK(cag_curve_nurbs(b, NULL, 4, 2, knots, 2, &c, &err));
  OK(cag_curve_elevate(c, 1, &up, &err));
  assert_true(cag_curve_nurbs_view(up, &v));
  assert_int_equal(v.count, 6);
  assert_memory_equal(v.knots, z, sizeof z);
  for (int i = 0; i < 6; i++)
    for (int k = 0; k < 2; k++) NEAR(v.homogeneous[4 * i + k], q[i][k], 1e-15);
  cag_curve_release(c);
  cag_curve_release(up);
}

// Reference 05b, example 18: midpoints into [0 0 0 2 4 4 4].
static void midpoints_give_the_points_of_the_reference(void **state) {
  (void)state;
  static const CagVec3 b[4] = {{0, 0, 0}, {1, 1, 0}, {2, 1, 0}, {3, 0, 0}};
  static const double knots[7] = {0, 0, 0, 2, 4, 4, 4}, y[9] = {0, 0, 0, 1, 2, 3, 4, 4, 4};
  static const double q[6][2] = {{0, 0}, {0.5, 0.5}, {1.25, 1}, {1.75, 1}, {2.5, 0.5}, {3, 0}};
  CagCurve *c, *fine;
  CagNurbsView v;
  OK(cag_curve_nurbs(b, NULL, 4, 2, knots, 2, &c, &err));
  OK(cag_curve_insert_midpoints(c, &fine, &err));
  assert_true(cag_curve_nurbs_view(fine, &v));
  assert_int_equal(v.count, 6);
  assert_memory_equal(v.knots, y, sizeof y);
  for (int i = 0; i < 6; i++)
    for (int k = 0; k < 2; k++) NEAR(v.homogeneous[4 * i + k], q[i][k], 1e-15);
  cag_curve_release(fine);
  const double twice[3] = {1, 1, 1}, outside = 5;
  FAILS_AT(cag_curve_insert_knots(c, twice, 3, &fine, &err), "knot-multiplicity", 2);
  FAILS(cag_curve_insert_knots(c, &outside, 1, &fine, &err), "parameter-range");
  cag_curve_release(c);
}

static void insertion_keeps_the_points(void **state) {
  (void)state;
  CagCurve *c[6], *fine;
  size_t n = splines(c);
  for (size_t i = 0; i < n; i++) {
    double t[3];
    for (int k = 0; k < 3; k++) t[k] = c[i]->start + (c[i]->end - c[i]->start) * (0.71 - 0.2 * k);
    OK(cag_curve_insert_knots(c[i], t, 3, &fine, &err));
    same_curve(fine, c[i]);
    cag_curve_release(fine);
    cag_curve_release(c[i]);
  }
}

static void bezier_pieces_are_the_curve(void **state) {
  (void)state;
  CagCurve *c[6], **pieces;
  size_t n = splines(c), m;
  for (size_t i = 0; i < n; i++) {
    OK(cag_curve_to_bezier(c[i], &pieces, &m, &err));
    double cuts[16];
    size_t breaks = c[i]->kind->breaks(c[i], cuts + 1, 14);
    assert_int_equal(m, breaks + 1);
    cuts[0] = c[i]->start;
    cuts[m] = c[i]->end;
    for (size_t k = 0; k < m; k++) {
      near_vec(at(pieces[k], 0.3), at(c[i], cuts[k] + 0.3 * (cuts[k + 1] - cuts[k])), 1e-12);
      assert_string_equal(pieces[k]->kind->name, "bezier");
      cag_curve_release(pieces[k]);
    }
    free(pieces);
    cag_curve_release(c[i]);
  }
}

// --- Random splines ---

static CagCurve *random_spline(int p, size_t n, int kind) {
  CagVec3 points[12];
  double w[12], knots[20], t = 0;
  CagCurve *c;
  for (size_t i = 0; i < n; i++) {
    points[i].x = uniform(-3, 3);
    points[i].y = uniform(-3, 3);
    points[i].z = uniform(-3, 3);
    w[i] = uniform(0.5, 2);
  }
  const double *weight = kind % 2 ? w : NULL;
  if (kind >= 6) {
    OK(cag_curve_nurbs_closed(points, weight, n, p, 3, &c, &err));
    return c;
  }
  // Clamped with nonuniform knots; nonuniform knots without clamping; uniform knots.
  for (size_t i = 0; i < n + (size_t)p + 1; i++) {
    const double step = kind < 4 ? uniform(0.3, 1.2) : 0.5;
    const bool inside = i > (size_t)p && i <= n;
    if (kind >= 2 || inside) t += i > 0 ? step : 0;
    knots[i] = t;
  }
  if (kind < 2 && n > (size_t)p + 2 && p > 1) knots[p + 2] = knots[p + 1];
  OK(cag_curve_nurbs(points, weight, n, p, knots, 3, &c, &err));
  return c;
}

static size_t count_of(const CagCurve *c) {
  CagNurbsView v;
  assert_true(cag_curve_nurbs_view(c, &v));
  return v.count;
}

static void random_splines_keep_their_points(void **state) {
  (void)state;
  seed = 301;
  for (int round = 0; round < 96; round++) {
    const int p = 1 + round % 4, kind = round % 8;
    const size_t n = (size_t)p + 1 + (size_t)(round % 5);
    CagCurve *c = random_spline(p, n, kind), *other, *half[2], *middle, **pieces;
    CagNurbsView v, w;
    assert_true(cag_curve_nurbs_view(c, &v));
    // Degree elevation increases the multiplicity of each distinct knot by one.
    OK(cag_curve_elevate(c, 1 + round % 2, &other, &err));
    same_curve(other, c);
    assert_true(cag_curve_nurbs_view(other, &w));
    assert_int_equal(w.degree, p + 1 + round % 2);
    assert_true(w.rational == v.rational);
    cag_curve_release(other);
    // The midpoints of all intervals. Uniform knots stay uniform, and a closed curve stays closed.
    OK(cag_curve_insert_midpoints(c, &other, &err));
    same_curve(other, c);
    assert_true(cag_curve_nurbs_view(other, &w));
    assert_true(w.degree == p && w.periodic == v.periodic && w.rational == v.rational);
    if (kind >= 4) {
      const double step = (c->end - c->start) / (double)(v.count - (size_t)p);
      assert_int_equal(w.count, 2 * (v.count - (size_t)p) + (size_t)p);
      for (size_t i = 0; i + 1 < w.count + (size_t)p + 1; i++)
        NEAR(w.knots[i + 1] - w.knots[i], step / 2, 1e-12);
      if (v.periodic) {
        assert_int_equal(w.distinct, 2 * v.distinct);
        for (size_t i = 0; i < 4 * (size_t)p; i++)
          assert_true(w.homogeneous[i] == w.homogeneous[4 * w.distinct + i]);
      }
    }
    cag_curve_release(other);
    // Some knots, in any order.
    double t[3];
    for (int k = 0; k < 3; k++) t[k] = uniform(c->start, c->end);
    OK(cag_curve_insert_knots(c, t, 3, &other, &err));
    same_curve(other, c);
    assert_true(cag_curve_nurbs_view(other, &w));
    for (int k = 0; k < 3; k++) {
      int found = 0;
      for (size_t i = 0; i < w.count + (size_t)p + 1; i++) found += w.knots[i] == t[k];
      assert_int_equal(found, 1);
    }
    cag_curve_release(other);
    FAILS(cag_curve_insert_knots(c, &c->start, 1, &other, &err), "parameter-range");
    FAILS(cag_curve_insert_knots(c, &c->end, 1, &other, &err), "parameter-range");
    // A clamped curve begins at its first and ends at its last control point.
    OK(cag_curve_clamp(c, &other, &err));
    same_curve(other, c);
    assert_true(cag_curve_nurbs_view(other, &w));
    for (int end = 0; end < 2; end++) {
      const double *h = w.homogeneous + (end ? 4 * (w.count - 1) : 0);
      near_vec(cag_vec3(h[0] / h[3], h[1] / h[3], h[2] / h[3]), at(c, end ? c->end : c->start),
               1e-13);
    }
    assert_true(w.knots[0] == c->start && w.knots[p] == c->start);
    assert_true(w.knots[w.count] == c->end && w.knots[w.count + (size_t)p] == c->end);
    // An inserted knot can be removed again.
    CagCurve *fine, *back;
    double deviation;
    OK(cag_curve_insert_knots(other, t, 1, &fine, &err));
    assert_int_equal(count_of(fine), w.count + 1);
    OK(cag_curve_remove_knot(fine, t[0], 1, 1e-9, &back, &deviation, &err));
    same_curve(back, c);
    assert_int_equal(count_of(back), w.count);
    assert_true(deviation <= 1e-9);
    cag_curve_release(back);
    cag_curve_release(fine);
    cag_curve_release(other);
    // Halves and a part.
    OK(cag_curve_split(c, t[1], half, &err));
    OK(cag_curve_trim(c, fmin(t[0], t[1]), fmax(t[0], t[1]), &middle, &err));
    for (int k = 0; k <= 8; k++)
      for (int j = 0; j < 3; j++) {
        const CagCurve *part = j < 2 ? half[j] : middle;
        const double u = k == 8 ? part->end : part->start + (part->end - part->start) * k / 8;
        near_vec(at(part, u), at(c, u), 1e-11);
      }
    assert_true(half[0]->start == c->start && half[0]->end == t[1]);
    assert_true(half[1]->start == t[1] && half[1]->end == c->end);
    cag_curve_release(middle);
    cag_curve_release(half[0]);
    cag_curve_release(half[1]);
    FAILS(cag_curve_split(c, c->end, half, &err), "parameter-range");
    FAILS(cag_curve_elevate(c, -1, &other, &err), "order-range");
    // The Bezier pieces in order.
    size_t m;
    double cuts[32];
    OK(cag_curve_to_bezier(c, &pieces, &m, &err));
    const size_t breaks = c->kind->breaks(c, cuts + 1, 30);
    assert_int_equal(m, breaks + 1);
    cuts[0] = c->start;
    cuts[m] = c->end;
    for (size_t k = 0; k < m; k++) {
      for (int s = 0; s <= 4; s++)
        near_vec(at(pieces[k], s / 4.0),
                 at(c, fmin(c->end, cuts[k] + (cuts[k + 1] - cuts[k]) * s / 4)), 1e-11);
      cag_curve_release(pieces[k]);
    }
    free(pieces);
    cag_curve_release(c);
  }
}

// Elevated curves can be reduced again.
static void degrees_go_up_and_down(void **state) {
  (void)state;
  seed = 302;
  for (int round = 0; round < 32; round++) {
    const int p = 1 + round % 4;
    CagCurve *c = random_spline(p, (size_t)p + 1 + (size_t)(round % 3), round % 8), *up, *down;
    double deviation;
    OK(cag_curve_elevate(c, 1, &up, &err));
    OK(cag_curve_reduce_degree(up, 1e-9, &down, &deviation, &err));
    same_curve(down, c);
    CagNurbsView v;
    assert_true(cag_curve_nurbs_view(down, &v));
    assert_int_equal(v.degree, p);
    assert_true(deviation <= 1e-9);
    cag_curve_release(down);
    cag_curve_release(up);
    cag_curve_release(c);
  }
}

// --- Random composites ---

// A line, an arc, a spline, and a Bezier curve, each of which begins where the previous one ends.
static size_t random_pieces(CagCurve *out[4], bool space) {
  const double turn = uniform(0.5, 3), r = uniform(0.5, 2);
  const CagTransform f = cag_transform_identity();
  const CagVec3 p = {r, 0, 0}, q = {r * cos(turn), r * sin(turn), 0};
  CagVec3 a = {0, -2, 0}, net[4] = {q, q, q, q};
  a.x = uniform(1, 3);
  if (space) a.z = 1;
  for (int i = 1; i < 4; i++) {
    net[i].x += uniform(-2, 2);
    net[i].y += uniform(-2, 2);
    net[i].z += space ? uniform(-1, 1) : 0;
  }
  const CagVec3 last[3] = {net[3], cag_add(net[3], cag_vec3(1, 2, 0)),
                           cag_add(net[3], cag_vec3(3, 1, 0))};
  const double w[3] = {1, uniform(0.5, 2), uniform(0.5, 2)}, knots[8] = {1, 1, 1, 1.5, 4, 4, 4};
  OK(cag_curve_line(a, p, space ? 3 : 2, &out[0], &err));
  OK(cag_curve_arc(r, r, 0, turn, &f, &out[1], &err));
  OK(cag_curve_nurbs(net, NULL, 4, 2, knots, space ? 3 : 2, &out[2], &err));
  OK(cag_curve_bezier(last, w, 3, space ? 3 : 2, &out[3], &err));
  return 4;
}

static void random_composites_are_their_pieces(void **state) {
  (void)state;
  seed = 303;
  for (int round = 0; round < 40; round++) {
    CagCurve *pieces[4], *c, *nested, *pair, *exact, *back, *moved, *part, *faster;
    const bool space = round % 2;
    const size_t n = random_pieces(pieces, space);
    double cuts[5] = {0};
    for (size_t i = 0; i < n; i++) cuts[i + 1] = cuts[i] + pieces[i]->end - pieces[i]->start;
    OK(cag_curve_join(pieces, n, &c, &err));
    // Joining in two steps has the same result.
    OK(cag_curve_join(pieces, 2, &pair, &err));
    CagCurve *three[3] = {pair, pieces[2], pieces[3]};
    OK(cag_curve_join(three, 3, &nested, &err));
    same_curve(nested, c);
    OK(cag_curve_to_nurbs(c, &exact, &err));
    OK(cag_curve_reverse(c, &back, &err));
    const CagTransform shift = cag_translate(cag_vec3(1, 2, 0));
    CagTransform t = cag_transform_identity();
    t.m[0][1] = 0.5;
    t.m[1][1] = -2;
    t = cag_transform_multiply(&shift, &t);
    t.planar = true;
    OK(cag_curve_transform(c, &t, &moved, &err));
    const double from = uniform(0, cuts[2]), to = uniform(cuts[2], cuts[4]);
    OK(cag_curve_trim(c, from, to, &part, &err));
    OK(cag_curve_reparametrize(c, 3, 5, &faster, &err));
    assert_true(c->start == 0 && c->end == cuts[4] && c->dimension == (space ? 3 : 2));
    assert_true(part->start == from && part->end == to && !c->closed);
    CagBounds seen = CAG_BOUNDS_EMPTY;
    for (int k = 0; k <= 60; k++) {
      // The ends of the pieces are included, from both sides.
      const double u = k % 12 == 0 && k < 60 ? cuts[k / 12] : fmin(c->end, c->end * k / 60);
      for (int side = 0; side < 2; side++) {
        size_t i = 0;
        while (i < 3 && (side ? cuts[i + 1] <= u : cuts[i + 1] < u)) i++;
        if (!side && u == 0) i = 0;
        const double rate = (pieces[i]->end - pieces[i]->start) / (cuts[i + 1] - cuts[i]);
        const double v = fmin(pieces[i]->end, pieces[i]->start + (u - cuts[i]) * rate);
        CagVec3 d[3], e[3];
        OK(cag_curve_eval(c, u, 2, side ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT, d, &err));
        OK(cag_curve_eval(pieces[i], v, 2, side ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT, e, &err));
        for (int m = 0; m < 3; m++) near_vec(d[m], e[m], 1e-9);
        OK(cag_curve_eval(exact, u, 2, side ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT, e, &err));
        near_vec(d[0], e[0],
                 i == 1 ? 0.2 : 1e-9); // the arc's exact form is parametrized differently
        if (i != 1)
          for (int m = 1; m < 3; m++) near_vec(d[m], e[m], 1e-7 * (1 + cag_norm(e[m])));
        OK(cag_curve_eval(back, c->end - u, 2, side ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, e, &err));
        near_vec(e[0], d[0], 1e-9);
        near_vec(e[1], cag_scaled(d[1], -1), 1e-7 * (1 + cag_norm(d[1])));
        OK(cag_curve_eval(moved, u, 1, side ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT, e, &err));
        near_vec(e[0], cag_transform_point(&t, d[0]), 1e-9);
        near_vec(e[1], cag_transform_vector(&t, d[1]), 1e-9 * (1 + cag_norm(d[1])));
        const double w = 3 + 2 * u / c->end;
        OK(cag_curve_eval(faster, fmin(w, 5), 2, side ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT, e, &err));
        near_vec(e[0], d[0], 1e-9);
        if (u > from && u < to) {
          OK(cag_curve_eval(part, u, 1, side ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT, e, &err));
          near_vec(e[0], d[0], 1e-9);
          near_vec(e[1], d[1], 1e-7 * (1 + cag_norm(d[1])));
        }
        cag_bounds_add(&seen, d[0]);
      }
    }
    const double mid = c->end * 0.45;
    CagVec3 d[3], e[3];
    OK(cag_curve_eval(c, mid, 2, CAG_SIDE_RIGHT, d, &err));
    OK(cag_curve_eval(faster, 3 + 2 * mid / c->end, 2, CAG_SIDE_RIGHT, e, &err));
    near_vec(e[1], cag_scaled(d[1], c->end / 2), 1e-8 * (1 + cag_norm(e[1])));
    near_vec(e[2], cag_scaled(d[2], c->end * c->end / 4), 1e-8 * (1 + cag_norm(e[2])));
    const CagBounds box = c->kind->hull(c, c->start, c->end);
    assert_true(box.min.x <= seen.min.x + 1e-9 && box.min.y <= seen.min.y + 1e-9);
    assert_true(box.max.x >= seen.max.x - 1e-9 && box.max.y >= seen.max.y - 1e-9);
    // The box of a part that covers some of the pieces.
    const CagBounds less = c->kind->hull(c, from, to);
    assert_true(less.min.x >= box.min.x - 1e-9 && less.max.y <= box.max.y + 1e-9);
    for (int k = 0; k <= 8; k++) {
      const CagVec3 p = at(c, fmin(to, from + (to - from) * k / 8));
      assert_true(p.x >= less.min.x - 1e-9 && p.x <= less.max.x + 1e-9);
      assert_true(p.y >= less.min.y - 1e-9 && p.y <= less.max.y + 1e-9);
    }
    // Breaks: the joints and the inner knot of the spline, also with less space for results.
    double breaks[8] = {-1, -1, -1, -1, -1, -1, -1, -1};
    const double expected[4] = {cuts[1], cuts[2], cuts[2] + 0.5, cuts[3]};
    assert_int_equal(c->kind->breaks(c, NULL, 0), 4);
    for (size_t room = 0; room <= 6; room++) {
      for (int k = 0; k < 8; k++) breaks[k] = -1;
      assert_int_equal(c->kind->breaks(c, breaks, room), 4);
      for (size_t k = 0; k < 8; k++) NEAR(breaks[k], k < room && k < 4 ? expected[k] : -1, 1e-12);
    }
    cag_curve_release(faster);
    cag_curve_release(part);
    cag_curve_release(moved);
    cag_curve_release(back);
    cag_curve_release(exact);
    cag_curve_release(nested);
    cag_curve_release(pair);
    cag_curve_release(c);
    for (size_t i = 0; i < n; i++) cag_curve_release(pieces[i]);
  }
}

// Curves whose domains continue each other keep them, including angles. Points add nothing.
static void domains_that_go_on_are_kept(void **state) {
  (void)state;
  const CagTransform f = cag_transform_identity();
  CagCurve *parts[3], *c, *rest, *line;
  OK(cag_curve_arc(2, 2, 1, 2, &f, &parts[0], &err));
  OK(cag_curve_arc(2, 2, 2, 4, &f, &parts[1], &err));
  OK(cag_curve_arc(2, 2, 4, 1 + 2 * M_PI, &f, &parts[2], &err));
  OK(cag_curve_join(parts, 2, &c, &err));
  assert_true(c->start == 1 && c->end == 4 && c->angular && !c->closed);
  near_vec(at(c, 3), cag_vec3(2 * cos(3), 2 * sin(3), 0), 1e-15);
  cag_curve_release(c);
  OK(cag_curve_join(parts, 3, &c, &err));
  assert_true(c->start == 1 && c->end == 1 + 2 * M_PI && c->closed && c->angular);
  cag_curve_release(c);
  CagCurve *apart[2] = {parts[1], parts[0]};
  FAILS_AT(cag_curve_join(apart, 2, &c, &err), "ends-do-not-meet", 1);
  const CagVec3 end = at(parts[1], 4);
  OK(cag_curve_resting(end, 2, 0, 1, false, &rest, &err));
  OK(cag_curve_line(end, cag_vec3(5, 5, 0), 2, &line, &err));
  CagCurve *with_point[4] = {parts[0], parts[1], rest, line};
  OK(cag_curve_join(with_point, 4, &c, &err));
  assert_true(c->start == 0 && c->end == 4 && !c->angular && !c->closed);
  near_vec(at(c, 1), at(parts[0], 2), 0);
  near_vec(at(c, 4), cag_vec3(5, 5, 0), 0);
  cag_curve_release(c);
  OK(cag_curve_join(&rest, 1, &c, &err));
  assert_true(cag_curve_resting_view(c, NULL));
  cag_curve_release(c);
  FAILS(cag_curve_join(NULL, 0, &c, &err), "too-few-curves");
  // A plane curve and a space curve join to a space curve.
  CagCurve *space, *mixed[2] = {parts[0], NULL};
  OK(cag_curve_to_space(parts[1], &space, &err));
  mixed[1] = space;
  OK(cag_curve_join(mixed, 2, &c, &err));
  assert_int_equal(c->dimension, 3);
  near_vec(at(c, 3), at(parts[1], 3), 0);
  cag_curve_release(c);
  cag_curve_release(space);
  cag_curve_release(line);
  cag_curve_release(rest);
  for (int i = 0; i < 3; i++) cag_curve_release(parts[i]);
}

// Lines and polylines join to one polyline, which is closed if it returns to its start.
static void straight_pieces_make_a_polyline(void **state) {
  (void)state;
  const CagVec3 p[5] = {{0, 0, 0}, {2, 0, 0}, {3, 2, 0}, {1, 3, 0}, {-1, 1, 0}};
  const CagVec3 *points;
  for (int closed = 0; closed < 2; closed++) {
    CagCurve *parts[3], *c;
    size_t n;
    bool ring;
    const CagVec3 last[3] = {p[2], p[3], closed ? p[0] : p[4]};
    OK(cag_curve_line(p[0], p[1], 2, &parts[0], &err));
    OK(cag_curve_line(p[1], p[2], 2, &parts[1], &err));
    OK(cag_curve_polyline(last, 3, false, 2, &parts[2], &err));
    OK(cag_curve_join(parts, 3, &c, &err));
    assert_true(cag_curve_vertices(c, &points, &n, &ring));
    assert_true(ring == closed && c->closed == closed && c->start == 0 && c->end == 4);
    assert_int_equal(n, closed ? 4 : 5);
    for (size_t i = 0; i < n; i++) near_vec(points[i], i < 4 ? p[i] : p[4], 0);
    cag_curve_release(c);
    // With different speeds, they remain separate pieces.
    CagCurve *slow[2] = {parts[0], NULL};
    OK(cag_curve_reparametrize(parts[1], 0, 3, &slow[1], &err));
    OK(cag_curve_join(slow, 2, &c, &err));
    assert_false(cag_curve_vertices(c, &points, &n, &ring));
    near_vec(at(c, 1), p[1], 0);
    near_vec(at(c, 2.5), cag_lerp(p[1], p[2], 0.5), 1e-15);
    assert_true(c->end == 4);
    cag_curve_release(c);
    cag_curve_release(slow[1]);
    for (int i = 0; i < 3; i++) cag_curve_release(parts[i]);
  }
  // A line there and back is not a closed polyline. A closed polyline can be one of the parts.
  CagCurve *way[2], *c;
  OK(cag_curve_line(p[0], p[1], 2, &way[0], &err));
  OK(cag_curve_line(p[1], p[0], 2, &way[1], &err));
  OK(cag_curve_join(way, 2, &c, &err));
  assert_true(c->end == 2);
  near_vec(at(c, 1), p[1], 0);
  near_vec(at(c, 2), p[0], 0);
  cag_curve_release(c);
  cag_curve_release(way[1]);
  OK(cag_curve_polyline(p, 4, true, 2, &way[1], &err));
  CagCurve *around[2] = {way[1], way[0]};
  OK(cag_curve_join(around, 2, &c, &err));
  assert_true(c->end == 5);
  near_vec(at(c, 4), p[0], 0);
  near_vec(at(c, 5), p[1], 0);
  cag_curve_release(c);
  cag_curve_release(way[0]);
  cag_curve_release(way[1]);
}

// --- Intersections ---

static CagCurve *circle(double r, double x, double y) {
  CagTransform frame = cag_translate(cag_vec3(x, y, 0));
  frame.planar = true;
  CagCurve *c;
  OK(cag_curve_arc(r, r, 0, 2 * M_PI, &frame, &c, &err));
  return c;
}

// A helix of 3 turns and pitch 2 crosses the plane x = 0 at the odd quarter turns, and touches the
// plane x = radius at the whole turns.
static void a_helix_meets_planes(void **state) {
  (void)state;
  CagCurve *c;
  CagPlane plane;
  CagMeeting *m;
  size_t n;
  OK(cag_curve_helix(1.5, 2, 3, 0, &c, &err));
  OK(cag_plane(cag_vec3(0, 0, 0), cag_vec3(1, 0, 0), &plane, &err));
  OK(cag_curve_intersect_plane(c, &plane, &m, &n, &err));
  assert_int_equal(n, 6);
  for (size_t i = 0; i < n; i++) NEAR(m[i].t, M_PI / 2 + (double)i * M_PI, 1e-12);
  free(m);
  OK(cag_plane(cag_vec3(1.5, 0, 0), cag_vec3(1, 0, 0), &plane, &err));
  OK(cag_curve_intersect_plane(c, &plane, &m, &n, &err));
  assert_int_equal(n, 4);
  for (size_t i = 0; i < n; i++) NEAR(m[i].t, 2 * M_PI * (double)i, 1e-6);
  free(m);
  OK(cag_plane(cag_vec3(2, 0, 0), cag_vec3(1, 0, 0), &plane, &err));
  OK(cag_curve_intersect_plane(c, &plane, &m, &n, &err));
  assert_int_equal(n, 0);
  free(m);
  cag_curve_release(c);
  c = circle(1, 0, 0);
  OK(cag_plane(cag_vec3(0, 0, 0), cag_vec3(0, 0, 1), &plane, &err));
  FAILS(cag_curve_intersect_plane(c, &plane, &m, &n, &err), "overlap");
  cag_curve_release(c);
}

// Circles of radius 5 about (0, 0) and (6, 0) meet at (3, +-4); tangent circles meet once.
static void circles_meet(void **state) {
  (void)state;
  CagCurve *a = circle(5, 0, 0), *b = circle(5, 6, 0), *t = circle(2, 7, 0),
           *far = circle(1, 20, 0);
  CagMeeting *m;
  size_t n;
  OK(cag_curve_intersect(a, b, &m, &n, &err));
  assert_int_equal(n, 2);
  near_vec(m[0].point, cag_vec3(3, 4, 0), 1e-12);
  near_vec(m[1].point, cag_vec3(3, -4, 0), 1e-12);
  NEAR(m[0].t2, M_PI - atan2(4, 3), 1e-12);
  free(m);
  OK(cag_curve_intersect(a, t, &m, &n, &err));
  assert_int_equal(n, 1); // the seam of the first counts once
  near_vec(m[0].point, cag_vec3(5, 0, 0), 1e-6);
  free(m);
  OK(cag_curve_intersect(a, far, &m, &n, &err));
  assert_int_equal(n, 0);
  free(m);
  FAILS(cag_curve_intersect(a, a, &m, &n, &err), "overlap");
  CagCurve *all[4] = {a, b, t, far};
  for (int i = 0; i < 4; i++) cag_curve_release(all[i]);
}

// Two cubics with nine intersections (Bezout's bound): T3(x) = y and T3(y) = x, where T3 is the
// Chebyshev polynomial. All nine are at cosines.
static void two_cubics_meet_nine_times(void **state) {
  (void)state;
  CagVec3 p[4], q[4];
  // (x, 4 x^3 - 3 x) over -1.1..1.1 from blossoms: y = 4 abc - (a + b + c).
  for (int i = 0; i < 4; i++) {
    double a = i > 0 ? 1.1 : -1.1, b = i > 1 ? 1.1 : -1.1, c = i > 2 ? 1.1 : -1.1;
    p[i] = cag_vec3((a + b + c) / 3, 4 * a * b * c - (a + b + c), 0);
    q[i] = cag_vec3(p[i].y, p[i].x, 0);
  }
  CagCurve *a, *b;
  CagMeeting *m;
  size_t n;
  OK(cag_curve_bezier(p, NULL, 4, 2, &a, &err));
  OK(cag_curve_bezier(q, NULL, 4, 2, &b, &err));
  OK(cag_curve_intersect(a, b, &m, &n, &err));
  assert_int_equal(n, 9);
  for (size_t i = 0; i < n; i++) {
    double x = m[i].point.x, y = m[i].point.y;
    NEAR(4 * x * x * x - 3 * x, y, 1e-11);
    NEAR(4 * y * y * y - 3 * y, x, 1e-11);
    if (i > 0) assert_true(m[i].t > m[i - 1].t + 1e-3);
  }
  free(m);
  cag_curve_release(a);
  cag_curve_release(b);
}

static void polylines_meet_at_vertices_once(void **state) {
  (void)state;
  static const CagVec3 v[3] = {{0, 0, 0}, {1, 1, 0}, {2, 0, 0}};
  CagCurve *a, *b;
  CagMeeting *m;
  size_t n;
  OK(cag_curve_polyline(v, 3, false, 2, &a, &err));
  OK(cag_curve_line(cag_vec3(1, -1, 0), cag_vec3(1, 3, 0), 2, &b, &err));
  OK(cag_curve_intersect(a, b, &m, &n, &err));
  assert_int_equal(n, 1);
  NEAR(m[0].t, 1, 1e-14);
  NEAR(m[0].t2, 0.5, 1e-14);
  free(m);
  cag_curve_release(a);
  cag_curve_release(b);
}

// A joined arc and polylines, each over a domain of its own. At each corner, the two limits are the
// directions before and after it.
static void corners_within_joined_curves_have_both_limits(void **state) {
  (void)state;
  enum { PIECES = 5, MOST = 4 * PIECES + 1 };
  seed = 103;
  for (int round = 0; round < 60; round++) {
    CagVec3 p[MOST];
    CagCurve *parts[PIECES], *c;
    size_t n = 0;
    const CagTransform frame = cag_translate(cag_vec3(-1, 0, 0));
    OK(cag_curve_arc(1, 1, uniform(-3, -0.5), 0, &frame, &parts[0], &err));
    p[0] = cag_vec3(0, 0, 0);
    for (int i = 1; i < PIECES; i++) {
      const size_t first = n, edges = 1 + (size_t)uniform(0, 3.99);
      for (size_t k = 0; k < edges; k++, n++) {
        const double x = uniform(-1, 1), y = uniform(-1, 1);
        p[n + 1] = cag_add(p[n], cag_vec3(x, y, uniform(-1, 1)));
      }
      CagCurve *plain;
      const double from = uniform(-2, 2), to = from + uniform(0.1, 3);
      OK(cag_curve_polyline(p + first, edges + 1, false, 3, &plain, &err));
      OK(cag_curve_reparametrize(plain, from, to, &parts[i], &err));
      cag_curve_release(plain);
    }
    OK(cag_curve_join(parts, PIECES, &c, &err));
    double at[MOST];
    const size_t found = c->kind->breaks(c, at, MOST);
    assert_int_equal(found, n);
    assert_int_equal(c->kind->breaks(c, NULL, 0), found);
    for (size_t i = 0; i < found; i++) {
      CagVec3 here, before, after;
      assert_true(at[i] > (i ? at[i - 1] : c->start) && at[i] < c->end);
      OK(cag_curve_point(c, at[i], &here, &err));
      OK(cag_curve_tangent(c, at[i], CAG_SIDE_LEFT, &before, &err));
      OK(cag_curve_tangent(c, at[i], CAG_SIDE_RIGHT, &after, &err));
      near_vec(here, p[i], 0);
      near_vec(before, i ? cag_unit(cag_sub(p[i], p[i - 1])) : cag_vec3(0, 1, 0), 1e-15);
      near_vec(after, cag_unit(cag_sub(p[i + 1], p[i])), 1e-15);
    }
    // Fewer results are written if there is less space.
    double few[MOST];
    for (size_t room = 0; room < found; room++) {
      few[room] = -77;
      assert_int_equal(c->kind->breaks(c, few, room), found);
      assert_true(few[room] == -77 && memcmp(few, at, room * sizeof *few) == 0);
    }
    cag_curve_release(c);
    for (int i = 0; i < PIECES; i++) cag_curve_release(parts[i]);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(corners_within_joined_curves_have_both_limits),
      cmocka_unit_test(random_splines_keep_their_points),
      cmocka_unit_test(degrees_go_up_and_down),
      cmocka_unit_test(random_composites_are_their_pieces),
      cmocka_unit_test(domains_that_go_on_are_kept),
      cmocka_unit_test(straight_pieces_make_a_polyline),
      cmocka_unit_test(splitting_keeps_the_points),
      cmocka_unit_test(elevating_keeps_the_points_and_the_smoothness),
      cmocka_unit_test(elevation_of_a_spline_is_that_of_the_reference),
      cmocka_unit_test(midpoints_give_the_points_of_the_reference),
      cmocka_unit_test(insertion_keeps_the_points),
      cmocka_unit_test(bezier_pieces_are_the_curve),
      cmocka_unit_test(a_helix_meets_planes),
      cmocka_unit_test(circles_meet),
      cmocka_unit_test(two_cubics_meet_nine_times),
      cmocka_unit_test(polylines_meet_at_vertices_once),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
