// Set operations of solids, half spaces, bodies bounded by quadrics, and clipping.

#include <string.h>

#include "geom/solid/clip.h"
#include "geom/solid/csg.h"
#include "interp/builtin/holds.h"
#include "interp/builtin/scene.h"
#include "interp/builtin/solids.h"
#include "interp/builtin/surfaces.h"
#include "interp/vm/vm.h"

// The result has the material, tolerance, and frames of the first operand, but not its name and
// visibility.
static void inherit_material(CagValue to, const CagShape *from) {
  CAG_AS_SHAPE(to)->material = from->material;
  CAG_AS_SHAPE(to)->tolerance = from->tolerance;
}

// A mesh is made after the script has ended. If that fails, the message needs the location of the
// set operation.
static void record_location(const CagCall *call, CagSolid *s) {
  const CagSource *source;
  CagSpan span;
  if (!s->core || !cag_vm_place(call->vm, &source, &span)) return;
  s->core->place = (CagSolidPlace){source, span.start, span.end};
}

// --- Materials of operands ---

// If operands have materials of their own, each face of the result has the material of its operand.
// The labels of solids and meshes are numbers of records that the machine keeps. Operands without a
// material get that of the first.
typedef struct Paint {
  CagVm *vm;
  bool mixed;       // labels are needed, because there are several materials
  CagRecord *first; // may be NULL
  CagRecord *said;  // that of the current shape
} Paint;

CagRecord *cag_solids_material(const CagVm *vm, uint32_t label) {
  const bool known = label > 0 && label <= vm->kept_count;
  const CagValue v = known ? vm->kept[label - 1] : cag_unset();
  return v.type == CAG_RECORD ? CAG_AS_RECORD(v) : NULL;
}

static uint64_t hash_field(const CagText *name, CagValue v) {
  const uint64_t h = cag_hash_bytes(CAG_HASH_START, name->bytes, name->length);
  const double *x;
  size_t n;
  if (v.type == CAG_NUMBER) return cag_hash_number(h, v.as.number);
  if (v.type == CAG_TEXT) return cag_hash_text(h, CAG_AS_TEXT(v)->bytes);
  if (v.type != CAG_LIST || !cag_as_vector(v, &x, &n)) return h;
  uint64_t numbers = h;
  for (size_t i = 0; i < n; i++) numbers = cag_hash_number(numbers, x[i]);
  return numbers;
}

// A sum, because equal records may have their fields in any order.
static uint64_t hash_record(const CagRecord *r) {
  uint64_t sum = 0;
  for (size_t i = 0; i < r->layout->count; i++)
    sum += hash_field(r->layout->names[i], r->fields[i]);
  return sum;
}

static uint32_t label_of(CagVm *vm, CagRecord *material) {
  if (!material) return 0;
  const CagValue v = cag_object(CAG_RECORD, material);
  const uint64_t hash = hash_record(material);
  size_t slot;
  for (CagHashWalk w = cag_hash_walk(&vm->kept_materials, hash); cag_hash_next(&w, &slot);)
    if (cag_equal(vm, vm->kept[slot], v)) return (uint32_t)slot + 1;
  slot = cag_vm_keep(vm, v);
  if (!cag_hash_add(&vm->kept_materials, hash, slot)) cag_vm_out_of_memory(vm);
  return (uint32_t)slot + 1;
}

typedef struct Relabeling {
  const Paint *paint;
  uint32_t label;
} Relabeling;

static bool find_label(CagVm *vm, void *context) {
  Relabeling *r = context;
  CagRecord *own = cag_solids_material(vm, r->label), *said = r->paint->said;
  if (!own) r->label = label_of(vm, said ? said : r->paint->first);
  else if (said) r->label = label_of(vm, cag_material_combine(vm, own, said));
  return true;
}

