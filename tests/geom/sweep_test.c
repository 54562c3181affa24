// Sweeps and lofts: the reference's examples (06a, 6.3), closed forms, Pappus, and watertight
// meshes.

#include "geom/mesh/mesh.h"
#include "geom/solid/tessellate.h"
#include "geom/surface/loft.h"
#include "tests/geom/surface_support.h"

static CagCurve *line(CagVec3 a, CagVec3 b) {
  CagCurve *c = NULL;
  MUST(cag_curve_line(a, b, 3, &c, err));
  return c;
}

static CagCurve *circle(double radius) {
  CagCurve *c = NULL;
  CagTransform t = cag_transform_identity();
  MUST(cag_curve_arc(radius, radius, 0, 2 * M_PI, &t, &c, err));
  return c;
}

static CagRegion *rectangle(double w, double h) {
  CagRegion *r = NULL;
  MUST(cag_region_rectangle(w, h, 0, &r, err));
  return r;
}

static CagMotion *along(const CagCurve *path, CagOrient orient, double twist, double scale) {
  CagMotion *m = NULL;
  CagPathMotion how = {orient, {0, 0, 1}, {0, twist, NULL}, {1, scale, NULL}};
  MUST(cag_motion_along(path, &how, &m, err));
  return m;
}

static double volume(const CagSolid *s) {
  CagMassProperties p;
  MUST(cag_solid_mass(s, &p, err));
  return p.volume;
}

static void assert_watertight(const CagSolid *s, double tolerance) {
  CagMesh *mesh = NULL;
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  how.tolerance = tolerance;
  MUST(cag_solid_tessellate(s, &how, &mesh, err));
  assert_true(cag_mesh_is_watertight(mesh, NULL));
  cag_mesh_release(mesh);
}

// sweep.ex4: a segment along and about the x axis.
static void a_helicoid_of_example_4(void **state) {
  (void)state;
  CagCurve *section = NULL, *path = line(cag_vec3(0, 0, 0), cag_vec3(10, 0, 0));
  MUST(cag_curve_line(cag_vec3(0, 0, 0), cag_vec3(0, 3, 0), 2, &section, err));
  CagMotion *m = along(path, CAG_ORIENT_FIXED, 2 * M_PI, 1);
  CagSurface *s = NULL;
  MUST(cag_surface_sweep(section, m, &s, err));
  assert_point(surface_at(s, (s->u0 + s->u1) / 2, (s->v0 + s->v1) / 2), cag_vec3(5, -1.5, 0), 1e-12,
               "sweep.ex4");
  assert_consistent(s);
  assert_transforms(s);
  MUST_FAIL(cag_surface_to_nurbs(s, &s, err), "no-exact-form");
  cag_surface_release(s);
  cag_motion_release(m);
  cag_curve_release(section);
  cag_curve_release(path);
}

