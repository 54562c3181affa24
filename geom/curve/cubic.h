// Interpolating curves made of cubic segments: Hermite curves, cubic splines, parabolic blends.
//
// Every curve here is a B-spline of degree 3 (kind "bspline") whose domain is the natural
// parameter: the curve passes through point i at the i-th parameter. Splines with two continuous
// derivatives have simple knots, those with one have double knots, and those with only a continuous
// tangent direction have triple knots. A segment of length h with end tangents D and E has the
// Bezier points P, P + h D / 3, Q - h E / 3, Q.

#ifndef CAG_GEOM_CUBIC_H
#define CAG_GEOM_CUBIC_H

#include "geom/curve/curve.h"

// The parameter step between data points: their distance, 1, or the square root of their distance.
typedef enum CagSpacing {
  CAG_SPACING_CHORD,
  CAG_SPACING_UNIFORM,
  CAG_SPACING_CENTRIPETAL
} CagSpacing;

// Parameters of the n points, the first 0. Fails with "too-few-points" and, except for uniform
// spacing, with "coincident-points" and the index of the second of two equal neighbors.
CagStatus cag_spacing_parameters(const CagVec3 *points, size_t n, CagSpacing spacing, double *out,
                                 CagError *err);
// Checks given parameters: finite and strictly ascending, else "bad-parameter-length".
CagStatus cag_parameters_check(const double *parameters, size_t n, CagError *err);

typedef enum CagCubicClosing {
  CAG_CUBIC_ENDS,
  CAG_CUBIC_CYCLIC,
  CAG_CUBIC_ANTICYCLIC
} CagCubicClosing;

// End conditions. With CAG_CUBIC_ENDS each end is clamped (its tangent given), or has a given second
// derivative (0: relaxed). Cyclic: tangents and second derivatives at both ends are equal; anticyclic: equal and opposite.
typedef struct CagCubicEnds {
  CagCubicClosing closing;
  bool clamped[2];
  CagVec3 tangent[2];
  CagVec3 second[2]; // of ends that are not clamped
} CagCubicEnds;

// Tangents at all n points of the interpolating cubic spline with a continuous second derivative,
// from one tridiagonal system, solved in O(n) (de Boor 1978, chapter IV).
//
//   tension  NULL, or n - 2 numbers nu >= 0 of the inner points: the nu-spline, whose P'' jumps by
//            nu P' there ("bad-tension")
CagStatus cag_cubic_tangents(const CagVec3 *points, size_t n, const double *parameters,
                             const CagCubicEnds *ends, const double *tension, CagVec3 *out,
                             CagError *err);
// The spline itself.
CagStatus cag_curve_cubic_spline(const CagVec3 *points, size_t n, const double *parameters,
                                 const CagCubicEnds *ends, const double *tension, int dimension,
                                 CagCurve **out, CagError *err);

// The Hermite curve: n - 1 cubic segments with these points and tangents.
CagStatus cag_curve_hermite(const CagVec3 *points, const CagVec3 *tangents, size_t n,
                            const double *parameters, int dimension, CagCurve **out, CagError *err);
// Shortens tangents longer than `limit` chords of an adjacent segment (with 3, a segment has no
// loop unless its tangents point backwards).
void cag_hermite_limit(const CagVec3 *points, CagVec3 *tangents, size_t n, const double *parameters,
                       double limit);

// The polynomial curve sum of coefficients[k] t^k over 0..length, degree n - 1 >= 1.
CagStatus cag_curve_polynomial(const CagVec3 *coefficients, size_t n, double length, int dimension,
                               CagCurve **out, CagError *err);
// Coefficients of the pieces of a polynomial Bezier or B-spline curve, with the parameter measured
// from the start of each piece: *out has pieces x (degree + 1) of them, malloc'd, lowest power
// first. Fails with "not-polynomial".
CagStatus cag_curve_coefficients(const CagCurve *c, CagVec3 **out, size_t *pieces, int *degree,
                                 CagError *err);

// The shape of a plane cubic segment with end tangents over 0..1 (Stone and DeRose 1989, A
// geometric characterization of parametric cubic curves).
typedef struct CagHermiteShape {
  double chord;
  double speed[2], ratio[2], projection[2]; // of the tangents: length, length in chords, component
                                            // along the chord
  bool within_limit;                        // both ratios are at most 3
  size_t inflections;
  double inflection[2];
  bool has_cusp, has_loop;
  double cusp, loop[2]; // parameters
} CagHermiteShape;
CagStatus cag_hermite_shape(CagVec3 p, CagVec3 q, CagVec3 dp, CagVec3 dq, CagHermiteShape *out,
                            CagError *err);
// Lengths k0, k1 of the end tangents along the unit vectors dp, dq for which the plane segment has
// these signed curvatures at its ends. Returns the number of solutions: up to four pairs of
// positive lengths, ascending (de Boor, Hollig, and Sabin 1987, High accuracy geometric Hermite
// interpolation).
size_t cag_hermite_by_curvature(CagVec3 p, CagVec3 q, CagVec3 dp, CagVec3 dq, const double k[2],
                                double out[4][2]);

// Parabolic blends (Overhauser 1968; Brewer and Anderson 1977): segment i lies between points i and
// i + 1 and blends the parabolas through points i - 1, i, i + 1 and i, i + 1, i + 2.
typedef enum CagBlendEnds { CAG_BLEND_OPEN, CAG_BLEND_PARABOLA, CAG_BLEND_CLOSED } CagBlendEnds;

//   ratios   where each parabola passes its middle point, in (0, 1): n - 2 numbers for the inner
//            points, n of a closed curve; NULL: by the chords to the power `power`. Given ratios
//            make segments of length 1, and the curve's tangent is continuous in direction only
//            where they are not 1/2.
//   ends     open: from the second point to the last but one; parabola: the first and last span
//            are arcs of the first and last parabola; closed
CagStatus cag_curve_parabolic_blend(const CagVec3 *points, size_t n, const double *ratios,
                                    double power, CagBlendEnds ends, int dimension, CagCurve **out,
                                    CagError *err);

// The first control points of a Bezier curve Q over 0..1 of degree m that continues `c` with order
// 0, 1, or 2: C'(end) = ratio Q'(0), C''(end) = ratio^2 Q''(0). out: order + 1 points. Fails with
// "bad-order" and "bad-parameter".
CagStatus cag_bezier_join(const CagCurve *c, int m, int order, double ratio, CagVec3 *out,
                          CagError *err);

#endif
