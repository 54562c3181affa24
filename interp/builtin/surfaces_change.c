// Measures of whole surfaces, and what is made of one: samples, curves, other forms.

#include "base/memory.h"
#include "geom/surface/trimmed.h"
#include "interp/builtin/surfaces.h"

bool cag_surfaces_area(CagCall *call, const struct cag_surfaces_area *a, CagValue *result) {
  CagVec3 centroid;
  double area;
  if (!cag_geometry_ok(call, cag_surface_area(a->S, &area, &centroid, call->err))) return false;
  *result = cag_number(area);
  return true;
}

bool cag_surfaces_volume(CagCall *call, const struct cag_surfaces_volume *a, CagValue *result) {
  double terms[10] = {0};
  CagStatus status =
      cag_surface_is_closed(a->S)
          ? cag_surface_volume_terms(a->S, terms, call->err)
          : cag_fail(
                call->err, CAG_E_ARGUMENT, CAG_ERR_surface_open, "", -1,
                "the surface is open, so it has no volume; `solid` of all sides reports the gap");
  if (!cag_geometry_ok(call, status)) return false;
  *result = cag_number(fabs(terms[0]));
  return true;
}

// Of the body within, or of an open surface itself.
bool cag_surfaces_centroid(CagCall *call, const struct cag_surfaces_centroid *a, CagValue *result) {
  CagVec3 center;
  double terms[10] = {0}, area;
  CagStatus status = CAG_OK;
  if (cag_surface_is_closed(a->S)) status = cag_surface_volume_terms(a->S, terms, call->err);
  if (terms[0] != 0)
    center = cag_vec3(terms[1] / terms[0], terms[2] / terms[0], terms[3] / terms[0]);
  else if (!status) status = cag_surface_area(a->S, &area, &center, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  *result = cag_point(call->vm, center, 3);
  return true;
}

// Most points that one call makes.
#define POINTS_MAX 100000000

static double step(double from, double to, size_t i, size_t n) {
  return i == n ? to : from + (to - from) * ((double)i / (double)n);
}

bool cag_surfaces_sample(CagCall *call, CagValue *result) {
  CagSurface *s;
  long n, m;
  if (!cag_arg_side(call, 0, &s) || !cag_arg_integer(call, 1, 2, POINTS_MAX, &n) ||
      !cag_arg_integer(call, 2, 2, POINTS_MAX / n, &m))
    return false;
  size_t nu = (size_t)n, nv = (size_t)m;
  double *us = cag_hold_array(call, nu, sizeof *us), *vs = cag_hold_array(call, nv, sizeof *vs);
  CagVec3 *points = cag_hold(call, cag_malloc(nu * nv * sizeof *points));
  for (size_t i = 0; i < nu; i++) us[i] = step(s->u0, s->u1, i, nu - 1);
  for (size_t j = 0; j < nv; j++) vs[j] = step(s->v0, s->v1, j, nv - 1);
  CagStatus status = cag_surface_eval_grid(s, us, nu, vs, nv, points, NULL, NULL, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  *result = cag_table_value(call->vm, points, nu, nv);
  return true;
}

bool cag_surfaces_to_nurbs(CagCall *call, CagValue *result) {
  CagSurface *s, *out = NULL;
  if (!cag_arg_side(call, 0, &s)) return false;
  return cag_changed_surface_result(call, cag_surface_to_nurbs(s, &out, call->err), &out, result);
}

bool cag_surfaces_flip(CagCall *call, const struct cag_surfaces_flip *a, CagValue *result) {
  CagSurface *out = NULL;
  return cag_changed_surface_result(call, cag_surface_flip(a->S, &out, call->err), &out, result);
}

bool cag_surfaces_isocurve(CagCall *call, CagValue *result) {
  CagSurface *s;
  CagCurve *c = NULL;
  double at;
  if (!cag_arg_side(call, 0, &s)) return false;
  bool u = cag_given(call, 1);
  bool v = cag_given(call, 2);
  if (u == v)
    return cag_fail_call(call, u ? 2 : -1, CAG_ERR_value,
                         "expects either `u:` or `v:`, the constant parameter");
  bool read = u ? cag_arg_parameter(call, 1, s->angular_u, s->u0, s->u1, false, &at)
                : cag_arg_parameter(call, 2, s->angular_v, s->v0, s->v1, false, &at);
  return read &&
         cag_curve_result(call, cag_surface_isocurve(s, u ? 0 : 1, at, &c, call->err), &c, result);
}

static bool is_unrolled(const CagSurface *s) {
  const CagSurface *inner;
  CagTransform map;
  return (cag_surface_placed_view(s, &inner, &map) ? inner : s)->unrolled;
}

// The four edges, one after the other in the sense of u to v, as one closed curve.
static CagStatus outline(const CagSurface *s, CagCurve **out, CagError *err) {
  const struct {
    bool pole;
    int direction;
    double at;
    bool back;
  } sides[] = {{s->pole_v0, 1, s->v0, false},
               {s->pole_u1, 0, s->u1, false},
               {s->pole_v1, 1, s->v1, true},
               {s->pole_u0, 0, s->u0, true}};
  CagCurve *edges[4] = {NULL};
  size_t n = 0;
  CagStatus status = CAG_OK;
  for (int i = 0; !status && i < 4; i++) {
    if (sides[i].pole) continue;
    CagCurve *edge = NULL;
    status = cag_surface_isocurve(s, sides[i].direction, sides[i].at, &edge, err);
    if (!status && sides[i].back) status = cag_curve_reverse(edge, &edges[n++], err);
    else if (!status) edges[n++] = cag_curve_retain(edge);
    cag_curve_release(edge);
  }
  if (!status) status = cag_curve_join(edges, n, out, err);
  for (size_t i = 0; i < n; i++) cag_curve_release(edges[i]);
  return status;
}

bool cag_surfaces_boundary(CagCall *call, const struct cag_surfaces_boundary *a, CagValue *result) {
  const CagSurface *s = a->S;
  const struct {
    bool edge;
    int direction;
    double at;
  } sides[] = {{!s->closed_u && !s->pole_u0, 0, s->u0},
               {!s->closed_u && !s->pole_u1, 0, s->u1},
               {!s->closed_v && !s->pole_v0, 1, s->v0},
               {!s->closed_v && !s->pole_v1, 1, s->v1}};
  const CagRegion *region;
  CagTransform frame;
  const bool planar = cag_surface_planar_view(s, &region, &frame);
  const bool trimmed = !planar && cag_surface_trimmed_view(s, NULL, &region);
  const bool unrolled = !planar && !trimmed && is_unrolled(s);
  const size_t n = planar || trimmed ? region->count : unrolled ? 1 : 4;
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = 0; i < n; i++) {
    CagCurve *c = NULL;
    CagStatus status;
    CagValue curve;
    if (planar) status = cag_curve_transform(region->loops[i], &frame, &c, call->err);
    else if (trimmed) status = cag_trimmed_loop(s, i, &c, call->err);
    else if (unrolled) status = outline(s, &c, call->err);
    else if (!sides[i].edge) continue;
    else status = cag_surface_isocurve(s, sides[i].direction, sides[i].at, &c, call->err);
    if (!cag_curve_result(call, status, &c, &curve) || !cag_builder_add(call->vm, list, curve))
      return false;
  }
  *result = cag_builder_finish(call->vm, list);
  return true;
}
