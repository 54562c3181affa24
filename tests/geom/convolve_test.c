// Minkowski sums of meshes and offsets: formulas, and meshes that are closed.

#include "geom/solid/ball.h"
#include "geom/solid/convolve.h"
#include "geom/solid/csg.h"
#include "surface_support.h"

static CagMesh *new_box(CagVec3 min, CagVec3 max) {
  CagMesh *m;
  const CagBounds box = {min, max};
  MUST(cag_box_mesh(&box, &m, err));
  return m;
}

static double volume_of(const CagMesh *m) {
  double terms[10] = {0};
  cag_mesh_volume_terms(m, terms);
  return terms[0];
}

static void assert_closed(const CagMesh *m) {
  CagVec3 edge[2];
  assert_true(cag_check_mesh(m));
  assert_true(cag_mesh_is_watertight(m, edge));
}

static void the_sum_of_boxes_is_a_box(void **state) {
  (void)state;
  CagMesh *a = new_box(cag_vec3(0, 0, 0), cag_vec3(4, 3, 2)),
          *b = new_box(cag_vec3(-1, 0, 5), cag_vec3(1, 1, 6)), *sum;
  MUST(cag_mesh_minkowski(a, b, NULL, &sum, err));
  const CagBounds box = cag_mesh_bounds(sum);
  assert_closed(sum);
  assert_near(volume_of(sum), 6 * 4 * 3, 1e-12, "volume");
  assert_point(box.min, cag_vec3(-1, 0, 5), 1e-15, "min");
  assert_point(box.max, cag_vec3(5, 4, 8), 1e-15, "max");
  assert_int_equal(sum->triangle_count, 12);
  cag_mesh_release(a);
  cag_mesh_release(b);
  cag_mesh_release(sum);
}

// Steiner's formula with the mean width of the polyhedron: between those of its inner and outer
// balls.
static void a_grown_box_is_within_the_tolerance(void **state) {
  (void)state;
  CagMesh *box = new_box(cag_vec3(0, 0, 0), cag_vec3(4, 6, 8)), *grown;
  for (int k = 0; k < 3; k++) {
    const double tolerance = pow(10, -k - 1), d = 1.5;
    MUST(cag_mesh_offset(box, d, tolerance, NULL, &grown, err));
    const double most = 192 + 208 * d + 18 * M_PI * d * d + 4 * M_PI / 3 * d * d * d,
                 e = d - tolerance;
    const double least = 192 + 208 * e + 18 * M_PI * e * e + 4 * M_PI / 3 * e * e * e;
    assert_closed(grown);
    assert_true(volume_of(grown) < most && volume_of(grown) > least);
    assert_non_null(grown->normals);
    cag_mesh_release(grown);
  }
  cag_mesh_release(box);
}

static void balls_have_their_faces_within_the_tolerance(void **state) {
  (void)state;
  CagMesh *box = new_box(cag_vec3(0, 0, 0), cag_vec3(4, 6, 8)), *ball;
  MUST(cag_ball_for(box, 2, 0.02, &ball, err));
  assert_closed(ball);
  for (size_t i = 0; i < ball->vertex_count; i++)
    assert_near(cag_norm(ball->positions[i]), 2, 1e-14, "radius");
  for (size_t f = 0; f < ball->triangle_count; f++) {
    const uint32_t *v = ball->triangles + 3 * f;
    const CagVec3 a = ball->positions[v[0]], b = ball->positions[v[1]], c = ball->positions[v[2]];
    const CagVec3 n = cag_unit(cag_cross(cag_sub(b, a), cag_sub(c, a)));
    assert_true(cag_dot(n, a) >= 2 - 0.02);
  }
  cag_mesh_release(ball);
  MUST_FAIL(cag_ball_for(box, 2, 1e-6, &ball, err), "ball-too-fine");
  cag_mesh_release(box);
}

// The Euler characteristic of the part of a frame within the ball is 0 in the middle of its hole,
// and so is the winding number.
static void a_hole_that_the_ball_covers_is_closed(void **state) {
  (void)state;
  CagMesh *plate = new_box(cag_vec3(0, 0, 0), cag_vec3(10, 10, 2)),
          *pin = new_box(cag_vec3(4, 4, -1), cag_vec3(6, 6, 3)), *frame, *grown;
  MUST(cag_mesh_boolean(CAG_DIFFERENCE, plate, pin, NULL, &frame, err));
  assert_int_equal(cag_mesh_euler_characteristic(frame), 0);
  MUST(cag_mesh_offset(frame, 2, 0.05, NULL, &grown, err));
  assert_closed(grown);
  assert_int_equal(cag_mesh_euler_characteristic(grown), 2);
  cag_mesh_release(grown);
  MUST(cag_mesh_offset(frame, 0.5, 0.05, NULL, &grown, err));
  assert_closed(grown);
  assert_int_equal(cag_mesh_euler_characteristic(grown), 0);
  cag_mesh_release(grown);
  cag_mesh_release(frame);
  cag_mesh_release(plate);
  cag_mesh_release(pin);
}

static void shrunk_boxes_are_boxes(void **state) {
  (void)state;
  CagMesh *box = new_box(cag_vec3(0, 0, 0), cag_vec3(4, 6, 8)), *shrunk;
  MUST(cag_mesh_offset(box, -1, 0.1, NULL, &shrunk, err));
  assert_closed(shrunk);
  assert_near(volume_of(shrunk), 2 * 4 * 6, 1e-12, "volume");
  assert_int_equal(shrunk->triangle_count, 12);
  cag_mesh_release(shrunk);
  MUST(cag_mesh_offset(box, -2.5, 0.1, NULL, &shrunk, err));
  assert_int_equal(shrunk->triangle_count, 0);
  cag_mesh_release(shrunk);
  cag_mesh_release(box);
}

static void convex_meshes_are_recognized(void **state) {
  (void)state;
  CagMesh *box = new_box(cag_vec3(0, 0, 0), cag_vec3(4, 6, 8)),
          *corner = new_box(cag_vec3(2, 2, 2), cag_vec3(9, 9, 9)), *rest;
  bool convex;
  MUST(cag_mesh_is_convex(box, &convex, err));
  assert_true(convex);
  MUST(cag_mesh_boolean(CAG_DIFFERENCE, box, corner, NULL, &rest, err));
  MUST(cag_mesh_is_convex(rest, &convex, err));
  assert_false(convex);
  cag_mesh_release(box);
  cag_mesh_release(corner);
  cag_mesh_release(rest);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_sum_of_boxes_is_a_box),
      cmocka_unit_test(a_grown_box_is_within_the_tolerance),
      cmocka_unit_test(balls_have_their_faces_within_the_tolerance),
      cmocka_unit_test(a_hole_that_the_ball_covers_is_closed),
      cmocka_unit_test(shrunk_boxes_are_boxes),
      cmocka_unit_test(convex_meshes_are_recognized),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
