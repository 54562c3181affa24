// What a page asks about the shapes that others were made of: the sources of the faces of set
// operations, and ghosts.

#include <math.h>
#include <stdlib.h>

#include "tests/interp/session_support.h"

static void build_scene(CagSession *s, const char *text) {
  CagShownCounts counts;
  if (cag_session_run_text(s, "page.cag", text, strlen(text)) != CAG_STATUS_OK ||
      cag_session_scene(s, &counts) != CAG_STATUS_OK) {
    cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr);
    fail_msg("%s", text);
  }
}

// --- Sources of faces ---

typedef struct Faces {
  CagFacesView view;
  CagMeshView mesh;
  float *positions;
  uint32_t *triangles;
} Faces;

static Faces faces_of(CagSession *s) {
  Faces f;
  assert_int_equal(cag_session_part_mesh(s, 0, 1, NULL, NULL, &f.mesh), CAG_STATUS_OK);
  const size_t points = 3 * f.mesh.vertex_count * sizeof *f.positions,
               corners = 3 * f.mesh.triangle_count * sizeof *f.triangles;
  f.positions = malloc(points);
  f.triangles = malloc(corners);
  memcpy(f.positions, f.mesh.positions, points);
  memcpy(f.triangles, f.mesh.triangles, corners);
  assert_int_equal(cag_session_part_faces(s, 0, &f.view), CAG_STATUS_OK);
  assert_string_equal(f.view.id, f.mesh.id);
  assert_int_equal(f.view.triangle_count, f.mesh.triangle_count);
  return f;
}

static void free_faces(Faces *f) {
  free(f->positions);
  free(f->triangles);
}

static void center_of(const Faces *f, size_t t, double out[3]) {
  for (int i = 0; i < 3; i++) {
    out[i] = 0;
    for (size_t k = 0; k < 3; k++)
      out[i] += (double)f->positions[3 * f->triangles[3 * t + k] + (uint32_t)i] / 3;
  }
}

static void expect_source(CagSession *s, size_t source, size_t k, const char *what, size_t line,
                          size_t column) {
  const char *found = "";
  CagPlaceView p;
  assert_true(cag_session_source_place(s, 0, source, k, &found, &p));
  assert_string_equal(found, what);
  assert_int_equal(p.line, line);
  assert_int_equal(p.column, column);
}

static void faces_know_their_operands(void **state) {
  (void)state;
  CagSession *s = new_session();
  build_scene(s, "block = box([40, 40, 10], centered: true)\n"
                 "hole = cylinder(20, 8, centered: true)\n"
                 "show translate(block - translate(hole, [5, 0, 0]), [0, 0, 30])\n");
  assert_string_equal(cag_session_part_source(s, 0, 0), "block");
  assert_string_equal(cag_session_part_source(s, 0, 1), "");
  assert_null(cag_session_part_source(s, 0, 2));
  expect_source(s, 0, 0, "made", 1, 9);
  expect_source(s, 1, 0, "changed", 3, 24);
  expect_source(s, 1, 1, "made", 2, 8);
  Faces f = faces_of(s);
  assert_int_equal(f.view.operand_count, 2);
  size_t inside = 0;
  for (size_t t = 0; t < f.view.triangle_count; t++) {
    double c[3];
    center_of(&f, t, c);
    // The faces of the hole are inside of its cylinder, whose axis is at x = 5.
    const bool hole = hypot(c[0] - 5, c[1]) < 8 - 1e-6;
    assert_int_equal(f.view.operands[t], hole ? 1 : 0);
    inside += hole;
  }
  assert_true(inside > 8 && inside < f.view.triangle_count);
  free_faces(&f);
  cag_session_free(s);
}

static void operands_of_a_loop_are_one_source(void **state) {
  (void)state;
  CagSession *s = new_session();
  build_scene(s, "holes = [for i in 0..3: translate(cylinder(9, 2), [10 * i, 5, -1])]\n"
                 "show box([40, 10, 5]) - holes\n");
  assert_string_equal(cag_session_part_source(s, 0, 1), "holes");
  assert_null(cag_session_part_source(s, 0, 2));
  Faces f = faces_of(s);
  assert_int_equal(f.view.operand_count, 5);
  bool seen[5] = {false};
  for (size_t t = 0; t < f.view.triangle_count; t++) seen[f.view.operands[t]] = true;
  for (size_t i = 0; i < 5; i++) {
    assert_true(seen[i]);
    assert_int_equal(f.view.sources[i], i > 0);
  }
  free_faces(&f);
  cag_session_free(s);
}

