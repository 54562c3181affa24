// Parser of job files.
//
// CSV is as in RFC 4180: quoted fields may contain separators, newlines, and doubled quotes. The
// separator is a comma, or a semicolon or tab if the header line contains one of these and no
// comma, as spreadsheets write in many countries. Empty lines are skipped.

#include "cli/jobs.h"

#include <cJSON.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <utf8proc.h>

#include "base/array.h"
#include "base/diagnostic.h"

const char *const cag_job_column_names[CAG_JOB_COLUMN_COUNT] = {
#define CAG_JOB_COLUMN(name) #name,
    CAG_JOB_COLUMNS(CAG_JOB_COLUMN)
#undef CAG_JOB_COLUMN
};

#define CODE_FILE "E0910"
#define CODE_COLUMN "E0911"

// --- The list ---

bool cag_jobs_problem(CagJobs *jobs, const CagJob *row, const char *code, const char *help,
                      const char *format, ...) {
  if (!CAG_RESERVE(jobs->problems, jobs->problem_capacity, jobs->problem_count + 1)) return false;
  CagJobProblem p = {.row = row ? row->number : 0, .line = row ? row->line : 0, .code = code};
  va_list args;
  va_start(args, format);
  const int n = vasprintf(&p.message, format, args);
  va_end(args);
  if (n < 0) return false;
  p.help = help && *help ? strdup(help) : NULL;
  jobs->problems[jobs->problem_count++] = p;
  return true;
}

static CagJob *add_row(CagJobs *jobs, size_t line) {
  if (!CAG_RESERVE(jobs->rows, jobs->capacity, jobs->count + 1)) return NULL;
  CagJob *row = &jobs->rows[jobs->count++];
  *row = (CagJob){.number = jobs->count, .line = line};
  return row;
}

// Returns the text without surrounding blanks, allocated with malloc, or NULL if memory ran out.
static char *trimmed(const char *text) {
  text += strspn(text, " \t\r\n");
  size_t length = strlen(text);
  while (length && strchr(" \t\r\n", text[length - 1])) length--;
  return strndup(text, length);
}

// Sets a field of the row by the column's name. Blanks count as empty. Returns false if memory ran
// out.
static bool set_field(CagJob *row, const char *column, const char *text) {
  if (!text[strspn(text, " \t\r\n")]) return true;
  char *value = trimmed(text);
  if (!value) return false;
  for (size_t i = 0; i < CAG_JOB_COLUMN_COUNT; i++) {
    if (strcmp(column, cag_job_column_names[i]) != 0) continue;
    free(row->cells[i]);
    row->cells[i] = value;
    return true;
  }
  CagJobParam *params = realloc(row->params, (row->param_count + 1) * sizeof *params);
  char *name = strdup(column);
  if (params) row->params = params;
  if (!params || !name) {
    free(name);
    free(value);
    return false;
  }
  row->params[row->param_count++] = (CagJobParam){name, value};
  return true;
}

static int by_name(const void *a, const void *b) {
  return strcmp(((const CagJobParam *)a)->name, ((const CagJobParam *)b)->name);
}

void cag_jobs_free(CagJobs *jobs) {
  for (size_t i = 0; i < jobs->count; i++) {
    CagJob *row = &jobs->rows[i];
    for (size_t c = 0; c < CAG_JOB_COLUMN_COUNT; c++) free(row->cells[c]);
    for (size_t p = 0; p < row->param_count; p++) {
      free(row->params[p].name);
      free(row->params[p].value);
    }
    free(row->params);
  }
  for (size_t i = 0; i < jobs->problem_count; i++) {
    free(jobs->problems[i].message);
    free(jobs->problems[i].help);
  }
  free(jobs->rows);
  free(jobs->problems);
  *jobs = (CagJobs){0};
}

// --- The columns ---

// Checks the names of the columns: script and output are required, and duplicates are not allowed.
static bool check_columns(CagJobs *jobs, char *const *names, size_t count) {
  static const CagJobColumn NEEDED[] = {CAG_JOB_script, CAG_JOB_output};
  bool ok = true;
  for (size_t i = 0; ok && i < count; i++)
    for (size_t k = 0; ok && k < i; k++)
      if (strcmp(names[i], names[k]) == 0 && *names[i])
        ok = cag_jobs_problem(jobs, NULL, CODE_COLUMN, "remove one of them",
                              "duplicate column '%s'", names[i]);
  for (size_t n = 0; ok && n < sizeof NEEDED / sizeof *NEEDED; n++) {
    const char *wanted = cag_job_column_names[NEEDED[n]];
    char help[200];
    bool found = false;
    for (size_t i = 0; i < count; i++) found |= strcmp(names[i], wanted) == 0;
    if (found) continue;
    const char *nearest = cag_nearest_name(wanted, (const char *const *)names, count);
    if (nearest) snprintf(help, sizeof help, "if the column '%.80s' is meant, rename it", nearest);
    else snprintf(help, sizeof help, "the first line names the columns, such as script,output");
    ok = cag_jobs_problem(jobs, NULL, CODE_COLUMN, help, "the column '%s' is missing", wanted);
  }
  return ok;
}

