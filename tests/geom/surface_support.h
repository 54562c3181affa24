// Helpers for the tests of surfaces and solids: comparisons, and checks for every kind.

#ifndef CAG_TESTS_SURFACE_SUPPORT_H
#define CAG_TESTS_SURFACE_SUPPORT_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "geom/solid/solid.h"

static inline void assert_near(double found, double expected, double tolerance, const char *what) {
  if (fabs(found - expected) <= tolerance * fmax(1, fabs(expected))) return;
  fail_msg("%s: expected %.17g, found %.17g", what, expected, found);
}

static inline void assert_point(CagVec3 found, CagVec3 expected, double tolerance,
                                const char *what) {
  assert_near(found.x, expected.x, tolerance, what);
  assert_near(found.y, expected.y, tolerance, what);
  assert_near(found.z, expected.z, tolerance, what);
}

#define MUST(call)                                                                                 \
  do {                                                                                             \
    CagError must_error;                                                                           \
    memset(&must_error, 0, sizeof must_error);                                                     \
    CagError *err = &must_error;                                                                   \
    if (call) fail_msg("%s: %s", #call, must_error.message);                                       \
  } while (0)

#define MUST_FAIL(call, with)                                                                      \
  do {                                                                                             \
    CagError must_error;                                                                           \
    memset(&must_error, 0, sizeof must_error);                                                     \
    CagError *err = &must_error;                                                                   \
    assert_true(call);                                                                             \
    assert_string_equal(cag_error_info(must_error.id)->reason, with);                              \
  } while (0)

static inline CagVec3 surface_at(const CagSurface *s, double u, double v) {
  CagVec3 p = {0, 0, 0};
  MUST(cag_surface_point(s, u, v, &p, err));
  return p;
}

// A point and the partial derivatives of a surface there.
typedef struct Partials {
  CagVec3 point, du, dv, duv, duu, dvv;
} Partials;

static inline void assert_partials(const CagSurface *s, double u, double v, const Partials *e) {
  CagVec3 d[9];
  MUST(cag_surface_eval(s, u, v, 2, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err));
  assert_point(d[0], e->point, 1e-9, "point");
  assert_point(d[cag_partial(2, 1, 0)], e->du, 1e-9, "du");
  assert_point(d[cag_partial(2, 0, 1)], e->dv, 1e-9, "dv");
  assert_point(d[cag_partial(2, 1, 1)], e->duv, 1e-9, "duv");
  assert_point(d[cag_partial(2, 2, 0)], e->duu, 1e-9, "duu");
  assert_point(d[cag_partial(2, 0, 2)], e->dvv, 1e-9, "dvv");
}

// Parameters inside the domain, away from symmetries.
static inline double inside(double a, double b, int k) {
  static const double FRACTION[] = {0.137, 0.391, 0.583, 0.871};
  return a + FRACTION[k] * (b - a);
}

// Checks that all partial derivatives of order 1..3 are the derivatives of those of the previous
// order (by central differences, whose error is h^2 times the third derivative of these), that the
// grid agrees with single points, and that the flipped surface has the opposite normal.
static inline void assert_consistent(const CagSurface *s) {
  enum { N = 3 };
  double hu = 1e-5 * (s->u1 - s->u0), hv = 1e-5 * (s->v1 - s->v0);
  CagSurface *flipped;
  MUST(cag_surface_flip(s, &flipped, err));
  for (int a = 0; a < 4; a++)
    for (int b = 0; b < 4; b++) {
      double u = inside(s->u0, s->u1, a), v = inside(s->v0, s->v1, b);
      CagVec3 d[16], lo[16], hi[16];
      MUST(cag_surface_eval(s, u, v, N, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err));
      double scale = 1;
      for (int i = 0; i <= N; i++)
        for (int j = 0; i + j <= N; j++)
          scale = fmax(scale, cag_norm(d[cag_partial(N, i, j)]) * pow(s->u1 - s->u0, i) *
                                  pow(s->v1 - s->v0, j));
      for (int direction = 0; direction < 2; direction++) {
        double h = direction == 0 ? hu : hv;
        double du = direction == 0 ? hu : 0, dv = direction == 0 ? 0 : hv;
        MUST(cag_surface_eval(s, u - du, v - dv, N, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, lo, err));
        MUST(cag_surface_eval(s, u + du, v + dv, N, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, hi, err));
        for (int i = 0; i < N; i++)
          for (int j = 0; i + j < N; j++) {
            size_t at = cag_partial(N, i, j);
            CagVec3 slope = cag_scaled(cag_sub(hi[at], lo[at]), 1 / (2 * h));
            CagVec3 given = d[direction == 0 ? cag_partial(N, i + 1, j) : cag_partial(N, i, j + 1)];
            double unit =
                pow(s->u1 - s->u0, i + (direction == 0)) * pow(s->v1 - s->v0, j + (direction == 1));
            if (cag_norm(cag_sub(slope, given)) * unit > 1e-6 * scale)
              fail_msg("%s: partial %d, %d by %c at %g, %g: [%g %g %g], differences [%g %g %g]",
                       s->kind->name, i, j, "uv"[direction], u, v, given.x, given.y, given.z,
                       slope.x, slope.y, slope.z);
          }
      }
      CagVec3 p, pu, pv, normal, other;
      MUST(cag_surface_eval_grid(s, &u, 1, &v, 1, &p, &pu, &pv, err));
      assert_point(p, d[0], 1e-13 * scale, "grid point");
      assert_point(pu, d[cag_partial(N, 1, 0)], 1e-12 * scale, "grid S_u");
      assert_point(pv, d[cag_partial(N, 0, 1)], 1e-12 * scale, "grid S_v");
      MUST(cag_surface_normal(s, u, v, &normal, err));
      MUST(cag_surface_normal(flipped, u, s->v0 + s->v1 - v, &other, err));
      assert_point(other, cag_scaled(normal, -1), 1e-9, "flipped normal");
    }
  cag_surface_release(flipped);
}

// Checks that the images of the surface under affine maps, including a reflection and a shear, have
// the images of the points.
static inline void assert_transforms(const CagSurface *s) {
  CagTransform maps[3];
  CagError e;
  assert_int_equal(cag_rotate(cag_vec3(1, 2, 3), 0.7, cag_vec3(1, 0, -1), &maps[0], &e), CAG_OK);
  assert_int_equal(cag_reflect(cag_vec3(1, -1, 2), cag_vec3(0, 1, 0), &maps[1], &e), CAG_OK);
  maps[2] = cag_shear(0.3, -0.2, 0.5, 0.1, 0, 0.4);
  for (int m = 0; m < 3; m++) {
    CagSurface *moved;
    MUST(cag_surface_transform(s, &maps[m], &moved, err));
    for (int a = 0; a < 4; a++) {
      double u = inside(s->u0, s->u1, a), v = inside(s->v0, s->v1, 3 - a);
      CagVec3 p = cag_transform_point(&maps[m], surface_at(s, u, v));
      assert_point(surface_at(moved, u, v), p, 1e-11 * (1 + cag_norm(p)), "transformed point");
    }
    cag_surface_release(moved);
  }
}

// Checks that the bounds contain all points, and that points reach them up to the spacing of a
// grid.
static inline void assert_bounds(const CagSurface *s, CagVec3 min, CagVec3 max) {
  CagBounds box;
  MUST(cag_surface_bounds(s, &box, err));
  assert_point(box.min, min, 1e-9, "bounds, min");
  assert_point(box.max, max, 1e-9, "bounds, max");
}

static inline void assert_area(const CagSurface *s, double expected) {
  double area;
  CagVec3 centroid;
  MUST(cag_surface_area(s, &area, &centroid, err));
  assert_near(area, expected, 1e-9, "area");
}

#endif
