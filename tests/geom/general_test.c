// General position: operands that coincide by construction, and operands slightly apart. Each pair
// is tested with every operation, at random scales and placements, also inside nested operations.

#include "geom/solid/general.h"
#include "geom/solid/tessellate.h"

#include "geom/curve/conic.h"
#include "geom/curve/region.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

static CagTransform random_turn(void) {
  double a[3];
  for (int i = 0; i < 3; i++) a[i] = uniform(-3, 3);
  return cag_rpy(a[0], a[1], a[2]);
}

// The size of all operands is that of their axis-aligned box, so it depends on the rotation.
static bool upright = false;

static CagTransform random_similarity(void) {
  CagTransform turn = upright ? cag_transform_identity() : random_turn(), scale;
  double way[3];
  const double k = pow(10, uniform(-2, 3));
  for (int i = 0; i < 3; i++) way[i] = uniform(-5, 5);
  OK(cag_scale(cag_vec3(k, k, k), cag_vec3(0, 0, 0), &scale, &err));
  const CagTransform lift = cag_translate(cag_vec3(way[0], way[1], way[2]));
  turn = cag_transform_multiply(&lift, &turn);
  return cag_transform_multiply(&scale, &turn);
}

// Takes ownership of the solid.
static CagSolid *placed(CagSolid *s, const CagTransform *t) {
  CagSolid *out;
  OK(cag_solid_transform(s, t, &out, &err));
  cag_solid_release(s);
  return out;
}

static CagSolid *moved(CagSolid *s, double x, double y, double z) {
  const CagTransform t = cag_translate(cag_vec3(x, y, z));
  return placed(s, &t);
}

static CagSolid *turned(CagSolid *s, CagVec3 axis, double angle, CagVec3 about) {
  CagTransform t;
  OK(cag_rotate(axis, angle, about, &t, &err));
  return placed(s, &t);
}

// Takes ownership of both.
static CagSolid *combined(CagSetOperation op, CagSolid *a, CagSolid *b) {
  CagSolid *out = NULL;
  OK(cag_solid_combine(op, (CagSolid *[]){a, b}, 2, NULL, &out, &err));
  cag_solid_release(a);
  cag_solid_release(b);
  return out;
}

static CagSolid *box(double x, double y, double z) {
  CagSolid *s;
  OK(cag_solid_box(cag_vec3(x, y, z), true, &s, &err));
  return s;
}

static CagSolid *sphere(double r) {
  CagSolid *s;
  OK(cag_solid_sphere(r, &s, &err));
  return s;
}

static CagSolid *cylinder(double h, double r, double top) {
  CagSolid *s;
  OK(cag_solid_cylinder(h, r, top, &s, &err));
  return s;
}

static CagSolid *torus(double major, double minor) {
  CagSolid *s;
  OK(cag_solid_torus(major, minor, &s, &err));
  return s;
}

static CagSolid *half_space(CagVec3 point, CagVec3 normal) {
  CagPlane plane;
  CagSolid *s;
  OK(cag_plane(point, normal, &plane, &err));
  OK(cag_solid_half_space(&plane, &s, &err));
  return s;
}

static CagSolid *quadric(const double c[10]) {
  CagQuadric q;
  CagSolid *s;
  memcpy(q.c, c, sizeof q.c);
  OK(cag_solid_quadric(&q, &s, &err));
  return s;
}

// An ellipse swept along a direction and twisted. Its curve begins at a random angle.
static CagSolid *twisted(double a, double b, CagVec3 along, double twist) {
  const CagTransform level = cag_transform_identity();
  CagCurve *c;
  CagRegion *r;
  CagSolid *s;
  const double start = uniform(0, 6);
  OK(cag_curve_arc(a, b, start, start + 2 * M_PI, &level, &c, &err));
  OK(cag_region_new(c, NULL, 0, &r, &err));
  OK(cag_solid_extrude(r, along, twist, 1, &s, &err));
  cag_curve_release(c);
  cag_region_release(r);
  return s;
}

static CagSolid *column(double a, double b, CagVec3 along) { return twisted(a, b, along, 0); }