static void nested_operations_tell_the_calls_around_an_operand(void **state) {
  (void)state;
  CagSession *s = new_session();
  build_scene(s, "part = rotate(box([9, 9, 9]) - sphere(4), Z, 30deg)\n"
                 "lid = cylinder(2, 3)\n"
                 "show part | translate(lid, [4, 4, 9])\n");
  expect_source(s, 0, 0, "combined", 1, 8);
  expect_source(s, 0, 1, "combined", 1, 15);
  expect_source(s, 0, 2, "made", 1, 15);
  expect_source(s, 1, 2, "made", 1, 32);
  expect_source(s, 2, 0, "changed", 3, 13);
  Faces f = faces_of(s);
  bool seen[3] = {false};
  for (size_t t = 0; t < f.view.triangle_count; t++) {
    double c[3];
    center_of(&f, t, c);
    seen[f.view.operands[t]] = true;
    if (c[2] > 9 + 1e-6) assert_int_equal(f.view.operands[t], 2);
    if (hypot(hypot(c[0], c[1]), c[2]) < 4 - 1e-6) assert_int_equal(f.view.operands[t], 1);
  }
  assert_true(seen[0] && seen[1] && seen[2]);
  free_faces(&f);
  cag_session_free(s);
}

static void a_loop_that_subtracts_keeps_its_origins(void **state) {
  (void)state;
  CagSession *s = new_session();
  build_scene(s,
              "cut(body, n) = if n == 0 then body else cut(body - translate(sphere(1), [3 * n, 0, "
              "0]), n - 1)\n"
              "show cut(box([40, 4, 4]), 10)\n");
  expect_source(s, 0, 0, "made", 2, 10);
  expect_source(s, 1, 1, "made", 1, 62);
  assert_null(cag_session_part_source(s, 0, 2));
  Faces f = faces_of(s);
  assert_int_equal(f.view.operand_count, 11);
  free_faces(&f);
  cag_session_free(s);
}

static void parts_without_operands_have_no_sources(void **state) {
  (void)state;
  CagSession *s = new_session();
  CagFacesView v;
  build_scene(s, "show sphere(3)\n");
  assert_null(cag_session_part_source(s, 0, 0));
  assert_int_equal(cag_session_part_faces(s, 0, &v), CAG_STATUS_USAGE);
  assert_null(cag_session_part_source(s, 7, 0));
  build_scene(s, "show sphere(3) | sphere(3)\n");
  assert_string_equal(cag_session_part_source(s, 0, 0), "");
  cag_session_free(s);
}

// --- Ghosts ---

typedef struct Seen {
  size_t count;
  CagGhostView last; // its texts are not valid any more
  char type[16], motion[16];
  double low[3], high[3]; // of the mesh, placed
} Seen;

static void see(void *context, const CagGhostView *g, const CagMeshView *m) {
  Seen *seen = context;
  seen->count++;
  seen->last = *g;
  snprintf(seen->type, sizeof seen->type, "%s", g->type);
  snprintf(seen->motion, sizeof seen->motion, "%s", g->motion ? g->motion : "");
  for (int i = 0; i < 3; i++) seen->low[i] = INFINITY, seen->high[i] = -INFINITY;
  for (size_t v = 0; v < m->vertex_count; v++)
    for (int i = 0; i < 3; i++) {
      const double *row = m->placement[i];
      const float *p = m->positions + 3 * v;
      const double x =
          row[0] * (double)p[0] + row[1] * (double)p[1] + row[2] * (double)p[2] + row[3];
      seen->low[i] = fmin(seen->low[i], x);
      seen->high[i] = fmax(seen->high[i], x);
    }
}

// The ghosts of the text between two marks `^` in the script, which are removed.
static Seen ghosts_of(CagSession *s, const char *script) {
  char text[1024];
  size_t n = 0, line = 1, column = 1, found_line = 0, found_column = 0;
  for (const char *at = script; *at; at++) {
    if (*at == '^') {
      found_line = line;
      found_column = column;
      continue;
    }
    text[n++] = *at;
    if (*at == '\n') line++, column = 1;
    else column++;
  }
  text[n] = 0;
  build_scene(s, text);
  Seen seen = {0};
  const int status = cag_session_ghosts(s, "page.cag", found_line, found_column, NULL, see, &seen);
  if (status != CAG_STATUS_OK) {
    cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr);
    fail_msg("status %d of %s", status, script);
  }
  return seen;
}

