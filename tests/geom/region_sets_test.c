// Set operations and offsets of regions, compared with closed forms and the points that they
// contain.

#include "tests/geom/support.h"

#include "geom/curve/circles.h"
#include "geom/curve/region.h"
#include "tests/geom/random.h"
#include "tests/geom/region_support.h"

static CagRegion *disc(double x, double y, double radius) {
  CagTransform frame = cag_translate(cag_vec3(x, y, 0));
  frame.planar = true;
  CagCurve *c;
  CagRegion *r;
  OK(cag_curve_arc(radius, radius, 0, 2 * M_PI, &frame, &c, &err));
  OK(cag_region_new(c, NULL, 0, &r, &err));
  cag_curve_release(c);
  return r;
}

static CagRegion *polygon(const CagVec3 *p, size_t n) {
  CagCurve *c;
  CagRegion *r;
  OK(cag_curve_polyline(p, n, true, 2, &c, &err));
  OK(cag_region_new(c, NULL, 0, &r, &err));
  cag_curve_release(c);
  return r;
}

static CagRegion *box(double x, double y, double w, double h) {
  const CagVec3 p[4] = {{x, y, 0}, {x + w, y, 0}, {x + w, y + h, 0}, {x, y + h, 0}};
  return polygon(p, 4);
}

// A closed cubic B-spline about a point, which depends only on the seed.
static CagRegion *blob(double x, double y, unsigned seed) {
  enum { POINTS = 8 };
  CagVec3 p[POINTS];
  for (int i = 0; i < POINTS; i++) {
    seed = seed * 1103515245u + 12345u;
    const double r = 1.5 + (double)(seed >> 16 & 1023) / 512, a = 2 * M_PI * i / POINTS;
    p[i] = cag_vec3(x + r * cos(a), y + r * sin(a), 0);
  }
  CagCurve *c;
  CagRegion *r;
  OK(cag_curve_nurbs_closed(p, NULL, POINTS, 3, 2, &c, &err));
  OK(cag_region_new(c, NULL, 0, &r, &err));
  cag_curve_release(c);
  return r;
}

static double area_of(const CagRegion *r) {
  double area;
  OK(cag_region_area(r, &area, NULL, &err));
  return area;
}

static double free_area(CagRegion *r) {
  const double area = area_of(r);
  cag_region_release(r);
  return area;
}

// Takes ownership of both operands.
static CagRegion *set(CagRegionOp op, CagRegion *a, CagRegion *b) {
  CagRegion *r;
  OK(cag_region_boolean(op, a, b, &r, &err));
  cag_region_release(a);
  cag_region_release(b);
  return r;
}

static CagRegion *grown(CagRegion *a, double d) {
  CagRegion *r;
  OK(cag_region_offset(a, d, 1e-7, &r, &err));
  cag_region_release(a);
  return r;
}

static void check_loops(const CagRegion *r, size_t loops, size_t outer) {
  size_t found = 0;
  assert_int_equal(r->count, loops);
  for (size_t i = 0; i < r->count; i++) {
    double area;
    assert_true(r->loops[i]->closed);
    OK(cag_curve_area(r->loops[i], &area, NULL, &err));
    assert_true((area > 0) == (r->outer[i] == i));
    found += r->outer[i] == i;
  }
  assert_int_equal(found, outer);
}

static void crossing_discs_share_a_lens_of_arcs(void **state) {
  (void)state;
  // Two unit circles at distance 1: 2 pi / 3 - sqrt(3) / 2.
  const double lens = 2 * M_PI / 3 - sqrt(3) / 2;
  CagRegion *r = set(CAG_REGION_INTERSECTION, disc(0, 0, 1), disc(1, 0, 1));
  check_loops(r, 1, 1);
  NEAR(free_area(r), lens, 1e-12);
  NEAR(free_area(set(CAG_REGION_UNION, disc(0, 0, 1), disc(1, 0, 1))), 2 * M_PI - lens, 1e-12);
  r = set(CAG_REGION_DIFFERENCE, disc(0, 0, 1), disc(1, 0, 1));
  // The entire boundary is on one of the circles, because arcs are preserved.
  for (int i = 0; i <= 50; i++) {
    const CagCurve *c = r->loops[0];
    CagVec3 p;
    OK(cag_curve_point(c, c->start + (c->end - c->start) * i / 50, &p, &err));
    NEAR(fmin(fabs(hypot(p.x, p.y) - 1), fabs(hypot(p.x - 1, p.y) - 1)), 0, 1e-14);
  }
  NEAR(free_area(r), M_PI - lens, 1e-12);
}

