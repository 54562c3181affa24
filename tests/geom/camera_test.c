// Cameras, calibration, fits, and positions, against the numbers of the reference and identities.

#include "geom/camera/camera.h"
#include "geom/camera/locate.h"
#include "geom/camera/model_fit.h"
#include "geom/camera/triangle.h"
#include "geom/linalg/dense.h"
#include "random.h"
#include "support.h"

static void near_rows(const double *a, const double *b, size_t n, double tolerance) {
  for (size_t i = 0; i < n; i++)
    if (!(fabs(a[i] - b[i]) <= tolerance)) fail_msg("[%zu] = %.17g is not %.17g", i, a[i], b[i]);
}

// The camera of the reference: K = [800 0 320; 0 800 240; 0 0 1] at (1.2, 1.9, 5.9).
static const CagVec3 reference_points[7] = {
    {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0.3}, {-0.6, 0.4, 0.8}, {0.5, -0.7, 0.2}};
static const CagVec3 reference_pixels[7] = {
    {308.690999913044, 251.6742417822148, 0},    {421.19186547895185, 190.79318098934093, 0},
    {241.64458109310206, 144.03083312850458, 0}, {306.71296012091926, 304.64534403740475, 0},
    {359.80470726429405, 83.40620865798094, 0},  {203.2949742430231, 286.4769597150441, 0},
    {408.8599970857433, 303.4320859322495, 0}};
static const double reference_rows[3][4] = {
    {638.097100095444, -494.78340247232757, -300.7016386514907, 1948.5116126266846},
    {-416.9194655134435, -722.1256969337447, 48.089885671916925, 1588.6118573259373},
    {-0.1710100716628343, -0.2961981327260238, -0.9396926207859084, 6.312175000811706}};

static void calibration_finds_the_camera_of_the_reference(void **state) {
  (void)state;
  static const double k[9] = {800, 0, 320, 0, 800, 240, 0, 0, 1};
  static const double r[9] = {0.8660254037844387,   -0.49999999999999994, 0.0,
                              -0.46984631039295416, -0.8137976813493738,  0.34202014332566866,
                              -0.1710100716628343,  -0.2961981327260238,  -0.9396926207859084};
  CagCameraMap c;
  CagCameraParts parts;
  double rms;
  OK(cag_calibrate(reference_points, reference_pixels, 7, &c, &rms, &err));
  near_rows(c.p[0], reference_rows[0], 12, 1e-8);
  cag_camera_split(&c, &parts);
  near_rows(parts.k[0], k, 9, 1e-8);
  near_rows(parts.r[0], r, 9, 1e-11);
  near_vec(c.center, cag_vec3(1.2, 1.9, 5.9), 1e-10);
  assert_false(c.parallel);
  assert_true(rms < 1e-9);
  CagVec3 origin, direction;
  cag_camera_sight(&c, (double[]){400, 200}, &origin, &direction);
  near_vec(direction, cag_vec3(-0.06053802813956964, -0.3036165385277502, -0.9508691522398862),
           1e-11);
  // Six points suffice, five do not.
  OK(cag_calibrate(reference_points + 1, reference_pixels + 1, 6, &c, &rms, &err));
  near_rows(c.p[0], reference_rows[0], 12, 1e-7);
  FAILS(cag_calibrate(reference_points, reference_pixels, 5, &c, &rms, &err),
        "too-few-model-points");
}

static void the_depth_of_a_calibrated_camera_is_positive_for_mirrored_pictures_too(void **state) {
  (void)state;
  CagVec3 pixels[7];
  CagCameraMap c;
  CagCameraParts parts;
  double rms, depth, pixel[2];
  for (size_t i = 0; i < 7; i++)
    pixels[i] = cag_vec3(640 - reference_pixels[i].x, reference_pixels[i].y, 0);
  OK(cag_calibrate(reference_points, pixels, 7, &c, &rms, &err));
  near_vec(c.center, cag_vec3(1.2, 1.9, 5.9), 1e-10);
  cag_camera_split(&c, &parts);
  for (int i = 0; i < 3; i++) assert_true(parts.k[i][i] > 0);
  const CagVec3 *r = (const CagVec3 *)(const void *)parts.r;
  NEAR(cag_dot(r[0], cag_cross(r[1], r[2])), -1, 1e-12); // a reflection
  assert_true(cag_camera_project(&c, reference_points[3], pixel, &depth));
  NEAR(depth, reference_rows[2][2] + reference_rows[2][3], 1e-9);
}

