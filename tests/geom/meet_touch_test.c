// Graphs of polynomials whose difference is known: they touch along curves or at points, cross, do
// both, or overlap, with uneven parametrizations.

#include "tests/geom/polynomial_support.h"

#include "geom/meet/meet_surface.h"

// The length of the part inside the square of a plane curve that is lifted onto f.
typedef struct Path {
  bool round;
  CagVec3 from, way; // a line; or the center, and the radius in way.x
} Path;

static double lifted_length(const Polynomial *f, const Path *path) {
  enum { STEPS = 4000 };
  double length = 0;
  CagVec3 last = {0, 0, 0};
  bool was = false;
  for (int i = 0; i <= STEPS; i++) {
    const double t = (double)i / STEPS, a = 2 * M_PI * t;
    CagVec3 p = path->round ? cag_madd(path->from, path->way.x, cag_vec3(cos(a), sin(a), 0))
                            : cag_madd(path->from, 4 * t - 2, path->way);
    const bool is = p.x >= 0 && p.x <= 1 && p.y >= 0 && p.y <= 1;
    p.z = value(f, p.x, p.y);
    if (is && was) length += cag_norm(cag_sub(p, last));
    was = is;
    last = p;
  }
  return length;
}

typedef struct Case {
  const char *name;
  Polynomial difference;
  Path paths[2];
  int n; // number of paths; -1: they overlap
  bool touches;
} Case;

static Case some_case(int kind) {
  const double x0 = uniform(0.25, 0.75), y0 = uniform(0.25, 0.75), r = uniform(0.12, 0.22),
               slope = uniform(-0.6, 0.6), gap = pow(10, uniform(-5, -3));
  const Polynomial one = {{{1}}};
  const Polynomial a = line_x(x0), b = line_y(y0), c = slanted(x0, y0, slope),
                   d = circle(x0, y0, r), cc = product(&c, &c), aa = product(&a, &a),
                   bb = product(&b, &b);
  const CagVec3 at = {x0, y0, 0};
  const Path along_a = {false, at, {0, 1, 0}}, along_b = {false, at, {1, 0, 0}},
             along_c = {false, at, {-slope, 1, 0}}, around = {true, at, {r, 0, 0}};
  switch (kind) {
  case 0: return (Case){"touching line", aa, {along_a}, 1, true};
  case 1: return (Case){"touching slanted line", cc, {along_c}, 1, true};
  case 2: return (Case){"touching circle", product(&d, &d), {around}, 1, true};
  case 3: return (Case){"crossing circle", d, {around}, 1, false};
  case 4: return (Case){"point", sum(&aa, &bb, 1), {{0}}, 0, true};
  case 5: return (Case){"two lines", product(&a, &b), {along_a, along_b}, 2, false};
  case 6: return (Case){"line", c, {along_c}, 1, false};
  case 9: return (Case){"just apart", sum(&aa, &one, gap), {{0}}, 0, false};
  case 7: return (Case){"apart", {{{1}}}, {{0}}, 0, false};
  default: return (Case){"same", {{{0}}}, {{0}}, -1, false};
  }
}

enum { KINDS = 10 };

static void check_curves(const CagCurveList *list, const Polynomial *f, const Case *is,
                         const CagTransform *back, double near, int round) {
  double length = 0, expected = 0;
  for (int k = 0; k < is->n; k++) expected += lifted_length(f, &is->paths[k]);
  for (size_t i = 0; i < list->count; i++) {
    const CagCurve *c = list->items[i];
    double own;
    OK(cag_curve_length(c, c->start, c->end, &own, &err));
    length += own;
    if (is->n == 1) assert_int_equal(c->closed, is->paths[0].round);
    for (int k = 0; k <= 24; k++) {
      CagVec3 p;
      OK(cag_curve_point(c, c->start + (c->end - c->start) * k / 24, &p, &err));
      p = cag_transform_point(back, p);
      const double off = p.z - value(f, p.x, p.y);
      double beside = INFINITY;
      for (int j = 0; j < is->n; j++) {
        const CagVec3 d = cag_sub(p, is->paths[j].from), way = is->paths[j].way;
        beside = fmin(beside, is->paths[j].round ? fabs(hypot(d.x, d.y) - way.x)
                                                 : fabs(d.x * way.y - d.y * way.x));
      }
      if (!(fabs(off) < 1e-5) || !(beside < near))
        fail_msg("round %d, %s: [%g %g %g] is off by %g, %g", round, is->name, p.x, p.y, p.z, off,
                 beside);
      // Open curves end on an edge of the square.
      const double edge = fmin(fmin(fabs(p.x), fabs(1 - p.x)), fmin(fabs(p.y), fabs(1 - p.y)));
      if ((k == 0 || k == 24) && !c->closed && is->n == 1) NEAR(edge, 0, 1e-7);
    }
  }
  if ((int)list->count != is->n || !(fabs(length - expected) <= 2e-3 * expected))
    fail_msg("round %d, %s: %zu curves of length %g, not %d of %g", round, is->name, list->count,
             length, is->n, expected);
}

