// Chains the boundary edges of an arrangement to loops with the region to the left.
//
// If several loops pass through one corner, each continues with the first edge clockwise from its
// incoming edge: the region lies between the two. A chain that returns to a corner is split off
// there as a separate loop, so no loop passes a corner twice, and loops touch but never cross.

#include "geom/curve/region_chain.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "geom/curve/family.h"

#define NOWHERE ((size_t)-1)

typedef struct Chain {
  const CagRegionPieces *s;
  const CagRegionEdge *edges;
  const CagVec3 *corners;
  size_t n;                // kept edges
  size_t *kept;            // their indices, sorted by the corner where they start
  size_t *starts;          // corner v: kept[starts[v] .. starts[v + 1] - 1]
  bool *used;              // indexed like `kept`
  size_t *path, path_size; // indices into `kept`
  size_t *position;        // for each corner: position in the path of the edge that leaves it; or
                           // none
  size_t *loops;           // indices into `kept`, loop by loop
  size_t *loop_ends;       // end of each loop in `loops`
  size_t loop_count, loop_size;
} Chain;

static size_t edge_start(const CagRegionEdge *e) { return e->keep > 0 ? e->from : e->to; }
static size_t edge_end(const CagRegionEdge *e) { return e->keep > 0 ? e->to : e->from; }

static CagStatus undecided(const Chain *c, size_t corner, CagError *err) {
  char x[32], y[32];
  return cag_fail(err, CAG_E_CONVERGENCE, CAG_ERR_region_undecided, "", -1,
                  "the boundaries run so close to each other near [%s, %s] that rounding hides "
                  "which is in front; move one of the regions by a little more than that, or make "
                  "them share the edge exactly",
                  cag_number_text(c->corners[corner].x, x),
                  cag_number_text(c->corners[corner].y, y));
}

// --- The next edge at a corner ---

// The point of the edge at the given distance from its start (or its end).
static CagStatus point_near(const Chain *c, const CagRegionEdge *e, bool at_end, double distance,
                            CagVec3 *out, CagError *err) {
  return cag_region_piece_at_distance(c->s, &c->s->items[e->piece], e->a, e->b,
                                      at_end == (e->keep > 0), distance, out, err);
}

static double chord(const Chain *c, const CagRegionEdge *e) {
  const CagVec3 p = c->corners[e->from], q = c->corners[e->to];
  return hypot(q.x - p.x, q.y - p.y);
}

// The unused edge that starts where `in` ends, first clockwise from it. Edges move away from a
// corner monotonically and do not intersect within the length of the shortest of them, so their
// order is the same on any smaller circle about it.
static CagStatus successor(const Chain *c, const CagRegionEdge *in, size_t *out, CagError *err) {
  const double part = 0.5; // of the shortest edge
  const size_t v = edge_end(in);
  size_t candidates = 0;
  double radius = chord(c, in);
  *out = NOWHERE;
  for (size_t i = c->starts[v]; i < c->starts[v + 1]; i++) {
    if (c->used[i]) continue;
    candidates++;
    *out = i;
    radius = fmin(radius, chord(c, &c->edges[c->kept[i]]));
  }
  if (candidates < 2) return CAG_OK;
  CagVec3 back, there;
  CagStatus status = point_near(c, in, true, part * radius, &back, err);
  if (status) return status;
  const CagVec3 center = c->corners[v];
  const double from = atan2(back.y - center.y, back.x - center.x);
  double least = INFINITY;
  for (size_t i = c->starts[v]; i < c->starts[v + 1]; i++) {
    if (c->used[i]) continue;
    status = point_near(c, &c->edges[c->kept[i]], false, part * radius, &there, err);
    if (status) return status;
    double turn = from - atan2(there.y - center.y, there.x - center.x);
    if (turn <= 0) turn += 2 * M_PI;
    if (turn >= least) continue;
    least = turn;
    *out = i;
  }
  return CAG_OK;
}

