// The interpreter loop of the machine.

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/large_stack.h"
#include "base/memory.h"
#include "base/utf8.h"
#include "interp/vm/calls.h"
#include "interp/vm/unpack.h"
#include "interp/vm/vm.h"

// Free space that the C stack must have for a nested run. The deepest built-in needs far less.
#define C_STACK_RESERVE ((size_t)256 * 1024)

bool cag_room_on_c_stack(CagVm *vm) {
  const char here = 0;
  if (vm->stack_low == NULL) return true;
  if (!cag_large_stack_has_room(&here, vm->stack_low, C_STACK_RESERVE)) return false;
  if (&here >= vm->stack_paid) return true;
  const size_t bytes = (size_t)(vm->stack_paid - &here) + CAG_STACK_STEP;
  if (!cag_account_hold(bytes)) return false;
  vm->stack_paid -= bytes;
  return true;
}

bool cag_may_go_deeper(CagVm *vm, const char *done) {
  if (vm->stop) return !vm->failed && cag_keep_going(vm);
  if (cag_room_on_c_stack(vm)) return true;
  if (!vm->failed)
    cag_vm_fail(vm, CAG_ERR_limit_depth, "the values are nested too deeply to be %s", done);
  return false;
}

bool cag_safe_point(CagVm *vm) {
  if (*vm->interrupt) return cag_vm_fail(vm, CAG_ERR_interrupted, "interrupted");
  if (vm->stop)
    return cag_vm_fail(vm, CAG_ERR_limit_time, "exceeded the time limit of %g s (--max-time)",
                       vm->max_time);
  if (vm->heap.debt >= vm->heap.threshold) cag_collect(vm);
  return !vm->stop || cag_keep_going(vm);
}

bool cag_keep_going(CagVm *vm) {
  if (*vm->interrupt) return cag_vm_fail(vm, CAG_ERR_interrupted, "interrupted");
  if (vm->stop)
    return cag_vm_fail(vm, CAG_ERR_limit_time, "exceeded the time limit of %g s (--max-time)",
                       vm->max_time);
  return true;
}

bool cag_stop_answer(CagVm *vm) {
  const CagErrorId id = vm->errors.count ? vm->errors.items[0].id : CAG_ERR_COUNT;
  const bool known = vm->failed && (id == CAG_ERR_limit_time || id == CAG_ERR_interrupted);
  return !known && cag_keep_going(vm);
}

// Tests whether two values are equal (or not equal). Returns false if they are nested too deeply.
static bool equal(CagVm *vm, CagValue a, CagValue b, bool negated, bool *out) {
  *out = cag_equal(vm, a, b) != negated;
  return !vm->failed;
}

static bool fail_depth(CagVm *vm) {
  cag_vm_fail(vm, CAG_ERR_limit_depth, "calls are nested deeper than %zu", vm->frame_limit);
  return cag_fail_help(
      vm,
      "does the recursion end? A call in tail position, `reduce`, or a comprehension uses no stack");
}

static bool fail_condition(CagVm *vm, CagValue v, const char *what) {
  CagString s = {0};
  cag_describe_value(vm, &s, v);
  cag_vm_fail(vm, CAG_ERR_condition, "%s must be true or false, found %s", what, s.bytes);
  cag_string_free(&s);
  if (v.type == CAG_NUMBER) cag_fail_help(vm, "compare it: ... != 0");
  else if (v.type == CAG_LIST || v.type == CAG_TEXT)
    cag_fail_help(vm, "compare its length: len(...) > 0");
  else if (v.type == CAG_NONE) cag_fail_help(vm, "compare it: ... != none");
  return false;
}

// --- Parts of the loop ---

static CagValue make_closure(CagVm *vm, const CagProto *child, const CagFrame *f) {
  CagClosure *c = cag_alloc(vm, CAG_CLOSURE, sizeof *c + child->capture_count * sizeof(CagValue));
  c->proto = child;
  c->capture_count = child->capture_count;
  for (size_t i = 0; i < child->capture_count; i++) {
    struct CagCapture k = child->captures[i];
    if (!k.local) c->captures[i] = f->closure->captures[k.index];
    else if (k.index == CAG_CAPTURE_SELF) c->captures[i] = cag_object(CAG_CLOSURE, f->closure);
    else c->captures[i] = f->base[k.index];
  }
  return cag_object(CAG_CLOSURE, c);
}

