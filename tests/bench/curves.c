// Curves compared with SISL 4.6, in one run: evaluation, arc length, curves from data, and closest
// points. Uses SISL if its header is installed (CAG_SISL); otherwise, the column of the peer is
// empty.
//
// The curve is a cubic of 20 control points on a bent helix, polynomial and rational. Every figure
// is the best of five rounds over the same parameters, in random order. A sum of the results is
// kept, so that the compiler cannot omit anything. Where SISL computes the same quantity, the two
// are compared.

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#ifdef CAG_SISL
#include <sisl.h>
// SISL defines these as macros.
#undef MAX
#undef MIN
#endif

#include "geom/curve/curve.h"
#include "geom/curve/fit.h"

#define ROUNDS 5
#define EVALUATIONS 1000000
#define POINTS 20
#define DEGREE 3
#define QUERIES 2000
#define PIECES 100
#define DATA 100000
#define FITTED 1000 // control points of the least squares fit

// Processor time, so that other programs do not count.
static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void check(bool ok, const char *what) {
  if (ok) return;
  fprintf(stderr, "curves: %s\n", what);
  exit(1);
}

// Park and Miller's multiplicative generator: the same parameters on every machine.
static double random_fraction(void) {
  static uint64_t state = 1;
  state = state * 48271 % 2147483647;
  return (double)state / 2147483647;
}

// name, our seconds, SISL's seconds (0: not available), the required ratio of SISL's time to ours
// (0: none).
static void report(const char *name, double ours, double sisl, double aim) {
  printf("%-52s %10.4f ms", name, 1e3 * ours);
  if (sisl > 0) printf("   SISL %10.4f ms   %6.2f times as fast", 1e3 * sisl, sisl / ours);
  if (aim > 0) printf("   aim >= %g", aim);
  putchar('\n');
}

// --- The curve, and its SISL counterpart ---

typedef struct Subject {
  CagCurve *ours;
#ifdef CAG_SISL
  SISLCurve *theirs;
#endif
  double start, end;
} Subject;

static Subject make_subject(size_t n, bool rational) {
  CagVec3 *points = malloc(n * sizeof *points);
  double *weights = malloc(n * sizeof *weights);
  double *knots = malloc((n + DEGREE + 1) * sizeof *knots);
  double *flat = malloc(4 * n * sizeof *flat);
  check(points && weights && knots && flat, "no memory");
  for (size_t i = 0; i < n; i++) {
    double a = 0.7 * (double)i;
    points[i] = cag_vec3(40 * cos(a) + a, 30 * sin(a), 3 * a + 5 * cos(3 * a));
    weights[i] = rational ? 1 + 0.5 * sin(2 * a) : 1;
    const double w = weights[i], h[4] = {w * points[i].x, w * points[i].y, w * points[i].z, w};
    const size_t stride = rational ? 4 : 3;
    for (size_t k = 0; k < stride; k++) flat[stride * i + k] = h[k];
  }
  CagError err;
  Subject s = {0};
  check(cag_knots_make("open", n, DEGREE, points, knots, &err) == CAG_OK, err.message);
  check(cag_curve_nurbs(points, rational ? weights : NULL, n, DEGREE, knots, 3, &s.ours, &err) ==
            CAG_OK,
        err.message);
  s.start = s.ours->start;
  s.end = s.ours->end;
#ifdef CAG_SISL
  s.theirs = newCurve((int)n, DEGREE + 1, knots, flat, rational ? 2 : 1, 3, 1);
  check(s.theirs != NULL, "SISL makes no curve");
#endif
  free(points);
  free(weights);
  free(knots);
  free(flat);
  return s;
}

static void free_subject(Subject *s) {
  cag_curve_release(s->ours);
#ifdef CAG_SISL
  freeCurve(s->theirs);
#endif
}

// --- Point and two derivatives ---

// Sum of all coordinates of point, first and second derivative.
static double total(const CagVec3 e[3]) {
  CagVec3 s = cag_add(cag_add(e[0], e[1]), e[2]);
  return s.x + s.y + s.z;
}

static double one_by_one(const Subject *s, const double *t, double *sum) {
  CagError err;
  CagVec3 e[3];
  double begin = now();
  *sum = 0;
  for (size_t i = 0; i < EVALUATIONS; i++) {
    check(cag_curve_eval(s->ours, t[i], 2, CAG_SIDE_RIGHT, e, &err) == CAG_OK, err.message);
    *sum += total(e);
  }
  return now() - begin;
}

