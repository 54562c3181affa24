#include "interp/session/point_literals.h"
#include "lang/tree.h"

#include <string.h>

// The most names that are followed from one expression.
#define MOST_NAMES 32
#define NOT_COUNTED ((size_t)-1)

static const CagLiteral unknown = {NULL, NULL};

// --- The call at a location ---

static bool contains(CagSpan outer, CagSpan inner) {
  return outer.start <= inner.start && inner.end <= outer.end;
}

static const CagExpr *find_call(const CagExpr *e, CagSpan span);

static const CagExpr *find_in_all(CagExpr *const *items, size_t n, CagSpan span) {
  const CagExpr *found = NULL;
  for (size_t i = 0; !found && i < n; i++) found = find_call(items[i], span);
  return found;
}

static const CagExpr *find_in_function(const CagFunctionAst *f, CagSpan span) {
  const CagExpr *found = find_call(f->body, span);
  for (size_t i = 0; !found && i < f->parameter_count; i++)
    found = find_call(f->parameters[i].fallback, span);
  return found;
}

static const CagExpr *find_in_statement(const CagStatement *s, CagSpan span) {
  switch (s->kind) {
  case CAG_STATEMENT_PARAM: return find_call(s->as.param.value, span);
  case CAG_STATEMENT_DEFINITION: return find_call(s->as.definition.value, span);
  case CAG_STATEMENT_SHOW:
  case CAG_STATEMENT_PRINT: return find_in_all(s->as.list.items, s->as.list.count, span);
  case CAG_STATEMENT_ASSERT: return find_call(s->as.assertion.condition, span);
  case CAG_STATEMENT_EXPRESSION: return find_call(s->as.expression, span);
  default: return NULL;
  }
}

static const CagExpr *find_in_block(const CagExpr *e, CagSpan span) {
  const CagExpr *found = find_call(e->as.block.value, span);
  for (size_t i = 0; !found && i < e->as.block.count; i++)
    found = find_in_statement(e->as.block.statements[i], span);
  return found;
}

static const CagExpr *find_in_clauses(const CagExpr *e, CagSpan span) {
  const CagExpr *found = find_call(e->as.comprehension.body, span);
  for (size_t i = 0; !found && i < e->as.comprehension.count; i++) {
    found = find_call(e->as.comprehension.clauses[i].source, span);
    if (!found) found = find_call(e->as.comprehension.clauses[i].filter, span);
  }
  return found;
}

static const CagExpr *find_in_arguments(const CagExpr *e, CagSpan span) {
  const CagExpr *found = find_call(e->as.call.callee, span);
  for (size_t i = 0; !found && i < e->as.call.count; i++)
    found = find_call(e->as.call.arguments[i].value, span);
  return found;
}

static const CagExpr *find_below(const CagExpr *e, CagSpan span) {
  const CagExpr *found = NULL;
  switch (e->kind) {
  case CAG_EXPR_TEMPLATE:
  case CAG_EXPR_LIST: return find_in_all(e->as.list.items, e->as.list.count, span);
  case CAG_EXPR_GROUP:
  case CAG_EXPR_SPREAD:
  case CAG_EXPR_NEGATE:
  case CAG_EXPR_NOT: return find_call(e->as.unary.operand, span);
  case CAG_EXPR_COMPREHENSION: return find_in_clauses(e, span);
  case CAG_EXPR_RECORD:
    for (size_t i = 0; !found && i < e->as.record.count; i++)
      found = find_call(e->as.record.fields[i].value, span);
    return found;
  case CAG_EXPR_BLOCK: return find_in_block(e, span);
  case CAG_EXPR_LAMBDA: return find_in_function(e->as.function, span);
  case CAG_EXPR_IF:
    if ((found = find_call(e->as.branch.condition, span))) return found;
    if ((found = find_call(e->as.branch.then, span))) return found;
    return find_call(e->as.branch.otherwise, span);
  case CAG_EXPR_BINARY:
  case CAG_EXPR_AND:
  case CAG_EXPR_OR:
  case CAG_EXPR_PIPE:
  case CAG_EXPR_INDEX:
    found = find_call(e->as.binary.left, span);
    return found ? found : find_call(e->as.binary.right, span);
  case CAG_EXPR_CALL: return find_in_arguments(e, span);
  case CAG_EXPR_MEMBER: return find_call(e->as.member.object, span);
  default: return NULL;
  }
}

// The call or pipe with exactly this span.
static const CagExpr *find_call(const CagExpr *e, CagSpan span) {
  if (!e || !contains(e->span, span)) return NULL;
  const bool whole = e->span.start == span.start && e->span.end == span.end;
  if (whole && (e->kind == CAG_EXPR_CALL || e->kind == CAG_EXPR_PIPE)) return e;
  return find_below(e, span);
}

