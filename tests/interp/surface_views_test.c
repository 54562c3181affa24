// What a page asks about exact surfaces: curvature, the distance of meshes from them, lines of
// parameters, control points, and the curves in which a plane cuts them.

#include <math.h>

#include "tests/interp/session_support.h"

static void build_scene(CagSession *s, const char *text) {
  CagShownCounts counts;
  if (cag_session_run_text(s, "page.cag", text, strlen(text)) != CAG_STATUS_OK ||
      cag_session_scene(s, &counts) != CAG_STATUS_OK) {
    cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr);
    fail_msg("%s", text);
  }
}

static CagSurfaceView ask(CagSession *s, const char *text, const char *what) {
  CagSurfaceView v;
  build_scene(s, text);
  if (cag_session_part_surface(s, 0, what, &v) != CAG_STATUS_OK) {
    cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr);
    fail_msg("%s of %s", what, text);
  }
  return v;
}

static void expect_refusal(CagSession *s, const char *text, const char *what, const char *why) {
  CagSurfaceView v;
  CagErrorView e;
  build_scene(s, text);
  assert_int_equal(cag_session_part_surface(s, 0, what, &v), CAG_STATUS_SCRIPT);
  assert_true(cag_session_error_count(s) > 0);
  cag_session_error(s, cag_session_error_count(s) - 1, &e);
  if (!strstr(e.message, why)) fail_msg("%s of %s: %s", what, text, e.message);
}

// --- Curvature ---

// All corners have these curvatures, to the precision of floats.
static void expect_curvature(CagSession *s, const char *text, double mean, double gaussian) {
  const CagSurfaceView v = ask(s, text, "curvature");
  assert_true(v.triangle_count > 0);
  size_t known = 0;
  for (size_t i = 0; i < 3 * v.triangle_count; i++) {
    if (isnan(v.mean[i])) continue;
    known++;
    if (!(fabs((double)v.mean[i] - mean) < 1e-6) ||
        !(fabs((double)v.gaussian[i] - gaussian) < 1e-6))
      fail_msg("%s: %g and %g", text, (double)v.mean[i], (double)v.gaussian[i]);
  }
  assert_true(known > 3 * v.triangle_count * 9 / 10);
}

static void spheres_have_the_curvature_of_their_radius(void **state) {
  (void)state;
  CagSession *s = new_session();
  expect_curvature(s, "show sphere(5)\n", 1. / 5, 1. / 25);
  expect_curvature(s, "show translate(sphere(5), [9, 9, 9])\n", 1. / 5, 1. / 25);
  expect_curvature(s, "show sphere_surface(5)\n", 1. / 5, 1. / 25);
  expect_curvature(s, "show revolve(arc(4, -90deg..90deg))\n", 1. / 4, 1. / 16);
  expect_curvature(s, "show box([4, 5, 6])\n", 0, 0);
  cag_session_free(s);
}

static void the_curvature_of_a_torus_depends_on_the_radius(void **state) {
  (void)state;
  CagSession *s = new_session();
  static const char *const SCRIPTS[] = {"show torus(5, 2)\n", "show torus_surface(5, 2)\n"};
  for (size_t k = 0; k < 2; k++) {
    const CagSurfaceView v = ask(s, SCRIPTS[k], "curvature");
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < 3 * v.triangle_count; i++) {
      low = fmin(low, (double)v.gaussian[i]);
      high = fmax(high, (double)v.gaussian[i]);
      // One principal curvature is 1/2 everywhere, so that the other one follows from the mean.
      const double other = 2 * (double)v.mean[i] - 0.5;
      assert_true(fabs((double)v.gaussian[i] - other / 2) < 1e-6);
    }
    // cos t / (r (R + r cos t)): -1/6 inside, 1/14 outside
    assert_true(fabs(low - -1. / 6) < 5e-3 && fabs(high - 1. / 14) < 5e-3);
  }
  cag_session_free(s);
}

static void faces_of_set_operations_have_the_curvature_of_their_operands(void **state) {
  (void)state;
  CagSession *s = new_session();
  const CagSurfaceView v = ask(
      s, "show box([40, 40, 10], centered: true) - cylinder(20, 8, centered: true)\n", "curvature");
  size_t flat = 0, bent = 0, other = 0;
  for (size_t i = 0; i < 3 * v.triangle_count; i++) {
    assert_true(isnan(v.gaussian[i]) || fabsf(v.gaussian[i]) < 1e-6f);
    if (fabsf(v.mean[i]) < 1e-6f) flat++;
    else if (fabs((double)v.mean[i] - -1. / 16) < 1e-6) bent++; // hollow: half of 1/8
    else other++;
  }
  assert_true(flat > 30 && bent > 30);
  assert_int_equal(other, 0);
  cag_session_free(s);
}

