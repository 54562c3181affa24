// Bounds, areas, and volume terms of random surfaces, compared with derivative-free searches and
// Gauss quadrature of their definitions.

#include "geom/surface/function.h"
#include "geom/surface/surface.h"
#include "tests/geom/function_support.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

enum { NU = 5, NV = 6, PU = 2, PV = 3 };
static const double KU[] = {0.5, 0.5, 0.5, 1.2, 2, 3.1, 3.1, 3.1};
static const double KV[] = {-1, -1, -1, -1, -0.4, 0.5, 1.5, 1.5, 1.5, 1.5};

// `rough` is the deviation of its points from a plane grid. Integrals over folds would not be
// smooth.
static CagSurface *random_surface(bool rational, double rough) {
  CagVec3 p[NU * NV];
  double w[NU * NV];
  for (int i = 0; i < NU; i++)
    for (int j = 0; j < NV; j++) {
      CagVec3 *at = &p[i * NV + j];
      at->x = i + uniform(-rough, rough);
      at->y = j + uniform(-rough, rough);
      at->z = 2 * uniform(-rough, rough);
      w[i * NV + j] = uniform(0.5, 2);
    }
  CagSurface *s;
  OK(cag_surface_nurbs(p, rational ? w : NULL, NU, NV, PU, PV, KU, KV, &s, &err));
  return s;
}

static CagVec3 at(const CagSurface *s, double u, double v) {
  CagVec3 p;
  OK(cag_surface_point(s, u, v, &p, &err));
  return p;
}

static double coordinate(CagVec3 p, int k) { return k == 0 ? p.x : k == 1 ? p.y : p.z; }

// The maximum of sign times a coordinate: starts from the best points of a grid, with decreasing
// steps.
static double extreme(const CagSurface *s, int axis, double sign) {
  enum { N = 24 };
  static double grid[N + 1][N + 1];
  double best = -INFINITY;
  const double du = (s->u1 - s->u0) / N, dv = (s->v1 - s->v0) / N;
  for (int i = 0; i <= N; i++)
    for (int j = 0; j <= N; j++) {
      grid[i][j] =
          sign * coordinate(at(s, fmin(s->u0 + i * du, s->u1), fmin(s->v0 + j * dv, s->v1)), axis);
      best = fmax(best, grid[i][j]);
    }
  const double promising = best - 0.1;
  for (int i = 0; i <= N; i++)
    for (int j = 0; j <= N; j++) {
      bool highest = grid[i][j] > promising;
      for (int k = 0; highest && k < 9; k++) {
        const int x = i + k / 3 - 1, y = j + k % 3 - 1;
        highest = x < 0 || y < 0 || x > N || y > N || grid[i][j] >= grid[x][y];
      }
      if (!highest) continue;
      double u = fmin(s->u0 + i * du, s->u1), v = fmin(s->v0 + j * dv, s->v1), here = grid[i][j];
      for (double step = 0.5; step > 1e-7;) {
        bool better = false;
        for (int k = 0; k < 8; k++) {
          static const int WAY[8][2] = {{1, 0}, {-1, 0},  {0, 1},  {0, -1},
                                        {1, 1}, {-1, -1}, {1, -1}, {-1, 1}};
          const double a = fmin(fmax(u + WAY[k][0] * step * du, s->u0), s->u1);
          const double b = fmin(fmax(v + WAY[k][1] * step * dv, s->v0), s->v1);
          const double found = sign * coordinate(at(s, a, b), axis);
          if (!(found > here)) continue;
          here = found;
          u = a;
          v = b;
          better = true;
        }
        if (!better) step /= 2;
      }
      best = fmax(best, here);
    }
  return best;
}

static int looks; // evaluations of second derivatives

static CagStatus waves(void *context, double u, double v, int n, CagVec3 *out, CagError *e) {
  (void)context;
  looks += n == 2;
  (void)e;
  const double a = sin(2 * u), b = cos(3 * v), a1 = 2 * cos(2 * u), b1 = -3 * sin(3 * v);
  out[0] = cag_vec3(u + 0.4 * b, v + 0.3 * a, a * b);
  if (n == 0) return CAG_OK;
  out[cag_partial(n, 1, 0)] = cag_vec3(1, 0.3 * a1, a1 * b);
  out[cag_partial(n, 0, 1)] = cag_vec3(0.4 * b1, 1, a * b1);
  if (n == 1) return CAG_OK;
  out[cag_partial(n, 2, 0)] = cag_vec3(0, -1.2 * a, -4 * a * b);
  out[cag_partial(n, 0, 2)] = cag_vec3(-3.6 * b, 0, -9 * a * b);
  out[cag_partial(n, 1, 1)] = cag_vec3(0, 0, a1 * b1);
  return CAG_OK;
}
static CagStatus waves_row(void *context, double u, const double *vs, size_t nv, int n,
                           CagVec3 *out, CagError *e) {
  return row_by_points(waves, context, u, vs, nv, n, out, e);
}

