// Meshes of random nets with creases, seams, and pieces of any width: triangles tile the parameter
// domain, vertices are points of the surface with one-sided normals, and all limits are satisfied.

#include "geom/mesh/check.h"
#include "geom/mesh/distance.h"
#include "geom/surface/reshape.h"
#include "geom/tessellate/tessellate.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

enum { MOST = 8 };

typedef struct Shape {
  CagSurface *s;
  bool closed[2];
} Shape;

// Knots over 0..3 with one or two inner ones. Two equal ones are a crease.
static size_t random_knots(int degree, double *knots) {
  const double at = uniform(0.3, 1.4);
  const double next = uniform(1.6, 2.7);
  const int times = uniform(0, 1) < 0.4 ? degree : 1;
  size_t n = 0;
  for (int k = 0; k <= degree; k++) knots[n++] = 0;
  for (int k = 0; k < times; k++) knots[n++] = at;
  knots[n++] = next;
  for (int k = 0; k <= degree; k++) knots[n++] = 3;
  return n - (size_t)degree - 1;
}

// A sheet, a pipe or a ring.
static Shape random_shape(int k) {
  Shape shape = {.closed = {k % 4 == 1 || k % 4 == 3, k % 4 == 2 || k % 4 == 3}};
  CagVec3 p[MOST * MOST];
  double knots[2][2 * MOST];
  int degree[2];
  size_t n[2];
  for (int d = 0; d < 2; d++) {
    degree[d] = 1 + (int)uniform(0, 3);
    n[d] = shape.closed[d] ? 5 + (size_t)uniform(0, 3) : random_knots(degree[d], knots[d]);
  }
  for (size_t i = 0; i < n[0]; i++)
    for (size_t j = 0; j < n[1]; j++) {
      const double share[2] = {(double)i / (double)n[0], (double)j / (double)n[1]};
      const CagVec3 off = cag_vec3(uniform(-0.5, 0.5), uniform(-0.5, 0.5), uniform(-0.5, 0.5));
      const double a = 2 * M_PI * share[0], b = 2 * M_PI * share[1], r = 7 + 3 * cos(b);
      CagVec3 at = cag_vec3(10 * share[0], 8 * share[1], 0);
      if (k % 4 == 1) at = cag_vec3(4 * cos(a), 4 * sin(a), 10 * share[1]);
      if (k % 4 == 2) at = cag_vec3(4 * cos(b), 10 * share[0], 4 * sin(b));
      if (k % 4 == 3) at = cag_vec3(r * cos(a), r * sin(a), 3 * sin(b));
      p[i * n[1] + j] = cag_add(at, off);
    }
  OK(cag_surface_nurbs_closed(p, NULL, n[0], n[1], degree[0], degree[1],
                              shape.closed[0] ? NULL : knots[0], shape.closed[1] ? NULL : knots[1],
                              shape.closed[0], shape.closed[1], &shape.s, &err));
  return shape;
}

// Checks that no triangle has a negative area in the parameter domain, and that the areas add up to
// that of the domain: no part is covered twice or missing.
static void check_tiling(const CagMesh *m, const CagSurface *s) {
  double area = 0;
  for (size_t t = 0; t < m->triangle_count; t++) {
    const double *a = m->uv + 2 * (size_t)m->triangles[3 * t],
                 *b = m->uv + 2 * (size_t)m->triangles[3 * t + 1],
                 *c = m->uv + 2 * (size_t)m->triangles[3 * t + 2];
    const double twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    assert_true(twice > 0);
    area += twice / 2;
  }
  NEAR(area, (s->u1 - s->u0) * (s->v1 - s->v0), 1e-9);
}

static void check_topology(const CagMesh *m, const Shape *shape) {
  CagMeshCheck c;
  OK(cag_mesh_check(m, &c, &err));
  assert_int_equal(c.nonmanifold_edges + c.nonmanifold_vertices, 0);
  assert_true(c.oriented);
  assert_int_equal(c.shells, 1);
  assert_int_equal(c.euler, shape->closed[0] || shape->closed[1] ? 0 : 1);
  assert_true(c.closed == (shape->closed[0] && shape->closed[1]));
}

// Checks that every vertex is a point of the surface, and has the normal that the surface has
// slightly inside each of its triangles.
static void check_vertices(const CagMesh *m, const CagSurface *s) {
  const double beside = 1e-6; // fraction of the distance to the center of the triangle
  bool *used = calloc(m->vertex_count + 1, sizeof *used);
  assert_non_null(used);
  for (size_t t = 0; t < m->triangle_count; t++)
    for (size_t k = 0; k < 3; k++) {
      const uint32_t *v = m->triangles + 3 * t;
      double at[2], in[2];
      CagVec3 p, n;
      for (size_t d = 0; d < 2; d++) {
        at[d] = m->uv[2 * v[k] + d];
        const double middle = (m->uv[2 * v[0] + d] + m->uv[2 * v[1] + d] + m->uv[2 * v[2] + d]) / 3;
        in[d] = at[d] + beside * (middle - at[d]);
      }
      OK(cag_surface_point(s, at[0], at[1], &p, &err));
      near_vec(m->positions[v[k]], p, 1e-12);
      OK(cag_surface_normal(s, in[0], in[1], &n, &err));
      near_vec(m->normals[v[k]], n, 1e-4);
      used[v[k]] = true;
    }
  for (size_t v = 0; v < m->vertex_count; v++) {
    assert_true(used[v]);
    near_vec(m->positions[v], m->positions[m->weld[v]], 0);
    // All vertices differ.
    for (size_t w = 0; w < v; w++)
      assert_false(m->uv[2 * w] == m->uv[2 * v] && m->uv[2 * w + 1] == m->uv[2 * v + 1] &&
                   cag_norm(cag_sub(m->normals[w], m->normals[v])) < 1e-9);
  }
  free(used);
}

