// Tessellation, step 3: the nodes of lines become vertices.
//
// A node is one point, but not always one vertex: at a seam the parameters differ between the
// sides, at a crease the normals. Leaf corners lie on two lines and so have four quadrants, each
// with its vertex. Vertices at one point are united in `weld`; in the end all of them get the
// position of the first.

#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/surface/frames.h"
#include "geom/tessellate/tessellation.h"

// Normals that differ by less than this are equal: they are the same limit computed in two ways.
#define SAME_NORMAL 1e-6

// --- Vertices ---

static CagStatus reserve_vertices(Tessellator *t, CagError *err) {
  if (t->vertex_count < t->vertex_capacity) return CAG_OK;
  if (t->vertex_count >= UINT32_MAX / 2) return cag_tess_limit(t, (double)t->vertex_count, err);
  size_t n = t->vertex_capacity ? 2 * t->vertex_capacity : 1024;
  if (!CAG_RESIZE(t->positions, n) || !CAG_RESIZE(t->normals, n) || !CAG_RESIZE(t->uv, 2 * n) ||
      !CAG_RESIZE(t->weld, n))
    return cag_fail_memory(err);
  t->vertex_capacity = n;
  return CAG_OK;
}

CagStatus cag_tess_new_vertex(Tessellator *t, CagVec3 position, CagVec3 normal, double u, double v,
                              uint32_t *out, CagError *err) {
  CagStatus status = reserve_vertices(t, err);
  if (status) return status;
  uint32_t k = (uint32_t)t->vertex_count++;
  t->positions[k] = position;
  t->normals[k] = normal;
  t->uv[2 * k] = u;
  t->uv[2 * k + 1] = v;
  t->weld[k] = k;
  t->needs_normals |= cag_dot(normal, normal) == 0;
  *out = k;
  return CAG_OK;
}

uint32_t cag_tess_find(Tessellator *t, uint32_t vertex) {
  while (t->weld[vertex] != vertex) {
    t->weld[vertex] = t->weld[t->weld[vertex]];
    vertex = t->weld[vertex];
  }
  return vertex;
}

void cag_tess_unite(Tessellator *t, uint32_t a, uint32_t b) {
  if (a == NO_INDEX || b == NO_INDEX) return;
  a = cag_tess_find(t, a);
  b = cag_tess_find(t, b);
  if (a < b) t->weld[b] = a;
  else t->weld[a] = b;
}

// --- Normals ---

static bool cross_normal(const CagSurface *s, const CagVec3 d[4], CagVec3 *out) {
  return cag_normal_of_partials(s, d[0], d[cag_partial(1, 1, 0)], d[cag_partial(1, 0, 1)], out);
}

// Normal if the partials do not determine it: the surface's own limit, else that a little further
// inside, else zero (replaced by the mean of the triangles in the end).
//
// Before a break inside the domain, the surface's own limit is the one after the break. There this
// function evaluates the normal a little before the break instead.
static CagVec3 limit_normal(const CagSurface *s, double u, double v, bool after_u, bool after_v) {
  const double inside = 1e-4; // of the way to the middle of the domain
  const double beside = 1e-6; // fraction of the domain
  const bool before_u = !after_u && u > s->u0 && u < s->u1;
  const bool before_v = !after_v && v > s->v0 && v < s->v1;
  CagError ignored;
  CagVec3 n, d[4];
  if ((before_u || before_v) &&
      !cag_surface_eval(s, before_u ? u - beside * (s->u1 - s->u0) : u,
                        before_v ? v - beside * (s->v1 - s->v0) : v, 1, CAG_SIDE_RIGHT,
                        CAG_SIDE_RIGHT, d, &ignored) &&
      cross_normal(s, d, &n))
    return n;
  if (!cag_surface_normal(s, u, v, &n, &ignored)) return n;
  u += inside * ((s->u0 + s->u1) / 2 - u);
  v += inside * ((s->v0 + s->v1) / 2 - v);
  CagStatus status = cag_surface_eval(s, u, v, 1, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, &ignored);
  if (!status && cross_normal(s, d, &n)) return n;
  return cag_vec3(0, 0, 0);
}

