// Regions: orientation, holes, measures, and points inside.

#include "geom/curve/region.h"
#include "support.h"

static CagCurve *circle(double r, double x, double y) {
  CagTransform frame = cag_translate(cag_vec3(x, y, 0));
  frame.planar = true;
  CagCurve *c;
  OK(cag_curve_arc(r, r, 0, 2 * M_PI, &frame, &c, &err));
  return c;
}

static CagCurve *square(double half, double x, double y, bool clockwise) {
  CagVec3 p[4] = {{x - half, y - half, 0},
                  {x + half, y - half, 0},
                  {x + half, y + half, 0},
                  {x - half, y + half, 0}};
  if (clockwise) {
    CagVec3 q = p[1];
    p[1] = p[3];
    p[3] = q;
  }
  CagCurve *c;
  OK(cag_curve_polyline(p, 4, true, 2, &c, &err));
  return c;
}

static bool contains(const CagRegion *r, double x, double y) {
  bool in;
  OK(cag_region_contains(r, cag_vec3(x, y, 0), &in, &err));
  return in;
}

static void holes_take_their_area_away(void **state) {
  (void)state;
  CagCurve *outer = square(5, 0, 0, true), *hole = circle(2, 1, 0);
  CagRegion *r;
  double area, length;
  CagVec3 centroid;
  OK(cag_region_new(outer, &hole, 1, &r, &err));
  OK(cag_region_area(r, &area, &centroid, &err));
  NEAR(area, 100 - 4 * M_PI, 1e-11);
  NEAR(centroid.x, -4 * M_PI / (100 - 4 * M_PI), 1e-12);
  OK(cag_region_perimeter(r, &length, &err));
  NEAR(length, 40 + 4 * M_PI, 1e-12);
  assert_true(r->outer[0] == 0 && r->outer[1] == 0);
  double a;
  OK(cag_curve_area(r->loops[0], &a, NULL, &err));
  assert_true(a > 0);
  OK(cag_curve_area(r->loops[1], &a, NULL, &err));
  assert_true(a < 0);
  assert_true(contains(r, -4, 4) && !contains(r, 1, 0) && !contains(r, 6, 0));
  assert_true(contains(r, 3, 0) && contains(r, 5, 5) && contains(r, -5, 0)); // boundary
  assert_true(!contains(r, 3 - 1e-6, 0) && contains(r, 3 + 1e-6, 0));
  assert_true(!contains(r, 5 + 1e-6, 0));
  cag_region_release(r);
  cag_curve_release(outer);
  cag_curve_release(hole);
}

static void bad_holes_are_named(void **state) {
  (void)state;
  CagCurve *outer = square(5, 0, 0, false), *open, *bow;
  CagCurve *in = circle(1, 0, 0), *out = circle(1, 20, 0), *across = circle(2, 5, 0);
  CagCurve *near = circle(1, 1.5, 0), *within = circle(0.5, 0, 0);
  CagRegion *r;
  CagCurve *const pair[2] = {in, out}, *const overlap[2] = {in, near},
                  *const nested[2] = {in, within};
  FAILS_AT(cag_region_new(outer, pair, 2, &r, &err), "hole-outside", 1);
  FAILS_AT(cag_region_new(outer, &across, 1, &r, &err), "region-crossing", 0);
  FAILS_AT(cag_region_new(outer, overlap, 2, &r, &err), "region-crossing", 1);
  FAILS_AT(cag_region_new(outer, nested, 2, &r, &err), "region-crossing", 1);
  CagCurve *const twice[2] = {in, in};
  FAILS_AT(cag_region_new(outer, twice, 2, &r, &err), "region-crossing", 1); // the second
  assert_string_equal(err.message, "holes[0] and holes[1] are one curve; leave one of them out");
  FAILS_AT(cag_region_new(outer, &outer, 1, &r, &err), "hole-outside", 0);
  OK(cag_curve_line(cag_vec3(0, 0, 0), cag_vec3(1, 0, 0), 2, &open, &err));
  FAILS(cag_region_new(open, NULL, 0, &r, &err), "region-not-closed");
  FAILS_AT(cag_region_new(outer, &open, 1, &r, &err), "region-not-closed", 0);
  static const CagVec3 eight[4] = {{0, 0, 0}, {2, 1, 0}, {2, 0, 0}, {0, 2, 0}};
  OK(cag_curve_polyline(eight, 4, true, 2, &bow, &err));
  FAILS(cag_region_new(bow, NULL, 0, &r, &err), "region-crossing");
  CagCurve *all[8] = {outer, in, out, across, near, within, open, bow};
  for (int i = 0; i < 8; i++) cag_curve_release(all[i]);
}