static CagSolid *tetrahedron(const CagVec3 p[4]) {
  static const uint32_t faces[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  CagMesh *m;
  CagSolid *s;
  OK(cag_mesh_new(4, 4, false, false, false, &m, &err));
  memcpy(m->positions, p, 4 * sizeof *p);
  memcpy(m->triangles, faces, sizeof faces);
  OK(cag_solid_from_mesh(m, &s, &err));
  cag_mesh_release(m);
  return s;
}

// Takes ownership of the operands. Their location and size do not matter.
static void expect(CagSolid *a, CagSolid *b, bool general, const char *what) {
  static const CagSetOperation operations[] = {CAG_UNION, CAG_DIFFERENCE, CAG_INTERSECTION};
  const CagTransform together = random_similarity(), place = random_similarity(),
                     inner = random_turn();
  CagTransform back;
  const CagSetOperation op = operations[(int)uniform(0, 3)];
  if (uniform(0, 1) < 0.5) {
    CagSolid *swap = a;
    a = b;
    b = swap;
  }
  if (uniform(0, 1) < 0.3) {
    // In the coordinates of another operation.
    OK(cag_transform_inverse(&inner, &back, &err));
    b = combined(CAG_UNION, placed(b, &back), moved(sphere(0.013), 0.02, 0.01, 0));
    b = placed(b, &inner);
  }
  CagSolid *s = combined(op, placed(a, &together), placed(b, &together));
  s = placed(s, &place);
  if (cag_solid_in_general_position(s, NULL) != general)
    fail_msg("%s: expected to be %s", what, general ? "in general position" : "coincident");
  cag_solid_release(s);
}

static void lone_solids_are_in_general_position(void **state) {
  (void)state;
  CagSolid *s[5] = {box(1, 2, 3), sphere(1), torus(2, 1),
                    half_space(cag_vec3(0, 0, 1), cag_vec3(1, 0, 0)),
                    column(1, 2, cag_vec3(1, 0, 1))};
  for (int i = 0; i < 5; i++) {
    assert_true(cag_solid_in_general_position(s[i], NULL));
    cag_solid_release(s[i]);
  }
}

// The roof of a box of size 2, and a face of a second body: in its plane, slightly above, and in
// its plane but beside it.
static void flat_faces(void **state) {
  (void)state;
  seed = 71;
  for (int k = 0; k < 120; k++) {
    CagSolid *b;
    const double angle = uniform(0, 6), side = k % 2 ? 1 : -1;
    double x = uniform(-0.8, 0.8), y = uniform(-0.8, 0.8), z = 1;
    const int place = k / 2 % 3;
    if (place == 1) z += (uniform(0, 1) < 0.5 ? 1 : -1) * 2e-3;
    if (place == 2) x = 2.6;
    switch (k / 6 % 4) {
    case 0: b = moved(box(0.71, 0.93, 1.37), 0, 0, side * 1.37 / 2); break;
    case 1:
      b = side > 0 ? cylinder(0.83, 0.9, 0.4) : moved(cylinder(0.83, 0.4, 0.9), 0, 0, -0.83);
      break;
    case 2: {
      const CagVec3 p[4] = {{-0.7, -0.5, 0}, {0.9, -0.3, 0}, {0.1, 0.8, 0}, {0.1, 0.1, side * 0.7}};
      b = tetrahedron(p);
      break;
    }
    default: b = column(0.8, 0.5, cag_vec3(0.3, 0.4, side * 0.9)); break;
    }
    b = moved(turned(b, cag_vec3(0, 0, 1), angle, cag_vec3(0, 0, 0)), x, y, z);
    expect(box(2, 2, 2), b, place > 0, "flat faces");
  }
}

// Axis-parallel boxes, each with a face in a plane of the other, or slightly beside it.
static void boxes_along_the_axes(void **state) {
  (void)state;
  seed = 78;
  for (int k = 0; k < 72; k++) {
    const int axis = k % 3, order = k / 12 % 2;
    const double x = uniform(-1.5, 1.5), y = uniform(-1.5, 1.5), z = uniform(-1.5, 1.5);
    double at[3] = {x, y, z};
    at[axis] = (k / 3 % 2 ? 1 : -1) * (2 + (k / 6 % 2) * 2e-3);
    CagSolid *a = box(2, 2, 2), *b = moved(box(2, 2, 2), at[0], at[1], at[2]);
    CagSolid *s = order ? combined(CAG_UNION, b, a) : combined(CAG_UNION, a, b);
    assert_int_equal(cag_solid_in_general_position(s, NULL), k / 6 % 2);
    cag_solid_release(s);
  }
}

// The distance between two triangles of the plane z = 0 across one of their edges. It is negative
// if they overlap; its size is the shortest translation that separates them.
static double apart_by(const CagVec3 p[3], const CagVec3 q[3]) {
  double most = -INFINITY;
  for (int side = 0; side < 2; side++)
    for (int i = 0; i < 3; i++) {
      const CagVec3 *t = side ? q : p, *other = side ? p : q;
      const CagVec3 a = t[i], along = cag_unit(cag_sub(t[(i + 1) % 3], a));
      CagVec3 out = cag_vec3(along.y, -along.x, 0);
      if (cag_dot(out, cag_sub(t[(i + 2) % 3], a)) > 0) out = cag_scaled(out, -1);
      double least = INFINITY;
      for (int k = 0; k < 3; k++) least = fmin(least, cag_dot(out, cag_sub(other[k], a)));
      most = fmax(most, least);
    }
  return most;
}

// Tetrahedra on both sides of a plane, with their bases in it.
static void triangles_of_one_plane_coincide_where_they_overlap(void **state) {
  (void)state;
  seed = 76;
  int tried[2] = {0, 0};
  for (int k = 0; k < 400; k++) {
    CagVec3 p[2][4];
    double area = INFINITY;
    for (int side = 0; side < 2; side++) {
      for (int i = 0; i < 3; i++) {
        const double x = uniform(-1, 1);
        const double y = uniform(-1, 1);
        p[side][i] = cag_vec3(x + (side && k % 2 ? 0.8 : 0), y, 0);
      }
      const double x = uniform(-0.3, 0.3);
      const double y = uniform(-0.3, 0.3);
      p[side][3] = cag_vec3(x, y, side ? -1.1 : 0.9);
      const CagVec3 n = cag_cross(cag_sub(p[side][1], p[side][0]), cag_sub(p[side][2], p[side][0]));
      area = fmin(area, fabs(n.z));
      // Faces are oriented outward.
      if ((n.z < 0) != (side == 1)) {
        const CagVec3 swap = p[side][1];
        p[side][1] = p[side][2];
        p[side][2] = swap;
      }
    }
    const double gap = apart_by(p[0], p[1]);
    if (area < 0.1 || (gap > -0.02 && gap < 0.01)) continue;
    expect(tetrahedron(p[0]), tetrahedron(p[1]), gap > 0, "triangles of one plane");
    tried[gap > 0]++;
  }
  assert_true(tried[0] > 60 && tried[1] > 60);
}

// Curved faces of one surface, trimmed and rotated differently. Then one slightly larger, and both
// next to each other on the same surface.
static void curved_faces(void **state) {
  (void)state;
  seed = 72;
  for (int k = 0; k < 90; k++) {
    CagSolid *a, *b;
    const int place = k % 3;
    const double grown = place == 1 ? 1 + 4e-3 : 1, lift = place == 2 ? 1.3 : uniform(0.2, 0.6);
    const double angle = uniform(0, 6);
    const CagVec3 up = cag_vec3(0, 0, 1), o = cag_vec3(0, 0, 0);
    switch (k / 3 % 6) {
    case 0:
      a = cylinder(1, 0.8, 0.8), b = moved(cylinder(1.17, grown * 0.8, grown * 0.8), 0, 0, lift);
      break;
    case 1: // r = 2 - z / 2
      a = cylinder(1, 2, 1.5);
      b = moved(cylinder(1.2, grown * (2 - lift / 2), grown * (2 - lift / 2 - 0.6)), 0, 0, lift);
      break;
    case 2:
      if (place == 2) continue;
      a = sphere(1), b = turned(sphere(grown), cag_vec3(1, 2, 3), angle, o);
      break;
    case 3:
      if (place == 2) continue;
      a = torus(2, 0.5), b = torus(2, grown * 0.5);
      break;
    case 4:
      a = column(1, 0.6, cag_vec3(0.7, -0.4, 1));
      b = moved(column(grown, grown * 0.6, cag_vec3(0.7 * 1.1, -0.4 * 1.1, 1.1)), 0.7 * lift,
                -0.4 * lift, lift);
      break;
    default: // oblique parameter lines
      a = twisted(1, 0.4, up, 1.5);
      b = twisted(grown, grown * 0.4, cag_vec3(0, 0, 1.17), 1.5 * 1.17);
      b = turned(moved(b, 0, 0, lift), up, 1.5 * lift, o);
    }
    if (k / 3 % 6 < 4) b = turned(b, up, angle, o);
    expect(a, b, place > 0, "curved faces");
  }
}

// Only a tetrahedron on a random triangle of a fine mesh coincides with the mesh.
static void single_triangles_of_fine_meshes(void **state) {
  (void)state;
  seed = 73;
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagSolid *ball = sphere(1), *body;
  CagMesh *m, *other;
  how.tolerance = 2e-2;
  OK(cag_solid_tessellate(ball, &how, &m, &err));
  how.tolerance = 5e-2;
  OK(cag_solid_tessellate(ball, &how, &other, &err));
  assert_true(m->triangle_count > 200);
  OK(cag_solid_from_mesh(m, &body, &err));
  for (int k = 0; k < 60; k++) {
    const uint32_t *t = m->triangles + 3 * (size_t)uniform(0, (double)m->triangle_count);
    CagVec3 p[4];
    const double out = k % 2 ? 1 + 2e-3 : 1;
    for (int i = 0; i < 3; i++) p[i] = cag_scaled(m->positions[t[i]], out);
    const CagVec3 middle = cag_scaled(cag_add(p[0], cag_add(p[1], p[2])), 1.0 / 3);
    p[3] = cag_scaled(middle, 1.2);
    // A smaller triangle.
    for (int i = 0; i < 3; i++) p[i] = cag_lerp(p[i], middle, 0.3);
    if (cag_norm(cag_cross(cag_sub(p[1], p[0]), cag_sub(p[2], p[0]))) < 1e-4) continue;
    CagSolid *b = tetrahedron(p);
    if (k % 4 > 1) {
      // A second fine mesh, which touches neither.
      CagSolid *far;
      OK(cag_solid_from_mesh(other, &far, &err));
      b = combined(CAG_UNION, b, moved(far, 0.3, 0.2, 0.1));
    }
    expect(cag_solid_retain(body), b, k % 2 == 1, "one triangle");
  }
  // Two fine meshes with one common triangle: a mesh, and its reflection in the plane of one of its
  // triangles. Also with a small gap.
  for (int k = 0; k < 16; k++) {
    const uint32_t *t = m->triangles + 3 * (size_t)uniform(0, (double)m->triangle_count);
    const CagVec3 a = m->positions[t[0]], u = cag_sub(m->positions[t[1]], a),
                  v = cag_sub(m->positions[t[2]], a);
    if (cag_norm(cag_cross(u, v)) < 1e-3) continue;
    const CagVec3 n = cag_unit(cag_cross(u, v));
    CagTransform mirror = cag_transform_identity();
    const double nn[3] = {n.x, n.y, n.z}, shift = 2 * cag_dot(a, n) + (k % 2 ? 2e-3 : 0);
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 3; j++) mirror.m[i][j] -= 2 * nn[i] * nn[j];
      mirror.m[i][3] = shift * nn[i];
    }
    mirror.planar = false;
    expect(cag_solid_retain(body), placed(cag_solid_retain(body), &mirror), k % 2 == 1,
           "mirror image");
  }
  cag_mesh_release(m);
  cag_mesh_release(other);
  cag_solid_release(body);
  cag_solid_release(ball);
}

