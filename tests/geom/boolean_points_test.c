// Points of set operations and the predicates on them, compared with exact fractions. The points
// are intersections of lines and planes of a small grid, so most predicates are close to
// degenerate.

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "geom/boolean/work.h"
#include "tests/geom/random.h"

__extension__ typedef __int128 Whole;

static int whole(int low, int high) { return low + (int)uniform(0, high - low + 1); }
static int sign(Whole x) { return (x > 0) - (x < 0); }

// x[k] / w; w > 0, in lowest terms.
typedef struct Fraction {
  Whole x[3], w;
} Fraction;

#define MOST 4000

static BoolPoints points;
static Fraction known[MOST]; // by point number
static bool far[MOST];       // added without searching for an equal point

static Fraction lowest(Fraction f) {
  Whole g = f.w;
  for (int k = 0; k < 3; k++)
    for (Whole b = f.x[k], r; b != 0; b = r) r = g % b, g = b;
  if ((g < 0) != (f.w < 0)) g = -g;
  for (int k = 0; k < 3; k++) f.x[k] /= g;
  f.w /= g;
  return f;
}

static bool are_equal(const Fraction *a, const Fraction *b) {
  return a->x[0] * b->w == b->x[0] * a->w && a->x[1] * b->w == b->x[1] * a->w &&
         a->x[2] * b->w == b->x[2] * a->w;
}

// Checks the number of a new point: that of an equal point before, or the next free one.
static void enter(uint32_t number, size_t count, Fraction f, bool is_far) {
  size_t expected = count;
  f = lowest(f);
  for (size_t i = 0; i < count && !is_far; i++)
    if (!far[i] && are_equal(&known[i], &f)) expected = i;
  assert_int_equal(number, expected);
  assert_int_equal(points.n, expected == count ? count + 1 : count);
  assert_true(points.n < MOST);
  if (expected < count) return;
  known[number] = f;
  far[number] = is_far;
  const CagVec3 at = points.at[number];
  const double w = (double)f.w;
  // The numbers are below 2^53, so each quotient is rounded once.
  assert_true(at.x == (double)f.x[0] / w && at.y == (double)f.x[1] / w &&
              at.z == (double)f.x[2] / w);
}

// --- Exact coordinates ---

static Whole turned(const Fraction *a, const Fraction *b, const Fraction *c, int axis) {
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  return a->w * (b->x[i] * c->x[j] - b->x[j] * c->x[i]) +
         b->w * (c->x[i] * a->x[j] - c->x[j] * a->x[i]) +
         c->w * (a->x[i] * b->x[j] - a->x[j] * b->x[i]);
}

// The normal of the plane of three points, multiplied by a positive number.
static void normal_of(const uint32_t plane[3], Whole n[3]) {
  for (int k = 0; k < 3; k++)
    n[k] = turned(&known[plane[0]], &known[plane[1]], &known[plane[2]], k);
}

static Whole side_of(const uint32_t plane[3], const Fraction *f) {
  const Fraction *a = &known[plane[0]];
  Whole n[3], sum = 0;
  normal_of(plane, n);
  for (int k = 0; k < 3; k++) sum += n[k] * (f->x[k] * a->w - a->x[k] * f->w);
  return sum;
}

// normal . x = offset
typedef struct Equation {
  Whole n[3], offset;
} Equation;

static Equation plane_through(const uint32_t plane[3]) {
  Equation e = {.offset = 0};
  const Fraction *a = &known[plane[0]];
  normal_of(plane, e.n);
  for (int k = 0; k < 3; k++) e.offset += e.n[k] * a->x[k];
  for (int k = 0; k < 3; k++) e.n[k] *= a->w;
  return e;
}

static Equation cut_of(BoolCut c) {
  if (c.c != BOOL_NONE) return plane_through((const uint32_t[3]){c.a, c.b, c.c});
  const int i = (c.axis + 1) % 3, j = (c.axis + 2) % 3;
  const Fraction *a = &known[c.a], *b = &known[c.b];
  Equation e = {.offset = 0};
  e.n[i] = b->x[j] * a->w - a->x[j] * b->w;
  e.n[j] = -(b->x[i] * a->w - a->x[i] * b->w);
  e.offset = e.n[i] * a->x[i] + e.n[j] * a->x[j];
  e.n[i] *= a->w;
  e.n[j] *= a->w;
  return e;
}

