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
    CagIoError err = {0};
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
  CagIoError err = {0};
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
  job.files = &file;
  job.file_count = 1;
  CagPovrayResult result;
  CagIoError err = {0};
  bool ok = cag_povray_render(&job, &result, &err);
  unlink(source);
  if (!ok) fail_msg("%s", err.message);
  cag_povray_result_free(&result);
  const CagPovrayFile missing = {"a.inc", source}, elsewhere = {"../a.inc", source};
  job.files = &missing;
  assert_false(cag_povray_render(&job, &result, &err));
  assert_int_equal(err.exit_status, CAG_EXIT_FILE);
  assert_non_null(strstr(err.message, source));
  job.files = &elsewhere;
  assert_false(cag_povray_render(&job, &result, &err));
  assert_int_equal(err.exit_status, CAG_EXIT_USAGE);
}

static void a_broken_scene_shows_its_line(void **state) {
  (void)state;
  if (!installed) skip();
  CagPovrayJob job = job_for(HEAD "// fine\n  sphere { <0,0,0> 1 pigmint { rgb 1 } }\n");
  CagPovrayResult result;
  CagIoError err = {0};
  assert_false(cag_povray_render(&job, &result, &err));
  assert_int_equal(err.exit_status, CAG_EXIT_RENDERER);
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
  CagIoError err = {0};
  const double begun = seconds();
  assert_false(cag_povray_render(&job, &result, &err));
  assert_true(seconds() - begun < 10);
  assert_int_equal(err.exit_status, CAG_EXIT_LIMIT);
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
  CagIoError err = {0};
  pthread_t thread;
  interrupted = 0;
  assert_int_equal(pthread_create(&thread, NULL, interrupt_soon, NULL), 0);
  const double begun = seconds();
  assert_false(cag_povray_render(&job, &result, &err));
  assert_true(seconds() - begun < 10);
  pthread_join(thread, NULL);
  assert_int_equal(err.exit_status, CAG_EXIT_INTERRUPTED);
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
  };
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    CagPovrayJob job = job_for(ROWS[i].scene);
    CagPovrayResult result;
    CagIoError err = {0};
    assert_false(cag_povray_render(&job, &result, &err));
    if (!strstr(err.message, ROWS[i].says)) fail_msg("%zu: %s", i, err.message);
    assert_int_equal(err.exit_status, CAG_EXIT_RENDERER);
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
      "/* unended /* twice */",
      "#",
      "",
  };
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    CagIoError err = {0};
    if (!cag_povray_check_files(ROWS[i], strlen(ROWS[i]), &err))
      fail_msg("%zu: %s", i, err.message);
  }
}

// Puts a shell script in the place of POV-Ray while `job` runs, expects it to fail, and gives the
// error.
static CagIoError run_fake(const char *script, CagPovrayJob job) {
  char place[96], path[160];
  snprintf(place, sizeof place, "%s/bin", folder);
  mkdir(place, 0777);
  snprintf(path, sizeof path, "%s/povray", place);
  FILE *f = fopen(path, "w");
  fprintf(f, "#!/bin/sh\n%s\n", script);
  fclose(f);
  chmod(path, 0755);
  char list[4300];
  snprintf(list, sizeof list, "%s:%s", place, real_path);
  setenv("PATH", list, 1);
  CagPovrayResult result;
  CagIoError err = {0};
  bool ok = cag_povray_render(&job, &result, &err);
  setenv("PATH", real_path, 1);
  unlink(path);
  rmdir(place);
  assert_false(ok);
  assert_int_equal(count_entries(), 0);
  return err;
}

static void a_missing_povray_is_named(void **state) {
  (void)state;
  CagPovrayJob job = job_for(SQUARE);
  CagPovrayResult result;
  CagIoError err = {0};
  setenv("PATH", folder, 1);
  bool ok = cag_povray_render(&job, &result, &err);
  setenv("PATH", real_path, 1);
  assert_false(ok);
  assert_int_equal(err.exit_status, CAG_EXIT_RENDERER);
  assert_non_null(strstr(err.message, "not installed"));
  assert_non_null(strstr(err.help, "apt-get install povray"));
}

static void a_killed_povray_is_told_with_its_last_lines(void **state) {
  (void)state;
  CagIoError err =
      run_fake("for i in 1 2 3 4 5 6 7; do echo line $i >&2; done; kill -SEGV $$", job_for(SQUARE));
  assert_int_equal(err.exit_status, CAG_EXIT_RENDERER);
  assert_non_null(strstr(err.message, "killed by signal 11"));
  assert_non_null(strstr(err.message, "\nline 3\nline 4\nline 5\nline 6\nline 7"));
  assert_null(strstr(err.message, "line 2"));
}

static void a_failing_povray_is_told_with_its_status(void **state) {
  (void)state;
  CagIoError err = run_fake("echo no more memory; exit 9", job_for(SQUARE));
  assert_int_equal(err.exit_status, CAG_EXIT_RENDERER);
  assert_non_null(strstr(err.message, "exit status 9"));
  assert_non_null(strstr(err.message, "\nno more memory"));
}

static void a_povray_without_picture_is_told(void **state) {
  (void)state;
  CagIoError err = run_fake("exit 0", job_for(SQUARE));
  assert_non_null(strstr(err.message, "wrote no picture"));
}

static void a_povray_that_is_no_program_is_told(void **state) {
  (void)state;
  CagIoError err = run_fake("#\nexec /nowhere/interpreter", job_for(SQUARE));
  assert_int_equal(err.exit_status, CAG_EXIT_RENDERER);
}

static void a_stubborn_group_is_killed_whole(void **state) {
  (void)state;
  // Ignores every polite signal, closes its output, and has a child.
  CagPovrayJob job = job_for(SQUARE);
  job.time_limit = 0.4;
  const double begun = seconds();
  CagIoError err =
      run_fake("trap '' TERM INT HUP; sleep 30 & exec >/dev/null 2>&1; sleep 30; sleep 30", job);
  assert_true(seconds() - begun < 10);
  assert_int_equal(err.exit_status, CAG_EXIT_LIMIT);
}

static void a_child_that_stays_does_not_hold_the_run(void **state) {
  (void)state;
  const double begun = seconds();
  CagIoError err = run_fake("sleep 30 & exit 3", job_for(SQUARE));
  assert_true(seconds() - begun < 10);
  assert_non_null(strstr(err.message, "exit status 3"));
}

static void the_process_sees_no_configuration_and_no_secrets(void **state) {
  (void)state;
  setenv("CAG_TEST_SECRET", "hidden", 1);
  setenv("POVINI", "/etc/elsewhere.ini", 1);
  CagIoError err =
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
  CagIoError err = run_fake(script, job);
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
  CagPovrayJob job = job_for(SQUARE);
  CagPovrayResult result;
  CagIoError err = {0};
  job.width = 0;
  assert_false(cag_povray_render(&job, &result, &err));
  assert_int_equal(err.exit_status, CAG_EXIT_USAGE);
  job.width = 1 << 20;
  assert_false(cag_povray_render(&job, &result, &err));
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
      cmocka_unit_test(impossible_sizes_are_refused),
      cmocka_unit_test(the_version_is_found),
  };
  return cmocka_run_group_tests(tests, prepare, finish);
}
