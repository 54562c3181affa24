// Tessellation of planar trimmed faces: their loops as points, the points as triangles.
//
// Where a loop is the edge of other faces of a solid, it uses exactly the nodes of their sides;
// where it meets other planar faces its edges are straight, and their corners are united in the
// end. No interior points are added, since the face is flat.

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/linalg/tolerance.h"
#include "geom/tessellate/tessellation.h"

// Points of the loops in order: positions in space; for those from other faces their vertex.
typedef struct Outline {
  CagVec3 *points;
  uint32_t *vertices;
  size_t count, capacity;
} Outline;

// A side of another face that runs along the loop.
typedef struct Piece {
  const Line *line;
  bool used;
} Piece;

static CagStatus add_point(Outline *o, CagVec3 point, uint32_t vertex, CagError *err) {
  if (o->count == o->capacity) {
    size_t n = o->capacity ? 2 * o->capacity : 256;
    if (!CAG_RESIZE(o->points, n) || !CAG_RESIZE(o->vertices, n)) return cag_fail_memory(err);
    o->capacity = n;
  }
  o->points[o->count] = point;
  o->vertices[o->count++] = vertex;
  return CAG_OK;
}

// A vertex of the node at an index.
static uint32_t node_vertex(const Tessellator *t, size_t at) {
  const Node *node = &t->nodes[at];
  return node->corner != NO_INDEX ? t->corners[node->corner].quadrant[3] : node->vertex[1];
}

static uint32_t node_root(Tessellator *t, const Line *line, bool last) {
  return cag_tess_find(t, node_vertex(t, line->node + (last ? line->node_count - 1 : 0)));
}

// --- Loops that are edges of other faces ---

// Lines of the sides along the loop; *n of them, malloc'd.
static CagStatus find_pieces(const Tessellator *t, const CagFaces *faces, uint32_t face, int side,
                             Piece **out, size_t *n, CagError *err) {
  *n = 0;
  Piece *pieces = cag_malloc((faces->edge_count + 1) * sizeof *pieces);
  if (!pieces) return cag_fail_memory(err);
  for (size_t e = 0; e < faces->edge_count; e++)
    for (int k = 0; k < 2; k++) {
      const CagFaceEdge *edge = &faces->edges[e];
      if (edge->face[k] != face || edge->side[k] != side) continue;
      uint32_t line = cag_tess_side_line(t, (uint32_t)edge->face[1 - k], edge->side[1 - k]);
      if (line != NO_INDEX) pieces[(*n)++] = (Piece){&t->lines[line], false};
    }
  *out = pieces;
  return CAG_OK;
}

static bool is_same(Tessellator *t, uint32_t a, uint32_t b) {
  return a != NO_INDEX && b != NO_INDEX && cag_tess_find(t, a) == cag_tess_find(t, b);
}

// Appends the nodes of a piece, from its start or from its end; the last one is left to the next
// piece if that begins there.
static CagStatus append_piece(Tessellator *t, Outline *o, size_t first, const Line *line,
                              bool backwards, CagError *err) {
  for (size_t k = 0; k < line->node_count; k++) {
    size_t at = line->node + (backwards ? line->node_count - 1 - k : k);
    const uint32_t v = cag_tess_find(t, node_vertex(t, at));
    if (o->count > first && is_same(t, o->vertices[o->count - 1], v)) continue;
    CagStatus status = add_point(o, t->positions[v], v, err);
    if (status) return status;
  }
  // The loop closes on its first point.
  while (o->count > first + 1 && is_same(t, o->vertices[o->count - 1], o->vertices[first]))
    o->count--;
  return CAG_OK;
}

