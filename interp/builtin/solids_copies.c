// Copies of shapes as groups: around an axis, in a row, mirrored.

#include "interp/builtin/solids.h"

// Most copies that one call makes.
#define COPIES_MAX 10000000

static bool add_moved(CagCall *call, CagBuilder *copies, const CagTransform *t) {
  CagValue moved;
  return cag_transform_apply(call->vm, t, call->values[0], &moved) &&
         cag_shapes_collect(call, moved, copies);
}

static bool give_group(CagCall *call, CagBuilder *copies, CagValue *result) {
  *result = cag_group_value(call->vm, cag_builder_finish(call->vm, copies));
  return true;
}

bool cag_solids_around(CagCall *call, CagValue *result) {
  long n;
  CagVec3 axis, through;
  if (!cag_arg_integer(call, 1, 1, COPIES_MAX, &n) ||
      !cag_arg_direction(call, 2, cag_vec3(0, 0, 1), &axis, NULL) ||
      !cag_arg_vec_or(call, 3, cag_vec3(0, 0, 0), &through, NULL))
    return false;
  CagBuilder *copies = cag_builder_new(call->vm);
  bool plane = axis.x == 0 && axis.y == 0 && through.z == 0;
  for (long i = 0; i < n; i++) {
    // Whole degrees where there are, so that quarter turns are exact.
    double angle = 360.0 * (double)i / (double)n * CAG_RADIANS_PER_DEGREE;
    CagTransform t;
    if (i % CAG_LOOK_UP == 0 && !cag_keep_going(call->vm)) return false;
    if (!cag_geometry_ok(call, cag_rotate(axis, angle, through, &t, call->err))) return false;
    t.planar = plane;
    if (!add_moved(call, copies, &t)) return false;
  }
  return give_group(call, copies, result);
}

bool cag_solids_rows(CagCall *call, CagValue *result) {
  long n;
  CagVec3 step;
  int dimension;
  if (!cag_arg_integer(call, 1, 1, COPIES_MAX, &n) || !cag_arg_vec(call, 2, &step, &dimension))
    return false;
  CagBuilder *copies = cag_builder_new(call->vm);
  for (long i = 0; i < n; i++) {
    CagTransform t = cag_translate(cag_scaled(step, (double)i));
    if (i % CAG_LOOK_UP == 0 && !cag_keep_going(call->vm)) return false;
    t.planar = dimension == 2;
    if (!add_moved(call, copies, &t)) return false;
  }
  return give_group(call, copies, result);
}

bool cag_solids_mirrored(CagCall *call, CagValue *result) {
  CagPlane plane;
  CagTransform t;
  if (!cag_arg_plane(call, 1, &plane) ||
      !cag_geometry_ok(call, cag_reflect(plane.normal, plane.point, &t, call->err)))
    return false;
  t.planar = false;
  CagBuilder *copies = cag_builder_new(call->vm);
  if (!cag_shapes_collect(call, call->values[0], copies) || !add_moved(call, copies, &t))
    return false;
  return give_group(call, copies, result);
}
