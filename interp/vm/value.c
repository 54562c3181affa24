// Constructors of values: texts, ranges, records, transforms, and shapes. Lists are in list.c.

#include "interp/vm/value.h"

#include <math.h>
#include <string.h>

#include "base/assert.h"
#include "base/memory.h"
#include "base/utf8.h"
#include "interp/vm/value_type.h"
#include "interp/vm/vm.h"

static const char *const type_names[] = {
#define X(tag, name, article) name,
    CAG_VALUE_TYPES(X)
#undef X
};
static const char *const type_articles[] = {
#define X(tag, name, article) article,
    CAG_VALUE_TYPES(X)
#undef X
};

const char *cag_type_name(CagValue v) {
  return v.type < CAG_TYPE_COUNT ? type_names[v.type] : "none";
}
const char *cag_type_article(CagValue v) {
  return v.type < CAG_TYPE_COUNT ? type_articles[v.type] : "nothing";
}

// --- Text ---

// Bytes of a text that are copied between two checks of the stop flag.
#define BLOCK ((size_t)1 << 20)

// Appends bytes to a text and increases its length accordingly. If the run must stop, the text
// stays incomplete, and its end is filled with zeros.
static void append_bytes(CagVm *vm, CagText *t, const char *bytes, size_t length) {
  char *to = t->bytes + t->length;
  t->length += length;
  for (size_t from = 0; from < length && !vm->stop; from += BLOCK) {
    const size_t size = length - from < BLOCK ? length - from : BLOCK;
    t->characters += cag_utf8_count(bytes + from, size);
    memcpy(to + from, bytes + from, size);
  }
}

CagValue cag_text_new(CagVm *vm, const char *bytes, size_t length) {
  CagText *t = cag_alloc(vm, CAG_TEXT, sizeof *t + length + 1);
  append_bytes(vm, t, bytes, length);
  return cag_object(CAG_TEXT, t);
}

CagValue cag_text_joined(CagVm *vm, const CagText *a, const CagText *b) {
  CagText *t = cag_alloc(vm, CAG_TEXT, sizeof *t + a->length + b->length + 1);
  append_bytes(vm, t, a->bytes, a->length);
  append_bytes(vm, t, b->bytes, b->length);
  return cag_object(CAG_TEXT, t);
}

CagValue cag_text_c(CagVm *vm, const char *s) { return cag_text_new(vm, s, strlen(s)); }

// FNV-1a (Fowler, Noll, Vo).
static uint32_t hash_bytes(const char *bytes, size_t length) {
  uint32_t h = 2166136261u;
  for (size_t i = 0; i < length; i++) h = (h ^ (unsigned char)bytes[i]) * 16777619u;
  return h;
}

static void grow_interned(CagVm *vm) {
  size_t size = vm->interned_size ? vm->interned_size * 2 : 1024;
  CagText **table = cag_calloc(size, sizeof *table);
  if (!table) cag_vm_out_of_memory(vm);
  for (size_t i = 0; i < vm->interned_size; i++) {
    CagText *t = vm->interned[i];
    if (!t) continue;
    size_t k = t->head.hash & (size - 1);
    while (table[k]) k = (k + 1) & (size - 1);
    table[k] = t;
  }
  cag_free(vm->interned);
  vm->interned = table;
  vm->interned_size = size;
}

CagText *cag_intern(CagVm *vm, const char *bytes, size_t length) {
  if (vm->interned_count * 2 >= vm->interned_size) grow_interned(vm);
  uint32_t h = hash_bytes(bytes, length);
  size_t k = h & (vm->interned_size - 1);
  for (; vm->interned[k]; k = (k + 1) & (vm->interned_size - 1)) {
    CagText *t = vm->interned[k];
    if (t->head.hash == h && t->length == length && memcmp(t->bytes, bytes, length) == 0) return t;
  }
  CagText *t = CAG_AS_TEXT(cag_text_new(vm, bytes, length));
  t->head.hash = h;
  t->interned = true;
  vm->interned[k] = t;
  vm->interned_count++;
  return t;
}

