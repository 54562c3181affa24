// Planes, and points and lines in the plane.

#include "interp/builtin/holds.h"
#include "interp/builtin/shapes.h"

// Lines whose directions differ by less than this sine are parallel; lines of space that pass each
// other by more than this share of their data's size do not meet. Both are some hundred roundings.
#define LINE_TOLERANCE 1e-12

bool cag_transforms_plane(CagCall *call, CagValue *result) {
  CagPlane plane;
  CagVec3 p, q, r;
  CagStatus status;
  const double *row;
  size_t n;
  if (!cag_given(call, 1)) {
    if (!cag_arg_numbers(call, 0, &row, &n)) return false;
    if (n != 4) {
      cag_fail_call(call, 0, CAG_ERR_value,
                    "expects the 4 numbers of a x + b y + c z + d = 0, or a point and a normal, or "
                    "three points; found %zu numbers alone",
                    n);
      return false;
    }
    status = cag_plane_from_row(row, &plane, call->err);
  } else {
    if (!cag_arg_vec(call, 0, &p, NULL) || !cag_arg_vec(call, 1, &q, NULL)) return false;
    if (cag_given(call, 2)) {
      if (!cag_arg_vec(call, 2, &r, NULL)) return false;
      status = cag_plane_through(p, q, r, &plane, call->err);
    } else {
      status = cag_plane(p, q, &plane, call->err);
    }
  }
  if (!cag_geometry_ok(call, status)) return false;
  *result = cag_plane_value(call->vm, &plane);
  return true;
}

bool cag_transforms_polar(CagCall *call, CagValue *result) {
  double r, angle, sine, cosine;
  CagVec3 center;
  int dimension = 2;
  if (!cag_arg_finite(call, 0, &r) || !cag_arg_angle(call, 1, &angle) ||
      !cag_arg_vec_or(call, 2, cag_vec3(0, 0, 0), &center, &dimension))
    return false;
  if (!cag_given(call, 2)) dimension = 2;
  cag_sincos(angle, &sine, &cosine);
  *result = cag_point(call->vm, cag_madd(center, r, cag_vec3(cosine, sine, 0)), dimension);
  return true;
}

bool cag_transforms_intersect_lines(CagCall *call, CagValue *result) {
  CagVec3 p[4];
  int dimension = 2;
  for (int i = 0; i < 4; i++) {
    int d;
    if (!cag_arg_vec(call, i, &p[i], &d)) return false;
    if (d == 3) dimension = 3;
  }
  CagVec3 a = cag_sub(p[1], p[0]), b = cag_sub(p[3], p[2]), between = cag_sub(p[2], p[0]);
  for (int i = 0; i < 2; i++)
    if (cag_norm(i == 0 ? a : b) == 0)
      return cag_fail_call(call, 2 * i + 1, CAG_ERR_value,
                           "expects two different points of each line");
  CagVec3 n = cag_cross(a, b);
  double nn = cag_dot(n, n), size = cag_norm(a) + cag_norm(b) + cag_norm(between);
  *result = cag_none();
  if (sqrt(nn) <= LINE_TOLERANCE * cag_norm(a) * cag_norm(b)) return true;
  if (fabs(cag_dot(between, n)) / sqrt(nn) > 1000 * LINE_TOLERANCE * size) return true;
  double t = cag_dot(cag_cross(between, b), n) / nn;
  *result = cag_point(call->vm, cag_madd(p[0], t, a), dimension);
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
         cag_fail_call(call, -1, CAG_ERR_value, "expects points so near that distances are finite");
}

// Vector area of the closed polygon and its centroid: shoelace sums taken from the first point,
// which keeps them small. A polygon of space is taken as seen along its vector area.
static CagVec3 polygon_area(const CagVec3 *p, size_t n, CagVec3 *centroid) {
  CagVec3 area = {0, 0, 0}, moment = {0, 0, 0};
  for (size_t i = 1; i + 1 < n; i++)
    area = cag_madd(area, 0.5, cag_cross(cag_sub(p[i], p[0]), cag_sub(p[i + 1], p[0])));
  CagVec3 normal = cag_unit(area);
  double whole = cag_norm(area);
  for (size_t i = 1; i + 1 < n; i++) {
    CagVec3 a = cag_sub(p[i], p[0]), b = cag_sub(p[i + 1], p[0]);
    moment = cag_madd(moment, cag_dot(normal, cag_cross(a, b)) / 6, cag_add(a, b));
  }
  *centroid = whole > 0 ? cag_madd(p[0], 1 / whole, moment) : p[0];
  return area;
}

static bool read_polygon(CagCall *call, CagVec3 *area, CagVec3 *centroid, int *dimension) {
  CagVec3 *points;
  size_t n;
  if (!cag_arg_points(call, 0, &points, &n, dimension)) return false;
  cag_hold(call, points);
  if (n < 3)
    return cag_fail_call(call, 0, CAG_ERR_value,
                         "expects at least 3 points of a polygon, found %zu", n);
  *area = polygon_area(points, n, centroid);
  return true;
}

bool cag_transforms_area_of_points(CagCall *call, CagValue *result) {
  CagVec3 area, centroid;
  int dimension;
  if (!read_polygon(call, &area, &centroid, &dimension)) return false;
  *result = cag_number(cag_norm(area));
  return true;
}

bool cag_transforms_centroid_of_points(CagCall *call, CagValue *result) {
  CagVec3 area, centroid;
  int dimension;
  if (!read_polygon(call, &area, &centroid, &dimension)) return false;
  if (cag_norm(area) == 0)
    return cag_fail_call(call, 0, CAG_ERR_value, "expects a polygon with an area, found none");
  *result = cag_point(call->vm, centroid, dimension);
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
