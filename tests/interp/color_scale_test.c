// Colors of values: sRGB and the published color scales.

#include "interp/scene/color_scale.h"
#include "scene_checks.h"

// --- Colors ---

static void srgb_is_that_of_its_definition(void **state) {
  (void)state;
  assert_true(cag_linear_to_srgb(0.0031308) == 12.92 * 0.0031308);
  assert_true(cag_srgb_to_linear(0.04045) == 0.04045 / 12.92);
  for (int k = 0; k <= 1000; k++) {
    const double c = k / 1000.0;
    const double s = c < 0.0031308 ? 12.92 * c : 1.055 * exp(log(c) / 2.4) - 0.055;
    is_near(cag_linear_to_srgb(c), s, 1e-12, "to sRGB");
    is_near(cag_srgb_to_linear(cag_linear_to_srgb(c)), c, 1e-7, "and back");
  }
  CagColor c;
  assert_true(cag_color_from_text("#4080c0", &c));
  is_near(c.r, cag_srgb_to_linear(0x40 / 255.0), 1e-15, "red");
  is_near(c.g, cag_srgb_to_linear(0x80 / 255.0), 1e-15, "green");
  is_near(c.b, cag_srgb_to_linear(0xc0 / 255.0), 1e-15, "blue");
}

static void is_srgb(CagColor c, double r, double g, double b, const char *what) {
  is_near(cag_linear_to_srgb(c.r) * 255, r, 1e-3, what);
  is_near(cag_linear_to_srgb(c.g) * 255, g, 1e-3, what);
  is_near(cag_linear_to_srgb(c.b) * 255, b, 1e-3, what);
}

// Viridis at multiples of a tenth, as published with matplotlib. Between two of them, the color is
// the mean in sRGB.
static void scales_have_their_published_colors(void **state) {
  (void)state;
  static const int viridis[11][3] = {{68, 1, 84},    {72, 36, 117},  {65, 68, 135},  {53, 95, 141},
                                     {42, 120, 142}, {33, 145, 140}, {34, 168, 132}, {68, 191, 112},
                                     {122, 209, 81}, {189, 223, 38}, {253, 231, 37}};
  const CagColorScale scale = {CAG_SCALE_SEQUENCE, -20, 30, 0};
  for (int i = 0; i <= 10; i++) {
    const int *a = viridis[i], *b = viridis[i < 10 ? i + 1 : i];
    const double value = -20 + 5 * i;
    is_srgb(cag_color_scale_at(&scale, value), a[0], a[1], a[2], "a tenth");
    if (i < 10)
      is_srgb(cag_color_scale_at(&scale, value + 2.5), (a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0,
              (a[2] + b[2]) / 2.0, "between");
  }
  is_srgb(cag_color_scale_at(&scale, -1e9), 68, 1, 84, "below");
  is_srgb(cag_color_scale_at(&scale, 1e9), 253, 231, 37, "above");
  is_srgb(cag_color_scale_at(&scale, NAN), 128, 128, 128, "no number");
  // Moreland's cool to warm: blue, nearly white, red.
  const CagColorScale diverging = {CAG_SCALE_DIVERGING, -1, 1, 0};
  is_srgb(cag_color_scale_at(&diverging, -1), 59, 76, 192, "cool");
  is_srgb(cag_color_scale_at(&diverging, 0), 221, 220, 220, "middle");
  is_srgb(cag_color_scale_at(&diverging, 1), 180, 4, 38, "warm");
}

// Stripes change abruptly, beginning with a light one. Stops are the colors at their positions.
static void stops_are_the_colors_of_the_scale(void **state) {
  (void)state;
  static const CagColorScaleKind kinds[] = {CAG_SCALE_SEQUENCE, CAG_SCALE_DIVERGING,
                                            CAG_SCALE_STRIPES};
  CagColorStop stops[CAG_SCALE_STOPS_MAX];
  for (int k = 0; k < 3; k++)
    for (int stripes = 1; stripes <= CAG_SCALE_STRIPES_MAX; stripes += 13) {
      const CagColorScale scale = {kinds[k], 10, 12, stripes};
      const size_t n = cag_color_scale_stops(&scale, stops);
      assert_true(stops[0].at == 0 && stops[n - 1].at == 1);
      if (k == 2) assert_int_equal(n, 4 * stripes);
      for (size_t i = 0; i + 1 < n; i++) {
        assert_true(stops[i].at <= stops[i + 1].at);
        if (k == 2) assert_true((stops[i].at == stops[i + 1].at) == (i % 2 == 1));
        for (int j = 0; j < 5; j++) {
          const double t = 0.1 + 0.2 * j, at = stops[i].at + t * (stops[i + 1].at - stops[i].at);
          if (stops[i].at == stops[i + 1].at) continue;
          const CagColor c = cag_color_scale_at(&scale, 10 + 2 * at);
          const CagColor a = stops[i].color, b = stops[i + 1].color;
          is_near(c.r, a.r + t * (b.r - a.r), 2e-3, "red");
          is_near(c.g, a.g + t * (b.g - a.g), 2e-3, "green");
          is_near(c.b, a.b + t * (b.b - a.b), 2e-3, "blue");
          if (k == 2) assert_true((c.r > 0.5) == (i / 2 % 2 == 0));
        }
      }
      if (k == 2) {
        assert_true(cag_color_scale_at(&scale, 9).r > 0.5);
        assert_true(cag_color_scale_at(&scale, 13).r < 0.5);
      }
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(srgb_is_that_of_its_definition),
      cmocka_unit_test(scales_have_their_published_colors),
      cmocka_unit_test(stops_are_the_colors_of_the_scale),
  };
  return cmocka_run_group_tests_name("color_scale", tests, NULL, NULL);
}
