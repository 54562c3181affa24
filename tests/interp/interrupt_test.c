// An interrupt ends any operation. Values with common parts take practically forever to traverse,
// so they test all code that traverses values.

#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "cag.h"

// The processor time, in seconds, that may pass after an interrupt.
#define SECONDS_MOST 0.1

// Lists, shapes, and records of 2^60 parts, and groups of 2^40, each of which contains the previous
// one twice.
static const char shared[] = "f(n, t) = if n == 0 then t else f(n - 1, [t, t])\n"
                             "g(n, t) = if n == 0 then t else g(n - 1, { x: t, y: t })\n"
                             "h(n, t) = if n == 0 then t else h(n - 1, group(t, t))\n"
                             "a = f(60, 1)\ns = f(60, box(1))\nr = g(60, 1)\n";

static const char *const endless[] = {
    "print a",
    "print \"{a}\"",
    "print r",
    "print s",
    "print a == f(60, 1)",
    "print r != g(60, 1)",
    "print a in [f(60, 1)]",
    "print index_of([a], f(60, 1))",
    "print near(a, f(60, 1))",
    "print -a",
    "print 2 * a",
    "print a + a",
    "print text(a), json(a)",
    "print flatten(a)",
    "print round(a)",
    "print map(a, x => x == f(59, 1))",
    "assert a == f(60, 1)",
    "show s",
    "print bounds(s)",
    "print volume(union(s))",
    "print hull(s)",
    "print translate(s, Z)",
    "print translate(Z) * s",
    "print color(s, \"red\")",
    "print group(s)",
    "print tessellate(h(40, box(1)))",
    "print bounds(h(60, box(1)))",
    "print translate(h(60, box(1)), Z)",
    "show h(40, box(1))",
};
#define COUNT (sizeof endless / sizeof *endless)

// Messages show only the beginning of a value, so they do not need an interrupt.
static const char *const wrong[] = {"print sin(a)",   "print box(a)", "print a.x",
                                    "print a(1)",     "print [a][a]", "print polygon(a)",
                                    "print sphere(r)"};

static volatile int interrupt;

static void *interrupt_soon(void *context) {
  clock_t *at = context;
  const struct timespec wait = {0, 50 * 1000 * 1000};
  nanosleep(&wait, NULL);
  *at = clock();
  interrupt = 1;
  return NULL;
}

static CagSession *new_session(FILE **out) {
  CagSessionOptions options;
  cag_session_options_init(&options);
  options.out = *out = fopen("/dev/null", "w");
  options.interrupt = &interrupt;
  return cag_session_new(&options);
}

static int run(const char *statement) {
  char script[1024];
  FILE *out;
  snprintf(script, sizeof script, "%s%s\n", shared, statement);
  CagSession *s = new_session(&out);
  assert_non_null(s);
  CagShownCounts counts;
  int status = cag_session_run_text(s, "test", script, strlen(script));
  if (status == CAG_STATUS_OK) status = cag_session_scene(s, &counts);
  cag_session_free(s);
  fclose(out);
  return status;
}

static void an_interrupt_ends_what_walks_shared_values(void **state) {
  (void)state;
  size_t bad = 0;
  for (size_t i = 0; i < COUNT; i++) {
    pthread_t thread;
    clock_t at = 0;
    interrupt = 0;
    assert_int_equal(pthread_create(&thread, NULL, interrupt_soon, &at), 0);
    const int status = run(endless[i]);
    const clock_t end = clock();
    pthread_join(thread, NULL);
    bad += status != CAG_STATUS_INTERRUPTED;
    if (status != CAG_STATUS_INTERRUPTED) print_error("%s: status %d\n", endless[i], status);
    const double seconds = (double)(end - at) / CLOCKS_PER_SEC;
    bad += seconds > SECONDS_MOST;
    if (seconds > SECONDS_MOST) print_error("%s: went on for %g s\n", endless[i], seconds);
  }
  assert_int_equal(bad, 0);
}

static void messages_show_the_beginning_of_a_value(void **state) {
  (void)state;
  interrupt = 0;
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
    if (run(wrong[i]) != CAG_STATUS_SCRIPT) fail_msg("%s", wrong[i]);
}

static void count_value(void *context, const char *text, const char *type) {
  (void)text, (void)type;
  ++*(int *)context;
}

// The printed text of a value before the interrupt has millions of characters, and is not returned.
static void an_interrupted_value_is_not_given(void **state) {
  (void)state;
  FILE *out;
  CagSession *s = new_session(&out);
  assert_non_null(s);
  assert_int_equal(cag_session_input(s, shared, strlen(shared), NULL, NULL), CAG_STATUS_OK);
  pthread_t thread;
  clock_t at;
  int given = 0;
  interrupt = 0;
  assert_int_equal(pthread_create(&thread, NULL, interrupt_soon, &at), 0);
  assert_int_equal(cag_session_input(s, "1; a; 2", 7, count_value, &given), CAG_STATUS_INTERRUPTED);
  pthread_join(thread, NULL);
  interrupt = 0;
  assert_int_equal(given, 1);
  assert_int_equal(cag_session_input(s, "1; 2", 4, count_value, &given), CAG_STATUS_OK);
  assert_int_equal(given, 3);
  cag_session_free(s);
  fclose(out);
}

// A session continues after an interrupt, with correct values.
static void a_session_goes_on_after_an_interrupt(void **state) {
  (void)state;
  FILE *out;
  CagSession *s = new_session(&out);
  assert_non_null(s);
  assert_int_equal(cag_session_input(s, shared, strlen(shared), NULL, NULL), CAG_STATUS_OK);
  pthread_t thread;
  clock_t at;
  interrupt = 0;
  assert_int_equal(pthread_create(&thread, NULL, interrupt_soon, &at), 0);
  assert_int_equal(cag_session_input(s, "a == f(60, 1)", 13, NULL, NULL), CAG_STATUS_INTERRUPTED);
  pthread_join(thread, NULL);
  interrupt = 0;
  const char *check = "assert f(3, 1) == [[[1, 1], [1, 1]], [[1, 1], [1, 1]]] and len(a) == 2";
  assert_int_equal(cag_session_input(s, check, strlen(check), NULL, NULL), CAG_STATUS_OK);
  cag_session_free(s);
  fclose(out);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(an_interrupt_ends_what_walks_shared_values),
      cmocka_unit_test(messages_show_the_beginning_of_a_value),
      cmocka_unit_test(an_interrupted_value_is_not_given),
      cmocka_unit_test(a_session_goes_on_after_an_interrupt),
  };
  return cmocka_run_group_tests_name("interrupt", tests, NULL, NULL);
}
