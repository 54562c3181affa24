// The list of parts.
//
// A part is a copy of another one if a rigid motion maps all of its bodies to those of the other.
// Most copies were made by moving one shape: they remember the same shape before they were moved, or
// their solids, and the operands of these, agree but for their placements. Others are compared by
// their meshes.

#include <math.h>
#include <string.h>

#include "base/array.h"
#include "geom/linalg/tolerance.h"
#include "geom/solid/csg.h"
#include "interp/builtin/assemblies.h"
#include "interp/builtin/scene.h"
#include "interp/builtin/solids.h"
#include "interp/formats/mesh_copies.h"
#include "interp/vm/vm.h"

// Volumes and areas of parts that are compared by their meshes agree to this fraction.
#define ALIKE 1e-6
#define CUBIC_METERS 1e-9 // in a cubic millimeter

typedef struct ListedPart {
  const CagPart *part;
  size_t count;
  CagDigest digest; // of what is alike in copies; may be unknown
  double volume;    // NAN: it has open bodies
  double area;      // of its mesh; 0: there is none yet
  CagMesh **meshes; // of the bodies; NULL: not made yet
} ListedPart;

typedef struct PartListing {
  CagCall *call;
  const CagParts *parts;
  ListedPart *items;
  size_t count;
} PartListing;

static void free_meshes(CagMesh **meshes, size_t n) {
  for (size_t i = 0; meshes && i < n; i++) cag_mesh_release(meshes[i]);
  cag_free(meshes);
}

static void release_listing(void *what) {
  PartListing *l = what;
  for (size_t i = 0; i < l->count; i++) free_meshes(l->items[i].meshes, l->items[i].part->count);
  cag_free(l->items);
  cag_free(l);
}

// --- Materials ---

static CagRecord *body_material(CagVm *vm, const CagPartBody *body) {
  if (body->material || !body->solid) return body->material;
  return cag_solids_material(vm, cag_solid_first_label(body->solid));
}

// Whether the parts are made of the same: materials with names agree in name and density, others in
// all fields.
static bool same_material(CagVm *vm, const CagRecord *a, const CagRecord *b) {
  if (a == b) return true;
  if (!a || !b) return false;
  const CagValue x = cag_record_get(a, "name"), y = cag_record_get(b, "name");
  if (x.type != CAG_TEXT && y.type != CAG_TEXT)
    return cag_equal(vm, cag_object(CAG_RECORD, (void *)a), cag_object(CAG_RECORD, (void *)b));
  return x.type == CAG_TEXT && y.type == CAG_TEXT && cag_equal(vm, x, y) &&
         cag_number_field(a, "density", 0) == cag_number_field(b, "density", 0);
}

// --- Copies ---

// A body before it was moved.
typedef struct BodyStill {
  CagValue shape;
  CagTransform motion;
} BodyStill;

static BodyStill still_of(CagValue v) {
  const CagStill *before = CAG_AS_SHAPE(v)->still;
  if (!before) return (BodyStill){v, cag_transform_identity()};
  return (BodyStill){cag_object(v.type, before->shape), cag_motion_transform(before->motion)};
}

static bool is_operation(const CagSolid *s) { return s->core && s->core->count > 0; }

// Adds a solid to a digest without its placement, if it has one.
static void unplaced_digest(const CagSolid *s, CagDigest *d) {
  if (!is_operation(s)) {
    if (cag_solid_has_own_frame(s)) cag_solid_digest_in_own_frame(s, d);
    else cag_solid_digest(s, d);
    return;
  }
  cag_digest_word(d, (uint64_t)s->kind);
  cag_digest_word(d, s->core->count);
  for (size_t i = 0; i < s->core->count; i++) unplaced_digest(s->core->operands[i], d);
}

static CagDigest part_digest(const PartListing *l, const CagPart *part) {
  CagDigest d = cag_digest_start();
  cag_digest_word(&d, part->count);
  for (size_t i = 0; i < part->count; i++) {
    const BodyStill still = still_of(l->parts->bodies[part->first + i].shape);
    const CagShape *s = CAG_AS_SHAPE(still.shape);
    cag_digest_word(&d, still.shape.type);
    if (still.shape.type == CAG_SURFACE) cag_surface_digest(s->as.surface, &d);
    else if (still.shape.type == CAG_MESH) cag_mesh_digest(s->as.mesh, &d);
    else unplaced_digest(s->as.solid, &d);
  }
  return d;
}

