// Extrusions with rounded ends: rims, edges, and formulas; and rounded boxes and cylinders.

#include "geom/solid/rounded.h"
#include "geom/surface/rim.h"
#include "surface_support.h"

static CagRegion *new_region(CagCurve *const *curves, size_t n) {
  CagCurve *loop;
  CagRegion *r;
  MUST(cag_curve_join(curves, n, &loop, err));
  MUST(cag_region_new(loop, NULL, 0, &r, err));
  cag_curve_release(loop);
  return r;
}

// The upper half of a disk of radius 5.
static CagRegion *new_half_disk(void) {
  const CagTransform frame = cag_transform_identity();
  CagCurve *parts[2];
  MUST(cag_curve_line(cag_vec3(-5, 0, 0), cag_vec3(5, 0, 0), 2, &parts[0], err));
  MUST(cag_curve_arc(5, 5, 0, M_PI, &frame, &parts[1], err));
  CagRegion *r = new_region(parts, 2);
  cag_curve_release(parts[0]);
  cag_curve_release(parts[1]);
  return r;
}

static CagRegion *new_l(void) {
  const CagVec3 p[] = {{0, 0, 0}, {10, 0, 0}, {10, 4, 0}, {4, 4, 0}, {4, 10, 0}, {0, 10, 0}};
  CagCurve *c;
  CagRegion *r;
  MUST(cag_curve_polyline(p, 6, true, 2, &c, err));
  MUST(cag_region_new(c, NULL, 0, &r, err));
  cag_curve_release(c);
  return r;
}

static CagSolid *new_extrusion(CagRegion *r, double height, CagRoundedEnd start,
                               CagRoundedEnd end) {
  CagSolid *s;
  const CagRoundedEnd ends[2] = {start, end};
  MUST(cag_solid_extrude_rounded(r, height, ends, &s, err));
  cag_region_release(r);
  return s;
}

static CagVec3 side_at(const CagSurface *f, int side, double fraction) {
  const double u = f->u0 + fraction * (f->u1 - f->u0), v = f->v0 + fraction * (f->v1 - f->v0);
  return side < 2 ? surface_at(f, side == 0 ? f->u0 : f->u1, v)
                  : surface_at(f, u, side == 2 ? f->v0 : f->v1);
}

// Edges between faces other than caps run along the same points, and sides that are not poles or
// seams have one edge each.
static void assert_edges(const CagSolid *s) {
  size_t sides = 0, used = 0;
  for (size_t f = 0; f < s->face_count; f++) {
    const CagSurface *face = s->faces[f];
    if (cag_surface_planar_view(face, NULL, NULL)) continue;
    sides += face->closed_u ? 0 : (size_t)!face->pole_u0 + !face->pole_u1;
    sides += face->closed_v ? 0 : (size_t)!face->pole_v0 + !face->pole_v1;
  }
  for (size_t e = 0; e < s->edge_count; e++) {
    const CagFaceEdge *edge = &s->edges[e];
    const CagSurface *a = s->faces[edge->face[0]], *b = s->faces[edge->face[1]];
    used += (size_t)(edge->side[0] < 4) + (edge->side[1] < 4);
    if (edge->side[0] >= 4 || edge->side[1] >= 4) continue;
    for (int i = 0; i <= 4; i++) {
      const double t = i / 4.0;
      assert_point(side_at(a, edge->side[0], t),
                   side_at(b, edge->side[1], edge->reversed ? 1 - t : t), 1e-11, "edge");
    }
  }
  assert_int_equal(used, sides);
}

static double volume_of(const CagSolid *s) {
  CagMassProperties m;
  MUST(cag_solid_mass(s, &m, err));
  return m.volume;
}

static void rims_have_consistent_derivatives(void **state) {
  (void)state;
  CagCurve *line, *arc;
  CagSurface *face;
  CagRimMiter miter;
  bool fits;
  const CagTransform frame = cag_transform_identity();
  MUST(cag_curve_line(cag_vec3(-5, 0, 0), cag_vec3(5, 0, 0), 2, &line, err));
  MUST(cag_curve_arc(5, 5, 0, M_PI, &frame, &arc, err));
  for (int k = 0; k < 4; k++) {
    const CagRimProfile p = {1, k % 2 == 0, 3, k < 2 ? 1 : -1};
    MUST(cag_rim_miter(line, arc, &p, &fits, &miter, err));
    assert_true(fits);
    MUST(cag_surface_rim(line, &p, NULL, &miter, &face, err));
    assert_consistent(face);
    cag_surface_release(face);
    MUST(cag_surface_rim(arc, &p, &miter, NULL, &face, err));
    assert_consistent(face);
    cag_surface_release(face);
    cag_rim_miter_free(&miter);
  }
  cag_curve_release(line);
  cag_curve_release(arc);
}

