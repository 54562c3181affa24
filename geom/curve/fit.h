// B-splines from data points: interpolation and least squares (Piegl and Tiller 1997, chapter 9).
//
// Both systems are banded, since only degree + 1 basis functions are nonzero on a span.
// Interpolation uses LAPACK's banded elimination with pivoting. Least squares uses Givens rotations
// that add one data row at a time to a banded triangle, which never squares the condition number.

#ifndef CAG_GEOM_FIT_H
#define CAG_GEOM_FIT_H

#include "geom/curve/cubic.h"

typedef enum CagFitKnots {
  CAG_FIT_AUTO,     // uniform if the data suit it, else averaged
  CAG_FIT_OPEN,     // clamped, uniform
  CAG_FIT_AVERAGED, // clamped, from the parameters of the data
  CAG_FIT_GIVEN
} CagFitKnots;

typedef struct CagFitData {
  const CagVec3 *points;
  size_t n;
  CagSpacing spacing;       // spacing of the parameters over the usable range of the knots ...
  const double *parameters; // ... or n numbers, ascending; NULL: by spacing
  CagFitKnots kind;
  const double *knots; // for CAG_FIT_GIVEN
  int degree;
  int dimension;
} CagFitData;

typedef struct CagFitReport {
  double *parameters; // n, malloc'd
  CagVec3 *residuals; // n, malloc'd: curve minus data
  double rms, largest;
  int rounds; // rounds of the iteration that keeps a coordinate exact
} CagFitReport;
void cag_fit_report_free(CagFitReport *r);

// The curve through all points. tangents: NULL; or 2: at both ends (with n = 2 at both points); or
// n: at all points. They are derivatives with respect to the parameter. Fails with "fit-singular",
// "zero-chord-total", "bad-parameter", "order-range", and others.
CagStatus cag_curve_interpolate(const CagFitData *data, const CagVec3 *tangents,
                                size_t tangent_count, CagCurve **out, CagError *err);

// Conditions at the ends of an interpolating cubic, instead of tangents.
typedef enum CagFitEnds {
  CAG_FIT_NATURAL,    // the second derivative is 0
  CAG_FIT_NOT_A_KNOT, // the third derivative is continuous at the second and second to last point;
                      // a parabola through 3 points, and a line through 2
  CAG_FIT_PERIODIC,   // the first and second derivative agree; the first point is also the last
  CAG_FIT_SECOND      // given second derivatives with respect to the parameter
} CagFitEnds;

// The cubic with two continuous derivatives through all points. The degree in the data is 3, and
// knots in the data are ignored. `second` is for CAG_FIT_SECOND. Fails also with "not-closed".
CagStatus cag_curve_interpolate_ends(const CagFitData *data, CagFitEnds ends,
                                     const CagVec3 second[2], CagCurve **out, CagError *err);

// Least squares with `count` control points.
//
//   keep_ends  the first and last control point are the first and last data point
//   axis       -1; else 0, 1, 2: the curve at the parameter of each point has exactly (to `slack`)
//              that coordinate of the point; keeps the ends too. The parameters of inner points are
//              moved, at most CAG_FIT_ROUNDS times ("fit-no-convergence")
//   report     may be NULL
#define CAG_FIT_ROUNDS 50
CagStatus cag_curve_fit(const CagFitData *data, size_t count, bool keep_ends, int axis,
                        double slack, CagCurve **out, CagFitReport *report, CagError *err);

#endif
