// Files of data that read_csv, read_json and read_text read: bytes, and what a script makes of
// them, or the place of what is wrong.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "session_support.h"

static char folder[] = "/tmp/cag-data-files-XXXXXX";

// Runs the text, which prints one line, and compares the line.
static bool prints(const char *text, const char *expected) {
  char *out = NULL;
  size_t n = 0;
  CagSessionOptions options = session_options();
  options.out = open_memstream(&out, &n);
  CagSession *s = cag_session_new(&options);
  int status = cag_session_run_text(s, "main.cag", text, strlen(text));
  if (status != CAG_STATUS_OK) cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr);
  cag_session_free(s);
  fclose(options.out);
  if (n > 0 && out[n - 1] == '\n') out[n - 1] = 0;
  const bool good = status == CAG_STATUS_OK && strcmp(out, expected) == 0;
  if (!good) print_error("%s\n  gives: %s\n  and not: %s\n", text, out, expected);
  free(out);
  return good;
}

// What the script prints of the expression, in which the file of these bytes is F; where it fails,
// the message from the place on.
static bool reads_bytes(const char *bytes, size_t n, const char *expression, const char *expected) {
  FILE *f = fopen("F", "wb");
  assert_non_null(f);
  assert_int_equal(fwrite(bytes, 1, n, f), n);
  assert_int_equal(fclose(f), 0);
  char text[1000];
  snprintf(
      text, sizeof text,
      "F = \"F\"\n"
      "tail(t) = if index_of(t, \"line \") == none then t else rest(t, index_of(t, \"line \"))\n"
      "print attempt(() => %s, e => tail(e.message))\n",
      expression);
  return prints(text, expected);
}
#define READS(bytes, expression, expected)                                                         \
  bad += !reads_bytes(bytes, sizeof bytes - 1, expression, expected)

static void values_of_json(void **state) {
  (void)state;
  size_t bad = 0;
  READS("null", "read_json(F)", "none");
  READS(" \t\r\n true\n", "read_json(F)", "true");
  READS("\xEF\xBB\xBF[1]", "read_json(F)", "[1]");
  READS("[]", "read_json(F)", "[]");
  READS("[ ]", "read_json(F)", "[]");
  READS("{ }", "read_json(F)", "{}");
  READS("[1 , 2\n,\t3]", "read_json(F)", "[1, 2, 3]");
  READS("[-1.5e2, 0.25E+1, 1e-3]", "read_json(F)", "[-150, 2.5, 0.001]");
  READS("{\"a\" : {\"b\":[{}]} , \"c\":\"\"}", "read_json(F)", "{a: {b: [{}]}, c: \"\"}");
  READS("\"\\\"\\\\\\/\"", "[read_json(F)]", "[\"\\\"\\\\/\"]");
  READS("\"\\b\\f\\n\\r\\t\"", "read_json(F) == \"\\u{8}\\u{c}\\n\\u{d}\\t\"", "true");
  READS("\"\\u0041\\u00e9\\u20AC\\uFFFF\\ud7ff\\ue000\"",
        "read_json(F) == \"A\\u{e9}\\u{20ac}\\u{ffff}\\u{d7ff}\\u{e000}\"", "true");
  // Both ends of what pairs can hold.
  READS("\"\\ud800\\udc00\\uDBFF\\uDFFF\\ud83d\\uDE00\"",
        "read_json(F) == \"\\u{10000}\\u{10ffff}\\u{1f600}\"", "true");
  READS("\" \x7f\"", "read_json(F) == \" \\u{7f}\"", "true");
  // Of equal names the last value holds, at the place of the first.
  READS("{\"b\":1,\"a\":2,\"c\":3,\"a\":4,\"b\":5,\"b\":6}", "read_json(F)", "{b: 6, a: 4, c: 3}");
  READS("{\"k\":1,\"j\":2,\"i\":3,\"h\":4,\"g\":5,\"f\":6,\"e\":7,\"d\":8,\"c\":9,\"b\":10}",
        "read_json(F)", "{k: 1, j: 2, i: 3, h: 4, g: 5, f: 6, e: 7, d: 8, c: 9, b: 10}");
  assert_int_equal(bad, 0);
}

