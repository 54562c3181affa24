// A hierarchy of bounding boxes over numbered items, such as the triangles of a mesh.
//
// A node has up to eight children, whose boxes are tested together. The boxes are stored in bytes,
// relative to the box of the node (Ylitie, Karras, and Laine 2017), since the time of a ray is mostly
// that of fetching nodes from memory. They are rounded outward by more than the rounding of the
// traversal in floats, so that an item is never missed. The hierarchy is made by splitting items at
// the cheapest of a few planes by the surface area heuristic (MacDonald and Booth 1990; Wald 2007).

#ifndef CAG_GEOM_RAY_BVH_H
#define CAG_GEOM_RAY_BVH_H

#include <stdint.h>

#include "base/status.h"
#include "geom/linalg/vec.h"

#define CAG_BVH_WIDTH 8
// A node's child is another node, or a leaf: the range of `order` that starts at the index in the
// lower bits, with a count of 1 to 7 above them, less 1.
#define CAG_BVH_LEAF UINT32_C(0x80000000)
#define CAG_BVH_LEAF_MAX 7
#define CAG_BVH_COUNT_SHIFT 28
#define CAG_BVH_FIRST_MASK UINT32_C(0x0fffffff)
// The largest number of items.
#define CAG_BVH_ITEMS_MAX ((size_t)CAG_BVH_FIRST_MASK)

// The planes of a child's box are base + step * byte along each axis, where step is the power of two
// whose float has this exponent. A node fills 1.5 cache lines, and is aligned so that it is in two.
typedef struct CagBvhNode {
  float base[3];
  uint8_t exponent[3];
  uint8_t count;                       // of children; the others are unset
  uint8_t planes[2][3][CAG_BVH_WIDTH]; // low and high, along each axis
  uint32_t child[CAG_BVH_WIDTH];
} CagBvhNode;
#define CAG_BVH_NODE_ALIGN 32

// The float with a biased exponent, 1 to 254.
static inline float cag_bvh_step(uint8_t exponent) {
  const union {
    uint32_t bits;
    float value;
  } step = {.bits = (uint32_t)exponent << 23};
  return step.value;
}

typedef struct CagBvh {
  CagBvhNode *nodes; // within `memory`
  void *memory;
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

// Makes the hierarchy of n items with these boxes, n >= 0. Leaves have at most `leaf_items`, 1 to 7:
// 1 unless an item takes less time than a box. Fails with CAG_E_LIMIT if there are more than
// CAG_BVH_ITEMS_MAX items.
CagStatus cag_bvh_build(const CagBounds *boxes, size_t n, size_t leaf_items, CagBvh *out,
                        CagError *err);
void cag_bvh_free(CagBvh *b); // also of a zeroed one

// A ray prepared for the traversal: relative to the point at which it enters the bounds.
typedef struct CagBvhRay {
  float origin[3], inverse[3]; // of the direction; large where the direction is 0
  double start;                // the ray's parameter at the prepared origin
  float least, most;           // range of parameters relative to `start`
  bool down[3];                // whether the direction is negative
} CagBvhRay;

// Prepares the part [least, most] of the ray origin + t direction, direction of length 1. Returns
// false if it misses the bounds.
bool cag_bvh_ray(const CagBvh *b, CagVec3 origin, CagVec3 direction, double least, double most,
                 CagBvhRay *out);

#endif