static void a_loop_that_nothing_crosses_is_the_given_one(void **state) {
  (void)state;
  CagRegion *a = disc(0, 0, 3), *b = disc(1, 0, 1), *r;
  OK(cag_region_boolean(CAG_REGION_DIFFERENCE, a, b, &r, &err));
  check_loops(r, 2, 1);
  assert_ptr_equal(r->loops[0], a->loops[0]);
  NEAR(free_area(r), 8 * M_PI, 1e-11);
  cag_region_release(b);
  b = disc(2, 0, 1); // touches from inside
  OK(cag_region_boolean(CAG_REGION_DIFFERENCE, a, b, &r, &err));
  check_loops(r, 2, 1);
  assert_ptr_equal(r->loops[0], a->loops[0]);
  cag_region_release(r);
  cag_region_release(a);
  cag_region_release(b);
}

static void coincident_edges_vanish_between_and_stay_around(void **state) {
  (void)state;
  CagRegion *r = set(CAG_REGION_UNION, box(0, 0, 2, 2), box(2, 0, 2, 2));
  check_loops(r, 1, 1);
  NEAR(free_area(r), 8, 1e-14);
  r = set(CAG_REGION_UNION, box(0, 0, 2, 2), box(0, 0, 2, 2));
  check_loops(r, 1, 1);
  NEAR(free_area(r), 4, 1e-14);
  r = set(CAG_REGION_DIFFERENCE, box(0, 0, 4, 4), box(0, 0, 2, 4));
  check_loops(r, 1, 1);
  NEAR(free_area(r), 8, 1e-14);
  // Half disks with a common arc, cut from the whole one and united again.
  CagRegion *upper = set(CAG_REGION_INTERSECTION, disc(0, 0, 2), box(-3, 0, 6, 3)),
            *lower = set(CAG_REGION_DIFFERENCE, disc(0, 0, 2), box(-3, 0, 6, 3));
  NEAR(area_of(upper), 2 * M_PI, 1e-12);
  NEAR(area_of(lower), 2 * M_PI, 1e-12);
  r = set(CAG_REGION_UNION, upper, lower);
  check_loops(r, 1, 1);
  NEAR(free_area(r), 4 * M_PI, 1e-12);
}

static void pieces_that_touch_stay_pieces(void **state) {
  (void)state;
  CagRegion *r = set(CAG_REGION_UNION, box(0, 0, 1, 1), box(1, 1, 1, 1));
  check_loops(r, 2, 2);
  NEAR(free_area(r), 2, 1e-14);
  // A cross cut from a square leaves four corners. A frame around an island has two outlines.
  r = set(CAG_REGION_DIFFERENCE, box(0, 0, 3, 3), box(1, -1, 1, 5));
  r = set(CAG_REGION_DIFFERENCE, r, box(-1, 1, 5, 1));
  check_loops(r, 4, 4);
  NEAR(free_area(r), 4, 1e-14);
  r = set(CAG_REGION_DIFFERENCE, box(0, 0, 9, 9), box(1, 1, 7, 7));
  r = set(CAG_REGION_UNION, r, box(3, 3, 3, 3));
  check_loops(r, 3, 2);
  assert_true(holds(r, 0.5, 0.5) && !holds(r, 2, 2) && holds(r, 4, 4));
  // Two triangular holes that touch at a point.
  const CagVec3 left[3] = {{1, 2, 0}, {4, 4, 0}, {1, 6, 0}},
                right[3] = {{7, 2, 0}, {7, 6, 0}, {4, 4, 0}};
  CagRegion *holes = set(CAG_REGION_UNION, polygon(left, 3), polygon(right, 3));
  r = set(CAG_REGION_UNION, r, box(0, 0, 9, 9));
  r = set(CAG_REGION_DIFFERENCE, r, holes);
  check_loops(r, 3, 1);
  NEAR(free_area(r), 81 - 12, 1e-12);
}