static CagVec3 random_point(double size) {
  return cag_vec3(uniform(-size, size), uniform(-size, size), uniform(-size, size));
}

// A random camera whose points within 1 of the origin are in front.
static CagCameraParts random_parts(CagVec3 *eye) {
  CagTransform frame;
  *eye = cag_scaled(cag_unit(random_point(1)), uniform(4, 9));
  OK(cag_look_at(*eye, random_point(0.2), random_point(1), &frame, &err));
  const double f = uniform(200, 900);
  CagCameraParts parts = {
      .k = {{f, uniform(-5, 5), uniform(0, 600)}, {0, f * uniform(0.9, 1.1), uniform(0, 600)}}};
  parts.k[2][2] = 1;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) parts.r[i][j] = frame.m[j][i];
  return parts;
}

static void a_sight_line_ends_at_the_projected_point(void **state) {
  (void)state;
  for (int trial = 0; trial < 200; trial++) {
    CagVec3 eye, origin, direction, back;
    const CagCameraParts parts = random_parts(&eye);
    const bool parallel = trial % 2;
    CagCameraMap c;
    double pixel[2], depth;
    OK(cag_camera_map_of_parts(&parts, eye, parallel, trial % 3, &c, &err));
    const CagVec3 p = random_point(1);
    assert_true(cag_camera_project(&c, p, pixel, &depth));
    cag_camera_sight(&c, pixel, &origin, &direction);
    NEAR(cag_norm(direction), 1, 1e-14);
    const CagVec3 way = cag_sub(p, origin);
    assert_true(cag_norm(cag_cross(way, direction)) < 1e-12 * 9);
    assert_true(cag_dot(way, direction) > 0);
    const CagVec3 view = cag_vec3(parts.r[2][0], parts.r[2][1], parts.r[2][2]);
    NEAR(depth, cag_dot(view, cag_sub(p, eye)) - (parallel ? 0 : trial % 3), 1e-12);
    CagPlane plane;
    OK(cag_plane(p, cag_add(view, random_point(0.5)), &plane, &err));
    assert_true(cag_camera_on_plane(&c, pixel, &plane, &back));
    near_vec(back, p, 1e-11);
    // What is behind the eye is not seen.
    const CagVec3 behind = cag_madd(eye, -1, view);
    assert_false(cag_camera_project(&c, behind, pixel, &depth));
    OK(cag_plane(behind, view, &plane, &err));
    assert_false(cag_camera_on_plane(&c, (double[]){300, 300}, &plane, &back));
  }
}

static void splitting_a_matrix_returns_its_parts(void **state) {
  (void)state;
  for (int trial = 0; trial < 200; trial++) {
    CagVec3 eye;
    CagCameraParts parts = random_parts(&eye), found;
    CagCameraMap c, again;
    if (trial % 2)
      for (int j = 0; j < 3; j++) parts.r[0][j] = -parts.r[0][j]; // mirrored
    OK(cag_camera_map_of_parts(&parts, eye, false, 0, &c, &err));
    // The factor of the matrix does not matter.
    double rows[3][4];
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 4; j++) rows[i][j] = 7.5 * c.p[i][j];
    OK(cag_camera_map(rows, &again, &err));
    near_rows(again.p[0], c.p[0], 12, 1e-10);
    near_vec(again.center, eye, 1e-11);
    cag_camera_split(&again, &found);
    near_rows(found.k[0], parts.k[0], 9, 1e-9);
    near_rows(found.r[0], parts.r[0], 9, 1e-12);
  }
}

