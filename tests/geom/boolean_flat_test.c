// Faces of set operations: planar ones have as few triangles as their outlines allow, normals are
// those of the operands, and parts that touch do not have vertices in common.

#include "geom/boolean/boolean.h"
#include "geom/linalg/transform.h"
#include "tests/geom/support.h"

static uint64_t seed;
static int random_int(int n) {
  seed = seed * 6364136223846793005u + 1442695040888963407u;
  return (int)((double)(seed >> 11) / 9007199254740992.0 * n);
}

enum { CELLS = 4, ROW = CELLS + 2 };
typedef bool Cells[ROW][ROW][ROW]; // with an empty margin

// A box whose vertices have the normals of their sides.
static CagMesh *box_with_normals(CagVec3 a, CagVec3 b) {
  static const uint32_t faces[24] = {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4,
                                     1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
  static const uint32_t fours[6] = {4, 4, 4, 4, 4, 4};
  const CagVec3 v[8] = {{a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z},
                        {a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}};
  CagMesh *plain, *m;
  OK(cag_mesh_from_faces(v, 8, faces, fours, 6, &plain, &err));
  OK(cag_mesh_new(36, 12, true, false, true, &m, &err));
  for (uint32_t t = 0; t < 12; t++) {
    const uint32_t *k = plain->triangles + 3 * (size_t)t;
    const CagVec3 *p = plain->positions;
    const CagVec3 n = cag_unit(cag_cross(cag_sub(p[k[1]], p[k[0]]), cag_sub(p[k[2]], p[k[0]])));
    for (uint32_t i = 0; i < 3; i++) {
      const uint32_t c = 3 * t + i;
      m->positions[c] = p[k[i]];
      m->normals[c] = n;
      m->triangles[c] = m->weld[c] = c;
      for (uint32_t j = c; j-- > 0;)
        if (memcmp(&m->positions[j], &m->positions[c], sizeof(CagVec3)) == 0) m->weld[c] = j;
    }
  }
  cag_mesh_release(plain);
  return m;
}

// Counts the parts formed by the cells of a 2 x 2 x 2 block with the given value, where cells are
// connected by their sides.
static int parts_of_block(const bool block[8], bool value) {
  int part[8], count = 0;
  for (int i = 0; i < 8; i++) part[i] = i;
  for (int round = 0; round < 8; round++)
    for (int i = 0; i < 8; i++)
      for (int bit = 1; bit < 8; bit *= 2)
        if (block[i] == value && block[i ^ bit] == value && part[i ^ bit] < part[i])
          part[i] = part[i ^ bit];
  for (int i = 0; i < 8; i++) count += block[i] == value && part[i] == i;
  return count;
}

// The number of triangles needed for the body of the cells, by Euler's formula: two for each
// corner, minus two for each sphere, and so on. Returns -1 if the body touches itself along an edge
// or at a corner.
static long triangles_needed(Cells g) {
  long corners = 0, euler = 0;
  for (int x = 0; x + 1 < ROW; x++)
    for (int y = 0; y + 1 < ROW; y++)
      for (int z = 0; z + 1 < ROW; z++) {
        bool block[8], straight = false;
        int faces = 0, edges = 0;
        for (int i = 0; i < 8; i++) block[i] = g[x + (i & 1)][y + (i >> 1 & 1)][z + (i >> 2)];
        if (parts_of_block(block, true) > 1 || parts_of_block(block, false) > 1) return -1;
        for (int bit = 1; bit < 8; bit *= 2) { // the same on both sides: flat, or an edge
          bool same = true;
          for (int i = 0; i < 8; i++) same = same && block[i] == block[i ^ bit];
          straight = straight || same;
        }
        // The squares and edges of the boundary that start at this point in the positive
        // directions.
        for (int bit = 1; bit < 8; bit *= 2) faces += block[7] != block[7 ^ bit];
        for (int bit = 1; bit < 8; bit *= 2) {
          const int a = bit == 1 ? 2 : 1, b = bit == 4 ? 2 : 4;
          edges +=
              block[7] != block[7 ^ a] || block[7] != block[7 ^ b] || block[7] != block[7 ^ a ^ b];
        }
        const bool is_point = parts_of_block(block, true) == 1 && parts_of_block(block, false) == 1;
        corners += is_point && !straight;
        euler += is_point - edges + faces;
      }
  return 2 * (corners - euler);
}

// Checks that each normal is that of its triangle, which is that of a side of a cell.
static void check_flat_normals(const CagMesh *m) {
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    const CagVec3 *p = m->positions;
    const CagVec3 n = cag_unit(cag_cross(cag_sub(p[k[1]], p[k[0]]), cag_sub(p[k[2]], p[k[0]])));
    for (int i = 0; i < 3; i++) near_vec(m->normals[k[i]], n, 1e-9);
  }
}

