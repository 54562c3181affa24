// Labels of SVG pictures: positions of marks and texts, rotation, and extents.

#include "tests/interp/scene_fixture.h"

#include "interp/formats/svg_label.h"

// Fractions of the height of a text: the radius of a mark, the distance between a text and the
// point or mark, the height of capitals, and the width of a letter.
#define MARK 0.24
#define SPACE 0.36
#define CAPITALS 0.72
#define LETTER 0.56
// The depth of a text with a subscript below the baseline.
#define DROP 0.22

static char *label_text(const CagLabel *l, CagVec3 at, CagVec3 along, double unit, CagBounds *box,
                        bool *finite) {
  char *text = NULL;
  size_t n;
  FILE *out = open_memstream(&text, &n);
  assert_non_null(out);
  *finite = cag_svg_label(out, l, at, along, "#102030", unit, box);
  fclose(out);
  char *copy = strdup(text);
  free(text);
  return copy;
}

static void assert_contains(const char *text, const char *part) {
  if (!strstr(text, part)) fail_msg("no `%s` in\n%s", part, text);
}

static double number_after(const char *text, const char *name) {
  const char *at = strstr(text, name);
  if (!at) fail_msg("no `%s` in\n%s", name, text);
  return strtod(at + strlen(name), NULL);
}

static void is_near(double x, double expected, double within, const char *what) {
  if (!(fabs(x - expected) <= within)) fail_msg("%s: %.12g, not %.12g", what, x, expected);
}

// The area of a label: its point, its mark, and a rectangle around its text.
typedef struct Area {
  CagBounds box;
} Area;

static void extend_area(Area *a, double x, double y) { cag_bounds_add(&a->box, cag_vec3(x, y, 0)); }

// Each alignment of a text, with and without a mark, along many directions and in many sizes. The
// text is next to its point: the closest edge of the letters is at the distance (plus the radius of
// the mark), or 0.7 of that at a corner, and letters next to a point are centered. Upside-down text
// is reversed.
static void texts_stand_beside_their_points(void **state) {
  (void)state;
  static const int steps[][2] = {{1, 0}, {-1, 0}, {0, 1},  {0, -1}, {0, 0},
                                 {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
  static const char *const anchors[] = {"\"end\"", "\"middle\"", "\"start\""};
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
        const CagLabel l = {.text = "ab\xc3\xa9"
                                    "d",
                            .place = (CagLabelPlace)place,
                            .mark = (CagLabelMark)mark,
                            .size = size};
        CagBounds box = CAG_BOUNDS_EMPTY;
        bool finite;
        char *text = label_text(&l, at, along, 1000, &box, &finite);
        assert_true(finite);
        const int sx = steps[place][0], sy = steps[place][1];
        assert_contains(strstr(text, "text-anchor="), anchors[sx + 1]);
        // The direction of writing: to the right or upward.
        double c = turn < 0 ? 1 : cos(angle), s = turn < 0 ? 0 : sin(angle);
        if (c < -1e-9 || (fabs(c) < 1e-9 && s < 0)) c = -c, s = -s;
        const double space = (SPACE + (mark ? MARK : 0)) * size * (sx && sy ? 0.7 : 1);
        const double right = sx * space;
        const double up = sy > 0 ? space : sy < 0 ? -space - CAPITALS * size : -CAPITALS * size / 2;
        const double x = at.x + right * c - up * s, y = at.y + right * s + up * c;
        const double within = 0.0006 * size; // numbers are rounded to a thousandth of a letter
        const char *t = strstr(text, "<text");
        is_near(number_after(t, " x=\""), x, within, "x");
        is_near(number_after(t, " y=\""), -y, within, "y");
        is_near(number_after(t, " font-size=\""), size, 0, "size");
        assert_true((strstr(text, "rotate(") != NULL) == (turn >= 0));
        if (turn >= 0) {
          double degrees, cx, cy;
          assert_int_equal(
              sscanf(strstr(text, "rotate("), "rotate(%lf %lf %lf)", &degrees, &cx, &cy), 3);
          is_near(degrees, -atan2(s, c) * 180 / M_PI, 0.0051, "turn");
          is_near(cx, x, within, "center");
          is_near(cy, -y, within, "center");
        }
        Area area = {CAG_BOUNDS_EMPTY};
        extend_area(&area, at.x, at.y);
        const double wide = 4 * LETTER * size, left = sx > 0 ? 0 : sx < 0 ? -wide : -wide / 2;
        for (int k = 0; k < 4; k++) {
          const double along_text = left + (k & 1 ? wide : 0),
                       over = k & 2 ? CAPITALS * size : -DROP * size;
          extend_area(&area, x + along_text * c - over * s, y + along_text * s + over * c);
        }
        if (mark) {
          const double r = (MARK + 0.1) * size; // half of its stroke is outside
          extend_area(&area, at.x - r, at.y - r);
          extend_area(&area, at.x + r, at.y + r);
        }
        is_near(box.min.x, area.box.min.x, 1e-9 * size, "left");
        is_near(box.max.x, area.box.max.x, 1e-9 * size, "right");
        is_near(box.min.y, area.box.min.y, 1e-9 * size, "bottom");
        is_near(box.max.y, area.box.max.y, 1e-9 * size, "top");
        assert_true(box.min.z == 0 && box.max.z == 0);
        free(text);
      }
  }
}

