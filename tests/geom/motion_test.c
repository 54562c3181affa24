// Frames along random paths: the defining property of each kind, derivatives, and corners.

#include "geom/surface/motion.h"
#include "geom/surface/motion_parts.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

static CagVec3 anywhere(double size) {
  CagVec3 p;
  p.x = uniform(-size, size);
  p.y = uniform(-size, size);
  p.z = uniform(-size, size);
  return p;
}

// A wavy path of degree 5 along a direction, with inner knots; closed paths are periodic.
static CagCurve *random_path(bool closed) {
  enum { N = 9, P = 5 };
  const double knots[N + P + 1] = {1, 1, 1, 1, 1, 1, 2, 2.5, 3.5, 4, 4, 4, 4, 4, 4};
  CagVec3 p[N];
  const CagVec3 along = cag_unit(anywhere(1)), x = cag_unit(cag_cross(along, anywhere(1))),
                y = cag_cross(along, x);
  for (int i = 0; i < N; i++) {
    const double angle = 2 * M_PI * i / N;
    p[i] = closed ? cag_add(cag_scaled(x, 9 * cos(angle)), cag_scaled(y, 9 * sin(angle)))
                  : cag_scaled(along, 4 * i);
    p[i] = cag_add(p[i], anywhere(2));
  }
  CagCurve *c;
  if (closed) OK(cag_curve_nurbs_closed(p, NULL, N, P, 3, &c, &err));
  else OK(cag_curve_nurbs(p, NULL, N, P, knots, 3, &c, &err));
  return c;
}

static double along_path(const CagCurve *c, double start, double end, double t) {
  return start + (end - start) * (t - c->start) / (c->end - c->start);
}

static CagVec3 sum_at(const CagVec3 *series, int n, double h) {
  CagVec3 sum = {0, 0, 0};
  for (int k = n; k >= 0; k--) sum = cag_madd(series[k], h, sum);
  return sum;
}

enum { ORDER = 5 };

// The axes without twist and scale, with their first derivatives.
static void bare(const CagCurve *c, const CagPathMotion *how, const CagMotionSeries *m, double t,
                 CagVec3 x[2], CagVec3 y[2], CagVec3 *z) {
  const double length = c->end - c->start;
  const double k = along_path(c, how->scale.start, how->scale.end, t);
  const double k1 = (how->scale.end - how->scale.start) / length;
  const double angle = along_path(c, how->twist.start, how->twist.end, t);
  const double turn = (how->twist.end - how->twist.start) / length;
  const CagVec3 a[2] = {cag_scaled(m->x[0], 1 / k),
                        cag_scaled(cag_madd(m->x[1], -k1 / k, m->x[0]), 1 / k)};
  const CagVec3 b[2] = {cag_scaled(m->y[0], 1 / k),
                        cag_scaled(cag_madd(m->y[1], -k1 / k, m->y[0]), 1 / k)};
  for (int i = 0; i < 2; i++) {
    x[i] = cag_sub(cag_scaled(a[i], cos(angle)), cag_scaled(b[i], sin(angle)));
    y[i] = cag_add(cag_scaled(a[i], sin(angle)), cag_scaled(b[i], cos(angle)));
  }
  // The untwisting has a derivative, too: x' loses turn y, and y' gains turn x.
  const CagVec3 x0 = x[0], y0 = y[0];
  x[1] = cag_madd(x[1], -turn, y0);
  y[1] = cag_madd(y[1], turn, x0);
  *z = cag_scaled(m->z[0], 1 / k);
}