static void boxes_of_a_grid_take_as_few_triangles_as_they_need(void **state) {
  (void)state;
  seed = 41;
  int checked = 0;
  for (int trial = 0; trial < 100; trial++) {
    Cells g = {{{false}}};
    CagTransform t = cag_transform_identity();
    double det = 1;
    // Every other trial is sheared, with integer corners.
    for (int i = 0; trial % 2 && i < 9; i++) t.m[i / 3][i % 3] = random_int(5) - 2;
    det = t.m[0][0] * (t.m[1][1] * t.m[2][2] - t.m[1][2] * t.m[2][1]) +
          t.m[0][1] * (t.m[1][2] * t.m[2][0] - t.m[1][0] * t.m[2][2]) +
          t.m[0][2] * (t.m[1][0] * t.m[2][1] - t.m[1][1] * t.m[2][0]);
    if (det == 0) continue;
    CagMesh *body;
    OK(cag_mesh_new(0, 0, true, false, false, &body, &err));
    for (int step = 0; step < 5; step++) {
      int low[3], high[3], count = 0;
      for (int k = 0; k < 3; k++) {
        low[k] = random_int(CELLS);
        high[k] = low[k] + 1 + random_int(CELLS - low[k]);
      }
      const bool add = step < 2 || random_int(2);
      CagMesh *straight =
          box_with_normals(cag_vec3(low[0], low[1], low[2]), cag_vec3(high[0], high[1], high[2]));
      CagMesh *b, *m;
      OK(cag_mesh_transform(straight, &t, &b, &err));
      OK(cag_mesh_boolean(add ? CAG_UNION : CAG_DIFFERENCE, body, b, NULL, &m, &err));
      cag_mesh_release(straight);
      cag_mesh_release(b);
      cag_mesh_release(body);
      body = m;
      for (int x = 0; x < CELLS; x++)
        for (int y = 0; y < CELLS; y++)
          for (int z = 0; z < CELLS; z++) {
            bool *cell = &g[x + 1][y + 1][z + 1];
            if (x >= low[0] && x < high[0] && y >= low[1] && y < high[1] && z >= low[2] &&
                z < high[2])
              *cell = add;
            count += *cell;
          }
      CagVec3 gap[2];
      double terms[10];
      assert_true(body->triangle_count == 0 || cag_mesh_is_watertight(body, gap));
      cag_mesh_volume_terms(body, terms);
      NEAR(terms[0], count * fabs(det), 1e-10);
      check_flat_normals(body);
      const long needed = triangles_needed(g);
      if (needed < 0) break; // where the body touches itself, the points are kept
      assert_int_equal(body->triangle_count, needed);
      checked++;
    }
    cag_mesh_release(body);
  }
  assert_true(checked > 150);
}

// Two rotated boxes at the origin with sides in common planes. The tolerance for points off their
// planes must depend on all points, because the first may be the origin.
static void turned_boxes_take_as_few_triangles_as_straight_ones(void **state) {
  (void)state;
  seed = 42;
  for (int trial = 0; trial < 40; trial++) {
    const double x = 1 + random_int(9), y = 1 + random_int(9), z = 1 + random_int(9);
    const CagVec3 o = cag_vec3(0, 0, 0), axis = cag_vec3(1 + random_int(5), random_int(5), 1);
    // The second box extends the first one, or forms a step on it.
    const CagVec3 far = cag_vec3(2 * x, trial % 2 ? y : y + 1, z);
    CagMesh *boxes[2] = {box_with_normals(o, cag_vec3(x, y, z)),
                         box_with_normals(cag_vec3(x, 0, 0), far)};
    CagTransform turn;
    size_t count[2];
    OK(cag_rotate(axis, 0.1 + random_int(100), o, &turn, &err));
    for (int turned = 0; turned < 2; turned++) {
      CagMesh *a, *b, *m;
      const CagTransform t = turned ? turn : cag_transform_identity();
      OK(cag_mesh_transform(boxes[0], &t, &a, &err));
      OK(cag_mesh_transform(boxes[1], &t, &b, &err));
      OK(cag_mesh_boolean(CAG_UNION, a, b, NULL, &m, &err));
      count[turned] = m->triangle_count;
      cag_mesh_release(a);
      cag_mesh_release(b);
      cag_mesh_release(m);
    }
    assert_int_equal(count[0], trial % 2 ? 12 : 20);
    assert_int_equal(count[1], count[0]);
    cag_mesh_release(boxes[0]);
    cag_mesh_release(boxes[1]);
  }
}

