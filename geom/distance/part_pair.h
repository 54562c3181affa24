// Two parts of shapes, and the nearest points of the exact shapes found from them.

#ifndef CAG_GEOM_DISTANCE_PART_PAIR_H
#define CAG_GEOM_DISTANCE_PART_PAIR_H

#include "geom/distance/separation.h"

typedef struct CagPartPair {
  const CagPart *part[2];
  int free[2], n; // number of parameters of each, and of both
  double x[4];
} CagPartPair;

// The pair, starting at the parameters of its parts.
CagPartPair cag_part_pair(const CagPart *a, const CagPart *b);
// Converges from the pair to a local minimum of the distance; returns it and its points.
CagStatus cag_part_pair_refine(CagPartPair *pair, double *out, CagVec3 points[2], CagError *err);
// Moves the point of a flat triangle to the one nearest to the other point. Newton's method can get
// stuck at the corner at which the parameters of the triangle are not unique. Returns false if the
// distance does not decrease.
bool cag_part_pair_leave_corner(CagPartPair *pair, double distance, CagStatus *status,
                                CagError *err);

#endif
