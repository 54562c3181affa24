// Curves along which two carriers meet, for recognized.h.

#ifndef CAG_GEOM_SOLID_RECOGNIZED_CURVE_H
#define CAG_GEOM_SOLID_RECOGNIZED_CURVE_H

#include "geom/boundary/boundary.h"

// Moves a point to where n carriers (2 or 3) meet, by Newton's method with steps of least length.
// *settled: false, and the point stays, if they are tangent there or the point would move by more
// than `most` (mm). Carriers of the kind NONE count as missing ones.
CagStatus cag_recognized_settle(const CagCarrier *const *carriers, size_t n, double most,
                                CagVec3 *p, bool *settled, CagError *err);

// The curve between two carriers near n >= 2 points, through the first and the last of them; n >= 4
// and these are equal if it is closed. It is a line, a circle, or an ellipse where it is one to
// 1e-7 of `size`, else a cubic spline through points of both carriers. Points that cannot be moved
// to both by at most `most` stay.
CagStatus cag_recognized_curve(const CagCarrier *const carriers[2], const CagVec3 *points, size_t n,
                               bool closed, double size, double most, CagCurve **out,
                               CagError *err);

// The curve in the parameters of a carrier, with the parameter of the curve: a line where it is one,
// else a cubic spline through points of it.
CagStatus cag_recognized_trace(const CagCarrier *c, const CagCurve *curve, CagCurve **out,
                               CagError *err);

#endif
