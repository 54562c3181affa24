// A hierarchy of bounding boxes over numbered items, such as the triangles of a mesh.
//
// The boxes are floats relative to an origin, rounded outward by more than the rounding of the
// traversal, so that an item is never missed. A node has four children, whose boxes are tested
// together. The hierarchy is made by splitting items at the cheapest of a few planes by the surface
// area heuristic (MacDonald and Booth 1990; Wald 2007).

#ifndef CAG_GEOM_RAY_BVH_H
#define CAG_GEOM_RAY_BVH_H

#include <stdint.h>

#include "base/status.h"
#include "geom/linalg/vec.h"

#define CAG_BVH_WIDTH 4
// A node's child is another node, or a leaf: the range of `order` that starts at the index in the
// lower bits, with a count of 1 to 8 above them.
#define CAG_BVH_LEAF UINT32_C(0x80000000)
#define CAG_BVH_LEAF_MAX 8
#define CAG_BVH_COUNT_SHIFT 28
#define CAG_BVH_FIRST_MASK UINT32_C(0x0fffffff)
// The largest number of items.
#define CAG_BVH_ITEMS_MAX ((size_t)CAG_BVH_FIRST_MASK)

typedef struct CagBvhNode {
  float low[3][CAG_BVH_WIDTH], high[3][CAG_BVH_WIDTH]; // empty children have low > high
  uint32_t child[CAG_BVH_WIDTH];                       // of empty children: CAG_BVH_LEAF
  uint32_t unused[CAG_BVH_WIDTH];                      // nodes fill whole cache lines
} CagBvhNode;

typedef struct CagBvh {
  CagBvhNode *nodes;
  size_t node_count;
  uint32_t root;   // a node or leaf
  uint32_t *order; // the items, in the order of the leaves
  size_t item_count;
  // What the caller reads for each item of a leaf, in the order of `order`, so that the traversal can
  // fetch it early; NULL: unknown.
  const void *items;
  size_t item_size;
  CagBounds bounds;
  CagVec3 origin; // of the boxes
  double radius;  // half the diagonal of the bounds
} CagBvh;

// Makes the hierarchy of n items with these boxes, n >= 0. Fails with CAG_E_LIMIT if there are more
// than CAG_BVH_ITEMS_MAX.
CagStatus cag_bvh_build(const CagBounds *boxes, size_t n, CagBvh *out, CagError *err);
void cag_bvh_free(CagBvh *b); // also of a zeroed one

// A ray prepared for the traversal: relative to the point at which it enters the bounds.
typedef struct CagBvhRay {
  float origin[3], inverse[3]; // of the direction; large where the direction is 0
  double start;                // the ray's parameter at the prepared origin
  float least, most;           // range of parameters relative to `start`
} CagBvhRay;

// Prepares the part [least, most] of the ray origin + t direction, direction of length 1. Returns
// false if it misses the bounds.
bool cag_bvh_ray(const CagBvh *b, CagVec3 origin, CagVec3 direction, double least, double most,
                 CagBvhRay *out);

#endif
