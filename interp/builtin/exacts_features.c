// Records of the faces, edges, and corners of exact solids.

#include "interp/builtin/exacts_features.h"

#include "geom/boundary/features.h"
#include "geom/boundary/moved.h"
#include "geom/solid/exact.h"
#include "interp/builtin/support.h"
#include "interp/vm/vm.h"

// A part in world coordinates, and the numbers of faces and edges of the parts before it.
typedef struct Part {
  CagBoundary boundary;
  CagFeatures features;
  size_t first_face, first_edge;
} Part;

typedef struct Parts {
  Part *items;
  size_t count;
} Parts;

static void release_parts(void *what) {
  Parts *p = what;
  for (size_t i = 0; i < p->count; i++) {
    cag_features_free(&p->items[i].features);
    cag_boundary_free(&p->items[i].boundary);
  }
  cag_free(p->items);
  cag_free(p);
}

// Held by the call. NULL: an error is set.
static Parts *parts_of(CagCall *call, const CagSolid *exact) {
  size_t n = 0, faces = 0, edges = 0;
  const CagBoundary *own = cag_solid_boundaries(exact, &n);
  Parts *p = cag_calloc(1, sizeof *p);
  if (!p) cag_vm_out_of_memory(call->vm);
  cag_hold_for(call, release_parts, p);
  p->items = cag_calloc(n + 1, sizeof *p->items);
  if (!p->items) cag_vm_out_of_memory(call->vm);
  for (size_t i = 0; i < n; i++) {
    Part *part = &p->items[i];
    CagStatus status = cag_boundary_moved(&own[i], &exact->placement, &part->boundary, call->err);
    if (!status) p->count++;
    if (!status) status = cag_boundary_features(&part->boundary, &part->features, call->err);
    if (!cag_geometry_ok(call, status)) return NULL;
    part->first_face = faces;
    part->first_edge = edges;
    faces += part->features.face_count;
    edges += part->features.edge_count;
  }
  return p;
}

static CagValue angle_value(double radians) { return cag_angle(cag_degrees_shown(radians)); }

static bool indexes_value(CagVm *vm, const size_t *indexes, size_t n, size_t add, CagValue *out) {
  CagBuilder *list = cag_builder_new(vm);
  for (size_t i = 0; i < n; i++)
    if (!cag_builder_add(vm, list, cag_number((double)(indexes[i] + add)))) return false;
  *out = cag_builder_finish(vm, list);
  return true;
}

// --- Faces ---

static CagValue face_record(CagVm *vm, const CagFaceFeature *f, const CagSurface *s, size_t index) {
  static const char *const names[] = {"surface", "kind",   "area", "normal",
                                      "center",  "bounds", "index"};
  const CagValue values[] = {cag_surface_value(vm, cag_surface_retain(s)),
                             cag_text_c(vm, f->kind),
                             cag_number(f->area),
                             cag_point(vm, f->normal, 3),
                             cag_point(vm, f->center, 3),
                             cag_bounds_value(vm, &f->bounds, 3),
                             cag_number((double)index)};
  return cag_record_new(vm, names, values, sizeof values / sizeof *values);
}

bool cag_exacts_face_records(CagCall *call, const CagSolid *exact, CagValue *list) {
  const Parts *p = parts_of(call, exact);
  if (!p) return false;
  CagBuilder *all = cag_builder_new(call->vm);
  for (size_t i = 0; i < p->count; i++) {
    const Part *part = &p->items[i];
    for (size_t k = 0; k < part->features.face_count; k++) {
      const size_t index = part->first_face + k;
      if (!cag_builder_add(
              call->vm, all,
              face_record(call->vm, &part->features.faces[k], exact->faces[index], index)))
        return false;
    }
  }
  *list = cag_builder_finish(call->vm, all);
  return true;
}

// --- Edges ---

// The curve along the direction of the edge. Lines of degree 1 become lines.
static CagStatus edge_curve(const Part *part, const CagEdgeFeature *e, CagCurve **out,
                            CagError *err) {
  CagCurve *curve = part->boundary.edges[e->edge].curve;
  if (e->kind[0] == 'l') return cag_curve_line(e->start, e->end, 3, out, err);
  if (e->flipped) return cag_curve_reverse(curve, out, err);
  *out = cag_curve_retain(curve);
  return CAG_OK;
}

