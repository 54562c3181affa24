// Hashes, and the index of numbered items.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "base/hash.h"

// Test vectors of Fowler, Noll and Vo for FNV-1a with 64 bits.
static void texts_have_the_published_hashes(void **state) {
  (void)state;
  assert_true(cag_hash_text(CAG_HASH_START, "") == UINT64_C(0xcbf29ce484222325));
  assert_true(cag_hash_text(CAG_HASH_START, "a") == UINT64_C(0xaf63dc4c8601ec8c));
  assert_true(cag_hash_text(CAG_HASH_START, "foobar") == UINT64_C(0x85944171f73967e8));
  assert_true(cag_hash_bytes(CAG_HASH_START, "foobarbaz", 6) == UINT64_C(0x85944171f73967e8));
}

static void equal_numbers_have_one_hash(void **state) {
  (void)state;
  assert_true(cag_hash_number(CAG_HASH_START, 0.0) == cag_hash_number(CAG_HASH_START, -0.0));
  assert_true(cag_hash_number(CAG_HASH_START, 1.0) != cag_hash_number(CAG_HASH_START, 2.0));
  assert_true(cag_hash_word(cag_hash_word(CAG_HASH_START, 1), 2) !=
              cag_hash_word(cag_hash_word(CAG_HASH_START, 2), 1));
}

static void an_empty_index_has_no_numbers(void **state) {
  (void)state;
  CagHashIndex x = {0};
  size_t number;
  CagHashWalk w = cag_hash_walk(&x, 1);
  assert_false(cag_hash_next(&w, &number));
  cag_hash_free(&x);
}

static void numbers_are_found_by_their_hash(void **state) {
  (void)state;
  CagHashIndex x = {0};
  size_t number;
  char name[32];
  const size_t count = 20000;
  for (size_t i = 0; i < count; i++) {
    snprintf(name, sizeof name, "part.%zu", i);
    assert_true(cag_hash_add(&x, cag_hash_text(CAG_HASH_START, name), i));
  }
  assert_int_equal(x.count, count);
  for (size_t i = 0; i < count; i++) {
    snprintf(name, sizeof name, "part.%zu", i);
    CagHashWalk w = cag_hash_walk(&x, cag_hash_text(CAG_HASH_START, name));
    assert_true(cag_hash_next(&w, &number));
    assert_int_equal(number, i);
    assert_false(cag_hash_next(&w, &number));
  }
  CagHashWalk w = cag_hash_walk(&x, cag_hash_text(CAG_HASH_START, "part"));
  assert_false(cag_hash_next(&w, &number));
  cag_hash_free(&x);
}

// Also after the index grows, and with other hashes between and around its end.
static void numbers_of_one_hash_come_in_their_order(void **state) {
  (void)state;
  for (uint64_t hash = 0; hash < 64; hash++) {
    CagHashIndex x = {0};
    for (size_t i = 0; i < 100; i++) assert_true(cag_hash_add(&x, i % 2 ? hash : hash + 1, i));
    size_t number;
    CagHashWalk w = cag_hash_walk(&x, hash);
    for (size_t i = 1; i < 100; i += 2) {
      assert_true(cag_hash_next(&w, &number));
      assert_int_equal(number, i);
    }
    assert_false(cag_hash_next(&w, &number));
    cag_hash_free(&x);
  }
}

static void room_is_made_before(void **state) {
  (void)state;
  CagHashIndex x = {0};
  assert_true(cag_hash_reserve(&x, 1000));
  const CagHashSlot *slots = x.slots;
  for (size_t i = 0; i < 1000; i++) assert_true(cag_hash_add(&x, i, i));
  assert_ptr_equal(x.slots, slots);
  assert_false(cag_hash_reserve(&x, SIZE_MAX / 2));
  assert_int_equal(x.count, 1000);
  cag_hash_free(&x);
  assert_int_equal(x.count, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(texts_have_the_published_hashes),
      cmocka_unit_test(equal_numbers_have_one_hash),
      cmocka_unit_test(an_empty_index_has_no_numbers),
      cmocka_unit_test(numbers_are_found_by_their_hash),
      cmocka_unit_test(numbers_of_one_hash_come_in_their_order),
      cmocka_unit_test(room_is_made_before),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