// The core holds memory while it asks for a label, so running out of memory must not jump past it.
static uint32_t relabel(void *context, uint32_t label) {
  const Paint *paint = context;
  Relabeling r = {paint, label};
  cag_vm_call_back(paint->vm, find_label, &r); // leaves the error for relabel_operand
  return r.label;
}

static bool same_record(CagVm *vm, CagRecord *a, CagRecord *b) {
  return a == b || (a && b && cag_equal(vm, cag_object(CAG_RECORD, a), cag_object(CAG_RECORD, b)));
}

// Finds the materials of all operands before any of them is read.
static bool find_paint(CagCall *call, const CagValue *items, size_t n, Paint *out) {
  *out = (Paint){.vm = call->vm};
  CagBuilder *builder = cag_builder_new(call->vm);
  for (size_t i = 0; i < n; i++)
    if (!cag_shapes_collect(call, items[i], builder)) return false;
  const CagList *shapes = CAG_AS_LIST(cag_builder_finish(call->vm, builder));
  for (size_t i = 0; i < shapes->length; i++) {
    const CagValue v = cag_list_get(call->vm, shapes, i);
    const CagShape *s = CAG_AS_SHAPE(v);
    const uint32_t label = v.type == CAG_SOLID ? cag_solid_first_label(s->as.solid) : 0;
    if (i == 0) out->first = s->material ? s->material : cag_solids_material(call->vm, label);
    else if (s->material && !same_record(call->vm, s->material, out->first)) out->mixed = true;
    out->mixed = out->mixed || label != 0;
  }
  return true;
}

// --- Origins of operands ---

// The operands that take the place of one that dissolves, which has a core.
static size_t origin_count(const CagSolid *operand, CagSetOperation op, size_t index) {
  return operand->core && cag_solid_dissolves(operand, op, index) ? operand->core->count : 1;
}

static CagOperands *known_operands(const CagOrigin *o, const CagSolid *s) {
  return s->core && o->operands && o->operands->count == s->core->count ? o->operands : NULL;
}

// Where the operands of a set operation come from, in the order in which cag_solid_combine keeps
// them. `origins` are those of n operands.
static CagOperands *operands_of(CagVm *vm, CagSetOperation op, CagSolid *const *operands,
                                const CagOrigin *origins, size_t n) {
  size_t count = 0, at = 0;
  CagOperands *first =
      cag_solid_dissolves(operands[0], op, 0) ? known_operands(&origins[0], operands[0]) : NULL;
  const size_t from = first ? 1 : 0;
  for (size_t i = from; i < n; i++) count += origin_count(operands[i], op, i);
  CagOperands *out = cag_operands_new(vm, first, count);
  for (size_t i = from; i < n; i++) {
    const CagOperands *known = known_operands(&origins[i], operands[i]);
    if (!cag_solid_dissolves(operands[i], op, i)) out->items[at] = origins[i];
    else if (known) cag_operands_list(known, out->items + at);
    at += origin_count(operands[i], op, i);
  }
  return out;
}

// --- Operands ---

// Adds the number of the operand to an error, counted from 1.
static bool operand_ok(CagCall *call, CagStatus status, CagError *err, size_t index) {
  if (!status) return true;
  if (err->index < 0 && strcmp(err->argument, "surfaces") != 0) {
    char text[sizeof err->message];
    snprintf(text, sizeof text, "operand %zu: %.360s", index + 1, err->message);
    memcpy(err->message, text, sizeof text);
  }
  return cag_fail_geometry(call, err);
}

// Reads one body: a solid, or a closed mesh or surface.
static bool read_one(CagCall *call, CagValue v, size_t index, CagSolid **out) {
  const CagShape *shape = CAG_AS_SHAPE(v);
  CagSurface *face;
  switch (v.type) {
  case CAG_SOLID: *out = cag_solid_retain(shape->as.solid); return true;
  case CAG_MESH:
    return operand_ok(call, cag_solid_from_mesh(shape->as.mesh, out, call->err), call->err, index);
  case CAG_SURFACE:
    face = shape->as.surface;
    return operand_ok(call, cag_solid_shell(&face, 1, out, call->err), call->err, index);
  default:
    return cag_fail_call(
        call, -1, CAG_ERR_csg_operand,
        "expects solids, closed meshes, and closed surfaces, found %s as operand %zu, which encloses no volume",
        cag_type_article(v), index + 1);
  }
}

