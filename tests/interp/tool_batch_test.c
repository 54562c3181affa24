// The rows of a batch: the tasks that they are cut into, what is wrong with them, and on what the
// keys of tasks depend.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/batch.h"
#include "cli/frames.h"
#include "tests/fuzz/failing.h"

volatile int cag_tool_interrupt;

static char folder[] = "/tmp/cag-rows-XXXXXX";

static void write_file(const char *name, const char *text) {
  FILE *f = fopen(name, "w");
  assert_non_null(f);
  assert_true(fputs(text, f) >= 0);
  assert_int_equal(fclose(f), 0);
}

static int begin(void **state) {
  (void)state;
  if (!mkdtemp(folder) || chdir(folder) || mkdir("parts", 0700) || mkdir("lib", 0700)) return -1;
  write_file("a.cag", "param h = 1\nshow sphere(h)\n");
  write_file("b.cag", "import parts.gear\nprint read_text(\"data.txt\"), \"none.txt\"\n");
  write_file("parts/gear.cag", "import wheel\nteeth = 12\n");
  write_file("parts/wheel.cag", "radius = 3\n");
  write_file("lib/wheel.cag", "radius = 4\n");
  write_file("data.txt", "1 2 3");
  write_file("unused.txt", "4");
  return symlink("a.cag", "link.cag");
}

static int end(void **state) {
  (void)state;
  static const char *const files[] = {
      "a.cag",          "b.cag",           "link.cag",      "data.txt", "unused.txt", "none.txt",
      "parts/gear.cag", "parts/wheel.cag", "lib/wheel.cag", "parts",    "lib"};
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) remove(files[i]);
  return chdir("/") ? -1 : rmdir(folder);
}

static char path[64], journal[64], report[64], tiles[64];

static void open_batch(CagBatch *b, CagTool *t, const char *text) {
  snprintf(path, sizeof path, "%s/jobs.csv", folder);
  snprintf(journal, sizeof journal, "%s/jobs.csv.journal", folder);
  snprintf(report, sizeof report, "%s/jobs.report.csv", folder);
  snprintf(tiles, sizeof tiles, "%s/jobs.csv.tiles", folder);
  *b = (CagBatch){.tool = t,
                  .path = path,
                  .folder = folder,
                  .journal_path = journal,
                  .report_path = report,
                  .tiles_folder = tiles};
  assert_true(cag_jobs_read(&b->jobs, text, strlen(text), false));
  assert_true(cag_batch_check(b));
}

static void close_batch(CagBatch *b) {
  for (size_t i = 0; i < b->task_count; i++) free(b->tasks[i].output);
  free(b->tasks);
  free(b->rows);
  cag_jobs_free(&b->jobs);
}

// Tasks as "row:frame output", with /tile or +joined tiles, and problems as "! row code message".
static void describe(const CagBatch *b, char *out, size_t size) {
  size_t n = 0;
  out[0] = 0;
#define SAY(...) n += (size_t)snprintf(out + n, size - n, __VA_ARGS__)
  for (size_t i = 0; i < b->task_count; i++) {
    const CagTask *t = &b->tasks[i];
    SAY("%zu:%ld", t->row, t->frame);
    if (t->tile >= 0) SAY("/%d", t->tile);
    if (t->joins) SAY("+%d", t->joins);
    if (t->output) SAY(" %s", t->output);
    SAY("\n");
  }
  for (size_t i = 0; i < b->jobs.problem_count; i++) {
    const CagJobProblem *p = &b->jobs.problems[i];
    const char *place = strstr(p->message, folder); // written as DIR
    SAY("! %zu %s ", p->row, p->code);
    if (place) SAY("%.*sDIR%s", (int)(place - p->message), p->message, place + strlen(folder));
    else SAY("%s", p->message);
    if (p->help) SAY(" (%s)", p->help);
    SAY("\n");
  }
#undef SAY
}

#define HEAD "script,output,frames,size,tiles,tolerance,quality\n"
#define PATTERN_HELP "(write the number as %04d, such as film.%04d.png, and a % as %%)"

#define FORMATS                                                                                    \
  "the formats are .exr .png .obj .stl .ply .glb .gltf .3mf .pov .igs .step .urdf .svg .json"

