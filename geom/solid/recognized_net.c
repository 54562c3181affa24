// Regions of a mesh and their borders (see recognized_net.h).

#include "geom/solid/recognized_net.h"

#include <math.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/mesh/edges.h"
#include "geom/solid/recognized_fit.h"

// Carriers that differ by less than this fraction of the size of the mesh are one.
#define SAME 1e-8
// A region is narrow if its area is below this multiple of its border times the tolerance.
#define NARROW 0.5
// Corners are one if the border between them is shorter than this multiple of the tolerance.
#define SHORT 2
#define NONE UINT32_MAX

// An edge of the mesh between two triangles.
typedef struct MeshEdge {
  uint32_t from, to, left, right; // vertices and triangles
} MeshEdge;

typedef struct NetWork {
  CagRecognizedNet *net;
  double tolerance;
  MeshEdge *edges;
  size_t edge_count;
  uint32_t *parent;         // by triangles
  uint32_t *carrier;        // by sources: the first one that is the same
  uint32_t *first, *around; // border edges at vertices
  bool *used;               // by edges
} NetWork;

void cag_recognized_net_free(CagRecognizedNet *n) {
  cag_free(n->region);
  cag_free(n->source);
  cag_free(n->area);
  cag_free(n->path);
  cag_free(n->chains);
  cag_free(n->corners);
  *n = (CagRecognizedNet){0};
}

static void work_free(NetWork *w) {
  cag_free(w->edges);
  cag_free(w->parent);
  cag_free(w->carrier);
  cag_free(w->first);
  cag_free(w->around);
  cag_free(w->used);
}

static uint32_t root_of(uint32_t *parent, uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

static double mesh_size(const CagMesh *m) {
  const CagBounds box = cag_mesh_bounds(m);
  return cag_norm(cag_sub(box.max, box.min));
}

static CagStatus find_equal_carriers(NetWork *w, const CagRecognizedSources *s, CagError *err) {
  const double size = mesh_size(w->net->mesh);
  w->carrier = cag_calloc(s->count + 1, sizeof *w->carrier);
  if (!w->carrier) return cag_fail_memory(err);
  for (size_t i = 0; i < s->count; i++) {
    size_t k = 0;
    CagStatus status = cag_stop_check(err);
    if (status) return status;
    while (k < i && !(w->carrier[k] == k &&
                      cag_recognized_same(&s->items[k], &s->items[i], size, SAME * size)))
      k++;
    w->carrier[i] = (uint32_t)k;
  }
  return CAG_OK;
}

static CagStatus find_mesh_edges(NetWork *w, CagError *err) {
  const CagMesh *m = w->net->mesh;
  size_t n = 0;
  CagMeshEdge *uses = cag_mesh_edges(m->triangles, m->triangle_count, m->weld, m->vertex_count, &n);
  w->edges = cag_malloc((n / 2 + 1) * sizeof *w->edges);
  w->used = cag_calloc(n / 2 + 1, sizeof *w->used);
  CagStatus status = uses && w->edges && w->used ? CAG_OK : cag_stop_check(err);
  if (!status && (!uses || !w->edges || !w->used)) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i + 1 < n; i += 2) {
    const CagMeshEdge *a = &uses[i], *b = &uses[i + 1];
    if (a->low != b->low || a->high != b->high ||
        cag_mesh_edge_forward(a) == cag_mesh_edge_forward(b)) {
      status = cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_no_boundary, "", -1,
                        "its mesh has an edge that is not of two triangles");
      break;
    }
    const uint32_t t[2] = {(uint32_t)cag_mesh_edge_triangle(a),
                           (uint32_t)cag_mesh_edge_triangle(b)};
    const bool ahead = cag_mesh_edge_forward(a);
    w->edges[w->edge_count++] = (MeshEdge){a->low, a->high, t[!ahead], t[ahead]};
  }
  cag_free(uses);
  return status;
}

// --- Regions ---

static uint32_t carrier_of(const NetWork *w, uint32_t triangle) {
  const uint32_t label = w->net->mesh->labels[triangle];
  return label ? w->carrier[label - 1] : NONE;
}