// --- Deviation ---

static void meshes_are_within_the_tolerance(void **state) {
  (void)state;
  CagSession *s = new_session();
  static const char *const SCRIPTS[] = {
      "show sphere(50) |> tolerance(0.1)\n", "show torus_surface(50, 20) |> tolerance(0.1)\n",
      "show cylinder(60, 20) - sphere(19) |> tolerance(0.1)\n",
      "show bspline_surface([for i in 0..5: [for k in 0..5: [10 * i, 10 * k, 8 * sin(40deg * i * k)]]]) |> tolerance(0.1)\n"};
  for (size_t k = 0; k < sizeof SCRIPTS / sizeof *SCRIPTS; k++) {
    const CagSurfaceView v = ask(s, SCRIPTS[k], "deviation");
    if (!(v.farthest > 0.01 && v.farthest <= 0.1 * 1.01))
      fail_msg("%g from %s", v.farthest, SCRIPTS[k]);
    size_t unknown = 0;
    for (size_t t = 0; t < v.triangle_count; t++) {
      unknown += isnan(v.distance[t]);
      assert_true(!((double)v.distance[t] > v.farthest * (1 + 1e-6)));
    }
    assert_true(unknown < v.triangle_count / 50 + 1);
  }
  assert_true(ask(s, "show box([1, 2, 3])\n", "deviation").farthest < 1e-9);
  cag_session_free(s);
}

// --- Lines ---

static void isolines_are_on_the_surface(void **state) {
  (void)state;
  CagSession *s = new_session();
  const CagSurfaceView v = ask(s, "show translate(sphere_surface(5), [20, 0, 0])\n", "isolines");
  assert_int_equal(v.line_count, 18);
  size_t points = 0;
  for (size_t i = 0; i < v.line_count; i++) points += v.line_sizes[i];
  assert_int_equal(points, v.point_count);
  for (size_t i = 0; i < v.point_count; i++) {
    const float *p = v.points + 3 * i;
    assert_true(fabs(hypot(hypot((double)p[0] - 20, (double)p[1]), (double)p[2]) - 5) < 1e-5);
  }
  cag_session_free(s);
}

static void a_net_has_the_control_points(void **state) {
  (void)state;
  CagSession *s = new_session();
  CagSurfaceView v = ask(
      s,
      "show translate(bspline_surface([for i in 0..3: [for k in 0..4: [i, k, i * k]]]), [0, 0, 9])\n",
      "net");
  assert_int_equal(v.line_count, 4 + 5);
  assert_int_equal(v.point_count, 2 * 4 * 5);
  for (uint32_t i = 0; i < 20; i++) {
    const float *p = v.points + 3 * i;
    assert_true(p[0] == (float)(i / 5) && p[1] == (float)(i % 5));
    assert_true(fabsf(p[2] - (9 + p[0] * p[1])) < 1e-6f);
  }
  v = ask(s, "show bspline([[0, 0], [2, 0], [2, 2], [0, 2]], degree: 3, closed: true)\n", "net");
  assert_int_equal(v.point_count, 5); // it closes
  cag_session_free(s);
}

static void what_has_no_exact_surface_says_so(void **state) {
  (void)state;
  CagSession *s = new_session();
  CagSurfaceView v;
  expect_refusal(s, "show tessellate(sphere(3))\n", "curvature", "is a mesh");
  expect_refusal(s, "show tessellate(sphere(3))\n", "deviation", "is a mesh");
  expect_refusal(s, "show circle(3)\n", "curvature", "is a curve");
  expect_refusal(s, "show region(circle(3))\n", "curvature", "is a region");
  expect_refusal(s, "show sphere(3)\n", "net", "is not a spline");
  expect_refusal(s, "show sphere(3) - box([3, 3, 3])\n", "isolines", "is a set operation");
  assert_int_equal(cag_session_part_surface(s, 0, "charm", &v), CAG_STATUS_USAGE);
  assert_int_equal(cag_session_part_surface(s, 99, "net", &v), CAG_STATUS_USAGE);
  cag_session_free(s);
}

// --- Sections ---

typedef struct Cut {
  size_t count, holes;
  double length, area;
  bool closed, exact;
  double off; // the largest distance of a point from the plane
  double plane[4];
} Cut;

