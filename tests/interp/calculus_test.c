// The parameters at which minimize, find_root, and integrate evaluate their function, compared with
// the published algorithms, which are implemented again here: Brent's localmin and zeroin
// (Algorithms for Minimization without Derivatives, 1973, chapters 4 and 5), and QUADPACK's qag
// with a search for hidden steps.

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "cag.h"

#define POINTS_MOST 100000

// The parameters at which a script evaluated its function (it passes them through `trace`), and its
// output.
typedef struct Trace {
  double x[POINTS_MOST];
  size_t count;
  char output[256];
  int status;
} Trace;

static void run(const char *script, Trace *out) {
  CagSessionOptions options;
  char *output = NULL, *messages = NULL;
  size_t size = 0, length = 0;
  cag_session_options_init(&options);
  options.out = open_memstream(&output, &size);
  options.messages = open_memstream(&messages, &length);
  CagSession *s = cag_session_new(&options);
  assert_non_null(s);
  out->status = cag_session_run_text(s, "calculus.cag", script, strlen(script));
  cag_session_free(s);
  fclose(options.out);
  fclose(options.messages);
  snprintf(out->output, sizeof out->output, "%s", output);
  out->count = 0;
  for (char *line = strtok(messages, "\n"); line; line = strtok(NULL, "\n")) {
    const char *x = strrchr(line, ' ');
    assert_non_null(x);
    assert_true(out->count < POINTS_MOST);
    out->x[out->count++] = strtod(x + 1, NULL);
  }
  free(output);
  free(messages);
}

// The same function in C and in the language.
typedef struct Function {
  double (*f)(double);
  const char *text;
  double start, end;
} Function;

static double parabola(double x) { return (x - 2) * (x - 2) + 1; }
static double flat(double x) { return (x - 0.3) * (x - 0.3) * (x - 0.3) * (x - 0.3); }
static double wedge(double x) { return fabs(x - 0.1234); }
static double root_wedge(double x) { return sqrt(fabs(x - 0.7)); }
static double rising(double x) { return x * x * x + x; }
static double falling(double x) { return -x; }
static double constant(double x) { return 3 + 0 * x; }
static double quartic(double x) { return x * x * x * x - 2 * x * x + x / 4; }
static double quotient(double x) { return x / (1 + x * x); }
static double hyperbola(double x) { return 1 / (x + 1.5) + x * x; }
static double steep(double x) { return x * x * x * x * x * x * x * x - x; }

static const Function to_minimize[] = {
    {parabola, "(x - 2) * (x - 2) + 1", -10, 10},
    {parabola, "(x - 2) * (x - 2) + 1", 2, 3},
    {flat, "(x - 0.3) * (x - 0.3) * (x - 0.3) * (x - 0.3)", -1, 1},
    {flat, "(x - 0.3) * (x - 0.3) * (x - 0.3) * (x - 0.3)", -100, 1000},
    {wedge, "abs(x - 0.1234)", -1, 1},
    {wedge, "abs(x - 0.1234)", 0, 0.1234},
    {root_wedge, "sqrt(abs(x - 0.7))", 0, 1},
    {rising, "x * x * x + x", 0, 1},
    {falling, "-x", -3, 0.5},
    {constant, "3 + 0 * x", 0, 1},
    {quartic, "x * x * x * x - 2 * x * x + x / 4", -2, 2},
    {quotient, "x / (1 + x * x)", -3, 8},
    {quotient, "x / (1 + x * x)", -3e-5, 5e-5},
    {hyperbola, "1 / (x + 1.5) + x * x", -1, 1},
    {steep, "x * x * x * x * x * x * x * x - x", -1, 1},
    {steep, "x * x * x * x * x * x * x * x - x", -2, 3},
};
#define COUNT(array) (sizeof(array) / sizeof *(array))

typedef struct Asked {
  double x[POINTS_MOST];
  size_t count;
} Asked;

static double ask(Asked *asked, const Function *f, double sign, double x) {
  asked->x[asked->count++] = x;
  return sign * f->f(x);
}

