// Welding: merges vertices closer than a tolerance.
//
// The vertices are processed in order. Each joins the nearest existing point within the tolerance,
// or becomes a new point. Points are kept in a hash table of cubes with the tolerance as side, so
// that only the 27 cubes around a vertex are searched.

#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/mesh/mesh.h"

#define NO_VERTEX UINT32_MAX

typedef struct Welder {
  const CagMesh *mesh;
  double tolerance;
  size_t mask;
  uint32_t *heads; // hash of the cube -> the last point in it
  uint32_t *next;  // for each point: the previous one in its cube
} Welder;

static uint64_t mix(uint64_t h) {
  h ^= h >> 33;
  h *= 0xff51afd7ed558ccdu; // constants of MurmurHash3's finisher
  h ^= h >> 33;
  h *= 0xc4ceb9fe1a85ec53u;
  return h ^ h >> 33;
}

// The cube's coordinate along an axis; with tolerance 0 the number itself (both zeros are equal).
static uint64_t cube(const Welder *w, double x, int step) {
  double c = w->tolerance > 0 ? floor(x / w->tolerance) + step : x + 0.0;
  uint64_t bits;
  memcpy(&bits, &c, sizeof bits);
  return c == 0 ? 0 : bits;
}

static size_t slot(const Welder *w, CagVec3 p, int i, int j, int k) {
  uint64_t h = mix(cube(w, p.x, i) + 0x9e3779b97f4a7c15u);
  h = mix(h ^ cube(w, p.y, j)) + 0x9e3779b97f4a7c15u;
  return mix(h ^ cube(w, p.z, k)) & w->mask;
}

static uint32_t nearest_point(const Welder *w, CagVec3 p) {
  int reach = w->tolerance > 0 ? 1 : 0;
  uint32_t best = NO_VERTEX;
  double best_distance = w->tolerance;
  for (int i = -reach; i <= reach; i++)
    for (int j = -reach; j <= reach; j++)
      for (int k = -reach; k <= reach; k++)
        for (uint32_t v = w->heads[slot(w, p, i, j, k)]; v != NO_VERTEX; v = w->next[v]) {
          double d = cag_norm(cag_sub(w->mesh->positions[v], p));
          bool nearer =
              d < best_distance || (d == best_distance && (best == NO_VERTEX || v < best));
          if (nearer) best = v, best_distance = d;
        }
  return best;
}

// first[v]: the vertex that v is merged into.
static CagStatus find_points(const CagMesh *m, double tolerance, uint32_t *first, CagError *err) {
  size_t size = 1024;
  while (size < m->vertex_count) size *= 2;
  Welder w = {m, tolerance, size - 1, cag_malloc(size * sizeof *w.heads),
              cag_malloc((m->vertex_count + 1) * sizeof *w.next)};
  CagStatus status = w.heads && w.next ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < size; i++) w.heads[i] = NO_VERTEX;
  for (size_t v = 0; !status && v < m->vertex_count; v++) {
    status = cag_stop_check(err);
    first[v] = nearest_point(&w, m->positions[v]);
    if (first[v] != NO_VERTEX) continue;
    size_t at = slot(&w, m->positions[v], 0, 0, 0);
    first[v] = (uint32_t)v;
    w.next[v] = w.heads[at];
    w.heads[at] = (uint32_t)v;
  }
  cag_free(w.heads);
  cag_free(w.next);
  return status;
}

// Whether merged vertices agree in their normals (within a difference that shading does not show),
// and in their parameters.
static void find_agreement(const CagMesh *m, const uint32_t *first, bool *normals, bool *uv) {
  const double same_direction = 1 - 1e-6; // cosine of 0.08 degrees
  *normals = m->normals != NULL;
  *uv = m->uv != NULL;
  for (size_t v = 0; v < m->vertex_count; v++) {
    const uint32_t k = first[v];
    if (*normals && cag_dot(m->normals[v], m->normals[k]) < same_direction) *normals = k == v;
    if (*uv && (m->uv[2 * v] != m->uv[2 * k] || m->uv[2 * v + 1] != m->uv[2 * k + 1])) *uv = false;
  }
}

static CagStatus build_welded(const CagMesh *m, const uint32_t *first, uint32_t *number,
                              CagMesh **out, CagError *err) {
  size_t vertices = 0, triangles = 0;
  bool normals, uv;
  for (size_t v = 0; v < m->vertex_count; v++)
    if (first[v] == v) number[v] = (uint32_t)vertices++;
  find_agreement(m, first, &normals, &uv);
  CagMesh *w = NULL;
  CagStatus status = cag_mesh_new(vertices, m->triangle_count, normals, uv, false, &w, err);
  if (status) return status;
  if (m->labels) w->labels = cag_malloc((m->triangle_count + 1) * sizeof *w->labels);
  if (m->labels && !w->labels) {
    cag_mesh_release(w);
    return cag_fail_memory(err);
  }
  for (size_t v = 0; v < m->vertex_count; v++) {
    if (first[v] != v) continue;
    uint32_t to = number[v];
    w->positions[to] = m->positions[v];
    if (normals) w->normals[to] = m->normals[v];
    if (uv) memcpy(w->uv + 2 * to, m->uv + 2 * v, 2 * sizeof *w->uv);
  }
  for (size_t t = 0; t < m->triangle_count; t++) {
    uint32_t k[3];
    for (int j = 0; j < 3; j++) k[j] = number[first[m->triangles[3 * t + j]]];
    if (k[0] == k[1] || k[1] == k[2] || k[2] == k[0]) continue; // collapsed to an edge or a point
    if (m->labels) w->labels[triangles] = m->labels[t];
    memcpy(w->triangles + 3 * triangles++, k, sizeof k);
  }
  w->triangle_count = triangles;
  if (uv) w->scale = m->scale;
  *out = w;
  return CAG_OK;
}

// Each point is one vertex of the result, even at sharp edges and seams. Normals and parameters are
// kept only if merged vertices agree everywhere; otherwise the result has none (and is shaded
// flat).
CagStatus cag_mesh_weld(const CagMesh *m, double tolerance, CagMesh **out, CagError *err) {
  if (!(tolerance >= 0) || !isfinite(tolerance))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_weld_tolerance, "tolerance", -1,
                    "`tolerance` must be at least 0, found %g", tolerance);
  size_t n = m->vertex_count + 1;
  uint32_t *first = cag_malloc(n * sizeof *first), *number = cag_malloc(n * sizeof *number);
  CagStatus status = first && number ? CAG_OK : cag_fail_memory(err);
  if (!status) status = find_points(m, tolerance, first, err);
  if (!status) status = build_welded(m, first, number, out, err);
  cag_free(first);
  cag_free(number);
  return status;
}
