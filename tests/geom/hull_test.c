// Convex hulls, side predicates, curves on surfaces and distances of meshes: closed forms.

#include "geom/curve/function.h"
#include "geom/mesh/hull.h"
#include "geom/mesh/predicates.h"
#include "geom/mesh/separation.h"
#include "geom/mesh/tessellate.h"
#include "geom/surface/curve_on.h"
#include "geom/surface/quadric.h"
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
  const volatile int stop = 1, go = 0;
  FAILS(cag_parts_distance(&a, &b, 20, &distance, NULL, &stop, &err), "interrupted");
  FAILS(cag_parts_distance(&a, &b, 20, &distance, NULL, &go, &err), "convergence");
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

// --- The end of the search ---

// Along a curve that crosses the other shape all points of the crossing are as near.
static void shapes_that_meet_need_few_pairs(void **state) {
  (void)state;
  for (int i = 0; i < 8; i++) {
    const CagTransform move = cag_translate(cag_vec3(0.7 * i - 2, 0.3 * i, 0.2));
    CagSurface *s, *moved;
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    CagMesh *m[2];
    CagParts a = {0}, b = {0};
    double distance = -1;
    how.tolerance = 0.01;
    OK(cag_surface_torus(5, 1, &s, &err));
    OK(cag_surface_transform(s, &move, &moved, &err));
    OK(cag_surface_tessellate(s, &how, &m[0], &err));
    OK(cag_surface_tessellate(moved, &how, &m[1], &err));
    OK(cag_parts_add_mesh(&a, m[0], s, how.tolerance, &err));
    OK(cag_parts_add_mesh(&b, m[1], moved, how.tolerance, &err));
    OK(cag_parts_distance(&a, &b, 20, &distance, NULL, NULL, &err));
    assert_true(distance == 0);
    cag_parts_free(&a);
    cag_parts_free(&b);
    for (int k = 0; k < 2; k++) cag_mesh_release(m[k]);
    cag_surface_release(s);
    cag_surface_release(moved);
  }
}

typedef struct Calls {
  int count, failing; // the call that fails, from 1; 0: none
} Calls;

static CagStatus fail_once(void *context, double t, int order, CagVec3 *out, CagError *e) {
  Calls *calls = context;
  if (++calls->count == calls->failing)
    return cag_fail(e, CAG_E_CALLBACK, "function-failed", "", -1, "the function failed");
  for (int k = 0; k <= order; k++)
    out[k] = cag_vec3(k == 0 ? t : k == 1, cos(t + k * M_PI / 2), sin(t + k * M_PI / 2));
  return CAG_OK;
}

// Whichever call it is: no later success covers it.
static void a_function_that_fails_once_fails_the_search(void **state) {
  (void)state;
  Calls calls = {0};
  const CagCurveFunction f = {fail_once, NULL, &calls};
  CagCurve *coil;
  CagParts a = {0}, b = {0};
  double distance;
  OK(cag_curve_function(&f, 3, -6, 6, false, &coil, &err));
  OK(cag_parts_add_curve(&a, coil, 1e-3, &err));
  OK(cag_parts_add_point(&b, cag_vec3(0, 4, 0), &err));
  calls.count = 0;
  OK(cag_parts_distance(&a, &b, CAG_PARTS_PAIRS, &distance, NULL, NULL, &err));
  NEAR(distance, 3, 1e-12); // straight above the point of t = 0
  const int most = calls.count;
  assert_true(most > 0);
  for (int i = 1; i <= most; i++) {
    calls = (Calls){0, i};
    FAILS(cag_parts_distance(&a, &b, CAG_PARTS_PAIRS, &distance, NULL, NULL, &err),
          "function-failed");
    assert_int_equal(calls.count, i); // and none is made after it
  }
  cag_parts_free(&a);
  cag_parts_free(&b);
  cag_curve_release(coil);
}

// --- Shapes at a constant distance ---

static double between(uint64_t *state, double from, double to) {
  return from + (to - from) * random_number(state);
}

static void add_surface(CagParts *parts, const CagSurface *s) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *m;
  how.tolerance = 0.01;
  OK(cag_surface_tessellate(s, &how, &m, &err));
  OK(cag_parts_add_mesh(parts, m, s, how.tolerance, &err));
  cag_mesh_release(m);
}

// Takes the surfaces. So few pairs tell the distance only if bounds show that no other is closer.
static double distance_by_few_pairs(CagSurface *s[2], size_t most, uint64_t *state) {
  CagParts parts[2] = {{0}, {0}};
  CagTransform move = cag_translate(cag_vec3(between(state, -9, 9), 2, 3)), turn;
  double distance = -1;
  OK(cag_rotate(cag_vec3(1, 2, between(state, -3, 3)), between(state, 0, 3), cag_vec3(0, 0, 0),
                &turn, &err));
  move = cag_transform_multiply(&move, &turn);
  CagSurface *moved[2];
  for (int i = 0; i < 2; i++) {
    OK(cag_surface_transform(s[i], &move, &moved[i], &err));
    add_surface(&parts[i], moved[i]);
  }
  OK(cag_parts_distance(&parts[0], &parts[1], most, &distance, NULL, NULL, &err));
  for (int i = 0; i < 2; i++) {
    cag_parts_free(&parts[i]);
    cag_surface_release(moved[i]);
    cag_surface_release(s[i]);
  }
  return distance;
}

