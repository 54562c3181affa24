// All feet of perpendiculars from a point to a curve.
//
// They are the zeros of f = (C - P) . C'. On each smooth piece, f is approximated by Chebyshev
// series, whose ranges over an interval exclude zeros or show that there is at most one, because f
// is monotonic. Other intervals are halved. What is left are zeros of higher order, at which P is a
// center of curvature.

#include "geom/curve/feet.h"

#include <stdlib.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/basis/chebyshev.h"
#include "geom/curve/family.h"
#include "geom/linalg/tolerance.h"

// The error of the series, relative to their largest value.
#define SERIES 1e-13
// f vanishes along a piece, or at a point, if it is below this fraction of |C - P| |C'|.
#define NOTHING 1e-11
#define NOTHING_HERE 1e-10
// Intervals are not halved further below this fraction of a piece. Zeros that are closer are one.
#define NARROW 1e-7
// f is 0 within rounding below this fraction of |C - P| |C'|.
#define ROUNDED 1e-15
// The kind of a zero of higher order is that of the signs of f at this fraction of the piece aside.
#define ASIDE 1e-3
// Points at which the curve stands still are not feet.
#define STANDS CAG_COINCIDENT
enum { BISECTIONS = 100, SAMPLES = 16 };

typedef struct Search {
  const CagCurve *curve;
  CagVec3 target;
  double low, high;   // the piece
  double speed, size; // the largest |C'| and |C - P| on it
  const CagChebyshev *series;
  double narrow_from, narrow_to; // the narrow intervals before, which are adjacent; NaN: none
  CagFoot *feet;
  size_t n, capacity;
} Search;

static CagStatus derivatives(const Search *s, double t, int order, CagVec3 *d, CagError *err) {
  return cag_curve_eval(s->curve, t, order, t >= s->high ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, d, err);
}

static CagStatus slope_at(const Search *s, double t, double *out, CagError *err) {
  CagVec3 d[2];
  CagStatus status = derivatives(s, t, 1, d, err);
  if (!status) *out = cag_dot(cag_sub(d[0], s->target), d[1]);
  return status;
}

static CagStatus sampled_slope(void *context, double t, double *out, CagError *err) {
  return slope_at(context, t, out, err);
}

static double noise(const Search *s, double part) { return part * s->speed * s->size; }

// --- Feet ---

// Where the derivative of f vanishes, the signs of f on both sides decide. At an end of the piece,
// the side that is missing is like the other one.
static CagStatus flat_kind(const Search *s, double t, CagFootKind *kind, CagError *err) {
  const double step = ASIDE * (s->high - s->low);
  double before, after;
  CagStatus status = slope_at(s, fmax(s->low, t - step), &before, err);
  if (!status) status = slope_at(s, fmin(s->high, t + step), &after, err);
  if (status) return status;
  if (t - step < s->low) before = -after;
  else if (t + step > s->high) after = -before;
  *kind = before <= 0 && after >= 0   ? CAG_FOOT_MINIMUM
          : before >= 0 && after <= 0 ? CAG_FOOT_MAXIMUM
                                      : CAG_FOOT_INFLECTION;
  return CAG_OK;
}

static CagStatus add_foot(Search *s, double t, bool flat, CagError *err) {
  CagVec3 d[3];
  CagStatus status = derivatives(s, t, 2, d, err);
  if (status) return status;
  if (cag_norm(d[1]) <= STANDS * s->speed) return CAG_OK;
  const CagVec3 r = cag_sub(d[0], s->target);
  const double slope = cag_dot(d[1], d[1]) + cag_dot(r, d[2]);
  CagFoot foot = {{t, 0}, d[0], cag_norm(r), slope > 0 ? CAG_FOOT_MINIMUM : CAG_FOOT_MAXIMUM};
  if (flat) status = flat_kind(s, t, &foot.kind, err);
  if (status) return status;
  if (!CAG_RESERVE(s->feet, s->capacity, s->n + 1)) return cag_fail_memory(err);
  s->feet[s->n++] = foot;
  return CAG_OK;
}

