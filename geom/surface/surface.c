// Operations on all kinds of surfaces through CagSurfaceKind: checked evaluation, normals with
// their limits at poles, reference counts, and fallbacks for optional functions.

#include "geom/surface/surface.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/linalg/tolerance.h"
#include "geom/surface/family.h"
#include "geom/surface/frames.h"
#include "geom/surface/trimmed.h"

// A parameter this many ulps outside the domain is snapped to the end: it is a rounding error.
#define SNAP_ULPS 16

CagStatus cag_surface_block(size_t size, const CagSurfaceKind *kind, double u0, double u1,
                            double v0, double v1, CagSurface **out, CagError *err) {
  CagSurface *s = cag_calloc(1, size);
  if (!s) return cag_fail_memory(err);
  s->kind = kind;
  s->references = 1;
  s->u0 = u0;
  s->u1 = u1;
  s->v0 = v0;
  s->v1 = v1;
  *out = s;
  return CAG_OK;
}

CagSurface *cag_surface_retain(const CagSurface *s) {
  CagSurface *mine = (CagSurface *)s;
  if (mine) mine->references++;
  return mine;
}

void cag_surface_release(CagSurface *s) {
  if (!s || --s->references > 0) return;
  if (s->kind->destroy) s->kind->destroy(s);
  cag_free(s);
}

void cag_surface_digest(const CagSurface *s, CagDigest *d) {
  cag_digest_text(d, s->kind->name);
  cag_digest_numbers(d, (const double[]){s->u0, s->u1, s->v0, s->v1}, 4);
  cag_digest_word(d, (uint64_t)s->angular_u << 1 | s->angular_v);
  if (s->kind->digest) s->kind->digest(s, d);
  else d->unknown = true;
}

bool cag_check_surface(const CagSurface *s) {
  return s && s->kind && s->kind->eval && s->references > 0 && isfinite(s->u0) && isfinite(s->u1) &&
         isfinite(s->v0) && isfinite(s->v1) && s->u0 < s->u1 && s->v0 < s->v1;
}

CagStatus cag_surface_space_curve(const CagCurve *c, CagCurve **out, CagError *err) {
  CagVec3 p;
  // A point may have a single parameter; a surface needs a range.
  if (cag_curve_resting_view(c, &p) && c->start == c->end)
    return cag_curve_resting(p, 3, c->start, c->start + 1, c->angular, out, err);
  if (c->dimension == 3) {
    *out = cag_curve_retain(c);
    return CAG_OK;
  }
  return cag_curve_to_space(c, out, err);
}

// --- Parameters ---

static double shown(double t, bool angular) { return angular ? t * (180 / M_PI) : t; }

static CagStatus check_parameter(double *t, double a, double b, bool angular, const char *name,
                                 CagError *err) {
  if (*t >= a && *t <= b) return CAG_OK;
  double slack = SNAP_ULPS * DBL_EPSILON * fmax(fabs(a), fabs(b));
  if (*t < a && *t >= a - slack) {
    *t = a;
    return CAG_OK;
  }
  if (*t > b && *t <= b + slack) {
    *t = b;
    return CAG_OK;
  }
  char found[32], from[32], to[32];
  const char *unit = angular ? "deg" : "";
  return cag_fail(err, CAG_E_DOMAIN, CAG_ERR_parameter_range, name, -1,
                  "`%s` must lie in the domain %s%s..%s%s, found %s%s", name,
                  cag_number_text(shown(a, angular), from), unit,
                  cag_number_text(shown(b, angular), to), unit,
                  cag_number_text(shown(*t, angular), found), unit);
}

static CagStatus check_parameters(const CagSurface *s, double *u, double *v, CagError *err) {
  CagStatus status = check_parameter(u, s->u0, s->u1, s->angular_u, "u", err);
  return status ? status : check_parameter(v, s->v0, s->v1, s->angular_v, "v", err);
}

