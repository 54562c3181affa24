// Trimmed surfaces: measures compared with closed forms, and meshes with dense samples of the
// surface.

#include "geom/mesh/distance.h"
#include "geom/surface/quadric.h"
#include "geom/surface/trimmed.h"
#include "geom/tessellate/orient.h"
#include "geom/tessellate/tessellate.h"
#include "tests/geom/trimmed_support.h"

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

// Checks that samples of the region, some of them right beside the outlines, are within the
// tolerance of the mesh.
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
  // Every vertex is on the surface at its parameters, triangles are not reversed, and open edges
  // are on the outlines.
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
  // A small part of a strongly curved surface, all of which is near its outline.
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
  // z = x y on the circle reaches 2 at 45 degrees.
  CagBounds box;
  MUST(cag_surface_bounds(s, &box, err));
  assert_point(box.max, cag_vec3(2, 2, 2), 1e-9, "bounds");
  // Its flux of z has equal parts of both signs.
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

// --- Outlines with straight sides ---

static CagRegion *polygons(const CagVec3 *const *corners, const size_t *counts, size_t n) {
  CagCurve *loops[4] = {0};
  CagRegion *r = NULL;
  for (size_t i = 0; i < n; i++)
    MUST(cag_curve_polyline(corners[i], counts[i], true, 2, &loops[i], err));
  MUST(cag_region_from_loops(loops, n, &r, err));
  for (size_t i = 0; i < n; i++) cag_curve_release(loops[i]);
  return r;
}

// z = 2 x - 3 y over -9..9.
static CagSurface *slope(void) {
  CagSurface *s = NULL;
  double knots[4] = {-9, -9, 9, 9};
  CagVec3 net[4];
  for (int i = 0; i < 4; i++) {
    const double x = i / 2 ? 9 : -9, y = i % 2 ? 9 : -9;
    net[i] = cag_vec3(x, y, 2 * x - 3 * y);
  }
  MUST(cag_surface_nurbs(net, NULL, 2, 2, 1, 1, knots, knots, &s, err));
  return s;
}

static double edge_length(const CagMesh *m, size_t t, int k) {
  const uint32_t *c = m->triangles + 3 * t;
  return cag_norm(cag_sub(m->positions[c[(k + 1) % 3]], m->positions[c[k]]));
}

// A star with two holes: n corners and h holes need n + 2 h - 2 triangles. With a limit of edges,
// each side of the outline is divided into the fewest equal parts that satisfy it.
static void flat_polygons_are_cut_into_few_triangles(void **state) {
  (void)state;
  uint64_t random = 5;
  CagSurface *all = slope(), *s = NULL;
  for (int trial = 0; trial < 12; trial++) {
    CagVec3 star[24], hole[2][3];
    const size_t n = 8 + 2 * (size_t)(trial % 8), holes = (size_t)(trial % 3);
    for (size_t i = 0; i < n; i++) {
      random = random * 6364136223846793005u + 1442695040888963407u;
      const double r = (i % 2 ? 3 : 5) + 3 * (double)(random >> 11) / 9007199254740992.0;
      const double a = 2 * M_PI * (double)i / (double)n;
      star[i] = cag_vec3(r * cos(a), r * sin(a), 0);
    }
    for (int h = 0; h < 2; h++)
      for (int k = 0; k < 3; k++)
        hole[h][k] = cag_vec3((h ? 1 : -1) + 0.5 * cos(2 * k + h), 0.7 * sin(2 * k + h), 0);
    const CagVec3 *const corners[3] = {star, hole[0], hole[1]};
    const size_t counts[3] = {n, 3, 3};
    CagRegion *r = polygons(corners, counts, 1 + holes);
    MUST(cag_surface_trimmed(all, r, &s, err));
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    CagMesh *m = NULL;
    double area, expected = 0;
    for (size_t l = 0; l <= holes; l++) {
      double loop = 0;
      for (size_t i = 0; i < counts[l]; i++) {
        const CagVec3 a = corners[l][i], b = corners[l][(i + 1) % counts[l]];
        loop += (a.x * b.y - a.y * b.x) / 2;
      }
      expected += l ? -fabs(loop) : fabs(loop);
    }
    how.tolerance = 0.01;
    MUST(cag_surface_tessellate(s, &how, &m, err));
    assert_int_equal(m->vertex_count, n + 3 * holes);
    assert_int_equal(m->triangle_count, n + 3 * holes + 2 * holes - 2);
    area = cag_mesh_area(m);
    assert_near(area, expected * sqrt(14), 1e-9, "area");
    cag_mesh_release(m);
    // With subdivided edges.
    how.max_edge = 1.3;
    MUST(cag_surface_tessellate(s, &how, &m, err));
    size_t parts = 0, open = 0;
    for (size_t l = 0; l <= holes; l++)
      for (size_t i = 0; i < counts[l]; i++) {
        const CagVec3 d = cag_sub(corners[l][(i + 1) % counts[l]], corners[l][i]);
        parts += (size_t)ceil(cag_norm(cag_vec3(d.x, d.y, 2 * d.x - 3 * d.y)) / how.max_edge);
      }
    MUST(cag_mesh_open_edges(m, &open, err));
    assert_int_equal(open, parts);
    assert_near(cag_mesh_area(m), expected * sqrt(14), 1e-9, "area of parts");
    for (size_t t = 0; t < m->triangle_count; t++)
      for (int k = 0; k < 3; k++) assert_true(edge_length(m, t, k) <= 1.3 * (1 + 1e-12));
    for (size_t v = 0; v < m->vertex_count; v++)
      assert_point(m->normals[v], cag_scaled(cag_vec3(-2, 3, 1), 1 / sqrt(14)), 1e-12, "normal");
    // They are slender because the sides along the parameters are oblique, but not more.
    assert_true((double)m->triangle_count < 20 * cag_mesh_area(m) / (1.3 * 1.3));
    cag_mesh_release(m);
    cag_surface_release(s);
    cag_region_release(r);
  }
  cag_surface_release(all);
}

