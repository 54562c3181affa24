// Faces: kinds, areas, centers, normals, and bounds (see features.h).

#include "geom/boundary/face_feature.h"

#include <math.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/boundary/carrier.h"
#include "geom/boundary/measure.h"
#include "geom/boundary/outline.h"

// A center this close to the axis of a face, as a fraction of the distances, is equally far from
// all sides.
#define CENTRAL 1e-9
// Samples of a face in each direction, and steps that refine the best of them.
#define SAMPLES 24
#define NEWTON_STEPS 30
// Samples of an edge, and sections between two of them.
#define EDGE_SAMPLES 32
#define GOLDEN_STEPS 40
#define GOLDEN 1.618033988749895
// The step of difference quotients of the derivatives, as a fraction of the domain.
#define DIFFERENCE 1e-5

static double coordinate(CagVec3 p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

static CagVec3 axis_of(int k) { return cag_vec3(k == 0, k == 1, k == 2); }

static double clamped(double t, double lo, double hi) { return fmin(fmax(t, lo), hi); }

// --- The point nearest to the center ---

typedef struct Foot {
  double uv[2], distance;
} Foot;

// The point of the carrier at parameters, and whether the face contains it. If so, they are changed
// by periods to those of the loops.
static CagStatus point_inside(const CagFaceOutline *o, double uv[2], bool *inside,
                              CagCarrierPoint *out, CagError *err) {
  CagStatus status = cag_face_outline_has(o, uv, inside, err);
  if (status || !*inside) return status;
  return cag_carrier_eval(&o->face->carrier, uv[0], uv[1], out, err);
}

static CagStatus try_foot(const CagFaceOutline *o, CagVec3 center, double u, double v, Foot *best,
                          CagError *err) {
  double uv[2] = {u, v};
  bool inside;
  CagCarrierPoint p;
  CagStatus status = point_inside(o, uv, &inside, &p, err);
  if (status || !inside) return status;
  const double distance = cag_norm(cag_sub(p.point, center));
  if (distance < best->distance) *best = (Foot){{uv[0], uv[1]}, distance};
  return CAG_OK;
}

// The directions across the axis along +-X, +-Y, and +-Z, for faces whose sides are equally far
// from their center. Nearest sides that have the same distance are taken in this order.
static CagStatus try_sides(const CagFaceOutline *o, CagVec3 center, double v, Foot *best,
                           CagError *err) {
  const CagTransform *frame = &o->face->carrier.frame;
  CagStatus status = CAG_OK;
  for (int k = 0; !status && k < 6 && best->distance == INFINITY; k++) {
    const CagVec3 side = cag_scaled(axis_of(k / 2), k % 2 ? -1 : 1);
    const double x = cag_dot(side, cag_frame_column(frame, 0));
    const double y = cag_dot(side, cag_frame_column(frame, 1));
    if (hypot(x, y) < 1e-6) continue;
    // Of a ball, the sides are points; of a surface about an axis, they are directions from it.
    const double z = cag_dot(side, cag_frame_column(frame, 2));
    const double to = isnan(v) ? atan2(z, hypot(x, y)) : v;
    status = try_foot(o, center, atan2(y, x), to, best, err);
  }
  return status;
}

static CagStatus analytic_foot(const CagFaceOutline *o, CagVec3 center, Foot *best, CagError *err) {
  const CagCarrier *c = &o->face->carrier;
  const double *d = o->face->domain, middle[2] = {(d[0] + d[1]) / 2, (d[2] + d[3]) / 2};
  const CagVec3 from = cag_sub(center, cag_frame_column(&c->frame, 3));
  const CagVec3 axis = cag_frame_column(&c->frame, 2);
  const double across = cag_norm(cag_cross(from, axis)), size = fabs(c->a) + fabs(c->b);
  double uv[2];
  cag_carrier_parameters(c, center, middle, uv);
  if (c->kind == CAG_CARRIER_SPHERE && cag_norm(from) <= CENTRAL * size)
    return try_sides(o, center, NAN, best, err);
  if (c->kind != CAG_CARRIER_SPHERE && across <= CENTRAL * (size + cag_norm(from)))
    return try_sides(o, center, uv[1], best, err);
  return try_foot(o, center, uv[0], uv[1], best, err);
}

// The best sample, refined by the method of Gauss and Newton.
static CagStatus sampled_foot(const CagFaceOutline *o, CagVec3 center, Foot *best, CagError *err) {
  const CagCarrier *c = &o->face->carrier;
  const double *box = o->box;
  CagStatus status = cag_stop_check(err);
  for (int i = 0; !status && i < SAMPLES * SAMPLES; i++)
    status = try_foot(o, center, box[0] + (box[1] - box[0]) * (i % SAMPLES + 0.5) / SAMPLES,
                      box[2] + (box[3] - box[2]) * (i / SAMPLES + 0.5) / SAMPLES, best, err);
  for (int k = 0; !status && best->distance < INFINITY && k < NEWTON_STEPS; k++) {
    CagCarrierPoint p;
    status = cag_carrier_eval(c, best->uv[0], best->uv[1], &p, err);
    if (status) break;
    const CagVec3 to = cag_sub(center, p.point);
    const double a = cag_dot(p.du, p.du), b = cag_dot(p.du, p.dv), d = cag_dot(p.dv, p.dv);
    const double x = cag_dot(to, p.du), y = cag_dot(to, p.dv), det = a * d - b * b;
    const double before = best->distance;
    if (!(det > 0)) break;
    status = try_foot(o, center, best->uv[0] + (d * x - b * y) / det,
                      best->uv[1] + (a * y - b * x) / det, best, err);
    if (!(best->distance < before)) break;
  }
  return status;
}

static CagStatus distance_along(const CagCurve *c, CagVec3 center, double t, double *out,
                                CagError *err) {
  CagVec3 p;
  CagStatus status = cag_curve_point(c, t, &p, err);
  if (!status) *out = cag_norm(cag_sub(p, center));
  return status;
}

// The point of an edge nearest to the center: the best of some samples, refined by golden sections
// between its neighbors. (The general function of curves is slow for the center of a circle.)
static CagStatus nearest_on_edge(const CagCurve *c, CagVec3 center, double *t, double *distance,
                                 CagError *err) {
  const double step = (c->end - c->start) / EDGE_SAMPLES;
  *distance = INFINITY;
  for (int i = 0; i <= EDGE_SAMPLES; i++) {
    const double at = i == EDGE_SAMPLES ? c->end : c->start + i * step;
    double d;
    CagStatus status = distance_along(c, center, at, &d, err);
    if (status) return status;
    if (d < *distance) *distance = d, *t = at;
  }
  double lo = fmax(*t - step, c->start), hi = fmin(*t + step, c->end);
  for (int k = 0; k < GOLDEN_STEPS; k++) {
    const double a = hi - (hi - lo) / GOLDEN, b = lo + (hi - lo) / GOLDEN;
    double da, db;
    CagStatus status = distance_along(c, center, a, &da, err);
    if (!status) status = distance_along(c, center, b, &db, err);
    if (status) return status;
    if (fmin(da, db) < *distance) *distance = fmin(da, db), *t = da < db ? a : b;
    if (da < db) hi = b;
    else lo = a;
  }
  return CAG_OK;
}

// The nearest points of the edges, if they are nearer than the best one.
static CagStatus edge_foot(const CagFaceOutline *o, CagVec3 center, Foot *best, CagError *err) {
  const CagBoundary *b = o->boundary;
  for (size_t l = o->face->first; l < o->face->first + o->face->count; l++)
    for (size_t i = b->loops[l].first; i < b->loops[l].first + b->loops[l].count; i++) {
      const CagCurve *curve = b->edges[b->uses[i].edge].curve;
      CagEdgePath path;
      Foot foot;
      double t = 0;
      if (!curve) continue;
      CagStatus status = nearest_on_edge(curve, center, &t, &foot.distance, err);
      if (status) return status;
      if (!(foot.distance < (1 - CENTRAL) * best->distance)) continue;
      status = cag_edge_path(b, o->face, &b->uses[i], &path, err);
      if (!status) status = cag_edge_path_eval(&path, t, foot.uv, NULL, err);
      if (status) return status;
      *best = foot;
    }
  return CAG_OK;
}

static CagStatus outward_at(const CagBoundaryFace *f, const double uv[2], CagVec3 *out,
                            CagError *err) {
  CagStatus status = cag_carrier_normal(&f->carrier, uv[0], uv[1], out, err);
  if (!status && f->reversed) *out = cag_scaled(*out, -1);
  return status;
}

static CagStatus normal_near(const CagFaceOutline *o, CagVec3 center, CagVec3 *out, CagError *err) {
  Foot best = {{0, 0}, INFINITY};
  const bool analytic = cag_carrier_is_analytic(&o->face->carrier);
  CagStatus status =
      analytic ? analytic_foot(o, center, &best, err) : sampled_foot(o, center, &best, err);
  if (!status && (!analytic || best.distance == INFINITY))
    status = edge_foot(o, center, &best, err);
  return status ? status : outward_at(o->face, best.uv, out, err);
}

// --- Bounds ---

static CagStatus add_inside(const CagFaceOutline *o, double u, double v, CagBounds *box,
                            CagError *err) {
  double uv[2] = {u, v};
  bool inside;
  CagCarrierPoint p;
  CagStatus status = point_inside(o, uv, &inside, &p, err);
  if (!status && inside) cag_bounds_add(box, p.point);
  return status;
}

// Where the normal of a ball or torus is along an axis of the world.
static CagStatus round_extremes(const CagFaceOutline *o, CagBounds *box, CagError *err) {
  const CagCarrier *c = &o->face->carrier;
  CagStatus status = CAG_OK;
  for (int k = 0; !status && k < 12; k++) {
    const CagVec3 to = cag_scaled(axis_of(k / 4), k % 2 ? -1 : 1);
    const double x = cag_dot(to, cag_frame_column(&c->frame, 0));
    const double y = cag_dot(to, cag_frame_column(&c->frame, 1));
    const double z = cag_dot(to, cag_frame_column(&c->frame, 2));
    // Of a torus also on the inner side, and opposite ones are those of the opposite direction.
    const bool inner = k / 2 % 2;
    if (inner && c->kind == CAG_CARRIER_SPHERE) continue;
    const double v = atan2(z, inner ? -hypot(x, y) : hypot(x, y));
    status = add_inside(o, inner ? atan2(-y, -x) : atan2(y, x), v, box, err);
  }
  return status;
}

// One side of the bounds, found from the highest sample along a direction.
typedef struct Peak {
  const CagFaceOutline *outline;
  int axis;
  double sign, uv[2], height;
} Peak;

static CagStatus peak_slopes(const Peak *p, double u, double v, double out[2], CagError *err) {
  CagCarrierPoint at;
  CagStatus status = cag_carrier_eval(&p->outline->face->carrier, u, v, &at, err);
  if (status) return status;
  out[0] = p->sign * coordinate(at.du, p->axis);
  out[1] = p->sign * coordinate(at.dv, p->axis);
  return CAG_OK;
}

// A step of Newton's method; false if there is no maximum nearby.
static CagStatus peak_step(const Peak *p, double step[2], bool *near, CagError *err) {
  const double *box = p->outline->box, u = p->uv[0], v = p->uv[1];
  const double hu = DIFFERENCE * (box[1] - box[0]), hv = DIFFERENCE * (box[3] - box[2]);
  double g[2], right[2], left[2], up[2], down[2];
  *near = false;
  CagStatus status = peak_slopes(p, u, v, g, err);
  if (!status) status = peak_slopes(p, u + hu, v, right, err);
  if (!status) status = peak_slopes(p, u - hu, v, left, err);
  if (!status) status = peak_slopes(p, u, v + hv, up, err);
  if (!status) status = peak_slopes(p, u, v - hv, down, err);
  if (status) return status;
  const double uu = (right[0] - left[0]) / (2 * hu), vv = (up[1] - down[1]) / (2 * hv);
  const double uv = ((right[1] - left[1]) / hu + (up[0] - down[0]) / hv) / 4;
  const double det = uu * vv - uv * uv;
  if (!(det > 0) || uu >= 0) return CAG_OK;
  step[0] = -(vv * g[0] - uv * g[1]) / det;
  step[1] = -(uu * g[1] - uv * g[0]) / det;
  *near = true;
  return CAG_OK;
}

static CagStatus climb(Peak *p, CagBounds *box, CagError *err) {
  const double *d = p->outline->box;
  for (int k = 0; k < NEWTON_STEPS; k++) {
    double step[2];
    bool near;
    CagStatus status = peak_step(p, step, &near, err);
    if (status || !near) return status;
    const double u = clamped(p->uv[0] + step[0], d[0], d[1]);
    const double v = clamped(p->uv[1] + step[1], d[2], d[3]);
    if (u == p->uv[0] && v == p->uv[1]) return CAG_OK;
    p->uv[0] = u, p->uv[1] = v;
    status = add_inside(p->outline, u, v, box, err);
    if (status) return status;
  }
  return CAG_OK;
}

static CagStatus sampled_extremes(const CagFaceOutline *o, CagBounds *box, CagError *err) {
  Peak peaks[6];
  const double *d = o->box;
  CagStatus status = cag_stop_check(err);
  for (int k = 0; k < 6; k++) peaks[k] = (Peak){o, k / 2, k % 2 ? -1 : 1, {0, 0}, -INFINITY};
  for (int i = 0; !status && i < SAMPLES * SAMPLES; i++) {
    double uv[2] = {d[0] + (d[1] - d[0]) * (i % SAMPLES + 0.5) / SAMPLES,
                    d[2] + (d[3] - d[2]) * (i / SAMPLES + 0.5) / SAMPLES};
    bool inside;
    CagCarrierPoint p;
    status = cag_face_outline_has(o, uv, &inside, err);
    if (!status && inside) status = cag_carrier_eval(&o->face->carrier, uv[0], uv[1], &p, err);
    if (status || !inside) continue;
    cag_bounds_add(box, p.point);
    for (int k = 0; k < 6; k++) {
      const double height = peaks[k].sign * coordinate(p.point, peaks[k].axis);
      if (!(height > peaks[k].height)) continue;
      peaks[k].height = height;
      peaks[k].uv[0] = uv[0], peaks[k].uv[1] = uv[1];
    }
  }
  for (int k = 0; !status && k < 6; k++)
    if (peaks[k].height > -INFINITY) status = climb(&peaks[k], box, err);
  return status;
}

// The straight lines of ruled carriers end at the edges, and so do their extremes.
static CagStatus face_bounds(const CagFaceOutline *o, const CagBounds *boxes, CagBounds *out,
                             CagError *err) {
  const CagBoundary *b = o->boundary;
  const CagCarrierKind kind = o->face->carrier.kind;
  *out = CAG_BOUNDS_EMPTY;
  for (size_t l = o->face->first; l < o->face->first + o->face->count; l++)
    for (size_t u = b->loops[l].first; u < b->loops[l].first + b->loops[l].count; u++) {
      cag_bounds_add(out, boxes[b->uses[u].edge].min);
      cag_bounds_add(out, boxes[b->uses[u].edge].max);
    }
  if (cag_carrier_is_ruled(&o->face->carrier)) return CAG_OK;
  return kind == CAG_CARRIER_SPHERE || kind == CAG_CARRIER_TORUS ? round_extremes(o, out, err)
                                                                 : sampled_extremes(o, out, err);
}

CagStatus cag_face_feature(const CagBoundary *b, size_t face, const CagBounds *boxes,
                           CagFaceFeature *out, CagError *err) {
  const CagBoundaryFace *f = &b->faces[face];
  const bool plane = f->carrier.kind == CAG_CARRIER_PLANE;
  CagFaceOutline outline = {.boundary = b, .face = f};
  *out = (CagFaceFeature){.kind = cag_carrier_name(&f->carrier)};
  CagStatus status = cag_boundary_face_area(b, face, &out->area, &out->center, err);
  if (!status && !plane) status = cag_face_outline(b, face, &outline, err);
  if (!status) status = face_bounds(&outline, boxes, &out->bounds, err);
  const double none[2] = {0, 0};
  if (!status)
    status = plane ? outward_at(f, none, &out->normal, err)
                   : normal_near(&outline, out->center, &out->normal, err);
  cag_face_outline_free(&outline);
  return status;
}

// --- The whole boundary ---

CagStatus cag_boundary_edge_boxes(const CagBoundary *b, CagBounds **out, CagError *err) {
  CagBounds *boxes = cag_calloc(b->edge_count + 1, sizeof *boxes);
  CagStatus status = boxes ? CAG_OK : cag_fail_memory(err);
  for (size_t e = 0; !status && e < b->edge_count; e++) {
    const CagBoundaryEdge *edge = &b->edges[e];
    status = cag_stop_check(err);
    if (!edge->curve) boxes[e] = (CagBounds){b->corners[edge->from], b->corners[edge->from]};
    else if (!status) status = cag_curve_bounds(edge->curve, &boxes[e], err);
  }
  if (status) cag_free(boxes);
  else *out = boxes;
  return status;
}

CagStatus cag_boundary_bounds(const CagBoundary *b, CagBounds *out, CagError *err) {
  CagBounds *boxes;
  CagBounds all = CAG_BOUNDS_EMPTY;
  if (b->mesh) {
    *out = cag_mesh_bounds(b->mesh);
    return CAG_OK;
  }
  CagStatus status = cag_boundary_edge_boxes(b, &boxes, err);
  if (status) return status;
  for (size_t f = 0; !status && f < b->face_count; f++) {
    CagFaceOutline outline = {.boundary = b, .face = &b->faces[f]};
    CagBounds box;
    if (!cag_carrier_is_ruled(&b->faces[f].carrier)) status = cag_face_outline(b, f, &outline, err);
    if (!status) status = face_bounds(&outline, boxes, &box, err);
    cag_face_outline_free(&outline);
    if (status) break;
    cag_bounds_add(&all, box.min);
    cag_bounds_add(&all, box.max);
  }
  cag_free(boxes);
  if (!status) *out = all;
  return status;
}
