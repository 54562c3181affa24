// Set operations of meshes: closed forms, identities between volumes, and winding numbers of random
// points. Many small operands on an integer grid cover the degenerate cases.

#include "geom/boolean/boolean.h"

#include <stdio.h>

#include "geom/linalg/transform.h"
#include "geom/mesh/check.h"
#include "geom/mesh/exact.h"
#include "tests/geom/support.h"

#define PI 3.14159265358979323846

// --- Bodies ---

static CagMesh *mesh_of(const CagVec3 *v, size_t n, const uint32_t *faces, const uint32_t *counts,
                        size_t face_count) {
  CagMesh *m;
  OK(cag_mesh_from_faces(v, n, faces, counts, face_count, &m, &err));
  return m;
}

static CagMesh *box(CagVec3 a, CagVec3 b) {
  static const uint32_t faces[24] = {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4,
                                     1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
  static const uint32_t fours[6] = {4, 4, 4, 4, 4, 4};
  const CagVec3 v[8] = {{a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z},
                        {a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}};
  return mesh_of(v, 8, faces, fours, 6);
}

static CagMesh *cube(double x, double y, double z, double size) {
  return box(cag_vec3(x, y, z), cag_vec3(x + size, y + size, z + size));
}

static double turned(const CagVec3 v[4]) {
  return cag_dot(cag_sub(v[1], v[0]), cag_cross(cag_sub(v[2], v[0]), cag_sub(v[3], v[0])));
}

static CagMesh *tetrahedron(const CagVec3 corners[4]) {
  static const uint32_t out[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
  static const uint32_t in[12] = {0, 1, 2, 0, 3, 1, 1, 3, 2, 0, 2, 3};
  static const uint32_t threes[4] = {3, 3, 3, 3};
  return mesh_of(corners, 4, turned(corners) > 0 ? out : in, threes, 4);
}

// Rings of n points from pole to pole, optionally with normals.
static CagMesh *ball(CagVec3 center, double radius, uint32_t n, bool normals) {
  CagMesh *m;
  const uint32_t rings = n / 2, south = n * (rings - 1);
  OK(cag_mesh_new(south + 2, 2 * n * (rings - 1), normals, false, false, &m, &err));
  for (uint32_t i = 0; i < south + 2; i++) {
    const double polar = i < south ? PI * (1 + i / n) / rings : i == south ? 0 : PI;
    const double turn = 2 * PI * (i % n) / n;
    const CagVec3 d = cag_vec3(sin(polar) * cos(turn), sin(polar) * sin(turn), cos(polar));
    m->positions[i] = i < south
                          ? cag_madd(center, radius, d)
                          : cag_madd(center, i == south ? radius : -radius, cag_vec3(0, 0, 1));
    if (normals) m->normals[i] = i < south ? d : cag_vec3(0, 0, i == south ? 1 : -1);
  }
  uint32_t *t = m->triangles;
  for (uint32_t k = 0; k < n; k++) {
    const uint32_t next = (k + 1) % n, last = n * (rings - 2);
    const uint32_t caps[6] = {south, k, next, south + 1, last + next, last + k};
    memcpy(t, caps, sizeof caps);
    t += 6;
    for (uint32_t r = 0; r + 2 < rings; r++) {
      const uint32_t a = r * n + k, b = r * n + next, quad[6] = {a, a + n, b + n, a, b + n, b};
      memcpy(t, quad, sizeof quad);
      t += 6;
    }
  }
  return m;
}

// A prism about the Z axis with a regular polygon of n corners.
static CagMesh *prism(uint32_t n, double radius, double low, double high) {
  CagVec3 *v = malloc(2 * n * sizeof *v);
  uint32_t *faces = malloc(6 * n * sizeof *faces), *counts = malloc((n + 2) * sizeof *counts);
  for (uint32_t i = 0; i < n; i++) {
    const double a = 2 * PI * i / n;
    v[i] = cag_vec3(radius * cos(a), radius * sin(a), low);
    v[n + i] = cag_vec3(v[i].x, v[i].y, high);
    const uint32_t next = (i + 1) % n, side[4] = {i, next, n + next, n + i};
    memcpy(faces + 4 * i, side, sizeof side);
    counts[i] = 4;
    faces[4 * n + i] = n - 1 - i;
    faces[5 * n + i] = n + i;
  }
  counts[n] = counts[n + 1] = n;
  CagMesh *m = mesh_of(v, 2 * n, faces, counts, n + 2);
  free(v);
  free(faces);
  free(counts);
  return m;
}

static CagMesh *moved(CagMesh *m, const CagTransform *t) {
  CagMesh *out;
  OK(cag_mesh_transform(m, t, &out, &err));
  cag_mesh_release(m);
  return out;
}

static CagMesh *rotated(CagMesh *m, CagVec3 axis, double angle) {
  CagTransform t;
  OK(cag_rotate(axis, angle, cag_vec3(0, 0, 0), &t, &err));
  return moved(m, &t);
}

// Both meshes as one. Releases the operands.
static CagMesh *together(CagMesh *a, CagMesh *b) {
  CagMesh *const parts[2] = {a, b};
  CagMesh *m;
  OK(cag_mesh_append(parts, 2, &m, &err));
  cag_mesh_release(a);
  cag_mesh_release(b);
  return m;
}

// --- Measures ---

static double volume(const CagMesh *m) {
  long double sum = 0;
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    const CagVec3 tip = m->positions[m->triangles[0]], a = cag_sub(m->positions[k[0]], tip);
    sum +=
        cag_dot(a, cag_cross(cag_sub(m->positions[k[1]], tip), cag_sub(m->positions[k[2]], tip)));
  }
  return (double)(sum / 6);
}

static void assert_sound(const CagMesh *m) {
  CagVec3 edge[2];
  if (m->triangle_count > 0) assert_true(cag_mesh_is_watertight(m, edge));
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    assert_true(k[0] != k[1] && k[1] != k[2] && k[2] != k[0]);
    for (int i = 0; i < 3; i++) assert_true(k[i] < m->vertex_count);
  }
  for (size_t i = 0; i < m->vertex_count; i++) {
    assert_true(isfinite(m->positions[i].x + m->positions[i].y + m->positions[i].z));
    if (m->weld) assert_true(m->weld[i] <= i && m->weld[m->weld[i]] == m->weld[i]);
    if (m->normals) NEAR(cag_norm(m->normals[i]), 1, 1e-12);
  }
}