// --- Angles, limits ---

static void angles_and_limits_are_kept(void **state) {
  (void)state;
  CagSurface *all = NULL, *s = NULL;
  MUST(cag_surface_torus(3, 1, &all, err));
  CagRegion *r = disks((const double[][3]){{2, 2.5, 1.6}, {2.2, 2.3, 0.4}}, 2);
  MUST(cag_surface_trimmed(all, r, &s, err));
  size_t last = 0;
  for (int step = 0; step < 3; step++) {
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    CagMesh *m = NULL, *none = NULL;
    how.tolerance = 0.05;
    how.angle = 0.2 - 0.06 * step;
    if (step == 1) how.max_edge = 0.2;
    MUST(cag_surface_tessellate(s, &how, &m, err));
    for (size_t t = 0; t < m->triangle_count; t++)
      for (int k = 0; k < 3; k++) {
        const uint32_t a = m->triangles[3 * t + (size_t)k];
        const uint32_t b = m->triangles[3 * t + (size_t)(k + 1) % 3];
        const double turn = acos(fmin(1, cag_dot(m->normals[a], m->normals[b])));
        if (edge_length(m, t, k) > 0.2 * how.tolerance) assert_true(turn <= how.angle * (1 + 1e-6));
        if (step == 1) assert_true(edge_length(m, t, k) <= 0.2 * (1 + 1e-12));
      }
    assert_int_equal(cag_mesh_euler_characteristic(m), 0);
    assert_true(m->triangle_count > last);
    last = m->triangle_count;
    how.max_triangles = m->triangle_count - 1;
    MUST_FAIL(cag_surface_tessellate(s, &how, &none, err), "triangle-limit");
    how.max_triangles = 20;
    MUST_FAIL(cag_surface_tessellate(s, &how, &none, err), "triangle-limit");
    const volatile int stop = 1;
    how = CAG_TESSELLATION_DEFAULT;
    how.interrupt = &stop;
    MUST_FAIL(cag_surface_tessellate(s, &how, &none, err), "interrupted");
    cag_mesh_release(m);
  }
  cag_surface_release(s);
  cag_region_release(r);
  cag_surface_release(all);
}

