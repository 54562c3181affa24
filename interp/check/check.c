// The walk of the checker: types of expressions, calls, and which definitions are reached.

#include "interp/check/check.h"

#include <stdlib.h>
#include <string.h>

#include "interp/check/circle.h"
#include "interp/check/constant.h"
#include "interp/check/types.h"
#include "interp/doc/doc.h"
#include "lang/foreign.h"

// Definitions are walked where they are used first; a chain of more than so many is not followed.
#define DEPTH_MAX 1000

// What is known of a definition, parameter or name of a comprehension.
typedef struct Known {
  const CagDecl *decl;
  CagTypes types;
} Known;

// What a parameter of a built-in takes, by the place of its name in the signature.
typedef struct Taken {
  const char *const *parameter;
  CagTypes types;
} Taken;

// Places for all parameters of all built-ins, and how many are looked at before the words are read
// again.
#define TAKEN_SIZE ((size_t)4096)
#define TAKEN_TRIES 16

typedef struct Check {
  CagVm *vm;
  const CagModuleUnit *unit;
  const CagModuleAst *ast;
  Known *known; // open addressing by the address of the declaration
  size_t known_count, known_size;
  Taken *taken; // open addressing; NULL before the first
  // Definitions of the top level: what is known of them, and which others they use.
  CagTypes *top_types;
  bool *top_done, *top_busy, *reached;
  size_t *edges; // pairs: user, used
  size_t edge_count, edge_capacity;
  size_t top;             // whose value is walked; the number of tops for statements
  size_t unjudged;        // calls of `attempt` around
  CagDiagnostics ignored; // what is said of them
  size_t depth;           // definitions that are walked within one another
  CagConstants constants;
  bool *top_bad; // definitions with errors
  size_t thunks; // functions without parameters around: their calls may be meant to fail
} Check;

static CagTypes infer(Check *c, const CagExpr *e);

// ---- reports ----

static CagDiagnostic *report(Check *c, CagErrorId id, CagSpan span, const char *message) {
  if (c->unjudged) {
    cag_diagnostics_clear(&c->ignored);
    return cag_diagnostics_add(&c->ignored, id, c->ast->source, span, "%s", message);
  }
  return cag_diagnostics_add(&c->vm->errors, id, c->ast->source, span, "%s", message);
}

static CagDiagnostic *warn(Check *c, CagErrorId id, CagSpan span, const char *message) {
  CagDiagnostic *d = report(c, id, span, message);
  d->severity = CAG_SEVERITY_WARNING;
  return d;
}

// "..., found a number".
static void report_found(Check *c, CagErrorId id, CagSpan span, const char *wanted,
                         CagTypes types) {
  char found[256], text[512];
  snprintf(text, sizeof text, "%s, found %s", wanted, cag_types_text(types, found, sizeof found));
  report(c, id, span, text);
}

// ---- names ----

static size_t slot_of(const Check *c, const CagDecl *decl) {
  size_t i = ((size_t)decl >> 4) * 0x9E3779B97F4A7C15u >> 20 & (c->known_size - 1);
  while (c->known[i].decl && c->known[i].decl != decl) i = (i + 1) & (c->known_size - 1);
  return i;
}

static void learn(Check *c, const CagDecl *decl, CagTypes types) {
  if (!decl) return;
  if (2 * (c->known_count + 1) > c->known_size) {
    Check old = *c;
    c->known_size = old.known_size ? 2 * old.known_size : 256;
    c->known = cag_checked(calloc(c->known_size, sizeof *c->known));
    for (size_t i = 0; i < old.known_size; i++)
      if (old.known[i].decl) c->known[slot_of(c, old.known[i].decl)] = old.known[i];
    free(old.known);
  }
  const size_t i = slot_of(c, decl);
  c->known_count += !c->known[i].decl;
  c->known[i] = (Known){decl, types};
}

static CagTypes types_known(const Check *c, const CagDecl *decl) {
  if (!c->known_size) return CAG_TYPES_ANY;
  const Known *k = &c->known[slot_of(c, decl)];
  return k->decl ? k->types : CAG_TYPES_ANY;
}

static void use_top(Check *c, size_t used) {
  if (c->edge_count == c->edge_capacity) {
    c->edge_capacity = 2 * c->edge_capacity + 64;
    c->edges = cag_checked(realloc(c->edges, 2 * c->edge_capacity * sizeof *c->edges));
  }
  c->edges[2 * c->edge_count] = c->top;
  c->edges[2 * c->edge_count++ + 1] = used;
}