static CagMesh *operated(CagSetOperation op, const CagMesh *a, const CagMesh *b) {
  CagMesh *m;
  OK(cag_mesh_boolean(op, a, b, NULL, &m, &err));
  assert_sound(m);
  return m;
}

static double operated_volume(CagSetOperation op, const CagMesh *a, const CagMesh *b) {
  CagMesh *m = operated(op, a, b);
  const double v = volume(m);
  cag_mesh_release(m);
  return v;
}

// The winding number of a mesh around a point, from the solid angles of its triangles (van Oosterom
// and Strackee 1983). It is independent of the code under test.
static double winding(const CagMesh *m, CagVec3 p) {
  double sum = 0;
  for (size_t t = 0; t < m->triangle_count; t++) {
    CagVec3 v[3];
    double r[3];
    for (int k = 0; k < 3; k++) {
      v[k] = cag_sub(m->positions[m->triangles[3 * t + (size_t)k]], p);
      r[k] = cag_norm(v[k]);
    }
    const double down = r[0] * r[1] * r[2] + cag_dot(v[0], v[1]) * r[2] +
                        cag_dot(v[1], v[2]) * r[0] + cag_dot(v[2], v[0]) * r[1];
    sum += 2 * atan2(cag_dot(v[0], cag_cross(v[1], v[2])), down);
  }
  return sum / (4 * PI);
}

static uint64_t seed;
static double random_number(void) {
  seed = seed * 6364136223846793005u + 1442695040888963407u;
  return (double)(seed >> 11) / 9007199254740992.0;
}
static int random_int(int n) { return (int)(random_number() * n); }
static CagVec3 random_point(double size) {
  const double x = random_number(), y = random_number();
  return cag_vec3(size * x, size * y, size * random_number());
}

static void assert_same_inside(CagSetOperation op, const CagMesh *a, const CagMesh *b,
                               const CagMesh *m, double size, int points) {
  for (int i = 0; i < points; i++) {
    const CagVec3 p = cag_sub(random_point(size + 1.5), cag_vec3(0.713, 0.717, 0.719));
    const bool in_a = winding(a, p) > 0.5, in_b = winding(b, p) > 0.5;
    const bool expected = op == CAG_UNION        ? in_a || in_b
                          : op == CAG_DIFFERENCE ? in_a && !in_b
                                                 : in_a && in_b;
    const double w = winding(m, p);
    if (fabs(w - expected) > 1e-6)
      fail_msg("[%g %g %g]: winds %g times, not %d", p.x, p.y, p.z, w, expected);
  }
}

// Checks all three operations on a pair: V(A|B) + V(A&B) = V(A) + V(B), V(A-B) + V(A&B) = V(A), and
// (A-B) | (A&B) is A again.
static void check_pair(const CagMesh *a, const CagMesh *b, double size, int points) {
  CagMesh *m[3], *again;
  double v[3];
  const double tolerance = 1e-12 * (volume(a) + volume(b) + size * size * size);
  for (int op = 0; op < 3; op++) {
    m[op] = operated((CagSetOperation)op, a, b);
    v[op] = volume(m[op]);
    assert_same_inside((CagSetOperation)op, a, b, m[op], size, points);
  }
  NEAR(v[CAG_UNION] + v[CAG_INTERSECTION], volume(a) + volume(b), tolerance);
  NEAR(v[CAG_DIFFERENCE] + v[CAG_INTERSECTION], volume(a), tolerance);
  again = operated(CAG_UNION, m[CAG_DIFFERENCE], m[CAG_INTERSECTION]);
  NEAR(volume(again), volume(a), tolerance);
  cag_mesh_release(again);
  for (int op = 0; op < 3; op++) cag_mesh_release(m[op]);
}

// --- Boxes ---

// Checks the volumes and the Euler characteristic of each result; an empty result has no triangles.
static void check_boxes(CagMesh *a, CagMesh *b, const double volumes[3], const long euler[3]) {
  for (int op = 0; op < 3; op++) {
    CagMesh *m = operated((CagSetOperation)op, a, b);
    NEAR(volume(m), volumes[op], 1e-12);
    assert_int_equal(cag_mesh_euler_characteristic(m), euler[op]);
    if (volumes[op] == 0) assert_int_equal(m->triangle_count, 0);
    cag_mesh_release(m);
  }
  cag_mesh_release(a);
  cag_mesh_release(b);
}

static void boxes_in_every_position(void **state) {
  (void)state;
  // overlapping corners
  check_boxes(cube(0, 0, 0, 2), cube(1, 1, 1, 2), (double[]){15, 7, 1}, (long[]){2, 2, 2});
  // one passes through the other: a tunnel leaves a ring
  check_boxes(cube(0, 0, 0, 3), box(cag_vec3(1, 1, -1), cag_vec3(2, 2, 4)), (double[]){29, 24, 3},
              (long[]){2, 0, 2});
  // apart
  check_boxes(cube(0, 0, 0, 1), cube(5, 0, 0, 1), (double[]){2, 1, 0}, (long[]){4, 2, 0});
  // one inside the other: a cavity
  check_boxes(cube(0, 0, 0, 3), cube(1, 1, 1, 1), (double[]){27, 26, 1}, (long[]){2, 4, 2});
  check_boxes(cube(1, 1, 1, 1), cube(0, 0, 0, 3), (double[]){27, 0, 1}, (long[]){2, 0, 2});
}