static void see_curve(void *context, const CagSectionCurve *c) {
  Cut *cut = context;
  cut->count++;
  cut->length += c->length;
  cut->area += c->area;
  cut->holes += c->area < 0;
  cut->closed = c->closed;
  cut->exact = c->exact;
  assert_true(c->point_count >= 2);
  for (size_t i = 0; i < c->point_count; i++) {
    const float *p = c->points + 3 * i;
    cut->off = fmax(cut->off, fabs(cut->plane[0] * (double)p[0] + cut->plane[1] * (double)p[1] +
                                   cut->plane[2] * (double)p[2] - cut->plane[3]));
  }
}

static Cut cut_by(CagSession *s, const char *text, double x, double y, double z, double d) {
  Cut cut = {.plane = {x, y, z, d}};
  build_scene(s, text);
  assert_int_equal(cag_session_section_curves(s, cut.plane, see_curve, &cut), CAG_STATUS_OK);
  assert_true(cut.off < 1e-5);
  return cut;
}

static void sections_have_exact_lengths_and_areas(void **state) {
  (void)state;
  CagSession *s = new_session();
  Cut c = cut_by(s, "show cylinder(10, 4)\n", 0, 0, 1, 3);
  assert_int_equal(c.count, 1);
  assert_true(c.closed && c.exact);
  assert_true(fabs(c.length - 8 * M_PI) < 1e-9 && fabs(c.area - 16 * M_PI) < 1e-9);
  c = cut_by(s, "show translate(cylinder(10, 4), [7, 8, 9])\n", 1, 0, 0, 7);
  assert_true(fabs(c.length - 36) < 1e-9 && fabs(c.area - 80) < 1e-9);
  // A hole has a negative area.
  c = cut_by(s, "show box([40, 40, 10], centered: true) - cylinder(20, 8, centered: true)\n", 0, 0,
             1, 0);
  assert_int_equal(c.count, 2);
  assert_int_equal(c.holes, 1);
  assert_true(fabs(c.area - (1600 - 64 * M_PI)) < 1e-6);
  assert_true(fabs(c.length - (160 + 16 * M_PI)) < 1e-6);
  c = cut_by(s, "show sphere_surface(5)\n", 0, 0, 2, 6);
  assert_true(c.closed && fabs(c.length - 8 * M_PI) < 1e-6);
  c = cut_by(s, "show tessellate(box([4, 4, 4]))\n", 0, 0, 1, 1);
  assert_true(!c.exact && fabs(c.length - 16) < 1e-6);
  assert_int_equal(cut_by(s, "show sphere(3)\n", 0, 0, 1, 9).count, 0);
  cag_session_free(s);
}

static void planes_without_a_normal_are_refused(void **state) {
  (void)state;
  CagSession *s = new_session();
  build_scene(s, "show sphere(3)\n");
  assert_int_equal(cag_session_section_curves(s, (double[]){0, 0, 0, 1}, see_curve, NULL),
                   CAG_STATUS_USAGE);
  assert_int_equal(cag_session_section_curves(s, (double[]){NAN, 0, 1, 1}, see_curve, NULL),
                   CAG_STATUS_USAGE);
  cag_session_free(s);
}

static void memory_and_sizes_of_images_are_known(void **state) {
  (void)state;
  CagSession *s = new_session();
  size_t width, height;
  assert_int_equal(cag_session_memory(s), 0);
  build_scene(s, "show image([[0, 1, 0], [1, 0, 1]])\nshow sphere(4)\n");
  assert_true(cag_session_memory(s) > 10000);
  assert_true(cag_session_image_size(s, 0, &width, &height));
  assert_int_equal(width, 3);
  assert_int_equal(height, 2);
  assert_false(cag_session_image_size(s, 1, &width, &height));
  cag_session_free(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(spheres_have_the_curvature_of_their_radius),
      cmocka_unit_test(the_curvature_of_a_torus_depends_on_the_radius),
      cmocka_unit_test(faces_of_set_operations_have_the_curvature_of_their_operands),
      cmocka_unit_test(meshes_are_within_the_tolerance),
      cmocka_unit_test(isolines_are_on_the_surface),
      cmocka_unit_test(a_net_has_the_control_points),
      cmocka_unit_test(what_has_no_exact_surface_says_so),
      cmocka_unit_test(sections_have_exact_lengths_and_areas),
      cmocka_unit_test(planes_without_a_normal_are_refused),
      cmocka_unit_test(memory_and_sizes_of_images_are_known),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
