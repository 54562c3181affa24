// Type inference for expressions.

#include "interp/check/walk.h"

#include <stdio.h>
#include <string.h>

#include "lang/foreign.h"
#include "lang/tree.h"

// ---- expressions ----

void cag_check_expect_bool(Check *c, const CagExpr *e, const char *of) {
  char found[256], text[320];
  const CagTypes types = cag_check_infer(c, e);
  if (types & CAG_TYPES(BOOL)) return;
  snprintf(text, sizeof text, "%s expects true or false, found %s", of,
           cag_types_text(types, found, sizeof found));
  cag_check_report(c, CAG_ERR_condition, e->span, text);
}

static CagTypes infer_binary(Check *c, const CagExpr *e) {
  char left[256], right[256], text[600];
  const CagTypes a = cag_check_infer(c, e->as.binary.left),
                 b = cag_check_infer(c, e->as.binary.right);
  const CagTypes result = cag_types_joined(e->as.binary.op, a, b);
  if (result) return result;
  const CagSpan op = e->as.binary.op_span;
  snprintf(text, sizeof text, "cannot apply %.*s to %s and %s", (int)(op.end - op.start),
           c->ast->source->text + op.start, cag_types_text(a, left, sizeof left),
           cag_types_text(b, right, sizeof right));
  CagDiagnostic *d = cag_check_report(c, CAG_ERR_operand, e->span, text);
  const bool mixed = (a | b) == (CAG_TYPES(NUMBER) | CAG_TYPES(ANGLE));
  const CagExpr *number = a == CAG_TYPES(NUMBER) ? e->as.binary.left : e->as.binary.right;
  if (mixed)
    cag_diagnostic_set_help(d, "write the number with a unit: %.15gdeg",
                            number->kind == CAG_EXPR_NUMBER ? number->as.number : 30);
  return CAG_TYPES_ANY;
}

static CagTypes infer_branch(Check *c, const CagExpr *e) {
  CagTypes types = 0;
  for (; e->kind == CAG_EXPR_IF; e = e->as.branch.otherwise) {
    const CagExpr *condition = e->as.branch.condition;
    cag_check_expect_bool(c, condition, "if");
    if (condition->kind == CAG_EXPR_TRUE)
      cag_check_warn(c, CAG_ERR_never_reached, e->as.branch.otherwise->span,
                     "this is unreachable: the condition is always true");
    if (condition->kind == CAG_EXPR_FALSE)
      cag_check_warn(c, CAG_ERR_never_reached, e->as.branch.then->span,
                     "this is unreachable: the condition is always false");
    types |= cag_check_infer(c, e->as.branch.then);
  }
  return types | cag_check_infer(c, e);
}

// Returns the types of the elements of a list, range, or text.
static CagTypes types_of_elements(const CagExpr *source, CagTypes types) {
  if (source->kind == CAG_EXPR_RANGE && source->as.range.low->kind == CAG_EXPR_NUMBER)
    return CAG_TYPES(NUMBER);
  if (source->kind == CAG_EXPR_RANGE && source->as.range.low->kind == CAG_EXPR_ANGLE)
    return CAG_TYPES(ANGLE);
  return types == CAG_TYPES(TEXT) ? CAG_TYPES(TEXT) : CAG_TYPES_ANY;
}

// Returns the types of a part of a value, without reporting what is wrong in it again.
static CagTypes types_of_part(Check *c, const CagExpr *part) {
  if (!part || c->again) return CAG_TYPES_ANY;
  c->unjudged++;
  c->again = true;
  const CagTypes types = cag_check_infer(c, part);
  c->again = false;
  c->unjudged--;
  return types;
}

// Reports a list that is written with another number of elements, and a record that is written
// without a field. Values with spreads are not checked.
static void check_written(Check *c, const CagPattern *pattern, const CagExpr *value) {
  char of[64], text[256];
  while (value && value->kind == CAG_EXPR_GROUP) value = value->as.unary.operand;
  const bool list = pattern->kind == CAG_PATTERN_LIST;
  if (!value || value->kind != (list ? CAG_EXPR_LIST : CAG_EXPR_RECORD)) return;
  const size_t n = list ? value->as.list.count : value->as.record.count;
  for (size_t i = 0; i < n; i++)
    if (list ? value->as.list.items[i]->kind == CAG_EXPR_SPREAD : !value->as.record.fields[i].name)
      return;
  cag_source_excerpt(c->ast->source, pattern->span, of, sizeof of);
  if (list && (pattern->rest ? n < pattern->count : n != pattern->count)) {
    snprintf(text, sizeof text, "the pattern %s expects a list of %s%zu element%s, found %zu", of,
             pattern->rest ? "at least " : "", pattern->count, pattern->count == 1 ? "" : "s", n);
    cag_check_report(c, CAG_ERR_pattern, value->span, text);
  }
  for (size_t i = 0; !list && i < pattern->count; i++) {
    if (cag_tree_part(pattern, i, value)) continue;
    snprintf(text, sizeof text, "the pattern %s expects the field `%s`, missing here", of,
             pattern->parts[i].field);
    cag_check_report(c, CAG_ERR_pattern, value->span, text);
  }
}

