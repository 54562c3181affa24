// The points of parts that can be dragged: where they are in the scene, where their numbers stand
// in the script, and which params move them.

#include <math.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/interp/session_support.h"

static size_t find_points(CagSession *s, const char *text, size_t part) {
  CagShownCounts counts;
  size_t n, omitted;
  if (cag_session_run_text(s, "page.cag", text, strlen(text)) != CAG_STATUS_OK ||
      cag_session_scene(s, &counts) != CAG_STATUS_OK) {
    cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr);
    fail_msg("%s", text);
  }
  assert_int_equal(cag_session_points(s, part, &n, &omitted), CAG_STATUS_OK);
  return n;
}

// The text at a place of one line.
static void expect_text(const char *script, const CagPlaceView *p, const char *expected) {
  const char *line = script;
  assert_int_equal(p->line, p->end_line);
  for (size_t i = 1; i < p->line; i++) line = strchr(line, '\n') + 1;
  char found[64];
  snprintf(found, sizeof found, "%.*s", (int)(p->end_column - p->column), line + p->column - 1);
  assert_string_equal(found, expected);
}

static void expect_at(const CagPointView *p, double x, double y, double z) {
  const double expected[3] = {x, y, z};
  for (int i = 0; i < 3; i++)
    if (!(fabs(p->at[i] - expected[i]) < 1e-9))
      fail_msg("%s: found [%g, %g, %g], expected [%g, %g, %g]", p->call, p->at[0], p->at[1],
               p->at[2], x, y, z);
}

// A point of a script, with the texts of its numbers; "": it is computed.
typedef struct Row {
  const char *script;
  size_t count, point;
  const char *call;
  double at[3];
  const char *numbers[3];
} Row;

static void check_row(CagSession *s, const Row *row) {
  CagPointView p;
  const size_t n = find_points(s, row->script, 0);
  if (n != row->count) fail_msg("%zu points, not %zu: %s", n, row->count, row->script);
  assert_true(cag_session_point(s, row->point, &p));
  assert_string_equal(p.call, row->call);
  expect_at(&p, row->at[0], row->at[1], row->at[2]);
  for (int k = 0; k < 3; k++) {
    const bool literal = row->numbers[k] && row->numbers[k][0];
    if (p.numbers[k].literal != literal) fail_msg("coordinate %d of %s", k, row->script);
    if (literal) expect_text(row->script, &p.numbers[k].place, row->numbers[k]);
  }
}

