// Tangent circles and lines, fillets, and rounded corners. The expected values are closed forms, or
// those of the reference on plane curves.

#include "conic_support.h"
#include "geom/curve/circles.h"
#include "geom/curve/conic.h"
#include "geom/curve/family.h"

// --- Tangent circles and lines ---

static void a_corner_has_four_circles(void **state) {
  (void)state;
  const CagTouched a = {{1, 1, 0}, {4, 1, 0}, 0}, b = {{2, 5, 0}, {2, -6, 0}, 0};
  static const CagVec3 centers[2][2] = {
      {{3.645731058560915, 2.43451506944354, 0}, {2.186218292329355, 2.06963687788565, 0}},
      {{4.121474015362952, 1.0072861990374267, 0}, {2.6619612491313926, 0.6424080074795367, 0}}};
  for (int right = 0; right < 2; right++)
    for (int near = 0; near < 2; near++) {
      const CagTouchChoice choice = {.right = right, .near = near};
      CagVec3 center, touch[2];
      OK(cag_tangent_circle(&a, &b, 0.75, choice, &center, touch, &err));
      near_vec(center, centers[right][near], 1e-13);
      for (int i = 0; i < 2; i++) NEAR(cag_norm(cag_sub(center, touch[i])), 0.75, 1e-13);
    }
  const CagTouched c = {{0, 9, 0}, {-8, -2, 0}, 0};
  CagVec3 center, touch[2];
  FAILS(cag_tangent_circle(&a, &c, 1, (CagTouchChoice){0}, &center, touch, &err), "parallel-lines");
  FAILS(cag_tangent_circle(&a, &b, 0, (CagTouchChoice){0}, &center, touch, &err),
        "radius-not-positive");
}

static void circles_touch_from_outside_and_inside(void **state) {
  (void)state;
  const CagTouched a = {{0, 0, 0}, {0, 0, 0}, 3}, b = {{8, 0, 0}, {0, 0, 0}, 2};
  const CagTouched l = {{0, -5, 0}, {1, 0, 0}, 0};
  for (int in_a = 0; in_a < 2; in_a++)
    for (int in_b = 0; in_b < 2; in_b++)
      for (int right = 0; right < 2; right++) {
        const double radius = 7.5;
        CagVec3 center, touch[2];
        const CagTouchChoice choice = {.right = right, .inside = {in_a, in_b}};
        OK(cag_tangent_circle(&a, &b, radius, choice, &center, touch, &err));
        assert_true(right == (center.y < 0));
        NEAR(cag_norm(center), in_a ? 4.5 : 10.5, 1e-12);
        NEAR(cag_norm(cag_sub(center, b.p)), in_b ? 5.5 : 9.5, 1e-12);
        NEAR(cag_norm(touch[0]), 3, 1e-13);
        NEAR(cag_norm(cag_sub(touch[0], center)), radius, 1e-12);
        NEAR(cag_norm(cag_sub(touch[1], center)), radius, 1e-12);
      }
  CagVec3 center, touch[2];
  // Above the line y = -5 and outside the circle: the center is at height -4, at distance 4 from
  // the origin.
  OK(cag_tangent_circle(&l, &a, 1, (CagTouchChoice){0}, &center, touch, &err));
  near_vec(center, cag_vec3(0, -4, 0), 1e-12);
  near_vec(touch[1], cag_vec3(0, -3, 0), 1e-12);
  FAILS(cag_tangent_circle(&l, &a, 0.5, (CagTouchChoice){0}, &center, touch, &err),
        "no-tangent-circle");
}

static void tangents_from_a_point_touch(void **state) {
  (void)state;
  const CagTransform f = plane_frame(0, 0, 0);
  CagCurve *c;
  CagTangentLine *lines;
  size_t n;
  OK(cag_curve_arc(3, 1, 0, 2 * M_PI, &f, &c, &err));
  // The polar of (5, 0): x = 9/5.
  OK(cag_tangents_from_point(c, cag_vec3(5, 0, 0), &lines, &n, &err));
  assert_int_equal(n, 2);
  near_vec(lines[0].p, cag_vec3(1.8, 0.8, 0), 1e-12);
  near_vec(lines[1].p, cag_vec3(1.8, -0.8, 0), 1e-12);
  free(lines);
  OK(cag_tangents_from_point(c, cag_vec3(1, 0.2, 0), &lines, &n, &err));
  assert_int_equal(n, 0);
  free(lines);
  OK(cag_tangents_from_point(c, cag_vec3(0, 1, 0), &lines, &n, &err));
  assert_int_equal(n, 1);
  near_vec(cag_cross(cag_sub(lines[0].q, lines[0].p), cag_vec3(1, 0, 0)), cag_vec3(0, 0, 0), 1e-12);
  free(lines);
  cag_curve_release(c);
}

static size_t common_tangents(double x, double r, double s) {
  CagCurve *a, *b;
  CagTangentLine *lines;
  size_t n;
  CagTransform f = plane_frame(0, 0, 0), g = plane_frame(x, 0.5, 0);
  OK(cag_curve_arc(r, r, 0, 2 * M_PI, &f, &a, &err));
  OK(cag_curve_arc(s, s, 0, 2 * M_PI, &g, &b, &err));
  OK(cag_tangents_of_two(a, b, &lines, &n, &err));
  for (size_t i = 0; i < n; i++) {
    const CagVec3 d = cag_sub(lines[i].q, lines[i].p);
    NEAR(cag_dot(d, lines[i].p), 0, 1e-10);
    NEAR(cag_dot(d, cag_sub(lines[i].q, cag_vec3(x, 0.5, 0))), 0, 1e-10);
  }
  free(lines);
  cag_curve_release(a);
  cag_curve_release(b);
  return n;
}

