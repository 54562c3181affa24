// Sections of scenes: what is left, the outlines of the cut, names, and materials. Expected measures
// are the formulas of caps, segments, and rings.

#include <math.h>

#include "interp/scene/item_measure.h"
#include "interp/scene/item_mesh.h"
#include "interp/session/session.h"
#include "session_support.h"

// Relative error of what is measured by a mesh within the tolerance of the session below.
#define MESHED 1e-4

static CagSession *run(const char *script) {
  CagSessionOptions o;
  cag_session_options_init(&o);
  o.tolerance = 1e-4;
  CagSession *s = cag_session_new(&o);
  assert_non_null(s);
  if (cag_session_run_text(s, "test", script, strlen(script)) != CAG_STATUS_OK) {
    cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr);
    fail();
  }
  return s;
}

static void cut(CagSession *s, double a, double b, double c, double d) {
  assert_true(cag_session_set_section(s, (double[]){a, b, c, d}));
}

typedef struct Sum {
  double length, area, volume;
  size_t count;
  CagMeasures last;
} Sum;

static void add_measures(void *context, const CagMeasures *m) {
  Sum *sum = context;
  if (isfinite(m->length)) sum->length += m->length;
  if (isfinite(m->area)) sum->area += m->area;
  if (isfinite(m->volume)) sum->volume += m->volume;
  sum->count++;
  sum->last = *m;
}

static Sum measure(CagSession *s) {
  Sum sum = {0};
  assert_int_equal(cag_session_measure(s, add_measures, &sum), CAG_STATUS_OK);
  return sum;
}

static void near(double a, double expected, double relative) {
  if (fabs(a - expected) > relative * fabs(expected)) fail_msg("%.17g is not %.17g", a, expected);
}

// --- What is left ---

static void a_box_is_cut_exactly(void **state) {
  (void)state;
  CagSession *s = run("show box([4, 3, 2])");
  cut(s, 0, 0, 1, 0.5);
  Sum sum = measure(s);
  near(sum.volume, 6, 1e-14);
  near(sum.area, 2 * 12 + 0.5 * 14, 1e-14);
  assert_true(sum.last.closed);
  cut(s, 0, 0, -1, -0.5); // the other side
  near(measure(s).volume, 18, 1e-14);
  cut(s, 1, 1, 0, 1); // only the corner x + y < 1 is left
  near(measure(s).volume, 1, 1e-12);
  assert_true(cag_session_set_section(s, NULL));
  near(measure(s).volume, 24, 1e-15);
  cag_session_free(s);
}

// The cap of height h of a ball: pi h^2 (3 r - h) / 3, with the curved area 2 pi r h.
static void a_ball_loses_a_cap(void **state) {
  (void)state;
  CagSession *s = run("show sphere(10)");
  cut(s, 0, 0, 1, 4);
  const double h = 6, r = 10;
  Sum sum = measure(s);
  near(sum.volume, 4 * M_PI / 3 * r * r * r - M_PI * h * h * (3 * r - h) / 3, MESHED);
  near(sum.area, 2 * M_PI * r * (2 * r - h) + M_PI * (r * r - 16), MESHED);
  near(sum.last.max[2], 4, 1e-12);
  cag_session_free(s);
}

// The segment of a circle beyond distance d: r^2 acos(d / r) - d sqrt(r^2 - d^2).
static void other_shapes_are_clipped(void **state) {
  (void)state;
  const double r = 5, d = 3, angle = 2 * acos(d / r),
               segment = r * r * angle / 2 - d * sqrt(r * r - d * d);
  CagSession *s = run("show cylinder(8, 5)");
  cut(s, 1, 0, 0, d);
  near(measure(s).volume, 8 * (M_PI * r * r - segment), MESHED);
  cag_session_free(s);
  s = run("show circle(5)");
  cut(s, 1, 0, 0, d);
  Sum sum = measure(s);
  assert_int_equal(sum.count, 1);
  near(sum.length, r * (2 * M_PI - angle), 1e-12);
  cut(s, -1, 0, 0, d); // keeps x > -3
  near(measure(s).length, r * (2 * M_PI - angle), 1e-12);
  cag_session_free(s);
  s = run("show region(circle(5))");
  cut(s, 1, 0, 0, d);
  near(measure(s).area, M_PI * r * r - segment, MESHED);
  cag_session_free(s);
  s = run("show torus_surface(7, 2)");
  cut(s, 0, 0, 1, 0);
  near(measure(s).area, 2 * M_PI * M_PI * 7 * 2, MESHED); // half of 4 pi^2 R r
  cag_session_free(s);
  s = run("show tessellate(box(2))");
  cut(s, 0, 0, 1, 1.5);
  sum = measure(s);
  near(sum.volume, 6, 1e-14);
  assert_true(sum.last.closed);
  cag_session_free(s);
  s = run("show mesh([[0, 0, 0], [2, 0, 0], [0, 2, 0]], [[0, 1, 2]])");
  cut(s, 1, 0, 0, 1);
  sum = measure(s);
  near(sum.area, 1.5, 1e-12);
  assert_false(sum.last.closed);
  cag_session_free(s);
}

