// Intervals, series of intervals, and Chebyshev series, compared with closed forms and random
// members.

#include "geom/basis/chebyshev.h"
#include "geom/basis/interval.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

enum { ORDER = 6 };

// --- Members of ranges ---

static CagInterval random_interval(double width) {
  const double x = uniform(-3, 3);
  return (CagInterval){x, x + uniform(0, width)};
}

static double member(CagInterval a) {
  const double x = uniform(-0.2, 1.2); // the ends are included
  return x <= 0 ? a.lo : x >= 1 ? a.hi : a.lo + (a.hi - a.lo) * x;
}

static bool holds(CagInterval a, double x, double slack) {
  return a.lo <= x + slack && a.hi >= x - slack;
}

static void operations_hold_their_members_and_reach_both_ends(void **state) {
  (void)state;
  seed = 301;
  for (int round = 0; round < 400; round++) {
    const CagInterval a = random_interval(2),
                      b = round % 5 ? random_interval(2) : cag_interval(uniform(-2, 2));
    const double f = uniform(-2, 2);
    struct {
      CagInterval range;
      double low, high;
    } r[7] = {{cag_interval_add(a, b), 0, 0},     {cag_interval_sub(a, b), 0, 0},
              {cag_interval_product(a, b), 0, 0}, {cag_interval_scaled(a, f), 0, 0},
              {cag_interval_square(a), 0, 0},     {cag_interval_cos(a), 0, 0},
              {cag_interval_hull(a, b), 0, 0}};
    for (int i = 0; i < 7; i++) {
      r[i].low = INFINITY;
      r[i].high = -INFINITY;
    }
    enum { STEPS = 40 };
    for (int i = 0; i <= STEPS; i++)
      for (int j = 0; j <= STEPS; j += STEPS / 4) {
        const double x = i == STEPS ? a.hi : a.lo + (a.hi - a.lo) * i / STEPS,
                     y = j == STEPS ? b.hi : b.lo + (b.hi - b.lo) * j / STEPS;
        const double value[7] = {x + y, x - y, x * y, x * f, x * x, cos(x), i % 2 ? y : x};
        for (int k = 0; k < 7; k++) {
          assert_true(holds(r[k].range, value[k], 1e-14));
          r[k].low = fmin(r[k].low, value[k]);
          r[k].high = fmax(r[k].high, value[k]);
        }
      }
    for (int k = 0; k < 7; k++) { // squares and cosines have extremes between the samples
      NEAR(r[k].range.lo, r[k].low, k == 4 || k == 5 ? 2e-3 : 1e-13);
      NEAR(r[k].range.hi, r[k].high, k == 4 || k == 5 ? 2e-3 : 1e-13);
    }
    NEAR(cag_interval_size(a), fmax(fabs(a.lo), fabs(a.hi)), 0);
    const CagInterval3 v = {a, b, cag_interval(f)};
    NEAR(cag_interval3_size(v),
         sqrt(pow(cag_interval_size(a), 2) + pow(cag_interval_size(b), 2) + f * f), 1e-14);
  }
  // At multiples of half turns, and slightly beside them.
  for (int k = -3; k <= 3; k++) {
    const double at = k * M_PI;
    const CagInterval over = cag_interval_cos((CagInterval){at - 0.1, at + 0.2}),
                      before = cag_interval_cos((CagInterval){at - 0.3, at - 0.1});
    assert_true(k % 2 ? over.lo == -1 : over.hi == 1);
    NEAR(k % 2 ? over.hi : over.lo, cos(at + 0.2), 1e-14);
    assert_true(before.lo > -0.996 && before.hi < 0.996);
  }
}

// --- Series ---

static double value_of(const double *a, double t) {
  double sum = 0;
  for (int k = ORDER; k >= 0; k--) sum = sum * t + a[k];
  return sum;
}

typedef struct Vector {
  double x[ORDER + 1], y[ORDER + 1], z[ORDER + 1];
} Vector;

