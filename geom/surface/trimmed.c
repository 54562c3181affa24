// Trimmed surfaces: evaluation uses the inner surface, measures use the part within the loops.
//
// An integral of f over the region is the line integral of F dv along its loops, outer ones
// counter-clockwise and holes clockwise, where F is the integral of f in u from the left side of
// the region's box. Both integrations are adaptive and split at the breaks of the surface, so that
// the pieces are smooth.

#include "geom/surface/trimmed.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "geom/basis/quadrature.h"
#include "geom/linalg/tolerance.h"
#include "geom/surface/curve_on.h"
#include "geom/surface/family.h"
#include "geom/surface/quadric.h"
#include "geom/surface/reshape.h"

// Loops may leave the domain by this fraction of it, to allow for rounding.
#define OUTSIDE CAG_COINCIDENT

typedef struct Trimmed {
  CagSurface base;
  CagSurface *inner;
  CagRegion *region;
  CagKeptBreaks breaks[2]; // by direction
} Trimmed;

static const CagSurfaceKind trimmed_kind;

static CagStatus trimmed_eval(const CagSurface *s, double u, double v, int n, CagSide su,
                              CagSide sv, CagVec3 *out, CagError *err) {
  return cag_surface_eval(((const Trimmed *)s)->inner, u, v, n, su, sv, out, err);
}

static CagStatus trimmed_grid(const CagSurface *s, const double *us, size_t nu, const double *vs,
                              size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv, CagError *err) {
  return cag_surface_eval_grid(((const Trimmed *)s)->inner, us, nu, vs, nv, points, du, dv, err);
}

static CagStatus trimmed_transform(const CagSurface *s, const CagTransform *t, CagSurface **out,
                                   CagError *err) {
  const Trimmed *w = (const Trimmed *)s;
  // A projective map changes the parameters of every kind except those with control points.
  if (!cag_transform_is_affine(t) && !cag_surface_nurbs_view(w->inner, NULL))
    return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_no_exact_form, "surface", -1,
                    "only a trimmed NURBS surface can be projected: trim `to_nurbs` of the %s",
                    w->inner->kind->name);
  CagSurface *moved;
  CagStatus status = cag_surface_transform(w->inner, t, &moved, err);
  if (status) return status;
  status = cag_surface_trimmed(moved, w->region, out, err);
  cag_surface_release(moved);
  return status;
}

static size_t trimmed_breaks(const CagSurface *s, int direction, double *out, size_t capacity) {
  return cag_surface_kept_breaks(&((const Trimmed *)s)->breaks[direction], out, capacity);
}

static void trimmed_describe(const CagSurface *s, char *buffer, size_t size) {
  const Trimmed *w = (const Trimmed *)s;
  snprintf(buffer, size, "%s within %zu closed %s", w->inner->kind->name, w->region->count,
           w->region->count == 1 ? "curve" : "curves");
}

static void trimmed_destroy(CagSurface *s) {
  Trimmed *w = (Trimmed *)s;
  cag_surface_release(w->inner);
  cag_region_release(w->region);
  cag_free(w->breaks[0].at);
  cag_free(w->breaks[1].at);
}

static void trimmed_digest(const CagSurface *surface, CagDigest *d) {
  const Trimmed *s = (const Trimmed *)surface;
  cag_surface_digest(s->inner, d);
  cag_region_digest(s->region, d);
}

static const CagSurfaceKind trimmed_kind = {
    .name = "trimmed",
    .eval = trimmed_eval,
    .eval_grid = trimmed_grid,
    .transform = trimmed_transform,
    .breaks = trimmed_breaks,
    .describe = trimmed_describe,
    .destroy = trimmed_destroy,
    .digest = trimmed_digest,
};

