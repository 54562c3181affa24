// Bodies of random quadrics in boxes as exact boundaries: all edges are shared by faces, and are on
// the quadric and the sides of the box.

#include "tests/geom/quadric_support.h"
#include "tests/interp/scene_fixture.h"

#include "geom/meet/quadric_body.h"
#include "geom/solid/csg.h"
#include "interp/formats/brep.h"

#define ROUNDS 3
// Edges are exact arcs; the form and the box are known up to rounding.
#define EXACT 1e-12

// The distance of p from the quadric, to first order.
static double off_quadric(const CagQuadric *q, CagVec3 p) {
  const double *c = q->c;
  const CagVec3 slope = cag_vec3(2 * c[0] * p.x + c[3] * p.y + c[5] * p.z + c[6],
                                 2 * c[1] * p.y + c[3] * p.x + c[4] * p.z + c[7],
                                 2 * c[2] * p.z + c[4] * p.y + c[5] * p.x + c[8]);
  const double value = fabs(cag_quadric_value(q, p)), steep = cag_norm(slope);
  return steep > 1e-3 ? value / steep : sqrt(value);
}

static double off_sides(const CagBounds *b, CagVec3 p) {
  const double x = fmin(fabs(p.x - b->min.x), fabs(p.x - b->max.x));
  const double y = fmin(fabs(p.y - b->min.y), fabs(p.y - b->max.y));
  const double z = fmin(fabs(p.z - b->min.z), fabs(p.z - b->max.z));
  return fmin(x, fmin(y, z));
}

// Checks that each edge is used once in each direction. Edges that one face uses twice are seams.
static void check_edges(const CagBrep *b, const CagQuadric *q, const CagBounds *box, double size,
                        int *arcs) {
  int *forward = calloc(b->edge_count, sizeof *forward);
  int *back = calloc(b->edge_count, sizeof *back);
  size_t *face = calloc(b->edge_count, sizeof *face);
  bool *seam = calloc(b->edge_count, sizeof *seam);
  for (size_t f = 0; f < b->face_count; f++)
    for (size_t l = b->faces[f].first; l < b->faces[f].first + b->faces[f].count; l++)
      for (size_t i = 0; i < b->loops[l].count; i++) {
        const CagBrepUse *u = &b->uses[b->loops[l].first + i];
        (u->reversed ? back : forward)[u->edge]++;
        seam[u->edge] = face[u->edge] == f + 1;
        face[u->edge] = f + 1;
      }
  for (size_t i = 0; i < b->edge_count; i++) {
    const CagCurve *c = b->edges[i].curve;
    assert_int_equal(forward[i], 1);
    assert_int_equal(back[i], 1);
    if (seam[i]) continue;
    for (int k = 0; k <= 8; k++) {
      CagVec3 p;
      OK(cag_curve_point(c, c->start + (c->end - c->start) * k / 8, &p, &err));
      assert_near(off_sides(box, p) / size, 0, EXACT, "edge on a side");
      if (!b->edges[i].straight)
        assert_near(off_quadric(q, p) / size, 0, EXACT, "edge on the quadric");
    }
    *arcs += !b->edges[i].straight;
  }
  free(forward);
  free(back);
  free(face);
  free(seam);
}

static void check_loops(const CagBrep *b) {
  for (size_t l = 0; l < b->loop_count; l++)
    for (size_t i = 0; i < b->loops[l].count; i++) {
      const CagBrepUse *u = &b->uses[b->loops[l].first + i];
      const CagBrepUse *v = &b->uses[b->loops[l].first + (i + 1) % b->loops[l].count];
      assert_int_equal(u->reversed ? b->edges[u->edge].from : b->edges[u->edge].to,
                       v->reversed ? b->edges[v->edge].to : b->edges[v->edge].from);
    }
}

static void bodies_within_boxes_close_with_exact_edges(void **state) {
  (void)state;
  enum { CURVED = 9 };
  int bodies = 0, arcs = 0;
  for (int i = 0; i < ROUNDS * CURVED; i++) {
    state_of_random = 70 + (uint64_t)i;
    const CagQuadric q = random_quadric(UNITS[i % CURVED], i / CURVED % 2 == 0);
    const CagVec3 corner = cag_vec3(random_in(-2, 0), random_in(-2, 0), random_in(-2, 0));
    const CagBounds box = {
        corner, cag_add(corner, cag_vec3(random_in(1, 4), random_in(1, 4), random_in(1, 4)))};
    CagSurface **list = NULL;
    size_t n = 0;
    CagError why;
    CagSolid *s;
    if (cag_quadric_patches(&q, &box, false, &list, &n, &why)) continue;
    OK(cag_solid_quadric_body(list, n, NULL, &s, &err));
    for (size_t k = 0; k < n; k++) cag_surface_release(list[k]);
    free(list);
    Fixture f;
    CagBrep b;
    fixture_begin(&f);
    fixture_solid(&f, "body", s);
    OK(cag_brep_of_scene(&f.scene, NULL, CAG_BREP_STEP, &b, &err));
    assert_int_equal(b.shapes[0].kind, CAG_BREP_SOLID);
    for (size_t k = 0; k < b.shell_count; k++) assert_true(b.shells[k].closed);
    check_edges(&b, &q, &box, cag_norm(cag_sub(box.max, box.min)), &arcs);
    check_loops(&b);
    cag_brep_free(&b);
    fixture_end(&f);
    bodies++;
  }
  assert_true(bodies > ROUNDS * CURVED / 2 && arcs > 4 * bodies);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(bodies_within_boxes_close_with_exact_edges)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
