// Solids without faces: what operations keep, where they reach, which side points are on; clipping.

#include <math.h>
#include <stdlib.h>

#include "geom/solid/clip.h"
#include "geom/solid/csg.h"
#include "tests/geom/support.h"

static CagSolid *box(double size) {
  CagSolid *s = NULL;
  OK(cag_solid_box(cag_vec3(size, size, size), false, &s, &err));
  return s;
}

static CagSolid *sphere(double radius) {
  CagSolid *s = NULL;
  OK(cag_solid_sphere(radius, &s, &err));
  return s;
}

// Takes the solid over.
static CagSolid *moved(CagSolid *s, double x, double y, double z) {
  CagSolid *out = NULL;
  CagTransform t = cag_translate(cag_vec3(x, y, z));
  OK(cag_solid_transform(s, &t, &out, &err));
  cag_solid_release(s);
  return out;
}

// Takes both over.
static CagSolid *combined(CagSetOperation op, CagSolid *a, CagSolid *b) {
  CagSolid *out = NULL;
  OK(cag_solid_combine(op, (CagSolid *[]){a, b}, 2, NULL, &out, &err));
  cag_solid_release(a);
  cag_solid_release(b);
  return out;
}

static CagSolid *side_of(CagVec3 point, CagVec3 normal) {
  CagPlane plane;
  CagSolid *s = NULL;
  OK(cag_plane(point, normal, &plane, &err));
  OK(cag_solid_half_space(&plane, &s, &err));
  return s;
}

static double volume(const CagSolid *s) {
  CagMassProperties m;
  OK(cag_solid_mass(s, &m, &err));
  return m.volume;
}

static void operations_of_one_kind_are_one(void **state) {
  (void)state;
  CagSolid *s = box(1);
  for (int i = 1; i < 50; i++) s = combined(CAG_UNION, s, moved(box(1), i, 0, 0));
  assert_int_equal(s->core->count, 50);
  NEAR(volume(s), 50, 1e-10);
  // A moved one is kept whole: its operands stand elsewhere.
  CagSolid *t = combined(CAG_UNION, moved(s, 0, 5, 0), box(1));
  assert_int_equal(t->core->count, 2);
  cag_solid_release(t);
}

static void moved_operations_share_their_mesh(void **state) {
  (void)state;
  CagSolid *s = combined(CAG_DIFFERENCE, sphere(3), box(9)), *copy = NULL;
  CagTransform t = cag_translate(cag_vec3(10, 0, 0));
  OK(cag_solid_transform(s, &t, &copy, &err));
  assert_ptr_equal(s->core, copy->core);
  NEAR(volume(copy), 36 * M_PI * 7 / 8, 36 * M_PI * 2e-3);
  assert_non_null(s->core->mesh);
  const CagMesh *kept = s->core->mesh;
  NEAR(volume(s), volume(copy), 1e-9);
  assert_ptr_equal(s->core->mesh, kept);
  cag_solid_release(s);
  cag_solid_release(copy);
}

static void reach_of_sides(void **state) {
  (void)state;
  CagBounds b;
  CagSolid *s = side_of(cag_vec3(0, 0, 4), cag_vec3(0, 0, 2));
  OK(cag_solid_reach(s, &b, &err));
  NEAR(b.max.z, 4, 1e-15);
  assert_true(isinf(b.min.z) && isinf(b.max.x));
  s = combined(CAG_INTERSECTION, s, sphere(9));
  OK(cag_solid_reach(s, &b, &err));
  NEAR(b.max.z, 4, 1e-15);
  NEAR(b.min.z, -9, 1e-9);
  cag_solid_release(s);
  // An ellipsoid turned about z by a: half of its width is sqrt(a^2 cos^2 + b^2 sin^2).
  const CagQuadric q = {{(1.0 / 9 + 1) / 2, (1.0 / 9 + 1) / 2, 1, 1.0 / 9 - 1, 0, 0, 0, 0, 0, -1}};
  OK(cag_solid_quadric(&q, &s, &err));
  OK(cag_solid_reach(s, &b, &err));
  NEAR(b.max.x, sqrt(5), 1e-12);
  NEAR(b.min.y, -sqrt(5), 1e-12);
  cag_solid_release(s);
}