// The default size of a label is 0.024 of the picture's diagonal.
static void a_label_has_a_size_by_the_picture(void **state) {
  (void)state;
  const CagLabel l = {.text = "A", .mark = CAG_LABEL_DOT};
  CagBounds box = CAG_BOUNDS_EMPTY;
  bool finite;
  char *text = label_text(&l, cag_vec3(1, 2, 0), cag_vec3(0, 0, 0), 500, &box, &finite);
  assert_true(finite);
  assert_contains(text, " font-size=\"12\"");
  assert_contains(text, "<circle cx=\"1\" cy=\"-2\" r=\"2.88\" fill=\"#102030\" stroke=\"none\"/>");
  free(text);
}

static void marks_have_their_shapes(void **state) {
  (void)state;
  const double size = 10;
  for (int turn = 0; turn < 24; turn++) {
    const double angle = turn * M_PI / 12, c = cos(angle), s = sin(angle);
    const CagVec3 at = {5, 30, 0}, along = {7 * c, 7 * s, 0};
    CagLabel l = {.text = "", .mark = CAG_LABEL_ARROW, .size = size};
    CagBounds box = CAG_BOUNDS_EMPTY;
    bool finite;
    char *text = label_text(&l, at, along, 1, &box, &finite);
    // The tip is at the point. The back is 0.9 of the size behind it and 0.55 wide, and its notch
    // is a quarter of the length deep.
    double p[4][2];
    const char *d = strstr(text, "d=\"");
    assert_int_equal(sscanf(d, "d=\"M %lf %lf L %lf %lf L %lf %lf L %lf %lf Z\"/>", &p[0][0],
                            &p[0][1], &p[1][0], &p[1][1], &p[2][0], &p[2][1], &p[3][0], &p[3][1]),
                     8);
    const double expected[4][2] = {{0, 0}, {-9, 2.75}, {-6.75, 0}, {-9, -2.75}};
    for (int k = 0; k < 4; k++) {
      const double u = expected[k][0], v = expected[k][1];
      is_near(p[k][0], at.x + u * c - v * s, 0.0051, "x");
      is_near(-p[k][1], at.y + u * s + v * c, 0.0051, "y");
    }
    assert_null(strstr(text, "<text"));
    free(text);
    l.mark = CAG_LABEL_CROSS;
    text = label_text(&l, at, along, 1, &box, &finite);
    assert_contains(text, " stroke-width=\"1\" stroke=\"#102030\"");
    assert_contains(text, "d=\"M 2.6 -27.6 L 7.4 -32.4 M 2.6 -32.4 L 7.4 -27.6\"/>");
    free(text);
    l.mark = CAG_LABEL_CIRCLE;
    text = label_text(&l, at, along, 1, &box, &finite);
    assert_contains(text,
                    "<circle cx=\"5\" cy=\"-30\" r=\"2.4\" stroke-width=\"1\" fill=\"#ffffff\" "
                    "stroke=\"#102030\"/>");
    free(text);
    l.mark = CAG_LABEL_NONE;
    text = label_text(&l, at, along, 1, &box, &finite);
    assert_string_equal(text, "");
    free(text);
  }
}

// An arrow seen along its direction has no head, but its text keeps the distance. The text of an
// arrow is never rotated.
static void an_arrow_seen_from_its_end_has_no_head(void **state) {
  (void)state;
  const CagLabel l = {.text = "v", .mark = CAG_LABEL_ARROW, .size = 10};
  CagBounds box = CAG_BOUNDS_EMPTY;
  bool finite;
  char *text = label_text(&l, cag_vec3(0, 0, 0), cag_vec3(0, 0, 0), 1, &box, &finite);
  assert_null(strstr(text, "<path"));
  assert_contains(text, "<text x=\"6\" y=\"3.6\"");
  free(text);
  text = label_text(&l, cag_vec3(0, 0, 0), cag_vec3(0, 2, 0), 1, &box, &finite);
  assert_non_null(strstr(text, "<path"));
  assert_contains(text, "<text x=\"6\" y=\"3.6\"");
  assert_null(strstr(text, "rotate"));
  free(text);
}

