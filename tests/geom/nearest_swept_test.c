// Closest points of tubes, sweeps, and extrusions: closed forms, and random surfaces compared with
// a dense search. Also the ranges of derivatives that the search depends on.

#include "nearest_support.h"

#include "geom/curve/family.h"
#include "geom/curve/range.h"
#include "geom/surface/motion_parts.h"
#include "geom/surface/nearest.h"
#include "geom/surface/swept.h"

static const CagTransform *in_space(void) {
  static CagTransform frame;
  frame = cag_transform_identity();
  frame.planar = false;
  return &frame;
}

// --- Ranges ---

static bool holds(CagInterval range, double x, double slack) {
  return x >= range.lo - slack && x <= range.hi + slack;
}

static void assert_held(const CagInterval3 *range, CagVec3 p, const char *what) {
  const double slack = 1e-12 * (1 + cag_norm(p));
  if (!holds(range->x, p.x, slack) || !holds(range->y, p.y, slack) || !holds(range->z, p.z, slack))
    fail_msg("%s: [%.17g %.17g %.17g] is not in %g..%g, %g..%g, %g..%g", what, p.x, p.y, p.z,
             range->x.lo, range->x.hi, range->y.lo, range->y.hi, range->z.lo, range->z.hi);
}

enum { LINE, ARC, COIL, SPLINE, RATIONAL, OVAL, JOINED, SPINES };

static CagCurve *spline(bool rational) {
  CagVec3 p[8];
  double knots[12], weights[8];
  CagCurve *c;
  for (int i = 0; i < 8; i++) {
    const double x = between(0, 8), y = between(0, 8);
    p[i] = cag_vec3(x, y, 3 * i);
    weights[i] = between(0.3, 2.5);
  }
  for (int i = 0; i < 12; i++) knots[i] = i < 4 ? 0 : i > 7 ? 5 : i - 3;
  MUST(cag_curve_nurbs(p, rational ? weights : NULL, 8, 3, knots, 3, &c, err));
  return c;
}

static CagCurve *spine(int kind) {
  const CagVec3 ends[2] = {{0, 0, 0}, {between(1, 4), between(1, 4), between(4, 9)}};
  CagCurve *c = NULL, *parts[2];
  switch (kind) {
  case LINE: MUST(cag_curve_polyline(ends, 2, false, 3, &c, err)); break;
  case ARC: MUST(cag_curve_arc(5, 5, 0, between(1, 6), in_space(), &c, err)); break;
  case COIL: MUST(cag_curve_helix(4, between(1, 4), between(1, 2), 0.2, &c, err)); break;
  case SPLINE: c = spline(false); break;
  case RATIONAL: c = spline(true); break;
  case OVAL: MUST(cag_curve_arc(5, 3, 0, 2 * M_PI, in_space(), &c, err)); break;
  default: { // a straight part and a quarter circle, which meet at a corner
    const CagVec3 side[2] = {{2, -4, 1}, {5, 0, 0}};
    MUST(cag_curve_polyline(side, 2, false, 3, &parts[0], err));
    MUST(cag_curve_arc(5, 5, 0, M_PI / 2, in_space(), &parts[1], err));
    MUST(cag_curve_join(parts, 2, &c, err));
    cag_curve_release(parts[0]);
    cag_curve_release(parts[1]);
  }
  }
  return c;
}

// A part of a piece that is short enough for all ranges to exist.
static void short_part(const double *ends, double part[2]) {
  const double length = (ends[1] - ends[0]) * between(0, 0.05);
  part[0] = ends[0] + between(0, 1) * (ends[1] - ends[0] - length);
  part[1] = part[0] + length;
}

static void ranges_hold_the_derivatives_of_curves(void **state) {
  (void)state;
  enum { ORDER = 4 };
  state_of_random = 21;
  for (int i = 0; i < 40 * SPINES; i++) {
    CagCurve *c = spine(i % SPINES);
    double *cuts, part[2], factorial = 1;
    size_t n;
    CagInterval3 ranges[ORDER + 1];
    CagVec3 d[ORDER + 1];
    MUST(cag_curve_cuts(c, &cuts, &n, err));
    short_part(cuts + whole(0, (int)n - 2), part);
    assert_true(cag_curve_ranges(c, part[0], part[1], ORDER, ranges));
    for (int probe = 0; probe < 8; probe++) {
      MUST(cag_curve_eval(c, between(part[0], part[1]), ORDER, CAG_SIDE_RIGHT, d, err));
      for (int k = 0; k <= ORDER; k++) {
        factorial = k ? factorial * k : 1;
        assert_held(&ranges[k], cag_scaled(d[k], 1 / factorial), "derivative");
      }
    }
    free(cuts);
    cag_curve_release(c);
  }
}

