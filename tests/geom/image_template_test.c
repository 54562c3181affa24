// Templates, against the reference's numbers and a slow algorithm.

#include "geom/image/template.h"
#include "image_support.h"

static void maps_are_those_of_the_reference(void **state) {
  (void)state;
  static const double errors[] = {21, 27, 25, 30, 47, 0, 23, 43, 4, 27, 25, 5};
  static const double correlation[] = {0.7016464154456233, 0.6316202918382532, 0.6537204504606134,
                                       0.4828045495852676, 0.4200412794412907, 1,
                                       0.7473028425354332, 0.4694579005520308, 0.9607689228305228,
                                       0.5563486402641867, 0.7082882469748284, 0.9855206599818044};
  CagRaster *r = picture("12103/05211/41362/22015"), *t = picture("52/13"), *map;
  const CagTemplatePart part = {.pattern = t};
  CagMatch m;
  OK(cag_template_errors(r, t, &map, &err));
  assert_true(map->width == 4 && map->height == 3);
  for (int i = 0; i < 12; i++) NEAR(map->data[i], errors[i], 0);
  cag_raster_release(map);
  OK(cag_template_correlation(r, t, false, &map, &err));
  for (int i = 0; i < 12; i++) NEAR(map->data[i], correlation[i], 1e-15);
  cag_raster_release(map);
  OK(cag_template_find(r, &part, 1, &m, &err));
  assert_true(m.found && m.x == 1 && m.y == 1 && m.error == 0 && m.counted == 4);
  cag_raster_release(r);
  cag_raster_release(t);
}

static void only_the_zero_mean_form_ignores_an_offset(void **state) {
  (void)state;
  CagRaster *t = picture("52/13"), *r = picture("52/13"), *map;
  for (int i = 0; i < 4; i++) r->data[i] = 3 * r->data[i] + 10;
  OK(cag_template_correlation(r, t, false, &map, &err));
  NEAR(map->data[0], 0.9676761712473896, 1e-15);
  cag_raster_release(map);
  OK(cag_template_correlation(r, t, true, &map, &err));
  NEAR(map->data[0], 1, 1e-15);
  cag_raster_release(map);
  // A window of one gray value has no correlation.
  for (int i = 0; i < 4; i++) r->data[i] = 0.1;
  OK(cag_template_correlation(r, t, true, &map, &err));
  NEAR(map->data[0], 0, 0);
  cag_raster_release(map);
  cag_raster_release(r);
  cag_raster_release(t);
}

static void pixels_without_a_value_do_not_count(void **state) {
  (void)state;
  CagRaster *r = picture("0012-120"), *t = picture("1-"), *two = picture("12"), *map;
  CagMatch m;
  const CagTemplatePart part = {.pattern = two};
  OK(cag_template_errors(r, t, &map, &err));
  NEAR(map->data[0], 1, 0);
  NEAR(map->data[3], 1, 0); // the image has no value under the ignored pixel
  assert_true(isnan(map->data[4]));
  cag_raster_release(map);
  OK(cag_template_find(r, &part, 1, &m, &err));
  assert_true(m.found && m.x == 2 && m.error == 0);
  for (int i = 0; i < 8; i++) r->data[i] = NAN;
  OK(cag_template_find(r, &part, 1, &m, &err));
  assert_false(m.found);
  cag_raster_release(r);
  cag_raster_release(t);
  cag_raster_release(two);
}

// The first minimum of the map in raster order.
static void the_best_shift_is_the_least_of_the_map(void **state) {
  (void)state;
  seed = 6;
  for (int round = 0; round < 100; round++) {
    CagRaster *r = random_picture(6 + (size_t)uniform(0, 20), 6 + (size_t)uniform(0, 20), 2, 0.3);
    CagRaster *t = random_picture(1 + (size_t)uniform(0, 5), 1 + (size_t)uniform(0, 5), 2, 0.3);
    CagRaster *map;
    CagMatch m;
    const CagTemplatePart part = {.pattern = t};
    size_t best = 0;
    OK(cag_template_errors(r, t, &map, &err));
    OK(cag_template_find(r, &part, 1, &m, &err));
    for (size_t i = 1; i < map->width * map->height; i++)
      if (map->data[i] < map->data[best]) best = i;
    assert_int_equal(m.x, best % map->width);
    assert_int_equal(m.y, best / map->width);
    NEAR(m.error, map->data[best], 0);
    cag_raster_release(map);
    cag_raster_release(t);
    cag_raster_release(r);
  }
}

