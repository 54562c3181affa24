// Journals and plans of batches: what is written comes back, torn and foreign files are told, and
// failing allocations do no harm.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/slurm_plan.h"
#include "tests/fuzz/failing.h"
#include "tests/geom/random.h"

volatile int cag_tool_interrupt;

static char folder[] = "/tmp/cag-journal-XXXXXX";

static int begin(void **state) {
  (void)state;
  assert_non_null(mkdtemp(folder));
  return chdir(folder);
}

static int end(void **state) {
  (void)state;
  remove("journal");
  remove("plan.json");
  return rmdir(folder);
}

static void write_bytes(const char *path, const char *text, size_t length) {
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  assert_int_equal(fwrite(text, 1, length, f), length);
  assert_int_equal(fclose(f), 0);
}

static void write_text(const char *path, const char *text) {
  write_bytes(path, text, strlen(text));
}

// --- Journals ---

#define KEY "0123456789abcdef0123456789abcdef"
#define LONG_KEY KEY "0"
#define DONE(key, rest) "{\"what\":\"done\",\"key\":\"" key "\"" rest "}\n"

// The entry of a key in a journal of this text.
static void test_lines(void **state) {
  (void)state;
  static const struct {
    const char *text, *key;
    double seconds; // -1: there is no entry
    size_t memory;
    int attempts;
  } rows[] = {
      {"", "a", -1, 0, 0},
      {DONE("a", ",\"seconds\":1.5,\"memory\":64,\"attempts\":2"), "a", 1.5, 64, 2},
      {DONE("a", ",\"seconds\":1.5"), "b", -1, 0, 0},
      {DONE("a", ""), "a", 0, 0, 0},
      {DONE("a", ",\"seconds\":\"x\",\"memory\":\"x\",\"attempts\":null"), "a", 0, 0, 0},
      {DONE("a", ",\"memory\":-3"), "a", 0, 0, 0},
      {DONE(KEY, ",\"seconds\":4"), KEY, 4, 0, 0},
      // the newest counts
      {DONE("a", ",\"seconds\":1") DONE("b", ",\"seconds\":2") DONE("a", ",\"seconds\":3"), "a", 3,
       0, 0},
      // a torn line, and lines that are none of ours among them, are passed over
      {DONE("a", ",\"seconds\":1") "{\"what\":\"done\",\"key\":\"a\",\"sec", "a", 1, 0, 0},
      {DONE("a", ",\"seconds\":1") "{\"what\":\"done\",\"ke\n" DONE("b", ",\"seconds\":2"), "b", 2,
       0, 0},
      {DONE("a", ",\"seconds\":1") "{\"what\":\"lost\",\"key\":\"a\"}\n", "a", 1, 0, 0},
      {DONE("a", ",\"seconds\":1") "{\"what\":\"done\",\"key\":3}\n", "a", 1, 0, 0},
      {DONE("a", ",\"seconds\":1") DONE(LONG_KEY, ",\"seconds\":9"), "a", 1, 0, 0},
      {DONE("a", ",\"seconds\":1") "mine\n", "a", 1, 0, 0},
      {"{\"wh", "a", -1, 0, 0},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    CagJournal j;
    CagError err = {0};
    write_text("journal", rows[i].text);
    assert_true(cag_journal_open(&j, "journal", false, &err));
    const CagJournalEntry *e = cag_journal_find(&j, rows[i].key);
    if ((e != NULL) != (rows[i].seconds >= 0)) print_error("%s: %s\n", rows[i].text, rows[i].key);
    assert_true((e != NULL) == (rows[i].seconds >= 0));
    if (e) {
      assert_true(e->seconds == rows[i].seconds);
      assert_int_equal(e->memory, rows[i].memory);
      assert_int_equal(e->attempts, rows[i].attempts);
    }
    cag_journal_close(&j);
  }
}

