// Tessellation, step 4: leaves become triangles.
//
// If the nodes around a leaf are those of its grid, the leaf is a plain grid. Otherwise the grid
// stays one step away from the sides, and the band between each side's nodes and the outermost row
// of the grid is stitched: of the two next edges across the band the shorter one is used, unless it
// leans by more than a step. So no triangle of a band is wider than a step of the grid, and the
// bound of plan.c holds for it too.

#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/linalg/tolerance.h"
#include "geom/surface/frames.h"
#include "geom/tessellate/sides.h"
#include "geom/tessellate/tessellation.h"

typedef struct Fill {
  Tessellator *t;
  CagMesh *mesh;
  size_t vertices, triangles; // number filled so far
  double *us, *vs;            // room for the parameters of the largest leaf
  size_t grid_room;           // points
} Fill;

// A sequence of vertices with their parameters along it.
typedef struct Chain {
  const Node *nodes; // of a line; NULL: a row of the grid
  const Line *line;
  bool after;
  double from, step; // of the grid
  uint32_t first;
  uint32_t stride;
  size_t segments;
  bool ends; // the last node is also the end of the leaf's side
} Chain;

static uint32_t chain_vertex(const Tessellator *t, const Chain *c, size_t k) {
  if (c->nodes)
    return cag_tess_node_vertex(t, c->line, c->nodes + k, c->after, c->ends && k == c->segments);
  return c->first + (uint32_t)k * c->stride;
}

static double chain_parameter(const Chain *c, size_t k) {
  return c->nodes ? c->nodes[k].t : c->from + c->step * (double)k;
}

static Chain side_chain(const Tessellator *t, const Leaf *leaf, int side) {
  const Line *line = &t->lines[leaf->line[side]];
  return (Chain){.nodes = t->nodes + leaf->nodes[side],
                 .line = line,
                 .after = side % 2 == 0,
                 .segments = leaf->segments[side],
                 .ends = true};
}

// Without the first and the last segment.
static Chain inner_part(Chain side) {
  side.nodes++;
  side.segments -= 2;
  side.ends = false;
  return side;
}

// --- Triangles ---

static bool one_point(const Fill *f, uint32_t a, uint32_t b) {
  if (a == b) return true;
  const Tessellator *t = f->t;
  return a < t->vertex_count && b < t->vertex_count && t->weld[a] == t->weld[b];
}

// Skips triangles at poles that have collapsed to an edge.
static void add_triangle(Fill *f, uint32_t a, uint32_t b, uint32_t c) {
  if (one_point(f, a, b) || one_point(f, b, c) || one_point(f, c, a)) return;
  uint32_t *to = f->mesh->triangles + 3 * f->triangles++;
  to[0] = a;
  to[1] = b;
  to[2] = c;
}

// Corners counter-clockwise in (u, v): a lower left, b lower right, c upper right, d upper left.
// At a pole the vertex where the base of the triangle begins is kept (see pole_nodes).
static void add_quad(Fill *f, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  const CagVec3 *p = f->mesh->positions;
  bool cut_ac = tess_cut_ac(p[a], p[b], p[c], p[d]);
  if (one_point(f, a, d) || one_point(f, a, b)) cut_ac = true;
  else if (one_point(f, b, c) || one_point(f, c, d)) cut_ac = false;
  if (cut_ac) {
    add_triangle(f, a, b, c);
    add_triangle(f, a, c, d);
  } else {
    add_triangle(f, a, b, d);
    add_triangle(f, b, c, d);
  }
}

// Whether to use the edge across the band that takes the next segment of `low`, rather than that
// which takes the next of `high`. x, y: the parameters at both ends of these segments.
static bool is_low_better(const Fill *f, const double x[2], const double y[2], uint32_t a,
                          uint32_t b, uint32_t c, uint32_t d) {
  const double rounding = CAG_COINCIDENT; // of a step
  double step = fmax(x[1] - x[0], y[1] - y[0]) * (1 + rounding);
  // Only one of them can lean forward by more than a step; if one leans back, the other leans
  // forward.
  if (y[1] - x[0] > step) return true;
  if (x[1] - y[0] > step) return false;
  if (one_point(f, a, b)) return false;
  if (one_point(f, c, d)) return true;
  const CagVec3 *p = f->mesh->positions;
  return !tess_cut_ac(p[a], p[b], p[c], p[d]);
}

