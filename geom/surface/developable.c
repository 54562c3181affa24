// The developable surface between two curves (the tangent plane stays the same along each ruling).
//
// A ruling joins a(s) and b(t) if both tangents and the ruling are coplanar:
// F(s, t) = det(a'(s), b'(t), b(t) - a(s)) = 0. From a first such pair the matching t(s) is traced
// by dt/ds = -F_s / F_t and Newton's method, and stored as a series. It must increase, or rulings
// would cross. If equal fractions of both domains match already, as for parallel curves, the
// surface is a plain ruled one.

#include <float.h>
#include <math.h>
#include <stdio.h>

#include "base/memory.h"
#include "geom/basis/chebyshev.h"
#include "geom/curve/frenet.h"
#include "geom/surface/family.h"
#include "geom/surface/patches.h"

// F of unit vectors below this is rounding.
#define SAME_PLANE 1e-10
// Number of parameters tried for a first ruling, and of steps along the first curve.
#define PLACES 512
#define STEPS 512
#define NEWTON_STEPS 60
// Tolerance of the series of t(s), as a fraction of the domain.
#define SERIES 1e-13
// A matching that covers less than this fraction of a curve is rejected.
#define LEAST_PART 1e-3

typedef struct Match {
  const CagCurve *a, *b; // of space
  double t_low, t_high;  // range of t; beyond the domain if b is closed
  double s[STEPS + 1], t[STEPS + 1];
  size_t n; // pairs found
} Match;

typedef struct Developable {
  CagSurface base;
  CagCurve *a, *b;
  double s0, s1;   // of a over v in 0..1
  CagChebyshev *t; // of b by v
} Developable;

static const CagSurfaceKind developable_kind;

// --- The condition ---

// t reduced to the domain of b, if b is closed.
static double home(const CagCurve *b, double t) {
  double period = b->end - b->start;
  if (b->closed && (t > b->end || t < b->start)) t -= period * floor((t - b->start) / period);
  return fmin(fmax(t, b->start), b->end);
}

typedef struct Condition {
  double f, by_s, by_t; // F divided by the magnitudes of its vectors, and its derivatives
  double sense;         // of the tangents: their cosine
  double length;        // length of the ruling
} Condition;

static CagStatus condition(const Match *m, double s, double t, Condition *out, CagError *err) {
  CagVec3 a[3], b[3];
  CagStatus status =
      cag_curve_eval(m->a, fmin(fmax(s, m->a->start), m->a->end), 2, CAG_SIDE_RIGHT, a, err);
  if (!status) status = cag_curve_eval(m->b, home(m->b, t), 2, CAG_SIDE_RIGHT, b, err);
  if (status) return status;
  CagVec3 r = cag_sub(b[0], a[0]);
  double size = cag_norm(a[1]) * cag_norm(b[1]) * cag_norm(r);
  *out = (Condition){0, 0, 0, cag_dot(cag_unit(a[1]), cag_unit(b[1])), cag_norm(r)};
  if (!(size > 0)) return CAG_OK;
  out->f = cag_dot(cag_cross(a[1], b[1]), r) / size;
  out->by_s = cag_dot(cag_cross(a[2], b[1]), r) / size; // a' x b' . a' is 0
  out->by_t = cag_dot(cag_cross(a[1], b[2]), r) / size;
  return CAG_OK;
}

// The root of F with respect to t, or to s if `of_s`, between two values of opposite sign.
static CagStatus solve(const Match *m, bool of_s, double fixed, double lo, double hi, double *out,
                       CagError *err) {
  Condition c, at_lo;
  CagStatus status = condition(m, of_s ? lo : fixed, of_s ? fixed : lo, &at_lo, err);
  double x = (lo + hi) / 2;
  for (int k = 0; !status && k < NEWTON_STEPS; k++) {
    status = condition(m, of_s ? x : fixed, of_s ? fixed : x, &c, err);
    if (status || c.f == 0) break;
    if ((c.f > 0) == (at_lo.f > 0)) lo = x;
    else hi = x;
    double slope = of_s ? c.by_s : c.by_t, next = slope != 0 ? x - c.f / slope : lo;
    if (!(next > lo && next < hi)) next = (lo + hi) / 2;
    if (next == x || hi - lo <= DBL_EPSILON * fmax(fabs(lo), fabs(hi))) break;
    x = next;
  }
  *out = x;
  return status;
}

