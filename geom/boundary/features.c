// Edges and corners of a boundary (see features.h).

#include "geom/boundary/features.h"

#include <math.h>
#include <stdint.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/boundary/carrier.h"
#include "geom/boundary/face_feature.h"
#include "geom/boundary/meshed.h"
#include "geom/curve/family.h"
#include "geom/linalg/tolerance.h"

// Faces meet smoothly if their normals differ by less, in radians. The normals of approximated
// blends are less accurate than those of other carriers.
#define SMOOTH 1e-4

void cag_features_free(CagFeatures *f) {
  cag_free(f->faces);
  cag_free(f->edges);
  cag_free(f->corners);
  cag_free(f->edge_faces);
  cag_free(f->corner_edges);
  *f = (CagFeatures){0};
}

// What is known of the boundary while its features are collected.
typedef struct Work {
  const CagBoundary *b;
  CagFeatures *out;
  size_t *face_of;       // by uses
  size_t *first, *users; // the uses of edge e are users[first[e]] to users[first[e + 1] - 1]
  CagBounds *boxes;      // by edges
} Work;

static void work_free(Work *w) {
  cag_free(w->face_of);
  cag_free(w->first);
  cag_free(w->users);
  cag_free(w->boxes);
}

static CagStatus sort_uses(Work *w, CagError *err) {
  const CagBoundary *b = w->b;
  w->face_of = cag_calloc(b->use_count + 1, sizeof *w->face_of);
  w->first = cag_calloc(b->edge_count + 2, sizeof *w->first);
  w->users = cag_calloc(b->use_count + 1, sizeof *w->users);
  if (!w->face_of || !w->first || !w->users) return cag_fail_memory(err);
  for (size_t f = 0; f < b->face_count; f++)
    for (size_t l = b->faces[f].first; l < b->faces[f].first + b->faces[f].count; l++)
      for (size_t u = b->loops[l].first; u < b->loops[l].first + b->loops[l].count; u++)
        w->face_of[u] = f;
  for (size_t u = 0; u < b->use_count; u++) w->first[b->uses[u].edge + 2]++;
  for (size_t e = 0; e < b->edge_count; e++) w->first[e + 2] += w->first[e + 1];
  for (size_t u = 0; u < b->use_count; u++) w->users[w->first[b->uses[u].edge + 1]++] = u;
  return CAG_OK;
}

// --- Edges ---

static const char *curve_kind(const CagCurve *c, double *radius, double *sweep) {
  CagVec3 center, x, y;
  CagNurbsView view;
  double rate;
  *radius = *sweep = 0;
  if (cag_curve_arc_axes(c, &center, &x, &y, &rate)) {
    const double a = cag_norm(x), b = cag_norm(y);
    *sweep = fabs(rate) * (c->end - c->start);
    if (fabs(a - b) > CAG_COINCIDENT * a || fabs(cag_dot(x, y)) > CAG_COINCIDENT * a * a)
      return "ellipse";
    *radius = a;
    return "circle";
  }
  return cag_curve_nurbs_view(c, &view) && view.degree == 1 && view.count == 2 ? "line" : "spline";
}

// The length, the ends, and the direction in the middle.
static CagStatus describe_curve(const CagCurve *c, CagEdgeFeature *out, CagError *err) {
  double radius, sweep;
  CagVec3 middle;
  out->kind = curve_kind(c, &radius, &sweep);
  CagStatus status = cag_curve_point(c, c->start, &out->start, err);
  if (!status) status = cag_curve_point(c, c->end, &out->end, err);
  if (!status)
    status = cag_curve_tangent(c, c->start + (c->end - c->start) / 2, CAG_SIDE_RIGHT, &middle, err);
  if (status) return status;
  const double along[3] = {middle.x, middle.y, middle.z};
  int k = 0;
  while (k < 2 && fabs(along[k]) <= CAG_PARALLEL) k++;
  out->flipped = along[k] < 0;
  out->direction = out->flipped ? cag_scaled(middle, -1) : middle;
  if (out->flipped) {
    const CagVec3 start = out->start;
    out->start = out->end;
    out->end = start;
  }
  if (radius > 0) out->length = radius * sweep;
  else if (out->kind[0] == 'l') out->length = cag_norm(cag_sub(out->end, out->start));
  else status = cag_curve_length(c, c->start, c->end, &out->length, err);
  return status;
}

