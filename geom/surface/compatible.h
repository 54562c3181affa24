// Brings two NURBS curves to a common degree, domain, and knot vector, so that their control points
// can be joined by rulings.

#ifndef CAG_GEOM_SURFACE_COMPATIBLE_H
#define CAG_GEOM_SURFACE_COMPATIBLE_H

#include "geom/curve/curve.h"

typedef struct CagCompatible {
  int degree;
  size_t count;
  double *knots;  // count + degree + 1, over 0..1
  double *net[2]; // count x 4, homogeneous, for each curve
} CagCompatible;

// Both curves must have exact forms. Release with cag_compatible_free.
CagStatus cag_curves_compatible(const CagCurve *a, const CagCurve *b, CagCompatible *out,
                                CagError *err);
void cag_compatible_free(CagCompatible *c);

#endif
