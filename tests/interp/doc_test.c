// Documentation is complete: walked through by all rows of the built-ins and all public definitions
// of the library.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "interp/doc/doc.h"
#include "interp/session/expect.h"

static CagSession *open_session(void) {
  CagSessionOptions options;
  cag_session_options_init(&options);
  CagSession *s = cag_session_new(&options);
  assert_non_null(s);
  return s;
}

static void every_parameter_of_a_built_in_is_told(void **state) {
  (void)state;
  size_t bad = 0, parameters = 0;
  for (size_t i = 0; i < cag_builtin_count(); i++) {
    size_t rows;
    cag_builtin_rows(i, &rows);
    for (size_t r = 0; r < rows; r++) {
      const CagSignature *s = cag_builtin_signature(i, r);
      for (size_t k = 0; s && k < s->count; k++) {
        const CagDocParameter *p = cag_doc_parameter(s->name, s->parameters[k]);
        parameters++;
        if (p && *p->type && *p->meaning) continue;
        print_error("%s: nothing tells of the parameter %s\n", s->name, s->parameters[k]);
        bad++;
      }
    }
  }
  assert_true(parameters > 1000);
  assert_int_equal(bad, 0);
}

static void every_built_in_has_result_summary_example_and_family(void **state) {
  (void)state;
  size_t bad = 0;
  for (size_t i = 0; i < cag_builtin_count(); i++) {
    size_t rows;
    const CagBuiltin *b = cag_builtin_rows(i, &rows);
    for (size_t r = 0; r < rows; r++) {
      const char *const parts[] = {b[r].result, b[r].summary, b[r].example, b[r].family};
      for (size_t k = 0; k < 4; k++) {
        if (parts[k] && *parts[k]) continue;
        print_error("%s: part %zu of its documentation is missing\n", b[r].signature, k);
        bad++;
      }
    }
  }
  assert_int_equal(bad, 0);
}

static void every_public_definition_of_the_library_is_told(void **state) {
  (void)state;
  CagSession *s = open_session();
  size_t bad = 0, definitions = 0;
  for (size_t i = 0; cag_doc_module_name(i); i++) {
    const char *text;
    size_t length;
    CagDocModule m;
    const char *name = cag_doc_library(cag_doc_module_name(i), &text, &length);
    assert_int_equal(cag_session_read_doc(s, name, text, length, &m), CAG_STATUS_OK);
    for (size_t k = 0; k < m.count; k++) {
      const CagDocEntry *e = &m.entries[k];
      definitions++;
      bool whole = e->text && *e->text;
      if (!whole) print_error("%s.%s has no documentation\n", m.name, e->name);
      for (size_t n = 0; n < e->argument_count; n++)
        if (!cag_doc_module_parameter(m.name, e->name, e->arguments[n].name)) {
          print_error("%s.%s: nothing tells of %s\n", m.name, e->name, e->arguments[n].name);
          whole = false;
        }
      bad += !whole;
    }
    cag_doc_module_free(&m);
  }
  cag_session_free(s);
  assert_true(definitions > 50);
  assert_int_equal(bad, 0);
}

static bool is_module(const char *word) {
  const char *text;
  size_t length;
  return cag_doc_library(word, &text, &length) != NULL;
}

// Rows of the table that tell of parameters which no function has any more.
static void no_row_of_parameters_is_left_over(void **state) {
  (void)state;
  static const CagDocParameter rows[] = {
#define CAG_PARAMETER(functions, name, type, meaning) {functions, name, type, meaning},
#include "interp/doc/parameters.def"
#undef CAG_PARAMETER
  };
  size_t bad = 0;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    char *words = strdup(rows[i].functions), *rest = NULL;
    for (char *word = strtok_r(words, " ", &rest); word; word = strtok_r(NULL, " ", &rest)) {
      const size_t index = cag_builtin_find(word);
      bool found = false;
      size_t count = 0;
      if (index != (size_t)-1) cag_builtin_rows(index, &count);
      for (size_t r = 0; r < count && !found; r++) {
        const CagSignature *s = cag_builtin_signature(index, r);
        for (size_t k = 0; s && k < s->count; k++)
          found |= strcmp(s->parameters[k], rows[i].name) == 0;
      }
      if (index == (size_t)-1) found = strchr(word, '.') || is_module(word);
      if (!found) print_error("no %s takes %s\n", word, rows[i].name);
      bad += !found;
    }
    free(words);
  }
  assert_int_equal(bad, 0);
}

static void a_script_s_params_have_default_range_and_words(void **state) {
  (void)state;
  static const char SCRIPT[] = "// Two lines\n// of purpose.\n\n"
                               "/// How high.\nparam height = 3 * 40 in 50..300 \"mm\"\n"
                               "/// Flat.\nflat(c,\n  amount = 2) = c\n"
                               "plain = x => x\n_hidden = 1\n";
  CagSession *s = open_session();
  CagDocModule m;
  assert_int_equal(cag_session_read_doc(s, "a.cag", SCRIPT, sizeof SCRIPT - 1, &m), CAG_STATUS_OK);
  assert_string_equal(m.purpose, "Two lines\nof purpose.\n");
  assert_int_equal(m.count, 3);
  assert_int_equal(m.entries[0].kind, CAG_DOC_PARAM);
  assert_string_equal(m.entries[0].fallback, "3 * 40");
  assert_string_equal(m.entries[0].range, "50..300");
  assert_string_equal(m.entries[0].label, "mm");
  assert_string_equal(m.entries[0].text, "How high.");
  assert_int_equal(m.entries[1].kind, CAG_DOC_FUNCTION);
  assert_string_equal(m.entries[1].signature, "flat(c, amount = 2)");
  assert_string_equal(m.entries[1].arguments[1].fallback, "2");
  assert_int_equal(m.entries[2].kind, CAG_DOC_VALUE);
  assert_null(m.entries[2].text);
  cag_doc_module_free(&m);
  cag_session_free(s);
}

