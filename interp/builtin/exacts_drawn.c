// Drawings of shapes with hidden lines.

#include "geom/solid/csg.h"
#include "geom/view/hidden.h"
#include "interp/builtin/exacts.h"
#include "interp/builtin/holds.h"
#include "interp/builtin/solids.h"
#include "interp/builtin/support.h"
#include "interp/builtin/surfaces.h"
#include "interp/builtin/targets.h"
#include "interp/vm/vm.h"

// The mesh of a solid without an exact boundary, held by the call.
static CagStatus meshed_body(CagCall *call, const CagShape *shape, CagViewBody *out) {
  CagBounds box;
  CagMesh *mesh = NULL;
  CagStatus status = cag_solid_bounds(shape->as.solid, &box, call->err);
  if (status) return status;
  const double size = cag_norm(cag_sub(box.max, box.min));
  const CagTessellation how = cag_shape_tessellation(
      call->vm, shape->tolerance > 0 ? shape->tolerance : CAG_SHAPE_TOLERANCE * size);
  status = cag_solid_tessellate(shape->as.solid, &how, &mesh, call->err);
  if (status) return status;
  cag_hold_mesh(call, mesh);
  out->mesh = mesh;
  return CAG_OK;
}

// Set operations are drawn by their boundaries, other solids by their faces or triangles.
static CagStatus solid_body(CagCall *call, const CagShape *shape, CagViewBody *out) {
  const CagSolid *s = shape->as.solid;
  out->solid = s;
  if (s->face_count > 0 || s->kind == CAG_SOLID_MESH) return CAG_OK;
  out->solid = NULL;
  CagStatus status = cag_exacts_of_solid(call, s, true, &out->solid);
  if (status && call->err->id == CAG_ERR_no_boundary) {
    out->solid = NULL;
    status = meshed_body(call, shape, out);
  }
  return status;
}

static bool body_of(CagCall *call, CagValue v, CagViewBody *out) {
  const CagShape *shape = CAG_AS_SHAPE(v);
  CagSurface *flat = NULL;
  CagStatus status = CAG_OK;
  switch (v.type) {
  case CAG_CURVE: out->curve = shape->as.curve; break;
  case CAG_SURFACE: out->surface = shape->as.surface; break;
  case CAG_MESH: out->mesh = shape->as.mesh; break;
  case CAG_SOLID: status = solid_body(call, shape, out); break;
  case CAG_REGION:
    status = cag_surface_planar(shape->as.region, shape->placement, &flat, call->err);
    if (!status) cag_hold_surface(call, flat);
    out->surface = flat;
    break;
  default: return cag_fail_type(call, 0, "curves, regions, surfaces, solids, or meshes");
  }
  return cag_geometry_ok(call, status);
}

bool cag_exacts_hlr(CagCall *call, const struct cag_exacts_hlr *a, CagValue *result) {
  static const char *const names[] = {"visible", "hidden", "frame"};
  CagList *shapes;
  if (!cag_list_shapes(call, call->values[0], &shapes)) return false;
  const CagPlane plane = {.normal = cag_unit(a->direction.at)};
  CagTransform frame = cag_plane_frame(&plane);
  CagViewBody *bodies = cag_hold_array(call, shapes->length + 1, sizeof *bodies);
  CagCurveList *visible = cag_hold_curve_list(call), *hidden = cag_hold_curve_list(call);
  size_t n = 0;
  bool ok = true;
  // Surfaces may call functions of the script, so the list of shapes is rooted.
  cag_root_push(call->vm, cag_object(CAG_LIST, shapes));
  for (size_t i = 0; ok && i < shapes->length; i++) {
    const CagValue v = cag_list_get(call->vm, shapes, i);
    bool empty = false;
    bodies[n] = (CagViewBody){0};
    ok = cag_value_is_empty(call, v, &empty) && (empty || body_of(call, v, &bodies[n]));
    n += ok && !empty;
  }
  ok = ok && cag_geometry_ok(call, cag_hidden_lines(bodies, n, &frame, visible, hidden, call->err));
  if (ok) {
    frame.planar = false;
    const CagValue values[] = {cag_curve_list_value(call->vm, visible),
                               cag_curve_list_value(call->vm, hidden),
                               cag_transform_value(call->vm, &frame)};
    *result = cag_record_new(call->vm, names, values, 3);
  }
  cag_root_pop(call->vm, 1);
  return ok;
}