// Releases the region.
static bool is_empty(CagRegion *r) {
  const bool empty = cag_region_is_empty(r);
  NEAR(area_of(r), 0, empty ? 0 : INFINITY);
  cag_region_release(r);
  return empty;
}

static CagRegion *combined(CagRegionOp op, const CagRegion *a, const CagRegion *b) {
  CagRegion *r;
  OK(cag_region_boolean(op, a, b, &r, &err));
  return r;
}

static CagRegion *grown_by(const CagRegion *a, double d) {
  CagRegion *r;
  OK(cag_region_offset(a, d, 1e-6, &r, &err));
  return r;
}

static void an_empty_result_is_a_region_like_others(void **state) {
  (void)state;
  CagRegion *a = disc(0, 0, 1), *b = disc(5, 0, 1), *around = disc(0, 0, 2), *r;
  assert_true(is_empty(combined(CAG_REGION_INTERSECTION, a, b)));
  assert_true(is_empty(combined(CAG_REGION_DIFFERENCE, a, around)));
  assert_true(is_empty(combined(CAG_REGION_DIFFERENCE, a, a)));
  assert_true(is_empty(grown_by(a, -1)));
  assert_true(is_empty(grown_by(a, -7)));
  FAILS(cag_region_offset(a, (double)NAN, 1e-6, &r, &err), "not-finite");
  CagRegion *beside = disc(2, 0, 1); // they touch at a point
  assert_true(is_empty(combined(CAG_REGION_INTERSECTION, a, beside)));
  // The empty region is a valid operand.
  CagRegion *none = combined(CAG_REGION_DIFFERENCE, a, a);
  assert_true(is_empty(combined(CAG_REGION_UNION, none, none)));
  assert_true(is_empty(combined(CAG_REGION_INTERSECTION, a, none)));
  assert_true(is_empty(combined(CAG_REGION_DIFFERENCE, none, a)));
  assert_true(is_empty(grown_by(none, 3)));
  NEAR(free_area(combined(CAG_REGION_UNION, none, a)), M_PI, 1e-12);
  NEAR(free_area(combined(CAG_REGION_DIFFERENCE, a, none)), M_PI, 1e-12);
  CagBounds box;
  CagVec3 center;
  double area;
  FAILS(cag_region_bounds(none, &box, &err), "empty-shape");
  FAILS(cag_region_area(none, &area, &center, &err), "empty-shape");
  OK(cag_region_perimeter(none, &area, &err));
  NEAR(area, 0, 0);
  assert_false(holds(none, 0, 0));
  cag_region_release(none);
  cag_region_release(beside);
  cag_region_release(a);
  cag_region_release(b);
  cag_region_release(around);
}

// |A or B| + |A and B| = |A| + |B| and |A minus B| + |A and B| = |A|. The containment of points
// agrees.
static void check_identities(CagRegion *a, CagRegion *b, double tolerance) {
  CagRegion *u, *d, *m;
  OK(cag_region_boolean(CAG_REGION_UNION, a, b, &u, &err));
  OK(cag_region_boolean(CAG_REGION_DIFFERENCE, a, b, &d, &err));
  OK(cag_region_boolean(CAG_REGION_INTERSECTION, a, b, &m, &err));
  NEAR(area_of(u) + area_of(m), area_of(a) + area_of(b), tolerance);
  NEAR(area_of(d) + area_of(m), area_of(a), tolerance);
  CagBounds box;
  OK(cag_region_bounds(u, &box, &err));
  for (int i = 0; i < 100; i++) {
    const double x = box.min.x + (box.max.x - box.min.x) * (i % 10 + 0.437) / 10,
                 y = box.min.y + (box.max.y - box.min.y) * (i / 10 + 0.561) / 10;
    const bool in_a = holds(a, x, y), in_b = holds(b, x, y);
    assert_int_equal(holds(u, x, y), in_a || in_b);
    assert_int_equal(holds(d, x, y), in_a && !in_b);
    assert_int_equal(holds(m, x, y), in_a && in_b);
  }
  cag_region_release(u);
  cag_region_release(d);
  cag_region_release(m);
}

