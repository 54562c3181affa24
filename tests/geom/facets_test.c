// Flat faces of meshes: counts for known bodies by Euler's formula, volumes by the formulas of boxes.

#include "geom/mesh/facets.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

// Adds the 12 triangles of the box between two corners. They point into it if `inward` is set.
static void add_box(uint32_t *triangles, CagVec3 *points, size_t *n, size_t *count, CagVec3 low,
                    CagVec3 high, bool inward) {
  static const uint32_t faces[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                       {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  const uint32_t base = (uint32_t)*n;
  for (int k = 0; k < 8; k++)
    points[(*n)++] = cag_vec3(k % 4 == 1 || k % 4 == 2 ? high.x : low.x,
                              k % 4 >= 2 ? high.y : low.y, k >= 4 ? high.z : low.z);
  for (int f = 0; f < 6; f++)
    for (uint32_t half = 1; half < 3; half++) {
      uint32_t *t = triangles + 3 * (*count)++;
      t[0] = base + faces[f][0];
      t[1] = base + faces[f][inward ? half + 1 : half];
      t[2] = base + faces[f][inward ? half : half + 1];
    }
}

static CagMesh *mesh_of(const CagVec3 *points, size_t n, const uint32_t *triangles, size_t count) {
  uint32_t threes[256];
  CagMesh *m;
  for (size_t i = 0; i < count; i++) threes[i] = 3;
  OK(cag_mesh_from_faces(points, n, triangles, threes, count, &m, &err));
  return m;
}

typedef struct Body {
  CagVec3 points[64];
  uint32_t triangles[3 * 128];
  size_t n, count;
} Body;

static CagFacets facets_of(const Body *b, double slack) {
  CagMesh *m = mesh_of(b->points, b->n, b->triangles, b->count);
  CagFacets f;
  OK(cag_mesh_facets(m, slack, &f, &err));
  cag_mesh_release(m);
  return f;
}

static void box_between(Body *b, CagVec3 low, CagVec3 high, bool inward) {
  add_box(b->triangles, b->points, &b->n, &b->count, low, high, inward);
}

// Checks that every edge has one use in each direction, and that uses continue each other.
static void check_uses(const CagFacets *f) {
  int *uses = calloc(2 * f->edge_count, sizeof *uses);
  for (size_t i = 0; i < f->use_count; i++) uses[2 * f->uses[i].edge + f->uses[i].reversed]++;
  for (size_t i = 0; i < 2 * f->edge_count; i++) assert_int_equal(uses[i], 1);
  free(uses);
  for (size_t l = 0; l < f->loop_count; l++)
    for (size_t i = 0; i < f->loops[l].count; i++) {
      const CagFacetUse *a = &f->uses[f->loops[l].first + i];
      const CagFacetUse *b = &f->uses[f->loops[l].first + (i + 1) % f->loops[l].count];
      const CagFacetEdge *s = &f->edges[a->edge], *t = &f->edges[b->edge];
      assert_int_equal(a->reversed ? s->from : s->to, b->reversed ? t->to : t->from);
    }
}

static void a_box_has_six_faces(void **state) {
  (void)state;
  Body b = {0};
  box_between(&b, cag_vec3(1, 2, 3), cag_vec3(3, 5, 7), false);
  CagFacets f = facets_of(&b, 1e-9);
  assert_int_equal(f.vertex_count, 8);
  assert_int_equal(f.edge_count, 12);
  assert_int_equal(f.face_count, 6);
  assert_int_equal(f.loop_count, 6);
  assert_int_equal(f.shell_count, 1);
  NEAR(f.shells[0].volume, 2 * 3 * 4, 1e-12);
  NEAR(f.flatness, 0, 0);
  check_uses(&f);
  cag_facets_free(&f);
}

static void a_cavity_belongs_to_the_smallest_body_around_it(void **state) {
  (void)state;
  Body b = {0};
  box_between(&b, cag_vec3(0, 0, 0), cag_vec3(9, 9, 9), false);
  box_between(&b, cag_vec3(1, 1, 1), cag_vec3(8, 8, 8), true);
  box_between(&b, cag_vec3(2, 2, 2), cag_vec3(7, 7, 7), false);
  box_between(&b, cag_vec3(3, 3, 3), cag_vec3(4, 4, 4), true);
  CagFacets f = facets_of(&b, 1e-9);
  assert_int_equal(f.shell_count, 4);
  const double volumes[4] = {729, -343, 125, -1};
  const size_t outer[4] = {0, 0, 2, 2};
  for (size_t i = 0; i < 4; i++) {
    NEAR(f.shells[i].volume, volumes[i], 1e-11);
    assert_int_equal(f.shells[i].void_of, outer[i]);
    assert_int_equal(f.shells[i].count, 6);
  }
  check_uses(&f);
  cag_facets_free(&f);
}

// A ring of four beams with a square hole: its top and bottom have two loops.
static void a_face_may_have_a_hole(void **state) {
  (void)state;
  Body b = {0};
  for (int k = 0; k < 16; k++) {
    static const double x[4] = {0, 1, 1, 0}, y[4] = {0, 0, 1, 1};
    const double size = k % 8 < 4 ? 3 : 1, off = k % 8 < 4 ? 0 : 1;
    b.points[b.n++] = cag_vec3(off + size * x[k % 4], off + size * y[k % 4], k / 8);
  }
  for (uint32_t k = 0; k < 4; k++) { // outer 0..3, inner 4..7, those above 8 more
    const uint32_t l = (k + 1) % 4;
    const uint32_t quads[4][4] = {{k, l, l + 8, k + 8},           // outside
                                  {l + 4, k + 4, k + 12, l + 12}, // inside
                                  {k + 8, l + 8, l + 12, k + 12}, // top
                                  {l, k, k + 4, l + 4}};          // bottom
    for (int q = 0; q < 4; q++)
      for (int half = 1; half < 3; half++) {
        uint32_t *t = b.triangles + 3 * b.count++;
        t[0] = quads[q][0], t[1] = quads[q][half], t[2] = quads[q][half + 1];
      }
  }
  CagFacets f = facets_of(&b, 1e-9);
  assert_int_equal(f.face_count, 10);
  assert_int_equal(f.loop_count, 12);
  assert_int_equal(f.edge_count, 24);
  assert_int_equal(f.vertex_count, 16);
  NEAR(f.shells[0].volume, 8, 1e-12);
  for (size_t i = 0; i < f.face_count; i++)
    if (f.faces[i].count == 2) { // the outer loop has the larger sides
      const CagFacetEdge *e = &f.edges[f.uses[f.loops[f.faces[i].first].first].edge];
      NEAR(cag_norm(cag_sub(f.vertices[e->from], f.vertices[e->to])), 3, 1e-12);
    }
  check_uses(&f);
  cag_facets_free(&f);
}

// Two boxes with a common edge, which four triangles use.
static void bodies_that_touch_along_an_edge_are_two_shells(void **state) {
  (void)state;
  Body b = {0};
  box_between(&b, cag_vec3(0, 0, 0), cag_vec3(1, 1, 1), false);
  box_between(&b, cag_vec3(1, 1, 0), cag_vec3(2, 2, 1), false);
  for (size_t i = 0; i < 3 * b.count; i++) { // the second box has the corners of the first
    if (b.triangles[i] == 8) b.triangles[i] = 2;
    if (b.triangles[i] == 12) b.triangles[i] = 6;
  }
  CagFacets f = facets_of(&b, 1e-9);
  assert_int_equal(f.shell_count, 2);
  assert_int_equal(f.face_count, 12);
  assert_int_equal(f.vertex_count, 14);
  NEAR(f.shells[0].volume, 1, 1e-14);
  NEAR(f.shells[1].volume, 1, 1e-14);
  check_uses(&f);
  cag_facets_free(&f);
}

// A box whose top is divided by a point that is 1e-10 off an edge: a triangle without a plane.
static void thin_triangles_are_parts_of_their_neighbors(void **state) {
  (void)state;
  Body b = {0};
  box_between(&b, cag_vec3(0, 0, 0), cag_vec3(1, 1, 1), false);
  // The top is 4 5 6 and 4 6 7. The new vertex 8 lies near the middle of 4 5.
  b.points[b.n++] = cag_vec3(0.5, 1e-10, 1);
  for (size_t i = 0; i < b.count; i++) {
    uint32_t *t = b.triangles + 3 * i;
    if (!(t[0] == 4 && t[1] == 5 && t[2] == 6)) continue;
    const uint32_t three[3][3] = {{4, 5, 8}, {5, 6, 8}, {6, 4, 8}};
    memcpy(t, three[0], sizeof three[0]);
    memcpy(b.triangles + 3 * b.count++, three[1], sizeof three[1]);
    memcpy(b.triangles + 3 * b.count++, three[2], sizeof three[2]);
    break;
  }
  CagFacets f = facets_of(&b, 1e-9);
  assert_int_equal(f.face_count, 6);
  assert_int_equal(f.edge_count, 12);
  assert_true(f.flatness <= 1e-9);
  check_uses(&f);
  cag_facets_free(&f);
}

// Without slack only triangles in exactly one plane are joined, and a turned box has few of them.
static void a_turned_box_needs_slack(void **state) {
  (void)state;
  Body b = {0};
  box_between(&b, cag_vec3(0, 0, 0), cag_vec3(1, 2, 3), false);
  const CagTransform t = cag_rpy(0.3, 0.7, 1.1);
  for (size_t i = 0; i < b.n; i++) b.points[i] = cag_transform_point(&t, b.points[i]);
  CagFacets f = facets_of(&b, 1e-12);
  assert_int_equal(f.face_count, 6);
  assert_true(f.flatness > 0 && f.flatness < 1e-14);
  cag_facets_free(&f);
}

static void an_open_mesh_is_an_error_with_the_edge(void **state) {
  (void)state;
  Body b = {0};
  box_between(&b, cag_vec3(0, 0, 0), cag_vec3(1, 1, 1), false);
  CagMesh *m = mesh_of(b.points, b.n, b.triangles, b.count - 1);
  CagFacets f;
  assert_int_equal(cag_mesh_facets(m, 1e-9, &f, &err), CAG_E_ARGUMENT);
  assert_int_equal(err.id, CAG_ERR_mesh_open);
  assert_non_null(strstr(err.message, "its edge from [0, "));
  assert_null(f.faces);
  cag_mesh_release(m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_box_has_six_faces),
      cmocka_unit_test(a_cavity_belongs_to_the_smallest_body_around_it),
      cmocka_unit_test(a_face_may_have_a_hole),
      cmocka_unit_test(bodies_that_touch_along_an_edge_are_two_shells),
      cmocka_unit_test(thin_triangles_are_parts_of_their_neighbors),
      cmocka_unit_test(a_turned_box_needs_slack),
      cmocka_unit_test(an_open_mesh_is_an_error_with_the_edge),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
