// Chains the boundary edges of an arrangement into the loops of a region.

#ifndef CAG_GEOM_REGION_CHAIN_H
#define CAG_GEOM_REGION_CHAIN_H

#include "geom/curve/region_arrange.h"

typedef struct CagRegionEdge {
  size_t from, to; // corners
  size_t piece;
  double a, b;  // range of the parameter on the piece's curve
  int count[2]; // net number of times it is run (forwards minus backwards), by operand
  int keep;     // 1: the region is to the left, -1: to the right, 0: not part of its boundary
} CagRegionEdge;

// *out is NULL if no edge is kept. Fails with "region-undecided" (CAG_E_CONVERGENCE) if loops stay
// open.
CagStatus cag_region_chain(const CagRegionPieces *s, const CagRegionEdge *edges, size_t n,
                           const CagVec3 *corners, size_t corner_count, CagRegion **out,
                           CagError *err);

#endif
