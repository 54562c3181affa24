// The types of the language itself: numbers, texts, lists, records, functions, modules.

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/assert.h"
#include "base/memory.h"
#include "interp/vm/builtin.h"
#include "interp/vm/jet.h"
#include "interp/vm/value_type.h"
#include "interp/vm/vm.h"

static void add(CagString *s, const char *text) { cag_string_add(s, text, strlen(text)); }

// --- none, bool, number, angle ---

static void print_none(CagVm *vm, CagString *s, CagValue v) {
  (void)vm, (void)v;
  add(s, "none");
}

static void print_bool(CagVm *vm, CagString *s, CagValue v) {
  (void)vm;
  add(s, v.as.boolean ? "true" : "false");
}

static void print_number(CagVm *vm, CagString *s, CagValue v) {
  (void)vm;
  cag_print_number(s, v.as.number);
}

static void describe_number(CagVm *vm, CagString *s, CagValue v) {
  add(s, "the number ");
  print_number(vm, s, v);
}

static void print_angle(CagVm *vm, CagString *s, CagValue v) {
  print_number(vm, s, v);
  add(s, "deg");
}

static void describe_angle(CagVm *vm, CagString *s, CagValue v) {
  add(s, "the angle ");
  print_angle(vm, s, v);
}

static bool equal_none(CagVm *vm, CagValue a, CagValue b) {
  (void)vm, (void)a, (void)b;
  return true;
}

static bool equal_bools(CagVm *vm, CagValue a, CagValue b) {
  (void)vm;
  return a.as.boolean == b.as.boolean;
}

static bool equal_numbers(CagVm *vm, CagValue a, CagValue b) {
  (void)vm;
  return a.as.number == b.as.number;
}

const CagValueType cag_type_none = {
    .print = print_none, .describe = print_none, .equal = equal_none};
const CagValueType cag_type_bool = {
    .print = print_bool, .describe = print_bool, .equal = equal_bools};
const CagValueType cag_type_number = {
    .print = print_number, .describe = describe_number, .equal = equal_numbers};
const CagValueType cag_type_angle = {
    .print = print_angle, .describe = describe_angle, .equal = equal_numbers};

// A jet is printed as its value.
static void print_jet(CagVm *vm, CagString *s, CagValue v) {
  cag_print_value(vm, s, cag_plain(v), true);
}

static void describe_jet(CagVm *vm, CagString *s, CagValue v) {
  cag_describe_value(vm, s, cag_plain(v));
}

// cag_equal compares the values of jets.
const CagValueType cag_type_jet = {.print = print_jet, .describe = describe_jet};

// --- text ---

// Longer values are described only by type and size.
#define DESCRIBED_MAX 40

static void print_text(CagVm *vm, CagString *s, CagValue v) {
  (void)vm;
  cag_print_quoted(s, CAG_AS_TEXT(v));
}

static void describe_text(CagVm *vm, CagString *s, CagValue v) {
  if (CAG_AS_TEXT(v)->length > DESCRIBED_MAX) {
    cag_string_printf(s, "a text of %zu characters", CAG_AS_TEXT(v)->characters);
    return;
  }
  add(s, "the text ");
  print_text(vm, s, v);
}

static bool equal_texts(CagVm *vm, CagValue a, CagValue b) {
  (void)vm;
  const CagText *x = CAG_AS_TEXT(a), *y = CAG_AS_TEXT(b);
  return x == y || (x->length == y->length && memcmp(x->bytes, y->bytes, x->length) == 0);
}

const CagValueType cag_type_text = {
    .print = print_text, .describe = describe_text, .equal = equal_texts};

// --- list ---

static void print_list(CagVm *vm, CagString *s, CagValue v) {
  const CagList *l = CAG_AS_LIST(v);
  if (l->dim == 1) {
    cag_print_numbers(vm, s, l->as.numbers, l->length);
    return;
  }
  add(s, "[");
  for (size_t i = 0; i < l->length && !cag_print_is_cut(vm, s); i++) {
    if (i) add(s, ", ");
    if (l->dim) cag_print_numbers(vm, s, l->as.numbers + i * l->dim, l->dim);
    else cag_print_value(vm, s, l->as.items[i], true);
  }
  add(s, "]");
}

