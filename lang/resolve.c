// Name resolution.
//
// Every name of a tree has a number, and the array `current` holds its meaning: `current[number]`
// is the innermost visible declaration. Opening a scope marks a position in the stack of
// declarations. Closing it restores what each of them hid. So a lookup takes constant time,
// regardless of the number of names in a scope.

#include "base/array.h"
#include "base/memory.h"
#include "lang/foreign.h"
#include "lang/lexer.h"
#include "lang/names.h"
#include "lang/parser.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

typedef struct Entry {
  CagDecl *decl;
  CagDecl *covered; // previous meaning of the name
  uint32_t covered_scope;
} Entry;

typedef struct Current {
  CagDecl *decl;
  uint32_t scope; // depth of its scope; 0 is the module
  bool damaged;   // unparsable text may define it, so nothing is known about it
  bool head;      // first name of an expression that is a statement, which may lack a `=`
} Current;

// An enclosing block, to distinguish a name that is used too early from an unknown one.
typedef struct OpenBlock {
  const CagExpr *block;
  const struct OpenBlock *outer;
} OpenBlock;

typedef struct Resolver {
  const CagModuleAst *module;
  const CagResolveEnv *env;
  CagDiagnostics *errors;
  Current *current; // one for each name of the tree
  Entry *entries;   // visible declarations, innermost last
  size_t count, capacity;
  uint32_t scope;
  CagFunctionAst *function; // innermost enclosing function
  const OpenBlock *block;
  const char *param;              // the param whose default or domain is being resolved; NULL: none
  const CagFunctionAst *defaults; // the function whose defaults are being resolved; NULL: none
  size_t default_index;
  size_t templates; // number of enclosing texts with { }
  size_t searches;  // for the nearest names
  CagArena scratch; // holds lists that live as long as the resolver
} Resolver;

#define NOT_FOUND ((size_t)-1)

static bool is_blank(const char *name) { return name[0] == '_' && name[1] == 0; }

static Current *current_of(Resolver *r, const char *name) {
  return &r->current[cag_name_head(name)->index];
}

// ---- errors ----

