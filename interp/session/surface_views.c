// What the exact surfaces of parts are like: curvature, lines of parameters, control points, and
// how far meshes are from them.

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "geom/ray/mesh_surface.h"
#include "geom/surface/trimmed.h"
#include "interp/session/part_mesh.h"
#include "interp/session/polylines.h"

// Lines of each direction of a surface, in addition to the last one.
enum { ISOLINES = 8 };
// Steps along a line of a trimmed surface, at each of which it may enter or leave.
enum { TRIMMED_STEPS = 160 };

// --- Isolines ---

static CagStatus fail_without(const CagItem *item, const char *why, CagError *err) {
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_value, "", -1, "%s %s", item->name ? item->name : "",
                  why);
}

static const char *why_no_surface(const CagItem *item) {
  switch (item->kind) {
  case CAG_ITEM_CURVE: return "is a curve, which has no surface";
  case CAG_ITEM_REGION: return "is a region, which is flat";
  case CAG_ITEM_MESH: return "is a mesh, which has no exact surface";
  default: return "has no exact surface";
  }
}

// The parts of a line that are in the region of a trimmed surface.
static CagStatus trimmed_isoline(const CagSurface *s, const CagRegion *region, int direction,
                                 double at, CagPolylines *l, CagError *err) {
  bool before = false;
  CagStatus status = CAG_OK;
  for (int k = 0; !status && k <= TRIMMED_STEPS; k++) {
    const double part = (double)k / TRIMMED_STEPS;
    const double u = direction == 0 ? at : s->u0 + (s->u1 - s->u0) * part,
                 v = direction == 0 ? s->v0 + (s->v1 - s->v0) * part : at;
    bool inside = false;
    CagVec3 p;
    status = cag_region_contains(region, cag_vec3(u, v, 0), &inside, err);
    if (!status && inside && !before) status = cag_polylines_begin(l, err);
    if (!status && inside) status = cag_surface_point(s, u, v, &p, err);
    if (!status && inside) status = cag_polylines_add(l, p, err);
    before = inside;
  }
  return status;
}

static CagStatus surface_isolines(const CagSurface *s, CagPolylines *l, CagError *err) {
  const double from[2] = {s->u0, s->v0}, to[2] = {s->u1, s->v1};
  const CagTransform same = cag_transform_identity();
  const CagSurface *inner;
  const CagRegion *region;
  const bool trimmed = cag_surface_trimmed_view(s, &inner, &region);
  CagStatus status = CAG_OK;
  for (int direction = 0; direction < 2; direction++)
    for (int k = 0; !status && k <= ISOLINES; k++) {
      CagCurve *line = NULL;
      const double at = from[direction] + (to[direction] - from[direction]) * k / ISOLINES;
      if (trimmed) {
        status = trimmed_isoline(s, region, direction, at, l, err);
        continue;
      }
      status = cag_surface_isocurve(s, direction, at, &line, err);
      if (!status) status = cag_polylines_curve(l, line, &same, err);
      cag_curve_release(line);
    }
  return status;
}

// Flat faces have no lines that tell anything.
static bool has_isolines(const CagSurface *s) {
  const CagRegion *region;
  const CagSurface *inner;
  CagTransform map;
  if (cag_surface_placed_view(s, &inner, &map)) return has_isolines(inner);
  return !cag_surface_planar_view(s, &region, &map);
}

typedef CagStatus OnFace(const CagSurface *s, CagPolylines *l, CagError *err);

static CagStatus each_face(const CagItem *item, OnFace *each, CagPolylines *l, CagError *err) {
  CagStatus status = CAG_OK;
  if (item->kind == CAG_ITEM_SURFACE) return each(item->as.surface, l, err);
  if (item->kind != CAG_ITEM_SOLID) return fail_without(item, why_no_surface(item), err);
  if (item->as.solid->face_count == 0)
    return fail_without(item, "is a set operation, whose faces have no parameters", err);
  for (size_t i = 0; !status && i < item->as.solid->face_count; i++)
    status = each(item->as.solid->faces[i], l, err);
  return status;
}

static CagStatus face_isolines(const CagSurface *s, CagPolylines *l, CagError *err) {
  return has_isolines(s) ? surface_isolines(s, l, err) : CAG_OK;
}

// --- Control points ---

static CagVec3 control_point(const double *h) {
  return cag_vec3(h[0] / h[3], h[1] / h[3], h[2] / h[3]);
}

// The rows of a net, or with `across` its columns. Those of a periodic direction close.
static CagStatus net_lines(const CagSurfaceNurbsView *v, const CagTransform *map, bool across,
                           CagPolylines *l, CagError *err) {
  const size_t lines = across ? v->distinct_v : v->distinct_u,
               points = across ? v->distinct_u : v->distinct_v;
  const bool closes = across ? v->periodic_u : v->periodic_v;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < lines; i++) {
    status = cag_polylines_begin(l, err);
    for (size_t k = 0; !status && k < points + (closes ? 1 : 0); k++) {
      const size_t row = across ? k % points : i, column = across ? i : k % points;
      const CagVec3 p = control_point(v->homogeneous + 4 * (row * v->nv + column));
      status = cag_polylines_add(l, cag_transform_point(map, p), err);
    }
  }
  return status;
}

static CagStatus face_net(const CagSurface *s, CagPolylines *l, CagError *err) {
  CagSurfaceNurbsView v;
  const CagSurface *inner;
  const CagRegion *region;
  CagTransform map = cag_transform_identity();
  if (cag_surface_trimmed_view(s, &inner, &region)) s = inner;
  if (cag_surface_placed_view(s, &inner, &map)) s = inner;
  if (!cag_surface_nurbs_view(s, &v)) return CAG_OK;
  const CagStatus status = net_lines(&v, &map, false, l, err);
  return status ? status : net_lines(&v, &map, true, l, err);
}

