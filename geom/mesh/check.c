// Checks whether faces form a boundary: uses of edges are sorted so that those of one edge are
// adjacent; union-find forests over the faces and over their corners determine shells and fans.

#include "geom/mesh/check.h"

#include <math.h>

#include "base/memory.h"
#include "base/sort.h"

// A use of an edge by a face. Corners are positions in the list of indices; low < high are
// vertices.
typedef struct Use {
  uint32_t low, high, face;
  bool forward;                   // the face runs along it from low to high
  size_t low_corner, high_corner; // of the face
} Use;

typedef struct Work {
  const CagVec3 *vertices;
  const uint32_t *indices, *counts;
  size_t n, faces, corners;
  Use *uses;                   // one for each corner
  size_t *of_face, *of_corner; // union-find forests: each element's parent; roots are their own
  size_t *around;              // per vertex, for marks and counts
} Work;

static size_t root_of(size_t *parent, size_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

static void join(size_t *parent, size_t a, size_t b) {
  a = root_of(parent, a);
  b = root_of(parent, b);
  if (a < b) parent[b] = a;
  else parent[a] = b;
}

static int by_edge(const void *a, const void *b) {
  const Use *p = a, *q = b;
  if (p->low != q->low) return p->low < q->low ? -1 : 1;
  return p->high < q->high ? -1 : p->high > q->high;
}

// --- Reading ---

static CagStatus check_face(const Work *w, size_t f, const uint32_t *face, CagError *err) {
  if (w->counts[f] < 3)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_face_degenerate, "faces", (long)f,
                    "a face needs 3 or more vertices: faces[%zu] has %lu", f,
                    (unsigned long)w->counts[f]);
  for (size_t k = 0; k < w->counts[f]; k++) {
    if (face[k] >= w->n)
      return cag_fail(
          err, CAG_E_ARGUMENT, CAG_ERR_face_index, "faces", (long)f,
          "vertex indices in `faces` must be less than the number of vertices, %zu: faces[%zu][%zu] = %lu",
          w->n, f, k, (unsigned long)face[k]);
    if (w->around[face[k]] == f + 1)
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_face_degenerate, "faces", (long)f,
                      "a face must not contain a vertex twice: faces[%zu] repeats %lu at [%zu]", f,
                      (unsigned long)face[k], k);
    w->around[face[k]] = f + 1;
  }
  return CAG_OK;
}

static CagStatus read_faces(Work *w, CagError *err) {
  for (size_t i = 0; i < w->n; i++) {
    CagVec3 p = w->vertices[i];
    if (!isfinite(p.x) || !isfinite(p.y) || !isfinite(p.z))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_vertex_not_finite, "vertices", (long)i,
                      "`vertices` must be finite: vertices[%zu] = [%g, %g, %g]", i, p.x, p.y, p.z);
  }
  size_t first = 0;
  for (size_t f = 0; f < w->faces; first += w->counts[f++]) {
    CagStatus status = check_face(w, f, w->indices + first, err);
    if (status) return status;
    w->of_face[f] = f;
    for (size_t k = 0; k < w->counts[f]; k++) {
      size_t here = first + k, next = first + (k + 1) % w->counts[f];
      uint32_t a = w->indices[here], b = w->indices[next];
      w->of_corner[here] = here;
      w->uses[here] = a < b ? (Use){a, b, (uint32_t)f, true, here, next}
                            : (Use){b, a, (uint32_t)f, false, next, here};
    }
  }
  return cag_sort(w->uses, w->corners, sizeof *w->uses, by_edge, err);
}

// --- Counting ---

// Counts the edge whose uses are u[0 .. n).
static void count_edge(Work *w, const Use *u, size_t n, CagMeshCheck *out) {
  size_t forward = 0;
  for (size_t i = 0; i < n; i++) {
    forward += u[i].forward;
    join(w->of_face, u[0].face, u[i].face);
    join(w->of_corner, u[0].low_corner, u[i].low_corner);
    join(w->of_corner, u[0].high_corner, u[i].high_corner);
  }
  out->edges++;
  out->boundary_edges += n == 1;
  out->nonmanifold_edges += n > 2;
  if (forward > 1 || n - forward > 1) out->oriented = false;
}

