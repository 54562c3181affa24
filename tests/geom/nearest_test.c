// Closest points of surfaces and curves: random shapes compared with a dense search, and closed
// forms.

#include "nearest_support.h"

#include "geom/surface/nearest.h"
#include "geom/surface/quadric.h"
#include "geom/surface/reshape.h"
#include "geom/surface/trimmed.h"

// Checks that the point is on the surface at the reported parameters, and that the dense search
// finds no closer one.
static void assert_nearest(const CagSurface *s, const char *what, int turn) {
  CagSurfaceNearest found;
  const CagVec3 p = beside(s);
  MUST(cag_surface_closest(s, p, &found, err));
  assert_point(surface_at(s, found.u, found.v), found.point, 1e-12, what);
  assert_near(cag_norm(cag_sub(found.point, p)), found.distance, 1e-12, what);
  const double dense = dense_distance(s, p, 16, 16);
  if (found.distance > dense + 1e-9)
    fail_msg("%s %d: found %.17g, but %.17g is nearer", what, turn, found.distance, dense);
}

// --- Random surfaces ---

static CagSurface *random_net(bool bilinear, bool rational, bool creased) {
  const int p = bilinear ? 1 : whole(1, 3), q = bilinear ? 1 : whole(1, 3);
  const int nu = p + 1 + whole(0, 3), nv = q + 1 + whole(0, 3);
  CagVec3 net[49];
  double weights[49], ku[16], kv[16];
  CagSurface *s;
  for (int k = 0; k < nu * nv; k++) {
    const CagVec3 jitter = anywhere(3);
    net[k] = cag_add(cag_vec3(2 * (k / nv), 2 * (k % nv), 0), jitter);
    weights[k] = between(0.3, 3.3);
  }
  // All inner knots coincide: creases of every kind, if there are enough knots.
  for (int i = 0; i < nu + p + 1; i++)
    ku[i] = i <= p ? 0 : i >= nu ? 1 : creased ? 0.4 : (double)(i - p) / (nu - p);
  for (int i = 0; i < nv + q + 1; i++) kv[i] = i <= q ? 0 : i >= nv ? nv - q : i - q;
  if (creased && nu - p - 1 > p) return NULL;
  MUST(cag_surface_nurbs(net, rational ? weights : NULL, (size_t)nu, (size_t)nv, p, q, ku, kv, &s,
                         err));
  return s;
}

static void nearest_points_of_creased_surfaces_are_right(void **state) {
  (void)state;
  state_of_random = 20240601;
  for (int i = 0; i < 1200; i++) {
    CagSurface *s = random_net(true, i % 2, false);
    assert_nearest(s, "creased surface", i);
    cag_surface_release(s);
  }
}

static void nearest_points_of_tensor_surfaces_are_right(void **state) {
  (void)state;
  state_of_random = 77;
  for (int i = 0; i < 200; i++) {
    CagSurface *s = random_net(false, i % 2, i % 4 < 2);
    if (!s) continue;
    assert_nearest(s, "tensor surface", i);
    cag_surface_release(s);
  }
}

// A long winding strip of one patch along v, or along u if turned. The bounds of its distance
// depend on both degrees, and there are many local minima.
static CagSurface *random_strip(bool turned, bool rational) {
  enum { LONG = 10 };
  const int p = whole(1, 2), q = whole(4, LONG - 1);
  CagVec3 net[3 * LONG];
  double weights[3 * LONG], ku[2 * LONG], kv[2 * LONG];
  CagSurface *s;
  for (int i = 0; i <= p; i++)
    for (int j = 0; j <= q; j++) {
      const int at = turned ? j * (p + 1) + i : i * (q + 1) + j;
      net[at] = cag_vec3(j, 8 * i + between(0, 2), between(-9, 9));
      weights[at] = between(0.3, 3.3);
    }
  for (int i = 0; i < 2 * (p + 1); i++) ku[i] = i > p;
  for (int j = 0; j < 2 * (q + 1); j++) kv[j] = j > q;
  MUST(cag_surface_nurbs(net, rational ? weights : NULL, (size_t)(turned ? q : p) + 1,
                         (size_t)(turned ? p : q) + 1, turned ? q : p, turned ? p : q,
                         turned ? kv : ku, turned ? ku : kv, &s, err));
  return s;
}

