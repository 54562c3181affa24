// Meshes: checks, measures, and operations, compared with bodies of known values.

#include "geom/mesh/mesh.h"

#include "geom/tessellate/split.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

// A cube of side 2 about the origin, as six quadrilaterals seen counter-clockwise from outside.
static const CagVec3 cube_vertices[8] = {{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1},
                                         {-1, -1, 1},  {1, -1, 1},  {-1, 1, 1},  {1, 1, 1}};
static const uint32_t cube_faces[24] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4,
                                        2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
static const uint32_t fours[6] = {4, 4, 4, 4, 4, 4};

static CagMesh *cube(void) {
  CagMesh *m;
  OK(cag_mesh_from_faces(cube_vertices, 8, cube_faces, fours, 6, &m, &err));
  return m;
}

static void a_cube_is_watertight_and_has_its_measures(void **state) {
  (void)state;
  CagMesh *m = cube();
  CagVec3 edge[2];
  assert_int_equal(m->triangle_count, 12);
  assert_true(cag_mesh_is_watertight(m, edge));
  assert_int_equal(cag_mesh_euler_characteristic(m), 2);
  NEAR(cag_mesh_area(m), 24, 1e-14);
  double terms[10];
  cag_mesh_volume_terms(m, terms);
  NEAR(terms[0], 8, 1e-14);
  for (int k = 1; k < 4; k++) NEAR(terms[k], 0, 1e-14);
  // The integral of x^2 over the cube is 2 * 2 * 2/3.
  for (int k = 4; k < 7; k++) NEAR(terms[k], 8.0 / 3, 1e-14);
  for (int k = 7; k < 10; k++) NEAR(terms[k], 0, 1e-14);
  CagBounds b = cag_mesh_bounds(m);
  near_vec(b.min, cag_vec3(-1, -1, -1), 0);
  near_vec(b.max, cag_vec3(1, 1, 1), 0);
  cag_mesh_release(m);
}

static void a_missing_or_turned_face_is_found(void **state) {
  (void)state;
  CagMesh *m;
  CagVec3 edge[2];
  OK(cag_mesh_from_faces(cube_vertices, 8, cube_faces, fours, 5, &m, &err));
  assert_false(cag_mesh_is_watertight(m, edge));
  NEAR(edge[0].x, 1, 0); // the face x = 1 is missing
  NEAR(edge[1].x, 1, 0);
  assert_int_equal(cag_mesh_euler_characteristic(m), 1);
  cag_mesh_release(m);
  uint32_t turned[24];
  memcpy(turned, cube_faces, sizeof turned);
  turned[1] = 1, turned[3] = 2;
  OK(cag_mesh_from_faces(cube_vertices, 8, turned, fours, 6, &m, &err));
  assert_false(cag_mesh_is_watertight(m, edge));
  cag_mesh_release(m);
}

static void a_mirror_keeps_the_outside_outside(void **state) {
  (void)state;
  CagMesh *m = cube(), *image, *flipped;
  CagTransform mirror = cag_transform_identity();
  mirror.m[0][0] = -3;
  OK(cag_mesh_transform(m, &mirror, &image, &err));
  double terms[10];
  cag_mesh_volume_terms(image, terms);
  NEAR(terms[0], 24, 1e-13);
  OK(cag_mesh_flip(image, &flipped, &err));
  cag_mesh_volume_terms(flipped, terms);
  NEAR(terms[0], -24, 1e-13);
  cag_mesh_release(m);
  cag_mesh_release(image);
  cag_mesh_release(flipped);
}

static void normals_follow_a_transform_as_normals(void **state) {
  (void)state;
  CagMesh *m, *image;
  OK(cag_mesh_new(1, 0, true, false, false, &m, &err));
  double half = sqrt(0.5);
  m->positions[0] = cag_vec3(1, 0, 0);
  m->normals[0] = cag_vec3(half, half, 0); // normal of the plane x + y = 1
  CagTransform stretch = cag_transform_identity();
  stretch.m[0][0] = -2; // it becomes -x/2 + y = 1
  OK(cag_mesh_transform(m, &stretch, &image, &err));
  near_vec(image->normals[0], cag_unit(cag_vec3(-0.5, 1, 0)), 1e-15);
  cag_mesh_release(m);
  cag_mesh_release(image);
}

static void bad_faces_are_named(void **state) {
  (void)state;
  CagMesh *m;
  uint32_t three = 3, two = 2, four = 4;
  FAILS_AT(cag_mesh_from_faces(cube_vertices, 8, (uint32_t[]){0, 1, 8}, &three, 1, &m, &err),
           "face-index", 0);
  FAILS_AT(cag_mesh_from_faces(cube_vertices, 8, (uint32_t[]){0, 1}, &two, 1, &m, &err),
           "face-degenerate", 0);
  FAILS_AT(cag_mesh_from_faces(cube_vertices, 8, (uint32_t[]){0, 1, 3, 0}, &four, 1, &m, &err),
           "face-degenerate", 0);
  // With two corners exchanged, the face is a bow tie.
  FAILS_AT(cag_mesh_from_faces(cube_vertices, 8, (uint32_t[]){0, 1, 2, 3}, &four, 1, &m, &err),
           "face-degenerate", 0);
  CagVec3 line[4] = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {NAN, 0, 0}};
  FAILS_AT(cag_mesh_from_faces(line, 4, (uint32_t[]){0, 1, 2}, &three, 1, &m, &err),
           "vertex-not-finite", 3);
}

