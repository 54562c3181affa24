// Zeros between two nodes of the tracing grid: accurate to the last digits, and with far fewer
// steps than bisection.

#include "geom/meet/section_grid.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

enum { KINDS = 7, MOST_VALUES = 24 };

static const double rounding = 1e-15; // of values

static int values; // number of evaluations

// `constant` is the zero. The value is 0 nowhere else, up to rounding.
static double function_at(const CagLevel *level, double x, double *slope) {
  const double r = level->constant, d = x - r;
  switch (level->which) {
  case 0: *slope = 1; return d;
  case 1: *slope = 2 * x; return d * (x + r);
  case 2: *slope = 3 * x * x; return d * (x * x + x * r + r * r);
  case 3: *slope = 5 * exp(5 * d); return expm1(5 * d);
  case 4: *slope = 50 / (1 + 2500 * d * d); return atan(50 * d);
  case 5: *slope = -1 / (x * x); return -d / (r * x);
  default: *slope = 1 + 3 * d * d; return d + d * d * d;
  }
}

static double value_along_x(const CagLevel *level, const CagVec3 *d, int n, double *gradient) {
  double slope;
  const double value = level->unit * function_at(level, d[0].x, &slope);
  values++;
  if (gradient) {
    gradient[0] = level->unit * slope * d[cag_partial(n, 1, 0)].x;
    gradient[1] = level->unit * slope * d[cag_partial(n, 0, 1)].x;
  }
  return value;
}

static void crossings_are_zeros_found_in_few_steps(void **state) {
  (void)state;
  seed = 17;
  CagSurface *s;
  OK(cag_surface_bilinear(cag_vec3(0, 0, 0), cag_vec3(0, 1, 0), cag_vec3(1, 0, 0),
                          cag_vec3(1, 1, 0), &s, &err));
  int most[KINDS] = {0};
  for (int k = 0; k < 50 * KINDS; k++) {
    CagLevel level = {.order = 1,
                      .value = value_along_x,
                      .constant = uniform(0.1, 0.9),
                      .zero = rounding,
                      .unit = k % 2 ? 1 : -1,
                      .which = k % KINDS};
    const double zero = level.constant;
    CagTracer t = {.s = s, .level = &level, .err = &err};
    OK(cag_patch_open(s, &level, (double[2]){0, 0}, (double[2]){1, 1}, &t.patch, &err));
    // Along u, and obliquely.
    const double u[2] = {uniform(0.01, zero), uniform(zero, 1)};
    const double v[2] = {0.5, k % 3 ? 0.5 : uniform(0, 1)};
    double f[2], slope;
    for (int i = 0; i < 2; i++) f[i] = level.unit * function_at(&level, u[i], &slope);
    const int first = k / 2 % 2;
    CagTraceNode node = {0};
    values = 0;
    cag_tracer_crossing(&t, u[first], v[first], f[first], u[!first], v[!first], f[!first], &node);
    OK(t.status);
    function_at(&level, zero, &slope);
    NEAR(node.u, zero, 2e-16 + rounding / fabs(slope));
    NEAR(node.v, v[0] + (v[1] - v[0]) * (zero - u[0]) / (u[1] - u[0]), 1e-14);
    near_vec(node.p, cag_vec3(node.u, node.v, 0), 1e-15);
    assert_true(node.regular && fabs(node.t.x) < 1e-12);
    most[k % KINDS] = values > most[k % KINDS] ? values : most[k % KINDS];
  }
  for (int k = 0; k < KINDS; k++)
    if (most[k] > (k ? MOST_VALUES : 3)) fail_msg("function %d: %d values", k, most[k]);
  cag_surface_release(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(crossings_are_zeros_found_in_few_steps),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