static void nearest_points_of_winding_strips_are_right(void **state) {
  (void)state;
  state_of_random = 4711;
  for (int i = 0; i < 300; i++) {
    CagSurface *s = random_strip(i % 2, i % 4 < 2);
    assert_nearest(s, "strip", i);
    cag_surface_release(s);
  }
}

static CagSurface *random_revolution(void) {
  CagVec3 p[5];
  CagCurve *profile;
  CagSurface *s;
  for (int i = 0; i < 5; i++) p[i] = cag_vec3(between(1, 5), 0, between(1.5 * i, 1.5 * i + 1));
  MUST(cag_curve_polyline(p, 5, false, 3, &profile, err));
  MUST(cag_surface_revolve(profile, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0, between(1, 6.28), &s,
                           err));
  cag_curve_release(profile);
  return s;
}

static CagSurface *random_ellipsoid(void) {
  CagTransform frame = cag_transform_identity();
  CagSurface *s;
  for (int k = 0; k < 9; k++) frame.m[k / 3][k % 3] = between(-2, 2);
  MUST(cag_surface_quadric(CAG_SHAPE_ELLIPSOID, &frame, 0, 2 * M_PI, 0, M_PI, &s, err));
  return s;
}

// Without an exact form.
static CagSurface *random_twist(void) {
  CagVec3 p[5];
  CagCurve *section;
  CagSurface *s;
  for (int i = 0; i < 5; i++) p[i] = cag_vec3(between(0, 8), between(0, 8), 0);
  MUST(cag_curve_polyline(p, 5, false, 2, &section, err));
  MUST(cag_surface_extrude(section, cag_vec3(0, 0, 3), between(0, 2), between(0.5, 1.5), &s, err));
  cag_curve_release(section);
  return s;
}

static CagSurface *random_tube(void) {
  CagVec3 p[5];
  CagCurve *path;
  CagSurface *s;
  for (int i = 0; i < 5; i++) p[i] = cag_vec3(between(0, 8), between(0, 8), 2 * i);
  MUST(cag_curve_bezier(p, NULL, 5, 3, &path, err));
  MUST(cag_surface_tube(path, between(0.2, 1), &s, err));
  cag_curve_release(path);
  return s;
}

static void nearest_points_of_other_kinds_are_right(void **state) {
  (void)state;
  static CagSurface *(*const make[])(void) = {random_revolution, random_ellipsoid, random_twist,
                                              random_tube};
  static const char *const name[] = {"revolution", "ellipsoid", "twist", "tube"};
  state_of_random = 4711;
  for (int i = 0; i < 100; i++) {
    CagSurface *s = make[i % 4]();
    assert_nearest(s, name[i % 4], i);
    cag_surface_release(s);
  }
}

// The distance from a torus is that of two circles.
static void nearest_points_of_a_torus_have_closed_form(void **state) {
  (void)state;
  state_of_random = 5;
  for (int i = 0; i < 300; i++) {
    const double major = between(2, 5), minor = between(0.5, 3);
    CagSurface *s;
    CagSurfaceNearest found;
    MUST(cag_surface_torus(major, minor, &s, err));
    // Every tenth point is on the axis, and every tenth on the center circle: rings of closest
    // points.
    CagVec3 p = anywhere(8);
    if (i % 10 == 0) p = cag_vec3(0, 0, p.z);
    if (i % 10 == 5) p = cag_vec3(0, major, 0);
    MUST(cag_surface_closest(s, p, &found, err));
    const double rho = hypot(p.x, p.y);
    const double near = fabs(hypot(rho - major, p.z) - minor);
    const double far = fabs(hypot(rho + major, p.z) - minor); // of a spindle
    assert_near(found.distance, fmin(near, far), 1e-13, "distance");
    cag_surface_release(s);
  }
}

