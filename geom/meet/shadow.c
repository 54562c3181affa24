// Shadows by winding numbers. Each face is cut along its contour; the parts whose normals point to
// the light are bounded by contours and by pieces of the face's edges, all with the part on the
// left. In the plane, these walks run around a point once for each part above it. Edges between two
// such parts are walked in both directions, and so they do not count.

#include "geom/meet/shadow.h"

#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/region_arrange.h"
#include "geom/meet/section.h"
#include "geom/mesh/edges.h"
#include "geom/solid/build.h"
#include "geom/solid/csg.h"
#include "geom/surface/crease.h"
#include "geom/surface/nearest.h"
#include "geom/surface/reshape.h"
#include "geom/surface/trimmed.h"

// A contour that ends this close to an edge, as a fraction of the size, cuts it.
#define MEETS 1e-6
// How far inside of an edge the side of the face is looked up, as a fraction of the parameters.
#define INSIDE 1e-6
// Curves smaller than this, as a fraction of the size, are points in the plane.
#define POINT 1e-12
// A face is along the light if its normal has at most this part along it.
#define UPRIGHT 1e-9
// Where a piece of a curve is looked at, as fractions of its parameters.
static const double LOOKS[] = {0.3819, 0.1273, 0.8517};
enum { LOOK_COUNT = sizeof LOOKS / sizeof *LOOKS };

// A contour is looked at this many times for changes of its side.
enum { CONTOUR_STEPS = 37 };

typedef struct Shadow {
  CagTransform frame;
  CagVec3 light; // unit: the parts whose normals have a part along it are in front
  double tolerance, size;
  bool closed; // the faces bound a body, so parts at the back add nothing
  CagWalk *walks;
  size_t count, capacity;
} Shadow;

static CagVec3 column(const CagTransform *t, int j) {
  return cag_vec3(t->m[0][j], t->m[1][j], t->m[2][j]);
}

static void free_walks(Shadow *s) {
  for (size_t i = 0; i < s->count; i++) cag_curve_release((CagCurve *)s->walks[i].curve);
  cag_free(s->walks);
}

static CagStatus undecided(CagError *err) {
  return cag_fail(err, CAG_E_CONVERGENCE, CAG_ERR_region_undecided, "", -1,
                  "contours run so close to each other that rounding hides their order");
}

// Adds a curve in space. `sign`: 1 if the part in front (operand 0) or at the back (1) is on its
// left.
static CagStatus add_walk(Shadow *s, const CagCurve *c, int operand, int sign, CagError *err) {
  CagCurve *flat;
  CagBounds box;
  CagStatus status = cag_curve_flatten(c, &s->frame, &flat, err);
  if (status) return status;
  if (flat->dimension == 3) cag_curve_lay_flat(flat);
  status = cag_curve_bounds(flat, &box, err);
  const bool point = !status && cag_norm(cag_sub(box.max, box.min)) <= POINT * s->size;
  if (!status && !CAG_RESERVE(s->walks, s->capacity, s->count + 1)) status = cag_fail_memory(err);
  if (status || point) {
    cag_curve_release(flat);
    return status;
  }
  s->walks[s->count++] = (CagWalk){.curve = flat, .operand = operand, .sign = sign, .group = -1};
  return CAG_OK;
}

// How much the face is turned to the light at these parameters: 0 where it has no normal.
static double lit(const Shadow *s, const CagSurface *face, double u, double v) {
  CagVec3 normal;
  CagError none;
  if (cag_surface_normal(face, fmin(fmax(u, face->u0), face->u1), fmin(fmax(v, face->v0), face->v1),
                         &normal, &none))
    return 0;
  return cag_dot(normal, s->light);
}

// 1: in front, -1: at the back, 0: along the light.
static int side_of(double lit) { return lit > UPRIGHT ? 1 : lit < -UPRIGHT ? -1 : 0; }

// --- Contours ---

