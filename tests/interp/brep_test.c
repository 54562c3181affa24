// Scenes as exact boundaries: edges and vertices are shared, seams and poles are marked, and the
// files are well formed. tests/cli/cases_brep.sh checks that other programs measure the same
// values.

#include "tests/interp/scene_fixture.h"

#include "geom/solid/build.h"
#include "interp/formats/brep.h"
#include "interp/formats/iges.h"
#include "interp/formats/step.h"

static CagBrep boundary_of(const Fixture *f) {
  CagBrep b;
  OK(cag_brep_of_scene(&f->scene, NULL, CAG_BREP_STEP, &b, &err));
  return b;
}

static CagSolid *cylinder(void) {
  CagSolid *s;
  OK(cag_solid_cylinder(20, 5, 5, &s, &err));
  return s;
}

static CagSolid *box(void) {
  CagSolid *s;
  OK(cag_solid_box(cag_vec3(1, 2, 3), false, &s, &err));
  return s;
}

static CagSurface *sphere_surface(double radius) {
  CagTransform frame = cag_transform_identity();
  for (int i = 0; i < 3; i++) frame.m[i][i] = i < 2 ? radius : -radius;
  CagSurface *s;
  OK(cag_surface_quadric(CAG_SHAPE_ELLIPSOID, &frame, 0, 2 * M_PI, 0, M_PI, &s, &err));
  return s;
}

// Checks that every edge of a closed body is used once in each direction.
static void check_closed(const CagBrep *b) {
  int *forward = calloc(b->edge_count, sizeof *forward),
      *back = calloc(b->edge_count, sizeof *back);
  for (size_t i = 0; i < b->use_count; i++)
    (b->uses[i].reversed ? back : forward)[b->uses[i].edge]++;
  for (size_t i = 0; i < b->edge_count; i++) {
    assert_int_equal(forward[i], 1);
    assert_int_equal(back[i], 1);
  }
  free(forward);
  free(back);
}

// Checks that loops are connected: each use ends at the vertex at which the next begins.
static void check_loops(const CagBrep *b) {
  for (size_t l = 0; l < b->loop_count; l++)
    for (size_t i = 0; i < b->loops[l].count; i++) {
      const CagBrepUse *u = &b->uses[b->loops[l].first + i];
      const CagBrepUse *v = &b->uses[b->loops[l].first + (i + 1) % b->loops[l].count];
      size_t end = u->reversed ? b->edges[u->edge].from : b->edges[u->edge].to;
      size_t next = v->reversed ? b->edges[v->edge].to : b->edges[v->edge].from;
      assert_int_equal(end, next);
    }
}

static void a_box_has_8_corners_12_edges_and_6_flat_faces(void **state) {
  (void)state;
  Fixture f;
  fixture_begin(&f);
  fixture_solid(&f, "box", box());
  CagBrep b = boundary_of(&f);
  assert_int_equal(b.vertex_count, 8);
  assert_int_equal(b.edge_count, 12);
  assert_int_equal(b.face_count, 6);
  for (size_t i = 0; i < 6; i++) assert_int_equal(b.faces[i].carrier.kind, CAG_CARRIER_PLANE);
  for (size_t i = 0; i < 12; i++) assert_true(b.edges[i].straight);
  assert_int_equal(b.shapes[0].kind, CAG_BREP_SOLID);
  check_closed(&b);
  check_loops(&b);
  cag_brep_free(&b);
  fixture_end(&f);
}

static void a_cylinder_has_a_seam_and_two_circles(void **state) {
  (void)state;
  Fixture f;
  fixture_begin(&f);
  fixture_solid(&f, "can", cylinder());
  CagBrep b = boundary_of(&f);
  assert_int_equal(b.vertex_count, 2);
  assert_int_equal(b.edge_count, 3);
  assert_int_equal(b.use_count, 6);
  check_closed(&b);
  check_loops(&b);
  cag_brep_free(&b);
  fixture_end(&f);
}

