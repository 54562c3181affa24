// Convex hulls, curves on surfaces, containment, and distances.

#include "base/array.h"
#include "base/memory.h"
#include "geom/distance/separation.h"
#include "geom/mesh/hull.h"
#include "geom/solid/csg.h"
#include "geom/solid/tessellate.h"
#include "geom/surface/curve_on.h"
#include "interp/builtin/shapes.h"
#include "interp/builtin/surfaces.h"
#include "interp/builtin/targets.h"
#include "interp/vm/vm.h"

// --- Hulls ---

static bool plane_hull(CagCall *call, const CagVec3 *points, size_t n, CagValue *result) {
  size_t *ring, count;
  CagCurve *loop = NULL;
  CagRegion *region = NULL;
  if (!cag_geometry_ok(call, cag_hull_plane(points, n, &ring, &count, call->err))) return false;
  cag_hold(call, ring);
  CagVec3 *corners = cag_hold_array(call, count, sizeof *corners);
  for (size_t i = 0; i < count; i++) corners[i] = points[ring[i]];
  CagStatus status = cag_curve_polyline(corners, count, true, 2, &loop, call->err);
  if (!status) status = cag_region_new(loop, NULL, 0, &region, call->err);
  cag_curve_release(loop);
  return cag_region_result(call, status, &region, result);
}

static bool space_hull(CagCall *call, const CagVec3 *points, size_t n, CagValue *result) {
  CagMesh *m = NULL;
  CagSolid *s = NULL;
  CagStatus status = cag_hull_space(points, n, &m, call->err);
  if (!status) status = cag_solid_from_mesh(m, &s, call->err);
  cag_mesh_release(m);
  return cag_solid_result(call, status, &s, result);
}

typedef struct Cloud {
  CagVec3 *points;
  size_t n, capacity;
  bool plane; // all points are in the plane z = 0
} Cloud;

static void release_cloud(void *cloud) { cag_free(((Cloud *)cloud)->points); }

static CagStatus cloud_add(Cloud *cloud, const CagVec3 *points, size_t n, CagError *err) {
  if (!CAG_RESERVE(cloud->points, cloud->capacity, cloud->n + n)) return cag_fail_memory(err);
  for (size_t i = 0; i < n; i++) cloud->points[cloud->n++] = points[i];
  return CAG_OK;
}

// A point is on a boundary if it is closer than this fraction of the size.
#define BOUNDARY 1e-9

static CagStatus add_curve(Cloud *cloud, const CagCurve *c, double tolerance, CagError *err) {
  CagBounds box;
  double *t = NULL;
  size_t n = 0;
  CagStatus status = cag_curve_bounds(c, &box, err);
  if (status) return status;
  if (tolerance <= 0) tolerance = CAG_SHAPE_TOLERANCE * cag_norm(cag_sub(box.max, box.min));
  status = cag_curve_discretize(c, tolerance, CAG_TESSELLATION_DEFAULT.angle, &t, &n, err);
  for (size_t i = 0; !status && i < n; i++) {
    CagVec3 p;
    status = cag_curve_point(c, t[i], &p, err);
    if (!status) status = cloud_add(cloud, &p, 1, err);
  }
  cag_free(t);
  if (c->dimension != 2) cloud->plane = false;
  return status;
}

static CagStatus add_region(Cloud *cloud, const CagShape *shape, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < shape->as.region->count; i++) {
    CagCurve *loop;
    status = cag_curve_transform(shape->as.region->loops[i], &shape->placement, &loop, err);
    if (status) break;
    status = add_curve(cloud, loop, shape->tolerance, err);
    cag_curve_release(loop);
  }
  return status;
}

