// Moved copies of boundaries (see moved.h).
//
// A reflection makes right-handed frames left-handed. A plane then keeps its parameters and gets
// the opposite normal z; a carrier of revolution gets the opposite y, and the opposite angle u.
// Splines and extruded carriers keep their parameters, in which their normals are opposite to the
// images of the former ones.

#include "geom/boundary/moved.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/boundary/carrier.h"

typedef struct Move {
  const CagTransform *map;
  double scale;
  bool mirrors;
} Move;

// The factors of u and v.
typedef struct Factors {
  double u, v;
} Factors;

static Factors factors_of(const CagCarrier *c, const Move *m) {
  const double u = m->mirrors && cag_carrier_is_periodic(c, 0) ? -1 : 1;
  switch (c->kind) {
  case CAG_CARRIER_PLANE: return (Factors){m->scale, m->scale};
  case CAG_CARRIER_CYLINDER:
  case CAG_CARRIER_CONE:
  case CAG_CARRIER_EXTRUDED: return (Factors){u, m->scale};
  default: return (Factors){u, 1};
  }
}

static CagTransform moved_frame(const CagCarrier *c, const Move *m) {
  CagTransform t = cag_transform_identity();
  const int opposite = c->kind == CAG_CARRIER_PLANE ? 2 : 1;
  t.planar = false;
  for (int k = 0; k < 4; k++) {
    const CagVec3 from = cag_frame_column(&c->frame, k);
    CagVec3 to =
        k == 3 ? cag_transform_point(m->map, from) : cag_unit(cag_transform_vector(m->map, from));
    if (m->mirrors && k == opposite) to = cag_scaled(to, -1);
    t.m[0][k] = to.x;
    t.m[1][k] = to.y;
    t.m[2][k] = to.z;
  }
  return t;
}

static CagStatus move_carrier(const CagCarrier *c, const Move *m, CagCarrier *out, CagError *err) {
  CagCarrier moved = {.kind = c->kind, .a = c->a * m->scale, .b = c->b};
  CagStatus status = CAG_OK;
  if (c->kind == CAG_CARRIER_TORUS) moved.b *= m->scale;
  moved.frame = c->kind == CAG_CARRIER_SPLINE ? c->frame : moved_frame(c, m);
  if (c->profile) status = cag_curve_transform(c->profile, m->map, &moved.profile, err);
  if (!status && c->spline) status = cag_surface_transform(c->spline, m->map, &moved.spline, err);
  if (status) cag_curve_release(moved.profile);
  else *out = moved;
  return status;
}

static void move_domain(double domain[4], Factors f) {
  for (int k = 0; k < 4; k++) domain[k] *= k < 2 ? f.u : f.v;
  if (f.u > 0) return;
  const double u = domain[0];
  domain[0] = domain[1];
  domain[1] = u;
}

static CagStatus move_trace(CagCurve **trace, Factors f, CagError *err) {
  CagTransform t = cag_transform_identity();
  CagCurve *moved;
  if (!*trace || (f.u == 1 && f.v == 1)) return CAG_OK;
  t.m[0][0] = f.u;
  t.m[1][1] = f.v;
  CagStatus status = cag_curve_transform(*trace, &t, &moved, err);
  if (status) return status;
  cag_curve_release(*trace);
  *trace = moved;
  return CAG_OK;
}

// --- Copies ---

static void *copied(const void *items, size_t n, size_t size, bool *failed) {
  void *copy = cag_malloc((n + 1) * size);
  if (!copy) *failed = true;
  else if (n > 0) memcpy(copy, items, n * size);
  return copy;
}