// The limits: faces closer than 1e-4 of the total size, at an angle below 1e-3, whose overlap is
// larger than 1e-9 of the squared size.
static void limits_of_coincidence(void **state) {
  (void)state;
  seed = 74;
  upright = true;
  for (int k = 0; k < 28; k++) {
    const bool general = k % 2;
    const CagVec3 o = cag_vec3(0, 0, 0), up = cag_vec3(0, 0, 1);
    const double factor = general ? 1.25 : 0.8;
    // The distance: concentric spheres of known radius and size.
    double size = 2 * sqrt(3), gap = factor * 1e-4 * size;
    expect(sphere(1), sphere(1 - gap), general, "distance of spheres");
    // Boxes that together span 2 by 2 by 4.
    size = sqrt(24), gap = factor * 1e-4 * size;
    CagSolid *b = turned(moved(box(1, 1, 2), 0, 0, 2 + gap), up, uniform(0, 6), o);
    // The angle: two equal tetrahedra, the second of which is rotated about an edge parallel
    // through the center of a face.
    const CagVec3 p[4] = {{-1, -1, 0}, {2, -1, 0}, {-1, 2, 0}, {0.1, 0.2, 1}};
    const CagVec3 q[4] = {{-1, -1, 0}, {2, -1, 0}, {-1, 2, 0}, {0.2, 0.1, -1}};
    expect(box(2, 2, 2), b, general, "distance of boxes");
    const double way = uniform(0, 6), tilt = factor * 1e-3;
    expect(tetrahedron(p), turned(tetrahedron(q), cag_vec3(cos(way), sin(way), 0), tilt, o),
           general, "angle");
    // The center of the face is on the plane of the half space.
    const double lean = asin(factor * 1e-3);
    const CagVec3 normal = cag_vec3(sin(lean) * cos(way), sin(lean) * sin(way), cos(lean));
    expect(tetrahedron(p), half_space(o, normal), general, "angle of a half space");
    size = sqrt(9 + 9 + 1);
    gap = factor * 1e-4 * size * (k % 4 < 2 ? 1 : -1);
    expect(tetrahedron(p), half_space(cag_vec3(0, 0, gap), up), general,
           "distance of a half space");
    // The area: boxes on a common plane that overlap in a strip as long as both.
    const double width = (general ? 0.8 : 1.25) * 1e-9 * (2 * 2 + 1 + 2 * 2);
    expect(box(1, 1, 1), moved(box(1, 1, 1), 1 - width, 0, 1), general, "area");
  }
  upright = false;
}

