// Each shape has a chain of steps, one for each call that it went through. A step keeps the
// arguments of the call, so that a page can show the points in them, and the map between the shape
// before and after it. The steps of other operands are among the arguments: together they are the
// tree of calls that made the shape, without the shapes in between.

#include "interp/vm/origin.h"

#include <string.h>

#include "interp/vm/vm.h"

// Lists are followed this deep for shapes.
#define LIST_DEPTH 3
// The most shapes in an argument whose steps are kept.
#define MOST_SHAPES 400
// Of more arguments, which only functions of any number of shapes have, the first ones are kept.
#define MOST_ARGUMENTS 64

// The most shapes that a call is noted to have been made of.
enum { MOST_INPUTS = 64 };

// A call whose results get it as a step of their origins. What is kept of its arguments is made
// when the first shape is found.
typedef struct NotedCall {
  CagVm *vm;
  const CagCall *call;    // NULL: an operator
  CagOriginSite at;       // what its site is like
  CagOriginSite *site;    // NULL: not made yet
  const CagValue *values; // arguments
  size_t count;
  bool sought_call; // `kept` has been made
  CagOriginCall *kept;
  bool sought; // `inputs` has been made
  CagInputs *inputs;
} NotedCall;

// --- Arguments ---

static CagValue kept_argument(CagVm *vm, CagValue v, const CagOriginStep *before, int depth);

// Whether a list of lists has few numbers, which are directly in its elements.
static bool is_short_table(CagVm *vm, const CagList *list) {
  size_t numbers = 0;
  for (size_t i = 0; i < list->length; i++) {
    const CagValue row = cag_list_get(vm, list, i);
    if (row.type != CAG_LIST || CAG_AS_LIST(row)->dim == 0) return false;
    numbers += CAG_AS_LIST(row)->length * CAG_AS_LIST(row)->dim;
    if (numbers > CAG_ORIGIN_NUMBERS) return false;
  }
  return true;
}

static CagValue kept_list(CagVm *vm, CagValue v, const CagOriginStep *before, int depth) {
  CagList *list = CAG_AS_LIST(v);
  // A short part of a long list would keep all of it.
  const CagList *owner = list->owner ? list->owner : list;
  if (list->dim > 0) return owner->length * list->dim <= CAG_ORIGIN_NUMBERS ? v : cag_unset();
  if (list->length == 0 || list->length > MOST_SHAPES || owner->length > CAG_ORIGIN_NUMBERS)
    return cag_unset();
  if (is_short_table(vm, list)) return v;
  if (depth >= LIST_DEPTH) return cag_unset();
  CagValue kept[MOST_SHAPES];
  for (size_t i = 0; i < list->length; i++)
    kept[i] = kept_argument(vm, list->as.items[i], before, depth + 1);
  return cag_list_values(vm, kept, list->length);
}

// Numbers, or the steps of shapes. `before` is the step that the chain itself continues.
static CagValue kept_argument(CagVm *vm, CagValue v, const CagOriginStep *before, int depth) {
  if (v.type == CAG_LIST) return kept_list(vm, v, before, depth);
  if (v.type == CAG_GROUP)
    return kept_list(vm, cag_object(CAG_LIST, CAG_AS_SHAPE(v)->as.items), before, depth);
  if (!cag_is_shape(v)) return cag_unset();
  CagOriginStep *last = CAG_AS_SHAPE(v)->origin.last;
  return last && last != before ? cag_object(CAG_INTERNAL, last) : cag_unset();
}

// Lists that kept_list has made are of steps and of such lists.
static bool holds_steps(CagValue list) {
  const CagList *l = CAG_AS_LIST(list);
  bool found = false;
  for (size_t i = 0; l->dim == 0 && !found && i < l->length; i++) {
    const CagValue item = l->as.items[i];
    found = item.type == CAG_INTERNAL || (item.type == CAG_LIST && holds_steps(item));
  }
  return found;
}

// Whether an argument of a call may have points, or a vector that tells where shapes are. The vector
// of a translation is in its motion.
static bool has_points(const CagBuiltin *row, const char *words) {
  if (!strncmp(row->result, "as ", 3)) return false;
  // Of vectors, only the axis of a revolution tells where points are.
  return strstr(words, "point") ||
         (strstr(words, "vector") && !strcmp(cag_builtin_signature_of(row)->name, "revolve"));
}

