// Syntax errors: recovery, open brackets, syntax of other languages, and limits.

#include "support.h"

static void the_parser_goes_on_at_the_next_statement(void **state) {
  (void)state;
  expect_errors("x = 1 +* 2\n  y\nz = 3 $\nw = 4\nv = * 5\n", "E0120 1:8, E0102 3:7, E0120 5:5");
}

static void an_open_bracket_is_reported_where_it_was_opened(void **state) {
  (void)state;
  expect_errors("x = [1, 2\ny = 3\n", "E0123 1:5");
  expect_errors("x = [1,\ny = 3\n", "E0123 1:5");
  expect_errors("x = { a: 1,\ny = 3\n", "E0123 1:5");
  expect_errors("f(x) = max(x, (1 + 2\nshow f(1)\n", "E0123 1:15");
  expect_errors("f(x) = {\n  a = 1\n  a\nshow f(1)\n", "E0123 1:8");
  expect_errors("x = f(1", "E0123 1:6");
  expect_errors("x = (1 + * [2\ny = 3", "E0120 1:10, E0123 1:12");
}

static void a_wrong_bracket_names_the_open_one(void **state) {
  (void)state;
  expect_errors("x = [1, 2)\ny = 1 $\n", "E0124 1:10, E0102 2:7");
  expect_errors("x = 1)\n", "E0125 1:6");
  Parsed p = parse_text("x = f([1)\n");
  assert_int_equal(p.errors.items[0].notes[0].span.start, 6);
  release(&p);
}

static void twenty_errors_are_kept(void **state) {
  (void)state;
  char text[4096] = "";
  for (int i = 0; i < 100; i++) strcat(text, "x = $\n");
  Parsed p = parse_text(text);
  assert_int_equal(p.errors.count, CAG_DIAGNOSTICS_MAX);
  release(&p);
}

static void habits_of_other_languages_get_their_mend(void **state) {
  (void)state;
  expect_help("x = !true", "E0154", "not");
  expect_help("x = true && false", "E0155", "and");
  expect_help("x = true || false", "E0155", "or");
  expect_help("x = true ? 1 : 2", "E0156", "if true then 1 else 2");
  expect_help("x = 'text'", "E0108", "\"text\"");
  expect_help("print(1, 2)", "E0157", "print 1, 2");
  expect_help("a = 1\nprint(a, 2)", "E0157", "print a, 2");
  expect_help("x = 1\nx += 1", "E0151", "x2 = x + ...");
  expect_help("max(1, 2)", "E0150", "print max(1, 2)");
  expect_help("x == 3", "E0150", "to define x, write =");
  expect_help("x = if 1 = 2 then 3 else 4", "E0153", "==");
  expect_help("let x = 1", "E0152", "let");
  expect_help("def f(x) = x", "E0152", "def");
  expect_help("var x = 1", "E0152", "var");
  expect_help("function f(x) = x", "E0152", "function");
  expect_help("x = 2 ** 3", "E0158", "^");
  expect_help("x = if true then 1 elif false then 2 else 3", "E0159", "else if");
  expect_help("f(x) = {\n return x\n}", "E0160", "block");
  expect_help("x = 1 # one", "E0115", "//");
  expect_help("x = True", "E0201", "true");
  expect_help("x = null", "E0201", "none");
  expect_help("for i in 0..3: print i", "E0161", "show [for i in 0..3: ");
  expect_help("while x < 3", "E0161", "reduce");
  expect_help("x = 1 if true else 2", "E0162", "if c then 1 else b");
  expect_help("x = [1 for i in 0..3]", "E0163", "[for x in xs: 1]");
  expect_help("x = 3 not in [1]", "E0164", "not (3 in xs)");
  expect_help("x = max(a = 1)", "E0165", "a: value");
  expect_help("x = 1 === 1", "E0166", "==");
  expect_help("x = 1 <> 1", "E0166", "!=");
  expect_help("f = x -> x", "E0166", "=>");
  expect_help("x := 3", "E0166", "=");
  expect_help("y = 1\nx = \"{y:.2f}\"", "E0167", "text(y, digits: 2)");
  expect_help("x = (1, 2)", "E0140", "[1, 2]");
  expect_help("x = {1, 2}", "E0140", "[ ]");
  expect_help("x = [1, 2][1..]", "E0142", "1..-1");
  expect_help("x = 1 + if true then 1 else 2", "E0136", "(if true then 1 else 2)");
  expect_help("x = 1 |> y => y", "E0136", "(y => y)");
  expect_help("x = 3 × 4", "E0102", "*");
  expect_help("f(x: number) = x", "E0126", "no types");
  expect_help("x = max(...[1])", "E0143", "each argument");
}

