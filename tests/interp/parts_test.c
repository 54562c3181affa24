// What a page is told of a script: its params, and the parts of its scene with their meshes and
// origins.

#include <math.h>

#include "tests/interp/session_support.h"

static void run_script(CagSession *s, const char *text) {
  if (cag_session_run_text(s, "page.cag", text, strlen(text)) != CAG_STATUS_OK) {
    cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr);
    fail_msg("%s", text);
  }
}

static void build_scene(CagSession *s, const char *text) {
  CagShownCounts counts;
  run_script(s, text);
  assert_int_equal(cag_session_scene(s, &counts), CAG_STATUS_OK);
}

// --- Identity of meshes ---

// The mesh of `show EXPRESSION`.
static CagMeshView mesh_of(CagSession *s, const char *before, const char *expression,
                           const char *after, double coarse) {
  char text[2048];
  CagMeshView m;
  snprintf(text, sizeof text, "show %s%s%s\n", before, expression, after);
  build_scene(s, text);
  assert_int_equal(cag_session_part_mesh(s, 0, coarse, NULL, NULL, &m), CAG_STATUS_OK);
  return m;
}

static void check_identity(CagSession *s, const char *shape, const char *other) {
  char before[33], again[33];
  CagMeshView m = mesh_of(s, "", shape, "", 1);
  memcpy(before, m.id, sizeof before);
  assert_true(m.vertex_count > 0);
  m = mesh_of(s, "", shape, "", 1);
  memcpy(again, m.id, sizeof again);
  if (strcmp(before, again) != 0) fail_msg("two runs of %s", shape);
  m = mesh_of(s, "", other, "", 1);
  if (!strcmp(before, m.id)) fail_msg("%s and %s", shape, other);
  m = mesh_of(s, "", shape, "", 8);
  if (!strcmp(before, m.id)) fail_msg("a coarse mesh of %s", shape);
  m = mesh_of(s, "scale(", shape, ", 2)", 1);
  if (!strcmp(before, m.id) && !m.placed) fail_msg("a larger %s", shape);
}

static void check_motion(CagSession *s, const char *shape) {
  char before[33];
  CagMeshView m = mesh_of(s, "", shape, "", 1);
  double still[3][4];
  memcpy(before, m.id, sizeof before);
  memcpy(still, m.placement, sizeof still);
  m = mesh_of(s, "rotate(translate(", shape, ", [5, 0, 0]), Z, 90deg)", 1);
  if (strcmp(before, m.id) != 0) fail_msg("%s was meshed again when it was moved", shape);
  assert_true(m.placed);
  // The turn maps x to y: a step by [5, 0, 0] becomes one by [0, 5, 0].
  const double x = still[0][3], y = still[1][3];
  assert_true(fabs(m.placement[0][3] - -y) < 1e-9);
  assert_true(fabs(m.placement[1][3] - (x + 5)) < 1e-9);
  assert_true(fabs(m.placement[1][0] - still[0][0]) < 1e-9);
}

