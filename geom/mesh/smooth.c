// Smooth vertex normals (see smooth.h).
//
// The corners of triangles are sorted by their welded vertices. Around a vertex, corners form a group
// if their triangles share edges without a crease. A group becomes a vertex.

#include "geom/mesh/smooth.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/mesh/edges.h"

// Triangles are in one flat face if their normals differ by less (radians).
#define FLAT 1e-4
// A normal of a vertex that differs by more from that of the triangle is one of a curved surface.
#define CURVED 1e-5

typedef struct Smoothing {
  const CagMesh *mesh;
  double cosine;    // of the crease
  CagVec3 *normals; // of triangles
  double *area;     // of triangles, then, at roots of `face`, of flat faces
  uint32_t *face;   // of triangles: a forest of flat faces
  uint32_t *group;  // of corners 3 t + k: a forest
  uint32_t *vertex; // of the roots of groups: the new vertex
  CagVec3 *sum;     // of the roots of groups
  CagVec3 *given;   // of the roots of groups: the sum of normals of curved surfaces
} Smoothing;

static uint32_t welded(const CagMesh *m, uint32_t v) { return m->weld ? m->weld[v] : v; }

static uint32_t root_of(uint32_t *forest, uint32_t i) {
  while (forest[i] != i) i = forest[i] = forest[forest[i]];
  return i;
}

static void join(uint32_t *forest, uint32_t a, uint32_t b) {
  a = root_of(forest, a);
  b = root_of(forest, b);
  // The lower index is the root, so that the result does not depend on the order.
  if (a < b) forest[b] = a;
  else forest[a] = b;
}

static bool take_memory(Smoothing *s) {
  const size_t n = s->mesh->triangle_count;
  s->normals = cag_malloc((n + 1) * sizeof *s->normals);
  s->area = cag_calloc(n + 1, sizeof *s->area);
  s->face = cag_malloc((n + 1) * sizeof *s->face);
  s->group = cag_malloc((3 * n + 1) * sizeof *s->group);
  s->vertex = cag_malloc((3 * n + 1) * sizeof *s->vertex);
  s->sum = cag_calloc(3 * n + 1, sizeof *s->sum);
  s->given = cag_calloc(3 * n + 1, sizeof *s->given);
  return s->normals && s->area && s->face && s->group && s->vertex && s->sum && s->given;
}

static void free_memory(Smoothing *s) {
  void *const all[] = {s->normals, s->area, s->face, s->group, s->vertex, s->sum, s->given};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) cag_free(all[i]);
}

static void measure_triangles(Smoothing *s) {
  const CagMesh *m = s->mesh;
  for (uint32_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *v = m->triangles + 3 * (size_t)t;
    const CagVec3 a = m->positions[v[0]];
    const CagVec3 cross = cag_cross(cag_sub(m->positions[v[1]], a), cag_sub(m->positions[v[2]], a));
    s->normals[t] = cag_unit(cross);
    s->area[t] = cag_norm(cross) / 2;
    s->face[t] = t;
    for (uint32_t k = 0; k < 3; k++) s->group[3 * t + k] = 3 * t + k;
  }
}

// The corner of a triangle at a welded vertex.
static uint32_t corner_at(const CagMesh *m, uint32_t t, uint32_t vertex) {
  uint32_t k = 0;
  while (k < 2 && welded(m, m->triangles[3 * (size_t)t + k]) != vertex) k++;
  return 3 * t + k;
}

// Joins the triangles at an edge, and their corners at its ends.
static void join_triangles(Smoothing *s, const CagMeshEdge *e, uint32_t t, uint32_t u) {
  const double cosine = cag_dot(s->normals[t], s->normals[u]);
  if (cosine > cos(FLAT)) join(s->face, t, u);
  if (!(cosine > s->cosine)) return;
  const uint32_t ends[2] = {(uint32_t)e->low, (uint32_t)e->high};
  for (int k = 0; k < 2; k++)
    join(s->group, corner_at(s->mesh, t, ends[k]), corner_at(s->mesh, u, ends[k]));
}

