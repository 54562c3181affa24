// The curves in which a plane cuts the parts of a scene, with their lengths and areas.

#include <math.h>

#include "geom/meet/section.h"
#include "geom/meet/section_region.h"
#include "geom/solid/csg.h"
#include "interp/scene/item_mesh.h"
#include "interp/scene/section.h"
#include "interp/session/polylines.h"
#include "interp/session/session.h"

typedef struct Cutting {
  const CagItem *item;
  CagPlane plane;
  CagTransform frame;
  void (*give)(void *context, const CagSectionCurve *c);
  void *context;
} Cutting;

// Whether a solid consists of operands whose sections are known as curves.
static bool is_exact(const CagSolid *s) {
  if (s->kind == CAG_SOLID_MESH || s->kind == CAG_SOLID_HALF_SPACE || s->kind == CAG_SOLID_QUADRIC)
    return false;
  for (size_t i = 0; s->core && i < s->core->count; i++)
    if (!is_exact(s->core->operands[i])) return false;
  return true;
}

// Gives a curve in the coordinates of `map`. `area`, unless NaN, is the area within it.
static CagStatus give_curve(const Cutting *c, const CagCurve *curve, const CagTransform *map,
                            double area, bool exact, CagError *err) {
  CagPolylines l = {0};
  CagSectionCurve out = {
      .part = c->item->name, .closed = curve->closed, .exact = exact, .area = area};
  CagStatus status = cag_curve_length(curve, curve->start, curve->end, &out.length, err);
  if (!status) status = cag_polylines_curve(&l, curve, map, err);
  out.points = l.points;
  out.point_count = l.point_count / 3;
  if (!status) c->give(c->context, &out);
  cag_polylines_free(&l);
  return status;
}

static CagStatus cut_body(const Cutting *c, const CagScene *scene, CagError *err) {
  const CagTessellation how = cag_item_fineness(scene, c->item);
  CagRegion *r = NULL;
  CagStatus status = cag_solid_section_region(c->item->as.solid, &c->frame, 0, &how, &r, err);
  for (size_t i = 0; !status && i < r->count; i++) {
    double area;
    status = cag_curve_area(r->loops[i], &area, NULL, err); // negative for holes
    if (!status)
      status = give_curve(c, r->loops[i], &c->frame, area, is_exact(c->item->as.solid), err);
  }
  cag_region_release(r);
  return status;
}

static CagStatus give_open(const Cutting *c, const CagCurve *curve, bool exact, CagError *err) {
  const CagTransform same = cag_transform_identity();
  CagCurve *flat = NULL;
  double area = NAN;
  CagStatus status = CAG_OK;
  if (curve->closed) {
    status = cag_curve_flatten(curve, &c->frame, &flat, err);
    if (!status) status = cag_curve_area(flat, &area, NULL, err);
    area = fabs(area);
  }
  cag_curve_release(flat);
  return status ? status : give_curve(c, curve, &same, area, exact, err);
}

static CagStatus cut_sheet(const Cutting *c, CagError *err) {
  CagCurveList curves = {0};
  CagSurface *flat = NULL;
  CagStatus status;
  const CagItem *item = c->item;
  const bool mesh = item->kind == CAG_ITEM_MESH;
  if (mesh) status = cag_mesh_section(item->as.mesh, &c->plane, &curves, err);
  else if (item->kind == CAG_ITEM_SURFACE)
    status = cag_surface_section(item->as.surface, &c->plane, 0, &curves, err);
  else {
    status = cag_surface_planar(item->as.region, &item->placement, &flat, err);
    if (!status) status = cag_surface_section(flat, &c->plane, 0, &curves, err);
  }
  for (size_t i = 0; !status && i < curves.count; i++)
    status = give_open(c, curves.items[i], !mesh, err);
  cag_curve_list_free(&curves);
  cag_surface_release(flat);
  return status;
}

static bool is_across(const Cutting *c, CagError *err) {
  CagTransform back;
  CagBounds box;
  if (cag_transform_inverse(&c->frame, &back, err) || cag_item_bounds(c->item, &back, &box, err))
    return true; // the section tells
  return box.min.z <= 0 && box.max.z >= 0;
}

static int cut_item(CagSession *s, void *context) {
  const Cutting *c = context;
  CagError err = {0};
  CagStatus status = CAG_OK;
  if (c->item->kind == CAG_ITEM_CURVE || c->item->kind == CAG_ITEM_GROUND || !is_across(c, &err))
    return CAG_STATUS_OK;
  err = (CagError){0};
  status = c->item->kind == CAG_ITEM_SOLID ? cut_body(c, &s->scene, &err) : cut_sheet(c, &err);
  status = cag_session_checked(s, status, &err);
  return !status || cag_is_empty_shape(&err) ? CAG_STATUS_OK : cag_session_fail_geometry(s, &err);
}

int cag_session_section_curves(CagSession *s, const double plane[4],
                               void (*give)(void *context, const CagSectionCurve *c),
                               void *context) {
  Cutting c = {.give = give, .context = context};
  CagError ignored;
  if (cag_plane_from_row((double[]){plane[0], plane[1], plane[2], -plane[3]}, &c.plane, &ignored) ||
      !cag_session_begin(s))
    return CAG_STATUS_USAGE;
  c.frame = cag_section_frame(&c.plane);
  int status = s->has_scene ? CAG_STATUS_OK : CAG_STATUS_USAGE;
  for (size_t i = 0; status == CAG_STATUS_OK && i < s->scene.item_count; i++) {
    c.item = &s->scene.items[i];
    status = cag_session_geometry(s, cut_item, &c);
  }
  return cag_session_end(s, status);
}