static double triangle_area(const CagMesh *m, size_t t) {
  const uint32_t *v = m->triangles + 3 * t;
  const CagVec3 a = m->positions[v[0]];
  return cag_norm(cag_cross(cag_sub(m->positions[v[1]], a), cag_sub(m->positions[v[2]], a))) / 2;
}

static double edge_length(const NetWork *w, const MeshEdge *e) {
  const CagVec3 *p = w->net->mesh->positions;
  return cag_norm(cag_sub(p[e->from], p[e->to]));
}

// The neighbor with the longest common border, or NONE. `shared` has zeros, by triangles.
static uint32_t longest_neighbor(NetWork *w, uint32_t region, double *shared) {
  uint32_t best = NONE;
  for (int pass = 0; pass < 2; pass++)
    for (size_t i = 0; i < w->edge_count; i++) {
      const MeshEdge *e = &w->edges[i];
      const uint32_t a = root_of(w->parent, e->left), b = root_of(w->parent, e->right);
      if (a == b || (a != region && b != region)) continue;
      const uint32_t other = a == region ? b : a;
      if (pass == 1) shared[other] = 0;
      else shared[other] += edge_length(w, e);
      if (pass == 0 && (best == NONE || shared[other] > shared[best])) best = other;
    }
  return best;
}

// Unites narrow regions with neighbors. Roots of regions keep their carriers.
static CagStatus unite_narrow(NetWork *w, CagError *err) {
  const CagMesh *m = w->net->mesh;
  const size_t n = m->triangle_count;
  double *area = cag_calloc(3 * n + 3, sizeof *area), *border = area + n, *shared = border + n;
  CagStatus status = area ? CAG_OK : cag_fail_memory(err);
  for (size_t t = 0; !status && t < n; t++)
    area[root_of(w->parent, (uint32_t)t)] += triangle_area(m, t);
  for (size_t i = 0; !status && i < w->edge_count; i++) {
    const uint32_t a = root_of(w->parent, w->edges[i].left);
    const uint32_t b = root_of(w->parent, w->edges[i].right);
    if (a == b) continue;
    border[a] += edge_length(w, &w->edges[i]);
    border[b] += edge_length(w, &w->edges[i]);
  }
  for (uint32_t t = 0; !status && t < n; t++) {
    if (w->parent[t] != t || area[t] >= NARROW * w->tolerance * border[t]) continue;
    status = cag_stop_check(err);
    const uint32_t to = longest_neighbor(w, t, shared);
    if (to != NONE) w->parent[t] = to;
  }
  cag_free(area);
  return status;
}

static CagStatus find_regions(NetWork *w, CagError *err) {
  CagRecognizedNet *net = w->net;
  const size_t n = net->mesh->triangle_count;
  w->parent = cag_calloc(n + 1, sizeof *w->parent);
  net->region = cag_calloc(n + 1, sizeof *net->region);
  if (!w->parent || !net->region) return cag_fail_memory(err);
  for (size_t t = 0; t < n; t++) w->parent[t] = (uint32_t)t;
  for (size_t i = 0; i < w->edge_count; i++) {
    const MeshEdge *e = &w->edges[i];
    if (carrier_of(w, e->left) == carrier_of(w, e->right))
      w->parent[root_of(w->parent, e->left)] = root_of(w->parent, e->right);
  }
  CagStatus status = unite_narrow(w, err);
  if (status) return status;
  for (size_t t = 0; t < n; t++)
    if (w->parent[t] == t) net->region[t] = (uint32_t)net->region_count++;
  net->source = cag_calloc(net->region_count + 1, sizeof *net->source);
  net->area = cag_calloc(net->region_count + 1, sizeof *net->area);
  if (!net->source || !net->area) return cag_fail_memory(err);
  for (uint32_t t = 0; t < n; t++)
    if (w->parent[t] == t) net->source[net->region[t]] = carrier_of(w, t);
  for (uint32_t t = 0; t < n; t++) net->region[t] = net->region[root_of(w->parent, t)];
  for (uint32_t t = 0; t < n; t++) net->area[net->region[t]] += triangle_area(net->mesh, t);
  return CAG_OK;
}

