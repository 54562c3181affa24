// Bezier clipping (Sederberg and Nishita 1990).
//
// A Bezier piece lies in its fat line: the strip along its chord that contains its control points.
// The other piece's signed distance from either side of the strip is a polynomial in Bernstein
// form, so the piece can be in the strip only where the hull of the coefficients, spaced evenly
// over the parameter, is on the right side of zero. Rational pieces use homogeneous coordinates, in
// which the same holds for the distance times the weight. In space two perpendicular strips are
// used.

#include "geom/curve/intersect_clip.h"

#include <math.h>

#include "geom/curve/family.h"
#include "geom/curve/nurbs.h"
#include "geom/linalg/tolerance.h"

typedef struct Segment {
  int degree;
  double points[4 * (CAG_MAX_DEGREE + 1)]; // homogeneous
} Segment;

// The control points over [a, b] of a smooth piece; false: there are none.
static bool segment_of(const CagCurve *c, double a, double b, Segment *out) {
  const CagVec3 *vertices;
  size_t count;
  bool ring;
  double rate;
  const CagCurve *piece = cag_curve_composite_piece(c, a, b, &a, &b, &rate);
  if (piece) c = piece;
  if (cag_curve_vertices(c, &vertices, &count, &ring)) {
    CagVec3 ends[2];
    CagError ignored;
    if (cag_curve_eval(c, a, 0, CAG_SIDE_RIGHT, &ends[0], &ignored) ||
        cag_curve_eval(c, b, 0, CAG_SIDE_LEFT, &ends[1], &ignored))
      return false;
    out->degree = 1;
    for (int i = 0; i < 2; i++) {
      out->points[4 * i] = ends[i].x;
      out->points[4 * i + 1] = ends[i].y;
      out->points[4 * i + 2] = ends[i].z;
      out->points[4 * i + 3] = 1;
    }
    return true;
  }
  const CagNurbs *nurbs = cag_nurbs_data(c);
  if (!nurbs) return false;
  const size_t i = cag_nurbs_piece(nurbs, a + (b - a) / 2, CAG_SIDE_RIGHT, nurbs->pieces);
  const double length = nurbs->cuts[i + 1] - nurbs->cuts[i];
  out->degree = nurbs->degree;
  cag_bezier_segment(cag_nurbs_bezier(nurbs, i), nurbs->degree,
                     fmax(0, (a - nurbs->cuts[i]) / length), fmin(1, (b - nurbs->cuts[i]) / length),
                     out->points);
  for (int k = 0; k <= out->degree; k++)
    if (!(out->points[4 * k + 3] > 0)) return false;
  return true;
}

// The range in which the hull of the points (i / n, e[i]) reaches down to 0: narrows [*low, *high].
static bool narrow(const double *e, int n, double *low, double *high) {
  double first = INFINITY, last = -INFINITY;
  for (int i = 0; i <= n; i++) {
    if (e[i] > 0) continue;
    const double x = (double)i / n;
    first = fmin(first, x);
    last = fmax(last, x);
    for (int k = 0; k <= n; k++) {
      if (e[k] <= 0) continue;
      const double cross = x + ((double)k / n - x) * (e[i] / (e[i] - e[k]));
      first = fmin(first, cross);
      last = fmax(last, cross);
    }
  }
  *low = fmax(*low, first);
  *high = fmin(*high, last);
  return *low <= *high;
}

// Clips b against the strip of a across the direction n.
static bool clip_across(const Segment *a, const Segment *b, CagVec3 n, double slack, double *low,
                        double *high) {
  const CagVec3 base = cag_project(a->points);
  double least = INFINITY, most = -INFINITY, e[CAG_MAX_DEGREE + 1];
  for (int i = 0; i <= a->degree; i++) {
    const double d = cag_dot(cag_sub(cag_project(a->points + 4 * i), base), n);
    least = fmin(least, d);
    most = fmax(most, d);
  }
  for (int side = 0; side < 2; side++) {
    for (int i = 0; i <= b->degree; i++) {
      const double *h = b->points + 4 * i;
      const double d = cag_dot(cag_sub(cag_vec3(h[0], h[1], h[2]), cag_scaled(base, h[3])), n);
      e[i] = side ? (least - slack) * h[3] - d : d - (most + slack) * h[3];
    }
    if (!narrow(e, b->degree, low, high)) return false;
  }
  return true;
}

bool cag_curve_clip_parameters(const CagCurve *a, double a0, double a1, const CagCurve *b,
                               double slack, double *from, double *to) {
  // Amount by which the range is enlarged, as a fraction of the interval: rounding of the
  // crossings.
  const double rounding = CAG_ROUNDING;
  Segment s, t;
  if (!segment_of(a, a0, a1, &s) || !segment_of(b, *from, *to, &t)) return true;
  const CagVec3 chord = cag_sub(cag_project(s.points + 4 * s.degree), cag_project(s.points));
  const CagVec3 unit = cag_unit(chord); // 0 for a closed piece: all distances are 0
  double low = 0, high = 1;
  if (a->dimension == 2 && b->dimension == 2) {
    if (!clip_across(&s, &t, cag_vec3(-unit.y, unit.x, 0), slack, &low, &high)) return false;
  } else {
    const CagVec3 other = fabs(unit.x) < 0.5 ? cag_vec3(1, 0, 0) : cag_vec3(0, 1, 0);
    const CagVec3 n = cag_unit(cag_cross(unit, other));
    if (!clip_across(&s, &t, n, slack, &low, &high) ||
        !clip_across(&s, &t, cag_cross(unit, n), slack, &low, &high))
      return false;
  }
  const double range = *to - *from, start = *from;
  if (low > rounding) *from = start + range * (low - rounding);
  if (high < 1 - rounding) *to = start + range * (high + rounding);
  return true;
}