static CagTypes types_of_top(Check *c, const CagDecl *decl) {
  const size_t k = decl->index;
  if (c->top_done[k]) return c->top_types[k];
  if (c->top_busy[k] || c->depth > DEPTH_MAX) return CAG_TYPES_ANY;
  const size_t outer = c->top, errors = c->vm->errors.count + c->vm->errors.dropped;
  const CagStatement *s = decl->statement;
  c->top_busy[k] = true;
  c->depth++;
  c->top = k;
  c->top_types[k] =
      infer(c, s->kind == CAG_STATEMENT_PARAM ? s->as.param.value : s->as.definition.value);
  if (s->kind == CAG_STATEMENT_PARAM && s->as.param.domain) infer(c, s->as.param.domain);
  c->top = outer;
  c->depth--;
  c->top_done[k] = true;
  if (c->vm->errors.count + c->vm->errors.dropped > errors) c->top_bad[k] = true;
  return c->top_types[k];
}

// The statement that defines an imported name, or the member of an imported module; NULL: unknown.
static const CagStatement *find_public(const Check *c, const CagStatement *import,
                                       const char *name) {
  if (!import || import->kind != CAG_STATEMENT_IMPORT || import->as.import.module == CAG_NO_MODULE)
    return NULL;
  const CagModuleUnit *m = c->vm->modules[import->as.import.module];
  for (size_t i = 0; i < m->public_count; i++)
    if (strcmp(m->publics[i].name, name) == 0) return m->publics[i].statement;
  return NULL;
}

// Definitions whose documentation says `deprecated: ...` are told where they are used.
static void check_deprecated(Check *c, const CagStatement *s, const char *name, CagSpan span) {
  const char *said = s && s->doc ? strstr(s->doc, "deprecated:") : NULL;
  if (!said) return;
  said += strlen("deprecated:");
  said += strspn(said, " ");
  CagDiagnostic *d = cag_diagnostics_add(&c->vm->errors, CAG_ERR_deprecated, c->ast->source, span,
                                         "%s is deprecated", name);
  d->severity = CAG_SEVERITY_WARNING;
  cag_diagnostic_set_help(d, "%.*s", (int)strcspn(said, "\n"), said);
}

static CagTypes types_of_builtin(size_t index) {
  if (index >= cag_builtin_count()) return CAG_TYPES(NUMBER); // time, frame, frames
  size_t rows;
  const CagBuiltin *row = cag_builtin_rows(index, &rows);
  return row->function ? CAG_TYPES(BUILTIN) : cag_types_of_result(row->result);
}

static CagTypes infer_name(Check *c, const CagExpr *e) {
  const CagDecl *decl = e->as.name.decl;
  if (e->as.name.binding == CAG_BIND_BUILTIN) return types_of_builtin(e->as.name.index);
  if (e->as.name.binding != CAG_BIND_DECL || !decl) return CAG_TYPES_ANY;
  switch (decl->kind) {
  case CAG_DECL_TOP:
    use_top(c, decl->index);
    check_deprecated(c, decl->statement, decl->name, e->span);
    return types_of_top(c, decl);
  case CAG_DECL_IMPORT: return CAG_TYPES(MODULE);
  case CAG_DECL_IMPORTED:
    check_deprecated(c, find_public(c, decl->statement, decl->name), decl->name, e->span);
    return CAG_TYPES_ANY;
  default: return types_known(c, decl);
  }
}

// ---- calls ----

// A call with what a pipe puts before its arguments.
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

// What a call is held against: a row of the table, or a function of a script.
typedef struct Callee {
  const char *name;
  const char *const *parameters;
  size_t count, required;
  const bool *positional_only;
  bool variadic, builtin;
} Callee;

static size_t parameter_named(const Callee *f, const char *name) {
  for (size_t i = 0; i < f->count; i++)
    if (strcmp(f->parameters[i], name) == 0 && !(f->positional_only && f->positional_only[i]))
      return i;
  return f->count;
}

// Shows the form of a call of a built-in where other languages have another.
static void help_call(const Callee *f, CagDiagnostic *d) {
  const char *form = f->builtin ? cag_foreign_call(f->name) : NULL;
  if (form) cag_diagnostic_set_help(d, "write %s", form);
}

// Whether the arguments fit the parameters; where `tell`, the first that does not is reported.
static bool check_arguments(Check *c, const Callee *f, const CallView *v, bool tell) {
  char text[256];
  if (v->positional > f->count && !f->variadic) {
    if (tell) {
      const CagExpr *extra = positional_argument(v, f->count);
      snprintf(text, sizeof text, "%s takes %zu argument%s, found %zu", f->name, f->count,
               f->count == 1 ? "" : "s", v->positional);
      help_call(f, report(c, CAG_ERR_arity, extra ? extra->span : v->span, text));
    }
    return false;
  }
  uint64_t given = 0; // parameters by name; functions have few
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
             k < f->count ? "%s has %s already, by position" : "%s has no parameter %s", f->name,
             a->name);
    CagDiagnostic *d = report(c, CAG_ERR_argument_name, a->name_span, text);
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
      help_call(f, report(c, CAG_ERR_arity, v->span, text));
    }
    return false;
  }
  return true;
}

