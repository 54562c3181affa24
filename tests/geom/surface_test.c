// Properties of every kind of surface: isocurves, bounds, integrals, breaks, grids, and maps.

#include "geom/surface/loft.h"
#include "geom/surface/patches.h"
#include "geom/surface/reshape.h"
#include "surface_support.h"

// --- Planar pieces, isocurves ---

static void planar_pieces_measure_their_region(void **state) {
  (void)state;
  CagTransform frame, identity = cag_transform_identity();
  CagCurve *outer, *hole;
  CagRegion *region;
  CagSurface *s;
  const CagVec3 square[] = {{0, 0, 0}, {6, 0, 0}, {6, 4, 0}, {0, 4, 0}};
  MUST(cag_curve_polyline(square, 4, true, 2, &outer, err));
  identity.m[0][3] = 2;
  identity.m[1][3] = 2;
  MUST(cag_curve_arc(1, 1, 0, 2 * M_PI, &identity, &hole, err));
  MUST(cag_region_new(outer, &hole, 1, &region, err));
  MUST(cag_axes(cag_vec3(0, 0, 5), cag_vec3(1, 0, 0), cag_vec3(0, 0, 1), &frame, err));
  MUST(cag_surface_planar(region, &frame, &s, err));
  assert_area(s, 24 - M_PI);
  assert_bounds(s, cag_vec3(0, 0, 5), cag_vec3(6, 0, 9));
  assert_false(cag_surface_is_closed(s));
  CagVec3 n;
  MUST(cag_surface_normal(s, 1, 1, &n, err));
  assert_point(n, cag_vec3(0, -1, 0), 1e-15, "normal");
  CagSurface *flipped;
  MUST(cag_surface_flip(s, &flipped, err));
  MUST(cag_surface_normal(flipped, 1, 1, &n, err));
  assert_point(n, cag_vec3(0, 1, 0), 1e-15, "normal of the flip");
  assert_area(flipped, 24 - M_PI);
  assert_transforms(s);
  cag_surface_release(flipped);
  cag_surface_release(s);
  cag_region_release(region);
  cag_curve_release(outer);
  cag_curve_release(hole);
}

static void isocurves_run_on_the_surface(void **state) {
  (void)state;
  CagSurface *s;
  CagCurve *c, *part;
  double length;
  MUST(cag_surface_torus(3, 1, &s, err));
  MUST(cag_surface_isocurve(s, 1, M_PI / 2, &c, err));
  assert_true(c->closed && c->angular);
  MUST(cag_curve_length(c, c->start, c->end, &length, err));
  assert_near(length, 6 * M_PI, 1e-9, "top circle");
  MUST(cag_curve_trim(c, 1, 2, &part, err));
  MUST(cag_curve_length(part, 1, 2, &length, err));
  assert_near(length, 3, 1e-9, "its part");
  CagBounds box; // sin has its maximum inside, cos falls
  MUST(cag_curve_bounds(part, &box, err));
  assert_near(box.max.y, 3, 1e-9, "bounds");
  assert_near(box.min.y, 3 * sin(1), 1e-9, "bounds");
  assert_near(box.min.x, 3 * cos(2), 1e-9, "bounds");
  assert_near(box.max.x, 3 * cos(1), 1e-9, "bounds");
  assert_near(box.min.z, 1, 1e-12, "bounds");
  cag_curve_release(part);
  MUST(cag_curve_reverse(c, &part, err));
  CagVec3 p;
  MUST(cag_curve_point(part, 1, &p, err));
  assert_point(p, surface_at(s, 2 * M_PI - 1, M_PI / 2), 1e-14, "reversed");
  cag_curve_release(part);
  cag_curve_release(c);
  cag_surface_release(s);
}