// The runs of a text that is a name: one letter and an index after `_`. The index is lowered, and
// text after it is raised again.
static void names_have_lowered_indices(void **state) {
  (void)state;
  static const struct {
    const char *text, *runs;
    bool italic;
    double letters;
  } cases[] = {
      {"P", "<tspan>P</tspan>", true, 1},
      {"P_0", "<tspan>P</tspan><tspan dy=\"2.2\" font-size=\"7\">0</tspan>", true, 1.7},
      {"P_12", "<tspan>P</tspan><tspan dy=\"2.2\" font-size=\"7\">12</tspan>", true, 2.4},
      {"P_0(t)",
       "<tspan>P</tspan><tspan dy=\"2.2\" font-size=\"7\">0</tspan><tspan dy=\"-2.2\">(t)</tspan>",
       true, 4.7},
      {"\xce\xb1_\xce\xb2",
       "<tspan>\xce\xb1</tspan><tspan dy=\"2.2\" font-size=\"7\">\xce\xb2</tspan>", true, 1.7},
      {"P_\xce\xb1\xce\xb2",
       "<tspan>P</tspan><tspan dy=\"2.2\" font-size=\"7\">\xce\xb1\xce\xb2</tspan>", true, 2.4},
      {"P_", "<tspan>P_</tspan>", true, 2},
      {"P_ Q_i", "<tspan>P_</tspan><tspan> Q</tspan><tspan dy=\"2.2\" font-size=\"7\">i</tspan>",
       true, 4.7},
      {"PQ", "<tspan>PQ</tspan>", false, 2},
      {"my_name", "<tspan>my_name</tspan>", false, 7},
      {"1_2", "<tspan>1_2</tspan>", false, 3},
      {"\xce\xb1\xce\xb2", "<tspan>\xce\xb1\xce\xb2</tspan>", true, 2},
      {"\xe2\x82\xac"
       "a",
       "<tspan>\xe2\x82\xac"
       "a</tspan>",
       false, 2},
      {"<a", "<tspan>&lt;a</tspan>", false, 2},
      {"a&\"b\"\t>", "<tspan>a&amp;&quot;b&quot; &gt;</tspan>", true, 7},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const CagLabel l = {.text = (char *)cases[i].text, .size = 10};
    CagBounds box = CAG_BOUNDS_EMPTY;
    bool finite;
    char *text = label_text(&l, cag_vec3(0, 0, 0), cag_vec3(0, 0, 0), 1, &box, &finite), whole[300];
    snprintf(whole, sizeof whole, ">%s</text>\n", cases[i].runs);
    assert_contains(text, whole);
    if ((strstr(text, "italic") != NULL) != cases[i].italic) fail_msg("%s: italics", cases[i].text);
    is_near(box.max.x, 3.6 + cases[i].letters * 5.6, 1e-9, cases[i].text);
    free(text);
  }
}

// Numbers are rounded to a thousandth of the size's power of ten, and zero is never negative.
static void numbers_have_the_digits_that_the_size_asks_for(void **state) {
  (void)state;
  const CagVec3 at = {1234.56789012345, 0.0000001, 0};
  static const struct {
    double size;
    const char *circle;
  } cases[] = {{10, "cx=\"1234.57\" cy=\"0\" r=\"2.4\""},
               {99, "cx=\"1234.57\" cy=\"0\" r=\"23.76\""},
               {1, "cx=\"1234.568\" cy=\"0\" r=\"0.24\""},
               {0.01, "cx=\"1234.56789\" cy=\"0\" r=\"0.0024\""},
               {20000, "cx=\"1230\" cy=\"0\" r=\"4800\""}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const CagLabel l = {.text = "", .mark = CAG_LABEL_DOT, .size = cases[i].size};
    CagBounds box = CAG_BOUNDS_EMPTY;
    bool finite;
    char *text = label_text(&l, at, cag_vec3(0, 0, 0), 1, &box, &finite);
    assert_contains(text, cases[i].circle);
    assert_true(finite);
    free(text);
  }
}

static void a_number_that_is_not_finite_is_told(void **state) {
  (void)state;
  for (int i = 0; i < 3; i++) {
    const CagLabel l = {.text = "A", .mark = CAG_LABEL_DOT, .size = 1};
    const CagVec3 at = i == 0   ? cag_vec3(1e9, 0, 0)
                       : i == 1 ? cag_vec3(INFINITY, 0, 0)
                                : cag_vec3(0, NAN, 0);
    CagBounds box = CAG_BOUNDS_EMPTY;
    bool finite;
    free(label_text(&l, at, cag_vec3(0, 0, 0), 1, &box, &finite));
    assert_true(finite == (i == 0));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(texts_stand_beside_their_points),
      cmocka_unit_test(a_label_has_a_size_by_the_picture),
      cmocka_unit_test(marks_have_their_shapes),
      cmocka_unit_test(an_arrow_seen_from_its_end_has_no_head),
      cmocka_unit_test(names_have_lowered_indices),
      cmocka_unit_test(numbers_have_the_digits_that_the_size_asks_for),
      cmocka_unit_test(a_number_that_is_not_finite_is_told),
  };
  return cmocka_run_group_tests_name("svg_label", tests, NULL, NULL);
}