static CagStatus join_corners(Smoothing *s, CagError *err) {
  const CagMesh *m = s->mesh;
  size_t n = 0;
  CagMeshEdge *edges =
      cag_mesh_edges(m->triangles, m->triangle_count, m->weld, m->vertex_count, &n);
  CagStatus status = edges ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0, end; !status && i < n; i = end) {
    for (end = i + 1;
         end < n && edges[end].low == edges[i].low && edges[end].high == edges[i].high;)
      end++;
    if (end - i == 2)
      join_triangles(s, &edges[i], (uint32_t)cag_mesh_edge_triangle(&edges[i]),
                     (uint32_t)cag_mesh_edge_triangle(&edges[i + 1]));
    if (i % 1024 == 0) status = cag_stop_check(err);
  }
  cag_free(edges);
  for (uint32_t t = 0; !status && t < m->triangle_count; t++) {
    const uint32_t root = root_of(s->face, t);
    if (root != t) s->area[root] += s->area[t];
  }
  return status;
}

// The angle of a triangle at its corner, so that it does not matter how a flat face is divided.
static double corner_angle(const CagMesh *m, uint32_t c) {
  const uint32_t *v = m->triangles + 3 * (size_t)(c / 3);
  const CagVec3 p = m->positions[v[c % 3]];
  const CagVec3 a = cag_sub(m->positions[v[(c + 1) % 3]], p);
  const CagVec3 b = cag_sub(m->positions[v[(c + 2) % 3]], p);
  return atan2(cag_norm(cag_cross(a, b)), cag_dot(a, b));
}

// Adds up the normals of the groups, and numbers their vertices. Returns the number of vertices.
static size_t sum_groups(Smoothing *s) {
  const CagMesh *m = s->mesh;
  size_t n = 0;
  for (uint32_t c = 0; c < 3 * m->triangle_count; c++) {
    const uint32_t t = c / 3, root = root_of(s->group, c);
    const double area = s->area[root_of(s->face, t)];
    if (root == c) s->vertex[c] = (uint32_t)n++;
    s->sum[root] = cag_madd(s->sum[root], corner_angle(m, c) * area * area, s->normals[t]);
    if (!m->normals) continue;
    const CagVec3 own = m->normals[m->triangles[c]];
    if (cag_norm(cag_sub(own, s->normals[t])) > CURVED && cag_dot(own, s->normals[t]) > s->cosine)
      s->given[root] = cag_add(s->given[root], own);
  }
  return n;
}

static CagVec3 group_normal(const Smoothing *s, uint32_t root) {
  const CagVec3 given = cag_unit(s->given[root]), mean = cag_unit(s->sum[root]);
  if (cag_norm(given) > 0) return given;
  return cag_norm(mean) > 0 ? mean : s->normals[root / 3];
}

static CagStatus make_mesh(Smoothing *s, size_t n, CagMesh **out, CagError *err) {
  const CagMesh *m = s->mesh;
  CagMesh *made;
  uint32_t *first = cag_malloc((m->vertex_count + 1) * sizeof *first);
  CagStatus status = first ? CAG_OK : cag_fail_memory(err);
  if (!status) status = cag_mesh_new(n, m->triangle_count, true, false, true, &made, err);
  if (!status && m->labels) {
    made->labels = cag_malloc((m->triangle_count + 1) * sizeof *made->labels);
    if (made->labels) memcpy(made->labels, m->labels, m->triangle_count * sizeof *made->labels);
    else {
      cag_mesh_release(made);
      status = cag_fail_memory(err);
    }
  }
  if (status) {
    cag_free(first);
    return status;
  }
  for (size_t v = 0; v < m->vertex_count; v++) first[v] = UINT32_MAX;
  for (uint32_t c = 0; c < 3 * m->triangle_count; c++) {
    const uint32_t root = root_of(s->group, c), vertex = s->vertex[root];
    made->triangles[c] = vertex;
    if (root != c) continue;
    const uint32_t old = welded(m, m->triangles[c]);
    if (first[old] == UINT32_MAX) first[old] = vertex;
    made->positions[vertex] = m->positions[old];
    made->normals[vertex] = group_normal(s, root);
    made->weld[vertex] = first[old];
  }
  cag_free(first);
  *out = made;
  return CAG_OK;
}

CagStatus cag_mesh_smooth(const CagMesh *m, double crease, CagMesh **out, CagError *err) {
  Smoothing s = {.mesh = m, .cosine = cos(crease)};
  if (m->triangle_count >= UINT32_MAX / 3)
    return cag_fail(err, CAG_E_LIMIT, CAG_ERR_limit_triangles, "", -1,
                    "the mesh has too many triangles");
  CagStatus status = take_memory(&s) ? CAG_OK : cag_fail_memory(err);
  if (!status) {
    measure_triangles(&s);
    status = join_corners(&s, err);
  }
  if (!status) status = make_mesh(&s, sum_groups(&s), out, err);
  free_memory(&s);
  return status;
}
