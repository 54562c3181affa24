// Creased surfaces that meet each other: random comparisons with the intersection segments of their
// planar cells, computed by clipping lines.

#include "tests/geom/random.h"
#include "tests/geom/support.h"

#include "geom/meet/meet_surface.h"

#define NET 5
#define SEGMENTS 512
#define SHORT 1e-5

// Points a[i] + b[j]; all cells are parallelograms.
typedef struct Net {
  size_t n;
  CagVec3 a[NET], b[NET];
} Net;

typedef struct Segments {
  size_t n, curves;
  CagVec3 end[SEGMENTS][2];
  double length, shortest;
} Segments;

// Restricts t to the part of the line p + t d inside the cell.
static void clip(CagVec3 p, CagVec3 d, CagVec3 o, CagVec3 e, CagVec3 f, double t[2]) {
  const CagVec3 n = cag_cross(e, f), r = cag_sub(p, o);
  const double nn = cag_dot(n, n);
  const double at[2] = {cag_dot(cag_cross(r, f), n) / nn, cag_dot(cag_cross(e, r), n) / nn};
  const double per[2] = {cag_dot(cag_cross(d, f), n) / nn, cag_dot(cag_cross(e, d), n) / nn};
  for (int k = 0; k < 2; k++) {
    const double x = -at[k] / per[k], y = (1 - at[k]) / per[k];
    t[0] = fmax(t[0], fmin(x, y));
    t[1] = fmin(t[1], fmax(x, y));
  }
}

static void add_cells(const Net *s, size_t i, size_t j, const Net *w, size_t k, size_t l,
                      Segments *out) {
  const CagVec3 o = cag_add(s->a[i], s->b[j]), e = cag_sub(s->a[i + 1], s->a[i]),
                f = cag_sub(s->b[j + 1], s->b[j]), q = cag_add(w->a[k], w->b[l]),
                g = cag_sub(w->a[k + 1], w->a[k]), h = cag_sub(w->b[l + 1], w->b[l]);
  const CagVec3 n = cag_cross(e, f), m = cag_cross(g, h), d = cag_cross(n, m);
  const double dd = cag_dot(d, d), x = cag_dot(n, o), y = cag_dot(m, q);
  const CagVec3 p =
      cag_scaled(cag_add(cag_scaled(cag_cross(m, d), x), cag_scaled(cag_cross(d, n), y)), 1 / dd);
  double t[2] = {-INFINITY, INFINITY};
  clip(p, d, o, e, f, t);
  clip(p, d, q, g, h, t);
  if (t[0] >= t[1]) return;
  assert_true(out->n < SEGMENTS);
  for (int c = 0; c < 2; c++) out->end[out->n][c] = cag_madd(p, t[c], d);
  const double length = (t[1] - t[0]) * sqrt(dd);
  out->length += length;
  out->shortest = fmin(out->shortest, length);
  out->n++;
}

// Finds the segments, and the number of curves that they form.
static void find_segments(const Net *s, const Net *w, Segments *out) {
  *out = (Segments){.shortest = INFINITY};
  for (size_t i = 0; i + 1 < s->n; i++)
    for (size_t j = 0; j + 1 < s->n; j++)
      for (size_t k = 0; k + 1 < w->n; k++)
        for (size_t l = 0; l + 1 < w->n; l++) add_cells(s, i, j, w, k, l, out);
  size_t part[SEGMENTS];
  for (size_t i = 0; i < out->n; i++) part[i] = i;
  out->curves = out->n;
  for (size_t i = 0; i < 4 * out->n * out->n; i++) {
    const size_t a = i / 4 / out->n, b = i / 4 % out->n;
    const CagVec3 p = out->end[a][i & 1], q = out->end[b][i >> 1 & 1];
    if (part[a] == part[b] || cag_norm(cag_sub(p, q)) > SHORT / 100) continue;
    const size_t from = part[b], to = part[a];
    for (size_t k = 0; k < out->n; k++)
      if (part[k] == from) part[k] = to;
    out->curves--;
  }
}