// How fast the normal turns to the light if the point of the face moves along a tangent vector; 0 if
// it is unknown.
static double turn_along(const CagVec3 *d, CagVec3 light, CagVec3 along) {
  const CagVec3 su = d[cag_partial(2, 1, 0)], sv = d[cag_partial(2, 0, 1)],
                suu = d[cag_partial(2, 2, 0)], suv = d[cag_partial(2, 1, 1)],
                svv = d[cag_partial(2, 0, 2)];
  const double e = cag_dot(su, su), f = cag_dot(su, sv), g = cag_dot(sv, sv), w = e * g - f * f;
  if (!(w > 0)) return 0;
  const double a = cag_dot(along, su), b = cag_dot(along, sv), du = (a * g - b * f) / w,
               dv = (b * e - a * f) / w;
  const CagVec3 by_u = cag_add(cag_cross(suu, sv), cag_cross(su, suv)),
                by_v = cag_add(cag_cross(suv, sv), cag_cross(su, svv));
  return du * cag_dot(by_u, light) + dv * cag_dot(by_v, light);
}

// 1: the part of the face in front is on the left of the contour, -1: on its right, 0: unknown.
static int contour_side(const Shadow *s, const CagSurface *face, const CagCurve *c, double t) {
  CagVec3 at_t[2], d[9];
  CagSurfaceNearest at;
  CagError none;
  if (cag_curve_eval(c, t, 1, CAG_SIDE_RIGHT, at_t, &none) ||
      cag_surface_closest(face, at_t[0], &at, &none) ||
      cag_surface_eval(face, at.u, at.v, 2, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, &none))
    return 0;
  const CagVec3 normal = cag_cross(d[cag_partial(2, 1, 0)], d[cag_partial(2, 0, 1)]);
  const double turn = turn_along(d, s->light, cag_cross(normal, at_t[1]));
  return turn > 0 ? 1 : turn < 0 ? -1 : 0;
}

// Whether a point of the face is on a side of its rectangle of parameters that is an edge.
static bool is_on_edge(const CagSurface *face, const CagSurfaceNearest *at) {
  if (cag_surface_trimmed_view(face, NULL, NULL)) return false;
  const double near_u = 1e-7 * (face->u1 - face->u0), near_v = 1e-7 * (face->v1 - face->v0);
  return (cag_solid_side_is_edge(face, 0) && at->u - face->u0 < near_u) ||
         (cag_solid_side_is_edge(face, 1) && face->u1 - at->u < near_u) ||
         (cag_solid_side_is_edge(face, 2) && at->v - face->v0 < near_v) ||
         (cag_solid_side_is_edge(face, 3) && face->v1 - at->v < near_v);
}

// Contours that cross exchange their sides at the crossing. Returns where this one does, between a
// and b, whose sides differ.
static double contour_change(const Shadow *s, const CagSurface *face, const CagCurve *c, double a,
                             double b) {
  const int side = contour_side(s, face, c, a);
  for (int i = 0; i < 60; i++) {
    const double middle = (a + b) / 2;
    if (contour_side(s, face, c, middle) == side) a = middle;
    else b = middle;
  }
  return (a + b) / 2;
}

// A part of a contour with one side.
static CagStatus add_contour_part(Shadow *s, const CagCurve *c, double a, double b, int side,
                                  CagError *err) {
  CagCurve *part = NULL;
  CagStatus status = CAG_OK;
  if (side == 0) return undecided(err);
  if (a > c->start || b < c->end) status = cag_curve_trim(c, a, b, &part, err);
  else part = cag_curve_retain(c);
  if (!status) status = add_walk(s, part, 0, side, err);
  if (!status && !s->closed) status = add_walk(s, part, 1, side, err);
  cag_curve_release(part);
  return status;
}

// Whether the contour runs along an edge. Edges are looked at on their own.
static CagStatus is_along_edge(const CagSurface *face, const CagCurve *c, bool *out,
                               CagError *err) {
  CagStatus status = CAG_OK;
  *out = true;
  for (int i = 0; !status && *out && i < LOOK_COUNT; i++) {
    CagSurfaceNearest at;
    CagVec3 p;
    status = cag_curve_point(c, c->start + LOOKS[i] * (c->end - c->start), &p, err);
    if (!status) status = cag_surface_closest(face, p, &at, err);
    *out = !status && is_on_edge(face, &at);
  }
  return status;
}

