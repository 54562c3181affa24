// Winding numbers on both sides of each piece of a set operation.
//
// The pieces around an edge are sorted by angle; the space in front of one is the space behind the
// next. Pieces are kept in a union-find forest in which each stores how the winding numbers in
// front of it differ from those in front of its parent. A ray from each root to infinity determines
// the winding numbers there.

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "geom/boolean/work.h"
#include "geom/mesh/edges.h"

#define STOP_INTERVAL 4096 // edges or rays between checks of the stop flag

typedef int32_t Winding[2];

// A piece at an edge.
typedef struct Leaf {
  uint32_t piece;
  bool forward; // it runs along the edge from the lower to the higher point
  int half;     // sector of the full turn that starts at the first leaf: 0 the first leaf, 1, 2
                // opposite, 3
} Leaf;

typedef struct Forest {
  BoolWork *w;
  uint32_t *parent;
  Winding *more; // winding in front of a piece, minus that in front of its parent
} Forest;

// --- The forest ---

// Returns the root, with path compression; *more becomes relative to the root.
static uint32_t find_root(Forest *f, uint32_t i) {
  uint32_t root = i;
  Winding sum = {0, 0};
  for (; f->parent[root] != root; root = f->parent[root])
    for (int k = 0; k < 2; k++) sum[k] += f->more[root][k];
  while (f->parent[i] != root && i != root) {
    const uint32_t next = f->parent[i];
    for (int k = 0; k < 2; k++) {
      const int32_t own = f->more[i][k];
      f->more[i][k] = sum[k];
      sum[k] -= own;
    }
    f->parent[i] = root;
    i = next;
  }
  return root;
}

// Records that the winding in front of `a` plus `at_a` equals that in front of `b` plus `at_b`.
static void tie(Forest *f, uint32_t a, const Winding at_a, uint32_t b, const Winding at_b) {
  const uint32_t root_a = find_root(f, a), root_b = find_root(f, b);
  if (root_a == root_b) return;
  for (int k = 0; k < 2; k++) {
    const int32_t in_a = a == root_a ? 0 : f->more[a][k], in_b = b == root_b ? 0 : f->more[b][k];
    f->more[root_b][k] = in_a + at_a[k] - in_b - at_b[k];
  }
  f->parent[root_b] = root_a;
}

// --- Around an edge ---

static const uint32_t *plane_of(const BoolWork *w, uint32_t piece) {
  return w->faces[bool_pieces(w)[piece].plane].plane;
}

// The sign of the sine of the angle from one leaf to the other about the edge's direction. Both
// planes contain the edge, so the cross product of their normals is parallel to it.
static int sine(BoolWork *w, const Leaf *a, const Leaf *b, int axis, int along) {
  const int s =
      cag_bool_normals_cross(&w->points, plane_of(w, a->piece), plane_of(w, b->piece), axis);
  return a->forward == b->forward ? s * along : -s * along;
}

static int cosine(BoolWork *w, const Leaf *a, const Leaf *b) {
  const int c = cag_bool_normals_dot(&w->points, plane_of(w, a->piece), plane_of(w, b->piece));
  return a->forward == b->forward ? c : -c;
}

// A coordinate in which the edge's ends differ.
static int direction(BoolWork *w, uint32_t a, uint32_t b, int *along) {
  const CagVec3 d = cag_sub(w->points.at[b], w->points.at[a]);
  const double x = fabs(d.x), y = fabs(d.y), z = fabs(d.z);
  const int first = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
  for (int k = 0; k < 3; k++) {
    *along = cag_bool_compare(&w->points, a, b, (first + k) % 3);
    if (*along) return (first + k) % 3;
  }
  return first;
}

static void sort_leaves(BoolWork *w, uint32_t low, uint32_t high, Leaf *leaf, size_t n) {
  int along;
  const int axis = direction(w, low, high, &along);
  leaf[0].half = 0;
  for (size_t i = 1; i < n; i++) {
    const int s = sine(w, &leaf[0], &leaf[i], axis, along);
    leaf[i].half = s > 0 ? 1 : s < 0 ? 3 : cosine(w, &leaf[0], &leaf[i]) > 0 ? 0 : 2;
  }
  for (size_t i = 2; i < n; i++) {
    const Leaf moving = leaf[i];
    size_t k = i;
    for (; k > 1; k--) {
      const Leaf *before = &leaf[k - 1];
      if (before->half < moving.half) break;
      if (before->half == moving.half && sine(w, before, &moving, axis, along) >= 0) break;
      leaf[k] = *before;
    }
    leaf[k] = moving;
  }
}

// A piece that runs along the edge forward has its front on the counter-clockwise side.
static void side_of(const BoolWork *w, const Leaf *l, bool after, Winding out) {
  const BoolPiece *p = &bool_pieces(w)[l->piece];
  const bool front = l->forward == after;
  for (int k = 0; k < 2; k++) out[k] = front ? 0 : p->times[k];
}

static void tie_leaves(Forest *f, const Leaf *leaf, size_t n) {
  for (size_t i = 0; i < n; i++) {
    const Leaf *a = &leaf[i], *b = &leaf[(i + 1) % n];
    Winding after, before;
    side_of(f->w, a, true, after);
    side_of(f->w, b, false, before);
    tie(f, a->piece, after, b->piece, before);
  }
}

static size_t uses_of(const CagMeshEdge *e, size_t left) {
  size_t n = 1;
  while (n < left && e[n].low == e[0].low && e[n].high == e[0].high) n++;
  return n;
}

