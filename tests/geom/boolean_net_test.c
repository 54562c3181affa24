// The triangulations used to cut the faces of set operations, compared with brute force: random
// points of a small grid in tilted planes, and segments that cross, overlap, and touch.

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "geom/boolean/net.h"
#include "tests/geom/random.h"

static int whole(int low, int high) { return low + (int)uniform(0, high - low + 1); }

// --- Points and segments of a trial ---

#define MOST 24

// A point in the projection plane: (x / w, y / w).
typedef struct Rational {
  long x, y, w;
} Rational;

typedef struct Trial {
  int axis, slope[2];
  BoolPoints points;
  BoolNet net;
  uint32_t plane[3];
  long x[MOST], y[MOST];
  uint32_t number[MOST];
  size_t n;
  int from[MOST], to[MOST]; // segments, by their points
  size_t segments;
  Rational all[4 * MOST * MOST]; // the points, and the intersections of segments, each once
  size_t all_count;
} Trial;

static CagVec3 lifted(const Trial *t, long x, long y) {
  double at[3];
  at[(t->axis + 1) % 3] = (double)x;
  at[(t->axis + 2) % 3] = (double)y;
  at[t->axis] = (double)(t->slope[0] * x + t->slope[1] * y);
  return cag_vec3(at[0], at[1], at[2]);
}

static double seen(const Trial *t, uint32_t v, int k) {
  const CagVec3 p = t->points.at[v];
  const double at[3] = {p.x, p.y, p.z};
  return at[(t->axis + 1 + k) % 3];
}

static void note(Trial *t, Rational r) {
  for (size_t i = 0; i < t->all_count; i++) {
    const Rational *q = &t->all[i];
    if (q->x * r.w == r.x * q->w && q->y * r.w == r.y * q->w) return;
  }
  t->all[t->all_count++] = r;
}

static long cross(long ax, long ay, long bx, long by) { return ax * by - ay * bx; }

static void note_all(Trial *t) {
  t->all_count = 0;
  for (size_t i = 0; i < t->n; i++) note(t, (Rational){t->x[i], t->y[i], 1});
  for (size_t i = 0; i < t->segments; i++)
    for (size_t k = 0; k < i; k++) {
      const int a = t->from[i], b = t->to[i], c = t->from[k], d = t->to[k];
      const long ux = t->x[b] - t->x[a], uy = t->y[b] - t->y[a];
      const long vx = t->x[d] - t->x[c], vy = t->y[d] - t->y[c];
      const long wx = t->x[c] - t->x[a], wy = t->y[c] - t->y[a];
      const long det = cross(ux, uy, vx, vy), sign = det < 0 ? -1 : 1;
      const long s = cross(wx, wy, vx, vy) * sign, r = cross(wx, wy, ux, uy) * sign;
      if (det == 0 || s < 0 || r < 0 || s > det * sign || r > det * sign) continue;
      note(t, (Rational){t->x[a] * det * sign + s * ux, t->y[a] * det * sign + s * uy, det * sign});
    }
}

// The number of points inside a segment, without its ends.
static size_t count_within(const Trial *t, size_t segment) {
  const int a = t->from[segment], b = t->to[segment];
  const long ux = t->x[b] - t->x[a], uy = t->y[b] - t->y[a];
  size_t count = 0;
  for (size_t i = 0; i < t->all_count; i++) {
    const Rational *r = &t->all[i];
    const long wx = r->x - t->x[a] * r->w, wy = r->y - t->y[a] * r->w, along = wx * ux + wy * uy;
    count += cross(ux, uy, wx, wy) == 0 && along > 0 && along < r->w * (ux * ux + uy * uy);
  }
  return count;
}

// --- Properties of a net ---

static int turn(Trial *t, uint32_t a, uint32_t b, uint32_t c) {
  return cag_bool_turn(&t->points, a, b, c, t->axis);
}

static bool is_ahead(const Trial *t, uint32_t a, uint32_t b, uint32_t v) {
  double along = 0;
  for (int k = 0; k < 2; k++)
    along += (seen(t, b, k) - seen(t, a, k)) * (seen(t, v, k) - seen(t, a, k));
  return along > 0;
}

// Positive if the last corner is inside the circle through the other three, in a cell of size 1.
static double circle(const Trial *t, const uint32_t v[3], uint32_t d) {
  double m[3][3], value = 0, size = 0;
  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < 2; k++) m[i][k] = seen(t, v[i], k) - seen(t, d, k);
    m[i][2] = m[i][0] * m[i][0] + m[i][1] * m[i][1];
  }
  for (int i = 0; i < 3; i++) {
    const double *p = m[(i + 1) % 3], *q = m[(i + 2) % 3];
    value += m[i][2] * (p[0] * q[1] - p[1] * q[0]);
    size += m[i][2] * (fabs(p[0] * q[1]) + fabs(p[1] * q[0]));
  }
  return value / size;
}