static CagSurface *surface_of(const Net *s) {
  CagVec3 p[NET * NET];
  double knots[2][NET + 2];
  for (size_t i = 0; i < s->n * s->n; i++) p[i] = cag_add(s->a[i / s->n], s->b[i % s->n]);
  for (int d = 0; d < 2; d++) {
    knots[d][0] = knots[d][1] = 0;
    for (size_t i = 2; i <= s->n; i++) knots[d][i] = knots[d][i - 1] + pow(10, uniform(-1, 0));
    knots[d][s->n + 1] = knots[d][s->n];
  }
  CagSurface *surface;
  OK(cag_surface_nurbs(p, NULL, s->n, s->n, 1, 1, knots[0], knots[1], &surface, &err));
  return surface;
}

// A net over the square of side 2 about the origin, rotated to `frame`.
static Net folded(size_t n, double height, const CagVec3 frame[3]) {
  Net s = {.n = n};
  for (size_t i = 0; i < n; i++)
    for (int k = 0; k < 2; k++) {
      const bool inner = i > 0 && i + 1 < n;
      const double x = -1 + 2 * ((double)i + (inner ? uniform(-0.3, 0.3) : 0)) / (double)(n - 1);
      const CagVec3 p = cag_scaled(frame[2], uniform(-height, height));
      (k ? s.b : s.a)[i] = cag_madd(p, x, frame[k]);
    }
  return s;
}

static CagVec3 direction(void) {
  return cag_unit(cag_vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)));
}

static void turn(CagVec3 frame[3], double tilt) {
  // Tilted relative to the previous one.
  frame[2] = cag_unit(cag_madd(frame[2], tilt, direction()));
  frame[0] = cag_unit(cag_cross(frame[2], direction()));
  frame[1] = cag_cross(frame[2], frame[0]);
}

static bool is_end(const Segments *s, CagVec3 p) {
  for (size_t i = 0; i < 2 * s->n; i++)
    if (cag_norm(cag_sub(s->end[i / 2][i % 2], p)) <= 1e-9) return true;
  return false;
}

// Checks that the curves are polylines whose corners are exactly the ends of the segments.
static void compare(const Net *s, const Net *w) {
  Segments wanted;
  find_segments(s, w, &wanted);
  if (wanted.shortest < SHORT) return;
  CagSurface *a = surface_of(s), *b = surface_of(w);
  CagCurveList found = {0};
  OK(cag_surface_intersect(a, b, 0, NULL, &found, &err));
  double length = 0;
  size_t segments = 0;
  for (size_t i = 0; i < found.count; i++) {
    const CagVec3 *points;
    size_t n;
    bool closed;
    double own;
    assert_true(cag_curve_vertices(found.items[i], &points, &n, &closed));
    for (size_t k = 0; k < n; k++)
      if (!is_end(&wanted, points[k]))
        fail_msg("[%g %g %g] is no corner", points[k].x, points[k].y, points[k].z);
    segments += n - !closed;
    OK(cag_curve_length(found.items[i], found.items[i]->start, found.items[i]->end, &own, &err));
    length += own;
  }
  NEAR(length, wanted.length, 1e-8);
  assert_int_equal(segments, wanted.n);
  assert_int_equal(found.count, wanted.curves);
  cag_curve_list_free(&found);
  cag_surface_release(a);
  cag_surface_release(b);
}

static void creased_nets_meet_a_flat_sheet_as_their_cells_do(void **state) {
  (void)state;
  seed = 1;
  for (int round = 0; round < 60; round++) {
    CagVec3 frame[3] = {[2] = direction()};
    turn(frame, 0);
    const Net s = folded(2 + (size_t)round % 4, 0.4, frame);
    turn(frame, 0.5);
    Net w = folded(2, 0.1, frame);
    for (int i = 0; i < 2; i++) {
      w.a[i] = cag_scaled(w.a[i], 3);
      w.b[i] = cag_scaled(w.b[i], 3);
    }
    compare(&s, &w);
  }
}

static void creased_nets_meet_each_other_as_their_cells_do(void **state) {
  (void)state;
  seed = 2;
  for (int round = 0; round < 30; round++) {
    CagVec3 frame[3] = {[2] = direction()};
    turn(frame, 0);
    const Net s = folded(2 + (size_t)round % 4, 0.4, frame);
    turn(frame, 0.7);
    const Net w = folded(3 + (size_t)round % 3, 0.4, frame);
    compare(&s, &w);
  }
}