// --- Range ---

CagValue cag_range_new(CagVm *vm, double start, double end, double step, bool angle, bool open,
                       bool stepped) {
  CagRange *r = cag_alloc(vm, CAG_RANGE, sizeof *r);
  r->start = start;
  r->end = end;
  r->step = step;
  r->angle = angle;
  r->open = open;
  r->stepped = stepped;
  return cag_object(CAG_RANGE, r);
}

// If the last step is this close to the end, as a fraction of a step, it is moved to the end
// (language, section 2).
#define STEP_SLACK 1e-9
// More than any list can have.
#define RANGE_MAX 1e15

// Returns the number of steps from start to end. Sets *meets if the last one meets the end.
static double range_steps(const CagRange *r, bool *meets) {
  double q = (r->end - r->start) / r->step;
  double whole = floor(q + STEP_SLACK);
  *meets = fabs(q - whole) <= STEP_SLACK;
  return whole;
}

bool cag_range_count(CagVm *vm, const CagRange *r, size_t *count) {
  if (!isfinite(r->start) || !isfinite(r->end)) {
    return cag_vm_fail(vm, CAG_ERR_endless, "a range to inf is an interval, not a list");
  }
  bool meets;
  double steps = range_steps(r, &meets);
  if (steps < 0) {
    *count = 0;
    return true;
  }
  if (steps > RANGE_MAX)
    return cag_vm_fail(vm, CAG_ERR_endless, "the range has more than 1e15 elements");
  *count = (size_t)steps + (r->open && meets ? 0 : 1);
  return true;
}

double cag_range_element(const CagRange *r, size_t k, size_t count) {
  (void)count;
  if (r->step == rint(r->step) && r->start == rint(r->start)) return r->start + (double)k * r->step;
  bool meets;
  double steps = range_steps(r, &meets);
  if (!meets || steps == 0) return r->start + (double)k * r->step;
  if ((double)k == steps) return r->end;
  return r->start + (r->end - r->start) * (double)k / steps;
}

// --- Record ---

#define INDEXED_FROM 9 // smaller layouts are searched linearly

static void index_layout(CagVm *vm, CagLayout *l) {
  size_t size = 16;
  while (size < l->count * 2) size *= 2;
  l->index = cag_calloc(size, sizeof *l->index);
  if (!l->index) cag_vm_out_of_memory(vm);
  l->index_size = size;
  for (size_t i = 0; i < l->count; i++) {
    size_t k = l->names[i]->head.hash & (size - 1);
    while (l->index[k]) k = (k + 1) & (size - 1);
    l->index[k] = (uint32_t)i + 1;
  }
}

CagLayout *cag_layout_new(CagVm *vm, CagText *const *names, size_t n) {
  CagLayout *l = cag_alloc(vm, CAG_INTERNAL, sizeof *l + n * sizeof(CagText *));
  l->head.flags = CAG_INTERNAL_LAYOUT;
  l->count = n;
  if (n) memcpy(l->names, names, n * sizeof *names);
  if (n >= INDEXED_FROM) index_layout(vm, l);
  return l;
}

size_t cag_layout_find(const CagLayout *l, const CagText *interned) {
  if (!l->index) {
    for (size_t i = 0; i < l->count; i++)
      if (l->names[i] == interned) return i;
    return (size_t)-1;
  }
  for (size_t k = interned->head.hash & (l->index_size - 1); l->index[k];
       k = (k + 1) & (l->index_size - 1))
    if (l->names[l->index[k] - 1] == interned) return l->index[k] - 1;
  return (size_t)-1;
}

CagValue cag_record_with_layout(CagVm *vm, CagLayout *l, const CagValue *values) {
  CagRecord *r = cag_alloc(vm, CAG_RECORD, sizeof *r + l->count * sizeof(CagValue));
  r->layout = l;
  if (l->count) memcpy(r->fields, values, l->count * sizeof *values);
  return cag_object(CAG_RECORD, r);
}

