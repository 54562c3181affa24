// Mesh lines along a common edge of two faces: each gets the corners of both faces, and as many
// steps as the denser one needs, even if the faces traverse the edge in opposite directions or at
// different speeds.

#include "tests/geom/leaf_support.h"

static const double origin[2] = {0, 0}, far_corner[2] = {1, 1};

// The point on the common edge at the parameter t, and a plane quadrilateral beside it. `bend`
// tells how unevenly the parameter runs along the edge, which is straight in any case.
static CagSurface *patch(CagVec3 p, CagVec3 q, CagVec3 off, int side, bool back, double bend) {
  enum { ROWS = 2, ALONG = 3 };
  CagVec3 net[ROWS * ALONG], turned[ROWS * ALONG];
  CagSurface *s;
  for (int i = 0; i < ROWS; i++)
    for (int k = 0; k < ALONG; k++) {
      const double t = k == 1 ? 0.5 + bend : k / 2.0;
      const CagVec3 at = cag_lerp(p, q, t);
      net[i * ALONG + (back ? ALONG - 1 - k : k)] =
          (i == 1) == (side % 2 == 1) ? at : cag_add(at, off);
    }
  if (side / 2 == 0) {
    OK(cag_surface_bezier(net, NULL, ROWS, ALONG, &s, &err));
    return s;
  }
  for (int i = 0; i < ROWS; i++)
    for (int k = 0; k < ALONG; k++) turned[k * ROWS + i] = net[i * ALONG + k];
  OK(cag_surface_bezier(turned, NULL, ALONG, ROWS, &s, &err));
  return s;
}

typedef struct Joint {
  CutFaces cut;
  int side[FACES];
  uint32_t line[FACES];
  bool reversed;
  double bend[FACES];
} Joint;

static void begin(Joint *j, int k) {
  const CagVec3 p = cag_vec3(uniform(-3, 0), 0, 1), q = cag_vec3(2, 1, uniform(0, 4));
  *j = (Joint){.side = {k % 4, k / 4 % 4}, .reversed = k / 16 % 2};
  for (int f = 0; f < FACES; f++) {
    if (k / 32 % 2) j->bend[f] = uniform(-0.3, 0.3);
    add_face(&j->cut, patch(p, q, cag_vec3(0, f ? 3 : -3, uniform(-1, 1)), j->side[f],
                            f == 1 && j->reversed, j->bend[f]));
    add_random_leaves(&j->cut, origin, far_corner, 1 + k % 4);
  }
  make_lines(&j->cut);
  for (int f = 0; f < FACES; f++) {
    j->line[f] = cag_tess_side_line(&j->cut.t, (uint32_t)f, j->side[f]);
    assert_int_not_equal(j->line[f], NO_INDEX);
  }
  OK(cag_tess_join_lines(&j->cut.t, j->line[0], j->line[1], j->reversed, &err));
  OK(cag_tess_make_nodes(&j->cut.t, &err));
}

// --- Required steps along the edge ---

// The fraction of the edge's length at a parameter of a face.
static double length_at(const Joint *j, int face, double t) {
  const double x = face == 1 && j->reversed ? 1 - t : t;
  return x + 2 * j->bend[face] * x * (1 - x);
}

static double parameter_at(const Joint *j, int face, double length) {
  const double b = 2 * j->bend[face];
  const double x = 2 * length / (1 + b + sqrt((1 + b) * (1 + b) - 4 * b * length));
  return face == 1 && j->reversed ? 1 - x : x;
}

