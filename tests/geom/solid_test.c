// Solids: closed forms for mass, outward normals, common edges, and rejected input.

#include <stdio.h>

#include "surface_support.h"
#include "tests/geom/random.h"

static CagRegion *new_polygon(const CagVec3 *points, size_t n) {
  CagCurve *c;
  CagRegion *r;
  MUST(cag_curve_polyline(points, n, true, 2, &c, err));
  MUST(cag_region_new(c, NULL, 0, &r, err));
  cag_curve_release(c);
  return r;
}

static CagRegion *new_disk(double radius, double x, double y) {
  CagTransform frame = cag_transform_identity();
  CagCurve *c;
  CagRegion *r;
  frame.m[0][3] = x;
  frame.m[1][3] = y;
  MUST(cag_curve_arc(radius, radius, 0, 2 * M_PI, &frame, &c, err));
  MUST(cag_region_new(c, NULL, 0, &r, err));
  cag_curve_release(c);
  return r;
}

// The volume by the divergence theorem over the faces, which is positive if they are oriented
// outward.
static double flux_volume(const CagSolid *s) {
  double terms[10] = {0};
  for (size_t i = 0; i < s->face_count; i++)
    MUST(cag_surface_volume_terms(s->faces[i], terms, err));
  return terms[0];
}

// Checks that every edge of a face has a partner, and that the two run along the same points in the
// recorded directions. With `whole`, sides correspond one to one.
static void assert_edges(const CagSolid *s, size_t expected) {
  assert_int_equal(s->edge_count, expected);
  for (size_t e = 0; e < s->edge_count; e++) {
    CagVec3 p[2][3];
    for (int k = 0; k < 2; k++) {
      const CagSurface *f = s->faces[s->edges[e].face[k]];
      int side = s->edges[e].side[k];
      const CagRegion *region;
      CagTransform frame;
      for (int i = 0; i < 3; i++) {
        double t = (k == 1 && s->edges[e].reversed) ? 1 - 0.3 * (i + 0.5) : 0.3 * (i + 0.5);
        if (side >= 4) {
          assert_true(cag_surface_planar_view(f, &region, &frame));
          const CagCurve *c = region->loops[side - 4];
          CagVec3 flat;
          MUST(cag_curve_point(c, c->start + t * (c->end - c->start), &flat, err));
          p[k][i] = cag_transform_point(&frame, flat);
        } else if (side < 2)
          p[k][i] = surface_at(f, side == 0 ? f->u0 : f->u1, f->v0 + t * (f->v1 - f->v0));
        else p[k][i] = surface_at(f, f->u0 + t * (f->u1 - f->u0), side == 2 ? f->v0 : f->v1);
      }
    }
    for (int i = 0; i < 3; i++) assert_point(p[0][i], p[1][i], 1e-9, "shared edge");
  }
}

static void assert_mass(const CagSolid *s, double volume, double area, CagVec3 centroid) {
  CagMassProperties m;
  MUST(cag_solid_mass(s, &m, err));
  assert_near(m.volume, volume, 1e-9, "volume");
  assert_near(flux_volume(s), volume, 1e-8, "volume by the faces");
  assert_near(m.area, area, 1e-8, "area");
  assert_point(m.volume_centroid, centroid, 1e-8, "centroid");
}

// The closed form agrees with the integrals over the faces, and so do the inertia and the centroid
// of the area.
static void assert_same_as_shell(const CagSolid *s) {
  CagSolid *shell;
  CagMassProperties a, b;
  MUST(cag_solid_shell(s->faces, s->face_count, &shell, err));
  MUST(cag_solid_mass(s, &a, err));
  MUST(cag_solid_mass(shell, &b, err));
  assert_near(a.volume, b.volume, 1e-8, "volume");
  assert_near(a.area, b.area, 1e-8, "area");
  assert_point(a.area_centroid, b.area_centroid, 1e-7, "area centroid");
  assert_point(a.volume_centroid, b.volume_centroid, 1e-7, "centroid");
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) assert_near(a.inertia[i][j], b.inertia[i][j], 1e-7, "inertia");
  assert_int_equal(shell->edge_count, s->edge_count);
  cag_solid_release(shell);
}

