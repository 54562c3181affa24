// From names to their definitions and uses, and renaming.

#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "interp/document/document.h"
#include "lang/lexer.h"

typedef struct Navigation {
  CagWorkspace *w;
  Document *d;
  size_t offset;
  bool definition; // of references: include it
  CagGivePlace *give;
  void *context;
  Entity entity;
} Navigation;

static void give_span(const Navigation *n, const Document *d, const CagModuleUnit *unit,
                      CagSpan span) {
  const CagPlace place = cag_document_place(n->w, d, unit, span);
  n->give(n->context, &place);
}

// --- Definitions ---

// Gives the field of a record, if the value whose member is at the offset is known.
typedef struct FieldSearch {
  const char *name;
  const CagModuleUnit *unit;
  CagSpan span;
} FieldSearch;

typedef struct MemberSearch {
  size_t offset;
  const CagExpr *member;
} MemberSearch;

static void find_member(void *context, const CagExpr *e) {
  MemberSearch *m = context;
  if (e->span.start > m->offset || m->offset > e->span.end) return;
  if (e->kind == CAG_EXPR_MEMBER && e->as.member.name_span.start <= m->offset &&
      m->offset <= e->as.member.name_span.end)
    m->member = e;
  else cag_tree_below(e, find_member, m);
}

static void take_field(void *context, const char *name, const CagExpr *value,
                       const CagModuleUnit *unit) {
  FieldSearch *s = context;
  if (strcmp(name, s->name) != 0) return;
  s->unit = unit;
  s->span = value->span;
}

static void define_field(const Navigation *n) {
  const CagStatement *s = cag_tree_statement(n->d->unit->ast, n->offset);
  MemberSearch m = {n->offset, NULL};
  if (s) cag_tree_of_statement(s, find_member, &m);
  if (!m.member) return;
  FieldSearch f = {.name = m.member->as.member.name};
  cag_fields_of(n->d->session->vm, n->d->unit, m.member->as.member.object, take_field, &f);
  if (f.unit) give_span(n, n->d, f.unit, f.span);
}

static void define(void *context) {
  const Navigation *n = context;
  const Occurrence *o = cag_document_occurrence(n->d, n->offset);
  const CagVm *vm = n->d->session->vm;
  if (!o) return;
  const Entity *e = &o->entity;
  if (e->kind == ENTITY_FIELD) define_field(n);
  if (e->kind == ENTITY_MODULE) give_span(n, n->d, e->unit, (CagSpan){0, 0});
  if (e->kind != ENTITY_DECL) return;
  if (e->decl->kind == CAG_DECL_IMPORT && o->role == ROLE_USE) {
    const size_t k = e->decl->statement->as.import.module;
    if (k < vm->module_count) give_span(n, n->d, vm->modules[k], (CagSpan){0, 0});
    return;
  }
  give_span(n, n->d, e->unit, e->decl->span);
}

void cag_document_definition(CagWorkspace *w, const char *file, size_t offset, CagGivePlace *give,
                             void *context) {
  Navigation n = {w, cag_document_get(w, file), offset, false, give, context, {0}};
  if (n.d) cag_document_guard(define, &n);
}

// --- References ---

// An import without an alias names the module by the last word of its path.
static bool names_import(const Occurrence *o, const Entity *e) {
  return e->kind == ENTITY_DECL && e->decl->kind == CAG_DECL_IMPORT && o->decl == e->decl &&
         o->entity.kind == ENTITY_MODULE && !e->decl->statement->as.import.alias;
}

static bool refers(const Occurrence *o, const Entity *e) {
  return cag_entity_equal(&o->entity, e) || names_import(o, e);
}

static bool give_references(void *context, Document *d) {
  const Navigation *n = context;
  for (size_t i = 0; i < d->occurrence_count; i++) {
    const Occurrence *o = &d->occurrences[i];
    if (!refers(o, &n->entity)) continue;
    if ((o->role == ROLE_DEFINITION || o->role == ROLE_SHORTHAND) && !n->definition) continue;
    give_span(n, d, d->unit, o->span);
  }
  return true;
}

// The text that a document with a reference contains.
static const char *word_of(const Entity *e) {
  switch (e->kind) {
  case ENTITY_DECL: return e->decl->name;
  case ENTITY_BUILTIN:
  case ENTITY_ARGUMENT:
  case ENTITY_FIELD: return e->name ? e->name : "";
  default: return "";
  }
}

