// Arrangements of plane curves, from which winding numbers select a region.
//
// The steps: monotone pieces (region_pieces.c); their intersections (region_meet.c); corners, which
// merge ends and intersections closer than the tolerance; edges between corners, where coincident
// edges are merged and their counts added; winding numbers on both sides of each edge, by a ray
// from its middle; the edges whose two sides differ by the rule, chained to loops with the region
// to their left (region_chain.c).
//
// Edges run from corner to corner, so moving the ends may cause new intersections. These are cut in
// turn until edges meet only at corners (as in snap rounding, Hobby 1999); only then do rays
// determine on which side of an edge another one lies.
//
// Every walk is a chain from corner to corner, so counts balance at each corner however points were
// moved: winding numbers remain those of closed curves.

#include "geom/curve/region_arrange.h"

#include <math.h>
#include <stdint.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/sort.h"
#include "base/stop.h"
#include "geom/curve/family.h"
#include "geom/curve/region_chain.h"
#include "geom/linalg/tolerance.h"

// Points closer than this fraction of the total size are identified, as for intersections.
#define SAME CAG_COINCIDENT
// Maximum number of times that edges are cut again after their ends were moved.
#define ROUNDS 16
// If rounding left loops open, the tolerance grows by a factor, up to a number of times.
#define GROWTH 8
#define ATTEMPTS 4

// --- Corners ---

typedef struct Corners {
  CagVec3 *points;
  size_t *next; // the next corner in the same cell of the grid
  size_t n, capacity;
  size_t *heads, buckets;
  double cell;
} Corners;

#define NOWHERE ((size_t)-1)

static size_t bucket(const Corners *c, double x, double y) {
  // Cells beyond the range of integers belong to coordinates whose spacing exceeds the cell size
  // anyway.
  const uint64_t i = (uint64_t)(int64_t)fmax(-9e18, fmin(9e18, x)),
                 k = (uint64_t)(int64_t)fmax(-9e18, fmin(9e18, y));
  uint64_t h = i * 0x9E3779B97F4A7C15u ^ (k + 0x7F4A7C15u) * 0xC2B2AE3D27D4EB4Fu;
  h ^= h >> 29;
  return (size_t)(h % c->buckets);
}

// Index of the corner at the point, added if there is none.
static CagStatus corner_at(Corners *c, CagVec3 p, double tolerance, size_t *out, CagError *err) {
  const double x = floor(p.x / c->cell), y = floor(p.y / c->cell);
  double best = tolerance;
  *out = NOWHERE;
  for (int i = -1; i <= 1; i++)
    for (int k = -1; k <= 1; k++)
      for (size_t v = c->heads[bucket(c, x + i, y + k)]; v != NOWHERE; v = c->next[v]) {
        const double d = hypot(c->points[v].x - p.x, c->points[v].y - p.y);
        if (d > best) continue;
        best = d;
        *out = v;
      }
  if (*out != NOWHERE) return CAG_OK;
  if (c->n == c->capacity) {
    const size_t capacity = 2 * c->capacity + 8;
    if (!CAG_RESIZE(c->points, capacity) || !CAG_RESIZE(c->next, capacity))
      return cag_fail_memory(err);
    c->capacity = capacity;
  }
  const size_t b = bucket(c, x, y);
  c->points[c->n] = p;
  c->next[c->n] = c->heads[b];
  c->heads[b] = c->n;
  *out = c->n++;
  return CAG_OK;
}

static CagStatus corners_new(Corners *c, size_t most, double tolerance, CagError *err) {
  *c = (Corners){.capacity = most, .buckets = 2 * most + 1, .cell = 2 * tolerance};
  c->points = cag_malloc(sizeof *c->points * (most + 1));
  c->next = cag_malloc(sizeof *c->next * (most + 1));
  c->heads = cag_malloc(sizeof *c->heads * c->buckets);
  if (!c->points || !c->next || !c->heads) return cag_fail_memory(err);
  for (size_t i = 0; i < c->buckets; i++) c->heads[i] = NOWHERE;
  return CAG_OK;
}

static void corners_free(Corners *c) {
  cag_free(c->points);
  cag_free(c->next);
  cag_free(c->heads);
}

// --- Edges ---

typedef struct Edges {
  CagRegionEdge *items;
  size_t n;
} Edges;