// After syntax of another language, the parser continues: there is one error each, and no
// subsequent errors.
static void a_mended_habit_leaves_no_further_error(void **state) {
  (void)state;
  expect_errors("x = !true && false\nlet y = 2 ** 3 # c\nprint('a', y)\n",
                "E0154 1:5, E0155 1:11, E0152 2:1, E0158 2:11, E0115 2:16, E0157 3:6, E0108 3:7");
}

static void a_missing_value_is_reported_at_the_end_of_its_line(void **state) {
  (void)state;
  expect_errors("x =\ny = 4\n", "E0120 1:3");
  expect_errors("x = 3 +\ny = 4\n", "E0120 1:7");
  expect_errors("x = {\n a =\n b = 2\n a\n}\n", "E0120 2:4");
  expect_errors("x =", "E0120 1:4");
}

static char *repeated(const char *head, const char *unit, size_t n, const char *middle,
                      const char *closer, size_t closers) {
  size_t size = strlen(head) + n * strlen(unit) + strlen(middle) + closers * strlen(closer) + 2;
  char *text = malloc(size), *p = text;
  p += sprintf(p, "%s", head);
  for (size_t i = 0; i < n; i++) p += sprintf(p, "%s", unit);
  p += sprintf(p, "%s", middle);
  for (size_t i = 0; i < closers; i++) p += sprintf(p, "%s", closer);
  return text;
}

static void expect_limit(size_t n, const char *unit, const char *closer, const char *errors) {
  char *text = repeated("x = ", unit, n, "1", closer, *closer ? n : 0);
  expect_errors(text, errors);
  free(text);
}

static void brackets_nest_a_thousand_deep(void **state) {
  (void)state;
  expect_limit(1000, "(", ")", "");
  expect_limit(1001, "(", ")", "E0127 1:1005");
  expect_limit(1000, "[", "]", "");
  expect_limit(1000, "{", "}", "");
  expect_limit(1000, "\"{", "}\"", "");
  expect_limit(1001, "\"{", "}\"", "E0127 1:2005");
  expect_limit(100000, "[", "]", "E0127 1:1005");
  expect_limit(100000, "{a: ", "}", "E0127 1:4005");
  expect_limit(100000, "max(", "", "E0127 1:4008");
}

static void chains_without_brackets_are_bounded_too(void **state) {
  (void)state;
  expect_limit(100000, "-", "", "E0127 1:1006");
  expect_limit(100000, "2^", "", "E0127 1:2007");
  expect_limit(100000, "a => ", "", "E0127 1:5010");
  expect_limit(3000, "1 + ", "", "");
  expect_limit(3000, "if true then 1 else ", "", "");
  Parsed p;
  char *text = repeated("x = 1", " + 1", 1000000, "", "", 0);
  p = parse_text(text);
  assert_int_equal(p.errors.count, 1);
  assert_string_equal(cag_error_info(p.errors.items[0].id)->code, "E0128");
  release(&p);
  free(text);
}

static void a_long_line_is_no_burden(void **state) {
  (void)state;
  char *text = repeated("x = [", "1, ", 3000000, "2", "]", 1);
  expect_errors(text, "");
  free(text);
  text = repeated("x = \"", "0123456789", 1000000, "\" $", "", 0);
  expect_errors(text, "E0102 1:10000008");
  free(text);
}