// Returns the number of fans in excess of the number of vertices.
static size_t count_vertices(Work *w, CagMeshCheck *out) {
  size_t fans = 0;
  for (size_t i = 0; i < w->n; i++) w->around[i] = 0;
  for (size_t c = 0; c < w->corners; c++)
    if (w->of_corner[c] == c) {
      size_t *here = &w->around[w->indices[c]];
      fans++;
      out->vertices += *here == 0;
      out->nonmanifold_vertices += *here == 1;
      ++*here;
    }
  return fans - out->vertices;
}

// Any point can be the apex of the tetrahedra of a closed surface; one of its own vertices keeps
// the terms small.
static double volume_of(const Work *w) {
  double six = 0;
  size_t first = 0;
  CagVec3 tip = w->vertices[w->indices[0]];
  for (size_t f = 0; f < w->faces; first += w->counts[f++]) {
    const uint32_t *face = w->indices + first;
    CagVec3 a = cag_sub(w->vertices[face[0]], tip);
    for (size_t k = 1; k + 1 < w->counts[f]; k++)
      six += cag_dot(
          a, cag_cross(cag_sub(w->vertices[face[k]], tip), cag_sub(w->vertices[face[k + 1]], tip)));
  }
  return six / 6;
}

static void count(Work *w, CagMeshCheck *out) {
  *out = (CagMeshCheck){.faces = w->faces, .oriented = true};
  for (size_t i = 0, n; i < w->corners; i += n) {
    for (n = 1; i + n < w->corners && by_edge(&w->uses[i], &w->uses[i + n]) == 0;) n++;
    count_edge(w, w->uses + i, n, out);
  }
  for (size_t f = 0; f < w->faces; f++) out->shells += w->of_face[f] == f;
  size_t touching = count_vertices(w, out);
  out->euler = (long)out->vertices - (long)out->edges + (long)out->faces;
  out->closed = w->faces > 0 && out->boundary_edges == 0 && out->nonmanifold_edges == 0;
  if (!out->closed || !out->oriented) return;
  out->genus = (long)out->shells - (out->euler + (long)touching) / 2;
  out->volume = volume_of(w);
  out->solid = out->nonmanifold_vertices == 0 && out->volume > 0;
}

CagStatus cag_faces_check(const CagVec3 *vertices, size_t n, const uint32_t *indices,
                          const uint32_t *counts, size_t faces, CagMeshCheck *out, CagError *err) {
  Work w = {vertices, indices, counts, n, faces, 0, NULL, NULL, NULL, NULL};
  for (size_t f = 0; f < faces; f++) w.corners += counts[f];
  w.uses = cag_malloc((w.corners + 1) * sizeof *w.uses);
  w.of_face = cag_malloc((faces + 1) * sizeof *w.of_face);
  w.of_corner = cag_malloc((w.corners + 1) * sizeof *w.of_corner);
  w.around = cag_calloc(n + 1, sizeof *w.around);
  CagStatus status =
      w.uses && w.of_face && w.of_corner && w.around ? read_faces(&w, err) : cag_fail_memory(err);
  if (!status) count(&w, out);
  cag_free(w.uses);
  cag_free(w.of_face);
  cag_free(w.of_corner);
  cag_free(w.around);
  return status;
}

CagStatus cag_mesh_check(const CagMesh *m, CagMeshCheck *out, CagError *err) {
  uint32_t *indices = cag_malloc((3 * m->triangle_count + 1) * sizeof *indices);
  uint32_t *counts = cag_malloc((m->triangle_count + 1) * sizeof *counts);
  CagStatus status = indices && counts ? CAG_OK : cag_fail_memory(err);
  size_t n = 0;
  for (size_t t = 0; !status && t < m->triangle_count; t++) {
    uint32_t *k = indices + 3 * n;
    for (int i = 0; i < 3; i++) {
      k[i] = m->triangles[3 * t + (size_t)i];
      if (m->weld) k[i] = m->weld[k[i]];
    }
    counts[n] = 3;
    n += k[0] != k[1] && k[1] != k[2] && k[2] != k[0];
  }
  if (!status)
    status = cag_faces_check(m->positions, m->vertex_count, indices, counts, n, out, err);
  cag_free(indices);
  cag_free(counts);
  return status;
}
