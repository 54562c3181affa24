// Orients the closed parts of a mesh outward.
//
// Edges connect triangles into parts: a union-find forest in which each triangle stores whether it
// is oriented against its root. The sign of a part's volume gives its current orientation, and the
// number of other parts around it the required one. Whether a part is inside another is tested at
// points of it by vertical rays through the other, with exact predicates, so that triangles that
// share an edge or a corner count once.

#include "geom/tessellate/orient.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/sort.h"
#include "base/stop.h"
#include "geom/mesh/edges.h"
#include "geom/mesh/predicates.h"
#include "geom/tessellate/tessellate.h"

// A part whose volume is below this fraction of the cube of its size is flat up to rounding.
#define FLAT 1e-14
// Number of points of a part at which nesting is tested; points on the other part's surface are
// inconclusive.
#define PROBES 7
#define PROBES_DECISIVE 3

typedef struct Part {
  bool closed;
  double volume; // signed, with the orientation of the parts' roots
  CagBounds box;
  size_t first, count; // in Work.order
  bool turn;           // opposite to the root
} Part;

typedef struct Work {
  const CagMesh *mesh;
  uint32_t *parent; // union-find forest of triangles
  bool *against;    // the triangle is oriented against its parent; after `settle`, against its root
  bool *open;       // for roots: the part is open or one-sided
  uint32_t *part;   // for each triangle; UINT32_MAX: collapsed to an edge or a point of the welded
                    // mesh
  uint32_t *order;  // triangles, sorted by part
  Part *parts;
  size_t part_count;
} Work;

static void work_free(Work *w) {
  cag_free(w->parent);
  cag_free(w->against);
  cag_free(w->open);
  cag_free(w->part);
  cag_free(w->order);
  cag_free(w->parts);
}

static uint32_t welded(const CagMesh *m, size_t triangle, size_t corner) {
  const uint32_t v = m->triangles[3 * triangle + corner % 3];
  return m->weld ? m->weld[v] : v;
}

static bool has_area(const CagMesh *m, size_t t) {
  const uint32_t a = welded(m, t, 0), b = welded(m, t, 1), c = welded(m, t, 2);
  return a != b && b != c && c != a;
}

// --- Parts ---

// Root of a triangle, and whether the triangle is oriented against it; with path compression.
static uint32_t find_root(Work *w, uint32_t t, bool *against) {
  uint32_t root = t;
  bool turned = false;
  for (; w->parent[root] != root; root = w->parent[root]) turned ^= w->against[root];
  *against = turned;
  while (w->parent[t] != root && t != root) {
    const uint32_t next = w->parent[t];
    const bool own = w->against[t];
    w->parent[t] = root;
    w->against[t] = turned;
    turned ^= own;
    t = next;
  }
  return root;
}

// agree: the two triangles must keep their relative orientation. False: they cannot.
static bool tie(Work *w, uint32_t a, uint32_t b, bool agree) {
  bool against_a, against_b;
  uint32_t root_a = find_root(w, a, &against_a), root_b = find_root(w, b, &against_b);
  if (root_a == root_b) return (against_a == against_b) == agree;
  if (root_b < root_a) {
    const uint32_t swap = root_a;
    root_a = root_b;
    root_b = swap;
  }
  w->parent[root_b] = root_a;
  w->against[root_b] = (against_a == against_b) != agree;
  w->open[root_a] |= w->open[root_b];
  return true;
}

static void mark_open(Work *w, uint32_t t) {
  bool against;
  w->open[find_root(w, t, &against)] = true;
}

// Ties the triangles at one edge. If more than two meet, their own orientations are kept, since
// pairs cannot be determined.
static void tie_uses(Work *w, const CagMeshEdge *use, size_t n) {
  const uint32_t first = (uint32_t)cag_mesh_edge_triangle(&use[0]);
  size_t forward = cag_mesh_edge_forward(&use[0]);
  bool fits = true;
  for (size_t i = 1; i < n; i++) {
    const bool opposite = cag_mesh_edge_forward(&use[i]) != cag_mesh_edge_forward(&use[0]);
    forward += cag_mesh_edge_forward(&use[i]);
    fits &= tie(w, first, (uint32_t)cag_mesh_edge_triangle(&use[i]), n > 2 || opposite);
  }
  if (n == 1 || !fits || (n > 2 && 2 * forward != n)) mark_open(w, first);
}

// Drops uses by triangles without area: their neighbors then share an edge.
static size_t drop_degenerate(const CagMesh *m, CagMeshEdge *edges, size_t n) {
  size_t kept = 0;
  for (size_t i = 0; i < n; i++)
    if (has_area(m, cag_mesh_edge_triangle(&edges[i]))) edges[kept++] = edges[i];
  return kept;
}