// --- Segments that meet at one point ---

// Rays from one point that form pairs of straight lines. Regardless of the order and direction of
// the rays, the lines must continue straight.
#define LINES 4
#define RAYS (2 * LINES)

static void shuffle(CagVec3 ends[][2], size_t n) {
  for (size_t i = n; i > 1; i--) {
    const size_t k = (size_t)uniform(0, (double)i);
    for (int e = 0; e < 2; e++) {
      const CagVec3 swap = ends[i - 1][e];
      ends[i - 1][e] = ends[k][e];
      ends[k][e] = swap;
    }
    if (uniform(0, 1) < 0.5) {
      const CagVec3 swap = ends[i - 1][0];
      ends[i - 1][0] = ends[i - 1][1];
      ends[i - 1][1] = swap;
    }
  }
}

static int by_value(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static size_t joined_lengths(CagVec3 ends[][2], size_t n, double *out) {
  CagCurveList list = {0};
  for (size_t i = 0; i < n; i++) {
    CagCurve *c;
    OK(cag_curve_line(ends[i][0], ends[i][1], 3, &c, &err));
    OK(cag_curve_list_add(&list, c, &err));
  }
  OK(cag_curve_list_join(&list, 0, 1e-9, &err));
  const size_t count = list.count;
  for (size_t i = 0; i < count; i++)
    OK(cag_curve_length(list.items[i], list.items[i]->start, list.items[i]->end, &out[i], &err));
  qsort(out, count, sizeof *out, by_value);
  cag_curve_list_free(&list);
  return count;
}

static void lines_through_a_point_go_on_straight_in_every_order(void **state) {
  (void)state;
  seed = 5;
  for (int trial = 0; trial < 200; trial++) {
    const CagVec3 p = direction();
    CagVec3 ends[RAYS][2];
    double expected[LINES], found[RAYS];
    for (size_t i = 0; i < LINES; i++) {
      const CagVec3 d = direction();
      const double a = uniform(0.5, 2), b = uniform(0.5, 2);
      ends[2 * i][0] = ends[2 * i + 1][0] = p;
      ends[2 * i][1] = cag_madd(p, a, d);
      ends[2 * i + 1][1] = cag_madd(p, -b, d);
      expected[i] = a + b;
    }
    qsort(expected, LINES, sizeof *expected, by_value);
    for (int order = 0; order < 5; order++) {
      shuffle(ends, RAYS);
      assert_int_equal(joined_lengths(ends, RAYS, found), LINES);
      for (size_t i = 0; i < LINES; i++) NEAR(found[i], expected[i], 1e-12);
    }
  }
}

// Segments between few points with equal turning angles: edges of a cube, some of them removed.
static void segments_are_joined_alike_in_every_order(void **state) {
  (void)state;
  enum { EDGES = 12 };
  seed = 6;
  for (int trial = 0; trial < 200; trial++) {
    CagVec3 ends[EDGES][2];
    double first[EDGES], again[EDGES];
    size_t n = 0;
    CagVec3 frame[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    if (trial % 2) turn(frame, 1);
    for (int corner = 0; corner < 8; corner++)
      for (int axis = 0; axis < 3; axis++) {
        if (corner >> axis & 1 || uniform(0, 1) < 0.2) continue;
        CagVec3 p = {0, 0, 0};
        for (int k = 0; k < 3; k++) p = cag_madd(p, (corner >> k & 1) * (k + 1.0), frame[k]);
        ends[n][0] = p;
        ends[n++][1] = cag_madd(p, axis + 1.0, frame[axis]);
      }
    const size_t count = joined_lengths(ends, n, first);
    for (int order = 0; order < 8; order++) {
      shuffle(ends, n);
      assert_int_equal(joined_lengths(ends, n, again), count);
      for (size_t i = 0; i < count; i++) NEAR(again[i], first[i], 1e-12);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(creased_nets_meet_a_flat_sheet_as_their_cells_do),
      cmocka_unit_test(creased_nets_meet_each_other_as_their_cells_do),
      cmocka_unit_test(lines_through_a_point_go_on_straight_in_every_order),
      cmocka_unit_test(segments_are_joined_alike_in_every_order),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
