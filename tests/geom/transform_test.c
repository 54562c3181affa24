// Transforms compared with their definitions and the reference's examples.

#include "geom/linalg/transform.h"
#include "random.h"
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
  static const double exact[12] = {0, 0.5, 0, 1, 0, 0.5, 0, -0.5, 0, -1, 0, -0.5}; // 0: not checked
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
  cag_sincos(1e-9, &s, &c); // a small angle is not a multiple
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
  // Very small and very large scales are not singular.
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
  // Reference 02-04, 2.16: reflection in the line y = (x + 4) / 2 of the points (2, 4), (4, 6), (2,
  // 6).
  OK(cag_reflect_line(cag_vec3(0, 2, 0), cag_vec3(2, 3, 0), &r, &err));
  near_vec(cag_transform_point(&r, cag_vec3(2, 4, 0)), cag_vec3(2.8, 2.4, 0), 1e-14);
  assert_true(r.planar);
  double scale;
  assert_true(!cag_transform_is_similarity(&s, &scale));
  OK(cag_scale(cag_vec3(-2, 2, 2), origin, &s, &err));
  assert_true(cag_transform_is_similarity(&s, &scale) && scale == 2);
}

// Images of a point on the plane z = 0 under a parallel projection along (1, 1, 1), and a central
// one from (0, 0, 4).
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
    for (int k = 0; k < 2; k++) { // both gimbal locks
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

// Denavit-Hartenberg transforms are products of four steps.
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
  // Golden vector t2.solve-affine (transposed: these are columns).
  const CagVec3 p[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  const CagVec3 q[3] = {{1, 2, 0}, {3, 3, 0}, {0, 4, 0}};
  OK(cag_transform_from(p, q, 3, true, &t, &err));
  const double affine[4][4] = {{2, -1, 0, 1}, {1, 2, 0, 2}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  near_matrix(&t, affine, 1e-15);
  // Two pairs: rotation, scale, and translation.
  const CagVec3 two[2] = {{1, 1, 0}, {1, 3, 0}};
  OK(cag_transform_from(p, two, 2, true, &t, &err));
  near_vec(cag_transform_point(&t, cag_vec3(0, 1, 0)), cag_vec3(-1, 1, 0), 1e-15);
  // Four pairs in the plane: a square in perspective.
  const CagVec3 seen[4] = {{0, 0, 0}, {4, 0, 0}, {1, 2, 0}, {3, 2, 0}};
  OK(cag_transform_from(p, seen, 4, true, &t, &err));
  for (int i = 0; i < 4; i++) near_vec(cag_transform_point(&t, p[i]), seen[i], 1e-14);
  near_vec(cag_transform_point(&t, cag_vec3(0.5, 0.5, 0)), cag_vec3(2, 4.0 / 3, 0), 1e-14);
  // If four pairs are an affine image, the transform is affine.
  const CagVec3 moved[4] = {{1, 1, 0}, {3, 1, 0}, {1, 4, 0}, {3, 4, 0}};
  OK(cag_transform_from(p, moved, 4, true, &t, &err));
  assert_true(cag_transform_is_affine(&t));
  // In space.
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
  // A rotation about a line far from the origin.
  OK(cag_rotate(cag_vec3(0, 3, 0), 1e-3, cag_vec3(1e4, 7, 5), &t, &err));
  c = classify(&t);
  assert_string_equal(c.name, "rigid");
  assert_string_equal(c.fixed, "line");
  near_vec(c.fixed_point, cag_vec3(1e4, 0, 5), 1e-6);
  NEAR(fabs(c.fixed_direction.y), 1, 1e-9);
  NEAR(c.angle, 1e-3, 1e-13);
  // A screw motion has no fixed point.
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
  // In the plane, a rotation has one fixed point.
  OK(cag_rotate(axis_z, -0.4, cag_vec3(3, 4, 0), &t, &err));
  t.planar = true;
  c = classify(&t);
  assert_string_equal(c.fixed, "point");
  NEAR(c.angle, -0.4, 1e-15);
  near_vec(c.fixed_point, cag_vec3(3, 4, 0), 1e-12);
}

// --- Random matrices and transforms ---

static CagVec3 random_vec(double size) {
  CagVec3 v;
  v.x = uniform(-size, size);
  v.y = uniform(-size, size);
  v.z = uniform(-size, size);
  return v;
}

static CagTransform random_matrix(bool affine) {
  CagTransform t = {.planar = false};
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) t.m[i][j] = affine && i == 3 && j < 3 ? 0 : uniform(-2, 2);
  return t;
}

// The determinant by all permutations.
static double brute_determinant(const double m[4][4]) {
  double sum = 0;
  for (int code = 0; code < 256; code++) {
    const int p[4] = {code & 3, code >> 2 & 3, code >> 4 & 3, code >> 6};
    double product = 1;
    for (int i = 0; i < 4; i++) {
      product *= m[i][p[i]];
      for (int j = 0; j < i; j++) product *= p[j] == p[i] ? 0 : p[j] > p[i] ? -1 : 1;
    }
    sum += product;
  }
  return sum;
}

static void matrices_follow_their_definitions(void **state) {
  (void)state;
  seed = 61;
  for (int i = 0; i < 200; i++) {
    const CagTransform a = random_matrix(i % 2), b = random_matrix(i % 3 == 0);
    const CagTransform ab = cag_transform_multiply(&a, &b);
    const CagVec3 p = random_vec(2);
    const double h[4] = {p.x, p.y, p.z, uniform(0.5, 2)};
    double image[4], vector[4] = {0}, point[4], out[4];
    for (int r = 0; r < 4; r++) {
      image[r] = 0;
      point[r] = a.m[r][3];
      for (int k = 0; k < 4; k++) {
        double sum = 0;
        for (int j = 0; j < 4; j++) sum += a.m[r][j] * b.m[j][k];
        NEAR(ab.m[r][k], sum, 1e-14);
        image[r] += a.m[r][k] * h[k];
        if (k < 3) vector[r] += a.m[r][k] * h[k];
      }
      point[r] += vector[r];
    }
    cag_transform_homogeneous(&a, h, out);
    for (int r = 0; r < 4; r++) NEAR(out[r], image[r], 1e-14);
    const CagVec3 where = {point[0] / point[3], point[1] / point[3], point[2] / point[3]};
    near_vec(cag_transform_point(&a, p), where, 1e-13 * (1 + cag_norm(where)));
    near_vec(cag_transform_vector(&a, p),
             cag_scaled(cag_vec3(vector[0], vector[1], vector[2]), 1 / a.m[3][3]),
             1e-13 * (1 + 1 / fabs(a.m[3][3])));
    NEAR(cag_transform_determinant(&a), brute_determinant(a.m), 1e-13);
    double linear[4][4];
    for (int r = 0; r < 4; r++)
      for (int k = 0; k < 4; k++) linear[r][k] = r == 3 || k == 3 ? r == k : a.m[r][k];
    assert_true(cag_transform_mirrors(&a) == (brute_determinant(linear) * a.m[3][3] < 0));
    CagTransform inverse;
    OK(cag_transform_inverse(&a, &inverse, &err));
    const CagTransform one = cag_transform_multiply(&a, &inverse), none = cag_transform_identity();
    near_transform(&one, &none, 1e-10);
    // Derivatives of a curve are mapped there and back.
    CagVec3 d[7], there[7];
    for (int k = 0; k < 7; k++) there[k] = d[k] = random_vec(1);
    if (fabs(point[3]) < 0.5) continue;
    there[0] = d[0] = p;
    assert_true(cag_transform_derivatives(&a, 6, there));
    near_vec(there[0], where, 1e-12 * (1 + cag_norm(where)));
    // w q = numerator, whose derivative is w' q + w q'.
    const CagVec3 v = {a.m[0][0] * d[1].x + a.m[0][1] * d[1].y + a.m[0][2] * d[1].z,
                       a.m[1][0] * d[1].x + a.m[1][1] * d[1].y + a.m[1][2] * d[1].z,
                       a.m[2][0] * d[1].x + a.m[2][1] * d[1].y + a.m[2][2] * d[1].z};
    const double w = a.m[3][0] * d[1].x + a.m[3][1] * d[1].y + a.m[3][2] * d[1].z;
    near_vec(cag_madd(cag_scaled(there[1], point[3]), w, there[0]), v,
             1e-11 * (1 + cag_norm(where)));
    assert_true(cag_transform_derivatives(&inverse, 6, there));
    for (int k = 0; k < 7; k++) near_vec(there[k], d[k], 1e-3 * (1 + cag_norm(d[k])));
  }
}

static void singular_matrices_have_no_inverse(void **state) {
  (void)state;
  seed = 62;
  for (int i = 0; i < 100; i++) {
    CagTransform t = random_matrix(i % 2), out;
    const int rows = i % 2 ? 3 : 4;
    // One row is twice another, which is exact in both computations.
    const int a = i % rows, b = (a + 1 + i / 4 % (rows - 1)) % rows;
    for (int k = 0; k < 4; k++) t.m[a][k] = 2 * t.m[b][k];
    FAILS(cag_transform_inverse(&t, &out, &err), "singular-transform");
    t.m[a][i % 3] += 1e-9;
    OK(cag_transform_inverse(&t, &out, &err));
    for (int k = 0; k < 4; k++) t.m[a][k] = 0;
    FAILS(cag_transform_inverse(&t, &out, &err), "singular-transform");
    t = random_matrix(i % 2);
    t.m[i % 4][i / 4 % 4] = i % 3 ? NAN : INFINITY;
    FAILS(cag_transform_inverse(&t, &out, &err), "not-finite");
  }
}

static void similarities_are_told_to_rounding(void **state) {
  (void)state;
  seed = 63;
  for (int i = 0; i < 60; i++) {
    const double factor = i % 2 ? -uniform(0.1, 5) : uniform(0.1, 5),
                 w = i % 3 ? uniform(-2, -1) : 1;
    CagTransform t, turn;
    double scale = 0;
    OK(cag_rotate(cag_unit(random_vec(1)), uniform(-3, 3), random_vec(2), &turn, &err));
    OK(cag_scale(cag_vec3(factor, factor, factor), origin, &t, &err));
    t = cag_transform_multiply(&t, &turn);
    t.m[3][3] = w;
    assert_true(cag_transform_is_similarity(&t, &scale));
    assert_true(cag_transform_is_similarity(&t, NULL));
    NEAR(scale, fabs(factor / w), 1e-14 * fabs(factor));
    for (int r = 0; r < 3; r++)
      for (int k = 0; k < 3; k++) {
        CagTransform bent = t;
        if (fabs(t.m[r][k] / factor) < 1e-3) continue;
        bent.m[r][k] *= 1 + 1e-7;
        assert_false(cag_transform_is_similarity(&bent, &scale));
      }
    for (int k = 0; k < 3; k++) {
      CagTransform bent = t;
      bent.m[3][k] = 1e-3;
      assert_false(cag_transform_is_affine(&bent) || cag_transform_is_similarity(&bent, &scale));
    }
    assert_true(cag_transform_is_affine(&t));
    t.m[3][3] = 0;
    assert_false(cag_transform_is_affine(&t));
  }
  // Each pair of columns is perpendicular, and all have the length of the first.
  for (int k = 0; k < 3; k++) {
    CagTransform t = cag_transform_identity();
    t.m[k][k] = 1 + 1e-9;
    assert_false(cag_transform_is_similarity(&t, NULL));
    t.m[k][k] = 1 + 1e-13;
    assert_true(cag_transform_is_similarity(&t, NULL));
    t.m[k][(k + 1) % 3] = 1e-9;
    assert_false(cag_transform_is_similarity(&t, NULL));
    t.m[k][(k + 1) % 3] = -1e-9;
    assert_false(cag_transform_is_similarity(&t, NULL));
    t.m[k][(k + 1) % 3] = -1e-13;
    assert_true(cag_transform_is_similarity(&t, NULL));
  }
  const CagTransform zero = {.m = {{0}, {0}, {0}, {0, 0, 0, 1}}};
  assert_false(cag_transform_is_similarity(&zero, NULL));
}

static void random_motions_have_their_fixed_set(void **state) {
  (void)state;
  seed = 21;
  static const double units[3] = {1, 1e5, 1e-5};
  for (int i = 0; i < 180; i++) {
    const double unit = units[i % 3], angle = uniform(0.1, 3), factor = uniform(1.3, 4);
    const CagVec3 axis = cag_unit(random_vec(1)), about = random_vec(3 * unit);
    const CagVec3 along = cag_scaled(axis, unit * uniform(0.5, 2));
    CagTransform turn, t, mirror, scale;
    OK(cag_rotate(axis, angle, about, &turn, &err));
    OK(cag_reflect(axis, about, &mirror, &err));
    OK(cag_scale(cag_vec3(factor, factor, factor), about, &scale, &err));
    t = turn;
    const int kind = i / 3 % 6;
    const CagTransform shift = cag_translate(along);
    if (kind == 1) t = cag_transform_multiply(&shift, &turn); // a screw motion
    if (kind == 2) t = mirror;
    if (kind == 3) t = cag_transform_multiply(&mirror, &turn); // only the center is fixed
    if (kind == 4) t = cag_transform_multiply(&scale, &turn);
    if (kind == 5) t = cag_transform_multiply(&scale, &mirror);
    // A common factor does not matter.
    const double common = i % 2 ? uniform(0.1, 10) : 1;
    for (int r = 0; r < 4; r++)
      for (int k = 0; k < 4; k++) t.m[r][k] *= common;
    const CagTransformClass c = classify(&t);
    static const char *const names[] = {"rigid",  "rigid",      "mirror",
                                        "mirror", "similarity", "similarity"};
    static const char *const fixed[] = {"line", "none", "plane", "point", "point", "point"};
    assert_string_equal(c.name, names[kind]);
    assert_string_equal(c.fixed, fixed[kind]);
    NEAR(c.scale, kind >= 4 ? factor : 1, 1e-12);
    assert_true(c.has_rotation == (kind < 2 || kind == 4));
    if (c.has_rotation) {
      near_vec(c.axis, axis, 1e-11);
      NEAR(c.angle, angle, 1e-11);
    }
    // The point of the fixed set closest to the origin.
    const double height = cag_dot(about, axis);
    if (kind == 0) near_vec(c.fixed_point, cag_madd(about, -height, axis), 1e-8 * unit);
    if (kind == 2) near_vec(c.fixed_point, cag_scaled(axis, height), 1e-8 * unit);
    if (kind >= 3) near_vec(c.fixed_point, about, 1e-8 * unit);
    if (kind == 0 || kind == 2) near_vec(cag_cross(c.fixed_direction, axis), origin, 1e-8);
    NEAR(cag_norm(c.fixed_direction), kind == 0 || kind == 2, 1e-12);
  }
}

static void random_maps_of_the_plane_have_their_fixed_set(void **state) {
  (void)state;
  seed = 22;
  for (int i = 0; i < 120; i++) {
    const double angle = uniform(-3, 3), factor = uniform(1.2, 3);
    CagVec3 about = random_vec(4), other = random_vec(4);
    about.z = other.z = 0;
    const int kind = i % 6;
    CagTransform t;
    OK(cag_rotate(axis_z, angle, about, &t, &err));
    CagTransform scale;
    OK(cag_scale(cag_vec3(factor, factor, 1), about, &scale, &err));
    if (kind == 1) OK(cag_reflect_line(about, other, &t, &err));
    if (kind == 2) t = cag_translate(about);
    if (kind == 3) t = cag_transform_multiply(&scale, &t);
    if (kind == 4) { OK(cag_scale(cag_vec3(factor, 0.5, 1), about, &t, &err)); }
    if (kind == 5) { // a homology: it fixes the points of a line, and one more
      t = cag_transform_identity();
      t.m[3][0] = 0.02;
      t.m[3][1] = -0.03;
    }
    t.planar = true;
    const CagTransformClass c = classify(&t);
    static const char *const names[] = {"rigid",      "mirror", "rigid",
                                        "similarity", "affine", "projective"};
    static const char *const fixed[] = {"point", "line", "none", "point", "point", "line"};
    assert_string_equal(c.name, names[kind]);
    assert_string_equal(c.fixed, fixed[kind]);
    NEAR(c.scale, kind == 3 ? factor : 1, 1e-12);
    assert_true(c.has_rotation == (kind == 0 || kind == 2 || kind == 3));
    if (c.has_rotation) {
      near_vec(c.axis, axis_z, 0);
      NEAR(c.angle, kind == 2 ? 0 : angle, 1e-12);
    }
    if (kind == 0 || kind == 3 || kind == 4) near_vec(c.fixed_point, about, 1e-10);
    if (kind == 1) {
      const CagVec3 d = cag_unit(cag_sub(other, about));
      near_vec(cag_cross(c.fixed_direction, d), origin, 1e-9);
      near_vec(c.fixed_point, cag_madd(about, -cag_dot(about, d), d), 1e-8);
    }
    if (kind == 5) {
      near_vec(c.fixed_point, origin, 1e-9);
      NEAR(0.02 * c.fixed_direction.x - 0.03 * c.fixed_direction.y, 0, 1e-9);
    }
  }
  CagTransform t = cag_transform_identity();
  assert_string_equal(classify(&t).fixed, "all");
  near_vec(classify(&t).fixed_point, origin, 0);
  near_vec(classify(&t).fixed_direction, origin, 0);
  t.m[3][3] = 5;
  for (int i = 0; i < 3; i++) t.m[i][i] = 5;
  t.planar = false;
  assert_string_equal(classify(&t).fixed, "all");
  assert_string_equal(classify(&t).name, "rigid");
  for (int i = 0; i < 16; i++) {
    t = cag_transform_identity();
    t.m[i / 4][i % 4] = i % 2 ? NAN : INFINITY;
    CagTransformClass c;
    FAILS(cag_transform_classify(&t, &c, &err), "not-finite");
  }
}

// Deviations of 1e-10 are rounding, and deviations of 1e-8 are not.
static void classes_have_a_tolerance(void **state) {
  (void)state;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      CagTransform t = cag_transform_identity();
      t.planar = false;
      t.m[i][j] += 1e-10;
      assert_string_equal(classify(&t).name, "rigid");
      t.m[i][j] += 1e-8;
      assert_string_equal(classify(&t).name, "affine");
      t = cag_transform_identity();
      if (i == 2 || j == 2) continue;
      t.m[i][j] -= 1e-8;
      assert_string_equal(classify(&t).name, "affine");
    }
}