CagStatus cag_surface_trimmed(const CagSurface *inner, const CagRegion *region, CagSurface **out,
                              CagError *err) {
  if (cag_surface_trimmed_view(inner, NULL, NULL) || cag_surface_planar_view(inner, NULL, NULL))
    return cag_fail(
        err, CAG_E_UNSUPPORTED, CAG_ERR_already_trimmed, "", -1,
        "the surface is already trimmed by curves; trim the whole surface once, by all curves");
  CagBounds box;
  CagStatus status = cag_region_bounds(region, &box, err);
  if (status) return status;
  double slack_u = OUTSIDE * (inner->u1 - inner->u0), slack_v = OUTSIDE * (inner->v1 - inner->v0);
  bool out_u = box.min.x < inner->u0 - slack_u || box.max.x > inner->u1 + slack_u;
  bool out_v = box.min.y < inner->v0 - slack_v || box.max.y > inner->v1 + slack_v;
  char a[32], b[32], c[32], d[32];
  if (out_u || out_v)
    return cag_fail(
        err, CAG_E_DOMAIN, CAG_ERR_curve_outside, "curves", -1,
        "`curves` must stay in the domain %s..%s of %s, found %s..%s (angles are in radians)",
        cag_number_text(out_u ? inner->u0 : inner->v0, a),
        cag_number_text(out_u ? inner->u1 : inner->v1, b), out_u ? "u" : "v",
        cag_number_text(out_u ? box.min.x : box.min.y, c),
        cag_number_text(out_u ? box.max.x : box.max.y, d));
  CagSurface *s;
  status = cag_surface_block(sizeof(Trimmed), &trimmed_kind, fmax(box.min.x, inner->u0),
                             fmin(box.max.x, inner->u1), fmax(box.min.y, inner->v0),
                             fmin(box.max.y, inner->v1), &s, err);
  if (status) return status;
  Trimmed *w = (Trimmed *)s;
  w->inner = cag_surface_retain(inner);
  w->region = cag_region_retain((CagRegion *)region);
  s->angular_u = inner->angular_u;
  s->angular_v = inner->angular_v;
  status = cag_surface_keep_breaks(inner, 0, s->u0, s->u1, &w->breaks[0], err);
  if (!status) status = cag_surface_keep_breaks(inner, 1, s->v0, s->v1, &w->breaks[1], err);
  if (status) cag_surface_release(s);
  else *out = s;
  return status;
}

bool cag_surface_trimmed_view(const CagSurface *s, const CagSurface **inner,
                              const CagRegion **region) {
  if (s->kind != &trimmed_kind) return false;
  const Trimmed *w = (const Trimmed *)s;
  if (inner) *inner = w->inner;
  if (region) *region = w->region;
  return true;
}

CagStatus cag_trimmed_loop(const CagSurface *s, size_t i, CagCurve **out, CagError *err) {
  const Trimmed *w = (const Trimmed *)s;
  return cag_curve_on_surface(w->inner, w->region->loops[i], out, err);
}

// --- Integrals ---

// Differences of the rules below this fraction of the integral of magnitudes are ignored. The inner
// integral is the integrand of the outer one and must be more accurate.
#define OUTER 1e-10
#define INNER 1e-12
#define TERMS 10

typedef void Integrand(CagVec3 p, CagVec3 du, CagVec3 dv, double *out);

typedef struct Integral {
  const CagSurface *inner;
  const CagCurve *loop;
  Integrand *f;
  int parts;
  double from; // where inner integrals start
  double v;    // of the current inner integral
  double *cuts;
  size_t cut_count;
} Integral;

static double clamp(double t, double lo, double hi) { return fmin(fmax(t, lo), hi); }

static CagStatus at_point(void *context, double u, double *out, CagError *err) {
  const Integral *in = context;
  CagVec3 d[4];
  CagStatus status = cag_surface_eval(in->inner, clamp(u, in->inner->u0, in->inner->u1), in->v, 1,
                                      CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err);
  if (!status) in->f(d[0], d[cag_partial(1, 1, 0)], d[cag_partial(1, 0, 1)], out);
  return status;
}