static void poles_are_vertices_without_an_edge(void **state) {
  (void)state;
  Fixture f;
  fixture_begin(&f);
  fixture_surface(&f, "ball", sphere_surface(10));
  CagBrep b = boundary_of(&f);
  assert_int_equal(b.vertex_count, 2);
  assert_int_equal(b.edge_count, 1);
  assert_int_equal(b.use_count, 2);
  assert_int_equal(b.shapes[0].kind, CAG_BREP_SOLID); // closed, so it bounds a solid
  assert_true(b.shells[0].closed);
  check_loops(&b);
  cag_brep_free(&b);
  fixture_end(&f);
}

// The profile ascends on the outside, which makes the normals of its surface of revolution point
// inward, or descends. The volume is that of a cone: pi r^2 h / 3.
static void a_closed_surface_is_a_solid_with_its_normals_outward(void **state) {
  (void)state;
  for (int down = 0; down < 2; down++) {
    const CagVec3 up[3] = {{0, 0, 0}, {3, 0, 4}, {0, 0, 8}}, back[3] = {up[2], up[1], up[0]};
    Fixture f;
    fixture_begin(&f);
    CagCurve *profile;
    CagSurface *s;
    OK(cag_curve_polyline(down ? back : up, 3, false, 3, &profile, &err));
    OK(cag_surface_revolve(profile, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0, 2 * M_PI, &s, &err));
    cag_curve_release(profile);
    fixture_surface(&f, "top", s);
    CagBrep b = boundary_of(&f);
    assert_int_equal(b.shapes[0].kind, CAG_BREP_SOLID);
    check_closed(&b);
    check_loops(&b);
    double terms[10] = {0};
    for (size_t i = 0; i < b.face_count; i++)
      OK(cag_surface_volume_terms(b.faces[i].surface, terms, &err));
    assert_true(fabs(terms[0] - 2 * M_PI * 9 * 4 / 3) < 1e-9);
    cag_brep_free(&b);
    fixture_end(&f);
  }
}

static CagSurface *patch(CagVec3 p00, CagVec3 p01, CagVec3 p10, CagVec3 p11) {
  CagSurface *s;
  OK(cag_surface_bilinear(p00, p01, p10, p11, &s, &err));
  return s;
}

// A box whose front consists of many strips, each of which ends on the long edges of the top and
// the bottom. A strip has 3 edges, plus one for the last; the other sides have 8.
static void long_edges_meet_as_many_short_ones_as_there_are(void **state) {
  (void)state;
  enum { STRIPS = 150 };
  const double n = STRIPS;
  CagSolid *s;
  OK(cag_solid_block(CAG_SOLID_SHELL, STRIPS + 5, &s, &err));
  const CagVec3 a = {0, 0, 0}, b = {n, 0, 0}, c = {n, 7, 0}, d = {0, 7, 0};
  const CagVec3 up = {0, 0, 5};
  for (int k = 0; k < STRIPS; k++) {
    const CagVec3 from = {k, 0, 0}, to = {k + 1, 0, 0};
    cag_solid_add(s, patch(from, cag_add(from, up), to, cag_add(to, up)));
  }
  cag_solid_add(s, patch(a, b, d, c));
  cag_solid_add(s, patch(cag_add(a, up), cag_add(d, up), cag_add(b, up), cag_add(c, up)));
  cag_solid_add(s, patch(d, c, cag_add(d, up), cag_add(c, up)));
  cag_solid_add(s, patch(a, d, cag_add(a, up), cag_add(d, up)));
  cag_solid_add(s, patch(b, cag_add(b, up), c, cag_add(c, up)));
  Fixture f;
  fixture_begin(&f);
  fixture_solid(&f, "strips", s);
  CagBrep brep = boundary_of(&f);
  assert_int_equal(brep.edge_count, 3 * STRIPS + 1 + 8);
  check_loops(&brep);
  cag_brep_free(&brep);
  fixture_end(&f);
}

