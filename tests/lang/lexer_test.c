// Words: numbers and units, names, texts, comments.

#include <math.h>

#include "lang/lexer.h"
#include "support.h"

static void numbers_have_digits_on_both_sides_of_the_point(void **state) {
  (void)state;
  value_is("1", "1");
  value_is("0.5", "0.5");
  value_is("1_000", "1000");
  value_is("6.02e23", "6.02e+23");
  value_is("1e-3", "0.001");
  value_is("0..5", "(.. 0 5)");
  value_is("0.5..1.5", "(.. 0.5 1.5)");
  value_is("0..<5", "(..< 0 5)");
  expect_mend("x = .5\n", "E0111", "0.5");
  expect_mend("x = 5.\n", "E0111", "5.0");
}

static double value_of(const char *number, CagExprKind kind) {
  char text[128];
  snprintf(text, sizeof text, "x = %s", number);
  Parsed p = parse_text(text);
  assert_int_equal(p.errors.count, 0);
  const CagExpr *e = p.module->statements[0]->as.definition.value;
  assert_int_equal(e->kind, kind);
  double v = e->as.number;
  release(&p);
  return v;
}

// Compared with what the C compiler makes of the same decimal number.
static void numbers_are_rounded_correctly(void **state) {
  (void)state;
  static const struct {
    const char *text;
    double value;
  } cases[] = {{"0.1", 0.1},
               {"123456789.123456789", 123456789.123456789},
               {"9007199254740993", 9007199254740993.0},
               {"1.7976931348623157e308", 1.7976931348623157e308},
               {"4.9e-324", 4.9e-324},
               {"2.2250738585072011e-308", 2.2250738585072011e-308},
               {"123456789012345678901234567890", 123456789012345678901234567890.0},
               {"0.000000000000000000000000000000123", 0.000000000000000000000000000000123},
               {"1e-400", 0}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    assert_true(value_of(cases[i].text, CAG_EXPR_NUMBER) == cases[i].value);
}

static void units_scale_before_rounding(void **state) {
  (void)state;
  static const struct {
    const char *text;
    double millimetres;
  } lengths[] = {{"10mm", 10},  {"2.5cm", 25},   {"2.3cm", 23},  {"1m", 1000},      {"25um", 0.025},
                 {"1in", 25.4}, {"0.1in", 2.54}, {"1ft", 304.8}, {"1.1ft", 335.28}, {"0.057m", 57}};
  for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++)
    assert_true(value_of(lengths[i].text, CAG_EXPR_NUMBER) == lengths[i].millimetres);
  assert_true(value_of("45deg", CAG_EXPR_ANGLE) == 45);
  assert_true(value_of("0.5turn", CAG_EXPR_ANGLE) == 180);
  assert_true(value_of("1.5rad", CAG_EXPR_ANGLE) ==
              85.943669269623482); // 1.5 * 180/pi to 17 digits
}

static void an_unknown_unit_gets_the_nearest(void **state) {
  (void)state;
  expect_mend("x = 45degrees", "E0109", "45deg");
  expect_mend("x = 3inch", "E0109", "3in");
  expect_mend("x = 3parsec", "E0109", "3 * parsec");
  expect_mend("x = 45°", "E0109", "45deg");
  expect_mend("x = 1_000_", "E0112", "1_000");
  expect_mend("x = 1e999", "E0110", "inf");
}

static void names_are_compared_after_nfc(void **state) {
  (void)state;
  // é as one character, and as e with a combining accent
  expect_tree("\xc3\xa9t\xc3\xa9 = 1\nx = e\xcc\x81t\xc3\xa9\n",
              "(= \xc3\xa9t\xc3\xa9 1)\n(= x \xc3\xa9t\xc3\xa9)");
  Parsed p = resolve_text("\xc3\xa9 = 1\nx = e\xcc\x81\nрадиус = 1\nθ = радиус\n");
  assert_string_equal(errors_of(&p), "");
  release(&p);
}