static CagStatus tie_edges(Forest *f, const CagMeshEdge *edges, size_t n) {
  BoolWork *w = f->w;
  BoolList leaves = {0};
  CagStatus status = CAG_OK;
  for (size_t i = 0, uses, edge = 0; !status && i < n; i += uses) {
    uses = uses_of(edges + i, n - i);
    if (!cag_bool_list_reserve(&leaves, uses, sizeof(Leaf))) {
      status = cag_fail_memory(w->err);
      break;
    }
    Leaf *leaf = leaves.items;
    for (size_t k = 0; k < uses; k++)
      leaf[k] = (Leaf){(uint32_t)cag_mesh_edge_triangle(&edges[i + k]),
                       cag_mesh_edge_forward(&edges[i + k]), 0};
    if (uses > 2) sort_leaves(w, edges[i].low, edges[i].high, leaf, uses);
    tie_leaves(f, leaf, uses);
    if (edge++ % STOP_INTERVAL == 0) status = cag_bool_stopped(w);
  }
  cag_free(leaves.items);
  return status;
}

static CagStatus tie_pieces(Forest *f) {
  BoolWork *w = f->w;
  const size_t count = w->pieces.n;
  uint32_t *triangles = cag_malloc((3 * count + 1) * sizeof *triangles);
  if (!triangles) return cag_fail_memory(w->err);
  for (size_t i = 0; i < count; i++)
    memcpy(triangles + 3 * i, bool_pieces(w)[i].v, 3 * sizeof *triangles);
  size_t n = 0;
  CagMeshEdge *edges = cag_mesh_edges(triangles, count, NULL, w->points.n, &n);
  cag_free(triangles);
  const CagStatus status = edges ? tie_edges(f, edges, n) : cag_fail_memory(w->err);
  cag_free(edges);
  return status;
}

// --- Rays ---

// A ray along x from `from`, perturbed a little along y and far less along z, so that it hits no
// edge.
typedef struct Ray {
  BoolWork *w;
  uint32_t from;
  Winding sum; // of the spaces it leaves, minus those it enters
} Ray;

// The side of the line a, b, seen along x, on which the perturbed ray is.
static int side_of_ray(const Ray *r, uint32_t a, uint32_t b) {
  const int side = cag_bool_turn(&r->w->points, a, b, r->from, 0);
  if (side) return side;
  const int rise = cag_bool_compare(&r->w->points, a, b, 2);
  return rise ? -rise : cag_bool_compare(&r->w->points, a, b, 1);
}

static bool cross_face(void *context, uint32_t face) {
  Ray *r = context;
  const BoolFace *f = &r->w->faces[face];
  const int seen = cag_bool_normal_sign(&r->w->points, f->plane, 0);
  if (seen == 0) return true;
  for (int k = 0; k < 3; k++)
    if (side_of_ray(r, f->v[k], f->v[(k + 1) % 3]) != seen) return true;
  // The face is ahead of the start: it faces +x with the start behind it, or the reverse.
  if (cag_bool_side(&r->w->points, f->plane, r->from) * seen >= 0) return true;
  for (int k = 0; k < 2; k++) r->sum[k] += seen * f->times[k];
  return true;
}

// The winding in front of a piece. The ray starts at the centroid of the piece, on its +x side; for
// a piece parallel to x, on the side towards which the ray is perturbed.
static bool cast_ray(BoolWork *w, uint32_t piece, Winding front) {
  const BoolPiece *p = &bool_pieces(w)[piece];
  Ray r = {w, cag_bool_points_centroid(&w->points, p->v), {0, 0}};
  if (r.from == BOOL_NONE) return false;
  CagBounds ahead = {w->points.at[r.from], w->points.at[r.from]};
  ahead.max.x = INFINITY;
  cag_box_tree_meeting(&w->tree, &ahead, cross_face, &r);
  int facing = 0;
  for (int axis = 0; axis < 3 && facing == 0; axis++)
    facing = cag_bool_normal_sign(&w->points, plane_of(w, piece), axis);
  for (int k = 0; k < 2; k++) front[k] = r.sum[k] - (facing > 0 ? 0 : p->times[k]);
  return true;
}

static CagStatus wind_pieces(Forest *f) {
  BoolWork *w = f->w;
  CagStatus status = CAG_OK;
  for (uint32_t i = 0; !status && i < w->pieces.n; i++) {
    if (f->parent[i] != i) continue;
    if (!cast_ray(w, i, w->winding[i])) return cag_fail_memory(w->err);
    status = cag_bool_stopped(w);
  }
  for (uint32_t i = 0; !status && i < w->pieces.n; i++) {
    const uint32_t root = find_root(f, i);
    for (int k = 0; k < 2 && root != i; k++) w->winding[i][k] = w->winding[root][k] + f->more[i][k];
  }
  return status;
}

CagStatus cag_bool_find_windings(BoolWork *w) {
  const size_t n = w->pieces.n + 1;
  Forest f = {w, cag_malloc(n * sizeof *f.parent), cag_calloc(n, sizeof *f.more)};
  w->winding = cag_malloc(n * sizeof *w->winding);
  CagStatus status = CAG_OK;
  if (!f.parent || !f.more || !w->winding) status = cag_fail_memory(w->err);
  for (uint32_t i = 0; !status && i < w->pieces.n; i++) f.parent[i] = i;
  if (!status) status = tie_pieces(&f);
  if (!status) status = wind_pieces(&f);
  cag_free(f.parent);
  cag_free(f.more);
  return status;
}
