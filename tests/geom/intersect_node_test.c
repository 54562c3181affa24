// Curves through points where another curve intersects itself: each branch counts.

#include "tests/geom/random.h"
#include "tests/geom/support.h"

#include "geom/curve/curve.h"
#include "geom/curve/intersect.h"

// A closed polyline that passes the node twice, in the middle of its edges a b and c d. There are
// `between` and `after` additional vertices on the edges b c and d a, so that the two passes may be
// any fraction of the domain apart. It begins at any vertex.
static CagCurve *bow_at(CagVec3 node, int between, int after, bool spline) {
  enum { MOST = 16 };
  CagVec3 round[MOST], p[MOST];
  const double turn = uniform(-3, 3), angle = uniform(0.5, 2.6), size = uniform(1, 2);
  const CagVec3 u = cag_vec3(size * cos(turn), size * sin(turn), 0);
  const CagVec3 v = cag_vec3(size * cos(turn + angle), size * sin(turn + angle), 0);
  const CagVec3 a = cag_sub(node, u), b = cag_add(node, u), c = cag_add(node, v),
                d = cag_sub(node, v);
  int n = 0;
  round[n++] = a;
  round[n++] = b;
  for (int i = 1; i <= between; i++) round[n++] = cag_lerp(b, c, (double)i / (between + 1));
  round[n++] = c;
  round[n++] = d;
  for (int i = 1; i <= after; i++) round[n++] = cag_lerp(d, a, (double)i / (after + 1));
  const int first = (int)uniform(0, n);
  for (int i = 0; i < n; i++) p[i] = round[(i + first) % n];
  CagCurve *out;
  OK(cag_curve_polyline(p, (size_t)n, true, 2, &out, &err));
  if (!spline) return out;
  CagCurve *same;
  OK(cag_curve_to_nurbs(out, &same, &err));
  cag_curve_release(out);
  return same;
}

// Counts the intersections at the node, which are different pairs of parameters whose points are
// the node.
static size_t count_at(const CagCurve *a, const CagCurve *b, const CagMeeting *m, size_t n,
                       CagVec3 at) {
  size_t found = 0;
  for (size_t i = 0; i < n; i++) {
    CagVec3 p, q;
    OK(cag_curve_point(a, m[i].t, &p, &err));
    OK(cag_curve_point(b, m[i].t2, &q, &err));
    near_vec(p, m[i].point, 1e-12);
    near_vec(q, m[i].point, 1e-9);
    for (size_t k = 0; k < i; k++)
      assert_true(fabs(m[k].t - m[i].t) > 1e-6 || fabs(m[k].t2 - m[i].t2) > 1e-6);
    found += cag_norm(cag_sub(p, at)) < 1e-8;
  }
  return found;
}

static void every_branch_through_a_point_is_met(void **state) {
  (void)state;
  seed = 431;
  for (int round = 0; round < 400; round++) {
    CagVec3 node = {0, 0, 0};
    node.x = uniform(-3, 3);
    node.y = uniform(-3, 3);
    CagCurve *bow = bow_at(node, round % 4, round / 4 % 6, round % 2), *other, *back;
    CagMeeting *m;
    size_t n;
    // A line through the node, which may intersect other edges as well.
    const double way = uniform(-3, 3), before = uniform(0.2, 4), after = uniform(0.2, 4);
    const CagVec3 along = cag_vec3(cos(way), sin(way), 0);
    OK(cag_curve_line(cag_madd(node, -before, along), cag_madd(node, after, along), 2, &other,
                      &err));
    OK(cag_curve_intersect(other, bow, &m, &n, &err));
    assert_int_equal(count_at(other, bow, m, n, node), 2);
    free(m);
    OK(cag_curve_intersect(bow, other, &m, &n, &err));
    assert_int_equal(count_at(bow, other, m, n, node), 2);
    free(m);
    OK(cag_curve_reverse(bow, &back, &err));
    OK(cag_curve_intersect(other, back, &m, &n, &err));
    assert_int_equal(count_at(other, back, m, n, node), 2);
    free(m);
    const CagVec3 across = cag_vec3(-along.y, along.x, 0);
    CagPlane plane;
    OK(cag_plane(node, across, &plane, &err));
    OK(cag_curve_intersect_plane(bow, &plane, &m, &n, &err));
    size_t found = 0;
    for (size_t i = 0; i < n; i++) found += cag_norm(cag_sub(m[i].point, node)) < 1e-8;
    assert_int_equal(found, 2);
    free(m);
    cag_curve_release(other);
    // Two such polylines with the same node meet there on each pair of branches.
    other = bow_at(node, round / 3 % 5, round / 5 % 3, round / 2 % 2);
    OK(cag_curve_intersect(bow, other, &m, &n, &err));
    assert_int_equal(count_at(bow, other, m, n, node), 4);
    free(m);
    cag_curve_release(other);
    cag_curve_release(back);
    cag_curve_release(bow);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_branch_through_a_point_is_met),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
