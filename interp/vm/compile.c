// Compiles the syntax tree to register code.
//
// A function's parameters are its first registers. Names of blocks and comprehensions get registers
// as they occur, with temporaries above them, as on a stack: `next` is the first free register.
// compile_any returns the register that already holds a value (names never change, so nothing is
// copied), and compile_to puts the value where the caller wants it. Conditions become jumps
// (jump_when). Trees with errors are not compiled, so ERROR expressions do not occur.

#include <string.h>

#include "base/arena.h"
#include "base/array.h"
#include "base/memory.h"
#include "interp/vm/vm.h"

// Longer lists are built one element at a time instead of in consecutive registers.
#define LIST_IN_REGISTERS 32

typedef struct Unit {
  CagVm *vm;
  CagModuleUnit *module;
  CagProto *proto;
  struct Unit *outer;
  const CagFunctionAst *function; // NULL: initializer of a definition, or a statement
  CagArena *scratch;              // temporary memory, shared by nested functions
  const CagDecl **captured;       // decl of each capture
  size_t captured_capacity;
  uint32_t next;
  uint32_t result; // where the next name of a pattern at the top level is put
  bool failed;
} Unit;

typedef struct Patches {
  size_t *at;
  size_t count, capacity;
} Patches;

static void compile_to(Unit *u, const CagExpr *e, uint32_t target);
static uint32_t compile_any(Unit *u, const CagExpr *e);
static void compile_tail(Unit *u, const CagExpr *e);
static CagProto *compile_function(Unit *outer, CagModuleUnit *m, CagVm *vm,
                                  const CagFunctionAst *f);

// --- Growing arrays ---

static void *grown(CagVm *vm, void *p, size_t count, size_t *capacity, size_t size) {
  if (!cag_array_reserve(&p, capacity, count + 1, size)) cag_vm_out_of_memory(vm);
  return p;
}

static void too_large(Unit *u, CagSpan span) {
  if (!u->failed)
    cag_diagnostics_add(&u->vm->errors, CAG_ERR_too_large, u->proto->source, span,
                        "this expression is too large: move parts of it to other definitions");
  u->failed = true;
}

static size_t emit(Unit *u, CagSpan span, CagOpcode op, uint32_t a, uint32_t b, uint32_t c) {
  CagProto *p = u->proto;
  if (p->code_count == p->code_capacity) {
    size_t capacity = p->code_capacity;
    p->code = grown(u->vm, p->code, p->code_count, &capacity, sizeof *p->code);
    p->spans = grown(u->vm, p->spans, p->code_count, &p->code_capacity, sizeof *p->spans);
  }
  if (a > 0xffff || b > 0xffff || c > 0xffff) too_large(u, span);
  p->code[p->code_count] =
      (CagInstruction){.op = (uint16_t)op, .a = (uint16_t)a, .b = (uint16_t)b, .c = (uint16_t)c};
  p->spans[p->code_count] = span;
  return p->code_count++;
}

static size_t emit_wide(Unit *u, CagSpan span, CagOpcode op, uint32_t a, int32_t x) {
  size_t at = emit(u, span, op, a, 0, 0);
  u->proto->code[at].x = x;
  return at;
}

static uint32_t take_registers(Unit *u, uint32_t n) {
  uint32_t first = u->next;
  u->next += n;
  if (u->next > CAG_MAX_REGISTERS) {
    too_large(u, (CagSpan){0, 0});
    u->next = first;
    return 0;
  }
  if (u->next > u->proto->registers) u->proto->registers = u->next;
  return first;
}

static int32_t add_constant(Unit *u, CagValue v) {
  CagProto *p = u->proto;
  size_t from = p->constant_count > 32 ? p->constant_count - 32 : 0;
  for (size_t i = from; i < p->constant_count; i++) {
    CagValue k = p->constants[i];
    if (k.type == v.type &&
        (v.type >= CAG_FIRST_OBJECT ? k.as.object == v.as.object
                                    : k.as.number == v.as.number && v.type != CAG_BOOL))
      return (int32_t)i;
  }
  p->constants =
      grown(u->vm, p->constants, p->constant_count, &p->constant_capacity, sizeof *p->constants);
  p->constants[p->constant_count] = v;
  return (int32_t)p->constant_count++;
}

// Grows an array in the scratch memory to make room for one more item.
static void *grown_scratch(Unit *u, void *p, size_t count, size_t *capacity, size_t size) {
  if (count < *capacity) return p;
  *capacity = *capacity ? *capacity * 2 : 16;
  void *more = cag_arena_alloc(u->scratch, *capacity * size);
  if (count) memcpy(more, p, count * size);
  return more;
}

static void add_patch(Unit *u, Patches *list, size_t at) {
  list->at = grown_scratch(u, list->at, list->count, &list->capacity, sizeof *list->at);
  list->at[list->count++] = at;
}

static void patch_to(Unit *u, size_t at, size_t target) {
  u->proto->code[at].x = (int32_t)((long)target - (long)at - 1);
}

// Makes the jumps of the list lead to `target`, and frees the list.
static void patch_all(Unit *u, Patches *list, size_t target) {
  for (size_t i = 0; i < list->count; i++) patch_to(u, list->at[i], target);
  *list = (Patches){0};
}

