// cag test [PATH ...]: runs scripts as tests.
//
// A folder stands for the scripts below it, in the order of their names; what begins with a dot is
// passed over. interp/session/expect.h says what a test is. The report goes to standard output:
// what failed, with -v also what passed, and at last `N passed, N failed`.

#include <cJSON.h>
#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "interp/session/expect.h"
#include "interp/tool/tool.h"

typedef struct Testing {
  CagTool *tool;
  CagTestOptions options;
  CagTestCounts counts;
  size_t scripts;
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

// --- Finding scripts ---

static bool is_script(const char *name) {
  size_t n = strlen(name);
  return n > 4 && strcmp(name + n - 4, ".cag") == 0;
}

static int is_visible(const struct dirent *entry) { return entry->d_name[0] != '.'; }

static int by_bytes(const struct dirent **a, const struct dirent **b) {
  return strcmp((*a)->d_name, (*b)->d_name);
}

static int fail_path(Testing *t, const char *path) {
  t->status =
      cag_tool_fail(t->tool, CAG_STATUS_FILE, NULL, "cannot read %s: %s", path, strerror(errno));
  return CAG_STATUS_OK;
}

static int test_script(Testing *t, const char *path) {
  t->scripts++;
  int status = cag_test_file(path, &t->options, &t->counts);
  if (status != CAG_STATUS_FILE) return status;
  t->status = CAG_STATUS_FILE;
  return CAG_STATUS_OK;
}

static int test_folder(Testing *t, const char *folder);

// An entry of a folder: a script, a folder with more of them, or something else.
static int test_entry(Testing *t, const char *folder, const char *name) {
  char *path;
  struct stat link, target;
  size_t n = strlen(folder);
  const char *slash = n && folder[n - 1] == '/' ? "" : "/";
  const bool here = strcmp(folder, ".") == 0; // shown without ./
  if (asprintf(&path, "%s%s%s", here ? "" : folder, here ? "" : slash, name) < 0)
    return CAG_STATUS_LIMIT;
  int status = CAG_STATUS_OK;
  if (lstat(path, &link) == 0 && stat(path, &target) == 0) {
    // A link to a folder could lead back to where it stands.
    if (S_ISDIR(link.st_mode)) status = test_folder(t, path);
    else if (S_ISREG(target.st_mode) && is_script(name)) status = test_script(t, path);
  }
  free(path);
  return status;
}

static int test_folder(Testing *t, const char *folder) {
  struct dirent **entries;
  int n = scandir(folder, &entries, is_visible, by_bytes), status = CAG_STATUS_OK;
  if (n < 0) return fail_path(t, folder);
  for (int i = 0; i < n; i++) {
    if (status == CAG_STATUS_OK) status = test_entry(t, folder, entries[i]->d_name);
    free(entries[i]);
  }
  free(entries);
  return status;
}

static char *read_input(size_t *length) {
  char *text = NULL, bytes[65536];
  FILE *f = open_memstream(&text, length);
  size_t n;
  if (!f) return NULL;
  while ((n = fread(bytes, 1, sizeof bytes, stdin)) > 0) fwrite(bytes, 1, n, f);
  fclose(f);
  return text;
}

static int test_input(Testing *t) {
  size_t length;
  char *text = read_input(&length);
  if (!text) return CAG_STATUS_LIMIT;
  t->scripts++;
  int status = cag_test_text("<stdin>", text, length, &t->options, &t->counts);
  free(text);
  return status;
}

static int test_path(Testing *t, const char *path) {
  struct stat st;
  if (strcmp(path, "-") == 0) return test_input(t);
  if (stat(path, &st) != 0) return fail_path(t, path);
  return S_ISDIR(st.st_mode) ? test_folder(t, path) : test_script(t, path);
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
  int status = argc == 0 ? test_folder(&t, ".") : CAG_STATUS_OK;
  for (int i = 0; i < argc && status == CAG_STATUS_OK; i++) status = test_path(&t, argv[i]);
  if (status == CAG_STATUS_LIMIT) cag_tool_fail(tool, status, NULL, "out of memory");
  if (status == CAG_STATUS_OK && t.scripts == 0 && t.status == CAG_STATUS_OK)
    cag_tool_say(tool, "there is no script to test");
  if (t.counts.left_out) printf("%zu pictures not compared\n", t.counts.left_out);
  printf("%zu passed, %zu failed\n", t.counts.passed, t.counts.failed);
  free((void *)(size_t)t.options.define_names);
  if (status != CAG_STATUS_OK) return status;
  if (t.status != CAG_STATUS_OK) return t.status;
  return t.counts.failed ? CAG_STATUS_SCRIPT : CAG_STATUS_OK;
}
