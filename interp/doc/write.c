// Documentation as text for a terminal.

#include <stdarg.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "base/memory.h"
#include "interp/doc/doc.h"

// The maximum line width, and the width assumed for narrower terminals, in columns.
#define WIDTH 92
#define NARROWEST 40
// The column at which the description of a parameter starts.
#define NAME_COLUMN 24

static void heading(const CagDocWriter *w, const char *text) {
  fprintf(w->out, w->styled ? "\033[1m%s\033[0m\n" : "%s\n", text);
}

// Returns the line width, which is smaller on a narrow terminal.
static size_t width_of(FILE *out) {
  struct winsize size;
  const int fd = fileno(out);
  if (fd < 0 || !isatty(fd) || ioctl(fd, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return WIDTH;
  return size.ws_col < NARROWEST ? NARROWEST : size.ws_col < WIDTH ? size.ws_col : WIDTH;
}

// Writes text with wrapped lines. The first line starts at column `at`, the others at `indent`.
static void write_wrapped(FILE *out, const char *text, size_t length, size_t indent, size_t at) {
  const size_t width = width_of(out);
  size_t column = at;
  bool first = true;
  for (size_t i = strspn(text, " \n"); i < length; i += strspn(text + i, " \n")) {
    size_t n = strcspn(text + i, " \n");
    if (n > length - i) n = length - i;
    if (!first && column + 1 + n > width) {
      fprintf(out, "\n%*s", (int)indent, "");
      column = indent;
    } else if (!first) {
      fputc(' ', out);
      column++;
    } else if (column < indent) {
      fprintf(out, "%*s", (int)(indent - column), "");
      column = indent;
    }
    fwrite(text + i, 1, n, out);
    column += n;
    i += n;
    first = false;
  }
  fputc('\n', out);
}

void cag_doc_write_wrapped(FILE *out, const char *text, size_t length, size_t indent) {
  write_wrapped(out, text, length, indent, 0);
}

void cag_doc_write_indented(FILE *out, const char *text, int indent) {
  while (*text) {
    const size_t n = strcspn(text, "\n");
    if (n) fprintf(out, "%*s%.*s\n", indent, "", (int)n, text);
    else fputc('\n', out);
    text += n + (text[n] == '\n');
  }
}

static bool is_script(const char *line) { return strncmp(line, "    ", 4) == 0; }

// Returns the length of the paragraph that starts with this line, without its last newline.
// *longest is the length of its longest line. Items of lists and rows of tables are separate
// paragraphs.
static size_t paragraph(const char *text, size_t *longest) {
  size_t end = *longest = strcspn(text, "\n");
  while (text[end] == '\n') {
    const char *line = text + end + 1;
    const size_t n = strcspn(line, "\n");
    if (n == 0 || is_script(line) || *line == '|' || strncmp(line, "- ", 2) == 0) break;
    if (n > *longest) *longest = n;
    end += 1 + n;
  }
  return end;
}

// Writes lines as they are, but wraps paragraphs that are too wide. Scripts are indented by four.
static void write_prose(FILE *out, const char *text, size_t indent) {
  const size_t width = width_of(out);
  while (*text) {
    size_t n = strcspn(text, "\n"), longest = 0;
    const size_t whole = is_script(text) || n == 0 ? n : paragraph(text, &longest);
    if (indent + longest > width) {
      n = whole;
      write_wrapped(out, text, n, indent, 0);
    } else {
      if (n) fprintf(out, "%*s%.*s", (int)indent, "", (int)n, text);
      fputc('\n', out);
    }
    text += n + (text[n] == '\n');
  }
}

char *cag_doc_text(const char *format, ...) {
  char *text;
  va_list args;
  va_start(args, format);
  const int n = cag_vasprintf(&text, format, args);
  va_end(args);
  if (n >= 0) return text;
  cag_memory_leave();
}

// --- Built-ins ---

static void write_parameter(FILE *out, const char *type, const char *meaning, const char *name,
                            const char *fallback) {
  const int used = fprintf(out, "    %s", name);
  char *text = cag_doc_text(
      "%s%s%s%s%.*s", type, *meaning ? ": " : "", meaning, fallback ? "; default " : "",
      fallback ? (int)cag_doc_default(fallback) : 0, fallback ? fallback : "");
  if (used + 2 > NAME_COLUMN) fprintf(out, "\n%*s", NAME_COLUMN, "");
  else fprintf(out, "%*s", NAME_COLUMN - used, "");
  write_wrapped(out, text, strlen(text), NAME_COLUMN, NAME_COLUMN);
  cag_free(text);
}

typedef struct Errors {
  FILE *out;
  size_t count;
} Errors;

static void write_error(void *context, CagErrorId id) {
  Errors *e = context;
  const CagErrorInfo *info = cag_error_info(id);
  if (e->count++ == 0) fputs("\n  Errors\n", e->out);
  fprintf(e->out, "    %s  %s: %s\n", info->code, info->reason, info->title);
}

static void write_row(const CagDocWriter *w, const CagBuiltin *row) {
  fprintf(w->out, w->styled ? "\033[1m%s\033[0m" : "%s", row->signature);
  if (row->result) fprintf(w->out, " -> %s", row->result);
  fputc('\n', w->out);
  write_wrapped(w->out, row->summary, strlen(row->summary), 2, 0);
  const CagSignature *s = cag_builtin_signature_of(row);
  if (s && (s->count || s->variadic)) fputs("\n  Parameters\n", w->out);
  for (size_t i = 0; s && i < s->count; i++)
    write_parameter(w->out, s->words[i], cag_doc_meaning(s->name, s->parameters[i]),
                    s->parameters[i], s->defaults[i]);
  if (s && s->variadic)
    write_parameter(w->out, "as the first", cag_doc_meaning(s->name, "..."), "...", NULL);
  Errors errors = {w->out, 0};
  cag_doc_reasons(row->summary, write_error, &errors);
  fputs("\n  Example\n", w->out);
  cag_doc_write_indented(w->out, row->example, 4);
}

void cag_doc_write_builtin(const CagDocWriter *w, size_t index) {
  size_t rows;
  const CagBuiltin *b = cag_builtin_rows(index, &rows);
  for (size_t i = 0; i < rows; i++) {
    if (i) fputc('\n', w->out);
    write_row(w, &b[i]);
  }
}

// --- Modules and scripts ---

static void write_param(const CagDocWriter *w, const CagDocEntry *e) {
  fprintf(w->out, w->styled ? "\033[1mparam %s\033[0m" : "param %s", e->name);
  fprintf(w->out, " = %s", e->fallback);
  if (e->range) fprintf(w->out, " in %s", e->range);
  fputc('\n', w->out);
  if (e->label) write_wrapped(w->out, e->label, strlen(e->label), 2, 0);
}

static void write_arguments(FILE *out, const CagDocModule *m, const CagDocEntry *e) {
  if (e->argument_count) fputs("\n  Parameters\n", out);
  for (size_t i = 0; i < e->argument_count; i++) {
    const CagDocArgument *a = &e->arguments[i];
    const CagDocParameter *known = cag_doc_module_parameter(m->name, e->name, a->name);
    if (a->meaning) write_parameter(out, a->meaning, "", a->name, a->fallback);
    else
      write_parameter(out, known ? known->type : "any value", known ? known->meaning : "", a->name,
                      a->fallback);
  }
}

// Tests whether the /// lines describe single parameters.
static bool tells_parameters(const CagDocEntry *e) {
  for (size_t i = 0; i < e->argument_count; i++)
    if (e->arguments[i].meaning) return true;
  return false;
}

static void write_definition(const CagDocWriter *w, const CagDocEntry *e) {
  if (e->kind == CAG_DOC_PARAM) write_param(w, e);
  else fprintf(w->out, w->styled ? "\033[1m%s\033[0m\n" : "%s\n", e->signature);
  if (e->text) write_prose(w->out, e->text, 2);
}

void cag_doc_write_entry(const CagDocWriter *w, const CagDocModule *m, const CagDocEntry *e) {
  fprintf(w->out, "In %s:\n\n", m->name);
  write_definition(w, e);
  write_arguments(w->out, m, e);
}

void cag_doc_write_module(const CagDocWriter *w, const CagDocModule *m) {
  heading(w, m->name);
  if (*m->purpose) fputc('\n', w->out);
  write_prose(w->out, m->purpose, 0);
  for (size_t i = 0; i < m->count; i++) {
    fputc('\n', w->out);
    write_definition(w, &m->entries[i]);
    if (tells_parameters(&m->entries[i])) write_arguments(w->out, m, &m->entries[i]);
  }
}

// --- The overview ---

static void write_family(const CagDocWriter *w, const char *family) {
  const size_t width = width_of(w->out);
  size_t column = 0;
  heading(w, family);
  const char *last = "";
  for (size_t i = 0; i < cag_builtin_count(); i++) {
    size_t rows;
    const CagBuiltin *b = cag_builtin_rows(i, &rows);
    const char *name = cag_builtin_name(i);
    if (strcmp(b->family, family) != 0 || strcmp(name, last) == 0) continue;
    last = name;
    const size_t n = strlen(name);
    if (column && column + 1 + n > width) {
      fputc('\n', w->out);
      column = 0;
    }
    column += (size_t)fprintf(w->out, column ? " %s" : "  %s", name);
  }
  fputs("\n", w->out);
}

void cag_doc_write_overview(const CagDocWriter *w) {
  const char **families = cag_calloc(cag_builtin_count() + 1, sizeof *families);
  if (!families) return;
  size_t count = 0;
  for (size_t i = 0; i < cag_builtin_count(); i++) {
    size_t rows, k = 0;
    const char *family = cag_builtin_rows(i, &rows)->family;
    while (k < count && strcmp(families[k], family) != 0) k++;
    if (k == count) families[count++] = family;
  }
  for (size_t k = 0; k < count; k++) write_family(w, families[k]);
  cag_free(families);
  heading(w, "Library");
  for (size_t i = 0; cag_doc_module_name(i); i++) fprintf(w->out, "  %s\n", cag_doc_module_name(i));
  const CagDocChapter *c;
  heading(w, "Manual");
  for (size_t i = 0; (c = cag_doc_chapter(i)); i++)
    fprintf(w->out, "  %-18s %s\n", c->name, c->title);
  fputs(
      "\n`cag doc NAME` shows a function, a module, a word of the language such as `if` or `|>`, a topic such as\n`gear`, a chapter, or an error code. `cag doc FILE.cag` shows the documentation of a script.\n`cag doc --html DIR` writes all documentation as a site.\n",
      w->out);
}