// What a parameter takes. The words of the documentation are read once for each.
static CagTypes types_taken(Check *c, const CagBuiltin *row, const CagSignature *s, size_t k) {
  if (k >= s->count) return cag_types_taken(row, s, k);
  if (!c->taken) c->taken = cag_checked(calloc(TAKEN_SIZE, sizeof *c->taken));
  const char *const *key = &s->parameters[k];
  size_t i = ((size_t)key >> 3) * 0x9E3779B97F4A7C15u >> 20 & (TAKEN_SIZE - 1);
  for (size_t tries = 0; tries < TAKEN_TRIES; tries++, i = (i + 1) & (TAKEN_SIZE - 1)) {
    if (c->taken[i].parameter == key) return c->taken[i].types;
    if (c->taken[i].parameter) continue;
    c->taken[i].parameter = key;
    return c->taken[i].types = cag_types_taken(row, s, k);
  }
  return cag_types_taken(row, s, k);
}

// An argument that a parameter does not take.
typedef struct Misfit {
  const CagExpr *value;
  size_t parameter;
  CagTypes taken, found;
} Misfit;

static bool fits(Check *c, const CagBuiltin *row, const CagSignature *s, size_t k, CagTypes types,
                 const CagExpr *value, Misfit *out) {
  const CagTypes taken = types_taken(c, row, s, k);
  *out = (Misfit){value, k, taken, types};
  return types & taken;
}

// Whether the arguments are of types that a row takes; else the first that is not.
static bool types_fit(Check *c, const CagBuiltin *row, const CagSignature *s, const CallView *v,
                      Misfit *out) {
  size_t k = 0;
  if (v->piped && !fits(c, row, s, k++, v->piped_types, v->piped, out)) return false;
  const Callee f = {s->name,     s->parameters, s->count, s->required, s->positional_only,
                    s->variadic, true};
  for (size_t i = 0; v->e && i < v->e->as.call.count; i++) {
    const CagArgument *a = &v->e->as.call.arguments[i];
    const size_t parameter = a->name ? parameter_named(&f, a->name) : k++;
    if (!fits(c, row, s, parameter, v->types[i], a->value, out)) return false;
  }
  return true;
}

// "a number", or in the words of the documentation where these are many: "a list of points".
static const char *expected_text(const CagSignature *s, const Misfit *m, char *buffer,
                                 size_t size) {
  const CagTypes taken = m->taken & ~CAG_TYPES(NONE);
  size_t count = 0;
  for (size_t i = 0; i < CAG_TYPE_COUNT; i++) count += taken >> i & 1;
  const CagDocParameter *said =
      m->parameter < s->count ? cag_doc_parameter(s->name, s->parameters[m->parameter]) : NULL;
  if (count <= 5 || !said) return cag_types_text(taken, buffer, size);
  snprintf(buffer, size, "%s %.*s", strchr("aeiou", said->type[0]) ? "an" : "a",
           (int)strcspn(said->type, ","), said->type);
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
  CagDiagnostic *d = report(c, CAG_ERR_type, e->span, text);
  if (m->taken & CAG_TYPES(ANGLE) && !(m->taken & CAG_TYPES(NUMBER)) &&
      m->found == CAG_TYPES(NUMBER) && e->kind == CAG_EXPR_NUMBER)
    cag_diagnostic_set_help(d, "write %gdeg or %grad", e->as.number, e->as.number);
  else if (cag_foreign_call(s->name))
    cag_diagnostic_set_help(d, "write %s", cag_foreign_call(s->name));
}

static CagTypes result_of(const CagBuiltin *row, CagTypes first) {
  if (strcmp(row->signature, "error(message)") == 0) return CAG_TYPES_ANY; // it gives nothing back
  if (row->result && strncmp(row->result, "as ", 3) == 0) return first ? first : CAG_TYPES_ANY;
  return cag_types_of_result(row->result);
}

// Rows of one name are tried in order: a call is good when one of them takes it.
static CagTypes check_builtin(Check *c, size_t index, const CallView *v) {
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
    const Callee f = {s->name,     s->parameters, s->count, s->required, s->positional_only,
                      s->variadic, true};
    if (!check_arguments(c, &f, v, false)) continue;
    fitting++;
    result |= result_of(&row[i], first);
    if (types_fit(c, &row[i], s, v, &misfit)) continue;
    // Of several rows, that is meant which takes the most of the arguments.
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
    const Callee f = {s->name,     s->parameters, s->count, s->required, s->positional_only,
                      s->variadic, true};
    check_arguments(c, &f, v, true);
    return CAG_TYPES_ANY;
  }
  if (misfits == fitting) report_misfit(c, missed, &nearest);
  return result;
}

static CagTypes check_function(Check *c, const char *name, const CagFunctionAst *fn,
                               const CallView *v) {
  const char *few[32], **parameters = few;
  if (fn->parameter_count > 32)
    parameters = cag_checked(malloc(fn->parameter_count * sizeof *parameters));
  for (size_t i = 0; i < fn->parameter_count; i++) parameters[i] = fn->parameters[i].decl->name;
  const Callee f = {name, parameters, fn->parameter_count, fn->required_count, NULL, false, false};
  check_arguments(c, &f, v, true);
  if (parameters != few) free(parameters);
  return CAG_TYPES_ANY;
}