// Makes corners at the ends of the pieces. They come before intersections, so that intersections
// are moved to them and not vice versa.
static CagStatus make_corners(CagRegionPieces *s, Corners *corners, CagError *err) {
  CagStatus status = corners_new(corners, 2 * s->n, s->tolerance, err);
  for (size_t i = 0; !status && i < s->n; i++) {
    CagRegionPiece *piece = &s->items[i];
    status = corner_at(corners, piece->p, s->tolerance, &piece->from, err);
    if (!status) status = corner_at(corners, piece->q, s->tolerance, &piece->to, err);
  }
  return status;
}

// Cuts the pieces at their intersections; parts that shrink to a corner are dropped.
static CagStatus make_edges(const CagRegionPieces *s, const CagRegionCut *cuts, size_t cut_count,
                            Corners *corners, Edges *out, CagError *err) {
  out->items = cag_malloc(sizeof *out->items * (s->n + cut_count + 1));
  if (!out->items) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  size_t k = 0;
  for (size_t i = 0; !status && i < s->n; i++) {
    if ((status = cag_stop_check(err)) != CAG_OK) break;
    const CagRegionPiece *piece = &s->items[i];
    size_t from = piece->from, to = piece->to;
    double a = piece->a;
    for (bool last = false; !status && !last;) {
      last = k == cut_count || cuts[k].piece != i;
      const double b = last ? piece->b : cuts[k].t;
      if (last) to = piece->to;
      else status = corner_at(corners, cuts[k++].point, s->tolerance, &to, err);
      // A remainder at the end of a piece belongs to the edge before it.
      if (!status && last && from == to && a > piece->a) out->items[out->n - 1].b = b;
      if (status || from == to || (!(b > a) && !last)) continue;
      out->items[out->n++] =
          (CagRegionEdge){from, to, i, a, b, {piece->count[0], piece->count[1]}, 0};
      from = to;
      a = b;
    }
  }
  return status;
}

static int by_corners(const void *a, const void *b) {
  const CagRegionEdge *e = a, *f = b;
  const size_t e0 = e->from < e->to ? e->from : e->to, e1 = e->from < e->to ? e->to : e->from;
  const size_t f0 = f->from < f->to ? f->from : f->to, f1 = f->from < f->to ? f->to : f->from;
  if (e0 != f0) return e0 > f0 ? 1 : -1;
  if (e1 != f1) return e1 > f1 ? 1 : -1;
  if (e->piece != f->piece) return e->piece > f->piece ? 1 : -1;
  return (e->a > f->a) - (e->a < f->a);
}

static bool same_corners(const CagRegionEdge *e, const CagRegionEdge *f) {
  return (e->from == f->from && e->to == f->to) || (e->from == f->to && e->to == f->from);
}

// Whether two edges between the same corners coincide: three points of one are on the other,
// searched perpendicular to the line between the corners.
static CagStatus coincide(const CagRegionPieces *s, const CagRegionEdge *e, const CagRegionEdge *f,
                          bool *out, CagError *err) {
  const CagRegionPiece *p = &s->items[e->piece], *q = &s->items[f->piece];
  const double near = 8; // tolerances: both ends of both were moved by up to one, which may be
                         // amplified between them
  *out = true;
  if (p->straight && q->straight) return CAG_OK;
  for (int i = 1; *out && i < 4; i++) {
    const double t = e->a + (e->b - e->a) * i / 4;
    CagVec3 a, b[2];
    double u;
    CagStatus status = cag_region_piece_point(s, p, t, &a, err);
    for (int axis = 0; !status && axis < 2; axis++)
      status = cag_region_piece_at(s, q, f->a, f->b, axis, axis ? a.y : a.x, &u, &b[axis], err);
    if (status) return status;
    *out = fmin(hypot(a.x - b[0].x, a.y - b[0].y), hypot(a.x - b[1].x, a.y - b[1].y)) <=
           near * s->tolerance;
  }
  return CAG_OK;
}