static void rows_become_tasks(void **state) {
  (void)state;
  static const struct {
    const char *rows, *told;
  } cases[] = {
      {"a.cag,a.stl", "0:0 a.stl\n"},
      {"a.cag,a.stl,,,,0.1\na.cag,b.PNG,,64x32,,,draft", "0:0 a.stl\n1:0 b.PNG\n"},
      {"a.cag,x.exr\n", "0:0 x.exr\n"},
      {"a.cag,f.%02d.png,3..5", "0:3 f.03.png\n0:4 f.04.png\n0:5 f.05.png\n"},
      {"a.cag,f%d.png,0..1\na.cag,g%d.png,1..1", "0:0 f0.png\n0:1 f1.png\n1:1 g1.png\n"},
      {"a.cag,f.png,7..7", "0:7 f.png\n"},
      {"a.cag,50%%.png,7..7", "0:7 50%.png\n"},
      // A picture alone is named as it is written.
      {"a.cag,50%%.png", "0:0 50%%.png\n"},
      {"a.cag,50%.stl", "0:0 50%.stl\n"},
      {"a.cag,t.png,,64x64,2x1", "0:0/0\n0:0/1\n0:0+2 t.png\n"},
      {"a.cag,t%d.png,4..5,64x64,1x2", "0:4/0\n0:4/1\n0:4+2 t4.png\n0:5/0\n0:5/1\n0:5+2 t5.png\n"},
      {"a.cag,t.png,,,1x1", "0:0 t.png\n"},
      // Scripts.
      {",a.stl", "! 1 E0913 the script is missing (name a .cag file)\n"},
      {"none.cag,a.stl", "! 1 E0913 cannot read the script 'none.cag': No such file or directory "
                         "(paths are relative to the folder of the table)\n"},
      {"/none.cag,a.stl",
       "! 1 E0913 cannot read the script '/none.cag': No such file or directory\n"},
      {"parts,a.stl",
       "! 1 E0913 cannot read the script 'parts': it is not a regular file (paths are relative to the folder of the table)\n"},
      {"-,a.stl",
       "! 1 E0913 cannot read the script '-': rows cannot share standard input (paths are relative to the folder of the table)\n"},
      // Values.
      {"a.cag,a.png,,64", "! 1 E0912 size '64': expected a size (write width x height in pixels, "
                          "such as 1280x720)\n"},
      {"a.cag,a.stl,,,,0",
       "! 1 E0912 tolerance '0': expected a distance (give a number of millimeters greater than 0, such as 0.05)\n"},
      {"a.cag,a.png,,x,,y",
       "! 1 E0912 size 'x': expected a size (write width x height in pixels, such as 1280x720)\n! 1 E0912 tolerance 'y': expected a distance (give a number of millimeters greater than 0, such as 0.05)\n"},
      {"a.cag,a.stl,0..1,64x64,2x2,,draft",
       "! 1 E0912 an export has no frames (leave the field empty)\n! 1 E0912 an export has no size "
       "(leave the field empty)\n! 1 E0912 an export has no quality (leave the field empty)\n! 1 "
       "E0912 an export has no tiles (leave the field empty)\n"},
      // Films.
      {"a.cag,f%d.png",
       "! 1 E0912 the output 'f%d.png' has a placeholder for a frame number, but the row "
       "has no frames (fill in frames, such as 0..47)\n"},
      {"a.cag,f.png,0..1",
       "! 1 E0914 all frames would be written to the same output 'f.png' " PATTERN_HELP "\n"},
      {"a.cag,f%d%d.png,0..1",
       "! 1 E0912 the output 'f%d%d.png' has several placeholders for a frame "
       "number " PATTERN_HELP "\n"},
      {"a.cag,f%s.png,0..1",
       "! 1 E0912 a % in the output 'f%s.png' is not a placeholder for a frame number " PATTERN_HELP
       "\n"},
      {"a.cag,f%d.png,0..999999\na.cag,g.png",
       "! 2 E0912 with this row, the batch has more than 1000000 pictures (split the table into several files)\n"},
      {"a.cag,f%d.png,0..1000000",
       "! 1 E0912 with this row, the batch has more than 1000000 pictures (split the table into several files)\n"},
      {"a.cag,f%d.png,5..1000005",
       "! 1 E0912 with this row, the batch has more than 1000000 pictures (split the table into several files)\n"},
      {"a.cag,f%d.png,2000000..2000001", "0:2000000 f2000000.png\n0:2000001 f2000001.png\n"},
      // Formats.
      {"a.cag,", "! 1 E0916 the output is missing (name a file, such as vase.png)\n"},
      {"a.cag,noending",
       "! 1 E0916 the output 'noending' has no extension that determines its format (" FORMATS
       ")\n"},
      {"a.cag,.png",
       "! 1 E0916 the output '.png' has no extension that determines its format (" FORMATS ")\n"},
      {"a.cag,x.d/noending",
       "! 1 E0916 the output 'x.d/noending' has no extension that determines its format (" FORMATS
       ")\n"},
      {"a.cag,x.",
       "! 1 E0916 the output 'x.' has no extension that determines its format (" FORMATS ")\n"},
      {"a.cag,x.gif", "! 1 E0916 unknown format '.gif' (" FORMATS ")\n"},
      // Tiles.
      {"a.cag,t.png,,,2x2",
       "! 1 E0912 a picture in tiles needs its size (fill in size, such as 7680x4320)\n"},
      // Outputs that meet.
      {"a.cag,x.stl\na.cag,./x.stl",
       "! 2 E0914 the output 'DIR/x.stl' is also the output of row 1 (give each row its own output)\n"},
      {"a.cag,f1.png\na.cag,f%d.png,0..2",
       "! 2 E0914 the output 'DIR/f1.png' is also the output of row 1 (give each row its own output)\n"},
      // Two films that meet are told once.
      {"a.cag,f%d.png,0..2\na.cag,f%d.png,1..3",
       "! 2 E0914 the output 'DIR/f1.png' is also the output of row 1 (give each row its own output)\n"},
      {"a.cag,jobs.report.csv.stl\na.cag,parts/../x.stl\na.cag,x.stl",
       "! 3 E0914 the output 'DIR/x.stl' is also the output of row 2 (give each row its own output)\n"},
  };
  size_t bad = 0;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    static char text[300], told[4000];
    CagTool t = {0};
    CagBatch b;
    snprintf(text, sizeof text, HEAD "%s\n", cases[i].rows);
    open_batch(&b, &t, text);
    const size_t tasks = b.task_count;
    if (tasks > 50) b.task_count = 0;
    describe(&b, told, sizeof told);
    b.task_count = tasks;
    // Tasks of sound rows stand beside problems.
    const char *got = b.jobs.problem_count ? strchr(told, '!') : told;
    if (strcmp(got, cases[i].told) != 0) {
      print_error("%s\n  gives %s  not %s", cases[i].rows, got, cases[i].told);
      bad++;
    }
    close_batch(&b);
  }
  assert_int_equal(bad, 0);
}