// The function that an expression stands for, and its name; NULL: not known.
static const CagFunctionAst *function_of(const Check *c, const CagExpr *e, const char **name) {
  const CagStatement *s = NULL;
  if (e->kind == CAG_EXPR_NAME && e->as.name.binding == CAG_BIND_DECL && e->as.name.decl) {
    const CagDecl *decl = e->as.name.decl;
    *name = decl->name;
    if (decl->kind == CAG_DECL_TOP || decl->kind == CAG_DECL_BLOCK) s = decl->statement;
    if (decl->kind == CAG_DECL_IMPORTED) s = find_public(c, decl->statement, decl->name);
  } else if (e->kind == CAG_EXPR_MEMBER && e->as.member.object->kind == CAG_EXPR_NAME) {
    const CagExpr *object = e->as.member.object;
    const CagDecl *decl = object->as.name.binding == CAG_BIND_DECL ? object->as.name.decl : NULL;
    *name = e->as.member.name;
    if (decl && decl->kind == CAG_DECL_IMPORT)
      s = find_public(c, decl->statement, e->as.member.name);
  }
  if (!s || s->kind != CAG_STATEMENT_DEFINITION) return NULL;
  const CagExpr *value = s->as.definition.value;
  return value->kind == CAG_EXPR_LAMBDA ? value->as.function : NULL;
}

static bool names_builtin(const CagExpr *e) {
  return e->kind == CAG_EXPR_NAME && e->as.name.binding == CAG_BIND_BUILTIN &&
         e->as.name.index < cag_builtin_count();
}

// `attempt` is there for what may fail: its function is not judged.
static bool is_attempt(const CagExpr *e) {
  return names_builtin(e) && strcmp(cag_builtin_name(e->as.name.index), "attempt") == 0;
}

// A curve is called with one parameter, a surface with two.
static void check_shape_call(Check *c, CagTypes called, const CallView *v) {
  const bool curve = called == CAG_TYPES(CURVE), surface = called == CAG_TYPES(SURFACE);
  const bool number = !(first_types(v) & ~(CAG_TYPES(NUMBER) | CAG_TYPES(ANGLE)));
  if (curve && v->positional > 1)
    report(c, CAG_ERR_arity, v->span, "a curve is called with one parameter");
  if (surface && (v->positional > 2 || (v->positional == 1 && v->named == 0 && number)))
    report(c, CAG_ERR_arity, v->span, "a surface is called with two parameters, u and v");
}

// A call, or a pipe into what is called.
static CagTypes check_call(Check *c, const CagExpr *callee, CallView *v) {
  CagTypes few[16];
  v->types = few;
  v->positional = v->piped != NULL;
  for (size_t i = 0; v->e && i < v->e->as.call.count; i++)
    if (v->e->as.call.arguments[i].name) v->named++;
    else v->positional++;
  if (v->positional + v->named > 16)
    v->types = cag_checked(malloc((v->positional + v->named) * sizeof *v->types));
  c->unjudged += is_attempt(callee);
  if (v->piped) v->piped_types = infer(c, v->piped);
  const CagTypes called = infer(c, callee);
  for (size_t i = 0; v->e && i < v->e->as.call.count; i++)
    v->types[i] = infer(c, v->e->as.call.arguments[i].value);
  c->unjudged -= is_attempt(callee);
  CagTypes result = CAG_TYPES_ANY;
  const char *name = NULL;
  const CagFunctionAst *fn = function_of(c, callee, &name);
  if (names_builtin(callee)) result = check_builtin(c, callee->as.name.index, v);
  else if (fn) result = check_function(c, name, fn, v);
  else if (!(called &
             (CAG_TYPES_FUNCTION | CAG_TYPES(CURVE) | CAG_TYPES(SURFACE) | CAG_TYPES(SOLID)))) {
    char found[256], text[320];
    snprintf(text, sizeof text, "a call needs a function, found %s",
             cag_types_text(called, found, sizeof found));
    CagDiagnostic *d = report(c, CAG_ERR_not_function, callee->span, text);
    const size_t hidden =
        callee->kind == CAG_EXPR_NAME ? cag_builtin_find(callee->as.name.id) : (size_t)-1;
    if (hidden != (size_t)-1 && cag_builtin_rows(hidden, &(size_t){0})->function)
      cag_diagnostic_set_help(d, "`%s` is defined here and hides the built-in function; rename it",
                              callee->as.name.id);
  } else {
    check_shape_call(c, called, v);
  }
  if (v->types != few) free(v->types);
  return result;
}

// ---- expressions ----