static void areas_of_splines_add_up(void **state) {
  (void)state;
  for (unsigned i = 0; i < 40; i++) {
    CagRegion *a = blob(0, 0, i), *b = blob(1.5 * cos(i), 1.5 * sin(i), 77 + i);
    if (i % 2) a = set(CAG_REGION_DIFFERENCE, a, disc(0.5, 0.25, 0.75));
    check_identities(a, b, 1e-8);
    cag_region_release(a);
    cag_region_release(b);
  }
}

static void areas_add_up_at_any_scale_and_far_away(void **state) {
  (void)state;
  const struct {
    double scale, away, tolerance;
  } cases[] = {{1e9, 0, 1e8}, {1e-9, 0, 1e-26}, {1, 1e6, 1e-5}, {1, 1e9, 1}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    CagTransform t = cag_transform_identity();
    t.m[0][0] = t.m[1][1] = cases[i].scale;
    t.m[0][3] = t.m[1][3] = cases[i].away;
    t.planar = true;
    CagRegion *a = set(CAG_REGION_DIFFERENCE, box(-2, -2, 5, 4), disc(0, 0, 1)), *b = blob(1, 1, 5),
              *moved[2];
    OK(cag_region_transform(a, &t, &moved[0], &err));
    OK(cag_region_transform(b, &t, &moved[1], &err));
    check_identities(moved[0], moved[1], cases[i].tolerance);
    for (int k = 0; k < 2; k++) cag_region_release(moved[k]);
    cag_region_release(a);
    cag_region_release(b);
  }
}

static void slivers_are_not_there(void **state) {
  (void)state;
  CagRegion *a = box(0, 0, 1, 1), *b = box(0, 0, 1, 1 + 1e-12), *r;
  assert_true(is_empty(combined(CAG_REGION_DIFFERENCE, b, a)));
  OK(cag_region_boolean(CAG_REGION_UNION, a, b, &r, &err));
  check_loops(r, 1, 1);
  cag_region_release(r);
  cag_region_release(a);
  cag_region_release(b);
}

static void thousands_of_edges_take_no_time(void **state) {
  (void)state;
  // Two crossing combs with n teeth each: n * n crossings of teeth.
  enum { TEETH = 40 };
  CagVec3 p[4 * TEETH], q[4 * TEETH];
  for (int i = 0; i < TEETH; i++)
    for (int k = 0; k < 4; k++) {
      const double x = i + (k >= 2 ? 0.5 : 0),
                   y = k == 1 || k == 2 ? TEETH : -1 + (k == 3 && i < TEETH - 1) * 0.5;
      p[4 * i + k] = cag_vec3(x, k == 0 && i > 0 ? -0.5 : y, 0);
      q[4 * i + k] = cag_vec3(p[4 * i + k].y, p[4 * i + k].x, 0);
    }
  CagRegion *a = polygon(p, 4 * TEETH), *b = polygon(q, 4 * TEETH);
  check_identities(a, b, 1e-9);
  cag_region_release(a);
  cag_region_release(b);
}

// --- Offsets ---

static void a_convex_region_grows_by_its_perimeter_and_a_disc(void **state) {
  (void)state;
  const CagVec3 p[5] = {{0, 0, 0}, {4, 0, 0}, {5, 3, 0}, {2, 5, 0}, {-1, 2, 0}};
  CagRegion *r = polygon(p, 5);
  double around;
  const double area = area_of(r), d = 0.7;
  OK(cag_region_perimeter(r, &around, &err));
  NEAR(free_area(grown(r, d)), area + around * d + M_PI * d * d, 1e-12);
  NEAR(free_area(grown(disc(1, 2, 3), 0.5)), M_PI * 3.5 * 3.5, 1e-12);
  NEAR(free_area(grown(disc(1, 2, 3), -0.5)), M_PI * 2.5 * 2.5, 1e-12);
  NEAR(free_area(grown(box(0, 0, 4, 3), -1)), 2, 1e-14);
}

