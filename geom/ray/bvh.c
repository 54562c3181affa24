#include "geom/ray/bvh.h"

#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/stop.h"

// Boxes are enlarged by this fraction of the size of everything: a few times the rounding of the
// box, of the ray's origin, and of the products of the slab test.
#define BOX_PAD 4e-7
// Planes that are compared along each axis.
enum { BINS = 16 };
// Items of a leaf, unless they cannot be told apart.
enum { LEAF_ITEMS = 4 };
// A deeper hierarchy is split into halves, which adds at most 14 levels to it.
enum { DEPTH_BEFORE_HALVES = 44 };
// Ranges of items that threads work on, for each thread; the smallest range that is worth one.
enum { RANGES_PER_THREAD = 8, RANGES_MAX = RANGES_PER_THREAD * CAG_THREADS_MAX, RANGE_MIN = 2048 };

// A box and the number of its item. The fourth number makes it fit wide registers.
typedef struct Ref {
  float low[4], high[4];
  uint32_t item;
  uint32_t unused[3];
} Ref;

typedef struct Box {
  float low[4], high[4];
} Box;

// A range of items, whose nodes are stored from `node` on.
typedef struct Range {
  size_t first, n, node;
  uint32_t *parent; // where the range's root is stored
  int depth;
  size_t used; // number of nodes
} Range;

typedef struct Build {
  Ref *refs;
  CagBvhNode *nodes;
  size_t top; // number of nodes above the ranges
  Range ranges[RANGES_MAX];
  size_t range_count;
} Build;

static Box empty_box(void) {
  Box b;
  for (int k = 0; k < 4; k++) {
    b.low[k] = INFINITY;
    b.high[k] = -INFINITY;
  }
  return b;
}

static void box_join(Box *a, const float low[4], const float high[4]) {
  for (int k = 0; k < 4; k++) {
    a->low[k] = low[k] < a->low[k] ? low[k] : a->low[k];
    a->high[k] = high[k] > a->high[k] ? high[k] : a->high[k];
  }
}

// Half the surface.
static float box_area(const Box *b) {
  const float x = b->high[0] - b->low[0], y = b->high[1] - b->low[1], z = b->high[2] - b->low[2];
  return x >= 0 ? x * y + y * z + z * x : 0;
}

static Box range_box(const Ref *refs, size_t n) {
  Box b = empty_box();
  for (size_t i = 0; i < n; i++) box_join(&b, refs[i].low, refs[i].high);
  return b;
}

// Twice the center.
static void ref_middle(const Ref *r, float out[4]) {
  for (int k = 0; k < 4; k++) out[k] = r->low[k] + r->high[k];
}

// --- Splits ---

// The bins of the centers of a range's items: bin k holds those with floor((c - low) scale) = k.
typedef struct Bins {
  float low[4], scale[4];
  Box box[3][BINS];
  uint32_t count[3][BINS];
} Bins;

static int bin_of(const Bins *b, int axis, float middle) {
  const int k = (int)((middle - b->low[axis]) * b->scale[axis]);
  return k < 0 ? 0 : k >= BINS ? BINS - 1 : k;
}

// Returns false if all centers are equal.
static bool fill_bins(const Ref *refs, size_t n, Bins *b) {
  Box centers = empty_box();
  float m[4];
  for (size_t i = 0; i < n; i++) {
    ref_middle(&refs[i], m);
    box_join(&centers, m, m);
  }
  bool spread = false;
  for (int k = 0; k < 4; k++) {
    const float extent = k < 3 ? centers.high[k] - centers.low[k] : 0;
    b->low[k] = centers.low[k];
    b->scale[k] = extent > 0 ? BINS / extent : 0;
    if (!(b->scale[k] <= 3e38f)) b->scale[k] = 0; // the extent is denormal
    spread = spread || b->scale[k] > 0;
  }
  if (!spread) return false;
  memset(b->count, 0, sizeof b->count);
  for (int axis = 0; axis < 3; axis++)
    for (int k = 0; k < BINS; k++) b->box[axis][k] = empty_box();
  for (size_t i = 0; i < n; i++) {
    ref_middle(&refs[i], m);
    for (int axis = 0; axis < 3; axis++) {
      const int k = bin_of(b, axis, m[axis]);
      b->count[axis][k]++;
      box_join(&b->box[axis][k], refs[i].low, refs[i].high);
    }
  }
  return true;
}

