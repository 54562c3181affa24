// Distances of shapes, and their nearest points.

#include "interp/builtin/distances.h"

#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/distance/separation.h"
#include "geom/solid/convex_list.h"
#include "geom/solid/csg.h"
#include "geom/surface/curve_on.h"
#include "interp/builtin/hulls.h"
#include "interp/builtin/shapes.h"
#include "interp/builtin/surfaces.h"
#include "interp/builtin/targets.h"
#include "interp/vm/memo.h"
#include "interp/vm/vm.h"

// Shapes closer than this fraction of their size meet (see separation.c).
#define TOUCHING 1e-10
// Locations on meshes are one if they are closer than this multiple of the geometric mean of the
// margin and the size. Over that distance, round shapes become farther apart by the margin.
#define APART 4.0
// The tolerance of the meshes of curved surfaces, as a fraction of their size. They are only where
// the search on the surface starts.
#define CURVED_TOLERANCE 1e-3

// --- Bodies ---

// Shapes as convex bodies, and as parts: those that are unions of convex bodies, and all others. It
// also owns the curves and solids created for it.
typedef struct Body {
  CagConvexList convex;
  CagParts convex_parts; // of the same shapes, made when they are needed
  CagParts parts;        // of the other shapes
  CagParts *into;        // the ones that are being filled
  CagCurveList curves;
  CagSolid **solids; // operands of unions
  size_t solid_count;
  const CagList *shapes; // NULL: a point
  bool *is_convex;       // of each shape
  size_t *first;         // of each other shape: its first part, or SIZE_MAX if it has none
  CagBounds bounds;
  double tolerance; // of meshes
  bool is_rough;    // some parts are only a mesh of the shape
} Body;

static void body_free(void *body) {
  Body *b = body;
  cag_curve_list_free(&b->curves);
  for (size_t i = 0; i < b->solid_count; i++) cag_solid_release(b->solids[i]);
  cag_free(b->solids);
  cag_convex_list_free(&b->convex);
  cag_parts_free(&b->convex_parts);
  cag_parts_free(&b->parts);
  cag_free(b->is_convex);
  cag_free(b->first);
  cag_free(b);
}

static double body_size(const Body *b) { return cag_norm(cag_sub(b->bounds.max, b->bounds.min)); }

static CagStatus body_add_curve(Body *b, const CagCurve *c, double tolerance, CagError *err) {
  CagStatus status = cag_curve_list_add(&b->curves, cag_curve_retain(c), err);
  return status ? status : cag_parts_add_curve(b->into, c, tolerance, err);
}

static CagStatus body_add_surface(const CagVm *vm, Body *b, const CagSurface *s, double tolerance,
                                  CagError *err) {
  const bool flat = cag_surface_planar_view(s, NULL, NULL);
  CagMesh *m = NULL;
  CagBounds box;
  CagStatus status = CAG_OK;
  if (!flat) status = cag_surface_bounds(s, &box, err);
  if (status) return status;
  if (!flat) tolerance = CURVED_TOLERANCE * cag_norm(cag_sub(box.max, box.min));
  const CagTessellation how = cag_shape_tessellation(vm, tolerance);
  status = cag_surface_tessellate(s, &how, &m, err);
  if (!status) status = cag_parts_add_mesh(b->into, m, flat ? NULL : s, tolerance, err);
  cag_mesh_release(m);
  return status;
}

// Adds the inside of a region as triangles, and its edges exactly.
static CagStatus body_add_region(const CagVm *vm, Body *b, const CagRegion *r,
                                 const CagTransform *place, double tolerance, CagError *err) {
  CagSurface *flat;
  CagStatus status = cag_surface_planar(r, place, &flat, err);
  if (status) return status;
  status = body_add_surface(vm, b, flat, tolerance, err);
  cag_surface_release(flat);
  for (size_t i = 0; !status && i < r->count; i++) {
    CagCurve *loop;
    status = cag_curve_transform(r->loops[i], place, &loop, err);
    if (status) break;
    status = body_add_curve(b, loop, tolerance, err);
    cag_curve_release(loop);
  }
  return status;
}

