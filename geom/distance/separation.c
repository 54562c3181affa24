// Distances of shapes.
//
// Two trees of boxes are traversed together for the closest pairs of chords and triangles. Starting
// from these, Newton's method, damped and kept within smooth pieces, finds the closest points of
// the exact shapes. A second traversal tests all pairs that may still be closer: those whose
// distance of chords and triangles, minus the sag of the shapes, is below the best distance found.
// Parts with cores have bounds without such a margin.

#include "geom/distance/separation.h"

#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/family.h"
#include "geom/distance/part_pair.h"
#include "geom/mesh/distance.h"

// Pairs from which the exact search starts. Neighbors lead to the same closest point, so several
// are needed for each location.
#define CANDIDATES 8
// The search for them ends after this many pairs; the second traversal finds what it missed.
#define MOST_LOOKED 500
// The second traversal adapts its bounds to closer pairs after this many pairs of nodes.
#define ADAPTED 200
#define LEAF 4
// Maximum number of restarts of Newton's method from the corner of a flat triangle.
#define CORNER_ROUNDS 8
// After this many pairs at the same distance, the shapes count as running along each other: the
// number of such pairs is unlimited.
#define SAME_PAIRS 4000
// After this many pairs, the search skips locations that are only nearly as close.
#define NEAR_PAIRS 3000
// Pairs are equally close if their distances differ by less than this fraction of the size.
#define EQUALLY_NEAR 1e-11
// Shapes closer than this fraction of their size meet.
#define TOUCHING 1e-10

// --- Parts ---

static void tree_free(struct CagPartTree *t);

static CagStatus push(CagParts *parts, CagPart part, CagError *err) {
  tree_free(parts->tree);
  parts->tree = NULL;
  if (!CAG_RESERVE(parts->items, parts->capacity, parts->n + 1)) return cag_fail_memory(err);
  parts->items[parts->n++] = part;
  return CAG_OK;
}

void cag_parts_free(CagParts *parts) {
  cag_free(parts->items);
  cag_free(parts->cores);
  tree_free(parts->tree);
}

// Stores the core; *out is one more than its index.
static CagStatus add_core(CagParts *parts, const CagCore *core, size_t *out, CagError *err) {
  if (!CAG_RESIZE(parts->cores, parts->core_count + 1)) return cag_fail_memory(err);
  parts->cores[parts->core_count++] = *core;
  *out = parts->core_count;
  return CAG_OK;
}

CagStatus cag_parts_add_point(CagParts *parts, CagVec3 p, CagError *err) {
  return push(parts, (CagPart){.p = {p, p, p}}, err);
}

CagStatus cag_parts_add_triangle(CagParts *parts, const CagVec3 corners[3], CagError *err) {
  const CagPart part = {
      .p = {corners[0], corners[1], corners[2]}, .flat = true, .at = {0.5, 0.5}, .high = {1, 1}};
  return push(parts, part, err);
}

CagStatus cag_parts_add_curve(CagParts *parts, const CagCurve *c, double tolerance, CagError *err) {
  const double turn = 0.3; // radians
  double *t = NULL;
  size_t n = 0, core = 0;
  CagCore last = {.radius = -1}, next;
  CagVec3 before = {0, 0, 0}, p;
  CagStatus status = cag_curve_discretize(c, tolerance, turn, &t, &n, err);
  for (size_t i = 0; !status && i < n; i++) {
    status = cag_curve_point(c, t[i], &p, err);
    if (status || i == 0) {
      before = p;
      continue;
    }
    const double sag = cag_curve_sag(c, t[i - 1], t[i]);
    if (sag == 0 || !cag_curve_core(c, t[i - 1], t[i], &next)) {
      core = 0;
    } else if (core == 0 || memcmp(&last, &next, sizeof next) != 0) {
      status = add_core(parts, &next, &core, err);
      last = next;
    }
    if (!status)
      status = push(parts,
                    (CagPart){.p = {before, p, p},
                              .curve = c,
                              .at = {(t[i - 1] + t[i]) / 2, 0},
                              .low = {t[i - 1], 0},
                              .high = {t[i], 0},
                              .sag = sag,
                              .core = core},
                    err);
    before = p;
  }
  cag_free(t);
  return status;
}

// The smooth pieces of a surface along both directions.
typedef struct Pieces {
  double *cuts[2]; // breaks and both ends
  size_t n[2];
  bool closed[2];
  size_t *core;   // of each piece along u, as in CagPart
  bool *straight; // for each piece along u: flat, with straight edges
} Pieces;

