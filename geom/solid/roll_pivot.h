// Turns of the ball about an edge of the opposite bend, for roll_plan.c.
//
// Two convex edges may meet where the third edge of the corner is concave, or the other way round:
// the upper edges of an L, or the lower edges of a box that stands on a plate. The ball rolls along
// the first edge until it touches the third one, turns about it, and continues along the second. If
// the third edge is rounded too, the ball turns about its fillet.
//
// The ball touches the face F of both edges and, at the distance `inner` + `radius` from the axis,
// the third edge (inner = 0) or its fillet. The other faces are planes, and the third edge is
// straight.

#ifndef CAG_GEOM_SOLID_ROLL_PIVOT_H
#define CAG_GEOM_SOLID_ROLL_PIVOT_H

#include "geom/solid/roll_plan.h"

// Adds the turn at a corner of three sharp edges, two of which (tips) are rounded and have a bend
// opposite to the third. third: the pick of the latter, or CAG_ROLL_NONE. *done: false if the
// corner is of another kind, or the ball leaves the third edge.
CagStatus cag_roll_add_pivot(CagRollPlan *p, size_t part, size_t corner, const CagRollTip tips[2],
                             CagRollTip third, bool *done, CagError *err);
// The section when the ball has turned by the fraction t from the end `tip` of an edge to the
// other. Side 0 is on the left of someone who comes along the edge. `along` is not set. *fits:
// whether there is a place for the ball.
CagStatus cag_roll_pivot_section(const CagRollPivot *pivot, CagRollTip tip, double t,
                                 CagRollSection *out, bool *fits, CagError *err);
// The number of parts into which the turn is divided.
size_t cag_roll_pivot_parts(const CagRollPlan *p, const CagRollPivot *pivot);

#endif