// sweep.box-claim, sweep.cylinder-claim, sweep.cone-claim, sweep.section-with-hole; V = A L (1 + k
// + k^2) / 3 for any twist.
static void straight_sweeps_have_the_volumes_of_the_reference(void **state) {
  (void)state;
  CagCurve *path = line(cag_vec3(1, 2, 3), cag_vec3(1, 2 + 3, 3 + 4)); // length 5
  CagRegion *r = rectangle(3, 2);
  static const double TWIST[] = {0, 0, 1.2}, SCALE[] = {1, 0.5, 2};
  for (int i = 0; i < 3; i++) {
    CagMotion *m = along(path, CAG_ORIENT_RMF, TWIST[i], SCALE[i]);
    CagSolid *s = NULL;
    MUST(cag_solid_sweep(r, m, &s, err));
    double k = SCALE[i];
    assert_near(volume(s), 30 * (1 + k + k * k) / 3, 1e-8, "straight sweep");
    assert_watertight(s, 0.05);
    cag_solid_release(s);
    cag_motion_release(m);
  }
  cag_region_release(r);
  CagCurve *disk = circle(2);
  MUST(cag_region_new(disk, NULL, 0, &r, err));
  for (int apex = 0; apex < 2; apex++) {
    CagMotion *m = along(path, CAG_ORIENT_RMF, 0, apex ? 0 : 1);
    CagSolid *s = NULL;
    MUST(cag_solid_sweep(r, m, &s, err));
    assert_near(volume(s), apex ? 20.943951023931955 : 62.83185307179586, 1e-9, "sweep.cylinder");
    assert_int_equal(s->face_count, apex ? 2 : 3);
    double area;
    CagVec3 c;
    MUST(cag_surface_area(cag_solid_side(s), &area, &c, err));
    assert_near(area, apex ? 33.8359883929281 : 62.83185307179586, 1e-8, "sweep.cone-claim");
    assert_watertight(s, 0.05);
    // Exact forms of both.
    CagSurface *exact = NULL;
    MUST(cag_surface_to_nurbs(s->faces[0], &exact, err));
    MUST(cag_surface_area(exact, &area, &c, err));
    assert_near(area, apex ? 33.8359883929281 : 62.83185307179586, 1e-8, "exact form");
    cag_surface_release(exact);
    cag_solid_release(s);
    cag_motion_release(m);
  }
  cag_region_release(r);
  cag_curve_release(disk);
  // A square of 4 with a square hole of 2, length 2.
  CagVec3 outer[] = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
  CagVec3 inner[] = {{1, 1, 0}, {3, 1, 0}, {3, 3, 0}, {1, 3, 0}};
  CagCurve *a = NULL, *b = NULL, *two = line(cag_vec3(0, 0, 0), cag_vec3(0, 0, 2));
  MUST(cag_curve_polyline(outer, 4, true, 2, &a, err));
  MUST(cag_curve_polyline(inner, 4, true, 2, &b, err));
  MUST(cag_region_new(a, &b, 1, &r, err));
  CagMotion *m = along(two, CAG_ORIENT_RMF, 0, 1);
  CagSolid *s = NULL;
  MUST(cag_solid_sweep(r, m, &s, err));
  assert_near(volume(s), 24, 1e-9, "sweep.section-with-hole");
  assert_watertight(s, 0.1);
  cag_solid_release(s);
  cag_motion_release(m);
  cag_region_release(r);
  cag_curve_release(a);
  cag_curve_release(b);
  cag_curve_release(two);
  cag_curve_release(path);
}

// Pappus: a section perpendicular to the path with its centroid on it sweeps area times length.
static void sweeps_obey_pappus(void **state) {
  (void)state;
  CagCurve *paths[2] = {circle(5), NULL};
  MUST(cag_curve_helix(5, 4, 2, 0, &paths[1], err));
  CagRegion *r = rectangle(1, 2);
  static const CagOrient ORIENT[] = {CAG_ORIENT_RMF, CAG_ORIENT_FRENET, CAG_ORIENT_UP};
  for (int p = 0; p < 2; p++)
    for (int o = 0; o < 3; o++) {
      // On a closed path, the section must return to its start.
      double twist = p == 0 ? 2 * M_PI : 1.5, length;
      CagMotion *m = along(paths[p], ORIENT[o], twist, 1);
      CagSolid *s = NULL;
      MUST(cag_solid_sweep(r, m, &s, err));
      MUST(cag_curve_length(paths[p], paths[p]->start, paths[p]->end, &length, err));
      assert_near(volume(s), 2 * length, 1e-8, "Pappus");
      assert_int_equal(s->face_count, p == 0 ? 1 : 3);
      if (o != 1) assert_watertight(s, 0.05);
      assert_consistent(cag_solid_side(s));
      cag_solid_release(s);
      cag_motion_release(m);
    }
  CagMotion *m = along(paths[0], CAG_ORIENT_RMF, 1, 1);
  CagSolid *s = NULL;
  MUST_FAIL(cag_solid_sweep(r, m, &s, err), "sweep-not-closed");
  cag_motion_release(m);
  cag_region_release(r);
  cag_curve_release(paths[0]);
  cag_curve_release(paths[1]);
}

// Around a circle, rotating with it: exactly a surface of revolution.
static void round_paths_have_exact_forms(void **state) {
  (void)state;
  CagCurve *path = circle(5), *section = circle(1);
  CagMotion *m = along(path, CAG_ORIENT_RMF, 0, 1);
  CagSurface *s = NULL, *exact = NULL;
  MUST(cag_surface_sweep(section, m, &s, err));
  MUST(cag_surface_to_nurbs(s, &exact, err));
  assert_area(exact, 4 * M_PI * M_PI * 5);
  // Points of the exact form are on the torus.
  for (int i = 0; i < 4; i++) {
    CagVec3 p =
        surface_at(exact, inside(exact->u0, exact->u1, i), inside(exact->v0, exact->v1, 3 - i));
    assert_near(hypot(hypot(p.x, p.y) - 5, p.z), 1, 1e-12, "torus");
  }
  cag_surface_release(s);
  cag_surface_release(exact);
  cag_motion_release(m);
  cag_curve_release(section);
  cag_curve_release(path);
}