// What is kept of argument k.
static CagValue kept_of(const CagCall *call, size_t k, const CagOriginStep *before) {
  const CagSignature *s = cag_builtin_signature_of(call->builtin);
  const CagValue kept = kept_argument(call->vm, call->values[k], before, 0);
  const bool numbers = kept.type == CAG_LIST && !holds_steps(kept);
  if (kept.type == CAG_INTERNAL || (kept.type == CAG_LIST && !numbers)) return kept;
  return numbers && k < s->count && has_points(call->builtin, s->words[k]) ? kept : cag_unset();
}

static CagOriginCall *kept_call(const CagCall *call, const CagOriginStep *before) {
  CagValue kept[MOST_ARGUMENTS];
  size_t count = 0;
  for (size_t k = 0; k < call->count && k < MOST_ARGUMENTS; k++) {
    kept[k] = kept_of(call, k, before);
    if (kept[k].type != CAG_UNSET) count = k + 1;
  }
  if (count == 0) return NULL;
  CagOriginCall *made = cag_alloc(call->vm, CAG_INTERNAL, sizeof *made + count * sizeof *kept);
  made->head.flags = CAG_INTERNAL_CALL;
  made->count = count;
  memcpy(made->values, kept, count * sizeof *kept);
  return made;
}

bool cag_is_translation(const CagBuiltin *row) {
  return row && !strcmp(row->result, "as G") &&
         !strcmp(cag_builtin_signature_of(row)->name, "translate");
}

// --- Inputs ---

// Calls `give` for the shapes among the arguments, and in lists among them.
static void each_shape(const NotedCall *c,
                       void (*give)(void *context, size_t parameter, CagValue shape),
                       void *context) {
  for (size_t i = 0; i < c->count; i++) {
    const CagValue v = c->values[i];
    if (cag_is_shape(v)) give(context, i, v);
    if (v.type != CAG_LIST || CAG_AS_LIST(v)->dim != 0) continue;
    const CagList *list = CAG_AS_LIST(v);
    for (size_t k = 0; k < list->length && cag_is_shape(list->as.items[k]); k++)
      give(context, i, list->as.items[k]);
  }
}

// Bodies and meshes are not kept: they are large, and set operations keep their operands anyway.
static bool is_kept_input(CagValue v) {
  return v.type == CAG_CURVE || v.type == CAG_REGION || v.type == CAG_SURFACE;
}

static void count_input(void *context, size_t parameter, CagValue shape) {
  (void)parameter;
  if (is_kept_input(shape)) ++*(size_t *)context;
}

static void add_input(void *context, size_t parameter, CagValue shape) {
  CagInputs *inputs = context;
  if (!is_kept_input(shape) || inputs->count == MOST_INPUTS) return;
  inputs->items[inputs->count].parameter = parameter;
  inputs->items[inputs->count++].shape = shape;
}

static CagInputs *inputs_of(NotedCall *c) {
  if (c->sought) return c->inputs;
  c->sought = true;
  size_t n = 0;
  each_shape(c, count_input, &n);
  if (n == 0) return NULL;
  if (n > MOST_INPUTS) n = MOST_INPUTS;
  c->inputs = cag_alloc(c->vm, CAG_INTERNAL, sizeof *c->inputs + n * sizeof *c->inputs->items);
  c->inputs->head.flags = CAG_INTERNAL_INPUTS;
  c->inputs->count = 0;
  each_shape(c, add_input, c->inputs);
  return c->inputs;
}

// --- What steps share ---

static size_t slot_of(uint64_t hash) {
  return (hash * 0x9e3779b97f4a7c15u >> 32) % CAG_RECENT_COUNT;
}

// Whether what is made now may be shared: not in a call from geometry, which older objects must not
// refer to (heap.c).
static bool may_share(const CagVm *vm) { return vm->heap.depth == 0; }

static CagOriginSite *site_of(NotedCall *c) {
  if (c->site) return c->site;
  const CagOriginSite *at = &c->at;
  CagOriginSite **slot =
      &c->vm->recent.sites[slot_of((uint64_t)at->span.start << 20 ^ at->caller_span.start)];
  const CagOriginSite *s = *slot;
  if (s && s->source == at->source && s->span.start == at->span.start &&
      s->span.end == at->span.end && s->caller == at->caller &&
      s->caller_span.start == at->caller_span.start && s->caller_span.end == at->caller_span.end &&
      s->row == at->row && s->index == at->index)
    return c->site = *slot;
  c->site = cag_alloc(c->vm, CAG_INTERNAL, sizeof *c->site);
  const CagObject head = c->site->head;
  *c->site = *at;
  c->site->head = head;
  c->site->head.flags = CAG_INTERNAL_SITE;
  if (may_share(c->vm)) *slot = c->site;
  return c->site;
}