// Splits off the loop that starts at position i of the path.
static void cut_off(Chain *c, size_t i) {
  for (size_t k = i; k < c->path_size; k++) {
    c->position[edge_start(&c->edges[c->kept[c->path[k]]])] = NOWHERE;
    c->loops[c->loop_size++] = c->path[k];
  }
  c->path_size = i;
  c->loop_ends[c->loop_count++] = c->loop_size;
}

static CagStatus walk(Chain *c, size_t first, CagError *err) {
  size_t at = first;
  for (;;) {
    const CagRegionEdge *e = &c->edges[c->kept[at]];
    const size_t v = edge_end(e);
    c->used[at] = true;
    c->position[edge_start(e)] = c->path_size;
    c->path[c->path_size++] = at;
    if (c->position[v] != NOWHERE) cut_off(c, c->position[v]);
    if (c->path_size == 0) return CAG_OK;
    CagStatus status = successor(c, e, &at, err);
    if (status) return status;
    if (at == NOWHERE) return undecided(c, v, err);
  }
}

static CagStatus chain_new(Chain *c, const CagRegionEdge *edges, size_t n, size_t corners,
                           CagError *err) {
  for (size_t i = 0; i < n; i++) c->n += edges[i].keep != 0;
  c->kept = cag_malloc(sizeof *c->kept * (c->n + 1));
  c->starts = cag_calloc(corners + 2, sizeof *c->starts);
  c->used = cag_calloc(c->n + 1, sizeof *c->used);
  c->path = cag_malloc(sizeof *c->path * (c->n + 1));
  c->position = cag_malloc(sizeof *c->position * (corners + 1));
  c->loops = cag_malloc(sizeof *c->loops * (c->n + 1));
  c->loop_ends = cag_malloc(sizeof *c->loop_ends * (c->n + 1));
  if (!c->kept || !c->starts || !c->used || !c->path || !c->position || !c->loops || !c->loop_ends)
    return cag_fail_memory(err);
  for (size_t i = 0; i < n; i++)
    if (edges[i].keep) c->starts[edge_start(&edges[i]) + 2]++;
  for (size_t v = 2; v < corners + 2; v++) c->starts[v] += c->starts[v - 1];
  for (size_t i = 0; i < n; i++)
    if (edges[i].keep) c->kept[c->starts[edge_start(&edges[i]) + 1]++] = i;
  for (size_t v = 0; v < corners; v++) c->position[v] = NOWHERE;
  return CAG_OK;
}

// At each corner as many kept edges end as start, if the winding numbers are consistent.
static CagStatus check_balance(const Chain *c, size_t corners, CagError *err) {
  long *balance = cag_calloc(corners + 1, sizeof *balance);
  if (!balance) return cag_fail_memory(err);
  for (size_t i = 0; i < c->n; i++) {
    balance[edge_start(&c->edges[c->kept[i]])]++;
    balance[edge_end(&c->edges[c->kept[i]])]--;
  }
  CagStatus status = CAG_OK;
  for (size_t v = 0; !status && v < corners; v++)
    if (balance[v] != 0) status = undecided(c, v, err);
  cag_free(balance);
  return status;
}

static void chain_free(Chain *c) {
  cag_free(c->kept);
  cag_free(c->starts);
  cag_free(c->used);
  cag_free(c->path);
  cag_free(c->position);
  cag_free(c->loops);
  cag_free(c->loop_ends);
}

// --- Curves of a loop ---

static const CagRegionEdge *loop_edge(const Chain *c, const size_t *loop, size_t i) {
  return &c->edges[c->kept[loop[i]]];
}

static const CagCurve *walk_curve(const Chain *c, const CagRegionEdge *e) {
  return c->s->walks[c->s->items[e->piece].walk].curve;
}

