// Nearest points of boundaries: they are on the boundary, and no ray from the point meets it closer.
// Some have closed forms.

#include "random_point.h"
#include "support.h"

#include "base/memory.h"
#include "geom/ray/nearest.h"
#include "geom/solid/csg.h"
#include "geom/solid/tessellate.h"
#include "geom/surface/quadric_equation.h"
#include "geom/surface/quadric_nearest.h"

// Rays in all directions, and close to the direction of the nearest point.
enum { RAYS = 200, CLOSE_RAYS = 100 };
// Kinds of random solids.
enum { KINDS = 8 };
#define CLOSE 0.1
#define EXACT 1e-9 // relative to the size

static CagTransform random_similarity(void) {
  CagTransform turn, scale;
  const double angle = uniform(-3, 3), by = uniform(0.5, 2);
  const CagVec3 axis = random_point(1), factors = {by, (uniform(0, 1) < 0.5) ? by : -by, by};
  OK(cag_rotate(axis, angle, cag_vec3(0, 0, 0), &turn, &err));
  OK(cag_scale(factors, cag_vec3(0, 0, 0), &scale, &err));
  const CagTransform move = cag_translate(random_point(5));
  turn = cag_transform_multiply(&turn, &scale);
  return cag_transform_multiply(&move, &turn);
}

static CagTransform random_affine(void) {
  const CagTransform turn = random_similarity();
  CagTransform t = cag_shear(0.3, 0, 0.2, 0, 0, uniform(-0.5, 0.5));
  for (int k = 0; k < 3; k++) t.m[k][2] *= uniform(0.4, 1.5);
  return cag_transform_multiply(&turn, &t);
}

// How many points that are not certain were looked for on the exact boundary, and found.
static int tried, polished;

// The distance at which a ray first meets the boundary.
static double first_hit(const CagCaster *c, CagVec3 from, CagVec3 to, CagCrossings *work) {
  const CagRay ray = {from, cag_unit(to), 0, INFINITY};
  CagCrossing hit;
  bool met;
  OK(cag_caster_first(c, &ray, work, &hit, &met, &err));
  return met ? hit.t : INFINITY;
}

// The nearest point of a set operation that its operands do not decide.
static void find_polished(const CagSolid *s, const CagCaster *c, CagVec3 p, double size,
                          CagCrossings *work, CagNearest *out) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *m;
  CagCaster *mesh;
  CagNearest near;
  how.tolerance = 1e-4 * size;
  OK(cag_solid_tessellate(s, &how, &m, &err));
  OK(cag_caster_of_mesh(m, &mesh, &err));
  OK(cag_caster_closest(mesh, p, INFINITY, work, &near, &err));
  OK(cag_caster_polish(c, p, near.point, 2e-3 * size, work, out, &err));
  cag_caster_free(mesh);
  cag_mesh_release(m);
}

// Checks that a point is on the boundary and that no other one is closer.
static void check_point(const CagCaster *c, CagVec3 p, const CagNearest *found, double size,
                        CagCrossings *work) {
  const CagVec3 way = cag_sub(found->point, p);
  NEAR(found->distance, cag_norm(way), EXACT * size);
  // Rays that pass it closely meet the boundary near it, even at an edge.
  double there = INFINITY, least = INFINITY;
  const double wide = CLOSE * found->distance, narrow = 1e-6 * found->distance + 1e-9;
  for (int i = 0; i < CLOSE_RAYS; i++) {
    there = fmin(there, first_hit(c, p, cag_add(way, random_point(narrow)), work));
    least = fmin(least, first_hit(c, p, cag_add(way, random_point(wide)), work));
  }
  assert_true(there <= found->distance + 1e-4 * size);
  assert_true(found->distance <= least * (1 + EXACT) + EXACT * size);
}

