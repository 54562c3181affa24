// Triangles of twisted blades are nearly tangent to the surface: the normals at their corners,
// which determine the shading, are close to their own. At a sharp leading edge, steps across are
// short and steps along are long. A triangle that is as high as the former and bulges like the
// latter would be almost perpendicular to the surface.

#include "geom/solid/solid.h"
#include "geom/solid/tessellate.h"
#include "geom/surface/loft.h"
#include "tests/geom/support.h"

static uint64_t chance_state = 1;

// Park and Miller's generator, for the same blades on every machine.
static double between(double a, double b) {
  chance_state = chance_state * 48271 % 2147483647;
  return a + (b - a) * (double)chance_state / 2147483647;
}

enum { SECTIONS = 5 };

// A section of chord 10, rotated, scaled, and raised.
static CagCurve *section(const double profile[6][2], double angle, double scale, double z) {
  CagVec3 p[6];
  for (int k = 0; k < 6; k++) {
    const double x = scale * profile[k][0], y = scale * profile[k][1];
    p[k] = cag_vec3(x * cos(angle) - y * sin(angle), x * sin(angle) + y * cos(angle), z);
  }
  CagCurve *c;
  OK(cag_curve_nurbs_closed(p, NULL, 6, 3, 3, &c, &err));
  return c;
}

static CagSurface *blade(void) {
  const double thick = between(0.4, 1), camber = between(0, 0.4), twist = between(0.5, 2.5);
  const double taper = between(0.2, 1);
  const double profile[6][2] = {{-5, 0},          {-2, camber + thick}, {2, camber + thick},
                                {5, 0.2 * thick}, {2, camber - thick},  {-2, camber - thick}};
  CagCurve *c[SECTIONS];
  CagSurface *s;
  for (int k = 0; k < SECTIONS; k++) {
    const double at = (double)k / (SECTIONS - 1);
    c[k] = section(profile, twist * at, 1 + (taper - 1) * at, 40 * at);
  }
  OK(cag_surface_loft((const CagCurve *const *)c, SECTIONS, 3, false, &s, &err));
  for (int k = 0; k < SECTIONS; k++) cag_curve_release(c[k]);
  return s;
}

static double angle_between(CagVec3 a, CagVec3 b) {
  return atan2(cag_norm(cag_cross(a, b)), cag_dot(a, b));
}

// The largest angle between the normal of a triangle and that of one of its corners, in radians.
static double largest_lean(const CagMesh *m) {
  double largest = 0;
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    const CagVec3 a = m->positions[k[0]];
    const CagVec3 n = cag_cross(cag_sub(m->positions[k[1]], a), cag_sub(m->positions[k[2]], a));
    for (int j = 0; j < 3; j++) largest = fmax(largest, angle_between(n, m->normals[k[j]]));
  }
  return largest;
}

// The normal rotates by at most 15 degrees along an edge. The limit is the same for the triangle's
// own normal.
static const double most = 15 * M_PI / 180;

static void triangles_of_blades_lie_along_the_surface(void **state) {
  (void)state;
  enum { BLADES = 24 };
  for (int k = 0; k < BLADES; k++) {
    CagSurface *s = blade();
    CagSolid *solid;
    CagMesh *open, *closed;
    CagVec3 edge[2];
    OK(cag_solid_loft(s, &solid, &err));
    OK(cag_surface_tessellate(s, NULL, &open, &err));
    OK(cag_solid_tessellate(solid, NULL, &closed, &err));
    const double leans[2] = {largest_lean(open), largest_lean(closed)};
    if (!(leans[0] <= most && leans[1] <= most))
      fail_msg("blade %d: normals lean by %.1f and %.1f degrees", k, leans[0] * 180 / M_PI,
               leans[1] * 180 / M_PI);
    assert_true(cag_mesh_is_watertight(closed, edge));
    cag_mesh_release(open);
    cag_mesh_release(closed);
    cag_solid_release(solid);
    cag_surface_release(s);
  }
}

static void triangles_of_twisted_extrusions_lie_along_the_surface(void **state) {
  (void)state;
  const double profile[6][2] = {{-5, 0}, {-2, 0.9}, {2, 0.9}, {5, 0.2}, {2, -0.1}, {-2, -0.5}};
  for (int turns = 1; turns <= 6; turns++) {
    CagCurve *c = section(profile, 0, 1, 0);
    CagSurface *s;
    CagMesh *m;
    OK(cag_surface_extrude(c, cag_vec3(0, 0, 40), turns * M_PI / 3, 1, &s, &err));
    OK(cag_surface_tessellate(s, NULL, &m, &err));
    const double lean = largest_lean(m);
    if (!(lean <= most)) fail_msg("%d: normals lean by %.1f degrees", turns, lean * 180 / M_PI);
    cag_mesh_release(m);
    cag_surface_release(s);
    cag_curve_release(c);
  }
}

// The profile crosses the axis: the surface is a single point there, and its normal is reversed.
static void triangles_of_revolutions_across_the_axis_lie_along_the_surface(void **state) {
  (void)state;
  enum { SHAPES = 16 };
  for (int k = 0; k < SHAPES; k++) {
    CagVec3 p[4];
    for (int i = 0; i < 4; i++) {
      const double radius = between(2, 10);
      p[i] = cag_vec3(i % 2 ? radius : -radius, 0, 5 * i + between(-1, 1));
    }
    const double from = between(0, 3), to = k % 2 ? from + 2 * M_PI : from + between(0.5, 6);
    CagCurve *c;
    CagSurface *s;
    CagMesh *m;
    const bool straight = k % 4 < 2;
    OK(straight ? cag_curve_line(p[0], p[1], 3, &c, &err)
                : cag_curve_bezier(p, NULL, 4, 3, &c, &err));
    OK(cag_surface_revolve(c, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), from, to, &s, &err));
    OK(cag_surface_tessellate(s, NULL, &m, &err));
    const double lean = largest_lean(m);
    if (!(lean <= most)) fail_msg("%d: normals lean by %.1f degrees", k, lean * 180 / M_PI);
    cag_mesh_release(m);
    cag_surface_release(s);
    cag_curve_release(c);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(triangles_of_blades_lie_along_the_surface),
      cmocka_unit_test(triangles_of_twisted_extrusions_lie_along_the_surface),
      cmocka_unit_test(triangles_of_revolutions_across_the_axis_lie_along_the_surface),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
