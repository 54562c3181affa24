// The part of a sheet of a quadric within half spaces: from cells of its parameter plane to
// surfaces.
//
// Cells that share a piece of a line of constant u are merged; the remaining pieces of those lines
// and the ends of the cells in v are the edges of the outline. They are followed with the inside on
// the left. If an outline is a rectangle, the piece is a plain patch; otherwise it is a patch
// trimmed by splines that interpolate the exact outline.

#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/surface/quadric_within.h"
#include "geom/surface/trimmed.h"

// Ends of cells at one place in u that are closer than this coincide.
#define SAME_VERTEX 1e-11

typedef struct Vertex {
  double u, v;
} Vertex;

typedef enum EdgeKind { EDGE_LOW, EDGE_HIGH, EDGE_ACROSS } EdgeKind;

typedef struct Edge {
  EdgeKind kind;
  size_t cell; // of low and high ones
  size_t from, to;
  bool used;
} Edge;

// The vertices of a cell: [at its left or right end][low or high].
typedef struct Ends {
  size_t at[2][2];
} Ends;

typedef struct Outline {
  const CagQuadricCells *c;
  Vertex *vertices;
  size_t vertex_count;
  Ends *ends;
  Edge *edges;
  size_t edge_count;
  size_t *path; // edges of the current loop
  size_t path_count;
} Outline;

static bool is_folded(const CagQuadricCells *c, const CagQuadricBound *b, size_t place) {
  return b->side >= 0 && (c->places[place].folds & (1u << b->side));
}

// --- Vertices and edges ---

typedef struct End {
  double v;
  size_t cell;
  int right, high; // which end of the cell
} End;

static int by_value(const void *a, const void *b) {
  const double x = ((const End *)a)->v, y = ((const End *)b)->v;
  return (x > y) - (x < y);
}

static void add_edge(Outline *o, EdgeKind kind, size_t cell, size_t from, size_t to) {
  o->edges[o->edge_count++] = (Edge){kind, cell, from, to, false};
}

// Whether a cell on that side of the place covers the line between two neighboring vertices.
static bool is_covered(const Outline *o, size_t place, int right_end, size_t vertex) {
  const CagQuadricCells *c = o->c;
  for (size_t i = 0; i < c->cell_count; i++)
    if (c->cells[i].place + (size_t)right_end == place && o->ends[i].at[right_end][0] <= vertex &&
        o->ends[i].at[right_end][1] > vertex)
      return true;
  return false;
}

// Adds the ends of the cells at a place as vertices, and the edges between them; false: an end at
// infinity.
static bool add_vertices(Outline *o, size_t place, End *ends) {
  const CagQuadricCells *c = o->c;
  size_t n = 0;
  for (size_t i = 0; i < c->cell_count; i++)
    for (int right = 0; right < 2; right++)
      for (int high = 0; c->cells[i].place + (size_t)right == place && high < 2; high++) {
        const CagQuadricBound *b = high ? &c->cells[i].high : &c->cells[i].low;
        const double v = cag_quadric_bound_at(c, b, c->places[place].u, is_folded(c, b, place));
        if (!isfinite(v)) return false;
        ends[n++] = (End){v, i, right, high};
      }
  qsort(ends, n, sizeof *ends, by_value);
  const size_t first = o->vertex_count;
  for (size_t i = 0; i < n; i++) {
    const double last = i ? o->vertices[o->vertex_count - 1].v : 0;
    if (i == 0 || ends[i].v - last > SAME_VERTEX * (1 + fabs(last)))
      o->vertices[o->vertex_count++] = (Vertex){c->places[place].u, ends[i].v};
    o->ends[ends[i].cell].at[ends[i].right][ends[i].high] = o->vertex_count - 1;
  }
  for (size_t i = first; i + 1 < o->vertex_count; i++) {
    const bool before = is_covered(o, place, 1, i), behind = is_covered(o, place, 0, i);
    if (before && !behind) add_edge(o, EDGE_ACROSS, 0, i, i + 1);
    if (behind && !before) add_edge(o, EDGE_ACROSS, 0, i + 1, i);
  }
  return true;
}

static bool add_all(Outline *o, End *room) {
  const CagQuadricCells *c = o->c;
  for (size_t k = 0; k < c->place_count; k++)
    if (!add_vertices(o, k, room)) return false;
  for (size_t i = 0; i < c->cell_count; i++) {
    add_edge(o, EDGE_LOW, i, o->ends[i].at[0][0], o->ends[i].at[1][0]);
    add_edge(o, EDGE_HIGH, i, o->ends[i].at[1][1], o->ends[i].at[0][1]);
  }
  return true;
}

