#include "geom/ray/bvh.h"

#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/stop.h"

// Boxes are enlarged by this fraction of half the diagonal of everything, R, which exceeds the
// rounding of the slab test. With e = 2^-24, of lengths up to 2 R: the ray's origin is off by e R.
// The difference of base and origin is rounded to 2 e R, its product with the inverse adds 4 e R, as
// that of the step with it, and their sum 2 e R: 13 e R = 7.7e-7 R.
#define BOX_PAD 1e-6
// Planes that are compared along each axis.
enum { BINS = 16 };
// The largest byte of a plane.
enum { PLANES = 255 };
// Of the exponents of floats.
enum { EXPONENT_BIAS = 127 };
// A deeper hierarchy is split into eighths, which adds at most 10 levels to it.
enum { DEPTH_BEFORE_EIGHTHS = 44 };
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
  size_t leaf_items;
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
  if (depth >= DEPTH_BEFORE_EIGHTHS || !fill_bins(refs, n, &b)) return n / 2;
  cheapest_plane(&b, &axis, &plane);
  const size_t below = axis >= 0 ? move_below(refs, n, &b, axis, plane) : 0;
  return below > 0 && below < n ? below : n / 2;
}

// --- Nodes ---

static uint32_t leaf_of(size_t first, size_t n) {
  return CAG_BVH_LEAF | (uint32_t)(n - 1) << CAG_BVH_COUNT_SHIFT | (uint32_t)first;
}

// The exponent of the least power of two with which 255 steps are at least the extent.
static uint8_t exponent_of(double extent) {
  int e = 1;
  if (extent > 0 && isfinite(extent)) (void)frexp(extent / PLANES, &e);
  e = e + EXPONENT_BIAS - 1 < 1 ? 1 : e + EXPONENT_BIAS - 1;
  while (e < 254 && (double)cag_bvh_step((uint8_t)e) * PLANES < extent) e++;
  return (uint8_t)e;
}

static uint8_t plane_of(double plane) {
  return (uint8_t)(plane < PLANES ? plane > 0 ? plane : 0 : PLANES);
}

// Stores the boxes of the children in bytes, rounded outward.
static void set_child_boxes(CagBvhNode *node, const Box *box, int n) {
  Box all = empty_box();
  for (int i = 0; i < n; i++) box_join(&all, box[i].low, box[i].high);
  for (int k = 0; k < 3; k++) {
    const double base = all.low[k];
    node->base[k] = all.low[k];
    node->exponent[k] = exponent_of(all.high[k] - base);
    const double step = cag_bvh_step(node->exponent[k]);
    for (int i = 0; i < n; i++) {
      node->planes[0][k][i] = plane_of(floor((box[i].low[k] - base) / step));
      node->planes[1][k][i] = plane_of(ceil((box[i].high[k] - base) / step));
    }
  }
}

// The largest part of a range that may be divided: by its surface times its number of items, or,
// where the hierarchy is too deep, by its number of items. Returns -1 if there is none.
static int largest_part(const size_t first[], const Box box[], int parts, int depth,
                        size_t leaf_items) {
  int largest = -1;
  float most = -1;
  for (int i = 0; i < parts; i++) {
    const size_t n = first[i + 1] - first[i];
    const float cost = (depth < DEPTH_BEFORE_EIGHTHS ? box_area(&box[i]) : 1) * (float)n;
    if (n <= leaf_items || !(cost > most)) continue;
    most = cost;
    largest = i;
  }
  return largest;
}

