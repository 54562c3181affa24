// Removes and adds the bodies of rounded edges, and checks the result, for rolling.h.

#ifndef CAG_GEOM_SOLID_ROLL_APPLY_H
#define CAG_GEOM_SOLID_ROLL_APPLY_H

#include "geom/mesh/mesh.h"
#include "geom/solid/roll_plan.h"

// Whether the mesh has a point that is at most `most` away from p. Linear time.
bool cag_roll_is_near(const CagMesh *m, CagVec3 p, double most);

// Tests whether the contacts of the plan's sections lie on the mesh of the solid, between the balls
// at the corners: sets `unfit` otherwise.
CagStatus cag_roll_contacts(CagRollPlan *p, const CagMesh *solid, CagError *err);

// The mesh of the solid after all bodies of the plan were removed or added. Sets `unfit` if the
// result does not pass through the sections in the middles of edges. Fails with "no-boundary" if
// the result is not watertight, or if its volume is out of bounds. *out is set if the plan fits.
CagStatus cag_roll_apply(CagRollPlan *p, const CagMesh *solid, CagMesh **out, CagError *err);

#endif
