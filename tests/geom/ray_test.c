// Rays: crossings of closed shapes alternate, lie on the surface and on the ray, and are those of
// the formulas; none slips through an edge, a corner, or a seam.

#include <stdlib.h>

#include "base/memory.h"
#include "geom/mesh/distance.h"
#include "geom/mesh/hull.h"
#include "geom/ray/caster.h"
#include "geom/ray/ray_mesh.h"
#include "geom/solid/csg.h"
#include "geom/solid/tessellate.h"
#include "tests/geom/random.h"
#include "tests/geom/surface_support.h"

static double signed_random(void) { return 2 * uniform(0, 1) - 1; }

static CagVec3 random_in_cube(double side) {
  return cag_vec3(side * signed_random(), side * signed_random(), side * signed_random());
}

static CagRay ray_to(CagVec3 from, CagVec3 to) {
  return (CagRay){from, cag_unit(cag_sub(to, from)), -INFINITY, INFINITY};
}

static CagCaster *caster_of(const CagSolid *s) {
  CagCaster *c = NULL;
  MUST(cag_caster_of_solid(s, &c, err));
  return c;
}

// Random lines through the solid: the signs of their crossings alternate, their normals agree with
// the signs, and between two of them the middle is inside or outside as they say.
static void assert_solid_crossings(const char *name, const CagSolid *s, int lines) {
  CagCaster *c = caster_of(s);
  const CagBounds b = cag_caster_bounds(c);
  const CagVec3 middle = cag_lerp(b.min, b.max, 0.5);
  const double radius = cag_norm(cag_sub(b.max, b.min)) / 2;
  CagCrossings list = {0}, work = {0};
  for (int k = 0; k < lines; k++) {
    const CagRay ray = ray_to(cag_add(middle, random_in_cube(radius)),
                              cag_add(middle, random_in_cube(0.6 * radius)));
    bool inside;
    MUST(cag_caster_all(c, &ray, &list, &inside, err));
    if (inside || list.n % 2) fail_msg("%s: %zu crossings", name, list.n);
    for (size_t i = 0; i < list.n; i++) {
      const CagCrossing *x = &list.items[i];
      if (x->sign != (i % 2 ? 1 : -1)) fail_msg("%s: crossing %zu has sign %d", name, i, x->sign);
      const double slope = cag_dot(x->normal, ray.direction);
      assert_near(cag_norm(x->normal), 1, 1e-9, "normal");
      if ((slope > 0) != (x->sign > 0)) fail_msg("%s: a normal is on the other side", name);
      int side;
      if (i + 1 == list.n || list.items[i + 1].t - x->t < 1e-6 * radius) continue;
      const double t = (x->t + list.items[i + 1].t) / 2;
      MUST(cag_caster_side(c, cag_ray_point(&ray, t), 0, &work, &side, err));
      // The common face of bodies that touch counts as a boundary.
      if (side == (i % 2 ? -1 : 1)) fail_msg("%s: the middle is on side %d", name, side);
    }
  }
  cag_crossings_free(&list);
  cag_crossings_free(&work);
  cag_caster_free(c);
}

static CagRegion *flower(bool hole) {
  CagVec3 p[12];
  CagCurve *outer = NULL, *inner = NULL;
  CagRegion *r = NULL;
  const CagTransform plane = cag_transform_identity();
  for (int i = 0; i < 12; i++) {
    const double a = 2 * M_PI * i / 12, radius = 10 + 3 * sin(3 * a);
    p[i] = cag_vec3(radius * cos(a), radius * sin(a), 0);
  }
  MUST(cag_curve_nurbs_closed(p, NULL, 12, 3, 2, &outer, err));
  MUST(cag_curve_arc(3, 3, 0, 2 * M_PI, &plane, &inner, err));
  MUST(cag_region_new(outer, &inner, hole, &r, err));
  cag_curve_release(outer);
  cag_curve_release(inner);
  return r;
}

