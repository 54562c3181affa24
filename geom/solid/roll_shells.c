// Thin shells of meshes (see roll_shells.h).

#include "geom/solid/roll_shells.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

// The parts of the mesh by the first vertex of each, and what is known of it.
typedef struct Shells {
  uint32_t *parent;      // by vertices: a forest whose roots stand for shells
  double *volume, *area; // of roots
  bool *dropped;
} Shells;

static void shells_free(Shells *s) {
  cag_free(s->parent);
  cag_free(s->volume);
  cag_free(s->area);
  cag_free(s->dropped);
}

static uint32_t shell_root(uint32_t *parent, uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

static CagStatus find_shells(const CagMesh *m, Shells *s, CagError *err) {
  *s = (Shells){.parent = cag_calloc(m->vertex_count + 1, sizeof *s->parent),
                .volume = cag_calloc(m->vertex_count + 1, sizeof *s->volume),
                .area = cag_calloc(m->vertex_count + 1, sizeof *s->area),
                .dropped = cag_calloc(m->vertex_count + 1, sizeof *s->dropped)};
  if (!s->parent || !s->volume || !s->area || !s->dropped) return cag_fail_memory(err);
  for (uint32_t i = 0; i < m->vertex_count; i++) s->parent[i] = m->weld ? m->weld[i] : i;
  for (size_t t = 0; t < m->triangle_count; t++)
    for (int k = 1; k < 3; k++)
      s->parent[shell_root(s->parent, m->triangles[3 * t])] =
          shell_root(s->parent, m->triangles[3 * t + (size_t)k]);
  const CagVec3 origin = m->vertex_count ? m->positions[0] : cag_vec3(0, 0, 0);
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *c = m->triangles + 3 * t, root = shell_root(s->parent, c[0]);
    const CagVec3 a = cag_sub(m->positions[c[0]], origin), b = cag_sub(m->positions[c[1]], origin);
    const CagVec3 d = cag_sub(m->positions[c[2]], origin);
    s->volume[root] += cag_dot(a, cag_cross(b, d)) / 6;
    s->area[root] += cag_norm(cag_cross(cag_sub(b, a), cag_sub(d, a))) / 2;
  }
  return CAG_OK;
}

// Marks the shells to be dropped. Returns the number of their triangles.
static size_t mark_thin(const CagMesh *m, double tolerance, Shells *s) {
  double most = 0;
  size_t n = 0;
  for (size_t i = 0; i < m->vertex_count; i++) most = fmax(most, fabs(s->volume[i]));
  for (size_t i = 0; i < m->vertex_count; i++)
    s->dropped[i] = s->area[i] > 0 && fabs(s->volume[i]) < most &&
                    fabs(s->volume[i]) < tolerance * s->area[i] / 2;
  for (size_t t = 0; t < m->triangle_count; t++)
    n += s->dropped[shell_root(s->parent, m->triangles[3 * t])] ? 1 : 0;
  return n;
}

// Copies what is kept. Vertices keep their order, so that weld still refers to earlier ones.
static CagStatus copy_kept(const CagMesh *m, Shells *s, size_t triangles, CagMesh **out,
                           CagError *err) {
  uint32_t *number = cag_calloc(m->vertex_count + 1, sizeof *number), *labels = NULL;
  size_t vertices = 0;
  CagMesh *kept = NULL;
  CagStatus status = number ? CAG_OK : cag_fail_memory(err);
  for (uint32_t i = 0; number && i < m->vertex_count; i++)
    if (!s->dropped[shell_root(s->parent, i)]) number[i] = (uint32_t)vertices++;
  if (!status) status = cag_mesh_new(vertices, triangles, m->normals, m->uv, m->weld, &kept, err);
  if (!status && m->labels) {
    labels = cag_calloc(triangles + 1, sizeof *labels);
    if (!labels) status = cag_fail_memory(err);
  }
  for (uint32_t i = 0; !status && i < m->vertex_count; i++) {
    if (s->dropped[shell_root(s->parent, i)]) continue;
    const uint32_t k = number[i];
    kept->positions[k] = m->positions[i];
    if (m->normals) kept->normals[k] = m->normals[i];
    if (m->uv) memcpy(kept->uv + 2 * (size_t)k, m->uv + 2 * (size_t)i, 2 * sizeof *m->uv);
    if (m->weld) kept->weld[k] = number[m->weld[i]];
  }
  for (size_t t = 0, n = 0; !status && t < m->triangle_count; t++) {
    if (s->dropped[shell_root(s->parent, m->triangles[3 * t])]) continue;
    for (size_t k = 0; k < 3; k++) kept->triangles[3 * n + k] = number[m->triangles[3 * t + k]];
    if (labels) labels[n] = m->labels[t];
    n++;
  }
  cag_free(number);
  if (status) cag_mesh_release(kept);
  else {
    kept->labels = labels;
    kept->scale = m->scale;
    *out = kept;
  }
  return status;
}

CagStatus cag_roll_drop_thin_shells(const CagMesh *m, double tolerance, CagMesh **out,
                                    CagError *err) {
  Shells s;
  CagStatus status = find_shells(m, &s, err);
  const size_t thin = status ? 0 : mark_thin(m, tolerance, &s);
  if (!status && thin == 0) *out = cag_mesh_retain(m);
  if (!status && thin > 0) status = copy_kept(m, &s, m->triangle_count - thin, out, err);
  shells_free(&s);
  return status;
}