// Stitches the band between two chains, with `low` on the right of `high` (so that a triangle low,
// next low, high is counter-clockwise).
static void sew(Fill *f, const Chain *low, const Chain *high) {
  const Tessellator *t = f->t;
  size_t i = 0, j = 0;
  uint32_t a = chain_vertex(t, low, 0), d = chain_vertex(t, high, 0);
  while (i < low->segments || j < high->segments) {
    bool can_low = i < low->segments, can_high = j < high->segments;
    uint32_t b = can_low ? chain_vertex(t, low, i + 1) : a,
             c = can_high ? chain_vertex(t, high, j + 1) : d;
    bool take_low = can_low;
    if (can_low && can_high) {
      double x[2] = {chain_parameter(low, i), chain_parameter(low, i + 1)},
             y[2] = {chain_parameter(high, j), chain_parameter(high, j + 1)};
      take_low = is_low_better(f, x, y, a, b, c, d);
    }
    if (take_low) {
      add_triangle(f, a, b, d);
      a = b;
      i++;
    } else {
      add_triangle(f, a, c, d);
      d = c;
      j++;
    }
  }
}

// --- Vertices inside a leaf ---

// Normals that the partials do not determine.
static void limit_normals(Fill *f, const CagSurface *s, size_t first, size_t n) {
  CagMesh *m = f->mesh;
  for (size_t v = first; v < first + n; v++) {
    if (cag_dot(m->normals[v], m->normals[v]) > 0) continue;
    CagError ignored;
    CagVec3 *normal = &m->normals[v];
    if (!cag_surface_normal(s, m->uv[2 * v], m->uv[2 * v + 1], normal, &ignored)) continue;
    *normal = cag_vec3(0, 0, 0);
    f->t->needs_normals = true;
  }
}

// Inner vertices of the leaf's grid: index (i - 1) * (nv - 1) + (j - 1) from *first.
static CagStatus inner_vertices(Fill *f, const Leaf *leaf, uint32_t *first, CagError *err) {
  const CagSurface *s = f->t->faces[leaf->face].surface;
  CagMesh *m = f->mesh;
  size_t nu = leaf->n[0] - 1, nv = leaf->n[1] - 1;
  *first = (uint32_t)f->vertices;
  if (nu == 0 || nv == 0) return CAG_OK;
  for (size_t i = 0; i < nu; i++)
    f->us[i] = tess_mix(leaf->from[0], leaf->to[0], i + 1, leaf->n[0]);
  for (size_t j = 0; j < nv; j++)
    f->vs[j] = tess_mix(leaf->from[1], leaf->to[1], j + 1, leaf->n[1]);
  size_t rows = f->grid_room / nv;
  for (size_t done = 0; done < nu; done += rows) {
    if (rows > nu - done) rows = nu - done;
    CagVec3 *points = m->positions + f->vertices;
    CagStatus status = cag_surface_eval_frames(s, f->us + done, rows, f->vs, nv, points, NULL, NULL,
                                               m->normals + f->vertices, err);
    if (!status) status = cag_tess_interrupted(f->t, err);
    if (status) return status;
    for (size_t i = 0, k = 0; i < rows; i++)
      for (size_t j = 0; j < nv; j++, k++) {
        size_t v = f->vertices + k;
        m->uv[2 * v] = f->us[done + i];
        m->uv[2 * v + 1] = f->vs[j];
        m->weld[v] = (uint32_t)v;
      }
    limit_normals(f, s, f->vertices, rows * nv);
    f->vertices += rows * nv;
  }
  return CAG_OK;
}

// --- Leaves ---

static void fill_regular(Fill *f, const Leaf *leaf, uint32_t first) {
  const Tessellator *t = f->t;
  uint32_t nu = leaf->n[0], nv = leaf->n[1], stride = nv - 1;
  Chain side[4];
  for (int k = 0; k < 4; k++) side[k] = side_chain(t, leaf, k);
#define VERTEX(i, j)                                                                               \
  ((j) == 0    ? chain_vertex(t, &side[SIDE_V0], i)                                                \
   : (j) == nv ? chain_vertex(t, &side[SIDE_V1], i)                                                \
   : (i) == 0  ? chain_vertex(t, &side[SIDE_U0], j)                                                \
   : (i) == nu ? chain_vertex(t, &side[SIDE_U1], j)                                                \
               : first + ((i)-1) * stride + (j)-1)
  const CagVec3 *p = f->mesh->positions;
  for (uint32_t i = 0; i < nu && !cag_stopped(); i++) {
    bool inner_column = i > 0 && i + 1 < nu;
    for (uint32_t j = 0; j < nv; j++) {
      if (!inner_column || j == 0 || j + 1 == nv) {
        add_quad(f, VERTEX(i, j), VERTEX(i + 1, j), VERTEX(i + 1, j + 1), VERTEX(i, j + 1));
        continue;
      }
      uint32_t a = first + (i - 1) * stride + j - 1, b = a + stride, c = b + 1, d = a + 1;
      bool cut_ac = tess_cut_ac(p[a], p[b], p[c], p[d]);
      uint32_t *to = f->mesh->triangles + 3 * f->triangles;
      to[0] = a;
      to[1] = b;
      to[2] = cut_ac ? c : d;
      to[3] = cut_ac ? a : b;
      to[4] = c;
      to[5] = d;
      f->triangles += 2;
    }
  }
#undef VERTEX
}