void cag_check_learn_pattern(Check *c, const CagPattern *pattern, CagTypes types,
                             const CagExpr *value) {
  const CagTypes taken =
      pattern->kind == CAG_PATTERN_RECORD ? CAG_TYPES(RECORD) : CAG_TYPES(LIST) | CAG_TYPES(RANGE);
  char of[64], found[256], text[400];
  if (pattern->kind == CAG_PATTERN_NAME) {
    cag_check_learn(c, pattern->decl, types);
    return;
  }
  if (!(types & taken)) {
    snprintf(text, sizeof text, "the pattern %s expects %s, found %s",
             (cag_source_excerpt(c->ast->source, pattern->span, of, sizeof of), of),
             pattern->kind == CAG_PATTERN_RECORD ? "a record" : "a list",
             cag_types_text(types, found, sizeof found));
    cag_check_report(c, CAG_ERR_pattern, value ? value->span : pattern->span, text);
  }
  check_written(c, pattern, value);
  const CagTypes elements = value ? types_of_elements(value, types) : CAG_TYPES_ANY;
  for (size_t i = 0; i < pattern->count; i++) {
    const CagExpr *part = cag_tree_part(pattern, i, value);
    const CagTypes inner = part ? types_of_part(c, part) : elements;
    cag_check_learn_pattern(c, pattern->parts[i].pattern, inner, part);
  }
  if (pattern->rest) cag_check_learn(c, pattern->rest, CAG_TYPES(LIST));
}

static CagTypes infer_comprehension(Check *c, const CagExpr *e) {
  for (size_t i = 0; i < e->as.comprehension.count; i++) {
    const CagClause *clause = &e->as.comprehension.clauses[i];
    const CagTypes source = cag_check_infer(c, clause->source),
                   types = types_of_elements(clause->source, source);
    if (!(source & CAG_TYPES_LOOPED))
      cag_check_report_found(c, CAG_ERR_type, clause->source->span,
                             "a comprehension needs a list, range, text, or record", source);
    cag_check_learn_pattern(c, clause->pattern,
                            source == CAG_TYPES(RECORD) ? CAG_TYPES(LIST) : types, NULL);
    if (clause->filter) cag_check_expect_bool(c, clause->filter, "the condition");
  }
  cag_check_infer(c, e->as.comprehension.body);
  return CAG_TYPES(LIST);
}

static void walk_function(Check *c, const CagFunctionAst *fn) {
  for (size_t i = 0; i < fn->parameter_count; i++) {
    cag_check_learn(c, fn->parameters[i].decl, CAG_TYPES_ANY);
    if (fn->parameters[i].pattern)
      cag_check_learn_pattern(c, fn->parameters[i].pattern, CAG_TYPES_ANY, NULL);
    if (fn->parameters[i].fallback) cag_check_infer(c, fn->parameters[i].fallback);
  }
  const bool thunk = fn->parameter_count == 0;
  c->thunks += thunk;
  cag_check_infer(c, fn->body);
  c->thunks -= thunk;
}

static void warn_unused_in_block(Check *c, const CagDecl *decl) {
  char text[256];
  if (decl->used || decl->name[0] == '_') return;
  snprintf(text, sizeof text, "%s is not used", decl->name);
  cag_check_warn(c, CAG_ERR_unused, decl->span, text);
}