// Tests whether other documents cannot refer to it. Fields of the same name in other documents are
// usually others.
static bool is_local(const Entity *e) {
  if (e->kind == ENTITY_FIELD) return true;
  return e->kind == ENTITY_DECL &&
         (e->decl->kind == CAG_DECL_IMPORT || e->decl->kind == CAG_DECL_IMPORTED ||
          e->decl->kind == CAG_DECL_BLOCK || e->decl->kind == CAG_DECL_CLAUSE ||
          e->decl->name[0] == '_');
}

// Sets the entity at the offset. Its document keeps its tree while others are read.
static bool find_entity(Navigation *n) {
  const Occurrence *o = cag_document_occurrence(n->d, n->offset);
  if (o) n->entity = o->entity;
  return o && n->entity.kind != ENTITY_NONE;
}

static bool give_in(void *context, Document *d) {
  const Navigation *n = context;
  return d == n->d || give_references(context, d);
}

// The definition may be in a document that is neither open nor listed, such as one of the library.
static void give_definition(const Navigation *n) {
  const Entity *e = &n->entity;
  if (!n->definition || e->kind != ENTITY_DECL || e->unit == n->d->unit) return;
  const char *file = cag_document_file_of(n->w, n->d, e->unit);
  for (size_t i = 0; i < n->w->count; i++) {
    const Document *d = n->w->documents[i];
    if (strcmp(d->file, file) == 0 && (d->open || d->listed)) return;
  }
  give_span(n, n->d, e->unit, e->decl->span);
}

static void find_references(void *context) {
  Navigation *n = context;
  if (!find_entity(n)) return;
  give_references(n, n->d);
  give_definition(n);
  if (!is_local(&n->entity)) cag_workspace_each(n->w, word_of(&n->entity), give_in, n);
}

void cag_document_references(CagWorkspace *w, const char *file, size_t offset, bool definition,
                             CagGivePlace *give, void *context) {
  Navigation n = {w, cag_document_get(w, file), offset, definition, give, context, {0}};
  if (n.d) cag_document_guard(find_references, &n);
}

static void highlight(void *context) {
  Navigation *n = context;
  n->definition = true;
  if (find_entity(n)) give_references(n, n->d);
}

void cag_document_highlights(CagWorkspace *w, const char *file, size_t offset, CagGivePlace *give,
                             void *context) {
  Navigation n = {w, cag_document_get(w, file), offset, true, give, context, {0}};
  if (n.d) cag_document_guard(highlight, &n);
}

// --- Renaming ---

static bool is_library(const CagModuleUnit *unit) {
  return !unit->path && strncmp(unit->name, "std.", 4) == 0;
}

// The name of a module is changed by an alias, so it is not the last word of its path.
static bool can_rename(Navigation *n, const Occurrence *o) {
  if (!o || !find_entity(n)) return false;
  if (o->entity.kind == ENTITY_MODULE && o->decl)
    n->entity = (Entity){.kind = ENTITY_DECL, .unit = n->d->unit, .decl = o->decl};
  return n->entity.kind == ENTITY_DECL && !is_library(n->entity.unit);
}

static void test_rename(void *context) {
  Navigation *n = context;
  const Occurrence *o = cag_document_occurrence(n->d, n->offset);
  if (can_rename(n, o) && o->entity.kind != ENTITY_MODULE) give_span(n, n->d, n->d->unit, o->span);
  else if (can_rename(n, o) && o->span.end - o->span.start == strlen(n->entity.decl->name))
    give_span(n, n->d, n->d->unit, o->span);
  else n->d = NULL;
}

bool cag_document_can_rename(CagWorkspace *w, const char *file, size_t offset, CagGivePlace *give,
                             void *context) {
  Navigation n = {w, cag_document_get(w, file), offset, true, give, context, {0}};
  return n.d && cag_document_guard(test_rename, &n) && n.d;
}

typedef struct FileEdit {
  char *file;
  size_t start, end;
  const char *text;
} FileEdit;

typedef struct Rename {
  Navigation n;
  const char *name;
  char *alias;     // " as NAME"
  char *shorthand; // "FIELD: NAME"
  FileEdit *edits;
  size_t count, capacity;
  char *why;
  size_t size;
  bool ok;
} Rename;

