// Other representations of surfaces have the same points; offsets, parts, and joins are compared
// with closed forms.

#include "geom/surface/reshape.h"
#include "tests/geom/surface_support.h"

// A rational surface with uneven knots, and a crease.
static CagSurface *wavy(void) {
  CagSurface *s = NULL;
  CagVec3 net[6 * 4];
  double weights[6 * 4];
  for (int i = 0; i < 6; i++)
    for (int j = 0; j < 4; j++) {
      net[4 * i + j] = cag_vec3(i, j, sin(1.3 * i) + 0.4 * cos(2.1 * j) + 0.1 * i * j);
      weights[4 * i + j] = 1 + 0.25 * ((i + 2 * j) % 3);
    }
  double ku[] = {0, 0, 0, 0, 1, 2.5, 4, 4, 4, 4}, kv[] = {0, 0, 0, 1, 2, 2, 2};
  MUST(cag_surface_nurbs(net, weights, 6, 4, 3, 2, ku, kv, &s, err));
  return s;
}

static void assert_same(const CagSurface *a, const CagSurface *b, const char *what) {
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      double u = inside(b->u0, b->u1, i), v = inside(b->v0, b->v1, j);
      assert_point(surface_at(b, u, v), surface_at(a, u, v), 1e-12, what);
    }
}

static void nets_change_and_points_stay(void **state) {
  (void)state;
  CagSurface *s = wavy(), *t = NULL;
  CagSurfaceNurbsView v;
  MUST(cag_surface_insert_knot(s, 0, 1.7, 2, &t, err));
  cag_surface_nurbs_view(t, &v);
  assert_int_equal(v.nu, 8);
  assert_same(s, t, "knot");
  cag_surface_release(t);
  MUST_FAIL(cag_surface_insert_knot(s, 1, 1, 2, &t, err), "knot-multiplicity");
  MUST_FAIL(cag_surface_insert_knot(s, 1, 5, 1, &t, err), "parameter-range");
  MUST(cag_surface_refine(s, true, true, &t, err));
  cag_surface_nurbs_view(t, &v);
  assert_int_equal(v.nu, 9);
  assert_int_equal(v.nv, 6);
  assert_same(s, t, "refined");
  cag_surface_release(t);
  MUST(cag_surface_elevate(s, 1, 2, &t, err));
  cag_surface_nurbs_view(t, &v);
  assert_int_equal(v.degree_u, 4);
  assert_int_equal(v.degree_v, 4);
  // Each elevation increases the multiplicity of inner knots: 6 + 1 + 2, and 4 + 2 (1 + 1).
  assert_int_equal(v.nu, 9);
  assert_int_equal(v.nv, 8);
  assert_same(s, t, "elevated");
  cag_surface_release(t);
  MUST(cag_surface_part(s, 0.5, 3, 0.25, 1.5, &t, err));
  assert_near(t->u0, 0.5, 0, "domain");
  assert_same(s, t, "part");
  cag_surface_release(t);
  MUST_FAIL(cag_surface_part(s, 0.5, 5, 0, 1, &t, err), "parameter-range");
  CagSurface **pieces;
  size_t nu, nv;
  MUST(cag_surface_to_bezier(s, &pieces, &nu, &nv, err));
  assert_int_equal(nu, 3);
  assert_int_equal(nv, 2);
  assert_point(surface_at(pieces[2 * 1 + 1], 0.5, 0.5), surface_at(s, 1.75, 1.5), 1e-12, "piece");
  for (size_t i = 0; i < nu * nv; i++) cag_surface_release(pieces[i]);
  free(pieces);
  MUST(cag_surface_transpose(s, &t, err));
  assert_point(surface_at(t, 0.7, 1.9), surface_at(s, 1.9, 0.7), 1e-13, "transposed");
  cag_surface_release(t);
  cag_surface_release(s);
}

