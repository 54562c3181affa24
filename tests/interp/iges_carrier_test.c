// Carriers and edges in IGES files: the parameters of the surfaces and curves that are written. The
// expected values follow from IGES 5.3: angles of analytic surfaces are in degrees from 0, a line
// has the parameters 0 to 1, and a surface of revolution has those of its generatrix and angles.

#include "geom/boundary/boundary.h"
#include "interp/formats/iges_carrier.h"
#include "tests/geom/support.h"

#define DEGREES (180 / M_PI)

typedef struct Fixture {
  CagIges writer;
  CagAtomicFile *files[2];
} Fixture;

static void fixture_begin(Fixture *f) {
  CagError io;
  for (int i = 0; i < 2; i++) assert_non_null(f->files[i] = cag_atomic_file_open_memory(&io));
  f->writer = (CagIges){
      .directory = f->files[0], .parameters = f->files[1], .width = CAG_IGES_PARAMETER_COLUMNS};
}

static void fixture_end(Fixture *f) {
  for (int i = 0; i < 2; i++) cag_atomic_file_abort(f->files[i]);
}

static CagBrepFace a_face(CagCarrierKind kind, double a, double b, double u0, double u1, double v0,
                          double v1) {
  return (CagBrepFace){.carrier = {kind, cag_transform_identity(), a, b, NULL, NULL},
                       .domain = {u0, u1, v0, v1}};
}

// Writes the face's carrier, and checks where a corner of its domain is.
static CagIgesSurface written(const CagBrepFace *face, double u, double v) {
  Fixture f;
  CagIgesSurface s;
  fixture_begin(&f);
  OK(cag_iges_carrier(&f.writer, face, &s, &err));
  assert_true(s.at % 2 == 1);
  near_vec(cag_transform_point(&s.parameters, cag_vec3(face->domain[0], face->domain[2], 0)),
           cag_vec3(u, v, 0), 1e-12);
  fixture_end(&f);
  return s;
}

static void angles_are_in_degrees_and_begin_at_0(void **state) {
  (void)state;
  CagBrepFace face = a_face(CAG_CARRIER_CYLINDER, 5, 0, 0.5, 2, 3, 4);
  written(&face, 0.5 * DEGREES, 3);
  face = a_face(CAG_CARRIER_CYLINDER, 5, 0, -0.5, 2, 3, 4);
  written(&face, 0, 3);
  face = a_face(CAG_CARRIER_SPHERE, 5, 0, 5, 7, -0.25, 0.5);
  written(&face, 0, -0.25 * DEGREES);
  face = a_face(CAG_CARRIER_SPHERE, 5, 0, 0, 2 * M_PI, -M_PI / 2, M_PI / 2);
  assert_false(written(&face, 0, -90).turned);
}

// The angle about the axis runs backwards.
static void a_torus_has_the_angle_in_its_section_first(void **state) {
  (void)state;
  const CagBrepFace face = a_face(CAG_CARRIER_TORUS, 20, 5, 1, 2, 0.25, 3);
  assert_false(written(&face, 0.25 * DEGREES, 360 - 1 * DEGREES).turned);
}

static void a_cone_is_a_revolved_line(void **state) {
  (void)state;
  const CagBrepFace face = a_face(CAG_CARRIER_CONE, 2, M_PI / 6, -1, 2, 3, 7);
  const CagIgesSurface s = written(&face, 0, 0);
  assert_true(s.turned);
  near_vec(cag_transform_point(&s.parameters, cag_vec3(2, 5, 0)), cag_vec3(0.5, 3, 0), 1e-12);
}

static void an_extrusion_has_parameters_from_0_to_1(void **state) {
  (void)state;
  const CagVec3 points[] = {{0, 0, 0}, {1, 2, 0}, {3, 0, 0}};
  const double knots[] = {2, 2, 2, 6, 6, 6};
  CagBrepFace face = a_face(CAG_CARRIER_EXTRUDED, 0, 0, 3, 5, -4, 6);
  OK(cag_curve_nurbs(points, NULL, 3, 2, knots, 3, &face.carrier.profile, &err));
  const CagIgesSurface s = written(&face, 0.25, 0);
  near_vec(cag_transform_point(&s.parameters, cag_vec3(6, 6, 0)), cag_vec3(1, 1, 0), 1e-12);
  cag_curve_release(face.carrier.profile);
}

static void near_curve(const CagCurve *c, double scale, double shift) {
  Fixture f;
  CagIgesCurve out;
  fixture_begin(&f);
  OK(cag_iges_curve(&f.writer, c, &out, &err));
  assert_true(fabs(out.scale - scale) < 1e-12);
  assert_true(fabs(out.shift - shift) < 1e-12);
  fixture_end(&f);
}

// Readers take a closed conic arc as an ellipse from its longer axis on.
static void whole_ellipses_start_on_their_longer_axis(void **state) {
  (void)state;
  static const struct {
    double a, b, start;
    bool bent;
  } ROWS[] = {
      {3, 2, 0, false},        {2, 3, 0, true},         {3, 2, 1, true}, {2, 3, -1.5 * M_PI, false},
      {2, 3, M_PI / 2, false}, {3, 2, 4 * M_PI, false}, {3, 3, 1, false}};
  const CagTransform frame = cag_transform_identity();
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    Fixture f;
    CagIgesCurve out;
    CagBrepFace face = a_face(CAG_CARRIER_EXTRUDED, 0, 0, 0, 2 * M_PI, -4, 6);
    CagIgesSurface surface;
    CagCurve *c;
    OK(cag_curve_arc(ROWS[i].a, ROWS[i].b, ROWS[i].start, ROWS[i].start + 2 * M_PI, &frame, &c,
                     &err));
    fixture_begin(&f);
    OK(cag_iges_curve(&f.writer, c, &out, &err));
    assert_int_equal(out.bent, ROWS[i].bent);
    OK(cag_curve_to_space(c, &face.carrier.profile, &err));
    OK(cag_iges_carrier(&f.writer, &face, &surface, &err));
    assert_int_equal(surface.bent, ROWS[i].bent);
    cag_curve_release(face.carrier.profile);
    cag_curve_release(c);
    fixture_end(&f);
  }
}

static void curves_tell_their_parameters(void **state) {
  (void)state;
  const CagTransform frame = cag_transform_identity();
  const CagVec3 points[] = {{0, 0, 0}, {1, 2, 0}};
  const double knots[] = {2, 2, 6, 6};
  CagCurve *c;
  OK(cag_curve_nurbs(points, NULL, 2, 1, knots, 3, &c, &err));
  near_curve(c, 0.25, -0.5);
  cag_curve_release(c);
  OK(cag_curve_arc(3, 3, 1, 2, &frame, &c, &err)); // starts on the x axis
  near_curve(c, 1, -1);
  cag_curve_release(c);
  OK(cag_curve_arc(3, 2, 7, 8, &frame, &c, &err)); // starts in the first turn
  near_curve(c, 1, -2 * M_PI);
  cag_curve_release(c);
  OK(cag_curve_arc(2, 3, 1, 2, &frame, &c, &err)); // its first axis is the longer one
  near_curve(c, 1, 1.5 * M_PI);
  cag_curve_release(c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(angles_are_in_degrees_and_begin_at_0),
      cmocka_unit_test(a_torus_has_the_angle_in_its_section_first),
      cmocka_unit_test(a_cone_is_a_revolved_line),
      cmocka_unit_test(an_extrusion_has_parameters_from_0_to_1),
      cmocka_unit_test(whole_ellipses_start_on_their_longer_axis),
      cmocka_unit_test(curves_tell_their_parameters),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
