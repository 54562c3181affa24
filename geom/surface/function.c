// Surfaces defined by a function of the caller.
//
// Images under transforms are placed surfaces (placed.c). Grids are evaluated row by row, so that
// one call handles many points.

#include "geom/surface/function.h"

#include "geom/surface/trimmed.h"

#include <math.h>
#include <stdio.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "geom/curve/family.h"
#include "geom/surface/family.h"

typedef struct Function {
  CagSurface base;
  CagSurfaceFunction function;
} Function;

static bool all_finite(CagVec3 p) { return isfinite(p.x) && isfinite(p.y) && isfinite(p.z); }

static CagStatus fail_not_finite(const CagSurface *s, double u, double v, bool point,
                                 CagError *err) {
  char a[32], b[32];
  return cag_fail(
      err, CAG_E_DEGENERATE, CAG_ERR_not_finite, "", -1,
      "%s of the function at u = %s%s, v = %s%s is not finite",
      point ? "the point" : "a derivative", cag_number_text(s->angular_u ? u * (180 / M_PI) : u, a),
      s->angular_u ? "deg" : "", cag_number_text(s->angular_v ? v * (180 / M_PI) : v, b),
      s->angular_v ? "deg" : "");
}

static CagStatus eval(const CagSurface *s, double u, double v, int n, CagSide su, CagSide sv,
                      CagVec3 *out, CagError *err) {
  (void)su;
  (void)sv;
  const CagSurfaceFunction *f = &((const Function *)s)->function;
  if (cag_on_worker()) return cag_worker_fail(err);
  CagStatus status = f->eval(f->context, u, v, n, out, err);
  if (status) return status;
  for (int i = 0; i <= n; i++)
    for (int j = 0; i + j <= n; j++)
      if (!all_finite(out[cag_partial(n, i, j)])) return fail_not_finite(s, u, v, i + j == 0, err);
  return CAG_OK;
}

static CagStatus eval_grid(const CagSurface *s, const double *us, size_t nu, const double *vs,
                           size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv, CagError *err) {
  const CagSurfaceFunction *f = &((const Function *)s)->function;
  if (cag_on_worker()) return cag_worker_fail(err);
  const bool partials = du || dv;
  const size_t each = partials ? 3 : 1;
  CagVec3 *row = cag_malloc((nv ? nv : 1) * each * sizeof *row);
  if (!row) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < nu; i++) {
    status = f->eval_row(f->context, us[i], vs, nv, partials, row, err);
    for (size_t j = 0; !status && j < nv; j++) {
      const CagVec3 *p = row + j * each;
      const size_t at = i * nv + j;
      if (!all_finite(p[0]) || (partials && (!all_finite(p[1]) || !all_finite(p[2]))))
        status = fail_not_finite(s, us[i], vs[j], !all_finite(p[0]), err);
      points[at] = p[0];
      if (du) du[at] = p[1];
      if (dv) dv[at] = p[2];
    }
  }
  cag_free(row);
  return status;
}

static void describe(const CagSurface *s, char *buffer, size_t size) {
  (void)s;
  snprintf(buffer, size, "by a formula");
}

static void destroy(CagSurface *s) {
  const CagSurfaceFunction *f = &((Function *)s)->function;
  if (f->release) f->release(f->context);
}

static void digest(const CagSurface *surface, CagDigest *d) {
  const Function *s = (const Function *)surface;
  if (s->function.digest) s->function.digest(s->function.context, d);
  else d->unknown = true;
}

static const CagSurfaceKind function_kind = {
    .name = "function",
    .eval = eval,
    .eval_grid = eval_grid,
    .describe = describe,
    .destroy = destroy,
    .digest = digest,
};

static CagStatus check_range(double a, double b, bool angular, const char *name, CagError *err) {
  char x[32], y[32];
  CagStatus status = cag_curve_check_number(a, name, err);
  if (!status) status = cag_curve_check_number(b, name, err);
  if (status || a < b) return status;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_empty_range, name, -1,
                  "the range %s..%s has no length; its start must be less than its end",
                  cag_number_text(angular ? a * (180 / M_PI) : a, x),
                  cag_number_text(angular ? b * (180 / M_PI) : b, y));
}

// The function must be defined at the corners, the middle, and on the edges, where closedness is
// determined.
static CagStatus probe(const CagSurface *s, CagError *err) {
  CagStatus status = CAG_OK;
  for (int i = 0; i <= 2; i++)
    for (int j = 0; !status && j <= 2; j++) {
      CagVec3 p;
      double u = i == 0 ? s->u0 : i == 1 ? s->u0 + (s->u1 - s->u0) / 2 : s->u1;
      double v = j == 0 ? s->v0 : j == 1 ? s->v0 + (s->v1 - s->v0) / 2 : s->v1;
      status = cag_surface_point(s, u, v, &p, err);
    }
  return status;
}

CagStatus cag_surface_function(const CagSurfaceFunction *f, double u0, double u1, bool angular_u,
                               double v0, double v1, bool angular_v, CagSurface **out,
                               CagError *err) {
  CagSurface *s;
  CagStatus status = check_range(u0, u1, angular_u, "u", err);
  if (!status) status = check_range(v0, v1, angular_v, "v", err);
  if (!status)
    status = cag_surface_block(sizeof(Function), &function_kind, u0, u1, v0, v1, &s, err);
  if (status) return status;
  s->angular_u = angular_u;
  s->angular_v = angular_v;
  Function *made = (Function *)s;
  made->function = *f;
  status = probe(s, err);
  if (status) {
    made->function.release = NULL; // the caller keeps the context
    cag_surface_release(s);
    return status;
  }
  cag_surface_judge(s);
  *out = s;
  return CAG_OK;
}

bool cag_surface_is_formula(const CagSurface *s) {
  CagTransform map;
  const CagRegion *region;
  while (cag_surface_placed_view(s, &s, &map) || cag_surface_trimmed_view(s, &s, &region)) continue;
  return s->kind == &function_kind;
}

CagStatus cag_surface_eval_beside(const CagSurface *s, const double lo[2], const double hi[2],
                                  const double at[2], int n, CagVec3 *out, CagError *err) {
  // Fractions of the rectangle, different so that no simple line through the point is hit.
  static const double steps[2] = {1e-9, 1.37e-9};
  double beside[2];
  for (int k = 0; k < 2; k++) {
    const double step = steps[k] * (hi[k] - lo[k]);
    beside[k] = at[k] < (lo[k] + hi[k]) / 2 ? at[k] + step : at[k] - step;
  }
  CagStatus status = CAG_OK;
  if (n > 0)
    status = cag_surface_eval(s, beside[0], beside[1], n, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, out, err);
  return status ? status
                : cag_surface_eval(s, at[0], at[1], 0, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, out, err);
}
