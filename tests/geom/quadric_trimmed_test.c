// Bounds of pieces of quadrics, whole or trimmed by disks, compared with a local search for the
// extremes.

#include "geom/surface/quadric.h"
#include "geom/surface/trimmed.h"
#include "tests/geom/random.h"
#include "tests/geom/trimmed_support.h"

// The parametric forms by their definitions.
static CagVec3 form(CagQuadricShape shape, double u, double v) {
  switch (shape) {
  case CAG_SHAPE_ELLIPSOID: return cag_vec3(cos(u) * sin(v), sin(u) * sin(v), cos(v));
  case CAG_SHAPE_HYPERBOLOID_ONE: return cag_vec3(cos(u) * cosh(v), sin(u) * cosh(v), sinh(v));
  case CAG_SHAPE_HYPERBOLOID_TWO: return cag_vec3(cos(u) * sinh(v), sin(u) * sinh(v), cosh(v));
  case CAG_SHAPE_CONE: return cag_vec3(v * cos(u), v * sin(u), v);
  case CAG_SHAPE_ELLIPTIC_PARABOLOID: return cag_vec3(v * cos(u), v * sin(u), v * v);
  case CAG_SHAPE_HYPERBOLIC_PARABOLOID: return cag_vec3(u, v, u * u - v * v);
  case CAG_SHAPE_ELLIPTIC_CYLINDER: return cag_vec3(cos(u), sin(u), v);
  case CAG_SHAPE_PARABOLIC_CYLINDER: return cag_vec3(u * u, 2 * u, v);
  default: return cag_vec3(cosh(u), sinh(u), v);
  }
}

typedef struct Subject {
  CagQuadricShape shape;
  CagTransform frame;
  double low[2], high[2];
  double disks[2][3]; // the second one is a hole
  bool trimmed;
} Subject;

static double inside_by(const Subject *s, double u, double v) {
  if (!s->trimmed)
    return fmin(fmin(u - s->low[0], s->high[0] - u), fmin(v - s->low[1], s->high[1] - v));
  return fmin(s->disks[0][2] - hypot(u - s->disks[0][0], v - s->disks[0][1]),
              hypot(u - s->disks[1][0], v - s->disks[1][1]) - s->disks[1][2]);
}

static double height(const Subject *s, int axis, double sign, double u, double v) {
  const CagVec3 p = cag_transform_point(&s->frame, form(s->shape, u, v));
  return sign * (axis == 0 ? p.x : axis == 1 ? p.y : p.z);
}

// Searches locally from the highest sample; *inside is the distance from the boundary.
static double highest(const Subject *s, int axis, double sign, double *inside) {
  enum { N = 40 };
  double best = -INFINITY, u = 0, v = 0;
  for (int i = 0; i <= N; i++)
    for (int j = 0; j <= N; j++) {
      const double a = s->low[0] + (s->high[0] - s->low[0]) * i / N;
      const double b = s->low[1] + (s->high[1] - s->low[1]) * j / N;
      const double h = height(s, axis, sign, a, b);
      if (inside_by(s, a, b) < -1e-15 || h <= best) continue;
      best = h;
      u = a;
      v = b;
    }
  for (double step = 0.1; step > 1e-10;) {
    bool better = false;
    for (int k = 0; k < 12; k++) {
      const double a = fmin(fmax(u + step * cos(k * M_PI / 6), s->low[0]), s->high[0]);
      const double b = fmin(fmax(v + step * sin(k * M_PI / 6), s->low[1]), s->high[1]);
      const double h = height(s, axis, sign, a, b);
      if (inside_by(s, a, b) < 0 || h <= best) continue;
      best = h;
      u = a;
      v = b;
      better = true;
    }
    if (!better) step /= 2;
  }
  *inside = inside_by(s, u, v);
  return best;
}

// The same along the outlines of the disks.
static double highest_of_circles(const Subject *s, int axis, double sign) {
  enum { N = 200 };
  double best = -INFINITY;
  for (int d = 0; d < 2; d++) {
    const double *disk = s->disks[d];
#define ON_CIRCLE(at)                                                                              \
  height(s, axis, sign, disk[0] + disk[2] * cos(at), disk[1] + disk[2] * sin(at))
    double top = 0;
    for (int i = 1; i < N; i++)
      if (ON_CIRCLE(2 * M_PI * i / N) > ON_CIRCLE(top)) top = 2 * M_PI * i / N;
    for (double step = 0.02; step > 1e-9; step /= 2)
      for (int k = -1; k < 2; k += 2)
        while (ON_CIRCLE(top + k * step) > ON_CIRCLE(top)) top += k * step;
    best = fmax(best, ON_CIRCLE(top));
  }
  return best;
}

