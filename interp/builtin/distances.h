// The nearest points of two shapes.

#ifndef CAG_INTERP_BUILTIN_DISTANCES_H
#define CAG_INTERP_BUILTIN_DISTANCES_H

#include "geom/linalg/vec.h"
#include "interp/vm/builtin.h"

// Two points with the least distance. They coincide if it is 0.
typedef struct CagClosest {
  double distance;
  CagVec3 points[2];
} CagClosest;

// The closest points of the first two arguments: shapes, groups, lists of these, or points. Without
// `points`, these may be off by more than the distance is.
bool cag_closest_of_arguments(CagCall *call, bool points, CagClosest *out);

#endif