static void two_circles_have_up_to_four_tangents(void **state) {
  (void)state;
  assert_int_equal(common_tangents(5, 1, 2), 4);
  assert_int_equal(common_tangents(2, 1, 2), 2);
  assert_int_equal(common_tangents(0.1, 1, 2), 0);
}

// The four tangents of two crossing ellipses with swapped axes are symmetric: x + y = +-sqrt(5), x
// - y = +-sqrt(5) (a^2 + b^2 = 5).
static void two_ellipses_have_their_tangents(void **state) {
  (void)state;
  const CagTransform f = plane_frame(0, 0, 0);
  CagCurve *a, *b;
  CagTangentLine *lines;
  size_t n;
  OK(cag_curve_arc(2, 1, 0, 2 * M_PI, &f, &a, &err));
  OK(cag_curve_arc(1, 2, 0, 2 * M_PI, &f, &b, &err));
  OK(cag_tangents_of_two(a, b, &lines, &n, &err));
  assert_int_equal(n, 4);
  for (size_t i = 0; i < n; i++) {
    NEAR(fabs(lines[i].p.x) + fabs(lines[i].p.y), sqrt(5), 1e-12);
    NEAR(fabs(lines[i].q.x) + fabs(lines[i].q.y), sqrt(5), 1e-12);
  }
  free(lines);
  cag_curve_release(a);
  cag_curve_release(b);
}

static void a_fillet_leaves_and_enters_along_the_tangents(void **state) {
  (void)state;
  const CagVec3 bend[3] = {{0, 0, 0}, {6, 7, 0}, {10, 0, 0}};
  const CagTransform f = plane_frame(15, 0, 0);
  CagCurve *a, *b, *arc;
  CagVec3 in, out, first, last;
  double t, u;
  OK(cag_curve_bezier(bend, NULL, 3, 2, &a, &err));
  OK(cag_curve_arc(5, 5, -M_PI, 0, &f, &b, &err));
  OK(cag_fillet(a, b, 0.7, &arc, &t, &u, &err));
  near_vec(at(arc, arc->start), at(a, t), 1e-11);
  near_vec(at(arc, arc->end), at(b, u), 1e-11);
  OK(cag_curve_tangent(a, t, CAG_SIDE_LEFT, &in, &err));
  OK(cag_curve_tangent(b, u, CAG_SIDE_RIGHT, &out, &err));
  OK(cag_curve_tangent(arc, arc->start, CAG_SIDE_RIGHT, &first, &err));
  OK(cag_curve_tangent(arc, arc->end, CAG_SIDE_LEFT, &last, &err));
  near_vec(in, first, 1e-10);
  near_vec(out, last, 1e-10);
  cag_curve_release(arc);
  FAILS(cag_fillet(a, b, 100, &arc, &t, &u, &err), "radius-too-large");
  cag_curve_release(a);
  cag_curve_release(b);
}

static void rounding_shortens_by_what_the_arcs_save(void **state) {
  (void)state;
  const CagVec3 square[4] = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
  CagCurve *c, *r;
  CagVec3 center;
  double x;
  OK(cag_curve_polyline(square, 4, true, 2, &c, &err));
  OK(cag_curve_rounded(c, 1, &r, &err));
  assert_true(r->closed);
  OK(cag_curve_length(r, r->start, r->end, &x, &err));
  NEAR(x, 8 + 2 * M_PI, 1e-12);
  OK(cag_curve_area(r, &x, &center, &err));
  NEAR(x, 12 + M_PI, 1e-12);
  cag_curve_release(r);
  // The arcs of radius 2 meet and form a circle.
  OK(cag_curve_rounded(c, 2, &r, &err));
  OK(cag_curve_area(r, &x, &center, &err));
  NEAR(x, 4 * M_PI, 1e-12);
  cag_curve_release(r);
  FAILS_AT(cag_curve_rounded(c, 2.1, &r, &err), "radius-too-large", 0);
  FAILS(cag_curve_rounded(c, 0, &r, &err), "radius-not-positive");
  cag_curve_release(c);
}

// --- Random circles and lines ---

static CagVec3 random_location(double size) {
  CagVec3 p = {0, 0, 0};
  p.x = uniform(-size, size);
  p.y = uniform(-size, size);
  return p;
}

static double distance_from(const CagTouched *t, CagVec3 p) {
  const CagVec3 d = cag_sub(p, t->p);
  if (t->radius > 0) return cag_norm(d);
  return fabs(t->d.x * d.y - t->d.y * d.x) / cag_norm(t->d);
}

static double side_of(const CagTouched *line, CagVec3 p) {
  return line->d.x * (p.y - line->p.y) - line->d.y * (p.x - line->p.x);
}

