// The data of the NURBS kinds (bezier, bspline, nurbs), for code that works on control points.
//
// In addition to the given knots and control points, a curve keeps its Bezier pieces, one per
// non-empty knot interval. Neighboring pieces share their joint bit for bit, and the last piece of
// a periodic curve ends in the first point of its first piece. Curves are evaluated from the
// pieces, so they are exactly continuous and closed. Up to degree CAG_NURBS_TAYLOR the Taylor
// coefficients of the pieces about both ends are kept as well; evaluation from the nearer end is as
// accurate as de Casteljau and several times faster.

#ifndef CAG_GEOM_NURBS_H
#define CAG_GEOM_NURBS_H

#include "geom/basis/bspline.h"
#include "geom/curve/curve.h"

#define CAG_NURBS_TAYLOR 3

typedef struct CagNurbs {
  CagCurve base;
  int degree;
  size_t count, distinct;
  bool periodic, rational;
  double *knots;       // count + degree + 1
  double *homogeneous; // count x 4
  size_t pieces;
  double *cuts;    // pieces + 1: distinct knots of the domain
  double *bezier;  // pieces x (degree + 1) x 4
  double *taylor;  // pieces x 2 x (degree + 1) x 4: about the left end, about the right; or NULL
  double per_unit; // pieces per unit of t if the cuts are equally spaced, else 0
  bool has_narrow; // some piece is much shorter than its neighboring knot intervals: its
                   // derivatives are not taken from its Bezier form
} CagNurbs;

typedef enum CagNurbsKind { CAG_NURBS_BEZIER, CAG_NURBS_BSPLINE, CAG_NURBS_RATIONAL } CagNurbsKind;

// NULL if the curve is of another kind.
const CagNurbs *cag_nurbs_data(const CagCurve *c);
// From homogeneous points (copied). distinct: number of given points of a periodic curve, else 0.
// If not `rational`, all weights must be 1. Knots must be valid; weights are checked.
CagStatus cag_nurbs_new(const double *homogeneous, size_t n, int degree, const double *knots,
                        bool rational, size_t distinct, CagNurbsKind kind, int dimension,
                        CagCurve **out, CagError *err);
// The part over [a, b], which is in the domain, with clamped ends.
CagStatus cag_nurbs_clamped(const CagCurve *c, double a, double b, CagCurve **out, CagError *err);
// Index of the piece that contains t.
size_t cag_nurbs_piece(const CagNurbs *c, double t, CagSide side, size_t hint);
// Points and derivatives up to `order` at n parameters, limits from the right, like eval_many.
// Returns false if the degree or order is not supported. See nurbs_many.c.
bool cag_nurbs_eval_many(const CagNurbs *c, const double *t, size_t n, int order, CagVec3 *out);
static inline const double *cag_nurbs_bezier(const CagNurbs *c, size_t piece) {
  return c->bezier + piece * (size_t)(c->degree + 1) * 4;
}

#endif
