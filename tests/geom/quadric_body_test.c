// Bodies that pieces of quadrics bound: volumes compared with closed forms and with sums over
// grids.

#include "geom/solid/csg.h"
#include "geom/surface/trimmed.h"
#include "quadric_support.h"

static CagSolid *body_of(const CagQuadric *q, const CagBounds *within, bool z_only,
                         const CagTransform *then) {
  CagSurface **list = NULL, *moved;
  size_t n = 0;
  CagSolid *s;
  MUST(cag_quadric_patches(q, within, z_only, &list, &n, err));
  for (size_t i = 0; then && i < n; i++) {
    MUST(cag_surface_transform(list[i], then, &moved, err));
    cag_surface_release(list[i]);
    list[i] = moved;
  }
  assert_true(cag_solid_has_quadric_body(list, n));
  // If a piece is missing, the others do not define the body.
  if (n > 1 && cag_surface_trimmed_view(list[0], NULL, NULL))
    assert_false(cag_solid_has_quadric_body(list, n - 1));
  MUST(cag_solid_quadric_body(list, n, NULL, &s, err));
  for (size_t i = 0; i < n; i++) cag_surface_release(list[i]);
  free(list);
  return s;
}

// Measures the volume of a mesh with this tolerance, as a fraction of the box. The mesh must be
// closed.
static double volume_of(const CagSolid *s, double tolerance) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMassProperties mass;
  CagMesh *m;
  how.tolerance = tolerance;
  MUST(cag_solid_tessellate(s, &how, &m, err));
  assert_true(m->triangle_count == 0 || cag_mesh_is_watertight(m, NULL));
  cag_mesh_release(m);
  MUST(cag_solid_mass_within(s, tolerance, &mass, err));
  return mass.volume;
}

// Length of the part of z0..z1 in which a z^2 + b z + c <= 0.
static double length_within(double a, double b, double c, double z0, double z1) {
  double cut[4] = {z0, z0, z0, z1}, sum = 0;
  int n = 1;
  const double rest = b * b - 4 * a * c;
  if (fabs(a) < 1e-12 * (fabs(b) + fabs(c))) {
    if (b != 0) cut[n++] = -c / b;
  } else if (rest > 0) {
    const double x = (-b - sqrt(rest)) / (2 * a), y = (-b + sqrt(rest)) / (2 * a);
    cut[n++] = fmin(x, y);
    cut[n++] = fmax(x, y);
  }
  cut[n] = z1;
  for (int i = 0; i <= n; i++) cut[i] = fmin(fmax(cut[i], z0), z1);
  for (int i = 0; i < n; i++) {
    const double z = (cut[i] + cut[i + 1]) / 2;
    if ((a * z + b) * z + c <= 0) sum += cut[i + 1] - cut[i];
  }
  return sum;
}

// Volume of the part of the box in which the form is negative: closed form along z, sum over x and
// y.
static double sum_over_grid(const CagQuadric *q, const CagBounds *box) {
  enum { STEPS = 200 };
  const CagVec3 size = cag_sub(box->max, box->min);
  const double *k = q->c;
  double sum = 0;
  for (int i = 0; i < STEPS; i++)
    for (int j = 0; j < STEPS; j++) {
      const double x = box->min.x + size.x * (i + 0.5) / STEPS;
      const double y = box->min.y + size.y * (j + 0.5) / STEPS;
      const double c = k[0] * x * x + k[1] * y * y + k[3] * x * y + k[6] * x + k[7] * y + k[9];
      sum += length_within(k[2], k[4] * y + k[5] * x + k[8], c, box->min.z, box->max.z);
    }
  return sum * size.x * size.y / (STEPS * STEPS);
}

#ifndef ROUNDS
#define ROUNDS 2
#endif