// Edges of the welded mesh, and their number; NULL: out of memory, or canceled.
static CagMeshEdge *edges_of(const CagMesh *m, size_t *n) {
  CagMeshEdge *edges = cag_mesh_edges(m->triangles, m->triangle_count, m->weld, m->vertex_count, n);
  if (edges && m->weld) *n = drop_degenerate(m, edges, *n);
  return edges;
}

static size_t uses_of(const CagMeshEdge *e, size_t left) {
  size_t n = 1;
  while (n < left && e[n].low == e[0].low && e[n].high == e[0].high) n++;
  return n;
}

static bool make_forest(Work *w) {
  size_t n;
  CagMeshEdge *edges = edges_of(w->mesh, &n);
  if (!edges) return false;
  for (uint32_t t = 0; t < w->mesh->triangle_count; t++) w->parent[t] = t;
  for (size_t i = 0, k; i < n && !cag_stopped(); i += k)
    tie_uses(w, edges + i, k = uses_of(edges + i, n - i));
  cag_free(edges);
  return true;
}

// Numbers the parts by their first triangles, and sorts the triangles by them.
static bool make_parts(Work *w) {
  const size_t n = w->mesh->triangle_count;
  for (uint32_t t = 0; t < n; t++) {
    bool against;
    const uint32_t root = find_root(w, t, &against);
    w->part[t] = !has_area(w->mesh, t) ? UINT32_MAX
                 : root == t           ? (uint32_t)w->part_count++
                                       : w->part[root];
  }
  w->parts = cag_calloc(w->part_count + 1, sizeof *w->parts);
  if (!w->parts) return false;
  for (uint32_t t = 0; t < n; t++) {
    if (w->part[t] == UINT32_MAX) continue;
    bool against;
    Part *p = &w->parts[w->part[t]];
    p->closed = !w->open[find_root(w, t, &against)];
    p->count++;
  }
  for (size_t i = 1; i < w->part_count; i++)
    w->parts[i].first = w->parts[i - 1].first + w->parts[i - 1].count;
  for (size_t i = 0; i < w->part_count; i++) w->parts[i].count = 0;
  for (uint32_t t = 0; t < n; t++) {
    if (w->part[t] == UINT32_MAX) continue;
    Part *p = &w->parts[w->part[t]];
    w->order[p->first + p->count++] = t;
  }
  return true;
}

static bool runs_against(const Work *w, uint32_t t) {
  return w->parent[t] != t && w->against[t]; // paths are short after make_parts
}

// Volume relative to a vertex of the part, which keeps the terms small, and bounds.
static void measure(Work *w, Part *p) {
  const CagMesh *m = w->mesh;
  const CagVec3 tip = m->positions[m->triangles[3 * (size_t)w->order[p->first]]];
  p->box = CAG_BOUNDS_EMPTY;
  for (size_t i = p->first; i < p->first + p->count && !cag_stopped(); i++) {
    const uint32_t *k = m->triangles + 3 * (size_t)w->order[i];
    CagVec3 c[3];
    for (int j = 0; j < 3; j++) {
      cag_bounds_add(&p->box, m->positions[k[j]]);
      c[j] = cag_sub(m->positions[k[j]], tip);
    }
    const double six = cag_dot(c[0], cag_cross(c[1], c[2]));
    p->volume += runs_against(w, w->order[i]) ? -six / 6 : six / 6;
  }
  const double size = cag_norm(cag_sub(p->box.max, p->box.min));
  p->closed = fabs(p->volume) > FLAT * size * size * size;
}

// --- Nesting ---

static bool holds(const CagBounds *a, const CagBounds *b) {
  return a->min.x <= b->min.x && a->min.y <= b->min.y && a->min.z <= b->min.z &&
         a->max.x >= b->max.x && a->max.y >= b->max.y && a->max.z >= b->max.z;
}

// Winding number about p of the outline of a triangle seen from above. Each edge is processed from
// its lower end, so that both of its triangles agree, and includes that end but not the other.
static int winding_from_above(const CagVec3 c[3], CagVec3 p) {
  int winding = 0;
  for (int j = 0; j < 3; j++) {
    const CagVec3 from = c[j], to = c[(j + 1) % 3];
    const bool up = from.y <= p.y && to.y > p.y, down = to.y <= p.y && from.y > p.y;
    if (!up && !down) continue;
    const int side = cag_side_of_line(up ? from : to, up ? to : from, p);
    if (side > 0) winding += up ? 1 : -1;
  }
  return winding;
}

