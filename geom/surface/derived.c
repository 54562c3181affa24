// Surfaces based on another one: parts, exchanged parameters, offsets.

#include <math.h>
#include <stdio.h>

#include "base/memory.h"
#include "geom/surface/family.h"
#include "geom/surface/nearest.h"
#include "geom/surface/reshape.h"
#include "geom/surface/trimmed.h"

typedef struct Derived {
  CagSurface base;
  CagSurface *inner;
  double distance;         // offset
  CagKeptBreaks breaks[2]; // by direction
} Derived;

static const CagSurfaceKind part_kind, transposed_kind, offset_kind;

static CagStatus make(const CagSurfaceKind *kind, const CagSurface *inner, double u0, double u1,
                      double v0, double v1, double distance, CagSurface **out, CagError *err) {
  CagSurface *s;
  CagStatus status = cag_surface_block(sizeof(Derived), kind, u0, u1, v0, v1, &s, err);
  if (status) return status;
  Derived *d = (Derived *)s;
  d->inner = cag_surface_retain(inner);
  d->distance = distance;
  const bool transposed = kind == &transposed_kind;
  s->angular_u = transposed ? inner->angular_v : inner->angular_u;
  s->angular_v = transposed ? inner->angular_u : inner->angular_v;
  status = cag_surface_keep_breaks(inner, transposed, u0, u1, &d->breaks[0], err);
  if (!status) status = cag_surface_keep_breaks(inner, !transposed, v0, v1, &d->breaks[1], err);
  if (status) {
    cag_surface_release(s);
    return status;
  }
  cag_surface_judge(s);
  *out = s;
  return CAG_OK;
}

static void derived_destroy(CagSurface *s) {
  Derived *d = (Derived *)s;
  cag_surface_release(d->inner);
  cag_free(d->breaks[0].at);
  cag_free(d->breaks[1].at);
}

static void derived_describe(const CagSurface *s, char *buffer, size_t size) {
  const Derived *d = (const Derived *)s;
  char text[32];
  if (s->kind == &offset_kind)
    snprintf(buffer, size, "of %s %s surface by %s", cag_article(d->inner->kind->name),
             d->inner->kind->name, cag_number_text(d->distance, text));
  else
    snprintf(buffer, size, "of %s %s surface", cag_article(d->inner->kind->name),
             d->inner->kind->name);
}

static size_t derived_breaks(const CagSurface *s, int direction, double *out, size_t capacity) {
  return cag_surface_kept_breaks(&((const Derived *)s)->breaks[direction], out, capacity);
}

// --- Parts ---

static CagStatus part_eval(const CagSurface *s, double u, double v, int n, CagSide su, CagSide sv,
                           CagVec3 *out, CagError *err) {
  return cag_surface_eval(((const Derived *)s)->inner, u, v, n, su, sv, out, err);
}

static CagStatus part_grid(const CagSurface *s, const double *us, size_t nu, const double *vs,
                           size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv, CagError *err) {
  return cag_surface_eval_grid(((const Derived *)s)->inner, us, nu, vs, nv, points, du, dv, err);
}

// The parameter of the exact form that corresponds to `at` on the inner surface. In every exact
// form the lines of constant u and v are those of the surface, but their parameters may differ: the
// form of an arc is not parametrized by the angle. Two points of the line must have the same
// parameter; otherwise it does not exist.
static CagStatus part_cut(const CagSurface *s, const CagSurface *exact, int direction, double at,
                          double *out, CagError *err) {
  const CagSurface *inner = ((const Derived *)s)->inner;
  const double ends[2] = {direction == 0 ? inner->u0 : inner->v0,
                          direction == 0 ? inner->u1 : inner->v1};
  const double exact_ends[2] = {direction == 0 ? exact->u0 : exact->v0,
                                direction == 0 ? exact->u1 : exact->v1};
  for (int i = 0; i < 2; i++)
    if (at == ends[i]) {
      *out = exact_ends[i];
      return CAG_OK;
    }
  const double stations[2] = {0.4, 0.7}; // across, on the part
  double found[2];
  for (int i = 0; i < 2; i++) {
    CagVec3 p;
    CagSurfaceNearest near;
    double u = direction == 0 ? at : s->u0 + stations[i] * (s->u1 - s->u0);
    double v = direction == 1 ? at : s->v0 + stations[i] * (s->v1 - s->v0);
    CagStatus status = cag_surface_point(inner, u, v, &p, err);
    if (!status) status = cag_surface_closest(exact, p, &near, err);
    if (status) return status;
    found[i] = direction == 0 ? near.u : near.v;
  }
  const double rounding = CAG_SURFACE_SAME * (exact_ends[1] - exact_ends[0]);
  *out = fabs(found[0] - at) <= rounding ? at : found[0];
  if (fabs(found[0] - found[1]) <= rounding) return CAG_OK;
  return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_no_exact_form, "surface", -1,
                  "a part of %s %s surface has no exact NURBS form; approximate it to a tolerance",
                  cag_article(inner->kind->name), inner->kind->name);
}