static size_t here(const Unit *u) { return u->proto->code_count; }

// --- Constants ---

// Evaluates an expression that is always constant: literals, signed numbers, lists of these, and
// built-in constants.
static bool constant_value(Unit *u, const CagExpr *e, CagValue *out) {
  switch (e->kind) {
  case CAG_EXPR_NUMBER: *out = cag_number(e->as.number); return true;
  case CAG_EXPR_ANGLE: *out = cag_angle(e->as.number); return true;
  case CAG_EXPR_TEXT: *out = cag_text_new(u->vm, e->as.text.bytes, e->as.text.length); return true;
  case CAG_EXPR_TRUE: *out = cag_bool(true); return true;
  case CAG_EXPR_FALSE: *out = cag_bool(false); return true;
  case CAG_EXPR_NONE: *out = cag_none(); return true;
  case CAG_EXPR_GROUP: return constant_value(u, e->as.unary.operand, out);
  case CAG_EXPR_NEGATE:
    if (!constant_value(u, e->as.unary.operand, out) ||
        (out->type != CAG_NUMBER && out->type != CAG_ANGLE))
      return false;
    out->as.number = -out->as.number;
    return true;
  case CAG_EXPR_NAME:
    if (e->as.name.binding != CAG_BIND_BUILTIN || e->as.name.index >= cag_builtin_count())
      return false;
    *out = u->vm->builtin_values[e->as.name.index];
    return true;
  case CAG_EXPR_LIST: {
    size_t n = e->as.list.count;
    CagCleanup cleanup;
    CagValue *values = cag_temporary(&cleanup, n, sizeof *values);
    bool all = true;
    for (size_t i = 0; all && i < n; i++) all = constant_value(u, e->as.list.items[i], &values[i]);
    if (all) *out = cag_list_values(u->vm, values, n);
    cag_cleanup_run(&cleanup);
    return all;
  }
  default: return false;
  }
}

// Finds number constants among operands of arithmetic.
static bool number_operand(Unit *u, const CagExpr *e, uint32_t *index) {
  CagValue v;
  if (e->kind != CAG_EXPR_NUMBER && e->kind != CAG_EXPR_NEGATE) return false;
  if (!constant_value(u, e, &v) || v.type != CAG_NUMBER) return false;
  *index = (uint32_t)add_constant(u, v);
  return *index <= 0xffff;
}

static uint32_t name_constant(Unit *u, const char *name) {
  return (uint32_t)add_constant(u, cag_object(CAG_TEXT, cag_intern(u->vm, name, strlen(name))));
}

// --- Names ---

static uint16_t capture_index(Unit *u, const CagDecl *d) {
  for (size_t i = 0; i < u->proto->capture_count; i++)
    if (u->captured[i] == d) return (uint16_t)i;
  struct CagCapture c;
  Unit *outer = u->outer;
  if (outer->function && outer->function->self == d)
    c = (struct CagCapture){true, CAG_CAPTURE_SELF};
  else if (d->owner == outer->function) c = (struct CagCapture){true, (uint16_t)d->index};
  else c = (struct CagCapture){false, capture_index(outer, d)};
  CagProto *p = u->proto;
  u->captured =
      grown_scratch(u, u->captured, p->capture_count, &u->captured_capacity, sizeof *u->captured);
  p->captures =
      grown(u->vm, p->captures, p->capture_count, &p->capture_capacity, sizeof *p->captures);
  p->captures[p->capture_count] = c;
  u->captured[p->capture_count] = d;
  return (uint16_t)p->capture_count++;
}

static size_t global_of(const Unit *u, const CagDecl *d) {
  CagModuleUnit *m = u->module;
  if (d->kind == CAG_DECL_TOP) return m->tops[d->index];
  return d->index; // IMPORT, IMPORTED: the loader has stored the index of the global there
}

// Finds the register of a name. Returns false if it is not in a register.
static bool local_register(const Unit *u, const CagExpr *e, uint32_t *reg) {
  if (e->kind == CAG_EXPR_GROUP) return local_register(u, e->as.unary.operand, reg);
  if (e->kind != CAG_EXPR_NAME || e->as.name.binding != CAG_BIND_DECL) return false;
  const CagDecl *d = e->as.name.decl;
  if (d->kind < CAG_DECL_PARAMETER || d->owner != u->function) return false;
  if (u->function && u->function->self == d) return false;
  *reg = (uint32_t)d->index;
  return true;
}

static void compile_name(Unit *u, const CagExpr *e, uint32_t target) {
  if (e->as.name.binding == CAG_BIND_OUTER) {
    emit_wide(u, e->span, CAG_CODE_GLOBAL, target, (int32_t)e->as.name.index);
    return;
  }
  if (e->as.name.binding == CAG_BIND_BUILTIN) {
    size_t i = e->as.name.index;
    if (i >= cag_builtin_count()) u->vm->uses_time = true;
    if (i >= cag_builtin_count())
      emit_wide(u, e->span, CAG_CODE_GLOBAL, target, (int32_t)(i - cag_builtin_count()));
    else
      emit_wide(u, e->span, CAG_CODE_CONSTANT, target, add_constant(u, u->vm->builtin_values[i]));
    return;
  }
  const CagDecl *d = e->as.name.decl;
  uint32_t reg;
  if (d->kind < CAG_DECL_PARAMETER)
    emit_wide(u, e->span, CAG_CODE_GLOBAL, target, (int32_t)global_of(u, d));
  else if (u->function && u->function->self == d) emit(u, e->span, CAG_CODE_SELF, target, 0, 0);
  else if (local_register(u, e, &reg)) {
    if (reg != target) emit(u, e->span, CAG_CODE_MOVE, target, reg, 0);
  } else emit(u, e->span, CAG_CODE_CAPTURE, target, capture_index(u, d), 0);
}

