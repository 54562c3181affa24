// Output files: whole or not at all, in every way that writing can end.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/stop.h"

static char folder[64];

static int enter_folder(void **state) {
  (void)state;
  strcpy(folder, "/tmp/cag-atomic-XXXXXX");
  return mkdtemp(folder) ? chdir(folder) : -1;
}

static int leave_folder(void **state) {
  (void)state;
  return chdir("/") ? -1 : rmdir(folder);
}

static size_t count_entries(void) {
  DIR *d = opendir(".");
  size_t n = 0;
  for (struct dirent *e; (e = readdir(d));) n += strcmp(e->d_name, ".") && strcmp(e->d_name, "..");
  closedir(d);
  return n;
}

static void put_file(const char *path, const char *text) {
  FILE *f = fopen(path, "w");
  fputs(text, f);
  fclose(f);
}

static void assert_content(const char *path, const char *text) {
  char bytes[256] = {0};
  FILE *f = fopen(path, "r");
  assert_non_null(f);
  size_t n = fread(bytes, 1, sizeof bytes - 1, f);
  fclose(f);
  assert_int_equal(n, strlen(text));
  assert_string_equal(bytes, text);
}

static CagAtomicFile *open_file(const char *path) {
  CagError err = {0};
  CagAtomicFile *f = cag_atomic_file_open(path, &err);
  if (!f) fail_msg("%s", err.message);
  return f;
}

static void a_file_appears_at_commit(void **state) {
  (void)state;
  CagAtomicFile *f = open_file("a");
  cag_atomic_file_text(f, "one ");
  cag_atomic_file_printf(f, "%d ", 2);
  char *at = cag_atomic_file_reserve(f, 10);
  memcpy(at, "three", 5);
  cag_atomic_file_advance(f, at + 5);
  assert_int_equal(cag_atomic_file_size(f), 11);
  assert_int_equal(access("a", F_OK), -1);
  assert_true(cag_atomic_file_commit(f, NULL));
  assert_content("a", "one 2 three");
  assert_int_equal(count_entries(), 1);
  unlink("a");
}

static void an_abort_leaves_the_old_file(void **state) {
  (void)state;
  put_file("a", "old");
  CagAtomicFile *f = open_file("a");
  cag_atomic_file_text(f, "new");
  cag_atomic_file_flush(f);
  assert_int_equal(count_entries(), 2);
  cag_atomic_file_abort(f);
  cag_atomic_file_abort(NULL);
  assert_content("a", "old");
  assert_int_equal(count_entries(), 1);
  unlink("a");
}

static void much_data_passes_in_order(void **state) {
  (void)state;
  // 40 MB through every way in, larger and smaller than the buffer; the byte at i is i mod 251.
  enum { BLOCK = 3000017, BLOCKS = 12 };
  unsigned char *block = malloc(BLOCK);
  CagAtomicFile *f = open_file("big");
  size_t i = 0;
  for (int b = 0; b < BLOCKS; b++) {
    for (size_t k = 0; k < BLOCK; k++) block[k] = (unsigned char)((i + k) % 251);
    cag_atomic_file_write(f, block, BLOCK);
    i += BLOCK;
    for (size_t n = 1; n <= CAG_ATOMIC_FILE_RESERVE_MAX; n *= 4) {
      char *at = cag_atomic_file_reserve(f, n);
      for (size_t k = 0; k < n; k++) at[k] = (char)((i + k) % 251);
      cag_atomic_file_advance(f, at + n);
      i += n;
    }
  }
  assert_int_equal(cag_atomic_file_size(f), i);
  assert_true(cag_atomic_file_commit(f, NULL));
  FILE *in = fopen("big", "rb");
  size_t seen = 0, n;
  while ((n = fread(block, 1, BLOCK, in)) > 0)
    for (size_t k = 0; k < n; k++, seen++)
      if (block[k] != seen % 251) fail_msg("byte %zu is wrong", seen);
  fclose(in);
  assert_int_equal(seen, i);
  free(block);
  unlink("big");
}

