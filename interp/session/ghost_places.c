// Which shape an expression of the script stands for.
//
// Calls and operators are known by their location, which the shapes that they made have in their
// origins. Other expressions are known by what is done with them: the second operand of a
// difference is the operand that the difference has. A name that is used in no such way stands for
// its definition.

#include <string.h>

#include "base/memory.h"
#include "interp/session/ghosts.h"
#include "lang/tree.h"

enum { MOST_AROUND = 64, MOST_STEPS = 16 };

typedef struct Search {
  const CagSession *session;
  const CagGhosts *all;
  size_t *found, count;
  const CagModuleUnit *unit;
  uint32_t offset;
  // The expressions around the offset, the outermost first. Of deeper ones, the innermost are left
  // out.
  const CagExpr *around[MOST_AROUND];
  size_t depth;
} Search;

// --- Locations ---

static const CagModuleUnit *unit_of_file(const CagVm *vm, const char *file) {
  for (size_t i = 0; i < vm->module_count; i++) {
    const CagModuleUnit *m = vm->modules[i];
    if (m->source && m->ast && !m->source->library && !strcmp(m->source->name, file)) return m;
  }
  return NULL;
}

static bool offset_of(const CagSource *s, size_t line, size_t column, uint32_t *out) {
  size_t length, at = 0;
  const char *text = cag_source_line(s, line, &length);
  if (line == 0 || line > s->line_count || column == 0) return false;
  for (size_t k = 1; k < column && at < length; k++) {
    at++;
    while (at < length && ((unsigned char)text[at] & 0xc0) == 0x80) at++; // within a code point
  }
  *out = (uint32_t)((size_t)(text - s->text) + at);
  return true;
}

static bool is_same_span(CagSpan a, CagSpan b) { return a.start == b.start && a.end == b.end; }

// Whether a call is that of an expression, or is made by the library for it.
static bool is_step_at(const CagOriginStep *step, const CagSource *source, CagSpan span) {
  if (!step) return false;
  const CagOriginSite *at = step->site;
  return (at->source == source && is_same_span(at->span, span)) ||
         (at->caller == source && is_same_span(at->caller_span, span));
}

static void look_below(void *context, const CagExpr *e) {
  Search *s = context;
  if (e->span.start > s->offset || s->offset > e->span.end || s->depth == MOST_AROUND) return;
  // Of two that touch at the offset, the later one counts.
  if (s->depth > 0 && s->around[s->depth - 1]->span.end <= e->span.start)
    while (s->depth > 0 && s->around[s->depth - 1]->span.end <= e->span.start) s->depth--;
  s->around[s->depth++] = e;
  cag_tree_below(e, look_below, s);
}

// The name that a definition defines stands for its value.
static void look_around(Search *s) {
  const CagStatement *st = cag_tree_statement(s->unit->ast, s->offset);
  s->depth = 0;
  if (!st || s->offset > st->span.end) return;
  cag_tree_of_statement(st, look_below, s);
  const CagDecl *decl = st->kind == CAG_STATEMENT_DEFINITION ? st->as.definition.decl
                        : st->kind == CAG_STATEMENT_PARAM    ? st->as.param.decl
                                                             : NULL;
  if (s->depth > 0 || !decl || s->offset > decl->span.end) return;
  s->around[s->depth++] =
      st->kind == CAG_STATEMENT_PARAM ? st->as.param.value : st->as.definition.value;
}

// --- Matching ---

static void add_found(Search *s, size_t i) { s->found[s->count++] = i; }

// States after a call. A call in the library may do several things; the last one counts.
static bool match_call(Search *s, const CagSource *source, const CagExpr *e) {
  const size_t before = s->count;
  for (size_t i = 0; i < s->all->count; i++) {
    const CagGhost *g = &s->all->items[i];
    if (is_step_at(g->step, source, e->span) && !is_step_at(g->next, source, e->span) &&
        !(g->next == NULL && is_step_at(g->user, source, e->span)))
      add_found(s, i);
  }
  return s->count > before;
}

// Arguments of a call or operator: of a pipe, what is piped comes first.
typedef struct Uses {
  const CagExpr *items[MOST_AROUND];
  bool named[MOST_AROUND];
  size_t count;
} Uses;

static void add_use(Uses *u, const CagExpr *e, bool named) {
  if (u->count == MOST_AROUND) return;
  u->named[u->count] = named;
  u->items[u->count++] = e;
}

static void list_uses(const CagExpr *e, Uses *out) {
  const CagExpr *call = e;
  out->count = 0;
  if (e->kind == CAG_EXPR_BINARY) {
    add_use(out, e->as.binary.left, false);
    add_use(out, e->as.binary.right, false);
    return;
  }
  if (e->kind == CAG_EXPR_PIPE) {
    add_use(out, e->as.binary.left, false);
    call = e->as.binary.right;
  }
  if (call->kind != CAG_EXPR_CALL) return;
  for (size_t i = 0; i < call->as.call.count; i++)
    add_use(out, call->as.call.arguments[i].value, call->as.call.arguments[i].name != NULL);
}

// Whether an operand of a set operation with `count` operands is argument k of n. If there are more
// operands than arguments, the first argument was dissolved into several.
static bool is_operand_of(size_t operand, size_t count, size_t k, size_t n) {
  if (count < n) return false;
  const size_t more = count - n;
  return k == 0 ? operand <= more : operand == k + more;
}

static bool is_use(const CagGhost *g, const CagSource *source, const CagExpr *user, const Uses *u,
                   size_t k) {
  const bool maps = user->kind == CAG_EXPR_BINARY && user->as.binary.op == CAG_OP_MULTIPLY;
  if (g->next) return is_step_at(g->next, source, user->span) && k == (maps ? 1 : 0);
  if (!is_step_at(g->user, source, user->span)) return false;
  if (g->operand_count > 0) return is_operand_of(g->operand, g->operand_count, k, u->count);
  return u->named[k] || g->parameter == k;
}