static void equal_shapes_have_one_mesh(void **state) {
  (void)state;
  static const struct {
    const char *shape, *other; // which differs a little
    bool moves;                // its mesh stays when it is moved
  } ROWS[] = {
      {"line([0, 0, 0], [1, 2, 3])", "line([0, 0, 0], [1, 2, 3.1])", true},
      {"polyline([[0, 0, 0], [4, 0, 0], [4, 3, 1]])", "polyline([[0, 0, 0], [4, 0, 0], [4, 3, 2]])",
       true},
      {"circle(5)", "circle(5.001)", true},
      {"ellipse(5, 3)", "ellipse(5, 2)", true},
      {"helix(5, 2, 3)", "helix(5, 2.1, 3)", true},
      {"bspline([[0, 0, 0], [1, 4, 0], [3, 4, 2], [6, 0, 0], [8, 1, 1]])",
       "bspline([[0, 0, 0], [1, 4, 0], [3, 4, 2], [6, 0, 0], [8, 1, 2]])", true},
      {"bezier([[0, 0], [1, 4], [3, 4]])", "bezier([[0, 0], [1, 4], [3, 5]])", true},
      {"region(circle(5))", "region(circle(4))", true},
      {"region([circle(5), circle(2)])", "region([circle(5), circle(3)])", true},
      {"extrude(bezier([[0, 0], [1, 4], [3, 4]]), [0, 0, 5])",
       "extrude(bezier([[0, 0], [1, 4], [3, 4]]), [0, 0, 6])", true},
      {"revolve(polyline([[2, 0], [4, 5], [1, 7]]))", "revolve(polyline([[2, 0], [4, 5], [1, 8]]))",
       true},
      {"ruled(circle(5), translate(circle(3), [0, 0, 4]))",
       "ruled(circle(5), translate(circle(3), [0, 0, 5]))", true},
      {"loft([circle(5), translate(circle(3), [0, 0, 4]), translate(circle(4), [0, 0, 8])])",
       "loft([circle(5), translate(circle(3), [0, 0, 4]), translate(circle(4), [0, 0, 9])])", true},
      {"tube(helix(9, 4, 2), 1)", "tube(helix(9, 4, 2), 1.1)", true},
      {"box([1, 2, 3])", "box([1, 2, 3.5])", true},
      {"sphere(4)", "sphere(5)", true},
      {"cylinder(4, 2)", "cylinder(4, 2.5)", true},
      {"torus(5, 2)", "torus(5, 1)", true},
      {"prism(regular_polygon(5, 5), 6)", "prism(regular_polygon(6, 5), 6)", true},
      {"(box([9, 9, 9]) - sphere(4))", "(box([9, 9, 9]) - sphere(5))", true},
      {"tessellate(sphere(4))", "tessellate(sphere(3))", true},
  };
  CagSession *s = new_session();
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    check_identity(s, ROWS[i].shape, ROWS[i].other);
    if (ROWS[i].moves) check_motion(s, ROWS[i].shape);
  }
  cag_session_free(s);
}

static bool knows_all(void *context, const char *id) {
  ++*(int *)context;
  assert_int_equal(strlen(id), 32);
  return true;
}

static void a_known_mesh_is_not_made(void **state) {
  (void)state;
  CagSession *s = new_session();
  CagMeshView m;
  int asked = 0;
  build_scene(s, "show translate(sphere(4), [1, 2, 3])\n");
  assert_int_equal(cag_session_part_mesh(s, 0, 1, knows_all, &asked, &m), CAG_STATUS_OK);
  assert_int_equal(asked, 1);
  assert_null(m.positions);
  assert_true(m.placed);
  assert_true(m.placement[0][3] == 1 && m.placement[1][3] == 2 && m.placement[2][3] == 3);
  cag_session_free(s);
}

// --- Edges ---

static void creases_and_borders_are_edges(void **state) {
  (void)state;
  CagSession *s = new_session();
  assert_int_equal(mesh_of(s, "", "box([1, 2, 3])", "", 1).edge_count, 12);
  assert_int_equal(mesh_of(s, "", "sphere(4)", "", 1).edge_count, 0);
  assert_int_equal(mesh_of(s, "", "tessellate(box([1, 2, 3]))", "", 1).edge_count, 12);
  // The rims of a cylinder have as many edges as vertices: those of both circles.
  const CagMeshView m = mesh_of(s, "", "cylinder(4, 2)", "", 1);
  for (size_t i = 0; i < 2 * m.edge_count; i++) {
    const float *p = m.positions + 3 * m.edges[i];
    assert_true(fabs(hypot(p[0], p[1]) - 2) < 1e-5);
    assert_true(fabsf(p[2]) < 1e-6f || fabsf(p[2] - 4) < 1e-6f);
  }
  assert_true(m.edge_count >= 24);
  cag_session_free(s);
}

static void a_curve_is_a_line(void **state) {
  (void)state;
  CagSession *s = new_session();
  const CagMeshView m = mesh_of(s, "", "circle(5)", "", 1);
  assert_true(m.line);
  assert_int_equal(m.triangle_count, 0);
  assert_int_equal(m.edge_count, m.vertex_count - 1);
  for (size_t i = 0; i < m.vertex_count; i++)
    assert_true(fabs(hypot(m.positions[3 * i], m.positions[3 * i + 1]) - 5) < 1e-5);
  cag_session_free(s);
}

