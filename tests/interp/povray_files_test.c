// File names in POV-Ray scenes: which ones are allowed, and the line of those that are not.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "interp/render/povray.h"

static CagError err;
static uint64_t seed;

static unsigned random_below(unsigned n) {
  seed = seed * 6364136223846793005u + 1442695040888963407u;
  return (unsigned)(seed >> 33) % n;
}

// A scene of its exact length, so that out-of-bounds reads are detected.
static bool passes(const char *scene) {
  const size_t n = strlen(scene);
  char *copy = malloc(n ? n : 1);
  memcpy(copy, scene, n);
  err = (CagError){0};
  const bool ok = cag_povray_check_files(copy, n, &err);
  free(copy);
  assert_true(ok || err.status == CAG_E_RENDERER);
  return ok;
}

static void let_through(const char *scene) {
  if (!passes(scene)) fail_msg("%s: %s", scene, err.message);
}

static void refused(const char *scene, const char *part) {
  if (passes(scene)) fail_msg("let through: %s", scene);
  if (!strstr(err.message, part)) fail_msg("%s: %s", scene, err.message);
}

// The rule, component by component.
static bool is_inside(const char *name) {
  if (!*name || *name == '/' || *name == '~' || strchr(name, '\\')) return false;
  for (const char *at = name;;) {
    const size_t n = strcspn(at, "/");
    if (n == 2 && at[0] == '.' && at[1] == '.') return false;
    if (!at[n]) return true;
    at += n + 1;
  }
}

static void names_stay_in_the_folder(void **state) {
  (void)state;
  seed = 1;
  size_t inside = 0, outside = 0;
  for (int round = 0; round < 4000; round++) {
    char name[12], scene[40];
    size_t n = random_below(9);
    for (size_t i = 0; i < n; i++) name[i] = "...//a~b"[random_below(8)];
    if (n && random_below(8) == 0) name[n - 1] = '\\', name[n++] = 'a';
    name[n] = 0;
    snprintf(scene, sizeof scene, "#include \"%s\"", name);
    const bool expected = is_inside(name);
    if (passes(scene) != expected) fail_msg("%s", scene);
    inside += expected;
    outside += !expected;
    if (!expected) assert_non_null(strstr(err.message, name));
  }
  assert_true(inside > 800 && outside > 800);
}

// Messages truncate names to 120 bytes.
static void long_names_are_cut(void **state) {
  (void)state;
  for (size_t n = 119; n < 123; n++) {
    char scene[200], told[200];
    snprintf(scene, sizeof scene, "#include \"/%0*d\"", (int)n - 1, 7);
    refused(scene, "outside the scene's folder");
    const char *from = strchr(err.message, '\'') + 1;
    snprintf(told, sizeof told, "%.*s", (int)(strrchr(err.message, ',') - from - 1), from);
    assert_int_equal(strlen(told), n < 120 ? n : 120);
    assert_int_equal(strncmp(told, scene + 10, strlen(told)), 0);
  }
}

static const char *const kinds[] = {"df3", "exr", "gif", "hdr", "iff", "jpeg", "pgm",
                                    "png", "pot", "ppm", "sys", "tga", "tiff", "ttf"};
static const char *const blocks[] = {"bump_map", "height_field", "image_map", "image_pattern",
                                     "material_map"};
static const char *const functions[] = {"chr",    "concat", "datetime", "str",
                                        "strlwr", "strupr", "substr",   "vstr"};

static void words_before_names_are_known(void **state) {
  (void)state;
  char scene[200];
#define SCENE(...) (snprintf(scene, sizeof scene, __VA_ARGS__), scene)
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
    const char *k = kinds[i];
    let_through(SCENE("a { %s \"b.c\" }", k));
    refused(SCENE("a { %s \"/b.c\" }", k), "outside");
    refused(SCENE("%s/**/\"../b\"", k), "outside");
    refused(SCENE("%s Name", k), "computes");
    refused(SCENE("%s x", k), "computes");
    refused(SCENE("%s concat(\"a\", \"b\")", k), "computes");
    let_through(SCENE("%s internal 1", k));
    let_through(SCENE("%s { \"/b\" }", k)); // not a file name: POV-Ray rejects it
    let_through(SCENE("%s", k));
    let_through(SCENE("%s_ \"/b\"", k));
    let_through(SCENE("x%s \"/b\"", k));
    let_through(SCENE("%s2 \"/b\"", k));
    let_through(SCENE("\"%s\" \"/b\"", k));
    let_through(SCENE("// %s \"/b\"", k));
    let_through(SCENE("/* %s \"/b\" */", k));
    refused(SCENE("// %s \"/b\"\n%s \"/b\"", k, k), "line 2 ");
  }
  for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
    const char *b = blocks[i];
    let_through(SCENE("%s \"a\"", b));
    refused(SCENE("%s \"/a\"", b), "outside");
    let_through(SCENE("%s { \"a\" }", b));
    refused(SCENE("%s { \"/a\" }", b), "outside");
    refused(SCENE("%s{\"~\"}", b), "outside");
    let_through(SCENE("%s { function 9, 9 { x } }", b));
    let_through(SCENE("%s { png \"a\" }", b));
    refused(SCENE("%s { png \"/a\" }", b), "outside");
    refused(SCENE("%s { png Name }", b), "computes");
    refused(SCENE("%s { substr(\"a\", 1, 1) }", b), "computes");
    let_through(SCENE("%s ( \"/a\" )", b));
    let_through(SCENE("%s { { \"/a\" } }", b));
  }
  for (size_t i = 0; i < sizeof functions / sizeof *functions; i++) {
    refused(SCENE("png %s(1)", functions[i]), "computes");
    refused(SCENE("image_map { %s(1) }", functions[i]), "computes");
    let_through(SCENE("image_map { %s_ }", functions[i]));
    let_through(SCENE("%s(\"/a\")", functions[i]));
  }
}