// Merges coincident edges into the first of them; edges whose counts cancel are dropped.
static CagStatus join_alike(const CagRegionPieces *s, Edges *edges, CagError *err) {
  CagStatus status = cag_sort(edges->items, edges->n, sizeof *edges->items, by_corners, err);
  size_t kept = 0;
  for (size_t i = 0; !status && i < edges->n;) {
    size_t group = i;
    const size_t first = kept;
    for (; !status && group < edges->n && same_corners(&edges->items[i], &edges->items[group]);
         group++) {
      const CagRegionEdge e = edges->items[group];
      bool same = false;
      for (size_t k = first; !status && k < kept && !same; k++) {
        CagRegionEdge *f = &edges->items[k];
        status = coincide(s, f, &e, &same, err);
        if (status || !same) continue;
        const int sense = f->from == e.from ? 1 : -1;
        for (int o = 0; o < 2; o++) f->count[o] += sense * e.count[o];
      }
      if (!same) edges->items[kept++] = e;
    }
    i = group;
  }
  edges->n = kept;
  if (status) return status;
  kept = 0;
  for (size_t i = 0; i < edges->n; i++)
    if (edges->items[i].count[0] || edges->items[i].count[1])
      edges->items[kept++] = edges->items[i];
  edges->n = kept;
  return CAG_OK;
}

// --- Iterated cutting ---

// Edges no longer than this, in tolerances, are replaced by segments: their ends were moved by one
// tolerance each, and there may be no room for their parameters.
#define SPECK 4

// Converts edges to pieces, which run from corner to corner.
static CagStatus pieces_of_edges(CagRegionPieces *s, Edges *edges, const Corners *corners,
                                 CagError *err) {
  CagRegionPiece *items = cag_malloc(sizeof *items * (edges->n + 1));
  if (!items) return cag_fail_memory(err);
  for (size_t i = 0; i < edges->n; i++) {
    CagRegionEdge *e = &edges->items[i];
    items[i] = s->items[e->piece];
    items[i].a = e->a;
    items[i].b = e->b;
    items[i].p = corners->points[e->from];
    items[i].q = corners->points[e->to];
    items[i].from = e->from;
    items[i].to = e->to;
    items[i].part = NULL;
    for (int o = 0; o < 2; o++) items[i].count[o] = e->count[o];
    items[i].straight |=
        hypot(items[i].q.x - items[i].p.x, items[i].q.y - items[i].p.y) <= SPECK * s->tolerance;
    e->piece = i;
  }
  cag_region_pieces_free(s);
  s->items = items;
  s->n = s->capacity = edges->n;
  return CAG_OK;
}

// Cuts pieces at intersections, moves close points to corners, and cuts new intersections caused by
// that, until there are none.
static CagStatus cut_pieces(CagRegionPieces *s, Corners *corners, Edges *edges, CagError *err) {
  CagStatus status = make_corners(s, corners, err);
  for (int round = 0; !status && round < ROUNDS; round++) {
    CagRegionCut *cuts = NULL;
    size_t cut_count = 0;
    const size_t before = s->n;
    status = cag_region_pieces_meet(s, round > 0, &cuts, &cut_count, err);
    cag_free(edges->items);
    *edges = (Edges){0};
    if (!status) status = make_edges(s, cuts, cut_count, corners, edges, err);
    cag_free(cuts);
    const bool cut = edges->n != before;
    if (!status) status = join_alike(s, edges, err);
    if (!status) status = pieces_of_edges(s, edges, corners, err);
    if (round > 0 && !cut) break;
  }
  return status;
}

// --- Winding numbers ---

// The edges sorted into strips: axis 1 has strips in y, for rays along +x; axis 0 strips in x, for
// rays along +y.
typedef struct Strips {
  size_t n, *starts, *edges;
  double low, high;
} Strips;

#define STRIPS_MOST 512
#define EDGES_PER_STRIP 8

static double across(int axis, CagVec3 p) { return axis ? p.y : p.x; }

// Coordinate along the ray, in axes with the orientation of the plane: x for axis 1; y for axis 0,
// with strips in -x, which only reverses the sign of the count.
static double ahead(int axis, CagVec3 p) { return axis ? p.x : p.y; }

static size_t strip_of(const Strips *s, double value) {
  const double x = (value - s->low) / (s->high - s->low) * (double)s->n;
  if (!(x > 0)) return 0;
  return x >= (double)s->n ? s->n - 1 : (size_t)x;
}