static CagStatus waist(void *context, double t, double *out, CagError *err) {
  (void)context;
  (void)err;
  out[0] = 1 + 0.5 * cos(t);
  return CAG_OK;
}

static CagStatus jump(void *context, double t, double *out, CagError *err) {
  (void)context;
  (void)err;
  out[0] = t < 1.3 ? 1 : 2;
  return CAG_OK;
}

// The integral of pi (1 + cos(t) / 2)^2 over a turn: pi (2 pi + pi / 4).
static void radii_may_be_functions(void **state) {
  (void)state;
  CagCurve *path = line(cag_vec3(0, 0, 0), cag_vec3(0, 0, 2 * M_PI)), *unit = NULL;
  MUST(cag_curve_reparametrize(path, 0, 2 * M_PI, &unit, err));
  CagChebyshev *f = NULL;
  MUST(cag_chebyshev_fit(waist, NULL, unit->start, unit->end, 1, 1e-12, "radius", &f, err));
  double taylor[3];
  cag_chebyshev_series(f, 0.7, false, 2, taylor);
  assert_near(taylor[0], 1 + 0.5 * cos(0.7), 1e-13, "value");
  assert_near(taylor[1], -0.5 * sin(0.7), 1e-11, "first derivative");
  assert_near(taylor[2], -0.25 * cos(0.7), 1e-9, "second derivative");
  assert_int_equal(cag_chebyshev_breaks(f, NULL, 0), 0);
  CagAlong radius = {0, 0, f};
  CagSolid *s = NULL;
  MUST(cag_solid_tube_along(unit, &radius, &s, err));
  assert_near(volume(s), M_PI * (2 * M_PI + M_PI / 4), 1e-8, "waisted tube");
  assert_watertight(s, 0.02);
  assert_consistent(cag_solid_side(s));
  cag_solid_release(s);
  cag_chebyshev_release(f);
  MUST_FAIL(cag_chebyshev_fit(jump, NULL, 0, 3, 1, 1e-12, "radius", &f, err), "function-jumps");
  cag_curve_release(path);
  cag_curve_release(unit);
}

// Prisms cut by the bisecting planes: area times the length of the axis through the centroid.
static void corners_are_mitered(void **state) {
  (void)state;
  CagVec3 points[] = {{0, 0, 0}, {5, 0, 0}, {5, 5, 0}, {5, 5, 5}};
  CagCurve *path = NULL, *ring = NULL;
  MUST(cag_curve_polyline(points, 4, false, 3, &path, err));
  MUST(cag_curve_polyline(points, 3, true, 3, &ring, err));
  CagRegion *r = rectangle(1, 2);
  CagMotion *m = along(path, CAG_ORIENT_RMF, 0, 1);
  CagSolid *s = NULL;
  MUST(cag_solid_sweep(r, m, &s, err));
  assert_near(volume(s), 30, 1e-9, "mitred");
  assert_watertight(s, 0.1);
  CagSurface *exact = NULL;
  MUST(cag_surface_to_nurbs(cag_solid_side(s), &exact, err));
  assert_point(surface_at(exact, exact->u0, exact->v1),
               surface_at(s->faces[0], s->faces[0]->u0, s->faces[0]->v1), 1e-12, "exact end");
  cag_surface_release(exact);
  cag_solid_release(s);
  cag_motion_release(m);
  m = along(ring, CAG_ORIENT_RMF, 0, 1);
  MUST(cag_solid_sweep(r, m, &s, err));
  assert_near(volume(s), 2 * (10 + sqrt(50)), 1e-9, "mitred ring");
  assert_watertight(s, 0.1);
  cag_solid_release(s);
  cag_motion_release(m);
  CagPathMotion how = {CAG_ORIENT_FRENET, {0, 0, 1}, {0, 0, NULL}, {1, 1, NULL}};
  MUST_FAIL(cag_motion_along(path, &how, &m, err), "path-straight");
  how.orient = CAG_ORIENT_UP;
  MUST_FAIL(cag_motion_along(path, &how, &m, err), "path-along-up");
  how.scale.end = -1;
  how.orient = CAG_ORIENT_RMF;
  MUST_FAIL(cag_motion_along(path, &how, &m, err), "scale-negative");
  cag_region_release(r);
  cag_curve_release(path);
  cag_curve_release(ring);
}

