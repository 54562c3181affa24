// Rendering with POV-Ray: a picture with known pixels, and every way in which a run can go wrong.
//
// Tests that need POV-Ray itself are skipped where it is not installed; the others put a small
// shell script in its place.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <dirent.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "interp/render/exr.h"
#include "interp/render/povray.h"

static char folder[64], real_path[4096];
static bool installed;

// TMPDIR is a folder of our own, so that what a run leaves can be seen.
static int prepare(void **state) {
  (void)state;
  strcpy(folder, "/tmp/cag-test-XXXXXX");
  if (!mkdtemp(folder)) return -1;
  snprintf(real_path, sizeof real_path, "%s", getenv("PATH"));
  setenv("TMPDIR", folder, 1);
  installed = cag_povray_find(NULL, 0, NULL, NULL);
  return 0;
}

static int finish(void **state) {
  (void)state;
  return rmdir(folder); // fails when a run left something
}

static size_t count_entries(void) {
  DIR *d = opendir(folder);
  size_t n = 0;
  for (struct dirent *e; (e = readdir(d));) n += strcmp(e->d_name, ".") && strcmp(e->d_name, "..");
  closedir(d);
  return n;
}

static CagPovrayJob job_for(const char *scene) {
  return (CagPovrayJob){
      .scene = scene, .scene_size = strlen(scene), .width = 64, .height = 48, .time_limit = 60};
}

#define HEAD                                                                                       \
  "#version 3.7;\nglobal_settings { assumed_gamma 1.0 }\n"                                         \
  "camera { orthographic location <0,0,-5> right x*4/3 up y look_at 0 }\n"

// An emitting square of (3, 0.1, 0.5) in front of (0.25, 0.5, 2): no light is computed, so the
// pixels are these numbers.
static const char SQUARE[] = HEAD "background { rgb <0.25,0.5,2> }\n"
                                  "box { <-0.2,-0.2,0>,<0.2,0.2,1> pigment { rgb <3,0.1,0.5> }\n"
                                  "  finish { ambient 0 diffuse 0 emission 1 } }\n";
// Parses for ever.
static const char ENDLESS[] = HEAD "#declare I = 0;\n#while (1) #declare I = I + 1; #end\n";

typedef struct {
  int calls;
  double last;
  bool saw_parsing, saw_rendering, in_range;
} Seen;

static void note(void *user, double percent, const char *phase) {
  Seen *seen = user;
  seen->calls++;
  seen->last = percent;
  seen->saw_parsing |= !strcmp(phase, "parsing");
  seen->saw_rendering |= !strcmp(phase, "rendering");
  seen->in_range &= percent >= 0 && percent <= 100;
}

static void the_picture_is_linear_light(void **state) {
  (void)state;
  if (!installed) skip();
  for (int quality = CAG_POVRAY_DRAFT; quality <= CAG_POVRAY_FINAL; quality++) {
    Seen seen = {.in_range = true};
    CagPovrayJob job = job_for(SQUARE);
    job.quality = (CagPovrayQuality)quality;
    job.progress = note;
    job.progress_user = &seen;
    CagPovrayResult result;
    CagError err = {0};
    if (!cag_povray_render(&job, &result, &err)) fail_msg("%s", err.message);
    assert_int_equal(strncmp(result.version, "3.", 2), 0);
    assert_true(seen.calls > 1 && seen.saw_parsing && seen.saw_rendering && seen.in_range);
    assert_true(seen.last == 100);
    CagImage image;
    if (!cag_exr_read_memory(result.exr, result.exr_size, "out", &image, NULL, &err))
      fail_msg("%s", err.message);
    assert_int_equal(image.width, 64);
    assert_int_equal(image.height, 48);
    static const char *const NAMES[3] = {"R", "G", "B"};
    static const float BACK[3] = {0.25f, 0.5f, 2}, FRONT[3] = {3, 0.1f, 0.5f};
    for (int k = 0; k < 3; k++) {
      size_t c;
      assert_true(cag_image_find(&image, NAMES[k], &c));
      // Half has 11 bits of precision.
      assert_true(fabsf(cag_image_plane(&image, c)[0] - BACK[k]) <= BACK[k] / 2048);
      assert_true(fabsf(cag_image_plane(&image, c)[24 * 64 + 32] - FRONT[k]) <= FRONT[k] / 2048);
    }
    cag_image_free(&image);
    cag_povray_result_free(&result);
  }
  assert_int_equal(count_entries(), 0);
}