static CagStatus add_contour(Shadow *s, const CagSurface *face, const CagCurve *c, CagError *err) {
  bool edge;
  CagStatus status = is_along_edge(face, c, &edge, err);
  if (status || edge) return status;
  const double step = (c->end - c->start) / CONTOUR_STEPS;
  double from = c->start, last = from;
  int side = 0;
  for (int i = 0; !status && i < CONTOUR_STEPS; i++) {
    const double t = c->start + (i + 0.43) * step; // not in the middle, where an apex may be
    const int here = contour_side(s, face, c, t);
    if (here == 0) continue;
    if (side == 0) side = here;
    if (here != side) {
      const double change = contour_change(s, face, c, last, t);
      status = add_contour_part(s, c, from, change, side, err);
      from = change;
      side = here;
    }
    last = t;
  }
  return status ? status : add_contour_part(s, c, from, c->end, side, err);
}

// --- Edges ---

// An edge of a face: a curve in its parameter plane and in space, with equal parameters. `sense`: 1
// if the face is on the left of it.
typedef struct Edge {
  const CagSurface *face;
  const CagCurve *plane; // NULL: a side of the rectangle of parameters
  int side;              // of the rectangle: 0 to 3, as those of CagFaceEdge
  CagCurve *space;
  int sense;
} Edge;

// The side of the face next to the edge: 1 in front, -1 at the back, 0 neither.
static int side_near(const Shadow *s, const Edge *e, double t) {
  const CagSurface *f = e->face;
  const double wide = f->u1 - f->u0, high = f->v1 - f->v0;
  double u, v;
  if (e->plane) {
    CagVec3 d[2];
    CagError none;
    if (cag_curve_eval(e->plane, t, 1, CAG_SIDE_RIGHT, d, &none)) return 0;
    const CagVec3 along = cag_unit(cag_vec3(d[1].x / wide, d[1].y / high, 0));
    u = d[0].x - INSIDE * e->sense * along.y * wide;
    v = d[0].y + INSIDE * e->sense * along.x * high;
  } else {
    const double ends[] = {f->u0 + INSIDE * wide, f->u1 - INSIDE * wide, f->v0 + INSIDE * high,
                           f->v1 - INSIDE * high};
    u = e->side < 2 ? ends[e->side] : t;
    v = e->side < 2 ? t : ends[e->side];
  }
  return side_of(lit(s, f, u, v));
}

static CagStatus add_piece(Shadow *s, const Edge *e, double a, double b, CagError *err) {
  int side = 2;
  for (int i = 0; i < LOOK_COUNT; i++) {
    const int found = side_near(s, e, a + LOOKS[i] * (b - a));
    if (side != 2 && found != side) return undecided(err);
    side = found;
  }
  if (side == 0 || (side < 0 && s->closed)) return CAG_OK;
  CagCurve *part = cag_curve_retain(e->space);
  CagStatus status = CAG_OK;
  if (a > e->space->start || b < e->space->end) {
    cag_curve_release(part);
    status = cag_curve_trim(e->space, a, b, &part, err);
  }
  if (status) return status;
  status = add_walk(s, part, side > 0 ? 0 : 1, side * e->sense, err);
  cag_curve_release(part);
  return status;
}

// The ends of the contours that lie on the edge, ascending, as parameters of it.
static CagStatus edge_cuts(const Shadow *s, const Edge *e, const CagCurveList *contours,
                           double *cuts, size_t *n, CagError *err) {
  *n = 0;
  for (size_t i = 0; i < 2 * contours->count; i++) {
    const CagCurve *c = contours->items[i / 2];
    CagVec3 end, at;
    double t, distance;
    CagStatus status = cag_curve_point(c, i % 2 ? c->end : c->start, &end, err);
    if (!status) status = cag_curve_closest(e->space, end, &t, &at, &distance, err);
    if (status) return status;
    if (distance > MEETS * s->size) continue;
    size_t k = (*n)++;
    for (; k > 0 && cuts[k - 1] > t; k--) cuts[k] = cuts[k - 1];
    cuts[k] = t;
  }
  return CAG_OK;
}

static CagStatus add_edge(Shadow *s, const Edge *e, const CagCurveList *contours, CagError *err) {
  size_t n;
  double *cuts = cag_calloc(2 * contours->count + 1, sizeof *cuts);
  if (!cuts) return cag_fail_memory(err);
  CagStatus status = edge_cuts(s, e, contours, cuts, &n, err);
  double from = e->space->start;
  const double least = 1e-9 * (e->space->end - e->space->start);
  for (size_t i = 0; !status && i <= n; i++) {
    const double to = i < n ? cuts[i] : e->space->end;
    if (to - from > least) {
      status = add_piece(s, e, from, to, err);
      from = to;
    }
  }
  cag_free(cuts);
  return status;
}

