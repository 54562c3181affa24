// Converts curves and surfaces to the form that files of exact geometry support: clamped, with
// positive weights, and polynomial if possible.

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "geom/curve/approximate.h"
#include "geom/curve/nurbs.h"
#include "geom/curve/nurbs_ops.h"
#include "geom/surface/approximate.h"
#include "geom/surface/family.h"
#include "geom/surface/reshape.h"
#include "interp/formats/brep_build.h"

// Weights count as equal up to this relative difference, which allows for rounding.
#define WEIGHT_SAME 1e-14
// The sine of the smallest angle that counts as a corner. Rounding of exact arcs is a thousand
// times smaller, and other programs treat smaller angles as smooth.
#define CORNER 1e-7
// The largest distance of control points from a line, as a fraction of its length, which allows for
// rounding after degree elevation.
#define LINE_SAME 1e-13

// --- Shapes without an exact form ---

static CagStatus fail_inexact(const CagBrepWork *w, const char *what, CagError *err) {
  return cag_fail(
      err, CAG_E_UNSUPPORTED, CAG_ERR_export_not_exact, "", -1,
      "%s has no exact NURBS form (%s): to approximate it within 0.01 mm, use --tolerance 0.01, or tolerance(.., 0.01) for this shape only",
      w->item->name, what);
}

// Reports a shape that cannot be approximated at some point, and what to do.
static CagStatus name_rough(const CagBrepWork *w, CagStatus status, const char *what,
                            CagError *err) {
  if (status != CAG_E_CONVERGENCE) return status;
  return cag_fail(
      err, CAG_E_CONVERGENCE, CAG_ERR_convergence, "", -1,
      "%s (%s) is not smooth at a point, so it cannot be approximated within %g mm: use a larger --tolerance, split the shape there, or write .stl, .obj, .ply, or .glb",
      w->item->name, what, w->asked);
}

static CagStatus fail_weight(const CagBrepWork *w, double weight, CagError *err) {
  char text[32];
  return cag_fail(
      err, CAG_E_UNSUPPORTED, CAG_ERR_export_weight, "weights", -1,
      "%s has a control point of weight %s, but files of exact geometry need positive weights: raise the degree with elevate(..), or insert a knot, until all are positive",
      w->item->name, cag_number_text(weight, text));
}

static bool no_exact_form(CagStatus status) {
  return status == CAG_E_UNSUPPORTED || status == CAG_E_DEGENERATE;
}

// --- Weights ---

typedef enum Weights { WEIGHTS_ONE, WEIGHTS_ALIKE, WEIGHTS_VARY, WEIGHTS_BAD } Weights;

static Weights judge_weights(const double *h, size_t n, double *bad) {
  double low = h[3], high = h[3];
  for (size_t i = 1; i < n; i++) {
    low = fmin(low, h[4 * i + 3]);
    high = fmax(high, h[4 * i + 3]);
  }
  *bad = low;
  if (!(low > 0)) return WEIGHTS_BAD;
  if (high - low > WEIGHT_SAME * high) return WEIGHTS_VARY;
  return low == 1 && high == 1 ? WEIGHTS_ONE : WEIGHTS_ALIKE;
}

// Divides each point by its weight, so that the weights are 1.
static double *without_weights(const double *h, size_t n) {
  double *out = cag_malloc(4 * n * sizeof *out);
  for (size_t i = 0; out && i < n; i++) {
    for (int c = 0; c < 3; c++) out[4 * i + c] = h[4 * i + c] / h[4 * i + 3];
    out[4 * i + 3] = 1;
  }
  return out;
}

static CagStatus curve_weights(const CagBrepWork *w, CagCurve **c, CagError *err) {
  CagNurbsView v;
  double bad;
  if (!cag_curve_nurbs_view(*c, &v)) return CAG_OK;
  Weights how = judge_weights(v.homogeneous, v.count, &bad);
  if (how == WEIGHTS_BAD) return fail_weight(w, bad, err);
  if (how == WEIGHTS_VARY || !v.rational) return CAG_OK;
  double *plain = without_weights(v.homogeneous, v.count);
  if (!plain) return cag_fail_memory(err);
  CagCurve *out;
  CagStatus status = cag_nurbs_new(plain, v.count, v.degree, v.knots, false, 0, CAG_NURBS_BSPLINE,
                                   (*c)->dimension, &out, err);
  cag_free(plain);
  if (status) return status;
  cag_curve_release(*c);
  *c = out;
  return CAG_OK;
}

