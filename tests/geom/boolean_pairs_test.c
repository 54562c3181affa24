// The selection of pairs of faces for set operations, compared with all pairs.

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "geom/boolean/work.h"
#include "tests/geom/random.h"

static int whole(int low, int high) { return low + (int)uniform(0, high - low + 1); }

#define MOST 90

typedef struct Seen {
  int pairs[MOST][MOST];
  int single[MOST];
  size_t calls, last; // the call that fails; 0: none
} Seen;

static bool see_pair(void *context, uint32_t f, uint32_t g) {
  Seen *s = context;
  s->pairs[f][g]++;
  return ++s->calls != s->last;
}

static bool see_face(void *context, uint32_t f) {
  ((Seen *)context)->single[f]++;
  return true;
}

static BoolWork work;
static CagError err;

static void start(size_t n, int side, double slack) {
  work = (BoolWork){.err = &err, .slack = slack};
  assert_true(cag_bool_points_start(&work.points, 3 * n));
  work.faces = calloc(n + 1, sizeof *work.faces);
  work.face_count = n;
  for (size_t i = 0; i < n; i++) {
    const int x = whole(0, side), y = whole(0, side), z = whole(0, side);
    for (int k = 0; k < 3; k++) {
      const int dx = whole(-1, 1), dy = whole(-1, 1), dz = whole(-1, 1);
      work.faces[i].v[k] = cag_bool_points_add(&work.points, cag_vec3(x + dx, y + dy, z + dz));
    }
  }
  work.corners = work.points.n;
}

static void stop(void) {
  cag_bool_points_free(&work.points);
  cag_bool_forget_pairs(&work);
  free(work.faces);
}

static CagBounds box_of(size_t face) {
  CagBounds box = CAG_BOUNDS_EMPTY;
  for (int k = 0; k < 3; k++) cag_bounds_add(&box, work.points.at[work.faces[face].v[k]]);
  return box;
}

// Sees the faces whose boxes the ray from a point along x meets.
static void see_ahead(CagVec3 from, Seen *seen) {
  CagBounds ahead = {from, from};
  ahead.max.x = INFINITY;
  assert_true(cag_box_tree_meeting(&work.tree, &ahead, see_face, seen));
}

// Boxes within twice the slack are reported as a pair, once. With integer coordinates, many are
// exactly at this distance.
static void pairs_are_those_whose_boxes_are_near(void **state) {
  (void)state;
  static Seen seen;
  seed = 6;
  for (int trial = 0; trial < 60; trial++) {
    const size_t n = trial < 10 ? (size_t)trial : (size_t)whole(10, MOST);
    const double slack = trial % 3 * 0.5;
    start(n, whole(1, 12), slack);
    for (int round = 0; round < 2; round++) { // the tree is kept for the second
      memset(&seen, 0, sizeof seen);
      assert_int_equal(cag_bool_visit_pairs(&work, see_pair, &seen), CAG_OK);
      for (size_t f = 0; f < n; f++)
        for (size_t g = 0; g <= f; g++) {
          const CagBounds a = box_of(f), b = box_of(g);
          const double off = 2 * slack;
          const bool near = a.min.x <= b.max.x + off && b.min.x <= a.max.x + off &&
                            a.min.y <= b.max.y + off && b.min.y <= a.max.y + off &&
                            a.min.z <= b.max.z + off && b.min.z <= a.max.z + off;
          assert_int_equal(seen.pairs[f][g] + (f == g ? 0 : seen.pairs[g][f]), near && f != g);
        }
    }
    // A ray along x meets all faces whose boxes, with the slack, it meets, each once.
    for (int i = 0; i < 30 && n > 0; i++) {
      const CagVec3 from = {whole(-2, 13), whole(-2, 13), whole(-2, 13)};
      memset(&seen, 0, sizeof seen);
      see_ahead(from, &seen);
      for (size_t f = 0; f < n; f++) {
        const CagBounds b = box_of(f);
        const bool meets = b.max.x + slack >= from.x && b.min.y - slack <= from.y &&
                           b.max.y + slack >= from.y && b.min.z - slack <= from.z &&
                           b.max.z + slack >= from.z;
        assert_true(seen.single[f] == meets);
      }
    }
    stop();
  }
}

// A ray beside all boxes meets none.
static void far_rays_meet_nothing(void **state) {
  (void)state;
  static Seen seen;
  seed = 7;
  start(MOST, 5, 0);
  memset(&seen, 0, sizeof seen);
  assert_int_equal(cag_bool_visit_pairs(&work, see_pair, &seen), CAG_OK);
  static const double FROM[5][3] = {
      {6.5, 2, 2}, {-9, -1.5, 2}, {-9, 6.5, 2}, {-9, 2, -1.5}, {-9, 2, 6.5}};
  for (int i = 0; i < 5; i++) see_ahead(cag_vec3(FROM[i][0], FROM[i][1], FROM[i][2]), &seen);
  for (int f = 0; f < MOST; f++) assert_int_equal(seen.single[f], 0);
  stop();
}

// The first failure or a request to stop ends the search.
static void searches_end(void **state) {
  (void)state;
  static Seen seen;
  seed = 8;
  start(MOST, 3, 0);
  for (size_t last = 1; last < 40; last++) {
    memset(&seen, 0, sizeof seen);
    seen.last = last;
    assert_int_equal(cag_bool_visit_pairs(&work, see_pair, &seen), CAG_E_MEMORY);
    assert_int_equal(seen.calls, last);
  }
  const volatile int now = 1;
  work.interrupt = &now;
  memset(&seen, 0, sizeof seen);
  assert_int_equal(cag_bool_visit_pairs(&work, see_pair, &seen), CAG_E_CALLBACK);
  assert_int_equal(seen.calls, 0);
  stop();
}

// Points in the plane of a face, on a grid: inside, on its edges, and outside.
static void points_in_faces(void **state) {
  (void)state;
  seed = 9;
  for (int trial = 0; trial < 60; trial++) {
    long p[3][2];
    const int axis = trial % 3;
    BoolFace f = {.axis = (signed char)axis};
    work = (BoolWork){.err = &err};
    assert_true(cag_bool_points_start(&work.points, 9));
    double at[3];
    for (int k = 0; k < 3; k++) {
      p[k][0] = whole(-3, 3);
      p[k][1] = whole(-3, 3);
      at[axis] = (double)(p[k][0] - p[k][1]);
      at[(axis + 1) % 3] = (double)p[k][0];
      at[(axis + 2) % 3] = (double)p[k][1];
      f.v[k] = cag_bool_points_add(&work.points, cag_vec3(at[0], at[1], at[2]));
    }
    const long area =
        (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
    f.sign = (signed char)((area > 0) - (area < 0));
    for (int x = -4; x <= 4 && area != 0; x++)
      for (int y = -4; y <= 4; y++) {
        bool in = true;
        for (int k = 0; k < 3; k++) {
          const long *a = p[k], *b = p[(k + 1) % 3];
          in = in && ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) * f.sign >= 0;
        }
        at[axis] = x - y;
        at[(axis + 1) % 3] = x;
        at[(axis + 2) % 3] = y;
        const uint32_t v = cag_bool_points_add(&work.points, cag_vec3(at[0], at[1], at[2]));
        assert_int_equal(cag_bool_is_in_face(&work, &f, v), in);
      }
    cag_bool_points_free(&work.points);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pairs_are_those_whose_boxes_are_near),
      cmocka_unit_test(far_rays_meet_nothing),
      cmocka_unit_test(searches_end),
      cmocka_unit_test(points_in_faces),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