static void a_concave_face_is_cut_within_its_outline(void **state) {
  (void)state;
  // An L of area 3 in the plane x = 5.
  CagVec3 l[6] = {{5, 0, 0}, {5, 2, 0}, {5, 2, 1}, {5, 1, 1}, {5, 1, 2}, {5, 0, 2}};
  uint32_t corners[6] = {0, 1, 2, 3, 4, 5}, six = 6;
  CagMesh *m;
  OK(cag_mesh_from_faces(l, 6, corners, &six, 1, &m, &err));
  assert_int_equal(m->triangle_count, 4);
  NEAR(cag_mesh_area(m), 3, 1e-14);
  double terms[10];
  cag_mesh_volume_terms(m, terms); // the cone over it from the origin
  NEAR(terms[0], 5, 1e-14);
  cag_mesh_release(m);
}

// The triangles of the cube, with separate corners and slight noise.
static CagMesh *loose_cube(double noise) {
  CagMesh *m = cube(), *loose;
  OK(cag_mesh_new(36, 12, false, false, false, &loose, &err));
  for (uint32_t k = 0; k < 36; k++) {
    loose->positions[k] = m->positions[m->triangles[k]];
    loose->positions[k].x += noise * ((k * 7) % 5) / 4;
    loose->triangles[k] = k;
  }
  cag_mesh_release(m);
  return loose;
}

static void welding_closes_what_is_near(void **state) {
  (void)state;
  CagMesh *loose = loose_cube(1e-4), *welded;
  CagVec3 edge[2];
  assert_false(cag_mesh_is_watertight(loose, edge));
  OK(cag_mesh_weld(loose, 1e-3, &welded, &err));
  assert_int_equal(welded->vertex_count, 8);
  assert_int_equal(welded->triangle_count, 12);
  assert_true(cag_mesh_is_watertight(welded, edge));
  cag_mesh_release(welded);
  OK(cag_mesh_weld(loose, 1e-6, &welded, &err));
  assert_true(welded->vertex_count > 8);
  cag_mesh_release(welded);
  FAILS(cag_mesh_weld(loose, -1, &welded, &err), "tolerance-negative");
  cag_mesh_release(loose);
  loose = loose_cube(0);
  OK(cag_mesh_weld(loose, 0, &welded, &err));
  assert_int_equal(welded->vertex_count, 8);
  cag_mesh_release(welded);
  OK(cag_mesh_weld(loose, 10, &welded, &err));
  assert_int_equal(welded->triangle_count, 0);
  cag_mesh_release(welded);
  cag_mesh_release(loose);
}

// A tessellated box has a vertex for each corner of each face, so its edges are sharp.
static void welding_joins_vertices_across_sharp_edges(void **state) {
  (void)state;
  CagMesh *m = cube(), *doubled, *welded;
  OK(cag_mesh_new(8, 12, true, true, true, &doubled, &err));
  memcpy(doubled->positions, m->positions, 8 * sizeof *m->positions);
  memcpy(doubled->triangles, m->triangles, 36 * sizeof *m->triangles);
  for (uint32_t i = 0; i < 8; i++) {
    doubled->normals[i] = cag_unit(doubled->positions[i]);
    doubled->uv[2 * i] = doubled->uv[2 * i + 1] = 0.5;
    doubled->weld[i] = i;
  }
  CagMesh *pair;
  OK(cag_mesh_append((CagMesh *[]){doubled, doubled}, 2, &pair, &err));
  OK(cag_mesh_weld(pair, 0, &welded, &err));
  assert_int_equal(welded->vertex_count, 8);
  assert_non_null(welded->normals); // all are equal
  assert_non_null(welded->uv);
  assert_null(welded->weld);
  cag_mesh_release(welded);
  pair->normals[12] = cag_scaled(pair->normals[12], -1);
  pair->uv[20] = 0.25;
  OK(cag_mesh_weld(pair, 1e-9, &welded, &err));
  assert_int_equal(welded->vertex_count, 8);
  assert_null(welded->normals);
  assert_null(welded->uv);
  cag_mesh_release(welded);
  cag_mesh_release(pair);
  cag_mesh_release(doubled);
  cag_mesh_release(m);
}

