// Bounds of the distance of a curve from its chord, used for discretization, boxes, and searches.

#include <math.h>

#include "geom/curve/family.h"
#include "geom/curve/nurbs.h"

static double from_segment(CagVec3 p, CagVec3 a, CagVec3 b) {
  CagVec3 ab = cag_sub(b, a), ap = cag_sub(p, a);
  double n = cag_dot(ab, ab), u = n > 0 ? cag_dot(ap, ab) / n : 0;
  return cag_norm(cag_madd(ap, -fmin(1, fmax(0, u)), ab));
}

// Two bounds hold: the convex hull of the control points, and for polynomials p (p - 1) / 8 times
// their largest second difference.
static double bezier_sag(const double *b, int p, bool rational) {
  double bend = 0, hull = 0;
  const CagVec3 first = cag_project(b), last = cag_project(b + 4 * p);
  for (int i = 1; i < p; i++) {
    if (b[4 * i + 3] > 0) hull = fmax(hull, from_segment(cag_project(b + 4 * i), first, last));
    const double *q = b + 4 * (i - 1);
    CagVec3 d = {q[0] - 2 * q[4] + q[8], q[1] - 2 * q[5] + q[9], q[2] - 2 * q[6] + q[10]};
    bend = fmax(bend, cag_norm(d));
  }
  return rational ? hull : fmin(hull, p * (p - 1) * bend / 8);
}

static double nurbs_sag(const CagNurbs *c, double a, double b) {
  // Find the piece by the midpoint: the ends may miss a knot by the rounding of a composite's
  // parameters.
  const size_t i = cag_nurbs_piece(c, a + (b - a) / 2, CAG_SIDE_RIGHT, c->pieces);
  const double length = c->cuts[i + 1] - c->cuts[i];
  double u = fmax(0, (a - c->cuts[i]) / length), v = fmin(1, (b - c->cuts[i]) / length);
  double part[4 * (CAG_MAX_DEGREE + 1)];
  cag_bezier_segment(cag_nurbs_bezier(c, i), c->degree, u, v, part);
  return bezier_sag(part, c->degree, c->rational);
}

// For a kind known only by points: the largest distance found, plus half. The samples are at
// multiples of the golden ratio, so that no periodic curve meets them all at the same phase.
#define GOLDEN 0.6180339887498949
static double sampled_sag(const CagCurve *c, double a, double b) {
  enum { SAMPLES = 9 };
  const double safety = 1.5;
  CagVec3 first, last, p;
  CagError ignored;
  if (cag_curve_eval(c, a, 0, CAG_SIDE_RIGHT, &first, &ignored) ||
      cag_curve_eval(c, b, 0, CAG_SIDE_LEFT, &last, &ignored))
    return INFINITY;
  double most = 0;
  for (int i = 1; i < SAMPLES; i++) {
    const double share = i * GOLDEN - floor(i * GOLDEN);
    if (cag_curve_eval(c, a + (b - a) * share, 0, CAG_SIDE_RIGHT, &p, &ignored)) return INFINITY;
    most = fmax(most, from_segment(p, first, last));
  }
  return safety * most;
}

bool cag_curve_chord_cubic(const CagCurve *c, double a, double b, CagVec3 *q) {
  // Fraction of the bend by which points of the curve may be off the cubic.
  const double like = 1.0 / 8;
  const double h = b - a;
  CagVec3 d[4];
  CagError ignored;
  if (cag_curve_eval(c, a, 1, CAG_SIDE_RIGHT, d, &ignored) ||
      cag_curve_eval(c, b, 1, CAG_SIDE_LEFT, d + 2, &ignored))
    return false;
  q[0] = d[0];
  q[1] = cag_madd(d[0], h / 3, d[1]);
  q[2] = cag_madd(d[2], -h / 3, d[3]);
  q[3] = d[2];
  const double bend = fmax(from_segment(q[1], q[0], q[3]), from_segment(q[2], q[0], q[3]));
  for (int i = 1; i <= 2; i++) {
    const double u = i * GOLDEN - floor(i * GOLDEN), v = 1 - u;
    CagVec3 p, on = cag_scaled(q[0], v * v * v);
    on = cag_madd(on, 3 * v * v * u, q[1]);
    on = cag_madd(on, 3 * v * u * u, q[2]);
    on = cag_madd(on, u * u * u, q[3]);
    if (cag_curve_eval(c, a + h * u, 0, CAG_SIDE_RIGHT, &p, &ignored)) return false;
    if (!(cag_norm(cag_sub(p, on)) <= like * bend)) return false;
  }
  return true;
}

// If two points agree with the cubic Hermite interpolant of both ends, the curve is treated as that
// cubic, which stays within 3/4 of the largest distance of its control points.
static double smooth_sag(const CagCurve *c, double a, double b) {
  const double cubic = 0.75, safety = 1.25; // the curve may be off by 1/8 of the bend
  CagVec3 q[4];
  if (!cag_curve_chord_cubic(c, a, b, q)) return sampled_sag(c, a, b);
  return safety * cubic * fmax(from_segment(q[1], q[0], q[3]), from_segment(q[2], q[0], q[3]));
}

double cag_curve_sag(const CagCurve *c, double a, double b) {
  const CagNurbs *nurbs = cag_nurbs_data(c);
  if (nurbs) return nurbs_sag(nurbs, a, b);

  CagVec3 center, x, y;
  double rate, bend;
  if (cag_curve_arc_axes(c, &center, &x, &y, &rate)) {
    // The chord of a unit circle, stretched at most by the axes.
    double half = fabs(rate) * (b - a) / 2, quarter = sin(fmin(half, M_PI) / 2);
    return cag_curve_stretch(x, y) * 2 * quarter * quarter;
  }
  if (cag_curve_helix_bend(c, a, b, &bend)) return (b - a) * (b - a) * bend / 8;

  const CagVec3 *points;
  size_t n;
  bool ring;
  if (cag_curve_vertices(c, &points, &n, &ring)) return 0;
  const CagCurve *piece = cag_curve_composite_piece(c, a, b, &a, &b, &rate);
  if (piece) return cag_curve_sag(piece, a, b);
  return smooth_sag(c, a, b);
}
