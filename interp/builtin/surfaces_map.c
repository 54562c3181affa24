// Maps by the parameters of a surface: curves, surfaces, and bodies laid onto it, and its
// reparametrization.
//
// Images of curves and surfaces are functions of the language, which makes their derivatives exact.
// Images of regions, solids, and meshes are meshes.

#include <string.h>

#include "base/memory.h"
#include "geom/solid/tessellate.h"
#include "geom/surface/mapped.h"
#include "geom/surface/reshape.h"
#include "geom/surface/trimmed.h"
#include "interp/builtin/solids.h"
#include "interp/builtin/support.h"
#include "interp/builtin/surfaces.h"
#include "interp/vm/vm.h"

// The point over x, y at height z. `o` is the surface offset by 1, so o - s is the normal.
#define PLACE(x, y) "s(" x ", " y ")"
#define LIFT(x, y, z) " + (" z ") * (o(" x ", " y ") - s(" x ", " y "))"

// Indexed by whether u and v of the surface are angles. In that case, the coordinates of the mapped
// shape are radians.
static const char *const CURVES[2][2] = {
    {"(c, s, o, r) => curve(t => s(c(t)[0], c(t)[1]), r)",
     "(c, s, o, r) => curve(t => s(c(t)[0], c(t)[1] * 1rad), r)"},
    {"(c, s, o, r) => curve(t => s(c(t)[0] * 1rad, c(t)[1]), r)",
     "(c, s, o, r) => curve(t => s(c(t)[0] * 1rad, c(t)[1] * 1rad), r)"}};
#define LIFTED(x, y) "(c, s, o, r) => curve(t => " PLACE(x, y) LIFT(x, y, "c(t)[2]") ", r)"
static const char *const CURVES_LIFTED[2][2] = {
    {LIFTED("c(t)[0]", "c(t)[1]"), LIFTED("c(t)[0]", "c(t)[1] * 1rad")},
    {LIFTED("c(t)[0] * 1rad", "c(t)[1]"), LIFTED("c(t)[0] * 1rad", "c(t)[1] * 1rad")}};
#define SHEET(x, y)                                                                                \
  "(g, s, o, a, b) => surface((u, v) => " PLACE(x, y) LIFT(x, y, "g(u, v)[2]") ", u: a, v: b)"
static const char *const SHEETS[2][2] = {
    {SHEET("g(u, v)[0]", "g(u, v)[1]"), SHEET("g(u, v)[0]", "g(u, v)[1] * 1rad")},
    {SHEET("g(u, v)[0] * 1rad", "g(u, v)[1]"), SHEET("g(u, v)[0] * 1rad", "g(u, v)[1] * 1rad")}};

#define LEAVES "expects a shape whose x and y are parameters of the surface as `G`"

// An error in the generated functions is reported as an error of the mapping, because their text is
// not part of the script. Other errors keep their locations.
static bool fail_mapping(CagCall *call, int argument, const char *what) {
  CagDiagnostics *errors = &call->vm->errors;
  if (errors->count == 0 || !errors->items[0].source ||
      strcmp(errors->items[0].source->name, "<formula>") != 0)
    return false;
  const CagErrorId id = errors->items[0].id;
  const char *said = errors->items[0].message ? errors->items[0].message : "";
  said = cag_hold(call, cag_strdup(said));
  if (strncmp(said, "at: ", 4) == 0) said += 4; // the function that evaluates points of a surface
  return cag_fail_call(call, argument, id, "%s: %s", what, said);
}