// Checks the nearest point of p, and returns its distance; less than 0 if it is not certain.
static double check_nearest(const CagSolid *s, CagVec3 p, double size) {
  CagCaster *c;
  CagCrossings work = {0};
  CagNearest found, other;
  OK(cag_caster_of_solid(s, &c, &err));
  OK(cag_caster_closest(c, p, INFINITY, &work, &found, &err));
  assert_true(found.found);
  double least = INFINITY;
  for (int i = 0; i < RAYS; i++) least = fmin(least, first_hit(c, p, random_point(1), &work));
  assert_true(found.distance <= least * (1 + EXACT) + EXACT * size);
  if (found.certain) {
    check_point(c, p, &found, size, &work);
    // Nothing is found within less than the distance.
    OK(cag_caster_closest(c, p, found.distance * (1 - 1e-9) - 1e-12, &work, &other, &err));
    assert_false(other.found);
  } else {
    find_polished(s, c, p, size, &work, &other);
    tried++;
    polished += other.found;
    if (other.found) {
      assert_true(other.distance >= found.distance - EXACT * size);
      check_point(c, p, &other, size, &work);
    }
  }
  cag_crossings_free(&work);
  cag_caster_free(c);
  return found.certain ? found.distance : -1;
}

static CagSolid *moved(CagSolid *s, const CagTransform *t) {
  CagSolid *out;
  OK(cag_solid_transform(s, t, &out, &err));
  cag_solid_release(s);
  return out;
}

// A disk with a square hole beside the z axis, which is extruded or revolved.
static CagSolid *random_face_solid(bool turn) {
  CagTransform plane = cag_translate(cag_vec3(3, 0, 0));
  plane.planar = true;
  const CagVec3 square[] = {{2.5, -0.5, 0}, {3.5, -0.5, 0}, {3.5, 0.5, 0}, {2.5, 0.5, 0}};
  const double size = uniform(1, 2);
  CagCurve *outline, *hole;
  CagRegion *region;
  CagSolid *s;
  OK(cag_curve_arc(size, size, 0, 2 * M_PI, &plane, &outline, &err));
  OK(cag_curve_polyline(square, 4, true, 2, &hole, &err));
  OK(cag_region_new(outline, &hole, 1, &region, &err));
  if (turn) OK(cag_solid_revolve(region, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0, 4, &s, &err));
  else OK(cag_solid_extrude(region, cag_vec3(0, 0, 3), 0, 1, &s, &err));
  cag_region_release(region);
  cag_curve_release(outline);
  cag_curve_release(hole);
  return s;
}

static CagSolid *random_primitive(int kind) {
  CagSolid *s = NULL;
  const CagVec3 size = {uniform(1, 4), uniform(1, 4), uniform(1, 4)};
  switch (kind) {
  case 6:
  case 7: return random_face_solid(kind == 7);
  case 0: OK(cag_solid_box(size, (uniform(0, 1) < 0.5), &s, &err)); break;
  case 1: OK(cag_solid_sphere(size.x, &s, &err)); break;
  case 2: OK(cag_solid_cylinder(size.x, size.y, size.y, &s, &err)); break;
  case 3: OK(cag_solid_cylinder(size.x, size.y, 0, &s, &err)); break;
  case 4: OK(cag_solid_cylinder(size.x, size.y, size.z, &s, &err)); break;
  default: OK(cag_solid_torus(3 + size.x, size.y / 2, &s, &err));
  }
  return s;
}

static void solids_have_nearest_points(void **state) {
  (void)state;
  seed = 5;
  for (int i = 0; i < 120; i++) {
    const CagTransform t = random_similarity();
    CagSolid *s = moved(random_primitive(i % KINDS), &t);
    assert_true(check_nearest(s, random_point(i % 4 ? 12 : 4), 10) >= 0);
    cag_solid_release(s);
  }
}

static void affine_images_of_solids_have_nearest_points(void **state) {
  (void)state;
  seed = 6;
  for (int i = 0; i < 60; i++) {
    const CagTransform t = random_affine();
    CagSolid *s = moved(random_primitive(i % KINDS), &t);
    assert_true(check_nearest(s, random_point(i % 4 ? 12 : 4), 10) >= 0);
    cag_solid_release(s);
  }
}