// On the offset of the line y = 0 by d, and on the circle of radius 5 - d.
static void a_miter_is_on_both_offsets(void **state) {
  (void)state;
  CagCurve *line, *arc;
  CagSurface *face;
  CagRimMiter miter;
  bool fits;
  const CagTransform frame = cag_transform_identity();
  const CagRimProfile p = {2, true, 0, 1};
  MUST(cag_curve_line(cag_vec3(-5, 0, 0), cag_vec3(5, 0, 0), 2, &line, err));
  MUST(cag_curve_arc(5, 5, 0, M_PI, &frame, &arc, err));
  MUST(cag_rim_miter(line, arc, &p, &fits, &miter, err));
  MUST(cag_surface_rim(arc, &p, &miter, NULL, &face, err));
  for (int i = 0; i <= 20; i++) {
    const double v = i / 20.0, d = 2 * (1 - cos(v * M_PI / 2));
    const CagVec3 q = surface_at(face, 0, v);
    assert_point(q, cag_vec3(sqrt((5 - d) * (5 - d) - d * d), d, 2 * sin(v * M_PI / 2)), 1e-12,
                 "miter");
  }
  cag_surface_release(face);
  cag_rim_miter_free(&miter);
  // Beyond d = 2.5 the line is used up.
  const CagRimProfile wide = {2.6, true, 0, 1};
  MUST(cag_rim_miter(line, arc, &wide, &fits, &miter, err));
  assert_false(fits);
  cag_curve_release(line);
  cag_curve_release(arc);
}

static void all_sides_of_faces_are_shared(void **state) {
  (void)state;
  const CagRoundedEnd fillet = {1, true}, chamfer = {0.7, false}, none = {0, false};
  const struct {
    bool half;
    CagRoundedEnd start, end;
    size_t faces;
  } CASES[] = {
      {false, fillet, fillet, 2 + 6 + 2 * 7},
      {false, none, chamfer, 2 + 6 + 7},
      {true, fillet, chamfer, 2 + 3 * 2},
      {true, chamfer, none, 2 + 2 * 2},
  };
  for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
    CagSolid *s =
        new_extrusion(CASES[i].half ? new_half_disk() : new_l(), 5, CASES[i].start, CASES[i].end);
    assert_true(cag_check_solid(s));
    assert_int_equal(s->face_count, CASES[i].faces);
    assert_edges(s);
    cag_solid_release(s);
  }
  // Without sides, the rims of both ends meet.
  CagSolid *s = new_extrusion(new_l(), 2, fillet, fillet);
  assert_int_equal(s->face_count, 2 + 2 * 7);
  assert_edges(s);
  cag_solid_release(s);
}

// The same shell is found by comparing the edges of its faces.
static void the_faces_are_a_closed_shell(void **state) {
  (void)state;
  const CagRoundedEnd fillet = {1, true}, chamfer = {0.7, false};
  CagSolid *shell, *s = new_extrusion(new_l(), 5, fillet, chamfer);
  MUST(cag_solid_shell(s->faces, s->face_count, &shell, err));
  assert_near(volume_of(shell), volume_of(s), 1e-9, "volume");
  cag_solid_release(shell);
  cag_solid_release(s);
}

// The slopes of 45 degrees of an L: A h - P/2 d^2 + (5 - pi/4) d^3/3.
static void a_chamfered_l_has_the_volume_of_its_sections(void **state) {
  (void)state;
  const CagRoundedEnd none = {0, false}, chamfer = {1.5, false};
  CagSolid *s = new_extrusion(new_l(), 5, none, chamfer);
  const double d = 1.5;
  assert_near(volume_of(s), 64 * 5 - 20 * d * d + (5 - M_PI / 4) * d * d * d / 3, 1e-10, "volume");
  cag_solid_release(s);
}

static void what_does_not_fit_is_rejected(void **state) {
  (void)state;
  CagSolid *s;
  CagRegion *l = new_l();
  const CagRoundedEnd wide[2] = {{2, true}, {0, false}}, high[2] = {{1, true}, {1.5, false}};
  MUST_FAIL(cag_solid_extrude_rounded(l, 5, wide, &s, err), "rounding-too-large");
  MUST_FAIL(cag_solid_extrude_rounded(l, 2.4, high, &s, err), "rounding-too-large");
  cag_region_release(l);
}

static void rounded_bodies_share_all_edges(void **state) {
  (void)state;
  CagSolid *s;
  MUST(cag_solid_rounded_box(cag_vec3(10, 20, 30), 3, false, &s, err));
  assert_int_equal(s->face_count, 26);
  assert_int_equal(s->edge_count, 48);
  assert_edges(s);
  cag_solid_release(s);
  // A rod with round ends: the faces of four edges, and eight octants with poles.
  MUST(cag_solid_rounded_box(cag_vec3(2, 2, 8), 1, false, &s, err));
  assert_int_equal(s->face_count, 12);
  assert_int_equal(s->edge_count, 4 + 8 + 8);
  cag_solid_release(s);
  MUST(cag_solid_rounded_cylinder(10, 4, 1, &s, err));
  assert_int_equal(s->face_count, 5);
  assert_int_equal(s->edge_count, 4);
  cag_solid_release(s);
  MUST(cag_solid_rounded_cylinder(10, 4, 4, &s, err));
  assert_int_equal(s->face_count, 3);
  assert_int_equal(s->edge_count, 2);
  cag_solid_release(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rims_have_consistent_derivatives),
      cmocka_unit_test(a_miter_is_on_both_offsets),
      cmocka_unit_test(all_sides_of_faces_are_shared),
      cmocka_unit_test(the_faces_are_a_closed_shell),
      cmocka_unit_test(a_chamfered_l_has_the_volume_of_its_sections),
      cmocka_unit_test(what_does_not_fit_is_rejected),
      cmocka_unit_test(rounded_bodies_share_all_edges),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
