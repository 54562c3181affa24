// Every kind of error has an explanation, an example that causes it, and a script that causes it.
//
// The scripts are tests/language/errors/CODE.cag, and `cag test` runs them. This test checks that
// all of them exist. It runs in the root of the repository.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "cag.h"

// A limit that makes the examples of limits fast.
#define EXAMPLE_MEMORY ((size_t)64 << 20)
#define EXAMPLE_SECONDS 20

// Limits that the test script sets with `// run:`, because an example without options would be
// slow.
static const char *const by_options[] = {"E0603", "E0604"};

// A kind without an example cannot be caused by a script: outputs, renderers, and pictures belong
// to the command line, an interrupt comes from outside, and internal errors should not occur.
static bool has_script(const char *code, const char *example) {
  for (size_t i = 0; i < sizeof by_options / sizeof *by_options; i++)
    if (strcmp(by_options[i], code) == 0) return true;
  return example != NULL;
}

// Examples that need more than one text: a file that imports itself, a -D, or another file.
static const char *const beyond_text[] = {"E0241", "E0247", "E0248", "E0249", "E0730", "E0731",
                                          "E0732", "E0733", "E0734", "E0735", "E0736", "E0843",
                                          "E0844", "E0845", "E0846", "E0847"};

static bool wants_more(const char *code) {
  for (size_t i = 0; i < sizeof beyond_text / sizeof *beyond_text; i++)
    if (strcmp(beyond_text[i], code) == 0) return true;
  return false;
}

static bool is_provoked(const char *code, const char *example) {
  CagSessionOptions options;
  cag_session_options_init(&options);
  options.max_memory = EXAMPLE_MEMORY;
  options.max_time = EXAMPLE_SECONDS;
  options.out = fopen("/dev/null", "w");
  assert_non_null(options.out);
  CagSession *s = cag_session_new(&options);
  assert_non_null(s);
  int status = cag_session_run_text(s, code, example, strlen(example));
  CagShownCounts counts;
  if (status == CAG_STATUS_OK)
    cag_session_scene(s, &counts); // reports why a shown value cannot be built
  bool found = cag_session_error_count(s) > 0;
  for (size_t i = 0; i < cag_session_error_count(s); i++) {
    CagErrorView e;
    cag_session_error(s, i, &e);
    if (strcmp(e.code, code) == 0) continue;
    print_error("the example of %s gives %s: %s\n", code, e.code, e.message);
    found = false;
  }
  if (cag_session_error_count(s) == 0) print_error("the example of %s gives no error\n", code);
  cag_session_free(s);
  fclose(options.out);
  return found;
}

static void every_example_provokes_its_error(void **state) {
  (void)state;
  const char *code, *example;
  size_t bad = 0;
  for (size_t i = 0; cag_error_kind(i, &code, NULL, NULL, &example); i++)
    if (example && !wants_more(code) && !is_provoked(code, example)) bad++;
  assert_int_equal(bad, 0);
}

static void every_kind_is_explained(void **state) {
  (void)state;
  const char *code, *reason, *title;
  for (size_t i = 0; cag_error_kind(i, &code, &reason, &title, NULL); i++) {
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (!cag_explain(code, out)) fail_msg("%s has no explanation", code);
    fclose(out);
    // The first line has the code, the reason, and the title, and is followed by at least one
    // sentence.
    size_t head = strcspn(text, "\n");
    if (!strstr(text, code) || !strstr(text, reason) || !strstr(text, title) || size < head + 20)
      fail_msg("%s is not explained: %s", code, text);
    free(text);
  }
}

static void codes_and_reasons_are_said_once(void **state) {
  (void)state;
  const char *a, *b, *a_reason, *b_reason;
  for (size_t i = 0; cag_error_kind(i, &a, &a_reason, NULL, NULL); i++)
    for (size_t k = 0; k < i && cag_error_kind(k, &b, &b_reason, NULL, NULL); k++)
      if (strcmp(a, b) == 0 || strcmp(a_reason, b_reason) == 0)
        fail_msg("%s (%s) and %s (%s)", a, a_reason, b, b_reason);
}

static void every_kind_of_a_script_has_one(void **state) {
  (void)state;
  const char *code, *example;
  size_t bad = 0;
  for (size_t i = 0; cag_error_kind(i, &code, NULL, NULL, &example); i++) {
    char path[128];
    snprintf(path, sizeof path, "tests/language/errors/%s.cag", code);
    bool missing = has_script(code, example) && access(path, R_OK) != 0;
    if (missing) print_error("%s is missing\n", path);
    bad += missing;
  }
  assert_int_equal(bad, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_example_provokes_its_error),
      cmocka_unit_test(every_kind_is_explained),
      cmocka_unit_test(codes_and_reasons_are_said_once),
      cmocka_unit_test(every_kind_of_a_script_has_one),
  };
  return cmocka_run_group_tests_name("errors", tests, NULL, NULL);
}
