// The names that are visible at a place, and the fields of values.

#include <string.h>

#include "base/memory.h"
#include "interp/document/document.h"
#include "interp/vm/builtin.h"

// Longer chains of definitions are not followed.
#define DEPTH_MAX 20

// --- Scopes ---

typedef struct Scope {
  size_t offset;
  const char *text;
  size_t unfinished;     // what ends here or later may go on to the offset, because of an error
  const CagDecl **decls; // outermost first
  size_t count, capacity;
  CagArena *memory;
} Scope;

static void add_decl(Scope *s, const CagDecl *decl) {
  if (!decl || strcmp(decl->name, "_") == 0) return;
  if (s->count == s->capacity) {
    const CagDecl **old = s->decls;
    s->capacity = 2 * s->capacity + 32;
    s->decls = cag_arena_alloc(s->memory, s->capacity * sizeof *s->decls);
    if (s->count) memcpy(s->decls, old, s->count * sizeof *old);
  }
  s->decls[s->count++] = decl;
}

// Adds the names of a pattern, or else (NULL) the name of `whole`.
static void add_names(Scope *s, const CagDecl *whole, const CagPattern *pattern) {
  if (!pattern) add_decl(s, whole);
  for (size_t i = 0; pattern && i < pattern->name_count; i++) add_decl(s, pattern->names[i]);
}

// Tests whether only blanks are between the end of an expression and the offset, and no bracket
// closes the expression. It may then go on there.
static bool continues(const Scope *s, CagSpan span) {
  if (span.end == 0 || strchr(")]}\"`", s->text[span.end - 1])) return false;
  return strspn(s->text + span.end, " \t") >= s->offset - span.end;
}

static bool encloses(const Scope *s, CagSpan span) {
  if (span.start > s->offset) return false;
  return s->offset <= span.end || span.end >= s->unfinished || continues(s, span);
}

static void enter_expression(void *context, const CagExpr *e);

// The definitions of a block are visible after their statement; functions, also within it.
static void enter_block(Scope *s, const CagExpr *e) {
  for (size_t i = 0; i < e->as.block.count; i++) {
    const CagStatement *st = e->as.block.statements[i];
    if (st->span.start > s->offset) break;
    if (st->kind != CAG_STATEMENT_DEFINITION) continue;
    const CagExpr *value = st->as.definition.value;
    const bool function = value->kind == CAG_EXPR_LAMBDA && value->as.function->self;
    if (st->span.end <= s->offset || function)
      add_names(s, st->as.definition.decl, st->as.definition.pattern);
  }
}

static void enter_clauses(Scope *s, const CagExpr *e) {
  for (size_t i = 0; i < e->as.comprehension.count; i++) {
    const CagClause *c = &e->as.comprehension.clauses[i];
    if (c->source->span.end > s->offset) break;
    add_names(s, NULL, c->pattern);
  }
}

static void enter_expression(void *context, const CagExpr *e) {
  Scope *s = context;
  if (!encloses(s, e->span)) return;
  if (e->kind == CAG_EXPR_LAMBDA)
    for (size_t i = 0; i < e->as.function->parameter_count; i++)
      add_names(s, e->as.function->parameters[i].decl, e->as.function->parameters[i].pattern);
  else if (e->kind == CAG_EXPR_BLOCK) enter_block(s, e);
  else if (e->kind == CAG_EXPR_COMPREHENSION) enter_clauses(s, e);
  cag_tree_below(e, enter_expression, s);
}

static void gather(Scope *s, const Document *d) {
  const CagModuleAst *ast = d->unit->ast;
  const CagStatement *st = ast ? cag_tree_statement(ast, s->offset) : NULL;
  if (!st) return;
  s->unfinished = st->damage == CAG_SOUND ? SIZE_MAX : st->span.end;
  cag_tree_of_statement(st, enter_expression, s);
}

static void gather_module(Scope *s, const Document *d) {
  const CagModuleAst *ast = d->unit->ast;
  for (size_t i = 0; ast && i < ast->count; i++) {
    const CagStatement *st = ast->statements[i];
    if (st->kind == CAG_STATEMENT_PARAM) add_decl(s, st->as.param.decl);
    if (st->kind == CAG_STATEMENT_DEFINITION)
      add_names(s, st->as.definition.decl, st->as.definition.pattern);
    if (st->kind != CAG_STATEMENT_IMPORT) continue;
    add_decl(s, st->as.import.decl);
    for (size_t k = 0; k < st->as.import.name_count; k++) add_decl(s, st->as.import.names[k].decl);
  }
}

static void free_arena(void *arena) { cag_arena_free(arena); }

void cag_document_scope(const Document *d, size_t offset,
                        void (*give)(void *context, const CagDecl *decl), void *context) {
  CagArena memory = {0};
  CagCleanup cleanup;
  cag_cleanup_push(&cleanup, free_arena, &memory);
  Scope inner = {.offset = offset, .text = d->text, .memory = &memory}, outer = inner;
  gather(&inner, d);
  gather_module(&outer, d);
  for (size_t i = inner.count; i-- > 0;) give(context, inner.decls[i]);
  for (size_t i = 0; i < outer.count; i++) give(context, outer.decls[i]);
  cag_cleanup_run(&cleanup);
}

