// Files of jobs: what rows and problems their texts give, and that no failing allocation and no
// torn text does harm.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <string.h>

#include "cli/jobs.h"
#include "tests/fuzz/failing.h"

volatile int cag_tool_interrupt;

// The rows as `line: column=value ...`, and the problems as `! row code message`, each on a line.
static void describe(const CagJobs *jobs, char *out, size_t size) {
  size_t n = 0;
  *out = '\0';
#define SAY(...) n += n < size ? (size_t)snprintf(out + n, size - n, __VA_ARGS__) : 0
  for (size_t i = 0; i < jobs->count; i++) {
    const CagJob *row = &jobs->rows[i];
    SAY("%zu:", row->line);
    for (size_t c = 0; c < CAG_JOB_COLUMN_COUNT; c++)
      if (row->cells[c]) SAY(" %s=%s", cag_job_column_names[c], row->cells[c]);
    for (size_t p = 0; p < row->param_count; p++)
      SAY(" %s=%s", row->params[p].name, row->params[p].value);
    SAY("\n");
  }
  for (size_t i = 0; i < jobs->problem_count; i++)
    SAY("! %zu %s %s\n", jobs->problems[i].row, jobs->problems[i].code, jobs->problems[i].message);
#undef SAY
}

typedef struct File {
  const char *text;
  size_t length; // 0: of the text
  bool json;
  const char *rows;
} File;

#define CSV(text, rows)                                                                            \
  { text, 0, false, rows }
#define JSON(text, rows)                                                                           \
  { text, 0, true, rows }
#define BYTES(text, json, rows)                                                                    \
  { text, sizeof text - 1, json, rows }
#define MARK "\xEF\xBB\xBF"

static const File FILES[] = {
    // --- CSV ---
    CSV("script,output\na.cag,a.stl\n", "2: script=a.cag output=a.stl\n"),
    CSV("script,output\na.cag,a.stl", "2: script=a.cag output=a.stl\n"),
    CSV(MARK "script;output;r\r\n a.cag ;a.stl; 1,5 \r\n", "2: script=a.cag output=a.stl r=1,5\n"),
    CSV("script\toutput\tr\na.cag\ta.stl\t\n", "2: script=a.cag output=a.stl\n"),
    CSV("script\toutput\tr\na.cag\t \"a.stl\"\t2\n", "2: script=a.cag output=a.stl r=2\n"),
    // params stand in the order of their names
    CSV("output,z,script,b\na.stl,1,a.cag,2\n", "2: script=a.cag output=a.stl b=2 z=1\n"),
    // empty lines, and lines of empty fields, are passed over
    CSV("\n ,,\nscript,output\n\n , \na.cag,a.stl\n", "6: script=a.cag output=a.stl\n"),
    // quotes
    CSV("script,output,t\na.cag,\"a b.stl\",\"say \"\"no\"\"\"\n",
        "2: script=a.cag output=a b.stl t=say \"no\"\n"),
    CSV("script,output,t\n\ta.cag, \t\"a.stl\"more ,\"\"\n", "2: script=a.cag output=a.stlmore\n"),
    CSV("script,output,t\na.cag,a.stl,\"1\n2\"\nb.cag,b.stl,3\n",
        "2: script=a.cag output=a.stl t=1\n2\n4: script=b.cag output=b.stl t=3\n"),
    CSV("script,output\na.cag,\"a.stl\"", "2: script=a.cag output=a.stl\n"),
    CSV("script,output\na.cag,\"a.stl\n",
        "2: script=a.cag output=a.stl\n! 1 E0910 the quote at the beginning of a field is never closed\n"),
    // columns
    CSV("script,output,,\na.cag,a.stl,,\n", "2: script=a.cag output=a.stl\n"),
    CSV("script,output\na.cag,a.stl,,more\n",
        "2: script=a.cag output=a.stl\n! 1 E0910 the row has more fields than the first line has columns: 'more'\n"),
    CSV("script,output\na.cag\n", "2: script=a.cag\n"),
    CSV("script,output,r,r\na.cag,a.stl,1,2\n", "! 0 E0911 duplicate column 'r'\n"),
    CSV("x,y\n1,2\n3,4\n", "! 0 E0911 the column 'script' is missing\n"
                           "! 0 E0911 the column 'output' is missing\n"),
    // no rows
    CSV("", "! 0 E0910 the file is empty\n"),
    CSV(" \n\n", "! 0 E0910 the file is empty\n"),
    CSV("script,output\n", "! 0 E0910 the file has no rows\n"),
    BYTES("script,output\na\0b,c\n", false, "! 0 E0910 the file is not text in UTF-8\n"),
    BYTES("script,output\n\xC3\n", false, "! 0 E0910 the file is not text in UTF-8\n"),
    // --- JSON ---
    JSON("[{\"script\": \"a.cag\", \"output\": \"a.stl\", \"r\": 7, \"list\": [1, 2], \"on\": true,"
         " \"none\": null, \"empty\": \"\"}]",
         "0: script=a.cag output=a.stl list=[1,2] on=true r=7\n"),
    JSON("[{\"t\": \"\\u00e9\\\\\", \"b\": \"\\n\"}]", "0: t=\xC3\xA9\\\n"),
    JSON("[{\"script\": \"a.cag\", \"r\": 1, \"script\": \"b.cag\"}]",
         "0: script=a.cag r=1\n! 1 E0911 'script' is given twice\n"),
    JSON("[{\"r\": {\"a\": 1}}, 3, []]", "0:\n0:\n0:\n! 1 E0910 the value of 'r' is a record\n"
                                         "! 2 E0910 the row is not a record\n"
                                         "! 3 E0910 the row is not a record\n"),
    JSON("[]", "! 0 E0910 the file has no rows\n"),
    JSON("{\"script\": \"a.cag\"}", "! 0 E0910 expected a list of records\n"),
    JSON("[\n{\"script\":\n", "! 0 E0910 line 3: invalid JSON\n"),
    JSON("[] more", "! 0 E0910 line 1: invalid JSON\n"),
    JSON("[\n{\"script\": \"a\\u0000b\"}]", "! 0 E0910 line 2: expected texts without \\u0000\n"),
    JSON("[{\"t\": \"\\\\u0000\"}]", "0: t=\\u0000\n"),
    JSON("", "! 0 E0910 line 1: invalid JSON\n"),
};
#define FILE_COUNT (sizeof FILES / sizeof *FILES)