// localmin, with the tolerance 1.5e-8 |x| + t, where t is 1e-14 of the remaining range, or of 1 if
// that is larger. The book starts with a golden section step; here, x is given with its value.
static double localmin(Asked *asked, const Function *f, double sign, double a, double b, double x,
                       double fx, double *value) {
  const double c = (3 - sqrt(5)) / 2;
  double v, w, fv, fw, d = 0, e = 0, u, fu;
  v = w = x;
  fv = fw = fx;
  for (;;) {
    const double m = (a + b) / 2, tol = 1.5e-8 * fabs(x) + 1e-14 * (b - a > 1 ? b - a : 1);
    if (!(fabs(x - m) > 2 * tol - (b - a) / 2)) break;
    double p = 0, q = 0, r = 0;
    if (fabs(e) > tol) { // fit a parabola
      r = (x - w) * (fx - fv);
      q = (x - v) * (fx - fw);
      p = (x - v) * q - (x - w) * r;
      q = 2 * (q - r);
      if (q > 0) p = -p;
      else q = -q;
      r = e;
      e = d;
    }
    if (fabs(p) < fabs(q * r / 2) && p > q * (a - x) && p < q * (b - x)) {
      d = p / q;
      u = x + d;
      if (u - a < 2 * tol || b - u < 2 * tol) d = x < m ? tol : -tol;
    } else { // a golden section step
      e = (x < m ? b : a) - x;
      d = c * e;
    }
    u = x + (fabs(d) >= tol ? d : d > 0 ? tol : -tol);
    fu = ask(asked, f, sign, u);
    if (fu <= fx) {
      if (u < x) b = x;
      else a = x;
      v = w, fv = fw, w = x, fw = fx, x = u, fx = fu;
    } else {
      if (u < x) a = u;
      else b = u;
      if (fu <= fw || w == x) v = w, fv = fw, w = u, fw = fu;
      else if (fu <= fv || v == x || v == w) v = u, fv = fu;
    }
  }
  *value = fx;
  return x;
}

// Takes 129 samples, and then applies localmin to each of the four lowest valleys, between the
// neighboring samples.
static double least_of_all(Asked *asked, const Function *f, double sign) {
  double y[129], best = f->start, least;
  bool used[129] = {false};
  const double h = (f->end - f->start) / 128;
  for (int i = 0; i <= 128; i++) y[i] = ask(asked, f, sign, i == 128 ? f->end : f->start + h * i);
  least = y[0];
  if (y[128] < least) least = y[128], best = f->end;
  for (int k = 0; k < 4; k++) {
    int at = -1;
    for (int i = 0; i <= 128; i++)
      if (!used[i] && (i == 0 || y[i - 1] >= y[i]) && (i == 128 || y[i + 1] >= y[i]) &&
          (at < 0 || y[i] < y[at]))
        at = i;
    if (at < 0) break;
    used[at] = true;
    const double from = f->start + h * (at > 0 ? at - 1 : 0);
    const double to = at >= 127 ? f->end : f->start + h * (at + 1);
    double value;
    double x =
        localmin(asked, f, sign, from, to, at == 128 ? f->end : f->start + h * at, y[at], &value);
    if (value < least) least = value, best = x;
  }
  ask(asked, f, sign, best);
  return best;
}

static void compare(const Trace *trace, const Asked *asked, const char *script) {
  for (size_t i = 0; i < trace->count && i < asked->count; i++)
    if (!(fabs(trace->x[i] - asked->x[i]) <= 1e-13 * (1 + fabs(asked->x[i]))))
      fail_msg("%s: point %zu is %.17g instead of %.17g", script, i, trace->x[i], asked->x[i]);
  if (trace->count != asked->count)
    fail_msg("%s: %zu points instead of %zu", script, trace->count, asked->count);
}

