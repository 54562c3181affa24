// Knot removal and degree reduction of B-splines, with bounds of the change.
//
// Both invert an averaging of neighbors: b_k = a_k g_k + (1 - a_k) g_{k-1} for k = 1..E, where g_0
// and g_E are fixed and the E - 1 points between are unknown. There is one equation more than
// unknowns, so the least change of the b_k that makes it solvable is a multiple of one vector.
//
// The bound: let h and g be homogeneous points over the same knots, S the points of h and w the
// weights of g. A point of g minus S is sum N_i (g_i.xyz - h_i.xyz - S (g_i.w - h_i.w)) / w, hence
// no longer than the largest |g_i.xyz - h_i.xyz| + M |g_i.w - h_i.w| over the smallest weight; M is
// the greatest distance of S from the origin, which is moved to the middle of the points. The sum
// over a net of a surface has the same form.

#include "geom/curve/reduce_rows.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/basis/bernstein.h"
#include "geom/basis/knots.h"
#include "geom/curve/family.h"

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

CagStatus cag_rows_new(int degree, size_t count, size_t across, bool rational, CagRows *out,
                       CagError *err) {
  *out = (CagRows){.degree = degree, .count = count, .across = across, .rational = rational};
  out->h = cag_malloc(sizeof(double) * 4 * across * count);
  out->knots = cag_malloc(sizeof(double) * (count + (size_t)degree + 1));
  if (out->h && out->knots) return CAG_OK;
  cag_rows_free(out);
  return cag_fail_memory(err);
}

void cag_rows_free(CagRows *rows) {
  cag_free(rows->h);
  cag_free(rows->knots);
  *rows = (CagRows){0};
}

// --- Removal ---

// b: E rows of `width` numbers; a: E numbers within (0, 1). g[0] and g[E] are given; computes the
// rows between and replaces b by their averages.
static void solve_chain(double *b, const double *a, size_t e, size_t width, double *g) {
  for (size_t c = 0; c < width; c++) {
    // z is orthogonal to the columns of the equations.
    double z = 1, zz = 0, sum = 0;
    for (int round = 0; round < 2; round++) {
      z = 1;
      for (size_t k = 0; k < e; k++) {
        if (k > 0) z *= -a[k - 1] / (1 - a[k]);
        double rest = b[width * k + c];
        if (k == 0) rest -= (1 - a[k]) * g[c];
        if (k + 1 == e) rest -= a[k] * g[width * e + c];
        if (round == 0) zz += z * z;
        if (round == 0) sum += z * rest;
        else b[width * k + c] -= z * (sum / zz);
      }
    }
  }
  // From both ends to the middle.
  size_t low = 1, high = e;
  for (; low < high; low++) {
    const double *from = g + width * (low - 1), *mean = b + width * (low - 1);
    for (size_t c = 0; c < width; c++)
      g[width * low + c] = (mean[c] - (1 - a[low - 1]) * from[c]) / a[low - 1];
    if (low + 1 >= high) break;
    high--;
    for (size_t c = 0; c < width; c++)
      g[width * high + c] =
          (b[width * high + c] - a[high] * g[width * (high + 1) + c]) / (1 - a[high]);
  }
}

// Buffers of solve_chain.
typedef struct Chain {
  double *b, *a, *g;
} Chain;

static CagStatus chain_make(Chain *c, int degree, size_t across, CagError *err) {
  const size_t n = (size_t)degree + 2;
  c->b = cag_malloc(sizeof(double) * (8 * across + 1) * n);
  if (!c->b) return cag_fail_memory(err);
  c->g = c->b + 4 * across * n;
  c->a = c->g + 4 * across * n;
  return CAG_OK;
}

static void set_weights(double *h, size_t points) {
  for (size_t i = 0; i < points; i++) h[4 * i + 3] = 1;
}

// Removes the occurrence of t at knots[r], the last of m <= degree, unless the deviation exceeds
// `most`; returns the deviation.
static double remove_once(CagRows *s, size_t r, int m, double most, Chain *chain) {
  const size_t p = (size_t)s->degree, e = (size_t)(s->degree - m + 1), first = r - 1 - p;
  const size_t width = 4 * s->across;
  const double t = s->knots[r], *x = s->knots;
  double *h = s->h;
  for (size_t k = 0; k < e; k++) {
    const size_t i = first + 1 + k;
    chain->a[k] = (t - x[i]) / (x[i + p + 1] - x[i]);
  }
  memcpy(chain->b, h + width * (first + 1), sizeof(double) * width * e);
  memcpy(chain->g, h + width * first, sizeof(double) * width);
  memcpy(chain->g + width * e, h + width * (first + e + 1), sizeof(double) * width);
  solve_chain(chain->b, chain->a, e, width, chain->g);
  if (!s->rational) {
    set_weights(chain->b, s->across * e);
    set_weights(chain->g, s->across * e);
  }
  const size_t low = first + 1 > p ? first + 1 - p : 0;
  const size_t high = first + 1 + e + p < s->count ? first + 1 + e + p : s->count;
  const double deviation = bound(h + width * (first + 1), chain->b, e * s->across, h + width * low,
                                 (high - low) * s->across);
  if (!(deviation <= most)) return deviation;
  memcpy(h + width * first, chain->g, sizeof(double) * width * e);
  memmove(h + width * (first + e), h + width * (first + e + 1),
          sizeof(double) * width * (s->count - first - e - 1));
  memmove(s->knots + r, s->knots + r + 1, sizeof(double) * (s->count + p - r));
  s->count--;
  return deviation;
}