static CagStatus sided_vertex(const CagSurface *s, double u, double v, bool after_u, bool after_v,
                              CagVec3 *point, CagVec3 *normal, CagError *err) {
  CagVec3 d[4];
  CagStatus status = cag_surface_eval(s, u, v, 1, after_u ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT,
                                      after_v ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT, d, err);
  if (status) return status;
  *point = d[0];
  if (!cross_normal(s, d, normal)) *normal = limit_normal(s, u, v, after_u, after_v);
  return CAG_OK;
}

static bool alike(CagVec3 a, CagVec3 b) { return cag_norm(cag_sub(a, b)) <= SAME_NORMAL; }

// --- Corners ---

static size_t corner_slot(const Tessellator *t, uint32_t face, double u, double v) {
  uint64_t a, b;
  u += 0.0, v += 0.0; // merges the two zeros
  memcpy(&a, &u, sizeof a);
  memcpy(&b, &v, sizeof b);
  uint64_t h = (a ^ face) * 0x9e3779b97f4a7c15u; // golden ratio, as in Fibonacci hashing
  h = (h ^ h >> 32 ^ b) * 0xc4ceb9fe1a85ec53u;
  h ^= h >> 29;
  size_t at = h & t->corner_mask;
  for (; t->corner_hash[at] != NO_INDEX; at = (at + 1) & t->corner_mask) {
    const Corner *c = &t->corners[t->corner_hash[at]];
    if (c->face == face && c->u == u && c->v == v) break;
  }
  return at;
}

static bool is_closed_break(const Face *f, int direction, double at) {
  const CagSurface *s = f->surface;
  if (direction == 0 ? s->closed_u && at == s->u0 : s->closed_v && at == s->v0) return true;
  for (size_t low = 1, high = f->break_count[direction] - 1; low < high;) {
    size_t middle = (low + high) / 2;
    if (f->breaks[direction][middle] == at) return true;
    if (f->breaks[direction][middle] < at) low = middle + 1;
    else high = middle;
  }
  return false;
}

// Makes vertices for the four quadrants of the corner at (u, v), each united with the first.
static CagStatus fill_corner(Tessellator *t, Corner *c, CagError *err) {
  const Face *f = &t->faces[c->face];
  const CagSurface *s = f->surface;
  bool seam_u = s->closed_u && c->u == s->u0, seam_v = s->closed_v && c->v == s->v0;
  bool split_u = is_closed_break(f, 0, c->u), split_v = is_closed_break(f, 1, c->v);
  for (int q = 3; q >= 0; q--) {
    bool after_u = q & 1, after_v = q & 2;
    // If the surface is smooth across the corner, two quadrants share a vertex.
    int twin = q | (split_u ? 0 : 1) | (split_v ? 0 : 2);
    if (twin != q) {
      c->quadrant[q] = c->quadrant[twin];
      continue;
    }
    double u = seam_u && !after_u ? s->u1 : c->u, v = seam_v && !after_v ? s->v1 : c->v;
    CagVec3 point, normal;
    CagStatus status = sided_vertex(s, u, v, after_u, after_v, &point, &normal, err);
    if (status) return status;
    c->quadrant[q] = NO_INDEX;
    for (int k = 3; k > q; k--) {
      uint32_t other = c->quadrant[k];
      if (!alike(t->normals[other], normal)) continue;
      normal = t->normals[other];
      if (t->uv[2 * other] == u && t->uv[2 * other + 1] == v) c->quadrant[q] = other;
    }
    if (c->quadrant[q] != NO_INDEX) continue;
    status = cag_tess_new_vertex(t, point, normal, u, v, &c->quadrant[q], err);
    if (status) return status;
    cag_tess_unite(t, c->quadrant[3], c->quadrant[q]);
  }
  return CAG_OK;
}