static void long_formatted_text_is_whole(void **state) {
  (void)state;
  CagAtomicFile *f = open_file("a");
  char *filler = malloc(1 << 20);
  memset(filler, 'x', (1 << 20) - 10);
  filler[(1 << 20) - 10] = '\0';
  cag_atomic_file_text(f, filler);
  cag_atomic_file_printf(f, "%s", "0123456789abcdef"); // does not fit the rest of the buffer
  cag_atomic_file_printf(f, "%s%s", filler, filler);   // fits no buffer
  assert_int_equal(cag_atomic_file_size(f), 3 * ((1 << 20) - 10) + 16);
  assert_true(cag_atomic_file_commit(f, NULL));
  struct stat st;
  stat("a", &st);
  assert_int_equal(st.st_size, 3 * ((1 << 20) - 10) + 16);
  free(filler);
  unlink("a");
}

static void permissions_are_kept_or_those_of_the_umask(void **state) {
  (void)state;
  struct stat st;
  mode_t mask = umask(027);
  assert_true(cag_atomic_file_commit(open_file("a"), NULL));
  stat("a", &st);
  assert_int_equal(st.st_mode & 0777, 0640);
  chmod("a", 0604);
  assert_true(cag_atomic_file_commit(open_file("a"), NULL));
  stat("a", &st);
  assert_int_equal(st.st_mode & 0777, 0604);
  umask(mask);
  unlink("a");
}

static void places_that_are_no_files_are_refused(void **state) {
  (void)state;
  char long_name[300] = {0};
  memset(long_name, 'n', 256);
  const struct {
    const char *path, *says;
  } ROWS[] = {
      {"", "empty name"},
      {".", "folder"},
      {"sub", "it is a folder"},
      {"sub/", "folder"},
      {"no/a", "No such"},
      {"file/a", "Not a"},
      {"new/", "the name of a folder"},
      {"no/.", "the name of a folder"},
      {"no/..", "the name of a folder"},
      {"socket", "a socket"},
      {long_name, "too long"},
      {"dangling", "symbolic link"},
  };
  const int s = socket(AF_UNIX, SOCK_STREAM, 0);
  const struct sockaddr_un place = {.sun_family = AF_UNIX, .sun_path = "socket"};
  assert_int_equal(bind(s, (const struct sockaddr *)&place, sizeof place), 0);
  mkdir("sub", 0777);
  put_file("file", "");
  assert_int_equal(symlink("nowhere", "dangling"), 0);
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    CagError err = {0};
    assert_null(cag_atomic_file_open(ROWS[i].path, &err));
    if (!strstr(err.message, ROWS[i].says)) fail_msg("%s: %s", ROWS[i].path, err.message);
    assert_int_equal(err.status, CAG_E_FILE);
  }
  close(s);
  unlink("socket");
  unlink("dangling");
  unlink("file");
  rmdir("sub");
  assert_int_equal(count_entries(), 0);
}

static void a_link_stays_a_link(void **state) {
  (void)state;
  mkdir("sub", 0777);
  put_file("sub/real", "old");
  assert_int_equal(symlink("sub/real", "link"), 0);
  CagAtomicFile *f = open_file("link");
  cag_atomic_file_text(f, "new");
  assert_true(cag_atomic_file_commit(f, NULL));
  struct stat st;
  lstat("link", &st);
  assert_true(S_ISLNK(st.st_mode));
  assert_content("sub/real", "new");
  unlink("link");
  unlink("sub/real");
  rmdir("sub");
}

static void a_device_is_written_not_replaced(void **state) {
  (void)state;
  CagAtomicFile *f = open_file("/dev/null");
  cag_atomic_file_text(f, "x");
  assert_true(cag_atomic_file_commit(f, NULL));
  struct stat st;
  stat("/dev/null", &st);
  assert_true(S_ISCHR(st.st_mode));
}

static int fifo; // the reading end of the one below
static size_t fifo_bytes, ticks;

