// Meshes mapped onto a surface.
//
// Edges are divided, not triangles: whether an edge is split depends only on its ends, so both
// adjacent triangles agree, and no cracks appear.

#include "geom/surface/mapped.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"

// Maximum length of an edge, as a fraction of the domain's diagonal; longer edges might miss waves.
#define SPAN 0.08
#define ROUNDS 14
#define DEFAULT_TOLERANCE 1e-3

typedef struct Vertex {
  CagVec3 from, to, normal;
} Vertex;

typedef struct Mapping {
  const CagSurface *s;
  double tolerance, span;
  Vertex *vertices;
  size_t count, capacity;
  uint32_t *triangles;
  size_t triangle_count, triangle_most;
  // Midpoints of the edges in this round, by the pair of ends; NONE if the edge is not split.
  uint64_t *keys;
  uint32_t *middles;
  size_t slots;
  CagStatus status;
  CagError *err;
} Mapping;

#define NONE UINT32_MAX
#define EMPTY UINT64_MAX

static bool map_vertex(Mapping *m, CagVec3 p, Vertex *out) {
  out->from = p;
  out->normal = cag_vec3(0, 0, 0);
  m->status = cag_surface_point(m->s, p.x, p.y, &out->to, m->err);
  if (!m->status) m->status = cag_surface_normal(m->s, p.x, p.y, &out->normal, m->err);
  // A point on the surface itself does not need a normal.
  if (m->status == CAG_E_DEGENERATE && p.z == 0) m->status = CAG_OK;
  out->to = cag_madd(out->to, p.z, out->normal);
  return !m->status;
}

static uint32_t add_vertex(Mapping *m, const Vertex *v) {
  if (!CAG_RESERVE(m->vertices, m->capacity, m->count + 1)) {
    m->status = cag_fail_memory(m->err);
    return NONE;
  }
  m->vertices[m->count] = *v;
  return (uint32_t)m->count++;
}

static bool load(Mapping *m, const CagMesh *mesh) {
  // Copies of a vertex at sharp edges are identified here.
  uint32_t *place = cag_malloc((mesh->vertex_count + 1) * sizeof *place);
  m->triangle_count = mesh->triangle_count;
  m->triangles = cag_malloc((3 * mesh->triangle_count + 1) * sizeof *m->triangles);
  if (!place || !m->triangles) m->status = cag_fail_memory(m->err);
  for (size_t i = 0; i < mesh->vertex_count && !m->status; i++) {
    uint32_t first = mesh->weld ? mesh->weld[i] : (uint32_t)i;
    Vertex v;
    if (first < i) place[i] = place[first];
    else if (map_vertex(m, mesh->positions[i], &v)) place[i] = add_vertex(m, &v);
  }
  for (size_t i = 0; i < 3 * mesh->triangle_count && !m->status; i++)
    m->triangles[i] = place[mesh->triangles[i]];
  cag_free(place);
  return !m->status;
}

// --- Edges of a round ---

static bool make_table(Mapping *m) {
  size_t slots = 16;
  while (slots < 6 * m->triangle_count) slots *= 2; // at most half full
  cag_free(m->keys);
  cag_free(m->middles);
  m->slots = slots;
  m->keys = cag_malloc(slots * sizeof *m->keys);
  m->middles = cag_malloc(slots * sizeof *m->middles);
  if (m->keys && m->middles) memset(m->keys, 0xff, slots * sizeof *m->keys);
  else m->status = cag_fail_memory(m->err);
  return !m->status;
}

static size_t slot_of(const Mapping *m, uint64_t key) {
  const uint64_t golden = 0x9e3779b97f4a7c15u;
  size_t slot = (size_t)((key * golden) >> 20) & (m->slots - 1);
  while (m->keys[slot] != EMPTY && m->keys[slot] != key) slot = (slot + 1) & (m->slots - 1);
  return slot;
}

static uint32_t divide(Mapping *m, uint32_t a, uint32_t b) {
  Vertex p = m->vertices[a], q = m->vertices[b], middle;
  if (m->status || !map_vertex(m, cag_lerp(p.from, q.from, 0.5), &middle)) return NONE;
  double off = cag_norm(cag_sub(middle.to, cag_lerp(p.to, q.to, 0.5)));
  double span = hypot((q.from.x - p.from.x) / (m->s->u1 - m->s->u0),
                      (q.from.y - p.from.y) / (m->s->v1 - m->s->v0));
  return off <= m->tolerance && span <= m->span ? NONE : add_vertex(m, &middle);
}

