// Names in a document and what they stand for.

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "interp/document/document.h"
#include "interp/vm/builtin.h"

// --- Entities ---

static const CagModuleUnit *imported_unit(const CagVm *vm, const CagDecl *decl) {
  const CagStatement *s = decl->statement;
  if (!s || s->kind != CAG_STATEMENT_IMPORT || s->as.import.module >= vm->module_count) return NULL;
  return vm->modules[s->as.import.module];
}

// Finds a public definition of a module.
static Entity public_entity(const CagModuleUnit *m, const char *name) {
  for (size_t i = 0; m && i < m->public_count; i++) {
    if (strcmp(m->publics[i].name, name) != 0) continue;
    return (Entity){.kind = ENTITY_DECL, .unit = m, .decl = m->publics[i].decl};
  }
  return (Entity){.kind = ENTITY_NONE};
}

Entity cag_entity_of_decl(const CagVm *vm, const CagModuleUnit *unit, const CagDecl *decl) {
  if (decl->kind == CAG_DECL_IMPORTED) {
    const CagModuleUnit *m = imported_unit(vm, decl);
    for (size_t i = 0; m && i < decl->statement->as.import.name_count; i++)
      if (decl->statement->as.import.names[i].decl == decl) {
        const Entity e = public_entity(m, decl->statement->as.import.names[i].name);
        if (e.kind) return e;
      }
  }
  return (Entity){.kind = ENTITY_DECL, .unit = unit, .decl = decl};
}

Entity cag_entity_of_member(const CagVm *vm, const CagModuleUnit *unit, const CagExpr *member) {
  const CagExpr *object = member->as.member.object;
  (void)unit;
  if (object->kind == CAG_EXPR_NAME && object->as.name.binding == CAG_BIND_DECL &&
      object->as.name.decl->kind == CAG_DECL_IMPORT)
    return public_entity(imported_unit(vm, object->as.name.decl), member->as.member.name);
  return (Entity){.kind = ENTITY_FIELD, .name = member->as.member.name};
}

static Entity entity_of_name(const CagVm *vm, const CagModuleUnit *unit, const CagExpr *e) {
  if (e->as.name.binding == CAG_BIND_DECL && e->as.name.decl)
    return cag_entity_of_decl(vm, unit, e->as.name.decl);
  if (e->as.name.binding == CAG_BIND_BUILTIN)
    return (Entity){.kind = ENTITY_BUILTIN, .index = e->as.name.index, .name = e->as.name.id};
  return (Entity){.kind = ENTITY_NONE};
}

Entity cag_entity_of_callee(const CagVm *vm, const CagModuleUnit *unit, const CagExpr *callee) {
  while (callee->kind == CAG_EXPR_GROUP) callee = callee->as.unary.operand;
  if (callee->kind == CAG_EXPR_NAME) return entity_of_name(vm, unit, callee);
  if (callee->kind == CAG_EXPR_MEMBER) return cag_entity_of_member(vm, unit, callee);
  return (Entity){.kind = ENTITY_NONE};
}

// Units of different machines are the same module if their paths, or else their names, are equal.
static bool same_unit(const CagModuleUnit *a, const CagModuleUnit *b) {
  if (a == b) return true;
  if (!a || !b || !a->path != !b->path) return false;
  return a->path ? strcmp(a->path, b->path) == 0 : strcmp(a->name, b->name) == 0;
}

bool cag_entity_equal(const Entity *a, const Entity *b) {
  if (a->kind != b->kind) return false;
  switch (a->kind) {
  case ENTITY_NONE: return false;
  case ENTITY_DECL:
    return same_unit(a->unit, b->unit) && a->decl->span.start == b->decl->span.start &&
           strcmp(a->decl->name, b->decl->name) == 0;
  case ENTITY_BUILTIN: return a->index == b->index;
  case ENTITY_MODULE: return same_unit(a->unit, b->unit);
  case ENTITY_FIELD: return strcmp(a->name, b->name) == 0;
  case ENTITY_ARGUMENT: return a->index == b->index && strcmp(a->name, b->name) == 0;
  }
  return false;
}

const CagExpr *cag_entity_value(const Entity *e) {
  return e->kind == ENTITY_DECL ? cag_tree_value(e->decl) : NULL;
}

const CagFunctionAst *cag_entity_function(const Entity *e) {
  const CagExpr *value = cag_entity_value(e);
  return value && value->kind == CAG_EXPR_LAMBDA ? value->as.function : NULL;
}