static void minimize_asks_where_brent_does(void **state) {
  (void)state;
  static Trace trace;
  static Asked asked;
  char script[256];
  for (size_t i = 0; i < COUNT(to_minimize); i++)
    for (int greatest = 0; greatest < 2; greatest++) {
      const Function *f = &to_minimize[i];
      snprintf(script, sizeof script, "g(x) = %s%s%s\nprint %s(x => g(trace(x)), %.17g..%.17g)",
               greatest ? "-(" : "", f->text, greatest ? ")" : "",
               greatest ? "maximize" : "minimize", f->start, f->end);
      run(script, &trace);
      assert_int_equal(trace.status, CAG_STATUS_OK);
      asked.count = 0;
      double x = least_of_all(&asked, f, 1);
      compare(&trace, &asked, script);
      double found = strtod(trace.output + 1, NULL);
      if (!(fabs(found - x) <= 1e-13 * (1 + fabs(x))))
        fail_msg("%s: %.17g instead of %.17g", script, found, x);
    }
}

static double cubic(double x) { return x * x * x - 2 * x - 5; }
static double ninth(double x) {
  const double y = (x - 0.7) * (x - 0.7) * (x - 0.7);
  return y * y * y;
}
static double shifted(double x) { return 1 / (x - 3) + 6; }
static double bent(double x) { return x > 0.25 ? 20 * (x - 0.25) : (x - 0.25) / 20; }
static double step(double x) { return x >= 0.3 ? 1 : -1; }
static double line(double x) { return 3 - 2 * x; }
static double through_zero(double x) { return x * x * x * (1 + x * x); }
static double wave(double x) { return x * x * x * x * x - 5 * x * x + 0.1; }

static const Function to_solve[] = {
    {cubic, "x * x * x - 2 * x - 5", 2, 3},
    {cubic, "x * x * x - 2 * x - 5", -100, 200},
    {ninth, "(y => y * y * y)((x - 0.7) * (x - 0.7) * (x - 0.7))", 0, 1},
    {ninth, "(y => y * y * y)((x - 0.7) * (x - 0.7) * (x - 0.7))", -4, 1.5},
    {shifted, "1 / (x - 3) + 6", 0, 2.999},
    {bent, "if x > 0.25 then 20 * (x - 0.25) else (x - 0.25) / 20", -1, 1},
    {step, "if x >= 0.3 then 1 else -1", 0, 1},
    {line, "3 - 2 * x", 0, 7},
    {line, "3 - 2 * x", 1, 2},
    {through_zero, "x * x * x * (1 + x * x)", -1, 3},
    {through_zero, "x * x * x * (1 + x * x)", -5, 0.001},
    {wave, "x * x * x * x * x - 5 * x * x + 0.1", -1, 0},
    {wave, "x * x * x * x * x - 5 * x * x + 0.1", 1, 8},
};

// zeroin, with the tolerance 2 eps |b| + t, where t is 1e-4 eps of the range.
static double zeroin(Asked *asked, const Function *f) {
  double a = f->start, b = f->end, fa = ask(asked, f, 1, a), fb = ask(asked, f, 1, b);
  const double t = 1e-4 * DBL_EPSILON * (b - a);
  if (fa == 0 || fb == 0) return fa == 0 ? a : b;
  double c = a, fc = fa, d = b - a, e = d;
  for (;;) {
    if (fabs(fc) < fabs(fb)) {
      a = b, b = c, c = a;
      fa = fb, fb = fc, fc = fa;
    }
    const double tol = 2 * DBL_EPSILON * fabs(b) + t, m = (c - b) / 2;
    if (!(fabs(m) > tol && fb != 0)) return b;
    if (fabs(e) < tol || fabs(fa) <= fabs(fb)) {
      d = e = m;
    } else {
      double p, q, r, s = fb / fa;
      if (a == c) { // linear interpolation
        p = 2 * m * s;
        q = 1 - s;
      } else { // inverse quadratic interpolation
        q = fa / fc;
        r = fb / fc;
        p = s * (2 * m * q * (q - r) - (b - a) * (r - 1));
        q = (q - 1) * (r - 1) * (s - 1);
      }
      if (p > 0) q = -q;
      else p = -p;
      s = e;
      e = d;
      if (2 * p < 3 * m * q - fabs(tol * q) && p < fabs(s * q / 2)) {
        d = p / q;
      } else {
        d = e = m;
      }
    }
    a = b;
    fa = fb;
    b += fabs(d) > tol ? d : m > 0 ? tol : -tol;
    fb = ask(asked, f, 1, b);
    if ((fb > 0) == (fc > 0)) c = a, fc = fa, d = e = b - a;
  }
}

