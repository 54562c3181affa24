// Binding of arguments, and calls of values that are not closures.

#include "interp/vm/calls.h"

#include <string.h>

#include "base/memory.h"
#include "interp/vm/apply.h"
#include "interp/vm/jet.h"
#include "interp/vm/jet_builtins.h"
#include "interp/vm/origin.h"
#include "interp/vm/value_type.h"
#include "lang/foreign.h"

static const char *function_name(const char *name) { return name ? name : "this function"; }

// Formats "f(x, y = ...)" for messages.
static void add_closure_signature(CagString *s, const CagProto *p) {
  cag_string_printf(s, "%s(", p->name ? p->name : "");
  for (size_t i = 0; i < p->parameter_count; i++) {
    if (i) cag_string_add(s, ", ", 2);
    cag_string_add(s, p->parameters[i], strlen(p->parameters[i]));
    if (i >= p->required_count) cag_string_add(s, " = ...", 6);
  }
  cag_string_add(s, ")", 1);
}

static bool fail_arity(CagVm *vm, const char *name, size_t required, size_t most, bool any,
                       size_t found) {
  char expected[64];
  if (any) snprintf(expected, sizeof expected, "at least %zu", required);
  else if (required == most) snprintf(expected, sizeof expected, "%zu", most);
  else snprintf(expected, sizeof expected, "%zu to %zu", required, most);
  bool one = required == 1 && (any || most == 1);
  return cag_vm_fail(vm, CAG_ERR_arity, "%s expects %s argument%s, found %zu", function_name(name),
                     expected, one ? "" : "s", found);
}

static size_t find_name(const char *const *names, size_t n, const char *name) {
  for (size_t i = 0; i < n; i++)
    if (strcmp(names[i], name) == 0) return i;
  return (size_t)-1;
}

static bool fail_unknown_name(CagVm *vm, const char *function, const char *name,
                              const char *const *names, size_t n, int argument) {
  cag_vm_fail_at(vm, argument, CAG_ERR_argument_name, "%s has no parameter `%s`",
                 function_name(function), name);
  const char *form = NULL, *meant = cag_foreign_argument(name, names, n, &form);
  const char *nearest = cag_nearest_name(name, names, n);
  if (meant) {
    cag_fail_help(vm, "did you mean `%s`, as in %s?", meant, form);
  } else if (nearest) {
    cag_fail_help(vm, "did you mean `%s`?", nearest);
  } else if (n) {
    CagString s = {0};
    for (size_t i = 0; i < n; i++) cag_string_printf(&s, "%s%s", i ? ", " : "", names[i]);
    cag_fail_help(vm, "its parameters are %s", s.bytes);
    cag_string_free(&s);
  }
  return false;
}

// The help for too few arguments names the parameters.
static bool fail_closure_arity(CagVm *vm, const CagProto *p, size_t found) {
  fail_arity(vm, p->name, p->required_count, p->parameter_count, false, found);
  CagString s = {0};
  add_closure_signature(&s, p);
  cag_fail_help(vm, "%s", s.bytes);
  cag_string_free(&s);
  return false;
}

bool cag_bind_closure(CagVm *vm, const CagProto *p, CagValue *arguments, size_t count,
                      const char *const *names, size_t named) {
  size_t positional = count - named;
  if (positional > p->parameter_count || (!named && count < p->required_count))
    return fail_closure_arity(vm, p, count);
  if (!named) {
    for (size_t i = count; i < p->parameter_count; i++) arguments[i] = cag_unset();
    return true;
  }
  CagValue given[16], *moved = named <= 16 ? given : cag_malloc(named * sizeof *moved);
  if (!moved) cag_vm_out_of_memory(vm);
  memcpy(moved, arguments + positional, named * sizeof *moved);
  for (size_t i = positional; i < p->parameter_count; i++) arguments[i] = cag_unset();
  bool ok = true;
  for (size_t i = 0; ok && i < named; i++) {
    size_t k = find_name(p->parameters, p->parameter_count, names[i]);
    if (k == (size_t)-1) {
      ok = fail_unknown_name(vm, p->name, names[i], p->parameters, p->parameter_count,
                             (int)(positional + i));
    } else if (arguments[k].type != CAG_UNSET) {
      ok = cag_vm_fail_at(vm, (int)(positional + i), CAG_ERR_argument_name,
                          "%s got `%s` twice: by position and by name", function_name(p->name),
                          names[i]);
    } else {
      arguments[k] = moved[i];
    }
  }
  if (moved != given) cag_free(moved);
  for (size_t i = 0; ok && i < p->required_count; i++) {
    if (arguments[i].type != CAG_UNSET) continue;
    ok = cag_vm_fail(vm, CAG_ERR_arity, "%s needs an argument for `%s`", function_name(p->name),
                     p->parameters[i]);
  }
  return ok;
}