static void a_singular_matrix_is_not_a_camera(void **state) {
  (void)state;
  CagCameraMap c;
  static const double dependent[3][4] = {{1, 2, 3, 4}, {2, 4, 6, 1}, {0, 0, 1, 5}};
  static const double zero[3][4] = {{0}};
  static const double flat[3][4] = {{1, 0, 0, 4}, {3, 0, 0, 1}, {0, 0, 0, 1}};
  static const double level[3][4] = {{1, 0, 0, 4}, {0, 1, 0, 1}, {0, 0, 0, 2}};
  FAILS(cag_camera_map(dependent, &c, &err), "camera-singular");
  FAILS(cag_camera_map(zero, &c, &err), "camera-singular");
  FAILS(cag_camera_map(flat, &c, &err), "camera-singular");
  OK(cag_camera_map(level, &c, &err));
  assert_true(c.parallel && !c.has_depth);
  double pixel[2], depth = 7;
  assert_true(cag_camera_project(&c, cag_vec3(6, 4, -100), pixel, &depth));
  NEAR(pixel[0], 5, 0);
  NEAR(pixel[1], 2.5, 0);
}

// --- Fits ---

static CagVec3 cube_corner(size_t i) {
  return cag_vec3((double)(i / 4), (double)(i / 2 % 2), (double)(i % 2));
}

static void the_affine_fit_of_noisy_points_is_that_of_the_reference(void **state) {
  (void)state;
  static const CagVec3 pictures[8] = {{3.02, -1.01, 0},
                                      {2.74, -0.23, 0},
                                      {3.53, 0.5, 0},
                                      {3.25, 1.28, 0},
                                      {4.98, -0.89, 0},
                                      {4.76, -0.17, 0},
                                      {5.47, 0.6100000000000001, 0},
                                      {5.27, 1.32, 0}};
  static const double rows[12] = {1.985,  0.505, -0.245, 3.005, 0.0825, 1.5025,
                                  0.7475, -0.99, 0,      0,     0,      1};
  CagVec3 points[8];
  CagModelFit fit;
  for (size_t i = 0; i < 8; i++) points[i] = cube_corner(i);
  OK(cag_model_fit_affine(points, pictures, 8, &fit, &err));
  near_rows(fit.rows[0], rows, 12, 1e-13);
  NEAR(fit.error, 0.19461205232955608, 1e-13);
  NEAR(fit.rms, 0.024622144504490205, 1e-14);
  FAILS(cag_model_fit_affine(points, pictures, 4, &fit, &err), "model-points-coplanar");
  FAILS(cag_model_fit_affine(points, pictures, 3, &fit, &err), "too-few-model-points");
}

static void the_affine_fit_does_not_depend_on_position_and_unit(void **state) {
  (void)state;
  CagVec3 points[20], pictures[20], far[20];
  CagModelFit fit, other;
  for (size_t i = 0; i < 20; i++) {
    points[i] = random_point(1);
    pictures[i] = cag_vec3(uniform(-1, 1), uniform(-1, 1), 0);
    far[i] = cag_add(cag_scaled(points[i], 1e-3), cag_vec3(1000, -2000, 500));
  }
  OK(cag_model_fit_affine(points, pictures, 20, &fit, &err));
  OK(cag_model_fit_affine(far, pictures, 20, &other, &err));
  NEAR(fit.error, other.error, 1e-8);
  // The residuals of a least-squares fit are orthogonal to the coordinates of the points.
  for (int axis = 0; axis < 2; axis++) {
    CagVec3 moment = {0, 0, 0};
    double sum = 0;
    for (size_t i = 0; i < 20; i++) {
      const double *h = fit.rows[axis];
      const double residual = h[0] * points[i].x + h[1] * points[i].y + h[2] * points[i].z + h[3] -
                              (axis ? pictures[i].y : pictures[i].x);
      moment = cag_madd(moment, residual, points[i]);
      sum += residual;
    }
    assert_true(cag_norm(moment) < 1e-13 && fabs(sum) < 1e-13);
  }
}

