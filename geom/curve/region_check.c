// Crossings and overlaps of the loops of a region.
//
// Crossings are searched on polygons far finer than any drawing. Loops whose polygons cross or
// touch may do neither (circles that touch), or may share an edge and lie on both sides of it
// (identical loops). Set operations of their insides decide these cases.

#include "geom/curve/region_check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/sort.h"
#include "base/stop.h"
#include "geom/curve/region.h"
#include "geom/linalg/tolerance.h"

// Chord tolerance of the polygons, as a fraction of the size.
#define CROSSING_TOLERANCE 1e-5
#define CROSSING_ANGLE (M_PI / 18)
// Edges closer than this fraction of the total size touch.
#define TOUCH CAG_COINCIDENT

CagStatus cag_region_check_closed(const CagCurve *c, const char *argument, long index,
                                  CagError *err) {
  char which[64] = "the outer boundary";
  if (index >= 0) snprintf(which, sizeof which, "%.30s[%ld]", argument, index);
  if (c->dimension != 2)
    return cag_fail(
        err, CAG_E_ARGUMENT, CAG_ERR_not_planar, argument, index,
        "%s is a space curve; a region must be bounded by plane curves, with points [x, y]", which);
  if (c->closed) return CAG_OK;
  CagVec3 p, q;
  CagStatus status = cag_curve_point(c, c->start, &p, err);
  if (!status) status = cag_curve_point(c, c->end, &q, err);
  if (status) return status;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_region_not_closed, argument, index,
                  "%s is not closed: it runs from [%.9g, %.9g] to [%.9g, %.9g], %.3g apart", which,
                  p.x, p.y, q.x, q.y, cag_norm(cag_sub(p, q)));
}

static double loop_size(const CagCurve *c) {
  CagBounds b = c->kind->hull(c, c->start, c->end);
  return cag_norm(cag_sub(b.max, b.min));
}

typedef struct Edge {
  CagVec3 p, q;
  double min_x, max_x;
  size_t loop, index, count; // edge `index` of `count` of its loop
} Edge;

typedef struct Edges {
  Edge *items;
  size_t n, capacity;
} Edges;

static CagStatus add_edges(const CagCurve *c, size_t loop, Edges *edges, CagError *err) {
  double *t;
  size_t n;
  CagStatus status =
      cag_curve_discretize(c, CROSSING_TOLERANCE * loop_size(c), CROSSING_ANGLE, &t, &n, err);
  if (status) return status;
  CagVec3 *p = cag_malloc(sizeof *p * n);
  status = p ? cag_curve_eval_many(c, t, n, 0, p, err) : cag_fail_memory(err);
  if (!status && !CAG_RESERVE(edges->items, edges->capacity, edges->n + n))
    status = cag_fail_memory(err);
  if (!status) p[n - 1] = p[0];
  for (size_t i = 0; !status && i + 1 < n; i++)
    edges->items[edges->n++] =
        (Edge){p[i], p[i + 1], fmin(p[i].x, p[i + 1].x), fmax(p[i].x, p[i + 1].x), loop, i, n - 1};
  cag_free(p);
  cag_free(t);
  return status;
}

static int by_min_x(const void *a, const void *b) {
  double x = ((const Edge *)a)->min_x, y = ((const Edge *)b)->min_x;
  return (x > y) - (x < y);
}