static bool relabel_operand(CagCall *call, Paint *paint, CagSolid **operand) {
  CagSolid *labeled;
  if (!cag_geometry_ok(call, cag_solid_relabel(*operand, relabel, paint, &labeled, call->err)))
    return false;
  cag_solid_release(*operand);
  *operand = labeled;
  return !call->vm->failed;
}

static CagStatus combine(CagCall *call, CagSetOperation op, CagSolid **operands, size_t n,
                         CagSolid **out, CagError *err) {
  if (n == 1) {
    *out = cag_solid_retain(operands[0]);
    return CAG_OK;
  }
  const CagStatus status = cag_solid_combine(op, operands, n, cag_vm_stop(call->vm), out, err);
  if (!status) record_location(call, *out);
  return status;
}

// Reads a shape, or a group or list, whose shapes are united. If there are none, the result is an
// empty solid. `said` is the first shape, if any. *origin is that of the only shape, or has those
// of several.
static bool read_operand(CagCall *call, CagValue v, size_t index, Paint *paint, CagSolid **out,
                         CagOrigin *origin, CagValue *said) {
  CagList *shapes;
  if (!cag_list_shapes(call, v, &shapes)) return false;
  if (shapes->length == 0) return cag_geometry_ok(call, cag_solid_empty(out, call->err));
  CagSolid **parts = cag_hold_solid_array(call, shapes->length);
  *said = cag_list_get(call->vm, shapes, 0);
  CagOperands *origins = cag_operands_new(call->vm, NULL, shapes->length);
  for (size_t i = 0; i < shapes->length; i++) {
    const CagValue shape = cag_list_get(call->vm, shapes, i);
    origins->items[i] = CAG_AS_SHAPE(shape)->origin;
    if (!read_one(call, shape, index, &parts[i])) return false;
    if (!paint || !paint->mixed) continue;
    paint->said = CAG_AS_SHAPE(shape)->material;
    if (!relabel_operand(call, paint, &parts[i])) return false;
  }
  if (shapes->length == 1) *origin = origins->items[0];
  else origin->operands = operands_of(call->vm, CAG_UNION, parts, origins->items, shapes->length);
  const CagStatus status = combine(call, CAG_UNION, parts, shapes->length, out, call->err);
  cag_release_held(call, parts);
  return cag_geometry_ok(call, status);
}

// --- union, difference, intersection ---

// Set operations on regions have rows of their own. The first shape of a list or group decides.
static bool holds_region(CagVm *vm, CagValue v) {
  for (;;) {
    const CagList *items = v.type == CAG_GROUP ? CAG_AS_SHAPE(v)->as.items
                           : v.type == CAG_LIST && CAG_AS_LIST(v)->dim == 0 ? CAG_AS_LIST(v)
                                                                            : NULL;
    if (!items || items->length == 0) return v.type == CAG_REGION;
    v = cag_list_get(vm, items, 0);
  }
}

// Skips empty lists and groups, which are compatible with both.
static bool is_of_regions(CagCall *call) {
  CagValue *items;
  size_t n;
  if (call->values[0].type == CAG_LIST && CAG_AS_LIST(call->values[0])->dim != 0) return false;
  if (!cag_arg_several(call, &items, &n)) return false;
  for (size_t i = 0; i < n; i++) {
    if (holds_region(call->vm, items[i])) return true;
    const bool nothing =
        (items[i].type == CAG_LIST && CAG_AS_LIST(items[i])->length == 0) ||
        (items[i].type == CAG_GROUP && CAG_AS_SHAPE(items[i])->as.items->length == 0);
    if (!nothing) return false;
  }
  return false;
}

