// Texts as regions, and their measures, with faults (faults.h).

#include "tests/geom/faults.h"

#include "geom/letter/lettering.h"

typedef struct Case {
  const char *name, *text;
  CagFontStyle style;
  double width, spacing;
  CagLetterDirection direction;
  double radius; // of the circle along which it is set; 0: none
} Case;

static CagStatus make_curve(const Case *c, CagCurve **out, CagError *e) {
  CagTransform frame = cag_translate(cag_vec3(1, 2, 0));
  frame.planar = true;
  return c->radius > 0 ? cag_curve_arc(c->radius, c->radius, 0, 2 * M_PI, &frame, out, e) : CAG_OK;
}

static CagStatus set_text(const void *given, CagError *e) {
  const Case *c = given;
  CagCurve *along = NULL;
  CagRegion *out = NULL;
  CagFont font;
  CagStatus status = cag_font_compiled_in(c->style, &font, e);
  if (status) return status;
  status = make_curve(c, &along, e);
  if (!status) {
    const CagLettering how = {.font = &font,
                              .size = 10,
                              .spacing = c->spacing,
                              .line_spacing = 1,
                              .direction = c->direction,
                              .width = c->width,
                              .along = along};
    status = cag_lettering(c->text, strlen(c->text), &how, &out, e);
  }
  double area = 0;
  if (!status) status = cag_region_area(out, &area, NULL, e);
  if (!status) fault_found(area);
  cag_region_release(out);
  cag_curve_release(along);
  cag_font_free(&font);
  return status;
}

static CagStatus measure_text(const void *given, CagError *e) {
  const Case *c = given;
  CagLetteringMetrics m;
  CagFont font;
  CagStatus status = cag_font_compiled_in(c->style, &font, e);
  if (status) return status;
  const CagLettering how = {.font = &font,
                            .size = 10,
                            .spacing = c->spacing,
                            .line_spacing = 1,
                            .direction = c->direction,
                            .width = c->width};
  status = cag_lettering_measure(c->text, strlen(c->text), &how, &m, e);
  if (!status) fault_found(m.advance + m.box.max.y);
  cag_font_free(&font);
  return status;
}

static void texts_report_faults(void **state) {
  (void)state;
  static const Case cases[] = {
      {"one line", "AVi", CAG_FONT_REGULAR, 0, 1, CAG_LETTER_AUTO, 0},
      {"broken lines", "a b-c \u05d0\u05d1 1", CAG_FONT_BOLD, 10, 1, CAG_LETTER_AUTO, 0},
      {"letters that overlap", "\u00c5WO", CAG_FONT_ITALIC, 0, 0.4, CAG_LETTER_RTL, 0},
      {"a column", "Hi\nyo", CAG_FONT_BOLD_ITALIC, 0, 1, CAG_LETTER_TTB, 0},
      {"a circle", "oTo", CAG_FONT_REGULAR, 0, 1, CAG_LETTER_LTR, 8},
  };
  fault_problems = 0;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    OK(set_text(&cases[i], &err));
    try_faults("set", cases[i].name, set_text, &cases[i]);
    try_faults("measure", cases[i].name, measure_text, &cases[i]);
  }
  assert_int_equal(fault_problems, 0);
}

static void missing_characters_release_memory(void **state) {
  (void)state;
  static const Case missing = {"missing", "a\u6f22", CAG_FONT_REGULAR, 0, 1, CAG_LETTER_AUTO, 0};
  fault_problems = 0;
  FAILS(set_text(&missing, &err), "glyph-missing");
  try_faults("set", missing.name, set_text, &missing);
  assert_int_equal(fault_problems, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(texts_report_faults),
      cmocka_unit_test(missing_characters_release_memory),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
