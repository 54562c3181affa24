// Writes binary STL: an 80-byte header, the number of triangles, and 50 bytes per triangle.

#include "base/memory.h"

#include "base/stop.h"
#include "interp/formats/mesh_write.h"

enum { HEADER = 80, RECORD = 50, LANES = 8, BATCH = 1024 };

// Corners and normals of LANES triangles, one row per number, so that normals are computed with
// vector instructions.
typedef struct Lanes {
  float corner[9][LANES], normal[3][LANES], size[LANES];
} Lanes;

// Squared lengths that single precision represents well. Others are scaled first.
#define LEAST_SQUARE 1e-30f
#define MOST_SQUARE 1e30f

// Computes the unit normal of a very small or large triangle, or zero if it has no area.
static void put_normal(Lanes *l, int k) {
  CagVec3 p[3];
  for (int j = 0; j < 3; j++)
    p[j] = cag_vec3(l->corner[3 * j][k], l->corner[3 * j + 1][k], l->corner[3 * j + 2][k]);
  CagVec3 n = cag_unit(cag_cross(cag_sub(p[1], p[0]), cag_sub(p[2], p[0])));
  l->normal[0][k] = (float)n.x;
  l->normal[1][k] = (float)n.y;
  l->normal[2][k] = (float)n.z;
}

// Products of two floats are exact in double, so only one rounding remains for a slim triangle.
static void find_normals(Lanes *l) {
  for (int k = 0; k < LANES; k++) {
    double a[3], b[3];
    for (int i = 0; i < 3; i++) {
      a[i] = l->corner[3 + i][k] - l->corner[i][k];
      b[i] = l->corner[6 + i][k] - l->corner[i][k];
    }
    l->normal[0][k] = (float)(a[1] * b[2] - a[2] * b[1]);
    l->normal[1][k] = (float)(a[2] * b[0] - a[0] * b[2]);
    l->normal[2][k] = (float)(a[0] * b[1] - a[1] * b[0]);
  }
  int good = 1;
  for (int k = 0; k < LANES; k++) {
    float x = l->normal[0][k], y = l->normal[1][k], z = l->normal[2][k];
    float square = x * x + y * y + z * z, size = sqrtf(square);
    good &= square > LEAST_SQUARE && square < MOST_SQUARE;
    l->size[k] = size;
  }
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < LANES; k++) l->normal[i][k] /= l->size[k];
  for (int k = 0; k < LANES && !good; k++) {
    float square = l->size[k] * l->size[k];
    if (!(square > LEAST_SQUARE && square < MOST_SQUARE)) put_normal(l, k);
  }
}

// Writes n triangles, at most LANES, whose corners are p[3 k].
static char *put_triangles(char *at, const float *p, const uint32_t *corners, int n) {
  Lanes l;
  for (int k = 0; k < LANES; k++) {
    const uint32_t *t = corners + 3 * (k < n ? k : 0);
    for (int j = 0; j < 3; j++) {
      const float *q = p + 3 * (size_t)t[j];
      for (int i = 0; i < 3; i++) l.corner[3 * j + i][k] = q[i];
    }
  }
  find_normals(&l);
  for (int k = 0; k < n; k++) {
    for (int i = 0; i < 3; i++) at = cag_mesh_put_float(at, l.normal[i][k]);
    for (int i = 0; i < 9; i++) at = cag_mesh_put_float(at, l.corner[i][k]);
    at[0] = at[1] = 0; // attribute count
    at += 2;
  }
  return at;
}

static void write_all(const CagMesh *m, const float *p, CagAtomicFile *file) {
  for (size_t t = 0; t < m->triangle_count && !cag_stopped();) {
    char *at = cag_atomic_file_reserve(file, (size_t)BATCH * RECORD);
    size_t end = m->triangle_count - t < BATCH ? m->triangle_count : t + BATCH;
    for (; t < end; t += LANES)
      at = put_triangles(at, p, m->triangles + 3 * t, end - t < LANES ? (int)(end - t) : LANES);
    t = end;
    cag_atomic_file_advance(file, at);
  }
}

// Writes the triangles that do not degenerate.
static void write_kept(const CagMesh *m, const float *p, CagAtomicFile *file) {
  for (size_t t = 0; t < m->triangle_count && !cag_stopped(); t++) {
    const uint32_t *k = m->triangles + 3 * t;
    if (cag_mesh_shrinks(p, k)) continue;
    char *at = cag_atomic_file_reserve(file, RECORD);
    cag_atomic_file_advance(file, put_triangles(at, p, k, 1));
  }
}

CagStatus cag_export_stl(const CagMeshPart *parts, size_t n, const char *title, CagAtomicFile *file,
                         CagError *err) {
  float **positions = cag_calloc(n + 1, sizeof *positions);
  CagStatus status = positions ? CAG_OK : cag_fail_memory(err);
  size_t triangles = 0, shown = 0;
  for (size_t i = 0; !status && i < n; i++) {
    status = cag_mesh_floats(&parts[i], &positions[i], NULL, NULL, err);
    if (status) break;
    triangles += cag_mesh_kept_triangles(parts[i].mesh, positions[i]);
    shown += parts[i].mesh->triangle_count;
  }
  if (!status && triangles > UINT32_MAX)
    status = cag_fail(
        err, CAG_E_LIMIT, CAG_ERR_file_too_large, "", -1,
        "an STL file can have at most %lu triangles, but the scene has %zu; use a larger tolerance",
        (unsigned long)UINT32_MAX, triangles);
  if (!status) {
    // Readers treat a file that starts with "solid" as the text form.
    char header[HEADER + 4] = {0};
    strcpy(header, "cag: ");
    strncpy(header + 5, title ? title : "binary STL, mm", HEADER - 5);
    cag_mesh_put_u32(header + HEADER, (uint32_t)triangles);
    cag_atomic_file_expect(file, sizeof header + (uint64_t)triangles * RECORD);
    cag_atomic_file_write(file, header, sizeof header);
  }
  for (size_t i = 0; positions && i < n; i++) {
    if (!status && triangles == shown) write_all(parts[i].mesh, positions[i], file);
    else if (!status) write_kept(parts[i].mesh, positions[i], file);
    cag_free(positions[i]);
  }
  cag_free(positions);
  return status;
}