static void expect_bool(Check *c, const CagExpr *e, const char *of) {
  char found[256], text[320];
  const CagTypes types = infer(c, e);
  if (types & CAG_TYPES(BOOL)) return;
  snprintf(text, sizeof text, "%s wants true or false, found %s", of,
           cag_types_text(types, found, sizeof found));
  report(c, CAG_ERR_condition, e->span, text);
}

static CagTypes infer_binary(Check *c, const CagExpr *e) {
  char left[256], right[256], text[600];
  const CagTypes a = infer(c, e->as.binary.left), b = infer(c, e->as.binary.right);
  const CagTypes result = cag_types_joined(e->as.binary.op, a, b);
  if (result) return result;
  const CagSpan op = e->as.binary.op_span;
  snprintf(text, sizeof text, "%.*s does not join %s and %s", (int)(op.end - op.start),
           c->ast->source->text + op.start, cag_types_text(a, left, sizeof left),
           cag_types_text(b, right, sizeof right));
  CagDiagnostic *d = report(c, CAG_ERR_operand, e->span, text);
  const bool mixed = (a | b) == (CAG_TYPES(NUMBER) | CAG_TYPES(ANGLE));
  if (mixed) cag_diagnostic_set_help(d, "give the number a unit: 30deg");
  return CAG_TYPES_ANY;
}

static CagTypes infer_branch(Check *c, const CagExpr *e) {
  CagTypes types = 0;
  for (; e->kind == CAG_EXPR_IF; e = e->as.branch.otherwise) {
    const CagExpr *condition = e->as.branch.condition;
    expect_bool(c, condition, "if");
    if (condition->kind == CAG_EXPR_TRUE)
      warn(c, CAG_ERR_never_reached, e->as.branch.otherwise->span,
           "this is never reached: the condition is always true");
    if (condition->kind == CAG_EXPR_FALSE)
      warn(c, CAG_ERR_never_reached, e->as.branch.then->span,
           "this is never reached: the condition is always false");
    types |= infer(c, e->as.branch.then);
  }
  return types | infer(c, e);
}

// What a list, range or text gives one after the other.
static CagTypes types_of_elements(const CagExpr *source, CagTypes types) {
  if (source->kind == CAG_EXPR_RANGE && source->as.range.low->kind == CAG_EXPR_NUMBER)
    return CAG_TYPES(NUMBER);
  if (source->kind == CAG_EXPR_RANGE && source->as.range.low->kind == CAG_EXPR_ANGLE)
    return CAG_TYPES(ANGLE);
  return types == CAG_TYPES(TEXT) ? CAG_TYPES(TEXT) : CAG_TYPES_ANY;
}

static CagTypes infer_comprehension(Check *c, const CagExpr *e) {
  for (size_t i = 0; i < e->as.comprehension.count; i++) {
    const CagClause *clause = &e->as.comprehension.clauses[i];
    const CagTypes source = infer(c, clause->source),
                   types = types_of_elements(clause->source, source);
    if (!(source & CAG_TYPES_LOOPED))
      report_found(c, CAG_ERR_type, clause->source->span,
                   "a comprehension runs over a list, a range, a text or a record", source);
    for (size_t k = 0; k < clause->name_count; k++)
      learn(c, clause->names[k], clause->pattern ? CAG_TYPES_ANY : types);
    if (clause->filter) expect_bool(c, clause->filter, "the condition");
  }
  infer(c, e->as.comprehension.body);
  return CAG_TYPES(LIST);
}

static void walk_function(Check *c, const CagFunctionAst *fn) {
  for (size_t i = 0; i < fn->parameter_count; i++) {
    learn(c, fn->parameters[i].decl, CAG_TYPES_ANY);
    if (fn->parameters[i].fallback) infer(c, fn->parameters[i].fallback);
  }
  const bool thunk = fn->parameter_count == 0;
  c->thunks += thunk;
  infer(c, fn->body);
  c->thunks -= thunk;
}

static CagTypes infer_block(Check *c, const CagExpr *e) {
  char text[256];
  for (size_t i = 0; i < e->as.block.count; i++) {
    const CagStatement *s = e->as.block.statements[i];
    if (s->kind == CAG_STATEMENT_ASSERT) {
      expect_bool(c, s->as.assertion.condition, "assert");
      if (s->as.assertion.message) infer(c, s->as.assertion.message);
      continue;
    }
    const CagDecl *decl = s->as.definition.decl;
    learn(c, decl, CAG_TYPES_ANY); // a function sees itself
    learn(c, decl, infer(c, s->as.definition.value));
    if (decl->used || decl->name[0] == '_') continue;
    snprintf(text, sizeof text, "nothing uses %s", decl->name);
    warn(c, CAG_ERR_unused, decl->span, text);
  }
  return infer(c, e->as.block.value);
}