static void holes_shrink_until_they_are_gone(void **state) {
  (void)state;
  CagRegion *ring = set(CAG_REGION_DIFFERENCE, disc(0, 0, 3), disc(0, 0, 1));
  ring = grown(ring, 0.5);
  check_loops(ring, 2, 1);
  NEAR(area_of(ring), M_PI * (3.5 * 3.5 - 0.25), 1e-12);
  ring = grown(ring, 1);
  check_loops(ring, 1, 1);
  NEAR(free_area(ring), M_PI * 4.5 * 4.5, 1e-12);
  ring = set(CAG_REGION_DIFFERENCE, disc(0, 0, 3), disc(0, 0, 1));
  NEAR(free_area(grown(ring, -0.5)), M_PI * (2.5 * 2.5 - 1.5 * 1.5), 1e-12);
}

static void a_dumbbell_shrinks_to_two_pieces(void **state) {
  (void)state;
  // Squares of side 4 with a bar of height 1 between. The inner offset by 1 is squares of side 2,
  // whose sides toward the bar bulge to circles about the bar's corners.
  CagRegion *r = set(CAG_REGION_UNION, box(0, 0, 4, 4), box(10, 0, 4, 4));
  r = set(CAG_REGION_UNION, r, box(3, 1.5, 8, 1));
  check_loops(r, 1, 1);
  r = grown(r, -1);
  check_loops(r, 2, 2);
  // Beyond x = 3, the offset region is between the two circles of radius 1 about [4, 1.5] and [4,
  // 2.5], up to x = 4 - sqrt(1 - 0.25). Its area is twice the integral of 1 - sqrt(1 - s^2) over s
  // in 0..0.5.
  const double h = 0.5, bulge = 2 * (h - (h * sqrt(1 - h * h) + asin(h)) / 2);
  NEAR(free_area(r), 2 * (4 + bulge), 1e-12);
}

static void offsets_of_splines_keep_the_distance(void **state) {
  (void)state;
  const double distances[] = {0.3, 1, 2.5, -0.2, -0.6, -0.35};
  for (unsigned i = 0; i < 6; i++) {
    CagRegion *r = set(CAG_REGION_UNION, blob(0, 0, i), blob(2.5, 1, i + 9));
    if (i % 2) r = set(CAG_REGION_DIFFERENCE, r, blob(1, 0.5, i));
    check_distances(r, distances[i], 1e-6);
    cag_region_release(r);
  }
}

static void an_ellipse_folds_where_it_is_sharp(void **state) {
  (void)state;
  // The radius of curvature at the tips of x^2/25 + y^2 = 1 is 1/5, so an inner offset by one half
  // has two corners.
  CagTransform frame = cag_transform_identity();
  CagCurve *c;
  CagRegion *r;
  OK(cag_curve_arc(5, 1, 0, 2 * M_PI, &frame, &c, &err));
  OK(cag_region_new(c, NULL, 0, &r, &err));
  cag_curve_release(c);
  for (int i = 1; i < 10; i++) check_distances(r, -i / 10.0, 1e-6);
  for (int i = 1; i < 4; i++) check_distances(r, i, 1e-6);
  assert_true(is_empty(grown_by(r, -1.01)));
  cag_region_release(r);
}