static CagStatus body_add_face(const CagVm *vm, Body *b, const CagSurface *face, double tolerance,
                               CagError *err) {
  const CagRegion *region;
  CagTransform frame;
  return cag_surface_planar_view(face, &region, &frame)
             ? body_add_region(vm, b, region, &frame, tolerance, err)
             : body_add_surface(vm, b, face, tolerance, err);
}

// The distance from bodies bounded by meshes is that from their triangles. That from set operations
// starts from theirs.
static CagStatus body_add_compound(const CagVm *vm, Body *b, const CagSolid *s, double tolerance,
                                   CagError *err) {
  const CagTessellation how = cag_shape_tessellation(vm, tolerance);
  CagMesh *m = NULL;
  CagStatus status = cag_solid_tessellate(s, &how, &m, err);
  b->is_rough = b->is_rough || s->kind != CAG_SOLID_MESH;
  if (!status) status = cag_parts_add_mesh(b->into, m, NULL, 0, err);
  cag_mesh_release(m);
  return status;
}

// The faces of a box as triangles, in any order.
static CagStatus body_add_box(Body *b, const CagSolid *s, CagError *err) {
  static const int faces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                  {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
  const CagVec3 size = cag_vec3(s->a, s->b, s->c);
  const CagVec3 low = s->centered ? cag_scaled(size, -0.5) : cag_vec3(0, 0, 0);
  CagVec3 corner[8];
  for (int k = 0; k < 8; k++)
    corner[k] = cag_transform_point(&s->placement, cag_vec3(low.x + (k & 1 ? size.x : 0),
                                                            low.y + (k & 2 ? size.y : 0),
                                                            low.z + (k & 4 ? size.z : 0)));
  CagStatus status = CAG_OK;
  for (int k = 0; !status && k < 12; k++) {
    const int *face = faces[k / 2];
    const CagVec3 triangle[3] = {corner[face[0]], corner[face[1 + k % 2]], corner[face[2 + k % 2]]};
    status = cag_parts_add_triangle(b->into, triangle, err);
  }
  return status;
}

static CagStatus body_add_solid(const CagVm *vm, Body *b, const CagSolid *s, double tolerance,
                                CagError *err);

// The points of the operands' surfaces that are inside of the union are not closer to anything
// outside.
static CagStatus body_add_union(const CagVm *vm, Body *b, const CagSolid *s, double tolerance,
                                CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < s->core->count; i++) {
    CagSolid *moved;
    if (!CAG_RESIZE(b->solids, b->solid_count + 1)) return cag_fail_memory(err);
    status = cag_solid_transform(s->core->operands[i], &s->placement, &moved, err);
    if (status) return status;
    b->solids[b->solid_count++] = moved;
    status = body_add_solid(vm, b, moved, tolerance, err);
  }
  return status;
}

static CagStatus body_add_solid(const CagVm *vm, Body *b, const CagSolid *s, double tolerance,
                                CagError *err) {
  CagStatus status = CAG_OK;
  if (s->kind == CAG_SOLID_BOX && cag_transform_is_affine(&s->placement))
    return body_add_box(b, s, err);
  if (s->kind == CAG_SOLID_UNION) return body_add_union(vm, b, s, tolerance, err);
  if (cag_solid_is_compound(s)) return body_add_compound(vm, b, s, tolerance, err);
  for (size_t i = 0; !status && i < s->face_count; i++)
    status = body_add_face(vm, b, s->faces[i], tolerance, err);
  return status;
}

// An empty shape adds nothing.
static CagStatus body_add_shape(const CagVm *vm, Body *b, CagValue v, double tolerance,
                                CagError *err) {
  const CagShape *shape = CAG_AS_SHAPE(v);
  if (v.type == CAG_REGION && cag_region_is_empty(shape->as.region)) return CAG_OK;
  switch (v.type) {
  case CAG_CURVE: return body_add_curve(b, shape->as.curve, tolerance, err);
  case CAG_REGION:
    return body_add_region(vm, b, shape->as.region, shape->placement, tolerance, err);
  case CAG_SURFACE: return body_add_face(vm, b, shape->as.surface, tolerance, err);
  case CAG_MESH: return cag_parts_add_mesh(b->into, shape->as.mesh, NULL, 0, err);
  case CAG_LABEL: return cag_parts_add_point(b->into, shape->as.label->at, err);
  default: return body_add_solid(vm, b, shape->as.solid, tolerance, err);
  }
}