static void meshes_join_to_one(void **state) {
  (void)state;
  CagMesh *a = cube(), *b, *both;
  CagTransform away = cag_translate(cag_vec3(5, 0, 0));
  OK(cag_mesh_transform(a, &away, &b, &err));
  OK(cag_mesh_append((CagMesh *[]){a, b}, 2, &both, &err));
  assert_int_equal(both->triangle_count, 24);
  assert_int_equal(cag_mesh_euler_characteristic(both), 4); // two spheres
  double terms[10];
  cag_mesh_volume_terms(both, terms);
  NEAR(terms[0], 16, 1e-13);
  NEAR(terms[1], 40, 1e-12); // of the second one: 8 * 5
  cag_mesh_release(a);
  cag_mesh_release(b);
  cag_mesh_release(both);
}

// --- Random meshes ---

static CagVec3 random_point(double size) {
  double x[3];
  for (int i = 0; i < 3; i++) x[i] = uniform(-size, size);
  return cag_vec3(x[0], x[1], x[2]);
}

// Random triangles between few points, with any of the arrays that a mesh may have. Vertices may
// coincide; if so, `weld` is set.
static CagMesh *random_soup(size_t vertices, size_t triangles, bool normals, bool uv, bool weld,
                            bool labels) {
  CagMesh *m;
  OK(cag_mesh_new(vertices, triangles, normals, uv, weld, &m, &err));
  for (uint32_t v = 0; v < vertices; v++) {
    m->positions[v] = random_point(2);
    const bool twin = weld && v > 0 && uniform(0, 1) < 0.3;
    if (weld) m->weld[v] = twin ? m->weld[v - 1] : v;
    if (twin) m->positions[v] = m->positions[v - 1];
    if (normals) m->normals[v] = cag_unit(random_point(1));
    if (uv) m->uv[2 * v] = uniform(0, 1), m->uv[2 * v + 1] = uniform(0, 1);
  }
  for (size_t t = 0; t < triangles; t++)
    for (int k = 0; k < 3; k++) {
      uint32_t *c = m->triangles + 3 * t, v;
      do v = (uint32_t)uniform(0, (double)vertices);
      while ((k > 0 && v == c[0]) || (k > 1 && v == c[1]));
      c[k] = v;
    }
  if (labels) {
    m->labels = malloc((triangles + 1) * sizeof *m->labels);
    for (size_t t = 0; t < triangles; t++) m->labels[t] = (uint32_t)uniform(0, 4);
  }
  return m;
}

static uint32_t point_of(const CagMesh *m, uint32_t v) { return m->weld ? m->weld[v] : v; }

// Counts the triangles with the directed edge from a to b, after welding.
static int count_edge(const CagMesh *m, uint32_t a, uint32_t b) {
  int n = 0;
  for (size_t t = 0; t < m->triangle_count; t++)
    for (int k = 0; k < 3; k++)
      n += point_of(m, m->triangles[3 * t + (size_t)k]) == a &&
           point_of(m, m->triangles[3 * t + (size_t)(k + 1) % 3]) == b;
  return n;
}

// Whether the mesh is closed and its Euler characteristic, from every pair of vertices. Every
// second mesh is closed, because some of the triangles are repeated in reverse.
static void edges_are_counted_as_by_hand(void **state) {
  (void)state;
  seed = 31;
  int closed = 0;
  for (int k = 0; k < 400; k++) {
    const size_t half = 1 + (size_t)k % 5;
    CagMesh *m = random_soup(3 + (size_t)k % 6, 2 * half, false, false, k % 3 == 0, false);
    if (k % 2) // the second half closes the first
      for (size_t t = 0; t < half; t++) {
        const uint32_t *a = m->triangles + 3 * t;
        uint32_t *b = m->triangles + 3 * (half + t);
        b[0] = a[1], b[1] = a[0], b[2] = a[2];
      }
    bool expected = true, named = false;
    long euler = 0;
    CagVec3 edge[2] = {{0, 0, 0}, {0, 0, 0}};
    bool watertight;
    OK(cag_mesh_watertight(m, &watertight, edge, &err));
    for (uint32_t a = 0; a < m->vertex_count; a++) {
      bool used = false;
      for (size_t i = 0; i < 3 * m->triangle_count; i++)
        used = used || point_of(m, m->triangles[i]) == a;
      euler += used;
      for (uint32_t b = a + 1; b < m->vertex_count; b++) {
        const int there = count_edge(m, a, b), back = count_edge(m, b, a);
        euler -= there + back > 0;
        if ((there == 1 && back == 1) || there + back == 0) continue;
        expected = false;
        const double apart = cag_norm(cag_sub(edge[0], m->positions[a])) +
                             cag_norm(cag_sub(edge[1], m->positions[b]));
        named = named || apart == 0;
      }
    }
    for (size_t t = 0; t < m->triangle_count; t++) {
      const uint32_t *c = m->triangles + 3 * t;
      const uint32_t x = point_of(m, c[0]), y = point_of(m, c[1]), z = point_of(m, c[2]);
      euler += x != y && y != z && z != x;
    }
    assert_int_equal(watertight, expected);
    assert_int_equal(cag_mesh_is_watertight(m, NULL), expected);
    assert_int_equal(named, !expected);
    assert_int_equal(cag_mesh_euler_characteristic(m), euler);
    closed += expected;
    cag_mesh_release(m);
  }
  assert_true(closed > 20 && closed < 380);
  CagMesh *none;
  OK(cag_mesh_new(0, 0, false, false, false, &none, &err));
  assert_false(cag_mesh_is_watertight(none, NULL));
  assert_int_equal(cag_mesh_euler_characteristic(none), 0);
  cag_mesh_release(none);
}