CagValue cag_record_from_texts(CagVm *vm, CagText *const *names, const CagValue *values, size_t n) {
  CagCleanup cleanup;
  CagText **interned = cag_temporary(&cleanup, n, sizeof *interned);
  for (size_t i = 0; i < n; i++)
    interned[i] = names[i]->interned ? names[i] : cag_intern(vm, names[i]->bytes, names[i]->length);
  CagLayout *l = cag_layout_new(vm, interned, n);
  cag_cleanup_run(&cleanup);
  return cag_record_with_layout(vm, l, values);
}

CagValue cag_record_new(CagVm *vm, const char *const *names, const CagValue *values, size_t n) {
  CagCleanup cleanup;
  CagText **texts = cag_temporary(&cleanup, n, sizeof *texts);
  for (size_t i = 0; i < n; i++) texts[i] = cag_intern(vm, names[i], strlen(names[i]));
  CagLayout *l = cag_layout_new(vm, texts, n);
  cag_cleanup_run(&cleanup);
  return cag_record_with_layout(vm, l, values);
}

CagValue cag_record_get(const CagRecord *r, const char *name) {
  for (size_t i = 0; i < r->layout->count; i++)
    if (strcmp(r->layout->names[i]->bytes, name) == 0) return r->fields[i];
  return cag_unset();
}

CagValue cag_record_get_text(CagVm *vm, const CagRecord *r, const CagText *name) {
  const CagText *t = name->interned ? name : cag_intern(vm, name->bytes, name->length);
  size_t i = cag_layout_find(r->layout, t);
  return i == (size_t)-1 ? cag_unset() : r->fields[i];
}

// --- Geometry ---

CagValue cag_transform_value(CagVm *vm, const CagTransform *t) {
  CagTransformValue *v = cag_alloc(vm, CAG_TRANSFORM, sizeof *v);
  v->t = *t;
  return cag_object(CAG_TRANSFORM, v);
}

CagValue cag_plane_value(CagVm *vm, const CagPlane *p) {
  CagPlaneValue *v = cag_alloc(vm, CAG_PLANE, sizeof *v);
  v->plane = *p;
  return cag_object(CAG_PLANE, v);
}

static CagShape *shape_new(CagVm *vm, CagType type) {
  const bool placed = type == CAG_REGION;
  CagShape *s = cag_alloc(vm, type, sizeof *s + (placed ? sizeof *s->placement : 0));
  if (placed) s->placement[0] = cag_transform_identity();
  s->fresh = true;
  return s;
}

// Makes a shape that takes over its geometry, which is released if memory runs out.
static CagShape *shape_of(CagVm *vm, CagType type, void (*release)(void *), void *owned) {
  CagCleanup cleanup;
  cag_cleanup_push(&cleanup, release, owned);
  CagShape *s = shape_new(vm, type);
  cag_cleanup_pop(&cleanup);
  return s;
}

static void release_curve(void *c) { cag_curve_release(c); }
static void release_region(void *r) { cag_region_release(r); }
static void release_surface(void *s) { cag_surface_release(s); }
static void release_solid(void *s) { cag_solid_release(s); }
static void release_mesh(void *m) { cag_mesh_release(m); }
static void release_robot(void *r) { cag_robot_release(r); }
static void release_raster(void *r) { cag_raster_release(r); }

CagValue cag_curve_value(CagVm *vm, CagCurve *c) {
  CAG_ASSERT(cag_check_curve(c));
  CagShape *s = shape_of(vm, CAG_CURVE, release_curve, c);
  s->as.curve = c;
  return cag_object(CAG_CURVE, s);
}

CagValue cag_region_value(CagVm *vm, CagRegion *r, const CagTransform *placement) {
  CagShape *s = shape_of(vm, CAG_REGION, release_region, r);
  s->as.region = r;
  if (placement) s->placement[0] = *placement;
  return cag_object(CAG_REGION, s);
}

