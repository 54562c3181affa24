// Each shape has a chain of steps, one for each call that it went through. A step keeps the arguments
// of the call, so that a page can show the points in them, and the map between the shape before and
// after it. The steps of other operands are among the arguments: together they are the tree of calls
// that made the shape, without the shapes in between.

#include "interp/vm/origin.h"

#include <string.h>

#include "interp/vm/vm.h"

// Lists are followed this deep for shapes.
#define LIST_DEPTH 3
// The most shapes in an argument whose steps are kept.
#define MOST_SHAPES 400
// Of more arguments, which only functions of any number of shapes have, the first ones are kept.
#define MOST_ARGUMENTS 64

// The arguments of the call that is noted. They are copied when the first shape is found.
typedef struct Noting {
  const CagCall *call;
  CagOriginStep step; // its location and function
  bool copied;
} Noting;

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

// Whether an argument of a call may have points, or a vector that tells where shapes are.
static bool has_points(const CagBuiltin *row, const char *words) {
  if (!strncmp(row->result, "as ", 3)) return !strcmp(words, "vector") && cag_is_translation(row);
  return strstr(words, "point") || strstr(words, "vector");
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
  return !strcmp(row->result, "as G") && !strcmp(cag_builtin_signature_of(row)->name, "translate");
}

// --- Steps ---

static CagTransformValue *combined(CagVm *vm, CagTransformValue *later,
                                   CagTransformValue *earlier) {
  if (!later || !earlier) return later ? later : earlier;
  const CagTransform both = cag_transform_multiply(&later->t, &earlier->t);
  return CAG_AS_TRANSFORM(cag_transform_value(vm, &both));
}

static void add_step(CagVm *vm, CagOrigin *o, const CagOriginStep *like) {
  CagOriginStep *before = o->last;
  CagTransformValue *motion = o->motion;
  if (before && before->depth >= CAG_ORIGIN_DEPTH) { // drops the latest one
    motion = combined(vm, motion, before->motion);
    before = before->before;
  }
  CagOriginStep *step = cag_alloc(vm, CAG_INTERNAL, sizeof *step);
  const CagObject head = step->head;
  *step = *like;
  step->head = head;
  step->head.flags = CAG_INTERNAL_STEP;
  step->motion = motion;
  step->before = before;
  step->depth = before ? before->depth + 1 : 0;
  o->last = step;
  o->motion = NULL;
}

// The first of a list tells whether the call made the others.
static void note_in(Noting *n, CagValue v) {
  const CagList *items = NULL;
  if (v.type == CAG_LIST) items = CAG_AS_LIST(v);
  if (v.type == CAG_GROUP && CAG_AS_SHAPE(v)->fresh) items = CAG_AS_SHAPE(v)->as.items;
  for (size_t i = 0; items && items->dim == 0 && i < items->length; i++) {
    const CagValue item = items->as.items[i];
    if (!cag_is_shape(item) || !CAG_AS_SHAPE(item)->fresh) break;
    note_in(n, item);
  }
  if (!cag_is_shape(v) || !CAG_AS_SHAPE(v)->fresh) return;
  CagOrigin *o = &CAG_AS_SHAPE(v)->origin;
  CAG_AS_SHAPE(v)->fresh = false;
  if (!n->copied) n->step.call = kept_call(n->call, o->last);
  n->copied = true;
  add_step(n->call->vm, o, &n->step);
}

void cag_origin_note(const CagCall *call, size_t index, CagValue result) {
  Noting n = {.call = call, .step = {.row = call->builtin, .index = index}};
  if (!cag_vm_place(call->vm, &n.step.source, &n.step.span)) return;
  if (n.step.source->library) cag_vm_caller(call->vm, &n.step.caller, &n.step.caller_span);
  note_in(&n, result);
}

void cag_origin_moved(CagVm *vm, CagValue moved, const CagTransform *t) {
  CagOrigin *o = &CAG_AS_SHAPE(moved)->origin;
  const CagTransform all = o->motion ? cag_transform_multiply(t, &o->motion->t) : *t;
  o->motion = CAG_AS_TRANSFORM(cag_transform_value(vm, &all));
}
