// Rays at meshes: crossings are those of each triangle alone, computed in long double, and all copies
// of the code for other processors give the same results.

#include <stdlib.h>
#include <string.h>

#include "geom/ray/ray_mesh.h"
#include "tests/geom/random.h"
#include "tests/geom/surface_support.h"

static double signed_random(void) { return 2 * uniform(0, 1) - 1; }

static CagVec3 random_in_cube(double side) {
  return cag_vec3(side * signed_random(), side * signed_random(), side * signed_random());
}

// A bumpy torus of 2 side^2 triangles, whose bumps and whose triangles differ in size. Its last
// triangles, which are as large as everything, stand across it.
static CagMesh *bumpy_torus(uint32_t side, CagVec3 center, double scale) {
  const uint32_t points = side * side;
  CagMesh *m = NULL;
  MUST(cag_mesh_new((size_t)points + 3, 2 * (size_t)points + 2, false, false, false, &m, err));
  for (uint32_t i = 0; i < side; i++)
    for (uint32_t k = 0; k < side; k++) {
      const double u = 2 * M_PI * pow((double)i / side, 3), v = 2 * M_PI * k / side;
      const double r = 1 + 0.1 * sin(7 * u) * sin(9 * v);
      const uint32_t a = i * side + k, b = (i + 1) % side * side + k;
      const uint32_t c = (i + 1) % side * side + (k + 1) % side, d = i * side + (k + 1) % side;
      const uint32_t corners[6] = {a, b, c, a, c, d};
      const CagVec3 p = cag_vec3((3 + r * cos(v)) * cos(u), (3 + r * cos(v)) * sin(u), r * sin(v));
      m->positions[a] = cag_madd(center, scale, p);
      memcpy(m->triangles + 6 * (size_t)a, corners, sizeof corners);
    }
  const uint32_t large[6] = {points, points + 1, points + 2, points, points + 2, points + 1};
  m->positions[points] = cag_madd(center, scale, cag_vec3(-4, -4, -1));
  m->positions[points + 1] = cag_madd(center, scale, cag_vec3(4, -4, 0.5));
  m->positions[points + 2] = cag_madd(center, scale, cag_vec3(0.3, 4, 1));
  memcpy(m->triangles + 6 * (size_t)points, large, sizeof large);
  return m;
}

// The parameter at which the ray meets a triangle, by Cramer's rule (Moeller and Trumbore 1997), or
// NaN. *doubtful: the ray passes an edge so closely that rounding may decide.
static long double meet_alone(const CagMesh *m, size_t face, const CagRay *ray, bool *doubtful) {
  const uint32_t *t = m->triangles + 3 * face;
  long double e[3], f[3], s[3], p[3], q[3];
  const CagVec3 *a = &m->positions[t[0]], *b = &m->positions[t[1]], *c = &m->positions[t[2]];
  const double d[3] = {ray->direction.x, ray->direction.y, ray->direction.z};
  for (int k = 0; k < 3; k++) {
    const double origin = k == 0 ? ray->origin.x : k == 1 ? ray->origin.y : ray->origin.z;
    const double from = k == 0 ? a->x : k == 1 ? a->y : a->z;
    e[k] = (long double)(k == 0 ? b->x : k == 1 ? b->y : b->z) - from;
    f[k] = (long double)(k == 0 ? c->x : k == 1 ? c->y : c->z) - from;
    s[k] = (long double)origin - from;
  }
  for (int k = 0; k < 3; k++) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    p[k] = d[i] * f[j] - d[j] * f[i];
    q[k] = s[i] * e[j] - s[j] * e[i];
  }
  const long double volume = e[0] * p[0] + e[1] * p[1] + e[2] * p[2];
  const long double u = (s[0] * p[0] + s[1] * p[1] + s[2] * p[2]) / volume;
  const long double v = (d[0] * q[0] + d[1] * q[1] + d[2] * q[2]) / volume;
  const long double least = fminl(fminl(u, v), 1 - u - v);
  *doubtful = *doubtful || !(fabsl(least) > 1e-7L);
  return least < 0 ? NAN : (f[0] * q[0] + f[1] * q[1] + f[2] * q[2]) / volume;
}

