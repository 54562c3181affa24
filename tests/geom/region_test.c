// Regions: orientation, holes, measures, and containment of points.

#include "geom/curve/region.h"
#include "random.h"
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
  FAILS_AT(cag_region_new(outer, twice, 2, &r, &err), "region-crossing", 1); // the second one
  assert_string_equal(err.message, "holes[0] and holes[1] are the same curve; omit one of them");
  FAILS_AT(cag_region_new(outer, &outer, 1, &r, &err), "hole-outside", 0);
  // After a valid hole.
  CagCurve *const fine = circle(0.5, -4, -4);
  const struct {
    CagCurve *holes[3];
    size_t n;
    long index;
    const char *says;
  } ROWS[] = {
      {{fine, out}, 2, 1, "holes[1] does not lie within the outer boundary"},
      {{fine, across}, 2, 1, "holes[1] crosses the outer boundary near [5, "},
      {{fine, outer}, 2, 1, "holes[1] and the outer boundary are the same curve"},
      {{fine, in, near}, 3, 2, "holes[1] and holes[2] cross near [0.75, "},
      {{fine, in, within}, 3, 2, "holes[1] and holes[2] are nested"},
      {{fine, in, in}, 3, 2, "holes[1] and holes[2] are the same curve"},
  };
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    assert_int_not_equal(cag_region_new(outer, ROWS[i].holes, ROWS[i].n, &r, &err), CAG_OK);
    if (strncmp(err.message, ROWS[i].says, strlen(ROWS[i].says)) != 0) fail_msg("%s", err.message);
    assert_int_equal(err.index, ROWS[i].index);
    assert_string_equal(err.argument, "holes");
  }
  CagCurve *const loops[3] = {fine, in, near};
  FAILS_AT(cag_region_from_loops(loops, 3, &r, &err), "region-crossing", 2);
  assert_non_null(strstr(err.message, "curves[1] and curves[2] cross near [0.75, "));
  cag_curve_release(fine);
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

// --- Holes and loops with common edges: rectangles of a grid, compared with its cells ---

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

// The common and separate cells of two rectangles.
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
  assert_true(holes > 100 && loops > 500); // both occur
}

// A square in a ring in a square: loops at even depths are outer loops.
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
  OK(cag_region_rectangle(4, 2, 1, &r, &err)); // a stadium without short sides
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

// --- Random regions ---

// A star-shaped loop of either orientation: a polygon, a closed spline, or alternating lines and
// arcs.
static CagCurve *random_loop(int kind, CagVec3 center, double low, double high, bool clockwise) {
  enum { POINTS = 8 };
  CagVec3 p[POINTS];
  CagCurve *c, *turned;
  for (int i = 0; i < POINTS; i++) {
    const double r = uniform(low, high), angle = 2 * M_PI * (i + uniform(-0.3, 0.3)) / POINTS;
    p[i] = cag_add(center, cag_vec3(r * cos(angle), r * sin(angle), 0));
  }
  if (kind == 0) OK(cag_curve_polyline(p, POINTS, true, 2, &c, &err));
  if (kind == 1) OK(cag_curve_nurbs_closed(p, NULL, POINTS, 3, 2, &c, &err));
  if (kind == 2) {
    CagCurve *parts[POINTS];
    for (int i = 0; i < POINTS; i++) {
      const CagVec3 q = p[(i + 1) % POINTS],
                    apex = cag_madd(cag_lerp(p[i], q, 0.5), 0.2, cag_sub(p[i], center));
      const CagVec3 bend[3] = {p[i], apex, q};
      if (i % 2) OK(cag_curve_line(p[i], q, 2, &parts[i], &err));
      else OK(cag_curve_bezier(bend, NULL, 3, 2, &parts[i], &err));
    }
    OK(cag_curve_join(parts, POINTS, &c, &err));
    for (int i = 0; i < POINTS; i++) cag_curve_release(parts[i]);
  }
  if (kind == 3) {
    CagTransform f = cag_translate(center);
    const double a = uniform(low, high), b = uniform(low, high), turn = uniform(0, 3);
    f.m[0][0] = f.m[1][1] = cos(turn);
    f.m[1][0] = sin(turn);
    f.m[0][1] = -sin(turn);
    f.planar = true;
    OK(cag_curve_arc(a, b, turn, turn + 2 * M_PI, &f, &c, &err));
  }
  if (!clockwise) return c;
  OK(cag_curve_reverse(c, &turned, &err));
  cag_curve_release(c);
  return turned;
}

