// Transforms against their definitions and the reference's examples.

#include "geom/linalg/transform.h"
#include "support.h"

static const CagVec3 origin = {0, 0, 0}, axis_x = {1, 0, 0}, axis_y = {0, 1, 0}, axis_z = {0, 0, 1};

static void near_matrix(const CagTransform *a, const double b[4][4], double tolerance) {
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      if (!(fabs(a->m[i][j] - b[i][j]) <= tolerance))
        fail_msg("m[%d][%d] = %.17g is not %.17g", i, j, a->m[i][j], b[i][j]);
}

static void near_transform(const CagTransform *a, const CagTransform *b, double tolerance) {
  near_matrix(a, b->m, tolerance);
}

static void special_angles_are_exact(void **state) {
  (void)state;
  static const double exact[12] = {0, 0.5, 0, 1, 0, 0.5, 0, -0.5, 0, -1, 0, -0.5}; // 0: not asked
  for (int k = -48; k <= 48; k++) {
    double degrees = 30.0 * k, s, c, s2, c2;
    cag_sincos(degrees * (M_PI / 180), &s, &c);
    cag_sincos(k * (M_PI / 6), &s2, &c2);
    assert_true(s == s2 && c == c2);
    int i = ((k % 12) + 12) % 12;
    if (i % 6 == 0) assert_true(s == 0 && !signbit(s) && c == (i ? -1 : 1));
    else if (i % 3 == 0) assert_true(c == 0 && !signbit(c) && s == exact[i]);
    else if (exact[i] != 0) assert_true(s == exact[i]);
    assert_true(s * s + c * c > 1 - 3e-16 && s * s + c * c < 1 + 3e-16);
  }
  double s, c;
  cag_sincos(M_PI / 3, &s, &c);
  assert_true(c == 0.5);
  cag_sincos(M_PI / 4, &s, &c);
  assert_true(s == c && s == sqrt(0.5));
  cag_sincos(1, &s, &c);
  assert_true(s == sin(1) && c == cos(1));
  cag_sincos(1e-9, &s, &c); // a small angle is no multiple
  assert_true(s == 1e-9);
}

static void quarter_turns_are_exact(void **state) {
  (void)state;
  CagTransform r, four = cag_transform_identity();
  OK(cag_rotate(cag_vec3(0, 0, 5), M_PI / 2, cag_vec3(1, 1, 0), &r, &err));
  near_vec(cag_transform_point(&r, cag_vec3(2, 1, 7)), cag_vec3(1, 2, 7), 0);
  for (int i = 0; i < 4; i++) four = cag_transform_multiply(&r, &four);
  CagTransform one = cag_transform_identity();
  near_transform(&four, &one, 0);
}

// Rodrigues about [1 1 1] by 120 degrees permutes the axes.
static void a_third_of_a_turn_about_the_diagonal_permutes_the_axes(void **state) {
  (void)state;
  CagTransform r;
  OK(cag_rotate(cag_vec3(1, 1, 1), 2 * M_PI / 3, origin, &r, &err));
  near_vec(cag_transform_vector(&r, axis_x), axis_y, 1e-15);
  near_vec(cag_transform_vector(&r, axis_y), axis_z, 1e-15);
  FAILS(cag_rotate(origin, 1, origin, &r, &err), "zero-vector");
  assert_string_equal(err.argument, "axis");
  FAILS(cag_rotate(axis_x, NAN, origin, &r, &err), "not-finite");
}

static void inverses_undo(void **state) {
  (void)state;
  CagTransform shear = cag_shear(0.5, 0, 0.25, 0, 0.1, 3),
               move = cag_translate(cag_vec3(100, -3, 7));
  CagTransform a = cag_transform_multiply(&move, &shear), b, product;
  OK(cag_transform_inverse(&a, &b, &err));
  product = cag_transform_multiply(&a, &b);
  CagTransform one = cag_transform_identity();
  near_transform(&product, &one, 1e-13);
  a.m[3][0] = 0.01; // projective
  a.m[3][1] = -0.02;
  OK(cag_transform_inverse(&a, &b, &err));
  product = cag_transform_multiply(&a, &b);
  near_transform(&product, &one, 1e-12);
  // Very small and very large scales are no singularity.
  CagTransform s;
  OK(cag_scale(cag_vec3(1e-9, 1e9, 1), origin, &s, &err));
  OK(cag_transform_inverse(&s, &b, &err));
  NEAR(b.m[0][0], 1e9, 1e-6);
  CagPlane plane;
  OK(cag_plane(origin, cag_vec3(1, 2, 3), &plane, &err));
  OK(cag_project_parallel(&plane, origin, &s, &err));
  FAILS(cag_transform_inverse(&s, &b, &err), "singular-transform");
  FAILS_AT(cag_scale(cag_vec3(1, 0, 1), origin, &s, &err), "zero-factor", 1);
}

