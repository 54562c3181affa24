// Triangle meshes: construction, copying, transforms, joining, and reversal.
//
// A mesh is immutable once returned; all functions here make a new one. Measures and checks are in
// mesh_measure.c, welding in mesh_weld.c.

#include "geom/mesh/mesh.h"

#include <string.h>

#include "base/memory.h"
#include "geom/mesh/polygon.h"

static CagStatus too_large(size_t vertices, size_t triangles, CagError *err) {
  return cag_fail(
      err, CAG_E_LIMIT, CAG_ERR_mesh_too_large, "", -1,
      "a mesh can have at most %lu vertices, found %zu vertices and %zu triangles; use a larger tolerance",
      (unsigned long)UINT32_MAX, vertices, triangles);
}

CagStatus cag_mesh_new(size_t vertices, size_t triangles, bool normals, bool uv, bool weld,
                       CagMesh **out, CagError *err) {
  if (vertices > UINT32_MAX || triangles > SIZE_MAX / (8 * sizeof(uint32_t)))
    return too_large(vertices, triangles, err);
  CagMesh *m = cag_calloc(1, sizeof *m);
  if (!m) return cag_fail_memory(err);
  m->references = 1;
  m->vertex_count = vertices;
  m->triangle_count = triangles;
  // Allocate one more than needed, so that an empty array is not NULL, which means "none".
  m->positions = cag_malloc((vertices + 1) * sizeof *m->positions);
  m->triangles = cag_malloc((triangles + 1) * 3 * sizeof *m->triangles);
  if (normals) m->normals = cag_malloc((vertices + 1) * sizeof *m->normals);
  if (uv) m->uv = cag_malloc((vertices + 1) * 2 * sizeof *m->uv);
  if (weld) m->weld = cag_malloc((vertices + 1) * sizeof *m->weld);
  if (!m->positions || !m->triangles || (normals && !m->normals) || (uv && !m->uv) ||
      (weld && !m->weld)) {
    cag_mesh_release(m);
    return cag_fail_memory(err);
  }
  cag_memory_scattered(m->positions, (vertices + 1) * sizeof *m->positions);
  *out = m;
  return CAG_OK;
}

CagMesh *cag_mesh_retain(const CagMesh *m) {
  CagMesh *shared = (CagMesh *)m;
  shared->references++;
  return shared;
}

void cag_mesh_digest(const CagMesh *m, CagDigest *d) {
  const size_t v = m->vertex_count, t = m->triangle_count;
  cag_digest_bytes(d, m->positions, v * sizeof *m->positions);
  cag_digest_bytes(d, m->triangles, 3 * t * sizeof *m->triangles);
  if (m->normals) cag_digest_bytes(d, m->normals, v * sizeof *m->normals);
  if (m->uv) cag_digest_bytes(d, m->uv, 2 * v * sizeof *m->uv);
  if (m->labels) cag_digest_bytes(d, m->labels, t * sizeof *m->labels);
  cag_digest_word(d, (uint64_t)m->scale.kind << 32 | (uint64_t)m->scale.stripes);
  cag_digest_number(d, m->scale.from);
  cag_digest_number(d, m->scale.to);
}

void cag_mesh_release(CagMesh *m) {
  if (!m || --m->references > 0) return;
  cag_free(m->positions);
  cag_free(m->normals);
  cag_free(m->uv);
  cag_free(m->triangles);
  cag_free(m->weld);
  cag_free(m->labels);
  cag_free(m);
}

static bool check_triangle(const CagMesh *m, const uint32_t t[3]) {
  for (int k = 0; k < 3; k++)
    if (t[k] >= m->vertex_count || t[k] == t[(k + 1) % 3]) return false;
  return true;
}

bool cag_check_mesh(const CagMesh *m) {
  if (!m || m->references < 1 || !m->positions || !m->triangles) return false;
  for (size_t i = 0; i < m->vertex_count; i++) {
    const CagVec3 p = m->positions[i];
    if (!isfinite(p.x) || !isfinite(p.y) || !isfinite(p.z)) return false;
    if (!m->weld) continue;
    const size_t first = m->weld[i];
    if (first > i || m->weld[first] != first) return false;
    if (memcmp(&m->positions[first], &p, sizeof p) != 0) return false;
  }
  for (size_t i = 0; i < m->triangle_count; i++)
    if (!check_triangle(m, m->triangles + 3 * i)) return false;
  return true;
}

// --- Lists to a mesh ---

static CagStatus check_vertices(const CagVec3 *vertices, size_t n, CagError *err) {
  for (size_t i = 0; i < n; i++) {
    CagVec3 p = vertices[i];
    if (isfinite(p.x) && isfinite(p.y) && isfinite(p.z)) continue;
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_vertex_not_finite, "vertices", (long)i,
                    "`vertices` must be finite: vertices[%zu] = [%g, %g, %g]", i, p.x, p.y, p.z);
  }
  return CAG_OK;
}

