// Checks calls against the rows of built-ins and the functions of scripts.

#include "interp/check/walk.h"

#include <string.h>

#include "lang/foreign.h"
#include "lang/tree.h"

// ---- calls ----

// A call, including an argument from a pipe.
typedef struct CallView {
  const CagExpr *e; // the call; NULL: a pipe into a function
  const CagExpr *piped;
  CagSpan span;
  size_t positional, named;
  CagTypes piped_types, *types; // of the call's arguments, in its order
} CallView;

static const CagExpr *positional_argument(const CallView *v, size_t k) {
  if (v->piped && k-- == 0) return v->piped;
  for (size_t i = 0; v->e && i < v->e->as.call.count; i++)
    if (!v->e->as.call.arguments[i].name && k-- == 0) return v->e->as.call.arguments[i].value;
  return NULL;
}

static CagTypes first_types(const CallView *v) {
  if (v->piped) return v->piped_types;
  for (size_t i = 0; v->e && i < v->e->as.call.count; i++)
    if (!v->e->as.call.arguments[i].name) return v->types[i];
  return CAG_TYPES_ANY;
}

// What a call is checked against: a row of the table, or a function of a script.
typedef struct Callee {
  const char *name;
  const char *const *parameters;
  size_t count, required;
  const bool *positional_only;
  bool variadic, builtin;
} Callee;

static Callee callee_of(const CagSignature *s) {
  return (Callee){s->name,     s->parameters, s->count, s->required, s->positional_only,
                  s->variadic, true};
}

static size_t parameter_named(const Callee *f, const char *name) {
  for (size_t i = 0; i < f->count; i++)
    if (strcmp(f->parameters[i], name) == 0 && !(f->positional_only && f->positional_only[i]))
      return i;
  return f->count;
}

// Adds the correct form of a call of a built-in if other languages use a different one.
static void help_call(const Callee *f, CagDiagnostic *d) {
  const char *form = f->builtin ? cag_foreign_call(f->name) : NULL;
  if (form) cag_diagnostic_set_help(d, "write %s", form);
}

// Returns whether the arguments fit the parameters. With `tell`, reports the first that does not.
static bool check_arguments(Check *c, const Callee *f, const CallView *v, bool tell) {
  char text[256];
  if (v->positional > f->count && !f->variadic) {
    if (tell) {
      const CagExpr *extra = positional_argument(v, f->count);
      snprintf(text, sizeof text, "%s takes %zu argument%s, found %zu", f->name, f->count,
               f->count == 1 ? "" : "s", v->positional);
      help_call(f, cag_check_report(c, CAG_ERR_arity, extra ? extra->span : v->span, text));
    }
    return false;
  }
  uint64_t given = 0; // named arguments, by parameter; functions have few parameters
  for (size_t i = 0; v->e && i < v->e->as.call.count; i++) {
    const CagArgument *a = &v->e->as.call.arguments[i];
    if (!a->name) continue;
    const size_t k = parameter_named(f, a->name);
    if (k < f->count && k >= v->positional) {
      if (k < 64) given |= (uint64_t)1 << k;
      continue;
    }
    if (!tell) return false;
    snprintf(text, sizeof text,
             k < f->count ? "%s already has %s, by position" : "%s has no parameter %s", f->name,
             a->name);
    CagDiagnostic *d = cag_check_report(c, CAG_ERR_argument_name, a->name_span, text);
    if (k < f->count) return false;
    const char *form = NULL, *meant = cag_foreign_argument(a->name, f->parameters, f->count, &form);
    const char *nearest = cag_nearest_name(a->name, f->parameters, f->count);
    if (meant) cag_diagnostic_set_help(d, "did you mean `%s`, as in %s?", meant, form);
    else if (nearest) cag_diagnostic_set_help(d, "did you mean `%s`?", nearest);
    return false;
  }
  for (size_t k = v->positional; k < f->required && k < 64; k++) {
    if (given >> k & 1) continue;
    if (tell) {
      snprintf(text, sizeof text, "%s needs an argument for `%s`", f->name, f->parameters[k]);
      help_call(f, cag_check_report(c, CAG_ERR_arity, v->span, text));
    }
    return false;
  }
  return true;
}

