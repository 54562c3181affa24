// Each shape has a chain of steps, one for each call that it went through. A step keeps the arguments
// of the call, so that a page can show the points in them, and the map between the shape before and
// after it. The steps of other operands are among the arguments: together they are the tree of calls
// that made the shape, without the shapes in between.

#include "interp/vm/origin.h"

#include "interp/vm/vm.h"

// Lists are followed this deep for shapes.
#define LIST_DEPTH 3
// The most shapes in an argument whose steps are kept.
#define MOST_SHAPES 400

// The arguments of the call that is noted. They are copied when the first shape is found.
typedef struct Noting {
  const CagCall *call;
  size_t index;
  CagOriginStep step; // its location
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

// What is kept of an argument. `before` is the step that the chain itself continues.
static CagValue kept_argument(CagVm *vm, CagValue v, const CagOriginStep *before, int depth) {
  switch (v.type) {
  case CAG_NONE:
  case CAG_BOOL:
  case CAG_NUMBER:
  case CAG_ANGLE:
  case CAG_PLANE: return v;
  case CAG_LIST: return kept_list(vm, v, before, depth);
  case CAG_GROUP:
    return kept_list(vm, cag_object(CAG_LIST, CAG_AS_SHAPE(v)->as.items), before, depth);
  default: break;
  }
  if (!cag_is_shape(v)) return cag_unset();
  CagOriginStep *last = CAG_AS_SHAPE(v)->origin.last;
  return last && last != before ? cag_object(CAG_INTERNAL, last) : cag_unset();
}

static CagOriginCall *kept_call(const Noting *n, const CagOriginStep *before) {
  const CagCall *call = n->call;
  size_t count = call->count;
  while (count > 0 && call->values[count - 1].type == CAG_UNSET) count--;
  CagOriginCall *kept =
      cag_alloc(call->vm, CAG_INTERNAL, sizeof *kept + count * sizeof *kept->values);
  kept->head.flags = CAG_INTERNAL_CALL;
  kept->row = call->builtin;
  kept->index = n->index;
  kept->count = count;
  for (size_t i = 0; i < count; i++) kept->values[i] = cag_unset();
  for (size_t i = 0; i < count; i++)
    kept->values[i] = kept_argument(call->vm, call->values[i], before, 0);
  return kept;
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
  if (!n->copied) n->step.call = kept_call(n, o->last);
  n->copied = true;
  add_step(n->call->vm, o, &n->step);
}

void cag_origin_note(const CagCall *call, size_t index, CagValue result) {
  Noting n = {.call = call, .index = index};
  if (!cag_vm_place(call->vm, &n.step.source, &n.step.span)) return;
  if (n.step.source->library) cag_vm_caller(call->vm, &n.step.caller, &n.step.caller_span);
  note_in(&n, result);
}

void cag_origin_moved(CagVm *vm, CagValue moved, const CagTransform *t) {
  CagOrigin *o = &CAG_AS_SHAPE(moved)->origin;
  const CagTransform all = o->motion ? cag_transform_multiply(t, &o->motion->t) : *t;
  o->motion = CAG_AS_TRANSFORM(cag_transform_value(vm, &all));
}