// Checks the distances of the tangent circles, and the chosen side, for all choices.
static void random_circles_touch_as_chosen(void **state) {
  (void)state;
  seed = 17;
  int none[4] = {0}, made[4] = {0};
  for (int i = 0; i < 400; i++) {
    const double radius = uniform(0.2, 3);
    const int kind = i % 4; // two lines; line and circle; circle and line; two circles
    CagTouched t[2];
    for (int k = 0; k < 2; k++) {
      const bool round = k == 0 ? kind >= 2 : kind % 2;
      t[k].p = random_location(3);
      t[k].d = round ? cag_vec3(0, 0, 0) : random_location(2);
      t[k].radius = round ? uniform(0.3, 2) : 0;
    }
    CagVec3 found[2][2], touch[2]; // indexed by .right and .near
    for (int code = 0; code < 16; code++) {
      const CagTouchChoice c = {code & 1, code & 2, {code & 4, code & 8}};
      CagVec3 center = {0, 0, 0};
      double reach[2];
      for (int k = 0; k < 2; k++)
        reach[k] = t[k].radius == 0 ? radius
                   : c.inside[k]    ? fabs(t[k].radius - radius)
                                    : t[k].radius + radius;
      // A center exists if two circles about the centers meet, or the parallel line meets one.
      bool exists = true;
      double spare = 1;
      if (kind == 3) {
        const double d = cag_norm(cag_sub(t[1].p, t[0].p));
        spare = fmin(reach[0] + reach[1] - d, d - fabs(reach[0] - reach[1]));
      } else if (kind > 0) {
        const CagTouched *line = &t[kind - 1], *circle = &t[2 - kind];
        const double height = side_of(line, circle->p) / cag_norm(line->d);
        spare = reach[2 - kind] - fabs(height - (c.right ? -radius : radius));
      }
      exists = spare > 0;
      if (fabs(spare) < 1e-6) continue;
      if (!exists) {
        FAILS(cag_tangent_circle(&t[0], &t[1], radius, c, &center, touch, &err),
              "no-tangent-circle");
        none[kind]++;
        continue;
      }
      OK(cag_tangent_circle(&t[0], &t[1], radius, c, &center, touch, &err));
      made[kind]++;
      for (int k = 0; k < 2; k++) {
        NEAR(distance_from(&t[k], center), reach[k], 1e-9);
        NEAR(distance_from(&t[k], touch[k]), t[k].radius, 1e-9);
        NEAR(cag_norm(cag_sub(touch[k], center)), radius, 1e-7);
      }
      assert_true(center.z == 0);
      found[c.right][c.near] = center;
      const CagTouched *line = kind == 2 ? &t[1] : &t[0];
      const CagTouched between = {t[0].p, cag_sub(t[1].p, t[0].p), 0};
      assert_true((side_of(kind == 3 ? &between : line, center) < 0) == c.right);
      // The near side of the second line is that from which the first arrives.
      if (kind == 0) {
        const double before = side_of(&t[1], cag_madd(t[0].p, -1e6, t[0].d));
        assert_true((side_of(&t[1], center) * before > 0) == c.near);
      }
      // The earlier of the two points.
      if ((kind == 1 || kind == 2) && c.near)
        assert_true(cag_dot(cag_sub(found[c.right][0], center), line->d) >= 0);
    }
  }
  for (int kind = 0; kind < 4; kind++)
    assert_true(made[kind] > 200 && (kind == 0 || none[kind] > 100));
}

// Circles that touch only up to rounding are accepted: the center is between them.
static void circles_that_just_reach_are_found(void **state) {
  (void)state;
  seed = 18;
  for (int i = 0; i < 100; i++) {
    const double angle = uniform(-3, 3), radius = uniform(0.5, 2), r = uniform(0.5, 2);
    const CagVec3 p = random_location(i % 2 ? 1e4 : 100), e = {cos(angle), sin(angle), 0},
                  n = {-e.y, e.x, 0};
    const double s = uniform(0.5, 2);
    const CagTouched a = {p, {0, 0, 0}, r};
    const CagTouched b = {cag_madd(p, r + 2 * radius + s, e), {0, 0, 0}, s};
    const CagTouched line = {cag_madd(p, r + 2 * radius, n), e, 0};
    CagVec3 center, touch[2];
    for (int right = 0; right < 2; right++) {
      const CagTouchChoice c = {.right = right};
      OK(cag_tangent_circle(&a, &b, radius, c, &center, touch, &err));
      near_vec(center, cag_madd(p, r + radius, e), 1e-4);
      const CagTouched far = {cag_madd(b.p, 1e-6, e), {0, 0, 0}, s};
      FAILS(cag_tangent_circle(&a, &far, radius, c, &center, touch, &err), "no-tangent-circle");
    }
    const CagTouchChoice c = {.right = true};
    OK(cag_tangent_circle(&line, &a, radius, c, &center, touch, &err));
    near_vec(center, cag_madd(p, r + radius, n), 1e-4);
    const CagTouched far = {cag_madd(line.p, 1e-6, n), e, 0};
    FAILS(cag_tangent_circle(&far, &a, radius, c, &center, touch, &err), "no-tangent-circle");
  }
  const CagTouched a = {{1, 2, 0}, {0, 0, 0}, 1}, b = {{1, 2, 0}, {0, 0, 0}, 2};
  const CagTouched l = {{0, 0, 0}, {1, 0, 0}, 0}, point = {{0, 0, 0}, {0, 0, 0}, 0};
  const CagTouchChoice c = {0};
  CagVec3 center, touch[2];
  FAILS(cag_tangent_circle(&a, &b, 1, c, &center, touch, &err), "no-tangent-circle");
  FAILS_AT(cag_tangent_circle(&point, &l, 1, c, &center, touch, &err), "zero-vector", 0);
  FAILS_AT(cag_tangent_circle(&l, &point, 1, c, &center, touch, &err), "zero-vector", 1);
  FAILS_AT(cag_tangent_circle(&a, &point, 1, c, &center, touch, &err), "zero-vector", 1);
  FAILS(cag_tangent_circle(&a, &l, INFINITY, c, &center, touch, &err), "radius-not-positive");
  FAILS(cag_tangent_circle(&a, &l, -1, c, &center, touch, &err), "radius-not-positive");
  const CagTouched slanted = {{0, 1, 0}, {1, 1e-13, 0}, 0}, steeper = {{0, 1, 0}, {1, 1e-11, 0}, 0};
  FAILS(cag_tangent_circle(&l, &slanted, 1, c, &center, touch, &err), "parallel-lines");
  OK(cag_tangent_circle(&l, &steeper, 1, c, &center, touch, &err));
}

// --- Random tangent lines ---