static void alpha_is_written_when_asked_for(void **state) {
  (void)state;
  if (!installed) skip();
  // POV-Ray 3.7 takes a background of `rgb` for opaque; `transmit 1` makes it a hole.
  CagPovrayJob job = job_for(HEAD "background { rgbt <0,0,0,1> }\n"
                                  "sphere { 0, 0.2 pigment { rgb 1 } finish { emission 1 } }\n");
  job.alpha = true;
  CagPovrayResult result;
  CagError err = {0};
  if (!cag_povray_render(&job, &result, &err)) fail_msg("%s", err.message);
  CagImage image;
  size_t a;
  assert_true(cag_exr_read_memory(result.exr, result.exr_size, "out", &image, NULL, NULL));
  assert_true(cag_image_find(&image, "A", &a));
  assert_true(cag_image_plane(&image, a)[0] == 0 && cag_image_plane(&image, a)[24 * 64 + 32] == 1);
  cag_image_free(&image);
  cag_povray_result_free(&result);
}

static void files_of_the_job_are_there(void **state) {
  (void)state;
  if (!installed) skip();
  char source[96];
  snprintf(source, sizeof source, "%s/red.txt", folder);
  FILE *f = fopen(source, "w");
  fputs("#declare Red = rgb <1,0,0>;\n", f);
  fclose(f);
  const CagPovrayFile file = {"red.inc", source};
  CagPovrayJob job =
      job_for(HEAD "#include \"red.inc\"\n#include \"colors.inc\"\nbackground { Red }\n");
  job.file = &file;
  CagPovrayResult result;
  CagError err = {0};
  bool ok = cag_povray_render(&job, &result, &err);
  unlink(source);
  if (!ok) fail_msg("%s", err.message);
  cag_povray_result_free(&result);
  const CagPovrayFile missing = {"a.inc", source}, elsewhere = {"../a.inc", source};
  job.file = &missing;
  assert_false(cag_povray_render(&job, &result, &err));
  assert_int_equal(err.status, CAG_E_FILE);
  assert_non_null(strstr(err.message, source));
  job.file = &elsewhere;
  assert_false(cag_povray_render(&job, &result, &err));
  assert_int_equal(err.status, CAG_E_USAGE);
}

static void a_broken_scene_shows_its_line(void **state) {
  (void)state;
  if (!installed) skip();
  CagPovrayJob job = job_for(HEAD "// fine\n  sphere { <0,0,0> 1 pigmint { rgb 1 } }\n");
  CagPovrayResult result;
  CagError err = {0};
  assert_false(cag_povray_render(&job, &result, &err));
  assert_int_equal(err.status, CAG_E_RENDERER);
  assert_non_null(strstr(err.message, "line 5 of 'scene.pov'"));
  assert_non_null(strstr(err.message, "undeclared identifier 'pigmint' found instead"));
  assert_non_null(strstr(err.message, "\nsphere { <0,0,0> 1 pigmint { rgb 1 } }"));
  assert_int_equal(count_entries(), 0);
}

static double seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void an_endless_scene_ends_at_the_time_limit(void **state) {
  (void)state;
  if (!installed) skip();
  CagPovrayJob job = job_for(ENDLESS);
  job.time_limit = 0.5;
  CagPovrayResult result;
  CagError err = {0};
  const double begun = seconds();
  assert_false(cag_povray_render(&job, &result, &err));
  assert_true(seconds() - begun < 10);
  assert_int_equal(err.status, CAG_E_LIMIT);
  assert_non_null(strstr(err.message, "time limit of 0.5 s"));
  assert_int_equal(count_entries(), 0);
}

static volatile sig_atomic_t interrupted;

static void *interrupt_soon(void *unused) {
  (void)unused;
  usleep(300000);
  interrupted = 1;
  return NULL;
}

static void an_interrupt_ends_the_run(void **state) {
  (void)state;
  if (!installed) skip();
  CagPovrayJob job = job_for(ENDLESS);
  job.interrupted = &interrupted;
  CagPovrayResult result;
  CagError err = {0};
  pthread_t thread;
  interrupted = 0;
  assert_int_equal(pthread_create(&thread, NULL, interrupt_soon, NULL), 0);
  const double begun = seconds();
  assert_false(cag_povray_render(&job, &result, &err));
  assert_true(seconds() - begun < 10);
  pthread_join(thread, NULL);
  assert_int_equal(err.status, CAG_E_CALLBACK);
  assert_int_equal(count_entries(), 0);
}