// Points on axes and at centers have many nearest points.
static void symmetric_points_have_one_of_the_nearest_points(void **state) {
  (void)state;
  CagSolid *s;
  OK(cag_solid_sphere(2, &s, &err));
  NEAR(check_nearest(s, cag_vec3(0, 0, 0), 4), 2, 1e-12);
  cag_solid_release(s);
  OK(cag_solid_torus(5, 1, &s, &err));
  NEAR(check_nearest(s, cag_vec3(0, 0, 0), 12), 4, 1e-12);
  NEAR(check_nearest(s, cag_vec3(0, 5, 0), 12), 1, 1e-12);
  cag_solid_release(s);
  OK(cag_solid_cylinder(6, 2, 2, &s, &err));
  NEAR(check_nearest(s, cag_vec3(0, 0, 3), 8), 2, 1e-12);
  NEAR(check_nearest(s, cag_vec3(0, 0, 5), 8), 1, 1e-12);
  NEAR(check_nearest(s, cag_vec3(5, 0, 10), 8), 5, 1e-12);
  cag_solid_release(s);
}

static CagSolid *combined(CagSetOperation op, CagSolid *a, CagSolid *b) {
  CagSolid *operands[2] = {a, b}, *out;
  OK(cag_solid_combine(op, operands, 2, NULL, &out, &err));
  cag_solid_release(a);
  cag_solid_release(b);
  return out;
}

static CagSolid *centered_box(double x, double y, double z) {
  CagSolid *s;
  OK(cag_solid_box(cag_vec3(x, y, z), true, &s, &err));
  return s;
}

static CagSolid *cylinder_at(double from, double height, double radius) {
  CagSolid *s;
  const CagTransform t = cag_translate(cag_vec3(0, 0, from));
  OK(cag_solid_cylinder(height, radius, radius, &s, &err));
  return moved(s, &t);
}

static void edges_have_closed_forms(void **state) {
  (void)state;
  CagCrossings work = {0};
  CagCaster *c;
  CagNearest found;
  // The rim of a hole, whose cylinder ends at the faces of the plate, from above its middle.
  CagSolid *s = combined(CAG_DIFFERENCE, centered_box(20, 20, 2), cylinder_at(-1, 2, 3));
  OK(cag_caster_of_solid(s, &c, &err));
  find_polished(s, c, cag_vec3(1, 2, 6), 28, &work, &found);
  assert_true(found.found);
  near_vec(found.point, cag_vec3(3 / sqrt(5), 6 / sqrt(5), 1), 1e-6);
  NEAR(found.distance, hypot(3 - sqrt(5), 5), 1e-12);
  find_polished(s, c, cag_vec3(0, 0, 5), 28, &work, &found);
  assert_true(found.found);
  NEAR(found.distance, 5, 1e-12);
  cag_caster_free(c);
  cag_solid_release(s);
  // A corner of two boxes and a cylinder.
  const CagTransform aside = cag_translate(cag_vec3(4, 4, 0));
  s = combined(CAG_INTERSECTION, moved(centered_box(8, 8, 9), &aside), cylinder_at(-1, 5, 5));
  s = combined(CAG_INTERSECTION, s, centered_box(20, 6, 4));
  OK(cag_caster_of_solid(s, &c, &err));
  find_polished(s, c, cag_vec3(7, 6, 5), 12, &work, &found);
  assert_true(found.found);
  near_vec(found.point, cag_vec3(4, 3, 2), 1e-9);
  cag_caster_free(c);
  cag_solid_release(s);
  cag_crossings_free(&work);
}