// Checks that cells run counter-clockwise, know their neighbors, and fill the first triangle. Edges
// that may be flipped must satisfy the Delaunay condition. Returns the number of edges on the
// border.
static size_t check_cells(Trial *t, const uint32_t corners[3], bool improved) {
  const BoolCell *cells = bool_cells(&t->net);
  double area = 0, filled = 0;
  size_t border = 0;
  for (size_t i = 0; i < t->net.cells.n; i++) {
    const BoolCell *c = &cells[i];
    assert_true(turn(t, c->v[0], c->v[1], c->v[2]) > 0);
    for (int k = 0; k < 3; k++) {
      const uint32_t a = c->v[(k + 1) % 3], b = c->v[(k + 2) % 3];
      filled += seen(t, a, 0) * seen(t, b, 1) - seen(t, a, 1) * seen(t, b, 0);
      border += c->neighbor[k] == BOOL_NONE;
      if (c->neighbor[k] == BOOL_NONE) continue;
      const BoolCell *o = &cells[c->neighbor[k]];
      int j = 0;
      while (j < 3 && o->neighbor[j] != i) j++;
      assert_true(j < 3);
      assert_true(o->v[(j + 1) % 3] == b && o->v[(j + 2) % 3] == a);
      assert_true(o->fixed[j] == c->fixed[k]);
      if (improved && c->fixed[k] == BOOL_NONE) assert_true(circle(t, c->v, o->v[j]) < 1e-12);
    }
  }
  for (int k = 0; k < 3; k++) {
    const uint32_t a = corners[k], b = corners[(k + 1) % 3];
    area += seen(t, a, 0) * seen(t, b, 1) - seen(t, a, 1) * seen(t, b, 0);
  }
  assert_true(fabs(filled - fabs(area)) < 1e-11 * fabs(area));
  for (size_t i = 0; i < t->net.vertices.n; i++) {
    const uint32_t v = ((uint32_t *)t->net.vertices.items)[i];
    const BoolCell *c = &cells[t->net.cell_of[v]];
    assert_true(c->v[0] == v || c->v[1] == v || c->v[2] == v);
  }
  // Euler's formula: the number of cells is twice the number of inner points, plus the points on
  // the border, minus two.
  assert_int_equal(t->net.cells.n, 2 * t->net.vertices.n - border - 2);
  return border;
}

// Walks along a segment, and checks that each step is an edge on it, fixed on both sides. Returns
// the number of steps.
static size_t check_walk(Trial *t, uint32_t a, uint32_t b) {
  size_t steps = 0;
  for (uint32_t at = a, next; at != b; at = next, steps++) {
    uint32_t cell;
    int e;
    next = cag_bool_net_step(&t->net, at, b, &cell, &e);
    assert_true(next != BOOL_NONE && steps < 1000);
    const BoolCell *c = &bool_cells(&t->net)[cell];
    assert_true(c->v[(e + 1) % 3] == at && c->v[(e + 2) % 3] == next);
    assert_int_equal(turn(t, a, b, next), 0);
    assert_true(is_ahead(t, at, b, next));
    assert_true(next == b || is_ahead(t, b, at, next));
    const uint32_t fixed = c->fixed[e];
    assert_true(fixed < t->net.cuts.n);
    const BoolCut *cut = (BoolCut *)t->net.cuts.items + fixed;
    assert_true(turn(t, cut->a, cut->b, at) == 0 && turn(t, cut->a, cut->b, next) == 0);
    for (int k = 0; k < 2; k++) {
      const uint32_t end = k ? next : at;
      assert_true(end == cut->a || is_ahead(t, cut->a, cut->b, end));
      assert_true(end == cut->b || is_ahead(t, cut->b, cut->a, end));
    }
  }
  return steps;
}