// --- The first ruling ---

static double sample_parameter(double lo, double hi, int i) { return lo + (hi - lo) * i / PLACES; }

// The root nearest to the start of one curve, with the parameter of the other fixed at its start.
// Tangents must have the same direction there.
static CagStatus first_root(const Match *m, bool of_s, bool *found, double *out, CagError *err) {
  const CagCurve *free_ = of_s ? m->a : m->b;
  double fixed = of_s ? m->b->start : m->a->start, best = INFINITY;
  double period = free_->end - free_->start;
  Condition last = {0}, c;
  *found = false;
  for (int i = 0; i <= PLACES; i++) {
    double x = sample_parameter(free_->start, free_->end, i), root = x;
    CagStatus status = condition(m, of_s ? x : fixed, of_s ? fixed : x, &c, err);
    if (status) return status;
    bool hit = fabs(c.f) <= SAME_PLANE, crossing = i > 0 && last.f * c.f < 0;
    if (!hit && crossing)
      status =
          solve(m, of_s, fixed, sample_parameter(free_->start, free_->end, i - 1), x, &root, err);
    if (status) return status;
    double away = root - free_->start;
    if (free_->closed && !of_s) away = fmin(away, period - away);
    if ((hit || crossing) && c.sense > 0 && away < best) {
      best = away;
      *out = root;
      *found = true;
    }
    last = c;
  }
  return CAG_OK;
}

static CagStatus no_ruling(CagError *err, const char *why) {
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_no_rulings, "", -1,
                  "there is no developable surface between the curves: %s", why);
}

// --- Tracing ---

// The t of the ruling at s, near a guess. Beyond the end of b it is extrapolated by the slope
// there.
static CagStatus newton(const Match *m, double s, double guess, bool *good, double *out,
                        CagError *err) {
  double t = guess, range = m->t_high - m->t_low;
  *good = false;
  for (int k = 0; k < NEWTON_STEPS; k++) {
    Condition c;
    t = fmin(t, m->t_high);
    CagStatus status = condition(m, s, t, &c, err);
    if (status) return status;
    if (c.by_t == 0) return CAG_OK;
    double step = -c.f / c.by_t;
    if (t == m->t_high && step > 0) {
      *good = true;
      *out = t + fmin(step, range / 8);
      return CAG_OK;
    }
    if (fabs(step) > range) return CAG_OK;
    t += step;
    if (fabs(step) > 4 * DBL_EPSILON * fmax(fabs(t), range)) continue;
    *good = true;
    *out = t;
    return CAG_OK;
  }
  // Converged to rounding, or stuck at a break of the slope without a root.
  Condition c;
  CagStatus status = condition(m, s, t, &c, err);
  if (status) return status;
  *good = fabs(c.f) <= SAME_PLANE;
  *out = t;
  return CAG_OK;
}

static CagStatus follow(Match *m, double s0, double t0, CagError *err) {
  double end = m->a->end, range = m->t_high - m->t_low;
  m->s[0] = s0;
  m->t[0] = t0;
  m->n = 1;
  for (int i = 1; i <= STEPS; i++) {
    double s = i == STEPS ? end : s0 + (end - s0) * i / STEPS, last = m->t[m->n - 1], t = 0;
    bool good;
    Condition c;
    CagStatus status = condition(m, m->s[m->n - 1], last, &c, err);
    if (status) return status;
    double slope = c.by_t != 0 ? -c.by_s / c.by_t : 0;
    status = newton(m, s, last + slope * (s - m->s[m->n - 1]), &good, &t, err);
    if (status) return status;
    if (!good || !(t > last) || t - last > range / 4)
      return no_ruling(err, "the rulings would cross each other");
    if (t > m->t_high) {
      // The last ruling ends at the end of b.
      double root;
      status = solve(m, true, m->t_high, m->s[m->n - 1], s, &root, err);
      if (status) return status;
      if (root > m->s[m->n - 1]) {
        m->s[m->n] = root;
        m->t[m->n++] = m->t_high;
      }
      break;
    }
    m->s[m->n] = s;
    m->t[m->n++] = t;
  }
  double part_a = (m->s[m->n - 1] - s0) / (m->a->end - m->a->start);
  if (m->n < 2 || part_a < LEAST_PART || (m->t[m->n - 1] - t0) / range < LEAST_PART)
    return no_ruling(err, "rulings with one tangent plane join only single points of them");
  return CAG_OK;
}

