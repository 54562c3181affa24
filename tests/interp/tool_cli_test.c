// The command line: which values each option takes, where options and operands may stand, and what
// is said of those that are wrong.

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "cli/cli.h"
#include "cli/tool.h"
#include "tests/fuzz/failing.h"

volatile int cag_tool_interrupt;

#define WORDS_MOST 16
static char *words[WORDS_MOST + 1];
static int operands;
static char said[1024];

// Reads a command line, whose words are separated by single spaces. What it writes to standard
// error is kept in `said`.
static bool read_line(CagTool *t, const char *line) {
  static char copy[512];
  int count = 0;
  snprintf(copy, sizeof copy, "%s", line);
  words[count++] = copy;
  for (char *at = copy; (at = strchr(at, ' '));) {
    assert_true(count < WORDS_MOST);
    *at++ = 0;
    words[count++] = at;
  }
  words[count] = NULL;
  fflush(stderr);
  FILE *file = tmpfile();
  const int before = dup(STDERR_FILENO);
  dup2(fileno(file), STDERR_FILENO);
  operands = -1;
  const bool ok = cag_tool_read(t, count, words, &operands);
  fflush(stderr);
  dup2(before, STDERR_FILENO);
  close(before);
  rewind(file);
  said[fread(said, 1, sizeof said - 1, file)] = 0;
  fclose(file);
  return ok;
}

// --- Values ---

// What an option made of a value, as text.
static void show(const CagTool *t, const char *option, char *out, size_t size) {
  const CagSessionOptions *s = &t->session;
#define IS(name) (strcmp(option, name) == 0)
  if (IS("--size")) snprintf(out, size, "%d %d", t->width, t->height);
  else if (IS("--frames"))
    snprintf(out, size, "%ld %ld %d", t->first_frame, t->last_frame, t->has_frames);
  else if (IS("--exposure")) snprintf(out, size, "%g", t->exposure);
  else if (IS("--threshold")) snprintf(out, size, "%g", t->threshold);
  else if (IS("--tolerance")) snprintf(out, size, "%g", s->tolerance);
  else if (IS("--max-memory")) snprintf(out, size, "%zu", s->max_memory);
  else if (IS("--max-time")) snprintf(out, size, "%g", s->max_time);
  else if (IS("--max-depth")) snprintf(out, size, "%zu", s->max_depth);
  else if (IS("--max-triangles")) snprintf(out, size, "%zu", s->max_triangles);
  else if (IS("--jobs")) snprintf(out, size, "%zu", t->jobs);
  else if (IS("--threads")) snprintf(out, size, "%d", t->threads);
  else if (IS("--samples")) snprintf(out, size, "%d", t->samples);
  else if (IS("--retries")) snprintf(out, size, "%zu", t->retries);
  else if (IS("--region"))
    snprintf(out, size, "%d %d %d %d", t->region.x, t->region.y, t->region.width, t->region.height);
  else if (IS("--diagnostics")) snprintf(out, size, "%d", t->style == CAG_STYLE_JSON);
  else if (IS("--color")) snprintf(out, size, "%d", (int)t->color);
  else if (IS("--format")) snprintf(out, size, "%s", t->format);
  else if (IS("--quality")) snprintf(out, size, "%s", t->quality);
  else if (IS("--pov-csg")) snprintf(out, size, "%s", s->pov_csg);
  else if (IS("--tiles")) snprintf(out, size, "%s", t->tiles);
  else if (IS("--element")) snprintf(out, size, "%s", t->element);
  else fail_msg("%s", option);
#undef IS
}

