// Groups of copies: around an axis, in a row, and mirrored.

#include "interp/builtin/solids.h"

static bool add_moved(CagCall *call, CagBuilder *copies, const CagTransform *t) {
  CagValue moved;
  return cag_transform_apply(call->vm, t, call->values[0], &moved) &&
         cag_shapes_collect(call, moved, copies);
}

bool cag_group_result(CagCall *call, CagBuilder *shapes, CagValue *result) {
  *result = cag_group_value(call->vm, cag_builder_finish(call->vm, shapes));
  return true;
}

bool cag_shapes_result(CagCall *call, CagBuilder *shapes, CagValue *result) {
  const CagValue list = cag_builder_finish(call->vm, shapes);
  const bool single = CAG_AS_LIST(list)->length == 1;
  *result = single ? cag_list_get(call->vm, CAG_AS_LIST(list), 0) : cag_group_value(call->vm, list);
  return true;
}

bool cag_solids_around(CagCall *call, const struct cag_solids_around *a, CagValue *result) {
  const CagVec3 axis = a->axis.at, through = a->through.at;
  CagBuilder *copies = cag_builder_new(call->vm);
  bool plane = axis.x == 0 && axis.y == 0 && through.z == 0;
  for (long i = 0; i < a->n; i++) {
    // In degrees, so that quarter turns are exact.
    double angle = 360.0 * (double)i / (double)a->n * CAG_RADIANS_PER_DEGREE;
    CagTransform t;
    if (i % CAG_LOOK_UP == 0 && !cag_keep_going(call->vm)) return false;
    if (!cag_geometry_ok(call, cag_rotate(axis, angle, through, &t, call->err))) return false;
    t.planar = plane;
    if (!add_moved(call, copies, &t)) return false;
  }
  return cag_group_result(call, copies, result);
}

bool cag_solids_rows(CagCall *call, const struct cag_solids_rows *a, CagValue *result) {
  CagBuilder *copies = cag_builder_new(call->vm);
  for (long i = 0; i < a->n; i++) {
    CagTransform t = cag_translate(cag_scaled(a->V.at, (double)i));
    if (i % CAG_LOOK_UP == 0 && !cag_keep_going(call->vm)) return false;
    t.planar = a->V.dimension == 2;
    if (!add_moved(call, copies, &t)) return false;
  }
  return cag_group_result(call, copies, result);
}

bool cag_solids_mirrored(CagCall *call, const struct cag_solids_mirrored *a, CagValue *result) {
  CagTransform t;
  if (!cag_geometry_ok(call, cag_reflect(a->plane.normal, a->plane.point, &t, call->err)))
    return false;
  t.planar = false;
  CagBuilder *copies = cag_builder_new(call->vm);
  return cag_shapes_collect(call, call->values[0], copies) && add_moved(call, copies, &t) &&
         cag_group_result(call, copies, result);
}
