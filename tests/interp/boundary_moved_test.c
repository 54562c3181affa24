// Moved copies of boundaries that cag-brep computed.

#include "geom/boundary/carrier.h"
#include "geom/boundary/features.h"
#include "geom/boundary/measure.h"
#include "geom/boundary/moved.h"
#include "tests/interp/boundary_support.h"

#define REQUIRE_KERNEL()                                                                           \
  if (!kernel) skip()

// The moves: rigid, scaled, mirrored, and mirrored and scaled.
static CagTransform move_number(int k) {
  CagTransform turn, other;
  OK(cag_rotate(cag_vec3(1, 2, 3), 0.7, cag_vec3(4, 0, 0), &turn, &err));
  if (k == 0) return turn;
  if (k == 1) {
    OK(cag_scale(cag_vec3(2.5, 2.5, 2.5), cag_vec3(1, 1, 1), &other, &err));
    return cag_transform_multiply(&turn, &other);
  }
  OK(cag_reflect(cag_vec3(1, -1, 0.5), cag_vec3(0, 0, 3), &other, &err));
  if (k == 2) return other;
  const CagTransform scaled = move_number(1);
  return cag_transform_multiply(&scaled, &other);
}

// Frames are right-handed, and each trace leads to the points of its edge.
static void check_invariants(const CagBoundary *b) {
  for (size_t i = 0; i < b->face_count; i++) {
    const CagBoundaryFace *f = &b->faces[i];
    const CagTransform *t = &f->carrier.frame;
    if (f->carrier.kind != CAG_CARRIER_SPLINE)
      near_vec(cag_cross(cag_frame_column(t, 0), cag_frame_column(t, 1)), cag_frame_column(t, 2),
               1e-12);
    for (size_t l = f->first; l < f->first + f->count; l++)
      for (size_t u = b->loops[l].first; u < b->loops[l].first + b->loops[l].count; u++) {
        const CagBoundaryEdge *e = &b->edges[b->uses[u].edge];
        for (int k = 0; e->curve && k <= 6; k++) {
          const double s = e->curve->start + (e->curve->end - e->curve->start) * k / 6;
          CagVec3 at, uv;
          CagCarrierPoint p;
          OK(cag_curve_point(e->curve, s, &at, &err));
          OK(cag_curve_point(b->uses[u].trace, s, &uv, &err));
          OK(cag_carrier_eval(&f->carrier, uv.x, uv.y, &p, &err));
          near_vec(p.point, at, 4 * e->gap + 1e-9);
          assert_true(uv.x > f->domain[0] - 1e-5 && uv.x < f->domain[1] + 1e-5);
          assert_true(uv.y > f->domain[2] - 1e-5 && uv.y < f->domain[3] + 1e-5);
        }
      }
  }
}

static void check_mass(const CagBoundary *b, const CagBoundary *to, const CagTransform *t) {
  CagMassProperties m, n;
  double s;
  assert_true(cag_transform_is_similarity(t, &s));
  OK(cag_boundary_mass(b, &m, &err));
  OK(cag_boundary_mass(to, &n, &err));
  // The faces meet along splines up to the gaps of the edges, at most 1e-6, and a turned boundary
  // shares the error out differently.
  NEAR(n.volume, m.volume * s * s * s, 1e-9 * n.volume);
  NEAR(n.area, m.area * s * s, 1e-9 * n.area);
  NEAR(to->volume, b->volume * s * s * s, 1e-10 * n.volume);
  near_vec(n.volume_centroid, cag_transform_point(t, m.volume_centroid), 1e-7);
  near_vec(to->centroid, cag_transform_point(t, b->centroid), 1e-8);
}

static void check_features(const CagBoundary *b, const CagBoundary *to, const CagTransform *t) {
  CagFeatures f, g;
  double s;
  cag_transform_is_similarity(t, &s);
  OK(cag_boundary_features(b, &f, &err));
  OK(cag_boundary_features(to, &g, &err));
  assert_int_equal(f.edge_count, g.edge_count);
  assert_int_equal(f.corner_count, g.corner_count);
  for (size_t i = 0; i < f.face_count; i++) {
    assert_string_equal(f.faces[i].kind, g.faces[i].kind);
    near_vec(g.faces[i].center, cag_transform_point(t, f.faces[i].center), 1e-7);
    if (b->faces[i].carrier.kind != CAG_CARRIER_PLANE) continue;
    near_vec(g.faces[i].normal, cag_scaled(cag_transform_vector(t, f.faces[i].normal), 1 / s),
             1e-12);
  }
  for (size_t i = 0; i < f.edge_count; i++) {
    assert_string_equal(f.edges[i].kind, g.edges[i].kind);
    assert_int_equal(f.edges[i].bend, g.edges[i].bend);
    NEAR(f.edges[i].angle, g.edges[i].angle, 1e-7);
    NEAR(g.edges[i].length, s * f.edges[i].length, 1e-8 * g.edges[i].length);
  }
  cag_features_free(&f);
  cag_features_free(&g);
}