static double side(CagVec3 a, CagVec3 b, CagVec3 p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

// Whether edges cross in their interiors; touching is not crossing.
static bool cross(const Edge *e, const Edge *f) {
  if (fmax(e->p.y, e->q.y) < fmin(f->p.y, f->q.y) || fmax(f->p.y, f->q.y) < fmin(e->p.y, e->q.y))
    return false;
  if (e->loop == f->loop) {
    size_t gap = e->index > f->index ? e->index - f->index : f->index - e->index;
    if (gap == 1 || gap == e->count - 1) return false;
  }
  return side(e->p, e->q, f->p) * side(e->p, e->q, f->q) < 0 &&
         side(f->p, f->q, e->p) * side(f->p, f->q, e->q) < 0;
}

// The intersection of two edges that cross.
static CagVec3 crossing_of(const Edge *e, const Edge *f) {
  const double s = side(f->p, f->q, e->p), t = side(f->p, f->q, e->q);
  return cag_lerp(e->p, e->q, s / (s - t));
}

static double distance_to(const Edge *e, CagVec3 p) {
  const CagVec3 d = cag_sub(e->q, e->p), r = cag_sub(p, e->p);
  const double dd = cag_dot(d, d), t = dd > 0 ? fmin(1, fmax(0, cag_dot(r, d) / dd)) : 0;
  return cag_norm(cag_sub(r, cag_scaled(d, t)));
}

static bool touch(const Edge *e, const Edge *f, double slack) {
  if (fmax(e->p.y, e->q.y) < fmin(f->p.y, f->q.y) - slack ||
      fmax(f->p.y, f->q.y) < fmin(e->p.y, e->q.y) - slack)
    return false;
  return distance_to(e, f->p) <= slack || distance_to(e, f->q) <= slack ||
         distance_to(f, e->p) <= slack || distance_to(f, e->q) <= slack;
}

// --- Pairs of loops ---

// How messages name loops: holes[i] are the loops after the outer boundary, curves[i] all of them.
typedef struct Loops {
  CagCurve *const *items;
  size_t n;
  bool holes;
} Loops;

typedef struct Pair {
  size_t a, b; // loops whose polygons cross or touch, a < b
  bool cross;
  CagVec3 at; // where they cross
} Pair;

typedef struct Pairs {
  Pair *items;
  size_t n, capacity;
} Pairs;

static CagStatus add_pair(Pairs *s, const Edge *e, const Edge *f, bool crosses, CagError *err) {
  Pair pair = {.a = e->loop < f->loop ? e->loop : f->loop,
               .b = e->loop < f->loop ? f->loop : e->loop,
               .cross = crosses};
  if (crosses) pair.at = crossing_of(e, f);
  if (!CAG_RESERVE(s->items, s->capacity, s->n + 1)) return cag_fail_memory(err);
  s->items[s->n++] = pair;
  return CAG_OK;
}

static int by_loops(const void *a, const void *b) {
  const Pair *p = a, *q = b;
  if (p->a != q->a) return p->a > q->a ? 1 : -1;
  if (p->b != q->b) return p->b > q->b ? 1 : -1;
  if (p->cross != q->cross) return p->cross ? -1 : 1;
  if (p->at.x != q->at.x) return p->at.x > q->at.x ? 1 : -1;
  return (p->at.y > q->at.y) - (p->at.y < q->at.y);
}

static CagStatus fail_itself(const Loops *l, size_t loop, CagVec3 at, CagError *err) {
  const char *name = l->holes ? "holes" : "curves";
  if (l->holes && loop == 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_region_crossing, "C", -1,
                    "the boundary crosses itself near [%.6g, %.6g]", at.x, at.y);
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_region_crossing, name, (long)(loop - l->holes),
                  "%s[%zu] crosses itself near [%.6g, %.6g]", name, loop - l->holes, at.x, at.y);
}

static CagStatus fail_crossing(const Loops *l, const Pair *p, CagError *err) {
  const char *name = l->holes ? "holes" : "curves";
  if (l->holes && p->a == 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_region_crossing, name, (long)p->b - 1,
                    "holes[%zu] crosses the outer boundary near [%.6g, %.6g]; boundaries of a "
                    "region must not cross",
                    p->b - 1, p->at.x, p->at.y);
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_region_crossing, name, (long)(p->b - l->holes),
                  "%s[%zu] and %s[%zu] cross near [%.6g, %.6g]; boundaries of a region must not "
                  "cross",
                  name, p->a - l->holes, name, p->b - l->holes, p->at.x, p->at.y);
}

// Edges compared with an edge between checks of the stop flag.
#define EDGES_BETWEEN_LOOKS ((size_t)1 << 12)

// Fails if a loop crosses itself; collects pairs of loops that cross or touch.
static CagStatus search_edges(const Loops *l, Edges *edges, Pairs *pairs, CagError *err) {
  CagBounds box = CAG_BOUNDS_EMPTY;
  for (size_t i = 0; i < edges->n; i++) cag_bounds_add(&box, edges->items[i].p);
  const double slack = TOUCH * cag_norm(cag_sub(box.max, box.min));
  CagStatus status = cag_sort(edges->items, edges->n, sizeof(Edge), by_min_x, err);
  for (size_t i = 0; !status && i < edges->n; i++) {
    const Edge *e = &edges->items[i];
    status = cag_stop_check(err);
    for (size_t k = i + 1; !status && k < edges->n; k++) {
      const Edge *f = &edges->items[k];
      if (f->min_x > e->max_x + slack) break;
      if ((k - i) % EDGES_BETWEEN_LOOKS == 0 && cag_stop_check(err)) return err->status;
      const bool crosses = cross(e, f);
      if (crosses && e->loop == f->loop) status = fail_itself(l, e->loop, crossing_of(e, f), err);
      else if (e->loop != f->loop && (crosses || touch(e, f, slack)))
        status = add_pair(pairs, e, f, crosses, err);
    }
  }
  return status;
}

