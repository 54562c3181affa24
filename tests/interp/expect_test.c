// Scripts as tests: the runs of a script, and the messages and lines of failures.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "interp/session/expect.h"

static char log_text[8192];

static void note(const char *format, ...) __attribute__((format(printf, 1, 2)));
static void note(const char *format, ...) {
  va_list args;
  const size_t n = strlen(log_text);
  va_start(args, format);
  vsnprintf(log_text + n, sizeof log_text - n, format, args);
  va_end(args);
}

// Writes "3: the output is different [1|2]": the line, the message, the expected and the actual
// text.
static void write_failure(void *context, const CagTestFailure *f) {
  (void)context;
  note("%zu: %s", f->line, f->message);
  if (f->expected || f->got) note(" [%s|%s]", f->expected ? f->expected : "", f->got ? f->got : "");
  note("%s\n", f->detail ? " +" : "");
}

static void write_end(void *context, const char *test, CagTestOutcome outcome, double seconds,
                      const char *remark) {
  (void)context;
  static const char *const outcomes[] = {"passed", "failed", "skipped"};
  assert_true(seconds >= 0 && seconds < 60);
  const char *slash = strrchr(test, '/');
  note("%s %s%s\n", slash ? slash + 1 : test, outcomes[outcome], remark ? remark : "");
}

static CagTestOptions test_options(void) {
  CagTestOptions options;
  cag_test_options_init(&options);
  options.failure = write_failure;
  options.ended = write_end;
  options.no_pictures = true;
  options.session.messages = stderr;
  return options;
}

typedef struct Row {
  const char *script, *log;
} Row;

static size_t differs(const char *script, const char *expected, CagTestCounts counts) {
  size_t bad = strcmp(log_text, expected) != 0;
  if (bad) print_error("%s\n  gives:\n%s  and not:\n%s", script, log_text, expected);
  // The counts match the lines.
  size_t passed = 0, failed = 0;
  for (const char *at = log_text; (at = strstr(at, " passed\n")); at++) passed++;
  for (const char *at = log_text; (at = strstr(at, " failed\n")); at++) failed++;
  assert_int_equal(counts.passed, passed);
  assert_int_equal(counts.failed, failed);
  return bad;
}

static void check_rows(const Row *rows, size_t count, const CagTestOptions *options) {
  size_t bad = 0;
  for (size_t i = 0; i < count; i++) {
    CagTestCounts counts = {0};
    log_text[0] = 0;
    const int status = cag_test_text("t", rows[i].script, strlen(rows[i].script), options, &counts);
    assert_int_equal(status, CAG_STATUS_OK);
    bad += differs(rows[i].script, rows[i].log, counts);
  }
  assert_int_equal(bad, 0);
}

#define CHECK(rows, options) check_rows(rows, sizeof rows / sizeof *rows, options)

static void printed_lines_are_compared_in_order(void **state) {
  (void)state;
  static const Row rows[] = {
      {"", "t passed\n"},
      {"print 1", "t passed\n"}, // a script that does not expect any line may print
      {"print 1 // expect: 1", "t passed\n"},
      {"print 1 //expect:1", "t passed\n"},
      {"print 1 // \t expect: \t 1 \t ", "t passed\n"},
      {"print \"a b\" // expect: a b\nprint 2 // expect: 2\n", "t passed\n"},
      {"print 1 // expect: 2", "1: the output is different [2|1]\nt failed\n"},
      {"print 1 // expect: 1\n\nprint 12 // expect: 1",
       "3: the output is different [1|12]\nt failed\n"},
      {"print 1 // expect: 12", "1: the output is different [12|1]\nt failed\n"},
      {"print 1 // expect: 2\nprint 2 // expect: 1",
       "1: the output is different [2|1]\nt failed\n"},
      {"print 1 // expect: 1\n// expect: 2",
       "2: the output ends before this line [2|]\nt failed\n"},
      {"print 1 // expect: 1\nprint 2\nprint 3\n// nothing\n",
       "1: there is more output than expected [|2]\nt failed\n"},
      {"print \"a\\nb\"\n// expect: a\n// expect: b", "t passed\n"},
      {"print \"a\\n\\nb\"\n// expect: a\n// expect:\n// expect: b", "t passed\n"},
      {"print \"  a  \" // expect: a", "t passed\n"},
      {"// expect: 1", "1: the output ends before this line [1|]\nt failed\n"},
  };
  const CagTestOptions options = test_options();
  CHECK(rows, &options);
}

