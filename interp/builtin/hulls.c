// Convex hulls, curves on surfaces, and containment.

#include "interp/builtin/hulls.h"
#include "base/array.h"
#include "base/memory.h"
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
    status = cag_curve_transform(shape->as.region->loops[i], shape->placement, &loop, err);
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
  for (size_t i = 0; i < call->count; i++)
    if (!cag_shapes_collect(call, call->values[i], builder)) return false;
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

bool cag_is_list_of_shapes(CagVm *vm, CagValue v) {
  if (v.type != CAG_LIST) return false;
  while (v.type == CAG_LIST && CAG_AS_LIST(v)->length > 0) v = cag_list_get(vm, CAG_AS_LIST(v), 0);
  return cag_is_shape(v);
}

bool cag_hulls_convex_hull(CagCall *call, CagValue *result) {
  const CagValue v = call->values[0];
  if (cag_is_shape(v) || cag_is_list_of_shapes(call->vm, v)) return hull_of_shapes(call, result);
  if (call->count > 1) return cag_fail_type(call, 0, "one list of points, or shapes");
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

// --- Containment ---

bool cag_shape_holds(CagCall *call, CagValue v, CagVec3 p, bool *inside, bool *body) {
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
  if (!cag_shape_holds(call, a->G, a->P.at, &inside, &body)) return false;
  if (!body)
    return cag_fail_call(call, 0, CAG_ERR_value,
                         "expects a closed mesh, found one with an open edge");
  *result = cag_bool(inside);
  return true;
}