// Chains the pieces: each time the one with an end nearest to the current end. Ends that differ
// only by rounding are merged.
static CagStatus outline_of_pieces(Tessellator *t, Outline *o, Piece *pieces, size_t n,
                                   CagError *err) {
  const double rounding = 1e-7; // of the size
  size_t first = o->count;
  CagStatus status = append_piece(t, o, first, pieces[0].line, false, err);
  uint32_t end = node_root(t, pieces[0].line, true);
  for (size_t done = 1; !status && done < n; done++) {
    size_t best = 0;
    bool backwards = false;
    double least = INFINITY;
    for (size_t k = 1; k < n; k++)
      for (int last = 0; last < 2 && !pieces[k].used; last++) {
        CagVec3 gap = cag_sub(t->positions[node_root(t, pieces[k].line, last)], t->positions[end]);
        if (cag_norm(gap) >= least) continue;
        least = cag_norm(gap);
        best = k;
        backwards = last;
      }
    pieces[best].used = true;
    if (least <= rounding * t->size)
      cag_tess_unite(t, end, node_root(t, pieces[best].line, backwards));
    status = append_piece(t, o, first, pieces[best].line, backwards, err);
    end = node_root(t, pieces[best].line, !backwards);
  }
  uint32_t start = node_root(t, pieces[0].line, false);
  if (n > 1 && cag_norm(cag_sub(t->positions[start], t->positions[end])) <= rounding * t->size)
    cag_tess_unite(t, start, end);
  while (o->count > first + 1 && is_same(t, o->vertices[o->count - 1], o->vertices[first]))
    o->count--;
  return status;
}

// Whether the ends of the pieces meet in pairs.
static bool do_chain(Tessellator *t, const Piece *pieces, size_t n, double slack) {
  for (size_t i = 0; i < 2 * n; i++) {
    const CagVec3 p = t->positions[node_root(t, pieces[i / 2].line, i % 2)];
    bool met = false;
    for (size_t k = 0; k < 2 * n && !met; k++)
      met = k != i &&
            cag_norm(cag_sub(t->positions[node_root(t, pieces[k / 2].line, k % 2)], p)) <= slack;
    if (!met) return false;
  }
  return true;
}

// The second node of a piece, from its start or from its end.
static CagVec3 second_point(const Tessellator *t, const Line *line, bool backwards) {
  return t->positions[node_vertex(t, line->node + (backwards ? line->node_count - 2 : 1))];
}

// The unused piece that begins (*backwards: ends) at p.
static Piece *piece_from(Tessellator *t, Piece *pieces, size_t n, CagVec3 p, double slack,
                         bool *backwards) {
  for (size_t k = 0; k < n; k++)
    for (int last = 0; last < 2 && !pieces[k].used; last++) {
      const CagVec3 from = t->positions[node_root(t, pieces[k].line, last)];
      if (cag_norm(cag_sub(from, p)) > slack) continue;
      *backwards = last;
      return &pieces[k];
    }
  return NULL;
}

// A loop and its corners: its start, its breaks, and its end.
typedef struct Loop {
  const CagCurve *curve;
  CagTransform frame, back;
  double *at;
  CagVec3 *corners;
  size_t n;
} Loop;

// The unused piece that begins (*backwards: ends) at a corner of the loop and runs along the loop
// from there; NULL if there is none. At an acute corner the previous side has nearly the same
// direction, so the position on the loop decides.
static CagStatus piece_at(Tessellator *t, Piece *pieces, size_t n, const Loop *loop, size_t corner,
                          double slack, Piece **out, bool *backwards, CagError *err) {
  *out = NULL;
  for (size_t k = 0; k < n; k++)
    for (int last = 0; last < 2 && !pieces[k].used; last++) {
      const Line *line = pieces[k].line;
      const CagVec3 from = t->positions[node_root(t, line, last)];
      if (cag_norm(cag_sub(from, loop->corners[corner])) > slack) continue;
      const CagVec3 next = second_point(t, line, last);
      double at, distance;
      CagVec3 nearest;
      CagStatus status = cag_curve_closest(loop->curve, cag_transform_point(&loop->back, next), &at,
                                           &nearest, &distance, err);
      if (status) return status;
      const bool ends = cag_norm(cag_sub(next, loop->corners[corner + 1])) <= slack;
      if (!ends && !(at > loop->at[corner] && at < loop->at[corner + 1])) continue;
      *backwards = last;
      *out = &pieces[k];
      return CAG_OK;
    }
  return CAG_OK;
}

// The point of the loop at a break, in space.
static CagStatus loop_point(const CagCurve *curve, const CagTransform *frame, double at,
                            CagVec3 *out, CagError *err) {
  CagStatus status = cag_curve_point(curve, at, out, err);
  if (!status) *out = cag_transform_point(frame, *out);
  return status;
}