// Counts the sign changes of C' x (C - p) at dense samples.
static size_t count_tangents(const CagCurve *c, CagVec3 p) {
  size_t count = 0;
  double last = 0;
  for (int i = 0; i <= 4000; i++) {
    CagVec3 d[2];
    OK(cag_curve_eval(c, c->start + (c->end - c->start) * (i + 0.5) / 4001, 1, CAG_SIDE_RIGHT, d,
                      &err));
    const CagVec3 e = cag_sub(d[0], p);
    const double value = d[1].x * e.y - d[1].y * e.x;
    count += last * value < 0;
    last = value;
  }
  return count;
}

static void tangents_from_random_points(void **state) {
  (void)state;
  seed = 41;
  for (int i = 0; i < 40; i++) {
    CagVec3 net[5];
    CagCurve *c;
    CagTangentLine *lines;
    size_t n;
    const CagTransform f = plane_frame(1, 0.5, 0.3);
    for (int k = 0; k < 5; k++) net[k] = random_location(3);
    if (i % 2) OK(cag_curve_bezier(net, NULL, 5, 2, &c, &err));
    else OK(cag_curve_arc(2, 1, uniform(-3, 0), uniform(0.1, 3), &f, &c, &err));
    const CagVec3 p = random_location(4);
    OK(cag_tangents_from_point(c, p, &lines, &n, &err));
    assert_int_equal(n, count_tangents(c, p));
    for (size_t k = 0; k < n; k++) {
      CagVec3 tangent;
      near_vec(lines[k].p, at(c, lines[k].t), 0);
      near_vec(lines[k].q, p, 0);
      OK(cag_curve_tangent(c, lines[k].t, CAG_SIDE_RIGHT, &tangent, &err));
      near_vec(cag_cross(tangent, cag_sub(p, lines[k].p)), cag_vec3(0, 0, 0), 1e-9);
      assert_true(k == 0 || lines[k - 1].t < lines[k].t);
    }
    free(lines);
    // At a point of the curve, one of the tangents is its own.
    const double t = c->start + (c->end - c->start) * uniform(0.2, 0.8);
    OK(cag_tangents_from_point(c, at(c, t), &lines, &n, &err));
    bool own = false;
    for (size_t k = 0; k < n; k++) own = own || fabs(lines[k].t - t) < 1e-6;
    assert_true(own);
    free(lines);
    cag_curve_release(c);
  }
  CagCurve *line, *space;
  CagTangentLine *lines;
  size_t n;
  OK(cag_curve_line(cag_vec3(0, 0, 0), cag_vec3(1, 1, 0), 2, &line, &err));
  OK(cag_tangents_from_point(line, cag_vec3(3, 3, 0), &lines, &n, &err));
  assert_int_equal(n, 0);
  free(lines);
  OK(cag_tangents_from_point(line, cag_vec3(3, 2, 0), &lines, &n, &err));
  assert_int_equal(n, 0);
  free(lines);
  OK(cag_curve_to_space(line, &space, &err));
  FAILS(cag_tangents_from_point(space, cag_vec3(3, 2, 0), &lines, &n, &err), "not-planar");
  FAILS(cag_tangents_of_two(space, line, &lines, &n, &err), "not-planar");
  FAILS(cag_tangents_of_two(line, space, &lines, &n, &err), "not-planar");
  cag_curve_release(space);
  cag_curve_release(line);
}

// The maximum of n . x over an ellipse with axes along X and Y.
static double support(CagVec3 center, double a, double b, double angle) {
  return center.x * cos(angle) + center.y * sin(angle) + hypot(a * cos(angle), b * sin(angle));
}

// A line with normal n touches an ellipse on either side. If the line is on the same side of two
// ellipses, their supports are equal; otherwise, they are opposite.
static size_t count_common(const CagVec3 c[2], const double a[2], const double b[2]) {
  size_t count = 0;
  double last[2] = {0, 0};
  enum { STEPS = 20000 };
  for (int i = 0; i <= STEPS; i++) {
    const double angle = 2 * M_PI * (i + 0.3) / STEPS;
    const double here = support(c[0], a[0], b[0], angle);
    const double value[2] = {here - support(c[1], a[1], b[1], angle),
                             here + support(c[1], a[1], b[1], angle + M_PI)};
    for (int k = 0; k < 2; k++) {
      count += last[k] * value[k] < 0;
      last[k] = value[k];
    }
  }
  return count;
}

static void random_ellipses_have_their_common_tangents(void **state) {
  (void)state;
  seed = 42;
  int seen[5] = {0};
  for (int i = 0; i < 24; i++) {
    CagVec3 c[2];
    double a[2], b[2];
    CagCurve *e[2];
    CagTangentLine *lines;
    size_t n;
    for (int k = 0; k < 2; k++) {
      c[k] = random_location(2);
      a[k] = uniform(0.4, 2);
      b[k] = i % 2 ? a[k] : uniform(0.4, 2);
      const CagTransform f = plane_frame(c[k].x, c[k].y, 0);
      OK(cag_curve_arc(a[k], b[k], 0, 2 * M_PI, &f, &e[k], &err));
    }
    OK(cag_tangents_of_two(e[0], e[1], &lines, &n, &err));
    assert_int_equal(n, count_common(c, a, b));
    seen[n]++;
    for (size_t k = 0; k < n; k++) {
      CagVec3 one, two;
      near_vec(lines[k].p, at(e[0], lines[k].t), 1e-12);
      near_vec(lines[k].q, at(e[1], lines[k].t2), 1e-12);
      OK(cag_curve_tangent(e[0], lines[k].t, CAG_SIDE_RIGHT, &one, &err));
      OK(cag_curve_tangent(e[1], lines[k].t2, CAG_SIDE_RIGHT, &two, &err));
      const CagVec3 d = cag_sub(lines[k].q, lines[k].p);
      near_vec(cag_cross(one, d), cag_vec3(0, 0, 0), 1e-8);
      near_vec(cag_cross(two, d), cag_vec3(0, 0, 0), 1e-8);
      assert_true(k == 0 || lines[k - 1].t <= lines[k].t);
      for (size_t j = 0; j < k; j++)
        assert_true(cag_norm(cag_sub(lines[j].p, lines[k].p)) > 1e-6 ||
                    cag_norm(cag_sub(lines[j].q, lines[k].q)) > 1e-6);
    }
    free(lines);
    // For arcs, only tangents at points of the arcs count.
    if (i % 2) {
      CagCurve *part;
      CagTangentLine *fewer;
      size_t m, expected = 0;
      OK(cag_curve_trim(e[0], 1, 4, &part, &err));
      OK(cag_tangents_of_two(e[0], e[1], &lines, &n, &err));
      for (size_t k = 0; k < n; k++) expected += lines[k].t > 1 && lines[k].t < 4;
      OK(cag_tangents_of_two(part, e[1], &fewer, &m, &err));
      assert_int_equal(m, expected);
      free(fewer);
      OK(cag_tangents_of_two(e[1], part, &fewer, &m, &err));
      assert_int_equal(m, expected);
      for (size_t k = 0; k < m; k++) assert_true(fewer[k].t2 > 1 && fewer[k].t2 < 4);
      free(fewer);
      free(lines);
      cag_curve_release(part);
    }
    cag_curve_release(e[0]);
    cag_curve_release(e[1]);
  }
  assert_true(seen[0] > 0 && seen[2] > 0 && seen[4] > 0);
}