static void boxes_that_touch(void **state) {
  (void)state;
  // identical
  check_boxes(cube(0, 0, 0, 1), cube(0, 0, 0, 1), (double[]){1, 0, 1}, (long[]){2, 0, 2});
  // a common face, entirely or partly
  check_boxes(cube(0, 0, 0, 1), cube(1, 0, 0, 1), (double[]){2, 1, 0}, (long[]){2, 2, 0});
  check_boxes(cube(0, 0, 0, 3), box(cag_vec3(3, 1, 1), cag_vec3(4, 2, 2)), (double[]){28, 27, 0},
              (long[]){2, 2, 0});
  check_boxes(cube(0, 0, 0, 2), cube(2, 1, 1, 2), (double[]){16, 8, 0}, (long[]){2, 2, 0});
  // flush from inside: a pocket that reaches one face, a slot through two, a half
  check_boxes(cube(0, 0, 0, 3), box(cag_vec3(1, 1, 1), cag_vec3(2, 2, 3)), (double[]){27, 25, 2},
              (long[]){2, 2, 2});
  check_boxes(cube(0, 0, 0, 3), box(cag_vec3(1, 0, 1), cag_vec3(2, 3, 3)), (double[]){27, 21, 6},
              (long[]){2, 2, 2});
  check_boxes(cube(0, 0, 0, 2), box(cag_vec3(0, 0, 0), cag_vec3(1, 2, 2)), (double[]){8, 4, 4},
              (long[]){2, 2, 2});
  // a common edge, and a common corner: two bodies with separate vertices
  check_boxes(cube(0, 0, 0, 1), cube(1, 1, 0, 1), (double[]){2, 1, 0}, (long[]){4, 2, 0});
  check_boxes(cube(0, 0, 0, 1), cube(1, 1, 1, 1), (double[]){2, 1, 0}, (long[]){4, 2, 0});
  // the difference is two bars with a common edge
  check_boxes(box(cag_vec3(0, 0, 0), cag_vec3(2, 2, 1)),
              together(box(cag_vec3(0, 0, 0), cag_vec3(1, 1, 1)),
                       box(cag_vec3(1, 1, 0), cag_vec3(2, 2, 1))),
              (double[]){4, 2, 2}, (long[]){2, 4, 4});
}

static void solids_of_several_parts_and_cavities(void **state) {
  (void)state;
  // A shell, whose inner box is inside out. A rod through it loses the part inside the cavity.
  CagMesh *inner = cube(1, 1, 1, 3), *inside_out, *shell;
  OK(cag_mesh_flip(inner, &inside_out, &err));
  cag_mesh_release(inner);
  shell = together(cube(0, 0, 0, 5), inside_out);
  CagMesh *rod = box(cag_vec3(2, 2, -1), cag_vec3(3, 3, 6));
  NEAR(operated_volume(CAG_UNION, shell, rod), 98 + 3 + 2, 1e-12);
  NEAR(operated_volume(CAG_DIFFERENCE, shell, rod), 98 - 2, 1e-12);
  NEAR(operated_volume(CAG_INTERSECTION, shell, rod), 2, 1e-12);
  NEAR(operated_volume(CAG_DIFFERENCE, rod, shell), 5, 1e-12);
  // A plug that exactly fills the cavity.
  CagMesh *plug = cube(1, 1, 1, 3);
  CagMesh *full = operated(CAG_UNION, shell, plug);
  NEAR(volume(full), 125, 1e-12);
  assert_int_equal(cag_mesh_euler_characteristic(full), 2);
  cag_mesh_release(full);
  cag_mesh_release(shell);
  cag_mesh_release(plug);
  // Parts that overlap each other count once.
  CagMesh *double_bar = together(cube(0, 0, 0, 2), cube(1, 0, 0, 2));
  NEAR(operated_volume(CAG_DIFFERENCE, double_bar, rod), 12, 1e-12);
  CagMesh *empty, *one[1] = {double_bar};
  OK(cag_mesh_new(0, 0, false, false, false, &empty, &err));
  NEAR(operated_volume(CAG_UNION, double_bar, empty), 12, 1e-12);
  NEAR(operated_volume(CAG_INTERSECTION, double_bar, empty), 0, 0);
  NEAR(operated_volume(CAG_DIFFERENCE, empty, double_bar), 0, 0);
  CagMesh *m;
  OK(cag_mesh_boolean_many(CAG_UNION, (const CagMesh *const *)one, 1, NULL, &m, &err));
  NEAR(volume(m), 12, 1e-12);
  cag_mesh_release(m);
  cag_mesh_release(empty);
  cag_mesh_release(rod);
  cag_mesh_release(double_bar);
}

static void cubes_turned_by_next_to_nothing(void **state) {
  (void)state;
  const double angles[] = {1e-1, 1e-6, 1e-9, 1e-12, 1e-15, 1e-16};
  for (int i = 0; i < 6; i++)
    for (int scale = 0; scale < 2; scale++) {
      const double size = scale ? 1e6 : 1;
      CagMesh *a = cube(-size / 2, -size / 2, -size / 2, size);
      CagMesh *b =
          rotated(cube(-size / 2, -size / 2, -size / 2, size), cag_vec3(1, 2, 3), angles[i]);
      check_pair(a, b, size, 3);
      cag_mesh_release(a);
      cag_mesh_release(b);
    }
}

// Nearly all triangles are cut, and most points coincide after rounding.
static void balls_turned_by_next_to_nothing(void **state) {
  (void)state;
  const double angles[] = {1e-9, 1e-15, 3e-16};
  for (int i = 0; i < 3; i++) {
    CagMesh *a = ball(cag_vec3(0, 0, 0), 1, 24, true);
    CagMesh *b = rotated(ball(cag_vec3(0, 0, 0), 1, 24, true), cag_vec3(1, 2, 3), angles[i]);
    check_pair(a, b, 1, 2);
    cag_mesh_release(a);
    cag_mesh_release(b);
  }
}