// Maps the smooth pieces of the curve separately, because the image, a function, cannot have
// corners.
static bool map_curve(CagCall *call, CagValue g, const CagSurface *s, CagValue offset,
                      CagValue *result) {
  CagVm *vm = call->vm;
  const CagCurve *c = CAG_AS_SHAPE(g)->as.curve;
  const size_t inner = c->kind->breaks ? c->kind->breaks(c, NULL, 0) : 0;
  double *cuts = cag_hold_array(call, inner + 2, sizeof *cuts);
  CagCurve **pieces = cag_hold_array(call, inner + 1, sizeof(CagCurve *)), *joined = NULL;
  CagValue lambda;
  const char *source = (c->dimension == 2 ? CURVES : CURVES_LIFTED)[s->angular_u][s->angular_v];
  if (!cag_vm_compile_lambda(vm, source, &lambda)) return false;
  cag_root_push(vm, lambda);
  cuts[0] = c->start;
  if (inner > 0) c->kind->breaks(c, cuts + 1, inner);
  cuts[inner + 1] = c->end;
  bool ok = true;
  for (size_t i = 0; ok && i <= inner; i++) {
    CagValue piece, arguments[4] = {g, call->values[1], offset,
                                    cag_domain_value(vm, c->angular, cuts[i], cuts[i + 1])};
    ok = cag_call(vm, lambda, arguments, 4, &piece) || fail_mapping(call, 0, LEAVES);
    if (!ok) break;
    pieces[i] = cag_curve_retain(CAG_AS_SHAPE(piece)->as.curve);
    cag_hold_curve(call, pieces[i]);
  }
  cag_root_pop(vm, 1);
  if (!ok) return false;
  if (inner == 0) joined = cag_curve_retain(pieces[0]);
  else if (!cag_geometry_ok(call, cag_curve_join(pieces, inner + 1, &joined, call->err)))
    return false;
  *result = cag_curve_value(vm, joined);
  return true;
}

static bool map_surface(CagCall *call, CagValue value, const CagSurface *s, CagValue offset,
                        CagValue *result) {
  const CagSurface *g = CAG_AS_SHAPE(value)->as.surface;
  CagValue lambda;
  if (!cag_vm_compile_lambda(call->vm, SHEETS[s->angular_u][s->angular_v], &lambda)) return false;
  CagValue arguments[5] = {value, call->values[1], offset,
                           cag_domain_value(call->vm, g->angular_u, g->u0, g->u1),
                           cag_domain_value(call->vm, g->angular_v, g->v0, g->v1)};
  return cag_call(call->vm, lambda, arguments, 5, result) || fail_mapping(call, 0, LEAVES);
}

static bool map_smooth(CagCall *call, CagValue g, const CagSurface *s, CagValue *result) {
  CagSurface *over = NULL;
  if (!cag_geometry_ok(call, cag_surface_offset(s, 1, &over, call->err))) return false;
  CagValue offset = cag_surface_value(call->vm, over);
  cag_root_push(call->vm, offset);
  bool ok = g.type == CAG_CURVE ? map_curve(call, g, s, offset, result)
                                : map_surface(call, g, s, offset, result);
  cag_root_pop(call->vm, 1);
  return ok;
}

// --- Bodies, as meshes ---

static CagStatus body_mesh(CagValue v, const CagTessellation *how, CagMesh **out, CagError *err) {
  const CagShape *shape = CAG_AS_SHAPE(v);
  CagSurface *flat = NULL;
  if (v.type == CAG_MESH) {
    *out = cag_mesh_retain(shape->as.mesh);
    return CAG_OK;
  }
  if (v.type == CAG_SOLID) return cag_solid_tessellate(shape->as.solid, how, out, err);
  CagStatus status = cag_surface_planar(shape->as.region, shape->placement, &flat, err);
  if (!status) status = cag_surface_tessellate(flat, how, out, err);
  cag_surface_release(flat);
  return status;
}

static bool lies_flat(const CagMesh *m) {
  for (size_t i = 0; i < m->vertex_count; i++)
    if (m->positions[i].z != 0) return false;
  return true;
}

// Before it is mapped, a body becomes a mesh with this fraction of the image's tolerance.
#define FINER 0.25

