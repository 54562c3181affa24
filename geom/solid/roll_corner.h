// Balls and turns at corners, for roll_plan.c.

#ifndef CAG_GEOM_SOLID_ROLL_CORNER_H
#define CAG_GEOM_SOLID_ROLL_CORNER_H

#include "geom/solid/roll_plan.h"

// Adds the balls and turns of all corners, and lets the edges there end within them. Sets `unfit`
// if a ball does not exist, or if those at the ends of an edge pass each other. Fails as
// cag_roll_plan.
CagStatus cag_roll_balls(CagRollPlan *p, CagError *err);

// The parameter at which the section of an edge contains the center of a ball near its end.
CagStatus cag_roll_station(const CagRollPick *pick, int end, CagVec3 center, double *out,
                           bool *found, CagError *err);

#endif
