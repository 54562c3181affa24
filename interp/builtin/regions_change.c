// Regions made from others and from curves: offsets, strokes, sums, and simplification.

#include "geom/curve/minkowski.h"
#include "geom/curve/region_stroke.h"
#include "geom/curve/simplify.h"
#include "interp/builtin/curves.h"
#include "interp/builtin/holds.h"
#include "interp/builtin/regions.h"

// The default tolerance, as a fraction of the size.
#define TOLERANCE 1e-6

static double size_of(const CagBounds *box) {
  return box->max.x < box->min.x ? 1 : cag_norm(cag_sub(box->max, box->min));
}

// Adds the bounds of a region, if it is not empty.
static bool add_bounds(CagCall *call, const CagRegion *r, CagBounds *box) {
  CagBounds one;
  if (cag_region_is_empty(r)) return true;
  if (!cag_geometry_ok(call, cag_region_bounds(r, &one, call->err))) return false;
  cag_bounds_add(box, one.min);
  cag_bounds_add(box, one.max);
  return true;
}

// The tolerance of an argument, or the default.
static bool read_tolerance(CagCall *call, int argument, double given, double size, double *out) {
  *out = cag_given(call, argument) ? given : TOLERANCE * size;
  return *out > 0 ||
         cag_fail_call(call, argument, CAG_ERR_value, "expects a tolerance greater than 0");
}

bool cag_regions_offset(CagCall *call, const struct cag_regions_offset *a, CagValue *result) {
  const CagShape *shape = CAG_AS_SHAPE(a->R);
  const CagJoins joins = {(CagJoin)a->join, a->miter_limit};
  CagBounds box = CAG_BOUNDS_EMPTY;
  CagRegion *out = NULL;
  double tolerance;
  if (!add_bounds(call, shape->as.region, &box) ||
      !read_tolerance(call, 2, a->tolerance, size_of(&box), &tolerance))
    return false;
  CagStatus status =
      cag_region_offset_joined(shape->as.region, a->d, tolerance, &joins, &out, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  *result = cag_region_value(call->vm, out, shape->placement);
  cag_shape_say_alike(*result, a->R);
  return true;
}

// Reads a curve, or a list or group of curves; they are held.
static bool read_curves(CagCall *call, CagCurve ***out, size_t *n) {
  CagBuilder *builder = cag_builder_new(call->vm);
  if (!cag_shapes_collect(call, call->values[0], builder)) return false;
  const CagList *shapes = CAG_AS_LIST(cag_builder_finish(call->vm, builder));
  *n = shapes->length;
  *out = cag_hold_curve_array(call, *n);
  for (size_t i = 0; i < *n; i++) {
    const CagValue v = cag_list_get(call->vm, shapes, i);
    if (v.type != CAG_CURVE)
      return cag_fail_call(call, 0, CAG_ERR_type, "expects curves, found %s", cag_type_article(v));
    (*out)[i] = cag_curve_retain(CAG_AS_SHAPE(v)->as.curve);
  }
  return true;
}

bool cag_regions_stroke(CagCall *call, const struct cag_regions_stroke *a, CagValue *result) {
  CagStroke stroke = {
      .width = a->width, .cap = (CagCap)a->cap, .joins = {(CagJoin)a->join, a->miter_limit}};
  CagTransform frame;
  CagCurve **curves;
  CagRegion *out = NULL;
  CagBounds box = CAG_BOUNDS_EMPTY;
  bool in_space;
  size_t n;
  if (!read_curves(call, &curves, &n) ||
      !cag_region_loops_plane(call, curves, n, &frame, &in_space))
    return false;
  for (size_t i = 0; i < n; i++) {
    const CagBounds one = curves[i]->kind->hull(curves[i], curves[i]->start, curves[i]->end);
    cag_bounds_add(&box, one.min);
    cag_bounds_add(&box, one.max);
  }
  const double size = (n > 0 ? size_of(&box) : 0) + a->width;
  if (!read_tolerance(call, 5, a->tolerance, size, &stroke.tolerance)) return false;
  CagStatus status =
      cag_region_stroke((const CagCurve *const *)curves, n, &stroke, &out, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  *result = cag_region_value(call->vm, out, in_space ? &frame : NULL);
  if (call->values[0].type == CAG_CURVE) cag_shape_say_alike(*result, call->values[0]);
  return true;
}

bool cag_regions_minkowski(CagCall *call, CagValue *result) {
  CagRegion **pair, *out = NULL;
  CagTransform plane;
  CagBounds box = CAG_BOUNDS_EMPTY, other = CAG_BOUNDS_EMPTY;
  if (!cag_regions_read_pair(call, &pair, &plane) || !add_bounds(call, pair[0], &box) ||
      !add_bounds(call, pair[1], &other))
    return false;
  CagStatus status = cag_region_minkowski(
      pair[0], pair[1], TOLERANCE * fmax(size_of(&box), size_of(&other)), &out, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  *result = cag_region_value(call->vm, out, &plane);
  if (cag_is_shape(call->values[0])) cag_shape_say_alike(*result, call->values[0]);
  return true;
}

bool cag_curves_simplify(CagCall *call, const struct cag_curves_simplify *a, CagValue *result) {
  CagCurve *out = NULL;
  CagStatus status = cag_curve_simplify(a->C, a->tolerance, &out, call->err);
  return cag_changed_curve_result(call, status, &out, result);
}

bool cag_regions_simplify(CagCall *call, const struct cag_regions_simplify *a, CagValue *result) {
  const CagShape *shape = CAG_AS_SHAPE(a->R);
  CagRegion *out = NULL;
  CagStatus status = cag_region_simplify(shape->as.region, a->tolerance, &out, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  *result = cag_region_value(call->vm, out, shape->placement);
  cag_shape_say_alike(*result, a->R);
  return true;
}