static size_t length_of(const File *f) { return f->length ? f->length : strlen(f->text); }

static void test_files(void **state) {
  (void)state;
  int wrong = 0;
  for (size_t i = 0; i < FILE_COUNT; i++) {
    char got[2048];
    CagJobs jobs = {0};
    assert_true(cag_jobs_read(&jobs, FILES[i].text, length_of(&FILES[i]), FILES[i].json));
    describe(&jobs, got, sizeof got);
    if (strcmp(got, FILES[i].rows) != 0) {
      print_error("%s\n  expected: %s  got:      %s\n", FILES[i].text, FILES[i].rows, got);
      wrong++;
    }
    cag_jobs_free(&jobs);
  }
  assert_int_equal(wrong, 0);
}

// Rows, fields and problems beyond what is allocated at first.
static void test_many(void **state) {
  (void)state;
  enum { ROWS = 100, COLUMNS = 50 };
  char *text = NULL;
  size_t length = 0;
  FILE *f = __real_open_memstream(&text, &length);
  fputs("script,output", f);
  for (int c = 0; c < COLUMNS; c++) fprintf(f, ",p%02d", c);
  for (int r = 0; r < ROWS; r++) {
    fprintf(f, "\na.cag,%d.stl", r);
    for (int c = 0; c < COLUMNS; c++) fprintf(f, ",%d", r * c);
    fputs(",more", f);
  }
  fclose(f);
  CagJobs jobs = {0};
  assert_true(cag_jobs_read(&jobs, text, length, false));
  assert_int_equal(jobs.count, ROWS);
  assert_int_equal(jobs.problem_count, ROWS);
  for (int r = 0; r < ROWS; r++) {
    char value[16];
    assert_int_equal(jobs.problems[r].row, r + 1);
    assert_int_equal(jobs.rows[r].param_count, COLUMNS);
    snprintf(value, sizeof value, "%d", r * 49);
    assert_string_equal(jobs.rows[r].params[49].value, value);
  }
  cag_jobs_free(&jobs);
  free(text);
}

// A text that ends anywhere is read, without a look behind its end (the copy fits exactly).
static void test_torn(void **state) {
  (void)state;
  for (size_t i = 0; i < FILE_COUNT; i++)
    for (size_t n = 0; n < length_of(&FILES[i]); n++) {
      char *part = calloc(n + 1, 1);
      memcpy(part, FILES[i].text, n);
      CagJobs jobs = {0};
      assert_true(cag_jobs_read(&jobs, part, n, FILES[i].json));
      assert_true(jobs.count || jobs.problem_count);
      cag_jobs_free(&jobs);
      free(part);
    }
}

// Without memory it says so, or reads all that it would.
static void test_failing_memory(void **state) {
  (void)state;
  for (size_t i = 0; i < FILE_COUNT; i++) {
    CagJobs whole = {0};
    made = 0;
    cag_jobs_read(&whole, FILES[i].text, length_of(&FILES[i]), FILES[i].json);
    const size_t all = made;
    for (size_t at = 1; at <= all; at++) {
      CagJobs jobs = {0};
      made = 0;
      failing = at;
      const bool ok = cag_jobs_read(&jobs, FILES[i].text, length_of(&FILES[i]), FILES[i].json);
      failing = 0;
      char got[2048];
      describe(&jobs, got, sizeof got);
      if (ok && strcmp(got, FILES[i].rows) != 0)
        print_error("%s, allocation %zu\n  expected: %s  got:      %s\n", FILES[i].text, at,
                    FILES[i].rows, got);
      if (ok) assert_string_equal(got, FILES[i].rows);
      cag_jobs_free(&jobs);
    }
    cag_jobs_free(&whole);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_files),
      cmocka_unit_test(test_many),
      cmocka_unit_test(test_torn),
      cmocka_unit_test(test_failing_memory),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