CagNameKind cag_entity_kind(const Entity *e) {
  size_t rows;
  switch (e->kind) {
  case ENTITY_NONE: break;
  case ENTITY_BUILTIN:
    if (e->index >= cag_builtin_count()) return CAG_NAME_PARAM; // time, frame, frames
    return cag_builtin_rows(e->index, &rows)->function ? CAG_NAME_BUILTIN : CAG_NAME_CONSTANT;
  case ENTITY_MODULE: return CAG_NAME_MODULE;
  case ENTITY_FIELD: return CAG_NAME_FIELD;
  case ENTITY_ARGUMENT: return CAG_NAME_PARAMETER;
  case ENTITY_DECL:
    switch (e->decl->kind) {
    case CAG_DECL_TOP:
      if (e->decl->statement->kind == CAG_STATEMENT_PARAM) return CAG_NAME_PARAM;
      return cag_entity_function(e) ? CAG_NAME_FUNCTION : CAG_NAME_VALUE;
    case CAG_DECL_IMPORT: return CAG_NAME_MODULE;
    case CAG_DECL_IMPORTED: return CAG_NAME_VALUE;
    case CAG_DECL_PARAMETER: return CAG_NAME_PARAMETER;
    case CAG_DECL_BLOCK: return cag_entity_function(e) ? CAG_NAME_FUNCTION : CAG_NAME_LOCAL;
    case CAG_DECL_CLAUSE: return CAG_NAME_LOCAL;
    }
  }
  return CAG_NAME_UNKNOWN;
}

// --- The list ---

typedef struct Listing {
  Document *d;
  const CagVm *vm;
  size_t capacity;
} Listing;

static void add(Listing *l, CagSpan span, Entity entity, const CagDecl *decl,
                enum OccurrenceRole role) {
  Document *d = l->d;
  if (span.end <= span.start) return;
  if (!CAG_RESERVE(d->occurrences, l->capacity, d->occurrence_count + 1)) cag_memory_leave();
  d->occurrences[d->occurrence_count++] = (Occurrence){span, entity, decl, role};
}

static void add_definition(Listing *l, const CagDecl *decl) {
  const Entity e = {.kind = ENTITY_DECL, .unit = l->d->unit, .decl = decl};
  if (decl && strcmp(decl->name, "_") != 0) add(l, decl->span, e, decl, ROLE_DEFINITION);
}

static void add_pattern(Listing *l, const CagPattern *pattern) {
  if (pattern->decl) add_definition(l, pattern->decl);
  if (pattern->rest) add_definition(l, pattern->rest);
  for (size_t i = 0; i < pattern->count; i++) {
    const CagPatternPart *part = &pattern->parts[i];
    const Entity field = {.kind = ENTITY_FIELD, .name = part->field};
    if (cag_pattern_is_shorthand(part)) {
      const Entity e = {.kind = ENTITY_DECL, .unit = l->d->unit, .decl = part->pattern->decl};
      add(l, part->field_span, e, e.decl, ROLE_SHORTHAND);
      continue;
    }
    if (part->field) add(l, part->field_span, field, NULL, ROLE_USE);
    add_pattern(l, part->pattern);
  }
}

// Adds the names of a pattern, or else (NULL) the name of `whole`.
static void add_names(Listing *l, const CagDecl *whole, const CagPattern *pattern) {
  if (pattern) add_pattern(l, pattern);
  else add_definition(l, whole);
}

// The name of an argument is that of a parameter.
static void add_label(Listing *l, const Entity *callee, const CagArgument *a) {
  const CagFunctionAst *f = cag_entity_function(callee);
  Entity e = {.kind = ENTITY_NONE};
  if (callee->kind == ENTITY_BUILTIN)
    e = (Entity){.kind = ENTITY_ARGUMENT, .index = callee->index, .name = a->name};
  for (size_t i = 0; f && i < f->parameter_count; i++)
    if (strcmp(f->parameters[i].decl->name, a->name) == 0)
      e = (Entity){.kind = ENTITY_DECL, .unit = callee->unit, .decl = f->parameters[i].decl};
  add(l, a->name_span, e, NULL, ROLE_LABEL);
}

static void list_expression(void *context, const CagExpr *e);