static void each_option_takes_its_values(void **state) {
  (void)state;
  static const struct {
    const char *command, *option, *value, *result; // NULL: refused
  } rows[] = {
      {"render", "--size", "1280x720", "1280 720"},
      {"render", "--size", "1x1", "1 1"},
      {"render", "--size", "131072x131072", "131072 131072"},
      {"render", "--size", "131073x1", NULL},
      {"render", "--size", "1x131073", NULL},
      {"render", "--size", "0x1", NULL},
      {"render", "--size", "1x0", NULL},
      {"render", "--size", "1280", NULL},
      {"render", "--size", "1280x", NULL},
      {"render", "--size", "1280x720x", NULL},
      {"render", "--size", "-1x5", NULL},
      {"render", "--size", "+1x5", NULL},
      {"render", "--size", "99999999999999999999x5", NULL},
      {"render", "--frames", "0..47", "0 47 1"},
      {"render", "--frames", "3..3", "3 3 1"},
      {"render", "--frames", "4..3", NULL},
      {"render", "--frames", "0..2147483646", "0 2147483646 1"},
      {"render", "--frames", "0..2147483647", NULL},
      {"render", "--frames", "0.47", NULL},
      {"render", "--frames", "0..", NULL},
      {"render", "--frames", "0..5x", NULL},
      {"render", "--exposure", "-1.5", "-1.5"},
      {"render", "--exposure", "1e2", "100"},
      {"render", "--exposure", "inf", NULL},
      {"render", "--exposure", "nan", NULL},
      {"render", "--exposure", "1x", NULL},
      {"render", "--exposure", "", NULL},
      {"compare", "--threshold", "0", "0"},
      {"compare", "--threshold", "0.25", "0.25"},
      {"compare", "--threshold", "-0.25", NULL},
      {"compare", "--threshold", "x", NULL},
      {"run", "--tolerance", "0.05", "0.05"},
      {"run", "--tolerance", "0.05mm", "0.05"},
      {"run", "--tolerance", "0.05MM", "0.05"},
      {"run", "--tolerance", "0.05cm", NULL},
      {"run", "--tolerance", "mm", NULL},
      {"run", "--tolerance", "0", NULL},
      {"run", "--tolerance", "-1", NULL},
      {"run", "--max-memory", "1", "1"},
      {"run", "--max-memory", "0", NULL},
      {"run", "--max-memory", "0.5", NULL},
      {"run", "--max-memory", "512k", "524288"},
      {"run", "--max-memory", "1.5K", "1536"},
      {"run", "--max-memory", "2M", "2097152"},
      {"run", "--max-memory", "2MB", "2097152"},
      {"run", "--max-memory", "2MiB", "2097152"},
      {"run", "--max-memory", "2Mb", "2097152"},
      {"run", "--max-memory", "1G", "1073741824"},
      {"run", "--max-memory", ".5G", "536870912"},
      {"run", "--max-memory", "1T", "1099511627776"},
      {"run", "--max-memory", "1000T", NULL},
      {"run", "--max-memory", "900T", "989560464998400"},
      {"run", "--max-memory", "1000000000000000", "1000000000000000"},
      {"run", "--max-memory", "1000000000000001", NULL},
      {"run", "--max-memory", "2X", NULL},
      {"run", "--max-memory", "2MX", NULL},
      {"run", "--max-memory", "M", NULL},
      {"run", "--max-memory", "-2M", NULL},
      {"run", "--max-memory", "+2M", NULL},
      {"run", "--max-memory", "/2", NULL},
      {"run", "--max-memory", ":2", NULL},
      {"run", "--max-memory", "9", "9"},
      {"run", "--max-time", "60", "60"},
      {"run", "--max-time", "0.5s", "0.5"},
      {"run", "--max-time", "0", NULL},
      {"run", "--max-time", "5m", NULL},
      {"run", "--max-depth", "1", "1"},
      {"run", "--max-depth", "0", NULL},
      {"run", "--max-depth", "1.5", NULL},
      {"run", "--max-depth", "1e15", "1000000000000000"},
      {"run", "--max-depth", "1.1e15", NULL},
      {"run", "--max-triangles", "1e8", "100000000"},
      {"run", "--max-triangles", "-3", NULL},
      {"test", "--jobs", "8", "8"},
      {"test", "--jobs", "1", "1"},
      {"test", "--jobs", "0", NULL},
      {"render", "--threads", "3", "3"},
      {"render", "--threads", "2147483648", "2147483647"},
      {"render", "--threads", "2147483646", "2147483646"},
      {"render", "--threads", "0", NULL},
      {"render", "--samples", "9999", "9999"},
      {"render", "--samples", "10001", "10000"},
      {"render", "--samples", "none", NULL},
      {"batch", "--retries", "0", "0"},
      {"batch", "--retries", "12", "12"},
      {"batch", "--retries", "1.5", NULL},
      {"batch", "--retries", "-1", NULL},
      {"batch", "--retries", "x", NULL},
      {"render", "--region", "640x360+12+34", "12 34 640 360"},
      {"render", "--region", "1x1+0+0", "0 0 1 1"},
      {"render", "--region", "0x1+0+0", NULL},
      {"render", "--region", "1x0+0+0", NULL},
      {"render", "--region", "131072x131072+131072+131072", "131072 131072 131072 131072"},
      {"render", "--region", "131073x1+0+0", NULL},
      {"render", "--region", "1x1+131073+0", NULL},
      {"render", "--region", "640x360", NULL},
      {"render", "--region", "640x360+1", NULL},
      {"render", "--region", "640x360+1+2+", NULL},
      {"run", "--diagnostics", "json", "1"},
      {"run", "--diagnostics", "text", "0"},
      {"run", "--diagnostics", "xml", NULL},
      {"run", "--color", "auto", "0"},
      {"run", "--color", "always", "1"},
      {"run", "--color", "never", "2"},
      {"run", "--color", "red", NULL},
      {"export", "--format", ".stl", "stl"},
      {"export", "--format", "stl", "stl"},
      {"render", "--quality", "draft", "draft"},
      {"render", "--quality", "final", "final"},
      {"render", "--quality", "best", NULL},
      {"render", "--pov-csg", "native", "native"},
      {"render", "--pov-csg", "csg", NULL},
      {"batch", "--tiles", "4x3", "4x3"},
      {"batch", "--tiles", "64x64", "64x64"},
      {"batch", "--tiles", "65x1", NULL},
      {"batch", "--tiles", "0x1", NULL},
      {"batch", "--tiles", "4", NULL},
      {"batch", "--element", "3", "3"},
      {"batch", "--element", "3a", NULL},
  };
  size_t bad = 0;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const char *operand = strcmp(rows[i].command, "compare") ? "" : " b";
    for (int joined = 0; joined < 2; joined++) {
      char line[256], got[128] = "refused";
      CagTool t;
      snprintf(line, sizeof line, "cag %s%s a %s%s%s", rows[i].command, operand, rows[i].option,
               joined ? "=" : " ", rows[i].value);
      const bool ok = read_line(&t, line);
      if (ok) show(&t, rows[i].option, got, sizeof got);
      if (strcmp(got, rows[i].result ? rows[i].result : "refused") != 0) {
        print_error("%s: %s\n", line, got);
        bad++;
      }
      assert_int_equal(*said != 0, !ok);
      cag_tool_release(&t);
    }
    // The same by name, as the columns of a batch give it: the reason is kept.
    CagTool t = {0};
    CagToolRefusal why;
    const bool taken = cag_tool_try(&t, rows[i].option + 2, rows[i].value, &why);
    assert_int_equal(taken, rows[i].result != NULL);
    assert_int_equal(why.message[0] != 0, !taken);
    assert_int_equal(why.help[0] != 0, !taken);
    assert_null(t.refusal);
  }
  CagToolRefusal why;
  CagTool t = {0};
  assert_false(cag_tool_try(&t, "no-such-option", "1", &why));
  assert_int_equal(bad, 0);
}

