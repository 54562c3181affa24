// Words and forms of other languages: each row of lang/foreign.def is suggested in its place, and
// the suggested form runs.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "cag.h"

// The minimum number of names.
#define NAMES_LEAST 100

typedef enum Kind { NAME, MEMBER, ARGUMENT, CALL, SYNTAX } Kind;

typedef struct Row {
  Kind kind;
  const char *word, *example, *form;
} Row;

static const Row rows[] = {
#define CAG_FOREIGN_NAME(word, form) {NAME, word, "print " word, form},
#define CAG_FOREIGN_MEMBER(word, form) {MEMBER, word, "print [1, 2]." word "(3)", form},
#define CAG_FOREIGN_ARGUMENT(word, meant, example, form) {ARGUMENT, word, "show " example, form},
#define CAG_FOREIGN_CALL(function, example, form) {CALL, function, "print " example, form},
#define CAG_FOREIGN_SYNTAX(id, example, form) {SYNTAX, #id, example, form},
#include "lang/foreign.def"
};
#define ROW_COUNT (sizeof rows / sizeof *rows)

static char folder[] = "/tmp/cag_foreign_XXXXXX";

static CagSession *quiet_session(FILE **out) {
  CagSessionOptions options;
  cag_session_options_init(&options);
  options.out = *out = fopen("/dev/null", "w");
  assert_non_null(*out);
  CagSession *s = cag_session_new(&options);
  assert_non_null(s);
  return s;
}

// Whether an error of the example has a help that contains the form.
static bool is_suggested(const Row *row, bool check) {
  FILE *out;
  CagSession *s = quiet_session(&out);
  const size_t length = strlen(row->example);
  if (check) cag_session_check_text(s, "test", row->example, length);
  else cag_session_run_text(s, "test", row->example, length);
  bool good = false;
  for (size_t i = 0; i < cag_session_error_count(s); i++) {
    CagErrorView e;
    cag_session_error(s, i, &e);
    good = good || (e.help && strstr(e.help, row->form));
    if (!good) print_error("%s: help: %s\n", e.message, e.help ? e.help : "none");
  }
  if (!good) print_error("%s does not suggest %s\n", row->example, row->form);
  cag_session_free(s);
  fclose(out);
  return good;
}

static bool runs(const Row *row) {
  FILE *out;
  CagSession *s = quiet_session(&out);
  const int status = cag_session_input(s, row->form, strlen(row->form), NULL, NULL);
  if (status != CAG_STATUS_OK) {
    CagErrorView e = {0};
    cag_session_error(s, 0, &e);
    print_error("%s: the form %s fails: %s\n", row->word, row->form, e.message);
  }
  cag_session_free(s);
  fclose(out);
  return status == CAG_STATUS_OK;
}

static void every_form_is_suggested(void **state) {
  (void)state;
  size_t bad = 0;
  for (size_t i = 0; i < ROW_COUNT; i++) bad += !is_suggested(&rows[i], false);
  assert_int_equal(bad, 0);
}

static void every_form_is_suggested_by_the_checker(void **state) {
  (void)state;
  size_t bad = 0;
  for (size_t i = 0; i < ROW_COUNT; i++) bad += !is_suggested(&rows[i], true);
  assert_int_equal(bad, 0);
}

// Forms that read files need these files.
static void every_form_runs(void **state) {
  (void)state;
  size_t bad = 0;
  for (size_t i = 0; i < ROW_COUNT; i++) bad += !runs(&rows[i]);
  assert_int_equal(bad, 0);
}

static void names_stand_once_and_are_many(void **state) {
  (void)state;
  size_t names = 0;
  for (size_t i = 0; i < ROW_COUNT; i++) {
    names += rows[i].kind == NAME;
    for (size_t k = 0; k < i; k++)
      if (rows[i].kind == rows[k].kind && rows[i].kind != ARGUMENT &&
          strcmp(rows[i].word, rows[k].word) == 0)
        fail_msg("%s stands twice", rows[i].word);
  }
  assert_true(names >= NAMES_LEAST);
}

static int make_files(void **state) {
  (void)state;
  if (!mkdtemp(folder) || chdir(folder) != 0) return -1;
  FILE *f = fopen("notes.txt", "w");
  if (!f) return -1;
  fputs("a line\n", f);
  return fclose(f);
}

static int remove_files(void **state) {
  (void)state;
  return unlink("notes.txt") || chdir("/") || rmdir(folder);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_form_is_suggested),
      cmocka_unit_test(every_form_is_suggested_by_the_checker),
      cmocka_unit_test(every_form_runs),
      cmocka_unit_test(names_stand_once_and_are_many),
  };
  return cmocka_run_group_tests_name("foreign", tests, make_files, remove_files);
}