// The plane, below bin *plane of *axis, with the least sum of areas times numbers of items.
static void cheapest_plane(const Bins *b, int *axis, int *plane) {
  float least = INFINITY;
  *axis = -1;
  for (int a = 0; a < 3; a++) {
    if (b->scale[a] == 0) continue;
    float right[BINS];
    Box box = empty_box();
    size_t n = 0;
    for (int k = BINS - 1; k > 0; k--) {
      box_join(&box, b->box[a][k].low, b->box[a][k].high);
      n += b->count[a][k];
      right[k] = n ? box_area(&box) * (float)n : INFINITY;
    }
    box = empty_box();
    n = 0;
    for (int k = 1; k < BINS; k++) {
      box_join(&box, b->box[a][k - 1].low, b->box[a][k - 1].high);
      n += b->count[a][k - 1];
      const float cost = n ? box_area(&box) * (float)n + right[k] : INFINITY;
      if (!(cost < least)) continue;
      least = cost;
      *axis = a;
      *plane = k;
    }
  }
}

// Moves the items below the plane to the front, and returns their number.
static size_t move_below(Ref *refs, size_t n, const Bins *b, int axis, int plane) {
  size_t i = 0, j = n;
  while (i < j) {
    const float middle = refs[i].low[axis] + refs[i].high[axis];
    if (bin_of(b, axis, middle) < plane) {
      i++;
      continue;
    }
    const Ref last = refs[--j];
    refs[j] = refs[i];
    refs[i] = last;
  }
  return i;
}

// Splits a range of at least two items in two. Returns the number of items of the first part.
static size_t split_range(Ref *refs, size_t n, int depth) {
  Bins b;
  int axis, plane = 0;
  if (depth >= DEPTH_BEFORE_HALVES || !fill_bins(refs, n, &b)) return n / 2;
  cheapest_plane(&b, &axis, &plane);
  const size_t below = axis >= 0 ? move_below(refs, n, &b, axis, plane) : 0;
  return below > 0 && below < n ? below : n / 2;
}

// --- Nodes ---

static uint32_t leaf_of(size_t first, size_t n) {
  return CAG_BVH_LEAF | (uint32_t)(n - 1) << CAG_BVH_COUNT_SHIFT | (uint32_t)first;
}

static void set_child_box(CagBvhNode *node, int i, const Box *b) {
  for (int k = 0; k < 3; k++) {
    node->low[k][i] = b->low[k];
    node->high[k][i] = b->high[k];
  }
}

// Divides a range in four, always the part with the largest surface times number of items.
static int divide_range(const Build *build, const Range *r, size_t first[CAG_BVH_WIDTH + 1],
                        Box box[CAG_BVH_WIDTH]) {
  int parts = 1;
  first[0] = r->first;
  first[1] = r->first + r->n;
  box[0] = range_box(build->refs + r->first, r->n);
  while (parts < CAG_BVH_WIDTH) {
    int largest = -1;
    float most = -1;
    for (int i = 0; i < parts; i++) {
      const size_t n = first[i + 1] - first[i];
      const float cost = box_area(&box[i]) * (float)n;
      if (n < 2 || !(cost > most)) continue;
      most = cost;
      largest = i;
    }
    if (largest < 0) break;
    const size_t from = first[largest], n = first[largest + 1] - from;
    const size_t below = split_range(build->refs + from, n, r->depth);
    for (int i = parts; i > largest; i--) {
      first[i + 1] = first[i];
      box[i] = box[i - 1];
    }
    first[largest + 1] = from + below;
    box[largest] = range_box(build->refs + from, below);
    box[largest + 1] = range_box(build->refs + from + below, n - below);
    parts++;
  }
  return parts;
}

static void make_node(const Build *build, const Range *r, CagBvhNode *node, Range parts[],
                      int *part_count) {
  size_t first[CAG_BVH_WIDTH + 1];
  Box box[CAG_BVH_WIDTH];
  const Box none = empty_box();
  *part_count = divide_range(build, r, first, box);
  for (int i = 0; i < CAG_BVH_WIDTH; i++) {
    set_child_box(node, i, i < *part_count ? &box[i] : &none);
    node->child[i] = CAG_BVH_LEAF;
    node->unused[i] = 0;
    if (i < *part_count)
      parts[i] = (Range){.first = first[i],
                         .n = first[i + 1] - first[i],
                         .parent = &node->child[i],
                         .depth = r->depth + 1};
  }
}

