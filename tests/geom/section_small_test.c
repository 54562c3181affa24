// Sections through graphs of quadratic polynomials near their extremes and saddles: loops and arcs
// much smaller than the surface, and branches that nearly meet.

#include "tests/geom/random.h"
#include "tests/geom/support.h"

#include "geom/meet/section.h"
#include "geom/surface/reshape.h"

// f = c0 + c1 x + c2 y + c3 x^2 + c4 x y + c5 y^2 over 0..w, 0..h.
typedef struct Graph {
  double c[6], w, h;
} Graph;

static double value_at(const Graph *g, double x, double y) {
  return g->c[0] + g->c[1] * x + g->c[2] * y + g->c[3] * x * x + g->c[4] * x * y + g->c[5] * y * y;
}

// Defines the graph by its center and second-order terms.
static void center_at(Graph *g, double x, double y, double xx, double xy, double yy, double least) {
  g->c[3] = xx;
  g->c[4] = xy;
  g->c[5] = yy;
  g->c[1] = -2 * xx * x - xy * y;
  g->c[2] = -2 * yy * y - xy * x;
  g->c[0] = 0;
  g->c[0] = least - value_at(g, x, y);
}

static CagSurface *graph_surface(const Graph *g, int form) {
  CagVec3 net[9];
  CagSurface *s, *t;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      const double x = g->w * i / 2, y = g->h * j / 2;
      net[3 * i + j].x = x;
      net[3 * i + j].y = y;
      net[3 * i + j].z = g->c[0] + g->c[1] * x + g->c[2] * y + g->c[4] * x * y +
                         g->c[3] * g->w * g->w * (i == 2) + g->c[5] * g->h * g->h * (j == 2);
    }
  OK(cag_surface_bezier(net, NULL, 3, 3, &s, &err));
  if (form & 1) {
    OK(cag_surface_transpose(s, &t, &err));
    cag_surface_release(s);
    s = t;
  }
  if (form & 2) {
    OK(cag_surface_flip(s, &t, &err));
    cag_surface_release(s);
    s = t;
  }
  return s;
}

static double inside_of(const Graph *g, double x, double y) {
  return fmin(fmin(x, g->w - x), fmin(y, g->h - y));
}

// Finds the arcs of an ellipse inside the rectangle, and their length. Returns -1 if one of them is
// too short to decide.
static int arcs_within(const Graph *g, CagVec3 center, CagVec3 a, CagVec3 b, double *length) {
  enum { STEPS = 4000 };
  int runs = 0, changes = 0, since = STEPS, first = -1;
  double before = 0;
  CagVec3 last = {0, 0, 0};
  *length = 0;
  for (int i = 0; i <= STEPS; i++, since++) {
    const double t = 2 * M_PI * i / STEPS;
    const CagVec3 p = cag_madd(cag_madd(center, cos(t), a), sin(t), b);
    const double in = inside_of(g, p.x, p.y), step = cag_norm(cag_sub(p, last));
    if (i > 0 && in > 0 && before > 0) *length += step;
    if (i > 0 && (in > 0) != (before > 0)) {
      *length += step * fmax(in, before) / fabs(in - before);
      if (since < STEPS / 20) return -1;
      if (first < 0) first = i;
      since = 0;
      changes++;
    }
    before = in;
    last = p;
  }
  if (changes && first + since < STEPS / 20) return -1;
  runs = changes ? changes / 2 : before > 0;
  return runs;
}

static void section_at(const CagSurface *s, double z, double tolerance, CagCurveList *out) {
  const CagPlane plane = {{0.3, -0.2, z}, {0, 0, 1}};
  OK(cag_surface_section(s, &plane, tolerance, out, &err));
}

static void check_curve(const Graph *g, const CagCurve *c, double z, double near) {
  for (int k = 0; k <= 12; k++) {
    CagVec3 p;
    OK(cag_curve_point(c, c->start + (c->end - c->start) * k / 12, &p, &err));
    NEAR(p.z, z, near);
    NEAR(value_at(g, p.x, p.y), z, near);
    assert_true(inside_of(g, p.x, p.y) > -near);
    if (!c->closed && k % 12 == 0) NEAR(inside_of(g, p.x, p.y), 0, near);
  }
}