// --- Conditions ---

static bool is_comparison(const CagExpr *e) {
  return e->kind == CAG_EXPR_BINARY && e->as.binary.op >= CAG_OP_EQUAL &&
         e->as.binary.op <= CAG_OP_GREATER_EQUAL;
}

static uint32_t operand(Unit *u, const CagExpr *e);

// Jumps if the value of the comparison is `sense`.
static void jump_on_comparison(Unit *u, const CagExpr *e, bool sense, Patches *out) {
  uint32_t mark = u->next;
  uint32_t left = operand(u, e->as.binary.left);
  uint32_t right = operand(u, e->as.binary.right);
  CagOpcode op;
  switch (e->as.binary.op) {
  case CAG_OP_EQUAL: op = CAG_CODE_JUMP_NOT_EQUAL; break;
  case CAG_OP_NOT_EQUAL: op = CAG_CODE_JUMP_EQUAL; break;
  case CAG_OP_LESS: op = CAG_CODE_JUMP_NOT_LESS; break;
  case CAG_OP_LESS_EQUAL: op = CAG_CODE_JUMP_NOT_LESS_EQUAL; break;
  case CAG_OP_GREATER: op = CAG_CODE_JUMP_NOT_LESS; break;
  default: op = CAG_CODE_JUMP_NOT_LESS_EQUAL; break;
  }
  bool swap = e->as.binary.op == CAG_OP_GREATER || e->as.binary.op == CAG_OP_GREATER_EQUAL;
  emit(u, e->span, op, swap ? right : left, swap ? left : right, swap);
  if (sense) { // if the comparison fails, the instruction skips to after the jump
    emit_wide(u, e->span, CAG_CODE_JUMP, 0, 1);
    add_patch(u, out, emit_wide(u, e->span, CAG_CODE_JUMP, 0, 0));
  } else {
    add_patch(u, out, emit_wide(u, e->span, CAG_CODE_JUMP, 0, 0));
  }
  u->next = mark;
}

static void jump_when(Unit *u, const CagExpr *e, bool sense, Patches *out) {
  switch (e->kind) {
  case CAG_EXPR_GROUP: jump_when(u, e->as.unary.operand, sense, out); return;
  case CAG_EXPR_NOT: jump_when(u, e->as.unary.operand, !sense, out); return;
  case CAG_EXPR_AND:
  case CAG_EXPR_OR: {
    bool decisive = e->kind == CAG_EXPR_OR; // the value of the left side that determines the result
    if (decisive == sense) {
      jump_when(u, e->as.binary.left, sense, out);
      jump_when(u, e->as.binary.right, sense, out);
    } else {
      Patches skip = {0};
      jump_when(u, e->as.binary.left, decisive, &skip);
      jump_when(u, e->as.binary.right, sense, out);
      patch_all(u, &skip, here(u));
    }
    return;
  }
  default: break;
  }
  if (is_comparison(e)) {
    jump_on_comparison(u, e, sense, out);
    return;
  }
  uint32_t mark = u->next;
  uint32_t r = compile_any(u, e);
  add_patch(u, out,
            emit_wide(u, e->span, sense ? CAG_CODE_JUMP_IF_TRUE : CAG_CODE_JUMP_IF_FALSE, r, 0));
  u->next = mark;
}

// --- Calls ---

static const char *const *add_names(Unit *u, const CagArgument *arguments, size_t n, size_t named,
                                    uint32_t *index) {
  CagProto *p = u->proto;
  size_t capacity = p->names_capacity;
  p->names = grown(u->vm, p->names, p->names_count, &capacity, sizeof *p->names);
  p->name_counts =
      grown(u->vm, p->name_counts, p->names_count, &p->names_capacity, sizeof *p->name_counts);
  const char **names = cag_malloc(named * sizeof *names);
  if (!names) cag_vm_out_of_memory(u->vm);
  for (size_t i = 0; i < named; i++) names[i] = arguments[n - named + i].name;
  p->names[p->names_count] = names;
  p->name_counts[p->names_count] = named;
  *index = (uint32_t)p->names_count++;
  return names;
}

static void add_site_span(Unit *u, CagSpan span) {
  CagProto *p = u->proto;
  p->site_spans = grown(u->vm, p->site_spans, p->site_span_count, &p->site_span_capacity,
                        sizeof *p->site_spans);
  p->site_spans[p->site_span_count++] = span;
}

