// Tab completion in the REPL: for lines up to the cursor, with and without preceding lines, and
// with failing allocations.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/repl.h"
#include "tests/fuzz/failing.h"

volatile int cag_tool_interrupt;

// --- The session ---

static const char DEFINITIONS[] =
    "import std.robots: puma560\n"
    "import std.robots as arms\n"
    "r = {height: 7, hue: 1}\n"
    "plate(width, thickness = 2) = width\n"
    "bracket(\n  leg_one,\n  leg_two = (3 + 4), // the other (longer leg\n"
    "  leg_three = [1, 2]) = leg_one\n"
    "label(text_left = \"(\", /* not ) here */ text_right = \"{1 + (2)}\\\")\") = text_right\n"
    "raw(raw_one = `\\(\", raw_two = 2`, raw_three = 1) = raw_three\n"
    "span = 1..9\n"
    "none_taken() = 3\n"
    "wide(a_parameter_whose_name_is_longer_than_all_that_anybody_would_want_to_type = 1) = 2\n"
    "радиус = 5\n"
    "радиан = 6\n";

static char *module_path[] = {"modules", "more"};

static void write_file(const char *path, const char *text) {
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  fputs(text, f);
  assert_int_equal(fclose(f), 0);
}

static char folder[] = "/tmp/cag-complete-XXXXXX";
static CagTool tool;
static CagRepl repl;

static int begin(void **state) {
  (void)state;
  assert_non_null(mkdtemp(folder));
  assert_int_equal(chdir(folder), 0);
  assert_int_equal(mkdir("li", 0777), 0);
  assert_int_equal(mkdir("modules", 0777), 0);
  assert_int_equal(mkdir("more", 0777), 0);
  write_file("gripper.cag", "span = 3\nspread(x) = x\n");
  write_file("li/jaws.cag", "jaw = 1\n");
  write_file("modules/shelf.cag", "board = 1\n");
  write_file("modules/notes.txt", "");
  write_file("more/shell.cag", "wall = 1\n");
  write_file("wrong.cag", "a = (\n");
  write_file("g.t", "");
  cag_session_options_init(&tool.session);
  tool.session.messages = fopen("/dev/null", "w");
  tool.session.module_path = (const char *const *)module_path;
  tool.session.module_path_count = 2;
  repl = (CagRepl){.tool = &tool, .session = cag_session_new(&tool.session)};
  assert_non_null(repl.session);
  assert_int_equal(cag_session_input(repl.session, DEFINITIONS, strlen(DEFINITIONS), NULL, NULL),
                   0);
  return 0;
}

static int end(void **state) {
  (void)state;
  cag_session_free(repl.session);
  fclose(tool.session.messages);
  static const char *const PATHS[] = {"gripper.cag",
                                      "li/jaws.cag",
                                      "modules/shelf.cag",
                                      "modules/notes.txt",
                                      "more/shell.cag",
                                      "wrong.cag",
                                      "g.t",
                                      "li",
                                      "modules",
                                      "more",
                                      folder};
  for (size_t i = 0; i < sizeof PATHS / sizeof *PATHS; i++) remove(PATHS[i]);
  return 0;
}

// --- Lines ---

// A line up to the cursor, the lines that it continues, and the proposals, separated by `|`.
typedef struct Line {
  const char *before, *text, *proposed;
} Line;