static CagStatus part_to_nurbs(const CagSurface *s, CagSurface **out, CagError *err) {
  CagSurface *exact;
  double at[4];
  const double cuts[4] = {s->u0, s->u1, s->v0, s->v1};
  CagStatus status = cag_surface_to_nurbs(((const Derived *)s)->inner, &exact, err);
  if (status) return status;
  for (int i = 0; !status && i < 4; i++) status = part_cut(s, exact, i / 2, cuts[i], &at[i], err);
  if (!status) status = cag_surface_nurbs_part(exact, at[0], at[1], at[2], at[3], out, err);
  cag_surface_release(exact);
  return status;
}

static void derived_digest(const CagSurface *surface, CagDigest *d) {
  const Derived *s = (const Derived *)surface;
  cag_surface_digest(s->inner, d);
  cag_digest_number(d, s->distance);
}

static const CagSurfaceKind part_kind = {
    .name = "part",
    .eval = part_eval,
    .eval_grid = part_grid,
    .to_nurbs = part_to_nurbs,
    .breaks = derived_breaks,
    .describe = derived_describe,
    .destroy = derived_destroy,
    .digest = derived_digest,
};

static CagStatus check_range(double a, double b, double lo, double hi, bool angular,
                             const char *name, CagError *err) {
  char x[32], y[32], from[32], to[32];
  if (a < b && a >= lo && b <= hi) return CAG_OK;
  const double shown = angular ? 180 / M_PI : 1;
  const char *deg = angular ? "deg" : "";
  return cag_fail(err, CAG_E_DOMAIN, a < b ? CAG_ERR_parameter_range : CAG_ERR_empty_range, name,
                  -1, "`%s` must be a range within %s%s..%s%s, found %s%s..%s%s", name,
                  cag_number_text(shown * lo, from), deg, cag_number_text(shown * hi, to), deg,
                  cag_number_text(shown * a, x), deg, cag_number_text(shown * b, y), deg);
}

CagStatus cag_surface_part(const CagSurface *s, double u0, double u1, double v0, double v1,
                           CagSurface **out, CagError *err) {
  CagSurfaceNurbsView view;
  CagStatus status = check_range(u0, u1, s->u0, s->u1, s->angular_u, "u", err);
  if (!status) status = check_range(v0, v1, s->v0, s->v1, s->angular_v, "v", err);
  if (status) return status;
  if (cag_surface_planar_view(s, NULL, NULL))
    return cag_fail(
        err, CAG_E_UNSUPPORTED, CAG_ERR_no_exact_form, "surface", -1,
        "a plane region cannot be trimmed by ranges of parameters; trim the region itself");
  if (cag_surface_trimmed_view(s, NULL, NULL))
    return cag_fail(
        err, CAG_E_UNSUPPORTED, CAG_ERR_already_trimmed, "", -1,
        "the surface is already trimmed by curves; trim by ranges first, then by curves");
  if (cag_surface_nurbs_view(s, &view)) return cag_surface_nurbs_part(s, u0, u1, v0, v1, out, err);
  const CagSurface *inner = s->kind == &part_kind ? ((const Derived *)s)->inner : s;
  return make(&part_kind, inner, u0, u1, v0, v1, 0, out, err);
}

// --- Exchanged parameters ---

static CagStatus transposed_eval(const CagSurface *s, double u, double v, int n, CagSide su,
                                 CagSide sv, CagVec3 *out, CagError *err) {
  CagStatus status = cag_surface_eval(((const Derived *)s)->inner, v, u, n, sv, su, out, err);
  for (int i = 0; !status && i <= n; i++)
    for (int j = 0; j < i && i + j <= n; j++) {
      CagVec3 swap = out[cag_partial(n, i, j)];
      out[cag_partial(n, i, j)] = out[cag_partial(n, j, i)];
      out[cag_partial(n, j, i)] = swap;
    }
  return status;
}