static void drain_fifo(void) {
  char bytes[4096];
  for (ssize_t n; (n = read(fifo, bytes, sizeof bytes)) > 0; fifo_bytes += (size_t)n)
    for (ssize_t i = 0; i < n; i++)
      if (bytes[i] != (char)((fifo_bytes + (size_t)i) % 251)) _exit(1);
}

// At every second signal a write that waits is only interrupted.
static void on_tick(int number) {
  (void)number;
  const int saved = errno;
  if (ticks++ % 2) drain_fifo();
  errno = saved;
}

// A write to a FIFO waits for its reader, and signals interrupt it.
static void signals_lose_nothing_that_is_written(void **state) {
  (void)state;
  enum { SIZE = 500000 };
  assert_int_equal(mkfifo("fifo", 0600), 0);
  fifo = open("fifo", O_RDONLY | O_NONBLOCK);
  const struct sigaction action = {.sa_handler = on_tick};
  struct sigaction before;
  const struct itimerval often = {{0, 3000}, {0, 3000}}, never = {{0, 0}, {0, 0}};
  sigaction(SIGALRM, &action, &before);
  CagAtomicFile *f = open_file("fifo");
  char *bytes = malloc(SIZE);
  for (size_t i = 0; i < SIZE; i++) bytes[i] = (char)(i % 251);
  setitimer(ITIMER_REAL, &often, NULL);
  cag_atomic_file_write(f, bytes, SIZE);
  const bool good = cag_atomic_file_commit(f, NULL);
  setitimer(ITIMER_REAL, &never, NULL);
  sigaction(SIGALRM, &before, NULL);
  drain_fifo();
  assert_true(good);
  assert_int_equal(fifo_bytes, SIZE);
  free(bytes);
  close(fifo);
  unlink("fifo");
}

static void a_device_that_cannot_be_opened_is_told(void **state) {
  (void)state;
  const pid_t child = fork();
  if (child == 0) {
    setsid(); // a process without a terminal has no /dev/tty
    CagError err = {0};
    CagAtomicFile *f = cag_atomic_file_open("/dev/tty", &err);
    _exit(!f && strstr(err.message, "cannot write '/dev/tty'") ? 0 : 1);
  }
  int status;
  waitpid(child, &status, 0);
  assert_int_equal(status, 0);
}

static void a_full_disk_is_an_error(void **state) {
  (void)state;
  CagAtomicFile *f = open_file("/dev/full");
  cag_atomic_file_text(f, "x");
  assert_false(cag_atomic_file_failed(f)); // still in the buffer
  cag_atomic_file_flush(f);
  assert_true(cag_atomic_file_failed(f));
  CagError err = {0};
  assert_false(cag_atomic_file_commit(f, &err));
  assert_non_null(strstr(err.message, "'/dev/full' failed: No space left on device"));
  assert_int_equal(err.status, CAG_E_FILE);
}

static void a_file_that_cannot_grow_leaves_the_old_one(void **state) {
  (void)state;
  put_file("a", "old");
  // The system's limit for file sizes stands in for a full disk: write gives EFBIG after a short
  // write.
  struct rlimit before, small;
  getrlimit(RLIMIT_FSIZE, &before);
  small = before;
  small.rlim_cur = 100000;
  signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  CagAtomicFile *f = open_file("a");
  for (int i = 0; i < 300000; i++) cag_atomic_file_text(f, "0123456789");
  CagError err = {0};
  bool ok = cag_atomic_file_commit(f, &err);
  setrlimit(RLIMIT_FSIZE, &before);
  signal(SIGXFSZ, SIG_DFL);
  assert_false(ok);
  assert_non_null(strstr(err.message, "File too large"));
  assert_content("a", "old");
  assert_int_equal(count_entries(), 1);
  unlink("a");
}

static void on_signal(int number) {
  cag_atomic_files_cleanup();
  _exit(128 + number);
}

