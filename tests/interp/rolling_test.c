// Fillets and chamfers of meshes by rolling balls, at boundaries that cag-brep computed.

#include "geom/boundary/features.h"
#include "geom/mesh/check.h"
#include "geom/solid/exact.h"
#include "geom/solid/rolling.h"
#include "tests/interp/boundary_support.h"

#define REQUIRE_KERNEL()                                                                           \
  if (!kernel) skip()

#define EDGES_MOST 64

// A solid with its features and the edges that are chosen.
typedef struct Shape {
  CagSolid *solid;
  CagFeatures f;
  CagRolledEdge edges[EDGES_MOST];
  size_t n;
} Shape;

static Shape shape_of(CagSolid *s) {
  Shape out = {0};
  CagBoundary b = boundary_of(s);
  OK(cag_solid_exact(&b, 1, &out.solid, &err));
  size_t n;
  OK(cag_boundary_features(cag_solid_boundaries(out.solid, &n), &out.f, &err));
  return out;
}

static void shape_free(Shape *s) {
  cag_features_free(&s->f);
  cag_solid_release(s->solid);
}

typedef bool Chooses(const CagEdgeFeature *e);

static void choose(Shape *s, Chooses *chooses, double from, double to) {
  s->n = 0;
  for (size_t i = 0; i < s->f.edge_count; i++)
    if (chooses(&s->f.edges[i]))
      s->edges[s->n++] = (CagRolledEdge){0, s->f.edges[i].edge, {from, to}};
}

static bool is_any(const CagEdgeFeature *e) { return e->bend != CAG_EDGE_SMOOTH; }
static bool is_convex(const CagEdgeFeature *e) { return e->bend == CAG_EDGE_CONVEX; }
static bool is_concave(const CagEdgeFeature *e) { return e->bend == CAG_EDGE_CONCAVE; }
static bool is_circle(const CagEdgeFeature *e) { return strcmp(e->kind, "circle") == 0; }
static bool is_vertical(const CagEdgeFeature *e) {
  return strcmp(e->kind, "line") == 0 && fabs(e->direction.z) > 0.999;
}
static bool is_top(const CagEdgeFeature *e) {
  return fabs(e->direction.z) < 1e-6 && e->start.z > 1e-6;
}

// The volume of the mesh of a solid, which must be watertight.
static double volume_of(CagSolid *s) {
  CagMesh *m;
  CagMeshCheck check;
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  OK(cag_solid_tessellate(s, &how, &m, &err));
  OK(cag_mesh_check(m, &check, &err));
  assert_true(check.solid);
  cag_mesh_release(m);
  cag_solid_release(s);
  return check.volume;
}

static double rolled_volume(const Shape *s, double tolerance) {
  CagSolid *out;
  OK(cag_solid_roll(s->solid, s->edges, s->n, tolerance, NULL, &out, &err));
  return volume_of(out);
}

// The area between two perpendicular lines and a circle of radius 1 that touches both.
#define CORNER_AREA (1 - M_PI / 4)

static void vertical_edges_of_a_box(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  Shape s = shape_of(a_box(10, 8, 6));
  choose(&s, is_vertical, 2, 2);
  assert_int_equal(s.n, 4);
  // Off by at most the tolerance over the area of the fillets.
  NEAR(rolled_volume(&s, 1e-3), 480 - 4 * 6 * 4 * CORNER_AREA, 4 * 6 * M_PI * 1e-3);
  shape_free(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(vertical_edges_of_a_box)};
  (void)is_any, (void)is_convex, (void)is_concave, (void)is_circle, (void)is_top;
  return cmocka_run_group_tests(tests, start_kernel, end_kernel);
}
