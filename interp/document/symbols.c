// The definitions of documents, the parts that fold, the expressions around a place, and links.

#include <ctype.h>
#include <string.h>

#include "base/memory.h"
#include "interp/document/document.h"

// --- Symbols ---

typedef struct Symbols {
  CagWorkspace *w;
  Document *d;
  CagGiveSymbol *give;
  void *context;
  const char *query; // of the workspace; NULL: all, with those below
  size_t depth;
} Symbols;

static void give_symbol(Symbols *s, const CagDecl *decl, CagSpan whole, const char *detail) {
  const Entity e = {.kind = ENTITY_DECL, .unit = s->d->unit, .decl = decl};
  const CagSymbolView view = {.name = decl->name,
                              .detail = detail,
                              .kind = cag_entity_kind(&e),
                              .whole = cag_document_place(s->w, s->d, s->d->unit, whole),
                              .place = cag_document_place(s->w, s->d, s->d->unit, decl->span),
                              .depth = s->depth};
  s->give(s->context, &view);
}

static void symbols_below(void *context, const CagExpr *e);

static bool matches(const char *name, const char *query);

static void give_name(Symbols *s, const CagStatement *st, const CagDecl *decl) {
  const Entity e = {.kind = ENTITY_DECL, .unit = s->d->unit, .decl = decl};
  CagString head = {0};
  cag_describe_head(&e, &head);
  const size_t name = strlen(decl->name);
  const char *detail = head.bytes && head.length > name ? head.bytes + name : "";
  if (st->kind == CAG_STATEMENT_PARAM && st->as.param.label) detail = st->as.param.label;
  const bool wanted = !s->query || s->depth > 0 || matches(decl->name, s->query);
  if (wanted && strcmp(decl->name, "_") != 0) give_symbol(s, decl, st->span, detail);
  cag_string_free(&head);
}

static void give_definition(Symbols *s, const CagStatement *st) {
  const CagPattern *pattern =
      st->kind == CAG_STATEMENT_DEFINITION ? st->as.definition.pattern : NULL;
  if (!pattern)
    give_name(s, st, st->kind == CAG_STATEMENT_PARAM ? st->as.param.decl : st->as.definition.decl);
  for (size_t i = 0; pattern && i < pattern->name_count; i++) give_name(s, st, pattern->names[i]);
  if (s->query) return;
  s->depth++;
  cag_tree_of_statement(st, symbols_below, s);
  s->depth--;
}

static void symbols_below(void *context, const CagExpr *e) {
  Symbols *s = context;
  if (e->kind == CAG_EXPR_BLOCK)
    for (size_t i = 0; i < e->as.block.count; i++)
      if (e->as.block.statements[i]->kind == CAG_STATEMENT_DEFINITION)
        give_definition(s, e->as.block.statements[i]);
  if (e->kind == CAG_EXPR_LAMBDA && e->as.function->body) symbols_below(s, e->as.function->body);
  if (e->kind != CAG_EXPR_RECORD || s->depth != 1) return; // fields of a definition
  for (size_t i = 0; i < e->as.record.count; i++) {
    const CagField *f = &e->as.record.fields[i];
    if (!f->name) continue;
    const CagSpan whole = {f->name_span.start, f->value->span.end > f->name_span.end
                                                   ? f->value->span.end
                                                   : f->name_span.end};
    const CagSymbolView view = {.name = f->name,
                                .detail = "",
                                .kind = CAG_NAME_FIELD,
                                .whole = cag_document_place(s->w, s->d, s->d->unit, whole),
                                .place = cag_document_place(s->w, s->d, s->d->unit, f->name_span),
                                .depth = s->depth};
    s->give(s->context, &view);
  }
}

// Tests whether the name has the letters of the query in order.
static bool matches(const char *name, const char *query) {
  for (; *query; name++) {
    if (!*name) return false;
    if (tolower((unsigned char)*name) == tolower((unsigned char)*query)) query++;
  }
  return true;
}

static void give_symbols(void *context) {
  Symbols *s = context;
  const CagModuleAst *ast = s->d->unit->ast;
  for (size_t i = 0; ast && i < ast->count; i++) {
    const CagStatement *st = ast->statements[i];
    if (st->kind == CAG_STATEMENT_DEFINITION || st->kind == CAG_STATEMENT_PARAM)
      give_definition(s, st);
  }
}

void cag_document_symbols(CagWorkspace *w, const char *file, CagGiveSymbol *give, void *context) {
  Symbols s = {.w = w, .d = cag_document_get(w, file), .give = give, .context = context};
  if (s.d) cag_document_guard(give_symbols, &s);
}

static bool symbols_of(void *context, Document *d) {
  Symbols *s = context;
  s->d = d;
  return cag_document_guard(give_symbols, s);
}

