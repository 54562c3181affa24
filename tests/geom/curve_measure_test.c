// Lengths, bounds, areas, discretization, and closest points, compared with closed forms.

#include "geom/curve/curve.h"
#include "geom/curve/region.h"
#include "support.h"

static CagCurve *ellipse(double a, double b, double from, double to) {
  CagCurve *c;
  CagTransform frame = cag_transform_identity();
  OK(cag_curve_arc(a, b, from, to, &frame, &c, &err));
  return c;
}

static double length_of(const CagCurve *c) {
  double s;
  OK(cag_curve_length(c, c->start, c->end, &s, &err));
  return s;
}

// Perimeter 4 a E(e) with a = 5, b = 3 (e = 4/5): 25.52699886339812... (complete elliptic integral
// E(k^2 = 0.64) = 1.276349943169906).
static void an_ellipse_has_the_perimeter_of_the_elliptic_integral(void **state) {
  (void)state;
  CagCurve *c = ellipse(5, 3, 0, 2 * M_PI);
  NEAR(length_of(c), 20 * 1.2763499431699064, 2e-9);
  cag_curve_release(c);
  // Vector curve.arclength.ellipse: a quarter of a = 2, b = 1, and the parameter at length 1.
  c = ellipse(2, 1, 0, M_PI / 2);
  double t;
  NEAR(length_of(c), 2.4221120551369193, 1e-12);
  OK(cag_curve_parameter_at_length(c, 1, &t, &err));
  NEAR(t, 0.8069752653315049, 1e-12);
  cag_curve_release(c);
}

// Vector curve.arclength.helix: a = 3, b = 4 has length 5 per radian.
static void a_helix_has_constant_speed(void **state) {
  (void)state;
  CagCurve *c;
  double s;
  OK(cag_curve_helix(3, 8 * M_PI, 1, 0, &c, &err));
  OK(cag_curve_length(c, 0, 2, &s, &err));
  NEAR(s, 10, 1e-14);
  OK(cag_curve_parameter_at_length(c, 7.5, &s, &err));
  NEAR(s, 1.5, 1e-14);
  FAILS(cag_curve_parameter_at_length(c, 1000, &s, &err), "parameter-range");
  FAILS(cag_curve_parameter_at_length(c, -1, &s, &err), "parameter-range");
  cag_curve_release(c);
}

// The parabola y = x^2 over 0..1 has length sqrt 5 / 2 + asinh(2) / 4; the cusp (t^2, t^3) over
// -1..1 has 2 (13 sqrt 13 - 8) / 27.
static void parabola_and_cusp_have_their_lengths(void **state) {
  (void)state;
  CagCurve *c;
  static const CagVec3 parabola[3] = {{0, 0, 0}, {0.5, 0, 0}, {1, 1, 0}};
  OK(cag_curve_bezier(parabola, NULL, 3, 2, &c, &err));
  double exact = sqrt(5) / 2 + asinh(2) / 4;
  NEAR(length_of(c), exact, 1e-13);
  double t, s;
  OK(cag_curve_parameter_at_length(c, exact / 2, &t, &err));
  OK(cag_curve_length(c, 0, t, &s, &err));
  NEAR(s, exact / 2, 1e-13);
  cag_curve_release(c);
  static const CagVec3 cusp[4] = {{1, -1, 0}, {-1.0 / 3, 1, 0}, {-1.0 / 3, -1, 0}, {1, 1, 0}};
  OK(cag_curve_bezier(cusp, NULL, 4, 2, &c, &err));
  exact = 2 * (13 * sqrt(13) - 8) / 27;
  NEAR(length_of(c), exact, 1e-10 * exact);
  OK(cag_curve_parameter_at_length(c, exact / 2, &t, &err));
  NEAR(t, 0.5, 1e-5); // the speed is 0 there, so s grows with (t - 1/2)^2
  cag_curve_release(c);
}

