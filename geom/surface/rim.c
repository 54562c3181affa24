// Rims: curves moved inward while they rise, between miters.
//
// All derivatives are those of truncated power series. The ends of a rim with miters are functions
// t(v), whose series solve the equation of the miter order by order; with t linear in u between
// them, C(t) + d(v) N(t) is a composition of series.

#include "geom/surface/rim.h"

#include <math.h>
#include <stdio.h>

#include "base/memory.h"
#include "geom/linalg/tolerance.h"
#include "geom/surface/family.h"

#define SIDE (CAG_MAX_PARTIAL + 1)
// Newton's method starts within a step of the miter; it converges in a few iterations or not at
// all.
#define NEWTON 30
// Halvings of a step that Newton's method does not solve, before the miter counts as used up.
#define HALVINGS 6

typedef struct Rim {
  CagSurface base;
  CagCurve *curve;
  CagRimProfile profile;
  CagRimMiter miter[2];
  CagKeptBreaks breaks; // in u
} Rim;

static const double FACTORIAL[] = {1, 1, 2, 6, 24, 120, 720, 5040, 40320};

// --- Series ---

// Taylor coefficients of a curve and of its normal, by its parameter.
typedef struct Strand {
  CagVec3 c[SIDE], n[SIDE];
} Strand;

static CagStatus strand_at(const CagCurve *curve, double t, int order, CagSide side, Strand *out,
                           CagError *err) {
  CagVec3 d[SIDE + 1], along[SIDE];
  double w[SIDE], f[SIDE];
  t = fmin(fmax(t, curve->start), curve->end);
  const CagStatus status = cag_curve_eval(curve, t, order + 1, side, d, err);
  if (status) return status;
  for (int k = 0; k <= order; k++) {
    out->c[k] = cag_scaled(d[k], 1 / FACTORIAL[k]);
    along[k] = cag_scaled(d[k + 1], 1 / FACTORIAL[k]);
  }
  if (!(cag_dot(along[0], along[0]) > 0))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_degenerate_normal, "", -1,
                    "the outline has no normal where its derivative is 0");
  // f = w^(-1/2) with w = C' . C': w D f = -1/2 f D w, order by order.
  for (int k = 0; k <= order; k++) {
    w[k] = 0;
    for (int i = 0; i <= k; i++) w[k] += cag_dot(along[i], along[k - i]);
    double sum = 0;
    for (int i = 1; i <= k; i++) sum += (-0.5 * i - (k - i)) * w[i] * f[k - i];
    f[k] = k == 0 ? 1 / sqrt(w[0]) : sum / (k * w[0]);
    CagVec3 unit = {0, 0, 0};
    for (int i = 0; i <= k; i++) unit = cag_madd(unit, f[i], along[k - i]);
    out->n[k] = cag_vec3(-unit.y, unit.x, 0);
  }
  return CAG_OK;
}

// Taylor coefficients of d and e at v.
static void profile_series(const CagRimProfile *p, double v, int order, double d[SIDE],
                           double e[SIDE]) {
  const double rate = M_PI / 2;
  for (int k = 0; k <= order; k++) d[k] = e[k] = 0;
  if (!p->round) {
    d[0] = e[0] = p->reach * v;
    if (order > 0) d[1] = e[1] = p->reach;
    return;
  }
  double sine, cosine, factor = p->reach;
  cag_sincos(rate * v, &sine, &cosine);
  for (int k = 0; k <= order; k++) {
    const double s[4] = {sine, cosine, -sine, -cosine};
    e[k] = factor * s[k % 4];
    d[k] = -factor * s[(k + 1) % 4];
    factor *= rate / (k + 1);
  }
  d[0] += p->reach;
}

// Series in u and v, of total order up to `order` and of order up to `wide` in u.
typedef struct Plane {
  double c[SIDE][SIDE];
} Plane;
typedef struct Space {
  CagVec3 c[SIDE][SIDE];
} Space;

// The sum of a[k] t^k, where t has no constant term, by Horner's scheme.
static void series_compose(const CagVec3 *a, const Plane *t, int order, int wide, Space *out) {
  *out = (Space){0};
  for (int k = order; k >= 0; k--) {
    Space next = {0};
    for (int i = 0; i <= wide; i++)
      for (int j = 0; i + j <= order; j++)
        for (int m = 0; m <= i; m++)
          for (int l = 0; l <= j; l++)
            next.c[i][j] = cag_madd(next.c[i][j], t->c[m][l], out->c[i - m][j - l]);
    next.c[0][0] = cag_add(next.c[0][0], a[k]);
    *out = next;
  }
}