static CagStatus transposed_to_nurbs(const CagSurface *s, CagSurface **out, CagError *err) {
  CagSurface *exact;
  CagStatus status = cag_surface_to_nurbs(((const Derived *)s)->inner, &exact, err);
  if (status) return status;
  status = cag_surface_nurbs_swapped(exact, out, err);
  cag_surface_release(exact);
  return status;
}

static const CagSurfaceKind transposed_kind = {
    .name = "transposed",
    .eval = transposed_eval,
    .to_nurbs = transposed_to_nurbs,
    .breaks = derived_breaks,
    .describe = derived_describe,
    .destroy = derived_destroy,
    .digest = derived_digest,
};

CagStatus cag_surface_transpose(const CagSurface *s, CagSurface **out, CagError *err) {
  if (cag_surface_trimmed_view(s, NULL, NULL)) return cag_trimmed_transpose(s, out, err);
  CagSurfaceNurbsView view;
  if (cag_surface_nurbs_view(s, &view)) return cag_surface_nurbs_swapped(s, out, err);
  if (s->kind == &transposed_kind) {
    *out = cag_surface_retain(((const Derived *)s)->inner);
    return CAG_OK;
  }
  return make(&transposed_kind, s, s->v0, s->v1, s->u0, s->u1, 0, out, err);
}

// --- Offsets ---

#define SIDE (CAG_MAX_PARTIAL + 1)
typedef struct Series {
  CagVec3 c[SIDE][SIDE]; // Taylor coefficients by u and v, total order <= n
} Series;

static double dot_term(const Series *a, const Series *b, int i, int j) {
  double sum = 0;
  for (int k = 0; k <= i; k++)
    for (int l = 0; l <= j; l++) sum += cag_dot(a->c[k][l], b->c[i - k][j - l]);
  return sum;
}

static void series_cross(const Series *a, const Series *b, int n, Series *out) {
  for (int i = 0; i <= n; i++)
    for (int j = 0; i + j <= n; j++) {
      CagVec3 sum = {0, 0, 0};
      for (int k = 0; k <= i; k++)
        for (int l = 0; l <= j; l++) sum = cag_add(sum, cag_cross(a->c[k][l], b->c[i - k][j - l]));
      out->c[i][j] = sum;
    }
}

// N / |N|: with w = N . N and f = w^(-1/2), w D f = -1/2 f D w gives f order by order (by u, and
// for i = 0 by v).
static void series_unit(const Series *a, int n, Series *out) {
  double w[SIDE][SIDE], f[SIDE][SIDE];
  for (int i = 0; i <= n; i++)
    for (int j = 0; i + j <= n; j++) w[i][j] = dot_term(a, a, i, j);
  for (int i = 0; i <= n; i++)
    for (int j = 0; i + j <= n; j++) {
      if (i + j == 0) {
        f[0][0] = 1 / sqrt(w[0][0]);
        continue;
      }
      bool by_u = i > 0;
      int order = by_u ? i : j;
      double sum = 0;
      for (int k = 0; k <= i; k++)
        for (int l = 0; l <= j; l++) {
          if (k + l == 0) continue;
          int of_w = by_u ? k : l, of_f = order - of_w;
          sum += (-0.5 * of_w - of_f) * w[k][l] * f[i - k][j - l];
        }
      f[i][j] = sum / (order * w[0][0]);
    }
  for (int i = 0; i <= n; i++)
    for (int j = 0; i + j <= n; j++) {
      CagVec3 sum = {0, 0, 0};
      for (int k = 0; k <= i; k++)
        for (int l = 0; l <= j; l++) sum = cag_madd(sum, f[i - k][j - l], a->c[k][l]);
      out->c[i][j] = sum;
    }
}

static const double FACTORIAL[] = {1, 1, 2, 6, 24, 120, 720, 5040, 40320};

// Points need only the normal, which has a limit at poles.
static CagStatus offset_point(const Derived *d, double u, double v, CagVec3 *out, CagError *err) {
  CagVec3 normal;
  CagStatus status = cag_surface_point(d->inner, u, v, out, err);
  if (!status) status = cag_surface_normal(d->inner, u, v, &normal, err);
  if (!status) *out = cag_madd(*out, d->distance, normal);
  return status;
}

// Where the normal is a limit, derivatives are evaluated this fraction of the domain inside.
#define FROM_POLE 1e-7

