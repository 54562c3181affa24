// Regions of the plane.

#include <string.h>

#include "interp/builtin/curves.h"
#include "interp/builtin/holds.h"

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
  // cag_arg_points reads an argument, so the list temporarily replaces it.
  CagValue kept = call->values[argument];
  CagVec3 *points;
  size_t n;
  int dimension;
  call->values[argument] = v;
  const bool ok = cag_arg_points(call, argument, &points, &n, &dimension);
  call->values[argument] = kept;
  if (!ok) return false;
  cag_hold(call, points);
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
  if (!cag_geometry_ok(call, status)) return false;
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

bool cag_curves_region(CagCall *call, CagValue *result) {
  const CagValue outline = call->values[0];
  CagList *holes = NULL;
  CagRegion *region = NULL;
  if (cag_given(call, 1) && !cag_arg_list(call, 1, &holes)) return false;
  if (outline.type != CAG_LIST || CAG_AS_LIST(outline)->length > 0)
    return bounded_by_some(call, holes, result);
  // A region without boundary curves is empty, so it cannot have holes.
  const CagStatus status =
      holes && holes->length ? cag_fail(call->err, CAG_E_ARGUMENT, CAG_ERR_hole_outside, "holes", 0,
                                        "the outline is empty, so holes[0] does not lie within it")
                             : cag_region_empty(&region, call->err);
  return cag_region_result(call, status, &region, result);
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

// --- Set operations and offsets ---

// Computes the transform from the plane `place` to the plane `base`. Fails if they are not the same
// plane. Messages count operands from 1.
static CagStatus between_planes(const CagTransform *base, const CagTransform *place, size_t operand,
                                CagTransform *out, CagError *err) {
  const double same =
      1e-9; // tolerance for the distance between the planes, relative to the region's distance
  CagTransform back;
  CagStatus status = cag_transform_inverse(base, &back, err);
  if (status) return status;
  *out = cag_transform_multiply(&back, place);
  const double reach = 1 + fabs(out->m[0][3]) + fabs(out->m[1][3]);
  if (!(fabs(out->m[2][0]) <= same && fabs(out->m[2][1]) <= same &&
        fabs(out->m[2][3]) <= same * reach))
    return cag_fail(
        err, CAG_E_ARGUMENT, CAG_ERR_region_planes, "", -1,
        "operand %zu lies in another plane than the first region; combine the regions in one plane, then move the result",
        operand);
  for (int i = 0; i < 4; i++) out->m[2][i] = out->m[i][2] = i == 2;
  out->planar = true;
  return CAG_OK;
}

// The operands of a set operation, which are read one after the other.
typedef struct Operands {
  CagCall *call;
  CagTransform base; // the plane of the first region
  bool based;
  CagValue first; // the first shape; unset: none so far
} Operands;

// Reads a region or closed plane curve, in the common plane; *out has one reference.
static bool read_shape(Operands *o, CagValue v, size_t operand, CagRegion **out) {
  if (v.type != CAG_REGION && v.type != CAG_CURVE)
    return cag_fail_call(o->call, -1, CAG_ERR_type, "expects regions, found %s as operand %zu",
                         cag_type_article(v), operand);
  const CagShape *shape = CAG_AS_SHAPE(v);
  if (o->first.type == CAG_UNSET) o->first = v;
  if (v.type == CAG_CURVE)
    return cag_geometry_ok(o->call, cag_region_new(shape->as.curve, NULL, 0, out, o->call->err));
  if (!o->based) o->base = shape->placement[0];
  o->based = true;
  if (!memcmp(o->base.m, shape->placement->m, sizeof o->base.m)) {
    *out = cag_region_retain(shape->as.region);
    return true;
  }
  CagTransform t;
  CagStatus status = between_planes(&o->base, shape->placement, operand, &t, o->call->err);
  if (!status) status = cag_region_transform(shape->as.region, &t, out, o->call->err);
  return cag_geometry_ok(o->call, status);
}

// Returns the union of the shapes of an operand, or the empty region if there are none.
static bool unite_shapes(Operands *o, const CagList *shapes, size_t operand, CagRegion **out) {
  CagRegion **parts = cag_hold_region_array(o->call, shapes->length);
  for (size_t i = 0; i < shapes->length; i++)
    if ((i % CAG_LOOK_UP == 0 && !cag_keep_going(o->call->vm)) ||
        !read_shape(o, cag_list_get(o->call->vm, shapes, i), operand, &parts[i]))
      return false;
  CagStatus status = cag_region_combine(CAG_REGION_UNION, (const CagRegion *const *)parts,
                                        shapes->length, out, o->call->err);
  cag_release_held(o->call, parts);
  return cag_geometry_ok(o->call, status);
}

// Reads a region, a closed plane curve, or a group or list of these, which are united.
static bool read_operand(Operands *o, CagValue v, size_t operand, CagRegion **out) {
  if (v.type != CAG_LIST && v.type != CAG_GROUP) return read_shape(o, v, operand, out);
  CagBuilder *builder = cag_builder_new(o->call->vm);
  if (!cag_shapes_collect(o->call, v, builder)) return false;
  const CagList *shapes = CAG_AS_LIST(cag_builder_finish(o->call->vm, builder));
  return unite_shapes(o, shapes, operand, out);
}

static bool combine(CagCall *call, CagRegionOp op, CagValue *result) {
  CagValue *items;
  size_t n;
  CagRegion *out = NULL;
  if (!cag_arg_several(call, &items, &n)) return false;
  if (n == 0) return cag_fail_call(call, 0, CAG_ERR_value, "expects at least one region");
  Operands o = {.call = call, .base = cag_transform_identity(), .first = cag_unset()};
  CagRegion **regions = cag_hold_region_array(call, n);
  for (size_t i = 0; i < n; i++)
    if (!read_operand(&o, items[i], i + 1, &regions[i])) return false;
  CagStatus status = cag_region_combine(op, (const CagRegion *const *)regions, n, &out, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  *result = cag_region_value(call->vm, out, &o.base);
  if (o.first.type != CAG_UNSET) cag_shape_say_alike(*result, o.first);
  return true;
}

bool cag_regions_unite(CagCall *call, CagValue *result) {
  return combine(call, CAG_REGION_UNION, result);
}

bool cag_regions_subtract(CagCall *call, CagValue *result) {
  return combine(call, CAG_REGION_DIFFERENCE, result);
}

bool cag_regions_intersect(CagCall *call, CagValue *result) {
  return combine(call, CAG_REGION_INTERSECTION, result);
}

bool cag_regions_offset(CagCall *call, const struct cag_regions_offset *a, CagValue *result) {
  const double part = 1e-6; // the default tolerance, as a fraction of the size
  const CagShape *shape = CAG_AS_SHAPE(a->R);
  double tolerance = a->tolerance;
  CagRegion *out = NULL;
  CagBounds box = {{0, 0, 0}, {1, 1, 0}};
  if (!cag_region_is_empty(shape->as.region) &&
      !cag_geometry_ok(call, cag_region_bounds(shape->as.region, &box, call->err)))
    return false;
  if (!cag_given(call, 2)) tolerance = part * cag_norm(cag_sub(box.max, box.min));
  if (!(tolerance > 0))
    return cag_fail_call(call, 2, CAG_ERR_value, "expects a tolerance greater than 0");
  CagStatus status = cag_region_offset(shape->as.region, a->d, tolerance, &out, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  *result = cag_region_value(call->vm, out, shape->placement);
  cag_shape_say_alike(*result, a->R);
  return true;
}

bool cag_regions_inertia(CagCall *call, const struct cag_regions_inertia *a, CagValue *result) {
  static const char *const names[] = {"mass", "center", "matrix"};
  const CagShape *shape = CAG_AS_SHAPE(a->R);
  const double density = a->density;
  double area = 0, xx = 0, xy = 0, yy = 0, *m;
  CagVec3 center;
  if (!shape->placement->planar)
    return cag_fail_call(call, 0, CAG_ERR_value,
                         "expects a region of the plane, found one that was moved into space");
  const bool empty = cag_region_is_empty(shape->as.region);
  CagStatus status = CAG_OK;
  if (!empty)
    status = cag_region_second_moments(shape->as.region, &area, &center, &xx, &xy, &yy, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  CagValue matrix = cag_list_vectors(call->vm, 2, 2, &m);
  m[0] = density * yy;
  m[1] = m[2] = 0 - density * xy;
  m[3] = density * xx;
  const CagValue at = empty ? cag_none() : cag_point(call->vm, center, 2);
  CagValue values[] = {cag_number(density * area), at, matrix};
  *result = cag_record_new(call->vm, names, values, 3);
  return true;
}
