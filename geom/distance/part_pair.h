// Two parts of shapes, and the nearest points of the exact shapes that they lead to.

#ifndef CAG_GEOM_DISTANCE_PART_PAIR_H
#define CAG_GEOM_DISTANCE_PART_PAIR_H

#include "geom/distance/separation.h"

typedef struct CagPartPair {
  const CagPart *part[2];
  int free[2], n; // parameters of each, of both
  double x[4];
} CagPartPair;

// The pair at the parameters within its parts.
CagPartPair cag_part_pair(const CagPart *a, const CagPart *b);
// The distance at the local minimum that the pair leads to, and its point of the second shape.
CagStatus cag_part_pair_refine(CagPartPair *pair, double *out, CagVec3 *point, CagError *err);
// Moves the point of a flat triangle to the nearest one to the other point. Newton's method can end
// at the corner where the parameters of the triangle are not unique. False: it does not get nearer.
bool cag_part_pair_leave_corner(CagPartPair *pair, double distance, CagStatus *status,
                                CagError *err);

#endif