static void parts_lie_at_their_offsets(void **state) {
  (void)state;
  CagRaster *r = picture("00000000/00110000/00110000/00000000/00111100/00000000/00000000");
  CagRaster *square = picture("11/11"), *bar = picture("1111");
  CagTemplatePart parts[2] = {{square, 0, 0}, {bar, 0, 3}};
  CagMatch m;
  OK(cag_template_find(r, parts, 2, &m, &err));
  assert_true(m.found && m.x == 2 && m.y == 1 && m.error == 0 && m.counted == 8);
  // The same with the bar as the origin.
  parts[0].dy = -3;
  parts[1].dy = 0;
  OK(cag_template_find(r, parts, 2, &m, &err));
  assert_true(m.x == 2 && m.y == 4 && m.error == 0);
  parts[0].dy = -7;
  FAILS(cag_template_find(r, parts, 2, &m, &err), "template-larger-than-image");
  cag_raster_release(r);
  cag_raster_release(square);
  cag_raster_release(bar);
}

static void quarter_turns_are_exact(void **state) {
  (void)state;
  static const char *const expected[] = {"123/456", "36/25/14", "654/321", "41/52/63"};
  CagRaster *t = picture("123/456"), *turned, *same;
  for (int k = -4; k <= 8; k++) {
    same = picture(expected[(k + 8) % 4]);
    OK(cag_template_turned(t, 90 * k, 1, &turned, &err));
    assert_true(turned->width == same->width && turned->height == same->height);
    assert_memory_equal(turned->data, same->data, 6 * sizeof(double));
    cag_raster_release(turned);
    cag_raster_release(same);
  }
  cag_raster_release(t);
}

// A plane slope stays one, except next to the border.
static void other_turns_interpolate(void **state) {
  (void)state;
  const double angle = 30 * M_PI / 180, scale = 1.5;
  CagRaster *t, *turned;
  size_t inside = 0;
  OK(cag_raster_new(20, 10, 1, &t, &err));
  for (size_t i = 0; i < 200; i++) t->data[i] = (double)(i % 20) + 0.5 - 10; // x from the center
  OK(cag_template_turned(t, 30, scale, &turned, &err));
  assert_int_equal(turned->width, ceil(scale * (20 * cos(angle) + 10 * sin(angle))));
  assert_int_equal(turned->height, ceil(scale * (20 * sin(angle) + 10 * cos(angle))));
  for (size_t y = 0; y < turned->height; y++)
    for (size_t x = 0; x < turned->width; x++) {
      const double dx = (double)x + 0.5 - (double)turned->width / 2;
      const double dy = (double)turned->height / 2 - (double)y - 0.5;
      const double u = (cos(angle) * dx + sin(angle) * dy) / scale;
      const double v = (-sin(angle) * dx + cos(angle) * dy) / scale;
      const double found = *cag_raster_at(turned, 0, x, y);
      assert_int_equal(isnan(found), fabs(u) > 10 || fabs(v) > 5);
      if (!isnan(found)) inside++;
      if (fabs(u) < 9.5 && fabs(v) <= 5) NEAR(found, u, 1e-12);
    }
  NEAR((double)inside, 200 * scale * scale, 40);
  cag_raster_release(turned);
  cag_raster_release(t);
}

static void templates_fit_the_image(void **state) {
  (void)state;
  CagRaster *r = picture("12"), *tall = picture("1/2"), *two, *map;
  OK(cag_raster_new(1, 1, 2, &two, &err));
  FAILS(cag_template_errors(r, tall, &map, &err), "template-larger-than-image");
  FAILS(cag_template_correlation(r, tall, true, &map, &err), "template-larger-than-image");
  FAILS(cag_template_errors(r, two, &map, &err), "several-channels");
  cag_raster_release(r);
  cag_raster_release(tall);
  cag_raster_release(two);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(maps_are_those_of_the_reference),
      cmocka_unit_test(only_the_zero_mean_form_ignores_an_offset),
      cmocka_unit_test(pixels_without_a_value_do_not_count),
      cmocka_unit_test(the_best_shift_is_the_least_of_the_map),
      cmocka_unit_test(parts_lie_at_their_offsets),
      cmocka_unit_test(quarter_turns_are_exact),
      cmocka_unit_test(other_turns_interpolate),
      cmocka_unit_test(templates_fit_the_image),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