// Compiles a call with a callee, an optional piped first argument, and arguments. Returns the new
// register that receives the result.
static uint32_t compile_call(Unit *u, const CagExpr *whole, const CagExpr *callee,
                             const CagExpr *piped, const CagArgument *arguments, size_t n,
                             bool tail) {
  uint32_t base = take_registers(u, 1);
  compile_to(u, callee, base);
  size_t total = n + (piped ? 1 : 0), named = 0;
  if (piped) {
    uint32_t r = take_registers(u, 1);
    compile_to(u, piped, r);
  }
  for (size_t i = 0; i < n; i++) {
    uint32_t r = take_registers(u, 1);
    compile_to(u, arguments[i].value, r);
    if (arguments[i].name) named++;
  }
  uint32_t names = 0;
  if (named) add_names(u, arguments, n, named, &names);
  CagOpcode op = tail    ? (named ? CAG_CODE_TAIL_CALL_NAMED : CAG_CODE_TAIL_CALL)
                 : named ? CAG_CODE_CALL_NAMED
                         : CAG_CODE_CALL;
  size_t at = emit(u, whole->span, op, base, (uint32_t)total, names);
  CagProto *p = u->proto;
  p->sites = grown(u->vm, p->sites, p->site_count, &p->site_capacity, sizeof *p->sites);
  p->sites[p->site_count++] =
      (CagCallSite){(uint32_t)at, (uint32_t)p->site_span_count, (uint32_t)total + 1};
  add_site_span(u, callee->span);
  if (piped) add_site_span(u, piped->span);
  for (size_t i = 0; i < n; i++) add_site_span(u, arguments[i].value->span);
  u->next = base + 1;
  return base;
}

static uint32_t compile_pipe(Unit *u, const CagExpr *e, bool tail) {
  const CagExpr *right = e->as.binary.right;
  if (right->kind == CAG_EXPR_CALL)
    return compile_call(u, e, right->as.call.callee, e->as.binary.left, right->as.call.arguments,
                        right->as.call.count, tail);
  return compile_call(u, e, right, e->as.binary.left, NULL, 0, tail);
}

// --- Compound expressions ---

static void compile_list(Unit *u, const CagExpr *e, uint32_t target) {
  CagValue constant;
  if (constant_value(u, e, &constant)) {
    emit_wide(u, e->span, CAG_CODE_CONSTANT, target, add_constant(u, constant));
    return;
  }
  size_t n = e->as.list.count;
  bool spread = false;
  for (size_t i = 0; i < n; i++) spread |= e->as.list.items[i]->kind == CAG_EXPR_SPREAD;
  uint32_t mark = u->next;
  if (!spread && n <= LIST_IN_REGISTERS) {
    uint32_t first = take_registers(u, (uint32_t)n);
    for (size_t i = 0; i < n; i++) compile_to(u, e->as.list.items[i], first + (uint32_t)i);
    emit(u, e->span, CAG_CODE_LIST, target, first, (uint32_t)n);
  } else {
    uint32_t builder = take_registers(u, 1);
    emit(u, e->span, CAG_CODE_BUILDER, builder, 0, 0);
    for (size_t i = 0; i < n; i++) {
      const CagExpr *item = e->as.list.items[i];
      uint32_t inner = u->next;
      bool spreads = item->kind == CAG_EXPR_SPREAD;
      uint32_t r = compile_any(u, spreads ? item->as.unary.operand : item);
      emit(u, spreads ? item->as.unary.operand->span : item->span,
           spreads ? CAG_CODE_EXTEND : CAG_CODE_PUSH, builder, r, 0);
      u->next = inner;
    }
    emit(u, e->span, CAG_CODE_FINISH, target, builder, 0);
  }
  u->next = mark;
}

static void compile_record(Unit *u, const CagExpr *e, uint32_t target) {
  size_t n = e->as.record.count, plain = 0;
  while (plain < n && e->as.record.fields[plain].name) plain++;
  uint32_t mark = u->next;
  uint32_t first = take_registers(u, (uint32_t)plain);
  CagCleanup cleanup;
  CagText **names = cag_temporary(&cleanup, plain, sizeof *names);
  for (size_t i = 0; i < plain; i++) {
    const CagField *f = &e->as.record.fields[i];
    names[i] = cag_intern(u->vm, f->name, strlen(f->name));
    compile_to(u, f->value, first + (uint32_t)i);
  }
  CagLayout *layout = cag_layout_new(u->vm, names, plain);
  cag_cleanup_run(&cleanup);
  uint32_t r = plain == n ? target : take_registers(u, 1);
  emit(u, e->span, CAG_CODE_RECORD, r, first,
       (uint32_t)add_constant(u, cag_object(CAG_INTERNAL, layout)));
  for (size_t i = plain; i < n; i++) { // from the first spread on, one field at a time
    const CagField *f = &e->as.record.fields[i];
    uint32_t inner = u->next;
    uint32_t v = compile_any(u, f->value);
    if (f->name) emit(u, f->name_span, CAG_CODE_RECORD_SET, r, v, name_constant(u, f->name));
    else emit(u, f->value->span, CAG_CODE_RECORD_SPREAD, r, v, 0);
    u->next = inner;
  }
  if (r != target) emit(u, e->span, CAG_CODE_MOVE, target, r, 0);
  u->next = mark;
}

static void compile_assert(Unit *u, const CagStatement *s);

