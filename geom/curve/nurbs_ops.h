// Changing how a curve is written without changing its points: splitting, Bezier pieces, degree
// elevation, knot insertion.
//
// Curves that are no NURBS are converted first ("no-exact-form" where that cannot be). A periodic
// curve becomes an open one with the same points.

#ifndef CAG_GEOM_NURBS_OPS_H
#define CAG_GEOM_NURBS_OPS_H

#include "geom/curve/curve.h"

// The parts before and after t, t strictly inside the domain; each keeps its part of the domain.
CagStatus cag_curve_split(const CagCurve *c, double t, CagCurve *out[2], CagError *err);
// The pieces as curves of kind "bezier" over 0..1; *out is malloc'd.
CagStatus cag_curve_to_bezier(const CagCurve *c, CagCurve ***out, size_t *n, CagError *err);
// Degree raised `times` times; every knot's multiplicity grows along, so smoothness stays.
CagStatus cag_curve_elevate(const CagCurve *c, int times, CagCurve **out, CagError *err);
// Inserts each of the n knots (any order, repeats allowed) of the domain's inside (Boehm 1980). No
// knot may occur more often than the degree: "knot-multiplicity".
CagStatus cag_curve_insert_knots(const CagCurve *c, const double *t, size_t n, CagCurve **out,
                                 CagError *err);
// Inserts the middle of every non-empty knot interval.
CagStatus cag_curve_insert_midpoints(const CagCurve *c, CagCurve **out, CagError *err);

#endif