// --- Chains ---

static uint32_t left_of(const NetWork *w, uint32_t edge) {
  return w->net->region[w->edges[edge].left];
}

static uint32_t right_of(const NetWork *w, uint32_t edge) {
  return w->net->region[w->edges[edge].right];
}

static bool is_border(const NetWork *w, size_t edge) {
  return left_of(w, (uint32_t)edge) != right_of(w, (uint32_t)edge);
}

static CagStatus sort_border(NetWork *w, CagError *err) {
  const size_t n = w->net->mesh->vertex_count;
  w->first = cag_calloc(n + 2, sizeof *w->first);
  w->around = cag_calloc(2 * w->edge_count + 1, sizeof *w->around);
  if (!w->first || !w->around) return cag_fail_memory(err);
  for (size_t i = 0; i < w->edge_count; i++) {
    if (!is_border(w, i)) continue;
    w->first[w->edges[i].from + 2]++;
    w->first[w->edges[i].to + 2]++;
  }
  for (size_t v = 0; v < n; v++) w->first[v + 2] += w->first[v + 1];
  for (size_t i = 0; i < w->edge_count; i++) {
    if (!is_border(w, i)) continue;
    w->around[w->first[w->edges[i].from + 1]++] = (uint32_t)i;
    w->around[w->first[w->edges[i].to + 1]++] = (uint32_t)i;
  }
  return CAG_OK;
}

// Whether a vertex of the border is a corner: the border does not pass through it between the same
// two regions.
static bool is_corner(const NetWork *w, uint32_t v) {
  const uint32_t *at = w->around + w->first[v];
  const uint32_t n = w->first[v + 1] - w->first[v];
  if (n != 2) return n > 0;
  const bool ahead[2] = {w->edges[at[0]].from == v, w->edges[at[1]].from == v};
  const uint32_t l = left_of(w, at[0]), r = right_of(w, at[0]);
  const bool turned = ahead[0] == ahead[1];
  return turned ? left_of(w, at[1]) != r || right_of(w, at[1]) != l
                : left_of(w, at[1]) != l || right_of(w, at[1]) != r;
}

static CagStatus add_to_path(CagRecognizedNet *net, uint32_t v, CagError *err) {
  if (!CAG_RESERVE(net->path, net->path_room, net->path_count + 1)) return cag_fail_memory(err);
  net->path[net->path_count++] = v;
  return CAG_OK;
}

// Follows the border from a vertex along an edge to the next corner, or around.
static CagStatus add_chain(NetWork *w, uint32_t v, uint32_t edge, const size_t *corner_of,
                           CagError *err) {
  CagRecognizedNet *net = w->net;
  const bool ahead = w->edges[edge].from == v;
  CagRecognizedChain c = {.first = net->path_count,
                          .sides = {ahead ? left_of(w, edge) : right_of(w, edge),
                                    ahead ? right_of(w, edge) : left_of(w, edge)},
                          .closed = corner_of[v] == 0};
  const uint32_t start = v;
  CagStatus status = add_to_path(net, v, err);
  for (;;) {
    if (!status) status = cag_stop_check(err);
    if (status) return status;
    w->used[edge] = true;
    v = w->edges[edge].from == v ? w->edges[edge].to : w->edges[edge].from;
    status = add_to_path(net, v, err);
    if (status || v == start || corner_of[v]) break;
    const uint32_t *at = w->around + w->first[v];
    edge = at[0] == edge ? at[1] : at[0];
  }
  if (status) return status;
  c.count = net->path_count - c.first;
  c.ends[0] = corner_of[start] ? corner_of[start] - 1 : 0;
  c.ends[1] = corner_of[v] ? corner_of[v] - 1 : 0;
  if (!CAG_RESERVE(net->chains, net->chain_room, net->chain_count + 1)) return cag_fail_memory(err);
  net->chains[net->chain_count++] = c;
  return CAG_OK;
}