// A semicircle of radius 2 from two rational quadratics with the weights 1, cos 60deg, 1.
static void a_rational_circle_has_length_and_area_of_the_circle(void **state) {
  (void)state;
  CagCurve *c = ellipse(2, 2, 0, 2 * M_PI), *exact;
  OK(cag_curve_to_nurbs(c, &exact, &err));
  NEAR(length_of(exact), 4 * M_PI, 1e-10);
  NEAR(length_of(c), 4 * M_PI, 1e-14);
  double area;
  CagVec3 centroid;
  OK(cag_curve_area(exact, &area, &centroid, &err));
  NEAR(area, 4 * M_PI, 1e-11);
  near_vec(centroid, cag_vec3(0, 0, 0), 1e-12);
  OK(cag_curve_area(c, &area, &centroid, &err));
  NEAR(area, 4 * M_PI, 1e-12);
  cag_curve_release(c);
  cag_curve_release(exact);
}

static void areas_and_centroids_of_polygons(void **state) {
  (void)state;
  CagCurve *c;
  double area;
  CagVec3 centroid;
  // An L of 3 unit squares, far from the origin: centroid 5/6 from its corner.
  static const CagVec3 l[6] = {{1000, 0, 0}, {1002, 0, 0}, {1002, 1, 0},
                               {1001, 1, 0}, {1001, 2, 0}, {1000, 2, 0}};
  OK(cag_curve_polyline(l, 6, true, 2, &c, &err));
  OK(cag_curve_area(c, &area, &centroid, &err));
  NEAR(area, 3, 0);
  near_vec(centroid, cag_vec3(1000 + 5.0 / 6, 5.0 / 6, 0), 1e-12);
  NEAR(length_of(c), 8, 0);
  cag_curve_release(c);
  OK(cag_curve_polyline(l, 6, false, 2, &c, &err));
  FAILS(cag_curve_area(c, &area, &centroid, &err), "not-closed");
  cag_curve_release(c);
  // In space: a square tilted by 45 degrees.
  static const CagVec3 tilted[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 1}};
  OK(cag_curve_polyline(tilted, 4, true, 3, &c, &err));
  OK(cag_curve_area(c, &area, &centroid, &err));
  NEAR(area, sqrt(2), 1e-15);
  near_vec(centroid, cag_vec3(0.5, 0.5, 0.5), 1e-14);
  cag_curve_release(c);
  static const CagVec3 bent[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}};
  OK(cag_curve_polyline(bent, 4, true, 3, &c, &err));
  FAILS(cag_curve_area(c, &area, &centroid, &err), "not-planar");
  cag_curve_release(c);
}

// The cubic (0,0) (0,1) (1,1) (1,0) rises to y = 3/4; its x runs from 0 to 1.
static void bounds_are_tight(void **state) {
  (void)state;
  CagCurve *c;
  CagBounds b;
  static const CagVec3 arch[4] = {{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}};
  OK(cag_curve_bezier(arch, NULL, 4, 2, &c, &err));
  OK(cag_curve_bounds(c, &b, &err));
  near_vec(b.min, cag_vec3(0, 0, 0), 1e-9);
  near_vec(b.max, cag_vec3(1, 0.75, 0), 1e-9);
  cag_curve_release(c);
  // For an ellipse rotated by 30 degrees, half the width is sqrt(a^2 cos^2 + b^2 sin^2).
  CagCurve *turned;
  CagTransform turn;
  c = ellipse(3, 1, 0, 2 * M_PI);
  OK(cag_rotate(cag_vec3(0, 0, 1), M_PI / 6, cag_vec3(0, 0, 0), &turn, &err));
  turn.planar = true;
  OK(cag_curve_transform(c, &turn, &turned, &err));
  OK(cag_curve_bounds(turned, &b, &err));
  NEAR(b.max.x, sqrt(9 * 0.75 + 0.25), 1e-14);
  NEAR(b.min.y, -sqrt(9 * 0.25 + 0.75), 1e-14);
  assert_int_equal(turned->dimension, 2);
  cag_curve_release(turned);
  cag_curve_release(c);
  // A helix fills the box of its cylinder.
  OK(cag_curve_helix(2, 3, 4, 0, &c, &err));
  OK(cag_curve_bounds(c, &b, &err));
  near_vec(b.min, cag_vec3(-2, -2, 0), 1e-8);
  near_vec(b.max, cag_vec3(2, 2, 12), 1e-8);
  cag_curve_release(c);
}