static void add_edit(Rename *r, const Document *d, CagSpan span, const char *text) {
  if (!CAG_RESERVE(r->edits, r->capacity, r->count + 1)) cag_memory_leave();
  char *file = cag_checked(cag_strdup(cag_document_file_of(r->n.w, d, d->unit)));
  r->edits[r->count++] = (FileEdit){file, span.start, span.end, text};
}

static bool rename_in(void *context, Document *d) {
  Rename *r = context;
  const Entity *e = &r->n.entity;
  for (size_t i = 0; i < d->occurrence_count; i++) {
    const Occurrence *o = &d->occurrences[i];
    if (d == r->n.d && names_import(o, e))
      add_edit(r, d, (CagSpan){o->span.end, o->span.end}, r->alias);
    else if (cag_entity_equal(&o->entity, e))
      add_edit(r, d, o->span, o->role == ROLE_SHORTHAND ? r->shorthand : r->name);
  }
  return true;
}

static bool rename_elsewhere(void *context, Document *d) {
  const Rename *r = context;
  return d == r->n.d || rename_in(context, d);
}

static bool is_name(const char *name) {
  CagArena memory = {0};
  CagNames names;
  CagLexer lexer;
  CagToken t, end;
  CagSource *source = cag_source_new("", name, strlen(name));
  if (!source || cag_source_bad_utf8(source) < source->length) {
    cag_source_free(source);
    return false;
  }
  cag_names_init(&names, &memory);
  cag_lexer_init(&lexer, source, &memory, &names, NULL);
  cag_lexer_next(&lexer, &t);
  cag_lexer_next(&lexer, &end);
  const bool good = t.kind == CAG_TOKEN_NAME && t.span.start == 0 && t.span.end == strlen(name) &&
                    end.kind == CAG_TOKEN_END && strcmp(name, "_");
  cag_lexer_release(&lexer);
  cag_names_release(&names);
  cag_arena_free(&memory);
  cag_source_free(source);
  return good;
}

// --- Checking a change of a name ---
//
// The edits are made in a workspace of copies. The change is allowed if no document gets errors
// that it did not have, and the changed places, and no others, mean the same name.

static size_t count_errors(CagWorkspace *w, Document *d, const char **first) {
  size_t count = 0;
  if (!cag_document_make_checked(w, d)) return 0;
  const CagDiagnostics *list = &d->session->diagnostics;
  for (size_t i = list->count; i-- > 0;) {
    const CagDiagnostic *e = cag_diagnostics_at(list, i);
    if (e->severity != CAG_SEVERITY_ERROR) continue;
    count++;
    *first = e->message;
  }
  return count;
}

static bool copy_documents(const CagWorkspace *from, CagWorkspace *to) {
  for (size_t i = 0; i < from->count; i++) {
    const Document *d = from->documents[i];
    if (d->open && !cag_workspace_open(to, d->file, d->text, d->length)) return false;
    if (d->listed) cag_workspace_add_file(to, d->file);
  }
  return true;
}

// Makes the edits, the last one of a file first. Edits of a file are in order.
static bool apply(const Rename *r, CagWorkspace *copy) {
  for (size_t i = r->count; i-- > 0;) {
    const FileEdit *e = &r->edits[i];
    size_t length;
    const char *text = cag_document_text(copy, e->file, &length);
    const Document *d = cag_workspace_document(copy, e->file);
    if (!text || !d) return false;
    if (!d->open && !cag_workspace_open(copy, e->file, text, length)) return false;
    if (!cag_workspace_change(copy, e->file, e->start, e->end, e->text, strlen(e->text)))
      return false;
  }
  return true;
}

typedef struct Recount {
  const Entity *entity;
  size_t count;
} Recount;

static bool recount(void *context, Document *d) {
  Recount *c = context;
  for (size_t i = 0; i < d->occurrence_count; i++) {
    c->count += refers(&d->occurrences[i], c->entity);
  }
  return true;
}

// Returns the offset in the changed text of what was at `offset`.
static size_t moved(const Rename *r, const char *file, size_t offset) {
  size_t out = offset;
  for (size_t i = 0; i < r->count; i++) {
    const FileEdit *e = &r->edits[i];
    if (strcmp(e->file, file) == 0 && e->start < offset && e->end <= offset)
      out += strlen(e->text) - (e->end - e->start);
    else if (strcmp(e->file, file) == 0 && e->text == r->shorthand && e->start <= offset &&
             offset < e->end)
      out += strlen(e->text) - (offset - e->start); // to the name after the field
  }
  return out;
}