// A side of a patch of a face, as a curve of the face, whose kind may be simpler.
static CagStatus side_curve(const CagSurface *face, const CagSurface *patch, int side,
                            CagCurve **out, CagError *err) {
  const double at[] = {patch->u0, patch->u1, patch->v0, patch->v1};
  const double from = side < 2 ? patch->v0 : patch->u0, to = side < 2 ? patch->v1 : patch->u1;
  CagCurve *whole;
  CagStatus status = cag_surface_isocurve(face, side < 2 ? 0 : 1, at[side], &whole, err);
  if (status) return status;
  if (whole->start == from && whole->end == to) *out = cag_curve_retain(whole);
  else status = cag_curve_trim(whole, from, to, out, err);
  cag_curve_release(whole);
  return status;
}

// The sides of the rectangle of parameters, as far as they are edges.
static CagStatus add_sides(Shadow *s, const CagSurface *face, const CagSurface *patch,
                           const CagCurveList *contours, CagError *err) {
  CagStatus status = CAG_OK;
  for (int side = 0; !status && side < 4; side++) {
    if (!cag_solid_side_is_edge(patch, side)) continue;
    Edge e = {.face = patch, .side = side, .sense = side == 0 || side == 3 ? -1 : 1};
    status = side_curve(face, patch, side, &e.space, err);
    if (status) break;
    status = add_edge(s, &e, contours, err);
    cag_curve_release(e.space);
  }
  return status;
}

static CagStatus add_loops(Shadow *s, const CagSurface *face, const CagRegion *region,
                           const CagCurveList *contours, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < region->count; i++) {
    Edge e = {.face = face, .plane = region->loops[i], .sense = 1};
    status = cag_trimmed_loop(face, i, &e.space, err);
    if (status) break;
    status = add_edge(s, &e, contours, err);
    cag_curve_release(e.space);
  }
  return status;
}

// --- Faces ---

// A flat face is in front, or at the back, as a whole.
static CagStatus add_flat(Shadow *s, const CagRegion *region, const CagTransform *frame,
                          CagError *err) {
  const CagVec3 normal = cag_unit(cag_cross(column(frame, 0), column(frame, 1)));
  const int side = side_of(cag_dot(normal, s->light));
  CagStatus status = CAG_OK;
  if (side == 0 || (side < 0 && s->closed)) return CAG_OK;
  for (size_t i = 0; !status && i < region->count; i++) {
    CagCurve *loop;
    status = cag_curve_transform(region->loops[i], frame, &loop, err);
    if (status) break;
    status = add_walk(s, loop, side > 0 ? 0 : 1, side, err);
    cag_curve_release(loop);
  }
  return status;
}

// A patch of a face, without creases; the whole face if that has none.
static CagStatus add_patch(Shadow *s, const CagSurface *face, const CagSurface *patch,
                           CagError *err) {
  const CagRegion *region;
  const CagSurface *inner;
  CagCurveList contours = {0};
  CagStatus status =
      cag_surface_contour(patch, s->light, cag_vec3(0, 0, 0), false, s->tolerance, &contours, err);
  for (size_t i = 0; !status && i < contours.count; i++)
    status = add_contour(s, patch, contours.items[i], err);
  if (!status)
    status = cag_surface_trimmed_view(patch, &inner, &region)
                 ? add_loops(s, patch, region, &contours, err)
                 : add_sides(s, face, patch, &contours, err);
  cag_curve_list_free(&contours);
  return status ? status : cag_stop_check(err);
}

// Each patch between creases is a face of its own, since contours jump there.
static CagStatus add_face(Shadow *s, const CagSurface *face, CagError *err) {
  const CagRegion *region;
  CagTransform frame;
  CagPatches p;
  if (cag_surface_planar_view(face, &region, &frame)) return add_flat(s, region, &frame, err);
  if (cag_surface_trimmed_view(face, NULL, NULL)) return add_patch(s, face, face, err);
  CagStatus status = cag_patches_open(face, &p, err);
  if (status) return status;
  const size_t n = p.n[0] * p.n[1];
  for (size_t i = 0; !status && i < n; i++) {
    const size_t u = i / p.n[1], v = i % p.n[1];
    CagSurface *patch = NULL;
    if (n == 1) patch = cag_surface_retain(face);
    else
      status = cag_surface_part(face, p.ends[0][u], p.ends[0][u + 1], p.ends[1][v],
                                p.ends[1][v + 1], &patch, err);
    if (!status) status = add_patch(s, face, patch, err);
    cag_surface_release(patch);
  }
  cag_patches_free(&p);
  return status;
}