static CagStatus screw(void *context, double t, double *out, CagError *err) {
  (void)context;
  (void)err;
  double m[12] = {cos(t), -sin(t), 0, 0, sin(t), cos(t), 0, 0, 0, 0, 1, 2 * t};
  memcpy(out, m, sizeof m);
  return CAG_OK;
}

// A screw motion preserves volume: area times rise.
static void transforms_sweep_too(void **state) {
  (void)state;
  CagChebyshev *rows = NULL;
  CagMotion *m = NULL;
  CagSolid *s = NULL;
  CagRegion *r = rectangle(1, 2);
  MUST(cag_chebyshev_fit(screw, NULL, 0, 3, 12, 1e-12, "map", &rows, err));
  MUST(cag_motion_affine(rows, 0, 3, false, &m, err));
  MUST(cag_solid_sweep(r, m, &s, err));
  assert_near(volume(s), 12, 1e-8, "screw");
  assert_watertight(s, 0.05);
  assert_consistent(cag_solid_side(s));
  cag_solid_release(s);
  cag_motion_release(m);
  cag_chebyshev_release(rows);
  cag_region_release(r);
}

// Circles whose radii and heights are cubic in i: the loft of degree 3 is the surface of
// revolution.
static void lofts_reproduce_cubics(void **state) {
  (void)state;
  CagCurve *sections[5];
  for (int i = 0; i < 5; i++) {
    CagTransform t = cag_translate(cag_vec3(0, 0, i));
    t.planar = false;
    double radius = 1 + 0.1 * i * i * i - 0.3 * i * i + 0.25 * i;
    MUST(cag_curve_arc(radius, radius, 0, 2 * M_PI, &t, &sections[i], err));
  }
  CagSurface *side = NULL;
  CagSolid *s = NULL;
  const CagCurve *const *curves = (const CagCurve *const *)sections;
  MUST(cag_surface_loft(curves, 5, 3, false, &side, err));
  for (int i = 0; i < 5; i++) {
    CagVec3 p = surface_at(side, 0.25, i), q;
    MUST(cag_curve_point(sections[i], M_PI / 2, &q, err));
    assert_point(p, q, 1e-12, "v = i on curve i");
  }
  CagVec3 p = surface_at(side, 0.1, 2.5);
  assert_near(hypot(p.x, p.y), 1 + 0.1 * 15.625 - 0.3 * 6.25 + 0.25 * 2.5, 1e-12, "between");
  assert_near(p.z, 2.5, 1e-12, "between");
  MUST(cag_solid_loft(side, &s, err));
  // pi times the integral of (1 + t/4 - 3t^2/10 + t^3/10)^2 over 0..4.
  double c[] = {1, 0.25, -0.3, 0.1}, integral = 0;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) integral += c[i] * c[j] * pow(4, i + j + 1) / (i + j + 1);
  assert_near(volume(s), M_PI * integral, 1e-8, "loft");
  assert_watertight(s, 0.05);
  cag_solid_release(s);
  cag_surface_release(side);
  for (int i = 0; i < 5; i++) cag_curve_release(sections[i]);
}

// At the ends of a natural spline, and at an inflection, the curvature is 0 up to rounding. The
// Frenet frame there is the one-sided limit.
static void frenet_has_limits_where_the_curvature_vanishes(void **state) {
  (void)state;
  // The second differences at both ends are 0. The middle of the other spline bends in the opposite
  // direction.
  const CagVec3 ends[] = {{1.1, 0.7, 0}, {2.3, 1.4, 0.9}, {3.5, 2.1, 1.8},
                          {5, 1, 3},     {6, 0, 1.2},     {7, -1, -0.6}};
  const CagVec3 turning[] = {{-3, 0.1, 0}, {-1, 2.3, 0}, {1, -2.3, 0}, {3, -0.1, 0}};
  CagCurve *c[2];
  MUST(cag_curve_bezier(ends, NULL, 6, 3, &c[0], err));
  MUST(cag_curve_bezier(turning, NULL, 4, 3, &c[1], err));
  const double at[3] = {0, 1, 0.5};
  for (int k = 0; k < 4; k++) {
    bool left = k == 1 || k == 3;
    double t = at[k < 2 ? k : 2], beside = t + (left ? -1 : 1) * 1e-6;
    CagSide side = left ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
    CagMotion *m = along(c[k / 2], CAG_ORIENT_FRENET, 0, 1);
    CagMotionSeries here, there;
    MUST(cag_motion_at(m, t, 1, side, &here, err));
    MUST(cag_motion_at(m, beside, 1, side, &there, err));
    assert_point(here.x[0], there.x[0], 1e-5, "normal");
    assert_point(here.y[0], there.y[0], 1e-5, "binormal");
    assert_point(here.x[1], there.x[1], 1e-3, "its derivative");
    cag_motion_release(m);
  }
  cag_curve_release(c[0]);
  cag_curve_release(c[1]);
}