static double together(const Subject *s, const double *t, CagVec3 *out, double *sum) {
  CagError err;
  double begin = now();
  check(cag_curve_eval_many(s->ours, t, EVALUATIONS, 2, out, &err) == CAG_OK, err.message);
  double seconds = now() - begin;
  *sum = 0;
  for (size_t i = 0; i < EVALUATIONS; i++) *sum += total(out + 3 * i);
  return seconds;
}

// `order`: the number of derivatives.
static double of_sisl(const Subject *s, const double *t, int order, double *sum) {
  *sum = 0;
#ifdef CAG_SISL
  int left = 0, status;
  double e[9];
  double begin = now();
  for (size_t i = 0; i < EVALUATIONS; i++) {
    s1227(s->theirs, order, t[i], &left, e, &status);
    check(status >= 0, "s1227 fails");
    for (int k = 0; k < 3 * (order + 1); k++) *sum += e[k];
  }
  return now() - begin;
#else
  (void)s;
  (void)t;
  (void)order;
  return 0;
#endif
}

static double best(double a, double b) { return a == 0 || b < a ? b : a; }

static bool agree(double a, double b) { return fabs(a - b) <= 1e-9 * (1 + fabs(b)); }

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

// `order` describes the order of the parameters. SISL, too, starts from the previous span.
static void measure_evaluation(const char *kind, const char *order, bool rational, bool sorted) {
  Subject s = make_subject(POINTS, rational);
  double *t = malloc(EVALUATIONS * sizeof *t);
  CagVec3 *out = malloc(3 * EVALUATIONS * sizeof *out);
  check(t && out, "no memory");
  for (size_t i = 0; i < EVALUATIONS; i++) t[i] = s.start + (s.end - s.start) * random_fraction();
  if (sorted) qsort(t, EVALUATIONS, sizeof *t, ascending);
  double single = 0, many = 0, sisl = 0, sums[3];
  for (int round = 0; round < ROUNDS; round++) {
    single = best(single, one_by_one(&s, t, &sums[0]));
    many = best(many, together(&s, t, out, &sums[1]));
    sisl = best(sisl, of_sisl(&s, t, 2, &sums[2]));
  }
  check(agree(sums[0], sums[1]), "one by one and together differ");
  check(sisl == 0 || agree(sums[0], sums[2]), "SISL and we differ");
  char name[64];
  snprintf(name, sizeof name, "%s, parameters %s, one by one", kind, order);
  report(name, single, sisl, 3);
  snprintf(name, sizeof name, "%s, parameters %s, together", kind, order);
  report(name, many, sisl, 8);
  free(t);
  free(out);
  free_subject(&s);
}

// --- The language's `sample` ---

// `seconds`: the time of a script for 10^6 points, measured outside. SISL's points are at the same
// equal steps.
static void compare_sample(const char *kind, bool rational, double seconds) {
  Subject s = make_subject(POINTS, rational);
  double *t = malloc(EVALUATIONS * sizeof *t), sisl = 0, derivatives = 0, sum;
  check(t != NULL, "no memory");
  for (size_t i = 0; i < EVALUATIONS; i++)
    t[i] = s.start + (s.end - s.start) * (double)i / (EVALUATIONS - 1);
  for (int round = 0; round < ROUNDS; round++) {
    sisl = best(sisl, of_sisl(&s, t, 0, &sum));
    derivatives = best(derivatives, of_sisl(&s, t, 2, &sum));
  }
  char name[64];
  snprintf(name, sizeof name, "%s, `sample`, SISL: points", kind);
  report(name, seconds, sisl, 0);
  snprintf(name, sizeof name, "%s, `sample`, SISL: with derivatives", kind);
  report(name, seconds, derivatives, 8);
  free(t);
  free_subject(&s);
}

// --- Arc length ---

static void measure_length(void) {
  Subject s = make_subject(PIECES + DEGREE, false);
  CagError err;
  double ours = 0, sisl = 0, length = 0, theirs = 0;
  for (int round = 0; round < ROUNDS; round++) {
    double begin = now();
    check(cag_curve_length(s.ours, s.start, s.end, &length, &err) == CAG_OK, err.message);
    ours = best(ours, now() - begin);
#ifdef CAG_SISL
    int status;
    begin = now();
    s1240(s.theirs, 1e-10 * length, &theirs, &status);
    sisl = best(sisl, now() - begin);
#endif
  }
  report("arc length of 100 cubic pieces to 1e-10", ours, sisl, 0);
  printf("    aim < 1 ms; the length is %.12g", length);
  if (sisl > 0) printf(", SISL's differs by %.1e of it", fabs(theirs - length) / length);
  putchar('\n');
  free_subject(&s);
}

// --- Curves from data ---

