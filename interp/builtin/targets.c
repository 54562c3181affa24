#include "interp/builtin/targets.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "geom/ray/bvh_walk.h"
#include "geom/ray/nearest.h"
#include "geom/solid/csg.h"
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
  CagStatus status = cag_surface_planar(s->as.region, s->placement, &flat, err);
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

// --- Meshes of shapes ---

CagTessellation cag_shape_tessellation(const CagVm *vm, double tolerance) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  how.tolerance = tolerance;
  if (vm->max_triangles > 0) how.max_triangles = vm->max_triangles;
  how.interrupt = cag_vm_stop(vm);
  return how;
}

CagStatus cag_shape_mesh(const CagVm *vm, CagValue v, double tolerance, CagMesh **out,
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
  if (tolerance <= 0) tolerance = CAG_SHAPE_TOLERANCE * cag_norm(cag_sub(box.max, box.min));
  const CagTessellation how = cag_shape_tessellation(vm, tolerance);
  return v.type == CAG_SOLID ? cag_solid_tessellate(shape->as.solid, &how, out, err)
                             : cag_surface_tessellate(shape->as.surface, &how, out, err);
}

static void release_mesh_caster(void *c) { cag_caster_free(c); }

// The caster of a solid's mesh, kept in the same way as that of the solid; NULL: it is empty.
static bool solid_mesh_caster(CagCall *call, CagValue solid, const CagCaster **out) {
  CagCaster *made = cag_memo_find(call, solid.as.object, release_mesh_caster);
  if (!made) {
    const size_t before = call->vm->account.used;
    CagMesh *m = NULL;
    CagStatus status =
        cag_shape_mesh(call->vm, solid, CAG_AS_SHAPE(solid)->tolerance, &m, call->err);
    if (status && cag_is_empty_shape(call->err)) {
      *out = NULL;
      return true;
    }
    if (!status) status = cag_caster_of_mesh(m, &made, call->err);
    cag_mesh_release(m);
    if (!cag_geometry_ok(call, status)) return false;
    cag_memo_keep(call, solid.as.object, cag_unset(), made, release_mesh_caster, before);
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
  cag_free(t->others);
  cag_free(t);
}

// Tells targets for distances from those of rays among the memos of a value.
static void near_target_free(void *what) { target_free(what); }

static bool has_surface(CagValue v) {
  const CagShape *s = CAG_AS_SHAPE(v);
  if (v.type == CAG_CURVE || v.type == CAG_LABEL) return false;
  return v.type != CAG_REGION || !cag_region_is_empty(s->as.region);
}

static bool is_bounded(const CagBounds *b) {
  return isfinite(b->max.x - b->min.x + b->max.y - b->min.y + b->max.z - b->min.z);
}

// Adds a part; the bounded ones are first.
static CagStatus add_part(CagTarget *t, CagValue v, CagError *err) {
  CagTargetPart *part = &t->parts[t->count];
  part->value = v;
  part->shape = CAG_AS_SHAPE(v);
  part->number = t->count;
  CagStatus status = make_caster(v, &part->caster, err);
  if (status) return status;
  const CagBounds b = cag_caster_bounds(part->caster);
  t->count++;
  if (!is_bounded(&b)) return CAG_OK;
  const CagTargetPart moved = t->parts[t->bounded];
  t->parts[t->bounded++] = *part;
  if (t->bounded < t->count) *part = moved;
  return CAG_OK;
}

static CagStatus fill_target(CagVm *vm, CagTarget *t, const CagList *shapes, bool for_rays,
                             CagError *err) {
  CagStatus status = CAG_OK;
  t->parts = cag_calloc(shapes->length + 1, sizeof *t->parts);
  t->others = cag_calloc(shapes->length + 1, sizeof *t->others);
  if (!t->parts || !t->others) return cag_fail_memory(err);
  for (size_t i = 0; !status && i < shapes->length; i++) {
    const CagValue v = cag_list_get(vm, shapes, i);
    if (for_rays && CAG_AS_SHAPE(v)->hidden) continue;
    if (has_surface(v)) status = add_part(t, v, err);
    else if (!for_rays && (v.type == CAG_CURVE || v.type == CAG_LABEL))
      t->others[t->other_count++] = v;
  }
  return status;
}

static CagStatus find_boxes(CagTarget *t, CagError *err) {
  CagBounds *boxes = cag_malloc((t->bounded + 1) * sizeof *boxes);
  if (!boxes) return cag_fail_memory(err);
  for (size_t i = 0; i < t->bounded; i++) boxes[i] = cag_caster_bounds(t->parts[i].caster);
  CagStatus status = cag_bvh_build(boxes, t->bounded, 1, &t->boxes, err);
  cag_free(boxes);
  t->bounds = t->boxes.bounds;
  t->size = t->bounded ? cag_norm(cag_sub(t->bounds.max, t->bounds.min)) : 0;
  return status;
}

static bool make_target(CagCall *call, CagValue list, bool for_rays, CagTarget **out) {
  CagTarget *t = cag_hold_array(call, 1, sizeof *t);
  cag_give_held(call, t);
  cag_hold_for(call, target_free, t);
  CagStatus status = fill_target(call->vm, t, CAG_AS_LIST(list), for_rays, call->err);
  if (!status) status = find_boxes(t, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  *out = cag_give_held(call, t);
  return true;
}

// A ground is a slab below its level for finite sizes, as in pictures, and else a half space.
#define SLAB 1e-3

static CagStatus make_ground(double z, double size, CagSolid **out, CagError *err) {
  const CagPlane level = {{0, 0, z}, {0, 0, 1}};
  if (isinf(size)) return cag_solid_half_space(&level, out, err);
  CagSolid *box = NULL;
  const CagTransform shift = cag_translate(cag_vec3(-size / 2, -size / 2, z - SLAB * size));
  CagStatus status = cag_solid_box(cag_vec3(size, size, SLAB * size), false, &box, err);
  if (!status) status = cag_solid_transform(box, &shift, out, err);
  cag_solid_release(box);
  return status;
}

static bool ground_solid(CagCall *call, CagValue v, CagValue *out) {
  const CagRecord *fields = CAG_AS_SCENE(v)->fields;
  const CagValue material = cag_record_get(fields, "material"),
                 name = cag_record_get(fields, "name");
  CagSolid *s = NULL;
  const CagStatus status = make_ground(cag_record_get(fields, "z").as.number,
                                       cag_record_get(fields, "size").as.number, &s, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  *out = cag_solid_value(call->vm, s);
  CagShape *shape = CAG_AS_SHAPE(*out);
  if (material.type == CAG_RECORD) shape->material = CAG_AS_RECORD(material);
  shape->name = name.type == CAG_TEXT ? CAG_AS_TEXT(name) : cag_intern(call->vm, "ground", 6);
  return true;
}

// Collects shapes from whatever a script can show. Rays also meet grounds.
static bool collect_shown(CagCall *call, CagValue v, bool for_rays, CagBuilder *into) {
  if (for_rays && v.type == CAG_SETTING && !strcmp(CAG_AS_SCENE(v)->kind, "ground"))
    return ground_solid(call, v, &v) && cag_builder_add(call->vm, into, v);
  if (v.type == CAG_CAMERA || v.type == CAG_LIGHT || v.type == CAG_SETTING) return true;
  if (v.type != CAG_LIST) return cag_shapes_collect(call, v, into);
  if (!cag_may_go_deeper(call->vm, "collected")) return false;
  const CagList *list = CAG_AS_LIST(v);
  for (size_t i = 0; i < list->length; i++)
    if (!collect_shown(call, cag_list_get(call->vm, list, i), for_rays, into)) return false;
  return true;
}

static bool find_target(CagCall *call, int argument, bool for_rays, const CagTarget **out) {
  void (*const release)(void *) = for_rays ? target_free : near_target_free;
  const CagValue v = call->values[argument];
  if (!cag_is_shape(v) && v.type != CAG_LIST && v.type != CAG_ROBOT)
    return cag_fail_type(call, argument, "a shape, a robot, or a list of them");
  CagTarget *t = cag_memo_find(call, v.as.object, release);
  if (!t) {
    const size_t before = call->vm->account.used;
    CagBuilder *shapes = cag_builder_new(call->vm);
    if (!collect_shown(call, v, for_rays, shapes)) return false;
    const CagValue list = cag_builder_finish(call->vm, shapes);
    if (!make_target(call, list, for_rays, &t)) return false;
    cag_memo_keep(call, v.as.object, list, t, release, before);
  }
  *out = t;
  return true;
}

bool cag_arg_ray_target(CagCall *call, int argument, const CagTarget **out) {
  return find_target(call, argument, true, out);
}

bool cag_arg_near_target(CagCall *call, int argument, const CagTarget **out) {
  return find_target(call, argument, false, out);
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

// --- Nearest points ---

// A point is on a boundary if it is closer than this fraction of the size.
#define BOUNDARY 1e-9

// The side of a closed part that p is on (see cag_caster_side); 1 for others.
static bool side_of_part(CagCall *call, const CagCaster *c, CagVec3 p, double slack,
                         CagCrossings *work, int *side) {
  *side = 1;
  return !cag_caster_is_closed(c) ||
         cag_geometry_ok(call, cag_caster_side(c, p, slack, work, side, call->err));
}

// The distance from a mesh within which the exact boundary is searched, in tolerances of the mesh.
#define POLISH_REACH 20.0

// The nearest point by the mesh of a set operation, and from there on the exact boundary.
static bool mesh_closest(CagCall *call, const CagTargetPart *part, CagVec3 p, double most,
                         CagCrossings *work, CagNearest *out) {
  const CagCaster *mesh;
  CagNearest exact;
  out->found = false;
  if (!solid_mesh_caster(call, part->value, &mesh)) return false;
  if (!mesh) return true;
  const CagBounds b = cag_caster_bounds(mesh);
  const double set = part->shape->tolerance;
  const double tolerance = set > 0 ? set : CAG_SHAPE_TOLERANCE * cag_norm(cag_sub(b.max, b.min));
  CagStatus status = cag_caster_closest(mesh, p, most + tolerance, work, out, call->err);
  if (!status && out->found)
    status = cag_caster_polish(part->caster, p, out->point, POLISH_REACH * tolerance, work, &exact,
                               call->err);
  if (!status && out->found && exact.found) *out = exact;
  out->found = out->found && out->distance <= most;
  return cag_geometry_ok(call, status);
}

static bool offer_part(CagCall *call, const CagTarget *t, size_t i, CagVec3 p, CagCrossings *work,
                       CagTargetNearest *best) {
  const CagCaster *c = t->parts[i].caster;
  const CagBounds b = cag_caster_bounds(c);
  const double size = cag_norm(cag_sub(b.max, b.min));
  const double slack = BOUNDARY * (isfinite(size) ? size : cag_norm(p));
  CagNearest found;
  int side;
  if (cag_bounds_distance(&b, p) > best->distance) return true;
  if (!side_of_part(call, c, p, slack, work, &side)) return false;
  if (side < 0) {
    *best = (CagTargetNearest){true, i, p, 0};
    return true;
  }
  CagStatus status = cag_caster_closest(c, p, best->distance, work, &found, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  if (found.found && !found.certain &&
      !mesh_closest(call, &t->parts[i], p, best->distance, work, &found))
    return false;
  if (side == 0 && found.found && found.distance <= slack) found.distance = 0;
  // Of two parts at one distance, the first counts.
  if (found.found && (found.distance < best->distance || !best->found || i < best->part))
    *best = (CagTargetNearest){true, i, found.point, found.distance};
  return true;
}

static bool offer_other(CagCall *call, const CagTarget *t, size_t i, CagVec3 p,
                        CagTargetNearest *best) {
  const CagValue v = t->others[i];
  const CagShape *s = CAG_AS_SHAPE(v);
  CagVec3 point = {0, 0, 0};
  double at, distance;
  if (v.type == CAG_LABEL) {
    point = s->as.label->at;
    distance = cag_norm(cag_sub(point, p));
  } else if (!cag_geometry_ok(call,
                              cag_curve_closest(s->as.curve, p, &at, &point, &distance, call->err)))
    return false;
  if (distance < best->distance || (!best->found && distance == best->distance))
    *best = (CagTargetNearest){true, t->count + i, point, distance};
  return true;
}

static bool offer_boxes(CagCall *call, const CagTarget *t, CagVec3 p, CagCrossings *work,
                        CagTargetNearest *best) {
  const CagVec3 local = cag_sub(p, t->boxes.origin);
  const double slack = CAG_BVH_SLACK * (cag_norm(local) + t->boxes.radius);
  const float at[3] = {(float)local.x, (float)local.y, (float)local.z};
  CagBvhWalk walk;
  size_t first, count;
  if (t->bounded == 1) return offer_part(call, t, 0, p, work, best);
  cag_bvh_start(&t->boxes, &walk);
  for (;;) {
    const double reach = best->distance + slack;
    if (!cag_bvh_near(&t->boxes, at, reach * reach, &walk, &first, &count)) return true;
    for (size_t k = first; k < first + count; k++)
      if (!offer_part(call, t, t->boxes.order[k], p, work, best)) return false;
  }
}

static void release_crossings(void *list) { cag_crossings_free(list); }

bool cag_target_closest(CagCall *call, const CagTarget *t, CagVec3 p, double most,
                        CagTargetNearest *out) {
  CagCrossings *work = cag_hold_array(call, 1, sizeof *work);
  cag_hold_for(call, release_crossings, work);
  *out = (CagTargetNearest){.distance = most};
  if (!offer_boxes(call, t, p, work, out)) return false;
  for (size_t i = t->bounded; i < t->count; i++)
    if (!offer_part(call, t, i, p, work, out)) return false;
  for (size_t i = 0; i < t->other_count; i++) {
    if (i % CAG_LOOK_UP == 0 && !cag_keep_going(call->vm)) return false;
    if (!offer_other(call, t, i, p, out)) return false;
  }
  return true;
}

// --- What was met ---

CagValue cag_target_name(const CagTarget *t, size_t part) {
  const CagShape *s =
      part < t->count ? t->parts[part].shape : CAG_AS_SHAPE(t->others[part - t->count]);
  CagText *name = s->name ? s->name : s->origin.definition;
  return name ? cag_object(CAG_TEXT, name) : cag_none();
}

CagValue cag_target_material(const CagVm *vm, const CagTarget *t, const CagTargetHit *hit) {
  const CagShape *s = t->parts[hit->part].shape;
  CagRecord *own = cag_solids_material(vm, hit->at.label);
  CagRecord *material = own ? own : s->material;
  return material ? cag_object(CAG_RECORD, material) : cag_none();
}