static void a_box_far_from_the_origin(void **state) {
  (void)state;
  CagMesh *a = cube(1e6, -1e6, 1e6, 1), *b = cube(1e6 + 0.3, -1e6 + 0.3, 1e6 + 0.3, 1);
  const double side = 1e6 + 1 - (1e6 + 0.3), deep = -1e6 + 1 - (-1e6 + 0.3);
  NEAR(operated_volume(CAG_INTERSECTION, a, b), side * side * deep, 1e-15);
  NEAR(operated_volume(CAG_DIFFERENCE, a, b), 1 - side * side * deep, 1e-9);
  cag_mesh_release(a);
  cag_mesh_release(b);
}

static void boxes_of_any_size(void **state) {
  (void)state;
  static const double sizes[] = {1e-40, 1e-15, 1e15, 1e40};
  for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
    const double s = sizes[k], cubed = s * s * s;
    CagMesh *a = cube(0, 0, 0, 2 * s), *b = cube(s, s, s, 2 * s);
    NEAR(operated_volume(CAG_UNION, a, b) / cubed, 15, 1e-13);
    NEAR(operated_volume(CAG_DIFFERENCE, a, b) / cubed, 7, 1e-13);
    NEAR(operated_volume(CAG_INTERSECTION, a, b) / cubed, 1, 1e-13);
    cag_mesh_release(a);
    cag_mesh_release(b);
  }
}

// --- Round bodies ---

static void a_drilled_box(void **state) {
  (void)state;
  const uint32_t n = 64;
  const double area = n / 2.0 * 0.25 * sin(2 * PI / n); // of the polygon with radius 0.5
  for (int flush = 0; flush < 2; flush++) {
    CagMesh *a = box(cag_vec3(-1, -1, 0), cag_vec3(1, 1, 1)), *m;
    CagMesh *b = prism(n, 0.5, flush ? 0 : -1, flush ? 1 : 2);
    m = operated(CAG_DIFFERENCE, a, b);
    NEAR(volume(m), 4 - area, 1e-14);
    assert_int_equal(cag_mesh_euler_characteristic(m), 0);
    cag_mesh_release(m);
    NEAR(operated_volume(CAG_INTERSECTION, a, b), area, 1e-14);
    NEAR(operated_volume(CAG_UNION, a, b), flush ? 4 : 4 + 2 * area, 1e-13);
    cag_mesh_release(a);
    cag_mesh_release(b);
  }
}

// Two unit spheres at distance 1: the lens has the volume 5 pi / 12.
static void the_lens_of_two_spheres(void **state) {
  (void)state;
  CagMesh *a = ball(cag_vec3(0, 0, 0), 1, 128, true),
          *b = ball(cag_vec3(0.8, 0.6, 0), 1, 128, true);
  CagMesh *lens = operated(CAG_INTERSECTION, a, b), *all = operated(CAG_UNION, a, b);
  NEAR(volume(lens), 5 * PI / 12, 3e-3);
  NEAR(volume(lens) + volume(all), volume(a) + volume(b), 1e-13);
  assert_int_equal(cag_mesh_euler_characteristic(lens), 2);
  CagMeshCheck c;
  OK(cag_mesh_check(lens, &c, &err));
  assert_true(c.closed && c.oriented && c.shells == 1);
  // Normals are those of the spheres, reversed on b's part of a difference.
  CagMesh *bitten = operated(CAG_DIFFERENCE, a, b);
  size_t turned_normals = 0;
  for (size_t i = 0; i < bitten->vertex_count; i++) {
    const CagVec3 p = bitten->positions[i], n = bitten->normals[i];
    const CagVec3 q = cag_sub(cag_vec3(0.8, 0.6, 0), p);
    const bool on_a = cag_norm(p) > 0.9985 && cag_dot(cag_unit(p), n) > 1 - 1e-3;
    const bool on_b = cag_norm(q) > 0.9985 && cag_dot(cag_unit(q), n) > 1 - 1e-3;
    assert_true(on_a || on_b);
    turned_normals += !on_a;
  }
  assert_true(turned_normals > 500);
  // A point on the edge has a vertex for each sphere, but it is one point of the closed mesh.
  size_t twice = 0;
  for (size_t i = 0; i < bitten->vertex_count; i++) twice += bitten->weld[i] != i;
  assert_true(twice > 100 && twice < 1000);
  cag_mesh_release(lens);
  cag_mesh_release(all);
  cag_mesh_release(bitten);
  cag_mesh_release(a);
  cag_mesh_release(b);
}

static void balls_in_general_and_special_positions(void **state) {
  (void)state;
  seed = 7;
  for (int i = 0; i < 12; i++) {
    CagMesh *a = ball(cag_vec3(0, 0, 0), 1, 24, i % 2);
    CagMesh *b = i == 0   ? ball(cag_vec3(0, 0, 0), 1, 24, false)  // identical
                 : i == 1 ? ball(cag_vec3(0, 0, 1), 1, 24, true)   // poles on poles
                 : i == 2 ? ball(cag_vec3(0, 0, 2), 1, 24, true)   // touching at a point
                 : i == 3 ? ball(cag_vec3(0, 0, 0), 0.5, 24, true) // one inside the other
                          : ball(random_point(1), 1, 16 + 2 * (uint32_t)i, i % 3);
    if (i > 7) b = rotated(b, random_point(1), 1e-8);
    check_pair(a, b, 1, 2);
    cag_mesh_release(a);
    cag_mesh_release(b);
  }
}

// --- An integer grid ---

