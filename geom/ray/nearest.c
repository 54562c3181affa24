#include "geom/ray/nearest.h"

#include "base/stop.h"
#include "geom/linalg/tolerance.h"
#include "geom/ray/bvh_walk.h"
#include "geom/ray/caster_parts.h"
#include "geom/surface/nearest.h"
#include "geom/surface/quadric_nearest.h"

// A point on the boundary of a set operation has its inside and its outside at this distance, as a
// fraction of the size, on both sides.
#define BESIDE 1e-6
// Points closer to the boundary than this fraction of the size are on it.
#define ON_BOUNDARY 1e-9

double cag_bounds_distance(const CagBounds *b, CagVec3 p) {
  const double x = fmax(0, fmax(b->min.x - p.x, p.x - b->max.x));
  const double y = fmax(0, fmax(b->min.y - p.y, p.y - b->max.y));
  const double z = fmax(0, fmax(b->min.z - p.z, p.z - b->max.z));
  return cag_norm(cag_vec3(x, y, z));
}

// Keeps a point if it is the closest one so far.
static void offer_point(CagNearest *best, CagVec3 p, CagVec3 point) {
  const double distance = cag_norm(cag_sub(point, p));
  if (distance < best->distance || (!best->found && distance == best->distance))
    *best = (CagNearest){true, true, distance, point};
}

// --- Faces ---

static CagStatus offer_surface(CagNearest *best, const CagSurface *s, CagVec3 p, CagError *err) {
  CagSurfaceNearest found;
  CagStatus status = cag_stop_check(err);
  if (!status) status = cag_surface_closest(s, p, &found, err);
  if (!status) offer_point(best, p, found.point);
  return status;
}

// The face with the closest box comes first, so that most others are skipped.
static CagStatus closest_of_faces(const CagCaster *c, CagVec3 p, CagNearest *best, CagError *err) {
  size_t first = 0;
  double least = INFINITY;
  for (size_t i = 0; i < c->face_count; i++) {
    const double distance = cag_bounds_distance(&c->faces[i]->bounds, p);
    if (distance >= least) continue;
    least = distance;
    first = i;
  }
  CagStatus status = CAG_OK;
  for (size_t k = 0; !status && k < c->face_count; k++) {
    const size_t i = k == 0 ? first : k <= first ? k - 1 : k;
    if (cag_bounds_distance(&c->faces[i]->bounds, p) > best->distance) continue;
    status = offer_surface(best, c->faces[i]->shape, p, err);
  }
  return status;
}

// --- Placed parts ---

static CagVec3 to_world(const CagCaster *c, CagVec3 own) {
  CagTransform placement;
  CagError err;
  return cag_transform_inverse(&c->back, &placement, &err) ? own
                                                           : cag_transform_point(&placement, own);
}

// FACES and meshes, in their own coordinates.
static CagStatus closest_of_parts(const CagCaster *c, CagVec3 p, CagNearest *best, CagError *err) {
  double scale = 1;
  if (c->placed) cag_transform_is_similarity(&c->back, &scale);
  const CagVec3 own = c->placed ? cag_transform_point(&c->back, p) : p;
  CagNearest found = {.distance = best->distance * scale};
  CagStatus status = CAG_OK;
  uint32_t face;
  if (c->kind == CAG_CASTER_MESH) {
    found.found = cag_ray_mesh_closest(c->mesh, own, found.distance, &found.point, &face);
  } else status = closest_of_faces(c, own, &found, err);
  if (!status && found.found)
    offer_point(best, p, c->placed ? to_world(c, found.point) : found.point);
  return status;
}

// --- Set operations ---

static CagStatus closest_boundary(const CagCaster *c, CagVec3 p, CagCrossings *work,
                                  CagNearest *best, CagError *err);

static CagStatus closest_of_operands(const CagCaster *c, CagVec3 p, CagCrossings *work,
                                     CagNearest *best, CagError *err) {
  CagStatus status = CAG_OK;
  if (c->boxes.item_count == 0) {
    for (size_t i = 0; !status && i < c->operand_count; i++)
      status = closest_boundary(c->operands[i], p, work, best, err);
    return status;
  }
  const CagVec3 local = cag_sub(p, c->boxes.origin);
  const double slack = CAG_BVH_SLACK * (cag_norm(local) + c->boxes.radius);
  const float at[3] = {(float)local.x, (float)local.y, (float)local.z};
  CagBvhWalk walk;
  size_t first, count;
  cag_bvh_start(&c->boxes, &walk);
  for (;;) {
    const double reach = best->distance + slack;
    if (status || !cag_bvh_near(&c->boxes, at, reach * reach, &walk, &first, &count)) return status;
    for (size_t k = first; !status && k < first + count; k++)
      status = closest_boundary(c->operands[c->boxes.order[k]], p, work, best, err);
  }
}

