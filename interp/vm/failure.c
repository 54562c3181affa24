// Errors of a run: their location, the chain of calls, and their form in scripts.
//
// The location of an error is the current instruction of the top frame, whose pc is just after it.
// A built-in may name one of its arguments, which is then underlined if the call in the source
// contains it.

#include <stdarg.h>
#include <string.h>

#include "base/memory.h"
#include "interp/vm/jet.h"
#include "interp/vm/vm.h"

// Of longer chains, only the first and last frames are shown.
#define CHAIN_FIRST 6
#define CHAIN_LAST 4

static uint32_t at_instruction(const CagFrame *f) {
  long k = f->pc - f->proto->code - 1;
  return k < 0 ? 0 : (uint32_t)k;
}

#define WHOLE_CALL (-2)

// Returns the call's argument spans at an instruction, or NULL.
static const CagCallSite *find_site(const CagProto *p, uint32_t pc) {
  size_t low = 0, high = p->site_count;
  while (low < high) {
    size_t middle = (low + high) / 2;
    if (p->sites[middle].pc < pc) low = middle + 1;
    else high = middle;
  }
  return low < p->site_count && p->sites[low].pc == pc ? &p->sites[low] : NULL;
}

static CagSpan place_of(const CagFrame *f, int argument) {
  uint32_t pc = at_instruction(f);
  const CagCallSite *site = find_site(f->proto, pc);
  if (site && argument >= -1 && (uint32_t)(argument + 1) < site->count)
    return f->proto->site_spans[site->first + (uint32_t)(argument + 1)];
  return f->proto->spans[pc];
}

static void add_call(CagDiagnostic *d, int kind, const CagProto *p, uint32_t pc) {
  // The name is that of the function or definition that contains the call.
  cag_diagnostic_add_note(d, kind, p->source, p->spans[pc], "%s", p->name ? p->name : "");
}

// Adds the frames below the top one, innermost first, and the calls in tail position of each.
static void add_chain(CagVm *vm, CagDiagnostic *d) {
  size_t n = vm->frame_count;
  for (size_t back = 1; back <= n; back++) {
    const CagFrame *f = &vm->frames[n - back];
    if (back > CHAIN_FIRST + 1 && back + CHAIN_LAST <= n) {
      size_t skipped = n - CHAIN_LAST - back + 1;
      cag_diagnostic_add_note(d, CAG_NOTE_OMITTED, NULL, (CagSpan){0, 0}, "%zu more calls",
                              skipped);
      back += skipped - 1;
      continue;
    }
    if (back > 1) add_call(d, CAG_NOTE_CALL, f->proto, at_instruction(f));
    const CagTailPlace *ring = vm->tails + (n - back) * CAG_TAIL_KEPT;
    uint64_t kept = f->tail_count < CAG_TAIL_KEPT ? f->tail_count : CAG_TAIL_KEPT;
    for (uint64_t k = 1; k <= kept; k++) {
      const CagTailPlace *t = &ring[(f->tail_count - k) % CAG_TAIL_KEPT];
      add_call(d, CAG_NOTE_TAIL_CALL, t->proto, t->pc);
    }
    if (f->tail_count > kept)
      cag_diagnostic_add_note(d, CAG_NOTE_OMITTED, NULL, (CagSpan){0, 0},
                              "%llu more calls in tail position",
                              (unsigned long long)(f->tail_count - kept));
  }
}

bool cag_vm_place(const CagVm *vm, const CagSource **source, CagSpan *span) {
  if (!vm->frame_count) return false;
  const CagFrame *f = &vm->frames[vm->frame_count - 1];
  *source = f->proto->source;
  *span = place_of(f, WHOLE_CALL);
  return true;
}

bool cag_vm_caller(const CagVm *vm, const CagSource **source, CagSpan *span) {
  for (size_t i = vm->frame_count; i-- > 0;) {
    const CagFrame *f = &vm->frames[i];
    if (f->proto->source->library) continue;
    *source = f->proto->source;
    *span = place_of(f, WHOLE_CALL);
    return true;
  }
  return false;
}

static const char *memory_message(const CagVm *vm, char *buffer, size_t size) {
  static const char *const units[] = {"B", "KiB", "MiB", "GiB"};
  double limit = (double)vm->account.limit;
  size_t unit = 0;
  for (; unit < 3 && limit >= 1024; unit++) limit /= 1024;
  snprintf(buffer, size, "exceeded the memory limit of %.3g %s (--max-memory)", limit, units[unit]);
  return buffer;
}

