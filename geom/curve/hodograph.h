// Derivatives and integrals of curves, as curves over the same domain.

#ifndef CAG_GEOM_HODOGRAPH_H
#define CAG_GEOM_HODOGRAPH_H

#include "geom/curve/curve.h"

// The curve t -> C'(t), exact: of polynomial curves and polylines without corners, and of arcs.
// Fails with "no-exact-form" for other kinds, and with "knot-multiplicity" at a corner of C, where
// the hodograph would jump.
CagStatus cag_curve_hodograph(const CagCurve *c, CagCurve **out, CagError *err);

// The curve t -> start + the integral of C from its first parameter to t, exact: of polynomial
// curves and polylines. Fails with "no-exact-form" for other kinds, and with "order-range".
CagStatus cag_curve_antiderivative(const CagCurve *c, CagVec3 start, CagCurve **out, CagError *err);

#endif