// --- Built-ins ---

// The maximum number of parameters of a built-in.
#define MAX_PARAMETERS 64

static bool fail_no_row(CagVm *vm, size_t index, CagValue first) {
  CagString served = {0}, found = {0};
  cag_builtin_served(index, &served);
  cag_describe_value(vm, &found, first);
  cag_vm_fail_at(vm, 0, CAG_ERR_type, "%s expects %s, found %s", cag_builtin_name(index),
                 served.bytes ? served.bytes : "another type", found.bytes);
  if (first.type == CAG_NUMBER && served.bytes && strcmp(served.bytes, "an angle") == 0)
    cag_fail_help(vm, "write %sdeg or %srad", found.bytes + strlen("the number "),
                  found.bytes + strlen("the number "));
  else if (cag_foreign_call(cag_builtin_name(index)))
    cag_fail_help(vm, "write %s", cag_foreign_call(cag_builtin_name(index)));
  cag_string_free(&served);
  cag_string_free(&found);
  return false;
}

// Shows how to call a function: its signature, preceded by the correct form if other languages use
// a different one.
static bool help_call(CagVm *vm, const CagBuiltin *row, const CagSignature *s) {
  const char *form = cag_foreign_call(s->name);
  if (form) return cag_fail_help(vm, "write %s; the signature is %s", form, row->signature);
  return cag_fail_help(vm, "%s", row->signature);
}

static bool fail_builtin_arity(CagVm *vm, const CagBuiltin *row, const CagSignature *s,
                               size_t found) {
  fail_arity(vm, s->name, s->required, s->count, s->variadic, found);
  return help_call(vm, row, s);
}

// Moves named arguments to their parameters. `order` is set to the argument from which each
// parameter came.
static bool bind_names(CagVm *vm, const CagSignature *s, CagValue *values, size_t positional,
                       const char *const *names, size_t named, uint16_t *order) {
  CagValue moved[MAX_PARAMETERS];
  if (named > MAX_PARAMETERS)
    return cag_vm_fail(vm, CAG_ERR_arity, "%s got %zu named arguments", s->name, named);
  memcpy(moved, values + positional, named * sizeof *moved);
  for (size_t i = positional; i < s->count; i++) {
    values[i] = cag_unset();
    order[i] = 0xffff;
  }
  for (size_t i = 0; i < positional && i < s->count; i++) order[i] = (uint16_t)i;
  for (size_t i = 0; i < named; i++) {
    size_t k = find_name(s->parameters, s->count, names[i]);
    int place = (int)(positional + i);
    if (k == (size_t)-1)
      return fail_unknown_name(vm, s->name, names[i], s->parameters, s->count, place);
    if (s->positional_only[k])
      return cag_vm_fail_at(vm, place, CAG_ERR_argument_name, "%s takes `%s` by position only",
                            s->name, names[i]);
    if (values[k].type != CAG_UNSET)
      return cag_vm_fail_at(vm, place, CAG_ERR_argument_name, "%s got `%s` twice", s->name,
                            names[i]);
    values[k] = moved[i];
    order[k] = (uint16_t)place;
  }
  return true;
}

// Handles a built-in that succeeded with an error set, or failed without one. This is valid after a
// formula failed at a point that the geometry core only probed, or if a limit was noticed late.
static bool check_answer(CagVm *vm, const char *name, bool ok) {
  if (!ok) return cag_vm_fail(vm, CAG_ERR_internal, "%s failed without an error", name);
  if (vm->native->probed || cag_vm_at_limit(vm)) return false;
  return cag_vm_fail(vm, CAG_ERR_internal, "%s continued after the error: %s", name,
                     vm->errors.items[0].message);
}