static void pieces_free(Pieces *pieces) {
  cag_free(pieces->cuts[0]);
  cag_free(pieces->cuts[1]);
  cag_free(pieces->core);
  cag_free(pieces->straight);
}

static CagStatus find_pieces(CagParts *parts, const CagSurface *s, Pieces *out, CagError *err) {
  CagStatus status = CAG_OK;
  for (int k = 0; !status && k < 2; k++) {
    status = cag_surface_cuts(s, k, &out->cuts[k], &out->n[k], err);
    out->closed[k] = k ? s->closed_v : s->closed_u;
  }
  if (status) return status;
  const size_t n = out->n[0];
  out->core = cag_calloc(n, sizeof *out->core);
  out->straight = cag_calloc(n, sizeof *out->straight);
  if (!out->core || !out->straight) return cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++) {
    const double *ends = out->cuts[0] + i;
    CagCore core;
    out->straight[i] = cag_surface_is_straight(s, ends[0], ends[1]);
    if (!out->straight[i] && cag_surface_core(s, ends[0], ends[1], &core))
      status = add_core(parts, &core, &out->core[i], err);
  }
  return status;
}

// The piece around the part.
static void limit_part(const Pieces *pieces, CagPart *part) {
  for (int k = 0; k < 2; k++) {
    const double *cuts = pieces->cuts[k];
    size_t low = 0, high = pieces->n[k];
    while (high - low > 1) {
      const size_t middle = (low + high) / 2;
      if (cuts[middle] <= part->at[k]) low = middle;
      else high = middle;
    }
    part->low[k] = cuts[low];
    part->high[k] = cuts[low + 1];
    part->ring[k] = pieces->closed[k] && pieces->n[k] == 1;
    if (k > 0) continue;
    part->core = pieces->core[low];
    if (pieces->straight[low]) part->sag = 0;
  }
}

CagStatus cag_parts_add_mesh(CagParts *parts, const CagMesh *m, const CagSurface *surface,
                             double tolerance, CagError *err) {
  const bool exact = surface && m->uv;
  Pieces pieces = {0};
  CagStatus status = exact ? find_pieces(parts, surface, &pieces, err) : CAG_OK;
  for (size_t t = 0; !status && t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    CagPart part = {.flat = !exact, .at = {0.5, 0.5}, .high = {1, 1}};
    for (int i = 0; i < 3; i++) part.p[i] = m->positions[k[i]];
    if (exact) {
      part.surface = surface;
      part.sag = tolerance;
      for (int x = 0; x < 2; x++)
        part.at[x] = (m->uv[2 * k[0] + x] + m->uv[2 * k[1] + x] + m->uv[2 * k[2] + x]) / 3;
      limit_part(&pieces, &part);
    }
    status = push(parts, part, err);
    if (!status) status = cag_stop_check(err);
  }
  pieces_free(&pieces);
  return status;
}

// --- Chords and triangles ---

static double segments(CagVec3 p, CagVec3 q, CagVec3 r, CagVec3 s) {
  const CagVec3 a = cag_sub(q, p), b = cag_sub(s, r), w = cag_sub(p, r);
  const double aa = cag_dot(a, a), bb = cag_dot(b, b), ab = cag_dot(a, b);
  const double det = aa * bb - ab * ab, aw = cag_dot(a, w), bw = cag_dot(b, w);
  double nearest = fmin(fmin(cag_distance_to_segment(p, r, s), cag_distance_to_segment(q, r, s)),
                        fmin(cag_distance_to_segment(r, p, q), cag_distance_to_segment(s, p, q)));
  if (!(det > 0)) return nearest;
  const double x = (ab * bw - bb * aw) / det, y = (aa * bw - ab * aw) / det;
  if (x > 0 && x < 1 && y > 0 && y < 1)
    nearest = fmin(nearest, cag_norm(cag_sub(cag_madd(p, x, a), cag_madd(r, y, b))));
  return nearest;
}

// Whether a segment crosses a triangle, and where.
static bool pierces(CagVec3 p, CagVec3 q, const CagVec3 t[3], CagVec3 *at) {
  const CagVec3 n = cag_cross(cag_sub(t[1], t[0]), cag_sub(t[2], t[0]));
  const double a = cag_dot(n, cag_sub(p, t[0])), b = cag_dot(n, cag_sub(q, t[0]));
  if (!((a < 0 && b > 0) || (a > 0 && b < 0))) return false;
  const CagVec3 x = cag_lerp(p, q, a / (a - b));
  for (int i = 0; i < 3; i++)
    if (cag_dot(cag_cross(cag_sub(t[(i + 1) % 3], t[i]), cag_sub(x, t[i])), n) < 0) return false;
  *at = x;
  return true;
}

