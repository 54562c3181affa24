// Memory accounts: charges, credits, and the limit.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <errno.h>
#include <malloc.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

static uint32_t seed = 1;
static size_t chance(size_t n) {
  seed = seed * 1664525 + 1013904223;
  return (seed >> 8) % n;
}

// The account equals the malloc sizes of all live blocks, after any operations.
static void an_account_holds_the_usable_sizes_of_its_blocks(void **state) {
  (void)state;
  enum { N = 100 };
  CagAccount a = {.limit = (size_t)1 << 30};
  char *blocks[N] = {NULL};
  cag_account_lend(&a);
  for (int step = 0; step < 5000; step++) {
    const size_t i = chance(N), size = 1 + chance(chance(10) ? 300 : 300000);
    switch (chance(5)) {
    case 0:
      cag_free(blocks[i]);
      blocks[i] = cag_malloc(size);
      break;
    case 1:
      cag_free(blocks[i]);
      blocks[i] = cag_calloc(size, 3);
      for (size_t k = 0; k < 3 * size; k++) assert_int_equal(blocks[i][k], 0);
      break;
    case 2: {
      const size_t old = blocks[i] ? malloc_usable_size(blocks[i]) : 0;
      if (old) memset(blocks[i], (int)i, old);
      blocks[i] = cag_realloc(blocks[i], size);
      for (size_t k = 0; k < size && k < old; k++) assert_int_equal(blocks[i][k], (char)i);
      break;
    }
    case 3:
      cag_free(blocks[i]);
      blocks[i] = cag_strndup("a name", chance(10));
      break;
    default: cag_free(blocks[i]); blocks[i] = NULL;
    }
    size_t sum = 0;
    for (int k = 0; k < N; k++) sum += blocks[k] ? malloc_usable_size(blocks[k]) : 0;
    assert_int_equal(a.used, sum);
  }
  for (int k = 0; k < N; k++) cag_free(blocks[k]);
  assert_int_equal(a.used, 0);
  cag_account_lend(NULL);
}

static void what_exceeds_the_limit_is_refused_like_exhausted_memory(void **state) {
  (void)state;
  CagAccount a = {.limit = 1000000};
  cag_account_lend(&a);
  errno = 0;
  assert_null(cag_malloc(1000001));
  assert_int_equal(errno, ENOMEM);
  assert_null(cag_calloc(1000001, 1));
  assert_null(cag_calloc(SIZE_MAX / 2, 4));
  assert_null(cag_realloc(NULL, 1000001));
  assert_int_equal(a.used, 0);
  char *block = cag_malloc(600000);
  assert_non_null(block);
  memset(block, 7, 600000);
  assert_null(cag_malloc(400000 + 100));
  // The old block is kept if there is no memory for the larger one.
  assert_null(cag_realloc(block, 1000100));
  assert_int_equal(block[599999], 7);
  char *text;
  assert_int_equal(cag_asprintf(&text, "%500000d", 1), -1);
  block = cag_realloc(block, 900000);
  assert_non_null(block);
  block = cag_realloc(block, 10);
  assert_true(a.used < 1000);
  cag_free(block);
  assert_int_equal(a.used, 0);
  cag_account_lend(NULL);
}

static void bytes_of_others_are_held_and_dropped(void **state) {
  (void)state;
  CagAccount a = {.limit = 1000};
  assert_true(cag_account_hold(SIZE_MAX));
  cag_account_drop(SIZE_MAX);
  assert_true(cag_account_room() > SIZE_MAX / 4);
  assert_null(cag_account_lend(&a));
  assert_true(cag_account_hold(700));
  assert_int_equal(cag_account_room(), 300);
  assert_true(cag_account_has_room(300));
  assert_false(cag_account_has_room(301));
  assert_false(cag_account_has_room(SIZE_MAX));
  assert_false(cag_account_hold(301));
  assert_true(cag_account_hold(300));
  cag_account_drop(1000);
  assert_int_equal(a.used, 0);
  assert_ptr_equal(cag_account_lend(NULL), &a);
}

static void blocks_can_come_from_the_system_and_go_to_it(void **state) {
  (void)state;
  CagAccount a = {.limit = 1000};
  cag_account_lend(&a);
  // Adopted blocks may exceed the limit.
  char *system = malloc(5000);
  cag_adopt(system);
  assert_true(a.used >= 5000);
  assert_null(cag_malloc(1));
  assert_int_equal(cag_account_room(), 0);
  cag_free(system);
  assert_int_equal(a.used, 0);
  char *text = cag_strdup("for the host");
  assert_true(a.used > 0);
  cag_disown(text);
  assert_int_equal(a.used, 0);
  cag_account_lend(NULL);
  free(text);
}

static void texts_are_as_the_system_makes_them(void **state) {
  (void)state;
  char *text = cag_strndup("names", 3), *number, *path;
  assert_string_equal(text, "nam");
  assert_int_equal(cag_asprintf(&number, "%d %s", 12, "mm"), 5);
  assert_string_equal(number, "12 mm");
  path = cag_realpath("/usr/../usr/");
  assert_string_equal(path, "/usr");
  assert_null(cag_realpath("/no/such/path"));
  cag_free(text);
  cag_free(number);
  cag_free(path);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(an_account_holds_the_usable_sizes_of_its_blocks),
      cmocka_unit_test(what_exceeds_the_limit_is_refused_like_exhausted_memory),
      cmocka_unit_test(bytes_of_others_are_held_and_dropped),
      cmocka_unit_test(blocks_can_come_from_the_system_and_go_to_it),
      cmocka_unit_test(texts_are_as_the_system_makes_them),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