static CagTypes infer_block(Check *c, const CagExpr *e) {
  for (size_t i = 0; i < e->as.block.count; i++) {
    const CagStatement *s = e->as.block.statements[i];
    if (s->kind == CAG_STATEMENT_ASSERT) {
      cag_check_expect_bool(c, s->as.assertion.condition, "assert");
      if (s->as.assertion.message) cag_check_infer(c, s->as.assertion.message);
      continue;
    }
    const CagDecl *decl = s->as.definition.decl;
    const CagPattern *pattern = s->as.definition.pattern;
    cag_check_learn(c, decl, CAG_TYPES_ANY); // recursion
    const CagTypes types = cag_check_infer(c, s->as.definition.value);
    cag_check_learn(c, decl, types);
    if (!pattern) warn_unused_in_block(c, decl);
    else cag_check_learn_pattern(c, pattern, types, s->as.definition.value);
    for (size_t k = 0; pattern && k < pattern->name_count; k++)
      warn_unused_in_block(c, pattern->names[k]);
  }
  return cag_check_infer(c, e->as.block.value);
}

static CagTypes infer_index(Check *c, const CagExpr *e) {
  const CagTypes indexable =
      CAG_TYPES(LIST) | CAG_TYPES(RANGE) | CAG_TYPES(TEXT) | CAG_TYPES(RECORD);
  char found[256], text[320];
  const CagTypes types = cag_check_infer(c, e->as.binary.left);
  cag_check_infer(c, e->as.binary.right);
  if (types & indexable) return types == CAG_TYPES(TEXT) ? types : CAG_TYPES_ANY;
  snprintf(text, sizeof text, "[ ] expects a list, a range, a text, or a record, found %s",
           cag_types_text(types, found, sizeof found));
  cag_check_report(c, CAG_ERR_type, e->as.binary.left->span, text);
  return CAG_TYPES_ANY;
}

static CagTypes infer_negation(Check *c, const CagExpr *e) {
  const CagTypes wrong =
      CAG_TYPES(TEXT) | CAG_TYPES(BOOL) | CAG_TYPES(NONE) | CAG_TYPES(RECORD) | CAG_TYPES_FUNCTION;
  char found[256], text[320];
  const CagTypes types = cag_check_infer(c, e->as.unary.operand);
  if (types & ~wrong) return types & ~wrong;
  snprintf(text, sizeof text, "- does not take %s", cag_types_text(types, found, sizeof found));
  cag_check_report(c, CAG_ERR_operand, e->span, text);
  return CAG_TYPES_ANY;
}

// Reports a range from a number to an angle or vice versa.
static void check_mixed_range(Check *c, const CagExpr *e, CagTypes low, CagTypes high) {
  char text[320];
  if (!((low == CAG_TYPES(NUMBER) && high == CAG_TYPES(ANGLE)) ||
        (low == CAG_TYPES(ANGLE) && high == CAG_TYPES(NUMBER))))
    return;
  const CagExpr *number = low == CAG_TYPES(NUMBER) ? e->as.range.low : e->as.range.high;
  snprintf(text, sizeof text, "a range needs two numbers or two angles, found %s and %s",
           low == CAG_TYPES(NUMBER) ? "a number" : "an angle",
           high == CAG_TYPES(NUMBER) ? "a number" : "an angle");
  CagDiagnostic *d = cag_check_report(c, CAG_ERR_type, e->span, text);
  if (number->kind == CAG_EXPR_NUMBER)
    cag_diagnostic_set_help(d, "write the number with a unit: %.15gdeg", number->as.number);
}

static CagTypes infer_range(Check *c, const CagExpr *e) {
  const CagExpr *ends[] = {e->as.range.low, e->as.range.high, e->as.range.step};
  char found[256], text[320];
  CagTypes types[3] = {0};
  bool known = true;
  for (int i = 0; i < 3 && ends[i]; i++) {
    types[i] = cag_check_infer(c, ends[i]);
    if (types[i] & (CAG_TYPES(NUMBER) | CAG_TYPES(ANGLE))) continue;
    snprintf(text, sizeof text,
             "the ends and the step of a range must be numbers or angles, found %s",
             cag_types_text(types[i], found, sizeof found));
    cag_check_report(c, CAG_ERR_type, ends[i]->span, text);
    known = false;
  }
  if (known) check_mixed_range(c, e, types[0], types[1]);
  return CAG_TYPES(RANGE);
}

void cag_check_infer_all(Check *c, CagExpr *const *items, size_t count) {
  for (size_t i = 0; i < count; i++) cag_check_infer(c, items[i]);
}