// --- Origins ---

static void expect_place(CagSession *s, size_t part, size_t k, const char *what, size_t line,
                         size_t column, size_t end_column, bool library) {
  const char *found = "";
  CagPlaceView p;
  assert_true(cag_session_part_place(s, part, k, &found, &p));
  assert_string_equal(found, what);
  assert_int_equal(p.library, library);
  if (library) return;
  assert_string_equal(p.file, "page.cag");
  assert_int_equal(p.line, line);
  assert_int_equal(p.column, column);
  assert_int_equal(p.end_column, end_column);
}

static void parts_know_the_calls_they_went_through(void **state) {
  (void)state;
  CagSession *s = new_session();
  const char *what;
  CagPlaceView p;
  build_scene(s, "lid = box([4, 4, 1])\n"
                 "high = translate(lid, [0, 0, 9])\n"
                 "show high |> material({color: \"teal\"})\n"
                 "show around(lid, 3)\n");
  expect_place(s, 0, 0, "show", 3, 6, 39, false);
  expect_place(s, 0, 1, "changed", 3, 6, 39, false);
  expect_place(s, 0, 2, "changed", 2, 8, 33, false);
  expect_place(s, 0, 3, "made", 1, 7, 21, false);
  assert_false(cag_session_part_place(s, 0, 4, &what, &p));
  for (size_t part = 1; part < 4; part++) {
    expect_place(s, part, 0, "show", 4, 6, 20, false);
    expect_place(s, part, 2, "made", 1, 7, 21, false);
  }
  cag_session_free(s);
}

static void the_users_call_comes_before_that_in_the_library(void **state) {
  (void)state;
  CagSession *s = new_session();
  build_scene(s, "import std.figures as fig\n"
                 "show fig.axes(0..5, 0..5)\n");
  expect_place(s, 0, 0, "show", 2, 6, 26, false);
  size_t k = 1;
  const char *what;
  CagPlaceView p;
  bool library = false;
  for (; cag_session_part_place(s, 0, k, &what, &p); k++) {
    if (p.library && !library) expect_place(s, 0, k - 1, what, 2, 6, 26, false);
    library = library || p.library;
  }
  assert_true(library);
  cag_session_free(s);
}

static void a_ground_has_no_story(void **state) {
  (void)state;
  CagSession *s = new_session();
  const char *what;
  CagPartView part;
  CagPlaceView p;
  build_scene(s, "show sphere(4)\n"); // in the studio, which has a floor
  assert_true(cag_session_part(s, 1, &part));
  assert_string_equal(part.type, "ground");
  assert_null(part.story);
  assert_false(cag_session_part_place(s, 1, 0, &what, &p));
  cag_session_free(s);
}

// --- Params ---

static void params_are_described(void **state) {
  (void)state;
  CagSession *s = new_session();
  CagParamView p;
  cag_session_define(s, "height", "150");
  run_script(s, "param height = 100 + 40 in 80..220 \"height, mm\"\n"
                "param turn = 30deg in 0deg..90deg\n"
                "param style = \"tall\" in [\"tall\", \"low\"]\n"
                "param open = true\n"
                "param glaze = \"#0b7d85\"\n"
                "param title = \"for you\"\n"
                "param at = [1, 2]\n"
                "show sphere(height)\n");
  assert_true(cag_session_param(s, 0, &p));
  assert_string_equal(p.name, "height");
  assert_string_equal(p.description, "height, mm");
  assert_string_equal(p.kind, "number");
  assert_string_equal(p.value, "150");
  assert_string_equal(p.initial, "100 + 40");
  assert_true(p.ranged && p.low == 80 && p.high == 220);
  assert_int_equal(p.place.line, 1);
  static const char *const KINDS[] = {"number", "angle", "choice", "bool",
                                      "color",  "text",  "other"};
  for (size_t i = 0; i < 7; i++) {
    assert_true(cag_session_param(s, i, &p));
    assert_string_equal(p.kind, KINDS[i]);
  }
  assert_false(cag_session_param(s, 7, &p));
  assert_true(cag_session_param(s, 1, &p));
  assert_true(p.low == 0 && p.high == 90);
  assert_string_equal(cag_session_param_choice(s, 2, 1), "\"low\"");
  assert_null(cag_session_param_choice(s, 2, 2));
  assert_false(cag_session_is_timed(s));
  cag_session_clear_defines(s);
  run_script(s, "show sphere(1 + time)\n");
  assert_true(cag_session_is_timed(s));
  cag_session_free(s);
}