static CagStatus surface_weights(const CagBrepWork *w, CagSurface **s, CagError *err) {
  CagSurfaceNurbsView v;
  double bad;
  if (!cag_surface_nurbs_view(*s, &v)) return CAG_OK;
  Weights how = judge_weights(v.homogeneous, v.nu * v.nv, &bad);
  if (how == WEIGHTS_BAD) return fail_weight(w, bad, err);
  if (how == WEIGHTS_VARY || !v.rational) return CAG_OK;
  double *plain = without_weights(v.homogeneous, v.nu * v.nv);
  if (!plain) return cag_fail_memory(err);
  CagSurface *out;
  CagStatus status = cag_surface_from_homogeneous(plain, v.nu, v.nv, v.degree_u, v.degree_v,
                                                  v.knots_u, v.knots_v, &out, err);
  cag_free(plain);
  if (status) return status;
  cag_surface_release(*s);
  *s = out;
  return CAG_OK;
}

// --- Curves ---

CagStatus cag_brep_curve(CagBrepWork *w, const CagCurve *c, CagCurve **out, CagError *err) {
  CagCurve *exact = NULL, *clamped = NULL, *space = NULL;
  CagStatus status = cag_curve_to_nurbs(c, &exact, err);
  if (no_exact_form(status)) {
    if (!(w->asked > 0)) return fail_inexact(w, c->kind->name, err);
    w->approximate = true;
    status = name_rough(w, cag_curve_approximate(c, w->asked, &exact, err), c->kind->name, err);
  }
  if (!status) status = cag_curve_clamp(exact, &clamped, err);
  if (!status) status = cag_curve_to_space(clamped, &space, err);
  if (!status) status = curve_weights(w, &space, err);
  cag_curve_release(exact);
  cag_curve_release(clamped);
  if (status) cag_curve_release(space);
  else *out = space;
  return status;
}

static bool turns(CagVec3 before, CagVec3 after) {
  double a = cag_norm(before), b = cag_norm(after);
  if (!(a > 0) || !(b > 0)) return false; // zero speed alone is not a corner
  return cag_norm(cag_cross(before, after)) > CORNER * a * b || cag_dot(before, after) < 0;
}

// Returns the distinct inner knots with at least multiplicity `degree`. Elsewhere, the derivative
// is continuous.
static size_t full_knots(const double *knots, size_t count, int degree, double *out) {
  size_t n = 0, p = (size_t)degree;
  for (size_t i = p + 1; i < count; i++) {
    if (!(knots[i] > knots[p]) || !(knots[i] < knots[count])) continue;
    if (knots[i + p - 1] != knots[i] || (n > 0 && out[n - 1] == knots[i])) continue;
    out[n++] = knots[i];
  }
  return n;
}

CagStatus cag_brep_curve_corners(const CagCurve *c, double **out, size_t *n, CagError *err) {
  CagNurbsView v = {0};
  cag_curve_nurbs_view(c, &v);
  double *t = cag_malloc((v.count + 1) * sizeof *t);
  if (!t) return cag_fail_memory(err);
  size_t found = full_knots(v.knots, v.count, v.degree, t);
  *n = 0;
  for (size_t i = 0; i < found; i++) {
    CagVec3 before[2], after[2];
    CagStatus status = cag_curve_eval(c, t[i], 1, CAG_SIDE_LEFT, before, err);
    if (!status) status = cag_curve_eval(c, t[i], 1, CAG_SIDE_RIGHT, after, err);
    if (status) {
      cag_free(t);
      return status;
    }
    if (turns(before[1], after[1])) t[(*n)++] = t[i];
  }
  *out = t;
  return CAG_OK;
}

// On a line with constant speed, control points are at the averages of knots (Greville abscissas).
bool cag_brep_is_straight(const CagCurve *c) {
  CagNurbsView v;
  double bad;
  if (!cag_curve_nurbs_view(c, &v) || judge_weights(v.homogeneous, v.count, &bad) > WEIGHTS_ALIKE)
    return false;
  const double *first = v.homogeneous, *last = first + 4 * (v.count - 1);
  const CagVec3 p = cag_vec3(first[0] / first[3], first[1] / first[3], first[2] / first[3]);
  const CagVec3 q = cag_vec3(last[0] / last[3], last[1] / last[3], last[2] / last[3]);
  const double slack = LINE_SAME * cag_norm(cag_sub(q, p));
  for (size_t i = 0; i < v.count; i++) {
    const double *h = v.homogeneous + 4 * i;
    double at = 0;
    for (size_t k = i + 1; k <= i + (size_t)v.degree; k++) at += v.knots[k] / v.degree;
    const CagVec3 on = cag_lerp(p, q, (at - c->start) / (c->end - c->start));
    const CagVec3 off = cag_sub(cag_vec3(h[0] / h[3], h[1] / h[3], h[2] / h[3]), on);
    if (cag_norm(off) > slack) return false;
  }
  return slack > 0;
}

