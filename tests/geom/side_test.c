// Meshes of half spaces and of the negative sides of quadrics, compared with integrals over the
// window.

#include "box_integral.h"
#include "geom/boolean/boolean.h"
#include "geom/solid/csg.h"
#include "quadric_support.h"

static const double PLANE[10] = {0, 0, 0, 0, 0, 0, 0, 0, 1, -0.3};

// The distance of a mesh from the form's surface.
#define TOLERANCE 2e-3

// Checks that the mesh is closed and agrees with the form inside the window: it has the same volume
// and center there, and its corners are on the surface.
static void check_mesh(const CagQuadric *q, const CagBounds *window, const double *sum) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *m, *box, *common;
  double terms[10] = {0};
  how.tolerance = TOLERANCE;
  MUST(cag_side_mesh(q, window, &how, &m, err));
  const CagVec3 size = cag_sub(window->max, window->min);
  const double all = size.x * size.y * size.z, diagonal = cag_norm(size);
  if (m->triangle_count > 0) {
    assert_true(cag_mesh_is_watertight(m, NULL));
    MUST(cag_box_mesh(window, &box, err));
    MUST(cag_mesh_boolean(CAG_INTERSECTION, m, box, NULL, &common, err));
    cag_mesh_volume_terms(common, terms);
    cag_mesh_release(common);
    cag_mesh_release(box);
  }
  // The area of the surface inside the window is at most about four times that of its largest
  // section.
  const double slack = 4 * TOLERANCE * diagonal * diagonal;
  assert_near(terms[0] / all, sum[0] / all, slack / all, "volume");
  for (int i = 1; i < 4; i++)
    assert_near(terms[i] / (all * diagonal), sum[i] / (all * diagonal), 2 * slack / all, "center");
  for (size_t i = 0; i < m->vertex_count; i++) {
    const CagVec3 p = m->positions[i];
    const double *c = q->c;
    if (!(p.x > window->min.x && p.x < window->max.x && p.y > window->min.y &&
          p.y < window->max.y && p.z > window->min.z && p.z < window->max.z))
      continue;
    double greatest = 0;
    for (int k = 0; k < 10; k++) greatest = fmax(greatest, fabs(c[k]));
    assert_near(cag_quadric_value(q, p) / greatest, 0, 1e-7, "corner");
  }
  cag_mesh_release(m);
}

// Checks both sides of the form, which together fill the window.
static void check_sides(const CagQuadric *q, const CagBounds *window) {
  const CagVec3 size = cag_sub(window->max, window->min);
  const CagVec3 middle = cag_lerp(window->min, window->max, 0.5);
  const double all = size.x * size.y * size.z;
  const double whole[4] = {all, all * middle.x, all * middle.y, all * middle.z};
  CagQuadric other;
  double sum[INTEGRALS];
  for (int i = 0; i < 10; i++) other.c[i] = -q->c[i];
  box_integrals(q, window, sum);
  check_mesh(q, window, sum);
  for (int i = 0; i < 4; i++) sum[i] = whole[i] - sum[i];
  check_mesh(&other, window, sum);
}

static void sides_have_the_integrals_of_their_forms(void **state) {
  (void)state;
  for (int i = 0; i < 2 * (CLASSES + 1); i++) {
    state_of_random = 7000 + (uint64_t)i;
    const double *unit = i % (CLASSES + 1) == CLASSES ? PLANE : UNITS[i % (CLASSES + 1)];
    const CagQuadric q = random_quadric(unit, i > CLASSES);
    double corner[3], size[3];
    for (int k = 0; k < 3; k++) corner[k] = random_in(-2.5, 0);
    for (int k = 0; k < 3; k++) size[k] = random_in(1, 4);
    const CagVec3 low = cag_vec3(corner[0], corner[1], corner[2]);
    const CagBounds window = {low, cag_add(low, cag_vec3(size[0], size[1], size[2]))};
    check_sides(&q, &window);
  }
}

// Windows at some distance from the center of the form, which a sheet, a nappe, a branch, or the
// entire surface does not reach.
static void sides_far_from_the_center(void **state) {
  (void)state;
  static const double WAYS[6][3] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                    {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
  for (int i = 0; i < 6 * (REAL + 1); i++) {
    state_of_random = 8000 + (uint64_t)i;
    const double *unit = i % (REAL + 1) == REAL ? PLANE : UNITS[i % (REAL + 1)];
    const CagQuadric q = random_quadric(unit, false);
    const double *way = WAYS[i / (REAL + 1)], far = random_in(1.5, 6);
    double shift[3];
    for (int k = 0; k < 3; k++) shift[k] = far * way[k] + random_in(-0.5, 0.5);
    const CagVec3 low = cag_vec3(shift[0] - 1, shift[1] - 1, shift[2] - 1);
    const CagBounds window = {low, cag_add(low, cag_vec3(2, 2, 2))};
    check_sides(&q, &window);
  }
}

// Sheets and branches with tips in the window, which is small compared with their semi-axes.
static void tips_of_large_forms_are_in_small_windows(void **state) {
  (void)state;
  const CagQuadric sheets = {{1, 1, -1, 0, 0, 0, 0, 0, 0, 1e4}};
  const CagQuadric branches = {{-1, 1, 0, 0, 0, 0, 0, 0, 0, 1e4}};
  for (int side = -1; side <= 1; side += 2) {
    const CagBounds tip = {{-3, -4, side * 100 - 1}, {4, 3, side * 100 + 1}};
    const CagBounds bend = {{side * 100 - 1, -4, -3}, {side * 100 + 1, 3, 4}};
    check_sides(&sheets, &tip);
    check_sides(&branches, &bend);
  }
}

// Closing faces are outside the window, but not much farther away than its diagonal.
static void planes_end_near_the_window(void **state) {
  (void)state;
  for (int i = 0; i < 40; i++) {
    state_of_random = 9000 + (uint64_t)i;
    const CagQuadric q = random_quadric(PLANE, true);
    double low[3];
    for (int k = 0; k < 3; k++) low[k] = random_in(-4, 4);
    const CagBounds window = {{low[0], low[1], low[2]}, {low[0] + 1, low[1] + 2, low[2] + 3}};
    const CagVec3 middle = cag_lerp(window.min, window.max, 0.5);
    const double diagonal = sqrt(14), *n = q.c + 6,
                 length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    CagMesh *m;
    MUST(cag_side_mesh(&q, &window, &CAG_TESSELLATION_DEFAULT, &m, err));
    const double above = cag_quadric_value(&q, middle) / length;
    if (above > diagonal) assert_int_equal(m->triangle_count, 0);
    if (above < 0) assert_true(m->triangle_count > 0);
    for (size_t k = 0; k < m->vertex_count; k++)
      assert_true(cag_norm(cag_sub(m->positions[k], middle)) < 2.5 * diagonal);
    if (fabs(above) < diagonal / 2) {
      // Half of the corners are in the plane.
      int on = 0;
      for (size_t k = 0; k < m->vertex_count; k++)
        on += fabs(cag_quadric_value(&q, m->positions[k])) < 1e-12 * length * 10;
      assert_int_equal(on, 4);
    }
    cag_mesh_release(m);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sides_have_the_integrals_of_their_forms),
      cmocka_unit_test(sides_far_from_the_center),
      cmocka_unit_test(tips_of_large_forms_are_in_small_windows),
      cmocka_unit_test(planes_end_near_the_window),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
