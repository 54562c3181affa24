// Rays against a parametric surface.
//
// The parameter rectangle is divided into cells over which the surface is smooth and bends little.
// A ray is solved for by Newton's method in each cell whose box it meets (Toth 1985; Martin, Cohen,
// Fish, and Shirley 2000). Where the normals of a cell are all on one side of the plane
// perpendicular to the ray, the cell has at most one crossing; elsewhere the search starts at
// several points.

#ifndef CAG_GEOM_RAY_RAY_PATCH_H
#define CAG_GEOM_RAY_RAY_PATCH_H

#include "geom/ray/bvh.h"
#include "geom/ray/ray.h"
#include "geom/ray/ray_outline.h"
#include "geom/surface/surface.h"

typedef struct CagRayCell {
  double from[2], to[2]; // [0]: u, [1]: v
  CagVec3 axis;          // of a cone that contains the normals
  double sine;           // of the half angle of the cone; 1 if it is unknown
} CagRayCell;

// What the points of a surface have in common.
typedef enum CagRayFlat {
  CAG_RAY_CURVED,
  CAG_RAY_PARALLELOGRAM, // origin + u x + v y
  CAG_RAY_PLANE          // origin + u x + v y, within the outline
} CagRayFlat;

typedef struct CagRayPatch {
  CagSurface *shape;      // retained
  CagSurface *surface;    // retained; the whole one of a trimmed surface
  CagRayOutline *outline; // in parameters; NULL: the whole rectangle
  CagRayFlat flat;
  CagVec3 origin, x, y; // of a flat one
  CagRayCell *cells;    // of a curved one
  size_t cell_count;
  CagBvh bvh; // of the cells
  CagBounds bounds;
  double size; // diagonal of the bounds
} CagRayPatch;

CagStatus cag_ray_patch_new(const CagSurface *s, CagRayPatch **out, CagError *err);
void cag_ray_patch_free(CagRayPatch *p); // p may be NULL
// Adds the crossings of the ray. One on the common edge of two cells may be there twice. With
// `first`, crossings behind another one may be missing.
CagStatus cag_ray_patch_meet(const CagRayPatch *p, const CagRay *ray, bool first, CagCrossings *out,
                             CagError *err);

#endif
