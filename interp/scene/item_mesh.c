// Meshes of items: surfaces and solids are tessellated, regions are flat, curves are tubes.

#include "interp/scene/item_mesh.h"
#include "geom/solid/tessellate.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "geom/tessellate/orient.h"

// The radius of curves without their own, as a fraction of the diagonal of the scene's bounds.
#define LINE_PART 0.0025

static double diagonal(const CagBounds *b) {
  double d = b->min.x <= b->max.x ? cag_norm(cag_sub(b->max, b->min)) : 0;
  return d > 0 ? d : 100;
}

double cag_item_line_radius(const CagScene *s, const CagItem *item) {
  return item->line_radius > 0 ? item->line_radius : LINE_PART * diagonal(&s->bounds);
}

static CagStatus region_mesh(const CagItem *item, const CagTessellation *how, CagMesh **out,
                             CagError *err) {
  CagSurface *flat = NULL;
  CagStatus status = cag_surface_planar(item->as.region, &item->placement, &flat, err);
  if (!status) status = cag_surface_tessellate(flat, how, out, err);
  cag_surface_release(flat);
  return status;
}

// A closed surface gets outward normals, regardless of its parameters.
static CagStatus surface_mesh(const CagSurface *s, const CagTessellation *how, CagMesh **out,
                              CagError *err) {
  CagMesh *m = NULL;
  CagStatus status = cag_surface_tessellate(s, how, &m, err);
  if (status || !cag_surface_is_closed(s)) {
    if (!status) *out = m;
    return status;
  }
  status = cag_mesh_outward(m, out, err);
  cag_mesh_release(m);
  return status;
}

static CagStatus make_mesh(const CagScene *s, const CagItem *item, CagMesh **out, CagError *err) {
  CagTessellation how = cag_item_fineness(s, item);
  switch (item->kind) {
  case CAG_ITEM_CURVE: {
    double radius = cag_item_line_radius(s, item);
    return cag_curve_tube_mesh(item->as.curve, radius, item->dash, &how, out, err);
  }
  case CAG_ITEM_REGION: return region_mesh(item, &how, out, err);
  case CAG_ITEM_SURFACE: return surface_mesh(item->as.surface, &how, out, err);
  case CAG_ITEM_SOLID: return cag_solid_tessellate(item->as.solid, &how, out, err);
  case CAG_ITEM_MESH: return cag_mesh_outward(item->as.mesh, out, err);
  case CAG_ITEM_GROUND: break; // only for pictures, which draw a plane
  }
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_value, "", -1, "a ground is not a mesh");
}

CagStatus cag_item_mesh(const CagScene *s, const CagItem *item, CagMesh **out, CagError *err) {
  CagMesh *m;
  CagStatus status = make_mesh(s, item, &m, err);
  if (status) return status;
  for (size_t i = 0; i < m->vertex_count; i++) {
    const CagVec3 p = m->positions[i];
    if (isfinite(p.x) && isfinite(p.y) && isfinite(p.z)) continue;
    cag_mesh_release(m);
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_not_finite, "", -1,
                    "%s has points whose coordinates overflow or are undefined",
                    item->name ? item->name : "a shape");
  }
  *out = m;
  return CAG_OK;
}

static int by_number(const void *a, const void *b) {
  const size_t x = *(const size_t *)a, y = *(const size_t *)b;
  return x < y ? -1 : x > y;
}

CagStatus cag_item_materials(const CagItem *item, size_t **out, size_t *count, CagError *err) {
  size_t *all = *out = cag_malloc((item->label_count + 1) * sizeof *all), n = 0;
  *count = 0;
  if (!all) return cag_fail_memory(err);
  all[n++] = item->material;
  for (size_t i = 0; i < item->label_count; i++) all[n++] = item->labels[i].material;
  qsort(all, n, sizeof *all, by_number);
  for (size_t i = 0; i < n; i++)
    if (*count == 0 || all[*count - 1] != all[i]) all[(*count)++] = all[i];
  return CAG_OK;
}

CagStatus cag_item_mesh_of(const CagItem *item, const CagMesh *m, size_t material, CagMesh **out,
                           CagError *err) {
  CagMesh *part = NULL;
  uint32_t *number = cag_malloc((m->vertex_count + 1) * sizeof *number);
  if (!number) return cag_fail_memory(err);
  memset(number, 0xff, m->vertex_count * sizeof *number);
  CagStatus status = cag_mesh_new(m->vertex_count, m->triangle_count, m->normals != NULL,
                                  m->uv != NULL, m->weld != NULL, &part, err);
  if (status) {
    cag_free(number);
    return status;
  }
  part->scale = m->scale;
  part->vertex_count = part->triangle_count = 0;
  for (size_t t = 0; t < m->triangle_count; t++) {
    if (cag_item_label_material(item, m->labels ? m->labels[t] : 0) != material) continue;
    for (int k = 0; k < 3; k++) {
      const uint32_t from = m->triangles[3 * t + (size_t)k];
      if (number[from] == UINT32_MAX) number[from] = (uint32_t)part->vertex_count++;
      const uint32_t to = number[from];
      part->triangles[3 * part->triangle_count + (size_t)k] = to;
      part->positions[to] = m->positions[from];
      if (m->normals) part->normals[to] = m->normals[from];
      if (m->uv) memcpy(part->uv + 2 * to, m->uv + 2 * from, 2 * sizeof *m->uv);
      if (m->weld) part->weld[to] = m->weld[from];
    }
    part->triangle_count++;
  }
  // `weld` refers to the first vertex at a point, which may be a different one in the part.
  if (m->weld) memset(number, 0xff, m->vertex_count * sizeof *number);
  for (uint32_t v = 0; m->weld && v < part->vertex_count; v++) {
    uint32_t *first = &number[part->weld[v]];
    if (*first == UINT32_MAX) *first = v;
    part->weld[v] = *first;
  }
  cag_free(number);
  *out = part;
  return CAG_OK;
}