static void texts_know_their_escapes(void **state) {
  (void)state;
  Parsed p = parse_text("x = \"a \\\"q\\\" \\t\\n \\\\ \\u{3b8} \\{y\\}\"");
  const CagExpr *e = p.module->statements[0]->as.definition.value;
  assert_int_equal(e->kind, CAG_EXPR_TEXT);
  const char *wanted = "a \"q\" \t\n \\ \xce\xb8 {y}";
  assert_int_equal(e->as.text.length, strlen(wanted));
  assert_memory_equal(e->as.text.bytes, wanted, strlen(wanted));
  release(&p);
  value_is("`C:\\data {x}\nnext`", "\"C:\\\\data {x}\\nnext\"");
  expect_mend("x = \"\\x41\"", "E0106", "\\u{41}");
  expect_mend("x = \"\\u{d800}\"", "E0107", "hexadecimal");
}

static void texts_hold_expressions_to_any_depth(void **state) {
  (void)state;
  value_is("\"a{1}b\"", "(text \"a\" 1 \"b\")");
  value_is("\"{1}{2}\"", "(text \"\" 1 \"\" 2 \"\")");
  value_is("\"{ {a: \"x{1}\"}.a }\"", "(text \"\" (. (record (a (text \"x\" 1 \"\"))) a) \"\")");
  value_is("\"{f(\"{g(\"}\")}\")}\"", "(text \"\" (call f (text \"\" (call g \"}\") \"\")) \"\")");
}

static void a_text_ends_on_its_line(void **state) {
  (void)state;
  expect_errors("x = \"abc\ny = 3\n", "E0104 1:5");
  expect_errors("x = \"{1 +\n2}\"\ny = 3 $\n", "E0104 1:5, E0102 3:7");
  expect_errors("x = \"{`a\nb`}\"\n", "E0104 1:5");
}

static void comments_nest_and_count_as_blanks(void **state) {
  (void)state;
  expect_tree("/* a /* b */ c */ x = 1 // d\n", "(= x 1)");
  expect_tree("x = 1 + /* \n */ 2", "(= x (+ 1 2))");
  expect_errors("x = 1 /* /* */\n", "E0103 1:7");
  Parsed p = parse_text("// one\n/// two\nx = 1 /* three */\n");
  assert_int_equal(p.module->comment_count, 3);
  assert_false(p.module->comments[0].doc);
  assert_true(p.module->comments[1].doc);
  assert_true(p.module->comments[2].block);
  assert_string_equal(p.module->tops[0]->doc, "two");
  release(&p);
}

static void documentation_is_that_of_the_definition_which_follows(void **state) {
  (void)state;
  Parsed p = parse_text("/// first\n///  second\n/// \nf(x) = x\n\n//// no\ny = 2\n");
  assert_string_equal(p.module->tops[0]->doc, "first\n second\n");
  assert_null(p.module->tops[1]->doc);
  release(&p);
}

static void invalid_utf8_is_shown_where_it_stands(void **state) {
  (void)state;
  expect_errors("x = 1\ny = \"\xff\"\n", "E0101 2:6");
  expect_errors("x = \"\xc0\x80\"\n", "E0101 1:6");     // overlong
  expect_errors("x = \"\xed\xa0\x80\"\n", "E0101 1:6"); // surrogate
  expect_errors("x = \"\xe2\x82", "E0101 1:6");         // cut off
  Parsed p = parse_bytes("a = 1\0b", 7, CAG_PARSE_FILE);
  assert_string_equal(errors_of(&p), "E0101 1:6");
  release(&p);
}

static void a_byte_order_mark_and_other_spaces_are_blanks(void **state) {
  (void)state;
  expect_tree("\xef\xbb\xbfx = 1\r\ny\xc2\xa0= 2\r\n", "(= x 1)\n(= y 2)");
}

// ---- random words ----

static uint32_t seed;
static uint32_t chance(uint32_t n) {
  seed = seed * 1664525 + 1013904223;
  return (seed >> 8) % n;
}

