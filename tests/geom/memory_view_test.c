// Tests drawings with exhausted memory and with interrupted work. Each fault is reported, and
// nothing leaks.

#include "faults.h"
#include "geom/curve/region.h"
#include "geom/solid/solid.h"
#include "geom/solid/tessellate.h"
#include "geom/view/hidden.h"

typedef struct Scene {
  CagViewBody bodies[2];
  size_t n;
  CagTransform frame;
} Scene;

static CagStatus draw(const void *given, CagError *e) {
  const Scene *s = given;
  CagCurveList visible = {0}, hidden = {0};
  const CagStatus status = cag_hidden_lines(s->bodies, s->n, &s->frame, &visible, &hidden, e);
  for (size_t i = 0; !status && i < visible.count; i++) {
    CagVec3 p;
    assert_int_equal(cag_curve_point(visible.items[i], visible.items[i]->start, &p, e), CAG_OK);
    fault_found(p.x + p.y);
  }
  if (!status) fault_found((double)hidden.count);
  cag_curve_list_free(&visible);
  cag_curve_list_free(&hidden);
  return status;
}

static Scene seen_along(CagVec3 direction) {
  const CagPlane plane = {.normal = cag_unit(direction)};
  return (Scene){.frame = cag_plane_frame(&plane)};
}

static void drawings_report_faults(void **state) {
  (void)state;

  CagSolid *box, *ball, *moved, *can;
  CagMesh *mesh;
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  const CagTransform up = cag_translate(cag_vec3(2, 1, 1));
  fault_problems = 0;
  assert_int_equal(cag_solid_box(cag_vec3(1, 2, 3), false, &box, &err), CAG_OK);
  assert_int_equal(cag_solid_sphere(1, &ball, &err), CAG_OK);
  assert_int_equal(cag_solid_transform(ball, &up, &moved, &err), CAG_OK);
  assert_int_equal(cag_solid_cylinder(2, 1, 1, &can, &err), CAG_OK);
  how.tolerance = 0.2;
  assert_int_equal(cag_solid_tessellate(box, &how, &mesh, &err), CAG_OK);

  fault_steps = FAULTS_OF_SLOW;
  Scene pair = seen_along(cag_vec3(1, 0.2, 0.1));
  pair.bodies[0].solid = box;
  pair.bodies[1].solid = moved;
  pair.n = 2;
  try_faults("drawing", "box and ball", draw, &pair);
  Scene one = seen_along(cag_vec3(0, -1, 1));
  one.bodies[0].solid = can;
  one.n = 1;
  try_faults("drawing", "cylinder", draw, &one);
  Scene facets = seen_along(cag_vec3(1, 1, 1));
  facets.bodies[0].mesh = mesh;
  facets.n = 1;
  try_faults("drawing", "mesh", draw, &facets);
  assert_int_equal(fault_problems, 0);

  cag_mesh_release(mesh);
  cag_solid_release(can);
  cag_solid_release(moved);
  cag_solid_release(ball);
  cag_solid_release(box);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(drawings_report_faults)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