static CagStatus add_shape(const CagVm *vm, Cloud *cloud, CagValue v, CagError *err) {
  const CagShape *shape = CAG_AS_SHAPE(v);
  if (v.type == CAG_CURVE) return add_curve(cloud, shape->as.curve, shape->tolerance, err);
  if (v.type == CAG_REGION) return add_region(cloud, shape, err);
  CagMesh *m;
  cloud->plane = false;
  if (v.type == CAG_LABEL) return cloud_add(cloud, &shape->as.label->at, 1, err);
  CagStatus status = cag_shape_mesh(vm, v, shape->tolerance, &m, err);
  if (status) return cag_is_empty_shape(err) ? CAG_OK : status;
  status = cloud_add(cloud, m->positions, m->vertex_count, err);
  cag_mesh_release(m);
  return status;
}

static bool hull_of_shapes(CagCall *call, CagValue *result) {
  Cloud *cloud = cag_hold_array(call, 1, sizeof *cloud);
  cag_hold_for(call, release_cloud, cloud);
  cloud->plane = true;
  CagBuilder *builder = cag_builder_new(call->vm);
  if (!cag_shapes_collect(call, call->values[0], builder)) return false;
  const CagList *shapes = CAG_AS_LIST(cag_builder_finish(call->vm, builder));
  for (size_t i = 0; i < shapes->length; i++) {
    const CagValue v = cag_list_get(call->vm, shapes, i);
    if ((i % CAG_LOOK_UP == 0 && !cag_keep_going(call->vm)) ||
        !cag_geometry_ok(call, add_shape(call->vm, cloud, v, call->err)))
      return false;
  }
  return cloud->plane ? plane_hull(call, cloud->points, cloud->n, result)
                      : space_hull(call, cloud->points, cloud->n, result);
}

static bool is_list_of_shapes(CagVm *vm, CagValue v) {
  if (v.type != CAG_LIST) return false;
  while (v.type == CAG_LIST && CAG_AS_LIST(v)->length > 0) v = cag_list_get(vm, CAG_AS_LIST(v), 0);
  return cag_is_shape(v);
}

bool cag_hulls_convex_hull(CagCall *call, CagValue *result) {
  const CagValue v = call->values[0];
  if (cag_is_shape(v) || is_list_of_shapes(call->vm, v)) return hull_of_shapes(call, result);
  CagVec3 *points;
  size_t n;
  int dimension;
  if (!cag_arg_points(call, 0, &points, &n, &dimension)) return false;
  cag_hold(call, points);
  return dimension == 2 ? plane_hull(call, points, n, result) : space_hull(call, points, n, result);
}

// --- Curves on surfaces ---

bool cag_hulls_curve_on(CagCall *call, const struct cag_hulls_curve_on *a, CagValue *result) {
  CagSurface *s;
  CagCurve *on = NULL;
  if (!cag_arg_side(call, 0, &s)) return false;
  return cag_curve_result(call, cag_curve_on_surface(s, a->C, &on, call->err), &on, result);
}

// --- Containment and distance ---

// A shape split into parts. It also owns the surfaces, curves, and meshes created for it.
typedef struct Body {
  CagParts parts;
  CagCurveList curves;
  double size;
} Body;

static void body_free(Body *b) {
  cag_curve_list_free(&b->curves);
  cag_parts_free(&b->parts);
}

static CagStatus body_add_curve(Body *b, const CagCurve *c, double tolerance, CagError *err) {
  CagStatus status = cag_curve_list_add(&b->curves, cag_curve_retain(c), err);
  return status ? status : cag_parts_add_curve(&b->parts, c, tolerance, err);
}

