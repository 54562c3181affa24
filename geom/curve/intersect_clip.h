// Bezier clipping: the part of a Bezier piece that may lie near another one.

#ifndef CAG_GEOM_INTERSECT_CLIP_H
#define CAG_GEOM_INTERSECT_CLIP_H

#include "geom/curve/curve.h"

// Narrows [*from, *to], a part of a smooth piece of b, to where b may be within `slack` of a over
// [a0, a1], likewise smooth. False: nowhere. Parts of curves without control points, or with
// weights that are not positive, stay as they are.
bool cag_curve_clip_parameters(const CagCurve *a, double a0, double a1, const CagCurve *b,
                               double slack, double *from, double *to);

#endif