static void files_outside_the_folder_are_refused(void **state) {
  (void)state;
  static const struct {
    const char *scene, *says;
  } ROWS[] = {
      {"#include \"/etc/passwd\"\n", "line 1 of the POV-Ray scene names the file '/etc/passwd'"},
      {"\n# include \"a/../../b.inc\"", "line 2"},
      {"#fopen F \"/tmp/x\" write", "'/tmp/x'"},
      {"#fopen F concat(\"/t\",\"mp/x\") write", "computes"},
      {"#declare N=\"/etc/passwd\"; #include N", "computes"},
      {"/* a /* b */ \" */ pigment { image_map { png \"/etc/x.png\" } }", "'/etc/x.png'"},
      {"pigment { image_map { \"../x.png\" } }", "'../x.png'"},
      {"height_field { tga\n N }", "line 2"},
      {"text { ttf \"~/font.ttf\" \"text\" 1, 0 }", "~/font.ttf"},
      {"// \"\n#include \"\\x2fetc/passwd\"", "line 2"},
      {"/* one\n*/ /*\n/**/ */\n#include \"/a\"", "line 4"},
      {"#include \"\"", "names the file ''"},
      {"#include \"..\"", "'..'"},
      {"#include \"a/..\"", "'a/..'"},
      {"#include \"a\\\"b\"", "line 1"},
      {"#include \"/open", "'/open'"},
      {"pigment { image_map \"/x.png\" }", "'/x.png'"},
      {"pigment { image_map { png concat(\"a\", \"b\") } }", "computes"},
      {"pigment { image_map { concat(\"a\", \"b\") } }", "computes"},
  };
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    CagPovrayJob job = job_for(ROWS[i].scene);
    CagPovrayResult result;
    CagError err = {0};
    assert_false(cag_povray_render(&job, &result, &err));
    if (!strstr(err.message, ROWS[i].says)) fail_msg("%zu: %s", i, err.message);
    assert_int_equal(err.status, CAG_E_RENDERER);
  }
}

static void names_in_the_folder_and_other_texts_are_let_through(void **state) {
  (void)state;
  static const char *const ROWS[] = {
      "#include \"colors.inc\"\n",
      "// #include \"/etc/passwd\"\n",
      "/* #include \"/etc/passwd\" */",
      "#debug \"/etc/passwd\"",
      "text { ttf \"timrom.ttf\" \"/../\" 1, 0 }",
      "text { ttf internal 1 \"/a\" 1, 0 }",
      "pigment { image_map { exr \"sky..v2.exr\" map_type 1 } }",
      "#declare Png = 1; #declare s = \"unended",
      "#declare s = \"unended\\",
      "#include \"a..b.inc\"",
      "#include \"..b.inc\"",
      "#include \"a/..b\"",
      "#include \"b../a\"",
      "pigment { image_map { N } }",
      "pigment { image_map N }",
      "image_map",
      "png + 1",
      "/*/ \"#include \"/etc/passwd\" */",
      "// ends in a slash /",
      "/",
      "/* unended /* twice */",
      "#",
      "",
  };
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    CagError err = {0};
    if (!cag_povray_check_files(ROWS[i], strlen(ROWS[i]), &err))
      fail_msg("%zu: %s", i, err.message);
  }
}

// Puts a shell script in the place of POV-Ray: bin/povray in our folder.
static char fake_bin[80], fake_program[96];

static void begin_fake(const char *script) {
  snprintf(fake_bin, sizeof fake_bin, "%s/bin", folder);
  snprintf(fake_program, sizeof fake_program, "%s/bin/povray", folder);
  mkdir(fake_bin, 0777);
  FILE *f = fopen(fake_program, "w");
  fprintf(f, "#!/bin/sh\n%s\n", script);
  fclose(f);
  chmod(fake_program, 0755);
}

static void end_fake(void) {
  unlink(fake_program);
  rmdir(fake_bin);
}