// The corner at canonical (u, v) of a face, created on demand. `vertex`: its vertex, if known (at
// poles).
static CagStatus corner_at(Tessellator *t, uint32_t face, double u, double v, uint32_t vertex,
                           uint32_t *out, CagError *err) {
  const CagSurface *s = t->faces[face].surface;
  if (s->closed_u && u == s->u1) u = s->u0;
  if (s->closed_v && v == s->v1) v = s->v0;
  size_t slot = corner_slot(t, face, u, v);
  if (t->corner_hash[slot] != NO_INDEX) {
    *out = t->corner_hash[slot];
    return CAG_OK;
  }
  if (!CAG_RESERVE(t->corners, t->corner_capacity, t->corner_count + 1))
    return cag_fail_memory(err);
  Corner c = {u + 0.0, v + 0.0, face, {vertex, vertex, vertex, vertex}};
  const CagStatus status = vertex == NO_INDEX ? fill_corner(t, &c, err) : CAG_OK;
  if (status) return status;
  *out = t->corner_hash[slot] = (uint32_t)t->corner_count;
  t->corners[t->corner_count++] = c;
  return CAG_OK;
}

uint32_t cag_tess_node_vertex(const Tessellator *t, const Line *line, const Node *node, bool after,
                              bool node_is_end) {
  if (node->corner == NO_INDEX) return node->vertex[after];
  // The leaf lies before a node that ends its side, and after one that begins it (or lies within
  // it).
  bool after_u = line->fixed == 0 ? after : !node_is_end,
       after_v = line->fixed == 0 ? !node_is_end : after;
  return t->corners[node->corner].quadrant[2 * after_v + after_u];
}

// --- Nodes ---

static void place_nodes(Tessellator *t, Line *line) {
  Node *node = t->nodes + line->node;
  for (size_t a = 0, at = 0; a < line->atom_count; a++) {
    const Atom *atom = &t->atoms[line->atom + a];
    for (size_t k = 0; k < atom->n; k++, at++) {
      double x = line->own_parameters ? line->own_parameters[at]
                                      : tess_mix(atom->from, atom->to, k, atom->n);
      // corner: 0 marks a corner for the next step.
      *node++ = (Node){x, {NO_INDEX, NO_INDEX}, k == 0 && atom->corner ? 0 : NO_INDEX};
    }
    if (a + 1 == line->atom_count) *node = (Node){atom->to, {NO_INDEX, NO_INDEX}, 0};
  }
}

static void node_parameters(const Line *line, double t, bool after, double *u, double *v) {
  double at = after ? line->coordinate : line->before;
  *u = line->fixed == 0 ? at : t;
  *v = line->fixed == 0 ? t : at;
}

// All vertices of a pole line are one point. If the normal has a limit they are also one vertex;
// otherwise (at the tip of a cone) each triangle has its own, with the normal at its middle: the
// vertex of the node at which the triangle's base begins.
static CagStatus pole_nodes(Tessellator *t, Line *line, CagError *err) {
  enum { TRIALS = 5 };
  const double same_limit = 1e-4; // limits are computed by small steps, not in closed form
  const double beside = 1e-5;     // of the domain: offset at which the normal of a cone's side is
                                  // evaluated
  const CagSurface *s = t->faces[line->face].surface;
  Node *nodes = t->nodes + line->node;
  size_t last = line->node_count - 1;
  double u, v, across = line->fixed == 0 ? s->u1 - s->u0 : s->v1 - s->v0;
  bool low = line->coordinate == (line->fixed == 0 ? s->u0 : s->v0);
  bool has_limit = true;
  CagVec3 normal = {0, 0, 0}, point, other;
  for (size_t k = 0; k < TRIALS && has_limit; k++) {
    node_parameters(line, tess_mix(nodes[0].t, nodes[last].t, 2 * k + 1, 2 * TRIALS), true, &u, &v);
    CagError ignored;
    has_limit = !cag_surface_normal(s, u, v, &other, &ignored) &&
                (k == 0 || cag_norm(cag_sub(other, normal)) <= same_limit);
    if (k == 0) normal = other;
  }
  CagStatus status = cag_surface_point(s, u, v, &point, err);
  uint32_t first = NO_INDEX;
  for (size_t k = 0; !status && k <= last; k++) {
    size_t next = k < last ? k + 1 : k;
    double middle = (nodes[k].t + nodes[next].t) / 2;
    if (has_limit) middle = (nodes[0].t + nodes[last].t) / 2;
    node_parameters(line, middle, true, &u, &v);
    if (!has_limit) {
      double in_u = line->fixed == 0 ? u + (low ? beside : -beside) * across : u,
             in_v = line->fixed == 1 ? v + (low ? beside : -beside) * across : v;
      status = sided_vertex(s, in_u, in_v, true, true, &other, &normal, err);
    }
    if (!status && (first == NO_INDEX || !has_limit))
      status = cag_tess_new_vertex(t, point, normal, u, v, &nodes[k].vertex[0], err);
    else nodes[k].vertex[0] = first;
    if (status) return status;
    if (first == NO_INDEX) first = nodes[k].vertex[0];
    cag_tess_unite(t, first, nodes[k].vertex[0]);
    nodes[k].vertex[1] = nodes[k].vertex[0];
    if (nodes[k].corner == NO_INDEX) continue;
    node_parameters(line, nodes[k].t, true, &u, &v);
    status = corner_at(t, line->face, u, v, nodes[k].vertex[0], &nodes[k].corner, err);
    // The corner of a closed pole line was created at its other end; each end keeps its own vertex.
    nodes[k].corner = NO_INDEX;
  }
  return status;
}

