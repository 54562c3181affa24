// Random NURBS surfaces on random grids: points, partial derivatives, and normals are the same as
// at single parameters, and nothing else is written.

#include "geom/surface/frames.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

enum { MOST = 11, ROWS = 6, COLUMNS = 90 };

static int whole(int low, int high) { return low + (int)uniform(0, high - low + 1); }

// Bumps over a square of any size and location; with `pole`, the first row is one point.
static CagSurface *random_surface(int p, int q, bool rational, double size, bool pole) {
  CagVec3 net[MOST * MOST];
  double weights[MOST * MOST], knots[2][2 * MOST];
  size_t n[2];
  for (int k = 0; k < 2; k++) {
    const size_t degree = (size_t)(k ? q : p);
    n[k] = degree + (size_t)whole(1, 4);
    double at = uniform(-2, 2);
    for (size_t i = 0; i < n[k] + degree + 1; i++) {
      if (i > degree && i <= n[k]) at += uniform(0.5, 1);
      knots[k][i] = at;
    }
  }
  for (size_t i = 0; i < n[0] * n[1]; i++) {
    const double x = (double)(i / n[1]), y = (double)(i % n[1]);
    net[i].x = x + uniform(-0.2, 0.2);
    net[i].y = y + uniform(-0.2, 0.2);
    net[i].z = uniform(-0.5, 0.5);
    if (pole && i < n[1]) net[i] = cag_vec3(-1, 2, 3);
    net[i] = cag_scaled(net[i], size);
    weights[i] = uniform(0.5, 3);
  }
  CagSurface *s;
  OK(cag_surface_nurbs(net, rational ? weights : NULL, n[0], n[1], p, q, knots[0], knots[1], &s,
                       &err));
  return s;
}

// Parameters, sorted or not, which include the ends.
static void set_parameters(double from, double to, size_t n, bool sorted, double *out) {
  for (size_t i = 0; i < n; i++) out[i] = uniform(from, to);
  for (size_t i = 0; sorted && i < n; i++)
    out[i] = from + (to - from) * ((double)i + 0.5) / (double)n;
  out[0] = from;
  out[n - 1] = to;
}

static const CagVec3 UNTOUCHED = {7, 8, 9};

typedef struct Grid {
  CagVec3 points[ROWS * COLUMNS + 1], du[ROWS * COLUMNS + 1], dv[ROWS * COLUMNS + 1],
      normals[ROWS * COLUMNS + 1];
} Grid;

static void clear(Grid *g) {
  for (size_t i = 0; i <= ROWS * COLUMNS; i++)
    g->points[i] = g->du[i] = g->dv[i] = g->normals[i] = UNTOUCHED;
}

static void untouched(const CagVec3 *p) { assert_memory_equal(p, &UNTOUCHED, sizeof *p); }

// Bits of the requested results: 1: S_u, 2: S_v, 4: normals. Points are always computed.
static void check_grid(const CagSurface *s, const double *us, size_t nu, const double *vs,
                       size_t nv, int what, double size, bool pole) {
  static Grid g;
  const size_t n = nu * nv;
  clear(&g);
  CagVec3 *du = what & 1 ? g.du : NULL, *dv = what & 2 ? g.dv : NULL;
  if (what & 4) OK(cag_surface_eval_frames(s, us, nu, vs, nv, g.points, du, dv, g.normals, &err));
  else OK(cag_surface_eval_grid(s, us, nu, vs, nv, g.points, du, dv, &err));
  for (size_t i = 0; i < n; i++) {
    const double u = us[i / nv], v = vs[i % nv];
    CagVec3 d[4];
    OK(cag_surface_eval(s, u, v, 1, u >= s->u1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT,
                        v >= s->v1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, d, &err));
    const CagVec3 by_u = d[cag_partial(1, 1, 0)], by_v = d[cag_partial(1, 0, 1)];
    near_vec(g.points[i], d[0], 1e-13 * size * MOST);
    if (du) near_vec(du[i], by_u, 1e-12 * size * MOST);
    if (dv) near_vec(dv[i], by_v, 1e-12 * size * MOST);
    if (!(what & 4)) continue;
    const CagVec3 cross = cag_cross(by_u, by_v);
    if (pole && u == s->u0) near_vec(g.normals[i], cag_vec3(0, 0, 0), 0);
    else near_vec(g.normals[i], cag_scaled(cross, 1 / cag_norm(cross)), 1e-10);
  }
  untouched(&g.points[n]);
  untouched(&g.du[what & 1 ? n : 0]);
  untouched(&g.dv[what & 2 ? n : 0]);
  untouched(&g.normals[what & 4 ? n : 0]);
}

