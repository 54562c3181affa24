// The garbage collector: the objects that it keeps and frees, and the memory that it charges.

#include "tests/interp/vm_support.h"

static CagValue string_value(CagVm *vm, size_t length) {
  char *bytes = malloc(length + 1);
  memset(bytes, 'x', length);
  const CagValue v = cag_text_new(vm, bytes, length);
  free(bytes);
  return v;
}

// The number of live objects after a collection with `v`, or nothing, as the root.
static size_t live(CagVm *vm, const CagValue *v) {
  if (v) cag_root_push(vm, *v);
  cag_collect(vm);
  if (v) cag_root_pop(vm, 1);
  return vm->heap.objects;
}

// Cells of small objects are allocated from pages. Larger objects and buffers have separate blocks.
// All of them are charged.
static void what_objects_hold_is_charged(void **state) {
  CagVm *vm = *state;
  const size_t nothing = live(vm, NULL);
  for (size_t n = 0; n < 30000; n += 1 + n / 5) {
    double *numbers;
    const size_t before = vm->account.used, debt = vm->heap.debt;
    const CagValue values[] = {string_value(vm, n), cag_list_numbers(vm, n, &numbers),
                               cag_list_vectors(vm, n, 3, &numbers),
                               cag_list_vectors(vm, n, 17, &numbers)};
    // Blocks larger than a cell are charged at their size, in the allocator's steps.
    if (n > CAG_SMALL_MAX) {
      const size_t least = n + 8 * n + 24 * n + 16 * n;
      assert_in_range(vm->account.used - before, least, least + 4 * 4096 + 8 * 65536);
      // The next object adds the previous buffer to the debt.
      assert_in_range(vm->heap.debt - debt, least - 16 * n, least + 4 * 4096 + 8 * 65536);
    }
    assert_int_equal(vm->heap.objects, nothing + 4);
    for (int i = 0; i < 4; i++) cag_root_push(vm, values[i]);
    for (size_t i = 4; i > 0; i--) {
      assert_int_equal(live(vm, NULL), nothing + i);
      cag_root_pop(vm, 1);
    }
    assert_int_equal(live(vm, NULL), nothing);
    assert_int_equal(vm->heap.debt, 0);
  }
}

// Free cells are reused, and returned to the system if memory is short.
static void empty_pages_go_back_where_memory_is_short(void **state) {
  (void)state;
  for (int is_short = 0; is_short < 2; is_short++) {
    CagVm *vm = new_vm((size_t)(is_short ? 40 : 4000) << 20);
    live(vm, NULL);
    const size_t before = vm->account.used;
    size_t first = 0;
    for (int round = 0; round < 5; round++) {
      for (int i = 0; i < 100000; i++) string_value(vm, 100);
      const size_t used = vm->account.used - before;
      if (round == 0) first = used;
      assert_in_range(used, 100000 * 100, 100000 * 160 + 65536);
      assert_in_range(used, first - 65536, first + 65536);
      live(vm, NULL);
      if (is_short) assert_in_range(vm->account.used, before - 65536, before + 4 * 65536);
    }
    cag_account_lend(NULL);
    cag_vm_free(vm);
  }
}

// Random graphs of lists, records, and texts: objects reachable from a root are not changed, and
// all others are freed.
static void what_is_reached_stays_as_it_is(void **state) {
  CagVm *vm = *state;
  static const char *const fields[] = {"alpha", "beta"};
  cag_record_new(vm, fields, (CagValue[]){cag_none(), cag_none()}, 2);
  const size_t nothing = live(vm, NULL);
  for (int round = 0; round < 30; round++) {
    CagValue nodes[200];
    char texts[200][512];
    const size_t count = 50 + chance(150);
    for (size_t i = 0; i < count; i++) {
      CagValue parts[40];
      const size_t n = chance(i % 10 ? 4 : 40);
      for (size_t k = 0; k < n; k++)
        parts[k] = i && chance(3) ? nodes[chance((uint32_t)i)] : cag_text_c(vm, "leaf");
      const uint32_t form = chance(4);
      if (form == 0 && n >= 2) nodes[i] = cag_record_new(vm, fields, parts, 2);
      else if (form == 1) nodes[i] = random_vector(vm, n < 20 ? n : 20);
      else if (form == 2) nodes[i] = built(vm, parts, n);
      else nodes[i] = cag_list_slice(vm, cag_list_values(vm, parts, n), n / 4, n / 2);
      CagString s = {.most = 400};
      cag_print_value(vm, &s, nodes[i], true);
      snprintf(texts[i], sizeof texts[i], "%.500s", s.bytes);
      cag_string_free(&s);
    }
    size_t kept[8];
    for (size_t k = 0; k < 8; k++) {
      kept[k] = chance((uint32_t)count);
      cag_root_push(vm, nodes[kept[k]]);
    }
    for (int pass = 0; pass < 3; pass++) {
      cag_collect(vm);
      for (int i = 0; i < 3000; i++) string_value(vm, chance(200)); // overwrites freed memory
    }
    for (size_t k = 0; k < 8; k++) {
      CagString s = {.most = 400};
      cag_print_value(vm, &s, nodes[kept[k]], true);
      char text[512];
      snprintf(text, sizeof text, "%.500s", s.bytes);
      assert_string_equal(text, texts[kept[k]]);
      cag_string_free(&s);
    }
    cag_root_pop(vm, 8);
    assert_int_equal(live(vm, NULL), nothing);
  }
}

