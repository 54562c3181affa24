// SVG: the file is XML, exact curves become exact paths, and all others are approximated.

#include "tests/interp/scene_fixture.h"

#include "interp/formats/svg.h"

static char folder[64];

static char *export_text(const Fixture *f) {
  char path[128];
  CagError io;
  snprintf(path, sizeof path, "%s/picture.svg", folder);
  CagAtomicFile *file = cag_atomic_file_open(path, &io);
  assert_non_null(file);
  OK(cag_export_svg(&f->scene, 0, file, &err));
  assert_true(cag_atomic_file_commit(file, &io));
  return read_whole(path);
}

static void assert_contains(const char *text, const char *part) {
  if (!strstr(text, part)) fail_msg("no `%s` in\n%s", part, text);
}

static CagCurve *cubic(void) {
  const CagVec3 p[] = {{0, 0, 0}, {10, 30, 0}, {20, -30, 0}, {40, 0, 0}};
  CagCurve *c;
  OK(cag_curve_bezier(p, NULL, 4, 2, &c, &err));
  return c;
}

static CagCurve *circle(double radius, CagVec3 center) {
  CagTransform frame = cag_translate(center);
  frame.planar = true;
  CagCurve *c;
  OK(cag_curve_arc(radius, radius, 0, 2 * M_PI, &frame, &c, &err));
  return c;
}

static void a_cubic_bezier_is_one_path_command(void **state) {
  (void)state;
  Fixture f;
  fixture_begin(&f);
  fixture_curve(&f, "wave", cubic());
  char *text = export_text(&f);
  // y goes down in SVG.
  assert_contains(text, "d=\"M 0 0 C 10 -30, 20 30, 40 0\"");
  assert_contains(text, "<title>wave</title>");
  free(text);
  fixture_end(&f);
}

// A uniform quadratic B-spline of the points P0..P3 with open knots 0 0 0 1 2 2 2 is split into two
// parabolas that meet at (P1 + P2) / 2. Each is elevated to a cubic, which divides its legs in
// thirds.
static void a_bspline_is_split_into_its_exact_pieces(void **state) {
  (void)state;
  const CagVec3 p[] = {{0, 0, 0}, {6, 12, 0}, {18, 12, 0}, {24, 0, 0}};
  const double knots[] = {0, 0, 0, 1, 2, 2, 2};
  Fixture f;
  CagCurve *c;
  OK(cag_curve_nurbs(p, NULL, 4, 2, knots, 2, &c, &err));
  fixture_begin(&f);
  fixture_curve(&f, "arch", c);
  char *text = export_text(&f);
  assert_contains(text, "d=\"M 0 0 C 4 -8, 8 -12, 12 -12 C 16 -12, 20 -8, 24 0\"");
  free(text);
  fixture_end(&f);
}

static void a_circle_is_two_exact_arcs(void **state) {
  (void)state;
  Fixture f;
  fixture_begin(&f);
  fixture_curve(&f, "hoop", circle(10, cag_vec3(5, 7, 0)));
  char *text = export_text(&f);
  // Counter-clockwise with y up is the negative direction with y down: sweep flag 0.
  assert_contains(text, "d=\"M 15 -7 A 10 10 0 0 0 -5 -7 A 10 10 0 0 0 15 -7 Z\"");
  free(text);
  fixture_end(&f);
}

static void a_region_is_filled_with_its_holes_left_out(void **state) {
  (void)state;
  Fixture f;
  CagRegion *r;
  CagCurve *outer, *hole = circle(5, cag_vec3(10, 10, 0));
  const CagVec3 p[] = {{0, 0, 0}, {20, 0, 0}, {20, 20, 0}, {0, 20, 0}};
  OK(cag_curve_polyline(p, 4, true, 2, &outer, &err));
  OK(cag_region_new(outer, &hole, 1, &r, &err));
  cag_curve_release(outer);
  cag_curve_release(hole);
  fixture_begin(&f);
  f.materials[0].color = (CagColor){1, 0, 0};
  fixture_region(&f, "plate", r);
  char *text = export_text(&f);
  assert_contains(text, "fill-rule=\"evenodd\" fill=\"#ff0000\"");
  assert_contains(text, "d=\"M 0 0 L 20 0 L 20 -20 L 0 -20 L 0 0 Z M ");
  assert_contains(text, " A 5 5 0 0 1 "); // holes run clockwise
  free(text);
  fixture_end(&f);
}