static void sides_of_forms(void **state) {
  (void)state;
  seed = 75;
  for (int k = 0; k < 40; k++) {
    const bool general = k % 2;
    double c[10], d[10];
    const double sense = k % 4 < 2 ? 1 : -1, scale = uniform(0.1, 5);
    for (int i = 0; i < 10; i++) c[i] = uniform(-1, 1);
    for (int i = 0; i < 10; i++) d[i] = sense * scale * c[i];
    const int which = k / 2 % 10;
    if (general) d[which] += sense * scale * (c[which] > 0 ? 0.1 : -0.1);
    // A ball in the middle determines the size.
    CagSolid *a = combined(CAG_INTERSECTION, sphere(0.5), quadric(c));
    expect(a, quadric(d), general, "two quadrics");
    // A quadric and its faces.
    const double r = uniform(0.5, 2), to = general ? 1.004 * r : r;
    const double ball[10] = {sense, sense, sense, 0, 0, 0, 0, 0, 0, -sense * to * to};
    const double tube[10] = {sense * scale,           sense * scale, 0, 0, 0, 0, 0, 0, 0,
                             -sense * scale * to * to};
    expect(sphere(r), quadric(ball), general, "a ball and its form");
    expect(moved(cylinder(2, r, r), 0, 0, -1), quadric(tube), general, "a cylinder and its form");
    // The same plane twice.
    const CagVec3 n = cag_unit(cag_vec3(c[0], c[1], c[2])), p = cag_scaled(n, c[3]);
    a = combined(CAG_INTERSECTION, sphere(2), half_space(p, n));
    const CagVec3 at = general ? cag_madd(p, 0.01, n) : p;
    expect(a, half_space(at, cag_scaled(n, sense)), general, "two half spaces");
  }
}

static void an_interrupt_ends_the_search(void **state) {
  (void)state;
  static const volatile int stop = 1, go = 0;
  CagSolid *s = combined(CAG_UNION, box(1, 1, 1), moved(sphere(1), 0.3, 0.4, 0.2));
  assert_true(cag_solid_in_general_position(s, &go));
  assert_false(cag_solid_in_general_position(s, &stop));
  cag_solid_release(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lone_solids_are_in_general_position),
      cmocka_unit_test(flat_faces),
      cmocka_unit_test(boxes_along_the_axes),
      cmocka_unit_test(triangles_of_one_plane_coincide_where_they_overlap),
      cmocka_unit_test(curved_faces),
      cmocka_unit_test(single_triangles_of_fine_meshes),
      cmocka_unit_test(limits_of_coincidence),
      cmocka_unit_test(sides_of_forms),
      cmocka_unit_test(an_interrupt_ends_the_search),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