// Checks that the step is an edge of the net toward the end of the walk, whether or not it is part
// of a segment.
static void check_step(Trial *t, uint32_t a, uint32_t b) {
  uint32_t expected = BOOL_NONE, cell;
  int e;
  for (size_t i = 0; i < t->net.cells.n; i++) {
    const uint32_t *v = bool_cells(&t->net)[i].v;
    if (v[0] != a && v[1] != a && v[2] != a) continue;
    for (int k = 0; k < 3; k++)
      if (v[k] != a && turn(t, a, b, v[k]) == 0 && is_ahead(t, a, b, v[k])) expected = v[k];
  }
  const uint32_t found = cag_bool_net_step(&t->net, a, b, &cell, &e);
  // On the border, the net may be only on the right of the step.
  bool left = false;
  for (size_t i = 0; i < t->net.cells.n; i++)
    for (int k = 0; k < 3; k++) {
      const uint32_t *v = bool_cells(&t->net)[i].v;
      left = left || (v[k] == a && v[(k + 1) % 3] == expected);
    }
  assert_int_equal(found, left ? expected : BOOL_NONE);
}

// --- Trials ---

// Starts with points of a right triangle at the origin, many of them on its border. The first
// triangle of the net is this triangle, or a large one around it.
static void start(Trial *t, int side, bool far) {
  uint32_t corners[3];
  static const long around[3][2] = {{-40, -30}, {90, -35}, {-45, 110}};
  const long inner[3][2] = {{0, 0}, {side, 0}, {0, side}};
  const bool right = whole(0, 1); // the net reverses a clockwise triangle
  for (int k = 0; k < 3; k++) {
    const int from = right ? 2 - k : k;
    const long(*c)[2] = far ? &around[from] : &inner[from];
    corners[k] = far ? cag_bool_points_add_far(&t->points, lifted(t, (*c)[0], (*c)[1]))
                     : cag_bool_points_add(&t->points, lifted(t, (*c)[0], (*c)[1]));
  }
  assert_true(cag_bool_net_start(&t->net, corners));
  t->n = 0;
  for (int k = 0; !far && k < 3; k++) {
    t->x[t->n] = inner[right ? 2 - k : k][0];
    t->y[t->n] = inner[right ? 2 - k : k][1];
    t->number[t->n++] = corners[k];
  }
}

static void add_points(Trial *t, int side, int wanted) {
  for (int i = 0; i < wanted && t->n < MOST; i++) {
    const int x = whole(0, side), y = whole(0, side - x);
    t->x[t->n] = x;
    t->y[t->n] = y;
    t->number[t->n] = cag_bool_points_add(&t->points, lifted(t, x, y));
    assert_true(cag_bool_net_add_point(&t->net, t->number[t->n]));
    t->n++;
  }
}

static void add_segments(Trial *t, int wanted) {
  t->segments = 0;
  for (int i = 0; i < wanted; i++) {
    const int a = whole(0, (int)t->n - 1), b = whole(0, (int)t->n - 1);
    if (t->number[a] == t->number[b]) continue;
    t->from[t->segments] = a;
    t->to[t->segments++] = b;
    const BoolCut cut = {t->number[a], t->number[b], BOOL_NONE, t->axis};
    assert_true(cag_bool_net_add_segment(&t->net, t->number[a], t->number[b], cut));
  }
}

static void check_trial(Trial *t, int side, bool far) {
  start(t, side, far);
  uint32_t corners[3];
  memcpy(corners, bool_cells(&t->net)[0].v, sizeof corners);
  add_points(t, side, whole(0, 20));
  t->segments = 0;
  note_all(t);
  assert_int_equal(t->net.vertices.n, t->all_count + (far ? 3 : 0));
  check_cells(t, corners, true);
  for (int i = 0; i < 10 && t->n > 1; i++) {
    const int a = whole(0, (int)t->n - 1), b = whole(0, (int)t->n - 1);
    if (t->number[a] != t->number[b]) check_step(t, t->number[a], t->number[b]);
  }
  if (t->n > 1) add_segments(t, whole(0, 16));
  note_all(t);
  check_cells(t, corners, false);
  assert_true(cag_bool_net_improve(&t->net));
  check_cells(t, corners, true);
  assert_int_equal(t->net.vertices.n, t->all_count + (far ? 3 : 0));
  // Each fixed edge is part of a segment, so the walks pass all of them.
  size_t fixed = 0;
  for (size_t i = 0; i < t->net.cells.n; i++)
    for (int k = 0; k < 3; k++) {
      const BoolCell *c = &bool_cells(&t->net)[i];
      const uint32_t a = c->v[(k + 1) % 3], b = c->v[(k + 2) % 3];
      bool part = false;
      for (size_t s = 0; s < t->segments && !part; s++) {
        const uint32_t p = t->number[t->from[s]], q = t->number[t->to[s]];
        part = turn(t, p, q, a) == 0 && turn(t, p, q, b) == 0;
        for (int end = 0; end < 2 && part; end++) {
          const uint32_t v = end ? b : a;
          part = (v == p || is_ahead(t, p, q, v)) && (v == q || is_ahead(t, q, p, v));
        }
      }
      assert_int_equal(part, c->fixed[k] != BOOL_NONE);
      fixed += part;
    }
  for (size_t s = 0; s < t->segments; s++) {
    // The cell to the left of a step. On the border, the step is taken in the direction that has
    // the net on its left.
    const int a = t->from[s], b = t->to[s];
    const long x = t->x[a] + t->x[b], y = t->y[a] + t->y[b];
    const bool on_border = !far && ((t->x[a] == 0 && t->x[b] == 0) ||
                                    (t->y[a] == 0 && t->y[b] == 0) || x + y == 2 * side);
    const bool back = on_border && cross(t->x[b] - t->x[a], t->y[b] - t->y[a], side - 3 * t->x[a],
                                         side - 3 * t->y[a]) < 0;
    const size_t steps = back ? check_walk(t, t->number[b], t->number[a])
                              : check_walk(t, t->number[a], t->number[b]);
    assert_int_equal(steps, count_within(t, s) + 1);
  }
  assert_true(fixed > 0 || t->segments == 0);
}