// Starts an iterator: it[0] source, it[1] next index, it[2] count. For a range with step 1, the
// source is its start, a number.
static bool iterate(CagVm *vm, CagValue *it, CagValue source) {
  size_t n = 0;
  it[0] = source;
  it[1] = cag_number(0);
  switch (source.type) {
  case CAG_LIST: n = CAG_AS_LIST(source)->length; break;
  case CAG_TEXT: n = CAG_AS_TEXT(source)->length; break;
  case CAG_RECORD: n = CAG_AS_RECORD(source)->layout->count; break;
  case CAG_RANGE: {
    const CagRange *r = CAG_AS_RANGE(source);
    if (!cag_range_count(vm, r, &n)) return false;
    if (!r->angle && r->step == 1) it[0] = cag_number(r->start);
    break;
  }
  default: {
    CagString s = {0};
    cag_describe_value(vm, &s, source);
    cag_vm_fail(vm, CAG_ERR_type, "a comprehension needs a list, range, text, or record, found %s",
                s.bytes);
    cag_string_free(&s);
    if (source.type == CAG_NUMBER) cag_fail_help(vm, "to count, write 0..<n");
    return false;
  }
  }
  it[2] = cag_number((double)n);
  return true;
}

// Returns the next element, except for a range with step 1. Returns false at the end.
static bool next_element(CagVm *vm, CagValue *it) {
  size_t i = (size_t)it[1].as.number, n = (size_t)it[2].as.number;
  if (i >= n) return false;
  it[1].as.number += 1;
  switch (it[0].type) {
  case CAG_LIST: it[3] = cag_list_get(vm, CAG_AS_LIST(it[0]), i); return true;
  case CAG_RANGE: {
    const CagRange *r = CAG_AS_RANGE(it[0]);
    double x = cag_range_element(r, i, n);
    it[3] = r->angle ? cag_angle(x) : cag_number(x);
    return true;
  }
  case CAG_TEXT: { // the index is a byte offset
    const CagText *t = CAG_AS_TEXT(it[0]);
    const size_t end = cag_utf8_next(t->bytes, n, i);
    it[1].as.number = (double)end;
    it[3] = cag_text_new(vm, t->bytes + i, end - i);
    return true;
  }
  default: {
    const CagRecord *r = CAG_AS_RECORD(it[0]);
    it[3] = cag_list_values(
        vm, (CagValue[]){cag_object(CAG_TEXT, r->layout->names[i]), r->fields[i]}, 2);
    return true;
  }
  }
}

static bool extend(CagVm *vm, CagValue builder, CagValue v) {
  CagBuilder *b = (CagBuilder *)builder.as.object;
  if (v.type != CAG_LIST && v.type != CAG_RANGE) {
    CagString s = {0};
    cag_describe_value(vm, &s, v);
    cag_vm_fail(vm, CAG_ERR_type, "`...` spreads a list, found %s", s.bytes);
    cag_string_free(&s);
    return false;
  }
  if (v.type == CAG_RANGE) {
    const CagRange *r = CAG_AS_RANGE(v);
    size_t n;
    if (!cag_range_count(vm, r, &n)) return false;
    for (size_t i = 0; i < n; i++) {
      double x = cag_range_element(r, i, n);
      if (!cag_builder_add(vm, b, r->angle ? cag_angle(x) : cag_number(x))) return false;
    }
    return true;
  }
  const CagList *l = CAG_AS_LIST(v);
  for (size_t i = 0; i < l->length; i++)
    if (!cag_builder_add(vm, b, cag_list_get(vm, l, i))) return false;
  return true;
}

static CagValue record_set(CagVm *vm, const CagRecord *r, CagText *name, CagValue v) {
  size_t n = r->layout->count, at = cag_layout_find(r->layout, name);
  if (at != (size_t)-1) {
    CagValue copy = cag_record_with_layout(vm, r->layout, r->fields);
    CAG_AS_RECORD(copy)->fields[at] = v;
    return copy;
  }
  CagCleanup first, second;
  CagText **names = cag_temporary(&first, n + 1, sizeof *names);
  CagValue *values = cag_temporary(&second, n + 1, sizeof *values);
  memcpy(names, r->layout->names, n * sizeof *names);
  memcpy(values, r->fields, n * sizeof *values);
  names[n] = name;
  values[n] = v;
  CagValue out = cag_record_with_layout(vm, cag_layout_new(vm, names, n + 1), values);
  cag_cleanup_run(&second);
  cag_cleanup_run(&first);
  return out;
}

static bool record_spread(CagVm *vm, CagValue *target, CagValue v) {
  if (v.type != CAG_RECORD) {
    CagString s = {0};
    cag_describe_value(vm, &s, v);
    cag_vm_fail(vm, CAG_ERR_type, "`...` in a record spreads a record, found %s", s.bytes);
    cag_string_free(&s);
    return false;
  }
  const CagRecord *r = CAG_AS_RECORD(v);
  if (CAG_AS_RECORD(*target)->layout->count == 0) {
    *target = v;
    return true;
  }
  for (size_t i = 0; i < r->layout->count; i++)
    *target = record_set(vm, CAG_AS_RECORD(*target), r->layout->names[i], r->fields[i]);
  return true;
}

static CagValue join_template(CagVm *vm, const CagValue *parts, size_t n) {
  CagString s = {0};
  for (size_t i = 0; i < n; i++) cag_print_value(vm, &s, parts[i], false);
  return cag_text_from_string(vm, &s);
}

