// The parts of a group, and moving them apart.

#include <string.h>

#include "base/array.h"
#include "geom/solid/csg.h"
#include "interp/builtin/assemblies.h"
#include "interp/builtin/holds.h"
#include "interp/builtin/robots.h"
#include "interp/builtin/scene.h"
#include "interp/vm/vm.h"

static void release_parts(void *what) {
  CagParts *parts = what;
  for (size_t i = 0; i < parts->body_count; i++) cag_solid_release(parts->bodies[i].solid);
  cag_free(parts->bodies);
  cag_free(parts->items);
  cag_free(parts);
}

// --- What is a part ---

static bool holds_names(CagVm *vm, const CagShape *group) {
  if (!cag_may_go_deeper(vm, "searched for parts")) return false;
  const CagList *items = group->as.items;
  for (size_t i = 0; i < items->length; i++) {
    const CagValue item = cag_list_get(vm, items, i);
    if (CAG_AS_SHAPE(item)->name) return true;
    if (item.type == CAG_GROUP && holds_names(vm, CAG_AS_SHAPE(item))) return true;
  }
  return false;
}

bool cag_is_part(CagVm *vm, CagValue group) {
  const CagShape *shape = CAG_AS_SHAPE(group);
  return shape->name && !holds_names(vm, shape);
}

// --- Collecting ---

// What enclosing groups say.
typedef struct PartAround {
  CagRecord *material;
  CagText *given;            // name
  const char *name;          // given, or of a definition; NULL: none
  double tolerance;          // 0: none
  const CagOriginStep *last; // of the part; NULL: not in a part yet
  bool open;                 // groups here are not parts
} PartAround;

typedef struct PartSearch {
  CagCall *call;
  CagParts *parts;
  bool only_shapes;
  bool in_part; // bodies belong to the last part
} PartSearch;

static PartAround said_within(CagVm *vm, const CagShape *s, const PartAround *around) {
  PartAround own = *around;
  const CagText *definition = s->model ? s->model : s->origin.definition;
  own.material = cag_material_combine(vm, s->material, around->material);
  if (s->tolerance > 0) own.tolerance = s->tolerance;
  if (s->name) {
    own.given = s->name;
    own.name = s->name->bytes;
  } else if (definition && !around->given) {
    own.name = definition->bytes;
  }
  return own;
}

static const char *kind_name(CagValue v) {
  const CagShape *s = CAG_AS_SHAPE(v);
  return v.type == CAG_SOLID     ? cag_solid_kind_name(s->as.solid->kind)
         : v.type == CAG_SURFACE ? s->as.surface->kind->name
                                 : "mesh";
}

// Closed surfaces and meshes are bodies. Leaves *out NULL for open ones.
static bool body_solid(CagCall *call, CagValue v, CagSolid **out) {
  const CagShape *s = CAG_AS_SHAPE(v);
  CagSurface *face = s->as.surface;
  *out = NULL;
  if (v.type == CAG_SOLID) *out = cag_solid_retain(s->as.solid);
  if (v.type == CAG_SURFACE && cag_surface_is_closed(face))
    return cag_geometry_ok(call, cag_solid_shell(&face, 1, out, call->err));
  if (v.type == CAG_MESH && cag_mesh_is_watertight(s->as.mesh, NULL))
    return cag_geometry_ok(call, cag_solid_from_mesh(s->as.mesh, out, call->err));
  return true;
}

static CagPart *add_part(PartSearch *p, const PartAround *said, const char *kind) {
  CagParts *parts = p->parts;
  if (!CAG_RESERVE(parts->items, parts->capacity, parts->count + 1))
    cag_vm_out_of_memory(p->call->vm);
  CagPart *part = &parts->items[parts->count++];
  *part = (CagPart){.given = said->given,
                    .name = said->name ? said->name : kind,
                    .last = said->last,
                    .first = parts->body_count};
  return part;
}

static bool add_body(PartSearch *p, CagValue v, const PartAround *said) {
  CagParts *parts = p->parts;
  bool empty;
  if (v.type != CAG_SOLID && v.type != CAG_SURFACE && v.type != CAG_MESH) return true;
  if (!cag_value_is_empty(p->call, v, &empty)) return false;
  if (empty) return true;
  CagPart *part = p->in_part ? &parts->items[parts->count - 1] : add_part(p, said, kind_name(v));
  if (!CAG_RESERVE(parts->bodies, parts->body_capacity, parts->body_count + 1))
    cag_vm_out_of_memory(p->call->vm);
  CagPartBody *body = &parts->bodies[parts->body_count++];
  *body = (CagPartBody){.shape = v, .material = said->material, .tolerance = said->tolerance};
  part->count++;
  return body_solid(p->call, v, &body->solid);
}

static bool add_parts(PartSearch *p, CagValue v, const PartAround *around);

static bool add_items(PartSearch *p, const CagList *items, const PartAround *around) {
  PartAround own = *around;
  own.open = around->open && items->length == 1; // what is alone is opened, too
  for (size_t i = 0; i < items->length; i++) {
    if (i % CAG_LOOK_UP == 0 && !cag_keep_going(p->call->vm)) return false;
    if (!add_parts(p, cag_list_get(p->call->vm, items, i), &own)) return false;
  }
  return true;
}

