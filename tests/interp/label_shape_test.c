// Shapes of labels: positions of marks and texts, rotation, and extents. Widths and heights of
// letters are those of Liberation Sans, in units of which an em has 2048 (fontTools: hmtx and glyf).

#include "tests/interp/scene_fixture.h"

#include "interp/scene/label_shape.h"

// Fractions of the height of a text: the radius of a mark, the distance between a text and the
// point or mark, the height of capitals, and the depth of a text with a subscript.
#define MARK 0.24
#define SPACE 0.36
#define CAPITALS (1409.0 / 2048)
#define DROP 0.22
// The advance of H, and its sides from the start of the advance.
#define H_ADVANCE (1479.0 / 2048)
#define H_LEFT (168.0 / 2048)
#define H_RIGHT (1312.0 / 2048)

static void is_near(double x, double expected, double within, const char *what) {
  if (!(fabs(x - expected) <= within)) fail_msg("%s: %.12g, not %.12g", what, x, expected);
}

static CagLabelShape shape_of(const CagLabel *l, CagVec3 at, CagVec3 along, double size) {
  CagLabelFonts fonts = {0};
  CagLabelShape shape;
  CagError err = {0};
  if (cag_label_shape(&fonts, l, at, along, size, &shape, &err)) fail_msg("%s", err.message);
  cag_label_fonts_free(&fonts);
  return shape;
}

static CagBounds bounds_of(const CagRegion *r) {
  CagBounds box;
  CagError err = {0};
  assert_non_null(r);
  assert_int_equal(cag_region_bounds(r, &box, &err), CAG_OK);
  return box;
}

static double area_of(const CagRegion *r) {
  double area;
  CagError err = {0};
  assert_non_null(r);
  assert_int_equal(cag_region_area(r, &area, NULL, &err), CAG_OK);
  return area;
}

// A point of the text's own coordinates, with the baseline along (c, s).
static void extend(CagBounds *box, double x, double y, double c, double s, double u, double v) {
  cag_bounds_add(box, cag_vec3(x + u * c - v * s, y + u * s + v * c, 0));
}

static void assert_box(const CagBounds *box, const CagBounds *expected, double within) {
  is_near(box->min.x, expected->min.x, within, "left");
  is_near(box->max.x, expected->max.x, within, "right");
  is_near(box->min.y, expected->min.y, within, "bottom");
  is_near(box->max.y, expected->max.y, within, "top");
}

