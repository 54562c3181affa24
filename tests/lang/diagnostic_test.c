// Rendering of diagnostics: text, color, JSON, long and wide lines, and notes. Also the search for
// the nearest name.

#include "support.h"

// A diagnostic at bytes [start, end) of a text, rendered.
static char *rendered(const char *text, uint32_t start, uint32_t end, const char *help,
                      CagDiagnosticStyle style) {
  CagSource *source = cag_source_new("spring.cag", text, strlen(text));
  CagDiagnostics list = {0};
  CagDiagnostic *d = cag_diagnostics_add(&list, CAG_ERR_unknown_name, source, (CagSpan){start, end},
                                         "it \"is\"\twrong");
  if (help) cag_diagnostic_set_help(d, "%s", help);
  char *out;
  size_t size;
  FILE *f = open_memstream(&out, &size);
  cag_diagnostics_render(&list, style, f);
  fclose(f);
  cag_diagnostics_clear(&list);
  cag_source_free(source);
  return out;
}

static void expect_rendered(const char *text, uint32_t start, uint32_t end, const char *help,
                            const char *wanted) {
  char *out = rendered(text, start, end, help, CAG_DIAGNOSTIC_TEXT);
  assert_string_equal(out, wanted);
  free(out);
}

// The example in section 6 of the language's description.
static void the_example_of_the_language_is_met_exactly(void **state) {
  (void)state;
  const char *head = "\n\n\n\n\n\n\n\n\n\n\n";
  char text[256];
  snprintf(text, sizeof text, "%s  [r * cos(a), sin(30), 0]\n\n\n\n\n\n\n\nx = 1 + coil(3)\n",
           head);
  CagSource *source = cag_source_new("spring.cag", text, strlen(text));
  uint32_t at = (uint32_t)(strstr(text, "30") - text);
  uint32_t from = (uint32_t)(strstr(text, "coil") - text); // column 9 of line 20
  CagDiagnostics list = {0};
  CagDiagnostic *d = cag_diagnostics_add(&list, CAG_ERR_unknown_name, source, (CagSpan){at, at + 2},
                                         "sin expects an angle, found the number 30");
  cag_diagnostic_set_help(d, "write 30deg or 30rad");
  cag_diagnostic_add_note(d, CAG_NOTE_CALL, source, (CagSpan){from, from + 4}, "coil");
  char *out;
  size_t size;
  FILE *f = open_memstream(&out, &size);
  cag_diagnostic_render(&list.items[0], CAG_DIAGNOSTIC_TEXT, f);
  fclose(f);
  assert_string_equal(out, "error: sin expects an angle, found the number 30\n"
                           "  --> spring.cag:12:20\n"
                           "   |\n"
                           "12 |   [r * cos(a), sin(30), 0]\n"
                           "   |                    ^^ write 30deg or 30rad\n"
                           "   = called from spring.cag:20:9 in coil\n");
  free(out);
  cag_diagnostics_clear(&list);
  cag_source_free(source);
}

static void tabs_and_wide_characters_keep_the_carets_in_place(void **state) {
  (void)state;
  expect_rendered(
      "\tx = y", 5, 6, NULL,
      "error: it \"is\"\twrong\n --> spring.cag:1:6\n  |\n1 |     x = y\n  |         ^\n");
  // two characters that are two columns wide each
  expect_rendered("\xe6\xbc\xa2\xe5\xad\x97 = y", 9, 10, NULL,
                  "error: it \"is\"\twrong\n --> spring.cag:1:6\n  |\n"
                  "1 | \xe6\xbc\xa2\xe5\xad\x97 = y\n  |        ^\n");
  // e and a combining accent take one column
  expect_rendered(
      "e\xcc\x81 = y", 6, 7, NULL,
      "error: it \"is\"\twrong\n --> spring.cag:1:6\n  |\n1 | e\xcc\x81 = y\n  |     ^\n");
  // Invalid UTF-8, and control characters, including DEL.
  expect_rendered("a\xff\x01 = y", 1, 2, NULL,
                  "error: it \"is\"\twrong\n --> spring.cag:1:2\n  |\n"
                  "1 | a\xef\xbf\xbd\xef\xbf\xbd = y\n  |  ^\n");
  expect_rendered("a\x7f\x1f~ = y", 3, 4, NULL,
                  "error: it \"is\"\twrong\n --> spring.cag:1:4\n  |\n"
                  "1 | a\xef\xbf\xbd\xef\xbf\xbd~ = y\n  |    ^\n");
}

