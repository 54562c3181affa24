// Convex hulls, side predicates, curves on surfaces, and distances of meshes, compared with closed
// forms.

#include "geom/curve/function.h"
#include "geom/distance/separation.h"
#include "geom/mesh/exact.h"
#include "geom/mesh/hull.h"
#include "geom/mesh/predicates.h"
#include "geom/surface/curve_on.h"
#include "geom/surface/quadric.h"
#include "geom/tessellate/tessellate.h"
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
  // 0.5 + k 2^-53: exactly on the line x = y, or beside it by one unit in the last place.
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
  // Multiples of a tenth are collinear only up to rounding.
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
      if (kind == 1)                  // many are coplanar and collinear
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
  // With u = a t and v = b t, [(R + r cos v) cos u, (R + r cos v) sin u, r sin v] is a sum of
  // waves.
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

// A curve oscillates by 1e-4 above a line. The search must find the lowest of many nearly equal
// minima, compared with samples accurate to 1e-10. If there are too few pairs, the result is an
// error, never an uncertain distance.
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
  CagVec3 feet[2];
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
  OK(cag_parts_distance(&a, &b, CAG_PARTS_PAIRS, &distance, feet, NULL, &err));
  // The circles of both tori are at a constant distance.
  NEAR(distance, 5, 1e-12);
  NEAR(feet[1].z, 6, 1e-9);
  NEAR(hypot(feet[1].x, feet[1].y), 5, 1e-7);
  // The distance is the same all around, which few pairs cannot prove.
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

// --- Termination of the search ---

// If a curve crosses the other shape, all points of the intersection are equally close.
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
  int count, failing; // the call that fails, counted from 1; 0: none
} Calls;

static CagStatus fail_once(void *context, double t, int order, CagVec3 *out, CagError *e) {
  Calls *calls = context;
  if (++calls->count == calls->failing)
    return cag_fail(e, CAG_E_CALLBACK, CAG_ERR_function_failed, "", -1, "the function failed");
  for (int k = 0; k <= order; k++)
    out[k] = cag_vec3(k == 0 ? t : k == 1, cos(t + k * M_PI / 2), sin(t + k * M_PI / 2));
  return CAG_OK;
}

// Whichever call fails, later successes do not hide it.
static void a_function_that_fails_once_fails_the_search(void **state) {
  (void)state;
  Calls calls = {0};
  const CagCurveFunction f = {.eval = fail_once, .release = NULL, .context = &calls};
  CagCurve *coil;
  CagParts a = {0}, b = {0};
  double distance;
  OK(cag_curve_function(&f, 3, -6, 6, false, &coil, &err));
  OK(cag_parts_add_curve(&a, coil, 1e-3, &err));
  OK(cag_parts_add_point(&b, cag_vec3(0, 4, 0), &err));
  calls.count = 0;
  OK(cag_parts_distance(&a, &b, CAG_PARTS_PAIRS, &distance, NULL, NULL, &err));
  NEAR(distance, 3, 1e-12); // directly above the point at t = 0
  const int most = calls.count;
  assert_true(most > 0);
  for (int i = 1; i <= most; i++) {
    calls = (Calls){0, i};
    FAILS(cag_parts_distance(&a, &b, CAG_PARTS_PAIRS, &distance, NULL, NULL, &err),
          "function-failed");
    assert_int_equal(calls.count, i); // and no call follows
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

// Takes ownership of the surfaces. So few pairs suffice only if bounds prove that no other pair is
// closer.
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

// A rectangle with rounded corners, extruded upward.
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
    // Near the edges where flat and round parts meet, more pairs are needed.
    NEAR(distance_by_few_pairs(walls, 500, &random), gap, 1e-12);
  }
}

// All points of a circle, and of a helix, are equally far from the axis.
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