// A curve through all the data, and one of FITTED control points by least squares. The data are on
// a smooth curve, so both must be close: the first up to rounding, the second up to its spans.
static void measure_fits(void) {
  CagVec3 *points = malloc(DATA * sizeof *points);
  check(points != NULL, "no memory");
  for (size_t i = 0; i < DATA; i++) {
    double a = 40.0 * (double)i / DATA;
    points[i] = cag_vec3(40 * cos(a) + a, 30 * sin(a), 3 * a);
  }
  CagFitData data = {
      .points = points, .n = DATA, .spacing = CAG_SPACING_CHORD, .degree = DEGREE, .dimension = 3};
  double through = 0, least = 0, rms = 0;
  CagError err;
  for (int round = 0; round < ROUNDS; round++) {
    CagCurve *c;
    CagFitReport fit;
    double begin = now();
    check(cag_curve_interpolate(&data, NULL, 0, &c, &err) == CAG_OK, err.message);
    through = best(through, now() - begin);
    cag_curve_release(c);
    begin = now();
    check(cag_curve_fit(&data, FITTED, true, -1, 0, &c, &fit, &err) == CAG_OK, err.message);
    least = best(least, now() - begin);
    rms = fit.rms;
    cag_fit_report_free(&fit);
    cag_curve_release(c);
  }
  report("cubic through 10^5 points", through, 0, 0);
  printf("    aim < 500 ms\n");
  report("10^5 points by 1000 control points", least, 0, 0);
  printf("    aim < 1000 ms; the rms is %.1e\n", rms);
  free(points);
}

// --- Closest point ---

static double sisl_closest(const Subject *s, const CagVec3 *p, double *distance) {
#ifdef CAG_SISL
  double begin = now();
  for (size_t i = 0; i < QUERIES; i++) {
    double point[3] = {p[i].x, p[i].y, p[i].z}, *at = NULL, e[3];
    int n = 0, m = 0, status, left = 0;
    SISLIntcurve **curves = NULL;
    s1953(s->theirs, point, 3, 1e-12, 1e-9, &n, &at, &m, &curves, &status);
    check(status >= 0 && n > 0, "s1953 fails");
    s1227(s->theirs, 0, at[0], &left, e, &status);
    distance[i] = cag_norm(cag_sub(cag_vec3(e[0], e[1], e[2]), p[i]));
    if (curves) freeIntcrvlist(curves, m);
    free(at);
  }
  return now() - begin;
#else
  (void)s;
  (void)p;
  (void)distance;
  return 0;
#endif
}

static void measure_closest(const char *name, bool rational) {
  Subject s = make_subject(POINTS, rational);
  CagVec3 *p = malloc(QUERIES * sizeof *p), q;
  double *distance = malloc(QUERIES * sizeof *distance);
  double *theirs = malloc(QUERIES * sizeof *theirs);
  check(p && distance && theirs, "no memory");
  for (size_t i = 0; i < QUERIES; i++)
    p[i] = cag_vec3(120 * random_fraction() - 60, 100 * random_fraction() - 50,
                    70 * random_fraction() - 10);
  double ours = 0, sisl = 0, t;
  CagError err;
  for (int round = 0; round < ROUNDS; round++) {
    double begin = now();
    for (size_t i = 0; i < QUERIES; i++)
      check(cag_curve_closest(s.ours, p[i], &t, &q, &distance[i], &err) == CAG_OK, err.message);
    ours = best(ours, now() - begin);
    sisl = best(sisl, sisl_closest(&s, p, theirs));
  }
  report(name, ours, sisl, 1);
  size_t farther = 0, nearer = 0;
  for (size_t i = 0; sisl > 0 && i < QUERIES; i++) {
    farther += distance[i] > theirs[i] * (1 + 1e-9);
    nearer += distance[i] < theirs[i] * (1 - 1e-9);
  }
  if (sisl > 0)
    printf("    of %d points, ours is farther than SISL's for %zu (aim 0), nearer for %zu\n",
           QUERIES, farther, nearer);
  free(p);
  free(distance);
  free(theirs);
  free_subject(&s);
}

// Arguments: the seconds that scripts need to sample the polynomial and the rational curve.
int main(int argc, char **argv) {
  measure_evaluation("cubic B-spline", "at random", false, false);
  measure_evaluation("cubic B-spline", "ascending", false, true);
  measure_evaluation("cubic NURBS", "at random", true, false);
  measure_evaluation("cubic NURBS", "ascending", true, true);
  if (argc > 2) {
    compare_sample("cubic B-spline", false, strtod(argv[1], NULL));
    compare_sample("cubic NURBS", true, strtod(argv[2], NULL));
  }
  measure_length();
  measure_fits();
  measure_closest("2000 closest points, cubic B-spline", false);
  measure_closest("2000 closest points, cubic NURBS", true);
  return 0;
}
