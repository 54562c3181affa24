// Diagnostics as text for people, and as JSON for editors.
//
// A source line is shown as a list of cells, one for each character, with the text that represents
// it (a tab becomes blanks, a control character a replacement mark) and its width on a terminal.
// The line and its underline use the same widths, so the carets are aligned. Of a line that is too
// long, only a window around the span is shown and processed.

#include "base/diagnostic.h"
#include "base/json_text.h"
#include "base/utf8.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <utf8proc.h>

#define WINDOW 100 // maximum number of columns of a source line that are shown
#define LEAD 40    // columns before the span that are kept if a line is cut
#define TAB 4      // columns from one tab stop to the next
#define REPLACEMENT "\xef\xbf\xbd"

typedef struct Colors {
  const char *error, *warning, *note, *bold, *gutter, *caret, *reset;
} Colors;
static const Colors plain = {"", "", "", "", "", "", ""};
static const Colors ansi = {"\033[1;31m", "\033[1;33m", "\033[1;36m", "\033[1m",
                            "\033[34m",   "\033[1;31m", "\033[0m"};

static const char *severity_name(CagSeverity s) {
  static const char *const names[] = {"error", "warning", "note"};
  return names[s];
}

// ---- text ----

// One character of a source line: its bytes, its width in columns, and the text that represents it.
typedef struct Cell {
  size_t bytes;
  int width;
  const char *shown; // NULL: the bytes themselves
} Cell;

static Cell cell_at(const char *p, size_t left, size_t column) {
  unsigned char c = (unsigned char)*p;
  if (c == '\t') return (Cell){1, (int)(TAB - column % TAB), "    "};
  if (c >= 32 && c < 127) return (Cell){1, 1, NULL};
  if (c < 128) return (Cell){1, 1, REPLACEMENT};
  utf8proc_int32_t point;
  utf8proc_ssize_t n =
      utf8proc_iterate((const utf8proc_uint8_t *)p, (utf8proc_ssize_t)left, &point);
  if (n <= 0) return (Cell){1, 1, REPLACEMENT};
  utf8proc_category_t k = utf8proc_category(point);
  if (k == UTF8PROC_CATEGORY_CC || k == UTF8PROC_CATEGORY_ZL || k == UTF8PROC_CATEGORY_ZP)
    return (Cell){(size_t)n, 1, REPLACEMENT};
  return (Cell){(size_t)n, utf8proc_charwidth(point), NULL};
}

static size_t step_back(const char *line, size_t i) { return cag_utf8_start(line, i - 1); }

// The part of the line [from, to) that is shown, as byte offsets.
typedef struct Window {
  size_t from, to;
} Window;

// Returns the whole line if it is short, or else LEAD columns before the span and what fits after
// them. The LEAD columns are counted in characters, which are at most two columns wide.
static Window choose_window(const char *line, size_t length, size_t start) {
  size_t columns = 0, i = 0;
  while (i < length && columns <= WINDOW) {
    Cell c = cell_at(line + i, length - i, columns);
    i += c.bytes;
    columns += (size_t)c.width;
  }
  if (columns <= WINDOW) return (Window){0, length};
  Window w = {start, start};
  for (size_t n = 0; n < LEAD && w.from > 0; n++) w.from = step_back(line, w.from);
  for (columns = 0, w.to = w.from; w.to < length;) {
    Cell c = cell_at(line + w.to, length - w.to, columns);
    columns += (size_t)c.width;
    if (columns > WINDOW) break;
    w.to += c.bytes;
  }
  return w;
}

static void draw_line(FILE *out, const char *line, Window w, size_t length) {
  if (w.from > 0) fputs("...", out);
  size_t column = 0;
  for (size_t i = w.from; i < w.to;) {
    Cell c = cell_at(line + i, length - i, column);
    if (line[i] == '\t') fprintf(out, "%*s", c.width, "");
    else if (c.shown) fputs(c.shown, out);
    else fwrite(line + i, 1, c.bytes, out);
    i += c.bytes;
    column += (size_t)c.width;
  }
  if (w.to < length) fputs("...", out);
  fputc('\n', out);
}