// A plate whose top is divided between two materials along a line of short steps. Each point is
// closer to the line of its neighbors than the rounding tolerance. If the whole line is bent, all
// its points must be kept; if it is straight, all must be removed.
static void lines_between_materials_stay_where_they_are_bent(void **state) {
  (void)state;
  enum { STEPS = 40 };
  static const double BENDS[3] = {0, 2e-11, 1e-3}; // of the whole line
  for (int k = 0; k < 3; k++)
    for (int axis = 0; axis < 3; axis++) {
      // The outline of the top (its corners and the ends of the line), and the points of the line.
      CagVec3 v[8 + STEPS - 1];
      uint32_t faces[24 + 2 * (STEPS + 3)], counts[7], n = 0;
      const double at[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                               {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
      // The line runs from corner 4 to corner 6, bent away from the diagonal.
      for (int i = 0; i < 8 + STEPS - 1; i++) {
        const double t = (double)(i - 7) / STEPS, off = BENDS[k] * 4 * t * (1 - t);
        const double p[3] = {i < 8 ? at[i][0] : t + off, i < 8 ? at[i][1] : t - off,
                             i < 8 ? at[i][2] : 1};
        v[i] = cag_vec3(p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]);
      }
      static const uint32_t SIDES[5][4] = {
          {0, 3, 2, 1}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
      memcpy(faces, SIDES, sizeof SIDES);
      n = 20;
      for (int half = 0; half < 2; half++) {
        faces[n++] = half ? 6 : 4;
        faces[n++] = half ? 7 : 5;
        faces[n++] = half ? 4 : 6;
        for (uint32_t i = 0; i < STEPS - 1; i++) faces[n++] = half ? 8 + i : 8 + STEPS - 2 - i;
      }
      for (int i = 0; i < 7; i++) counts[i] = i < 5 ? 4 : STEPS + 2;
      CagMesh *plate, *other, *m;
      OK(cag_mesh_from_faces(v, 8 + STEPS - 1, faces, counts, 7, &plate, &err));
      plate->labels = malloc(plate->triangle_count * sizeof *plate->labels);
      for (uint32_t t = 0; t < plate->triangle_count; t++) plate->labels[t] = 1 + (t >= 10 + STEPS);
      other = box_with_normals(cag_vec3(0.4, -3, 0.4), cag_vec3(0.6, -2, 0.6));
      OK(cag_mesh_boolean(CAG_UNION, plate, other, NULL, &m, &err));
      assert_int_equal(m->triangle_count, k ? plate->triangle_count + 12 : 24);
      assert_int_equal(plate->triangle_count, 10 + 2 * STEPS);
      double area[3] = {0, 0, 0};
      for (size_t t = 0; t < m->triangle_count; t++) {
        const uint32_t *c = m->triangles + 3 * t;
        const CagVec3 o = m->positions[c[0]];
        area[m->labels[t]] +=
            cag_norm(cag_cross(cag_sub(m->positions[c[1]], o), cag_sub(m->positions[c[2]], o))) / 2;
      }
      double half = 0.5; // as in the polygon of the points
      for (int i = 0; i < STEPS; i++) {
        const double s = (double)i / STEPS, t = (double)(i + 1) / STEPS;
        half -= BENDS[k] * 4 * (s * (1 - s) + t * (1 - t)) / STEPS;
      }
      NEAR(area[2], 1 - half, 1e-11);
      NEAR(area[1], 5 + half, 1e-11);
      cag_mesh_release(m);
      cag_mesh_release(plate);
      cag_mesh_release(other);
    }
}

// --- Bodies that touch themselves ---

// The number of boundaries around a grid point of one part of a block, slightly shrunk: one more
// than the number of connected sets that the other cells form, connected by sides and edges.
static int boundaries(const bool part[8]) {
  int group[8], count = 0;
  for (int i = 0; i < 8; i++) group[i] = i;
  for (int round = 0; round < 8; round++)
    for (int i = 0; i < 8; i++)
      for (int k = 0; k < 8; k++) {
        const int bits = i ^ k, apart = (bits & 1) + (bits >> 1 & 1) + (bits >> 2);
        if (!part[i] && !part[k] && apart <= 2 && group[k] < group[i]) group[i] = group[k];
      }
  for (int i = 0; i < 8; i++) count += !part[i] && group[i] == i;
  return count;
}

// The Euler characteristic of the surface of the cells. Cells that have only an edge or a corner in
// common are separate.
static long euler_of_cells(Cells g) {
  long euler = 0;
  for (int x = 0; x + 1 < ROW; x++)
    for (int y = 0; y + 1 < ROW; y++)
      for (int z = 0; z + 1 < ROW; z++) {
        bool block[8];
        int group[8];
        for (int i = 0; i < 8; i++) block[i] = g[x + (i & 1)][y + (i >> 1 & 1)][z + (i >> 2)];
        for (int i = 0; i < 8; i++) group[i] = i;
        for (int round = 0; round < 8; round++)
          for (int i = 0; i < 8; i++)
            for (int bit = 1; bit < 8; bit *= 2)
              if (block[i] && block[i ^ bit] && group[i ^ bit] < group[i])
                group[i] = group[i ^ bit];
        for (int i = 0; i < 8; i++) {
          bool part[8];
          if (!block[i] || group[i] != i) continue;
          for (int k = 0; k < 8; k++) part[k] = block[k] && group[k] == i;
          euler += boundaries(part);
        }
        for (int bit = 1; bit < 8; bit *= 2) euler += block[7] != block[7 ^ bit];
        for (int bit = 1; bit < 8; bit *= 2) { // of four cells around an edge
          const int a = bit == 1 ? 2 : 1, b = bit == 4 ? 2 : 4;
          const bool four[4] = {block[7], block[7 ^ a], block[7 ^ a ^ b], block[7 ^ b]};
          int changes = 0;
          for (int k = 0; k < 4; k++) changes += four[k] != four[(k + 1) % 4];
          euler -= changes / 2;
        }
      }
  return euler;
}

static void touching_cells_have_vertices_of_their_own(void **state) {
  (void)state;
  seed = 42;
  for (int trial = 0; trial < 40; trial++) {
    Cells g = {{{false}}};
    const CagMesh *cubes[27];
    size_t n = 0;
    CagMesh *m, *whole = box_with_normals(cag_vec3(1, 1, 1), cag_vec3(4, 4, 4));
    const int often = 2 + trial % 3;
    for (int i = 0; i < 27; i++) {
      const int x = i % 3 + 1, y = i / 3 % 3 + 1, z = i / 9 + 1;
      if (random_int(often) > 0) continue;
      g[x][y][z] = true;
      cubes[n++] = box_with_normals(cag_vec3(x, y, z), cag_vec3(x + 1, y + 1, z + 1));
    }
    for (int rest = 0; rest < 2 && n > 0; rest++) {
      const CagMesh *list[28] = {whole};
      memcpy(list + 1, cubes, n * sizeof *cubes);
      if (rest) OK(cag_mesh_boolean_many(CAG_DIFFERENCE, list, n + 1, NULL, &m, &err));
      else OK(cag_mesh_boolean_many(CAG_UNION, cubes, n, NULL, &m, &err));
      CagVec3 gap[2];
      double terms[10];
      assert_true(n == 27 || cag_mesh_is_watertight(m, gap));
      cag_mesh_volume_terms(m, terms);
      NEAR(terms[0], rest ? 27.0 - (double)n : (double)n, 1e-11);
      for (int i = 0; rest && i < 27; i++) {
        bool *cell = &g[i % 3 + 1][i / 3 % 3 + 1][i / 9 + 1];
        *cell = !*cell;
      }
      assert_int_equal(cag_mesh_euler_characteristic(m), euler_of_cells(g));
      check_flat_normals(m);
      cag_mesh_release(m);
    }
    for (size_t i = 0; i < n; i++) cag_mesh_release((CagMesh *)cubes[i]);
    cag_mesh_release(whole);
  }
}

// --- Normals of curved faces ---

static double random_number(void) { return random_int(1 << 30) / (double)(1 << 30) * 2 - 1; }
static CagVec3 random_vector(void) {
  const double x = random_number(), y = random_number();
  return cag_vec3(x, y, random_number());
}

// A tetrahedron, optionally with normals for the corners of each face.
static CagMesh *random_tetrahedron(bool normals) {
  static const uint32_t out[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
  CagVec3 v[4];
  double size;
  do {
    for (int k = 0; k < 4; k++) v[k] = random_vector();
    size = cag_dot(cag_sub(v[1], v[0]), cag_cross(cag_sub(v[2], v[0]), cag_sub(v[3], v[0])));
  } while (size < 0.5);
  CagMesh *m;
  OK(cag_mesh_new(12, 4, normals, false, false, &m, &err));
  for (uint32_t i = 0; i < 12; i++) {
    const uint32_t *k = out + i / 3 * 3;
    const CagVec3 n = cag_unit(cag_cross(cag_sub(v[k[1]], v[k[0]]), cag_sub(v[k[2]], v[k[0]])));
    m->positions[i] = v[out[i]];
    m->triangles[i] = i;
    if (normals) m->normals[i] = cag_unit(cag_madd(n, 0.5, random_vector()));
  }
  return m;
}

// Whether the point p lies on a triangle of m (reversed if `turned` is set) with this interpolated
// normal. The triangle's plane has the normal `flat`.
static bool has_normal(const CagMesh *m, bool turned, CagVec3 p, CagVec3 normal, CagVec3 flat) {
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    const CagVec3 *v = m->positions;
    const CagVec3 n = cag_cross(cag_sub(v[k[1]], v[k[0]]), cag_sub(v[k[2]], v[k[0]]));
    CagVec3 sum = {0, 0, 0};
    bool inside = fabs(cag_dot(cag_unit(n), cag_sub(p, v[k[0]]))) < 1e-9 &&
                  (turned ? -1 : 1) * cag_dot(cag_unit(n), flat) > 1 - 1e-9;
    for (int i = 0; i < 3 && inside; i++) {
      const CagVec3 a = cag_sub(v[k[(i + 1) % 3]], p), b = cag_sub(v[k[(i + 2) % 3]], p);
      const double part = cag_dot(n, cag_cross(a, b)) / cag_dot(n, n);
      inside = part > -1e-9;
      sum = cag_madd(sum, part, m->normals ? m->normals[k[i]] : n);
    }
    if (!inside) continue;
    if (cag_norm(cag_sub(cag_scaled(cag_unit(sum), turned ? -1 : 1), normal)) < 1e-7) return true;
  }
  return false;
}

static void normals_are_interpolated(void **state) {
  (void)state;
  seed = 43;
  size_t checked = 0;
  for (int trial = 0; trial < 60; trial++) {
    CagMesh *a = random_tetrahedron(trial % 3 != 1), *b = random_tetrahedron(trial % 3 != 2);
    for (int op = 0; op < 3; op++) {
      CagMesh *m;
      OK(cag_mesh_boolean((CagSetOperation)op, a, b, NULL, &m, &err));
      for (size_t t = 0; t < m->triangle_count; t++) {
        const uint32_t *k = m->triangles + 3 * t;
        const CagVec3 *v = m->positions;
        const CagVec3 flat = cag_cross(cag_sub(v[k[1]], v[k[0]]), cag_sub(v[k[2]], v[k[0]]));
        if (cag_norm(flat) < 1e-6) continue; // its plane is undetermined
        for (int i = 0; i < 3; i++, checked++)
          assert_true(
              has_normal(a, false, v[k[i]], m->normals[k[i]], cag_unit(flat)) ||
              has_normal(b, op == CAG_DIFFERENCE, v[k[i]], m->normals[k[i]], cag_unit(flat)));
      }
      cag_mesh_release(m);
    }
    cag_mesh_release(a);
    cag_mesh_release(b);
  }
  assert_true(checked > 3000);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(turned_boxes_take_as_few_triangles_as_straight_ones),
      cmocka_unit_test(lines_between_materials_stay_where_they_are_bent),
      cmocka_unit_test(touching_cells_have_vertices_of_their_own),
      cmocka_unit_test(normals_are_interpolated),
      cmocka_unit_test(boxes_of_a_grid_take_as_few_triangles_as_they_need),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