// Many triangles around one vertex: a bipyramid has two for each of its n sides.
static void a_fan_of_many_triangles_closes(void **state) {
  (void)state;
  for (uint32_t n = 3; n < 60; n += 7) {
    CagMesh *m;
    OK(cag_mesh_new(n + 2, 2 * n, false, false, false, &m, &err));
    m->positions[0] = cag_vec3(0, 0, -1);
    m->positions[1] = cag_vec3(0, 0, 1);
    for (uint32_t i = 0; i < n; i++) {
      m->positions[2 + i] = cag_vec3(cos(2 * M_PI * i / n), sin(2 * M_PI * i / n), 0);
      const uint32_t a = 2 + i, b = 2 + (i + 1) % n, two[6] = {1, a, b, 0, b, a};
      memcpy(m->triangles + 6 * i, two, sizeof two);
    }
    CagVec3 edge[2];
    assert_true(cag_mesh_is_watertight(m, edge));
    assert_int_equal(cag_mesh_euler_characteristic(m), 2);
    // An additional or missing triangle at an edge opens the mesh.
    const uint32_t first = m->triangles[0];
    m->triangle_count--;
    assert_false(cag_mesh_is_watertight(m, edge));
    m->triangle_count++;
    m->triangles[0] = 0;
    assert_false(cag_mesh_is_watertight(m, edge));
    m->triangles[0] = first;
    cag_mesh_release(m);
  }
}

// Tetrahedra: the integrals of 1, the coordinates, and their products from a four-point rule that
// is exact for the second degree.
static void volume_terms_are_integrals(void **state) {
  (void)state;
  seed = 32;
  static const uint32_t faces[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  for (int k = 0; k < 100; k++) {
    CagMesh *m;
    OK(cag_mesh_new(4, 4, false, false, false, &m, &err));
    for (int i = 0; i < 4; i++) m->positions[i] = random_point(3);
    memcpy(m->triangles, faces, sizeof faces);
    const CagVec3 *p = m->positions;
    const CagVec3 a = cag_sub(p[1], p[0]), b = cag_sub(p[2], p[0]), c = cag_sub(p[3], p[0]);
    const double volume = cag_dot(a, cag_cross(b, c)) / 6;
    double expected[10] = {volume}, terms[10], area = 0;
    const double near = (5 + 3 * sqrt(5)) / 20, far = (5 - sqrt(5)) / 20;
    for (int i = 0; i < 4; i++) {
      CagVec3 x = {0, 0, 0};
      for (int j = 0; j < 4; j++) x = cag_madd(x, i == j ? near : far, p[j]);
      const double parts[9] = {x.x,       x.y,       x.z,       x.x * x.x, x.y * x.y,
                               x.z * x.z, x.x * x.y, x.y * x.z, x.z * x.x};
      for (int j = 0; j < 9; j++) expected[1 + j] += volume / 4 * parts[j];
      const CagVec3 u = p[(i + 1) % 4], v = p[(i + 2) % 4], w = p[(i + 3) % 4];
      area += cag_norm(cag_cross(cag_sub(v, u), cag_sub(w, u))) / 2;
    }
    cag_mesh_volume_terms(m, terms);
    for (int i = 0; i < 10; i++) NEAR(terms[i], expected[i], 1e-11);
    NEAR(cag_mesh_area(m), area, 1e-12);
    cag_mesh_release(m);
  }
}

// A normal of a plane's vertices is mapped to that of the plane's image, on the side that the map
// makes the outer one.
static void normals_stay_square_to_images_of_planes(void **state) {
  (void)state;
  seed = 33;
  for (int k = 0; k < 200; k++) {
    CagMesh *m = random_soup(3, 1, true, k % 2, k % 3 == 0, k % 5 == 0), *image;
    const CagVec3 p[3] = {random_point(1), random_point(1), random_point(1)};
    const CagVec3 n = cag_unit(cag_cross(cag_sub(p[1], p[0]), cag_sub(p[2], p[0])));
    for (uint32_t v = 0; v < 3; v++) {
      m->positions[v] = p[v], m->normals[v] = n, m->triangles[v] = v;
      if (m->weld) m->weld[v] = v;
    }
    CagTransform t = cag_transform_identity();
    t.planar = false;
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 4; j++) t.m[i][j] += uniform(-0.4, 0.4);
    for (int j = 0; j < 3; j++) t.m[3][j] = k % 4 == 0 ? uniform(-0.2, 0.2) : 0;
    if (k % 2)
      for (int j = 0; j < 4; j++) t.m[0][j] *= -1;
    OK(cag_mesh_transform(m, &t, &image, &err));
    const CagVec3 *q = image->positions;
    const uint32_t *c = image->triangles;
    for (int v = 0; v < 3; v++) near_vec(q[v], cag_transform_point(&t, p[v]), 0);
    const CagVec3 normal =
        cag_unit(cag_cross(cag_sub(q[c[1]], q[c[0]]), cag_sub(q[c[2]], q[c[0]])));
    assert_int_equal(c[1] == 2, k % 2); // a reflection reverses the triangle
    for (int v = 0; v < 3; v++) near_vec(image->normals[v], normal, 1e-9);
    if (m->uv) assert_memory_equal(image->uv, m->uv, 6 * sizeof *m->uv);
    if (m->labels) assert_int_equal(image->labels[0], m->labels[0]);
    assert_int_equal(image->weld != NULL, k % 3 == 0);
    cag_mesh_release(image);
    OK(cag_mesh_flip(m, &image, &err));
    assert_int_equal(image->triangles[1], 2);
    assert_int_equal(image->triangles[2], 1);
    near_vec(image->normals[2], cag_scaled(n, -1), 0);
    if (m->uv) assert_memory_equal(image->uv, m->uv, 6 * sizeof *m->uv);
    if (m->labels) assert_int_equal(image->labels[0], m->labels[0]);
    cag_mesh_release(image);
    // One coordinate of one vertex at infinity.
    const int axis = k % 3;
    CagTransform huge = cag_transform_identity();
    huge.planar = false;
    huge.m[axis][axis] = 1e300;
    double *x = &(&m->positions[k / 3 % 3].x)[axis];
    for (int v = 0; v < 3; v++) (&m->positions[v].x)[axis] = 0.5;
    *x = 1e30;
    FAILS_AT(cag_mesh_transform(m, &huge, &image, &err), "point-at-infinity", k / 3 % 3);
    cag_mesh_release(m);
  }
}