static CagVec3 grid_point(int n) {
  const int x = random_int(n + 1), y = random_int(n + 1);
  return cag_vec3(x, y, random_int(n + 1));
}

static CagMesh *grid_box(int n) {
  int low[3], high[3];
  for (int k = 0; k < 3; k++) {
    low[k] = random_int(n);
    high[k] = low[k] + 1 + random_int(n - low[k]);
  }
  return box(cag_vec3(low[0], low[1], low[2]), cag_vec3(high[0], high[1], high[2]));
}

static CagMesh *grid_body(int n) {
  const int kind = random_int(3);
  if (kind == 0) return grid_box(n);
  if (kind == 1) { // a sheared prism, often with faces along the diagonals
    const CagVec3 up = grid_point(2), a = grid_point(n - 2), b = grid_point(n - 2);
    const CagVec3 c = grid_point(n - 2);
    static const uint32_t faces[18] = {0, 2, 1, 3, 4, 5, 0, 1, 4, 3, 1, 2, 5, 4, 2, 0, 3, 5};
    static const uint32_t counts[5] = {3, 3, 4, 4, 4};
    const CagVec3 v[6] = {a, b, c, cag_add(a, up), cag_add(b, up), cag_add(c, up)};
    const double size = cag_dot(up, cag_cross(cag_sub(b, a), cag_sub(c, a)));
    if (size > 0) return mesh_of(v, 6, faces, counts, 5);
  }
  for (;;) {
    CagVec3 v[4];
    for (int k = 0; k < 4; k++) v[k] = grid_point(n);
    if (turned(v) != 0) return tetrahedron(v);
  }
}

static void bodies_on_a_grid(void **state) {
  (void)state;
  seed = 20;
  for (int i = 0; i < 150; i++) {
    const int n = 2 + i % 4 + (i % 4 == 0);
    CagMesh *a = grid_body(n), *b = grid_body(n);
    check_pair(a, b, n, 6);
    cag_mesh_release(a);
    cag_mesh_release(b);
  }
}

// The corners of the pieces are rounded thirds. Snapping moves them off the cutting plane by less
// than a double can represent. A ray in this plane must pass an edge on the correct side.
static void pieces_of_a_tetrahedron_join_again(void **state) {
  (void)state;
  const CagVec3 v[4] = {{3, 3, 0}, {2, 3, 3}, {1, 1, 2}, {3, 2, 2}};
  CagMesh *a = tetrahedron(v), *b = box(cag_vec3(1, 0, 2), cag_vec3(2, 2, 3));
  CagMesh *less = operated(CAG_DIFFERENCE, a, b), *common = operated(CAG_INTERSECTION, a, b);
  for (int k = 0; k < 2; k++) {
    CagMesh *again = operated(CAG_UNION, k ? common : less, k ? less : common);
    NEAR(volume(again), 4.0 / 3, 1e-14);
    cag_mesh_release(again);
  }
  cag_mesh_release(less);
  cag_mesh_release(common);
  cag_mesh_release(a);
  cag_mesh_release(b);
}

// Operands that are results: parts that touch along edges and at points, and subdivided faces.
static void chains_on_a_grid(void **state) {
  (void)state;
  seed = 4;
  for (int i = 0; i < 20; i++) {
    CagMesh *a = grid_body(4);
    for (int k = 0; k < 8; k++) {
      CagMesh *b = i % 2 ? grid_body(4) : grid_box(4);
      if (k % 4 == 3) check_pair(a, b, 4, 4);
      CagMesh *m = operated(random_int(3) == 0 ? CAG_DIFFERENCE : CAG_UNION, a, b);
      cag_mesh_release(a);
      cag_mesh_release(b);
      a = m;
    }
    cag_mesh_release(a);
  }
}

// Bodies of boxes on the grid, whose volume is a count of cells.
static void cells_of_boxes_are_counted(void **state) {
  (void)state;
  enum { N = 4 };
  seed = 99;
  for (int i = 0; i < 25; i++) {
    bool cell[N][N][N] = {{{false}}};
    CagMesh *all;
    OK(cag_mesh_new(0, 0, false, false, false, &all, &err));
    for (int k = 0; k < 7; k++) {
      CagMesh *b = grid_box(N);
      const CagBounds r = cag_mesh_bounds(b);
      const bool add = k < 3 || random_int(2);
      CagMesh *m = operated(add ? CAG_UNION : CAG_DIFFERENCE, all, b);
      cag_mesh_release(all);
      cag_mesh_release(b);
      all = m;
      int count = 0;
      for (int c = 0; c < N * N * N; c++) {
        const int x = c % N, y = c / N % N, z = c / (N * N);
        if (x >= r.min.x && x < r.max.x && y >= r.min.y && y < r.max.y && z >= r.min.z &&
            z < r.max.z)
          cell[x][y][z] = add;
        count += cell[x][y][z];
      }
      NEAR(volume(all), count, 1e-12);
    }
    cag_mesh_release(all);
  }
}

// --- Many operands ---

static void many_operands(void **state) {
  (void)state;
  enum { N = 3, ALL = N * N * N };
  const CagMesh *cubes[ALL + 1];
  for (int i = 0; i < ALL; i++) cubes[i + 1] = cube(i % N, i / N % N, i / (N * N), 1);
  cubes[0] = cube(-1, -1, -1, N + 2);
  CagMesh *m;
  OK(cag_mesh_boolean_many(CAG_UNION, cubes + 1, ALL, NULL, &m, &err));
  assert_sound(m);
  NEAR(volume(m), ALL, 1e-12);
  assert_int_equal(cag_mesh_euler_characteristic(m), 2);
  cag_mesh_release(m);
  OK(cag_mesh_boolean_many(CAG_DIFFERENCE, cubes, ALL + 1, NULL, &m, &err));
  NEAR(volume(m), 125 - ALL, 1e-12);
  assert_int_equal(cag_mesh_euler_characteristic(m), 4);
  cag_mesh_release(m);
  OK(cag_mesh_boolean_many(CAG_INTERSECTION, cubes, 2, NULL, &m, &err));
  NEAR(volume(m), 1, 1e-15);
  cag_mesh_release(m);
  OK(cag_mesh_boolean_many(CAG_INTERSECTION, cubes, 3, NULL, &m, &err));
  assert_int_equal(m->triangle_count, 0);
  cag_mesh_release(m);
  for (int i = 0; i <= ALL; i++) cag_mesh_release((CagMesh *)cubes[i]);
}

