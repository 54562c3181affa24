// Texts of both directions, lines, and places, compared with the rules. Advances and heights are those
// of Liberation Sans (fontTools: hmtx and glyf).

#include "tests/geom/support.h"

#include "geom/letter/lettering.h"

static CagFont fonts[CAG_FONT_STYLE_COUNT];

static int open_fonts(void **state) {
  (void)state;
  for (int i = 0; i < CAG_FONT_STYLE_COUNT; i++)
    OK(cag_font_compiled_in((CagFontStyle)i, &fonts[i], &err));
  return 0;
}

static int close_fonts(void **state) {
  (void)state;
  for (int i = 0; i < CAG_FONT_STYLE_COUNT; i++) cag_font_free(&fonts[i]);
  return 0;
}

static CagLetters shape(CagFontStyle style, CagLetterDirection direction, const char *text) {
  const CagLetterRules rules = {.direction = direction, .spacing = 1};
  CagLetters letters;
  OK(cag_letters_shape(&fonts[style], text, strlen(text), &rules, &letters, &err));
  return letters;
}

// --- Bidirectional order ---

// The text whose characters, from left to right, have the glyphs of the letters.
static void assert_seen(CagLetterDirection direction, const char *text, const char *seen) {
  CagLetters a = shape(CAG_FONT_REGULAR, direction, text),
             b = shape(CAG_FONT_REGULAR, CAG_LETTER_LTR, "");
  size_t i = 0;
  for (const char *c = seen; *c; i++) {
    char one[5] = "";
    const size_t n = (*c & 0x80) == 0 ? 1 : (*c & 0xe0) == 0xc0 ? 2 : 3;
    memcpy(one, c, n);
    c += n;
    cag_letters_free(&b);
    b = shape(CAG_FONT_REGULAR, CAG_LETTER_LTR, one);
    assert_int_equal(b.count, 1);
    assert_true(i < a.count);
    if (a.items[i].glyph != b.items[0].glyph)
      fail_msg("%s: place %zu does not show %s", text, i, one);
  }
  assert_int_equal(i, a.count);
  cag_letters_free(&a);
  cag_letters_free(&b);
}

// The rules of Unicode Standard Annex 9: Hebrew runs to the left, numbers in it to the right, the
// first letter decides for the paragraph, and brackets follow what they enclose.
static void texts_of_both_directions_are_ordered(void **state) {
  (void)state;
  assert_seen(CAG_LETTER_AUTO, "car \u05d0\u05d1\u05d2 cdr", "car \u05d2\u05d1\u05d0 cdr");
  assert_seen(CAG_LETTER_AUTO, "\u05d0\u05d1\u05d2 means \u05d3\u05d4.",
              ".\u05d4\u05d3 means \u05d2\u05d1\u05d0");
  assert_seen(CAG_LETTER_AUTO, "\u05d0\u05d1 123", "123 \u05d1\u05d0");
  assert_seen(CAG_LETTER_AUTO, "abc \u05d0\u05d1 123", "abc 123 \u05d1\u05d0");
  assert_seen(CAG_LETTER_LTR, "\u05d0\u05d1 abc", "\u05d1\u05d0 abc");
  assert_seen(CAG_LETTER_RTL, "abc \u05d0\u05d1", "\u05d1\u05d0 abc");
  assert_seen(CAG_LETTER_RTL, "abc!", "!abc");
  // Mirrored brackets: the one on the left opens to the right.
  assert_seen(CAG_LETTER_AUTO, "\u05d0\u05d1 (car) \u05d2\u05d3",
              "\u05d3\u05d2 (car) \u05d1\u05d0");
  assert_seen(CAG_LETTER_AUTO, "\u05d0 (\u05d1)", "(\u05d1) \u05d0");
}

// --- Lines ---

