// Walks through a hierarchy of boxes: along a ray, and around a point.

#ifndef CAG_GEOM_RAY_BVH_WALK_H
#define CAG_GEOM_RAY_BVH_WALK_H

#include "geom/basis/wide.h"
#include "geom/ray/bvh.h"

// The children that are still to be visited, and the parameters at which the ray enters them, or
// the squares of their distances. A node leaves at most three of its children here, and the
// hierarchy is at most 60 nodes deep.
#define CAG_BVH_STACK 192
typedef struct CagBvhWalk {
  uint32_t child[CAG_BVH_STACK];
  float key[CAG_BVH_STACK];
  int n;
} CagBvhWalk;

INLINE void cag_bvh_start(const CagBvh *b, CagBvhWalk *w) {
  w->n = b->item_count > 0;
  w->child[0] = b->root;
  w->key[0] = -INFINITY;
}

// Pushes the children whose key is at most `most`, so that the one with the least key is on top.
INLINE void cag_bvh_push(const CagBvhNode *node, const float *key, const float *most,
                         CagBvhWalk *w) {
  const int from = w->n;
  for (int i = 0; i < CAG_BVH_WIDTH; i++) {
    if (!(key[i] <= most[i])) continue;
    int at = w->n++;
    for (; at > from && w->key[at - 1] < key[i]; at--) {
      w->key[at] = w->key[at - 1];
      w->child[at] = w->child[at - 1];
    }
    w->key[at] = key[i];
    w->child[at] = node->child[i];
  }
}

INLINE void cag_bvh_leaf(uint32_t child, size_t *first, size_t *count) {
  *first = child & CAG_BVH_FIRST_MASK;
  *count = ((child & ~CAG_BVH_LEAF) >> CAG_BVH_COUNT_SHIFT) + 1;
}

// Finds the next leaf along the ray, near ones first, as a range of `order`. Returns false at the
// end. `ray->most` may be reduced between calls.
INLINE bool cag_bvh_next(const CagBvh *b, const CagBvhRay *ray, CagBvhWalk *w, size_t *first,
                         size_t *count) {
  while (w->n > 0) {
    w->n--;
    const uint32_t child = w->child[w->n];
    if (w->key[w->n] > ray->most) continue;
    if (child & CAG_BVH_LEAF) {
      cag_bvh_leaf(child, first, count);
      return true;
    }
    const CagBvhNode *node = &b->nodes[child];
    float enter[CAG_BVH_WIDTH], leave[CAG_BVH_WIDTH];
    for (int i = 0; i < CAG_BVH_WIDTH; i++) {
      enter[i] = ray->least;
      leave[i] = ray->most;
    }
    for (int k = 0; k < 3; k++) {
      const float o = ray->origin[k], inverse = ray->inverse[k];
      const float *near = inverse >= 0 ? node->low[k] : node->high[k];
      const float *far = inverse >= 0 ? node->high[k] : node->low[k];
      for (int i = 0; i < CAG_BVH_WIDTH; i++) {
        const float in = (near[i] - o) * inverse, out = (far[i] - o) * inverse;
        enter[i] = in > enter[i] ? in : enter[i];
        leave[i] = out < leave[i] ? out : leave[i];
      }
    }
    cag_bvh_push(node, enter, leave, w);
  }
  return false;
}

// The rounding of distances from boxes in floats, as a fraction of the distance of the point from
// the origin plus the radius of the hierarchy.
#define CAG_BVH_SLACK 1e-6

// Finds the next leaf whose box is at most the square root of most2 away from the point, near ones
// first. The point is relative to the origin of the hierarchy.
INLINE bool cag_bvh_near(const CagBvh *b, const float p[3], double most2, CagBvhWalk *w,
                         size_t *first, size_t *count) {
  // The largest float that is not less.
  const float limit = most2 < 3e38 ? nextafterf((float)most2, INFINITY) : INFINITY;
  const float most[CAG_BVH_WIDTH] = {limit, limit, limit, limit};
  while (w->n > 0) {
    w->n--;
    const uint32_t child = w->child[w->n];
    if (w->key[w->n] > limit) continue;
    if (child & CAG_BVH_LEAF) {
      cag_bvh_leaf(child, first, count);
      return true;
    }
    const CagBvhNode *node = &b->nodes[child];
    float square[CAG_BVH_WIDTH] = {0};
    for (int k = 0; k < 3; k++)
      for (int i = 0; i < CAG_BVH_WIDTH; i++) {
        const float below = node->low[k][i] - p[k], above = p[k] - node->high[k][i];
        const float off = below > above ? below : above;
        square[i] += off > 0 ? off * off : 0;
      }
    cag_bvh_push(node, square, most, w);
  }
  return false;
}

#endif