// Whether the motions agree, for a body of this size near a point.
static bool same_motion(const CagTransform *a, const CagTransform *b, CagVec3 near, double size) {
  const CagVec3 corners[4] = {near, cag_add(near, cag_vec3(size, 0, 0)),
                              cag_add(near, cag_vec3(0, size, 0)),
                              cag_add(near, cag_vec3(0, 0, size))};
  for (int i = 0; i < 4; i++) {
    const CagVec3 p = cag_transform_point(a, corners[i]), q = cag_transform_point(b, corners[i]);
    if (!(cag_norm(cag_sub(p, q)) <= CAG_COINCIDENT * (size + cag_norm(p)))) return false;
  }
  return true;
}

static double part_size(const PartListing *l, const CagPart *part, CagVec3 *middle) {
  CagBounds all = CAG_BOUNDS_EMPTY, one;
  CagError ignored;
  for (size_t i = part->first; i < part->first + part->count; i++) {
    const CagPartBody *b = &l->parts->bodies[i];
    const CagShape *s = CAG_AS_SHAPE(b->shape);
    if (b->shape.type == CAG_MESH) one = cag_mesh_bounds(s->as.mesh);
    else if (b->shape.type == CAG_SURFACE ? cag_surface_bounds(s->as.surface, &one, &ignored)
                                          : cag_solid_reach(s->as.solid, &one, &ignored))
      continue;
    cag_bounds_add(&all, one.min);
    cag_bounds_add(&all, one.max);
  }
  *middle = cag_lerp(all.min, all.max, 0.5);
  return cag_norm(cag_sub(all.max, all.min));
}

// Whether the parts were the same before they were moved. Formulas have no digests, but copies refer
// to one shape.
static bool same_stills(const PartListing *l, const ListedPart *a, const ListedPart *b) {
  if (!a->digest.unknown && !b->digest.unknown) return cag_digest_equal(&a->digest, &b->digest);
  for (size_t i = 0; i < a->part->count; i++) {
    const BodyStill x = still_of(l->parts->bodies[a->part->first + i].shape),
                    y = still_of(l->parts->bodies[b->part->first + i].shape);
    if (x.shape.as.object != y.shape.as.object) return false;
  }
  return true;
}

// The motion that maps a part to another one, as far as it is known.
typedef struct CopyMotion {
  const PartListing *l;
  const CagPart *part;
  CagTransform motion;
  bool known, measured;
  CagVec3 middle; // of the part, if it is measured
  double size;
} CopyMotion;

// Whether something that is placed by `from` in the part, and by `to` in the other, moves rigidly,
// like what was added before.
static bool add_motion(CopyMotion *m, const CagTransform *from, const CagTransform *to) {
  CagTransform back;
  CagError ignored;
  if (cag_transform_inverse(from, &back, &ignored)) return false;
  const CagTransform motion = cag_transform_multiply(to, &back);
  if (!cag_transform_is_rigid(&motion)) return false;
  if (!m->known) {
    m->motion = motion;
    return m->known = true;
  }
  if (!m->measured) m->size = part_size(m->l, m->part, &m->middle);
  m->measured = true;
  return same_motion(&m->motion, &motion, m->middle, m->size);
}

// The solids have equal digests without their placements.
static bool add_solid_motion(CopyMotion *m, const CagSolid *a, const CagTransform *around_a,
                             const CagSolid *b, const CagTransform *around_b) {
  if (!cag_solid_has_own_frame(a)) return add_motion(m, around_a, around_b);
  const CagTransform from = cag_transform_multiply(around_a, &a->placement),
                     to = cag_transform_multiply(around_b, &b->placement);
  if (!is_operation(a)) return add_motion(m, &from, &to);
  for (size_t i = 0; i < a->core->count; i++)
    if (!add_solid_motion(m, a->core->operands[i], &from, b->core->operands[i], &to)) return false;
  return true;
}

