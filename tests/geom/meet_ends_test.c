// Ends of intersection curves of two surfaces: on an edge of one surface, and on the other one, up
// to rounding.

#include "tests/geom/random.h"
#include "tests/geom/support.h"

#include "geom/meet/meet_surface.h"

// z = a x^2 + b x y + c y^2 + d over 0..w, 0..h.
typedef struct Graph {
  double a, b, c, d, w, h;
} Graph;

static double height(const Graph *g, double x, double y) {
  return g->a * x * x + g->b * x * y + g->c * y * y + g->d;
}

static CagSurface *graph_surface(const Graph *g) {
  // The domain is negative, which must not matter.
  const double knots[] = {-2.5, -2.5, -2.5, -1, -1, -1};
  CagVec3 net[9];
  CagSurface *s;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      const double x = g->w * i / 2, y = g->h * j / 2;
      net[3 * i + j].x = x;
      net[3 * i + j].y = y;
      net[3 * i + j].z =
          g->b * x * y + g->d + g->a * g->w * g->w * (i == 2) + g->c * g->h * g->h * (j == 2);
    }
  OK(cag_surface_nurbs(net, NULL, 3, 3, 2, 2, knots, knots, &s, &err));
  return s;
}

static double off_edges_of_graph(const Graph *g, CagVec3 p) {
  const double x = fmin(fabs(p.x), fabs(p.x - g->w)), y = fmin(fabs(p.y), fabs(p.y - g->h));
  return fmin(x, y);
}

// The distance from the sides of the parallelogram, as a fraction of the sides.
static double off_edges_of_sheet(CagVec3 o, CagVec3 e, CagVec3 f, CagVec3 p) {
  const CagVec3 n = cag_cross(e, f), r = cag_sub(p, o);
  const double u = cag_dot(cag_cross(r, f), n) / cag_dot(n, n);
  const double v = cag_dot(cag_cross(e, r), n) / cag_dot(n, n);
  return fmin(fmin(fabs(u), fabs(u - 1)), fmin(fabs(v), fabs(v - 1)));
}

static void curves_end_on_edges_to_rounding(void **state) {
  (void)state;
  seed = 71;
  int on_graph = 0, on_sheet = 0;
  for (int round = 0; round < 30; round++) {
    Graph g = {.w = uniform(1, 3), .h = uniform(1, 3)};
    g.a = uniform(-0.5, 0.5);
    g.b = uniform(-0.5, 0.5);
    g.c = uniform(-0.5, 0.5);
    g.d = uniform(-0.3, 0.3);
    CagVec3 o, e, f;
    o.x = uniform(-0.5, 0.8) * g.w;
    o.y = uniform(-0.5, 0.8) * g.h;
    o.z = uniform(-1, 0.2);
    e.x = uniform(0.3, 2);
    e.y = uniform(-0.8, 0.8);
    e.z = uniform(-0.5, 0.5);
    f.x = uniform(-0.5, 0.5);
    f.y = uniform(0.2, 2);
    f.z = uniform(0.6, 2);
    CagSurface *s = graph_surface(&g), *sheet;
    OK(cag_surface_bilinear(o, cag_add(o, f), cag_add(o, e), cag_add(o, cag_add(e, f)), &sheet,
                            &err));
    CagCurveList list = {0};
    OK(cag_surface_intersect(round % 2 ? s : sheet, round % 2 ? sheet : s, 0, NULL, &list, &err));
    for (size_t i = 0; i < list.count; i++) {
      const CagCurve *c = list.items[i];
      for (int end = 0; end < 2 && !c->closed; end++) {
        CagVec3 p;
        OK(cag_curve_point(c, end ? c->end : c->start, &p, &err));
        const double first = off_edges_of_graph(&g, p), second = off_edges_of_sheet(o, e, f, p);
        if (first < second) on_graph++;
        else on_sheet++;
        NEAR(fmin(first, second), 0, 2e-13);
        NEAR(p.z, height(&g, p.x, p.y), 1e-12);
        NEAR(cag_dot(cag_unit(cag_cross(e, f)), cag_sub(p, o)), 0, 1e-12);
      }
    }
    cag_curve_list_free(&list);
    cag_surface_release(s);
    cag_surface_release(sheet);
  }
  assert_true(on_graph > 10 && on_sheet > 10);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(curves_end_on_edges_to_rounding),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