// Waves whose minima differ by less than the chords deviate from them. The first pairs that are
// tried are hardly ever the closest.
static void the_nearest_of_alike_minima_is_certain(void **state) {
  (void)state;
  enum { POINTS = 90, SAMPLES = 9000 };
  uint64_t random = 61;
  for (int trial = 0; trial < 24; trial++) {
    CagVec3 p[POINTS];
    double knots[POINTS + 4], least = INFINITY, distance;
    const double most = ldexp(1e-3, -(trial % 4));
    for (int i = 0; i < POINTS; i++)
      p[i] = cag_vec3(i, 1 + most * ((i % 2 ? 1 : 0) + 0.1 * random_number(&random)), 0);
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
    OK(cag_parts_add_curve(&a, wave, 1e-3, &err));
    OK(cag_parts_add_curve(&b, line, 1e-3, &err));
    if (trial % 2) OK(cag_parts_distance(&a, &b, CAG_PARTS_PAIRS, &distance, NULL, NULL, &err));
    else OK(cag_parts_distance(&b, &a, CAG_PARTS_PAIRS, &distance, NULL, NULL, &err));
    assert_true(distance <= least + 1e-9); // 1e-11 of the size
    // Between samples a hundredth apart, a wave of this height deviates by less.
    assert_true(distance >= least - 1e-3 * most);
    cag_parts_free(&a);
    cag_parts_free(&b);
    cag_curve_release(wave);
    cag_curve_release(line);
  }
}

// A spiral of half circles about two centers, and a parallel curve beside it.
static void spirals_of_arcs_need_few_pairs(void **state) {
  (void)state;
  enum { ARCS = 6 };
  for (int k = 0; k < 4; k++) {
    const double gap = 0.05 + 0.1 * k;
    CagCurve *arcs[ARCS], *spiral[2];
    CagParts parts[2] = {{0}, {0}};
    double distance = -1;
    for (int side = 0; side < 2; side++) {
      for (int i = 0; i < ARCS; i++) {
        const double r = 1 + 0.5 * i + side * gap;
        const CagTransform frame = cag_translate(cag_vec3(i % 2 ? 0.5 : 0, 0, 0));
        OK(cag_curve_arc(r, r, i * M_PI, (i + 1) * M_PI, &frame, &arcs[i], &err));
      }
      OK(cag_curve_join(arcs, ARCS, &spiral[side], &err));
      OK(cag_parts_add_curve(&parts[side], spiral[side], 1e-3, &err));
      for (int i = 0; i < ARCS; i++) cag_curve_release(arcs[i]);
    }
    OK(cag_parts_distance(&parts[k % 2], &parts[1 - k % 2], 60, &distance, NULL, NULL, &err));
    NEAR(distance, gap, 1e-13);
    for (int side = 0; side < 2; side++) {
      cag_parts_free(&parts[side]);
      cag_curve_release(spiral[side]);
    }
  }
}

// --- Flat triangles, segments and points ---

static CagVec3 random_location(uint64_t *state, double size) {
  double x[3];
  for (int i = 0; i < 3; i++) x[i] = between(state, -size, size);
  return cag_vec3(x[0], x[1], x[2]);
}

// The distance of p from the triangle: from its plane if the foot is inside, and from its edges
// otherwise.
static double from_triangle(CagVec3 p, const CagVec3 t[3]) {
  const CagVec3 n = cag_cross(cag_sub(t[1], t[0]), cag_sub(t[2], t[0]));
  double least = INFINITY;
  bool inside = cag_norm(n) > 0;
  for (int i = 0; i < 3; i++) {
    const CagVec3 a = t[i], way = cag_sub(t[(i + 1) % 3], a), to = cag_sub(p, a);
    const double length2 = cag_dot(way, way),
                 along = length2 > 0 ? fmin(1, fmax(0, cag_dot(to, way) / length2)) : 0;
    least = fmin(least, cag_norm(cag_madd(to, -along, way)));
    inside = inside && cag_dot(cag_cross(way, to), n) >= 0;
  }
  return inside ? fabs(cag_dot(cag_sub(p, t[0]), n)) / cag_norm(n) : least;
}

// Whether the segment from p to q passes through the triangle: solves p + x (q - p) = t0 + y u + z
// v by Cramer's rule.
static bool passes_through(CagVec3 p, CagVec3 q, const CagVec3 t[3]) {
  const CagVec3 u = cag_sub(t[1], t[0]), v = cag_sub(t[2], t[0]), way = cag_sub(p, q),
                to = cag_sub(p, t[0]);
  const double det = cag_dot(way, cag_cross(u, v));
  if (det == 0) return false;
  const double x = cag_dot(to, cag_cross(u, v)) / det, y = cag_dot(way, cag_cross(to, v)) / det,
               z = cag_dot(way, cag_cross(u, to)) / det;
  return x >= 0 && x <= 1 && y >= 0 && z >= 0 && y + z <= 1;
}