static int by_size(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static bool is_beside(const Joint *j, int face, const Leaf *l) {
  const int side = j->side[face];
  return (int)l->face == face && (side % 2 ? l->to[side / 2] == 1 : l->from[side / 2] == 0);
}

// The number of steps that the leaves of a face need between two fractions of the length.
static double needed(const Joint *j, int face, double from, double to) {
  const double a = parameter_at(j, face, from), b = parameter_at(j, face, to);
  const int along = 1 - j->side[face] / 2;
  for (size_t k = 0; k < j->cut.t.leaf_count; k++) {
    const Leaf *l = &j->cut.leaves[k];
    if (is_beside(j, face, l) && l->from[along] < (a + b) / 2 && (a + b) / 2 < l->to[along])
      return l->n[along] * fabs(b - a) / (l->to[along] - l->from[along]);
  }
  fail();
  return 0;
}

static void lines_of_an_edge_have_the_same_nodes(void **state) {
  (void)state;
  seed = 71;
  size_t cuts_in_all = 0;
  for (int k = 0; k < 640; k++) {
    Joint j;
    begin(&j, k);
    const Tessellator *t = &j.cut.t;
    const double near = k / 32 % 2 ? 1e-7 : 1e-14; // parameters that must be searched for, or not
    // The corners of the leaves of both faces, as fractions of the length.
    double cuts[2 * MOST_LEAVES + 2];
    size_t n = 0, expected = 1;
    for (size_t l = 0; l < t->leaf_count; l++)
      for (int f = 0; f < FACES; f++)
        if (is_beside(&j, f, &j.cut.leaves[l]))
          cuts[n++] = length_at(&j, f, j.cut.leaves[l].from[1 - j.side[f] / 2]);
    cuts[n++] = 0;
    cuts[n++] = 1;
    qsort(cuts, n, sizeof *cuts, by_size);
    for (size_t i = 0; i + 1 < n; i++) {
      if (cuts[i + 1] - cuts[i] < 1e-12) continue;
      const double most =
          fmax(needed(&j, 0, cuts[i], cuts[i + 1]), needed(&j, 1, cuts[i], cuts[i + 1]));
      expected += (size_t)fmax(1, ceil(most - 1e-6));
      cuts_in_all++;
    }
    const Line *line[FACES] = {&t->lines[j.line[0]], &t->lines[j.line[1]]};
    assert_int_equal(line[0]->node_count, expected);
    assert_int_equal(line[1]->node_count, expected);
    for (size_t i = 0; i < expected; i++) {
      const Node *node[FACES] = {&t->nodes[line[0]->node + i],
                                 &t->nodes[line[1]->node + (j.reversed ? expected - 1 - i : i)]};
      NEAR(length_at(&j, 0, node[0]->t), length_at(&j, 1, node[1]->t), near);
      const uint32_t v[FACES] = {
          cag_tess_node_vertex(t, line[0], node[0], j.side[0] % 2 == 0, i == expected - 1),
          cag_tess_node_vertex(t, line[1], node[1], j.side[1] % 2 == 0,
                               j.reversed ? i == 0 : i == expected - 1)};
      assert_int_equal(cag_tess_find(&j.cut.t, v[0]), cag_tess_find(&j.cut.t, v[1]));
      // Between corners, the steps along the first line are equal.
      if (i > 0 && i + 1 < expected && node[0]->corner == NO_INDEX) {
        const double before = node[0]->t - node[0][-1].t, after = node[0][1].t - node[0]->t;
        bool cut = false;
        for (size_t l = 0; l < n; l++) cut |= fabs(cuts[l] - length_at(&j, 0, node[0]->t)) < 1e-6;
        if (!cut) NEAR(before, after, 1e-6);
      }
    }
    // Each line keeps its own corners exactly.
    for (size_t l = 0; l < t->leaf_count; l++)
      for (int f = 0; f < FACES; f++) {
        const Leaf *leaf = &j.cut.leaves[l];
        const int along = 1 - j.side[f] / 2;
        if (!is_beside(&j, f, leaf)) continue;
        size_t found = 0;
        for (size_t i = 0; i < expected; i++) {
          const Node *node = &t->nodes[line[f]->node + i];
          found += (node->t == leaf->from[along]) + (node->t == leaf->to[along]);
        }
        assert_int_equal(found, 2);
      }
    free_faces(&j.cut);
  }
  assert_true(cuts_in_all > 2000);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lines_of_an_edge_have_the_same_nodes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