static void bounds_of_differences_that_keep_their_sides(void **state) {
  (void)state;
  CagBounds b;
  CagSolid *s = combined(CAG_DIFFERENCE, box(4), moved(sphere(1), 2, 2, 4));
  OK(cag_solid_bounds(s, &b, &err));
  near_vec(b.max, cag_vec3(4, 4, 4), 0);
  assert_null(s->core->mesh); // told without the operation
  cag_solid_release(s);
  s = combined(CAG_DIFFERENCE, box(4), moved(box(9), -1, -1, 3));
  OK(cag_solid_bounds(s, &b, &err));
  near_vec(b.max, cag_vec3(4, 4, 3), 1e-12);
  cag_solid_release(s);
}

static CagStatus no_leaf(void *context, const CagSolid *leaf, CagVec3 p, int *side, CagError *e) {
  (void)context;
  (void)e;
  double d = cag_norm(p) - leaf->a; // spheres where they stand
  *side = fabs(d) < 1e-12 ? 0 : d < 0 ? -1 : 1;
  return CAG_OK;
}

static void boundaries_belong_to_both_sides(void **state) {
  (void)state;
  int side;
  CagSolid *s = combined(CAG_DIFFERENCE, sphere(3), sphere(1));
  const struct {
    double x;
    int side;
  } cases[] = {{0, 1}, {1, 0}, {2, -1}, {3, 0}, {4, 1}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    OK(cag_csg_side(s, cag_vec3(cases[i].x, 0, 0), 1e-12, no_leaf, NULL, &side, &err));
    assert_int_equal(side, cases[i].side);
  }
  cag_solid_release(s);
}

static void meshes_enclose_when_they_are_closed(void **state) {
  (void)state;
  CagMesh *m = NULL, *flipped = NULL;
  CagSolid *s = NULL, *b = box(2);
  OK(cag_solid_tessellate(b, NULL, &m, &err));
  OK(cag_mesh_flip(m, &flipped, &err));
  OK(cag_solid_from_mesh(flipped, &s, &err));
  NEAR(volume(s), 8, 1e-12);
  cag_solid_release(s);
  flipped->triangle_count--;
  assert_int_equal(cag_solid_from_mesh(flipped, &s, &err), CAG_E_ARGUMENT);
  assert_string_equal(err.reason, "mesh-open");
  cag_mesh_release(m);
  cag_mesh_release(flipped);
  cag_solid_release(b);
}

static void what_is_empty_or_endless_says_so(void **state) {
  (void)state;
  CagMesh *m = NULL;
  CagBounds b;
  CagSolid *s = combined(CAG_INTERSECTION, sphere(1), moved(sphere(1), 5, 0, 0));
  NEAR(volume(s), 0, 0);
  FAILS(cag_solid_bounds(s, &b, &err), "empty-shape");
  OK(cag_solid_tessellate(s, NULL, &m, &err));
  assert_int_equal(m->triangle_count, 0);
  cag_mesh_release(m);
  bool empty;
  OK(cag_solid_is_empty(s, &empty, &err));
  assert_true(empty);
  // The union with a ball is the ball, and the ball without it, too.
  s = combined(CAG_UNION, sphere(2), s);
  OK(cag_solid_bounds(s, &b, &err));
  near_vec(b.max, cag_vec3(2, 2, 2), 1e-12);
  NEAR(volume(s), 32 * M_PI / 3, 32 * M_PI / 3 * 2e-3);
  OK(cag_solid_is_empty(s, &empty, &err));
  assert_false(empty);
  cag_solid_release(s);
  CagSolid *nothing;
  OK(cag_solid_empty(&nothing, &err));
  s = combined(CAG_DIFFERENCE, box(2), nothing);
  NEAR(volume(s), 8, 1e-12);
  cag_solid_release(s);
  s = side_of(cag_vec3(0, 0, 0), cag_vec3(1, 1, 0));
  OK(cag_solid_is_empty(s, &empty, &err));
  assert_false(empty);
  cag_solid_release(s);
  s = combined(CAG_UNION, sphere(1), side_of(cag_vec3(0, 0, 0), cag_vec3(1, 1, 0)));
  assert_int_equal(cag_solid_bounds(s, &b, &err), CAG_E_ARGUMENT);
  assert_string_equal(err.reason, "solid-unbounded");
  // Cut by a ball it is the half ball and what the union adds of the other half.
  s = combined(CAG_INTERSECTION, s, sphere(3));
  NEAR(volume(s), 18 * M_PI + 2 * M_PI / 3, 20 * M_PI * 2e-3);
  cag_solid_release(s);
}