// --- Where words stand ---

static void expect_line(const char *line, const char *command, const char *operand_words) {
  CagTool t;
  const bool ok = read_line(&t, line);
  if (!ok) fail_msg("%s: %s", line, said);
  assert_string_equal(t.command->name, command);
  char got[256] = "";
  for (int i = 0; i < operands; i++) {
    if (i) strcat(got, " ");
    strcat(got, words[i]);
  }
  assert_string_equal(got, operand_words);
  cag_tool_release(&t);
}

static void options_stand_anywhere(void **state) {
  (void)state;
  expect_line("cag", "repl", "");
  expect_line("cag -q", "repl", "");
  expect_line("cag repl a.cag", "repl", "a.cag");
  expect_line("cag run a.cag", "run", "a.cag");
  expect_line("cag -q run a.cag", "run", "a.cag");
  expect_line("cag run -q a.cag", "run", "a.cag");
  expect_line("cag run a.cag -q", "run", "a.cag");
  expect_line("cag -D h=1 run a.cag", "run", "a.cag");
  expect_line("cag -Dh=1 run a.cag", "run", "a.cag");
  expect_line("cag -qD h=1 run a.cag", "run", "a.cag");
  expect_line("cag -qDh=1 run a.cag", "run", "a.cag");
  expect_line("cag --max-depth 5 run a.cag", "run", "a.cag");
  expect_line("cag --max-depth=5 run a.cag", "run", "a.cag");
  expect_line("cag run -- -a.cag", "run", "-a.cag");
  expect_line("cag -- run a.cag", "run", "a.cag");
  expect_line("cag run -q -- a.cag", "run", "a.cag");
  expect_line("cag run -", "run", "-");
  expect_line("cag eval -2^2 1 -(3)", "eval", "-2^2 1 -(3)");
  expect_line("cag eval -- -x -q", "eval", "-x -q");
  expect_line("cag export a.cag -oout.stl", "export", "a.cag");
  expect_line("cag export -o=out.stl a.cag", "export", "a.cag");
  expect_line("cag test", "test", "");
  expect_line("cag test a b c", "test", "a b c");
  expect_line("cag explain", "explain", "");
  CagTool t;
  assert_true(read_line(&t, "cag run a.cag -vqD a=1 -D b=x=y -I m1 -Im2 --color=always"));
  assert_true(t.verbose && t.quiet);
  assert_int_equal(t.define_count, 2);
  assert_string_equal(t.defines[0].name, "a");
  assert_string_equal(t.defines[0].value, "1");
  assert_string_equal(t.defines[1].name, "b");
  assert_string_equal(t.defines[1].value, "x=y");
  assert_int_equal(t.session.module_path_count, 2);
  assert_string_equal(t.session.module_path[0], "m1");
  assert_string_equal(t.session.module_path[1], "m2");
  assert_int_equal(t.style, CAG_STYLE_COLOR);
  cag_tool_release(&t);
  assert_true(
      read_line(&t, "cag render a.cag -o=x.png --loop --progress --camera top --engine povray"));
  assert_string_equal(t.output, "x.png");
  assert_string_equal(t.camera, "top");
  assert_true(t.loop && t.progress && !t.quiet && !t.verbose && !t.update && !t.fresh);
  cag_tool_release(&t);
  assert_true(read_line(&t, "cag test --update --no-pictures --filter x --report r.xml"));
  assert_true(t.update && t.no_pictures && !t.loop && !t.check && !t.diff);
  assert_string_equal(t.filter, "x");
  assert_string_equal(t.report, "r.xml");
  cag_tool_release(&t);
  assert_true(read_line(&t, "cag fmt --check --diff"));
  assert_true(t.check && t.diff && !t.fresh);
  cag_tool_release(&t);
  assert_true(read_line(&t, "cag batch j.csv --fresh --engine-queue slurm"));
  assert_true(t.fresh && !t.update);
  assert_string_equal(t.queue, "slurm");
  cag_tool_release(&t);
  // Help and version need no operands, nor a command.
  assert_true(read_line(&t, "cag run --help"));
  assert_true(t.wants_help && !t.wants_version);
  assert_string_equal(t.command->name, "run");
  assert_true(read_line(&t, "cag -h"));
  assert_true(t.wants_help && !t.command);
  assert_true(read_line(&t, "cag --version"));
  assert_true(t.wants_version && !t.wants_help && !t.command);
}