static void find_root_asks_where_brent_does(void **state) {
  (void)state;
  static Trace trace;
  static Asked asked;
  char script[256];
  for (size_t i = 0; i < COUNT(to_solve); i++) {
    const Function *f = &to_solve[i];
    snprintf(script, sizeof script, "g(x) = %s\nprint find_root(x => g(trace(x)), %.17g..%.17g)",
             f->text, f->start, f->end);
    run(script, &trace);
    assert_int_equal(trace.status, CAG_STATUS_OK);
    asked.count = 0;
    double x = zeroin(&asked, f);
    compare(&trace, &asked, script);
    double found = strtod(trace.output, NULL);
    if (!(fabs(found - x) <= 1e-14 * (1 + fabs(x))))
      fail_msg("%s: %.17g instead of %.17g", script, found, x);
  }
}

// --- Integrals ---

// Integrals with closed forms, which are not symmetric, so that the errors of any two pieces
// differ. Both rules are exact for polynomials up to degree 13, so that two pieces suffice.
typedef struct Integral {
  double (*f)(double);
  const char *text;
  double start, end, value;
  bool exact; // with both rules
} Integral;

static double one(double x) { return 1 + 0 * x; }
static double fifth(double x) { return x * x * x * x * x; }
static double mixed(double x) {
  const double y = x * x * x * x;
  return y * y * y * y * y * x * x * x - y * y;
}
static double odd(double x) { return x * x * x - x; }
static double cauchy(double x) { return 1 / (1 + x * x); }
static double beside(double x) { return 1 / (1 + (x - 3) * (x - 3)); }
static double fast(double x) { return 1 / ((1 + x * x) * (1 + x * x)); }
static double kink(double x) { return fabs(x - 0.3); }
static double jump(double x) { return x < 0.7 ? 0 : 1; }
static double late(double x) { return x < 0.9999999 ? 1 : 3; }
static double central(double x) { return x < 0.5000001 ? 1 : 3; }
static double singular(double x) { return 1 / sqrt(x); }
static double peak(double x) { return 1e4 / (1 + 1e8 * x * x); }
static double runge(double x) { return 1 / (1 + 25 * x * x) - x; }

#define PI 3.141592653589793
static const Integral integrals[] = {
    {one, "1", 0, 1, 1, true},
    {parabola, "(x - 2) * (x - 2) + 1", 0, 6, 30, true},
    {fifth, "x * x * x * x * x", -1, 2, 10.5, true},
    {mixed, "(y => y * y * y * y * y * x * x * x - y * y)(x * x * x * x)", 0, 1, 1.0 / 24 - 1.0 / 9,
     false},
    {odd, "x * x * x - x", -1, 1, 0, true},
    {cauchy, "1 / (1 + x * x)", -5, 4, 2.6992184306130484, false},
    {cauchy, "1 / (1 + x * x)", 0.5, INFINITY, 1.1071487177940904, false},
    {beside, "1 / (1 + (x - 3) * (x - 3))", -INFINITY, INFINITY, PI, false},
    {cauchy, "1 / (1 + x * x)", -INFINITY, 1, 0.75 * PI, false},
    {beside, "1 / (1 + (x - 3) * (x - 3))", 3.5, INFINITY, 1.1071487177940904, false},
    {beside, "1 / (1 + (x - 3) * (x - 3))", -INFINITY, 2, PI / 4, false},
    {fast, "1 / ((1 + x * x) * (1 + x * x))", -INFINITY, 1, 0.375 * PI + 0.25, false},
    {fast, "1 / ((1 + x * x) * (1 + x * x))", 1, INFINITY, PI / 8 - 0.25, false},
    {kink, "abs(x - 0.3)", 0, 1, 0.29, false},
    {jump, "if x < 0.7 then 0 else 1", 0, 1, 0.3, false},
    {late, "if x < 0.9999999 then 1 else 3", 0, 1, 1.0000002, false},
    {central, "if x < 0.5000001 then 1 else 3", 0, 1, 1.9999998, false},
    {singular, "1 / sqrt(x)", 0, 1, 2, false},
    {peak, "1e4 / (1 + 1e8 * x * x)", -1, 2, 3.1414426535901683, false},
    {runge, "1 / (1 + 25 * x * x) - x", -1, 2, -0.9310943117502498, false},
};