// A torus does not have its own net.
static void parts_of_other_kinds(void **state) {
  (void)state;
  CagSurface *torus = NULL, *part = NULL, *turned = NULL;
  MUST(cag_surface_torus(3, 1, &torus, err));
  MUST(cag_surface_part(torus, torus->u0, torus->u1, 0, M_PI / 2, &part, err));
  double whole, area;
  CagVec3 c;
  MUST(cag_surface_area(torus, &whole, &c, err));
  MUST(cag_surface_area(part, &area, &c, err));
  bool quarter = fabs(area / whole - 0.25) < 1e-8;
  // A quarter about the tube's own circle has another fraction: (pi / 2 R + r) of 2 pi R.
  bool tube = fabs(area / whole - (M_PI / 2 * 3 + 1) / (2 * M_PI * 3)) < 1e-8;
  assert_true(quarter || tube);
  assert_consistent(part);
  MUST(cag_surface_transpose(torus, &turned, err));
  assert_consistent(turned);
  cag_surface_release(turned);
  cag_surface_release(part);
  cag_surface_release(torus);
}

static void joined_parts_are_the_whole(void **state) {
  (void)state;
  CagSurface *s = wavy(), *a = NULL, *b = NULL, *t = NULL, *flipped = NULL;
  CagSeam seam;
  MUST(cag_surface_part(s, s->u0, 2, s->v0, s->v1, &a, err));
  MUST(cag_surface_part(s, 2, s->u1, s->v0, s->v1, &b, err));
  MUST(cag_surface_seam(a, b, 1e-9, &seam, err));
  assert_true(seam.c0 && seam.c1 && seam.g1 && seam.g2);
  assert_int_equal(seam.side[0], 1);
  assert_int_equal(seam.side[1], 0);
  MUST(cag_surface_join(a, b, 1e-9, &t, err));
  assert_same(s, t, "joined");
  cag_surface_release(t);
  // If the surface is transposed and flipped, the edge is still found.
  cag_surface_release(a);
  MUST(cag_surface_transpose(b, &a, err));
  MUST(cag_surface_flip(a, &flipped, err));
  cag_surface_release(a);
  MUST(cag_surface_part(s, s->u0, 2, s->v0, s->v1, &a, err));
  MUST(cag_surface_join(a, flipped, 1e-9, &t, err));
  double whole, area;
  CagVec3 c;
  MUST(cag_surface_area(s, &whole, &c, err));
  MUST(cag_surface_area(t, &area, &c, err));
  assert_near(area, whole, 1e-8, "joined area");
  cag_surface_release(t);
  cag_surface_release(flipped);
  MUST(cag_surface_part(s, 3, s->u1, s->v0, s->v1, &t, err));
  MUST_FAIL(cag_surface_join(a, t, 1e-9, &flipped, err), "edges-do-not-match");
  cag_surface_release(t);
  cag_surface_release(a);
  cag_surface_release(b);
  cag_surface_release(s);
}

static void offsets_and_plates(void **state) {
  (void)state;
  CagSurface *torus = NULL, *grown = NULL, *s = wavy();
  MUST(cag_surface_torus(3, 1, &torus, err));
  MUST(cag_surface_offset(torus, 0.5, &grown, err));
  assert_area(grown, 4 * M_PI * M_PI * 3 * 1.5);
  assert_consistent(grown);
  cag_surface_release(grown);
  MUST(cag_surface_offset(s, 0.1, &grown, err));
  assert_consistent(grown);
  cag_surface_release(grown);
  CagSolid *plate = NULL;
  CagMassProperties m;
  MUST(cag_solid_thicken(torus, 0.5, &plate, err));
  MUST(cag_solid_mass(plate, &m, err));
  assert_near(m.volume, 2 * M_PI * M_PI * 3 * (2.25 - 1), 1e-7, "hollow torus");
  cag_solid_release(plate);
  // Steiner's formula, A d - H d^2 + K d^3 / 3. For a quarter cylinder of radius 2, outward: pi / 4
  // (9 - 4) h.
  CagSurface *quarter = NULL, *exact = NULL;
  CagCurve *edge = NULL;
  MUST(cag_curve_line(cag_vec3(2, 0, 0), cag_vec3(2, 0, 5), 3, &edge, err));
  MUST(cag_surface_revolve(edge, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0, M_PI / 2, &quarter, err));
  for (int k = 0; k < 2; k++) {
    double d = k == 0 ? 1 : -1;
    MUST(cag_solid_thicken(quarter, d, &plate, err));
    MUST(cag_solid_mass(plate, &m, err));
    bool outward = fabs(m.volume - M_PI / 4 * 5 * 5) < 1e-6;
    bool inward = fabs(m.volume - M_PI / 4 * 3 * 5) < 1e-6;
    assert_true(outward || inward);
    assert_int_equal(plate->face_count, 6);
    cag_solid_release(plate);
  }
  cag_curve_release(edge);
  cag_surface_release(exact);
  cag_surface_release(quarter);
  cag_surface_release(torus);
  cag_surface_release(s);
}