static const CagModuleUnit *module_of(const CagVm *vm, const CagSource *source) {
  for (size_t i = 0; i < vm->module_count; i++)
    if (vm->modules[i]->source == source && vm->modules[i]->ast) return vm->modules[i];
  return NULL;
}

// --- Arguments ---

// A call or pipe in one form.
typedef struct Written {
  const CagExpr *callee, *piped; // piped: NULL if it is no pipe
  const CagArgument *arguments;
  size_t count;
} Written;

static Written written_call(const CagExpr *e) {
  const CagExpr *call = e;
  Written w = {0};
  if (e->kind == CAG_EXPR_PIPE) {
    w.piped = e->as.binary.left;
    call = e->as.binary.right;
  }
  w.callee = call;
  if (call->kind != CAG_EXPR_CALL) return w;
  w.callee = call->as.call.callee;
  w.arguments = call->as.call.arguments;
  w.count = call->as.call.count;
  return w;
}

static const CagExpr *argument_of(const Written *w, const CagSignature *s, size_t parameter) {
  if (w->piped && parameter == 0) return w->piped;
  const size_t shift = w->piped ? 1 : 0;
  for (size_t i = 0; i < w->count; i++) {
    const CagArgument *a = &w->arguments[i];
    if (a->name ? parameter < s->count && !strcmp(a->name, s->parameters[parameter])
                : i + shift == parameter)
      return a->value;
  }
  return NULL;
}

CagLiteral cag_literal_of_argument(const CagVm *vm, const CagOriginStep *step, size_t parameter) {
  const CagModuleUnit *m = module_of(vm, step->site->source);
  const CagSignature *s = cag_builtin_signature_of(step->site->row);
  const CagExpr *found = NULL;
  for (size_t i = 0; m && s && !found && i < m->ast->count; i++)
    if (contains(m->ast->statements[i]->span, step->site->span))
      found = find_in_statement(m->ast->statements[i], step->site->span);
  if (!found) return unknown;
  const Written w = written_call(found);
  const CagExpr *callee = w.callee;
  while (callee->kind == CAG_EXPR_GROUP) callee = callee->as.unary.operand;
  if (callee->kind != CAG_EXPR_NAME || callee->as.name.binding != CAG_BIND_BUILTIN ||
      callee->as.name.index != step->site->index)
    return unknown;
  return (CagLiteral){m, argument_of(&w, s, parameter)};
}

// --- Names ---

static CagLiteral defined_value(const CagModuleUnit *m, const CagDecl *decl) {
  const CagStatement *s = decl->statement;
  const CagExpr *value = s && s->kind == CAG_STATEMENT_DEFINITION ? cag_tree_value(decl) : NULL;
  return value ? (CagLiteral){m, value} : unknown;
}

static CagLiteral public_value(const CagVm *vm, size_t module, const char *name) {
  if (module >= vm->module_count) return unknown;
  const CagModuleUnit *m = vm->modules[module];
  for (size_t i = 0; m->ast && i < m->public_count; i++) {
    if (strcmp(m->publics[i].name, name) == 0) return defined_value(m, m->publics[i].decl);
  }
  return unknown;
}

// The name of a definition in the module that it was imported from.
static CagLiteral imported_value(const CagVm *vm, const CagDecl *decl) {
  const CagStatement *s = decl->statement;
  for (size_t i = 0; s && i < s->as.import.name_count; i++)
    if (s->as.import.names[i].decl == decl)
      return public_value(vm, s->as.import.module, s->as.import.names[i].name);
  return unknown;
}

static CagLiteral named_value(const CagVm *vm, CagLiteral l) {
  const CagDecl *decl = l.expr->as.name.decl;
  if (l.expr->as.name.binding != CAG_BIND_DECL || !decl) return unknown;
  if (decl->kind == CAG_DECL_IMPORTED) return imported_value(vm, decl);
  const bool defined = decl->kind == CAG_DECL_TOP || decl->kind == CAG_DECL_BLOCK;
  return defined ? defined_value(l.module, decl) : unknown;
}

static CagLiteral member_value(const CagVm *vm, CagLiteral l) {
  const CagExpr *object = l.expr->as.member.object;
  if (object->kind != CAG_EXPR_NAME || object->as.name.binding != CAG_BIND_DECL) return unknown;
  const CagDecl *decl = object->as.name.decl;
  if (!decl || decl->kind != CAG_DECL_IMPORT || !decl->statement) return unknown;
  return public_value(vm, decl->statement->as.import.module, l.expr->as.member.name);
}