// The film and the tiles of the command line.
static void rows_fit_the_command_line(void **state) {
  (void)state;
  static const struct {
    const char *frames, *tiles, *row, *told;
  } cases[] = {
      {"6", NULL, "a.cag,f%d.png,4..5", "0:4 f4.png\n0:5 f5.png\n"},
      {"5", NULL, "a.cag,f%d.png,4..5",
       "! 1 E0912 frames 4..5 exceed -D frames=5 (the frames of "
       "a film of N are 0..N-1)\n"},
      {"x", NULL, "a.cag,f%d.png,4..5",
       "! 1 E0912 frames 4..5 exceed -D frames=x (the frames of "
       "a film of N are 0..N-1)\n"},
      {"1", NULL, "a.cag,f.png", "0:0 f.png\n"},
      {NULL, "2x1", "a.cag,t.png,,64x64", "0:0/0\n0:0/1\n0:0+2 t.png\n"},
      {NULL, "2x1", "a.cag,t.png,,64x64,1x2", "0:0/0\n0:0/1\n0:0+2 t.png\n"},
      {NULL, "2x1", "a.cag,t.png,,64x64,1x1", "0:0 t.png\n"},
      {NULL, "2x1", "a.cag,t.stl", "0:0 t.stl\n"},
      {NULL, "64x1", "a.cag,t.png,,64x64", NULL},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    static char text[300], told[2000];
    CagToolDefine defines[] = {{"h", "0"}, {"frames", cases[i].frames}};
    CagTool t = {.tiles = cases[i].tiles, .defines = defines};
    t.define_count = cases[i].frames ? 2 : 0;
    CagBatch b;
    snprintf(text, sizeof text, HEAD "%s\n", cases[i].row);
    open_batch(&b, &t, text);
    describe(&b, told, sizeof told);
    if (cases[i].told) assert_string_equal(told, cases[i].told);
    else
      assert_non_null(strstr(told, "tiles 64x1 of a picture of 64 by 64 pixels are smaller than"));
    close_batch(&b);
  }
}

