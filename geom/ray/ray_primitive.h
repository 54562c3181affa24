// Rays and points against boxes, spheres, cylinders, cones, tori, and quadratic forms.

#ifndef CAG_GEOM_RAY_RAY_PRIMITIVE_H
#define CAG_GEOM_RAY_RAY_PRIMITIVE_H

#include "geom/ray/ray.h"
#include "geom/solid/solid.h"

typedef struct CagRayPrimitive {
  CagSolid *solid;              // retained; its sizes, in its own coordinates
  CagTransform placement, back; // from its own coordinates to the world, and back; affine
} CagRayPrimitive;

// Whether the solid is of a kind that has equations here.
bool cag_ray_primitive_can(const CagSolid *s);
// `placement` maps the solid's own coordinates to the world; affine.
CagStatus cag_ray_primitive_set(CagRayPrimitive *p, const CagSolid *s,
                                const CagTransform *placement, CagError *err);
void cag_ray_primitive_free(CagRayPrimitive *p);              // also of a zeroed one
CagBounds cag_ray_primitive_bounds(const CagRayPrimitive *p); // in its own coordinates
// Adds the crossings of the whole line, which alternate. Their parameters are not set.
CagStatus cag_ray_primitive_meet(const CagRayPrimitive *p, const CagRay *line, CagCrossings *out,
                                 CagError *err);
// Sets the parameters u and v of a crossing on its face of the solid.
void cag_ray_primitive_parameters(const CagRayPrimitive *p, const CagRay *ray, CagCrossing *c);
// The point of the boundary nearest to `at`. Returns false for cylinders, cones, and tori that are
// not placed by a similarity.
bool cag_ray_primitive_closest(const CagRayPrimitive *p, CagVec3 at, CagVec3 *out);
// The side that p is on: -1 inside, 1 outside, 0 within `slack` of the boundary.
int cag_ray_primitive_side(const CagRayPrimitive *p, CagVec3 at, double slack);

// The same for the points at which a form is negative.
int cag_ray_form_side(const CagQuadric *form, CagVec3 p, double slack);

// The real roots of a t^2 + b t + c in ascending order, without a double one, which does not change
// the sign. Returns their number. The smaller root is not computed by a difference.
int cag_ray_quadratic(double a, double b, double c, double roots[2]);

#endif