// --- CSV ---

typedef struct {
  const char *at, *end;
  size_t line;
  char separator;
} Csv;

typedef struct {
  char **fields;
  size_t count, capacity;
  bool open_quote; // an unclosed quote
} Record;

static void free_record(Record *r) {
  for (size_t i = 0; i < r->count; i++) free(r->fields[i]);
  free(r->fields);
  *r = (Record){0};
}

static bool add_field(Record *r, char *text) {
  if (!text) return false;
  if (!CAG_RESERVE(r->fields, r->capacity, r->count + 1)) {
    free(text);
    return false;
  }
  r->fields[r->count++] = text;
  return true;
}

// field = '"' { any but '"' | '""' } '"' | { any but separator and newline }
static char *read_field(Csv *c, Record *r) {
  const char *start = c->at;
  while (c->at < c->end && (*c->at == ' ' || (*c->at == '\t' && c->separator != '\t'))) c->at++;
  if (c->at == c->end || *c->at != '"') {
    c->at = start;
    while (c->at < c->end && *c->at != c->separator && *c->at != '\n') c->at++;
    return strndup(start, (size_t)(c->at - start));
  }
  char *text = malloc((size_t)(c->end - c->at) + 1), *into = text;
  if (!text) return NULL;
  for (c->at++; c->at < c->end; c->at++) {
    if (*c->at == '"' && (c->at + 1 == c->end || c->at[1] != '"')) break;
    if (*c->at == '"') c->at++;
    c->line += *c->at == '\n';
    *into++ = *c->at;
  }
  r->open_quote |= c->at == c->end;
  c->at += c->at < c->end;
  while (c->at < c->end && *c->at != c->separator && *c->at != '\n') *into++ = *c->at++;
  *into = '\0';
  char *fitting = realloc(text, (size_t)(into - text) + 1);
  return fitting ? fitting : text;
}

// record = field { separator field } newline. Returns false if memory ran out.
static bool read_record(Csv *c, Record *r) {
  do {
    if (!add_field(r, read_field(c, r))) return false;
  } while (c->at < c->end && *c->at == c->separator && c->at++);
  if (c->at < c->end) c->at++, c->line++;
  return true;
}

static bool is_empty(const Record *r) {
  for (size_t i = 0; i < r->count; i++)
    if (r->fields[i][strspn(r->fields[i], " \t\r")]) return false;
  return true;
}

static char find_separator(const char *text, size_t length) {
  const char *newline = memchr(text, '\n', length);
  const size_t n = newline ? (size_t)(newline - text) : length;
  if (memchr(text, ',', n)) return ',';
  return memchr(text, ';', n) ? ';' : memchr(text, '\t', n) ? '\t' : ',';
}

// Reads the names of the columns from the first record, without surrounding blanks.
static bool take_names(CagJobs *jobs, Record *names) {
  bool ok = true;
  for (size_t i = 0; ok && i < names->count; i++) {
    char *name = trimmed(names->fields[i]);
    free(names->fields[i]);
    names->fields[i] = name;
    ok = name != NULL;
  }
  // Spreadsheets write empty columns at the end of each line.
  return ok && check_columns(jobs, names->fields, names->count);
}

static bool take_row(CagJobs *jobs, const Record *names, const Record *record, size_t line) {
  CagJob *row = add_row(jobs, line);
  bool ok = row != NULL;
  if (ok && record->open_quote)
    ok = cag_jobs_problem(jobs, row, CODE_FILE, "write a quote inside a field twice",
                          "the quote at the beginning of a field is never closed");
  for (size_t i = 0; ok && i < record->count; i++) {
    const char *text = record->fields[i], *name = i < names->count ? names->fields[i] : "";
    if (*name) ok = set_field(row, name, text);
    else if (text[strspn(text, " \t\r")])
      ok = cag_jobs_problem(
          jobs, row, CODE_FILE, "put a field that contains the separator in quotes",
          "the row has more fields than the first line has columns: '%.80s'", text);
  }
  return ok;
}

static bool read_csv(CagJobs *jobs, const char *text, size_t length) {
  Csv c = {text, text + length, 1, find_separator(text, length)};
  Record names = {0};
  bool ok = true;
  while (ok && c.at < c.end) {
    Record record = {0};
    const size_t line = c.line;
    ok = read_record(&c, &record);
    if (!ok || is_empty(&record)) {
      free_record(&record);
    } else if (!names.count) {
      names = record;
      ok = take_names(jobs, &names);
    } else {
      // Without valid columns, rows are meaningless.
      if (!jobs->problem_count || jobs->count) ok = take_row(jobs, &names, &record, line);
      free_record(&record);
    }
  }
  if (ok && !names.count)
    ok = cag_jobs_problem(jobs, NULL, CODE_FILE,
                          "the first line names the columns, such as script,output",
                          "the file is empty");
  free_record(&names);
  return ok;
}