static void assert_text(const CagSolid *s, const char *text) {
  char found[120];
  cag_solid_describe(s, found, sizeof found);
  assert_string_equal(found, text);
}

// analysis.box-mass checks meshes. Here, I = m (b^2 + c^2) / 12.
static void a_box_has_six_faces_and_twelve_edges(void **state) {
  (void)state;
  CagSolid *s;
  CagMassProperties m;
  MUST(cag_solid_box(cag_vec3(10, 20, 30), false, &s, err));
  assert_mass(s, 6000, 2200, cag_vec3(5, 10, 15));
  assert_edges(s, 12);
  assert_same_as_shell(s);
  assert_text(s, "box, 10 x 20 x 30");
  MUST(cag_solid_mass(s, &m, err));
  assert_near(m.inertia[0][0], 6000 * (400 + 900) / 12.0, 1e-12, "Ixx");
  assert_near(m.inertia[0][1], 0, 1e-9, "Ixy");
  cag_solid_release(s);
  MUST(cag_solid_box(cag_vec3(1, 2, 3), true, &s, err));
  assert_mass(s, 6, 22, cag_vec3(0, 0, 0));
  CagBounds box;
  MUST(cag_solid_bounds(s, &box, err));
  assert_point(box.min, cag_vec3(-0.5, -1, -1.5), 1e-15, "bounds");
  cag_solid_release(s);
  MUST_FAIL(cag_solid_box(cag_vec3(1, 0, 3), true, &s, err), "size-not-positive");
  MUST_FAIL(cag_solid_box(cag_vec3(1, 2, -3), true, &s, err), "size-not-positive");
}

static void a_sphere_faces_outward_at_its_poles(void **state) {
  (void)state;
  CagSolid *s;
  MUST(cag_solid_sphere(10, &s, err));
  assert_mass(s, 4 * M_PI / 3 * 1000, 400 * M_PI, cag_vec3(0, 0, 0));
  assert_edges(s, 0);
  assert_same_as_shell(s);
  assert_text(s, "sphere, radius 10");
  const CagSurface *f = s->faces[0];
  CagVec3 n;
  MUST(cag_surface_normal(f, 1, f->v0, &n, err));
  assert_point(n, cag_vec3(0, 0, -1), 1e-14, "south");
  MUST(cag_surface_normal(f, 2, f->v1, &n, err));
  assert_point(n, cag_vec3(0, 0, 1), 1e-14, "north");
  assert_bounds(f, cag_vec3(-10, -10, -10), cag_vec3(10, 10, 10));
  cag_solid_release(s);
  MUST_FAIL(cag_solid_sphere(0, &s, err), "size-not-positive");
}

static void cylinders_frusta_and_cones(void **state) {
  (void)state;
  const double tops[] = {2, 1, 0, 3};
  const char *texts[] = {"cylinder, height 5, radius 2", "cylinder, height 5, radius 2, top 1",
                         "cone, height 5, radius 2", "cylinder, height 5, radius 2, top 3"};
  for (int k = 0; k < 4; k++) {
    double r = tops[k], R = 2, h = 5;
    CagSolid *s;
    MUST(cag_solid_cylinder(h, R, r, &s, err));
    double z = h * (R * R + 2 * R * r + 3 * r * r) / (4 * (R * R + R * r + r * r));
    assert_mass(s, M_PI * h * (R * R + R * r + r * r) / 3,
                M_PI * (R + r) * hypot(h, R - r) + M_PI * (R * R + r * r), cag_vec3(0, 0, z));
    assert_edges(s, r > 0 ? 2 : 1);
    assert_same_as_shell(s);
    assert_text(s, texts[k]);
    cag_solid_release(s);
  }
  CagSolid *s;
  MUST(cag_solid_cylinder(5, 0, 2, &s, err));
  assert_mass(s, M_PI * 20 / 3, M_PI * 2 * sqrt(29) + 4 * M_PI, cag_vec3(0, 0, 3.75));
  cag_solid_release(s);
  MUST_FAIL(cag_solid_cylinder(5, 0, 0, &s, err), "size-not-positive");
  MUST_FAIL(cag_solid_cylinder(-1, 2, 2, &s, err), "size-not-positive");
}