// A random affine or projective map is recovered from its points.
static void random_point_pairs_give_their_transform(void **state) {
  (void)state;
  seed = 23;
  for (int i = 0; i < 200; i++) {
    const int kind = i % 4; // similarity, affine, projective, affine in space
    const size_t n = kind == 0 ? 2 : kind == 1 ? 3 : 4;
    CagTransform t = cag_transform_identity(), found;
    const int rows = kind == 3 ? 3 : 2;
    for (int r = 0; r < rows; r++)
      for (int k = 0; k < 4; k++)
        if (kind == 3 || k != 2) t.m[r][k] = uniform(-2, 2) + 3 * (r == k);
    if (kind == 0) {
      t.m[1][1] = t.m[0][0];
      t.m[1][0] = -t.m[0][1];
    }
    if (kind == 2) {
      t.m[3][0] = uniform(-0.1, 0.1);
      t.m[3][1] = uniform(-0.1, 0.1);
    }
    CagVec3 p[4] = {{0, 0, 0}}, q[4] = {{0, 0, 0}};
    static const CagVec3 corners[4] = {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {-2, -2, 3}};
    for (size_t j = 0; j < n; j++) {
      p[j] = cag_add(corners[j], random_vec(0.5));
      if (kind != 3) p[j].z = 0;
      q[j] = cag_transform_point(&t, p[j]);
    }
    OK(cag_transform_from(p, q, n, kind != 3, &found, &err));
    assert_true(found.planar == (kind != 3));
    near_transform(&found, &t, 1e-11);
  }
  const CagVec3 p[5] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1}, {3, 2, 1}};
  CagTransform t;
  FAILS(cag_transform_from(p, p, 0, true, &t, &err), "point-count");
  FAILS(cag_transform_from(p, p, 5, true, &t, &err), "point-count");
  FAILS(cag_transform_from(p, p, 2, false, &t, &err), "point-count");
  FAILS(cag_transform_from(p, p, 3, false, &t, &err), "point-count");
  FAILS(cag_transform_from(p, p, 5, false, &t, &err), "point-count");
  for (int i = 0; i < 12; i++) {
    CagVec3 bad[4] = {p[0], p[1], p[2], p[3]};
    double *coordinate = i % 3 == 0 ? &bad[i / 3].x : i % 3 == 1 ? &bad[i / 3].y : &bad[i / 3].z;
    *coordinate = i % 2 ? NAN : INFINITY;
    FAILS_AT(cag_transform_from(bad, p, 4, false, &t, &err), "not-finite", i / 3);
    assert_string_equal(err.argument, "points");
    FAILS_AT(cag_transform_from(p, bad, 4, false, &t, &err), "not-finite", i / 3);
    assert_string_equal(err.argument, "images");
  }
}

