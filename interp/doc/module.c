// The public definitions of a script or module, with the text of their /// lines.

#include <string.h>

#include "base/memory.h"
#include "interp/doc/doc.h"
#include "interp/vm/stdlib.h"
#include "lang/tree.h"

// --- Texts of the source ---

static char *copy(const char *text, size_t n) {
  char *out = cag_strndup(text, n);
  if (!out) cag_memory_leave();
  return out;
}

// Copies a part of the source as one line. Line breaks and the spaces around them become one space,
// or nothing next to brackets.
static char *copy_line(const char *text, size_t n) {
  char *out = copy(text, n), *to = out;
  for (char *at = out; *at;) {
    const size_t spaces = strspn(at, " \t\r\n");
    const bool broken = spaces && strcspn(at, "\n") < spaces;
    if (broken) {
      at += spaces;
      if (to > out && !strchr("([{", to[-1]) && *at && !strchr(")]}", *at)) *to++ = ' ';
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
  e->arguments = cag_calloc(f->parameter_count + 1, sizeof *e->arguments);
  if (!e->arguments) cag_memory_leave();
  for (size_t i = 0; i < f->parameter_count; i++) {
    const CagParameter *p = &f->parameters[i];
    e->arguments[i].name = copy(p->decl->name, strlen(p->decl->name));
    if (p->fallback) e->arguments[i].fallback = copy_span(s, p->fallback->span);
  }
  e->argument_count = f->parameter_count;
}

// Finds the source lines of the `count` /// lines before a statement.
static void find_lines(const CagModuleAst *ast, const CagStatement *st, size_t count,
                       CagDocEntry *e) {
  size_t i = 0;
  e->lines = cag_calloc(count + 1, sizeof *e->lines);
  if (!e->lines) cag_memory_leave();
  while (i < ast->comment_count && ast->comments[i].span.start < st->span.start) i++;
  while (count > 0 && i-- > 0)
    if (ast->comments[i].doc)
      e->lines[--count] = cag_source_position(ast->source, ast->comments[i].span.start).line;
}

// Finds the parameter that an item such as "- `width`: number, mm: how wide" describes; `n` bytes.
static CagDocArgument *find_item(CagDocEntry *e, const char *line, size_t n, size_t *skip) {
  for (size_t i = 0; i < e->argument_count; i++) {
    const size_t k = strlen(e->arguments[i].name);
    if (n < k + 6 || strncmp(line, "- `", 3) != 0 || strncmp(line + k + 3, "`: ", 3) != 0) continue;
    if (strncmp(line + 3, e->arguments[i].name, k) != 0 || e->arguments[i].meaning) continue;
    *skip = k + 6;
    return &e->arguments[i];
  }
  return NULL;
}

// Adds a part of a line to the description of a parameter.
static void add_meaning(CagDocArgument *a, const char *text, size_t n) {
  char *old = a->meaning;
  const size_t spaces = strspn(text, " ");
  if (cag_asprintf(&a->meaning, "%s%s%.*s", old ? old : "", old ? " " : "", (int)(n - spaces),
                   text + spaces) < 0)
    cag_memory_leave();
  cag_free(old);
}

// Moves the items that describe parameters from the text to the arguments. Continuation lines of an
// item are indented by two.
static void read_items(CagDocEntry *e) {
  char *to = e->text;
  size_t kept = 0, line = 0;
  CagDocArgument *item = NULL;
  bool gap = false; // the last kept line is blank, so a blank line after the items is dropped
  for (const char *at = e->text; *at; line++) {
    size_t n = strcspn(at, "\n"), skip = 0;
    const size_t next = n + (at[n] == '\n');
    CagDocArgument *begun = find_item(e, at, n, &skip);
    const bool more = item && !begun && strncmp(at, "  ", 2) == 0 && strspn(at, " ") < n;
    item = begun ? begun : more ? item : NULL;
    if (item) {
      add_meaning(item, at + skip, n - skip);
      gap = to == e->text || (to - e->text > 1 && to[-2] == '\n'); // blank, or the start of the
                                                                   // text
    } else if (n > 0 || !gap) {
      gap = false;
      e->lines[kept++] = e->lines[line];
      memmove(to, at, next);
      to += next;
    }
    at += next;
  }
  *to = 0;
}

// Returns the head of a definition up to its `=`: "flat(profile, height = 10)".
static char *function_head(const CagSource *s, CagSpan statement, const CagFunctionAst *f) {
  size_t end = f->body->span.start;
  const char *text = s->text;
  while (end > statement.start && strchr(" \t\r\n", text[end - 1])) end--;
  if (end > statement.start && text[end - 1] == '=') end--;
  return copy_line(text + statement.start, end - statement.start);
}

static size_t count_lines(const char *text) {
  size_t count = 1;
  for (; *text; text++) count += *text == '\n';
  return count;
}

static void read_entry(const CagModuleAst *ast, const CagDecl *d, CagDocEntry *e) {
  const CagSource *s = ast->source;
  const CagStatement *st = d->statement;
  *e = (CagDocEntry){.name = copy(d->name, strlen(d->name))};
  if (d->doc) {
    e->text = copy(d->doc, strlen(d->doc));
    find_lines(ast, st, count_lines(d->doc), e);
  }
  if (st->kind == CAG_STATEMENT_PARAM) {
    e->kind = CAG_DOC_PARAM;
    e->signature = copy_span(s, st->span);
    e->fallback = copy_span(s, st->as.param.value->span);
    if (st->as.param.domain) e->range = copy_span(s, st->as.param.domain->span);
    if (st->as.param.label) e->label = copy(st->as.param.label, strlen(st->as.param.label));
    return;
  }
  const CagExpr *value = cag_tree_value(d);
  const bool head = value && value->kind == CAG_EXPR_LAMBDA && value->as.function->name;
  if (!head) {
    e->kind = CAG_DOC_VALUE;
    e->signature = copy(d->name, strlen(d->name));
    return;
  }
  e->kind = CAG_DOC_FUNCTION;
  e->signature = function_head(s, st->span, value->as.function);
  read_arguments(s, value->as.function, e);
  if (e->text) read_items(e);
}

// Reads the // lines at the very start, without their slashes.
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
  out->entries = cag_calloc(ast->top_count + 1, sizeof *out->entries);
  if (!out->entries) cag_memory_leave();
  for (size_t i = 0; i < ast->top_count; i++)
    if (!ast->tops[i]->whole && ast->tops[i]->name[0] != '_')
      read_entry(ast, ast->tops[i], &out->entries[out->count++]);
}

void cag_doc_module_free(CagDocModule *m) {
  for (size_t i = 0; i < m->count; i++) {
    CagDocEntry *e = &m->entries[i];
    for (size_t k = 0; k < e->argument_count; k++) {
      cag_free(e->arguments[k].name);
      cag_free(e->arguments[k].fallback);
      cag_free(e->arguments[k].meaning);
    }
    char *const texts[] = {e->name, e->signature, e->text, e->fallback, e->range, e->label};
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) cag_free(texts[k]);
    cag_free(e->arguments);
    cag_free(e->lines);
  }
  cag_free(m->entries);
  cag_free(m->name);
  cag_free(m->purpose);
  *m = (CagDocModule){0};
}

