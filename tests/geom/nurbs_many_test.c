// Points evaluated together are bit for bit equal to those evaluated one by one, on every
// processor.

#include "tests/geom/support.h"

#include <string.h>

#include "geom/curve/curve.h"

#define POINTS 20
#define PARAMETERS 1001

static CagCurve *winding(int degree, bool rational, const char *knots) {
  CagVec3 p[POINTS];
  double w[POINTS], k[POINTS + 5];
  CagCurve *c;
  for (int i = 0; i < POINTS; i++) {
    p[i] = cag_vec3(40 * sin(1.3 * i), 30 * cos(0.7 * i), 1.1 * i);
    w[i] = 1 + 0.5 * sin(i);
  }
  assert_int_equal(cag_knots_make(knots, POINTS, degree, p, k, &err), CAG_OK);
  assert_int_equal(cag_curve_nurbs(p, rational ? w : NULL, POINTS, degree, k, 3, &c, &err), CAG_OK);
  return c;
}

static void compare(const CagCurve *c, int order) {
  static double t[PARAMETERS];
  static CagVec3 many[PARAMETERS * 4 + 1];
  const CagVec3 untouched = {1, 2, 3};
  for (int i = 0; i < PARAMETERS; i++) t[i] = c->start + (c->end - c->start) * i / (PARAMETERS - 1);
  t[PARAMETERS - 1] = c->end;
  many[PARAMETERS * (order + 1)] = untouched;
  assert_int_equal(cag_curve_eval_many(c, t, PARAMETERS, order, many, &err), CAG_OK);
  assert_memory_equal(&many[PARAMETERS * (order + 1)], &untouched, sizeof untouched);
  for (int i = 0; i < PARAMETERS; i++) {
    CagVec3 one[4];
    assert_int_equal(cag_curve_eval(c, t[i], order, CAG_SIDE_RIGHT, one, &err), CAG_OK);
    assert_memory_equal(many + i * (order + 1), one, (size_t)(order + 1) * sizeof *one);
  }
}

static void points_together_are_those_one_by_one(void **state) {
  (void)state;
  const char *const knots[] = {"open", "chord", "periodic"};
  for (int degree = 1; degree <= 4; degree++)
    for (int rational = 0; rational < 2; rational++)
      for (int k = 0; k < 3; k++) {
        CagCurve *c = winding(degree, rational, knots[k]);
        for (int order = 0; order <= 3; order++) compare(c, order);
        cag_curve_release(c);
      }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(points_together_are_those_one_by_one)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