// F v' at t along the loop.
static CagStatus along_loop(void *context, double t, double *out, CagError *err) {
  Integral *in = context;
  CagVec3 d[2];
  for (int k = 0; k < in->parts; k++) out[k] = 0;
  CagStatus status = cag_curve_eval(in->loop, t, 1, CAG_SIDE_RIGHT, d, err);
  if (status || d[1].y == 0 || !(d[0].x > in->from)) return status;
  in->v = clamp(d[0].y, in->inner->v0, in->inner->v1);
  double ends[64];
  size_t n = 0;
  const size_t room = sizeof ends / sizeof *ends - 1;
  // The first cut is the start of the integrals; if there are very many, the last ones are left to
  // bisection.
  for (size_t i = 0; i < in->cut_count && in->cuts[i] < d[0].x && n < room; i++)
    ends[n++] = in->cuts[i];
  ends[n++] = d[0].x;
  status = cag_integrate(at_point, in, ends, n, in->parts, INNER, out, err);
  for (int k = 0; k < in->parts; k++) out[k] *= d[1].y;
  return status;
}

static CagStatus integrate_loop(Integral *in, const Trimmed *w, size_t loop, double *sum,
                                CagError *err) {
  CagCurve *on;
  double part[TERMS];
  CagStatus status = cag_curve_on_surface(w->inner, w->region->loops[loop], &on, err);
  if (status) return status;
  size_t n = on->kind->breaks ? on->kind->breaks(on, NULL, 0) : 0;
  double *cuts = cag_malloc((n + 2) * sizeof *cuts);
  if (!cuts) status = cag_fail_memory(err);
  if (!status) {
    if (n > 0) on->kind->breaks(on, cuts + 1, n);
    cuts[0] = on->start;
    cuts[n + 1] = on->end;
    in->loop = w->region->loops[loop];
    status = cag_integrate(along_loop, in, cuts, n + 2, in->parts, OUTER, part, err);
  }
  for (int k = 0; !status && k < in->parts; k++) sum[k] += part[k];
  cag_free(cuts);
  cag_curve_release(on);
  return status;
}

static CagStatus integrate(const CagSurface *s, Integrand *f, int parts, double *sum,
                           CagError *err) {
  const Trimmed *w = (const Trimmed *)s;
  size_t n = trimmed_breaks(s, 0, NULL, 0);
  Integral in = {.inner = w->inner, .f = f, .parts = parts, .from = s->u0};
  in.cuts = cag_malloc((n + 1) * sizeof *in.cuts);
  if (!in.cuts) return cag_fail_memory(err);
  in.cuts[0] = s->u0;
  trimmed_breaks(s, 0, in.cuts + 1, n);
  in.cut_count = n + 1;
  for (int k = 0; k < parts; k++) sum[k] = 0;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < w->region->count; i++)
    status = integrate_loop(&in, w, i, sum, err);
  cag_free(in.cuts);
  return status;
}

static void area_terms(CagVec3 p, CagVec3 du, CagVec3 dv, double *out) {
  out[0] = cag_norm(cag_cross(du, dv));
  out[1] = out[0] * p.x;
  out[2] = out[0] * p.y;
  out[3] = out[0] * p.z;
}

CagStatus cag_trimmed_area(const CagSurface *s, double *area, CagVec3 *centroid, CagError *err) {
  double sum[4];
  CagStatus status = integrate(s, area_terms, 4, sum, err);
  if (status) return status;
  *area = sum[0];
  if (centroid && sum[0] > 0) *centroid = cag_scaled(cag_vec3(sum[1], sum[2], sum[3]), 1 / sum[0]);
  else if (centroid) return cag_surface_point(s, s->u0, s->v0, centroid, err);
  return CAG_OK;
}

// The volume integrals as fluxes, as in measure.c; in two halves, because of the integration's
// limit on parts.
static void first_fluxes(CagVec3 p, CagVec3 du, CagVec3 dv, double *out) {
  CagVec3 n = cag_cross(du, dv);
  out[0] = cag_dot(p, n) / 3;
  out[1] = p.x * p.x * n.x / 2;
  out[2] = p.y * p.y * n.y / 2;
  out[3] = p.z * p.z * n.z / 2;
}