static double chord_distance(const CagPart *a, const CagPart *b) {
  double nearest = INFINITY;
  CagVec3 at;
  for (int i = 0; i < 3; i++) {
    const int next = (i + 1) % 3;
    if (pierces(a->p[i], a->p[next], b->p, &at) || pierces(b->p[i], b->p[next], a->p, &at))
      return 0;
    nearest = fmin(nearest, cag_distance_to_triangle(a->p[i], b->p[0], b->p[1], b->p[2]));
    nearest = fmin(nearest, cag_distance_to_triangle(b->p[i], a->p[0], a->p[1], a->p[2]));
    for (int k = 0; k < 3; k++)
      nearest = fmin(nearest, segments(a->p[i], a->p[next], b->p[k], b->p[(k + 1) % 3]));
  }
  return nearest;
}

// Keeps points of the first and the second shape if they are the closest so far.
typedef struct Feet {
  double distance;
  CagVec3 p[2];
} Feet;
static void offer_foot(Feet *feet, CagVec3 p, CagVec3 q) {
  const double d = cag_norm(cag_sub(p, q));
  if (d < feet->distance) *feet = (Feet){d, {p, q}};
}

// The closest points of triangles, or a common one.
static Feet chord_feet(const CagPart *a, const CagPart *b) {
  Feet nearest = {INFINITY, {a->p[0], b->p[0]}};
  CagVec3 foot;
  for (int i = 0; i < 3; i++) {
    const CagVec3 p = a->p[i], q = a->p[(i + 1) % 3];
    if (pierces(p, q, b->p, &foot) || pierces(b->p[i], b->p[(i + 1) % 3], a->p, &foot))
      return (Feet){0, {foot, foot}};
    if (cag_foot_in_triangle(p, b->p, &foot)) offer_foot(&nearest, p, foot);
    if (cag_foot_in_triangle(b->p[i], a->p, &foot)) offer_foot(&nearest, foot, b->p[i]);
    for (int k = 0; k < 3; k++) {
      const CagVec3 r = b->p[k], s = b->p[(k + 1) % 3];
      offer_foot(&nearest, p, cag_nearest_of_segment(p, r, s));
      offer_foot(&nearest, cag_nearest_of_segment(r, p, q), r);
      // The closest points of the lines, if both are within the segments.
      const CagVec3 u = cag_sub(q, p), v = cag_sub(s, r), w = cag_sub(p, r);
      const double uu = cag_dot(u, u), vv = cag_dot(v, v), uv = cag_dot(u, v);
      const double det = uu * vv - uv * uv, uw = cag_dot(u, w), vw = cag_dot(v, w);
      const double x = (uv * vw - vv * uw) / det, y = (uu * vw - uv * uw) / det;
      if (det > 0 && x > 0 && x < 1 && y > 0 && y < 1)
        offer_foot(&nearest, cag_madd(p, x, u), cag_madd(r, y, v));
    }
  }
  return nearest;
}

// --- Bounds by cores ---

// The hull of up to three points; all points of the part have the same distance from it.
typedef struct Hull {
  CagPart part; // only its points are used
  double radius;
} Hull;

static Hull hull_of_core(const CagCore *core) {
  return (Hull){{.p = {core->p[0], core->p[1], core->p[1]}}, core->radius};
}

// False: the part is known only up to its sag.
static bool hull_of_part(const CagParts *parts, const CagPart *part, Hull *out) {
  if (part->core) *out = hull_of_core(&parts->cores[part->core - 1]);
  else *out = (Hull){.part = *part};
  return part->core || part->sag == 0;
}

// The largest distance of a point of the hull from a core's point or infinite line. It is attained
// at a corner, since the distance is convex.
static double reach(const Hull *from, const Hull *core) {
  const CagVec3 *to = core->part.p, along = cag_unit(cag_sub(to[1], to[0]));
  double most = 0;
  for (int i = 0; i < 3; i++) {
    const CagVec3 r = cag_sub(from->part.p[i], to[0]);
    most = fmax(most, cag_norm(cag_madd(r, -cag_dot(r, along), along)));
  }
  return most;
}

