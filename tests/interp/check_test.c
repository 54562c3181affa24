// The checker: the errors that it finds, and that correct scripts have none.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "cag.h"

// The codes of the diagnostics of a script with their lines, such as "E0301:2 E0900:1".
static const char *found(const char *script) {
  static char text[1024];
  CagSessionOptions options;
  cag_session_options_init(&options);
  CagSession *s = cag_session_new(&options);
  cag_session_check_text(s, "test", script, strlen(script));
  text[0] = 0;
  for (size_t i = 0; i < cag_session_error_count(s); i++) {
    CagErrorView view;
    cag_session_error(s, i, &view);
    char one[64];
    snprintf(one, sizeof one, "%s%s:%zu", i ? " " : "", view.code, view.line);
    strncat(text, one, sizeof text - strlen(text) - 1);
  }
  cag_session_free(s);
  return text;
}

static void arguments_are_counted_and_named(void **state) {
  (void)state;
  assert_string_equal(found("print sqrt(1, 2)"), "E0302:1");
  assert_string_equal(found("print sqrt()"), "E0302:1");
  assert_string_equal(found("print box(10, centred: true)"), "E0303:1");
  assert_string_equal(found("f(x, y = 2) = x + y\nprint f(1, 2, 3)"), "E0302:2");
  assert_string_equal(found("f(x, y = 2) = x + y\nprint f(y: 1)"), "E0302:2");
  assert_string_equal(found("f(x, y = 2) = x + y\nprint f(1, z: 1)"), "E0303:2");
  assert_string_equal(found("f(x, y = 2) = x + y\nprint f(1, x: 1)"), "E0303:2");
  assert_string_equal(found("f(x, y = 2) = x + y\nprint 1 |> f(2), 1 |> f(y: 3)"), "");
  assert_string_equal(found("f(x) = x\nprint 1 |> f(2)"), "E0302:2");
  assert_string_equal(found("g = { h(a) = a; h(1, 2) }\nprint g"), "E0302:1");
  assert_string_equal(found("import std.materials as m\nprint m.glazed(\"red\", 1, 2, 3, 4)"),
                      "E0302:2");
}

static void arguments_are_held_against_the_words_of_the_documentation(void **state) {
  (void)state;
  assert_string_equal(found("print rotate(Z, 30)"), "E0301:1");
  assert_string_equal(found("print camera(eye: [1, 2, 3], fov: 35)"), "E0301:1");
  assert_string_equal(found("print revolve(circle(5), 360)"), "E0301:1");
  assert_string_equal(found("show sphere(2) |> material(\"red\")"), "E0301:1");
  assert_string_equal(found("print len(3)"), "E0301:1");
  assert_string_equal(found("print bspline(3)"), "E0301:1");
  assert_string_equal(found("print bspline([[0, 0], [1, 1]], degree: \"2\")"), "E0301:1");
  assert_string_equal(found("print read_csv(\"a.csv\", header: true)"), "");
  assert_string_equal(found("print map(\"abc\", upper), first(\"abc\", 2)"), "");
  assert_string_equal(found("print rotate(line([0, 0], [2, 0]), 90deg, [1, 0])"), "");
  assert_string_equal(found("print max([1, 2]), max(1, 2), false and error(\"no\")"), "");
  assert_string_equal(found("print tube(line([0, 0, 0], [0, 0, 5]), t => 2 - t)"), "");
}

static void calls_of_shapes_and_members_are_held_against_their_types(void **state) {
  (void)state;
  assert_string_equal(found("c = circle(2)\nprint c(0deg, 1)"), "E0302:2");
  assert_string_equal(found("s = bilinear([0, 0], [0, 2], [4, 0], [4, 2])\nprint s(0)"), "E0302:2");
  assert_string_equal(found("s = bilinear([0, 0], [0, 2], [4, 0], [4, 2])\nprint s(0, 1)"), "");
  assert_string_equal(found("print [1, 2].x, (0..1).end, [1, 2].foo"), "E0306:1");
  assert_string_equal(found("x = 3\nprint x.y"), "E0306:2");
  assert_string_equal(found("show 3, \"text\""), "E0327:1 E0327:1");
  assert_string_equal(found("print [for x in 5: x], 1 in 2"), "E0301:1 E0321:1");
  assert_string_equal(found("print sphere(2) | 3"), "E0321:1");
}