static void check_moves(CagSolid *s) {
  CagBoundary b = boundary_of(s), to, back;
  check_invariants(&b);
  for (int k = 0; k < 4; k++) {
    CagTransform t = move_number(k), inverse;
    OK(cag_boundary_moved(&b, &t, &to, &err));
    check_invariants(&to);
    check_mass(&b, &to, &t);
    check_features(&b, &to, &t);
    OK(cag_transform_inverse(&t, &inverse, &err));
    OK(cag_boundary_moved(&to, &inverse, &back, &err));
    check_mass(&to, &back, &inverse);
    for (size_t i = 0; i < b.face_count; i++)
      assert_int_equal(back.faces[i].reversed, b.faces[i].reversed);
    for (size_t i = 0; i < b.corner_count; i++) near_vec(back.corners[i], b.corners[i], 1e-10);
    cag_boundary_free(&to);
    cag_boundary_free(&back);
  }
  cag_boundary_free(&b);
}

static void planes_and_cylinders(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagSolid *hole = turned(shifted(a_cylinder(60, 6, 6), 3, 0, -30), cag_vec3(0, 1, 0), M_PI / 6);
  check_moves(combined(CAG_DIFFERENCE, a_box(60, 50, 10), hole));
  CagSolid *a = shifted(a_cylinder(40, 6, 6), 0, 0, -20);
  CagSolid *b = turned(shifted(a_cylinder(40, 3, 3), 1, 0, -20), cag_vec3(1, 0, 0), M_PI / 2);
  check_moves(combined(CAG_UNION, a, b));
}

static void round_carriers(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  check_moves(combined(CAG_DIFFERENCE, a_sphere(10), shifted(a_box(20, 20, 20), 13, 2, 9)));
  check_moves(combined(CAG_DIFFERENCE, a_torus(10, 3), shifted(a_box(20, 20, 20), 13, 2, 9)));
  check_moves(
      combined(CAG_DIFFERENCE, a_cylinder(30, 10, 0), shifted(a_box(20, 20, 20), 13, 2, 9)));
  check_moves(
      combined(CAG_DIFFERENCE, a_cylinder(30, 6, 10), shifted(a_box(20, 20, 20), 13, 2, 9)));
}

static void splines(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagTransform t;
  OK(cag_scale(cag_vec3(1, 2, 3), cag_vec3(0, 0, 0), &t, &err));
  check_moves(
      combined(CAG_DIFFERENCE, moved(a_sphere(5), t), shifted(a_box(20, 20, 20), 10, 3, 10)));
}

static void extruded_and_revolved(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  static const double RADII[6] = {4, 6, 5, 3, 4, 5};
  for (int k = 0; k < 2; k++) {
    CagVec3 points[6];
    CagCurve *loop;
    CagRegion *r;
    CagSolid *s;
    for (int i = 0; i < 6; i++)
      points[i] = cag_vec3(12 + RADII[i] * cos(i * M_PI / 3), RADII[i] * sin(i * M_PI / 3), 0);
    OK(cag_curve_nurbs_closed(points, NULL, 6, 3, 2, &loop, &err));
    OK(cag_region_new(loop, NULL, 0, &r, &err));
    cag_curve_release(loop);
    if (k == 0) OK(cag_solid_extrude(r, cag_vec3(1, 2, 10), 0, 1, &s, &err));
    else OK(cag_solid_revolve(r, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0.3, 2, &s, &err));
    cag_region_release(r);
    check_moves(s);
  }
}

static void only_similarities(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagBoundary b = boundary_of(a_box(1, 2, 3)), out;
  CagTransform t;
  OK(cag_scale(cag_vec3(1, 2, 3), cag_vec3(0, 0, 0), &t, &err));
  FAILS(cag_boundary_moved(&b, &t, &out, &err), "no-boundary");
  cag_boundary_free(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(planes_and_cylinders),
      cmocka_unit_test(round_carriers),
      cmocka_unit_test(splines),
      cmocka_unit_test(extruded_and_revolved),
      cmocka_unit_test(only_similarities),
  };
  return cmocka_run_group_tests(tests, start_kernel, end_kernel);
}
