// Checks the statements of a module, and finds unused definitions.

#include "interp/check/check.h"

#include <string.h>

#include "interp/check/circle.h"
#include "interp/check/walk.h"

// ---- the module ----

// Reads a number literal with its sign. Returns false for anything else.
static bool literal(const CagExpr *e, double *x) {
  const bool negative = e->kind == CAG_EXPR_NEGATE;
  if (negative) e = e->as.unary.operand;
  if (e->kind != CAG_EXPR_NUMBER && e->kind != CAG_EXPR_ANGLE) return false;
  *x = negative ? -e->as.number : e->as.number;
  return true;
}

// Tests whether a literal default is of another type than its range, or not in its list.
static bool is_elsewhere(const CagExpr *value, const CagExpr *domain) {
  double x, y;
  const bool word = value->kind == CAG_EXPR_TEXT, number = literal(value, &x);
  if (domain->kind == CAG_EXPR_RANGE) return word;
  if (domain->kind != CAG_EXPR_LIST || (!word && !number)) return false;
  for (size_t i = 0; i < domain->as.list.count; i++) {
    const CagExpr *e = domain->as.list.items[i];
    const bool same_word = word && e->kind == CAG_EXPR_TEXT;
    if (e->kind != CAG_EXPR_TEXT && !literal(e, &y)) return false; // not known
    if (same_word && strcmp(e->as.text.bytes, value->as.text.bytes) == 0) return false;
    if (number && literal(e, &y) && x == y && e->kind == value->kind) return false;
  }
  return true;
}

static void check_param(Check *c, const CagStatement *s) {
  const CagExpr *domain = s->as.param.domain;
  double value, low, high;
  char text[256];
  if (domain && is_elsewhere(s->as.param.value, domain)) {
    snprintf(text, sizeof text, "the default of %s is not in %s", s->as.param.decl->name,
             domain->kind == CAG_EXPR_LIST ? "the list of allowed values" : "its range");
    cag_check_report(c, CAG_ERR_param_default, s->as.param.value->span, text);
    return;
  }
  if (!domain || domain->kind != CAG_EXPR_RANGE || !literal(s->as.param.value, &value) ||
      !literal(domain->as.range.low, &low) || !literal(domain->as.range.high, &high))
    return;
  if (value >= low && (domain->as.range.open ? value < high : value <= high)) return;
  snprintf(text, sizeof text, "the default of %s lies outside of its range",
           s->as.param.decl->name);
  cag_check_report(c, CAG_ERR_param_default, s->as.param.value->span, text);
}

static void check_shown(Check *c, const CagExpr *e) {
  const CagTypes unseen = CAG_TYPES(NUMBER) | CAG_TYPES(ANGLE) | CAG_TYPES(BOOL) | CAG_TYPES(TEXT) |
                          CAG_TYPES(NONE) | CAG_TYPES_FUNCTION;
  const CagTypes types = cag_check_infer(c, e);
  if (types & ~unseen) return;
  cag_check_report_found(c, CAG_ERR_no_image, e->span,
                         "show expects shapes, images, lights, cameras, or settings of the scene",
                         types);
}

static void walk_statement(Check *c, const CagStatement *s) {
  if (s->damage != CAG_SOUND) return;
  switch (s->kind) {
  case CAG_STATEMENT_PARAM:
    cag_check_types_of_top(c, s->as.param.decl);
    check_param(c, s);
    break;
  case CAG_STATEMENT_DEFINITION: cag_check_types_of_top(c, s->as.definition.decl); break;
  case CAG_STATEMENT_SHOW:
    for (size_t i = 0; i < s->as.list.count; i++) check_shown(c, s->as.list.items[i]);
    break;
  case CAG_STATEMENT_PRINT: cag_check_infer_all(c, s->as.list.items, s->as.list.count); break;
  case CAG_STATEMENT_ASSERT:
    cag_check_expect_bool(c, s->as.assertion.condition, "assert");
    if (s->as.assertion.message) cag_check_infer(c, s->as.assertion.message);
    break;
  case CAG_STATEMENT_EXPRESSION: cag_check_infer(c, s->as.expression); break;
  case CAG_STATEMENT_IMPORT: break;
  }
}

// Marks the definitions that statements use, directly or indirectly. If a module shows and prints
// nothing, all its public definitions count as used.
static void mark_reached(Check *c, bool is_script) {
  const size_t n = c->ast->top_count;
  for (size_t i = 0; i < n; i++)
    if (!is_script && c->ast->tops[i]->name[0] != '_')
      c->reached[i] = true; // the whole of a pattern, too
  for (size_t i = 0; i < c->edge_count; i++)
    if (c->edges[2 * i] == n) c->reached[c->edges[2 * i + 1]] = true;
  for (bool more = true; more;) {
    more = false;
    for (size_t i = 0; i < c->edge_count; i++) {
      const size_t user = c->edges[2 * i], used = c->edges[2 * i + 1];
      if (user == n || !c->reached[user] || c->reached[used]) continue;
      c->reached[used] = more = true;
    }
  }
}