static void numbers_are_found_in_the_script(void **state) {
  (void)state;
  static const Row ROWS[] = {
      // Layouts
      {"show polyline([[0, 0], [40, 10]])\n", 2, 1, "polyline", {40, 10, 0}, {"40", "10"}},
      {"show polyline([\n  [0, 0], // one\n  [4.5, /* two */ 6],\n])\n",
       2,
       1,
       "polyline",
       {4.5, 6, 0},
       {"4.5", "6"}},
      {"show polyline([[0, 0], ([(7), -8])])\n", 2, 1, "polyline", {7, -8, 0}, {"7", "-8"}},
      {"show [[0, 0], [1, 2]] |> polyline()\n", 2, 1, "polyline", {1, 2, 0}, {"1", "2"}},
      {"show polyline(closed: true, points: [[0, 0], [1, 0], [1, 5]])\n",
       3,
       2,
       "polyline",
       {1, 5, 0},
       {"1", "5"}},
      // Units and signs
      {"show polyline([[0, 0], [2.5cm, -3mm]])\n",
       2,
       1,
       "polyline",
       {25, -3, 0},
       {"2.5cm", "-3mm"}},
      {"show polyline([[0, 0], [1in, -0.5ft]])\n",
       2,
       1,
       "polyline",
       {25.4, -152.4, 0},
       {"1in", "-0.5ft"}},
      {"show polyline([[0, 0], [1e1, - 1_000um]])\n",
       2,
       1,
       "polyline",
       {10, -1, 0},
       {"1e1", "- 1_000um"}},
      {"show polyline([[0, 0], [- /* no */ 3, 2]])\n", 2, 1, "polyline", {-3, 2, 0}, {"", "2"}},
      // Names
      {"pts = [[0, 0], [3, 4]]\nshow polyline(pts)\n", 2, 1, "polyline", {3, 4, 0}, {"3", "4"}},
      {"p = [3, 4]\npts = [[0, 0], p]\nshow polyline(pts)\n",
       2,
       1,
       "polyline",
       {3, 4, 0},
       {"3", "4"}},
      {"a = [[0, 0], [1, 1]]\nshow polyline([...a, [5, 6]])\n",
       3,
       2,
       "polyline",
       {5, 6, 0},
       {"5", "6"}},
      {"a = [for k in 0..3: [k, 2]]\nshow polyline([[9, 9], ...a, [5, 6]])\n",
       6,
       5,
       "polyline",
       {5, 6, 0},
       {"5", "6"}},
      {"a = [[0, 0], [1, 1]]\nshow polyline([a[1], [5, 6]])\n",
       2,
       0,
       "polyline",
       {1, 1, 0},
       {"1", "1"}},
      {"w = 5\nshow polyline([[0, 0], [w, 6]])\n", 2, 1, "polyline", {5, 6, 0}, {"", "6"}},
      {"show polyline([[0, 0], [2 + 3, 6]])\n", 2, 1, "polyline", {5, 6, 0}, {"", "6"}},
      {"show polyline({ p = [1, 2]; [[0, 0], p] })\n", 2, 1, "polyline", {1, 2, 0}, {"1", "2"}},
      // Comprehensions and functions
      {"show polyline([for k in 0..2: [k, 7]])\n", 3, 2, "polyline", {2, 7, 0}, {"", "7"}},
      {"show polyline([for k in 0..4 if k > 1: [k, 7]])\n", 3, 2, "polyline", {4, 7, 0}, {"", "7"}},
      {"leg(h) = polyline([[0, 0], [12, h]])\nshow leg(30)\n",
       2,
       1,
       "polyline",
       {12, 30, 0},
       {"12", ""}},
      {"f(pts) = polyline(pts)\nshow f([[0, 0], [1, 2]])\n", 2, 1, "polyline", {1, 2, 0}, {NULL}},
      {"f = polyline\nshow f([[0, 0], [1, 2]])\n", 2, 1, "polyline", {1, 2, 0}, {NULL}},
      // Kinds of curves and surfaces
      {"show bspline([[0, 0, 1], [1, 2, 3], [4, 4, 4], [9, 8, 7]])\n",
       4,
       3,
       "bspline",
       {9, 8, 7},
       {"9", "8", "7"}},
      {"show bezier([[0, 0], [1, 2], [4, 4]])\n", 3, 1, "bezier", {1, 2, 0}, {"1", "2"}},
      {"show interpolate([[0, 0], [1, 2], [4, 4], [5, 5]])\n",
       4,
       1,
       "interpolate",
       {1, 2, 0},
       {"1", "2"}},
      {"show line([0, 0], [1, 2])\n", 2, 1, "line", {1, 2, 0}, {"1", "2"}},
      {"row = [[0, 9, 0], [5, 9, 1]]\nshow bezier_surface([[[0, 0, 0], [5, 0, 0]], row])\n",
       4,
       3,
       "bezier_surface",
       {5, 9, 1},
       {"5", "9", "1"}},
      {"show polygon([[0, 0], [9, 0], [0, 9]]) |> extrude(4)\n",
       3,
       1,
       "polygon",
       {9, 0, 0},
       {"9", "0"}},
      {"show extrude([[0, 0], [9, 0], [0, 9]], 4)\n", 3, 2, "extrude", {0, 9, 0}, {"0", "9"}},
  };
  CagSession *s = new_session();
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) check_row(s, &ROWS[i]);
  // Columns are counted in characters.
  CagPointView p;
  find_points(s, "/* \xc3\xa9\xc3\xa9 */ show line([0, 0], [1, 2])\n", 0);
  assert_true(cag_session_point(s, 1, &p));
  assert_int_equal(p.numbers[0].place.column, strlen("/* ee */ show line([0, 0], [1"));
  cag_session_free(s);
}

