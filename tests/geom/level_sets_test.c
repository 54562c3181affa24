// Curves on graphs z = f(x, y), computed as sections, isophotes, contours, curvature contours, and
// intersections of surfaces. Compares number, length, and location with marching squares in the x,
// y plane.

#include "geom/meet/curvature_contour.h"
#include "geom/meet/curvature_line.h"
#include "geom/meet/isophote.h"
#include "geom/meet/meet_surface.h"
#include "geom/meet/section.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

// The rectangle of x and y, and the grid over it.
#define WIDE 3.0
#define HIGH 2.0
enum { NX = 168, NY = 112, NODES = (NX + 1) * (NY + 1) };

// --- Graphs ---

// A graph of degree p in both directions, with the given numbers of control points. Their x and y
// are averages of knots, so u is x and v is y.
static CagSurface *graph(int p, int nu, int nv, double rough) {
  double knots[2][24];
  CagVec3 net[14 * 14];
  const int count[2] = {nu, nv};
  const double size[2] = {WIDE, HIGH};
  for (int k = 0; k < 2; k++) {
    const int inner = count[k] - p;
    for (int i = 0; i < count[k] + p + 1; i++) {
      const double at = i <= p ? 0 : i >= count[k] ? inner : i - p;
      knots[k][i] = size[k] * at / inner;
    }
  }
  for (int i = 0; i < nu; i++)
    for (int j = 0; j < nv; j++) {
      double x = 0, y = 0;
      for (int k = 1; k <= p; k++) {
        x += knots[0][i + k] / p;
        y += knots[1][j + k] / p;
      }
      net[i * nv + j] = cag_vec3(x, y, uniform(-rough, rough));
    }
  CagSurface *s;
  OK(cag_surface_nurbs(net, NULL, (size_t)nu, (size_t)nv, p, p, knots[0], knots[1], &s, &err));
  return s;
}

// The surfaces and the level for which curves are computed.
typedef struct Question Question;
struct Question {
  const CagSurface *s, *other;
  CagVec3 direction;
  double level;
  CagVec3 eye;
  CagCurvature of;
  double (*value)(const Question *q, const CagVec3 d[9]);
};

static CagVec3 normal_of(const CagVec3 d[9]) {
  return cag_unit(cag_cross(d[cag_partial(2, 1, 0)], d[cag_partial(2, 0, 1)]));
}

static double above_plane(const Question *q, const CagVec3 d[9]) {
  return cag_dot(d[0], q->direction) - q->level;
}
static double above_other(const Question *q, const CagVec3 d[9]) {
  CagVec3 p;
  OK(cag_surface_point(q->other, d[0].x, d[0].y, &p, &err));
  return d[0].z - p.z;
}
static double lighter(const Question *q, const CagVec3 d[9]) {
  return cag_dot(normal_of(d), q->direction) - q->level;
}
static double facing_eye(const Question *q, const CagVec3 d[9]) {
  return cag_dot(normal_of(d), cag_unit(cag_sub(d[0], q->eye)));
}
static double bent(const Question *q, const CagVec3 d[9]) {
  const double a = d[cag_partial(2, 1, 0)].z, b = d[cag_partial(2, 0, 1)].z;
  const double r = d[cag_partial(2, 2, 0)].z, s = d[cag_partial(2, 1, 1)].z,
               t = d[cag_partial(2, 0, 2)].z, g = 1 + a * a + b * b;
  const double gauss = (r * t - s * s) / (g * g);
  const double mean = ((1 + b * b) * r - 2 * a * b * s + (1 + a * a) * t) / (2 * pow(g, 1.5));
  const double half = sqrt(fmax(0, mean * mean - gauss));
  return (q->of == CAG_CURVATURE_GAUSSIAN ? gauss
          : q->of == CAG_CURVATURE_MEAN   ? mean
          : q->of == CAG_CURVATURE_MAX    ? mean + half
                                          : mean - half) -
         q->level;
}

static double value_at(const Question *q, double x, double y, CagVec3 *p) {
  CagVec3 d[9];
  x = fmin(fmax(x, 0), WIDE);
  y = fmin(fmax(y, 0), HIGH);
  OK(cag_surface_eval(q->s, x, y, 2, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, &err));
  if (p) *p = d[0];
  return q->value(q, d);
}

// --- Marching squares ---