enum { DENSE = 4000 };
typedef struct Dense {
  CagVec3 p[DENSE];
} Dense;

static void sample(const CagCurve *c, Dense *out) {
  for (int i = 0; i < DENSE; i++)
    OK(cag_curve_point(c, c->start + (c->end - c->start) * i / DENSE, &out->p[i], &err));
}

// Integrals over a polygon: 1, x, y, x x, x y, y y.
static void add_integrals(const Dense *d, double sign, double out[6]) {
  double sum[6] = {0};
  for (int i = 0; i < DENSE; i++) {
    const CagVec3 a = d->p[i], b = d->p[(i + 1) % DENSE];
    const double cross = a.x * b.y - a.y * b.x;
    sum[0] += cross / 2;
    sum[1] += cross * (a.x + b.x) / 6;
    sum[2] += cross * (a.y + b.y) / 6;
    sum[3] += cross * (a.x * a.x + a.x * b.x + b.x * b.x) / 12;
    sum[4] += cross * (2 * a.x * a.y + a.x * b.y + b.x * a.y + 2 * b.x * b.y) / 24;
    sum[5] += cross * (a.y * a.y + a.y * b.y + b.y * b.y) / 12;
  }
  for (int k = 0; k < 6; k++) out[k] += sum[0] < 0 ? -sign * sum[k] : sign * sum[k];
}

static bool within(const Dense *d, CagVec3 p) {
  bool in = false;
  for (int i = 0; i < DENSE; i++) {
    const CagVec3 a = d->p[i], b = d->p[(i + 1) % DENSE];
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) in = !in;
  }
  return in;
}