static CagStatus corner_nodes(Tessellator *t, Line *line, CagError *err) {
  Node *nodes = t->nodes + line->node;
  for (size_t k = 0; k < line->node_count; k++) {
    if (nodes[k].corner == NO_INDEX) continue;
    double u, v;
    node_parameters(line, nodes[k].t, true, &u, &v);
    CagStatus status = corner_at(t, line->face, u, v, NO_INDEX, &nodes[k].corner, err);
    if (status) return status;
  }
  return CAG_OK;
}

typedef struct Row {
  double *t;
  CagVec3 *points, *du, *dv;
} Row;

// Makes vertices for the nodes that are not corners, for the leaves after (before) the line.
static CagStatus row_of_nodes(Tessellator *t, Line *line, bool after, const Row *row,
                              CagError *err) {
  const CagSurface *s = t->faces[line->face].surface;
  Node *nodes = t->nodes + line->node;
  size_t n = line->node_count;
  double u, v, at = after ? line->coordinate : line->before;
  for (size_t k = 0; k < n; k++) row->t[k] = nodes[k].t;
  CagStatus status =
      line->fixed == 0
          ? cag_surface_eval_grid(s, &at, 1, row->t, n, row->points, row->du, row->dv, err)
          : cag_surface_eval_grid(s, row->t, n, &at, 1, row->points, row->du, row->dv, err);
  for (size_t k = 0; !status && k < n; k++) {
    Node *node = &nodes[k];
    if (node->corner != NO_INDEX) continue;
    CagVec3 normal;
    node_parameters(line, node->t, after, &u, &v);
    if (!cag_normal_of_partials(s, row->points[k], row->du[k], row->dv[k], &normal))
      normal = limit_normal(s, u, v, after || line->fixed != 0, after || line->fixed == 0);
    uint32_t other = node->vertex[!after];
    if (other != NO_INDEX && alike(t->normals[other], normal)) normal = t->normals[other];
    status = cag_tess_new_vertex(t, row->points[k], normal, u, v, &node->vertex[after], err);
    cag_tess_unite(t, other, node->vertex[after]);
  }
  return status;
}

// Makes separate vertices for the leaves before an interior break, if the normal there is
// different.
static CagStatus crease_nodes(Tessellator *t, Line *line, bool only_look, bool *found,
                              CagError *err) {
  const CagSurface *s = t->faces[line->face].surface;
  Node *nodes = t->nodes + line->node;
  // Testing some nodes suffices to detect a crease, which extends along the whole line except on
  // contrived surfaces.
  enum { LOOKS = 16 };
  size_t stride = only_look && line->node_count > LOOKS ? line->node_count / LOOKS : 1, step;
  for (size_t k = 0; k < line->node_count; k += step) {
    Node *node = &nodes[k];
    step = node->corner != NO_INDEX ? 1 : stride; // corners are skipped
    if (node->corner != NO_INDEX) continue;
    double u, v;
    CagVec3 point, normal;
    node_parameters(line, node->t, true, &u, &v);
    CagStatus status =
        sided_vertex(s, u, v, line->fixed != 0, line->fixed == 0, &point, &normal, err);
    if (status) return status;
    if (alike(normal, t->normals[node->vertex[1]])) continue;
    *found = true;
    if (only_look) return CAG_OK;
    status = cag_tess_new_vertex(t, point, normal, u, v, &node->vertex[0], err);
    if (status) return status;
    cag_tess_unite(t, node->vertex[1], node->vertex[0]);
  }
  return CAG_OK;
}