static CagSurface *formula(double u0, double u1, double v0, double v1) {
  const CagSurfaceFunction f = {
      .eval = waves, .eval_row = waves_row, .release = NULL, .context = NULL};
  CagSurface *s;
  OK(cag_surface_function(&f, u0, u1, false, v0, v1, false, &s, &err));
  return s;
}

static void bounds_are_the_extremes(void **state) {
  (void)state;
  seed = 61;
  for (int round = 0; round < 24; round++) {
    CagSurface *s, *moved;
    if (round % 4 == 3) {
      const double u = uniform(-2, 0), v = uniform(-2, 0);
      s = formula(u, u + uniform(0.5, 3), v, v + 2);
    } else {
      s = random_surface(round % 2, 1);
    }
    CagTransform turn;
    OK(cag_rotate(cag_vec3(1, -2, 0.5), uniform(0, 3), cag_vec3(1, 1, 1), &turn, &err));
    OK(cag_surface_transform(s, &turn, &moved, &err));
    for (int which = 0; which < 2; which++) {
      CagBounds box;
      OK(cag_surface_bounds(which ? moved : s, &box, &err));
      for (int axis = 0; axis < 3; axis++) {
        NEAR(coordinate(box.max, axis), extreme(which ? moved : s, axis, 1), 1e-9);
        NEAR(coordinate(box.min, axis), -extreme(which ? moved : s, axis, -1), 1e-9);
      }
    }
    cag_surface_release(moved);
    cag_surface_release(s);
  }
}

// Newton's method finds extrema within a few steps.
static void bounds_take_few_steps(void **state) {
  (void)state;
  seed = 64;
  looks = 0;
  for (int round = 0; round < 60; round++) {
    const double u = uniform(-2, 0), v = uniform(-2, 0);
    CagSurface *s = formula(u, u + uniform(0.5, 3), v, v + uniform(0.5, 2)), *moved;
    CagTransform turn;
    CagBounds box;
    OK(cag_rotate(cag_vec3(1, -2, 0.5), uniform(0, 3), cag_vec3(1, 1, 1), &turn, &err));
    OK(cag_surface_transform(s, &turn, &moved, &err));
    OK(cag_surface_bounds(moved, &box, &err));
    cag_surface_release(moved);
    cag_surface_release(s);
  }
  assert_true(looks < 60 * 60);
}

// --- Integrals ---

// Gauss-Legendre nodes of order 8 over 0..1.
static const double NODE[] = {0.019855071751231884, 0.10166676129318664, 0.2372337950418355,
                              0.4082826787521751,   0.5917173212478249,  0.7627662049581645,
                              0.8983332387068134,   0.9801449282487681};
static const double WEIGHT[] = {0.05061426814518813, 0.1111905172266872,  0.1568533229389436,
                                0.18134189168918100, 0.18134189168918100, 0.1568533229389436,
                                0.1111905172266872,  0.05061426814518813};

typedef struct Integrals {
  double area, terms[10];
  CagVec3 moment;
} Integrals;

// V is 1/3 of the flux of the position vector. Moments are fluxes along their own axes.
static void add_sample(const CagSurface *s, double u, double v, double weight, Integrals *out) {
  CagVec3 d[4];
  OK(cag_surface_eval(s, u, v, 1, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, &err));
  const CagVec3 n = cag_cross(d[cag_partial(1, 1, 0)], d[cag_partial(1, 0, 1)]);
  const double x[4] = {d[0].x, d[0].y, d[0].z, d[0].x}, m[3] = {n.x, n.y, n.z};
  out->area += weight * cag_norm(n);
  out->moment = cag_madd(out->moment, weight * cag_norm(n), d[0]);
  out->terms[0] += weight * cag_dot(d[0], n) / 3;
  for (int k = 0; k < 3; k++) {
    out->terms[1 + k] += weight * x[k] * x[k] / 2 * m[k];
    out->terms[4 + k] += weight * x[k] * x[k] * x[k] / 3 * m[k];
    out->terms[7 + k] += weight * x[k] * x[k] * x[k + 1] / 2 * m[k];
  }
}

static Integrals integrals_of(const CagSurface *s, const double *ku, int nu, const double *kv,
                              int nv) {
  enum { PARTS = 12 };
  Integrals sum = {0};
  for (int i = 0; i < nu * PARTS; i++)
    for (int j = 0; j < nv * PARTS; j++) {
      const double hu = (ku[i / PARTS + 1] - ku[i / PARTS]) / PARTS;
      const double hv = (kv[j / PARTS + 1] - kv[j / PARTS]) / PARTS;
      for (int a = 0; a < 8; a++)
        for (int b = 0; b < 8; b++)
          add_sample(s, ku[i / PARTS] + hu * (i % PARTS + NODE[a]),
                     kv[j / PARTS] + hv * (j % PARTS + NODE[b]), WEIGHT[a] * WEIGHT[b] * hu * hv,
                     &sum);
    }
  return sum;
}