static bool map_body(CagCall *call, CagValue g, const CagSurface *s, double tolerance,
                     CagValue *result) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *flat = NULL, *image = NULL;
  CagStatus status = body_mesh(g, &how, &flat, call->err);
  if (!status && g.type != CAG_MESH && tolerance > 0) {
    // The domain's size tells how much the surface stretches shapes in its parameters.
    CagBounds box;
    status = cag_surface_bounds(s, &box, call->err);
    double size = status ? 0 : cag_norm(cag_sub(box.max, box.min));
    double domain = hypot(s->u1 - s->u0, s->v1 - s->v0);
    if (size > 0) {
      how.tolerance = FINER * tolerance * domain / size;
      cag_mesh_release(flat);
      flat = NULL;
      status = body_mesh(g, &how, &flat, call->err);
    }
  }
  if (!status)
    status = cag_mesh_onto_surface(flat, s, tolerance, lies_flat(flat), how.max_triangles, &image,
                                   call->err);
  cag_mesh_release(flat);
  return cag_mesh_result(call, status, &image, result);
}

// The map ignores the curves that trim a surface, so trimmed surfaces are rejected.
static bool refuse_trimmed(CagCall *call, CagValue g) {
  if (g.type != CAG_SURFACE || !cag_surface_trimmed_view(CAG_AS_SHAPE(g)->as.surface, NULL, NULL))
    return true;
  return cag_geometry_ok(
      call,
      cag_fail(
          call->err, CAG_E_UNSUPPORTED, CAG_ERR_surface_trimmed, "", -1,
          "a trimmed surface cannot be mapped; map the whole surface and trim the result, or map its mesh"));
}

static bool map_one(CagCall *call, CagValue g, const CagSurface *s, double tolerance,
                    CagValue *result) {
  if (!refuse_trimmed(call, g)) return false;
  bool smooth = g.type == CAG_CURVE || g.type == CAG_SURFACE;
  if (smooth ? !map_smooth(call, g, s, result) : !map_body(call, g, s, tolerance, result))
    return false;
  cag_shape_say_alike(*result, g);
  CAG_AS_SHAPE(*result)->frames = NULL; // what is bent has no rigid frame
  return true;
}

// Maps each shape of a group or list.
static bool map_several(CagCall *call, const CagSurface *s, double tolerance, CagValue *result) {
  CagList *list;
  if (!cag_list_shapes(call, call->values[0], &list)) return false;
  CagBuilder *images = cag_builder_new(call->vm);
  // Mapping the next one may call the script, so the list is rooted.
  cag_root_push(call->vm, cag_object(CAG_LIST, list));
  cag_root_push(call->vm, cag_builder_value(images));
  bool ok = true;
  for (size_t i = 0; ok && i < list->length; i++) {
    CagValue image;
    ok = map_one(call, cag_list_get(call->vm, list, i), s, tolerance, &image) &&
         cag_builder_add(call->vm, images, image);
  }
  cag_root_pop(call->vm, 2);
  if (ok) *result = cag_group_value(call->vm, cag_builder_finish(call->vm, images));
  return ok;
}

bool cag_surfaces_map_onto(CagCall *call, const struct cag_surfaces_map_onto *a, CagValue *result) {
  return a->G.type == CAG_GROUP || a->G.type == CAG_LIST
             ? map_several(call, a->S, a->tolerance, result)
             : map_one(call, a->G, a->S, a->tolerance, result);
}

bool cag_surfaces_remap(CagCall *call, const struct cag_surfaces_remap *a, CagValue *result) {
  const CagSurface *s = a->S;
  const bool u = cag_given(call, 2), v = cag_given(call, 3);
  CagValue lambda;
  if (!refuse_trimmed(call, call->values[0]) ||
      !cag_vm_compile_lambda(call->vm,
                             "(s, f, a, b) => surface((u, v) => s(f(u, v)[0], f(u, v)[1]), u: a, "
                             "v: b)",
                             &lambda))
    return false;
  CagValue arguments[4] = {call->values[0], a->f,
                           u ? a->u : cag_domain_value(call->vm, s->angular_u, s->u0, s->u1),
                           v ? a->v : cag_domain_value(call->vm, s->angular_v, s->v0, s->v1)};
  if (!cag_call(call->vm, lambda, arguments, 4, result))
    return fail_mapping(call, 1, "expects a function that returns [u, v] of the surface as `f`");
  cag_shape_say_alike(*result, call->values[0]);
  return true;
}