static void second_fluxes(CagVec3 p, CagVec3 du, CagVec3 dv, double *out) {
  CagVec3 n = cag_cross(du, dv);
  out[0] = p.x * p.x * p.x * n.x / 3;
  out[1] = p.y * p.y * p.y * n.y / 3;
  out[2] = p.z * p.z * p.z * n.z / 3;
  out[3] = p.x * p.x * p.y * n.x / 2;
  out[4] = p.y * p.y * p.z * n.y / 2;
  out[5] = p.z * p.z * p.x * n.z / 2;
}

CagStatus cag_trimmed_volume_terms(const CagSurface *s, double terms[10], CagError *err) {
  double sum[TERMS];
  CagStatus status = integrate(s, first_fluxes, 4, sum, err);
  if (!status) status = integrate(s, second_fluxes, 6, sum + 4, err);
  for (int k = 0; !status && k < TERMS; k++) terms[k] += sum[k];
  return status;
}

// --- Bounds ---

// Number of samples in each direction for finding peaks; Newton's method then refines the highest
// in each direction.
#define SAMPLES 32
#define NEWTON_STEPS 30

static double coordinate(CagVec3 p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

// From (u, v) to the point at which the gradient of a coordinate vanishes.
static CagStatus climb(const Trimmed *w, double u, double v, int axis, double sign, double *best,
                       CagError *err) {
  const CagSurface *s = &w->base;
  for (int k = 0; k < NEWTON_STEPS; k++) {
    CagVec3 d[9];
    bool inside;
    CagStatus status = cag_surface_eval(w->inner, u, v, 2, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err);
    if (!status) status = cag_region_contains(w->region, cag_vec3(u, v, 0), &inside, err);
    if (status) return status;
    if (inside) *best = fmax(*best, sign * coordinate(d[0], axis));
    double gu = coordinate(d[cag_partial(2, 1, 0)], axis);
    double gv = coordinate(d[cag_partial(2, 0, 1)], axis);
    double huu = coordinate(d[cag_partial(2, 2, 0)], axis);
    double huv = coordinate(d[cag_partial(2, 1, 1)], axis);
    double hvv = coordinate(d[cag_partial(2, 0, 2)], axis), det = huu * hvv - huv * huv;
    // Newton's method is used only near a maximum; otherwise the extremum is on the edge.
    if (!(det > 0) || sign * huu >= 0) return CAG_OK;
    double step_u = -(hvv * gu - huv * gv) / det, step_v = -(huu * gv - huv * gu) / det;
    u = clamp(u + step_u, s->u0, s->u1);
    v = clamp(v + step_v, s->v0, s->v1);
    if (fabs(step_u) <= 1e-15 * (s->u1 - s->u0) && fabs(step_v) <= 1e-15 * (s->v1 - s->v0))
      return CAG_OK;
  }
  return CAG_OK;
}

static double sample_at(double lo, double hi, int i) {
  return lo + (hi - lo) * (i + 0.5) / SAMPLES;
}

// The highest sample inside for each of the six directions, refined.
static CagStatus inner_extremes(const Trimmed *w, double best[6], CagError *err) {
  const CagSurface *s = &w->base;
  double top[6], place[6][2] = {{0}};
  for (int e = 0; e < 6; e++) top[e] = -INFINITY;
  for (int i = 0; i < SAMPLES; i++)
    for (int j = 0; j < SAMPLES; j++) {
      double u = sample_at(s->u0, s->u1, i), v = sample_at(s->v0, s->v1, j);
      CagVec3 p;
      bool inside;
      CagStatus status = cag_region_contains(w->region, cag_vec3(u, v, 0), &inside, err);
      if (!status && inside) status = cag_surface_point(w->inner, u, v, &p, err);
      if (status) return status;
      for (int e = 0; inside && e < 6; e++) {
        double value = (e % 2 ? 1 : -1) * coordinate(p, e / 2);
        if (value <= top[e]) continue;
        top[e] = value;
        place[e][0] = u;
        place[e][1] = v;
      }
    }
  for (int e = 0; e < 6; e++) {
    if (top[e] == -INFINITY) continue;
    best[e] = fmax(best[e], top[e]);
    CagStatus status = climb(w, place[e][0], place[e][1], e / 2, e % 2 ? 1 : -1, &best[e], err);
    if (status) return status;
  }
  return CAG_OK;
}

static CagStatus quadric_extremes(const Trimmed *w, double best[6], CagError *err) {
  for (int axis = 0; axis < 3; axis++) {
    CagVec3 at[2], p;
    const size_t n = cag_surface_quadric_extremes(w->inner, axis, at);
    for (size_t i = 0; i < n; i++) {
      bool inside;
      CagStatus status = cag_region_contains(w->region, at[i], &inside, err);
      if (!status && inside) status = cag_surface_point(w->inner, at[i].x, at[i].y, &p, err);
      if (status) return status;
      if (!inside) continue;
      best[2 * axis] = fmax(best[2 * axis], -coordinate(p, axis));
      best[2 * axis + 1] = fmax(best[2 * axis + 1], coordinate(p, axis));
    }
  }
  return CAG_OK;
}

CagStatus cag_trimmed_bounds(const CagSurface *s, CagBounds *out, CagError *err) {
  const Trimmed *w = (const Trimmed *)s;
  CagBounds box = CAG_BOUNDS_EMPTY;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < w->region->count; i++) {
    CagCurve *on;
    CagBounds part;
    status = cag_trimmed_loop(s, i, &on, err);
    if (status) break;
    status = cag_curve_bounds(on, &part, err);
    cag_curve_release(on);
    if (status) break;
    cag_bounds_add(&box, part.min);
    cag_bounds_add(&box, part.max);
  }
  if (status) return status;
  double best[6] = {-box.min.x, box.max.x, -box.min.y, box.max.y, -box.min.z, box.max.z};
  status = cag_surface_quadric_view(w->inner, NULL) ? quadric_extremes(w, best, err)
                                                    : inner_extremes(w, best, err);
  if (status) return status;
  *out = (CagBounds){{-best[0], -best[2], -best[4]}, {best[1], best[3], best[5]}};
  return CAG_OK;
}