static CagSurface *quadric(CagQuadricShape shape, double radius, double z, double height) {
  CagTransform frame = cag_transform_identity();
  frame.m[0][0] = frame.m[1][1] = radius;
  frame.m[2][2] = shape == CAG_SHAPE_ELLIPSOID ? radius : 1;
  frame.m[2][3] = z;
  CagSurface *s;
  OK(cag_surface_quadric(shape, &frame, 0, 2 * M_PI, 0,
                         shape == CAG_SHAPE_ELLIPSOID ? M_PI : height, &s, &err));
  return s;
}

// A rectangle with rounded corners, carried upwards.
static CagSurface *wall(double width, double depth, double radius) {
  CagCurve *outline;
  CagSurface *s;
  const CagVec3 corners[4] = {
      {-width, -depth, 0}, {width, -depth, 0}, {width, depth, 0}, {-width, depth, 0}};
  CagCurve *sides[8];
  for (int i = 0; i < 4; i++) {
    const CagVec3 a = corners[i], b = corners[(i + 1) % 4], to = cag_unit(cag_sub(b, a));
    const CagVec3 ends[2] = {cag_madd(a, radius, to), cag_madd(b, -radius, to)};
    CagTransform frame = cag_translate(cag_madd(ends[1], radius, cag_vec3(-to.y, to.x, 0)));
    frame.planar = true;
    OK(cag_curve_polyline(ends, 2, false, 2, &sides[2 * i], &err));
    OK(cag_curve_arc(radius, radius, (i - 1) * M_PI / 2, i * M_PI / 2, &frame, &sides[2 * i + 1],
                     &err));
  }
  OK(cag_curve_join(sides, 8, &outline, &err));
  OK(cag_surface_extrude(outline, cag_vec3(0, 0, 3), 0, 1, &s, &err));
  for (int i = 0; i < 8; i++) cag_curve_release(sides[i]);
  cag_curve_release(outline);
  return s;
}

static void shapes_at_a_constant_distance_need_few_pairs(void **state) {
  (void)state;
  uint64_t random = 11;
  for (int i = 0; i < 12; i++) {
    const double r = between(&random, 1, 3), gap = between(&random, 0.1, 2);
    const double z = between(&random, 0, 0.5) * gap;
    CagSurface *spheres[2] = {quadric(CAG_SHAPE_ELLIPSOID, r, z, 0),
                              quadric(CAG_SHAPE_ELLIPSOID, r + gap, 0, 0)};
    NEAR(distance_by_few_pairs(spheres, 60, &random), gap - z, 1e-12);
    CagSurface *pipes[2] = {quadric(CAG_SHAPE_ELLIPTIC_CYLINDER, r, z, 4),
                            quadric(CAG_SHAPE_ELLIPTIC_CYLINDER, r + gap, 0, 5)};
    NEAR(distance_by_few_pairs(pipes, 60, &random), gap, 1e-12);
    CagSurface *ball_in_pipe[2] = {quadric(CAG_SHAPE_ELLIPSOID, r, 4, 0),
                                   quadric(CAG_SHAPE_ELLIPTIC_CYLINDER, r + gap, 0, 8)};
    NEAR(distance_by_few_pairs(ball_in_pipe, 60, &random), gap, 1e-12);
    CagSurface *walls[2] = {wall(3, 2, 0.5), wall(3 + gap, 2 + gap, 0.5 + gap)};
    // Beside the edges where flat and round parts meet there are more.
    NEAR(distance_by_few_pairs(walls, 500, &random), gap, 1e-12);
  }
}

// All points of a circle, and of a helix, are as far from the axis.
static void curves_at_a_constant_distance_need_few_pairs(void **state) {
  (void)state;
  const CagTransform flat = cag_transform_identity();
  const CagVec3 axis[2] = {{0, 0, -1}, {0, 0, 9}};
  CagCurve *inner, *outer, *line, *coil;
  CagParts a = {0}, b = {0}, c = {0}, d = {0};
  double distance = -1;
  OK(cag_curve_arc(2, 2, 0, 2 * M_PI, &flat, &inner, &err));
  OK(cag_curve_arc(5, 5, 0, 4, &flat, &outer, &err));
  OK(cag_curve_polyline(axis, 2, false, 3, &line, &err));
  OK(cag_curve_helix(3, 2, -4, 0, &coil, &err));
  OK(cag_parts_add_curve(&a, inner, 1e-3, &err));
  OK(cag_parts_add_curve(&b, outer, 1e-3, &err));
  OK(cag_parts_add_curve(&c, line, 1e-3, &err));
  OK(cag_parts_add_curve(&d, coil, 1e-3, &err));
  OK(cag_parts_distance(&a, &b, 60, &distance, NULL, NULL, &err));
  NEAR(distance, 3, 1e-14 * 8);
  OK(cag_parts_distance(&c, &d, 60, &distance, NULL, NULL, &err));
  NEAR(distance, 3, 1e-14 * 8);
  CagCurve *curves[] = {inner, outer, line, coil};
  CagParts *parts[] = {&a, &b, &c, &d};
  for (int i = 0; i < 4; i++) {
    cag_parts_free(parts[i]);
    cag_curve_release(curves[i]);
  }
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
      cmocka_unit_test(shapes_that_meet_need_few_pairs),
      cmocka_unit_test(a_function_that_fails_once_fails_the_search),
      cmocka_unit_test(shapes_at_a_constant_distance_need_few_pairs),
      cmocka_unit_test(curves_at_a_constant_distance_need_few_pairs),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