// A small generator, so that every run has the same texts.
static uint32_t next_random(uint32_t *seed) {
  *seed ^= *seed << 13;
  *seed ^= *seed >> 17;
  *seed ^= *seed << 5;
  return *seed;
}

// A text, with everything open in it, ends at the end of its line, but a bracket before it does
// not. `1 2` is an error in each of them.
static void a_text_that_is_open_is_no_open_bracket(void **state) {
  (void)state;
  uint32_t seed = 88172645u;
  for (int round = 0; round < 300; round++) {
    char line[128] = "x = ", expected[64] = "";
    const uint32_t before = next_random(&seed) % 5, within = next_random(&seed) % 5;
    for (uint32_t i = 0; i < before; i++) strcat(line, next_random(&seed) % 2 ? "(" : "[");
    if (before) snprintf(expected, sizeof expected, "E0123 1:%zu, ", strlen(line));
    strcat(line, "\"a {");
    for (uint32_t i = 0; i < within; i++) {
      static const char *const openers[] = {"(", "[", "\"b {"};
      strcat(line, openers[next_random(&seed) % 3]);
    }
    strcat(line, "1 2");
    const size_t n = strlen(expected);
    snprintf(expected + n, sizeof expected - n, "E0126 1:%zu", strlen(line));
    strcat(line, "\ny = 3\n");
    expect_errors(line, expected);
  }
}

static void damaged_texts_neither_crash_nor_hang(void **state) {
  (void)state;
  static const char good[] =
      "/// doc\nimport std.materials as mat: glazed\nparam h = 120 in 50..300 \"height\"\n"
      "f(a, b = 2) = { c = a + b; assert c > 0, \"m{c}\"\n c ^ -2 }\n"
      "xs = [for [k, _] in {a: 1, \"b\": 2} if k != \"a\": \"{k} {\"x{1}\"}\"]\n"
      "g = (x, y) => if x then y else not x |> f(1, k: 0..<5 by 2)[1..-1].z\n"
      "show `raw` + 45deg /* c /* d */ */\nprint xs == 1 and g or -h, 'q' // end\n";
  static const char pieces[] = "()[]{}\"`'\\\n,:;.=<>+-*/%|&^!?#_ \xc3\xa9\xffxif0";
  uint32_t seed = 2463534242u;
  for (int round = 0; round < 4000; round++) {
    char text[sizeof good];
    size_t length = sizeof good - 1;
    memcpy(text, good, sizeof good);
    for (uint32_t edits = 1 + next_random(&seed) % 8; edits; edits--) {
      size_t at = next_random(&seed) % length;
      if (next_random(&seed) % 4 == 0 && length > 20) {
        memmove(text + at, text + at + 1, length - at - 1);
        length--;
      } else {
        text[at] = pieces[next_random(&seed) % (sizeof pieces - 1)];
      }
    }
    if (next_random(&seed) % 3 == 0) length = 1 + next_random(&seed) % length;
    Parsed p = parse_bytes(text, length, round % 2 ? CAG_PARSE_FILE : CAG_PARSE_REPL);
    CagResolveEnv env = test_env();
    cag_resolve(p.module, &env, &p.errors); // a damaged tree too
    messages_of(&p, round % 3 ? CAG_DIAGNOSTIC_TEXT : CAG_DIAGNOSTIC_JSON);
    tree_of(&p);
    cag_parse_incomplete(text, length);
    release(&p);
  }
}