static bool fail_assert(CagVm *vm, CagValue message, const CagValue *parts, size_t n) {
  CagString s = {0};
  cag_string_add(&s, "assertion failed", 16);
  if (message.type != CAG_NONE) {
    cag_string_add(&s, ": ", 2);
    cag_print_value(vm, &s, message, false);
  }
  cag_vm_fail(vm, CAG_ERR_assertion, "%s", s.bytes);
  s.length = 0;
  for (size_t i = 0; i < n; i++) {
    if (i) cag_string_add(&s, ", ", 2);
    cag_print_value(vm, &s, parts[2 * i], false);
    cag_string_add(&s, " is ", 4);
    size_t before = s.length;
    s.most = before + 200;
    cag_print_value(vm, &s, parts[2 * i + 1], true);
    if (s.length - before > 200) { // more of a long list would not help
      s.length = cag_utf8_start(s.bytes, before + 200);
      cag_string_add(&s, " ...", 4);
    }
  }
  if (n) cag_fail_help(vm, "%s", s.bytes);
  cag_string_free(&s);
  return false;
}

static bool keep_tail_place(CagVm *vm, CagFrame *f) {
  CagTailPlace *ring = vm->tails + (size_t)(f - vm->frames) * CAG_TAIL_KEPT;
  ring[f->tail_count++ % CAG_TAIL_KEPT] =
      (CagTailPlace){f->proto, (uint32_t)(f->pc - f->proto->code - 1)};
  return true;
}

void cag_pay_for_values(CagVm *vm, const CagValue *end) {
  const size_t bytes = (size_t)((const char *)end - (const char *)vm->paid_end) + CAG_STACK_STEP;
  if (!cag_account_hold(bytes)) cag_vm_out_of_memory(vm);
  vm->paid_end += bytes / sizeof *end;
}

// Makes room for a frame of `registers` registers at base.
static inline bool reserve(CagVm *vm, CagValue *base, size_t registers) {
  CagValue *end = base + registers;
  if (end > vm->high_water) {
    if (end + CAG_MAX_REGISTERS / 64 > vm->stack_end) return fail_depth(vm);
    if (end > vm->paid_end) cag_pay_for_values(vm, end);
    vm->high_water = end;
  }
  return true;
}

// --- The loop ---

#if defined(__GNUC__)
#define COMPUTED_GOTO 1
#else
#define COMPUTED_GOTO 0
#endif

#if COMPUTED_GOTO
#define CASE(name) op_##name:
#define NEXT_INSTRUCTION                                                                           \
  do {                                                                                             \
    i = *pc++;                                                                                     \
    goto *labels[i.op];                                                                            \
  } while (0)
#else
#define CASE(name) case CAG_CODE_##name:
#define NEXT_INSTRUCTION goto next
#endif

#define R(n) base[n]
#define K(n) constants[n]
#define SAVE() (f->pc = pc)
#define TRY(call)                                                                                  \
  do {                                                                                             \
    SAVE();                                                                                        \
    if (!(call)) goto failed;                                                                      \
  } while (0)
#define LOAD_FRAME()                                                                               \
  do {                                                                                             \
    f = &vm->frames[vm->frame_count - 1];                                                          \
    pc = f->pc;                                                                                    \
    base = f->base;                                                                                \
    constants = f->proto->constants;                                                               \
  } while (0)
// Checks whether a collection or a stop is due.
#define SAFE_POINT()                                                                               \
  do {                                                                                             \
    if (vm->heap.debt >= vm->heap.threshold || *vm->interrupt || vm->stop) {                       \
      SAVE();                                                                                      \
      vm->top = base + f->proto->registers;                                                        \
      if (!cag_safe_point(vm)) goto failed;                                                        \
    }                                                                                              \
  } while (0)
#define NUMBERS(x, y) ((x).type == CAG_NUMBER && (y).type == CAG_NUMBER)
#define FINITE(x) (fabs(x) <= DBL_MAX)
// `second` is the register or the constant of the second operand. `numbers` is true if *x and *y
// are both numbers.
#define ARITHMETIC_OF(op, second, numbers, expression)                                             \
  do {                                                                                             \
    CagValue *x = &R(i.b), *y = &second;                                                           \
    if (numbers) {                                                                                 \
      double r = (expression);                                                                     \
      if (FINITE(r)) {                                                                             \
        R(i.a) = cag_number(r);                                                                    \
        NEXT_INSTRUCTION;                                                                          \
      }                                                                                            \
    }                                                                                              \
    TRY(cag_arithmetic(vm, op, *x, *y, &R(i.a)));                                                  \
    NEXT_INSTRUCTION;                                                                              \
  } while (0)
#define ARITHMETIC(op, expression) ARITHMETIC_OF(op, R(i.c), NUMBERS(*x, *y), expression)
#define ARITHMETIC_K(op, expression) ARITHMETIC_OF(op, K(i.c), x->type == CAG_NUMBER, expression)
// Skips the following jump if the comparison holds, or else takes it.
#define BRANCH(holds)                                                                              \
  do {                                                                                             \
    if (holds) pc++;                                                                               \
    else pc += 1 + pc->x;                                                                          \
    NEXT_INSTRUCTION;                                                                              \
  } while (0)