CagValue cag_surface_value(CagVm *vm, CagSurface *surface) {
  CAG_ASSERT(cag_check_surface(surface));
  CagShape *s = shape_of(vm, CAG_SURFACE, release_surface, surface);
  s->as.surface = surface;
  return cag_object(CAG_SURFACE, s);
}

CagValue cag_solid_value(CagVm *vm, CagSolid *solid) {
  CAG_ASSERT(cag_check_solid(solid));
  CagShape *s = shape_of(vm, CAG_SOLID, release_solid, solid);
  s->as.solid = solid;
  return cag_object(CAG_SOLID, s);
}

CagValue cag_image_value(CagVm *vm, CagRaster *r) {
  CAG_ASSERT(cag_check_raster(r));
  CagCleanup cleanup;
  cag_cleanup_push(&cleanup, release_raster, r);
  CagImageValue *v = cag_alloc(vm, CAG_IMAGE, sizeof *v);
  cag_cleanup_pop(&cleanup);
  v->raster = r;
  return cag_object(CAG_IMAGE, v);
}

CagValue cag_mesh_value(CagVm *vm, CagMesh *m) {
  CAG_ASSERT(cag_check_mesh(m));
  CagShape *s = shape_of(vm, CAG_MESH, release_mesh, m);
  s->as.mesh = m;
  return cag_object(CAG_MESH, s);
}

CagValue cag_label_value(CagVm *vm, const CagLabelText *like) {
  CagLabelText *text = cag_alloc(vm, CAG_INTERNAL, sizeof *text);
  const CagObject head = text->head;
  *text = *like;
  text->head = head;
  text->head.flags = CAG_INTERNAL_LABEL;
  CagShape *s = shape_new(vm, CAG_LABEL);
  s->as.label = text;
  return cag_object(CAG_LABEL, s);
}

CagValue cag_group_value(CagVm *vm, CagValue list) {
  CagShape *s = shape_new(vm, CAG_GROUP);
  s->as.items = CAG_AS_LIST(list);
  return cag_object(CAG_GROUP, s);
}

CagValue cag_shape_copy(CagVm *vm, CagValue shape) {
  const CagShape *from = CAG_AS_SHAPE(shape);
  CagShape *s = shape_new(vm, shape.type);
  CagObject head = s->head;
  *s = *from;
  s->head = head;
  if (shape.type == CAG_REGION) s->placement[0] = from->placement[0];
  s->fresh = s->copied = true;
  const CagValueType *type = cag_value_type(shape);
  if (type->retain) type->retain(&s->head);
  return cag_object(shape.type, s);
}

// The levels of shapes that a step keeps: those before it, and one more for those of its inputs.
static size_t held_levels(const CagOriginStep *before, const CagInputs *inputs) {
  size_t most = before ? before->held : 0;
  for (size_t i = 0; inputs && i < inputs->count; i++) {
    const CagOriginStep *last = CAG_AS_SHAPE(inputs->items[i].shape)->origin.last;
    const size_t levels = 1 + (last ? last->held : 0);
    if (levels > most) most = levels;
  }
  return most;
}

// --- Motions ---

// How many numbers of a transform tell it.
static uint8_t motion_numbers(const CagTransform *t) {
  static const double last_row[] = {0, 0, 0, 1};
  if (t->in_front || memcmp(t->m[3], last_row, sizeof last_row) != 0) return 16;
  for (int i = 0; i < 12; i++)
    if (i % 4 != 3 && t->m[i / 4][i % 4] != (i % 5 == 0)) return 12;
  return 3;
}

CagTransform cag_motion_transform(const CagMotionNote *note) {
  CagTransform t = cag_transform_identity();
  if (note->numbers == 3) t = cag_translate(cag_vec3(note->m[0], note->m[1], note->m[2]));
  else memcpy(t.m, note->m, note->numbers * sizeof *note->m);
  t.planar = note->planar;
  t.in_front = note->in_front;
  return t;
}

