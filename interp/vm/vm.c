// Creating and freeing the machine.

#include "interp/vm/vm.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/reserve.h"

// The values of a frame of ordinary size. The stack of values has room for frame_limit such frames.
#define STACK_VALUES_PER_FRAME 64

static const volatile int never = 0;

static size_t stack_values(const CagVm *vm) {
  const size_t n = vm->frame_limit * STACK_VALUES_PER_FRAME;
  const size_t ample = cag_reserve_ample / sizeof *vm->stack;
  return n > ample ? n : ample;
}

static size_t tail_bytes(const CagVm *vm) {
  return vm->frame_limit * CAG_TAIL_KEPT * sizeof(CagTailPlace);
}

// Makes the function value or constant of each built-in name.
static void make_builtins(CagVm *vm) {
  size_t n = cag_builtin_count();
  CagValue *values = cag_calloc(n ? n : 1, sizeof *values);
  if (!values) cag_vm_out_of_memory(vm);
  vm->builtin_values = values;
  for (size_t i = 0; i < n; i++) {
    CagValue constant = cag_builtin_constant(vm, i);
    if (constant.type != CAG_UNSET) {
      values[i] = constant;
      continue;
    }
    CagBuiltinValue *b = cag_alloc(vm, CAG_BUILTIN, sizeof *b);
    b->index = i;
    values[i] = cag_object(CAG_BUILTIN, b);
  }
}

size_t cag_vm_add_global(CagVm *vm, const char *name) {
  if (!CAG_RESERVE(vm->globals, vm->global_capacity, vm->global_count + 1))
    cag_vm_out_of_memory(vm);
  vm->globals[vm->global_count] = (CagGlobal){.name = name};
  return vm->global_count++;
}

static void set_reserved(CagVm *vm, const char *name, double value) {
  size_t g = cag_vm_add_global(vm, name);
  vm->globals[g].value = cag_number(value);
  vm->globals[g].state = CAG_GLOBAL_DONE;
}

static void set_up(CagVm *vm, const CagVmOptions *options) {
  vm->account.limit = options->max_memory;
  cag_heap_init(vm);
  vm->frame_limit = options->max_depth;
  vm->max_time = options->max_time;
  vm->max_triangles = options->max_triangles;
  vm->out = options->out;
  vm->trace = options->trace;
  vm->interrupt = options->interrupt ? options->interrupt : &never;
}

static bool reserve_stacks(CagVm *vm) {
  vm->stack = cag_reserve(stack_values(vm) * sizeof *vm->stack);
  vm->frames = cag_reserve(vm->frame_limit * sizeof *vm->frames);
  vm->tails = cag_reserve(tail_bytes(vm));
  if (!vm->stack || !vm->frames || !vm->tails) return false;
  vm->top = vm->high_water = vm->paid_end = vm->stack;
  vm->stack_end = vm->stack + stack_values(vm);
  return true;
}

static bool start(CagVm *vm, void *context) {
  (void)context;
  make_builtins(vm);
  set_reserved(vm, "time", 0);
  set_reserved(vm, "frame", 0);
  set_reserved(vm, "frames", 1);
  return true;
}

CagVm *cag_vm_new(const CagVmOptions *options, CagDiagnostics *errors) {
  CagVm *vm = cag_builtins_ready() ? calloc(1, sizeof *vm) : NULL;
  bool ready = vm != NULL;
  if (ready) {
    set_up(vm, options);
    CagAccount *before = cag_account_lend(&vm->account);
    ready = reserve_stacks(vm) && cag_vm_protect(vm, start, NULL);
    cag_account_lend(before);
    cag_diagnostics_move(errors, &vm->errors);
  }
  if (ready) return vm;
  if (errors->count == 0)
    cag_diagnostics_add(errors, CAG_ERR_limit_memory, NULL, (CagSpan){0, 0},
                        "there is not enough memory to start");
  cag_vm_free(vm);
  return NULL;
}
void cag_module_free(CagModuleUnit *m) {
  cag_free(m->name);
  cag_free(m->path);
  if (m->ast) cag_module_ast_free(m->ast);
  cag_source_free(m->source);
  cag_free(m->tops);
  cag_free(m->imports);
  cag_free(m->publics);
  cag_free(m->public_names);
  cag_free(m);
}

void cag_vm_free(CagVm *vm) {
  if (!vm) return;
  CagAccount *before = cag_account_lend(&vm->account);
  cag_memo_clear(vm);
  cag_heap_free(vm);
  cag_unreserve(vm->stack, stack_values(vm) * sizeof *vm->stack);
  cag_unreserve(vm->tails, tail_bytes(vm));
  cag_unreserve(vm->frames, vm->frame_limit * sizeof *vm->frames);
  for (CagProto *p = vm->protos, *next; p; p = next) {
    next = p->next;
    cag_proto_free(p);
  }
  cag_diagnostics_clear(&vm->errors);
  for (size_t i = 0; i < vm->module_count; i++) cag_module_free(vm->modules[i]);
  cag_free(vm->modules);
  cag_free(vm->globals);
  cag_free(vm->roots);
  cag_free(vm->kept);
  cag_free(vm->held);
  cag_hash_free(&vm->kept_materials);
  cag_free(vm->interned);
  cag_free(vm->builtin_values);
  cag_free(vm->shown);
  cag_free(vm->outer_names);
  cag_free(vm->outer_globals);
  cag_free(vm->root);
  for (size_t i = 0; i < vm->include_count; i++) cag_free(vm->include[i]);
  cag_free(vm->include);
  for (size_t i = 0; i < vm->read_count; i++) cag_free(vm->reads[i]);
  cag_free(vm->reads);
  cag_hash_free(&vm->reads_by_path);
  cag_account_lend(before);
  free(vm);
}