static void list_statement(Listing *l, const CagStatement *s) {
  if (s->kind == CAG_STATEMENT_DEFINITION)
    add_names(l, s->as.definition.decl, s->as.definition.pattern);
  if (s->kind == CAG_STATEMENT_PARAM) add_definition(l, s->as.param.decl);
  cag_tree_of_statement(s, list_expression, l);
}

static void list_expression(void *context, const CagExpr *e) {
  Listing *l = context;
  switch (e->kind) {
  case CAG_EXPR_NAME:
    add(l, e->span, entity_of_name(l->vm, l->d->unit, e),
        e->as.name.binding == CAG_BIND_DECL ? e->as.name.decl : NULL, ROLE_USE);
    return;
  case CAG_EXPR_MEMBER:
    add(l, e->as.member.name_span, cag_entity_of_member(l->vm, l->d->unit, e), NULL, ROLE_USE);
    break;
  case CAG_EXPR_CALL: {
    const Entity callee = cag_entity_of_callee(l->vm, l->d->unit, e->as.call.callee);
    for (size_t i = 0; i < e->as.call.count; i++)
      if (e->as.call.arguments[i].name) add_label(l, &callee, &e->as.call.arguments[i]);
    break;
  }
  case CAG_EXPR_RECORD:
    for (size_t i = 0; i < e->as.record.count; i++) {
      const CagField *f = &e->as.record.fields[i];
      const Entity field = {.kind = ENTITY_FIELD, .name = f->name};
      if (f->name) add(l, f->name_span, field, NULL, ROLE_DEFINITION);
    }
    break;
  case CAG_EXPR_LAMBDA:
    for (size_t i = 0; i < e->as.function->parameter_count; i++)
      add_names(l, e->as.function->parameters[i].decl, e->as.function->parameters[i].pattern);
    break;
  case CAG_EXPR_COMPREHENSION:
    for (size_t i = 0; i < e->as.comprehension.count; i++)
      add_pattern(l, e->as.comprehension.clauses[i].pattern);
    break;
  case CAG_EXPR_BLOCK:
    for (size_t i = 0; i < e->as.block.count; i++) list_statement(l, e->as.block.statements[i]);
    list_expression(l, e->as.block.value);
    return;
  default: break;
  }
  cag_tree_below(e, list_expression, l);
}

static void list_import(Listing *l, const CagStatement *s) {
  const CagModuleUnit *m =
      s->as.import.module < l->vm->module_count ? l->vm->modules[s->as.import.module] : NULL;
  const CagDecl *own = s->as.import.decl;
  add(l, s->as.import.path_span,
      (Entity){.kind = m ? ENTITY_MODULE : ENTITY_NONE, .unit = m, .name = s->as.import.path}, own,
      ROLE_USE);
  if (own && s->as.import.alias) add_definition(l, own);
  for (size_t i = 0; i < s->as.import.name_count; i++) {
    const CagDecl *decl = s->as.import.names[i].decl;
    add(l, decl->span, cag_entity_of_decl(l->vm, l->d->unit, decl), decl, ROLE_IMPORTED);
  }
}

static int by_start(const void *a, const void *b) {
  const Occurrence *x = a, *y = b;
  if (x->span.start != y->span.start) return x->span.start < y->span.start ? -1 : 1;
  return (x->span.end > y->span.end) - (x->span.end < y->span.end);
}

static void list_all(void *context) {
  Listing *l = context;
  const CagModuleAst *ast = l->d->unit->ast;
  for (size_t i = 0; i < ast->count; i++)
    if (ast->statements[i]->kind == CAG_STATEMENT_IMPORT) list_import(l, ast->statements[i]);
    else list_statement(l, ast->statements[i]);
}

void cag_document_list(Document *d) {
  Listing l = {.d = d, .vm = d->session->vm};
  if (!d->unit->ast || !d->unit->resolved) return;
  if (!cag_document_guard(list_all, &l)) d->occurrence_count = 0;
  if (d->occurrence_count)
    qsort(d->occurrences, d->occurrence_count, sizeof *d->occurrences, by_start);
}

const Occurrence *cag_document_occurrence(const Document *d, size_t offset) {
  size_t low = 0, high = d->occurrence_count; // those before `low` start at or before the offset
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (d->occurrences[middle].span.start <= offset) low = middle + 1;
    else high = middle;
  }
  while (low-- > 0) {
    const Occurrence *o = &d->occurrences[low];
    if (offset <= o->span.end) return o;
    if (o->span.start + 1024 < offset) break; // spans do not overlap
  }
  return NULL;
}
