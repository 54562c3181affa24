// The one layout: what it looks like, and that it never changes a tree, loses a comment, or differs
// the second time; over all scripts of the tree, as they are and with their spaces thrown about.

#include <ftw.h>

#include "lang/format.h"
#include "lang/lexer.h"
#include "support.h"

// The layout of a text, or NULL where it has errors.
static char *laid_out(const char *text, size_t length, char **tree, size_t *comments) {
  Parsed p = parse_bytes(text, length, CAG_PARSE_FILE);
  size_t n;
  CagDiagnostics errors = {0};
  char *out = cag_format(p.source, &errors, &n);
  assert_true((out != NULL) == (p.errors.count == 0));
  assert_int_equal(errors.count, p.errors.count);
  cag_diagnostics_clear(&errors);
  if (out) {
    assert_int_equal(strlen(out), n);
    if (tree) {
      FILE *f = open_memstream(tree, &n);
      cag_ast_dump(f, p.module);
      fclose(f);
    }
    if (comments) *comments = p.module->comment_count;
  }
  release(&p);
  return out;
}

static void expect_layout(const char *text, const char *expected) {
  char *out = laid_out(text, strlen(text), NULL, NULL);
  assert_non_null(out);
  assert_string_equal(out, expected);
  char *again = laid_out(out, strlen(out), NULL, NULL);
  assert_string_equal(again, expected);
  free(again);
  free(out);
}

static void spaces_are_set_anew(void **state) {
  (void)state;
  expect_layout("a=1+2 *3;b   =-a^2\n\n\n\nshow   a,b", "a = 1 + 2*3\nb = -a^2\n\nshow a, b\n");
  expect_layout("f( x,y=2 )=max( x , y )[ 0 ].p", "f(x, y = 2) = max(x, y)[0].p\n");
  expect_layout("r={a:1,\"b c\":[1,2,],...s}", "r = { a: 1, \"b c\": [1, 2], ...s }\n");
  expect_layout("r={ }\nxs=[ ]\ng=( )=>1", "r = {}\nxs = []\ng = () => 1\n");
  expect_layout("x = [for i in 0 ..< n - 1 , [ a,_ ] in ys if a>0:i*a]",
                "x = [for i in 0..<n-1, [a, _] in ys if a > 0: i * a]\n");
  expect_layout("param h=120mm in 50 .. 300\"the height\"",
                "param h = 120mm in 50..300  \"the height\"\n");
  expect_layout("import  std.materials  as mat :a,b\nimport \"x.cag\"",
                "import std.materials as mat: a, b\nimport \"x.cag\"\n");
  expect_layout("t = \"a {1+2} b\"", "t = \"a {1+2} b\"\n");
  expect_layout("f = (x) => not (x in r)", "f = x => not (x in r)\n");
  expect_layout("r = 0deg .. 2 * 90deg by 1deg * 3", "r = 0deg..2*90deg by 1deg*3\n");
  expect_layout("", "");
}

static void products_are_set_close_within_something(void **state) {
  (void)state;
  expect_layout("a=2*r;b=[2 * r,-x / 2, r*3^2]", "a = 2 * r\nb = [2*r, -x/2, r*3^2]\n");
  expect_layout("c = f(2 * p.x, k: w[0] / 3)", "c = f(2*p.x, k: w[0]/3)\n");
  expect_layout("c = a*b+c  %d*sin(2 * t)", "c = a*b + c % d * sin(2*t)\n");
  expect_layout("d = map(xs, x=>2*x)", "d = map(xs, x => 2 * x)\n");
  expect_layout("e = [a /* the */ * b]", "e = [a * /* the */ b]\n");
  expect_layout("f = [a*b*c*d*e, (a*b)^2]", "f = [a * b * c * d * e, (a*b)^2]\n");
}

static void labels_of_params_are_set_one_below_the_other(void **state) {
  (void)state;
  expect_layout("param a=1 in 0..9 \"one\"\nparam bcd = 2   \"two\"",
                "param a = 1 in 0..9  \"one\"\nparam bcd = 2        \"two\"\n");
  expect_layout("param a=1 \"one\" // why\nb = 2\nparam b = 2 \"two\"; c = 3",
                "param a = 1 \"one\"  // why\nb = 2\nparam b = 2  \"two\"\nc = 3\n");
}