static void crossings_of_primitives_alternate(void **state) {
  (void)state;
  CagSolid *s[7], *moved;
  CagTransform shear = cag_shear(0.3, -0.4, 0.2, 0, 0.1, 0);
  shear.m[2][2] = 2;
  shear.m[0][3] = 5;
  MUST(cag_solid_box(cag_vec3(1, 2, 3), false, &s[0], err));
  MUST(cag_solid_sphere(2, &s[1], err));
  MUST(cag_solid_cylinder(4, 1, 1, &s[2], err));
  MUST(cag_solid_cylinder(4, 1, 0.3, &s[3], err));
  MUST(cag_solid_cylinder(4, 1, 0, &s[4], err));
  MUST(cag_solid_cylinder(4, 0, 2, &s[5], err));
  MUST(cag_solid_torus(3, 1, &s[6], err));
  for (int i = 0; i < 7; i++) {
    assert_solid_crossings(cag_solid_kind_name(s[i]->kind), s[i], 2000);
    MUST(cag_solid_transform(s[i], &shear, &moved, err));
    assert_solid_crossings("sheared", moved, 2000);
    cag_solid_release(moved);
    cag_solid_release(s[i]);
  }
}

static void crossings_of_swept_solids_alternate(void **state) {
  (void)state;
  CagRegion *r = flower(true), *beside = NULL;
  CagTransform shift = cag_translate(cag_vec3(20, 0, 0));
  CagSolid *s = NULL;
  shift.planar = true;
  MUST(cag_solid_extrude(r, cag_vec3(0, 0, 20), 0, 1, &s, err));
  assert_solid_crossings("extrusion", s, 500);
  cag_solid_release(s);
  MUST(cag_solid_extrude(r, cag_vec3(0, 0, 20), 1.5, 0.5, &s, err));
  assert_solid_crossings("twisted extrusion", s, 500);
  cag_solid_release(s);
  MUST(cag_region_transform(r, &shift, &beside, err));
  MUST(cag_solid_revolve(beside, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0, 2, &s, err));
  assert_solid_crossings("revolution", s, 500);
  cag_solid_release(s);
  cag_region_release(beside);
  cag_region_release(r);
}

// The distance from the origin of a point of a sphere is its radius, and so on: equations that the
// crossings must fulfill.
static double torus_off(CagVec3 p) { return hypot(hypot(p.x, p.y) - 3, p.z) - 1; }
static double sphere_off(CagVec3 p) { return cag_norm(p) - 2; }
static double cone_off(CagVec3 p) {
  const double side = (hypot(p.x, p.y) - 1 + p.z / 4) / hypot(1, 0.25);
  return fmax(side, fmax(-p.z, p.z - 4));
}

static void assert_equation(CagSolid *s, double (*off)(CagVec3), double size) {
  CagCaster *c = caster_of(s);
  CagCrossings list = {0};
  for (int k = 0; k < 2000; k++) {
    const CagRay ray = ray_to(random_in_cube(3 * size), random_in_cube(size));
    MUST(cag_caster_all(c, &ray, &list, NULL, err));
    for (size_t i = 0; i < list.n; i++)
      assert_near(off(cag_ray_point(&ray, list.items[i].t)), 0, 1e-11 * size, "equation");
  }
  cag_crossings_free(&list);
  cag_caster_free(c);
  cag_solid_release(s);
}

static void crossings_fulfill_the_equations(void **state) {
  (void)state;
  CagSolid *s;
  MUST(cag_solid_torus(3, 1, &s, err));
  assert_equation(s, torus_off, 4);
  MUST(cag_solid_sphere(2, &s, err));
  assert_equation(s, sphere_off, 2);
  MUST(cag_solid_cylinder(4, 1, 0, &s, err));
  assert_equation(s, cone_off, 4);
}

// A crossing of a patch is the surface's point at its parameters, and on the ray.
static void crossings_of_surfaces_are_their_points(void **state) {
  (void)state;
  CagVec3 net[16];
  const double knots[] = {0, 0, 0, 0, 1, 1, 1, 1};
  CagSurface *s = NULL;
  CagCaster *c = NULL;
  CagCrossings list = {0};
  for (int i = 0; i < 16; i++)
    net[i] = cag_vec3(i / 4, i % 4, i == 5 || i == 10 ? 2 : i == 6 ? -1.5 : 0);
  MUST(cag_surface_nurbs(net, NULL, 4, 4, 3, 3, knots, knots, &s, err));
  MUST(cag_caster_of_surface(s, &c, err));
  size_t met = 0;
  for (int k = 0; k < 3000; k++) {
    const CagVec3 middle = cag_vec3(1.5, 1.5, 0);
    const CagRay ray =
        ray_to(cag_add(middle, random_in_cube(5)), cag_add(middle, random_in_cube(1.4)));
    MUST(cag_caster_all(c, &ray, &list, NULL, err));
    met += list.n;
    for (size_t i = 0; i < list.n; i++)
      assert_point(surface_at(s, list.items[i].u, list.items[i].v),
                   cag_ray_point(&ray, list.items[i].t), 1e-10, "point");
  }
  if (met < 1000) fail_msg("only %zu crossings", met);
  cag_crossings_free(&list);
  cag_caster_free(c);
  cag_surface_release(s);
}

