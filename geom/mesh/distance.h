// Distances from a point to a segment and to a triangle of space.

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

// Also of triangles that are a segment or a point.
static inline double cag_distance_to_triangle(CagVec3 p, CagVec3 a, CagVec3 b, CagVec3 c) {
  CagVec3 n = cag_cross(cag_sub(b, a), cag_sub(c, a));
  double area2 = cag_dot(n, n);
  bool inside = area2 > 0 && cag_dot(cag_cross(cag_sub(b, a), cag_sub(p, a)), n) >= 0 &&
                cag_dot(cag_cross(cag_sub(c, b), cag_sub(p, b)), n) >= 0 &&
                cag_dot(cag_cross(cag_sub(a, c), cag_sub(p, c)), n) >= 0;
  if (inside) return fabs(cag_dot(cag_sub(p, a), n)) / sqrt(area2);
  return fmin(cag_distance_to_segment(p, a, b),
              fmin(cag_distance_to_segment(p, b, c), cag_distance_to_segment(p, c, a)));
}

#endif
