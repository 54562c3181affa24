// Moved copies of boundaries.

#ifndef CAG_GEOM_BOUNDARY_MOVED_H
#define CAG_GEOM_BOUNDARY_MOVED_H

#include "geom/boundary/boundary.h"

// The image under a similarity: rigid, or scaled uniformly, with or without a reflection. Frames of
// the copy are right-handed, and the parameters of its carriers are those of boundary.h. The edges
// keep their order and parameters; a reflection reverses the loops, and u on carriers of
// revolution. The copy has no `body`. Fails with "no-boundary" if the transform is not a
// similarity.
CagStatus cag_boundary_moved(const CagBoundary *b, const CagTransform *similarity, CagBoundary *out,
                             CagError *err);

#endif