static CagTypes infer_index(Check *c, const CagExpr *e) {
  const CagTypes indexable =
      CAG_TYPES(LIST) | CAG_TYPES(RANGE) | CAG_TYPES(TEXT) | CAG_TYPES(RECORD);
  char found[256], text[320];
  const CagTypes types = infer(c, e->as.binary.left);
  infer(c, e->as.binary.right);
  if (types & indexable) return types == CAG_TYPES(TEXT) ? types : CAG_TYPES_ANY;
  snprintf(text, sizeof text, "[ ] wants a list, a range, a text or a record, found %s",
           cag_types_text(types, found, sizeof found));
  report(c, CAG_ERR_type, e->as.binary.left->span, text);
  return CAG_TYPES_ANY;
}

static CagTypes infer_negation(Check *c, const CagExpr *e) {
  const CagTypes wrong =
      CAG_TYPES(TEXT) | CAG_TYPES(BOOL) | CAG_TYPES(NONE) | CAG_TYPES(RECORD) | CAG_TYPES_FUNCTION;
  char found[256], text[320];
  const CagTypes types = infer(c, e->as.unary.operand);
  if (types & ~wrong) return types & ~wrong;
  snprintf(text, sizeof text, "- does not take %s", cag_types_text(types, found, sizeof found));
  report(c, CAG_ERR_operand, e->span, text);
  return CAG_TYPES_ANY;
}

// A range from a number to an angle, or back.
static void check_mixed_range(Check *c, const CagExpr *e, CagTypes low, CagTypes high) {
  char text[320];
  if (!((low == CAG_TYPES(NUMBER) && high == CAG_TYPES(ANGLE)) ||
        (low == CAG_TYPES(ANGLE) && high == CAG_TYPES(NUMBER))))
    return;
  const CagExpr *number = low == CAG_TYPES(NUMBER) ? e->as.range.low : e->as.range.high;
  snprintf(text, sizeof text, "a range needs two numbers or two angles, found %s and %s",
           low == CAG_TYPES(NUMBER) ? "a number" : "an angle",
           high == CAG_TYPES(NUMBER) ? "a number" : "an angle");
  CagDiagnostic *d = report(c, CAG_ERR_type, e->span, text);
  if (number->kind == CAG_EXPR_NUMBER)
    cag_diagnostic_set_help(d, "give the number a unit: %.15gdeg", number->as.number);
}

static CagTypes infer_range(Check *c, const CagExpr *e) {
  const CagExpr *ends[] = {e->as.range.low, e->as.range.high, e->as.range.step};
  char found[256], text[320];
  CagTypes types[3] = {0};
  bool known = true;
  for (int i = 0; i < 3 && ends[i]; i++) {
    types[i] = infer(c, ends[i]);
    if (types[i] & (CAG_TYPES(NUMBER) | CAG_TYPES(ANGLE))) continue;
    snprintf(text, sizeof text, "the ends and the step of a range are numbers or angles, found %s",
             cag_types_text(types[i], found, sizeof found));
    report(c, CAG_ERR_type, ends[i]->span, text);
    known = false;
  }
  if (known) check_mixed_range(c, e, types[0], types[1]);
  return CAG_TYPES(RANGE);
}

static size_t error_count(const Check *c) { return c->vm->errors.count + c->vm->errors.dropped; }

// A call that looks right is tried where all that it is given is written out.
static void try_call(Check *c, const CagExpr *e, size_t errors_before) {
  if (!c->unjudged && !c->thunks && error_count(c) == errors_before)
    cag_check_constant(&c->constants, e);
}

static CagTypes infer_pipe(Check *c, const CagExpr *e) {
  const CagExpr *right = e->as.binary.right;
  CallView v = {.e = right->kind == CAG_EXPR_CALL ? right : NULL,
                .piped = e->as.binary.left,
                .span = right->span};
  const size_t before = error_count(c);
  const CagTypes types = check_call(c, v.e ? right->as.call.callee : right, &v);
  try_call(c, e, before);
  return types;
}

static void infer_all(Check *c, CagExpr *const *items, size_t count) {
  for (size_t i = 0; i < count; i++) infer(c, items[i]);
}

// Members of values that have none, or few: those of a vector and of a range.
static void check_member(Check *c, const CagExpr *e, CagTypes types) {
  static const char *const ends[] = {"start", "end", "step"};
  const CagTypes none = CAG_TYPES(NUMBER) | CAG_TYPES(ANGLE) | CAG_TYPES(BOOL) | CAG_TYPES(TEXT) |
                        CAG_TYPES(NONE) | CAG_TYPES_FUNCTION;
  const char *name = e->as.member.name;
  char found[256], text[400];
  bool known = types & ~(none | CAG_TYPES(LIST) | CAG_TYPES(RANGE));
  if (types & CAG_TYPES(LIST)) known |= strlen(name) == 1 && strchr("xyzw", *name);
  for (size_t i = 0; types & CAG_TYPES(RANGE) && i < 3; i++) known |= strcmp(name, ends[i]) == 0;
  if (types & CAG_TYPES(RANGE)) known |= strlen(name) == 1 && strchr("xyzw", *name); // as a list
  if (known) return;
  snprintf(text, sizeof text, "%s has no member `%s`", cag_types_text(types, found, sizeof found),
           name);
  CagDiagnostic *d = report(c, CAG_ERR_field, e->as.member.name_span, text);
  if (cag_foreign_member(name)) cag_diagnostic_set_help(d, "write %s", cag_foreign_member(name));
  else if (cag_builtin_find(name) != (size_t)-1)
    cag_diagnostic_set_help(d, "a function stands behind |>: write x |> %s(...)", name);
}

