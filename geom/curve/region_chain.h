// The edges of an arrangement that bound a region, and the region made of them.

#ifndef CAG_GEOM_REGION_CHAIN_H
#define CAG_GEOM_REGION_CHAIN_H

#include "geom/curve/region_arrange.h"

typedef struct CagRegionEdge {
  size_t from, to; // corners
  size_t piece;
  double a, b;  // over the piece's curve
  int count[2]; // how often it is run, forwards less backwards, by operand
  int keep;     // 1: the region is to the left, -1: to the right, 0: no part of its boundary
} CagRegionEdge;

// *out is NULL where no edge is kept. Fails with "region-undecided" (CAG_E_CONVERGENCE) where loops
// stay open.
CagStatus cag_region_chain(const CagRegionPieces *s, const CagRegionEdge *edges, size_t n,
                           const CagVec3 *corners, size_t corner_count, CagRegion **out,
                           CagError *err);

#endif