// The zero between a and b, where f has different signs.
static CagStatus bisect(Search *s, double a, double b, double at_a, bool flat, CagError *err) {
  CagStatus status = CAG_OK;
  for (int i = 0; !status && i < BISECTIONS; i++) {
    const double middle = a + (b - a) / 2;
    double f = 0;
    if (!(a < middle && middle < b)) break;
    status = slope_at(s, middle, &f, err);
    if ((f < 0) == (at_a < 0)) a = middle;
    else b = middle;
  }
  return status ? status : add_foot(s, a + (b - a) / 2, flat, err);
}

// --- Zeros of a piece ---

// Ends a run of narrow intervals, which have a zero of higher order, or two that are almost one.
static CagStatus end_narrow(Search *s, CagError *err) {
  const double from = s->narrow_from, to = s->narrow_to;
  double low, high, middle;
  if (isnan(from)) return CAG_OK;
  s->narrow_from = s->narrow_to = NAN;
  CagStatus status = slope_at(s, from, &low, err);
  if (!status) status = slope_at(s, to, &high, err);
  if (!status) status = slope_at(s, from + (to - from) / 2, &middle, err);
  if (status) return status;
  // A zero at an end of the piece is there exactly.
  if (from == s->low && fabs(low) <= noise(s, ROUNDED)) return add_foot(s, from, true, err);
  if (to == s->high && fabs(high) <= noise(s, ROUNDED)) return add_foot(s, to, true, err);
  if (low * high < 0) return bisect(s, from, to, low, true, err);
  if (fabs(middle) > noise(s, NOTHING_HERE)) return CAG_OK;
  return add_foot(s, from + (to - from) / 2, true, err);
}

static bool excludes_zero(CagInterval x) { return x.lo > 0 || x.hi < 0; }

// At most one zero, because f is monotonic.
static CagStatus search_monotonic(Search *s, double a, double b, CagError *err) {
  double low, high;
  CagStatus status = slope_at(s, a, &low, err);
  if (!status) status = slope_at(s, b, &high, err);
  if (status) return status;
  // Within the piece, a zero at b belongs to the next interval.
  const double nothing = noise(s, ROUNDED);
  if (low == 0 || (a == s->low && fabs(low) <= nothing)) return add_foot(s, a, false, err);
  if (b == s->high && fabs(high) <= nothing) return add_foot(s, b, false, err);
  return low * high < 0 ? bisect(s, a, b, low, false, err) : CAG_OK;
}

static CagStatus search_between(Search *s, double a, double b, CagError *err) {
  CagInterval range[2];
  if (cag_stop_check(err)) return err->status;
  cag_chebyshev_ranges(s->series, a, b, 1, range);
  // The series may be off by their error.
  const double off = noise(s, SERIES);
  range[0].lo -= off;
  range[0].hi += off;
  const bool none = excludes_zero(range[0]), monotonic = excludes_zero(range[1]);
  const double middle = a + (b - a) / 2;
  const bool narrow = b - a <= NARROW * (s->high - s->low) || !(a < middle && middle < b);
  if (narrow && !none && !monotonic) {
    if (isnan(s->narrow_from)) s->narrow_from = a;
    s->narrow_to = b;
    return CAG_OK;
  }
  if (none || monotonic) {
    CagStatus status = end_narrow(s, err);
    return status || none ? status : search_monotonic(s, a, b, err);
  }
  CagStatus status = search_between(s, a, middle, err);
  return status ? status : search_between(s, middle, b, err);
}

