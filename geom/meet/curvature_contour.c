// Contour lines of curvature as zero curves of f = x / sqrt(x^2 + unit^2), x = curvature - level.
//
// The square root bounds f where the curvature has a pole (the tip of a cone, a cuspidal edge) and
// makes it dimensionless: `unit` is a typical curvature of the surface. Curvatures are expressed by
// both fundamental forms, and these with their derivatives with respect to u and v, so that the
// gradient of f is computed along with it (third partials of the surface).

#include "geom/meet/curvature_contour.h"
#include "geom/linalg/tolerance.h"

#include <math.h>
#include <stdlib.h>

// A normal shorter than this fraction of |S_u| |S_v| is undefined: rounding at a pole is near
// 1e-16.
#define NO_NORMAL CAG_ROUNDING
// Fraction of the inverse size (squared: Gaussian) below which curvature is 0.
#define STRAIGHT 1e-8

// --- Numbers with their derivatives by u and v ---

typedef struct Jet {
  double x, u, v;
} Jet;

static Jet jet(double x, double u, double v) { return (Jet){x, u, v}; }
static Jet sum(Jet a, Jet b) { return jet(a.x + b.x, a.u + b.u, a.v + b.v); }
static Jet scaled(Jet a, double k) { return jet(k * a.x, k * a.u, k * a.v); }
static Jet minus(Jet a, Jet b) { return sum(a, scaled(b, -1)); }
static Jet times(Jet a, Jet b) {
  return jet(a.x * b.x, a.u * b.x + a.x * b.u, a.v * b.x + a.x * b.v);
}
static Jet over(Jet a, Jet b) {
  double q = a.x / b.x;
  return jet(q, (a.u - q * b.u) / b.x, (a.v - q * b.v) / b.x);
}
// At 0 the root has no derivative; it is set to 0.
static Jet root(Jet a) {
  double r = sqrt(fmax(a.x, 0)), k = r > 0 ? 0.5 / r : 0;
  return jet(r, k * a.u, k * a.v);
}

typedef struct JetVector {
  CagVec3 x, u, v;
} JetVector;

static Jet dot(JetVector a, JetVector b) {
  return jet(cag_dot(a.x, b.x), cag_dot(a.u, b.x) + cag_dot(a.x, b.u),
             cag_dot(a.v, b.x) + cag_dot(a.x, b.v));
}

static JetVector cross(JetVector a, JetVector b) {
  return (JetVector){cag_cross(a.x, b.x), cag_add(cag_cross(a.u, b.x), cag_cross(a.x, b.u)),
                     cag_add(cag_cross(a.v, b.x), cag_cross(a.x, b.v))};
}

// The partial (i, j), with its derivatives if the order n includes them.
static JetVector partial(const CagVec3 *d, int n, int i, int j) {
  const CagVec3 zero = {0, 0, 0};
  bool more = i + j < n;
  return (JetVector){d[cag_partial(n, i, j)], more ? d[cag_partial(n, i + 1, j)] : zero,
                     more ? d[cag_partial(n, i, j + 1)] : zero};
}

// --- Curvature ---

// The shape operator [a b; b c] in the orthonormal basis e1 along S_u, e2 = N x e1. False: the
// surface has no normal.
static bool shape_operator(const CagVec3 *d, int n, Jet *a, Jet *b, Jet *c) {
  JetVector su = partial(d, n, 1, 0), sv = partial(d, n, 0, 1), normal = cross(su, sv);
  Jet e = dot(su, su), f = dot(su, sv), g = dot(sv, sv), w = root(dot(normal, normal));
  if (!(w.x > NO_NORMAL * sqrt(e.x * g.x))) return false;
  Jet l = over(dot(partial(d, n, 2, 0), normal), w);
  Jet m = over(dot(partial(d, n, 1, 1), normal), w);
  Jet k = over(dot(partial(d, n, 0, 2), normal), w);
  Jet slant = over(f, e);
  // The component of S_v perpendicular to S_u has the length w / |S_u|.
  Jet m2 = minus(m, times(slant, l));
  Jet k2 = sum(minus(k, scaled(times(slant, m), 2)), times(times(slant, slant), l));
  *a = over(l, e);
  *b = over(m2, w);
  *c = over(times(k2, e), times(w, w));
  return true;
}