static void what_is_wrong_is_said(void **state) {
  (void)state;
  static const struct {
    const char *line, *said;
  } rows[] = {
      {"cag rnu a.cag", "cag: unknown command `rnu`\n  did you mean `cag run`?\n"},
      {"cag a.cag", "cag: unknown command `a.cag`\n  to run the script, write `cag run a.cag`\n"},
      {"cag .cag", "cag: unknown command `.cag`\n  `cag --help` lists the commands\n"},
      {"cag xyzzyx", "cag: unknown command `xyzzyx`\n  `cag --help` lists the commands\n"},
      {"cag run", "cag run: FILE is missing\n  write `cag run FILE`; `cag run --help` shows "
                  "examples\n"},
      {"cag run a b", "cag run: unexpected argument 'b'\n  write `cag run FILE`; `cag run --help` "
                      "shows examples\n"},
      {"cag compare a", "cag compare: expected A B, found only 'a'\n  write `cag compare A B`; "
                        "`cag compare --help` shows examples\n"},
      {"cag info a",
       "cag info: unexpected argument 'a'\n  write `cag info `; `cag info --help` shows "
       "examples\n"},
      {"cag run a --sizes 3", "cag run: unknown option --sizes\n  `cag run --help` lists the "
                              "options\n"},
      {"cag render a --sizes 3", "cag render: unknown option --sizes\n  did you mean --size?\n"},
      {"cag run a --size 3x4",
       "cag run: --size is an option of other commands\n  `cag run --help` lists the options\n"},
      {"cag eval -x", "cag eval: unknown option -x\n  `cag eval --help` lists the options; an "
                      "expression that begins with - comes after --\n"},
      {"cag run a -a", "cag run: unknown option -a\n  `cag run --help` lists the options\n"},
      {"cag run a -z", "cag run: unknown option -z\n  `cag run --help` lists the options\n"},
      {"cag run a -A", "cag run: unknown option -A\n  `cag run --help` lists the options\n"},
      {"cag run a -Z", "cag run: unknown option -Z\n  `cag run --help` lists the options\n"},
      {"cag run a -[",
       "cag run: unexpected argument '-['\n  write `cag run FILE`; `cag run --help` "
       "shows examples\n"},
      {"cag run a -o",
       "cag run: -o is an option of other commands\n  `cag run --help` lists the options\n"},
      {"cag export a -o", "cag export: -o needs a value\n  write -o OUT\n"},
      {"cag export a -o --format stl", "cag export: -o needs a value\n  write -o OUT\n"},
      {"cag run a --max-depth", "cag run: --max-depth needs a value\n  write --max-depth CALLS\n"},
      {"cag run a --help=yes", "cag run: --help takes no value\n"},
      {"cag export a -o x -o y", "cag export: -o is given twice: 'x' and 'y'\n  run the command "
                                 "again for another output\n"},
      {"cag export a -o=", "cag export: -o '': expected a name\n  name a file, or - for standard "
                           "output\n"},
      {"cag run a -D h", "cag run: -D 'h': expected NAME=VALUE\n  write -D name=value, such as -D "
                         "height=200\n"},
      {"cag run a -D =3", "cag run: -D '=3': expected NAME=VALUE\n  write -D name=value, such as "
                          "-D height=200\n"},
      {"cag run a -I=", "cag run: -I '': expected a name\n  name a folder\n"},
      {"cag run a --max-depth 0",
       "cag run: --max-depth '0': expected a count\n  give a whole number of at least 1\n"},
      {"cag --diagnostics=json run", "{\"severity\":\"error\""},
  };
  size_t bad = 0;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    CagTool t;
    const bool ok = read_line(&t, rows[i].line);
    const bool json = rows[i].said[0] == '{';
    if (ok || (json ? strncmp(said, rows[i].said, strlen(rows[i].said)) != 0
                    : strcmp(said, rows[i].said) != 0)) {
      print_error("%s:\n%s", rows[i].line, said);
      bad++;
    }
    cag_tool_release(&t);
  }
  assert_int_equal(bad, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(each_option_takes_its_values),
      cmocka_unit_test(options_stand_anywhere),
      cmocka_unit_test(what_is_wrong_is_said),
  };
  return cmocka_run_group_tests_name("command line", tests, NULL, NULL);
}
