// Points and vectors in space.

#ifndef CAG_GEOM_VEC_H
#define CAG_GEOM_VEC_H

#include <math.h>

typedef struct CagVec3 {
  double x, y, z;
} CagVec3;

static inline CagVec3 cag_vec3(double x, double y, double z) { return (CagVec3){x, y, z}; }
static inline CagVec3 cag_add(CagVec3 a, CagVec3 b) {
  return (CagVec3){a.x + b.x, a.y + b.y, a.z + b.z};
}
static inline CagVec3 cag_sub(CagVec3 a, CagVec3 b) {
  return (CagVec3){a.x - b.x, a.y - b.y, a.z - b.z};
}
static inline CagVec3 cag_scaled(CagVec3 a, double s) {
  return (CagVec3){a.x * s, a.y * s, a.z * s};
}
// a + s b
static inline CagVec3 cag_madd(CagVec3 a, double s, CagVec3 b) {
  return (CagVec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}
static inline double cag_dot(CagVec3 a, CagVec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline CagVec3 cag_cross(CagVec3 a, CagVec3 b) {
  return (CagVec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline double cag_norm(CagVec3 a) { return sqrt(cag_dot(a, a)); }
static inline CagVec3 cag_lerp(CagVec3 a, CagVec3 b, double t) {
  return cag_madd(a, t, cag_sub(b, a));
}
// Unit vector; the zero vector stays zero.
static inline CagVec3 cag_unit(CagVec3 a) {
  double n = cag_norm(a);
  return n > 0 ? cag_scaled(a, 1 / n) : a;
}

// Axis-aligned box; empty while min > max.
typedef struct CagBounds {
  CagVec3 min, max;
} CagBounds;

#define CAG_BOUNDS_EMPTY                                                                           \
  ((CagBounds){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}})
static inline void cag_bounds_add(CagBounds *b, CagVec3 p) {
  b->min = (CagVec3){fmin(b->min.x, p.x), fmin(b->min.y, p.y), fmin(b->min.z, p.z)};
  b->max = (CagVec3){fmax(b->max.x, p.x), fmax(b->max.y, p.y), fmax(b->max.z, p.z)};
}

#endif
