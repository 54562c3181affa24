// Smooth normals of meshes.

#include "geom/mesh/smooth.h"

#include "tests/geom/support.h"

#define CREASE (40 * M_PI / 180)

// A prism over a regular polygon about z, from z = 0 to 10, with flat caps; no normals.
static CagMesh *prism(uint32_t sides, double radius) {
  CagVec3 points[64];
  uint32_t indices[256], counts[64];
  size_t n = 0;
  assert_true(2 * sides <= 64);
  for (uint32_t i = 0; i < sides; i++) {
    const double t = 2 * M_PI * i / sides;
    points[i] = cag_vec3(radius * cos(t), radius * sin(t), 0);
    points[sides + i] = cag_vec3(radius * cos(t), radius * sin(t), 10);
    const uint32_t next = (i + 1) % sides;
    const uint32_t quad[4] = {i, next, sides + next, sides + i};
    memcpy(indices + n, quad, sizeof quad);
    n += 4;
    counts[i] = 4;
  }
  for (uint32_t i = 0; i < sides; i++) indices[n++] = sides - 1 - i;
  for (uint32_t i = 0; i < sides; i++) indices[n++] = sides + i;
  counts[sides] = counts[sides + 1] = sides;
  CagMesh *m;
  OK(cag_mesh_from_faces(points, 2 * (size_t)sides, indices, counts, sides + 2, &m, &err));
  return m;
}

static CagVec3 triangle_normal(const CagMesh *m, size_t t) {
  const uint32_t *v = m->triangles + 3 * t;
  const CagVec3 a = m->positions[v[0]];
  return cag_unit(cag_cross(cag_sub(m->positions[v[1]], a), cag_sub(m->positions[v[2]], a)));
}

static CagMesh *smooth(CagMesh *m) {
  CagMesh *out;
  OK(cag_mesh_smooth(m, CREASE, &out, &err));
  assert_int_equal(out->triangle_count, m->triangle_count);
  assert_true(cag_check_mesh(out));
  assert_true(cag_mesh_is_watertight(out, NULL));
  return out;
}

// By symmetry, the normals of the sides point away from the axis; the caps stay flat.
static void sides_of_prisms_become_round(void **state) {
  (void)state;
  CagMesh *m = prism(24, 5), *s = smooth(m);
  assert_int_equal(s->vertex_count, 4 * 24);
  for (size_t c = 0; c < 3 * s->triangle_count; c++) {
    const CagVec3 own = triangle_normal(s, c / 3), p = s->positions[s->triangles[c]];
    const CagVec3 n = s->normals[s->triangles[c]];
    const CagVec3 expected =
        fabs(own.z) > 0.5 ? cag_vec3(0, 0, own.z > 0 ? 1 : -1) : cag_vec3(p.x / 5, p.y / 5, 0);
    NEAR(cag_norm(cag_sub(n, expected)), 0, 1e-12);
  }
  cag_mesh_release(s);
  cag_mesh_release(m);
}

// The sides of a hexagon turn by 60 degrees.
static void creases_stay_sharp(void **state) {
  (void)state;
  CagMesh *m = prism(6, 5), *s = smooth(m);
  for (size_t c = 0; c < 3 * s->triangle_count; c++)
    NEAR(cag_norm(cag_sub(s->normals[s->triangles[c]], triangle_normal(s, c / 3))), 0, 1e-12);
  cag_mesh_release(s);
  cag_mesh_release(m);
}

// Where a triangle has a normal that is not its own, its neighbors take it over.
static void normals_of_surfaces_are_kept(void **state) {
  (void)state;
  CagMesh *m = prism(24, 5), *given = smooth(m), *s;
  const CagVec3 tilted = cag_unit(cag_vec3(1, 0.05, 0));
  // A vertex of the sides at the angle 0.
  for (size_t v = 0; v < given->vertex_count; v++)
    if (given->positions[v].x == 5 && given->normals[v].x > 0.9) given->normals[v] = tilted;
  s = smooth(given);
  size_t n = 0;
  for (size_t v = 0; v < s->vertex_count; v++)
    if (s->positions[v].x == 5 && s->normals[v].x > 0.9) {
      NEAR(cag_norm(cag_sub(s->normals[v], tilted)), 0, 1e-12);
      n++;
    }
  assert_int_equal(n, 2);
  cag_mesh_release(s);
  cag_mesh_release(given);
  cag_mesh_release(m);
}

// The rim of a large flat face next to narrow strips: the face keeps its normal.
static void large_faces_stay_flat(void **state) {
  (void)state;
  // A roof of slopes 0, 20, and 40 degrees above a floor; the strips are 0.1 wide.
  const double a = 20 * M_PI / 180;
  const CagVec3 outline[] = {
      {0, 0, 0},
      {0, 0, 10},
      {10, 0, 10},
      {10 + 0.1 * cos(a), 0, 10 - 0.1 * sin(a)},
      {10 + 0.1 * (cos(a) + cos(2 * a)), 0, 10 - 0.1 * (sin(a) + sin(2 * a))},
      {10 + 0.1 * (cos(a) + cos(2 * a)), 0, 0}};
  enum { N = 6 };
  CagVec3 points[2 * N];
  uint32_t indices[8 * N], counts[N + 2];
  size_t n = 0;
  for (uint32_t i = 0; i < N; i++) {
    points[i] = outline[i];
    points[N + i] = cag_add(outline[i], cag_vec3(0, 10, 0));
    const uint32_t next = (i + 1) % N, quad[4] = {i, N + i, N + next, next};
    memcpy(indices + n, quad, sizeof quad);
    n += 4;
    counts[i] = 4;
  }
  for (uint32_t i = 0; i < N; i++) indices[n++] = i;
  for (uint32_t i = 0; i < N; i++) indices[n++] = 2 * N - 1 - i;
  counts[N] = counts[N + 1] = N;
  CagMesh *m, *outward;
  OK(cag_mesh_from_faces(points, (size_t)2 * N, indices, counts, N + 2, &m, &err));
  double terms[10];
  cag_mesh_volume_terms(m, terms);
  if (terms[0] < 0) OK(cag_mesh_flip(m, &outward, &err));
  else outward = cag_mesh_retain(m);
  CagMesh *s = smooth(outward);
  for (size_t c = 0; c < 3 * s->triangle_count; c++) {
    if (triangle_normal(s, c / 3).z < 0.9999) continue;
    // The strip's share is (1 / 100)^2.
    assert_true(s->normals[s->triangles[c]].z > cos(1e-4));
  }
  cag_mesh_release(s);
  cag_mesh_release(outward);
  cag_mesh_release(m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sides_of_prisms_become_round),
      cmocka_unit_test(creases_stay_sharp),
      cmocka_unit_test(normals_of_surfaces_are_kept),
      cmocka_unit_test(large_faces_stay_flat),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
