// The order of the parts of recognized boundaries, for recognized.h.

#ifndef CAG_GEOM_SOLID_RECOGNIZED_ORDER_H
#define CAG_GEOM_SOLID_RECOGNIZED_ORDER_H

#include "geom/boundary/boundary.h"

// Sorts corners, edges, and faces by x, then y, then z, as the kernel does: corners by their points,
// edges by their middles, and faces by the mean of the middles of their edges. Coordinates that
// differ by at most `slack` (mm) count as equal.
//
//   rank  b->face_count numbers: the new index of each face
CagStatus cag_recognized_order(CagBoundary *b, double slack, size_t *rank, CagError *err);

#endif