// Appends a piece; its first point may be there already.
static CagStatus append_from(Tessellator *t, Outline *o, size_t first, const Piece *piece,
                             bool backwards, double slack, CagError *err) {
  const uint32_t from = node_root(t, piece->line, backwards);
  if (o->count > first && cag_norm(cag_sub(o->points[o->count - 1], t->positions[from])) <= slack) {
    if (o->vertices[o->count - 1] != NO_INDEX) cag_tess_unite(t, o->vertices[o->count - 1], from);
    o->count--;
  }
  return append_piece(t, o, first, piece->line, backwards, err);
}

// Appends the pieces that follow each other from break *k on, and moves *k to the break where they
// end.
static CagStatus append_run(Tessellator *t, Outline *o, size_t first, const CagVec3 *corners,
                            size_t n_corners, Piece *pieces, size_t n, Piece *piece, bool backwards,
                            double slack, size_t *k, CagError *err) {
  CagStatus status = CAG_OK;
  while (piece && !status) {
    piece->used = true;
    const CagVec3 reached = t->positions[node_root(t, piece->line, !backwards)];
    status = append_from(t, o, first, piece, backwards, slack, err);
    for (size_t j = *k + 1; j < n_corners; j++)
      if (cag_norm(cag_sub(corners[j], reached)) <= slack) {
        *k = j;
        return status;
      }
    piece = piece_from(t, pieces, n, reached, slack, &backwards);
  }
  ++*k;
  return status;
}

static void close_outline(Tessellator *t, Outline *o, size_t first, double slack) {
  if (o->count < first + 2 || cag_norm(cag_sub(o->points[o->count - 1], o->points[first])) > slack)
    return;
  uint32_t *start = &o->vertices[first], last = o->vertices[o->count - 1];
  if (*start == NO_INDEX) *start = last;
  else cag_tess_unite(t, *start, last);
  o->count--;
}

static CagStatus find_corners(Loop *loop, CagError *err) {
  const CagCurve *curve = loop->curve;
  const size_t breaks = curve->kind->breaks(curve, NULL, 0);
  loop->n = breaks + 2;
  loop->at = cag_malloc(loop->n * sizeof *loop->at);
  loop->corners = cag_malloc(loop->n * sizeof *loop->corners);
  if (!loop->at || !loop->corners) return cag_fail_memory(err);
  loop->at[0] = curve->start;
  curve->kind->breaks(curve, loop->at + 1, breaks);
  loop->at[breaks + 1] = curve->end;
  CagStatus status = cag_transform_inverse(&loop->frame, &loop->back, err);
  for (size_t k = 0; !status && k < loop->n; k++)
    status = loop_point(curve, &loop->frame, loop->at[k], &loop->corners[k], err);
  return status;
}

// Number of steps between two points that keeps edges short enough. Both faces at a straight edge
// compute the same number.
static size_t steps_between(const Tessellator *t, CagVec3 p, CagVec3 q) {
  const double rounding = CAG_COINCIDENT;
  if (!(t->how.max_edge > 0)) return 1;
  const double n = ceil(cag_norm(cag_sub(q, p)) / t->how.max_edge * (1 - rounding));
  return n > 1 ? (size_t)n : 1;
}

static CagStatus check_count(const Tessellator *t, const Outline *o, CagError *err) {
  if ((double)o->count <= (double)t->how.max_triangles + 2) return CAG_OK;
  return cag_tess_limit(t, (double)o->count, err);
}

// The straight edge from p to q without its end.
static CagStatus append_edge(const Tessellator *t, Outline *o, size_t first, CagVec3 p, CagVec3 q,
                             double slack, CagError *err) {
  const size_t n = steps_between(t, p, q);
  const bool there = o->count > first && cag_norm(cag_sub(o->points[o->count - 1], p)) <= slack;
  CagStatus status = CAG_OK;
  for (size_t k = there; !status && k < n; k++) {
    status = add_point(o, cag_lerp(p, q, (double)k / (double)n), NO_INDEX, err);
    if (!status) status = check_count(t, o, err);
  }
  return status;
}