// Runs until frame number `entry` has returned. In any case, `entry` and the frames above it are
// gone afterwards.
static bool loop(CagVm *vm, size_t entry, CagValue *result) {
  CagFrame *f;
  const CagInstruction *pc;
  CagValue *base, *constants;
  CagInstruction i;
  LOAD_FRAME();
#if COMPUTED_GOTO
  static const void *const labels[] = {
#define CAG_OPCODE(name, story) &&op_##name,
#include "interp/vm/opcodes.def"
#undef CAG_OPCODE
  };
  NEXT_INSTRUCTION;
#else
next:
  i = *pc++;
  switch (i.op) {
#endif

  CASE(CONSTANT) {
    R(i.a) = K(i.x);
    NEXT_INSTRUCTION;
  }
  CASE(NONE) {
    R(i.a) = cag_none();
    NEXT_INSTRUCTION;
  }
  CASE(BOOL) {
    R(i.a) = cag_bool(i.x != 0);
    NEXT_INSTRUCTION;
  }
  CASE(MOVE) {
    R(i.a) = R(i.b);
    NEXT_INSTRUCTION;
  }
  CASE(GLOBAL) {
    const CagGlobal *g = &vm->globals[i.x];
    if (g->state == CAG_GLOBAL_DONE) {
      R(i.a) = g->value;
      NEXT_INSTRUCTION;
    }
    CagValue v;
    SAVE();
    vm->top = base + f->proto->registers;
    if (!cag_vm_force(vm, (size_t)i.x, &v)) goto failed;
    R(i.a) = v;
    NEXT_INSTRUCTION;
  }
  CASE(CAPTURE) {
    R(i.a) = f->closure->captures[i.b];
    NEXT_INSTRUCTION;
  }
  CASE(SELF) {
    R(i.a) = cag_object(CAG_CLOSURE, f->closure);
    NEXT_INSTRUCTION;
  }
  CASE(CLOSURE) {
    SAVE();
    R(i.a) = make_closure(vm, f->proto->children[i.x], f);
    NEXT_INSTRUCTION;
  }
  CASE(ADD) { ARITHMETIC(CAG_OP_ADD, x->as.number + y->as.number); }
  CASE(SUBTRACT) { ARITHMETIC(CAG_OP_SUBTRACT, x->as.number - y->as.number); }
  CASE(MULTIPLY) { ARITHMETIC(CAG_OP_MULTIPLY, x->as.number * y->as.number); }
  CASE(DIVIDE) { ARITHMETIC(CAG_OP_DIVIDE, x->as.number / y->as.number); }
  CASE(ADD_K) { ARITHMETIC_K(CAG_OP_ADD, x->as.number + y->as.number); }
  CASE(SUBTRACT_K) { ARITHMETIC_K(CAG_OP_SUBTRACT, x->as.number - y->as.number); }
  CASE(MULTIPLY_K) { ARITHMETIC_K(CAG_OP_MULTIPLY, x->as.number * y->as.number); }
  CASE(DIVIDE_K) { ARITHMETIC_K(CAG_OP_DIVIDE, x->as.number / y->as.number); }
  CASE(BINARY) {
    SAVE();
    vm->top = base + f->proto->registers; // an operator on solids may call a built-in
    if (!cag_arithmetic(vm, (CagBinaryOp)i.c, R(i.a), R(i.b), &R(i.a))) goto failed;
    NEXT_INSTRUCTION;
  }
  CASE(COMPARE) {
    bool b;
    if (i.c == CAG_OP_EQUAL || i.c == CAG_OP_NOT_EQUAL)
      TRY(equal(vm, R(i.a), R(i.b), i.c == CAG_OP_NOT_EQUAL, &b));
    else if (i.c == CAG_OP_IN) TRY(cag_contains(vm, R(i.a), R(i.b), &b));
    else TRY(cag_compare(vm, (CagBinaryOp)i.c, R(i.a), R(i.b), &b));
    R(i.a) = cag_bool(b);
    NEXT_INSTRUCTION;
  }
  CASE(NEGATE) {
    if (R(i.b).type == CAG_NUMBER) R(i.a) = cag_number(-R(i.b).as.number);
    else TRY(cag_negate(vm, R(i.b), &R(i.a)));
    NEXT_INSTRUCTION;
  }
  CASE(NOT) {
    if (R(i.b).type != CAG_BOOL) {
      SAVE();
      fail_condition(vm, R(i.b), "the operand of `not`");
      goto failed;
    }
    R(i.a) = cag_bool(!R(i.b).as.boolean);
    NEXT_INSTRUCTION;
  }
  CASE(JUMP) {
    pc += i.x;
    NEXT_INSTRUCTION;
  }
  CASE(JUMP_IF_FALSE) {
    if (R(i.a).type != CAG_BOOL) {
      SAVE();
      fail_condition(vm, R(i.a), "a condition");
      goto failed;
    }
    if (!R(i.a).as.boolean) pc += i.x;
    NEXT_INSTRUCTION;
  }
  CASE(JUMP_IF_TRUE) {
    if (R(i.a).type != CAG_BOOL) {
      SAVE();
      fail_condition(vm, R(i.a), "a condition");
      goto failed;
    }
    if (R(i.a).as.boolean) pc += i.x;
    NEXT_INSTRUCTION;
  }
  CASE(JUMP_IF_SET) {
    if (R(i.a).type != CAG_UNSET) pc += i.x;
    NEXT_INSTRUCTION;
  }
  CASE(JUMP_NOT_LESS) {
    if (NUMBERS(R(i.a), R(i.b))) BRANCH(R(i.a).as.number < R(i.b).as.number);
    {
      bool b;
      TRY(i.c ? cag_compare(vm, CAG_OP_GREATER, R(i.b), R(i.a), &b)
              : cag_compare(vm, CAG_OP_LESS, R(i.a), R(i.b), &b));
      BRANCH(b);
    }
  }
  CASE(JUMP_NOT_LESS_EQUAL) {
    if (NUMBERS(R(i.a), R(i.b))) BRANCH(R(i.a).as.number <= R(i.b).as.number);
    {
      bool b;
      TRY(i.c ? cag_compare(vm, CAG_OP_GREATER_EQUAL, R(i.b), R(i.a), &b)
              : cag_compare(vm, CAG_OP_LESS_EQUAL, R(i.a), R(i.b), &b));
      BRANCH(b);
    }
  }
  CASE(JUMP_NOT_EQUAL) {
    if (NUMBERS(R(i.a), R(i.b))) BRANCH(R(i.a).as.number == R(i.b).as.number);
    bool b;
    TRY(equal(vm, R(i.a), R(i.b), false, &b));
    BRANCH(b);
  }
  CASE(JUMP_EQUAL) {
    if (NUMBERS(R(i.a), R(i.b))) BRANCH(R(i.a).as.number != R(i.b).as.number);
    bool b;
    TRY(equal(vm, R(i.a), R(i.b), true, &b));
    BRANCH(b);
  }
  CASE(CHECK_BOOL) {
    if (R(i.a).type != CAG_BOOL) {
      SAVE();
      fail_condition(vm, R(i.a),
                     i.b == CAG_EXPR_AND ? "the right side of `and`" : "the right side of `or`");
      goto failed;
    }
    NEXT_INSTRUCTION;
  }
  CASE(CALL) {
    CagValue *callee = &R(i.a);
    SAVE();
    if (callee->type != CAG_CLOSURE) {
      vm->top = base + f->proto->registers;
      if (!cag_call_native(vm, *callee, callee + 1, i.b, NULL, 0, true, callee)) goto failed;
      NEXT_INSTRUCTION;
    }
    CagClosure *closure = (CagClosure *)callee->as.object;
    const CagProto *p = closure->proto;
    if (!reserve(vm, callee + 1, p->registers)) goto failed;
    const CagInstruction *start = p->code + p->body;
    if (i.b != p->parameter_count) {
      if (!cag_bind_closure(vm, p, callee + 1, i.b, NULL, 0)) goto failed;
      start = p->code;
    }
    if (vm->frame_count == vm->frame_limit) {
      fail_depth(vm);
      goto failed;
    }
    f = &vm->frames[vm->frame_count++];
    f->proto = p;
    f->closure = closure;
    f->pc = pc = start;
    f->base = base = callee + 1;
    f->tail_count = 0;
    constants = p->constants;
    SAFE_POINT();
    NEXT_INSTRUCTION;
  }
  CASE(CALL_NAMED) {
    CagValue *callee = &R(i.a);
    SAVE();
    const char *const *names = (const char *const *)f->proto->names[i.c];
    size_t named = f->proto->name_counts[i.c];
    if (callee->type != CAG_CLOSURE) {
      vm->top = base + f->proto->registers;
      if (!cag_call_native(vm, *callee, callee + 1, i.b, names, named, true, callee)) goto failed;
      NEXT_INSTRUCTION;
    }
    CagClosure *closure = (CagClosure *)callee->as.object;
    const CagProto *p = closure->proto;
    if (!reserve(vm, callee + 1, p->registers + i.b)) goto failed;
    if (!cag_bind_closure(vm, p, callee + 1, i.b, names, named)) goto failed;
    if (vm->frame_count == vm->frame_limit) {
      fail_depth(vm);
      goto failed;
    }
    f = &vm->frames[vm->frame_count++];
    *f = (CagFrame){.proto = p, .closure = closure, .pc = p->code, .base = callee + 1};
    LOAD_FRAME();
    SAFE_POINT();
    NEXT_INSTRUCTION;
  }
  CASE(TAIL_CALL)
  CASE(TAIL_CALL_NAMED) {
    CagValue *callee = &R(i.a);
    SAVE();
    const char *const *names = NULL;
    size_t named = 0, count = i.b;
    if (i.op == CAG_CODE_TAIL_CALL_NAMED) {
      names = (const char *const *)f->proto->names[i.c];
      named = f->proto->name_counts[i.c];
    }
    if (callee->type != CAG_CLOSURE) {
      vm->top = base + f->proto->registers;
      if (!cag_call_native(vm, *callee, callee + 1, count, names, named, true, callee)) goto failed;
      goto return_value;
    }
    CagClosure *closure = (CagClosure *)callee->as.object;
    const CagProto *p = closure->proto;
    if (!reserve(vm, callee + 1, p->registers + count)) goto failed;
    const CagInstruction *start = p->code + p->body;
    if (named || count != p->parameter_count) {
      if (!cag_bind_closure(vm, p, callee + 1, count, names, named)) goto failed;
      start = p->code;
    }
    keep_tail_place(vm, f);
    memmove(base, callee + 1, p->parameter_count * sizeof *base);
    f->proto = p;
    f->closure = closure;
    f->pc = pc = start;
    constants = p->constants;
    SAFE_POINT();
    NEXT_INSTRUCTION;
  }
  CASE(RETURN) {
  return_value:;

    CagValue v = R(i.a);
    vm->frame_count--;
    if (vm->frame_count == entry) {
      *result = v;
      return true;
    }
    LOAD_FRAME();
    R(pc[-1].a) = v;
    NEXT_INSTRUCTION;
  }
  CASE(LIST) {
    SAVE();
    R(i.a) = cag_list_values(vm, &R(i.b), i.c);
    NEXT_INSTRUCTION;
  }
  CASE(BUILDER) {
    SAVE();
    R(i.a) = cag_builder_value(cag_builder_new(vm));
    NEXT_INSTRUCTION;
  }
  CASE(PUSH) {
    CagBuilder *b = (CagBuilder *)R(i.a).as.object;
    if (R(i.b).type == CAG_NUMBER && b->dim == 1 && b->length < b->capacity) {
      ((double *)b->data)[b->length++] = R(i.b).as.number;
      NEXT_INSTRUCTION;
    }
    TRY(cag_builder_add(vm, b, R(i.b)));
    NEXT_INSTRUCTION;
  }
  CASE(EXTEND) {
    TRY(extend(vm, R(i.a), R(i.b)));
    NEXT_INSTRUCTION;
  }
  CASE(FINISH) {
    SAVE();
    R(i.a) = cag_builder_finish(vm, (CagBuilder *)R(i.b).as.object);
    NEXT_INSTRUCTION;
  }
  CASE(RECORD) {
    SAVE();
    R(i.a) = cag_record_with_layout(vm, (CagLayout *)K(i.c).as.object, &R(i.b));
    NEXT_INSTRUCTION;
  }
  CASE(RECORD_SET) {
    SAVE();
    R(i.a) = record_set(vm, CAG_AS_RECORD(R(i.a)), CAG_AS_TEXT(K(i.c)), R(i.b));
    NEXT_INSTRUCTION;
  }
  CASE(RECORD_SPREAD) {
    TRY(record_spread(vm, &R(i.a), R(i.b)));
    NEXT_INSTRUCTION;
  }
  CASE(RANGE) {
    TRY(cag_make_range(vm, R(i.b), R(i.b + 1), i.c & 2 ? R(i.b + 2) : cag_unset(), i.c & 1,
                       &R(i.a)));
    NEXT_INSTRUCTION;
  }
  CASE(INDEX) {
    CagValue *o = &R(i.b), *k = &R(i.c);
    if (o->type == CAG_LIST && k->type == CAG_NUMBER) {
      const CagList *l = (const CagList *)o->as.object;
      double x = k->as.number;
      if (x >= 0 && x < (double)l->length && x == (double)(size_t)x && l->dim <= 1) {
        R(i.a) = l->dim ? cag_number(l->as.numbers[(size_t)x]) : l->as.items[(size_t)x];
        NEXT_INSTRUCTION;
      }
    }
    TRY(cag_index(vm, *o, *k, &R(i.a)));
    NEXT_INSTRUCTION;
  }
  CASE(MEMBER) {
    CagValue *o = &R(i.b);
    if (o->type == CAG_RECORD) {
      const CagRecord *r = (const CagRecord *)o->as.object;
      size_t k = cag_layout_find(r->layout, (const CagText *)K(i.c).as.object);
      if (k != (size_t)-1) {
        R(i.a) = r->fields[k];
        NEXT_INSTRUCTION;
      }
    }
    SAVE();
    vm->top = base + f->proto->registers; // a member of a module may be evaluated here
    if (!cag_member(vm, *o, K(i.c), &R(i.a))) goto failed;
    NEXT_INSTRUCTION;
  }
  CASE(TEMPLATE) {
    SAVE();
    R(i.a) = join_template(vm, &R(i.b), i.c);
    if (vm->failed) goto failed;
    NEXT_INSTRUCTION;
  }
  CASE(ITERATE) {
    TRY(iterate(vm, &R(i.a), R(i.b)));
    NEXT_INSTRUCTION;
  }
  CASE(NEXT) {
    CagValue *it = &R(i.a);
    if (it->type == CAG_NUMBER) { // a range with step 1
      double k = it[1].as.number;
      if (k >= it[2].as.number) {
        pc += i.x;
        NEXT_INSTRUCTION;
      }
      it[1].as.number = k + 1;
      it[3] = cag_number(it[0].as.number + k);
      NEXT_INSTRUCTION;
    }
    SAVE();
    if (!next_element(vm, it)) pc += i.x;
    NEXT_INSTRUCTION;
  }
  CASE(LOOP) {
    SAFE_POINT();
    pc += i.x;
    NEXT_INSTRUCTION;
  }
  CASE(UNPACK) {
    CagValue v = R(i.b);
    const CagList *l = v.type == CAG_LIST ? (const CagList *)v.as.object : NULL;
    if (l && l->dim <= 1 && l->length == i.c) {
      for (size_t k = 0; k < i.c; k++)
        R(i.a + k) = l->dim ? cag_number(l->as.numbers[k]) : l->as.items[k];
      NEXT_INSTRUCTION;
    }
    TRY(cag_unpack(vm, v, i.c, false, &R(i.a)));
    NEXT_INSTRUCTION;
  }
  CASE(UNPACK_REST) {
    TRY(cag_unpack(vm, R(i.b), i.c, true, &R(i.a)));
    NEXT_INSTRUCTION;
  }
  CASE(FIELD) {
    TRY(cag_unpack_field(vm, R(i.b), CAG_AS_TEXT(K(i.c)), &R(i.a)));
    NEXT_INSTRUCTION;
  }
  CASE(ASSERT_FAIL) {
    SAVE();
    fail_assert(vm, R(i.a), &R(i.a + 1), i.b);
    goto failed;
  }
#if !COMPUTED_GOTO
}
#endif

failed : vm->frame_count = entry;
return false;
}