static bool is_planar(const CagCurve *c, CagPlane *plane) {
  bool is = false;
  OK(cag_curve_is_planar(c, &is, plane, &err));
  return is;
}
static bool is_straight(const CagCurve *c) {
  bool is = false;
  OK(cag_curve_is_straight(c, &is, &err));
  return is;
}

static void planes_and_lines_are_recognized(void **state) {
  (void)state;
  CagCurve *c;
  CagPlane plane;
  // Vector curve.classify.plane: (1, 0, 0) + (t, t, 2t) + (0, t^2, t^2).
  static const CagVec3 flat[3] = {{1, 0, 0}, {1.5, 0.5, 1}, {2, 2, 3}};
  OK(cag_curve_bezier(flat, NULL, 3, 3, &c, &err));
  assert_true(is_planar(c, &plane) && !is_straight(c));
  NEAR(fabs(cag_dot(plane.normal, cag_unit(cag_vec3(1, 1, -1)))), 1, 1e-12);
  cag_curve_release(c);
  // Vector curve.classify.straight: (1, 2, 3) + (2, 0, -1) t + (4, 0, -2) t^3.
  static const CagVec3 straight[4] = {
      {1, 2, 3}, {1 + 2.0 / 3, 2, 3 - 1.0 / 3}, {1 + 4.0 / 3, 2, 3 - 2.0 / 3}, {7, 2, 0}};
  OK(cag_curve_bezier(straight, NULL, 4, 3, &c, &err));
  assert_true(is_planar(c, NULL) && is_straight(c));
  cag_curve_release(c);
  OK(cag_curve_helix(1, 1, 1, 0, &c, &err));
  assert_true(!is_planar(c, NULL) && !is_straight(c));
  cag_curve_release(c);
}

// Compares dense samples of the curve with the chord over each part.
static void check_polyline(const CagCurve *c, double tolerance, double angle) {
  double *t;
  size_t n;
  OK(cag_curve_discretize(c, tolerance, angle, &t, &n, &err));
  assert_true(t[0] == c->start && t[n - 1] == c->end);
  for (size_t i = 0; i + 1 < n; i++) {
    assert_true(t[i] < t[i + 1]);
    CagVec3 p[2], q[2], r[2];
    OK(cag_curve_eval(c, t[i], 1, CAG_SIDE_RIGHT, p, &err));
    OK(cag_curve_eval(c, t[i + 1], 1, CAG_SIDE_LEFT, q, &err));
    CagVec3 chord = cag_sub(q[0], p[0]);
    for (int k = 1; k < 20; k++) {
      OK(cag_curve_eval(c, t[i] + (t[i + 1] - t[i]) * k / 20, 1, CAG_SIDE_RIGHT, r, &err));
      CagVec3 off = cag_sub(r[0], p[0]);
      double u = cag_dot(off, chord) / cag_dot(chord, chord);
      u = fmin(1, fmax(0, u));
      assert_true(cag_norm(cag_madd(off, -u, chord)) <= tolerance * (1 + 1e-9));
    }
    double turn = atan2(cag_norm(cag_cross(p[1], q[1])), cag_dot(p[1], q[1]));
    if (cag_norm(p[1]) > 0 && cag_norm(q[1]) > 0) assert_true(turn <= angle * (1 + 1e-9));
  }
  double cuts[64];
  size_t m = c->kind->breaks ? c->kind->breaks(c, cuts, 64) : 0;
  for (size_t k = 0; k < m; k++) {
    bool found = false;
    for (size_t i = 0; i < n; i++) found = found || t[i] == cuts[k];
    assert_true(found);
  }
  free(t);
}