static bool curvature_of(CagCurvature of, const CagVec3 *d, int n, Jet *out) {
  Jet a, b, c;
  if (!shape_operator(d, n, &a, &b, &c)) return false;
  Jet mean = scaled(sum(a, c), 0.5), half = scaled(minus(a, c), 0.5);
  if (of == CAG_CURVATURE_GAUSSIAN) {
    *out = minus(times(a, c), times(b, b));
    return true;
  }
  Jet spread = root(sum(times(half, half), times(b, b)));
  *out = of == CAG_CURVATURE_MEAN  ? mean
         : of == CAG_CURVATURE_MAX ? sum(mean, spread)
                                   : minus(mean, spread);
  return true;
}

static double contour_value(const CagLevel *level, const CagVec3 *d, int n, double *gradient) {
  Jet k;
  if (gradient) gradient[0] = gradient[1] = 0;
  if (!curvature_of((CagCurvature)level->which, d, n, &k)) return NAN;
  double x = k.x - level->constant, length = hypot(x, level->unit);
  double slope = level->unit / length * (level->unit / length) / length;
  if (gradient) {
    gradient[0] = slope * k.u;
    gradient[1] = slope * k.v;
  }
  return isinf(x) ? copysign(1, x) : x / length;
}

// --- Typical curvature ---

static int by_size(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

// The median difference from the level; at least the level itself, and the limit for straightness.
static CagStatus find_unit(const CagSurface *s, CagLevel *level, CagError *err) {
  enum { TRIED = 12 };
  const double first = 0.31; // fraction of a step: neither middle nor edge
  double found[TRIED * TRIED], size;
  size_t n = 0;
  CagBounds box;
  CagStatus status = cag_surface_bounds(s, &box, err);
  for (int i = 0; !status && i < TRIED; i++)
    for (int j = 0; !status && j < TRIED; j++) {
      CagVec3 d[9];
      Jet k;
      status = cag_surface_eval(s, s->u0 + (i + first) / TRIED * (s->u1 - s->u0),
                                s->v0 + (j + first) / TRIED * (s->v1 - s->v0), 2, CAG_SIDE_RIGHT,
                                CAG_SIDE_RIGHT, d, err);
      if (!status && curvature_of((CagCurvature)level->which, d, 2, &k) && isfinite(k.x))
        found[n++] = fabs(k.x - level->constant);
    }
  if (status) return status;
  size = cag_norm(cag_sub(box.max, box.min));
  bool square = level->which == CAG_CURVATURE_GAUSSIAN;
  double least = STRAIGHT / (square ? size * size : size);
  qsort(found, n, sizeof *found, by_size);
  level->unit = fmax(fmax(n > 0 ? found[n / 2] : 0, fabs(level->constant)), least);
  return CAG_OK;
}

CagStatus cag_surface_curvature_contour(const CagSurface *s, CagCurvature of, double level,
                                        double tolerance, CagCurveList *out, bool *everywhere,
                                        CagError *err) {
  const CagRegion *region;
  CagTransform frame;
  *everywhere = false;
  if (cag_surface_planar_view(s, &region, &frame)) {
    *everywhere = level == 0;
    return CAG_OK;
  }
  CagLevel wanted = {
      .order = 3, .value = contour_value, .constant = level, .which = (int)of, .sided = true};
  CagStatus status = find_unit(s, &wanted, err);
  return status ? status : cag_surface_level_curves(s, &wanted, tolerance, out, everywhere, err);
}
