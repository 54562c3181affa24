// Workspaces as values, and chains from the axes of joints.

#include <string.h>

#include "base/memory.h"
#include "geom/mesh/hull.h"
#include "geom/robot/dh.h"
#include "geom/robot/workspace.h"
#include "interp/builtin/robots.h"
#include "interp/builtin/support.h"

// --- Workspace ---

// Size of a dot of the cloud as a part of the cloud's.
#define DOT 0.004
// Points are in a plane when their heights differ by less than this part of the cloud.
#define FLAT 1e-9

// A small octahedron at each point: the cloud as one mesh to show.
static bool cloud_value(CagCall *call, const CagVec3 *points, size_t n, double radius,
                        CagValue *out) {
  static const double corners[6][3] = {{1, 0, 0},  {0, 1, 0}, {-1, 0, 0},
                                       {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  static const uint32_t faces[8][3] = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4},
                                       {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}};
  CagMesh *m = NULL;
  CagVec3 *vertices = cag_hold(call, cag_malloc(6 * n * sizeof *vertices));
  uint32_t *counts = cag_hold(call, cag_malloc(8 * n * sizeof *counts));
  uint32_t *indices = cag_hold(call, cag_malloc(24 * n * sizeof *indices));
  for (size_t i = 0; i < n; i++) {
    for (size_t k = 0; k < 6; k++)
      vertices[6 * i + k] =
          cag_madd(points[i], radius, cag_vec3(corners[k][0], corners[k][1], corners[k][2]));
    for (size_t k = 0; k < 8; k++) {
      counts[8 * i + k] = 3;
      for (size_t j = 0; j < 3; j++) indices[24 * i + 3 * k + j] = (uint32_t)(6 * i) + faces[k][j];
    }
  }
  const CagStatus status =
      cag_mesh_from_faces(vertices, 6 * n, indices, counts, 8 * n, &m, call->err);
  cag_release_held(call, indices);
  cag_release_held(call, counts);
  cag_release_held(call, vertices);
  return cag_mesh_result(call, status, &m, out);
}

static CagBounds bounds_of(const CagVec3 *points, size_t n) {
  CagBounds b = CAG_BOUNDS_EMPTY;
  for (size_t i = 0; i < n; i++) cag_bounds_add(&b, points[i]);
  return b;
}

// The hull as a mesh, of points at one height as a region there; none where it has no inside.
static bool hull_value(CagCall *call, const CagVec3 *points, size_t n, const CagBounds *b,
                       CagValue *out) {
  CagMesh *m = NULL;
  size_t *ring = NULL, count = 0;
  *out = cag_none();
  double size = cag_norm(cag_sub(b->max, b->min));
  if (b->max.z - b->min.z > FLAT * size) {
    CagStatus status = cag_hull_space(points, n, &m, call->err);
    if (!status) *out = cag_mesh_value(call->vm, m);
    return status != CAG_E_MEMORY || cag_fail_geometry(call, call->err);
  }
  CagStatus status = cag_hull_plane(points, n, &ring, &count, call->err);
  if (status) return status != CAG_E_MEMORY || cag_fail_geometry(call, call->err);
  cag_hold_for(call, cag_free, ring);
  CagVec3 *corners = cag_hold_array(call, count, sizeof *corners);
  CagCurve *loop = NULL;
  CagRegion *region = NULL;
  for (size_t i = 0; i < count; i++) corners[i] = cag_vec3(points[ring[i]].x, points[ring[i]].y, 0);
  status = cag_curve_polyline(corners, count, true, 2, &loop, call->err);
  if (!status) status = cag_region_new(loop, NULL, 0, &region, call->err);
  cag_curve_release(loop);
  if (!cag_geometry_ok(call, status)) return false;
  CagTransform place = cag_translate(cag_vec3(0, 0, b->min.z));
  *out = cag_region_value(call->vm, region, &place);
  return true;
}

static CagValue number_or_none(bool known, double x) { return known ? cag_number(x) : cag_none(); }

static bool give_workspace(CagCall *call, const CagRobot *r, const CagVec3 *points, size_t n,
                           CagValue *result) {
  static const char *const names[] = {"kind",   "of",    "points", "hull", "cloud", "bounds",
                                      "center", "r_min", "r_max",  "hole", "volume"};
  static const char *const kinds[] = {"cartesian", "cylindrical", "spherical",   "spherical-offset",
                                      "planar",    "scara",       "articulated", "other"};
  CagWorkspace w;
  CagValue hull, cloud;
  cag_robot_workspace(r, &w);
  CagBounds seen = bounds_of(points, n), b = w.bounds.min.x <= w.bounds.max.x ? w.bounds : seen;
  double size = cag_norm(cag_sub(seen.max, seen.min));
  if (!hull_value(call, points, n, &seen, &hull) ||
      !cloud_value(call, points, n, DOT * (size > 0 ? size : 1), &cloud))
    return false;
  bool known = w.kind != CAG_WORKSPACE_OTHER;
  CagVm *vm = call->vm;
  CagValue values[] = {cag_text_c(vm, kinds[w.kind]),
                       cag_text_c(vm, w.of_wrist ? "wrist" : "tool"),
                       cag_points_value(vm, points, n, 3),
                       hull,
                       cloud,
                       cag_bounds_value(vm, &b, 3),
                       known ? cag_point(vm, w.center, 3) : cag_none(),
                       number_or_none(known, w.r_min),
                       number_or_none(known, w.r_max),
                       number_or_none(known, w.hole),
                       number_or_none(w.exact, w.volume)};
  *result = cag_record_new(vm, names, values, 11);
  return true;
}