static void a_torus_has_its_closed_forms(void **state) {
  (void)state;
  CagSolid *s;
  MUST(cag_solid_torus(3, 1, &s, err));
  assert_mass(s, 6 * M_PI * M_PI, 12 * M_PI * M_PI, cag_vec3(0, 0, 0));
  assert_same_as_shell(s);
  assert_text(s, "torus, major 3, minor 1");
  cag_solid_release(s);
  MUST_FAIL(cag_solid_torus(1, 2, &s, err), "self-intersection");
}

// Reflections, shears, and rotations: the volume is multiplied by the determinant, normals stay
// outward, and edges still meet.
// The bounds of primitives have closed forms, under any map; those of a shell come from its faces.
static void bounds_are_those_of_the_faces(void **state) {
  (void)state;
  enum { KINDS = 6, MAPS = 12 };
  seed = 17;
  for (int k = 0; k < KINDS * MAPS; k++) {
    const double a = uniform(1, 5), b = uniform(1, 5), c = uniform(0.5, 5);
    CagSolid *own, *s, *shell;
    switch (k % KINDS) {
    case 0: MUST(cag_solid_box(cag_vec3(a, b, c), k % 2, &own, err)); break;
    case 1: MUST(cag_solid_sphere(a, &own, err)); break;
    case 2: MUST(cag_solid_cylinder(a, b, c, &own, err)); break;
    case 3: MUST(cag_solid_cylinder(a, b, 0, &own, err)); break;
    case 4: MUST(cag_solid_cylinder(a, 0, b, &own, err)); break;
    default: MUST(cag_solid_torus(a + b, b, &own, err)); break;
    }
    CagTransform map = cag_transform_identity();
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 4; j++) map.m[i][j] = uniform(-2, 2);
    MUST(cag_solid_transform(own, &map, &s, err));
    MUST(cag_solid_shell(s->faces, s->face_count, &shell, err));
    CagBounds found, expected;
    MUST(cag_solid_bounds(s, &found, err));
    MUST(cag_solid_bounds(shell, &expected, err));
    assert_point(found.min, expected.min, 1e-9, "lower bounds");
    assert_point(found.max, expected.max, 1e-9, "upper bounds");
    cag_solid_release(own);
    cag_solid_release(s);
    cag_solid_release(shell);
  }
}

static void transforms_keep_solids_outward(void **state) {
  (void)state;
  CagSolid *solids[3], *moved;
  CagTransform maps[3];
  MUST(cag_solid_box(cag_vec3(1, 2, 3), false, &solids[0], err));
  MUST(cag_solid_cylinder(5, 2, 1, &solids[1], err));
  MUST(cag_solid_torus(3, 1, &solids[2], err));
  MUST(cag_rotate(cag_vec3(1, 2, 3), 1, cag_vec3(0, 1, 0), &maps[0], err));
  MUST(cag_reflect(cag_vec3(1, 1, 0), cag_vec3(2, 0, 0), &maps[1], err));
  maps[2] = cag_shear(0.5, 0, 0.2, 0, 0, 0.7);
  for (int i = 0; i < 3; i++)
    for (int m = 0; m < 3; m++) {
      CagMassProperties a, b;
      MUST(cag_solid_transform(solids[i], &maps[m], &moved, err));
      MUST(cag_solid_mass(solids[i], &a, err));
      MUST(cag_solid_mass(moved, &b, err));
      double det = fabs(cag_transform_determinant(&maps[m]));
      assert_near(b.volume, a.volume * det, 1e-12, "volume");
      assert_near(flux_volume(moved), a.volume * det, 1e-8, "volume by the faces");
      assert_edges(moved, solids[i]->edge_count);
      assert_same_as_shell(moved);
      cag_solid_release(moved);
    }
  CagTransform flat = cag_transform_identity();
  flat.m[2][2] = 0;
  MUST_FAIL(cag_solid_transform(solids[0], &flat, &moved, err), "singular-transform");
  for (int i = 0; i < 3; i++) cag_solid_release(solids[i]);
}