// Sets of triangles, or of segments or points as triangles with repeated corners. The computed
// distance is that of a pair of points: no corner or point of an edge is closer, the point of the
// second shape is on it, and the point of the first is at that distance.
static void flat_shapes_are_as_far_apart_as_their_nearest_points(void **state) {
  (void)state;
  enum { MOST = 12, STEPS = 16 };
  uint64_t seed = 51;
  int meetings = 0;
  for (int k = 0; k < 400; k++) {
    CagVec3 t[2][MOST][3];
    size_t n[2], line_count = 0;
    CagParts parts[2] = {{0}, {0}};
    CagCurve *lines[MOST];
    const CagVec3 away = random_location(&seed, k % 4 == 0 ? 0.5 : 3);
    for (int side = 0; side < 2; side++) {
      n[side] = 1 + (size_t)(k / (side ? 3 : 1)) % MOST;
      CagMesh *m;
      OK(cag_mesh_new(3 * n[side], n[side], false, false, false, &m, &err));
      for (uint32_t i = 0; i < n[side]; i++) {
        const CagVec3 middle = random_location(&seed, 2);
        for (uint32_t j = 0; j < 3; j++) {
          CagVec3 p = cag_add(middle, random_location(&seed, 1));
          if (k % 5 == 0) p.z = side ? 1 : 0; // parallel planes
          if (side) p = cag_add(p, away);
          if (k % 7 == 1 && side && j > 0) p = t[side][i][0]; // points
          if (k % 7 == 2 && j > 1) p = t[side][i][1];         // segments
          t[side][i][j] = p;
          m->positions[3 * i + j] = p;
          m->triangles[3 * i + j] = 3 * i + j;
        }
      }
      if (k % 7 == 1 && side)
        for (size_t i = 0; i < n[side]; i++) OK(cag_parts_add_point(&parts[1], t[1][i][0], &err));
      else if (k % 7 == 3 && side) // the second shape consists of the outlines of its triangles
        for (size_t i = 0; i < n[side]; i++) {
          OK(cag_curve_polyline(t[side][i], 3, true, 3, &lines[i], &err));
          OK(cag_parts_add_curve(&parts[side], lines[i], 0.1, &err));
          line_count = i + 1;
        }
      else OK(cag_parts_add_mesh(&parts[side], m, NULL, 0.1, &err));
      cag_mesh_release(m);
    }
    double least = INFINITY, out;
    bool meet = false;
    CagVec3 feet[2] = {{0, 0, 0}, {0, 0, 0}};
    // Each side of an outline becomes a triangle without area.
    CagVec3 sides[3 * MOST][3];
    const CagVec3(*shape[2])[3] = {(const CagVec3(*)[3])t[0], (const CagVec3(*)[3])t[1]};
    if (line_count > 0) {
      for (size_t i = 0; i < 3 * line_count; i++) {
        const CagVec3 *of = t[1][i / 3];
        sides[i][0] = of[i % 3], sides[i][1] = sides[i][2] = of[(i + 1) % 3];
      }
      shape[1] = (const CagVec3(*)[3])sides;
      n[1] *= 3;
    }
    for (int side = 0; side < 2; side++)
      for (size_t i = 0; i < n[side]; i++)
        for (int j = 0; j < 3; j++)
          for (size_t l = 0; l < n[1 - side]; l++) {
            const CagVec3 a = shape[side][i][j], b = shape[side][i][(j + 1) % 3];
            const CagVec3 *other = shape[1 - side][l];
            meet = meet || passes_through(a, b, other);
            for (int step = 0; step <= STEPS; step++)
              least = fmin(least, from_triangle(cag_lerp(a, b, (double)step / STEPS), other));
          }
    OK(cag_parts_distance(&parts[0], &parts[1], CAG_PARTS_PAIRS, &out, feet, NULL, &err));
    if (meet) {
      assert_true(out == 0);
      meetings++;
    } else {
      double on = INFINITY, back = INFINITY;
      for (size_t i = 0; i < n[1]; i++) on = fmin(on, from_triangle(feet[1], shape[1][i]));
      for (size_t i = 0; i < n[0]; i++) back = fmin(back, from_triangle(feet[1], shape[0][i]));
      assert_true(out <= least + 1e-12);
      assert_true(out >= least - 0.4); // the points of an edge are at most 0.25 apart
      NEAR(on, 0, 1e-7);
      NEAR(back, out, 1e-7);
    }
    for (int side = 0; side < 2; side++) cag_parts_free(&parts[side]);
    for (size_t i = 0; i < line_count; i++) cag_curve_release(lines[i]);
  }
  assert_true(meetings > 20);
  CagParts none = {0}, one = {0};
  double out;
  OK(cag_parts_add_point(&one, cag_vec3(1, 2, 3), &err));
  FAILS(cag_parts_distance(&none, &one, 9, &out, NULL, NULL, &err), "zero-area");
  FAILS(cag_parts_distance(&one, &none, 9, &out, NULL, NULL, &err), "zero-area");
  cag_parts_free(&one);
}