// Whether edge f continues along the curve of edge e at its end; `seam`: also from the end of a
// closed curve to its start.
static bool goes_on(const Chain *c, const CagRegionEdge *e, const CagRegionEdge *f, bool seam) {
  const CagRegionPiece *p = &c->s->items[e->piece], *q = &c->s->items[f->piece];
  if (p->walk != q->walk || e->keep != f->keep) return false;
  const CagCurve *curve = c->s->walks[p->walk].curve;
  const double from = e->keep > 0 ? e->b : e->a, to = f->keep > 0 ? f->a : f->b;
  if (from == to) return true;
  return seam && curve->closed && fmin(from, to) == curve->start && fmax(from, to) == curve->end;
}

// Ends this close, as a fraction of the size of their coordinates, are joined without moving them.
#define JOINS 1e-10

static bool joins(CagVec3 p, CagVec3 q) {
  const CagVec3 both[2] = {p, q};
  return cag_norm(cag_sub(p, q)) <= JOINS * cag_curve_size(both, 2);
}

// The curve with its ends moved to the given points by a similarity, so lines, arcs, and others
// keep their kinds. Ends that are close enough to be joined are not moved, nor are the ends of
// curves that would then move farther elsewhere, such as one that returns to near its start.
static CagStatus fit_ends(CagCurve **curve, CagVec3 from, CagVec3 to, double tolerance,
                          CagError *err) {
  const double most = 4; // tolerances: each end moves by at most one
  CagVec3 p, q;
  CagStatus status = cag_curve_point(*curve, (*curve)->start, &p, err);
  if (!status) status = cag_curve_point(*curve, (*curve)->end, &q, err);
  if (status) return status;
  if (joins(p, from) && joins(q, to)) return CAG_OK;
  // Complex factor (to - from) / (q - p).
  const CagVec3 old = cag_sub(q, p), new = cag_sub(to, from);
  const double square = cag_dot(old, old);
  const CagBounds box = (*curve)->kind->hull(*curve, (*curve)->start, (*curve)->end);
  const double size = cag_norm(cag_sub(box.max, box.min));
  if (!(cag_norm(cag_sub(new, old)) * size <= most * tolerance * sqrt(square))) return CAG_OK;
  const double re = cag_dot(old, new) / square, im = cag_cross(old, new).z / square;
  CagTransform t = cag_transform_identity();
  t.m[0][0] = t.m[1][1] = re;
  t.m[1][0] = im;
  t.m[0][1] = -im;
  t.m[0][3] = from.x - (re * p.x - im * p.y);
  t.m[1][3] = from.y - (im * p.x + re * p.y);
  t.planar = true;
  CagCurve *moved;
  status = cag_curve_transform(*curve, &t, &moved, err);
  if (status) return status;
  cag_curve_release(*curve);
  *curve = moved;
  return CAG_OK;
}

// Whether edge f continues straight from e, which starts at p or on the way from p: both belong to
// one segment, and the corner between them, if others met there, was not moved off it.
static bool runs_on(const Chain *c, CagVec3 p, const CagRegionEdge *e, const CagRegionEdge *f) {
  const double moved = 1e-3; // tolerances
  if (c->s->items[e->piece].source != c->s->items[f->piece].source) return false;
  const CagVec3 between = cag_sub(c->corners[edge_end(e)], p),
                d = cag_sub(c->corners[edge_end(f)], p);
  return fabs(d.x * between.y - d.y * between.x) <= moved * c->s->tolerance * hypot(d.x, d.y) &&
         cag_dot(d, between) > 0;
}

// A sequence of segments, without the corners at which others met them.
static CagStatus straight_run(const Chain *c, const size_t *loop, size_t n, CagCurve **out,
                              CagError *err) {
  CagVec3 *p = cag_malloc(sizeof *p * (n + 1));
  if (!p) return cag_fail_memory(err);
  size_t m = 0;
  for (size_t i = 0; i < n; i++) {
    const CagRegionEdge *e = loop_edge(c, loop, i);
    if (i == 0) p[m++] = c->corners[edge_start(e)];
    if (i + 1 < n && runs_on(c, p[m - 1], e, loop_edge(c, loop, i + 1))) continue;
    p[m++] = c->corners[edge_end(e)];
  }
  CagStatus status = m == 2 ? cag_curve_line(p[0], p[1], 2, out, err)
                            : cag_curve_polyline(p, m, false, 2, out, err);
  cag_free(p);
  return status;
}