// A cap like a paraboloid, whose height has an inner maximum that no grid point hits.
static void bounds_are_tight_between_samples(void **state) {
  (void)state;
  const CagVec3 net[] = {{0, 0, 0}, {0, 1, 0}, {0, 2, 0}, {1, 0, 0}, {1, 1, 5},
                         {1, 2, 1}, {2, 0, 0}, {2, 1, 2}, {2, 2, 0}};
  CagSurface *s;
  CagBounds box;
  MUST(cag_surface_bezier(net, NULL, 3, 3, &s, err));
  MUST(cag_surface_bounds(s, &box, err));
  double best = 0;
  enum { N = 1500 };
  for (int i = 0; i <= N; i++)
    for (int j = 0; j <= N; j += 1) {
      double u = (double)i / N, v = (double)j / N;
      double z =
          4 * u * (1 - u) * v * (1 - v) * 5 + 2 * u * (1 - u) * v * v + u * u * 2 * v * (1 - v) * 2;
      best = fmax(best, z);
    }
  assert_true(box.max.z >= best);
  assert_near(box.max.z, best, 1e-6, "height");
  cag_surface_release(s);
}

// The parabola [0, 0], [1, 1], [2, 0] with the middle weight w: revolved about the x axis,
// extruded, and as the base of a prism. The expected values are from mpmath with 40 digits.
static void integrals_of_uneven_surfaces_are_right(void **state) {
  (void)state;
  static const struct {
    double weight, length, area, turned_area, turned_volume;
  } cases[] = {
      {1e2, 2.8165856059646152, 0.99957010128011681, 8.8097363770118865, 2.0919031593887972},
      {1e4, 2.8283073248631982, 0.99999991096512311, 8.8850127849046535, 2.0943945639145109},
      {1e6, 2.8284259266073696, 0.99999999998649134, 8.8857583481313851, 2.0943951023104125},
  };
  const CagVec3 p[3] = {{0, 0, 0}, {1, 1, 0}, {2, 0, 0}}, x_axis = {1, 0, 0}, o = {0, 0, 0};
  for (size_t i = 0; i < 3; i++) {
    const double weights[3] = {1, cases[i].weight, 1};
    CagCurve *both[2], *outline;
    CagSurface *s;
    CagRegion *region;
    double area = 0, terms[10] = {0};
    MUST(cag_curve_bezier(p, weights, 3, 2, &both[0], err));
    MUST(cag_curve_line(p[2], p[0], 2, &both[1], err));
    MUST(cag_surface_extrude(both[0], cag_vec3(0, 0, 3), 0, 1, &s, err));
    MUST(cag_surface_area(s, &area, NULL, err));
    assert_near(area, 3 * cases[i].length, 1e-8, "wall");
    cag_surface_release(s);
    MUST(cag_surface_revolve(both[0], x_axis, o, 0, 2 * M_PI, &s, err));
    MUST(cag_surface_area(s, &area, NULL, err));
    MUST(cag_surface_volume_terms(s, terms, err));
    assert_near(area, cases[i].turned_area, 1e-8, "turned area");
    assert_near(fabs(terms[0]), cases[i].turned_volume, 1e-8, "turned volume");
    cag_surface_release(s);
    MUST(cag_curve_join(both, 2, &outline, err));
    MUST(cag_region_new(outline, NULL, 0, &region, err));
    MUST(cag_region_area(region, &area, NULL, err));
    assert_near(area, cases[i].area, 1e-10, "region");
    // The flux through the lid of a prism of height 3 is the area times 3 / 3.
    const CagTransform lid = cag_translate(cag_vec3(0, 0, 3));
    double flux[10] = {0};
    MUST(cag_surface_planar(region, &lid, &s, err));
    MUST(cag_surface_volume_terms(s, flux, err));
    assert_near(flux[0], cases[i].area, 1e-10, "lid");
    cag_surface_release(s);
    cag_region_release(region);
    cag_curve_release(outline);
    cag_curve_release(both[0]);
    cag_curve_release(both[1]);
  }
}

// --- Breaks ---