// --- Loops ---

// Directions at a vertex, clockwise.
enum { LEFT, UP, RIGHT, DOWN };

static int direction_of(const Edge *e) {
  if (e->kind == EDGE_ACROSS) return e->to > e->from ? UP : DOWN;
  return e->kind == EDGE_HIGH ? LEFT : RIGHT;
}

// Clockwise angle from the arriving edge: from none, via the other edge of a cell that ends in the
// vertex, to a full turn.
static int turned(const Edge *arrives, const Edge *e) {
  const bool along = arrives->kind != EDGE_ACROSS && e->kind != EDGE_ACROSS;
  if (along && e->kind != arrives->kind && e->cell == arrives->cell) return 0;
  return (direction_of(e) - direction_of(arrives) + 5) % 4 + 1;
}

// The next edge. If several leave a vertex, the first one clockwise from the arriving edge, so that
// pieces that touch in a point stay separate loops.
static Edge *next_edge(const Outline *o, const Edge *arrives) {
  Edge *found = NULL;
  int least = 0;
  for (size_t i = 0; i < o->edge_count; i++) {
    Edge *e = &o->edges[i];
    if (e->used || e->from != arrives->to) continue;
    const int turn = turned(arrives, e);
    if (found && turn >= least) continue;
    found = e;
    least = turn;
  }
  return found;
}

static void follow(Outline *o, size_t start) {
  Edge *e = &o->edges[start];
  const size_t home = e->from;
  o->path_count = 0;
  while (e) {
    e->used = true;
    o->path[o->path_count++] = (size_t)(e - o->edges);
    e = e->to == home ? NULL : next_edge(o, e);
  }
}

// Whether the loop is a rectangle, which is then returned. If all cells have the same constant
// bounds of v, every side is a line of constant u or v.
static bool is_rectangle(const Outline *o, double u[2], double v[2]) {
  const CagQuadricCells *c = o->c;
  u[0] = v[0] = INFINITY;
  u[1] = v[1] = -INFINITY;
  for (size_t i = 0; i < o->path_count; i++) {
    const Edge *e = &o->edges[o->path[i]];
    const Vertex *at = &o->vertices[e->from];
    const CagQuadricCell *cell = &c->cells[e->cell];
    u[0] = fmin(u[0], at->u), u[1] = fmax(u[1], at->u);
    v[0] = fmin(v[0], at->v), v[1] = fmax(v[1], at->v);
    if (e->kind == EDGE_LOW && !cag_quadric_bound_is_straight(c, &cell->low)) return false;
    if (e->kind == EDGE_HIGH && !cag_quadric_bound_is_straight(c, &cell->high)) return false;
  }
  return true;
}

// --- Splines ---

#define DEGREE 7
// Interpolating pieces are halved down to this fraction of an edge.
#define LEAST_PIECE 1e-6

typedef struct Spline {
  CagVec3 *points; // DEGREE per piece, and the first one
  size_t count, room;
  bool failed; // no memory
} Spline;

static void push(Spline *s, CagVec3 p) {
  if (s->failed) return;
  if (!CAG_RESERVE(s->points, s->room, s->count + 1)) {
    s->failed = true;
    return;
  }
  s->points[s->count++] = p;
}

// An edge of a cell from left to right, with a parameter 0..1 in which it is smooth: near a fold, v
// is a function of the square root of u.
typedef struct Graph {
  const CagQuadricCells *c;
  const CagQuadricBound *bound;
  double from, to;
  bool folded[2];
} Graph;

static CagVec3 graph_at(const Graph *g, double s) {
  const double w = g->to - g->from;
  double u = g->from + w * s;
  if (g->folded[0] && g->folded[1]) u = g->from + w * s * s * (3 - 2 * s);
  else if (g->folded[0]) u = g->from + w * s * s;
  else if (g->folded[1]) u = g->to - w * (1 - s) * (1 - s);
  const bool end = s == 0 ? g->folded[0] : s == 1 ? g->folded[1] : false;
  if (s == 1) u = g->to;
  return cag_vec3(u, cag_quadric_bound_at(g->c, g->bound, u, end), 0);
}