static CagStatus fill_body(CagVm *vm, Body *b, CagError *err) {
  CagStatus status = CAG_OK;
  const size_t n = b->shapes->length;
  b->first = cag_malloc((n + 1) * sizeof *b->first);
  b->is_convex = cag_calloc(n + 1, sizeof *b->is_convex);
  if (!b->first || !b->is_convex) return cag_fail_memory(err);
  b->into = &b->parts;
  for (size_t i = 0; !status && i < n; i++) {
    const CagValue v = cag_list_get(vm, b->shapes, i);
    const size_t known = b->parts.n;
    b->first[i] = SIZE_MAX;
    if (v.type == CAG_SOLID)
      status = cag_solid_add_convex(CAG_AS_SHAPE(v)->as.solid, &b->convex, &b->is_convex[i], err);
    if (status || b->is_convex[i]) continue;
    status = body_add_shape(vm, b, v, b->tolerance, err);
    if (b->parts.n > known) b->first[i] = known;
  }
  return status;
}

// Makes the parts of the shapes that are unions of convex bodies.
static CagStatus need_convex_parts(CagVm *vm, Body *b, CagError *err) {
  CagStatus status = CAG_OK;
  if (b->convex_parts.n > 0) return CAG_OK;
  b->into = &b->convex_parts;
  for (size_t i = 0; !status && b->shapes && i < b->shapes->length; i++)
    if (b->is_convex[i])
      status = body_add_shape(vm, b, cag_list_get(vm, b->shapes, i), b->tolerance, err);
  return status;
}

// Makes the body of shapes, or of a point.
static bool make_body(CagCall *call, int argument, Body **out, CagValue *held) {
  const CagValue v = call->values[argument];
  CagBounds box;
  CagVec3 p;
  int dimension;
  Body *b = cag_hold_array(call, 1, sizeof *b);
  cag_give_held(call, b);
  cag_hold_for(call, body_free, b);
  *held = cag_unset();
  if (!cag_is_shape(v) && !cag_is_list_of_shapes(call->vm, v)) {
    if (!cag_arg_vec(call, argument, &p, NULL) ||
        !cag_geometry_ok(call, cag_parts_add_point(&b->parts, p, call->err)))
      return false;
    b->bounds = (CagBounds){p, p};
    *out = b;
    return true;
  }
  CagBuilder *builder = cag_builder_new(call->vm);
  if (!cag_shapes_collect(call, v, builder)) return false;
  *held = cag_builder_finish(call->vm, builder);
  b->shapes = CAG_AS_LIST(*held);
  if (!cag_value_bounds(call, v, &box, &dimension)) return false;
  b->bounds = box;
  b->tolerance = CAG_SHAPE_TOLERANCE * cag_norm(cag_sub(box.max, box.min));
  *out = b;
  return cag_geometry_ok(call, fill_body(call->vm, b, call->err));
}

// The body of an argument, which the machine keeps for the next call with the same value.
static bool find_body(CagCall *call, int argument, Body **out) {
  const CagValue v = call->values[argument];
  const bool shapes = cag_is_shape(v) || cag_is_list_of_shapes(call->vm, v);
  *out = shapes ? cag_memo_find(call, v.as.object, body_free) : NULL;
  if (*out) return true;
  const size_t before = call->vm->account.used;
  CagValue held;
  if (!make_body(call, argument, out, &held)) return false;
  if (!shapes) return true;
  cag_give_held(call, *out);
  cag_memo_keep(call, v.as.object, held, *out, body_free, before);
  return true;
}

// --- Distances ---

static bool is_in_bounds(const CagBounds *b, CagVec3 p) {
  return p.x >= b->min.x && p.x <= b->max.x && p.y >= b->min.y && p.y <= b->max.y &&
         p.z >= b->min.z && p.z <= b->max.z;
}

static bool shape_encloses(CagCall *call, CagValue v, const Body *outer, CagVec3 p, bool *yes) {
  bool body;
  return !is_in_bounds(&outer->bounds, p) || cag_shape_holds(call, v, p, yes, &body);
}