// Four points of the plane whose map sends the origin to infinity, and an affine map that is affine
// only up to rounding.
static void quadrilaterals_have_their_map(void **state) {
  (void)state;
  seed = 24;
  for (int i = 0; i < 60; i++) {
    CagTransform t = cag_transform_identity(), found;
    for (int r = 0; r < 2; r++)
      for (int k = 0; k < 4; k++)
        if (k != 2) t.m[r][k] = uniform(-1, 1) + 2 * (r == k);
    const CagVec3 shift = cag_vec3(5 + uniform(0, 1), 3 + uniform(0, 1), 0);
    if (i % 2) {
      t.m[3][0] = uniform(0.5, 1);
      t.m[3][1] = uniform(0.5, 1);
      t.m[3][3] = 0;
    }
    CagVec3 p[4], q[4];
    for (int j = 0; j < 4; j++) {
      p[j] = cag_add(shift, cag_vec3(j % 2 + uniform(0, 0.3), j / 2, 0));
      q[j] = cag_transform_point(&t, p[j]);
    }
    OK(cag_transform_from(p, q, 4, true, &found, &err));
    for (int j = 0; j < 8; j++) {
      const CagVec3 r = cag_add(shift, cag_vec3(uniform(-1, 2), j % 3, 0));
      near_vec(cag_transform_point(&found, r), cag_transform_point(&t, r), 1e-9);
    }
    assert_true(cag_transform_is_affine(&found) == !(i % 2));
    for (int k = 0; k < 4; k++) assert_true(found.m[2][k] == (k == 2) && found.m[k][2] == (k == 2));
    // Three of them are collinear within 1e-13 of their distance, in the source or the image.
    const int skip = i % 4, a = (skip + 1) % 4, b = (skip + 2) % 4, c = (skip + 3) % 4;
    const CagVec3 save = p[a], save_q = q[a];
    p[a] = cag_lerp(p[b], p[c], 0.25);
    p[a].y += 1e-14;
    FAILS(cag_transform_from(p, q, 4, true, &found, &err), "collinear-points");
    assert_string_equal(err.argument, "points");
    p[a] = save;
    q[a] = cag_lerp(q[b], q[c], 0.25);
    FAILS(cag_transform_from(p, q, 4, true, &found, &err), "collinear-points");
    assert_string_equal(err.argument, "images");
    q[a] = save_q;
  }
  const CagVec3 near[4] = {{1, 1, 0}, {2, 1, 0}, {1, 2, 0}, {2, 2, 0}};
  CagTransform t = cag_transform_identity(), found;
  CagVec3 images[4];
  t.m[3][0] = t.m[3][1] = 1; // [2 x + y + 1, y] / (x + y)
  t.m[0][0] = 2;
  t.m[0][1] = t.m[0][3] = 1;
  t.m[3][3] = 0;
  for (int i = 0; i < 4; i++) images[i] = cag_transform_point(&t, near[i]);
  OK(cag_transform_from(near, images, 4, true, &found, &err));
  NEAR(found.m[3][3], 0, 1e-12);
  near_vec(cag_transform_point(&found, cag_vec3(3, 2, 0)), cag_vec3(1.8, 0.4, 0), 1e-12);
  // A height of 1e-13 counts as rounding, but 1e-10 does not, both in the plane and in space.
  for (int dimension = 2; dimension <= 3; dimension++)
    for (int high = 0; high < 2; high++) {
      const double height = high ? 1e-10 : 1e-13;
      CagVec3 p[4] = {{1, 1, 1}, {2, 3, 1}, {3, 5, 1}, {0, 0, 1 + height}};
      if (dimension == 2) p[2].x += height;
      else p[2].x += 1;
      const CagStatus status =
          cag_transform_from(p, p, dimension == 2 ? 3 : 4, dimension == 2, &t, &err);
      assert_true((status == CAG_OK) == high);
    }
  const CagVec3 same[2] = {{1, 2, 0}, {1, 2, 0}}, apart[2] = {{0, 0, 0}, {1, 0, 0}};
  FAILS(cag_transform_from(same, apart, 2, true, &t, &err), "coincident-points");
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
      cmocka_unit_test(matrices_follow_their_definitions),
      cmocka_unit_test(singular_matrices_have_no_inverse),
      cmocka_unit_test(similarities_are_told_to_rounding),
      cmocka_unit_test(random_motions_have_their_fixed_set),
      cmocka_unit_test(random_maps_of_the_plane_have_their_fixed_set),
      cmocka_unit_test(classes_have_a_tolerance),
      cmocka_unit_test(random_point_pairs_give_their_transform),
      cmocka_unit_test(quadrilaterals_have_their_map),
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