static void random_regions_have_the_measures_of_polygons(void **state) {
  (void)state;
  static Dense dense[3];
  seed = 601;
  for (int round = 0; round < 32; round++) {
    const CagVec3 hole_at = {-1.2, 0.3, 0}, other_at = {1.3, -0.2, 0}, origin = {0, 0, 0};
    CagCurve *outer = random_loop(round % 4, origin, 3.5, 5, round % 3 == 0), *holes[2];
    const size_t count = (size_t)(round / 4 % 3);
    holes[0] = random_loop(round / 2 % 4, hole_at, 0.4, 1, round % 2);
    holes[1] = random_loop((round + 1) % 4, other_at, 0.4, 1, round % 3);
    CagRegion *r, *moved;
    OK(cag_region_new(outer, holes, count, &r, &err));
    sample(outer, &dense[0]);
    sample(holes[0], &dense[1]);
    sample(holes[1], &dense[2]);
    double sum[6] = {0}, area, xx, xy, yy, length = 0, whole;
    add_integrals(&dense[0], 1, sum);
    for (size_t i = 0; i < count; i++) add_integrals(&dense[i + 1], -1, sum);
    CagVec3 center, again;
    OK(cag_region_area(r, &area, &center, &err));
    NEAR(area, sum[0], 1e-4);
    near_vec(center, cag_vec3(sum[1] / sum[0], sum[2] / sum[0], 0), 1e-4);
    OK(cag_region_second_moments(r, &area, &again, &xx, &xy, &yy, &err));
    NEAR(area, sum[0], 1e-4);
    near_vec(again, center, 1e-9);
    NEAR(xx, sum[3] - sum[0] * center.x * center.x, 2e-3);
    NEAR(xy, sum[4] - sum[0] * center.x * center.y, 2e-3);
    NEAR(yy, sum[5] - sum[0] * center.y * center.y, 2e-3);
    CagBounds box, seen = CAG_BOUNDS_EMPTY;
    for (size_t k = 0; k <= count; k++)
      for (int i = 0; i < DENSE; i++) {
        length += cag_norm(cag_sub(dense[k].p[(i + 1) % DENSE], dense[k].p[i]));
        if (k == 0) cag_bounds_add(&seen, dense[k].p[i]);
      }
    OK(cag_region_perimeter(r, &whole, &err));
    NEAR(whole, length, 1e-3);
    OK(cag_region_bounds(r, &box, &err));
    near_vec(box.min, seen.min, 1e-4);
    near_vec(box.max, seen.max, 1e-4);
    assert_int_equal(r->count, count + 1);
    for (size_t k = 0; k < r->count; k++) {
      double one;
      OK(cag_curve_area(r->loops[k], &one, NULL, &err));
      assert_true((one > 0) == (k == 0) && r->outer[k] == 0);
    }
    // A reflected and stretched image.
    CagTransform t = cag_transform_identity();
    t.m[0][0] = -2;
    t.m[0][1] = 0.5;
    t.m[0][3] = 3;
    OK(cag_region_transform(r, &t, &moved, &err));
    OK(cag_region_area(moved, &whole, NULL, &err));
    NEAR(whole, 2 * area, 1e-9 * area);
    // Points, some at the heights of vertices.
    for (int i = 0; i < 120; i++) {
      CagVec3 p = {0, 0, 0};
      p.x = uniform(-5.5, 5.5);
      p.y = uniform(-5.5, 5.5);
      if (i % 4 == 0) p.y = dense[i / 4 % 3].p[DENSE / 8 * (i % 7)].y;
      double nearest = INFINITY;
      for (size_t k = 0; k <= count; k++)
        for (int j = 0; j < DENSE; j++)
          nearest = fmin(nearest, cag_norm(cag_sub(p, dense[k].p[j])));
      if (nearest < 0.02) continue;
      bool in = within(&dense[0], p);
      for (size_t k = 0; k < count; k++) in = in && !within(&dense[k + 1], p);
      assert_true(contains(r, p.x, p.y) == in);
      const CagVec3 q = cag_transform_point(&t, p);
      assert_true(contains(moved, q.x, q.y) == in);
    }
    // Points of the boundary are in the region. Points 1e-6 beside it are inside or outside.
    for (int i = 0; i < 20; i++) {
      CagVec3 d[2];
      const double u = outer->start + (outer->end - outer->start) * (i + 0.37) / 20;
      OK(cag_curve_eval(outer, u, 1, CAG_SIDE_RIGHT, d, &err));
      const CagVec3 n = cag_unit(cag_vec3(d[1].y, -d[1].x, 0));
      const double out = round % 3 == 0 ? -1e-6 : 1e-6;
      assert_true(contains(r, d[0].x, d[0].y));
      assert_false(contains(r, d[0].x + out * n.x, d[0].y + out * n.y));
      assert_true(contains(r, d[0].x - out * n.x, d[0].y - out * n.y));
    }
    cag_region_release(moved);
    cag_region_release(r);
    cag_curve_release(outer);
    for (int k = 0; k < 2; k++) cag_curve_release(holes[k]);
  }
}