static void defaults_of_params_are_in_their_range_or_list(void **state) {
  (void)state;
  assert_string_equal(found("param h = \"a\" in 1..3\nprint h"), "E0250:1");
  assert_string_equal(found("param h = 2.5 in [1, 2, 3]\nprint h"), "E0250:1");
  assert_string_equal(found("param h = \"c\" in [\"a\", \"b\"]\nprint h"), "E0250:1");
  assert_string_equal(found("param h = \"b\" in [\"a\", \"b\"]\nprint h"), "");
  // Computed values are not checked without a run.
  assert_string_equal(found("param x = 2 * 5 in [10, 20]\nprint x"), "");
  assert_string_equal(found("param x = 2 * 5 in [30, 20]\nprint x"), "");
  assert_string_equal(found("param h = 2 in [1, 2, 3]\nprint h"), "");
}

static void functions_of_a_module_are_found_wherever_they_stand(void **state) {
  (void)state;
  assert_string_equal(found("import std.materials as m\nprint m.metal(1, 2, 3, 4, 5, 6)"),
                      "E0302:2");
  assert_string_equal(found("import std.kinematics: joint, freedoms\n"
                            "print joint(\"screw\", foo: 1), freedoms(1, 2)"),
                      "E0303:2 E0302:2");
}

static void types_that_cannot_be_are_found(void **state) {
  (void)state;
  assert_string_equal(found("print sin(30)"), "E0301:1");
  assert_string_equal(found("print sqrt(2deg)"), "E0301:1");
  assert_string_equal(found("print 1 + 2deg"), "E0321:1");
  assert_string_equal(found("a = 3\nprint a + \"x\""), "E0321:2");
  assert_string_equal(found("c = line([0, 0, 0], [1, 0, 0])\nprint gaussian_curvature(c, 0, 0)"),
                      "E0301:2");
  assert_string_equal(found("print if 1 then 2 else 3"), "E0309:1");
  assert_string_equal(found("print not 1, 1 and true"), "E0309:1 E0309:1");
  assert_string_equal(found("print 3(4)"), "E0304:1");
  assert_string_equal(found("print true[0]"), "E0301:1");
  assert_string_equal(found("print -\"a\""), "E0321:1");
  assert_string_equal(found("print [for i in 0..3: sin(i)]"), "E0301:1");
  assert_string_equal(found("param h = 10 in 20..30\nprint h"), "E0250:1");
}