// Every point of the surface is met by the ray that aims at it.
static void rays_meet_the_points_that_they_aim_at(void **state) {
  (void)state;
  CagRegion *r = flower(false);
  CagSolid *s = NULL;
  MUST(cag_solid_extrude(r, cag_vec3(0, 0, 20), 1.5, 0.5, &s, err));
  CagCaster *c = caster_of(s);
  CagCrossings list = {0};
  for (size_t f = 0; f < s->face_count; f++) {
    const CagSurface *face = s->faces[f];
    if (cag_surface_planar_view(face, NULL, NULL)) continue;
    for (int k = 0; k < 30000; k++) {
      // Parameters on the seam, on the borders, and anywhere.
      const double u = k % 3 == 0 ? face->u0 : face->u0 + (face->u1 - face->u0) * uniform(0, 1);
      const double v = k % 3 == 1 ? face->v0 : face->v0 + (face->v1 - face->v0) * uniform(0, 1);
      const CagVec3 at = surface_at(face, u, v);
      const CagRay ray = ray_to(random_in_cube(40), at);
      bool found = false;
      MUST(cag_caster_all(c, &ray, &list, NULL, err));
      if (list.n % 2) fail_msg("%zu crossings at u %g, v %g", list.n, u, v);
      for (size_t i = 0; i < list.n; i++)
        found = found || cag_norm(cag_sub(cag_ray_point(&ray, list.items[i].t), at)) < 1e-6;
      CagVec3 normal;
      MUST(cag_surface_normal(face, u, v, &normal, err));
      // On a border, and where it is tangent, the ray may graze the solid.
      if (!found && k % 3 != 1 && fabs(cag_dot(normal, ray.direction)) > 1e-4)
        fail_msg("the point at u %g, v %g is not met", u, v);
    }
  }
  cag_crossings_free(&list);
  cag_caster_free(c);
  cag_solid_release(s);
  cag_region_release(r);
}

// Set operations: a point is in the result as the rule says of its operands, on rays through
// operands that touch and coincide.
static void set_operations_combine_intervals(void **state) {
  (void)state;
  CagSolid *box, *ball, *beside, *operands[2], *s;
  const CagTransform shift = cag_translate(cag_vec3(4, 0, 0));
  MUST(cag_solid_box(cag_vec3(4, 4, 4), true, &box, err));
  MUST(cag_solid_sphere(2.5, &ball, err));
  MUST(cag_solid_transform(box, &shift, &beside, err));
  for (int op = CAG_UNION; op <= CAG_INTERSECTION; op++)
    for (int which = 0; which < 2; which++) {
      operands[0] = box;
      operands[1] = which ? beside : ball;
      MUST(cag_solid_combine((CagSetOperation)op, operands, 2, NULL, &s, err));
      if (which == 0 || op != CAG_INTERSECTION) assert_solid_crossings("operation", s, 2000);
      cag_solid_release(s);
    }
  // Boxes side by side are one: nothing is crossed between them.
  operands[1] = beside;
  MUST(cag_solid_combine(CAG_UNION, operands, 2, NULL, &s, err));
  CagCaster *c = caster_of(s);
  CagCrossings list = {0};
  const CagRay along = {{-10, 0.3, 0.7}, {1, 0, 0}, 0, INFINITY};
  MUST(cag_caster_all(c, &along, &list, NULL, err));
  assert_int_equal(list.n, 2);
  assert_near(list.items[0].t, 8, 1e-12, "enters");
  assert_near(list.items[1].t, 16, 1e-12, "leaves");
  cag_crossings_free(&list);
  cag_caster_free(c);
  cag_solid_release(s);
  cag_solid_release(box);
  cag_solid_release(ball);
  cag_solid_release(beside);
}