// Tangent lines of transformed curves, of any size, are the transformed tangent lines.
static void tangent_lines_have_images(void **state) {
  (void)state;
  seed = 43;
  size_t seen = 0;
  for (int i = 0; i < 24; i++) {
    const double scale = pow(10, i % 3 * 6 - 6.0), ratio = 1 / scale;
    // The axes have equal lengths, but are not perpendicular.
    const double slant = i % 2 ? 0.3 : 0;
    CagTransform grow = cag_transform_identity();
    grow.m[0][0] = scale;
    grow.m[0][1] = scale * slant;
    grow.m[1][1] = scale * sqrt(1 - slant * slant);
    CagVec3 net[2][4];
    CagCurve *c[2], *image[2];
    for (int k = 0; k < 2; k++) {
      for (int j = 0; j < 4; j++) net[k][j] = random_location(3);
      const CagTransform f = plane_frame(net[k][0].x, net[k][0].y, i % 8 == 7 ? 0 : 0.3);
      const double radius = uniform(0.5, 2);
      if (i % 4 == 3 || (i % 4 == 1 && k))
        OK(cag_curve_arc(i % 8 == 7 ? radius : 2, radius, 0, 2 * M_PI, &f, &c[k], &err));
      else OK(cag_curve_bezier(net[k], NULL, 4, 2, &c[k], &err));
      OK(cag_curve_transform(c[k], &grow, &image[k], &err));
    }
    const CagVec3 p = random_location(4);
    for (int two = 0; two < 2; two++) {
      CagTangentLine *lines, *images;
      size_t n, m;
      if (two) {
        OK(cag_tangents_of_two(c[0], c[1], &lines, &n, &err));
        OK(cag_tangents_of_two(image[0], image[1], &images, &m, &err));
      } else {
        OK(cag_tangents_from_point(c[0], p, &lines, &n, &err));
        OK(cag_tangents_from_point(image[0], cag_transform_point(&grow, p), &images, &m, &err));
      }
      assert_int_equal(m, n);
      for (size_t k = 0; k < n; k++) {
        near_vec(cag_scaled(cag_sub(images[k].p, cag_transform_point(&grow, lines[k].p)), ratio),
                 cag_vec3(0, 0, 0), 1e-7);
        near_vec(cag_scaled(cag_sub(images[k].q, cag_transform_point(&grow, lines[k].q)), ratio),
                 cag_vec3(0, 0, 0), 1e-7);
        NEAR(images[k].t, lines[k].t, 1e-7);
        if (two) NEAR(images[k].t2, lines[k].t2, 1e-7);
      }
      seen += n;
      free(lines);
      free(images);
    }
    for (int k = 0; k < 2; k++) {
      cag_curve_release(c[k]);
      cag_curve_release(image[k]);
    }
  }
  assert_true(seen > 40);
}

// Circles that touch have three common tangents from outside and one from inside. Concentric
// circles have none.
static void touching_circles_have_the_tangent_of_their_point(void **state) {
  (void)state;
  static const struct {
    double x, r;
    size_t n;
  } cases[] = {{3, 2, 3}, {1, 2, 1}, {0, 2, 0}, {-3, 2, 3}, {3.001, 2, 4}, {2.999, 2, 2}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const CagTransform f = plane_frame(0, 0, 0), g = plane_frame(cases[i].x, 0, 0);
    CagCurve *a, *b;
    CagTangentLine *lines;
    size_t n;
    OK(cag_curve_arc(1, 1, -1, 2 * M_PI - 1, &f, &a, &err));
    OK(cag_curve_arc(cases[i].r, cases[i].r, -1, 2 * M_PI - 1, &g, &b, &err));
    OK(cag_tangents_of_two(a, b, &lines, &n, &err));
    assert_int_equal(n, cases[i].n);
    for (size_t k = 0; k < n; k++) {
      const CagVec3 d = cag_sub(lines[k].q, lines[k].p);
      assert_true(cag_norm(d) > 1e-3);
      NEAR(cag_dot(d, lines[k].p), 0, 1e-9);
    }
    free(lines);
    cag_curve_release(a);
    cag_curve_release(b);
  }
}

// --- Random fillets ---

