// Walks through a hierarchy of boxes: along a ray, and around a point.

#ifndef CAG_GEOM_RAY_BVH_WALK_H
#define CAG_GEOM_RAY_BVH_WALK_H

#include <stdint.h>

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

// Four floats, in one register where the compiler has vectors.
#if defined(__GNUC__)
typedef float CagFloat4 __attribute__((vector_size(16)));
typedef int32_t CagMask4 __attribute__((vector_size(16)));
typedef union CagLanes {
  CagFloat4 v;
  float f[CAG_BVH_WIDTH];
} CagLanes;
INLINE CagFloat4 cag_load4(const float *p) { return *(const CagFloat4 *)p; }
INLINE CagFloat4 cag_all4(float x) { return (CagFloat4){x, x, x, x}; }
INLINE CagFloat4 cag_select4(CagMask4 mask, CagFloat4 a, CagFloat4 b) {
  return (CagFloat4)(((CagMask4)a & mask) | ((CagMask4)b & ~mask));
}
INLINE CagFloat4 cag_larger4(CagFloat4 a, CagFloat4 b) { return cag_select4(a > b, a, b); }
INLINE CagFloat4 cag_smaller4(CagFloat4 a, CagFloat4 b) { return cag_select4(a < b, a, b); }
#define CAG_PLUS4(a, b) ((a) + (b))
#define CAG_MINUS4(a, b) ((a) - (b))
#define CAG_TIMES4(a, b) ((a) * (b))
#else
typedef struct CagFloat4 {
  float f[CAG_BVH_WIDTH];
} CagFloat4;
typedef union CagLanes {
  CagFloat4 v;
  float f[CAG_BVH_WIDTH];
} CagLanes;
INLINE CagFloat4 cag_load4(const float *p) { return (CagFloat4){{p[0], p[1], p[2], p[3]}}; }
INLINE CagFloat4 cag_all4(float x) { return (CagFloat4){{x, x, x, x}}; }
#define CAG_LANEWISE(name, expression)                                                             \
  INLINE CagFloat4 name(CagFloat4 a, CagFloat4 b) {                                                \
    CagFloat4 r;                                                                                   \
    for (int i = 0; i < CAG_BVH_WIDTH; i++) r.f[i] = (expression);                                 \
    return r;                                                                                      \
  }
CAG_LANEWISE(cag_larger4, a.f[i] > b.f[i] ? a.f[i] : b.f[i])
CAG_LANEWISE(cag_smaller4, a.f[i] < b.f[i] ? a.f[i] : b.f[i])
CAG_LANEWISE(CAG_PLUS4, a.f[i] + b.f[i])
CAG_LANEWISE(CAG_MINUS4, a.f[i] - b.f[i])
CAG_LANEWISE(CAG_TIMES4, a.f[i] * b.f[i])
#endif

// The lanes in which a <= b, as bits.
INLINE unsigned cag_no_larger4(CagFloat4 a, CagFloat4 b) {
#if defined(__SSE__) && defined(__GNUC__)
  return (unsigned)__builtin_ia32_movmskps((CagFloat4)(a <= b));
#else
  const CagLanes x = {.v = a}, y = {.v = b};
  unsigned bits = 0;
  for (int i = 0; i < CAG_BVH_WIDTH; i++) bits |= (unsigned)(x.f[i] <= y.f[i]) << i;
  return bits;
#endif
}

INLINE int cag_lowest_bit(unsigned bits) {
#if defined(__GNUC__)
  return __builtin_ctz(bits);
#else
  int i = 0;
  while (!(bits >> i & 1)) i++;
  return i;
#endif
}

// Starts to bring a child into the cache.
INLINE void cag_bvh_fetch(const CagBvh *b, uint32_t child) {
#if defined(__GNUC__)
  if (child & CAG_BVH_LEAF && !b->items) return;
  const char *at = child & CAG_BVH_LEAF
                       ? (const char *)b->items + (child & CAG_BVH_FIRST_MASK) * b->item_size
                       : (const char *)&b->nodes[child];
  __builtin_prefetch(at);
  __builtin_prefetch(at + 64);
#endif
}

// Pushes the children whose key is at most `most`, so that the one with the least key is on top.
INLINE void cag_bvh_push(const CagBvh *b, const CagBvhNode *node, const CagLanes *key,
                         const CagLanes *most, CagBvhWalk *w) {
  const int from = w->n;
  for (unsigned lanes = cag_no_larger4(key->v, most->v); lanes; lanes &= lanes - 1) {
    const int i = cag_lowest_bit(lanes);
    const float k = key->f[i];
    int at = w->n++;
    for (; at > from && w->key[at - 1] < k; at--) {
      w->key[at] = w->key[at - 1];
      w->child[at] = w->child[at - 1];
    }
    w->key[at] = k;
    w->child[at] = node->child[i];
    cag_bvh_fetch(b, node->child[i]);
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
    CagLanes enter = {.v = cag_all4(ray->least)}, leave = {.v = cag_all4(ray->most)};
    for (int k = 0; k < 3; k++) {
      const CagFloat4 o = cag_all4(ray->origin[k]), inverse = cag_all4(ray->inverse[k]);
      const bool up = ray->inverse[k] >= 0;
      const CagFloat4 near = cag_load4(up ? node->low[k] : node->high[k]);
      const CagFloat4 far = cag_load4(up ? node->high[k] : node->low[k]);
      enter.v = cag_larger4(CAG_TIMES4(CAG_MINUS4(near, o), inverse), enter.v);
      leave.v = cag_smaller4(CAG_TIMES4(CAG_MINUS4(far, o), inverse), leave.v);
    }
    cag_bvh_push(b, node, &enter, &leave, w);
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
  const CagLanes most = {.v = cag_all4(limit)};
  while (w->n > 0) {
    w->n--;
    const uint32_t child = w->child[w->n];
    if (w->key[w->n] > limit) continue;
    if (child & CAG_BVH_LEAF) {
      cag_bvh_leaf(child, first, count);
      return true;
    }
    const CagBvhNode *node = &b->nodes[child];
    CagLanes square = {.v = cag_all4(0)};
    for (int k = 0; k < 3; k++) {
      const CagFloat4 at = cag_all4(p[k]);
      const CagFloat4 below = CAG_MINUS4(cag_load4(node->low[k]), at);
      const CagFloat4 above = CAG_MINUS4(at, cag_load4(node->high[k]));
      const CagFloat4 off = cag_larger4(cag_larger4(below, above), cag_all4(0));
      square.v = CAG_PLUS4(square.v, CAG_TIMES4(off, off));
    }
    cag_bvh_push(b, node, &square, &most, w);
  }
  return false;
}

#endif