// Every array of the parts appears after those of the previous parts.
static void joined_meshes_keep_their_arrays(void **state) {
  (void)state;
  seed = 34;
  for (int k = 0; k < 200; k++) {
    const size_t n = 1 + (size_t)k % 3;
    CagMesh *parts[3], *all;
    bool normals = false, uv = true, weld = false, labels = false, same = true;
    for (size_t i = 0; i < n; i++) {
      const bool has_normals = uniform(0, 1) < 0.5, has_uv = uniform(0, 1) < 0.8,
                 has_weld = uniform(0, 1) < 0.5, has_labels = uniform(0, 1) < 0.5;
      parts[i] = random_soup(4 + i, 3 + i, has_normals, has_uv, has_weld, has_labels);
      CagColorScale scale = {CAG_SCALE_STRIPES, 1, 2, 3};
      const int other = k % 6; // one number differs
      if (i == 1 && other == 1) scale.kind = CAG_SCALE_SEQUENCE;
      if (i == 1 && other == 2) scale.from = 0;
      if (i == 1 && other == 3) scale.to = 4;
      if (i == 1 && other == 4) scale.stripes = 5;
      if (i == 1 && other > 0 && other < 5) same = false;
      if (has_uv) parts[i]->scale = scale;
      normals = normals || has_normals, uv = uv && has_uv, weld = weld || has_weld;
      labels = labels || has_labels;
    }
    OK(cag_mesh_append(parts, n, &all, &err));
    assert_int_equal(all->normals != NULL, normals);
    assert_int_equal(all->uv != NULL, uv);
    assert_int_equal(all->weld != NULL, weld);
    assert_int_equal(all->labels != NULL, labels);
    assert_int_equal(all->scale.kind, uv && same ? CAG_SCALE_STRIPES : CAG_SCALE_NONE);
    if (uv && same) {
      NEAR(all->scale.from, 1, 0);
      NEAR(all->scale.to, 2, 0);
      assert_int_equal(all->scale.stripes, 3);
    }
    size_t v = 0, t = 0;
    for (size_t i = 0; i < n; i++) {
      const CagMesh *m = parts[i];
      for (uint32_t j = 0; j < m->vertex_count; j++) {
        near_vec(all->positions[v + j], m->positions[j], 0);
        if (uv) assert_memory_equal(all->uv + 2 * (v + j), m->uv + 2 * j, 2 * sizeof(double));
        if (weld) assert_int_equal(all->weld[v + j], v + point_of(m, j));
        if (!normals) continue;
        // Parts without normals get those of their triangles, weighted by area.
        CagVec3 sum = {0, 0, 0};
        for (size_t f = 0; f < m->triangle_count; f++) {
          const uint32_t *c = m->triangles + 3 * f;
          if (c[0] != j && c[1] != j && c[2] != j) continue;
          sum = cag_add(sum, cag_cross(cag_sub(m->positions[c[1]], m->positions[c[0]]),
                                       cag_sub(m->positions[c[2]], m->positions[c[0]])));
        }
        near_vec(all->normals[v + j], m->normals ? m->normals[j] : cag_unit(sum), 1e-12);
      }
      for (size_t j = 0; j < 3 * m->triangle_count; j++)
        assert_int_equal(all->triangles[3 * t + j], v + m->triangles[j]);
      for (size_t j = 0; j < m->triangle_count && labels; j++)
        assert_int_equal(all->labels[t + j], m->labels ? m->labels[j] : 0);
      v += m->vertex_count;
      t += m->triangle_count;
    }
    assert_int_equal(all->vertex_count, v);
    assert_int_equal(all->triangle_count, t);
    const CagBounds box = cag_mesh_bounds(all);
    for (size_t j = 0; j < v; j++) {
      const CagVec3 p = all->positions[j];
      assert_true(p.x >= box.min.x && p.y >= box.min.y && p.z >= box.min.z);
      assert_true(p.x <= box.max.x && p.y <= box.max.y && p.z <= box.max.z);
    }
    for (size_t i = 0; i < n; i++) cag_mesh_release(parts[i]);
    cag_mesh_release(all);
  }
}