static void a_signal_leaves_no_temporary(void **state) {
  (void)state;
  pid_t child = fork();
  if (child == 0) {
    signal(SIGTERM, on_signal);
    CagAtomicFile *f = cag_atomic_file_open("a", NULL), *g = cag_atomic_file_open("b", NULL);
    if (!f || !g) _exit(1);
    if (chdir("/")) _exit(1); // the registry does not depend on the working folder
    raise(SIGTERM);
    _exit(2);
  }
  int status;
  waitpid(child, &status, 0);
  assert_int_equal(WEXITSTATUS(status), 128 + SIGTERM);
  assert_int_equal(count_entries(), 0);
}

static void a_child_does_not_remove_its_parents_files(void **state) {
  (void)state;
  CagAtomicFile *f = open_file("a");
  pid_t child = fork();
  if (child == 0) {
    cag_atomic_files_cleanup();
    _exit(0);
  }
  waitpid(child, NULL, 0);
  assert_true(cag_atomic_file_commit(f, NULL));
  unlink("a");
}

static void a_file_cleaned_up_cannot_be_committed(void **state) {
  (void)state;
  put_file("a", "old");
  CagAtomicFile *f = open_file("a");
  cag_atomic_files_cleanup();
  CagError err = {0};
  assert_false(cag_atomic_file_commit(f, &err));
  assert_content("a", "old");
  unlink("a");
}

static void many_files_may_be_open_but_not_endlessly(void **state) {
  (void)state;
  CagAtomicFile *files[300];
  size_t n = 0;
  CagError err = {0};
  char name[16];
  for (; n < 300; n++) {
    snprintf(name, sizeof name, "f%zu", n);
    files[n] = cag_atomic_file_open(name, &err);
    if (!files[n]) break;
  }
  assert_true(n >= 100 && n < 300);
  assert_true(err.message[0]);
  while (n) cag_atomic_file_abort(files[--n]);
  assert_int_equal(count_entries(), 0);
}

static void a_long_name_has_room_for_its_temporary(void **state) {
  (void)state;
  char name[256];
  memset(name, 'n', 255);
  name[255] = '\0';
  assert_true(cag_atomic_file_commit(open_file(name), NULL));
  assert_int_equal(unlink(name), 0);
}

static void memory_takes_the_same_writes(void **state) {
  (void)state;
  CagAtomicFile *f = cag_atomic_file_open_memory(NULL);
  for (int i = 0; i < 1000000; i++)
    cag_atomic_file_printf(f, "%06d\n", i); // seven times the buffer
  assert_int_equal(cag_atomic_file_size(f), 7000000);
  char *bytes;
  size_t size;
  assert_true(cag_atomic_file_commit_memory(f, &bytes, &size, NULL));
  assert_int_equal(size, 7000000);
  for (int i = 0; i < 1000000; i++) assert_int_equal(atoi(bytes + 7 * i), i);
  assert_int_equal(bytes[size], 0);
  free(bytes);
  assert_true(
      cag_atomic_file_commit_memory(cag_atomic_file_open_memory(NULL), &bytes, &size, NULL));
  assert_true(size == 0 && bytes[0] == 0);
  free(bytes);
  cag_atomic_file_abort(cag_atomic_file_open_memory(NULL));
  volatile int stop = 1;
  CagError err = {0};
  f = cag_atomic_file_open_memory(NULL);
  cag_atomic_file_text(f, "text");
  cag_stop_lend(&stop);
  const bool written = cag_atomic_file_commit_memory(f, &bytes, &size, &err);
  cag_stop_lend(NULL);
  assert_false(written);
  assert_int_equal(err.status, CAG_E_CALLBACK);
}