// Flat triangles and outlines against a sphere and a circle: the distance from the center minus the
// radius, and for the circle, the distance of its points.
static void flat_shapes_are_measured_from_round_ones(void **state) {
  (void)state;
  enum { MOST = 8, POINTS = 720 };
  uint64_t seed = 55;
  for (int k = 0; k < 120; k++) {
    const size_t n = 1 + (size_t)k % MOST;
    const double r = between(&seed, 0.3, 1.5);
    CagVec3 t[MOST][3];
    CagParts flat = {0}, round = {0};
    CagMesh *m;
    CagCurve *circle = NULL;
    CagSurface *sphere = NULL;
    CagTransform frame = cag_transform_identity();
    double least = INFINITY, out;
    CagVec3 feet[2];
    OK(cag_mesh_new(3 * n, n, false, false, false, &m, &err));
    for (uint32_t i = 0; i < n; i++) {
      const CagVec3 middle = random_location(&seed, 3);
      for (uint32_t j = 0; j < 3; j++) {
        m->positions[3 * i + j] = t[i][j] = cag_add(middle, random_location(&seed, 2));
        m->triangles[3 * i + j] = 3 * i + j;
      }
    }
    OK(cag_parts_add_mesh(&flat, m, NULL, 0.1, &err));
    cag_mesh_release(m);
    if (k % 2) {
      for (size_t i = 0; i < n; i++) least = fmin(least, from_triangle(cag_vec3(0, 0, 0), t[i]));
      sphere = quadric(CAG_SHAPE_ELLIPSOID, r, 0, 0);
      add_surface(&round, sphere);
      // Triangles that cross the sphere meet it. For triangles inside, the farthest corner counts.
      double farthest = 0;
      for (size_t i = 0; i < n; i++) {
        double corner = 0;
        for (int j = 0; j < 3; j++) corner = fmax(corner, cag_norm(t[i][j]));
        farthest = fmax(farthest, corner);
      }
      least = fmax(0, fmax(least - r, r - farthest));
    } else {
      OK(cag_curve_arc(r, r, 0, 2 * M_PI, &frame, &circle, &err));
      OK(cag_parts_add_curve(&round, circle, 1e-3, &err));
      for (int i = 0; i < POINTS; i++) {
        const CagVec3 p = {r * cos(2 * M_PI * i / POINTS), r * sin(2 * M_PI * i / POINTS), 0};
        for (size_t j = 0; j < n; j++) least = fmin(least, from_triangle(p, t[j]));
      }
    }
    OK(cag_parts_distance(&round, &flat, CAG_PARTS_PAIRS, &out, feet, NULL, &err));
    if (k % 2) NEAR(out, least, 1e-8);
    else {
      assert_true(out <= least + 1e-9);
      assert_true(out >= least - r * M_PI / POINTS - 1e-9);
    }
    double on = INFINITY;
    for (size_t i = 0; i < n && out > 0; i++) on = fmin(on, from_triangle(feet[1], t[i]));
    if (out > 0) NEAR(on, 0, 1e-7);
    OK(cag_parts_distance(&flat, &round, CAG_PARTS_PAIRS, &out, feet, NULL, &err));
    if (k % 2) NEAR(out, least, 1e-8);
    else assert_true(out <= least + 1e-9);
    cag_parts_free(&flat);
    cag_parts_free(&round);
    cag_curve_release(circle);
    cag_surface_release(sphere);
  }
}