// A lower bound of the distance of two parts from their hulls: one is outside the other, or inside.
static double hull_bound(const Hull *a, const Hull *b) {
  const double beside = chord_distance(&a->part, &b->part) - a->radius - b->radius;
  const double within = fabs(b->radius - a->radius);
  if (beside >= within) return beside;
  const Hull *inner = a->radius < b->radius ? a : b, *outer = inner == a ? b : a;
  return fmax(beside, within - reach(inner, outer));
}

// --- Trees of boxes ---

typedef struct Node {
  CagBounds box;
  double sag;          // the largest of its parts
  size_t core;         // core of all parts; 0: none, or several
  size_t first, count; // parts by `order`
  size_t left;         // children left and left + 1; 0: a leaf
} Node;

typedef struct CagPartTree {
  const CagParts *parts;
  size_t *order;
  Node *nodes;
  size_t n;
} Tree;

static void tree_free(Tree *t) {
  if (!t) return;
  cag_free(t->order);
  cag_free(t->nodes);
  cag_free(t);
}

static double coordinate(CagVec3 p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

// Loops over the parts of a node end early if the work is canceled, which grow_tree reports.
static CagBounds box_of(const Tree *t, size_t first, size_t count) {
  CagBounds box = CAG_BOUNDS_EMPTY;
  for (size_t i = 0; i < count && !cag_stopped(); i++)
    for (int k = 0; k < 3; k++) cag_bounds_add(&box, t->parts->items[t->order[first + i]].p[k]);
  return box;
}

static Node node_of(const Tree *t, size_t first, size_t count) {
  Node node = {.box = box_of(t, first, count), .first = first, .count = count};
  node.core = t->parts->items[t->order[first]].core;
  for (size_t i = 0; i < count && !cag_stopped(); i++) {
    const CagPart *part = &t->parts->items[t->order[first + i]];
    node.sag = fmax(node.sag, part->sag);
    if (part->core != node.core) node.core = 0;
  }
  return node;
}

// Splits at the middle of the box, or by count if all parts are on one side.
static size_t divide(Tree *t, const Node *node) {
  const CagVec3 size = cag_sub(node->box.max, node->box.min);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const double middle = (coordinate(node->box.min, axis) + coordinate(node->box.max, axis)) / 2;
  size_t low = 0;
  for (size_t i = 0; i < node->count && !cag_stopped(); i++) {
    size_t *at = t->order + node->first;
    const CagPart *part = &t->parts->items[at[i]];
    const double x = (coordinate(part->p[0], axis) + coordinate(part->p[1], axis) +
                      coordinate(part->p[2], axis)) /
                     3;
    if (x >= middle) continue;
    const size_t swap = at[i];
    at[i] = at[low];
    at[low++] = swap;
  }
  return low == 0 || low == node->count ? node->count / 2 : low;
}

static CagStatus grow_tree(CagParts *parts, Tree *t, CagError *err) {
  *t = (Tree){.parts = parts, .n = 1};
  t->order = cag_malloc(parts->n * sizeof *t->order);
  t->nodes = cag_malloc(2 * parts->n * sizeof *t->nodes);
  if (!t->order || !t->nodes) return cag_fail_memory(err);
  for (size_t i = 0; i < parts->n; i++) t->order[i] = i;
  t->nodes[0] = node_of(t, 0, parts->n);
  for (size_t i = 0; i < t->n; i++) {
    if (cag_stop_check(err)) return err->status;
    Node *node = &t->nodes[i];
    if (node->count <= LEAF) continue;
    const size_t low = divide(t, node), rest = node->count - low;
    node->left = t->n;
    t->nodes[t->n++] = node_of(t, node->first, low);
    t->nodes[t->n++] = node_of(t, node->first + low, rest);
  }
  return CAG_OK;
}

static CagStatus find_tree(CagParts *parts, CagError *err) {
  if (parts->tree) {
    parts->tree->parts = parts; // the structure may have been copied
    return CAG_OK;
  }
  Tree *t = cag_calloc(1, sizeof *t);
  if (!t) return cag_fail_memory(err);
  CagStatus status = grow_tree(parts, t, err);
  if (status) tree_free(t);
  else parts->tree = t;
  return status;
}

static double gap(const CagBounds *a, const CagBounds *b) {
  const double x = fmax(0, fmax(a->min.x - b->max.x, b->min.x - a->max.x));
  const double y = fmax(0, fmax(a->min.y - b->max.y, b->min.y - a->max.y));
  const double z = fmax(0, fmax(a->min.z - b->max.z, b->min.z - a->max.z));
  return sqrt(x * x + y * y + z * z);
}

// The distance of the boxes of two parts, which is far cheaper than that of their chords.
static double part_gap(const CagPart *a, const CagPart *b) {
  CagBounds box[2];
  for (int i = 0; i < 2; i++) {
    const CagVec3 *p = i ? b->p : a->p;
    box[i].min = box[i].max = p[0];
    for (int k = 1; k < 3; k++) {
      box[i].min = cag_vec3(p[k].x < box[i].min.x ? p[k].x : box[i].min.x,
                            p[k].y < box[i].min.y ? p[k].y : box[i].min.y,
                            p[k].z < box[i].min.z ? p[k].z : box[i].min.z);
      box[i].max = cag_vec3(p[k].x > box[i].max.x ? p[k].x : box[i].max.x,
                            p[k].y > box[i].max.y ? p[k].y : box[i].max.y,
                            p[k].z > box[i].max.z ? p[k].z : box[i].max.z);
    }
  }
  return gap(&box[0], &box[1]);
}

// The closest pairs so far, ascending.
typedef struct Nearest {
  size_t n;
  double distance[CANDIDATES];
  const CagPart *a[CANDIDATES], *b[CANDIDATES];
  size_t looked;                 // pairs of parts compared so far
  const volatile int *interrupt; // nonzero cancels the search; may be NULL
} Nearest;

static double worst(const Nearest *s) {
  return s->n < CANDIDATES ? INFINITY : s->distance[CANDIDATES - 1];
}

static void keep(Nearest *s, double d, const CagPart *a, const CagPart *b) {
  if (d >= worst(s)) return;
  size_t i = s->n < CANDIDATES ? s->n++ : CANDIDATES - 1;
  for (; i > 0 && s->distance[i - 1] > d; i--) {
    s->distance[i] = s->distance[i - 1];
    s->a[i] = s->a[i - 1];
    s->b[i] = s->b[i - 1];
  }
  s->distance[i] = d;
  s->a[i] = a;
  s->b[i] = b;
}

static void walk(const Tree *a, size_t i, const Tree *b, size_t k, Nearest *s) {
  const Node *x = &a->nodes[i], *y = &b->nodes[k];
  if (gap(&x->box, &y->box) >= worst(s)) return;
  if ((s->interrupt && *s->interrupt) || s->looked >= MOST_LOOKED) return;
  if (!x->left && !y->left) {
    s->looked += x->count * y->count;
    for (size_t m = 0; m < x->count; m++)
      for (size_t n = 0; n < y->count; n++) {
        const CagPart *p = &a->parts->items[a->order[x->first + m]];
        const CagPart *q = &b->parts->items[b->order[y->first + n]];
        if (part_gap(p, q) < worst(s)) keep(s, chord_distance(p, q), p, q);
      }
    return;
  }
  const bool first = x->left && (!y->left || x->count >= y->count);
  const Node *child = first ? &a->nodes[x->left] : &b->nodes[y->left];
  const CagBounds *other = first ? &y->box : &x->box;
  const size_t nearer = gap(&child[1].box, other) < gap(&child[0].box, other);
  for (size_t turn = 0; turn < 2; turn++) {
    const size_t c = turn ? 1 - nearer : nearer;
    if (first) walk(a, x->left + c, b, k, s);
    else walk(a, i, b, y->left + c, s);
  }
}

// --- The search ---

// Two nodes with a lower bound of their distance.
typedef struct Task {
  double bound;
  size_t i, k;
} Task;

typedef struct Search {
  const Tree *a, *b;
  double size, best;
  double farthest;  // largest distance found for a pair
  CagVec3 point[2]; // the closest ones so far
  size_t pairs, most;
  // The unit vector from the one to the other. Along it, the nodes of the first tree reach up to
  // `reach[0]`, those of the second one down to `reach[1]`. NULL: not computed yet.
  CagVec3 way;
  double *reach[2];
  double reach_best;  // the best distance at that time
  CagPartsNear *near; // locations to be found; NULL: none
  Task *tasks;        // a heap with the lowest bound first
  size_t count, room;
  const volatile int *interrupt;
  CagStatus status;
  CagError *err;
} Search;

// Shapes closer than this meet. Pairs that cannot improve the best distance by this much are
// skipped.
static double touching(const Search *s) { return TOUCHING * s->size; }

static double equally_near(const Search *s) { return EQUALLY_NEAR * s->size; }

// Pairs whose bound is at least this are of no interest.
static double wanted(const Search *s) {
  const double margin = s->near && s->pairs < NEAR_PAIRS ? s->near->margin : 0;
  return s->best + margin - equally_near(s);
}

// A point, a straight piece of a curve, or a flat triangle, whose chord is exact.
static bool is_exact(const CagPart *part) { return part->sag == 0 && !part->core; }

// Restarts from the ends of curves if the search from the middle led to a worse minimum; keeps the
// best.
static void try_ends(Search *s, const CagPartPair *start, double *d, CagVec3 p[2]) {
  for (int side = 0, at = 0; side < 2; at += start->free[side++])
    for (int last = 0; last < 2 && start->part[side]->curve && !s->status; last++) {
      CagPartPair pair = *start;
      double there;
      CagVec3 feet[2];
      pair.x[at] = last ? pair.part[side]->high[0] : pair.part[side]->low[0];
      s->status = cag_part_pair_refine(&pair, &there, feet, s->err);
      if (s->status || there >= *d) continue;
      *d = there;
      memcpy(p, feet, sizeof feet);
    }
}

static void remove_near(CagPartsNear *near, size_t at) {
  for (size_t i = at + 1; i < near->n; i++) {
    near->distance[i - 1] = near->distance[i];
    memcpy(near->points[i - 1], near->points[i], sizeof near->points[i]);
  }
  near->n--;
}

// Keeps a location unless a closer one is beside it.
static void offer_near(CagPartsNear *near, double distance, const CagVec3 points[2]) {
  for (size_t i = 0; i < near->n; i++) {
    if (cag_norm(cag_sub(points[0], near->points[i][0])) > near->apart ||
        cag_norm(cag_sub(points[1], near->points[i][1])) > near->apart)
      continue;
    if (near->distance[i] <= distance) return;
    remove_near(near, i--);
  }
  if (near->n == CAG_PARTS_NEAR && near->distance[near->n - 1] <= distance) return;
  size_t at = near->n < CAG_PARTS_NEAR ? near->n++ : near->n - 1;
  for (; at > 0 && near->distance[at - 1] > distance; at--) {
    near->distance[at] = near->distance[at - 1];
    memcpy(near->points[at], near->points[at - 1], sizeof near->points[at]);
  }
  near->distance[at] = distance;
  memcpy(near->points[at], points, sizeof near->points[at]);
}

// Lowers the best distance by the minimum that the pair leads to; `chords` is the distance of their
// chords.
static void try_pair(Search *s, const CagPart *a, const CagPart *b, double chords) {
  const CagPartPair start = cag_part_pair(a, b);
  CagPartPair pair = start;
  double d = chords;
  CagVec3 p[2];
  const bool exact = is_exact(a) && is_exact(b);
  if (exact) {
    const Feet feet = chord_feet(a, b);
    memcpy(p, feet.p, sizeof p);
  } else s->status = cag_part_pair_refine(&pair, &d, p, s->err);
  for (int round = 0; !exact && round < CORNER_ROUNDS && d > touching(s); round++) {
    if (s->status || !cag_part_pair_leave_corner(&pair, d, &s->status, s->err)) break;
    s->status = cag_part_pair_refine(&pair, &d, p, s->err);
  }
  if (s->status) return;
  if (!exact && d > chords + equally_near(s)) try_ends(s, &start, &d, p);
  if (s->status) return;
  s->pairs++;
  s->farthest = fmax(s->farthest, d);
  if (s->near && d <= s->best + s->near->margin) offer_near(s->near, d, p);
  if (d >= s->best) return;
  s->best = d;
  memcpy(s->point, p, sizeof s->point);
}

// True if the search can stop: it failed, or the shapes touch or run along each other at a constant
// distance.
static bool is_over(const Search *s) {
  return s->status || s->best <= touching(s) || (s->interrupt && *s->interrupt) ||
         (s->pairs >= SAME_PAIRS && s->farthest - s->best <= equally_near(s));
}

// --- Bounds along the shortest way ---

// How far the corners of a part reach along the way: to the farthest (0) or nearest (1).
static double part_reach(const Search *s, const CagPart *part, int side) {
  const double x = cag_dot(part->p[0], s->way), y = cag_dot(part->p[1], s->way);
  const double z = cag_dot(part->p[2], s->way);
  return side ? (x < y ? (x < z ? x : z) : (y < z ? y : z))
              : (x > y ? (x > z ? x : z) : (y > z ? y : z));
}

// The planes perpendicular to the way between the closest points found so far separate most other
// parts better than their boxes do: all of them, if the shapes are convex.
static void find_reach(Search *s) {
  const CagVec3 way = cag_sub(s->point[1], s->point[0]);
  if (s->status || !(s->best > touching(s)) || !isfinite(s->best)) return;
  s->way = cag_unit(way);
  s->reach_best = s->best;
  for (int side = 0; side < 2; side++) {
    const Tree *t = side ? s->b : s->a;
    if (!s->reach[side]) s->reach[side] = cag_malloc(t->n * sizeof **s->reach);
    double *reach = s->reach[side];
    if (!reach) {
      s->status = cag_fail_memory(s->err);
      return;
    }
    for (size_t i = t->n; i-- > 0;) { // children follow their parents
      const Node *node = &t->nodes[i];
      reach[i] = side ? INFINITY : -INFINITY;
      for (size_t k = 0; k < (node->left ? 2 : node->count); k++) {
        const double x = node->left
                             ? reach[node->left + k]
                             : part_reach(s, &t->parts->items[t->order[node->first + k]], side);
        if (side ? x < reach[i] : x > reach[i]) reach[i] = x;
      }
    }
  }
}

static void push_task(Search *s, Task task) {
  if (s->status || task.bound >= wanted(s)) return;
  if (!CAG_RESERVE(s->tasks, s->room, s->count + 1)) {
    s->status = cag_fail_memory(s->err);
    return;
  }
  size_t i = s->count++;
  for (; i > 0 && s->tasks[(i - 1) / 2].bound > task.bound; i = (i - 1) / 2)
    s->tasks[i] = s->tasks[(i - 1) / 2];
  s->tasks[i] = task;
}

static Task pop_task(Search *s) {
  Task *tasks = s->tasks;
  const Task top = tasks[0], last = tasks[--s->count];
  size_t i = 0;
  for (size_t child; (child = 2 * i + 1) < s->count; i = child) {
    if (child + 1 < s->count && tasks[child + 1].bound < tasks[child].bound) child++;
    if (!(tasks[child].bound < last.bound)) break;
    tasks[i] = tasks[child];
  }
  tasks[i] = last;
  return top;
}

static void push_nodes(Search *s, size_t i, size_t k) {
  const Node *x = &s->a->nodes[i], *y = &s->b->nodes[k];
  double bound = -INFINITY;
  if (s->reach[1]) bound = s->reach[1][k] - s->reach[0][i] - x->sag - y->sag;
  if (bound >= wanted(s)) return;
  bound = fmax(bound, gap(&x->box, &y->box) - x->sag - y->sag);
  if (x->core && y->core && bound < wanted(s)) {
    const Hull p = hull_of_core(&s->a->parts->cores[x->core - 1]);
    const Hull q = hull_of_core(&s->b->parts->cores[y->core - 1]);
    bound = fmax(bound, hull_bound(&p, &q));
  }
  push_task(s, (Task){bound, i, k});
}

static void fail_uncertain(Search *s, double bound) {
  s->status =
      cag_fail(s->err, CAG_E_LIMIT, CAG_ERR_convergence, "", -1,
               "more than %zu pairs of points on the shapes are nearly equally close, at %g "
               "to %g mm; cannot determine which pair is the closest",
               s->most, fmax(0, bound), s->best);
}

static void try_parts(Search *s, const Node *x, const Node *y) {
  for (size_t m = 0; m < x->count; m++) {
    const CagPart *p = &s->a->parts->items[s->a->order[x->first + m]];
    const double from = s->reach[1] ? part_reach(s, p, 0) : INFINITY;
    for (size_t n = 0; n < y->count && !is_over(s); n++) {
      const CagPart *q = &s->b->parts->items[s->b->order[y->first + n]];
      const double least = wanted(s) + p->sag + q->sag;
      if (s->reach[1] && part_reach(s, q, 1) - from >= least) continue;
      if (part_gap(p, q) >= least) continue;
      const double chords = chord_distance(p, q);
      if (chords >= least) continue;
      Hull a, b;
      if (hull_of_part(s->a->parts, p, &a) && hull_of_part(s->b->parts, q, &b) &&
          hull_bound(&a, &b) >= wanted(s))
        continue;
      if (s->pairs < s->most) try_pair(s, p, q, chords);
      else fail_uncertain(s, chords - p->sag - q->sag);
    }
  }
}

static void go_on(Search *s, const Task *task) {
  const Node *x = &s->a->nodes[task->i], *y = &s->b->nodes[task->k];
  if (!x->left && !y->left) {
    try_parts(s, x, y);
    return;
  }
  const bool first = x->left && (!y->left || x->count >= y->count);
  for (size_t half = 0; half < 2; half++)
    if (first) push_nodes(s, x->left + half, task->k);
    else push_nodes(s, task->i, y->left + half);
}

// Tests all pairs that may be closer than the best one, in the order of the bounds of their nodes.
static void certify(Search *s) {
  size_t visited = 0;
  find_reach(s);
  push_nodes(s, 0, 0);
  while (s->count > 0 && !is_over(s)) {
    const Task task = pop_task(s);
    if (task.bound >= wanted(s)) break;
    go_on(s, &task);
    if (++visited % ADAPTED == 0 && s->best < s->reach_best - equally_near(s)) find_reach(s);
  }
}

static void find_nearest(Search *s) {
  Nearest nearest = {.interrupt = s->interrupt};
  const CagBounds *box[2] = {&s->a->nodes[0].box, &s->b->nodes[0].box};
  for (int i = 0; i < 2; i++) s->size = fmax(s->size, cag_norm(cag_sub(box[i]->max, box[i]->min)));
  walk(s->a, 0, s->b, 0, &nearest);
  for (size_t i = 0; i < nearest.n && !is_over(s); i++)
    try_pair(s, nearest.a[i], nearest.b[i], nearest.distance[i]);
  certify(s);
}

static CagStatus search_parts(CagParts *a, CagParts *b, size_t most, double *out, CagVec3 points[2],
                              CagPartsNear *near, const volatile int *interrupt, CagError *err) {
  if (a->n == 0 || b->n == 0)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_zero_area, "", -1,
                    "a surface without area has no triangles to measure from");
  CagStatus status = find_tree(a, err);
  if (!status) status = find_tree(b, err);
  if (status) return status;
  Search s = {a->tree,      b->tree,      .best = INFINITY,
              .most = most, .near = near, .interrupt = interrupt,
              .err = err};
  find_nearest(&s);
  status = s.status;
  if (!status && interrupt && *interrupt)
    status =
        cag_fail(err, CAG_E_CALLBACK, CAG_ERR_interrupted, "", -1, "the search was interrupted");
  cag_free(s.tasks);
  for (int side = 0; side < 2; side++) cag_free(s.reach[side]);
  if (status) return status;
  *out = s.best <= touching(&s) ? 0 : s.best;
  if (points) memcpy(points, s.point, sizeof s.point);
  return CAG_OK;
}

