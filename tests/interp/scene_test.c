// The parts of a scene: tubes of curves, colors, meshes of items, cameras, and standard views.

#include "interp/scene/scene.h"
#include "scene_fixture.h"

// A tube has twelve sides. SECTION is the area of its section divided by r^2.
#define SECTION (6 * sin(M_PI / 6))

static CagCurve *polyline(const CagVec3 *p, size_t n, bool closed) {
  CagCurve *c;
  OK(cag_curve_polyline(p, n, closed, 3, &c, &err));
  return c;
}

// Returns the mesh of an item with one curve, or NULL with the reason.
static CagMesh *tube_of(CagCurve *c, double radius, double dash, size_t most, CagError *err) {
  Fixture f;
  CagMesh *m = NULL;
  fixture_begin(&f);
  f.items[0] = (CagItem){.kind = CAG_ITEM_CURVE, .name = "line", .as.curve = c};
  f.items[0].line_radius = radius;
  f.items[0].dash = dash;
  f.scene.item_count = 1;
  f.scene.max_triangles = most;
  *err = (CagError){0};
  cag_item_mesh(&f.scene, &f.items[0], &m, err);
  return m;
}

static void is_volume(CagCurve *c, double radius, double dash, double expected, double within) {
  CagError err;
  CagMesh *m = tube_of(c, radius, dash, 1000000, &err);
  if (!m) fail_msg("%s", err.message);
  const double volume = volume_of(m);
  if (fabs(volume - expected) > within) fail_msg("volume %.9g, not %.9g", volume, expected);
  cag_mesh_release(m);
  cag_curve_release(c);
}

static void a_line_is_a_prism_along_it(void **state) {
  (void)state;
  const CagVec3 p[] = {{0, 0, 0}, {30, 40, 0}};
  is_volume(polyline(p, 2, false), 2, 0, 50 * 4 * SECTION, 1e-9);
}

// A length of 90 with dashes of 10 has nine steps, of which five are drawn. A length of 95 has the
// same number of steps, each slightly longer. If three steps do not fit, the whole line is drawn.
static void dashes_fill_a_line_from_end_to_end(void **state) {
  (void)state;
  const CagVec3 even[] = {{0, 0, 0}, {20, 0, 0}, {90, 0, 0}}, odd[] = {{0, 0, 0}, {95, 0, 0}};
  is_volume(polyline(even, 3, false), 1, 10, 5 * 10 * SECTION, 1e-9);
  is_volume(polyline(odd, 2, false), 1, 10, 5 * 95.0 / 9 * SECTION, 1e-9);
  is_volume(polyline(odd, 2, false), 1, 40, 95 * SECTION, 1e-9);
}

// A circle is approximated by chords. The length of its tube is that of the chords, except at the
// corners between them, where sections are not perpendicular to the chord.
static void dashes_of_a_closed_curve_are_as_many_as_gaps(void **state) {
  (void)state;
  CagCurve *c;
  const CagTransform frame = cag_transform_identity();
  OK(cag_curve_arc(20, 20, 0, 2 * M_PI, &frame, &c, &err));
  const double length = 2 * M_PI * 20;
  is_volume(cag_curve_retain(c), 0.5, 0, length * 0.25 * SECTION, 0.01 * length * 0.25 * SECTION);
  is_volume(c, 0.5, 7, length / 2 * 0.25 * SECTION, 0.01 * length / 2 * 0.25 * SECTION);
}

// Six frustums between regular dodecagons, at every 30 degrees from pole to pole.
static double ball_volume(void) {
  double v = 0;
  for (int i = 0; i < 6; i++) {
    const double a = SECTION * pow(sin(M_PI * i / 6), 2);
    const double b = SECTION * pow(sin(M_PI * (i + 1) / 6), 2);
    v += (cos(M_PI * i / 6) - cos(M_PI * (i + 1) / 6)) / 3 * (a + b + sqrt(a * b));
  }
  return v;
}

// The volume that a corner of 90 degrees adds to two tubes of radius 1 that end at it. A wedge in
// three steps of 30 degrees fills the outer side: each step adds sin(30 degrees) / 2 times the
// integral of the squared width of half a section. The bisecting plane cuts both tubes on the inner
// side: each loses the first moment of that half times tan(45 degrees).
static double corner_volume(void) {
  double moment = 0, squares = 0;
  for (int k = -3; k < 3; k++) {
    const double a = M_PI * k / 6, b = M_PI * (k + 1) / 6;
    const double x0 = cos(a), y0 = sin(a), x1 = cos(b), y1 = sin(b);
    moment += (x0 * y1 - x1 * y0) / 2 * (x0 + x1) / 3;
    squares += (y1 - y0) * (x0 * x0 + x0 * x1 + x1 * x1) / 3;
  }
  return 3 * 0.5 / 2 * squares - 2 * moment;
}

static void corners_are_filled_by_wedges(void **state) {
  (void)state;
  const CagVec3 square[] = {{0, 0, 0}, {100, 0, 0}, {100, 100, 0}, {0, 100, 0}};
  const CagVec3 open[] = {{0, 0, 0}, {100, 0, 0}, {100, 100, 0}};
  const double corner = corner_volume();
  is_volume(polyline(square, 4, true), 1, 0, 400 * SECTION + 4 * corner, 1e-6);
  is_volume(polyline(open, 3, false), 1, 0, 200 * SECTION + corner, 1e-6);
}

// The tubes end at distances of 0.03 and 0.05 of the radius before the center of the ball.
static void a_path_that_turns_back_has_a_ball(void **state) {
  (void)state;
  const CagVec3 p[] = {{0, 0, 0}, {100, 0, 0}, {50, 0, 0}};
  is_volume(polyline(p, 3, false), 1, 0, (150 - 0.08) * SECTION + ball_volume(), 1e-6);
}