void cag_workspace_symbols(CagWorkspace *w, const char *query, CagGiveSymbol *give, void *context) {
  Symbols s = {.w = w, .give = give, .context = context, .query = query};
  cag_workspace_each(w, "", symbols_of, &s);
}

// --- Folding ---

typedef struct Folds {
  CagWorkspace *w;
  Document *d;
  void (*give)(void *context, const CagPlace *place, CagFoldKind kind);
  void *context;
} Folds;

static bool has_lines(const Document *d, CagSpan span) {
  return span.end > span.start && memchr(d->text + span.start, '\n', span.end - span.start);
}

static void give_fold(const Folds *f, CagSpan span, CagFoldKind kind) {
  const CagPlace place = cag_document_place(f->w, f->d, f->d->unit, span);
  if (has_lines(f->d, span)) f->give(f->context, &place, kind);
}

static void fold_expression(void *context, const CagExpr *e) {
  const Folds *f = context;
  if (!has_lines(f->d, e->span)) return;
  if (e->kind == CAG_EXPR_LIST || e->kind == CAG_EXPR_RECORD || e->kind == CAG_EXPR_BLOCK ||
      e->kind == CAG_EXPR_COMPREHENSION || e->kind == CAG_EXPR_CALL || e->kind == CAG_EXPR_TEXT)
    give_fold(f, e->span, CAG_FOLD_CODE);
  cag_tree_below(e, fold_expression, context);
}

// Comments on neighboring lines fold together, and so do imports.
static void fold_comments(const Folds *f) {
  const CagModuleAst *ast = f->d->unit->ast;
  for (size_t i = 0; i < ast->comment_count; i++) {
    CagSpan span = ast->comments[i].span;
    while (!ast->comments[i].block && i + 1 < ast->comment_count && !ast->comments[i + 1].block) {
      const uint32_t next = ast->comments[i + 1].span.start;
      const char *between = f->d->text + span.end;
      const size_t blank = strspn(between, " \t\r\n");
      if (blank != next - span.end || memchr(between, '\n', blank) != memrchr(between, '\n', blank))
        break;
      span.end = ast->comments[++i].span.end;
    }
    give_fold(f, span, CAG_FOLD_COMMENT);
  }
}

static void fold_imports(const Folds *f) {
  const CagModuleAst *ast = f->d->unit->ast;
  for (size_t i = 0; i < ast->count; i++) {
    if (ast->statements[i]->kind != CAG_STATEMENT_IMPORT) continue;
    CagSpan span = ast->statements[i]->span;
    while (i + 1 < ast->count && ast->statements[i + 1]->kind == CAG_STATEMENT_IMPORT)
      span.end = ast->statements[++i]->span.end;
    give_fold(f, span, CAG_FOLD_IMPORTS);
  }
}

static void give_folds(void *context) {
  Folds *f = context;
  const CagModuleAst *ast = f->d->unit->ast;
  if (!ast) return;
  fold_comments(f);
  fold_imports(f);
  for (size_t i = 0; i < ast->count; i++) {
    const CagStatement *s = ast->statements[i];
    if (s->kind == CAG_STATEMENT_DEFINITION) give_fold(f, s->span, CAG_FOLD_CODE);
    cag_tree_of_statement(s, fold_expression, f);
  }
}

void cag_document_folds(CagWorkspace *w, const char *file,
                        void (*give)(void *context, const CagPlace *place, CagFoldKind kind),
                        void *context) {
  Folds f = {w, cag_document_get(w, file), give, context};
  if (f.d) cag_document_guard(give_folds, &f);
}

// --- Selection ---

typedef struct Selection {
  CagWorkspace *w;
  Document *d;
  CagGivePlace *give;
  void *context;
  size_t offset;
  CagSpan last; // the one given last
} Selection;

static void give_part(Selection *s, CagSpan span) {
  if (span.start > s->offset || s->offset > span.end) return;
  if (span.start == s->last.start && span.end == s->last.end) return;
  if (span.start > s->last.start || span.end < s->last.end) return; // parts must contain each other
  const CagPlace place = cag_document_place(s->w, s->d, s->d->unit, span);
  s->last = span;
  s->give(s->context, &place);
}

static void select_below(void *context, const CagExpr *e) {
  Selection *s = context;
  if (e->span.start > s->offset || s->offset > e->span.end) return;
  cag_tree_below(e, select_below, s);
  give_part(s, e->span);
}

static void give_selection(void *context) {
  Selection *s = context;
  const CagModuleAst *ast = s->d->unit->ast;
  const Occurrence *o = cag_document_occurrence(s->d, s->offset);
  const CagStatement *st = ast ? cag_tree_statement(ast, s->offset) : NULL;
  s->last = (CagSpan){(uint32_t)s->offset, (uint32_t)s->offset};
  if (o) give_part(s, o->span);
  if (st) {
    cag_tree_of_statement(st, select_below, s);
    give_part(s, st->span);
  }
  give_part(s, (CagSpan){0, (uint32_t)s->d->length});
}