static CagStatus line_nodes(Tessellator *t, Line *line, const Row *row, CagError *err) {
  CagStatus status = corner_nodes(t, line, err);
  if (!status) status = row_of_nodes(t, line, true, row, err);
  if (status) return status;
  if (line->seam) return row_of_nodes(t, line, false, row, err);
  Node *nodes = t->nodes + line->node;
  for (size_t k = 0; k < line->node_count; k++)
    if (nodes[k].corner == NO_INDEX) nodes[k].vertex[0] = nodes[k].vertex[1];
  bool crease = false;
  if (line->is_break) status = crease_nodes(t, line, true, &crease, err);
  return !status && crease ? crease_nodes(t, line, false, &crease, err) : status;
}

// Any vertex of the node, since all are one point.
static uint32_t some_vertex(const Tessellator *t, const Node *node) {
  return node->corner != NO_INDEX ? t->corners[node->corner].quadrant[3] : node->vertex[1];
}

static void unite_joined(Tessellator *t, const Line *slave) {
  const Line *master = &t->lines[slave->joined];
  for (size_t k = 0; k < slave->node_count; k++) {
    size_t at = slave->joined_reversed ? slave->node_count - 1 - k : k;
    cag_tess_unite(t, some_vertex(t, &t->nodes[master->node + at]),
                   some_vertex(t, &t->nodes[slave->node + k]));
  }
}

static CagStatus begin_nodes(Tessellator *t, Row *row, CagError *err) {
  size_t longest = 0, corners = 0;
  t->node_count = 0;
  for (size_t k = 0; k < t->line_count; k++) {
    Line *line = &t->lines[k];
    line->node = t->node_count;
    line->node_count = 1;
    for (size_t a = 0; a < line->atom_count; a++) line->node_count += t->atoms[line->atom + a].n;
    t->node_count += line->node_count;
    corners += line->atom_count + 1;
    if (line->node_count > longest) longest = line->node_count;
  }
  size_t slots = 64;
  while (slots < 2 * corners) slots *= 2;
  t->corner_mask = slots - 1;
  t->corner_hash = cag_malloc(slots * sizeof *t->corner_hash);
  t->nodes = cag_malloc((t->node_count + 1) * sizeof *t->nodes);
  row->t = cag_malloc((longest + 1) * sizeof *row->t);
  row->points = cag_malloc((longest + 1) * 3 * sizeof *row->points);
  if (!t->corner_hash || !t->nodes || !row->t || !row->points) return cag_fail_memory(err);
  row->du = row->points + longest;
  row->dv = row->du + longest;
  memset(t->corner_hash, 0xff, slots * sizeof *t->corner_hash);
  for (size_t k = 0; k < t->line_count; k++) place_nodes(t, &t->lines[k]);
  return CAG_OK;
}

CagStatus cag_tess_make_nodes(Tessellator *t, CagError *err) {
  Row row = {0};
  CagStatus status = begin_nodes(t, &row, err);
  // Poles first: lines that end there use the pole's vertex for their corner.
  for (int poles = 1; poles >= 0; poles--)
    for (size_t k = 0; !status && k < t->line_count; k++) {
      if (t->lines[k].pole != (poles == 1)) continue;
      status = poles ? pole_nodes(t, &t->lines[k], err) : line_nodes(t, &t->lines[k], &row, err);
    }
  for (size_t k = 0; !status && k < t->line_count; k++)
    if (t->lines[k].joined != NO_INDEX) unite_joined(t, &t->lines[k]);
  cag_free(row.t);
  cag_free(row.points);
  return status;
}
