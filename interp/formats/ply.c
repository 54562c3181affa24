// Writes binary PLY, little-endian: a list of vertices with normals, parameters, and colors, and a
// list of triangles. The vertices of a point are merged unless their normals differ, as at a sharp
// edge.

#include "base/memory.h"

#include "base/stop.h"
#include "interp/formats/mesh_write.h"
#include "interp/scene/color_scale.h"

enum { VERTEX_BYTES = 8 * 4 + 3, FACE_BYTES = 1 + 3 * 4, BATCH = 1024 };

typedef struct PlyPart {
  float *positions;
  uint32_t *number; // of each vertex in the file; NULL: consecutive, from `first` on
  CagVec3 *sums;    // normals of the points of a mesh without normals
  size_t first, vertices, triangles;
} PlyPart;

static uint32_t point_of(const CagMesh *m, size_t v) { return m->weld ? m->weld[v] : (uint32_t)v; }

// Sums up the normals of the triangles at each point, for a mesh without normals.
static bool sum_normals(const CagMesh *m, PlyPart *p) {
  if (m->normals) return true;
  p->sums = cag_malloc((m->vertex_count + 1) * sizeof *p->sums);
  if (!p->sums) return false;
  for (size_t v = 0; v < m->vertex_count; v++) p->sums[v] = cag_vec3(0, 0, 0);
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    CagVec3 a = m->positions[k[0]];
    CagVec3 n = cag_cross(cag_sub(m->positions[k[1]], a), cag_sub(m->positions[k[2]], a));
    for (int j = 0; j < 3; j++) {
      uint32_t point = point_of(m, k[j]);
      p->sums[point] = cag_add(p->sums[point], n);
    }
  }
  return true;
}

// Tests whether each vertex is a separate point.
static bool is_plain(const CagMesh *m) {
  size_t v = 0;
  while (m->weld && v < m->vertex_count && m->weld[v] == v) v++;
  return !m->weld || v == m->vertex_count;
}

static bool same_normal(const CagMesh *m, size_t a, size_t b) {
  const double same_direction = 1 - 1e-6; // cosine of 0.08 degrees, as in cag_mesh_weld
  return !m->normals || cag_dot(m->normals[a], m->normals[b]) >= same_direction;
}

// Numbers the vertices in ascending order from `first`; equal vertices get the same number. `next`
// links a point's vertex to the other vertices of the point that have their own numbers.
static void number_vertices(const CagMesh *m, PlyPart *p, uint32_t *next) {
  p->vertices = 0;
  for (size_t v = 0; v < m->vertex_count; v++) {
    uint32_t like = point_of(m, v), last = like;
    next[v] = UINT32_MAX;
    for (; like != v && like != UINT32_MAX && !same_normal(m, v, like); like = next[like])
      last = like;
    if (like != v && like != UINT32_MAX) {
      p->number[v] = p->number[like];
      continue;
    }
    p->number[v] = (uint32_t)(p->first + p->vertices++);
    if (last != v) next[last] = (uint32_t)v;
  }
}

static bool begin_part(PlyPart *p, const CagMesh *m, size_t first) {
  p->first = first;
  p->vertices = m->vertex_count;
  p->triangles = cag_mesh_kept_triangles(m, p->positions);
  if (!sum_normals(m, p)) return false;
  if (is_plain(m)) return true;
  uint32_t *next = cag_malloc((m->vertex_count + 1) * sizeof *next);
  p->number = cag_malloc((m->vertex_count + 1) * sizeof *p->number);
  const bool made = next && p->number;
  if (made) number_vertices(m, p, next);
  cag_free(next);
  return made;
}

static void write_header(size_t vertices, size_t triangles, CagAtomicFile *file) {
  cag_atomic_file_printf(file,
                         "ply\nformat binary_little_endian 1.0\ncomment written by cag, lengths "
                         "in mm, z up\nelement vertex %zu\n",
                         vertices);
  static const char *const floats[] = {"x", "y", "z", "nx", "ny", "nz", "s", "t"};
  for (size_t k = 0; k < sizeof floats / sizeof *floats; k++)
    cag_atomic_file_printf(file, "property float %s\n", floats[k]);
  cag_atomic_file_printf(file,
                         "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                         "element face %zu\nproperty list uchar uint vertex_indices\nend_header\n",
                         triangles);
}