static CagStatus strips_new(const Edges *edges, const Corners *corners, int axis, Strips *s,
                            CagError *err) {
  *s = (Strips){.n = edges->n / EDGES_PER_STRIP + 1, .low = INFINITY, .high = -INFINITY};
  if (s->n > STRIPS_MOST) s->n = STRIPS_MOST;
  for (size_t i = 0; i < corners->n; i++) {
    s->low = fmin(s->low, across(axis, corners->points[i]));
    s->high = fmax(s->high, across(axis, corners->points[i]));
  }
  s->starts = cag_calloc(s->n + 2, sizeof *s->starts);
  if (!s->starts) return cag_fail_memory(err);
  // Two passes over the edges: counts, then indices.
  for (int fill = 0; fill < 2; fill++) {
    for (size_t i = 0; i < edges->n; i++) {
      const double y0 = across(axis, corners->points[edges->items[i].from]),
                   y1 = across(axis, corners->points[edges->items[i].to]);
      const size_t last = strip_of(s, fmax(y0, y1));
      for (size_t k = strip_of(s, fmin(y0, y1)); k <= last; k++) {
        if (fill) s->edges[s->starts[k + 1]++] = i;
        else s->starts[k + 2]++;
      }
    }
    if (fill) break;
    for (size_t k = 2; k < s->n + 2; k++) s->starts[k] += s->starts[k - 1];
    s->edges = cag_malloc(sizeof *s->edges * (s->starts[s->n + 1] + 1));
    if (!s->edges) return cag_fail_memory(err);
  }
  return CAG_OK;
}

// The winding numbers next to edge `self` at the given fraction of it, on the side ahead along the
// ray. *clear: no other edge is so close there that rounding may have changed their order.
static CagStatus cast(const CagRegionPieces *s, const Edges *edges, const Corners *corners,
                      const Strips *strips, int axis, size_t self, double part, int winding[2],
                      bool *clear, CagError *err) {
  const double near = 4 * s->tolerance;
  const CagRegionEdge *e = &edges->items[self];
  const CagVec3 p = corners->points[e->from], q = corners->points[e->to];
  const double y = across(axis, p) + (across(axis, q) - across(axis, p)) * part;
  CagVec3 m;
  double t;
  CagStatus status = cag_region_piece_at(s, &s->items[e->piece], e->a, e->b, axis, y, &t, &m, err);
  if (status) return status;
  const double x = ahead(axis, m);
  winding[0] = winding[1] = 0;
  *clear = true;
  const size_t strip = strip_of(strips, y);
  for (size_t i = strips->starts[strip]; i < strips->starts[strip + 1]; i++) {
    if (strips->edges[i] == self) continue;
    const CagRegionEdge *f = &edges->items[strips->edges[i]];
    const CagVec3 u = corners->points[f->from], v = corners->points[f->to];
    const bool up = across(axis, u) <= y, stays = (across(axis, v) <= y) == up;
    const double x0 = ahead(axis, u), x1 = ahead(axis, v);
    if (stays || fmax(x0, x1) < x - near) continue;
    if (fmin(x0, x1) <= x + near) {
      CagVec3 there;
      status = cag_region_piece_at(s, &s->items[f->piece], f->a, f->b, axis, y, &t, &there, err);
      if (status) return status;
      const double gap = ahead(axis, there) - x;
      *clear = *clear && fabs(gap) > near;
      if (gap <= 0) continue;
    }
    // Strips in x are strips in -x reversed: upward is downward there.
    const int sense = up == (axis == 1) ? 1 : -1;
    for (int o = 0; o < 2; o++) winding[o] += sense * f->count[o];
  }
  return CAG_OK;
}

// The same at the first of some positions that is clear, else at the middle.
static CagStatus cast_clearly(const CagRegionPieces *s, const Edges *edges, const Corners *corners,
                              const Strips *strips, int axis, size_t self, int winding[2],
                              CagError *err) {
  static const double parts[] = {0.5, 0.27, 0.77, 0.11, 0.91, 0.03, 0.97};
  bool clear = false;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && !clear && i < sizeof parts / sizeof *parts; i++)
    status = cast(s, edges, corners, strips, axis, self, parts[i], winding, &clear, err);
  if (status || clear) return status;
  return cast(s, edges, corners, strips, axis, self, parts[0], winding, &clear, err);
}