// A closed mesh of random points, and rays that aim exactly at its corners, the middles of its
// edges, and along its edges.
static void no_ray_slips_through_a_closed_mesh(void **state) {
  (void)state;
  CagVec3 points[400];
  CagMesh *hull = NULL;
  CagRayMesh *m = NULL;
  CagCrossings list = {0};
  for (int i = 0; i < 400; i++) points[i] = cag_unit(random_in_cube(1));
  // Halves and quarters: many corners are on lines with others.
  for (int i = 0; i < 200; i++)
    points[i] = cag_vec3(round(4 * points[i].x) / 4, round(4 * points[i].y) / 4,
                         round(4 * points[i].z) / 4);
  MUST(cag_hull_space(points, 400, &hull, err));
  MUST(cag_ray_mesh_new(hull, &m, err));
  for (int k = 0; k < 20000; k++) {
    const uint32_t *t =
        hull->triangles + 3 * (size_t)(uniform(0, 1) * (double)hull->triangle_count);
    const CagVec3 a = hull->positions[t[0]], b = hull->positions[t[1]];
    const CagVec3 other = hull->positions[(size_t)(uniform(0, 1) * (double)hull->vertex_count)];
    const CagVec3 from = k % 3 == 0 ? other : k % 3 == 1 ? a : random_in_cube(3);
    const CagVec3 to = k % 2 ? cag_lerp(a, b, 0.5) : b;
    if (cag_norm(cag_sub(from, to)) == 0) continue;
    const CagRay ray = ray_to(from, to);
    int sum = 0;
    list.n = 0;
    MUST(cag_ray_mesh_all(m, &ray, &list, err));
    for (size_t i = 0; i < list.n; i++) sum += list.items[i].sign;
    if (sum || list.n % 2) fail_msg("%zu crossings, the sum of the signs is %d", list.n, sum);
  }
  cag_crossings_free(&list);
  cag_ray_mesh_free(m);
  cag_mesh_release(hull);
}

// The nearest point of all triangles, one by one.
static double nearest_of_all(const CagMesh *m, CagVec3 p) {
  double least = INFINITY;
  for (size_t i = 0; i < m->triangle_count; i++) {
    const uint32_t *t = m->triangles + 3 * i;
    least = fmin(least, cag_distance_to_triangle(p, m->positions[t[0]], m->positions[t[1]],
                                                 m->positions[t[2]]));
  }
  return least;
}

static void closest_points_of_meshes_are_the_closest(void **state) {
  (void)state;
  CagSolid *torus;
  CagMesh *mesh = NULL;
  CagRayMesh *m = NULL;
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  how.tolerance = 0.05;
  MUST(cag_solid_torus(3, 1, &torus, err));
  MUST(cag_solid_tessellate(torus, &how, &mesh, err));
  MUST(cag_ray_mesh_new(mesh, &m, err));
  for (int k = 0; k < 500; k++) {
    const CagVec3 p = random_in_cube(k % 2 ? 5 : 50);
    CagVec3 at;
    uint32_t face;
    assert_true(cag_ray_mesh_closest(m, p, INFINITY, &at, &face));
    const double expected = nearest_of_all(mesh, p);
    assert_near(cag_norm(cag_sub(at, p)), expected, 1e-12 * (1 + expected), "distance");
    assert_false(cag_ray_mesh_closest(m, p, 0.99 * expected, &at, &face));
  }
  cag_ray_mesh_free(m);
  cag_mesh_release(mesh);
  cag_solid_release(torus);
}

// Far from the origin, and from a start far away.
static void distances_are_exact_far_away(void **state) {
  (void)state;
  CagSolid *ball, *moved;
  const CagTransform shift = cag_translate(cag_vec3(20000, -30000, 10000));
  MUST(cag_solid_sphere(2, &ball, err));
  MUST(cag_solid_transform(ball, &shift, &moved, err));
  CagCaster *c = caster_of(moved);
  CagCrossings work = {0};
  CagCrossing x;
  bool met;
  const CagRay ray = {{20000, -30000, 1010000}, {0, 0, -1}, 0, INFINITY};
  MUST(cag_caster_first(c, &ray, &work, &x, &met, err));
  assert_true(met);
  assert_near(x.t, 1e6 - 2, 1e-9, "distance");
  cag_crossings_free(&work);
  cag_caster_free(c);
  cag_solid_release(moved);
  cag_solid_release(ball);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(crossings_of_primitives_alternate),
      cmocka_unit_test(crossings_of_swept_solids_alternate),
      cmocka_unit_test(crossings_fulfill_the_equations),
      cmocka_unit_test(crossings_of_surfaces_are_their_points),
      cmocka_unit_test(rays_meet_the_points_that_they_aim_at),
      cmocka_unit_test(set_operations_combine_intervals),
      cmocka_unit_test(no_ray_slips_through_a_closed_mesh),
      cmocka_unit_test(closest_points_of_meshes_are_the_closest),
      cmocka_unit_test(distances_are_exact_far_away),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