// Draws blanks below the text before the span, then at least one caret below the span.
static void draw_carets(FILE *out, const char *line, Window w, size_t start, size_t end) {
  size_t column = 0, blanks = 0, carets = 0;
  for (size_t i = w.from; i < w.to && i < end;) {
    Cell c = cell_at(line + i, w.to - i, column);
    if (i < start) blanks += (size_t)c.width;
    else carets += (size_t)c.width;
    column += (size_t)c.width;
    i += c.bytes;
  }
  if (carets == 0) carets = 1;
  if (w.from > 0) blanks += 3;
  for (size_t i = 0; i < blanks; i++) fputc(' ', out);
  for (size_t i = 0; i < carets; i++) fputc('^', out);
}

static int digits_of(size_t n) {
  int digits = 1;
  while (n >= 10) n /= 10, digits++;
  return digits;
}

// Shows the location of a diagnostic. Returns the width of the gutter, with which notes are
// aligned.
static int draw_place(FILE *out, const CagDiagnostic *d, const Colors *k) {
  CagPosition p = cag_source_position(d->source, d->span.start);
  int gutter = digits_of(p.line);
  size_t length, first = d->source->lines[p.line - 1];
  const char *line = cag_source_line(d->source, p.line, &length);
  size_t start = d->span.start > first ? d->span.start - first : 0;
  size_t end = d->span.end > first ? d->span.end - first : 0;
  if (start > length) start = length;
  if (end > length) end = length;
  if (end < start) end = start;

  fprintf(out, "%*s%s-->%s %s:%zu:%zu\n", gutter, "", k->gutter, k->reset, d->source->name, p.line,
          p.column);
  fprintf(out, "%*s %s|%s\n", gutter, "", k->gutter, k->reset);
  Window w = choose_window(line, length, start);
  fprintf(out, "%s%*zu |%s%s", k->gutter, gutter, p.line, k->reset, w.to > w.from ? " " : "");
  draw_line(out, line, w, length);
  fprintf(out, "%*s %s|%s ", gutter, "", k->gutter, k->reset);
  fputs(k->caret, out);
  draw_carets(out, line, w, start, end);
  if (d->help) fprintf(out, " %s", d->help);
  fprintf(out, "%s\n", k->reset);
  return gutter;
}

static void draw_note(FILE *out, const CagNote *n, int gutter, const Colors *k) {
  const char *text = n->text ? n->text : "";
  fprintf(out, "%*s %s=%s ", gutter, "", k->gutter, k->reset);
  char place[64] = "";
  if (n->source) {
    CagPosition p = cag_source_position(n->source, n->span.start);
    snprintf(place, sizeof place, ":%zu:%zu", p.line, p.column);
  }
  const char *name = n->source ? n->source->name : "";
  switch (n->kind) {
  case CAG_NOTE_CALL:
  case CAG_NOTE_TAIL_CALL:
    fprintf(out, "called from %s%s", n->source ? name : "outside", place);
    if (*text) fprintf(out, " in %s", text);
    if (n->kind == CAG_NOTE_TAIL_CALL) fputs(" (tail call)", out);
    break;
  case CAG_NOTE_OMITTED: fprintf(out, "... %s ...", text); break;
  case CAG_NOTE_RELATED:
    fputs(text, out);
    if (n->source) fprintf(out, "%s%s%s", *text ? ": " : "", name, place);
    break;
  }
  fputc('\n', out);
}

static void render_text(const CagDiagnostic *d, const Colors *k, FILE *out) {
  const char *severity_color = d->severity == CAG_SEVERITY_ERROR     ? k->error
                               : d->severity == CAG_SEVERITY_WARNING ? k->warning
                                                                     : k->note;
  fprintf(out, "%s%s%s%s: %s%s\n", severity_color, severity_name(d->severity), k->reset, k->bold,
          d->message ? d->message : "", k->reset);
  int gutter = 1;
  if (d->source && d->source->line_count) gutter = draw_place(out, d, k);
  else if (d->help) fprintf(out, "  %s=%s %s\n", k->gutter, k->reset, d->help);
  for (size_t i = 0; i < d->note_count; i++) draw_note(out, &d->notes[i], gutter, k);
}