static CagDiagnostic *set_error(CagVm *vm, CagErrorId id, int argument, const char *message) {
  char buffer[128];
  if (vm->starved) { // the message may be incomplete
    id = CAG_ERR_limit_memory;
    message = memory_message(vm, buffer, sizeof buffer);
  }
  cag_diagnostics_clear(&vm->errors);
  vm->failed = true;
  const CagSource *source = NULL;
  CagSpan span = {0, 0};
  if (vm->frame_count) {
    const CagFrame *f = &vm->frames[vm->frame_count - 1];
    source = f->proto->source;
    span = place_of(f, argument);
  }
  CagDiagnostic *d = cag_diagnostics_add(&vm->errors, id, source, span, "%s", message);
  add_chain(vm, d);
  return d;
}

static void vfail(CagVm *vm, CagErrorId id, int argument, const char *prefix, const char *format,
                  va_list args) {
  char *message = NULL;
  if (cag_vasprintf(&message, format, args) < 0) message = NULL;
  CagString s = {0};
  if (prefix) cag_string_printf(&s, "%s ", prefix);
  if (message) cag_string_add(&s, message, strlen(message));
  vm->starved |= !message || s.failed;
  cag_free(message);
  set_error(vm, id, argument, s.bytes);
  cag_string_free(&s);
}

bool(cag_vm_fail)(CagVm *vm, CagErrorId id, const char *format, ...) {
  va_list args;
  va_start(args, format);
  vfail(vm, id, WHOLE_CALL, NULL, format, args);
  va_end(args);
  return false;
}

bool cag_vm_fail_in(CagVm *vm, CagValue function, CagErrorId id, const char *format, ...) {
  va_list args;
  va_start(args, format);
  // A temporary frame of the function, at its last instruction.
  bool entered = function.type == CAG_CLOSURE && vm->frame_count < vm->frame_limit;
  if (entered) {
    CagClosure *c = CAG_AS_CLOSURE(function);
    vm->frames[vm->frame_count++] = (CagFrame){.proto = c->proto,
                                               .closure = c,
                                               .pc = c->proto->code + c->proto->code_count,
                                               .base = vm->top};
  }
  vfail(vm, id, WHOLE_CALL, NULL, format, args);
  if (entered) vm->frame_count--;
  va_end(args);
  return false;
}

bool(cag_vm_fail_at)(CagVm *vm, int argument, CagErrorId id, const char *format, ...) {
  va_list args;
  va_start(args, format);
  vfail(vm, id, argument, NULL, format, args);
  va_end(args);
  return false;
}

bool(cag_fail_help)(CagVm *vm, const char *format, ...) {
  if (!vm->failed || vm->errors.count == 0) return false;
  char *text = NULL;
  va_list args;
  va_start(args, format);
  if (cag_vasprintf(&text, format, args) < 0) text = NULL;
  va_end(args);
  if (text)
    cag_diagnostic_set_help(cag_diagnostics_at(&vm->errors, vm->errors.count - 1), "%s", text);
  cag_free(text);
  return false;
}

bool cag_fail_hidden(CagVm *vm) {
  if (!vm->failed || vm->errors.count == 0) return false;
  const CagDiagnostic *d = cag_diagnostics_at(&vm->errors, vm->errors.count - 1);
  char name[64];
  const size_t length = d->span.end - d->span.start;
  if (!d->source || d->help || length >= sizeof name) return false;
  memcpy(name, d->source->text + d->span.start, length);
  name[length] = 0;
  const size_t index = cag_builtin_find(name);
  if (index == (size_t)-1 || !cag_builtin_rows(index, &(size_t){0})->function) return false;
  return cag_fail_help(vm, "`%s` is defined here and hides the built-in function; rename it", name);
}

// Returns the index of the argument, in the call in the source, of parameter `parameter` of the
// running built-in, or WHOLE_CALL.
static int argument_of(const CagCall *call, int parameter) {
  const CagNative *n = call->vm->native;
  if (parameter < 0 || !n || !n->direct || n->frame_count != call->vm->frame_count)
    return WHOLE_CALL;
  if (!n->order) return parameter;
  if ((size_t)parameter >= n->order_count || n->order[parameter] == 0xffff) return WHOLE_CALL;
  return n->order[parameter];
}

bool(cag_fail_call)(CagCall *call, int argument, CagErrorId id, const char *format, ...) {
  va_list args;
  va_start(args, format);
  vfail(call->vm, id, argument_of(call, argument), cag_builtin_signature_of(call->builtin)->name,
        format, args);
  va_end(args);
  return false;
}

bool cag_fail_differentiate(CagCall *call, int argument) {
  cag_fail_call(call, argument, CAG_ERR_not_differentiable, "cannot be differentiated");
  return cag_fail_help(call->vm, "a curve or surface that is differentiated must not use it");
}

