// Rays against rods: cylinders of one radius, with balls at their joints.

#ifndef CAG_GEOM_RAY_RAY_RODS_H
#define CAG_GEOM_RAY_RAY_RODS_H

#include "geom/ray/bvh.h"
#include "geom/ray/ray.h"

// A cylinder with flat ends, and a ball of its radius about its start. If the ends coincide, it is
// the ball only.
typedef struct CagRod {
  CagVec3 from, to;
  bool ball;
} CagRod;

// What is met: the `face` of a crossing.
enum { CAG_ROD_SIDE, CAG_ROD_BALL, CAG_ROD_END };

typedef struct CagRodForm CagRodForm;
typedef struct CagRayRods {
  double radius;
  CagRodForm *forms; // in the order of the hierarchy's leaves
  CagBvh bvh;
} CagRayRods;

// The rods are copied. radius > 0; n >= 0.
CagStatus cag_ray_rods_new(const CagRod *rods, size_t n, double radius, CagRayRods **out,
                           CagError *err);
void cag_ray_rods_free(CagRayRods *r); // r may be NULL

// The first crossing with the surface of any rod or ball, even inside of another. Returns false if
// there is none. u and v are NaN.
bool cag_ray_rods_first(const CagRayRods *r, const CagRay *ray, CagCrossing *out);
// Whether there is any crossing.
bool cag_ray_rods_blocks(const CagRayRods *r, const CagRay *ray);

#endif