// At an end of the domain only the limit from inside exists.
static CagSide side_at(double t, double a, double b, CagSide wanted) {
  if (t <= a) return CAG_SIDE_RIGHT;
  if (t >= b) return CAG_SIDE_LEFT;
  return wanted;
}

CagStatus cag_surface_eval(const CagSurface *s, double u, double v, int n, CagSide su, CagSide sv,
                           CagVec3 *out, CagError *err) {
  if (cag_stop_check(err)) return err->status;
  if (n < 0 || n > CAG_MAX_PARTIAL)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_derivative_order, "order", -1,
                    "`order` must lie in 0..%d, found %d", CAG_MAX_PARTIAL, n);
  CagStatus status = check_parameters(s, &u, &v, err);
  if (status) return status;
  return s->kind->eval(s, u, v, n, side_at(u, s->u0, s->u1, su), side_at(v, s->v0, s->v1, sv), out,
                       err);
}

CagStatus cag_surface_cuts(const CagSurface *s, int direction, double **out, size_t *n,
                           CagError *err) {
  const size_t inner = s->kind->breaks ? s->kind->breaks(s, direction, NULL, 0) : 0;
  double *cuts = cag_malloc((inner + 2) * sizeof *cuts);
  *out = cuts;
  if (!cuts) return cag_fail_memory(err);
  cuts[0] = direction ? s->v0 : s->u0;
  if (inner > 0) s->kind->breaks(s, direction, cuts + 1, inner);
  cuts[inner + 1] = direction ? s->v1 : s->u1;
  *n = inner + 1;
  return CAG_OK;
}

double cag_cut_part(const double *cuts, size_t k, size_t parts) {
  const size_t i = k / parts, part = k % parts;
  return part ? cuts[i] + (cuts[i + 1] - cuts[i]) * (double)part / (double)parts : cuts[i];
}

CagStatus cag_surface_point(const CagSurface *s, double u, double v, CagVec3 *out, CagError *err) {
  return cag_surface_eval(s, u, v, 0, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, out, err);
}

static CagStatus grid_by_points(const CagSurface *s, const double *us, size_t nu, const double *vs,
                                size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv,
                                CagError *err) {
  int n = du || dv ? 1 : 0;
  for (size_t i = 0; i < nu; i++)
    for (size_t j = 0; j < nv; j++) {
      if (cag_stop_check(err)) return err->status;
      CagVec3 d[4];
      CagStatus status =
          s->kind->eval(s, us[i], vs[j], n, side_at(us[i], s->u0, s->u1, CAG_SIDE_RIGHT),
                        side_at(vs[j], s->v0, s->v1, CAG_SIDE_RIGHT), d, err);
      if (status) return status;
      size_t at = i * nv + j;
      points[at] = d[0];
      if (du) du[at] = d[cag_partial(1, 1, 0)];
      if (dv) dv[at] = d[cag_partial(1, 0, 1)];
    }
  return CAG_OK;
}

// Points between checks of the stop flag.
#define BLOCK ((size_t)1 << 16)

static CagStatus grid_by_blocks(const CagSurface *s, const double *us, size_t nu, const double *vs,
                                size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv,
                                CagError *err) {
  const size_t rows = nv < BLOCK ? BLOCK / (nv + 1) + 1 : 1;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < nu; i += rows) {
    const size_t at = i * nv, n = nu - i < rows ? nu - i : rows;
    status = cag_stop_check(err);
    if (!status)
      status = s->kind->eval_grid(s, us + i, n, vs, nv, points + at, du ? du + at : NULL,
                                  dv ? dv + at : NULL, err);
  }
  return status;
}

static bool all_inside(const double *t, size_t n, double a, double b) {
  bool inside = true;
  for (size_t i = 0; i < n; i++) inside = inside && t[i] >= a && t[i] <= b;
  return inside;
}