// Finds the scales of a piece. *all: f vanishes along it.
static CagStatus measure_piece(Search *s, bool *all, CagError *err) {
  double most = 0;
  s->speed = s->size = 0;
  for (int i = 0; i <= SAMPLES; i++) {
    CagVec3 d[2];
    const double t = s->low + (s->high - s->low) * i / SAMPLES;
    CagStatus status = derivatives(s, i == SAMPLES ? s->high : t, 1, d, err);
    if (status) return status;
    const CagVec3 r = cag_sub(d[0], s->target);
    s->speed = fmax(s->speed, cag_norm(d[1]));
    s->size = fmax(s->size, cag_norm(r));
    most = fmax(most, fabs(cag_dot(r, d[1])));
  }
  *all = most <= noise(s, NOTHING) && s->size > 0 && s->speed > 0;
  return CAG_OK;
}

static CagStatus fail_piece(const Search *s, CagError *err) {
  const double shown = s->curve->angular ? 180 / M_PI : 1;
  const char *deg = s->curve->angular ? "deg" : "";
  char from[32], to[32];
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_not_unique, "P", -1,
                  "all points of the curve from %s%s to %s%s have the same distance from it",
                  cag_number_text(shown * s->low, from), deg, cag_number_text(shown * s->high, to),
                  deg);
}

static CagStatus search_piece(Search *s, CagError *err) {
  CagChebyshev *series;
  bool all;
  CagStatus status = measure_piece(s, &all, err);
  if (status) return status;
  if (all) return fail_piece(s, err);
  if (!(s->size > 0 && s->speed > 0)) return CAG_OK;
  status = cag_chebyshev_fit(sampled_slope, s, s->low, s->high, 1, SERIES, "C", &series, err);
  if (status) return status;
  const size_t joints = cag_chebyshev_joints(series, NULL, 0);
  double *at = cag_malloc((joints + 2) * sizeof *at);
  if (!at) status = cag_fail_memory(err);
  else {
    cag_chebyshev_joints(series, at + 1, joints);
    at[0] = s->low;
    at[joints + 1] = s->high;
  }
  s->series = series;
  s->narrow_from = s->narrow_to = NAN;
  for (size_t i = 0; !status && i <= joints; i++) status = search_between(s, at[i], at[i + 1], err);
  if (!status) status = end_narrow(s, err);
  cag_free(at);
  cag_chebyshev_release(series);
  return status;
}

// --- All pieces ---

static int by_parameter(const void *a, const void *b) {
  const double x = ((const CagFoot *)a)->at[0], y = ((const CagFoot *)b)->at[0];
  return (x > y) - (x < y);
}

// Sorts the feet, and removes those that were found in two pieces or intervals.
static void tidy_feet(Search *s, double narrow) {
  size_t kept = 0;
  if (s->n > 1) qsort(s->feet, s->n, sizeof *s->feet, by_parameter);
  for (size_t i = 0; i < s->n; i++)
    if (kept == 0 || s->feet[i].at[0] - s->feet[kept - 1].at[0] > narrow)
      s->feet[kept++] = s->feet[i];
  const CagCurve *c = s->curve;
  if (kept > 1 && c->closed && s->feet[0].at[0] - c->start <= narrow &&
      c->end - s->feet[kept - 1].at[0] <= narrow)
    kept--;
  s->n = kept;
}

CagStatus cag_curve_feet(const CagCurve *c, CagVec3 p, CagFoot **out, size_t *n, CagError *err) {
  Search s = {.curve = c, .target = p};
  double *cuts = NULL, shortest = INFINITY;
  size_t count = 0;
  CagStatus status = cag_curve_check_points(&p, 1, "P", err);
  if (!status) status = cag_curve_cuts(c, &cuts, &count, err);
  for (size_t i = 0; !status && i + 1 < count; i++) {
    s.low = cuts[i];
    s.high = cuts[i + 1];
    shortest = fmin(shortest, s.high - s.low);
    status = search_piece(&s, err);
  }
  cag_free(cuts);
  if (status) {
    cag_free(s.feet);
    return status;
  }
  tidy_feet(&s, NARROW * shortest);
  *out = s.feet;
  *n = s.n;
  return CAG_OK;
}