static CagMotion *random_motion(int kind, int orient) {
  static const CagOrient orients[] = {CAG_ORIENT_RMF, CAG_ORIENT_FIXED, CAG_ORIENT_UP,
                                      CAG_ORIENT_FRENET};
  CagPathMotion how = {.orient = orients[orient],
                       .up = {0.1, 0.3, 1},
                       .twist = {0, between(-2, 2), NULL},
                       .scale = {1, between(0.5, 1.5), NULL}};
  CagCurve *path = spine(kind);
  CagMotion *m = NULL;
  CagError refused; // there may be no frame along the path
  if (cag_motion_along(path, &how, &m, &refused)) m = NULL;
  cag_curve_release(path);
  return m;
}

// Returns the number of compared points: 0 if the ranges are unknown.
static int assert_motion_held(const CagMotion *m) {
  enum { ORDER = 3 };
  double *joints, part[2];
  size_t n;
  CagMotionRanges ranges;
  CagMotionSeries at;
  int held = 0;
  MUST(cag_motion_joints(m, &joints, &n, err));
  short_part(joints + whole(0, (int)n - 1), part);
  const bool known = cag_motion_ranges(m, part[0], part[1], ORDER, &ranges);
  for (int probe = 0; known && probe < 8; probe++, held++) {
    MUST(cag_motion_at(m, between(part[0], part[1]), ORDER, CAG_SIDE_RIGHT, &at, err));
    for (int k = 0; k <= ORDER; k++) {
      assert_held(&ranges.origin[k], at.origin[k], "origin");
      assert_held(&ranges.x[k], at.x[k], "x");
      assert_held(&ranges.y[k], at.y[k], "y");
      assert_held(&ranges.z[k], at.z[k], "z");
    }
  }
  free(joints);
  return held;
}

static void ranges_hold_the_derivatives_of_motions(void **state) {
  (void)state;
  state_of_random = 22;
  int held = 0;
  for (int i = 0; i < 40 * SPINES; i++) {
    CagMotion *m = random_motion(i % SPINES, i / SPINES % 4);
    if (m) held += assert_motion_held(m);
    cag_motion_release(m);
  }
  assert_true(held > 1500);
}

// A wave with a kink at 2.
static CagStatus wave(void *context, double t, double *out, CagError *err) {
  (void)context, (void)err;
  out[0] = 1 + 0.3 * sin(2 * t) + 0.2 * fabs(t - 2);
  return CAG_OK;
}

// A rotation about the z axis that shrinks and translates.
static CagStatus spiral(void *context, double t, double *out, CagError *err) {
  (void)context, (void)err;
  const double size = exp(-t / 5), c = size * cos(t), s = size * sin(t);
  const double rows[12] = {c, -s, 0, t * t / 4, s, c, 0, cos(3 * t), 0, 0, size, t};
  memcpy(out, rows, sizeof rows);
  return CAG_OK;
}

static CagMotion *motion_by_function(int kind) {
  CagChebyshev *f;
  CagMotion *m;
  if (kind == 0) {
    MUST(cag_chebyshev_fit(spiral, NULL, 0, 5, 12, 1e-13, "motion", &f, err));
    MUST(cag_motion_affine(f, 0, 5, false, &m, err));
  } else {
    CagCurve *path = spline(false);
    MUST(cag_chebyshev_fit(wave, NULL, 0, 5, 1, 1e-13, "scale", &f, err));
    const CagPathMotion how = {.orient = CAG_ORIENT_RMF,
                               .twist = {0, 0, kind == 1 ? f : NULL},
                               .scale = {1, 1, kind == 1 ? NULL : f}};
    MUST(cag_motion_along(path, &how, &m, err));
    cag_curve_release(path);
  }
  cag_chebyshev_release(f);
  return m;
}

