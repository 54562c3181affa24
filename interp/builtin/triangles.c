// Triangular Bezier surfaces in barycentric coordinates; the surface itself is made by
// bezier_triangle.

#include "geom/surface/triangle.h"
#include "interp/builtin/surfaces.h"

static const char triangles[] = "Surfaces: control nets";

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

static bool triangle_point(CagCall *call, CagValue *result) {
  static const char *const names[] = {"point", "ds", "dt", "normal"};
  CagVec3 *net = NULL;
  int degree = 0;
  double w[3];
  CagTriangleJet jet = {0};
  CagError err;
  if (!read_coordinates(call, 1, w) || !cag_arg_triangle(call, 0, &net, &degree)) return false;
  cag_hold(call, net);
  if (!cag_geometry_ok(call, cag_triangle_at(net, degree, w, &jet, &err), &err)) return false;
  CagVec3 normal = cag_unit(cag_cross(jet.ds, jet.dt));
  CagValue values[] = {vector_value(call->vm, jet.point), vector_value(call->vm, jet.ds),
                       vector_value(call->vm, jet.dt),
                       cag_norm(normal) > 0 ? vector_value(call->vm, normal) : cag_none()};
  *result = cag_record_new(call->vm, names, values, 4);
  return true;
}

static bool triangle_elevate(CagCall *call, CagValue *result) {
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

static bool triangle_split(CagCall *call, CagValue *result) {
  CagVec3 *net = NULL;
  int degree = 0;
  double w[3];
  CagError err;
  if (!read_coordinates(call, 1, w) || !cag_arg_triangle(call, 0, &net, &degree)) return false;
  cag_hold(call, net);
  size_t n = cag_triangle_count(degree);
  CagVec3 *parts = cag_hold_array(call, 3 * n, sizeof *parts);
  CagStatus status =
      cag_triangle_split(net, degree, w, (CagVec3 *const[]){parts, parts + n, parts + 2 * n}, &err);
  if (!cag_geometry_ok(call, status, &err)) return false;
  CagValue nets[3];
  for (size_t c = 0; c < 3; c++) nets[c] = net_value(call->vm, parts + c * n, degree);
  *result = cag_list_values(call->vm, nets, 3);
  return true;
}

const CagBuiltin cag_builtins_triangles[] = {
    {"triangle_point(net: list of rows of points, W: list of 3 numbers)", triangle_point, "record",
     "Evaluates the triangular Bezier surface of a net, as bezier_triangle takes it, at the "
     "barycentric coordinates [u, v, w]: point, the derivatives ds and dt along [1, 0, -1] and "
     "[0, 1, -1], and the unit normal (none if it is undefined). The first row of the net is the "
     "corner u = 1; the last runs from v = 1 to w = 1. Coordinates that are negative, or whose "
     "sum is not 1 (to 1e-9), are an error (parameter-range).",
     "net = [[[2, 0, 0]], [[1, 1, 1], [1, 0, 1]], [[0, 2, 0], [0, 1, 2], [0, 0, 0]]]\n"
     "print triangle_point(net, [0.5, 0.25, 0.25]).point // expect: [1, 0.5, 0.75]",
     CAG_TAKES_LISTS, triangles},
    {"triangle_elevate(net: list of rows of points, times: integer = 1)", triangle_elevate, "list",
     "Returns the net of the same triangular Bezier surface with a higher degree.",
     "print triangle_elevate([[[2, 0, 0]], [[0, 2, 0], [0, 0, 4]]])[1] // expect: [[1, 1, 0], [1, "
     "0, 2]]",
     CAG_TAKES_LISTS, triangles},
    {"triangle_split(net: list of rows of points, W: list of 3 numbers)", triangle_split, "list",
     "Returns the nets of the three triangular Bezier surfaces between a point, given by its "
     "barycentric coordinates, and each pair of corners of a net. In the first net, the point "
     "replaces the first corner, and so on. If the point is on an edge, one of them has no area.",
     "parts = triangle_split([[[2, 0, 0]], [[0, 2, 0], [0, 0, 4]]], [0.5, 0.25, 0.25])\n"
     "print parts[0][0] // expect: [[1, 0.5, 1]]",
     CAG_TAKES_LISTS, triangles},
    {0}};