// --- Triangles without area ---

static void triangles_without_area_are_no_gap(void **state) {
  (void)state;
  // A tetrahedron with an additional point on an edge. Only one of the two faces at this edge has
  // the point; a triangle without area between them closes the mesh.
  const CagVec3 v[5] = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1, 0, 0}};
  const uint32_t faces[18] = {0, 2, 4, 4, 2, 1, 0, 4, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
  CagMesh *a;
  OK(cag_mesh_new(5, 6, false, false, false, &a, &err));
  memcpy(a->positions, v, sizeof v);
  memcpy(a->triangles, faces, sizeof faces);
  CagMesh *b = cube(0.5, 0.25, 0.25, 3);
  check_pair(a, b, 3, 10);
  cag_mesh_release(a);
  cag_mesh_release(b);
}

// --- Errors ---

static void operands_that_bound_nothing(void **state) {
  (void)state;
  CagMesh *a = cube(0, 0, 0, 1), *b = cube(0, 0, 0, 1), *m;
  b->triangle_count--;
  FAILS_AMONG(cag_mesh_boolean(CAG_UNION, a, b, NULL, &m, &err), "mesh-open", 0, 10);
  assert_string_equal(err.argument, "b");
  assert_non_null(strstr(err.message, "the edge from ["));
  const CagMesh *list[3] = {a, a, b};
  FAILS_AT(cag_mesh_boolean_many(CAG_DIFFERENCE, list, 3, NULL, &m, &err), "mesh-open", 2);
  assert_string_equal(err.argument, "meshes");
  assert_int_equal(err.index, 2);
  b->triangle_count++;
  b->positions[3].x = NAN;
  FAILS_AT(cag_mesh_boolean(CAG_UNION, b, a, NULL, &m, &err), "vertex-out-of-range", 3);
  assert_string_equal(err.argument, "a");
  b->positions[3].x = 1e300;
  FAILS_AT(cag_mesh_boolean(CAG_UNION, a, b, NULL, &m, &err), "vertex-out-of-range", 3);
  cag_mesh_release(b);
  OK(cag_mesh_flip(a, &b, &err));
  FAILS(cag_mesh_boolean(CAG_UNION, a, b, NULL, &m, &err), "mesh-inside-out");
  const volatile int stop = 1;
  assert_int_equal(cag_mesh_boolean(CAG_UNION, a, a, &stop, &m, &err), CAG_E_CALLBACK);
  cag_mesh_release(a);
  cag_mesh_release(b);
}

// Counts how often the mesh has the edge from p to q.
static int runs(const CagMesh *m, CagVec3 p, CagVec3 q, long *triangle) {
  int count = 0;
  for (size_t t = 0; t < m->triangle_count; t++)
    for (size_t k = 0; k < 3; k++) {
      const CagVec3 a = m->positions[m->triangles[3 * t + k]];
      const CagVec3 b = m->positions[m->triangles[3 * t + (k + 1) % 3]];
      if (cag_norm(cag_sub(a, p)) > 0 || cag_norm(cag_sub(b, q)) > 0) continue;
      count++;
      if (triangle) *triangle = (long)t;
    }
  return count;
}

// Messages name an edge and how often it occurs, and the reported triangle has it.
static void messages_of_open_operands_are_true(void **state) {
  (void)state;
  CagMesh *a = cube(0, 0, 0, 9), *m;
  for (int i = 0; i < 12; i++)
    for (int twice = 0; twice < 2; twice++) {
      CagMesh *b = cube(1, 2, 3, 4);
      uint32_t *t = b->triangles + 3 * i;
      if (twice)
        memcpy(t, b->triangles + 3 * ((i + 5) % 12), 3 * sizeof *t); // an additional one instead
      else memcpy(t, b->triangles + 3 * --b->triangle_count, 3 * sizeof *t);
      FAILS_AMONG(cag_mesh_boolean(CAG_UNION, a, b, NULL, &m, &err), "mesh-open", 0, 11);
      CagVec3 p, q;
      int ahead, back;
      const char *at = strstr(err.message, "the edge from");
      assert_non_null(at);
      assert_int_equal(
          sscanf(at,
                 "the edge from [%lg, %lg, %lg] to [%lg, %lg, %lg] is traversed %d times "
                 "forward and %d times backward",
                 &p.x, &p.y, &p.z, &q.x, &q.y, &q.z, &ahead, &back),
          8);
      long first = -1, second = -1;
      assert_int_equal(ahead, runs(b, p, q, &first));
      assert_int_equal(back, runs(b, q, p, &second));
      assert_int_not_equal(ahead, back);
      const uint32_t *k = b->triangles + 3 * err.index;
      int ends = 0;
      for (int j = 0; j < 3; j++)
        ends += cag_norm(cag_sub(b->positions[k[j]], p)) == 0 ||
                cag_norm(cag_sub(b->positions[k[j]], q)) == 0;
      assert_int_equal(ends, 2);
      cag_mesh_release(b);
    }
  cag_mesh_release(a);
}