static void comments_keep_their_places(void **state) {
  (void)state;
  expect_layout("// head\n\n/// of a\na=1 // one\nbcd=2   // two\n// tail",
                "// head\n\n/// of a\na = 1    // one\nbcd = 2  // two\n// tail\n");
  expect_layout("x=[1,// one\n2 /* two */,\n// three\n3]",
                "x = [\n  1,  // one\n  2, /* two */\n  // three\n  3\n]\n");
  expect_layout("f(x)={// why\ny=x;// so\n\ny// last\n// end\n}",
                "f(x) = {  // why\n  y = x  // so\n\n  y  // last\n  // end\n}\n");
  expect_layout("f(x)={\ny=x\ny /* last */ }", "f(x) = {\n  y = x\n  y /* last */\n}\n");
  expect_layout("f(x)={\ny=x\ny\n/* own */ }", "f(x) = {\n  y = x\n  y\n  /* own */\n}\n");
  expect_layout("f(x)={ x /* last */ }", "f(x) = { x /* last */ }\n");
  expect_layout("a = b // c\n|> f", "a = b  // c\n  |> f\n");
  expect_layout("/* a\r\n b\r\n*/\r\na=1 // one\r\n", "/* a\n b\n*/\na = 1  // one\n");
  expect_layout("a = [b /* c */ +\n// own\nd]", "a = [\n  b + /* c */\n    // own\n    d\n]\n");
}

#define LONG "an_argument_with_a_rather_long_name_of_its_own"

static void long_lines_are_broken(void **state) {
  (void)state;
  expect_layout("a = function_name(" LONG ", " LONG ", k: 1)",
                "a = function_name(\n  " LONG ",\n  " LONG ",\n  k: 1\n)\n");
  expect_layout("a = function_name(" LONG ", name: 120, position: [100, 200, 300], color: 1)",
                "a = function_name(\n  " LONG
                ", name: 120, position: [100, 200, 300], color: 1\n)\n");
  expect_layout("a = figure([" LONG ", " LONG "], width: 110)",
                "a = figure([\n  " LONG ",\n  " LONG "\n], width: 110)\n");
  expect_layout("a = curve(t => { x = t; x }, 0..1)", "a = curve(t => {\n  x = t\n  x\n}, 0..1)\n");
  expect_layout("a = revolve(polyline([" LONG ", " LONG "]))",
                "a = revolve(polyline([\n  " LONG ",\n  " LONG "\n]))\n");
  expect_layout("a = " LONG " + " LONG " + c", "a = " LONG " +\n  " LONG " + c\n");
  expect_layout("a = " LONG " |> " LONG "(1) |> g", "a = " LONG "\n  |> " LONG "(1)\n  |> g\n");
  expect_layout("a = if " LONG " then " LONG " else if c then 1 else 2",
                "a =\n  if " LONG " then " LONG "\n  else if c then 1\n  else 2\n");
  expect_layout("a = map(xs, x => { y = x; y })", "a = map(xs, x => {\n  y = x\n  y\n})\n");
}

static void rows_of_numbers_stand_one_below_the_other(void **state) {
  (void)state;
  expect_layout("net = [[[0,0,8],[0,18.5,24],[0,36,-4],[0,54,12]],[[18,0,26],[18,18,48],[18,36,30],"
                "[18,54,24]],]",
                "net = [\n"
                "  [[ 0, 0,  8], [ 0, 18.5, 24], [ 0, 36, -4], [ 0, 54, 12]],\n"
                "  [[18, 0, 26], [18,   18, 48], [18, 36, 30], [18, 54, 24]]\n"
                "]\n");
  // What fits on a line is no table.
  expect_layout("m = [[1,20],[300,4]]", "m = [[1, 20], [300, 4]]\n");
  // Comments and blank lines may stand between the rows.
  expect_layout("m = [ // all\n[1000000000,2,3,4,5,6,7,8],\n\n[1,2,3,4,5,6,7,8], // two\n"
                "/* three */ [1,2,3,4,5,6,7,8]]",
                "m = [  // all\n  [1000000000, 2, 3, 4, 5, 6, 7, 8],\n\n"
                "  [         1, 2, 3, 4, 5, 6, 7, 8],  // two\n"
                "  /* three */ [         1, 2, 3, 4, 5, 6, 7, 8]\n]\n");
  // Rows that are not alike are set as they are.
  expect_layout("m = [[1000000000000, 2000000000000], [1, 2000000000000, 3], [100000000000000, x], "
                "[1000000, 20000000, 3]]",
                "m = [\n  [1000000000000, 2000000000000],\n  [1, 2000000000000, 3],\n"
                "  [100000000000000, x],\n  [1000000, 20000000, 3]\n]\n");
}

