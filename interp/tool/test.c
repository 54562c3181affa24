// cag test [PATH ...]: runs scripts as tests.
//
// scripts.h says which scripts, interp/session/expect.h says what a test is. The report goes to
// standard output: what failed, with -v also what passed, and at last `N passed, N failed`.

#include <cJSON.h>
#include <stdlib.h>
#include <string.h>

#include "interp/session/expect.h"
#include "interp/tool/scripts.h"

typedef struct Testing {
  CagTool *tool;
  CagTestOptions options;
  CagTestCounts counts;
  int status; // of the first path that could not be read
} Testing;

// --- Report ---

static void add_text(cJSON *object, const char *name, const char *text) {
  if (text) cJSON_AddStringToObject(object, name, text);
}

// The fields of a diagnostic, and what was expected and found.
static void report_json(const CagTestFailure *f) {
  cJSON *object = cJSON_CreateObject();
  add_text(object, "severity", "error");
  cJSON_AddNullToObject(object, "code");
  add_text(object, "message", f->message);
  add_text(object, "file", f->file);
  if (f->line) cJSON_AddNumberToObject(object, "line", (double)f->line);
  add_text(object, "test", f->test);
  add_text(object, "expected", f->expected);
  add_text(object, "got", f->got);
  add_text(object, "detail", f->detail);
  char *text = cJSON_PrintUnformatted(object);
  fprintf(stderr, "%s\n", text ? text : "{\"severity\":\"error\"}");
  cJSON_free(text);
  cJSON_Delete(object);
}

static void print_indented(const char *text) {
  while (*text) {
    size_t n = strcspn(text, "\n");
    printf("  %.*s\n", (int)n, text);
    text += n + (text[n] == '\n');
  }
}

static void report_failure(void *context, const CagTestFailure *f) {
  const Testing *t = context;
  if (t->tool->style == CAG_STYLE_JSON) {
    report_json(f);
    return;
  }
  printf("FAILED %s\n", f->test);
  if (f->line) printf("  %s:%zu: %s\n", f->file, f->line, f->message);
  else printf("  %s: %s\n", f->file, f->message);
  if (f->expected) printf("    expected: %s\n", f->expected);
  if (f->got) printf("    got:      %s\n", f->got);
  if (f->detail) print_indented(f->detail);
  fflush(stdout);
}

static void report_end(void *context, const char *test, CagTestOutcome outcome, double seconds,
                       const char *remark) {
  const Testing *t = context;
  if (outcome == CAG_TEST_LEFT_OUT) cag_tool_say(t->tool, "%s is left out: %s", test, remark);
  else if (remark && !t->tool->quiet) printf("%s: %s\n", test, remark);
  else if (t->tool->verbose && outcome == CAG_TEST_PASSED)
    printf("passed %s in %.2f s\n", test, seconds);
}

// --- A script ---

static int test_input(Testing *t) {
  size_t length;
  char *text = cag_tool_read_file(t->tool, "-", &length);
  if (!text) {
    t->status = CAG_STATUS_FILE;
    return CAG_STATUS_OK;
  }
  int status = cag_test_text("<stdin>", text, length, &t->options, &t->counts);
  free(text);
  return status;
}

static int test_script(void *context, const char *path) {
  Testing *t = context;
  if (strcmp(path, "-") == 0) return test_input(t);
  int status = cag_test_file(path, &t->options, &t->counts);
  if (status != CAG_STATUS_FILE) return status;
  t->status = CAG_STATUS_FILE;
  return CAG_STATUS_OK;
}

// --- The command ---

// The defines of the command line as two lists, in one piece of memory.
static bool copy_defines(CagTestOptions *o, const CagTool *t) {
  size_t n = t->define_count;
  const char **texts = malloc((2 * n + 1) * sizeof *texts);
  if (!texts) return false;
  for (size_t i = 0; i < n; i++) {
    texts[i] = t->defines[i].name;
    texts[n + i] = t->defines[i].value;
  }
  o->define_names = texts;
  o->define_values = texts + n;
  o->define_count = n;
  return true;
}

int cag_tool_test(CagTool *tool, int argc, char **argv) {
  Testing t = {.tool = tool};
  cag_test_options_init(&t.options);
  t.options.session = tool->session;
  t.options.filter = tool->filter;
  t.options.update = tool->update;
  t.options.no_pictures = tool->no_pictures;
  t.options.failure = report_failure;
  t.options.ended = report_end;
  t.options.context = &t;
  if (!copy_defines(&t.options, tool))
    return cag_tool_fail(tool, CAG_STATUS_LIMIT, NULL, "out of memory");
  CagToolScripts scripts = {.tool = tool, .each = test_script, .context = &t};
  int status = cag_tool_each_script(&scripts, argc, argv);
  if (scripts.status != CAG_STATUS_OK) t.status = scripts.status;
  if (status == CAG_STATUS_LIMIT) cag_tool_fail(tool, status, NULL, "out of memory");
  if (status == CAG_STATUS_OK && scripts.count == 0 && t.status == CAG_STATUS_OK)
    cag_tool_say(tool, "there is no script to test");
  if (t.counts.left_out) printf("%zu pictures not compared\n", t.counts.left_out);
  printf("%zu passed, %zu failed\n", t.counts.passed, t.counts.failed);
  free((void *)(size_t)t.options.define_names);
  if (status != CAG_STATUS_OK) return status;
  if (t.status != CAG_STATUS_OK) return t.status;
  return t.counts.failed ? CAG_STATUS_SCRIPT : CAG_STATUS_OK;
}