CagStatus cag_parts_distance(CagParts *a, CagParts *b, size_t most, double *out, CagVec3 points[2],
                             const volatile int *interrupt, CagError *err) {
  return search_parts(a, b, most, out, points, NULL, interrupt, err);
}

CagStatus cag_parts_near(CagParts *a, CagParts *b, size_t most, double *out, CagPartsNear *near,
                         const volatile int *interrupt, CagError *err) {
  near->n = 0;
  CagStatus status = search_parts(a, b, most, out, NULL, near, interrupt, err);
  while (near->n > 0 && near->distance[near->n - 1] > *out + near->margin) near->n--;
  return status;
}

// --- Inside ---

// Solid angles (van Oosterom, Strackee 1983), over 4 pi. Ends early if the work is canceled.
double cag_mesh_winding(const CagMesh *m, CagVec3 p) {
  double sum = 0;
  for (size_t t = 0; t < m->triangle_count && !cag_stopped(); t++) {
    const uint32_t *k = m->triangles + 3 * t;
    const CagVec3 a = cag_sub(m->positions[k[0]], p), b = cag_sub(m->positions[k[1]], p);
    const CagVec3 c = cag_sub(m->positions[k[2]], p);
    const double x = cag_norm(a), y = cag_norm(b), z = cag_norm(c);
    sum += atan2(cag_dot(a, cag_cross(b, c)),
                 x * y * z + cag_dot(a, b) * z + cag_dot(b, c) * x + cag_dot(c, a) * y);
  }
  return sum / (2 * M_PI);
}
