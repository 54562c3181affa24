// Tessellation of surfaces and faces: runs the steps of tessellation.h in order.
//
// Everything runs on the caller's thread and in a fixed order: a surface may call the script, which
// is single-threaded, and a million triangles take less than a tenth of a second, mostly for memory
// allocation.

#include "geom/tessellate/tessellate.h"

#include <float.h>

#include "base/memory.h"
#include "geom/surface/trimmed.h"
#include "geom/tessellate/tessellation.h"
#include "geom/tessellate/trimmed.h"

CagStatus cag_tess_interrupted(const Tessellator *t, CagError *err) {
  if (!t->how.interrupt || !*t->how.interrupt) return CAG_OK;
  return cag_fail(err, CAG_E_CALLBACK, CAG_ERR_interrupted, "", -1,
                  "the tessellation was interrupted");
}

CagStatus cag_tess_limit(const Tessellator *t, double triangles, CagError *err) {
  char tolerance[32];
  return cag_fail(
      err, CAG_E_LIMIT, CAG_ERR_limit_triangles, "tolerance", -1,
      "a tolerance of %s mm needs more than %.0f triangles, and the limit is %zu; use a larger tolerance",
      cag_number_text(t->how.tolerance, tolerance), floor(triangles), t->how.max_triangles);
}

static void release(Tessellator *t) {
  for (size_t k = 0; k < t->face_count; k++) {
    cag_free(t->faces[k].breaks[0]);
    cag_free(t->faces[k].breaks[1]);
    cag_free(t->faces[k].triangles);
  }
  for (size_t k = 0; k < t->line_count; k++) cag_free(t->lines[k].own_parameters);
  cag_free(t->faces);
  cag_free(t->leaves);
  cag_free(t->lines);
  cag_free(t->atoms);
  cag_free(t->nodes);
  cag_free(t->corners);
  cag_free(t->corner_hash);
  cag_free(t->positions);
  cag_free(t->normals);
  cag_free(t->uv);
  cag_free(t->weld);
  cag_free(t->own);
}

static CagStatus begin(Tessellator *t, const CagTessellation *how, const CagBounds *bounds,
                       CagSurface *const *faces, size_t n, CagError *err) {
  const double default_share = 1e-3; // of the diagonal
  // Relative to the largest coordinate: a smaller surface is a point, and its normals are rounding.
  const double rounding = 64 * DBL_EPSILON;
  *t = (Tessellator){.how = how ? *how : CAG_TESSELLATION_DEFAULT};
  t->size = cag_norm(cag_sub(bounds->max, bounds->min));
  if (!isfinite(t->size))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_surface_unbounded, "", -1,
                    "only bounded surfaces can be tessellated, found an unbounded one");
  t->noise = rounding * fmax(cag_norm(bounds->min), cag_norm(bounds->max));
  if (!(t->how.tolerance > 0)) t->how.tolerance = t->size > 0 ? t->size * default_share : 1;
  t->is_point = t->size <= t->noise;
  if (t->is_point) {
    t->how.tolerance = fmax(t->how.tolerance, t->noise);
    t->how.angle = t->how.max_edge = 0;
  }
  t->faces = cag_calloc(n + 1, sizeof *t->faces);
  if (!t->faces) return cag_fail_memory(err);
  t->face_count = n;
  for (size_t k = 0; k < n; k++) {
    t->faces[k].surface = faces[k];
    t->faces[k].planar = cag_surface_planar_view(faces[k], NULL, NULL);
  }
  return CAG_OK;
}

// Sides shared by two faces get the same division.
static CagStatus join_edges(Tessellator *t, const CagFaces *faces, CagError *err) {
  for (size_t e = 0; e < faces->edge_count; e++) {
    const CagFaceEdge *edge = &faces->edges[e];
    uint32_t a = cag_tess_side_line(t, (uint32_t)edge->face[0], edge->side[0]),
             b = cag_tess_side_line(t, (uint32_t)edge->face[1], edge->side[1]);
    if (a == NO_INDEX || b == NO_INDEX || a == b) continue;
    if (t->lines[a].joined != NO_INDEX || t->lines[b].joined != NO_INDEX) continue;
    CagStatus status = cag_tess_join_lines(t, a, b, edge->reversed, err);
    if (status) return status;
  }
  return CAG_OK;
}

static CagStatus run(Tessellator *t, const CagFaces *faces, CagMesh **out, CagError *err) {
  CagStatus status = CAG_OK;
  for (uint32_t k = 0; !status && k < t->face_count; k++)
    if (!t->faces[k].planar) {
      status = cag_tess_plan_face(t, k, err);
      if (!status) status = cag_tess_plan_strips(t, k, err);
    }
  for (uint32_t k = 0; !status && k < t->face_count; k++)
    if (!t->faces[k].planar) status = cag_tess_make_even_lines(t, k, err);
  if (!status && faces) status = join_edges(t, faces, err);
  if (!status) status = cag_tess_make_nodes(t, err);
  for (uint32_t k = 0; !status && k < t->face_count; k++)
    if (t->faces[k].planar) status = cag_tess_planar_face(t, k, faces, err);
  if (!status && faces) status = cag_tess_unite_corners(t, err);
  return !status ? cag_tess_fill(t, out, err) : status;
}

CagStatus cag_surface_tessellate(const CagSurface *s, const CagTessellation *how, CagMesh **out,
                                 CagError *err) {
  CagBounds bounds;
  CagSurface *face = (CagSurface *)s;
  CagStatus status = cag_surface_bounds(s, &bounds, err);
  if (status) return status;
  Tessellator t;
  status = begin(&t, how, &bounds, &face, 1, err);
  if (!status)
    status = cag_surface_trimmed_view(s, NULL, NULL) ? cag_trimmed_tessellate(s, &t.how, out, err)
                                                     : run(&t, NULL, out, err);
  release(&t);
  return status;
}

CagStatus cag_faces_tessellate(const CagFaces *faces, const CagBounds *bounds,
                               const CagTessellation *how, CagMesh **out, CagError *err) {
  Tessellator t;
  CagStatus status = begin(&t, how, bounds, faces->items, faces->count, err);
  if (!status) status = run(&t, faces, out, err);
  release(&t);
  return status;
}