// The first error of a text: its code, the span between « and », and the contents of its message
// and its help. "" means that there is no help.
static void syntax_errors_mark_what_is_wrong(void **state) {
  (void)state;
  static const struct {
    const char *text, *code, *message, *help;
  } rows[] = {
      {"x «=»\ny = 2", "E0120", "expected an expression after `=`", ""},
      {"x = 1 +«»", "E0120", "expected an expression after `+`", ""},
      {"x = «+»1", "E0120", "expected an expression, found `+`", "remove the +"},
      {"x = f(1, «,» 2)", "E0120", "expected an expression, found `,`", "remove one comma"},
      {"x = «show» 2", "E0120", "expected an expression, found the reserved word `show`",
       "it starts a statement"},
      {"x = «.5»", "E0111", "digits on both sides", "write 0.5"},
      {"x = xs[«..»3]", NULL, "this range has no start", "0..3"},
      {"x = «...»y", NULL, "only allowed in a list or a record", "[...xs, 4]"},
      {"x = «for» i in y", NULL, "`for` is only allowed in a list", "write [for x in xs: ...]"},
      {"x = «(1, 2)»", NULL, "a list is written in [ ]", "write [1, 2]"},
      {"x = «()»", NULL, "there is nothing in these parentheses", "an empty list is []"},
      {"print«(1, 2)»", NULL, "print is a statement", "write print 1, 2"},
      {"show «(a, b)»", NULL, "show is a statement", "write show a, b"},
      {"x = «{»1, 2}", NULL, "this brace opens a block, which has one value",
       "a list is written in [ ]"},
      {"x = { «\"a{1}\"»: 2 }", NULL, "the name of a field has no { } in it",
       "record([[name, value], ...])"},
      {"x = { a = 1 «}»", NULL, "this block has no value", "it ends with an expression"},
      {"x = { «a + 1»\nb }", NULL, "not the last expression of its block", "give it a name"},
      {"x = { «a»\n-b }", NULL, "not the last expression of its block",
       "a line that starts with `-`"},
      {"x = \"a«{}»\"", "E0113", "there is nothing in these { }", "contain an expression"},
      {"x = «[»1, 2\ny = 3", "E0123", "this bracket is not closed: `]` is missing", "opened here"},
      {"x = f«(»1", NULL, "this bracket is never closed: `)` is missing", "opened here"},
      {"x = 1«)»", NULL, "`)` closes nothing", "no bracket is open here"},
      {"x = [1«)»", NULL, "expected `]`, found `)`", "close the inner bracket first"},
      {"x = [1 «2»]", NULL, "expected `,` or `]`, found", "a comma or an operator is missing"},
      {"x = 1 «2»", NULL, "found", "an operator is missing before it, or a line break"},
      {"x = f(1«;» 2)", NULL, "found `;`", "separate the items in brackets with commas"},
      {"x = 1 «not in» xs", NULL, "`not in` is not an operator", "write not (1 in xs)"},
      {"x = 1 «if» y", NULL, "the condition comes before the value", "write if c then 1 else b"},
      {"x = y «for» z in xs", NULL, "in a comprehension, the loop comes first",
       "write [for x in xs: y]"},
      {"x = 3 «by» 2", NULL, "`by` needs a range before it", "write 0..10 by 2"},
      {"f = 1 «=>» 2", NULL, "expected the names of the parameters", "write x => e"},
      {"x = a «=» b", "E0153", "is not allowed here", "to compare, write =="},
      {"x = f(a «+=» 1)", NULL, "values cannot be changed", "define a new name"},
      {"x = \"{y«:»2}\"", "E0167", "without a format", "text(y, digits: 2)"},
      {"x = c «?» a : b", NULL, "", "write if c then a else b"},
      {"x = 1 + «if» c then 2 else 3", NULL, "in parentheses", "write (if c then 2 else 3)"},
      {"x = 2 * «y» => y", "E0136", "put a function in parentheses", "write (y => y)"},
  };
  size_t bad = 0;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    char text[200];
    const char *left = strstr(rows[i].text, "«"), *right = strstr(left, "»");
    const size_t before = (size_t)(left - rows[i].text), marked = (size_t)(right - left) - 2;
    snprintf(text, sizeof text, "%.*s%.*s%s", (int)before, rows[i].text, (int)marked, left + 2,
             right + 2);
    Parsed p = parse_text(text);
    const CagDiagnostic none = {.message = (char[]){""}};
    const CagDiagnostic *d = p.errors.count ? &p.errors.items[0] : &none;
    const char *help = d->help ? d->help : "";
    if (d->span.start != before || d->span.end != before + marked ||
        !strstr(d->message, rows[i].message) ||
        (*rows[i].help ? !strstr(help, rows[i].help) : *help != 0) ||
        (rows[i].code && strcmp(cag_error_info(d->id)->code, rows[i].code) != 0)) {
      print_error("%s: %s %u-%u: %s (%s)\n", text, cag_error_info(d->id)->code, d->span.start,
                  d->span.end, d->message, help);
      bad++;
    }
    release(&p);
  }
  assert_int_equal(bad, 0);
}