static Whole determinant(const Whole a[3], const Whole b[3], const Whole c[3]) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

static Fraction solution(Equation e[3]) {
  Fraction f = {.w = determinant(e[0].n, e[1].n, e[2].n)};
  for (int k = 0; k < 3; k++) {
    Whole rows[3][3];
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) rows[i][j] = j == k ? e[i].offset : e[i].n[j];
    f.x[k] = determinant(rows[0], rows[1], rows[2]);
  }
  return f;
}

// --- Grid points, and points constructed from them ---

#define GIVEN 14

static void begin(int origin) {
  assert_true(cag_bool_points_start(&points, 1));
  for (size_t i = 0; points.n < GIVEN; i++) {
    Fraction f = {{origin + whole(-3, 3), whole(-3, 3), whole(-3, 3) - origin}, 1};
    const CagVec3 at = {(double)f.x[0], (double)f.x[1], (double)f.x[2]};
    const size_t n = points.n;
    const uint32_t number = cag_bool_points_add(&points, at);
    enter(number, n, f, false);
    assert_int_equal(cag_bool_points_add(&points, at), number);
    assert_int_equal(points.n, n > number ? n : n + 1);
  }
}

static uint32_t random_given(void) { return (uint32_t)whole(0, GIVEN - 1); }

static uint32_t any(void) {
  for (;;) {
    const uint32_t i = (uint32_t)whole(0, (int)points.n - 1);
    if (known[i].w < 3000) return i; // products of larger ones overflow
  }
}

// Three of the given points that are not collinear.
static void random_plane(uint32_t plane[3]) {
  Whole n[3];
  do {
    for (int k = 0; k < 3; k++) plane[k] = random_given();
    normal_of(plane, n);
  } while (n[0] == 0 && n[1] == 0 && n[2] == 0);
}

static void add_crossing(void) {
  uint32_t plane[3];
  random_plane(plane);
  const uint32_t a = random_given(), b = random_given();
  const Whole s = side_of(plane, &known[a]), t = side_of(plane, &known[b]);
  if (sign(s) * sign(t) >= 0) return;
  Fraction f = {.w = t - s};
  for (int k = 0; k < 3; k++) f.x[k] = known[a].x[k] * t - known[b].x[k] * s;
  const size_t n = points.n;
  enter(cag_bool_points_cross(&points, a, b, plane), n, f, false);
}

static BoolCut random_cut(void) {
  uint32_t plane[3];
  random_plane(plane);
  return (BoolCut){plane[0], plane[1], whole(0, 1) ? plane[2] : BOOL_NONE, whole(0, 2)};
}

static void add_meeting(void) {
  uint32_t plane[3];
  random_plane(plane);
  const BoolCut one = random_cut();
  BoolCut two = random_cut();
  if (two.c == BOOL_NONE && whole(0, 1)) two.a = any(); // an edge to a constructed point
  Equation e[3] = {plane_through(plane), cut_of(one), cut_of(two)};
  const Fraction f = solution(e);
  const size_t n = points.n;
  const uint32_t number = cag_bool_points_meet(&points, plane, one, two);
  if (f.w == 0) assert_int_equal(number, BOOL_NONE);
  else enter(number, n, f, false);
}

static void add_put(void) {
  uint32_t planes[3][3];
  Equation e[3];
  const int n = whole(1, 3), first = whole(0, 2), second = (first + whole(1, 2)) % 3;
  const int kept[2] = {first, second};
  const uint32_t from = any();
  for (int k = 0; k < n; k++) {
    random_plane(planes[k]);
    e[k] = plane_through(planes[k]);
  }
  for (int k = n; k < 3; k++) {
    e[k] = (Equation){.offset = known[from].x[kept[k - n]]};
    e[k].n[kept[k - n]] = known[from].w;
  }
  const Fraction f = solution(e);
  const size_t count = points.n;
  const uint32_t number = cag_bool_points_put(&points, from, (const uint32_t(*)[3])planes, n, kept);
  if (f.w == 0) assert_int_equal(number, BOOL_NONE);
  else enter(number, count, f, false);
}