static void places_of_errors_in_json(void **state) {
  (void)state;
  size_t bad = 0;
  READS("", "read_json(F)", "line 1, column 1: the file ends where a value was expected");
  READS("[1,\n", "read_json(F)", "line 2, column 1: the file ends where a value was expected");
  READS("[1 2]", "read_json(F)", "line 1, column 4: expected `,` or `]`");
  READS("[1", "read_json(F)", "line 1, column 3: expected `,` or `]`");
  READS("[1,]", "read_json(F)", "line 1, column 4: expected a value");
  READS("nul", "read_json(F)", "line 1, column 1: expected a value");
  READS("truth", "read_json(F)", "line 1, column 1: expected a value");
  READS("nulls", "read_json(F)", "line 1, column 5: unexpected text after the value");
  READS("1 2", "read_json(F)", "line 1, column 3: unexpected text after the value");
  READS("{1:2}", "read_json(F)", "line 1, column 2: expected a name in quotes");
  READS("{\"a\" 2}", "read_json(F)", "line 1, column 6: expected `:`");
  READS("{\"a\":2", "read_json(F)", "line 1, column 7: expected `,` or `}`");
  READS("{\"a\":2 3}", "read_json(F)", "line 1, column 8: expected `,` or `}`");
  READS("{\"a\":2,}", "read_json(F)", "line 1, column 8: expected a name in quotes");
  READS("[1e999]", "read_json(F)", "line 1, column 2: the number is too large");
  READS("[\n -\n]", "read_json(F)", "line 2, column 2: the number is too large");
  READS("[1-2]", "read_json(F)", "line 1, column 2: the number is too large");
  // Columns count characters.
  READS("[\"\xE2\x82\xAC\xC3\xA9\", ?]", "read_json(F)", "line 1, column 8: expected a value");
  READS("[\"abc]", "read_json(F)", "line 1, column 2: a text that is never closed");
  READS("[\"abc\n\"]", "read_json(F)", "line 1, column 2: a text that is never closed");
  READS("[\"a\x01\"]", "read_json(F)",
        "line 1, column 4: a control character in a text: write \\u0001");
  READS("[\"a\x1f\"]", "read_json(F)",
        "line 1, column 4: a control character in a text: write \\u001f");
  READS("\"a\\x\"", "read_json(F)", "line 1, column 4: an unknown escape");
  READS("\"\\u12g4\"", "read_json(F)", "line 1, column 6: expected four hexadecimal digits");
  READS("\"\\u12", "read_json(F)", "line 1, column 6: expected four hexadecimal digits");
  READS("\"\\u12G4\"", "read_json(F)", "line 1, column 6: expected four hexadecimal digits");
  READS("\"\\u12@4\"", "read_json(F)", "line 1, column 6: expected four hexadecimal digits");
  READS("\"\\u0000\"", "read_json(F)", "line 1, column 4: a NUL character");
  READS("\"\\ud800\"", "read_json(F)", "line 1, column 4: an incomplete surrogate pair");
  READS("\"\\udc00\"", "read_json(F)", "line 1, column 4: an incomplete surrogate pair");
  READS("\"\\udfff\\ud800\"", "read_json(F)", "line 1, column 4: an incomplete surrogate pair");
  READS("\"\\ud800\\n\"", "read_json(F)", "line 1, column 4: an incomplete surrogate pair");
  READS("\"\\ud800xudc00\"", "read_json(F)", "line 1, column 4: an incomplete surrogate pair");
  READS("\"\\ud800\\udbff\"", "read_json(F)", "line 1, column 4: an incomplete surrogate pair");
  READS("\"\\ud800\\ue000\"", "read_json(F)", "line 1, column 4: an incomplete surrogate pair");
  READS("\"\\ud800\\u", "read_json(F)", "line 1, column 4: an incomplete surrogate pair");
  READS("\"\\ud800\\u12", "read_json(F)", "line 1, column 4: an incomplete surrogate pair");
  READS("\"\\ud800\\", "read_json(F)", "line 1, column 4: an incomplete surrogate pair");
  assert_int_equal(bad, 0);
}