// Resolves names after syntax errors as well.
static Parsed resolve_damaged(const char *text) {
  Parsed p = parse_text(text);
  CagResolveEnv env = test_env();
  cag_resolve(p.module, &env, &p.errors);
  cag_diagnostics_sort(&p.errors, 0);
  return p;
}

static void expect_all_errors(const char *text, const char *errors) {
  Parsed p = resolve_damaged(text);
  assert_string_equal(errors_of(&p), errors);
  release(&p);
}

static void a_block_is_read_on_after_a_broken_line(void **state) {
  (void)state;
  // Each broken line has its error, and so has an unknown name in another line. Names that broken
  // lines may define are known.
  expect_all_errors("f(a) = {\n  x = a +* 2\n  y = x + b\n  y\n}\n", "E0120 2:10, E0201 3:11");
  expect_all_errors("f(a) = {\n  x 2 = a\n  y = x + b\n  y +\n}\nz = c\n",
                    "E0126 2:5, E0201 3:11, E0120 5:1, E0201 6:5");
  // A bracket that stays open ends with the line before the next line of the block.
  expect_all_errors("f(a) = {\n  x = max([a, 2\n  y = x + b\n  y\n}\n", "E0126 3:3, E0201 3:11");
  expect_all_errors("f(a) = { x = max([1, }\nz = c\n", "E0120 1:22, E0201 2:5");
  // An inner block ends before the outer one goes on.
  expect_all_errors("f(a) = {\n  x = {\n    y = a +* 1\n    y + b\n  }\n  x + c\n}\n",
                    "E0120 3:12, E0201 4:9, E0201 6:7");
}

static void names_of_a_damaged_statement_are_bound_without_errors(void **state) {
  (void)state;
  Parsed p = resolve_damaged("r = 2\nshow r * q, r +* 2\n");
  assert_int_equal(p.errors.count, 1);
  const CagExpr *product = p.module->statements[1]->as.list.items[0];
  assert_int_equal(product->as.binary.left->as.name.binding, CAG_BIND_DECL);
  assert_ptr_equal(product->as.binary.left->as.name.decl, p.module->tops[0]);
  assert_int_equal(product->as.binary.right->as.name.binding, CAG_BIND_NONE);
  release(&p);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(syntax_errors_mark_what_is_wrong),
      cmocka_unit_test(the_parser_goes_on_at_the_next_statement),
      cmocka_unit_test(an_open_bracket_is_reported_where_it_was_opened),
      cmocka_unit_test(a_wrong_bracket_names_the_open_one),
      cmocka_unit_test(twenty_errors_are_kept),
      cmocka_unit_test(habits_of_other_languages_get_their_mend),
      cmocka_unit_test(a_mended_habit_leaves_no_further_error),
      cmocka_unit_test(a_missing_value_is_reported_at_the_end_of_its_line),
      cmocka_unit_test(brackets_nest_a_thousand_deep),
      cmocka_unit_test(chains_without_brackets_are_bounded_too),
      cmocka_unit_test(a_long_line_is_no_burden),
      cmocka_unit_test(a_text_that_is_open_is_no_open_bracket),
      cmocka_unit_test(damaged_texts_neither_crash_nor_hang),
      cmocka_unit_test(a_block_is_read_on_after_a_broken_line),
      cmocka_unit_test(names_of_a_damaged_statement_are_bound_without_errors),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