static void a_try_says_what_an_open_would_and_leaves_nothing(void **state) {
  (void)state;
  CagError err = {0};
  assert_true(cag_atomic_file_try("new", &err));
  assert_true(cag_atomic_file_try("-", &err));
  assert_true(cag_atomic_file_try("/dev/null", &err));
  assert_int_equal(count_entries(), 0);
  put_file("old", "old");
  assert_true(cag_atomic_file_try("old", &err));
  assert_content("old", "old");
  mkdir("dir", 0777);
  symlink("nowhere", "link");
  if (geteuid() == 0) assert_true(cag_atomic_file_try("/cag-file-of-a-test", &err));
  assert_int_equal(access("/cag-file-of-a-test", F_OK), -1);
  static const char *const REFUSED[] = {"", "dir", "link", "none/a", "old/a", "/proc/a", ".."};
  for (size_t i = 0; i < sizeof REFUSED / sizeof *REFUSED; i++) {
    CagError other = {0};
    assert_false(cag_atomic_file_try(REFUSED[i], &err));
    assert_null(cag_atomic_file_open(REFUSED[i], &other));
    assert_int_equal(cag_exit_status(&err), cag_exit_status(&other));
    assert_string_equal(err.message, other.message);
  }
  unlink("old");
  unlink("link");
  rmdir("dir");
}

static void work_that_is_to_end_writes_nothing(void **state) {
  (void)state;
  volatile int stop = 0;
  CagError err = {0};
  put_file("a", "earlier");
  cag_stop_lend(&stop);
  CagAtomicFile *f = open_file("a");
  cag_atomic_file_text(f, "later");
  stop = 1;
  cag_atomic_file_flush(f);
  cag_atomic_file_expect(f, 1 << 30); // no room is taken any more
  const bool written = cag_atomic_file_commit(f, &err);
  cag_stop_lend(NULL);
  assert_false(written);
  assert_int_equal(err.status, CAG_E_CALLBACK);
  assert_content("a", "earlier");
  assert_int_equal(count_entries(), 1);
  unlink("a");
}

static void standard_output_is_a_dash(void **state) {
  (void)state;
  fflush(stdout);
  int saved = dup(STDOUT_FILENO), to = open("out", O_WRONLY | O_CREAT, 0666);
  dup2(to, STDOUT_FILENO);
  printf("before ");
  cag_atomic_file_abort(open_file("-")); // leaves it open
  CagAtomicFile *f = open_file("-");
  cag_atomic_file_text(f, "data ");
  bool ok = cag_atomic_file_commit(f, NULL);
  printf("after");
  fflush(stdout);
  dup2(saved, STDOUT_FILENO);
  close(saved);
  close(to);
  assert_true(ok);
  assert_content("out", "before data after");
  unlink("out");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_file_appears_at_commit),
      cmocka_unit_test(an_abort_leaves_the_old_file),
      cmocka_unit_test(much_data_passes_in_order),
      cmocka_unit_test(long_formatted_text_is_whole),
      cmocka_unit_test(permissions_are_kept_or_those_of_the_umask),
      cmocka_unit_test(places_that_are_no_files_are_refused),
      cmocka_unit_test(a_link_stays_a_link),
      cmocka_unit_test(a_device_is_written_not_replaced),
      cmocka_unit_test(signals_lose_nothing_that_is_written),
      cmocka_unit_test(a_device_that_cannot_be_opened_is_told),
      cmocka_unit_test(a_full_disk_is_an_error),
      cmocka_unit_test(a_file_that_cannot_grow_leaves_the_old_one),
      cmocka_unit_test(a_signal_leaves_no_temporary),
      cmocka_unit_test(a_child_does_not_remove_its_parents_files),
      cmocka_unit_test(a_file_cleaned_up_cannot_be_committed),
      cmocka_unit_test(many_files_may_be_open_but_not_endlessly),
      cmocka_unit_test(a_long_name_has_room_for_its_temporary),
      cmocka_unit_test(memory_takes_the_same_writes),
      cmocka_unit_test(a_try_says_what_an_open_would_and_leaves_nothing),
      cmocka_unit_test(work_that_is_to_end_writes_nothing),
      cmocka_unit_test(standard_output_is_a_dash),
  };
  return cmocka_run_group_tests(tests, enter_folder, leave_folder);
}