static void polylines_keep_the_tolerance(void **state) {
  (void)state;
  static const CagVec3 p[7] = {{0, 0, 0}, {1, 3, 0},  {2, -1, 2}, {3, 4, 0},
                               {5, 4, 1}, {6, 0, -2}, {8, 1, 0}};
  static const double w[7] = {1, 5, 0.2, 3, 1, 1, 2};
  static const double tolerances[3] = {0.1, 0.001, 1e-6};
  CagCurve *c[6];
  OK(cag_curve_bezier(p, NULL, 7, 3, &c[0], &err));
  OK(cag_curve_bezier(p, w, 7, 3, &c[1], &err));
  OK(cag_curve_nurbs_closed(p, w, 7, 3, 3, &c[2], &err));
  OK(cag_curve_helix(2, 1, 3, 0.5, &c[3], &err));
  c[4] = ellipse(5, 1, 0, 2 * M_PI);
  c[5] = ellipse(5, 5, 1, 6);
  for (int i = 0; i < 6; i++) {
    for (int k = 0; k < 3; k++) check_polyline(c[i], tolerances[k], M_PI);
    check_polyline(c[i], 10, 0.1);
    cag_curve_release(c[i]);
  }
}

// A chord over the angle s deviates by r (1 - cos(s / 2)).
static void a_circle_takes_the_fewest_points(void **state) {
  (void)state;
  CagCurve *c = ellipse(100, 100, 0, 2 * M_PI);
  double *t;
  size_t n;
  OK(cag_curve_discretize(c, 0.01, M_PI, &t, &n, &err));
  assert_int_equal(n, (size_t)ceil(M_PI / acos(1 - 0.01 / 100)) + 1);
  free(t);
  FAILS(cag_curve_discretize(c, 0, M_PI, &t, &n, &err), "tolerance-not-positive");
  FAILS(cag_curve_discretize(c, 0.1, 0, &t, &n, &err), "angle-not-positive");
  cag_curve_release(c);
}

static void the_closest_point_is_the_global_one(void **state) {
  (void)state;
  static const CagVec3 p[7] = {{0, 0, 0}, {1, 3, 0},  {2, -1, 2}, {3, 4, 0},
                               {5, 4, 1}, {6, 0, -2}, {8, 1, 0}};
  CagCurve *c[4];
  OK(cag_curve_bezier(p, NULL, 7, 3, &c[0], &err));
  OK(cag_curve_nurbs_closed(p, NULL, 7, 3, 3, &c[1], &err));
  OK(cag_curve_polyline(p, 7, true, 3, &c[2], &err));
  OK(cag_curve_helix(2, 1, 3, 0, &c[3], &err));
  unsigned seed = 1;
  for (int i = 0; i < 4; i++) {
    for (int k = 0; k < 25; k++) {
      double x[3];
      for (int j = 0; j < 3; j++) {
        seed = seed * 1664525u + 1013904223u;
        x[j] = seed / 4294967296.0 * 8 - 2;
      }
      CagVec3 q = cag_vec3(x[0], x[1], x[2]), found, best, d[2];
      double t, distance, least = INFINITY;
      OK(cag_curve_closest(c[i], q, &t, &found, &distance, &err));
      NEAR(cag_norm(cag_sub(found, q)), distance, 1e-14);
      OK(cag_curve_eval(c[i], t, 1, CAG_SIDE_RIGHT, d, &err));
      near_vec(d[0], found, 1e-14);
      for (int s = 0; s <= 4000; s++) {
        double u = s == 4000 ? c[i]->end : c[i]->start + (c[i]->end - c[i]->start) * s / 4000;
        OK(cag_curve_point(c[i], u, &best, &err));
        least = fmin(least, cag_norm(cag_sub(best, q)));
      }
      assert_true(distance <= least + 1e-12 && distance >= least - 1e-2);
    }
    cag_curve_release(c[i]);
  }
  // All points of a circle are equally far from its center.
  CagCurve *round = ellipse(2, 2, 0, 2 * M_PI), *exact;
  double distance;
  OK(cag_curve_closest(round, cag_vec3(0, 0, 0), NULL, NULL, &distance, &err));
  NEAR(distance, 2, 1e-15);
  OK(cag_curve_to_nurbs(round, &exact, &err));
  OK(cag_curve_closest(exact, cag_vec3(0, 0, 0), NULL, NULL, &distance, &err));
  NEAR(distance, 2, 1e-14);
  OK(cag_curve_closest(round, cag_vec3(3, 4, 12), NULL, NULL, &distance, &err));
  NEAR(distance, sqrt(9 + 144), 1e-13);
  cag_curve_release(round);
  cag_curve_release(exact);
}