// Compares parts that were the same before they were moved.
static bool moves_alike(const PartListing *l, const CagPart *a, const CagPart *b) {
  CopyMotion m = {.l = l, .part = a};
  for (size_t i = 0; i < a->count; i++) {
    const BodyStill x = still_of(l->parts->bodies[a->first + i].shape),
                    y = still_of(l->parts->bodies[b->first + i].shape);
    const bool solid = x.shape.type == CAG_SOLID;
    if (solid ? !add_solid_motion(&m, CAG_AS_SHAPE(x.shape)->as.solid, &x.motion,
                                  CAG_AS_SHAPE(y.shape)->as.solid, &y.motion)
              : !add_motion(&m, &x.motion, &y.motion))
      return false;
  }
  return true;
}

// --- Copies by meshes ---

static CagStatus body_mesh(const PartListing *l, const CagPartBody *b, CagMesh **out,
                           CagError *err) {
  const CagShape *s = CAG_AS_SHAPE(b->shape);
  CagTessellation how = cag_run_tessellation(l->call->vm);
  how.tolerance = b->tolerance;
  if (b->shape.type == CAG_SURFACE) return cag_surface_tessellate(s->as.surface, &how, out, err);
  if (b->shape.type == CAG_SOLID) return cag_solid_tessellate(s->as.solid, &how, out, err);
  *out = cag_mesh_retain(s->as.mesh);
  return CAG_OK;
}

static bool mesh_part(PartListing *l, ListedPart *p) {
  const size_t n = p->part->count;
  if (p->meshes) return true;
  p->meshes = cag_calloc(n, sizeof *p->meshes);
  if (!p->meshes) cag_vm_out_of_memory(l->call->vm);
  for (size_t i = 0; i < n; i++) {
    const CagPartBody *body = &l->parts->bodies[p->part->first + i];
    if (!cag_geometry_ok(l->call, body_mesh(l, body, &p->meshes[i], l->call->err))) return false;
    p->area += cag_mesh_area(p->meshes[i]);
  }
  return true;
}

static bool nearly_equal(double a, double b) { return fabs(a - b) <= ALIKE * fabs(a); }

// Whether each mesh of b is one of a, moved by one motion for all.
static bool meshes_alike(PartListing *l, const ListedPart *a, const ListedPart *b, bool *alike) {
  CagVec3 middle;
  CagTransform whole = cag_transform_identity();
  const double size = part_size(l, a->part, &middle);
  *alike = true;
  for (size_t i = 0; *alike && i < a->part->count; i++) {
    const CagMeshPart pair[2] = {{.mesh = a->meshes[i]}, {.mesh = b->meshes[i]}};
    CagMeshCopy *copies;
    if (!cag_geometry_ok(l->call, cag_mesh_find_copies(pair, 2, false, &copies, l->call->err)))
      return false;
    const CagTransform place = copies[1].place;
    *alike = copies[1].original == 0 && (i == 0 || same_motion(&whole, &place, middle, size));
    cag_free(copies);
    whole = place;
  }
  return true;
}

// Compares parts whose digests differ.
static bool looks_alike(PartListing *l, ListedPart *a, ListedPart *b, bool *alike) {
  *alike = false;
  if (isnan(a->volume) != isnan(b->volume)) return true;
  if (!isnan(a->volume) && !nearly_equal(a->volume, b->volume)) return true;
  if (!mesh_part(l, a) || !mesh_part(l, b)) return false;
  return !nearly_equal(a->area, b->area) || meshes_alike(l, a, b, alike);
}

// --- The list ---

static bool same_text(const CagText *a, const CagText *b) {
  return a == b || (a && b && !strcmp(a->bytes, b->bytes));
}

static bool may_be_copy(const PartListing *l, const CagPart *a, const CagPart *b) {
  if (a->count != b->count || !same_text(a->given, b->given)) return false;
  for (size_t i = 0; i < a->count; i++) {
    const CagPartBody *x = &l->parts->bodies[a->first + i], *y = &l->parts->bodies[b->first + i];
    if (x->shape.type != y->shape.type || !x->solid != !y->solid ||
        !same_material(l->call->vm, body_material(l->call->vm, x), body_material(l->call->vm, y)))
      return false;
  }
  return true;
}

static bool measure_part(PartListing *l, ListedPart *p) {
  p->volume = 0;
  for (size_t i = 0; i < p->part->count; i++) {
    const CagPartBody *b = &l->parts->bodies[p->part->first + i];
    CagMassProperties mass;
    if (!b->solid) {
      p->volume = NAN;
      continue;
    }
    if (!cag_geometry_ok(l->call,
                         cag_solid_mass_within(b->solid, b->tolerance, &mass, l->call->err)))
      return false;
    p->volume += mass.volume;
  }
  return true;
}