static CagTypes infer(Check *c, const CagExpr *e) {
  switch (e->kind) {
  case CAG_EXPR_NUMBER: return CAG_TYPES(NUMBER);
  case CAG_EXPR_ANGLE: return CAG_TYPES(ANGLE);
  case CAG_EXPR_TEXT: return CAG_TYPES(TEXT);
  case CAG_EXPR_TEMPLATE: infer_all(c, e->as.list.items, e->as.list.count); return CAG_TYPES(TEXT);
  case CAG_EXPR_TRUE:
  case CAG_EXPR_FALSE: return CAG_TYPES(BOOL);
  case CAG_EXPR_NONE: return CAG_TYPES(NONE);
  case CAG_EXPR_NAME: return infer_name(c, e);
  case CAG_EXPR_GROUP: return infer(c, e->as.unary.operand);
  case CAG_EXPR_SPREAD: infer(c, e->as.unary.operand); return CAG_TYPES_ANY;
  case CAG_EXPR_LIST: infer_all(c, e->as.list.items, e->as.list.count); return CAG_TYPES(LIST);
  case CAG_EXPR_COMPREHENSION: return infer_comprehension(c, e);
  case CAG_EXPR_RECORD:
    for (size_t i = 0; i < e->as.record.count; i++) infer(c, e->as.record.fields[i].value);
    return CAG_TYPES(RECORD);
  case CAG_EXPR_BLOCK: return infer_block(c, e);
  case CAG_EXPR_LAMBDA: walk_function(c, e->as.function); return CAG_TYPES(CLOSURE);
  case CAG_EXPR_IF: return infer_branch(c, e);
  case CAG_EXPR_NEGATE: return infer_negation(c, e);
  case CAG_EXPR_NOT: expect_bool(c, e->as.unary.operand, "not"); return CAG_TYPES(BOOL);
  case CAG_EXPR_AND:
  case CAG_EXPR_OR: {
    const char *word = e->kind == CAG_EXPR_AND ? "and" : "or";
    expect_bool(c, e->as.binary.left, word);
    expect_bool(c, e->as.binary.right, word);
    return CAG_TYPES(BOOL);
  }
  case CAG_EXPR_BINARY: return infer_binary(c, e);
  case CAG_EXPR_PIPE: return infer_pipe(c, e);
  case CAG_EXPR_RANGE: return infer_range(c, e);
  case CAG_EXPR_CALL: {
    CallView v = {.e = e, .span = e->span};
    const size_t before = error_count(c);
    const CagTypes types = check_call(c, e->as.call.callee, &v);
    try_call(c, e, before);
    return types;
  }
  case CAG_EXPR_INDEX: return infer_index(c, e);
  case CAG_EXPR_MEMBER: {
    check_member(c, e, infer(c, e->as.member.object));
    const CagExpr *o = e->as.member.object;
    if (o->kind == CAG_EXPR_NAME && o->as.name.binding == CAG_BIND_DECL && o->as.name.decl &&
        o->as.name.decl->kind == CAG_DECL_IMPORT)
      check_deprecated(c, find_public(c, o->as.name.decl->statement, e->as.member.name),
                       e->as.member.name, e->as.member.name_span);
    return CAG_TYPES_ANY;
  }
  case CAG_EXPR_ERROR: break;
  }
  return CAG_TYPES_ANY;
}

// ---- the module ----

// A number that is written, with its sign; false: something else.
static bool literal(const CagExpr *e, double *x) {
  const bool negative = e->kind == CAG_EXPR_NEGATE;
  if (negative) e = e->as.unary.operand;
  if (e->kind != CAG_EXPR_NUMBER && e->kind != CAG_EXPR_ANGLE) return false;
  *x = negative ? -e->as.number : e->as.number;
  return true;
}

// A default that is written out, of another kind than its range, or not in its list.
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
             domain->kind == CAG_EXPR_LIST ? "the list of what it may be" : "its range");
    report(c, CAG_ERR_param_default, s->as.param.value->span, text);
    return;
  }
  if (!domain || domain->kind != CAG_EXPR_RANGE || !literal(s->as.param.value, &value) ||
      !literal(domain->as.range.low, &low) || !literal(domain->as.range.high, &high))
    return;
  if (value >= low && (domain->as.range.open ? value < high : value <= high)) return;
  snprintf(text, sizeof text, "the default of %s lies outside of its range",
           s->as.param.decl->name);
  report(c, CAG_ERR_param_default, s->as.param.value->span, text);
}