// --- JSON ---

// Converts a value to text: lists are written as in the language.
static char *value_text(const cJSON *value) {
  if (cJSON_IsString(value)) return strdup(value->valuestring);
  return cJSON_PrintUnformatted(value);
}

static bool take_member(CagJobs *jobs, CagJob *row, const cJSON *member) {
  if (cJSON_IsNull(member)) return true;
  if (cJSON_IsObject(member))
    return cag_jobs_problem(jobs, row, CODE_FILE, "write the value as a text, as after -D",
                            "the value of '%s' is a record", member->string);
  for (const cJSON *other = member->prev; other && other->next; other = other->prev)
    if (strcmp(other->string, member->string) == 0)
      return cag_jobs_problem(jobs, row, CODE_COLUMN, "remove one of them", "'%s' is given twice",
                              member->string);
  char *text = value_text(member);
  const bool ok = text && set_field(row, member->string, text);
  free(text);
  return ok;
}

static bool take_record(CagJobs *jobs, const cJSON *record) {
  CagJob *row = add_row(jobs, 0);
  if (!row) return false;
  if (!cJSON_IsObject(record))
    return cag_jobs_problem(jobs, row, CODE_FILE,
                            "write {\"script\": \"vase.cag\", \"output\": \"vase.png\"}",
                            "the row is not a record");
  bool ok = true;
  for (const cJSON *m = record->child; ok && m; m = m->next) ok = take_member(jobs, row, m);
  return ok;
}

static size_t line_of(const char *text, const char *at) {
  size_t line = 1;
  for (; text < at; text++) line += *text == '\n';
  return line;
}

// Returns the first \u0000 in a text, where it would end early, or NULL.
static const char *find_zero(const char *text, size_t length) {
  for (const char *at = text; (at = memchr(at, '\\', (size_t)(text + length - at))); at += 2) {
    if (text + length - at < 6) break;
    if (memcmp(at, "\\u0000", 6) == 0) return at;
  }
  return NULL;
}

static bool read_json(CagJobs *jobs, const char *text, size_t length) {
  const char *zero = find_zero(text, length);
  if (zero)
    return cag_jobs_problem(jobs, NULL, CODE_FILE, "remove the character",
                            "line %zu: expected texts without \\u0000", line_of(text, zero));
  const char *stopped = text;
  // The zero after the text makes cJSON check that nothing else follows.
  cJSON *list = cJSON_ParseWithLengthOpts(text, length + 1, &stopped, true);
  bool ok = true;
  if (!list) {
    ok = cag_jobs_problem(jobs, NULL, CODE_FILE, "a list of records: [{\"script\": ...}, ...]",
                          "line %zu: invalid JSON", line_of(text, stopped));
  } else if (!cJSON_IsArray(list)) {
    ok = cag_jobs_problem(jobs, NULL, CODE_FILE, "put the records between [ and ]",
                          "expected a list of records");
  } else {
    for (const cJSON *m = list->child; ok && m; m = m->next) ok = take_record(jobs, m);
  }
  cJSON_Delete(list);
  return ok;
}

// --- The file ---

static bool is_text(const char *text, size_t length) {
  utf8proc_int32_t c;
  for (size_t i = 0; i < length;) {
    const utf8proc_ssize_t n =
        utf8proc_iterate((const utf8proc_uint8_t *)text + i, (utf8proc_ssize_t)(length - i), &c);
    if (n <= 0 || c == 0) return false;
    i += (size_t)n;
  }
  return true;
}

bool cag_jobs_read(CagJobs *jobs, const char *text, size_t length, bool is_json) {
  static const char MARK[] = "\xEF\xBB\xBF";
  if (length >= 3 && memcmp(text, MARK, 3) == 0) text += 3, length -= 3;
  if (!is_text(text, length))
    return cag_jobs_problem(jobs, NULL, CODE_FILE, "save it as UTF-8",
                            "the file is not text in UTF-8");
  const bool ok = is_json ? read_json(jobs, text, length) : read_csv(jobs, text, length);
  for (size_t i = 0; i < jobs->count; i++)
    if (jobs->rows[i].param_count)
      qsort(jobs->rows[i].params, jobs->rows[i].param_count, sizeof(CagJobParam), by_name);
  if (ok && !jobs->count && !jobs->problem_count)
    return cag_jobs_problem(jobs, NULL, CODE_FILE, "add a row for each job",
                            "the file has no rows");
  return ok;
}