// Whether the vector of the call follows the numbers of the motion.
static bool has_other_vector(const CagMotionNote *note) {
  return note->given > 0 && note->numbers != 3;
}

size_t cag_motion_vector(const CagMotionNote *note, double out[3]) {
  const double *v = has_other_vector(note) ? note->m + note->numbers : note->m;
  memcpy(out, v, note->given * sizeof *v);
  return note->given;
}

size_t cag_motion_bytes(const CagMotionNote *note) {
  return sizeof *note + (note->numbers + (has_other_vector(note) ? 3u : 0)) * sizeof *note->m;
}

CagMotionNote *cag_motion_note(CagVm *vm, const CagTransform *t, const double *vector,
                               size_t given) {
  uint8_t numbers = motion_numbers(t);
  const double moved[] = {t->m[0][3], t->m[1][3], t->m[2][3]};
  double v[3] = {0};
  if (given > 0) memcpy(v, vector, given * sizeof *v);
  if (numbers == 3 && given > 0 && memcmp(v, moved, sizeof v) != 0) numbers = 12;
  const bool extra = given > 0 && numbers != 3;
  CagMotionNote *note =
      cag_alloc(vm, CAG_INTERNAL, sizeof *note + (numbers + (extra ? 3u : 0)) * sizeof *note->m);
  note->head.flags = CAG_INTERNAL_MOTION;
  note->numbers = numbers;
  note->given = (uint8_t)given;
  note->planar = t->planar;
  note->in_front = t->in_front;
  memcpy(note->m, numbers == 3 ? moved : t->m[0], numbers * sizeof *moved);
  if (extra) memcpy(note->m + numbers, v, sizeof v);
  return note;
}

void cag_shape_note_motion(CagVm *vm, CagValue moved, CagValue from, const CagTransform *motion) {
  CagTransform t = *motion;
  const CagShape *before = CAG_AS_SHAPE(from);
  if (before->fresh && before->motion) {
    const CagTransform first = cag_motion_transform(before->motion);
    t = cag_transform_multiply(motion, &first);
  }
  CAG_AS_SHAPE(moved)->motion = cag_motion_note(vm, &t, NULL, 0);
}

// --- Steps ---

// A step takes over the motion of the one that is dropped before it.
static void take_motion(CagVm *vm, CagOriginStep *step, const CagMotionNote *dropped) {
  const CagMotionNote *own = cag_step_motion(step);
  CagTransform t = cag_motion_transform(dropped);
  double vector[3];
  size_t given = 0;
  if (own) {
    const CagTransform after = cag_motion_transform(own);
    t = cag_transform_multiply(&after, &t);
    given = cag_motion_vector(own, vector);
  }
  step->as.motion = cag_motion_note(vm, &t, vector, given);
  step->kind = CAG_STEP_MOVED;
}

void cag_origin_add(CagVm *vm, CagOrigin *o, const CagOriginStep *like, CagOriginCall *call) {
  const CagOriginStep *dropped = NULL;
  CagOriginStep *before = o->last;
  if (before && before->depth >= CAG_ORIGIN_DEPTH) { // drops the latest one
    dropped = before;
    before = before->before;
  }
  CagOriginStep *step = cag_alloc(vm, CAG_INTERNAL, sizeof *step + (call ? sizeof call : 0));
  step->head.flags = CAG_INTERNAL_STEP;
  step->site = like->site;
  step->kind = like->kind;
  step->as = like->as;
  step->called = call != NULL;
  if (call) step->call[0] = call;
  step->before = before;
  step->depth = before ? (uint8_t)(before->depth + 1) : 0;
  o->last = step;
  if (dropped && cag_step_motion(dropped)) take_motion(vm, step, cag_step_motion(dropped));
  const CagInputs *inputs = cag_step_inputs(step);
  size_t held = held_levels(before, inputs);
  if (inputs && held > CAG_INPUTS_DEPTH) {
    step->as.inputs = NULL;
    held = before ? before->held : 0;
  }
  step->held = (uint8_t)held;
}

