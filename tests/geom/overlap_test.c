// Volumes that random solids share: against formulas, for solids that touch, and for thin overlaps.

#include "geom/meet/overlap.h"

#include "geom/linalg/rigid.h"
#include "geom/solid/csg.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

static const CagTessellation HOW = CAG_TESSELLATION_DEFAULT;

static CagTransform anywhere(void) {
  CagTransform turn, t;
  CagVec3 axis;
  axis.x = uniform(-1, 1);
  axis.y = uniform(-1, 1);
  axis.z = uniform(-1, 1);
  const double angle = uniform(0, 6);
  const double x = uniform(-50, 50), y = uniform(-50, 50), z = uniform(-50, 50);
  OK(cag_rotate(axis, angle, cag_vec3(0, 0, 0), &turn, &err));
  t = cag_translate(cag_vec3(x, y, z));
  return cag_transform_multiply(&t, &turn);
}

// Takes over both solids, and moves them by `place`, the second one by `shift` before.
static double shared(CagSolid *a, CagSolid *b, CagVec3 shift, const CagTransform *place) {
  const CagTransform by = cag_translate(shift), moved = cag_transform_multiply(place, &by);
  CagSolid *x, *y;
  CagOverlapBody p, q;
  double volume, reverse;
  OK(cag_solid_transform(a, place, &x, &err));
  OK(cag_solid_transform(b, &moved, &y, &err));
  OK(cag_overlap_body(x, 0, &HOW, &p, &err));
  OK(cag_overlap_body(y, 0, &HOW, &q, &err));
  OK(cag_overlap_volume(&p, &q, &HOW, &volume, &err));
  OK(cag_overlap_volume(&q, &p, &HOW, &reverse, &err));
  NEAR(volume, reverse, 1e-9 * volume);
  cag_overlap_release(&p);
  cag_overlap_release(&q);
  cag_solid_release(a);
  cag_solid_release(b);
  cag_solid_release(x);
  cag_solid_release(y);
  return volume;
}

static CagSolid *box(double x, double y, double z) {
  CagSolid *s;
  OK(cag_solid_box(cag_vec3(x, y, z), false, &s, &err));
  return s;
}

static CagSolid *ball(double radius) {
  CagSolid *s;
  OK(cag_solid_sphere(radius, &s, &err));
  return s;
}

// The first minus the second, which are released.
static CagSolid *minus(CagSolid *a, CagSolid *b) {
  CagSolid *s, *both[2] = {a, b};
  OK(cag_solid_combine(CAG_DIFFERENCE, both, 2, NULL, &s, &err));
  cag_solid_release(a);
  cag_solid_release(b);
  return s;
}

static void boxes_share_the_product_of_their_overlaps(void **state) {
  (void)state;
  seed = 3;
  for (int round = 0; round < 40; round++) {
    const CagTransform place = anywhere();
    const double x = uniform(0.001, 2), y = uniform(0.001, 2), z = uniform(0.001, 2);
    NEAR(shared(box(2, 2, 2), box(2, 2, 2), cag_vec3(2 - x, 2 - y, 2 - z), &place), x * y * z,
         1e-10);
  }
}

static void boxes_that_touch_share_nothing(void **state) {
  (void)state;
  seed = 5;
  for (int round = 0; round < 40; round++) {
    const CagTransform place = anywhere();
    const double y = uniform(-2, 2), z = uniform(-2, 2);
    assert_true(shared(box(2, 2, 2), box(2, 2, 2), cag_vec3(2, y, z), &place) == 0);
    assert_true(shared(box(2, 2, 2), box(2, 2, 2), cag_vec3(2, 2, z), &place) == 0);
    assert_true(shared(box(2, 2, 2), box(2, 2, 2), cag_vec3(2, 2, 2), &place) == 0);
  }
}

// Two balls of radius r at the distance d share pi (4 r + d) (2 r - d)^2 / 12.
static void balls_share_a_lens(void **state) {
  (void)state;
  seed = 7;
  for (int round = 0; round < 4; round++) {
    const CagTransform place = anywhere();
    const double r = 5, d = uniform(0.5, 9.5);
    const double lens = M_PI * (4 * r + d) * (2 * r - d) * (2 * r - d) / 12;
    NEAR(shared(ball(r), ball(r), cag_vec3(d, 0, 0), &place), lens, 3e-3 * lens);
  }
}

static void a_pin_in_its_hole_touches_however_it_is_turned(void **state) {
  (void)state;
  seed = 9;
  for (int round = 0; round < 3; round++) {
    const CagTransform place = anywhere();
    const double angle = uniform(0, 1), size = uniform(0.1, 100);
    CagSolid *pin, *drill, *turned;
    CagTransform turn;
    OK(cag_rotate(cag_vec3(0, 0, 1), angle, cag_vec3(0, 0, 0), &turn, &err));
    OK(cag_solid_cylinder(4 * size, size, size, &pin, &err));
    OK(cag_solid_cylinder(4 * size, size, size, &drill, &err));
    OK(cag_solid_transform(drill, &turn, &turned, &err));
    cag_solid_release(drill);
    CagSolid *block;
    OK(cag_solid_box(cag_vec3(4 * size, 4 * size, 4 * size), true, &block, &err));
    assert_true(shared(minus(block, turned), pin, cag_vec3(0, 0, 0), &place) == 0);
  }
}