// Follows the loop: pieces where they begin, else its own straight edges.
static CagStatus outline_between(Tessellator *t, Outline *o, const CagCurve *curve,
                                 const CagTransform *frame, Piece *pieces, size_t n, double slack,
                                 CagError *err) {
  const size_t first = o->count;
  Loop loop = {.curve = curve, .frame = *frame};
  CagStatus status = find_corners(&loop, err);
  for (size_t i = 0; i < n; i++) pieces[i].used = false;
  for (size_t k = 0; !status && k + 1 < loop.n;) {
    bool backwards = false;
    Piece *piece;
    status = piece_at(t, pieces, n, &loop, k, slack, &piece, &backwards, err);
    if (status) break;
    if (piece) {
      status = append_run(t, o, first, loop.corners, loop.n, pieces, n, piece, backwards, slack, &k,
                          err);
      continue;
    }
    status = append_edge(t, o, first, loop.corners[k], loop.corners[k + 1], slack, err);
    k++;
  }
  cag_free(loop.at);
  cag_free(loop.corners);
  if (!status) close_outline(t, o, first, slack);
  return status;
}

// --- Loops without adjacent faces ---

// The largest factor by which the frame lengthens: the larger singular value of its x and y.
static double largest_scale(const CagTransform *frame) {
  const CagVec3 x = cag_vec3(frame->m[0][0], frame->m[1][0], frame->m[2][0]),
                y = cag_vec3(frame->m[0][1], frame->m[1][1], frame->m[2][1]);
  const double xx = cag_dot(x, x), yy = cag_dot(y, y), xy = cag_dot(x, y);
  const double scale = sqrt((xx + yy) / 2 + hypot((xx - yy) / 2, xy));
  return scale > 0 ? scale : 1;
}

// The last point of a closed curve equals the first one, and is left out.
static CagStatus outline_of_curve(const Tessellator *t, Outline *o, const CagCurve *curve,
                                  const CagTransform *frame, CagError *err) {
  double *at;
  size_t n;
  double scale = largest_scale(frame), angle = t->how.angle > 0 ? t->how.angle : M_PI / 2;
  const double tolerance = t->how.tolerance / scale;
  CagStatus status = cag_curve_discretize_short(curve, tolerance, angle,
                                                t->how.short_edge * tolerance, &at, &n, err);
  if (status) return status;
  for (size_t k = 0; !status && k + 1 < n; k++) {
    CagVec3 p, q;
    status = cag_curve_point(curve, at[k], &p, err);
    if (!status) status = cag_curve_point(curve, at[k + 1], &q, err);
    if (status) break;
    const size_t parts =
        steps_between(t, cag_transform_point(frame, p), cag_transform_point(frame, q));
    for (size_t j = 0; !status && j < parts; j++) {
      if (j > 0) status = cag_curve_point(curve, tess_mix(at[k], at[k + 1], j, parts), &p, err);
      if (!status) status = add_point(o, cag_transform_point(frame, p), NO_INDEX, err);
    }
    if (!status) status = check_count(t, o, err);
  }
  cag_free(at);
  return status;
}

// --- The face ---

static CagStatus outline_of_loop(Tessellator *t, Outline *o, uint32_t face, size_t loop,
                                 const CagFaces *faces, const CagCurve *curve,
                                 const CagTransform *frame, CagError *err) {
  Piece *pieces = NULL;
  size_t n = 0;
  CagStatus status = CAG_OK;
  if (faces) status = find_pieces(t, faces, face, (int)loop + 4, &pieces, &n, err);
  const double rounding = 4e-6; // of the size: edges of shells gape by 1e-6 at most
  if (!status && n == 0) status = outline_of_curve(t, o, curve, frame, err);
  else if (!status && !do_chain(t, pieces, n, rounding * t->size) && curve->kind->breaks)
    status = outline_between(t, o, curve, frame, pieces, n, rounding * t->size, err);
  else if (!status) status = outline_of_pieces(t, o, pieces, n, err);
  cag_free(pieces);
  return status;
}