// The rule with 7 and 15 points (QUADPACK's qk15), from the center outward. At the points between,
// the weight of the rule with 7 points is 0.
static const double nodes[8][3] = {
    {0, 0.2094821410847278, 0.4179591836734694},
    {0.2077849550078985, 0.20443294007529889, 0},
    {0.4058451513773972, 0.19035057806478541, 0.3818300505051189},
    {0.5860872354676911, 0.16900472663926790, 0},
    {0.7415311855993944, 0.1406532597155259, 0.2797053914892767},
    {0.8648644233597691, 0.10479001032225018, 0},
    {0.9491079123427585, 0.06309209262997855, 0.1294849661688697},
    {0.9914553711208126, 0.022935322010529225, 0},
};

typedef struct Part {
  double from, to, value, error, size;
  double y[15];
  int doubted; // at the end `from` (-1) or `to` (1)
} Part;

// The integrand after the substitution for infinite ranges: t / (1 - t), or t / (1 - t^2).
static double at(Asked *asked, const Integral *g, double t) {
  const Function f = {g->f, NULL, 0, 0};
  const double r = t / (1 - t), slope = (1 + r) * (1 + r);
  if (isinf(g->start) && isinf(g->end)) {
    const double x = t / ((1 - t) * (1 + t));
    return ask(asked, &f, 1, x) * (1 + t * t) / ((1 - t * t) * (1 - t * t));
  }
  if (isinf(g->end)) return ask(asked, &f, 1, g->start + r) * slope;
  if (isinf(g->start)) return ask(asked, &f, 1, g->end - r) * slope;
  return ask(asked, &f, 1, t);
}

static Part part(Asked *asked, const Integral *g, double from, double to) {
  Part p = {.from = from, .to = to};
  const double middle = (from + to) / 2, half = (to - from) / 2;
  double gauss = 0;
  for (int k = -7; k <= 7; k++) { // from left to right
    const double *n = nodes[abs(k)];
    double y = p.y[k + 7] = at(asked, g, middle + (k < 0 ? -half : half) * n[0]);
    p.value += half * n[1] * y;
    p.size += half * n[1] * fabs(y);
    gauss += half * n[2] * y;
  }
  p.error = fabs(p.value - gauss);
  // QUADPACK: size * min(1, (200 error / size)^1.5); here, never more than the difference.
  double estimate = p.size * pow(200 * p.error / p.size, 1.5);
  if (p.size > 0 && 200 * p.error < p.size && estimate < p.error) p.error = estimate;
  return p;
}

// Evaluates the polynomial through the points of a part at x in -1 .. 1 (Neville's algorithm).
static double extrapolated(const Part *p, double x) {
  double y[15], t[15];
  for (int i = 0; i < 15; i++) {
    t[i] = i < 7 ? -nodes[7 - i][0] : nodes[i - 7][0];
    y[i] = p->y[i];
  }
  for (int n = 1; n < 15; n++)
    for (int i = 0; i + n < 15; i++)
      y[i] = ((x - t[i + n]) * y[i] + (t[i] - x) * y[i + 1]) / (t[i] - t[i + n]);
  return y[0];
}

// An extension of QUADPACK, for steps between an end of a part and the nearest point: compares the
// function at 2^-36 of the width from the end. Returns whether the part becomes doubtful.
static bool check_beside(Asked *asked, const Integral *g, Part *p, int end, double wanted) {
  const double width = p->to - p->from, by = ldexp(width, -36);
  const double t = end < 0 ? p->from + by : p->to - by;
  if (t == p->from || t == p->to) return false;
  const double off = fabs(at(asked, g, t) - extrapolated(p, end * (1 - ldexp(1, -35))));
  const double hidden = off * (1 - nodes[7][0]) * width / 2;
  if (off * width <= 1e-7 * p->size || hidden <= wanted || hidden <= p->error) return false;
  p->doubted = end;
  p->error = hidden;
  return true;
}