// Bernstein polynomials of the degree at t.
static void bernstein(double t, double out[DEGREE + 1]) {
  out[0] = 1;
  for (int d = 1; d <= DEGREE; d++) {
    out[d] = t * out[d - 1];
    for (int i = d - 1; i > 0; i--) out[i] = (1 - t) * out[i] + t * out[i - 1];
    out[0] *= 1 - t;
  }
}

static double node(int i) { return (1 - cos(M_PI * i / DEGREE)) / 2; }

// The control points of the polynomial through points at the nodes, by elimination with pivoting.
static void interpolate(CagVec3 p[DEGREE + 1]) {
  double m[DEGREE + 1][DEGREE + 1];
  for (int i = 0; i <= DEGREE; i++) bernstein(node(i), m[i]);
  for (int k = 0; k <= DEGREE; k++) {
    int best = k;
    for (int i = k + 1; i <= DEGREE; i++)
      if (fabs(m[i][k]) > fabs(m[best][k])) best = i;
    for (int j = 0; j <= DEGREE; j++) {
      const double swap = m[k][j];
      m[k][j] = m[best][j];
      m[best][j] = swap;
    }
    const CagVec3 swap = p[k];
    p[k] = p[best];
    p[best] = swap;
    for (int i = 0; i <= DEGREE; i++) {
      if (i == k) continue;
      const double f = m[i][k] / m[k][k];
      for (int j = k; j <= DEGREE; j++) m[i][j] -= f * m[k][j];
      p[i] = cag_madd(p[i], -f, p[k]);
    }
  }
  for (int k = 0; k <= DEGREE; k++) p[k] = cag_scaled(p[k], 1 / m[k][k]);
}

// The partials of the unit form by u and by v.
static void unit_partials(CagQuadricShape shape, double u, double v, CagVec3 out[2]) {
  const double c = cos(u), s = sin(u);
  double r, dr, dz; // radius about the axis, and the derivatives of radius and height
  switch (shape) {
  case CAG_SHAPE_ELLIPSOID: r = sin(v), dr = cos(v), dz = -sin(v); break;
  case CAG_SHAPE_HYPERBOLOID_ONE: r = cosh(v), dr = sinh(v), dz = cosh(v); break;
  case CAG_SHAPE_HYPERBOLOID_TWO: r = sinh(v), dr = cosh(v), dz = sinh(v); break;
  case CAG_SHAPE_CONE: r = v, dr = 1, dz = 1; break;
  case CAG_SHAPE_ELLIPTIC_PARABOLOID: r = v, dr = 1, dz = 2 * v; break;
  case CAG_SHAPE_ELLIPTIC_CYLINDER: r = 1, dr = 0, dz = 1; break;
  case CAG_SHAPE_HYPERBOLIC_PARABOLOID:
    out[0] = cag_vec3(1, 0, 2 * u);
    out[1] = cag_vec3(0, 1, -2 * v);
    return;
  case CAG_SHAPE_PARABOLIC_CYLINDER:
    out[0] = cag_vec3(2 * u, 2, 0);
    out[1] = cag_vec3(0, 0, 1);
    return;
  default:
    out[0] = cag_vec3(sinh(u), cosh(u), 0);
    out[1] = cag_vec3(0, 0, 1);
    return;
  }
  out[0] = cag_vec3(-s * r, c * r, 0);
  out[1] = cag_vec3(c * dr, s * dr, dz);
}

// Rounding error of a few operations, as a fraction of their terms.
#define ROUNDING (16 * 2.220446049250313e-16)
// Tolerance of outlines, as a fraction of the size of the result.
#define OUTLINE 1e-11

// Tests whether the point of the quadric with these parameters is on the cut, within the tolerance.
// Its location along the edge does not matter. Near a fold, the roots are square roots of a
// difference, and their error moves the point far more along the edge than across it.
static bool is_on_cut(const Graph *g, CagVec3 uv) {
  const CagQuadricSheet *sheet = g->c->sheet;
  const CagQuadricCut *cut = &g->c->cuts[g->bound->side];
  const CagVec3 x = cag_quadric_unit_point(sheet->shape, uv.x, uv.y);
  const CagVec3 normal = cag_vec3(cut->a, cut->b, cut->c);
  const double off = fabs(cag_dot(normal, x) - cut->d);
  if (off <= ROUNDING * (fabs(cut->a * x.x) + fabs(cut->b * x.y) + fabs(cut->c * x.z))) return true;
  CagVec3 d[2];
  double slope[2];
  unit_partials(sheet->shape, uv.x, uv.y, d);
  for (int k = 0; k < 2; k++) {
    slope[k] = cag_dot(normal, d[k]);
    d[k] = cag_transform_vector(&sheet->frame, d[k]);
  }
  // The shortest step (du, dv) on the quadric with slope . (du, dv) = off.
  const double uu = cag_dot(d[0], d[0]), uw = cag_dot(d[0], d[1]), vv = cag_dot(d[1], d[1]);
  const double steep =
      vv * slope[0] * slope[0] - 2 * uw * slope[0] * slope[1] + uu * slope[1] * slope[1];
  const double size = cag_norm(cag_transform_point(&sheet->frame, x));
  const double enough = fmax(OUTLINE * sheet->size, ROUNDING * size);
  return off * off * (uu * vv - uw * uw) <= enough * enough * steep;
}