// Whether a point is on the boundary of one operand only, and so on that of the result if the others
// do not hide it.
static CagStatus is_on_one_operand(const CagCaster *c, CagVec3 p, double slack, CagCrossings *work,
                                   bool *on, CagError *err) {
  size_t touched = 0;
  int side;
  CagStatus status = cag_caster_side(c, p, slack, work, &side, err);
  *on = false;
  for (size_t i = 0; !status && side == 0 && touched < 2 && i < c->operand_count; i++) {
    int one;
    status = cag_caster_side(c->operands[i], p, slack, work, &one, err);
    touched += one == 0;
  }
  *on = touched == 1;
  return status;
}

CagStatus cag_operation_ends_at(const CagCaster *c, CagVec3 p, const CagNearest *found,
                                CagCrossings *work, bool *on, CagError *err) {
  const double scale = c->size > 0 ? c->size : cag_norm(p) + found->distance;
  int side[2] = {0, 0};
  CagStatus status;
  *on = false;
  if (found->distance <= ON_BOUNDARY * scale)
    return is_on_one_operand(c, found->point, ON_BOUNDARY * scale, work, on, err);
  const CagVec3 way = cag_scaled(cag_sub(p, found->point), 1 / found->distance);
  const double by = fmin(BESIDE * scale, found->distance / 2);
  status = cag_caster_side(c, cag_madd(found->point, by, way), 0, work, &side[0], err);
  if (!status)
    status = cag_caster_side(c, cag_madd(found->point, -by, way), 0, work, &side[1], err);
  *on = side[0] * side[1] < 0;
  return status;
}

// Whether the point of the operands' boundaries that is closest to p is on that of the result.
static CagStatus is_closest_on_boundary(const CagCaster *c, CagVec3 p, const CagNearest *found,
                                        CagCrossings *work, bool *on, CagError *err) {
  const double scale = c->size > 0 ? c->size : cag_norm(p) + found->distance;
  int side = 0;
  if (c->operation == CAG_SOLID_UNION) {
    CagStatus status = cag_caster_side(c, p, ON_BOUNDARY * scale, work, &side, err);
    *on = true;
    if (status || side > 0) return status; // from outside, no operand is closer
  }
  return cag_operation_ends_at(c, p, found, work, on, err);
}

static CagStatus closest_of_operation(const CagCaster *c, CagVec3 p, CagCrossings *work,
                                      CagNearest *best, CagError *err) {
  CagNearest found = {.distance = best->distance};
  CagStatus status = closest_of_operands(c, p, work, &found, err);
  if (status || !found.found) return status;
  bool on = found.certain;
  if (on) status = is_closest_on_boundary(c, p, &found, work, &on, err);
  found.certain = on;
  *best = found;
  return status;
}

// --- All kinds ---

// Improves the best point. What is not certain replaces it if its bound is less.
static CagStatus closest_boundary(const CagCaster *c, CagVec3 p, CagCrossings *work,
                                  CagNearest *best, CagError *err) {
  CagVec3 point;
  CagStatus status = cag_stop_check(err);
  if (status) return status;
  if (c->kind != CAG_CASTER_FORM && cag_bounds_distance(&c->bounds, p) > best->distance)
    return CAG_OK;
  switch (c->kind) {
  case CAG_CASTER_PRIMITIVE:
    if (!c->image) {
      if (cag_ray_primitive_closest(&c->primitive, p, &point)) offer_point(best, p, point);
      return CAG_OK;
    }
    for (size_t i = 0; !status && i < c->image->face_count; i++)
      status = offer_surface(best, c->image->faces[i], p, err);
    return status;
  case CAG_CASTER_FORM:
    if (cag_quadric_closest(&c->form, p, &point)) offer_point(best, p, point);
    return CAG_OK;
  case CAG_CASTER_OPERATION: return closest_of_operation(c, p, work, best, err);
  default: return closest_of_parts(c, p, best, err);
  }
}

CagStatus cag_caster_closest(const CagCaster *c, CagVec3 p, double most, CagCrossings *work,
                             CagNearest *out, CagError *err) {
  *out = (CagNearest){.distance = most};
  return closest_boundary(c, p, work, out, err);
}