static void ranges_hold_the_derivatives_of_motions_by_functions(void **state) {
  (void)state;
  state_of_random = 23;
  for (int kind = 0; kind < 3; kind++) {
    int held = 0;
    CagMotion *m = motion_by_function(kind);
    for (int i = 0; i < 30; i++) held += assert_motion_held(m);
    cag_motion_release(m);
    assert_true(held > 100);
  }
}

// --- Closed forms ---

// Inside a tube around a helix, closer than its reach, the distance is the radius minus the
// distance from the helix. The test creates points at known distances, and also translates, scales,
// and reflects the tube.
static void points_inside_tubes_have_closed_forms(void **state) {
  (void)state;
  state_of_random = 31;
  for (int i = 0; i < 60; i++) {
    const double radius = between(0.3, 0.9), off = between(0, 0.95) * radius;
    const double size = between(0.5, 2), angle = between(0, 6);
    CagTransform move = *in_space(), turn;
    CagCurve *coil;
    CagSurface *s, *moved;
    CagSurfaceNearest found;
    CagVec3 d[2];
    MUST(cag_curve_helix(4, 3, i % 2 ? 2 : -2, 0, &coil, err));
    MUST(cag_surface_tube(coil, radius, &s, err));
    MUST(cag_curve_eval(coil, between(1, 11), 1, CAG_SIDE_RIGHT, d, err));
    const CagVec3 x = cag_unit(cag_cross(d[1], cag_vec3(0, 0, 1)));
    const CagVec3 y = cag_unit(cag_cross(d[1], x));
    const CagVec3 p = cag_madd(cag_madd(d[0], off * cos(angle), x), off * sin(angle), y);
    MUST(cag_surface_closest(s, p, &found, err));
    assert_near(found.distance, radius - off, 1e-12, "distance");
    for (int k = 0; k < 3; k++) move.m[k][k] = k == 1 && i % 3 == 0 ? -size : size;
    MUST(cag_rotate(cag_vec3(1, 2, 2), angle, cag_vec3(3, 0, 0), &turn, err));
    move = cag_transform_multiply(&turn, &move);
    MUST(cag_surface_transform(s, &move, &moved, err));
    MUST(cag_surface_closest(moved, cag_transform_point(&move, p), &found, err));
    assert_near(found.distance, size * (radius - off), 1e-12, "distance of the moved one");
    assert_point(surface_at(moved, found.u, found.v), found.point, 1e-12, "place");
    cag_surface_release(moved);
    // A stretched surface is not at a constant distance from its center line.
    CagTransform stretch = *in_space();
    stretch.m[i % 3][i % 3] = between(1.5, 2.5);
    const CagVec3 q = cag_transform_point(&stretch, p);
    MUST(cag_surface_transform(s, &stretch, &moved, err));
    MUST(cag_surface_closest(moved, q, &found, err));
    if (i < 12) assert_true(found.distance <= dense_distance(moved, q, 12, 40) + 1e-9);
    assert_point(surface_at(moved, found.u, found.v), found.point, 1e-12, "place");
    cag_surface_release(moved);
    cag_surface_release(s);
    cag_curve_release(coil);
  }
}

// --- Random surfaces ---

static CagCurve *section(int kind) {
  const CagVec3 corners[4] = {{-1, -0.6, 0}, {1, -0.6, 0}, {1, 0.6, 0}, {-1, 0.6, 0}};
  const double knots[10] = {0, 0, 0, 0, 1, 2, 3, 3, 3, 3};
  CagTransform frame = cag_transform_identity();
  CagVec3 p[6];
  CagCurve *c;
  for (int i = 0; i < 6; i++) p[i] = cag_vec3(between(-1, 1), between(-1, 1), 0);
  frame.m[0][3] = kind == 1 ? 0.3 : 0;
  switch (kind) {
  case 0: MUST(cag_curve_polyline(corners, 4, true, 2, &c, err)); break;
  case 1:
  case 2: MUST(cag_curve_arc(0.9, kind == 1 ? 0.9 : 0.4, 0, 2 * M_PI, &frame, &c, err)); break;
  default: MUST(cag_curve_nurbs(p, NULL, 6, 3, knots, 2, &c, err));
  }
  return c;
}