// QUADPACK's qag: the part with the largest error is halved until the sum of the errors is below
// 1e-11 of the result, or below 100 rounding units of the sum of sizes. Parts with an error below
// 50 rounding units are not divided. If both halves suddenly have no error, their common end is
// doubtful; so are the ends and the middle of the range if `check_beside` says so. There, eighths
// are cut off, with an error at least proportional to their width.
static double qag(Asked *asked, const Integral *g) {
  static Part parts[5000];
  size_t n = 2;
  const bool low = isinf(g->start), high = isinf(g->end);
  const double a = low && high ? -1 : low || high ? 0 : g->start, b = low || high ? 1 : g->end;
  const double center = (a + b) / 2, narrowest = ldexp(b - a, -150);
  bool looked = false;
  parts[0] = part(asked, g, a, center);
  parts[1] = part(asked, g, center, b);
  for (;;) {
    double error = 0, size = 0, value = 0;
    Part *worst = NULL;
    for (size_t i = 0; i < n; i++) {
      error += parts[i].error;
      size += parts[i].size;
      value += parts[i].value;
      if (parts[i].error > 50 * DBL_EPSILON * parts[i].size &&
          parts[i].to - parts[i].from > narrowest && (!worst || parts[i].error > worst->error))
        worst = &parts[i];
    }
    const double wanted = fmax(1e-11 * fabs(value), 100 * DBL_EPSILON * size);
    if (error <= wanted || !worst) {
      if (looked) return value;
      looked = true;
      bool found = false;
      for (size_t i = 0; i < n; i++)
        for (int end = -1; end <= 1; end += 2) {
          const double place = end < 0 ? parts[i].from : parts[i].to;
          if ((place == a || place == b || place == center) && !parts[i].doubted &&
              parts[i].to - parts[i].from > narrowest)
            found |= check_beside(asked, g, &parts[i], end, wanted);
        }
      if (!found) return value;
      continue;
    }
    const Part whole = *worst;
    const double eighth = (whole.to - whole.from) / 8;
    const double cut = whole.doubted < 0   ? whole.from + eighth
                       : whole.doubted > 0 ? whole.to - eighth
                                           : (whole.from + whole.to) / 2;
    Part left = part(asked, g, whole.from, cut), right = part(asked, g, cut, whole.to);
    if (!whole.doubted && fmax(left.error, right.error) <= 1e-8 * whole.error) {
      left.doubted = 1;
      right.doubted = -1;
      left.error = right.error = 0.05 * whole.error;
    }
    Part *end = whole.doubted < 0 ? &left : &right;
    if (whole.doubted && end->error <= whole.error / 8) {
      end->doubted = whole.doubted;
      end->error = whole.error / 8;
    }
    *worst = left;
    parts[n++] = right;
  }
}

static void integrate_asks_where_quadpack_does_and_beside_ends(void **state) {
  (void)state;
  static Trace trace;
  static Asked asked;
  char script[256];
  for (size_t i = 0; i < COUNT(integrals); i++) {
    const Integral *g = &integrals[i];
    snprintf(script, sizeof script, "g(x) = %s\nprint integrate(x => g(trace(x)), %.17g..%.17g)",
             g->text, g->start, g->end);
    run(script, &trace);
    assert_int_equal(trace.status, CAG_STATUS_OK);
    double found = strtod(trace.output, NULL);
    if (!(fabs(found - g->value) <= 1e-11 * fabs(g->value) + 1e-15))
      fail_msg("%s: %.17g instead of %.17g", script, found, g->value);
    asked.count = 0;
    double value = qag(&asked, g);
    if (!(fabs(value - found) <= 1e-13 * (1 + fabs(value))))
      fail_msg("%s: %.17g instead of %.17g, %zu %zu", script, found, value, trace.count,
               asked.count);
    compare(&trace, &asked, script);
    if (g->exact) assert_int_equal(trace.count, 34);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(minimize_asks_where_brent_does),
      cmocka_unit_test(find_root_asks_where_brent_does),
      cmocka_unit_test(integrate_asks_where_quadpack_does_and_beside_ends),
  };
  return cmocka_run_group_tests_name("calculus", tests, NULL, NULL);
}