static void grids_have_the_values_of_single_places(void **state) {
  (void)state;
  seed = 51;
  for (int round = 0; round < 240; round++) {
    const bool pole = round % 7 == 0;
    const double size = pow(10, uniform(-12, 12));
    const int p = whole(1, 5), q = round % 4 < 3 ? round % 4 + 1 : whole(4, 6);
    CagSurface *s = random_surface(p, q, round / 4 % 2, size, pole);
    double us[ROWS], vs[COLUMNS];
    // Few columns, or more than fit in a block.
    const size_t nu = (size_t)whole(2, ROWS),
                 nv = (size_t)(round % 3 ? whole(2, 9) : whole(60, COLUMNS));
    set_parameters(s->u0, s->u1, nu, round % 2, us);
    set_parameters(s->v0, s->v1, nv, round / 2 % 2, vs);
    for (int what = 0; what < 8; what++) check_grid(s, us, nu, vs, nv, what, size, pole);
    cag_surface_release(s);
  }
}

// There is no normal where the partial derivatives are parallel, or one of them is zero.
static void flat_nets_have_no_normals(void **state) {
  (void)state;
  seed = 52;
  for (int round = 0; round < 60; round++) {
    const int p = whole(1, 4), q = whole(1, 5);
    const size_t nu = (size_t)p + 1, nv = (size_t)q + 1;
    const double size = pow(10, uniform(-5, 5));
    CagVec3 net[MOST * MOST], along = {1, 2, -1};
    // All lines coincide, or all points of a row coincide.
    for (size_t i = 0; i < nu * nv; i++) {
      const double x = (double)(i / nv), y = (double)(i % nv);
      net[i] = cag_scaled(along, size * (round % 3 == 0 ? x + 0.7 * y : round % 3 == 1 ? x : y));
    }
    CagSurface *s;
    OK(cag_surface_bezier(net, NULL, nu, nv, &s, &err));
    CagVec3 points[15], normals[15];
    double us[3], vs[5];
    set_parameters(0, 1, 3, false, us);
    set_parameters(0, 1, 5, false, vs);
    OK(cag_surface_eval_frames(s, us, 3, vs, 5, points, NULL, NULL, normals, &err));
    for (int i = 0; i < 15; i++) near_vec(normals[i], cag_vec3(0, 0, 0), 0);
    cag_surface_release(s);
  }
}

// If all control points that affect a parameter have weight 0, there is no point.
static void places_without_weight_are_refused(void **state) {
  (void)state;
  seed = 53;
  for (int q = 1; q < 6; q++)
    for (int bad = 0; bad < 2; bad++) {
      const size_t nv = (size_t)q + 1;
      CagVec3 net[2 * MOST], points[2 * 20], du[2 * 20], dv[2 * 20], normals[2 * 20];
      double weights[2 * MOST], vs[20];
      const double us[] = {0.25, 1};
      for (size_t i = 0; i < 2 * nv; i++) {
        net[i] = cag_vec3((double)(i / nv), (double)(i % nv), 0);
        weights[i] = bad && i >= nv ? 0 : 1;
      }
      CagSurface *s;
      OK(cag_surface_bezier(net, weights, 2, nv, &s, &err));
      for (size_t n = 1; n <= 20; n++) {
        set_parameters(0, 1, n, true, vs);
        for (int what = 0; what < 3; what++) {
          const CagStatus status =
              what == 2
                  ? cag_surface_eval_frames(s, us, 2, vs, n, points, NULL, NULL, normals, &err)
                  : cag_surface_eval_grid(s, us, 2, vs, n, points, what ? du : NULL,
                                          what ? dv : NULL, &err);
          assert_int_equal(status != CAG_OK, bad);
          if (bad) assert_string_equal(cag_error_info(err.id)->reason, "zero-denominator");
        }
      }
      cag_surface_release(s);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(grids_have_the_values_of_single_places),
      cmocka_unit_test(flat_nets_have_no_normals),
      cmocka_unit_test(places_without_weight_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
