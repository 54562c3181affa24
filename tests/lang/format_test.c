// The formatter: its layout, and that it never changes a tree, loses a comment, or changes its own
// output. Tested with all scripts of the source tree, as they are and with random spaces.

#include <ftw.h>

#include "lang/format.h"
#include "lang/lexer.h"
#include "support.h"

// Returns the formatted text, or NULL if it has errors.
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

static void patterns_are_set_like_lists_and_records(void **state) {
  (void)state;
  expect_layout("[x,y,...r ]=v\n{a,b:[c,_,],in:d}= v",
                "[x, y, ...r] = v\n{ a, b: [c, _], in: d } = v\n");
  expect_layout("f( [x , y],{a} )=([ z ])=>x", "f([x, y], { a }) = ([z]) => x\n");
  expect_layout("xs=[for{a,at:[x]}in ys:x]", "xs = [for { a, at: [x] } in ys: x]\n");
  expect_layout("[ // first\nx, /* second */ y // last\n] = v",
                "[  // first\n  x,\n  /* second */ y  // last\n] = v\n");
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

// A multi-line text as the last argument stays after the bracket and breaks the others. As a label,
// it is neither aligned with others nor are others with it.
static void texts_of_several_lines_stay_as_they_are(void **state) {
  (void)state;
  expect_layout("u = f(3,`one\ntwo`)", "u = f(3, `one\ntwo`)\n");
  expect_layout("u=f(`one\ntwo`,3)", "u = f(\n  `one\ntwo`,\n  3\n)\n");
  expect_layout("param a=1 \"x\"\nparam bcd=2 \"y\"\nparam e=3 `one\ntwo`\n"
                "param fghij=4 \"z\" // why\nparam k=5 \"w\"",
                "param a = 1    \"x\"\nparam bcd = 2  \"y\"\nparam e = 3 `one\ntwo`\n"
                "param fghij = 4 \"z\"  // why\nparam k = 5          \"w\"\n");
}

static void comments_keep_their_places(void **state) {
  (void)state;
  // Before the fields of a record, including a spread one.
  expect_layout("r = {a: 1,\n // b\n\n b: 2,\n // c\n\n ...c,\n // d\n ...d}",
                "r = {\n  a: 1,\n  // b\n\n  b: 2,\n  // c\n\n  ...c,\n  // d\n  ...d\n}\n");
  expect_layout("r = {/* a */ ...a, ... /* b */ b}", "r = { /* a */ ...a, ... /* b */ b }\n");
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
  // Rows that fit on one line are not a table.
  expect_layout("m = [[1,20],[300,4]]", "m = [[1, 20], [300, 4]]\n");
  // Comments and blank lines are allowed between the rows.
  expect_layout("m = [ // all\n[1000000000,2,3,4,5,6,7,8],\n\n[1,2,3,4,5,6,7,8], // two\n"
                "/* three */ [1,2,3,4,5,6,7,8]]",
                "m = [  // all\n  [1000000000, 2, 3, 4, 5, 6, 7, 8],\n\n"
                "  [         1, 2, 3, 4, 5, 6, 7, 8],  // two\n"
                "  /* three */ [         1, 2, 3, 4, 5, 6, 7, 8]\n]\n");
  // Rows of different lengths are not aligned.
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
  // A field that must be broken is separate.
  expect_layout("r = { a: 1, b: 2, xs: [" LONG ", " LONG ", 1], c: 3, d: 4 }",
                "r = {\n  a: 1, b: 2,\n  xs: [\n    " LONG ",\n    " LONG ",\n    1\n  ],\n"
                "  c: 3, d: 4\n}\n");
  // If a field is computed, each field has its own line.
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
  // A single stage that must be broken begins after its head.
  expect_layout("a = b |> f(" LONG ", " LONG ", 1, 2)",
                "a = b |> f(\n  " LONG ",\n  " LONG ",\n  1,\n  2\n)\n");
  // Comments are directly above their stage, and blank lines between them are kept.
  expect_layout("a = b\n// one\n\n|> f\n// two\n\n// three\n\n|> g",
                "a = b\n  // one\n  |> f\n  // two\n\n  // three\n  |> g\n");
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

// ---- limits ----

// Replaces each @ in the text by a name of k letters.
static char *with_name(const char *text, size_t k) {
  char *out;
  size_t size;
  FILE *f = open_memstream(&out, &size);
  for (; *text; text++) {
    if (*text != '@') fputc(*text, f);
    else
      for (size_t i = 0; i < k; i++) fputc('a', f);
  }
  fclose(f);
  return out;
}

static size_t longest_line(const char *text) {
  size_t most = 0;
  while (*text) {
    const size_t n = strcspn(text, "\n");
    if (n > most) most = n;
    text += n + (text[n] != 0);
  }
  return most;
}

// Any statement is on one line if and only if that has at most 100 columns. Otherwise, it is broken
// as shown.
static void a_line_has_at_most_a_hundred_columns(void **state) {
  (void)state;
  static const struct {
    const char *flat, *broken;
  } rows[] = {
      {"a = f(@, b)\n", "a = f(\n  @, b\n)\n"},
      {"a = f(b, k: @)\n", "a = f(\n  b, k: @\n)\n"},
      {"f(@) = 1\n", "f(\n  @\n) = 1\n"},
      {"f(x) = @(x)\n", "f(x) = @(\n  x\n)\n"},
      {"a = [@, bb, c]\n", "a = [\n  @,\n  bb,\n  c\n]\n"},
      {"a = [@]\n", "a = [\n  @\n]\n"},
      {"a = { b: @ + 1, c: 2 }\n", "a = {\n  b: @ + 1,\n  c: 2\n}\n"},
      {"a = { b: @, c: 2 }\n", "a = {\n  b: @, c: 2\n}\n"},
      {"a = f(@).b[c]\n", "a = f(\n  @\n).b[c]\n"},
      {"a = f(@) + b\n", "a = f(@) +\n  b\n"},
      {"a = -f(@, 2)\n", "a = -f(\n  @, 2\n)\n"},
      {"a = not f(@)\n", "a = not f(\n  @\n)\n"},
      {"a = f(@)..b\n", "a = f(\n  @\n)..b\n"},
      {"param a = f(@, b)\n", "param a = f(\n  @, b\n)\n"},
      {"f(b = @, c = 1) = 2\n", "f(\n  b = @, c = 1\n) = 2\n"},
      {"a = b |> f(@, c)\n", "a = b\n  |> f(@, c)\n"},
      {"a = @ + b\n", "a = @ +\n  b\n"},
      {"a = @ and b\n", "a = @ and\n  b\n"},
      {"a = @ |> f |> g\n", "a = @\n  |> f\n  |> g\n"},
      {"a = if @ then 1 else 2\n", "a =\n  if @ then 1\n  else 2\n"},
      {"a = if b then @ else if c then d else 2\n",
       "a =\n  if b then @\n  else if c then d\n  else 2\n"},
      {"a = [for x in @: x + 1]\n", "a = [for x in @:\n  x + 1]\n"},
      {"a = (b + @)\n", "a = (\n  b + @\n)\n"},
      {"a = f([@, b])\n", "a = f([\n  @,\n  b\n])\n"},
      {"a = f({ b: @, c: 1 + 2 })\n", "a = f({\n  b: @,\n  c: 1 + 2\n})\n"},
      {"a = f([@, b], c)\n", "a = f(\n  [@, b], c\n)\n"},
      {"a = x => g(x, @)\n", "a = x => g(\n  x, @\n)\n"},
      {"show @, b\n", "show @,\n  b\n"},
      {"print @, b, c\n", "print @, b,\n  c\n"},
      {"import std.robots: b, @\n", "import std.robots: b,\n  @\n"},
      {"assert @ > 1, \"too small\"\n", "assert @ > 1,\n  \"too small\"\n"},
      {"a = b[@]\n", "a = b[@]\n"},
      {"a = f({ x = 1; @ })\n", "a = f({\n  x = 1\n  @\n})\n"},
  };
  size_t bad = 0;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    for (size_t k = 60; k <= 94; k++) {
      char *flat = with_name(rows[i].flat, k), *broken = with_name(rows[i].broken, k);
      const bool fits = longest_line(flat) <= 100 && !strchr(rows[i].flat, ';');
      if (fits || longest_line(broken) <= 100) {
        char *out = laid_out(flat, strlen(flat), NULL, NULL);
        const char *expected = fits ? flat : broken;
        if (strcmp(out, expected) != 0) {
          print_error("%zu letters give\n%sand not\n%s", k, out, expected);
          bad++;
        }
        free(out);
      }
      free(flat);
      free(broken);
    }
  assert_int_equal(bad, 0);
}

#define LONGER LONG "_and_a_tail"

// Of two layouts, the first is used if and only if it has at most 100 columns.
static void a_last_list_opens_where_its_bracket_fits(void **state) {
  (void)state;
  static const struct {
    const char *text, *first, *second;
  } rows[] = {
      {"a = f(@, x => [" LONGER ", " LONGER "])\n",
       "a = f(@, x => [\n  " LONGER ",\n  " LONGER "\n])\n",
       "a = f(\n  @,\n  x => [\n    " LONGER ",\n    " LONGER "\n  ]\n)\n"},
      {"a = f([" LONGER ", " LONGER "], @)\n", "a = f([\n  " LONGER ",\n  " LONGER "\n], @)\n",
       NULL},
      {"a = b |> f(" LONGER ", " LONGER ", @)\n",
       "a = b |> f(\n  " LONGER ",\n  " LONGER ",\n  @\n)\n", NULL},
      {"a = (@ + [" LONGER ", " LONGER "])\n",
       "a = (\n  @ +\n    [\n      " LONGER ",\n      " LONGER "\n    ]\n)\n", NULL},
      {"a = @ |> f(" LONGER ", " LONGER ")\n", "a = @ |> f(\n  " LONGER ",\n  " LONGER "\n)\n",
       "a = @\n  |> f(\n    " LONGER ",\n    " LONGER "\n  )\n"},
  };
  size_t bad = 0;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    for (size_t k = rows[i].second ? 60 : 3; k <= (rows[i].second ? 94 : 37); k++) {
      char *text = with_name(rows[i].text, k), *first = with_name(rows[i].first, k);
      char *second = with_name(rows[i].second ? rows[i].second : "", k);
      const char *expected = longest_line(first) <= 100 || !*second ? first : second;
      if (longest_line(expected) <= 100) {
        char *out = laid_out(text, strlen(text), NULL, NULL);
        if (strcmp(out, expected) != 0) {
          print_error("%zu letters give\n%sand not\n%s", k, out, expected);
          bad++;
        }
        free(out);
      }
      free(text);
      free(first);
      free(second);
    }
  assert_int_equal(bad, 0);
}

static uint32_t seed;
static uint32_t chance(uint32_t n) {
  seed = seed * 1664525 + 1013904223;
  return (seed >> 8) % n;
}

// Appends `word` to a line of `indent` columns, or to the next line if it would exceed 100 columns.
static void fill(char *out, size_t *column, size_t indent, const char *word, bool last) {
  const size_t n = strlen(word) + !last;
  if (*column + 1 + n > 100) {
    sprintf(out + strlen(out), "\n%*s%s%s", (int)indent, "", word, last ? "" : ",");
    *column = indent + n;
  } else {
    sprintf(out + strlen(out), " %s%s", word, last ? "" : ",");
    *column += 1 + n;
  }
}

// Lists of small elements, imports, and shown expressions are filled: as many to a line as fit.
static void short_words_fill_their_lines(void **state) {
  (void)state;
  seed = 3;
  for (int round = 0; round < 300; round++) {
    char text[4000], expected[4000];
    const int kind = (int)chance(3), n = 2 + (int)chance(40);
    static const char *const heads[] = {"a = [", "show", "import \"m.cag\":"};
    strcpy(text, heads[kind]);
    strcpy(expected, heads[kind]);
    size_t column = strlen(expected), flat = column;
    if (kind == 0) {
      strcat(expected, "\n ");
      column = 1;
    }
    for (int i = 0; i < n; i++) {
      char word[30];
      const size_t length = 2 + chance(25);
      memset(word, 'b' + i % 20, length);
      word[length] = 0;
      word[1] = (char)('a' + i / 20);
      sprintf(text + strlen(text), " %s%s", word, i + 1 < n ? "," : "");
      flat += length + (i + 1 < n ? 2 : 0);
      fill(expected, &column, 2, word, i + 1 == n);
    }
    if (kind == 0) {
      strcat(text, "]");
      strcat(expected, "\n]");
      if (flat + 1 <= 100) { // on one line
        strcpy(expected, heads[0]);
        strcat(expected, text + strlen(heads[0]) + 1);
      }
    }
    strcat(text, "\n");
    strcat(expected, "\n");
    char *out = laid_out(text, strlen(text), NULL, NULL);
    assert_non_null(out);
    assert_string_equal(out, expected);
    free(out);
  }
}

// The columns of a table are as wide as their widest elements, and right-aligned.
static void tables_have_right_aligned_columns(void **state) {
  (void)state;
  seed = 4;
  for (int round = 0; round < 200; round++) {
    const int rows = 2 + (int)chance(6), columns = 8 + (int)chance(5), nested = (int)chance(2);
    char words[8][12][16], text[4000] = "a = [", expected[4000] = "a = [\n";
    size_t widths[12] = {0};
    for (int i = 0; i < rows; i++)
      for (int j = 0; j < columns; j++) {
        static const char *const units[] = {"", ".5", "deg", "mm"};
        const uint32_t number = chance(chance(2) ? 10 : 10000), unit = chance(4), sign = chance(2);
        sprintf(words[i][j], "%s%u%s", sign ? "-" : "", number, units[unit]);
        if (strlen(words[i][j]) > widths[j]) widths[j] = strlen(words[i][j]);
      }
    size_t width = 2;
    for (int j = 0; j < columns; j++) width += widths[j] + 2;
    for (int i = 0; i < rows; i++) {
      strcat(text, i ? ", [" : "[");
      strcat(expected, "  [");
      for (int j = 0; j < columns; j++) {
        const bool opens = nested && j % 4 == 0,
                   closes = nested && (j % 4 == 3 || j + 1 == columns);
        sprintf(text + strlen(text), "%s%s%s%s", j ? "," : "", opens ? "[" : "", words[i][j],
                closes ? "]" : "");
        sprintf(expected + strlen(expected), "%s%s%*s%s", j ? ", " : "", opens ? "[" : "",
                (int)widths[j], words[i][j], closes ? "]" : "");
      }
      strcat(text, "]");
      strcat(expected, i + 1 < rows ? "],\n" : "]\n");
    }
    strcat(text, "]\n");
    strcat(expected, "]\n");
    char *out = laid_out(text, strlen(text), NULL, NULL);
    assert_non_null(out);
    // Only tables whose rows all fit, and which do not fit on one line themselves.
    if (longest_line(expected) <= 100 && strchr(out, '\n') + 1 != out + strlen(out))
      assert_string_equal(out, expected);
    else assert_true(width > 90 || strlen(out) <= 101);
    free(out);
  }
}

// Comments at the ends of adjacent lines begin two columns after the longest of the lines, unless
// that has more than 72 columns. A blank line, or a line without a comment, ends the group.
static void comments_of_neighboring_lines_are_aligned(void **state) {
  (void)state;
  seed = 5;
  for (int round = 0; round < 300; round++) {
    const int n = 2 + (int)chance(9);
    char lines[11][120], text[2000] = "", expected[3000] = "";
    bool comments[11], blank[11];
    for (int i = 0; i < n; i++) {
      char name[100];
      const size_t length = chance(8) ? 1 + chance(30) : 60 + chance(12);
      memset(name, 'a', length);
      name[length] = 0;
      sprintf(lines[i], "b%d = %s%s", i, name, chance(4) ? "" : "\xc3\xa9");
      comments[i] = chance(4);
      blank[i] = i && chance(5) == 0;
      sprintf(text + strlen(text), "%s%s%s\n", blank[i] ? "\n" : "", lines[i],
              comments[i] ? " // c" : "");
    }
    for (int i = 0; i < n; i++) {
      size_t most = 0;
      int from = i, to = i;
      while (from > 0 && comments[from - 1] && !blank[from]) from--;
      while (to + 1 < n && comments[to + 1] && !blank[to + 1]) to++;
      for (int k = from; k <= to && comments[i]; k++) {
        size_t columns = 0;
        for (const char *c = lines[k]; *c; c++) columns += (*c & 0xc0) != 0x80;
        if (columns > most) most = columns;
      }
      size_t columns = 0;
      for (const char *c = lines[i]; *c; c++) columns += (*c & 0xc0) != 0x80;
      if (most > 72) most = columns;
      sprintf(expected + strlen(expected), "%s%s", blank[i] ? "\n" : "", lines[i]);
      if (comments[i])
        sprintf(expected + strlen(expected), "%*s// c", (int)(most - columns + 2), "");
      strcat(expected, "\n");
    }
    char *out = laid_out(text, strlen(text), NULL, NULL);
    assert_non_null(out);
    assert_string_equal(out, expected);
    free(out);
  }
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

// The text with different spaces between its tokens, additional comments, and newlines where they
// are allowed.
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
      cmocka_unit_test(patterns_are_set_like_lists_and_records),
      cmocka_unit_test(products_are_set_close_within_something),
      cmocka_unit_test(labels_of_params_are_set_one_below_the_other),
      cmocka_unit_test(texts_of_several_lines_stay_as_they_are),
      cmocka_unit_test(comments_keep_their_places),
      cmocka_unit_test(long_lines_are_broken),
      cmocka_unit_test(rows_of_numbers_stand_one_below_the_other),
      cmocka_unit_test(records_of_data_are_filled),
      cmocka_unit_test(the_first_operand_breaks_at_the_indentation_of_its_line),
      cmocka_unit_test(short_parameters_are_filled),
      cmocka_unit_test(stages_stand_behind_a_closing_bracket),
      cmocka_unit_test(a_line_has_at_most_a_hundred_columns),
      cmocka_unit_test(a_last_list_opens_where_its_bracket_fits),
      cmocka_unit_test(short_words_fill_their_lines),
      cmocka_unit_test(tables_have_right_aligned_columns),
      cmocka_unit_test(comments_of_neighboring_lines_are_aligned),
      cmocka_unit_test(scripts_keep_their_trees),
  };
  return cmocka_run_group_tests_name("layout", tests, NULL, NULL);
}
