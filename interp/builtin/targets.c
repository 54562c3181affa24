#include "interp/builtin/targets.h"

#include "base/memory.h"
#include "geom/ray/bvh_walk.h"
#include "interp/builtin/shapes.h"
#include "interp/builtin/solids.h"
#include "interp/builtin/support.h"
#include "interp/vm/memo.h"
#include "interp/vm/vm.h"

// What is closer to the start of a ray than this fraction of the size of everything is skipped.
#define SKIPPED 1e-9

// --- Casters of single shapes ---

static void release_caster(void *c) { cag_caster_free(c); }

static CagStatus make_caster(CagValue v, CagCaster **out, CagError *err) {
  const CagShape *s = CAG_AS_SHAPE(v);
  if (v.type == CAG_SOLID) return cag_caster_of_solid(s->as.solid, out, err);
  if (v.type == CAG_MESH) return cag_caster_of_mesh(s->as.mesh, out, err);
  if (v.type == CAG_SURFACE) return cag_caster_of_surface(s->as.surface, out, err);
  CagSurface *flat = NULL;
  CagStatus status = cag_surface_planar(s->as.region, &s->placement, &flat, err);
  if (!status) status = cag_caster_of_surface(flat, out, err);
  cag_surface_release(flat);
  return status;
}

bool cag_shape_caster(CagCall *call, CagValue shape, const CagCaster **out) {
  CagCaster *made = cag_memo_find(call, shape.as.object, release_caster);
  if (!made) {
    const size_t before = call->vm->account.used;
    if (!cag_geometry_ok(call, make_caster(shape, &made, call->err))) return false;
    cag_memo_keep(call, shape.as.object, cag_unset(), made, release_caster, before);
  }
  *out = made;
  return true;
}

// --- Targets ---

static void target_free(void *what) {
  CagTarget *t = what;
  for (size_t i = 0; i < t->count; i++) cag_caster_free(t->parts[i].caster);
  cag_bvh_free(&t->boxes);
  cag_free(t->parts);
  cag_free(t);
}

static bool has_surface(CagValue v) {
  const CagShape *s = CAG_AS_SHAPE(v);
  if (s->hidden || v.type == CAG_CURVE || v.type == CAG_LABEL) return false;
  return v.type != CAG_REGION || !cag_region_is_empty(s->as.region);
}

static bool is_bounded(const CagBounds *b) {
  return isfinite(b->max.x - b->min.x + b->max.y - b->min.y + b->max.z - b->min.z);
}

// Makes the parts, the bounded ones first.
static CagStatus fill_target(CagVm *vm, CagTarget *t, const CagList *shapes, CagError *err) {
  CagStatus status = CAG_OK;
  t->parts = cag_calloc(shapes->length + 1, sizeof *t->parts);
  if (!t->parts) return cag_fail_memory(err);
  for (size_t i = 0; !status && i < shapes->length; i++) {
    const CagValue v = cag_list_get(vm, shapes, i);
    if (!has_surface(v)) continue;
    CagTargetPart *part = &t->parts[t->count];
    part->shape = CAG_AS_SHAPE(v);
    part->number = t->count;
    status = make_caster(v, &part->caster, err);
    if (status) break;
    const CagBounds b = cag_caster_bounds(part->caster);
    t->count++;
    if (!is_bounded(&b)) continue;
    const CagTargetPart moved = t->parts[t->bounded];
    t->parts[t->bounded++] = *part;
    if (t->bounded < t->count) *part = moved;
  }
  return status;
}

static CagStatus find_boxes(CagTarget *t, CagError *err) {
  CagBounds *boxes = cag_malloc((t->bounded + 1) * sizeof *boxes);
  if (!boxes) return cag_fail_memory(err);
  for (size_t i = 0; i < t->bounded; i++) boxes[i] = cag_caster_bounds(t->parts[i].caster);
  CagStatus status = cag_bvh_build(boxes, t->bounded, &t->boxes, err);
  cag_free(boxes);
  t->bounds = t->boxes.bounds;
  t->size = t->bounded ? cag_norm(cag_sub(t->bounds.max, t->bounds.min)) : 0;
  return status;
}