// A validated copy of parameters, with those a few ulps outside snapped to the end.
static CagStatus snapped(const double *t, size_t n, double a, double b, bool angular,
                         const char *name, double **out, CagError *err) {
  double *copy = cag_malloc((n ? n : 1) * sizeof *copy);
  if (!copy) return cag_fail_memory(err);
  for (size_t i = 0; i < n; i++) {
    copy[i] = t[i];
    CagStatus status = check_parameter(&copy[i], a, b, angular, name, err);
    if (status) {
      err->index = (long)i;
      cag_free(copy);
      return status;
    }
  }
  *out = copy;
  return CAG_OK;
}

CagStatus cag_surface_eval_grid(const CagSurface *s, const double *us, size_t nu, const double *vs,
                                size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv,
                                CagError *err) {
  double *copy_u = NULL, *copy_v = NULL;
  CagStatus status = cag_stop_check(err);
  if (status) return status;
  if (!all_inside(us, nu, s->u0, s->u1))
    status = snapped(us, nu, s->u0, s->u1, s->angular_u, "u", &copy_u, err);
  if (!status && !all_inside(vs, nv, s->v0, s->v1))
    status = snapped(vs, nv, s->v0, s->v1, s->angular_v, "v", &copy_v, err);
  if (!status) {
    const double *u = copy_u ? copy_u : us, *v = copy_v ? copy_v : vs;
    status = s->kind->eval_grid ? grid_by_blocks(s, u, nu, v, nv, points, du, dv, err)
                                : grid_by_points(s, u, nu, v, nv, points, du, dv, err);
  }
  cag_free(copy_u);
  cag_free(copy_v);
  return status;
}

// --- Normals ---

// |S_u x S_v| is zero below this fraction of |S_u| |S_v| (both multiplied by the length of the
// domain; the larger of them is used for both): rounding at a pole is near 1e-16, and the flattest
// valid patch is far above.
#define NORMAL_ZERO CAG_ROUNDING
// Order of the expansion that determines the limit: a pole of a smooth surface needs 1, a cusp 2.
#define NORMAL_ORDER 4

// Coefficients (times k!) of the expansion of S_u (i0 = 1) or S_v (i0 = 0) along the direction
// (du, dv).
static void expand(const CagVec3 *d, int n, int i0, double du, double dv, CagVec3 *out) {
  for (int k = 0; k < n; k++) {
    CagVec3 sum = {0, 0, 0};
    double binomial = 1;
    for (int i = 0; i <= k; i++) {
      double factor = binomial * pow(du, i) * pow(dv, k - i);
      sum = cag_madd(sum, factor, d[cag_partial(n, i + i0, k - i + 1 - i0)]);
      binomial = binomial * (k - i) / (i + 1);
    }
    out[k] = sum;
  }
}

// The first nonzero direction of S_u x S_v along the line (du, dv) into the surface. False: none
// found. zero: smaller values are 0.
static bool limit_along(const CagVec3 *d, int n, double du, double dv, double zero,
                        CagVec3 *normal) {
  CagVec3 a[NORMAL_ORDER], b[NORMAL_ORDER];
  expand(d, n, 1, du, dv, a);
  expand(d, n, 0, du, dv, b);
  for (int k = 0; k < n; k++) {
    CagVec3 sum = {0, 0, 0};
    double binomial = 1;
    for (int i = 0; i <= k; i++) {
      sum = cag_madd(sum, binomial, cag_cross(a[i], b[k - i]));
      binomial = binomial * (k - i) / (i + 1);
    }
    if (cag_norm(sum) > zero) {
      *normal = cag_unit(sum);
      return true;
    }
  }
  return false;
}