// A sphere with a wall: its outer face, and its inner face oriented inward.
static void a_sphere_in_a_sphere_is_a_hollow(void **state) {
  (void)state;
  Fixture f;
  fixture_begin(&f);
  CagSurface *inner = sphere_surface(10);
  CagSolid *s;
  OK(cag_solid_thicken(inner, 2, &s, &err));
  fixture_solid(&f, "hollow", s)->tolerance = 0.01; // an offset is approximated
  CagBrep b = boundary_of(&f);
  assert_int_equal(b.shell_count, 2);
  size_t hollows = 0;
  for (size_t i = 0; i < 2; i++) hollows += b.shells[i].void_of != i;
  assert_int_equal(hollows, 1);
  check_closed(&b);
  cag_brep_free(&b);
  cag_surface_release(inner);
  fixture_end(&f);
}

static void creases_part_faces_and_smooth_knots_do_not(void **state) {
  (void)state;
  Fixture f;
  fixture_begin(&f);
  const CagVec3 corners[] = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 5}};
  CagCurve *line, *circle;
  CagSurface *s;
  CagTransform frame = cag_transform_identity();
  OK(cag_curve_polyline(corners, 4, false, 3, &line, &err));
  OK(cag_surface_extrude(line, cag_vec3(1, 2, 20), 0, 1, &s, &err));
  fixture_surface(&f, "folded", s);
  OK(cag_curve_arc(5, 5, 0, 2 * M_PI, &frame, &circle, &err));
  OK(cag_surface_extrude(circle, cag_vec3(0, 0, 20), 0, 1, &s, &err));
  fixture_surface(&f, "pipe", s);
  CagBrep b = boundary_of(&f);
  assert_int_equal(b.shapes[0].count, 1);
  assert_int_equal(b.shells[b.shapes[0].first].count, 3); // three segments
  assert_int_equal(b.shells[b.shapes[1].first].count, 1); // the knots of a circle are smooth
  check_loops(&b);
  cag_brep_free(&b);
  cag_curve_release(line);
  cag_curve_release(circle);
  fixture_end(&f);
}

static void what_is_not_exact_needs_a_tolerance(void **state) {
  (void)state;
  Fixture f;
  CagCurve *c;
  CagBrep b;
  CagError err = {0};
  fixture_begin(&f);
  OK(cag_curve_helix(10, 5, 3, 0, &c, &err));
  CagItem *item = fixture_curve(&f, "coil", c);
  assert_int_equal(cag_brep_of_scene(&f.scene, NULL, CAG_BREP_STEP, &b, &err), CAG_E_UNSUPPORTED);
  assert_string_equal(cag_error_info(err.id)->reason, "export-not-exact");
  assert_non_null(strstr(err.message, "coil"));
  cag_brep_free(&b);
  item->tolerance = 0.01;
  b = boundary_of(&f);
  assert_true(b.shapes[0].approximate);
  // Within the tolerance, between the knots.
  for (int i = 1; i < 97; i++) {
    CagVec3 p, q;
    double t, off;
    OK(cag_curve_point(c, c->start + (c->end - c->start) * i / 97, &p, &err));
    OK(cag_curve_closest(b.shapes[0].curve, p, &t, &q, &off, &err));
    assert_true(off <= 0.01);
  }
  cag_brep_free(&b);
  fixture_end(&f);
}

static void a_weight_of_zero_is_an_error(void **state) {
  (void)state;
  Fixture f;
  CagCurve *c;
  CagBrep b;
  CagError err = {0};
  const CagVec3 p[] = {{0, 0, 0}, {1, 1, 0}, {2, 0, 0}};
  const double weights[] = {1, 0, 1};
  fixture_begin(&f);
  OK(cag_curve_bezier(p, weights, 3, 3, &c, &err));
  fixture_curve(&f, "flat", c);
  assert_int_equal(cag_brep_of_scene(&f.scene, NULL, CAG_BREP_STEP, &b, &err), CAG_E_UNSUPPORTED);
  assert_string_equal(cag_error_info(err.id)->reason, "export-weight");
  cag_brep_free(&b);
  fixture_end(&f);
}