// sweep.section-with-hole, sweep.cylinder-claim, sweep.cone-claim; V = A L (1 + k + k^2) / 3.
static void extrusions_have_the_metrics_of_the_reference(void **state) {
  (void)state;
  const CagVec3 outer[] = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
  const CagVec3 inner[] = {{1, 1, 0}, {3, 1, 0}, {3, 3, 0}, {1, 3, 0}};
  CagCurve *a, *b;
  CagRegion *holed, *disk = new_disk(2, 0, 0);
  CagSolid *s;
  MUST(cag_curve_polyline(outer, 4, true, 2, &a, err));
  MUST(cag_curve_polyline(inner, 4, true, 2, &b, err));
  MUST(cag_region_new(a, &b, 1, &holed, err));
  cag_curve_release(a);
  cag_curve_release(b);
  for (int down = 0; down < 2; down++) {
    MUST(cag_solid_extrude(holed, cag_vec3(0, 0, down ? -2 : 2), 0, 1, &s, err));
    assert_mass(s, 24, 48 + 24, cag_vec3(2, 2, down ? -1 : 1));
    assert_edges(s, 4);
    assert_text(s, "extrusion, 4 faces");
    cag_solid_release(s);
  }
  MUST(cag_solid_extrude(disk, cag_vec3(0, 0, 5), 0, 1, &s, err));
  assert_mass(s, 62.83185307179586, 62.83185307179586 + 2 * 12.566370614359172,
              cag_vec3(0, 0, 2.5));
  assert_edges(s, 2);
  cag_solid_release(s);
  MUST(cag_solid_extrude(disk, cag_vec3(0, 0, 5), 0, 0, &s, err));
  assert_mass(s, 20.943951023931955, 33.8359883929281 + 12.566370614359172, cag_vec3(0, 0, 1.25));
  assert_edges(s, 1);
  cag_solid_release(s);
  // A twist about the center does not change the volume. Tapering by k does, as stated.
  MUST(cag_solid_extrude(holed, cag_vec3(1, 0, 6), 2, 1, &s, err));
  assert_near(flux_volume(s), 12 * 6, 1e-8, "twisted");
  assert_edges(s, 4);
  cag_solid_release(s);
  MUST(cag_solid_extrude(holed, cag_vec3(0, 0, -6), 1, 0.5, &s, err));
  assert_near(flux_volume(s), 12 * 6 * (1 + 0.5 + 0.25) / 3, 1e-8, "twisted and tapered");
  cag_solid_release(s);
  MUST_FAIL(cag_solid_extrude(disk, cag_vec3(1, 0, 0), 0, 1, &s, err), "degenerate-direction");
  cag_region_release(holed);
  cag_region_release(disk);
}

static const CagVec3 Z = {0, 0, 1}, ORIGIN = {0, 0, 0};