static void check_series(const CagMotion *m, const CagCurve *c, double t) {
  CagMotionSeries at, beside;
  CagVec3 d[ORDER + 1];
  const double h = 1e-3 * (c->end - c->start);
  // Both parameters are on one side of all knots.
  double breaks[16];
  const size_t n = cag_motion_breaks(m, breaks, 16);
  for (size_t i = 0; i < n; i++)
    if (breaks[i] > t - 1e-12 && breaks[i] < t + h) return;
  if (t + h > c->end) return;
  OK(cag_motion_at(m, t, ORDER, CAG_SIDE_RIGHT, &at, &err));
  OK(cag_motion_at(m, t + h, 0, CAG_SIDE_RIGHT, &beside, &err));
  near_vec(sum_at(at.origin, ORDER, h), beside.origin[0], 1e-9);
  near_vec(sum_at(at.x, ORDER, h), beside.x[0], 1e-7);
  near_vec(sum_at(at.y, ORDER, h), beside.y[0], 1e-7);
  near_vec(sum_at(at.z, ORDER, h), beside.z[0], 1e-7);
  OK(cag_curve_eval(c, t, ORDER, CAG_SIDE_RIGHT, d, &err));
  double factorial = 1;
  for (int k = 0; k <= ORDER; k++) {
    factorial *= k ? k : 1;
    near_vec(at.origin[k], cag_scaled(d[k], 1 / factorial), 1e-10 * (1 + cag_norm(d[k])));
  }
}

// X rotated about the axis perpendicular to Z and the tangent.
static CagVec3 start_spoke(CagVec3 tangent) {
  CagTransform turn;
  OK(cag_rotate(cag_cross(cag_vec3(0, 0, 1), tangent), acos(tangent.z), cag_vec3(0, 0, 0), &turn,
                &err));
  return cag_transform_vector(&turn, cag_vec3(1, 0, 0));
}

static void frames_are_what_defines_them(void **state) {
  (void)state;
  seed = 41;
  int made[4] = {0, 0, 0, 0};
  for (int round = 0; round < 120; round++) {
    const bool closed = round % 3 == 0;
    CagPathMotion how = {.orient = (CagOrient)(round % 4), .up = anywhere(1)};
    const bool plain = round % 5 == 0;
    how.twist.start = plain ? 0 : uniform(-2, 2);
    how.twist.end = plain ? 0 : uniform(-2, 2);
    how.scale.start = plain ? 1 : uniform(0.5, 2);
    how.scale.end = plain ? 1 : uniform(0.5, 2);
    CagCurve *c = random_path(closed);
    CagMotion *m;
    CagVec3 d[3], x[2], y[2], z, first[2] = {{0}}, home;
    CagMotionSeries at;
    CagError refused;
    if (cag_motion_along(c, &how, &m, &refused)) {
      // The Frenet frame may be undefined, and the path may run along the direction.
      assert_true(how.orient == CAG_ORIENT_FRENET || how.orient == CAG_ORIENT_UP);
      cag_curve_release(c);
      continue;
    }
    made[how.orient]++;
    assert_int_equal(cag_motion_is_plain(m), plain);
    assert_false(cag_motion_has_corner(m));
    double start, end, drift = NAN;
    bool angular;
    cag_motion_domain(m, &start, &end, &angular);
    assert_true(start == c->start && end == c->end && !angular);
    OK(cag_curve_eval(c, c->start, 1, CAG_SIDE_RIGHT, d, &err));
    const CagVec3 outset = cag_unit(d[1]);
    home = start_spoke(outset);
    for (int i = 0; i < 12; i++) {
      const double t = i == 0 ? start : i == 11 ? end : uniform(start, end);
      const CagSide side = i == 11 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
      OK(cag_motion_at(m, t, 1, side, &at, &err));
      OK(cag_curve_eval(c, t, 2, side, d, &err));
      bare(c, &how, &at, t, x, y, &z);
      NEAR(cag_dot(x[0], x[0]), 1, 1e-12);
      NEAR(cag_dot(y[0], y[0]), 1, 1e-12);
      NEAR(cag_dot(x[0], y[0]), 0, 1e-12);
      near_vec(cag_cross(x[0], y[0]), z, 1e-12);
      const CagVec3 tangent = how.orient == CAG_ORIENT_FIXED ? outset : cag_unit(d[1]);
      near_vec(z, tangent, 1e-12);
      const CagVec3 up = cag_madd(how.up, -cag_dot(how.up, tangent), tangent);
      const CagVec3 bend = cag_madd(d[2], -cag_dot(d[2], tangent), tangent);
      switch (how.orient) {
      case CAG_ORIENT_RMF:
        if (i == 0) near_vec(x[0], home, 1e-12);
        // Its rotation about the tangent is 0, or constant so that a closed path returns to its
        // first frame.
        if (i == 0) drift = closed ? cag_dot(x[1], y[0]) : 0;
        NEAR(cag_dot(x[1], y[0]), drift, 1e-9);
        if (i == 11 && closed) near_vec(x[0], home, 1e-9);
        break;
      case CAG_ORIENT_FRENET: near_vec(x[0], cag_unit(bend), 1e-9); break;
      case CAG_ORIENT_UP: near_vec(y[0], cag_unit(up), 1e-11); break;
      default:
        if (i == 0) first[0] = x[0], first[1] = y[0];
        near_vec(x[0], home, 1e-12);
        near_vec(x[0], first[0], 1e-13);
        near_vec(y[0], first[1], 1e-13);
      }
      // The frame as a matrix.
      CagTransform frame;
      OK(cag_motion_frame(m, t, &frame, &err));
      const CagVec3 p = cag_vec3(0.3, -0.7, 1.1);
      CagVec3 q = cag_madd(cag_madd(at.origin[0], p.x, at.x[0]), p.y, at.y[0]);
      q = cag_madd(q, p.z, at.z[0]);
      near_vec(cag_transform_point(&frame, p), q, 1e-12);
      if (how.orient != CAG_ORIENT_FRENET) check_series(m, c, t);
    }
    double breaks[16];
    const size_t n = cag_motion_breaks(m, breaks, 16);
    if (!closed) {
      assert_int_equal(n, 3);
      NEAR(breaks[0], 2, 0);
      NEAR(breaks[1], 2.5, 0);
      NEAR(breaks[2], 3.5, 0);
    }
    cag_motion_release(m);
    cag_curve_release(c);
  }
  for (int k = 0; k < 4; k++) assert_true(made[k] > 10);
}

