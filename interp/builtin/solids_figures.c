// Shapes that illustrate other shapes: control nets, isolines, arrows, and frames.

#include "geom/basis/bernstein.h"
#include "interp/builtin/solids.h"
#include "interp/builtin/surfaces.h"

static bool add_line(CagCall *call, CagBuilder *list, const CagVec3 *points, size_t n, bool closed,
                     int dimension) {
  CagCurve *c = NULL;
  return cag_geometry_ok(call, cag_curve_polyline(points, n, closed, dimension, &c, call->err)) &&
         cag_builder_add(call->vm, list, cag_curve_value(call->vm, c));
}

bool cag_solids_control_net(CagCall *call, const struct cag_solids_control_net *a,
                            CagValue *result) {
  CagSurfaceNurbsView net;
  if (!cag_surface_net(call, a->S, "control points", &net)) return false;
  CagBuilder *list = cag_builder_new(call->vm);
  size_t nu = net.distinct_u, nv = net.distinct_v;
  CagVec3 *points = cag_hold_array(call, nu > nv ? nu : nv, sizeof *points);
  for (size_t i = 0; i < nu; i++) {
    for (size_t j = 0; j < nv; j++) points[j] = cag_project(net.homogeneous + 4 * (i * net.nv + j));
    if (!add_line(call, list, points, nv, net.periodic_v, 3)) return false;
  }
  for (size_t j = 0; j < nv; j++) {
    for (size_t i = 0; i < nu; i++) points[i] = cag_project(net.homogeneous + 4 * (i * net.nv + j));
    if (!add_line(call, list, points, nu, net.periodic_u, 3)) return false;
  }
  return cag_group_result(call, list, result);
}

static bool add_isolines(CagCall *call, CagBuilder *list, const CagSurface *s, int direction,
                         long n) {
  double from = direction ? s->v0 : s->u0, to = direction ? s->v1 : s->u1;
  bool closed = direction ? s->closed_v : s->closed_u;
  bool poles[2] = {direction ? s->pole_v0 : s->pole_u0, direction ? s->pole_v1 : s->pole_u1};
  // In a closed direction, the last line would coincide with the first.
  long last = closed ? n : n - 1;
  for (long i = 0; i < n; i++) {
    if ((i == 0 && poles[0]) || (i == last && poles[1])) continue;
    double at = last == 0 ? from : from + (to - from) * ((double)i / (double)last);
    CagCurve *c = NULL;
    CagValue line;
    if (!cag_curve_result(call, cag_surface_isocurve(s, direction, at, &c, call->err), &c, &line) ||
        !cag_builder_add(call->vm, list, line))
      return false;
  }
  return true;
}

bool cag_solids_isolines(CagCall *call, const struct cag_solids_isolines *a, CagValue *result) {
  CagSurface *s;
  CagBuilder *list = cag_builder_new(call->vm);
  return cag_arg_side(call, 0, &s) && add_isolines(call, list, s, 0, a->nu) &&
         add_isolines(call, list, s, 1, a->nv) && cag_group_result(call, list, result);
}

// The proportions of an arrow: the radius of the shaft relative to its length, the length and
// radius of the head relative to the radius of the shaft, and the largest fraction of the arrow
// that the head occupies.
#define SHAFT 0.02
#define HEAD_LENGTH 8
#define HEAD_RADIUS 2.5
#define HEAD_PART 0.5

static bool make_arrow(CagCall *call, CagVec3 p, CagVec3 v, double radius, CagValue *result) {
  CagSolid *shaft = NULL, *head = NULL;
  double length = cag_norm(v);
  double head_length = fmin(HEAD_LENGTH * radius, HEAD_PART * length);
  CagVec3 neck = cag_madd(p, 1 - head_length / length, v);
  CagValue parts[2];
  if (!cag_solid_result(call, cag_solid_rod(p, neck, radius, radius, &shaft, call->err), &shaft,
                        &parts[0]) ||
      !cag_solid_result(
          call, cag_solid_rod(neck, cag_add(p, v), HEAD_RADIUS * radius, 0, &head, call->err),
          &head, &parts[1]))
    return false;
  *result = cag_group_value(call->vm, cag_list_values(call->vm, parts, 2));
  return true;
}

bool cag_solids_arrow(CagCall *call, const struct cag_solids_arrow *a, CagValue *result) {
  const double radius = cag_given(call, 2) ? a->radius : SHAFT * cag_norm(a->V.at);
  return make_arrow(call, a->P.at, a->V.at, radius, result);
}

bool cag_solids_triad(CagCall *call, const struct cag_solids_triad *a, CagValue *result) {
  // The axes x, y, and z are red, green, and blue, in linear light.
  static const double colors[3][3] = {{0.7, 0.02, 0.02}, {0.03, 0.4, 0.03}, {0.02, 0.08, 0.7}};
  static const char *const names[] = {"color"};
  CagValue arrows[3];
  CagVec3 origin = cag_transform_point(&a->T, cag_vec3(0, 0, 0));
  for (int i = 0; i < 3; i++) {
    CagVec3 axis = cag_unit(cag_vec3(a->T.m[0][i], a->T.m[1][i], a->T.m[2][i]));
    if (cag_norm(axis) == 0)
      return cag_fail_call(call, 0, CAG_ERR_value, "expects a frame whose axes are not zero");
    if (!make_arrow(call, origin, cag_scaled(axis, a->size), SHAFT * a->size, &arrows[i]))
      return false;
    CagValue color = cag_vector(call->vm, colors[i], 3);
    CAG_AS_SHAPE(arrows[i])->material = CAG_AS_RECORD(cag_record_new(call->vm, names, &color, 1));
  }
  *result = cag_group_value(call->vm, cag_list_values(call->vm, arrows, 3));
  return true;
}