static uint32_t middle_of(Mapping *m, uint32_t a, uint32_t b) {
  uint32_t low = a < b ? a : b, high = a < b ? b : a;
  uint64_t key = (uint64_t)low << 32 | high;
  size_t slot = slot_of(m, key);
  if (m->keys[slot] == EMPTY) {
    m->keys[slot] = key;
    m->middles[slot] = divide(m, low, high);
  }
  return m->middles[slot];
}

// --- Triangles of a round ---

static void put(uint32_t *out, size_t *n, uint32_t a, uint32_t b, uint32_t c) {
  out[(*n)++] = a;
  out[(*n)++] = b;
  out[(*n)++] = c;
}

// The parts of a triangle, at most four, from the midpoints of its edges ab, bc, ca.
static void divide_triangle(const uint32_t v[3], const uint32_t e[3], uint32_t *out, size_t *n) {
  int split = (e[0] != NONE) + (e[1] != NONE) + (e[2] != NONE);
  if (split == 0) {
    put(out, n, v[0], v[1], v[2]);
    return;
  }
  if (split == 3) {
    put(out, n, v[0], e[0], e[2]);
    put(out, n, v[1], e[1], e[0]);
    put(out, n, v[2], e[2], e[1]);
    put(out, n, e[0], e[1], e[2]);
    return;
  }
  // Rotated so that a single split edge comes first, or a single unsplit one last.
  int k = 0;
  while (split == 1 ? e[k] == NONE : e[(k + 2) % 3] != NONE) k++;
  uint32_t a = v[k], b = v[(k + 1) % 3], c = v[(k + 2) % 3], ab = e[k], bc = e[(k + 1) % 3];
  if (split == 1) {
    put(out, n, a, ab, c);
    put(out, n, ab, b, c);
    return;
  }
  put(out, n, ab, b, bc);
  put(out, n, a, ab, c);
  put(out, n, ab, bc, c);
}

static bool divide_all(Mapping *m, bool *changed) {
  if (!make_table(m)) return false;
  size_t before = m->count, n = 0;
  uint32_t *parts = cag_malloc((12 * m->triangle_count + 1) * sizeof *parts);
  if (!parts) m->status = cag_fail_memory(m->err);
  for (size_t t = 0; t < m->triangle_count && !m->status; t++) {
    const uint32_t *v = &m->triangles[3 * t];
    const uint32_t e[3] = {middle_of(m, v[0], v[1]), middle_of(m, v[1], v[2]),
                           middle_of(m, v[2], v[0])};
    divide_triangle(v, e, parts, &n);
  }
  *changed = m->count > before;
  if (m->status) {
    cag_free(parts);
    return false;
  }
  cag_free(m->triangles);
  m->triangles = parts;
  m->triangle_count = n / 3;
  if (m->triangle_count <= m->triangle_most) return true;
  m->status =
      cag_fail(m->err, CAG_E_LIMIT, CAG_ERR_limit_triangles, "", -1,
               "the image needs more than %zu triangles; use a larger tolerance", m->triangle_most);
  return false;
}

static double size_of(const Mapping *m) {
  CagBounds b = CAG_BOUNDS_EMPTY;
  for (size_t i = 0; i < m->count; i++) cag_bounds_add(&b, m->vertices[i].to);
  return m->count > 0 ? cag_norm(cag_sub(b.max, b.min)) : 0;
}

static CagStatus mapped_mesh(const Mapping *m, bool sheet, CagMesh **out, CagError *err) {
  CagStatus status = cag_mesh_new(m->count, m->triangle_count, sheet, false, false, out, err);
  for (size_t i = 0; i < m->count && !status; i++) {
    (*out)->positions[i] = m->vertices[i].to;
    if (sheet) (*out)->normals[i] = m->vertices[i].normal;
  }
  if (!status)
    memcpy((*out)->triangles, m->triangles, 3 * m->triangle_count * sizeof *m->triangles);
  return status;
}

CagStatus cag_mesh_onto_surface(const CagMesh *mesh, const CagSurface *s, double tolerance,
                                bool sheet, size_t max_triangles, CagMesh **out, CagError *err) {
  Mapping m = {.s = s, .tolerance = tolerance, .span = SPAN, .err = err};
  m.triangle_most = max_triangles;
  bool changed = load(&m, mesh);
  // The size of the image is known once its edges are short.
  for (int round = 0; round < ROUNDS && changed; round++) {
    if (!(tolerance > 0)) m.tolerance = DEFAULT_TOLERANCE * size_of(&m);
    if (!divide_all(&m, &changed)) break;
  }
  CagStatus status = m.status ? m.status : mapped_mesh(&m, sheet, out, err);
  cag_free(m.vertices);
  cag_free(m.triangles);
  cag_free(m.keys);
  cag_free(m.middles);
  return status;
}
