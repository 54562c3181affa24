// The nearest point of an ellipse.

#ifndef CAG_GEOM_ELLIPSE_FOOT_H
#define CAG_GEOM_ELLIPSE_FOOT_H

#include "geom/linalg/vec.h"

// The point of the ellipse with the semi-axes a and b along x and y that is nearest to (p.x, p.y);
// *normal is the outward unit normal there. At z = 0.
CagVec3 cag_ellipse_foot(double a, double b, CagVec3 p, CagVec3 *normal);

#endif
