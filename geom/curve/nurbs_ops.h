// Changing how a curve is written without changing its points: splitting, Bezier pieces, degree
// elevation, knot insertion; and the ways back, knot removal and degree reduction, which may change
// them within a tolerance.
//
// Curves that are not NURBS are converted first ("no-exact-form" where that cannot be). A periodic
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
// knot may occur more often than the degree: "knot-multiplicity". Ends that are not clamped stay as
// they are.
CagStatus cag_curve_insert_knots(const CagCurve *c, const double *t, size_t n, CagCurve **out,
                                 CagError *err);
// Inserts the middle of every non-empty knot interval. Uniform knots stay uniform: outer intervals
// of an unclamped curve are halved too, and a periodic curve stays one, with twice as many points.
CagStatus cag_curve_insert_midpoints(const CagCurve *c, CagCurve **out, CagError *err);
// Both ends in degree + 1 knots, so that the curve starts in its first and ends in its last control
// point.
CagStatus cag_curve_clamp(const CagCurve *c, CagCurve **out, CagError *err);

// Removes the inner knot t `times` times. *deviation (may be NULL) bounds the distance of new and
// old points of one parameter; where it is more than the tolerance, fails with
// "tolerance-exceeded". Fails with "no-such-knot".
CagStatus cag_curve_remove_knot(const CagCurve *c, double t, int times, double tolerance,
                                CagCurve **out, double *deviation, CagError *err);
// Lowers the degree by one, keeping both ends and, within the tolerance, the smoothness at the
// knots; deviation and failure as of cag_curve_remove_knot. Of each piece the control points,
// raised again, are nearest to the old ones in the least squares sense.
CagStatus cag_curve_reduce_degree(const CagCurve *c, double tolerance, CagCurve **out,
                                  double *deviation, CagError *err);

#endif