// Stores the nodes of a range from r->node on. Each has four children, so a range of n items has
// fewer than n / 3.
static void build_range(Build *build, Range *r) {
  if (r->n <= LEAF_ITEMS || cag_stopped()) {
    *r->parent = leaf_of(r->first, r->n <= CAG_BVH_LEAF_MAX ? r->n : 1);
    return;
  }
  Range parts[CAG_BVH_WIDTH];
  int n;
  const size_t at = r->node;
  *r->parent = (uint32_t)at;
  make_node(build, r, &build->nodes[at], parts, &n);
  r->used = 1;
  for (int i = 0; i < n; i++) {
    parts[i].node = at + r->used;
    build_range(build, &parts[i]);
    r->used += parts[i].used;
  }
}

static void build_numbered_range(void *context, size_t i, int thread) {
  (void)thread;
  Build *build = context;
  build_range(build, &build->ranges[i]);
}

// Divides the largest range until each thread has several to work on.
static void divide_work(Build *build) {
  const size_t wanted = (size_t)(RANGES_PER_THREAD * cag_thread_count());
  while (build->range_count + CAG_BVH_WIDTH <= wanted && !cag_stopped()) {
    size_t largest = 0;
    for (size_t i = 1; i < build->range_count; i++)
      if (build->ranges[i].n > build->ranges[largest].n) largest = i;
    const Range r = build->ranges[largest];
    if (r.n < RANGE_MIN) return;
    Range parts[CAG_BVH_WIDTH];
    int n;
    *r.parent = (uint32_t)build->top;
    make_node(build, &r, &build->nodes[build->top++], parts, &n);
    build->ranges[largest] = parts[0];
    for (int i = 1; i < n; i++) build->ranges[build->range_count++] = parts[i];
  }
}

// Moves the nodes of all ranges next to each other. Returns their number.
static size_t close_gaps(Build *build) {
  size_t used = build->top;
  for (size_t i = 0; i < build->range_count; i++) {
    const Range *r = &build->ranges[i];
    const uint32_t shift = (uint32_t)(r->node - used);
    if (!(*r->parent & CAG_BVH_LEAF)) *r->parent -= shift;
    memmove(build->nodes + used, build->nodes + r->node, r->used * sizeof *build->nodes);
    for (size_t k = used; k < used + r->used; k++)
      for (int c = 0; c < CAG_BVH_WIDTH; c++)
        if (!(build->nodes[k].child[c] & CAG_BVH_LEAF)) build->nodes[k].child[c] -= shift;
    used += r->used;
  }
  return used;
}

// --- Hierarchies ---

static float rounded_down(double x) {
  const float f = (float)x;
  return (double)f > x ? nextafterf(f, -INFINITY) : f;
}
static float rounded_up(double x) {
  const float f = (float)x;
  return (double)f < x ? nextafterf(f, INFINITY) : f;
}

static void make_refs(const CagBounds *boxes, size_t n, const CagBvh *b, Ref *refs) {
  const double pad = BOX_PAD * b->radius;
  for (size_t i = 0; i < n; i++) {
    const CagVec3 low = cag_sub(boxes[i].min, b->origin), high = cag_sub(boxes[i].max, b->origin);
    refs[i] =
        (Ref){{rounded_down(low.x - pad), rounded_down(low.y - pad), rounded_down(low.z - pad), 0},
              {rounded_up(high.x + pad), rounded_up(high.y + pad), rounded_up(high.z + pad), 0},
              (uint32_t)i,
              {0}};
  }
}