static void small_loops_and_arcs_are_found(void **state) {
  (void)state;
  seed = 61;
  int told = 0, arcs = 0, loops = 0;
  for (int round = 0; round < 60; round++) {
    Graph g = {.w = uniform(1, 3), .h = uniform(1, 3)};
    const double turn = uniform(0, M_PI), size = pow(10, uniform(round % 5 < 4 ? -2 : -3, -0.5)),
                 slim = uniform(0.3, 1), level = uniform(-1, 1), top = round % 2 ? 1 : -1;
    // Inside the rectangle, or beside one of its edges.
    const double off = uniform(-0.8, 0.8) * size;
    CagVec3 center = {uniform(0.1, 0.9) * g.w, 0, level};
    center.y = uniform(0.1, 0.9) * g.h;
    switch (round % 5) {
    case 0: center.x = off; break;
    case 1: center.x = g.w + off; break;
    case 2: center.y = off; break;
    case 3: center.y = g.h + off; break;
    default: break;
    }
    // The semi-axes of the ellipse at the level are size and size times slim.
    const CagVec3 x = {cos(turn), sin(turn), 0}, y = {-sin(turn), cos(turn), 0};
    const double p = top, q = top / (slim * slim);
    center_at(&g, center.x, center.y, p * x.x * x.x + q * y.x * y.x,
              2 * (p * x.x * x.y + q * y.x * y.y), p * x.y * x.y + q * y.y * y.y,
              level - top * size * size);
    double wanted, length = 0;
    const int runs =
        arcs_within(&g, center, cag_scaled(x, size), cag_scaled(y, size * slim), &wanted);
    if (runs < 0) continue;
    CagSurface *s = graph_surface(&g, round / 5 % 4);
    CagCurveList list = {0};
    section_at(s, level, 1e-5 * size, &list);
    if (list.count != (size_t)runs)
      fail_msg("round %d: %zu curves of size %g, not %d", round, list.count, size, runs);
    for (size_t i = 0; i < list.count; i++) {
      double one;
      OK(cag_curve_length(list.items[i], list.items[i]->start, list.items[i]->end, &one, &err));
      check_curve(&g, list.items[i], level, 1e-4 * size * size + 1e-10);
      length += one;
      if (list.items[i]->closed) loops++;
      else arcs++;
    }
    NEAR(length, wanted, 1e-3 * wanted);
    cag_curve_list_free(&list);
    cag_surface_release(s);
    told++;
  }
  assert_true(told > 45 && loops > 8 && arcs > 20);
}

// --- Saddles ---

// Counts the zeros along the border of the rectangle. Returns -1 if two of them are too close to
// each other.
static int zeros_on_outline(const Graph *g, double z) {
  enum { STEPS = 8000 };
  int n = 0, since = STEPS;
  double before = 0;
  for (int i = 0; i <= STEPS; i++, since++) {
    const double t = 4.0 * i / STEPS, f = t - floor(t);
    const int side = (int)t % 4;
    const double x = side == 0 ? f * g->w : side == 1 ? g->w : side == 2 ? (1 - f) * g->w : 0;
    const double y = side == 0 ? 0 : side == 1 ? f * g->h : side == 2 ? g->h : (1 - f) * g->h;
    const double now = value_at(g, x, y) - z;
    if (i > 0 && (now < 0) != (before < 0)) {
      if (since < STEPS / 400) return -1;
      since = 0;
      n++;
    }
    before = now;
  }
  return n;
}

// The plane is slightly above or below a saddle: two branches, one on each side.
static void branches_beside_a_saddle_are_told_apart(void **state) {
  (void)state;
  seed = 62;
  int told = 0;
  for (int round = 0; round < 50; round++) {
    Graph g = {.w = uniform(1, 3), .h = uniform(1, 3)};
    const double x = uniform(0.1, 0.9) * g.w, y = uniform(0.1, 0.9) * g.h;
    const double one = uniform(0, M_PI), two = one + uniform(0.6, M_PI - 0.6);
    const double px = cos(one), py = sin(one), qx = cos(two), qy = sin(two);
    const double level = uniform(-1, 1), off = pow(10, uniform(-5, -2)) * (round % 2 ? 1 : -1);
    // The product of two linear functions, raised.
    center_at(&g, x, y, px * qx, px * qy + py * qx, py * qy, level - off);
    const int ends = zeros_on_outline(&g, level);
    if (ends < 0) continue;
    CagSurface *s = graph_surface(&g, round / 2 % 4);
    CagCurveList list = {0};
    section_at(s, level, 1e-9, &list);
    if (2 * list.count != (size_t)ends)
      fail_msg("round %d: %zu curves, not %d / 2", round, list.count, ends);
    for (size_t i = 0; i < list.count; i++) {
      const CagCurve *c = list.items[i];
      bool positive = false;
      assert_false(c->closed);
      check_curve(&g, c, level, 1e-8);
      for (int k = 0; k <= 40; k++) {
        CagVec3 p;
        OK(cag_curve_point(c, c->start + (c->end - c->start) * k / 40, &p, &err));
        const double side = px * (p.x - x) + py * (p.y - y);
        if (k == 0) positive = side > 0;
        assert_int_equal(side > 0, positive);
      }
    }
    cag_curve_list_free(&list);
    cag_surface_release(s);
    told++;
  }
  assert_true(told > 35);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(small_loops_and_arcs_are_found),
      cmocka_unit_test(branches_beside_a_saddle_are_told_apart),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