static CagStatus add_corner(CagRecognizedNet *net, uint32_t v, size_t *number, CagError *err) {
  if (!CAG_RESERVE(net->corners, net->corner_room, net->corner_count + 1))
    return cag_fail_memory(err);
  net->corners[net->corner_count++] = v;
  *number = net->corner_count;
  return CAG_OK;
}

static CagStatus find_chains(NetWork *w, CagError *err) {
  CagRecognizedNet *net = w->net;
  const size_t n = net->mesh->vertex_count;
  size_t *corner_of = cag_calloc(n + 1, sizeof *corner_of); // plus 1
  CagStatus status = corner_of ? sort_border(w, err) : cag_fail_memory(err);
  for (uint32_t v = 0; !status && v < n; v++)
    if (is_corner(w, v)) status = add_corner(net, v, &corner_of[v], err);
  for (size_t i = 0; !status && i < net->corner_count; i++) {
    const uint32_t v = net->corners[i];
    for (uint32_t k = w->first[v]; !status && k < w->first[v + 1]; k++)
      if (!w->used[w->around[k]]) status = add_chain(w, v, w->around[k], corner_of, err);
  }
  // The others are closed.
  for (uint32_t v = 0; !status && v < n; v++)
    if (w->first[v] < w->first[v + 1] && !w->used[w->around[w->first[v]]]) {
      const size_t chain = net->chain_count;
      size_t number;
      status = add_chain(w, v, w->around[w->first[v]], corner_of, err);
      if (!status) status = add_corner(net, v, &number, err);
      if (!status) net->chains[chain].ends[0] = net->chains[chain].ends[1] = number - 1;
    }
  cag_free(corner_of);
  return status;
}

// --- Short chains ---

static double chain_length(const CagRecognizedNet *net, const CagRecognizedChain *c) {
  double length = 0;
  for (size_t i = c->first + 1; i < c->first + c->count; i++)
    length += cag_norm(
        cag_sub(net->mesh->positions[net->path[i]], net->mesh->positions[net->path[i - 1]]));
  return length;
}

static CagStatus drop_short_chains(NetWork *w, CagError *err) {
  CagRecognizedNet *net = w->net;
  uint32_t *one = cag_calloc(net->corner_count + 1, sizeof *one);
  size_t kept = 0;
  if (!one) return cag_fail_memory(err);
  for (size_t i = 0; i < net->corner_count; i++) one[i] = (uint32_t)i;
  for (size_t i = 0; i < net->chain_count; i++) {
    const CagRecognizedChain c = net->chains[i];
    const bool is_short = chain_length(net, &c) < SHORT * w->tolerance;
    if (is_short && c.ends[0] != c.ends[1])
      one[root_of(one, (uint32_t)c.ends[0])] = root_of(one, (uint32_t)c.ends[1]);
    if (!is_short) net->chains[kept++] = c;
  }
  net->chain_count = kept;
  for (size_t i = 0; i < kept; i++)
    for (int k = 0; k < 2; k++)
      net->chains[i].ends[k] = root_of(one, (uint32_t)net->chains[i].ends[k]);
  cag_free(one);
  return CAG_OK;
}

CagStatus cag_recognized_net(const CagMesh *m, const CagRecognizedSources *sources,
                             double tolerance, CagRecognizedNet *out, CagError *err) {
  CagRecognizedNet net = {.mesh = m};
  NetWork w = {.net = &net, .tolerance = tolerance};
  CagStatus status = CAG_OK;
  if (!m->labels || m->triangle_count == 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_no_boundary, "", -1, "it is empty");
  status = find_equal_carriers(&w, sources, err);
  if (!status) status = find_mesh_edges(&w, err);
  if (!status) status = find_regions(&w, err);
  if (!status) status = find_chains(&w, err);
  if (!status) status = drop_short_chains(&w, err);
  work_free(&w);
  if (status) cag_recognized_net_free(&net);
  else *out = net;
  return status;
}
