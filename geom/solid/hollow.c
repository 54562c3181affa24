// Shells by offsets of meshes.
//
// The cavity is the solid offset to its inside. With open faces, the walls are the points of the
// solid that are near the other faces: the offset of a thin layer beneath these.

#include "geom/solid/hollow.h"

#include <math.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/boolean/boolean.h"
#include "geom/mesh/edges.h"
#include "geom/solid/convolve.h"
#include "geom/solid/csg.h"
#include "geom/solid/face_mesh.h"
#include "geom/solid/tessellate.h"

// The thickness of the layer beneath the faces, as a fraction of the tolerance.
#define LAYER 0.1
// Steps of corners that are longer than this multiple of the thickness are not taken.
#define STEP_MOST 4
// The cavity has at least this part of the volume.
#define NO_CAVITY 1e-9

static bool is_open(const CagSolidFace *open, size_t n, CagSolidFace face) {
  for (size_t i = 0; i < n; i++)
    if (open[i].part == face.part && open[i].face == face.face) return true;
  return false;
}

// --- The layer beneath the faces ---

// How the corners move by which the faces of all marked triangles move by 1.
static CagStatus corner_steps(const CagMesh *m, const bool *marked, CagVec3 **out, CagError *err) {
  CagFaceSteps *faces = cag_calloc(m->vertex_count + 1, sizeof *faces);
  CagVec3 *steps = cag_calloc(m->vertex_count + 1, sizeof *steps);
  if (!faces || !steps) {
    cag_free(faces);
    cag_free(steps);
    return cag_fail_memory(err);
  }
  for (size_t t = 0; t < m->triangle_count; t++) {
    CagCornerView c[3];
    if (!marked[t]) continue;
    cag_triangle_corners(m, t, c);
    for (size_t k = 0; k < 3; k++)
      cag_face_steps_add(&faces[cag_mesh_corner(m, 3 * t + k)], c[k].angle, c[k].normal, 1);
  }
  for (size_t i = 0; i < m->vertex_count; i++)
    if (cag_face_steps_solve(&faces[i], &steps[i]) && cag_norm(steps[i]) > STEP_MOST)
      steps[i] = cag_unit(faces[i].sum);
  cag_free(faces);
  *out = steps;
  return CAG_OK;
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
  for (size_t i = 0; i < 3 * m->triangle_count; i++) corners[i] = cag_mesh_corner(m, i);
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

// The triangles of the layer: the marked ones, those beneath, and two for each edge of the rim.
static void fill_layer(const CagMesh *m, const bool *marked, const CagMeshEdge *rim, size_t rims,
                       CagMesh *layer) {
  const uint32_t below = (uint32_t)m->vertex_count;
  size_t at = 0;
  for (size_t t = 0; t < m->triangle_count; t++) {
    uint32_t v[3];
    if (!marked[t]) continue;
    for (size_t k = 0; k < 3; k++) v[k] = cag_mesh_corner(m, 3 * t + k);
    put_corners(layer, &at, v[0], v[1], v[2]);
    put_corners(layer, &at, below + v[0], below + v[2], below + v[1]);
  }
  for (size_t i = 0; i < rims; i++) {
    const bool ahead = cag_mesh_edge_forward(&rim[i]);
    const uint32_t a = ahead ? rim[i].low : rim[i].high, b = ahead ? rim[i].high : rim[i].low;
    put_corners(layer, &at, b, a, below + a);
    put_corners(layer, &at, b, below + a, below + b);
  }
}

// The closed mesh between the marked triangles and copies of them that are `depth` beneath.
static CagStatus layer_beneath(const CagMesh *m, const bool *marked, double depth, CagMesh **out,
                               CagError *err) {
  const size_t n = m->vertex_count;
  CagVec3 *steps = NULL;
  CagMeshEdge *rim = NULL;
  CagMesh *layer = NULL;
  size_t rims = 0, faces = 0;
  for (size_t t = 0; t < m->triangle_count; t++) faces += marked[t];
  CagStatus status = rim_edges(m, marked, &rim, &rims, err);
  if (!status) status = corner_steps(m, marked, &steps, err);
  if (!status) status = cag_mesh_new(2 * n, 2 * (faces + rims), false, false, false, &layer, err);
  for (size_t i = 0; !status && i < n; i++) {
    layer->positions[i] = m->positions[i];
    layer->positions[n + i] = cag_madd(m->positions[i], -depth, steps[i]);
  }
  if (!status) {
    fill_layer(m, marked, rim, rims, layer);
    *out = layer;
  }
  cag_free(steps);
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

// walled: the triangles that have a wall.
static CagStatus open_shell(const CagMesh *m, const bool *walled, double thickness,
                            double tolerance, CagMesh **out, CagError *err) {
  CagMesh *layer = NULL, *thick = NULL, *shell = NULL;
  const double depth = LAYER * tolerance, volume = mesh_volume(m);
  CagStatus status = layer_beneath(m, walled, depth, &layer, err);
  if (!status) status = cag_mesh_offset(layer, thickness - depth, tolerance, NULL, &thick, err);
  if (!status) status = cag_mesh_boolean(CAG_INTERSECTION, m, thick, NULL, &shell, err);
  if (!status && !(mesh_volume(shell) < (1 - NO_CAVITY) * volume))
    status = fail_thickness(thickness, err);
  cag_mesh_release(layer);
  cag_mesh_release(thick);
  if (status) cag_mesh_release(shell);
  else *out = shell;
  return status;
}

static CagStatus hollow_open(const CagSolid *s, double thickness, const CagSolidFace *open,
                             size_t n, double tolerance, CagMesh **out, CagError *err) {
  CagFaceMesh m;
  CagStatus status = cag_solid_face_mesh(s, tolerance, &m, err);
  if (status) return status;
  bool *walled = cag_malloc(m.mesh->triangle_count + 1);
  if (!walled) status = cag_fail_memory(err);
  for (size_t t = 0; !status && t < m.mesh->triangle_count; t++)
    walled[t] = !is_open(open, n, m.face[t]);
  if (!status) status = open_shell(m.mesh, walled, thickness, tolerance, out, err);
  cag_free(walled);
  cag_face_mesh_free(&m);
  return status;
}

static CagStatus hollow_closed(const CagSolid *s, double thickness, bool outside, double tolerance,
                               CagMesh **out, CagError *err) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *m = NULL;
  how.tolerance = tolerance;
  CagStatus status = cag_solid_tessellate(s, &how, &m, err);
  if (!status) status = closed_shell(m, thickness, outside, tolerance, out, err);
  cag_mesh_release(m);
  return status;
}

CagStatus cag_solid_hollow(const CagSolid *s, double thickness, bool outside,
                           const CagSolidFace *open, size_t n, double tolerance, CagSolid **out,
                           CagError *err) {
  CagMesh *shell = NULL;
  if (n > 0 && outside)
    return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_no_boundary, "open", -1,
                    "walls outside of a solid cannot have open faces without the kernel");
  CagStatus status = n > 0 ? hollow_open(s, thickness, open, n, tolerance, &shell, err)
                           : hollow_closed(s, thickness, outside, tolerance, &shell, err);
  if (!status) status = cag_solid_from_mesh(shell, out, err);
  cag_mesh_release(shell);
  return status;
}