// C(t) + d(v) N(t).
static void series_inward(const Strand *s, const Plane *t, const double d[SIDE], int order,
                          int wide, Space *out) {
  Space normal;
  series_compose(s->c, t, order, wide, out);
  series_compose(s->n, t, order, wide, &normal);
  for (int i = 0; i <= wide; i++)
    for (int j = 0; i + j <= order; j++)
      for (int l = 0; l <= j; l++) out->c[i][j] = cag_madd(out->c[i][j], d[l], normal.c[i][j - l]);
}

// --- Miters ---

// The derivatives of both moved curves by their parameters, the second one negated.
static double miter_matrix(const Strand s[2], double d, CagVec3 j[2]) {
  j[0] = cag_madd(s[0].c[1], d, s[0].n[1]);
  j[1] = cag_scaled(cag_madd(s[1].c[1], d, s[1].n[1]), -1);
  return cag_cross(j[0], j[1]).z;
}

static void miter_step(const CagVec3 j[2], double det, CagVec3 f, double out[2]) {
  out[0] = -cag_cross(f, j[1]).z / det;
  out[1] = -cag_cross(j[0], f).z / det;
}

static CagStatus miter_strands(const CagRimMiter *m, const double t[2], int order, Strand s[2],
                               CagError *err) {
  CagStatus status = strand_at(m->curves[0], t[0], order, CAG_SIDE_LEFT, &s[0], err);
  return status ? status : strand_at(m->curves[1], t[1], order, CAG_SIDE_RIGHT, &s[1], err);
}

// Newton's method from t; *found: it converged within the curves.
static CagStatus miter_solve(const CagRimMiter *m, double d, double t[2], bool *found,
                             CagError *err) {
  const double small = 4e-15; // of the domains: the rounding of the parameters
  double length[2];
  for (int i = 0; i < 2; i++) length[i] = m->curves[i]->end - m->curves[i]->start;
  *found = false;
  for (int k = 0; k < NEWTON; k++) {
    Strand s[2];
    CagVec3 j[2];
    double step[2];
    const CagStatus status = miter_strands(m, t, 1, s, err);
    if (status) return status;
    const double det = miter_matrix(s, d, j);
    if (!(fabs(det) > CAG_ROUNDING * cag_norm(j[0]) * cag_norm(j[1]))) return CAG_OK;
    miter_step(j, det,
               cag_sub(cag_madd(s[0].c[0], d, s[0].n[0]), cag_madd(s[1].c[0], d, s[1].n[0])), step);
    bool still = true;
    for (int i = 0; i < 2; i++) {
      t[i] += step[i];
      still = still && fabs(step[i]) <= small * length[i];
      if (!(fabs(step[i]) <= length[i])) return CAG_OK;
      // Steps out of the domain are rounding, or the curve is used up.
      if (t[i] < m->curves[i]->start - CAG_COINCIDENT * length[i] ||
          t[i] > m->curves[i]->end + CAG_COINCIDENT * length[i])
        return CAG_OK;
      t[i] = fmin(fmax(t[i], m->curves[i]->start), m->curves[i]->end);
    }
    if (still || k == NEWTON - 1) {
      *found = still || fabs(step[0]) <= CAG_ROUNDING * length[0];
      return CAG_OK;
    }
  }
  return CAG_OK;
}

static double inward_at(const CagRimProfile *p, double v) {
  double d[SIDE], e[SIDE];
  profile_series(p, v, 0, d, e);
  return d[0];
}

// From v = a to v = b, in smaller steps where one does not converge.
static CagStatus miter_advance(const CagRimMiter *m, const CagRimProfile *p, double a, double b,
                               int halvings, double t[2], bool *found, CagError *err) {
  double tried[2] = {t[0], t[1]};
  CagStatus status = miter_solve(m, inward_at(p, b), tried, found, err);
  if (status) return status;
  if (*found) {
    t[0] = tried[0];
    t[1] = tried[1];
    return CAG_OK;
  }
  if (halvings == 0) return CAG_OK;
  const double middle = (a + b) / 2;
  status = miter_advance(m, p, a, middle, halvings - 1, t, found, err);
  if (status || !*found) return status;
  return miter_advance(m, p, middle, b, halvings - 1, t, found, err);
}