CagOperands *cag_operands_new(CagVm *vm, CagOperands *first, size_t n) {
  CagOperands *o = cag_alloc(vm, CAG_INTERNAL, sizeof *o + n * sizeof *o->items);
  o->head.flags = CAG_INTERNAL_OPERANDS;
  o->count = (first ? first->count : 0) + n;
  o->first = first;
  memset(o->items, 0, n * sizeof *o->items);
  return o;
}

void cag_operands_list(const CagOperands *o, CagOrigin *out) {
  for (; o; o = o->first) {
    const size_t before = o->first ? o->first->count : 0;
    memcpy(out + before, o->items, (o->count - before) * sizeof *out);
  }
}

void cag_shape_moved(CagVm *vm, CagValue moved, CagValue from, const CagTransform *motion) {
  CagShape *to = CAG_AS_SHAPE(moved), *shape = CAG_AS_SHAPE(from);
  const CagStill *before = shape->still;
  CagStill *still = cag_alloc(vm, CAG_INTERNAL, sizeof *still);
  still->head.flags = CAG_INTERNAL_STILL;
  still->shape = before ? before->shape : shape;
  if (before) {
    const CagTransform first = cag_motion_transform(before->motion),
                       both = cag_transform_multiply(motion, &first);
    still->motion = cag_motion_note(vm, &both, NULL, 0);
  } else if (to->motion && !shape->fresh) still->motion = to->motion;
  else still->motion = cag_motion_note(vm, motion, NULL, 0);
  to->still = still;
}

CagPosture *cag_posture_new(CagVm *vm, CagRobotValue *robot, const double *q) {
  const size_t size = robot->robot->joint_count * sizeof *q;
  CagPosture *p = cag_alloc(vm, CAG_INTERNAL, sizeof *p + size);
  p->head.flags = CAG_INTERNAL_POSTURE;
  p->robot = robot;
  if (size) memcpy(p->q, q, size);
  return p;
}

CagLimb *cag_limb_new(CagVm *vm, const CagLimb *like) {
  CagLimb *limb = cag_alloc(vm, CAG_INTERNAL, sizeof *limb);
  const CagObject head = limb->head;
  *limb = *like;
  limb->head = head;
  limb->head.flags = CAG_INTERNAL_LIMB;
  return limb;
}

void cag_limb_moved(CagVm *vm, CagValue moved, CagValue from, const CagTransform *motion) {
  const CagLimb *before = CAG_AS_SHAPE(from)->limb;
  CagLimb *after = cag_limb_new(vm, before);
  after->motion = cag_transform_multiply(motion, &before->motion);
  CAG_AS_SHAPE(moved)->limb = after;
}

CagValue cag_scene_value(CagVm *vm, CagType type, const char *kind, CagValue record) {
  CagSceneValue *s = cag_alloc(vm, type, sizeof *s);
  s->kind = kind;
  s->fields = CAG_AS_RECORD(record);
  s->mirrored = false;
  s->placement = cag_transform_identity();
  return cag_object(type, s);
}

CagValue cag_link_value(CagVm *vm, const CagRobotLink *link, CagValue shape) {
  CagLinkValue *v = cag_alloc(vm, CAG_LINK, sizeof *v);
  v->link = *link;
  v->shape = shape;
  return cag_object(CAG_LINK, v);
}

CagValue cag_robot_value(CagVm *vm, CagRobot *r, CagText *name, CagValue links) {
  CagCleanup cleanup;
  cag_cleanup_push(&cleanup, release_robot, r);
  CagRobotValue *v = cag_alloc(vm, CAG_ROBOT, sizeof *v);
  cag_cleanup_pop(&cleanup);
  v->robot = r;
  v->name = name;
  v->links = CAG_AS_LIST(links);
  return cag_object(CAG_ROBOT, v);
}