// A row must not name a file that the batch itself writes, whatever form the path has.
static void outputs_are_no_files_of_the_batch(void **state) {
  (void)state;
  static const char *const others[] = {"parts/../x.stl", "./x.stl", "x.stl"};
  for (size_t i = 0; i < sizeof others / sizeof *others; i++)
    for (int k = 0; k < 3; k++) {
      CagTool t = {0};
      char told[1000], other[64];
      snprintf(other, sizeof other, "%s/%s", folder, others[i]);
      CagBatch b = {.tool = &t,
                    .path = k == 0 ? other : path,
                    .folder = folder,
                    .journal_path = k == 1 ? other : journal,
                    .report_path = k == 2 ? other : report,
                    .tiles_folder = tiles};
      const char *text = HEAD "a.cag,y.stl\na.cag,x.stl\n";
      write_file("x.stl", "");
      assert_true(cag_jobs_read(&b.jobs, text, strlen(text), false));
      assert_true(cag_batch_check(&b));
      describe(&b, told, sizeof told);
      assert_string_equal(
          told,
          "0:0 y.stl\n1:0 x.stl\n! 2 E0914 the output 'DIR/x.stl' is one of the batch's own files (choose another name)\n");
      remove("x.stl");
      close_batch(&b);
    }
}

// --- Keys ---

#define TASKS_MOST 32
typedef struct Keys {
  char keys[TASKS_MOST][CAG_JOURNAL_KEY_SIZE];
  size_t count;
} Keys;

static Keys keys_of(CagTool *t, const char *text) {
  Keys k = {.count = 0};
  CagBatch b;
  open_batch(&b, t, text);
  assert_int_equal(b.jobs.problem_count, 0);
  assert_true(cag_batch_make_keys(&b));
  assert_true(b.task_count <= TASKS_MOST);
  for (; k.count < b.task_count; k.count++) {
    const char *key = b.tasks[k.count].key;
    assert_int_equal(strlen(key), 32);
    assert_int_equal(strspn(key, "0123456789abcdef"), 32);
    strcpy(k.keys[k.count], key);
    if (b.tasks[k.count].tile < 0) continue;
    char name[100]; // a tile's place is beside the journal, under its key
    snprintf(name, sizeof name, "jobs.csv.tiles/%s.exr", key);
    assert_string_equal(b.tasks[k.count].output, name);
  }
  close_batch(&b);
  return k;
}

static bool same_keys(const Keys *a, const Keys *b) {
  return a->count == b->count && memcmp(a->keys, b->keys, sizeof a->keys[0] * a->count) == 0;
}

static void expect_change(const char *file, const char *text, const char *restored, bool changes) {
  CagTool t = {0};
  static const char rows[] = "script,output,f\nb.cag,b.stl,\n";
  const Keys before = keys_of(&t, rows);
  if (text) write_file(file, text);
  else remove(file);
  const Keys after = keys_of(&t, rows);
  if (same_keys(&before, &after) == changes) fail_msg("%s %s", file, text ? text : "(removed)");
  if (restored) write_file(file, restored);
  else remove(file);
  const Keys again = keys_of(&t, rows);
  if (!same_keys(&before, &again)) fail_msg("%s restored", file);
}

// A key changes with the script and every file that it names, and with nothing else.
static void keys_depend_on_files_that_scripts_name(void **state) {
  (void)state;
  expect_change("data.txt", "1 2 4", "1 2 3", true);
  expect_change("data.txt", "1 2 3 ", "1 2 3", true);
  expect_change("data.txt", NULL, "1 2 3", true);
  expect_change("none.txt", "now it is there", NULL, true);
  expect_change("unused.txt", "5", "4", false);
  expect_change("a.cag", "show box(1)", "param h = 1\nshow sphere(h)\n", false);
  expect_change("parts/gear.cag", "import wheel\nteeth = 13\n", "import wheel\nteeth = 12\n", true);
  // What an imported module imports itself is seen from there.
  expect_change("parts/wheel.cag", "radius = 5\n", "radius = 3\n", true);
  expect_change("lib/wheel.cag", "radius = 5\n", "radius = 4\n", false);
  static const char b[] = "import parts.gear\nprint read_text(\"data.txt\"), \"none.txt\"\n";
  expect_change("b.cag", "import parts.gear", b, true);
}