// Entries in any number and order, compared with a plain list; half of them in a second session.
static void test_round_trip(void **state) {
  (void)state;
  enum { KEYS = 200, ENTRIES = 500 };
  double newest[KEYS];
  CagJournal j;
  CagError err = {0};
  seed = 3;
  for (int k = 0; k < KEYS; k++) newest[k] = -1;
  write_text("journal", "");
  for (int session = 0; session < 2; session++) {
    assert_true(cag_journal_open(&j, "journal", false, &err));
    for (int i = 0; i < ENTRIES / 2; i++) {
      const int k = (int)uniform(0, KEYS);
      CagJournalEntry e = {.what = CAG_JOURNAL_FAILED, .seconds = i + 1000 * session};
      snprintf(e.key, sizeof e.key, "%d", k);
      newest[k] = e.seconds;
      assert_true(cag_journal_write(&j, &e, &err));
    }
    assert_true(cag_journal_sync(&j, &err));
    assert_true(cag_journal_sync(&j, &err));
    cag_journal_close(&j);
  }
  assert_true(cag_journal_open(&j, "journal", false, &err));
  for (int k = 0; k < KEYS; k++) {
    char key[16];
    snprintf(key, sizeof key, "%d", k);
    const CagJournalEntry *e = cag_journal_find(&j, key);
    assert_true(newest[k] < 0 ? !e : e && e->seconds == newest[k]);
  }
  cag_journal_close(&j);
  assert_true(cag_journal_open(&j, "journal", true, &err)); // a fresh one forgets
  assert_int_equal(j.count, 0);
  cag_journal_close(&j);
  assert_true(cag_journal_open(&j, "journal", false, &err));
  assert_int_equal(j.count, 0);
  cag_journal_close(&j);
}

static void test_job(void **state) {
  (void)state;
  CagJournal j;
  CagError err = {0};
  static const CagJournalEntry SUBMITTED = {.what = CAG_JOURNAL_SUBMITTED, .key = "cag-1"},
                               COLLECTED = {.what = CAG_JOURNAL_COLLECTED, .key = "cag-1"};
  write_text("journal", "");
  assert_true(cag_journal_open(&j, "journal", false, &err));
  assert_string_equal(j.job, "");
  assert_true(cag_journal_add(&j, &SUBMITTED, &err));
  cag_journal_close(&j);
  assert_true(cag_journal_open(&j, "journal", false, &err));
  assert_string_equal(j.job, "cag-1");
  assert_true(cag_journal_add(&j, &COLLECTED, &err));
  cag_journal_close(&j);
  assert_true(cag_journal_open(&j, "journal", false, &err));
  assert_string_equal(j.job, "");
  cag_journal_close(&j);
}

static void test_refused(void **state) {
  (void)state;
  static const struct {
    const char *text, *why;
  } rows[] = {
      {"my list\n", "the file is not a journal"},
      {"my list", "the file is not a journal"},
      {"{\"what\":\"lost\",\"key\":\"a\"}\nmine\n", "the file is not a journal"},
  };
  CagJournal j, other;
  CagError err = {0};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    write_text("journal", rows[i].text);
    assert_false(cag_journal_open(&j, "journal", false, &err));
    assert_non_null(strstr(err.message, rows[i].why));
  }
  remove("journal");
  assert_int_equal(mkfifo("journal", 0666), 0);
  assert_false(cag_journal_open(&j, "journal", false, &err));
  assert_non_null(strstr(err.message, "it is not a regular file"));
  remove("journal");
  assert_int_equal(mkdir("journal", 0777), 0);
  assert_false(cag_journal_open(&j, "journal", false, &err));
  assert_non_null(strstr(err.message, "cannot open the journal"));
  rmdir("journal");
  assert_true(cag_journal_open(&j, "journal", false, &err));
  assert_false(cag_journal_open(&other, "journal", false, &err));
  assert_non_null(strstr(err.message, "another batch of this table is running"));
  // What cannot be written is told, with the reason.
  close(j.fd);
  assert_int_equal(open("/dev/full", O_WRONLY), j.fd);
  assert_false(cag_journal_add(&j, &(CagJournalEntry){.key = "a"}, &err));
  assert_non_null(strstr(err.message, "No space left"));
  cag_journal_close(&j);
  cag_journal_close(&j);
}

static void test_journal_without_memory(void **state) {
  (void)state;
  for (size_t at = 1; at <= 4; at++) {
    CagJournal j;
    CagError err = {0};
    write_text("journal", DONE("a", ",\"seconds\":1") DONE("b", ",\"seconds\":2"));
    made = 0;
    failing = at;
    const bool ok = cag_journal_open(&j, "journal", false, &err);
    failing = 0;
    assert_true(ok == (at == 4)); // three allocations: the text, the entries, their order
    assert_true(ok || cag_exit_status(&err));
    cag_journal_close(&j);
  }
}

// --- Plans and results ---

#define TASK "{\"key\":\"k\",\"words\":[\"cag\",\"render\"]}"