// The quadrilaterals at the corners of a leaf belong to two bands each and are made separately,
// because they can be cut either way. Each lies between a corner, its adjacent nodes, and the
// grid's corner.
static void add_corners(Fill *f, const Leaf *leaf, uint32_t first) {
  const Tessellator *t = f->t;
  uint32_t nu = leaf->n[0] - 2, nv = leaf->n[1] - 2, stride = nv + 1;
  Chain u0 = side_chain(t, leaf, SIDE_U0), u1 = side_chain(t, leaf, SIDE_U1);
  Chain v0 = side_chain(t, leaf, SIDE_V0), v1 = side_chain(t, leaf, SIDE_V1);
  size_t eu0 = u0.segments, eu1 = u1.segments, ev0 = v0.segments, ev1 = v1.segments;
  add_quad(f, chain_vertex(t, &v0, 0), chain_vertex(t, &v0, 1), first, chain_vertex(t, &u0, 1));
  add_quad(f, chain_vertex(t, &v0, ev0 - 1), chain_vertex(t, &v0, ev0), chain_vertex(t, &u1, 1),
           first + nu * stride);
  add_quad(f, first + nu * stride + nv, chain_vertex(t, &u1, eu1 - 1), chain_vertex(t, &u1, eu1),
           chain_vertex(t, &v1, ev1 - 1));
  add_quad(f, chain_vertex(t, &u0, eu0 - 1), first + nv, chain_vertex(t, &v1, 1),
           chain_vertex(t, &v1, 0));
}

// The four bands around the inner grid and the grid itself.
static void fill_stitched(Fill *f, const Leaf *leaf, uint32_t first) {
  uint32_t nu = leaf->n[0], nv = leaf->n[1], stride = nv - 1;
  bool corners = true;
  double step[2];
  for (int d = 0; d < 2; d++) step[d] = (leaf->to[d] - leaf->from[d]) / leaf->n[d];
  for (int side = 0; side < 4; side++) corners &= leaf->segments[side] > 1;
  for (uint32_t i = 0; i + 2 < nu && !cag_stopped(); i++)
    for (uint32_t j = 0; j + 2 < nv; j++) {
      uint32_t a = first + i * stride + j;
      add_quad(f, a, a + stride, a + stride + 1, a + 1);
    }
  for (int side = 0; side < 4; side++) {
    int along = side < 2 ? 1 : 0;
    uint32_t start = first;
    if (side == SIDE_U1) start += (nu - 2) * stride;
    if (side == SIDE_V1) start += nv - 2;
    Chain outer = side_chain(f->t, leaf, side);
    if (corners) outer = inner_part(outer);
    Chain inner = {.from = leaf->from[along] + step[along],
                   .step = step[along],
                   .first = start,
                   .stride = along == 0 ? stride : 1,
                   .segments = leaf->n[along] - 2};
    bool outer_is_low = side == SIDE_U1 || side == SIDE_V0;
    sew(f, outer_is_low ? &outer : &inner, outer_is_low ? &inner : &outer);
  }
  if (corners) add_corners(f, leaf, first);
}

// --- Strips ---

// The vertices of two sides of a strip in order, each with its slant. Both rails of a strip begin
// at the corner with the least slant and end at the corner with the greatest.
typedef struct Rail {
  uint32_t *vertices;
  double *slants;
  size_t segments;
} Rail;

static double slant_of(const Leaf *leaf, double u, double v) {
  const Slants *s = &leaf->slants;
  const double across = s->along == 1 ? u - leaf->from[0] : v - leaf->from[1];
  return (s->along == 1 ? v : u) - s->slope * across;
}

