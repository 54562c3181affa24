// Trees of bounding boxes: built bottom up from sorted items, walked recursively.

#include "geom/mesh/box_tree.h"

#include "base/memory.h"
#include "base/stop.h"

#define LEAF_ITEMS 4

typedef struct CagBoxNode {
  CagBounds box;
  uint32_t first, count; // of `order`
  uint32_t right;        // the left child follows its parent; 0: a leaf
} CagBoxNode;

// For numbers other than NaN; fmin and fmax are slower.
static double least(double a, double b) { return a < b ? a : b; }
static double most(double a, double b) { return a > b ? a : b; }

static void join_box(CagBounds *all, const CagBounds *b) {
  all->min = cag_vec3(least(all->min.x, b->min.x), least(all->min.y, b->min.y),
                      least(all->min.z, b->min.z));
  all->max =
      cag_vec3(most(all->max.x, b->max.x), most(all->max.y, b->max.y), most(all->max.z, b->max.z));
}

// --- Order along the curve ---

typedef struct Place {
  uint64_t code;
  uint32_t item;
} Place;

// Moves each bit to every third position.
static uint64_t spread(uint64_t x) {
  x = (x | x << 32) & 0x1f00000000ffffu;
  x = (x | x << 16) & 0x1f0000ff0000ffu;
  x = (x | x << 8) & 0x100f00f00f00f00fu;
  x = (x | x << 4) & 0x10c30c30c30c30c3u;
  return (x | x << 2) & 0x1249249249249249u;
}

static uint64_t grid_step(double x, double low, double high) {
  const double steps = 2097151; // 21 bits
  return high > low ? (uint64_t)((x - low) / (high - low) * steps) : 0;
}

// A stable sort by code; needs n more items of scratch space after p.
static void sort_places(Place *p, size_t n) {
  // 66 bits: an even number of passes, so that the result ends up in p.
  enum { BITS = 11, DIGITS = 6 };
  // Before each pass p holds a permutation, which remains if the work is canceled.
  for (int digit = 0; digit < DIGITS && !cag_stopped(); digit++) {
    size_t start[(1 << BITS) + 1] = {0};
    Place *from = digit % 2 ? p + n : p, *to = digit % 2 ? p : p + n;
    const uint64_t mask = (1 << BITS) - 1;
    for (size_t i = 0; i < n; i++) start[(from[i].code >> (BITS * digit) & mask) + 1]++;
    for (int k = 0; k < 1 << BITS; k++) start[k + 1] += start[k];
    for (size_t i = 0; i < n; i++) to[start[from[i].code >> (BITS * digit) & mask]++] = from[i];
  }
}

static bool sort_items(CagBoxTree *t, const CagBounds *boxes, size_t n) {
  Place *places = cag_malloc((2 * n + 1) * sizeof *places);
  if (!places) return false;
  CagBounds all = CAG_BOUNDS_EMPTY;
  for (size_t i = 0; i < n; i++) join_box(&all, &boxes[i]);
  for (size_t i = 0; i < n; i++) {
    const CagVec3 c = cag_lerp(boxes[i].min, boxes[i].max, 0.5);
    places[i].item = (uint32_t)i;
    places[i].code = spread(grid_step(c.x, all.min.x, all.max.x)) |
                     spread(grid_step(c.y, all.min.y, all.max.y)) << 1 |
                     spread(grid_step(c.z, all.min.z, all.max.z)) << 2;
  }
  sort_places(places, n);
  for (size_t i = 0; i < n; i++) {
    t->order[i] = places[i].item;
    t->boxes[i] = boxes[places[i].item];
  }
  cag_free(places);
  return true;
}

// --- The tree ---