static void shapes_that_the_plane_misses_stay_or_go(void **state) {
  (void)state;
  CagSession *s =
      run("show sphere(1), translate(sphere(2), [0, 0, 9]), bezier([[0, 0], [1, 2], [3, 0]])\n"
          "show translate(sphere(1) - box(1), [0, 0, 20])");
  cut(s, 0, 0, 1, 5);
  Sum sum = measure(s);
  assert_int_equal(sum.count, 2);
  near(sum.volume, 4 * M_PI / 3, 1e-14);
  assert_true(sum.last.exact);
  cag_session_free(s);
}

// --- Outlines ---

// The total length of the outlines, whose number must be this. All lie in z = 0.
static double outlines(CagSession *s, size_t count) {
  double sum = 0, length;
  CagError err;
  if (cag_session_build_drawing(s) != CAG_STATUS_OK) {
    cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr);
    fail();
  }
  assert_int_equal(s->scene.item_count, count);
  for (size_t i = 0; i < s->scene.item_count; i++) {
    const CagCurve *c = s->scene.items[i].as.curve;
    assert_int_equal(s->scene.items[i].kind, CAG_ITEM_CURVE);
    assert_int_equal(c->dimension, 2);
    assert_int_equal(cag_curve_length(c, c->start, c->end, &length, &err), CAG_OK);
    sum += length;
  }
  return sum;
}

static void outlines_are_exact(void **state) {
  (void)state;
  static const struct {
    const char *script;
    double plane[4];
    size_t count;
    double length;
  } cases[] = {
      {"show sphere(10)", {0, 0, 1, 4}, 1, 2 * M_PI * 9.1651513899116800}, // sqrt(84)
      {"show torus(7, 2)", {1, 0, 0, 0}, 2, 8 * M_PI},
      {"show torus(7, 2)", {0, 0, 1, 0}, 2, 2 * M_PI * (9 + 5)},
      {"show box([4, 3, 2])", {0, 1, 0, 1}, 1, 12},
      // A plate with a hole, and one cut by a half space
      {"show box([40, 30, 10]) - translate(cylinder(20, 5), [10, 10, -5])",
       {0, 0, 1, 6},
       2,
       140 + 10 * M_PI},
      {"show box([40, 30, 10]) & half_space(plane([10, 0, 0], X))", {0, 0, 1, 6}, 1, 80},
      {"show box([40, 30, 10]) - half_space(plane([0, 0, 8], Z))", {0, 0, 1, 6}, 1, 0},
      // Two disks of radius 5 whose centers are 6 apart: each loses 2 acos(3/5) of its circle.
      {"show cylinder(9, 5) | translate(cylinder(9, 5), [6, 0, 0])",
       {0, 0, 1, 2},
       1,
       20 * M_PI - 20 * 0.92729521800161219},
      {"show cylinder(9, 5) & translate(cylinder(9, 5), [6, 0, 0])",
       {0, 0, 1, 2},
       1,
       20 * 0.92729521800161219},
      // Moved and scaled as a whole
      {"show scale(sphere(5) - sphere(3), 2) |> translate([1, 2, 3])", {0, 0, 1, 3}, 2, 32 * M_PI},
      {"show revolve(line([4, 0], [4, 10]))", {0, 0, 1, 5}, 1, 8 * M_PI},
      {"show tessellate(box(2))", {0, 0, 1, 1}, 1, 8},
      {"show region(circle(5))", {1, 0, 0, 3}, 1, 8},
      {"show circle(5)", {0, 0, 1, 0}, 1, 10 * M_PI},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    CagSession *s = run(cases[i].script);
    const double *p = cases[i].plane;
    cut(s, p[0], p[1], p[2], p[3]);
    if (cases[i].length == 0) { // it has nothing below the plane
      assert_int_equal(cag_session_build_drawing(s), CAG_STATUS_SCRIPT);
    } else {
      near(outlines(s, cases[i].count), cases[i].length, 1e-12);
    }
    cag_session_free(s);
  }
}