static bool edge_record(CagCall *call, const Part *part, size_t k, CagValue *out) {
  static const char *const names[] = {"curve",     "kind",  "length", "convex", "bend",    "angle",
                                      "direction", "start", "end",    "faces",  "normals", "index"};
  static const char *const bends[] = {
      [CAG_EDGE_CONVEX] = "convex", [CAG_EDGE_CONCAVE] = "concave", [CAG_EDGE_SMOOTH] = "smooth"};
  CagVm *vm = call->vm;
  const CagEdgeFeature *e = &part->features.edges[k];
  CagCurve *curve;
  CagValue faces;
  if (!cag_geometry_ok(call, edge_curve(part, e, &curve, call->err))) return false;
  const CagValue shape = cag_curve_value(vm, curve);
  if (!indexes_value(vm, part->features.edge_faces + e->first, e->count, part->first_face, &faces))
    return false;
  const CagValue values[] = {shape,
                             cag_text_c(vm, e->kind),
                             cag_number(e->length),
                             cag_bool(e->bend == CAG_EDGE_CONVEX),
                             cag_text_c(vm, bends[e->bend]),
                             angle_value(e->angle),
                             cag_point(vm, e->direction, 3),
                             cag_point(vm, e->start, 3),
                             cag_point(vm, e->end, 3),
                             faces,
                             cag_points_value(vm, e->normals, 2, 3),
                             cag_number((double)(part->first_edge + k))};
  *out = cag_record_new(vm, names, values, sizeof values / sizeof *values);
  return true;
}

bool cag_exacts_edge_records(CagCall *call, const CagSolid *exact, CagValue *list) {
  const Parts *p = parts_of(call, exact);
  if (!p) return false;
  CagBuilder *all = cag_builder_new(call->vm);
  for (size_t i = 0; i < p->count; i++)
    for (size_t k = 0; k < p->items[i].features.edge_count; k++) {
      CagValue record;
      if (!edge_record(call, &p->items[i], k, &record) || !cag_builder_add(call->vm, all, record))
        return false;
    }
  *list = cag_builder_finish(call->vm, all);
  return true;
}

// --- Corners ---

bool cag_exacts_corner_records(CagCall *call, const CagSolid *exact, CagValue *list) {
  static const char *const names[] = {"point", "edges", "index"};
  const Parts *p = parts_of(call, exact);
  CagVm *vm = call->vm;
  size_t index = 0;
  if (!p) return false;
  CagBuilder *all = cag_builder_new(vm);
  for (size_t i = 0; i < p->count; i++) {
    const CagFeatures *f = &p->items[i].features;
    for (size_t k = 0; k < f->corner_count; k++) {
      const CagCornerFeature *c = &f->corners[k];
      CagValue edges;
      if (!indexes_value(vm, f->corner_edges + c->first, c->count, p->items[i].first_edge, &edges))
        return false;
      const CagValue values[] = {cag_point(vm, c->point, 3), edges, cag_number((double)index++)};
      if (!cag_builder_add(vm, all, cag_record_new(vm, names, values, 3))) return false;
    }
  }
  *list = cag_builder_finish(vm, all);
  return true;
}

bool cag_exacts_same_record(CagVm *vm, CagValue a, CagValue b) {
  if (a.type != CAG_RECORD || b.type != CAG_RECORD) return false;
  const CagRecord *r = CAG_AS_RECORD(a), *s = CAG_AS_RECORD(b);
  if (r->layout->count != s->layout->count) return false;
  for (size_t i = 0; i < r->layout->count; i++) {
    if (r->layout->names[i] != s->layout->names[i]) return false;
    const CagType type = r->fields[i].type;
    if (type == CAG_SURFACE || type == CAG_CURVE) continue;
    if (!cag_equal(vm, r->fields[i], s->fields[i])) return false;
  }
  return true;
}

// --- Built-ins ---

bool cag_exacts_faces_of(CagCall *call, const struct cag_exacts_faces_of *a, CagValue *result) {
  const CagSolid *s;
  (void)a;
  return cag_exacts_or_meshed(call, 0, &s) && cag_exacts_face_records(call, s, result);
}

bool cag_exacts_edges_of(CagCall *call, const struct cag_exacts_edges_of *a, CagValue *result) {
  const CagSolid *s;
  (void)a;
  return cag_exacts_or_meshed(call, 0, &s) && cag_exacts_edge_records(call, s, result);
}

bool cag_exacts_corners_of(CagCall *call, const struct cag_exacts_corners_of *a, CagValue *result) {
  const CagSolid *s;
  (void)a;
  return cag_exacts_or_meshed(call, 0, &s) && cag_exacts_corner_records(call, s, result);
}