// At a corner, the sections of both sides coincide in the bisecting plane. Between corners, they
// are perpendicular to the path, except for their tilt.
static void corners_are_halved(void **state) {
  (void)state;
  seed = 42;
  for (int round = 0; round < 60; round++) {
    enum { N = 5 };
    const bool closed = round % 2;
    CagVec3 p[N];
    for (int i = 0; i < N; i++) {
      const double angle = 2 * M_PI * i / N;
      p[i] = cag_vec3(10 * cos(angle), 10 * sin(angle), 0);
      p[i] = cag_add(p[i], anywhere(3));
    }
    const CagPathMotion how = {.orient = CAG_ORIENT_RMF, .scale = {1, 1, NULL}};
    CagCurve *c;
    CagMotion *m;
    OK(cag_curve_polyline(p, N, closed, 3, &c, &err));
    OK(cag_motion_along(c, &how, &m, &err));
    assert_true(cag_motion_has_corner(m));
    double breaks[N + 2];
    const size_t n = cag_motion_breaks(m, breaks + 1, N);
    assert_int_equal(n, closed ? N - 1 : N - 2);
    breaks[0] = c->start;
    breaks[n + 1] = c->end;
    for (size_t i = 0; i <= n + 1; i++) {
      const bool end = i == 0 || i == n + 1;
      if (end && !closed) continue;
      CagMotionSeries in, out;
      CagVec3 a[2], b[2];
      const double t_in = i == 0 ? c->end : breaks[i], t_out = i == n + 1 ? c->start : breaks[i];
      OK(cag_motion_at(m, t_in, 0, CAG_SIDE_LEFT, &in, &err));
      OK(cag_motion_at(m, t_out, 0, CAG_SIDE_RIGHT, &out, &err));
      OK(cag_curve_eval(c, t_in, 1, CAG_SIDE_LEFT, a, &err));
      OK(cag_curve_eval(c, t_out, 1, CAG_SIDE_RIGHT, b, &err));
      const CagVec3 from = cag_unit(a[1]), to = cag_unit(b[1]);
      const CagVec3 across = cag_unit(cag_add(from, to));
      near_vec(in.origin[0], out.origin[0], 1e-12);
      // A frame on a closed path is rotated evenly, so only the joint of the ends differs.
      near_vec(in.x[0], out.x[0], end ? 1e-9 : 1e-11);
      near_vec(in.y[0], out.y[0], end ? 1e-9 : 1e-11);
      NEAR(cag_dot(in.x[0], across), 0, 1e-11);
      NEAR(cag_dot(in.y[0], across), 0, 1e-11);
      // Seen along the path, the section has its full size.
      const CagVec3 x = cag_madd(in.x[0], -cag_dot(in.x[0], from), from);
      const CagVec3 y = cag_madd(in.y[0], -cag_dot(in.y[0], from), from);
      NEAR(cag_norm(x), 1, 1e-11);
      NEAR(cag_norm(y), 1, 1e-11);
      NEAR(cag_dot(x, y), 0, 1e-11);
    }
    // Along a straight piece, the ends of the axes move on lines parallel to it.
    for (size_t i = 0; i <= n; i++) {
      CagMotionSeries s[3];
      for (int k = 0; k < 3; k++) {
        const double f = k == 0 ? 0.1 : k == 1 ? 0.45 : 0.8;
        OK(cag_motion_at(m, breaks[i] + f * (breaks[i + 1] - breaks[i]), 1, CAG_SIDE_RIGHT, &s[k],
                         &err));
      }
      near_vec(cag_lerp(s[0].x[0], s[2].x[0], 0.5), s[1].x[0], closed ? 1 : 1e-11);
      near_vec(cag_lerp(s[0].y[0], s[2].y[0], 0.5), s[1].y[0], closed ? 1 : 1e-11);
    }
    cag_motion_release(m);
    cag_curve_release(c);
  }
}

