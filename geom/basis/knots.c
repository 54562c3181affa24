// Knot vectors of B-splines. Nothing here allocates.

#include "geom/basis/knots.h"

#include "geom/basis/bernstein.h"
#include "geom/linalg/tolerance.h"

// Spacing is uniform within this fraction of the range: steps of 0.1 are not equal bit for bit.
#define EQUAL_SPACING CAG_COINCIDENT

void cag_knots_open(size_t n, int p, double *knots) {
  size_t m = n - (size_t)p;
  for (size_t i = 0; i < n + (size_t)p + 1; i++)
    knots[i] = i <= (size_t)p ? 0 : i < n ? (double)(i - (size_t)p) : (double)m;
}

void cag_knots_periodic(size_t n, int p, double *knots) {
  for (size_t i = 0; i < n + (size_t)p + 1; i++) knots[i] = (double)i;
}

// Inner knot i is the parameter after i (n - 1) / m of the polygon's n - 1 edges; edges shorter
// than `least` are counted with that length.
static void walk(const CagVec3 *points, size_t n, int p, double least, double total,
                 double *knots) {
  const size_t m = n - (size_t)p;
  double walked = 0; // length of the edges before `edge`
  size_t edge = 0;
  for (size_t i = 1; i < m; i++) {
    double q = (double)(i * (n - 1)) / (double)m;
    size_t e = i * (n - 1) / m;
    for (; edge < e; edge++)
      walked += fmax(least, cag_norm(cag_sub(points[edge + 1], points[edge])));
    double length = fmax(least, cag_norm(cag_sub(points[e + 1], points[e])));
    knots[(size_t)p + i] = (double)m * ((walked + (q - (double)e) * length) / total);
  }
}

void cag_knots_chord(const CagVec3 *points, size_t n, int p, double *knots) {
  // Minimum length of an edge as a fraction of the mean; otherwise repeated points would break the
  // curve.
  const double short_edge = 1e-3;
  cag_knots_open(n, p, knots);
  double total = 0;
  for (size_t i = 0; i + 1 < n; i++) total += cag_norm(cag_sub(points[i + 1], points[i]));
  if (!(total > 0)) return;
  walk(points, n, p, 0, total, knots);
  bool torn = false;
  for (size_t i = (size_t)p + 1; i < n; i++)
    torn = torn || !(knots[i] > 0 && knots[i] < knots[n]) ||
           (i > 2 * (size_t)p && knots[i] <= knots[i - (size_t)p]);
  if (!torn) return;
  const double least = short_edge * total / (double)(n - 1);
  total = 0;
  for (size_t i = 0; i + 1 < n; i++)
    total += fmax(least, cag_norm(cag_sub(points[i + 1], points[i])));
  walk(points, n, p, least, total, knots);
}

CagStatus cag_degree_check(size_t n, int p, CagError *err) {
  if (n < 2)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_too_few_points, "points", -1,
                    "expected at least 2 control points, found %zu", n);
  if (p < 1)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_order_range, "degree", -1,
                    "the degree must be at least 1, found %d", p);
  if ((size_t)p > n - 1)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_order_range, "degree", -1,
                    "degree %d needs at least %d control points, found %zu", p, p + 1, n);
  if (p > CAG_MAX_DEGREE)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_order_range, "degree", -1,
                    "the degree must be at most %d, found %d", CAG_MAX_DEGREE, p);
  return CAG_OK;
}

CagStatus cag_knots_check(const double *knots, size_t n, int p, CagError *err) {
  CagStatus status = cag_degree_check(n, p, err);
  if (status) return status;
  const size_t count = n + (size_t)p + 1;
  char a[32], b[32];
  for (size_t i = 0; i < count; i++) {
    if (!isfinite(knots[i]))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "knots", (long)i,
                      "knots[%zu] is not a finite number", i);
    if (i > 0 && knots[i] < knots[i - 1])
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_knots_not_monotone, "knots", (long)i,
                      "`knots` must not decrease: knots[%zu] = %s is less than knots[%zu] = %s", i,
                      cag_number_text(knots[i], a), i - 1, cag_number_text(knots[i - 1], b));
  }
  if (!(knots[p] < knots[n]))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_empty_range, "knots", p,
                    "the usable range of the knots, knots[%d]..knots[%zu]= %s..%s, has no length",
                    p, n, cag_number_text(knots[p], a), cag_number_text(knots[n], b));
  for (size_t i = 0, run = 1; i < count; i++, run++) {
    if (i > 0 && knots[i] != knots[i - 1]) run = 1;
    bool end = knots[i] <= knots[p] || knots[i] >= knots[n];
    size_t most = end ? (size_t)p + 1 : (size_t)p;
    if (run > most)
      return cag_fail(
          err, CAG_E_ARGUMENT, CAG_ERR_knot_multiplicity, "knots", (long)i,
          "the knot %s occurs more than %zu times: %s %s knot of degree %d may occur at most %zu times, or the curve would be discontinuous",
          cag_number_text(knots[i], a), most, cag_article(end ? "end" : "inner"),
          end ? "end" : "inner", p, most);
  }
  return CAG_OK;
}

bool cag_check_knots(const double *knots, size_t n, int p) {
  if (p < 1 || n <= (size_t)p || !isfinite(knots[0])) return false;
  for (size_t i = 1; i < n + (size_t)p + 1; i++)
    if (!isfinite(knots[i]) || knots[i] < knots[i - 1]) return false;
  return knots[p] < knots[n];
}

size_t cag_knots_span(const double *knots, size_t n, int p, double t, bool left, size_t hint) {
  size_t lo = (size_t)p, hi = n; // knots[lo] <= t, t <= knots[hi]
  if (hint >= lo && hint < hi && knots[hint] <= t && t < knots[hint + 1]) {
    lo = hint;
  } else {
    while (hi - lo > 1) {
      size_t mid = lo + (hi - lo) / 2;
      if (knots[mid] <= t) lo = mid;
      else hi = mid;
    }
  }
  // The last usable knot, and limits from the left, belong to the previous span.
  if (t >= knots[n] || left)
    while (lo > (size_t)p && knots[lo] >= t) lo--;
  while (knots[lo] >= knots[lo + 1] && lo + 1 < n) lo++;
  while (knots[lo] >= knots[lo + 1] && lo > (size_t)p) lo--;
  return lo;
}

int cag_knots_multiplicity(const double *knots, size_t n, int p, double t) {
  int m = 0;
  for (size_t i = 0; i < n + (size_t)p + 1; i++) m += knots[i] == t;
  return m;
}

const char *cag_knots_class(const double *knots, size_t n, int p) {
  const size_t last = n + (size_t)p;
  const double slack = EQUAL_SPACING * (knots[last] - knots[0]);
  bool uniform = true, inner = true;
  double step = (knots[last] - knots[0]) / (double)last;
  for (size_t i = 0; i < last; i++)
    uniform = uniform && fabs(knots[i + 1] - knots[i] - step) <= slack;
  if (uniform) return "uniform";
  if (knots[0] != knots[p] || knots[n] != knots[last]) return "nonuniform";
  step = (knots[n] - knots[p]) / (double)(n - (size_t)p);
  for (size_t i = (size_t)p; i < n; i++)
    inner = inner && fabs(knots[i + 1] - knots[i] - step) <= slack;
  return inner ? "open-uniform" : "open-nonuniform";
}