// --- Entry points ---

static bool enter(CagVm *vm, const CagProto *p, CagClosure *closure, const CagInstruction *start,
                  CagValue *base, CagValue *result) {
  if (vm->frame_count == vm->frame_limit || !cag_room_on_c_stack(vm)) return fail_depth(vm);
  if (!reserve(vm, base, p->registers)) return false;
  CagValue *top = vm->top;
  CagNative *native = vm->native;
  size_t entry = vm->frame_count++, roots = vm->root_count;
  vm->frames[entry] = (CagFrame){.proto = p, .closure = closure, .pc = start, .base = base};
  vm->top = base + p->registers;
  bool ok = cag_safe_point(vm);
  if (ok) ok = loop(vm, entry, result);
  else vm->frame_count = entry;
  vm->top = top;
  vm->native = native;
  if (!ok) vm->root_count = roots;
  return ok;
}

bool cag_vm_run(CagVm *vm, const CagProto *proto, CagValue *result) {
  return enter(vm, proto, NULL, proto->code + proto->body, vm->top + 1, result);
}

bool cag_call(CagVm *vm, CagValue function, const CagValue *arguments, size_t n, CagValue *result) {
  CagValue *base = vm->top + 1;
  if (function.type != CAG_CLOSURE) {
    if (!reserve(vm, base, n + 1)) return false;
    if (n) memcpy(base, arguments, n * sizeof *base); // may be NULL if there are no arguments
    CagValue *top = vm->top;
    vm->top = base + n;
    bool ok = cag_room_on_c_stack(vm)
                  ? cag_call_native(vm, function, base, n, NULL, 0, false, result)
                  : fail_depth(vm);
    vm->top = top;
    return ok;
  }
  CagClosure *closure = CAG_AS_CLOSURE(function);
  const CagProto *p = closure->proto;
  if (!reserve(vm, base, (n > p->registers ? n : p->registers) + 1)) return false;
  base[-1] = function;
  if (n) memcpy(base, arguments, n * sizeof *base); // may be NULL if there are no arguments
  const CagInstruction *start = p->code + p->body;
  if (n != p->parameter_count) {
    if (!cag_bind_closure(vm, p, base, n, NULL, 0)) return false;
    start = p->code;
  }
  return enter(vm, p, closure, start, base, result);
}