// Puts it there while `job` runs, expects the job to fail, and gives the error.
static CagError run_fake(const char *script, CagPovrayJob job) {
  char list[4300];
  const size_t files_before = count_entries();
  begin_fake(script);
  snprintf(list, sizeof list, "%s:%s", fake_bin, real_path);
  setenv("PATH", list, 1);
  CagPovrayResult result;
  CagError err = {0};
  bool ok = cag_povray_render(&job, &result, &err);
  setenv("PATH", real_path, 1);
  end_fake();
  assert_false(ok);
  assert_int_equal(count_entries(), files_before);
  return err;
}

static void a_missing_povray_is_named(void **state) {
  (void)state;
  CagPovrayJob job = job_for(SQUARE);
  CagPovrayResult result;
  CagError err = {0};
  setenv("PATH", folder, 1);
  bool ok = cag_povray_render(&job, &result, &err);
  setenv("PATH", real_path, 1);
  assert_false(ok);
  assert_int_equal(err.status, CAG_E_RENDERER);
  assert_non_null(strstr(err.message, "not installed"));
  assert_non_null(strstr(err.help, "apt-get install povray"));
}

static void a_killed_povray_is_told_with_its_last_lines(void **state) {
  (void)state;
  CagError err =
      run_fake("for i in 1 2 3 4 5 6 7; do echo line $i >&2; done; kill -SEGV $$", job_for(SQUARE));
  assert_int_equal(err.status, CAG_E_RENDERER);
  assert_non_null(strstr(err.message, "killed by signal 11"));
  assert_non_null(strstr(err.message, "\nline 3\nline 4\nline 5\nline 6\nline 7"));
  assert_null(strstr(err.message, "line 2"));
}

static void a_failing_povray_is_told_with_its_status(void **state) {
  (void)state;
  CagError err = run_fake("echo no more memory; exit 9", job_for(SQUARE));
  assert_int_equal(err.status, CAG_E_RENDERER);
  assert_non_null(strstr(err.message, "exit status 9"));
  assert_non_null(strstr(err.message, "\nno more memory"));
}

static void a_povray_without_picture_is_told(void **state) {
  (void)state;
  CagError err = run_fake("exit 0", job_for(SQUARE));
  assert_non_null(strstr(err.message, "wrote no picture"));
  static const char *const SCRIPTS[] = {": > out.exr", "mkdir out.exr", "echo x > out.exr; exit 3",
                                        "echo The disk is full; exit 0",
                                        "echo 'Render Statistics'; : > out.exr; sleep 0.2; exit 0"};
  static const char *const SAYS[] = {"wrote no picture", "wrote no picture", "exit status 3",
                                     "wrote no picture; its last lines were:\nThe disk is full",
                                     "wrote no picture"};
  for (size_t i = 0; i < sizeof SCRIPTS / sizeof *SCRIPTS; i++) {
    err = run_fake(SCRIPTS[i], job_for(SQUARE));
    if (!strstr(err.message, SAYS[i])) fail_msg("%s: %s", SCRIPTS[i], err.message);
  }
}

// The line of the scene that an error names, where it is of the scene and has it.
static void the_line_of_an_error_is_shown(void **state) {
  (void)state;
  static const struct {
    const char *file, *line, *says;
  } ROWS[] = {
      {"scene.pov", "1", "'scene.pov': Bad\none"}, {"scene.pov", "2", "'scene.pov': Bad\ntwo"},
      {"scene.pov", "3", "'scene.pov': Bad"},      {"scene.pov", "4", "'scene.pov': Bad\nfour"},
      {"scene.pov", "99", "'scene.pov': Bad"},     {"a.inc", "1", "'a.inc': Bad"},
  };
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    char script[128];
    snprintf(script, sizeof script, "echo \"File '%s' line %s: Parse Error: Bad\"; exit 1",
             ROWS[i].file, ROWS[i].line);
    const CagError err = run_fake(script, job_for("one\n \t two\r\n\t\nfour"));
    const size_t n = strlen(err.message), k = strlen(ROWS[i].says);
    if (n < k || strcmp(err.message + n - k, ROWS[i].says) != 0) fail_msg("%s", err.message);
  }
  char scene[400];
  memset(scene, 'x', sizeof scene - 1);
  scene[sizeof scene - 1] = 0;
  const CagError err =
      run_fake("echo \"File 'scene.pov' line 1: Error: Bad\"; exit 1", job_for(scene));
  assert_int_equal(strspn(strrchr(err.message, '\n') + 1, "x"), 120); // of a long line
}

