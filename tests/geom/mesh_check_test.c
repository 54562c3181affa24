// Checks of faces as boundaries: counts for known bodies, intact and damaged.

#include "geom/mesh/check.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

static const CagVec3 cube_vertices[8] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                         {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
static const uint32_t cube_faces[24] = {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4,
                                        1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
static const uint32_t fours[6] = {4, 4, 4, 4, 4, 4};
static const uint32_t threes[8] = {3, 3, 3, 3, 3, 3, 3, 3};

static void a_cube_is_a_solid(void **state) {
  (void)state;
  CagMeshCheck c;
  OK(cag_faces_check(cube_vertices, 8, cube_faces, fours, 6, &c, &err));
  assert_int_equal(c.vertices, 8);
  assert_int_equal(c.edges, 12);
  assert_int_equal(c.faces, 6);
  assert_int_equal(c.euler, 2);
  assert_int_equal(c.shells, 1);
  assert_int_equal(c.genus, 0);
  assert_true(c.closed && c.oriented && c.solid);
  NEAR(c.volume, 1, 1e-15);
}

static void the_mesh_of_a_cube_is_the_same_body(void **state) {
  (void)state;
  CagMesh *m;
  CagMeshCheck c;
  OK(cag_mesh_from_faces(cube_vertices, 8, cube_faces, fours, 6, &m, &err));
  OK(cag_mesh_check(m, &c, &err));
  assert_int_equal(c.edges, 18); // with six more diagonals
  assert_int_equal(c.faces, 12);
  assert_int_equal(c.euler, 2);
  assert_true(c.solid);
  NEAR(c.volume, 1, 1e-15);
  cag_mesh_release(m);
}

static void a_missing_and_a_turned_face_are_told(void **state) {
  (void)state;
  CagMeshCheck c;
  OK(cag_faces_check(cube_vertices, 8, cube_faces, fours, 5, &c, &err));
  assert_int_equal(c.boundary_edges, 4);
  assert_int_equal(c.euler, 1);
  assert_true(!c.closed && c.oriented && !c.solid);
  uint32_t turned[24];
  memcpy(turned, cube_faces, sizeof turned);
  turned[0] = 1, turned[1] = 2, turned[2] = 3, turned[3] = 0;
  OK(cag_faces_check(cube_vertices, 8, turned, fours, 6, &c, &err));
  assert_int_equal(c.boundary_edges, 0);
  assert_true(c.closed && !c.oriented && !c.solid);
}

static void inside_out_has_a_negative_volume(void **state) {
  (void)state;
  CagMeshCheck c;
  uint32_t out[24];
  for (int i = 0; i < 24; i++) out[i] = cube_faces[23 - i];
  OK(cag_faces_check(cube_vertices, 8, out, fours, 6, &c, &err));
  assert_true(c.closed && c.oriented && !c.solid);
  NEAR(c.volume, -1, 1e-15);
}

// Two tetrahedra with a common corner: two shells, each of genus 0.
static void bodies_that_touch_in_a_vertex_are_no_solid(void **state) {
  (void)state;
  const CagVec3 p[] = {{0, 0, 0},  {1, 0, 0},  {0, 1, 0}, {0, 0, 1},
                       {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  const uint32_t faces[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3, 0, 4, 5, 0, 6, 4, 0, 5, 6, 4, 6, 5};
  CagMeshCheck c;
  OK(cag_faces_check(p, 7, faces, threes, 8, &c, &err));
  assert_int_equal(c.edges, 12);
  assert_int_equal(c.euler, 3);
  assert_int_equal(c.shells, 2);
  assert_int_equal(c.nonmanifold_vertices, 1);
  assert_int_equal(c.genus, 0);
  assert_true(c.closed && c.oriented && !c.solid);
  NEAR(c.volume, 2 / 6.0, 1e-15);
}

// A fin on the edge of two triangles.
static void an_edge_of_three_faces_is_told(void **state) {
  (void)state;
  const CagVec3 p[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
  const uint32_t faces[] = {0, 1, 2, 1, 0, 3, 0, 1, 4};
  CagMeshCheck c;
  OK(cag_faces_check(p, 5, faces, threes, 3, &c, &err));
  assert_int_equal(c.nonmanifold_edges, 1);
  assert_int_equal(c.boundary_edges, 6);
  assert_int_equal(c.shells, 1);
  assert_int_equal(c.nonmanifold_vertices, 0);
  assert_true(!c.closed && !c.oriented);
}

// A ring of 6 by 12 quadrilaterals, joined at both ends: a torus with 72 vertices, 144 edges, and
// 72 faces. A vertex that no face uses is not counted.
static void a_torus_has_a_handle(void **state) {
  (void)state;
  enum { M = 6, N = 12 };
  CagVec3 p[M * N + 1];
  uint32_t faces[4 * M * N], counts[M * N];
  const double step = 3.14159265358979323846 / 6;
  for (uint32_t i = 0; i < M; i++)
    for (uint32_t j = 0; j < N; j++) {
      double r = 3 + cos(2 * step * i), around = step * j;
      p[i * N + j] = cag_vec3(r * cos(around), r * sin(around), sin(2 * step * i));
      uint32_t *f = faces + 4 * (i * N + j), next_i = (i + 1) % M, next_j = (j + 1) % N;
      counts[i * N + j] = 4;
      f[0] = i * N + j;
      f[1] = i * N + next_j;
      f[2] = next_i * N + next_j;
      f[3] = next_i * N + j;
    }
  p[M * N] = cag_vec3(9, 9, 9);
  CagMeshCheck c;
  OK(cag_faces_check(p, M * N + 1, faces, counts, M * N, &c, &err));
  assert_int_equal(c.vertices, 72);
  assert_int_equal(c.edges, 144);
  assert_int_equal(c.euler, 0);
  assert_int_equal(c.genus, 1);
  assert_true(c.solid);
}

static void bad_faces_are_named(void **state) {
  (void)state;
  CagMeshCheck c;
  const uint32_t twice[] = {0, 1, 2, 1}, beyond[] = {0, 1, 9}, two[] = {2};
  FAILS_AT(cag_faces_check(cube_vertices, 8, twice, fours, 1, &c, &err), "face-degenerate", 0);
  FAILS_AT(cag_faces_check(cube_vertices, 8, twice, two, 1, &c, &err), "face-degenerate", 0);
  FAILS_AT(cag_faces_check(cube_vertices, 8, beyond, threes, 1, &c, &err), "face-index", 0);
  CagVec3 p[3] = {{0, 0, 0}, {1, 0, 0}, {0, NAN, 0}};
  FAILS_AT(cag_faces_check(p, 3, cube_faces, threes, 0, &c, &err), "vertex-not-finite", 2);
  OK(cag_faces_check(cube_vertices, 8, cube_faces, fours, 0, &c, &err));
  assert_true(!c.closed && c.euler == 0);
}

// --- Random faces ---

// Counts how often a face has the edge from a to b.
static int runs(const uint32_t *face, uint32_t count, uint32_t a, uint32_t b) {
  int n = 0;
  for (uint32_t k = 0; k < count; k++) n += face[k] == a && face[(k + 1) % count] == b;
  return n;
}
static bool names(const uint32_t *face, uint32_t count, uint32_t v) {
  for (uint32_t k = 0; k < count; k++)
    if (face[k] == v) return true;
  return false;
}

// Joins two parts: all numbers x become y.
static void join_parts(size_t *part, size_t n, size_t x, size_t y) {
  for (size_t i = 0; i < n; i++)
    if (part[i] == x) part[i] = y;
}
static size_t count_parts(const size_t *part, size_t n) {
  size_t parts = 0;
  for (size_t i = 0; i < n; i++) {
    bool first = part[i] != SIZE_MAX;
    for (size_t j = 0; j < i; j++) first = first && part[j] != part[i];
    parts += first;
  }
  return parts;
}

// All counts by comparing every pair of vertices and faces. The faces are some of a cube and random
// ones, reversed or not, some of them repeated.
static void counts_are_those_of_all_pairs(void **state) {
  (void)state;
  enum { MOST = 12, POINTS = 8 };
  seed = 41;
  int solids = 0;
  for (int k = 0; k < 600; k++) {
    uint32_t indices[4 * MOST], counts[MOST], *face[MOST], at = 0;
    size_t n = 0;
    // All or some faces of the cube, followed by others.
    for (int f = 0; f < 6; f++)
      if (k % 3 == 0 || uniform(0, 1) < 0.6) {
        face[n] = indices + at, counts[n++] = 4;
        const bool turned = k % 3 > 0 && uniform(0, 1) < 0.2;
        for (int i = 0; i < 4; i++) indices[at++] = cube_faces[4 * f + (turned ? 3 - i : i)];
      }
    for (int more = k % 3 ? (int)uniform(0, 6) : 0; more > 0; more--) {
      const uint32_t count = 3 + (uint32_t)uniform(0, 2);
      face[n] = indices + at, counts[n++] = count;
      for (uint32_t i = 0; i < count; i++) {
        uint32_t v;
        do v = (uint32_t)uniform(0, POINTS);
        while (names(face[n - 1], i, v));
        indices[at++] = v;
      }
    }
    size_t edges = 0, boundary = 0, crowded = 0, vertices = 0, fans = 0, touched = 0;
    size_t shell[MOST];
    bool oriented = true;
    for (size_t f = 0; f < n; f++) shell[f] = f;
    for (uint32_t a = 0; a < POINTS; a++)
      for (uint32_t b = a + 1; b < POINTS; b++) {
        int there = 0, back = 0;
        size_t first = SIZE_MAX;
        for (size_t f = 0; f < n; f++) {
          const int x = runs(face[f], counts[f], a, b), y = runs(face[f], counts[f], b, a);
          there += x, back += y;
          if (x + y == 0) continue;
          if (first == SIZE_MAX) first = f;
          else join_parts(shell, n, shell[f], shell[first]);
        }
        edges += there + back > 0;
        boundary += there + back == 1;
        crowded += there + back > 2;
        if (there > 1 || back > 1) oriented = false;
      }
    for (uint32_t v = 0; v < POINTS; v++) {
      size_t fan[MOST];
      for (size_t f = 0; f < n; f++) fan[f] = names(face[f], counts[f], v) ? f : SIZE_MAX;
      for (uint32_t w = 0; w < POINTS; w++) { // faces with the edge from v to w
        size_t first = SIZE_MAX;
        for (size_t f = 0; f < n; f++) {
          if (runs(face[f], counts[f], v, w) + runs(face[f], counts[f], w, v) == 0) continue;
          if (first == SIZE_MAX) first = f;
          else join_parts(fan, n, fan[f], fan[first]);
        }
      }
      const size_t here = count_parts(fan, n);
      vertices += here > 0;
      fans += here;
      touched += here > 1;
    }
    const bool closed = n > 0 && boundary == 0 && crowded == 0;
    const long euler = (long)vertices - (long)edges + (long)n;
    CagMeshCheck c;
    OK(cag_faces_check(cube_vertices, POINTS, indices, counts, n, &c, &err));
    assert_int_equal(c.vertices, vertices);
    assert_int_equal(c.edges, edges);
    assert_int_equal(c.faces, n);
    assert_int_equal(c.euler, euler);
    assert_int_equal(c.shells, count_parts(shell, n));
    assert_int_equal(c.boundary_edges, boundary);
    assert_int_equal(c.nonmanifold_edges, crowded);
    assert_int_equal(c.nonmanifold_vertices, touched);
    assert_int_equal(c.closed, closed);
    assert_int_equal(c.oriented, oriented);
    if (!closed || !oriented) {
      assert_false(c.solid);
      continue;
    }
    solids += c.solid;
    assert_int_equal(c.genus, (long)c.shells - (euler + (long)(fans - vertices)) / 2);
    double volume = 0; // fans from the first corners, seen from a point that is not a vertex
    for (size_t f = 0; f < n; f++)
      for (uint32_t i = 1; i + 1 < counts[f]; i++) {
        const CagVec3 tip = {0.3, -4, 7};
        volume += cag_dot(cag_sub(cube_vertices[face[f][0]], tip),
                          cag_cross(cag_sub(cube_vertices[face[f][i]], tip),
                                    cag_sub(cube_vertices[face[f][i + 1]], tip))) /
                  6;
      }
    NEAR(c.volume, volume, 1e-13);
    assert_int_equal(c.solid, touched == 0 && volume > 0);
  }
  assert_true(solids > 100);
}

// Triangles of a welded mesh that degenerate to edges or points are ignored.
static void shrunk_triangles_do_not_count(void **state) {
  (void)state;
  static const uint32_t triangles[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3, // a tetrahedron
                                       0, 4, 1, 4, 0, 2, 1, 0, 4, 4, 3, 0, 4, 5, 0};
  CagMesh *m;
  CagMeshCheck c;
  OK(cag_mesh_new(6, 9, false, false, true, &m, &err));
  const CagVec3 p[6] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}, {0, 0, 0}};
  memcpy(m->positions, p, sizeof p);
  memcpy(m->triangles, triangles, sizeof triangles);
  for (uint32_t v = 0; v < 6; v++) m->weld[v] = v < 4 ? v : 0;
  OK(cag_mesh_check(m, &c, &err));
  assert_int_equal(c.faces, 4);
  assert_int_equal(c.vertices, 4);
  assert_true(c.solid);
  NEAR(c.volume, 1.0 / 6, 1e-16);
  cag_mesh_release(m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_cube_is_a_solid),
      cmocka_unit_test(the_mesh_of_a_cube_is_the_same_body),
      cmocka_unit_test(a_missing_and_a_turned_face_are_told),
      cmocka_unit_test(inside_out_has_a_negative_volume),
      cmocka_unit_test(bodies_that_touch_in_a_vertex_are_no_solid),
      cmocka_unit_test(an_edge_of_three_faces_is_told),
      cmocka_unit_test(a_torus_has_a_handle),
      cmocka_unit_test(counts_are_those_of_all_pairs),
      cmocka_unit_test(shrunk_triangles_do_not_count),
      cmocka_unit_test(bad_faces_are_named),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