typedef struct Word {
  const char *text;
  CagTokenKind kind;
  const char *holds; // of a text or a name: its bytes
  double number;
} Word;

static const Word words[] = {
    {"abc", CAG_TOKEN_NAME, "abc", 0},
    {"_x9", CAG_TOKEN_NAME, "_x9", 0},
    {"\xce\xb8_1", CAG_TOKEN_NAME, "\xce\xb8_1", 0},
    {"r\xc3\xa9z", CAG_TOKEN_NAME, "r\xc3\xa9z", 0},
    {"e\xcc\x81", CAG_TOKEN_NAME, "\xc3\xa9", 0}, // composed
    {"\xe6\xbc\xa2", CAG_TOKEN_NAME, "\xe6\xbc\xa2", 0},
    {"ZzAa", CAG_TOKEN_NAME, "ZzAa", 0},
    {"0", CAG_TOKEN_NUMBER, NULL, 0},
    {"17", CAG_TOKEN_NUMBER, NULL, 17},
    {"1_000.2_5", CAG_TOKEN_NUMBER, NULL, 1000.25},
    {"2.5e-3", CAG_TOKEN_NUMBER, NULL, 0.0025},
    {"2E+2", CAG_TOKEN_NUMBER, NULL, 200},
    {"1.5cm", CAG_TOKEN_NUMBER, NULL, 15},
    {"3um", CAG_TOKEN_NUMBER, NULL, 0.003},
    {"1e1in", CAG_TOKEN_NUMBER, NULL, 254},
    {"90deg", CAG_TOKEN_ANGLE, NULL, 90},
    {"0.25turn", CAG_TOKEN_ANGLE, NULL, 90},
    {"\"\"", CAG_TOKEN_TEXT, "", 0},
    {"\"a // b\"", CAG_TOKEN_TEXT, "a // b", 0},
    {"\"q\\\"\\\\\\n\\t\\{\\}\"", CAG_TOKEN_TEXT, "q\"\\\n\t{}", 0},
    {"\"\\u{41}\\u{3b8}\\u{10FFFF}\\u{00e9}\"", CAG_TOKEN_TEXT, "A\xce\xb8\xf4\x8f\xbf\xbf\xc3\xa9",
     0},
    {"`raw \\ {x} \n\"y\"`", CAG_TOKEN_TEXT, "raw \\ {x} \n\"y\"", 0},
    {"\"}\"", CAG_TOKEN_TEXT, "}", 0},
#define SIGN(text, name)                                                                           \
  { text, CAG_TOKEN_##name, NULL, 0 }
    SIGN("..<", RANGE_OPEN),
    SIGN("...", SPREAD),
    SIGN("..", RANGE),
    SIGN("==", EQUAL),
    SIGN("!=", NOT_EQUAL),
    SIGN("<=", LESS_EQUAL),
    SIGN(">=", GREATER_EQUAL),
    SIGN("=>", ARROW),
    SIGN("|>", PIPE),
    SIGN("+=", ASSIGN_OPERATOR),
    SIGN("-=", ASSIGN_OPERATOR),
    SIGN("*=", ASSIGN_OPERATOR),
    SIGN("/=", ASSIGN_OPERATOR),
    SIGN("%=", ASSIGN_OPERATOR),
    SIGN("^=", ASSIGN_OPERATOR),
    SIGN("|=", ASSIGN_OPERATOR),
    SIGN("&=", ASSIGN_OPERATOR),
    SIGN("(", LEFT_PAREN),
    SIGN(")", RIGHT_PAREN),
    SIGN("[", LEFT_SQUARE),
    SIGN("]", RIGHT_SQUARE),
    SIGN("{", LEFT_BRACE),
    SIGN("}", RIGHT_BRACE),
    SIGN(",", COMMA),
    SIGN(":", COLON),
    SIGN(";", SEMICOLON),
    SIGN(".", DOT),
    SIGN("=", EQUALS),
    SIGN("<", LESS),
    SIGN(">", GREATER),
    SIGN("+", PLUS),
    SIGN("-", MINUS),
    SIGN("*", STAR),
    SIGN("/", SLASH),
    SIGN("%", PERCENT),
    SIGN("|", BAR),
    SIGN("&", AMPERSAND),
    SIGN("^", CARET),
    SIGN("?", QUESTION),
    SIGN("and", AND),
    SIGN("as", AS),
    SIGN("assert", ASSERT),
    SIGN("by", BY),
    SIGN("else", ELSE),
    SIGN("false", FALSE),
    SIGN("for", FOR),
    SIGN("if", IF),
    SIGN("import", IMPORT),
    SIGN("in", IN),
    SIGN("none", NONE),
    SIGN("not", NOT),
    SIGN("or", OR),
    SIGN("param", PARAM),
    SIGN("print", PRINT),
    SIGN("show", SHOW),
    SIGN("then", THEN),
    SIGN("true", TRUE),
};

// What may stand between two words; lines: how many of them end there, comments: how many it has.
static const struct {
  const char *text;
  bool line;
  uint32_t comments;
} gaps[] = {{" ", false, 0},
            {" \t", false, 0},
            {"\n", true, 0},
            {"\r\n", true, 0},
            {"\xc2\xa0", false, 0}, // a no-break space
            {"\xe3\x80\x80", false, 0},
            {" /* c */ ", false, 1},
            {" /**/", false, 1},
            {" /* /* \"in\" */ ` */", false, 1},
            {" /* \n */", true, 1},
            {" // c\n", true, 1},
            {" /// doc\n", true, 1},
            {" //// c\r\n", true, 1}};

static void words_are_told_apart(void **state) {
  (void)state;
  seed = 11;
  for (int round = 0; round < 300; round++) {
    char text[4000] = "";
    const size_t count = chance(40);
    size_t which[40];
    uint32_t starts[40], ends[40], comments[40], seen = 0;
    bool lines[40];
    for (size_t i = 0; i < count; i++) {
      lines[i] = false;
      // One gap at least; a first line break is one as well.
      for (uint32_t n = 1 + chance(3); n > 0; n--) {
        const uint32_t g = chance(sizeof gaps / sizeof *gaps);
        strcat(text, gaps[g].text);
        lines[i] = lines[i] || gaps[g].line;
        seen += gaps[g].comments;
      }
      which[i] = chance(sizeof words / sizeof *words);
      comments[i] = seen;
      starts[i] = (uint32_t)strlen(text);
      strcat(text, words[which[i]].text);
      ends[i] = (uint32_t)strlen(text);
    }
    CagSource *source = cag_source_new("", text, strlen(text));
    CagArena arena = {0};
    CagNames names;
    CagLexer lexer;
    CagDiagnostics errors = {0};
    CagToken t;
    cag_names_init(&names, &arena);
    cag_lexer_init(&lexer, source, &arena, &names, &errors);
    for (size_t i = 0; i < count; i++) {
      const Word *w = &words[which[i]];
      cag_lexer_next(&lexer, &t);
      assert_int_equal(t.kind, w->kind);
      assert_int_equal(t.span.start, starts[i]);
      assert_int_equal(t.span.end, ends[i]);
      assert_int_equal(t.newline_before, lines[i]);
      assert_int_equal(t.comments, comments[i]);
      if (w->kind == CAG_TOKEN_NUMBER || w->kind == CAG_TOKEN_ANGLE)
        assert_true(t.as.number == w->number);
      if (w->kind == CAG_TOKEN_NAME) assert_string_equal(t.as.name, w->holds);
      if (w->kind >= CAG_TOKEN_FIRST_WORD) assert_string_equal(t.as.name, w->text);
      if (w->kind == CAG_TOKEN_TEXT) {
        assert_int_equal(t.as.text.length, strlen(w->holds));
        assert_memory_equal(t.as.text.bytes, w->holds, t.as.text.length);
      }
    }
    cag_lexer_next(&lexer, &t);
    assert_int_equal(t.kind, CAG_TOKEN_END);
    assert_int_equal(t.span.end, strlen(text));
    assert_int_equal(lexer.comment_count, seen);
    for (size_t i = 0; i < seen; i++) {
      const CagComment *c = &lexer.comments[i];
      const char *at = text + c->span.start;
      assert_int_equal(c->block, at[1] == '*');
      assert_int_equal(c->doc, strncmp(at, "/// ", 4) == 0);
      assert_true(c->block ? memcmp(text + c->span.end - 2, "*/", 2) == 0
                           : text[c->span.end] == '\n' || text[c->span.end] == '\r');
    }
    assert_int_equal(errors.count, 0);
    cag_lexer_release(&lexer);
    cag_names_release(&names);
    cag_arena_free(&arena);
    cag_source_free(source);
  }
}

// Decimal numbers of any length, with underscores, against the C library.
static void random_numbers_are_rounded_correctly(void **state) {
  (void)state;
  seed = 12;
  for (int round = 0; round < 6000; round++) {
    char plain[128] = "", spaced[200] = "";
    const uint32_t whole = 1 + chance(chance(4) ? 17 : 40), part = chance(chance(4) ? 17 : 40);
    char *p = plain, *s = spaced;
    for (uint32_t i = 0; i < whole + part; i++) {
      if (i == whole) *p++ = '.', *s++ = '.';
      else if (i && chance(6) == 0) *s++ = '_';
      *p = *s = (char)('0' + chance(chance(3) ? 10 : 1));
      p++, s++;
    }
    const int exponent = (int)chance(60) - 30, form = (int)chance(4);
    if (form) {
      sprintf(p, "%c%s%d", form > 1 ? 'e' : 'E', form > 2 && exponent >= 0 ? "+" : "", exponent);
      strcpy(s, p);
    } else {
      *p = *s = 0;
    }
    const double expected = strtod(plain, NULL);
    if (!(value_of(spaced, CAG_EXPR_NUMBER) == expected)) fail_msg("%s", spaced);
    // A metric unit moves the point.
    char scaled[260], shifted[260];
    static const struct {
      const char *name;
      int power;
    } units[] = {{"mm", 0}, {"cm", 1}, {"m", 3}, {"um", -3}};
    const uint32_t u = chance(4);
    snprintf(scaled, sizeof scaled, "%s%s", spaced, units[u].name);
    const char *e = strpbrk(plain, "eE");
    snprintf(shifted, sizeof shifted, "%.*se%d", e ? (int)(e - plain) : (int)strlen(plain), plain,
             (form ? exponent : 0) + units[u].power);
    const double metric = strtod(shifted, NULL), got = value_of(scaled, CAG_EXPR_NUMBER);
    if (!(fabs(got - metric) <= 2.3e-16 * metric)) fail_msg("%s is not %.17g", scaled, got);
  }
}

// Whole numbers around 2^53 and 2^59, and powers of ten around the largest exact one.
static void numbers_at_the_limits_of_exact_arithmetic(void **state) {
  (void)state;
  static const uint64_t around[] = {(uint64_t)1 << 53, (uint64_t)1 << 59, 999999999999999999u,
                                    (uint64_t)1 << 63};
  for (int i = 0; i < 4; i++)
    for (int d = -12; d <= 12; d++)
      for (int e = -30; e <= 30; e++) {
        char text[64];
        snprintf(text, sizeof text, "%llue%d",
                 (unsigned long long)(around[i] + (uint64_t)(int64_t)d), e);
        assert_true(value_of(text, CAG_EXPR_NUMBER) == strtod(text, NULL));
        snprintf(text, sizeof text, "%de%d", d + 20, e);
        assert_true(value_of(text, CAG_EXPR_NUMBER) == strtod(text, NULL));
      }
  // Zeros beyond the digits that fit, whole and as a fraction.
  value_is("12345678901234567890000", "1.2345678901234568e+22");
  value_is("1.00000000000000000000000000", "1");
  expect_mend("x = 1e308_0", "E0112", "");
}

static void long_texts_are_read_whole(void **state) {
  (void)state;
  char text[3000] = "x = \"", expected[1000];
  for (int i = 0; i < 900; i++) {
    strcat(text, i % 3 ? "\\\\" : "\\n");
    expected[i] = i % 3 ? '\\' : '\n';
  }
  strcat(text, "\"");
  Parsed p = parse_text(text);
  assert_string_equal(errors_of(&p), "");
  const CagExpr *e = p.module->statements[0]->as.definition.value;
  assert_int_equal(e->as.text.length, 900);
  assert_memory_equal(e->as.text.bytes, expected, 900);
  release(&p);
  // Texts within texts, deeper than any first capacity.
  char deep[300] = "", wanted[600] = "";
  for (int i = 0; i < 40; i++) strcat(deep, "\"{"), strcat(wanted, "(text \"\" ");
  strcat(deep, "1");
  strcat(wanted, "1");
  for (int i = 0; i < 40; i++) strcat(deep, "}\""), strcat(wanted, " \"\")");
  value_is(deep, wanted);
}

// ---- errors of single words ----

// Code, the marked span and the help of the only error. The marks are « and ».
static void words_that_are_wrong_are_marked(void **state) {
  (void)state;
  static const struct {
    const char *text, *code, *message, *help;
  } rows[] = {
      {"x = «'abc'»", "E0108", "double quotes", "write \"abc\""},
      {"x = 1 «&&» 2", "E0155", "`&&` is not an operator", "write and"},
      {"x = 1 «||» 2", "E0155", "`||` is not an operator", "write or"},
      {"x = «!»true", NULL, "`!` is not an operator", "write not"},
      {"x = 2 «**» 3", NULL, "`**` is not an operator", "write ^"},
      {"x = 1 «===» 1", NULL, "`===` is not an operator", "write =="},
      {"x = 1 «!==» 1", NULL, "`!==` is not an operator", "write !="},
      {"x = 1 «<>» 1", NULL, "`<>` is not an operator", "write !="},
      {"f = x «->» x", NULL, "`->` is not an operator", "write =>"},
      {"x «:=» 1", NULL, "`:=` is not an operator", "write ="},
      {"x = \"a«\\q»b\"", "E0106", "`\\q` is not an escape sequence", "the escape sequences are"},
      {"x = \"«\\x»41\"", "E0106", "`\\x` is not an escape sequence", "write \\u{41}"},
      {"x = \"«\\r»\"", "E0106", "`\\r` is not an escape sequence", "\\u{d}"},
      {"x = \"it«\\'»s\"", "E0106", "`\\'` is not an escape sequence", "needs no backslash"},
      {"x = \"«\\é»\"", "E0106", "`\\é` is not an escape sequence", "the escape sequences are"},
      {"x = \"«\\u{110000}»\"", "E0107", "is not a character", "up to 10FFFF"},
      {"x = \"«\\u{0000041}»\"", "E0107", "is not a character", "one to six"},
      {"x = \"«\\u{}»\"", "E0107", "is not a character", "one to six"},
      {"x = \"«\\u»41\"", "E0107", "is not a character", "one to six"},
      {"x = \"«\\u{4»g}\"", "E0107", "is not a character", "one to six"},
      {"x = \"«\\u{d800}»\"", "E0107", "is not a character", "one to six"},
      {"x = 5«degrees»", "E0109", "unknown unit `degrees`", "write 5deg, or 5 * degrees"},
      {"x = 2.5«radian»", "E0109", "unknown unit `radian`", "write 2.5rad, or 2.5 * radian"},
      {"x = 3«feet»", "E0109", "unknown unit `feet`", "write 3ft, or 3 * feet"},
      {"x = 3«metres»", "E0109", "unknown unit `metres`", "write 3m, or 3 * metres"},
      {"x = 3«dge»", "E0109", "unknown unit `dge`", "write 3deg, or 3 * dge"},
      {"x = 3«q»", "E0109", "unknown unit `q`", "to multiply, write 3 * q"},
      {"x = 3«xyzw»", "E0109", "unknown unit `xyzw`", "to multiply, write 3 * xyzw"},
      {"x = «12_»", "E0112", "between two digits", "write 12"},
      {"x = 7«°»", "E0109", "the degree sign is not a unit", "write 7deg"},
      {"x = «1e400»", "E0110", "too large", "about 1.8e308"},
      {"x = 1 «$» 2", "E0102", "`$` is not allowed here", NULL},
      {"x = «$fn»", "E0102", "unknown name `$fn`", "write "},
      {"x = «~»1", "E0102", "`~` is not allowed here", "`not c`"},
      {"x = «@»1", "E0102", "`@` is not allowed here", "A * B"},
      {"x = «\\»1", "E0102", "`\\` is not allowed here", "x => e"},
      {"x = 2 «×» 3", "E0102", "`×` is not allowed here", "write *"},
      {"x = 2 «≤» 3", "E0102", "`≤` is not allowed here", "write <="},
      {"x = «\001»", "E0102", "control character U+0001", NULL},
      {"x = «\177»", "E0102", "control character U+007F", NULL},
      {"x = «\"abc»  \ny = 1", "E0104", "is not closed on its line", "close it with \""},
      {"x = «\"a{1»\n}\"", "E0104", "is not closed on its line", "contain an expression"},
      {"x = «`»abc", "E0105", "is never closed", "close it with `"},
      {"x = 1 «/*» abc /* */", "E0103", "is never closed", "close it with */"},
      {"«#»include <x>\ny = 1", NULL, "do not start with #", "write import"},
      {"«#» note\ny = 1", NULL, "do not start with #", "starts with //"},
  };
  size_t bad = 0;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    char text[200];
    const char *left = strstr(rows[i].text, "«"), *right = strstr(left, "»");
    const size_t before = (size_t)(left - rows[i].text), marked = (size_t)(right - left) - 2;
    snprintf(text, sizeof text, "%.*s%.*s%s", (int)before, rows[i].text, (int)marked, left + 2,
             right + 2);
    Parsed p = parse_text(text);
    assert_true(p.errors.count >= 1);
    const CagDiagnostic *d = &p.errors.items[0];
    const char *help = d->help ? d->help : "";
    if (d->span.start != before || d->span.end != before + marked ||
        !strstr(d->message, rows[i].message) ||
        (rows[i].help ? !strstr(help, rows[i].help) : *help != 0) ||
        (rows[i].code && strcmp(cag_error_info(d->id)->code, rows[i].code) != 0)) {
      print_error("%s: %s %u-%u: %s (%s)\n", text, cag_error_info(d->id)->code, d->span.start,
                  d->span.end, d->message, help);
      bad++;
    }
    release(&p);
  }
  assert_int_equal(bad, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(numbers_have_digits_on_both_sides_of_the_point),
      cmocka_unit_test(numbers_are_rounded_correctly),
      cmocka_unit_test(units_scale_before_rounding),
      cmocka_unit_test(an_unknown_unit_gets_the_nearest),
      cmocka_unit_test(names_are_compared_after_nfc),
      cmocka_unit_test(texts_know_their_escapes),
      cmocka_unit_test(texts_hold_expressions_to_any_depth),
      cmocka_unit_test(a_text_ends_on_its_line),
      cmocka_unit_test(comments_nest_and_count_as_blanks),
      cmocka_unit_test(documentation_is_that_of_the_definition_which_follows),
      cmocka_unit_test(invalid_utf8_is_shown_where_it_stands),
      cmocka_unit_test(words_are_told_apart),
      cmocka_unit_test(random_numbers_are_rounded_correctly),
      cmocka_unit_test(numbers_at_the_limits_of_exact_arithmetic),
      cmocka_unit_test(long_texts_are_read_whole),
      cmocka_unit_test(words_that_are_wrong_are_marked),
      cmocka_unit_test(a_byte_order_mark_and_other_spaces_are_blanks),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