// --- Examples ---

size_t cag_doc_part(const char *text, bool *is_code) {
  const char *at = text;
  *is_code = strncmp(text, "    ", 4) == 0;
  while (*at) {
    const size_t n = strcspn(at, "\n"), next = n + (at[n] == '\n');
    const bool indented = strncmp(at, "    ", 4) == 0;
    // A blank line belongs to a script if the next line does.
    const bool between = n == 0 && strncmp(at + next, "    ", 4) == 0;
    if (*is_code ? !indented && !between : indented) break;
    at += next;
  }
  return (size_t)(at - text);
}

char *cag_doc_part_text(const char *text, size_t length, bool is_code) {
  char *part = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&part, &size);
  if (!out) cag_memory_leave();
  for (const char *at = text; at < text + length;) {
    const size_t n = strcspn(at, "\n"), indent = is_code && n >= 4 ? 4 : 0;
    fprintf(out, "%.*s\n", (int)(n - indent), at + indent);
    at += n + (at[n] == '\n');
  }
  fclose(out);
  return part;
}

static bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         (unsigned char)c >= 0x80;
}

// Tests whether a text contains the word, other than as a member (`.word`). With `defined`, tests
// whether a line defines the word; an imported name must not be defined again.
static bool has_word(const char *text, const char *word, bool defined) {
  const size_t n = strlen(word);
  for (const char *at = text; (at = strstr(at, word)); at += n) {
    const char before = at > text ? at[-1] : '\n', after = at[n];
    if (is_letter(before) || before == '.' || is_letter(after)) continue;
    if (!defined) return true;
    const size_t line = strcspn(at, "\n"), head = strcspn(at, "=\n");
    if (before == '\n' && head < line && at[head + 1] != '=' && at[head + 1] != '>') return true;
  }
  return false;
}

// Finds the name of the module in examples: as in the import in the head of the script ("import
// parts.flange as f"), or else the name of its file.
static void find_module_name(const CagDocModule *m, const char *file, char *name, size_t size) {
  const int n = (int)strcspn(file, ".");
  snprintf(name, size, "%.*s", n, file);
  for (const char *at = m->purpose; (at = strstr(at, "import ")); at++) {
    const size_t line = strcspn(at, "\n");
    const char *stem = memmem(at, line, name, (size_t)n), *as = memmem(at, line, " as ", 4);
    if (!stem || !as || as < stem || n == 0) continue;
    size_t k = 0;
    while (is_letter(as[4 + k])) k++;
    snprintf(name, size, "%.*s", (int)k, as + 4);
    return;
  }
}

// Tests whether the text uses members of a module with the name of this script: "flange.plate".
static bool has_members_of(const char *text, const char *stem) {
  const size_t n = strlen(stem);
  if (n == 0 || (*stem >= '0' && *stem <= '9')) return false;
  for (const char *at = stem; *at; at++)
    if (!is_letter(*at)) return false;
  for (const char *at = text; (at = strstr(at, stem)); at += n)
    if (at[n] == '.' && (at == text || (!is_letter(at[-1]) && at[-1] != '.'))) return true;
  return false;
}

char *cag_doc_script_import(const CagDocModule *m, const char *file, const char *example) {
  char *line = NULL, stem[256];
  size_t size = 0, names = 0;
  if (has_word(example, "import", false)) return NULL;
  FILE *out = open_memstream(&line, &size);
  if (!out) cag_memory_leave();
  find_module_name(m, file, stem, sizeof stem);
  const bool whole = has_members_of(example, stem);
  fprintf(out, "import \"%s\"%s%s", file, whole ? " as " : "", whole ? stem : "");
  for (size_t i = 0; i < m->count; i++) {
    const char *name = m->entries[i].name;
    if (!has_word(example, name, false) || has_word(example, name, true)) continue;
    fprintf(out, "%s%s", names++ ? ", " : ": ", name);
  }
  fclose(out);
  if (names || whole) return line;
  cag_free(line);
  return NULL;
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
    // "1 .. n ... and so on" and "e.g. x" do not end a sentence.
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
