// Documents: texts, positions, answers without a text, and limits.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "cag.h"

typedef struct Found {
  size_t count;
  char text[4096]; // what was given, separated by semicolons
} Found;

static void add(Found *f, const char *text) {
  f->count++;
  if (strlen(f->text) + strlen(text) + 2 > sizeof f->text) return;
  if (f->text[0]) strcat(f->text, ";");
  strcat(f->text, text);
}

static void take_problem(void *context, const CagProblem *p) { add(context, p->code); }
static void take_symbol(void *context, const CagSymbolView *s) { add(context, s->name); }
static void take_label(void *context, const CagCompletion *c) { add(context, c->label); }
static void take_place(void *context, const CagPlace *p) {
  char text[200];
  snprintf(text, sizeof text, "%s:%zu-%zu", p->file, p->start, p->end);
  add(context, text);
}
static void take_edit(void *context, const CagEdit *e) { add(context, e->text); }

static CagWorkspace *workspace(const char *name, const char *text) {
  CagWorkspace *w = cag_workspace_new(NULL);
  assert_non_null(w);
  assert_true(cag_workspace_open(w, name, text, strlen(text)));
  return w;
}

static const char *problems_of(CagWorkspace *w, const char *name, Found *f) {
  *f = (Found){0};
  cag_document_check(w, name, take_problem, f);
  return f->text;
}

static void changes_replace_bytes_and_make_the_document_stale(void **state) {
  (void)state;
  Found f;
  CagWorkspace *w = workspace("a", "x = 1\nprint y\n");
  assert_true(cag_document_is_stale(w, "a"));
  assert_string_equal(problems_of(w, "a", &f), "E0201");
  assert_false(cag_document_is_stale(w, "a"));
  assert_true(cag_workspace_change(w, "a", 12, 13, "x", 1));
  assert_true(cag_document_is_stale(w, "a"));
  size_t length;
  assert_string_equal(cag_document_text(w, "a", &length), "x = 1\nprint x\n");
  assert_int_equal(length, 14);
  assert_string_equal(problems_of(w, "a", &f), "");
  // Ranges outside of the text are refused.
  assert_false(cag_workspace_change(w, "a", 3, 15, "", 0));
  assert_false(cag_workspace_change(w, "a", 3, 2, "", 0));
  assert_false(cag_workspace_change(w, "b", 0, 0, "", 0));
  assert_string_equal(cag_document_text(w, "a", &length), "x = 1\nprint x\n");
  cag_workspace_free(w);
}

static void positions_count_columns_in_three_ways(void **state) {
  (void)state;
  // U+03B8 has 2 bytes and 1 unit of UTF-16; U+1F600 has 4 bytes and 2 units (Unicode, section 3.9).
  CagWorkspace *w = workspace("a", "ab\nθ😀c\r\nd");
  static const struct {
    CagColumns columns;
    size_t column;
  } cases[] = {{CAG_COLUMNS_UTF8, 6}, {CAG_COLUMNS_UTF16, 3}, {CAG_COLUMNS_UTF32, 2}};
  for (int i = 0; i < 3; i++) {
    size_t line, column;
    cag_document_position(w, "a", 9, cases[i].columns, &line, &column);
    assert_int_equal(line, 1);
    assert_int_equal(column, cases[i].column);
    assert_int_equal(cag_document_offset(w, "a", 1, cases[i].column, cases[i].columns), 9);
    // Beyond the end of the line, before its line break; and beyond the last line.
    assert_int_equal(cag_document_offset(w, "a", 1, 99, cases[i].columns), 10);
    assert_int_equal(cag_document_offset(w, "a", 9, 0, cases[i].columns), 13);
    cag_document_position(w, "a", 99, cases[i].columns, &line, &column);
    assert_int_equal(line, 2);
    assert_int_equal(column, 1);
  }
  // A position within a character is that of the character.
  assert_int_equal(cag_document_offset(w, "a", 1, 2, CAG_COLUMNS_UTF16), 5);
  assert_int_equal(cag_document_offset(w, "a", 1, 3, CAG_COLUMNS_UTF8), 5);
  cag_workspace_free(w);
}

