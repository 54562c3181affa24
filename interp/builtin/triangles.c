// Triangular Bezier surfaces in barycentric coordinates; the surface itself is made by
// bezier_triangle.

#include "geom/surface/triangle.h"
#include "interp/builtin/surfaces.h"

static CagValue net_value(CagVm *vm, const CagVec3 *net, int degree) {
  CagBuilder *rows = cag_builder_new(vm);
  for (int row = 0; row <= degree; row++) {
    cag_builder_add(vm, rows, cag_points_value(vm, net, (size_t)row + 1, 3));
    net += row + 1;
  }
  return cag_builder_finish(vm, rows);
}

// The net, and the coordinates W.
static bool read_place(CagCall *call, CagVec3 **net, int *degree, const double **w) {
  size_t n;
  if (!cag_arg_numbers(call, 1, w, &n)) return false;
  if (n != 3)
    return cag_fail_call(call, 1, CAG_ERR_length, "expects 3 barycentric coordinates, found %zu",
                         n);
  return cag_arg_triangle(call, 0, net, degree);
}

bool cag_triangles_triangle_point(CagCall *call, CagValue *result) {
  static const char *const names[] = {"point", "ds", "dt", "normal"};
  CagVec3 *net = NULL;
  int degree = 0;
  const double *w;
  CagTriangleJet jet = {0};
  if (!read_place(call, &net, &degree, &w)) return false;
  if (!cag_geometry_ok(call, cag_triangle_at(net, degree, w, &jet, call->err))) return false;
  CagVec3 normal = cag_unit(cag_cross(jet.ds, jet.dt));
  CagValue values[] = {cag_point(call->vm, jet.point, 3), cag_point(call->vm, jet.ds, 3),
                       cag_point(call->vm, jet.dt, 3),
                       cag_norm(normal) > 0 ? cag_point(call->vm, normal, 3) : cag_none()};
  *result = cag_record_new(call->vm, names, values, 4);
  return true;
}

bool cag_triangles_triangle_elevate(CagCall *call, const struct cag_triangles_triangle_elevate *a,
                                    CagValue *result) {
  CagVec3 *net = NULL;
  int degree = 0;
  if (!cag_arg_triangle(call, 0, &net, &degree)) return false;
  if (degree + a->times >= CAG_TRIANGLE_ROWS)
    return cag_fail_call(call, 1, CAG_ERR_value,
                         "raises the degree to at most %d, found degree %d and `times` %ld",
                         CAG_TRIANGLE_ROWS - 1, degree, a->times);
  for (long i = 0; i < a->times; i++) {
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
  const double *w;
  if (!read_place(call, &net, &degree, &w)) return false;
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