// The arguments of a job, as POV-Ray gets them.
static void a_job_becomes_arguments(void **state) {
  (void)state;
  static const struct {
    CagPovrayJob job;
    const char *arguments;
  } ROWS[] = {
      {{.threads = 1}, "+W64 +H48 +WT1 +SC1 +EC64 +SR1 +ER48 +Q8 -A +AM1 +R1 -J -UA"},
      {{.threads = 9999, .quality = CAG_POVRAY_FINAL, .alpha = true},
       "+WT512 +SC1 +EC64 +SR1 +ER48 +Q9 +A0.02 +AM2 +R4 -J +UA"},
      {{.threads = 2, .quality = CAG_POVRAY_NORMAL}, "+WT2 +SC1 +EC64 +SR1 +ER48 +Q9 +A0.1"},
      {{.threads = 2, .quality = CAG_POVRAY_NORMAL, .lens = true}, "+ER48 +Q9 -A +AM2"},
      {{.threads = 2, .region_x = 8, .region_y = 4, .region_width = 16, .region_height = 10},
       "+SC9 +EC24 +SR5 +ER14"},
  };
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    CagPovrayJob job = ROWS[i].job;
    job.scene = SQUARE;
    job.scene_size = strlen(SQUARE);
    job.width = 64;
    job.height = 48;
    const CagError err = run_fake("echo \"$*\" | cut -c 1-99; exit 1", job);
    if (!strstr(err.message, ROWS[i].arguments)) fail_msg("%zu: %s", i, err.message);
  }
}

static void a_povray_that_is_no_program_is_told(void **state) {
  (void)state;
  CagError err = run_fake("#\nexec /nowhere/interpreter", job_for(SQUARE));
  assert_int_equal(err.status, CAG_E_RENDERER);
}

static void a_stubborn_group_is_killed_whole(void **state) {
  (void)state;
  // Ignores every polite signal, closes its output, and has a child.
  CagPovrayJob job = job_for(SQUARE);
  job.time_limit = 0.4;
  const double begun = seconds();
  CagError err =
      run_fake("trap '' TERM INT HUP; sleep 30 & exec >/dev/null 2>&1; sleep 30; sleep 30", job);
  assert_true(seconds() - begun < 10);
  assert_int_equal(err.status, CAG_E_LIMIT);
}

static void a_child_that_stays_does_not_hold_the_run(void **state) {
  (void)state;
  const double begun = seconds();
  CagError err = run_fake("sleep 30 & exit 3", job_for(SQUARE));
  assert_true(seconds() - begun < 10);
  assert_non_null(strstr(err.message, "exit status 3"));
}

static void the_process_sees_no_configuration_and_no_secrets(void **state) {
  (void)state;
  setenv("CAG_TEST_SECRET", "hidden", 1);
  setenv("POVINI", "/etc/elsewhere.ini", 1);
  CagError err =
      run_fake("echo \"[$CAG_TEST_SECRET$POVINI]\"; test \"$HOME\" = \"$(pwd)\" || echo home; "
               "cat .povray/3.7/povray.conf | head -2 | tail -1; exit 1",
               job_for(SQUARE));
  unsetenv("CAG_TEST_SECRET");
  unsetenv("POVINI");
  assert_non_null(strstr(err.message, "\n[]\nrestricted"));
}

static void the_process_is_kept_in_its_folder(void **state) {
  (void)state;
  char outside[96];
  snprintf(outside, sizeof outside, "%s.outside", folder);
  char script[256];
  snprintf(
      script, sizeof script,
      "cat /etc/passwd >/dev/null 2>&1 && echo reads; (echo x >%s) 2>/dev/null && echo writes; "
      "echo x >inside && echo works; exit 1",
      outside);
  CagPovrayJob job = job_for(SQUARE);
  // Where the kernel has no Landlock the file is written, and there is nothing to test.
  CagError err = run_fake(script, job);
  assert_non_null(strstr(err.message, "works"));
  if (access(outside, F_OK) == 0) {
    unlink(outside);
    skip();
  }
  assert_null(strstr(err.message, "reads"));
  assert_null(strstr(err.message, "writes"));
}

