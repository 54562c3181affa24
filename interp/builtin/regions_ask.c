// Questions about regions.

#include "geom/curve/region_relation.h"
#include "interp/builtin/regions.h"

bool cag_regions_relation(CagCall *call, CagValue *result) {
  static const char *const names[] = {
      [CAG_REGION_DISJOINT] = "disjoint", [CAG_REGION_TOUCHES] = "touches",
      [CAG_REGION_OVERLAPS] = "overlaps", [CAG_REGION_WITHIN] = "within",
      [CAG_REGION_CONTAINS] = "contains", [CAG_REGION_EQUALS] = "equals"};
  CagRegion **pair;
  CagTransform plane;
  CagRegionRelation relation;
  if (!cag_regions_read_pair(call, &pair, &plane)) return false;
  if (!cag_geometry_ok(call, cag_region_relation(pair[0], pair[1], &relation, call->err)))
    return false;
  *result = cag_text_c(call->vm, names[relation]);
  return true;
}

bool cag_regions_interior_point(CagCall *call, const struct cag_regions_interior_point *a,
                                CagValue *result) {
  const CagShape *shape = CAG_AS_SHAPE(a->R);
  CagVec3 p;
  if (!cag_geometry_ok(call, cag_region_interior_point(shape->as.region, &p, call->err)))
    return false;
  const CagTransform *place = shape->placement;
  *result = cag_point(call->vm, cag_transform_point(place, p), place->planar ? 2 : 3);
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