static void the_projective_fit_is_that_of_the_reference(void **state) {
  (void)state;
  static const CagVec3 points[7] = {{0, 0, 0}, {1, 0, 0},   {0, 1, 0},      {0, 0, 1},
                                    {1, 1, 0}, {1, 0, 1.5}, {0.5, 1.2, 1.0}};
  static const CagVec3 pictures[7] = {{0.5, 0.25, 0},
                                      {1.8181818181818181, -0.04545454545454544, 0},
                                      {0.6666666666666666, 1.5714285714285712, 0},
                                      {0.37037037037037035, 0.41666666666666663, 0},
                                      {1.9130434782608698, 1.1739130434782608, 0},
                                      {1.5163934426229508, 0.20491803278688525, 0},
                                      {1.1680672268907564, 1.6638655462184873, 0}};
  static const double rows[12] = {1.5, 0.2, -0.1, 0.5, -0.3, 1.4, 0.2, 0.25, 0.1, 0.05, 0.08, 1.0};
  static const double scales[7] = {1.0, 1.1, 1.05, 1.08, 1.15, 1.22, 1.19};
  CagModelFit fit;
  double found[7];
  OK(cag_model_fit_projective(points, pictures, 7, &fit, found, &err));
  near_rows(fit.rows[0], rows, 12, 1e-11);
  near_rows(found, scales, 7, 1e-11);
  assert_true(fit.error < 1e-12);
}

// An affine picture is a special case, without perspective to the last bit.
static void the_projective_fit_of_an_affine_picture_is_affine(void **state) {
  (void)state;
  for (int trial = 0; trial < 50; trial++) {
    CagVec3 points[9], pictures[9];
    double scales[9], rms;
    CagModelFit fit;
    CagCameraMap c;
    const CagVec3 u = random_point(3), v = random_point(3);
    for (size_t i = 0; i < 9; i++) {
      points[i] = random_point(10);
      pictures[i] = cag_vec3(cag_dot(u, points[i]) + 5, cag_dot(v, points[i]) - 2, 0);
    }
    OK(cag_model_fit_projective(points, pictures, 9, &fit, scales, &err));
    for (int j = 0; j < 3; j++) NEAR(fit.rows[2][j], 0, 0);
    NEAR(fit.rows[2][3], 1, 1e-15);
    OK(cag_calibrate(points, pictures, 9, &c, &rms, &err));
    assert_true(c.parallel);
    CagCameraParts parts;
    cag_camera_split(&c, &parts);
    // K (R1 X, R2 X, 1)
    for (int axis = 0; axis < 2; axis++)
      for (int j = 0; j < 3; j++)
        NEAR(parts.k[axis][0] * parts.r[0][j] + parts.k[axis][1] * parts.r[1][j],
             (axis ? &v : &u)->x * (j == 0) + (axis ? &v : &u)->y * (j == 1) +
                 (axis ? &v : &u)->z * (j == 2),
             1e-9);
    NEAR(parts.k[0][2], 5, 1e-8);
    NEAR(parts.k[1][2], -2, 1e-8);
  }
}

static void points_that_fit_several_maps_are_an_error(void **state) {
  (void)state;
  CagVec3 points[8], pictures[8];
  CagModelFit fit;
  double scales[8], rms;
  CagCameraMap c;
  // All but one in a plane: the map across the plane is known up to a factor only.
  for (size_t i = 0; i < 7; i++) {
    points[i] = cag_vec3(uniform(-1, 1), uniform(-1, 1), 0);
    pictures[i] = points[i];
  }
  points[7] = cag_vec3(0.2, 0.1, 1), pictures[7] = cag_vec3(0.4, 0.9, 0);
  FAILS(cag_model_fit_projective(points, pictures, 8, &fit, scales, &err), "model-ambiguous");
  FAILS(cag_model_fit_projective(points, pictures, 7, &fit, scales, &err), "model-points-coplanar");
  FAILS(cag_calibrate(points, pictures, 7, &c, &rms, &err), "calibration-points-coplanar");
  for (size_t i = 0; i < 8; i++) pictures[i] = cag_vec3(3, 4, 0);
  for (size_t i = 0; i < 8; i++) points[i] = cube_corner(i);
  FAILS(cag_model_fit_projective(points, pictures, 8, &fit, scales, &err), "model-ambiguous");
  OK(cag_model_fit_affine(points, pictures, 8, &fit, &err)); // everything at one point
  NEAR(fit.error, 0, 1e-12);
  for (size_t i = 0; i < 8; i++) points[i] = cag_vec3(1, 2, 3);
  FAILS(cag_model_fit_affine(points, pictures, 8, &fit, &err), "model-points-coplanar");
}