// Curves with peaks of speed and near cusps, compared with mpmath results of at least 40 digits:
// ellipses, 4 E(1 - b^2); the parabola with the middle weight w; and the cubic [0, 0], [1, 1], [k,
// 1], [1, 0], which has a cusp at k = 0.
static void lengths_of_uneven_speed_are_right(void **state) {
  (void)state;
  CagCurve *c = ellipse(1, 1e-4, 0, 2 * M_PI);
  NEAR(length_of(c), 4.0000002019326954, 1e-12);
  cag_curve_release(c);
  static const double parabola[][2] = {{1e2, 2.8165856059646152},  {1e4, 2.8283073248631982},
                                       {1e6, 2.8284259266073696},  {1e8, 2.8284271127647879},
                                       {1e10, 2.8284271246263761}, {1e12, 2.8284271247449920},
                                       {1e15, 2.8284271247461889}};
  for (size_t i = 0; i < sizeof parabola / sizeof *parabola; i++) {
    static const CagVec3 p[3] = {{0, 0, 0}, {1, 1, 0}, {2, 0, 0}};
    const double weights[3] = {1, parabola[i][0], 1};
    OK(cag_curve_bezier(p, weights, 3, 2, &c, &err));
    NEAR(length_of(c), parabola[i][1], 1e-13);
    cag_curve_release(c);
  }
  static const CagVec3 wave[4] = {{0, 0, 0}, {1, 1, 0}, {2, -1, 0}, {3, 0, 0}};
  OK(cag_curve_bezier(wave, (const double[]){1, 1e12, 1e-3, 1}, 4, 2, &c, &err));
  NEAR(length_of(c), 3.6502815398722857, 1e-13);
  cag_curve_release(c);
  OK(cag_curve_bezier(wave, (const double[]){1, 1e6, 1e12, 1e3}, 4, 2, &c, &err));
  NEAR(length_of(c), 4.0968825395385815, 1e-13);
  // The lengths of the parts add up, wherever the curve is cut.
  for (int k = 1; k < 20; k++) {
    const double t = k % 2 ? pow(10, -k) : 1 - pow(10, -k);
    double before, after;
    OK(cag_curve_length(c, 0, t, &before, &err));
    OK(cag_curve_length(c, t, 1, &after, &err));
    NEAR(before + after, 4.0968825395385815, 1e-13);
  }
  cag_curve_release(c);
  static const double cubic[][2] = {{0, 1.8284271247461901},     {1e-9, 1.8284271246175104},
                                    {1e-6, 1.8284269960680730},  {1e-3, 1.8282993367024019},
                                    {-1e-3, 1.8285566963225382}, {-1e-6, 1.8284272534273859}};
  for (size_t i = 0; i < 6; i++) {
    const CagVec3 p[4] = {{0, 0, 0}, {1, 1, 0}, {cubic[i][0], 1, 0}, {1, 0, 0}};
    OK(cag_curve_bezier(p, NULL, 4, 2, &c, &err));
    NEAR(length_of(c), cubic[i][1], 1e-12);
    cag_curve_release(c);
  }
}

// Multiplying the weights by powers of a number changes the speed, but not the points or the
// length.
static void lengths_do_not_depend_on_the_speed(void **state) {
  (void)state;
  uint64_t random = 31;
  for (int i = 0; i < 200; i++) {
    CagVec3 p[5];
    double plain[5], uneven[5], number[20];
    const int n = 3 + i % 3;
    for (int k = 0; k < 20; k++) {
      random = random * 6364136223846793005u + 1442695040888963407u;
      number[k] = (double)(random >> 11) / 9007199254740992.0;
    }
    const double factor = pow(10, 24 * number[19] - 12);
    for (int k = 0; k < n; k++) {
      p[k] = cag_vec3(10 * number[3 * k], 10 * number[3 * k + 1], 10 * number[3 * k + 2]);
      plain[k] = 0.5 + number[15 + k % 4];
      uneven[k] = plain[k] * pow(factor, k);
    }
    CagCurve *a, *b;
    OK(cag_curve_bezier(p, plain, (size_t)n, 3, &a, &err));
    OK(cag_curve_bezier(p, uneven, (size_t)n, 3, &b, &err));
    NEAR(length_of(b) / length_of(a), 1, 1e-12);
    cag_curve_release(a);
    cag_curve_release(b);
  }
}