// A slice of a list keeps the whole list alive, and a builder keeps its elements alive.
static void parts_and_builders_keep_what_they_need(void **state) {
  CagVm *vm = *state;
  const size_t nothing = live(vm, NULL);
  double *numbers;
  const CagValue whole = cag_list_numbers(vm, 5000, &numbers);
  for (int i = 0; i < 5000; i++) numbers[i] = i;
  const CagValue part = cag_list_slice(vm, whole, 100, 1000);
  const CagValue inner = cag_list_slice(vm, part, 10, 500);
  assert_ptr_equal(CAG_AS_LIST(inner)->owner, CAG_AS_LIST(whole));
  // The list and its view.
  assert_int_equal(live(vm, &inner) - nothing, 2);
  for (int i = 0; i < 500; i++) assert_true(CAG_AS_LIST(inner)->as.numbers[i] == 110 + i);
  // Slices of up to 256 bytes are copies, so the whole list is freed.
  const CagValue copy = cag_list_slice(vm, whole, 7, 32), view = cag_list_slice(vm, whole, 7, 33);
  assert_null(CAG_AS_LIST(copy)->owner);
  assert_non_null(CAG_AS_LIST(view)->owner);
  CagBuilder *b = cag_builder_new(vm);
  for (int i = 0; i < 100; i++) {
    cag_builder_add(vm, b, cag_text_c(vm, "kept"));
    cag_root_push(vm, cag_builder_value(b));
    cag_collect(vm);
    for (int k = 0; k < 50; k++) string_value(vm, 4);
    cag_root_pop(vm, 1);
  }
  const CagValue list = cag_builder_finish(vm, b);
  for (size_t i = 0; i < 100; i++)
    assert_string_equal(CAG_AS_TEXT(CAG_AS_LIST(list)->as.items[i])->bytes, "kept");
  assert_int_equal(live(vm, NULL), nothing);
}

// Geometry that calls the script holds values that no root reaches. Objects older than the call
// must survive.
static void what_is_older_than_a_call_stays(void **state) {
  CagVm *vm = *state;
  const size_t nothing = live(vm, NULL);
  string_value(vm, 1000);
  const size_t outer = vm->heap.objects;
  vm->heap.depth = 1;
  string_value(vm, 1000);
  string_value(vm, 10);
  assert_int_equal(live(vm, NULL), outer);
  assert_int_equal(live(vm, NULL), outer);
  string_value(vm, 1000);
  const size_t both = vm->heap.objects;
  vm->heap.depth = 2;
  string_value(vm, 1000);
  assert_int_equal(live(vm, NULL), both);
  vm->heap.depth = 1;
  assert_int_equal(live(vm, NULL), outer);
  vm->heap.depth = 0;
  assert_int_equal(live(vm, NULL), nothing);
}

// The next collection is due after as much allocation as the last one had to mark, but at most half
// of the remaining memory. Numbers do not need marking.
static void collections_are_due_by_what_is_live(void **state) {
  (void)state;
  static const size_t mebibyte = (size_t)1 << 20;
  CagVm *vm = new_vm(100 * mebibyte);
  double *numbers;
  for (size_t live_mebibytes = 1; live_mebibytes < 95; live_mebibytes += 8) {
    const size_t bytes = live_mebibytes * mebibyte;
    for (int values = 0; values < 2; values++) {
      // A list of empty vectors is a list of values.
      const CagValue list = values ? cag_list_vectors(vm, bytes / sizeof(CagValue), 0, &numbers)
                                   : cag_list_numbers(vm, bytes / 8, &numbers);
      live(vm, &list);
      const size_t half = (100 * mebibyte - vm->account.used) / 2;
      const size_t wanted = values && bytes > 16 * mebibyte ? bytes : 16 * mebibyte;
      const size_t least = wanted < half ? wanted : half;
      assert_in_range(vm->heap.threshold, least, least + mebibyte);
      live(vm, NULL);
    }
  }
  cag_account_lend(NULL);
  cag_vm_free(vm);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_objects_hold_is_charged),
      cmocka_unit_test(empty_pages_go_back_where_memory_is_short),
      cmocka_unit_test(what_is_reached_stays_as_it_is),
      cmocka_unit_test(parts_and_builders_keep_what_they_need),
      cmocka_unit_test(what_is_older_than_a_call_stays),
      cmocka_unit_test(collections_are_due_by_what_is_live),
  };
  return cmocka_run_group_tests_name("collector", tests, open_vm, close_vm);
}
