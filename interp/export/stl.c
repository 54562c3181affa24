// Binary STL: an 80-byte header, the number of triangles, 50 bytes each.

#include <stdlib.h>

#include "interp/export/mesh_write.h"

enum { HEADER = 80, RECORD = 50, BATCH = 1024 };

static char *put_triangle(char *at, const CagMesh *m, const float *p, const uint32_t *k) {
  CagVec3 a = m->positions[k[0]];
  CagVec3 n = cag_unit(cag_cross(cag_sub(m->positions[k[1]], a), cag_sub(m->positions[k[2]], a)));
  at = cag_mesh_put_float(at, (float)n.x);
  at = cag_mesh_put_float(at, (float)n.y);
  at = cag_mesh_put_float(at, (float)n.z);
  for (int j = 0; j < 3; j++)
    for (int axis = 0; axis < 3; axis++) at = cag_mesh_put_float(at, p[3 * (size_t)k[j] + axis]);
  at[0] = at[1] = 0; // attribute count
  return at + 2;
}

// `all`: no triangle shrinks, as is nearly always so.
static void put_triangles(const CagMesh *m, const float *p, bool all, CagAtomicFile *file) {
  for (size_t t = 0; t < m->triangle_count;) {
    char *at = cag_atomic_file_reserve(file, (size_t)BATCH * RECORD);
    for (size_t end = t + BATCH; t < m->triangle_count && t < end; t++) {
      const uint32_t *k = m->triangles + 3 * t;
      if (all || !cag_mesh_shrinks(p, k)) at = put_triangle(at, m, p, k);
    }
    cag_atomic_file_advance(file, at);
  }
}

CagStatus cag_export_stl(const CagMeshPart *parts, size_t n, const char *title, CagAtomicFile *file,
                         CagError *err) {
  float **positions = calloc(n + 1, sizeof *positions);
  CagStatus status = positions ? CAG_OK : cag_fail_memory(err);
  size_t triangles = 0, shown = 0;
  for (size_t i = 0; status == CAG_OK && i < n; i++) {
    status = cag_mesh_floats(&parts[i], &positions[i], NULL, NULL, err);
    if (status != CAG_OK) break;
    triangles += cag_mesh_kept_triangles(parts[i].mesh, positions[i]);
    shown += parts[i].mesh->triangle_count;
  }
  if (status == CAG_OK && triangles > UINT32_MAX)
    status = cag_fail(err, CAG_E_LIMIT, "file-too-large", "", -1,
                      "an STL file holds at most %lu triangles, the scene has %zu: use a larger "
                      "tolerance",
                      (unsigned long)UINT32_MAX, triangles);
  if (status == CAG_OK) {
    // Readers take a file that begins with "solid" for the text form.
    char header[HEADER + 4] = {0};
    strcpy(header, "cag: ");
    strncpy(header + 5, title ? title : "binary STL, mm", HEADER - 5);
    cag_mesh_put_u32(header + HEADER, (uint32_t)triangles);
    cag_atomic_file_write(file, header, sizeof header);
  }
  for (size_t i = 0; positions && i < n; i++) {
    if (status == CAG_OK) put_triangles(parts[i].mesh, positions[i], triangles == shown, file);
    free(positions[i]);
  }
  free(positions);
  return status;
}