static void points_are_where_their_shape_is(void **state) {
  (void)state;
  static const Row ROWS[] = {
      {"show polyline([[0, 0], [4, 1]]) |> rotate(Z, 90deg) |> translate([100, 0, 5])\n",
       3,
       2,
       "polyline",
       {99, 4, 5},
       {"4", "1"}},
      {"show polyline([[0, 0], [4, 1]]) |> rotate(Z, 90deg) |> translate([100, 0, 5])\n",
       3,
       0,
       "translate",
       {100, 0, 5},
       {"100", "0", "5"}},
      {"show translate(translate(sphere(4), [1, 2, 3]), [10, 0, 0])\n",
       2,
       1,
       "translate",
       {11, 2, 3},
       {"1", "2", "3"}},
      {"show translate([7, 0]) * polyline([[0, 0], [4, 1]])\n",
       2,
       1,
       "polyline",
       {11, 1, 0},
       {"4", "1"}},
      {"show scale(translate([7, 0]) * polyline([[0, 0], [4, 1]]), 2)\n",
       2,
       1,
       "polyline",
       {22, 2, 0},
       {"4", "1"}},
      // A revolution places the plane upright.
      {"show revolve(polyline([[2, 0], [4, 5], [1, 7]]))\n",
       3,
       1,
       "polyline",
       {4, 0, 5},
       {"4", "5"}},
      {"show revolve(polyline([[2, 0], [4, 5], [1, 7]])) |> translate([0, 30, 0])\n",
       4,
       2,
       "polyline",
       {4, 30, 5},
       {"4", "5"}},
      {"show revolve(translate(polyline([[2, 0], [4, 5], [1, 7]]), [3, 0]))\n",
       4,
       2,
       "polyline",
       {7, 0, 5},
       {"4", "5"}},
      {"show revolve(polyline([[0, 2, 0], [0, 4, 5]]), X)\n",
       2,
       1,
       "polyline",
       {0, 4, 5},
       {"0", "4", "5"}},
      // All operands of set operations and lofts
      {"show box([9, 9, 9]) - translate(sphere(4), [1, 2, 3])\n",
       1,
       0,
       "translate",
       {1, 2, 3},
       {"1", "2", "3"}},
      {"show translate(union(sphere(2), translate(sphere(4), [1, 2, 3])), [0, 0, 50])\n",
       2,
       1,
       "translate",
       {1, 2, 53},
       {"1", "2", "3"}},
      {"show loft([circle(5), translate(circle(3), [0, 0, 4]), translate(circle(4), [0, 0, 8])])\n",
       2,
       1,
       "translate",
       {0, 0, 8},
       {"0", "0", "8"}},
      {"show tube(bspline([[0, 0, 0], [5, 0, 9], [9, 0, 0], [20, 0, 1]]), 1)\n",
       4,
       1,
       "bspline",
       {5, 0, 9},
       {"5", "0", "9"}},
      // A section is moved along the path, so its points are nowhere.
      {"show sweep(polygon([[0, 0], [1, 0], [0, 1]]), bezier([[0, 0, 0], [5, 0, 9], [9, 0, 0]]))\n",
       3,
       1,
       "bezier",
       {5, 0, 9},
       {"5", "0", "9"}},
      // Many steps
      {"show polyline([[0, 0], [4, 1]]) |> translate([1, 0]) |> translate([1, 0]) |> translate([1, "
       "0]) |> translate([1, 0]) |> translate([1, 0]) |> translate([1, 0]) |> translate([1, 0]) |> "
       "translate([1, 0]) |> translate([1, 0]) |> translate([1, 0]) |> translate([1, 0]) |> "
       "translate([1, 0]) |> translate([1, 0]) |> translate([1, 0]) |> translate([1, 0])\n",
       14,
       13,
       "polyline",
       {19, 1, 0},
       {"4", "1"}},
  };
  CagSession *s = new_session();
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) check_row(s, &ROWS[i]);
  cag_session_free(s);
}