// Reports the circular definition of `global`: the running definitions, starting from it.
static bool fail_circle(CagVm *vm, size_t global) {
  CagString s = {0};
  bool within = false;
  for (size_t k = 0; k < vm->frame_count; k++) {
    const CagProto *p = vm->frames[k].proto;
    if (p->is_function || !p->name) continue;
    if (!within && strcmp(p->name, vm->globals[global].name) != 0) continue;
    within = true;
    cag_string_printf(&s, "%s -> ", p->name);
  }
  cag_string_add(&s, vm->globals[global].name, strlen(vm->globals[global].name));
  cag_vm_fail(vm, CAG_ERR_circle, "the value of `%s` depends on itself: %s",
              vm->globals[global].name, s.bytes);
  cag_string_free(&s);
  return false;
}

// Shapes, and those in a list of them, remember the definition whose value they first were.
static void note_definition(CagVm *vm, const char *name, CagValue v) {
  if (cag_is_shape(v)) {
    CagShape *s = CAG_AS_SHAPE(v);
    if (!s->origin.definition) s->origin.definition = cag_intern(vm, name, strlen(name));
  } else if (v.type == CAG_LIST && CAG_AS_LIST(v)->dim == 0) {
    const CagList *list = CAG_AS_LIST(v);
    for (size_t i = 0; i < list->length && cag_is_shape(list->as.items[i]); i++)
      note_definition(vm, name, list->as.items[i]);
  }
}