static void errors_are_expected_on_their_lines(void **state) {
  (void)state;
  static const Row rows[] = {
      {"print y // expect error: E0201", "t passed\n"},
      {"print y // expect error:E0201", "t passed\n"},
      {"print y", "1: unexpected error: E0201 +\nt failed\n"},
      {"x = 1\nprint y\n", "2: unexpected error: E0201 +\nt failed\n"},
      {"print y // expect error: E0301",
       "1: unexpected error: E0201 +\n1: the expected error E0301 did not occur\nt failed\n"},
      {"print y // expect error: E020",
       "1: unexpected error: E0201 +\n1: the expected error E020 did not occur\nt failed\n"},
      {"print y\nprint 1 // expect error: E0201",
       "1: unexpected error: E0201 +\n2: the expected error E0201 did not occur\nt failed\n"},
      // In the plain run, a comment that is alone on its line refers to this line, too.
      {"print y\n// expect error: E0201",
       "1: unexpected error: E0201 +\n2: the expected error E0201 did not occur\nt failed\n"},
      {"print 1 // expect error: E0201", "1: the expected error E0201 did not occur\nt failed\n"},
      {"print y + z // expect error: E0201, E0201", "t passed\n"},
      {"print y + z // expect error: E0201 E0201", "t passed\n"},
      {"print y + z // expect error: E0201", "1: unexpected error: E0201 +\nt failed\n"},
      {"print y // expect error: E0201, E0201",
       "1: the expected error E0201 did not occur\nt failed\n"},
      // Lines printed before the error are also compared.
      {"print 1 // expect: 2\nprint [][0] // expect error: E0305",
       "1: the output is different [2|1]\nt failed\n"},
      {"print 1 // expect: 1\nprint [1][1] // expect error: E0305", "t passed\n"},
      {"print [1][1]\n// expect: 1", "1: unexpected error: E0305 +\nt failed\n"},
  };
  const CagTestOptions options = test_options();
  CHECK(rows, &options);
}

