// Intersections of coplanar circles, in closed form.

#ifndef CAG_GEOM_INTERSECT_CIRCLES_H
#define CAG_GEOM_INTERSECT_CIRCLES_H

#include "geom/curve/contact.h"

// Intersections of parts of two circles, ascending by t; at most two. *decided is false in cases
// left to the general search: other curves, different planes, more than a full turn, circles within
// `same` of each other that neither cross nor touch to rounding, and circles that nearly coincide
// but intersect beyond the ends of the parts.
CagStatus cag_circles_intersect(const CagCurve *a, const CagCurve *b, double same,
                                CagContact out[2], size_t *n, bool *decided, CagError *err);

#endif
