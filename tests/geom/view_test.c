// Tests drawings with hidden lines: their curves are of the kinds that they should be, and as long.

#include "geom/solid/solid.h"
#include "geom/view/hidden.h"
#include "support.h"

typedef struct Drawn {
  CagCurveList visible, hidden;
} Drawn;

static Drawn draw(const CagViewBody *bodies, size_t n, CagVec3 direction) {
  const CagPlane plane = {.normal = cag_unit(direction)};
  const CagTransform frame = cag_plane_frame(&plane);
  Drawn d = {{0}, {0}};
  assert_int_equal(cag_hidden_lines(bodies, n, &frame, &d.visible, &d.hidden, &err), CAG_OK);
  return d;
}

static void drop(Drawn *d) {
  cag_curve_list_free(&d->visible);
  cag_curve_list_free(&d->hidden);
}

static double length_of(const CagCurveList *list) {
  double all = 0;
  for (size_t i = 0; i < list->count; i++) {
    const CagCurve *c = list->items[i];
    double length;
    assert_int_equal(cag_curve_length(c, c->start, c->end, &length, &err), CAG_OK);
    all += length;
  }
  return all;
}

static void a_box_seen_along_its_diagonal_has_nine_visible_edges(void **state) {
  (void)state;
  CagSolid *box;
  assert_int_equal(cag_solid_box(cag_vec3(10, 20, 30), false, &box, &err), CAG_OK);
  Drawn d = draw(&(CagViewBody){.solid = box}, 1, cag_vec3(1, 1, 1));
  assert_int_equal(d.visible.count, 9);
  assert_int_equal(d.hidden.count, 3);
  // Each edge makes the angle acos(1/sqrt 3) with the direction.
  NEAR(length_of(&d.visible), 180 * sqrt(2.0 / 3), 1e-12 * 180);
  NEAR(length_of(&d.hidden), 60 * sqrt(2.0 / 3), 1e-12 * 60);
  for (size_t i = 0; i < 9; i++) {
    assert_string_equal(d.visible.items[i]->kind->name, "line");
    assert_int_equal(d.visible.items[i]->dimension, 2);
  }
  drop(&d);
  cag_solid_release(box);
}

static void circles_are_drawn_as_ellipses_and_lines(void **state) {
  (void)state;
  CagSolid *can;
  double a, b;
  CagTransform frame;
  assert_int_equal(cag_solid_cylinder(10, 4, 4, &can, &err), CAG_OK);
  Drawn d = draw(&(CagViewBody){.solid = can}, 1, cag_vec3(0, 1, 0));
  assert_int_equal(d.visible.count, 4);
  assert_int_equal(d.hidden.count, 0);
  NEAR(length_of(&d.visible), 36, 1e-11);
  drop(&d);
  d = draw(&(CagViewBody){.solid = can}, 1, cag_vec3(0, 0, 1));
  assert_int_equal(d.visible.count, 1);
  assert_true(cag_curve_arc_view(d.visible.items[0], &a, &b, &frame));
  NEAR(length_of(&d.visible), 8 * M_PI, 1e-11);
  drop(&d);
  // Half of the lower rim is hidden: an arc of an ellipse with the semi-axes 4 and 4 / sqrt 2.
  d = draw(&(CagViewBody){.solid = can}, 1, cag_vec3(0, -1, 1));
  assert_int_equal(d.hidden.count, 1);
  assert_true(cag_curve_arc_view(d.hidden.items[0], &a, &b, &frame));
  NEAR(fmax(a, b), 4, 1e-12);
  NEAR(fmin(a, b), 4 / sqrt(2), 1e-12);
  NEAR(d.hidden.items[0]->end - d.hidden.items[0]->start, M_PI, 1e-9);
  drop(&d);
  cag_solid_release(can);
}

static void curves_hide_nothing(void **state) {
  (void)state;
  CagCurve *line[2];
  assert_int_equal(cag_curve_line(cag_vec3(-1, 0, 0), cag_vec3(1, 0, 0), 3, &line[0], &err),
                   CAG_OK);
  assert_int_equal(cag_curve_line(cag_vec3(0, -1, 5), cag_vec3(0, 1, 5), 3, &line[1], &err),
                   CAG_OK);
  Drawn d = draw((CagViewBody[]){{.curve = line[0]}, {.curve = line[1]}}, 2, cag_vec3(0, 0, 1));
  assert_int_equal(d.visible.count, 2);
  assert_int_equal(d.hidden.count, 0);
  drop(&d);
  // One of two lines that coincide is drawn.
  d = draw((CagViewBody[]){{.curve = line[0]}, {.curve = line[1]}}, 2, cag_vec3(1, 0, 0));
  assert_int_equal(d.visible.count, 1);
  drop(&d);
  d = draw(NULL, 0, cag_vec3(1, 0, 0));
  assert_int_equal(d.visible.count, 0);
  for (int i = 0; i < 2; i++) cag_curve_release(line[i]);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_box_seen_along_its_diagonal_has_nine_visible_edges),
      cmocka_unit_test(circles_are_drawn_as_ellipses_and_lines),
      cmocka_unit_test(curves_hide_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