static CagStatus body_add_surface(const CagVm *vm, Body *b, const CagSurface *s, double tolerance,
                                  CagError *err) {
  const CagTessellation how = cag_shape_tessellation(vm, tolerance);
  const bool flat = cag_surface_planar_view(s, NULL, NULL);
  CagMesh *m = NULL;
  CagStatus status = cag_surface_tessellate(s, &how, &m, err);
  if (!status) status = cag_parts_add_mesh(&b->parts, m, flat ? NULL : s, tolerance, err);
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

// The distance from set operations and bodies bounded by meshes is that from their triangles.
static CagStatus body_add_compound(const CagVm *vm, Body *b, const CagSolid *s, double tolerance,
                                   CagError *err) {
  const CagTessellation how = cag_shape_tessellation(vm, tolerance);
  CagMesh *m = NULL;
  CagStatus status = cag_solid_tessellate(s, &how, &m, err);
  if (!status) status = cag_parts_add_mesh(&b->parts, m, NULL, 0, err);
  cag_mesh_release(m);
  return status;
}

// An empty shape adds nothing.
static CagStatus body_add_shape(const CagVm *vm, Body *b, CagValue v, double tolerance,
                                CagError *err) {
  const CagShape *shape = CAG_AS_SHAPE(v);
  CagStatus status = CAG_OK;
  if (v.type == CAG_REGION && cag_region_is_empty(shape->as.region)) return CAG_OK;
  switch (v.type) {
  case CAG_CURVE: return body_add_curve(b, shape->as.curve, tolerance, err);
  case CAG_REGION:
    return body_add_region(vm, b, shape->as.region, &shape->placement, tolerance, err);
  case CAG_SURFACE: return body_add_face(vm, b, shape->as.surface, tolerance, err);
  case CAG_MESH: return cag_parts_add_mesh(&b->parts, shape->as.mesh, NULL, 0, err);
  case CAG_LABEL: return cag_parts_add_point(&b->parts, shape->as.label->at, err);
  default:
    if (cag_solid_is_compound(shape->as.solid))
      return body_add_compound(vm, b, shape->as.solid, tolerance, err);
    for (size_t i = 0; !status && i < shape->as.solid->face_count; i++)
      status = body_add_face(vm, b, shape->as.solid->faces[i], tolerance, err);
    return status;
  }
}

// Whether a solid or closed mesh contains the point. *body is false for an open mesh.
static bool holds(CagCall *call, CagValue v, CagVec3 p, bool *inside, bool *body) {
  const CagCaster *caster;
  CagCrossings work = {0};
  int side = 1;
  if (!cag_shape_caster(call, v, &caster)) return false;
  *body = cag_caster_is_closed(caster);
  *inside = false;
  if (!*body) return true;
  const CagBounds b = cag_caster_bounds(caster);
  const double size = cag_norm(cag_sub(b.max, b.min));
  const double scale = isfinite(size) ? size : cag_norm(p);
  CagStatus status = cag_caster_side(caster, p, BOUNDARY * scale, &work, &side, call->err);
  cag_crossings_free(&work);
  *inside = side <= 0;
  return cag_geometry_ok(call, status);
}

bool cag_hulls_contains(CagCall *call, const struct cag_hulls_contains *a, CagValue *result) {
  bool inside, body;
  if (!holds(call, a->G, a->P.at, &inside, &body)) return false;
  if (!body)
    return cag_fail_call(call, 0, CAG_ERR_value,
                         "expects a closed mesh, found one with an open edge");
  *result = cag_bool(inside);
  return true;
}

// One argument of `distance`: a point, or shapes.
typedef struct Side {
  bool point;
  CagVec3 p;
  const CagList *shapes;
  Body body;
} Side;

static void release_sides(void *side) {
  for (int i = 0; i < 2; i++) body_free(&((Side *)side)[i].body);
}

static bool read_side(CagCall *call, int argument, Side *out) {
  const CagValue v = call->values[argument];
  CagBounds box;
  int dimension;
  *out = (Side){.point = !cag_is_shape(v) && !is_list_of_shapes(call->vm, v)};
  if (out->point) return cag_arg_vec(call, argument, &out->p, NULL);
  CagBuilder *builder = cag_builder_new(call->vm);
  if (!cag_shapes_collect(call, v, builder)) return false;
  out->shapes = CAG_AS_LIST(cag_builder_finish(call->vm, builder));
  if (!cag_value_bounds(call, v, &box, &dimension)) return false;
  out->body.size = cag_norm(cag_sub(box.max, box.min));
  return true;
}

static size_t side_count(const Side *s) { return s->point ? 1 : s->shapes->length; }

// Adds the point or the shape with index i.
static CagStatus body_add_part(CagVm *vm, Body *b, const Side *side, size_t i, CagError *err) {
  return side->point ? cag_parts_add_point(&b->parts, side->p, err)
                     : body_add_shape(vm, b, cag_list_get(vm, side->shapes, i),
                                      CAG_SHAPE_TOLERANCE * side->body.size, err);
}

static CagStatus fill_side(CagVm *vm, Side *side, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < side_count(side); i++)
    status = body_add_part(vm, &side->body, side, i, err);
  return status;
}

