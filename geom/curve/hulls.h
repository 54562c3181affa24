// The distance of the convex hulls of two point sets.
//
// A curve stays in the hull of its control points, so curves with disjoint hulls do not meet.

#ifndef CAG_GEOM_HULLS_H
#define CAG_GEOM_HULLS_H

#include <stdbool.h>
#include <stddef.h>

#include "geom/linalg/vec.h"

// The vector between the nearest points of both hulls, from the second to the first: zero (to
// rounding) if they intersect (Gilbert, Johnson, Keerthi 1988). n, m >= 1.
CagVec3 cag_hulls_gap(const CagVec3 *a, size_t n, const CagVec3 *b, size_t m);
// Whether a plane separates them; touching hulls are not disjoint.
bool cag_hulls_disjoint(const CagVec3 *a, size_t n, const CagVec3 *b, size_t m);

#endif