static CagProto *compile_global(CagVm *vm, const CagGlobal *g) {
  return g->pattern ? cag_compile_definition(vm, g->unit, g->expr, g->pattern, g->name)
                    : cag_compile_expression(vm, g->unit, g->expr, g->name);
}

// Gives the names of a pattern their values, except names that a later input of the REPL defines.
static void set_names(CagVm *vm, size_t whole, CagValue parts) {
  const CagGlobal *w = &vm->globals[whole];
  for (size_t i = 0; i < w->pattern->name_count; i++) {
    CagGlobal *g = &vm->globals[w->unit->tops[w->pattern->names[i]->index]];
    if (g->whole != whole) continue;
    g->value = cag_list_get(vm, CAG_AS_LIST(parts), i);
    g->state = CAG_GLOBAL_DONE;
    note_definition(vm, g->name, g->value);
  }
}

// Evaluates the definition that a name of a pattern belongs to.
static bool force_whole(CagVm *vm, size_t global, CagValue *result) {
  const size_t whole = vm->globals[global].whole;
  CagValue parts;
  // Some of its names may have been forgotten.
  if (vm->globals[whole].state == CAG_GLOBAL_DONE) vm->globals[whole].state = CAG_GLOBAL_NEW;
  if (!cag_vm_force(vm, whole, &parts)) return false;
  *result = vm->globals[global].value;
  return true;
}