static void the_map_leads_from_numbers_to_the_scene(void **state) {
  (void)state;
  CagSession *s = new_session();
  CagPointView p;
  find_points(s, "show polyline([[0, 0], [2cm, 1]]) |> rotate(X, 90deg) |> scale(3)\n", 0);
  assert_true(cag_session_point(s, 1, &p));
  assert_int_equal(p.dimension, 2);
  // y of the script is z of the scene, three times as large.
  const double expected[3][4] = {{3, 0, 0, 0}, {0, 0, -3, 0}, {0, 3, 0, 0}};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++) assert_true(fabs(p.map[i][j] - expected[i][j]) < 1e-12);
  assert_string_equal(p.numbers[0].unit, "cm");
  assert_true(p.numbers[0].scale == 10 && p.numbers[0].value == 20);
  assert_true(p.numbers[1].scale == 1 && !p.numbers[1].unit[0]);
  cag_session_free(s);
}

static void each_copy_has_the_same_numbers(void **state) {
  (void)state;
  CagSession *s = new_session();
  const char *script =
      "p = polyline([[0, 0], [4, 1]])\nshow [for k in 0..2: translate(p, [k, 0])]\n";
  CagPointView p;
  for (size_t part = 0; part < 3; part++) {
    assert_int_equal(find_points(s, script, part), 3);
    assert_true(cag_session_point(s, 2, &p));
    expect_at(&p, 4 + (double)part, 1, 0);
    expect_text(script, &p.numbers[0].place, "4");
    assert_true(cag_session_point(s, 0, &p));
    assert_false(p.numbers[0].literal);
    expect_text(script, &p.numbers[1].place, "0");
  }
  cag_session_free(s);
}

// --- Locks ---

static void expect_lock(CagSession *s, const char *script, size_t point, const char *reason) {
  CagPointView p;
  find_points(s, script, 0);
  assert_true(cag_session_point(s, point, &p));
  if (!p.locked || !strstr(p.locked, reason))
    fail_msg("%s: %s", script, p.locked ? p.locked : "not locked");
}

static void what_cannot_move_has_a_reason(void **state) {
  (void)state;
  CagSession *s = new_session();
  expect_lock(s, "show polyline([[0, 0], [cos(1rad), sin(1rad)]])\n", 1,
              "`[cos(1rad), sin(1rad)]`");
  expect_lock(s, "w = 3\nshow polyline([[0, 0], [w, w]])\n", 1, "`[w, w]`");
  expect_lock(s, "f(pts) = polyline(pts)\nshow f([[0, 0], [1, 2]])\n", 1, "computed");
  expect_lock(s, "param w = 3\nshow polyline([[0, 0], [w, w]])\n", 1, "without a param");
  expect_lock(s,
              "show polyline([[0, 0], [1, 2]]) |> translate([0, 0, 5]) |> "
              "project(plane([0, 0, 0], [0, 0, 1]), from: [0, 0, 20])\n",
              1, "perspective");
  cag_session_free(s);
}