// Pins that are too thick by a third of the first tolerance, which is a thousandth of the diagonal.
static void a_pin_that_is_too_thick_interferes(void **state) {
  (void)state;
  seed = 13;
  for (int round = 0; round < 2; round++) {
    const CagTransform place = anywhere();
    const double r = 5, by = 0.01;
    CagSolid *pin, *drill, *block;
    OK(cag_solid_cylinder(20, r + by, r + by, &pin, &err));
    OK(cag_solid_cylinder(20, r, r, &drill, &err));
    block = minus(box(20, 20, 20), drill); // a quarter of the hole, at a corner
    const double ring = M_PI * 20 * ((r + by) * (r + by) - r * r) / 4;
    NEAR(shared(block, pin, cag_vec3(0, 0, 0), &place), ring, 0.25 * ring);
  }
}

// The shell between a ball and its cavity is as thin as the difference of their radii.
static void a_ball_fills_its_cavity(void **state) {
  (void)state;
  seed = 15;
  for (int round = 0; round < 1; round++) {
    const CagTransform place = anywhere();
    CagSolid *block;
    OK(cag_solid_box(cag_vec3(20, 20, 20), true, &block, &err));
    assert_true(shared(minus(block, ball(6)), ball(6), cag_vec3(0, 0, 0), &place) == 0);
    OK(cag_solid_box(cag_vec3(20, 20, 20), true, &block, &err));
    const double shell = 4 * M_PI / 3 * (6.5 * 6.5 * 6.5 - 216);
    NEAR(shared(minus(block, ball(6)), ball(6.5), cag_vec3(0, 0, 0), &place), shell, 0.01 * shell);
  }
}

// --- Frames ---

static CagVec3 direction(void) {
  CagVec3 d;
  d.x = uniform(-1, 1);
  d.y = uniform(-1, 1);
  d.z = uniform(-1, 1);
  return cag_unit(d);
}

static void the_smallest_rotation_turns_by_the_angle_between(void **state) {
  (void)state;
  seed = 17;
  for (int round = 0; round < 200; round++) {
    const CagVec3 a = direction(), b = round % 3 == 0   ? cag_scaled(a, -1)
                                       : round % 3 == 1 ? a
                                                        : direction();
    const CagTransform t = cag_rotation_between(cag_scaled(a, 3), b);
    CagVec3 axis;
    double angle;
    bool singular;
    near_vec(cag_transform_vector(&t, a), b, 1e-14);
    OK(cag_axis_angle_of(&t, &axis, &angle, &singular, &err));
    NEAR(angle, atan2(cag_norm(cag_cross(a, b)), cag_dot(a, b)), 1e-8);
  }
}

static void frames_stay_on_their_face_under_affine_maps(void **state) {
  (void)state;
  seed = 19;
  for (int round = 0; round < 200; round++) {
    CagTransform map = cag_transform_identity(), out;
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 4; j++) map.m[i][j] = uniform(-2, 2);
    const CagTransform frame = anywhere();
    if (fabs(cag_transform_determinant(&map)) < 0.1) continue;
    assert_true(cag_frame_image(&map, &frame, &out));
    assert_true(cag_transform_is_rigid(&out));
    const CagVec3 x = {out.m[0][0], out.m[1][0], out.m[2][0]},
                  z = {out.m[0][2], out.m[1][2], out.m[2][2]};
    const CagTransform both = cag_transform_multiply(&map, &frame);
    const CagVec3 image_x = cag_transform_vector(&both, cag_vec3(1, 0, 0)),
                  image_y = cag_transform_vector(&both, cag_vec3(0, 1, 0)),
                  image_z = cag_transform_vector(&both, cag_vec3(0, 0, 1));
    near_vec(x, cag_unit(image_x), 1e-12);
    NEAR(cag_dot(z, image_y), 0, 1e-12);
    assert_true(cag_dot(z, image_z) > 0);
    near_vec(cag_vec3(out.m[0][3], out.m[1][3], out.m[2][3]),
             cag_transform_point(&both, cag_vec3(0, 0, 0)), 1e-12);
  }
}

static void singular_and_projective_maps_leave_no_frame(void **state) {
  (void)state;
  const CagTransform frame = cag_transform_identity();
  CagTransform flat = cag_transform_identity(), perspective, out;
  flat.m[2][2] = 0;
  assert_false(cag_frame_image(&flat, &frame, &out));
  OK(cag_perspective(5, true, &perspective, &err));
  assert_false(cag_frame_image(&perspective, &frame, &out));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(boxes_share_the_product_of_their_overlaps),
      cmocka_unit_test(boxes_that_touch_share_nothing),
      cmocka_unit_test(balls_share_a_lens),
      cmocka_unit_test(a_pin_in_its_hole_touches_however_it_is_turned),
      cmocka_unit_test(a_pin_that_is_too_thick_interferes),
      cmocka_unit_test(a_ball_fills_its_cavity),
      cmocka_unit_test(the_smallest_rotation_turns_by_the_angle_between),
      cmocka_unit_test(frames_stay_on_their_face_under_affine_maps),
      cmocka_unit_test(singular_and_projective_maps_leave_no_frame),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
