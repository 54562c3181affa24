// Evaluation of constant calls.

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "interp/check/constant.h"
#include "interp/vm/builtin.h"

// Larger expressions are data, which take long and are rarely wrong.
#define NODES_MAX 400
// Larger numbers may be counts, which may take long.
#define NUMBER_MAX 1e5
// The maximum number of calls that are evaluated in a file. Their code is kept as long as the
// machine.
#define CALLS_MAX 20000

// Tests for families of built-ins that are fast for all constants.
static bool is_quick(const CagBuiltin *row) {
  static const char *const families[] = {"Numbers",
                                         "Angles",
                                         "Vectors",
                                         "Transforms",
                                         "Plane geometry",
                                         "Curves: construction",
                                         "Curves: Bezier and B-splines",
                                         "Conics: from axes",
                                         "Regions",
                                         "Surfaces: construction from curves",
                                         "Quadrics",
                                         "Solids",
                                         "Robots: links",
                                         "Scene",
                                         "Appearance and names"};
  for (size_t i = 0; i < sizeof families / sizeof *families; i++)
    if (row->family && strcmp(row->family, families[i]) == 0)
      return strncmp(row->signature, "read_", strlen("read_")) != 0;
  return false;
}

static bool is_constant(const CagConstants *c, const CagExpr *e, size_t *nodes);

static bool are_constant(const CagConstants *c, CagExpr *const *items, size_t count,
                         size_t *nodes) {
  for (size_t i = 0; i < count; i++)
    if (!is_constant(c, items[i], nodes)) return false;
  return true;
}

static const CagBuiltin *builtin_of(const CagExpr *e) {
  size_t rows;
  if (e->kind != CAG_EXPR_NAME || e->as.name.binding != CAG_BIND_BUILTIN ||
      e->as.name.index >= cag_builtin_count())
    return NULL;
  return cag_builtin_rows(e->as.name.index, &rows);
}

static bool is_constant_name(const CagConstants *c, const CagExpr *e, size_t *nodes) {
  const CagBuiltin *row = builtin_of(e);
  if (row) return !row->function;
  const CagDecl *d = e->as.name.decl;
  if (e->as.name.binding != CAG_BIND_DECL || !d || d->kind != CAG_DECL_TOP) return false;
  const CagStatement *s = d->statement;
  return s->kind == CAG_STATEMENT_DEFINITION && !c->is_bad[d->index] &&
         is_constant(c, s->as.definition.value, nodes);
}

static bool is_constant_call(const CagConstants *c, const CagExpr *e, size_t *nodes) {
  const CagBuiltin *row = builtin_of(e->as.call.callee);
  if (!row || !row->function || !is_quick(row)) return false;
  for (size_t i = 0; i < e->as.call.count; i++)
    if (!is_constant(c, e->as.call.arguments[i].value, nodes)) return false;
  return true;
}

static bool is_constant_pipe(const CagConstants *c, const CagExpr *e, size_t *nodes) {
  const CagExpr *right = e->as.binary.right;
  if (!is_constant(c, e->as.binary.left, nodes)) return false;
  if (right->kind == CAG_EXPR_CALL) return is_constant_call(c, right, nodes);
  const CagBuiltin *row = builtin_of(right);
  return row && row->function && is_quick(row);
}

static bool is_constant(const CagConstants *c, const CagExpr *e, size_t *nodes) {
  if (++*nodes > NODES_MAX) return false;
  switch (e->kind) {
  case CAG_EXPR_NUMBER:
  case CAG_EXPR_ANGLE: return fabs(e->as.number) <= NUMBER_MAX;
  case CAG_EXPR_TEXT: return !strchr(e->as.text.bytes, '.'); // with a point, it may be a file name
  case CAG_EXPR_TRUE:
  case CAG_EXPR_FALSE:
  case CAG_EXPR_NONE: return true;
  case CAG_EXPR_NAME: return is_constant_name(c, e, nodes);
  case CAG_EXPR_GROUP:
  case CAG_EXPR_NEGATE: return is_constant(c, e->as.unary.operand, nodes);
  case CAG_EXPR_LIST: return are_constant(c, e->as.list.items, e->as.list.count, nodes);
  case CAG_EXPR_RECORD:
    for (size_t i = 0; i < e->as.record.count; i++)
      if (!is_constant(c, e->as.record.fields[i].value, nodes)) return false;
    return true;
  case CAG_EXPR_RANGE:
    return is_constant(c, e->as.range.low, nodes) && is_constant(c, e->as.range.high, nodes) &&
           (!e->as.range.step || is_constant(c, e->as.range.step, nodes));
  case CAG_EXPR_BINARY:
    return e->as.binary.op <= CAG_OP_MODULO && is_constant(c, e->as.binary.left, nodes) &&
           is_constant(c, e->as.binary.right, nodes);
  case CAG_EXPR_CALL: return is_constant_call(c, e, nodes);
  case CAG_EXPR_PIPE: return is_constant_pipe(c, e, nodes);
  default: return false;
  }
}

typedef struct Evaluation {
  CagModuleUnit *unit;
  const CagExpr *e;
} Evaluation;

static bool evaluate(CagVm *vm, void *context) {
  const Evaluation *w = context;
  CagValue ignored;
  const CagProto *p = cag_compile_expression(vm, w->unit, w->e, NULL);
  return p && cag_vm_run(vm, p, &ignored);
}

void cag_check_constant(CagConstants *c, const CagExpr *e) {
  size_t nodes = 0;
  CagVm *vm = c->vm;
  if (c->evaluated >= CALLS_MAX || !is_constant(c, e, &nodes)) return;
  c->evaluated++;
  CagDiagnostics known = vm->errors;
  vm->errors = (CagDiagnostics){0};
  Evaluation w = {c->unit, e};
  cag_vm_protect(vm, evaluate, &w);
  CagDiagnostics found = vm->errors;
  vm->errors = known;
  vm->failed = false;
  if (vm->stop) c->evaluated = CALLS_MAX; // interrupted: report this only once
  cag_diagnostics_move(&vm->errors, &found);
  cag_diagnostics_clear(&found);
}

typedef struct Printing {
  Evaluation work;
  CagString *out;
} Printing;

static bool evaluate_to_text(CagVm *vm, void *context) {
  const Printing *p = context;
  CagValue value;
  const CagProto *proto = cag_compile_expression(vm, p->work.unit, p->work.e, NULL);
  if (!proto || !cag_vm_run(vm, proto, &value)) return false;
  cag_print_value(vm, p->out, value, false);
  return true;
}

bool cag_constant_print(CagVm *vm, CagModuleUnit *unit, const CagExpr *e, CagString *out) {
  size_t nodes = 0;
  CagConstants c = {.vm = vm, .unit = unit};
  bool *bad = cag_calloc(unit->ast->top_count + 1, sizeof *bad);
  if (!bad) return false;
  for (size_t i = 0; i < unit->ast->top_count; i++)
    bad[i] = unit->ast->tops[i]->statement->damage != CAG_SOUND;
  c.is_bad = bad;
  bool ok = is_constant(&c, e, &nodes);
  cag_free(bad);
  if (!ok) return false;
  CagDiagnostics known = vm->errors;
  vm->errors = (CagDiagnostics){0};
  ok = cag_vm_protect(vm, evaluate_to_text, &(Printing){{unit, e}, out});
  cag_diagnostics_clear(&vm->errors);
  vm->errors = known;
  vm->failed = false;
  return ok && !out->failed;
}