// At z = 0 the body -x^2 - y^2 + z^2 + 1 > 0 is a disk of radius 1; a set operation with it is known
// by its mesh only.
static void an_unbounded_operand_is_cut_by_its_mesh(void **state) {
  (void)state;
  CagSession *s =
      run("show box([4, 4, 4], centered: true) & solid([1, 1, -1, 0, 0, 0, 0, 0, 0, -1])");
  cut(s, 0, 0, 1, 0);
  near(outlines(s, 1), 2 * M_PI, 1e-3);
  cag_session_free(s);
}

// The drawing is seen from the side that is removed, with up as in the standard views.
static void drawings_show_their_coordinates(void **state) {
  (void)state;
  static const struct {
    double plane[4], min[2], max[2];
  } cases[] = {{{0, 0, 1, 0.5}, {1, 2}, {2, 4}}, {{0, 0, -1, -0.5}, {1, -4}, {2, -2}},
               {{1, 0, 0, 1.5}, {2, 0}, {4, 3}}, {{-1, 0, 0, -1.5}, {-4, 0}, {-2, 3}},
               {{0, 1, 0, 3}, {-2, 0}, {-1, 3}}, {{0, -1, 0, -3}, {1, 0}, {2, 3}}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    CagSession *s = run("show translate(box([1, 2, 3]), [1, 2, 0])");
    const double *p = cases[i].plane;
    CagBounds box;
    CagError err;
    cut(s, p[0], p[1], p[2], p[3]);
    outlines(s, 1);
    assert_int_equal(cag_curve_bounds(s->scene.items[0].as.curve, &box, &err), CAG_OK);
    const double found[] = {box.min.x, box.min.y, box.max.x, box.max.y},
                 expected[] = {cases[i].min[0], cases[i].min[1], cases[i].max[0], cases[i].max[1]};
    for (int k = 0; k < 4; k++)
      if (fabs(found[k] - expected[k]) > 1e-12)
        fail_msg("case %zu: %g is not %g", i, found[k], expected[k]);
    cag_session_free(s);
  }
}

// --- Names, materials, labels ---

static bool has_name(const CagSession *s, const char *name) {
  size_t n = 0;
  for (size_t i = 0; i < s->scene.item_count; i++) n += !strcmp(s->scene.items[i].name, name);
  assert_true(n <= 1);
  return n == 1;
}

static void names_are_kept_and_stay_unique(void **state) {
  (void)state;
  // The third shape is called ring.2 by itself.
  CagSession *s = run(
      "ring = torus(7, 2)\nshow ring, sphere(1) |> translate([30, 0, 0]), translate(ring, [0, 40, 0])");
  cut(s, 0, 0, 1, 0);
  outlines(s, 5);
  assert_true(has_name(s, "ring") && has_name(s, "ring.2") && has_name(s, "sphere"));
  assert_true(has_name(s, "ring.3") || has_name(s, "ring.4"));
  cag_session_free(s);
  s = run("wire = polyline([[0, 0, 0], [1, 0, 2], [2, 0, 0], [3, 0, 2], [4, 0, 0]])\nshow wire");
  cut(s, 0, 0, 1, 1);
  near(measure(s).length, 2 * sqrt(5), 1e-12);
  assert_int_equal(s->scene.item_count, 4); // with the floor
  assert_true(has_name(s, "wire") && has_name(s, "wire.2") && has_name(s, "wire.3"));
  cag_session_free(s);
}

// The area of the triangles in z = `height` whose material has this much red.
static double painted(const CagSession *s, double height, double red) {
  CagMesh *m;
  CagError err;
  const CagItem *item = &s->scene.items[0];
  double sum = 0;
  assert_int_equal(cag_item_mesh(&s->scene, item, &m, &err), CAG_OK);
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    const CagVec3 a = m->positions[k[0]], b = m->positions[k[1]], c = m->positions[k[2]];
    if (fabs(a.z - height) + fabs(b.z - height) + fabs(c.z - height) > 1e-9) continue;
    const size_t material = cag_item_label_material(item, m->labels ? m->labels[t] : 0);
    if (fabs(s->scene.materials[material].color.r - red) < 1e-9)
      sum += cag_norm(cag_cross(cag_sub(b, a), cag_sub(c, a))) / 2;
  }
  cag_mesh_release(m);
  return sum;
}