// Each vertex is welded to the closest previous point within the tolerance, compared with a search
// over all pairs.
static void welding_is_that_of_all_pairs(void **state) {
  (void)state;
  seed = 35;
  for (int k = 0; k < 120; k++) {
    const size_t n = 20 + (size_t)k % 60;
    const double tolerance = k % 4 == 0 ? 0 : k % 4 == 1 ? 0.5 : uniform(0.05, 1);
    CagMesh *m = random_soup(n, n, k % 2, k % 3 > 0, false, k % 5 > 0), *welded;
    for (size_t v = 0; v < n; v++) {
      // On a grid with half units, some distances are equal, and some equal the tolerance.
      if (k % 4 < 2) {
        CagVec3 *p = &m->positions[v];
        *p = cag_vec3(round(p->x) / 2, round(p->y) / 2, round(p->z) / 2);
      }
      if (m->normals && k % 8 < 4) m->normals[v] = cag_vec3(0, 0, 1);
      if (m->uv && k % 16 < 8) m->uv[2 * v] = m->uv[2 * v + 1] = 0.25;
      if (m->uv) m->scale = (CagColorScale){CAG_SCALE_SEQUENCE, 0, 1, 0};
    }
    uint32_t first[80], number[80];
    size_t points = 0;
    bool normals = m->normals != NULL, uv = m->uv != NULL;
    for (uint32_t v = 0; v < n; v++) {
      double best = tolerance;
      first[v] = v;
      for (uint32_t p = 0; p < v; p++) {
        const double d = cag_norm(cag_sub(m->positions[v], m->positions[p]));
        if (first[p] != p || d > best || (d == best && first[v] != v)) continue;
        first[v] = p, best = d;
      }
      if (first[v] == v) number[v] = (uint32_t)points++;
      const uint32_t p = first[v];
      normals = normals && (p == v || cag_dot(m->normals[p], m->normals[v]) > 1 - 1e-6);
      uv = uv && !memcmp(m->uv + 2 * p, m->uv + 2 * v, 2 * sizeof *m->uv);
    }
    OK(cag_mesh_weld(m, tolerance, &welded, &err));
    assert_int_equal(welded->vertex_count, points);
    assert_int_equal(welded->normals != NULL, normals);
    assert_int_equal(welded->uv != NULL, uv);
    assert_int_equal(welded->scale.kind, uv ? CAG_SCALE_SEQUENCE : CAG_SCALE_NONE);
    for (size_t v = 0; v < n; v++) {
      if (first[v] != v) continue;
      near_vec(welded->positions[number[v]], m->positions[v], 0);
      if (normals) near_vec(welded->normals[number[v]], m->normals[v], 0);
      if (uv) NEAR(welded->uv[2 * number[v] + 1], m->uv[2 * v + 1], 0);
    }
    size_t t = 0;
    for (size_t f = 0; f < n; f++) {
      uint32_t c[3];
      for (int j = 0; j < 3; j++) c[j] = number[first[m->triangles[3 * f + (size_t)j]]];
      if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
      assert_memory_equal(welded->triangles + 3 * t, c, sizeof c);
      if (m->labels) assert_int_equal(welded->labels[t], m->labels[f]);
      t++;
    }
    assert_int_equal(welded->triangle_count, t);
    cag_mesh_release(m);
    cag_mesh_release(welded);
  }
}