static CagDiagnostic *report(Resolver *r, CagErrorId id, CagSpan span, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
static CagDiagnostic *report(Resolver *r, CagErrorId id, CagSpan span, const char *format, ...) {
  va_list args;
  va_start(args, format);
  char message[512];
  vsnprintf(message, sizeof message, format, args);
  va_end(args);
  return cag_diagnostics_add(r->errors, id, r->module->source, span, "%s", message);
}

static bool full(const Resolver *r) { return cag_diagnostics_full(r->errors); }

// The number of unknown names for which the nearest name is searched. In a file with more, the
// reason is a single missing line rather than misspellings.
#define SEARCHES_MAX 100

// Returns the known name nearest to `name`, from the enclosing scopes, the module, earlier inputs,
// and the built-ins.
static const char *nearest(Resolver *r, const char *name) {
  const CagResolveEnv *env = r->env;
  if (r->searches++ >= SEARCHES_MAX) return NULL;
  size_t count = 0, most = r->count + env->outer_count + env->builtin_count;
  const char **names = cag_arena_alloc(&r->scratch, (most + 1) * sizeof *names);
  for (size_t i = r->count; i-- > 0;)
    if (!is_blank(r->entries[i].decl->name)) names[count++] = r->entries[i].decl->name;
  for (size_t i = 0; i < env->outer_count; i++) names[count++] = env->outer_names[i];
  for (size_t i = 0; i < env->builtin_count; i++) names[count++] = env->builtin_names[i];
  return cag_nearest_name(name, names, count);
}

// Returns the definition of the name in an enclosing block after its use, or NULL.
static const CagDecl *defined_below(const Resolver *r, const char *name) {
  for (const OpenBlock *b = r->block; b; b = b->outer)
    for (size_t i = 0; i < b->block->as.block.count; i++) {
      const CagStatement *s = b->block->as.block.statements[i];
      if (s->kind != CAG_STATEMENT_DEFINITION) continue;
      if (s->as.definition.decl->name == name) return s->as.definition.decl;
      const CagPattern *pattern = s->as.definition.pattern;
      for (size_t k = 0; pattern && k < pattern->name_count; k++)
        if (pattern->names[k]->name == name) return pattern->names[k];
    }
  return NULL;
}

static void unknown_name(Resolver *r, const CagExpr *e) {
  const char *name = e->as.name.id;
  if (full(r)) {
    r->errors->dropped++;
    return;
  }
  const CagDecl *below = defined_below(r, name);
  if (below) {
    CagDiagnostic *d =
        report(r, CAG_ERR_used_before, e->span, "%s is used before its definition", name);
    cag_diagnostic_set_help(
        d, below->span.start < e->span.start
               ? "a definition that calls itself is written with its parameters: f(n) = ..."
               : "a block runs from top to bottom: define it above");
    cag_diagnostic_add_note(d, CAG_NOTE_RELATED, r->module->source, below->span, "defined here");
    return;
  }
  for (size_t i = r->defaults ? r->default_index : 0;
       r->defaults && i < r->defaults->parameter_count; i++) {
    const CagDecl *p = r->defaults->parameters[i].decl;
    if (p->name != name) continue;
    CagDiagnostic *d =
        report(r, CAG_ERR_used_before, e->span, "%s is a parameter that comes later", name);
    cag_diagnostic_set_help(d, "a default can use the parameters before it");
    cag_diagnostic_add_note(d, CAG_NOTE_RELATED, r->module->source, p->span, "the parameter");
    return;
  }
  CagDiagnostic *d = report(r, CAG_ERR_unknown_name, e->span, "unknown name `%s`", name);
  const char *form = cag_foreign_name(name), *near = form ? NULL : nearest(r, name);
  if (form) cag_diagnostic_set_help(d, "write %s", form);
  if (near) cag_diagnostic_set_help(d, "did you mean `%s`?", near);
  else if (!form && r->templates) cag_diagnostic_set_help(d, "%s", cag_lexer_brace_help);
}

// ---- scopes ----

static size_t open_scope(Resolver *r) {
  r->scope++;
  return r->count;
}

static void close_scope(Resolver *r, size_t mark) {
  while (r->count > mark) {
    Entry *e = &r->entries[--r->count];
    Current *c = current_of(r, e->decl->name);
    c->decl = e->covered;
    c->scope = e->covered_scope;
  }
  r->scope--;
}

static void report_twice(Resolver *r, const CagDecl *d, const CagDecl *first) {
  CagDiagnostic *error = report(r, CAG_ERR_defined_twice, d->span, "%s is defined twice", d->name);
  cag_diagnostic_set_help(error, "a name is defined once in its scope");
  cag_diagnostic_add_note(error, CAG_NOTE_RELATED, r->module->source, first->span,
                          "first defined here");
}

static const char *role_of(const CagDecl *d) {
  switch (d->kind) {
  case CAG_DECL_PARAMETER: return "a parameter";
  case CAG_DECL_BLOCK: return "a definition of a block";
  case CAG_DECL_CLAUSE: return "a name of a comprehension";
  default: return "a name";
  }
}

// Text in the first columns of an unparsable statement may be definitions.
static bool is_damaged(const CagDecl *d) {
  return d->statement && d->statement->damage == CAG_DAMAGED;
}

// Makes a declaration visible. Reports a duplicate in the same scope, and a name that hides one of
// an enclosing inner scope.
static void declare(Resolver *r, CagDecl *d) {
  d->owner = r->function;
  if (is_blank(d->name)) return;
  Current *c = current_of(r, d->name);
  if (c->decl && c->scope == r->scope) {
    if (!is_damaged(d) && !is_damaged(c->decl)) report_twice(r, d, c->decl);
    return;
  }
  if (c->decl && c->scope > 0) {
    CagDiagnostic *e =
        report(r, CAG_ERR_hides_name, d->span, "%s hides %s around it", d->name, role_of(c->decl));
    cag_diagnostic_set_help(e, "choose another name");
    cag_diagnostic_add_note(e, CAG_NOTE_RELATED, r->module->source, c->decl->span, "the outer %s",
                            d->name);
  }
  if (!CAG_RESERVE(r->entries, r->capacity, r->count + 1)) cag_memory_leave();
  r->entries[r->count++] = (Entry){d, c->decl, c->scope};
  c->decl = d;
  c->scope = r->scope;
}

// Makes the names of a pattern visible, or else (NULL) the name of `whole`.
static void declare_names(Resolver *r, CagDecl *whole, const CagPattern *pattern) {
  if (!pattern) {
    declare(r, whole);
    return;
  }
  if (whole) whole->owner = r->function;
  for (size_t i = 0; i < pattern->name_count; i++) declare(r, pattern->names[i]);
}

// ---- expressions ----

static void walk(Resolver *r, CagExpr *e);

// The default and the domain of a param can use only built-in names, and names that they define.
static bool allowed_in_param(Resolver *r, const CagExpr *e, const CagDecl *d) {
  if (!r->param || d->kind == CAG_DECL_PARAMETER || d->kind == CAG_DECL_BLOCK ||
      d->kind == CAG_DECL_CLAUSE)
    return true;
  CagDiagnostic *error = report(
      r, CAG_ERR_param_not_builtin, e->span,
      "the param %s can use only built-in names, but %s is defined in the file", r->param, d->name);
  cag_diagnostic_set_help(error, "write its value");
  cag_diagnostic_add_note(error, CAG_NOTE_RELATED, r->module->source, d->span, "defined here");
  return false;
}

static void walk_name(Resolver *r, CagExpr *e) {
  const char *name = e->as.name.id;
  if (is_blank(name)) {
    CagDiagnostic *d =
        report(r, CAG_ERR_underscore_value, e->span, "`_` stands for a value that is not used");
    cag_diagnostic_set_help(d, "give it a name in its definition");
    return;
  }
  CagDecl *decl = current_of(r, name)->decl;
  if (decl) {
    decl->used = true;
    if (!allowed_in_param(r, e, decl)) return;
    e->as.name.binding = CAG_BIND_DECL;
    e->as.name.decl = decl;
    return;
  }
  if (current_of(r, name)->damaged) return;
  const CagResolveEnv *env = r->env;
  size_t outer = env->find_outer && !r->param ? env->find_outer(env->context, name) : NOT_FOUND;
  size_t builtin =
      outer == NOT_FOUND && env->find_builtin ? env->find_builtin(env->context, name) : NOT_FOUND;
  if (outer != NOT_FOUND) {
    e->as.name.binding = CAG_BIND_OUTER;
    e->as.name.index = outer;
  } else if (builtin != NOT_FOUND) {
    e->as.name.binding = CAG_BIND_BUILTIN;
    e->as.name.index = builtin;
  } else if (!current_of(r, name)->head || cag_foreign_name(name)) {
    unknown_name(r, e);
  }
}

// Checks that the module of an import defines a name, and reports it if not.
static void check_in_module(Resolver *r, const CagStatement *import, const char *name,
                            CagSpan span) {
  if (name[0] == '_') {
    CagDiagnostic *d =
        report(r, CAG_ERR_private_name, span, "%s is private to %s", name, import->as.import.path);
    cag_diagnostic_set_help(d, "names that start with _ are private to their file");
    return;
  }
  const CagResolveEnv *env = r->env;
  const char *const *names = NULL;
  size_t count = 0;
  if (!env->module_has || env->module_has(env->context, import, name, &names, &count)) return;
  CagDiagnostic *d =
      report(r, CAG_ERR_not_in_module, span, "%s defines no %s", import->as.import.path, name);
  const char *near = names ? cag_nearest_name(name, names, count) : NULL;
  if (near) cag_diagnostic_set_help(d, "did you mean `%s`?", near);
}

static void walk_member(Resolver *r, CagExpr *e) {
  const CagExpr *object = e->as.member.object;
  walk(r, e->as.member.object);
  if (object->kind == CAG_EXPR_NAME && object->as.name.binding == CAG_BIND_DECL &&
      object->as.name.decl->kind == CAG_DECL_IMPORT)
    check_in_module(r, object->as.name.decl->statement, e->as.member.name, e->as.member.name_span);
}

static void walk_parameters(Resolver *r, CagFunctionAst *f) {
  const CagFunctionAst *outer_defaults = r->defaults;
  size_t outer_index = r->default_index;
  const CagParameter *with_default = NULL;
  for (size_t i = 0; i < f->parameter_count; i++) {
    CagParameter *p = &f->parameters[i];
    if (p->fallback) {
      with_default = p;
      r->defaults = f;
      r->default_index = i;
      walk(r, p->fallback);
      r->defaults = outer_defaults;
      r->default_index = outer_index;
    } else if (with_default) {
      CagDiagnostic *d =
          report(r, CAG_ERR_default_order, p->decl->span,
                 "%s has no default, but comes after a parameter with a default", p->decl->name);
      cag_diagnostic_set_help(d, "parameters with defaults come last");
      cag_diagnostic_add_note(d, CAG_NOTE_RELATED, r->module->source, with_default->decl->span,
                              "the parameter with a default");
    }
    declare_names(r, p->decl, p->pattern);
  }
}

static void walk_function(Resolver *r, CagFunctionAst *f) {
  f->outer = r->function;
  r->function = f;
  size_t mark = open_scope(r);
  walk_parameters(r, f);
  walk(r, f->body);
  close_scope(r, mark);
  r->function = f->outer;
}

static void walk_comprehension(Resolver *r, CagExpr *e) {
  // Each clause opens a new scope inside the previous one, so that a later name cannot hide an
  // earlier one.
  size_t mark = r->count;
  uint32_t scope = r->scope;
  for (size_t i = 0; i < e->as.comprehension.count; i++) {
    CagClause *c = &e->as.comprehension.clauses[i];
    walk(r, c->source);
    open_scope(r);
    declare_names(r, NULL, c->pattern);
    if (c->filter) walk(r, c->filter);
  }
  walk(r, e->as.comprehension.body);
  close_scope(r, mark);
  r->scope = scope;
}

static void clear_errors(void *errors) { cag_diagnostics_clear(errors); }

// Binds the names in the readable part of damaged text, for editors. Nothing is reported, because a
// name may be defined in the part that could not be read.
static void walk_damaged(Resolver *r, void (*work)(void *context, void *what), void *what) {
  CagDiagnostics *const errors = r->errors;
  CagDiagnostics unseen = {.most = 1};
  CagCleanup cleanup;
  cag_cleanup_push(&cleanup, clear_errors, &unseen);
  r->errors = &unseen;
  work(r, what);
  r->errors = errors;
  cag_cleanup_run(&cleanup);
}

static void walk_damaged_expression(void *context, void *e) { walk(context, e); }

static void walk_block_statement(void *context, void *statement) {
  Resolver *r = context;
  CagStatement *s = statement;
  if (s->kind == CAG_STATEMENT_ASSERT) {
    walk(r, s->as.assertion.condition);
    if (s->as.assertion.message) walk(r, s->as.assertion.message);
    return;
  }
  CagExpr *value = s->as.definition.value;
  bool function = value->kind == CAG_EXPR_LAMBDA && value->as.function->self;
  if (function) declare(r, s->as.definition.decl);
  walk(r, value);
  if (!function) declare_names(r, s->as.definition.decl, s->as.definition.pattern);
}

// A function in a block is visible in its own body, so it is declared first. Other definitions are
// declared after their value.
static void walk_block(Resolver *r, CagExpr *e) {
  OpenBlock open = {e, r->block};
  r->block = &open;
  size_t mark = open_scope(r);
  for (size_t i = 0; i < e->as.block.count; i++) {
    CagStatement *s = e->as.block.statements[i];
    if (s->damage == CAG_DAMAGED) walk_damaged(r, walk_block_statement, s);
    else walk_block_statement(r, s);
  }
  if (e->as.block.damaged) walk_damaged(r, walk_damaged_expression, e->as.block.value);
  else walk(r, e->as.block.value);
  close_scope(r, mark);
  r->block = open.outer;
}

// ---- duplicates ----

// Up to this many names are compared pairwise. More are sorted first.
#define FEW 16

typedef struct Given {
  const char *name;
  CagSpan span;
} Given;

static int by_name(const void *a, const void *b) {
  const Given *x = a, *y = b;
  if (x->name != y->name) return x->name < y->name ? -1 : 1;
  return x->span.start < y->span.start ? -1 : x->span.start > y->span.start;
}

static void report_given_twice(Resolver *r, CagErrorId id, const char *what, Given first,
                               Given again) {
  CagDiagnostic *d = report(r, id, again.span, "the %s %s is given twice", what, again.name);
  cag_diagnostic_add_note(d, CAG_NOTE_RELATED, r->module->source, first.span, "first given here");
}

// Reports duplicate names in the list, which is sorted.
static void check_twice(Resolver *r, Given *given, size_t count, CagErrorId id, const char *what) {
  if (count <= FEW) {
    for (size_t i = 1; i < count; i++)
      for (size_t k = 0; k < i; k++)
        if (given[k].name == given[i].name) {
          report_given_twice(r, id, what, given[k], given[i]);
          break;
        }
    return;
  }
  qsort(given, count, sizeof *given, by_name);
  for (size_t i = 1, first = 0; i < count; i++) {
    if (given[i].name == given[first].name) report_given_twice(r, id, what, given[first], given[i]);
    else first = i;
  }
}

static void walk_call(Resolver *r, CagExpr *e) {
  walk(r, e->as.call.callee);
  Given few[FEW], *given = few;
  size_t named = 0, count = e->as.call.count;
  if (count > FEW) given = cag_arena_alloc(&r->scratch, count * sizeof *given);
  for (size_t i = 0; i < count; i++) {
    CagArgument *a = &e->as.call.arguments[i];
    walk(r, a->value);
    if (a->name) given[named++] = (Given){a->name, a->name_span};
  }
  check_twice(r, given, named, CAG_ERR_argument_twice, "argument");
}

static void walk_record(Resolver *r, CagExpr *e) {
  Given few[FEW], *given = few;
  size_t named = 0, count = e->as.record.count;
  if (count > FEW) given = cag_arena_alloc(&r->scratch, count * sizeof *given);
  for (size_t i = 0; i < count; i++) {
    CagField *f = &e->as.record.fields[i];
    walk(r, f->value);
    if (f->name) given[named++] = (Given){f->name, f->name_span};
  }
  check_twice(r, given, named, CAG_ERR_field_twice, "field");
}

static void walk_all(Resolver *r, CagExpr **items, size_t count) {
  for (size_t i = 0; i < count; i++) walk(r, items[i]);
}

static void walk(Resolver *r, CagExpr *e) {
  cag_source_check(r->module->source);
  switch (e->kind) {
  case CAG_EXPR_NUMBER:
  case CAG_EXPR_ANGLE:
  case CAG_EXPR_TEXT:
  case CAG_EXPR_TRUE:
  case CAG_EXPR_FALSE:
  case CAG_EXPR_NONE:
  case CAG_EXPR_ERROR: break;
  case CAG_EXPR_NAME: walk_name(r, e); break;
  case CAG_EXPR_TEMPLATE:
    r->templates++;
    walk_all(r, e->as.list.items, e->as.list.count);
    r->templates--;
    break;
  case CAG_EXPR_LIST: walk_all(r, e->as.list.items, e->as.list.count); break;
  case CAG_EXPR_GROUP:
  case CAG_EXPR_SPREAD:
  case CAG_EXPR_NEGATE:
  case CAG_EXPR_NOT: walk(r, e->as.unary.operand); break;
  case CAG_EXPR_BINARY:
  case CAG_EXPR_AND:
  case CAG_EXPR_OR:
  case CAG_EXPR_PIPE:
  case CAG_EXPR_INDEX:
    walk(r, e->as.binary.left);
    walk(r, e->as.binary.right);
    break;
  case CAG_EXPR_RANGE:
    walk(r, e->as.range.low);
    walk(r, e->as.range.high);
    if (e->as.range.step) walk(r, e->as.range.step);
    break;
  case CAG_EXPR_IF:
    for (; e->kind == CAG_EXPR_IF; e = e->as.branch.otherwise) { // chains of else if may be long
      walk(r, e->as.branch.condition);
      walk(r, e->as.branch.then);
    }
    walk(r, e);
    break;
  case CAG_EXPR_CALL: walk_call(r, e); break;
  case CAG_EXPR_MEMBER: walk_member(r, e); break;
  case CAG_EXPR_COMPREHENSION: walk_comprehension(r, e); break;
  case CAG_EXPR_RECORD: walk_record(r, e); break;
  case CAG_EXPR_BLOCK: walk_block(r, e); break;
  case CAG_EXPR_LAMBDA: walk_function(r, e->as.function); break;
  }
}

// ---- the module ----

static void declare_import(Resolver *r, CagStatement *s) {
  if (s->as.import.decl) declare(r, s->as.import.decl);
  for (size_t i = 0; i < s->as.import.name_count; i++) {
    CagImportName *n = &s->as.import.names[i];
    declare(r, n->decl);
    if (s->damage != CAG_DAMAGED) check_in_module(r, s, n->name, n->decl->span);
  }
}

static void declare_tops(Resolver *r) {
  for (size_t i = 0; i < r->module->count; i++) {
    CagStatement *s = r->module->statements[i];
    if (s->kind == CAG_STATEMENT_IMPORT) declare_import(r, s);
    else if (s->kind == CAG_STATEMENT_PARAM) declare(r, s->as.param.decl);
    else if (s->kind == CAG_STATEMENT_DEFINITION)
      declare_names(r, s->as.definition.decl, s->as.definition.pattern);
  }
}

static void walk_statement(Resolver *r, CagStatement *s) {
  switch (s->kind) {
  case CAG_STATEMENT_IMPORT: break;
  case CAG_STATEMENT_PARAM:
    r->param = s->as.param.decl->name;
    walk(r, s->as.param.value);
    if (s->as.param.domain) walk(r, s->as.param.domain);
    r->param = NULL;
    break;
  case CAG_STATEMENT_DEFINITION: walk(r, s->as.definition.value); break;
  case CAG_STATEMENT_SHOW:
  case CAG_STATEMENT_PRINT: walk_all(r, s->as.list.items, s->as.list.count); break;
  case CAG_STATEMENT_ASSERT:
    walk(r, s->as.assertion.condition);
    if (s->as.assertion.message) walk(r, s->as.assertion.message);
    break;
  case CAG_STATEMENT_EXPRESSION: walk(r, s->as.expression); break;
  }
}

static void walk_damaged_statement(void *context, void *statement) {
  walk_statement(context, statement);
}

// Returns the name at the start of an expression, or NULL.
static const char *head_of(const CagExpr *e) {
  for (;;) switch (e->kind) {
    case CAG_EXPR_NAME: return e->as.name.id;
    case CAG_EXPR_CALL: e = e->as.call.callee; break;
    case CAG_EXPR_MEMBER: e = e->as.member.object; break;
    case CAG_EXPR_RANGE: e = e->as.range.low; break;
    case CAG_EXPR_BINARY:
    case CAG_EXPR_AND:
    case CAG_EXPR_OR:
    case CAG_EXPR_PIPE:
    case CAG_EXPR_INDEX: e = e->as.binary.left; break;
    default: return NULL;
    }
}

// Marks names whose definitions syntax errors may have hidden.
static void mark_damaged(Resolver *r) {
  const CagModuleAst *m = r->module;
  for (size_t i = 0; i < m->damaged_name_count; i++)
    current_of(r, m->damaged_names[i])->damaged = true;
  for (size_t i = 0; i < m->count; i++) {
    const CagStatement *s = m->statements[i];
    if (s->kind != CAG_STATEMENT_EXPRESSION || s->damage == CAG_SOUND) continue;
    const char *name = head_of(s->as.expression);
    if (!name) continue;
    if (s->damage == CAG_DAMAGED) current_of(r, name)->damaged = true;
    else current_of(r, name)->head = true;
  }
}

static void resolve(void *context) {
  Resolver *r = context;
  const CagModuleAst *m = r->module;
  r->current = cag_checked(cag_calloc(m->name_count + 1, sizeof *r->current));
  mark_damaged(r);
  declare_tops(r);
  for (size_t i = 0; i < m->count; i++)
    if (m->statements[i]->damage == CAG_DAMAGED)
      walk_damaged(r, walk_damaged_statement, m->statements[i]);
    else walk_statement(r, m->statements[i]);
}

bool cag_resolve(CagModuleAst *m, const CagResolveEnv *env, CagDiagnostics *errors) {
  Resolver r = {.module = m, .env = env, .errors = errors};
  const size_t before = errors->count;
  const bool done = cag_memory_guard(resolve, &r);
  cag_diagnostics_sort(errors, before);
  cag_free(r.current);
  cag_free(r.entries);
  cag_arena_free(&r.scratch);
  if (!done && !cag_source_stopped(m->source))
    cag_diagnostics_add(errors, CAG_ERR_limit_memory, NULL, (CagSpan){0, 0},
                        "not enough memory for the names of %s", m->source->name);
  return done;
}