static void a_triangle_of_many_rows_solves_like_all_at_once(void **state) {
  (void)state;
  enum { ROWS = 1000, COLUMNS = 5 };
  static double all[COLUMNS][ROWS], right[ROWS];
  CagTriangle t;
  double found[COLUMNS], values[COLUMNS];
  cag_triangle_init(&t, COLUMNS + 1);
  for (size_t i = 0; i < ROWS; i++) {
    double row[COLUMNS + 1];
    for (size_t j = 0; j <= COLUMNS; j++) row[j] = uniform(-1, 1);
    for (size_t j = 0; j < COLUMNS; j++) all[j][i] = row[j];
    right[i] = row[COLUMNS];
    OK(cag_triangle_add(&t, row, &err));
  }
  OK(cag_triangle_finish(&t, &err));
  cag_triangle_solve(&t, COLUMNS, COLUMNS, found);
  OK(cag_triangle_singular(&t, COLUMNS, values, NULL, &err));
  for (size_t j = 0; j + 1 < COLUMNS; j++) assert_true(values[j] >= values[j + 1]);
  OK(cag_least_squares(all[0], ROWS, COLUMNS, right, ROWS, 1, NULL, &err));
  near_rows(found, right, COLUMNS, 1e-14);
}

// --- Stereo and positions ---

static void the_point_of_two_lines_is_that_of_the_reference(void **state) {
  (void)state;
  static const CagVec3 origins[2] = {{0, 0, 0}, {1, 0, 0}};
  static const CagVec3 directions[2] = {{0.2, 0.1, 1}, {-0.05, 0.12, 1}};
  CagVec3 point;
  double gap;
  OK(cag_stereo_point(origins, directions, &point, &gap, &err));
  near_vec(point, cag_vec3(0.7984813542304003, 0.4368930515680633, 3.9721686198835804), 5e-14);
  NEAR(gap, 0.07921739545165557, 1e-15);
  static const CagVec3 equal[2] = {{0.2, 0.1, 1}, {-0.4, -0.2, -2}};
  FAILS(cag_stereo_point(origins, equal, &point, &gap, &err), "parallel-lines");
}

static void bearings_locate_the_point_of_the_reference(void **state) {
  (void)state;
  static const CagVec3 marks[2] = {{10, 4, 0}, {3, 9, 0}};
  double bearings[3] = {20.556045219583467 * M_PI / 180, 82.8749836510982 * M_PI / 180, 0};
  CagVec3 p;
  OK(cag_locate_by_bearings(marks, bearings, 2, &p, &err));
  near_vec(p, cag_vec3(2, 1, 0), 1e-13);
  bearings[1] = bearings[0] + M_PI;
  FAILS(cag_locate_by_bearings(marks, bearings, 2, &p, &err), "bearings-parallel");
  FAILS(cag_locate_by_bearings(marks, bearings, 1, &p, &err), "bearings-parallel");
}

static void ranges_locate_points_of_plane_and_space(void **state) {
  (void)state;
  static const CagVec3 marks[3] = {{10, 4, 0}, {3, 9, 0}, {-4, 2, 0}};
  static const double ranges[3] = {8.54400374531753, 8.06225774829855, 6.082762530298219};
  CagVec3 p;
  OK(cag_locate_by_ranges(marks, ranges, 3, 2, &p, &err));
  near_vec(p, cag_vec3(2, 1, 0), 1e-12);
  FAILS(cag_locate_by_ranges(marks, ranges, 2, 2, &p, &err), "landmarks-collinear");
  FAILS(cag_locate_by_ranges(marks, ranges, 3, 3, &p, &err), "landmarks-collinear");
  for (int trial = 0; trial < 50; trial++) {
    CagVec3 many[6];
    double distances[6];
    const CagVec3 at = random_point(20), far = random_point(1000);
    for (size_t i = 0; i < 6; i++) {
      many[i] = cag_add(far, random_point(30));
      distances[i] = cag_norm(cag_sub(cag_add(far, at), many[i]));
    }
    OK(cag_locate_by_ranges(many, distances, 4 + trial % 3, 3, &p, &err));
    near_vec(cag_sub(p, far), at, 1e-8);
  }
}

// --- Seams ---