// Whether a shape of `outer` contains one of `inner`, and a point of the latter. The surfaces do not
// meet, so one point of each decides. If the distance of convex bodies is certain, it is 0 already for those that contain
// each other.
static bool encloses(CagCall *call, const Body *outer, const Body *inner, bool certain, bool *yes,
                     CagVec3 *at) {
  const size_t inner_count = inner->shapes ? inner->shapes->length : 1;
  for (size_t i = 0; !*yes && outer->shapes && i < outer->shapes->length; i++) {
    const CagValue v = cag_list_get(call->vm, outer->shapes, i);
    if (v.type != CAG_SOLID && v.type != CAG_MESH) continue;
    for (size_t k = 0; !*yes && k < inner_count; k++) {
      const size_t first = inner->first ? inner->first[k] : 0;
      if (first >= inner->parts.n) continue;
      *at = inner->parts.items[first].p[0];
      if (!shape_encloses(call, v, outer, *at, yes)) return false;
    }
    for (size_t k = 0; !*yes && !(certain && outer->is_convex[i]) && k < inner->convex.n; k++) {
      *at = cag_convex_point(&inner->convex.items[k]);
      if (!shape_encloses(call, v, outer, *at, yes)) return false;
    }
  }
  return true;
}

// A distance, and locations on the meshes of set operations at which the exact shapes may be closer.
typedef struct Nearest {
  CagClosest closest;   // without these
  double margin, apart; // of the locations (see separation.h); 0 without such meshes
  double rough;         // the least distance of the meshes
  size_t n;
  CagPartsNear near[4]; // of the pairs of parts
} Nearest;

static void keep_closest(CagClosest *best, double distance, const CagVec3 points[2]) {
  if (distance >= best->distance) return;
  best->distance = distance;
  memcpy(best->points, points, sizeof best->points);
}

// Lowers the distance to that of the parts, if both have some.
static CagStatus parts_distance(CagVm *vm, CagParts *a, CagParts *b, Nearest *best, CagError *err) {
  const volatile int *stop = cag_vm_stop(vm);
  double found;
  CagVec3 points[2];
  CagStatus status = CAG_OK;
  if (a->n == 0 || b->n == 0 || best->closest.distance == 0) return CAG_OK;
  if (best->margin == 0) {
    status = cag_parts_distance(a, b, CAG_PARTS_PAIRS, &found, points, stop, err);
    if (!status) keep_closest(&best->closest, found, points);
    return status;
  }
  CagPartsNear *near = &best->near[best->n];
  *near = (CagPartsNear){.margin = best->margin, .apart = best->apart};
  status = cag_parts_near(a, b, CAG_PARTS_PAIRS, &found, near, stop, err);
  if (status) return status;
  best->rough = fmin(best->rough, found);
  best->n++;
  return CAG_OK;
}

// The distance of the surfaces, and of convex bodies, unless *certain is false: then it is that of
// their surfaces too. Fails if a body has no shapes.
static CagStatus surface_distance(CagVm *vm, Body *a, Body *b, Nearest *out, bool *certain,
                                  CagError *err) {
  CagStatus status = CAG_OK;
  CagClosest *closest = &out->closest;
  *out = (Nearest){.closest = {.distance = INFINITY}, .rough = INFINITY};
  if ((a->is_rough || b->is_rough) && a->shapes && b->shapes) {
    out->margin = 2 * (a->tolerance + b->tolerance);
    out->apart = APART * sqrt(out->margin * (body_size(a) + body_size(b)));
  }
  *certain = true;
  if (a->convex.n > 0 && b->convex.n > 0)
    status = cag_convex_list_distance(&a->convex, &b->convex, &closest->distance, closest->points,
                                      certain, err);
  if (!status && a->convex.n > 0 && (b->parts.n > 0 || !*certain))
    status = need_convex_parts(vm, a, err);
  if (!status && b->convex.n > 0 && (a->parts.n > 0 || !*certain))
    status = need_convex_parts(vm, b, err);
  if (!status) status = parts_distance(vm, &a->parts, &b->parts, out, err);
  if (!status) status = parts_distance(vm, &a->convex_parts, &b->parts, out, err);
  if (!status) status = parts_distance(vm, &a->parts, &b->convex_parts, out, err);
  if (!status && !*certain)
    status = parts_distance(vm, &a->convex_parts, &b->convex_parts, out, err);
  if (status || isfinite(closest->distance) || out->n > 0) return status;
  return cag_parts_distance(&a->parts, &b->parts, CAG_PARTS_PAIRS, &closest->distance,
                            closest->points, cag_vm_stop(vm), err);
}