static void set_subject(Subject *s, int round) {
  *s = (Subject){.shape = (CagQuadricShape)(round % 9)};
  s->frame = cag_transform_identity();
  s->frame.planar = false;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++) s->frame.m[i][j] = uniform(-1, 1);
  for (int i = 0; i < 3; i++) s->frame.m[i][i] += s->frame.m[i][i] < 0 ? -1 : 1;
  // u may be an angle. v of a cone or a cap usually begins away from the tip.
  const bool cap = s->shape == CAG_SHAPE_ELLIPSOID;
  s->low[0] = uniform(-3, 0);
  s->high[0] = s->low[0] + uniform(2, 6);
  s->low[1] = cap || s->shape == CAG_SHAPE_HYPERBOLOID_TWO || s->shape == CAG_SHAPE_CONE ||
                      s->shape == CAG_SHAPE_ELLIPTIC_PARABOLOID
                  ? uniform(0.01, 0.4)
                  : uniform(-1.5, -0.5);
  s->high[1] = s->low[1] + uniform(1.2, cap ? 2.7 : 1.8);
  const double most = fmin(s->high[0] - s->low[0], s->high[1] - s->low[1]) / 2;
  double *d = s->disks[0], *hole = s->disks[1];
  d[2] = uniform(0.6, 0.99) * most;
  for (int k = 0; k < 2; k++) d[k] = uniform(s->low[k] + d[2], s->high[k] - d[2]);
  hole[2] = uniform(0.1, 0.3) * d[2];
  hole[0] = d[0] + uniform(-0.4, 0.4) * d[2];
  hole[1] = d[1] + uniform(-0.4, 0.4) * d[2];
}

static void bounds_are_reached(void **state) {
  (void)state;
  seed = 81;
  int tops[2] = {0, 0};
  for (int round = 0; round < 90; round++) {
    Subject s;
    set_subject(&s, round);
    CagSurface *whole, *part;
    MUST(cag_surface_quadric(s.shape, &s.frame, s.low[0], s.high[0], s.low[1], s.high[1], &whole,
                             err));
    CagRegion *r = disks(s.disks, 2);
    MUST(cag_surface_trimmed(whole, r, &part, err));
    for (int trimmed = 0; trimmed < 2; trimmed++) {
      CagBounds box;
      s.trimmed = trimmed;
      MUST(cag_surface_bounds(trimmed ? part : whole, &box, err));
      const double found[6] = {-box.min.x, box.max.x, -box.min.y, box.max.y, -box.min.z, box.max.z};
      for (int e = 0; e < 6; e++) {
        double inside, top = highest(&s, e / 2, e % 2 ? 1 : -1, &inside);
        if (trimmed) top = fmax(top, highest_of_circles(&s, e / 2, e % 2 ? 1 : -1));
        if (fabs(found[e] - top) > 1e-8 * (1 + fabs(top)))
          fail_msg("round %d, %s, side %d: found %.12g, walked to %.12g, inside by %g", round,
                   trimmed ? "trimmed" : "whole", e, found[e], top, inside);
        tops[trimmed] += inside > 1e-3;
      }
    }
    cag_region_release(r);
    cag_surface_release(part);
    cag_surface_release(whole);
  }
  assert_true(tops[0] > 30 && tops[1] > 5);
}

// The critical points of a coordinate (extremes and saddles) are exactly its stationary points
// inside.
static void places_where_a_coordinate_stands_still(void **state) {
  (void)state;
  seed = 82;
  int found = 0;
  for (int round = 0; round < 180; round++) {
    Subject s;
    CagSurface *surface;
    set_subject(&s, round);
    MUST(cag_surface_quadric(s.shape, &s.frame, s.low[0], s.high[0], s.low[1], s.high[1], &surface,
                             err));
    for (int axis = 0; axis < 3; axis++) {
      CagVec3 at[2];
      const size_t n = cag_surface_quadric_extremes(surface, axis, at);
      assert_true(n <= 2);
      for (size_t i = 0; i < n; i++) {
        const double u = at[i].x, v = at[i].y, h = 1e-5;
        assert_true(u > s.low[0] && u < s.high[0] && v > s.low[1] && v < s.high[1]);
        assert_near(height(&s, axis, 1, u + h, v) - height(&s, axis, 1, u - h, v), 0, 1e-9, "by u");
        assert_near(height(&s, axis, 1, u, v + h) - height(&s, axis, 1, u, v - h), 0, 1e-9, "by v");
        if (i == 1) assert_true(hypot(at[0].x - u, at[0].y - v) > 1e-6);
        found++;
      }
    }
    cag_surface_release(surface);
  }
  assert_true(found > 60);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bounds_are_reached),
      cmocka_unit_test(places_where_a_coordinate_stands_still),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
