// Changes of representation that preserve the points of a curve: splitting, Bezier pieces, degree
// elevation, knot insertion; and the inverse operations, knot removal and degree reduction, which
// may change points within a tolerance.
//
// Curves that are not NURBS are converted first ("no-exact-form" if that is impossible). A periodic
// curve becomes an open one with the same points.

#ifndef CAG_GEOM_NURBS_OPS_H
#define CAG_GEOM_NURBS_OPS_H

#include "geom/curve/curve.h"

// The parts before and after t, t strictly inside the domain; each keeps its part of the parameter
// range.
CagStatus cag_curve_split(const CagCurve *c, double t, CagCurve *out[2], CagError *err);
// The pieces as curves of kind "bezier" over 0..1; *out is malloc'd.
CagStatus cag_curve_to_bezier(const CagCurve *c, CagCurve ***out, size_t *n, CagError *err);
// Raises the degree by `times`; every knot's multiplicity grows by as much, so the smoothness is
// preserved.
CagStatus cag_curve_elevate(const CagCurve *c, int times, CagCurve **out, CagError *err);
// Inserts each of the n knots (any order, repeats allowed) inside the domain (Boehm 1980). The
// multiplicity of a knot must not exceed the degree: "knot-multiplicity". Unclamped ends stay
// unclamped.
CagStatus cag_curve_insert_knots(const CagCurve *c, const double *t, size_t n, CagCurve **out,
                                 CagError *err);
// Inserts the midpoint of every non-empty knot interval. Uniform knots stay uniform: the outer
// intervals of an unclamped curve are halved too, and a periodic curve stays periodic, with twice
// as many points.
CagStatus cag_curve_insert_midpoints(const CagCurve *c, CagCurve **out, CagError *err);
// Clamps both ends: the end knots get multiplicity degree + 1, so the curve starts in its first and
// ends in its last control point.
CagStatus cag_curve_clamp(const CagCurve *c, CagCurve **out, CagError *err);

// Removes the inner knot t `times` times. *deviation (may be NULL) bounds the distance of new and
// old points at equal parameters; if it exceeds the tolerance, fails with "tolerance-exceeded".
// Fails with "no-such-knot".
CagStatus cag_curve_remove_knot(const CagCurve *c, double t, int times, double tolerance,
                                CagCurve **out, double *deviation, CagError *err);
// Lowers the degree by one, keeping both ends and, within the tolerance, the smoothness at the
// knots; deviation and failure as for cag_curve_remove_knot. In each piece the new control points,
// elevated again, are the least-squares approximation of the old ones.
CagStatus cag_curve_reduce_degree(const CagCurve *c, double tolerance, CagCurve **out,
                                  double *deviation, CagError *err);

#endif
