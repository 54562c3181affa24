// Members, calls and the printed form of shapes, transforms, planes, cameras, lights and settings.

#include <string.h>

#include "interp/builtin/robots.h"
#include "interp/builtin/shapes.h"
#include "interp/vm/vm.h"

// --- Members ---

static const char *const transform_members[] = {"x", "y", "z", "origin"};
static const char *const plane_members[] = {"point", "normal", "row"};
static const char *const mesh_members[] = {"vertices", "faces"};

// Calls a row from outside of built-ins, and releases what it holds.
static bool call_row(CagCall *call, CagValue *out) {
  const size_t held = call->vm->held_count;
  const bool ok = call->builtin->function(call, out);
  cag_vm_release_held(call->vm, held);
  return ok;
}

// A call of a built-in of one argument, for members that are functions as well.
static bool call_unary(CagVm *vm, const char *function, CagValue v, CagValue *out) {
  size_t index = cag_builtin_find(function), count;
  if (index == (size_t)-1) return false;
  const CagBuiltin *rows = cag_builtin_rows(index, &count);
  size_t row = cag_builtin_select(index, v.type, 1);
  if (row == (size_t)-1) return false;
  CagCall call = {vm, &rows[row], &v, 1, &vm->core_error};
  return call_row(&call, out);
}

static bool is_one_of(const char *name, const char *const *names, size_t n) {
  for (size_t i = 0; i < n; i++)
    if (!strcmp(name, names[i])) return true;
  return false;
}
#define COUNT(array) (sizeof array / sizeof *array)

static bool transform_member(CagVm *vm, const CagTransform *t, const char *name, CagValue *out) {
  for (int j = 0; j < 4; j++) {
    if (strcmp(name, transform_members[j]) != 0) continue;
    *out = cag_point(vm, cag_vec3(t->m[0][j], t->m[1][j], t->m[2][j]), 3);
    return true;
  }
  return false;
}

static bool plane_member(CagVm *vm, const CagPlane *p, const char *name, CagValue *out) {
  double row[4];
  if (!strcmp(name, "point")) *out = cag_point(vm, p->point, 3);
  else if (!strcmp(name, "normal")) *out = cag_point(vm, p->normal, 3);
  else if (!strcmp(name, "row")) {
    cag_plane_row(p, row);
    *out = cag_vector(vm, row, 4);
  } else return false;
  return true;
}

static bool is_staged(CagValue v) {
  return v.type == CAG_CAMERA || v.type == CAG_LIGHT || v.type == CAG_SETTING;
}

bool cag_value_member(CagVm *vm, CagValue object, const char *name, CagValue *out) {
  if (object.type == CAG_TRANSFORM)
    return transform_member(vm, &CAG_AS_TRANSFORM(object)->t, name, out);
  if (object.type == CAG_PLANE) return plane_member(vm, &CAG_AS_PLANE(object)->plane, name, out);
  if (object.type == CAG_ROBOT || object.type == CAG_LINK)
    return cag_robot_member(vm, object, name, out);
  if (is_staged(object)) {
    CagValue field = cag_record_get(CAG_AS_SCENE(object)->fields, name);
    if (field.type == CAG_UNSET) return false;
    *out = field;
    return true;
  }
  if (object.type == CAG_MESH && is_one_of(name, mesh_members, COUNT(mesh_members)))
    return call_unary(vm, name, object, out);
  if (object.type == CAG_GROUP && !strcmp(name, "items")) {
    *out = cag_object(CAG_LIST, CAG_AS_SHAPE(object)->as.items);
    return true;
  }
  return false;
}

static size_t give_names(const char **names, const char *const *from, size_t n) {
  for (size_t i = 0; i < n; i++) names[i] = from[i];
  return n;
}

static size_t field_names(const CagRecord *fields, const char **names) {
  const CagLayout *l = fields->layout;
  const size_t n = l->count < CAG_MEMBERS_MOST ? l->count : CAG_MEMBERS_MOST;
  for (size_t i = 0; i < n; i++) names[i] = l->names[i]->bytes;
  return n;
}

size_t cag_value_members(CagValue object, const char *names[CAG_MEMBERS_MOST]) {
  static const char *const group_members[] = {"items"};
  if (object.type == CAG_ROBOT || object.type == CAG_LINK) {
    size_t n;
    const char *const *members = cag_robot_members(object, &n);
    return give_names(names, members, n);
  }
  if (is_staged(object)) return field_names(CAG_AS_SCENE(object)->fields, names);
  switch (object.type) {
  case CAG_TRANSFORM: return give_names(names, transform_members, COUNT(transform_members));
  case CAG_PLANE: return give_names(names, plane_members, COUNT(plane_members));
  case CAG_MESH: return give_names(names, mesh_members, COUNT(mesh_members));
  case CAG_GROUP: return give_names(names, group_members, COUNT(group_members));
  default: return 0;
  }
}