static void empty_spans_ends_and_many_lines_are_shown(void **state) {
  (void)state;
  expect_rendered("x =", 3, 3, "a value",
                  "error: it \"is\"\twrong\n --> spring.cag:1:4\n  |\n1 | x =\n  |    ^ a value\n");
  expect_rendered("", 0, 0, NULL,
                  "error: it \"is\"\twrong\n --> spring.cag:1:1\n  |\n1 |\n  | ^\n");
  expect_rendered("x = [1,\r\n 2]\r\n", 4, 13, NULL,
                  "error: it \"is\"\twrong\n --> spring.cag:1:5\n  |\n1 | x = [1,\n  |     ^^^\n");
}

static void a_long_line_is_cut_around_the_span(void **state) {
  (void)state;
  size_t size = 10000001;
  char *text = malloc(size);
  memset(text, 'a', size - 1);
  text[size - 1] = 0;
  memcpy(text + 5000000, "HERE", 4);
  char *out = rendered(text, 5000000, 5000004, "mend", CAG_DIAGNOSTIC_TEXT);
  char wanted[1024] = "error: it \"is\"\twrong\n --> spring.cag:1:5000001\n  |\n1 | ...";
  memset(wanted + strlen(wanted), 'a', 40);
  strcat(wanted, "HERE");
  size_t n = strlen(wanted);
  memset(wanted + n, 'a', 56);
  strcpy(wanted + n + 56, "...\n  | ");
  n = strlen(wanted);
  memset(wanted + n, ' ', 43);
  strcpy(wanted + n + 43, "^^^^ mend\n");
  assert_string_equal(out, wanted);
  free(out);
  free(text);
}

static void json_is_one_object_on_one_line(void **state) {
  (void)state;
  char *out = rendered("a\nxy = \"\xc3\xa9\" + z", 12, 13, "a \\ b", CAG_DIAGNOSTIC_JSON);
  assert_string_equal(
      out, "{\"severity\":\"error\",\"code\":\"E0201\",\"reason\":\"unknown-name\","
           "\"message\":\"it \\\"is\\\"\\twrong\",\"file\":\"spring.cag\",\"line\":2,\"column\":10,"
           "\"end_line\":2,\"end_column\":11,\"help\":\"a \\\\ b\",\"related\":[]}\n");
  free(out);
}

static void json_has_the_related_places(void **state) {
  (void)state;
  Parsed p = resolve_text("a = 1\na = 2\n");
  const char *out = messages_of(&p, CAG_DIAGNOSTIC_JSON);
  assert_non_null(strstr(out,
                         "\"related\":[{\"message\":\"first defined here\",\"file\":\"test.cag\","
                         "\"line\":1,\"column\":1}]}\n"));
  release(&p);
}

static void colour_marks_the_same_text(void **state) {
  (void)state;
  char *out = rendered("x = y", 4, 5, "mend", CAG_DIAGNOSTIC_COLOR), *to = out;
  assert_non_null(strstr(out, "\033[1;31merror\033[0m"));
  for (const char *from = out; *from;) { // without escape sequences, it is the plain form
    if (*from == '\033') from = strchr(from, 'm') + 1;
    else *to++ = *from++;
  }
  *to = 0;
  char *plain = rendered("x = y", 4, 5, "mend", CAG_DIAGNOSTIC_TEXT);
  assert_string_equal(out, plain);
  free(plain);
  free(out);
}

static void notes_say_calls_tail_calls_and_what_is_left_out(void **state) {
  (void)state;
  CagSource *source = cag_source_new("a.cag", "f(1)\n", 5);
  CagDiagnostics list = {0};
  CagDiagnostic *d =
      cag_diagnostics_add(&list, CAG_ERR_unknown_name, NULL, (CagSpan){0, 0}, "no place");
  cag_diagnostic_set_help(d, "a mend");
  cag_diagnostic_add_note(d, CAG_NOTE_CALL, source, (CagSpan){0, 4}, "f");
  cag_diagnostic_add_note(d, CAG_NOTE_TAIL_CALL, source, (CagSpan){2, 3}, "g");
  cag_diagnostic_add_note(d, CAG_NOTE_OMITTED, NULL, (CagSpan){0, 0}, "9,980 more calls");
  cag_diagnostic_add_note(d, CAG_NOTE_CALL, source, (CagSpan){0, 4}, "%s", "");
  char *out;
  size_t size;
  FILE *f = open_memstream(&out, &size);
  cag_diagnostics_render(&list, CAG_DIAGNOSTIC_TEXT, f);
  fclose(f);
  assert_string_equal(out,
                      "error: no place\n  = a mend\n  = called from a.cag:1:1 in f\n"
                      "  = called from a.cag:1:3 in g (tail call)\n  = ... 9,980 more calls ...\n"
                      "  = called from a.cag:1:1\n");
  free(out);
  cag_diagnostics_clear(&list);
  cag_source_free(source);
}