static CagStatus fail_tolerance(double deviation, double tolerance, const char *what,
                                CagError *err) {
  char a[32], b[32];
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_tolerance_exceeded, "tolerance", -1,
                  "%s moves points by up to %s mm, more than the tolerance of %s mm", what,
                  cag_number_text(deviation, a), cag_number_text(tolerance, b));
}

CagStatus cag_rows_remove(CagRows *s, double t, int times, double tolerance, double *moved,
                          CagError *err) {
  const double start = s->knots[s->degree], end = s->knots[s->count];
  int m = t > start && t < end ? cag_knots_multiplicity(s->knots, s->count, s->degree, t) : 0;
  Chain chain = {0};
  char text[32];
  *moved = 0;
  if (times < 1 || m < times)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_no_such_knot, "t", -1,
                    "%s occurs %d times among the inner knots, so it cannot be removed %d times",
                    cag_number_text(t, text), m, times);
  CagStatus status = chain_make(&chain, s->degree, s->across, err);
  size_t r = 0;
  while (s->knots[r + 1] <= t) r++;
  for (int i = 0; !status && i < times; i++, m--, r--) {
    status = cag_stop_check(err);
    if (status) break;
    *moved += remove_once(s, r, m, tolerance - *moved, &chain);
    if (!(*moved <= tolerance))
      status = fail_tolerance(*moved, tolerance, "removing the knot", err);
  }
  cag_free(chain.b);
  return status;
}

// --- Reduction ---

// Reduces the degree of the pieces by one, with inner knots of multiplicity equal to the new
// degree; *deviation bounds the change.
static CagStatus reduce_pieces(const CagRowPieces *in, Chain *chain, CagRows *s, double *deviation,
                               CagError *err) {
  const size_t p = (size_t)in->degree, q = p - 1, e = p - 1, width = 4 * in->across;
  CagStatus status = cag_rows_new((int)q, in->pieces * q + 1, in->across, in->rational, s, err);
  if (status) return status;
  *deviation = 0;
  for (size_t k = 0; k < e; k++) chain->a[k] = 1 - (double)(k + 1) / (double)p;
  for (size_t i = 0; i < in->pieces; i++) {
    const double *b = in->h + i * p * width;
    if (cag_stop_check(err)) return err->status;
    memcpy(chain->b, b + width, sizeof(double) * width * e);
    memcpy(chain->g, b, sizeof(double) * width);
    memcpy(chain->g + width * e, b + width * p, sizeof(double) * width);
    solve_chain(chain->b, chain->a, e, width, chain->g);
    if (!in->rational) {
      set_weights(chain->g, in->across * (e + 1));
      set_weights(chain->b, in->across * e);
    }
    *deviation =
        fmax(*deviation, bound(b + width, chain->b, e * in->across, b, (p + 1) * in->across));
    memcpy(s->h + i * q * width, chain->g, sizeof(double) * width * (q + 1));
  }
  for (size_t i = 0; i < s->count + q + 1; i++) {
    const size_t cut = i == 0 ? 0 : (i - 1) / q;
    s->knots[i] = in->cuts[cut < in->pieces ? cut : in->pieces];
  }
  return CAG_OK;
}

// Removes knots that the smoothness of the pieces does not need, within the tolerance.
static CagStatus remove_unneeded(const CagRowPieces *in, double limit, Chain *chain, CagRows *s,
                                 double *moved, CagError *err) {
  for (size_t i = in->pieces; i-- > 1;) {
    const int want = in->multiplicity[i] - 1;
    size_t r = (i + 1) * (size_t)s->degree;
    if (cag_stop_check(err)) return err->status;
    for (int m = s->degree; m > 1 && m > want; m--, r--) {
      const double d = remove_once(s, r, m, limit - *moved, chain);
      if (!(*moved + d <= limit)) break;
      *moved += d;
    }
  }
  return CAG_OK;
}

CagStatus cag_rows_reduce(const CagRowPieces *in, double tolerance, CagRows *out, double *moved,
                          CagError *err) {
  Chain chain = {0};
  *out = (CagRows){0};
  if (in->degree < 2)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_order_range, "", -1, "degree 1 is the lowest");
  CagStatus status = chain_make(&chain, in->degree, in->across, err);
  if (!status) status = reduce_pieces(in, &chain, out, moved, err);
  if (!status && !(*moved <= tolerance))
    status = fail_tolerance(*moved, tolerance, "lowering the degree", err);
  const double limit = isfinite(tolerance) ? tolerance : *moved;
  if (!status) status = remove_unneeded(in, limit, &chain, out, moved, err);
  cag_free(chain.b);
  if (status) cag_rows_free(out);
  return status;
}