// Circles and segments in the plane, and spheres inside and beside spheres, compared with closed
// forms.
static void round_shapes_have_their_closed_forms(void **state) {
  (void)state;
  uint64_t seed = 52;
  for (int k = 0; k < 60; k++) {
    const double r = between(&seed, 0.5, 2), s = between(&seed, 0.5, 2),
                 apart = between(&seed, 0, 5);
    CagTransform frame = cag_transform_identity();
    CagCurve *a, *b;
    CagParts parts[2] = {{0}, {0}};
    double out;
    OK(cag_curve_arc(r, r, 0, 2 * M_PI, &frame, &a, &err));
    frame.m[0][3] = apart;
    OK(cag_curve_arc(s, s, 0, 2 * M_PI, &frame, &b, &err));
    OK(cag_parts_add_curve(&parts[0], a, 1e-3, &err));
    OK(cag_parts_add_curve(&parts[1], b, 1e-3, &err));
    OK(cag_parts_distance(&parts[0], &parts[1], CAG_PARTS_PAIRS, &out, NULL, NULL, &err));
    NEAR(out, fmax(0, fmax(apart - r - s, fabs(r - s) - apart)), 1e-9);
    cag_parts_free(&parts[1]);
    cag_curve_release(b);
    // A segment beside the circle: the closest point is an end or an inner point.
    const CagVec3 ends[2] = {{r + 0.3, -apart, 0}, {r + 0.3, k % 2 ? apart + 1 : -apart / 2, 0}};
    parts[1] = (CagParts){0};
    OK(cag_curve_polyline(ends, 2, false, 2, &b, &err));
    OK(cag_parts_add_curve(&parts[1], b, 1e-3, &err));
    OK(cag_parts_distance(&parts[0], &parts[1], CAG_PARTS_PAIRS, &out, NULL, NULL, &err));
    NEAR(out, k % 2 ? 0.3 : hypot(r + 0.3, apart / 2) - r, 1e-9);
    for (int side = 0; side < 2; side++) cag_parts_free(&parts[side]);
    cag_curve_release(a);
    cag_curve_release(b);
  }
}

// --- Exact arithmetic ---

static CagExact number(CagExactSpace *s, uint64_t *state) {
  const double x = between(state, -1, 1);
  return cag_exact(s, ldexp(x, (int)between(state, -200, 200)));
}

static void exact_numbers_obey_the_laws_of_arithmetic(void **state) {
  (void)state;
  uint64_t seed = 53, limbs[8192];
  for (int k = 0; k < 3000; k++) {
    CagExactSpace s = {limbs, 0, 8192, false};
    CagExact a = number(&s, &seed), b = number(&s, &seed), c = number(&s, &seed),
             d = number(&s, &seed);
    if (k % 5 == 0) b = cag_exact_negative(a);
    if (k % 7 == 0) c = cag_exact(&s, 0);
    // (a + b) (c + d) = a c + b d + a d + b c, in any order; a d - b c.
    const CagExact left = cag_exact_product(&s, cag_exact_sum(&s, a, b), cag_exact_sum(&s, d, c));
    const CagExact ac = cag_exact_product(&s, a, c), bd = cag_exact_product(&s, d, b),
                   ad = cag_exact_product(&s, a, d), bc = cag_exact_product(&s, c, b);
    const CagExact right = cag_exact_sum(&s, cag_exact_sum(&s, ac, bd), cag_exact_sum(&s, bc, ad));
    assert_int_equal(cag_exact_difference(&s, left, right).sign, 0);
    assert_int_equal(left.sign, right.sign);
    const CagExact minor = cag_exact_minor(&s, a, b, c, d);
    assert_int_equal(cag_exact_difference(&s, cag_exact_sum(&s, minor, bc), ad).sign, 0);
    // A unit of 2^-700 decides the sign.
    const CagExact unit = cag_exact(&s, ldexp(k % 2 ? 1 : -1, -700));
    const CagExact more = cag_exact_sum(&s, left, unit);
    assert_int_equal(cag_exact_difference(&s, more, right).sign, k % 2 ? 1 : -1);
    assert_false(s.full);
  }
  // Differences of adjacent doubles, and their signs.
  for (int k = 0; k < 2000; k++) {
    CagExactSpace s = {limbs, 0, 8192, false};
    const double x = between(&seed, -2, 2), y = k % 3 ? between(&seed, -2, 2) : nextafter(x, 3);
    assert_int_equal(cag_exact_step(&s, x, y).sign, (x > y) - (x < y));
    assert_int_equal(cag_exact_step(&s, x, x).sign, 0);
    assert_int_equal(cag_exact(&s, x).sign, x < 0 ? -1 : 1);
  }
}