static void determinants_and_mirrors(void **state) {
  (void)state;
  CagTransform s, r;
  OK(cag_scale(cag_vec3(2, 3, 4), origin, &s, &err));
  NEAR(cag_transform_determinant(&s), 24, 0);
  OK(cag_reflect(cag_vec3(1, 1, 0), cag_vec3(1, 0, 0), &r, &err));
  NEAR(cag_transform_determinant(&r), -1, 1e-15);
  assert_true(cag_transform_mirrors(&r) && !cag_transform_mirrors(&s));
  near_vec(cag_transform_point(&r, cag_vec3(3, 3, 1)), cag_vec3(-2, -2, 1), 1e-14);
  // Reference 02-04, 2.16: mirror in the line y = (x + 4) / 2 of the points (2, 4), (4, 6), (2, 6).
  OK(cag_reflect_line(cag_vec3(0, 2, 0), cag_vec3(2, 3, 0), &r, &err));
  near_vec(cag_transform_point(&r, cag_vec3(2, 4, 0)), cag_vec3(2.8, 2.4, 0), 1e-14);
  assert_true(r.planar);
  double scale;
  assert_true(!cag_transform_is_similarity(&s, &scale));
  OK(cag_scale(cag_vec3(-2, 2, 2), origin, &s, &err));
  assert_true(cag_transform_is_similarity(&s, &scale) && scale == 2);
}

// Images of a point under parallel projection along (1, 1, 1) and central from (0, 0, 4) onto z =
// 0.
static void projections_land_in_the_plane(void **state) {
  (void)state;
  CagPlane ground;
  CagTransform t;
  OK(cag_plane(origin, axis_z, &ground, &err));
  OK(cag_project_parallel(&ground, cag_vec3(1, 1, 1), &t, &err));
  near_vec(cag_transform_point(&t, cag_vec3(5, 6, 2)), cag_vec3(3, 4, 0), 1e-15);
  OK(cag_project_central(&ground, cag_vec3(0, 0, 4), &t, &err));
  near_vec(cag_transform_point(&t, cag_vec3(1, 2, 2)), cag_vec3(2, 4, 0), 1e-15);
  FAILS(cag_project_parallel(&ground, axis_x, &t, &err), "parallel-to-plane");
  FAILS(cag_project_central(&ground, cag_vec3(3, 4, 0), &t, &err), "center-in-plane");
}

static void planes_move_with_their_points(void **state) {
  (void)state;
  CagPlane p, q;
  OK(cag_plane_through(cag_vec3(1, 0, 0), cag_vec3(0, 1, 0), cag_vec3(0, 0, 1), &p, &err));
  double row[4];
  cag_plane_row(&p, row);
  for (int i = 0; i < 3; i++) NEAR(row[i], 1 / sqrt(3), 1e-15);
  NEAR(row[3], -1 / sqrt(3), 1e-15);
  CagTransform shear = cag_shear(0.5, 0, 0, 1, 0, 0);
  OK(cag_plane_transform(&p, &shear, &q, &err));
  for (int i = 0; i < 3; i++) {
    CagVec3 e = cag_vec3(i == 0, i == 1, i == 2);
    NEAR(cag_dot(cag_sub(cag_transform_point(&shear, e), q.point), q.normal), 0, 1e-15);
  }
  FAILS(cag_plane_through(origin, axis_x, cag_vec3(3, 0, 0), &p, &err), "collinear-points");
  const double none[4] = {0, 0, 0, 1};
  FAILS(cag_plane_from_row(none, &p, &err), "zero-vector");
}

static void cameras_look_along_z_with_y_down(void **state) {
  (void)state;
  CagTransform t;
  OK(cag_look_at(cag_vec3(0, -10, 0), origin, axis_z, &t, &err));
  near_vec(cag_transform_vector(&t, axis_x), axis_x, 0);
  near_vec(cag_transform_vector(&t, axis_y), cag_vec3(0, 0, -1), 0);
  near_vec(cag_transform_vector(&t, axis_z), axis_y, 0);
  FAILS(cag_look_at(cag_vec3(0, 0, 5), origin, axis_z, &t, &err), "parallel-axes");
  FAILS(cag_look_at(origin, origin, axis_z, &t, &err), "coincident-points");
  OK(cag_axes(cag_vec3(1, 2, 3), cag_vec3(0, 2, 0), cag_vec3(-1, 5, 0), &t, &err));
  near_vec(cag_transform_vector(&t, axis_x), axis_y, 0);
  near_vec(cag_transform_vector(&t, axis_y), cag_vec3(-1, 0, 0), 0);
}