static void assert_cuts(const CagSurface *s, int direction, const double *wanted, size_t n,
                        const char *what) {
  double *cuts;
  size_t found;
  MUST(cag_surface_cuts(s, direction, &cuts, &found, err));
  if (found + 1 != n)
    fail_msg("%s by %c: %zu stretches, not %zu", what, "uv"[direction], found, n - 1);
  for (size_t i = 0; i < n; i++) assert_near(cuts[i], wanted[i], 1e-12, what);
  free(cuts);
}

// Checks that the surface, its transpose, flip, image, offset, and part have the breaks of the
// curves.
static void assert_breaks(CagSurface *s, const double *u, size_t nu, const double *v, size_t nv,
                          const char *what) {
  CagSurface *t;
  double back[16], part[16];
  size_t n = 0;
  assert_cuts(s, 0, u, nu, what);
  assert_cuts(s, 1, v, nv, what);
  MUST(cag_surface_transpose(s, &t, err));
  assert_cuts(t, 0, v, nv, what);
  assert_cuts(t, 1, u, nu, what);
  cag_surface_release(t);
  MUST(cag_surface_flip(s, &t, err));
  for (size_t i = 0; i < nv; i++) back[i] = v[0] + v[nv - 1] - v[nv - 1 - i];
  assert_cuts(t, 0, u, nu, what);
  assert_cuts(t, 1, back, nv, what);
  cag_surface_release(t);
  CagTransform map = cag_shear(0.3, -0.2, 0.5, 0.1, 0, 0.4);
  MUST(cag_surface_transform(s, &map, &t, err));
  assert_cuts(t, 0, u, nu, what);
  assert_cuts(t, 1, v, nv, what);
  cag_surface_release(t);
  MUST(cag_surface_offset(s, 0.1, &t, err));
  assert_cuts(t, 0, u, nu, what);
  assert_cuts(t, 1, v, nv, what);
  cag_surface_release(t);
  // From the middle of the first interval of u to that of the last.
  part[n++] = (u[0] + u[1]) / 2;
  for (size_t i = 1; i + 1 < nu; i++) part[n++] = u[i];
  const double end = (u[nu - 2] + 2 * u[nu - 1]) / 3;
  part[n++] = end;
  MUST(cag_surface_part(s, part[0], end, v[0], v[nv - 1], &t, err));
  assert_cuts(t, 0, part, n, what);
  assert_cuts(t, 1, v, nv, what);
  cag_surface_release(t);
  cag_surface_release(s);
}

