// Walks through a hierarchy of boxes: along a ray, and around a point.

#ifndef CAG_GEOM_RAY_BVH_WALK_H
#define CAG_GEOM_RAY_BVH_WALK_H

#include <stdint.h>

#include "geom/ray/bvh.h"
#include "geom/ray/bvh_lanes.h"

// A child that is still to be visited, and the parameter at which the ray enters it, or the square
// of its distance.
typedef struct CagBvhEntry {
  float key;
  uint32_t child;
} CagBvhEntry;

// A node leaves at most seven of its children here, and the hierarchy is at most 56 nodes deep.
#define CAG_BVH_STACK 400
typedef struct CagBvhWalk {
  CagBvhEntry entry[CAG_BVH_STACK];
  int n;
} CagBvhWalk;

INLINE void cag_bvh_start(const CagBvh *b, CagBvhWalk *w) {
  w->n = b->item_count > 0;
  w->entry[0] = (CagBvhEntry){-INFINITY, b->root};
}

INLINE void cag_bvh_leaf(uint32_t child, size_t *first, size_t *count) {
  *first = child & CAG_BVH_FIRST_MASK;
  *count = ((child & ~CAG_BVH_LEAF) >> CAG_BVH_COUNT_SHIFT) + 1;
}

// Starts to bring a child into the cache.
INLINE void cag_bvh_fetch(const CagBvh *b, uint32_t child) {
  size_t first, count;
  if (!(child & CAG_BVH_LEAF)) {
    cag_fetch(&b->nodes[child], sizeof *b->nodes);
    return;
  }
  cag_bvh_leaf(child, &first, &count);
  if (b->items) cag_fetch((const char *)b->items + first * b->item_size, count * b->item_size);
}

// Adds the child of a lane to the entries from `from` on, which are in descending order of keys.
INLINE void cag_bvh_insert(const CagBvhNode *node, const float *key, int lane, CagBvhEntry *from,
                           int n) {
  const CagBvhEntry added = {key[lane], node->child[lane]};
  int at = n;
  for (; at > 0 && from[at - 1].key < added.key; at--) from[at] = from[at - 1];
  from[at] = added;
}

// Pushes the children of these lanes, of which there is at least one, except for the one with the
// least key, which it returns.
INLINE uint32_t cag_bvh_push(const CagBvh *b, const CagBvhNode *node, const float *key,
                             unsigned lanes, CagBvhWalk *w) {
  const int first = cag_lowest_bit(lanes);
  cag_bvh_fetch(b, node->child[first]);
  lanes &= lanes - 1;
  if (!lanes) return node->child[first];
  CagBvhEntry *from = w->entry + w->n;
  from[0] = (CagBvhEntry){key[first], node->child[first]};
  int n = 1;
  for (; lanes; lanes &= lanes - 1) {
    const int lane = cag_lowest_bit(lanes);
    cag_bvh_fetch(b, node->child[lane]);
    cag_bvh_insert(node, key, lane, from, n++);
  }
  w->n += n - 1;
  return from[n - 1].child;
}

// Takes the next child whose key is at most `most`. Returns false at the end.
INLINE bool cag_bvh_pop(CagBvhWalk *w, float most, uint32_t *child) {
  while (w->n > 0) {
    const CagBvhEntry top = w->entry[--w->n];
    *child = top.child;
    if (top.key <= most) return true;
  }
  return false;
}

// The lanes of a node's children.
INLINE unsigned cag_bvh_lanes(const CagBvhNode *node) { return (1u << node->count) - 1; }

// The children that the ray meets, as bits, and the parameters at which it enters them.
INLINE unsigned cag_bvh_meet(const CagBvhNode *node, const CagBvhRay *ray, float *enter) {
  CagFloat8 in = cag_all8(ray->least), out = cag_all8(ray->most);
  for (int k = 0; k < 3; k++) {
    // The parameter of the plane with byte q is scale q + offset. Where that is not a number, since
    // the hierarchy is extremely large, the box is not ruled out by it.
    const CagFloat8 scale = cag_all8(cag_bvh_step(node->exponent[k]) * ray->inverse[k]);
    const CagFloat8 offset = cag_all8((node->base[k] - ray->origin[k]) * ray->inverse[k]);
    const CagFloat8 near = cag_bytes8(node->planes[ray->down[k]][k]);
    const CagFloat8 far = cag_bytes8(node->planes[!ray->down[k]][k]);
    in = cag_larger8(cag_add_product8(near, scale, offset), in);
    out = cag_smaller8(cag_add_product8(far, scale, offset), out);
  }
  cag_store8(enter, in);
  return cag_no_larger8(in, out) & cag_bvh_lanes(node);
}

// Finds the next leaf along the ray, near ones first, as a range of `order`. Returns false at the
// end. `ray->most` may be reduced between calls.
INLINE bool cag_bvh_next(const CagBvh *b, const CagBvhRay *ray, CagBvhWalk *w, size_t *first,
                         size_t *count) {
  float enter[CAG_BVH_WIDTH];
  uint32_t child;
  if (!cag_bvh_pop(w, ray->most, &child)) return false;
  while (!(child & CAG_BVH_LEAF)) {
    const CagBvhNode *node = &b->nodes[child];
    const unsigned met = cag_bvh_meet(node, ray, enter);
    if (met) child = cag_bvh_push(b, node, enter, met, w);
    else if (!cag_bvh_pop(w, ray->most, &child)) return false;
  }
  cag_bvh_leaf(child, first, count);
  return true;
}

// The rounding of distances from boxes in floats, as a fraction of the distance of the point from
// the origin plus the radius of the hierarchy.
#define CAG_BVH_SLACK 1e-6

// The squares of the distances of a point from the boxes of a node's children.
INLINE void cag_bvh_squares(const CagBvhNode *node, const float p[3], CagFloat8 *out) {
  *out = cag_all8(0);
  for (int k = 0; k < 3; k++) {
    const CagFloat8 step = cag_all8(cag_bvh_step(node->exponent[k]));
    const CagFloat8 base = cag_all8(node->base[k]), at = cag_all8(p[k]);
    const CagFloat8 low = cag_add_product8(cag_bytes8(node->planes[0][k]), step, base);
    const CagFloat8 high = cag_add_product8(cag_bytes8(node->planes[1][k]), step, base);
    const CagFloat8 off =
        cag_larger8(cag_larger8(cag_minus8(low, at), cag_minus8(at, high)), cag_all8(0));
    *out = cag_add_product8(off, off, *out);
  }
}

// Finds the next leaf whose box is at most the square root of most2 away from the point, near ones
// first. The point is relative to the origin of the hierarchy.
INLINE bool cag_bvh_near(const CagBvh *b, const float p[3], double most2, CagBvhWalk *w,
                         size_t *first, size_t *count) {
  // The largest float that is not less.
  const float limit = most2 < 3e38 ? nextafterf((float)most2, INFINITY) : INFINITY;
  float key[CAG_BVH_WIDTH];
  uint32_t child;
  if (!cag_bvh_pop(w, limit, &child)) return false;
  while (!(child & CAG_BVH_LEAF)) {
    const CagBvhNode *node = &b->nodes[child];
    CagFloat8 squares;
    cag_bvh_squares(node, p, &squares);
    cag_store8(key, squares);
    const unsigned close = cag_no_larger8(squares, cag_all8(limit)) & cag_bvh_lanes(node);
    if (close) child = cag_bvh_push(b, node, key, close, w);
    else if (!cag_bvh_pop(w, limit, &child)) return false;
  }
  cag_bvh_leaf(child, first, count);
  return true;
}

#endif