static void coordinates_have_limits(void **state) {
  (void)state;
  CagMesh *m, *a = cube(0, 0, 0, 1), *b = cube(0, 0, 0, 1e100);
  NEAR(operated_volume(CAG_UNION, b, b) / 1e300, 1, 1e-14);
  cag_mesh_release(b);
  for (int k = 0; k < 6; k++) {
    b = cube(0, 0, 0, 1);
    double *p = k % 3 == 0   ? &b->positions[5].x
                : k % 3 == 1 ? &b->positions[5].y
                             : &b->positions[5].z;
    *p = k < 3 ? 1.000001e100 : -1.000001e100;
    FAILS_AT(cag_mesh_boolean(CAG_UNION, a, b, NULL, &m, &err), "vertex-out-of-range", 5);
    assert_non_null(strstr(err.message, "vertex 5 of `b`"));
    const CagMesh *list[2] = {a, b};
    FAILS_AT(cag_mesh_boolean_many(CAG_UNION, list, 2, NULL, &m, &err), "vertex-out-of-range", 1);
    assert_non_null(strstr(err.message, "vertex 5 of `meshes[1]`"));
    cag_mesh_release(b);
  }
  cag_mesh_release(a);
}

// An operand thinner than rounding may be inside out, but no other. The limit, 1e-11 of the largest
// coordinate times the area, is at a thickness of 1e-10 here.
static void thin_operands_may_be_turned(void **state) {
  (void)state;
  for (int k = 0; k < 4; k++) {
    static const double thickness[] = {1e-12, 5e-11, 2e-10, 2};
    CagMesh *m, *plate, *turned_plate, *other = cube(-20, -20, -20, 7);
    plate = box(cag_vec3(5, 6, 7), cag_vec3(8, 10, 7 + thickness[k]));
    OK(cag_mesh_flip(plate, &turned_plate, &err));
    if (k < 2) {
      OK(cag_mesh_boolean(CAG_UNION, other, turned_plate, NULL, &m, &err));
      NEAR(volume(m), 343, 1e-8);
      cag_mesh_release(m);
    } else {
      FAILS(cag_mesh_boolean(CAG_UNION, other, turned_plate, NULL, &m, &err), "mesh-inside-out");
      double told;
      assert_int_equal(sscanf(strstr(err.message, "its volume"), "its volume is %lg", &told), 1);
      NEAR(told, -12 * (7 + thickness[k] - 7), 1e-4 * 12 * thickness[k]);
    }
    cag_mesh_release(plate);
    cag_mesh_release(turned_plate);
    cag_mesh_release(other);
  }
}

// Whichever operand of a list is open is named, and no memory is lost.
static void an_open_operand_among_many_is_named(void **state) {
  (void)state;
  CagMesh *list[6], *m;
  for (int i = 0; i < 6; i++) list[i] = cube(0.7 * i, 0, 0, 1);
  for (size_t n = 1; n <= 6; n++)
    for (size_t bad = 0; bad < n; bad++)
      for (int op = 0; op < 3; op++) {
        list[bad]->triangle_count--;
        FAILS_AT(cag_mesh_boolean_many((CagSetOperation)op, (const CagMesh *const *)list, n, NULL,
                                       &m, &err),
                 "mesh-open", (long)bad);
        assert_string_equal(err.argument, "meshes");
        list[bad]->triangle_count++;
      }
  // Boxes in a row: the union, the part that only the first has, and the part common to all.
  for (size_t n = 0; n <= 6; n++)
    for (int op = 0; op < 3; op++) {
      const double length = (double)n, all = n ? 1 + 0.7 * (length - 1) : 0;
      const double expected[3] = {all, n > 1 ? 0.7 : length,
                                  n == 0 ? 0 : fmax(0, 1 - 0.7 * (length - 1))};
      OK(cag_mesh_boolean_many((CagSetOperation)op, (const CagMesh *const *)list, n, NULL, &m,
                               &err));
      assert_sound(m);
      if (n == 0) assert_int_equal(m->triangle_count, 0);
      else NEAR(m->triangle_count ? volume(m) : 0, expected[op], 1e-12);
      cag_mesh_release(m);
    }
  for (int i = 0; i < 6; i++) cag_mesh_release(list[i]);
}

// --- Exact numbers ---

static void exact_numbers(void **state) {
  (void)state;
  uint64_t limbs[4096];
  CagExactSpace s = {limbs, 0, 4096, false};
  // (1 + 2^-52)(1 - 2^-52) - 1 = -2^-104, which doubles cannot represent
  const CagExact one = cag_exact(&s, 1);
  const CagExact p = cag_exact_product(&s, cag_exact(&s, 1 + 0x1p-52), cag_exact(&s, 1 - 0x1p-52));
  const CagExact d = cag_exact_difference(&s, p, one);
  assert_int_equal(d.sign, -1);
  assert_int_equal(cag_exact_sum(&s, d, cag_exact(&s, 0x1p-104)).sign, 0);
  assert_int_equal(cag_exact_sum(&s, cag_exact(&s, 1e300), cag_exact(&s, -1e-300)).sign, 1);
  // Quotients are rounded like those of doubles, except for ties.
  seed = 3;
  for (int i = 0; i < 2000; i++) {
    s.used = 0;
    const double x = (random_number() - 0.5) * pow(10, random_int(40) - 20);
    const double w = (random_number() + 1e-3) * pow(10, random_int(40) - 20);
    assert_true(cag_exact_quotient(&s, cag_exact(&s, x), cag_exact(&s, w)) == x / w);
  }
  // A tie: 1 + 2^-53 is halfway between two doubles.
  const CagExact tie = cag_exact_sum(&s, cag_exact(&s, 1), cag_exact(&s, 0x1p-53));
  assert_true(cag_exact_quotient(&s, tie, cag_exact(&s, 1)) == 1);
  const CagExact above = cag_exact_sum(&s, tie, cag_exact(&s, 0x1p-200));
  assert_true(cag_exact_quotient(&s, above, cag_exact(&s, 1)) == 1 + 0x1p-52);
  assert_false(s.full);
}