static void lines_have_their_width_dash_and_color(void **state) {
  (void)state;
  Fixture f;
  fixture_begin(&f);
  CagItem *item = fixture_curve(&f, "a<b & \"c\"", cubic());
  item->line_radius = 0.5;
  item->dash = 3;
  char *text = export_text(&f);
  assert_contains(text, "stroke-width=\"1\"");
  assert_contains(text, "stroke-dasharray=\"3\"");
  assert_contains(text, "stroke=\"#ffffff\"");
  assert_contains(text, "<title>a&lt;b &amp; &quot;c&quot;</title>");
  free(text);
  fixture_end(&f);
}

// The helix [20 cos t, 20 sin t, 8 t / 2 pi] seen along +Y by an orthographic camera is x = 20 cos
// t, y = 8 t / 2 pi. All ends of path commands are on this curve.
static void a_space_curve_is_drawn_as_the_camera_sees_it(void **state) {
  (void)state;
  Fixture f;
  CagCurve *c;
  OK(cag_curve_helix(20, 8, 2, 0, &c, &err));
  fixture_begin(&f);
  f.camera.orthographic = true;
  f.camera.width = 100;
  fixture_curve(&f, "coil", c);
  char *text = export_text(&f);
  const char *at = strstr(text, "d=\"M");
  assert_non_null(at);
  size_t ends = 0;
  double x, y, skip_x, skip_y;
  for (at += 4; *at && *at != '"'; at++) {
    if (*at != 'C') continue;
    if (sscanf(at, "C %lf %lf, %lf %lf, %lf %lf", &skip_x, &skip_y, &skip_x, &skip_y, &x, &y) != 6)
      fail_msg("not a cubic: %.40s", at);
    double t = -y * 2 * M_PI / 8;
    assert_true(fabs(x - 20 * cos(t)) < 1e-6);
    ends++;
  }
  assert_true(ends >= 8);
  free(text);
  fixture_end(&f);
}

// A point at the distance of the target keeps its size in a perspective picture.
static void perspective_keeps_lengths_at_the_target(void **state) {
  (void)state;
  Fixture f;
  CagCurve *c;
  OK(cag_curve_line(cag_vec3(-10, 0, 5), cag_vec3(15, 0, -5), 3, &c, &err));
  fixture_begin(&f);
  fixture_curve(&f, "stick", c);
  char *text = export_text(&f);
  assert_contains(text, "d=\"M -10 -5 L 15 5\"");
  free(text);
  fixture_end(&f);
}

// The cubic with y values 0, 10, -10, 0 over x in 0..3 turns at t = 1/2 -+ sqrt(3)/6, where |y| is
// 10 sqrt(3)/6. The picture ends there, not at the control points. Its border is 5% of the diagonal
// and half of the stroke, which is 0.3% of it.
static void the_picture_ends_where_the_curve_does(void **state) {
  (void)state;
  Fixture f;
  CagCurve *c;
  const CagVec3 p[] = {{0, 0, 0}, {1, 10, 0}, {2, -10, 0}, {3, 0, 0}};
  OK(cag_curve_bezier(p, NULL, 4, 2, &c, &err));
  fixture_begin(&f);
  fixture_curve(&f, "wave", c);
  char *text = export_text(&f);
  double box[4];
  const char *at = strstr(text, "viewBox=\"");
  assert_non_null(at);
  assert_int_equal(sscanf(at, "viewBox=\"%lf %lf %lf %lf", &box[0], &box[1], &box[2], &box[3]), 4);
  const double tall = 10 * sqrt(3) / 3, border = (0.05 + 0.0015) * hypot(3, tall);
  assert_true(fabs(box[2] - (3 + 2 * border)) < 1e-6);
  assert_true(fabs(box[3] - (tall + 2 * border)) < 1e-6);
  free(text);
  fixture_end(&f);
}