CagStatus cag_surface_normal(const CagSurface *s, double u, double v, CagVec3 *out, CagError *err) {
  CagStatus status = check_parameters(s, &u, &v, err);
  if (status) return status;
  CagSide su = side_at(u, s->u0, s->u1, CAG_SIDE_RIGHT);
  CagSide sv = side_at(v, s->v0, s->v1, CAG_SIDE_RIGHT);
  double lu = s->u1 - s->u0, lv = s->v1 - s->v0;

  CagVec3 first[4];
  status = s->kind->eval(s, u, v, 1, su, sv, first, err);
  if (status) return status;
  CagVec3 a = cag_scaled(first[cag_partial(1, 1, 0)], lu);
  CagVec3 b = cag_scaled(first[cag_partial(1, 0, 1)], lv);
  CagVec3 cross = cag_cross(a, b);
  double scale = fmax(cag_norm(a), cag_norm(b)), noise = cag_partial_noise(first[0], 1);
  if (cag_norm(cross) > (NORMAL_ZERO * scale + noise) * scale) {
    *out = cag_unit(cross);
    return CAG_OK;
  }

  // A pole or a cusp: partials in units of the domain, then the limit along lines into the domain.
  CagVec3 d[(NORMAL_ORDER + 1) * (NORMAL_ORDER + 1)];
  status = s->kind->eval(s, u, v, NORMAL_ORDER, su, sv, d, err);
  if (status) return status;
  scale = 0;
  for (int i = 0; i <= NORMAL_ORDER; i++)
    for (int j = 0; i + j <= NORMAL_ORDER; j++) {
      CagVec3 *p = &d[cag_partial(NORMAL_ORDER, i, j)];
      *p = cag_scaled(*p, pow(lu, i) * pow(lv, j));
      if (i + j == 1 || i + j == 2) scale = fmax(scale, cag_norm(*p));
    }
  double inward_u = su == CAG_SIDE_LEFT ? -1 : 1, inward_v = sv == CAG_SIDE_LEFT ? -1 : 1;
  const double ways[3][2] = {{0, inward_v}, {inward_u, 0}, {inward_u, inward_v}};
  // From an edge u = const the inward direction is u, otherwise v.
  bool edge_u = u <= s->u0 || u >= s->u1, edge_v = v <= s->v0 || v >= s->v1;
  size_t start = edge_u && !edge_v ? 1 : 0;
  for (size_t i = 0; i < 3; i++) {
    const double *way = ways[i == 2 ? 2 : (i + start) % 2];
    if (limit_along(d, NORMAL_ORDER, way[0], way[1], (NORMAL_ZERO * scale + noise) * scale, out))
      return CAG_OK;
  }
  char text_u[32], text_v[32];
  return cag_fail(
      err, CAG_E_DEGENERATE, CAG_ERR_degenerate_normal, "", -1,
      "the surface has no normal at u = %s, v = %s: its partial derivatives are parallel there; use a neighboring point",
      cag_number_text(u, text_u), cag_number_text(v, text_v));
}

// --- Flags ---

// Odd fractions, so that symmetric shapes do not coincide by accident.
static const double PROBES[] = {0, 0.0831, 0.2113, 0.3407, 0.4729, 0.6151, 0.7393, 0.8677, 1};
#define PROBE_COUNT (sizeof PROBES / sizeof *PROBES)

static bool same(CagVec3 a, CagVec3 b, double size) {
  return cag_norm(cag_sub(a, b)) <= CAG_SURFACE_SAME * size;
}