// The outward normal of a face and the direction into it, at the middle of an edge whose tangent
// there is `along`.
static CagStatus side_of(const Work *w, size_t use, CagVec3 along, CagVec3 *normal, CagVec3 *into,
                         CagError *err) {
  const CagBoundary *b = w->b;
  const CagBoundaryFace *f = &b->faces[w->face_of[use]];
  CagEdgePath path;
  double uv[2];
  CagStatus status = cag_edge_path(b, f, &b->uses[use], &path, err);
  if (!status) status = cag_edge_path_eval(&path, (path.start + path.end) / 2, uv, NULL, err);
  if (!status) status = cag_carrier_normal(&f->carrier, uv[0], uv[1], normal, err);
  if (status) return status;
  if (f->reversed) *normal = cag_scaled(*normal, -1);
  *into = cag_cross(*normal, path.reversed ? cag_scaled(along, -1) : along);
  return CAG_OK;
}

// From the face of a use in one direction, through the solid, to that of one in the other.
static CagStatus bend_of(const Work *w, size_t e, CagVec3 along, CagEdgeFeature *out,
                         CagError *err) {
  const CagBoundaryUse *uses = w->b->uses;
  const size_t *users = w->users + w->first[e], n = w->first[e + 1] - w->first[e];
  CagVec3 normal, into, other, across;
  size_t partner = 0;
  out->angle = M_PI;
  out->bend = CAG_EDGE_SMOOTH;
  for (size_t i = n; i-- > 1;)
    if (uses[users[i]].reversed != uses[users[0]].reversed) partner = i;
  if (partner == 0) return CAG_OK;
  CagStatus status = side_of(w, users[0], along, &normal, &into, err);
  if (!status) status = side_of(w, users[partner], along, &other, &across, err);
  if (status) return status;
  const bool ascending = w->face_of[users[0]] <= w->face_of[users[partner]];
  out->normals[!ascending] = normal;
  out->normals[ascending] = other;
  if (cag_norm(into) == 0 || cag_norm(across) == 0) return CAG_OK;
  const double angle = atan2(-cag_dot(across, normal), cag_dot(across, into));
  out->angle = angle < 0 ? angle + 2 * M_PI : angle;
  if (fabs(out->angle - M_PI) >= SMOOTH)
    out->bend = out->angle < M_PI ? CAG_EDGE_CONVEX : CAG_EDGE_CONCAVE;
  return CAG_OK;
}

// Adds the faces of an edge, each once. Returns their number.
static size_t add_faces(Work *w, size_t e, size_t at) {
  size_t n = 0;
  for (size_t i = w->first[e]; i < w->first[e + 1]; i++) {
    const size_t face = w->face_of[w->users[i]];
    bool known = false;
    for (size_t k = 0; k < n; k++) known = known || w->out->edge_faces[at + k] == face;
    if (!known) w->out->edge_faces[at + n++] = face;
  }
  for (size_t i = 1; i < n; i++) // ascending
    for (size_t k = at + i; k > at && w->out->edge_faces[k - 1] > w->out->edge_faces[k]; k--) {
      const size_t face = w->out->edge_faces[k];
      w->out->edge_faces[k] = w->out->edge_faces[k - 1];
      w->out->edge_faces[k - 1] = face;
    }
  return n;
}

static CagStatus collect_edges(Work *w, CagError *err) {
  CagFeatures *out = w->out;
  size_t used = 0;
  out->edges = cag_calloc(w->b->edge_count + 1, sizeof *out->edges);
  out->edge_faces = cag_calloc(w->b->use_count + 1, sizeof *out->edge_faces);
  if (!out->edges || !out->edge_faces) return cag_fail_memory(err);
  for (size_t e = 0; e < w->b->edge_count; e++) {
    const CagCurve *curve = w->b->edges[e].curve;
    if (!curve) continue;
    CagEdgeFeature edge = {.edge = e, .first = used};
    CagStatus status = cag_stop_check(err);
    if (!status) status = describe_curve(curve, &edge, err);
    if (!status)
      status = bend_of(w, e, cag_scaled(edge.direction, edge.flipped ? -1 : 1), &edge, err);
    if (status) return status;
    edge.count = add_faces(w, e, used);
    if (edge.count == 1 && edge.bend == CAG_EDGE_SMOOTH) continue; // a seam
    used += edge.count;
    out->edges[out->edge_count++] = edge;
  }
  return CAG_OK;
}