// Unrolling a cylinder, a cone, and a ruled strip preserves the first form, and therefore lengths
// and areas.
static void unrolling_keeps_lengths(void **state) {
  (void)state;
  CagCurve *c[3] = {NULL, NULL, NULL};
  CagSurface *s[3] = {NULL, NULL, NULL}, *flat = NULL;
  CagVec3 bezier[] = {{0, 0, 0}, {1, 2, 0}, {3, -1, 0}, {4, 1, 0}};
  MUST(cag_curve_line(cag_vec3(0, 0, 4), cag_vec3(3, 0, 0), 3, &c[0], err));
  MUST(cag_surface_revolve(c[0], cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0, 2 * M_PI, &s[0], err));
  MUST(cag_curve_bezier(bezier, NULL, 4, 3, &c[1], err));
  MUST(cag_surface_extrude(c[1], cag_vec3(1, 0.5, 3), 0, 1, &s[1], err));
  // A cone with its apex outside the curve's plane.
  CagTransform half;
  MUST(cag_scale(cag_vec3(0.25, 0.25, 0.25), cag_vec3(1, 1, 5), &half, err));
  MUST(cag_curve_transform(c[1], &half, &c[2], err));
  MUST(cag_surface_ruled(c[1], c[2], &s[2], err));
  for (int k = 0; k < 3; k++) {
    MUST(cag_surface_unroll(s[k], &flat, err));
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 4; j++) {
        double u = inside(s[k]->u0, s[k]->u1, i), v = inside(s[k]->v0, s[k]->v1, j);
        CagVec3 a[4], b[4];
        MUST(cag_surface_eval(s[k], u, v, 1, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, a, err));
        MUST(cag_surface_eval(flat, u, v, 1, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, b, err));
        assert_near(b[0].z, 0, 0, "flat");
        assert_near(cag_dot(b[1], b[1]), cag_dot(a[1], a[1]), 1e-9, "G");
        assert_near(cag_dot(b[1], b[2]), cag_dot(a[1], a[2]), 1e-9, "F");
        assert_near(cag_dot(b[2], b[2]), cag_dot(a[2], a[2]), 1e-9, "E");
      }
    cag_surface_release(flat);
  }
  // The sector of the cone of slant 5 and radius 3 spans 216 degrees.
  MUST(cag_surface_unroll(s[0], &flat, err));
  CagVec3 p = surface_at(flat, flat->u1, 0), q = surface_at(flat, flat->u1, 2 * M_PI);
  assert_near(cag_norm(cag_sub(p, q)), 10 * sin(108 * M_PI / 180), 1e-9, "chord of the sector");
  cag_surface_release(flat);
  CagSurface *saddle = NULL;
  MUST(cag_surface_bilinear(cag_vec3(0, 0, 0), cag_vec3(0, 1, 0), cag_vec3(1, 0, 0),
                            cag_vec3(1, 1, 1), &saddle, err));
  MUST_FAIL(cag_surface_unroll(saddle, &flat, err), "not-developable");
  cag_surface_release(saddle);
  for (int k = 0; k < 3; k++) {
    cag_surface_release(s[k]);
    cag_curve_release(c[k]);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(nets_change_and_points_stay), cmocka_unit_test(parts_of_other_kinds),
      cmocka_unit_test(joined_parts_are_the_whole),  cmocka_unit_test(offsets_and_plates),
      cmocka_unit_test(unrolling_keeps_lengths),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
