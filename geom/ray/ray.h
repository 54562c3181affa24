// Rays, and where they cross surfaces.

#ifndef CAG_GEOM_RAY_RAY_H
#define CAG_GEOM_RAY_RAY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "geom/linalg/vec.h"

// The points origin + t direction with least < t <= most.
typedef struct CagRay {
  CagVec3 origin, direction; // the direction has length 1
  double least, most;
} CagRay;

struct CagCaster;

// Where a ray crosses a surface.
typedef struct CagCrossing {
  double t;
  CagVec3 normal;               // unit, of the surface there: outward for solids
  double u, v;                  // parameters of the surface; of a mesh without parameters, NaN
  uint32_t face;                // index of the face of a solid, or of the triangle of a mesh
  uint32_t label;               // of the solid or the triangle: see mesh.h
  int sign;                     // 1: along the normal, out of a solid; -1: against it; 0: touches
  bool angular[2];              // whether u and v are angles
  bool flipped;                 // the normal is opposite to that of the part, which is subtracted
  float weight[2];              // of corners 1 and 2 of the triangle, if the surface is a mesh
  const struct CagCaster *part; // what is met: of a set operation, the operand; NULL: unknown
} CagCrossing;

// A growing list of crossings. {0} is empty.
typedef struct CagCrossings {
  CagCrossing *items;
  size_t n, capacity;
} CagCrossings;

// Adds an uninitialized crossing. Returns NULL if memory is out.
CagCrossing *cag_crossings_add(CagCrossings *list, CagError *err);
void cag_crossings_sort(CagCrossings *list); // by t; a stable sort
void cag_crossings_free(CagCrossings *list);

static inline CagVec3 cag_ray_point(const CagRay *r, double t) {
  return cag_madd(r->origin, t, r->direction);
}

#endif