static void bodies_within_boxes_have_the_volume_of_their_forms(void **state) {
  (void)state;
  enum { CURVED = 9 };
  int bodies = 0;
  for (int i = 0; i < ROUNDS * CURVED; i++) {
    state_of_random = 900 + (uint64_t)i;
    const CagQuadric q = random_quadric(UNITS[i % CURVED], i / CURVED % 2 == 0);
    const CagVec3 corner = cag_vec3(random_in(-2, 0), random_in(-2, 0), random_in(-2, 0));
    const CagBounds box = {
        corner, cag_add(corner, cag_vec3(random_in(1, 4), random_in(1, 4), random_in(1, 4)))};
    const CagVec3 size = cag_sub(box.max, box.min);
    CagSurface **list = NULL;
    size_t n = 0;
    CagError why;
    if (cag_quadric_patches(&q, &box, false, &list, &n, &why)) continue;
    bool trimmed = false;
    for (size_t k = 0; k < n; k++) {
      trimmed = trimmed || cag_surface_trimmed_view(list[k], NULL, NULL);
      cag_surface_release(list[k]);
    }
    free(list);
    CagSolid *s = body_of(&q, &box, false, NULL);
    const double all = size.x * size.y * size.z;
    assert_near(volume_of(s, 1e-3) / all, sum_over_grid(&q, &box) / all, 3e-3, "volume");
    cag_solid_release(s);
    bodies += trimmed;
  }
  assert_true(bodies > ROUNDS * CURVED / 2);
}

static void bodies_have_closed_forms(void **state) {
  (void)state;
  // A ball of radius 5 in a cube of 8 loses six caps of height 1: pi h^2 (3 r - h) / 3 each.
  const CagQuadric ball = {{1, 1, 1, 0, 0, 0, 0, 0, 0, -25}};
  const CagBounds cube = {{-4, -4, -4}, {4, 4, 4}};
  CagSolid *s = body_of(&ball, &cube, false, NULL);
  const double volume = M_PI * (4 * 125 / 3.0 - 6 * 14 / 3.0);
  assert_near(volume_of(s, 1e-3) / volume, 1, 1e-3, "ball");
  cag_solid_release(s);
  // Later transforms move the cut as well.
  CagTransform turn, stretch;
  MUST(cag_rotate(cag_vec3(1, 2, 3), 0.7, cag_vec3(1, 0, 0), &turn, err));
  MUST(cag_scale(cag_vec3(1, 2, 0.5), cag_vec3(0, 0, 0), &stretch, err));
  stretch.planar = turn.planar = false;
  turn = cag_transform_multiply(&stretch, &turn);
  s = body_of(&ball, &cube, false, &turn);
  assert_near(volume_of(s, 1e-3) / volume, 1, 1e-3, "moved ball");
  cag_solid_release(s);
  // A paraboloid r^2 = t about an axis at 0.1 rad to the horizontal. The plane z = c cuts off pi
  // R^4 / 2 with R^2 = cot^2 / 4 + c / sin.
  const double cosine = cos(0.1), sine = sin(0.1);
  const CagQuadric level = {
      {1, sine * sine, cosine * cosine, 0, 2 * sine * cosine, 0, 0, cosine, -sine, 0}};
  const CagBounds range = {{0, 0, -1}, {0, 0, 1}};
  const double middle = cosine * cosine / (4 * sine * sine);
  const double slab = M_PI / 2 * (pow(middle + 1 / sine, 2) - pow(middle - 1 / sine, 2));
  s = body_of(&level, &range, true, NULL);
  assert_near(volume_of(s, 2e-3) / slab, 1, 2e-3, "paraboloid");
  cag_solid_release(s);
  // The body of a saddle is where its form is negative: z > x^2 - y^2 or z < x^2 - y^2, over a
  // square of side 2 from z = -1 to z = 3.
  const CagQuadric above = {{1, -1, 0, 0, 0, 0, 0, 0, -1, 0}};
  const CagQuadric below = {{-1, 1, 0, 0, 0, 0, 0, 0, 1, 0}};
  const CagBounds tower = {{-1, -1, -1}, {1, 1, 3}};
  s = body_of(&above, &tower, false, NULL);
  assert_near(volume_of(s, 1e-3), 12, 1e-3, "above");
  cag_solid_release(s);
  s = body_of(&below, &tower, false, NULL);
  assert_near(volume_of(s, 1e-3), 4, 1e-3, "below");
  cag_solid_release(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bodies_within_boxes_have_the_volume_of_their_forms),
      cmocka_unit_test(bodies_have_closed_forms),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
