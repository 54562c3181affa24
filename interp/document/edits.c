// Formatting, and changes that fix a problem or restructure a script.

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "interp/doc/doc.h"
#include "interp/document/document.h"
#include "interp/vm/stdlib.h"
#include "lang/format.h"

// --- Formatting ---

typedef struct Formatting {
  Document *d;
  size_t start, end;
  CagGiveEdit *give;
  void *context;
  bool ok;
} Formatting;

// Gives the edit from a part of the text to the formatted text, without the lines that both have at
// their start and end.
static void give_difference(const Formatting *f, CagSpan part, const char *text, size_t length) {
  const char *old = f->d->text + part.start;
  size_t n = part.end - part.start, head = 0, tail = 0;
  for (size_t i = 0; i < n && i < length && old[i] == text[i]; i++)
    if (old[i] == '\n') head = i + 1;
  if (n == length && memcmp(old, text, n) == 0) return;
  for (size_t i = 0; i < n - head && i < length - head && old[n - 1 - i] == text[length - 1 - i];
       i++)
    if (old[n - 1 - i] == '\n') tail = i;
  char *new = cag_checked(cag_strndup(text + head, length - head - tail));
  const CagEdit edit = {{f->d->file, part.start + head, part.end - tail}, new};
  f->give(f->context, &edit);
  cag_free(new);
}

static void format_part(Formatting *f, CagSpan part) {
  CagDiagnostics errors = {0};
  size_t length = 0;
  CagSource *source = cag_source_new(f->d->file, f->d->text + part.start, part.end - part.start);
  char *text = source ? cag_format(source, &errors, &length) : NULL;
  if (text) {
    const bool whole = part.start == 0 && part.end == f->d->length;
    if (!whole && length && text[length - 1] == '\n') text[--length] = 0;
    give_difference(f, part, text, length);
    f->ok = true;
  }
  cag_free(text);
  cag_source_free(source);
  cag_diagnostics_clear(&errors);
}

static void format(void *context) {
  Formatting *f = context;
  if (f->start == 0 && f->end >= f->d->length) {
    format_part(f, (CagSpan){0, (uint32_t)f->d->length});
    return;
  }
  const CagModuleAst *ast = f->d->unit->ast;
  f->ok = true;
  for (size_t i = 0; ast && i < ast->count; i++) {
    const CagStatement *s = ast->statements[i];
    if (s->span.end < f->start || s->span.start > f->end || s->damage != CAG_SOUND) continue;
    CagSpan part = s->span; // with the sound statements after it
    while (i + 1 < ast->count && ast->statements[i + 1]->span.start <= f->end &&
           ast->statements[i + 1]->damage == CAG_SOUND)
      part.end = ast->statements[++i]->span.end;
    const char *rest = f->d->text + part.end; // a comment at its end
    const size_t line = strcspn(rest, "\n"), blank = strspn(rest, " \t;");
    if (strncmp(rest + blank, "//", 2) == 0) part.end += (uint32_t)line;
    format_part(f, part);
  }
}

bool cag_document_format(CagWorkspace *w, const char *file, size_t start, size_t end,
                         CagGiveEdit *give, void *context) {
  Formatting f = {cag_document_get(w, file), start, end, give, context, false};
  return f.d && cag_document_guard(format, &f) && f.ok;
}

// --- Actions ---

#define EDITS_MAX 4

typedef struct Actions {
  CagWorkspace *w;
  Document *d;
  size_t start, end;
  void (*give)(void *context, const CagActionView *a);
  void *context;
  CagArena memory;
  const CagDiagnostic *problem; // being fixed; NULL: none
} Actions;

static CagEdit edit_of(const Actions *a, size_t start, size_t end, const char *text) {
  return (CagEdit){{a->d->file, start, end}, text};
}

static void give_action(const Actions *a, const char *title, CagActionKind kind, bool preferred,
                        const CagEdit *edits, size_t count) {
  CagActionView view = {
      .title = title, .kind = kind, .is_preferred = preferred, .edits = edits, .edit_count = count};
  if (a->problem) {
    view.code = cag_error_info(a->problem->id)->code;
    view.problem = (CagPlace){a->d->file, a->problem->span.start, a->problem->span.end};
  }
  a->give(a->context, &view);
}