static void assert_first_is_first(const CagRayMesh *m, const CagRay *ray, double size) {
  const CagMesh *mesh = m->mesh;
  long double least = INFINITY;
  bool doubtful = false;
  CagCrossing c;
  for (size_t i = 0; i < mesh->triangle_count; i++) {
    const long double t = meet_alone(mesh, i, ray, &doubtful);
    if (t > ray->least && t <= ray->most && t < least) least = t;
  }
  if (doubtful) return;
  const bool met = cag_ray_mesh_first(m, ray, &c);
  if (met != cag_ray_mesh_blocks(m, ray)) fail_msg("blocks and first differ");
  if (met != (least < INFINITY)) fail_msg("%s, expected %Lg", met ? "met" : "missed", least);
  if (met) assert_near(c.t, (double)least, 1e-12 * size, "parameter");
}

// Of any place and size: what is rounded to floats depends on them.
static void first_crossings_are_those_of_single_triangles(void **state) {
  (void)state;
  const double sizes[] = {1, 1e-25, 1e15};
  for (int s = 0; s < 3; s++)
    for (int far = 0; far < 2; far++) {
      const double size = sizes[s];
      const CagVec3 center = random_in_cube(far ? 1000 * size : 0);
      CagMesh *mesh = bumpy_torus(24, center, size);
      CagRayMesh *m = NULL;
      MUST(cag_ray_mesh_new(mesh, &m, err));
      for (int k = 0; k < 1500; k++) {
        const CagVec3 from = cag_add(center, random_in_cube(6 * size));
        const CagVec3 to = cag_add(center, random_in_cube(3 * size));
        const CagRay ray = {from, cag_unit(cag_sub(to, from)), k % 4 ? 0 : -INFINITY,
                            k % 3 ? INFINITY : 5 * size};
        assert_first_is_first(m, &ray, far ? 10000 * size : 10 * size);
      }
      cag_ray_mesh_free(m);
      cag_mesh_release(mesh);
    }
}

static void assert_same_crossing(const CagCrossing *a, const CagCrossing *b) {
  if (a->t != b->t || a->face != b->face || a->sign != b->sign || a->normal.x != b->normal.x ||
      a->weight[0] != b->weight[0] || a->weight[1] != b->weight[1])
    fail_msg("triangle %u at %.17g, and triangle %u at %.17g", a->face, a->t, b->face, b->t);
}

static int by_face(const void *a, const void *b) {
  const CagCrossing *x = a, *y = b;
  return (x->face > y->face) - (x->face < y->face);
}

// Compares the results of two meshes that differ only in how they find triangles.
static void assert_same_results(const CagRayMesh *m, const CagRayMesh *other, const CagRay *ray,
                                CagCrossings list[2]) {
  CagCrossing c[2];
  const bool met = cag_ray_mesh_first(m, ray, &c[0]);
  if (met != cag_ray_mesh_first(other, ray, &c[1])) fail_msg("one of them is not met");
  if (met) assert_same_crossing(&c[0], &c[1]);
  assert_true(cag_ray_mesh_blocks(m, ray) == cag_ray_mesh_blocks(other, ray));
  assert_true(cag_ray_mesh_contains(m, ray->origin, 0) ==
              cag_ray_mesh_contains(other, ray->origin, 0));
  list[0].n = list[1].n = 0;
  MUST(cag_ray_mesh_all(m, ray, &list[0], err));
  MUST(cag_ray_mesh_all(other, ray, &list[1], err));
  assert_int_equal(list[0].n, list[1].n);
  for (int k = 0; k < 2; k++)
    if (list[k].n) qsort(list[k].items, list[k].n, sizeof *list[k].items, by_face);
  for (size_t i = 0; i < list[0].n; i++) assert_same_crossing(&list[0].items[i], &list[1].items[i]);
}

