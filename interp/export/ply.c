// Binary PLY, little-endian: one welded list of vertices with normals, parameters and colours, and
// one of triangles.

#include <stdlib.h>

#include "interp/export/mesh_write.h"
#include "interp/scene/color_scale.h"

enum { VERTEX_BYTES = 8 * 4 + 3, FACE_BYTES = 1 + 3 * 4, BATCH = 1024 };

typedef struct PlyPart {
  float *positions;
  uint32_t *number; // of a vertex in the file; NULL: its own, from `first` on
  CagVec3 *sums;    // normals of points, those of their vertices together; NULL: the mesh's own do
  size_t first, vertices, triangles;
} PlyPart;

static uint32_t point_of(const CagMesh *m, size_t v) { return m->weld ? m->weld[v] : (uint32_t)v; }

static bool same_vector(CagVec3 a, CagVec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

// Adds each vertex's normal to its point's, one of many alike once; a mesh without normals gets
// those of its triangles.
static void sum_normals(const CagMesh *m, CagVec3 *sums) {
  for (size_t v = 0; v < m->vertex_count; v++) sums[v] = cag_vec3(0, 0, 0);
  if (m->normals) {
    for (size_t v = 0; v < m->vertex_count; v++) {
      uint32_t p = point_of(m, v);
      if (p == v || !same_vector(m->normals[v], m->normals[p]))
        sums[p] = cag_add(sums[p], m->normals[v]);
    }
    return;
  }
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    CagVec3 a = m->positions[k[0]];
    CagVec3 n = cag_cross(cag_sub(m->positions[k[1]], a), cag_sub(m->positions[k[2]], a));
    for (int j = 0; j < 3; j++) {
      uint32_t p = point_of(m, k[j]);
      sums[p] = cag_add(sums[p], n);
    }
  }
}

// True when each vertex is a point of its own.
static bool is_plain(const CagMesh *m) {
  size_t v = 0;
  while (m->weld && v < m->vertex_count && m->weld[v] == v) v++;
  return !m->weld || v == m->vertex_count;
}

static bool begin_part(PlyPart *p, const CagMesh *m, size_t first) {
  bool plain = is_plain(m);
  p->first = first;
  p->vertices = m->vertex_count;
  p->triangles = cag_mesh_kept_triangles(m, p->positions);
  if (!plain || !m->normals) {
    p->sums = malloc((m->vertex_count + 1) * sizeof *p->sums);
    if (!p->sums) return false;
    sum_normals(m, p->sums);
  }
  if (plain) return true;
  p->number = malloc((m->vertex_count + 1) * sizeof *p->number);
  if (!p->number) return false;
  p->vertices = 0;
  for (size_t v = 0; v < m->vertex_count; v++) {
    uint32_t point = point_of(m, v);
    p->number[v] = point == v ? (uint32_t)(first + p->vertices++) : p->number[point];
  }
  return true;
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
  color_bytes(part->material ? part->material->color : (CagColor){1, 1, 1}, rgb);
  for (size_t v = 0; v < m->vertex_count;) {
    char *at = cag_atomic_file_reserve(file, (size_t)BATCH * VERTEX_BYTES);
    size_t end = m->vertex_count - v < BATCH ? m->vertex_count : v + BATCH;
    for (; v < end; v++) {
      if (p->number && m->weld[v] != v) continue;
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
  for (size_t t = 0; t < m->triangle_count;) {
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
  PlyPart *p = calloc(n + 1, sizeof *p);
  size_t vertices = 0, triangles = 0;
  CagStatus status = p ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; status == CAG_OK && i < n; i++) {
    status = cag_mesh_floats(&parts[i], &p[i].positions, NULL, NULL, err);
    if (status != CAG_OK) break;
    if (!begin_part(&p[i], parts[i].mesh, vertices)) status = cag_fail_memory(err);
    vertices += p[i].vertices;
    triangles += p[i].triangles;
    if (status == CAG_OK && vertices > UINT32_MAX)
      status = cag_fail(err, CAG_E_LIMIT, "file-too-large", "", -1,
                        "a PLY file holds at most %lu vertices: use a larger tolerance",
                        (unsigned long)UINT32_MAX);
  }
  if (status == CAG_OK) {
    const uint64_t header = 512; // about
    cag_atomic_file_expect(file, header + (uint64_t)vertices * VERTEX_BYTES +
                                     (uint64_t)triangles * FACE_BYTES);
    write_header(vertices, triangles, file);
    for (size_t i = 0; i < n; i++) write_vertices(&parts[i], &p[i], file);
    for (size_t i = 0; i < n; i++) write_faces(parts[i].mesh, &p[i], file);
  }
  for (size_t i = 0; p && i < n; i++) {
    free(p[i].positions);
    free(p[i].number);
    free(p[i].sums);
  }
  free(p);
  return status;
}
