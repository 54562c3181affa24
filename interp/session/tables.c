// The program's tables for clients: built-ins with their documentation, and kinds of errors.

#include <stdlib.h>
#include <string.h>

#include "interp/doc/doc.h"
#include "interp/session/session.h"
#include "interp/vm/stdlib.h"

const char *cag_library_module(size_t i) {
  for (size_t k = 0; k < i; k++)
    if (!cag_stdlib[k].module) return NULL;
  return cag_stdlib[i].module;
}

const char *cag_library_text(const char *module, size_t *length) {
  for (const CagStdlibFile *f = cag_stdlib; f->module; f++) {
    if (strcmp(f->module, module) != 0) continue;
    *length = f->length;
    return f->text;
  }
  return NULL;
}

bool cag_cookbook(size_t i, const char **name, const char **text) {
  static const char FOLDER[] = "docs/cookbook/";
  const size_t n = sizeof FOLDER - 1;
  for (const CagDocument *d = cag_documents; d->path; d++) {
    if (strncmp(d->path, FOLDER, n) != 0 || i-- > 0) continue;
    *name = d->path + n;
    *text = d->text;
    return true;
  }
  return false;
}

const char *const *cag_builtin_name_list(void) { return cag_builtin_names(); }

// The width of wrapped text; each line is preceded by `indent`.
#define WIDTH 88

static void write_wrapped(FILE *out, const char *text, const char *indent) {
  size_t column = 0;
  while (*text) {
    size_t n = strcspn(text, " \n");
    if (column && column + 1 + n > WIDTH) {
      fputc('\n', out);
      column = 0;
    }
    if (column == 0) fputs(indent, out);
    else fputc(' ', out);
    fwrite(text, 1, n, out);
    column += n + 1;
    text += n;
    if (*text == '\n') {
      fputc('\n', out);
      column = 0;
    }
    if (*text) text++;
  }
  if (column) fputc('\n', out);
}

static void write_indented(FILE *out, const char *text, const char *indent) {
  while (*text) {
    size_t n = strcspn(text, "\n");
    fprintf(out, "%s%.*s\n", indent, (int)n, text);
    text += n + (text[n] == '\n');
  }
}

bool cag_write_builtin_doc(const char *name, FILE *out) {
  size_t index = cag_builtin_find(name), rows;
  if (index == (size_t)-1) return false;
  const CagBuiltin *b = cag_builtin_rows(index, &rows);
  for (size_t i = 0; i < rows; i++) {
    if (i) fputc('\n', out);
    fprintf(out, "%s", b[i].signature);
    if (b[i].result) fprintf(out, " -> %s", b[i].result);
    fputc('\n', out);
    if (b[i].summary) write_wrapped(out, b[i].summary, "  ");
    if (b[i].example) {
      fputs("\n", out);
      write_indented(out, b[i].example, "    ");
    }
  }
  return true;
}

bool cag_builtin_row(size_t i, const char **signature, const char **summary, const char **example,
                     const char **family) {
  for (size_t index = 0; index < cag_builtin_count(); index++) {
    size_t rows;
    const CagBuiltin *b = cag_builtin_rows(index, &rows);
    if (i < rows) {
      if (signature) *signature = b[i].signature;
      if (summary) *summary = b[i].summary;
      if (example) *example = b[i].example;
      if (family) *family = b[i].family;
      return true;
    }
    i -= rows;
  }
  const char **const outs[] = {signature, summary, example, family};
  for (size_t k = 0; k < sizeof outs / sizeof *outs; k++)
    if (outs[k]) *outs[k] = NULL;
  return false;
}

bool cag_explain(const char *code, FILE *out) {
  CagErrorId id = cag_error_by_code(code);
  if (id == CAG_ERR_COUNT) id = cag_error_by_reason(code);
  if (id == CAG_ERR_COUNT) return false;
  const CagErrorInfo *e = cag_error_info(id);
  fprintf(out, "%s (%s): %s\n\n", e->code, e->reason, e->title);
  write_wrapped(out, e->explanation, "");
  if (!e->example) return true;
  fputs("\nFor example:\n\n", out);
  write_indented(out, e->example, "    ");
  return true;
}

bool cag_error_kind(size_t i, const char **code, const char **reason, const char **title,
                    const char **example) {
  static const CagErrorInfo none = {0};
  const CagErrorInfo *e = i < CAG_ERR_COUNT ? cag_error_info((CagErrorId)i) : &none;
  if (code) *code = e->code;
  if (reason) *reason = e->reason;
  if (title) *title = e->title;
  if (example) *example = e->example;
  return e != &none;
}
