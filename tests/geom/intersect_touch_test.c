// Planes that touch curves of all kinds, and curves that touch each other: the point is found,
// once.

#include "geom/curve/intersect.h"
#include "tests/geom/curve_random.h"

static void planes_touch_where_the_height_turns(void **state) {
  (void)state;
  seed = 521;
  int touches = 0;
  for (int round = 0; round < 600; round++) {
    CagCurve *c = random_curve((Kind)(round % KINDS));
    const double range = c->end - c->start, t = c->start + range * uniform(0.05, 0.95);
    CagVec3 d[3];
    CagPlane plane;
    derivatives(c, t, 2, d);
    const double speed = cag_norm(d[1]);
    const CagVec3 n = cag_unit(cag_cross(d[1], random_point(1)));
    const double bend = cag_dot(d[2], n) / speed * range;
    if (!(fabs(bend) > 0.2 * speed)) {
      cag_curve_release(c);
      continue;
    }
    OK(cag_plane(d[0], n, &plane, &err));
    CagMeeting *m;
    size_t count, here = 0;
    OK(cag_curve_intersect_plane(c, &plane, &m, &count, &err));
    for (size_t i = 0; i < count; i++) {
      if (fabs(m[i].t - t) > 1e-5 * range) continue;
      here++;
      NEAR(m[i].t, t, 1e-11 * range);
      assert_int_equal(m[i].multiplicity, 2);
      near_vec(m[i].point, d[0], 1e-9 * speed * range);
    }
    assert_int_equal(here, 1);
    touches++;
    free(m);
    cag_curve_release(c);
  }
  assert_true(touches > 300);
}

// A plane curve.
static CagCurve *flat_curve(int kind) {
  CagVec3 p[6];
  double w[6];
  for (int i = 0; i < 6; i++) {
    p[i] = random_point(3);
    p[i].z = 0;
    w[i] = uniform(0.4, 2.5);
  }
  const CagTransform f = cag_transform_identity();
  const double a = uniform(0.5, 3), b = uniform(0.5, 3), from = uniform(-3, 3);
  CagCurve *c;
  if (kind == 0) OK(cag_curve_bezier(p, NULL, 4, 2, &c, &err));
  else if (kind == 1) OK(cag_curve_bezier(p, w, 5, 2, &c, &err));
  else if (kind == 2) OK(cag_curve_arc(a, b, from, from + uniform(1, 6), &f, &c, &err));
  else OK(cag_curve_nurbs_closed(p, NULL, 6, 3, 2, &c, &err));
  return c;
}

// One curve is moved such that it has a point and tangent of the other, but another curvature.
static void curves_touch_where_both_have_one_tangent(void **state) {
  (void)state;
  seed = 522;
  int touches = 0;
  for (int round = 0; round < 400; round++) {
    CagCurve *a = flat_curve(round % 4), *other = flat_curve(round / 4 % 4), *b;
    const double range_a = a->end - a->start, range_b = other->end - other->start;
    const double t = a->start + range_a * uniform(0.1, 0.9);
    const double u = other->start + range_b * uniform(0.1, 0.9);
    CagVec3 d[3], e[3];
    derivatives(a, t, 2, d);
    derivatives(other, u, 2, e);
    const double turn = atan2(d[1].y, d[1].x) - atan2(e[1].y, e[1].x) + (round % 3 ? 0 : M_PI);
    CagTransform move = cag_transform_identity();
    move.m[0][0] = move.m[1][1] = cos(turn);
    move.m[1][0] = sin(turn);
    move.m[0][1] = -sin(turn);
    const CagVec3 moved = cag_transform_point(&move, e[0]);
    move.m[0][3] = d[0].x - moved.x;
    move.m[1][3] = d[0].y - moved.y;
    OK(cag_curve_transform(other, &move, &b, &err));
    const double bend_a = cag_cross(d[1], d[2]).z / pow(cag_norm(d[1]), 3);
    const double bend_b = cag_cross(e[1], e[2]).z / pow(cag_norm(e[1]), 3);
    const double apart = fabs(bend_a - (round % 3 ? bend_b : -bend_b));
    if (apart > 0.2 && fabs(bend_a) < 5 && fabs(bend_b) < 5) {
      CagMeeting *m;
      size_t count, here = 0;
      OK(cag_curve_intersect(a, b, &m, &count, &err));
      for (size_t i = 0; i < count; i++) {
        if (cag_norm(cag_sub(m[i].point, d[0])) > 1e-3) continue;
        if (fabs(m[i].t - t) > 1e-2 * range_a || fabs(m[i].t2 - u) > 1e-2 * range_b) continue;
        here++;
        NEAR(m[i].t, t, 1e-11 * range_a);
        NEAR(m[i].t2, u, 1e-11 * range_b);
        assert_int_equal(m[i].multiplicity, 2);
      }
      assert_int_equal(here, 1);
      touches++;
      free(m);
    }
    cag_curve_release(a);
    cag_curve_release(b);
    cag_curve_release(other);
  }
  assert_true(touches > 150);
}

// Closed curves touch a line at or near their seam, over any domain, once.
static void closed_curves_touch_lines_at_their_seam(void **state) {
  (void)state;
  seed = 523;
  int touches = 0;
  for (int round = 0; round < 200; round++) {
    CagCurve *ring, *b, *line;
    const CagTransform f = cag_transform_identity();
    const double semi = uniform(0.5, 3), from = uniform(-3, 3), low = uniform(-20, 20);
    if (round % 2) ring = flat_curve(3);
    else OK(cag_curve_arc(semi, uniform(0.5, 3), from, from + 2 * M_PI, &f, &ring, &err));
    OK(cag_curve_reparametrize(ring, low, low + uniform(0.5, 9), &b, &err));
    assert_true(b->closed);
    const double range = b->end - b->start;
    static const double places[] = {0, 1, 1e-9, 1 - 1e-9, 1e-5, 1 - 1e-5};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
      const double u = places[i] == 1 ? b->end : b->start + range * places[i];
      CagVec3 d[3];
      derivatives(b, u, 2, d);
      const CagVec3 e = cag_unit(d[1]);
      const double bend = cag_cross(d[1], d[2]).z / pow(cag_norm(d[1]), 3);
      if (fabs(bend) < 0.1 || fabs(bend) > 5) continue;
      OK(cag_curve_line(cag_madd(d[0], -uniform(1, 5), e), cag_madd(d[0], uniform(1, 5), e), 2,
                        &line, &err));
      for (int other = 0; other < 2; other++) {
        CagMeeting *m;
        size_t count, here = 0;
        OK(other ? cag_curve_intersect(b, line, &m, &count, &err)
                 : cag_curve_intersect(line, b, &m, &count, &err));
        for (size_t k = 0; k < count; k++) {
          if (cag_norm(cag_sub(m[k].point, d[0])) > 1e-3) continue;
          const double off = ((other ? m[k].t : m[k].t2) - u) / range;
          here++;
          NEAR(off - rint(off), 0, 1e-7);
          assert_int_equal(m[k].multiplicity, 2);
        }
        assert_int_equal(here, 1);
        touches++;
        free(m);
      }
      cag_curve_release(line);
    }
    cag_curve_release(b);
    cag_curve_release(ring);
  }
  assert_true(touches > 1000);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(planes_touch_where_the_height_turns),
      cmocka_unit_test(curves_touch_where_both_have_one_tangent),
      cmocka_unit_test(closed_curves_touch_lines_at_their_seam),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
