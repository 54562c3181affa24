#include "interp/session/lead.h"

#include <string.h>

#include "interp/vm/builtin.h"

// The comprehensions that enclose an expression.
typedef struct Around {
  const CagExpr *comprehension;
  const struct Around *outer;
} Around;

static const char *lead(const CagExpr *e, const Around *around);

// --- Calls ---

static bool is_one_of(const char *name, const char *const *names, size_t n) {
  for (size_t i = 0; i < n; i++)
    if (!strcmp(name, names[i])) return true;
  return false;
}

// Tests for functions that make copies of the first argument.
static bool copies(const CagExpr *callee) {
  static const char *const names[] = {"around", "rows", "mirrored"};
  return callee->kind == CAG_EXPR_NAME && callee->as.name.binding == CAG_BIND_BUILTIN &&
         is_one_of(callee->as.name.id, names, sizeof names / sizeof *names);
}

// Tests for functions that return the first argument, transformed, with other attributes ("as G"),
// or in another form.
static bool keeps(const CagExpr *callee) {
  static const char *const forms[] = {"posed", "thicken", "solid", "clip", "tessellate"};
  if (callee->kind != CAG_EXPR_NAME || callee->as.name.binding != CAG_BIND_BUILTIN) return false;
  if (is_one_of(callee->as.name.id, forms, sizeof forms / sizeof *forms)) return true;
  size_t n;
  const CagBuiltin *rows = cag_builtin_rows(callee->as.name.index, &n);
  for (size_t i = 0; i < n; i++)
    if (!strcmp(rows[i].result, "as G") || !strcmp(rows[i].result, "as C") ||
        !strcmp(rows[i].result, "as part"))
      return true;
  return false;
}

static bool is_group(const CagExpr *callee) {
  return callee->kind == CAG_EXPR_NAME && callee->as.name.binding == CAG_BIND_BUILTIN &&
         !strcmp(callee->as.name.id, "group");
}

// The callee and the first argument of a call or pipe.
typedef struct Step {
  const CagExpr *callee, *first; // first: NULL if there is no positional argument
} Step;

static Step step_of(const CagExpr *e) {
  if (e->kind == CAG_EXPR_PIPE) {
    const CagExpr *right = e->as.binary.right;
    return (Step){right->kind == CAG_EXPR_CALL ? right->as.call.callee : right, e->as.binary.left};
  }
  const CagArgument *a = e->as.call.arguments;
  const bool by_position = e->as.call.count > 0 && !a->name;
  return (Step){e->as.call.callee, by_position ? a->value : NULL};
}

// For a function of the script, the name is that of the function, unless a named shape is piped
// through it.
static const char *lead_of_call(const CagExpr *e, const Around *around) {
  const Step s = step_of(e);
  if (keeps(s.callee) || copies(s.callee)) return s.first ? lead(s.first, around) : NULL;
  if (s.callee->kind != CAG_EXPR_NAME && s.callee->kind != CAG_EXPR_MEMBER) return NULL;
  const char *through = e->kind == CAG_EXPR_PIPE ? lead(s.first, around) : NULL;
  return through ? through : lead(s.callee, around);
}

// --- Names ---

// For a name of a comprehension, the name is that of its source.
static const char *lead_of_clause(const CagDecl *decl, const Around *around) {
  for (; around; around = around->outer)
    for (size_t i = 0; i < around->comprehension->as.comprehension.count; i++) {
      const CagClause *c = &around->comprehension->as.comprehension.clauses[i];
      if (c->pattern->decl == decl) return lead(c->source, around->outer);
    }
  return NULL;
}

static const char *lead_of_name(const CagExpr *e, const Around *around) {
  if (e->as.name.binding == CAG_BIND_OUTER) return e->as.name.id;
  if (e->as.name.binding != CAG_BIND_DECL) return NULL;
  const CagDecl *decl = e->as.name.decl;
  if (decl->kind == CAG_DECL_CLAUSE) return lead_of_clause(decl, around);
  return decl->kind == CAG_DECL_PARAMETER ? NULL : e->as.name.id;
}

static const char *same(const char *a, const char *b) { return a && b && !strcmp(a, b) ? a : NULL; }

static const char *lead_of_items(CagExpr *const *items, size_t n, const Around *around) {
  const char *name = n > 0 ? lead(items[0], around) : NULL;
  for (size_t i = 1; name && i < n; i++) name = same(name, lead(items[i], around));
  return name;
}

