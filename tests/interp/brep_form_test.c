// Primitives, extrusions, and revolutions with their own surfaces: the kinds of faces, and the
// curves of edges, which are on their carriers where the traces are.

#include "geom/boundary/carrier.h"
#include "geom/curve/region.h"
#include "geom/solid/solid.h"
#include "interp/formats/brep.h"
#include "tests/interp/scene_fixture.h"

#define FULL (2 * M_PI)

static CagBrep boundary_of(CagSolid *s) {
  Fixture f;
  CagBrep b;
  fixture_begin(&f);
  fixture_solid(&f, "form", s);
  OK(cag_brep_of_scene(&f.scene, NULL, CAG_BREP_STEP, &b, &err));
  fixture_end(&f);
  return b;
}

// Checks that every edge is used once in each direction, except poles, and that each loop continues
// from vertex to vertex.
static void check_uses(const CagBrep *b) {
  int *uses = calloc(2 * b->edge_count, sizeof *uses);
  for (size_t i = 0; i < b->use_count; i++) uses[2 * b->uses[i].edge + b->uses[i].reversed]++;
  for (size_t i = 0; i < b->edge_count; i++)
    if (b->edges[i].curve) {
      assert_int_equal(uses[2 * i], 1);
      assert_int_equal(uses[2 * i + 1], 1);
    }
  free(uses);
  for (size_t l = 0; l < b->loop_count; l++)
    for (size_t i = 0; i < b->loops[l].count; i++) {
      const CagBrepUse *u = &b->uses[b->loops[l].first + i];
      const CagBrepUse *v = &b->uses[b->loops[l].first + (i + 1) % b->loops[l].count];
      assert_int_equal(u->reversed ? b->edges[u->edge].from : b->edges[u->edge].to,
                       v->reversed ? b->edges[v->edge].to : b->edges[v->edge].from);
    }
}

// Checks that edges lie on the planes of faces, and on other carriers at their traces.
static void check_use(const CagBrep *b, const CagBrepFace *f, const CagBrepUse *use) {
  const CagBrepEdge *e = &b->edges[use->edge];
  for (int k = 0; k <= 4; k++) {
    CagCarrierPoint on;
    CagVec3 p = b->vertices[e->from], uv;
    const CagCurve *c = e->curve ? e->curve : use->trace;
    const double t = c->start + (c->end - c->start) * k / 4;
    if (e->curve) OK(cag_curve_point(e->curve, t, &p, &err));
    if (k % 4 == 0 && e->curve)
      assert_true(cag_norm(cag_sub(p, b->vertices[k ? e->to : e->from])) < 1e-12);
    if (f->carrier.kind == CAG_CARRIER_PLANE) {
      const CagVec3 off = cag_sub(p, cag_frame_column(&f->carrier.frame, 3));
      assert_true(fabs(cag_dot(off, cag_frame_column(&f->carrier.frame, 2))) < 1e-12);
      continue;
    }
    OK(cag_curve_point(use->trace, t, &uv, &err));
    OK(cag_carrier_eval(&f->carrier, uv.x, uv.y, &on, &err));
    assert_true(cag_norm(cag_sub(on.point, p)) < 1e-12);
  }
}

// Counts the faces of each kind after all checks, and releases the boundary.
static void expect_kinds(CagBrep b, size_t planes, size_t cylinders, size_t cones, size_t spheres,
                         size_t tori) {
  size_t found[CAG_CARRIER_EXTRUDED + 1] = {0};
  check_uses(&b);
  for (size_t f = 0; f < b.face_count; f++) {
    found[b.faces[f].carrier.kind]++;
    for (size_t l = 0; l < b.faces[f].count; l++) {
      const CagBrepLoop *loop = &b.loops[b.faces[f].first + l];
      for (size_t u = 0; u < loop->count; u++) check_use(&b, &b.faces[f], &b.uses[loop->first + u]);
    }
  }
  assert_int_equal(found[CAG_CARRIER_NONE], 0);
  assert_int_equal(found[CAG_CARRIER_PLANE], planes);
  assert_int_equal(found[CAG_CARRIER_CYLINDER], cylinders);
  assert_int_equal(found[CAG_CARRIER_CONE], cones);
  assert_int_equal(found[CAG_CARRIER_SPHERE], spheres);
  assert_int_equal(found[CAG_CARRIER_TORUS], tori);
  cag_brep_free(&b);
}

// A similarity that mirrors.
static CagSolid *moved(CagSolid *s) {
  const CagTransform turn = cag_rpy(0.3, -0.7, 2), shift = cag_translate(cag_vec3(1, 2, 3));
  CagTransform mirror = cag_transform_identity();
  mirror.m[0][0] = -2, mirror.m[1][1] = 2, mirror.m[2][2] = 2;
  mirror = cag_transform_multiply(&turn, &mirror);
  mirror = cag_transform_multiply(&shift, &mirror);
  CagSolid *out;
  OK(cag_solid_transform(s, &mirror, &out, &err));
  cag_solid_release(s);
  return out;
}