static const Line LINES[] = {
    // names
    {NULL, "sphere_s", "sphere_surface"},
    {NULL, "puma", "puma560"},
    {NULL, "ради", "радиан|радиус"},
    {NULL, "pri", "principal_curvatures|print|prism|prismatic"},
    {NULL, "zzz", ""},
    {NULL, "", ""},
    {NULL, "8 / sphere_s", "sphere_surface"},
    {NULL, ") + sphere_s", "sphere_surface"},
    {NULL, "0..sphere_s", "sphere_surface"},
    {NULL, "(sphere_s", "sphere_surface"},
    {NULL, "[sphere_s", "sphere_surface"},
    // deeper than the parser goes
    {NULL, "((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((sphere_s",
     "sphere_surface"},
    // named arguments
    {NULL, "plate(", "thickness: |width: "},
    {NULL, "plate(1, th", "then|thicken|thickness: |threshold"},
    {NULL, "plate(1, `a` + th", "then|thicken|thickness: |threshold"},
    {NULL, "plate(len([1, 2]), th", "then|thicken|thickness: |threshold"},
    {NULL, "bracket(leg", "leg_one: |leg_three: |leg_two: "},
    {NULL, "label(text_", "text_left: |text_right: "},
    {NULL, "raw(raw_", "raw_one: |raw_three: "},
    {NULL, "none_taken(", ""},
    {NULL, "wide(a_par",
     "a_parameter_whose_name_is_longer_than_all_that_anybody_would_want_to_type: "},
    {NULL, "puma560(", ""},
    {NULL, "r(", ""},
    {NULL, "zzz(", ""},
    {NULL, "bspline([[0, 0], [1, 1]], degr", "degree: "},
    {"plate(\n", "thi", "thicken|thickness: "},
    // members
    {NULL, "r.h", "height|hue"},
    {NULL, "span.s", "start|step"},
    {NULL, "1 + r.hei", "height"},
    {NULL, "arms.puma5", "puma560"},
    {NULL, "arms.puma560.conv", "convention"},
    {NULL, ".hei", ""},
    {NULL, "(.hei", ""},
    {NULL, "zzz.hei", ""},
    // in texts and comments
    {NULL, "print \"sphere_s", ""},
    {NULL, "print \"a {sphere_s", "sphere_surface"},
    {NULL, "print \"\\\" {sphere_s", "sphere_surface"},
    {NULL, "print \"\\{sphere_s", ""},
    {NULL, "print \"a {1} sphere_s", ""},
    {NULL, "print `a {sphere_s", ""},
    {NULL, "print `a\\`, sphere_s", "sphere_surface"},
    {NULL, "print \"\\", ""},
    {"print \"abc\n", "sphere_s", "sphere_surface"},
    {"[1, // a \" here\n", "sphere_s", "sphere_surface"},
    {"[1, /* a \" here */\n", "sphere_s", "sphere_surface"},
    {NULL, "[1, /* ( sphere_s", "sphere_surface"},
    // files
    {NULL, ":load gri", "gripper.cag"},
    {NULL, ":lo   li/", "li/jaws.cag"},
    {NULL, ":load nowhere/", ""},
    {NULL, ":load li", "li/"},
    {NULL, "read_text(\"gri", "gripper.cag"},
    {"read_text(\n", "  \"gri", "gripper.cag"},
    {NULL, "len(\"gri", ""},
    {NULL, "import \"gri", "gripper.cag"},
    {NULL, "  import \"gri", "gripper.cag"},
    {"x = 1\n", "import \"gri", "gripper.cag"},
    // commands
    {NULL, ":sc", ":scene"},
    {NULL, "  :re", ":reload|:render"},
    {NULL, ":zzz", ""},
    {NULL, ":help sphere_s", "sphere_surface"},
    {NULL, ":zzz sphere_s", "sphere_surface"},
    // imports
    {NULL, "import gri", "gripper"},
    {NULL, "import g", "gripper"}, // g.t is not a script
    {NULL, "import li", "li."},
    {NULL, "import li.", "li.jaws"},
    {NULL, "import she", "shelf|shell"},
    {NULL, "import shell: w", "wall"},
    {NULL, "import notes", ""},
    {NULL, "import std.ro", "std.robots"},
    {NULL, "import gripper: sp", "span|spread"},
    {NULL, "import gripper: span, spr", "spread"},
    {NULL, "import \"gripper.cag\": spa", "span"},
    {NULL, "import shelf as s: b", "board"},
    {NULL, "import wrong: a", ""},
    {NULL, "import nowhere: a", ""},
    {NULL, "import gripper a", ""},
    {NULL, "imports", ""},
};
#define LINE_COUNT (sizeof LINES / sizeof *LINES)

static CagReplProposals propose(const Line *l) {
  repl.before = l->before;
  return cag_repl_propose(&repl, l->text);
}

static void join(const CagReplProposals *p, char *out, size_t size) {
  *out = '\0';
  for (size_t i = 0, n = 0; i < p->count && n < size; i++)
    n += (size_t)snprintf(out + n, size - n, "%s%s", i ? "|" : "", p->items[i]);
}

static void test_lines(void **state) {
  (void)state;
  int wrong = 0;
  for (size_t i = 0; i < LINE_COUNT; i++) {
    char got[2048];
    CagReplProposals p = propose(&LINES[i]);
    join(&p, got, sizeof got);
    if (strcmp(got, LINES[i].proposed) != 0) {
      print_error("\"%s%s\": \"%s\"\n", LINES[i].before ? LINES[i].before : "", LINES[i].text, got);
      wrong++;
    }
    cag_repl_proposals_free(&p);
  }
  assert_int_equal(wrong, 0);
}

// A proposal replaces the last bytes of the line.
static void test_replaced_part(void **state) {
  (void)state;
  for (size_t i = 0; i < LINE_COUNT; i++) {
    CagReplProposals p = propose(&LINES[i]);
    const size_t n = strlen(LINES[i].text);
    assert_true(p.length <= n);
    for (size_t k = 0; k < p.count; k++)
      assert_memory_equal(p.items[k], LINES[i].text + n - p.length, p.length);
    cag_repl_proposals_free(&p);
  }
}

// Compares proposals. A name may lack its colon, because the argument could not be found.
static bool is_same(const char *a, const char *b) {
  const size_t n = strcspn(b, ":");
  return strcspn(a, ":") == n && memcmp(a, b, n) == 0;
}

// If memory runs out, some proposals are missing, but none is wrong.
static void test_failing_memory(void **state) {
  (void)state;
  for (size_t i = 0; i < LINE_COUNT; i++) {
    made = 0;
    CagReplProposals p = propose(&LINES[i]);
    const size_t all = made;
    for (size_t at = 1; at <= all; at += 1 + at / 8) {
      made = 0;
      failing = at;
      CagReplProposals some = propose(&LINES[i]);
      failing = 0;
      for (size_t k = 0; k < some.count; k++) {
        bool known = false;
        for (size_t j = 0; j < p.count; j++) known = known || is_same(p.items[j], some.items[k]);
        if (!known) print_error("\"%s\": \"%s\"\n", LINES[i].text, some.items[k]);
        assert_true(known);
      }
      cag_repl_proposals_free(&some);
    }
    cag_repl_proposals_free(&p);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_lines),
      cmocka_unit_test(test_replaced_part),
      cmocka_unit_test(test_failing_memory),
  };
  return cmocka_run_group_tests(tests, begin, end);
}