static void an_unknown_document_has_no_answers(void **state) {
  (void)state;
  Found f = {0};
  CagWorkspace *w = cag_workspace_new(NULL);
  size_t length, line, column;
  CagDocumentUse use;
  char why[100];
  assert_null(cag_document_text(w, "/no/such.cag", &length));
  assert_int_equal(cag_document_check(w, "/no/such.cag", take_problem, &f), CAG_STATUS_FILE);
  cag_document_symbols(w, "none", take_symbol, &f);
  cag_document_complete(w, "none", 3, take_label, &f);
  cag_document_definition(w, "none", 3, take_place, &f);
  cag_document_references(w, "none", 3, true, take_place, &f);
  assert_false(cag_document_format(w, "none", 0, SIZE_MAX, take_edit, &f));
  assert_false(cag_document_rename(w, "none", 0, "x", take_edit, &f, why, sizeof why));
  assert_false(cag_document_use(w, "none", &use));
  cag_document_position(w, "none", 5, CAG_COLUMNS_UTF8, &line, &column);
  assert_int_equal(line + column, 0);
  assert_int_equal(f.count, 0);
  // So has a place beyond the end.
  cag_workspace_open(w, "a", "x = 1\n", 6);
  cag_document_complete(w, "a", 7, take_label, &f);
  cag_document_definition(w, "a", 1000, take_place, &f);
  assert_int_equal(f.count, 0);
  cag_workspace_free(w);
}

static void an_open_document_replaces_its_file(void **state) {
  (void)state;
  Found f;
  char folder[] = "/tmp/cag-document-XXXXXX", file[64], other[64];
  assert_non_null(mkdtemp(folder));
  snprintf(file, sizeof file, "%s/a.cag", folder);
  snprintf(other, sizeof other, "%s/b.cag", folder);
  FILE *out = fopen(other, "w");
  fputs("x = 1\n", out);
  fclose(out);
  CagWorkspace *w = workspace(file, "import b: x\nprint x\n");
  assert_string_equal(problems_of(w, file, &f), "");
  assert_true(cag_workspace_open(w, other, "y = 1\n", 6));
  assert_true(cag_document_is_stale(w, file));
  assert_string_equal(problems_of(w, file, &f), "E0245");
  cag_workspace_close(w, other);
  assert_string_equal(problems_of(w, file, &f), "");
  // The name is found in the file, and its uses in both.
  f = (Found){0};
  cag_workspace_add_file(w, other);
  cag_document_references(w, file, 10, true, take_place, &f);
  assert_int_equal(f.count, 3);
  cag_workspace_free(w);
  unlink(other);
  rmdir(folder);
}

static void a_module_of_the_library_is_a_document(void **state) {
  (void)state;
  Found f = {0};
  CagWorkspace *w = workspace("a", "import std.materials: brass\nprint brass\n");
  cag_document_symbols(w, "std.materials", take_symbol, &f);
  assert_non_null(strstr(f.text, "brass"));
  f = (Found){0};
  cag_document_definition(w, "a", 36, take_place, &f);
  assert_int_equal(strncmp(f.text, "std.materials:", 14), 0);
  assert_null(cag_document_text(w, "std.nothing", &(size_t){0}));
  cag_workspace_free(w);
}

static void take_action(void *context, const CagActionView *a) {
  if (a->kind != CAG_ACTION_FIX) return;
  add(context, a->title);
  for (size_t i = 0; i < a->edit_count; i++) {
    char text[200];
    snprintf(text, sizeof text, "%zu-%zu=%s", a->edits[i].place.start, a->edits[i].place.end,
             a->edits[i].text);
    add(context, text);
  }
}

static void names_of_patterns_are_symbols_with_references(void **state) {
  (void)state;
  Found f = {0};
  // Offsets: width 1 and 37, x 13, 35.
  const char text[] = "{width, at: [x, ..._]} = box\nprint x, width\nbox = {width: 1, at: [2]}\n";
  CagWorkspace *w = workspace("a", text);
  const size_t width = (size_t)(strstr(text, ", width\n") - text) + 2;
  cag_document_symbols(w, "a", take_symbol, &f);
  assert_string_equal(f.text, "width;x;box;width;at");
  f = (Found){0};
  cag_document_definition(w, "a", width, take_place, &f);
  assert_string_equal(f.text, "a:1-6");
  f = (Found){0};
  cag_document_references(w, "a", 13, true, take_place, &f);
  assert_string_equal(f.text, "a:13-14;a:35-36");
  // The name of a field stays when the name that it defines is changed.
  char why[200];
  for (size_t k = 0; k < 2; k++) {
    f = (Found){0};
    assert_true(cag_document_rename(w, "a", k ? 3 : width, "w", take_edit, &f, why, sizeof why));
    assert_string_equal(f.text, "width: w;w");
  }
  f = (Found){0};
  assert_true(cag_document_rename(w, "a", 13, "left", take_edit, &f, why, sizeof why));
  assert_string_equal(f.text, "left;left");
  cag_workspace_free(w);
}