static void impossible_sizes_are_refused(void **state) {
  (void)state;
  static const int SIZES[][2] = {{0, 1}, {1, 0}, {1 << 20, 1}, {1, 1 << 20}, {-5, 1}};
  for (size_t i = 0; i < sizeof SIZES / sizeof *SIZES; i++) {
    CagPovrayJob job = job_for(SQUARE);
    CagPovrayResult result;
    CagError err = {0};
    job.width = SIZES[i][0];
    job.height = SIZES[i][1];
    assert_false(cag_povray_render(&job, &result, &err));
    assert_int_equal(err.status, CAG_E_USAGE);
  }
}

static void only_ordinary_files_stand_beside_the_scene(void **state) {
  (void)state;
  char long_name[300] = {0}, source[96], unsafe[96], dangling[96];
  memset(long_name, 'n', 256);
  snprintf(source, sizeof source, "%s/source", folder);
  snprintf(unsafe, sizeof unsafe, "%s/unsafe", folder);
  snprintf(dangling, sizeof dangling, "%s/dangling", folder);
  FILE *f = fopen(source, "w");
  fputs("// nothing\n", f);
  fclose(f);
  f = fopen(unsafe, "w");
  fputs("#include \"/etc/passwd\"\n", f);
  fclose(f);
  const struct {
    CagPovrayFile file;
    const char *says; // NULL: it is taken
  } ROWS[] = {
      {{"", source}, "cannot be the name"},
      {{".hidden", source}, "cannot be the name"},
      {{"a/b", source}, "cannot be the name"},
      {{long_name, source}, "cannot be the name"},
      {{"a", folder}, "not a regular file"},
      {{"a", "/dev/null"}, "not a regular file"},
      {{"a", dangling}, "No such file"},
      {{"a.inc", unsafe}, "outside the scene's folder"},
      {{"plain", source}, NULL},
      {{"a.inc", source}, NULL},
      {{"a.txt", unsafe}, NULL},
  };
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    CagPovrayJob job = job_for(SQUARE);
    job.file = &ROWS[i].file;
    const CagError err = run_fake("exit 1", job);
    if (!strstr(err.message, ROWS[i].says ? ROWS[i].says : "exit status 1"))
      fail_msg("%s from %s: %s", ROWS[i].file.name, ROWS[i].file.source, err.message);
  }
  unlink(source);
  unlink(unsafe);
}

static void povray_is_found_on_any_path(void **state) {
  (void)state;
  // bin/povray says its version; a folder of that name is passed over.
  char other[80], other_program[96], real[4096], paths[4300];
  snprintf(other, sizeof other, "%s/other", folder);
  snprintf(other_program, sizeof other_program, "%s/povray", other);
  mkdir(other, 0777);
  mkdir(other_program, 0777);
  begin_fake("echo 'POV-Ray 9.9.9 x'");
  assert_non_null(realpath(fake_program, real));
  char before[4096];
  assert_non_null(getcwd(before, sizeof before));
  snprintf(paths, sizeof paths, "/nowhere:%s:%s", other, fake_bin);
  char long_list[9000] = "/";
  memset(long_list + 1, 'n', 5000);
  strcpy(long_list + 5001, ":bin");
  const struct {
    const char *folder, *list;
    bool found;
  } ROWS[] = {
      {folder, paths, true},      {folder, "bin", true},    {folder, "nowhere:./bin", true},
      {fake_bin, ":/none", true}, {folder, "other", false}, {folder, "/none", false},
      {folder, long_list, true},
  };
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    char found[4096], version[64];
    CagError err = {0};
    assert_int_equal(chdir(ROWS[i].folder), 0);
    setenv("PATH", ROWS[i].list, 1);
    const bool good = cag_povray_find(found, sizeof found, version, &err);
    setenv("PATH", real_path, 1);
    assert_int_equal(chdir(before), 0);
    if (good != ROWS[i].found) fail_msg("%.40s: %s", ROWS[i].list, err.message);
    if (!good) continue;
    assert_string_equal(found, real);
    assert_string_equal(version, "9.9.9");
  }
  end_fake();
  rmdir(other_program);
  rmdir(other);
}

static void an_empty_path_is_that_of_the_system(void **state) {
  (void)state;
  char found[4096];
  const bool there = access("/usr/bin/povray", X_OK) == 0 || access("/bin/povray", X_OK) == 0 ||
                     access("/usr/local/bin/povray", X_OK) == 0;
  for (int unset = 0; unset < 2; unset++) {
    if (unset) unsetenv("PATH");
    else setenv("PATH", "", 1);
    char version[64];
    const bool good = cag_povray_find(found, sizeof found, version, NULL);
    setenv("PATH", real_path, 1);
    assert_true(good == there);
  }
}