static void check_shown(Check *c, const CagExpr *e) {
  const CagTypes unseen = CAG_TYPES(NUMBER) | CAG_TYPES(ANGLE) | CAG_TYPES(BOOL) | CAG_TYPES(TEXT) |
                          CAG_TYPES(NONE) | CAG_TYPES_FUNCTION;
  const CagTypes types = infer(c, e);
  if (types & ~unseen) return;
  report_found(c, CAG_ERR_no_image, e->span,
               "show wants shapes, lights, cameras or settings of the scene", types);
}

static void walk_statement(Check *c, const CagStatement *s) {
  switch (s->kind) {
  case CAG_STATEMENT_PARAM:
    types_of_top(c, s->as.param.decl);
    check_param(c, s);
    break;
  case CAG_STATEMENT_DEFINITION: types_of_top(c, s->as.definition.decl); break;
  case CAG_STATEMENT_SHOW:
    for (size_t i = 0; i < s->as.list.count; i++) check_shown(c, s->as.list.items[i]);
    break;
  case CAG_STATEMENT_PRINT: infer_all(c, s->as.list.items, s->as.list.count); break;
  case CAG_STATEMENT_ASSERT:
    expect_bool(c, s->as.assertion.condition, "assert");
    if (s->as.assertion.message) infer(c, s->as.assertion.message);
    break;
  case CAG_STATEMENT_EXPRESSION: infer(c, s->as.expression); break;
  case CAG_STATEMENT_IMPORT: break;
  }
}

// Marks what statements use, and what that uses. Of a module that shows and prints nothing all
// public definitions are for others.
static void mark_reached(Check *c, bool is_script) {
  const size_t n = c->ast->top_count;
  for (size_t i = 0; i < n; i++)
    if (!is_script && c->ast->tops[i]->name[0] != '_') c->reached[i] = true;
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
    if (c->reached[i] || (decl->statement->kind == CAG_STATEMENT_PARAM && decl->used)) continue;
    snprintf(text, sizeof text,
             decl->used ? "%s is used only by what nothing uses" : "nothing uses %s", decl->name);
    warn(c, CAG_ERR_unused, decl->span, text);
  }
  for (size_t i = 0; i < c->ast->count; i++) {
    const CagStatement *s = c->ast->statements[i];
    if (s->kind != CAG_STATEMENT_IMPORT) continue;
    if (s->as.import.decl && !s->as.import.decl->used && s->as.import.name_count == 0) {
      snprintf(text, sizeof text, "nothing uses the module %s", s->as.import.decl->name);
      warn(c, CAG_ERR_unused, s->as.import.path_span, text);
    }
    for (size_t k = 0; k < s->as.import.name_count; k++) {
      const CagDecl *decl = s->as.import.names[k].decl;
      if (decl->used) continue;
      snprintf(text, sizeof text, "nothing uses %s", decl->name);
      warn(c, CAG_ERR_unused, decl->span, text);
    }
  }
}

// Definitions that errors from number `from` on lie in are not evaluated.
static void mark_bad(Check *c, size_t from) {
  for (size_t i = from; i < c->vm->errors.count; i++)
    for (size_t k = 0; k < c->ast->top_count; k++) {
      const CagSpan s = c->ast->tops[k]->statement->span, at = c->vm->errors.items[i].span;
      if (s.start <= at.start && at.end <= s.end) c->top_bad[k] = true;
    }
}

bool cag_check_module(CagVm *vm, CagModuleUnit *m) {
  const size_t n = m->ast->top_count, known = vm->errors.count;
  Check c = {.vm = vm, .unit = m, .ast = m->ast, .top = n};
  c.top_types = cag_checked(calloc(n + 1, sizeof *c.top_types));
  c.top_done = cag_checked(calloc(n + 1, 1));
  c.top_busy = cag_checked(calloc(n + 1, 1));
  c.reached = cag_checked(calloc(n + 1, 1));
  c.top_bad = cag_checked(calloc(n + 1, 1));
  c.constants = (CagConstants){.vm = vm, .unit = m, .is_bad = c.top_bad};
  vm->failed = false;
  cag_check_circles(m->ast, &vm->errors);
  mark_bad(&c, known);
  for (size_t i = 0; i < m->ast->count; i++) walk_statement(&c, m->ast->statements[i]);
  if (known == m->first_error) warn_unused(&c); // what an unknown name was meant to be is not known
  cag_diagnostics_sort(&vm->errors, m->first_error);
  free(c.top_types);
  free(c.top_done);
  free(c.top_busy);
  free(c.reached);
  free(c.top_bad);
  free(c.edges);
  free(c.known);
  free(c.taken);
  cag_diagnostics_free(&c.ignored);
  for (size_t i = known; i < vm->errors.count; i++)
    if (vm->errors.items[i].severity == CAG_SEVERITY_ERROR) return false;
  return true;
}
