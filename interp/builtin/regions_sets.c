// Set operations of regions, and reading of their operands.

#include <string.h>

#include "interp/builtin/holds.h"
#include "interp/builtin/regions.h"

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

bool cag_regions_read_pair(CagCall *call, CagRegion ***out, CagTransform *plane) {
  Operands o = {.call = call, .base = cag_transform_identity(), .first = cag_unset()};
  const CagValue first = call->values[0];
  // Regions of the plane are compared in the coordinates of the script.
  o.based = first.type != CAG_REGION || CAG_AS_SHAPE(first)->placement->planar;
  *out = cag_hold_region_array(call, 2);
  for (int i = 0; i < 2; i++)
    if (!read_operand(&o, call->values[i], (size_t)i + 1, &(*out)[i])) return false;
  *plane = o.base;
  return true;
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