// Convex and concave polygons around a point in any plane, with any first corner: the triangles
// have the orientation of the outline and fill its area.
static void polygons_of_any_plane_are_filled(void **state) {
  (void)state;
  seed = 36;
  for (int k = 0; k < 300; k++) {
    const uint32_t n = 3 + (uint32_t)k % 10, *first;
    CagVec3 p[12];
    uint32_t face[12];
    CagTransform turn;
    double twice = 0, x[12], y[12];
    for (uint32_t i = 0; i < n; i++) {
      const double angle = 2 * M_PI * i / n, r = k % 3 ? uniform(0.3, 2) : 1;
      x[i] = r * cos(angle) + 3, y[i] = r * sin(angle) - 1;
    }
    for (uint32_t i = 0; i < n; i++) twice += x[i] * y[(i + 1) % n] - x[(i + 1) % n] * y[i];
    const CagVec3 axis = random_point(1), far = random_point(5);
    // Axis-parallel planes, seen from either side, and others.
    if (k % 4 == 0) turn = cag_rpy(0, k % 8 ? 0 : M_PI, 0);
    else if (k % 4 == 1) turn = cag_rpy(k % 8 < 4 ? M_PI / 2 : -M_PI / 2, 0, 0);
    else if (k % 4 == 2) turn = cag_rpy(0, k % 8 < 4 ? M_PI / 2 : -M_PI / 2, 0);
    else OK(cag_rotate(axis, 1 + k, cag_vec3(0, 0, 0), &turn, &err));
    for (uint32_t i = 0; i < n; i++) {
      const uint32_t at = (i + (uint32_t)k) % n;
      face[i] = at;
      p[at] = cag_add(cag_transform_point(&turn, cag_vec3(x[at], y[at], 0)), far);
    }
    const CagVec3 normal = cag_sub(cag_transform_point(&turn, cag_vec3(0, 0, 1)),
                                   cag_transform_point(&turn, cag_vec3(0, 0, 0)));
    CagMesh *m;
    OK(cag_mesh_from_faces(p, n, face, &n, 1, &m, &err));
    assert_int_equal(m->triangle_count, n - 2);
    double sum = 0;
    first = m->triangles;
    for (size_t t = 0; t < n - 2; t++, first += 3) {
      const CagVec3 area =
          cag_cross(cag_sub(p[first[1]], p[first[0]]), cag_sub(p[first[2]], p[first[0]]));
      assert_true(cag_dot(area, normal) > 0);
      sum += cag_dot(area, normal);
    }
    NEAR(sum, twice, 1e-12);
    cag_mesh_release(m);
  }
  // A star that winds twice, whose corners all turn left although it intersects itself. Collinear
  // corners.
  CagVec3 star[5];
  uint32_t five = 5, order[5] = {0, 2, 4, 1, 3};
  CagMesh *m;
  for (int i = 0; i < 5; i++) star[i] = cag_vec3(cos(0.4 * M_PI * i), sin(0.4 * M_PI * i), 2);
  FAILS_AT(cag_mesh_from_faces(star, 5, order, &five, 1, &m, &err), "face-self-intersection", 0);
  for (int i = 0; i < 5; i++) star[i] = cag_vec3(i * i, 2 * i * i, 3 * i * i);
  FAILS_AT(cag_mesh_from_faces(star, 5, order, &five, 1, &m, &err), "face-degenerate", 0);
}

