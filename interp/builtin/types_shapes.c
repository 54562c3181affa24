// The types of geometry: transforms, planes, and shapes.

#include <string.h>

#include "geom/solid/csg.h"
#include "interp/builtin/shapes.h"
#include "interp/builtin/types.h"
#include "interp/vm/vm.h"

// --- Transforms ---

static void print_transform(CagVm *vm, CagString *s, CagValue v) {
  const CagTransform *t = &CAG_AS_TRANSFORM(v)->t;
  cag_string_printf(s, "[");
  for (int i = 0; i < 4; i++) {
    if (i) cag_string_printf(s, ", ");
    cag_print_numbers(vm, s, t->m[i], 4);
  }
  cag_string_printf(s, "]");
}

static bool equal_transforms(CagVm *vm, CagValue a, CagValue b) {
  (void)vm;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      if (CAG_AS_TRANSFORM(a)->t.m[i][j] != CAG_AS_TRANSFORM(b)->t.m[i][j]) return false;
  return true;
}

static const char *const transform_members[] = {"x", "y", "z", "origin", NULL};

static bool transform_member(CagVm *vm, CagValue v, const char *name, CagValue *out) {
  const CagTransform *t = &CAG_AS_TRANSFORM(v)->t;
  for (int j = 0; j < 4; j++) {
    if (strcmp(name, transform_members[j]) != 0) continue;
    *out = cag_point(vm, cag_vec3(t->m[0][j], t->m[1][j], t->m[2][j]), 3);
    return true;
  }
  return false;
}

static const char *transform_member_name(CagVm *vm, CagValue v, size_t i) {
  (void)vm, (void)v;
  return cag_name_at(transform_members, i);
}

static bool multiply(CagCall *call, const CagTransform *t, CagValue v, CagValue *result) {
  const CagTransform product = cag_transform_multiply(t, &CAG_AS_TRANSFORM(v)->t);
  *result = cag_transform_value(call->vm, &product);
  return true;
}

const CagValueType cag_type_transform = {.print = print_transform,
                                         .equal = equal_transforms,
                                         .member = transform_member,
                                         .member_name = transform_member_name,
                                         .transform = multiply};

// --- Planes ---

static void print_plane(CagVm *vm, CagString *s, CagValue v) {
  const CagPlane *p = &CAG_AS_PLANE(v)->plane;
  cag_string_printf(s, "plane through ");
  cag_print_numbers(vm, s, &p->point.x, 3);
  cag_string_printf(s, ", normal ");
  cag_print_numbers(vm, s, &p->normal.x, 3);
}