// Scripts that import each other, and names as long as they may be.
static void keys_of_circles_and_long_names(void **state) {
  (void)state;
  static const char rows[] = "script,output\nb.cag,b.stl\n";
  CagTool t = {0};
  write_file("b.cag", "import parts.gear\n");
  write_file("parts/gear.cag", "import wheel\nimport gear\n");
  write_file("parts/wheel.cag", "import gear\n");
  const Keys circle = keys_of(&t, rows);
  write_file("parts/wheel.cag", "import gear \n");
  const Keys changed = keys_of(&t, rows);
  assert_false(same_keys(&circle, &changed));
  for (size_t length = 250; length <= 251; length++) { // with .cag: at most 255
    char script[400], name[300];
    memset(name, 'n', length);
    strcpy(name + length, ".cag");
    snprintf(script, sizeof script, "import %.*s\n", (int)length, name);
    write_file("b.cag", script);
    write_file(name, "x = 1\n");
    const Keys before = keys_of(&t, rows);
    write_file(name, "x = 2\n");
    const Keys after = keys_of(&t, rows);
    assert_false(same_keys(&before, &after));
    // The same in quotes.
    snprintf(script, sizeof script, "read_text(\"%s\")\n", name);
    write_file("b.cag", script);
    const Keys quoted = keys_of(&t, rows);
    write_file(name, "x = 3\n");
    const Keys then = keys_of(&t, rows);
    assert_false(same_keys(&quoted, &then));
    remove(name);
  }
}

static void keys_depend_on_the_row_and_the_options(void **state) {
  (void)state;
  static const char *const rows[] = {
      HEAD "a.cag,a.png,,64x64\n",
      HEAD "a.cag,a.png,,64x65\n",
      HEAD "a.cag,b.png,,64x64\n",
      HEAD "a.cag,a.png,,64x64,,,draft\n",
      HEAD "a.cag,a.png,,64x64,,0.5\n",
      HEAD "a.cag,a.png,0..0,64x64\n",
      HEAD "a.cag,a.png,1..1,64x64\n",
      HEAD "b.cag,a.png,,64x64\n",
      "script,output,size,h\na.cag,a.png,64x64,2\n",
      "script,output,size,h\na.cag,a.png,64x64,3\n",
      "script,output,size,g\na.cag,a.png,64x64,2\n",
      "script,output,size,h,g\na.cag,a.png,64x64,2,3\n",
      "script,output,size,h,g\na.cag,a.png,64x64,23,\n",
  };
  enum { ROWS = sizeof rows / sizeof *rows };
  Keys keys[ROWS];
  CagTool t = {0};
  for (size_t i = 0; i < ROWS; i++) {
    keys[i] = keys_of(&t, rows[i]);
    const Keys again = keys_of(&t, rows[i]);
    assert_true(same_keys(&keys[i], &again));
    for (size_t k = 0; k < i; k++)
      if (same_keys(&keys[i], &keys[k])) fail_msg("%s and %s", rows[k], rows[i]);
  }
  // Options that change results, and others.
  CagToolDefine defines[] = {{"h", "2"}, {"k", "1"}};
  CagTool tools[] = {{.defines = defines, .define_count = 1},
                     {.defines = defines, .define_count = 2}};
  CagTool coarse = {.session = {.tolerance = 0.5}}, loop = {.loop = true}, quiet = {.quiet = true};
  const Keys one = keys_of(&tools[0], rows[0]), two = keys_of(&tools[1], rows[0]);
  const Keys rough = keys_of(&coarse, rows[0]), looped = keys_of(&loop, rows[0]);
  const Keys film = keys_of(&loop, rows[5]), silent = keys_of(&quiet, rows[0]);
  assert_false(same_keys(&one, &keys[0]) || same_keys(&two, &keys[0]) || same_keys(&one, &two));
  assert_false(same_keys(&rough, &keys[0]) || same_keys(&film, &keys[5]));
  assert_true(same_keys(&looped, &keys[0])); // a picture alone has no loop
  assert_true(same_keys(&silent, &keys[0]));
  // A folder of modules counts by what is found in it.
  const char *const folders[] = {"lib"};
  CagTool with_lib = {.session = {.module_path = folders, .module_path_count = 1}};
  write_file("b.cag", "import wheel\n");
  const Keys before = keys_of(&with_lib, rows[7]), without = keys_of(&t, rows[7]);
  write_file("lib/wheel.cag", "radius = 9\n");
  const Keys after = keys_of(&with_lib, rows[7]), still = keys_of(&t, rows[7]);
  assert_false(same_keys(&before, &after));
  assert_true(same_keys(&without, &still));
  // Files that values of params name.
  static const char named[] = "script,output,data\na.cag,a.stl,data.txt\n";
  static const char quoted[] = "script,output,data\na.cag,a.stl,\"\"\"data.txt\"\"\"\n";
  const Keys n = keys_of(&t, named), q = keys_of(&t, quoted);
  write_file("data.txt", "changed");
  const Keys n2 = keys_of(&t, named), q2 = keys_of(&t, quoted);
  assert_false(same_keys(&n, &n2) || same_keys(&q, &q2) || same_keys(&n, &q));
}