// Pappus: V = 2 pi r A, area = 2 pi r L.
static void rings_obey_pappus(void **state) {
  (void)state;
  CagRegion *disk = new_disk(1, 4, 2);
  CagSolid *s;
  MUST(cag_solid_revolve(disk, Z, ORIGIN, 0, 2 * M_PI, &s, err));
  assert_mass(s, 2 * M_PI * 4 * M_PI, 2 * M_PI * 4 * 2 * M_PI, cag_vec3(0, 0, 2));
  assert_int_equal(s->face_count, 1);
  assert_edges(s, 0);
  assert_text(s, "revolution, 1 face");
  cag_solid_release(s);
  // A partial revolution with two caps, on either side of the axis and in either direction.
  for (int k = 0; k < 4; k++) {
    double angle = 1.2;
    CagVec3 through = k & 1 ? cag_vec3(9, 0, 0) : ORIGIN;
    double radius = k & 1 ? 5 : 4;
    MUST(cag_solid_revolve(disk, k & 2 ? cag_vec3(0, 0, -2) : Z, through, 0.3, 0.3 + angle, &s,
                           err));
    CagMassProperties m;
    MUST(cag_solid_mass(s, &m, err));
    assert_near(m.volume, angle * radius * M_PI, 1e-9, "volume");
    assert_near(m.area, angle * radius * 2 * M_PI + 2 * M_PI, 1e-9, "area");
    assert_edges(s, 2);
    cag_solid_release(s);
  }
  cag_region_release(disk);
}

// revolve.fig4-cone-with-hole: about x, the region in z = 0.
static void a_polygon_about_the_x_axis(void **state) {
  (void)state;
  const CagVec3 points[] = {{0, 1, 0}, {3, 1, 0}, {3, 2, 0}, {0, 5, 0}};
  CagRegion *r = new_polygon(points, 4);
  CagSolid *s;
  MUST(cag_solid_revolve(r, cag_vec3(1, 0, 0), ORIGIN, 0, 2 * M_PI, &s, err));
  CagMassProperties m;
  MUST(cag_solid_mass(s, &m, err));
  assert_near(m.volume, 113.09733552923255, 1e-9, "volume");
  assert_near(m.area, 196.97309926978886, 1e-9, "area");
  cag_solid_release(s);
  cag_region_release(r);
}

// A right triangle with a leg on the axis: a cone. The leg sweeps no surface.
static void regions_that_touch_the_axis_have_poles(void **state) {
  (void)state;
  const CagVec3 points[] = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}};
  CagRegion *r = new_polygon(points, 3);
  CagSolid *s;
  MUST(cag_solid_revolve(r, Z, ORIGIN, 0, 2 * M_PI, &s, err));
  assert_mass(s, 12 * M_PI, M_PI * 15 + M_PI * 9, cag_vec3(0, 0, 1));
  for (size_t i = 0; i < s->face_count; i++) assert_true(cag_surface_is_closed(s->faces[i]));
  cag_solid_release(s);
  MUST(cag_solid_revolve(r, Z, ORIGIN, 0, M_PI / 2, &s, err));
  CagMassProperties m;
  MUST(cag_solid_mass(s, &m, err));
  assert_near(m.volume, 3 * M_PI, 1e-9, "quarter");
  assert_near(m.area, M_PI * 6 + 12, 1e-9, "area of the quarter");
  assert_near(flux_volume(s), 3 * M_PI, 1e-9, "outward");
  cag_solid_release(s);
  cag_region_release(r);
  const CagVec3 across[] = {{-1, 0, 0}, {3, 0, 0}, {0, 4, 0}};
  r = new_polygon(across, 3);
  MUST_FAIL(cag_solid_revolve(r, Z, ORIGIN, 0, 1, &s, err), "region-crosses-axis");
  MUST_FAIL(cag_solid_revolve(r, cag_vec3(0, 1, 1), ORIGIN, 0, 1, &s, err), "axis-not-in-plane");
  MUST_FAIL(cag_solid_revolve(r, ORIGIN, ORIGIN, 0, 1, &s, err), "zero-axis");
  cag_region_release(r);
}

// A half disk about its diameter: a sphere, in one piece wherever the loop begins.
static void a_half_disk_revolves_to_a_ball(void **state) {
  (void)state;
  CagTransform frame = cag_transform_identity();
  CagCurve *arc, *line, *both, *parts[2];
  CagRegion *r;
  CagSolid *s;
  MUST(cag_curve_arc(2, 2, -M_PI / 2, M_PI / 2, &frame, &arc, err));
  MUST(cag_curve_line(cag_vec3(0, 2, 0), cag_vec3(0, -2, 0), 2, &line, err));
  parts[0] = arc;
  parts[1] = line;
  MUST(cag_curve_join(parts, 2, &both, err));
  MUST(cag_region_new(both, NULL, 0, &r, err));
  MUST(cag_solid_revolve(r, Z, ORIGIN, 0, 2 * M_PI, &s, err));
  assert_mass(s, 4 * M_PI / 3 * 8, 16 * M_PI, ORIGIN);
  assert_int_equal(s->face_count, 1);
  cag_solid_release(s);
  cag_region_release(r);
  cag_curve_release(arc);
  cag_curve_release(line);
  cag_curve_release(both);
}

