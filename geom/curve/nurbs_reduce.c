// Knot removal and degree reduction of NURBS curves, with bounds of the change.
//
// Both invert an averaging of neighbors: b_k = a_k g_k + (1 - a_k) g_{k-1} for k = 1..E, where g_0
// and g_E are fixed and the E - 1 points between are unknown. There is one equation more than
// unknowns, so the least change of the b_k that makes it solvable is a multiple of one vector.
//
// The bound: let h and g be homogeneous points over the same knots, S the points of h and w the
// weights of g. A point of g minus S is sum N_i (g_i.xyz - h_i.xyz - S (g_i.w - h_i.w)) / w, hence
// no longer than the largest |g_i.xyz - h_i.xyz| + M |g_i.w - h_i.w| over the smallest weight; M is
// the greatest distance of S from the origin, which is moved to the middle of the points.

#include <string.h>

#include "base/memory.h"
#include "geom/curve/family.h"
#include "geom/curve/nurbs.h"
#include "geom/curve/nurbs_ops.h"

// h: the old points, g: the new ones, n each; `around`: all points that influence the same range.
static double bound(const double *h, const double *g, size_t n, const double *around,
                    size_t count) {
  CagBounds box = CAG_BOUNDS_EMPTY;
  double least = INFINITY, most = 0;
  for (size_t i = 0; i < count; i++) {
    if (around[4 * i + 3] > 0) cag_bounds_add(&box, cag_project(around + 4 * i));
    least = fmin(least, around[4 * i + 3]);
  }
  const CagVec3 middle = cag_lerp(box.min, box.max, 0.5);
  const double reach = cag_norm(cag_sub(box.max, middle));
  for (size_t i = 0; i < n; i++) {
    const double *a = h + 4 * i, *b = g + 4 * i;
    const double weight = a[3] - b[3];
    if (!(b[3] >= 0)) return INFINITY;
    least = fmin(least, b[3]);
    CagVec3 d = {a[0] - b[0] - weight * middle.x, a[1] - b[1] - weight * middle.y,
                 a[2] - b[2] - weight * middle.z};
    most = fmax(most, cag_norm(d) + reach * fabs(weight));
  }
  // If a weight is 0, there is a bound only for curves that do not change.
  return most == 0 ? 0 : most / least;
}

// A working copy: n points, n + p + 1 knots.
typedef struct Spline {
  int p;
  size_t n;
  bool rational;
  double *h, *knots;
} Spline;

static void spline_free(Spline *s) {
  cag_free(s->h);
  cag_free(s->knots);
}

static CagStatus spline_make(Spline *s, int p, size_t n, bool rational, CagError *err) {
  *s = (Spline){.p = p, .n = n, .rational = rational};
  s->h = cag_malloc(sizeof(double) * 4 * n);
  s->knots = cag_malloc(sizeof(double) * (n + (size_t)p + 1));
  return s->h && s->knots ? CAG_OK : cag_fail_memory(err);
}

// --- Removal ---

// b: E points; a: E numbers within (0, 1). g[0] and g[E] are given; computes the points between and
// replaces b by their averages.
static void solve_chain(double *b, const double *a, size_t e, double *g) {
  // z is orthogonal to the columns of the equations.
  double z = 1, zz = 0, sum[4] = {0};
  for (int round = 0; round < 2; round++) {
    z = 1;
    for (size_t k = 0; k < e; k++) {
      if (k > 0) z *= -a[k - 1] / (1 - a[k]);
      zz += round == 0 ? z * z : 0;
      for (size_t c = 0; c < 4; c++) {
        double rest = b[4 * k + c];
        if (k == 0) rest -= (1 - a[k]) * g[c];
        if (k + 1 == e) rest -= a[k] * g[4 * e + c];
        if (round == 0) sum[c] += z * rest;
        else b[4 * k + c] -= z * (sum[c] / zz);
      }
    }
  }
  // From both ends to the middle.
  size_t low = 1, high = e;
  for (; low < high; low++) {
    for (size_t c = 0; c < 4; c++)
      g[4 * low + c] =
          (b[4 * (low - 1) + c] - (1 - a[low - 1]) * g[4 * (low - 1) + c]) / a[low - 1];
    if (low + 1 >= high) break;
    high--;
    for (size_t c = 0; c < 4; c++)
      g[4 * high + c] = (b[4 * high + c] - a[high] * g[4 * (high + 1) + c]) / (1 - a[high]);
  }
}