// --- Calls ---

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

// --- Printed form ---

static void add_range(CagString *s, const char *name, bool angular, double from, double to) {
  cag_string_printf(s, ", %s in ", name);
  cag_print_number(s, angular ? cag_degrees_shown(from) : from);
  cag_string_printf(s, angular ? "deg.." : "..");
  cag_print_number(s, angular ? cag_degrees_shown(to) : to);
  if (angular) cag_string_printf(s, "deg");
}

static void describe_curve(CagString *s, const CagCurve *c) {
  static const char *const splines[] = {"bezier", "bspline", "nurbs"};
  char text[200] = "";
  if (c->kind->describe) c->kind->describe(c, text, sizeof text);
  bool spline = is_one_of(c->kind->name, splines, COUNT(splines));
  cag_string_printf(s, "%s%s%s%s", c->kind->name, spline ? " curve" : "", *text ? ", " : "", text);
  add_range(s, "t", c->angular, c->start, c->end);
}

static void describe_surface(CagString *s, const CagSurface *f) {
  char text[200] = "";
  if (f->kind->describe) f->kind->describe(f, text, sizeof text);
  cag_string_printf(s, "%s surface%s%s", f->kind->name, *text ? ", " : "", text);
  add_range(s, "u", f->angular_u, f->u0, f->u1);
  add_range(s, "v", f->angular_v, f->v0, f->v1);
}

static void add_count(CagString *s, size_t n, const char *one, const char *many) {
  cag_string_printf(s, "%zu %s", n, n == 1 ? one : many);
}

static void describe_region(CagString *s, const CagRegion *r) {
  cag_string_printf(s, cag_region_is_empty(r) ? "empty region" : "region of ");
  if (cag_region_is_empty(r)) return;
  add_count(s, r->count, "curve", "curves");
}

// Fields by name, as far as they are given: "sun, direction [1, 1, -2], ...".
static void describe_staged(CagVm *vm, CagString *s, CagValue v) {
  const CagSceneValue *value = CAG_AS_SCENE(v);
  const char *noun = v.type == CAG_CAMERA ? " camera" : v.type == CAG_LIGHT ? " light" : "";
  cag_string_printf(s, "%s%s", value->kind, !strcmp(value->kind, "sun") ? "" : noun);
  for (size_t i = 0; i < value->fields->layout->count; i++) {
    CagValue field = value->fields->fields[i];
    const char *name = value->fields->layout->names[i]->bytes;
    if (field.type == CAG_NONE || !strcmp(name, "kind")) continue;
    cag_string_printf(s, ", %s ", name);
    cag_print_value(vm, s, field, true);
  }
}

static void print_point(CagString *s, CagVec3 p) {
  const double x[3] = {p.x, p.y, p.z};
  for (int i = 0; i < 3; i++) {
    cag_string_printf(s, i ? ", " : "[");
    cag_print_number(s, x[i]);
  }
  cag_string_printf(s, "]");
}

void cag_describe_shape(CagVm *vm, CagString *s, CagValue v) {
  char text[400] = "";
  switch (v.type) {
  case CAG_CURVE: describe_curve(s, CAG_AS_SHAPE(v)->as.curve); return;
  case CAG_SURFACE: describe_surface(s, CAG_AS_SHAPE(v)->as.surface); return;
  case CAG_REGION: describe_region(s, CAG_AS_SHAPE(v)->as.region); return;
  case CAG_SOLID:
    cag_solid_describe(CAG_AS_SHAPE(v)->as.solid, text, sizeof text);
    cag_string_printf(s, "%s", text);
    return;
  case CAG_MESH:
    cag_string_printf(s, "mesh, ");
    add_count(s, CAG_AS_SHAPE(v)->as.mesh->vertex_count, "vertex", "vertices");
    cag_string_printf(s, ", ");
    add_count(s, CAG_AS_SHAPE(v)->as.mesh->triangle_count, "triangle", "triangles");
    return;
  case CAG_GROUP:
    cag_string_printf(s, "group of ");
    add_count(s, CAG_AS_SHAPE(v)->as.items->length, "shape", "shapes");
    return;
  case CAG_PLANE: {
    const CagPlane *p = &CAG_AS_PLANE(v)->plane;
    cag_string_printf(s, "plane through ");
    print_point(s, p->point);
    cag_string_printf(s, ", normal ");
    print_point(s, p->normal);
    return;
  }
  case CAG_ROBOT:
  case CAG_LINK: cag_describe_robot(vm, s, v); return;
  default:
    if (is_staged(v)) describe_staged(vm, s, v);
    else cag_string_printf(s, "%s", cag_type_name(v));
  }
}