// An argument of a type that its parameter does not accept.
typedef struct Misfit {
  const CagExpr *value;
  size_t parameter;
  CagTypes taken, found;
} Misfit;

static bool fits(const CagBuiltin *row, const CagSignature *s, size_t k, CagTypes types,
                 const CagExpr *value, Misfit *out) {
  const CagTypes taken = cag_types_taken(row, s, k);
  *out = (Misfit){value, k, taken, types};
  return types & taken;
}

// Returns whether a row accepts the types of the arguments. Otherwise, sets the first misfit.
static bool types_fit(const CagBuiltin *row, const CagSignature *s, const CallView *v,
                      Misfit *out) {
  size_t k = 0;
  if (v->piped && !fits(row, s, k++, v->piped_types, v->piped, out)) return false;
  const Callee f = callee_of(s);
  for (size_t i = 0; v->e && i < v->e->as.call.count; i++) {
    const CagArgument *a = &v->e->as.call.arguments[i];
    const size_t parameter = a->name ? parameter_named(&f, a->name) : k++;
    if (!fits(row, s, parameter, v->types[i], a->value, out)) return false;
  }
  return true;
}

// Describes the expected types: "a number", or the words of the signature if there are many types:
// "a list of points".
static const char *expected_text(const CagSignature *s, const Misfit *m, char *buffer,
                                 size_t size) {
  const CagTypes taken = m->taken & ~CAG_TYPES(NONE);
  size_t count = 0;
  for (size_t i = 0; i < CAG_TYPE_COUNT; i++) count += taken >> i & 1;
  const size_t parameter = m->parameter >= s->count && s->variadic ? 0 : m->parameter;
  if (count <= 5 || parameter >= s->count) return cag_types_text(taken, buffer, size);
  const char *words = s->words[parameter];
  snprintf(buffer, size, "%s %s", cag_article(words), words);
  return buffer;
}

static void report_misfit(Check *c, const CagSignature *s, const Misfit *m) {
  char expected[256], found[256], text[800];
  const bool named = m->parameter > 0 && m->parameter < s->count;
  snprintf(text, sizeof text, "%s expects %s%s%s%s, found %s", s->name,
           expected_text(s, m, expected, sizeof expected), named ? " as `" : "",
           named ? s->parameters[m->parameter] : "", named ? "`" : "",
           cag_types_text(m->found, found, sizeof found));
  const CagExpr *e = m->value;
  CagDiagnostic *d = cag_check_report(c, CAG_ERR_type, e->span, text);
  if (m->taken & CAG_TYPES(ANGLE) && !(m->taken & CAG_TYPES(NUMBER)) &&
      m->found == CAG_TYPES(NUMBER) && e->kind == CAG_EXPR_NUMBER)
    cag_diagnostic_set_help(d, "write %gdeg or %grad", e->as.number, e->as.number);
  else if (cag_foreign_call(s->name))
    cag_diagnostic_set_help(d, "write %s", cag_foreign_call(s->name));
}

// Warns about a row whose summary states a replacement.
static void check_deprecated_row(Check *c, const CagBuiltin *row, const char *name, CagSpan span) {
  static const char mark[] = "Deprecated: ";
  if (strncmp(row->summary, mark, strlen(mark)) != 0) return;
  char text[160];
  snprintf(text, sizeof text, "%s is deprecated", name);
  CagDiagnostic *d = cag_check_warn(c, CAG_ERR_deprecated, span, text);
  cag_diagnostic_set_help(d, "%.*s", (int)strcspn(row->summary + strlen(mark), "."),
                          row->summary + strlen(mark));
}

static CagTypes result_of(const CagBuiltin *row, CagTypes first) {
  if (strncmp(row->signature, "error(", strlen("error(")) == 0)
    return CAG_TYPES_ANY; // it does not return
  // Functions that give attributes make a group of a list of shapes.
  if (first & CAG_TYPES(LIST)) first |= CAG_TYPES(GROUP);
  if (row->result && strncmp(row->result, "as ", 3) == 0) return first ? first : CAG_TYPES_ANY;
  return cag_types_of_result(row->result);
}