static bool check_documents(Rename *r, CagWorkspace *copy) {
  for (size_t i = 0; i < r->count; i++) {
    const char *file = r->edits[i].file, *before = "", *after = "";
    if (i > 0 && strcmp(file, r->edits[i - 1].file) == 0) continue;
    Document *old = cag_workspace_document(r->n.w, file), *new = cag_workspace_document(copy, file);
    const bool kept = old && (old->open || old->session);
    if (!old || !new) return false;
    const size_t errors = count_errors(r->n.w, old, &before);
    const bool worse = count_errors(copy, new, &after) > errors;
    if (worse) snprintf(r->why, r->size, "the change would make an error: %s", after);
    if (!kept) cag_document_rest(old);
    if (worse) return false;
  }
  return true;
}

static bool check_rename(Rename *r, CagWorkspace *copy) {
  if (!copy_documents(r->n.w, copy) || !apply(r, copy)) {
    snprintf(r->why, r->size, "not enough memory");
    return false;
  }
  if (!check_documents(r, copy)) return false;
  const size_t at = moved(r, r->n.d->file, r->n.offset);
  Document *d = cag_document_get(copy, r->n.d->file);
  const Occurrence *o = d ? cag_document_occurrence(d, at) : NULL;
  if (o) {
    Recount c = {&o->entity, 0};
    if (is_local(&o->entity) || o->entity.kind == ENTITY_MODULE) recount(&c, d);
    else cag_workspace_each(copy, "", recount, &c);
    if (c.count == r->count || o->entity.kind == ENTITY_MODULE) return true;
  }
  snprintf(r->why, r->size, "%s would then stand for something else in some places", r->name);
  return false;
}

static void free_copy(void *copy) { cag_workspace_free(copy); }

static void rename_all(void *context) {
  Rename *r = context;
  Navigation *n = &r->n;
  const Occurrence *o = cag_document_occurrence(n->d, n->offset);
  if (!can_rename(n, o)) {
    snprintf(r->why, r->size,
             n->entity.kind == ENTITY_BUILTIN || n->entity.kind == ENTITY_ARGUMENT
                 ? "%s is built in"
             : n->entity.kind == ENTITY_DECL  ? "%s belongs to the library"
             : n->entity.kind == ENTITY_FIELD ? "the field %s cannot be renamed"
                                              : "no name at this position%s",
             word_of(&n->entity));
    return;
  }
  if (cag_asprintf(&r->alias, " as %s", r->name) < 0 ||
      cag_asprintf(&r->shorthand, "%s: %s", n->entity.decl->name, r->name) < 0)
    cag_memory_leave();
  rename_in(r, n->d);
  if (!is_local(&n->entity)) cag_workspace_each(n->w, n->entity.decl->name, rename_elsewhere, r);
  CagSessionOptions options = n->w->options;
  CagWorkspace *copy = cag_checked(cag_workspace_new(&options));
  CagCleanup cleanup;
  cag_cleanup_push(&cleanup, free_copy, copy);
  r->ok = check_rename(r, copy);
  cag_cleanup_run(&cleanup);
}

bool cag_document_rename(CagWorkspace *w, const char *file, size_t offset, const char *name,
                         CagGiveEdit *give, void *context, char *why, size_t size) {
  Rename r = {.n = {.w = w, .d = cag_document_get(w, file), .offset = offset},
              .name = name,
              .why = why,
              .size = size};
  snprintf(why, size, "the document cannot be read");
  if (r.n.d && !is_name(name)) snprintf(why, size, "`%s` is not a name", name);
  else if (r.n.d && !cag_document_guard(rename_all, &r)) snprintf(why, size, "not enough memory");
  for (size_t i = 0; i < r.count; i++) {
    const FileEdit *e = &r.edits[i];
    if (r.ok) give(context, &(CagEdit){{e->file, e->start, e->end}, e->text});
  }
  for (size_t i = 0; i < r.count; i++) cag_free(r.edits[i].file);
  cag_free(r.edits);
  cag_free(r.alias);
  cag_free(r.shorthand);
  return r.ok;
}