static bool call_builtin(CagVm *vm, size_t index, CagValue *values, size_t count,
                         const char *const *names, size_t named, bool direct, CagValue *result) {
  size_t positional = count - named;
  CagType first = positional ? cag_plain_type(values[0]) : CAG_UNSET;
  size_t row = cag_builtin_select(index, first, positional);
  if (row == (size_t)-1) return fail_no_row(vm, index, values[0]);
  size_t rows;
  const CagBuiltin *b = cag_builtin_rows(index, &rows) + row;
  const CagSignature *s = cag_builtin_signature(index, row);
  if (!s)
    return cag_vm_fail_at(vm, -1, CAG_ERR_not_function, "%s is not a function",
                          cag_builtin_name(index));
  if ((positional > s->count && !s->variadic) || (!named && count < s->required))
    return fail_builtin_arity(vm, b, s, count);
  uint16_t order[MAX_PARAMETERS];
  CagNative native = {.outer = vm->native, .frame_count = vm->frame_count, .direct = direct};
  size_t total = count;
  if (named) {
    if (positional > s->count) return fail_builtin_arity(vm, b, s, count);
    if (!bind_names(vm, s, values, positional, names, named, order)) return false;
    native.order = order;
    native.order_count = s->count;
    for (size_t i = 0; i < s->required; i++)
      if (values[i].type == CAG_UNSET) {
        cag_vm_fail(vm, CAG_ERR_arity, "%s needs an argument for `%s`", s->name, s->parameters[i]);
        return help_call(vm, b, s);
      }
    total = s->count;
  } else {
    for (size_t i = count; i < s->count; i++) values[i] = cag_unset();
    if (total < s->count) total = s->count;
  }
  for (size_t i = s->required; i < s->count; i++)
    if (values[i].type == CAG_NONE && s->none_is_unset[i]) values[i] = cag_unset();
  CagValue *top = vm->top;
  if (values + total > vm->top) vm->top = values + total;
  if (vm->top > vm->high_water) vm->high_water = vm->top;
  if (vm->top > vm->paid_end) cag_pay_for_values(vm, vm->top);
  vm->native = &native;
  const size_t held = vm->held_count;
  CagCall call = {.vm = vm, .builtin = b, .values = values, .count = total, .err = &vm->core_error};
  *result = cag_none();
  CagBuiltinFunction function = vm->differentiation ? cag_jet_function(&call, index) : b->function;
  bool ok = function(&call, result);
  if (cag_memory_was_out()) ok = cag_vm_fail_memory(vm);
  else if (ok == vm->failed) ok = check_answer(vm, s->name, ok);
  ok = ok && cag_check_defined(&call, *result);
  cag_vm_release_held(vm, held);
  if (vm->stop) ok = cag_stop_answer(vm); // interrupted work may have returned anything
  if (ok) cag_origin_note(&call, index, *result);
  vm->native = native.outer;
  vm->top = top;
  return ok;
}

bool cag_call_native(CagVm *vm, CagValue callee, CagValue *arguments, size_t count,
                     const char *const *names, size_t named, bool direct, CagValue *result) {
  if (arguments + count + MAX_PARAMETERS >= vm->stack_end)
    return cag_vm_fail(vm, CAG_ERR_limit_depth, "the stack of values is full");
  if (callee.type == CAG_BUILTIN)
    return call_builtin(vm, CAG_AS_BUILTIN(callee)->index, arguments, count, names, named, direct,
                        result);
  const CagValueType *type = cag_value_type(callee);
  if (type->call) {
    if (named)
      return cag_vm_fail(vm, CAG_ERR_argument_name, "a call of %s takes its parameters by position",
                         cag_type_article(callee));
    bool jets = false;
    for (size_t i = 0; vm->differentiation && i < count; i++)
      jets = jets || arguments[i].type == CAG_JET;
    return jets ? cag_jet_shape_call(vm, callee, arguments, count, result)
                : type->call(vm, callee, arguments, count, result);
  }
  CagString s = {0};
  cag_describe_value(vm, &s, callee);
  cag_vm_fail_at(vm, -1, CAG_ERR_not_function, "cannot call %s, which is not a function", s.bytes);
  cag_string_free(&s);
  return cag_fail_hidden(vm);
}