static void each_run_has_its_own_options_and_expectations(void **state) {
  (void)state;
#define H "param h = 1\nprint h\n"
  static const Row rows[] = {
      {H "// run: -D h=2\n// expect: 2\n// run: -D h=3\n// expect: 4",
       "t -D h=2 passed\n6: the output is different [4|3]\nt -D h=3 failed\n"},
      {H "// expect: 1\n// run: -Dh=7\n// expect: 7", "t passed\nt -Dh=7 passed\n"},
      {H "// run:\n// expect: 1", "t  passed\n"},
      {"param a = \"x\"\nparam b = 1\nprint a, b\n// run: -D \"a=y z\" -D b=2\n// expect: y z 2",
       "t -D \"a=y z\" -D b=2 passed\n"},
      {"param a = \"x\"\nprint a\n// run: -D a='p \"q\" r'\n// expect: p \"q\" r",
       "t -D a='p \"q\" r' passed\n"},
      {"param a = \"x\"\nprint a\n// run: -D a=k=v\n// expect: k=v", "t -D a=k=v passed\n"},
      // Additional output is reported at the last expectation of the run.
      {H "print h\n// run: -D h=2\n// expect: 2",
       "5: there is more output than expected [|2]\nt -D h=2 failed\n"},
      // After `run:`, an error is matched by its code if the comment is alone on its line.
      {"param h = 1\nprint [5][h]\n// run: -D h=0\n// expect: 5\n// run: -D h=1\n"
       "// expect error: E0305",
       "t -D h=0 passed\nt -D h=1 passed\n"},
      {"param h = 1\nprint [5][h]\n// run: -D h=1\nx = 1 // expect error: E0305",
       "2: unexpected error: E0305 +\n4: the expected error E0305 did not occur\nt -D h=1 failed\n"},
      {H "// run: -D g=2\n// expect error: E0247", "t -D g=2 passed\n"},
      // Unknown options.
      {H "\n// run: -q\n// expect: 1",
       "4: `-q` is not an option of `// run:`; the options are -D name=value, --picture, --engine, --quality, --camera, --samples, --max-depth, --max-memory, --max-time, and --max-triangles\nt -q failed\n"},
      {H "// run: -D h\n", "3: expected -D name=value, found `-D h`\nt -D h failed\n"},
      {H "// run: -D =2\n", "3: expected -D name=value, found `-D =2`\nt -D =2 failed\n"},
      {H "// run: --max-depth 0\n", "3: `--max-depth` cannot be `0`\nt --max-depth 0 failed\n"},
      {H "// run: --max-depth 9x\n", "3: `--max-depth` cannot be `9x`\nt --max-depth 9x failed\n"},
      {H "// run: --max-depth\n", "3: `--max-depth` needs a value\nt --max-depth failed\n"},
      {H "// run: --samples none\n", "3: `--samples` cannot be `none`\nt --samples none failed\n"},
      {H "// run: --engine\n", "3: `--engine` needs a value\nt --engine failed\n"},
      {H "// run: --picture\n// expect: 1", "t --picture passed\n"},
      // Limits.
      {"f(n) = if n == 0 then 0 else 1 + f(n - 1)\nprint f(50)\n"
       "// run: --max-depth 60\n// expect: 50\n// run: --max-depth 40\n// expect error: E0601",
       "t --max-depth 60 passed\nt --max-depth 40 passed\n"},
      {"print len([for i in 1..100000: [i, \"a\"]])\n// run: --max-memory 100000000\n"
       "// expect: 100000\n// run: --max-memory 4000000\n// expect error: E0602",
       "t --max-memory 100000000 passed\nt --max-memory 4000000 passed\n"},
      {"f(n) = if n == 0 then 0 else f(n - 1)\nprint f(1e12)\n// run: --max-time 0.05\n"
       "// expect error: E0603",
       "t --max-time 0.05 passed\n"},
      {"print len(faces(tessellate(sphere(1)))) > 50\n// run: --max-triangles 100000\n// expect: "
       "true\n"
       "// run: --max-triangles 50\n// expect error: E0604",
       "t --max-triangles 100000 passed\nt --max-triangles 50 passed\n"},
  };
  const CagTestOptions options = test_options();
  CHECK(rows, &options);
}

// Test comments in texts and block comments are ignored.
static void only_line_comments_expect_something(void **state) {
  (void)state;
  static const Row rows[] = {
      {"t = \"// expect: 1\"", "t passed\n"},
      {"t = \"a \\\" // expect: 1\" // expect: 2",
       "1: the output ends before this line [2|]\nt failed\n"},
      {"t = \"\\\\\" // expect: 2", "1: the output ends before this line [2|]\nt failed\n"},
      {"t = `// expect: 1`", "t passed\n"},
      {"t = `\n// expect: 1\n` // expect: 2",
       "3: the output ends before this line [2|]\nt failed\n"},
      {"/* // expect: 1 */", "t passed\n"},
      {"/* /* */ // expect: 1 */", "t passed\n"},
      {"/* /* */ */ // expect: 1", "1: the output ends before this line [1|]\nt failed\n"},
      {"/*/ // expect: 1 */", "t passed\n"},
      {"/*\n\n// expect: 1\n*/\n// expect: 2",
       "5: the output ends before this line [2|]\nt failed\n"},
      {"t = \"{\"// expect: 1\"}\"", "t passed\n"},
      {"t = \"{ {a: \"{1}\"}.a }// expect: 1\"", "t passed\n"},
      {"t = \"{ {a: 1}.a }\" // expect: 2", "1: the output ends before this line [2|]\nt failed\n"},
      {"t = \"{`\"// expect: 1`}\" // expect: 2",
       "1: the output ends before this line [2|]\nt failed\n"},
      {"t = \"\\{\" // expect: 2", "1: the output ends before this line [2|]\nt failed\n"},
      {"a = 6 / 2 // expect: 2", "1: the output ends before this line [2|]\nt failed\n"},
      {"a = 2 * 3 /// expect: 2", "t passed\n"},
      // An unterminated text or comment can expect its own error on its line.
      {"t = \"abc // expect error: E0104", "t passed\n"},
      {"t = \"{`a} // expect error: E0105", "t passed\n"},
      {"x = 1\nt = `abc // expect error: E0105\n// expect: 1",
       "3: the output ends before this line [1|]\nt failed\n"},
      {"/* abc // expect error: E0103", "t passed\n"},
      {"t = \"abc // expect: 1\n", "1: unexpected error: E0104 +\nt failed\n"},
      {"x = 1 /", "1: unexpected error: E0120 +\nt failed\n"},
      {"x = 1 //", "t passed\n"},
  };
  const CagTestOptions options = test_options();
  CHECK(rows, &options);
}

