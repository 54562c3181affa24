// Convex hulls, side predicates, curves on surfaces and distances of meshes: closed forms.

#include "geom/mesh/hull.h"
#include "geom/mesh/predicates.h"
#include "geom/mesh/separation.h"
#include "geom/mesh/tessellate.h"
#include "geom/surface/curve_on.h"
#include "support.h"

static CagMesh *hull_of(const CagVec3 *points, size_t n) {
  CagMesh *m;
  CagVec3 edge[2];
  OK(cag_hull_space(points, n, &m, &err));
  assert_true(cag_mesh_is_watertight(m, edge));
  assert_int_equal(cag_mesh_euler_characteristic(m), 2);
  return m;
}

static double volume_of(const CagMesh *m) {
  double terms[10] = {0};
  cag_mesh_volume_terms(m, terms);
  return terms[0];
}

static double random_number(uint64_t *state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (double)(*state >> 11) / 9007199254740992.0;
}

static void sides_are_exact(void **state) {
  (void)state;
  // 0.5 + k 2^-53: on the line x = y to the last bit, or beside it by one.
  const CagVec3 a = cag_vec3(12, 12, 0), b = cag_vec3(24, 24, 0);
  for (int i = 0; i < 64; i++)
    for (int k = 0; k < 64; k++) {
      const CagVec3 c = cag_vec3(0.5 + i * 0x1p-53, 0.5 + k * 0x1p-53, 0);
      assert_int_equal(cag_side_of_line(a, b, c), (k > i) - (k < i));
      const CagVec3 up = cag_vec3(12, 12, 1e5);
      const int side = cag_side_of_plane(a, b, up, c); // the plane x = y, seen from x > y
      assert_int_equal(side, (i > k) - (i < k));
    }
  assert_int_equal(
      cag_side_of_plane(cag_vec3(0, 0, 0), cag_vec3(1, 0, 0), cag_vec3(0, 1, 0), cag_vec3(0, 0, 1)),
      1);
}

static void plane_hulls_run_counter_clockwise_without_straight_corners(void **state) {
  (void)state;
  const CagVec3 points[] = {{2, 2, 0}, {1, 0, 0}, {0, 0, 0}, {2, 0, 0},
                            {0, 2, 0}, {1, 1, 0}, {0, 0, 0}, {0, 1, 0}};
  size_t *ring, n;
  OK(cag_hull_plane(points, 8, &ring, &n, &err));
  const size_t expected[] = {2, 3, 0, 4};
  assert_int_equal(n, 4);
  assert_memory_equal(ring, expected, sizeof expected);
  free(ring);
  // Tenths are not on one line to the last bit, but to rounding.
  CagVec3 tenths[31];
  for (int i = 0; i < 30; i++) tenths[i] = cag_vec3(0.1 * i, 0.3 * i, 0);
  tenths[30] = cag_vec3(5, 0, 0);
  OK(cag_hull_plane(tenths, 31, &ring, &n, &err));
  assert_int_equal(n, 3);
  free(ring);
  FAILS(cag_hull_plane(tenths, 30, &ring, &n, &err), "collinear-points");
  FAILS(cag_hull_plane(tenths, 2, &ring, &n, &err), "too-few-points");
  const CagVec3 same[3] = {{1, 2, 0}, {1, 2, 0}, {1, 2, 0}};
  FAILS(cag_hull_plane(same, 3, &ring, &n, &err), "coincident-points");
}

static void boxes_of_grids_have_eight_corners(void **state) {
  (void)state;
  enum { N = 6 };
  CagVec3 points[N * N * N];
  CagTransform turn;
  OK(cag_rotate(cag_vec3(1, 2, 3), 0.7, cag_vec3(0.3, 0, 0), &turn, &err));
  for (int turned = 0; turned < 2; turned++) {
    for (int i = 0; i < N * N * N; i++) {
      points[i] = cag_vec3(i % N * 0.1, i / N % N * 0.2, i / (N * N) * 0.3);
      if (turned) points[i] = cag_transform_point(&turn, points[i]);
    }
    CagMesh *m = hull_of(points, N * N * N);
    assert_int_equal(m->vertex_count, 8);
    assert_int_equal(m->triangle_count, 12);
    NEAR(volume_of(m), 0.5 * 1 * 1.5, 1e-14);
    cag_mesh_release(m);
  }
}

