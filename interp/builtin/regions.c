// Regions: pieces of the plane.

#include <stdlib.h>

#include "interp/builtin/curves.h"

// `made` is read after the call that fills it: pass its address.
static bool give(CagCall *call, CagStatus status, const CagError *err, CagRegion **made,
                 CagValue *result) {
  if (!cag_geometry_ok(call, status, err)) return false;
  *result = cag_region_value(call->vm, *made, NULL);
  return true;
}

// A closed plane curve from a curve or a list of points; *out has one reference. `argument` is
// where it was given.
static bool read_loop(CagCall *call, int argument, CagValue v, CagCurve **out) {
  CagError err;
  if (v.type == CAG_CURVE) {
    *out = cag_curve_retain(CAG_AS_SHAPE(v)->as.curve);
    return true;
  }
  if (v.type != CAG_LIST)
    return cag_fail_call(call, argument, CAG_ERR_type,
                         "expects closed plane curves or lists of points, found %s",
                         cag_type_article(v));
  // The list is read as if it were the argument itself.
  CagValue kept = call->values[argument];
  CagVec3 *points;
  size_t n;
  int dimension;
  call->values[argument] = v;
  bool ok = cag_arg_points(call, argument, &points, &n, &dimension);
  call->values[argument] = kept;
  if (!ok) return false;
  ok = cag_geometry_ok(call, cag_curve_polyline(points, n, true, dimension, out, &err), &err);
  free(points);
  return ok;
}

bool cag_curves_region(CagCall *call, CagValue *result) {
  CagList *holes = NULL;
  CagCurve *outer = NULL, **loops = NULL;
  CagRegion *region = NULL;
  CagError err;
  if (cag_given(call, 1) && !cag_arg_list(call, 1, &holes)) return false;
  size_t n = holes ? holes->length : 0, read = 0;
  if (!read_loop(call, 0, call->values[0], &outer)) return false;
  loops = malloc((n + 1) * sizeof *loops);
  bool ok = loops != NULL;
  if (!ok) cag_fail_call(call, -1, CAG_ERR_limit_memory, "needs more memory than there is");
  for (; ok && read < n; read += ok)
    ok = read_loop(call, 1, cag_list_get(call->vm, holes, read), &loops[read]);
  if (ok) {
    CagStatus status = cag_region_new(outer, loops, n, &region, &err);
    ok = give(call, status, &err, &region, result);
  }
  for (size_t i = 0; i < read; i++) cag_curve_release(loops[i]);
  free(loops);
  cag_curve_release(outer);
  return ok;
}

bool cag_curves_polygon(CagCall *call, CagValue *result) {
  if (call->values[0].type != CAG_LIST) return cag_fail_type(call, 0, "a list of points");
  return cag_curves_region(call, result);
}

bool cag_curves_rectangle(CagCall *call, CagValue *result) {
  double w, h, radius;
  CagRegion *region = NULL;
  CagError err;
  if (!cag_arg_positive(call, 0, &w) || !cag_arg_positive(call, 1, &h) ||
      !cag_arg_number_or(call, 2, 0, &radius))
    return false;
  CagStatus status = cag_region_rectangle(w, h, radius, &region, &err);
  return give(call, status, &err, &region, result);
}

// More corners than any polygon of a drawing; a circle says it better.
#define CORNERS_MAX 1000000

bool cag_curves_regular_polygon(CagCall *call, CagValue *result) {
  long n;
  double radius;
  CagRegion *region = NULL;
  CagError err;
  if (!cag_arg_integer(call, 0, 3, CORNERS_MAX, &n) || !cag_arg_positive(call, 1, &radius))
    return false;
  CagStatus status = cag_region_regular_polygon((size_t)n, radius, &region, &err);
  return give(call, status, &err, &region, result);
}

bool cag_curves_boundary(CagCall *call, CagValue *result) {
  if (call->values[0].type != CAG_REGION) return cag_fail_type(call, 0, "a region");
  const CagShape *shape = CAG_AS_SHAPE(call->values[0]);
  CagBuilder *loops = cag_builder_new(call->vm);
  CagError err;
  for (size_t i = 0; i < shape->as.region->count; i++) {
    CagCurve *placed = NULL;
    CagStatus status =
        cag_curve_transform(shape->as.region->loops[i], &shape->placement, &placed, &err);
    if (!cag_geometry_ok(call, status, &err)) return false;
    if (!cag_builder_add(call->vm, loops, cag_curve_value(call->vm, placed))) return false;
  }
  *result = cag_builder_finish(call->vm, loops);
  return true;
}