// A copy that shares curves and surfaces.
static CagStatus copy_boundary(const CagBoundary *b, CagBoundary *out, CagError *err) {
  bool failed = false;
  *out = *b;
  out->corners = copied(b->corners, b->corner_count, sizeof *b->corners, &failed);
  out->edges = copied(b->edges, b->edge_count, sizeof *b->edges, &failed);
  out->uses = copied(b->uses, b->use_count, sizeof *b->uses, &failed);
  out->loops = copied(b->loops, b->loop_count, sizeof *b->loops, &failed);
  out->faces = copied(b->faces, b->face_count, sizeof *b->faces, &failed);
  out->shells = copied(b->shells, b->shell_count, sizeof *b->shells, &failed);
  out->order = copied(b->order, b->order_count, sizeof *b->order, &failed);
  out->name = cag_strdup(b->name ? b->name : "");
  out->use_room = b->use_count;
  out->loop_room = b->loop_count;
  out->order_room = b->order_count;
  out->body = NULL;
  out->body_length = 0;
  out->mesh = NULL;
  if (failed || !out->name) {
    // Nothing is shared yet.
    out->edge_count = out->use_count = out->face_count = 0;
    cag_boundary_free(out);
    return cag_fail_memory(err);
  }
  for (size_t i = 0; i < b->edge_count; i++)
    if (b->edges[i].curve) cag_curve_retain(b->edges[i].curve);
  for (size_t i = 0; i < b->use_count; i++)
    if (b->uses[i].trace) cag_curve_retain(b->uses[i].trace);
  for (size_t i = 0; i < b->face_count; i++) {
    if (b->faces[i].carrier.profile) cag_curve_retain(b->faces[i].carrier.profile);
    if (b->faces[i].carrier.spline) cag_surface_retain(b->faces[i].carrier.spline);
  }
  return CAG_OK;
}

static CagStatus move_edges(CagBoundary *b, const Move *m, CagError *err) {
  for (size_t i = 0; i < b->edge_count; i++) {
    CagBoundaryEdge *e = &b->edges[i];
    CagCurve *moved;
    e->gap *= m->scale;
    CagStatus status = cag_stop_check(err);
    if (!status && !e->curve) continue;
    if (!status) status = cag_curve_transform(e->curve, m->map, &moved, err);
    if (status) return status;
    cag_curve_release(e->curve);
    e->curve = moved;
  }
  return CAG_OK;
}

static void reverse_loop(CagBoundary *b, const CagBoundaryLoop *l) {
  CagBoundaryUse *uses = b->uses + l->first;
  for (size_t i = 0; i < l->count / 2; i++) {
    const CagBoundaryUse use = uses[i];
    uses[i] = uses[l->count - 1 - i];
    uses[l->count - 1 - i] = use;
  }
  for (size_t i = 0; i < l->count; i++) uses[i].reversed = !uses[i].reversed;
}

static CagStatus move_face(CagBoundary *b, CagBoundaryFace *f, const Move *m, CagError *err) {
  const Factors factors = factors_of(&f->carrier, m);
  CagCarrier moved;
  CagStatus status = move_carrier(&f->carrier, m, &moved, err);
  if (status) return status;
  cag_curve_release(f->carrier.profile);
  cag_surface_release(f->carrier.spline);
  f->carrier = moved;
  move_domain(f->domain, factors);
  if (m->mirrors && factors.u > 0) f->reversed = !f->reversed;
  for (size_t l = f->first; !status && l < f->first + f->count; l++) {
    const CagBoundaryLoop *loop = &b->loops[l];
    for (size_t u = loop->first; !status && u < loop->first + loop->count; u++)
      status = move_trace(&b->uses[u].trace, factors, err);
    if (m->mirrors) reverse_loop(b, loop);
  }
  return status;
}

CagStatus cag_boundary_moved(const CagBoundary *b, const CagTransform *similarity, CagBoundary *out,
                             CagError *err) {
  Move m = {.map = similarity, .mirrors = cag_transform_mirrors(similarity)};
  CagBoundary moved;
  if (!cag_transform_is_similarity(similarity, &m.scale))
    return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_no_boundary, "", -1,
                    "its exact boundary can be moved and scaled uniformly only");
  CagStatus status = copy_boundary(b, &moved, err);
  if (status) return status;
  for (size_t i = 0; i < b->corner_count; i++)
    moved.corners[i] = cag_transform_point(similarity, b->corners[i]);
  status = move_edges(&moved, &m, err);
  for (size_t i = 0; !status && i < b->face_count; i++)
    status = move_face(&moved, &moved.faces[i], &m, err);
  moved.volume *= m.scale * m.scale * m.scale;
  moved.area *= m.scale * m.scale;
  moved.centroid = cag_transform_point(similarity, b->centroid);
  if (!status && b->mesh) status = cag_mesh_transform(b->mesh, similarity, &moved.mesh, err);
  if (status) cag_boundary_free(&moved);
  else *out = moved;
  return status;
}