// Reference 07, 7.8: the z-y-x matrix written out.
static void euler_zyx_is_the_matrix_of_the_reference(void **state) {
  (void)state;
  double f = 0.3, t = -0.7, s = 1.1;
  const double expected[4][4] = {{cos(f) * cos(t), cos(f) * sin(t) * sin(s) - sin(f) * cos(s),
                                  cos(f) * sin(t) * cos(s) + sin(f) * sin(s), 0},
                                 {sin(f) * cos(t), sin(f) * sin(t) * sin(s) + cos(f) * cos(s),
                                  sin(f) * sin(t) * cos(s) - cos(f) * sin(s), 0},
                                 {-sin(t), cos(t) * sin(s), cos(t) * cos(s), 0},
                                 {0, 0, 0, 1}};
  CagTransform e, r = cag_rpy(s, t, f);
  OK(cag_euler(f, t, s, "zyx", &e, &err));
  near_matrix(&e, expected, 1e-15);
  near_matrix(&r, expected, 1e-15);
}

static const char *const orders[12] = {"xyz", "xzy", "yxz", "yzx", "zxy", "zyx",
                                       "xyx", "xzx", "yxy", "yzy", "zxz", "zyz"};

static void euler_angles_come_back_from_all_orders(void **state) {
  (void)state;
  for (int i = 0; i < 12; i++) {
    // Proper orders have the middle angle in (0, 180deg), the others in (-90deg, 90deg).
    double a = 2.5, b = i < 6 ? -0.8 : 2.1, c = -1.3, abc[3];
    bool singular;
    CagTransform t, back;
    OK(cag_euler(a, b, c, orders[i], &t, &err));
    OK(cag_euler_of(&t, orders[i], abc, &singular, &err));
    assert_false(singular);
    NEAR(abc[0], a, 1e-14);
    NEAR(abc[1], b, 1e-14);
    NEAR(abc[2], c, 1e-14);
    for (int k = 0; k < 2; k++) { // both locks
      double lock = i < 6 ? (k ? M_PI / 2 : -M_PI / 2) : k ? M_PI : 0;
      OK(cag_euler(a, lock, c, orders[i], &t, &err));
      OK(cag_euler_of(&t, orders[i], abc, &singular, &err));
      assert_true(singular && abc[2] == 0);
      OK(cag_euler(abc[0], abc[1], 0, orders[i], &back, &err));
      near_transform(&back, &t, 1e-14);
    }
  }
  CagTransform t;
  FAILS(cag_euler(0, 0, 0, "zzx", &t, &err), "euler-order");
  FAILS(cag_euler(0, 0, 0, "abc", &t, &err), "euler-order");
  double rpy[3];
  bool singular;
  t = cag_rpy(0.4, 0.5, -3);
  OK(cag_rpy_of(&t, rpy, &singular, &err));
  NEAR(rpy[0], 0.4, 1e-15);
  NEAR(rpy[1], 0.5, 1e-15);
  NEAR(rpy[2], -3, 1e-15);
  t = cag_rpy(0.4, M_PI / 2, 1);
  OK(cag_rpy_of(&t, rpy, &singular, &err));
  CagTransform back = cag_rpy(rpy[0], rpy[1], rpy[2]);
  assert_true(singular && rpy[2] == 0);
  near_transform(&back, &t, 1e-14);
}

static void quaternions_and_axes_come_back(void **state) {
  (void)state;
  for (int k = 0; k <= 24; k++) {
    double angle = M_PI * k / 24, back, q[4];
    bool singular;
    CagVec3 axis = cag_unit(cag_vec3(1, -2, 0.5)), found;
    CagTransform t, u;
    OK(cag_rotate(axis, angle, origin, &t, &err));
    OK(cag_axis_angle_of(&t, &found, &back, &singular, &err));
    NEAR(back, angle, 1e-14);
    assert_true(singular == (k == 0));
    if (k > 0 && k < 24) near_vec(found, axis, 1e-14);
    OK(cag_quaternion_of(&t, q, &err));
    NEAR(q[0], cos(angle / 2), 1e-14);
    OK(cag_quaternion(q, &u, &err));
    near_transform(&u, &t, 1e-14);
  }
  const double none[4] = {0, 0, 0, 0};
  CagTransform t, mirror;
  double q[4];
  FAILS(cag_quaternion(none, &t, &err), "zero-quaternion");
  OK(cag_reflect(axis_x, origin, &mirror, &err));
  FAILS(cag_quaternion_of(&mirror, q, &err), "not-a-rotation");
}

