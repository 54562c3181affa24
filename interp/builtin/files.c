// Data from files and text: CSV, JSON, and plain text.
//
// The machine decides which files a script may read, and reads them (cag_vm_open_file). Both
// parsers work on the bytes of the whole file, and report errors by line and column.

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <utf8proc.h>

#include "base/array.h"
#include "base/json_text.h"
#include "base/memory.h"
#include "interp/builtin/support.h"
#include "interp/vm/vm.h"

// --- Reading files ---

typedef struct Reader {
  CagCall *call;
  const char *path;
  char *bytes; // held; terminated by NUL
  const char *at, *end;
} Reader;

// Sets an error such as "read_csv: points.csv, line 3, column 7: ...".
static bool fail_at(Reader *r, const char *place, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
static bool fail_at(Reader *r, const char *place, const char *format, ...) {
  char message[300];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  size_t line = 1, column = 1;
  for (const char *s = r->bytes; s < place; s++) {
    if (*s == '\n') line++, column = 1;
    else if (((unsigned char)*s & 0xC0) != 0x80) column++;
  }
  return cag_fail_call(r->call, 0, CAG_ERR_parse_text,
                       "cannot read \"%s\": line %zu, column %zu: %s", r->path, line, column,
                       message);
}

static bool check_utf8(Reader *r) {
  const char *s = r->at;
  while (s < r->end) {
    utf8proc_int32_t c;
    utf8proc_ssize_t n = utf8proc_iterate((const utf8proc_uint8_t *)s, r->end - s, &c);
    if (n <= 0) return fail_at(r, s, "not UTF-8: the byte 0x%02x", (unsigned char)*s);
    if (c == 0) return fail_at(r, s, "a NUL character");
    s += n;
  }
  return true;
}

static bool reader_open(CagCall *call, const char *path, Reader *r) {
  *r = (Reader){.call = call, .path = path};
  size_t n;
  if (!cag_vm_open_file(call, 0, path, &r->bytes, &n)) return false;
  cag_hold(call, r->bytes);
  r->at = r->bytes;
  r->end = r->bytes + n;
  // Some programs write a byte order mark.
  static const char MARK[] = "\xEF\xBB\xBF";
  if (n >= strlen(MARK) && memcmp(r->at, MARK, strlen(MARK)) == 0) r->at += strlen(MARK);
  return check_utf8(r);
}

bool cag_files_read_text(CagCall *call, const struct cag_files_read_text *a, CagValue *result) {
  Reader r;
  if (!reader_open(call, a->path, &r)) return false;
  *result = cag_text_new(call->vm, r.at, (size_t)(r.end - r.at));
  return true;
}

// --- CSV (RFC 4180, any separator, any line ending) ---

typedef struct Csv {
  Reader r;
  char separator;
  CagString cell;
  CagValue *row; // cells of the row just read
  size_t count, capacity;
  bool numbers; // the row has a number
  const char *row_start;
} Csv;

// cell = '"' { any | '""' } '"' | { any but separator and line end }
static bool read_cell(Csv *c) {
  Reader *r = &c->r;
  c->cell.length = 0;
  if (r->at == r->end || *r->at != '"') {
    const char *from = r->at;
    while (r->at < r->end && *r->at != c->separator && *r->at != '\n' && *r->at != '\r') r->at++;
    cag_string_add(&c->cell, from, (size_t)(r->at - from));
    return true;
  }
  const char *open = r->at++;
  for (;;) {
    const char *quote = memchr(r->at, '"', (size_t)(r->end - r->at));
    if (!quote) return fail_at(r, open, "a quote that is never closed");
    bool doubled = quote + 1 < r->end && quote[1] == '"';
    cag_string_add(&c->cell, r->at, (size_t)(quote - r->at) + doubled);
    r->at = quote + 1 + doubled;
    if (!doubled) break;
  }
  if (r->at < r->end && *r->at != c->separator && *r->at != '\n' && *r->at != '\r')
    return fail_at(r, r->at, "there is text after the closing quote of a cell");
  return true;
}

static CagValue cell_value(Csv *c) {
  double x;
  cag_string_check(c->r.call->vm, &c->cell);
  if (c->cell.length == 0) return cag_none();
  if (!cag_read_number(c->cell.bytes, c->cell.length, &x))
    return cag_text_new(c->r.call->vm, c->cell.bytes, c->cell.length);
  c->numbers = true;
  return cag_number(x);
}

static void row_add(Csv *c, CagValue v) {
  if (!CAG_RESERVE(c->row, c->capacity, c->count + 1)) cag_vm_out_of_memory(c->r.call->vm);
  c->row[c->count++] = v;
}

static void skip_line_end(Reader *r) {
  if (r->at < r->end && *r->at == '\r') r->at++;
  if (r->at < r->end && *r->at == '\n') r->at++;
}

// Reads the next row that is not empty. *found is false at the end of the file.
static bool read_row(Csv *c, bool *found) {
  Reader *r = &c->r;
  while (r->at < r->end && (*r->at == '\n' || *r->at == '\r')) skip_line_end(r);
  c->count = 0;
  c->numbers = false;
  c->row_start = r->at;
  *found = r->at < r->end;
  if (!*found) return true;
  for (;;) {
    if (!read_cell(c)) return false;
    row_add(c, cell_value(c));
    if (r->at == r->end || *r->at != c->separator) break;
    r->at++;
  }
  skip_line_end(r);
  return true;
}

// Reads the names of the header. A column without a name is named by its position.
static bool read_names(Csv *c, CagText **names) {
  CagVm *vm = c->r.call->vm;
  for (size_t i = 0; i < c->count; i++) {
    CagString s = {0};
    if (c->row[i].type == CAG_NONE) cag_string_printf(&s, "column%zu", i + 1);
    else cag_print_value(vm, &s, c->row[i], false);
    names[i] = cag_intern_string(vm, &s);
    for (size_t j = 0; j < i; j++)
      if (names[j] == names[i])
        return fail_at(&c->r, c->row_start, "two columns are named \"%s\"", names[i]->bytes);
  }
  return true;
}

// Creates the record of a row. All rows share the layout of the first.
static bool row_record(Csv *c, CagText **names, size_t columns, CagRecord **first, CagValue *out) {
  CagVm *vm = c->r.call->vm;
  if (c->count > columns)
    return fail_at(&c->r, c->row_start, "%zu cells, but the header names %zu", c->count, columns);
  while (c->count < columns) row_add(c, cag_none());
  if (!*first) {
    *out = cag_record_from_texts(vm, names, c->row, columns);
    *first = CAG_AS_RECORD(*out);
    return true;
  }
  CagRecord *record = cag_alloc(vm, CAG_RECORD, sizeof *record + columns * sizeof(CagValue));
  record->layout = (*first)->layout;
  memcpy(record->fields, c->row, columns * sizeof(CagValue));
  *out = cag_object(CAG_RECORD, record);
  return true;
}

enum { ROWS_BETWEEN_CHECKS = 1 << 12 };

// Reads the rows: as records if the first row, which has been read, is a header, and as lists
// otherwise.
static bool read_rows(Csv *c, bool header, CagBuilder *built) {
  CagVm *vm = c->r.call->vm;
  const size_t columns = c->count;
  CagRecord *first = NULL;
  CagText **names = cag_hold_array(c->r.call, columns, sizeof(CagText *));
  bool found = true;
  if (header && (!read_names(c, names) || !read_row(c, &found))) return false;
  for (size_t n = 0; found; n++) {
    CagValue row;
    if (!header) row = cag_list_values(vm, c->row, c->count);
    else if (!row_record(c, names, columns, &first, &row)) return false;
    if (!cag_builder_add(vm, built, row)) return false;
    if (n % ROWS_BETWEEN_CHECKS == ROWS_BETWEEN_CHECKS - 1 && !cag_keep_going(vm)) return false;
    if (!read_row(c, &found)) return false;
  }
  return true;
}

static void free_csv(void *context) {
  Csv *c = context;
  cag_string_free(&c->cell);
  cag_free(c->row);
}

static bool is_separator(const char *s) {
  return s[0] && !s[1] && !strchr("\"\r\n", s[0]) && (unsigned char)s[0] < 0x80;
}

bool cag_files_read_csv(CagCall *call, const struct cag_files_read_csv *a, CagValue *result) {
  const char *separator = a->separator ? a->separator : ",";
  bool found;
  if (!is_separator(separator))
    return cag_fail_value(call, 1, "one character, such as \",\" \";\" \"\\t\"");
  Csv *c = cag_hold_array(call, 1, sizeof *c);
  cag_hold_for(call, free_csv, c);
  c->separator = *separator;
  if (!reader_open(call, a->path, &c->r) || !read_row(c, &found)) return false;
  CagBuilder *built = cag_builder_new(call->vm);
  const bool header = cag_given(call, 2) ? a->header : !c->numbers;
  if (found && !read_rows(c, header, built)) return false;
  *result = cag_builder_finish(call->vm, built);
  return true;
}

// --- Reading JSON ---

static void skip_blank(Reader *r) {
  while (r->at < r->end && cag_is_space(*r->at)) r->at++;
}

static bool next_is(Reader *r, char c) {
  skip_blank(r);
  if (r->at == r->end || *r->at != c) return false;
  r->at++;
  return true;
}

static bool read_hex(Reader *r, unsigned *out) {
  *out = 0;
  for (int i = 0; i < 4; i++, r->at++) {
    static const char DIGITS[] = "0123456789abcdef";
    char c = *r->at;
    if (c >= 'A' && c <= 'F') c += 'a' - 'A';
    const char *digit = c ? strchr(DIGITS, c) : NULL;
    if (!digit) return fail_at(r, r->at, "expected four hexadecimal digits");
    *out = *out * 16 + (unsigned)(digit - DIGITS);
  }
  return true;
}

// Reads \uXXXX, or two of them for a character beyond U+FFFF. The `\u` has been read already.
static bool read_unicode(Reader *r, CagString *s) {
  const char *place = r->at;
  unsigned high, low;
  if (!read_hex(r, &high)) return false;
  if (high >= 0xD800 && high < 0xE000) {
    bool pair = high < 0xDC00 && r->at[0] == '\\' && r->at[1] == 'u';
    if (pair) r->at += 2;
    if (!pair || !read_hex(r, &low) || low < 0xDC00 || low > 0xDFFF)
      return fail_at(r, place, "an incomplete surrogate pair");
    high = 0x10000 + ((high - 0xD800) << 10) + (low - 0xDC00);
  }
  if (high == 0) return fail_at(r, place, "a NUL character");
  utf8proc_uint8_t bytes[4];
  utf8proc_ssize_t n = utf8proc_encode_char((utf8proc_int32_t)high, bytes);
  cag_string_add(s, (const char *)bytes, (size_t)n);
  return true;
}

// The opening quote has been read.
static bool read_json_text(Reader *r, CagString *s) {
  static const char LETTERS[] = "\"\\/bfnrt", MEANT[] = "\"\\/\b\f\n\r\t";
  const char *open = r->at - 1;
  for (;;) {
    if (r->at == r->end || *r->at == '\n') return fail_at(r, open, "a text that is never closed");
    char c = *r->at++;
    if (c == '"') return true;
    if ((unsigned char)c < ' ')
      return fail_at(r, r->at - 1, "a control character in a text: write \\u%04x", (unsigned)c);
    if (c != '\\') {
      cag_string_add(s, &c, 1);
      continue;
    }
    char letter = r->at < r->end ? *r->at++ : 0;
    const char *found = letter ? strchr(LETTERS, letter) : NULL;
    if (found) cag_string_add(s, &MEANT[found - LETTERS], 1);
    else if (letter != 'u') return fail_at(r, r->at - 1, "an unknown escape");
    else if (!read_unicode(r, s)) return false;
  }
}

static bool read_json_value(Reader *r, int depth, CagValue *out);

// "[" [ value { "," value } ] "]"
static bool read_json_list(Reader *r, int depth, CagValue *out) {
  CagVm *vm = r->call->vm;
  CagBuilder *built = cag_builder_new(vm);
  if (!next_is(r, ']')) {
    do {
      CagValue v;
      if (!read_json_value(r, depth, &v) || !cag_builder_add(vm, built, v)) return false;
    } while (next_is(r, ','));
    if (!next_is(r, ']')) return fail_at(r, r->at, "expected `,` or `]`");
  }
  *out = cag_builder_finish(vm, built);
  return true;
}

typedef struct Field {
  CagText *name; // interned: equal names are one text
  CagValue value;
  size_t place;
} Field;

typedef struct Fields { // held
  Field *fields;
  size_t count, capacity;
} Fields;

static void add_field(Reader *r, Fields *f, CagText *name, CagValue value) {
  if (!CAG_RESERVE(f->fields, f->capacity, f->count + 1)) cag_vm_out_of_memory(r->call->vm);
  f->fields[f->count] = (Field){name, value, f->count};
  f->count++;
}

static int by_name(const void *a, const void *b) {
  const Field *f = a, *g = b;
  if (f->name != g->name) return f->name < g->name ? -1 : 1;
  return (f->place > g->place) - (f->place < g->place);
}

static int by_position(const void *a, const void *b) {
  const Field *f = a, *g = b;
  return (f->place > g->place) - (f->place < g->place);
}

// If a name occurs more than once, the last value is kept at the position of the first, as in most
// JSON readers.
static void join_fields(Fields *f) {
  if (f->count < 2) return;
  qsort(f->fields, f->count, sizeof *f->fields, by_name);
  size_t kept = 0;
  for (size_t i = 1; i < f->count; i++) {
    if (f->fields[i].name == f->fields[kept].name) f->fields[kept].value = f->fields[i].value;
    else f->fields[++kept] = f->fields[i];
  }
  f->count = kept + 1;
  qsort(f->fields, f->count, sizeof *f->fields, by_position);
}

static CagValue fields_value(Reader *r, Fields *f) {
  join_fields(f);
  CagText **names = cag_hold_array(r->call, f->count, sizeof(CagText *));
  CagValue *values = cag_hold_array(r->call, f->count, sizeof *values);
  for (size_t i = 0; i < f->count; i++) {
    names[i] = f->fields[i].name;
    values[i] = f->fields[i].value;
  }
  CagValue record = cag_record_from_texts(r->call->vm, names, values, f->count);
  cag_release_held(r->call, values);
  cag_release_held(r->call, names);
  return record;
}

static void free_fields(void *what) {
  Fields *f = what;
  cag_free(f->fields);
  cag_free(f);
}

static Fields *fields_new(CagCall *call) {
  Fields *f = cag_hold_array(call, 1, sizeof *f);
  cag_hold_for(call, free_fields, cag_give_held(call, f));
  return f;
}

// text ":" value
static bool read_field(Reader *r, int depth, Fields *f) {
  CagValue value;
  CagString s = {0};
  if (!next_is(r, '"')) return fail_at(r, r->at, "expected a name in quotes");
  if (!read_json_text(r, &s)) {
    cag_string_free(&s);
    return false;
  }
  CagText *name = cag_intern_string(r->call->vm, &s);
  if (!next_is(r, ':')) return fail_at(r, r->at, "expected `:`");
  if (!read_json_value(r, depth, &value)) return false;
  add_field(r, f, name, value);
  return true;
}

// "{" [ field { "," field } ] "}"
static bool read_json_record(Reader *r, int depth, CagValue *out) {
  Fields *f = fields_new(r->call);
  if (!next_is(r, '}')) {
    do
      if (!read_field(r, depth, f)) return false;
    while (next_is(r, ','));
    if (!next_is(r, '}')) return fail_at(r, r->at, "expected `,` or `}`");
  }
  *out = fields_value(r, f);
  cag_release_held(r->call, f);
  return true;
}

static bool read_json_number(Reader *r, CagValue *out) {
  const char *from = r->at;
  double x;
  while (r->at < r->end && *r->at && strchr("+-.eE0123456789", *r->at)) r->at++;
  if (r->at == from) return fail_at(r, from, "expected a value");
  if (!cag_read_number(from, (size_t)(r->at - from), &x))
    return fail_at(r, from, "the number is too large");
  *out = cag_number(x);
  return true;
}

static bool read_word(Reader *r, const char *word) {
  size_t n = strlen(word);
  if ((size_t)(r->end - r->at) < n || memcmp(r->at, word, n) != 0) return false;
  r->at += n;
  return true;
}

static bool read_json_value(Reader *r, int depth, CagValue *out) {
  skip_blank(r);
  if (r->at == r->end) return fail_at(r, r->at, "the file ends where a value was expected");
  if (depth == CAG_DEPTH_MOST)
    return fail_at(r, r->at, "brackets nest deeper than %d", CAG_DEPTH_MOST);
  if (next_is(r, '[')) return read_json_list(r, depth + 1, out);
  if (next_is(r, '{')) return read_json_record(r, depth + 1, out);
  if (next_is(r, '"')) {
    CagString s = {0};
    bool good = read_json_text(r, &s);
    if (good) *out = cag_text_from_string(r->call->vm, &s);
    else cag_string_free(&s);
    return good;
  }
  if (read_word(r, "true")) return *out = cag_bool(true), true;
  if (read_word(r, "false")) return *out = cag_bool(false), true;
  if (read_word(r, "null")) return *out = cag_none(), true;
  return read_json_number(r, out);
}

bool cag_files_read_json(CagCall *call, const struct cag_files_read_json *a, CagValue *result) {
  Reader r;
  if (!reader_open(call, a->path, &r) || !read_json_value(&r, 0, result)) return false;
  skip_blank(&r);
  return r.at == r.end || fail_at(&r, r.at, "unexpected text after the value");
}

// --- Writing CSV ---

static void write_cell_text(CagString *s, const char *bytes, size_t n, char separator) {
  bool quoted = n > 0 && (cag_is_space(bytes[0]) || cag_is_space(bytes[n - 1]));
  for (size_t i = 0; i < n && !quoted; i++)
    quoted = bytes[i] == separator || bytes[i] == '"' || bytes[i] == '\n' || bytes[i] == '\r';
  if (quoted) cag_string_add(s, "\"", 1);
  for (size_t i = 0; i < n; i++)
    cag_string_add(s, bytes[i] == '"' ? "\"\"" : bytes + i, bytes[i] == '"' ? 2 : 1);
  if (quoted) cag_string_add(s, "\"", 1);
}

static void write_cell(CagCall *call, CagString *s, CagValue v, char separator) {
  if (v.type == CAG_NONE) return;
  if (v.type == CAG_NUMBER || v.type == CAG_ANGLE) {
    cag_print_number(s, v.as.number);
    return;
  }
  if (v.type == CAG_TEXT) {
    write_cell_text(s, CAG_AS_TEXT(v)->bytes, CAG_AS_TEXT(v)->length, separator);
    return;
  }
  CagString *printed = cag_held_string(call);
  cag_print_value(call->vm, printed, v, false);
  cag_string_check(call->vm, printed);
  write_cell_text(s, printed->bytes ? printed->bytes : "", printed->length, separator);
  cag_release_held(call, printed);
}

static bool write_row(CagCall *call, CagString *s, const CagList *rows, size_t i, char separator,
                      const CagLayout *header) {
  const CagValue row = cag_list_get(call->vm, rows, i);
  if (row.type != (header ? CAG_RECORD : CAG_LIST))
    return cag_fail_element(call, 0, i, row, header ? "a record" : "a list");
  if (!header) {
    for (size_t k = 0; k < CAG_AS_LIST(row)->length; k++) {
      if (k > 0) cag_string_add(s, &separator, 1);
      write_cell(call, s, cag_list_get(call->vm, CAG_AS_LIST(row), k), separator);
    }
    return true;
  }
  const CagRecord *r = CAG_AS_RECORD(row);
  for (size_t k = 0; k < header->count; k++) {
    const size_t at = cag_layout_find(r->layout, header->names[k]);
    if (at == (size_t)-1 || r->layout->count != header->count) {
      cag_fail_call(
          call, 0, CAG_ERR_field,
          "expects records with the same fields as `rows`, but those of the record at [%zu] differ from those at [0]",
          i);
      return cag_fail_help(call->vm, "an empty cell is a field with the value none");
    }
    if (k > 0) cag_string_add(s, &separator, 1);
    write_cell(call, s, r->fields[at], separator);
  }
  return true;
}

bool cag_files_csv(CagCall *call, const struct cag_files_csv *a, CagValue *result) {
  const char *given = a->separator ? a->separator : ",", separator = *given;
  if (!is_separator(given))
    return cag_fail_value(call, 1, "one character, such as \",\" \";\" \"\\t\"");
  CagString *s = cag_held_string(call);
  const CagList *rows = a->rows;
  const CagValue first = rows->length ? cag_list_get(call->vm, rows, 0) : cag_none();
  const CagLayout *header = first.type == CAG_RECORD ? CAG_AS_RECORD(first)->layout : NULL;
  for (size_t k = 0; header && k < header->count; k++) {
    if (k > 0) cag_string_add(s, &separator, 1);
    write_cell_text(s, header->names[k]->bytes, header->names[k]->length, separator);
  }
  for (size_t i = 0; i < rows->length; i++) {
    if (i % ROWS_BETWEEN_CHECKS == 0 && !cag_keep_going(call->vm)) return false;
    if (i > 0 || header) cag_string_add(s, "\n", 1);
    if (!cag_string_fits(call->vm, s) || !write_row(call, s, rows, i, separator, header))
      return false;
  }
  *result = cag_text_from_string(call->vm, s);
  return true;
}

// --- Writing JSON ---

static bool write_json(CagCall *call, CagString *s, CagValue v, int depth);

static void write_json_text(CagString *s, const char *bytes, size_t n) {
  cag_string_add(s, "\"", 1);
  for (size_t i = 0; i < n; i++) {
    char escape[8];
    const char *escaped = cag_json_escape(bytes[i], escape);
    if (escaped) cag_string_add(s, escaped, strlen(escaped));
    else cag_string_add(s, bytes + i, 1);
  }
  cag_string_add(s, "\"", 1);
}

static bool write_json_number(CagCall *call, CagString *s, double x) {
  if (!isfinite(x))
    return cag_fail_call(call, 0, CAG_ERR_value,
                         "expects finite numbers, because JSON has no infinity");
  cag_print_number(s, x);
  return true;
}

static bool write_json_list(CagCall *call, CagString *s, const CagList *list, int depth) {
  cag_string_add(s, "[", 1);
  for (size_t i = 0; i < list->length; i++) {
    if (i > 0) cag_string_add(s, ", ", 2);
    if (!write_json(call, s, cag_list_get(call->vm, list, i), depth)) return false;
  }
  cag_string_add(s, "]", 1);
  return true;
}

static bool write_json_record(CagCall *call, CagString *s, const CagRecord *r, int depth) {
  cag_string_add(s, "{", 1);
  for (size_t i = 0; i < r->layout->count; i++) {
    if (i > 0) cag_string_add(s, ", ", 2);
    write_json_text(s, r->layout->names[i]->bytes, r->layout->names[i]->length);
    cag_string_add(s, ": ", 2);
    if (!write_json(call, s, r->fields[i], depth)) return false;
  }
  cag_string_add(s, "}", 1);
  return true;
}

static bool write_json_transform(CagCall *call, CagString *s, const CagTransform *t) {
  for (int i = 0; i < 4; i++) {
    cag_string_add(s, i == 0 ? "[[" : "], [", i == 0 ? 2 : 4);
    for (int j = 0; j < 4; j++) {
      if (j > 0) cag_string_add(s, ", ", 2);
      if (!write_json_number(call, s, t->m[i][j])) return false;
    }
  }
  cag_string_add(s, "]]", 2);
  return true;
}

static bool write_json(CagCall *call, CagString *s, CagValue v, int depth) {
  if (!cag_may_nest(call, depth) || !cag_string_fits(call->vm, s)) return false;
  switch (v.type) {
  case CAG_NONE: cag_string_add(s, "null", strlen("null")); return true;
  case CAG_BOOL: cag_string_printf(s, "%s", v.as.boolean ? "true" : "false"); return true;
  case CAG_NUMBER:
  case CAG_ANGLE: return write_json_number(call, s, v.as.number);
  case CAG_TEXT: write_json_text(s, CAG_AS_TEXT(v)->bytes, CAG_AS_TEXT(v)->length); return true;
  case CAG_RANGE:
    if (!cag_as_list(call->vm, v, &v)) return false;
    return write_json_list(call, s, CAG_AS_LIST(v), depth + 1);
  case CAG_LIST: return write_json_list(call, s, CAG_AS_LIST(v), depth + 1);
  case CAG_RECORD: return write_json_record(call, s, CAG_AS_RECORD(v), depth + 1);
  case CAG_TRANSFORM: return write_json_transform(call, s, &CAG_AS_TRANSFORM(v)->t);
  default: {
    char found[120];
    return cag_fail_call(
        call, 0, CAG_ERR_type,
        "expects numbers, angles, texts, bools, none, lists, records, or transforms, found %s",
        cag_value_words(call->vm, v, found, sizeof found));
  }
  }
}

bool cag_files_json(CagCall *call, CagValue *result) {
  CagString *s = cag_held_string(call);
  if (!write_json(call, s, call->values[0], 0)) return false;
  *result = cag_text_from_string(call->vm, s);
  return true;
}