// Rows of one name are tried in order. A call is valid if one of them accepts it.
static CagTypes check_builtin(Check *c, size_t index, const CallView *v, CagSpan callee) {
  size_t rows, candidates = 0, only = 0, fitting = 0, misfits = 0;
  Misfit misfit, nearest = {0};
  const CagSignature *missed = NULL;
  const CagBuiltin *row = cag_builtin_rows(index, &rows);
  CagTypes result = 0, served = 0;
  if (!row->function) return CAG_TYPES_ANY;
  const CagTypes first = first_types(v);
  for (size_t i = 0; i < rows; i++) {
    const CagSignature *s = cag_builtin_signature(index, i);
    served |= row[i].first ? row[i].first : CAG_TYPES_ANY;
    if (row[i].first && !(row[i].first & first)) continue;
    candidates++;
    only = i;
    const Callee f = callee_of(s);
    if (!check_arguments(c, &f, v, false)) continue;
    fitting++;
    result |= result_of(&row[i], first);
    if (types_fit(&row[i], s, v, &misfit)) continue;
    // Of several rows, report the one that accepts the most arguments.
    if (misfits++ > 0 && misfit.parameter <= nearest.parameter) continue;
    nearest = misfit;
    missed = s;
  }
  const CagSignature *s = cag_builtin_signature(index, only);
  if (candidates == 0) {
    const Misfit m = {v->piped ? v->piped : positional_argument(v, 0), 0, served, first};
    report_misfit(c, s, &m);
    return CAG_TYPES_ANY;
  }
  if (fitting == 0) {
    const Callee f = callee_of(s);
    check_arguments(c, &f, v, true);
    return CAG_TYPES_ANY;
  }
  if (misfits == fitting) report_misfit(c, missed, &nearest);
  else if (candidates == 1) check_deprecated_row(c, &row[only], s->name, callee);
  return result;
}

static CagTypes check_function(Check *c, const char *name, const CagFunctionAst *fn,
                               const CallView *v) {
  const char *few[32], **parameters = few;
  if (fn->parameter_count > 32)
    parameters = cag_arena_alloc(&c->memory, fn->parameter_count * sizeof *parameters);
  for (size_t i = 0; i < fn->parameter_count; i++) parameters[i] = fn->parameters[i].decl->name;
  const Callee f = {name, parameters, fn->parameter_count, fn->required_count, NULL, false, false};
  check_arguments(c, &f, v, true);
  return CAG_TYPES_ANY;
}

// Returns the function that an expression refers to, and its name, or NULL if it is unknown.
static const CagFunctionAst *function_of(const Check *c, const CagExpr *e, const char **name) {
  const CagDecl *found = NULL;
  if (e->kind == CAG_EXPR_NAME && e->as.name.binding == CAG_BIND_DECL && e->as.name.decl) {
    const CagDecl *decl = e->as.name.decl;
    *name = decl->name;
    if (decl->kind == CAG_DECL_TOP || decl->kind == CAG_DECL_BLOCK) found = decl;
    if (decl->kind == CAG_DECL_IMPORTED)
      found = cag_check_find_public(c, decl->statement, decl->name);
  } else if (e->kind == CAG_EXPR_MEMBER && e->as.member.object->kind == CAG_EXPR_NAME) {
    const CagExpr *object = e->as.member.object;
    const CagDecl *decl = object->as.name.binding == CAG_BIND_DECL ? object->as.name.decl : NULL;
    *name = e->as.member.name;
    if (decl && decl->kind == CAG_DECL_IMPORT)
      found = cag_check_find_public(c, decl->statement, e->as.member.name);
  }
  const CagStatement *s = found ? found->statement : NULL;
  if (!s || s->kind != CAG_STATEMENT_DEFINITION || s->damage != CAG_SOUND) return NULL;
  const CagExpr *value = cag_tree_value(found);
  return value && value->kind == CAG_EXPR_LAMBDA ? value->as.function : NULL;
}

static bool names_builtin(const CagExpr *e) {
  return e->kind == CAG_EXPR_NAME && e->as.name.binding == CAG_BIND_BUILTIN &&
         e->as.name.index < cag_builtin_count();
}

