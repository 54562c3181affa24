// Triangulation of leaves: plane patches are manually divided into leaves, so that grids with any
// counts are next to each other.

#include "tests/geom/leaf_support.h"

typedef struct Filled {
  CutFaces cut;
  CagMesh *mesh;
} Filled;

static void begin(Filled *f, double width, double height) {
  const double a = uniform(0.6, 1.4);
  const double b = uniform(0.6, 1.4);
  CagSurface *s;
  *f = (Filled){.mesh = NULL};
  OK(cag_surface_bilinear(cag_vec3(0, 0, 0), cag_vec3(0.2, height, 0), cag_vec3(width, 0.1, 0),
                          cag_vec3(a * width, b * height, 0), &s, &err));
  add_face(&f->cut, s);
}

static void fill(Filled *f) {
  make_lines(&f->cut);
  OK(cag_tess_make_nodes(&f->cut.t, &err));
  OK(cag_tess_fill(&f->cut.t, &f->mesh, &err));
}

static void end(Filled *f) {
  cag_mesh_release(f->mesh);
  free_faces(&f->cut);
}

// --- Properties of each triangle ---

static const double *uv_of(const CagMesh *m, size_t t, size_t k) {
  return m->uv + 2 * (size_t)m->triangles[3 * t + k];
}