void cag_surface_judge(CagSurface *s) {
  CagVec3 edge[4][PROBE_COUNT]; // u0, u1, v0, v1
  CagError err;
  CagBounds box = CAG_BOUNDS_EMPTY;
  for (size_t i = 0; i < PROBE_COUNT; i++) {
    double u = i + 1 == PROBE_COUNT ? s->u1 : s->u0 + PROBES[i] * (s->u1 - s->u0);
    double v = i + 1 == PROBE_COUNT ? s->v1 : s->v0 + PROBES[i] * (s->v1 - s->v0);
    if (cag_surface_point(s, s->u0, v, &edge[0][i], &err) ||
        cag_surface_point(s, s->u1, v, &edge[1][i], &err) ||
        cag_surface_point(s, u, s->v0, &edge[2][i], &err) ||
        cag_surface_point(s, u, s->v1, &edge[3][i], &err))
      return;
    for (int e = 0; e < 4; e++) cag_bounds_add(&box, edge[e][i]);
  }
  double size = cag_norm(cag_sub(box.max, box.min)) +
                CAG_SURFACE_SAME * fmax(cag_norm(box.min), cag_norm(box.max));
  bool pole[4] = {true, true, true, true}, closed[2] = {true, true};
  for (size_t i = 0; i < PROBE_COUNT; i++) {
    for (int e = 0; e < 4; e++) pole[e] = pole[e] && same(edge[e][i], edge[e][0], size);
    closed[0] = closed[0] && same(edge[0][i], edge[1][i], size);
    closed[1] = closed[1] && same(edge[2][i], edge[3][i], size);
  }
  s->pole_u0 = pole[0];
  s->pole_u1 = pole[1];
  s->pole_v0 = pole[2];
  s->pole_v1 = pole[3];
  s->closed_u = closed[0] && !(pole[0] && pole[1]);
  s->closed_v = closed[1] && !(pole[2] && pole[3]);
}

bool cag_surface_is_closed(const CagSurface *s) {
  if (cag_surface_planar_view(s, NULL, NULL) || cag_surface_trimmed_view(s, NULL, NULL))
    return false;
  bool no_edge_u = s->closed_u || (s->pole_u0 && s->pole_u1);
  bool no_edge_v = s->closed_v || (s->pole_v0 && s->pole_v1);
  return no_edge_u && no_edge_v;
}

// --- Dispatch ---

CagStatus cag_surface_to_nurbs(const CagSurface *s, CagSurface **out, CagError *err) {
  if (s->kind->to_nurbs) return s->kind->to_nurbs(s, out, err);
  return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_no_exact_form, "surface", -1,
                  "%s %s surface has no exact NURBS form; approximate it to a tolerance",
                  cag_article(s->kind->name), s->kind->name);
}

CagStatus cag_surface_transform_placed(const CagSurface *s, const CagTransform *t, CagSurface **out,
                                       CagError *err) {
  if (cag_transform_is_affine(t)) return cag_surface_placed(s, t, false, out, err);
  CagSurface *exact;
  CagStatus status = cag_surface_to_nurbs(s, &exact, err);
  if (status) return status;
  status = exact->kind->transform(exact, t, out, err);
  cag_surface_release(exact);
  return status;
}

CagStatus cag_surface_transform(const CagSurface *s, const CagTransform *t, CagSurface **out,
                                CagError *err) {
  return s->kind->transform ? s->kind->transform(s, t, out, err)
                            : cag_surface_transform_placed(s, t, out, err);
}

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

size_t cag_surface_tidy_breaks(double *a, size_t n, double lo, double hi) {
  size_t kept = 0;
  double same_parameter = 1e-12 * (hi - lo);
  if (n > 1) qsort(a, n, sizeof *a, ascending);
  for (size_t i = 0; i < n; i++)
    if (a[i] > lo && a[i] < hi && (kept == 0 || a[i] - a[kept - 1] > same_parameter))
      a[kept++] = a[i];
  return kept;
}

CagStatus cag_surface_keep_breaks(const CagSurface *inner, int direction, double lo, double hi,
                                  CagKeptBreaks *out, CagError *err) {
  *out = (CagKeptBreaks){0};
  const size_t n = inner->kind->breaks ? inner->kind->breaks(inner, direction, NULL, 0) : 0;
  if (n == 0) return CAG_OK;
  out->at = cag_malloc(n * sizeof *out->at);
  if (!out->at) return cag_fail_memory(err);
  inner->kind->breaks(inner, direction, out->at, n);
  out->n = cag_surface_tidy_breaks(out->at, n, lo, hi);
  return CAG_OK;
}

size_t cag_surface_kept_breaks(const CagKeptBreaks *kept, double *out, size_t capacity) {
  for (size_t i = 0; i < kept->n && i < capacity; i++) out[i] = kept->at[i];
  return kept->n;
}