// The connected lines: their number and lengths. Edges of the grid are numbered by the lower of
// their nodes, those along x first.
typedef struct Runs {
  int count;
  double length, of[2 * NODES], largest;
} Runs;

static int parent[2 * NODES];
static int root_of(int i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

static double values[NODES];
static CagVec3 points[NODES];

static CagVec3 crossing_of(int edge) {
  const int a = edge % NODES, b = edge < NODES ? a + NY + 1 : a + 1;
  return cag_lerp(points[a], points[b], values[a] / (values[a] - values[b]));
}

static void connect(Runs *r, int e, int f) {
  const double length = cag_norm(cag_sub(crossing_of(e), crossing_of(f)));
  e = root_of(e);
  f = root_of(f);
  if (e != f) {
    parent[f] = e;
    r->of[e] += r->of[f];
    r->of[f] = -1;
  }
  r->of[e] += length;
  r->length += length;
}

static bool positive(int node) { return values[node] >= 0; }

// Returns false if two lines are so close to each other that their connection is ambiguous.
static bool march(const Question *q, Runs *r) {
  r->length = r->largest = 0;
  for (int i = 0; i <= NX; i++)
    for (int j = 0; j <= NY; j++) {
      const int k = i * (NY + 1) + j;
      values[k] = value_at(q, WIDE * i / NX, HIGH * j / NY, &points[k]);
      r->largest = fmax(r->largest, fabs(values[k]));
    }
  for (int i = 0; i < 2 * NODES; i++) {
    parent[i] = i;
    r->of[i] = 0;
  }
  for (int i = 0; i < NX; i++)
    for (int j = 0; j < NY; j++) {
      const int a = i * (NY + 1) + j, b = a + NY + 1; // corners a, b, b + 1, a + 1
      const int edge[4] = {a, NODES + b, a + 1, NODES + a};
      const bool cut[4] = {positive(a) != positive(b), positive(b) != positive(b + 1),
                           positive(b + 1) != positive(a + 1), positive(a + 1) != positive(a)};
      int found[4], n = 0;
      for (int k = 0; k < 4; k++)
        if (cut[k]) found[n++] = edge[k];
      if (n == 4) return false;
      if (n == 2) connect(r, found[0], found[1]);
    }
  r->count = 0;
  for (int i = 0; i < 2 * NODES; i++)
    if (r->of[i] > 0) {
      if (r->of[i] < 0.1) return false; // a loop that may be missed, or touch an edge
      r->count++;
    }
  return true;
}

// --- Comparison ---

typedef CagStatus (*Ask)(const Question *q, CagCurveList *out, CagError *e);

static CagStatus ask_section(const Question *q, CagCurveList *out, CagError *e) {
  CagPlane plane;
  plane.normal = q->direction;
  plane.point = cag_scaled(q->direction, q->level);
  return cag_surface_section(q->s, &plane, 0, out, e);
}
static CagStatus ask_isophote(const Question *q, CagCurveList *out, CagError *e) {
  return cag_surface_isophote(q->s, q->direction, q->level, 0, out, e);
}
static CagStatus ask_outline(const Question *q, CagCurveList *out, CagError *e) {
  return cag_surface_contour(q->s, q->direction, q->eye, false, 0, out, e);
}
static CagStatus ask_central(const Question *q, CagCurveList *out, CagError *e) {
  return cag_surface_contour(q->s, q->direction, q->eye, true, 0, out, e);
}
static CagStatus ask_bend(const Question *q, CagCurveList *out, CagError *e) {
  bool everywhere;
  const CagStatus status =
      cag_surface_curvature_contour(q->s, q->of, q->level, 1e-5, out, &everywhere, e);
  assert_false(everywhere);
  return status;
}
static CagStatus ask_meeting(const Question *q, CagCurveList *out, CagError *e) {
  return cag_surface_intersect(q->s, q->other, 0, NULL, out, e);
}

// An open curve ends on the border of the rectangle, up to rounding.
static void check_ends(const Question *q, const CagCurve *c, const Runs *runs, const char *what,
                       int round) {
  for (int end = 0; end < 2 && !c->closed; end++) {
    CagVec3 p, on;
    OK(cag_curve_point(c, end ? c->end : c->start, &p, &err));
    const double beside =
        fmin(fmin(fabs(p.x), fabs(p.x - WIDE)), fmin(fabs(p.y), fabs(p.y - HIGH)));
    const double value = value_at(q, p.x, p.y, &on);
    if (beside > 1e-10 || cag_norm(cag_sub(p, on)) > 1e-9 || fabs(value) > 1e-8 * runs->largest)
      fail_msg("%s %d: the end [%g %g %g] is off by %g, %g, %g", what, round, p.x, p.y, p.z, beside,
               cag_norm(cag_sub(p, on)), value);
  }
}

// Returns false if marching squares are inconclusive. Their length is too short by a few
// thousandths, because they cut corners.
static bool compare(const Question *q, Ask ask, const char *what, int round) {
  static Runs runs;
  CagCurveList list = {0};
  if (!march(q, &runs)) return false;
  OK(ask(q, &list, &err));
  double length = 0;
  for (size_t i = 0; i < list.count; i++) {
    const CagCurve *c = list.items[i];
    double one;
    OK(cag_curve_length(c, c->start, c->end, &one, &err));
    length += one;
    for (int k = 0; k <= 40; k++) {
      CagVec3 p, on;
      OK(cag_curve_point(c, c->start + (c->end - c->start) * k / 40, &p, &err));
      const double off = value_at(q, p.x, p.y, &on);
      if (!(cag_norm(cag_sub(p, on)) < 2e-5) || !(fabs(off) < 3e-4 * runs.largest))
        fail_msg("%s %d: [%g %g %g] is off by %g, %g", what, round, p.x, p.y, p.z,
                 cag_norm(cag_sub(p, on)), off);
    }
  }
  for (size_t i = 0; i < list.count; i++) check_ends(q, list.items[i], &runs, what, round);
  if ((int)list.count != runs.count)
    fail_msg("%s %d: %zu curves, not %d", what, round, list.count, runs.count);
  if (!(fabs(length - runs.length) < 5e-3 * runs.length + 1e-3))
    fail_msg("%s %d: length %g, not %g", what, round, length, runs.length);
  cag_curve_list_free(&list);
  return true;
}

static CagVec3 some_direction(double steep) {
  const double a = uniform(-steep, steep), b = uniform(-steep, steep);
  return cag_unit(cag_vec3(a, b, 1));
}

static void run(const char *what, Ask ask, double (*value)(const Question *, const CagVec3 *),
                int rounds) {
  int told = 0;
  for (int round = 0; round < rounds; round++) {
    CagSurface *s = ask == ask_bend ? graph(4, 5, 5, 1.5) : graph(3, 6, 5, 0.8);
    CagSurface *other = ask == ask_meeting ? graph(3, 6, 7, 0.8) : NULL;
    Question q = {.s = s, .other = other, .value = value};
    q.direction = some_direction(ask == ask_outline ? 3 : 0.5);
    if (ask == ask_outline) q.direction.z = uniform(-0.3, 0.3);
    if (ask == ask_central) q.eye = cag_vec3(uniform(-2, 5), -3, 1.5);
    if (ask == ask_section) q.level = uniform(-0.2, 0.2);
    if (ask == ask_isophote) q.level = uniform(0.75, 0.95);
    if (ask == ask_bend) q.level = uniform(-0.7, 0.7);
    q.of = (CagCurvature)(round % 4);
    told += compare(&q, ask, what, round);
    cag_surface_release(s);
    cag_surface_release(other);
  }
  assert_true(3 * told > rounds);
}

static double facing(const Question *q, const CagVec3 d[9]) {
  return cag_dot(normal_of(d), q->direction);
}

static void sections_are_level_sets(void **state) {
  (void)state;
  seed = 31;
  run("section", ask_section, above_plane, 10);
}
static void isophotes_are_level_sets(void **state) {
  (void)state;
  seed = 32;
  run("isophote", ask_isophote, lighter, 8);
}
static void contours_are_level_sets(void **state) {
  (void)state;
  seed = 33;
  run("contour", ask_outline, facing, 6);
  run("contour from an eye", ask_central, facing_eye, 6);
}
static void curvature_contours_are_level_sets(void **state) {
  (void)state;
  seed = 34;
  run("curvature", ask_bend, bent, 12);
}
static void meetings_are_level_sets(void **state) {
  (void)state;
  seed = 35;
  run("meeting", ask_meeting, above_other, 9);
}

// --- Lines of curvature ---

// Checks that the normal curvature along (dx, dy) is the larger or smaller principal curvature, and
// that the direction is its.
static void check_bend(const CagSurface *s, CagVec3 p, CagVec3 along, bool larger, int round) {
  CagVec3 d[9];
  OK(cag_surface_eval(s, fmin(fmax(p.x, 0), WIDE), fmin(fmax(p.y, 0), HIGH), 2, CAG_SIDE_RIGHT,
                      CAG_SIDE_RIGHT, d, &err));
  const double a = d[cag_partial(2, 1, 0)].z, b = d[cag_partial(2, 0, 1)].z;
  const double root = sqrt(1 + a * a + b * b), x = along.x, y = along.y;
  const double l = d[cag_partial(2, 2, 0)].z / root, m = d[cag_partial(2, 1, 1)].z / root,
               n = d[cag_partial(2, 0, 2)].z / root;
  const double first = (1 + a * a) * x * x + 2 * a * b * x * y + (1 + b * b) * y * y;
  const double second = l * x * x + 2 * m * x * y + n * y * y;
  const Question of = {.s = s, .of = larger ? CAG_CURVATURE_MAX : CAG_CURVATURE_MIN};
  const double k = bent(&of, d);
  if (!(fabs(second / first - k) < 1e-5 * (1 + fabs(k))))
    fail_msg("line %d: at [%g %g] curvature %g, not %g", round, p.x, p.y, second / first, k);
  // In principal directions, (L - k E) x + (M - k F) y = 0.
  const double skew = ((1 + a * a) * x + a * b * y) * (m * x + n * y) -
                      (a * b * x + (1 + b * b) * y) * (l * x + m * y);
  if (!(fabs(skew) < 2e-4 * first))
    fail_msg("line %d: at [%g %g] off by %g", round, p.x, p.y, skew);
}

static void lines_of_curvature_follow_principal_directions(void **state) {
  (void)state;
  seed = 36;
  int told = 0;
  for (int round = 0; round < 24; round++) {
    CagSurface *s = graph(4, 5, 5, 0.7);
    const bool larger = round % 2;
    const double u = uniform(0.3, 2.7), v = uniform(0.3, 1.7);
    CagCurve *c;
    CagVec3 on;
    OK(cag_surface_point(s, u, v, &on, &err));
    OK(cag_surface_curvature_line(s, u, v, larger, &c, &err));
    double nearest = INFINITY;
    for (int i = 0; i <= 60; i++) {
      CagVec3 d[2], q;
      OK(cag_curve_eval(c, c->start + (c->end - c->start) * i / 60, 1,
                        i == 60 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, d, &err));
      OK(cag_surface_point(s, fmin(fmax(d[0].x, 0), WIDE), fmin(fmax(d[0].y, 0), HIGH), &q, &err));
      near_vec(d[0], q, 1e-6);
      // Avoids the ends, where an umbilic may be.
      if (i > 2 && i < 58) check_bend(s, d[0], cag_unit(d[1]), larger, round);
    }
    double t;
    CagVec3 foot;
    OK(cag_curve_closest(c, on, &t, &foot, &nearest, &err));
    NEAR(nearest, 0, 1e-9);
    for (int end = 0; end < 2 && !c->closed; end++) {
      CagVec3 p;
      OK(cag_curve_point(c, end ? c->end : c->start, &p, &err));
      const double beside =
          fmin(fmin(fabs(p.x), fabs(p.x - WIDE)), fmin(fabs(p.y), fabs(p.y - HIGH)));
      CagPrincipal at;
      bool found;
      OK(cag_surface_principal(s, fmin(fmax(p.x, 0), WIDE), fmin(fmax(p.y, 0), HIGH), &found, &at,
                               &err));
      told += beside < 1e-9;
      // At the border, or at an umbilic.
      assert_true(beside < 1e-9 || at.k[1] - at.k[0] < 0.05);
    }
    cag_curve_release(c);
    cag_surface_release(s);
  }
  assert_true(told > 24);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sections_are_level_sets),
      cmocka_unit_test(isophotes_are_level_sets),
      cmocka_unit_test(contours_are_level_sets),
      cmocka_unit_test(curvature_contours_are_level_sets),
      cmocka_unit_test(meetings_are_level_sets),
      cmocka_unit_test(lines_of_curvature_follow_principal_directions),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