bool cag_vm_force(CagVm *vm, size_t global, CagValue *result) {
  CagGlobal *g = &vm->globals[global];
  if (g->state == CAG_GLOBAL_DONE) {
    *result = g->value;
    return true;
  }
  if (g->whole) return force_whole(vm, global, result);
  if (g->state == CAG_GLOBAL_RUNNING) return fail_circle(vm, global);
  const CagProto *p = compile_global(vm, g);
  if (!p) {
    vm->failed = true;
    return false;
  }
  g->state = CAG_GLOBAL_RUNNING;
  bool ok = cag_vm_run(vm, p, result);
  g = &vm->globals[global];
  g->state = ok ? CAG_GLOBAL_DONE : CAG_GLOBAL_NEW;
  if (!ok) return false;
  if (g->pattern) {
    set_names(vm, global, *result);
    return true;
  }
  g->value = *result;
  note_definition(vm, g->name, *result);
  return true;
}

typedef struct Work {
  CagVm *vm;
  bool (*work)(CagVm *vm, void *context);
  void *context;
  bool ok;
} Work;

static void do_work(void *context) {
  Work *w = context;
  w->ok = w->work(w->vm, w->context);
}

bool cag_vm_protect(CagVm *vm, bool (*work)(CagVm *vm, void *context), void *context) {
  const size_t frames = vm->frame_count, roots = vm->root_count, held = vm->held_count;
  CagValue *const top = vm->top;
  CagNative *const native = vm->native;
  Work w = {vm, work, context, false};
  const bool done = cag_memory_guard(do_work, &w);
  vm->starved |= cag_memory_was_out();
  const bool told = vm->failed && vm->errors.items[0].id == CAG_ERR_limit_memory;
  if (!told && (vm->starved || (!done && !vm->failed))) cag_vm_fail_memory(vm);
  if (!done) {
    vm->frame_count = frames;
    vm->root_count = roots;
    vm->top = top;
    vm->native = native;
    cag_vm_release_held(vm, held);
    for (size_t i = 0; i < vm->global_count; i++)
      if (vm->globals[i].state == CAG_GLOBAL_RUNNING) vm->globals[i].state = CAG_GLOBAL_NEW;
    for (size_t i = 0; i < vm->module_count; i++)
      if (vm->modules[i]->state == CAG_MODULE_LOADING) vm->modules[i]->state = CAG_MODULE_LOST;
    cag_collect(vm);
  }
  const bool ok = done && w.ok && !vm->starved;
  vm->starved = false;
  return ok;
}
