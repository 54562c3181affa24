// Which side a point is on, exactly: signs of determinants of coordinates as they are given.

#ifndef CAG_GEOM_MESH_PREDICATES_H
#define CAG_GEOM_MESH_PREDICATES_H

#include "geom/linalg/vec.h"

// Positive where a, b, c turn left in the XY plane; 0: they are on one line.
int cag_side_of_line(CagVec3 a, CagVec3 b, CagVec3 c);
// Positive where d is on the side from which a, b, c run counter-clockwise; 0: in their plane.
int cag_side_of_plane(CagVec3 a, CagVec3 b, CagVec3 c, CagVec3 d);

#endif