static bool call_of_regions(CagCall *call, CagValue *result) {
  const size_t index = cag_builtin_find(cag_builtin_signature_of(call->builtin)->name);
  size_t count;
  CagCall regions = *call;
  regions.builtin =
      &cag_builtin_rows(index, &count)[cag_builtin_select(index, CAG_REGION, call->count)];
  return regions.builtin->function(&regions, result);
}

static bool operate(CagCall *call, CagSetOperation op, CagValue *result) {
  CagValue *items, said = cag_unset(), unused;
  size_t n;
  CagSolid *made = NULL;
  if (is_of_regions(call)) return call_of_regions(call, result);
  if (!cag_arg_several(call, &items, &n)) return false;
  if (n == 0)
    return cag_fail_call(call, -1, CAG_ERR_csg_operand, "expects solids, found an empty list");
  CagSolid **operands = cag_hold_solid_array(call, n);
  CagOperands *origins = cag_operands_new(call->vm, NULL, n);
  Paint paint;
  if (!find_paint(call, items, n, &paint)) return false;
  for (size_t i = 0; i < n; i++)
    if ((i % CAG_LOOK_UP == 0 && !cag_keep_going(call->vm)) ||
        !read_operand(call, items[i], i, &paint, &operands[i], &origins->items[i],
                      i == 0 ? &said : &unused))
      return false;
  CagOperands *origin = n > 1 ? operands_of(call->vm, op, operands, origins->items, n) : NULL;
  if (!cag_solid_result(call, combine(call, op, operands, n, &made, call->err), &made, result))
    return false;
  CagShape *shape = CAG_AS_SHAPE(*result);
  if (n > 1) shape->origin.operands = origin;
  else
    shape->origin =
        (CagOrigin){.last = origins->items[0].last, .operands = origins->items[0].operands};
  shape->copied = n == 1;
  if (said.type != CAG_UNSET) inherit_material(*result, CAG_AS_SHAPE(said));
  if (paint.mixed) CAG_AS_SHAPE(*result)->material = NULL; // its faces have their own
  if (cag_is_shape(items[0])) shape->frames = CAG_AS_SHAPE(items[0])->frames;
  return true;
}

bool cag_solids_union(CagCall *call, CagValue *result) { return operate(call, CAG_UNION, result); }
bool cag_solids_difference(CagCall *call, CagValue *result) {
  return operate(call, CAG_DIFFERENCE, result);
}
bool cag_solids_intersection(CagCall *call, CagValue *result) {
  return operate(call, CAG_INTERSECTION, result);
}

// --- Half spaces ---

bool cag_solids_half_space(CagCall *call, const struct cag_solids_half_space *a, CagValue *result) {
  CagSolid *s = NULL;
  const CagStatus status = cag_solid_half_space(&a->plane, &s, call->err);
  if (!status) record_location(call, s);
  return cag_solid_result(call, status, &s, result);
}

// The half spaces whose intersection is the slab between two heights.
static CagStatus heights(double low, double high, CagSolid *out[2], CagError *err) {
  CagPlane floor = {{0, 0, low}, {0, 0, -1}}, roof = {{0, 0, high}, {0, 0, 1}};
  CagStatus status = cag_solid_half_space(&floor, &out[0], err);
  return status ? status : cag_solid_half_space(&roof, &out[1], err);
}