static void tubes_keep_the_limit_of_triangles(void **state) {
  (void)state;
  const CagVec3 p[] = {{0, 0, 0}, {100, 0, 0}};
  CagCurve *c = polyline(p, 2, false);
  CagError err;
  assert_null(tube_of(c, 1, 0, 20, &err));
  assert_string_equal(cag_error_info(err.id)->reason, "triangle-limit");
  assert_null(tube_of(c, 1, 0.01, 10000, &err));
  assert_string_equal(cag_error_info(err.id)->reason, "triangle-limit");
  assert_non_null(strstr(err.message, "make them longer"));
  cag_curve_release(c);
}

// Values from the definition of sRGB: IEC 61966-2-1.
static void colors_are_read_in_any_case(void **state) {
  (void)state;
  static const char *const same[] = {"#008080", "teal", "TEAL", "Teal"};
  CagColor c;
  for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
    assert_true(cag_color_from_text(same[i], &c));
    assert_true(c.r == 0 && fabs(c.g - 0.21586050011389926) < 1e-12 && c.g == c.b);
  }
  CagColor upper;
  assert_true(cag_color_from_text("#AbF", &c) && cag_color_from_text("#aabbff", &upper));
  assert_true(c.r == upper.r && c.g == upper.g && c.b == 1);
  static const char *const none[] = {"#",    "#ab",  "#abcd", "#abcdefa", "#ggg", "#12:",
                                     "#12`", "#A@G", "tea",   "teals",    "",     "rebecca"};
  for (size_t i = 0; i < sizeof none / sizeof *none; i++)
    if (cag_color_from_text(none[i], &c)) fail_msg("`%s` is a color", none[i]);
}

static CagMesh *two_triangles(bool labels) {
  CagMesh *m;
  OK(cag_mesh_new(4, 2, false, false, labels, &m, &err));
  const CagVec3 p[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const uint32_t t[] = {0, 1, 2, 0, 3, 1};
  memcpy(m->positions, p, sizeof p);
  memcpy(m->triangles, t, sizeof t);
  return m;
}

// A mesh with infinite coordinates cannot be written.
static void meshes_without_finite_corners_are_refused(void **state) {
  (void)state;
  for (int axis = 0; axis < 4; axis++) {
    Fixture f;
    CagMesh *m = two_triangles(false), *out = NULL;
    CagError err = {0};
    fixture_begin(&f);
    if (axis < 3) (&m->positions[2].x)[axis] = INFINITY;
    f.items[0] = (CagItem){.kind = CAG_ITEM_MESH, .name = axis == 0 ? NULL : "cloth", .as.mesh = m};
    f.scene.item_count = 1;
    CagStatus status = cag_item_mesh(&f.scene, &f.items[0], &out, &err);
    if (axis == 3) assert_int_equal(status, CAG_OK);
    else {
      assert_int_equal(status, CAG_E_DEGENERATE);
      assert_string_equal(cag_error_info(err.id)->reason, "not-finite");
    }
    if (axis == 0) assert_non_null(strstr(err.message, "a shape"));
    if (axis == 1) assert_non_null(strstr(err.message, "cloth"));
    cag_mesh_release(out);
    cag_mesh_release(m);
  }
}

static void a_ground_is_not_a_mesh(void **state) {
  (void)state;
  Fixture f;
  CagMesh *m = NULL;
  CagError err = {0};
  CagBounds box;
  fixture_begin(&f);
  f.items[0] = (CagItem){.kind = CAG_ITEM_GROUND, .name = "ground", .ground_size = 100};
  f.scene.item_count = 1;
  assert_int_equal(cag_item_mesh(&f.scene, &f.items[0], &m, &err), CAG_E_ARGUMENT);
  OK(cag_item_bounds(&f.items[0], NULL, &box, &err));
  assert_true(box.min.x > box.max.x);
}

static void a_mesh_without_triangles_has_no_bounds(void **state) {
  (void)state;
  CagMesh *m;
  OK(cag_mesh_new(0, 0, false, false, false, &m, &err));
  CagItem item = {.kind = CAG_ITEM_MESH, .as.mesh = m};
  CagBounds box;
  CagError err = {0};
  assert_int_equal(cag_item_bounds(&item, NULL, &box, &err), CAG_E_DEGENERATE);
  assert_string_equal(cag_error_info(err.id)->reason, "empty-shape");
  cag_mesh_release(m);
}

static void an_unknown_view_is_an_error(void **state) {
  (void)state;
  CagScene s = {0};
  CagError err = {0};
  assert_int_equal(cag_scene_add_view(&s, "upside_down", &err), CAG_E_ARGUMENT);
  assert_string_equal(cag_error_info(err.id)->reason, "camera-unknown");
  assert_int_equal(s.camera_count, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_line_is_a_prism_along_it),
      cmocka_unit_test(dashes_fill_a_line_from_end_to_end),
      cmocka_unit_test(dashes_of_a_closed_curve_are_as_many_as_gaps),
      cmocka_unit_test(corners_are_filled_by_wedges),
      cmocka_unit_test(a_path_that_turns_back_has_a_ball),
      cmocka_unit_test(tubes_keep_the_limit_of_triangles),
      cmocka_unit_test(colors_are_read_in_any_case),
      cmocka_unit_test(meshes_without_finite_corners_are_refused),
      cmocka_unit_test(a_ground_is_not_a_mesh),
      cmocka_unit_test(a_mesh_without_triangles_has_no_bounds),
      cmocka_unit_test(an_unknown_view_is_an_error),
  };
  return cmocka_run_group_tests_name("scene", tests, NULL, NULL);
}