static void a_line_of_documentation_may_be_long(void **state) {
  (void)state;
  enum { LENGTH = 100000 };
  static char script[LENGTH + 32] = "/// ";
  memset(script + 4, 'x', LENGTH);
  strcpy(script + 4 + LENGTH, "\na = 1\n");
  CagSession *s = open_session();
  CagDocModule m;
  assert_int_equal(cag_session_read_doc(s, "a.cag", script, strlen(script), &m), CAG_STATUS_OK);
  assert_int_equal(strlen(m.entries[0].text), LENGTH);
  cag_doc_module_free(&m);
  cag_session_free(s);
}

static void a_sentence_ends_at_its_point(void **state) {
  (void)state;
  assert_int_equal(cag_doc_sentence("One. Two."), 4);
  assert_int_equal(cag_doc_sentence("Over 0..1. Two"), 10);
  assert_int_equal(cag_doc_sentence("By 1, 2 ... and so on"), 21);
  assert_int_equal(cag_doc_sentence(""), 0);
}

static void of_several_words_the_first_is_the_default(void **state) {
  (void)state;
  assert_int_equal(cag_doc_default("\"left\"|\"right\""), 6);
  assert_int_equal(cag_doc_default("0..1"), 4);
}

// ---- Words of the language, and topics ----

static bool is_documented(CagSession *s, const char *name) {
  FILE *out = fopen("/dev/null", "w");
  assert_non_null(out);
  const bool found = cag_session_document(s, name, false, out);
  fclose(out);
  return found;
}

static void every_word_of_the_language_is_told(void **state) {
  (void)state;
  static const char *const words[] = {
      "and",    "as",  "assert", "by",    "else",  "false", "for",  "if",   "import", "in",
      "none",   "not", "or",     "param", "print", "show",  "then", "true", "time",   "frame",
      "frames", "|>",  "=>",     "==",    "!=",    "<",     "<=",   ">",    ">=",     "+",
      "-",      "*",   "/",      "%",     "^",     "|",     "&",    "..",   "..<",    "...",
      "=",      "{}",  "[]",     "//",    "///",   "gear",  "hull", "text", "film",   "light"};
  CagSession *s = open_session();
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    if (!is_documented(s, words[i])) fail_msg("nothing tells of %s", words[i]);
  cag_session_free(s);
}

static void topics_refer_to_what_is_told(void **state) {
  (void)state;
  CagSession *s = open_session();
  const char *word, *see;
  for (size_t i = 0; cag_doc_word_row(i, &word, &see, NULL); i++) {
    char *names = see ? strdup(see) : NULL, *rest = NULL;
    for (char *n = names ? strtok_r(names, " ", &rest) : NULL; n; n = strtok_r(NULL, " ", &rest))
      if (!is_documented(s, n)) fail_msg("%s refers to %s, of which nothing tells", word, n);
    free(names);
  }
  cag_session_free(s);
}

static void tell_failure(void *context, const CagTestFailure *f) {
  (void)context;
  print_error("%s: %s; expected %s, got %s\n", f->test, f->message, f->expected ? f->expected : "",
              f->got ? f->got : "");
}

static void examples_of_words_run(void **state) {
  (void)state;
  CagTestOptions options;
  CagTestCounts counts = {0};
  const char *word, *example;
  cag_test_options_init(&options);
  options.failure = tell_failure;
  for (size_t i = 0; cag_doc_word_row(i, &word, NULL, &example); i++) {
    assert_true(strstr(example, "print ") || strstr(example, "show ") ||
                strstr(example, "assert "));
    assert_int_equal(cag_test_text(word, example, strlen(example), &options, &counts), 0);
  }
  assert_int_equal(counts.failed, 0);
  assert_true(counts.passed > 50);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_parameter_of_a_built_in_is_told),
      cmocka_unit_test(every_word_of_the_language_is_told),
      cmocka_unit_test(topics_refer_to_what_is_told),
      cmocka_unit_test(examples_of_words_run),
      cmocka_unit_test(every_built_in_has_result_summary_example_and_family),
      cmocka_unit_test(every_public_definition_of_the_library_is_told),
      cmocka_unit_test(no_row_of_parameters_is_left_over),
      cmocka_unit_test(a_script_s_params_have_default_range_and_words),
      cmocka_unit_test(a_line_of_documentation_may_be_long),
      cmocka_unit_test(a_sentence_ends_at_its_point),
      cmocka_unit_test(of_several_words_the_first_is_the_default),
  };
  return cmocka_run_group_tests_name("documentation", tests, NULL, NULL);
}