// Between two lines, the arc begins at distance radius tan(turn / 2) from the corner.
static void fillets_of_lines_are_closed_forms(void **state) {
  (void)state;
  seed = 51;
  for (int i = 0; i < 100; i++) {
    const CagVec3 corner = random_location(3), before = random_location(3),
                  after = random_location(3);
    const CagVec3 a = cag_sub(corner, before), b = cag_sub(after, corner);
    const double across = a.x * b.y - a.y * b.x, turn = atan2(fabs(across), cag_dot(a, b));
    const double room = fmin(cag_norm(a), cag_norm(b)) / tan(turn / 2),
                 radius = room * uniform(0.1, 0.95);
    const double back = radius * tan(turn / 2);
    // In a third of the pairs, the lines cross before the end of the first and after the start of
    // the second.
    const CagVec3 end = i % 3 ? corner : cag_madd(corner, 0.2, a);
    const CagVec3 start = i % 3 ? corner : cag_madd(corner, -0.3, b);
    CagCurve *p, *q, *arc;
    CagVec3 in, out;
    double t, u, bend;
    OK(cag_curve_line(before, end, 2, &p, &err));
    OK(cag_curve_line(start, after, 2, &q, &err));
    OK(cag_fillet(p, q, radius, &arc, &t, &u, &err));
    near_vec(at(p, t), cag_madd(corner, -back, cag_unit(a)), 1e-9);
    near_vec(at(q, u), cag_madd(corner, back, cag_unit(b)), 1e-9);
    near_vec(at(arc, arc->start), at(p, t), 1e-9);
    near_vec(at(arc, arc->end), at(q, u), 1e-9);
    OK(cag_curve_tangent(arc, arc->start, CAG_SIDE_RIGHT, &in, &err));
    OK(cag_curve_tangent(arc, arc->end, CAG_SIDE_LEFT, &out, &err));
    near_vec(in, cag_unit(a), 1e-9);
    near_vec(out, cag_unit(b), 1e-9);
    OK(cag_curve_length(arc, arc->start, arc->end, &bend, &err));
    NEAR(bend, radius * turn, 1e-9 * (1 + bend));
    assert_int_equal(arc->dimension, 2);
    cag_curve_release(arc);
    FAILS(cag_fillet(p, q, room * 1.01, &arc, &t, &u, &err), "radius-too-large");
    FAILS(cag_fillet(p, q, 0, &arc, &t, &u, &err), "radius-not-positive");
    FAILS(cag_fillet(p, q, INFINITY, &arc, &t, &u, &err), "radius-not-positive");
    cag_curve_release(p);
    cag_curve_release(q);
  }
}

// From a line to a circle, and from a circle to a circle: checks the distances of the center.
static void fillets_of_arcs_touch_both(void **state) {
  (void)state;
  seed = 52;
  for (int i = 0; i < 60; i++) {
    const double r = uniform(1, 3), start = uniform(-1, 1), turn = uniform(0.4, 1.5);
    const bool left = i % 2, two = i % 4 >= 2;
    const double radius = uniform(0.05, 0.25), sign = left ? 1 : -1;
    // b begins at angle `start` and runs counter-clockwise; a arrives there, rotated by `turn`.
    const CagTransform f = plane_frame(0, 0, 0);
    const CagVec3 corner = {r * cos(start), r * sin(start), 0};
    const double way = start + M_PI / 2 - sign * turn;
    const CagVec3 d = {cos(way), sin(way), 0}, n = {-d.y, d.x, 0};
    CagCurve *a, *b, *arc;
    CagVec3 p[2], q[2], tangent, last;
    double t, u;
    OK(cag_curve_arc(r, r, start, start + 2, &f, &b, &err));
    const CagVec3 center_a = cag_madd(corner, 1.5, n); // to the left of a
    if (two) {
      const CagTransform g = plane_frame(center_a.x, center_a.y, way - M_PI / 2 - 1);
      OK(cag_curve_arc(1.5, 1.5, 0, 1, &g, &a, &err));
    } else {
      OK(cag_curve_line(cag_madd(corner, -2, d), corner, 2, &a, &err));
    }
    OK(cag_fillet(a, b, radius, &arc, &t, &u, &err));
    OK(cag_curve_eval(arc, arc->start, 1, CAG_SIDE_RIGHT, p, &err));
    OK(cag_curve_eval(arc, arc->end, 1, CAG_SIDE_LEFT, q, &err));
    near_vec(p[0], at(a, t), 1e-10);
    near_vec(q[0], at(b, u), 1e-10);
    OK(cag_curve_tangent(a, t, CAG_SIDE_LEFT, &tangent, &err));
    OK(cag_curve_tangent(b, u, CAG_SIDE_RIGHT, &last, &err));
    near_vec(cag_unit(p[1]), tangent, 1e-9);
    near_vec(cag_unit(q[1]), last, 1e-9);
    const CagVec3 u1 = cag_unit(p[1]);
    const CagVec3 center = cag_madd(p[0], sign * radius, cag_vec3(-u1.y, u1.x, 0));
    NEAR(cag_norm(center), left ? r - radius : r + radius, 1e-10);
    if (two) NEAR(cag_norm(cag_sub(center, center_a)), left ? 1.5 - radius : 1.5 + radius, 1e-10);
    else NEAR(cag_dot(cag_sub(center, corner), n), sign * radius, 1e-10);
    NEAR(cag_norm(cag_sub(at(arc, (arc->start + arc->end) / 2), center)), radius, 1e-12);
    double length;
    OK(cag_curve_length(arc, arc->start, arc->end, &length, &err));
    assert_true(length < M_PI * radius);
    cag_curve_release(arc);
    cag_curve_release(a);
    cag_curve_release(b);
  }
}

// The point and tangent of the parallel curve at a distance to the left.
static void parallel(const CagCurve *c, double t, double distance, CagVec3 *p, CagVec3 *tangent) {
  CagVec3 d[2];
  OK(cag_curve_eval(c, t, 1, t >= c->end ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, d, &err));
  *tangent = cag_unit(d[1]);
  *p = cag_madd(d[0], distance, cag_vec3(-tangent->y, tangent->x, 0));
}

