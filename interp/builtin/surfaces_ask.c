// What surfaces answer at one place, and their data.

#include "interp/builtin/surfaces.h"

bool cag_arg_side(CagCall *call, int argument, CagSurface **out) {
  CagValue v = call->values[argument];
  if (v.type != CAG_SOLID) return cag_arg_surface(call, argument, out);
  *out = (CagSurface *)cag_solid_side(CAG_AS_SHAPE(v)->as.solid);
  return *out ||
         cag_fail_call(
             call, argument, CAG_ERR_type,
             "expects a surface, found a solid without u and v; only swept solids have them");
}

bool cag_arg_uv(CagCall *call, const CagSurface *s, int at, double *u, double *v) {
  return cag_arg_parameter(call, at, s->angular_u, s->u0, s->u1, false, u) &&
         cag_arg_parameter(call, at + 1, s->angular_v, s->v0, s->v1, false, v);
}

bool cag_arg_side_uv(CagCall *call, CagSurface **s, double *u, double *v) {
  return cag_arg_side(call, 0, s) && cag_arg_uv(call, *s, 1, u, v);
}

bool cag_surfaces_at(CagCall *call, CagValue *result) {
  CagSurface *s;
  CagVec3 p;
  double u, v;
  bool unit;
  if (!cag_arg_side(call, 0, &s) || !cag_arg_bool_or(call, 3, false, &unit) ||
      !cag_arg_parameter(call, 1, s->angular_u, s->u0, s->u1, unit, &u) ||
      !cag_arg_parameter(call, 2, s->angular_v, s->v0, s->v1, unit, &v) ||
      !cag_geometry_ok(call, cag_surface_point(s, u, v, &p, call->err)))
    return false;
  *result = cag_point(call->vm, p, 3);
  return true;
}

bool cag_surfaces_partial(CagCall *call, CagValue *result) {
  CagSurface *s;
  CagVec3 out[(CAG_MAX_PARTIAL + 1) * (CAG_MAX_PARTIAL + 1)];
  double u, v;
  long du, dv;
  if (!cag_arg_side_uv(call, &s, &u, &v) ||
      !cag_arg_integer_or(call, 3, 1, 0, CAG_MAX_PARTIAL, &du) ||
      !cag_arg_integer_or(call, 4, 0, 0, CAG_MAX_PARTIAL - du, &dv))
    return false;
  const int n = (int)(du + dv);
  CagSide side[2];
  if (!cag_arg_surface_sides(call, 5, side) ||
      !cag_geometry_ok(call, cag_surface_eval(s, u, v, n, side[0], side[1], out, call->err)))
    return false;
  *result = cag_point(call->vm, out[cag_partial(n, (int)du, (int)dv)], 3);
  return true;
}

bool cag_surfaces_normal(CagCall *call, CagValue *result) {
  CagSurface *s;
  CagVec3 n;
  double u, v;
  if (!cag_arg_side_uv(call, &s, &u, &v) ||
      !cag_geometry_ok(call, cag_surface_normal(s, u, v, &n, call->err)))
    return false;
  *result = cag_point(call->vm, n, 3);
  return true;
}

bool cag_surfaces_tangent_plane(CagCall *call, CagValue *result) {
  CagSurface *s;
  CagPlane plane;
  double u, v;
  if (!cag_arg_side_uv(call, &s, &u, &v) ||
      !cag_geometry_ok(call, cag_surface_point(s, u, v, &plane.point, call->err)) ||
      !cag_geometry_ok(call, cag_surface_normal(s, u, v, &plane.normal, call->err)))
    return false;
  *result = cag_plane_value(call->vm, &plane);
  return true;
}

bool cag_surfaces_domain(CagCall *call, CagValue *result) {
  CagSurface *s;
  if (!cag_arg_side(call, 0, &s)) return false;
  *result = cag_uv_value(call->vm, cag_domain_value(call->vm, s->angular_u, s->u0, s->u1),
                         cag_domain_value(call->vm, s->angular_v, s->v0, s->v1));
  return true;
}

bool cag_surface_net(CagCall *call, const CagSurface *s, const char *what,
                     CagSurfaceNurbsView *net) {
  return cag_surface_nurbs_view(s, net) ||
         cag_geometry_ok(
             call,
             cag_fail(
                 call->err, CAG_E_UNSUPPORTED, CAG_ERR_no_control_points, "", -1,
                 "a surface of kind %s has no %s; `to_nurbs` returns its rational form if there is one",
                 s->kind->name, what));
}

bool cag_surfaces_degree(CagCall *call, const struct cag_surfaces_degree *a, CagValue *result) {
  CagSurfaceNurbsView net;
  if (!cag_surface_net(call, a->S, "degree", &net)) return false;
  *result = cag_vector(call->vm, (double[]){net.degree_u, net.degree_v}, 2);
  return true;
}

bool cag_surfaces_knots(CagCall *call, const struct cag_surfaces_knots *a, CagValue *result) {
  CagSurfaceNurbsView net;
  if (!cag_surface_net(call, a->S, "knots", &net)) return false;
  CagValue values[] = {cag_numbers_value(call->vm, net.knots_u, net.nu + (size_t)net.degree_u + 1),
                       cag_numbers_value(call->vm, net.knots_v, net.nv + (size_t)net.degree_v + 1)};
  *result = cag_list_values(call->vm, values, 2);
  return true;
}

// The net by rows of u: points, or weights where `dim` is 1.
static bool give_net(CagCall *call, const CagSurfaceNurbsView *net, size_t dim, CagValue *result) {
  CagBuilder *rows = cag_builder_new(call->vm);
  for (size_t i = 0; i < net->distinct_u; i++) {
    double *out;
    CagValue row = dim == 1 ? cag_list_numbers(call->vm, net->distinct_v, &out)
                            : cag_list_vectors(call->vm, net->distinct_v, dim, &out);
    for (size_t j = 0; j < net->distinct_v; j++) {
      const double *h = net->homogeneous + 4 * (i * net->nv + j);
      if (dim == 1) *out++ = h[3];
      else
        for (size_t k = 0; k < dim; k++) *out++ = h[k] / h[3];
    }
    if (!cag_builder_add(call->vm, rows, row)) return false;
  }
  *result = cag_builder_finish(call->vm, rows);
  return true;
}

bool cag_surfaces_points(CagCall *call, const struct cag_surfaces_points *a, CagValue *result) {
  CagSurfaceNurbsView net;
  return cag_surface_net(call, a->S, "control points", &net) && give_net(call, &net, 3, result);
}

bool cag_surfaces_weights(CagCall *call, const struct cag_surfaces_weights *a, CagValue *result) {
  CagSurfaceNurbsView net;
  return cag_surface_net(call, a->S, "weights", &net) && give_net(call, &net, 1, result);
}

bool cag_surfaces_is_closed(CagCall *call, const struct cag_surfaces_is_closed *a,
                            CagValue *result) {
  (void)call;
  *result = cag_bool(cag_surface_is_closed(a->S));
  return true;
}

bool cag_surfaces_closed_in(CagCall *call, const struct cag_surfaces_closed_in *a,
                            CagValue *result) {
  *result = cag_uv_value(call->vm, cag_bool(a->S->closed_u), cag_bool(a->S->closed_v));
  return true;
}