static bool is_shadow(const int winding[2], int unused) {
  (void)unused;
  return winding[0] != 0 || winding[1] != 0;
}

// Makes the region of the walks.
static CagStatus shadow_of_walks(const Shadow *s, CagRegion **out, CagError *err) {
  *out = NULL;
  CagStatus status =
      s->count ? cag_region_arrange(s->walks, s->count, is_shadow, 0, 0, out, err) : CAG_OK;
  return status || *out ? status : cag_region_empty(out, err);
}

static Shadow shadow_begin(const CagTransform *frame, const CagBounds *box, double tolerance,
                           bool closed) {
  return (Shadow){.frame = *frame,
                  .light = column(frame, 2),
                  .tolerance = tolerance,
                  .size = cag_norm(cag_sub(box->max, box->min)),
                  .closed = closed};
}

static CagStatus faces_shadow(CagSurface *const *faces, size_t n, const CagBounds *box,
                              const CagTransform *frame, double tolerance, bool closed,
                              CagRegion **out, CagError *err) {
  Shadow s = shadow_begin(frame, box, tolerance, closed);
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < n; i++) status = add_face(&s, faces[i], err);
  if (!status) status = shadow_of_walks(&s, out, err);
  free_walks(&s);
  return status;
}

CagStatus cag_surface_shadow(const CagSurface *s, const CagTransform *frame, double tolerance,
                             CagRegion **out, CagError *err) {
  CagBounds box;
  CagStatus status = cag_surface_bounds(s, &box, err);
  if (status) return status;
  CagSurface *const faces[] = {(CagSurface *)s};
  return faces_shadow(faces, 1, &box, frame, tolerance, cag_surface_is_closed(s), out, err);
}

// --- Meshes ---

// The side of a triangle in the frame: 1 in front, -1 at the back, 0 along the light.
static int triangle_side(const CagMesh *m, const CagVec3 *flat, size_t t) {
  const uint32_t *corner = m->triangles + 3 * t;
  const CagVec3 a = flat[corner[0]], ab = cag_sub(flat[corner[1]], a),
                ac = cag_sub(flat[corner[2]], a);
  const double twice = ab.x * ac.y - ab.y * ac.x;
  return twice > 0 ? 1 : twice < 0 ? -1 : 0;
}

// Adds the edges along which the triangles of one side end.
static CagStatus add_mesh_edges(Shadow *s, const CagMesh *m, const CagVec3 *flat,
                                const CagMeshEdge *edges, size_t n, int side, CagError *err) {
  for (size_t i = 0, end; i < n; i = end) {
    int net = 0; // uses from low to high, minus those from high to low
    for (end = i; end < n && edges[end].low == edges[i].low && edges[end].high == edges[i].high;
         end++)
      if (triangle_side(m, flat, cag_mesh_edge_triangle(&edges[end])) == side)
        net += cag_mesh_edge_forward(&edges[end]) ? 1 : -1;
    if (net == 0) continue;
    const size_t t = cag_mesh_edge_triangle(&edges[i]);
    const unsigned k = cag_mesh_edge_corner(&edges[i]);
    CagVec3 p = flat[m->triangles[3 * t + k]], q = flat[m->triangles[3 * t + (k + 1) % 3]];
    if (p.x == q.x && p.y == q.y) continue;
    if (!cag_mesh_edge_forward(&edges[i])) net = -net;
    CagCurve *line = NULL;
    CagStatus status = cag_curve_line(p, q, 2, &line, err);
    // An edge of several sheets is walked once for each.
    for (int w = 0; !status && w < abs(net); w++) {
      if (!CAG_RESERVE(s->walks, s->capacity, s->count + 1)) status = cag_fail_memory(err);
      else
        s->walks[s->count++] = (CagWalk){.curve = cag_curve_retain(line),
                                         .operand = side > 0 ? 0 : 1,
                                         .sign = net > 0 ? side : -side,
                                         .group = -1};
    }
    cag_curve_release(line);
    if (status) return status;
  }
  return CAG_OK;
}