static void bind_name(Unit *u, CagDecl *decl, uint32_t value) {
  if (decl->kind != CAG_DECL_TOP) decl->index = value;
  else if (strcmp(decl->name, "_") != 0) emit(u, decl->span, CAG_CODE_MOVE, u->result++, value, 0);
}

// Takes apart the value of a register. The registers of the names remain in use. Places are those
// of the whole pattern of a list or record, whose text is in messages.
static void compile_pattern(Unit *u, const CagPattern *pattern, uint32_t value) {
  const size_t n = pattern->count;
  uint32_t first = 0;
  switch (pattern->kind) {
  case CAG_PATTERN_NAME: bind_name(u, pattern->decl, value); return;
  case CAG_PATTERN_LIST:
    first = take_registers(u, (uint32_t)n + (pattern->rest ? 1 : 0));
    emit(u, pattern->span, pattern->rest ? CAG_CODE_UNPACK_REST : CAG_CODE_UNPACK, first, value,
         (uint32_t)n);
    break;
  case CAG_PATTERN_RECORD:
    first = take_registers(u, (uint32_t)n);
    for (size_t i = 0; i < n; i++)
      emit(u, pattern->span, CAG_CODE_FIELD, first + (uint32_t)i, value,
           name_constant(u, pattern->parts[i].field));
    break;
  }
  for (size_t i = 0; i < n; i++) compile_pattern(u, pattern->parts[i].pattern, first + (uint32_t)i);
  if (pattern->rest) bind_name(u, pattern->rest, first + (uint32_t)n);
}

// Compiles the definitions and asserts of a block. Their registers remain in use.
static void compile_block_head(Unit *u, const CagExpr *e) {
  for (size_t i = 0; i < e->as.block.count; i++) {
    const CagStatement *s = e->as.block.statements[i];
    if (s->kind == CAG_STATEMENT_ASSERT) {
      compile_assert(u, s);
      continue;
    }
    uint32_t r = take_registers(u, 1);
    compile_to(u, s->as.definition.value, r);
    s->as.definition.decl->index = r;
    if (s->as.definition.pattern) compile_pattern(u, s->as.definition.pattern, r);
  }
}

static void compile_clause(Unit *u, const CagExpr *e, size_t k, uint32_t builder) {
  if (k == e->as.comprehension.count) {
    uint32_t mark = u->next;
    uint32_t r = compile_any(u, e->as.comprehension.body);
    emit(u, e->as.comprehension.body->span, CAG_CODE_PUSH, builder, r, 0);
    u->next = mark;
    return;
  }
  const CagClause *clause = &e->as.comprehension.clauses[k];
  uint32_t mark = u->next;
  uint32_t iterator = take_registers(u, 4);
  uint32_t source = compile_any(u, clause->source);
  emit(u, clause->source->span, CAG_CODE_ITERATE, iterator, source, 0);
  u->next = iterator + 4;
  size_t start = here(u);
  size_t next = emit_wide(u, clause->source->span, CAG_CODE_NEXT, iterator, 0);
  compile_pattern(u, clause->pattern, iterator + 3);
  Patches skip = {0};
  if (clause->filter) jump_when(u, clause->filter, false, &skip);
  compile_clause(u, e, k + 1, builder);
  patch_all(u, &skip, here(u));
  size_t loop = emit_wide(u, clause->span, CAG_CODE_LOOP, 0, 0);
  patch_to(u, loop, start);
  patch_to(u, next, here(u));
  u->next = mark;
}

static void compile_comprehension(Unit *u, const CagExpr *e, uint32_t target) {
  uint32_t mark = u->next;
  uint32_t builder = take_registers(u, 1);
  emit(u, e->span, CAG_CODE_BUILDER, builder, 0, 0);
  compile_clause(u, e, 0, builder);
  emit(u, e->span, CAG_CODE_FINISH, target, builder, 0);
  u->next = mark;
}

static void compile_if(Unit *u, const CagExpr *e, uint32_t target) {
  Patches otherwise = {0}, end = {0};
  jump_when(u, e->as.branch.condition, false, &otherwise);
  compile_to(u, e->as.branch.then, target);
  add_patch(u, &end, emit_wide(u, e->span, CAG_CODE_JUMP, 0, 0));
  patch_all(u, &otherwise, here(u));
  compile_to(u, e->as.branch.otherwise, target);
  patch_all(u, &end, here(u));
}

static void compile_logical(Unit *u, const CagExpr *e, uint32_t target) {
  Patches end = {0};
  // The target may be the register of a name that the right side reads, so use a new one.
  uint32_t mark = u->next;
  uint32_t r = take_registers(u, 1);
  compile_to(u, e->as.binary.left, r);
  bool is_and = e->kind == CAG_EXPR_AND;
  add_patch(u, &end,
            emit_wide(u, e->as.binary.left->span,
                      is_and ? CAG_CODE_JUMP_IF_FALSE : CAG_CODE_JUMP_IF_TRUE, r, 0));
  compile_to(u, e->as.binary.right, r);
  emit(u, e->as.binary.right->span, CAG_CODE_CHECK_BOOL, r, (uint32_t)e->kind, 0);
  patch_all(u, &end, here(u));
  if (r != target) emit(u, e->span, CAG_CODE_MOVE, target, r, 0);
  u->next = mark;
}

