// Two NURBS curves with one knot vector (reference 06b, 7.5): both are clamped over 0..1, the lower
// degree is raised piece by piece, and each gets the knots it lacks. The shapes do not change.

#include "geom/surface/compatible.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// A clamped curve on its way: arrays with room to grow.
typedef struct Work {
  int degree;
  size_t count;
  double *knots, *net; // net: count x 4
} Work;

// Knots nearer than this part of the range are one knot.
#define SAME_KNOT 1e-9

static void work_free(Work *w) {
  free(w->knots);
  free(w->net);
  *w = (Work){0};
}

static CagStatus work_new(int degree, size_t count, Work *out, CagError *err) {
  *out = (Work){.degree = degree, .count = count};
  out->knots = malloc((count + (size_t)degree + 1) * sizeof(double));
  out->net = malloc(4 * count * sizeof(double));
  if (out->knots && out->net) return CAG_OK;
  work_free(out);
  return cag_fail_memory(err);
}

// Inserts the knot t once (Boehm 1980).
static CagStatus insert(Work *w, double t, CagError *err) {
  size_t p = (size_t)w->degree, n = w->count, span = p;
  while (span + 1 < n && w->knots[span + 1] <= t) span++;
  Work next;
  CagStatus status = work_new(w->degree, n + 1, &next, err);
  if (status) return status;
  for (size_t i = 0; i <= n; i++)
    for (size_t c = 0; c < 4; c++) {
      double *to = &next.net[4 * i + c];
      if (i + p <= span) *to = w->net[4 * i + c];
      else if (i > span) *to = w->net[4 * (i - 1) + c];
      else {
        double width = w->knots[i + p] - w->knots[i];
        double f = width > 0 ? (t - w->knots[i]) / width : 0;
        *to = (1 - f) * w->net[4 * (i - 1) + c] + f * w->net[4 * i + c];
      }
    }
  for (size_t i = 0; i < n + p + 2; i++)
    next.knots[i] = i <= span ? w->knots[i] : i == span + 1 ? t : w->knots[i - 1];
  work_free(w);
  *w = next;
  return CAG_OK;
}

static int multiplicity(const Work *w, double t) {
  int times = 0;
  for (size_t i = 0; i < w->count + (size_t)w->degree + 1; i++)
    times += fabs(w->knots[i] - t) <= SAME_KNOT;
  return times;
}

// The curve's data over 0..1, its ends interpolated.
static CagStatus load(const CagCurve *c, Work *out, CagError *err) {
  CagCurve *exact;
  CagStatus status = cag_curve_to_nurbs(c, &exact, err);
  if (status) return status;
  CagNurbsView view;
  cag_curve_nurbs_view(exact, &view);
  size_t p = (size_t)view.degree, n = view.count;
  Work w;
  status = work_new(view.degree, n, &w, err);
  if (!status) {
    double a = view.knots[p], b = view.knots[n];
    for (size_t i = 0; i < n + p + 1; i++) {
      double t = (view.knots[i] - a) / (b - a);
      w.knots[i] = view.knots[i] == a ? 0 : view.knots[i] == b ? 1 : t;
    }
    memcpy(w.net, view.homogeneous, 4 * n * sizeof(double));
  }
  cag_curve_release(exact);
  // An unclamped end: knots until it interpolates, then the rest is cut off.
  while (!status && w.knots[w.degree] != w.knots[1]) {
    double lowest = w.knots[1];
    status = insert(&w, 0, err);
    if (!status && w.knots[1] == lowest) {
      memmove(w.knots, w.knots + 1, (w.count + p) * sizeof(double));
      memmove(w.net, w.net + 4, 4 * (w.count - 1) * sizeof(double));
      w.count--;
    }
  }
  while (!status && w.knots[w.count] != w.knots[w.count + p - 1]) {
    double highest = w.knots[w.count + p - 1];
    status = insert(&w, 1, err);
    if (!status && w.knots[w.count + p - 1] == highest) w.count--;
  }
  if (status) {
    work_free(&w);
    return status;
  }
  w.knots[0] = 0;
  w.knots[w.count + p] = 1;
  *out = w;
  return CAG_OK;
}

// Raises the degree by one: every piece as a Bezier curve (reference 06b, 7.3), all inner knots to
// the new degree.
static CagStatus raise_degree(Work *w, CagError *err) {
  int p = w->degree;
  CagStatus status = CAG_OK;
  for (size_t i = (size_t)p + 1; !status && i < w->count; i++) {
    double t = w->knots[i];
    if (t > 0 && t < 1 && multiplicity(w, t) < p) status = insert(w, t, err);
  }
  if (status) return status;
  size_t pieces = (w->count - 1) / (size_t)p;
  Work next;
  status = work_new(p + 1, pieces * (size_t)(p + 1) + 1, &next, err);
  if (status) return status;
  size_t k = 0;
  for (int m = 0; m < p + 2; m++) next.knots[k++] = 0;
  for (size_t s = 0; s < pieces; s++) {
    const double *from = w->net + 4 * s * (size_t)p;
    double *to = next.net + 4 * s * (size_t)(p + 1);
    for (int i = 0; i <= p + 1; i++) {
      double f = (double)i / (p + 1);
      for (int c = 0; c < 4; c++) {
        double before = i > 0 ? from[4 * (i - 1) + c] : 0, here = i <= p ? from[4 * i + c] : 0;
        to[4 * i + c] = f * before + (1 - f) * here;
      }
    }
    double t = w->knots[(s + 1) * (size_t)p + 1];
    for (int m = 0; m < (s + 1 < pieces ? p + 1 : p + 2); m++) next.knots[k++] = t;
  }
  work_free(w);
  *w = next;
  return CAG_OK;
}

// Gives w the knots of `other` that it lacks; its own that are nearly the same move onto them.
static CagStatus take_knots(Work *w, const Work *other, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = (size_t)other->degree + 1; !status && i < other->count; i++) {
    double t = other->knots[i];
    if (t <= 0 || t >= 1) continue;
    while (!status && multiplicity(w, t) < multiplicity(other, t)) status = insert(w, t, err);
  }
  return status;
}

CagStatus cag_curves_compatible(const CagCurve *a, const CagCurve *b, CagCompatible *out,
                                CagError *err) {
  Work w[2] = {{0}, {0}};
  CagStatus status = load(a, &w[0], err);
  if (!status) status = load(b, &w[1], err);
  for (int i = 0; i < 2; i++)
    while (!status && w[i].degree < w[1 - i].degree) status = raise_degree(&w[i], err);
  if (!status) status = take_knots(&w[0], &w[1], err);
  if (!status) status = take_knots(&w[1], &w[0], err);
  if (status) {
    work_free(&w[0]);
    work_free(&w[1]);
    return status;
  }
  *out = (CagCompatible){w[0].degree, w[0].count, w[0].knots, {w[0].net, w[1].net}};
  free(w[1].knots);
  return CAG_OK;
}

void cag_compatible_free(CagCompatible *c) {
  free(c->knots);
  free(c->net[0]);
  free(c->net[1]);
  *c = (CagCompatible){0};
}
