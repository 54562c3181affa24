// Random curves of all kinds.

#ifndef CAG_TESTS_GEOM_CURVE_RANDOM_H
#define CAG_TESTS_GEOM_CURVE_RANDOM_H

#include "geom/curve/conic.h"
#include "geom/curve/family.h"
#include "geom/curve/function.h"
#include "tests/geom/random_point.h"
#include "tests/geom/support.h"

typedef enum Kind {
  LINE,
  POLYLINE,
  RING,
  BEZIER,
  RATIONAL,
  SPLINE,
  NURBS,
  PERIODIC,
  CIRCLE,
  ELLIPSE,
  HELIX,
  CONE_HELIX,
  PARABOLA,
  HYPERBOLA,
  TANGENT,
  SECANT,
  COMPOSITE,
  FUNCTION,
  KINDS
} Kind;

// A rotation by random angles and a translation.
static inline CagTransform random_frame(void) {
  const CagVec3 x = cag_unit(random_point(1)), other = random_point(1);
  const CagVec3 z = cag_unit(cag_cross(x, other)), y = cag_cross(z, x), at = random_point(3);
  CagTransform t = cag_translate(at);
  const CagVec3 column[3] = {x, y, z};
  for (int k = 0; k < 3; k++) {
    t.m[0][k] = column[k].x;
    t.m[1][k] = column[k].y;
    t.m[2][k] = column[k].z;
  }
  t.planar = false;
  return t;
}

// 3 cos t, 2 sin 2t, t / 2 + cos 3t / 4.
static inline CagStatus wave(void *context, double t, int order, CagVec3 *out, CagError *e) {
  (void)context;
  (void)e;
  double two = 1, three = 1;
  for (int k = 0; k <= order; k++, two *= 2, three *= 3) {
    const double turn = k * (M_PI / 2);
    out[k] = cag_vec3(3 * cos(t + turn), 2 * two * sin(2 * t + turn),
                      (k == 0   ? t / 2
                       : k == 1 ? 0.5
                                : 0) +
                          three * cos(3 * t + turn) / 4);
  }
  return CAG_OK;
}
static inline void forget(void *context) { (void)context; }

static inline CagCurve *moved(CagCurve *c) {
  const CagTransform t = random_frame();
  CagCurve *out;
  OK(cag_curve_transform(c, &t, &out, &err));
  cag_curve_release(c);
  return out;
}

static inline CagCurve *random_curve(Kind kind) {
  enum { POINTS = 7 };
  CagVec3 p[POINTS];
  double w[POINTS], knots[POINTS + 4] = {0, 0, 0, 0, 0.7, 1, 2, 3, 3, 3, 3};
  for (int i = 0; i < POINTS; i++) {
    p[i] = random_point(4);
    w[i] = uniform(0.4, 2.5);
  }
  knots[4] = uniform(0.3, 0.9);
  knots[6] = uniform(1.1, 2.5);
  const CagTransform frame = random_frame();
  const double a = uniform(0.5, 3), b = uniform(0.5, 3), from = uniform(-1, 0.5),
               way = uniform(0.4, 5);
  CagCurve *c = NULL, *parts[3];
  switch (kind) {
  case LINE: OK(cag_curve_line(p[0], p[1], 3, &c, &err)); break;
  case POLYLINE: OK(cag_curve_polyline(p, 5, false, 3, &c, &err)); break;
  case RING: OK(cag_curve_polyline(p, 5, true, 3, &c, &err)); break;
  case BEZIER:
    OK(cag_curve_bezier(p, NULL, 3 + (size_t)(4 * (w[0] - 0.4) / 2.1), 3, &c, &err));
    break;
  case RATIONAL: OK(cag_curve_bezier(p, w, 4, 3, &c, &err)); break;
  case SPLINE: OK(cag_curve_nurbs(p, NULL, POINTS, 3, knots, 3, &c, &err)); break;
  case NURBS: OK(cag_curve_nurbs(p, w, POINTS, 3, knots, 3, &c, &err)); break;
  case PERIODIC: OK(cag_curve_nurbs_closed(p, NULL, POINTS, 3, 3, &c, &err)); break;
  case CIRCLE: OK(cag_curve_arc(a, a, from, from + way, &frame, &c, &err)); break;
  case ELLIPSE: OK(cag_curve_arc(a, b, 0, 2 * M_PI, &frame, &c, &err)); break;
  case HELIX: OK(cag_curve_helix(a, b, way / 3, 0, &c, &err)); return moved(c);
  case CONE_HELIX: OK(cag_curve_helix(a, b, -way / 3, 0.2, &c, &err)); return moved(c);
  case PARABOLA:
    OK(cag_curve_parabola(a / 2, CAG_FORM_QUADRATIC, from, from + way / 2, &frame, &c, &err));
    break;
  case HYPERBOLA:
    OK(cag_curve_hyperbola(a, b, CAG_FORM_HYPERBOLIC, from, from + way / 3, &frame, &c, &err));
    break;
  case TANGENT:
    OK(cag_curve_parabola(a / 2, CAG_FORM_TANGENT, from, from + way / 8, &frame, &c, &err));
    break;
  case SECANT:
    OK(cag_curve_hyperbola(a, b, CAG_FORM_SECANT, from, from + way / 8, &frame, &c, &err));
    break;
  case COMPOSITE: {
    CagVec3 end;
    OK(cag_curve_arc(a, a, from, from + way, &frame, &parts[0], &err));
    OK(cag_curve_point(parts[0], from + way, &end, &err));
    OK(cag_curve_line(end, p[0], 3, &parts[1], &err));
    OK(cag_curve_nurbs(p, w, POINTS, 3, knots, 3, &parts[2], &err));
    OK(cag_curve_join(parts, 3, &c, &err));
    for (int i = 0; i < 3; i++) cag_curve_release(parts[i]);
    break;
  }
  default: {
    const CagCurveFunction f = {.eval = wave, .release = forget, .context = NULL};
    OK(cag_curve_function(&f, 3, from, from + way, false, &c, &err));
    return moved(c);
  }
  }
  return c;
}

// Runs the check on curves of all kinds.
static inline void each_kind(int rounds, void (*check)(const CagCurve *c)) {
  for (int round = 0; round < rounds; round++)
    for (Kind kind = 0; kind < KINDS; kind++) {
      CagCurve *c = random_curve(kind);
      check(c);
      cag_curve_release(c);
    }
}

// The point and derivatives at t; at the end of the domain, from the left.
static inline void derivatives(const CagCurve *c, double t, int order, CagVec3 *d) {
  OK(cag_curve_eval(c, t, order, t >= c->end ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, d, &err));
}

static inline CagVec3 at(const CagCurve *c, double t) {
  CagVec3 p;
  OK(cag_curve_point(c, t, &p, &err));
  return p;
}

#endif