// For a point outside, the distance to a tube or an offset is that to its center line or base
// surface, minus its radius or offset. Moved tubes around circles and helices, and moved offsets of
// spheres and tori.
static void tubes_and_offsets_have_closed_forms(void **state) {
  (void)state;
  state_of_random = 77;
  for (int i = 0; i < 200; i++) {
    const double major = between(3, 5), minor = between(0.5, 1), d = between(0.1, 0.4);
    const CagTransform flat = cag_transform_identity();
    CagTransform move = cag_translate(anywhere(3)), turn;
    CagSurface *s, *moved;
    CagCurve *circle;
    CagSurfaceNearest found;
    MUST(cag_rotate(cag_vec3(1, 2, 2), between(0, 3), cag_vec3(0, 0, 0), &turn, err));
    move = cag_transform_multiply(&move, &turn);
    move.planar = false;
    CagVec3 p = anywhere(12);
    const double ring = hypot(hypot(p.x, p.y) - major, p.z);
    double expected = ring - minor;
    if (i % 2 == 0) {
      MUST(cag_curve_arc(major, major, 0, 2 * M_PI, &flat, &circle, err));
      MUST(cag_surface_tube(circle, minor, &s, err));
      cag_curve_release(circle);
    } else {
      CagSurface *torus;
      MUST(cag_surface_torus(major, minor, &torus, err));
      MUST(cag_surface_offset(torus, d, &s, err));
      cag_surface_release(torus);
      expected -= d;
    }
    if (expected > 0.01) {
      MUST(cag_surface_closest(s, p, &found, err));
      assert_near(found.distance, expected, 1e-12, "distance");
      MUST(cag_surface_transform(s, &move, &moved, err));
      MUST(cag_surface_closest(moved, cag_transform_point(&move, p), &found, err));
      assert_near(found.distance, expected, 1e-12, "distance of the moved one");
      assert_point(surface_at(moved, found.u, found.v), found.point, 1e-12, "place");
      cag_surface_release(moved);
    }
    cag_surface_release(s);
  }
}

// The line to the point is perpendicular to the surface up to rounding, not only to its square
// root.
static void nearest_points_are_perpendicular(void **state) {
  (void)state;
  state_of_random = 99;
  int inner = 0;
  for (int i = 0; i < 200; i++) {
    CagSurface *s = random_net(false, i % 2, false);
    CagSurfaceNearest found;
    CagVec3 d[4];
    const CagVec3 p = beside(s);
    MUST(cag_surface_closest(s, p, &found, err));
    const double u = (found.u - s->u0) / (s->u1 - s->u0), v = (found.v - s->v0) / (s->v1 - s->v0);
    MUST(cag_surface_eval(s, found.u, found.v, 1, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err));
    const CagVec3 r = cag_sub(found.point, p);
    const double off_u = fabs(cag_dot(r, cag_unit(d[cag_partial(1, 1, 0)])));
    const double off_v = fabs(cag_dot(r, cag_unit(d[cag_partial(1, 0, 1)])));
    // Except at creases.
    const double crease = 1e-3;
    if (u > 0 && u < 1 && v > 0 && v < 1 && fmax(off_u, off_v) < crease) {
      inner++;
      assert_true(fmax(off_u, off_v) < 1e-13 * 20);
    }
    cag_surface_release(s);
  }
  assert_true(inner > 40);
}

// Half of a square, cut along its diagonal. Points inside, beyond the cut, and above the cut-off
// corner, where the whole surface would be closer.
static void trimmed_surfaces_count_within_their_outlines(void **state) {
  (void)state;
  const CagVec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const CagVec3 net[] = {{0, 0, 0}, {0, 4, 0}, {4, 0, 0}, {4, 4, 0}};
  CagCurve *outline;
  CagRegion *region;
  CagSurface *whole_surface, *s;
  CagSurfaceNearest found;
  MUST(cag_curve_polyline(corners, 3, true, 2, &outline, err));
  MUST(cag_region_new(outline, NULL, 0, &region, err));
  MUST(cag_surface_bezier(net, NULL, 2, 2, &whole_surface, err));
  MUST(cag_surface_trimmed(whole_surface, region, &s, err));
  MUST(cag_surface_closest(s, cag_vec3(1, 1, 2), &found, err));
  assert_near(found.distance, 2, 1e-14, "inside");
  MUST(cag_surface_closest(s, cag_vec3(3, 3, 0), &found, err));
  assert_near(found.distance, sqrt(2), 1e-12, "beyond the cut");
  assert_point(found.point, cag_vec3(2, 2, 0), 1e-9, "point");
  MUST(cag_surface_closest(s, cag_vec3(4, 4, 1), &found, err));
  assert_near(found.distance, 3, 1e-12, "over the corner");
  cag_surface_release(s);
  cag_surface_release(whole_surface);
  cag_region_release(region);
  cag_curve_release(outline);
}