static CagLiteral element_at(const CagVm *vm, CagLiteral l) {
  const CagExpr *index = l.expr->as.binary.right;
  const CagLiteral list = cag_literal_resolve(vm, (CagLiteral){l.module, l.expr->as.binary.left});
  if (!list.expr || list.expr->kind != CAG_EXPR_LIST || index->kind != CAG_EXPR_NUMBER)
    return unknown;
  const double i = index->as.number;
  if (!(i >= 0 && i < (double)list.expr->as.list.count)) return unknown;
  for (size_t k = 0; k <= (size_t)i; k++)
    if (list.expr->as.list.items[k]->kind == CAG_EXPR_SPREAD) return unknown;
  return (CagLiteral){list.module, list.expr->as.list.items[(size_t)i]};
}

CagLiteral cag_literal_resolve(const CagVm *vm, CagLiteral l) {
  for (int i = 0; l.expr && i < MOST_NAMES; i++) {
    CagLiteral next = unknown;
    switch (l.expr->kind) {
    case CAG_EXPR_GROUP: next = (CagLiteral){l.module, l.expr->as.unary.operand}; break;
    case CAG_EXPR_BLOCK: next = (CagLiteral){l.module, l.expr->as.block.value}; break;
    case CAG_EXPR_NAME: next = named_value(vm, l); break;
    case CAG_EXPR_MEMBER: next = member_value(vm, l); break;
    case CAG_EXPR_INDEX: next = element_at(vm, l); break;
    default: return l;
    }
    if (!next.expr) return l;
    l = next;
  }
  return l;
}

// --- Elements of lists ---

static size_t count_elements(const CagVm *vm, CagLiteral list, int depth) {
  list = cag_literal_resolve(vm, list);
  if (!list.expr || list.expr->kind != CAG_EXPR_LIST || depth > MOST_NAMES) return NOT_COUNTED;
  size_t n = 0;
  for (size_t i = 0; i < list.expr->as.list.count; i++) {
    const CagExpr *item = list.expr->as.list.items[i];
    size_t more = 1;
    if (item->kind == CAG_EXPR_SPREAD)
      more = count_elements(vm, (CagLiteral){list.module, item->as.unary.operand}, depth + 1);
    if (more == NOT_COUNTED) return more;
    n += more;
  }
  return n;
}

// One spread may have elements that only a run counts: it has those that the others leave.
static void written_elements(const CagVm *vm, CagLiteral list, size_t n, CagLiteral *out) {
  size_t known = 0, uncounted = 0, at = 0;
  const size_t count = list.expr->as.list.count;
  CagExpr *const *items = list.expr->as.list.items;
  for (size_t i = 0; i < count; i++) {
    const CagLiteral item = {list.module, items[i]};
    const CagLiteral spread = {list.module, items[i]->as.unary.operand};
    const size_t more = item.expr->kind == CAG_EXPR_SPREAD ? count_elements(vm, spread, 0) : 1;
    if (more == NOT_COUNTED) uncounted++;
    else known += more;
  }
  if (known > n || uncounted > 1 || (!uncounted && known != n)) return;
  for (size_t i = 0; i < count; i++) {
    if (items[i]->kind != CAG_EXPR_SPREAD) {
      out[at++] = (CagLiteral){list.module, items[i]};
      continue;
    }
    const CagLiteral spread = {list.module, items[i]->as.unary.operand};
    size_t more = count_elements(vm, spread, 0);
    if (more == NOT_COUNTED) more = n - known;
    cag_literal_elements(vm, spread, more, out + at);
    at += more;
  }
}

void cag_literal_elements(const CagVm *vm, CagLiteral list, size_t n, CagLiteral *out) {
  for (size_t i = 0; i < n; i++) out[i] = unknown;
  list = cag_literal_resolve(vm, list);
  if (!list.expr) return;
  if (list.expr->kind == CAG_EXPR_LIST) written_elements(vm, list, n, out);
  if (list.expr->kind != CAG_EXPR_COMPREHENSION) return;
  for (size_t i = 0; i < n; i++)
    out[i] = (CagLiteral){list.module, list.expr->as.comprehension.body};
}

// Between a minus sign and its number, a comment is not overwritten.
static bool follows_sign(const CagSource *source, const CagExpr *negate, const CagExpr *number) {
  for (uint32_t i = negate->span.start + 1; i < number->span.start; i++)
    if (source->text[i] != ' ') return false;
  return true;
}

bool cag_literal_is_number(CagLiteral l, CagSpan *span, double *value) {
  const CagExpr *e = l.expr;
  while (e->kind == CAG_EXPR_GROUP) e = e->as.unary.operand;
  *span = e->span;
  const bool negative = e->kind == CAG_EXPR_NEGATE;
  if (negative) {
    if (!follows_sign(l.module->source, e, e->as.unary.operand)) return false;
    e = e->as.unary.operand;
  }
  if (e->kind != CAG_EXPR_NUMBER) return false;
  *value = negative ? -e->as.number : e->as.number;
  return true;
}