static void hulls_hold_all_points(void **state) {
  (void)state;
  enum { N = 2000 };
  static CagVec3 points[N];
  uint64_t seed = 7;
  for (int kind = 0; kind < 3; kind++) {
    for (int i = 0; i < N; i++) {
      CagVec3 p = cag_vec3(random_number(&seed) - 0.5, random_number(&seed) - 0.5,
                           random_number(&seed) - 0.5);
      if (kind == 0) p = cag_unit(p); // all are corners
      if (kind == 1)                  // many in planes and lines
        p = cag_vec3(floor(8 * p.x), floor(8 * p.y), floor(8 * p.z));
      points[i] = p;
    }
    CagMesh *m = hull_of(points, N);
    if (kind == 0) {
      assert_int_equal(m->vertex_count, N);
      assert_int_equal(m->triangle_count, 2 * N - 4); // Euler
    }
    if (kind == 1) NEAR(volume_of(m), 343, 1e-11);
    for (size_t t = 0; t < m->triangle_count; t++) {
      const uint32_t *k = m->triangles + 3 * t;
      for (int i = 0; i < N; i++)
        assert_true(cag_side_of_plane(m->positions[k[0]], m->positions[k[1]], m->positions[k[2]],
                                      points[i]) <= 0);
    }
    cag_mesh_release(m);
  }
}

static void flat_sets_have_no_solid(void **state) {
  (void)state;
  CagVec3 p[50];
  CagMesh *m;
  CagTransform turn;
  OK(cag_rotate(cag_vec3(1, 2, 3), 0.7, cag_vec3(0.3, 0, 0), &turn, &err));
  for (int i = 0; i < 50; i++)
    p[i] = cag_transform_point(&turn, cag_vec3(i % 7 * 0.1, i / 7 * 0.3, 0));
  FAILS(cag_hull_space(p, 50, &m, &err), "coplanar-points");
  for (int i = 0; i < 50; i++) p[i] = cag_vec3(0.1 * i, 0.3 * i, 0.7 * i);
  FAILS(cag_hull_space(p, 50, &m, &err), "collinear-points");
  for (int i = 0; i < 50; i++) p[i] = cag_vec3(0.1, 0.3, 0.7);
  FAILS(cag_hull_space(p, 50, &m, &err), "coincident-points");
  FAILS(cag_hull_space(p, 3, &m, &err), "too-few-points");
  p[7].y = NAN;
  FAILS_AT(cag_hull_space(p, 50, &m, &err), "not-finite", 7);
}

static void curves_on_a_torus_have_the_derivatives_of_its_formula(void **state) {
  (void)state;
  // u = a t, v = b t on [(R + r cos v) cos u, (R + r cos v) sin u, r sin v]: sums of waves.
  const double major = 5, minor = 1, a = 2, b = 3;
  CagSurface *s;
  CagCurve *line, *c;
  OK(cag_surface_torus(major, minor, &s, &err));
  OK(cag_curve_line(cag_vec3(0, 0, 0), cag_vec3(2 * M_PI * a, 2 * M_PI * b, 0), 2, &line, &err));
  CagCurve *timed;
  OK(cag_curve_reparametrize(line, 0, 2 * M_PI, &timed, &err));
  OK(cag_curve_on_surface(s, timed, &c, &err));
  assert_true(c->closed);
  CagVec3 d[4];
  for (int i = 0; i < 40; i++) {
    const double t = 0.157 * i, wave[3] = {a, a + b, a - b};
    const double size[3] = {major, minor / 2, minor / 2};
    OK(cag_curve_eval(c, t, 3, CAG_SIDE_RIGHT, d, &err));
    for (int k = 0; k <= 3; k++) {
      CagVec3 want = cag_vec3(0, 0, pow(b, k) * minor * sin(b * t + k * M_PI / 2));
      for (int w = 0; w < 3; w++) {
        want.x += size[w] * pow(wave[w], k) * cos(wave[w] * t + k * M_PI / 2);
        want.y += size[w] * pow(wave[w], k) * sin(wave[w] * t + k * M_PI / 2);
      }
      near_vec(d[k], want, 1e-11);
    }
  }
  CagCurve *far;
  OK(cag_curve_line(cag_vec3(0, 0, 0), cag_vec3(0, 0, 1), 3, &far, &err));
  FAILS(cag_curve_on_surface(s, far, &c, &err), "not-planar");
  cag_curve_release(far);
  cag_curve_release(line);
  cag_curve_release(timed);
  cag_curve_release(c);
  cag_surface_release(s);
}

