// Bounds of the derivatives of a curve over an interval.

#include "geom/curve/range.h"

#include <stdlib.h>
#include <string.h>

#include "geom/basis/bernstein.h"
#include "geom/curve/family.h"
#include "geom/curve/nurbs.h"

// Highest degree of a piece, and maximum length of a series.
#define MOST_DEGREE 24
#define MOST 16

static void widen(CagInterval *a, double x) {
  a->lo = cag_lower(a->lo, x);
  a->hi = cag_higher(a->hi, x);
}

// Ranges of the polynomial of degree p with the control points b on a piece of this length, over
// the part u..v of 0..1. Coefficient k has the control points C(p, k) times the k-th differences.
// The differences are those of the whole piece because those of a short part have larger rounding
// errors.
static void polynomial_ranges(double *b, int p, double length, double u, double v, int n,
                              CagInterval (*out)[4]) {
  double part[4 * (MOST_DEGREE + 1)], factor = 1;
  for (int k = 0; k <= n; k++) {
    for (int m = 0; m < 4; m++) out[k][m] = cag_interval(0);
    if (k > p) continue;
    cag_bezier_segment(b, p - k, u, v, part);
    for (int m = 0; m < 4; m++) {
      out[k][m] = cag_interval(part[m]);
      for (int i = 1; i <= p - k; i++) widen(&out[k][m], part[4 * i + m]);
      out[k][m] = cag_interval_scaled(out[k][m], factor);
    }
    for (int i = 0; i < p - k; i++)
      for (int m = 0; m < 4; m++) b[4 * i + m] = b[4 * (i + 1) + m] - b[4 * i + m];
    factor *= (p - k) / ((k + 1) * length);
  }
}

static bool nurbs_ranges(const CagNurbs *c, double a, double b, int n, CagInterval3 *out) {
  double part[4 * (MOST_DEGREE + 1)];
  CagInterval h[MOST][4], line[4][MOST], quotient[MOST];
  if (c->degree > MOST_DEGREE || n >= MOST) return false;
  // Find the piece by the midpoint: the ends may miss a knot by rounding.
  const size_t i = cag_nurbs_piece(c, a + (b - a) / 2, CAG_SIDE_RIGHT, c->pieces);
  const double length = c->cuts[i + 1] - c->cuts[i];
  const double u = fmax(0, (a - c->cuts[i]) / length), v = fmin(1, (b - c->cuts[i]) / length);
  memcpy(part, cag_nurbs_bezier(c, i), sizeof *part * 4 * (size_t)(c->degree + 1));
  polynomial_ranges(part, c->degree, length, u, v, n, h);
  for (int m = 0; m < 4; m++)
    for (int k = 0; k <= n; k++) line[m][k] = h[k][m];
  for (int m = 0; m < 3; m++) {
    if (c->rational && !cag_intervals_quotient(line[m], line[3], n, quotient)) return false;
    for (int k = 0; k <= n; k++) {
      CagInterval *to = m == 0 ? &out[k].x : m == 1 ? &out[k].y : &out[k].z;
      *to = c->rational ? quotient[k] : line[m][k];
    }
  }
  return true;
}

static CagInterval3 along(CagVec3 v, CagInterval f) {
  return (CagInterval3){cag_interval_scaled(f, v.x), cag_interval_scaled(f, v.y),
                        cag_interval_scaled(f, v.z)};
}

static CagInterval3 sum(CagInterval3 a, CagInterval3 b) {
  CagInterval3 out;
  cag_intervals3_add(&a, &b, 0, &out);
  return out;
}

// center + f(angle) (cos(angle) x + sin(angle) y) + climb angle z, angle = phase + rate t, where f
// is radius + growth angle.
static void coil_ranges(const CagCoil *coil, double a, double b, int n, CagInterval3 *out) {
  const double from = coil->phase + coil->rate * a, to = coil->phase + coil->rate * b;
  const CagInterval angle = {fmin(from, to), fmax(from, to)};
  const CagInterval r =
      cag_interval_add(cag_interval(coil->radius), cag_interval_scaled(angle, coil->growth));
  double factor = 1;
  for (int k = 0; k <= n; k++) {
    // (r e)^(k) = r e^(k) + k growth e^(k - 1), with e = (cos, sin) and quarter turns for e^(k).
    CagInterval e[4];
    for (int m = 0; m < 4; m++) {
      const double turn = (k - (m & 1) - (m >> 1)) * (M_PI / 2);
      e[m] = cag_interval_cos(cag_interval_add(angle, cag_interval(turn)));
    }
    const CagInterval x = cag_interval_add(cag_interval_product(r, e[0]),
                                           cag_interval_scaled(e[1], k * coil->growth));
    const CagInterval y = cag_interval_add(cag_interval_product(r, e[2]),
                                           cag_interval_scaled(e[3], k * coil->growth));
    const CagInterval z = k == 0   ? cag_interval_scaled(angle, coil->climb)
                          : k == 1 ? cag_interval(coil->climb)
                                   : cag_interval(0);
    const CagInterval3 v = sum(sum(along(coil->x, cag_interval_scaled(x, factor)),
                                   along(coil->y, cag_interval_scaled(y, factor))),
                               along(coil->z, cag_interval_scaled(z, factor)));
    out[k] = k == 0 ? sum(along(coil->center, cag_interval(1)), v) : v;
    factor *= coil->rate / (k + 1);
  }
}

static bool straight_ranges(const CagCurve *c, double a, double b, int n, CagInterval3 *out) {
  CagVec3 d[2];
  CagError ignored;
  if (cag_curve_eval(c, a, 1, CAG_SIDE_RIGHT, d, &ignored)) return false;
  memset(out, 0, (size_t)(n + 1) * sizeof *out);
  out[0] = sum(along(d[0], cag_interval(1)), along(d[1], (CagInterval){0, b - a}));
  if (n > 0) out[1] = along(d[1], cag_interval(1));
  return true;
}

bool cag_curve_ranges(const CagCurve *c, double a, double b, int n, CagInterval3 *out) {
  const CagNurbs *nurbs = cag_nurbs_data(c);
  if (nurbs) return nurbs_ranges(nurbs, a, b, n, out);
  CagCoil coil = {0};
  double rate;
  const CagVec3 *points;
  size_t count;
  bool ring;
  if (cag_curve_vertices(c, &points, &count, &ring)) return straight_ranges(c, a, b, n, out);
  if (cag_curve_coil(c, &coil)) {
    coil_ranges(&coil, a, b, n, out);
    return true;
  }
  const CagCurve *piece = cag_curve_composite_piece(c, a, b, &a, &b, &rate);
  if (!piece || !cag_curve_ranges(piece, a, b, n, out)) return false;
  double factor = 1;
  for (int k = 0; k <= n; k++) {
    out[k].x = cag_interval_scaled(out[k].x, factor);
    out[k].y = cag_interval_scaled(out[k].y, factor);
    out[k].z = cag_interval_scaled(out[k].z, factor);
    factor *= rate;
  }
  return true;
}