static void records_of_data_are_filled(void **state) {
  (void)state;
  expect_layout(
      "r = { name: \"a long name of a thing\", size: [10, 20, 30], at: f(1, -2), look: m.red, "
      "turned: 0deg..90deg, end: true }",
      "r = {\n  name: \"a long name of a thing\", size: [10, 20, 30], at: f(1, -2), look: "
      "m.red,\n  turned: 0deg..90deg, end: true\n}\n");
  // A field that has to be broken stands apart.
  expect_layout("r = { a: 1, b: 2, xs: [" LONG ", " LONG ", 1], c: 3, d: 4 }",
                "r = {\n  a: 1, b: 2,\n  xs: [\n    " LONG ",\n    " LONG ",\n    1\n  ],\n"
                "  c: 3, d: 4\n}\n");
  // Where something is computed, each field has its line.
  expect_layout("r = { first: 1, second: 2, third: 2 * " LONG ", fourth: 4, fifth: 5, sixth: 6 }",
                "r = {\n  first: 1,\n  second: 2,\n  third: 2*" LONG
                ",\n  fourth: 4,\n  fifth: 5,\n  sixth: 6\n}\n");
}

static void stages_stand_behind_a_closing_bracket(void **state) {
  (void)state;
  expect_layout("a = group([" LONG ", " LONG "]) |> f(1) |> g",
                "a = group([\n  " LONG ",\n  " LONG "\n]) |> f(1) |> g\n");
  expect_layout("a = group([" LONG ", " LONG "]) |> f(1) |> g(" LONG ", x) |> g(" LONG ")",
                "a = group([\n  " LONG ",\n  " LONG "\n])\n  |> f(1)\n  |> g(" LONG
                ", x)\n  |> g(" LONG ")\n");
  // A single stage that has to be broken begins behind its head.
  expect_layout("a = b |> f(" LONG ", " LONG ", 1, 2)",
                "a = b |> f(\n  " LONG ",\n  " LONG ",\n  1,\n  2\n)\n");
}

static void the_first_operand_breaks_at_the_indentation_of_its_line(void **state) {
  (void)state;
  expect_layout("a = all(" LONG ", " LONG ", 1, 2) and b",
                "a = all(\n  " LONG ",\n  " LONG ",\n  1,\n  2\n) and b\n");
  expect_layout("a = b and all(" LONG ", " LONG ", 1, 2)",
                "a = b and\n  all(\n    " LONG ",\n    " LONG ",\n    1,\n    2\n  )\n");
}

static void short_parameters_are_filled(void **state) {
  (void)state;
  expect_layout(
      "f(first = 1, second = 2, third = 3, fourth = 4, fifth = 5, sixth = 6, seventh = 7, "
      "eighth = 8, ninth = 9) = 1",
      "f(\n  first = 1, second = 2, third = 3, fourth = 4, fifth = 5, sixth = 6, "
      "seventh = 7, eighth = 8,\n  ninth = 9\n) = 1\n");
}

// ---- properties ----

static size_t scripts_seen;

static size_t count_of(const char *text, char c) {
  size_t n = 0;
  for (; *text; text++) n += *text == c;
  return n;
}

static void check_properties(const char *path, const char *text, size_t length) {
  char *tree, *again_tree;
  size_t comments, again_comments;
  char *out = laid_out(text, length, &tree, &comments);
  if (!out) return;
  scripts_seen++;
  char *again = laid_out(out, strlen(out), &again_tree, &again_comments);
  if (!again || strcmp(tree, again_tree) != 0) {
    print_error("%s: the layout changes the tree:\n%.900s\n", path, out);
    fail();
  }
  if (strcmp(out, again) != 0) {
    size_t at = 0;
    while (out[at] == again[at]) at++;
    at = at > 150 ? at - 150 : 0;
    print_error("%s: laid out twice it differs:\n%.300s\n-----\n%.300s\n", path, out + at,
                again + at);
    fail();
  }
  assert_int_equal(comments, again_comments);
  assert_true(count_of(out, '/') == count_of(text, '/'));
  free(tree);
  free(again_tree);
  free(out);
  free(again);
}

static uint32_t seed;
static uint32_t chance(uint32_t n) {
  seed = seed * 1664525 + 1013904223;
  return (seed >> 8) % n;
}

