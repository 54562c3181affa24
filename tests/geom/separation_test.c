// Distances of exact curves and surfaces, compared with closed forms and with a search on
// increasingly fine grids.

#include "geom/curve/function.h"
#include "geom/distance/separation.h"
#include "geom/tessellate/tessellate.h"
#include "tests/geom/random_point.h"
#include "tests/geom/support.h"

static CagVec3 random_direction(void) {
  CagVec3 v;
  do v = random_point(1);
  while (cag_norm(v) > 1 || cag_norm(v) < 0.1);
  return cag_unit(v);
}

// --- Sets of many parts ---

// An arc of the angle 2 half about c, with its midpoint m.
static CagCurve *arc_about(CagVec3 c, CagVec3 m, double half) {
  const double radius = cag_norm(cag_sub(m, c));
  const CagVec3 x = cag_unit(cag_sub(m, c)), z = cag_unit(cag_cross(x, random_direction()));
  const CagVec3 columns[4] = {x, cag_cross(z, x), z, c};
  CagTransform frame = cag_transform_identity();
  CagCurve *arc;
  frame.planar = false;
  for (int k = 0; k < 4; k++) {
    frame.m[0][k] = columns[k].x;
    frame.m[1][k] = columns[k].y;
    frame.m[2][k] = columns[k].z;
  }
  OK(cag_curve_arc(radius, radius, -half, half, &frame, &arc, &err));
  return arc;
}

// Shapes around the origin. The chord of an arc that bulges toward it is farther away than dozens
// of points and segments, but the arc is the closest. Other parts in the same box have no sag, or a
// different one.
static void the_nearest_of_many_parts_may_have_a_far_chord(void **state) {
  (void)state;
  enum { MOST = 90 };
  seed = 11;
  for (int k = 0; k < 200; k++) {
    CagParts parts = {0}, origin = {0};
    CagCurve *curves[MOST];
    size_t n = 0;
    double least = INFINITY, out;
    CagVec3 nearest = {0, 0, 0}, feet[2];
    const int points = k % 3 == 0 ? 60 : k % 7;
    const int arcs = 1 + k % 4, at = (int)uniform(0, 80);
    for (int i = 0; i < 80; i++) {
      const CagVec3 way = random_direction();
      const double r = uniform(1, 1.02);
      if (i == at || i < arcs) {
        // The center is beyond the arc, whose midpoint is its closest point.
        const double near = i == at ? uniform(0.97, 1) : uniform(1.01, 1.1);
        const double radius = uniform(3, 10);
        CagCurve *arc =
            arc_about(cag_scaled(way, near + radius), cag_scaled(way, near), uniform(0.05, 0.14));
        OK(cag_parts_add_curve(&parts, arc, 1, &err));
        curves[n++] = arc;
        if (near < least) nearest = cag_scaled(way, near);
        least = fmin(least, near);
        for (int j = 0; j < 3; j++) {
          const CagVec3 beside = cag_add(cag_scaled(way, near + 0.2), random_point(0.1));
          OK(cag_parts_add_point(&parts, beside, &err));
          if (cag_norm(beside) < least) nearest = beside;
          least = fmin(least, cag_norm(beside));
        }
      } else if (i < points) {
        OK(cag_parts_add_point(&parts, cag_scaled(way, r), &err));
        if (r < least) nearest = cag_scaled(way, r);
        least = fmin(least, r);
      } else {
        // The foot is the midpoint of the segment.
        const CagVec3 along = cag_scaled(cag_unit(cag_cross(way, random_direction())), 0.2);
        const CagVec3 ends[2] = {cag_madd(cag_scaled(way, r), 1, along),
                                 cag_madd(cag_scaled(way, r), -0.7, along)};
        OK(cag_curve_polyline(ends, 2, false, 3, &curves[n], &err));
        OK(cag_parts_add_curve(&parts, curves[n++], 1, &err));
        if (r < least) nearest = cag_scaled(way, r);
        least = fmin(least, r);
      }
    }
    OK(cag_parts_add_point(&origin, cag_vec3(0, 0, 0), &err));
    OK(cag_parts_distance(&origin, &parts, 2000, &out, feet, NULL, &err));
    NEAR(out, least, 1e-12);
    near_vec(feet[1], nearest, 1e-6);
    OK(cag_parts_distance(&parts, &origin, 2000, &out, feet, NULL, &err));
    NEAR(out, least, 1e-12);
    near_vec(feet[1], cag_vec3(0, 0, 0), 0);
    cag_parts_free(&parts);
    cag_parts_free(&origin);
    for (size_t i = 0; i < n; i++) cag_curve_release(curves[i]);
  }
}

// --- Curves and surfaces ---

typedef struct Shape {
  CagCurve *curve;
  CagSurface *surface;
  CagVec3 point; // if neither is set
  CagParts parts;
} Shape;

static int freedom_of(const Shape *s) { return s->surface ? 2 : s->curve ? 1 : 0; }

