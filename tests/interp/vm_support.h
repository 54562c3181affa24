// A machine for tests of values, random numbers, and texts of values and errors.

#ifndef CAG_TESTS_INTERP_VM_SUPPORT_H
#define CAG_TESTS_INTERP_VM_SUPPORT_H

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "interp/vm/vm.h"

static inline CagVm *new_vm(size_t memory) {
  CagDiagnostics errors = {0};
  const CagVmOptions options = {.max_memory = memory, .max_depth = 100};
  CagVm *vm = cag_vm_new(&options, &errors);
  assert_non_null(vm);
  cag_account_lend(&vm->account);
  return vm;
}

static inline int open_vm(void **state) {
  *state = new_vm((size_t)1 << 30);
  return 0;
}

static inline int close_vm(void **state) {
  cag_account_lend(NULL);
  cag_vm_free(*state);
  return 0;
}

static uint32_t seed = 1;
static inline uint32_t chance(uint32_t n) {
  seed = seed * 1664525 + 1013904223;
  return (seed >> 8) % n;
}

static inline void forget_error(CagVm *vm) {
  cag_vm_clear_error(vm);
  assert_false(vm->failed);
}

static inline const char *error_text(const CagVm *vm) {
  assert_true(vm->failed && vm->errors.count == 1);
  return vm->errors.items[0].message;
}

static inline const char *printed(CagVm *vm, CagValue v) {
  static char text[4096];
  CagString s = {0};
  cag_print_value(vm, &s, v, true);
  snprintf(text, sizeof text, "%s", s.bytes);
  cag_string_free(&s);
  return text;
}

static inline CagValue random_vector(CagVm *vm, size_t n) {
  double x[20];
  for (size_t i = 0; i < n; i++) x[i] = chance(100);
  return cag_vector(vm, x, n);
}

static inline CagValue built(CagVm *vm, const CagValue *values, size_t n) {
  CagBuilder *b = cag_builder_new(vm);
  for (size_t i = 0; i < n; i++) assert_true(cag_builder_add(vm, b, values[i]));
  return cag_builder_finish(vm, b);
}

#endif