// Counts the part as a copy of a listed one, or adds it to the list.
static bool list_part(PartListing *l, const CagPart *part) {
  ListedPart own = {.part = part, .count = 1, .digest = part_digest(l, part)};
  for (size_t i = 0; i < l->count; i++) {
    ListedPart *p = &l->items[i];
    if (!may_be_copy(l, p->part, part) || !same_stills(l, p, &own) ||
        !moves_alike(l, p->part, part))
      continue;
    p->count++;
    return true;
  }
  if (!measure_part(l, &own)) return false;
  ListedPart *last = &l->items[l->count++];
  *last = own;
  for (size_t i = 0; i + 1 < l->count; i++) {
    bool alike = false;
    if (!cag_keep_going(l->call->vm)) return false;
    if (!may_be_copy(l, l->items[i].part, part)) continue;
    if (!looks_alike(l, &l->items[i], last, &alike)) return false;
    if (!alike) continue;
    l->items[i].count++;
    free_meshes(last->meshes, part->count);
    l->count--;
    return true;
  }
  return true;
}

// The name that all bodies of the part have as their material; none if they differ, or have none.
static CagValue material_name(const PartListing *l, const CagPart *part) {
  CagValue name = cag_none();
  for (size_t i = 0; i < part->count; i++) {
    const CagRecord *m = body_material(l->call->vm, &l->parts->bodies[part->first + i]);
    const CagValue own = m ? cag_record_get(m, "name") : cag_unset();
    if (own.type != CAG_TEXT || (i > 0 && !cag_equal(l->call->vm, own, name))) return cag_none();
    name = own;
  }
  return name;
}

// In kg; none without a volume or a density.
static bool part_mass(const PartListing *l, const ListedPart *p, CagValue *out) {
  double sum = 0;
  *out = cag_none();
  for (size_t i = 0; i < p->part->count; i++) {
    const CagPartBody *b = &l->parts->bodies[p->part->first + i];
    const CagRecord *m = body_material(l->call->vm, b);
    const double density = m ? cag_number_field(m, "density", 0) : 0;
    CagMassProperties mass;
    if (!b->solid || !(density > 0)) return true;
    if (p->part->count == 1) mass.volume = p->volume;
    else if (!cag_geometry_ok(l->call,
                              cag_solid_mass_within(b->solid, b->tolerance, &mass, l->call->err)))
      return false;
    sum += density * CUBIC_METERS * mass.volume;
  }
  *out = cag_number(sum);
  return true;
}

static bool part_record(const PartListing *l, const ListedPart *p, CagValue *out) {
  static const char *const names[] = {"name", "count", "material", "volume", "mass"};
  CagValue mass;
  if (!part_mass(l, p, &mass)) return false;
  const CagValue volume = isnan(p->volume) ? cag_none() : cag_number(p->volume);
  const CagValue values[] = {cag_text_c(l->call->vm, p->part->name), cag_number((double)p->count),
                             material_name(l, p->part), volume, mass};
  *out = cag_record_new(l->call->vm, names, values, 5);
  return true;
}

bool cag_assemblies_parts_list(CagCall *call, const struct cag_assemblies_parts_list *a,
                               CagValue *result) {
  const CagParts *parts = cag_parts_of(call, a->G, true);
  if (!parts) return false;
  PartListing *l = cag_calloc(1, sizeof *l);
  if (!l) cag_vm_out_of_memory(call->vm);
  cag_hold_for(call, release_listing, l);
  l->call = call;
  l->parts = parts;
  l->items = cag_calloc(parts->count + 1, sizeof *l->items);
  if (!l->items) cag_vm_out_of_memory(call->vm);
  for (size_t i = 0; i < parts->count; i++)
    if (!cag_keep_going(call->vm) || !list_part(l, &parts->items[i])) return false;
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = 0; i < l->count; i++) {
    CagValue record;
    if (!part_record(l, &l->items[i], &record) || !cag_builder_add(call->vm, list, record))
      return false;
  }
  *result = cag_builder_finish(call->vm, list);
  return true;
}