static CagVec3 vector_at(const Vector *v, double t) {
  return cag_vec3(value_of(v->x, t), value_of(v->y, t), value_of(v->z, t));
}

// Random ranges, and random members of them.
static void random_series(double width, CagInterval *a, double *of) {
  for (int k = 0; k <= ORDER; k++) {
    a[k] = random_interval(width);
    of[k] = member(a[k]);
  }
}

static void random_vectors(double width, CagInterval3 *a, Vector *of) {
  for (int k = 0; k <= ORDER; k++) {
    a[k] = (CagInterval3){random_interval(width), random_interval(width), random_interval(width)};
    of->x[k] = member(a[k].x);
    of->y[k] = member(a[k].y);
    of->z[k] = member(a[k].z);
  }
}

// The value at t of the series of the midpoints of narrow ranges.
static CagVec3 middle_at(const CagInterval3 *a, double t) {
  CagVec3 sum = {0, 0, 0};
  for (int k = ORDER; k >= 0; k--)
    sum = cag_madd(cag_vec3((a[k].x.lo + a[k].x.hi) / 2, (a[k].y.lo + a[k].y.hi) / 2,
                            (a[k].z.lo + a[k].z.hi) / 2),
                   t, sum);
  return sum;
}

static double middle_of(const CagInterval *a, double t) {
  double sum = 0;
  for (int k = ORDER; k >= 0; k--) sum = sum * t + (a[k].lo + a[k].hi) / 2;
  return sum;
}

// For ranges of width 0 and a small t, the results are equal up to the omitted powers.
static void series_of_numbers_are_those_of_the_functions(void **state) {
  (void)state;
  seed = 302;
  const double t = 2e-3, left_out = 1e-12; // about (5 t)^7
  for (int round = 0; round < 200; round++) {
    CagInterval a[ORDER + 1], b[ORDER + 1], s[ORDER + 1], c[ORDER + 1], q[ORDER + 1];
    CagInterval3 v[ORDER + 1], w[ORDER + 1], r[ORDER + 1];
    double fa[ORDER + 1], fb[ORDER + 1];
    Vector fv, fw;
    random_series(0, a, fa);
    random_series(0, b, fb);
    random_vectors(0, v, &fv);
    random_vectors(0, w, &fw);
    const double x = value_of(fa, t), y = value_of(fb, t);
    cag_intervals_sincos(a, ORDER, s, c);
    NEAR(middle_of(s, t), sin(x), left_out);
    NEAR(middle_of(c, t), cos(x), left_out);
    if (fabs(y) > 0.5) {
      assert_true(cag_intervals_quotient(a, b, ORDER, q));
      NEAR(middle_of(q, t), x / y, 1e3 * left_out);
    }
    const CagVec3 p = vector_at(&fv, t), o = vector_at(&fw, t);
    cag_intervals3_cross(v, w, ORDER, r);
    near_vec(middle_at(r, t), cag_cross(p, o), left_out);
    cag_intervals3_scaled(v, a, ORDER, r);
    near_vec(middle_at(r, t), cag_scaled(p, x), left_out);
    cag_intervals3_add(v, w, ORDER, r);
    near_vec(middle_at(r, t), cag_add(p, o), left_out);
    cag_intervals3_sub(v, w, ORDER, r);
    near_vec(middle_at(r, t), cag_sub(p, o), left_out);
    if (cag_norm(p) > 0.5) {
      assert_true(cag_intervals3_unit(v, ORDER, r));
      near_vec(middle_at(r, t), cag_unit(p), 1e3 * left_out);
    }
  }
}

static void holds_vector(const CagInterval3 *a, const CagInterval3 *b) {
  for (int k = 0; k <= ORDER; k++) {
    const double slack = 1e-9 * (1 + cag_interval3_size(a[k]));
    assert_true(holds(a[k].x, b[k].x.lo, slack) && holds(a[k].x, b[k].x.hi, slack));
    assert_true(holds(a[k].y, b[k].y.lo, slack) && holds(a[k].y, b[k].y.hi, slack));
    assert_true(holds(a[k].z, b[k].z.lo, slack) && holds(a[k].z, b[k].z.hi, slack));
  }
}