static void warn_unused(Check *c) {
  char text[256];
  bool is_script = false;
  for (size_t i = 0; i < c->ast->count; i++) {
    const CagStatement *s = c->ast->statements[i];
    is_script = is_script || s->kind == CAG_STATEMENT_SHOW || s->kind == CAG_STATEMENT_PRINT;
  }
  mark_reached(c, is_script);
  for (size_t i = 0; i < c->ast->top_count; i++) {
    const CagDecl *decl = c->ast->tops[i];
    if (decl->whole) continue;
    if (c->reached[i] || (decl->statement->kind == CAG_STATEMENT_PARAM && decl->used)) continue;
    snprintf(text, sizeof text,
             decl->used ? "%s is used only by unused definitions" : "%s is not used", decl->name);
    cag_check_warn(c, CAG_ERR_unused, decl->span, text);
  }
  for (size_t i = 0; i < c->ast->count; i++) {
    const CagStatement *s = c->ast->statements[i];
    if (s->kind != CAG_STATEMENT_IMPORT) continue;
    if (s->as.import.decl && !s->as.import.decl->used && s->as.import.name_count == 0) {
      snprintf(text, sizeof text, "the module %s is not used", s->as.import.decl->name);
      cag_check_warn(c, CAG_ERR_unused, s->as.import.path_span, text);
    }
    for (size_t k = 0; k < s->as.import.name_count; k++) {
      const CagDecl *decl = s->as.import.names[k].decl;
      if (decl->used) continue;
      snprintf(text, sizeof text, "%s is not used", decl->name);
      cag_check_warn(c, CAG_ERR_unused, decl->span, text);
    }
  }
}

// Marks definitions that are not evaluated: those that contain an error numbered `from` or higher,
// and those damaged by syntax errors.
static void mark_bad(Check *c, size_t from) {
  for (size_t k = 0; k < c->ast->top_count; k++)
    c->top_bad[k] = c->ast->tops[k]->statement->damage != CAG_SOUND;
  for (size_t i = from; i < c->vm->errors.count; i++)
    for (size_t k = 0; k < c->ast->top_count; k++) {
      const CagSpan s = c->ast->tops[k]->statement->span,
                    at = cag_diagnostics_at(&c->vm->errors, i)->span;
      if (s.start <= at.start && at.end <= s.end) c->top_bad[k] = true;
    }
}

static void free_check(void *context) {
  Check *c = context;
  cag_arena_free(&c->memory);
  cag_diagnostics_clear(&c->ignored);
}

bool cag_check_module(CagVm *vm, CagModuleUnit *m) { return cag_check_module_types(vm, m, NULL); }

bool cag_check_module_types(CagVm *vm, CagModuleUnit *m, CagTypes *types) {
  const size_t n = m->ast->top_count, known = vm->errors.count;
  Check c = {.vm = vm, .unit = m, .ast = m->ast, .top = n};
  CagCleanup cleanup;
  cag_cleanup_push(&cleanup, free_check, &c);
  c.top_types = cag_arena_alloc(&c.memory, (n + 1) * sizeof *c.top_types);
  c.top_done = cag_arena_alloc(&c.memory, n + 1);
  c.top_busy = cag_arena_alloc(&c.memory, n + 1);
  c.reached = cag_arena_alloc(&c.memory, n + 1);
  c.top_bad = cag_arena_alloc(&c.memory, n + 1);
  c.constants = (CagConstants){.vm = vm, .unit = m, .is_bad = c.top_bad};
  vm->failed = false;
  cag_check_circles(m->ast, &vm->errors);
  mark_bad(&c, known);
  for (size_t i = 0; i < m->ast->count; i++) walk_statement(&c, m->ast->statements[i]);
  // Unused names are reported only if everything was read and all names are known. Otherwise an
  // unknown name or unread text may be a use.
  if (m->sound && known == m->first_error) warn_unused(&c);
  cag_diagnostics_sort_last(&vm->errors);
  for (size_t i = 0; types && i < n; i++) types[i] = c.top_done[i] ? c.top_types[i] : CAG_TYPES_ANY;
  cag_cleanup_run(&cleanup);
  for (size_t i = known; i < vm->errors.count; i++)
    if (cag_diagnostics_at(&vm->errors, i)->severity == CAG_SEVERITY_ERROR) return false;
  return true;
}
