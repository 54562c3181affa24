// The sides of the box that trims a quadric, and the conics in which they intersect it.

#ifndef CAG_GEOM_MEET_QUADRIC_ARC_H
#define CAG_GEOM_MEET_QUADRIC_ARC_H

#include "geom/surface/quadric.h"

#define CAG_BOX_SIDES 6

// The frame of a side of a box, numbered x low, x high, y low, and so on: its origin is the middle
// of the side, and its normal is outward, or inward for a box that is mirrored later. The rectangle
// is the side in this frame.
CagTransform cag_box_side_frame(const CagBounds *box, int side, bool mirrored,
                                CagBounds *rectangle);

// Maximum number of arcs for a stretch of an outline.
#define CAG_QUADRIC_ARCS 64

// Returns the stretch a..b of a loop of a trimmed quadric as exact arcs of a conic or a line, if it
// lies on a side of the box or range that trims the quadric. *n is 0 if it does not, or if the
// surface is not from cag_quadric_patches. `loop` is the loop in space.
CagStatus cag_quadric_side_arcs(const CagSurface *s, const CagCurve *loop, double a, double b,
                                CagCurve *out[CAG_QUADRIC_ARCS], size_t *n, CagError *err);

#endif