static void misspelt_words_are_failures(void **state) {
  (void)state;
  static const Row rows[] = {
      {"print 1 // Expect: 1", "1: `// Expect: 1` expects nothing; write `// expect:`\nt failed\n"},
      {"\nprint 1 // expects: 1\n// run: -D h=1",
       "2: `// expects: 1` expects nothing; write `// expect:`\n0: unexpected error: E0247 +\nt -D h=1 failed\n"},
      {"print 1 // run: --picture\n// Expect: 1\n// run:",
       "2: `// Expect: 1` expects nothing; write `// expect:`\nt --picture failed\nt  passed\n"},
      {"x = 1 // as we expect", "t passed\n"},
      {"print 1 // Expect: 123456789 123456789 123456789 123456789 123456789 1234567890",
       "1: `// Expect: 123456789 123456789 123456789 123456789 123456789 12` expects nothing; "
       "write `// expect:`\nt failed\n"},
  };
  const CagTestOptions options = test_options();
  CHECK(rows, &options);
}

static void runs_are_chosen_by_their_names(void **state) {
  (void)state;
  static const Row rows[] = {
      {H "// expect: 5\n// run: -D h=2\n// expect: 2\n// run: -D h=3\n// expect: 3",
       "t -D h=3 passed\n"},
      {H, ""},
  };
  CagTestOptions options = test_options();
  options.filter = "h=3";
  CHECK(rows, &options);
  // Definitions for all runs, which the definitions of a run override.
  static const Row defined[] = {
      {H "// expect: 9\n// run: -D h=2\n// expect: 2", "t passed\nt -D h=2 passed\n"}};
  const char *names[] = {"h"}, *values[] = {"9"};
  options = test_options();
  options.define_names = names;
  options.define_values = values;
  options.define_count = 1;
  CHECK(defined, &options);
  // A limit from the options applies to every run.
  static const Row limited[] = {{"f(n) = if n == 0 then 0 else 1 + f(n - 1)\nprint f(50)\n",
                                 "1: unexpected error: E0601 +\nt failed\n"}};
  options = test_options();
  options.session.max_depth = 40;
  CHECK(limited, &options);
}

// Examples in the documentation of definitions run as separate scripts, with their names imported.
static void examples_of_documentation_are_tests(void **state) {
  (void)state;
  static const Row rows[] = {
      {"/// Adds.\n///\n///     print add(1, 2)  // expect: 3\nadd(a, b) = a + b\n",
       "t.cag passed\nt.cag: example of add passed\n"},
      {"x = 1\n/// Adds.\n///     print add(1, 2)\n///     // expect: 4\nadd(a, b) = a + b\n",
       "t.cag passed\n4: the output is different [4|3]\nt.cag: example of add failed\n"},
      {"/// Adds.\n///\n///     print add(1, 2)  // expect: 3\n///\n/// And:\n///\n"
       "///     print add(2, 2)\n///     print add(2, q)\nadd(a, b) = a + b\n",
       "t.cag passed\nt.cag: example of add passed\n8: unexpected error: E0201 +\nt.cag: example 2 of add failed\n"},
      // For an example on the first line, the import is on the same line.
      {"///     print two + q  // expect error: E0201\ntwo = 2\n",
       "t.cag passed\nt.cag: example of two passed\n"},
      // A script with a syntax error has no examples.
      {"///     print two\ntwo = $  // expect error: E0102\n", "t.cag passed\n"},
      {"/// No example.\n///   print 1 + q\ntwo = 2\n", "t.cag passed\n"},
  };
  const CagTestOptions options = test_options();
  char path[] = "/tmp/cag-expect-XXXXXX", file[64];
  assert_non_null(mkdtemp(path));
  snprintf(file, sizeof file, "%s/t.cag", path);
  size_t bad = 0;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    FILE *f = fopen(file, "w");
    fputs(rows[i].script, f);
    fclose(f);
    CagTestCounts counts = {0};
    log_text[0] = 0;
    assert_int_equal(cag_test_file(file, &options, &counts), CAG_STATUS_OK);
    bad += differs(rows[i].script, rows[i].log, counts);
  }
  unlink(file);
  CagTestCounts counts = {0};
  log_text[0] = 0;
  assert_int_equal(cag_test_file(file, &options, &counts), CAG_STATUS_FILE);
  assert_string_equal(log_text, "0: cannot read the script: No such file or directory\n");
  assert_int_equal(counts.failed, 1);
  rmdir(path);
  assert_int_equal(bad, 0);
}