static bool is_within(const CagInterval3 *range, CagVec3 p) {
  const double slack = 1e-9 * (1 + cag_norm(p));
  const double lo[] = {range->x.lo, range->y.lo, range->z.lo};
  const double hi[] = {range->x.hi, range->y.hi, range->z.hi}, x[] = {p.x, p.y, p.z};
  for (int i = 0; i < 3; i++)
    if (!(x[i] >= lo[i] - slack && x[i] <= hi[i] + slack)) return false;
  return true;
}

// The frame that cag_motion_at computes anywhere in an interval is within the ranges of the
// interval, and so are its Taylor coefficients. Short intervals have narrow ranges.
static void ranges_hold_the_frames_of_an_interval(void **state) {
  (void)state;
  enum { N = 2, INTERVALS = 8, SAMPLES = 5 };
  seed = 43;
  int held = 0;
  for (int round = 0; round < 60; round++) {
    CagPathMotion how = {.orient = (CagOrient)(round % 4), .up = anywhere(1)};
    how.twist = (CagAlong){.start = uniform(-2, 2), .end = uniform(-2, 2)};
    how.scale = (CagAlong){.start = uniform(0.5, 2), .end = uniform(0.5, 2)};
    CagCurve *c = random_path(round % 3 == 0);
    CagMotion *m;
    CagError refused;
    double *joints;
    size_t n;
    if (cag_motion_along(c, &how, &m, &refused)) {
      cag_curve_release(c);
      continue;
    }
    OK(cag_motion_joints(m, &joints, &n, &err));
    for (size_t i = 0; i < n * INTERVALS; i++) {
      const double start = joints[i / INTERVALS], end = joints[i / INTERVALS + 1];
      const double a = start + (end - start) * (double)(i % INTERVALS) / INTERVALS;
      const double b = a + (end - start) / 64;
      CagMotionRanges r;
      CagMotionSeries at;
      if (!cag_motion_ranges(m, a, b, N, &r)) continue;
      held++;
      for (int k = 0; k <= SAMPLES; k++) {
        OK(cag_motion_at(m, a + (b - a) * k / SAMPLES, N, CAG_SIDE_RIGHT, &at, &err));
        for (int j = 0; j <= N; j++) {
          assert_true(is_within(&r.origin[j], at.origin[j]));
          assert_true(is_within(&r.x[j], at.x[j]));
          assert_true(is_within(&r.y[j], at.y[j]));
          assert_true(is_within(&r.z[j], at.z[j]));
        }
      }
      // The image of the x axis moves by less than its size.
      assert_true(r.x[0].x.hi - r.x[0].x.lo < 2.5);
    }
    free(joints);
    cag_motion_release(m);
    cag_curve_release(c);
  }
  assert_true(held > 200);
}