// Also in parameters after the first.
static void each_function_says_what_it_takes(void **state) {
  (void)state;
  static const struct {
    const char *function, *good, *wrong; // values of the parameter
    int count;                           // number of parameters that accept them
  } rows[] = {
      {"sqrt", "2", "true", 1},         {"cbrt", "2", "\"a\"", 1},
      {"exp", "2", "[1]", 1},           {"ln", "2", "1..2", 1},
      {"log10", "2", "none", 1},        {"log2", "2", "2deg", 1},
      {"sinh", "2", "2deg", 1},         {"cosh", "2", "true", 1},
      {"tanh", "2", "2deg", 1},         {"asinh", "2", "2deg", 1},
      {"acosh", "2", "[2]", 1},         {"atanh", "0.5", "2deg", 1},
      {"floor", "2", "\"a\"", 1},       {"ceil", "2", "2deg", 1},
      {"hypot", "2", "2deg", 2},        {"asin", "0.5", "2deg", 1},
      {"acos", "0.5", "2deg", 1},       {"atan", "2", "2deg", 1},
      {"atan2", "2", "\"a\"", 2},       {"sin", "2deg", "\"a\"", 1},
      {"cos", "2deg", "true", 1},       {"tan", "2deg", "[1]", 1},
      {"in_degrees", "2deg", "2", 1},   {"in_radians", "2deg", "2", 1},
      {"norm", "[1, 2]", "2", 1},       {"unit", "[1, 2]", "true", 1},
      {"cross", "[1, 2, 3]", "2", 2},   {"dot", "[1, 2]", "\"a\"", 2},
      {"sum", "[1, 2]", "2", 1},        {"upper", "\"a\"", "2", 1},
      {"lower", "\"a\"", "[1]", 1},     {"starts_with", "\"a\"", "2", 2},
      {"read_csv", "\"a\"", "2", 1},    {"read_json", "\"a\"", "2", 1},
      {"read_text", "\"a\"", "[1]", 1}, {"read_mesh", "\"a\"", "true", 1},
      {"roots", "[1, 2]", "2", 1},      {"complex_roots", "[1, 2]", "\"a\"", 1},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    for (int k = -1; k < rows[i].count; k++) {
      char text[256];
      int n = snprintf(text, sizeof text, "f = () => %s(", rows[i].function);
      for (int j = 0; j < rows[i].count; j++)
        n += snprintf(text + n, sizeof text - (size_t)n, "%s%s", j ? ", " : "",
                      j == k ? rows[i].wrong : rows[i].good);
      snprintf(text + n, sizeof text - (size_t)n, ")");
      if (strcmp(found(text), k < 0 ? "" : "E0301:1") != 0) fail_msg("%s", text);
    }
}

static void types_are_inferred_through_patterns(void **state) {
  (void)state;
  assert_string_equal(found("[x, y] = [1, \"a\"]\nprint x + 1, y - 1"), "E0321:2");
  assert_string_equal(found("{a, b: [c]} = {a: 1, b: [\"t\"]}\nprint a, c - 1"), "E0321:2");
  assert_string_equal(found("f(v) = { [x, y] = [30, v]; sin(x) + y }\nprint f(1)"), "E0301:1");
  assert_string_equal(found("[x, ...r] = [1, 2]\nprint x, r + 1deg"), "E0321:2");
  assert_string_equal(found("[g, x] = [(a, b) => a + b, 1]\nprint g(x)"), "E0302:2");
  assert_string_equal(found("[x, y] = [1, 2, 3]\nprint x, y"), "E0325:1");
  assert_string_equal(found("{a, b} = {a: 1}\nprint a, b"), "E0325:1");
  assert_string_equal(found("[x] = 3\nprint x"), "E0325:1");
  assert_string_equal(found("{x} = [3]\nprint x"), "E0325:1");
  assert_string_equal(
      found("r = {b: 2}\n{a, b} = {...r, a: 1}\n[x, y] = [1, ...[2]]\nprint a, b, x, y"), "");
  assert_string_equal(found("[x, y] = 0deg..1deg\nprint sin(x), sin(y)"), "");
  assert_string_equal(found("print [for [k, v] in {a: 1}: [k, v]]"), "");
  assert_string_equal(found("print [for {k} in 0..3: k]"), "E0325:1");
  // Errors in a part are reported once.
  assert_string_equal(found("[x, y] = [1 + \"a\", sin(3)]\nprint x, y"), "E0321:1 E0301:1");
}

static void names_of_patterns_that_nothing_uses_are_told(void **state) {
  (void)state;
  assert_string_equal(found("[x, y] = [1, 2]\nprint x"), "E0900:1");
  assert_string_equal(found("[x, _] = [1, 2]\nprint x"), "");
  assert_string_equal(found("print { [x, y] = [1, 2]; x }"), "E0900:1");
  assert_string_equal(found("n = 3\n[x, _] = [n, 2]\nprint x"), "");
  assert_string_equal(found("[a, b] = [b, 1]\nprint a, b"), "E0311:1");
  assert_string_equal(found("[a, b] = [1, () => a]\nprint a, b()"), "");
}

static void literal_mistakes_are_found(void **state) {
  (void)state;
  assert_string_equal(found("show sphere(-3)"), "E0314:1");
  assert_string_equal(found("show color(box(1), \"redd\")"), "E0501:1");
  assert_string_equal(found("show box([1, 2])"), "E0301:1");
  assert_string_equal(found("s = box(1)\nshow s |> color(\"redd\")"), "E0501:2");
  assert_string_equal(found("print sqrt(2 - 3), acos(2)"), "E0307:1 E0314:1");
  assert_string_equal(found("show group(sphere(-1), sphere(-2), sphere(1))"), "E0314:1 E0314:1");
  assert_string_equal(found("s = sphere(-3)\nshow s, color(s, \"redd\")"), "E0314:1");
  assert_string_equal(found("f(s) = color(s, \"redd\")\nshow f(box(1))"), "");
  assert_string_equal(found("r = -3\nf(x) = if x then sphere(r) else 0\nprint f(false)"),
                      "E0314:2");
  assert_string_equal(found("code(f) = attempt(f, e => e.code)\nprint code(() => sphere(-3))"), "");
  assert_string_equal(found("param r = 3 in -5..5\nshow sphere(r - 4)"), ""); // -D may change it
  assert_string_equal(found("print read_text(\"none.txt\"), sky(\"none.exr\")"), "");
}

static void circles_of_definitions_are_found(void **state) {
  (void)state;
  assert_string_equal(found("a = b\nb = a\nprint a"), "E0311:2");
  assert_string_equal(found("a = a + 1\nprint a"), "E0311:1");
  assert_string_equal(found("f(x) = a + x\na = 2 |> f\nprint a"), "E0311:1");
  assert_string_equal(found("a = [b]\nb = { x: c }\nc = { y = a; y }\nprint c"), "E0311:3");
  // Expressions that need not be evaluated do not make a circular definition.
  assert_string_equal(found("a = if time > 0 then b else 1\nb = a\nprint b"), "");
  assert_string_equal(found("f(n) = if n == 0 then 1 else n * f(n - 1)\nprint f(3)"), "");
  assert_string_equal(found("f(n) = g(n)\ng(n) = f(n)\nprint f(3)"), "");
  assert_string_equal(found("a = x => b(x)\nb(x) = if x > 0 then a(x - 1) else 1\nprint a(1)"), "");
  assert_string_equal(found("a = [for i in 1..0: a]\nprint a"), "");
}

// Operands that are always evaluated make a circular definition, and others do not.
static void circles_are_found_in_every_part_of_expressions(void **state) {
  (void)state;
  static const char *const always[] = {"a",
                                       "(a)",
                                       "-a",
                                       "not a",
                                       "[a]",
                                       "[1, a]",
                                       "[...a]",
                                       "{x: a}",
                                       "{x: 1, y: a}",
                                       "{ c = a; c }",
                                       "{ c = 1; c + a }",
                                       "{ assert a > 1; 2 }",
                                       "1 + a",
                                       "a * 2",
                                       "x[a]",
                                       "a[0]",
                                       "a and x",
                                       "a or x",
                                       "a |> f",
                                       "1 |> f(a)",
                                       "a |> f(1)",
                                       "f(a)",
                                       "f(1, y: a)",
                                       "a(1)",
                                       "a..1",
                                       "1..a",
                                       "1..2 by a",
                                       "if a then 1 else 2",
                                       "a.z",
                                       "[for i in a: i]",
                                       "\"t {a}\"",
                                       "g(1)",
                                       "1 |> g",
                                       "1 |> g()",
                                       "sqrt(a)",
                                       "a == 1",
                                       "a in 1..2",
                                       "[[[1, [a]]]]"};
  static const char *const sometimes[] = {"x and a",
                                          "x or a",
                                          "if x then a else 2",
                                          "if x then 1 else a",
                                          "[for i in [1]: a]",
                                          "[for i in [1], k in a: i]",
                                          "[for i in [1] if a: i]",
                                          "q => a",
                                          "g",
                                          "{x: g}"};
  char script[400];
  size_t bad = 0;
  for (int way = 0; way < 2; way++) {
    const size_t n = way ? sizeof sometimes / sizeof *sometimes : sizeof always / sizeof *always;
    for (size_t i = 0; i < n; i++) {
      snprintf(
          script, sizeof script,
          "print a\na = 1 + b\nb = %s\nx = []\nf(p, y = 1) = p + y\ng(p) = p + a\nprint x, f, g",
          way ? sometimes[i] : always[i]);
      const bool circle = strstr(found(script), "E0311") != NULL;
      if (circle != !way) {
        print_error("%s: %s\n", script, found(script));
        bad++;
      }
    }
  }
  assert_int_equal(bad, 0);
}

static void one_pass_reports_everything(void **state) {
  (void)state;
  assert_string_equal(found("show sphere(-3)\nprint hieght\nshow box([1, 2])\na = b\nb = a\n"
                            "print sin(30), colour\nshow color(box(1), \"redd\")"),
                      "E0314:1 E0201:2 E0301:3 E0311:5 E0301:6 E0201:6 E0501:7");
  assert_string_equal(found("import nowhere\nprint sphere(-2), hieght, nowhere.x"),
                      "E0240:1 E0314:2 E0201:2");
  assert_string_equal(found("import nowhere: a\nprint a(1), sin(30)"), "E0240:1 E0301:2");
}

static void checking_continues_after_syntax_errors(void **state) {
  (void)state;
  assert_string_equal(found("a = 1 +* 2\nb = sphere(-3)\nprint hieght\nprint sin(30), a, b"),
                      "E0120:1 E0314:2 E0201:3 E0301:4");
  assert_string_equal(found("f(x) = {\n  y = x *\n}\nprint f(1, 2), hieght"), "E0120:3 E0201:4");
  assert_string_equal(found("let n = 3\nprint n + \"a\"\nc = d\nd = c"), "E0152:1 E0321:2 E0311:4");
  assert_string_equal(found("import nowhere\nx = [1, 2\nshow sphere(-1)"),
                      "E0240:1 E0123:2 E0314:3");
  assert_string_equal(found("cube(3)\nshow cube(4)"), "E0150:1 E0201:1 E0201:2");
}

static void names_of_a_damaged_statement_are_not_unknown(void **state) {
  (void)state;
  assert_string_equal(found("f(x) = 3 +* 1\nprint f(1, 2, 3).y"), "E0120:1");
  assert_string_equal(found("module knob(r, h) { cylinder(h, r); }\nshow knob(3, r)"),
                      "E0152:1 E0168:1");
  assert_string_equal(found("sphere = [1, 2\nprint sphere(-3)"), "E0123:1"); // hides the built-in
  assert_string_equal(found("import std.materials: glass, *\nprint glass(1, 2), materials.x"),
                      "E0129:1");
  assert_string_equal(found("a = `text\nb = 3\nprint `b`, b, a"), "E0122:3");
  assert_string_equal(found("print b\n/* no end\nb = 3"), "E0103:2");
  assert_string_equal(found("area(r) r * r\nprint half(2)\nhalf(r) r / 2"), "E0168:1 E0168:3");
  assert_string_equal(found("scan [for i in 0..3: i]\nprint scan + 1"), "E0161:1"); // a built-in
  assert_string_equal(
      found("print attempt() => cos(1), e => 3)\nprint attempt(() => sin(1), e => 3)"), "E0144:1");
  assert_string_equal(found("f = (x, y) => x + (y *\nprint x, y, f(1)"), "E0123:1");
  assert_string_equal(found("l = [for i in 0..3:\ni + ]\nprint l, i"), "E0120:2");
}

// In this script, replacing any bracket, quote, or `=` with a blank causes only syntax errors.
static const char whole[] =
    "/// Ring of holes.\n"
    "import std.materials: steel\n"
    "param count = 6 in 3..12 \"Number of holes\"\n"
    "width = 12.5mm\n"
    "names = [\"a\", `b`, \"c {width}\"]\n"
    "hole(r, h = 4) = {\n"
    "  wide = (r + 1) / 2\n"
    "  assert wide > 0, \"no width\"\n"
    "  cylinder(h, wide) |> translate([0, 0, -(h / 2)])\n"
    "}\n"
    "holes = [for i in 0..<count, k in [0, 1]:\n"
    "  hole(1) |> rotate([0, 0, 1], i * 60deg + k * 1deg)]\n"
    "area_of = (a, b) => { c = a * b\n"
    "  if c > 3 then c else (c + 1) }\n"
    "style = { color: \"red\", size: [1, 2], sum: sum([for x in 0..3: x]) }\n"
    "print len(names), area_of(2, 3), style.size[0]\n"
    "show difference(sphere(width), holes)\n";

static void a_missing_character_causes_only_syntax_errors(void **state) {
  (void)state;
  assert_string_equal(found(whole), "E0900:2");
  for (size_t i = 0; i < strlen(whole); i++) {
    if (!strchr("()[]{}\"`=", whole[i])) continue;
    char text[sizeof whole];
    memcpy(text, whole, sizeof whole);
    text[i] = ' ';
    const char *codes = found(text);
    for (const char *c = codes; (c = strchr(c, 'E')); c++)
      if (strncmp(c, "E01", 3) != 0 && strncmp(c, "E0900", 5) != 0)
        fail_msg("without character %zu: %s\n%s", i, codes, text);
  }
}

static void scripts_cut_off_anywhere_are_checked(void **state) {
  (void)state;
  char text[sizeof whole];
  for (size_t i = 0; i < sizeof whole; i++) {
    snprintf(text, sizeof text, "%.*s", (int)i, whole);
    found(text);
  }
}

static void what_may_be_right_is_left_alone(void **state) {
  (void)state;
  assert_string_equal(found("f(x) = sin(x) + x\nprint f(1)"), ""); // the type of x is unknown
  assert_string_equal(found("x = if time > 0 then 1 else 1deg\nprint sin(x)"), "");
  assert_string_equal(found("print attempt(() => sin(30), e => e.code)"), "");
  assert_string_equal(found("even(n) = if n == 0 then true else odd(n - 1)\n"
                            "odd(n) = if n == 0 then false else even(n - 1)\nprint even(4)"),
                      "");
  assert_string_equal(found("print 360deg * time, frame + frames"), "");
}

static void definitions_that_nothing_uses_are_told(void **state) {
  (void)state;
  assert_string_equal(found("a = 1\nb = 2\nprint b"), "E0900:1");
  assert_string_equal(found("a = b\nb = 2\nprint 1"), "E0900:1 E0900:2");
  assert_string_equal(found("a = 1\n_b = 2\n"), "E0900:2"); // a module
  assert_string_equal(found("import std.materials\nprint 1"), "E0900:1");
  assert_string_equal(found("import std.materials: glazed, matte\nprint glazed(\"red\")"),
                      "E0900:1");
  assert_string_equal(found("print { a = 1; _b = 2; 3 }"), "E0900:1");
  assert_string_equal(found("print if true then 1 else 2"), "E0901:1");
  assert_string_equal(found("/// deprecated: use g\nf(x) = x\nprint f(1)"), "E0902:3");
}

static void a_long_chain_of_definitions_is_no_trouble(void **state) {
  (void)state;
  char *script = malloc(4000000), *p = script;
  for (int i = 0; i < 100000; i++) p += sprintf(p, "a%d = a%d + 1\n", i, i + 1);
  sprintf(p, "a100000 = 1\nprint a0\n");
  assert_string_equal(found(script), "");
  free(script);
}

// The types of all names in a block are known, no matter how many there are. Here, _l0, _l3, ...
// are numbers, _l1, ... are angles, and _l2, ... are texts. One of them is added to a text.
static void types_of_many_local_names_are_known(void **state) {
  (void)state;
  enum { NAMES = 1000 };
  char *script = malloc(100000);
  for (int wrong = 0; wrong < NAMES; wrong += 37) {
    char *p = script + sprintf(script, "print {\n");
    for (int i = 0; i < NAMES; i++)
      p += sprintf(p, "_l%d = %s\n", i, i % 3 == 0 ? "1" : i % 3 == 1 ? "2deg" : "\"a\"");
    p += sprintf(p, "_l%d + \"b\"\n}, {", wrong);
    for (int i = 0; i < NAMES; i++) p += sprintf(p, "_x%d = 1\n", i);
    p += sprintf(p, "[_x0");
    for (int i = 1; i < NAMES; i++) p += sprintf(p, ", _x%d", i);
    sprintf(p, "]}\n");
    const char *told = found(script);
    char expected[16];
    snprintf(expected, sizeof expected, "E0321:%d", NAMES + 2);
    if ((strstr(told, "E0321") != NULL) != (wrong % 3 != 2) ||
        (wrong % 3 != 2 && !strstr(told, expected)))
      fail_msg("_l%d: %s", wrong, told);
  }
  free(script);
}

// The examples in the table of built-ins are correct.
static void examples_are_found_right(void **state) {
  (void)state;
  const char *signature, *summary, *example, *family;
  size_t seen = 0;
  for (size_t i = 0; cag_builtin_row(i, &signature, &summary, &example, &family); i++) {
    if (!example || strstr(example, "expect error")) continue;
    seen++;
    const char *codes = found(example);
    if (strstr(codes, "E03") || strstr(codes, "E02"))
      fail_msg("%s: %s in\n%s", signature, codes, example);
  }
  assert_true(seen > 300);
}

static void a_check_has_all_of_the_time(void **state) {
  (void)state;
  CagSessionOptions options;
  cag_session_options_init(&options);
  options.max_time = 60;
  CagSession *s = cag_session_new(&options);
  for (int i = 0; i < 10; i++) // the file watch may be late
    assert_int_equal(cag_session_check_file(s, "stdlib/robots.cag"), CAG_STATUS_OK);
  cag_session_free(s);
}

// The first diagnostic of a script; its span is between « and » in the script.
static void messages_mark_what_is_wrong(void **state) {
  (void)state;
  static const struct {
    const char *script, *code, *message, *help; // help may be NULL
  } rows[] = {
      {"print sqrt(1, «2»)", "E0302", "sqrt takes 1 argument, found 2", NULL},
      {"print «sqrt()»", "E0302", "sqrt needs an argument for `x`", NULL},
      {"f(x, y) = x + y\nprint «f(1)»", "E0302", "f needs an argument for `y`", NULL},
      {"f(x, y) = x + y\nprint f(1, 2, «3», 4)", "E0302", "f takes 2 arguments, found 4", NULL},
      {"f(x, y) = x + y\nprint 1 |> f(2, «3»)", "E0302", "f takes 2 arguments, found 3", NULL},
      {"f(x, y) = x + y\nprint f(1, «x»: 3, y: 2)", "E0303", "f already has x, by position", NULL},
      {"f(x, y) = x + y\nprint 1 |> f(y: 2, «x»: 3)", "E0303", "f already has x, by position",
       NULL},
      {"f(width) = width\nprint f(1, «widht»: 2)", "E0303", "f has no parameter widht",
       "did you mean `width`?"},
      {"f(a, b, c) = a + b + c\nprint «f(1, c: 2)»", "E0302", "f needs an argument for `b`", NULL},
      {"f(a, b, c) = a + b + c\nprint 1 |> «f(b: 2)»", "E0302", "f needs an argument for `c`",
       NULL},
      {"print sin(«30»)", "E0301", "sin expects an angle, found a number", "write 30deg or 30rad"},
      {"x = 30\nprint sin(«x»)", "E0301", "sin expects an angle, found a number", NULL},
      {"print «30» |> sin", "E0301", "sin expects an angle, found a number",
       "write 30deg or 30rad"},
      {"print sqrt(«2deg»)", "E0301", "sqrt expects a number, found an angle", NULL},
      {"print atan2(1, «\"a\"»)", "E0301", "atan2 expects a number as `x`, found a text", NULL},
      {"print len(«3»)", "E0301", "found a number", "write len([1, 2])"},
      {"print «1 + 2deg»", "E0321", "cannot apply + to a number and an angle",
       "write the number with a unit: 1deg"},
      {"print «2 + \"a\"»", "E0321", "cannot apply + to a number and a text", NULL},
      {"print «true ^ 2»", "E0321", "cannot apply ^ to a bool and a number", NULL},
      {"print if «1» then 2 else 3", "E0309", "if expects true or false, found a number", NULL},
      {"print if true == false then 2 else if «\"a\"» then 3 else 4", "E0309",
       "if expects true or false, found a text", NULL},
      {"print not «1»", "E0309", "not expects true or false, found a number", NULL},
      {"print «1» and true", "E0309", "and expects true or false, found a number", NULL},
      {"print true or «[1]»", "E0309", "or expects true or false, found a list", NULL},
      {"assert «1», \"no\"", "E0309", "assert expects true or false, found a number", NULL},
      {"print { assert «1»; 2 }", "E0309", "assert expects true or false, found a number", NULL},
      {"assert 1 < 2, «\"a\" + 1»", "E0321", "cannot apply + to a text and a number", NULL},
      {"print [for x in «5»: x]", "E0301",
       "a comprehension needs a list, range, text, or record, found a number", NULL},
      {"print [for x in 1..5 if «x»: x]", "E0309",
       "the condition expects true or false, found a number", NULL},
      {"print [for x in 1deg..5deg: «x + 1»]", "E0321", "cannot apply + to an angle and a number",
       "write the number with a unit: 1deg"},
      {"print [for c in \"abc\": «c + 1»]", "E0321", "cannot apply + to a text and a number", NULL},
      {"print «true»[0]", "E0301", "[ ] expects a list, a range, a text, or a record, found a bool",
       NULL},
      {"print «-\"a\"»", "E0321", "- does not take a text", NULL},
      {"print «0..360deg»", "E0301",
       "a range needs two numbers or two angles, found a number and an angle",
       "write the number with a unit: 0deg"},
      {"print «90deg..180»", "E0301",
       "a range needs two numbers or two angles, found an angle and a number",
       "write the number with a unit: 180deg"},
      {"print 1..«\"a\"»", "E0301",
       "the ends and the step of a range must be numbers or angles, found a text", NULL},
      {"print 1..2 by «true»", "E0301",
       "the ends and the step of a range must be numbers or angles, found a bool", NULL},
      {"print [1, 2].«foo»", "E0306", "a list has no member `foo`", NULL},
      {"x = 3\nprint x.«sqrt»", "E0306", "a number has no member `sqrt`", "write x |> sqrt(...)"},
      {"print (1..2).«middle»", "E0306", "a range has no member `middle`", NULL},
      {"print «3»(4)", "E0304", "a call needs a function, found a number", NULL},
      {"norm = 50\nprint «norm»(1)", "E0304", "a call needs a function, found a number",
       "`norm` is defined here and hides the built-in function; rename it"},
      {"c = circle(2)\nprint «c(0deg, 1)»", "E0302", "a curve takes one parameter", NULL},
      {"s = sphere_surface(1)\nprint «s(0deg)»", "E0302", "a surface takes two parameters", NULL},
      {"s = sphere_surface(1)\nprint «s(0deg, 1deg, 2deg)»", "E0302",
       "a surface takes two parameters", NULL},
      {"show «3»", "E0327",
       "show expects shapes, images, lights, cameras, or settings of the scene, found a number",
       NULL},
      {"param h = «5» in 1..4\nprint h", "E0250", "the default of h lies outside of its range",
       NULL},
      {"param h = «4» in 1..<4\nprint h", "E0250", "the default of h lies outside of its range",
       NULL},
      {"param h = «-1» in 0..4\nprint h", "E0250", "the default of h lies outside of its range",
       NULL},
      {"param h = «\"a\"» in 1..4\nprint h", "E0250", "the default of h is not in its range", NULL},
      {"param h = «3» in [1, 2]\nprint h", "E0250",
       "the default of h is not in the list of allowed values", NULL},
      {"param h = «1» in [1deg, 2deg]\nprint h", "E0250",
       "the default of h is not in the list of allowed values", NULL},
      {"a = 1 + b\nb = «a»\nprint a", "E0311", "depends on itself: a -> b -> a", NULL},
      {"«aa» = 1\nprint 2", "E0900", "aa is not used", NULL},
      {"«aa» = bb\nbb = 2\nprint 2", "E0900", "aa is not used", NULL},
      {"bb = 2\n«_aa» = bb\n", "E0900", "_aa is not used", NULL},
      {"import «std.materials»\nprint 1", "E0900", "the module materials is not used", NULL},
      {"import std.materials: «matte»\nprint 1", "E0900", "matte is not used", NULL},
      {"print { «a» = 1; 3 }", "E0900", "a is not used", NULL},
      {"print if true then 1 else «2»", "E0901", "the condition is always true", NULL},
      {"print if false then «1» else 2", "E0901", "the condition is always false", NULL},
      {"/// deprecated:  use g\n/// please\nf(x) = x\nprint «f»(1)", "E0902", "f is deprecated",
       "use g"},
  };
  size_t bad = 0;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    char text[256];
    const char *left = strstr(rows[i].script, "«"), *right = strstr(left, "»");
    const int before = (int)(left - rows[i].script), marked = (int)(right - left) - 2;
    snprintf(text, sizeof text, "%.*s%.*s%s", before, rows[i].script, marked, left + 2, right + 2);
    size_t line = 1, column = 1;
    for (int k = 0; k < before; k++) {
      column++;
      if (text[k] == '\n') line++, column = 1;
    }
    CagSessionOptions options;
    cag_session_options_init(&options);
    CagSession *s = cag_session_new(&options);
    cag_session_check_text(s, "test", text, strlen(text));
    CagErrorView e = {0};
    cag_session_error(s, 0, &e);
    const char *help = e.help ? e.help : "";
    if (!e.code || strcmp(e.code, rows[i].code) != 0 || e.line != line || e.column != column ||
        e.end_column != column + (size_t)marked || !strstr(e.message, rows[i].message) ||
        (rows[i].help ? !strstr(help, rows[i].help) : *help != 0)) {
      print_error("%s\n  %s %zu:%zu-%zu: %s (%s)\n", text, e.code ? e.code : "no error", e.line,
                  e.column, e.end_column, e.message ? e.message : "", help);
      bad++;
    }
    cag_session_free(s);
  }
  assert_int_equal(bad, 0);
}