static bool is_same_motion(const CagMotionNote *a, const CagMotionNote *b) {
  return a->numbers == b->numbers && a->given == b->given && a->planar == b->planar &&
         a->in_front == b->in_front &&
         !memcmp(a->m, b->m, cag_motion_bytes(a) - offsetof(CagMotionNote, m));
}

static CagMotionNote *shared_motion(CagVm *vm, CagMotionNote *note) {
  CagDigest d = cag_digest_start();
  cag_digest_numbers(&d, note->m, note->numbers);
  CagMotionNote **slot = &vm->recent.motions[slot_of(d.a)];
  if (*slot && is_same_motion(*slot, note)) return *slot;
  if (may_share(vm)) *slot = note;
  return note;
}

// The motion of a shape, with the vector that the call was given if it is a translation.
static CagMotionNote *motion_of(NotedCall *c, CagMotionNote *note) {
  const double *x;
  size_t n;
  if (!c->call || !cag_is_translation(c->call->builtin) || c->count < 2 ||
      !cag_as_vector(c->values[1], &x, &n) || (n != 2 && n != 3))
    return shared_motion(c->vm, note);
  const double v[] = {x[0], x[1], n == 3 ? x[2] : 0};
  if (note->numbers == 3 && !memcmp(v, note->m, sizeof v)) {
    note->given = (uint8_t)n;
    return shared_motion(c->vm, note);
  }
  const CagTransform t = cag_motion_transform(note);
  return shared_motion(c->vm, cag_motion_note(c->vm, &t, x, n));
}

// --- Steps ---

static void add_step(NotedCall *c, CagValue v) {
  CagShape *s = CAG_AS_SHAPE(v);
  CagOriginStep step = {.site = site_of(c), .kind = CAG_STEP_SHAPED};
  if (s->motion) {
    step.kind = CAG_STEP_MOVED;
    step.as.motion = motion_of(c, s->motion);
  } else if (s->copied) step.kind = CAG_STEP_SAID;
  else if (!s->origin.operands) step.as.inputs = inputs_of(c);
  if (c->call && !c->sought_call) c->kept = kept_call(c->call, s->origin.last);
  c->sought_call = true;
  s->fresh = s->copied = false;
  s->motion = NULL;
  cag_origin_add(c->vm, &s->origin, &step, c->kept);
}

// Adds a call to the origins of the shapes that it made. The first of a list tells whether it made
// the others.
static void add_call_to_origin(NotedCall *c, CagValue v) {
  const CagList *items = NULL;
  if (v.type == CAG_LIST) items = CAG_AS_LIST(v);
  if (v.type == CAG_GROUP && CAG_AS_SHAPE(v)->fresh) items = CAG_AS_SHAPE(v)->as.items;
  for (size_t i = 0; items && items->dim == 0 && i < items->length; i++) {
    const CagValue item = items->as.items[i];
    if (!cag_is_shape(item) || !CAG_AS_SHAPE(item)->fresh) break;
    add_call_to_origin(c, item);
  }
  if (cag_is_shape(v) && CAG_AS_SHAPE(v)->fresh) add_step(c, v);
}

static void note(NotedCall *c, CagValue result) {
  if (!cag_is_shape(result) && result.type != CAG_LIST) return;
  CagOriginSite *at = &c->at;
  if (!cag_vm_place(c->vm, &at->source, &at->span)) return;
  if (at->source->library) cag_vm_caller(c->vm, &at->caller, &at->caller_span);
  add_call_to_origin(c, result);
}

void cag_origin_note(const CagCall *call, size_t index, CagValue result) {
  note(&(NotedCall){.vm = call->vm,
                    .call = call,
                    .at = {.row = call->builtin, .index = index},
                    .values = call->values,
                    .count = call->count},
       result);
}

void cag_origin_note_operator(CagVm *vm, CagValue result, const CagValue *values, size_t count) {
  note(&(NotedCall){.vm = vm, .values = values, .count = count}, result);
}