static uint32_t operand(Unit *u, const CagExpr *e) { return compile_any(u, e); }

static void compile_binary(Unit *u, const CagExpr *e, uint32_t target) {
  CagBinaryOp op = e->as.binary.op;
  uint32_t mark = u->next, k;
  if (op <= CAG_OP_DIVIDE) {
    uint32_t left = operand(u, e->as.binary.left);
    if (number_operand(u, e->as.binary.right, &k)) {
      emit(u, e->span, (CagOpcode)(CAG_CODE_ADD_K + (op - CAG_OP_ADD)), target, left, k);
    } else {
      uint32_t right = operand(u, e->as.binary.right);
      emit(u, e->span, (CagOpcode)(CAG_CODE_ADD + (op - CAG_OP_ADD)), target, left, right);
    }
    u->next = mark;
    return;
  }
  uint32_t left = take_registers(u, 1);
  compile_to(u, e->as.binary.left, left);
  uint32_t right = operand(u, e->as.binary.right);
  emit(u, e->span, op >= CAG_OP_EQUAL ? CAG_CODE_COMPARE : CAG_CODE_BINARY, left, right,
       (uint32_t)op);
  if (left != target) emit(u, e->span, CAG_CODE_MOVE, target, left, 0);
  u->next = mark;
}

static void compile_range(Unit *u, const CagExpr *e, uint32_t target) {
  uint32_t mark = u->next;
  uint32_t first = take_registers(u, 3);
  compile_to(u, e->as.range.low, first);
  compile_to(u, e->as.range.high, first + 1);
  if (e->as.range.step) compile_to(u, e->as.range.step, first + 2);
  emit(u, e->span, CAG_CODE_RANGE, target, first,
       (e->as.range.open ? 1u : 0u) | (e->as.range.step ? 2u : 0u));
  u->next = mark;
}

static void compile_lambda(Unit *u, const CagExpr *e, uint32_t target) {
  CagProto *child = compile_function(u, u->module, u->vm, e->as.function);
  if (!child) {
    u->failed = true;
    return;
  }
  CagProto *p = u->proto;
  p->children = grown(u->vm, p->children, p->child_count, &p->child_capacity, sizeof *p->children);
  p->children[p->child_count] = child;
  emit_wide(u, e->span, CAG_CODE_CLOSURE, target, (int32_t)p->child_count++);
}

static void compile_template(Unit *u, const CagExpr *e, uint32_t target) {
  uint32_t mark = u->next;
  size_t n = e->as.list.count;
  uint32_t first = take_registers(u, (uint32_t)n);
  for (size_t i = 0; i < n; i++) compile_to(u, e->as.list.items[i], first + (uint32_t)i);
  emit(u, e->span, CAG_CODE_TEMPLATE, target, first, (uint32_t)n);
  u->next = mark;
}

static void compile_to(Unit *u, const CagExpr *e, uint32_t target) {
  uint32_t mark = u->next, r;
  CagValue constant;
  switch (e->kind) {
  case CAG_EXPR_NUMBER:
  case CAG_EXPR_ANGLE:
  case CAG_EXPR_TEXT:
    if (constant_value(u, e, &constant))
      emit_wide(u, e->span, CAG_CODE_CONSTANT, target, add_constant(u, constant));
    break;
  case CAG_EXPR_TEMPLATE: compile_template(u, e, target); break;
  case CAG_EXPR_TRUE: emit_wide(u, e->span, CAG_CODE_BOOL, target, 1); break;
  case CAG_EXPR_FALSE: emit_wide(u, e->span, CAG_CODE_BOOL, target, 0); break;
  case CAG_EXPR_NONE:
  case CAG_EXPR_ERROR: emit(u, e->span, CAG_CODE_NONE, target, 0, 0); break;
  case CAG_EXPR_NAME: compile_name(u, e, target); break;
  case CAG_EXPR_GROUP:
  case CAG_EXPR_SPREAD: compile_to(u, e->as.unary.operand, target); break;
  case CAG_EXPR_LIST: compile_list(u, e, target); break;
  case CAG_EXPR_COMPREHENSION: compile_comprehension(u, e, target); break;
  case CAG_EXPR_RECORD: compile_record(u, e, target); break;
  case CAG_EXPR_BLOCK:
    compile_block_head(u, e);
    compile_to(u, e->as.block.value, target);
    break;
  case CAG_EXPR_LAMBDA: compile_lambda(u, e, target); break;
  case CAG_EXPR_IF: compile_if(u, e, target); break;
  case CAG_EXPR_NEGATE:
    if (constant_value(u, e, &constant)) {
      emit_wide(u, e->span, CAG_CODE_CONSTANT, target, add_constant(u, constant));
      break;
    }
    r = compile_any(u, e->as.unary.operand);
    emit(u, e->span, CAG_CODE_NEGATE, target, r, 0);
    break;
  case CAG_EXPR_NOT:
    r = compile_any(u, e->as.unary.operand);
    emit(u, e->span, CAG_CODE_NOT, target, r, 0);
    break;
  case CAG_EXPR_BINARY: compile_binary(u, e, target); break;
  case CAG_EXPR_AND:
  case CAG_EXPR_OR: compile_logical(u, e, target); break;
  case CAG_EXPR_PIPE:
    r = compile_pipe(u, e, false);
    if (r != target) emit(u, e->span, CAG_CODE_MOVE, target, r, 0);
    break;
  case CAG_EXPR_CALL:
    r = compile_call(u, e, e->as.call.callee, NULL, e->as.call.arguments, e->as.call.count, false);
    if (r != target) emit(u, e->span, CAG_CODE_MOVE, target, r, 0);
    break;
  case CAG_EXPR_RANGE: compile_range(u, e, target); break;
  case CAG_EXPR_INDEX: {
    uint32_t object = compile_any(u, e->as.binary.left);
    uint32_t index = compile_any(u, e->as.binary.right);
    emit(u, e->span, CAG_CODE_INDEX, target, object, index);
    break;
  }
  case CAG_EXPR_MEMBER: {
    uint32_t object = compile_any(u, e->as.member.object);
    emit(u, e->as.member.name_span, CAG_CODE_MEMBER, target, object,
         name_constant(u, e->as.member.name));
    break;
  }
  }
  u->next = mark;
}