// t by v in 0..1, for the series.
static CagStatus matched(void *context, double v, double *out, CagError *err) {
  const Match *m = context;
  double first = m->s[0], last = m->s[m->n - 1];
  double s = v >= 1 ? last : first + v * (last - first);
  size_t lo = 0, hi = m->n - 1;
  while (hi - lo > 1) {
    size_t middle = (lo + hi) / 2;
    if (m->s[middle] <= s) lo = middle;
    else hi = middle;
  }
  double f = (s - m->s[lo]) / (m->s[hi] - m->s[lo]);
  *out = m->t[lo] + f * (m->t[hi] - m->t[lo]);
  if (f <= 0 || f >= 1) return CAG_OK;
  bool good;
  double t = *out;
  CagStatus status = newton(m, s, *out, &good, &t, err);
  if (!status && good && t >= m->t[lo] && t <= m->t[hi]) *out = t;
  return status;
}

// --- The surface ---

// Derivatives 0..n by v of a curve at parameter x(v), whose derivatives are given.
static CagStatus along(const CagCurve *c, const double *x, int n, CagSide side, CagVec3 *out,
                       CagError *err) {
  CagVec3 d[CAG_MAX_PARTIAL + 1];
  CagStatus status = cag_curve_eval(c, home(c, x[0]), n, side, d, err);
  if (status) return status;
  out[0] = d[0];
  return n > 0 ? cag_chain_derivatives(d + 1, x + 1, n, out + 1, err) : CAG_OK;
}

static CagStatus developable_eval(const CagSurface *surface, double u, double v, int n, CagSide su,
                                  CagSide sv, CagVec3 *out, CagError *err) {
  (void)su;
  const Developable *w = (const Developable *)surface;
  CagVec3 a[CAG_MAX_PARTIAL + 1], b[CAG_MAX_PARTIAL + 1];
  double s[CAG_MAX_PARTIAL + 1] = {v >= 1 ? w->s1 : w->s0 + v * (w->s1 - w->s0), w->s1 - w->s0};
  double t[CAG_MAX_PARTIAL + 1], factorial = 1;
  cag_chebyshev_series(w->t, v, sv == CAG_SIDE_LEFT, n, t);
  for (int k = 1; k <= n; k++) t[k] *= factorial *= k;
  CagStatus status = along(w->a, s, n, sv, a, err);
  if (!status) status = along(w->b, t, n, sv, b, err);
  if (status) return status;
  for (int i = 0; i <= n; i++)
    for (int j = 0; i + j <= n; j++)
      out[cag_partial(n, i, j)] = i == 0   ? cag_add(cag_scaled(b[j], 1 - u), cag_scaled(a[j], u))
                                  : i == 1 ? cag_sub(a[j], b[j])
                                           : cag_vec3(0, 0, 0);
  return CAG_OK;
}

static size_t developable_breaks(const CagSurface *s, int direction, double *out, size_t capacity) {
  const Developable *w = (const Developable *)s;
  if (direction == 0) return 0;
  size_t of_t = cag_chebyshev_breaks(w->t, NULL, 0);
  size_t of_a = w->a->kind->breaks ? w->a->kind->breaks(w->a, NULL, 0) : 0, n = of_t;
  double *all = cag_malloc((of_t + of_a + 1) * sizeof *all);
  if (!all) return cag_note_memory(), 0;
  cag_chebyshev_breaks(w->t, all, of_t);
  if (of_a > 0) w->a->kind->breaks(w->a, all + n, of_a);
  for (size_t i = 0; i < of_a; i++) all[of_t + i] = (all[of_t + i] - w->s0) / (w->s1 - w->s0);
  n = cag_surface_tidy_breaks(all, of_t + of_a, 0, 1);
  for (size_t i = 0; i < n && i < capacity; i++) out[i] = all[i];
  cag_free(all);
  return n;
}

