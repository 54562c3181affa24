// Parts of closed curves across the seam, where the end meets the start.

#include <float.h>

#include "base/memory.h"
#include "geom/curve/family.h"
#include "geom/curve/nurbs.h"

// The vertices of both polylines; the second starts in the last vertex of the first, with its
// parameters increased by `shift`.
static CagStatus join_polylines(const CagCurve *first, const CagCurve *second, double shift,
                                CagCurve **out, CagError *err) {
  const CagVec3 *p, *q;
  size_t np, nq, cuts_p, cuts_q;
  bool ring;
  double *tp = NULL, *tq = NULL;
  cag_curve_vertices(first, &p, &np, &ring);
  cag_curve_vertices(second, &q, &nq, &ring);
  CagVec3 *points = cag_malloc((np + nq) * sizeof *points);
  double *t = cag_malloc((np + nq) * sizeof *t);
  CagStatus status = points && t ? CAG_OK : cag_fail_memory(err);
  if (!status) status = cag_curve_cuts(first, &tp, &cuts_p, err);
  if (!status) status = cag_curve_cuts(second, &tq, &cuts_q, err);
  for (size_t i = 0; !status && i < np; i++) {
    points[i] = p[i];
    t[i] = tp[i];
  }
  for (size_t i = 1; !status && i < nq; i++) {
    points[np + i - 1] = q[i];
    t[np + i - 1] = tq[i] + shift;
  }
  if (!status) status = cag_curve_polyline_over(points, t, np + nq - 1, first->dimension, out, err);
  cag_free(points);
  cag_free(t);
  cag_free(tp);
  cag_free(tq);
  return status;
}

// The part from a in the domain across the seam to b - period.
static CagStatus two_parts(const CagCurve *c, double a, double b, double period, CagCurve **out,
                           CagError *err) {
  CagCurve *parts[2] = {NULL, NULL}, *joined = NULL;
  const CagVec3 *vertices;
  size_t n;
  bool ring;
  CagStatus status = cag_curve_trim(c, a, c->end, &parts[0], err);
  if (!status) status = cag_curve_trim(c, c->start, b - period, &parts[1], err);
  if (!status && cag_curve_vertices(c, &vertices, &n, &ring)) {
    status = join_polylines(parts[0], parts[1], period, out, err);
  } else {
    if (!status) status = cag_curve_join(parts, 2, &joined, err);
    // A NURBS stays a NURBS, with a knot of full multiplicity at the seam.
    if (!status && cag_nurbs_data(c)) status = cag_curve_to_nurbs(joined, out, err);
    else if (!status) *out = cag_curve_retain(joined);
  }
  cag_curve_release(joined);
  cag_curve_release(parts[0]);
  cag_curve_release(parts[1]);
  return status;
}

CagStatus cag_curve_trim_over_seam(const CagCurve *c, double a, double b, CagCurve **out,
                                   CagError *err) {
  const double period = c->end - c->start, slack = 16 * DBL_EPSILON * fmax(fabs(a), fabs(b));
  CagVec3 center, x, y;
  double rate;
  const CagCurvePart between = {a, b, a, b};
  if (cag_curve_arc_axes(c, &center, &x, &y, &rate)) return cag_curve_part(c, &between, out, err);
  // Removes whole turns, so that the part begins within the domain.
  const double turns = floor((a - c->start + slack) / period) * period;
  const double from = fmax(a - turns, c->start), to = b - turns;
  CagCurve *part;
  CagStatus status = to <= c->end + slack ? cag_curve_trim(c, from, fmin(to, c->end), &part, err)
                                          : two_parts(c, from, to, period, &part, err);
  if (status) return status;
  status = cag_curve_reparametrize_as(part, a, b, c->angular, out, err);
  cag_curve_release(part);
  return status;
}