static void mixing_goes_the_short_way(void **state) {
  (void)state;
  CagTransform a = cag_transform_identity(), b, m, half, move = cag_translate(cag_vec3(4, 0, 2));
  OK(cag_rotate(axis_z, 2.4, origin, &b, &err));
  b = cag_transform_multiply(&move, &b);
  OK(cag_transform_mix(&a, &b, 0.25, &m, &err));
  OK(cag_rotate(axis_z, 0.6, origin, &half, &err));
  half.m[0][3] = 1;
  half.m[2][3] = 0.5;
  near_transform(&m, &half, 1e-15);
  CagTransform s;
  OK(cag_scale(cag_vec3(2, 2, 2), origin, &s, &err));
  FAILS(cag_transform_mix(&a, &s, 0.5, &m, &err), "not-rigid");
}

// Denavit-Hartenberg as the product of its four steps.
static void dh_is_the_product_of_its_steps(void **state) {
  (void)state;
  double theta = 0.4, d = 3, a = 2, alpha = -1.2;
  CagTransform rz, rx, tz = cag_translate(cag_vec3(0, 0, d)), tx = cag_translate(cag_vec3(a, 0, 0));
  OK(cag_rotate(axis_z, theta, origin, &rz, &err));
  OK(cag_rotate(axis_x, alpha, origin, &rx, &err));
  CagTransform p = cag_transform_multiply(&rz, &tz), link = cag_dh(theta, d, a, alpha);
  p = cag_transform_multiply(&p, &tx);
  p = cag_transform_multiply(&p, &rx);
  near_transform(&link, &p, 1e-15);
  p = cag_transform_multiply(&rx, &tx);
  p = cag_transform_multiply(&p, &rz);
  p = cag_transform_multiply(&p, &tz);
  link = cag_mdh(theta, d, a, alpha);
  near_transform(&link, &p, 1e-15);
}