static void the_list_keeps_twenty_and_counts_the_rest(void **state) {
  (void)state;
  CagDiagnostics a = {0}, b = {0};
  for (int i = 0; i < 15; i++) {
    cag_diagnostics_add(&a, CAG_ERR_unknown_name, NULL, (CagSpan){0, 0}, "%d", i);
    cag_diagnostics_add(&b, CAG_ERR_unknown_name, NULL, (CagSpan){0, 0}, "%d", i);
  }
  cag_diagnostics_move(&a, &b);
  assert_int_equal(a.count, CAG_DIAGNOSTICS_MAX);
  assert_int_equal(a.dropped, 10);
  assert_int_equal(b.count, 0);
  CagDiagnostic *thrown = cag_diagnostics_add(&a, CAG_ERR_unknown_name, NULL, (CagSpan){0, 0}, "x");
  assert_non_null(thrown);
  assert_int_equal(a.dropped, 11);
  cag_diagnostic_set_help(thrown, "y");
  cag_diagnostic_add_note(thrown, CAG_NOTE_CALL, NULL, (CagSpan){0, 0}, "z");
  cag_diagnostics_clear(&a);
  cag_diagnostics_clear(&b);
}

static void a_longer_list_is_sorted_and_keeps_the_order_of_equals(void **state) {
  (void)state;
  CagDiagnostics list = {.most = 1000}, other = {.most = 1000};
  for (uint32_t i = 0; i < 997; i++) { // 61 * i mod 100 has each start about ten times
    const CagSpan span = {61 * i % 100, 100};
    cag_diagnostics_add(i % 2 ? &list : &other, CAG_ERR_unknown_name, NULL, span, "%u", i);
  }
  cag_diagnostics_move(&list, &other);
  assert_int_equal(list.count, 997);
  for (int i = 0; i < 5; i++)
    cag_diagnostics_add(&list, CAG_ERR_unknown_name, NULL, (CagSpan){0, 0}, "last");
  assert_int_equal(list.count, 1000);
  assert_int_equal(list.dropped, 2);
  cag_diagnostics_sort(&list, 0);
  for (size_t i = 1; i < list.count; i++) {
    const CagDiagnostic *a = cag_diagnostics_at(&list, i - 1), *b = cag_diagnostics_at(&list, i);
    assert_true(a->span.start <= b->span.start);
    if (a->span.start < b->span.start || !strcmp(b->message, "last")) continue;
    const int first = atoi(a->message), second = atoi(b->message); // odd ones were added first
    assert_true(first % 2 == second % 2 ? first < second : first % 2 == 1);
  }
  cag_diagnostics_clear(&list);
}

static void the_nearest_name_is_within_a_third(void **state) {
  (void)state;
  const char *const names[] = {"height", "width", "material", "sin", "is_watertight"};
  assert_string_equal(cag_nearest_name("hieght", names, 5), "height"); // two letters are exchanged
  assert_string_equal(cag_nearest_name("Width", names, 5), "width");
  assert_string_equal(cag_nearest_name("metarials", names, 5), "material");
  assert_string_equal(cag_nearest_name("sn", names, 5), "sin");
  assert_null(cag_nearest_name("depth", names, 5));
  assert_null(cag_nearest_name("x", names, 5));
}

static void lines_and_columns_count_code_points(void **state) {
  (void)state;
  CagSource *s = cag_source_new("", "a\n\xc3\xa9\xe6\xbc\xa2z\n", 9);
  CagPosition p = cag_source_position(s, 7);
  assert_int_equal(p.line, 2);
  assert_int_equal(p.column, 3);
  p = cag_source_position(s, 9);
  assert_int_equal(p.line, 3);
  assert_int_equal(p.column, 1);
  size_t length;
  assert_memory_equal(cag_source_line(s, 1, &length), "a", 1);
  assert_int_equal(length, 1);
  cag_source_free(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_example_of_the_language_is_met_exactly),
      cmocka_unit_test(tabs_and_wide_characters_keep_the_carets_in_place),
      cmocka_unit_test(empty_spans_ends_and_many_lines_are_shown),
      cmocka_unit_test(a_long_line_is_cut_around_the_span),
      cmocka_unit_test(json_is_one_object_on_one_line),
      cmocka_unit_test(json_has_the_related_places),
      cmocka_unit_test(colour_marks_the_same_text),
      cmocka_unit_test(notes_say_calls_tail_calls_and_what_is_left_out),
      cmocka_unit_test(the_list_keeps_twenty_and_counts_the_rest),
      cmocka_unit_test(a_longer_list_is_sorted_and_keeps_the_order_of_equals),
      cmocka_unit_test(the_nearest_name_is_within_a_third),
      cmocka_unit_test(lines_and_columns_count_code_points),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