static void labels_stand_beside_their_marks(void **state) {
  (void)state;
  Fixture f;
  CagLabel labels[] = {{.text = "P_0",
                        .at = {10, 20, 0},
                        .place = CAG_LABEL_RIGHT,
                        .mark = CAG_LABEL_DOT,
                        .size = 4},
                       {.text = "a < b",
                        .at = {0, 0, 0},
                        .along = {0, 5, 0},
                        .directed = true,
                        .place = CAG_LABEL_ABOVE,
                        .size = 4},
                       {.text = "",
                        .at = {30, 0, 0},
                        .along = {2, 0, 0},
                        .directed = true,
                        .mark = CAG_LABEL_ARROW,
                        .size = 10}};
  fixture_begin(&f);
  fixture_curve(&f, "wave", cubic());
  f.scene.labels = labels;
  f.scene.label_count = 3;
  char *text = export_text(&f);
  // The texts are names of groups, for readers of screens. Their shapes are tested with the labels.
  assert_contains(text, "<g role=\"img\" aria-label=\"P_0\">\n    <path stroke=\"none\"");
  assert_contains(text, "<g role=\"img\" aria-label=\"a &lt; b\">");
  // The circle of a dot of radius 0.96.
  assert_contains(text, "A 0.96 0.96 0 0 0 ");
  // The tip of an arrow along +X is at its position.
  assert_contains(text, "d=\"M 30 0 L 21 ");
  free(text);
  fixture_end(&f);
}

static void the_file_is_well_formed(void **state) {
  (void)state;
  if (system("xmllint --version >/dev/null 2>&1") != 0) skip();
  char command[128];
  Fixture f;
  fixture_begin(&f);
  fixture_curve(&f, "<&>\x01", cubic());
  fixture_curve(&f, "hoop", circle(10, cag_vec3(0, 0, 0)));
  free(export_text(&f));
  snprintf(command, sizeof command, "xmllint --noout '%s/picture.svg'", folder);
  assert_int_equal(system(command), 0);
  fixture_end(&f);
}

static void a_scene_without_curves_is_an_error(void **state) {
  (void)state;
  Fixture f;
  CagError err;
  CagError io;
  fixture_begin(&f);
  fixture_item(&f, CAG_ITEM_GROUND, "ground");
  CagAtomicFile *file = cag_atomic_file_open("/dev/null", &io);
  assert_int_equal(cag_export_svg(&f.scene, 0, file, &err), CAG_E_ARGUMENT);
  assert_string_equal(cag_error_info(err.id)->reason, "svg-without-curves");
  cag_atomic_file_abort(file);
  fixture_end(&f);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_cubic_bezier_is_one_path_command),
      cmocka_unit_test(a_bspline_is_split_into_its_exact_pieces),
      cmocka_unit_test(a_circle_is_two_exact_arcs),
      cmocka_unit_test(a_region_is_filled_with_its_holes_left_out),
      cmocka_unit_test(lines_have_their_width_dash_and_color),
      cmocka_unit_test(a_space_curve_is_drawn_as_the_camera_sees_it),
      cmocka_unit_test(perspective_keeps_lengths_at_the_target),
      cmocka_unit_test(the_picture_ends_where_the_curve_does),
      cmocka_unit_test(labels_stand_beside_their_marks),
      cmocka_unit_test(the_file_is_well_formed),
      cmocka_unit_test(a_scene_without_curves_is_an_error),
  };
  fixture_folder(folder);
  int failed = cmocka_run_group_tests(tests, NULL, NULL);
  fixture_folder_remove(folder);
  return failed;
}
