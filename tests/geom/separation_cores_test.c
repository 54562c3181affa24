// Distances of sets of many spheres, pipes, and circles, which have closed forms: those of centers
// and axes, minus the radii.

#include "geom/distance/separation.h"
#include "geom/surface/quadric.h"
#include "geom/tessellate/tessellate.h"
#include "random_point.h"
#include "support.h"

enum { MOST = 12 };

typedef enum Kind { BALL, PIPE, POINT, CHORD, KINDS } Kind;

// The pipe and the chord are from a to b; the others are about a.
typedef struct Shape {
  Kind kind;
  CagVec3 a, b;
  double radius;
  CagSurface *surface;
  CagCurve *curve;
} Shape;

typedef struct Set {
  Shape shapes[MOST];
  int n;
  CagParts parts;
} Set;

static CagTransform frame_of(CagVec3 at, CagVec3 axis, double radius, double along) {
  const CagVec3 z = cag_unit(axis), x = cag_unit(cag_cross(z, cag_vec3(0.36, 0.48, 0.8)));
  const CagVec3 columns[4] = {cag_scaled(x, radius), cag_scaled(cag_cross(z, x), radius),
                              cag_scaled(z, along), at};
  CagTransform frame = cag_transform_identity();
  frame.planar = false;
  for (int k = 0; k < 4; k++) {
    frame.m[0][k] = columns[k].x;
    frame.m[1][k] = columns[k].y;
    frame.m[2][k] = columns[k].z;
  }
  return frame;
}

static void add_shape(Set *set, Kind kind, CagVec3 a, CagVec3 b, double radius) {
  Shape s = {kind, a, b, radius, NULL, NULL};
  const CagVec3 along = cag_sub(b, a);
  CagTransform frame = frame_of(a, along, radius, kind == BALL ? radius : 1);
  const CagVec3 ends[2] = {a, b};
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *m = NULL;
  how.tolerance = 0.02;
  if (kind == BALL)
    OK(cag_surface_quadric(CAG_SHAPE_ELLIPSOID, &frame, 0, 2 * M_PI, 0, M_PI, &s.surface, &err));
  if (kind == PIPE)
    OK(cag_surface_quadric(CAG_SHAPE_ELLIPTIC_CYLINDER, &frame, 0, 2 * M_PI, 0, cag_norm(along),
                           &s.surface, &err));
  if (kind == POINT) OK(cag_parts_add_point(&set->parts, a, &err));
  if (kind == CHORD) {
    OK(cag_curve_polyline(ends, 2, false, 3, &s.curve, &err));
    OK(cag_parts_add_curve(&set->parts, s.curve, how.tolerance, &err));
  }
  if (s.surface) {
    OK(cag_surface_tessellate(s.surface, &how, &m, &err));
    OK(cag_parts_add_mesh(&set->parts, m, s.surface, how.tolerance, &err));
    cag_mesh_release(m);
  }
  set->shapes[set->n++] = s;
}

static void let_go(Set *set) {
  for (int i = 0; i < set->n; i++) {
    cag_surface_release(set->shapes[i].surface);
    cag_curve_release(set->shapes[i].curve);
  }
  cag_parts_free(&set->parts);
}

// The distances of the point p from the closest and the farthest point of the shape.
static void reach_from(CagVec3 p, const Shape *s, double *least, double *most) {
  const CagVec3 d = cag_sub(s->b, s->a), r = cag_sub(p, s->a);
  const double length = cag_norm(d), along = cag_dot(r, cag_unit(d));
  const double off = cag_norm(cag_madd(r, -along, cag_unit(d)));
  const double beyond = fmax(0, fmax(-along, along - length)), end = fmax(along, length - along);
  *least = s->kind == POINT   ? cag_norm(r)
           : s->kind == BALL  ? fabs(cag_norm(r) - s->radius)
           : s->kind == CHORD ? hypot(beyond, off)
                              : hypot(beyond, off - s->radius);
  *most = s->kind == POINT   ? cag_norm(r)
          : s->kind == BALL  ? cag_norm(r) + s->radius
          : s->kind == CHORD ? hypot(end, off)
                             : hypot(end, off + s->radius);
}

// The shapes of a are balls and points.
static double distance_of(const Set *a, const Set *b) {
  double distance = INFINITY;
  for (int i = 0; i < a->n; i++)
    for (int k = 0; k < b->n; k++) {
      double least, most;
      const double radius = a->shapes[i].kind == BALL ? a->shapes[i].radius : 0;
      reach_from(a->shapes[i].a, &b->shapes[k], &least, &most);
      distance = fmin(distance, least > radius  ? least - radius
                                : most < radius ? radius - most
                                                : 0);
    }
  return distance;
}

static void sets_of_round_shapes_have_the_distances_of_their_centers_and_axes(void **state) {
  (void)state;
  seed = 1;
  int met = 0;
  for (int round = 0; round < 21; round++) {
    Set a = {.n = 0}, b = {.n = 0};
    const CagVec3 ahead = cag_unit(random_point(1)), way = cag_scaled(ahead, uniform(2, 6));
    const int n = 2 + round % 6, m = 1 + round / 2 % 6;
    for (int i = 0; i < n; i++) {
      const CagVec3 at = random_point(2), pole = cag_add(at, random_point(1));
      add_shape(&a, i % 4 == 3 ? POINT : BALL, at, pole, uniform(0.1, 0.7));
    }
    for (int i = 0; i < m; i++) {
      const CagVec3 at = cag_add(way, random_point(2));
      const Kind kind = (Kind)(uniform(0, 1) < 0.6 ? BALL : (round + i) % KINDS);
      // The ends of the pipes are far away, where their axes would no longer determine the
      // distance.
      const CagVec3 axis = cag_unit(random_point(1));
      const CagVec3 along = cag_scaled(axis, kind == PIPE ? 9 : uniform(0.1, 2));
      add_shape(&b, kind, cag_sub(at, kind == PIPE ? along : cag_vec3(0, 0, 0)), cag_add(at, along),
                uniform(0.1, 0.7));
    }
    if (round % 3 == 0) { // around a ball, and possibly others
      const CagVec3 at = a.shapes[0].a, pole = cag_add(at, random_point(1));
      add_shape(&b, BALL, at, pole, round % 2 ? uniform(0.8, 1) : uniform(8, 9));
    }
    const double expected = distance_of(&a, &b);
    met += expected == 0;
    Set *from = round % 2 ? &b : &a, *to = round % 2 ? &a : &b;
    double out, least, most, nearest = INFINITY;
    CagVec3 feet[2];
    OK(cag_parts_distance(&from->parts, &to->parts, 500, &out, feet, NULL, &err));
    NEAR(out, expected, 1e-11);
    for (int i = 0; out > 0 && i < to->n; i++) {
      reach_from(feet[1], &to->shapes[i], &least, &most);
      nearest = fmin(nearest, least);
    }
    if (out > 0) NEAR(nearest, 0, 1e-11);
    let_go(&a);
    let_go(&b);
  }
  assert_true(met > 0 && met < 10);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sets_of_round_shapes_have_the_distances_of_their_centers_and_axes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