CagStatus cag_rim_miter(const CagCurve *before, const CagCurve *after, const CagRimProfile *p,
                        bool *fits, CagRimMiter *out, CagError *err) {
  CagRimMiter m = {.curves = {(CagCurve *)before, (CagCurve *)after}};
  double t[2] = {before->end, after->start};
  m.at[0][0] = t[0];
  m.at[0][1] = t[1];
  *fits = true;
  for (int k = 1; *fits && k <= CAG_RIM_STEPS; k++) {
    const CagStatus status = miter_advance(&m, p, (double)(k - 1) / CAG_RIM_STEPS,
                                           (double)k / CAG_RIM_STEPS, HALVINGS, t, fits, err);
    if (status) return status;
    // Both curves get shorter.
    *fits = *fits && t[0] <= m.at[k - 1][0] && t[1] >= m.at[k - 1][1];
    m.at[k][0] = t[0];
    m.at[k][1] = t[1];
  }
  if (!*fits) return CAG_OK;
  for (int i = 0; i < 2; i++) m.curves[i] = cag_curve_retain(m.curves[i]);
  *out = m;
  return CAG_OK;
}

void cag_rim_miter_free(CagRimMiter *m) {
  for (int i = 0; i < 2; i++) {
    cag_curve_release(m->curves[i]);
    m->curves[i] = NULL;
  }
}

// Taylor coefficients by v of the parameter of curve `which` (0: the one that ends there).
static CagStatus miter_series(const CagRimMiter *m, int which, double v, const double d[SIDE],
                              int order, double out[SIDE], CagError *err) {
  const double place = v * CAG_RIM_STEPS;
  const int k = (int)fmin(fmax(floor(place), 0), CAG_RIM_STEPS - 1);
  double t[2];
  for (int i = 0; i < 2; i++) t[i] = m->at[k][i] + (place - k) * (m->at[k + 1][i] - m->at[k][i]);
  bool found = true;
  if (place != k) {
    const CagStatus status = miter_solve(m, d[0], t, &found, err);
    if (status) return status;
  }
  if (!found)
    return cag_fail(err, CAG_E_CONVERGENCE, CAG_ERR_convergence, "", -1,
                    "the edge between two rounded faces was not found");
  out[0] = t[which];
  if (order == 0) return CAG_OK;
  Strand s[2];
  CagVec3 j[2];
  const CagStatus status = miter_strands(m, t, order, s, err);
  if (status) return status;
  const double det = miter_matrix(s, d[0], j);
  Plane step[2] = {0};
  for (int n = 1; n <= order; n++) {
    Space at[2];
    double next[2];
    for (int i = 0; i < 2; i++) series_inward(&s[i], &step[i], d, n, 0, &at[i]);
    miter_step(j, det, cag_sub(at[0].c[0][n], at[1].c[0][n]), next);
    for (int i = 0; i < 2; i++) step[i].c[0][n] = next[i];
    out[n] = next[which];
  }
  return CAG_OK;
}

// --- The kind ---

// The series of the curve's parameter at an end of the rim.
static CagStatus rim_end(const Rim *r, int end, double v, const double d[SIDE], int order,
                         double out[SIDE], CagError *err) {
  for (int k = 0; k <= order; k++) out[k] = 0;
  if (r->miter[end].curves[0])
    return miter_series(&r->miter[end], end == 0 ? 1 : 0, v, d, order, out, err);
  out[0] = end == 0 ? r->curve->start : r->curve->end;
  return CAG_OK;
}

static CagStatus rim_eval(const CagSurface *s, double u, double v, int n, CagSide su, CagSide sv,
                          CagVec3 *out, CagError *err) {
  (void)sv;
  const Rim *r = (const Rim *)s;
  double d[SIDE], e[SIDE], ends[2][SIDE];
  profile_series(&r->profile, v, n, d, e);
  for (int end = 0; end < 2; end++) {
    const CagStatus status = rim_end(r, end, v, d, n, ends[end], err);
    if (status) return status;
  }
  // u runs from ends[from] to the other end.
  const int from = r->profile.sense < 0 ? 1 : 0;
  const double *a = ends[from], *b = ends[1 - from];
  Plane t = {0};
  for (int j = 0; j <= n; j++) {
    t.c[0][j] = (1 - u) * a[j] + u * b[j];
    if (j < n) t.c[1][j] = b[j] - a[j];
  }
  const double at = t.c[0][0];
  t.c[0][0] = 0;
  Strand strand;
  Space point;
  const CagSide side = from == 0 ? su : su == CAG_SIDE_LEFT ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT;
  const CagStatus status = strand_at(r->curve, at, n, side, &strand, err);
  if (status) return status;
  series_inward(&strand, &t, d, n, n, &point);
  for (int i = 0; i <= n; i++)
    for (int j = 0; i + j <= n; j++) {
      if (i == 0) point.c[0][j].z = r->profile.sense * e[j];
      out[cag_partial(n, i, j)] = cag_scaled(point.c[i][j], FACTORIAL[i] * FACTORIAL[j]);
    }
  out[0].z += r->profile.foot;
  return CAG_OK;
}