static void graphs_meet_where_their_difference_is_zero(void **state) {
  (void)state;
  seed = 61;
  for (int round = 0; round < 2 * KINDS; round++) {
    const Case is = some_case(round % KINDS);
    Polynomial f = {{{0}}};
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 4; j++) f.c[i][j] = uniform(-0.3, 0.3);
    const Polynomial g = sum(&f, &is.difference, uniform(0.5, 2));
    CagTransform turn, move, back;
    OK(cag_rotate(direction(), uniform(0, 6), direction(), &turn, &err));
    move = cag_translate(direction());
    move = cag_transform_multiply(&turn, &move);
    OK(cag_transform_inverse(&move, &back, &err));
    double per[2][2];
    for (int k = 0; k < 4; k++) per[k / 2][k % 2] = pow(10, floor(uniform(-3, 4)));
    CagSurface *a = graph(&f, per[0], &move), *b = graph(&g, per[1], &move);
    CagCurveList list = {0};
    if (is.n < 0) FAILS(cag_surface_intersect(a, b, 0, NULL, &list, &err), "overlap");
    else {
      OK(cag_surface_intersect(round % 2 ? a : b, round % 2 ? b : a, 0, NULL, &list, &err));
      check_curves(&list, &f, &is, &back, is.touches ? 1e-4 : 1e-5, round);
      cag_curve_list_free(&list);
      list = (CagCurveList){0};
      if (is.n < 2) { // those that only touch
        Case only = is;
        if (!is.touches) only.n = 0;
        OK(cag_surface_touches(a, b, 0, NULL, &list, &err));
        check_curves(&list, &f, &only, &back, 1e-4, round);
      }
    }
    cag_curve_list_free(&list);
    cag_surface_release(a);
    cag_surface_release(b);
  }
}

// Coplanar parallelograms either overlap or are disjoint, regardless of their parametrization.
static void flat_patches_of_one_plane_share_a_piece_or_none(void **state) {
  (void)state;
  seed = 62;
  for (int round = 0; round < 24; round++) {
    CagSurface *s[2];
    CagVec3 x = direction(), n = cag_unit(cag_cross(x, direction())), y = cag_cross(n, x);
    const CagVec3 o = direction();
    const bool apart = round % 2;
    for (int k = 0; k < 2; k++) {
      // The sizes are from 1 to 2, with centers close to each other or far apart.
      const double a = uniform(0, 6), w = uniform(0.5, 1), h = uniform(0.5, 1);
      const double off = k == 0 ? 0 : apart ? uniform(3, 4) : uniform(0.1, 0.4);
      const CagVec3 e = cag_madd(cag_scaled(x, w * cos(a)), w * sin(a), y);
      const CagVec3 f = cag_madd(cag_scaled(x, -h * sin(a)), h * cos(a), y);
      const CagVec3 c = cag_madd(o, off, x);
      OK(cag_surface_bilinear(cag_sub(cag_sub(c, e), f), cag_add(cag_sub(c, e), f),
                              cag_sub(cag_add(c, e), f), cag_add(cag_add(c, e), f), &s[k], &err));
    }
    CagCurveList list = {0};
    if (apart) {
      OK(cag_surface_intersect(s[0], s[1], 0, NULL, &list, &err));
      assert_int_equal(list.count, 0);
    } else FAILS(cag_surface_intersect(s[0], s[1], 0, NULL, &list, &err), "overlap");
    cag_curve_list_free(&list);
    cag_surface_release(s[0]);
    cag_surface_release(s[1]);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(graphs_meet_where_their_difference_is_zero),
      cmocka_unit_test(flat_patches_of_one_plane_share_a_piece_or_none),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