static CagVec3 shape_point(const Shape *s, const double *x) {
  CagVec3 p = s->point;
  if (s->surface) OK(cag_surface_point(s->surface, x[0], x[1], &p, &err));
  else if (s->curve) OK(cag_curve_point(s->curve, x[0], &p, &err));
  return p;
}

enum { CELLS = 16, ROWS = CELLS + 1, MOST_PLACES = ROWS * ROWS };

typedef struct Window {
  double low[2], high[2];
} Window;

static Window domain_of(const Shape *s) {
  if (s->surface)
    return (Window){{s->surface->u0, s->surface->v0}, {s->surface->u1, s->surface->v1}};
  if (!s->curve) return (Window){{0, 0}, {0, 0}};
  return (Window){{s->curve->start, 0}, {s->curve->end, 0}};
}

// Computes points on a grid over the window, and their parameters. Curves have as many points as
// surfaces.
static int grid_points(const Shape *s, const Window *w, CagVec3 *p, double (*x)[2]) {
  int n = 0;
  const int rows = s->surface ? ROWS : s->curve ? MOST_PLACES : 2, columns = s->surface ? ROWS : 1;
  for (int i = 0; i < rows; i++)
    for (int k = 0; k < columns; k++, n++) {
      x[n][0] = w->low[0] + (w->high[0] - w->low[0]) * i / (rows - 1);
      x[n][1] = s->surface ? w->low[1] + (w->high[1] - w->low[1]) * k / (columns - 1) : 0;
      p[n] = shape_point(s, x[n]);
    }
  return n;
}

static void narrow(Window *w, const double *x, const Shape *s) {
  const Window domain = domain_of(s);
  const int freedom = freedom_of(s);
  const int cells = CELLS;
  for (int d = 0; d < freedom; d++) {
    const double half = 4 * (w->high[d] - w->low[d]) / cells;
    w->low[d] = fmax(domain.low[d], x[d] - half);
    w->high[d] = fmin(domain.high[d], x[d] + half);
  }
}

// The distance from grids, each of which surrounds the closest points of the previous one.
static double distance_by_grids(const Shape *a, const Shape *b, int rounds) {
  static CagVec3 p[2][MOST_PLACES];
  static double x[2][MOST_PLACES][2];
  Window window[2] = {domain_of(a), domain_of(b)};
  double best = INFINITY;
  for (int round = 0; round < rounds; round++) {
    const int n = grid_points(a, &window[0], p[0], x[0]),
              m = grid_points(b, &window[1], p[1], x[1]);
    int at[2] = {0, 0};
    double least = INFINITY;
    for (int i = 0; i < n; i++)
      for (int k = 0; k < m; k++) {
        const CagVec3 r = cag_sub(p[0][i], p[1][k]);
        if (cag_dot(r, r) >= least) continue;
        least = cag_dot(r, r);
        at[0] = i, at[1] = k;
      }
    best = fmin(best, sqrt(least));
    narrow(&window[0], x[0][at[0]], a);
    narrow(&window[1], x[1][at[1]], b);
  }
  return best;
}

static double distance_to_point(const Shape *s, CagVec3 q) {
  const Shape point = {.point = q};
  return distance_by_grids(s, &point, 30);
}

static Shape random_curve(CagVec3 at, int k) {
  enum { MOST = 6 };
  Shape s = {0};
  CagVec3 p[MOST];
  double weights[MOST];
  const size_t n = 3 + (size_t)(k % 4);
  for (size_t i = 0; i < n; i++) {
    p[i] = cag_add(at, random_point(1));
    weights[i] = uniform(0.5, 2);
  }
  OK(cag_curve_bezier(p, k % 2 ? weights : NULL, n, 3, &s.curve, &err));
  OK(cag_parts_add_curve(&s.parts, s.curve, k % 3 ? 0.3 : 1e-3, &err));
  return s;
}

static Shape random_surface(CagVec3 at, int k) {
  enum { MOST = 4 };
  Shape s = {0};
  CagVec3 net[MOST * MOST];
  double weights[MOST * MOST];
  const size_t n = 2 + (size_t)(k % 3), m = 2 + (size_t)(k / 3 % 3);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < m; j++) {
      const CagVec3 grid = {2.0 * (double)i / (double)(n - 1) - 1,
                            2.0 * (double)j / (double)(m - 1) - 1, 0};
      net[i * m + j] = cag_add(cag_add(at, grid), random_point(0.5));
      weights[i * m + j] = uniform(0.5, 2);
    }
  OK(cag_surface_bezier(net, k % 2 ? weights : NULL, n, m, &s.surface, &err));
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *mesh;
  how.tolerance = k % 4 ? 0.1 : 0.01;
  OK(cag_surface_tessellate(s.surface, &how, &mesh, &err));
  OK(cag_parts_add_mesh(&s.parts, mesh, s.surface, how.tolerance, &err));
  cag_mesh_release(mesh);
  return s;
}

static void let_go(Shape *s) {
  cag_parts_free(&s->parts);
  cag_curve_release(s->curve);
  cag_surface_release(s->surface);
}