static void holds_series(const CagInterval *a, const CagInterval *b) {
  for (int k = 0; k <= ORDER; k++) {
    const double slack = 1e-9 * (1 + cag_interval_size(a[k]));
    assert_true(holds(a[k], b[k].lo, slack) && holds(a[k], b[k].hi, slack));
  }
}

// The result for a series of members is inside the result for the series of ranges.
static void series_of_ranges_hold_those_of_their_members(void **state) {
  (void)state;
  seed = 303;
  int quotients = 0, units = 0;
  for (int round = 0; round < 400; round++) {
    CagInterval a[ORDER + 1], b[ORDER + 1], wide[2][ORDER + 1], one[2][ORDER + 1], x[ORDER + 1],
        y[ORDER + 1];
    CagInterval3 v[ORDER + 1], w[ORDER + 1], p[ORDER + 1], q[ORDER + 1], r[2][ORDER + 1];
    double fa[ORDER + 1], fb[ORDER + 1];
    Vector fv, fw;
    random_series(0.5, a, fa);
    random_series(0.5, b, fb);
    random_vectors(0.3, v, &fv);
    random_vectors(0.3, w, &fw);
    for (int k = 0; k <= ORDER; k++) {
      x[k] = cag_interval(fa[k]);
      y[k] = cag_interval(fb[k]);
      p[k] = (CagInterval3){cag_interval(fv.x[k]), cag_interval(fv.y[k]), cag_interval(fv.z[k])};
      q[k] = (CagInterval3){cag_interval(fw.x[k]), cag_interval(fw.y[k]), cag_interval(fw.z[k])};
    }
    cag_intervals_sincos(a, ORDER, wide[0], wide[1]);
    cag_intervals_sincos(x, ORDER, one[0], one[1]);
    for (int i = 0; i < 2; i++) holds_series(wide[i], one[i]);
    const bool zero = b[0].lo <= 0 && b[0].hi >= 0;
    assert_int_equal(cag_intervals_quotient(a, b, ORDER, wide[0]), !zero);
    if (!zero) {
      assert_true(cag_intervals_quotient(x, y, ORDER, one[0]));
      holds_series(wide[0], one[0]);
      quotients++;
    }
    cag_intervals3_cross(v, w, ORDER, r[0]);
    cag_intervals3_cross(p, q, ORDER, r[1]);
    holds_vector(r[0], r[1]);
    cag_intervals3_scaled(v, a, ORDER, r[0]);
    cag_intervals3_scaled(p, x, ORDER, r[1]);
    holds_vector(r[0], r[1]);
    cag_intervals3_add(v, w, ORDER, r[0]);
    cag_intervals3_add(p, q, ORDER, r[1]);
    holds_vector(r[0], r[1]);
    cag_intervals3_sub(v, w, ORDER, r[0]);
    cag_intervals3_sub(p, q, ORDER, r[1]);
    holds_vector(r[0], r[1]);
    if (!cag_intervals3_unit(v, ORDER, r[0])) continue;
    assert_true(cag_intervals3_unit(p, ORDER, r[1]));
    holds_vector(r[0], r[1]);
    units++;
  }
  assert_true(quotients > 300 && units > 300);
  // A vector that may be 0 does not have a direction.
  CagInterval3 v[1] = {{{-1, 1}, {-0.1, 0.2}, {0, 0.1}}}, out[1];
  assert_false(cag_intervals3_unit(v, 0, out));
  v[0].z.lo = 0.05;
  assert_true(cag_intervals3_unit(v, 0, out));
}

// --- Chebyshev series ---

