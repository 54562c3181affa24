// Distances and nearest points from a point to a segment and to a triangle in space.

#ifndef CAG_GEOM_MESH_DISTANCE_H
#define CAG_GEOM_MESH_DISTANCE_H

#include <stdbool.h>

#include "geom/linalg/vec.h"

static inline double cag_distance_to_segment(CagVec3 p, CagVec3 a, CagVec3 b) {
  CagVec3 ab = cag_sub(b, a), ap = cag_sub(p, a);
  double length2 = cag_dot(ab, ab), along = cag_dot(ap, ab);
  double t = !(length2 > 0) || along <= 0 ? 0 : along >= length2 ? 1 : along / length2;
  return cag_norm(cag_sub(ap, cag_scaled(ab, t)));
}

// Whether a triangle is so thin that its plane is determined by rounding. Then the distances of its
// edges are used instead, which is off by less than its height. With corners off by e and longest
// edge l, the plane of a triangle of height h is off by l e / h at its ends; that is more than h if
// h is below sqrt(e l). n: the cross product of the edges from a.
static inline bool cag_triangle_is_thin(CagVec3 a, CagVec3 ab, CagVec3 ac, CagVec3 n) {
  const double rounding = 16 * 2.220446049250313e-16; // relative, of the evaluated coordinates
  double area2 = cag_dot(n, n), l2 = fmax(cag_dot(ab, ab), cag_dot(ac, ac));
  return !(area2 * area2 > rounding * rounding * (cag_dot(a, a) + l2) * (l2 * l2 * l2));
}

// Handles triangles that degenerate to a segment or a point.
static inline double cag_distance_to_triangle(CagVec3 p, CagVec3 a, CagVec3 b, CagVec3 c) {
  CagVec3 ab = cag_sub(b, a), ac = cag_sub(c, a), ap = cag_sub(p, a), n = cag_cross(ab, ac);
  bool inside = cag_dot(cag_cross(ab, ap), n) >= 0 && cag_dot(cag_cross(ap, ac), n) >= 0 &&
                cag_dot(cag_cross(cag_sub(c, b), cag_sub(p, b)), n) >= 0 &&
                !cag_triangle_is_thin(a, ab, ac, n);
  if (inside) return fabs(cag_dot(ap, n)) / cag_norm(n);
  return fmin(cag_distance_to_segment(p, a, b),
              fmin(cag_distance_to_segment(p, b, c), cag_distance_to_segment(p, c, a)));
}

// The point of the segment nearest to p.
static inline CagVec3 cag_nearest_of_segment(CagVec3 p, CagVec3 a, CagVec3 b) {
  const CagVec3 way = cag_sub(b, a);
  const double length2 = cag_dot(way, way), along = cag_dot(cag_sub(p, a), way);
  return length2 > 0 ? cag_madd(a, fmin(1, fmax(0, along / length2)), way) : a;
}

// The perpendicular foot of p in the plane of the triangle. Returns false if it is outside the
// triangle.
static inline bool cag_foot_in_triangle(CagVec3 p, const CagVec3 t[3], CagVec3 *foot) {
  const CagVec3 ab = cag_sub(t[1], t[0]), ac = cag_sub(t[2], t[0]), n = cag_cross(ab, ac);
  if (cag_triangle_is_thin(t[0], ab, ac, n)) return false;
  *foot = cag_madd(p, -cag_dot(cag_sub(p, t[0]), n) / cag_dot(n, n), n);
  for (int i = 0; i < 3; i++)
    if (cag_dot(cag_cross(cag_sub(t[(i + 1) % 3], t[i]), cag_sub(p, t[i])), n) < 0) return false;
  return true;
}

// The point of the triangle nearest to p.
static inline CagVec3 cag_nearest_of_triangle(CagVec3 p, const CagVec3 t[3]) {
  CagVec3 best = t[0];
  if (cag_foot_in_triangle(p, t, &best)) return best;
  double least = INFINITY;
  for (int k = 0; k < 3; k++) {
    const CagVec3 q = cag_nearest_of_segment(p, t[k], t[(k + 1) % 3]);
    const CagVec3 off = cag_sub(q, p);
    if (!(cag_dot(off, off) < least)) continue;
    least = cag_dot(off, off);
    best = q;
  }
  return best;
}

#endif
