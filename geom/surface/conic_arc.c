// Pieces of conics and of low polynomials as exact rational quadratics.
//
// The control points of a quadratic piece over [a, b] are its blossom at (a, a), (a, b), (b, b):
// for (cos, sin, 1) that is, up to the common factor that makes it rational, the intersection of
// the tangents, [cos m, sin m, cos h] with m the middle and h half of the range; cosh and sinh
// alike. A circle is cut into equal pieces of at most a right angle.

#include <math.h>

#include "geom/linalg/transform.h"
#include "geom/surface/family.h"

static void point_of(CagConicArc arc, double t, double w, double middle_weight, double *out) {
  double s, c;
  switch (arc) {
  case CAG_ARC_CIRCLE:
    cag_sincos(t, &s, &c);
    out[0] = c;
    out[1] = s;
    break;
  case CAG_ARC_HYPERBOLA:
    out[0] = cosh(t);
    out[1] = sinh(t);
    break;
  default: out[0] = t * t; out[1] = t;
  }
  out[2] = w * middle_weight;
}

static void set_knots(CagConicNurbs *out, const double *at, size_t pieces) {
  size_t k = 0;
  for (size_t i = 0; i <= pieces; i++) {
    int times = i == 0 || i == pieces ? out->degree + 1 : out->degree;
    for (int m = 0; m < times; m++) out->knots[k++] = at[i];
  }
}

static void circle(double from, double to, CagConicNurbs *out) {
  // Rounding of a full turn must not produce a fifth piece.
  size_t pieces = (size_t)ceil((to - from) / (M_PI / 2) - 1e-9);
  size_t most = (CAG_CONIC_ARC_POINTS - 1) / 2;
  if (pieces < 1) pieces = 1;
  if (pieces > most) pieces = most;
  double at[CAG_CONIC_ARC_POINTS], step = (to - from) / (double)pieces, weight, unused;
  cag_sincos(step / 2, &unused, &weight);
  out->degree = 2;
  out->count = 2 * pieces + 1;
  for (size_t i = 0; i <= pieces; i++) {
    at[i] = (double)i;
    double t = i == pieces ? to : from + (double)i * step;
    point_of(CAG_ARC_CIRCLE, t, 1, 1, out->points[2 * i]);
    if (i < pieces) point_of(CAG_ARC_CIRCLE, t + step / 2, 1, weight, out->points[2 * i + 1]);
  }
  set_knots(out, at, pieces);
}

void cag_conic_nurbs(CagConicArc arc, double from, double to, CagConicNurbs *out) {
  if (arc == CAG_ARC_CIRCLE) {
    circle(from, to, out);
    return;
  }
  double ends[2] = {from, to};
  out->degree = arc == CAG_ARC_LINE ? 1 : 2;
  out->count = (size_t)out->degree + 1;
  double *first = out->points[0], *middle = out->points[1], *last = out->points[out->count - 1];
  if (arc == CAG_ARC_LINE) {
    first[0] = last[0] = first[2] = last[2] = 1;
    first[1] = from;
    last[1] = to;
  } else if (arc == CAG_ARC_HYPERBOLA) {
    point_of(arc, from, 1, 1, first);
    point_of(arc, (from + to) / 2, 1, cosh((to - from) / 2), middle);
    point_of(arc, to, 1, 1, last);
  } else {
    point_of(arc, from, 1, 1, first);
    point_of(arc, to, 1, 1, last);
    middle[0] = from * to;
    middle[1] = (from + to) / 2;
    middle[2] = 1;
  }
  set_knots(out, ends, 1);
}