// Checks members of values that have few or none, such as vectors and ranges.
static void check_member(Check *c, const CagExpr *e, CagTypes types) {
  static const char *const ends[] = {"start", "end", "step"};
  const CagTypes none = CAG_TYPES(NUMBER) | CAG_TYPES(ANGLE) | CAG_TYPES(BOOL) | CAG_TYPES(TEXT) |
                        CAG_TYPES(NONE) | CAG_TYPES_FUNCTION;
  const char *name = e->as.member.name;
  char found[256], text[400];
  bool known = types & ~(none | CAG_TYPES(LIST) | CAG_TYPES(RANGE));
  if (types & CAG_TYPES(LIST)) known |= strlen(name) == 1 && strchr("xyzw", *name);
  for (size_t i = 0; types & CAG_TYPES(RANGE) && i < 3; i++) known |= strcmp(name, ends[i]) == 0;
  if (types & CAG_TYPES(RANGE))
    known |= strlen(name) == 1 && strchr("xyzw", *name); // as for a
                                                         // list
  if (known) return;
  snprintf(text, sizeof text, "%s has no member `%s`", cag_types_text(types, found, sizeof found),
           name);
  CagDiagnostic *d = cag_check_report(c, CAG_ERR_field, e->as.member.name_span, text);
  if (cag_foreign_member(name)) cag_diagnostic_set_help(d, "write %s", cag_foreign_member(name));
  else if (cag_builtin_find(name) != (size_t)-1)
    cag_diagnostic_set_help(d, "a function comes after |>: write x |> %s(...)", name);
}

CagTypes cag_check_infer(Check *c, const CagExpr *e) {
  switch (e->kind) {
  case CAG_EXPR_NUMBER: return CAG_TYPES(NUMBER);
  case CAG_EXPR_ANGLE: return CAG_TYPES(ANGLE);
  case CAG_EXPR_TEXT: return CAG_TYPES(TEXT);
  case CAG_EXPR_TEMPLATE:
    cag_check_infer_all(c, e->as.list.items, e->as.list.count);
    return CAG_TYPES(TEXT);
  case CAG_EXPR_TRUE:
  case CAG_EXPR_FALSE: return CAG_TYPES(BOOL);
  case CAG_EXPR_NONE: return CAG_TYPES(NONE);
  case CAG_EXPR_NAME: return cag_check_infer_name(c, e);
  case CAG_EXPR_GROUP: return cag_check_infer(c, e->as.unary.operand);
  case CAG_EXPR_SPREAD: cag_check_infer(c, e->as.unary.operand); return CAG_TYPES_ANY;
  case CAG_EXPR_LIST:
    cag_check_infer_all(c, e->as.list.items, e->as.list.count);
    return CAG_TYPES(LIST);
  case CAG_EXPR_COMPREHENSION: return infer_comprehension(c, e);
  case CAG_EXPR_RECORD:
    for (size_t i = 0; i < e->as.record.count; i++)
      cag_check_infer(c, e->as.record.fields[i].value);
    return CAG_TYPES(RECORD);
  case CAG_EXPR_BLOCK: return infer_block(c, e);
  case CAG_EXPR_LAMBDA: walk_function(c, e->as.function); return CAG_TYPES(CLOSURE);
  case CAG_EXPR_IF: return infer_branch(c, e);
  case CAG_EXPR_NEGATE: return infer_negation(c, e);
  case CAG_EXPR_NOT: cag_check_expect_bool(c, e->as.unary.operand, "not"); return CAG_TYPES(BOOL);
  case CAG_EXPR_AND:
  case CAG_EXPR_OR: {
    const char *word = e->kind == CAG_EXPR_AND ? "and" : "or";
    cag_check_expect_bool(c, e->as.binary.left, word);
    cag_check_expect_bool(c, e->as.binary.right, word);
    return CAG_TYPES(BOOL);
  }
  case CAG_EXPR_BINARY: return infer_binary(c, e);
  case CAG_EXPR_PIPE: return cag_check_infer_pipe(c, e);
  case CAG_EXPR_RANGE: return infer_range(c, e);
  case CAG_EXPR_CALL: return cag_check_infer_call(c, e);
  case CAG_EXPR_INDEX: return infer_index(c, e);
  case CAG_EXPR_MEMBER: {
    check_member(c, e, cag_check_infer(c, e->as.member.object));
    const CagExpr *o = e->as.member.object;
    if (o->kind == CAG_EXPR_NAME && o->as.name.binding == CAG_BIND_DECL && o->as.name.decl &&
        o->as.name.decl->kind == CAG_DECL_IMPORT)
      cag_check_deprecated(c,
                           cag_check_find_public(c, o->as.name.decl->statement, e->as.member.name),
                           e->as.member.name, e->as.member.name_span);
    return CAG_TYPES_ANY;
  }
  case CAG_EXPR_ERROR: break;
  }
  return CAG_TYPES_ANY;
}
