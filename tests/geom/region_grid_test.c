// Loops along the lines of a small grid, which often touch and have common edges, compared with
// sets of cells.

#include "geom/curve/region.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

enum { SIDE = 6, CELLS = SIDE * SIDE, MOST = 3 };

typedef struct Shape {
  CagCurve *loop;
  bool cells[CELLS];
} Shape;

static int whole(int low, int high) { return (int)floor(uniform(low, high)); }

// A rectangle, possibly without one of its corners, of any orientation and start.
static Shape random_shape(int least) {
  Shape s = {.loop = NULL};
  const int w = whole(least, SIDE + 1), h = whole(least, SIDE + 1);
  const int x = whole(0, SIDE - w + 1), y = whole(0, SIDE - h + 1);
  const int a = w > 1 ? whole(1, w) : 0, b = h > 1 ? whole(1, h) : 0;
  const bool notched = a > 0 && b > 0 && uniform(0, 1) < 0.6;
  const bool flip_x = uniform(0, 1) < 0.5, flip_y = uniform(0, 1) < 0.5;
  // The corner [a..w] x [b..h] is missing, before it is flipped.
  const int notch[6][2] = {{0, 0}, {w, 0}, {w, b}, {a, b}, {a, h}, {0, h}};
  const int plain[4][2] = {{0, 0}, {w, 0}, {w, h}, {0, h}};
  const int n = notched ? 6 : 4, first = whole(0, n), sense = uniform(0, 1) < 0.5 ? 1 : n - 1;
  CagVec3 p[6];
  for (int i = 0; i < n; i++) {
    const int *corner = notched ? notch[(first + i * sense) % n] : plain[(first + i * sense) % n];
    p[i] = cag_vec3(x + (flip_x ? w - corner[0] : corner[0]),
                    y + (flip_y ? h - corner[1] : corner[1]), 0);
  }
  for (int i = 0; i < w; i++)
    for (int k = 0; k < h; k++)
      if (!notched || i < a || k < b)
        s.cells[(x + (flip_x ? w - 1 - i : i)) + SIDE * (y + (flip_y ? h - 1 - k : k))] = true;
  OK(cag_curve_polyline(p, (size_t)n, true, 2, &s.loop, &err));
  return s;
}

typedef struct Relation {
  bool common, of_a, of_b; // cells of both, of the first alone, of the second alone
} Relation;

static Relation relation_of(const Shape *a, const Shape *b) {
  Relation r = {false, false, false};
  for (int i = 0; i < CELLS; i++) {
    r.common = r.common || (a->cells[i] && b->cells[i]);
    r.of_a = r.of_a || (a->cells[i] && !b->cells[i]);
    r.of_b = r.of_b || (b->cells[i] && !a->cells[i]);
  }
  return r;
}

// The region contains the cells that are in an odd number of shapes.
static void check_cells(const CagRegion *r, const Shape *shapes, size_t n) {
  double area, expected = 0;
  for (int i = 0; i < CELLS; i++) {
    bool odd = false, in;
    for (size_t k = 0; k < n; k++) odd ^= shapes[k].cells[i];
    expected += odd;
    OK(cag_region_contains(r, cag_vec3(i % SIDE + 0.5, i / SIDE + 0.4, 0), &in, &err));
    assert_int_equal(in, odd);
  }
  OK(cag_region_area(r, &area, NULL, &err));
  NEAR(area, expected, 1e-12);
}

static void loops_must_be_nested_or_apart(void **state) {
  (void)state;
  seed = 611;
  int good = 0, bad = 0;
  for (int round = 0; round < 1500; round++) {
    Shape shapes[MOST];
    CagCurve *loops[MOST];
    const size_t n = (size_t)(2 + round % 2);
    bool wrong = false;
    for (size_t i = 0; i < n; i++) {
      shapes[i] = random_shape(1);
      loops[i] = shapes[i].loop;
      for (size_t k = 0; k < i; k++) {
        const Relation r = relation_of(&shapes[k], &shapes[i]);
        wrong = wrong || (r.common && r.of_a == r.of_b);
      }
    }
    CagRegion *r;
    if (wrong) {
      FAILS_AMONG(cag_region_from_loops(loops, n, &r, &err), "region-crossing", 1, (long)n - 1);
      bad++;
    } else {
      OK(cag_region_from_loops(loops, n, &r, &err));
      check_cells(r, shapes, n);
      cag_region_release(r);
      good++;
    }
    for (size_t i = 0; i < n; i++) cag_curve_release(loops[i]);
  }
  assert_true(good > 200 && bad > 200);
}

static void holes_must_be_within_and_apart(void **state) {
  (void)state;
  seed = 612;
  int good = 0, outside = 0, bad = 0;
  for (int round = 0; round < 1500; round++) {
    Shape shapes[MOST];
    CagCurve *holes[MOST];
    const size_t n = (size_t)(1 + round % 2);
    shapes[0] = random_shape(4);
    bool leaves = false, overlap = false;
    for (size_t i = 0; i < n; i++) {
      shapes[1 + i] = random_shape(1);
      holes[i] = shapes[1 + i].loop;
      const Relation r = relation_of(&shapes[0], &shapes[1 + i]);
      leaves = leaves || r.of_b || !r.of_a;
      for (size_t k = 0; k < i; k++)
        overlap = overlap || relation_of(&shapes[1 + k], &shapes[1 + i]).common;
    }
    CagRegion *r;
    if (!leaves && !overlap) {
      OK(cag_region_new(shapes[0].loop, holes, n, &r, &err));
      check_cells(r, shapes, n + 1);
      cag_region_release(r);
      good++;
    } else {
      assert_int_not_equal(cag_region_new(shapes[0].loop, holes, n, &r, &err), CAG_OK);
      const bool crossing = strcmp(cag_error_info(err.id)->reason, "region-crossing") == 0;
      assert_true(crossing ||
                  (leaves && strcmp(cag_error_info(err.id)->reason, "hole-outside") == 0));
      assert_true(err.index >= 0 && err.index < (long)n);
      outside += !crossing;
      bad += crossing;
    }
    for (size_t i = 0; i <= n; i++) cag_curve_release(shapes[i].loop);
  }
  assert_true(good > 50 && outside > 50 && bad > 50);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(loops_must_be_nested_or_apart),
      cmocka_unit_test(holes_must_be_within_and_apart),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