// The double closest to a quotient is within half a unit, compared exactly.
static void quotients_are_rounded_once(void **state) {
  (void)state;
  uint64_t seed = 54, limbs[8192];
  for (int k = 0; k < 3000; k++) {
    CagExactSpace s = {limbs, 0, 8192, false};
    CagExact x = number(&s, &seed), w = number(&s, &seed);
    if (w.sign < 0) w = cag_exact_negative(w);
    if (w.sign == 0) continue;
    const double q = between(&seed, -1, 1);
    double half = 0;
    if (k % 2) { // a quotient that is a double, or halfway between two
      const double next = nextafter(q, 2);
      const int kind = k / 2 % 4;
      half = (next - q) / 2;
      CagExact wanted = cag_exact(&s, q);
      if (kind > 0) wanted = cag_exact_sum(&s, wanted, cag_exact(&s, half));
      if (kind > 1)
        wanted = cag_exact_sum(&s, wanted, cag_exact(&s, ldexp(kind == 2 ? 1 : -1, -120)));
      x = cag_exact_product(&s, wanted, w);
      const double got = cag_exact_quotient(&s, x, w);
      // In a tie, the lower one.
      assert_true(got == (kind == 2 ? next : q));
      continue;
    }
    const double got = cag_exact_quotient(&s, x, w);
    const CagExact rest = cag_exact_difference(&s, x, cag_exact_product(&s, cag_exact(&s, got), w));
    for (int way = -1; way <= 1; way += 2) {
      const double other = nextafter(got, way * INFINITY);
      const CagExact theirs =
          cag_exact_difference(&s, x, cag_exact_product(&s, cag_exact(&s, other), w));
      const CagExact mine_size = rest.sign < 0 ? cag_exact_negative(rest) : rest,
                     their_size = theirs.sign < 0 ? cag_exact_negative(theirs) : theirs;
      assert_true(cag_exact_difference(&s, mine_size, their_size).sign <= 0);
    }
    assert_true(x.sign == (got > 0) - (got < 0));
  }
  CagExactSpace s = {limbs, 0, 8192, false};
  const CagExact one = cag_exact(&s, 1), tiny = cag_exact(&s, 0x1p-961),
                 least = cag_exact(&s, 0x1p-960);
  assert_true(cag_exact_quotient(&s, cag_exact(&s, 0), one) == 0);
  assert_true(cag_exact_quotient(&s, tiny, one) == 0);
  assert_true(cag_exact_quotient(&s, least, one) == 0x1p-960);
  assert_true(cag_exact_quotient(&s, cag_exact_negative(least), one) == -0x1p-960);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sides_are_exact),
      cmocka_unit_test(the_nearest_of_alike_minima_is_certain),
      cmocka_unit_test(spirals_of_arcs_need_few_pairs),
      cmocka_unit_test(flat_shapes_are_as_far_apart_as_their_nearest_points),
      cmocka_unit_test(flat_shapes_are_measured_from_round_ones),
      cmocka_unit_test(round_shapes_have_their_closed_forms),
      cmocka_unit_test(exact_numbers_obey_the_laws_of_arithmetic),
      cmocka_unit_test(quotients_are_rounded_once),
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
