// Knot removal and degree reduction of NURBS curves.

#include <string.h>

#include "base/memory.h"
#include "geom/curve/family.h"
#include "geom/curve/nurbs.h"
#include "geom/curve/nurbs_ops.h"
#include "geom/curve/reduce_rows.h"

static CagStatus rows_curve(const CagRows *s, const CagCurve *like, CagCurve **out, CagError *err) {
  return cag_nurbs_new(s->h, s->count, s->degree, s->knots, s->rational, 0,
                       s->rational ? CAG_NURBS_RATIONAL : CAG_NURBS_BSPLINE, like->dimension, out,
                       err);
}

CagStatus cag_curve_remove_knot(const CagCurve *c, double t, int times, double tolerance,
                                CagCurve **out, double *deviation, CagError *err) {
  CagCurve *exact, *open = NULL;
  CagRows s = {0};
  double moved = 0;
  CagStatus status = cag_curve_to_nurbs(c, &exact, err);
  if (status) return status;
  const CagNurbs *n = cag_nurbs_data(exact);
  if (n->periodic) status = cag_curve_clamp(exact, &open, err);
  else open = cag_curve_retain(exact);
  cag_curve_release(exact);
  if (status) return status;
  n = cag_nurbs_data(open);
  status = cag_rows_new(n->degree, n->count, 1, n->rational, &s, err);
  if (!status) {
    memcpy(s.h, n->homogeneous, sizeof(double) * 4 * n->count);
    memcpy(s.knots, n->knots, sizeof(double) * (n->count + (size_t)n->degree + 1));
    status = cag_rows_remove(&s, t, times, tolerance, &moved, err);
  }
  if (!status) status = rows_curve(&s, c, out, err);
  if (!status && deviation) *deviation = moved;
  cag_rows_free(&s);
  cag_curve_release(open);
  return status;
}

// The pieces of a curve without their repeated ends, and the multiplicities of its cuts.
static CagStatus curve_pieces(const CagNurbs *n, CagRowPieces *out, CagError *err) {
  const size_t p = (size_t)n->degree;
  double *h = cag_malloc(sizeof(double) * 4 * (n->pieces * p + 1));
  int *multiplicity = cag_malloc((n->pieces + 1) * sizeof *multiplicity);
  *out = (CagRowPieces){n->degree, n->pieces, 1, n->rational, h, n->cuts, multiplicity};
  if (!h || !multiplicity) return cag_fail_memory(err);
  for (size_t i = 0; i < n->pieces; i++) {
    memcpy(h + 4 * i * p, cag_nurbs_bezier(n, i), sizeof(double) * 4 * (p + 1));
    multiplicity[i] = cag_knots_multiplicity(n->knots, n->count, n->degree, n->cuts[i]);
  }
  return CAG_OK;
}

CagStatus cag_curve_reduce_degree(const CagCurve *c, double tolerance, CagCurve **out,
                                  double *deviation, CagError *err) {
  CagCurve *open;
  CagStatus status = cag_curve_to_nurbs(c, &open, err);
  if (status) return status;
  CagCurve *exact = open;
  status = cag_curve_clamp(exact, &open, err);
  cag_curve_release(exact);
  if (status) return status;
  CagRowPieces pieces;
  CagRows s = {0};
  double moved = 0;
  status = curve_pieces(cag_nurbs_data(open), &pieces, err);
  if (!status) status = cag_rows_reduce(&pieces, tolerance, &s, &moved, err);
  if (!status) status = rows_curve(&s, c, out, err);
  if (!status && deviation) *deviation = moved;
  cag_free((void *)pieces.h);
  cag_free((void *)pieces.multiplicity);
  cag_rows_free(&s);
  cag_curve_release(open);
  return status;
}
