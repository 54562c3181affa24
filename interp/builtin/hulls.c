// Convex hulls, curves on surfaces, and what is inside of and how far from shapes.

#include <stdlib.h>

#include "geom/mesh/hull.h"
#include "geom/mesh/tessellate.h"
#include "geom/surface/curve_on.h"
#include "interp/builtin/shapes.h"
#include "interp/eval/vm.h"

// --- Hulls ---

static bool plane_hull(CagCall *call, const CagVec3 *points, size_t n, CagValue *result) {
  size_t *ring = NULL, count = 0;
  CagCurve *loop = NULL;
  CagRegion *region = NULL;
  CagError err;
  if (!cag_geometry_ok(call, cag_hull_plane(points, n, &ring, &count, &err), &err)) return false;
  CagVec3 *corners = malloc(count * sizeof *corners);
  CagStatus status = corners ? CAG_OK : cag_fail_memory(&err);
  for (size_t i = 0; !status && i < count; i++) corners[i] = points[ring[i]];
  if (!status) status = cag_curve_polyline(corners, count, true, 2, &loop, &err);
  if (!status) status = cag_region_new(loop, NULL, 0, &region, &err);
  cag_curve_release(loop);
  free(corners);
  free(ring);
  if (!cag_geometry_ok(call, status, &err)) return false;
  *result = cag_region_value(call->vm, region, NULL);
  return true;
}

static bool space_hull(CagCall *call, const CagVec3 *points, size_t n, CagValue *result) {
  CagMesh *m = NULL;
  CagError err;
  if (!cag_geometry_ok(call, cag_hull_space(points, n, &m, &err), &err)) return false;
  *result = cag_mesh_value(call->vm, m);
  return true;
}

typedef struct Cloud {
  CagVec3 *points;
  size_t n, capacity;
  bool plane; // all of the plane
} Cloud;

static CagStatus cloud_add(Cloud *cloud, const CagVec3 *points, size_t n, CagError *err) {
  if (cloud->n + n > cloud->capacity) {
    const size_t capacity = 2 * (cloud->n + n);
    CagVec3 *grown = realloc(cloud->points, capacity * sizeof *grown);
    if (!grown) return cag_fail_memory(err);
    cloud->points = grown;
    cloud->capacity = capacity;
  }
  for (size_t i = 0; i < n; i++) cloud->points[cloud->n++] = points[i];
  return CAG_OK;
}

// How finely a shape is replaced by points of it: part of its size.
#define HULL_TOLERANCE 1e-4

