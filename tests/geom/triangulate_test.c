// Triangulation of polygons with holes.

#include "geom/mesh/mesh.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

// The area of the triangles, which must all be counter-clockwise and use every point.
static double triangulated_area(const double *xy, const size_t *counts, size_t loops,
                                size_t expected) {
  uint32_t *t;
  size_t n, points = 0;
  for (size_t l = 0; l < loops; l++) points += counts[l];
  OK(cag_triangulate(xy, counts, loops, &t, &n, &err));
  assert_int_equal(n, expected);
  unsigned char *used = calloc(points, 1);
  double twice = 0;
  for (size_t k = 0; k < n; k++) {
    const double *a = xy + 2 * t[3 * k], *b = xy + 2 * t[3 * k + 1], *c = xy + 2 * t[3 * k + 2];
    double area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    assert_true(area > 0);
    twice += area;
    for (int j = 0; j < 3; j++) used[t[3 * k + j]] = 1;
  }
  for (size_t k = 0; k < points; k++) assert_true(used[k]);
  free(used);
  free(t);
  return twice / 2;
}

static size_t put_square(double *xy, double side, double turned, size_t per_side) {
  const double corner[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
  size_t n = 0;
  for (int k = 0; k < 4; k++)
    for (size_t i = 0; i < per_side; i++, n++) {
      double s = (double)i / (double)per_side;
      double x = side * (corner[k][0] + s * (corner[k + 1][0] - corner[k][0])),
             y = side * (corner[k][1] + s * (corner[k + 1][1] - corner[k][1]));
      xy[2 * n] = cos(turned) * x - sin(turned) * y;
      xy[2 * n + 1] = sin(turned) * x + cos(turned) * y;
    }
  return n;
}

static void points_on_straight_sides_are_kept(void **state) {
  (void)state;
  static double xy[2 * 400];
  for (int k = 0; k < 7; k++) {
    size_t n = put_square(xy, 3, 0.3 * k, 100);
    NEAR(triangulated_area(xy, &n, 1, n - 2), 9, 1e-12);
  }
}

static void holes_are_left_out_whatever_their_sense(void **state) {
  (void)state;
  static double xy[2 * 1000];
  for (int sense = -1; sense <= 1; sense += 2) {
    size_t counts[3] = {put_square(xy, 10, 0, 25), 50, 60}, at = counts[0];
    for (int h = 0; h < 2; h++)
      for (size_t k = 0; k < counts[h + 1]; k++, at++) {
        double angle = sense * 2 * M_PI * (double)k / (double)counts[h + 1];
        xy[2 * at] = 3 + 4 * h + cos(angle);
        xy[2 * at + 1] = 5 + sin(angle);
      }
    // A regular n-gon of radius 1 has the area n/2 sin(2 pi/n). The number of triangles is points +
    // 2 holes - 2.
    double holes = 25 * sin(2 * M_PI / 50) + 30 * sin(2 * M_PI / 60);
    NEAR(triangulated_area(xy, counts, 3, 100 + 50 + 60 + 4 - 2), 100 - holes, 1e-11);
  }
}

static void a_polygon_of_many_points_takes_no_more_than_a_moment(void **state) {
  (void)state;
  enum { TEETH = 25000 };
  double *xy = malloc(2 * (2 * TEETH + 2) * sizeof *xy);
  for (int turned = 0; turned < 2; turned++) {
    size_t n = 0;
    for (size_t k = 0; k < TEETH; k++)
      for (int top = 0; top < 2; top++, n++) {
        xy[2 * n + turned] = (double)k + 0.5 * top;
        xy[2 * n + !turned] = top ? 100 : 1;
      }
    xy[2 * n + turned] = TEETH, xy[2 * n + !turned] = 0, n++;
    xy[2 * n + turned] = 0, xy[2 * n + !turned] = 0, n++;
    double area = triangulated_area(xy, &n, 1, n - 2);
    // The shoelace formula, in the order of the points.
    double twice = 0;
    for (size_t k = 0; k < n; k++) {
      const double *p = xy + 2 * k, *q = xy + 2 * ((k + 1) % n);
      twice += p[0] * q[1] - p[1] * q[0];
    }
    NEAR(area, fabs(twice) / 2, 1e-6);
  }
  free(xy);
}

static void triangles_of_a_convex_polygon_are_delaunay(void **state) {
  (void)state;
  // Of the two diagonals of this kite, only the short one has empty circumcircles.
  const double kite[] = {0, 0, 5, -1, 10, 0, 5, 1};
  size_t n = 4, triangles;
  uint32_t *t;
  OK(cag_triangulate(kite, &n, 1, &t, &triangles, &err));
  for (size_t k = 0; k < triangles; k++) {
    bool one = false, three = false;
    for (int j = 0; j < 3; j++) one |= t[3 * k + j] == 1, three |= t[3 * k + j] == 3;
    assert_true(one && three);
  }
  free(t);
}

static int64_t turn_of(const int a[2], const int b[2], const int c[2]) {
  return (int64_t)(b[0] - a[0]) * (c[1] - a[1]) - (int64_t)(b[1] - a[1]) * (c[0] - a[0]);
}

static int compare_points(const void *a, const void *b) {
  const int *p = a, *q = b;
  return p[0] != q[0] ? p[0] - q[0] : p[1] - q[1];
}

// The corners of the convex hull of sorted points, counter-clockwise (Andrew's monotone chain).
static size_t convex_hull(int (*p)[2], size_t n, int (*hull)[2]) {
  size_t k = 0;
  for (size_t half = 0; half < 2; half++) {
    const size_t first = k;
    for (size_t i = 0; i < n; i++) {
      const int *at = p[half ? n - 1 - i : i];
      while (k >= first + 2 && turn_of(hull[k - 2], hull[k - 1], at) <= 0) k--;
      hull[k][0] = at[0];
      hull[k++][1] = at[1];
    }
    k--; // the next half begins with it
  }
  return k;
}

// Whether d is inside the circle through a, b, c, in integer arithmetic.
static bool is_within_circle(const int a[2], const int b[2], const int c[2], const int d[2]) {
  const int *corners[3] = {a, b, c};
  int64_t x[3], y[3], square[3];
  for (int k = 0; k < 3; k++) {
    x[k] = corners[k][0] - d[0];
    y[k] = corners[k][1] - d[1];
    square[k] = x[k] * x[k] + y[k] * y[k];
  }
  return square[0] * (x[1] * y[2] - x[2] * y[1]) - square[1] * (x[0] * y[2] - x[2] * y[0]) +
             square[2] * (x[0] * y[1] - x[1] * y[0]) >
         0;
}

static void no_corner_lies_within_the_circle_of_a_triangle(void **state) {
  (void)state;
  enum { POINTS = 60 };
  seed = 71;
  for (int round = 0; round < 400; round++) {
    int p[POINTS][2], hull[2 * POINTS][2];
    const int size = round % 2 ? 60 : 6; // small ones have many cocircular corners
    for (int i = 0; i < POINTS; i++)
      for (int k = 0; k < 2; k++) p[i][k] = (int)floor(uniform(-size, size));
    qsort(p, POINTS, sizeof *p, compare_points);
    size_t n = convex_hull(p, POINTS, hull), triangles;
    double xy[2 * POINTS * 2];
    for (size_t i = 0; i < 2 * n; i++) xy[i] = hull[i / 2][i % 2];
    uint32_t *t;
    OK(cag_triangulate(xy, &n, 1, &t, &triangles, &err));
    assert_int_equal(triangles, n - 2);
    for (size_t k = 0; k < triangles; k++) {
      const int *a = hull[t[3 * k]], *b = hull[t[3 * k + 1]], *c = hull[t[3 * k + 2]];
      assert_true(turn_of(a, b, c) > 0);
      for (size_t i = 0; i < n; i++) assert_false(is_within_circle(a, b, c, hull[i]));
    }
    free(t);
  }
}

static void crossing_and_touching_boundaries_fail(void **state) {
  (void)state;
  uint32_t *t;
  size_t n, four = 4, five = 5, two = 2;
  const double bow[] = {0, 0, 1, 1, 1, 0, 0, 1}, touching[] = {0, 0, 2, 0, 2, 2, 1, 0, 0, 2};
  FAILS_AMONG(cag_triangulate(bow, &four, 1, &t, &n, &err), "polygon-self-intersection", 0, 3);
  FAILS_AMONG(cag_triangulate(touching, &five, 1, &t, &n, &err), "polygon-self-intersection", 0, 3);
  const double same[] = {0, 0, 2, 0, 2, 2, 2, 2, 0, 2};
  FAILS_AMONG(cag_triangulate(same, &five, 1, &t, &n, &err), "polygon-self-intersection", 2, 3);
  FAILS_AT(cag_triangulate(bow, &two, 1, &t, &n, &err), "polygon-too-small", 0);
  const double crossing[] = {0, 0, 4, 0, 4, 4, 0, 4, 2, 2, 6, 2, 6, 3, 2, 3};
  FAILS_AMONG(cag_triangulate(crossing, (size_t[]){4, 4}, 2, &t, &n, &err),
              "polygon-self-intersection", 1, 7);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(points_on_straight_sides_are_kept),
      cmocka_unit_test(holes_are_left_out_whatever_their_sense),
      cmocka_unit_test(a_polygon_of_many_points_takes_no_more_than_a_moment),
      cmocka_unit_test(triangles_of_a_convex_polygon_are_delaunay),
      cmocka_unit_test(no_corner_lies_within_the_circle_of_a_triangle),
      cmocka_unit_test(crossing_and_touching_boundaries_fail),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
