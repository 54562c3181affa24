// A tree of bounding boxes over numbered items, such as the triangles of a mesh: which of them meet,
// and which meet a given box.
//
// The items are sorted along a space-filling curve by the centers of their boxes, and halved (Morton
// 1966). Such a tree is built in linear time, and good enough where it is walked once or twice.

#ifndef CAG_GEOM_MESH_BOX_TREE_H
#define CAG_GEOM_MESH_BOX_TREE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/status.h"
#include "geom/linalg/vec.h"

typedef struct CagBoxTree {
  struct CagBoxNode *nodes; // NULL: not built
  uint32_t *order;          // the items, in the order of the leaves
  CagBounds *boxes;         // in that order
} CagBoxTree;

static inline bool cag_bounds_meet(const CagBounds *a, const CagBounds *b) {
  return a->min.x <= b->max.x && b->min.x <= a->max.x && a->min.y <= b->max.y &&
         b->min.y <= a->max.y && a->min.z <= b->max.z && b->min.z <= a->max.z;
}

// The tree of n boxes, fewer than 2^31, without NaN.
CagStatus cag_box_tree_new(const CagBounds *boxes, size_t n, CagBoxTree *out, CagError *err);
// The tree is not built then.
void cag_box_tree_free(CagBoxTree *t);

// Calls `visit` for each pair of items whose boxes meet or touch, until it fails.
typedef CagStatus CagBoxPairVisit(void *context, uint32_t a, uint32_t b);
CagStatus cag_box_tree_pairs(const CagBoxTree *t, CagBoxPairVisit *visit, void *context);

// Calls `visit` for the items whose boxes meet or touch a box, which may be infinite, until it
// returns false. Returns whether it never did.
typedef bool CagBoxVisit(void *context, uint32_t item);
bool cag_box_tree_meeting(const CagBoxTree *t, const CagBounds *box, CagBoxVisit *visit,
                          void *context);

#endif
