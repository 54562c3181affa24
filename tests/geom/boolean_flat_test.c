// Flat faces of set operations: they take as few triangles as their outlines need, and keep their
// normals.

#include "geom/linalg/transform.h"
#include "geom/mesh/boolean.h"
#include "tests/geom/support.h"

static uint64_t seed;
static int random_int(int n) {
  seed = seed * 6364136223846793005u + 1442695040888963407u;
  return (int)((double)(seed >> 11) / 9007199254740992.0 * n);
}

enum { CELLS = 4, ROW = CELLS + 2 };
typedef bool Cells[ROW][ROW][ROW]; // with a rim of nothing

// A box with a normal for each side.
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

// The number of parts that the cells of a block of 2 x 2 x 2 with the given value form by their
// common sides.
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

// The triangles that the body of the cells needs: two for each corner, less two for each sphere,
// and so on (Euler). Returns -1 if the body touches itself along an edge or in a corner.
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
        // Squares and edges of the boundary that run from this point in the positive directions.
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

// Whether each normal is that of its triangle, which is that of a side of a cell.
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
    // Every other one sheared, with corners that are whole numbers.
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
      if (needed < 0) break; // what touches itself keeps the points along the touch
      assert_int_equal(body->triangle_count, needed);
      checked++;
    }
    cag_mesh_release(body);
  }
  assert_true(checked > 150);
}

// A plate whose top is divided among two materials along a line of short steps. Each point is off
// the line of its neighbors by less than rounding; but where the line is bent as a whole all of its
// points stay, and where it is straight all go.
static void lines_between_materials_stay_where_they_are_bent(void **state) {
  (void)state;
  enum { STEPS = 40 };
  static const double BENDS[3] = {0, 2e-11, 1e-3}; // of the whole line
  for (int k = 0; k < 3; k++)
    for (int axis = 0; axis < 3; axis++) {
      // The outline of the top: its corners and the ends of the line; the points of the line.
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

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lines_between_materials_stay_where_they_are_bent),
      cmocka_unit_test(boxes_of_a_grid_take_as_few_triangles_as_they_need),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