static void describe_list(CagVm *vm, CagString *s, CagValue v) {
  const CagList *l = CAG_AS_LIST(v);
  if (l->length == 0) {
    add(s, "an empty list");
    return;
  }
  CagString inner = {.most = DESCRIBED_MAX};
  if (l->length <= 8) cag_print_value(vm, &inner, v, true);
  if (inner.length && inner.length <= DESCRIBED_MAX && !vm->stop)
    cag_string_printf(s, "the list %s", inner.bytes);
  else cag_string_printf(s, "a list of %zu %s", l->length, l->length == 1 ? "element" : "elements");
  cag_string_free(&inner);
}

static bool equal_items(CagVm *vm, const CagList *a, const CagList *b) {
  for (size_t i = 0; i < a->length; i++)
    if (!cag_equal(vm, cag_list_get(vm, a, i), cag_list_get(vm, b, i))) return false;
  return true;
}

static bool equal_lists(CagVm *vm, CagValue v, CagValue w) {
  const CagList *a = CAG_AS_LIST(v), *b = CAG_AS_LIST(w);
  if (!cag_may_go_deeper(vm, "compared")) return false;
  if (a == b) return true;
  if (a->length != b->length) return false;
  if (a->dim != b->dim) // they can be equal only if one contains jets, which compare by value
    return vm->differentiation && a->dim + b->dim > 0 && (a->dim == 0 || b->dim == 0) &&
           equal_items(vm, a, b);
  if (a->dim == 0) return equal_items(vm, a, b);
  for (size_t i = 0; i < a->length * a->dim; i++)
    if (a->as.numbers[i] != b->as.numbers[i]) return false;
  return true;
}

static void scan_list(CagHeap *h, CagObject *o) {
  CagList *l = (CagList *)o;
  CAG_ASSERT(cag_check_list(l));
  if (l->owner) cag_mark_object(h, &l->owner->head);
  else if (l->dim == 0) cag_mark_values(h, l->as.items, l->length);
}

static void destroy_list(CagObject *o) {
  if (((CagList *)o)->allocated) cag_free(((CagList *)o)->as.data);
}

static bool list_member(CagVm *vm, CagValue object, const char *name, CagValue *result) {
  static const char axes[] = "xyzw";
  const CagList *l = CAG_AS_LIST(object);
  const char *axis = name[0] && !name[1] ? strchr(axes, name[0]) : NULL;
  if (axis && l->dim == 1 && l->length >= 2 && l->length <= 4) {
    size_t k = (size_t)(axis - axes);
    if (k < l->length) {
      *result = cag_number(l->as.numbers[k]);
      return true;
    }
    return cag_vm_fail(vm, CAG_ERR_field, "a vector of %zu numbers has no `%s`", l->length, name);
  }
  if (axis && l->dim == 0 && l->length >= 2 && l->length <= 4 && vm->differentiation &&
      cag_holds_jet(object)) {
    size_t k = (size_t)(axis - axes);
    if (k < l->length) {
      *result = l->as.items[k];
      return true;
    }
    return cag_vm_fail(vm, CAG_ERR_field, "a vector of %zu numbers has no `%s`", l->length, name);
  }
  if (axis) {
    CagString s = {0};
    cag_describe_value(vm, &s, object);
    cag_vm_fail(vm, CAG_ERR_field, "`.%s` needs a vector of 2 to 4 numbers, found %s", name,
                s.bytes);
    cag_string_free(&s);
    return false;
  }
  return false;
}

const CagValueType cag_type_list = {.print = print_list,
                                    .describe = describe_list,
                                    .equal = equal_lists,
                                    .scan = scan_list,
                                    .destroy = destroy_list,
                                    .member = list_member};

// --- range ---

static void print_range(CagVm *vm, CagString *s, CagValue v) {
  (void)vm;
  const CagRange *r = CAG_AS_RANGE(v);
  const char *unit = r->angle ? "deg" : "";
  cag_print_number(s, r->start);
  add(s, unit);
  add(s, r->open ? "..<" : "..");
  cag_print_number(s, r->end);
  add(s, unit);
  if (!r->stepped) return;
  add(s, " by ");
  cag_print_number(s, r->step);
  add(s, unit);
}

static void describe_range(CagVm *vm, CagString *s, CagValue v) {
  add(s, "the range ");
  print_range(vm, s, v);
}

static bool equal_ranges(CagVm *vm, CagValue a, CagValue b) {
  (void)vm;
  const CagRange *x = CAG_AS_RANGE(a), *y = CAG_AS_RANGE(b);
  return x->start == y->start && x->end == y->end && x->step == y->step && x->angle == y->angle &&
         x->open == y->open;
}

static const char *const range_members[] = {"start", "end", "step", NULL};

