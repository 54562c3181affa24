// Tests boundaries with exhausted memory and with interrupted work. Each fault is reported, and
// nothing leaks.

#include "faults.h"
#include "geom/boundary/features.h"
#include "geom/boundary/measure.h"
#include "geom/boundary/mesh.h"
#include "geom/boundary/moved.h"
#include "geom/boundary/patch.h"
#include "tests/geom/boundary_support.h"

#define QUESTION(name) static CagStatus name(const void *given, CagError *e)

QUESTION(mass) {
  CagMassProperties m;
  const CagStatus status = cag_boundary_mass(given, &m, e);
  if (!status) fault_found(m.volume);
  return status;
}
QUESTION(face_area) {
  double area;
  const CagStatus status = cag_boundary_face_area(given, 0, &area, NULL, e);
  if (!status) fault_found(area);
  return status;
}
QUESTION(features) {
  CagFeatures f;
  const CagStatus status = cag_boundary_features(given, &f, e);
  if (status) return status;
  fault_found(f.edges[0].length);
  cag_features_free(&f);
  return status;
}
static CagStatus move(const CagBoundary *b, double mirror, CagError *e) {
  CagTransform t = cag_translate(cag_vec3(1, 2, 3));
  CagBoundary to;
  t.m[0][0] = mirror;
  const CagStatus status = cag_boundary_moved(b, &t, &to, e);
  if (status) return status;
  fault_found(to.centroid.x);
  cag_boundary_free(&to);
  return status;
}
QUESTION(shifted) { return move(given, 1, e); }
QUESTION(mirrored) { return move(given, -1, e); }
QUESTION(surface) {
  CagSurface *s;
  const CagStatus status = cag_boundary_surface(given, 0, &s, e);
  if (status) return status;
  fault_found(s->u1);
  cag_surface_release(s);
  return status;
}
QUESTION(mesh) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *m;
  how.tolerance = 0.5;
  const CagStatus status = cag_boundary_mesh(given, &how, false, &m, e);
  if (status) return status;
  fault_found((double)m->triangle_count);
  cag_mesh_release(m);
  return status;
}

static void check_wall(CagCarrierKind kind, const char *name) {
  CagBoundary b = cylinder_boundary(kind);
  fault_steps = FAULTS_OF_QUICK;
  try_faults("mass", name, mass, &b);
  try_faults("area", name, face_area, &b);
  try_faults("features", name, features, &b);
  try_faults("shifted", name, shifted, &b);
  try_faults("mirrored", name, mirrored, &b);
  try_faults("surface", name, surface, &b);
  fault_steps = FAULTS_OF_SLOW;
  try_faults("mesh", name, mesh, &b);
  cag_boundary_free(&b);
}

static void boundaries_report_faults(void **state) {
  (void)state;
  fault_problems = 0;
  check_wall(CAG_CARRIER_CYLINDER, "cylinder");
  check_wall(CAG_CARRIER_EXTRUDED, "extruded");
  check_wall(CAG_CARRIER_REVOLVED, "revolved");
  check_wall(CAG_CARRIER_SPLINE, "spline");
  assert_int_equal(fault_problems, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(boundaries_report_faults)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