// --- Corners ---

// Marks corners at apexes of cones, where no edges need to end. In a boundary that was found from a
// mesh, no degenerate edges tell them, but they are computed from the cone.
static void mark_apexes(const Work *w, bool *apex) {
  const CagBoundary *b = w->b;
  for (size_t i = 0; b->mesh && i < b->face_count; i++) {
    const CagCarrier *cone = &b->faces[i].carrier;
    CagVec3 at;
    if (!cag_carrier_apex(cone, &at)) continue;
    const double rounding = CAG_COINCIDENT * (cag_norm(at) + cone->a);
    for (size_t c = 0; c < b->corner_count; c++)
      apex[c] = apex[c] || cag_norm(cag_sub(b->corners[c], at)) <= rounding;
  }
  for (size_t u = 0; u < b->use_count; u++) {
    const CagBoundaryEdge *e = &b->edges[b->uses[u].edge];
    if (!e->curve && b->faces[w->face_of[u]].carrier.kind == CAG_CARRIER_CONE) apex[e->from] = true;
  }
}

static CagStatus collect_corners(Work *w, CagError *err) {
  const CagBoundary *b = w->b;
  CagFeatures *out = w->out;
  const size_t n = b->corner_count;
  // The edges at corner c are at first[c] to first[c + 1] - 1.
  size_t *first = cag_calloc(n + 2, sizeof *first);
  bool *apex = cag_calloc(n + 1, sizeof *apex), *open = cag_calloc(n + 1, sizeof *open);
  out->corners = cag_calloc(n + 1, sizeof *out->corners);
  out->corner_edges = cag_calloc(2 * out->edge_count + 1, sizeof *out->corner_edges);
  CagStatus status =
      first && apex && open && out->corners && out->corner_edges ? CAG_OK : cag_fail_memory(err);
  for (int pass = 0; !status && pass < 2; pass++) {
    for (size_t i = 0; i < out->edge_count; i++) {
      const CagBoundaryEdge *e = &b->edges[out->edges[i].edge];
      const size_t ends[2] = {e->from, e->to}, several = e->from == e->to ? 1 : 2;
      for (size_t k = 0; k < several; k++) {
        if (pass == 0) first[ends[k] + 2]++;
        else out->corner_edges[first[ends[k] + 1]++] = i;
        if (several == 2) open[ends[k]] = true;
      }
    }
    for (size_t c = 0; pass == 0 && c < n; c++) first[c + 2] += first[c + 1];
  }
  if (!status) mark_apexes(w, apex);
  for (size_t c = 0; !status && c < n; c++) {
    const size_t count = first[c + 1] - first[c];
    if (!open[c] && count < 2 && !(apex[c] && count == 0)) continue;
    out->corners[out->corner_count++] = (CagCornerFeature){c, b->corners[c], first[c], count};
  }
  cag_free(first);
  cag_free(apex);
  cag_free(open);
  return status;
}

CagStatus cag_boundary_features(const CagBoundary *b, CagFeatures *out, CagError *err) {
  CagFeatures f = {.face_count = b->face_count};
  Work w = {.b = b, .out = &f};
  f.faces = cag_calloc(b->face_count + 1, sizeof *f.faces);
  CagStatus status = f.faces ? sort_uses(&w, err) : cag_fail_memory(err);
  if (!status) status = cag_boundary_edge_boxes(b, &w.boxes, err);
  for (size_t i = 0; !status && i < b->face_count; i++)
    status = b->mesh ? cag_meshed_face(b, i, &f.faces[i], err)
                     : cag_face_feature(b, i, w.boxes, &f.faces[i], err);
  if (!status) status = collect_edges(&w, err);
  if (!status) status = collect_corners(&w, err);
  work_free(&w);
  if (status) cag_features_free(&f);
  else *out = f;
  return status;
}