static void expect_box(const Seen *seen, const double low[3], const double high[3]) {
  for (int i = 0; i < 3; i++) {
    if (!(fabs(seen->low[i] - low[i]) < 0.05) || !(fabs(seen->high[i] - high[i]) < 0.05))
      fail_msg("the box has %g..%g along axis %d", seen->low[i], seen->high[i], i);
  }
}

static void an_operand_is_shown_where_it_is_used(void **state) {
  (void)state;
  CagSession *s = new_session();
  const double low[3] = {-2, -2, 30}, high[3] = {2, 2, 39};
  static const char *const SCRIPTS[] = {
      "show translate(box([9, 9, 9]) - cyli^nder(9, 2), [0, 0, 30])\n",
      "c = cylinder(9, 2)\nshow translate(box([9, 9, 9]) - ^c, [0, 0, 30])\n",
      "c = cylinder(9, 2)\nshow translate(box([9, 9, 9]) - (^c), [0, 0, 30])\n",
      "c = cylinder(9, 2)\nshow box([9, 9, 9]) |> difference(^c) |> translate([0, 0, 30])\n",
      "^c = cylinder(9, 2)\nshow translate(box([9, 9, 9]) - c, [0, 0, 30])\n",
      "hole(r) = cylinder(9, r)\nshow translate(box([9, 9, 9]) - hole(^2), [0, 0, 30])\n",
      "f(a, b) = a - ^b\nshow translate(f(box([9, 9, 9]), cylinder(9, 2)), [0, 0, 30])\n",
      "show translate(box([9, 9, 9]) - box([1, 1, 1]) - cylinder(9, ^2), [0, 0, 30])\n",
      "show translate([0, 0, 30]) * (box([9, 9, 9]) - cylinder(9, ^2))\n",
  };
  for (size_t i = 0; i < sizeof SCRIPTS / sizeof *SCRIPTS; i++) {
    const Seen seen = ghosts_of(s, SCRIPTS[i]);
    if (seen.count != 1) fail_msg("%zu ghosts of %s", seen.count, SCRIPTS[i]);
    assert_string_equal(seen.type, "solid");
    expect_box(&seen, low, high);
  }
  cag_session_free(s);
}

static void a_shape_is_shown_before_it_was_moved(void **state) {
  (void)state;
  CagSession *s = new_session();
  Seen seen =
      ghosts_of(s, "show ^box([1, 2, 3]) |> material({color: \"red\"}) |> translate([10, 0, 0])\n");
  assert_int_equal(seen.count, 1);
  assert_string_equal(seen.motion, "translate");
  seen = ghosts_of(s, "show ^box([1, 2, 3]) |> translate([10, 0, 0]) |> rotate(Z, 90deg)\n");
  assert_int_equal(seen.count, 1);
  expect_box(&seen, (double[]){0, 0, 0}, (double[]){1, 2, 3});
  assert_string_equal(seen.motion, "translate");
  assert_true(fabs(seen.last.direction[0] - 10) < 1e-12);
  seen = ghosts_of(
      s, "show box([1, 2, 3]) |> translate([1^0, 0, 0]) |> rotate(Z, 90deg, about: [1, 0, 0])\n");
  assert_int_equal(seen.count, 1);
  expect_box(&seen, (double[]){10, 0, 0}, (double[]){11, 2, 3});
  assert_string_equal(seen.motion, "rotate");
  assert_true(fabs(seen.last.angle - 90) < 1e-9);
  assert_true(fabs(fabs(seen.last.direction[2]) - 1) < 1e-12);
  assert_true(fabs(seen.last.point[0] - 1) < 1e-9 && fabs(seen.last.point[1]) < 1e-9);
  seen = ghosts_of(s, "c = circle(^5)\nshow scale(c, [2, 1, 1])\n");
  assert_int_equal(seen.count, 1);
  expect_box(&seen, (double[]){-5, -5, 0}, (double[]){5, 5, 0});
  assert_string_equal(seen.motion, "transform");
  cag_session_free(s);
}