// Buffers of solve_chain for curves of degree p.
typedef struct Chain {
  double *b, *a, *g;
} Chain;

static CagStatus chain_make(Chain *c, int p, CagError *err) {
  const size_t n = (size_t)p + 2;
  c->b = cag_malloc(sizeof(double) * 9 * n);
  if (!c->b) return cag_fail_memory(err);
  c->g = c->b + 4 * n;
  c->a = c->g + 4 * n;
  return CAG_OK;
}

// Removes the occurrence of t at knots[r], the last of m <= p, unless the deviation exceeds `most`;
// returns the deviation.
static double remove_once(Spline *s, size_t r, int m, double most, Chain *chain) {
  const size_t p = (size_t)s->p, e = (size_t)(s->p - m + 1), first = r - 1 - p;
  const double t = s->knots[r], *x = s->knots;
  double *h = s->h;
  for (size_t k = 0; k < e; k++) {
    const size_t i = first + 1 + k;
    chain->a[k] = (t - x[i]) / (x[i + p + 1] - x[i]);
  }
  memcpy(chain->b, h + 4 * (first + 1), sizeof(double) * 4 * e);
  memcpy(chain->g, h + 4 * first, 4 * sizeof(double));
  memcpy(chain->g + 4 * e, h + 4 * (first + e + 1), 4 * sizeof(double));
  solve_chain(chain->b, chain->a, e, chain->g);
  for (size_t k = 0; !s->rational && k < e; k++) chain->b[4 * k + 3] = 1;
  for (size_t k = 0; !s->rational && k < e; k++) chain->g[4 * k + 3] = 1;
  const size_t low = first + 1 > p ? first + 1 - p : 0;
  const size_t high = first + 1 + e + p < s->n ? first + 1 + e + p : s->n;
  const double deviation = bound(h + 4 * (first + 1), chain->b, e, h + 4 * low, high - low);
  if (!(deviation <= most)) return deviation;
  memcpy(h + 4 * first, chain->g, sizeof(double) * 4 * e);
  memmove(h + 4 * (first + e), h + 4 * (first + e + 1),
          sizeof(double) * 4 * (s->n - first - e - 1));
  memmove(s->knots + r, s->knots + r + 1, sizeof(double) * (s->n + p - r));
  s->n--;
  return deviation;
}

static CagStatus fail_tolerance(double deviation, double tolerance, const char *what,
                                CagError *err) {
  char a[32], b[32];
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_tolerance_exceeded, "tolerance", -1,
                  "%s moves points by up to %s mm, more than the tolerance of %s mm", what,
                  cag_number_text(deviation, a), cag_number_text(tolerance, b));
}

static CagStatus spline_curve(const Spline *s, const CagCurve *like, CagCurve **out,
                              CagError *err) {
  return cag_nurbs_new(s->h, s->n, s->p, s->knots, s->rational, 0,
                       s->rational ? CAG_NURBS_RATIONAL : CAG_NURBS_BSPLINE, like->dimension, out,
                       err);
}

CagStatus cag_curve_remove_knot(const CagCurve *c, double t, int times, double tolerance,
                                CagCurve **out, double *deviation, CagError *err) {
  CagCurve *exact, *open = NULL;
  Spline s = {0};
  Chain chain = {0};
  double moved = 0;
  char text[32];
  CagStatus status = cag_curve_to_nurbs(c, &exact, err);
  if (status) return status;
  const CagNurbs *n = cag_nurbs_data(exact);
  if (n->periodic) status = cag_curve_clamp(exact, &open, err);
  else open = cag_curve_retain(exact);
  cag_curve_release(exact);
  if (status) return status;
  n = cag_nurbs_data(open);
  int m = t > c->start && t < c->end ? cag_knots_multiplicity(n->knots, n->count, n->degree, t) : 0;
  if (times < 1 || m < times)
    status = cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_no_such_knot, "t", -1,
                      "%s occurs %d times among the inner knots, so it cannot be removed %d times",
                      cag_number_text(t, text), m, times);
  if (!status) status = spline_make(&s, n->degree, n->count, n->rational, err);
  if (!status) status = chain_make(&chain, n->degree, err);
  if (!status) {
    memcpy(s.h, n->homogeneous, sizeof(double) * 4 * n->count);
    memcpy(s.knots, n->knots, sizeof(double) * (n->count + (size_t)n->degree + 1));
    size_t r = 0;
    while (s.knots[r + 1] <= t) r++;
    for (int i = 0; !status && i < times; i++, m--, r--) {
      double d = remove_once(&s, r, m, tolerance - moved, &chain);
      moved += d;
      if (!(moved <= tolerance))
        status = fail_tolerance(moved, tolerance, "removing the knot", err);
    }
  }
  if (!status) status = spline_curve(&s, c, out, err);
  if (!status && deviation) *deviation = moved;
  cag_free(chain.b);
  spline_free(&s);
  cag_curve_release(open);
  return status;
}

