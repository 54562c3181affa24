// Closest points of planar pieces: a plate with a round hole, whose distances have closed forms,
// and convex polygons under shears, compared with the distances of their sides.

#include "random.h"
#include "surface_support.h"

#include "geom/surface/nearest.h"

enum { WIDE = 6, HIGH = 4 };
static const double RADIUS = 1.5;

static CagVec3 random_point(double size) {
  const double x = uniform(-size, size), y = uniform(-size, size);
  return cag_vec3(x, y, uniform(-size, size));
}

static CagTransform random_motion(void) {
  CagTransform turn;
  const double angle = uniform(-3, 3);
  const CagVec3 axis = random_point(1);
  MUST(cag_rotate(axis, angle, random_point(3), &turn, err));
  const CagTransform move = cag_translate(random_point(20));
  return cag_transform_multiply(&move, &turn);
}

// The closest point of a centered rectangle with a hole in its middle, in the plane.
static CagVec3 nearest_of_plate(CagVec3 p) {
  const double r = hypot(p.x, p.y);
  if (r < RADIUS) return cag_vec3(p.x * RADIUS / r, p.y * RADIUS / r, 0);
  return cag_vec3(fmin(fmax(p.x, -WIDE / 2), WIDE / 2), fmin(fmax(p.y, -HIGH / 2), HIGH / 2), 0);
}

static void nearest_points_of_a_plate_have_closed_forms(void **state) {
  (void)state;
  const CagVec3 corners[] = {{-WIDE / 2, -HIGH / 2, 0},
                             {WIDE / 2, -HIGH / 2, 0},
                             {WIDE / 2, HIGH / 2, 0},
                             {-WIDE / 2, HIGH / 2, 0}};
  const CagTransform plane = cag_transform_identity();
  CagCurve *outline, *hole;
  CagRegion *region;
  MUST(cag_curve_polyline(corners, 4, true, 2, &outline, err));
  MUST(cag_curve_arc(RADIUS, RADIUS, 0, 2 * M_PI, &plane, &hole, err));
  MUST(cag_region_new(outline, &hole, 1, &region, err));
  seed = 3;
  for (int i = 0; i < 300; i++) {
    const CagTransform frame = random_motion();
    const CagVec3 local = random_point(i % 2 ? 5 : 2), wanted = nearest_of_plate(local);
    CagSurfaceNearest found;
    CagSurface *s;
    MUST(cag_surface_planar(region, &frame, &s, err));
    MUST(cag_surface_closest(s, cag_transform_point(&frame, local), &found, err));
    assert_point(found.point, cag_transform_point(&frame, wanted), 1e-12, "point");
    assert_near(found.distance, cag_norm(cag_sub(local, wanted)), 1e-12, "distance");
    assert_near(found.u, wanted.x, 1e-12, "u");
    assert_near(found.v, wanted.y, 1e-12, "v");
    cag_surface_release(s);
  }
  cag_region_release(region);
  cag_curve_release(hole);
  cag_curve_release(outline);
}

// --- Maps that stretch and shear ---

static CagVec3 nearest_of_side(CagVec3 a, CagVec3 b, CagVec3 p) {
  const CagVec3 d = cag_sub(b, a);
  const double t = cag_dot(cag_sub(p, a), d) / cag_dot(d, d);
  return cag_madd(a, fmin(fmax(t, 0), 1), d);
}

static void nearest_points_of_mapped_triangles_are_their_own(void **state) {
  (void)state;
  seed = 11;
  for (int i = 0; i < 300; i++) {
    CagVec3 corners[3], q[3];
    for (int k = 0; k < 3; k++) {
      const double angle = 2 * k + uniform(0, 1.5);
      corners[k] = cag_vec3(3 * cos(angle), 3 * sin(angle), 0);
    }
    CagTransform frame = cag_transform_identity();
    for (int row = 0; row < 3; row++)
      for (int column = 0; column < 4; column++) frame.m[row][column] = uniform(-2, 2);
    frame.planar = false;
    for (int k = 0; k < 3; k++) q[k] = cag_transform_point(&frame, corners[k]);
    const CagVec3 n = cag_unit(cag_cross(cag_sub(q[1], q[0]), cag_sub(q[2], q[0])));
    const CagVec3 p = cag_add(q[0], random_point(6));
    // If the foot is inside all sides, it is the foot on the plane; otherwise, the closest point of
    // a side.
    CagVec3 wanted = cag_madd(p, -cag_dot(cag_sub(p, q[0]), n), n);
    bool within = true;
    for (int k = 0; k < 3; k++) {
      const CagVec3 side = cag_sub(q[(k + 1) % 3], q[k]);
      within = within && cag_dot(cag_cross(side, cag_sub(wanted, q[k])), n) >= 0;
    }
    for (int k = 0; k < 3 && !within; k++) {
      const CagVec3 other = nearest_of_side(q[k], q[(k + 1) % 3], p);
      if (k == 0 || cag_norm(cag_sub(other, p)) < cag_norm(cag_sub(wanted, p))) wanted = other;
    }
    CagCurve *outline;
    CagRegion *region;
    CagSurface *s;
    CagSurfaceNearest found;
    MUST(cag_curve_polyline(corners, 3, true, 2, &outline, err));
    MUST(cag_region_new(outline, NULL, 0, &region, err));
    MUST(cag_surface_planar(region, &frame, &s, err));
    MUST(cag_surface_closest(s, p, &found, err));
    assert_near(found.distance, cag_norm(cag_sub(wanted, p)), 1e-9, "distance");
    assert_point(found.point, wanted, 1e-7, "point");
    assert_point(cag_transform_point(&frame, cag_vec3(found.u, found.v, 0)), found.point, 1e-9,
                 "parameters");
    cag_surface_release(s);
    cag_region_release(region);
    cag_curve_release(outline);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(nearest_points_of_a_plate_have_closed_forms),
      cmocka_unit_test(nearest_points_of_mapped_triangles_are_their_own),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