// Partials of order n. *has_normal is false if the surface has no normal there; the partials are
// then undefined.
static CagStatus offset_partials(const Derived *d, double u, double v, int n, CagSide su,
                                 CagSide sv, CagVec3 *out, bool *has_normal, CagError *err) {
  CagVec3 all[SIDE * SIDE];
  CagStatus status = cag_surface_eval(d->inner, u, v, n + 1, su, sv, all, err);
  if (status) return status;
  Series du, dv, normal, unit;
  for (int i = 0; i <= n; i++)
    for (int j = 0; i + j <= n; j++) {
      double f = 1 / (FACTORIAL[i] * FACTORIAL[j]);
      du.c[i][j] = cag_scaled(all[cag_partial(n + 1, i + 1, j)], f);
      dv.c[i][j] = cag_scaled(all[cag_partial(n + 1, i, j + 1)], f);
    }
  series_cross(&du, &dv, n, &normal);
  *has_normal = cag_dot(normal.c[0][0], normal.c[0][0]) > 0;
  if (!*has_normal) return CAG_OK;
  series_unit(&normal, n, &unit);
  for (int i = 0; i <= n; i++)
    for (int j = 0; i + j <= n; j++)
      out[cag_partial(n, i, j)] = cag_madd(all[cag_partial(n + 1, i, j)],
                                           d->distance * FACTORIAL[i] * FACTORIAL[j], unit.c[i][j]);
  return CAG_OK;
}

static CagStatus offset_eval(const CagSurface *s, double u, double v, int n, CagSide su, CagSide sv,
                             CagVec3 *out, CagError *err) {
  const Derived *d = (const Derived *)s;
  const CagSurface *in = d->inner;
  if (n == 0) return offset_point(d, u, v, out, err);
  if (n + 1 > CAG_MAX_PARTIAL)
    return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_derivative_order, "order", -1,
                    "an offset has partial derivatives up to order %d, not %d", CAG_MAX_PARTIAL - 1,
                    n);
  CagVec3 point;
  CagStatus status = offset_point(d, u, v, &point, err);
  if (status) return status;
  double hu = FROM_POLE * (in->u1 - in->u0), hv = FROM_POLE * (in->v1 - in->v0);
  if (in->pole_u0 && u < in->u0 + hu) u = in->u0 + hu;
  if (in->pole_u1 && u > in->u1 - hu) u = in->u1 - hu;
  if (in->pole_v0 && v < in->v0 + hv) v = in->v0 + hv;
  if (in->pole_v1 && v > in->v1 - hv) v = in->v1 - hv;
  bool has_normal;
  status = offset_partials(d, u, v, n, su, sv, out, &has_normal, err);
  // An interior point without normal, as on the axis of a horn torus.
  if (!status && !has_normal) {
    u += u + hu <= in->u1 && (su == CAG_SIDE_RIGHT || u - hu < in->u0) ? hu : -hu;
    v += v + hv <= in->v1 && (sv == CAG_SIDE_RIGHT || v - hv < in->v0) ? hv : -hv;
    status = offset_partials(d, u, v, n, su, sv, out, &has_normal, err);
  }
  if (!status && !has_normal)
    status = cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_degenerate_normal, "", -1,
                      "the surface has no normal here, so its offset has no derivatives");
  out[0] = point;
  return status;
}

static const CagSurfaceKind offset_kind = {
    .name = "offset",
    .eval = offset_eval,
    .breaks = derived_breaks,
    .describe = derived_describe,
    .destroy = derived_destroy,
    .digest = derived_digest,
};

CagStatus cag_surface_offset(const CagSurface *s, double d, CagSurface **out, CagError *err) {
  if (!isfinite(d))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "d", -1, "`d` must be finite");
  if (cag_surface_planar_view(s, NULL, NULL)) {
    CagVec3 n;
    CagStatus status = cag_surface_normal(s, s->u0, s->v0, &n, err);
    CagTransform move = cag_translate(cag_scaled(n, d));
    move.planar = false;
    return status ? status : cag_surface_transform(s, &move, out, err);
  }
  if (cag_surface_trimmed_view(s, NULL, NULL)) return cag_trimmed_offset(s, d, out, err);
  CagVec3 probe;
  CagStatus status = make(&offset_kind, s, s->u0, s->u1, s->v0, s->v1, d, out, err);
  if (status) return status;
  // Away from poles the normal must exist.
  status = cag_surface_point(*out, (s->u0 + s->u1) / 2, (s->v0 + s->v1) / 2, &probe, err);
  if (status) cag_surface_release(*out);
  return status;
}

bool cag_surface_offset_view(const CagSurface *s, const CagSurface **inner, double *d) {
  if (s->kind != &offset_kind) return false;
  *inner = ((const Derived *)s)->inner;
  *d = ((const Derived *)s)->distance;
  return true;
}