// Whether each edge is used as often in one direction as in the other.
static bool is_closed_mesh(const CagMeshEdge *edges, size_t n) {
  for (size_t i = 0, end; i < n; i = end) {
    int net = 0;
    for (end = i; end < n && edges[end].low == edges[i].low && edges[end].high == edges[i].high;
         end++)
      net += cag_mesh_edge_forward(&edges[end]) ? 1 : -1;
    if (net != 0) return false;
  }
  return true;
}

CagStatus cag_mesh_shadow(const CagMesh *m, const CagTransform *frame, CagRegion **out,
                          CagError *err) {
  CagTransform to_frame;
  CagBounds box = CAG_BOUNDS_EMPTY;
  size_t n = 0;
  CagStatus status = cag_transform_inverse(frame, &to_frame, err);
  if (status) return status;
  CagVec3 *flat = cag_calloc(m->vertex_count + 1, sizeof *flat);
  CagMeshEdge *edges =
      cag_mesh_edges(m->triangles, m->triangle_count, m->weld, m->vertex_count, &n);
  for (size_t i = 0; flat && i < m->vertex_count; i++) {
    flat[i] = cag_transform_point(&to_frame, m->positions[i]);
    flat[i].z = 0;
    cag_bounds_add(&box, flat[i]);
  }
  Shadow s = shadow_begin(frame, &box, 0, false);
  status = flat && edges ? cag_stop_check(err) : cag_fail_memory(err);
  if (!status) status = add_mesh_edges(&s, m, flat, edges, n, 1, err);
  if (!status && !is_closed_mesh(edges, n)) status = add_mesh_edges(&s, m, flat, edges, n, -1, err);
  if (!status) status = shadow_of_walks(&s, out, err);
  free_walks(&s);
  cag_free(edges);
  cag_free(flat);
  return status;
}

// --- Solids ---

typedef struct SolidShadow {
  CagTransform frame;
  double tolerance;
  const CagTessellation *how;
} SolidShadow;

static CagStatus solid_shadow(const SolidShadow *c, const CagSolid *s, CagRegion **out,
                              CagError *err);

static CagStatus tessellated_shadow(const SolidShadow *c, const CagSolid *s, CagRegion **out,
                                    CagError *err) {
  CagMesh *mesh = NULL;
  CagStatus status = cag_solid_tessellate(s, c->how, &mesh, err);
  if (!status) status = cag_mesh_shadow(mesh, &c->frame, out, err);
  cag_mesh_release(mesh);
  return status;
}

static CagStatus union_shadow(const SolidShadow *c, const CagSolid *s, CagRegion **out,
                              CagError *err) {
  const size_t n = s->core->count;
  if (n == 0) return cag_region_empty(out, err);
  CagRegion **parts = cag_calloc(n, sizeof *parts);
  if (!parts) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < n; i++) {
    CagSolid *placed = NULL;
    status = cag_solid_transform(s->core->operands[i], &s->placement, &placed, err);
    if (!status) status = solid_shadow(c, placed, &parts[i], err);
    cag_solid_release(placed);
  }
  if (!status)
    status = cag_region_combine(CAG_REGION_UNION, (const CagRegion *const *)parts, n, out, err);
  for (size_t i = 0; i < n; i++) cag_region_release(parts[i]);
  cag_free(parts);
  return status;
}

static CagStatus solid_shadow(const SolidShadow *c, const CagSolid *s, CagRegion **out,
                              CagError *err) {
  CagBounds box;
  CagError none;
  if (s->kind == CAG_SOLID_UNION) return union_shadow(c, s, out, err);
  if (s->face_count > 0 && !cag_solid_bounds(s, &box, &none) &&
      !faces_shadow(s->faces, s->face_count, &box, &c->frame, c->tolerance, true, out, &none))
    return CAG_OK;
  CagStatus status = cag_stop_check(err);
  return status ? status : tessellated_shadow(c, s, out, err);
}

CagStatus cag_solid_shadow(const CagSolid *s, const CagTransform *frame, double tolerance,
                           const CagTessellation *how, CagRegion **out, CagError *err) {
  const SolidShadow c = {.frame = *frame, .tolerance = tolerance, .how = how};
  return solid_shadow(&c, s, out, err);
}
