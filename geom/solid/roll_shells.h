// Thin shells of meshes, for rolling.h.

#ifndef CAG_GEOM_SOLID_ROLL_SHELLS_H
#define CAG_GEOM_SOLID_ROLL_SHELLS_H

#include "geom/mesh/mesh.h"

// The closed mesh without the shells whose volume is less than half their area times the tolerance,
// except for that of the largest volume. Such shells, parts and cavities, are what is left where
// the surfaces of bodies nearly coincide.
CagStatus cag_roll_drop_thin_shells(const CagMesh *m, double tolerance, CagMesh **out,
                                    CagError *err);

#endif