static double to_triangle(const CagMesh *m, size_t t, CagVec3 p) {
  const uint32_t *v = m->triangles + 3 * t;
  return cag_distance_to_triangle(p, m->positions[v[0]], m->positions[v[1]], m->positions[v[2]]);
}

static void check_limits(const CagMesh *m, const CagSurface *s, const CagTessellation *how) {
  static const double weights[4][3] = {
      {1 / 3.0, 1 / 3.0, 1 / 3.0}, {0.5, 0.5, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}};
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *v = m->triangles + 3 * t;
    for (size_t k = 0; k < 3; k++) {
      const uint32_t a = v[k], b = v[(k + 1) % 3];
      const double length = cag_norm(cag_sub(m->positions[a], m->positions[b])),
                   turn = 2 * asin(cag_norm(cag_sub(m->normals[a], m->normals[b])) / 2);
      assert_true(!(how->angle > 0) || turn <= how->angle || length <= 0.2 * how->tolerance);
      assert_true(!(how->max_edge > 0) || length <= how->max_edge);
    }
    for (int k = 0; k < 4; k++) {
      double at[2] = {0, 0}, off;
      CagVec3 p;
      for (size_t j = 0; j < 3; j++)
        for (size_t d = 0; d < 2; d++) at[d] += weights[k][j] * m->uv[2 * v[j] + d];
      OK(cag_surface_point(s, at[0], at[1], &p, &err));
      off = to_triangle(m, t, p);
      for (size_t j = 0; off > how->tolerance && j < m->triangle_count; j++)
        off = fmin(off, to_triangle(m, j, p));
      assert_true(off <= how->tolerance);
    }
  }
}

// Returns the number of triangles.
static double check_mesh(const Shape *shape, const CagTessellation *how) {
  CagMesh *m;
  OK(cag_surface_tessellate(shape->s, how, &m, &err));
  check_tiling(m, shape->s);
  check_topology(m, shape);
  check_vertices(m, shape->s);
  check_limits(m, shape->s, how);
  const double n = (double)m->triangle_count;
  cag_mesh_release(m);
  return n;
}

static void meshes_of_random_nets_are_sound(void **state) {
  (void)state;
  seed = 67;
  for (int k = 0; k < 96; k++) {
    const Shape shape = random_shape(k);
    const CagTessellation how = {.tolerance = exp(uniform(-3.5, -1)),
                                 .angle = k % 3 ? uniform(0.3, 0.8) : 0,
                                 .max_edge = k % 5 ? 0 : uniform(1, 3),
                                 .max_triangles = 100000};
    check_mesh(&shape, &how);
    cag_surface_release(shape.s);
  }
}

// A section that rotates while it moves along z, closed or not, in either order of the parameters.
static Shape twisted_shape(int k) {
  Shape shape = {.closed = {k % 2, false}};
  CagVec3 p[9];
  CagCurve *c;
  const double turn = (k % 4 < 2 ? 1 : -1) * uniform(1, 3) * M_PI;
  const double scale = k % 3 ? 1 : uniform(0.7, 1.3);
  for (int i = 0; i < 9; i++) {
    const double r = uniform(4, 6), a = 2 * M_PI * i / 9;
    p[i] = cag_vec3(r * cos(a), r * sin(a), 0);
  }
  if (shape.closed[0]) OK(cag_curve_nurbs_closed(p, NULL, 9, 3, 2, &c, &err));
  else OK(cag_curve_bezier(p, NULL, 4, 2, &c, &err));
  OK(cag_surface_extrude(c, cag_vec3(0, 0, 15), turn, scale, &shape.s, &err));
  cag_curve_release(c);
  if (k / 2 % 2) {
    CagSurface *t;
    OK(cag_surface_transpose(shape.s, &t, &err));
    cag_surface_release(shape.s);
    shape.s = t;
  }
  return shape;
}

// Most of them need strips of long triangles, which are far fewer than those of grids. The bound is
// the number that was needed.
static void meshes_of_twisted_sections_are_sound(void **state) {
  (void)state;
  double sum = 0;
  seed = 68;
  for (int k = 0; k < 32; k++) {
    const Shape shape = twisted_shape(k);
    const CagTessellation how = {.tolerance = exp(uniform(-4, -2.5)),
                                 .angle = k % 3 ? uniform(0.3, 0.8) : 0,
                                 .max_edge = k % 5 ? 0 : uniform(2, 4),
                                 .max_triangles = 100000};
    sum += check_mesh(&shape, &how);
    cag_surface_release(shape.s);
  }
  assert_true(sum <= 63450);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(meshes_of_random_nets_are_sound),
      cmocka_unit_test(meshes_of_twisted_sections_are_sound),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