// Edges first .. first + n - 1 of a loop, which follow each other on one curve.
static CagStatus run_curve(const Chain *c, const size_t *loop, size_t n, CagCurve **out,
                           CagError *err) {
  const CagRegionEdge *e = loop_edge(c, loop, 0), *f = loop_edge(c, loop, n - 1);
  const CagCurve *curve = walk_curve(c, e);
  const CagVec3 *vertices;
  size_t count;
  bool ring;
  if (cag_curve_vertices(curve, &vertices, &count, &ring))
    return straight_run(c, loop, n, out, err);
  const bool forward = e->keep > 0;
  const double a = forward ? e->a : f->a, b = forward ? f->b : e->b;
  // A tiny bent piece, or the remainder of one.
  if ((n == 1 && c->s->items[e->piece].straight) ||
      !(b - a > DBL_EPSILON * 8 * fmax(fabs(a), fabs(b))))
    return cag_curve_line(c->corners[edge_start(e)], c->corners[edge_end(f)], 2, out, err);
  CagCurve *part;
  CagStatus status = cag_curve_trim(curve, a, b, &part, err);
  if (status) return status;
  if (!forward) {
    CagCurve *turned;
    status = cag_curve_reverse(part, &turned, err);
    cag_curve_release(part);
    if (status) return status;
    part = turned;
  }
  status =
      fit_ends(&part, c->corners[edge_start(e)], c->corners[edge_end(f)], c->s->tolerance, err);
  if (status) cag_curve_release(part);
  else *out = part;
  return status;
}

// A loop that is a whole closed curve.
static CagStatus whole_curve(const Chain *c, const CagRegionEdge *e, CagCurve **out,
                             CagError *err) {
  const CagCurve *curve = walk_curve(c, e);
  if (e->keep < 0) return cag_curve_reverse(curve, out, err);
  *out = cag_curve_retain(curve);
  return CAG_OK;
}

// A loop that is a single run is split in two parts, so that it is closed like any other.
static size_t run_length(const Chain *c, const size_t *loop, size_t i, size_t n) {
  size_t k = 1;
  while (i + k < n && goes_on(c, loop_edge(c, loop, i + k - 1), loop_edge(c, loop, i + k), false))
    k++;
  return i == 0 && k == n ? n / 2 : k;
}

// Inserts a line before the last run if it does not start at the end of the previous one.
static CagStatus close_gap(CagCurve **runs, size_t *count, CagError *err) {
  CagCurve *last = runs[*count - 1], *before = runs[*count - 2];
  CagVec3 p, q;
  CagStatus status = cag_curve_point(before, before->end, &p, err);
  if (!status) status = cag_curve_point(last, last->start, &q, err);
  if (status || joins(p, q)) return status;
  status = cag_curve_line(p, q, 2, &runs[*count - 1], err);
  if (status) runs[*count - 1] = last;
  else runs[(*count)++] = last;
  return status;
}

// The same between the last run and the first.
static CagStatus close_end(CagCurve **runs, size_t *count, CagError *err) {
  CagVec3 p, q;
  CagStatus status = cag_curve_point(runs[*count - 1], runs[*count - 1]->end, &p, err);
  if (!status) status = cag_curve_point(runs[0], runs[0]->start, &q, err);
  if (status || joins(p, q)) return status;
  status = cag_curve_line(p, q, 2, &runs[*count], err);
  *count += !status;
  return status;
}

