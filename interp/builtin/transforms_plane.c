// Planes, and points and lines in the plane.

#include "interp/builtin/holds.h"
#include "interp/builtin/shapes.h"

// Lines whose directions differ by less than this sine are parallel; lines of space that pass each
// other by more than this share of their data's size do not meet. Both are some hundred roundings.
#define LINE_TOLERANCE 1e-12

bool cag_transforms_plane(CagCall *call, const struct cag_transforms_plane *a, CagValue *result) {
  CagPlane plane;
  CagVec3 p, q;
  CagStatus status;
  const double *row;
  size_t n;
  if (!cag_given(call, 1)) {
    if (!cag_arg_numbers(call, 0, &row, &n)) return false;
    if (n != 4)
      return cag_fail_call(
          call, 0, CAG_ERR_value,
          "expects the 4 numbers of a x + b y + c z + d = 0, a point and a normal, or three points; found only %zu numbers",
          n);
    status = cag_plane_from_row(row, &plane, call->err);
  } else {
    if (!cag_arg_vec(call, 0, &p, NULL) || !cag_arg_vec(call, 1, &q, NULL)) return false;
    status = cag_given(call, 2) ? cag_plane_through(p, q, a->R.at, &plane, call->err)
                                : cag_plane(p, q, &plane, call->err);
  }
  if (!cag_geometry_ok(call, status)) return false;
  *result = cag_plane_value(call->vm, &plane);
  return true;
}

bool cag_transforms_polar(CagCall *call, const struct cag_transforms_polar *a, CagValue *result) {
  double sine, cosine;
  cag_sincos(a->angle, &sine, &cosine);
  *result = cag_point(call->vm, cag_madd(a->center.at, a->r, cag_vec3(cosine, sine, 0)),
                      a->center.dimension);
  return true;
}

bool cag_transforms_intersect_lines(CagCall *call, const struct cag_transforms_intersect_lines *a,
                                    CagValue *result) {
  const CagVec3 pq = cag_sub(a->Q.at, a->P.at), rs = cag_sub(a->S.at, a->R.at);
  const CagVec3 between = cag_sub(a->R.at, a->P.at), n = cag_cross(pq, rs);
  if (cag_norm(pq) == 0 || cag_norm(rs) == 0)
    return cag_fail_call(call, cag_norm(pq) == 0 ? 1 : 3, CAG_ERR_value,
                         "expects two different points of each line");
  double nn = cag_dot(n, n), size = cag_norm(pq) + cag_norm(rs) + cag_norm(between);
  *result = cag_none();
  if (sqrt(nn) <= LINE_TOLERANCE * cag_norm(pq) * cag_norm(rs)) return true;
  if (fabs(cag_dot(between, n)) / sqrt(nn) > 1000 * LINE_TOLERANCE * size) return true;
  double t = cag_dot(cag_cross(between, rs), n) / nn;
  const bool space =
      a->P.dimension == 3 || a->Q.dimension == 3 || a->R.dimension == 3 || a->S.dimension == 3;
  *result = cag_point(call->vm, cag_madd(a->P.at, t, pq), space ? 3 : 2);
  return true;
}

bool cag_transforms_distance_to_line(CagCall *call, const struct cag_transforms_distance_to_line *a,
                                     CagValue *result) {
  CagVec3 along = cag_sub(a->R.at, a->Q.at);
  if (cag_norm(along) == 0)
    return cag_fail_call(call, 2, CAG_ERR_value, "expects two different points of the line");
  const double distance = cag_norm(cag_cross(cag_sub(a->P.at, a->Q.at), along)) / cag_norm(along);
  *result = cag_number(distance);
  return isfinite(distance) ||
         cag_fail_call(call, -1, CAG_ERR_value, "expects points whose distances do not overflow");
}

// Size of the vector area of the closed polygon, and its centroid: shoelace sums taken from the first point,
// which keeps them small. A polygon of space is taken as seen along its vector area.
static bool polygon_area(CagCall *call, CagPoints polygon, double *out, CagVec3 *centroid) {
  const CagVec3 *p = polygon.items;
  const size_t n = polygon.count;
  CagVec3 area = {0, 0, 0}, moment = {0, 0, 0};
  if (n < 3)
    return cag_fail_call(call, 0, CAG_ERR_value,
                         "expects at least 3 points of a polygon, found %zu", n);
  for (size_t i = 1; i + 1 < n; i++)
    area = cag_madd(area, 0.5, cag_cross(cag_sub(p[i], p[0]), cag_sub(p[i + 1], p[0])));
  CagVec3 normal = cag_unit(area);
  for (size_t i = 1; i + 1 < n; i++) {
    CagVec3 a = cag_sub(p[i], p[0]), b = cag_sub(p[i + 1], p[0]);
    moment = cag_madd(moment, cag_dot(normal, cag_cross(a, b)) / 6, cag_add(a, b));
  }
  *out = cag_norm(area);
  *centroid = *out > 0 ? cag_madd(p[0], 1 / *out, moment) : p[0];
  return true;
}

bool cag_transforms_area_of_points(CagCall *call, const struct cag_transforms_area_of_points *a,
                                   CagValue *result) {
  double area;
  CagVec3 centroid;
  if (!polygon_area(call, a->points, &area, &centroid)) return false;
  *result = cag_number(area);
  return true;
}

bool cag_transforms_centroid_of_points(CagCall *call,
                                       const struct cag_transforms_centroid_of_points *a,
                                       CagValue *result) {
  double area;
  CagVec3 centroid;
  if (!polygon_area(call, a->points, &area, &centroid)) return false;
  if (area == 0)
    return cag_fail_call(call, 0, CAG_ERR_value, "expects a polygon with an area, found none");
  *result = cag_point(call->vm, centroid, a->points.dimension);
  return true;
}

bool cag_transforms_contains(CagCall *call, CagValue *result) {
  CagRegion *region;
  CagTransform place, back;
  CagVec3 p;
  bool inside = false;
  if (!cag_arg_vec(call, 1, &p, NULL) || !cag_arg_region(call, 0, &region, &place)) return false;
  cag_hold_region(call, region);
  if (!cag_geometry_ok(call, cag_transform_inverse(&place, &back, call->err))) return false;
  p = cag_transform_point(&back, p);
  // A point beside the region's plane is not in it; the rounding of placing it there is.
  bool beside = fabs(p.z) > 1000 * LINE_TOLERANCE * (1 + cag_norm(p));
  p.z = 0;
  if (!beside && !cag_geometry_ok(call, cag_region_contains(region, p, &inside, call->err)))
    return false;
  *result = cag_bool(inside);
  return true;
}
