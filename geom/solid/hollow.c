// Shells by offsets of meshes.
//
// The cavity is the solid offset to its inside. With open faces, the walls are the points of the
// solid that are near the other faces: the offset of a thin layer beneath these.

#include "geom/solid/hollow.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/boolean/boolean.h"
#include "geom/boundary/mesh.h"
#include "geom/mesh/edges.h"
#include "geom/solid/convolve.h"
#include "geom/solid/csg.h"
#include "geom/solid/exact.h"
#include "geom/solid/tessellate.h"

// The thickness of the layer beneath the faces, as a fraction of the tolerance.
#define LAYER 0.1
// Directions of faces at a corner that are closer than the root of this are one; steps that are
// longer than this multiple of the thickness are not taken.
#define RANK 1e-6
#define STEP_MOST 4
// The cavity has at least this part of the volume.
#define NO_CAVITY 1e-9

static uint32_t corner_of(const CagMesh *m, size_t i) {
  return m->weld ? m->weld[m->triangles[i]] : m->triangles[i];
}

// --- Meshes with marked triangles ---

typedef struct Walls {
  CagMesh *mesh; // of the solid
  bool *walled;  // its triangles that have a wall
} Walls;

static void walls_free(Walls *w) {
  cag_mesh_release(w->mesh);
  cag_free(w->walled);
}

static bool is_open(const CagSolidFace *open, size_t n, size_t part, size_t face) {
  for (size_t i = 0; i < n; i++)
    if (open[i].part == part && open[i].face == face) return true;
  return false;
}

// The mesh of a part; walled: its triangles, for as many as the part has.
static CagStatus part_mesh(const CagBoundary *b, size_t part, const CagSolidFace *open, size_t n,
                           const CagTessellation *how, CagMesh **out, bool **walled,
                           CagError *err) {
  size_t *first = cag_calloc(b->face_count + 1, sizeof *first);
  CagMesh *m = NULL;
  CagStatus status = first ? cag_boundary_mesh(b, how, first, &m, err) : cag_fail_memory(err);
  if (!status) *walled = cag_calloc(m->triangle_count + 1, sizeof **walled);
  if (!status && !*walled) status = cag_fail_memory(err);
  for (size_t f = 0; !status && f < b->face_count; f++)
    if (!is_open(open, n, part, f)) memset(*walled + first[f], true, first[f + 1] - first[f]);
  cag_free(first);
  if (status) cag_mesh_release(m);
  else *out = m;
  return status;
}

static CagStatus append_part(Walls *w, CagMesh *m, const bool *walled, CagError *err) {
  const size_t before = w->mesh ? w->mesh->triangle_count : 0;
  CagMesh *both[2] = {w->mesh, m}, *all = NULL;
  bool *longer = cag_realloc(w->walled, before + m->triangle_count + 1);
  if (!longer) return cag_fail_memory(err);
  w->walled = longer;
  memcpy(longer + before, walled, m->triangle_count);
  const CagStatus status =
      w->mesh ? cag_mesh_append(both, 2, &all, err) : cag_mesh_append(both + 1, 1, &all, err);
  if (status) return status;
  cag_mesh_release(w->mesh);
  w->mesh = all;
  return CAG_OK;
}

// The mesh of an exact solid in world coordinates.
static CagStatus mark_walls(const CagSolid *s, const CagSolidFace *open, size_t n, double tolerance,
                            Walls *out, CagError *err) {
  size_t parts;
  const CagBoundary *b = cag_solid_boundaries(s, &parts);
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  how.tolerance = tolerance / cag_transform_stretch(&s->placement);
  *out = (Walls){NULL, NULL};
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < parts; i++) {
    CagMesh *m = NULL;
    bool *walled = NULL;
    status = part_mesh(&b[i], i, open, n, &how, &m, &walled, err);
    if (!status) status = append_part(out, m, walled, err);
    cag_mesh_release(m);
    cag_free(walled);
  }
  CagMesh *placed = NULL;
  if (!status) status = cag_mesh_transform(out->mesh, &s->placement, &placed, err);
  if (status) {
    walls_free(out);
    return status;
  }
  cag_mesh_release(out->mesh);
  out->mesh = placed;
  return CAG_OK;
}