// Returns the register with the value of e: one that already holds it, or a new one.
static uint32_t compile_any(Unit *u, const CagExpr *e) {
  uint32_t reg;
  if (local_register(u, e, &reg)) return reg;
  if (e->kind == CAG_EXPR_CALL)
    return compile_call(u, e, e->as.call.callee, NULL, e->as.call.arguments, e->as.call.count,
                        false);
  if (e->kind == CAG_EXPR_PIPE) return compile_pipe(u, e, false);
  uint32_t r = take_registers(u, 1);
  compile_to(u, e, r);
  return r;
}

static void compile_tail(Unit *u, const CagExpr *e) {
  uint32_t mark = u->next;
  switch (e->kind) {
  case CAG_EXPR_GROUP: compile_tail(u, e->as.unary.operand); return;
  case CAG_EXPR_IF: {
    Patches otherwise = {0};
    jump_when(u, e->as.branch.condition, false, &otherwise);
    compile_tail(u, e->as.branch.then);
    patch_all(u, &otherwise, here(u));
    compile_tail(u, e->as.branch.otherwise);
    return;
  }
  case CAG_EXPR_BLOCK:
    compile_block_head(u, e);
    compile_tail(u, e->as.block.value);
    u->next = mark;
    return;
  case CAG_EXPR_CALL:
    compile_call(u, e, e->as.call.callee, NULL, e->as.call.arguments, e->as.call.count, true);
    u->next = mark;
    return;
  case CAG_EXPR_PIPE:
    compile_pipe(u, e, true);
    u->next = mark;
    return;
  default: emit(u, e->span, CAG_CODE_RETURN, compile_any(u, e), 0, 0); u->next = mark;
  }
}

// --- Asserts ---

static bool is_literal(const CagExpr *e) {
  switch (e->kind) {
  case CAG_EXPR_NUMBER:
  case CAG_EXPR_ANGLE:
  case CAG_EXPR_TEXT:
  case CAG_EXPR_TRUE:
  case CAG_EXPR_FALSE:
  case CAG_EXPR_NONE: return true;
  case CAG_EXPR_NEGATE:
  case CAG_EXPR_GROUP: return is_literal(e->as.unary.operand);
  default: return false;
  }
}

// Evaluates one part of a failed condition again, for its text and value in the message.
static uint32_t compile_part(Unit *u, const CagExpr *e) {
  if (is_literal(e) || e->kind == CAG_EXPR_LAMBDA) return 0;
  uint32_t r = take_registers(u, 2);
  const char *text = u->proto->source->text + e->span.start;
  CagValue v = cag_text_new(u->vm, text, e->span.end - e->span.start);
  emit_wide(u, e->span, CAG_CODE_CONSTANT, r, add_constant(u, v));
  compile_to(u, e, r + 1);
  return 1;
}

static void compile_assert_failure(Unit *u, const CagStatement *s, const CagExpr *condition) {
  while (condition->kind == CAG_EXPR_GROUP || condition->kind == CAG_EXPR_NOT)
    condition = condition->as.unary.operand;
  if (condition->kind == CAG_EXPR_AND) { // which side failed?
    Patches left = {0};
    jump_when(u, condition->as.binary.left, false, &left);
    compile_assert_failure(u, s, condition->as.binary.right);
    patch_all(u, &left, here(u));
    compile_assert_failure(u, s, condition->as.binary.left);
    return;
  }
  uint32_t mark = u->next;
  uint32_t message = take_registers(u, 1);
  if (s->as.assertion.message) compile_to(u, s->as.assertion.message, message);
  else emit(u, s->span, CAG_CODE_NONE, message, 0, 0);
  uint32_t parts = 0;
  if (condition->kind == CAG_EXPR_BINARY || condition->kind == CAG_EXPR_OR) {
    parts += compile_part(u, condition->as.binary.left);
    parts += compile_part(u, condition->as.binary.right);
  } else if (condition->kind == CAG_EXPR_CALL) {
    for (size_t i = 0; i < condition->as.call.count; i++)
      parts += compile_part(u, condition->as.call.arguments[i].value);
  } else {
    parts += compile_part(u, condition);
  }
  emit(u, s->as.assertion.condition->span, CAG_CODE_ASSERT_FAIL, message, parts, 0);
  u->next = mark;
}

