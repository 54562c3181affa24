// Tests what is made of meshes in place of the kernel's results, with exhausted memory and with
// interrupted work. Each fault is reported, and nothing leaks.

#include "faults.h"
#include "geom/boundary/patch.h"
#include "geom/mesh/smooth.h"
#include "geom/solid/hollow.h"
#include "geom/solid/incline.h"
#include "geom/solid/rolling.h"
#include "tests/geom/recognized_support.h"

#define COARSE 0.3

#define QUESTION(name) static CagStatus name(const void *given, CagError *e)
// It takes the address because the caller evaluates it before the call that makes the object.
static CagStatus drop_solid(CagStatus status, CagSolid *const *made) {
  if (status) return status;
  fault_found((double)(*made)->face_count);
  cag_solid_release(*made);
  return status;
}

// A solid with a boundary, and what is chosen of it.
typedef struct Rounded {
  CagSolid *solid;
  CagRolledEdge edges[2];
  CagSolidFace face;
} Rounded;

QUESTION(recognition) {
  CagSolid *s = NULL;
  return drop_solid(cag_solid_recognized(given, COARSE, &s, e), &s);
}
// The faces of a boundary as surfaces, whose loops have no seams.
QUESTION(surfaces) {
  const CagBoundary *b = given;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < b->face_count; i++) {
    CagSurface *face;
    status = cag_boundary_surface(b, i, &face, e);
    if (status) break;
    fault_found(face->u1);
    cag_surface_release(face);
  }
  return status;
}
QUESTION(smoothing) {
  CagMesh *m;
  const CagStatus status = cag_mesh_smooth(given, 0.7, &m, e);
  if (status) return status;
  fault_found((double)m->vertex_count);
  cag_mesh_release(m);
  return status;
}
QUESTION(rolling) {
  const Rounded *r = given;
  CagSolid *s = NULL;
  return drop_solid(cag_solid_roll(r->solid, r->edges, 2, COARSE, NULL, NULL, &s, e), &s);
}
QUESTION(bevel) {
  const Rounded *r = given;
  CagSolid *s = NULL;
  return drop_solid(cag_solid_bevel(r->solid, r->edges, 2, COARSE, NULL, NULL, &s, e), &s);
}
QUESTION(closed_shell) {
  CagSolid *s = NULL;
  return drop_solid(cag_solid_hollow(given, 1, false, NULL, 0, COARSE, &s, e), &s);
}
QUESTION(open_shell) {
  const Rounded *r = given;
  CagSolid *s = NULL;
  return drop_solid(cag_solid_hollow(r->solid, 1, false, &r->face, 1, COARSE, &s, e), &s);
}
QUESTION(draft) {
  const Rounded *r = given;
  CagSolid *s = NULL;
  const CagVec3 at = {0, 0, 0}, pull = {0, 0, 1};
  return drop_solid(cag_solid_incline(r->solid, &r->face, 1, 0.1, at, pull, COARSE, &s, e), &s);
}

// Two upright edges at one side.
static Rounded rounded_box(void) {
  Rounded r = {0};
  CagSolid *box;
  size_t n = 0;
  OK(cag_solid_box(cag_vec3(10, 8, 6), false, &box, &err));
  r.solid = recognized(box, COARSE);
  CagFeatures f = features_of(r.solid);
  for (size_t i = 0; i < f.edge_count && n < 2; i++)
    if (fabs(f.edges[i].direction.z) > 0.5)
      r.edges[n++] = (CagRolledEdge){0, f.edges[i].edge, {1, 1}};
  for (size_t i = 0; i < f.face_count; i++)
    if (f.faces[i].normal.x > 0.9) r.face.face = i;
  cag_features_free(&f);
  // The solid keeps its mesh.
  CagSolid *s;
  OK(cag_solid_roll(r.solid, r.edges, 2, COARSE, NULL, NULL, &s, &err));
  cag_solid_release(s);
  return r;
}

static void faces_and_normals_report_faults(void **state) {
  (void)state;
  CagSolid *block = holed_block(), *found;
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *m;
  size_t n;
  how.tolerance = COARSE;
  OK(cag_solid_tessellate(block, &how, &m, &err));
  found = recognized(block, COARSE);
  fault_problems = 0;
  fault_steps = FAULTS_OF_QUICK;
  try_faults("surfaces", "block", surfaces, cag_solid_boundaries(found, &n));
  try_faults("smoothing", "block", smoothing, m);
  assert_int_equal(fault_problems, 0);
  cag_mesh_release(m);
  cag_solid_release(found);
}

static void meshes_report_faults(void **state) {
  (void)state;
  Rounded r = rounded_box();
  CagSolid *box, *block = holed_block();
  OK(cag_solid_box(cag_vec3(10, 8, 6), false, &box, &err));
  fault_problems = 0;
  fault_steps = FAULTS_OF_SLOW;
  try_faults("recognition", "block", recognition, block);
  try_faults("rolling", "box", rolling, &r);
  try_faults("bevel", "box", bevel, &r);
  try_faults("closed shell", "box", closed_shell, box);
  try_faults("open shell", "box", open_shell, &r);
  try_faults("draft", "box", draft, &r);
  assert_int_equal(fault_problems, 0);
  cag_solid_release(r.solid);
  cag_solid_release(box);
  cag_solid_release(block);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(faces_and_normals_report_faults),
                                     cmocka_unit_test(meshes_report_faults)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