static CagStatus loop_curve(const Chain *c, size_t *loop, size_t n, CagCurve **out, CagError *err) {
  // Rotates the loop so that it starts with a run.
  size_t first = n;
  bool whole = true;
  for (size_t i = 0; i < n; i++) {
    const CagRegionEdge *before = loop_edge(c, loop, (i + n - 1) % n), *e = loop_edge(c, loop, i);
    if (first == n && !goes_on(c, before, e, false)) first = i;
    whole = whole && goes_on(c, before, e, true);
  }
  if (whole) return whole_curve(c, loop_edge(c, loop, 0), out, err);
  if (first == n) first = 0;
  size_t *turned = cag_malloc(sizeof *turned * n);
  CagCurve **runs = cag_malloc(sizeof *runs * (2 * n + 1));
  CagStatus status = turned && runs ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++) turned[i] = loop[(first + i) % n];
  size_t count = 0;
  for (size_t i = 0, k; !status && i < n; i += k) {
    k = run_length(c, turned, i, n);
    status = run_curve(c, turned + i, k, &runs[count], err);
    count += !status;
    if (!status && i > 0) status = close_gap(runs, &count, err);
  }
  if (!status) status = close_end(runs, &count, err);
  if (!status) status = cag_curve_join(runs, count, out, err);
  for (size_t i = 0; i < count; i++) cag_curve_release(runs[i]);
  cag_free(runs);
  cag_free(turned);
  return status;
}

// --- Nesting of holes ---

// Area and perimeter of the polygon of the loop's corners and the midpoints of its edges.
static CagStatus loop_measure(const Chain *c, const size_t *loop, size_t n, double *area,
                              double *perimeter, CagError *err) {
  *area = *perimeter = 0;
  const CagVec3 origin = c->corners[edge_start(loop_edge(c, loop, 0))];
  for (size_t i = 0; i < n; i++) {
    const CagRegionEdge *e = loop_edge(c, loop, i);
    const CagVec3 p = cag_sub(c->corners[edge_start(e)], origin),
                  q = cag_sub(c->corners[edge_end(e)], origin);
    CagVec3 m;
    CagStatus status =
        cag_region_piece_point(c->s, &c->s->items[e->piece], e->a + (e->b - e->a) / 2, &m, err);
    if (status) return status;
    m = cag_sub(m, origin);
    *area += (p.x * m.y - p.y * m.x + m.x * q.y - m.y * q.x) / 2;
    *perimeter += hypot(m.x - p.x, m.y - p.y) + hypot(q.x - m.x, q.y - m.y);
  }
  return CAG_OK;
}

typedef struct Loop {
  size_t *edges, n;
  double area;
  CagBounds box;
  size_t around; // for a hole: the loop around it
} Loop;

// Whether the loop contains the point, which is not on it.
static CagStatus runs_around(const Chain *c, const Loop *loop, CagVec3 p, bool *out,
                             CagError *err) {
  *out = false;
  if (p.y < loop->box.min.y || p.y > loop->box.max.y || p.x > loop->box.max.x) return CAG_OK;
  for (size_t i = 0; i < loop->n; i++) {
    const CagRegionEdge *e = loop_edge(c, loop->edges, i);
    const CagVec3 u = c->corners[e->from], v = c->corners[e->to];
    if ((u.y <= p.y) == (v.y <= p.y) || fmax(u.x, v.x) < p.x - c->s->tolerance) continue;
    if (fmin(u.x, v.x) <= p.x + c->s->tolerance) {
      double t;
      CagVec3 there;
      CagStatus status =
          cag_region_piece_at(c->s, &c->s->items[e->piece], e->a, e->b, 1, p.y, &t, &there, err);
      if (status) return status;
      if (there.x <= p.x) continue;
    }
    *out = !*out;
  }
  return CAG_OK;
}

// A point on the loop well suited for a ray along +x: the middle in y of its tallest edge.
static CagStatus probe(const Chain *c, const Loop *loop, CagVec3 *out, CagError *err) {
  const CagRegionEdge *tallest = NULL;
  double height = -1;
  for (size_t i = 0; i < loop->n; i++) {
    const CagRegionEdge *e = loop_edge(c, loop->edges, i);
    const double h = fabs(c->corners[e->to].y - c->corners[e->from].y);
    if (h <= height) continue;
    height = h;
    tallest = e;
  }
  const double y = (c->corners[tallest->from].y + c->corners[tallest->to].y) / 2;
  double t;
  return cag_region_piece_at(c->s, &c->s->items[tallest->piece], tallest->a, tallest->b, 1, y, &t,
                             out, err);
}