static void curves_and_surfaces_are_as_far_apart_as_on_grids(void **state) {
  (void)state;
  seed = 12;
  int apart = 0;
  for (int k = 0; k < 45; k++) {
    const CagVec3 way = cag_scaled(random_direction(), uniform(0.5, 3.5));
    Shape s[2];
    for (int side = 0; side < 2; side++) {
      const CagVec3 at = side ? way : cag_vec3(0, 0, 0);
      s[side] = (k + side) % 3 ? random_surface(at, k / 3 + side) : random_curve(at, k / 3 + side);
    }
    const double least = distance_by_grids(&s[0], &s[1], 16);
    for (int turn = 0; turn < 2; turn++) {
      Shape *a = &s[turn], *b = &s[1 - turn];
      double out;
      CagVec3 feet[2];
      OK(cag_parts_distance(&a->parts, &b->parts, CAG_PARTS_PAIRS, &out, feet, NULL, &err));
      assert_true(out <= least + 1e-9);
      assert_true(out >= least - 1e-4); // grids may lead to another minimum
      if (out == 0) continue;
      apart++;
      NEAR(distance_to_point(b, feet[1]), 0, 1e-4);
      NEAR(distance_to_point(a, feet[1]), out, 1e-4);
    }
    for (int side = 0; side < 2; side++) let_go(&s[side]);
  }
  assert_true(apart > 40);
}

// --- Work ---

static int evaluations;

static CagStatus coil(void *context, double t, int order, CagVec3 *out, CagError *e) {
  (void)e;
  const double *c = context; // radius, climb
  evaluations++;
  for (int k = 0; k <= order; k++)
    out[k] = cag_vec3(c[0] * cos(t + k * M_PI / 2), c[0] * sin(t + k * M_PI / 2),
                      k == 0   ? c[1] * t
                      : k == 1 ? c[1]
                               : 0);
  return CAG_OK;
}

// Formulas may be slow: Newton's method needs few evaluations for a pair of parts.
static void few_evaluations_find_the_distance(void **state) {
  (void)state;
  int most = 0, all = 0;
  seed = 13;
  for (int k = 0; k < 40; k++) {
    static double radius_and_climb[2];
    radius_and_climb[0] = uniform(1, 3);
    radius_and_climb[1] = uniform(0.5, 2);
    const CagCurveFunction f = {.eval = coil, .release = NULL, .context = radius_and_climb};
    CagParts a = {0}, b = {0};
    CagCurve *c;
    double out, least = INFINITY;
    OK(cag_curve_function(&f, 3, -4, 4, false, &c, &err));
    OK(cag_parts_add_curve(&a, c, 1e-3, &err));
    const CagVec3 p = cag_scaled(random_direction(), uniform(4, 8));
    OK(cag_parts_add_point(&b, p, &err));
    evaluations = 0;
    OK(cag_parts_distance(&a, &b, CAG_PARTS_PAIRS, &out, NULL, NULL, &err));
    most = evaluations > most ? evaluations : most;
    all += evaluations;
    for (int i = 0; i <= 80000; i++) {
      const double t = -4 + 8 * i / 80000.0;
      const CagVec3 q = {radius_and_climb[0] * cos(t), radius_and_climb[0] * sin(t),
                         radius_and_climb[1] * t};
      least = fmin(least, cag_norm(cag_sub(q, p)));
    }
    NEAR(out, least, 1e-8);
    cag_parts_free(&a);
    cag_parts_free(&b);
    cag_curve_release(c);
  }
  assert_true(most <= 130 && all <= 2600);
}

static void locations_that_are_nearly_as_close_are_found_in_order(void **state) {
  (void)state;
  const CagVec3 p[] = {{0, 1.01, 0}, {1, 0, 0}, {0.99, 0.2, 0}, {0, 0, 1.2}, {0, -1.05, 0}};
  CagParts origin = {0}, others = {0};
  CagPartsNear near = {.margin = 0.1, .apart = 0.5};
  double out;
  OK(cag_parts_add_point(&origin, cag_vec3(0, 0, 0), &err));
  for (int i = 0; i < 5; i++) OK(cag_parts_add_point(&others, p[i], &err));
  OK(cag_parts_near(&origin, &others, 100, &out, &near, NULL, &err));
  NEAR(out, 1, 0);
  assert_int_equal(near.n, 3); // not the one beside the closest, nor the one beyond the margin
  const int expected[] = {1, 0, 4};
  for (int i = 0; i < 3; i++) {
    NEAR(near.distance[i], cag_norm(p[expected[i]]), 0);
    near_vec(near.points[i][0], cag_vec3(0, 0, 0), 0);
    near_vec(near.points[i][1], p[expected[i]], 0);
  }
  cag_parts_free(&origin);
  cag_parts_free(&others);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_nearest_of_many_parts_may_have_a_far_chord),
      cmocka_unit_test(curves_and_surfaces_are_as_far_apart_as_on_grids),
      cmocka_unit_test(few_evaluations_find_the_distance),
      cmocka_unit_test(locations_that_are_nearly_as_close_are_found_in_order),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
