// Default tolerances of items. Expected numbers follow from the sizes by hand.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "interp/scene/fineness.h"

// An item whose bounds are a cube around a point; its diagonal is 1.732 sides.
static CagItem cube_at(CagVec3 p, double side) {
  const CagVec3 half = cag_vec3(side / 2, side / 2, side / 2);
  return (CagItem){
      .kind = CAG_ITEM_MESH, .bounds = {cag_sub(p, half), cag_add(p, half)}, .measured = true};
}

// A camera at the origin that looks along Y. A pixel at the distance 1000 is 1 mm wide.
static CagCamera perspective(void) {
  return (CagCamera){.eye = {0, 0, 0},
                     .target = {0, 1, 0},
                     .up = {0, 0, 1},
                     .fov = 2 * atan(0.5),
                     .size = {1000, 500}};
}

static double in_picture(const CagCamera *c, CagVec3 at, double side) {
  const CagScene s = {.usual_tolerance = 8, .picture = c};
  const CagItem item = cube_at(at, side);
  return cag_item_tolerance(&s, &item);
}

static void the_default_is_a_power_of_two_below_a_thousandth_of_the_size(void **state) {
  (void)state;
  const double sizes[][2] = {{999, 0.5}, {1001, 1}, {1999, 1}, {2001, 2}, {0.7, 0.00048828125}};
  for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
    const CagBounds b = {{5, 0, 0}, {5 + sizes[i][0], 0, 0}};
    assert_true(cag_usual_tolerance(&b) == sizes[i][1]);
  }
  const CagBounds empty = CAG_BOUNDS_EMPTY, point = {{1, 2, 3}, {1, 2, 3}};
  assert_true(cag_usual_tolerance(&empty) == 0);
  assert_true(cag_usual_tolerance(&point) == 0);
}

static void small_items_are_finer_and_keep_their_form(void **state) {
  (void)state;
  const CagScene s = {.usual_tolerance = 1};
  const CagItem large = cube_at(cag_vec3(0, 0, 0), 100), small = cube_at(cag_vec3(0, 0, 0), 1);
  assert_true(cag_item_tolerance(&s, &large) == 1);
  assert_true(fabs(cag_item_tolerance(&s, &small) - sqrt(3) / 32) < 1e-12);
}

static void what_was_asked_for_counts_first(void **state) {
  (void)state;
  CagTolerances used = {0};
  CagScene s = {.usual_tolerance = 1, .tolerance = 0.3, .used = &used};
  CagItem item = cube_at(cag_vec3(0, 0, 0), 100);
  assert_true(cag_item_tolerance(&s, &item) == 0.3);
  item.tolerance = 0.7;
  assert_true(cag_item_tolerance(&s, &item) == 0.7);
  item.tolerance = 5;
  assert_true(cag_item_tolerance(&s, &item) == 5);
  assert_true(used.of[CAG_TOLERANCE_OF_ITEM].least == 0.7);
  assert_true(used.of[CAG_TOLERANCE_OF_ITEM].most == 5);
  assert_true(used.of[CAG_TOLERANCE_OF_SCENE].most == 0.3);
  assert_true(used.of[CAG_TOLERANCE_OF_SIZE].most == 0);
}

static void a_picture_has_a_quarter_of_a_pixel(void **state) {
  (void)state;
  CagCamera c = perspective();
  // The nearest faces are at the distances 1010, 2100, and 510: 0.2525, 0.525, and 0.1275 mm.
  assert_true(in_picture(&c, cag_vec3(0, 1060, 0), 100) == 0.25);
  assert_true(in_picture(&c, cag_vec3(0, 2150, 0), 100) == 0.5);
  assert_true(in_picture(&c, cag_vec3(0, 560, 0), 100) == 0.125);
  assert_true(in_picture(&c, cag_vec3(0, -560, 0), 100) == 0.125); // behind, in a mirror
  c.size[0] = 4000;
  c.size[1] = 2000;
  assert_true(in_picture(&c, cag_vec3(0, 1060, 0), 100) == 0.0625);
  c.orthographic = true;
  c.width = 1000;
  assert_true(in_picture(&c, cag_vec3(0, 9000, 0), 100) == 0.0625);
}

static void parts_around_the_eye_are_bounded(void **state) {
  (void)state;
  const CagCamera c = perspective();
  // A quarter of the diagonal, 433 mm, has pixels of 0.433 mm.
  assert_true(in_picture(&c, cag_vec3(0, 0, 0), 1000) == 0.0625);
  // A detail of a huge part: not below 1e-5 of its diagonal, 17.3 mm.
  assert_true(in_picture(&c, cag_vec3(0, 500001, 0), 1000000) == 16);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_default_is_a_power_of_two_below_a_thousandth_of_the_size),
      cmocka_unit_test(small_items_are_finer_and_keep_their_form),
      cmocka_unit_test(what_was_asked_for_counts_first),
      cmocka_unit_test(a_picture_has_a_quarter_of_a_pixel),
      cmocka_unit_test(parts_around_the_eye_are_bounded),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
