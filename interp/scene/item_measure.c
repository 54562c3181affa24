// Volumes of surfaces and meshes are integrated about the middle of their bounds, because they would
// lose digits about a distant origin.

#include "interp/scene/item_measure.h"

#include <math.h>

#include "geom/solid/csg.h"

static const CagVec3 UNDEFINED = {NAN, NAN, NAN};

static CagVec3 middle_of(const CagBounds *b) { return cag_lerp(b->min, b->max, 0.5); }

// From the integrals of 1, x, y, z about `about`. A shape with inward normals bounds the same body.
static void set_volume(const double terms[10], CagVec3 about, CagItemMeasures *out) {
  const double v = terms[0];
  out->volume = fabs(v);
  if (v != 0) out->centroid = cag_add(about, cag_vec3(terms[1] / v, terms[2] / v, terms[3] / v));
}

static CagStatus measure_curve(const CagCurve *c, CagItemMeasures *out, CagError *err) {
  out->closed = c->closed;
  out->exact = true;
  return cag_curve_length(c, c->start, c->end, &out->length, err);
}

static CagStatus measure_region(const CagItem *item, CagItemMeasures *out, CagError *err) {
  CagSurface *flat = NULL;
  CagStatus status = cag_surface_planar(item->as.region, &item->placement, &flat, err);
  if (!status) status = cag_surface_area(flat, &out->area, &out->centroid, err);
  cag_surface_release(flat);
  out->length = 0;
  for (size_t i = 0; !status && i < item->as.region->count; i++) {
    CagCurve *loop = NULL;
    double length = 0;
    status = cag_curve_transform(item->as.region->loops[i], &item->placement, &loop, err);
    if (!status) status = cag_curve_length(loop, loop->start, loop->end, &length, err);
    cag_curve_release(loop);
    out->length += length;
  }
  out->exact = out->has_faces = true;
  out->faces = 1;
  return status;
}

static CagStatus measure_surface(const CagSurface *s, CagItemMeasures *out, CagError *err) {
  CagSurface *near = NULL;
  double terms[10] = {0};
  const CagVec3 middle = middle_of(&out->bounds);
  const CagTransform shift = cag_translate(cag_scaled(middle, -1));
  out->exact = out->has_faces = true;
  out->faces = 1;
  CagStatus status = cag_surface_area(s, &out->area, &out->centroid, err);
  if (status || !cag_surface_is_closed(s)) return status;
  status = cag_surface_transform(s, &shift, &near, err);
  if (!status) status = cag_surface_volume_terms(near, terms, err);
  if (!status) set_volume(terms, middle, out);
  cag_surface_release(near);
  return status;
}

static CagStatus measure_solid(const CagScene *scene, const CagItem *item, CagItemMeasures *out,
                               CagError *err) {
  CagMassProperties mass;
  const CagSolid *s = item->as.solid;
  const double tolerance = item->tolerance > 0 ? item->tolerance : scene->tolerance;
  const CagStatus status = cag_solid_mass_within(s, tolerance, &mass, err);
  if (status) return status;
  out->area = mass.area;
  out->volume = mass.volume;
  if (mass.volume != 0) out->centroid = mass.volume_centroid;
  out->exact = !cag_solid_is_compound(s) || s->face_count > 0 || s->kind == CAG_SOLID_MESH;
  out->has_faces = s->face_count > 0 || s->kind == CAG_SOLID_MESH;
  out->faces = s->face_count > 0 ? s->face_count
               : out->has_faces  ? s->core->mesh->triangle_count
                                 : 0;
  return CAG_OK;
}

static CagVec3 area_centroid(const CagMesh *m, CagVec3 about) {
  CagVec3 sum = {0, 0, 0};
  double whole = 0;
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    const CagVec3 a = cag_sub(m->positions[k[0]], about), b = cag_sub(m->positions[k[1]], about),
                  c = cag_sub(m->positions[k[2]], about);
    const double area = cag_norm(cag_cross(cag_sub(b, a), cag_sub(c, a))) / 2;
    sum = cag_madd(sum, area / 3, cag_add(a, cag_add(b, c)));
    whole += area;
  }
  return whole > 0 ? cag_madd(about, 1 / whole, sum) : UNDEFINED;
}

static CagStatus measure_mesh(const CagMesh *m, CagItemMeasures *out, CagError *err) {
  CagMesh *near = NULL;
  CagVec3 edge[2];
  double terms[10] = {0};
  bool watertight;
  const CagVec3 middle = middle_of(&out->bounds);
  const CagTransform shift = cag_translate(cag_scaled(middle, -1));
  out->exact = out->has_faces = true;
  out->faces = m->triangle_count;
  out->area = cag_mesh_area(m);
  out->centroid = area_centroid(m, middle);
  CagStatus status = cag_mesh_watertight(m, &watertight, edge, err);
  if (status || !watertight) return status;
  status = cag_mesh_transform(m, &shift, &near, err);
  if (status) return status;
  cag_mesh_volume_terms(near, terms);
  cag_mesh_release(near);
  set_volume(terms, middle, out);
  return CAG_OK;
}

// The mesh shows whether the shape has a boundary.
static CagStatus look_at_mesh(const CagScene *s, const CagItem *item, CagItemMeasures *out,
                              CagError *err) {
  CagMesh *m = NULL;
  CagVec3 edge[2];
  CagStatus status = cag_item_mesh(s, item, &m, err);
  if (status) return status;
  out->triangles = m->triangle_count;
  status = cag_mesh_watertight(m, &out->closed, edge, err);
  cag_mesh_release(m);
  return status;
}

CagStatus cag_item_measure(const CagScene *s, const CagItem *item, CagItemMeasures *out,
                           CagError *err) {
  *out = (CagItemMeasures){.length = NAN, .area = NAN, .volume = NAN, .centroid = UNDEFINED};
  CagStatus status = cag_item_bounds(item, NULL, &out->bounds, err);
  if (status) return status;
  switch (item->kind) {
  case CAG_ITEM_CURVE: return measure_curve(item->as.curve, out, err);
  case CAG_ITEM_REGION: status = measure_region(item, out, err); break;
  case CAG_ITEM_SURFACE: status = measure_surface(item->as.surface, out, err); break;
  case CAG_ITEM_SOLID: status = measure_solid(s, item, out, err); break;
  case CAG_ITEM_MESH: status = measure_mesh(item->as.mesh, out, err); break;
  case CAG_ITEM_GROUND: return CAG_OK;
  }
  return status ? status : look_at_mesh(s, item, out, err);
}

const char *cag_item_type(const CagItem *item) {
  static const char *const names[] = {
      [CAG_ITEM_CURVE] = "curve", [CAG_ITEM_REGION] = "region", [CAG_ITEM_SURFACE] = "surface",
      [CAG_ITEM_SOLID] = "solid", [CAG_ITEM_MESH] = "mesh",     [CAG_ITEM_GROUND] = "ground"};
  return names[item->kind];
}

const char *cag_item_kind(const CagItem *item) {
  const CagSurface *inner;
  CagTransform map;
  switch (item->kind) {
  case CAG_ITEM_CURVE: return item->as.curve->kind->name;
  case CAG_ITEM_SURFACE:
    return cag_surface_placed_view(item->as.surface, &inner, &map) ? inner->kind->name
                                                                   : item->as.surface->kind->name;
  case CAG_ITEM_SOLID: return cag_solid_kind_name(item->as.solid->kind);
  default: return cag_item_type(item);
  }
}