static size_t line_lengths(const char *text, double width, size_t *out, size_t most) {
  const CagLetterRules rules = {.direction = CAG_LETTER_AUTO, .spacing = 1, .width = width};
  CagLetters l;
  OK(cag_letters_shape(&fonts[0], text, strlen(text), &rules, &l, &err));
  const size_t n = l.line_count;
  assert_true(n <= most);
  for (size_t i = 0; i < n; i++) {
    out[i] = l.lines[i].count;
    assert_true(l.lines[i].count == 0 || i + 1 == n || l.lines[i].advance > 0);
  }
  cag_letters_free(&l);
  return n;
}

static void lines_are_broken_at_spaces_and_hyphens(void **state) {
  (void)state;
  size_t n[20];
  // An a is 1139 wide, and a space 569 (hmtx).
  assert_int_equal(line_lengths("aa aa aa", 0, n, 20), 1);
  assert_int_equal(line_lengths("aa aa aa", 4 * 1139 + 569, n, 20), 2);
  assert_int_equal(n[0], 5);
  assert_int_equal(n[1], 2);
  assert_int_equal(line_lengths("aa aa aa", 4 * 1139 + 568, n, 20), 3);
  // A word that is too long has a line of its own.
  assert_int_equal(line_lengths("a aaaaaa a", 2 * 1139, n, 20), 3);
  assert_int_equal(n[1], 6);
  // Spaces at the end of a line do not count; those within do.
  assert_int_equal(line_lengths("aa     aa", 2 * 1139, n, 20), 2);
  assert_int_equal(n[0], 2);
  assert_int_equal(line_lengths("aaa-aaa", 4 * 1139, n, 20), 2);
  assert_int_equal(n[0], 4);
  // A space that must not be broken.
  assert_int_equal(line_lengths("aa\u00a0aa", 2 * 1139, n, 20), 1);
  assert_int_equal(line_lengths("a\n\nb\n", 0, n, 20), 4);
  assert_int_equal(n[1], 0);
  assert_int_equal(line_lengths("", 0, n, 20), 1);
  assert_int_equal(line_lengths("", 100, n, 20), 1);
}

// --- Regions ---

static CagLettering plain(double size) {
  return (CagLettering){.font = &fonts[0],
                        .size = size,
                        .spacing = 1,
                        .line_spacing = 1,
                        .direction = CAG_LETTER_AUTO};
}

static CagRegion *region_of(const char *text, const CagLettering *how) {
  CagRegion *r;
  OK(cag_lettering(text, strlen(text), how, &r, &err));
  return r;
}

static double area_of(const char *text, const CagLettering *how) {
  CagRegion *r = region_of(text, how);
  double area;
  OK(cag_region_area(r, &area, NULL, &err));
  cag_region_release(r);
  return area;
}

// Letters that do not overlap have the sum of their areas, whatever their place.
static void areas_of_texts_are_sums(void **state) {
  (void)state;
  CagLettering how = plain(10);
  const double sum = area_of("a", &how) + area_of("V", &how) + area_of("o", &how);
  NEAR(area_of("aVo", &how), sum, 1e-9 * sum);
  how.spacing = 3;
  NEAR(area_of("a V o", &how), sum, 1e-9 * sum);
  how.direction = CAG_LETTER_TTB;
  NEAR(area_of("aVo", &how), sum, 1e-9 * sum);
  how = plain(20);
  NEAR(area_of("aVo", &how), 4 * sum, 1e-9 * sum);
  // With letters on top of each other, only the union counts.
  how = plain(10);
  how.spacing = 1e-9;
  NEAR(area_of("oo", &how), area_of("o", &how), 1e-6);
}