static void params_of_a_script_that_fails_are_known(void **state) {
  (void)state;
  CagSession *s = new_session();
  CagParamView p;
  const char text[] = "param n = 3 in 1..9\nshow sphere(n / 0)\n";
  assert_int_equal(cag_session_run_text(s, "page.cag", text, sizeof text - 1), CAG_STATUS_SCRIPT);
  const size_t errors = cag_session_error_count(s);
  assert_true(cag_session_param(s, 0, &p));
  assert_string_equal(p.value, "3");
  assert_int_equal(cag_session_error_count(s), errors);
  cag_session_free(s);
}

static void a_ground_that_was_added_is_no_shape(void **state) {
  (void)state;
  CagSession *s = new_session();
  CagPartView part = {0};
  CagPlaceView place;
  const char *what;
  size_t i = 0;
  build_scene(s, "show tube(helix(9, 4, 2), 1)\n");
  while (cag_session_part(s, i, &part) && strcmp(part.type, "ground") != 0) i++;
  assert_string_equal(part.type, "ground");
  assert_null(part.story);
  assert_false(cag_session_part_place(s, i, 0, &what, &place));
  cag_session_free(s);
}

// --- Calls together ---

typedef struct Counted {
  CagSession *session;
  size_t parts;
  int status; // of the last mesh
} Counted;

static void count_parts(void *context) {
  Counted *c = context;
  CagPartView p;
  CagMeshView m;
  for (c->parts = 0; cag_session_part(c->session, c->parts, &p); c->parts++) {
    if (!strcmp(p.type, "ground")) break;
    c->status = cag_session_part_mesh(c->session, c->parts, 1, NULL, NULL, &m);
    if (c->status != CAG_STATUS_OK) break;
    assert_int_equal(strncmp(p.story, "sphere, radius 2", 16), 0);
  }
  assert_int_equal(cag_session_run_text(c->session, "other.cag", "", 0), CAG_STATUS_USAGE);
}

static void free_at_once(void *context) {
  Counted *c = context;
  cag_session_free(c->session);
  count_parts(c); // the session still exists
}

static void calls_together_are_like_others(void **state) {
  (void)state;
  volatile int interrupt = 0;
  CagSessionOptions options = session_options();
  options.interrupt = &interrupt;
  CagSession *s = cag_session_new(&options);
  Counted c = {.session = s, .status = -1};
  build_scene(s, "show [for i in 1..20: translate(sphere(2), [5*i, 0, 0])]\n");
  cag_session_together(s, count_parts, &c);
  assert_int_equal(c.parts, 20);
  assert_int_equal(c.status, CAG_STATUS_OK);
  interrupt = 1; // before them: the first one ends
  cag_session_together(s, count_parts, &c);
  assert_int_equal(c.parts, 0);
  assert_int_equal(c.status, CAG_STATUS_INTERRUPTED);
  interrupt = 0;
  cag_session_together(s, free_at_once, &c);
  assert_int_equal(c.parts, 20);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(equal_shapes_have_one_mesh),
      cmocka_unit_test(a_known_mesh_is_not_made),
      cmocka_unit_test(creases_and_borders_are_edges),
      cmocka_unit_test(a_curve_is_a_line),
      cmocka_unit_test(parts_know_the_calls_they_went_through),
      cmocka_unit_test(the_users_call_comes_before_that_in_the_library),
      cmocka_unit_test(a_ground_has_no_story),
      cmocka_unit_test(params_are_described),
      cmocka_unit_test(params_of_a_script_that_fails_are_known),
      cmocka_unit_test(calls_together_are_like_others),
      cmocka_unit_test(a_ground_that_was_added_is_no_shape),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