static void add_to_rail(const Tessellator *t, const Leaf *leaf, int side, bool backwards, Rail *r) {
  const Chain chain = side_chain(t, leaf, side);
  const double at = side % 2 == 0 ? leaf->from[side / 2] : leaf->to[side / 2];
  const size_t first = r->segments;
  for (size_t k = 0; k <= chain.segments; k++) {
    const size_t node = backwards ? chain.segments - k : k;
    const double x = chain_parameter(&chain, node);
    r->vertices[first + k] = chain_vertex(t, &chain, node);
    r->slants[first + k] = side < 2 ? slant_of(leaf, at, x) : slant_of(leaf, x, at);
  }
  r->segments += chain.segments;
}

// Compares the edge from the next vertex of the low rail (b) to d with the edge from a to the next
// vertex of the high rail (c). True if the former follows the slants more closely.
static bool is_low_along(const Fill *f, const Leaf *leaf, const Rail *low, size_t i,
                         const Rail *high, size_t j) {
  const double alike = 1e-6; // fraction of a step
  const double to_low = fabs(low->slants[i + 1] - high->slants[j]),
               to_high = fabs(high->slants[j + 1] - low->slants[i]);
  if (fabs(to_low - to_high) > alike * leaf->slants.step) return to_low < to_high;
  const CagVec3 *p = f->mesh->positions;
  return !tess_cut_ac(p[low->vertices[i]], p[low->vertices[i + 1]], p[high->vertices[j + 1]],
                      p[high->vertices[j]]);
}

// Stitches the rails, with `low` on the right. The rails share both ends. There both advance at
// once, because a triangle with all corners on one side would be degenerate.
static void sew_rails(Fill *f, const Leaf *leaf, const Rail *low, const Rail *high) {
  const size_t last_low = low->segments - 1, last_high = high->segments - 1;
  const uint32_t *a = low->vertices, *b = high->vertices;
  size_t i = 1, j = 1;
  add_triangle(f, a[0], a[1], b[1]);
  while (i < last_low || j < last_high) {
    const bool take_low =
        j == last_high || (i < last_low && is_low_along(f, leaf, low, i, high, j));
    if (take_low) {
      add_triangle(f, a[i], a[i + 1], b[j]);
      i++;
    } else {
      add_triangle(f, a[i], b[j + 1], b[j]);
      j++;
    }
  }
  add_triangle(f, a[i], a[i + 1], b[j]);
}

static CagStatus fill_strip(Fill *f, const Leaf *leaf, CagError *err) {
  const Tessellator *t = f->t;
  size_t room = 4;
  for (int side = 0; side < 4; side++) room += leaf->segments[side];
  uint32_t *vertices = cag_malloc(2 * room * sizeof *vertices);
  double *slants = cag_malloc(2 * room * sizeof *slants);
  const CagStatus status = vertices && slants ? CAG_OK : cag_fail_memory(err);
  if (!status) {
    Rail low = {vertices, slants, 0}, high = {vertices + room, slants + room, 0};
    const bool rising = leaf->slants.slope > 0;
    // The corner with the least slant is the start of both sides or the end of one.
    if (!rising || leaf->slants.along == 1) {
      add_to_rail(t, leaf, rising ? SIDE_U1 : SIDE_V0, false, &low);
      add_to_rail(t, leaf, rising ? SIDE_V1 : SIDE_U1, rising, &low);
      add_to_rail(t, leaf, rising ? SIDE_V0 : SIDE_U0, rising, &high);
      add_to_rail(t, leaf, rising ? SIDE_U0 : SIDE_V1, false, &high);
    } else {
      add_to_rail(t, leaf, SIDE_U0, true, &low);
      add_to_rail(t, leaf, SIDE_V0, false, &low);
      add_to_rail(t, leaf, SIDE_V1, false, &high);
      add_to_rail(t, leaf, SIDE_U1, true, &high);
    }
    sew_rails(f, leaf, &low, &high);
  }
  cag_free(vertices);
  cag_free(slants);
  return status;
}

static CagStatus fill_leaf(Fill *f, const Leaf *leaf, CagError *err) {
  if (tess_is_strip(leaf)) return fill_strip(f, leaf, err);
  if (!leaf->regular && (leaf->n[0] == 1 || leaf->n[1] == 1)) {
    // A strip: the sides across it are single segments.
    bool along_u = leaf->segments[SIDE_U0] == 1 && leaf->segments[SIDE_U1] == 1;
    Chain low = side_chain(f->t, leaf, along_u ? SIDE_V0 : SIDE_U1),
          high = side_chain(f->t, leaf, along_u ? SIDE_V1 : SIDE_U0);
    sew(f, &low, &high);
    return CAG_OK;
  }
  uint32_t first;
  CagStatus status = inner_vertices(f, leaf, &first, err);
  if (status) return status;
  if (leaf->regular) fill_regular(f, leaf, first);
  else fill_stitched(f, leaf, first);
  return cag_stop_check(err);
}