// Half of the rays aim at corners or middles of edges, some of them from corners.
static CagRay aimed_ray(const CagMesh *m, CagVec3 center, int k) {
  const uint32_t *t = m->triangles + 3 * (size_t)(uniform(0, 1) * (double)m->triangle_count);
  const CagVec3 a = m->positions[t[0]], b = m->positions[t[1]];
  const CagVec3 to = k % 4 == 0   ? a
                     : k % 4 == 1 ? cag_lerp(a, b, 0.5)
                                  : cag_add(center, random_in_cube(4));
  const CagVec3 from = k % 5 ? cag_add(center, random_in_cube(5))
                             : m->positions[(size_t)(uniform(0, 1) * (double)m->vertex_count)];
  return (CagRay){from, cag_unit(cag_sub(to, from)), k % 3 ? 0 : -INFINITY, k % 7 ? INFINITY : 3};
}

// Compares a mesh with one that uses the code for any processor.
static void assert_copies_agree(const CagRayMesh *m, CagVec3 center) {
  CagRayMesh other = *m;
  CagCrossings list[2] = {{0}, {0}};
  other.casts = &cag_ray_mesh_casts;
  for (int k = 0; k < 60000; k++) {
    const CagRay ray = aimed_ray(m->mesh, center, k);
    assert_same_results(m, &other, &ray, list);
  }
  cag_crossings_free(&list[0]);
  cag_crossings_free(&list[1]);
}

static void all_copies_give_the_same_results(void **state) {
  (void)state;
  for (int far = 0; far < 2; far++) {
    const CagVec3 center = random_in_cube(far ? 1e5 : 0);
    CagMesh *mesh = bumpy_torus(100, center, 1);
    CagRayMesh *m = NULL;
    MUST(cag_ray_mesh_new(mesh, &m, err));
    assert_copies_agree(m, center);
#ifdef CAG_EMBREE
    if (!m->embree) cag_ray_mesh_use_embree(m);
    assert_non_null(m->embree);
    assert_copies_agree(m, center);
#endif
    cag_ray_mesh_free(m);
    cag_mesh_release(mesh);
  }
}

// A sheet of two triangles that share an edge along which many rays pass: each ray through the
// square meets exactly one of them.
static void rays_through_an_edge_meet_one_of_its_triangles(void **state) {
  (void)state;
  CagMesh *mesh = NULL;
  CagRayMesh *m = NULL;
  CagCrossings list = {0};
  const CagVec3 corners[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const uint32_t indices[6] = {0, 1, 2, 0, 2, 3}, counts[2] = {3, 3};
  MUST(cag_mesh_from_faces(corners, 4, indices, counts, 2, &mesh, err));
  MUST(cag_ray_mesh_new(mesh, &m, err));
  for (int k = 0; k < 20000; k++) {
    const double at = 0.01 + 0.98 * uniform(0, 1);
    const CagVec3 to = cag_vec3(at, at, 0);
    const CagVec3 from = cag_vec3(signed_random(), signed_random(), k % 2 ? 1 : -1e-3);
    const CagRay ray = {from, cag_unit(cag_sub(to, from)), 0, INFINITY};
    list.n = 0;
    MUST(cag_ray_mesh_all(m, &ray, &list, err));
    assert_int_equal(list.n, 1);
    assert_near(list.items[0].t, cag_norm(cag_sub(to, from)), 1e-12, "parameter");
  }
  cag_crossings_free(&list);
  cag_ray_mesh_free(m);
  cag_mesh_release(mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(first_crossings_are_those_of_single_triangles),
      cmocka_unit_test(all_copies_give_the_same_results),
      cmocka_unit_test(rays_through_an_edge_meet_one_of_its_triangles),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