// Brackets nest at most 1000 deep.
static void nesting_of_json(void **state) {
  (void)state;
  enum { DEPTH = 1000 };
  char text[2 * DEPTH + 3];
  memset(text, '[', DEPTH);
  memset(text + DEPTH, ']', DEPTH);
  size_t bad = !reads_bytes(text, 2 * DEPTH, "len(read_json(F))", "1");
  memset(text, '[', DEPTH + 1);
  memset(text + DEPTH + 1, ']', DEPTH + 1);
  bad += !reads_bytes(text, 2 * DEPTH + 2, "len(read_json(F))",
                      "line 1, column 1001: brackets nest deeper than 1000");
  assert_int_equal(bad, 0);
}

static void rows_of_csv(void **state) {
  (void)state;
  size_t bad = 0;
  READS("", "read_csv(F)", "[]");
  READS("\n\r\n\r", "read_csv(F)", "[]");
  READS("1,2", "read_csv(F)", "[[1, 2]]");
  READS("1,2\r\n3,4\r5,6\n\n7,8", "read_csv(F)", "[[1, 2], [3, 4], [5, 6], [7, 8]]");
  READS("1,\n,2\n,", "read_csv(F)", "[[1, none], [none, 2], [none, none]]");
  READS("\xEF\xBB\xBF"
        "a,b\n1,2",
        "read_csv(F)", "[{a: 1, b: 2}]");
  // One number makes the first row one of data; without a number it is a header, alone as well.
  READS("a,b,1\nc,d,e", "read_csv(F)", "[[\"a\", \"b\", 1], [\"c\", \"d\", \"e\"]]");
  READS("a,b\n", "read_csv(F)", "[]");
  READS("a,b\n", "read_csv(F, header: false)", "[[\"a\", \"b\"]]");
  READS("a,b\n", "read_csv(F, header: none)", "[]");
  READS("1,b\n2,3\n", "read_csv(F, header: true)", "[{\"1\": 2, b: 3}]");
  READS("a,,\n1,2,3\n4\n5,6\n", "read_csv(F)",
        "[{a: 1, column2: 2, column3: 3}, {a: 4, column2: none, column3: none}, "
        "{a: 5, column2: 6, column3: none}]");
  READS("\"1\",\" 2 \",\"x\"\"y\",\"\"\"\"\n", "read_csv(F, header: false)",
        "[[1, 2, \"x\\\"y\", \"\\\"\"]]");
  READS("\"a\nb\",\"c,d\"\r\n\"\",1e3", "read_csv(F, header: false)",
        "[[\"a\\nb\", \"c,d\"], [none, 1000]]");
  READS("x \"y\",z\n", "read_csv(F, header: false)", "[[\"x \\\"y\\\"\", \"z\"]]");
  READS("1;2\n3;4", "read_csv(F, separator: \";\")", "[[1, 2], [3, 4]]");
  READS("1\t2,5\n", "read_csv(F, separator: \"\\t\")", "[[1, \"2,5\"]]");
  READS("a;b\n\"1\";\"2;\"", "read_csv(F, \";\")", "[{a: 1, b: \"2;\"}]");
  // More cells than are reserved at first.
  READS("0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,21,22,23,24,25,26,27,28,29,30,31,32,"
        "33\n",
        "read_csv(F)[0] == [0..33]", "false");
  READS("0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,21,22,23,24,25,26,27,28,29,30,31,32,"
        "33\n",
        "read_csv(F)[0] == [for i in 0..33: i]", "true");
  assert_int_equal(bad, 0);
}

static void places_of_errors_in_csv(void **state) {
  (void)state;
  size_t bad = 0;
  READS("a,b\n1,\"2\n\n", "read_csv(F)", "line 2, column 3: a quote that is never closed");
  READS("1,\"2\"3\n", "read_csv(F)",
        "line 1, column 6: there is text after the closing quote of a cell");
  READS("a,b\n\n1,2\n3,4,5\n", "read_csv(F)", "line 4, column 1: 3 cells, but the header names 2");
  READS("a,b,a\n1,2,3\n", "read_csv(F)", "line 1, column 1: two columns are named \"a\"");
  READS("\na,column1,b\n", "read_csv(F, header: true)", "[]");
  READS("\n,column1\n", "read_csv(F, header: true)",
        "line 2, column 1: two columns are named \"column1\"");
  READS("1,2\n\xE9", "read_csv(F)", "line 2, column 1: not UTF-8: the byte 0xe9");
  READS("1,\xC3\xA9\x80", "read_csv(F)", "line 1, column 4: not UTF-8: the byte 0x80");
  READS("ab\0c", "read_text(F)", "line 1, column 3: a NUL character");
  for (const char *const *s = (const char *const[]){"\"\"", "\"ab\"", "\"\\n\"", "\"\\u{d}\"",
                                                    "\"\\\"\"", "\"\\u{e9}\"", NULL};
       *s; s++) {
    char call[100];
    snprintf(call, sizeof call, "attempt(() => read_csv(F, separator: %s), e => e.code)", *s);
    bad += !reads_bytes("1", 1, call, "E0314");
  }
  assert_int_equal(bad, 0);
}