static void point_pairs_give_their_transform(void **state) {
  (void)state;
  CagTransform t;
  // Vector t2.solve-affine (transposed: columns here).
  const CagVec3 p[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  const CagVec3 q[3] = {{1, 2, 0}, {3, 3, 0}, {0, 4, 0}};
  OK(cag_transform_from(p, q, 3, true, &t, &err));
  const double affine[4][4] = {{2, -1, 0, 1}, {1, 2, 0, 2}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  near_matrix(&t, affine, 1e-15);
  // Two pairs: turn, scale and move.
  const CagVec3 two[2] = {{1, 1, 0}, {1, 3, 0}};
  OK(cag_transform_from(p, two, 2, true, &t, &err));
  near_vec(cag_transform_point(&t, cag_vec3(0, 1, 0)), cag_vec3(-1, 1, 0), 1e-15);
  // Four pairs of the plane: a square seen in perspective.
  const CagVec3 seen[4] = {{0, 0, 0}, {4, 0, 0}, {1, 2, 0}, {3, 2, 0}};
  OK(cag_transform_from(p, seen, 4, true, &t, &err));
  for (int i = 0; i < 4; i++) near_vec(cag_transform_point(&t, p[i]), seen[i], 1e-14);
  near_vec(cag_transform_point(&t, cag_vec3(0.5, 0.5, 0)), cag_vec3(2, 4.0 / 3, 0), 1e-14);
  // Four pairs that are an affine image give an affine transform.
  const CagVec3 moved[4] = {{1, 1, 0}, {3, 1, 0}, {1, 4, 0}, {3, 4, 0}};
  OK(cag_transform_from(p, moved, 4, true, &t, &err));
  assert_true(cag_transform_is_affine(&t));
  // Space.
  const CagVec3 s[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const CagVec3 u[4] = {{1, 1, 1}, {1, 2, 1}, {1, 1, 3}, {0, 1, 1}};
  OK(cag_transform_from(s, u, 4, false, &t, &err));
  near_vec(cag_transform_point(&t, cag_vec3(1, 1, 1)), cag_vec3(0, 2, 3), 1e-15);
  FAILS(cag_transform_from(p, u, 4, false, &t, &err), "coplanar-points");
  const CagVec3 line[3] = {{0, 0, 0}, {1, 1, 0}, {2, 2, 0}};
  FAILS(cag_transform_from(line, q, 3, true, &t, &err), "collinear-points");
  FAILS(cag_transform_from(line, q, 1, true, &t, &err), "point-count");
}

static CagTransformClass classify(const CagTransform *t) {
  CagTransformClass c;
  OK(cag_transform_classify(t, &c, &err));
  return c;
}

static void transforms_are_classified(void **state) {
  (void)state;
  CagTransform t = cag_transform_identity(), u;
  CagTransformClass c = classify(&t);
  assert_string_equal(c.name, "rigid");
  assert_string_equal(c.fixed, "all");
  // A turn about a line far from the origin.
  OK(cag_rotate(cag_vec3(0, 3, 0), 1e-3, cag_vec3(1e4, 7, 5), &t, &err));
  c = classify(&t);
  assert_string_equal(c.name, "rigid");
  assert_string_equal(c.fixed, "line");
  near_vec(c.fixed_point, cag_vec3(1e4, 0, 5), 1e-6);
  NEAR(fabs(c.fixed_direction.y), 1, 1e-9);
  NEAR(c.angle, 1e-3, 1e-13);
  // A screw has no fixed point.
  u = cag_translate(cag_vec3(0, 1, 0));
  t = cag_transform_multiply(&u, &t);
  assert_string_equal(classify(&t).fixed, "none");
  OK(cag_reflect(cag_vec3(1, 1, 0), cag_vec3(2, 0, 0), &t, &err));
  c = classify(&t);
  assert_string_equal(c.name, "mirror");
  assert_string_equal(c.fixed, "plane");
  near_vec(c.fixed_point, cag_vec3(1, 1, 0), 1e-12);
  OK(cag_scale(cag_vec3(2, 2, 2), cag_vec3(1, 2, 3), &t, &err));
  c = classify(&t);
  assert_string_equal(c.name, "similarity");
  NEAR(c.scale, 2, 1e-15);
  assert_string_equal(c.fixed, "point");
  near_vec(c.fixed_point, cag_vec3(1, 2, 3), 1e-12);
  t = cag_shear(0.5, 0, 0, 0, 0, 0);
  c = classify(&t);
  assert_string_equal(c.name, "affine");
  assert_string_equal(c.fixed, "plane");
  CagPlane plane;
  OK(cag_plane(cag_vec3(0, 0, 1), axis_z, &plane, &err));
  OK(cag_project_central(&plane, cag_vec3(0, 0, 5), &t, &err));
  c = classify(&t);
  assert_string_equal(c.name, "projective");
  assert_string_equal(c.fixed, "plane");
  near_vec(c.fixed_point, cag_vec3(0, 0, 1), 1e-9);
  // In the plane a turn fixes one point.
  OK(cag_rotate(axis_z, -0.4, cag_vec3(3, 4, 0), &t, &err));
  t.planar = true;
  c = classify(&t);
  assert_string_equal(c.fixed, "point");
  NEAR(c.angle, -0.4, 1e-15);
  near_vec(c.fixed_point, cag_vec3(3, 4, 0), 1e-12);
}

static void numbers_read_back(void **state) {
  (void)state;
  char buffer[32];
  assert_string_equal(cag_number_text(0.1, buffer), "0.1");
  assert_string_equal(cag_number_text(3, buffer), "3");
  assert_string_equal(cag_number_text(1e300, buffer), "1e+300");
  assert_true(strtod(cag_number_text(0.1 + 0.2, buffer), NULL) == 0.1 + 0.2);
  assert_string_equal(cag_number_text(-INFINITY, buffer), "-inf");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(special_angles_are_exact),
      cmocka_unit_test(quarter_turns_are_exact),
      cmocka_unit_test(a_third_of_a_turn_about_the_diagonal_permutes_the_axes),
      cmocka_unit_test(inverses_undo),
      cmocka_unit_test(determinants_and_mirrors),
      cmocka_unit_test(projections_land_in_the_plane),
      cmocka_unit_test(planes_move_with_their_points),
      cmocka_unit_test(cameras_look_along_z_with_y_down),
      cmocka_unit_test(euler_zyx_is_the_matrix_of_the_reference),
      cmocka_unit_test(euler_angles_come_back_from_all_orders),
      cmocka_unit_test(quaternions_and_axes_come_back),
      cmocka_unit_test(mixing_goes_the_short_way),
      cmocka_unit_test(dh_is_the_product_of_its_steps),
      cmocka_unit_test(point_pairs_give_their_transform),
      cmocka_unit_test(transforms_are_classified),
      cmocka_unit_test(numbers_read_back),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
