#include "lang/tree.h"

#include <string.h>

void cag_tree_of_statement(const CagStatement *s, void (*each)(void *context, const CagExpr *e),
                           void *context) {
  switch (s->kind) {
  case CAG_STATEMENT_IMPORT: break;
  case CAG_STATEMENT_PARAM:
    each(context, s->as.param.value);
    if (s->as.param.domain) each(context, s->as.param.domain);
    break;
  case CAG_STATEMENT_DEFINITION: each(context, s->as.definition.value); break;
  case CAG_STATEMENT_SHOW:
  case CAG_STATEMENT_PRINT:
    for (size_t i = 0; i < s->as.list.count; i++) each(context, s->as.list.items[i]);
    break;
  case CAG_STATEMENT_ASSERT:
    each(context, s->as.assertion.condition);
    if (s->as.assertion.message) each(context, s->as.assertion.message);
    break;
  case CAG_STATEMENT_EXPRESSION: each(context, s->as.expression); break;
  }
}

static void below_comprehension(const CagExpr *e, void (*each)(void *context, const CagExpr *e),
                                void *context) {
  for (size_t i = 0; i < e->as.comprehension.count; i++) {
    const CagClause *c = &e->as.comprehension.clauses[i];
    each(context, c->source);
    if (c->filter) each(context, c->filter);
  }
  each(context, e->as.comprehension.body);
}

void cag_tree_below(const CagExpr *e, void (*each)(void *context, const CagExpr *e),
                    void *context) {
  switch (e->kind) {
  case CAG_EXPR_NUMBER:
  case CAG_EXPR_ANGLE:
  case CAG_EXPR_TEXT:
  case CAG_EXPR_TRUE:
  case CAG_EXPR_FALSE:
  case CAG_EXPR_NONE:
  case CAG_EXPR_NAME:
  case CAG_EXPR_ERROR: break;
  case CAG_EXPR_TEMPLATE:
  case CAG_EXPR_LIST:
    for (size_t i = 0; i < e->as.list.count; i++) each(context, e->as.list.items[i]);
    break;
  case CAG_EXPR_GROUP:
  case CAG_EXPR_SPREAD:
  case CAG_EXPR_NEGATE:
  case CAG_EXPR_NOT: each(context, e->as.unary.operand); break;
  case CAG_EXPR_BINARY:
  case CAG_EXPR_AND:
  case CAG_EXPR_OR:
  case CAG_EXPR_PIPE:
  case CAG_EXPR_INDEX:
    each(context, e->as.binary.left);
    each(context, e->as.binary.right);
    break;
  case CAG_EXPR_RANGE:
    each(context, e->as.range.low);
    each(context, e->as.range.high);
    if (e->as.range.step) each(context, e->as.range.step);
    break;
  case CAG_EXPR_IF:
    each(context, e->as.branch.condition);
    each(context, e->as.branch.then);
    each(context, e->as.branch.otherwise);
    break;
  case CAG_EXPR_CALL:
    each(context, e->as.call.callee);
    for (size_t i = 0; i < e->as.call.count; i++) each(context, e->as.call.arguments[i].value);
    break;
  case CAG_EXPR_MEMBER: each(context, e->as.member.object); break;
  case CAG_EXPR_COMPREHENSION: below_comprehension(e, each, context); break;
  case CAG_EXPR_RECORD:
    for (size_t i = 0; i < e->as.record.count; i++) each(context, e->as.record.fields[i].value);
    break;
  case CAG_EXPR_BLOCK:
    for (size_t i = 0; i < e->as.block.count; i++)
      cag_tree_of_statement(e->as.block.statements[i], each, context);
    each(context, e->as.block.value);
    break;
  case CAG_EXPR_LAMBDA:
    for (size_t i = 0; i < e->as.function->parameter_count; i++)
      if (e->as.function->parameters[i].fallback)
        each(context, e->as.function->parameters[i].fallback);
    if (e->as.function->body) each(context, e->as.function->body);
    break;
  }
}

const CagStatement *cag_tree_statement(const CagModuleAst *ast, size_t offset) {
  size_t low = 0, high = ast->count; // statements before `low` start at or before the offset
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (ast->statements[middle]->span.start <= offset) low = middle + 1;
    else high = middle;
  }
  return low ? ast->statements[low - 1] : NULL;
}

// ---- values of names ----

static const CagExpr *written_element(const CagExpr *list, size_t i) {
  if (list->kind != CAG_EXPR_LIST || i >= list->as.list.count) return NULL;
  for (size_t k = 0; k <= i; k++)
    if (list->as.list.items[k]->kind == CAG_EXPR_SPREAD) return NULL;
  return list->as.list.items[i];
}

static const CagExpr *written_field(const CagExpr *record, const char *name) {
  const CagExpr *value = NULL;
  for (size_t i = 0; record->kind == CAG_EXPR_RECORD && i < record->as.record.count; i++) {
    const CagField *f = &record->as.record.fields[i];
    if (!f->name) value = NULL; // a spread may replace the fields before it
    else if (strcmp(f->name, name) == 0) value = f->value;
  }
  return value;
}

const CagExpr *cag_tree_part(const CagPattern *pattern, size_t i, const CagExpr *value) {
  while (value && value->kind == CAG_EXPR_GROUP) value = value->as.unary.operand;
  if (!value) return NULL;
  const char *field = pattern->parts[i].field;
  return field ? written_field(value, field) : written_element(value, i);
}

// Finds the part of the value that a name of the pattern stands for. Returns false if the name is
// not in the pattern.
static bool find_part(const CagPattern *pattern, const CagDecl *decl, const CagExpr *value,
                      const CagExpr **out) {
  if (pattern->kind == CAG_PATTERN_NAME) {
    *out = value;
    return pattern->decl == decl;
  }
  for (size_t i = 0; i < pattern->count; i++)
    if (find_part(pattern->parts[i].pattern, decl, cag_tree_part(pattern, i, value), out))
      return true;
  *out = NULL;
  return pattern->rest == decl;
}

const CagExpr *cag_tree_value(const CagDecl *decl) {
  const CagStatement *s = decl->statement;
  const CagExpr *value = NULL;
  if (!s) return NULL;
  if (s->kind == CAG_STATEMENT_PARAM) return s->as.param.value;
  if (s->kind != CAG_STATEMENT_DEFINITION) return NULL;
  if (decl == s->as.definition.decl) return s->as.definition.value;
  return find_part(s->as.definition.pattern, decl, s->as.definition.value, &value) ? value : NULL;
}