static double twice_area(const double *a, const double *b, const double *c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static const Leaf *leaf_of(const Filled *f, size_t t) {
  double middle[2];
  for (size_t d = 0; d < 2; d++) {
    middle[d] = 0;
    for (size_t k = 0; k < 3; k++) middle[d] += uv_of(f->mesh, t, k)[d] / 3;
  }
  for (size_t k = 0; k < f->cut.t.leaf_count; k++) {
    const Leaf *l = &f->cut.leaves[k];
    if (l->from[0] < middle[0] && middle[0] < l->to[0] && l->from[1] < middle[1] &&
        middle[1] < l->to[1])
      return l;
  }
  fail_msg("a triangle lies in no leaf");
  return NULL;
}

// The triangles of a leaf add up to its area, and none is reversed.
static void check_tiling(const Filled *f) {
  double area[MOST_LEAVES] = {0};
  for (size_t t = 0; t < f->mesh->triangle_count; t++) {
    const double twice =
        twice_area(uv_of(f->mesh, t, 0), uv_of(f->mesh, t, 1), uv_of(f->mesh, t, 2));
    assert_true(twice > 0);
    area[leaf_of(f, t) - f->cut.leaves] += twice / 2;
  }
  for (size_t k = 0; k < f->cut.t.leaf_count; k++) {
    const Leaf *l = &f->cut.leaves[k];
    NEAR(area[k], (l->to[0] - l->from[0]) * (l->to[1] - l->from[1]), 1e-12);
  }
}

// --- Grids ---

// In both parameters, no triangle is wider than a cell of its leaf's grid.
static void check_widths(const Filled *f, const uint32_t (*planned)[2]) {
  for (size_t t = 0; t < f->mesh->triangle_count; t++) {
    const Leaf *l = leaf_of(f, t);
    for (size_t d = 0; d < 2; d++) {
      const double x = uv_of(f->mesh, t, 0)[d], y = uv_of(f->mesh, t, 1)[d],
                   z = uv_of(f->mesh, t, 2)[d];
      const double width = fmax(x, fmax(y, z)) - fmin(x, fmin(y, z));
      const double step = (l->to[d] - l->from[d]) / planned[l - f->cut.leaves][d];
      if (!(width <= step * (1 + 1e-9))) fail_msg("%g wide, not %g", width, step);
    }
  }
}

// The vertices inside leaves are those of their grids, each once.
static void check_inner_vertices(const Filled *f) {
  const CagMesh *m = f->mesh;
  size_t inner = 0, all = 0;
  for (size_t k = 0; k < f->cut.t.leaf_count; k++) {
    const Leaf *l = &f->cut.leaves[k];
    all += (size_t)(l->n[0] - 1) * (l->n[1] - 1);
    for (size_t v = 0; v < m->vertex_count; v++) {
      const double *at = m->uv + 2 * v;
      if (!(l->from[0] < at[0] && at[0] < l->to[0] && l->from[1] < at[1] && at[1] < l->to[1]))
        continue;
      inner++;
      for (size_t d = 0; d < 2; d++) {
        const double x = (at[d] - l->from[d]) / (l->to[d] - l->from[d]) * l->n[d];
        NEAR(x, round(x), 1e-9);
      }
      for (size_t w = 0; w < v; w++) assert_memory_not_equal(m->uv + 2 * w, at, 2 * sizeof *at);
    }
  }
  assert_int_equal(inner, all);
}

static double length_between(const CagMesh *m, uint32_t a, uint32_t b) {
  return cag_norm(cag_sub(m->positions[a], m->positions[b]));
}

// The corner of a triangle that is neither a nor b.
static uint32_t third(const uint32_t *k, uint32_t a, uint32_t b) {
  return k[0] != a && k[0] != b ? k[0] : k[1] != a && k[1] != b ? k[1] : k[2];
}

static bool is_single_sided(const Leaf *l) {
  const uint32_t *s = l->segments;
  return s[0] == 1 || s[1] == 1 || s[2] == 1 || s[3] == 1;
}

static bool is_at_corner(const Leaf *l, const double *uv) {
  return (uv[0] == l->from[0] || uv[0] == l->to[0]) && (uv[1] == l->from[1] || uv[1] == l->to[1]);
}

// Two triangles that form a cell of the grid meet at its shorter diagonal. At the corners of a leaf
// with a side of one edge, bands begin with the diagonal from the corner. Returns the number of
// cells.
static size_t check_diagonals(const Filled *f) {
  const CagMesh *m = f->mesh;
  size_t found = 0;
  for (size_t s = 0; s < m->triangle_count; s++)
    for (size_t t = s + 1; t < m->triangle_count; t++) {
      const Leaf *l = leaf_of(f, s);
      if (leaf_of(f, t) != l) continue;
      uint32_t common[3];
      size_t n = 0;
      for (size_t k = 0; k < 9; k++)
        if (m->triangles[3 * s + k / 3] == m->triangles[3 * t + k % 3] && n < 3)
          common[n++] = m->triangles[3 * s + k / 3];
      if (n != 2) continue;
      const uint32_t a = third(m->triangles + 3 * s, common[0], common[1]),
                     b = third(m->triangles + 3 * t, common[0], common[1]);
      bool quad = true;
      for (size_t d = 0; d < 2; d++) {
        const double step = (l->to[d] - l->from[d]) / l->n[d], x = m->uv[2 * a + d],
                     y = m->uv[2 * b + d];
        quad &= fabs(fabs(x - y) - step) < 1e-9;
        for (int e = 0; e < 2; e++) {
          const double z = m->uv[2 * common[e] + d];
          quad &= fmin(fabs(z - x), fabs(z - y)) < 1e-9;
        }
      }
      if (!quad) continue;
      if (!l->regular && is_single_sided(l) &&
          (is_at_corner(l, m->uv + 2 * common[0]) || is_at_corner(l, m->uv + 2 * common[1])))
        continue;
      found++;
      assert_true(length_between(m, common[0], common[1]) <= length_between(m, a, b) * (1 + 1e-6));
    }
  return found;
}

static void grids_beside_each_other_are_sewn_up(void **state) {
  (void)state;
  size_t quads = 0, regular = 0, all = 0;
  seed = 31;
  for (int k = 0; k < 300; k++) {
    Filled f;
    uint32_t planned[MOST_LEAVES][2];
    const double width = uniform(0.5, 8);
    begin(&f, width, uniform(0.5, 8));
    add_random_leaves(&f.cut, (double[2]){0, 0}, (double[2]){1, 1}, k % 5);
    for (size_t l = 0; l < f.cut.t.leaf_count; l++)
      memcpy(planned[l], f.cut.leaves[l].n, sizeof planned[l]);
    fill(&f);
    check_tiling(&f);
    check_widths(&f, planned);
    check_inner_vertices(&f);
    quads += check_diagonals(&f);
    for (size_t l = 0; l < f.cut.t.leaf_count; l++) regular += f.cut.leaves[l].regular;
    all += f.cut.t.leaf_count;
    end(&f);
  }
  assert_true(quads > 3000 && regular > all / 10 && regular < all / 2);
}

// --- Strips ---

static double slant_at(const Leaf *l, const double *uv) {
  const Slants *s = &l->slants;
  return uv[s->along] - s->slope * (uv[1 - s->along] - l->from[1 - s->along]);
}

// Adjacent strips whose slants continue from one to the next: each edge across a strip follows the
// slant.
static void edges_across_strips_follow_the_slants(void **state) {
  (void)state;
  seed = 32;
  size_t across = 0;
  for (int k = 0; k < 300; k++) {
    Filled f;
    const int along = k % 2, strips = 1 + k % 4;
    const double width = uniform(0.5, 8);
    const double step = uniform(0.02, 0.2);
    double phase = 0, at = 0;
    begin(&f, width, uniform(0.5, 8));
    for (int i = 0; i < strips; i++) {
      const double next = i + 1 < strips ? at + (1 - at) * uniform(0.1, 0.5) : 1;
      const double slope = uniform(0, 1) < 0.1 ? 0 : uniform(-0.7, 0.7) / (next - at);
      double from[2] = {0, 0}, to[2] = {1, 1};
      from[1 - along] = at;
      to[1 - along] = next;
      add_leaf(&f.cut, from, to, 1, 1);
      f.cut.leaves[i].slants = (Slants){along, slope, phase, step};
      phase += slope * (next - at);
      at = next;
    }
    fill(&f);
    check_tiling(&f);
    for (size_t t = 0; t < f.mesh->triangle_count; t++) {
      const Leaf *l = leaf_of(&f, t);
      double least = INFINITY, most = -INFINITY;
      for (size_t j = 0; j < 3; j++) {
        const double slant = slant_at(l, uv_of(f.mesh, t, j));
        least = fmin(least, slant);
        most = fmax(most, slant);
      }
      if (!(most - least <= 1.1 * step)) fail_msg("%g steps", (most - least) / step);
      across++;
    }
    end(&f);
  }
  assert_true(across > 5000);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(grids_beside_each_other_are_sewn_up),
      cmocka_unit_test(edges_across_strips_follow_the_slants),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