// ---- JSON ----

static void json_text(FILE *out, const char *text) {
  fputc('"', out);
  size_t length = strlen(text);
  for (size_t i = 0; i < length;) {
    utf8proc_int32_t point;
    utf8proc_ssize_t n = utf8proc_iterate((const utf8proc_uint8_t *)text + i,
                                          (utf8proc_ssize_t)(length - i), &point);
    if (n <= 0) {
      fputs("\\ufffd", out);
      i++;
      continue;
    }
    char escape[8];
    // DEL is valid in JSON, but terminals interpret it.
    const char *escaped = text[i] == 127 ? "\\u007f" : cag_json_escape(text[i], escape);
    if (escaped) fputs(escaped, out);
    else fwrite(text + i, 1, (size_t)n, out);
    i += (size_t)n;
  }
  fputc('"', out);
}

static void json_key_text(FILE *out, const char *key, const char *text) {
  fprintf(out, ",\"%s\":", key);
  if (text) json_text(out, text);
  else fputs("null", out);
}

static void json_place(FILE *out, const CagSource *source, CagSpan span, bool with_end) {
  if (!source) {
    fputs(",\"file\":null,\"line\":null,\"column\":null", out);
    if (with_end) fputs(",\"end_line\":null,\"end_column\":null", out);
    return;
  }
  json_key_text(out, "file", source->name);
  CagPosition p = cag_source_position(source, span.start);
  fprintf(out, ",\"line\":%zu,\"column\":%zu", p.line, p.column);
  if (!with_end) return;
  p = cag_source_position(source, span.end);
  fprintf(out, ",\"end_line\":%zu,\"end_column\":%zu", p.line, p.column);
}

static void json_note(FILE *out, const CagNote *n) {
  const char *text = n->text ? n->text : "";
  char message[512];
  if (n->kind == CAG_NOTE_CALL || n->kind == CAG_NOTE_TAIL_CALL)
    snprintf(message, sizeof message, "called from here%s%s%s", *text ? " in " : "", text,
             n->kind == CAG_NOTE_TAIL_CALL ? " (tail call)" : "");
  else snprintf(message, sizeof message, "%s", text);
  fputs("{\"message\":", out);
  json_text(out, message);
  json_place(out, n->source, n->span, false);
  fputc('}', out);
}

static void render_json(const CagDiagnostic *d, FILE *out) {
  const CagErrorInfo *info = cag_error_info(d->id);
  fprintf(out, "{\"severity\":\"%s\",\"code\":\"%s\"", severity_name(d->severity), info->code);
  json_key_text(out, "reason", info->reason);
  json_key_text(out, "message", d->message ? d->message : "");
  json_place(out, d->source, d->span, true);
  json_key_text(out, "help", d->help);
  fputs(",\"related\":[", out);
  for (size_t i = 0; i < d->note_count; i++) {
    if (i) fputc(',', out);
    json_note(out, &d->notes[i]);
  }
  fputs("]}\n", out);
}

void cag_diagnostic_render(const CagDiagnostic *d, CagDiagnosticStyle style, FILE *out) {
  if (style == CAG_DIAGNOSTIC_JSON) render_json(d, out);
  else render_text(d, style == CAG_DIAGNOSTIC_COLOR ? &ansi : &plain, out);
}

void cag_diagnostics_render(const CagDiagnostics *d, CagDiagnosticStyle style, FILE *out) {
  for (size_t i = 0; i < d->count; i++) {
    if (i && style != CAG_DIAGNOSTIC_JSON) fputc('\n', out);
    cag_diagnostic_render(cag_diagnostics_at(d, i), style, out);
  }
  if (d->dropped && style != CAG_DIAGNOSTIC_JSON)
    fprintf(out, "\n%zu more not shown\n", d->dropped);
}