static CagStatus curve_net(const CagCurve *c, CagPolylines *l, CagError *err) {
  CagNurbsView v;
  if (!cag_curve_nurbs_view(c, &v)) return CAG_OK;
  CagStatus status = cag_polylines_begin(l, err);
  for (size_t i = 0; !status && i < v.distinct + (v.periodic ? 1 : 0); i++)
    status = cag_polylines_add(l, control_point(v.homogeneous + 4 * (i % v.distinct)), err);
  return status;
}

static CagStatus find_net(const CagItem *item, CagPolylines *l, CagError *err) {
  const CagStatus status = item->kind == CAG_ITEM_CURVE ? curve_net(item->as.curve, l, err)
                                                        : each_face(item, face_net, l, err);
  if (status || l->count > 0) return status;
  return fail_without(item, "is not a spline, so it has no control points", err);
}

// --- Values ---

static CagStatus caster_of(const CagItem *item, CagCaster **out, CagError *err) {
  if (item->kind == CAG_ITEM_SURFACE) return cag_caster_of_surface(item->as.surface, out, err);
  if (item->kind == CAG_ITEM_SOLID && item->as.solid->kind != CAG_SOLID_MESH)
    return cag_caster_of_solid(item->as.solid, out, err);
  return fail_without(item, why_no_surface(item), err);
}

typedef struct Asking {
  const CagItem *item;
  const char *what;
  CagSurfaceView *out;
} Asking;

static CagStatus find_values(CagSessionMesh *m, bool curvature, CagSurfaceView *out,
                             CagError *err) {
  const size_t n = m->mesh->triangle_count;
  CagCaster *caster = NULL;
  CagStatus status = caster_of(&m->item, &caster, err);
  if (status) return status;
  m->values = cag_malloc((6 * n + 1) * sizeof *m->values);
  if (!m->values) status = cag_fail_memory(err);
  else if (curvature)
    status = cag_mesh_curvature(caster, m->mesh, m->values, m->values + 3 * n, err);
  else status = cag_mesh_deviation(caster, m->mesh, m->values, &out->farthest, err);
  cag_caster_free(caster);
  out->triangle_count = n;
  if (curvature) out->mean = m->values, out->gaussian = m->values ? m->values + 3 * n : NULL;
  else out->distance = m->values;
  memcpy(out->id, m->id, sizeof out->id);
  return status;
}

static int ask_values(CagSession *s, void *context) {
  const Asking *a = context;
  CagError err = {0};
  const CagStatus status = cag_session_checked(
      s, find_values(s->mesh, !strcmp(a->what, "curvature"), a->out, &err), &err);
  return status ? cag_session_fail_geometry(s, &err) : CAG_STATUS_OK;
}

static int ask_lines(CagSession *s, void *context) {
  const Asking *a = context;
  CagError err = {0};
  CagPolylines l = {0};
  cag_session_drop_mesh(s);
  CagStatus status = !strcmp(a->what, "net") ? find_net(a->item, &l, &err)
                                             : each_face(a->item, face_isolines, &l, &err);
  if (!status && !(s->mesh = cag_calloc(1, sizeof *s->mesh))) status = cag_fail_memory(&err);
  status = cag_session_checked(s, status, &err);
  if (status) {
    cag_polylines_free(&l);
    return cag_session_fail_geometry(s, &err);
  }
  s->mesh->values = l.points;
  s->mesh->sizes = l.sizes;
  a->out->points = l.points;
  a->out->point_count = l.point_count / 3;
  a->out->line_sizes = l.sizes;
  a->out->line_count = l.count;
  return CAG_STATUS_OK;
}

static int check_has_surface(CagSession *s, void *context) {
  const CagItem *item = context;
  CagError err = {0};
  if (item->kind == CAG_ITEM_SURFACE ||
      (item->kind == CAG_ITEM_SOLID && item->as.solid->kind != CAG_SOLID_MESH))
    return CAG_STATUS_OK;
  fail_without(item, why_no_surface(item), &err);
  return cag_session_fail_geometry(s, &err);
}

int cag_session_part_surface(CagSession *s, size_t part, const char *what, CagSurfaceView *out) {
  CagMeshView mesh;
  *out = (CagSurfaceView){0};
  const bool values = !strcmp(what, "curvature") || !strcmp(what, "deviation");
  if (!values && strcmp(what, "isolines") != 0 && strcmp(what, "net") != 0) return CAG_STATUS_USAGE;
  if (!cag_session_begin(s)) return CAG_STATUS_USAGE;
  if (!s->has_scene || part >= s->scene.item_count || s->scene.items[part].kind == CAG_ITEM_GROUND)
    return cag_session_end(s, CAG_STATUS_USAGE);
  CagItem *item = &s->scene.items[part];
  const CagItemSource *source = cag_session_item_source(s, item);
  Asking a = {item, what, out};
  int status = CAG_STATUS_OK;
  if (values) status = cag_session_geometry(s, check_has_surface, item);
  if (values && status == CAG_STATUS_OK)
    status = cag_session_item_mesh(s, item, source ? source->shape : NULL, 1, NULL, NULL, &mesh);
  if (status == CAG_STATUS_OK)
    status = cag_session_geometry(s, values ? ask_values : ask_lines, &a);
  return cag_session_end(s, status);
}