static CagSurface *random_tube(int kind) {
  const CagAlong radius = {between(0.2, 1), between(0.2, 1), NULL};
  CagCurve *path = spine(kind);
  CagSurface *s;
  if (kind % 2) MUST(cag_surface_tube_along(path, &radius, &s, err));
  else MUST(cag_surface_tube(path, radius.start, &s, err));
  cag_curve_release(path);
  return s;
}

// Returns NULL if there is no such frame along the path.
static CagSurface *random_sweep(int i) {
  CagMotion *m = random_motion(i % SPINES, i / SPINES % 4);
  CagSurface *s;
  if (!m) return NULL;
  CagCurve *c = section(whole(0, 3));
  MUST(cag_surface_sweep(c, m, &s, err));
  cag_curve_release(c);
  cag_motion_release(m);
  return s;
}

// Rotated and scaled about the z axis, next to which the section is.
static CagSurface *random_extrusion(void) {
  CagTransform aside = cag_translate(cag_vec3(between(-2, 2), between(-2, 2), 0));
  CagCurve *c = section(whole(0, 3)), *moved;
  CagSurface *s;
  aside.planar = true;
  MUST(cag_curve_transform(c, &aside, &moved, err));
  MUST(cag_surface_extrude(moved, cag_vec3(between(-1, 1), 0, 3), between(-7, 7), between(0.3, 1.5),
                           &s, err));
  cag_curve_release(moved);
  cag_curve_release(c);
  return s;
}

// Beside the surface, or well inside its box.
static CagVec3 near_or_far(const CagSurface *s, int i) {
  if (i % 3 == 0) return beside(s);
  const CagVec3 a = surface_at(s, between(s->u0, s->u1), between(s->v0, s->v1));
  const CagVec3 b = surface_at(s, between(s->u0, s->u1), between(s->v0, s->v1));
  return cag_lerp(a, b, i % 3 == 1 ? 0.1 : 0.3);
}

static void assert_nearest(const CagSurface *s, const char *what, int i) {
  CagSurfaceNearest found;
  const CagVec3 p = near_or_far(s, i);
  MUST(cag_surface_closest(s, p, &found, err));
  assert_point(surface_at(s, found.u, found.v), found.point, 1e-12, what);
  assert_near(cag_norm(cag_sub(found.point, p)), found.distance, 1e-12, what);
  const double dense = dense_distance(s, p, 32, 128);
  if (found.distance > dense + 1e-9)
    fail_msg("%s %d: found %.17g, but %.17g is nearer", what, i, found.distance, dense);
}

static void nearest_points_of_random_swept_surfaces_are_right(void **state) {
  (void)state;
  state_of_random = 41;
  CagTransform oblique = *in_space();
  oblique.m[0][1] = 0.5;
  oblique.m[1][1] = -1.5; // reflects
  for (int i = 0; i < 12 * SPINES; i++) {
    static const char *const names[] = {"tube", "sweep", "extrusion"};
    CagSurface *kinds[] = {random_tube(i % SPINES), random_sweep(i), random_extrusion()}, *moved;
    for (int k = 0; k < 3; k++) {
      if (!kinds[k]) continue;
      assert_nearest(kinds[k], names[k], i);
      MUST(cag_surface_transform(kinds[k], &oblique, &moved, err));
      if (i % 4 == 0) assert_nearest(moved, names[k], i);
      cag_surface_release(moved);
      cag_surface_release(kinds[k]);
    }
  }
}

static void nearest_points_of_sweeps_by_functions_are_right(void **state) {
  (void)state;
  state_of_random = 42;
  for (int i = 0; i < 9; i++) {
    CagMotion *m = motion_by_function(i % 3);
    CagCurve *c = section(i / 3);
    CagSurface *s;
    MUST(cag_surface_sweep(c, m, &s, err));
    assert_nearest(s, "sweep by a function", i);
    cag_surface_release(s);
    cag_curve_release(c);
    cag_motion_release(m);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(ranges_hold_the_derivatives_of_curves),
      cmocka_unit_test(ranges_hold_the_derivatives_of_motions),
      cmocka_unit_test(ranges_hold_the_derivatives_of_motions_by_functions),
      cmocka_unit_test(points_inside_tubes_have_closed_forms),
      cmocka_unit_test(nearest_points_of_random_swept_surfaces_are_right),
      cmocka_unit_test(nearest_points_of_sweeps_by_functions_are_right),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