void cag_document_selection(CagWorkspace *w, const char *file, size_t offset, CagGivePlace *give,
                            void *context) {
  Selection s = {w, cag_document_get(w, file), give, context, offset, {0, 0}};
  if (s.d) cag_document_guard(give_selection, &s);
}

// --- Links ---

typedef struct Links {
  CagWorkspace *w;
  Document *d;
  void (*give)(void *context, const CagPlace *place, const char *target);
  void *context;
} Links;

static bool reads_files(const CagExpr *callee) {
  return callee->kind == CAG_EXPR_NAME && callee->as.name.binding == CAG_BIND_BUILTIN &&
         strncmp(callee->as.name.id, "read_", 5) == 0;
}

// Gives the file that a text names, if it exists.
static void link_text(const Links *l, const CagExpr *e) {
  char *joined = NULL;
  const char *path = l->d->path, *slash = path ? strrchr(path, '/') : NULL;
  if (e->kind != CAG_EXPR_TEXT || !slash || strlen(e->as.text.bytes) != e->as.text.length) return;
  const bool absolute = e->as.text.bytes[0] == '/';
  if (cag_asprintf(&joined, "%.*s%s", absolute ? 0 : (int)(slash - path + 1), path,
                   e->as.text.bytes) < 0)
    return;
  char *real = cag_realpath(joined);
  const CagPlace place = cag_document_place(l->w, l->d, l->d->unit, e->span);
  if (real) l->give(l->context, &place, real);
  cag_free(real);
  cag_free(joined);
}

static void link_expression(void *context, const CagExpr *e) {
  const Links *l = context;
  if (e->kind == CAG_EXPR_CALL && reads_files(e->as.call.callee))
    for (size_t i = 0; i < e->as.call.count; i++) link_text(l, e->as.call.arguments[i].value);
  cag_tree_below(e, link_expression, context);
}

static void give_links(void *context) {
  Links *l = context;
  const CagModuleAst *ast = l->d->unit->ast;
  const CagVm *vm = l->d->session->vm;
  for (size_t i = 0; ast && i < ast->count; i++) {
    const CagStatement *s = ast->statements[i];
    cag_tree_of_statement(s, link_expression, l);
    if (s->kind != CAG_STATEMENT_IMPORT || s->as.import.module >= vm->module_count) continue;
    const CagPlace place = cag_document_place(l->w, l->d, l->d->unit, s->as.import.path_span);
    l->give(l->context, &place, cag_document_file_of(l->w, l->d, vm->modules[s->as.import.module]));
  }
}

void cag_document_links(CagWorkspace *w, const char *file,
                        void (*give)(void *context, const CagPlace *place, const char *target),
                        void *context) {
  Links l = {w, cag_document_get(w, file), give, context};
  if (l.d) cag_document_guard(give_links, &l);
}

// --- Use ---

typedef struct Use {
  CagWorkspace *w;
  Document *d;
  CagDocumentUse *out;
} Use;

// Finds the first expectation, or example of the documentation.
static void find_test(const Use *u) {
  const CagModuleAst *ast = u->d->unit->ast;
  for (size_t i = 0; i < ast->comment_count && !u->out->tests; i++) {
    const CagSpan span = ast->comments[i].span;
    const char *text = u->d->text + span.start;
    const size_t n = span.end - span.start;
    const bool example = ast->comments[i].doc && n > 7 && memcmp(text + 3, "     ", 5) == 0;
    if (!example && !memmem(text, n, "// expect:", 10) &&
        !memmem(text, n, "// expect error:", 16) && !memmem(text, n, "// expect image", 15))
      continue;
    u->out->tests = true;
    u->out->test = cag_document_place(u->w, u->d, u->d->unit, span);
  }
}

static void find_use(void *context) {
  Use *u = context;
  const CagModuleAst *ast = u->d->unit->ast;
  if (!ast) return;
  for (size_t i = 0; i < ast->count && !u->out->shows; i++) {
    if (ast->statements[i]->kind != CAG_STATEMENT_SHOW) continue;
    u->out->shows = true;
    u->out->show = cag_document_place(u->w, u->d, u->d->unit, ast->statements[i]->span);
  }
  find_test(u);
}

bool cag_document_use(CagWorkspace *w, const char *file, CagDocumentUse *out) {
  *out = (CagDocumentUse){0};
  Use u = {w, cag_document_get(w, file), out};
  return u.d && cag_document_guard(find_use, &u);
}
