// Trimmed surfaces: measures against closed forms, and meshes against dense samples of the surface.

#include "geom/mesh/distance.h"
#include "geom/mesh/tessellate.h"
#include "geom/surface/trimmed.h"
#include "tests/geom/surface_support.h"

static CagRegion *disks(const double (*circles)[3], size_t n) {
  CagCurve *loops[4] = {0};
  CagRegion *r = NULL;
  for (size_t i = 0; i < n; i++) {
    CagTransform frame = cag_translate(cag_vec3(circles[i][0], circles[i][1], 0));
    frame.planar = true;
    MUST(cag_curve_arc(circles[i][2], circles[i][2], 0, 2 * M_PI, &frame, &loops[i], err));
  }
  MUST(cag_region_from_loops(loops, n, &r, err));
  for (size_t i = 0; i < n; i++) cag_curve_release(loops[i]);
  return r;
}

// A bicubic surface over 0..5 by 0..5 whose control points are heights of sin i cos j.
static CagSurface *waves(void) {
  enum { N = 8 };
  CagVec3 net[N * N];
  double knots[N + 4] = {0, 0, 0, 0, 1, 2, 3, 4, 5, 5, 5, 5};
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++)
      net[i * N + j] = cag_vec3(i * 5.0 / (N - 1), j * 5.0 / (N - 1), sin(i) * cos(j));
  CagSurface *s = NULL;
  MUST(cag_surface_nurbs(net, NULL, N, N, 3, 3, knots, knots, &s, err));
  return s;
}

static double from_mesh(const CagMesh *m, CagVec3 p) {
  double least = INFINITY;
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *c = m->triangles + 3 * t;
    least = fmin(least, cag_distance_to_triangle(p, m->positions[c[0]], m->positions[c[1]],
                                                 m->positions[c[2]]));
  }
  return least;
}

// Samples within the region, some of them right beside the outlines, are as near to the mesh as the
// tolerance says.
static void check_mesh(const CagSurface *s, double tolerance, const char *name) {
  const int N = 41;
  const CagSurface *inner;
  const CagRegion *region;
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *m = NULL;
  double area, worst = 0;
  how.tolerance = tolerance;
  assert_true(cag_surface_trimmed_view(s, &inner, &region));
  MUST(cag_surface_tessellate(s, &how, &m, err));
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++) {
      double u = s->u0 + (s->u1 - s->u0) * (i + 0.37) / N;
      double v = s->v0 + (s->v1 - s->v0) * (j + 0.61) / N;
      bool inside;
      CagVec3 p;
      MUST(cag_region_contains(region, cag_vec3(u, v, 0), &inside, err));
      if (!inside) continue;
      MUST(cag_surface_point(s, u, v, &p, err));
      worst = fmax(worst, from_mesh(m, p));
    }
  for (size_t l = 0; l < region->count; l++)
    for (int i = 0; i < 4 * N; i++) {
      const CagCurve *c = region->loops[l];
      CagVec3 at, p;
      MUST(cag_curve_point(c, c->start + (c->end - c->start) * (i + 0.5) / (4 * N), &at, err));
      MUST(cag_surface_point(inner, at.x, at.y, &p, err));
      worst = fmax(worst, from_mesh(m, p));
    }
  if (!(worst <= tolerance))
    fail_msg("%s: %g from the mesh, the tolerance is %g", name, worst, tolerance);
  // Every vertex lies on the surface at its parameters, no triangle is turned over, none is open
  // but along the outlines.
  for (size_t k = 0; k < m->vertex_count; k++) {
    CagVec3 p;
    MUST(cag_surface_point(inner, m->uv[2 * k], m->uv[2 * k + 1], &p, err));
    assert_point(m->positions[k], p, 1e-9, name);
  }
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *c = m->triangles + 3 * t;
    CagVec3 n = cag_cross(cag_sub(m->positions[c[1]], m->positions[c[0]]),
                          cag_sub(m->positions[c[2]], m->positions[c[0]]));
    assert_true(cag_dot(n, m->normals[c[0]]) > 0);
  }
  assert_int_equal(cag_mesh_euler_characteristic(m), 2 - (long)region->count);
  MUST(cag_surface_area(s, &area, NULL, err));
  assert_true(fabs(cag_mesh_area(m) - area) < 0.05 * area);
  cag_mesh_release(m);
}

static void meshes_keep_the_tolerance(void **state) {
  (void)state;
  CagSurface *all = waves(), *s = NULL;
  CagRegion *r = disks((const double[][3]){{2.5, 2.5, 2.2}, {2, 2, 0.4}, {3.3, 3, 0.25}}, 3);
  MUST(cag_surface_trimmed(all, r, &s, err));
  check_mesh(s, 0.02, "waves");
  check_mesh(s, 0.002, "waves, fine");
  cag_surface_release(s);
  cag_region_release(r);
  cag_surface_release(all);
  // A small part of a strongly curved surface, all of it beside its outline.
  MUST(cag_surface_torus(3, 1, &all, err));
  r = disks((const double[][3]){{1.5, 2, 1.2}}, 1);
  MUST(cag_surface_trimmed(all, r, &s, err));
  check_mesh(s, 0.01, "torus");
  cag_surface_release(s);
  cag_region_release(r);
  cag_surface_release(all);
}

// x^2 + y^2 <= 4 on z = x y: the integral of sqrt(1 + r^2) is 2 pi (5^(3/2) - 1) / 3.
static void areas_are_exact(void **state) {
  (void)state;
  CagSurface *saddle = NULL, *s = NULL;
  CagRegion *r = disks((const double[][3]){{0, 0, 2}}, 1);
  double area, knots[4] = {-3, -3, 3, 3};
  CagVec3 centroid, net[4];
  for (int i = 0; i < 4; i++) {
    double x = i / 2 ? 3 : -3, y = i % 2 ? 3 : -3;
    net[i] = cag_vec3(x, y, x * y);
  }
  MUST(cag_surface_nurbs(net, NULL, 2, 2, 1, 1, knots, knots, &saddle, err));
  MUST(cag_surface_trimmed(saddle, r, &s, err));
  MUST(cag_surface_area(s, &area, &centroid, err));
  assert_near(area, 2 * M_PI * (5 * sqrt(5) - 1) / 3, 1e-10, "saddle");
  assert_point(centroid, cag_vec3(0, 0, 0), 1e-10, "centroid");
  // z = x y on the circle reaches 2 sin 90.
  CagBounds box;
  MUST(cag_surface_bounds(s, &box, err));
  assert_point(box.max, cag_vec3(2, 2, 2), 1e-9, "bounds");
  // The flux of z through it, of both signs alike.
  double terms[10] = {0};
  MUST(cag_surface_volume_terms(s, terms, err));
  assert_near(terms[0], 0, 1e-9, "flux");
  cag_surface_release(s);
  cag_region_release(r);
  r = disks((const double[][3]){{2, 0, 2}}, 1);
  MUST_FAIL(cag_surface_trimmed(saddle, r, &s, err), "curve-outside");
  cag_region_release(r);
  cag_surface_release(saddle);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(areas_are_exact),
      cmocka_unit_test(meshes_keep_the_tolerance),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