// Winding number of a part about p; *on: p lies on it.
static int part_winding(const Work *w, const Part *p, CagVec3 at, bool *on) {
  const CagMesh *m = w->mesh;
  int winding = 0;
  *on = false;
  for (size_t i = p->first; i < p->first + p->count && !cag_stopped(); i++) {
    const uint32_t *k = m->triangles + 3 * (size_t)w->order[i];
    const CagVec3 c[3] = {m->positions[k[0]], m->positions[k[1]], m->positions[k[2]]};
    if (fmin(c[0].y, fmin(c[1].y, c[2].y)) > at.y || fmax(c[0].y, fmax(c[1].y, c[2].y)) < at.y ||
        fmin(c[0].x, fmin(c[1].x, c[2].x)) > at.x || fmax(c[0].x, fmax(c[1].x, c[2].x)) < at.x ||
        fmax(c[0].z, fmax(c[1].z, c[2].z)) < at.z)
      continue;
    const int around = winding_from_above(c, at);
    if (around == 0) continue;
    // If a triangle is counter-clockwise from above, p below it is on its negative side.
    const int side = cag_side_of_plane(c[0], c[1], c[2], at);
    *on |= side == 0;
    if (side * around < 0) winding += runs_against(w, w->order[i]) ? -around : around;
  }
  return winding;
}

// Returns true if the first probes of a part that are not on the other are all inside it.
static bool is_within(const Work *w, const Part *inner, const Part *outer) {
  size_t asked = inner->count < PROBES ? inner->count : PROBES, within = 0;
  for (size_t i = 0; i < asked && within < PROBES_DECISIVE; i++) {
    const uint32_t t = w->order[inner->first + i * inner->count / asked];
    const uint32_t *k = w->mesh->triangles + 3 * (size_t)t;
    const CagVec3 *p = w->mesh->positions;
    const CagVec3 center = cag_scaled(cag_add(cag_add(p[k[0]], p[k[1]]), p[k[2]]), 1.0 / 3);
    bool on;
    const int winding = part_winding(w, outer, center, &on);
    if (!on && winding == 0) return false;
    within += !on;
  }
  return within > 0;
}

// Sorts by start in x; for equal starts, larger ones first.
static int by_start(const void *a, const void *b) {
  const Part *p = *(Part *const *)a, *q = *(Part *const *)b;
  if (p->box.min.x != q->box.min.x) return p->box.min.x < q->box.min.x ? -1 : 1;
  const double x = fabs(p->volume), y = fabs(q->volume);
  if (x != y) return x > y ? -1 : 1;
  return p < q ? -1 : p > q;
}

// Sweeps along x. `near`: the parts that have started and not ended, which may contain the next
// one.
static CagStatus choose_turns(Work *w, CagError *err) {
  size_t n = 0, near_count = 0;
  Part **sorted = cag_malloc((w->part_count + 1) * sizeof(Part *));
  Part **near = cag_malloc((w->part_count + 1) * sizeof(Part *));
  CagStatus status = sorted && near ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < w->part_count; i++)
    if (w->parts[i].closed) sorted[n++] = &w->parts[i];
  if (!status) status = cag_stop_check(err);
  if (!status) status = cag_sort(sorted, n, sizeof *sorted, by_start, err);
  for (size_t i = 0; !status && i < n; i++) {
    Part *p = sorted[i];
    size_t around = 0, kept = 0;
    for (size_t k = 0; k < near_count; k++) {
      Part *q = near[k];
      if (q->box.max.x < p->box.min.x) continue;
      near[kept++] = q;
      if (fabs(q->volume) > fabs(p->volume) && holds(&q->box, &p->box))
        around += is_within(w, p, q);
    }
    near_count = kept;
    near[near_count++] = p;
    p->turn = (p->volume < 0) != (around % 2 == 1);
    status = cag_stop_check(err);
  }
  cag_free(sorted);
  cag_free(near);
  return status;
}

// --- The result ---

static bool turns(const Work *w, size_t t) {
  if (w->part[t] == UINT32_MAX) return false;
  const Part *p = &w->parts[w->part[t]];
  return p->closed && p->turn != runs_against(w, (uint32_t)t);
}

enum { KEPT = 1, TURNED = 2 };