static bool range_member(CagVm *vm, CagValue v, const char *name, CagValue *out) {
  (void)vm;
  const CagRange *r = CAG_AS_RANGE(v);
  const double x[] = {r->start, r->end, r->step};
  for (size_t i = 0; range_members[i]; i++) {
    if (strcmp(name, range_members[i]) != 0) continue;
    *out = r->angle ? cag_angle(x[i]) : cag_number(x[i]);
    return true;
  }
  return false;
}

static const char *range_member_name(CagVm *vm, CagValue v, size_t i) {
  (void)vm, (void)v;
  return cag_name_at(range_members, i);
}

const CagValueType cag_type_range = {.print = print_range,
                                     .describe = describe_range,
                                     .equal = equal_ranges,
                                     .member = range_member,
                                     .member_name = range_member_name};

// --- record ---

// Tests whether a field's name can be written without quotes.
static bool is_word(const CagText *t) {
  if (t->length == 0 || (t->bytes[0] >= '0' && t->bytes[0] <= '9')) return false;
  for (size_t i = 0; i < t->length; i++) {
    unsigned char c = (unsigned char)t->bytes[i];
    bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c >= 0x80 ||
                  (c >= '0' && c <= '9');
    if (!letter) return false;
  }
  return true;
}

static void print_record(CagVm *vm, CagString *s, CagValue v) {
  const CagRecord *r = CAG_AS_RECORD(v);
  add(s, "{");
  for (size_t i = 0; i < r->layout->count && !cag_print_is_cut(vm, s); i++) {
    if (i) add(s, ", ");
    const CagText *name = r->layout->names[i];
    if (is_word(name)) add(s, name->bytes);
    else cag_print_quoted(s, name);
    add(s, ": ");
    cag_print_value(vm, s, r->fields[i], true);
  }
  add(s, "}");
}

static bool equal_records(CagVm *vm, CagValue v, CagValue w) {
  const CagRecord *a = CAG_AS_RECORD(v), *b = CAG_AS_RECORD(w);
  if (!cag_may_go_deeper(vm, "compared")) return false;
  if (a == b) return true;
  if (a->layout->count != b->layout->count) return false;
  for (size_t i = 0; i < a->layout->count; i++) {
    CagValue other = cag_record_get_text(vm, b, a->layout->names[i]);
    if (other.type == CAG_UNSET || !cag_equal(vm, a->fields[i], other)) return false;
  }
  return true;
}

static void scan_record(CagHeap *h, CagObject *o) {
  CagRecord *r = (CagRecord *)o;
  cag_mark_object(h, &r->layout->head);
  cag_mark_values(h, r->fields, r->layout->count);
}

static bool record_member(CagVm *vm, CagValue v, const char *name, CagValue *out) {
  (void)vm;
  *out = cag_record_get(CAG_AS_RECORD(v), name);
  return out->type != CAG_UNSET;
}

static const char *record_member_name(CagVm *vm, CagValue v, size_t i) {
  (void)vm;
  const CagLayout *l = CAG_AS_RECORD(v)->layout;
  return i < l->count ? l->names[i]->bytes : NULL;
}

const CagValueType cag_type_record = {.print = print_record,
                                      .equal = equal_records,
                                      .scan = scan_record,
                                      .member = record_member,
                                      .member_name = record_member_name};

// --- function ---

static const char *function_name(CagValue v) {
  return v.type == CAG_CLOSURE ? CAG_AS_CLOSURE(v)->proto->name
                               : cag_builtin_name(CAG_AS_BUILTIN(v)->index);
}

static void print_function(CagVm *vm, CagString *s, CagValue v) {
  (void)vm;
  const char *name = function_name(v);
  cag_string_printf(s, name ? "function %s" : "function", name);
}

static void describe_function(CagVm *vm, CagString *s, CagValue v) {
  (void)vm;
  const char *name = function_name(v);
  cag_string_printf(s, name ? "the function %s" : "a function", name);
}

static void scan_closure(CagHeap *h, CagObject *o) {
  CagClosure *c = (CagClosure *)o;
  cag_mark_values(h, c->captures, c->capture_count);
}

static bool equal_builtins(CagVm *vm, CagValue a, CagValue b) {
  (void)vm;
  return CAG_AS_BUILTIN(a)->index == CAG_AS_BUILTIN(b)->index;
}

const CagValueType cag_type_closure = {
    .print = print_function, .describe = describe_function, .scan = scan_closure};
const CagValueType cag_type_builtin = {
    .print = print_function, .describe = describe_function, .equal = equal_builtins};

// --- module ---