// A curve rises and falls by 1e-4 above a line. The nearest of its many nearly equal minima is
// found, compared with samples accurate to 1e-10. Too few pairs are an error, never an uncertain
// distance.
static void the_nearest_of_many_minima_is_found(void **state) {
  (void)state;
  enum { POINTS = 400, SAMPLES = 200000 };
  CagVec3 p[POINTS];
  double knots[POINTS + 4], distance, least = INFINITY;
  uint64_t random = 5;
  for (int i = 0; i < POINTS; i++) {
    random = random * 6364136223846793005u + 1442695040888963407u;
    p[i] = cag_vec3(i, 1 + 1e-4 * (double)(random >> 11) / 9007199254740992.0, 0);
  }
  for (int i = 0; i < POINTS + 4; i++) knots[i] = fmin(fmax(i - 3, 0), POINTS - 3);
  const CagVec3 ends[2] = {{0, 0, 0}, {POINTS, 0, 0}};
  CagCurve *wave, *line;
  CagParts a = {0}, b = {0};
  OK(cag_curve_nurbs(p, NULL, POINTS, 3, knots, 2, &wave, &err));
  OK(cag_curve_polyline(ends, 2, false, 2, &line, &err));
  for (int i = 0; i <= SAMPLES; i++) {
    CagVec3 at;
    OK(cag_curve_point(wave, wave->end * i / SAMPLES, &at, &err));
    least = fmin(least, at.y);
  }
  OK(cag_parts_add_curve(&a, wave, 1e-5, &err));
  OK(cag_parts_add_curve(&b, line, 1e-5, &err));
  OK(cag_parts_distance(&a, &b, CAG_PARTS_PAIRS, &distance, NULL, NULL, &err));
  NEAR(distance, least, 1e-10);
  FAILS(cag_parts_distance(&a, &b, 2, &distance, NULL, NULL, &err), "convergence");
  cag_parts_free(&a);
  cag_parts_free(&b);
  cag_curve_release(wave);
  cag_curve_release(line);
}

static void tori_are_as_far_apart_as_their_circles_less_their_tubes(void **state) {
  (void)state;
  CagSurface *s, *moved;
  CagMesh *m;
  CagParts a = {0}, b = {0};
  double distance;
  CagVec3 foot;
  const CagTransform lift = cag_translate(cag_vec3(0, 0, 7));
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  how.tolerance = 0.01;
  OK(cag_surface_torus(5, 1, &s, &err));
  OK(cag_surface_transform(s, &lift, &moved, &err));
  OK(cag_surface_tessellate(s, &how, &m, &err));
  OK(cag_parts_add_mesh(&a, m, s, how.tolerance, &err));
  NEAR(cag_mesh_winding(m, cag_vec3(5, 0, 0.3)), 1, 1e-9);
  NEAR(cag_mesh_winding(m, cag_vec3(0, 0, 0.3)), 0, 1e-9);
  cag_mesh_release(m);
  OK(cag_surface_tessellate(moved, &how, &m, &err));
  OK(cag_parts_add_mesh(&b, m, moved, how.tolerance, &err));
  OK(cag_parts_distance(&a, &b, CAG_PARTS_PAIRS, &distance, &foot, NULL, &err));
  // The circles of both tori have a constant distance.
  NEAR(distance, 5, 1e-12);
  NEAR(foot.z, 6, 1e-9);
  NEAR(hypot(foot.x, foot.y), 5, 1e-7);
  // The distance is constant all around, which a few pairs cannot show.
  FAILS(cag_parts_distance(&a, &b, 20, &distance, NULL, NULL, &err), "convergence");
  cag_parts_free(&b);
  b = (CagParts){0};
  OK(cag_parts_add_point(&b, cag_vec3(8, 0, 4), &err));
  OK(cag_parts_distance(&a, &b, CAG_PARTS_PAIRS, &distance, NULL, NULL, &err));
  NEAR(distance, 4, 1e-12); // 3-4-5
  cag_parts_free(&a);
  cag_parts_free(&b);
  cag_mesh_release(m);
  cag_surface_release(s);
  cag_surface_release(moved);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sides_are_exact),
      cmocka_unit_test(plane_hulls_run_counter_clockwise_without_straight_corners),
      cmocka_unit_test(boxes_of_grids_have_eight_corners),
      cmocka_unit_test(hulls_hold_all_points),
      cmocka_unit_test(flat_sets_have_no_solid),
      cmocka_unit_test(curves_on_a_torus_have_the_derivatives_of_its_formula),
      cmocka_unit_test(the_nearest_of_many_minima_is_found),
      cmocka_unit_test(tori_are_as_far_apart_as_their_circles_less_their_tubes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