// Random star-shaped polygons and shapes of lines and arcs, with outer and inner offsets.
static void random_shapes_keep_the_distance(void **state) {
  (void)state;
  seed = 71;
  for (int round = 0; round < 24; round++) {
    enum { POINTS = 7 };
    CagVec3 p[POINTS];
    CagCurve *c, *rounded;
    CagRegion *r;
    for (int i = 0; i < POINTS; i++) {
      const double radius = uniform(1, 3), angle = 2 * M_PI * i / POINTS;
      p[i] = cag_vec3(radius * cos(angle), radius * sin(angle), 0);
    }
    if (round % 4 == 3) { // convex, with a vertex on an edge
      for (int i = 0; i < POINTS; i++) p[i] = cag_scaled(cag_unit(p[i]), 2.5);
      p[1] = cag_lerp(p[0], p[2], 0.3);
    }
    OK(cag_curve_polyline(p, POINTS, true, 2, &c, &err));
    if (round % 3 == 0 && !cag_curve_rounded(c, 0.12, &rounded, &err)) {
      cag_curve_release(c);
      c = rounded;
    }
    OK(cag_region_new(c, NULL, 0, &r, &err));
    cag_curve_release(c);
    const double grow = uniform(0.05, 2), shrink = uniform(-1.2, -0.05);
    check_distances(r, grow, 1e-6);
    check_distances(r, shrink, 1e-6);
    // A convex region that grows and shrinks again is the same.
    if (round % 4 == 3) {
      CagRegion *out, *back;
      double before, after;
      OK(cag_region_offset(r, 0.7, 1e-7, &out, &err));
      OK(cag_region_offset(out, -0.7, 1e-7, &back, &err));
      OK(cag_region_area(r, &before, NULL, &err));
      OK(cag_region_area(back, &after, NULL, &err));
      NEAR(after, before, 1e-9);
      cag_region_release(back);
      cag_region_release(out);
    }
    cag_region_release(r);
  }
}

// --- Convex polygons compared with half planes ---

enum { MOST_CORNERS = 64 };

// Clips the polygon to the left of the line from p in the direction d.
static size_t clip_half_plane(CagVec3 *v, size_t n, CagVec3 p, CagVec3 d) {
  CagVec3 out[MOST_CORNERS];
  size_t m = 0;
  for (size_t i = 0; i < n; i++) {
    const CagVec3 a = v[i], b = v[(i + 1) % n];
    const double f = cag_cross(d, cag_sub(a, p)).z, g = cag_cross(d, cag_sub(b, p)).z;
    if (f >= 0) out[m++] = a;
    if ((f > 0 && g < 0) || (f < 0 && g > 0)) out[m++] = cag_lerp(a, b, f / (f - g));
  }
  memcpy(v, out, m * sizeof *v);
  return m;
}

static double area_of_corners(const CagVec3 *v, size_t n) {
  double twice = 0;
  for (size_t i = 0; i < n; i++) twice += cag_cross(v[i], v[(i + 1) % n]).z;
  return twice / 2;
}

// Counts the distinct corners.
static size_t count_corners(const CagVec3 *v, size_t n) {
  size_t found = 0;
  for (size_t i = 0; i < n; i++) found += cag_norm(cag_sub(v[i], v[(i + 1) % n])) > 1e-9;
  return found;
}

static void convex_polygons_shrink_to_what_half_planes_leave(void **state) {
  (void)state;
  seed = 72;
  int left = 0, gone = 0, fewer = 0;
  for (int round = 0; round < 400; round++) {
    CagVec3 p[MOST_CORNERS], given[MOST_CORNERS], rest[MOST_CORNERS];
    const size_t n = (size_t)uniform(3, 13);
    const double long_side = uniform(1, 8), start = uniform(0, 7);
    const double sizes[] = {1, 1e-5, 1e6};
    const double size = sizes[round % 3];
    double angle = start;
    for (size_t i = 0; i < n; i++) { // no gap reaches a half turn
      const double corner = cos(angle);
      p[i] = cag_scaled(cag_vec3(long_side * corner + 3, sin(angle), 0), size);
      angle += uniform(0.5, 1.5) * 4 / (double)n;
    }
    const double d = uniform(0.02, 0.9) * size;
    // With additional corners on edges, and in reverse.
    size_t m = 0;
    for (size_t i = 0; i < n; i++) {
      given[m++] = p[i];
      if ((round + (int)i) % 4 == 0) given[m++] = cag_lerp(p[i], p[(i + 1) % n], 0.25);
    }
    if (round % 5 == 0)
      for (size_t i = 0; i < m / 2; i++) {
        const CagVec3 other = given[i];
        given[i] = given[m - 1 - i];
        given[m - 1 - i] = other;
      }
    size_t k = n;
    memcpy(rest, p, n * sizeof *p);
    for (size_t i = 0; i < n && k > 0; i++) {
      const CagVec3 along = cag_unit(cag_sub(p[(i + 1) % n], p[i]));
      k = clip_half_plane(rest, k, cag_madd(p[i], d, cag_vec3(-along.y, along.x, 0)), along);
    }
    const double expected = k > 2 ? area_of_corners(rest, k) : 0;
    if (expected < 1e-6 * size * size && expected > 0) continue; // almost empty
    CagRegion *r = polygon(given, m), *s;
    OK(cag_region_offset(r, -d, 1e-7 * size, &s, &err));
    if (expected == 0) {
      assert_true(cag_region_is_empty(s));
      gone++;
    } else {
      const CagVec3 *v;
      size_t corners;
      bool closed;
      NEAR(area_of(s) / (size * size), expected / (size * size), 1e-11);
      assert_int_equal(s->count, 1);
      assert_true(cag_curve_vertices(s->loops[0], &v, &corners, &closed) && closed);
      for (size_t i = 0; i < k; i++) rest[i] = cag_scaled(rest[i], 1 / size);
      assert_int_equal(corners, count_corners(rest, k));
      fewer += corners < n;
      left++;
    }
    cag_region_release(r);
    cag_region_release(s);
  }
  assert_true(left > 100 && gone > 30 && fewer > 30);
}