static bool add_group(PartSearch *p, CagValue v, const PartAround *said) {
  const CagList *items = CAG_AS_SHAPE(v)->as.items;
  if (p->in_part || said->open || !cag_is_part(p->call->vm, v)) return add_items(p, items, said);
  add_part(p, said, "group");
  const size_t at = p->parts->count - 1;
  p->in_part = true;
  const bool ok = add_items(p, items, said);
  p->in_part = false;
  if (ok && p->parts->items[at].count == 0) p->parts->count--; // nothing in it is a body
  return ok;
}

static bool add_parts(PartSearch *p, CagValue v, const PartAround *around) {
  CagVm *vm = p->call->vm;
  if (!cag_may_go_deeper(vm, "searched for parts")) return false;
  if (v.type == CAG_LIST) return add_items(p, CAG_AS_LIST(v), around);
  if (v.type == CAG_ROBOT) {
    CagValue group;
    return cag_robot_at_home(vm, v, &group) && add_parts(p, group, around);
  }
  if (!cag_is_shape(v))
    return !p->only_shapes ||
           cag_fail_call(p->call, 0, CAG_ERR_type, "expects shapes, or lists of shapes, found %s",
                         cag_type_article(v));
  const CagShape *shape = CAG_AS_SHAPE(v);
  if (shape->hidden) return true;
  PartAround said = said_within(vm, shape, around);
  if (!p->in_part) said.last = shape->origin.last;
  return v.type == CAG_GROUP ? add_group(p, v, &said) : add_body(p, v, &said);
}

CagParts *cag_parts_of(CagCall *call, CagValue v, bool only_shapes) {
  CagParts *parts = cag_calloc(1, sizeof *parts);
  if (!parts) cag_vm_out_of_memory(call->vm);
  cag_hold_for(call, release_parts, parts);
  PartSearch search = {.call = call, .parts = parts, .only_shapes = only_shapes};
  return add_parts(&search, v, &(PartAround){.open = true}) ? parts : NULL;
}

// --- exploded ---

typedef struct Exploding {
  CagCall *call;
  CagVec3 center;
  double factor;
} Exploding;

static bool explode_items(const Exploding *e, CagList *items, bool open, CagValue *result);

static bool is_all_empty(CagCall *call, CagValue v, bool *out) {
  CagBuilder *shapes = cag_builder_new(call->vm);
  if (!cag_shapes_collect(call, v, shapes)) return false;
  const CagValue list = cag_builder_finish(call->vm, shapes);
  *out = true;
  for (size_t i = 0; *out && i < CAG_AS_LIST(list)->length; i++)
    if (!cag_value_is_empty(call, cag_list_get(call->vm, CAG_AS_LIST(list), i), out)) return false;
  return true;
}

static bool explode_part(const Exploding *e, CagValue v, CagValue *result) {
  CagBounds box;
  int dimension;
  bool empty;
  *result = v;
  if (!is_all_empty(e->call, v, &empty)) return false;
  if (empty) return true;
  if (!cag_value_bounds(e->call, v, &box, &dimension)) return false;
  const CagVec3 from_center = cag_sub(cag_lerp(box.min, box.max, 0.5), e->center);
  CagTransform t = cag_translate(cag_scaled(from_center, e->factor - 1));
  t.planar = dimension == 2;
  return cag_transform_apply(e->call->vm, &t, v, result);
}

// open: the group is not a part, even if it has a name.
static bool explode(const Exploding *e, CagValue v, bool open, CagValue *result) {
  if (!cag_may_go_deeper(e->call->vm, "moved apart")) return false;
  if (v.type == CAG_ROBOT && !cag_robot_at_home(e->call->vm, v, &v)) return false;
  if (v.type == CAG_LIST) return explode_items(e, CAG_AS_LIST(v), open, result);
  if (v.type != CAG_GROUP || (!open && cag_is_part(e->call->vm, v)))
    return explode_part(e, v, result);
  if (!explode_items(e, CAG_AS_SHAPE(v)->as.items, open, result)) return false;
  cag_shape_say_alike(*result, v);
  return true;
}

static bool explode_items(const Exploding *e, CagList *items, bool open, CagValue *result) {
  CagBuilder *moved = cag_builder_new(e->call->vm);
  for (size_t i = 0; i < items->length; i++) {
    CagValue one;
    if (i % CAG_LOOK_UP == 0 && !cag_keep_going(e->call->vm)) return false;
    if (!explode(e, cag_list_get(e->call->vm, items, i), open && items->length == 1, &one) ||
        !cag_builder_add(e->call->vm, moved, one))
      return false;
  }
  *result = cag_group_value(e->call->vm, cag_builder_finish(e->call->vm, moved));
  return true;
}

bool cag_assemblies_exploded(CagCall *call, const struct cag_assemblies_exploded *a,
                             CagValue *result) {
  CagBounds whole;
  int dimension;
  if (!cag_value_bounds(call, a->G, &whole, &dimension)) return false;
  const Exploding e = {call, cag_lerp(whole.min, whole.max, 0.5), a->factor};
  if (!explode(&e, a->G, true, result)) return false;
  if (result->type == CAG_GROUP) return true;
  CagBuilder *one = cag_builder_new(call->vm);
  if (!cag_builder_add(call->vm, one, *result)) return false;
  *result = cag_group_value(call->vm, cag_builder_finish(call->vm, one));
  return true;
}