typedef struct Lookup {
  const char *name;
  size_t length;
  const CagDecl *found;
} Lookup;

static void compare_name(void *context, const CagDecl *decl) {
  Lookup *l = context;
  if (!l->found && strlen(decl->name) == l->length && !memcmp(decl->name, l->name, l->length))
    l->found = decl;
}

Entity cag_document_lookup(const Document *d, size_t offset, const char *name, size_t length) {
  Lookup l = {name, length, NULL};
  cag_document_scope(d, offset, compare_name, &l);
  if (l.found) return cag_entity_of_decl(d->session->vm, d->unit, l.found);
  char word[128];
  if (length >= sizeof word) return (Entity){.kind = ENTITY_NONE};
  memcpy(word, name, length);
  word[length] = 0;
  const size_t index = cag_builtin_find(word);
  if (index == (size_t)-1) return (Entity){.kind = ENTITY_NONE};
  return (Entity){.kind = ENTITY_BUILTIN, .index = index, .name = cag_builtin_name(index)};
}

// --- Fields ---

typedef struct Fields {
  const CagVm *vm;
  GiveField *give;
  void *context;
} Fields;

static void fields_of(const Fields *f, const CagModuleUnit *unit, const CagExpr *e, int depth);

static void fields_of_module(const Fields *f, const CagModuleUnit *m) {
  for (size_t i = 0; i < m->public_count; i++) {
    const CagDecl *decl = m->publics[i].decl;
    const CagExpr *value = cag_tree_value(decl);
    if (!value) value = decl->statement->as.definition.value; // of the whole pattern
    f->give(f->context, m->publics[i].name, value, m);
  }
}

static void fields_of_entity(const Fields *f, const Entity *e, int depth, bool called) {
  const CagExpr *value = cag_entity_value(e);
  if (e->kind == ENTITY_DECL && e->decl->kind == CAG_DECL_IMPORT) {
    const CagStatement *s = e->decl->statement;
    if (s->as.import.module < f->vm->module_count)
      fields_of_module(f, f->vm->modules[s->as.import.module]);
    return;
  }
  if (!value) return;
  if (called) value = value->kind == CAG_EXPR_LAMBDA ? value->as.function->body : NULL;
  if (value) fields_of(f, e->unit, value, depth + 1);
}

typedef struct Search {
  const char *name;
  const CagExpr *value;
  const CagModuleUnit *unit;
} Search;

static void take_field(void *context, const char *name, const CagExpr *value,
                       const CagModuleUnit *unit) {
  Search *s = context;
  if (strcmp(name, s->name) != 0) return;
  s->value = value; // later fields replace earlier ones
  s->unit = unit;
}

static void fields_of_member(const Fields *f, const CagModuleUnit *unit, const CagExpr *e,
                             int depth) {
  const Entity entity = cag_entity_of_member(f->vm, unit, e);
  if (entity.kind == ENTITY_DECL) {
    fields_of_entity(f, &entity, depth, false);
    return;
  }
  Search s = {.name = e->as.member.name};
  const Fields inner = {f->vm, take_field, &s};
  fields_of(&inner, unit, e->as.member.object, depth + 1);
  if (s.value) fields_of(f, s.unit, s.value, depth + 1);
}

// Follows definitions, calls of functions of scripts, and spreads to a record.
static void fields_of(const Fields *f, const CagModuleUnit *unit, const CagExpr *e, int depth) {
  if (depth > DEPTH_MAX) return;
  Entity entity;
  switch (e->kind) {
  case CAG_EXPR_GROUP: fields_of(f, unit, e->as.unary.operand, depth + 1); break;
  case CAG_EXPR_NAME:
    entity = cag_entity_of_callee(f->vm, unit, e);
    fields_of_entity(f, &entity, depth, false);
    break;
  case CAG_EXPR_MEMBER: fields_of_member(f, unit, e, depth); break;
  case CAG_EXPR_CALL:
    entity = cag_entity_of_callee(f->vm, unit, e->as.call.callee);
    fields_of_entity(f, &entity, depth, true);
    break;
  case CAG_EXPR_BLOCK: fields_of(f, unit, e->as.block.value, depth + 1); break;
  case CAG_EXPR_IF: fields_of(f, unit, e->as.branch.then, depth + 1); break;
  case CAG_EXPR_RECORD:
    for (size_t i = 0; i < e->as.record.count; i++) {
      const CagField *field = &e->as.record.fields[i];
      if (field->name) f->give(f->context, field->name, field->value, unit);
      else fields_of(f, unit, field->value, depth + 1);
    }
    break;
  default: break;
  }
}

void cag_fields_of(const CagVm *vm, const CagModuleUnit *unit, const CagExpr *value,
                   GiveField *give, void *context) {
  const Fields f = {vm, give, context};
  fields_of(&f, unit, value, 0);
}