// --- Curves ---

static CagCurve *random_curve(int kind) {
  CagVec3 p[7];
  double weights[7], knots[11];
  CagCurve *c = NULL;
  CagTransform frame = cag_transform_identity();
  for (int i = 0; i < 7; i++) {
    p[i] = anywhere(10);
    weights[i] = between(0.1, 3);
  }
  for (int i = 0; i < 11; i++) knots[i] = i < 4 ? 0 : i > 6 ? 4 : i - 3;
  switch (kind) {
  case 0: MUST(cag_curve_bezier(p, NULL, 6, 3, &c, err)); break;
  case 1: MUST(cag_curve_nurbs(p, weights, 7, 3, knots, 3, &c, err)); break;
  case 2: MUST(cag_curve_polyline(p, 7, false, 3, &c, err)); break;
  case 3: MUST(cag_curve_arc(weights[0], weights[1], 0, 5, &frame, &c, err)); break;
  default: MUST(cag_curve_helix(2 + weights[0], 1, 3, weights[1], &c, err)); break;
  }
  return c;
}

static double curve_distance(const CagCurve *c, CagVec3 p, double t) {
  CagVec3 q;
  MUST(cag_curve_point(c, t, &q, err));
  return cag_norm(cag_sub(p, q));
}

// Samples, and then ternary search around the lowest ones.
static double dense_curve_distance(const CagCurve *c, CagVec3 p) {
  enum { SAMPLES = 300 };
  double best = INFINITY, at[SAMPLES + 1], h = (c->end - c->start) / SAMPLES;
  for (int i = 0; i <= SAMPLES; i++) at[i] = curve_distance(c, p, fmin(c->end, c->start + h * i));
  for (int i = 0; i <= SAMPLES; i++) {
    if ((i > 0 && at[i - 1] < at[i]) || (i < SAMPLES && at[i + 1] < at[i])) continue;
    double a = fmax(c->start, c->start + h * (i - 1)), b = fmin(c->end, c->start + h * (i + 1));
    for (int k = 0; k < 80; k++) {
      const double x = a + (b - a) / 3, y = b - (b - a) / 3;
      if (curve_distance(c, p, x) < curve_distance(c, p, y)) b = y;
      else a = x;
    }
    best = fmin(best, fmin(at[i], curve_distance(c, p, (a + b) / 2)));
  }
  return best;
}

static void nearest_points_of_curves_are_right_and_perpendicular(void **state) {
  (void)state;
  state_of_random = 1234;
  for (int i = 0; i < 300; i++) {
    CagCurve *c = random_curve(i % 5);
    const CagVec3 p = anywhere(12);
    CagVec3 q, d[2];
    double t, distance, to_corner = INFINITY;
    MUST(cag_curve_closest(c, p, &t, &q, &distance, err));
    const double dense = dense_curve_distance(c, p);
    if (distance > dense + 1e-9) fail_msg("curve %d: %.17g, but %.17g", i, distance, dense);
    MUST(cag_curve_eval(c, t, 1, CAG_SIDE_RIGHT, d, err));
    for (int k = 0; i % 5 == 2 && k < 7; k++) to_corner = fmin(to_corner, fabs(t - k));
    // Rounding errors of coordinates up to 12, whose differences are converted to a slope.
    if (t > c->start && t < c->end && to_corner > 0)
      assert_near(cag_dot(cag_sub(q, p), cag_unit(d[1])), 0, 3e-14, "leaning");
    cag_curve_release(c);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(nearest_points_of_curves_are_right_and_perpendicular),
      cmocka_unit_test(nearest_points_of_creased_surfaces_are_right),
      cmocka_unit_test(nearest_points_of_tensor_surfaces_are_right),
      cmocka_unit_test(nearest_points_of_winding_strips_are_right),
      cmocka_unit_test(nearest_points_of_other_kinds_are_right),
      cmocka_unit_test(nearest_points_of_a_torus_have_closed_form),
      cmocka_unit_test(tubes_and_offsets_have_closed_forms),
      cmocka_unit_test(nearest_points_are_perpendicular),
      cmocka_unit_test(trimmed_surfaces_count_within_their_outlines),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
