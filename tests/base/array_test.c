// Arrays and strings that grow.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/string.h"

static void an_array_keeps_its_items_as_it_grows(void **state) {
  (void)state;
  size_t *items = NULL, count = 0, capacity = 0, growths = 0;
  while (count < 100000) {
    const size_t before = capacity;
    assert_true(CAG_RESERVE(items, capacity, count + 1));
    if (capacity != before) {
      growths++;
      assert_true(capacity >= 2 * before);
    }
    items[count] = count;
    count++;
  }
  for (size_t i = 0; i < count; i++) assert_int_equal(items[i], i);
  assert_true(growths <= 17); // 16 * 2^13 > 100000
  cag_free(items);
}

static void room_for_many_items_is_made_at_once(void **state) {
  (void)state;
  double *items = NULL;
  size_t capacity = 0;
  assert_true(CAG_RESERVE(items, capacity, 0));
  assert_null(items);
  assert_true(CAG_RESERVE(items, capacity, 1000));
  assert_int_equal(capacity, 1000);
  double *same = items;
  assert_true(CAG_RESERVE(items, capacity, 1000));
  assert_ptr_equal(items, same);
  cag_free(items);
}

static void an_array_that_cannot_grow_is_as_it_was(void **state) {
  (void)state;
  CagAccount a = {.limit = 1000};
  cag_account_lend(&a);
  int *items = NULL;
  size_t capacity = 0;
  assert_true(CAG_RESERVE(items, capacity, 100));
  items[99] = 7;
  int *same = items;
  assert_false(CAG_RESERVE(items, capacity, 1000));
  assert_false(CAG_RESERVE(items, capacity, SIZE_MAX));
  assert_false(CAG_RESERVE(items, capacity, SIZE_MAX / 4));
  assert_ptr_equal(items, same);
  assert_int_equal(capacity, 100);
  assert_int_equal(items[99], 7);
  cag_free(items);
  assert_int_equal(a.used, 0);
  cag_account_lend(NULL);
}

static void arrays_that_share_a_capacity_are_resized(void **state) {
  (void)state;
  CagAccount a = {.limit = 1000};
  cag_account_lend(&a);
  int *numbers = NULL;
  double(*pairs)[2] = NULL;
  assert_true(CAG_RESIZE(numbers, 20) && CAG_RESIZE(pairs, 20));
  numbers[19] = 7;
  pairs[19][1] = 8;
  void *same = pairs;
  assert_true(CAG_RESIZE(numbers, 30));
  assert_int_equal(numbers[19], 7);
  assert_false(CAG_RESIZE(pairs, 100));
  assert_false(CAG_RESIZE(pairs, SIZE_MAX / 8));
  assert_ptr_equal(pairs, same);
  assert_true(pairs[19][1] == 8);
  cag_free(numbers);
  cag_free(pairs);
  assert_int_equal(a.used, 0);
  cag_account_lend(NULL);
}

static void a_string_takes_bytes_and_formats(void **state) {
  (void)state;
  CagString s = {0};
  cag_string_add(&s, "", 0);
  assert_string_equal(s.bytes, "");
  cag_string_add(&s, "a\0b", 3);
  cag_string_printf(&s, "%d", 12);
  assert_int_equal(s.length, 5);
  assert_memory_equal(s.bytes, "a\0b12", 6);
  char long_text[2000];
  memset(long_text, 'x', sizeof long_text);
  long_text[sizeof long_text - 1] = 0;
  cag_string_printf(&s, "%s.", long_text);
  assert_int_equal(s.length, 5 + 1999 + 1);
  assert_int_equal(s.bytes[s.length - 1], '.');
  assert_int_equal(s.bytes[s.length], 0);
  cag_string_free(&s);
  assert_null(s.bytes);
}

static void a_string_that_failed_stays_empty(void **state) {
  (void)state;
  CagAccount a = {.limit = 1000};
  cag_account_lend(&a);
  CagString s = {0};
  for (int i = 0; i < 200; i++) cag_string_add(&s, "0123456789", 10);
  assert_true(s.failed);
  assert_int_equal(s.length, 0);
  assert_string_equal(s.bytes, "");
  cag_string_add(&s, "a", 1);
  assert_string_equal(s.bytes, "");
  assert_int_equal(a.used, 0);
  cag_string_free(&s);
  cag_account_lend(NULL);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(an_array_keeps_its_items_as_it_grows),
      cmocka_unit_test(room_for_many_items_is_made_at_once),
      cmocka_unit_test(an_array_that_cannot_grow_is_as_it_was),
      cmocka_unit_test(arrays_that_share_a_capacity_are_resized),
      cmocka_unit_test(a_string_takes_bytes_and_formats),
      cmocka_unit_test(a_string_that_failed_stays_empty),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