// sin 3t, exp(t / 2) and t^3 - 2t, with their Taylor coefficients.
static void smooth_coefficients(double t, double out[3][5]) {
  double factorial = 1;
  for (int k = 0; k < 5; k++) {
    if (k > 0) factorial *= k;
    out[0][k] = pow(3, k) * sin(3 * t + k * M_PI / 2) / factorial;
    out[1][k] = pow(0.5, k) * exp(t / 2) / factorial;
  }
  const double cubic[5] = {t * t * t - 2 * t, 3 * t * t - 2, 3 * t, 1, 0};
  memcpy(out[2], cubic, sizeof cubic);
}

static CagStatus smooth(void *context, double t, double *out, CagError *e) {
  double c[3][5];
  (void)e;
  ++*(int *)context;
  smooth_coefficients(t, c);
  for (int i = 0; i < 3; i++) out[i] = c[i][0];
  return CAG_OK;
}

static void smooth_functions_have_their_series_and_ranges(void **state) {
  (void)state;
  seed = 304;
  int calls = 0;
  CagChebyshev *f, *again;
  OK(cag_chebyshev_fit(smooth, &calls, -1, 4, 3, 1e-13, "f", &f, &err));
  assert_true(calls < 600); // 8 or 16 pieces
  again = cag_chebyshev_retain(f);
  cag_chebyshev_release(again);
  double joints[64];
  const size_t n = cag_chebyshev_joints(f, joints, 64);
  assert_true(n >= 1 && n < 32);
  for (size_t i = 0; i < n; i++) assert_true(joints[i] > (i ? joints[i - 1] : -1) && joints[i] < 4);
  double few[2] = {0, -7};
  assert_int_equal(cag_chebyshev_joints(f, few, 1), n);
  assert_true(few[0] == joints[0] && few[1] == -7);
  assert_int_equal(cag_chebyshev_breaks(f, joints, 64), 0);
  const int before = calls;
  for (int round = 0; round < 300; round++) {
    const double t = round == 0 ? -1 : round == 1 ? 4 : round == 2 ? joints[0] : uniform(-1, 4);
    double out[15], expected[3][5];
    cag_chebyshev_series(f, t, round % 2, 4, out);
    smooth_coefficients(t, expected);
    for (int part = 0; part < 3; part++)
      for (int k = 0; k < 5; k++)
        NEAR(out[5 * part + k], expected[part][k], 1e-13 * 60 * pow(100, k));
    // Ranges over a part of a piece.
    const double at = uniform(-1, 4), width = pow(10, uniform(-6, -0.5));
    double low = -1, high = 4;
    for (size_t i = 0; i < n; i++) {
      if (joints[i] <= at) low = joints[i];
      if (joints[i] > at) high = fmin(high, joints[i]);
    }
    const double a = fmax(low, at - width), b = fmin(high, at + width);
    CagInterval r[15];
    cag_chebyshev_ranges(f, a, b, 4, r);
    for (int i = 0; i <= 10; i++) {
      smooth_coefficients(a + (b - a) * i / 10, expected);
      for (int part = 0; part < 3; part++)
        for (int k = 0; k < 5; k++) {
          const double slack = 1e-13 * 60 * pow(100, k);
          assert_true(holds(r[5 * part + k], expected[part][k], slack));
          // Not much wider than the difference of the values at the ends, plus the bend of 16
          // terms.
          if (k < 2) assert_true(r[5 * part + k].hi - r[5 * part + k].lo <= slack + 400 * (b - a));
        }
    }
  }
  assert_int_equal(calls, before); // never called again
  cag_chebyshev_release(f);
}

typedef struct Edge {
  double at;
  // 0: |t - at|; 1: a jump; 2: a pole; 3: a failure; 4: a jump of the third derivative; 5: a kink
  // of a wave
  int what;
  double bend;
} Edge;