static void color_bytes(CagColor c, unsigned char rgb[3]) {
  const double linear[3] = {c.r, c.g, c.b};
  for (int k = 0; k < 3; k++)
    rgb[k] = (unsigned char)(255 * cag_linear_to_srgb(fmin(fmax(linear[k], 0), 1)) + 0.5);
}

static char *put_vertex(char *at, const float *p, CagVec3 n, const double *uv,
                        const unsigned char *rgb) {
  const float x[8] = {p[0],
                      p[1],
                      p[2],
                      (float)n.x,
                      (float)n.y,
                      (float)n.z,
                      uv ? (float)uv[0] : 0,
                      uv ? (float)uv[1] : 0};
  for (int k = 0; k < 8; k++) at = cag_mesh_put_float(at, x[k]);
  memcpy(at, rgb, 3);
  return at + 3;
}

static void write_vertices(const CagMeshPart *part, const PlyPart *p, CagAtomicFile *file) {
  const CagMesh *m = part->mesh;
  unsigned char rgb[3];
  size_t number = p->first;
  color_bytes(part->material ? part->material->color : (CagColor){1, 1, 1}, rgb);
  for (size_t v = 0; v < m->vertex_count && !cag_stopped();) {
    char *at = cag_atomic_file_reserve(file, (size_t)BATCH * VERTEX_BYTES);
    size_t end = m->vertex_count - v < BATCH ? m->vertex_count : v + BATCH;
    for (; v < end; v++) {
      if (p->number && p->number[v] != number) continue; // an equal one has been written
      number++;
      if (m->scale.kind) color_bytes(cag_color_scale_at(&m->scale, m->uv[2 * v]), rgb);
      CagVec3 n = p->sums ? cag_unit(p->sums[v]) : m->normals[v];
      at = put_vertex(at, p->positions + 3 * v, n, m->uv ? m->uv + 2 * v : NULL, rgb);
    }
    cag_atomic_file_advance(file, at);
  }
}

static void write_faces(const CagMesh *m, const PlyPart *p, CagAtomicFile *file) {
  bool all = p->triangles == m->triangle_count;
  uint32_t first = (uint32_t)p->first;
  for (size_t t = 0; t < m->triangle_count && !cag_stopped();) {
    char *at = cag_atomic_file_reserve(file, (size_t)BATCH * FACE_BYTES);
    size_t end = m->triangle_count - t < BATCH ? m->triangle_count : t + BATCH;
    for (; t < end; t++) {
      const uint32_t *k = m->triangles + 3 * t;
      if (!all && cag_mesh_shrinks(p->positions, k)) continue;
      *at++ = 3;
      for (int j = 0; j < 3; j++)
        at = cag_mesh_put_u32(at, p->number ? p->number[k[j]] : first + k[j]);
    }
    cag_atomic_file_advance(file, at);
  }
}

CagStatus cag_export_ply(const CagMeshPart *parts, size_t n, CagAtomicFile *file, CagError *err) {
  PlyPart *p = cag_calloc(n + 1, sizeof *p);
  size_t vertices = 0, triangles = 0;
  CagStatus status = p ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++) {
    status = cag_mesh_floats(&parts[i], &p[i].positions, NULL, NULL, err);
    if (status) break;
    if (!begin_part(&p[i], parts[i].mesh, vertices)) status = cag_fail_memory(err);
    vertices += p[i].vertices;
    triangles += p[i].triangles;
    if (!status && vertices > UINT32_MAX)
      status = cag_fail(err, CAG_E_LIMIT, CAG_ERR_file_too_large, "", -1,
                        "a PLY file can have at most %lu vertices; use a larger tolerance",
                        (unsigned long)UINT32_MAX);
  }
  if (!status) {
    const uint64_t header = 512; // about
    cag_atomic_file_expect(file, header + (uint64_t)vertices * VERTEX_BYTES +
                                     (uint64_t)triangles * FACE_BYTES);
    write_header(vertices, triangles, file);
    for (size_t i = 0; i < n; i++) write_vertices(&parts[i], &p[i], file);
    for (size_t i = 0; i < n; i++) write_faces(parts[i].mesh, &p[i], file);
  }
  for (size_t i = 0; p && i < n; i++) {
    cag_free(p[i].positions);
    cag_free(p[i].number);
    cag_free(p[i].sums);
  }
  cag_free(p);
  return status;
}