static void crossings_are_told_where_they_are(void **state) {
  (void)state;
  // y = x / 5 and y = (100 - x) 1.02 / 94.9 cross where both are 1.02.
  static const CagVec3 p[4] = {{0, 0, 0}, {100, 20, 0}, {100, 0, 0}, {0, 102.0 / 94.9, 0}};
  CagCurve *c;
  CagRegion *r;
  OK(cag_curve_polyline(p, 4, true, 2, &c, &err));
  FAILS(cag_region_new(c, NULL, 0, &r, &err), "region-crossing");
  assert_non_null(strstr(err.message, "near [5.1, 1.02]"));
  cag_curve_release(c);
}

// --- Holes and loops that share edges: rectangles of a grid, counted by its cells ---

enum { GRID = 6, CELLS = GRID * GRID };

typedef struct Rectangle {
  int x0, y0, x1, y1;
} Rectangle;

static unsigned random_below(unsigned n) {
  static uint64_t state = 7;
  state = state * 6364136223846793005u + 1442695040888963407u;
  return (unsigned)((state >> 33) % n);
}

static Rectangle random_rectangle(void) {
  const int x = (int)random_below(GRID), y = (int)random_below(GRID);
  return (Rectangle){x, y, x + 1 + (int)random_below((unsigned)(GRID - x)),
                     y + 1 + (int)random_below((unsigned)(GRID - y))};
}

static bool has_cell(const Rectangle *r, int cell) {
  const int x = cell % GRID, y = cell / GRID;
  return x >= r->x0 && x < r->x1 && y >= r->y0 && y < r->y1;
}

static CagCurve *turned_rectangle(const Rectangle *r, double angle) {
  CagVec3 p[4] = {{r->x0, r->y0, 0}, {r->x1, r->y0, 0}, {r->x1, r->y1, 0}, {r->x0, r->y1, 0}};
  for (int i = 0; i < 4; i++)
    p[i] = cag_vec3(p[i].x * cos(angle) - p[i].y * sin(angle),
                    p[i].x * sin(angle) + p[i].y * cos(angle), 0);
  CagCurve *c;
  OK(cag_curve_polyline(p, 4, true, 2, &c, &err));
  return c;
}

// How the cells of two rectangles lie to each other.
typedef struct Cells {
  int common, first, second; // in both; in the first or the second only
} Cells;

static Cells compare_cells(const Rectangle *a, const Rectangle *b) {
  Cells c = {0, 0, 0};
  for (int i = 0; i < CELLS; i++) {
    const bool in_a = has_cell(a, i), in_b = has_cell(b, i);
    c.common += in_a && in_b;
    c.first += in_a && !in_b;
    c.second += in_b && !in_a;
  }
  return c;
}

static void loops_that_overlap_are_refused_and_others_measured(void **state) {
  (void)state;
  int holes = 0, loops = 0;
  for (int i = 0; i < 2000; i++) {
    const double angle = i % 2 ? i * 0.01 : 0;
    Rectangle r[3] = {{0, 0, GRID, GRID}, random_rectangle(), random_rectangle()};
    if (i % 3 == 0) r[0] = random_rectangle();
    if (i % 5 == 0) r[2] = r[1];
    const Cells one = compare_cells(&r[0], &r[1]), two = compare_cells(&r[0], &r[2]),
                both = compare_cells(&r[1], &r[2]);
    CagCurve *c[3];
    CagRegion *made;
    double area;
    for (int k = 0; k < 3; k++) c[k] = turned_rectangle(&r[k], angle);
    const bool good =
        one.second == 0 && two.second == 0 && both.common == 0 && one.first > 0 && two.first > 0;
    if (good) {
      OK(cag_region_new(c[0], c + 1, 2, &made, &err));
      OK(cag_region_area(made, &area, NULL, &err));
      NEAR(area, one.common + one.first - one.common - two.common, 1e-11);
      cag_region_release(made);
      holes++;
    } else {
      assert_int_not_equal(cag_region_new(c[0], c + 1, 2, &made, &err), CAG_OK);
    }
    if (both.common == 0 || (both.first == 0) != (both.second == 0)) {
      OK(cag_region_from_loops(c + 1, 2, &made, &err));
      OK(cag_region_area(made, &area, NULL, &err));
      NEAR(area, both.first + both.second, 1e-11);
      cag_region_release(made);
      loops++;
    } else {
      FAILS_AT(cag_region_from_loops(c + 1, 2, &made, &err), "region-crossing", 1);
    }
    for (int k = 0; k < 3; k++) cag_curve_release(c[k]);
  }
  assert_true(holes > 100 && loops > 500); // both happen
}