// States that the expression around e uses in the place of e. Of a dissolved operand, its own
// operands are found.
static bool match_use(Search *s, const CagSource *source, const CagExpr *e, const CagExpr *user) {
  const size_t before = s->count;
  Uses u;
  list_uses(user, &u);
  for (size_t k = 0; k < u.count; k++) {
    if (u.items[k] != e) continue;
    for (size_t i = 0; i < s->all->count; i++)
      if (is_use(&s->all->items[i], source, user, &u, k)) add_found(s, i);
  }
  return s->count > before;
}

// --- Names ---

static bool match_value(Search *s, const CagModuleUnit *unit, const CagExpr *e, int left);

static bool match_public(Search *s, const CagModuleUnit *unit, const char *name, int left) {
  for (size_t i = 0; unit && i < unit->public_count; i++) {
    if (strcmp(unit->publics[i].name, name) != 0) continue;
    const CagExpr *value = cag_tree_value(unit->publics[i].decl);
    return value && match_value(s, unit, value, left);
  }
  return false;
}

static const CagModuleUnit *imported_unit(const CagVm *vm, const CagDecl *decl) {
  const CagStatement *st = decl->statement;
  if (!st || st->kind != CAG_STATEMENT_IMPORT || st->as.import.module >= vm->module_count)
    return NULL;
  return vm->modules[st->as.import.module];
}

static bool match_name(Search *s, const CagModuleUnit *unit, const CagDecl *decl, int left) {
  if (decl->kind == CAG_DECL_IMPORTED)
    return match_public(s, imported_unit(s->session->vm, decl), decl->name, left);
  if (decl->kind != CAG_DECL_TOP && decl->kind != CAG_DECL_BLOCK) return false;
  const CagExpr *value = cag_tree_value(decl);
  return value && match_value(s, unit, value, left);
}

static const CagExpr *callee_of(const CagExpr *e) {
  if (e->kind == CAG_EXPR_CALL) return e->as.call.callee;
  const CagExpr *right = e->as.binary.right;
  return right->kind == CAG_EXPR_CALL ? right->as.call.callee : right;
}

// The states that the value of an expression may be: those after the call that it ends with.
// `left` bounds the number of definitions that are followed.
static bool match_value(Search *s, const CagModuleUnit *unit, const CagExpr *e, int left) {
  if (left == 0) return false;
  switch (e->kind) {
  case CAG_EXPR_GROUP: return match_value(s, unit, e->as.unary.operand, left - 1);
  case CAG_EXPR_BLOCK: return match_value(s, unit, e->as.block.value, left - 1);
  case CAG_EXPR_LAMBDA:
    return e->as.function->body && match_value(s, unit, e->as.function->body, left - 1);
  case CAG_EXPR_IF:
    // Only the branch that was taken has made a shape.
    return match_value(s, unit, e->as.branch.then, left - 1) ||
           match_value(s, unit, e->as.branch.otherwise, left - 1);
  case CAG_EXPR_NAME:
    return e->as.name.binding == CAG_BIND_DECL && e->as.name.decl &&
           match_name(s, unit, e->as.name.decl, left - 1);
  case CAG_EXPR_MEMBER:
    return e->as.member.object->kind == CAG_EXPR_NAME &&
           e->as.member.object->as.name.binding == CAG_BIND_DECL &&
           match_public(s, imported_unit(s->session->vm, e->as.member.object->as.name.decl),
                        e->as.member.name, left - 1);
  case CAG_EXPR_CALL:
  case CAG_EXPR_PIPE:
    return match_call(s, unit->source, e) || match_value(s, unit, callee_of(e), left - 1);
  case CAG_EXPR_BINARY: return match_call(s, unit->source, e);
  default: return false;
  }
}

// The expression that uses e, without the parentheses around e. *inner is e with them.
static const CagExpr *user_of(const Search *s, size_t i, const CagExpr **inner) {
  *inner = s->around[i];
  while (i > 0 && s->around[i - 1]->kind == CAG_EXPR_GROUP) *inner = s->around[--i];
  if (i == 0) return NULL;
  const CagExpr *user = s->around[i - 1];
  // In a |> f(b), b is an argument of the pipe.
  const bool piped = user->kind == CAG_EXPR_CALL && i > 1 &&
                     s->around[i - 2]->kind == CAG_EXPR_PIPE &&
                     s->around[i - 2]->as.binary.right == user && *inner != user->as.call.callee;
  return piped ? s->around[i - 2] : user;
}

bool cag_ghosts_at(const CagSession *session, const CagGhosts *all, const char *file, size_t line,
                   size_t column, size_t **found, size_t *count) {
  Search s = {.session = session, .all = all};
  *found = NULL;
  *count = 0;
  s.unit = unit_of_file(session->vm, file);
  if (!s.unit || !offset_of(s.unit->source, line, column, &s.offset)) return false;
  // Each of the steps below adds a state at most once.
  s.found = cag_calloc(3 * all->count + 1, sizeof *s.found);
  if (!s.found) return false;
  look_around(&s);
  for (size_t i = s.depth; i-- > 0 && s.count == 0;) {
    const CagExpr *e = s.around[i], *inner, *user = user_of(&s, i, &inner);
    if (match_call(&s, s.unit->source, e)) break;
    if (user && match_use(&s, s.unit->source, inner, user)) break;
    match_value(&s, s.unit, e, MOST_STEPS);
  }
  *found = s.found;
  *count = s.count;
  return s.count > 0;
}