static void breaks_are_those_of_the_curves(void **state) {
  (void)state;
  const CagVec3 p[] = {{1, 0, 0}, {3, 0, 1}, {2, 0, 2}, {4, 0, 3}},
                q[] = {{1, 5, 0}, {3, 5, 1}, {4, 6, 4}};
  const CagVec3 r[] = {{1, 0, 0}, {1, 2, 0}, {0, 5, 1}};
  const double thirds[] = {0, 1, 2, 3}, whole[] = {0, 1}, halves[] = {0, 1, 2};
  const double both[] = {0, 1.0 / 3, 0.5, 2.0 / 3, 1}, turn[] = {-1, 2};
  CagCurve *a, *b, *c, *d, *e;
  CagSurface *s;
  MUST(cag_curve_polyline(p, 4, false, 3, &a, err));
  MUST(cag_curve_polyline(q, 3, false, 3, &b, err));
  MUST(cag_curve_polyline(r, 3, false, 3, &c, err));
  MUST(cag_surface_extrude(a, cag_vec3(0, 2, 0), 0, 1, &s, err));
  assert_breaks(s, thirds, 4, whole, 2, "extrusion");
  MUST(cag_surface_extrude(a, cag_vec3(0, 2, 1), 0.4, 1.5, &s, err));
  assert_breaks(s, thirds, 4, whole, 2, "twisted extrusion");
  MUST(cag_surface_revolve(a, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), -1, 2, &s, err));
  assert_breaks(s, thirds, 4, turn, 2, "revolution");
  MUST(cag_surface_ruled(a, b, &s, err));
  assert_breaks(s, whole, 2, both, 5, "ruled");
  MUST(cag_surface_translational(a, c, &s, err));
  assert_breaks(s, thirds, 4, halves, 3, "translational");
  // Polylines along v = 0 and v = 1, with lines between them.
  MUST(cag_curve_line(p[0], q[0], 3, &d, err));
  MUST(cag_curve_line(p[3], q[2], 3, &e, err));
  MUST(cag_surface_coons(d, e, a, b, &s, err));
  assert_breaks(s, both, 5, whole, 2, "Coons");
  cag_curve_release(d);
  cag_curve_release(e);
  // Lofts through curves without an exact form: averages of three successive parameters are the
  // knots, and a curve of two pieces has a break in the middle.
  CagCurve *coil[7];
  for (int i = 0; i < 7; i++) {
    CagTransform up = cag_translate(cag_vec3(0.3 * i, 0, 4.0 * i));
    MUST(cag_curve_helix(2 + 0.3 * i, 1, 0.75, 0, &d, err));
    MUST(cag_curve_transform(d, &up, &coil[i], err));
    cag_curve_release(d);
  }
  const double knots[] = {0, 2, 3, 4, 6}, middle[] = {0, 0.5, 1};
  MUST(cag_surface_loft((const CagCurve *const *)coil, 7, 3, false, &s, err));
  assert_breaks(s, whole, 2, knots, 5, "loft");
  cag_curve_release(coil[6]);
  const CagVec3 bent[] = {{4, 0, 25}, {2, 3, 26}, {-1, 3, 25}};
  MUST(cag_curve_polyline(bent, 3, false, 3, &coil[6], err));
  MUST(cag_surface_loft((const CagCurve *const *)coil, 7, 3, false, &s, err));
  assert_breaks(s, middle, 3, knots, 5, "loft to a polyline");
  for (int i = 0; i < 7; i++) cag_curve_release(coil[i]);
  cag_curve_release(a);
  cag_curve_release(b);
  cag_curve_release(c);
}

// --- The maximum degree, and projective maps ---

// z = (x^2 + y^2)^16 on the unit square has degree 32. Elevated to 63, the control values of x^k
// are binomial(i, k) / binomial(63, k).
static void grids_of_the_largest_degree_are_their_points(void **state) {
  (void)state;
  enum { DEGREE = 63, N = 7 };
  static CagVec3 net[(DEGREE + 1) * (DEGREE + 1)];
  static double power[DEGREE + 1][33];
  for (int i = 0; i <= DEGREE; i++) {
    power[i][0] = 1;
    for (int k = 1; k <= 32; k++)
      power[i][k] = power[i][k - 1] * fmax(0, i - k + 1) / (DEGREE - k + 1);
  }
  for (int i = 0; i <= DEGREE; i++)
    for (int j = 0; j <= DEGREE; j++) {
      double z = 0, binomial = 1;
      for (int k = 0; k <= 16; k++) {
        z += binomial * power[i][2 * k] * power[j][32 - 2 * k];
        binomial = binomial * (16 - k) / (k + 1);
      }
      net[i * (DEGREE + 1) + j] = cag_vec3((double)i / DEGREE, (double)j / DEGREE, z);
    }
  CagSurface *s;
  MUST(cag_surface_bezier(net, NULL, DEGREE + 1, DEGREE + 1, &s, err));
  double at[N];
  CagVec3 points[N * N], du[N * N], dv[N * N];
  for (int i = 0; i < N; i++) at[i] = (double)i / (N - 1);
  for (int round = 0; round < 2; round++) {
    MUST(cag_surface_eval_grid(s, at, N, at, N, points, round ? du : NULL, round ? dv : NULL, err));
    for (int i = 0; i < N; i++)
      for (int j = 0; j < N; j++) {
        const double x = at[i], y = at[j], sum = x * x + y * y;
        assert_point(points[i * N + j], cag_vec3(x, y, pow(sum, 16)), 1e-10, "point");
        if (!round) continue;
        assert_point(du[i * N + j], cag_vec3(1, 0, 32 * x * pow(sum, 15)), 1e-9, "along u");
        assert_point(dv[i * N + j], cag_vec3(0, 1, 32 * y * pow(sum, 15)), 1e-9, "along v");
      }
  }
  cag_surface_release(s);
}