static void loops_that_cross_are_named(void **state) {
  (void)state;
  CagCurve *outer = square(3, 0, 0, false), *in = square(0.5, 1, 0, false);
  CagCurve *out = square(0.5, 9, 0, false), *across = square(1, 3, 0, true);
  CagCurve *around = square(4, 0, 0, false), *inner = square(0.2, 1, 0, false), *open;
  const CagVec3 p[3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  CagRegion *r;
  OK(cag_curve_polyline(p, 3, false, 2, &open, &err));
  CagCurve *holes[2] = {in, out};
  FAILS_AT(cag_region_new(outer, holes, 2, &r, &err), "hole-outside", 1);
  holes[1] = across;
  assert_int_not_equal(cag_region_new(outer, holes, 2, &r, &err), CAG_OK);
  assert_string_equal(cag_error_info(err.id)->reason, "region-crossing");
  holes[1] = around;
  assert_int_not_equal(cag_region_new(outer, holes, 2, &r, &err), CAG_OK);
  holes[1] = inner;
  assert_int_not_equal(cag_region_new(outer, holes, 2, &r, &err), CAG_OK);
  holes[1] = open;
  FAILS_AT(cag_region_new(outer, holes, 2, &r, &err), "region-not-closed", 1);
  FAILS(cag_region_new(open, NULL, 0, &r, &err), "region-not-closed");
  // Even-odd rule: a square in a ring in a square.
  CagCurve *loops[3] = {in, around, outer};
  double area;
  OK(cag_region_from_loops(loops, 3, &r, &err));
  OK(cag_region_area(r, &area, NULL, &err));
  NEAR(area, 64 - 36 + 1, 1e-12);
  assert_true(contains(r, 1, 0) && !contains(r, 2, 0) && contains(r, 3.5, 0));
  cag_region_release(r);
  cag_curve_release(open);
  cag_curve_release(inner);
  cag_curve_release(around);
  cag_curve_release(across);
  cag_curve_release(out);
  cag_curve_release(in);
  cag_curve_release(outer);
}

static void figures_have_their_closed_forms(void **state) {
  (void)state;
  CagRegion *r;
  double x;
  CagBounds b;
  for (int i = 0; i <= 4; i++) {
    const double radius = 0.5 * i;
    OK(cag_region_rectangle(6, 4, radius, &r, &err));
    OK(cag_region_area(r, &x, NULL, &err));
    NEAR(x, 24 - (4 - M_PI) * radius * radius, 1e-12);
    OK(cag_region_perimeter(r, &x, &err));
    NEAR(x, 20 - (8 - 2 * M_PI) * radius, 1e-12);
    OK(cag_region_bounds(r, &b, &err));
    near_vec(b.min, cag_vec3(-3, -2, 0), 1e-12);
    near_vec(b.max, cag_vec3(3, 2, 0), 1e-12);
    cag_region_release(r);
  }
  assert_int_not_equal(cag_region_rectangle(6, 4, 2.01, &r, &err), CAG_OK);
  assert_int_not_equal(cag_region_rectangle(6, 4, -0.1, &r, &err), CAG_OK);
  assert_int_not_equal(cag_region_rectangle(0, 4, 0, &r, &err), CAG_OK);
  assert_int_not_equal(cag_region_rectangle(6, -4, 0, &r, &err), CAG_OK);
  OK(cag_region_rectangle(4, 4, 2, &r, &err)); // a disk
  OK(cag_region_area(r, &x, NULL, &err));
  NEAR(x, 4 * M_PI, 1e-12);
  cag_region_release(r);
  for (size_t n = 3; n < 12; n++) {
    OK(cag_region_regular_polygon(n, 2.5, &r, &err));
    OK(cag_region_area(r, &x, NULL, &err));
    NEAR(x, (double)n * 2.5 * 2.5 * sin(2 * M_PI / (double)n) / 2, 1e-12);
    assert_true(contains(r, 2.5, 0) && !contains(r, 2.5 + 1e-6, 0));
    cag_region_release(r);
  }
  assert_int_not_equal(cag_region_regular_polygon(2, 1, &r, &err), CAG_OK);
  assert_int_not_equal(cag_region_regular_polygon(5, 0, &r, &err), CAG_OK);
}

// Bounds, areas, and perimeters include all loops, in any order.
static void separate_loops_all_count(void **state) {
  (void)state;
  CagCurve *loops[3] = {circle(1, 0, 0), circle(2, 7, 1), circle(0.5, -3, -2)};
  for (int first = 0; first < 3; first++) {
    CagCurve *turned[3] = {loops[first], loops[(first + 1) % 3], loops[(first + 2) % 3]};
    CagRegion *r;
    CagBounds b;
    CagVec3 center;
    double area, length;
    OK(cag_region_from_loops(turned, 3, &r, &err));
    OK(cag_region_bounds(r, &b, &err));
    near_vec(b.min, cag_vec3(-3.5, -2.5, 0), 1e-9);
    near_vec(b.max, cag_vec3(9, 3, 0), 1e-9);
    OK(cag_region_area(r, &area, &center, &err));
    NEAR(area, 5.25 * M_PI, 1e-9);
    near_vec(center, cag_vec3((4 * 7 - 0.25 * 3) / 5.25, (4 - 0.25 * 2) / 5.25, 0), 1e-9);
    OK(cag_region_perimeter(r, &length, &err));
    NEAR(length, 7 * M_PI, 1e-9);
    assert_true(contains(r, 0.9, 0) && contains(r, 8.9, 1) && contains(r, -3, -2.4));
    assert_false(contains(r, 3, 0));
    cag_region_release(r);
  }
  for (int i = 0; i < 3; i++) cag_curve_release(loops[i]);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(separate_loops_all_count),
      cmocka_unit_test(random_regions_have_the_measures_of_polygons),
      cmocka_unit_test(loops_that_cross_are_named),
      cmocka_unit_test(figures_have_their_closed_forms),
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