static void what_has_no_frame_is_told(void **state) {
  (void)state;
  CagCurve *line, *back, *arc;
  CagMotion *m;
  const CagVec3 turn[] = {{0, 0, 0}, {4, 0, 0}, {1, 0, 0}};
  CagPathMotion how = {.orient = CAG_ORIENT_FRENET, .scale = {1, 1, NULL}};
  OK(cag_curve_line(cag_vec3(0, 0, 0), cag_vec3(1, 2, 3), 3, &line, &err));
  FAILS(cag_motion_along(line, &how, &m, &err), "path-straight");
  how.orient = CAG_ORIENT_UP;
  how.up = cag_vec3(2, 4, 6);
  FAILS(cag_motion_along(line, &how, &m, &err), "path-along-up");
  how.up = cag_vec3(0, 0, 0);
  FAILS(cag_motion_along(line, &how, &m, &err), "zero-axis");
  how.orient = CAG_ORIENT_RMF;
  how.twist.end = INFINITY;
  FAILS(cag_motion_along(line, &how, &m, &err), "not-finite");
  how.twist.end = 0;
  how.scale.end = -0.5;
  FAILS(cag_motion_along(line, &how, &m, &err), "scale-negative");
  how.scale.end = 0;
  OK(cag_motion_along(line, &how, &m, &err));
  cag_motion_release(m);
  how.scale.end = 1;
  OK(cag_curve_polyline(turn, 3, false, 3, &back, &err));
  FAILS(cag_motion_along(back, &how, &m, &err), "path-turns-back");
  // A frame that does not rotate with the path allows corners.
  how.orient = CAG_ORIENT_FIXED;
  OK(cag_motion_along(back, &how, &m, &err));
  assert_false(cag_motion_has_corner(m));
  cag_motion_release(m);
  cag_curve_release(back);
  // The Frenet frame requires that the normals of both sides be mirrored at a corner.
  const CagVec3 net[] = {{0, 0, 0}, {1, 0, 0}, {2, 1, 0}, {2, 1, 1}, {3, 3, 3}};
  const double knots[] = {0, 0, 0, 1, 1, 2, 2, 2};
  how.orient = CAG_ORIENT_FRENET;
  OK(cag_curve_nurbs(net, NULL, 5, 2, knots, 3, &arc, &err));
  FAILS(cag_motion_along(arc, &how, &m, &err), "path-corner");
  cag_curve_release(arc);
  cag_curve_release(line);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(frames_are_what_defines_them),
      cmocka_unit_test(corners_are_halved),
      cmocka_unit_test(ranges_hold_the_frames_of_an_interval),
      cmocka_unit_test(what_has_no_frame_is_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