static void a_povray_that_tells_no_version_is_told(void **state) {
  (void)state;
  char version[64];
  static const struct {
    const char *script, *says;
  } ROWS[] = {{"echo hello", "\nhello"},
              {"kill -KILL $$", "killed by signal 9"},
              {"exit 4", "exit status 4"},
              {"kill -TERM $$", "killed by signal 15"}};
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    begin_fake(ROWS[i].script);
    setenv("PATH", fake_bin, 1);
    CagError err = {0};
    const bool good = cag_povray_find(NULL, 0, version, &err);
    setenv("PATH", real_path, 1);
    end_fake();
    assert_false(good);
    if (!strstr(err.message, ROWS[i].says)) fail_msg("%s: %s", ROWS[i].script, err.message);
  }
}

static void a_temporary_folder_that_cannot_be_is_told(void **state) {
  (void)state;
  char version[64], long_name[5000] = "/";
  begin_fake("echo POV-Ray 9.9.9; exit 1");
  memset(long_name + 1, 'n', 4500);
  const struct {
    const char *folder, *says; // says: NULL where it is not needed
  } ROWS[] = {{"/nowhere/at/all", "No such file"},
              {long_name, "File name too long"},
              {"relative", NULL}, // then it is /tmp
              {"", NULL}};
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    CagPovrayJob job = job_for(SQUARE);
    CagPovrayResult result;
    CagError found = {0}, rendered = {0};
    setenv("TMPDIR", ROWS[i].folder, 1);
    setenv("PATH", fake_bin, 1);
    const bool good = cag_povray_find(NULL, 0, version, &found);
    assert_false(cag_povray_render(&job, &result, &rendered));
    setenv("TMPDIR", folder, 1);
    setenv("PATH", real_path, 1);
    assert_true(good == !ROWS[i].says);
    if (good) continue;
    assert_non_null(strstr(found.message, ROWS[i].says));
    assert_non_null(strstr(rendered.message, ROWS[i].says));
    assert_int_equal(rendered.status, CAG_E_FILE);
    assert_non_null(strstr(rendered.help, "TMPDIR"));
  }
  end_fake();
}

static void the_version_is_found(void **state) {
  (void)state;
  if (!installed) skip();
  char path[4096], version[64];
  assert_true(cag_povray_find(path, sizeof path, version, NULL));
  assert_true(path[0] == '/' && version[0] >= '3');
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_picture_is_linear_light),
      cmocka_unit_test(alpha_is_written_when_asked_for),
      cmocka_unit_test(files_of_the_job_are_there),
      cmocka_unit_test(a_broken_scene_shows_its_line),
      cmocka_unit_test(an_endless_scene_ends_at_the_time_limit),
      cmocka_unit_test(an_interrupt_ends_the_run),
      cmocka_unit_test(files_outside_the_folder_are_refused),
      cmocka_unit_test(names_in_the_folder_and_other_texts_are_let_through),
      cmocka_unit_test(a_missing_povray_is_named),
      cmocka_unit_test(a_killed_povray_is_told_with_its_last_lines),
      cmocka_unit_test(a_failing_povray_is_told_with_its_status),
      cmocka_unit_test(a_povray_without_picture_is_told),
      cmocka_unit_test(a_povray_that_is_no_program_is_told),
      cmocka_unit_test(a_stubborn_group_is_killed_whole),
      cmocka_unit_test(a_child_that_stays_does_not_hold_the_run),
      cmocka_unit_test(the_process_sees_no_configuration_and_no_secrets),
      cmocka_unit_test(the_process_is_kept_in_its_folder),
      cmocka_unit_test(the_line_of_an_error_is_shown),
      cmocka_unit_test(a_job_becomes_arguments),
      cmocka_unit_test(impossible_sizes_are_refused),
      cmocka_unit_test(only_ordinary_files_stand_beside_the_scene),
      cmocka_unit_test(povray_is_found_on_any_path),
      cmocka_unit_test(an_empty_path_is_that_of_the_system),
      cmocka_unit_test(a_povray_that_tells_no_version_is_told),
      cmocka_unit_test(a_temporary_folder_that_cannot_be_is_told),
      cmocka_unit_test(the_version_is_found),
  };
  return cmocka_run_group_tests(tests, prepare, finish);
}