static void add_centroid(void) {
  uint32_t v[3];
  Fraction f = {.w = 3};
  for (int k = 0; k < 3; k++) v[k] = k ? random_given() : any();
  for (int i = 0; i < 3; i++) f.w *= known[v[i]].w;
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) f.x[k] += known[v[i]].x[k] * (f.w / 3 / known[v[i]].w);
  const size_t n = points.n;
  enter(cag_bool_points_centroid(&points, v), n, f, true);
}

// --- Predicates ---

static void ask_once(void) {
  uint32_t v[4], m[3], n[3];
  Whole p[3], q[3];
  for (int k = 0; k < 4; k++) v[k] = any();
  const int axis = whole(0, 2), i = (axis + 1) % 3, j = (axis + 2) % 3;
  const Fraction *a = &known[v[0]], *b = &known[v[1]], *c = &known[v[2]], *d = &known[v[3]];
  int all = 0;
  for (int k = 0; k < 3; k++) {
    const int order = sign(b->x[k] * a->w - a->x[k] * b->w);
    assert_int_equal(cag_bool_compare(&points, v[0], v[1], k), order);
    if (all == 0) all = order;
  }
  assert_int_equal(cag_bool_compare_all(&points, v[0], v[1]), all);
  assert_int_equal(cag_bool_turn(&points, v[0], v[1], v[2], axis), sign(turned(a, b, c, axis)));
  assert_int_equal(cag_bool_normal_sign(&points, v, axis), sign(turned(a, b, c, axis)));
  assert_int_equal(cag_bool_side(&points, v, v[3]), sign(side_of(v, d)));
  // For one of the planes, all points are given points, as for most planes of operands.
  random_plane(m);
  for (int k = 0; k < 3; k++) n[k] = whole(0, 3) ? random_given() : v[k];
  normal_of(m, p);
  normal_of(n, q);
  Whole dot = 0;
  for (int k = 0; k < 3; k++) dot += p[k] * q[k];
  assert_int_equal(cag_bool_normals_dot(&points, m, n), sign(dot));
  assert_int_equal(cag_bool_normals_dot(&points, n, m), sign(dot));
  const int cross = sign(p[i] * q[j] - p[j] * q[i]);
  assert_int_equal(cag_bool_normals_cross(&points, m, n, axis), cross);
  assert_int_equal(cag_bool_normals_cross(&points, n, m, axis), -cross);
}

static void check_first(void) {
  for (uint32_t i = 0; i < points.n; i++) {
    if (far[i]) continue;
    uint32_t first = i;
    for (uint32_t k = 0; k < i; k++)
      if (!far[k] && points.at[k].x == points.at[i].x && points.at[k].y == points.at[i].y &&
          points.at[k].z == points.at[i].z) {
        first = k;
        break;
      }
    assert_int_equal(cag_bool_points_first(&points, i), first);
  }
}

static void points_are_those_of_fractions(void **state) {
  (void)state;
  seed = 3;
  for (int trial = 0; trial < 24; trial++) {
    begin(trial % 3 == 2 ? 20 : 0);
    for (int i = 0; i < 150; i++) {
      add_crossing();
      if (i % 3 == 0) add_meeting();
      if (i % 3 == 1) add_put();
      if (i % 10 == 0) add_centroid();
      for (int k = 0; k < 10; k++) ask_once();
    }
    check_first();
    assert_true(points.n > 60);
    cag_bool_points_free(&points);
  }
}

// Zeros of both signs are one point. Auxiliary points are always new.
static void zeros_and_far_points(void **state) {
  (void)state;
  assert_true(cag_bool_points_start(&points, 0));
  const uint32_t zero = cag_bool_points_add(&points, cag_vec3(0.0, -0.0, 0.0));
  assert_int_equal(cag_bool_points_add(&points, cag_vec3(-0.0, 0.0, -0.0)), zero);
  const uint32_t one = cag_bool_points_add_far(&points, cag_vec3(0, 0, 0));
  assert_int_not_equal(one, zero);
  assert_int_not_equal(cag_bool_points_add_far(&points, cag_vec3(0, 0, 0)), one);
  assert_int_equal(cag_bool_points_add(&points, cag_vec3(0, 0, 0)), zero);
  cag_bool_points_free(&points);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(points_are_those_of_fractions),
      cmocka_unit_test(zeros_and_far_points),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