static void a_profile_is_shown_with_its_axis(void **state) {
  (void)state;
  CagSession *s = new_session();
  static const char *const SCRIPTS[] = {
      "profile = polyline([[2, 0], [4, 5], [1, 7]])\nshow revolve(pro^file) |> translate([20, 0, 0])\n",
      "show translate(revolve(polyline([[2, 0], [4, ^5], [1, 7]])), [20, 0, 0])\n",
  };
  for (size_t i = 0; i < 2; i++) {
    const Seen seen = ghosts_of(s, SCRIPTS[i]);
    if (seen.count != 1) fail_msg("%zu ghosts of %s", seen.count, SCRIPTS[i]);
    assert_string_equal(seen.type, "curve");
    assert_string_equal(seen.motion, "revolve");
    assert_true(fabs(seen.last.point[0] - 20) < 1e-12);
    expect_box(&seen, (double[]){21, 0, 0}, (double[]){24, 0, 7}); // [x, y] is [x, 0, y]
    assert_true(fabs(fabs(seen.last.direction[2]) - 1) < 1e-12);
  }
  Seen seen = ghosts_of(s, "p = region([[2, 0], [4, 5], [2, 7]])\nshow revolve(^p)\n");
  assert_int_equal(seen.count, 1);
  assert_string_equal(seen.type, "region");
  assert_string_equal(seen.motion, "revolve");
  expect_box(&seen, (double[]){2, 0, 0}, (double[]){4, 0, 7});
  seen = ghosts_of(s, "show loft([circle(5), translate(cir^cle(3), [0, 0, 4])])\n");
  assert_int_equal(seen.count, 1);
  seen = ghosts_of(s, "show loft([circle(5), ^translate(circle(3), [0, 0, 4])])\n");
  assert_int_equal(seen.count, 1);
  expect_box(&seen, (double[]){-3, -3, 4}, (double[]){3, 3, 4});
  cag_session_free(s);
}

static void what_is_shown_or_unknown_has_no_ghost(void **state) {
  (void)state;
  CagSession *s = new_session();
  assert_int_equal(ghosts_of(s, "show sph^ere(4)\n").count, 0);
  assert_int_equal(ghosts_of(s, "b = sphere(4)\nshow ^b\n").count, 0);
  assert_int_equal(ghosts_of(s, "print 1 ^+ 2\nshow sphere(4)\n").count, 0);
  // A definition that was evaluated and is not shown.
  const Seen seen = ghosts_of(s, "b = sphere(^4)\nprint volume(b)\nshow box([1, 1, 1])\n");
  assert_int_equal(seen.count, 1);
  Seen none = {0};
  assert_int_equal(cag_session_ghosts(s, "other.cag", 1, 1, NULL, see, &none), CAG_STATUS_OK);
  assert_int_equal(cag_session_ghosts(s, "page.cag", 99, 1, NULL, see, &none), CAG_STATUS_OK);
  assert_int_equal(cag_session_ghosts(s, "page.cag", 0, 0, NULL, see, &none), CAG_STATUS_OK);
  assert_int_equal(none.count, 0);
  cag_session_free(s);
}

static void loops_have_a_ghost_for_each_round(void **state) {
  (void)state;
  CagSession *s = new_session();
  const Seen seen = ghosts_of(
      s, "show box([40, 10, 5]) - [for i in 0..3: translate(cyl^inder(9, 2), [10 * i, 5, -1])]\n");
  assert_int_equal(seen.count, 4);
  assert_string_equal(seen.motion, "translate");
  assert_int_equal(
      ghosts_of(s, "show [for i in 0..<200: translate(sphere(^1), [3 * i, 0, 0])]\n").count, 64);
  cag_session_free(s);
}

// A loop that reshapes a curve keeps a few of its curves only.
static void reshaping_again_and_again_keeps_little(void **state) {
  (void)state;
  CagSession *s = new_session();
  build_scene(s, "again(c, n) = if n == 0 then c else again(reverse(c), n - 1)\n"
                 "show again(bspline([for i in 0..<2000: [i, sin(i * 7deg), 0]]), 2000)\n");
  assert_true(cag_session_memory(s) < (size_t)20 << 20);
  cag_session_free(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(faces_know_their_operands),
      cmocka_unit_test(operands_of_a_loop_are_one_source),
      cmocka_unit_test(nested_operations_tell_the_calls_around_an_operand),
      cmocka_unit_test(a_loop_that_subtracts_keeps_its_origins),
      cmocka_unit_test(parts_without_operands_have_no_sources),
      cmocka_unit_test(an_operand_is_shown_where_it_is_used),
      cmocka_unit_test(a_shape_is_shown_before_it_was_moved),
      cmocka_unit_test(a_profile_is_shown_with_its_axis),
      cmocka_unit_test(what_is_shown_or_unknown_has_no_ghost),
      cmocka_unit_test(loops_have_a_ghost_for_each_round),
      cmocka_unit_test(reshaping_again_and_again_keeps_little),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
