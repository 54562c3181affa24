// Mappings of parameters: curves and surfaces laid onto a surface, surfaces with other parameters.
//
// They are made as functions of the language, so that they are differentiated exactly.

#include <stdlib.h>

#include "geom/surface/reshape.h"
#include "interp/builtin/support.h"
#include "interp/builtin/surfaces.h"

// The point over x, y at the height z: `o` is the surface's offset by 1, so that o - s is the
// normal.
#define PLACE(x, y) "s(" x ", " y ")"
#define LIFT(x, y, z) " + (" z ") * (o(" x ", " y ") - s(" x ", " y "))"

// Whether u and v of the surface are angles: x and y of what is mapped are then radians.
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

// The curve's smooth pieces one by one: a function has no corners of its own.
static bool map_curve(CagCall *call, const CagCurve *c, const CagSurface *s, CagValue offset,
                      CagValue *result) {
  CagVm *vm = call->vm;
  CagError err;
  size_t inner = c->kind->breaks ? c->kind->breaks(c, NULL, 0) : 0, made = 0;
  double *cuts = malloc((inner + 2) * sizeof *cuts);
  CagCurve **pieces = malloc((inner + 1) * sizeof *pieces), *joined = NULL;
  CagValue lambda;
  bool ok = cuts && pieces;
  if (!ok) cag_fail_call(call, 0, CAG_ERR_limit_memory, "needs more memory than there is");
  const char *source = (c->dimension == 2 ? CURVES : CURVES_LIFTED)[s->angular_u][s->angular_v];
  ok = ok && cag_vm_compile_lambda(vm, source, &lambda);
  if (ok) {
    cag_root_push(vm, lambda);
    cuts[0] = c->start;
    if (inner > 0) c->kind->breaks(c, cuts + 1, inner);
    cuts[inner + 1] = c->end;
    for (size_t i = 0; ok && i <= inner; i++) {
      CagValue piece, arguments[4] = {call->values[0], call->values[1], offset,
                                      cag_domain_value(vm, c->angular, cuts[i], cuts[i + 1])};
      ok = cag_call(vm, lambda, arguments, 4, &piece);
      if (ok) pieces[made++] = cag_curve_retain(CAG_AS_SHAPE(piece)->as.curve);
    }
    cag_root_pop(vm, 1);
  }
  if (ok && made == 1) joined = cag_curve_retain(pieces[0]);
  else if (ok) ok = cag_geometry_ok(call, cag_curve_join(pieces, made, &joined, &err), &err);
  while (made > 0) cag_curve_release(pieces[--made]);
  free(pieces);
  free(cuts);
  if (ok) *result = cag_curve_value(vm, joined);
  return ok;
}

static bool map_surface(CagCall *call, const CagSurface *g, const CagSurface *s, CagValue offset,
                        CagValue *result) {
  CagValue lambda;
  if (!cag_vm_compile_lambda(call->vm, SHEETS[s->angular_u][s->angular_v], &lambda)) return false;
  CagValue arguments[5] = {call->values[0], call->values[1], offset,
                           cag_domain_value(call->vm, g->angular_u, g->u0, g->u1),
                           cag_domain_value(call->vm, g->angular_v, g->v0, g->v1)};
  return cag_call(call->vm, lambda, arguments, 5, result);
}

bool cag_surfaces_map_onto(CagCall *call, CagValue *result) {
  CagSurface *s, *over = NULL;
  CagError err;
  CagValue g = call->values[0];
  if (!cag_arg_surface(call, 1, &s) ||
      !cag_geometry_ok(call, cag_surface_offset(s, 1, &over, &err), &err))
    return false;
  CagValue offset = cag_surface_value(call->vm, over);
  cag_root_push(call->vm, offset);
  bool ok = g.type == CAG_CURVE ? map_curve(call, CAG_AS_SHAPE(g)->as.curve, s, offset, result)
                                : map_surface(call, CAG_AS_SHAPE(g)->as.surface, s, offset, result);
  cag_root_pop(call->vm, 1);
  if (ok) cag_shape_say_alike(*result, g);
  return ok;
}

bool cag_surfaces_remap(CagCall *call, CagValue *result) {
  CagSurface *s;
  CagValue f, lambda;
  if (!cag_arg_surface(call, 0, &s) || !cag_arg_function(call, 1, &f) ||
      !cag_vm_compile_lambda(call->vm,
                             "(s, f, a, b) => surface((u, v) => s(f(u, v)[0], f(u, v)[1]), u: a, "
                             "v: b)",
                             &lambda))
    return false;
  CagValue a = call->values[2], b = call->values[3];
  if (a.type == CAG_UNSET || a.type == CAG_NONE)
    a = cag_domain_value(call->vm, s->angular_u, s->u0, s->u1);
  if (b.type == CAG_UNSET || b.type == CAG_NONE)
    b = cag_domain_value(call->vm, s->angular_v, s->v0, s->v1);
  CagValue arguments[4] = {call->values[0], f, a, b};
  if (!cag_call(call->vm, lambda, arguments, 4, result)) return false;
  cag_shape_say_alike(*result, call->values[0]);
  return true;
}