static CagStatus edged(void *context, double t, double *out, CagError *e) {
  const Edge *x = context;
  const double d = t - x->at;
  if (x->what == 3 && d > 0)
    return cag_fail(e, CAG_E_CALLBACK, CAG_ERR_function_failed, "", -1, "no value beyond");
  out[0] = x->what == 0   ? fabs(d) + t
           : x->what == 1 ? (d > 0) + t
           : x->what == 2 ? (d > 0 ? INFINITY : t)
           : x->what == 5 ? sin(200 * t) + x->bend * fabs(d)
                          : d * d * fabs(d);
  return CAG_OK;
}

static void kinks_jumps_and_failures_are_told(void **state) {
  (void)state;
  seed = 305;
  for (int round = 0; round < 20; round++) {
    Edge x = {.at = uniform(0.2, 1.8)};
    CagChebyshev *f;
    double breaks[8], out[2];
    OK(cag_chebyshev_fit(edged, &x, 0, 2, 1, 1e-12, "f", &f, &err));
    const size_t n = cag_chebyshev_breaks(f, breaks, 8);
    assert_int_equal(n, 1);
    NEAR(breaks[0], x.at, 1e-6);
    breaks[0] = -7;
    assert_int_equal(cag_chebyshev_breaks(f, breaks, 0), 1);
    assert_true(breaks[0] == -7);
    for (int i = 0; i <= 20; i++) {
      const double t = i / 10.0;
      if (fabs(t - x.at) < 1e-3) continue;
      cag_chebyshev_series(f, t, i == 20, 1, out);
      NEAR(out[0], fabs(t - x.at) + t, 1e-11);
      NEAR(out[1], t > x.at ? 2 : 0, 1e-7);
    }
    cag_chebyshev_release(f);
    x.what = 4; // the first derivative is continuous
    OK(cag_chebyshev_fit(edged, &x, 0, 2, 1, 1e-10, "f", &f, &err));
    assert_int_equal(cag_chebyshev_breaks(f, breaks, 8), 0);
    cag_chebyshev_release(f);
    x.what = 1;
    FAILS(cag_chebyshev_fit(edged, &x, 0, 2, 1, 1e-12, "f", &f, &err), "function-jumps");
    assert_string_equal(err.argument, "f");
    x.what = 2;
    FAILS(cag_chebyshev_fit(edged, &x, 0, 2, 1, 1e-12, "f", &f, &err), "not-finite");
    x.what = 3;
    FAILS(cag_chebyshev_fit(edged, &x, 0, 2, 1, 1e-12, "f", &f, &err), "function-failed");
  }
  // A wave of slope 200 has kinks larger than 1e-5 of the slopes on both sides.
  for (int i = 0; i < 4; i++) {
    Edge wave = {(20 + i / 2) * M_PI / 200, 5, i % 2 ? 0.1 : 0.0005};
    CagChebyshev *f;
    double breaks[8];
    OK(cag_chebyshev_fit(edged, &wave, 0, 2, 1, 1e-11, "f", &f, &err));
    assert_int_equal(cag_chebyshev_breaks(f, breaks, 8), i % 2);
    if (i % 2) NEAR(breaks[0], wave.at, 1e-6);
    cag_chebyshev_release(f);
  }
  // At a kink at a joint, both one-sided limits exist.
  Edge x = {.at = 1};
  CagChebyshev *f;
  double out[2];
  OK(cag_chebyshev_fit(edged, &x, 0, 2, 1, 1e-12, "f", &f, &err));
  cag_chebyshev_series(f, 1, true, 1, out);
  NEAR(out[1], 0, 1e-10);
  cag_chebyshev_series(f, 1, false, 1, out);
  NEAR(out[1], 2, 1e-10);
  cag_chebyshev_release(f);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(operations_hold_their_members_and_reach_both_ends),
      cmocka_unit_test(series_of_numbers_are_those_of_the_functions),
      cmocka_unit_test(series_of_ranges_hold_those_of_their_members),
      cmocka_unit_test(smooth_functions_have_their_series_and_ranges),
      cmocka_unit_test(kinks_jumps_and_failures_are_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