static const char *lead_of_group(const CagExpr *e, const Around *around) {
  const CagArgument *a = e->as.call.arguments;
  const char *name = e->as.call.count > 0 ? lead(a[0].value, around) : NULL;
  for (size_t i = 1; name && i < e->as.call.count; i++) name = same(name, lead(a[i].value, around));
  return name;
}

static const char *lead(const CagExpr *e, const Around *around) {
  switch (e->kind) {
  case CAG_EXPR_NAME: return lead_of_name(e, around);
  case CAG_EXPR_GROUP:
  case CAG_EXPR_SPREAD: return lead(e->as.unary.operand, around);
  case CAG_EXPR_LIST: return lead_of_items(e->as.list.items, e->as.list.count, around);
  case CAG_EXPR_COMPREHENSION:
    return lead(e->as.comprehension.body, &(Around){.comprehension = e, .outer = around});
  case CAG_EXPR_BLOCK: return lead(e->as.block.value, around);
  case CAG_EXPR_IF:
    return same(lead(e->as.branch.then, around), lead(e->as.branch.otherwise, around));
  case CAG_EXPR_BINARY: // a transform times its operand
    return e->as.binary.op == CAG_OP_MULTIPLY ? lead(e->as.binary.right, around) : NULL;
  case CAG_EXPR_INDEX: return lead(e->as.binary.left, around);
  case CAG_EXPR_MEMBER:
    return strcmp(e->as.member.name, "items") ? e->as.member.name
                                              : lead(e->as.member.object, around);
  case CAG_EXPR_CALL:
    if (is_group(e->as.call.callee)) return lead_of_group(e, around);
    return lead_of_call(e, around);
  case CAG_EXPR_PIPE: return lead_of_call(e, around);
  default: return NULL;
  }
}

CagLead cag_lead(const CagExpr *e) {
  const char *name = e ? lead(e, NULL) : NULL;
  return (CagLead){name, name ? NULL : e};
}

// --- Parts ---

static bool has_spread(const CagExpr *list) {
  for (size_t i = 0; i < list->as.list.count; i++)
    if (list->as.list.items[i]->kind == CAG_EXPR_SPREAD) return true;
  return false;
}

static CagLeadParts parts_of_group(const CagExpr *e, size_t count) {
  CagArgument *a = e->as.call.arguments;
  if (e->as.call.count > 1 && e->as.call.count == count) return (CagLeadParts){.arguments = a};
  return e->as.call.count == 1 ? cag_lead_parts(cag_lead(a[0].value), count) : (CagLeadParts){0};
}

static CagLeadParts parts_of_call(const CagExpr *e, size_t count) {
  const Step s = step_of(e);
  if (!s.first) return (CagLeadParts){0};
  if (copies(s.callee)) return (CagLeadParts){.each = cag_lead(s.first)};
  return keeps(s.callee) ? cag_lead_parts(cag_lead(s.first), count) : (CagLeadParts){0};
}

CagLeadParts cag_lead_parts(CagLead whole, size_t count) {
  const CagExpr *e = whole.expr;
  if (!e) return (CagLeadParts){.each = whole};
  switch (e->kind) {
  case CAG_EXPR_GROUP: return cag_lead_parts(cag_lead(e->as.unary.operand), count);
  case CAG_EXPR_BINARY:
    if (e->as.binary.op != CAG_OP_MULTIPLY) return (CagLeadParts){0};
    return cag_lead_parts(cag_lead(e->as.binary.right), count);
  case CAG_EXPR_LIST:
    if (e->as.list.count != count || has_spread(e)) return (CagLeadParts){0};
    return (CagLeadParts){.items = e->as.list.items};
  case CAG_EXPR_COMPREHENSION: return (CagLeadParts){.each = cag_lead(e->as.comprehension.body)};
  case CAG_EXPR_CALL:
    return is_group(e->as.call.callee) ? parts_of_group(e, count) : parts_of_call(e, count);
  case CAG_EXPR_PIPE: return parts_of_call(e, count);
  default: return (CagLeadParts){0};
  }
}

CagLead cag_lead_part(const CagLeadParts *parts, size_t i) {
  if (parts->items) return cag_lead(parts->items[i]);
  if (parts->arguments) return cag_lead(parts->arguments[i].value);
  return parts->each;
}