static void set_operations_know_whether_an_operand_decides(void **state) {
  (void)state;
  seed = 7;
  int certain = 0, all = 0;
  for (int i = 0; i < 90; i++) {
    const CagTransform t = i % 2 ? random_similarity() : random_affine(), u = random_similarity();
    CagSolid *a = moved(random_primitive(i % KINDS), &t),
             *b = moved(random_primitive(i / KINDS % KINDS), &u);
    const CagSetOperation op = i % 3 == 0   ? CAG_UNION
                               : i % 3 == 1 ? CAG_DIFFERENCE
                                            : CAG_INTERSECTION;
    CagSolid *s = combined(op, a, b);
    CagBounds box;
    const bool empty = cag_solid_bounds(s, &box, &err) != CAG_OK;
    all += !empty;
    if (!empty) certain += check_nearest(s, random_point(12), 15) >= 0;
    cag_solid_release(s);
  }
  assert_true(certain > all / 2);
  assert_true(polished > tried * 9 / 10);
}

// A hole whose cylinder ends exactly at the faces of the plate: the disks that were removed are not
// nearest points.
static void removed_faces_are_not_near(void **state) {
  (void)state;
  CagSolid *s = combined(CAG_DIFFERENCE, centered_box(10, 10, 2), cylinder_at(-1, 2, 2));
  assert_true(check_nearest(s, cag_vec3(0.2, 0.1, 3), 14) < 0);
  NEAR(check_nearest(s, cag_vec3(1.5, 0, 0.3), 14), 0.5, 1e-12);
  NEAR(check_nearest(s, cag_vec3(4, 0, 3), 14), 2, 1e-12);
  cag_solid_release(s);
  // The common face of two boxes is inside of their union.
  const CagTransform aside = cag_translate(cag_vec3(4, 0, 0));
  s = combined(CAG_UNION, centered_box(4, 4, 4), moved(centered_box(4, 4, 4), &aside));
  assert_true(check_nearest(s, cag_vec3(1.9, 0, 0), 9) < 0);
  NEAR(check_nearest(s, cag_vec3(1.9, 5, 0), 9), 3, 1e-12);
  cag_solid_release(s);
}

static void half_spaces_have_nearest_points(void **state) {
  (void)state;
  CagPlane plane;
  CagSolid *s;
  OK(cag_plane(cag_vec3(1, 2, 3), cag_vec3(2, -1, 2), &plane, &err));
  OK(cag_solid_half_space(&plane, &s, &err));
  NEAR(check_nearest(s, cag_vec3(3, 1, 5), 10), 3, 1e-12);
  NEAR(check_nearest(s, cag_vec3(-1, 3, 1), 10), 3, 1e-12);
  cag_solid_release(s);
}

// --- Quadrics ---

static CagQuadric random_quadric(int kind) {
  static const double signs[][4] = {{1, 1, 1, -1}, {1, 1, -1, -1}, {1, 1, -1, 1},
                                    {1, 1, -1, 0}, {1, 1, 0, -1},  {1, -1, 0, -1},
                                    {1, 1, 0, 0},  {1, -1, 0, 0},  {1, 0, 0, 0}};
  CagQuadric q = {{0}}, out;
  for (int k = 0; k < 3; k++) q.c[k] = signs[kind][k] * uniform(0.2, 2);
  q.c[9] = signs[kind][3] * uniform(0.5, 3);
  if (kind >= 6) q.c[8] = -1; // paraboloids and the parabolic cylinder
  const CagTransform t = random_affine();
  OK(cag_quadric_transform(&q, &t, &out, &err));
  return out;
}

// The residual of the equation as a distance.
static double off_quadric(const CagQuadric *q, CagVec3 p) {
  return fabs(cag_quadric_value(q, p)) / cag_norm(cag_quadric_gradient(q, p));
}

// A point of the quadric on a random line through near p: more of them are tried.
static double closest_on_lines(const CagQuadric *q, CagVec3 p, CagVec3 near, double wide) {
  double least = INFINITY;
  for (int i = 0; i < RAYS; i++) {
    const CagVec3 d = cag_add(cag_sub(near, p), random_point(wide));
    const double f0 = cag_quadric_value(q, p), f1 = cag_quadric_value(q, cag_add(p, d)),
                 f2 = cag_quadric_value(q, cag_madd(p, -1, d));
    const double a = (f1 + f2) / 2 - f0, b = (f1 - f2) / 2, root = b * b - 4 * a * f0;
    if (root < 0) continue;
    const double t = -2 * f0 / (b + copysign(sqrt(root), b)); // the smaller root
    least = fmin(least, fabs(t) * cag_norm(d));
  }
  return least;
}

