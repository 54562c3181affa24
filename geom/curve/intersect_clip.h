// Bezier clipping: the part of a Bezier piece that may be near another one.

#ifndef CAG_GEOM_INTERSECT_CLIP_H
#define CAG_GEOM_INTERSECT_CLIP_H

#include "geom/curve/curve.h"

// Narrows [*from, *to], part of a smooth piece of b, to the parameters at which b may be within
// `slack` of a over [a0, a1], part of a smooth piece of a. Returns false if there are none.
// Intervals of curves without control points, or with weights that are not positive, are not
// changed.
bool cag_curve_clip_parameters(const CagCurve *a, double a0, double a1, const CagCurve *b,
                               double slack, double *from, double *to);

#endif
