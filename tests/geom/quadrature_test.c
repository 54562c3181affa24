// Integrals of kinks, cusps, and peaks anywhere, compared with closed forms, and the number of
// evaluations.

#include "geom/basis/quadrature.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

enum { SHAPES = 4 };

typedef struct Bump {
  int shape, parts;
  double at, width, factor[3];
  int calls;
} Bump;

// |x|, sqrt |x|, w / (w^2 + x^2), and e^x; each component has a factor.
static CagStatus bump(void *context, double t, double *out, CagError *e) {
  (void)e;
  Bump *b = context;
  const double x = t - b->at;
  const double f[SHAPES] = {fabs(x), sqrt(fabs(x)), b->width / (b->width * b->width + x * x),
                            exp(x)};
  for (int k = 0; k < b->parts; k++) out[k] = b->factor[k] * f[b->shape];
  b->calls++;
  return CAG_OK;
}

static double antiderivative(const Bump *b, double t) {
  const double x = t - b->at;
  const double f[SHAPES] = {x * fabs(x) / 2, 2.0 / 3 * x * sqrt(fabs(x)), atan(x / b->width),
                            exp(x)};
  return f[b->shape];
}

static void integrals_keep_the_tolerance_with_few_points(void **state) {
  (void)state;
  seed = 711;
  int most[SHAPES] = {0};
  for (int round = 0; round < 1200; round++) {
    const double tolerance = pow(10, uniform(-13, -2)), start = uniform(-3, 3);
    Bump b = {.shape = round % SHAPES, .parts = 1 + round / SHAPES % 3};
    double cuts[6] = {start}, sum[3], largest = 0;
    const size_t n = (size_t)(2 + round % 5);
    for (size_t i = 1; i < n; i++) cuts[i] = cuts[i - 1] + uniform(0.1, 2);
    b.at = uniform(cuts[0], cuts[n - 1]);
    b.width = pow(10, uniform(-3, 0));
    for (int k = 0; k < 3; k++) b.factor[k] = uniform(-1, 1) * pow(10, uniform(-6, 6));
    for (int k = 0; k < b.parts; k++) largest = fmax(largest, fabs(b.factor[k]));
    OK(cag_integrate(bump, &b, cuts, n, b.parts, tolerance, sum, &err));
    const double whole = antiderivative(&b, cuts[n - 1]) - antiderivative(&b, cuts[0]);
    // At a kink or cusp, both rules may agree by chance although neither is accurate.
    const double chance = b.shape < 2 ? 1e-5 + 4 * tolerance : 1e-14;
    for (int k = 0; k < b.parts; k++)
      NEAR(sum[k], b.factor[k] * whole, (tolerance + chance) * largest * whole);
    // 15 points for each piece, and two halves for each bisection.
    const int extra = b.calls / 15 - (int)(n - 1);
    assert_int_equal(b.calls % 15, 0);
    assert_int_equal(extra % 2, 0);
    if (extra / 2 > most[b.shape]) most[b.shape] = extra / 2;
  }
  // Bisection toward a kink or cusp reduces the error by 2^-2 or 2^-1.5 at a time. A peak is
  // bisected down to its width, and smooth functions are not bisected.
  assert_true(most[0] <= 25 && most[1] <= 50 && most[2] <= 40 && most[3] == 0);
  assert_true(most[0] >= 15 && most[1] >= 30 && most[2] >= 20);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(integrals_keep_the_tolerance_with_few_points),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
