#include "interp/render/preview_curvature.h"

#include "base/memory.h"

// The exact surface of a solid is searched for at this distance from its mesh, as a fraction of the
// size of the part: meshes are within 1/1000 of it, but rays may meet them at a small angle.
#define BESIDE 0.01

CagStatus cag_preview_curvature_new(const CagPreviewWorld *w, CagPreviewCurvature *out,
                                    CagError *err) {
  *out = (CagPreviewCurvature){.world = w};
  out->exact = cag_calloc(w->count + 1, sizeof *out->exact);
  if (!out->exact) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < w->count; i++) {
    const CagItem *item = &w->scene->items[w->parts[i].item];
    if (!w->parts[i].mesh || item->kind != CAG_ITEM_SOLID || item->as.solid->kind == CAG_SOLID_MESH)
      continue;
    status = cag_caster_of_solid(item->as.solid, &out->exact[i], err);
  }
  if (status) cag_preview_curvature_free(out);
  return status;
}

void cag_preview_curvature_free(CagPreviewCurvature *c) {
  for (size_t i = 0; c->exact && i < c->world->count; i++) cag_caster_free(c->exact[i]);
  cag_free(c->exact);
  *c = (CagPreviewCurvature){0};
}

// The curvature within a triangle, from the normals of its corners: the linear map from steps in its
// plane to changes of the normal (Rusinkiewicz 2004).
static bool triangle_bend(const CagMesh *m, uint32_t face, CagBend *out) {
  const uint32_t *t = m->triangles + 3 * (size_t)face;
  if (!m->normals) return false;
  const CagVec3 e = cag_sub(m->positions[t[1]], m->positions[t[0]]);
  const CagVec3 f = cag_sub(m->positions[t[2]], m->positions[t[0]]);
  const CagVec3 ne = cag_sub(m->normals[t[1]], m->normals[t[0]]);
  const CagVec3 nf = cag_sub(m->normals[t[2]], m->normals[t[0]]);
  const CagVec3 u = cag_unit(e), w = cag_unit(cag_cross(e, f)), v = cag_cross(w, u);
  const double eu = cag_dot(e, u), fu = cag_dot(f, u), fv = cag_dot(f, v);
  if (eu == 0 || fv == 0) return false;
  // Columns of the map: along u, and along v.
  const double uu = cag_dot(ne, u) / eu, uv = cag_dot(ne, v) / eu;
  const double vu = (cag_dot(nf, u) - uu * fu) / fv, vv = (cag_dot(nf, v) - uv * fu) / fv;
  *out = (CagBend){(uu + vv) / 2, uu * vv - uv * vu};
  return true;
}

static CagBend rod_bend(double radius, uint32_t face) {
  if (face == CAG_ROD_SIDE) return (CagBend){1 / (2 * radius), 0};
  if (face == CAG_ROD_BALL) return (CagBend){1 / radius, 1 / (radius * radius)};
  return (CagBend){0, 0};
}

static CagStatus caster_bend(const CagPreviewHit *hit, CagBend *out, bool *known, CagError *err) {
  const CagCrossing c = {.normal = hit->flat,
                         .u = hit->u,
                         .v = hit->v,
                         .face = hit->face,
                         .part = hit->operand,
                         .flipped = hit->flipped};
  return cag_crossing_bend(&c, hit->point, out, known, err);
}

// Finds the surface beside the mesh.
static CagStatus solid_bend(const CagCaster *exact, const CagRay *ray, const CagPreviewHit *hit,
                            CagCrossings *work, CagBend *out, bool *known, CagError *err) {
  const CagBounds *b = &hit->part->bounds;
  const double reach = BESIDE * cag_norm(cag_sub(b->max, b->min));
  CagRay beside = *ray;
  CagCrossing c;
  bool met;
  beside.least = fmax(ray->least, hit->t - reach);
  beside.most = hit->t + reach;
  *known = false;
  CagStatus status = cag_caster_first(exact, &beside, work, &c, &met, err);
  if (status || !met || cag_dot(c.normal, hit->flat) <= 0) return status;
  return cag_crossing_bend(&c, cag_ray_point(ray, c.t), out, known, err);
}

CagStatus cag_preview_curvature_at(const CagPreviewCurvature *c, const CagRay *ray,
                                   const CagPreviewHit *hit, CagCrossings *work, CagBend *out,
                                   CagError *err) {
  const CagPreviewPart *part = hit->part;
  CagStatus status = CAG_OK;
  bool known = true;
  *out = (CagBend){0, 0};
  if (!part) return CAG_OK; // a plane
  const CagItem *item = &c->world->scene->items[part->item];
  const CagCaster *exact = c->exact[part - c->world->parts];
  if (part->rods) *out = rod_bend(part->rods->radius, hit->face);
  else if (part->caster) status = caster_bend(hit, out, &known, err);
  else if (item->kind == CAG_ITEM_SURFACE)
    status = cag_surface_bend(item->as.surface, hit->u, hit->v, hit->flat, out, &known, err);
  else {
    known = false;
    if (exact) status = solid_bend(exact, ray, hit, work, out, &known, err);
  }
  if (status || known) return status;
  if (!hit->mesh || !triangle_bend(hit->mesh, hit->face, out)) *out = (CagBend){NAN, NAN};
  return CAG_OK;
}