static void give_fix(const Actions *a, const char *title, size_t start, size_t end,
                     const char *text) {
  const CagEdit edit = edit_of(a, start, end, text);
  give_action(a, title, CAG_ACTION_FIX, true, &edit, 1);
}

static const char *text_of(Actions *a, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
static const char *text_of(Actions *a, const char *format, ...) {
  va_list args;
  char *text;
  va_start(args, format);
  const int n = cag_vasprintf(&text, format, args);
  va_end(args);
  if (n < 0) cag_memory_leave();
  const char *copy = cag_arena_copy(&a->memory, text, (size_t)n);
  cag_free(text);
  return copy;
}

// Returns the text between the first two backquotes, or NULL.
static const char *quoted(Actions *a, const char *text) {
  const char *from = text ? strchr(text, '`') : NULL, *to = from ? strchr(from + 1, '`') : NULL;
  return to ? cag_arena_copy(&a->memory, from + 1, (size_t)(to - from - 1)) : NULL;
}

static const char *source_text(Actions *a, CagSpan span) {
  return cag_arena_copy(&a->memory, a->d->text + span.start, span.end - span.start);
}

// ---- lines ----

static size_t line_start(const Document *d, size_t at) {
  while (at > 0 && d->text[at - 1] != '\n') at--;
  return at;
}

static size_t line_end(const Document *d, size_t at) {
  while (at < d->length && d->text[at] != '\n') at++;
  return at < d->length ? at + 1 : at;
}

static const char *indent_of(Actions *a, size_t line) {
  return cag_arena_copy(&a->memory, a->d->text + line, strspn(a->d->text + line, " \t"));
}

// ---- imports ----

static size_t import_place(const Document *d) {
  const CagModuleAst *ast = d->unit->ast;
  size_t last = SIZE_MAX, end = 0;
  for (size_t i = 0; i < ast->count; i++)
    if (ast->statements[i]->kind == CAG_STATEMENT_IMPORT) last = ast->statements[i]->span.end;
  if (last != SIZE_MAX) return line_end(d, last);
  while (strncmp(d->text + end, "//", 2) == 0 && d->text[end + 2] != '/') end = line_end(d, end);
  while (d->text[end] == '\n') end++;
  return end;
}

static void give_import(Actions *a, const char *module, const char *name) {
  const size_t at = import_place(a->d);
  give_fix(a, text_of(a, "Import %s from %s", name, module), at, at,
           text_of(a, "import %s: %s\n", module, name));
}

static bool defines(const CagModuleUnit *m, const char *name) {
  for (size_t i = 0; i < m->public_count; i++)
    if (strcmp(m->publics[i].name, name) == 0) return true;
  return false;
}

typedef struct ImportSearch {
  Actions *a;
  const char *name;
} ImportSearch;

// Proposes an import from a file in the folder of the document, or below it.
static bool import_from(void *context, Document *d) {
  const ImportSearch *s = context;
  Actions *a = s->a;
  const char *own = a->d->path, *slash = own ? strrchr(own, '/') : NULL;
  const size_t folder = slash ? (size_t)(slash - own) + 1 : 0;
  if (d == a->d || !d->path || !folder || strncmp(d->path, own, folder) != 0) return true;
  if (!d->unit->ast || !defines(d->unit, s->name)) return true;
  char *module = cag_arena_copy(&a->memory, d->path + folder, strlen(d->path + folder));
  const size_t n = strlen(module);
  if (n < 5 || strcmp(module + n - 4, ".cag") != 0) return true;
  const bool words = !module[strspn(module, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                            "0123456789_/.")] &&
                     !memchr(module, '.', n - 4);
  if (words) {
    module[n - 4] = 0;
    for (char *at = module; *at; at++)
      if (*at == '/') *at = '.';
    give_import(a, module, s->name);
  } else give_import(a, text_of(a, "\"%s\"", module), s->name);
  return true;
}

static void fix_unknown_name(Actions *a, CagSpan span) {
  const char *name = source_text(a, span);
  for (const CagStdlibFile *f = cag_stdlib; f->module; f++) {
    Document *module = cag_document_get(a->w, f->module);
    if (module && defines(module->unit, name)) give_import(a, f->module, name);
    if (strcmp(f->module + 4, name) != 0) continue;
    const size_t at = import_place(a->d);
    give_fix(a, text_of(a, "Import %s", f->module), at, at, text_of(a, "import %s\n", f->module));
  }
  cag_workspace_each(a->w, name, import_from, &(ImportSearch){a, name});
  const CagStatement *s = cag_tree_statement(a->d->unit->ast, span.start);
  const size_t at = s ? line_start(a->d, s->span.start) : 0, param = import_place(a->d);
  if (!s || a->d->text[span.end] == '(' || a->d->text[span.end] == '.') return;
  const CagEdit define = edit_of(a, at, at, text_of(a, "%s = 10\n", name)),
                add = edit_of(a, param, param, text_of(a, "param %s = 10\n", name));
  give_action(a, text_of(a, "Define %s", name), CAG_ACTION_FIX, false, &define, 1);
  give_action(a, text_of(a, "Add the param %s", name), CAG_ACTION_FIX, false, &add, 1);
}

// ---- unused definitions ----

// Returns the statement whose name is at a place, in the module or a block. If the name is in a
// pattern, it is the place of the name.
typedef struct StatementSearch {
  uint32_t at;
  const CagStatement *found;
  const CagPattern *pattern; // of the statement; NULL: none
} StatementSearch;

static void test_statement(StatementSearch *s, const CagStatement *st) {
  if (st->kind == CAG_STATEMENT_PARAM && st->as.param.decl->span.start == s->at) s->found = st;
  if (st->kind != CAG_STATEMENT_DEFINITION) return;
  const CagPattern *pattern = st->as.definition.pattern;
  if (!pattern && st->as.definition.decl->span.start == s->at) s->found = st;
  for (size_t i = 0; pattern && i < pattern->name_count; i++)
    if (pattern->names[i]->span.start == s->at) {
      s->found = st;
      s->pattern = pattern;
    }
}

static void find_in_blocks(void *context, const CagExpr *e) {
  StatementSearch *s = context;
  if (e->span.start > s->at || s->at > e->span.end) return;
  for (size_t i = 0; e->kind == CAG_EXPR_BLOCK && i < e->as.block.count; i++)
    test_statement(s, e->as.block.statements[i]);
  cag_tree_below(e, find_in_blocks, s);
}

// Removes part k of a list, with its comma.
static void remove_part(Actions *a, const CagPattern *pattern, size_t k, const char *title) {
  const CagPatternPart *parts = pattern->parts;
  const size_t start = k ? parts[k - 1].pattern->span.end : parts[k].field_span.start;
  const size_t end = k ? parts[k].pattern->span.end : parts[k + 1].field_span.start;
  give_fix(a, title, start, end, "");
}

// Removes a name from a pattern that has other names. The place of an element is kept by `_`, and
// that of a field is not needed.
static void remove_from_pattern(Actions *a, const CagPattern *pattern, CagSpan span) {
  const char *title = text_of(a, "Remove the unused %s", source_text(a, span));
  for (size_t i = 0; i < pattern->count; i++) {
    const CagPattern *part = pattern->parts[i].pattern;
    if (part->kind != CAG_PATTERN_NAME) remove_from_pattern(a, part, span);
    else if (part->span.start != span.start) continue;
    else if (pattern->parts[i].field && pattern->count > 1) remove_part(a, pattern, i, title);
    else if (cag_pattern_is_shorthand(&pattern->parts[i]))
      give_fix(a, title, span.end, span.end, ": _");
    else give_fix(a, title, span.start, span.end, "_");
  }
  if (pattern->rest && pattern->rest->span.start == span.start)
    give_fix(a, title, span.start, span.end, "_");
}

static void remove_statement(Actions *a, const CagStatement *s, const char *name) {
  const Document *d = a->d;
  size_t start = s->span.start, end = s->span.end;
  const CagModuleAst *ast = d->unit->ast;
  for (size_t i = ast->comment_count; i-- > 0;) { // with its /// lines
    const CagSpan c = ast->comments[i].span;
    if (c.end > start) continue;
    const char *between = d->text + c.end;
    if (!ast->comments[i].doc || strspn(between, " \t\r\n") != start - c.end) break;
    start = c.start;
  }
  const bool alone = strspn(d->text + line_start(d, start), " \t") == start - line_start(d, start);
  end += strspn(d->text + end, " \t;");
  const bool last = end >= d->length || d->text[end] == '\n';
  if (alone) start = line_start(d, start);
  if (alone && last) end = line_end(d, end);
  give_fix(a, text_of(a, "Remove the unused %s", name), start, end, "");
}

// Removes a name from the list of an import, with its comma.
static void remove_imported(Actions *a, const CagStatement *s, size_t k) {
  const CagImportName *names = s->as.import.names;
  const char *name = names[k].decl->name;
  if (s->as.import.name_count == 1) {
    remove_statement(a, s, name);
    return;
  }
  const size_t start = k ? names[k - 1].decl->span.end : names[k].decl->span.start;
  const size_t end = k ? names[k].decl->span.end : names[k + 1].decl->span.start;
  give_fix(a, text_of(a, "Remove the unused %s", name), start, end, "");
}

static void fix_unused(Actions *a, CagSpan span) {
  const CagStatement *s = cag_tree_statement(a->d->unit->ast, span.start);
  if (!s) return;
  if (s->kind == CAG_STATEMENT_IMPORT) {
    for (size_t k = 0; k < s->as.import.name_count; k++)
      if (s->as.import.names[k].decl->span.start == span.start) {
        remove_imported(a, s, k);
        return;
      }
    remove_statement(a, s, s->as.import.path);
    return;
  }
  StatementSearch search = {.at = span.start};
  test_statement(&search, s);
  if (!search.found) cag_tree_of_statement(s, find_in_blocks, &search);
  if (search.pattern && search.pattern->name_count > 1)
    remove_from_pattern(a, search.pattern, span);
  else if (search.found) remove_statement(a, search.found, source_text(a, span));
}

// ---- fixes that the help of an error states ----

static const char *after(const char *text, const char *start) {
  const size_t n = strlen(start);
  return text && strncmp(text, start, n) == 0 ? text + n : NULL;
}

// A number that lacks the unit of an angle: the help has both forms.
static void fix_unit(Actions *a, CagSpan span, const char *form) {
  const size_t n = strcspn(form, " ,");
  const char *value = cag_arena_copy(&a->memory, form, n);
  const size_t digits = strspn(value, "-0123456789.e");
  // Finds the number in the span, which may be that of an operation.
  for (size_t at = span.start; at + digits <= span.end; at++) {
    if (strncmp(a->d->text + at, value, digits) != 0) continue;
    const char next = a->d->text[at + digits];
    if ((next >= '0' && next <= '9') || next == '.' || (next >= 'a' && next <= 'z')) continue;
    give_fix(a, text_of(a, "Write %s", value), at, at + digits, value);
    break;
  }
  const char *other = strstr(form, " or ");
  if (other && strstr(other, "rad")) fix_unit(a, span, other + 4);
}

static bool is_sign(const char *text) { return *text && !text[strspn(text, "!&|=<>*/+-:~^%?")]; }

static void fix_by_words(Actions *a, CagSpan span, const char *form) {
  const char *text = source_text(a, span);
  const size_t n = strlen(form);
  const bool one_word = !strpbrk(form, " \n");
  if (a->problem->id == CAG_ERR_tuple || a->problem->id == CAG_ERR_number_point) {
    // The form of a long list is only an example.
    const size_t inside = span.end - span.start > 2 ? span.end - span.start - 2 : 0;
    if (a->problem->id == CAG_ERR_tuple)
      form = text_of(a, "[%.*s]", (int)inside, a->d->text + span.start + 1);
    give_fix(a, text_of(a, "Write %s", form), span.start, span.end, form);
  } else if (a->problem->id == CAG_ERR_print_parentheses && n > 6) {
    give_fix(a, "Remove the parentheses", span.start, span.end,
             text_of(a, "%s%.*s", span.start && a->d->text[span.start - 1] != ' ' ? " " : "",
                     (int)(span.end - span.start - 2), a->d->text + span.start + 1));
  } else if (a->problem->id == CAG_ERR_needs_parentheses && n > 2 &&
             strncmp(a->d->text + span.start, form + 1, n - 2) == 0) {
    give_fix(a, "Add parentheses", span.start, span.start + n - 2, form);
  } else if (one_word && is_sign(text)) {
    give_fix(a, text_of(a, "Write %s", form), span.start, span.end, form);
  }
}

static void fix_expression_statement(Actions *a, CagSpan span) {
  give_fix(a, "Print it", span.start, span.start, "print ");
  give_fix(a, "Show it", span.start, span.start, "show ");
}

// Inserts the missing bracket before the next statement.
static void fix_open_bracket(Actions *a, const char *closer) {
  size_t at = a->d->length;
  const CagDiagnostic *p = a->problem;
  if (p->note_count && p->notes[0].source) at = p->notes[0].span.start;
  else
    for (size_t i = 0; i < a->d->unit->ast->count; i++)
      if (a->d->unit->ast->statements[i]->span.start > p->span.start) {
        at = a->d->unit->ast->statements[i]->span.start;
        break;
      }
  while (at > p->span.end && strchr(" \t\r\n", a->d->text[at - 1])) at--;
  give_fix(a, text_of(a, "Insert %s", closer), at, at, closer);
}

static void fix_equals(Actions *a, CagSpan span) {
  size_t start = span.start;
  while (start > 0 && a->d->text[start - 1] == ' ') start--;
  const bool blank = a->d->text[span.end] == ' ';
  give_fix(a, "Write a colon", start, span.end, blank ? ":" : ": ");
}

static void fix_problem(Actions *a, const CagDiagnostic *p) {
  const CagSpan span = p->span;
  const char *help = p->help, *form;
  a->problem = p;
  if (after(help, "did you mean ") && (form = quoted(a, help)))
    give_fix(a, text_of(a, "Change to `%s`", form), span.start, span.end, form);
  const char *unit = after(help, "write the number with a unit: ");
  form = after(help, "write ");
  if (!unit && form && p->id == CAG_ERR_type && strstr(form, "deg")) unit = form;
  if (unit) fix_unit(a, span, unit);
  else if (form) fix_by_words(a, span, form);
  else if (after(help, "remove `"))
    give_fix(a, "Remove the word", span.start, span.end + strspn(a->d->text + span.end, " "), "");
  else if (after(help, "remove the +") || after(help, "remove one comma"))
    give_fix(a, "Remove it", span.start, span.end, "");
  else if (after(help, "to compare, write ==")) give_fix(a, "Write ==", span.start, span.end, "==");
  switch (p->id) {
  case CAG_ERR_unknown_name: fix_unknown_name(a, span); break;
  case CAG_ERR_unused: fix_unused(a, span); break;
  case CAG_ERR_expression_statement:
    if (after(help, "write print")) fix_expression_statement(a, span);
    break;
  case CAG_ERR_argument_equals: fix_equals(a, span); break;
  case CAG_ERR_return:
    give_fix(a, "Remove the word", span.start, span.end + strspn(a->d->text + span.end, " "), "");
    break;
  case CAG_ERR_bracket_stray: give_fix(a, "Remove the bracket", span.start, span.end, ""); break;
  case CAG_ERR_bracket_not_closed:
    if (quoted(a, p->message)) fix_open_bracket(a, quoted(a, p->message));
    break;
  case CAG_ERR_deprecated:
    if ((form = quoted(a, help)))
      give_fix(a, text_of(a, "Change to `%s`", form), span.start, span.end, form);
    break;
  default: break;
  }
  a->problem = NULL;
}

static void fix_problems(Actions *a) {
  const CagDiagnostics *list = &a->d->session->diagnostics;
  for (size_t i = 0; i < list->count; i++) {
    const CagDiagnostic *p = cag_diagnostics_at(list, i);
    if (p->source != a->d->unit->source || p->span.start > a->end || p->span.end < a->start)
      continue;
    fix_problem(a, p);
  }
}

// ---- extraction ----

typedef struct ExtractSearch {
  size_t start, end;
  const CagExpr *found;
  const CagStatement *line; // the innermost statement of a block around it
  bool in_block, in_function;
  const char *label; // of the argument or field that it is
} ExtractSearch;

static void find_extract(void *context, const CagExpr *e);

static void find_in_block(ExtractSearch *s, const CagExpr *e) {
  const CagStatement *outer = s->line;
  const bool was_in_block = s->in_block;
  s->in_block = true;
  for (size_t i = 0; i < e->as.block.count && !s->found; i++) {
    s->line = e->as.block.statements[i];
    cag_tree_of_statement(s->line, find_extract, s);
  }
  if (s->found) return;
  s->line = NULL; // before the value of the block
  find_extract(s, e->as.block.value);
  if (s->found && !s->line) return;
  s->line = outer;
  s->in_block = was_in_block;
}

static void find_extract(void *context, const CagExpr *e) {
  ExtractSearch *s = context;
  if (s->found || e->span.start > s->start || s->end > e->span.end) return;
  if (e->span.start == s->start && e->span.end == s->end && e->kind != CAG_EXPR_ERROR) {
    s->found = e;
    return;
  }
  if (e->kind == CAG_EXPR_BLOCK) {
    find_in_block(s, e);
    return;
  }
  const bool scope = e->kind == CAG_EXPR_LAMBDA || e->kind == CAG_EXPR_COMPREHENSION;
  const bool was = s->in_function;
  // What is in a function of its own inside of a block cannot move to the block.
  if (scope) s->in_function = true;
  for (size_t i = 0; e->kind == CAG_EXPR_CALL && i < e->as.call.count; i++)
    if (e->as.call.arguments[i].name && e->as.call.arguments[i].value->span.start == s->start)
      s->label = e->as.call.arguments[i].name;
  for (size_t i = 0; e->kind == CAG_EXPR_RECORD && i < e->as.record.count; i++)
    if (e->as.record.fields[i].name && e->as.record.fields[i].value->span.start == s->start)
      s->label = e->as.record.fields[i].name;
  cag_tree_below(e, find_extract, s);
  if (!s->found) s->in_function = was;
}

typedef struct LocalUse {
  bool found;
} LocalUse;

static void find_local(void *context, const CagExpr *e) {
  LocalUse *u = context;
  const CagDecl *d =
      e->kind == CAG_EXPR_NAME && e->as.name.binding == CAG_BIND_DECL ? e->as.name.decl : NULL;
  u->found |= d && (d->kind == CAG_DECL_PARAMETER || d->kind == CAG_DECL_BLOCK ||
                    d->kind == CAG_DECL_CLAUSE);
  cag_tree_below(e, find_local, u);
}

static void compare_name(void *context, const CagDecl *decl) {
  const char **name = context;
  if (*name && strcmp(decl->name, *name) == 0) *name = NULL;
}

// Returns a name that is free in the whole document.
static const char *free_name(Actions *a, const char *wanted) {
  for (int i = 1;; i++) {
    const char *name = i == 1 ? wanted : text_of(a, "%s%d", wanted, i), *left = name;
    cag_document_scope(a->d, a->start, compare_name, &left);
    const Entity other = cag_document_lookup(a->d, a->d->length, name, strlen(name));
    const bool builtin = other.kind == ENTITY_BUILTIN && i == 1 && wanted[0] == 'v';
    bool used = !left || builtin || other.kind == ENTITY_DECL || cag_word_is_reserved(name);
    for (size_t k = 0; !used && k < a->d->occurrence_count; k++) {
      const CagSpan span = a->d->occurrences[k].span;
      used = a->d->occurrences[k].entity.kind != ENTITY_FIELD &&
             a->d->occurrences[k].role != ROLE_LABEL && span.end - span.start == strlen(name) &&
             memcmp(a->d->text + span.start, name, strlen(name)) == 0;
    }
    if (!used) return name;
  }
}

static void extract_definition(Actions *a, const ExtractSearch *s, const CagStatement *top) {
  const CagExpr *e = s->found;
  LocalUse local = {false};
  find_local(&local, e);
  const char *name = free_name(a, "value");
  size_t at = line_start(a->d, top->span.start);
  if (local.found) {
    if (!s->in_block) return;
    at = line_start(a->d, s->line ? s->line->span.start : e->span.start);
    if (at <= top->span.start) return; // a block on one line
  }
  const char *indent = local.found ? indent_of(a, at) : "";
  const CagEdit edits[] = {
      edit_of(a, at, at, text_of(a, "%s%s = %s\n", indent, name, source_text(a, e->span))),
      edit_of(a, e->span.start, e->span.end, name)};
  give_action(a, "Extract to a definition", CAG_ACTION_EXTRACT, false, edits, 2);
}

static bool is_param_value(const CagExpr *e) {
  while (e->kind == CAG_EXPR_NEGATE) e = e->as.unary.operand;
  return e->kind == CAG_EXPR_NUMBER || e->kind == CAG_EXPR_ANGLE || e->kind == CAG_EXPR_TEXT ||
         e->kind == CAG_EXPR_TRUE || e->kind == CAG_EXPR_FALSE;
}

static void extract_param(Actions *a, const ExtractSearch *s) {
  if (!is_param_value(s->found)) return;
  const char *name = free_name(a, s->label ? s->label : "size");
  const size_t at = import_place(a->d);
  const CagSpan span = s->found->span;
  const CagEdit edits[] = {
      edit_of(a, at, at, text_of(a, "param %s = %s\n", name, source_text(a, span))),
      edit_of(a, span.start, span.end, name)};
  give_action(a, text_of(a, "Make it the param %s", name), CAG_ACTION_EXTRACT, false, edits, 2);
}

// The smallest literal around the cursor can become a param without being selected.
static void find_literal(void *context, const CagExpr *e) {
  ExtractSearch *s = context;
  if (e->span.start > s->start || s->end > e->span.end) return;
  if (is_param_value(e)) {
    s->start = e->span.start;
    s->end = e->span.end;
    return;
  }
  cag_tree_below(e, find_literal, s);
}

static void make_param(Actions *a, const CagStatement *s) {
  if (s->kind != CAG_STATEMENT_DEFINITION || s->as.definition.pattern ||
      !is_param_value(s->as.definition.value) || a->start > s->as.definition.decl->span.end)
    return;
  const CagEdit edit = edit_of(a, s->span.start, s->span.start, "param ");
  give_action(a, text_of(a, "Make %s a param", s->as.definition.decl->name), CAG_ACTION_REWRITE,
              false, &edit, 1);
}

static void extract(Actions *a) {
  const CagStatement *top = cag_tree_statement(a->d->unit->ast, a->start);
  if (!top || top->damage == CAG_DAMAGED || top->kind == CAG_STATEMENT_IMPORT) return;
  make_param(a, top);
  if (top->kind == CAG_STATEMENT_PARAM) return;
  ExtractSearch s = {.start = a->start, .end = a->end};
  while (s.start < s.end && strchr(" \t\r\n", a->d->text[s.start])) s.start++;
  while (s.end > s.start && strchr(" \t\r\n", a->d->text[s.end - 1])) s.end--;
  const bool selected = s.end > s.start;
  if (!selected) cag_tree_of_statement(top, find_literal, &s);
  cag_tree_of_statement(top, find_extract, &s);
  if (!s.found) return;
  if (selected) extract_definition(a, &s, top);
  extract_param(a, &s);
}

static void give_actions(void *context) {
  Actions *a = context;
  if (!a->d->unit->ast) return;
  fix_problems(a);
  extract(a);
}

void cag_document_actions(CagWorkspace *w, const char *file, size_t start, size_t end,
                          void (*give)(void *context, const CagActionView *a), void *context) {
  Document *d = cag_workspace_document(w, file);
  if (!d || !cag_document_make_checked(w, d) || end > d->length || start > end) return;
  Actions a = {.w = w, .d = d, .start = start, .end = end, .give = give, .context = context};
  cag_document_guard(give_actions, &a);
  cag_arena_free(&a.memory);
}