static void nearest_points_of_quadrics_are_feet_of_normals(void **state) {
  (void)state;
  seed = 8;
  for (int i = 0; i < 900; i++) {
    const CagQuadric q = random_quadric(i % 9);
    const CagVec3 p = random_point(i % 5 ? 8 : 1);
    CagVec3 x;
    assert_true(cag_quadric_closest(&q, p, &x));
    const CagVec3 way = cag_sub(x, p);
    const double distance = cag_norm(way);
    assert_true(off_quadric(&q, x) <= 1e-11 * (1 + distance + cag_norm(x)));
    const CagVec3 n = cag_unit(cag_quadric_gradient(&q, x));
    // The tip of a cone has no normal.
    if (i % 9 != 3) assert_true(cag_norm(cag_cross(way, n)) <= 1e-7 * (1 + distance));
    const double other = fmin(closest_on_lines(&q, p, x, 10 * (1 + distance)),
                              closest_on_lines(&q, p, x, 0.1 * distance));
    assert_true(distance <= other * (1 + 1e-9) + 1e-12);
  }
}

// On planes and axes of symmetry the multiplier is a pole (the hard case).
static void points_on_axes_of_quadrics_have_closed_forms(void **state) {
  (void)state;
  const CagQuadric ellipsoid = {{1.0 / 16, 1.0 / 9, 1.0 / 4, 0, 0, 0, 0, 0, 0, -1}};
  CagVec3 x;
  assert_true(cag_quadric_closest(&ellipsoid, cag_vec3(0, 0, 0), &x));
  NEAR(cag_norm(x), 2, 1e-14);
  NEAR(fabs(x.z), 2, 1e-14);
  // Inside of the evolute, the end of the axis is the farthest point.
  assert_true(cag_quadric_closest(&ellipsoid, cag_vec3(1, 0, 0), &x));
  NEAR(x.x, 16.0 / 12, 1e-13);
  NEAR(fabs(x.z), 2 * sqrt(1 - 1.0 / 9), 1e-13);
  assert_true(cag_quadric_closest(&ellipsoid, cag_vec3(9, 0, 0), &x));
  near_vec(x, cag_vec3(4, 0, 0), 1e-13);
  const CagQuadric cone = {{1, 1, -1, 0, 0, 0, 0, 0, 0, 0}};
  assert_true(cag_quadric_closest(&cone, cag_vec3(0, 0, 2), &x));
  NEAR(cag_norm(cag_sub(x, cag_vec3(0, 0, 2))), sqrt(2), 1e-14);
  assert_true(cag_quadric_closest(&cone, cag_vec3(0, 0, 0), &x));
  NEAR(cag_norm(x), 0, 1e-14);
  const CagQuadric needle = {{1, 1, 1e-13, 0, 0, 0, 0, 0, 0, -1}};
  assert_true(cag_quadric_closest(&needle, cag_vec3(3, 4, 10), &x));
  near_vec(x, cag_vec3(0.6, 0.8, 10), 1e-9);
  const CagQuadric nothing = {{1, 1, 1, 0, 0, 0, 0, 0, 0, 1}};
  assert_false(cag_quadric_closest(&nothing, cag_vec3(3, 4, 10), &x));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(solids_have_nearest_points),
      cmocka_unit_test(affine_images_of_solids_have_nearest_points),
      cmocka_unit_test(symmetric_points_have_one_of_the_nearest_points),
      cmocka_unit_test(set_operations_know_whether_an_operand_decides),
      cmocka_unit_test(removed_faces_are_not_near),
      cmocka_unit_test(edges_have_closed_forms),
      cmocka_unit_test(half_spaces_have_nearest_points),
      cmocka_unit_test(nearest_points_of_quadrics_are_feet_of_normals),
      cmocka_unit_test(points_on_axes_of_quadrics_have_closed_forms),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