// Divides a range in up to eight parts, always the largest one.
static int divide_range(const Build *build, const Range *r, size_t first[CAG_BVH_WIDTH + 1],
                        Box box[CAG_BVH_WIDTH]) {
  int parts = 1;
  first[0] = r->first;
  first[1] = r->first + r->n;
  box[0] = range_box(build->refs + r->first, r->n);
  while (parts < CAG_BVH_WIDTH) {
    const int largest = largest_part(first, box, parts, r->depth, build->leaf_items);
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
  *part_count = divide_range(build, r, first, box);
  memset(node, 0, sizeof *node);
  node->count = (uint8_t)*part_count;
  set_child_boxes(node, box, *part_count);
  for (int i = 0; i < *part_count; i++)
    parts[i] = (Range){.first = first[i],
                       .n = first[i + 1] - first[i],
                       .parent = &node->child[i],
                       .depth = r->depth + 1};
}

// Room for the nodes of n items. Only a node of leaves has fewer than eight children, and it has
// more items than a leaf. For leaves of up to k items, there are thus at most 8/7 n / (k + 1) nodes.
static size_t room_for(const Build *build, size_t n) { return n / build->leaf_items + 1; }

// Stores the nodes of a range from r->node on.
static void build_range(Build *build, Range *r) {
  if (r->n <= build->leaf_items || cag_stopped()) {
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

// Copies the nodes, those of all ranges next to each other, to memory of their own.
static bool close_gaps(Build *build, CagBvh *b) {
  b->node_count = build->top;
  for (size_t i = 0; i < build->range_count; i++) b->node_count += build->ranges[i].used;
  const size_t size = b->node_count * sizeof *b->nodes + CAG_BVH_NODE_ALIGN;
  b->memory = cag_malloc(size);
  if (!b->memory) return false;
  cag_memory_scattered(b->memory, size);
  b->nodes = (CagBvhNode *)(((uintptr_t)b->memory + CAG_BVH_NODE_ALIGN - 1) / CAG_BVH_NODE_ALIGN *
                            CAG_BVH_NODE_ALIGN);
  size_t at = build->top;
  for (size_t i = 0; i < build->range_count; i++) {
    const Range *r = &build->ranges[i];
    const uint32_t shift = (uint32_t)(r->node - at);
    if (!(*r->parent & CAG_BVH_LEAF)) *r->parent -= shift;
    memcpy(b->nodes + at, build->nodes + r->node, r->used * sizeof *b->nodes);
    for (size_t k = at; k < at + r->used; k++)
      for (int c = 0; c < b->nodes[k].count; c++)
        if (!(b->nodes[k].child[c] & CAG_BVH_LEAF)) b->nodes[k].child[c] -= shift;
    at += r->used;
  }
  memcpy(b->nodes, build->nodes, build->top * sizeof *b->nodes);
  return true;
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

// Builds the nodes of all items. Room: those above the ranges, and those of each range.
static CagStatus build_nodes(Build *build, CagBvh *b, CagError *err) {
  const size_t n = b->item_count, room = RANGES_MAX + room_for(build, n) + RANGES_MAX;
  build->nodes = cag_malloc(room * sizeof *build->nodes);
  if (!build->nodes) return cag_fail_memory(err);
  build->ranges[0] = (Range){.n = n, .parent = &b->root};
  build->range_count = 1;
  divide_work(build);
  size_t at = build->top;
  for (size_t i = 0; i < build->range_count; i++) {
    build->ranges[i].node = at;
    at += room_for(build, build->ranges[i].n);
  }
  cag_parallel(build->range_count, build_numbered_range, build);
  if (!close_gaps(build, b)) return cag_fail_memory(err);
  return cag_stop_check(err);
}

CagStatus cag_bvh_build(const CagBounds *boxes, size_t n, size_t leaf_items, CagBvh *out,
                        CagError *err) {
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
  if (build) {
    build->leaf_items = leaf_items;
    build->refs = cag_malloc(n * sizeof *build->refs);
  }
  out->order = cag_malloc(n * sizeof *out->order);
  CagStatus status = build && build->refs && out->order ? CAG_OK : cag_fail_memory(err);
  if (!status) {
    make_refs(boxes, n, out, build->refs);
    status = build_nodes(build, out, err);
    for (size_t i = 0; i < n; i++) out->order[i] = build->refs[i].item;
  }
  if (build) {
    cag_free(build->refs);
    cag_free(build->nodes);
  }
  cag_free(build);
  if (status) cag_bvh_free(out);
  return status;
}

void cag_bvh_free(CagBvh *b) {
  cag_free(b->memory);
  cag_free(b->order);
  *b = (CagBvh){.bounds = CAG_BOUNDS_EMPTY};
}

// --- Rays ---

// Stands for the inverse of a direction's component that is 0, or nearly.
#define INVERSE_MAX 1e30

// Reduces the range of parameters to the part within the bounds along one axis.
static bool clip_axis(double origin, double inverse, double low, double high, double *least,
                      double *most) {
  if (fabs(inverse) == INVERSE_MAX) return origin >= low && origin <= high;
  const double a = (low - origin) * inverse, b = (high - origin) * inverse;
  const double in = a < b ? a : b, out = a < b ? b : a;
  *least = in > *least ? in : *least;
  *most = out < *most ? out : *most;
  return *least <= *most;
}

static double inverse_of(double direction) {
  return fabs(direction) * INVERSE_MAX > 1 ? 1 / direction : copysign(INVERSE_MAX, direction);
}

// The inverses of the traversal are at most this. Within the bounds, a ray with a larger one is almost
// parallel to the planes: it leaves the ray in the padding of a box over a thousand radii.
#define FLOAT_INVERSE_MAX 1e9

static float float_inverse(double inverse) {
  return (float)fmin(fmax(inverse, -FLOAT_INVERSE_MAX), FLOAT_INVERSE_MAX);
}

bool cag_bvh_ray(const CagBvh *b, CagVec3 origin, CagVec3 direction, double least, double most,
                 CagBvhRay *out) {
  const double pad = BOX_PAD * b->radius;
  const double inverse[3] = {inverse_of(direction.x), inverse_of(direction.y),
                             inverse_of(direction.z)};
  const CagVec3 low = b->bounds.min, high = b->bounds.max;
  double from = least, to = most;
  if (b->item_count == 0 ||
      !clip_axis(origin.x, inverse[0], low.x - pad, high.x + pad, &from, &to) ||
      !clip_axis(origin.y, inverse[1], low.y - pad, high.y + pad, &from, &to) ||
      !clip_axis(origin.z, inverse[2], low.z - pad, high.z + pad, &from, &to))
    return false;
  const CagVec3 start = cag_sub(cag_madd(origin, from, direction), b->origin);
  *out = (CagBvhRay){
      .origin = {(float)start.x, (float)start.y, (float)start.z},
      .inverse = {float_inverse(inverse[0]), float_inverse(inverse[1]), float_inverse(inverse[2])},
      .start = from,
      .least = (float)(-pad),
      .most = (float)(to - from + pad),
      .down = {inverse[0] < 0, inverse[1] < 0, inverse[2] < 0}};
  return true;
}