// Tests whether the polynomial stays close to the edge.
static bool is_near(const Graph *g, const CagVec3 p[DEGREE + 1]) {
  const double probes[] = {0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 0.98};
  for (size_t k = 0; k < sizeof probes / sizeof *probes; k++) {
    double b[DEGREE + 1];
    CagVec3 fitted = {0, 0, 0};
    bernstein(probes[k], b);
    for (int i = 0; i <= DEGREE; i++) fitted = cag_madd(fitted, b[i], p[i]);
    if (!is_on_cut(g, fitted)) return false;
  }
  return true;
}

static void fit(Spline *out, const Graph *g, double s0, double s1, bool backwards) {
  CagVec3 p[DEGREE + 1];
  for (int i = 0; i <= DEGREE; i++) p[i] = graph_at(g, i == DEGREE ? s1 : s0 + (s1 - s0) * node(i));
  interpolate(p);
  if (s1 - s0 > LEAST_PIECE && !is_near(g, p)) {
    const double half = s0 + (s1 - s0) / 2;
    fit(out, g, backwards ? half : s0, backwards ? s1 : half, backwards);
    fit(out, g, backwards ? s0 : half, backwards ? half : s1, backwards);
    return;
  }
  // The first point is the last one of the previous piece.
  for (int i = 1; i <= DEGREE; i++) push(out, p[backwards ? DEGREE - i : i]);
}

static void add_line(Spline *out, const Vertex *a, const Vertex *b) {
  for (int i = 1; i <= DEGREE; i++)
    push(out, cag_lerp(cag_vec3(a->u, a->v, 0), cag_vec3(b->u, b->v, 0), (double)i / DEGREE));
}

static void add_to_spline(const Outline *o, const Edge *e, Spline *out) {
  const CagQuadricCells *c = o->c;
  const CagQuadricCell *cell = &c->cells[e->cell];
  const CagQuadricBound *b = e->kind == EDGE_HIGH ? &cell->high : &cell->low;
  if (e->kind == EDGE_ACROSS || cag_quadric_bound_is_straight(c, b)) {
    add_line(out, &o->vertices[e->from], &o->vertices[e->to]);
    return;
  }
  const Graph g = {c,
                   b,
                   c->places[cell->place].u,
                   c->places[cell->place + 1].u,
                   {is_folded(c, b, cell->place), is_folded(c, b, cell->place + 1)}};
  fit(out, &g, 0, 1, e->kind == EDGE_HIGH);
  // End exactly in the vertex.
  const Vertex *end = &o->vertices[e->to];
  if (!out->failed) out->points[out->count - 1] = cag_vec3(end->u, end->v, 0);
}

static CagStatus loop_curve(const Outline *o, CagCurve **out, CagError *err) {
  Spline s = {NULL, 0, 0, false};
  const Vertex *home = &o->vertices[o->edges[o->path[0]].from];
  push(&s, cag_vec3(home->u, home->v, 0));
  for (size_t i = 0; i < o->path_count; i++) add_to_spline(o, &o->edges[o->path[i]], &s);
  double *knots = cag_malloc((s.count + DEGREE + 1) * sizeof *knots);
  CagStatus status = s.failed || !knots ? cag_fail_memory(err) : CAG_OK;
  if (!status) {
    for (size_t i = 0; i < s.count + DEGREE + 1; i++)
      knots[i] = i == 0 ? 0 : (double)((i - 1) / DEGREE);
    knots[s.count + DEGREE] = knots[s.count + DEGREE - 1];
    status = cag_curve_nurbs(s.points, NULL, s.count, DEGREE, knots, 2, out, err);
  }
  cag_free(s.points);
  cag_free(knots);
  return status;
}