// The tasks of one row have keys of their own; frames keep theirs when the film is cut shorter at
// its beginning, but not at its end, which the script can read.
static void each_task_has_its_own_key(void **state) {
  (void)state;
  CagTool t = {0};
  const Keys k = keys_of(&t, HEAD "a.cag,f%d.png,0..3,256x256,2x2\n");
  assert_int_equal(k.count, 20);
  for (size_t i = 0; i < k.count; i++)
    for (size_t j = 0; j < i; j++) assert_string_not_equal(k.keys[i], k.keys[j]);
  const Keys whole = keys_of(&t, HEAD "a.cag,f%d.png,0..3\n");
  const Keys later = keys_of(&t, HEAD "a.cag,f%d.png,2..3\n");
  const Keys shorter = keys_of(&t, HEAD "a.cag,f%d.png,0..2\n");
  for (size_t i = 0; i < 2; i++) assert_string_equal(whole.keys[2 + i], later.keys[i]);
  for (size_t i = 0; i < 3; i++) assert_string_not_equal(whole.keys[i], shorter.keys[i]);
  // A row's key is the same whatever rows stand beside it.
  const Keys rows = keys_of(&t, HEAD "b.cag,b.stl\na.cag,a.stl\nb.cag,c.stl\na.cag,d.stl\n");
  static const char *const alone[] = {HEAD "b.cag,b.stl\n", HEAD "a.cag,a.stl\n",
                                      HEAD "b.cag,c.stl\n", HEAD "a.cag,d.stl\n"};
  for (size_t i = 0; i < 4; i++) {
    const Keys one = keys_of(&t, alone[i]);
    assert_string_equal(rows.keys[i], one.keys[0]);
  }
  const Keys other = keys_of(&t, HEAD "a.cag,f%d.png,0..3,256x256,4x1\n");
  for (size_t i = 0; i < other.count; i++) assert_string_not_equal(k.keys[i], other.keys[i]);
}

// --- Names of frames ---

static void frames_have_their_numbers_in_the_name(void **state) {
  (void)state;
  static const struct {
    const char *pattern;
    int places;
    const char *name; // of frame 7
  } rows[] = {
      {"a.png", 0, "a.png"},       {"a%d.png", 1, "a7.png"}, {"a%04d.png", 1, "a0007.png"},
      {"a%3d.png", 1, "a  7.png"}, {"%%a%d", 1, "%a7"},      {"a%%.png", 0, "a%.png"},
      {"%d%02d", 2, "707"},        {"a%", -1, "a%"},         {"a%s", -1, "a%s"},
      {"a%d%", -1, "a7%"},         {"a%0d", 1, "a7"},        {"%1d", 1, "7"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    char name[64];
    assert_int_equal(cag_frames_places(rows[i].pattern), rows[i].places);
    assert_true(cag_frames_name(rows[i].pattern, 7, name, sizeof name));
    assert_string_equal(name, rows[i].name);
    // A buffer that the name and its end just fit into, and one that is too small.
    const size_t n = strlen(rows[i].name);
    assert_true(cag_frames_name(rows[i].pattern, 7, name, n + 1));
    assert_string_equal(name, rows[i].name);
    assert_false(cag_frames_name(rows[i].pattern, 7, name, n));
  }
  char most[16], more[16];
  snprintf(most, sizeof most, "%%%dd", CAG_FRAMES_DIGITS_MAX);
  snprintf(more, sizeof more, "%%%dd", CAG_FRAMES_DIGITS_MAX + 1);
  assert_int_equal(cag_frames_places(most), 1);
  assert_int_equal(cag_frames_places(more), -1);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rows_become_tasks),
      cmocka_unit_test(rows_fit_the_command_line),
      cmocka_unit_test(outputs_are_no_files_of_the_batch),
      cmocka_unit_test(keys_depend_on_files_that_scripts_name),
      cmocka_unit_test(keys_depend_on_the_row_and_the_options),
      cmocka_unit_test(each_task_has_its_own_key),
      cmocka_unit_test(keys_of_circles_and_long_names),
      cmocka_unit_test(frames_have_their_numbers_in_the_name),
  };
  return cmocka_run_group_tests_name("batch", tests, begin, end);
}