// The text with other spaces between its tokens, comments strewn in, and newlines where they do
// not count.
static char *thrown_about(const char *text, size_t length, size_t *size) {
  CagSource *source = cag_source_new("", text, length);
  CagArena arena = {0};
  CagNames names;
  CagLexer lexer;
  CagToken t;
  char *out;
  FILE *f = open_memstream(&out, size);
  uint32_t at = 0, texts = 0;
  char stack[CAG_MAX_NESTING + 1] = {0};
  size_t depth = 0;
  cag_names_init(&names, &arena);
  cag_lexer_init(&lexer, source, &arena, &names, NULL);
  for (cag_lexer_next(&lexer, &t); t.kind != CAG_TOKEN_END && t.kind != CAG_TOKEN_ERROR;
       cag_lexer_next(&lexer, &t)) {
    fwrite(text + at, 1, t.span.start - at, f);
    const bool free_space = depth && stack[depth - 1] != '{' && texts == 0 &&
                            t.kind != CAG_TOKEN_LEFT_PAREN && t.kind != CAG_TOKEN_LEFT_SQUARE;
    if (free_space && at) {
      static const char *const spaces[] = {" ",         "\n",         "\n\n ", " // c\n",
                                           " /* b */ ", "\n// own\n", "  "};
      const uint32_t which = chance(20);
      if (which < 7) fputs(spaces[which], f);
    }
    fwrite(text + t.span.start, 1, t.span.end - t.span.start, f);
    at = t.span.end;
    if (t.kind == CAG_TOKEN_TEXT_HEAD) texts++;
    if (t.kind == CAG_TOKEN_TEXT_TAIL) texts--;
    if (t.kind == CAG_TOKEN_LEFT_PAREN) stack[depth++] = '(';
    if (t.kind == CAG_TOKEN_LEFT_SQUARE) stack[depth++] = '[';
    if (t.kind == CAG_TOKEN_LEFT_BRACE) stack[depth++] = '{';
    if (depth && (t.kind == CAG_TOKEN_RIGHT_PAREN || t.kind == CAG_TOKEN_RIGHT_SQUARE ||
                  t.kind == CAG_TOKEN_RIGHT_BRACE))
      depth--;
  }
  fwrite(text + at, 1, length - at, f);
  fclose(f);
  cag_lexer_release(&lexer);
  cag_names_release(&names);
  cag_arena_free(&arena);
  cag_source_free(source);
  return out;
}

static int check_file(const char *path, const struct stat *info, int kind, struct FTW *where) {
  (void)info;
  (void)where;
  const size_t n = strlen(path);
  if (kind != FTW_F || n < 4 || strcmp(path + n - 4, ".cag") != 0) return 0;
  FILE *f = fopen(path, "rb");
  char *text = NULL;
  size_t size = 0;
  const ssize_t length = f ? getdelim(&text, &size, -1, f) : -1;
  if (f) fclose(f);
  if (length > 0) {
    check_properties(path, text, (size_t)length);
    for (int i = 0; i < 5; i++) {
      size_t thrown_size;
      char *thrown = thrown_about(text, (size_t)length, &thrown_size);
      check_properties(path, thrown, thrown_size);
      free(thrown);
    }
  }
  free(text);
  return 0;
}

static void scripts_keep_their_trees(void **state) {
  (void)state;
  static const char *const folders[] = {"stdlib", "examples", "docs", "tests"};
  scripts_seen = 0;
  seed = 1;
  for (size_t i = 0; i < sizeof folders / sizeof *folders; i++)
    assert_int_equal(nftw(folders[i], check_file, 16, FTW_PHYS), 0);
  assert_true(scripts_seen > 500);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(spaces_are_set_anew),
      cmocka_unit_test(products_are_set_close_within_something),
      cmocka_unit_test(labels_of_params_are_set_one_below_the_other),
      cmocka_unit_test(comments_keep_their_places),
      cmocka_unit_test(long_lines_are_broken),
      cmocka_unit_test(rows_of_numbers_stand_one_below_the_other),
      cmocka_unit_test(records_of_data_are_filled),
      cmocka_unit_test(the_first_operand_breaks_at_the_indentation_of_its_line),
      cmocka_unit_test(short_parameters_are_filled),
      cmocka_unit_test(stages_stand_behind_a_closing_bracket),
      cmocka_unit_test(scripts_keep_their_trees),
  };
  return cmocka_run_group_tests_name("layout", tests, NULL, NULL);
}