static void tubes_have_caps_unless_closed(void **state) {
  (void)state;
  CagCurve *helix, *corner, *circle;
  CagSolid *s;
  CagMassProperties m;
  double r = 0.5, length = hypot(3, 2 / (2 * M_PI)) * 4 * M_PI;
  MUST(cag_curve_helix(3, 2, 2, 0, &helix, err));
  MUST(cag_solid_tube(helix, r, &s, err));
  MUST(cag_solid_mass(s, &m, err));
  assert_near(m.volume, M_PI * r * r * length, 1e-9, "volume by Pappus");
  assert_near(m.area, 2 * M_PI * r * length + 2 * M_PI * r * r, 1e-9, "area");
  assert_edges(s, 2);
  assert_text(s, "tube, radius 0.5");
  // Reflected and scaled uniformly, it is a tube with another radius.
  for (int axis = 0; axis < 3; axis++) {
    double k[3] = {3, 3, 3};
    char text[200];
    CagTransform mirror;
    CagSolid *other;
    k[axis] = -3;
    MUST(cag_scale(cag_vec3(k[0], k[1], k[2]), ORIGIN, &mirror, err));
    MUST(cag_solid_transform(s, &mirror, &other, err));
    cag_solid_describe(other, text, sizeof text);
    text[strlen("tube, radius 1.5")] = '\0';
    assert_string_equal(text, "tube, radius 1.5");
    cag_solid_release(other);
  }
  cag_solid_release(s);
  const CagVec3 points[] = {{0, 0, 0}, {10, 0, 0}, {10, 6, 0}, {10, 6, 8}};
  MUST(cag_curve_polyline(points, 4, false, 3, &corner, err));
  MUST(cag_solid_tube(corner, 1, &s, err));
  assert_near(flux_volume(s), 24 * M_PI, 1e-9, "mitred");
  assert_edges(s, 2);
  cag_solid_release(s);
  CagTransform frame = cag_transform_identity();
  MUST(cag_curve_arc(5, 5, 0, 2 * M_PI, &frame, &circle, err));
  MUST(cag_solid_tube(circle, 1, &s, err));
  assert_int_equal(s->face_count, 1);
  assert_near(flux_volume(s), 10 * M_PI * M_PI, 1e-9, "ring");
  cag_solid_release(s);
  cag_curve_release(helix);
  cag_curve_release(corner);
  cag_curve_release(circle);
}

// Six squares with random orientations: the shell orients them outward. Five leave a hole.
static void shells_are_checked_and_turned_outward(void **state) {
  (void)state;
  CagSolid *box, *s;
  CagSurface *faces[6];
  MUST(cag_solid_box(cag_vec3(2, 3, 4), false, &box, err));
  for (int i = 0; i < 6; i++) {
    if (i % 2) faces[i] = cag_surface_retain(box->faces[i]);
    else MUST(cag_surface_flip(box->faces[i], &faces[i], err));
  }
  MUST(cag_solid_shell(faces, 6, &s, err));
  assert_mass(s, 24, 52, cag_vec3(1, 1.5, 2));
  assert_edges(s, 12);
  assert_text(s, "shell, 6 faces");
  cag_solid_release(s);
  MUST_FAIL(cag_solid_shell(faces, 5, &s, err), "solid-open");
  for (int i = 0; i < 6; i++) cag_surface_release(faces[i]);
  cag_solid_release(box);
}