// --- Reduction ---

// Reduces the degree of the pieces of n by one, with inner knots of multiplicity equal to the new
// degree; *deviation bounds the change.
static CagStatus reduce_pieces(const CagNurbs *n, Chain *chain, Spline *s, double *deviation,
                               CagError *err) {
  const size_t p = (size_t)n->degree, q = p - 1, e = p - 1;
  CagStatus status = spline_make(s, (int)q, n->pieces * q + 1, n->rational, err);
  if (status) return status;
  *deviation = 0;
  for (size_t k = 0; k < e; k++) chain->a[k] = 1 - (double)(k + 1) / (double)p;
  for (size_t i = 0; i < n->pieces; i++) {
    const double *b = cag_nurbs_bezier(n, i);
    memcpy(chain->b, b + 4, sizeof(double) * 4 * e);
    memcpy(chain->g, b, 4 * sizeof(double));
    memcpy(chain->g + 4 * e, b + 4 * p, 4 * sizeof(double));
    solve_chain(chain->b, chain->a, e, chain->g);
    for (size_t k = 0; !n->rational && k <= e; k++) chain->g[4 * k + 3] = 1;
    for (size_t k = 0; !n->rational && k < e; k++) chain->b[4 * k + 3] = 1;
    *deviation = fmax(*deviation, bound(b + 4, chain->b, e, b, p + 1));
    memcpy(s->h + 4 * i * q, chain->g, sizeof(double) * 4 * (q + 1));
  }
  for (size_t i = 0; i < s->n + q + 1; i++) {
    const size_t cut = i == 0 ? 0 : (i - 1) / q;
    s->knots[i] = n->cuts[cut < n->pieces ? cut : n->pieces];
  }
  return CAG_OK;
}

CagStatus cag_curve_reduce_degree(const CagCurve *c, double tolerance, CagCurve **out,
                                  double *deviation, CagError *err) {
  CagCurve *open;
  CagStatus status = cag_curve_to_nurbs(c, &open, err);
  if (status) return status;
  CagCurve *exact = open;
  status = cag_curve_clamp(exact, &open, err);
  cag_curve_release(exact);
  if (status) return status;
  const CagNurbs *n = cag_nurbs_data(open);
  Spline s = {0};
  Chain chain = {0};
  double moved = 0;
  if (n->degree < 2)
    status = cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_order_range, "C", -1,
                      "a curve of degree 1 has no lower degree");
  if (!status) status = chain_make(&chain, n->degree, err);
  if (!status) status = reduce_pieces(n, &chain, &s, &moved, err);
  if (!status && !(moved <= tolerance))
    status = fail_tolerance(moved, tolerance, "lowering the degree", err);
  // Removes knots that the smoothness of the curve does not need, within the tolerance.
  const double limit = isfinite(tolerance) ? tolerance : moved;
  for (size_t i = n->pieces; !status && i-- > 1;) {
    int m = s.p, want = cag_knots_multiplicity(n->knots, n->count, n->degree, n->cuts[i]) - 1;
    size_t r = i * (size_t)s.p + (size_t)s.p;
    for (; m > 1 && m > want; m--, r--) {
      double d = remove_once(&s, r, m, limit - moved, &chain);
      if (!(moved + d <= limit)) break;
      moved += d;
    }
  }
  if (!status) status = spline_curve(&s, c, out, err);
  if (!status && deviation) *deviation = moved;
  cag_free(chain.b);
  spline_free(&s);
  cag_curve_release(open);
  return status;
}