// The same net and points are reused for several triangulations.
static void random_points_and_segments(void **state) {
  (void)state;
  Trial *t = calloc(1, sizeof *t);
  assert_non_null(t);
  seed = 1;
  for (int trial = 0; trial < 640; trial++) {
    const int side = whole(2, 12);
    if (trial % 8 == 0) {
      if (trial > 0) {
        cag_bool_points_free(&t->points);
        cag_bool_net_free(&t->net);
      }
      *t = (Trial){.axis = trial / 8 % 3};
      t->slope[0] = whole(-2, 2);
      t->slope[1] = whole(-2, 2);
      assert_true(cag_bool_points_start(&t->points, 8));
      t->net.points = &t->points;
      t->net.plane = t->plane;
      t->net.axis = t->axis;
      t->plane[0] = cag_bool_points_add(&t->points, lifted(t, 0, 0));
      t->plane[1] = cag_bool_points_add(&t->points, lifted(t, 7, 1));
      t->plane[2] = cag_bool_points_add(&t->points, lifted(t, 2, 5));
    }
    check_trial(t, side, trial % 2);
  }
  cag_bool_points_free(&t->points);
  cag_bool_net_free(&t->net);
  free(t);
}

// A simple net rejects coincident points and crossing segments, and accepts all others.
static void simple_nets(void **state) {
  (void)state;
  Trial *t = calloc(1, sizeof *t);
  assert_non_null(t);
  seed = 2;
  int refused = 0, taken = 0;
  for (int trial = 0; trial < 200; trial++) {
    const int side = whole(4, 9);
    memset(t, 0, sizeof *t);
    t->axis = trial % 3;
    assert_true(cag_bool_points_start(&t->points, 8));
    t->net.points = &t->points;
    t->net.plane = t->plane;
    t->net.axis = t->axis;
    t->net.simple = true;
    start(t, side, true);
    for (int i = 0; i < 6; i++) {
      const int x = whole(0, side), y = whole(0, side);
      bool there = false;
      for (size_t k = 0; k < t->n; k++) there = there || (t->x[k] == x && t->y[k] == y);
      t->slope[0] = i; // coincident in the projection, but apart in space
      const uint32_t v = cag_bool_points_add_far(&t->points, lifted(t, x, y));
      assert_int_equal(cag_bool_net_add_point(&t->net, v), !there);
      assert_int_equal(t->net.spoiled, there);
      t->net.spoiled = false;
      if (there) continue;
      t->x[t->n] = x;
      t->y[t->n] = y;
      t->number[t->n++] = v;
    }
    for (int i = 0; i < 3 && t->n > 1; i++) {
      const int a = whole(0, (int)t->n - 1), b = whole(0, (int)t->n - 1);
      if (a == b) continue;
      t->from[t->segments] = a;
      t->to[t->segments++] = b;
      note_all(t);
      const bool crosses = t->all_count > t->n;
      const BoolCut cut = {t->number[a], t->number[b], BOOL_NONE, t->axis};
      assert_int_equal(cag_bool_net_add_segment(&t->net, t->number[a], t->number[b], cut),
                       !crosses);
      assert_int_equal(t->net.spoiled, crosses);
      if (crosses) refused++;
      else taken++;
      if (crosses) break;
    }
    cag_bool_points_free(&t->points);
    cag_bool_net_free(&t->net);
  }
  assert_true(refused > 20 && taken > 100);
  free(t);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(random_points_and_segments),
      cmocka_unit_test(simple_nets),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
