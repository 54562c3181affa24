// Where circles of one plane meet, in closed form.

#ifndef CAG_GEOM_INTERSECT_CIRCLES_H
#define CAG_GEOM_INTERSECT_CIRCLES_H

#include "geom/curve/contact.h"

// Where parts of two circles meet, ascending by t; at most two places. *decided is false where the
// formula does not tell, which is a matter for the general search: other curves, other planes, more
// than a turn, circles within `same` of each other that neither cross nor touch to rounding, and
// circles that nearly coincide but meet beyond the ends of the parts.
CagStatus cag_circles_intersect(const CagCurve *a, const CagCurve *b, double same,
                                CagContact out[2], size_t *n, bool *decided, CagError *err);

#endif
