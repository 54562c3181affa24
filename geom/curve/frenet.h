// Differential geometry of curves beyond the frame at one parameter: frames from derivatives,
// changes of parameter, contact with planes, and the points at which curvature, torsion, or speed
// vanish (do Carmo 1976, section 1-5).

#ifndef CAG_GEOM_CURVE_FRENET_H
#define CAG_GEOM_CURVE_FRENET_H

#include "geom/curve/curve.h"

// Frame, curvature, and torsion of a curve from its derivatives d[0..2] of order 1..3; the point is
// 0. Fails with "singular-point" if d[0] is 0.
CagStatus cag_frenet_of(const CagVec3 d[3], double *speed, CagFrenet *out, CagError *err);

// Derivatives 1..order of C(t(u)) with respect to u: d[k - 1] are the derivatives of C by t, f[k -
// 1] those of t by u; order is at most CAG_MAX_DERIVATIVE. Fails with "parameter-stands-still" if
// f[0] is 0.
CagStatus cag_chain_derivatives(const CagVec3 *d, const double *f, int order, CagVec3 *out,
                                CagError *err);

// Row i: the derivative of m[i] in the basis m; skew-symmetric, since the unit vectors m stay
// orthogonal. Fails with "frame-not-orthonormal", "triad-not-rigid".
CagStatus cag_triad_derivative(const CagVec3 m[3], const CagVec3 dm[3], double out[3][3],
                               CagError *err);

// The distance of the curve from the plane with this normal through its point at t, as a series in
// the parameter step h: c[1] h + c[2] h^2 + c[3] h^3 + ..
typedef struct CagPlaneContact {
  double c[4];
  int order; // order of contact: 0 crosses at an angle, 1 touches, ..; -1: lies in the plane
  int before, after; // side of the plane before and after t: -1, 0 (in the plane), 1
} CagPlaneContact;
CagStatus cag_curve_contact(const CagCurve *c, double t, CagVec3 normal, CagPlaneContact *out,
                            CagError *err);

// Quantities that may vanish along a curve: speed, curvature, torsion.
typedef enum CagVanishing { CAG_STANDS, CAG_STRAIGHT, CAG_FLAT, CAG_VANISHINGS } CagVanishing;

typedef struct CagParameters {
  double *t;
  size_t count, capacity;
} CagParameters;

typedef struct CagSpecialPoints {
  CagParameters points[CAG_VANISHINGS];    // single parameters, ascending
  CagParameters stretches[CAG_VANISHINGS]; // start and end of each interval on which it vanishes
} CagSpecialPoints;

// A point is listed only once, for the first quantity that vanishes. The result must be freed even
// after a failure.
CagStatus cag_curve_special_points(const CagCurve *c, CagSpecialPoints *out, CagError *err);
void cag_special_points_free(CagSpecialPoints *s);

#endif