// seen[v] is 1 + the last face that used v, so that a repeated corner is found without comparing
// all pairs.
static CagStatus check_face(const uint32_t *face, size_t count, size_t f, size_t n, size_t *seen,
                            CagError *err) {
  if (count < 3)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_face_degenerate, "faces", (long)f,
                    "a face needs 3 or more vertices: faces[%zu] has %zu", f, count);
  for (size_t k = 0; k < count; k++) {
    if (face[k] >= n)
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_face_index, "faces", (long)f,
                      "vertex indices in `faces` must be 0 to %zu: faces[%zu][%zu] = %lu",
                      n > 0 ? n - 1 : 0, f, k, (unsigned long)face[k]);
    if (seen[face[k]] == f + 1)
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_face_degenerate, "faces", (long)f,
                      "a face must not contain a vertex twice: faces[%zu] repeats %lu at [%zu]", f,
                      (unsigned long)face[k], k);
    seen[face[k]] = f + 1;
  }
  return CAG_OK;
}

static CagStatus check_faces(const uint32_t *indices, const uint32_t *counts, size_t faces,
                             size_t n, size_t *triangles, CagError *err) {
  size_t *seen = cag_calloc(n + 1, sizeof *seen);
  if (!seen) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  *triangles = 0;
  for (size_t f = 0, at = 0; f < faces && !status; at += counts[f++]) {
    status = check_face(indices + at, counts[f], f, n, seen, err);
    *triangles += counts[f] - 2;
  }
  cag_free(seen);
  return status;
}

CagStatus cag_mesh_from_faces(const CagVec3 *vertices, size_t n, const uint32_t *indices,
                              const uint32_t *counts, size_t faces, CagMesh **out, CagError *err) {
  CagStatus status = check_vertices(vertices, n, err);
  if (status) return status;
  size_t at = 0, triangles = 0;
  status = check_faces(indices, counts, faces, n, &triangles, err);
  if (status) return status;
  CagMesh *m = NULL;
  status = cag_mesh_new(n, triangles, false, false, false, &m, err);
  if (status) return status;
  memcpy(m->positions, vertices, n * sizeof *vertices);
  at = triangles = 0;
  for (size_t f = 0; f < faces; at += counts[f++]) {
    status = cag_polygon_triangulate(vertices, indices + at, counts[f], f,
                                     m->triangles + 3 * triangles, err);
    if (status) {
      cag_mesh_release(m);
      return status;
    }
    triangles += counts[f] - 2;
  }
  *out = m;
  return CAG_OK;
}

// --- Copies ---

// Copies the labels of m to `to`, starting at triangle `first`.
static bool copy_labels(const CagMesh *m, CagMesh *to, size_t first) {
  if (!m->labels) return true;
  if (!to->labels) to->labels = cag_calloc(to->triangle_count + 1, sizeof *to->labels);
  if (to->labels) memcpy(to->labels + first, m->labels, m->triangle_count * sizeof *m->labels);
  return to->labels != NULL;
}

static CagStatus copy_mesh(const CagMesh *m, CagMesh **out, CagError *err) {
  CagMesh *c = NULL;
  CagStatus status = cag_mesh_new(m->vertex_count, m->triangle_count, m->normals != NULL,
                                  m->uv != NULL, m->weld != NULL, &c, err);
  if (status) return status;
  size_t n = m->vertex_count;
  memcpy(c->positions, m->positions, n * sizeof *m->positions);
  memcpy(c->triangles, m->triangles, m->triangle_count * 3 * sizeof *m->triangles);
  if (m->normals) memcpy(c->normals, m->normals, n * sizeof *m->normals);
  if (m->uv) memcpy(c->uv, m->uv, n * 2 * sizeof *m->uv);
  c->scale = m->scale;
  if (m->weld) memcpy(c->weld, m->weld, n * sizeof *m->weld);
  if (!copy_labels(m, c, 0)) {
    cag_mesh_release(c);
    return cag_fail_memory(err);
  }
  *out = c;
  return CAG_OK;
}

static void turn_triangles(CagMesh *m) {
  for (size_t t = 0; t < m->triangle_count; t++) {
    uint32_t second = m->triangles[3 * t + 1];
    m->triangles[3 * t + 1] = m->triangles[3 * t + 2];
    m->triangles[3 * t + 2] = second;
  }
}

CagStatus cag_mesh_flip(const CagMesh *m, CagMesh **out, CagError *err) {
  CagStatus status = copy_mesh(m, out, err);
  if (status) return status;
  turn_triangles(*out);
  if (m->normals)
    for (size_t i = 0; i < m->vertex_count; i++)
      (*out)->normals[i] = cag_scaled((*out)->normals[i], -1);
  return CAG_OK;
}