static void texts_without_mark(void **state) {
  (void)state;
  size_t bad = 0;
  READS("", "[read_text(F)]", "[\"\"]");
  READS("\xEF\xBB\xBF", "[read_text(F)]", "[\"\"]");
  READS("\xEF\xBB\xBF\xEF\xBB\xBFx", "read_text(F) == \"\\u{feff}x\"", "true");
  READS("ab", "[read_text(F)]", "[\"ab\"]");
  READS("\xF0\x9D\x84\x9E\n", "len(read_text(F))", "2");
  READS("\xEF\xBB", "read_text(F)", "line 1, column 1: not UTF-8: the byte 0xef");
  assert_int_equal(bad, 0);
}

// json writes what read_json reads back.
static void json_both_ways(void **state) {
  (void)state;
  size_t bad = 0;
  bad += !prints("print json(\"q\\\"b\\\\n\\nt\\tr\\u{d}e\\u{1f}d\\u{7f} \\u{20ac}\")",
                 "\"q\\\"b\\\\n\\nt\\tr\\u000de\\u001fd\x7f \xE2\x82\xAC\"");
  bad += !prints("print json(translate([1, 2, 3]) * scale(2))",
                 "[[2, 0, 0, 1], [0, 2, 0, 2], [0, 0, 2, 3], [0, 0, 0, 1]]");
  bad += !prints("print json([1..3, 5..1 by -2, 30deg, none, false, [], {a: X, \"b c\": {}}])",
                 "[[1, 2, 3], [5, 3, 1], 30, null, false, [], {\"a\": [1, 0, 0], \"b c\": {}}]");
  bad += !prints(
      "print attempt(() => json([1, x => x]), e => e.message)",
      "json expects numbers, angles, texts, bools, none, lists, records, or transforms, found a function");
  bad += !prints("print attempt(() => json({a: [1, -inf]}), e => e.message)",
                 "json expects finite numbers, because JSON has no infinity");
  // Values nest at most 1000 deep, as brackets do: n + 1 lists, the innermost n deep.
  bad += !prints(
      "deep(n) = reduce(1..n, [], (a, i) => [a])\n"
      "print [for n in [100, 1000, 1001]: attempt(() => len(json(deep(n))), e => \"too deep\")]",
      "[202, 2002, \"too deep\"]");
  assert_int_equal(bad, 0);
}

// --- Meshes of URDF files ---

// A tetrahedron of this edge along the axes, as an OBJ file.
static void write_corner(const char *path, int edge) {
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  fprintf(f, "v 0 0 0\nv %d 0 0\nv 0 %d 0\nv 0 0 %d\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n", edge,
          edge, edge);
  assert_int_equal(fclose(f), 0);
}

static bool reads_mesh(const char *name, const char *expected) {
  FILE *f = fopen("w/x/r.urdf", "w");
  assert_non_null(f);
  fprintf(f,
          "<robot name=\"r\"><link name=\"a\"><visual><geometry>\n"
          "<mesh filename=\"%s\" scale=\"1 2 -3\"/></geometry></visual></link><link name=\"b\"/>\n"
          "<joint name=\"j\" type=\"continuous\"><parent link=\"a\"/><child "
          "link=\"b\"/></joint></robot>",
          name);
  assert_int_equal(fclose(f), 0);
  return prints("b = attempt(() => bounds(posed(read_urdf(\"w/x/r.urdf\"))), e => e.message)\n"
                "print if type_of(b) == \"text\" then rest(b, index_of(b, \"): \") + 3) else "
                "round(concat(b.min, b.max), 6)",
                expected);
}