// As the middle weight grows, a conic approaches two sides of its triangle. The area and second
// moments of the region between curve and chord approach those of the triangle.
static void areas_of_uneven_speed_are_right(void **state) {
  (void)state;
  static const CagVec3 p[3] = {{0, 0, 0}, {1, 1, 0}, {2, 0, 0}}, chord[2] = {{2, 0, 0}, {0, 0, 0}};
  CagCurve *parts[2], *loop;
  CagRegion *region;
  double area, xx, xy, yy;
  CagVec3 center;
  OK(cag_curve_bezier(p, (const double[]){1, 1e12, 1}, 3, 2, &parts[0], &err));
  OK(cag_curve_polyline(chord, 2, false, 2, &parts[1], &err));
  OK(cag_curve_join(parts, 2, &loop, &err));
  OK(cag_region_new(loop, NULL, 0, &region, &err));
  OK(cag_region_second_moments(region, &area, &center, &xx, &xy, &yy, &err));
  NEAR(area, 1, 1e-13);
  near_vec(center, cag_vec3(1, 1.0 / 3, 0), 1e-13);
  NEAR(xx, 1.0 / 6, 1e-13);
  NEAR(xy, 0, 1e-13);
  NEAR(yy, 1.0 / 18, 1e-13);
  cag_region_release(region);
  cag_curve_release(loop);
  cag_curve_release(parts[0]);
  cag_curve_release(parts[1]);
}

// The curve except for its end is between the last two numbers of its domain. No parameter is
// closer to the middle than the ends, and the search must terminate.
static void curves_within_the_last_digit_have_a_closest_point(void **state) {
  (void)state;
  const CagVec3 p[4] = {{0, 0, 0}, {1, 2, 0}, {3, 3, 0}, {4, 0, 0}};
  for (size_t n = 3; n <= 4; n++)
    for (int mirrored = 0; mirrored < 2; mirrored++) {
      double w[4];
      for (size_t i = 0; i < n; i++) w[i] = pow(1e-20, (double)(mirrored ? n - 1 - i : i));
      CagCurve *c;
      OK(cag_curve_bezier(p, w, n, 2, &c, &err));
      const CagVec3 target = cag_vec3(1.8, 2.5, 0);
      double t, distance;
      CagVec3 foot, at;
      OK(cag_curve_closest(c, target, &t, &foot, &distance, &err));
      OK(cag_curve_point(c, t, &at, &err));
      near_vec(at, foot, 0);
      NEAR(cag_norm(cag_sub(foot, target)), distance, 1e-15);
      const double first = cag_norm(cag_sub(p[0], target)),
                   last = cag_norm(cag_sub(p[n - 1], target));
      assert_true(distance <= fmin(first, last));
      cag_curve_release(c);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(an_ellipse_has_the_perimeter_of_the_elliptic_integral),
      cmocka_unit_test(a_helix_has_constant_speed),
      cmocka_unit_test(parabola_and_cusp_have_their_lengths),
      cmocka_unit_test(a_rational_circle_has_length_and_area_of_the_circle),
      cmocka_unit_test(areas_and_centroids_of_polygons),
      cmocka_unit_test(bounds_are_tight),
      cmocka_unit_test(planes_and_lines_are_recognized),
      cmocka_unit_test(polylines_keep_the_tolerance),
      cmocka_unit_test(a_circle_takes_the_fewest_points),
      cmocka_unit_test(lengths_of_uneven_speed_are_right),
      cmocka_unit_test(lengths_do_not_depend_on_the_speed),
      cmocka_unit_test(areas_of_uneven_speed_are_right),
      cmocka_unit_test(the_closest_point_is_the_global_one),
      cmocka_unit_test(curves_within_the_last_digit_have_a_closest_point),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