// Fillets of curved parts are where the parallels at the radius cross, and only there.
static void fillets_of_bent_curves_are_where_parallels_cross(void **state) {
  (void)state;
  enum { STEPS = 500 };
  static CagVec3 p[STEPS + 1], q[STEPS + 1], along[STEPS + 1], beside[STEPS + 1];
  seed = 54;
  int rounded = 0, refused = 0;
  for (int round = 0; round < 150; round++) {
    CagVec3 v[4], w[4];
    for (int i = 0; i < 4; i++) {
      v[i] = random_location(3);
      w[i] = random_location(3);
    }
    w[0] = v[3];
    CagCurve *a, *b, *arc;
    CagVec3 ta, tb;
    OK(cag_curve_bezier(v, NULL, 4, 2, &a, &err));
    OK(cag_curve_bezier(w, NULL, 4, 2, &b, &err));
    OK(cag_curve_tangent(a, 1, CAG_SIDE_LEFT, &ta, &err));
    OK(cag_curve_tangent(b, 0, CAG_SIDE_RIGHT, &tb, &err));
    const double side = cag_cross(ta, tb).z > 0 ? 1 : -1;
    const double radius = pow(10, uniform(-1.3, 0.3));
    for (int i = 0; i <= STEPS; i++) {
      parallel(a, (double)i / STEPS, side * radius, &p[i], &along[i]);
      parallel(b, (double)i / STEPS, side * radius, &q[i], &beside[i]);
    }
    // Counts only crossings at large angles, away from the ends and from where the parallels turn
    // back.
    int crossings = 0;
    for (int i = 2; i + 3 < STEPS; i++)
      for (int j = 2; j + 3 < STEPS; j++) {
        const CagVec3 d = cag_sub(p[i + 1], p[i]), e = cag_sub(q[j + 1], q[j]);
        const CagVec3 r = cag_sub(q[j], p[i]);
        if (fabs(r.x) + fabs(r.y) > cag_norm(d) + cag_norm(e)) continue;
        const double det = cag_cross(d, e).z, x = cag_cross(r, e).z / det,
                     y = cag_cross(r, d).z / det;
        crossings +=
            x >= 0 && x < 1 && y >= 0 && y < 1 && fabs(det) > 0.1 * cag_norm(d) * cag_norm(e);
      }
    double t, u;
    if (cag_fillet(a, b, radius, &arc, &t, &u, &err) == CAG_OK) {
      CagVec3 center, same, in, out, first, last;
      parallel(a, t, side * radius, &center, &in);
      parallel(b, u, side * radius, &same, &out);
      near_vec(same, center, 1e-10);
      near_vec(at(arc, arc->start), at(a, t), 1e-10);
      near_vec(at(arc, arc->end), at(b, u), 1e-10);
      OK(cag_curve_tangent(arc, arc->start, CAG_SIDE_RIGHT, &first, &err));
      OK(cag_curve_tangent(arc, arc->end, CAG_SIDE_LEFT, &last, &err));
      near_vec(first, in, 1e-9);
      near_vec(last, out, 1e-9);
      near_vec(cag_scaled(cag_sub(at(arc, arc->start + 0.3 * (arc->end - arc->start)), center),
                          1 / radius),
               cag_unit(cag_sub(at(arc, arc->start + 0.3 * (arc->end - arc->start)), center)),
               1e-9);
      cag_curve_release(arc);
      rounded++;
    } else {
      assert_string_equal(cag_error_info(err.id)->reason, "radius-too-large");
      assert_int_equal(crossings, 0);
      refused++;
    }
    cag_curve_release(a);
    cag_curve_release(b);
  }
  assert_true(rounded > 50 && refused > 20);
}

static void what_has_no_corner_is_refused(void **state) {
  (void)state;
  CagCurve *a, *b, *arc, *space;
  double t, u;
  OK(cag_curve_line(cag_vec3(0, 0, 0), cag_vec3(2, 0, 0), 2, &a, &err));
  OK(cag_curve_line(cag_vec3(2, 0, 0), cag_vec3(4, 1e-10, 0), 2, &b, &err));
  FAILS(cag_fillet(a, b, 1, &arc, &t, &u, &err), "no-corner");
  cag_curve_release(b);
  OK(cag_curve_line(cag_vec3(2, 0, 0), cag_vec3(1, 1e-10, 0), 2, &b, &err));
  FAILS(cag_fillet(a, b, 1e-3, &arc, &t, &u, &err), "no-corner");
  cag_curve_release(b);
  OK(cag_curve_line(cag_vec3(2, 1, 0), cag_vec3(4, 1, 0), 2, &b, &err));
  FAILS(cag_fillet(a, b, 1, &arc, &t, &u, &err), "curves-do-not-meet");
  OK(cag_curve_to_space(b, &space, &err));
  FAILS(cag_fillet(a, space, 1, &arc, &t, &u, &err), "not-planar");
  FAILS(cag_fillet(space, b, 1, &arc, &t, &u, &err), "not-planar");
  cag_curve_release(space);
  cag_curve_release(b);
  cag_curve_release(a);
}

