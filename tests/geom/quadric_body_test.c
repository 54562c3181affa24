// Bodies bounded by pieces of quadrics: masses and planar faces, compared with closed forms and
// with integrals over the box.

#include "box_integral.h"
#include "geom/meet/quadric_body.h"
#include "geom/solid/csg.h"
#include "geom/solid/tessellate.h"
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

static double volume_of(const CagSolid *s) {
  CagMassProperties mass;
  MUST(cag_solid_mass(s, &mass, err));
  return mass.volume;
}

// The volume of a mesh with this tolerance, which must be closed.
static double volume_of_mesh(const CagSolid *s, double tolerance) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  double terms[10] = {0};
  CagMesh *m;
  how.tolerance = tolerance;
  MUST(cag_solid_tessellate(s, &how, &m, err));
  assert_true(m->triangle_count == 0 || cag_mesh_is_watertight(m, NULL));
  cag_mesh_volume_terms(m, terms);
  cag_mesh_release(m);
  return terms[0];
}

#ifndef ROUNDS
#define ROUNDS 2
#endif
// Pieces end at splines that are accurate to 1e-11 of the box.
#define EXACT 1e-9

// Compares volume, center, and inertia with integrals over the box, about its center.
static void check_mass(const CagSolid *s, const CagQuadric *q, const CagBounds *box, double all,
                       double size) {
  CagMassProperties mass;
  CagTransform shift = cag_translate(cag_scaled(cag_lerp(box->min, box->max, 0.5), -1));
  CagQuadric local;
  shift.planar = false;
  MUST(cag_quadric_transform(q, &shift, &local, err));
  const CagBounds around = {cag_transform_point(&shift, box->min),
                            cag_transform_point(&shift, box->max)};
  double sum[INTEGRALS];
  box_integrals(&local, &around, sum);
  MUST(cag_solid_mass(s, &mass, err));
  const CagVec3 c = cag_transform_point(&shift, mass.volume_centroid);
  const double at[3] = {c.x, c.y, c.z}, square = cag_dot(c, c), v = mass.volume;
  assert_near(v / all, sum[0] / all, EXACT, "volume");
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    assert_near(v * at[i] / (all * size), sum[1 + i] / (all * size), EXACT, "center");
    assert_near((mass.inertia[i][i] + v * (square - at[i] * at[i])) / (all * size * size),
                (sum[4 + j] + sum[4 + k]) / (all * size * size), EXACT, "moment");
    assert_near((mass.inertia[i][j] - v * at[i] * at[j]) / (all * size * size),
                -sum[7 + i] / (all * size * size), EXACT, "product");
  }
}

// Compares the planar faces at both ends of z with sections of the form.
static void check_caps(const CagSolid *s, const CagQuadric *q, const CagBounds *box) {
  const CagVec3 size = cag_sub(box->max, box->min);
  double areas[2] = {0, 0};
  for (size_t i = 0; i < s->face_count; i++) {
    CagTransform frame;
    double area;
    CagVec3 centroid;
    if (!cag_surface_planar_view(s->faces[i], NULL, &frame)) continue;
    if (fabs(frame.m[2][2]) < 0.5) continue;
    MUST(cag_surface_area(s->faces[i], &area, &centroid, err));
    areas[frame.m[2][2] > 0] += area;
  }
  assert_near(areas[0] / (size.x * size.y), area_at_z(q, box, box->min.z) / (size.x * size.y),
              EXACT, "lower face");
  assert_near(areas[1] / (size.x * size.y), area_at_z(q, box, box->max.z) / (size.x * size.y),
              EXACT, "upper face");
}

// Checks that the body has exact faces: pieces of the quadric and planar ones.
static void check_faces(const CagSolid *s) {
  size_t flat = 0;
  for (size_t i = 0; i < s->face_count; i++)
    flat += cag_surface_planar_view(s->faces[i], NULL, NULL);
  assert_true(flat > 0 && flat < s->face_count);
}

static void bodies_within_boxes_have_the_integrals_of_their_forms(void **state) {
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
    for (size_t k = 0; k < n; k++) cag_surface_release(list[k]);
    free(list);
    CagSolid *s = body_of(&q, &box, false, NULL);
    check_faces(s);
    check_mass(s, &q, &box, size.x * size.y * size.z, cag_norm(size));
    check_caps(s, &q, &box);
    if (i < CURVED && i % 2 == 0) {
      // A mesh approximates the body within its tolerance.
      CagMassProperties mass;
      MUST(cag_solid_mass(s, &mass, err));
      for (double tolerance = 1e-2; tolerance > 5e-4; tolerance /= 10)
        assert_near(volume_of_mesh(s, tolerance), mass.volume, tolerance * mass.area, "mesh");
    }
    cag_solid_release(s);
    bodies++;
  }
  assert_true(bodies > ROUNDS * CURVED / 2);
}