bool cag_solids_of_form(CagCall *call, const CagQuadric *q, int within, CagValue *result) {
  CagSolid **parts = cag_hold_solid_array(call, 3), *made = NULL;
  const CagValue v = call->values[within];
  size_t n = 1;
  double low, high;
  bool angle;
  if (v.type == CAG_SOLID) {
    parts[n++] = cag_solid_retain(CAG_AS_SHAPE(v)->as.solid);
  } else if (cag_given(call, within)) {
    if (v.type != CAG_RANGE || !cag_arg_interval(call, within, &low, &high, &angle) || angle)
      return cag_fail_type(call, within, "a solid or a range of z");
    if (!(low < high))
      return cag_fail_call(call, within, CAG_ERR_value, "expects a range of z that is not empty");
    if (!cag_geometry_ok(call, heights(low, high, parts + 1, call->err))) return false;
    n = 3;
  }
  CagStatus status = cag_solid_quadric(q, &parts[0], call->err);
  if (!status) status = combine(call, CAG_INTERSECTION, parts, n, &made, call->err);
  if (!status) record_location(call, made);
  return cag_solid_result(call, status, &made, result);
}

// --- clip ---

typedef struct Clip {
  CagCall *call;
  CagSolid *by;
  CagOrigin origin; // of `by`
} Clip;

static bool clip_solid(const Clip *c, CagValue v, CagBuilder *into) {
  CagSolid *parts[2] = {NULL, c->by}, *made = NULL;
  CagBounds reach;
  if (!read_one(c->call, v, 0, &parts[0])) return false;
  CagStatus status = combine(c->call, CAG_INTERSECTION, parts, 2, &made, c->call->err);
  cag_hold_solid(c->call, parts[0]);
  if (!cag_geometry_ok(c->call, status)) return false;
  CagValue value = cag_solid_value(c->call->vm, made);
  cag_shape_say_alike(value, v);
  const CagOrigin origins[2] = {CAG_AS_SHAPE(v)->origin, c->origin};
  CAG_AS_SHAPE(value)->origin.operands =
      operands_of(c->call->vm, CAG_INTERSECTION, parts, origins, 2);
  // A part that is obviously outside is dropped. If only its mesh could show that, it is kept.
  bool outside = !cag_solid_reach(made, &reach, c->call->err) && !(reach.min.x <= reach.max.x);
  return outside || cag_builder_add(c->call->vm, into, value);
}

static CagTessellation fineness(const Clip *c, const CagShape *shape) {
  CagTessellation how = cag_run_tessellation(c->call->vm);
  how.tolerance = shape->tolerance;
  return how;
}

// Takes ownership of the mesh.
static bool add_clipped(const Clip *c, CagStatus status, CagMesh *m, CagValue v, CagBuilder *into) {
  CagValue value;
  if (!cag_mesh_result(c->call, status, &m, &value)) return false;
  cag_shape_say_alike(value, v);
  return m->triangle_count == 0 || cag_builder_add(c->call->vm, into, value);
}

static bool clip_surface(const Clip *c, CagValue v, CagBuilder *into) {
  const CagShape *shape = CAG_AS_SHAPE(v);
  const CagTessellation how = fineness(c, shape);
  CagSurface *s = NULL;
  CagMesh *m = NULL;
  CagStatus status = CAG_OK;
  if (v.type == CAG_SURFACE) s = cag_surface_retain(shape->as.surface);
  else status = cag_surface_planar(shape->as.region, shape->placement, &s, c->call->err);
  if (!status) status = cag_surface_clip(s, c->by, &how, &m, c->call->err);
  cag_surface_release(s);
  return add_clipped(c, status, m, v, into);
}

static bool clip_curve(const Clip *c, CagValue v, CagBuilder *into) {
  CagCurveList *pieces = cag_hold_curve_list(c->call);
  CagStatus status = cag_curve_clip(CAG_AS_SHAPE(v)->as.curve, c->by, cag_vm_stop(c->call->vm),
                                    &pieces->items, &pieces->count, c->call->err);
  if (!cag_geometry_ok(c->call, status)) return false;
  for (size_t i = 0; i < pieces->count; i++) {
    CagValue piece = cag_curve_value(c->call->vm, cag_curve_retain(pieces->items[i]));
    cag_shape_say_alike(piece, v);
    if (!cag_builder_add(c->call->vm, into, piece)) return false;
  }
  cag_release_held(c->call, pieces);
  return true;
}