// Whether a body of `outer` contains a shape of `inner`. The surfaces do not meet, so one point of
// each shape decides.
static bool encloses(CagCall *call, const Side *outer, const Side *inner, bool *yes) {
  for (size_t i = 0; !*yes && !outer->point && i < outer->shapes->length; i++) {
    const CagValue v = cag_list_get(call->vm, outer->shapes, i);
    if (v.type != CAG_SOLID && v.type != CAG_MESH) continue;
    bool body;
    for (size_t k = 0; !*yes && k < side_count(inner); k++) {
      Body one = {0};
      const CagStatus status = body_add_part(call->vm, &one, inner, k, call->err);
      const bool some = !status && one.parts.n > 0;
      const CagVec3 p = some ? one.parts.items[0].p[0] : cag_vec3(0, 0, 0);
      body_free(&one);
      if (!cag_geometry_ok(call, status) || (some && !holds(call, v, p, yes, &body))) return false;
    }
  }
  return true;
}

static bool measure(CagCall *call, Side side[2], double *out) {
  CagStatus status = fill_side(call->vm, &side[0], call->err);
  if (!status) status = fill_side(call->vm, &side[1], call->err);
  if (!status)
    status = cag_parts_distance(&side[0].body.parts, &side[1].body.parts, CAG_PARTS_PAIRS, out,
                                NULL, cag_vm_stop(call->vm), call->err);
  if (!cag_geometry_ok(call, status)) return false;
  bool within = false;
  if (*out == 0) return true;
  if (!encloses(call, &side[0], &side[1], &within)) return false;
  if (!within && !encloses(call, &side[1], &side[0], &within)) return false;
  if (within) *out = 0;
  return true;
}

// The distance of shapes from a point. Returns false, without an error, if both arguments are
// shapes or there is nothing that can be near.
static bool point_distance(CagCall *call, double *out, bool *ok) {
  CagVec3 p;
  const CagTarget *t;
  CagTargetNearest near;
  const int shapes =
      cag_is_shape(call->values[0]) || is_list_of_shapes(call->vm, call->values[0]) ? 0 : 1;
  const CagValue point = call->values[1 - shapes];
  *ok = true;
  if (cag_is_shape(point) || is_list_of_shapes(call->vm, point)) return false;
  *ok = cag_arg_vec(call, 1 - shapes, &p, NULL) && cag_arg_near_target(call, shapes, &t) &&
        cag_target_closest(call, t, p, INFINITY, &near);
  *out = near.distance;
  return *ok && near.found;
}

bool cag_hulls_distance(CagCall *call, CagValue *result) {
  Side *side = cag_hold_array(call, 2, sizeof *side);
  cag_hold_for(call, release_sides, side);
  double distance = 0;
  bool ok;
  if (point_distance(call, &distance, &ok)) {
    *result = cag_number(distance);
    return true;
  }
  if (!ok) return false;
  if (!read_side(call, 0, &side[0]) || !read_side(call, 1, &side[1]) ||
      !measure(call, side, &distance))
    return false;
  *result = cag_number(distance);
  return true;
}