static void definitions_are_reached_through_others(void **state) {
  (void)state;
  // Chains in both orders, and a circle of functions that are not used elsewhere.
  assert_string_equal(found("a = 1\nb = a\nc = b\nprint c"), "");
  assert_string_equal(found("c = b\nb = a\na = 1\nprint c"), "");
  assert_string_equal(found("f(n) = g(n)\ng(n) = f(n)\nprint 1"), "E0900:1 E0900:2");
  assert_string_equal(found("param h = 1\nprint 1"), "E0900:1");
  assert_string_equal(found("a = 1\n_b = a\nc = _b\n"), "");
  char script[20000] = "print a0", one[64];
  for (int i = 0; i < 300; i++) { // more uses of one definition than the initial capacity
    snprintf(one, sizeof one, " + a%d", i);
    strcat(script, one);
  }
  for (int i = 0; i <= 300; i++) {
    snprintf(one, sizeof one, "\na%d = %d", i, i);
    strcat(script, one);
  }
  assert_string_equal(found(script), "E0900:302");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(arguments_are_counted_and_named),
      cmocka_unit_test(types_that_cannot_be_are_found),
      cmocka_unit_test(arguments_are_held_against_the_words_of_the_documentation),
      cmocka_unit_test(calls_of_shapes_and_members_are_held_against_their_types),
      cmocka_unit_test(defaults_of_params_are_in_their_range_or_list),
      cmocka_unit_test(functions_of_a_module_are_found_wherever_they_stand),
      cmocka_unit_test(each_function_says_what_it_takes),
      cmocka_unit_test(types_are_inferred_through_patterns),
      cmocka_unit_test(names_of_patterns_that_nothing_uses_are_told),
      cmocka_unit_test(literal_mistakes_are_found),
      cmocka_unit_test(circles_of_definitions_are_found),
      cmocka_unit_test(circles_are_found_in_every_part_of_expressions),
      cmocka_unit_test(one_pass_reports_everything),
      cmocka_unit_test(checking_continues_after_syntax_errors),
      cmocka_unit_test(names_of_a_damaged_statement_are_not_unknown),
      cmocka_unit_test(a_missing_character_causes_only_syntax_errors),
      cmocka_unit_test(scripts_cut_off_anywhere_are_checked),
      cmocka_unit_test(what_may_be_right_is_left_alone),
      cmocka_unit_test(definitions_that_nothing_uses_are_told),
      cmocka_unit_test(a_long_chain_of_definitions_is_no_trouble),
      cmocka_unit_test(types_of_many_local_names_are_known),
      cmocka_unit_test(examples_are_found_right),
      cmocka_unit_test(messages_mark_what_is_wrong),
      cmocka_unit_test(definitions_are_reached_through_others),
      cmocka_unit_test(a_check_has_all_of_the_time),
  };
  return cmocka_run_group_tests_name("checker", tests, NULL, NULL);
}