static bool make_target(CagCall *call, CagValue list, CagTarget **out) {
  CagTarget *t = cag_hold_array(call, 1, sizeof *t);
  cag_give_held(call, t);
  cag_hold_for(call, target_free, t);
  CagStatus status = fill_target(call->vm, t, CAG_AS_LIST(list), call->err);
  if (!status) status = find_boxes(t, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  *out = cag_give_held(call, t);
  return true;
}

// Collects shapes from whatever a script can show.
static bool collect_shown(CagCall *call, CagValue v, CagBuilder *into) {
  if (v.type == CAG_CAMERA || v.type == CAG_LIGHT || v.type == CAG_SETTING) return true;
  if (v.type != CAG_LIST) return cag_shapes_collect(call, v, into);
  if (!cag_may_go_deeper(call->vm, "collected")) return false;
  const CagList *list = CAG_AS_LIST(v);
  for (size_t i = 0; i < list->length; i++)
    if (!collect_shown(call, cag_list_get(call->vm, list, i), into)) return false;
  return true;
}

bool cag_arg_ray_target(CagCall *call, int argument, const CagTarget **out) {
  const CagValue v = call->values[argument];
  if (!cag_is_shape(v) && v.type != CAG_LIST && v.type != CAG_ROBOT)
    return cag_fail_type(call, argument, "a shape, a robot, or a list of them");
  CagTarget *t = cag_memo_find(call, v.as.object, target_free);
  if (!t) {
    const size_t before = call->vm->account.used;
    CagBuilder *shapes = cag_builder_new(call->vm);
    if (!collect_shown(call, v, shapes)) return false;
    const CagValue list = cag_builder_finish(call->vm, shapes);
    if (!make_target(call, list, &t)) return false;
    cag_memo_keep(call, v.as.object, list, t, target_free, before);
  }
  *out = t;
  return true;
}

// --- Rays ---

static CagStatus meet_part(const CagTarget *t, size_t i, CagRay *ray, CagCrossings *work,
                           CagTargetHit *out, bool *met, CagError *err) {
  bool here;
  CagCrossing at;
  CagStatus status = cag_caster_first(t->parts[i].caster, ray, work, &at, &here, err);
  // Of two parts at one distance, the first counts.
  if (status || !here || (*met && at.t == ray->most && i > out->part)) return status;
  *met = true;
  *out = (CagTargetHit){i, at};
  ray->most = at.t;
  return CAG_OK;
}

CagStatus cag_target_first(const CagTarget *t, const CagRay *ray, CagCrossings *work,
                           CagTargetHit *out, bool *met, CagError *err) {
  CagRay rest = *ray;
  CagBvhRay walked;
  CagStatus status = CAG_OK;
  *met = false;
  if (t->bounded == 1) status = meet_part(t, 0, &rest, work, out, met, err);
  else if (cag_bvh_ray(&t->boxes, ray->origin, ray->direction, ray->least, ray->most, &walked)) {
    CagBvhWalk walk;
    size_t first, count;
    cag_bvh_start(&t->boxes, &walk);
    while (!status && cag_bvh_next(&t->boxes, &walked, &walk, &first, &count))
      for (size_t k = first; !status && k < first + count; k++) {
        status = meet_part(t, t->boxes.order[k], &rest, work, out, met, err);
        if (*met) walked.most = nextafterf((float)(rest.most - walked.start), INFINITY);
      }
  }
  for (size_t i = t->bounded; !status && i < t->count; i++)
    status = meet_part(t, i, &rest, work, out, met, err);
  return status;
}

// The size that distances are compared to: that of the shapes, and of the point's distance from
// them.
static double target_scale(const CagTarget *t, CagVec3 p) {
  if (t->bounded == 0) return fmax(1, cag_norm(p));
  return t->size + cag_norm(cag_sub(p, cag_lerp(t->bounds.min, t->bounds.max, 0.5)));
}

double cag_target_skipped(const CagTarget *t, CagVec3 p) { return SKIPPED * target_scale(t, p); }

CagStatus cag_target_sees(const CagTarget *t, CagVec3 p, CagVec3 q, CagCrossings *work, bool *sees,
                          CagError *err) {
  const CagVec3 way = cag_sub(q, p);
  const double length = cag_norm(way), skipped = cag_target_skipped(t, p);
  const CagRay ray = {p, cag_unit(way), skipped, length - skipped};
  CagTargetHit hit;
  bool met = false;
  CagStatus status = CAG_OK;
  if (length > 2 * skipped) status = cag_target_first(t, &ray, work, &hit, &met, err);
  *sees = !met;
  return status;
}

CagValue cag_target_name(const CagTarget *t, size_t part) {
  const CagShape *s = t->parts[part].shape;
  CagText *name = s->name ? s->name : s->definition;
  return name ? cag_object(CAG_TEXT, name) : cag_none();
}

CagValue cag_target_material(const CagVm *vm, const CagTarget *t, const CagTargetHit *hit) {
  const CagShape *s = t->parts[hit->part].shape;
  CagRecord *own = cag_solids_material(vm, hit->at.label);
  CagRecord *material = own ? own : s->material;
  return material ? cag_object(CAG_RECORD, material) : cag_none();
}