// A cap around the pole of a sphere, from seam to seam: the mesh closes at both.
static void seams_and_poles_close(void **state) {
  (void)state;
  for (int turned = 0; turned < 2; turned++) {
    CagTransform frame = cag_transform_identity();
    CagSurface *all = NULL, *s = NULL;
    for (int k = 0; k < 3; k++) frame.m[k][k] = 2;
    frame.m[0][3] = 7;
    MUST(cag_surface_quadric(CAG_SHAPE_ELLIPSOID, &frame, 0, 2 * M_PI, 0, M_PI, &all, err));
    const double from = turned ? M_PI : 0, to = turned ? M_PI - 1 : 1;
    const CagVec3 corners[4] = {{0, from, 0}, {2 * M_PI, from, 0}, {2 * M_PI, to, 0}, {0, to, 0}};
    const CagVec3 *const list[1] = {corners};
    CagRegion *r = polygons(list, (const size_t[1]){4}, 1);
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    CagMesh *m = NULL;
    size_t open = 0, rim = 0;
    how.tolerance = 0.01;
    MUST(cag_surface_trimmed(all, r, &s, err));
    MUST(cag_surface_tessellate(s, &how, &m, err));
    CagVec3 middle, normal;
    MUST(cag_surface_point(all, 1, (from + to) / 2, &middle, err));
    MUST(cag_surface_normal(all, 1, (from + to) / 2, &normal, err));
    middle = cag_scaled(cag_sub(middle, cag_vec3(7, 0, 0)), 0.5);
    assert_int_equal(cag_mesh_euler_characteristic(m), 1);
    const double area = 8 * M_PI * (1 - cos(1));
    assert_true(fabs(cag_mesh_area(m) - area) < 0.01 * area);
    for (size_t v = 0; v < m->vertex_count; v++) {
      const CagVec3 out = cag_scaled(cag_sub(m->positions[v], cag_vec3(7, 0, 0)), 0.5);
      const uint32_t first = m->weld[v];
      assert_near(cag_norm(out), 1, 1e-12, "radius");
      assert_near(cag_dot(out, m->normals[v]), cag_dot(normal, middle), 1e-2, "normal");
      assert_true(first <= v && m->weld[first] == first);
      assert_memory_equal(&m->positions[v], &m->positions[first], sizeof(CagVec3));
      for (size_t k = 0; k < v; k++)
        if (cag_norm(cag_sub(m->positions[k], m->positions[v])) < 1e-9)
          assert_int_equal(m->weld[k], first);
      rim += first == v && fabs(out.z - (turned ? -1 : 1) * cos(1)) < 1e-12;
    }
    MUST(cag_mesh_open_edges(m, &open, err));
    assert_int_equal(open, rim);
    cag_mesh_release(m);
    cag_surface_release(s);
    cag_region_release(r);
    cag_surface_release(all);
  }
}

// The sides of a rectangle on the saddle z = x y are straight, but the normals rotate along them.
static void normals_turn_by_the_angle_along_straight_outlines(void **state) {
  (void)state;
  const double knots[4] = {-3, -3, 3, 3};
  CagVec3 net[4];
  for (int i = 0; i < 4; i++) {
    const double x = i / 2 ? 3 : -3, y = i % 2 ? 3 : -3;
    net[i] = cag_vec3(x, y, x * y);
  }
  const CagVec3 corners[] = {{-2, -1.5, 0}, {2.5, -1.5, 0}, {2.5, 2.2, 0}, {-2, 2.2, 0}};
  CagSurface *all, *s;
  CagCurve *outline;
  CagRegion *r;
  MUST(cag_surface_nurbs(net, NULL, 2, 2, 1, 1, knots, knots, &all, err));
  MUST(cag_curve_polyline(corners, 4, true, 2, &outline, err));
  MUST(cag_region_new(outline, NULL, 0, &r, err));
  MUST(cag_surface_trimmed(all, r, &s, err));
  for (int step = 1; step <= 4; step++) {
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    CagMesh *m;
    how.tolerance = 0.1;
    how.angle = 0.1 * step;
    MUST(cag_surface_tessellate(s, &how, &m, err));
    for (size_t t = 0; t < m->triangle_count; t++)
      for (int k = 0; k < 3; k++) {
        CagVec3 n[2];
        for (int e = 0; e < 2; e++) {
          const CagVec3 p = m->positions[m->triangles[3 * t + (size_t)(k + e) % 3]];
          n[e] = cag_unit(cag_vec3(-p.y, -p.x, 1));
        }
        const double turn = acos(fmin(1, cag_dot(n[0], n[1])));
        if (turn > how.angle * (1 + 1e-6) && edge_length(m, t, k) > 0.2 * how.tolerance)
          fail_msg("limit %g: an edge of %g turns by %g", how.angle, edge_length(m, t, k), turn);
      }
    cag_mesh_release(m);
  }
  cag_surface_release(s);
  cag_surface_release(all);
  cag_region_release(r);
  cag_curve_release(outline);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(areas_are_exact),
      cmocka_unit_test(meshes_keep_the_tolerance),
      cmocka_unit_test(flat_polygons_are_cut_into_few_triangles),
      cmocka_unit_test(angles_and_limits_are_kept),
      cmocka_unit_test(normals_turn_by_the_angle_along_straight_outlines),
      cmocka_unit_test(seams_and_poles_close),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