static void compile_assert(Unit *u, const CagStatement *s) {
  Patches good = {0};
  jump_when(u, s->as.assertion.condition, true, &good);
  compile_assert_failure(u, s, s->as.assertion.condition);
  patch_all(u, &good, here(u));
}

// --- Units ---

static CagProto *new_proto(CagVm *vm, CagModuleUnit *m, const char *name) {
  CagProto *p = cag_calloc(1, sizeof *p);
  if (!p) cag_vm_out_of_memory(vm);
  p->name = name;
  p->source = m->source;
  p->next = vm->protos;
  vm->protos = p;
  return p;
}

static CagProto *compile_function(Unit *outer, CagModuleUnit *m, CagVm *vm,
                                  const CagFunctionAst *f) {
  Unit u = {.vm = vm,
            .module = m,
            .outer = outer,
            .function = f,
            .proto = new_proto(vm, m, f->name),
            .scratch = outer->scratch};
  CagProto *p = u.proto;
  p->is_function = true;
  p->parameter_count = f->parameter_count;
  p->required_count = f->required_count;
  p->parameters = cag_malloc((f->parameter_count ? f->parameter_count : 1) * sizeof *p->parameters);
  if (!p->parameters) cag_vm_out_of_memory(vm);
  take_registers(&u, (uint32_t)f->parameter_count);
  for (size_t i = 0; i < f->parameter_count; i++) {
    p->parameters[i] = f->parameters[i].decl->name;
    f->parameters[i].decl->index = i;
  }
  bool patterns = false;
  for (size_t i = 0; i < f->required_count; i++) {
    if (!f->parameters[i].pattern) continue;
    compile_pattern(&u, f->parameters[i].pattern, (uint32_t)i);
    patterns = true;
  }
  for (size_t i = f->required_count; i < f->parameter_count; i++) {
    size_t jump =
        emit_wide(&u, f->parameters[i].fallback->span, CAG_CODE_JUMP_IF_SET, (uint32_t)i, 0);
    compile_to(&u, f->parameters[i].fallback, (uint32_t)i);
    patch_to(&u, jump, here(&u));
  }
  p->body = patterns ? 0 : (uint32_t)here(&u);
  compile_tail(&u, f->body);
  return u.failed ? NULL : p;
}

static void free_scratch(void *scratch) { cag_arena_free(scratch); }

CagProto *cag_compile_expression(CagVm *vm, CagModuleUnit *m, const CagExpr *e, const char *name) {
  CagArena scratch = {0};
  CagCleanup cleanup;
  cag_cleanup_push(&cleanup, free_scratch, &scratch);
  Unit u = {.vm = vm, .module = m, .proto = new_proto(vm, m, name), .scratch = &scratch};
  uint32_t r = take_registers(&u, 1);
  compile_to(&u, e, r);
  emit(&u, e->span, CAG_CODE_RETURN, r, 0, 0);
  cag_cleanup_run(&cleanup);
  return u.failed ? NULL : u.proto;
}

CagProto *cag_compile_definition(CagVm *vm, CagModuleUnit *m, const CagExpr *value,
                                 const CagPattern *pattern, const char *name) {
  CagArena scratch = {0};
  CagCleanup cleanup;
  cag_cleanup_push(&cleanup, free_scratch, &scratch);
  Unit u = {.vm = vm, .module = m, .proto = new_proto(vm, m, name), .scratch = &scratch};
  const uint32_t r = take_registers(&u, 1), n = (uint32_t)pattern->name_count;
  const uint32_t first = u.result = take_registers(&u, n);
  compile_to(&u, value, r);
  compile_pattern(&u, pattern, r);
  emit(&u, value->span, CAG_CODE_LIST, r, first, n);
  emit(&u, value->span, CAG_CODE_RETURN, r, 0, 0);
  cag_cleanup_run(&cleanup);
  return u.failed ? NULL : u.proto;
}

CagProto *cag_compile_assert(CagVm *vm, CagModuleUnit *m, const CagStatement *s) {
  CagArena scratch = {0};
  CagCleanup cleanup;
  cag_cleanup_push(&cleanup, free_scratch, &scratch);
  Unit u = {.vm = vm, .module = m, .proto = new_proto(vm, m, NULL), .scratch = &scratch};
  uint32_t r = take_registers(&u, 1);
  compile_assert(&u, s);
  emit_wide(&u, s->span, CAG_CODE_BOOL, r, 1);
  emit(&u, s->span, CAG_CODE_RETURN, r, 0, 0);
  cag_cleanup_run(&cleanup);
  return u.failed ? NULL : u.proto;
}

void cag_proto_free(CagProto *p) {
  for (size_t i = 0; i < p->names_count; i++) cag_free(p->names[i]);
  cag_free(p->names);
  cag_free(p->name_counts);
  cag_free(p->parameters);
  cag_free(p->code);
  cag_free(p->spans);
  cag_free(p->constants);
  cag_free(p->children);
  cag_free(p->captures);
  cag_free(p->sites);
  cag_free(p->site_spans);
  cag_free(p);
}
