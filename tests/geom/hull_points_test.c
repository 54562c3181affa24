// Convex hulls of few points, compared with a search over all lines and planes through them. The
// points have integer coordinates, so that every predicate is exact. Rotated and translated points
// have the same hulls. Points that are almost coplanar, up to rounding, have a closed hull, too.

#include "geom/linalg/transform.h"
#include "geom/mesh/hull.h"
#include "random_point.h"
#include "support.h"

enum { MOST = 24 };

static int whole(int least, int most) {
  return (int)fmin(most, floor(uniform(least, (double)most + 1)));
}

static CagTransform random_motion(void) {
  CagTransform turn;
  const double x = uniform(-1, 1), y = uniform(-1, 1);
  const CagVec3 axis = cag_vec3(x, y, uniform(0.1, 1)), center = random_point(5);
  OK(cag_rotate(axis, uniform(-3, 3), center, &turn, &err));
  return turn;
}

static double triple(CagVec3 a, CagVec3 b, CagVec3 c) { return cag_dot(a, cag_cross(b, c)); }

// --- The plane ---

static double turn_of(CagVec3 a, CagVec3 b, CagVec3 c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

static bool is_same_point(CagVec3 a, CagVec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

// Whether b is the corner after a: no point is to the right of the line, and no point on the line
// is beyond b or before a.
static bool is_side(const CagVec3 *p, int n, CagVec3 a, CagVec3 b) {
  for (int i = 0; i < n; i++) {
    const double turn = turn_of(a, b, p[i]);
    const double along = cag_dot(cag_sub(b, a), cag_sub(p[i], a)),
                 length = cag_dot(cag_sub(b, a), cag_sub(b, a));
    if (turn < 0 || (turn == 0 && (along < 0 || along > length))) return false;
  }
  return !is_same_point(a, b);
}

// Finds the corners counter-clockwise from the lowest x, and the lowest y among these. Returns 0 if
// all points are collinear.
static int corners_of(const CagVec3 *p, int n, CagVec3 *ring) {
  int count = 0;
  bool flat = true;
  for (int i = 2; i < n; i++)
    for (int j = 1; j < i; j++) flat &= turn_of(p[0], p[j], p[i]) == 0;
  if (flat) return 0;
  ring[count++] = p[0];
  for (int i = 1; i < n; i++)
    if (p[i].x < ring[0].x || (p[i].x == ring[0].x && p[i].y < ring[0].y)) ring[0] = p[i];
  for (int i = 0; i < n; i++)
    if (is_side(p, n, ring[count - 1], p[i])) {
      if (is_same_point(p[i], ring[0])) break;
      ring[count++] = p[i];
      i = -1;
    }
  return count;
}

static void corners_in_the_plane_are_those_of_all_lines_through_two_points(void **state) {
  (void)state;
  seed = 1;
  int flat = 0;
  for (int round = 0; round < 1000; round++) {
    CagVec3 p[MOST], expected[MOST];
    const int n = whole(3, MOST), size = whole(1, 9);
    const double angle = uniform(-3, 3), c = cos(angle), s = sin(angle);
    const CagVec3 shift = {uniform(-5, 5), uniform(-5, 5), 0};
    for (int i = 0; i < n; i++) {
      const int x = whole(-size, size), y = whole(-size, size);
      p[i] = cag_vec3(x, y, 0);
    }
    if (round % 10 == 0)
      for (int i = 0; i < n; i++) p[i].y = 2 * p[i].x;
    const int count = corners_of(p, n, expected);
    flat += count == 0;
    for (int turned = 0; turned < 2; turned++) {
      size_t *ring, got, first = 0;
      CagVec3 q[MOST];
      for (int i = 0; i < n; i++)
        q[i] = turned ? cag_vec3(c * p[i].x - s * p[i].y + shift.x,
                                 s * p[i].x + c * p[i].y + shift.y, 0)
                      : p[i];
      if (count == 0) {
        assert_int_not_equal(cag_hull_plane(q, (size_t)n, &ring, &got, &err), CAG_OK);
        continue;
      }
      OK(cag_hull_plane(q, (size_t)n, &ring, &got, &err));
      assert_int_equal(got, count);
      for (size_t k = 0; k < got; k++) assert_true(q[ring[k]].x >= q[ring[0]].x);
      while (turned && first < got && !is_same_point(p[ring[first]], expected[0])) first++;
      for (size_t k = 0; k < got; k++) near_vec(p[ring[(first + k) % got]], expected[k], 0);
      free(ring);
    }
  }
  assert_true(flat >= 100);
}

// --- Space ---

// The planes of the faces, each once: outward normals and offsets.
typedef struct Planes {
  CagVec3 normal[2 * MOST];
  double offset[2 * MOST];
  int count;
} Planes;

static void add_plane(Planes *planes, const CagVec3 *p, int n, int a, int b, int c) {
  CagVec3 normal = cag_cross(cag_sub(p[b], p[a]), cag_sub(p[c], p[a]));
  bool above = false, below = false;
  for (int i = 0; i < n; i++) {
    const double side = cag_dot(normal, cag_sub(p[i], p[a]));
    above |= side > 0;
    below |= side < 0;
  }
  if (above == below) return; // points on both sides, or a zero normal
  if (above) normal = cag_scaled(normal, -1);
  const double offset = cag_dot(normal, p[a]);
  for (int k = 0; k < planes->count; k++) {
    const CagVec3 other = planes->normal[k];
    if (cag_norm(cag_cross(normal, other)) == 0 && cag_dot(normal, other) > 0) return;
  }
  assert_true(planes->count < 2 * MOST);
  planes->normal[planes->count] = normal;
  planes->offset[planes->count++] = offset;
}

static Planes planes_of(const CagVec3 *p, int n) {
  Planes planes = {.count = 0};
  for (int a = 0; a < n; a++)
    for (int b = a + 1; b < n; b++)
      for (int c = b + 1; c < n; c++) add_plane(&planes, p, n, a, b, c);
  return planes;
}

// A point is a corner if it is the only common point of its faces.
static bool is_corner(const Planes *planes, CagVec3 p) {
  double best = 0;
  int at[2 * MOST], n = 0;
  for (int k = 0; k < planes->count; k++)
    if (cag_dot(planes->normal[k], p) == planes->offset[k]) at[n++] = k;
  for (int i = 2; i < n; i++)
    for (int j = 1; j < i; j++)
      best = fmax(
          best, fabs(triple(planes->normal[at[0]], planes->normal[at[j]], planes->normal[at[i]])));
  return best > 0;
}

static double volume_of(const CagMesh *m) {
  double volume = 0;
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    const CagVec3 o = m->positions[0];
    volume += triple(cag_sub(m->positions[k[0]], o), cag_sub(m->positions[k[1]], o),
                     cag_sub(m->positions[k[2]], o)) /
              6;
  }
  return volume;
}

// Checks that the mesh is closed, is a topological sphere, and has the extent of the points in
// every direction.
static void check_body(const CagMesh *m, const CagVec3 *p, int n, double slack) {
  CagVec3 edge[2];
  assert_true(cag_mesh_is_watertight(m, edge));
  assert_true(!m->normals && !m->uv && !m->weld);
  assert_int_equal(cag_mesh_euler_characteristic(m), 2);
  for (int k = 0; k < 40; k++) {
    const CagVec3 d = random_point(1);
    double most = -INFINITY, reached = -INFINITY;
    for (int i = 0; i < n; i++) most = fmax(most, cag_dot(d, p[i]));
    for (size_t i = 0; i < m->vertex_count; i++)
      reached = fmax(reached, cag_dot(d, m->positions[i]));
    NEAR(reached, most, slack);
  }
}

static void corners_in_space_are_those_of_all_planes_through_three_points(void **state) {
  (void)state;
  seed = 2;
  int bodies = 0;
  for (int round = 0; round < 400; round++) {
    CagVec3 p[MOST];
    const int n = whole(4, MOST), size = whole(1, 3);
    for (int i = 0; i < n; i++) {
      const int x = whole(-size, size), y = whole(-size, size), z = whole(-size, size);
      p[i] = cag_vec3(x, y, z);
    }
    if (round % 10 == 0)
      for (int i = 0; i < n; i++) p[i].z = p[i].x - 2 * p[i].y;
    const Planes planes = planes_of(p, n);
    const CagTransform turn = random_motion();
    int corners = 0;
    double volume = 0;
    for (int i = 0; i < n; i++) {
      bool again = false;
      for (int j = 0; j < i; j++) again |= is_same_point(p[i], p[j]);
      corners += !again && is_corner(&planes, p[i]);
    }
    for (int turned = 0; turned < 2; turned++) {
      CagVec3 q[MOST];
      CagMesh *m;
      for (int i = 0; i < n; i++) q[i] = turned ? cag_transform_point(&turn, p[i]) : p[i];
      if (corners == 0) {
        assert_int_not_equal(cag_hull_space(q, (size_t)n, &m, &err), CAG_OK);
        continue;
      }
      OK(cag_hull_space(q, (size_t)n, &m, &err));
      assert_int_equal(m->vertex_count, corners);
      assert_int_equal(m->triangle_count, 2 * corners - 4); // Euler
      check_body(m, q, n, 1e-13);
      if (turned) {
        NEAR(volume_of(m), volume, 1e-12);
      } else {
        volume = volume_of(m);
        assert_true(volume > 0);
        for (size_t t = 0; t < m->triangle_count; t++) { // each is part of a face
          const uint32_t *k = m->triangles + 3 * t;
          const CagVec3 a = m->positions[k[0]], b = m->positions[k[1]], c = m->positions[k[2]];
          const CagVec3 normal = cag_cross(cag_sub(b, a), cag_sub(c, a));
          int within = 0;
          for (int f = 0; f < planes.count; f++)
            within += cag_norm(cag_cross(normal, planes.normal[f])) == 0 &&
                      cag_dot(normal, planes.normal[f]) > 0 &&
                      cag_dot(planes.normal[f], a) == planes.offset[f];
          assert_int_equal(within, 1);
        }
        bodies++;
      }
      cag_mesh_release(m);
    }
  }
  assert_true(bodies > 200);
}

static void bodies_as_thin_as_rounding_are_closed_and_hold_all_points(void **state) {
  (void)state;
  seed = 3;
  int flat = 0, rounds = 20000;
  for (int round = 0; round < rounds; round++) {
    CagVec3 p[MOST];
    CagMesh *m;
    const int n = whole(4, MOST), size = whole(1, 4);
    const CagTransform turn = random_motion();
    const double off = exp(uniform(log(1e-17), log(1e-13)));
    for (int i = 0; i < n; i++) {
      const double x = whole(-size, size), y = round % 2 ? whole(-size, size) : uniform(-1, 1);
      p[i] = cag_transform_point(&turn, cag_vec3(x, y, 0));
      p[i].z += uniform(-off, off);
    }
    if (cag_hull_space(p, (size_t)n, &m, &err) != CAG_OK) {
      flat++;
      continue;
    }
    check_body(m, p, n, 1e-13);
    cag_mesh_release(m);
  }
  assert_true(flat > rounds / 10 && flat < 9 * rounds / 10);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(corners_in_the_plane_are_those_of_all_lines_through_two_points),
      cmocka_unit_test(corners_in_space_are_those_of_all_planes_through_three_points),
      cmocka_unit_test(bodies_as_thin_as_rounding_are_closed_and_hold_all_points),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