static void print_module(CagVm *vm, CagString *s, CagValue v) {
  const char *name = vm->modules[CAG_AS_MODULE(v)->module]->name;
  const char *last = strrchr(name, '/');
  name = last ? last + 1 : name;
  if (strncmp(name, "std.", 4) == 0) name += 4;
  size_t n = strlen(name);
  if (n > 4 && strcmp(name + n - 4, ".cag") == 0) n -= 4;
  cag_string_printf(s, "module %.*s", (int)n, name);
}

static bool equal_modules(CagVm *vm, CagValue a, CagValue b) {
  (void)vm;
  return CAG_AS_MODULE(a)->module == CAG_AS_MODULE(b)->module;
}

static const CagModuleUnit *unit_of(CagVm *vm, CagValue v) {
  return vm->modules[CAG_AS_MODULE(v)->module];
}

static bool module_member(CagVm *vm, CagValue v, const char *name, CagValue *out) {
  const CagModuleUnit *m = unit_of(vm, v);
  for (size_t i = 0; i < m->public_count; i++)
    if (strcmp(m->publics[i].name, name) == 0) return cag_vm_force(vm, m->publics[i].global, out);
  return false;
}

static const char *module_member_name(CagVm *vm, CagValue v, size_t i) {
  const CagModuleUnit *m = unit_of(vm, v);
  return i < m->public_count ? m->publics[i].name : NULL;
}

const CagValueType cag_type_module = {.print = print_module,
                                      .equal = equal_modules,
                                      .member = module_member,
                                      .member_name = module_member_name};

// --- Internal objects: builders and layouts, distinguished by their flags ---

static void print_nothing(CagVm *vm, CagString *s, CagValue v) {
  (void)vm, (void)v;
  add(s, "nothing");
}

// Names of definitions are interned, so they need no marks.
void cag_mark_origin(CagHeap *h, const CagOrigin *o) {
  if (o->last) cag_mark_object(h, &o->last->head);
  if (o->operands) cag_mark_object(h, &o->operands->head);
}

static void scan_step(CagHeap *h, const CagOriginStep *step) {
  if (step->before) cag_mark_object(h, &step->before->head);
  cag_mark_object(h, &step->site->head);
  if (step->called) cag_mark_object(h, &step->call[0]->head);
  if (cag_step_motion(step)) cag_mark_object(h, &step->as.motion->head);
  if (cag_step_inputs(step)) cag_mark_object(h, &step->as.inputs->head);
}

static void scan_internal(CagHeap *h, CagObject *o) {
  const CagBuilder *b = (CagBuilder *)o;
  if (o->flags == CAG_INTERNAL_BUILDER && (b->mixed || b->dim == 0))
    cag_mark_values(h, b->data, b->length);
  if (o->flags == CAG_INTERNAL_LABEL) cag_mark_object(h, &((CagLabelText *)o)->text->head);
  if (o->flags == CAG_INTERNAL_STEP) scan_step(h, (CagOriginStep *)o);
  if (o->flags == CAG_INTERNAL_INPUTS) {
    const CagInputs *inputs = (CagInputs *)o;
    for (size_t i = 0; i < inputs->count; i++) cag_mark_value(h, inputs->items[i].shape);
  }
  if (o->flags == CAG_INTERNAL_OPERANDS) {
    const CagOperands *operands = (CagOperands *)o;
    const size_t before = operands->first ? operands->first->count : 0;
    if (operands->first) cag_mark_object(h, &operands->first->head);
    for (size_t i = 0; before + i < operands->count; i++) cag_mark_origin(h, &operands->items[i]);
  }
  const CagOriginCall *call = (CagOriginCall *)o;
  if (o->flags == CAG_INTERNAL_CALL) cag_mark_values(h, call->values, call->count);
  if (o->flags == CAG_INTERNAL_STILL) {
    cag_mark_object(h, &((CagStill *)o)->shape->head);
    cag_mark_object(h, &((CagStill *)o)->motion->head);
  }
  if (o->flags == CAG_INTERNAL_POSTURE) cag_mark_object(h, &((CagPosture *)o)->robot->head);
  if (o->flags == CAG_INTERNAL_LIMB) cag_mark_object(h, &((CagLimb *)o)->posture->head);
}

static void destroy_internal(CagObject *o) {
  if (o->flags == CAG_INTERNAL_BUILDER) cag_free(((CagBuilder *)o)->data);
  if (o->flags == CAG_INTERNAL_LAYOUT) cag_free(((CagLayout *)o)->index);
}

const CagValueType cag_type_internal = {
    .print = print_nothing, .scan = scan_internal, .destroy = destroy_internal};
