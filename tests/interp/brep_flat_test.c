// The bilinear patches that are written as planar faces: those whose corners form a planar convex
// quadrangle or a triangle, of any size and location.

#include "interp/formats/brep.h"
#include "tests/geom/random_point.h"
#include "tests/interp/scene_fixture.h"

typedef struct Corner {
  double x, y;
} Corner;

static double turn(Corner a, Corner b, Corner c) {
  return (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x);
}

// Whether the diagonals of a quadrangle cross inside both, which makes it convex.
static bool diagonals_cross(const Corner *c) {
  return turn(c[0], c[2], c[1]) * turn(c[0], c[2], c[3]) < 0 &&
         turn(c[1], c[3], c[0]) * turn(c[1], c[3], c[2]) < 0;
}

// Too close to a degenerate shape for a comparison of signs.
static bool is_doubtful(const Corner *c) {
  for (int i = 0; i < 4; i++)
    if (fabs(turn(c[i], c[(i + 1) % 4], c[(i + 2) % 4])) < 1e-3) return true;
  return false;
}

static double along(const CagTransform *t, int axis, CagVec3 p) {
  return p.x * t->m[0][axis] + p.y * t->m[1][axis] + p.z * t->m[2][axis];
}

static CagVec3 column(const CagTransform *t, int k) {
  return cag_vec3(t->m[0][k], t->m[1][k], t->m[2][k]);
}

// The origin is the first corner, and the corners run counter-clockwise about the normal. The x
// axis is along the longest edge, or the first one if several are equally long.
static void check_plane(const CagTransform *plane, const CagVec3 *p, CagVec3 normal, double size) {
  CagVec3 longest = {0, 0, 0};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      assert_true(fabs(cag_dot(column(plane, i), column(plane, j)) - (i == j)) < 1e-14);
  for (int i = 0; i < 4; i++) {
    const CagVec3 edge = cag_sub(p[(i + 1) % 4], p[i]);
    if (cag_norm(edge) > cag_norm(longest)) longest = edge;
    assert_true(fabs(along(plane, 2, cag_sub(p[i], column(plane, 3)))) < 1e-12 * size);
  }
  assert_true(cag_norm(cag_sub(column(plane, 3), p[0])) == 0);
  assert_true(cag_norm(cag_sub(column(plane, 0), cag_unit(longest))) < 1e-10);
  assert_true(cag_norm(cag_sub(column(plane, 2), normal)) < 1e-10);
}

// Whether the patch of the corners, in order, is a planar face.
static bool is_flat(const CagVec3 *p, CagTransform *plane) {
  Fixture f;
  fixture_begin(&f);
  CagSurface *s;
  OK(cag_surface_bilinear(p[0], p[3], p[1], p[2], &s, &err));
  fixture_surface(&f, "patch", s);
  CagBrep b;
  OK(cag_brep_of_scene(&f.scene, NULL, CAG_BREP_STEP, &b, &err));
  assert_int_equal(b.face_count, 1);
  const bool flat = b.faces[0].flat;
  *plane = b.faces[0].carrier.frame;
  cag_brep_free(&b);
  fixture_end(&f);
  return flat;
}

static CagTransform random_frame(void) {
  CagTransform t;
  const CagVec3 x = random_point(1), y = random_point(1);
  OK(cag_axes(cag_vec3(0, 0, 0), x, y, &t, &err));
  return t;
}

static CagVec3 placed(const CagTransform *t, Corner c, double height, double size) {
  return cag_scaled(
      cag_madd(cag_madd(cag_scaled(column(t, 0), c.x), c.y, column(t, 1)), height, column(t, 2)),
      size);
}