static bool equal_vectors(CagVec3 a, CagVec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

static bool equal_planes(CagVm *vm, CagValue a, CagValue b) {
  (void)vm;
  const CagPlane *x = &CAG_AS_PLANE(a)->plane, *y = &CAG_AS_PLANE(b)->plane;
  return equal_vectors(x->point, y->point) && equal_vectors(x->normal, y->normal);
}

static bool plane_member(CagVm *vm, CagValue v, const char *name, CagValue *out) {
  const CagPlane *p = &CAG_AS_PLANE(v)->plane;
  double row[4];
  if (!strcmp(name, "point")) *out = cag_point(vm, p->point, 3);
  else if (!strcmp(name, "normal")) *out = cag_point(vm, p->normal, 3);
  else if (!strcmp(name, "row")) {
    cag_plane_row(p, row);
    *out = cag_vector(vm, row, 4);
  } else return false;
  return true;
}

static const char *plane_member_name(CagVm *vm, CagValue v, size_t i) {
  (void)vm, (void)v;
  static const char *const names[] = {"point", "normal", "row", NULL};
  return cag_name_at(names, i);
}

static bool move_plane(CagCall *call, const CagTransform *t, CagValue v, CagValue *result) {
  CagPlane moved;
  const CagPlane *plane = &CAG_AS_PLANE(v)->plane;
  if (!cag_geometry_ok(call, cag_plane_transform(plane, t, &moved, call->err))) return false;
  *result = cag_plane_value(call->vm, &moved);
  return true;
}

const CagValueType cag_type_plane = {.print = print_plane,
                                     .equal = equal_planes,
                                     .member = plane_member,
                                     .member_name = plane_member_name,
                                     .transform = move_plane};

// --- Calls of built-ins ---

// Calls a row from outside of a built-in, and releases what it holds.
static bool call_row(CagCall *call, CagValue *out) {
  const size_t held = call->vm->held_count;
  const bool ok = call->builtin->function(call, out);
  cag_vm_release_held(call->vm, held);
  return ok;
}

// Calls a built-in of one argument, for members that are functions as well.
static bool call_unary(CagVm *vm, const char *function, CagValue v, CagValue *out) {
  size_t index = cag_builtin_find(function), count;
  if (index == (size_t)-1) return false;
  const CagBuiltin *rows = cag_builtin_rows(index, &count);
  size_t row = cag_builtin_select(index, v.type, 1);
  if (row == (size_t)-1) return false;
  CagCall call = {vm, &rows[row], &v, 1, &vm->core_error};
  return call_row(&call, out);
}

// Evaluates c(t) or s(u, v).
bool cag_shape_call(CagVm *vm, CagValue shape, const CagValue *arguments, size_t n,
                    CagValue *result) {
  size_t index = cag_builtin_find("at"), count, wanted = shape.type == CAG_CURVE ? 1 : 2;
  const CagBuiltin *rows = cag_builtin_rows(index, &count);
  size_t row = cag_builtin_select(index, shape.type, wanted + 1);
  CagValue values[4] = {shape, cag_unset(), cag_unset(), cag_unset()};
  for (size_t i = 0; i < n && i < wanted; i++) values[i + 1] = arguments[i];
  CagCall call = {vm, &rows[row], values, 3, &vm->core_error};
  if (n != wanted)
    return cag_fail_call(&call, -1, CAG_ERR_arity,
                         shape.type == CAG_CURVE ? "of a curve expects one parameter, found %zu"
                                                 : "of a surface expects u and v, found %zu",
                         n);
  return call_row(&call, result);
}

// --- Common to all shapes ---

static void scan_shape(CagHeap *h, CagObject *o) {
  const CagShape *s = (CagShape *)o;
  if (s->material) cag_mark_object(h, &s->material->head);
  if (s->name) cag_mark_object(h, &s->name->head);
  if (s->frames) cag_mark_object(h, &s->frames->head);
  cag_mark_origin(h, &s->origin);
  if (s->motion) cag_mark_object(h, &s->motion->head);
  if (s->still) cag_mark_object(h, &s->still->head);
  if (s->limb) cag_mark_object(h, &s->limb->head);
}

static void add_count(CagString *s, size_t n, const char *one, const char *many) {
  cag_string_printf(s, "%zu %s", n, n == 1 ? one : many);
}

// The columns that are the same for the types of curves, surfaces, solids, and meshes.
#define SHAPE(Type, name)                                                                          \
  static void retain_##name(CagObject *o) { cag_##name##_retain(((CagShape *)o)->as.name); }       \
  static void destroy_##name(CagObject *o) { cag_##name##_release(((CagShape *)o)->as.name); }     \
  static bool move_##name(CagCall *call, const CagTransform *t, CagValue v, CagValue *result) {    \
    Type *moved;                                                                                   \
    if (!cag_geometry_ok(call,                                                                     \
                         cag_##name##_transform(CAG_AS_SHAPE(v)->as.name, t, &moved, call->err)))  \
      return false;                                                                                \
    *result = cag_##name##_value(call->vm, moved);                                                 \
    cag_shape_say_alike(*result, v);                                                               \
    return true;                                                                                   \
  }

// `frames`, which every shape may have.
static bool shape_member(CagVm *vm, CagValue v, const char *name, CagValue *out) {
  const CagShape *s = CAG_AS_SHAPE(v);
  if (strcmp(name, "frames") != 0) return false;
  if (!s->frames) {
    cag_vm_fail(vm, CAG_ERR_field, "%s has no frames", cag_type_article(v));
    return cag_fail_help(vm, "give it frames by with_frames(shape, {top: translate([0, 0, 10])})");
  }
  *out = cag_object(CAG_RECORD, s->frames);
  return true;
}

static const char *shape_member_name(CagVm *vm, CagValue v, size_t i) {
  (void)vm;
  return i == 0 && CAG_AS_SHAPE(v)->frames ? "frames" : NULL;
}

// Beside the members of a type, which `names` has.
static const char *further_member_name(CagVm *vm, CagValue v, const char *const *names, size_t i) {
  size_t n = 0;
  while (names[n]) n++;
  return i < n ? names[i] : shape_member_name(vm, v, i - n);
}

// --- Curves and surfaces ---

SHAPE(CagCurve, curve)
SHAPE(CagSurface, surface)

static void add_range(CagString *s, const char *name, bool angular, double from, double to) {
  cag_string_printf(s, ", %s in ", name);
  cag_print_number(s, angular ? cag_degrees_shown(from) : from);
  cag_string_printf(s, angular ? "deg.." : "..");
  cag_print_number(s, angular ? cag_degrees_shown(to) : to);
  if (angular) cag_string_printf(s, "deg");
}

static void print_curve(CagVm *vm, CagString *s, CagValue v) {
  (void)vm;
  const CagCurve *c = CAG_AS_SHAPE(v)->as.curve;
  char text[200] = "";
  if (c->kind->describe) c->kind->describe(c, text, sizeof text);
  const char *kind = c->kind->name;
  const bool spline = !strcmp(kind, "bezier") || !strcmp(kind, "bspline") || !strcmp(kind, "nurbs");
  cag_string_printf(s, "%s%s%s%s", kind, spline ? " curve" : "", *text ? ", " : "", text);
  add_range(s, "t", c->angular, c->start, c->end);
}

static void print_surface(CagVm *vm, CagString *s, CagValue v) {
  (void)vm;
  const CagSurface *f = CAG_AS_SHAPE(v)->as.surface;
  char text[200] = "";
  if (f->kind->describe) f->kind->describe(f, text, sizeof text);
  cag_string_printf(s, "%s surface%s%s", f->kind->name, *text ? ", " : "", text);
  add_range(s, "u", f->angular_u, f->u0, f->u1);
  add_range(s, "v", f->angular_v, f->v0, f->v1);
}

const CagValueType cag_type_curve = {.print = print_curve,
                                     .scan = scan_shape,
                                     .retain = retain_curve,
                                     .destroy = destroy_curve,
                                     .call = cag_shape_call,
                                     .member = shape_member,
                                     .member_name = shape_member_name,
                                     .transform = move_curve};
const CagValueType cag_type_surface = {.print = print_surface,
                                       .scan = scan_shape,
                                       .retain = retain_surface,
                                       .destroy = destroy_surface,
                                       .call = cag_shape_call,
                                       .member = shape_member,
                                       .member_name = shape_member_name,
                                       .transform = move_surface};

// --- Regions ---

static void print_region(CagVm *vm, CagString *s, CagValue v) {
  (void)vm;
  const CagRegion *r = CAG_AS_SHAPE(v)->as.region;
  cag_string_printf(s, cag_region_is_empty(r) ? "empty region" : "region of ");
  if (!cag_region_is_empty(r)) add_count(s, r->count, "curve", "curves");
}

static void retain_region(CagObject *o) { cag_region_retain(((CagShape *)o)->as.region); }
static void destroy_region(CagObject *o) { cag_region_release(((CagShape *)o)->as.region); }

static bool move_region(CagCall *call, const CagTransform *t, CagValue v, CagValue *result) {
  const CagShape *shape = CAG_AS_SHAPE(v);
  CagTransform place = cag_transform_multiply(t, shape->placement);
  CagRegion *moved;
  if (t->planar && shape->placement->planar) {
    if (!cag_geometry_ok(call, cag_region_transform(shape->as.region, &place, &moved, call->err)))
      return false;
    *result = cag_region_value(call->vm, moved, NULL);
  } else {
    place.planar = false;
    *result = cag_region_value(call->vm, cag_region_retain(shape->as.region), &place);
  }
  cag_shape_say_alike(*result, v);
  return true;
}

const CagValueType cag_type_region = {.print = print_region,
                                      .scan = scan_shape,
                                      .retain = retain_region,
                                      .destroy = destroy_region,
                                      .member = shape_member,
                                      .member_name = shape_member_name,
                                      .transform = move_region};

// --- Solids and meshes ---

SHAPE(CagSolid, solid)
SHAPE(CagMesh, mesh)

// A set operation keeps its operands.
static bool move_operation(CagCall *call, const CagTransform *t, CagValue v, CagValue *result) {
  if (!move_solid(call, t, v, result)) return false;
  CAG_AS_SHAPE(*result)->origin.operands = CAG_AS_SHAPE(v)->origin.operands;
  return true;
}

static void print_solid(CagVm *vm, CagString *s, CagValue v) {
  (void)vm;
  char text[400] = "";
  cag_solid_describe(CAG_AS_SHAPE(v)->as.solid, text, sizeof text);
  cag_string_printf(s, "%s", text);
}

static void print_mesh(CagVm *vm, CagString *s, CagValue v) {
  (void)vm;
  const CagMesh *m = CAG_AS_SHAPE(v)->as.mesh;
  cag_string_printf(s, "mesh, ");
  add_count(s, m->vertex_count, "vertex", "vertices");
  cag_string_printf(s, ", ");
  add_count(s, m->triangle_count, "triangle", "triangles");
}

static const char *const mesh_members[] = {"vertices", "faces", NULL};

static bool mesh_member(CagVm *vm, CagValue v, const char *name, CagValue *out) {
  for (size_t i = 0; mesh_members[i]; i++)
    if (!strcmp(name, mesh_members[i])) return call_unary(vm, name, v, out);
  return shape_member(vm, v, name, out);
}

static const char *mesh_member_name(CagVm *vm, CagValue v, size_t i) {
  return further_member_name(vm, v, mesh_members, i);
}

const CagValueType cag_type_solid = {.print = print_solid,
                                     .scan = scan_shape,
                                     .retain = retain_solid,
                                     .destroy = destroy_solid,
                                     .call = cag_shape_call,
                                     .member = shape_member,
                                     .member_name = shape_member_name,
                                     .transform = move_operation};
const CagValueType cag_type_mesh = {.print = print_mesh,
                                    .scan = scan_shape,
                                    .retain = retain_mesh,
                                    .destroy = destroy_mesh,
                                    .member = mesh_member,
                                    .member_name = mesh_member_name,
                                    .transform = move_mesh};

// --- Labels ---

static void print_label(CagVm *vm, CagString *s, CagValue v) {
  (void)vm;
  cag_string_printf(s, "label ");
  cag_print_quoted(s, CAG_AS_SHAPE(v)->as.label->text);
}

static void scan_label(CagHeap *h, CagObject *o) {
  cag_mark_object(h, &((CagShape *)o)->as.label->head);
  scan_shape(h, o);
}

static bool move_label(CagCall *call, const CagTransform *t, CagValue v, CagValue *result) {
  CagLabelText moved = *CAG_AS_SHAPE(v)->as.label;
  const CagVec3 end = cag_transform_point(t, cag_add(moved.at, moved.along));
  const bool directed = cag_norm(moved.along) > 0;
  moved.at = cag_transform_point(t, moved.at);
  if (directed) moved.along = cag_sub(end, moved.at);
  *result = cag_label_value(call->vm, &moved);
  cag_shape_say_alike(*result, v);
  return true;
}

const CagValueType cag_type_label = {.print = print_label,
                                     .scan = scan_label,
                                     .member = shape_member,
                                     .member_name = shape_member_name,
                                     .transform = move_label};

// --- Groups ---

static void print_group(CagVm *vm, CagString *s, CagValue v) {
  (void)vm;
  cag_string_printf(s, "group of ");
  add_count(s, CAG_AS_SHAPE(v)->as.items->length, "shape", "shapes");
}

static void scan_group(CagHeap *h, CagObject *o) {
  const CagShape *s = (CagShape *)o;
  if (s->as.items) cag_mark_object(h, &s->as.items->head);
  if (s->drawn) cag_mark_object(h, &s->drawn->head);
  scan_shape(h, o);
}

static const char *const group_members[] = {"items", NULL};

static bool group_member(CagVm *vm, CagValue v, const char *name, CagValue *out) {
  if (strcmp(name, "items") != 0) return shape_member(vm, v, name, out);
  *out = cag_object(CAG_LIST, CAG_AS_SHAPE(v)->as.items);
  return true;
}

static const char *group_member_name(CagVm *vm, CagValue v, size_t i) {
  return further_member_name(vm, v, group_members, i);
}

static bool move_group(CagCall *call, const CagTransform *t, CagValue v, CagValue *result) {
  CagValue items;
  if (!cag_move_list(call, t, cag_object(CAG_LIST, CAG_AS_SHAPE(v)->as.items), &items))
    return false;
  *result = cag_group_value(call->vm, items);
  cag_shape_say_alike(*result, v);
  return true;
}

const CagValueType cag_type_group = {.print = print_group,
                                     .scan = scan_group,
                                     .member = group_member,
                                     .member_name = group_member_name,
                                     .transform = move_group};
