// Watching files: saves of all kinds are noticed, with events and without.

#include <limits.h>
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

#include "base/clock.h"
#include "live/watch_files.h"
#include "tests/fuzz/failing.h"

volatile int cag_tool_interrupt;

// Generous, because the machine may be busy; a change that is noticed ends the wait.
#define LONG 20000

typedef struct Place {
  char folder[64], a[128], b[128], other[128];
  CagFileWatch *watch;
} Place;

static void write_text(const char *path, const char *text) {
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  fputs(text, f);
  fclose(f);
}

static Place begin(bool polled) {
  Place p;
  strcpy(p.folder, "/tmp/cag-watch-XXXXXX");
  assert_non_null(mkdtemp(p.folder));
  snprintf(p.a, sizeof p.a, "%s/a.cag", p.folder);
  snprintf(p.b, sizeof p.b, "%s/b.csv", p.folder);
  snprintf(p.other, sizeof p.other, "%s/other", p.folder);
  write_text(p.a, "a");
  p.watch = cag_file_watch_new(polled);
  assert_non_null(p.watch);
  return p;
}

static void end(Place *p) {
  cag_file_watch_free(p->watch);
  unlink(p->a);
  unlink(p->b);
  unlink(p->other);
  rmdir(p->folder);
}

static void set(Place *p, const char *one, const char *two) {
  const char *paths[] = {one, two};
  // Nothing counts as changed before it was watched.
  assert_true(cag_file_watch_set(p->watch, paths, two ? 2 : 1, cag_file_watch_now() + 1e6));
}

static void expect_change(Place *p, const char *path) {
  const char *found = NULL;
  assert_true(cag_file_watch_wait(p->watch, LONG, 1, 1, &found));
  assert_string_equal(found, path);
}

static void saves_are_noticed(bool polled) {
  Place p = begin(polled);
  set(&p, p.a, p.b); // b does not exist yet
  assert_false(cag_file_watch_look(p.watch, NULL));
  write_text(p.a, "written");
  expect_change(&p, p.a);
  assert_false(cag_file_watch_look(p.watch, NULL));
  // By renaming, as many editors do; the size stays the same.
  write_text(p.other, "renamed");
  assert_int_equal(rename(p.other, p.a), 0);
  expect_change(&p, p.a);
  // Deleted and made again
  unlink(p.a);
  expect_change(&p, p.a);
  write_text(p.a, "again");
  expect_change(&p, p.a);
  write_text(p.b, "1,2");
  expect_change(&p, p.b);
  // A file that is not in the list
  write_text(p.other, "other");
  assert_false(cag_file_watch_wait(p.watch, 600, 1, 1, NULL));
  end(&p);
}

static void saves_are_noticed_by_events(void **state) {
  (void)state;
  saves_are_noticed(false);
}

static void saves_are_noticed_without_events(void **state) {
  (void)state;
  saves_are_noticed(true);
}

static void a_folder_may_be_replaced(void **state) {
  (void)state;
  Place p = begin(false);
  char folder[PATH_MAX], file[PATH_MAX];
  snprintf(folder, sizeof folder, "%s/parts", p.folder);
  snprintf(file, sizeof file, "%s/parts/lid.cag", p.folder);
  set(&p, file, NULL); // the folder is missing
  assert_true(cag_file_watch_interval(p.watch) > 0);
  assert_int_equal(mkdir(folder, 0777), 0);
  write_text(file, "1");
  expect_change(&p, file);
  assert_int_equal(cag_file_watch_interval(p.watch), -1);
  unlink(file);
  rmdir(folder);
  expect_change(&p, file);
  assert_int_equal(mkdir(folder, 0777), 0);
  write_text(file, "2");
  expect_change(&p, file);
  write_text(file, "3 and more");
  expect_change(&p, file);
  unlink(file);
  rmdir(folder);
  end(&p);
}

// A save between the run that reads a file and the watch is not lost.
static void a_file_that_changed_since_the_run_counts(void **state) {
  (void)state;
  Place p = begin(false);
  const char *paths[] = {p.a};
  const char *found;
  assert_true(cag_file_watch_set(p.watch, paths, 1, 0)); // since 1970
  assert_true(cag_file_watch_look(p.watch, &found));
  assert_string_equal(found, p.a);
  assert_false(cag_file_watch_look(p.watch, NULL));
  // Known files keep their state, and a change that is not reported yet.
  write_text(p.a, "longer text");
  assert_true(cag_file_watch_set(p.watch, paths, 1, cag_file_watch_now() + 1e6));
  expect_change(&p, p.a);
  end(&p);
}

static void a_file_is_no_longer_watched_once_it_is_dropped(void **state) {
  (void)state;
  Place p = begin(false);
  write_text(p.b, "b");
  set(&p, p.a, p.b);
  set(&p, p.b, NULL);
  write_text(p.a, "longer");
  assert_false(cag_file_watch_wait(p.watch, 300, 1, 1, NULL));
  write_text(p.b, "longer");
  expect_change(&p, p.b);
  end(&p);
}

static void several_steps_of_a_save_are_one_change(void **state) {
  (void)state;
  Place p = begin(false);
  set(&p, p.a, NULL);
  write_text(p.a, "");
  write_text(p.a, "first");
  assert_true(cag_file_watch_wait(p.watch, LONG, 200, 5000, NULL));
  assert_false(cag_file_watch_look(p.watch, NULL));
  end(&p);
}

// A script may read thousands of files. The list is replaced after each run, so that must not take
// quadratic time.
static void many_files_are_watched(void **state) {
  (void)state;
  enum { MANY = 50000 };
  Place p = begin(false);
  char **paths = calloc(MANY + 1, sizeof *paths);
  assert_non_null(paths);
  for (int i = 0; i < MANY; i++) {
    paths[i] = malloc(128);
    assert_non_null(paths[i]);
    snprintf(paths[i], 128, "%s/missing-%d", p.folder, i);
  }
  paths[MANY] = p.a;
  const double begun = cag_clock_seconds();
  for (int i = 0; i < 3; i++)
    assert_true(cag_file_watch_set(p.watch, (const char *const *)paths, MANY + 1, 1e300));
  assert_true(cag_clock_seconds() - begun < 10); // 0.2 s on an idle machine
  write_text(p.a, "longer");
  expect_change(&p, p.a);
  for (int i = 0; i < MANY; i++) free(paths[i]);
  free(paths);
  end(&p);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(saves_are_noticed_by_events),
      cmocka_unit_test(saves_are_noticed_without_events),
      cmocka_unit_test(a_folder_may_be_replaced),
      cmocka_unit_test(a_file_that_changed_since_the_run_counts),
      cmocka_unit_test(a_file_is_no_longer_watched_once_it_is_dropped),
      cmocka_unit_test(several_steps_of_a_save_are_one_change),
      cmocka_unit_test(many_files_are_watched),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