// A script longer than the initial buffer, with an error in its last line.
static void long_scripts_are_read_whole(void **state) {
  (void)state;
  char path[] = "/tmp/cag-expect-XXXXXX";
  const int fd = mkstemp(path);
  FILE *f = fdopen(fd, "w");
  for (int i = 0; i < 2000; i++) fprintf(f, "print %d // expect: %d\n", i, i);
  fprintf(f, "print q // expect error: E0201");
  fclose(f);
  const CagTestOptions options = test_options();
  CagTestCounts counts = {0};
  log_text[0] = 0;
  assert_int_equal(cag_test_file(path, &options, &counts), CAG_STATUS_OK);
  // Names are resolved first, so nothing is printed.
  assert_non_null(strstr(log_text, "1: the output ends before this line [0|]\n"));
  f = fopen(path, "w");
  for (int i = 0; i < 2000; i++) fprintf(f, "print %d // expect: %d\n", i, i);
  fprintf(f, "print 1 + \"\" // expect error: E0321");
  fclose(f);
  log_text[0] = 0;
  assert_int_equal(cag_test_file(path, &options, &counts), CAG_STATUS_OK);
  assert_non_null(strstr(log_text, " passed\n"));
  unlink(path);
}

// CAG_BREP names a program that does not exist.
static void runs_without_cag_brep_are_skipped(void **state) {
  (void)state;
  static const Row rows[] = {
      {"print volume(exact(box(1)))   // expect: 1\n",
       "t skippedthe program cag-brep is missing\n"},
      {"print 1   // expect: 1\nprint exact(box(1))   // expect error: E0756\n", "t passed\n"},
  };
  char *before = getenv("CAG_BREP");
  before = before ? strdup(before) : NULL;
  setenv("CAG_BREP", "/nonexistent/cag-brep", 1);
  const CagTestOptions options = test_options();
  check_rows(rows, sizeof rows / sizeof *rows, &options);
  if (before) setenv("CAG_BREP", before, 1);
  else unsetenv("CAG_BREP");
  free(before);
}

static void interrupted_runs_end_without_outcome(void **state) {
  (void)state;
  const volatile int interrupt = 1;
  CagTestOptions options = test_options();
  options.session.interrupt = &interrupt;
  CagTestCounts counts = {0};
  log_text[0] = 0;
  assert_int_equal(cag_test_text("t", "print 1 // expect: 2", 20, &options, &counts),
                   CAG_STATUS_INTERRUPTED);
  assert_string_equal(log_text, "");
  assert_int_equal(counts.passed + counts.failed + counts.skipped, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(printed_lines_are_compared_in_order),
      cmocka_unit_test(errors_are_expected_on_their_lines),
      cmocka_unit_test(each_run_has_its_own_options_and_expectations),
      cmocka_unit_test(only_line_comments_expect_something),
      cmocka_unit_test(misspelt_words_are_failures),
      cmocka_unit_test(runs_are_chosen_by_their_names),
      cmocka_unit_test(examples_of_documentation_are_tests),
      cmocka_unit_test(long_scripts_are_read_whole),
      cmocka_unit_test(runs_without_cag_brep_are_skipped),
      cmocka_unit_test(interrupted_runs_end_without_outcome),
  };
  return cmocka_run_group_tests_name("expectations", tests, NULL, NULL);
}