// A name in a package is looked for in four places, in this order; a plain one in one. Lengths are
// meters.
static void meshes_of_urdf_files(void **state) {
  (void)state;
  static const char *const folders[] = {"w", "w/x", "w/m", "w/x/m", "w/x/p", "w/x/p/m", "p", "p/m"};
  static const char *const places[] = {"w/x/m/t.obj", "w/x/p/m/t.obj", "w/m/t.obj", "p/m/t.obj"};
  size_t bad = 0;
  for (size_t i = 0; i < 8; i++) assert_int_equal(mkdir(folders[i], 0777), 0);
  for (int i = 0; i < 4; i++) write_corner(places[i], i + 1);
  for (int i = 0; i < 4; i++) {
    char expected[100];
    snprintf(expected, sizeof expected, "[0, 0, %d, %d, %d, 0]", -3000 * (i + 1), 1000 * (i + 1),
             2000 * (i + 1));
    bad += !reads_mesh("package://p/m/t.obj", expected);
    bad += !reads_mesh("model://p/m/t.obj", expected);
    if (i == 0) {
      bad += !reads_mesh("m/t.obj", expected);
      bad += !reads_mesh("file://m/t.obj", expected);
      write_corner("w/x/t.obj", 1);
      bad += !reads_mesh("/elsewhere/m/t.obj", expected);
      bad += !reads_mesh("file:///elsewhere/t.obj", expected);
      unlink("w/x/t.obj");
    }
    unlink(places[i]);
  }
  static const char missing[] = "the file does not exist in the folders that the script can read";
  bad += !reads_mesh("package://p/m/t.obj", missing);
  bad += !reads_mesh("m/t.obj", missing);
  bad += !reads_mesh("/t.obj", missing);
  bad += !reads_mesh("package://p.obj", "the file's name is missing after the package's name");
  bad += !reads_mesh("model://t.obj", "the file's name is missing after the package's name");
  bad += !reads_mesh("http://example.org/t.obj", "files are not downloaded");
  static const char ending[] = "meshes are read from .stl .obj .ply .gltf .glb";
  bad += !reads_mesh("m/t.dae", ending);
  bad += !reads_mesh("m/t", ending);
  bad += !reads_mesh("package://p/m/t.objx", ending);
  bad += !reads_mesh("m/T.OBJ", missing);
  bad += !reads_mesh("m/t.stl", missing);
  bad += !reads_mesh("m/t.ply", missing);
  bad += !reads_mesh("m/t.gltf", missing);
  bad += !reads_mesh("m/t.Glb", missing);
  // glTF says its own unit, and has the y axis upward; the mesh is one triangle of a meter.
  FILE *f = fopen("w/x/m/t.gltf", "w");
  assert_non_null(f);
  fputs(
      "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{"
      "\"mesh\":0}],"
      "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"accessors\":[{"
      "\"bufferView\":0,"
      "\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]}],"
      "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,\"uri\":"
      "\"data:application/"
      "octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}",
      f);
  assert_int_equal(fclose(f), 0);
  bad += !reads_mesh("m/t.gltf", "[0, 0, -3000, 1000, 0, 0]");
  unlink("w/x/m/t.gltf");
  unlink("w/x/r.urdf");
  for (size_t i = 8; i-- > 0;) assert_int_equal(rmdir(folders[i]), 0);
  assert_int_equal(bad, 0);
}

static int enter(void **state) {
  (void)state;
  return mkdtemp(folder) ? chdir(folder) : -1;
}

static int leave(void **state) {
  (void)state;
  return unlink("F") || chdir("/") || rmdir(folder);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(values_of_json),          cmocka_unit_test(places_of_errors_in_json),
      cmocka_unit_test(nesting_of_json),         cmocka_unit_test(rows_of_csv),
      cmocka_unit_test(places_of_errors_in_csv), cmocka_unit_test(texts_without_mark),
      cmocka_unit_test(json_both_ways),          cmocka_unit_test(meshes_of_urdf_files),
  };
  return cmocka_run_group_tests_name("data files", tests, enter, leave);
}