// --- Other forms ---

CagStatus cag_trimmed_flip(const CagSurface *s, CagSurface **out, CagError *err) {
  const Trimmed *w = (const Trimmed *)s;
  // The inner surface's v is reversed over its domain, and so is the region's.
  CagTransform mirror = cag_transform_identity();
  mirror.m[1][1] = -1;
  mirror.m[1][3] = w->inner->v0 + w->inner->v1;
  CagRegion *image;
  CagSurface *turned = NULL;
  CagStatus status = cag_region_transform(w->region, &mirror, &image, err);
  if (status) return status;
  status = cag_surface_flip(w->inner, &turned, err);
  if (!status) status = cag_surface_trimmed(turned, image, out, err);
  if (turned) cag_surface_release(turned);
  cag_region_release(image);
  return status;
}

CagStatus cag_trimmed_transpose(const CagSurface *s, CagSurface **out, CagError *err) {
  const Trimmed *w = (const Trimmed *)s;
  CagTransform swap = cag_transform_identity();
  swap.m[0][0] = swap.m[1][1] = 0;
  swap.m[0][1] = swap.m[1][0] = 1;
  CagRegion *image;
  CagSurface *turned = NULL;
  CagStatus status = cag_region_transform(w->region, &swap, &image, err);
  if (status) return status;
  status = cag_surface_transpose(w->inner, &turned, err);
  if (!status) status = cag_surface_trimmed(turned, image, out, err);
  if (turned) cag_surface_release(turned);
  cag_region_release(image);
  return status;
}

CagStatus cag_trimmed_offset(const CagSurface *s, double d, CagSurface **out, CagError *err) {
  const Trimmed *w = (const Trimmed *)s;
  CagSurface *moved;
  CagStatus status = cag_surface_offset(w->inner, d, &moved, err);
  if (status) return status;
  status = cag_surface_trimmed(moved, w->region, out, err);
  cag_surface_release(moved);
  return status;
}