static void imported_lists_are_followed(void **state) {
  (void)state;
  char folder[] = "/tmp/cag-points-XXXXXX", path[64];
  assert_non_null(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/outline.cag", folder);
  FILE *f = fopen(path, "w");
  fputs("// An outline.\npts = [[0, 0], [8, 9]]\n", f);
  fclose(f);
  CagSessionOptions o = session_options();
  o.folder = folder;
  CagSession *s = cag_session_new(&o);
  const char *scripts[] = {"import outline: pts\nshow polyline(pts)\n",
                           "import outline\nshow polyline(outline.pts)\n"};
  for (int i = 0; i < 2; i++) {
    CagPointView p;
    assert_int_equal(find_points(s, scripts[i], 0), 2);
    assert_true(cag_session_point(s, 1, &p));
    assert_true(p.numbers[0].literal && p.numbers[0].place.line == 2);
    assert_non_null(strstr(p.numbers[0].place.file, "outline.cag"));
  }
  cag_session_free(s);
  unlink(path);
  rmdir(folder);
}

static void of_many_points_those_that_move_come_first(void **state) {
  (void)state;
  CagSession *s = new_session();
  CagShownCounts counts;
  CagPointView p;
  size_t n, omitted, locked = 0;
  const char *script = "show polyline([...[for k in 1..500: [k, k * k]], [3, 4]])\n";
  assert_int_equal(cag_session_run_text(s, "page.cag", script, strlen(script)), CAG_STATUS_OK);
  assert_int_equal(cag_session_scene(s, &counts), CAG_STATUS_OK);
  assert_int_equal(cag_session_points(s, 0, &n, &omitted), CAG_STATUS_OK);
  assert_int_equal(n + omitted, 501);
  assert_true(n <= CAG_POINTS_MAX);
  for (size_t i = 0; i < n; i++) {
    assert_true(cag_session_point(s, i, &p));
    locked += p.locked != NULL;
  }
  assert_int_equal(locked, n - 1);
  assert_int_equal(p.id, 500);
  cag_session_free(s);
}

// --- Params ---

static const char PARAMS[] = "param h = 20 in 0..50\n"
                             "param w = 5 in 1..9\n"
                             "param turn = 30deg in 0deg..90deg\n"
                             "param free = 3\n"
                             "param n = 3 in 2..9\n"
                             "tip = polar(10, turn)\n"
                             "show polyline([[0, 0], [w, h], [2, h + w], tip, [free, 1],\n"
                             "               ...[for k in 1..n: [k, 9]]])\n";

static void params_that_move_a_point_are_found(void **state) {
  (void)state;
  static const char *const EXPECTED[][3] = {
      {NULL}, {"h", "w", NULL}, {"h", "w", NULL}, {"turn", NULL}, {NULL}};
  CagSession *s = new_session();
  CagPointView p;
  assert_int_equal(find_points(s, PARAMS, 0), 8);
  for (size_t i = 0; i < 5; i++) {
    assert_true(cag_session_point(s, i, &p));
    for (size_t k = 0; k <= p.param_count; k++) {
      const char *name = cag_session_point_param(s, i, k);
      if (!EXPECTED[i][k]) assert_null(name);
      else assert_string_equal(name, EXPECTED[i][k]);
    }
  }
  // The run is as it was.
  CagParamView param;
  assert_true(cag_session_param(s, 0, &param));
  assert_string_equal(param.value, "20");
  cag_session_free(s);
}

typedef struct Found {
  char names[4][16];
  double values[4];
  size_t count;
} Found;

static void note_value(void *context, const char *name, const char *value) {
  Found *f = context;
  snprintf(f->names[f->count], sizeof f->names[0], "%s", name);
  f->values[f->count++] = atof(value);
}

static void params_are_solved_for(void **state) {
  (void)state;
  CagSession *s = new_session();
  const char *names[] = {"h", "w"}, *turn[] = {"turn"}, *unknown[] = {"free"};
  double at[3];
  Found f = {0};
  find_points(s, PARAMS, 0);
  CagPointGoal goal = {
      .point = 1, .target = {7, 31}, .tolerance = 0.05, .names = names, .count = 2};
  assert_int_equal(cag_session_solve_point(s, &goal, note_value, &f, at), CAG_STATUS_OK);
  assert_int_equal(f.count, 2);
  assert_true(fabs(f.values[0] - 31) < 0.05 && fabs(f.values[1] - 7) < 0.05);
  assert_true(fabs(at[0] - 7) < 0.05 && fabs(at[1] - 31) < 0.05);
  // Beyond the range, h stays at its end.
  f = (Found){0};
  goal.target[1] = 70;
  assert_int_equal(cag_session_solve_point(s, &goal, note_value, &f, at), CAG_STATUS_OK);
  assert_true(f.values[0] == 50 && fabs(f.values[1] - 7) < 0.05);
  // 10 (cos a, sin a) is closest to the direction of the target.
  f = (Found){0};
  goal =
      (CagPointGoal){.point = 3, .target = {20, 20}, .tolerance = 0.01, .names = turn, .count = 1};
  assert_int_equal(cag_session_solve_point(s, &goal, note_value, &f, at), CAG_STATUS_OK);
  assert_true(fabs(f.values[0] - 45) < 0.1);
  goal.names = unknown;
  assert_int_equal(cag_session_solve_point(s, &goal, note_value, &f, at), CAG_STATUS_USAGE);
  goal.names = turn;
  goal.point = 99;
  assert_int_equal(cag_session_solve_point(s, &goal, note_value, &f, at), CAG_STATUS_USAGE);
  goal.part = 7;
  assert_int_equal(cag_session_solve_point(s, &goal, note_value, &f, at), CAG_STATUS_USAGE);
  cag_session_free(s);
}

// The vertical line of the point is seen from above at an angle: what matters is the picture.
static void the_line_of_sight_does_not_count(void **state) {
  (void)state;
  CagSession *s = new_session();
  const char *names[] = {"h"};
  const double c = sqrt(0.5);
  double at[3];
  Found f = {0};
  find_points(s, "param h = 2 in 0..50\nshow sphere(1) |> translate([0, 0, h])\n", 0);
  // From [0, 0, 2], 10 up in the picture.
  const CagPointGoal goal = {.target = {0, 10 * c, 2 + 10 * c},
                             .ignored = {{0, c, -c}},
                             .tolerance = 0.01,
                             .names = names,
                             .count = 1};
  assert_int_equal(cag_session_solve_point(s, &goal, note_value, &f, at), CAG_STATUS_OK);
  assert_true(fabs(f.values[0] - (2 + 10 / c)) < 0.02);
  cag_session_free(s);
}

// The numbers of a point take care of their directions, wherever they are.
static void directions_of_numbers_do_not_count(void **state) {
  (void)state;
  CagSession *s = new_session();
  CagPointView p;
  const char *names[] = {"h"};
  double at[3];
  Found f = {0};
  find_points(s, "param h = 2 in 0..50\nshow sphere(1) |> translate([7, 8, h])\n", 0);
  assert_true(cag_session_point(s, 0, &p));
  assert_true(!p.moved[0] && !p.moved[1] && p.moved[2]);
  const CagPointGoal goal = {.target = {100, -100, 30},
                             .ignored = {{3, 0, 0}, {5, 5, 0}},
                             .tolerance = 0.01,
                             .names = names,
                             .count = 1};
  assert_int_equal(cag_session_solve_point(s, &goal, note_value, &f, at), CAG_STATUS_OK);
  assert_true(fabs(f.values[0] - 30) < 0.02);
  cag_session_free(s);
}

static void parts_without_points_have_none(void **state) {
  (void)state;
  CagSession *s = new_session();
  size_t n, omitted;
  CagPointView p;
  assert_int_equal(cag_session_points(s, 0, &n, &omitted), CAG_STATUS_USAGE);
  assert_int_equal(find_points(s, "show sphere(3), ground(0)\n", 0), 0);
  assert_false(cag_session_point(s, 0, &p));
  assert_null(cag_session_point_param(s, 0, 0));
  assert_int_equal(cag_session_points(s, 1, &n, &omitted), CAG_STATUS_USAGE);
  assert_int_equal(cag_session_points(s, 9, &n, &omitted), CAG_STATUS_USAGE);
  cag_session_free(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(numbers_are_found_in_the_script),
      cmocka_unit_test(points_are_where_their_shape_is),
      cmocka_unit_test(the_map_leads_from_numbers_to_the_scene),
      cmocka_unit_test(each_copy_has_the_same_numbers),
      cmocka_unit_test(what_cannot_move_has_a_reason),
      cmocka_unit_test(imported_lists_are_followed),
      cmocka_unit_test(of_many_points_those_that_move_come_first),
      cmocka_unit_test(params_that_move_a_point_are_found),
      cmocka_unit_test(params_are_solved_for),
      cmocka_unit_test(the_line_of_sight_does_not_count),
      cmocka_unit_test(directions_of_numbers_do_not_count),
      cmocka_unit_test(parts_without_points_have_none),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