// Edge splitting preserves the shape, labels, and closedness, and linear functions over the
// triangles.
static void divided_triangles_keep_their_mesh(void **state) {
  (void)state;
  seed = 37;
  for (int k = 0; k < 60; k++) {
    CagMesh *m = k % 2 ? cube() : random_soup(8, 5, false, true, false, true), *fine;
    if (k % 4 == 1) { // the cube with separate corners for each face, welded
      CagMesh *loose;
      OK(cag_mesh_new(36, 12, true, false, true, &loose, &err));
      for (uint32_t i = 0; i < 36; i++) {
        loose->positions[i] = m->positions[m->triangles[i]];
        loose->triangles[i] = i;
        for (uint32_t j = 0; j <= i; j++)
          if (m->triangles[j] == m->triangles[i]) {
            loose->weld[i] = j;
            break;
          }
        loose->normals[i] = cag_unit(loose->positions[i]);
      }
      cag_mesh_release(m);
      m = loose;
    }
    if (m->uv)
      for (size_t v = 0; v < m->vertex_count; v++) { // linear functions of the position
        const CagVec3 p = m->positions[v];
        m->uv[2 * v] = p.x + 2 * p.y + 1, m->uv[2 * v + 1] = p.z - p.y;
      }
    if (m->uv) m->scale = (CagColorScale){CAG_SCALE_SEQUENCE, 0, 1, 0};
    double longest = k % 6 == 1 ? 1 : uniform(0.3, 3), areas[2][4] = {{0}}, terms[2][10];
    OK(cag_mesh_split_edges(m, longest, 100000, &fine, &err));
    const CagMesh *both[2] = {m, fine};
    for (int i = 0; i < 2; i++) {
      const CagMesh *one = both[i];
      for (size_t t = 0; t < one->triangle_count; t++) {
        const uint32_t *c = one->triangles + 3 * t;
        const CagVec3 *p = one->positions;
        areas[i][one->labels ? one->labels[t] : 0] +=
            cag_norm(cag_cross(cag_sub(p[c[1]], p[c[0]]), cag_sub(p[c[2]], p[c[0]])));
        for (int j = 0; j < 3 && i == 1; j++)
          assert_true(cag_norm(cag_sub(p[c[j]], p[c[(j + 1) % 3]])) <= longest * (1 + 1e-11));
      }
      cag_mesh_volume_terms(one, terms[i]);
    }
    for (int i = 0; i < 4; i++) NEAR(areas[1][i], areas[0][i], 1e-12);
    for (int i = 0; i < 10; i++) NEAR(terms[1][i], terms[0][i], 1e-11);
    assert_int_equal(fine->labels != NULL, m->labels != NULL);
    assert_int_equal(fine->scale.kind, m->scale.kind);
    for (size_t v = 0; v < fine->vertex_count; v++) {
      const CagVec3 p = fine->positions[v];
      if (fine->uv) {
        NEAR(fine->uv[2 * v], p.x + 2 * p.y + 1, 1e-13);
        NEAR(fine->uv[2 * v + 1], p.z - p.y, 1e-13);
      }
      if (fine->normals) NEAR(cag_norm(fine->normals[v]), 1, 1e-14);
      if (!fine->weld) continue;
      assert_true(fine->weld[v] <= v);
      near_vec(fine->positions[fine->weld[v]], p, 0);
      for (size_t w = 0; w < v; w++)
        if (!memcmp(&fine->positions[w], &p, sizeof p)) {
          assert_true(fine->weld[v] < v); // the first vertex at this position
          break;
        }
    }
    if (k % 2) {
      assert_true(cag_mesh_is_watertight(fine, NULL));
      assert_int_equal(cag_mesh_euler_characteristic(fine), 2);
    }
    const size_t made = fine->triangle_count;
    cag_mesh_release(fine);
    OK(cag_mesh_split_edges(m, longest, made, &fine, &err));
    cag_mesh_release(fine);
    if (made > m->triangle_count)
      FAILS(cag_mesh_split_edges(m, longest, made - 1, &fine, &err), "triangle-limit");
    cag_mesh_release(m);
  }
  // Edges as long as the limit are kept: a triangle with sides 3, 4, and 5 has one edge above 4.
  CagMesh *m, *fine;
  OK(cag_mesh_new(3, 1, true, false, false, &m, &err));
  m->positions[0] = cag_vec3(0, 0, 0);
  m->positions[1] = cag_vec3(3, 0, 0);
  m->positions[2] = cag_vec3(0, 4, 0);
  for (uint32_t v = 0; v < 3; v++) m->triangles[v] = v;
  // Opposite normals do not have a mean: the midpoint gets that of its first end.
  m->normals[0] = cag_vec3(0, 1, 0);
  m->normals[1] = cag_vec3(0, 0, 1);
  m->normals[2] = cag_vec3(0, 0, -1);
  OK(cag_mesh_split_edges(m, 5, 10, &fine, &err));
  assert_int_equal(fine->triangle_count, 1);
  cag_mesh_release(fine);
  OK(cag_mesh_split_edges(m, 4, 10, &fine, &err));
  assert_int_equal(fine->triangle_count, 2);
  near_vec(fine->positions[3], cag_vec3(1.5, 2, 0), 0);
  near_vec(fine->normals[3], cag_vec3(0, 0, 1), 0);
  cag_mesh_release(fine);
  // If two edges are long, the shorter diagonal divides the rest.
  OK(cag_mesh_split_edges(m, 3.5, 10, &fine, &err));
  assert_int_equal(fine->triangle_count, 3);
  double most = 0;
  for (size_t i = 0; i < 9; i++)
    most =
        fmax(most, cag_norm(cag_sub(fine->positions[fine->triangles[i]],
                                    fine->positions[fine->triangles[i % 3 == 2 ? i - 2 : i + 1]])));
  NEAR(most, 3, 1e-14); // from the middle [0, 2] to [1.5, 2] and [3, 0]: 1.5, sqrt(13) or 2.5
  cag_mesh_release(fine);
  cag_mesh_release(m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_cube_is_watertight_and_has_its_measures),
      cmocka_unit_test(a_missing_or_turned_face_is_found),
      cmocka_unit_test(a_mirror_keeps_the_outside_outside),
      cmocka_unit_test(normals_follow_a_transform_as_normals),
      cmocka_unit_test(bad_faces_are_named),
      cmocka_unit_test(a_concave_face_is_cut_within_its_outline),
      cmocka_unit_test(welding_closes_what_is_near),
      cmocka_unit_test(welding_joins_vertices_across_sharp_edges),
      cmocka_unit_test(meshes_join_to_one),
      cmocka_unit_test(edges_are_counted_as_by_hand),
      cmocka_unit_test(a_fan_of_many_triangles_closes),
      cmocka_unit_test(volume_terms_are_integrals),
      cmocka_unit_test(normals_stay_square_to_images_of_planes),
      cmocka_unit_test(joined_meshes_keep_their_arrays),
      cmocka_unit_test(welding_is_that_of_all_pairs),
      cmocka_unit_test(polygons_of_any_plane_are_filled),
      cmocka_unit_test(divided_triangles_keep_their_mesh),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