// Integer placements: the description of sheared solids has the rows of their map, that of rotated
// ones their axis, and that of scaled ones their sizes. The short form omits all of this.
static void placements_are_told_as_they_are(void **state) {
  (void)state;
  static const CagVec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int k = 0; k < 60; k++) {
    CagSolid *s, *moved;
    CagTransform t = cag_transform_identity();
    char expected[260], found[260], form[120], place[40] = "";
    const int x = k % 5 - 2, y = k % 3, z = k % 4 - 1;
    const char *centered = k % 2 ? ", centered" : "";
    if (x || y || z) snprintf(place, sizeof place, ", at [%d, %d, %d]", x, y, z);
    MUST(cag_solid_box(cag_vec3(2, 3, 4), k % 2, &s, err));
    if (k % 4 == 0) { // columns that are not perpendicular
      t.m[k / 4 % 3][(k / 4 + 1) % 3] = 1 + k / 4 % 2;
      snprintf(expected, sizeof expected,
               "box, 2 x 3 x 4%s, mapped by [[%g, %g, %g], [%g, %g, %g], [%g, %g, %g]]%s", centered,
               t.m[0][0], t.m[0][1], t.m[0][2], t.m[1][0], t.m[1][1], t.m[1][2], t.m[2][0],
               t.m[2][1], t.m[2][2], place);
    } else if (k % 4 < 3) { // a rotation about an axis
      const CagVec3 axis = axes[k % 3];
      const int degrees = 10 + 5 * (k % 13);
      MUST(cag_rotate(axis, degrees * M_PI / 180, cag_vec3(0, 0, 0), &t, err));
      snprintf(expected, sizeof expected, "box, 2 x 3 x 4%s, turned by %ddeg about [%g, %g, %g]%s",
               centered, degrees, axis.x, axis.y, axis.z, place);
    } else {
      for (int i = 0; i < 3; i++) t.m[i][i] = 1 + (k / 4 + i) % 3;
      snprintf(expected, sizeof expected, "box, %g x %g x %g%s%s", 2 * t.m[0][0], 3 * t.m[1][1],
               4 * t.m[2][2], centered, place);
    }
    t.planar = false;
    t.m[0][3] = x, t.m[1][3] = y, t.m[2][3] = z;
    MUST(cag_solid_transform(s, &t, &moved, err));
    cag_solid_describe(moved, found, sizeof found);
    assert_string_equal(found, expected);
    cag_solid_describe_form(moved, form, sizeof form);
    assert_int_equal(strncmp(form, expected, strlen(form)), 0);
    assert_true(!strstr(form, "turned") && !strstr(form, "mapped") && !strstr(form, ", at"));
    // A short buffer receives the beginning.
    for (size_t size = 1; size < strlen(expected); size += 7) {
      memset(found, '#', sizeof found);
      cag_solid_describe(moved, found, size);
      assert_int_equal(strlen(found), size - 1);
      assert_int_equal(strncmp(found, expected, size - 1), 0);
      assert_int_equal(found[size], '#');
    }
    cag_solid_release(s);
    cag_solid_release(moved);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_box_has_six_faces_and_twelve_edges),
      cmocka_unit_test(placements_are_told_as_they_are),
      cmocka_unit_test(a_sphere_faces_outward_at_its_poles),
      cmocka_unit_test(cylinders_frusta_and_cones),
      cmocka_unit_test(a_torus_has_its_closed_forms),
      cmocka_unit_test(bounds_are_those_of_the_faces),
      cmocka_unit_test(transforms_keep_solids_outward),
      cmocka_unit_test(extrusions_have_the_metrics_of_the_reference),
      cmocka_unit_test(rings_obey_pappus),
      cmocka_unit_test(a_polygon_about_the_x_axis),
      cmocka_unit_test(regions_that_touch_the_axis_have_poles),
      cmocka_unit_test(a_half_disk_revolves_to_a_ball),
      cmocka_unit_test(tubes_have_caps_unless_closed),
      cmocka_unit_test(shells_are_checked_and_turned_outward),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
