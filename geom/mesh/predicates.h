// Exact orientation predicates: signs of determinants of the coordinates as given.

#ifndef CAG_GEOM_MESH_PREDICATES_H
#define CAG_GEOM_MESH_PREDICATES_H

#include "geom/linalg/vec.h"

// Positive if a, b, c turn left in the XY plane; 0 if they are collinear.
int cag_side_of_line(CagVec3 a, CagVec3 b, CagVec3 c);
// Positive if a, b, c are counter-clockwise as seen from d; 0 if d is in their plane.
int cag_side_of_plane(CagVec3 a, CagVec3 b, CagVec3 c, CagVec3 d);

#endif