static void directives_need_a_text(void **state) {
  (void)state;
  let_through("#include \"a.inc\"");
  let_through("# include \"a.inc\"");
  let_through("include \"/a.inc\"");
  let_through("# x include \"/a.inc\"");
  let_through("#declare png = 3;");
  let_through("#png \"/a\"");
  let_through("# 3 \"/a\"");
  let_through("#includes \"/a\"");
  let_through("#debug \"/etc\"");
  refused("#include \"/a.inc\"", "outside");
  refused("#include Name", "computes");
  refused("#include concat(\"a\")", "computes");
  refused("#include", "computes");
  refused("#include (\"a\")", "computes");
  refused("#include/* \"a\" */\"/b\"", "outside");
  refused("#include // \"a\"\n\"/b\"", "line 2 ");
  let_through("#fopen File \"a\" read");
  refused("#fopen File \"/a\" write", "outside");
  refused("#fopen File Name write", "computes");
  refused("#fopen \"a\" \"/b\" write", "outside");
  refused("#fopen", "computes");
  let_through("#include \"a\" sphere { 0, 1 }");
  refused("#include \"a\" #include \"/b\"", "outside");
}

static void ends_of_scenes_are_seen(void **state) {
  (void)state;
  static const char *const good[] = {"",    "/",  "/*",    "//",     "/* *",        "/* /*",  "\"",
                                     "\"a", "#",  "a",     "/**/",   "/* /* */ */", "\"\\\"", "\\",
                                     "#fo", "3/", "\"a\\", "// a\n", "/*/ a",       "png \"a"};
  for (size_t i = 0; i < sizeof good / sizeof *good; i++) let_through(good[i]);
  refused("png \"/a", "outside");
  refused("/**/png \"/a\"", "outside");
  refused("/* /* */ */png \"/a\"", "outside");
  let_through("/* /* */ png \"/a\"");
  refused("/***/png \"/a\"", "outside");
  let_through("/*/png \"/a\"");
  refused("1/png \"/a\"", "outside");
  refused("\"\\\"\"png \"/a\"", "outside"); // a quote in a text
  let_through("\"\\\\\" png \"a\"");
  refused("\"\\\\\"png \"/a\"", "outside");
  let_through("\"\\\"png \"a\" /");
}

// Comments of both kinds, texts, and blanks in any order. The line is that of the name.
static void lines_are_counted(void **state) {
  (void)state;
  static const char *const pieces[] = {"\n",
                                       " \t",
                                       "// a \" /* b\n",
                                       "/* a\n\" b */",
                                       "\"a\nb\"",
                                       "\"\\\"\n\"",
                                       "/* a /*\n*/\n*/",
                                       "sphere { 0, 1 }\n",
                                       "\r\n",
                                       "/* // */",
                                       "/ 2 *",
                                       "\"//\"",
                                       "\"/*\"\n",
                                       "#declare a = 3;\n"};
  seed = 2;
  for (int round = 0; round < 500; round++) {
    char scene[2000] = "", part[40];
    const unsigned n = random_below(20);
    size_t line = 1;
    for (unsigned i = 0; i < n; i++) {
      strcat(scene, pieces[random_below(sizeof pieces / sizeof *pieces)]);
      strcat(scene, " ");
    }
    for (const char *c = scene; *c; c++) line += *c == '\n';
    let_through(scene);
    strcat(scene, round % 2 ? "#include \"/a\"" : "png Name");
    snprintf(part, sizeof part, "line %zu of", line);
    refused(scene, part);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(names_stay_in_the_folder),     cmocka_unit_test(long_names_are_cut),
      cmocka_unit_test(words_before_names_are_known), cmocka_unit_test(directives_need_a_text),
      cmocka_unit_test(ends_of_scenes_are_seen),      cmocka_unit_test(lines_are_counted),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