// --- The layer beneath the faces ---

// The faces at a corner: the sums of n n^T and n over their normals n, weighted by their angles.
typedef struct Around {
  CagTransform products;
  CagVec3 sum;
} Around;

static void add_normal(Around *a, double angle, CagVec3 n) {
  const double x[3] = {n.x, n.y, n.z};
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) a->products.m[i][k] += angle * x[i] * x[k];
  a->sum = cag_madd(a->sum, angle, n);
}

static void add_normals(const CagMesh *m, const bool *marked, Around *around) {
  for (size_t t = 0; t < m->triangle_count; t++) {
    CagVec3 p[3];
    if (!marked[t]) continue;
    for (int k = 0; k < 3; k++) p[k] = m->positions[corner_of(m, 3 * t + (size_t)k)];
    const CagVec3 n = cag_unit(cag_cross(cag_sub(p[1], p[0]), cag_sub(p[2], p[0])));
    for (int k = 0; k < 3; k++) {
      const CagVec3 a = cag_sub(p[(k + 1) % 3], p[k]), b = cag_sub(p[(k + 2) % 3], p[k]);
      add_normal(&around[corner_of(m, 3 * t + (size_t)k)],
                 atan2(cag_norm(cag_cross(a, b)), cag_dot(a, b)), n);
    }
  }
}

// The step by which all faces at a corner move by 1, in the least squares; the shortest one, if
// they have fewer than three directions.
static CagVec3 corner_step(const Around *a) {
  const double trace = a->products.m[0][0] + a->products.m[1][1] + a->products.m[2][2];
  CagTransform t = cag_transform_identity(), back;
  CagError err;
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) t.m[i][k] = a->products.m[i][k] + (i == k ? RANK * trace : 0);
  if (!(trace > 0) || cag_transform_inverse(&t, &back, &err)) return cag_unit(a->sum);
  const CagVec3 step = cag_transform_vector(&back, a->sum);
  return cag_norm(step) <= STEP_MOST ? step : cag_unit(a->sum);
}

static void put_corners(CagMesh *m, size_t *n, uint32_t a, uint32_t b, uint32_t c) {
  m->triangles[(*n)++] = a;
  m->triangles[(*n)++] = b;
  m->triangles[(*n)++] = c;
}

// The edges of marked triangles whose other triangle is not marked.
static CagStatus rim_edges(const CagMesh *m, const bool *marked, CagMeshEdge **out, size_t *n,
                           CagError *err) {
  uint32_t *corners = cag_malloc((3 * m->triangle_count + 1) * sizeof *corners);
  if (!corners) return cag_fail_memory(err);
  for (size_t i = 0; i < 3 * m->triangle_count; i++) corners[i] = corner_of(m, i);
  size_t all = 0;
  CagMeshEdge *e = cag_mesh_edges(corners, m->triangle_count, NULL, m->vertex_count, &all);
  cag_free(corners);
  if (!e) return cag_fail_memory(err);
  *n = 0;
  for (size_t i = 0, j; i < all; i = j) {
    size_t inside = 0, one = i;
    for (j = i; j < all && e[j].low == e[i].low && e[j].high == e[i].high; j++)
      if (marked[cag_mesh_edge_triangle(&e[j])]) inside++, one = j;
    if (inside == 1) e[(*n)++] = e[one];
  }
  *out = e;
  return CAG_OK;
}

