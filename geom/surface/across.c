// Lofts of curves without an exact NURBS form: a spline across the original curves.
//
// The spline is linear in the curves: S(u, v) = sum w_k(v) C_k(u), where w_k is the spline that is
// 1 on curve k and 0 on the others. u is the fraction of every curve's domain.

#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "geom/basis/bspline.h"
#include "geom/surface/family.h"
#include "geom/surface/loft.h"

// Maximum degree of the spline.
#define MOST_DEGREE 25

typedef struct Across {
  CagSurface base;
  size_t n;         // curves
  CagCurve **curve; // of space, over 0..1
  CagNet spline;    // width n: coefficients of the w_k
} Across;

static const CagSurfaceKind across_kind;

// w_k and its derivatives up to `order` at v: out[m * n + k].
static void weights_at(const Across *s, double v, int order, CagSide side, double *out) {
  const CagNet *net = &s->spline;
  const size_t p = (size_t)net->degree;
  double basis[(CAG_MAX_PARTIAL + 1) * (MOST_DEGREE + 1)];
  const size_t span =
      cag_knots_span(net->knots, net->count, net->degree, v, side == CAG_SIDE_LEFT, p);
  cag_bspline_derivatives(net->knots, net->degree, span, v, order, basis);
  memset(out, 0, (size_t)(order + 1) * s->n * sizeof *out);
  for (int m = 0; m <= order; m++)
    for (size_t j = 0; j <= p; j++)
      for (size_t k = 0; k < s->n; k++)
        out[(size_t)m * s->n + k] +=
            basis[(size_t)m * (p + 1) + j] * net->data[(span - p + j) * s->n + k];
}

static CagStatus eval(const CagSurface *surface, double u, double v, int n, CagSide su, CagSide sv,
                      CagVec3 *out, CagError *err) {
  const Across *s = (const Across *)surface;
  double *w = cag_malloc((size_t)(n + 1) * s->n * sizeof *w);
  if (!w) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  weights_at(s, v, n, sv, w);
  for (int i = 0; !status && i <= n; i++)
    for (int j = 0; i + j <= n; j++) out[cag_partial(n, i, j)] = cag_vec3(0, 0, 0);
  for (size_t k = 0; !status && k < s->n; k++) {
    CagVec3 d[CAG_MAX_PARTIAL + 1];
    status = cag_curve_eval(s->curve[k], u, n, su, d, err);
    for (int i = 0; !status && i <= n; i++)
      for (int j = 0; i + j <= n; j++) {
        CagVec3 *to = &out[cag_partial(n, i, j)];
        *to = cag_madd(*to, w[(size_t)j * s->n + k], d[i]);
      }
  }
  cag_free(w);
  return status;
}

static CagStatus eval_grid(const CagSurface *surface, const double *us, size_t nu, const double *vs,
                           size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv, CagError *err) {
  const Across *s = (const Across *)surface;
  const size_t n = s->n;
  double *w = cag_malloc(2 * n * nv * sizeof *w);
  CagVec3 *d = cag_malloc(2 * n * sizeof *d);
  CagStatus status = w && d ? CAG_OK : cag_fail_memory(err);
  for (size_t j = 0; !status && j < nv; j++)
    weights_at(s, vs[j], 1, vs[j] >= surface->v1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, w + 2 * n * j);
  for (size_t i = 0; !status && i < nu; i++) {
    const CagSide side = us[i] >= surface->u1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
    for (size_t k = 0; !status && k < n; k++)
      status = cag_curve_eval(s->curve[k], us[i], 1, side, d + 2 * k, err);
    for (size_t j = 0; !status && j < nv; j++) {
      const double *row = w + 2 * n * j;
      CagVec3 p = {0, 0, 0}, pu = p, pv = p;
      for (size_t k = 0; k < n; k++) {
        p = cag_madd(p, row[k], d[2 * k]);
        pu = cag_madd(pu, row[k], d[2 * k + 1]);
        pv = cag_madd(pv, row[n + k], d[2 * k]);
      }
      points[i * nv + j] = p;
      if (du) du[i * nv + j] = pu;
      if (dv) dv[i * nv + j] = pv;
    }
  }
  cag_free(w);
  cag_free(d);
  return status;
}