// Sets `keep` of every edge: 1, the region is to the left; -1, to the right; 0, on both sides or
// neither.
static CagStatus classify(const CagRegionPieces *s, Edges *edges, const Corners *corners,
                          CagFaceRule rule, int parameter, CagError *err) {
  Strips strips[2] = {{0}, {0}};
  CagStatus status = strips_new(edges, corners, 0, &strips[0], err);
  if (!status) status = strips_new(edges, corners, 1, &strips[1], err);
  for (size_t i = 0; !status && i < edges->n; i++) {
    CagRegionEdge *e = &edges->items[i];
    const CagVec3 p = corners->points[e->from], q = corners->points[e->to];
    const int axis = fabs(q.y - p.y) >= fabs(q.x - p.x);
    int ray[2] = {0, 0}, left[2], right[2];
    status = cag_stop_check(err);
    if (!status) status = cast_clearly(s, edges, corners, &strips[axis], axis, i, ray, err);
    // For rays along +x the right side of an upward edge is ahead; for rays along +y the left side
    // of an edge towards +x.
    const bool right_ahead = axis ? q.y > p.y : q.x < p.x;
    for (int o = 0; o < 2; o++) {
      right[o] = right_ahead ? ray[o] : ray[o] - e->count[o];
      left[o] = right_ahead ? ray[o] + e->count[o] : ray[o];
    }
    e->keep = (int)rule(left, parameter) - (int)rule(right, parameter);
  }
  for (int axis = 0; axis < 2; axis++) {
    cag_free(strips[axis].starts);
    cag_free(strips[axis].edges);
  }
  return status;
}

// --- All together ---

static CagStatus attempt(const CagWalk *walks, size_t n, double tolerance, double thin,
                         CagFaceRule rule, int parameter, CagRegion **out, CagError *err) {
  CagRegionPieces pieces = {.walks = walks, .tolerance = tolerance, .thin = fmax(tolerance, thin)};
  Corners corners = {0};
  Edges edges = {0};
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < n; i++) status = cag_region_pieces_add(&pieces, i, err);
  if (!status) status = cut_pieces(&pieces, &corners, &edges, err);
  if (!status) status = classify(&pieces, &edges, &corners, rule, parameter, err);
  if (!status)
    status = cag_region_chain(&pieces, edges.items, edges.n, corners.points, corners.n, out, err);
  cag_free(edges.items);
  corners_free(&corners);
  cag_region_pieces_free(&pieces);
  return status;
}

// The distance within which points of the walks are identified.
static double same_distance(const CagWalk *walks, size_t n) {
  CagBounds box = CAG_BOUNDS_EMPTY;
  for (size_t i = 0; i < n; i++) {
    const CagCurve *c = walks[i].curve;
    const CagBounds one = c->kind->hull(c, c->start, c->end);
    cag_bounds_add(&box, one.min);
    cag_bounds_add(&box, one.max);
  }
  return fmax(SAME * cag_norm(cag_sub(box.max, box.min)), cag_curve_noise(&box));
}

CagStatus cag_region_arrange(const CagWalk *walks, size_t n, CagFaceRule rule, int parameter,
                             double thin, CagRegion **out, CagError *err) {
  double tolerance = same_distance(walks, n);
  CagStatus status = CAG_OK;
  *out = NULL;
  if (!(tolerance > 0)) return CAG_OK; // a single point
  for (int i = 0; i < ATTEMPTS; i++, tolerance *= GROWTH) {
    status = attempt(walks, n, tolerance, thin, rule, parameter, out, err);
    if (status != CAG_E_CONVERGENCE) break;
  }
  return status;
}

// --- Common points ---

static CagStatus share_corner(const Edges *edges, const Corners *corners, bool *out,
                              CagError *err) {
  unsigned char *operands = cag_calloc(corners->n + 1, sizeof *operands); // a bit for each
  *out = false;
  if (!operands) return cag_fail_memory(err);
  for (size_t i = 0; i < edges->n && !*out; i++) {
    const CagRegionEdge *e = &edges->items[i];
    const int which = (e->count[0] ? 1 : 0) | (e->count[1] ? 2 : 0);
    operands[e->from] |= which;
    operands[e->to] |= which;
    *out = operands[e->from] == 3 || operands[e->to] == 3;
  }
  cag_free(operands);
  return CAG_OK;
}

CagStatus cag_region_arrange_share(const CagWalk *walks, size_t n, bool *out, CagError *err) {
  CagRegionPieces pieces = {.walks = walks, .tolerance = same_distance(walks, n)};
  Corners corners = {0};
  Edges edges = {0};
  *out = false;
  if (!(pieces.tolerance > 0)) return CAG_OK;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < n; i++) status = cag_region_pieces_add(&pieces, i, err);
  if (!status) status = cut_pieces(&pieces, &corners, &edges, err);
  if (!status) status = share_corner(&edges, &corners, out, err);
  cag_free(edges.items);
  corners_free(&corners);
  cag_region_pieces_free(&pieces);
  return status;
}