// --- Surfaces ---

static const char *what_it_is(const CagSurface *s) {
  const CagSurface *inner;
  CagTransform map;
  return cag_surface_placed_view(s, &inner, &map) ? inner->kind->name : s->kind->name;
}

CagStatus cag_brep_surface(CagBrepWork *w, const CagSurface *s, CagSurface **out, CagError *err) {
  CagSurface *exact = NULL, *clamped = NULL;
  CagStatus status = cag_surface_to_nurbs(s, &exact, err);
  if (no_exact_form(status)) {
    if (!(w->asked > 0)) return fail_inexact(w, what_it_is(s), err);
    w->approximate = true;
    status = name_rough(w, cag_surface_approximate(s, w->asked, &exact, err), what_it_is(s), err);
  }
  if (!status)
    status =
        cag_surface_nurbs_part(exact, exact->u0, exact->u1, exact->v0, exact->v1, &clamped, err);
  if (!status) status = surface_weights(w, &clamped, err);
  cag_surface_release(exact);
  if (status) cag_surface_release(clamped);
  else *out = clamped;
  return status;
}

CagStatus cag_brep_side_curve(const CagSurface *s, int side, CagCurve **out, CagError *err) {
  CagSurfaceNurbsView v = {0};
  cag_surface_nurbs_view(s, &v);
  bool along_v = side < 2;
  size_t n = along_v ? v.nv : v.nu, line = side % 2 == 0 ? 0 : (along_v ? v.nu : v.nv) - 1;
  double *h = cag_malloc(4 * n * sizeof *h), bad;
  if (!h) return cag_fail_memory(err);
  for (size_t i = 0; i < n; i++) {
    size_t at = along_v ? line * v.nv + i : i * v.nv + line;
    memcpy(h + 4 * i, v.homogeneous + 4 * at, 4 * sizeof *h);
  }
  Weights how = judge_weights(h, n, &bad);
  if (how == WEIGHTS_ALIKE)
    for (size_t i = 0; i < n; i++) {
      for (int c = 0; c < 3; c++) h[4 * i + c] /= h[4 * i + 3];
      h[4 * i + 3] = 1;
    }
  bool rational = how == WEIGHTS_VARY;
  CagStatus status =
      cag_nurbs_new(h, n, along_v ? v.degree_v : v.degree_u, along_v ? v.knots_v : v.knots_u,
                    rational, 0, rational ? CAG_NURBS_RATIONAL : CAG_NURBS_BSPLINE, 3, out, err);
  cag_free(h);
  return status;
}

// The number of lines across a possible crease that are examined.
#define CREASE_PROBES 7

static CagStatus is_crease(const CagSurface *s, int direction, double t, bool *out, CagError *err) {
  *out = false;
  for (int i = 0; i < CREASE_PROBES && !*out; i++) {
    double part = (i + 0.5) / CREASE_PROBES;
    double u = direction == 0 ? t : s->u0 + part * (s->u1 - s->u0);
    double v = direction == 1 ? t : s->v0 + part * (s->v1 - s->v0);
    CagVec3 before[4], after[4];
    CagStatus status = cag_surface_eval(s, u, v, 1, CAG_SIDE_LEFT, CAG_SIDE_LEFT, before, err);
    if (!status)
      status = cag_surface_eval(s, u, v, 1, direction == 0 ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT,
                                direction == 1 ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT, after, err);
    if (status) return status;
    size_t along = direction == 0 ? cag_partial(1, 1, 0) : cag_partial(1, 0, 1);
    *out = turns(before[along], after[along]);
  }
  return CAG_OK;
}

CagStatus cag_brep_surface_creases(const CagSurface *s, int direction, double **out, size_t *n,
                                   CagError *err) {
  CagSurfaceNurbsView v = {0};
  cag_surface_nurbs_view(s, &v);
  size_t count = direction == 0 ? v.nu : v.nv;
  double *t = cag_malloc((count + 1) * sizeof *t);
  if (!t) return cag_fail_memory(err);
  size_t found = full_knots(direction == 0 ? v.knots_u : v.knots_v, count,
                            direction == 0 ? v.degree_u : v.degree_v, t);
  *n = 0;
  for (size_t i = 0; i < found; i++) {
    bool crease;
    CagStatus status = is_crease(s, direction, t[i], &crease, err);
    if (status) {
      cag_free(t);
      return status;
    }
    if (crease) t[(*n)++] = t[i];
  }
  *out = t;
  return CAG_OK;
}
