// Arcs in place of curves: they join smoothly, and stay within the tolerance.

#include "tests/geom/support.h"

#include "geom/curve/biarc.h"
#include "tests/geom/random.h"

typedef struct Found {
  const CagCurve *curve;
  double tolerance;
  size_t n, corners;
  CagVec3 end, direction; // of the last step
} Found;

static CagStatus look(void *context, const CagArcStep *step, CagError *e) {
  Found *f = context;
  CagCurve *c;
  CagStatus status = cag_arc_step_curve(step, &c, e);
  if (status) return status;
  CagVec3 p, u, v;
  OK(cag_curve_point(c, c->start, &p, e));
  near_vec(p, step->from, 1e-9);
  OK(cag_curve_point(c, c->end, &p, e));
  near_vec(p, step->to, 1e-9);
  OK(cag_curve_tangent(c, c->start, CAG_SIDE_RIGHT, &u, e));
  OK(cag_curve_tangent(c, c->end, CAG_SIDE_LEFT, &v, e));
  if (f->n > 0) near_vec(step->from, f->end, 1e-12);
  // Chords of flat arcs deviate from the tangent by up to 1e-7.
  if (f->n > 0) f->corners += cag_norm(cag_sub(u, f->direction)) > 4e-7;
  for (int i = 1; i < 8; i++) {
    double t, distance;
    OK(cag_curve_point(c, c->start + (c->end - c->start) * i / 8, &p, e));
    OK(cag_curve_closest(f->curve, p, &t, &u, &distance, e));
    // The arcs are compared with the curve at some points only.
    assert_true(distance <= 1.5 * f->tolerance);
  }
  f->end = step->to;
  f->direction = v;
  f->n++;
  cag_curve_release(c);
  return CAG_OK;
}

static void arcs_follow_the_curve_smoothly(void **state) {
  (void)state;
  enum { POINTS = 7 };
  seed = 23;
  for (int round = 0; round < 10; round++) {
    CagVec3 p[POINTS];
    double knots[POINTS + 4];
    for (int i = 0; i < POINTS; i++) p[i] = cag_vec3(uniform(0, 10), uniform(0, 10), 0);
    CagCurve *c;
    OK(cag_knots_make("open", POINTS, 3, p, knots, &err));
    OK(cag_curve_nurbs(p, NULL, POINTS, 3, knots, 2, &c, &err));
    Found f = {.curve = c, .tolerance = 1e-4};
    OK(cag_curve_arcs(c, f.tolerance, look, &f, &err));
    assert_int_equal(f.corners, 0);
    near_vec(f.end, p[POINTS - 1], 1e-12);
    // The error is of the third order: some tens of arcs.
    assert_in_range(f.n, 8, 300);
    cag_curve_release(c);
  }
}

static void circles_and_lines_stay_what_they_are(void **state) {
  (void)state;
  CagTransform frame = cag_transform_identity();
  frame.planar = true;
  CagCurve *c;
  OK(cag_curve_arc(3, 3, 0.2, 3, &frame, &c, &err));
  Found f = {.curve = c, .tolerance = 1e-12};
  OK(cag_curve_arcs(c, f.tolerance, look, &f, &err));
  assert_true(f.n <= 8);
  cag_curve_release(c);
  OK(cag_curve_line(cag_vec3(0, 0, 0), cag_vec3(4, 1, 0), 2, &c, &err));
  f = (Found){.curve = c, .tolerance = 1e-12};
  OK(cag_curve_arcs(c, f.tolerance, look, &f, &err));
  assert_int_equal(f.n, 2);
  cag_curve_release(c);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(arcs_follow_the_curve_smoothly),
                                     cmocka_unit_test(circles_and_lines_stay_what_they_are)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
