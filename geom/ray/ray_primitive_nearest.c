// The points of boxes, spheres, cylinders, cones, and tori nearest to a point, in closed form. They
// are found in the solid's own coordinates, which similarities preserve; boxes are found by their
// faces, and ellipsoids by their equation, under all affine maps.

#include "geom/mesh/distance.h"
#include "geom/ray/ray_primitive.h"
#include "geom/surface/quadric_nearest.h"

static CagVec3 closest_of_box(CagVec3 low, CagVec3 high, CagVec3 p) {
  const double lo[3] = {low.x, low.y, low.z}, hi[3] = {high.x, high.y, high.z};
  double x[3] = {p.x, p.y, p.z}, least = INFINITY, to = 0;
  bool inside = true;
  int axis = 0;
  for (int k = 0; k < 3; k++) {
    const double below = x[k] - lo[k], above = hi[k] - x[k];
    inside = inside && below > 0 && above > 0;
    if (fmin(below, above) < least) {
      least = fmin(below, above);
      axis = k;
      to = below < above ? lo[k] : hi[k];
    }
    x[k] = fmin(fmax(x[k], lo[k]), hi[k]);
  }
  if (inside) x[axis] = to;
  return cag_vec3(x[0], x[1], x[2]);
}

// A unit vector from the axis toward p in the plane z = 0.
static CagVec3 outward(CagVec3 p) {
  const double rho = hypot(p.x, p.y);
  return rho > 0 ? cag_vec3(p.x / rho, p.y / rho, 0) : cag_vec3(1, 0, 0);
}

// The section of a cylinder or cone by a half plane through its axis is a polygon with one side on
// the axis; the others are the boundary.
static CagVec3 closest_of_frustum(const CagSolid *s, CagVec3 p) {
  const CagVec3 q = {hypot(p.x, p.y), p.z, 0};
  const CagVec3 corner[4] = {{0, 0, 0}, {s->b, 0, 0}, {s->c, s->a, 0}, {0, s->a, 0}};
  CagVec3 best = corner[0];
  double least = INFINITY;
  for (int k = 0; k < 3; k++) {
    const CagVec3 found = cag_nearest_of_segment(q, corner[k], corner[k + 1]);
    const double distance = cag_norm(cag_sub(found, q));
    if (!(distance < least)) continue;
    least = distance;
    best = found;
  }
  const CagVec3 out = outward(p);
  return cag_vec3(best.x * out.x, best.x * out.y, best.y);
}

static CagVec3 closest_of_torus(const CagSolid *s, CagVec3 p) {
  const CagVec3 out = outward(p), center = cag_scaled(out, s->a), off = cag_sub(p, center);
  const double distance = cag_norm(off);
  return distance > 0 ? cag_madd(center, s->b / distance, off) : cag_madd(center, s->b, out);
}

static CagVec3 closest_of_sphere(const CagSolid *s, CagVec3 p) {
  const double distance = cag_norm(p);
  return distance > 0 ? cag_scaled(p, s->a / distance) : cag_vec3(s->a, 0, 0);
}

// --- Other affine maps ---

// The closest of the triangles that divide the faces of a parallelepiped.
static CagVec3 closest_of_sheared_box(const CagTransform *t, CagVec3 low, CagVec3 high, CagVec3 p) {
  CagVec3 corner[8], best = p;
  double least = INFINITY;
  for (int k = 0; k < 8; k++)
    corner[k] = cag_transform_point(
        t, cag_vec3(k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z));
  for (int face = 0; face < 6; face++) {
    const int axis = face / 2, a = 1 << (axis + 1) % 3, b = 1 << (axis + 2) % 3;
    const int from = face % 2 ? 1 << axis : 0;
    for (int half = 0; half < 2; half++) {
      const CagVec3 triangle[3] = {corner[from], corner[from + a + b],
                                   corner[half ? from + b : from + a]};
      const CagVec3 found = cag_nearest_of_triangle(p, triangle);
      const double distance = cag_norm(cag_sub(found, p));
      if (!(distance < least)) continue;
      least = distance;
      best = found;
    }
  }
  return best;
}

static bool closest_of_ellipsoid(const CagRayPrimitive *p, CagVec3 at, CagVec3 *out) {
  const double r = p->solid->a;
  const CagQuadric sphere = {.c = {1, 1, 1, 0, 0, 0, 0, 0, 0, -r * r}};
  CagQuadric form;
  CagError err;
  return !cag_quadric_transform(&sphere, &p->placement, &form, &err) &&
         cag_quadric_closest(&form, at, out);
}

bool cag_ray_primitive_closest(const CagRayPrimitive *p, CagVec3 at, CagVec3 *out) {
  const CagSolid *s = p->solid;
  const CagBounds b = cag_ray_primitive_bounds(p);
  double scale;
  if (!cag_transform_is_similarity(&p->placement, &scale)) {
    if (s->kind == CAG_SOLID_SPHERE) return closest_of_ellipsoid(p, at, out);
    if (s->kind != CAG_SOLID_BOX) return false;
    *out = closest_of_sheared_box(&p->placement, b.min, b.max, at);
    return true;
  }
  const CagVec3 own = cag_transform_point(&p->back, at);
  const CagVec3 found = s->kind == CAG_SOLID_BOX      ? closest_of_box(b.min, b.max, own)
                        : s->kind == CAG_SOLID_SPHERE ? closest_of_sphere(s, own)
                        : s->kind == CAG_SOLID_TORUS  ? closest_of_torus(s, own)
                                                      : closest_of_frustum(s, own);
  *out = cag_transform_point(&p->placement, found);
  return true;
}