// Sections of different degree and knots, and a closed loft.
static void lofts_unify_their_sections(void **state) {
  (void)state;
  CagVec3 three[] = {{0, 0, 0}, {1, 2, 0}, {3, 0, 0}};
  CagVec3 five[] = {{0, 0, 4}, {1, 1, 4}, {2, 2, 4}, {3, 1, 4}, {4, 0, 4}};
  double knots[] = {0, 0, 0, 0, 0.3, 1, 1, 1, 1};
  CagCurve *c[3];
  MUST(cag_curve_bezier(three, NULL, 3, 3, &c[0], err));
  c[1] = line(cag_vec3(0, 0, 2), cag_vec3(4, 1, 2));
  MUST(cag_curve_nurbs(five, NULL, 5, 3, knots, 3, &c[2], err));
  CagSurface *s = NULL;
  MUST(cag_surface_loft((const CagCurve *const *)c, 3, 2, false, &s, err));
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 4; k++) {
      CagVec3 q;
      double t = inside(0, 1, k);
      MUST(cag_curve_point(c[i], t, &q, err));
      assert_point(surface_at(s, t, i), q, 1e-12, "on section");
    }
  assert_consistent(s);
  cag_surface_release(s);
  MUST_FAIL(cag_surface_loft((const CagCurve *const *)c, 3, 2, true, &s, err), "order-range");
  const CagCurve *many[40];
  for (int i = 0; i < 40; i++) many[i] = c[i % 3];
  MUST_FAIL(cag_surface_loft(many, 40, 33, true, &s, err), "order-range");
  for (int i = 0; i < 3; i++) cag_curve_release(c[i]);
  CagCurve *ring[6];
  for (int i = 0; i < 6; i++) {
    CagTransform turn, out = cag_translate(cag_vec3(5, 0, 0)), t;
    MUST(cag_rotate(cag_vec3(0, 1, 0), i * M_PI / 3, cag_vec3(0, 0, 0), &turn, err));
    t = cag_transform_multiply(&turn, &out);
    t.planar = false;
    MUST(cag_curve_arc(1, 1, 0, 2 * M_PI, &t, &ring[i], err));
  }
  MUST(cag_surface_loft((const CagCurve *const *)ring, 6, 3, true, &s, err));
  assert_true(cag_surface_is_closed(s));
  assert_near(s->v1, 6, 0, "domain");
  for (int i = 0; i <= 6; i++) {
    CagVec3 q;
    MUST(cag_curve_point(ring[i % 6], M_PI, &q, err));
    assert_point(surface_at(s, 0.5, i), q, 1e-12, "on ring");
  }
  CagSolid *body = NULL;
  MUST(cag_solid_loft(s, &body, err));
  assert_true(volume(body) > 0);
  assert_watertight(body, 0.05);
  cag_solid_release(body);
  cag_surface_release(s);
  for (int i = 0; i < 6; i++) cag_curve_release(ring[i]);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_helicoid_of_example_4),
      cmocka_unit_test(straight_sweeps_have_the_volumes_of_the_reference),
      cmocka_unit_test(sweeps_obey_pappus),
      cmocka_unit_test(round_paths_have_exact_forms),
      cmocka_unit_test(radii_may_be_functions),
      cmocka_unit_test(corners_are_mitered),
      cmocka_unit_test(transforms_sweep_too),
      cmocka_unit_test(frenet_has_limits_where_the_curvature_vanishes),
      cmocka_unit_test(lofts_reproduce_cubics),
      cmocka_unit_test(lofts_unify_their_sections),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
