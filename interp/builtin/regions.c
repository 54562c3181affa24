// Regions of the plane.

#include "geom/curve/region_fill.h"
#include "interp/builtin/curves.h"
#include "interp/builtin/holds.h"

// Reads the points of a list that is part of an argument; they are held.
static bool read_points(CagCall *call, int argument, CagValue v, CagVec3 **points, size_t *n,
                        int *dimension) {
  // cag_arg_points reads an argument, so the list temporarily replaces it.
  CagValue kept = call->values[argument];
  call->values[argument] = v;
  const bool ok = cag_arg_points(call, argument, points, n, dimension);
  call->values[argument] = kept;
  if (ok) cag_hold(call, *points);
  return ok;
}

// Reads a closed plane curve from a curve or a list of points. Messages name `argument`. *out has
// one reference.
static bool read_loop(CagCall *call, int argument, CagValue v, CagCurve **out) {
  if (v.type == CAG_CURVE) {
    *out = cag_curve_retain(CAG_AS_SHAPE(v)->as.curve);
    return true;
  }
  if (v.type != CAG_LIST)
    return cag_fail_call(call, argument, CAG_ERR_type,
                         "expects closed plane curves or lists of points, found %s",
                         cag_type_article(v));
  CagVec3 *points;
  size_t n;
  int dimension;
  if (!read_points(call, argument, v, &points, &n, &dimension)) return false;
  if (!cag_geometry_ok(call, cag_curve_polyline(points, n, true, dimension, out, call->err)))
    return false;
  cag_release_held(call, points);
  return true;
}

// Returns v if it is a nonempty list of curves, and NULL otherwise.
static const CagList *list_of_curves(CagCall *call, CagValue v) {
  if (v.type != CAG_LIST || CAG_AS_LIST(v)->dim != 0 || CAG_AS_LIST(v)->length == 0) return NULL;
  const CagList *list = CAG_AS_LIST(v);
  for (size_t i = 0; i < list->length; i++)
    if (cag_list_get(call->vm, list, i).type != CAG_CURVE) return NULL;
  return list;
}

// Returns the region bounded by the loops, of which the last ones are holes, in its plane.
static bool bounded_by(CagCall *call, CagCurve **loops, size_t outer, size_t holes,
                       CagValue *result) {
  CagTransform frame;
  bool in_space;
  CagRegion *region = NULL;
  if (!cag_region_loops_plane(call, loops, outer + holes, &frame, &in_space)) return false;
  CagStatus status = outer == 1 ? cag_region_new(loops[0], loops + 1, holes, &region, call->err)
                                : cag_region_from_loops(loops, outer + holes, &region, call->err);
  if (!cag_geometry_ok(call, status)) {
    if (call->err->id == CAG_ERR_region_crossing || call->err->id == CAG_ERR_zero_area)
      cag_fail_help(call->vm, "pass `fill: \"nonzero\"` to fill outlines that cross");
    return false;
  }
  *result = cag_region_value(call->vm, region, in_space ? &frame : NULL);
  return true;
}

static bool bounded_by_some(CagCall *call, const CagList *holes, CagValue *result) {
  const CagList *several = list_of_curves(call, call->values[0]);
  const size_t outer = several ? several->length : 1, n = outer + (holes ? holes->length : 0);
  CagCurve **loops = cag_hold_curve_array(call, n);
  for (size_t i = 0; i < n; i++) {
    const CagValue v = i >= outer ? cag_list_get(call->vm, holes, i - outer)
                       : several  ? cag_list_get(call->vm, several, i)
                                  : call->values[0];
    if (!read_loop(call, i >= outer, v, &loops[i])) return false;
  }
  return bounded_by(call, loops, outer, n - outer, result);
}

// --- Outlines that may cross ---

// Whether the value is a list of outlines; else it is one outline.
static bool is_list_of_outlines(CagCall *call, CagValue v) {
  if (v.type != CAG_LIST || CAG_AS_LIST(v)->dim != 0) return false;
  for (size_t i = 0; i < CAG_AS_LIST(v)->length; i++) {
    const CagValue item = cag_list_get(call->vm, CAG_AS_LIST(v), i);
    if (item.type == CAG_CURVE) return true;
    if (item.type != CAG_LIST) return false;
    if (CAG_AS_LIST(item)->dim != 0) return true;
    if (CAG_AS_LIST(item)->length > 0)
      return cag_list_get(call->vm, CAG_AS_LIST(item), 0).type == CAG_LIST;
  }
  return CAG_AS_LIST(v)->length > 0;
}

// Outlines, in a common plane once all are read.
typedef struct Outlines {
  CagCurve **loops; // held
  size_t n;
} Outlines;

// Whether fewer than three of the points differ from the next one, so that they bound nothing.
static bool bound_nothing(const CagVec3 *p, size_t n) {
  size_t steps = 0;
  for (size_t i = 0; i < n && steps < 3; i++) steps += cag_norm(cag_sub(p[i], p[(i + 1) % n])) > 0;
  return steps < 3;
}

// Reads a closed plane curve; *out is NULL for points that bound nothing.
static bool read_outline(CagCall *call, int argument, CagValue v, CagCurve **out) {
  CagVec3 *points;
  size_t n;
  int dimension;
  *out = NULL;
  if (v.type == CAG_LIST && CAG_AS_LIST(v)->length == 0) return true;
  if (v.type == CAG_LIST) {
    if (!read_points(call, argument, v, &points, &n, &dimension)) return false;
    const bool nothing = bound_nothing(points, n);
    cag_release_held(call, points);
    if (nothing) return true;
  }
  return read_loop(call, argument, v, out);
}

