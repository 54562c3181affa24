// Meshes of planar faces in frames with arbitrary columns. Outlines satisfy the tolerance in space
// with few corners. Vertices have the normal of the plane and their coordinates in the region.

#include "geom/surface/patches.h"
#include "geom/tessellate/tessellate.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

static CagCurve *circle(double radius, double x) {
  CagTransform t = cag_transform_identity();
  CagCurve *c;
  t.m[0][3] = x;
  OK(cag_curve_arc(radius, radius, 0, 2 * M_PI, &t, &c, &err));
  return c;
}

static CagTransform random_frame(double size) {
  CagTransform t = cag_transform_identity();
  t.planar = false;
  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < 3; k++) t.m[i][k] = size * uniform(-1, 1);
    t.m[i][3] = size * uniform(-3, 3);
  }
  return t;
}

static CagVec3 column(const CagTransform *t, int k) {
  return cag_vec3(t->m[0][k], t->m[1][k], t->m[2][k]);
}

// The ring's outer circle is about the origin, its hole about (x, 0).
static const double RADIUS = 3, HOLE = 1, HOLE_X = 0.5;

// Checks the distance of a chord of one of the circles from its arc.
static void check_chord(const CagTransform *t, CagVec3 a, CagVec3 b, double tolerance) {
  const CagVec3 center = {hypot(a.x, a.y) > 2.5 ? 0 : HOLE_X, 0, 0};
  const CagVec3 p = cag_sub(a, center), q = cag_sub(b, center), sum = cag_add(p, q);
  const CagVec3 top = cag_scaled(sum, cag_norm(p) / cag_norm(sum));
  const CagVec3 chord = cag_transform_vector(t, cag_sub(q, p));
  const CagVec3 off = cag_transform_vector(t, cag_sub(top, p));
  NEAR(cag_norm(p), center.x > 0 ? HOLE : RADIUS, 1e-9);
  NEAR(cag_norm(q), cag_norm(p), 1e-9);
  assert_true(cag_norm(cag_cross(off, chord)) <= (1 + 1e-6) * tolerance * cag_norm(chord));
}

static void outlines_keep_the_tolerance_in_space(void **state) {
  (void)state;
  seed = 421;
  for (int k = 0; k < 40; k++) {
    const double size = exp(uniform(-3, 3));
    const CagTransform t = random_frame(size);
    const CagVec3 x = column(&t, 0), y = column(&t, 1), normal = cag_unit(cag_cross(x, y));
    // The largest length in space of a unit vector of the region.
    double longest = 0;
    for (int i = 0; i < 720; i++) {
      const double angle = i * M_PI / 720;
      longest = fmax(longest, cag_norm(cag_madd(cag_scaled(x, cos(angle)), sin(angle), y)));
    }
    CagCurve *outer = circle(RADIUS, 0), *hole = circle(HOLE, HOLE_X);
    CagRegion *r;
    CagSurface *s;
    CagMesh *m;
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    how.tolerance = longest * exp(uniform(-9, -3));
    how.angle = 1.5;
    OK(cag_region_new(outer, &hole, 1, &r, &err));
    OK(cag_surface_planar(r, &t, &s, &err));
    OK(cag_surface_tessellate(s, &how, &m, &err));
    size_t corners = 0;
    for (size_t i = 0; i < m->vertex_count; i++) {
      const CagVec3 uv = cag_vec3(m->uv[2 * i], m->uv[2 * i + 1], 0);
      near_vec(m->positions[i], cag_transform_point(&t, uv), 1e-11 * size);
      near_vec(m->normals[i], normal, 1e-9);
      corners++;
    }
    double area = 0;
    for (size_t i = 0; i < m->triangle_count; i++) {
      const uint32_t *v = m->triangles + 3 * i;
      const CagVec3 a = m->positions[v[0]];
      const CagVec3 n = cag_cross(cag_sub(m->positions[v[1]], a), cag_sub(m->positions[v[2]], a));
      assert_true(cag_dot(n, normal) > 0);
      area += cag_norm(n) / 2;
      for (int e = 0; e < 3; e++) {
        // An edge that only one triangle has is part of the outline.
        const uint32_t p = v[e], q = v[(e + 1) % 3];
        int others = 0;
        for (size_t j = 0; j < 3 * m->triangle_count; j++)
          others += m->triangles[j] == q && m->triangles[j - j % 3 + (j + 1) % 3] == p;
        if (others > 0) continue;
        check_chord(&t, cag_vec3(m->uv[2 * p], m->uv[2 * p + 1], 0),
                    cag_vec3(m->uv[2 * q], m->uv[2 * q + 1], 0), how.tolerance);
      }
    }
    const double whole = M_PI * (RADIUS * RADIUS - HOLE * HOLE) * cag_norm(cag_cross(x, y));
    assert_true(fabs(area - whole) <= 2 * M_PI * (RADIUS + HOLE) * longest * how.tolerance);
    // Steps are uniform in the region, and the largest stretch determines their size.
    const double fewest = M_PI / acos(1 - how.tolerance / longest / RADIUS) +
                          M_PI / acos(1 - how.tolerance / longest / HOLE);
    assert_true((double)corners < 2 * fewest + 8);
    cag_mesh_release(m);
    cag_surface_release(s);
    cag_region_release(r);
    cag_curve_release(outer);
    cag_curve_release(hole);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(outlines_keep_the_tolerance_in_space),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