// --- Exact set operations ---

// The search for the closest points of set operations ends after this many steps, or if they move
// by less than this fraction of the size of both. For points, the error is not squared.
enum { POLISH_STEPS = 60 };
#define POLISHED 1e-10
#define POLISHED_POINTS 1e-14

// Two points on the exact shapes, each the closest one to the point of the other shape before it.
typedef struct Polish {
  const CagTarget *targets[2];
  double distance;
  CagVec3 points[2];
} Polish;

// The points that are reached by going from a point of the first shape to the second one and back.
// The distance is 0 if a point is inside of the other shape.
static bool polish_from(CagCall *call, const Polish *p, CagVec3 start, Polish *out) {
  CagTargetNearest there, back;
  *out = *p;
  if (!cag_target_closest(call, p->targets[1], start, INFINITY, &there) ||
      !cag_target_closest(call, p->targets[0], there.point, INFINITY, &back))
    return false;
  out->points[1] = there.point;
  out->points[0] = back.point;
  out->distance = there.found && back.found ? back.distance : 0;
  return true;
}

// Where steps end that all shrink in the same ratio (Anderson 1965, with the last two steps).
static CagVec3 limit_of_steps(CagVec3 before, CagVec3 at, CagVec3 next) {
  const CagVec3 first = cag_sub(at, before), second = cag_sub(next, at);
  const CagVec3 change = cag_sub(second, first);
  const double square = cag_dot(change, change);
  return square > 0 ? cag_madd(next, -cag_dot(second, change) / square, second) : next;
}

// Lowers the distance to that of the exact shapes close to a location on their meshes. Going from
// each shape to the other in turn, the distance only decreases. Since this is slow where the shapes
// are almost parallel, every other step starts from where the steps seem to end.
static bool polish_location(CagCall *call, const CagTarget *const targets[2], CagVec3 start,
                            double size, double polished, CagClosest *best) {
  Polish now = {.targets = {targets[0], targets[1]}};
  if (!polish_from(call, &now, start, &now)) return false;
  for (int step = 0; step < POLISH_STEPS && now.distance > 0; step++) {
    Polish next, ahead;
    const CagVec3 before = now.points[0];
    if (!cag_keep_going(call->vm) || !polish_from(call, &now, before, &now)) return false;
    if (cag_norm(cag_sub(now.points[0], before)) <= polished * size) break;
    if (!polish_from(call, &now, now.points[0], &next)) return false;
    const CagVec3 end = limit_of_steps(before, now.points[0], next.points[0]);
    if (!polish_from(call, &now, end, &ahead)) return false;
    now = ahead.distance < next.distance ? ahead : next;
  }
  keep_closest(best, now.distance <= TOUCHING * size ? 0 : now.distance, now.points);
  return true;
}

// Meshes are off by at most their tolerance, so the closest points are near one of the locations.
static bool polish_distance(CagCall *call, const Body *a, const Body *b, Nearest *best) {
  const CagTarget *targets[2];
  if (!cag_arg_near_target(call, 0, &targets[0]) || !cag_arg_near_target(call, 1, &targets[1]))
    return false;
  const double limit = fmin(best->closest.distance, best->rough) + best->margin;
  for (size_t i = 0; i < best->n; i++)
    for (size_t k = 0; k < best->near[i].n && best->closest.distance > 0; k++)
      if (best->near[i].distance[k] <= limit &&
          !polish_location(call, targets, best->near[i].points[k][0], body_size(a) + body_size(b),
                           POLISHED, &best->closest))
        return false;
  return true;
}