// Makes separate vertices for the outline's points (their normal differs from that of the
// neighbors), with x and y of the region as parameters.
static CagStatus own_vertices(Tessellator *t, const Outline *o, const CagTransform *frame,
                              double *xy, uint32_t *vertices, CagError *err) {
  CagTransform back;
  CagStatus status = cag_transform_inverse(frame, &back, err);
  CagVec3 x = cag_vec3(frame->m[0][0], frame->m[1][0], frame->m[2][0]),
          y = cag_vec3(frame->m[0][1], frame->m[1][1], frame->m[2][1]);
  CagVec3 normal = cag_unit(cag_cross(x, y));
  for (size_t k = 0; !status && k < o->count; k++) {
    CagVec3 flat = cag_transform_point(&back, o->points[k]);
    xy[2 * k] = flat.x;
    xy[2 * k + 1] = flat.y;
    status = cag_tess_new_vertex(t, o->points[k], normal, flat.x, flat.y, &vertices[k], err);
    if (!status) cag_tess_unite(t, o->vertices[k], vertices[k]);
    if (!status && o->vertices[k] == NO_INDEX)
      status =
          CAG_RESERVE(t->own, t->own_capacity, t->own_count + 1) ? CAG_OK : cag_fail_memory(err);
    if (!status && o->vertices[k] == NO_INDEX) t->own[t->own_count++] = vertices[k];
  }
  return status;
}

static CagStatus triangulate_outline(Tessellator *t, Face *f, const Outline *o,
                                     const size_t *counts, size_t loops, const CagTransform *frame,
                                     CagError *err) {
  double *xy = cag_malloc((2 * o->count + 1) * sizeof *xy);
  uint32_t *vertices = cag_malloc((o->count + 1) * sizeof *vertices);
  CagStatus status =
      xy && vertices ? own_vertices(t, o, frame, xy, vertices, err) : cag_fail_memory(err);
  if (!status) status = cag_triangulate(xy, counts, loops, &f->triangles, &f->triangle_count, err);
  for (size_t k = 0; !status && k < 3 * f->triangle_count; k++)
    f->triangles[k] = vertices[f->triangles[k]];
  cag_free(xy);
  cag_free(vertices);
  return status;
}

CagStatus cag_tess_planar_face(Tessellator *t, uint32_t face, const CagFaces *faces,
                               CagError *err) {
  Face *f = &t->faces[face];
  const CagRegion *region;
  CagTransform frame;
  if (!cag_surface_planar_view(f->surface, &region, &frame)) return CAG_OK;
  Outline o = {0};
  size_t *counts = cag_malloc((region->count + 1) * sizeof *counts), loops = 0;
  CagStatus status = counts ? CAG_OK : cag_fail_memory(err);
  for (size_t l = 0; !status && l < region->count; l++) {
    size_t before = o.count;
    status = outline_of_loop(t, &o, face, l, faces, region->loops[l], &frame, err);
    // Between the two pieces of a loop smaller than the tolerance there is nothing: they are one
    // edge of the adjacent faces.
    if (o.count - before < 3) o.count = before;
    else counts[loops++] = o.count - before;
  }
  if (!status && loops > 0) status = triangulate_outline(t, f, &o, counts, loops, &frame, err);
  cag_free(counts);
  cag_free(o.points);
  cag_free(o.vertices);
  return status;
}

// --- Corners between planar faces ---

typedef struct Place {
  CagVec3 at;
  uint32_t vertex;
} Place;

static int by_x(const void *a, const void *b) {
  const Place *p = a, *q = b;
  if (p->at.x != q->at.x) return p->at.x < q->at.x ? -1 : 1;
  return p->vertex < q->vertex ? -1 : p->vertex > q->vertex;
}

CagStatus cag_tess_unite_corners(Tessellator *t, CagError *err) {
  const double slack = 4e-6 * t->size; // edges of shells gape by 1e-6 at most
  if (t->own_count == 0) return CAG_OK;
  Place *places = cag_malloc((t->own_count + 2 * t->line_count) * sizeof *places);
  if (!places) return cag_fail_memory(err);
  size_t n = 0;
  for (size_t i = 0; i < t->own_count; i++) places[n++].vertex = t->own[i];
  for (size_t i = 0; i < t->line_count; i++)
    for (int last = 0; last < 2 && t->lines[i].border; last++)
      places[n++].vertex = node_root(t, &t->lines[i], last);
  for (size_t i = 0; i < n; i++) places[i].at = t->positions[places[i].vertex];
  qsort(places, n, sizeof *places, by_x);
  for (size_t i = 0; i < n; i++)
    for (size_t k = i + 1; k < n && places[k].at.x - places[i].at.x <= slack; k++)
      if (cag_norm(cag_sub(places[k].at, places[i].at)) <= slack)
        cag_tess_unite(t, places[i].vertex, places[k].vertex);
  cag_free(places);
  return CAG_OK;
}