static uint32_t build_node(CagBoxTree *t, uint32_t first, uint32_t count, uint32_t *used) {
  const uint32_t at = (*used)++;
  CagBoxNode *node = &t->nodes[at];
  *node = (CagBoxNode){CAG_BOUNDS_EMPTY, first, count, 0};
  if (count <= LEAF_ITEMS) {
    for (uint32_t i = 0; i < count; i++) join_box(&node->box, &t->boxes[first + i]);
    return at;
  }
  const uint32_t half = count / 2, left = build_node(t, first, half, used);
  node->right = build_node(t, first + half, count - half, used);
  join_box(&node->box, &t->nodes[left].box);
  join_box(&node->box, &t->nodes[node->right].box);
  return at;
}

CagStatus cag_box_tree_new(const CagBounds *boxes, size_t n, CagBoxTree *out, CagError *err) {
  *out = (CagBoxTree){cag_malloc((2 * n + 1) * sizeof *out->nodes),
                      cag_malloc((n + 1) * sizeof *out->order),
                      cag_malloc((n + 1) * sizeof *out->boxes)};
  if (!out->nodes || !out->order || !out->boxes || !sort_items(out, boxes, n)) {
    cag_box_tree_free(out);
    return cag_fail_memory(err);
  }
  uint32_t used = 0;
  build_node(out, 0, (uint32_t)n, &used);
  return CAG_OK;
}

void cag_box_tree_free(CagBoxTree *t) {
  cag_free(t->nodes);
  cag_free(t->order);
  cag_free(t->boxes);
  *t = (CagBoxTree){0};
}

// --- Pairs ---

typedef struct PairWalk {
  const CagBoxTree *tree;
  CagBoxPairVisit *visit;
  void *context;
  CagStatus status;
} PairWalk;

static void pair_leaves(PairWalk *w, const CagBoxNode *a, const CagBoxNode *b) {
  const CagBoxTree *t = w->tree;
  for (uint32_t i = 0; i < a->count; i++) {
    const CagBounds *box = &t->boxes[a->first + i];
    if (a != b && !cag_bounds_meet(box, &b->box)) continue;
    for (uint32_t k = a == b ? i + 1 : 0; k < b->count && !w->status; k++)
      if (cag_bounds_meet(box, &t->boxes[b->first + k]))
        w->status = w->visit(w->context, t->order[a->first + i], t->order[b->first + k]);
  }
}

static void pair_nodes(PairWalk *w, uint32_t i, uint32_t k) {
  const CagBoxNode *a = &w->tree->nodes[i], *b = &w->tree->nodes[k];
  if (w->status || !cag_bounds_meet(&a->box, &b->box)) return;
  if (!a->right && !b->right) pair_leaves(w, a, b);
  else if (a->count >= b->count) {
    pair_nodes(w, i + 1, k);
    pair_nodes(w, a->right, k);
  } else {
    pair_nodes(w, i, k + 1);
    pair_nodes(w, i, b->right);
  }
}

static void pair_within(PairWalk *w, uint32_t i) {
  const CagBoxNode *a = &w->tree->nodes[i];
  if (w->status) return;
  if (!a->right) {
    pair_leaves(w, a, a);
    return;
  }
  pair_within(w, i + 1);
  pair_within(w, a->right);
  pair_nodes(w, i + 1, a->right);
}

CagStatus cag_box_tree_pairs(const CagBoxTree *t, CagBoxPairVisit *visit, void *context) {
  PairWalk w = {t, visit, context, CAG_OK};
  pair_within(&w, 0);
  return w.status;
}

// --- Items that meet a box ---

static bool visit_meeting(const CagBoxTree *t, uint32_t at, const CagBounds *box,
                          CagBoxVisit *visit, void *context) {
  const CagBoxNode *node = &t->nodes[at];
  if (!cag_bounds_meet(&node->box, box)) return true;
  if (node->right)
    return visit_meeting(t, at + 1, box, visit, context) &&
           visit_meeting(t, node->right, box, visit, context);
  for (uint32_t i = node->first; i < node->first + node->count; i++)
    if (cag_bounds_meet(&t->boxes[i], box) && !visit(context, t->order[i])) return false;
  return true;
}

bool cag_box_tree_meeting(const CagBoxTree *t, const CagBounds *box, CagBoxVisit *visit,
                          void *context) {
  return visit_meeting(t, 0, box, visit, context);
}