static void test_plans(void **state) {
  (void)state;
  static char *words[] = {"cag", "render", "a b.cag", NULL};
  CagPlanTask tasks[2] = {{.key = KEY, .words = words}, {.key = "b", .words = words + 1}};
  const CagPlan plan = {.elements = 2,
                        .count = 2,
                        .retries = 3,
                        .max_time = 1.5,
                        .limit = 2.65,
                        .folder = "/some where",
                        .tasks = tasks};
  CagError err = {0};
  CagTool tool = {.style = CAG_STYLE_JSON};
  for (size_t at = 0; at <= 12; at++) {
    CagPlan back;
    assert_true(cag_plan_write(&plan, "plan.json", &err));
    made = 0;
    failing = at;
    const bool ok = cag_plan_read(&tool, &back, "plan.json");
    failing = 0;
    assert_true(ok || at > 0);
    if (!ok) continue;
    assert_int_equal(back.elements, 2);
    assert_int_equal(back.count, 2);
    assert_int_equal(back.retries, 3);
    assert_true(back.max_time == 1.5 && back.limit == 2.65);
    assert_string_equal(back.folder, "/some where");
    for (size_t i = 0; i < 2; i++) {
      assert_string_equal(back.tasks[i].key, tasks[i].key);
      size_t w = 0;
      for (; tasks[i].words[w]; w++) assert_string_equal(back.tasks[i].words[w], tasks[i].words[w]);
      assert_null(back.tasks[i].words[w]);
    }
    cag_plan_free(&back);
  }
  assert_false(cag_plan_write(&plan, "no/where/plan.json", &err));
}

static void test_no_plans(void **state) {
  (void)state;
  static const char *const texts[] = {
      "",
      "{}",
      "[]",
      "{\"elements\":1,\"folder\":\"/\",\"tasks\":3}",
      "{\"elements\":1,\"tasks\":[]}",
      "{\"elements\":0,\"folder\":\"/\",\"tasks\":[]}",
      "{\"elements\":1,\"folder\":\"/\",\"tasks\":[3]}",
      "{\"elements\":1,\"folder\":\"/\",\"tasks\":[" TASK ",{\"key\":\"k\",\"words\":[]}]}",
      "{\"elements\":1,\"folder\":\"/\",\"tasks\":[{\"key\":\"k\",\"words\":[\"a\",3]}]}",
      "{\"elements\":1,\"folder\":\"/\",\"tasks\":[{\"key\":\"" LONG_KEY "\",\"words\":[\"a\"]}]}",
  };
  CagTool tool = {.style = CAG_STYLE_JSON};
  CagPlan plan;
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    write_text("plan.json", texts[i]);
    assert_false(cag_plan_read(&tool, &plan, "plan.json"));
  }
  assert_false(cag_plan_read(&tool, &plan, "nowhere.json"));
  write_text("plan.json", "{\"elements\":1,\"folder\":\"/\",\"tasks\":[" TASK "]}");
  assert_true(cag_plan_read(&tool, &plan, "plan.json"));
  cag_plan_free(&plan);
}

static void test_results(void **state) {
  (void)state;
  CagError err = {0};
  CagTask back = {0};
  char *path = cag_plan_result_path(folder, "plan");
  assert_non_null(path);
  CagTask task = {
      .status = 5, .seconds = 1.25, .memory = 1 << 20, .attempts = 3, .message = "a \"message\""};
  for (int k = 0; k < 2; k++) {
    assert_true(cag_plan_write_result(path, &task, &err));
    assert_true(cag_plan_read_result(path, &back));
    assert_int_equal(back.status, task.status);
    assert_true(back.seconds == 1.25);
    assert_int_equal(back.memory, task.memory);
    assert_int_equal(back.attempts, 3);
    if (task.message) assert_string_equal(back.message, task.message);
    else assert_null(back.message);
    task.message = NULL;
    task.memory = 0;
  }
  static const char *const texts[] = {"", "{\"status\":", "[]", "{\"status\":\"0\"}"};
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    write_text(path, texts[i]);
    assert_false(cag_plan_read_result(path, &back));
  }
  remove(path);
  assert_false(cag_plan_read_result(path, &back));
  failing = 1;
  made = 0;
  assert_null(cag_plan_result_path(folder, "plan"));
  failing = 0;
  free(back.message);
  free(path);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_lines),
      cmocka_unit_test(test_round_trip),
      cmocka_unit_test(test_job),
      cmocka_unit_test(test_refused),
      cmocka_unit_test(test_journal_without_memory),
      cmocka_unit_test(test_plans),
      cmocka_unit_test(test_no_plans),
      cmocka_unit_test(test_results),
  };
  return cmocka_run_group_tests(tests, begin, end);
}