// A polyline in the plane or in space: each corner shortens it by 2 r tan(turn / 2) and adds r
// turn.
static void random_polylines_are_rounded(void **state) {
  (void)state;
  seed = 53;
  for (int i = 0; i < 60; i++) {
    CagVec3 p[6];
    const bool closed = i % 2, space = i % 4 >= 2;
    const size_t n = 6;
    for (size_t k = 0; k < n; k++) {
      const double angle = 2 * M_PI * (double)k / 6;
      p[k] = cag_add(cag_vec3(4 * cos(angle), 4 * sin(angle), 0), random_location(0.8));
      if (space) p[k].z = uniform(-1, 1);
    }
    if (i % 3 == 0) p[2] = cag_lerp(p[1], p[3], 0.4); // straight
    const double radius = uniform(0.1, 0.5);
    double expected = 0, length;
    CagVec3 corner_in = {0, 0, 0};
    for (size_t k = 0; k < n; k++) {
      if (!closed && k + 1 == n) break;
      expected += cag_norm(cag_sub(p[(k + 1) % n], p[k]));
    }
    for (size_t k = 0; k < n; k++) {
      if (!closed && (k == 0 || k + 1 == n)) continue;
      const CagVec3 a = cag_unit(cag_sub(p[k], p[(k + n - 1) % n]));
      const CagVec3 b = cag_unit(cag_sub(p[(k + 1) % n], p[k]));
      const double turn = atan2(cag_norm(cag_cross(a, b)), cag_dot(a, b));
      expected += radius * (turn - 2 * tan(turn / 2));
      if (k == 1) corner_in = cag_madd(p[k], -radius * tan(turn / 2), a);
    }
    CagCurve *c, *r;
    OK(cag_curve_polyline(p, n, closed, space ? 3 : 2, &c, &err));
    OK(cag_curve_rounded(c, radius, &r, &err));
    assert_true(r->closed == closed && r->dimension == c->dimension);
    OK(cag_curve_length(r, r->start, r->end, &length, &err));
    NEAR(length, expected, 1e-9);
    // The result is smooth, and passes through the first point of the corner's arc.
    double *cuts, distance, t;
    size_t count;
    CagVec3 nearest;
    OK(cag_curve_cuts(r, &cuts, &count, &err));
    for (size_t k = 1; k + 1 < count; k++) {
      CagVec3 before, after;
      OK(cag_curve_tangent(r, cuts[k], CAG_SIDE_LEFT, &before, &err));
      OK(cag_curve_tangent(r, cuts[k], CAG_SIDE_RIGHT, &after, &err));
      near_vec(before, after, 1e-9);
    }
    OK(cag_curve_closest(r, corner_in, &t, &nearest, &distance, &err));
    NEAR(distance, 0, 1e-9);
    if (!closed) {
      near_vec(at(r, r->start), p[0], 0);
      near_vec(at(r, r->end), p[n - 1], 0);
    }
    free(cuts);
    cag_curve_release(r);
    cag_curve_release(c);
  }
}

// A half disk, whose two corners are right angles between a line and an arc.
static void corners_of_other_curves_are_rounded(void **state) {
  (void)state;
  const double R = 3, r = 0.5;
  // The center is at height r above the diameter, and at distance R - r from the disk's center.
  const double x = sqrt((R - r) * (R - r) - r * r);
  const double expected = 2 * x + 2 * r * (M_PI - acos(r / (R - r))) + R * 2 * acos(r / (R - r));
  for (int first = 0; first < 3; first++) {
    const CagTransform f = plane_frame(1, 2, 0);
    CagCurve *parts[3], *c, *rounded;
    double length;
    const CagVec3 a = {1 - R, 2, 0}, b = {1 + R, 2, 0}, middle = {1.3, 2, 0};
    size_t n = 0;
    // The seam is at a corner, or inside the line.
    if (first == 2) OK(cag_curve_line(middle, b, 2, &parts[n++], &err));
    if (first == 1) OK(cag_curve_line(a, b, 2, &parts[n++], &err));
    OK(cag_curve_arc(R, R, 0, M_PI, &f, &parts[n++], &err));
    if (first == 2) OK(cag_curve_line(a, middle, 2, &parts[n++], &err));
    if (first == 0) OK(cag_curve_line(a, b, 2, &parts[n++], &err));
    OK(cag_curve_join(parts, n, &c, &err));
    OK(cag_curve_rounded(c, r, &rounded, &err));
    OK(cag_curve_length(rounded, rounded->start, rounded->end, &length, &err));
    NEAR(length, expected, 1e-9);
    assert_true(rounded->closed);
    cag_curve_release(rounded);
    assert_int_not_equal(cag_curve_rounded(c, 1.6, &rounded, &err), CAG_OK);
    assert_string_equal(cag_error_info(err.id)->reason, "radius-too-large");
    while (n > 0) cag_curve_release(parts[--n]);
    cag_curve_release(c);
  }
  const CagVec3 bend[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}};
  CagCurve *c, *rounded;
  OK(cag_curve_bezier(bend, NULL, 4, 3, &c, &err));
  FAILS(cag_curve_rounded(c, 0.1, &rounded, &err), "not-planar");
  cag_curve_release(c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_corner_has_four_circles),
      cmocka_unit_test(circles_touch_from_outside_and_inside),
      cmocka_unit_test(tangents_from_a_point_touch),
      cmocka_unit_test(two_circles_have_up_to_four_tangents),
      cmocka_unit_test(two_ellipses_have_their_tangents),
      cmocka_unit_test(a_fillet_leaves_and_enters_along_the_tangents),
      cmocka_unit_test(rounding_shortens_by_what_the_arcs_save),
      cmocka_unit_test(random_circles_touch_as_chosen),
      cmocka_unit_test(circles_that_just_reach_are_found),
      cmocka_unit_test(tangents_from_random_points),
      cmocka_unit_test(random_ellipses_have_their_common_tangents),
      cmocka_unit_test(tangent_lines_have_images),
      cmocka_unit_test(touching_circles_have_the_tangent_of_their_point),
      cmocka_unit_test(fillets_of_lines_are_closed_forms),
      cmocka_unit_test(fillets_of_arcs_touch_both),
      cmocka_unit_test(fillets_of_bent_curves_are_where_parallels_cross),
      cmocka_unit_test(what_has_no_corner_is_refused),
      cmocka_unit_test(random_polylines_are_rounded),
      cmocka_unit_test(corners_of_other_curves_are_rounded),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