static void the_cut_has_the_material_of_its_part(void **state) {
  (void)state;
  // A red box with a blue one beside it, moved as a whole; the blue one is cut at the same height.
  CagSession *s = run("a = box([2, 2, 2]) |> color([1, 0, 0])\n"
                      "b = box([3, 2, 2]) |> translate([2, 0, 0]) |> color([0.25, 0, 1])\n"
                      "show translate(a | b, [0, 0, 5])");
  cut(s, 0, 0, 1, 6);
  near(measure(s).volume, 10, 1e-12);
  near(painted(s, 6, 1), 4, 1e-12);
  near(painted(s, 6, 0.25), 6, 1e-12);
  cag_session_free(s);
  // The cut of a difference is that of the first operand.
  s = run(
      "show (box([4, 4, 4]) |> color([1, 0, 0])) - (cylinder(9, 1) |> translate([2, 2, -1]) |> color([0.25, 0, 1]))");
  cut(s, 0, 0, 1, 3);
  measure(s);
  near(painted(s, 3, 1), 16 - M_PI, MESHED);
  cag_session_free(s);
}

static void labels_above_the_plane_are_removed(void **state) {
  (void)state;
  CagSession *s = run("show label([0, 0, 0], \"low\"), label([0, 0, 9], \"high\"), sphere(10)");
  cut(s, 0, 0, 1, 4);
  assert_int_equal(cag_session_build_scene(s), CAG_STATUS_OK);
  assert_int_equal(s->scene.label_count, 1);
  assert_string_equal(s->scene.labels[0].text, "low");
  cut(s, 0, 0, 1, 9);
  outlines(s, 1);
  assert_int_equal(s->scene.label_count, 1);
  assert_string_equal(s->scene.labels[0].text, "high");
  cag_session_free(s);
}

// --- Errors ---

static void a_plane_beside_everything_is_an_error(void **state) {
  (void)state;
  CagErrorView e;
  CagSession *s = run("show sphere(10)");
  cut(s, 0, 0, -1, -600);
  assert_int_equal(cag_session_scene(s, &(CagShownCounts){0}), CAG_STATUS_SCRIPT);
  cag_session_error(s, 0, &e);
  assert_string_equal(e.code, "E0520");
  assert_string_equal(e.help, "the shapes reach from -10 to 10 along [0, 0, 1]");
  cut(s, 0, 0, 1, 600); // nothing to remove
  near(measure(s).volume, 4000 * M_PI / 3, 1e-14);
  assert_int_equal(cag_session_error_count(s), 0);
  assert_false(cag_session_set_section(s, (double[]){0, 0, 0, 1}));
  assert_false(cag_session_set_section(s, (double[]){0, 0, 1, NAN}));
  cag_session_free(s);
}

// The warning of a scene that is built again is not repeated.
static void warnings_are_those_of_the_last_scene(void **state) {
  (void)state;
  CagSession *s = run("show sphere(10), box(1) - box(2)");
  for (int i = 0; i < 3; i++) {
    cut(s, 0, 0, 1, 3 + i);
    measure(s);
    assert_int_equal(cag_session_error_count(s), 1);
    assert_int_equal(cag_session_build_drawing(s), CAG_STATUS_OK);
  }
  cag_session_free(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_box_is_cut_exactly),
      cmocka_unit_test(a_ball_loses_a_cap),
      cmocka_unit_test(other_shapes_are_clipped),
      cmocka_unit_test(shapes_that_the_plane_misses_stay_or_go),
      cmocka_unit_test(outlines_are_exact),
      cmocka_unit_test(an_unbounded_operand_is_cut_by_its_mesh),
      cmocka_unit_test(drawings_show_their_coordinates),
      cmocka_unit_test(names_are_kept_and_stay_unique),
      cmocka_unit_test(the_cut_has_the_material_of_its_part),
      cmocka_unit_test(labels_above_the_plane_are_removed),
      cmocka_unit_test(a_plane_beside_everything_is_an_error),
      cmocka_unit_test(warnings_are_those_of_the_last_scene),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