bool(cag_fail_type)(CagCall *call, int argument, const char *expected) {
  if ((size_t)argument < call->count && cag_holds_jet(call->values[argument]))
    return cag_fail_differentiate(call, argument);
  const CagSignature *s = cag_builtin_signature_of(call->builtin);
  CagValue v = (size_t)argument < call->count ? call->values[argument] : cag_unset();
  CagString found = {0};
  if (v.type == CAG_UNSET) cag_string_printf(&found, "nothing");
  else cag_describe_value(call->vm, &found, v);
  if (argument == 0 || (size_t)argument >= s->count)
    cag_fail_call(call, argument, CAG_ERR_type, "expects %s, found %s", expected, found.bytes);
  else
    cag_fail_call(call, argument, CAG_ERR_type, "expects %s as `%s`, found %s", expected,
                  s->parameters[argument], found.bytes);
  cag_string_free(&found);
  if (v.type == CAG_NUMBER && strcmp(expected, "an angle") == 0) {
    char n[32];
    cag_number_text(v.as.number, n);
    cag_fail_help(call->vm, "write %sdeg or %srad", n, n);
  } else if (v.type == CAG_ANGLE && strcmp(expected, "a number") == 0) {
    cag_fail_help(call->vm, "in_degrees(a) and in_radians(a) return numbers");
  } else if (strstr(expected, "function")) {
    cag_fail_hidden(call->vm);
  }
  return false;
}

bool(cag_fail_geometry)(CagCall *call, const CagError *err) {
  if (err->status == CAG_E_CALLBACK && call->vm->failed)
    return false; // the function of the script has set its
                  // error
  if (call->vm->stop)
    return cag_keep_going(call->vm); // takes precedence over errors of
                                     // interrupted work
  if (err->status == CAG_E_MEMORY) cag_vm_out_of_memory(call->vm);
  const CagSignature *s = cag_builtin_signature_of(call->builtin);
  int parameter = -1;
  for (size_t i = 0; err->argument[0] && i < s->count; i++)
    if (strcmp(s->parameters[i], err->argument) == 0) parameter = (int)i;
  CagString message = {0};
  cag_string_printf(&message, "%s: %s", s->name, err->message);
  call->vm->starved |= message.failed;
  set_error(call->vm, err->id, argument_of(call, parameter), message.bytes);
  cag_string_free(&message);
  return false;
}

void cag_vm_clear_error(CagVm *vm) {
  cag_diagnostics_clear(&vm->errors);
  vm->failed = false;
}

bool cag_vm_fail_memory(CagVm *vm) {
  char message[128];
  set_error(vm, CAG_ERR_limit_memory, WHOLE_CALL, memory_message(vm, message, sizeof message));
  return false;
}

_Noreturn void cag_vm_out_of_memory(CagVm *vm) {
  cag_vm_fail_memory(vm);
  cag_memory_leave();
}

// --- Errors as values of a script ---

bool cag_vm_at_limit(const CagVm *vm) {
  const CagErrorId id = vm->errors.count ? vm->errors.items[0].id : CAG_ERR_limit_memory;
  return cag_error_is_limit(id) || id == CAG_ERR_interrupted;
}

static CagValue error_record(CagVm *vm, const CagDiagnostic *d) {
  static const char *const names[] = {"message", "code", "reason", "file", "line", "column"};
  const CagErrorInfo *info = cag_error_info(d->id);
  CagPosition at = d->source ? cag_source_position(d->source, d->span.start) : (CagPosition){0, 0};
  CagValue values[] = {
      cag_text_c(vm, d->message),   cag_text_c(vm, info->code),
      cag_text_c(vm, info->reason), cag_text_c(vm, d->source ? d->source->name : ""),
      cag_number((double)at.line),  cag_number((double)at.column)};
  return cag_record_new(vm, names, values, 6);
}

bool cag_vm_attempt(CagCall *call, CagValue f, CagValue handler, CagValue *result) {
  CagVm *vm = call->vm;
  if (cag_call(vm, f, NULL, 0, result)) return true;
  if (cag_vm_at_limit(vm)) return false;
  CagValue err = error_record(vm, &vm->errors.items[0]);
  cag_vm_clear_error(vm);
  return cag_call(vm, handler, &err, 1, result);
}

void cag_vm_trace(CagCall *call, CagValue value, const char *label) {
  CagVm *vm = call->vm;
  CagString s = {0};
  if (vm->frame_count) {
    const CagFrame *f = &vm->frames[vm->frame_count - 1];
    CagPosition at = cag_source_position(f->proto->source, place_of(f, WHOLE_CALL).start);
    cag_string_printf(&s, "%s:%zu:%zu: ", f->proto->source->name, at.line, at.column);
  }
  if (label && *label) cag_string_printf(&s, "%s: ", label);
  cag_print_value(vm, &s, value, true);
  cag_string_add(&s, "\n", 1);
  cag_string_check(vm, &s);
  if (!vm->stop) fwrite(s.bytes, 1, s.length, vm->trace);
  fflush(vm->trace);
  cag_string_free(&s);
}