// Determines the nodes on the leaf's sides, and the kind of filling they allow.
static void look_at_sides(Tessellator *t, Leaf *leaf) {
  leaf->regular = true;
  for (int side = 0; side < 4; side++) {
    const Line *line = &t->lines[leaf->line[side]];
    int along = 1 - side / 2;
    size_t low = line->node, high = line->node + line->node_count - 1;
    while (low < high) {
      size_t middle = (low + high) / 2;
      if (t->nodes[middle].t < leaf->from[along]) low = middle + 1;
      else high = middle;
    }
    size_t last = low;
    double from = leaf->from[along], length = leaf->to[along] - from;
    while (last < line->node + line->node_count - 1 && t->nodes[last].t < leaf->to[along]) last++;
    leaf->nodes[side] = low;
    leaf->segments[side] = (uint32_t)(last - low);
    leaf->regular &= leaf->segments[side] == leaf->n[along];
    const double even = 1e-6; // of a step: rounding of equal parameters
    for (size_t k = low; leaf->regular && k <= last; k++) {
      double x = (t->nodes[k].t - from) / length * leaf->n[along];
      leaf->regular = fabs(x - (double)(k - low)) <= even;
    }
  }
  if (leaf->regular || tess_is_strip(leaf)) return;
  const uint32_t *s = leaf->segments;
  bool strip_u = leaf->n[1] == 1 && s[SIDE_U0] == 1 && s[SIDE_U1] == 1,
       strip_v = leaf->n[0] == 1 && s[SIDE_V0] == 1 && s[SIDE_V1] == 1;
  // Neither: the grid needs an interior point to stitch to.
  for (int d = 0; d < 2 && !strip_u && !strip_v; d++)
    if (leaf->n[d] < 2) leaf->n[d] = 2;
}

static size_t inner_count(const Leaf *leaf) { return (size_t)(leaf->n[0] - 1) * (leaf->n[1] - 1); }

// A disc with i inner vertices and b boundary segments has 2 i + b - 2 triangles.
static size_t triangles_of(const Leaf *leaf) {
  size_t boundary = 0;
  for (int side = 0; side < 4; side++) boundary += leaf->segments[side];
  return 2 * inner_count(leaf) + boundary - 2;
}

// --- The mesh ---

// Welded vertices take the position of the first, and point to it in `weld`.
static void finish_weld(Tessellator *t) {
  for (uint32_t k = 0; k < t->vertex_count; k++) {
    uint32_t root = cag_tess_find(t, k);
    t->weld[k] = root;
    t->positions[k] = t->positions[root];
  }
}

static uint32_t root_of(uint32_t *weld, uint32_t k) {
  while (weld[k] != k) k = weld[k] = weld[weld[k]];
  return k;
}

// Whether two corners of triangle k coincide. They are then welded, so that its neighbors meet.
static bool weld_shrunk(CagMesh *m, const uint32_t *k, double noise) {
  bool shrunk = false;
  for (int j = 0; j < 3; j++) {
    const uint32_t a = k[j], b = k[(j + 1) % 3];
    const CagVec3 d = cag_sub(m->positions[a], m->positions[b]);
    if (fabs(d.x) > noise || !(cag_dot(d, d) <= noise * noise)) continue;
    const uint32_t p = root_of(m->weld, a), q = root_of(m->weld, b);
    m->weld[p < q ? q : p] = p < q ? p : q;
    shrunk = true;
  }
  return shrunk;
}

// Drops triangles that have collapsed to an edge or a point without a flag: a part of a net may lie
// in one point that is not a pole.
static void drop_shrunk(CagMesh *m, double noise) {
  size_t kept = 0;
  for (size_t t = 0; t < m->triangle_count && !cag_stopped(); t++) {
    const uint32_t *k = m->triangles + 3 * t;
    if (weld_shrunk(m, k, noise)) continue;
    if (kept < t) memcpy(m->triangles + 3 * kept, k, 3 * sizeof *k);
    kept++;
  }
  if (kept == m->triangle_count) return;
  m->triangle_count = kept;
  for (uint32_t v = 0; v < m->vertex_count; v++) {
    m->weld[v] = m->weld[m->weld[v]]; // the root's is set already, since it comes first
    m->positions[v] = m->positions[m->weld[v]];
  }
}

