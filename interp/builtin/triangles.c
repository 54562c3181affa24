// Triangular Bezier surfaces in barycentric coordinates; the surface itself is made by
// bezier_triangle.

#include "geom/surface/triangle.h"
#include "interp/builtin/surfaces.h"

static CagValue vector_value(CagVm *vm, CagVec3 p) {
  return cag_vector(vm, (double[]){p.x, p.y, p.z}, 3);
}

static CagValue net_value(CagVm *vm, const CagVec3 *net, int degree) {
  CagBuilder *rows = cag_builder_new(vm);
  for (int row = 0; row <= degree; row++) {
    cag_builder_add(vm, rows, cag_points_value(vm, net, (size_t)row + 1, 3));
    net += row + 1;
  }
  return cag_builder_finish(vm, rows);
}

static bool read_coordinates(CagCall *call, int argument, double out[3]) {
  const double *w;
  size_t n;
  if (!cag_arg_numbers(call, argument, &w, &n)) return false;
  if (n != 3)
    return cag_fail_call(call, argument, CAG_ERR_length,
                         "expects 3 barycentric coordinates, found %zu", n);
  for (int c = 0; c < 3; c++) out[c] = w[c];
  return true;
}

bool cag_triangles_triangle_point(CagCall *call, CagValue *result) {
  static const char *const names[] = {"point", "ds", "dt", "normal"};
  CagVec3 *net = NULL;
  int degree = 0;
  double w[3];
  CagTriangleJet jet = {0};
  if (!read_coordinates(call, 1, w) || !cag_arg_triangle(call, 0, &net, &degree)) return false;
  cag_hold(call, net);
  if (!cag_geometry_ok(call, cag_triangle_at(net, degree, w, &jet, call->err))) return false;
  CagVec3 normal = cag_unit(cag_cross(jet.ds, jet.dt));
  CagValue values[] = {vector_value(call->vm, jet.point), vector_value(call->vm, jet.ds),
                       vector_value(call->vm, jet.dt),
                       cag_norm(normal) > 0 ? vector_value(call->vm, normal) : cag_none()};
  *result = cag_record_new(call->vm, names, values, 4);
  return true;
}

bool cag_triangles_triangle_elevate(CagCall *call, CagValue *result) {
  CagVec3 *net = NULL;
  int degree = 0;
  long times;
  if (!cag_arg_integer_or(call, 1, 1, 0, CAG_TRIANGLE_ROWS, &times) ||
      !cag_arg_triangle(call, 0, &net, &degree))
    return false;
  cag_hold(call, net);
  if (degree + times >= CAG_TRIANGLE_ROWS)
    return cag_fail_call(call, 1, CAG_ERR_value, "raises a degree to %d at most, found %d and %ld",
                         CAG_TRIANGLE_ROWS - 1, degree, times);
  for (; times > 0; times--) {
    CagVec3 *raised = cag_hold_array(call, cag_triangle_count(degree + 1), sizeof *raised);
    cag_triangle_elevate(net, degree++, raised);
    cag_release_held(call, net);
    net = raised;
    if (!cag_keep_going(call->vm)) return false;
  }
  *result = net_value(call->vm, net, degree);
  return true;
}

bool cag_triangles_triangle_split(CagCall *call, CagValue *result) {
  CagVec3 *net = NULL;
  int degree = 0;
  double w[3];
  if (!read_coordinates(call, 1, w) || !cag_arg_triangle(call, 0, &net, &degree)) return false;
  cag_hold(call, net);
  size_t n = cag_triangle_count(degree);
  CagVec3 *parts = cag_hold_array(call, 3 * n, sizeof *parts);
  CagStatus status = cag_triangle_split(
      net, degree, w, (CagVec3 *const[]){parts, parts + n, parts + 2 * n}, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  CagValue nets[3];
  for (size_t c = 0; c < 3; c++) nets[c] = net_value(call->vm, parts + c * n, degree);
  *result = cag_list_values(call->vm, nets, 3);
  return true;
}