// --- Surfaces ---

static CagStatus add_patch(const Outline *o, const double u[2], const double v[2],
                           CagSurface **list, size_t most, size_t *n, CagError *err) {
  if (*n == most) return CAG_OK;
  const CagQuadricSheet *sheet = o->c->sheet;
  CagStatus status =
      cag_surface_quadric(sheet->shape, &sheet->frame, u[0], u[1], v[0], v[1], &list[*n], err);
  if (!status) ++*n;
  return status;
}

// Adds an outer loop with its holes.
static CagStatus add_trimmed(const Outline *o, const CagRegion *all, size_t outer,
                             CagSurface **list, size_t most, size_t *n, CagError *err) {
  if (*n == most) return CAG_OK;
  CagCurve **holes = cag_malloc(all->count * sizeof *holes);
  if (!holes) return cag_fail_memory(err);
  size_t count = 0;
  for (size_t i = 0; i < all->count; i++)
    if (i != outer && all->outer[i] == outer) holes[count++] = all->loops[i];
  CagRegion *region = NULL;
  CagSurface *whole = NULL;
  CagBounds box;
  const CagQuadricSheet *s = o->c->sheet;
  CagStatus status = cag_region_new(all->loops[outer], holes, count, &region, err);
  if (!status) status = cag_region_bounds(region, &box, err);
  if (!status)
    status = cag_surface_quadric(s->shape, &s->frame, box.min.x, box.max.x, fmax(box.min.y, s->v0),
                                 fmin(box.max.y, s->v1), &whole, err);
  if (!status) status = cag_surface_trimmed(whole, region, &list[*n], err);
  if (!status) ++*n;
  if (whole) cag_surface_release(whole);
  cag_region_release(region);
  cag_free(holes);
  return status;
}

static CagStatus add_regions(const Outline *o, CagCurve *const *loops, size_t loop_count,
                             CagSurface **list, size_t most, size_t *n, CagError *err) {
  CagRegion *all = NULL;
  CagStatus status = cag_region_from_loops(loops, loop_count, &all, err);
  for (size_t i = 0; !status && i < all->count; i++)
    if (all->outer[i] == i) status = add_trimmed(o, all, i, list, most, n, err);
  cag_region_release(all);
  return status;
}

static CagStatus add_surfaces(Outline *o, CagSurface **list, size_t most, size_t *n,
                              CagError *err) {
  CagCurve **loops = cag_malloc((o->edge_count + 1) * sizeof *loops);
  double(*patches)[2][2] = cag_malloc((o->edge_count + 1) * sizeof *patches);
  size_t count = 0;
  bool plain = true;
  CagStatus status = loops && patches ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < o->edge_count; i++) {
    if (o->edges[i].used) continue;
    follow(o, i);
    plain = is_rectangle(o, patches[count][0], patches[count][1]) && plain;
    status = loop_curve(o, &loops[count], err);
    if (!status) count++;
  }
  for (size_t i = 0; !status && plain && i < count; i++)
    status = add_patch(o, patches[i][0], patches[i][1], list, most, n, err);
  if (!status && !plain) status = add_regions(o, loops, count, list, most, n, err);
  for (size_t i = 0; i < count; i++) cag_curve_release(loops[i]);
  cag_free(loops);
  cag_free(patches);
  return status;
}

CagStatus cag_quadric_outline(const CagQuadricCells *c, CagSurface **list, size_t most, size_t *n,
                              CagError *err) {
  // The four ends of every cell are vertices; between neighboring ones there is at most one edge.
  const size_t cells = c->cell_count;
  Outline o = {.c = c};
  o.vertices = cag_malloc(4 * cells * sizeof *o.vertices);
  o.ends = cag_malloc(cells * sizeof *o.ends);
  o.edges = cag_malloc(6 * cells * sizeof *o.edges);
  o.path = cag_malloc(6 * cells * sizeof *o.path);
  End *room = cag_malloc(4 * cells * sizeof *room);
  CagStatus status = CAG_OK;
  if (!o.vertices || !o.ends || !o.edges || !o.path || !room) status = cag_fail_memory(err);
  else if (!add_all(&o, room))
    status = cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_quadric_unbounded, "within", -1,
                      "the quadric is unbounded in `within`; use a box");
  else status = add_surfaces(&o, list, most, n, err);
  cag_free(o.vertices);
  cag_free(o.ends);
  cag_free(o.edges);
  cag_free(o.path);
  cag_free(room);
  return status;
}