static void check_integrals(const CagSurface *s, const Integrals *wanted, double tolerance) {
  double area, terms[10] = {0}, same;
  CagVec3 center;
  OK(cag_surface_area(s, &area, &center, &err));
  NEAR(area, wanted->area, tolerance * wanted->area);
  near_vec(center, cag_scaled(wanted->moment, 1 / wanted->area),
           tolerance * (1 + cag_norm(center)));
  OK(cag_surface_area(s, &same, NULL, &err));
  NEAR(same, area, 1e-14 * area);
  // The terms are added to the previous values.
  for (int k = 0; k < 10; k++) terms[k] = k;
  OK(cag_surface_volume_terms(s, terms, &err));
  double most = 0;
  for (int k = 0; k < 10; k++) most = fmax(most, fabs(wanted->terms[k]));
  for (int k = 0; k < 10; k++) NEAR(terms[k] - k, wanted->terms[k], tolerance * (1 + most));
}

static void integrals_are_those_of_the_definitions(void **state) {
  (void)state;
  seed = 62;
  const double ku[] = {0.5, 1.2, 2, 3.1}, kv[] = {-1, -0.4, 0.5, 1.5};
  for (int round = 0; round < 8; round++) {
    CagSurface *s = random_surface(round % 2, 0.2), *moved;
    CagTransform map;
    OK(cag_rotate(cag_vec3(1, -2, 0.5), uniform(0, 3), cag_vec3(1, 1, 1), &map, &err));
    map.m[0][1] += 0.4; // a shear and a reflection
    for (int k = 0; k < 4; k++) map.m[2][k] *= round % 3 ? 1 : -1;
    OK(cag_surface_transform(s, &map, &moved, &err));
    const Integrals own = integrals_of(s, ku, 3, kv, 3), other = integrals_of(moved, ku, 3, kv, 3);
    check_integrals(s, &own, 3e-8);
    check_integrals(moved, &other, 3e-8);
    cag_surface_release(moved);
    cag_surface_release(s);
  }
  const double fu[] = {-1, 0.5, 2}, fv[] = {-0.5, 0.5, 1.5};
  CagSurface *s = formula(-1, 2, -0.5, 1.5);
  const Integrals own = integrals_of(s, fu, 2, fv, 2);
  check_integrals(s, &own, 3e-8);
  cag_surface_release(s);
}

// A planar rectangle as a region has the same integrals as one given by its corners.
static void flat_pieces_have_the_integrals_of_patches(void **state) {
  (void)state;
  seed = 63;
  const double k[] = {0, 1};
  for (int round = 0; round < 30; round++) {
    const double w = uniform(0.5, 3), h = uniform(0.5, 3);
    CagRegion *centered, *region;
    CagTransform frame, away = cag_translate(cag_vec3(uniform(-2, 2), uniform(-2, 2), 0));
    CagSurface *flat, *patch;
    away.planar = true;
    OK(cag_region_rectangle(w, h, 0, &centered, &err));
    OK(cag_region_transform(centered, &away, &region, &err));
    cag_region_release(centered);
    OK(cag_rotate(cag_vec3(1, -2, 0.5), uniform(0, 3), cag_vec3(1, 1, 1), &frame, &err));
    frame.m[0][1] += 0.3;
    frame.m[2][3] += uniform(-3, 3);
    CagBounds box;
    OK(cag_region_bounds(region, &box, &err));
    const CagVec3 a = box.min, b = box.max;
    OK(cag_surface_planar(region, &frame, &flat, &err));
    OK(cag_surface_bilinear(cag_transform_point(&frame, a),
                            cag_transform_point(&frame, cag_vec3(a.x, b.y, 0)),
                            cag_transform_point(&frame, cag_vec3(b.x, a.y, 0)),
                            cag_transform_point(&frame, b), &patch, &err));
    const Integrals wanted = integrals_of(patch, k, 1, k, 1);
    NEAR(b.x - a.x, w, 1e-15);
    NEAR(b.y - a.y, h, 1e-15);
    check_integrals(flat, &wanted, 1e-10);
    check_integrals(patch, &wanted, 1e-8);
    for (int axis = 0; axis < 3; axis++) {
      CagBounds of[2];
      OK(cag_surface_bounds(flat, &of[0], &err));
      OK(cag_surface_bounds(patch, &of[1], &err));
      NEAR(coordinate(of[0].min, axis), coordinate(of[1].min, axis), 1e-12);
      NEAR(coordinate(of[0].max, axis), coordinate(of[1].max, axis), 1e-12);
    }
    cag_surface_release(flat);
    cag_surface_release(patch);
    cag_region_release(region);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bounds_are_the_extremes),
      cmocka_unit_test(bounds_take_few_steps),
      cmocka_unit_test(integrals_are_those_of_the_definitions),
      cmocka_unit_test(flat_pieces_have_the_integrals_of_patches),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