static CagStatus find_around(const Chain *c, Loop *loops, size_t n, size_t i, CagError *err) {
  CagVec3 p;
  CagStatus status = probe(c, &loops[i], &p, err);
  loops[i].around = NOWHERE;
  for (size_t k = 0; !status && k < n; k++) {
    bool within;
    if (loops[k].area < 0) continue;
    if (loops[i].around != NOWHERE && loops[k].area > loops[loops[i].around].area) continue;
    status = runs_around(c, &loops[k], p, &within, err);
    if (!status && within) loops[i].around = k;
  }
  if (!status && loops[i].around == NOWHERE)
    return undecided(c, edge_start(loop_edge(c, loops[i].edges, 0)), err);
  return status;
}

// Loops thinner than the tolerance are dropped.
static CagStatus collect_loops(const Chain *c, Loop *loops, size_t *count, CagError *err) {
  size_t begin = 0;
  *count = 0;
  for (size_t i = 0; i < c->loop_count; i++) {
    Loop *l = &loops[*count];
    double perimeter;
    *l = (Loop){.edges = c->loops + begin, .n = c->loop_ends[i] - begin, .box = CAG_BOUNDS_EMPTY};
    begin = c->loop_ends[i];
    CagStatus status = loop_measure(c, l->edges, l->n, &l->area, &perimeter, err);
    if (status) return status;
    if (fabs(l->area) <= c->s->thin * perimeter) continue;
    for (size_t k = 0; k < l->n; k++)
      cag_bounds_add(&l->box, c->corners[loop_edge(c, l->edges, k)->from]);
    for (size_t k = 0; k < l->n; k++)
      cag_bounds_add(&l->box, c->corners[loop_edge(c, l->edges, k)->to]);
    (*count)++;
  }
  return CAG_OK;
}

// The loops as curves, each outer one followed by its holes.
static CagStatus emit(const Chain *c, Loop *loops, size_t n, CagRegion **out, CagError *err) {
  CagCurve **curves = cag_calloc(n, sizeof *curves);
  size_t *outer = cag_malloc(sizeof *outer * n);
  CagStatus status = curves && outer ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++)
    if (loops[i].area < 0) status = find_around(c, loops, n, i, err);
  size_t used = 0;
  for (size_t i = 0; !status && i < n; i++) {
    if (loops[i].area < 0) continue;
    const size_t first = used;
    for (size_t k = 0; !status && k <= n; k++) {
      const size_t which = k == 0 ? i : k - 1;
      if (k > 0 && (loops[which].area > 0 || loops[which].around != i)) continue;
      status = loop_curve(c, loops[which].edges, loops[which].n, &curves[used], err);
      outer[used] = first;
      used += !status;
    }
  }
  if (!status) status = cag_region_take(curves, outer, used, out, err);
  else
    for (size_t i = 0; i < used; i++) cag_curve_release(curves[i]);
  cag_free(curves);
  cag_free(outer);
  return status;
}

CagStatus cag_region_chain(const CagRegionPieces *s, const CagRegionEdge *edges, size_t n,
                           const CagVec3 *corners, size_t corner_count, CagRegion **out,
                           CagError *err) {
  Chain c = {.s = s, .edges = edges, .corners = corners};
  *out = NULL;
  CagStatus status = chain_new(&c, edges, n, corner_count, err);
  if (!status) status = check_balance(&c, corner_count, err);
  for (size_t i = 0; !status && i < c.n; i++)
    if (!c.used[i]) status = walk(&c, i, err);
  Loop *loops = status ? NULL : cag_malloc(sizeof *loops * (c.loop_count + 1));
  if (!status && !loops) status = cag_fail_memory(err);
  size_t count = 0;
  if (!status) status = collect_loops(&c, loops, &count, err);
  if (!status && count > 0) status = emit(&c, loops, count, out, err);
  cag_free(loops);
  chain_free(&c);
  return status;
}