static size_t rim_breaks(const CagSurface *s, int direction, double *out, size_t capacity) {
  return direction == 0 ? cag_surface_kept_breaks(&((const Rim *)s)->breaks, out, capacity) : 0;
}

static void rim_describe(const CagSurface *s, char *buffer, size_t size) {
  const Rim *r = (const Rim *)s;
  char text[32];
  snprintf(buffer, size, "%s of %s along %s %s", r->profile.round ? "fillet" : "chamfer",
           cag_number_text(r->profile.reach, text), cag_article(r->curve->kind->name),
           r->curve->kind->name);
}

static void rim_destroy(CagSurface *s) {
  Rim *r = (Rim *)s;
  cag_curve_release(r->curve);
  for (int i = 0; i < 2; i++) cag_rim_miter_free(&r->miter[i]);
  cag_free(r->breaks.at);
}

static void rim_digest(const CagSurface *s, CagDigest *d) {
  const Rim *r = (const Rim *)s;
  const CagRimProfile *p = &r->profile;
  cag_curve_digest(r->curve, d);
  cag_digest_numbers(d, (const double[]){p->reach, p->round, p->foot, p->sense}, 4);
  for (int i = 0; i < 2; i++) {
    cag_digest_word(d, r->miter[i].curves[0] != NULL);
    if (!r->miter[i].curves[0]) continue;
    for (int k = 0; k < 2; k++) cag_curve_digest(r->miter[i].curves[k], d);
  }
}

static const CagSurfaceKind rim_kind = {
    .name = "rim",
    .eval = rim_eval,
    .transform = cag_surface_transform_placed,
    .breaks = rim_breaks,
    .describe = rim_describe,
    .destroy = rim_destroy,
    .digest = rim_digest,
};

// Without miters, the breaks of the curve are at constant u.
static CagStatus keep_breaks(Rim *r, CagError *err) {
  const CagCurve *c = r->curve;
  const size_t n = c->kind->breaks ? c->kind->breaks(c, NULL, 0) : 0;
  if (n == 0 || r->miter[0].curves[0] || r->miter[1].curves[0]) return CAG_OK;
  r->breaks.at = cag_malloc(n * sizeof *r->breaks.at);
  if (!r->breaks.at) return cag_fail_memory(err);
  c->kind->breaks(c, r->breaks.at, n);
  for (size_t i = 0; i < n; i++) {
    const double u = (r->breaks.at[i] - c->start) / (c->end - c->start);
    r->breaks.at[i] = r->profile.sense < 0 ? 1 - u : u;
  }
  r->breaks.n = cag_surface_tidy_breaks(r->breaks.at, n, 0, 1);
  return CAG_OK;
}

CagStatus cag_surface_rim(const CagCurve *c, const CagRimProfile *p, const CagRimMiter *start,
                          const CagRimMiter *end, CagSurface **out, CagError *err) {
  CagSurface *s;
  CagStatus status = cag_surface_block(sizeof(Rim), &rim_kind, 0, 1, 0, 1, &s, err);
  if (status) return status;
  Rim *r = (Rim *)s;
  r->curve = cag_curve_retain(c);
  r->profile = *p;
  const CagRimMiter *miters[2] = {start, end};
  for (int i = 0; i < 2; i++) {
    if (!miters[i]) continue;
    r->miter[i] = *miters[i];
    for (int k = 0; k < 2; k++) r->miter[i].curves[k] = cag_curve_retain(miters[i]->curves[k]);
  }
  status = keep_breaks(r, err);
  if (status) {
    cag_surface_release(s);
    return status;
  }
  cag_surface_judge(s);
  *out = s;
  return CAG_OK;
}