// The function given to `attempt` is expected to fail, so it is not checked.
static bool is_attempt(const CagExpr *e) {
  return names_builtin(e) && strcmp(cag_builtin_name(e->as.name.index), "attempt") == 0;
}

// A curve takes one parameter, a surface two.
static void check_shape_call(Check *c, CagTypes called, const CallView *v) {
  const bool curve = called == CAG_TYPES(CURVE), surface = called == CAG_TYPES(SURFACE);
  const bool number = !(first_types(v) & ~(CAG_TYPES(NUMBER) | CAG_TYPES(ANGLE)));
  if (curve && v->positional > 1)
    cag_check_report(c, CAG_ERR_arity, v->span, "a curve takes one parameter");
  if (surface && (v->positional > 2 || (v->positional == 1 && v->named == 0 && number)))
    cag_check_report(c, CAG_ERR_arity, v->span, "a surface takes two parameters, u and v");
}

// Checks a call, or a pipe into a function.
static CagTypes check_call(Check *c, const CagExpr *callee, CallView *v) {
  CagTypes few[16];
  v->types = few;
  v->positional = v->piped != NULL;
  for (size_t i = 0; v->e && i < v->e->as.call.count; i++)
    if (v->e->as.call.arguments[i].name) v->named++;
    else v->positional++;
  if (v->positional + v->named > 16)
    v->types = cag_arena_alloc(&c->memory, (v->positional + v->named) * sizeof *v->types);
  c->unjudged += is_attempt(callee);
  if (v->piped) v->piped_types = cag_check_infer(c, v->piped);
  const CagTypes called = cag_check_infer(c, callee);
  for (size_t i = 0; v->e && i < v->e->as.call.count; i++)
    v->types[i] = cag_check_infer(c, v->e->as.call.arguments[i].value);
  c->unjudged -= is_attempt(callee);
  CagTypes result = CAG_TYPES_ANY;
  const char *name = NULL;
  const CagFunctionAst *fn = function_of(c, callee, &name);
  if (names_builtin(callee)) result = check_builtin(c, callee->as.name.index, v, callee->span);
  else if (fn) result = check_function(c, name, fn, v);
  else if (!(called &
             (CAG_TYPES_FUNCTION | CAG_TYPES(CURVE) | CAG_TYPES(SURFACE) | CAG_TYPES(SOLID)))) {
    char found[256], text[320];
    snprintf(text, sizeof text, "a call needs a function, found %s",
             cag_types_text(called, found, sizeof found));
    CagDiagnostic *d = cag_check_report(c, CAG_ERR_not_function, callee->span, text);
    const size_t hidden =
        callee->kind == CAG_EXPR_NAME ? cag_builtin_find(callee->as.name.id) : (size_t)-1;
    if (hidden != (size_t)-1 && cag_builtin_rows(hidden, &(size_t){0})->function)
      cag_diagnostic_set_help(d, "`%s` is defined here and hides the built-in function; rename it",
                              callee->as.name.id);
  } else {
    check_shape_call(c, called, v);
  }
  v->types = NULL; // `few` ends here
  return result;
}

// Evaluates a call without errors if all its arguments are constant.
static void try_call(Check *c, const CagExpr *e, size_t errors_before) {
  if (!c->unjudged && !c->thunks && cag_check_error_count(c) == errors_before)
    cag_check_constant(&c->constants, e);
}

CagTypes cag_check_infer_pipe(Check *c, const CagExpr *e) {
  const CagExpr *right = e->as.binary.right;
  CallView v = {.e = right->kind == CAG_EXPR_CALL ? right : NULL,
                .piped = e->as.binary.left,
                .span = right->span};
  const size_t before = cag_check_error_count(c);
  const CagTypes types = check_call(c, v.e ? right->as.call.callee : right, &v);
  try_call(c, e, before);
  return types;
}

CagTypes cag_check_infer_call(Check *c, const CagExpr *e) {
  CallView v = {.e = e, .span = e->span};
  const size_t before = cag_check_error_count(c);
  const CagTypes types = check_call(c, e->as.call.callee, &v);
  try_call(c, e, before);
  return types;
}