static void developable_describe(const CagSurface *s, char *buffer, size_t size) {
  const Developable *w = (const Developable *)s;
  snprintf(buffer, size, "between %s %s and %s %s", cag_article(w->a->kind->name), w->a->kind->name,
           cag_article(w->b->kind->name), w->b->kind->name);
}

static void developable_destroy(CagSurface *s) {
  Developable *w = (Developable *)s;
  cag_curve_release(w->a);
  cag_curve_release(w->b);
  cag_chebyshev_release(w->t);
}

static void developable_digest(const CagSurface *surface, CagDigest *d) {
  const Developable *s = (const Developable *)surface;
  cag_curve_digest(s->a, d);
  cag_curve_digest(s->b, d);
  cag_digest_number(d, s->s0);
  cag_digest_number(d, s->s1);
  if (s->t) cag_chebyshev_digest(s->t, d);
}

static const CagSurfaceKind developable_kind = {
    .name = "developable",
    .eval = developable_eval,
    .breaks = developable_breaks,
    .describe = developable_describe,
    .destroy = developable_destroy,
    .digest = developable_digest,
};

// Whether rulings match equal fractions of the domains.
static CagStatus is_plain(const Match *m, bool *out, CagError *err) {
  double longest = 0;
  CagBounds box;
  CagStatus bounded = cag_curve_bounds(m->a, &box, err);
  if (bounded) return bounded;
  *out = true;
  for (int i = 0; *out && i <= PLACES; i++) {
    Condition c;
    CagStatus status = condition(m, sample_parameter(m->a->start, m->a->end, i),
                                 sample_parameter(m->b->start, m->b->end, i), &c, err);
    if (status) return status;
    *out = fabs(c.f) <= SAME_PLANE;
    longest = fmax(longest, c.length);
  }
  if (*out && longest <= CAG_SURFACE_SAME * cag_norm(cag_sub(box.max, box.min)))
    return no_ruling(err, "they are the same curve");
  return CAG_OK;
}

static CagStatus build(const Match *m, CagSurface **out, CagError *err) {
  CagSurface *s;
  CagChebyshev *t;
  CagStatus status = cag_chebyshev_fit(matched, (void *)m, 0, 1, 1, SERIES, "curve", &t, err);
  if (status) return status;
  status = cag_surface_block(sizeof(Developable), &developable_kind, 0, 1, 0, 1, &s, err);
  if (status) {
    cag_chebyshev_release(t);
    return status;
  }
  Developable *w = (Developable *)s;
  w->a = cag_curve_retain(m->a);
  w->b = cag_curve_retain(m->b);
  w->s0 = m->s[0];
  w->s1 = m->s[m->n - 1];
  w->t = t;
  cag_surface_judge(s);
  *out = s;
  return CAG_OK;
}

static CagStatus match(Match *m, CagSurface **out, CagError *err) {
  bool plain, found;
  double s0 = m->a->start, t0 = m->b->start;
  CagStatus status = is_plain(m, &plain, err);
  if (status) return status;
  if (plain) return cag_surface_ruled(m->a, m->b, out, err);
  status = first_root(m, false, &found, &t0, err);
  if (!status && !found) {
    t0 = m->b->start;
    status = first_root(m, true, &found, &s0, err);
  }
  if (status) return status;
  if (!found)
    return no_ruling(err, "no line from the start of one to the other lies in one plane with the "
                          "tangents at both ends");
  m->t_low = t0;
  m->t_high = m->b->closed ? t0 + (m->b->end - m->b->start) : m->b->end;
  if (!(m->t_high > t0))
    return no_ruling(err, "the first ruling is at the end of the second curve");
  status = follow(m, s0, t0, err);
  return status ? status : build(m, out, err);
}

CagStatus cag_surface_developable(const CagCurve *first, const CagCurve *second, CagSurface **out,
                                  CagError *err) {
  CagCurve *a = NULL, *b = NULL;
  Match *m = cag_malloc(sizeof *m);
  CagStatus status = m ? cag_surface_space_curve(first, &a, err) : cag_fail_memory(err);
  if (!status) status = cag_surface_space_curve(second, &b, err);
  if (!status) {
    m->a = a;
    m->b = b;
    m->t_low = b->start;
    m->t_high = b->end;
    status = match(m, out, err);
  }
  cag_curve_release(a);
  cag_curve_release(b);
  cag_free(m);
  return status;
}