static void primitives_have_their_own_surfaces(void **state) {
  (void)state;
  for (int k = 0; k < 2; k++) {
    CagSolid *s[6];
    OK(cag_solid_box(cag_vec3(1, 2, 3), false, &s[0], &err));
    OK(cag_solid_sphere(2, &s[1], &err));
    OK(cag_solid_cylinder(5, 2, 2, &s[2], &err));
    OK(cag_solid_cylinder(5, 2, 0, &s[3], &err));
    OK(cag_solid_cylinder(5, 1, 2, &s[4], &err));
    OK(cag_solid_torus(5, 2, &s[5], &err));
    for (int i = 0; k == 1 && i < 6; i++) s[i] = moved(s[i]);
    expect_kinds(boundary_of(s[0]), 6, 0, 0, 0, 0);
    expect_kinds(boundary_of(s[1]), 0, 0, 0, 1, 0);
    expect_kinds(boundary_of(s[2]), 2, 1, 0, 0, 0);
    expect_kinds(boundary_of(s[3]), 1, 0, 1, 0, 0);
    expect_kinds(boundary_of(s[4]), 2, 0, 1, 0, 0);
    expect_kinds(boundary_of(s[5]), 0, 0, 0, 0, 1);
  }
}

static CagRegion *region_of(CagCurve *outer, CagCurve *hole) {
  CagRegion *r;
  OK(cag_region_new(outer, &hole, hole ? 1 : 0, &r, &err));
  cag_curve_release(outer);
  cag_curve_release(hole);
  return r;
}

static CagCurve *polygon(const CagVec3 *p, size_t n) {
  CagCurve *c;
  OK(cag_curve_polyline(p, n, true, 2, &c, &err));
  return c;
}

static CagCurve *circle(double x, double y, double a, double b) {
  CagTransform frame = cag_translate(cag_vec3(x, y, 0));
  CagCurve *c;
  frame.planar = true;
  OK(cag_curve_arc(a, b, 0, FULL, &frame, &c, &err));
  return c;
}

static void extrusions_of_lines_and_arcs_have_planes_and_cylinders(void **state) {
  (void)state;
  const CagVec3 triangle[3] = {{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}};
  for (int k = 0; k < 4; k++) {
    CagRegion *r = region_of(polygon(triangle, 3), circle(0, 0, 2, 2));
    CagSolid *s;
    OK(cag_solid_extrude(r, cag_vec3(0, 0, k % 2 ? -4 : 4), 0, 1, &s, &err));
    cag_region_release(r);
    expect_kinds(boundary_of(k < 2 ? s : moved(s)), 5, 1, 0, 0, 0);
  }
}

static void revolutions_of_lines_and_arcs_have_quadrics_and_tori(void **state) {
  (void)state;
  const CagVec3 profile[5] = {{0, 0, 0}, {9, 0, 0}, {9, 5, 0}, {5, 8, 0}, {0, 8, 0}};
  const double turns[3][2] = {{0, FULL}, {0.5, 2}, {-1, 4}};
  for (int k = 0; k < 3; k++) {
    const bool full = k == 0;
    CagSolid *s, *t;
    CagRegion *r = region_of(polygon(profile, 5), NULL),
              *disk = region_of(circle(6, 1, 2, 2), NULL);
    const CagVec3 z = {0, 0, 1}, origin = {0, 0, 0};
    OK(cag_solid_revolve(r, z, origin, turns[k][0], turns[k][1], &s, &err));
    OK(cag_solid_revolve(disk, z, origin, turns[k][0], turns[k][1], &t, &err));
    cag_region_release(r);
    cag_region_release(disk);
    expect_kinds(boundary_of(s), full ? 2 : 4, 1, 1, 0, 0);
    expect_kinds(boundary_of(moved(t)), full ? 0 : 2, 0, 0, 0, 1);
  }
}

static void others_remain_splines(void **state) {
  (void)state;
  CagSolid *s[3], *t;
  CagTransform uneven = cag_transform_identity();
  uneven.m[0][0] = 3;
  OK(cag_solid_sphere(2, &t, &err));
  OK(cag_solid_transform(t, &uneven, &s[0], &err));
  cag_solid_release(t);
  CagRegion *r = region_of(circle(0, 0, 3, 2), NULL), *lens = region_of(circle(0, 0, 3, 3), NULL);
  OK(cag_solid_extrude(r, cag_vec3(0, 0, 4), 0, 1, &s[1], &err));
  OK(cag_solid_extrude(lens, cag_vec3(1, 0, 4), 0, 1, &s[2], &err)); // an oblique cylinder
  cag_region_release(r);
  cag_region_release(lens);
  for (int i = 0; i < 3; i++) {
    CagBrep b = boundary_of(s[i]);
    for (size_t f = 0; f < b.face_count; f++)
      assert_int_equal(b.faces[f].carrier.kind, CAG_CARRIER_NONE);
    cag_brep_free(&b);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(primitives_have_their_own_surfaces),
      cmocka_unit_test(extrusions_of_lines_and_arcs_have_planes_and_cylinders),
      cmocka_unit_test(revolutions_of_lines_and_arcs_have_quadrics_and_tori),
      cmocka_unit_test(others_remain_splines),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
