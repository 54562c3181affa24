// Rounding within a small ball about a point, by opening or closing the solid, for rolling.h.
//
// The opening of a solid is what balls within it cover: its convex edges are rounded. Its closing is
// what balls outside of it cannot reach: the concave edges are (Serra 1982, Image analysis and
// mathematical morphology). Both are offsets of the part near the zone.

#ifndef CAG_GEOM_SOLID_ROLL_ZONE_H
#define CAG_GEOM_SOLID_ROLL_ZONE_H

#include "geom/solid/roll_plan.h"

// Rounds the edges of a mesh within a zone: replaces *mesh by one that differs from it there by what
// the ball does not reach. *fits: false if the ball is too large for the solid there.
CagStatus cag_roll_apply_zone(const CagRollZone *z, double tolerance, CagMesh **mesh, bool *fits,
                              CagError *err);

// The distance of the result from the opened or closed solid.
double cag_roll_zone_within(const CagRollZone *z, double tolerance);

#endif