// Sets the normal of a vertex at which the surface has none to the mean of the triangles around it.
static void complete_normals(CagMesh *m) {
  unsigned char *missing = cag_calloc(m->vertex_count + 1, 1);
  if (!missing) return cag_note_memory();
  for (size_t v = 0; v < m->vertex_count; v++)
    missing[v] = cag_dot(m->normals[v], m->normals[v]) == 0;
  for (size_t t = 0; t < m->triangle_count && !cag_stopped(); t++) {
    const uint32_t *k = m->triangles + 3 * t;
    if (!missing[k[0]] && !missing[k[1]] && !missing[k[2]]) continue;
    CagVec3 a = m->positions[k[0]];
    CagVec3 n = cag_cross(cag_sub(m->positions[k[1]], a), cag_sub(m->positions[k[2]], a));
    for (int j = 0; j < 3; j++)
      if (missing[k[j]]) m->normals[k[j]] = cag_add(m->normals[k[j]], n);
  }
  for (size_t v = 0; v < m->vertex_count; v++) {
    if (!missing[v]) continue;
    m->normals[v] = cag_unit(m->normals[v]);
    if (cag_dot(m->normals[v], m->normals[v]) == 0) m->normals[v] = cag_vec3(0, 0, 1);
  }
  cag_free(missing);
}

static CagStatus begin_fill(Fill *f, CagError *err) {
  enum { CHUNK = 4096 }; // points evaluated together: their data stay in the cache
  Tessellator *t = f->t;
  size_t vertices = t->vertex_count, triangles = 0, longest = 1;
  for (size_t k = 0; k < t->leaf_count; k++) {
    Leaf *leaf = &t->leaves[k];
    look_at_sides(t, leaf);
    vertices += inner_count(leaf);
    triangles += triangles_of(leaf);
    for (int d = 0; d < 2; d++)
      if (leaf->n[d] > longest) longest = leaf->n[d];
  }
  for (size_t k = 0; k < t->face_count; k++) triangles += t->faces[k].triangle_count;
  if (triangles > t->how.max_triangles) return cag_tess_limit(t, (double)triangles, err);
  CagStatus status = cag_mesh_new(vertices, triangles, true, true, true, &f->mesh, err);
  if (status) return status;
  f->grid_room = longest > CHUNK ? longest : CHUNK;
  f->us = cag_malloc(longest * sizeof *f->us);
  f->vs = cag_malloc(longest * sizeof *f->vs);
  if (!f->us || !f->vs) return cag_fail_memory(err);
  memcpy(f->mesh->positions, t->positions, t->vertex_count * sizeof *t->positions);
  memcpy(f->mesh->normals, t->normals, t->vertex_count * sizeof *t->normals);
  memcpy(f->mesh->uv, t->uv, t->vertex_count * 2 * sizeof *t->uv);
  memcpy(f->mesh->weld, t->weld, t->vertex_count * sizeof *t->weld);
  f->vertices = t->vertex_count;
  return CAG_OK;
}

CagStatus cag_tess_fill(Tessellator *t, CagMesh **out, CagError *err) {
  finish_weld(t);
  Fill f = {.t = t};
  CagStatus status = begin_fill(&f, err);
  for (size_t k = 0; !status && k < t->leaf_count; k++) {
    const size_t first = f.triangles;
    status = fill_leaf(&f, &t->leaves[k], err);
    if (!status)
      status = cag_mesh_split_sides(f.mesh, first, f.triangles, t->faces[t->leaves[k].face].surface,
                                    t->how.angle, t->noise, err);
  }
  for (size_t k = 0; !status && k < t->face_count; k++)
    for (size_t j = 0; j < t->faces[k].triangle_count; j++) {
      const uint32_t *corner = t->faces[k].triangles + 3 * j;
      add_triangle(&f, corner[0], corner[1], corner[2]);
    }
  cag_free(f.us);
  cag_free(f.vs);
  if (status) {
    cag_mesh_release(f.mesh);
    return status;
  }
  f.mesh->triangle_count = f.triangles;
  drop_shrunk(f.mesh, t->noise);
  if (t->needs_normals) complete_normals(f.mesh);
  status = cag_stop_check(err);
  if (!status) status = cag_tess_turn_edges(t, f.mesh, err);
  if (!status) *out = f.mesh;
  else cag_mesh_release(f.mesh);
  return status;
}