static bool body_distance(CagCall *call, Body *a, Body *b, CagClosest *out) {
  bool certain, within = false;
  Nearest nearest;
  CagVec3 at = {0, 0, 0};
  if (!cag_geometry_ok(call, surface_distance(call->vm, a, b, &nearest, &certain, call->err)))
    return false;
  if (nearest.n > 0 && !polish_distance(call, a, b, &nearest)) return false;
  *out = nearest.closest;
  if (out->distance == 0 || (certain && a->parts.n == 0 && b->parts.n == 0)) return true;
  if (!encloses(call, a, b, certain, &within, &at)) return false;
  if (!within && !encloses(call, b, a, certain, &within, &at)) return false;
  if (within) *out = (CagClosest){0, {at, at}};
  return true;
}

// A point, or a ball: the points within a radius of its center.
static bool read_ball(CagCall *call, int argument, CagVec3 *center, double *radius, bool *is_ball) {
  const CagValue v = call->values[argument];
  double scale;
  *radius = 0;
  *is_ball = !cag_is_shape(v) && !cag_is_list_of_shapes(call->vm, v);
  if (*is_ball) return cag_arg_vec(call, argument, center, NULL);
  if (v.type != CAG_SOLID) return true;
  const CagSolid *s = CAG_AS_SHAPE(v)->as.solid;
  *is_ball = s->kind == CAG_SOLID_SPHERE && cag_transform_is_similarity(&s->placement, &scale);
  if (!*is_ball) return true;
  *center = cag_transform_point(&s->placement, cag_vec3(0, 0, 0));
  *radius = s->a * scale;
  return true;
}

// The closest point of a ball follows from that of its center. *known is false if neither argument
// is a ball, or if there is nothing that can be near.
static bool ball_distance(CagCall *call, CagClosest *out, bool *known) {
  *known = false;
  for (int k = 1; k >= 0; k--) {
    CagVec3 center;
    double radius;
    bool is_ball;
    const CagTarget *t;
    CagTargetNearest near;
    const CagValue other = call->values[1 - k];
    if (!cag_is_shape(other) && !cag_is_list_of_shapes(call->vm, other)) continue;
    if (!read_ball(call, k, &center, &radius, &is_ball)) return false;
    if (!is_ball) continue;
    if (!cag_arg_near_target(call, 1 - k, &t) ||
        !cag_target_closest(call, t, center, INFINITY, &near))
      return false;
    *known = near.found;
    *out = (CagClosest){fmax(0, near.distance - radius), {near.point, near.point}};
    if (out->distance <= TOUCHING * (near.distance + radius)) out->distance = 0;
    else out->points[k] = cag_lerp(center, near.point, radius / near.distance);
    return true;
  }
  return true;
}

static bool is_shapes(CagCall *call, int argument) {
  const CagValue v = call->values[argument];
  return cag_is_shape(v) || cag_is_list_of_shapes(call->vm, v);
}

// Points of curved bodies are known less exactly than their distance.
static bool polish_points(CagCall *call, const Body *a, const Body *b, CagClosest *out) {
  const CagTarget *targets[2];
  CagClosest exact = {INFINITY, {out->points[0], out->points[1]}};
  if (out->distance == 0 || !is_shapes(call, 0) || !is_shapes(call, 1)) return true;
  if (!cag_arg_near_target(call, 0, &targets[0]) || !cag_arg_near_target(call, 1, &targets[1]) ||
      !polish_location(call, targets, out->points[0], body_size(a) + body_size(b), POLISHED_POINTS,
                       &exact))
    return false;
  // Other points would be those of another location.
  if (fabs(exact.distance - out->distance) <= TOUCHING * (body_size(a) + body_size(b)))
    memcpy(out->points, exact.points, sizeof exact.points);
  return true;
}

bool cag_closest_of_arguments(CagCall *call, bool points, CagClosest *out) {
  bool known;
  Body *a, *b;
  *out = (CagClosest){0};
  if (!ball_distance(call, out, &known)) return false;
  if (known) return true;
  return find_body(call, 0, &a) && find_body(call, 1, &b) && body_distance(call, a, b, out) &&
         (!points || polish_points(call, a, b, out));
}

bool cag_hulls_distance(CagCall *call, CagValue *result) {
  CagClosest closest;
  if (!cag_closest_of_arguments(call, false, &closest)) return false;
  *result = cag_number(closest.distance);
  return true;
}