static char *written(const Fixture *f, CagStatus (*write)(const CagBrep *, const char *,
                                                          CagAtomicFile *, CagError *)) {
  CagBrep b = boundary_of(f);
  CagError io;
  char *bytes;
  size_t size;
  CagAtomicFile *file = cag_atomic_file_open_memory(&io);
  assert_non_null(file);
  OK(write(&b, "it's.cag", file, &err));
  assert_true(cag_atomic_file_commit_memory(file, &bytes, &size, &io));
  cag_brep_free(&b);
  return bytes;
}

static void names_of_any_kind_are_written_safely(void **state) {
  (void)state;
  Fixture f;
  fixture_begin(&f);
  fixture_solid(&f, "it's a \\ b\n\xc3\xa9\xf0\x9f\x8d\x8e;", box());
  char *step = written(&f, cag_export_step), *iges = written(&f, cag_export_iges);
  assert_non_null(
      strstr(step, "'it''s a \\\\ b\\X2\\000A\\X0\\\\X2\\00E9\\X0\\\\X4\\0001F34E\\X0\\;'"));
  assert_non_null(strstr(iges, "14Hit's a \\ b___;"));
  free(step);
  free(iges);
  fixture_end(&f);
}

// Every line has 80 columns, and the last one states the number of lines in each section.
static void an_iges_file_counts_its_lines(void **state) {
  (void)state;
  Fixture f;
  fixture_begin(&f);
  fixture_solid(&f, "can", cylinder());
  char *text = written(&f, cag_export_iges);
  int count[5] = {0};
  const char *sections = "SGDPT", *last = NULL;
  for (const char *line = text; *line; line = strchr(line, '\n') + 1) {
    assert_int_equal(strchr(line, '\n') - line, 80);
    const char *section = strchr(sections, line[72]);
    assert_non_null(section);
    assert_int_equal(atoi(line + 73), ++count[section - sections]);
    last = line;
  }
  int told[4];
  assert_int_equal(sscanf(last, "S%7dG%7dD%7dP%7d", &told[0], &told[1], &told[2], &told[3]), 4);
  for (int i = 0; i < 4; i++) assert_int_equal(told[i], count[i]);
  free(text);
  fixture_end(&f);
}

static void a_number_that_is_not_finite_is_an_error(void **state) {
  (void)state;
  typedef CagStatus Export(const CagBrep *, const char *, CagAtomicFile *, CagError *);
  Export *const exports[] = {cag_export_step, cag_export_iges};
  const double numbers[] = {NAN, INFINITY, -INFINITY};
  Fixture f;
  CagBrep b;
  CagError io;
  fixture_begin(&f);
  fixture_solid(&f, "can", cylinder());
  OK(cag_brep_of_scene(&f.scene, NULL, CAG_BREP_STEP, &b, &err));
  for (int i = 0; i < 6; i++) {
    CagError why = {0};
    CagAtomicFile *file = cag_atomic_file_open_memory(&io);
    b.accuracy = numbers[i / 2];
    assert_int_not_equal(exports[i % 2](&b, "can", file, &why), CAG_OK);
    assert_string_equal(cag_error_info(why.id)->reason, "not-finite");
    cag_atomic_file_abort(file);
  }
  cag_brep_free(&b);
  fixture_end(&f);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_box_has_8_corners_12_edges_and_6_flat_faces),
      cmocka_unit_test(a_cylinder_has_a_seam_and_two_circles),
      cmocka_unit_test(poles_are_vertices_without_an_edge),
      cmocka_unit_test(a_closed_surface_is_a_solid_with_its_normals_outward),
      cmocka_unit_test(long_edges_meet_as_many_short_ones_as_there_are),
      cmocka_unit_test(a_sphere_in_a_sphere_is_a_hollow),
      cmocka_unit_test(creases_part_faces_and_smooth_knots_do_not),
      cmocka_unit_test(what_is_not_exact_needs_a_tolerance),
      cmocka_unit_test(a_weight_of_zero_is_an_error),
      cmocka_unit_test(names_of_any_kind_are_written_safely),
      cmocka_unit_test(an_iges_file_counts_its_lines),
      cmocka_unit_test(a_number_that_is_not_finite_is_an_error),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