// A square in a ring in a square: even depths are outer loops.
static void loops_nest_by_the_even_odd_rule(void **state) {
  (void)state;
  CagCurve *loops[4] = {square(1, 0, 0, false), circle(2, 0, 0), square(3, 0, 0, true),
                        circle(1, 10, 0)};
  CagRegion *r;
  double area;
  OK(cag_region_from_loops(loops, 4, &r, &err));
  assert_int_equal(r->count, 4);
  OK(cag_region_area(r, &area, NULL, &err));
  NEAR(area, 4 + (36 - 4 * M_PI) + M_PI, 1e-11);
  assert_true(contains(r, 0, 0) && !contains(r, 1.5, 0) && contains(r, 2.5, 0) &&
              contains(r, 10, 0));
  int holes = 0;
  for (size_t i = 0; i < 4; i++) holes += r->outer[i] != i;
  assert_int_equal(holes, 1);
  cag_region_release(r);
  for (int i = 0; i < 4; i++) cag_curve_release(loops[i]);
}

static void rounded_rectangles_are_exact(void **state) {
  (void)state;
  CagRegion *r;
  double area, length;
  CagBounds b;
  OK(cag_region_rectangle(10, 6, 2, &r, &err));
  OK(cag_region_area(r, &area, NULL, &err));
  NEAR(area, 60 - (4 - M_PI) * 4, 1e-11);
  OK(cag_region_perimeter(r, &length, &err));
  NEAR(length, 2 * (6 + 2) + 4 * M_PI, 1e-12);
  OK(cag_region_bounds(r, &b, &err));
  near_vec(b.min, cag_vec3(-5, -3, 0), 1e-14);
  near_vec(b.max, cag_vec3(5, 3, 0), 1e-14);
  assert_true(contains(r, 5, 1) && !contains(r, 5, 3) && contains(r, 4.4, 2.4) &&
              !contains(r, 4.5, 2.5));
  cag_region_release(r);
  OK(cag_region_rectangle(4, 2, 1, &r, &err)); // a stadium: the short sides are gone
  OK(cag_region_area(r, &area, NULL, &err));
  NEAR(area, 4 + M_PI, 1e-12);
  cag_region_release(r);
  OK(cag_region_rectangle(2, 2, 1, &r, &err));
  assert_string_equal(r->loops[0]->kind->name, "circle");
  cag_region_release(r);
  FAILS(cag_region_rectangle(4, 2, 1.5, &r, &err), "radius-too-large");
  FAILS(cag_region_rectangle(0, 2, 0, &r, &err), "size-not-positive");
}

// A regular n-gon of radius r has the area n r^2 sin(2 pi / n) / 2.
static void regular_polygons_have_their_area(void **state) {
  (void)state;
  CagRegion *r;
  double area;
  for (size_t n = 3; n < 20; n++) {
    OK(cag_region_regular_polygon(n, 2, &r, &err));
    OK(cag_region_area(r, &area, NULL, &err));
    NEAR(area, 2 * (double)n * sin(2 * M_PI / (double)n), 1e-13);
    cag_region_release(r);
  }
  FAILS(cag_region_regular_polygon(2, 1, &r, &err), "too-few-points");
}

static void mirrors_keep_the_orientation(void **state) {
  (void)state;
  CagCurve *outer = square(5, 0, 0, false), *hole = circle(2, 1, 0);
  CagRegion *r, *image;
  CagTransform mirror;
  double area, a;
  OK(cag_region_new(outer, &hole, 1, &r, &err));
  OK(cag_reflect_line(cag_vec3(0, 0, 0), cag_vec3(1, 2, 0), &mirror, &err));
  OK(cag_region_transform(r, &mirror, &image, &err));
  OK(cag_region_area(image, &area, NULL, &err));
  NEAR(area, 100 - 4 * M_PI, 1e-11);
  OK(cag_curve_area(image->loops[0], &a, NULL, &err));
  assert_true(a > 0);
  cag_region_release(image);
  CagTransform lift = cag_translate(cag_vec3(0, 0, 1));
  FAILS(cag_region_transform(r, &lift, &image, &err), "not-planar");
  cag_region_release(r);
  cag_curve_release(outer);
  cag_curve_release(hole);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(holes_take_their_area_away),
      cmocka_unit_test(bad_holes_are_named),
      cmocka_unit_test(crossings_are_told_where_they_are),
      cmocka_unit_test(loops_that_overlap_are_refused_and_others_measured),
      cmocka_unit_test(loops_nest_by_the_even_odd_rule),
      cmocka_unit_test(rounded_rectangles_are_exact),
      cmocka_unit_test(regular_polygons_have_their_area),
      cmocka_unit_test(mirrors_keep_the_orientation),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