// The closed mesh between the marked triangles and copies of them that are `depth` beneath.
static CagStatus layer_beneath(const CagMesh *m, const bool *marked, double depth, CagMesh **out,
                               CagError *err) {
  Around *around = cag_calloc(m->vertex_count + 1, sizeof *around);
  CagMeshEdge *rim = NULL;
  CagMesh *layer = NULL;
  size_t rims = 0, faces = 0, at = 0;
  const uint32_t below = (uint32_t)m->vertex_count;
  for (size_t t = 0; t < m->triangle_count; t++) faces += marked[t];
  CagStatus status = around ? rim_edges(m, marked, &rim, &rims, err) : cag_fail_memory(err);
  if (!status)
    status =
        cag_mesh_new(2 * m->vertex_count, 2 * (faces + rims), false, false, false, &layer, err);
  if (!status) {
    add_normals(m, marked, around);
    for (uint32_t i = 0; i < below; i++) {
      layer->positions[i] = m->positions[i];
      layer->positions[below + i] = cag_madd(m->positions[i], -depth, corner_step(&around[i]));
    }
    for (size_t t = 0; t < m->triangle_count; t++) {
      if (!marked[t]) continue;
      uint32_t v[3];
      for (int k = 0; k < 3; k++) v[k] = corner_of(m, 3 * t + (size_t)k);
      put_corners(layer, &at, v[0], v[1], v[2]);
      put_corners(layer, &at, below + v[0], below + v[2], below + v[1]);
    }
    for (size_t i = 0; i < rims; i++) {
      const bool ahead = cag_mesh_edge_forward(&rim[i]);
      const uint32_t a = ahead ? rim[i].low : rim[i].high, b = ahead ? rim[i].high : rim[i].low;
      put_corners(layer, &at, b, a, below + a);
      put_corners(layer, &at, b, below + a, below + b);
    }
    *out = layer;
  }
  cag_free(around);
  cag_free(rim);
  return status;
}

// --- Shells ---

static double mesh_volume(const CagMesh *m) {
  double terms[10] = {0};
  cag_mesh_volume_terms(m, terms);
  return terms[0];
}

static CagStatus fail_thickness(double thickness, CagError *err) {
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_no_boundary, "thickness", -1,
                  "walls of %g leave no cavity", thickness);
}

static CagStatus closed_shell(const CagMesh *m, double thickness, bool outside, double tolerance,
                              CagMesh **out, CagError *err) {
  CagMesh *moved = NULL;
  CagStatus status =
      cag_mesh_offset(m, outside ? thickness : -thickness, tolerance, NULL, &moved, err);
  if (status) return status;
  if (!(mesh_volume(moved) > NO_CAVITY * mesh_volume(m))) status = fail_thickness(thickness, err);
  if (!status)
    status = outside ? cag_mesh_boolean(CAG_DIFFERENCE, moved, m, NULL, out, err)
                     : cag_mesh_boolean(CAG_DIFFERENCE, m, moved, NULL, out, err);
  cag_mesh_release(moved);
  return status;
}

static CagStatus open_shell(const Walls *w, double thickness, double tolerance, CagMesh **out,
                            CagError *err) {
  CagMesh *layer = NULL, *thick = NULL, *shell = NULL;
  const double depth = LAYER * tolerance, volume = mesh_volume(w->mesh);
  CagStatus status = layer_beneath(w->mesh, w->walled, depth, &layer, err);
  if (!status) status = cag_mesh_offset(layer, thickness - depth, tolerance, NULL, &thick, err);
  if (!status) status = cag_mesh_boolean(CAG_INTERSECTION, w->mesh, thick, NULL, &shell, err);
  if (!status && !(mesh_volume(shell) < (1 - NO_CAVITY) * volume))
    status = fail_thickness(thickness, err);
  cag_mesh_release(layer);
  cag_mesh_release(thick);
  if (status) cag_mesh_release(shell);
  else *out = shell;
  return status;
}

CagStatus cag_solid_hollow(const CagSolid *s, double thickness, bool outside,
                           const CagSolidFace *open, size_t n, double tolerance, CagSolid **out,
                           CagError *err) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *mesh = NULL, *shell = NULL;
  Walls w = {NULL, NULL};
  CagStatus status = CAG_OK;
  how.tolerance = tolerance;
  if (n > 0 && (outside || s->kind != CAG_SOLID_EXACT))
    return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_no_boundary, "open", -1,
                    "walls outside of a solid cannot have open faces without the kernel");
  if (n > 0) {
    status = mark_walls(s, open, n, tolerance, &w, err);
    if (!status) status = open_shell(&w, thickness, tolerance, &shell, err);
    walls_free(&w);
  } else {
    status = cag_solid_tessellate(s, &how, &mesh, err);
    if (!status) status = closed_shell(mesh, thickness, outside, tolerance, &shell, err);
    cag_mesh_release(mesh);
  }
  if (!status) status = cag_solid_from_mesh(shell, out, err);
  cag_mesh_release(shell);
  return status;
}