static bool clip_shape(const Clip *c, CagValue v, CagBuilder *into) {
  switch (v.type) {
  case CAG_SOLID: return clip_solid(c, v, into);
  case CAG_CURVE: return clip_curve(c, v, into);
  case CAG_SURFACE:
  case CAG_REGION: return clip_surface(c, v, into);
  case CAG_LABEL: return true; // left out
  default: break;
  }
  // A closed mesh is clipped as a body, and any other as a surface of triangles.
  const CagMesh *mesh = CAG_AS_SHAPE(v)->as.mesh;
  if (cag_mesh_is_watertight(mesh, NULL)) return clip_solid(c, v, into);
  const CagTessellation how = fineness(c, CAG_AS_SHAPE(v));
  CagMesh *m = NULL;
  const CagStatus status = cag_mesh_clip(mesh, c->by, &how, &m, c->call->err);
  return add_clipped(c, status, m, v, into);
}

// Returns the empty result of clipping: a solid if the shape has an interior, and a mesh otherwise.
static bool clipped_away(CagCall *call, CagValue *result) {
  const CagValue v = call->values[0];
  CagSolid *s = NULL;
  CagMesh *m = NULL;
  const bool body = v.type == CAG_SOLID ||
                    (v.type == CAG_MESH && cag_mesh_is_watertight(CAG_AS_SHAPE(v)->as.mesh, NULL));
  return body ? cag_changed_solid_result(call, cag_solid_empty(&s, call->err), &s, result)
              : cag_changed_mesh_result(
                    call, cag_mesh_new(0, 0, false, false, false, &m, call->err), &m, result);
}

bool cag_solids_is_empty(CagCall *call, CagValue *result) {
  CagList *shapes;
  const CagValue v = call->values[0];
  *result = cag_bool(false);
  // The list that `intersection` returns for curves and surfaces has records.
  if (v.type == CAG_LIST && CAG_AS_LIST(v)->length > 0 &&
      !cag_is_shape(cag_list_get(call->vm, CAG_AS_LIST(v), 0)))
    return true;
  if (!cag_list_shapes(call, v, &shapes)) return false;
  bool empty = true;
  for (size_t i = 0; empty && i < shapes->length; i++)
    if (!cag_keep_going(call->vm) ||
        !cag_value_is_empty(call, cag_list_get(call->vm, shapes, i), &empty))
      return false;
  *result = cag_bool(empty);
  return true;
}

bool cag_solids_clip(CagCall *call, CagValue *result) {
  Clip c = {.call = call};
  CagValue said;
  if (call->values[1].type == CAG_PLANE) {
    const CagPlane *plane = &CAG_AS_PLANE(call->values[1])->plane;
    if (!cag_geometry_ok(call, cag_solid_half_space(plane, &c.by, call->err))) return false;
  } else if (!read_operand(call, call->values[1], 1, NULL, &c.by, &c.origin, &said)) {
    return false;
  }
  cag_hold_solid(call, c.by);
  CagList *shapes;
  if (!cag_list_shapes(call, call->values[0], &shapes)) return false;
  CagBuilder *kept = cag_builder_new(call->vm);
  for (size_t i = 0; i < shapes->length; i++)
    if (!cag_keep_going(call->vm) || !clip_shape(&c, cag_list_get(call->vm, shapes, i), kept))
      return false;
  CagValue parts = cag_builder_finish(call->vm, kept);
  const size_t n = CAG_AS_LIST(parts)->length;
  const CagType first = call->values[0].type;
  const bool one = first != CAG_GROUP && first != CAG_LIST;
  if (n == 0 && one && first != CAG_CURVE) return clipped_away(call, result);
  const bool single = n == 1 && one;
  *result =
      single ? cag_list_get(call->vm, CAG_AS_LIST(parts), 0) : cag_group_value(call->vm, parts);
  return true;
}