// robot, n
bool cag_robots_workspace(CagCall *call, const struct cag_robots_workspace *a, CagValue *result) {
  CagVec3 *points = cag_hold(call, cag_malloc((size_t)a->n * sizeof *points));
  for (size_t k = 0; k < (size_t)a->n; k++) {
    double q[CAG_ROBOT_JOINTS_MAX];
    CagTransform t;
    cag_robot_workspace_sample(a->robot, k, (size_t)a->n, q);
    cag_robot_forward(a->robot, q, &t);
    points[k] = cag_vec3(t.m[0][3], t.m[1][3], t.m[2][3]);
    if (!cag_keep_going(call->vm)) return false;
  }
  return give_workspace(call, a->robot, points, (size_t)a->n, result);
}

// --- Frames for joint axes ---

static bool read_field_point(CagCall *call, int argument, const CagRecord *record, size_t index,
                             const char *name, CagVec3 *out) {
  const double *x;
  size_t n;
  CagValue v = cag_record_get(record, name);
  if (!cag_as_vector(v, &x, &n) || n != 3 || !isfinite(x[0]) || !isfinite(x[1]) || !isfinite(x[2]))
    return cag_fail_call(
        call, argument, CAG_ERR_type,
        "expects records with kind, point, and direction as axes; `%s` of [%zu] is not a point in space",
        name, index);
  *out = cag_vec3(x[0], x[1], x[2]);
  return true;
}

static bool read_axis(CagCall *call, int argument, CagValue v, size_t index, CagJointAxis *out) {
  if (v.type != CAG_RECORD)
    return cag_fail_element(call, argument, index, v, "records with kind, point, and direction");
  const CagRecord *record = CAG_AS_RECORD(v);
  CagValue kind = cag_record_get(record, "kind");
  const char *name = kind.type == CAG_TEXT    ? CAG_AS_TEXT(kind)->bytes
                     : kind.type == CAG_UNSET ? "revolute"
                                              : "";
  out->kind = strcmp(name, "prismatic") == 0 ? CAG_JOINT_PRISMATIC : CAG_JOINT_REVOLUTE;
  if (strcmp(name, cag_joint_kinds[out->kind]) != 0)
    return cag_fail_call(call, argument, CAG_ERR_value,
                         "expects \"revolute\" or \"prismatic\" as the kind of axes [%zu]", index);
  return read_field_point(call, argument, record, index, "point", &out->point) &&
         read_field_point(call, argument, record, index, "direction", &out->direction);
}

// A frame on the first axis: its origin at the axis' point, x as near to the world's as may be.
static bool default_base(CagCall *call, const CagJointAxis *axis, CagTransform *out) {
  CagVec3 z = cag_unit(axis->direction);
  const double nearly_x = 0.999999;
  CagVec3 x = fabs(z.x) < nearly_x ? cag_vec3(1, 0, 0) : cag_vec3(0, 1, 0);
  CagVec3 square = cag_madd(x, -cag_dot(x, z), z);
  return cag_geometry_ok(call, cag_axes(axis->point, square, cag_cross(z, square), out, call->err));
}

static bool give_assignment(CagCall *call, const CagRobotLink *links, const CagTransform *frames,
                            size_t n, CagValue *result) {
  static const char *const names[] = {"table", "frames"};
  static const char *const columns[] = {"kind", "theta", "d", "a", "alpha"};
  CagVm *vm = call->vm;
  CagBuilder *rows = cag_builder_new(vm), *places = cag_builder_new(vm);
  for (size_t i = 0; i <= n; i++) {
    if (!cag_builder_add(vm, places, cag_transform_value(vm, &frames[i]))) return false;
    if (i == n) break;
    const CagRobotLink *l = &links[i];
    CagValue row[] = {cag_text_c(vm, cag_joint_kinds[l->kind]),
                      cag_angle(cag_degrees_shown(l->theta)), cag_number(l->d), cag_number(l->a),
                      cag_angle(cag_degrees_shown(l->alpha))};
    if (!cag_builder_add(vm, rows, cag_record_new(vm, columns, row, 5))) return false;
  }
  CagValue values[] = {cag_builder_finish(vm, rows), cag_builder_finish(vm, places)};
  *result = cag_record_new(vm, names, values, 2);
  return true;
}

// axes, end, base
bool cag_robots_dh_assign(CagCall *call, CagValue *result) {
  CagList *list = NULL;
  CagJointAxis end;
  CagTransform base;
  if (!cag_arg_list(call, 0, &list)) return false;
  if (list->length == 0)
    return cag_fail_call(call, 0, CAG_ERR_empty_chain, "expects the axis of at least one joint");
  size_t n = list->length;
  CagJointAxis *axes = cag_hold_array(call, n, sizeof *axes);
  CagRobotLink *links = cag_hold_array(call, n, sizeof *links);
  CagTransform *frames = cag_hold_array(call, n + 1, sizeof *frames);
  for (size_t i = 0; i < n; i++)
    if (!read_axis(call, 0, cag_list_get(call->vm, list, i), i, &axes[i])) return false;
  if (!read_axis(call, 1, call->values[1], 0, &end)) return false;
  const bool based = cag_given(call, 2);
  if (!(based ? cag_arg_pose(call, 2, &base) : default_base(call, &axes[0], &base))) return false;
  const CagStatus status = cag_robot_dh_assign(&base, axes, n, &end, links, frames, call->err);
  return cag_geometry_ok(call, status) && give_assignment(call, links, frames, n, result);
}