static bool read_outlines(CagCall *call, int argument, CagValue v, Outlines *out) {
  const bool several = is_list_of_outlines(call, v);
  const size_t count = several ? CAG_AS_LIST(v)->length : 1;
  out->loops = cag_hold_curve_array(call, count);
  out->n = 0;
  for (size_t i = 0; i < count; i++) {
    const CagValue one = several ? cag_list_get(call->vm, CAG_AS_LIST(v), i) : v;
    if (!read_outline(call, argument, one, &out->loops[out->n])) return false;
    out->n += out->loops[out->n] != NULL;
  }
  return true;
}

static bool filled(CagCall *call, const Outlines *o, CagFill fill, CagRegion **out) {
  return cag_geometry_ok(
      call, cag_region_fill((const CagCurve *const *)o->loops, o->n, fill, out, call->err));
}

// The region inside the outlines, but not inside the holes.
static bool filled_region(CagCall *call, CagFill fill, CagValue *result) {
  Outlines all, holes = {0};
  CagTransform frame;
  bool in_space;
  if (!read_outlines(call, 0, call->values[0], &all)) return false;
  const size_t outer = all.n;
  if (cag_given(call, 1) && !read_outlines(call, 1, call->values[1], &holes)) return false;
  CagCurve **loops = cag_hold_curve_array(call, outer + holes.n);
  for (size_t i = 0; i < outer; i++) loops[i] = cag_curve_retain(all.loops[i]);
  for (size_t i = 0; i < holes.n; i++) loops[outer + i] = cag_curve_retain(holes.loops[i]);
  if (!cag_region_loops_plane(call, loops, outer + holes.n, &frame, &in_space)) return false;
  CagRegion **parts = cag_hold_region_array(call, 2), *region = NULL;
  const Outlines around = {loops, outer}, within = {loops + outer, holes.n};
  if (!filled(call, &around, fill, &parts[0])) return false;
  if (holes.n > 0) {
    if (!filled(call, &within, fill, &parts[1])) return false;
    CagStatus status =
        cag_region_boolean(CAG_REGION_DIFFERENCE, parts[0], parts[1], &region, call->err);
    if (!cag_geometry_ok(call, status)) return false;
  } else {
    region = cag_region_retain(parts[0]);
  }
  *result = cag_region_value(call->vm, region, in_space ? &frame : NULL);
  return true;
}

bool cag_curves_region(CagCall *call, CagValue *result) {
  static const char *const fills[] = {[CAG_FILL_EVEN_ODD] = "even-odd",
                                      [CAG_FILL_NONZERO] = "nonzero",
                                      [CAG_FILL_POSITIVE] = "positive",
                                      NULL};
  const CagValue outline = call->values[0];
  CagList *holes = NULL;
  CagRegion *region = NULL;
  int fill;
  if (cag_given(call, 1) && !cag_arg_list(call, 1, &holes)) return false;
  if (!cag_arg_choice(call, 2, fills, &fill)) return false;
  if (cag_given(call, 2)) return filled_region(call, (CagFill)fill, result);
  if (outline.type != CAG_LIST || CAG_AS_LIST(outline)->length > 0)
    return bounded_by_some(call, holes, result);
  // A region without boundary curves is empty, so it cannot have holes.
  const CagStatus status =
      holes && holes->length ? cag_fail(call->err, CAG_E_ARGUMENT, CAG_ERR_hole_outside, "holes", 0,
                                        "the outline is empty, so holes[0] does not lie within it")
                             : cag_region_empty(&region, call->err);
  return cag_region_result(call, status, &region, result);
}

bool cag_regions_repaired(CagCall *call, CagValue *result) {
  if (call->values[0].type != CAG_REGION) return filled_region(call, CAG_FILL_EVEN_ODD, result);
  const CagShape *shape = CAG_AS_SHAPE(call->values[0]);
  const Outlines loops = {shape->as.region->loops, shape->as.region->count};
  CagRegion *out = NULL;
  if (!filled(call, &loops, CAG_FILL_EVEN_ODD, &out)) return false;
  *result = cag_region_value(call->vm, out, shape->placement);
  cag_shape_say_alike(*result, call->values[0]);
  return true;
}

bool cag_curves_polygon(CagCall *call, CagValue *result) {
  CagList *holes = NULL;
  if (call->values[0].type != CAG_LIST) return cag_fail_type(call, 0, "a list of points");
  if (cag_given(call, 1) && !cag_arg_list(call, 1, &holes)) return false;
  return bounded_by_some(call, holes, result);
}

bool cag_curves_rectangle(CagCall *call, const struct cag_curves_rectangle *a, CagValue *result) {
  CagRegion *region = NULL;
  CagStatus status = cag_region_rectangle(a->w, a->h, a->radius, &region, call->err);
  return cag_region_result(call, status, &region, result);
}

bool cag_curves_regular_polygon(CagCall *call, const struct cag_curves_regular_polygon *a,
                                CagValue *result) {
  CagRegion *region = NULL;
  CagStatus status = cag_region_regular_polygon((size_t)a->n, a->radius, &region, call->err);
  return cag_region_result(call, status, &region, result);
}

bool cag_curves_boundary(CagCall *call, CagValue *result) {
  const CagShape *shape = CAG_AS_SHAPE(call->values[0]);
  CagBuilder *loops = cag_builder_new(call->vm);
  for (size_t i = 0; i < shape->as.region->count; i++) {
    CagCurve *placed = NULL;
    CagValue loop;
    CagStatus status =
        cag_curve_transform(shape->as.region->loops[i], shape->placement, &placed, call->err);
    if (!cag_curve_result(call, status, &placed, &loop) || !cag_builder_add(call->vm, loops, loop))
      return false;
  }
  *result = cag_builder_finish(call->vm, loops);
  return true;
}