static void translational_surfaces_move_point_by_point(void **state) {
  (void)state;
  const CagVec3 p[] = {{0, 0, 0}, {1, 2, 0.5}, {3, 0, 1}}, q[] = {{0, 0, 0}, {-1, 1, 2}, {0, 3, 4}};
  CagCurve *a, *b;
  CagSurface *s;
  MUST(cag_curve_bezier(p, NULL, 3, 3, &a, err));
  MUST(cag_curve_bezier(q, NULL, 3, 3, &b, err));
  MUST(cag_surface_translational(a, b, &s, err));
  for (int projective = 0; projective < 2; projective++) {
    CagTransform t = cag_transform_identity();
    CagSurface *moved;
    t.planar = false;
    t.m[0][1] = 0.5;
    t.m[1][2] = -0.25;
    t.m[2][3] = 3;
    t.m[3][0] = projective ? 0.05 : 0;
    t.m[3][2] = projective ? 0.02 : 0;
    MUST(cag_surface_transform(s, &t, &moved, err));
    if (!projective) assert_string_equal(moved->kind->name, s->kind->name);
    for (int i = 0; i <= 4; i++)
      for (int j = 0; j <= 4; j++)
        assert_point(surface_at(moved, i / 4.0, j / 4.0),
                     cag_transform_point(&t, surface_at(s, i / 4.0, j / 4.0)), 1e-13, "moved");
    cag_surface_release(moved);
  }
  cag_surface_release(s);
  cag_curve_release(a);
  cag_curve_release(b);
}

// The corners, the area |x x y|, the bounds, and the exact form.
static void parallelograms_are_the_bilinear_surface_of_their_corners(void **state) {
  (void)state;
  const CagVec3 o = {1, 2, 3}, x = {2, 0, 1}, y = {-1, 3, 0.5};
  CagSurface *s, *exact;
  CagVec3 back[3];
  CagBounds box;
  double area;
  MUST(cag_surface_parallelogram(o, x, y, &s, err));
  assert_consistent(s);
  assert_transforms(s);
  assert_true(cag_surface_parallelogram_view(s, &back[0], &back[1], &back[2]));
  assert_point(back[2], y, 0, "y");
  MUST(cag_surface_area(s, &area, NULL, err));
  assert_near(area, sqrt(3 * 3 + 2 * 2 + 6 * 6), 1e-12, "area"); // x x y = [-3, -2, 6]
  MUST(cag_surface_bounds(s, &box, err));
  assert_point(box.min, cag_vec3(0, 2, 3), 1e-12, "least");
  assert_point(box.max, cag_vec3(3, 5, 4.5), 1e-12, "most");
  MUST(cag_surface_to_nurbs(s, &exact, err));
  for (int k = 0; k < 4; k++) {
    const double u = inside(0, 1, k), v = inside(0, 1, 3 - k);
    assert_point(surface_at(exact, u, v), surface_at(s, u, v), 1e-14, "exact form");
  }
  assert_false(cag_surface_parallelogram_view(exact, &back[0], &back[1], &back[2]));
  cag_surface_release(exact);
  cag_surface_release(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(planar_pieces_measure_their_region),
      cmocka_unit_test(isocurves_run_on_the_surface),
      cmocka_unit_test(bounds_are_tight_between_samples),
      cmocka_unit_test(integrals_of_uneven_surfaces_are_right),
      cmocka_unit_test(breaks_are_those_of_the_curves),
      cmocka_unit_test(grids_of_the_largest_degree_are_their_points),
      cmocka_unit_test(translational_surfaces_move_point_by_point),
      cmocka_unit_test(parallelograms_are_the_bilinear_surface_of_their_corners),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