static void the_limits_of_distances_are_parts_of_the_size(void **state) {
  (void)state;
  CagRegion *r = box(1, 2, 3, 4), *s; // the diagonal is 5
  const double kept[] = {0, 4.9e-12, -4.9e-12}, moved[] = {5.1e-12, -5.1e-12};
  for (int i = 0; i < 3; i++) {
    OK(cag_region_offset(r, kept[i], 1e-7, &s, &err));
    assert_ptr_equal(s, r);
    cag_region_release(s);
  }
  for (int i = 0; i < 2; i++) {
    OK(cag_region_offset(r, moved[i], 1e-7, &s, &err));
    assert_ptr_not_equal(s, r);
    cag_region_release(s);
  }
  FAILS(cag_region_offset(r, 5.1e9, 1e-7, &s, &err), "too-far");
  FAILS(cag_region_offset(r, NAN, 1e-7, &s, &err), "not-finite");
  OK(cag_region_offset(r, 4.9e9, 1e-7, &s, &err));
  NEAR(free_area(s) / (M_PI * 4.9e9 * 4.9e9), 1, 1e-8);
  // Nearly the whole width, the whole width, and slightly more.
  NEAR(free_area(grown_by(r, -1.4999)), 2e-4 * 1.0002, 1e-12);
  assert_true(is_empty(grown_by(r, -1.5)));
  assert_true(is_empty(grown_by(r, -1.500001)));
  assert_true(is_empty(grown_by(r, -4e9)));
  cag_region_release(r);
  // An empty region stays empty.
  s = grown_by(r = set(CAG_REGION_DIFFERENCE, box(0, 0, 1, 1), box(-1, -1, 4, 4)), 1);
  assert_true(is_empty(s));
  cag_region_release(r);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(random_shapes_keep_the_distance),
      cmocka_unit_test(crossing_discs_share_a_lens_of_arcs),
      cmocka_unit_test(a_loop_that_nothing_crosses_is_the_given_one),
      cmocka_unit_test(coincident_edges_vanish_between_and_stay_around),
      cmocka_unit_test(pieces_that_touch_stay_pieces),
      cmocka_unit_test(an_empty_result_is_a_region_like_others),
      cmocka_unit_test(areas_of_splines_add_up),
      cmocka_unit_test(areas_add_up_at_any_scale_and_far_away),
      cmocka_unit_test(slivers_are_not_there),
      cmocka_unit_test(thousands_of_edges_take_no_time),
      cmocka_unit_test(a_convex_region_grows_by_its_perimeter_and_a_disc),
      cmocka_unit_test(holes_shrink_until_they_are_gone),
      cmocka_unit_test(a_dumbbell_shrinks_to_two_pieces),
      cmocka_unit_test(offsets_of_splines_keep_the_distance),
      cmocka_unit_test(an_ellipse_folds_where_it_is_sharp),
      cmocka_unit_test(convex_polygons_shrink_to_what_half_planes_leave),
      cmocka_unit_test(the_limits_of_distances_are_parts_of_the_size),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