static void seams_are_those_of_the_reference(void **state) {
  (void)state;
  static const CagProfileSample fillet[] = {{-2, 8.375}, {-1, 8.875}, {0, 9.375}, {1, 9.875},
                                            {2, 9.625},  {3, 9.125},  {4, 8.625}};
  static const CagProfileSample lap[] = {{-2, 10}, {-1, 10}, {0, 10}, {1, 10},
                                         {2, 8},   {3, 8},   {4, 8}};
  const CagProfileSample butt[] = {{-2, 10},   {-1, 10}, {0, 10}, {0.8, NAN},
                                   {1.2, NAN}, {2, 10},  {3, 10}};
  CagSeam s;
  OK(cag_find_seam(fillet, 7, CAG_SEAM_FILLET, 0, &s, &err));
  NEAR(s.y, 1.25, 1e-13);
  NEAR(s.z, 10, 1e-13);
  OK(cag_find_seam(lap, 7, CAG_SEAM_LAP, 0, &s, &err));
  NEAR(s.y, 1.5, 0);
  NEAR(s.step, 2, 0);
  OK(cag_find_seam(butt, 7, CAG_SEAM_BUTT, 0, &s, &err));
  NEAR(s.y, 1, 0);
  NEAR(s.gap_most, 2, 0);
  NEAR(s.gap_least, 0.4, 1e-15);
  FAILS(cag_find_seam(lap, 4, CAG_SEAM_LAP, 0, &s, &err), "no-seam");
  FAILS(cag_find_seam(lap, 7, CAG_SEAM_LAP, 2, &s, &err), "no-seam");
  FAILS(cag_find_seam(lap, 7, CAG_SEAM_BUTT, 0, &s, &err), "no-seam");
  FAILS(cag_find_seam(fillet, 4, CAG_SEAM_FILLET, 0, &s, &err), "no-seam"); // one line
  FAILS(cag_find_seam(fillet, 3, CAG_SEAM_FILLET, 0, &s, &err), "no-seam");
  FAILS(cag_find_seam(fillet, 0, CAG_SEAM_FILLET, 0, &s, &err), "no-seam");
}

static void a_fillet_is_found_in_a_noisy_profile_with_missing_samples(void **state) {
  (void)state;
  enum { COUNT = 400 };
  CagProfileSample v[COUNT];
  for (size_t i = 0; i < COUNT; i++) {
    const double y = 500 + (double)i * 0.1, z = y < 517.3 ? 2 * (y - 517.3) : -0.5 * (y - 517.3);
    v[i] = (CagProfileSample){y, i % 7 == 3 ? NAN : 3 + z + uniform(-1e-3, 1e-3)};
  }
  CagSeam s;
  OK(cag_find_seam(v, COUNT, CAG_SEAM_FILLET, 0, &s, &err));
  NEAR(s.y, 517.3, 1e-3);
  NEAR(s.z, 3, 1e-3);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(calibration_finds_the_camera_of_the_reference),
      cmocka_unit_test(the_depth_of_a_calibrated_camera_is_positive_for_mirrored_pictures_too),
      cmocka_unit_test(a_sight_line_ends_at_the_projected_point),
      cmocka_unit_test(splitting_a_matrix_returns_its_parts),
      cmocka_unit_test(a_singular_matrix_is_not_a_camera),
      cmocka_unit_test(the_affine_fit_of_noisy_points_is_that_of_the_reference),
      cmocka_unit_test(the_affine_fit_does_not_depend_on_position_and_unit),
      cmocka_unit_test(the_projective_fit_is_that_of_the_reference),
      cmocka_unit_test(the_projective_fit_of_an_affine_picture_is_affine),
      cmocka_unit_test(points_that_fit_several_maps_are_an_error),
      cmocka_unit_test(a_triangle_of_many_rows_solves_like_all_at_once),
      cmocka_unit_test(the_point_of_two_lines_is_that_of_the_reference),
      cmocka_unit_test(bearings_locate_the_point_of_the_reference),
      cmocka_unit_test(ranges_locate_points_of_plane_and_space),
      cmocka_unit_test(seams_are_those_of_the_reference),
      cmocka_unit_test(a_fillet_is_found_in_a_noisy_profile_with_missing_samples),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