// A vertex with a normal that is shared by reversed and other triangles is duplicated. second[v]:
// index of the copy.
static CagStatus copy_turned(const Work *w, unsigned char *kinds, uint32_t *second, CagMesh **out,
                             CagError *err) {
  const CagMesh *m = w->mesh;
  size_t n = m->vertex_count;
  for (size_t t = 0; t < m->triangle_count; t++)
    for (size_t k = 0; k < 3; k++) kinds[m->triangles[3 * t + k]] |= turns(w, t) ? TURNED : KEPT;
  for (size_t v = 0; v < m->vertex_count; v++)
    if (m->normals && kinds[v] == (KEPT | TURNED)) second[v] = (uint32_t)n++;
  const bool doubled = n > m->vertex_count;
  CagMesh *c;
  CagStatus status = cag_mesh_new(n, m->triangle_count, m->normals != NULL, m->uv != NULL,
                                  m->weld != NULL || doubled, &c, err);
  if (status) return status;
  c->scale = m->scale;
  if (m->labels) {
    c->labels = cag_malloc((m->triangle_count + 1) * sizeof *c->labels);
    if (!c->labels) {
      cag_mesh_release(c);
      return cag_fail_memory(err);
    }
    memcpy(c->labels, m->labels, m->triangle_count * sizeof *c->labels);
  }
  for (uint32_t v = 0; v < m->vertex_count; v++) {
    const bool twice = doubled && kinds[v] == (KEPT | TURNED);
    const uint32_t to[2] = {v, twice ? second[v] : v};
    for (int k = 0; k <= (int)twice; k++) {
      c->positions[to[k]] = m->positions[v];
      if (m->uv) memcpy(c->uv + 2 * (size_t)to[k], m->uv + 2 * (size_t)v, 2 * sizeof *c->uv);
      if (c->weld) c->weld[to[k]] = m->weld ? m->weld[v] : v;
      if (m->normals)
        c->normals[to[k]] =
            cag_scaled(m->normals[v], kinds[v] == TURNED || (twice && k == 1) ? -1 : 1);
    }
  }
  for (size_t t = 0; t < m->triangle_count; t++) {
    const bool turned = turns(w, t);
    for (size_t k = 0; k < 3; k++) {
      const uint32_t v = m->triangles[3 * t + (turned ? 2 - k : k)];
      const bool other = doubled && turned && kinds[v] == (KEPT | TURNED);
      c->triangles[3 * t + k] = other ? second[v] : v;
    }
  }
  *out = c;
  return CAG_OK;
}

static CagStatus result_of(const Work *w, CagMesh **out, CagError *err) {
  bool any = false;
  for (size_t t = 0; t < w->mesh->triangle_count && !any; t++) any = turns(w, t);
  if (!any) {
    *out = cag_mesh_retain(w->mesh);
    return CAG_OK;
  }
  unsigned char *kinds = cag_calloc(w->mesh->vertex_count + 1, sizeof *kinds);
  uint32_t *second = cag_malloc((w->mesh->vertex_count + 1) * sizeof *second);
  CagStatus status =
      kinds && second ? copy_turned(w, kinds, second, out, err) : cag_fail_memory(err);
  cag_free(kinds);
  cag_free(second);
  return status;
}

CagStatus cag_mesh_outward(const CagMesh *m, CagMesh **out, CagError *err) {
  const size_t n = m->triangle_count;
  Work w = {.mesh = m};
  w.parent = cag_malloc((n + 1) * sizeof *w.parent);
  w.against = cag_calloc(n + 1, sizeof *w.against);
  w.open = cag_calloc(n + 1, sizeof *w.open);
  w.part = cag_malloc((n + 1) * sizeof *w.part);
  w.order = cag_malloc((n + 1) * sizeof *w.order);
  const bool room = w.parent && w.against && w.open && w.part && w.order;
  CagStatus status = room && make_forest(&w) && make_parts(&w) ? CAG_OK : cag_fail_memory(err);
  if (!status) {
    for (size_t i = 0; i < w.part_count && !cag_stopped(); i++)
      if (w.parts[i].closed) measure(&w, &w.parts[i]);
    status = choose_turns(&w, err);
  }
  if (!status) status = result_of(&w, out, err);
  work_free(&w);
  return status;
}

// Six times the signed volume, relative to a vertex of the mesh, which keeps the terms small.
static double signed_six(const CagMesh *m) {
  double six = 0;
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    const CagVec3 *p = m->positions, tip = p[m->triangles[0]];
    six += cag_dot(cag_sub(p[k[0]], tip), cag_cross(cag_sub(p[k[1]], tip), cag_sub(p[k[2]], tip)));
  }
  return six;
}

CagStatus cag_surface_outward(const CagSurface *s, CagSurface **out, CagError *err) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *m = NULL;
  if (!cag_surface_is_closed(s)) {
    *out = cag_surface_retain(s);
    return CAG_OK;
  }
  CagStatus status = cag_surface_tessellate(s, &how, &m, err);
  if (status) return status;
  const bool inward = signed_six(m) < 0;
  cag_mesh_release(m);
  if (inward) return cag_surface_flip(s, out, err);
  *out = cag_surface_retain(s);
  return CAG_OK;
}

CagStatus cag_mesh_open_edges(const CagMesh *m, size_t *out, CagError *err) {
  size_t n;
  CagMeshEdge *edges = edges_of(m, &n);
  *out = 0;
  if (!edges) return cag_fail_memory(err);
  for (size_t i = 0, k; i < n; i += k) *out += (k = uses_of(edges + i, n - i)) == 1;
  cag_free(edges);
  return CAG_OK;
}
