// Curves as fields of messages (see put_curve.h).

#include "interp/kernel/put_curve.h"

#include <math.h>

#include "geom/curve/approximate.h"
#include "geom/curve/nurbs_ops.h"
#include "geom/linalg/tolerance.h"
#include "interp/kernel/protocol.h"

bool cag_no_exact_form(CagStatus status) {
  return status == CAG_E_UNSUPPORTED || status == CAG_E_DEGENERATE;
}

CagStatus cag_fail_inexact(const char *kind, CagError *err) {
  return cag_fail(
      err, CAG_E_UNSUPPORTED, CAG_ERR_export_not_exact, "", -1,
      "an operand has no exact NURBS form (%s): to approximate it within 0.01 mm, use --tolerance 0.01, or tolerance(.., 0.01) for this shape only",
      kind);
}

CagStatus cag_exact_curve(CagFields *f, const CagCurve *c, CagCurve **out, CagError *err) {
  const CagStatus status = cag_curve_to_nurbs(c, out, err);
  if (!cag_no_exact_form(status)) return status;
  if (!(f->tolerance > 0)) return cag_fail_inexact(c->kind->name, err);
  f->approximate = true;
  return cag_curve_approximate(c, f->tolerance, out, err);
}

static CagVec3 arc_column(const CagTransform *t, int j) {
  return cag_vec3(t->m[0][j], t->m[1][j], t->m[2][j]);
}

static bool put_space_arc(CagFields *f, const CagCurve *c) {
  double a, b;
  CagTransform t;
  if (!cag_curve_arc_view(c, &a, &b, &t) || !(a > 0) || !(b > 0)) return false;
  const CagVec3 x = arc_column(&t, 0), y = arc_column(&t, 1);
  if (fabs(cag_norm(x) - 1) > CAG_ROUNDING || fabs(cag_norm(y) - 1) > CAG_ROUNDING ||
      fabs(cag_dot(x, y)) > CAG_ROUNDING)
    return false;
  cag_put_u32(f, a == b ? CAG_BREP_CIRCLE : CAG_BREP_ELLIPSE);
  cag_put_vec(f, arc_column(&t, 3));
  cag_put_vec(f, x);
  cag_put_vec(f, y);
  cag_put_f64(f, a);
  if (a != b) cag_put_f64(f, b);
  return true;
}

static CagStatus put_space_spline(CagFields *f, const CagCurve *c, CagError *err) {
  CagCurve *exact, *clamped;
  CagNurbsView v = {0};
  CagStatus status = cag_exact_curve(f, c, &exact, err);
  if (status) return status;
  status = cag_curve_clamp(exact, &clamped, err);
  cag_curve_release(exact);
  if (status) return status;
  cag_curve_nurbs_view(clamped, &v);
  cag_put_u32(f, CAG_BREP_SPLINE_CURVE);
  cag_put_u32(f, (size_t)v.degree);
  cag_put_u32(f, v.rational);
  cag_put_u32(f, v.count);
  for (size_t i = 0; i < v.count; i++) {
    const double *h = v.homogeneous + 4 * i;
    cag_put_vec(f, cag_vec3(h[0] / h[3], h[1] / h[3], h[2] / h[3]));
    if (v.rational) cag_put_f64(f, h[3]);
  }
  for (size_t i = 0; i < v.count + (size_t)v.degree + 1; i++) cag_put_f64(f, v.knots[i]);
  cag_put_f64(f, clamped->start);
  cag_put_f64(f, clamped->end);
  cag_curve_release(clamped);
  return CAG_OK;
}

CagStatus cag_put_space_curve(CagFields *f, const CagCurve *c, CagError *err) {
  if (!put_space_arc(f, c)) return put_space_spline(f, c, err);
  cag_put_f64(f, c->start);
  cag_put_f64(f, c->end);
  return CAG_OK;
}