// Ellipsoids, hyperboloids, cones, elliptic paraboloids, and cylinders with axes up to 0.3 rad off
// z.
static void bodies_within_ranges_have_the_integrals_of_their_forms(void **state) {
  (void)state;
  const int classes[] = {0, 1, 2, 3, 4, 6};
  int bodies = 0;
  for (int i = 0; i < ROUNDS * 6; i++) {
    state_of_random = 4000 + (uint64_t)i;
    CagQuadric upright = random_quadric(UNITS[classes[i % 6]], false), q;
    CagTransform tilt;
    CagError why;
    MUST(cag_rotate(cag_vec3(random_in(-1, 1), random_in(-1, 1), 0), random_in(0, 0.3),
                    cag_vec3(0, 0, 0), &tilt, err));
    MUST(cag_quadric_transform(&upright, &tilt, &q, err));
    const CagBounds range = {{0, 0, random_in(-1.5, 0)}, {0, 0, random_in(0.2, 2)}};
    CagSurface **list = NULL;
    size_t n = 0;
    if (cag_quadric_patches(&q, &range, true, &list, &n, &why)) continue;
    for (size_t k = 0; k < n; k++) cag_surface_release(list[k]);
    free(list);
    CagSolid *s = body_of(&q, &range, true, NULL);
    CagBounds box;
    MUST(cag_solid_bounds(s, &box, err));
    check_faces(s);
    // The box of the integral is wider than the body, and the range determines the ends.
    const CagVec3 size = cag_sub(box.max, box.min);
    box.min = cag_vec3(box.min.x - 0.1, box.min.y - 0.1, range.min.z);
    box.max = cag_vec3(box.max.x + 0.1, box.max.y + 0.1, range.max.z);
    check_mass(s, &q, &box, size.x * size.y * size.z, cag_norm(size));
    check_caps(s, &q, &box);
    cag_solid_release(s);
    bodies++;
  }
  assert_true(bodies > ROUNDS * 3);
}

static void bodies_have_closed_forms(void **state) {
  (void)state;
  // A ball of radius 5 in a cube of side 8 loses six caps of height 1: pi h^2 (3 r - h) / 3 each.
  const CagQuadric ball = {{1, 1, 1, 0, 0, 0, 0, 0, 0, -25}};
  const CagBounds cube = {{-4, -4, -4}, {4, 4, 4}};
  CagSolid *s = body_of(&ball, &cube, false, NULL);
  const double volume = M_PI * (4 * 125 / 3.0 - 6 * 14 / 3.0);
  assert_near(volume_of(s) / volume, 1, 1e-9, "ball");
  cag_solid_release(s);
  // Subsequent transforms move the cut as well.
  CagTransform turn, stretch;
  MUST(cag_rotate(cag_vec3(1, 2, 3), 0.7, cag_vec3(1, 0, 0), &turn, err));
  MUST(cag_scale(cag_vec3(1, 2, 0.5), cag_vec3(0, 0, 0), &stretch, err));
  stretch.planar = turn.planar = false;
  turn = cag_transform_multiply(&stretch, &turn);
  s = body_of(&ball, &cube, false, &turn);
  assert_near(volume_of(s) / volume, 1, 1e-9, "moved ball");
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
  assert_near(volume_of(s) / slab, 1, 1e-9, "paraboloid");
  cag_solid_release(s);
  // The body of a saddle is where its form is negative: z > x^2 - y^2 or z < x^2 - y^2, over a
  // square of side 2 from z = -1 to z = 3.
  const CagQuadric above = {{1, -1, 0, 0, 0, 0, 0, 0, -1, 0}};
  const CagQuadric below = {{-1, 1, 0, 0, 0, 0, 0, 0, 1, 0}};
  const CagBounds tower = {{-1, -1, -1}, {1, 1, 3}};
  s = body_of(&above, &tower, false, NULL);
  assert_near(volume_of(s), 12, 1e-9, "above");
  cag_solid_release(s);
  s = body_of(&below, &tower, false, NULL);
  assert_near(volume_of(s), 4, 1e-9, "below");
  cag_solid_release(s);
}

// An ellipsoid with semi-axes 3, 2, and 2, rotated about the y axis, in a range that contains its
// extremes in x and y.
static void bounds_reach_the_extremes_between_the_caps(void **state) {
  (void)state;
  const double angle = 0.1, c = cos(angle), s = sin(angle);
  const CagQuadric upright = {{1.0 / 9, 1.0 / 4, 1.0 / 4, 0, 0, 0, 0, 0, 0, -1}};
  const CagBounds range = {{0, 0, -0.5}, {0, 0, 0.6}};
  CagTransform turn;
  CagQuadric q;
  CagBounds box;
  MUST(cag_rotate(cag_vec3(0, 1, 0), angle, cag_vec3(0, 0, 0), &turn, err));
  MUST(cag_quadric_transform(&upright, &turn, &q, err));
  CagSolid *body = body_of(&q, &range, true, NULL);
  MUST(cag_solid_bounds(body, &box, err));
  const double reach = sqrt(9 * c * c + 4 * s * s);
  assert_point(box.min, cag_vec3(-reach, -2, -0.5), 1e-9, "low");
  assert_point(box.max, cag_vec3(reach, 2, 0.6), 1e-9, "high");
  cag_solid_release(body);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bodies_within_boxes_have_the_integrals_of_their_forms),
      cmocka_unit_test(bodies_within_ranges_have_the_integrals_of_their_forms),
      cmocka_unit_test(bodies_have_closed_forms),
      cmocka_unit_test(bounds_reach_the_extremes_between_the_caps),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