static void fields_are_proposed_in_a_pattern(void **state) {
  (void)state;
  Found f = {0};
  CagWorkspace *w = workspace("a", "box = {width: 1, at: [2]}\n{wi, at: [x]} = box\n");
  cag_document_complete(w, "a", 29, take_label, &f); // after `wi`
  assert_string_equal(f.text, "width");
  f = (Found){0};
  cag_document_complete(w, "a", 37, take_label, &f); // after `x`, a new name
  assert_string_equal(f.text, "");
  cag_workspace_free(w);
}

static const char *fixes_of(const char *text, size_t at, Found *f) {
  CagWorkspace *w = workspace("a", text);
  *f = (Found){0};
  cag_document_actions(w, "a", at, at, take_action, f);
  cag_workspace_free(w);
  return f->text;
}

static void an_unused_name_is_removed_from_its_pattern(void **state) {
  (void)state;
  Found f;
  assert_string_equal(fixes_of("[x, y] = [1, 2]\nprint x\n", 4, &f), "Remove the unused y;4-5=_");
  assert_string_equal(fixes_of("[x, ...y] = [1, 2]\nprint x\n", 7, &f),
                      "Remove the unused y;7-8=_");
  assert_string_equal(fixes_of("{x, y} = {x: 1, y: 2}\nprint x\n", 4, &f),
                      "Remove the unused y;2-5=");
  assert_string_equal(fixes_of("{x, y: z} = {x: 1, y: 2}\nprint z\n", 1, &f),
                      "Remove the unused x;1-4=");
  assert_string_equal(fixes_of("[x, _] = [1, 2]\nprint 1\n", 1, &f), "Remove the unused x;0-16=");
}

static void a_check_has_limits_and_can_be_interrupted(void **state) {
  (void)state;
  Found f = {0};
  volatile int interrupt = 1;
  CagSessionOptions o;
  cag_session_options_init(&o);
  o.interrupt = &interrupt;
  CagWorkspace *w = cag_workspace_new(&o);
  cag_workspace_open(w, "a", "print x\n", 8);
  assert_int_equal(cag_document_check(w, "a", take_problem, &f), CAG_STATUS_INTERRUPTED);
  assert_true(cag_document_is_stale(w, "a")); // it is checked again later
  interrupt = 0;
  assert_int_equal(cag_document_check(w, "a", take_problem, &f), CAG_STATUS_SCRIPT);
  assert_string_equal(f.text, "E0201");
  cag_workspace_free(w);
  interrupt = 0;
  o.max_memory = 1000; // too little for the built-ins
  w = cag_workspace_new(&o);
  cag_workspace_open(w, "a", "print x\n", 8);
  assert_int_equal(cag_document_check(w, "a", take_problem, &f), CAG_STATUS_LIMIT);
  assert_false(cag_document_is_stale(w, "a")); // a second check would fail as well
  cag_workspace_free(w);
}

static void colors_are_written_as_short_as_possible(void **state) {
  (void)state;
  char text[16];
  cag_color_text((const double[3]){0, 2.0 / 3, 1}, text, sizeof text);
  assert_string_equal(text, "\"#0af\"");
  cag_color_text((const double[3]){0.5, -1, 2}, text, sizeof text);
  assert_string_equal(text, "\"#8000ff\"");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(changes_replace_bytes_and_make_the_document_stale),
      cmocka_unit_test(positions_count_columns_in_three_ways),
      cmocka_unit_test(an_unknown_document_has_no_answers),
      cmocka_unit_test(an_open_document_replaces_its_file),
      cmocka_unit_test(a_module_of_the_library_is_a_document),
      cmocka_unit_test(names_of_patterns_are_symbols_with_references),
      cmocka_unit_test(fields_are_proposed_in_a_pattern),
      cmocka_unit_test(an_unused_name_is_removed_from_its_pattern),
      cmocka_unit_test(a_check_has_limits_and_can_be_interrupted),
      cmocka_unit_test(colors_are_written_as_short_as_possible),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
