// Elements of curve theory beyond the frame at one parameter: frames from derivatives, changes of
// the parameter, contact with planes, and the points of a curve where curvature, torsion or speed
// are 0 (do Carmo 1976, section 1-5).

#ifndef CAG_GEOM_CURVE_FRENET_H
#define CAG_GEOM_CURVE_FRENET_H

#include "geom/curve/curve.h"

// Frame, curvature and torsion of a curve with the derivatives d[0..2] of order 1..3; the point is
// 0. Fails with "singular-point" where d[0] is 0.
CagStatus cag_frenet_of(const CagVec3 d[3], double *speed, CagFrenet *out, CagError *err);

// Derivatives 1..order of C(t(u)) by u: d[k - 1] those of C by t, f[k - 1] those of t by u; order
// is at most CAG_MAX_DERIVATIVE. Fails with "parameter-stands-still" where f[0] is 0.
CagStatus cag_chain_derivatives(const CagVec3 *d, const double *f, int order, CagVec3 *out,
                                CagError *err);

// Row i: the derivative of m[i] in the basis m, skew as the unit vectors m stay at right angles.
// Fails with "frame-not-orthonormal", "triad-not-rigid".
CagStatus cag_triad_derivative(const CagVec3 m[3], const CagVec3 dm[3], double out[3][3],
                               CagError *err);

// The distance from the plane through the point of the curve at t with this normal, as a series in
// the step of the parameter: c[1] h + c[2] h^2 + c[3] h^3 + ..
typedef struct CagContact {
  double c[4];
  int order;         // of contact: 0 crosses at an angle, 1 touches ..; -1: lies in the plane
  int before, after; // side on which the curve comes and goes: -1, 0 (in the plane), 1
} CagContact;
CagStatus cag_curve_contact(const CagCurve *c, double t, CagVec3 normal, CagContact *out,
                            CagError *err);

// What may be 0 along a curve: the speed, the curvature, the torsion.
typedef enum CagVanishing { CAG_STANDS, CAG_STRAIGHT, CAG_FLAT, CAG_VANISHINGS } CagVanishing;

typedef struct CagParameters {
  double *t;
  size_t count, capacity;
} CagParameters;

typedef struct CagSpecialPoints {
  CagParameters points[CAG_VANISHINGS];    // single parameters, ascending
  CagParameters stretches[CAG_VANISHINGS]; // start and end of each piece where it is 0 throughout
} CagSpecialPoints;

// A point is in one list only, that of the first that is 0. To be freed also after a failure.
CagStatus cag_curve_special_points(const CagCurve *c, CagSpecialPoints *out, CagError *err);
void cag_special_points_free(CagSpecialPoints *s);

#endif