// A polygon with n corners and h holes needs n + 2 h - 2 triangles.
static void flat_faces_have_few_triangles(void **state) {
  (void)state;
  CagMesh *m, *a = cube(0, 0, 0, 2), *b = cube(2, 0, 0, 2), *c = cube(1, 1, 1, 2);
  m = operated(CAG_UNION, a, b); // flush: a box
  assert_int_equal(m->triangle_count, 12);
  assert_int_equal(m->vertex_count, 8);
  NEAR(volume(m), 16, 1e-14);
  cag_mesh_release(m);
  m = operated(CAG_DIFFERENCE, a, c); // three squares, three L-shapes, three squares of the notch
  assert_int_equal(m->triangle_count, 3 * 2 + 3 * 4 + 3 * 2);
  NEAR(volume(m), 7, 1e-14);
  cag_mesh_release(m);
  const CagMesh *const both[2] = {a, b};
  OK(cag_mesh_boolean_many(CAG_UNION, both, 2, &(CagBooleanHow){.keep_flat = true}, &m, &err));
  assert_true(m->triangle_count > 12);
  cag_mesh_release(m);
  cag_mesh_release(a);
  cag_mesh_release(b);
  cag_mesh_release(c);
  // A drilled plate. The walls of its hole remain quads, regardless of how the cut crossed them.
  const uint32_t n = 40;
  a = cube(-2, -2, -2, 4);
  b = prism(n, 1, -3, 3);
  m = operated(CAG_DIFFERENCE, a, b);
  assert_int_equal(m->triangle_count, 4 * 2 + 2 * (n + 4) + 2 * n);
  NEAR(volume(m), 64 - 4 * n / 2.0 * sin(2 * PI / n), 1e-12);
  cag_mesh_release(m);
  cag_mesh_release(a);
  cag_mesh_release(b);
}

// Caps of 2,000 long triangles from one corner, one on the other and slightly rotated. Their edges
// would cross two million times.
static void fans_on_each_other(void **state) {
  (void)state;
  const uint32_t n = 2000;
  CagMesh *a = prism(n, 1, 0, 1), *b = rotated(prism(n, 1, 0, 1), cag_vec3(0, 0, 1), 1e-4);
  for (int k = 0; k < 2; k++) { // fans on both caps
    CagMesh *m = k ? b : a;
    for (uint32_t i = 1; i + 1 < n; i++) {
      const uint32_t at = 3 * (uint32_t)(m->triangle_count - 2 * (n - 2)) + 6 * (i - 1);
      const uint32_t fans[6] = {0, i + 1, i, n, n + i, n + i + 1};
      memcpy(m->triangles + at, fans, sizeof fans);
    }
  }
  CagMesh *m = operated(CAG_INTERSECTION, a, b);
  // The corners alternate: the outlines form a 4,000-gon.
  assert_int_equal(m->triangle_count, 2 * (2 * n - 2) + 2 * 2 * n);
  const double turn = 1e-4, step = 2 * PI / n, in = cos(step / 2);
  const double area = n / 2.0 * in * in * 2 * (tan(turn / 2) + tan((step - turn) / 2));
  NEAR(volume(m), area, 1e-11);
  cag_mesh_release(m);
  cag_mesh_release(a);
  cag_mesh_release(b);
}

// Each face keeps the label of its operand. Faces with different labels are not merged.
static void labels_stay_with_their_faces(void **state) {
  (void)state;
  CagMesh *m, *part[2] = {cube(0, 0, 0, 2), cube(2, 0, 0, 2)};
  for (uint32_t k = 0; k < 2; k++) {
    part[k]->labels = malloc(part[k]->triangle_count * sizeof(uint32_t));
    for (size_t t = 0; t < part[k]->triangle_count; t++) part[k]->labels[t] = 5 + k;
  }
  m = operated(CAG_UNION, part[0], part[1]);
  double area[2] = {0, 0};
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    const CagVec3 o = m->positions[k[0]];
    assert_true(m->labels[t] == 5 || m->labels[t] == 6);
    area[m->labels[t] - 5] +=
        cag_norm(cag_cross(cag_sub(m->positions[k[1]], o), cag_sub(m->positions[k[2]], o))) / 2;
  }
  for (int k = 0; k < 2; k++) NEAR(area[k], 5 * 4, 1e-13);
  cag_mesh_release(m);
  for (int k = 0; k < 2; k++) cag_mesh_release(part[k]);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(flat_faces_have_few_triangles),
      cmocka_unit_test(fans_on_each_other),
      cmocka_unit_test(labels_stay_with_their_faces),
      cmocka_unit_test(exact_numbers),
      cmocka_unit_test(boxes_in_every_position),
      cmocka_unit_test(boxes_that_touch),
      cmocka_unit_test(solids_of_several_parts_and_cavities),
      cmocka_unit_test(cubes_turned_by_next_to_nothing),
      cmocka_unit_test(balls_turned_by_next_to_nothing),
      cmocka_unit_test(a_box_far_from_the_origin),
      cmocka_unit_test(boxes_of_any_size),
      cmocka_unit_test(a_drilled_box),
      cmocka_unit_test(the_lens_of_two_spheres),
      cmocka_unit_test(balls_in_general_and_special_positions),
      cmocka_unit_test(bodies_on_a_grid),
      cmocka_unit_test(pieces_of_a_tetrahedron_join_again),
      cmocka_unit_test(chains_on_a_grid),
      cmocka_unit_test(cells_of_boxes_are_counted),
      cmocka_unit_test(many_operands),
      cmocka_unit_test(triangles_without_area_are_no_gap),
      cmocka_unit_test(operands_that_bound_nothing),
      cmocka_unit_test(messages_of_open_operands_are_true),
      cmocka_unit_test(coordinates_have_limits),
      cmocka_unit_test(thin_operands_may_be_turned),
      cmocka_unit_test(an_open_operand_among_many_is_named),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