static CagStatus transform(const CagSurface *surface, const CagTransform *t, CagSurface **out,
                           CagError *err) {
  if (!cag_transform_is_affine(t)) return cag_surface_transform_placed(surface, t, out, err);
  const Across *s = (const Across *)surface;
  CagCurve **moved = cag_calloc(s->n, sizeof *moved);
  if (!moved) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (size_t k = 0; !status && k < s->n; k++)
    status = cag_curve_transform(s->curve[k], t, &moved[k], err);
  if (!status) status = cag_surface_across((const CagCurve *const *)moved, &s->spline, out, err);
  for (size_t k = 0; k < s->n; k++) cag_curve_release(moved[k]);
  cag_free(moved);
  return status;
}

static size_t breaks(const CagSurface *surface, int direction, double *out, size_t capacity) {
  const Across *s = (const Across *)surface;
  size_t most = s->spline.count + (size_t)s->spline.degree + 1, n = 0;
  for (size_t k = 0; direction == 0 && k < s->n; k++)
    if (s->curve[k]->kind->breaks) most += s->curve[k]->kind->breaks(s->curve[k], NULL, 0);
  double *all = cag_malloc(most * sizeof *all);
  if (!all) return cag_note_memory(), 0;
  if (direction == 1) {
    n = s->spline.count + (size_t)s->spline.degree + 1;
    memcpy(all, s->spline.knots, n * sizeof *all);
  }
  for (size_t k = 0; direction == 0 && k < s->n; k++)
    if (s->curve[k]->kind->breaks) n += s->curve[k]->kind->breaks(s->curve[k], all + n, most - n);
  n = cag_surface_tidy_breaks(all, n, direction ? surface->v0 : 0, direction ? surface->v1 : 1);
  for (size_t i = 0; i < n && i < capacity; i++) out[i] = all[i];
  cag_free(all);
  return n;
}

static void describe(const CagSurface *surface, char *buffer, size_t size) {
  snprintf(buffer, size, "through %zu curves", ((const Across *)surface)->n);
}

static void destroy(CagSurface *surface) {
  Across *s = (Across *)surface;
  for (size_t k = 0; s->curve && k < s->n; k++) cag_curve_release(s->curve[k]);
  cag_free(s->curve);
  cag_net_free(&s->spline);
}

static void digest(const CagSurface *surface, CagDigest *d) {
  const Across *s = (const Across *)surface;
  cag_digest_word(d, s->n);
  for (size_t i = 0; i < s->n; i++) cag_curve_digest(s->curve[i], d);
  cag_digest_word(d, (uint64_t)s->spline.degree);
  cag_digest_numbers(d, s->spline.knots, s->spline.count + (size_t)s->spline.degree + 1);
  cag_digest_numbers(d, s->spline.data, s->spline.count * s->spline.width);
}

static const CagSurfaceKind across_kind = {
    .name = "loft",
    .eval = eval,
    .eval_grid = eval_grid,
    .transform = transform,
    .breaks = breaks,
    .describe = describe,
    .destroy = destroy,
    .digest = digest,
};

CagStatus cag_surface_across(const CagCurve *const *curves, const CagNet *cardinal,
                             CagSurface **out, CagError *err) {
  CagSurface *surface;
  if (cardinal->degree > MOST_DEGREE)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_order_range, "degree", -1,
                    "`degree` of a loft of such curves must be at most %d, found %d", MOST_DEGREE,
                    cardinal->degree);
  CagStatus status = cag_surface_block(sizeof(Across), &across_kind, 0, 1, cag_net_start(cardinal),
                                       cag_net_end(cardinal), &surface, err);
  if (status) return status;
  Across *s = (Across *)surface;
  s->n = cardinal->width;
  s->curve = cag_calloc(s->n, sizeof *s->curve);
  if (!s->curve) status = cag_fail_memory(err);
  if (!status) status = cag_net_new(cardinal->degree, cardinal->count, s->n, &s->spline, err);
  for (size_t k = 0; !status && k < s->n; k++) {
    CagCurve *space;
    status = cag_surface_space_curve(curves[k], &space, err);
    if (status) break;
    status = cag_curve_reparametrize_as(space, 0, 1, false, &s->curve[k], err);
    cag_curve_release(space);
  }
  if (status) {
    cag_surface_release(surface);
    return status;
  }
  memcpy(s->spline.knots, cardinal->knots,
         (cardinal->count + (size_t)cardinal->degree + 1) * sizeof *cardinal->knots);
  memcpy(s->spline.data, cardinal->data, cardinal->count * s->n * sizeof *cardinal->data);
  cag_surface_judge(surface);
  *out = surface;
  return CAG_OK;
}

bool cag_surface_across_end(const CagSurface *surface, bool first, const CagCurve **out) {
  if (surface->kind != &across_kind) return false;
  const Across *s = (const Across *)surface;
  *out = s->curve[first ? 0 : s->n - 1];
  return true;
}