// The letter o at the start of its line is as far from the curve as from the baseline of plain text,
// and turned with the curve.
static void letters_follow_a_curve(void **state) {
  (void)state;
  CagCurve *straight, *circle;
  CagTransform frame = cag_translate(cag_vec3(0, 0, 0));
  frame.planar = true;
  OK(cag_curve_line(cag_vec3(3, 1, 0), cag_vec3(3, 101, 0), 2, &straight, &err));
  OK(cag_curve_arc(40, 40, 0, 2 * M_PI, &frame, &circle, &err));
  CagLettering how = plain(10);
  CagRegion *r = region_of("HoHH", &how);
  CagBounds flat, box;
  OK(cag_region_bounds(r, &flat, &err));
  cag_region_release(r);
  how.along = straight;
  r = region_of("HoHH", &how);
  OK(cag_region_bounds(r, &box, &err));
  cag_region_release(r);
  // A line upward turns the text by a quarter.
  NEAR(box.min.x, 3 - flat.max.y, 1e-7);
  NEAR(box.max.x, 3 - flat.min.y, 1e-7);
  NEAR(box.min.y, 1 + flat.min.x, 1e-7);
  NEAR(box.max.y, 1 + flat.max.x, 1e-7);
  how.align = CAG_LETTER_RIGHT;
  r = region_of("HoHH", &how);
  CagBounds right;
  OK(cag_region_bounds(r, &right, &err));
  cag_region_release(r);
  // The advance of H is 1479, that of o 1139, and the height of H is 1409 (hmtx, glyf).
  NEAR(right.min.y - box.min.y, 100 - (3 * 1479 + 1139) * 10.0 / 1409, 1e-7);
  how.align = CAG_LETTER_LEFT;
  how.along = circle;
  // On the left side of the circle is its inside. The middle of H is above that of its advance.
  r = region_of("H", &how);
  const double s = 1479 * 10.0 / 1409 / 2 / 40;
  CagVec3 center;
  double area;
  OK(cag_region_area(r, &area, &center, &err));
  NEAR(cag_norm(center), 40 - 5, 0.05);
  NEAR(atan2(center.y, center.x), s, 0.002);
  cag_region_release(r);
  how.size = 200;
  assert_int_equal(cag_lettering("Hm", 2, &how, &r, &err), CAG_E_ARGUMENT);
  assert_int_equal(err.id, CAG_ERR_lettering_too_long);
  cag_curve_release(straight);
  cag_curve_release(circle);
}

static void a_missing_glyph_names_character_and_font(void **state) {
  (void)state;
  const CagLettering how = plain(10);
  CagRegion *r;
  assert_int_equal(cag_lettering("a\u6f22", 4, &how, &r, &err), CAG_E_ARGUMENT);
  assert_int_equal(err.id, CAG_ERR_glyph_missing);
  assert_non_null(strstr(err.message, "\"\u6f22\" (U+6F22)"));
  assert_non_null(strstr(err.message, "\"sans\""));
  assert_int_equal(cag_lettering("a\x01", 2, &how, &r, &err), CAG_E_ARGUMENT);
  assert_non_null(strstr(err.message, "U+0001"));
}

static void damaged_fonts_are_errors(void **state) {
  (void)state;
  CagFont f;
  const CagFontFile *file = &cag_compiled_fonts[0];
  assert_int_equal(cag_font_new("x", "", 0, 0, &f, &err), CAG_E_ARGUMENT);
  assert_int_equal(err.id, CAG_ERR_font_unreadable);
  assert_int_equal(cag_font_new("x", "no font", 7, 0, &f, &err), CAG_E_ARGUMENT);
  assert_int_equal(cag_font_new("x", file->bytes, file->size, 1, &f, &err), CAG_E_ARGUMENT);
  assert_int_equal(cag_font_new("x", file->bytes, 100, 0, &f, &err), CAG_E_ARGUMENT);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(texts_of_both_directions_are_ordered),
      cmocka_unit_test(lines_are_broken_at_spaces_and_hyphens),
      cmocka_unit_test(areas_of_texts_are_sums),
      cmocka_unit_test(letters_follow_a_curve),
      cmocka_unit_test(a_missing_glyph_names_character_and_font),
      cmocka_unit_test(damaged_fonts_are_errors),
  };
  return cmocka_run_group_tests_name("letter_layout", tests, open_fonts, close_fonts);
}