// --- Insides of loops that touch ---

// Whether the result of a set operation of the insides of two loops is not empty.
static CagStatus leaves(CagRegionOp op, const CagCurve *a, const CagCurve *b, bool *out,
                        CagError *err) {
  CagRegion *r[2] = {NULL}, *left = NULL;
  CagStatus status = cag_region_new(a, NULL, 0, &r[0], err);
  if (!status) status = cag_region_new(b, NULL, 0, &r[1], err);
  if (!status) status = cag_region_boolean(op, r[0], r[1], &left, err);
  *out = !status && !cag_region_is_empty(left);
  for (int i = 0; i < 2; i++) cag_region_release(r[i]);
  cag_region_release(left);
  return status;
}

static CagStatus check_hole(const Loops *l, const Pair *p, CagError *err) {
  const size_t hole = p->b;
  bool outside, rest;
  CagStatus status = leaves(CAG_REGION_DIFFERENCE, l->items[hole], l->items[0], &outside, err);
  if (status) return status;
  if (outside && p->cross) return fail_crossing(l, p, err);
  if (outside)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_hole_outside, "holes", (long)hole - 1,
                    "holes[%zu] does not lie within the outer boundary", hole - 1);
  status = leaves(CAG_REGION_DIFFERENCE, l->items[0], l->items[hole], &rest, err);
  if (status || rest) return status;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_hole_outside, "holes", (long)hole - 1,
                  "holes[%zu] and the outer boundary are the same curve: nothing lies between them",
                  hole - 1);
}

static CagStatus fail_overlap(const Loops *l, const Pair *p, const char *how, CagError *err) {
  const char *name = l->holes ? "holes" : "curves";
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_region_crossing, name, (long)(p->b - l->holes),
                  "%s[%zu] and %s[%zu] %s", name, p->a - l->holes, name, p->b - l->holes, how);
}

static CagStatus check_pair(const Loops *l, const Pair *p, CagError *err) {
  if (l->holes && p->a == 0) return check_hole(l, p, err);
  const CagCurve *a = l->items[p->a], *b = l->items[p->b];
  bool common, of_a, of_b;
  CagStatus status = leaves(CAG_REGION_INTERSECTION, a, b, &common, err);
  if (status || !common) return status;
  status = leaves(CAG_REGION_DIFFERENCE, a, b, &of_a, err);
  if (!status) status = leaves(CAG_REGION_DIFFERENCE, b, a, &of_b, err);
  if (status) return status;
  if (!of_a && !of_b) return fail_overlap(l, p, "are the same curve; omit one of them", err);
  if (of_a && of_b && p->cross) return fail_crossing(l, p, err);
  if (l->holes) return fail_overlap(l, p, "overlap; holes must be disjoint: unite them first", err);
  if (!of_a || !of_b) return CAG_OK; // one lies inside the other
  return fail_overlap(l, p, "overlap; one must lie within the other, or apart from it", err);
}

static CagStatus check(const Loops *l, CagError *err) {
  Edges edges = {0};
  Pairs pairs = {0};
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < l->n; i++) status = add_edges(l->items[i], i, &edges, err);
  if (!status) status = search_edges(l, &edges, &pairs, err);
  cag_free(edges.items);
  if (pairs.n) qsort(pairs.items, pairs.n, sizeof *pairs.items, by_loops);
  for (size_t i = 0; !status && i < pairs.n; i++) {
    const Pair *p = &pairs.items[i];
    if (i == 0 || p[-1].a != p->a || p[-1].b != p->b) status = check_pair(l, p, err);
  }
  cag_free(pairs.items);
  return status;
}

CagStatus cag_region_check_holes(CagCurve *const *loops, size_t n, CagError *err) {
  const Loops l = {loops, n, true};
  return check(&l, err);
}

CagStatus cag_region_check_loops(CagCurve *const *loops, size_t n, CagError *err) {
  const Loops l = {loops, n, false};
  return check(&l, err);
}