// Builds the nodes of all items. Room: those above the ranges, and a third of the items.
static CagStatus build_nodes(Build *build, CagBvh *b, CagError *err) {
  const size_t n = b->item_count, room = RANGES_MAX + n / 3 + RANGES_MAX;
  build->nodes = cag_malloc(room * sizeof *build->nodes);
  if (!build->nodes) return cag_fail_memory(err);
  build->ranges[0] = (Range){.n = n, .parent = &b->root};
  build->range_count = 1;
  divide_work(build);
  size_t at = build->top;
  for (size_t i = 0; i < build->range_count; i++) {
    build->ranges[i].node = at;
    at += build->ranges[i].n / 3 + 1;
  }
  cag_parallel(build->range_count, build_numbered_range, build);
  b->node_count = close_gaps(build);
  CagBvhNode *fitted = cag_realloc(build->nodes, (b->node_count + 1) * sizeof *fitted);
  b->nodes = fitted ? fitted : build->nodes;
  return cag_stop_check(err);
}

CagStatus cag_bvh_build(const CagBounds *boxes, size_t n, CagBvh *out, CagError *err) {
  *out = (CagBvh){.bounds = CAG_BOUNDS_EMPTY};
  if (n > CAG_BVH_ITEMS_MAX)
    return cag_fail(err, CAG_E_LIMIT, CAG_ERR_mesh_too_large, "", -1,
                    "more than %zu triangles cannot be searched", CAG_BVH_ITEMS_MAX);
  if (n == 0) return CAG_OK;
  for (size_t i = 0; i < n; i++) {
    cag_bounds_add(&out->bounds, boxes[i].min);
    cag_bounds_add(&out->bounds, boxes[i].max);
  }
  out->origin = cag_lerp(out->bounds.min, out->bounds.max, 0.5);
  out->radius = cag_norm(cag_sub(out->bounds.max, out->bounds.min)) / 2;
  out->item_count = n;
  Build *build = cag_calloc(1, sizeof *build);
  if (build) build->refs = cag_malloc(n * sizeof *build->refs);
  out->order = cag_malloc(n * sizeof *out->order);
  CagStatus status = build && build->refs && out->order ? CAG_OK : cag_fail_memory(err);
  if (!status) {
    make_refs(boxes, n, out, build->refs);
    status = build_nodes(build, out, err);
    for (size_t i = 0; i < n; i++) out->order[i] = build->refs[i].item;
  }
  if (build) cag_free(build->refs);
  cag_free(build);
  if (status) cag_bvh_free(out);
  return status;
}

void cag_bvh_free(CagBvh *b) {
  cag_free(b->nodes);
  cag_free(b->order);
  *b = (CagBvh){.bounds = CAG_BOUNDS_EMPTY};
}

// --- Rays ---

// Stands for the inverse of a direction's component that is 0, or nearly: products stay finite.
#define INVERSE_MAX 1e30

// Reduces the range of parameters to the part within the bounds along one axis.
static bool clip_axis(double origin, double direction, double low, double high, double pad,
                      double *least, double *most) {
  if (fabs(direction) * INVERSE_MAX < 1) return origin >= low - pad && origin <= high + pad;
  double in = (low - pad - origin) / direction, out = (high + pad - origin) / direction;
  if (in > out) {
    const double swap = in;
    in = out;
    out = swap;
  }
  *least = in > *least ? in : *least;
  *most = out < *most ? out : *most;
  return *least <= *most;
}

bool cag_bvh_ray(const CagBvh *b, CagVec3 origin, CagVec3 direction, double least, double most,
                 CagBvhRay *out) {
  const double pad = BOX_PAD * b->radius;
  const double d[3] = {direction.x, direction.y, direction.z};
  const double o[3] = {origin.x, origin.y, origin.z};
  const double low[3] = {b->bounds.min.x, b->bounds.min.y, b->bounds.min.z};
  const double high[3] = {b->bounds.max.x, b->bounds.max.y, b->bounds.max.z};
  double from = least, to = most;
  if (b->item_count == 0) return false;
  for (int k = 0; k < 3; k++)
    if (!clip_axis(o[k], d[k], low[k], high[k], pad, &from, &to)) return false;
  const CagVec3 start = cag_sub(cag_madd(origin, from, direction), b->origin);
  out->start = from;
  out->origin[0] = (float)start.x;
  out->origin[1] = (float)start.y;
  out->origin[2] = (float)start.z;
  for (int k = 0; k < 3; k++)
    out->inverse[k] =
        (float)(fabs(d[k]) * INVERSE_MAX < 1 ? copysign(INVERSE_MAX, d[k]) : 1 / d[k]);
  out->least = (float)(-pad);
  out->most = (float)(to - from + pad);
  return true;
}