// Normal at p under t: the cofactors of the map's derivative at p transform normals. For a
// projective map x -> A x / w the derivative is (A - image w')/w, which varies from point to point.
// Under a reflection the result points inward.
static CagVec3 transform_normal(const CagTransform *t, CagVec3 p, CagVec3 image, CagVec3 normal) {
  double w = t->m[3][0] * p.x + t->m[3][1] * p.y + t->m[3][2] * p.z + t->m[3][3];
  CagVec3 c[3];
  for (int k = 0; k < 3; k++) {
    CagVec3 column = cag_vec3(t->m[0][k], t->m[1][k], t->m[2][k]);
    c[k] = cag_scaled(cag_madd(column, -t->m[3][k], image), 1 / w);
  }
  CagVec3 n = cag_scaled(cag_cross(c[1], c[2]), normal.x);
  n = cag_madd(n, normal.y, cag_cross(c[2], c[0]));
  n = cag_madd(n, normal.z, cag_cross(c[0], c[1]));
  return cag_unit(n);
}

CagStatus cag_mesh_transform(const CagMesh *m, const CagTransform *t, CagMesh **out,
                             CagError *err) {
  CagMesh *c = NULL;
  CagStatus status = copy_mesh(m, &c, err);
  if (status) return status;
  bool mirrors = cag_transform_mirrors(t);
  for (size_t i = 0; i < c->vertex_count; i++) {
    CagVec3 p = m->positions[i], image = cag_transform_point(t, p);
    if (!isfinite(image.x) || !isfinite(image.y) || !isfinite(image.z)) {
      cag_mesh_release(c);
      return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_point_at_infinity, "transform", (long)i,
                      "the transform moves vertex %zu, [%g, %g, %g], to infinity", i, p.x, p.y,
                      p.z);
    }
    c->positions[i] = image;
    if (c->normals) {
      CagVec3 normal = transform_normal(t, p, image, m->normals[i]);
      c->normals[i] = mirrors ? cag_scaled(normal, -1) : normal;
    }
  }
  if (mirrors) turn_triangles(c);
  *out = c;
  return CAG_OK;
}

// Area-weighted normals at shared vertices, for parts of a joined mesh that have no normals when
// other parts do.
static void smooth_normals(CagMesh *m, size_t first_vertex, size_t vertices, size_t first_triangle,
                           size_t triangles) {
  for (size_t i = 0; i < vertices; i++) m->normals[first_vertex + i] = cag_vec3(0, 0, 0);
  for (size_t t = first_triangle; t < first_triangle + triangles; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    CagVec3 a = m->positions[k[0]];
    CagVec3 n = cag_cross(cag_sub(m->positions[k[1]], a), cag_sub(m->positions[k[2]], a));
    for (int j = 0; j < 3; j++) m->normals[k[j]] = cag_add(m->normals[k[j]], n);
  }
  for (size_t i = 0; i < vertices; i++)
    m->normals[first_vertex + i] = cag_unit(m->normals[first_vertex + i]);
}

// Values with a common scale are kept; if another part has parameters, the colors are dropped.
static CagColorScale common_scale(CagMesh *const *meshes, size_t n) {
  CagColorScale first = n > 0 ? meshes[0]->scale : (CagColorScale){0};
  for (size_t i = 1; i < n; i++) {
    const CagColorScale *s = &meshes[i]->scale;
    if (s->kind != first.kind || s->from != first.from || s->to != first.to ||
        s->stripes != first.stripes)
      return (CagColorScale){0};
  }
  return first;
}

CagStatus cag_mesh_append(CagMesh *const *meshes, size_t n, CagMesh **out, CagError *err) {
  size_t vertices = 0, triangles = 0;
  bool normals = false, uv = n > 0, weld = false;
  for (size_t i = 0; i < n; i++) {
    vertices += meshes[i]->vertex_count;
    triangles += meshes[i]->triangle_count;
    normals |= meshes[i]->normals != NULL;
    uv &= meshes[i]->uv != NULL;
    weld |= meshes[i]->weld != NULL;
  }
  CagMesh *m = NULL;
  CagStatus status = cag_mesh_new(vertices, triangles, normals, uv, weld, &m, err);
  if (status) return status;
  size_t v = 0, t = 0;
  bool labeled = true;
  if (uv) m->scale = common_scale(meshes, n);
  for (size_t i = 0; i < n; i++) {
    const CagMesh *part = meshes[i];
    memcpy(m->positions + v, part->positions, part->vertex_count * sizeof *m->positions);
    for (size_t k = 0; k < 3 * part->triangle_count; k++)
      m->triangles[3 * t + k] = (uint32_t)(v + part->triangles[k]);
    if (uv) memcpy(m->uv + 2 * v, part->uv, part->vertex_count * 2 * sizeof *m->uv);
    for (size_t k = 0; weld && k < part->vertex_count; k++)
      m->weld[v + k] = (uint32_t)(v + (part->weld ? part->weld[k] : k));
    if (part->normals)
      memcpy(m->normals + v, part->normals, part->vertex_count * sizeof *m->normals);
    else if (normals) smooth_normals(m, v, part->vertex_count, t, part->triangle_count);
    labeled = copy_labels(part, m, t) && labeled;
    v += part->vertex_count;
    t += part->triangle_count;
  }
  if (!labeled) {
    cag_mesh_release(m);
    return cag_fail_memory(err);
  }
  *out = m;
  return CAG_OK;
}