static CagStatus add_curve(Cloud *cloud, const CagCurve *c, double tolerance, CagError *err) {
  CagBounds box;
  double *t = NULL;
  size_t n = 0;
  CagStatus status = cag_curve_bounds(c, &box, err);
  if (status) return status;
  if (tolerance <= 0) tolerance = HULL_TOLERANCE * cag_norm(cag_sub(box.max, box.min));
  status = cag_curve_discretize(c, tolerance, CAG_TESSELLATION_DEFAULT.angle, &t, &n, err);
  for (size_t i = 0; !status && i < n; i++) {
    CagVec3 p;
    status = cag_curve_point(c, t[i], &p, err);
    if (!status) status = cloud_add(cloud, &p, 1, err);
  }
  free(t);
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

static CagStatus mesh_of(const CagVm *vm, CagValue v, double tolerance, CagMesh **out,
                         CagError *err) {
  const CagShape *shape = CAG_AS_SHAPE(v);
  CagBounds box;
  if (v.type == CAG_MESH) {
    *out = cag_mesh_retain(shape->as.mesh);
    return CAG_OK;
  }
  CagStatus status = v.type == CAG_SOLID ? cag_solid_bounds(shape->as.solid, &box, err)
                                         : cag_surface_bounds(shape->as.surface, &box, err);
  if (status) return status;
  if (tolerance <= 0) tolerance = HULL_TOLERANCE * cag_norm(cag_sub(box.max, box.min));
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  how.tolerance = tolerance;
  if (vm->max_triangles > 0) how.max_triangles = vm->max_triangles;
  how.interrupt = vm->interrupt;
  return v.type == CAG_SOLID ? cag_solid_tessellate(shape->as.solid, &how, out, err)
                             : cag_surface_tessellate(shape->as.surface, &how, out, err);
}

static CagStatus add_shape(const CagVm *vm, Cloud *cloud, CagValue v, CagError *err) {
  const CagShape *shape = CAG_AS_SHAPE(v);
  if (v.type == CAG_CURVE) return add_curve(cloud, shape->as.curve, shape->tolerance, err);
  if (v.type == CAG_REGION) return add_region(cloud, shape, err);
  CagMesh *m;
  CagStatus status = mesh_of(vm, v, shape->tolerance, &m, err);
  if (status) return status;
  cloud->plane = false;
  status = cloud_add(cloud, m->positions, m->vertex_count, err);
  cag_mesh_release(m);
  return status;
}

static bool hull_of_cloud(CagCall *call, const Cloud *cloud, CagValue *result) {
  return cloud->plane ? plane_hull(call, cloud->points, cloud->n, result)
                      : space_hull(call, cloud->points, cloud->n, result);
}

static bool hull_of_shapes(CagCall *call, CagValue *result) {
  CagError err;
  Cloud cloud = {.plane = true};
  CagBuilder *builder = cag_builder_new(call->vm);
  if (!cag_shapes_collect(call, call->values[0], builder)) return false;
  const CagList *shapes = CAG_AS_LIST(cag_builder_finish(call->vm, builder));
  bool ok = true;
  for (size_t i = 0; ok && i < shapes->length; i++)
    ok = cag_geometry_ok(call, add_shape(call->vm, &cloud, cag_list_get(call->vm, shapes, i), &err),
                         &err);
  ok = ok && hull_of_cloud(call, &cloud, result);
  free(cloud.points);
  return ok;
}

static bool is_list_of_shapes(CagVm *vm, CagValue v) {
  if (v.type != CAG_LIST || CAG_AS_LIST(v)->length == 0) return false;
  const CagValue first = cag_list_get(vm, CAG_AS_LIST(v), 0);
  return cag_is_shape(first) || is_list_of_shapes(vm, first);
}

static bool call_convex_hull(CagCall *call, CagValue *result) {
  const CagValue v = call->values[0];
  if (cag_is_shape(v) || is_list_of_shapes(call->vm, v)) return hull_of_shapes(call, result);
  CagVec3 *points;
  size_t n;
  int dimension;
  if (!cag_arg_points(call, 0, &points, &n, &dimension)) return false;
  const bool ok =
      dimension == 2 ? plane_hull(call, points, n, result) : space_hull(call, points, n, result);
  free(points);
  return ok;
}

// --- Curves on surfaces ---

static bool call_curve_on(CagCall *call, CagValue *result) {
  CagSurface *s;
  CagCurve *c, *on = NULL;
  CagError err;
  if (!cag_arg_surface(call, 0, &s) || !cag_arg_curve(call, 1, &c) ||
      !cag_geometry_ok(call, cag_curve_on_surface(s, c, &on, &err), &err))
    return false;
  *result = cag_curve_value(call->vm, on);
  return true;
}

const CagBuiltin cag_builtins_hulls[] = {
    {"convex_hull(points)", call_convex_hull, "region or mesh",
     "The smallest convex shape that holds all points: of points of the plane a region, "
     "counter-clockwise from the leftmost; of points in space, or of a shape or list of shapes, a "
     "closed mesh, its normals outward. Sides are decided exactly. Points within rounding of a "
     "side, edge or face are no corners of it. Curved shapes are replaced by points of them, to "
     "their own tolerance, without one to 1e-4 of their size. Points on one line or in "
     "one plane have no hull in space: errors (coincident-points, collinear-points, "
     "coplanar-points).",
     "print area(convex_hull([[0, 0], [4, 0], [4, 2], [0, 2], [1, 1], [2, 0]])) // expect: 8\n"
     "h = convex_hull([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0.1, 0.1, 0.1]])\n"
     "print len(vertices(h)), is_watertight(h), near(volume(h), 1 / 6) // expect: 4 true true",
     0, "The plane"},
    {"curve_on(S, C)", call_curve_on, "curve",
     "The curve on the surface whose u and v are x and y of a plane curve; angles of the surface "
     "are radians there. It has the plane curve's parameter and domain, and exact derivatives up "
     "to order 8. Along a direction in which the surface is closed it may go round several times; "
     "along others it must stay in the domain (curve-outside). It has no exact NURBS form.",
     "c = curve_on(torus_surface(5, 1), line([0, 0], [tau, 3 * tau]))\n"
     "print is_closed(c), length(c) > 3 * tau // expect: true true",
     CAG_TAKES(SURFACE), "Curves: made"},
    {0}};