static void flat_faces_are_convex(void **state) {
  (void)state;
  static const double sizes[] = {1e-7, 1e-3, 1, 1e3, 1e7};
  int count[2] = {0};
  seed = 3;
  for (int i = 0; i < 600; i++) {
    Corner c[4];
    for (int k = 0; k < 4; k++) c[k] = (Corner){uniform(0, 1), uniform(0, 1)};
    if (is_doubtful(c)) continue;
    const CagTransform t = random_frame();
    const double size = sizes[i % 5];
    CagVec3 p[4];
    for (int k = 0; k < 4; k++) p[k] = placed(&t, c[k], 0, size);
    CagTransform plane;
    const bool convex = diagonals_cross(c);
    assert_int_equal(is_flat(p, &plane), convex);
    count[convex]++;
    const double sign = turn(c[0], c[1], c[2]) > 0 ? 1 : -1;
    if (convex) check_plane(&plane, p, cag_scaled(column(&t, 2), sign), size);
    // Each corner matters for planarity, up to 1e-12 of the size.
    for (int k = 0; convex && k < 4; k++)
      for (int high = 0; high < 2; high++) {
        CagVec3 q[4] = {p[0], p[1], p[2], p[3]};
        q[k] = placed(&t, c[k], high ? 1e-10 : 1e-14, size);
        assert_int_equal(is_flat(q, &plane), !high);
      }
  }
  assert_true(count[0] > 100 && count[1] > 50);
}

// If two corners coincide, or one is on the line through its neighbors, the face is a triangle.
static void triangles_are_flat_faces(void **state) {
  (void)state;
  seed = 5;
  for (int i = 0; i < 80; i++) {
    const CagTransform t = random_frame();
    Corner c[4];
    for (int k = 0; k < 4; k++) c[k] = (Corner){uniform(0, 1), uniform(0, 1)};
    const int k = i % 4, next = (k + 1) % 4, last = (k + 3) % 4;
    const double part = i % 8 < 4 ? 0 : 0.5;
    c[k] = (Corner){c[last].x + part * (c[next].x - c[last].x),
                    c[last].y + part * (c[next].y - c[last].y)};
    if (fabs(turn(c[next], c[(k + 2) % 4], c[last])) < 1e-3) continue;
    const double size = i % 3 ? 1e-4 : 1e4;
    CagVec3 p[4];
    for (int j = 0; j < 4; j++) p[j] = placed(&t, c[j], 0, size);
    CagTransform plane;
    assert_true(is_flat(p, &plane));
    const double sign = turn(c[next], c[(k + 2) % 4], c[last]) > 0 ? 1 : -1;
    check_plane(&plane, p, cag_scaled(column(&t, 2), sign), size);
  }
}

// The tolerance for planarity is relative to the longer diagonal.
static void kites_are_as_flat_as_they_are_long(void **state) {
  (void)state;
  for (int i = 0; i < 4; i++) {
    CagVec3 p[4] = {{0, 0, 0}, {0.5, -5e-4, 0}, {1, 0, 0}, {0.5, 5e-4, 0}}, q[4];
    CagTransform plane;
    for (int high = 0; high < 2; high++) {
      p[3].z = high ? 1e-11 : 1e-13;
      for (int k = 0; k < 4; k++) q[k] = p[(k + i) % 4];
      assert_int_equal(is_flat(q, &plane), !high);
    }
  }
}

static void squares_lie_along_their_first_edges(void **state) {
  (void)state;
  CagVec3 p[4] = {{3, 3, 0}, {5, 3, 0}, {5, 5, 0}, {3, 5, 0}};
  for (int i = 0; i < 4; i++) {
    CagTransform plane;
    assert_true(is_flat(p, &plane));
    check_plane(&plane, p, cag_vec3(0, 0, 1), 5);
    const CagVec3 first = p[0];
    for (int k = 0; k < 3; k++) p[k] = p[k + 1];
    p[3] = first;
  }
}

static void patches_without_area_are_no_flat_faces(void **state) {
  (void)state;
  static const CagVec3 cases[][4] = {
      {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {2, 0, 0}},         // collinear
      {{0, 0, 0}, {1, 2, 0}, {0, 0, 0}, {1, 2, 0}},         // folded onto itself
      {{0, 0, 0}, {1, 0, 0}, {1, 1e-13, 0}, {0, 1e-13, 0}}, // narrower than rounding
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    CagTransform plane;
    assert_false(is_flat(cases[i], &plane));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(flat_faces_are_convex),
      cmocka_unit_test(triangles_are_flat_faces),
      cmocka_unit_test(kites_are_as_flat_as_they_are_long),
      cmocka_unit_test(squares_lie_along_their_first_edges),
      cmocka_unit_test(patches_without_area_are_no_flat_faces),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
