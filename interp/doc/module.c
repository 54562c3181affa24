// The public definitions of a script or module, with what their /// lines say.

#include <stdlib.h>
#include <string.h>

#include "interp/doc/doc.h"
#include "interp/eval/stdlib.h"
#include "interp/session/session.h"

// --- Texts of the source ---

static char *copy(const char *text, size_t n) {
  char *out = strndup(text, n);
  if (!out) abort();
  return out;
}

// A part of the source on one line: line breaks and the spaces around them become one space.
static char *copy_line(const char *text, size_t n) {
  char *out = copy(text, n), *to = out;
  for (char *at = out; *at;) {
    const size_t spaces = strspn(at, " \t\r\n");
    const bool broken = spaces && strcspn(at, "\n") < spaces;
    if (broken) {
      *to++ = ' ';
      at += spaces;
    } else {
      *to++ = *at++;
    }
  }
  while (to > out && to[-1] == ' ') to--;
  *to = 0;
  return out;
}

static char *copy_span(const CagSource *s, CagSpan span) {
  return copy_line(s->text + span.start, span.end - span.start);
}

// --- Entries ---

static void read_arguments(const CagSource *s, const CagFunctionAst *f, CagDocEntry *e) {
  e->arguments = calloc(f->parameter_count + 1, sizeof *e->arguments);
  if (!e->arguments) abort();
  for (size_t i = 0; i < f->parameter_count; i++) {
    const CagParameter *p = &f->parameters[i];
    e->arguments[i].name = copy(p->decl->name, strlen(p->decl->name));
    if (p->fallback) e->arguments[i].fallback = copy_span(s, p->fallback->span);
  }
  e->argument_count = f->parameter_count;
}

// "flat(profile, height = 10)": the head of a definition, up to its `=`.
static char *function_head(const CagSource *s, CagSpan statement, const CagFunctionAst *f) {
  size_t end = f->body->span.start;
  const char *text = s->text;
  while (end > statement.start && strchr(" \t\r\n", text[end - 1])) end--;
  if (end > statement.start && text[end - 1] == '=') end--;
  return copy_line(text + statement.start, end - statement.start);
}

static void read_entry(const CagSource *s, const CagDecl *d, CagDocEntry *e) {
  const CagStatement *st = d->statement;
  *e = (CagDocEntry){.name = copy(d->name, strlen(d->name))};
  if (d->doc) e->text = copy(d->doc, strlen(d->doc));
  if (st->kind == CAG_STATEMENT_PARAM) {
    e->kind = CAG_DOC_PARAM;
    e->signature = copy_span(s, st->span);
    e->fallback = copy_span(s, st->as.param.value->span);
    if (st->as.param.domain) e->range = copy_span(s, st->as.param.domain->span);
    if (st->as.param.label) e->label = copy(st->as.param.label, strlen(st->as.param.label));
    return;
  }
  const CagExpr *value = st->as.definition.value;
  const bool head = value->kind == CAG_EXPR_LAMBDA && value->as.function->name;
  if (!head) {
    e->kind = CAG_DOC_VALUE;
    e->signature = copy(d->name, strlen(d->name));
    return;
  }
  e->kind = CAG_DOC_FUNCTION;
  e->signature = function_head(s, st->span, value->as.function);
  read_arguments(s, value->as.function, e);
}

// The // lines at the very start, without their slashes.
static char *read_purpose(const CagModuleAst *ast) {
  const CagSource *s = ast->source;
  char *out = copy(s->text, s->length), *to = out;
  size_t line = 1, length;
  for (; line <= s->line_count; line++) {
    const char *text = cag_source_line(s, line, &length);
    if (length < 2 || strncmp(text, "//", 2) != 0 || (length > 2 && text[2] == '/')) break;
    const size_t skip = length > 2 && text[2] == ' ' ? 3 : 2;
    memmove(to, text + skip, length - skip);
    to += length - skip;
    *to++ = '\n';
  }
  *to = 0;
  return out;
}

void cag_doc_module_read(const CagModuleAst *ast, const char *name, CagDocModule *out) {
  *out = (CagDocModule){.name = copy(name, strlen(name)), .purpose = read_purpose(ast)};
  out->entries = calloc(ast->top_count + 1, sizeof *out->entries);
  if (!out->entries) abort();
  for (size_t i = 0; i < ast->top_count; i++)
    if (ast->tops[i]->name[0] != '_')
      read_entry(ast->source, ast->tops[i], &out->entries[out->count++]);
}

void cag_doc_module_free(CagDocModule *m) {
  for (size_t i = 0; i < m->count; i++) {
    CagDocEntry *e = &m->entries[i];
    for (size_t k = 0; k < e->argument_count; k++) {
      free(e->arguments[k].name);
      free(e->arguments[k].fallback);
    }
    char *const texts[] = {e->name, e->signature, e->text, e->fallback, e->range, e->label};
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) free(texts[k]);
    free(e->arguments);
  }
  free(m->entries);
  free(m->name);
  free(m->purpose);
  *m = (CagDocModule){0};
}

// --- The library ---

const char *cag_doc_library(const char *name, const char **text, size_t *length) {
  const bool whole = strncmp(name, "std.", 4) == 0;
  for (const CagStdlibFile *f = cag_stdlib; f->module; f++) {
    if (strcmp(f->module + (whole ? 0 : 4), name) != 0) continue;
    *text = f->text;
    *length = f->length;
    return f->module;
  }
  return NULL;
}

const char *cag_doc_module_name(size_t i) { return cag_stdlib[i].module; }

// --- Summaries ---

size_t cag_doc_default(const char *fallback) {
  const char *others = strstr(fallback, "\"|\"");
  return others ? (size_t)(others - fallback) + 1 : strlen(fallback);
}

size_t cag_doc_sentence(const char *text) {
  for (const char *at = text; *at; at++) {
    const bool stop = *at == '.' && (at[1] == ' ' || at[1] == '\n' || at[1] == 0);
    // "1 .. n ... and so on" and "e.g. x" are no ends.
    if (stop && at > text && at[-1] != '.' && (at[1] == 0 || (at[2] >= 'A' && at[2] <= 'Z')))
      return (size_t)(at - text) + 1;
  }
  return strlen(text);
}

void cag_doc_reasons(const char *summary, void (*give)(void *context, CagErrorId id),
                     void *context) {
  for (const char *at = summary; (at = strchr(at, '(')); at++) {
    const size_t n = strspn(at + 1, "abcdefghijklmnopqrstuvwxyz-");
    char reason[64];
    if (n == 0 || n >= sizeof reason || at[n + 1] != ')') continue;
    memcpy(reason, at + 1, n);
    reason[n] = 0;
    const CagErrorId id = cag_error_by_reason(reason);
    if (id != CAG_ERR_COUNT) give(context, id);
  }
}
