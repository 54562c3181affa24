// Closed meshes and surfaces are oriented outward, and cavities inward. Open ones are not changed.

#include "tests/geom/support.h"

#include "geom/surface/quadric.h"
#include "geom/tessellate/orient.h"

static uint32_t state_of_random = 1;
// Uniform in 0..1 (the linear congruential generator of Numerical Recipes).
static double random_unit(void) {
  state_of_random = state_of_random * 1664525u + 1013904223u;
  return (state_of_random >> 8) / 16777216.0;
}

typedef struct Draft {
  CagVec3 vertices[4096];
  uint32_t indices[16384], counts[4096];
  size_t vertex_count, index_count, face_count;
} Draft;

static void add_face(Draft *d, const uint32_t *corners, size_t n, bool turned) {
  for (size_t k = 0; k < n; k++) d->indices[d->index_count++] = corners[turned ? n - 1 - k : k];
  d->counts[d->face_count++] = (uint32_t)n;
}

// A box of quadrilaterals. With `inside_out`, all of them are reversed; with `mixed`, each randomly
// as well.
static void add_box(Draft *d, CagVec3 least, CagVec3 most, bool inside_out, bool mixed) {
  static const uint32_t SIDES[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                       {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  const uint32_t first = (uint32_t)d->vertex_count;
  for (int k = 0; k < 8; k++)
    d->vertices[d->vertex_count++] =
        cag_vec3(k & 1 ? most.x : least.x, k & 2 ? most.y : least.y, k & 4 ? most.z : least.z);
  for (int f = 0; f < 6; f++) {
    uint32_t corners[4];
    for (int k = 0; k < 4; k++) corners[k] = first + SIDES[f][k];
    add_face(d, corners, 4, inside_out != (mixed && random_unit() < 0.5));
  }
}

static CagMesh *mesh_of(const Draft *d) {
  CagMesh *m;
  OK(cag_mesh_from_faces(d->vertices, d->vertex_count, d->indices, d->counts, d->face_count, &m,
                         &err));
  return m;
}

static double volume_of(const CagMesh *m) {
  double terms[10];
  cag_mesh_volume_terms(m, terms);
  return terms[0];
}

static CagMesh *outward(CagMesh *m) {
  CagMesh *out;
  OK(cag_mesh_outward(m, &out, &err));
  cag_mesh_release(m);
  return out;
}

static void a_mesh_inside_out_is_turned_with_its_normals(void **state) {
  (void)state;
  static Draft d;
  memset(&d, 0, sizeof d);
  add_box(&d, cag_vec3(100, 0, 0), cag_vec3(102, 3, 4), true, false);
  CagMesh *given = mesh_of(&d), *with, *turned;
  OK(cag_mesh_new(given->vertex_count, given->triangle_count, true, false, false, &with, &err));
  memcpy(with->positions, given->positions, given->vertex_count * sizeof *with->positions);
  memcpy(with->triangles, given->triangles, 3 * given->triangle_count * sizeof *with->triangles);
  const CagVec3 middle = cag_vec3(101, 1.5, 2);
  for (size_t v = 0; v < with->vertex_count; v++)
    with->normals[v] = cag_unit(cag_sub(middle, with->positions[v])); // inward
  turned = outward(with);
  NEAR(volume_of(turned), 24, 1e-9);
  for (size_t v = 0; v < turned->vertex_count; v++)
    assert_true(cag_dot(turned->normals[v], cag_sub(turned->positions[v], middle)) > 0);
  cag_mesh_release(turned);
  cag_mesh_release(given);
}

// Nested boxes, some next to each other, each inside out or not. The volume is that of the odd
// layers.
static void nested_parts_alternate(void **state) {
  (void)state;
  static Draft d;
  for (int round = 0; round < 200; round++) {
    memset(&d, 0, sizeof d);
    double sum = 0;
    const size_t groups = 1 + (size_t)(4 * random_unit()), layers = 1 + (size_t)(5 * random_unit());
    const double wall = 0.01 + random_unit();
    // In half of the rounds, one more box contains everything.
    const bool around = random_unit() < 0.5;
    for (size_t g = 0; g < groups; g++)
      for (size_t k = 0; k < layers; k++) {
        const double half = wall * (double)(layers - k), x = 2.5 * wall * (double)(layers * g);
        const bool cavity = (k + around) % 2 == 1;
        add_box(&d, cag_vec3(x - half, -half, -half), cag_vec3(x + half, half, half),
                random_unit() < 0.5, round % 2);
        sum += (cavity ? -8 : 8) * half * half * half;
      }
    if (around) {
      add_box(&d, cag_vec3(-100, -100, -100), cag_vec3(100, 100, 100), random_unit() < 0.5, false);
      sum += 8e6;
    }
    CagMesh *m = outward(mesh_of(&d));
    NEAR(volume_of(m), sum, 1e-12 * fmax(fabs(sum), 8e6));
    assert_true(cag_mesh_is_watertight(m, NULL));
    cag_mesh_release(m);
  }
}

// Parts that begin at the same x as the one around them, in any order. Each has a corner on the
// box's side, from inside, and the smallest may be first.
static void parts_that_begin_with_the_one_around_them_alternate(void **state) {
  (void)state;
  // The corners of an octahedron on x, y, and z, and its faces, oriented outward.
  static const uint32_t FACES[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                       {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  static Draft d;
  enum { LAYERS = 4 };
  for (int round = 0; round < 100; round++) {
    memset(&d, 0, sizeof d);
    size_t order[LAYERS] = {0, 1, 2, 3}; // 0: the box
    for (size_t k = LAYERS - 1; k > 0; k--) {
      const size_t other = (size_t)((double)(k + 1) * random_unit()), swap = order[k];
      order[k] = order[other], order[other] = swap;
    }
    double sum = 0;
    for (size_t k = 0; k < LAYERS; k++) {
      const bool inside_out = random_unit() < 0.5;
      if (order[k] == 0) {
        add_box(&d, cag_vec3(0, -4, -4), cag_vec3(8, 4, 4), inside_out, false);
        sum += 512;
        continue;
      }
      const double r = 4 - (double)order[k]; // of the octahedron, whose volume is 4/3 r^3
      const uint32_t first = (uint32_t)d.vertex_count;
      for (int axis = 0; axis < 3; axis++)
        for (int sign = 1; sign >= -1; sign -= 2)
          d.vertices[d.vertex_count++] =
              cag_vec3(r + (axis == 0) * sign * r, (axis == 1) * sign * r, (axis == 2) * sign * r);
      for (int f = 0; f < 8; f++) {
        const uint32_t corners[3] = {first + FACES[f][0], first + FACES[f][1], first + FACES[f][2]};
        add_face(&d, corners, 3, inside_out);
      }
      sum += (order[k] % 2 ? -4.0 : 4.0) / 3 * r * r * r;
    }
    CagMesh *m = outward(mesh_of(&d));
    NEAR(volume_of(m), sum, 1e-9);
    cag_mesh_release(m);
  }
}

static void parts_beside_each_other_or_crossing_all_face_out(void **state) {
  (void)state;
  static Draft d;
  memset(&d, 0, sizeof d);
  add_box(&d, cag_vec3(0, 0, 0), cag_vec3(4, 4, 4), true, false);
  add_box(&d, cag_vec3(1, 1, 3), cag_vec3(2, 2, 5), true, false);  // crosses
  add_box(&d, cag_vec3(4, 0, 0), cag_vec3(5, 1, 1), true, false);  // touches along a face
  add_box(&d, cag_vec3(9, 9, 9), cag_vec3(8, 8, 8), false, false); // corners in reverse order
  CagMesh *m = outward(mesh_of(&d));
  NEAR(volume_of(m), 64 + 2 + 1 + 1, 1e-9);
  cag_mesh_release(m);
}

static void open_parts_stay_as_they_are(void **state) {
  (void)state;
  static Draft d;
  memset(&d, 0, sizeof d);
  add_box(&d, cag_vec3(0, 0, 0), cag_vec3(1, 1, 1), true, false);
  d.face_count--; // without its last side
  d.index_count -= 4;
  CagMesh *m = mesh_of(&d), *same;
  OK(cag_mesh_outward(m, &same, &err));
  assert_ptr_equal(same, m);
  size_t open;
  OK(cag_mesh_open_edges(m, &open, &err));
  assert_int_equal(open, 4);
  cag_mesh_release(same);
  cag_mesh_release(m);
}

// If a reversed and an unchanged triangle share a vertex with a normal, the vertex is duplicated.
static void triangles_that_disagree_share_no_normal_afterwards(void **state) {
  (void)state;
  static const uint32_t FACES[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 3, 2}}; // last: inward
  CagMesh *m;
  OK(cag_mesh_new(4, 4, true, false, false, &m, &err));
  for (uint32_t v = 0; v < 4; v++) {
    m->positions[v] = cag_vec3(v == 1, v == 2, v == 3);
    m->normals[v] = cag_vec3(0, 0, 1);
  }
  memcpy(m->triangles, FACES, sizeof FACES);
  m = outward(m);
  NEAR(volume_of(m), 1.0 / 6, 1e-15);
  assert_true(cag_mesh_is_watertight(m, NULL));
  for (size_t t = 0; t < 4; t++)
    for (size_t k = 0; k < 3; k++) NEAR(m->normals[m->triangles[3 * t + k]].z, t == 3 ? -1 : 1, 0);
  cag_mesh_release(m);
}

// A lathe of random profiles from the axis to the axis, upward or downward. Volumes are by Pappus:
// the sum over the pieces of a profile of pi/3 dz (r0^2 + r0 r1 + r1^2).
static void closed_surfaces_are_turned_outward(void **state) {
  (void)state;
  for (int round = 0; round < 60; round++) {
    enum { MOST = 8 };
    CagVec3 p[MOST];
    const size_t n = 3 + (size_t)(random_unit() * (MOST - 2));
    double six = 0;
    for (size_t k = 0; k < n; k++)
      p[k] =
          cag_vec3(k == 0 || k + 1 == n ? 0 : 1 + 5 * random_unit(), 0, (double)k + random_unit());
    if (round % 2)
      for (size_t k = 0; k < n / 2; k++) {
        const CagVec3 swap = p[k];
        p[k] = p[n - 1 - k];
        p[n - 1 - k] = swap;
      }
    for (size_t k = 0; k + 1 < n; k++)
      six += M_PI / 3 * fabs(p[k + 1].z - p[k].z) *
             (p[k].x * p[k].x + p[k].x * p[k + 1].x + p[k + 1].x * p[k + 1].x);
    CagCurve *profile;
    CagSurface *s, *out;
    OK(cag_curve_polyline(p, n, 3, false, &profile, &err));
    const bool full = round % 3 > 0;
    OK(cag_surface_revolve(profile, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), full ? 0 : 0.5,
                           (full ? 0 : 0.5) + 2 * M_PI, &s, &err));
    OK(cag_surface_outward(s, &out, &err));
    double terms[10] = {0};
    OK(cag_surface_volume_terms(out, terms, &err));
    NEAR(terms[0], six, 1e-9 * six);
    if (full) assert_true(cag_surface_revolution_view(out, NULL, NULL, NULL, NULL, NULL));
    cag_surface_release(out);
    cag_surface_release(s);
    cag_curve_release(profile);
  }
}

// An octahedron with corners at y = 0 around a tetrahedron whose triangles have their centers at y
// = 0: rays through these meet edges and corners.
static void parts_level_with_corners_alternate(void **state) {
  (void)state;
  static const uint32_t FACES[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                       {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  static const uint32_t INNER[4][3] = {{6, 8, 7}, {6, 7, 9}, {7, 8, 9}, {6, 9, 8}};
  static Draft d;
  for (int round = 0; round < 40; round++) {
    memset(&d, 0, sizeof d);
    const bool turned = round % 2;
    for (int axis = 0; axis < 3; axis++)
      for (int sign = 1; sign >= -1; sign -= 2)
        d.vertices[d.vertex_count++] =
            cag_vec3((axis == 0) * sign, (axis == 1) * sign, (axis == 2) * sign);
    for (int k = 0; k < 4; k++) {
      const double x = 0.25 * random_unit() + 0.01, z = 0.5 * random_unit() - 0.25;
      d.vertices[d.vertex_count++] = cag_vec3(x, k == 0 ? -0.25 : k == 1 ? 0.25 : 0, z);
    }
    for (int f = 0; f < 8; f++) add_face(&d, FACES[f], 3, turned);
    for (int f = 0; f < 4; f++) add_face(&d, INNER[f], 3, round % 3 == 0);
    const CagVec3 *v = d.vertices + 6;
    const double inner =
        fabs(cag_dot(cag_sub(v[1], v[0]), cag_cross(cag_sub(v[2], v[0]), cag_sub(v[3], v[0])))) / 6;
    CagMesh *m = outward(mesh_of(&d));
    NEAR(volume_of(m), 4.0 / 3 - inner, 1e-12);
    assert_int_equal(m->vertex_count, 10);
    cag_mesh_release(m);
  }
}

// Twelve inward triangles with three vertices each, an open quadrilateral, and a degenerate
// triangle, which belongs to no part. All arrays of the mesh are preserved.
static void all_arrays_go_along(void **state) {
  (void)state;
  static Draft d;
  for (int round = 0; round < 30; round++) {
    memset(&d, 0, sizeof d);
    add_box(&d, cag_vec3(0, 0, 0), cag_vec3(1, 2, 3), round % 2 == 0, round % 3 == 0);
    add_box(&d, cag_vec3(5, 0, 0), cag_vec3(7, 2, 3), true, false);
    d.face_count -= 5; // a single side of the second box
    d.index_count -= 20;
    CagMesh *plain = mesh_of(&d), *m, *out;
    const size_t n = plain->triangle_count;
    OK(cag_mesh_new(3 * n + 3, n + 1, true, true, true, &m, &err));
    m->labels = malloc((n + 1) * sizeof *m->labels);
    m->scale = (CagColorScale){CAG_SCALE_STRIPES, -1, 2, 7};
    for (uint32_t v = 0; v < 3 * n + 3; v++) {
      const uint32_t of = v < 3 * n ? plain->triangles[v] : plain->triangles[v == 3 * n];
      m->positions[v] = plain->positions[of];
      m->normals[v] = cag_unit(cag_vec3(random_unit(), random_unit() - 0.5, 1));
      m->uv[2 * v] = random_unit();
      m->uv[2 * v + 1] = random_unit();
      m->triangles[v] = m->weld[v] = v;
      for (uint32_t k = v; k-- > 0;)
        if (memcmp(&m->positions[k], &m->positions[v], sizeof(CagVec3)) == 0) m->weld[v] = k;
    }
    for (size_t t = 0; t <= n; t++) m->labels[t] = (uint32_t)(100 * random_unit());
    size_t open = 0, turned_count = 0;
    OK(cag_mesh_open_edges(m, &open, &err));
    assert_int_equal(open, 4);
    OK(cag_mesh_outward(m, &out, &err));
    assert_int_equal(out->triangle_count, n + 1);
    assert_int_equal(out->vertex_count, m->vertex_count);
    assert_memory_equal(out->labels, m->labels, (n + 1) * sizeof *m->labels);
    if (out != m) assert_memory_equal(&out->scale, &m->scale, sizeof m->scale);
    for (size_t t = 0; t <= n; t++) {
      const uint32_t *a = m->triangles + 3 * t, *b = out->triangles + 3 * t;
      const CagVec3 *p = m->positions;
      // Triangles of the box point away from its center; the others are not changed.
      const CagVec3 normal = cag_cross(cag_sub(p[a[1]], p[a[0]]), cag_sub(p[a[2]], p[a[0]]));
      const bool turned = t < 12 && cag_dot(normal, cag_sub(p[a[0]], cag_vec3(0.5, 1, 1.5))) < 0;
      turned_count += turned;
      for (size_t k = 0; k < 3; k++) {
        const uint32_t from = a[turned ? 2 - k : k], to = b[k];
        near_vec(out->positions[to], m->positions[from], 0);
        near_vec(out->normals[to], cag_scaled(m->normals[from], turned ? -1 : 1), 0);
        assert_true(out->uv[2 * to] == m->uv[2 * from]);
        assert_true(out->uv[2 * to + 1] == m->uv[2 * from + 1]);
        assert_int_equal(out->weld[to], m->weld[from]);
      }
    }
    assert_int_equal(out == m, turned_count == 0);
    cag_mesh_release(out);
    cag_mesh_release(m);
    cag_mesh_release(plain);
  }
}

// A closed band of N by N quadrilaterals, glued as a torus or, reversed, as a Klein bottle. The
// latter has no outside, and is not changed.
static void one_sided_meshes_stay_as_they_are(void **state) {
  (void)state;
  enum { N = 6 };
  for (int klein = 0; klein < 2; klein++) {
    CagMesh *m, *out;
    OK(cag_mesh_new(N * N, 2 * N * N, false, false, false, &m, &err));
    for (int i = 0; i < N * N; i++) {
      const double a = 2 * M_PI * (i / N) / N, b = 2 * M_PI * (i % N) / N;
      m->positions[i] =
          cag_vec3((3 + cos(b)) * cos(a), (3 + cos(b)) * sin(a), sin(b) + (klein ? cos(3 * a) : 0));
    }
    uint32_t *t = m->triangles;
    for (uint32_t i = 0; i < N; i++)
      for (uint32_t k = 0; k < N; k++) {
        const bool over = klein && i + 1 == N;
        const uint32_t next = (i + 1) % N, j = (k + 1) % N;
        const uint32_t a = i * N + k, b = i * N + j;
        const uint32_t c = next * N + (over ? (N - k) % N : k);
        const uint32_t e = next * N + (over ? (N - j) % N : j);
        const uint32_t quad[6] = {a, b, c, b, e, c}; // the torus: inward
        memcpy(t, quad, sizeof quad);
        t += 6;
      }
    const double before = volume_of(m);
    size_t open;
    OK(cag_mesh_open_edges(m, &open, &err));
    assert_int_equal(open, 0);
    OK(cag_mesh_outward(m, &out, &err));
    if (klein) assert_ptr_equal(out, m);
    else {
      assert_true(before < 0);
      NEAR(volume_of(out), -before, 1e-12);
    }
    cag_mesh_release(out);
    cag_mesh_release(m);
  }
}

// Two boxes with a common edge of four triangles: each is closed, but the edge is not that of two
// triangles. A sheet that ends at a box's edge opens everything.
static void edges_of_many_triangles(void **state) {
  (void)state;
  static Draft d;
  for (int k = 0; k < 4; k++) {
    memset(&d, 0, sizeof d);
    add_box(&d, cag_vec3(0, 0, 0), cag_vec3(1, 1, 1), k == 1 || k == 2, false);
    add_box(&d, cag_vec3(1, 1, 0), cag_vec3(3, 4, 1), k == 1, false);
    // Corners 0 and 4 of the second box are 3 and 7 of the first.
    for (size_t i = 24; i < 48; i++)
      if (d.indices[i] == 8 || d.indices[i] == 12) d.indices[i] = d.indices[i] == 8 ? 3 : 7;
    if (k == 3) {
      const uint32_t sheet[3] = {3, 7, 8};
      d.vertices[8] = cag_vec3(0, 5, 0);
      add_face(&d, sheet, 3, false);
    }
    CagMesh *m = mesh_of(&d), *out;
    OK(cag_mesh_outward(m, &out, &err));
    if (k < 2) NEAR(volume_of(out), 7, 1e-12);
    else assert_ptr_equal(out, m);
    size_t open;
    OK(cag_mesh_open_edges(m, &open, &err));
    assert_int_equal(open, k == 3 ? 2 : 0);
    cag_mesh_release(out);
    cag_mesh_release(m);
  }
}

// A part whose volume is only rounding error keeps its orientation.
static void flat_parts_stay_as_they_are(void **state) {
  (void)state;
  static Draft d;
  for (int k = 0; k < 2; k++) {
    memset(&d, 0, sizeof d);
    add_box(&d, cag_vec3(0, 0, 0), cag_vec3(1, 1, k ? 1e-12 : 1e-15), true, false);
    CagMesh *m = mesh_of(&d), *out;
    OK(cag_mesh_outward(m, &out, &err));
    assert_int_equal(out == m, k == 0);
    if (k) NEAR(volume_of(out), 1e-12, 1e-16);
    cag_mesh_release(out);
    cag_mesh_release(m);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(all_arrays_go_along),
      cmocka_unit_test(parts_level_with_corners_alternate),
      cmocka_unit_test(one_sided_meshes_stay_as_they_are),
      cmocka_unit_test(edges_of_many_triangles),
      cmocka_unit_test(flat_parts_stay_as_they_are),
      cmocka_unit_test(a_mesh_inside_out_is_turned_with_its_normals),
      cmocka_unit_test(nested_parts_alternate),
      cmocka_unit_test(parts_that_begin_with_the_one_around_them_alternate),
      cmocka_unit_test(parts_beside_each_other_or_crossing_all_face_out),
      cmocka_unit_test(open_parts_stay_as_they_are),
      cmocka_unit_test(triangles_that_disagree_share_no_normal_afterwards),
      cmocka_unit_test(closed_surfaces_are_turned_outward),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
