// The area of each glyph of the compiled-in fonts, compared with sums over the Beziers that an
// independent reader finds in the files (tests/data/lettering).

#include "tests/geom/support.h"

#include <stdio.h>

#include "geom/letter/outline.h"

// Relative to the area. The sums of both sides are exact up to rounding.
#define AREA_TOLERANCE 1e-9

static FILE *open_areas(CagFontStyle style) {
  static const char *const names[] = {"regular", "bold", "italic", "bold_italic"};
  char path[80];
  snprintf(path, sizeof path, "tests/data/lettering/%s.txt", names[style]);
  FILE *f = fopen(path, "r");
  assert_non_null(f);
  return f;
}

static double area_of(const CagFont *f, uint32_t glyph, double scale) {
  CagRegion *r;
  double area;
  if (cag_glyph_region(f, glyph, scale, &r, &err))
    fail_msg("%s, glyph %u: %s", f->name, glyph, err.message);
  OK(cag_region_area(r, &area, NULL, &err));
  cag_region_release(r);
  return area;
}

static void check_glyph(const CagFont *f, uint32_t glyph, double scale, double expected) {
  const double found = area_of(f, glyph, scale) / (scale * scale);
  if (!(fabs(found - expected) <= AREA_TOLERANCE * expected))
    fail_msg("%s, glyph %u at scale %g: area %.17g, expected %.17g", f->name, glyph, scale, found,
             expected);
}

// All glyphs: those that the file leaves out have no area.
static void check_font(CagFontStyle style, double scale) {
  CagFont f;
  OK(cag_font_compiled_in(style, &f, &err));
  FILE *areas = open_areas(style);
  uint32_t glyph = 0, listed;
  double expected;
  while (fscanf(areas, "%u %lf", &listed, &expected) == 2) {
    for (; glyph < listed; glyph++) assert_true(area_of(&f, glyph, scale) == 0);
    check_glyph(&f, glyph++, scale, expected);
  }
  assert_true(glyph > 800);
  fclose(areas);
  cag_font_free(&f);
}

static void regular_glyphs_have_the_area_of_their_beziers(void **state) {
  (void)state;
  check_font(CAG_FONT_REGULAR, 1);
}

static void bold_glyphs_have_the_area_of_their_beziers(void **state) {
  (void)state;
  check_font(CAG_FONT_BOLD, 10.0 / 1409);
}

static void italic_glyphs_have_the_area_of_their_beziers(void **state) {
  (void)state;
  check_font(CAG_FONT_ITALIC, 1e-6 / 3);
}

static void bold_italic_glyphs_have_the_area_of_their_beziers(void **state) {
  (void)state;
  check_font(CAG_FONT_BOLD_ITALIC, 1e5 / 7);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(regular_glyphs_have_the_area_of_their_beziers),
      cmocka_unit_test(bold_glyphs_have_the_area_of_their_beziers),
      cmocka_unit_test(italic_glyphs_have_the_area_of_their_beziers),
      cmocka_unit_test(bold_italic_glyphs_have_the_area_of_their_beziers),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