// Each alignment of a text, with and without a mark, along many directions and in many sizes. The
// text is next to its point: the closest edge of the letters is at the distance (plus the radius of
// the mark), or 0.7 of that at a corner, and letters next to a point are centered. Upside-down text
// is reversed.
static void texts_stand_beside_their_points(void **state) {
  (void)state;
  static const int steps[][2] = {{1, 0}, {-1, 0}, {0, 1},  {0, -1}, {0, 0},
                                 {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
  static const char *const names[] = {"right",      "left",        "above",
                                      "below",      "center",      "above_right",
                                      "above_left", "below_right", "below_left"};
  for (int place = 0; place < 9; place++) {
    assert_string_equal(cag_label_places[place], names[place]);
    for (int turn = -1; turn < 24; turn++)
      for (int mark = 0; mark < 4; mark++) {
        const double size = turn % 2 ? 4 : 350, angle = turn * M_PI / 12;
        const CagVec3 at = {13, -7, 0};
        const CagVec3 along =
            turn < 0 ? cag_vec3(0, 0, 0) : cag_vec3(3 * cos(angle), 3 * sin(angle), 0);
        const CagLabel l = {
            .text = "HH", .place = (CagLabelPlace)place, .mark = (CagLabelMark)mark};
        CagLabelShape shape = shape_of(&l, at, along, size);
        const int sx = steps[place][0], sy = steps[place][1];
        // The direction of writing: to the right or upward.
        double c = turn < 0 ? 1 : cos(angle), s = turn < 0 ? 0 : sin(angle);
        if (c < -1e-9 || (fabs(c) < 1e-9 && s < 0)) c = -c, s = -s;
        const double space = (SPACE + (mark ? MARK : 0)) * size * (sx && sy ? 0.7 : 1);
        const double wide = 2 * H_ADVANCE * size;
        const double right = sx * space + (sx > 0 ? 0 : sx < 0 ? -wide : -wide / 2);
        const double up = sy > 0 ? space : sy < 0 ? -space - CAPITALS * size : -CAPITALS * size / 2;
        const double x = at.x + right * c - up * s, y = at.y + right * s + up * c;
        CagBounds ink = CAG_BOUNDS_EMPTY, area = CAG_BOUNDS_EMPTY;
        for (int k = 0; k < 4; k++) {
          const double side = k & 1 ? (H_ADVANCE + H_RIGHT) * size : H_LEFT * size;
          extend(&ink, x, y, c, s, side, k & 2 ? CAPITALS * size : 0);
          extend(&area, x, y, c, s, k & 1 ? wide : 0, k & 2 ? CAPITALS * size : -DROP * size);
        }
        cag_bounds_add(&area, at);
        if (mark) {
          const double r = (MARK + 0.1) * size; // half of its stroke is outside
          cag_bounds_add(&area, cag_vec3(at.x - r, at.y - r, 0));
          cag_bounds_add(&area, cag_vec3(at.x + r, at.y + r, 0));
        }
        const CagBounds drawn = bounds_of(shape.text);
        assert_box(&drawn, &ink, 1e-8 * size);
        assert_box(&shape.box, &area, 1e-9 * size);
        cag_label_shape_free(&shape);
      }
  }
}

static void marks_have_their_shapes(void **state) {
  (void)state;
  const double size = 10, r = MARK * size;
  for (int turn = 0; turn < 24; turn++) {
    const double angle = turn * M_PI / 12, c = cos(angle), s = sin(angle);
    const CagVec3 at = {5, 30, 0}, along = {7 * c, 7 * s, 0};
    CagLabel l = {.text = "", .mark = CAG_LABEL_ARROW};
    CagLabelShape shape = shape_of(&l, at, along, size);
    // The tip is at the point. The back is 0.9 of the size behind it and 0.55 wide, and its notch
    // is a quarter of the length deep.
    CagBounds expected = CAG_BOUNDS_EMPTY;
    extend(&expected, at.x, at.y, c, s, 0, 0);
    extend(&expected, at.x, at.y, c, s, -9, 2.75);
    extend(&expected, at.x, at.y, c, s, -9, -2.75);
    const CagBounds arrow = bounds_of(shape.mark);
    assert_box(&arrow, &expected, 1e-9);
    is_near(area_of(shape.mark), 5.5 * 9 / 2 - 5.5 * 2.25 / 2, 1e-9, "area of an arrow");
    assert_null(shape.text);
    cag_label_shape_free(&shape);
    l.mark = CAG_LABEL_DOT;
    shape = shape_of(&l, at, along, size);
    is_near(area_of(shape.mark), M_PI * r * r, 1e-9, "area of a dot");
    cag_label_shape_free(&shape);
    l.mark = CAG_LABEL_CIRCLE;
    shape = shape_of(&l, at, along, size);
    is_near(area_of(shape.mark), 2 * M_PI * r * 1, 1e-9, "area of a circle");
    is_near(area_of(shape.paper), M_PI * r * r, 1e-9, "area of its inside");
    cag_label_shape_free(&shape);
    // Two strokes of width 1 and length 2 sqrt(2) r with round ends, which share a square.
    l.mark = CAG_LABEL_CROSS;
    shape = shape_of(&l, at, along, size);
    is_near(area_of(shape.mark), 2 * (2 * sqrt(2) * r + M_PI / 4) - 1, 1e-6, "area of a cross");
    cag_label_shape_free(&shape);
    l.mark = CAG_LABEL_NONE;
    shape = shape_of(&l, at, along, size);
    assert_null(shape.mark);
    cag_label_shape_free(&shape);
  }
}

// An arrow seen along its direction has no head, but its text keeps the distance. The text of an
// arrow is never rotated.
static void an_arrow_seen_from_its_end_has_no_head(void **state) {
  (void)state;
  const CagLabel l = {.text = "HH", .mark = CAG_LABEL_ARROW};
  for (int k = 0; k < 2; k++) {
    CagLabelShape shape = shape_of(&l, cag_vec3(0, 0, 0), cag_vec3(0, 2 * k, 0), 10);
    assert_true((shape.mark != NULL) == (k == 1));
    const CagBounds drawn = bounds_of(shape.text);
    is_near(drawn.min.x, 6 + 10 * H_LEFT, 1e-9, "left");
    is_near(drawn.min.y, -5 * CAPITALS, 1e-9, "bottom");
    is_near(drawn.max.y, 5 * CAPITALS, 1e-9, "top");
    cag_label_shape_free(&shape);
  }
}

// The advances of letters by fontTools: of the italic font P 1366, H 1479, Q 1593, i 455, 1 1139, _
// 1139, space 569; of the regular font P 1366, Q 1593.
static void names_have_lowered_indices(void **state) {
  (void)state;
  static const struct {
    const char *text;
    double advance;
    double bottom; // of the letters, in ems
  } cases[] = {{"P", 1366, 0},
               {"P_1", 1366 + 0.7 * 1139, -DROP},
               {"P_11", 1366 + 0.7 * 2 * 1139, -DROP},
               {"H_ ", 1479 + 1139 + 569, -1},
               {"PQ", 1366 + 1593, -1},
               {"1_1", 3 * 1139, -1}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const CagLabel l = {.text = (char *)cases[i].text};
    CagLabelShape shape = shape_of(&l, cag_vec3(0, 0, 0), cag_vec3(0, 0, 0), 10);
    is_near(shape.box.max.x, 3.6 + 10 * cases[i].advance / 2048, 1e-6, cases[i].text);
    if (cases[i].bottom > -1)
      is_near(bounds_of(shape.text).min.y, 10 * cases[i].bottom - 5 * CAPITALS, 1e-9,
              cases[i].text);
    cag_label_shape_free(&shape);
  }
}

// Characters that the font does not have are boxes, so that a label is never an error.
static void a_missing_character_is_a_box(void **state) {
  (void)state;
  const CagLabel l = {.text = "\xe6\xbc\xa2"};
  CagLabelShape shape = shape_of(&l, cag_vec3(0, 0, 0), cag_vec3(0, 0, 0), 10);
  assert_true(area_of(shape.text) > 1);
  cag_label_shape_free(&shape);
}

// The location of a label in a picture is that of its point, and a size in millimeters is that at its
// depth; without a size, it is 0.024 of the picture's diagonal.
static void a_label_is_where_the_camera_sees_it(void **state) {
  (void)state;
  // 90 degrees: the picture is as wide as twice the distance.
  const CagCamera camera = {.eye = {0, 0, 100},
                            .target = {0, 0, 0},
                            .up = {0, 1, 0},
                            .fov = M_PI / 2,
                            .size = {800, 600}};
  CagCameraMap map;
  CagLabelFonts fonts = {0};
  CagError err = {0};
  assert_int_equal(cag_scene_camera_map(&camera, &map, &err), CAG_OK);
  CagLabel l = {.text = "", .mark = CAG_LABEL_DOT, .at = {10, 20, 50}, .size = 5};
  CagLabelShape shape;
  assert_int_equal(cag_label_in_picture(&fonts, &l, &camera, &map, &shape, &err), CAG_OK);
  // At the distance 50, a millimeter has 8 pixels.
  CagBounds dot = bounds_of(shape.mark);
  is_near((dot.min.x + dot.max.x) / 2, 400 + 80, 1e-6, "x");
  is_near((dot.min.y + dot.max.y) / 2, 300 + 160, 1e-6, "y");
  is_near(dot.max.x - dot.min.x, 2 * MARK * 5 * 8, 1e-6, "width");
  cag_label_shape_free(&shape);
  l.size = 0;
  assert_int_equal(cag_label_in_picture(&fonts, &l, &camera, &map, &shape, &err), CAG_OK);
  dot = bounds_of(shape.mark);
  is_near(dot.max.x - dot.min.x, 2 * MARK * 0.024 * 1000, 1e-6, "width");
  cag_label_shape_free(&shape);
  l.at.z = 150;
  assert_int_equal(cag_label_in_picture(&fonts, &l, &camera, &map, &shape, &err), CAG_OK);
  assert_null(shape.mark);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(texts_stand_beside_their_points),
      cmocka_unit_test(marks_have_their_shapes),
      cmocka_unit_test(an_arrow_seen_from_its_end_has_no_head),
      cmocka_unit_test(names_have_lowered_indices),
      cmocka_unit_test(a_missing_character_is_a_box),
      cmocka_unit_test(a_label_is_where_the_camera_sees_it),
  };
  return cmocka_run_group_tests_name("label_shape", tests, NULL, NULL);
}