static void an_interrupt_stops_operations(void **state) {
  (void)state;
  static volatile int stop = 1;
  CagSolid *s = NULL, *parts[2] = {sphere(3), box(2)};
  CagMesh *m = NULL;
  OK(cag_solid_combine(CAG_DIFFERENCE, parts, 2, &stop, &s, &err));
  assert_int_equal(cag_solid_tessellate(s, NULL, &m, &err), CAG_E_CALLBACK);
  for (int i = 0; i < 2; i++) cag_solid_release(parts[i]);
  cag_solid_release(s);
}

static void clipped_surfaces_end_on_the_solid(void **state) {
  (void)state;
  CagSolid *by = sphere(2);
  CagSurface *s = NULL;
  CagMesh *m = NULL;
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  how.tolerance = 1e-3;
  OK(cag_surface_bilinear(cag_vec3(-5, -5, 1), cag_vec3(-5, 5, 1), cag_vec3(5, -5, 1),
                          cag_vec3(5, 5, 1), &s, &err));
  OK(cag_surface_clip(s, by, &how, &m, &err));
  NEAR(cag_mesh_area(m), 3 * M_PI, 3 * M_PI * 2e-3);
  double farthest = 0;
  for (size_t i = 0; i < m->vertex_count; i++) farthest = fmax(farthest, cag_norm(m->positions[i]));
  NEAR(farthest, 2, 1e-9);
  cag_mesh_release(m);
  cag_surface_release(s);
  cag_solid_release(by);
}

static void clipped_curves_end_on_the_solid(void **state) {
  (void)state;
  CagSolid *by = combined(CAG_DIFFERENCE, sphere(2), sphere(1));
  const CagVec3 ends[2] = {{-5, 0, 0}, {5, 0, 0}};
  CagCurve *line = NULL, **pieces = NULL;
  size_t n = 0;
  CagVec3 p;
  OK(cag_curve_polyline(ends, 2, false, 3, &line, &err));
  OK(cag_curve_clip(line, by, NULL, &pieces, &n, &err));
  assert_int_equal(n, 2);
  const double at[4] = {-2, -1, 1, 2};
  for (size_t i = 0; i < 4; i++) {
    const CagCurve *c = pieces[i / 2];
    OK(cag_curve_point(c, i % 2 ? c->end : c->start, &p, &err));
    near_vec(p, cag_vec3(at[i], 0, 0), 1e-10);
  }
  for (size_t i = 0; i < n; i++) cag_curve_release(pieces[i]);
  free(pieces);
  cag_curve_release(line);
  cag_solid_release(by);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(operations_of_one_kind_are_one),
      cmocka_unit_test(moved_operations_share_their_mesh),
      cmocka_unit_test(reach_of_sides),
      cmocka_unit_test(bounds_of_differences_that_keep_their_sides),
      cmocka_unit_test(boundaries_belong_to_both_sides),
      cmocka_unit_test(meshes_enclose_when_they_are_closed),
      cmocka_unit_test(what_is_empty_or_endless_says_so),
      cmocka_unit_test(an_interrupt_stops_operations),
      cmocka_unit_test(clipped_surfaces_end_on_the_solid),
      cmocka_unit_test(clipped_curves_end_on_the_solid),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
