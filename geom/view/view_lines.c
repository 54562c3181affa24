// The lines of exact solids and of faces. Whether faces meet smoothly is decided by the normals of
// all faces at some points of the edge.

#include "geom/view/view_lines.h"

#include <math.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/boundary/features.h"
#include "geom/boundary/moved.h"
#include "geom/curve/family.h"
#include "geom/meet/section.h"
#include "geom/meet/section_edges.h"
#include "geom/solid/csg.h"
#include "geom/solid/exact.h"
#include "geom/surface/nearest.h"
#include "geom/surface/trimmed.h"

// Faces meet smoothly if the sine of the angle between their normals is less.
#define SMOOTH 1e-3
// A face is parallel to the direction where its unit normal has at most this part along it.
#define UPRIGHT 1e-6
// A face whose distance is at most this fraction of the size has the point.
#define TOUCHES 1e-7
// The tolerance of contours, as a fraction of the size.
#define CONTOUR 2e-7
// A parameter this close to a break, as a fraction of the domain, is on it.
#define ON_BREAK 1e-7
// A curve is an arc if at this many points the center is the same, to this fraction of the radius.
enum { ARC_LOOKS = 7 };
#define ARC_SAME 1e-11
// Where an edge is looked at, as fractions of its parameters.
static const double LOOKS[] = {0.4819, 0.1873, 0.8217};
enum { LOOK_COUNT = sizeof LOOKS / sizeof *LOOKS };

void cag_view_lines_free(CagViewLines *l) {
  for (size_t i = 0; i < l->count; i++) cag_curve_release(l->items[i].curve);
  cag_free(l->items);
  l->items = NULL;
  l->count = l->capacity = 0;
}

CagStatus cag_view_lines_add(CagViewLines *l, CagCurve *c, const CagSurface *fold, size_t body,
                             CagError *err) {
  if (!CAG_RESERVE(l->items, l->capacity, l->count + 1)) {
    cag_curve_release(c);
    return cag_fail_memory(err);
  }
  l->items[l->count++] = (CagViewLine){c, fold, body};
  return CAG_OK;
}

// The faces of a body.
typedef struct Faces {
  CagViewLines *lines;
  CagSurface *const *items;
  CagBounds *boxes;
  size_t count, body;
  bool closed; // they bound a solid
} Faces;

static CagStatus faces_open(CagViewLines *l, CagSurface *const *items, size_t n, size_t body,
                            bool closed, Faces *out, CagError *err) {
  *out = (Faces){l, items, cag_calloc(n + 1, sizeof *out->boxes), n, body, closed};
  CagStatus status = out->boxes ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++)
    status = cag_surface_bounds(items[i], &out->boxes[i], err);
  if (status) cag_free(out->boxes);
  return status;
}

// --- Normals ---

// What the normals of the faces at a point tell.
typedef struct Normals {
  CagVec3 first; // zero: none is known
  bool sharp;    // another one differs from it
  bool upright;  // all are perpendicular to the direction
  size_t faces;
} Normals;

static bool box_has(const CagBounds *b, CagVec3 p, double slack) {
  return p.x >= b->min.x - slack && p.x <= b->max.x + slack && p.y >= b->min.y - slack &&
         p.y <= b->max.y + slack && p.z >= b->min.z - slack && p.z <= b->max.z + slack;
}

// A parameter, moved to a break that it is close to, and the one at the other side of a seam there.
static CagStatus on_break(const CagSurface *s, int direction, double x, double out[2],
                          CagError *err) {
  double *cuts;
  size_t n;
  CagStatus status = cag_surface_cuts(s, direction, &cuts, &n, err);
  if (status) return status;
  const double near = ON_BREAK * (cuts[n] - cuts[0]);
  for (size_t i = 0; i <= n; i++)
    if (fabs(x - cuts[i]) <= near) x = cuts[i];
  out[0] = out[1] = x;
  if (direction ? s->closed_v : s->closed_u)
    out[1] = x == cuts[0] ? cuts[n] : x == cuts[n] ? cuts[0] : x;
  cag_free(cuts);
  return CAG_OK;
}

static void normals_add(const CagViewLines *l, CagVec3 normal, Normals *out) {
  if (cag_norm(normal) == 0) return;
  if (cag_norm(out->first) == 0) out->first = normal;
  if (cag_norm(cag_sub(normal, out->first)) > SMOOTH) out->sharp = true;
  if (fabs(cag_dot(normal, l->direction)) > UPRIGHT) out->upright = false;
}

// Adds the normals on all sides of the breaks and seams through the point of a face.
static CagStatus face_normals(const Faces *f, const CagSurface *s, const CagSurfaceNearest *at,
                              Normals *out, CagError *err) {
  const CagSurface *whole = s;
  cag_surface_trimmed_view(s, &whole, NULL);
  double u[2], v[2];
  CagStatus status = on_break(whole, 0, at->u, u, err);
  if (!status) status = on_break(whole, 1, at->v, v, err);
  for (int k = 0; !status && k < 16; k++) {
    CagVec3 d[4];
    if ((k & 4 && u[1] == u[0]) || (k & 8 && v[1] == v[0])) continue;
    status = cag_surface_eval(whole, u[k >> 2 & 1], v[k >> 3 & 1], 1,
                              k & 1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT,
                              k & 2 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, d, err);
    if (!status)
      normals_add(f->lines, cag_unit(cag_cross(d[cag_partial(1, 1, 0)], d[cag_partial(1, 0, 1)])),
                  out);
  }
  return status;
}

static CagStatus normals_at(const Faces *f, CagVec3 p, Normals *out, CagError *err) {
  const double near = TOUCHES * f->lines->size;
  CagStatus status = CAG_OK;
  *out = (Normals){.upright = true};
  for (size_t i = 0; !status && i < f->count; i++) {
    CagSurfaceNearest at;
    if (!box_has(&f->boxes[i], p, near)) continue;
    status = cag_surface_closest(f->items[i], p, &at, err);
    if (status || at.distance > near) continue;
    out->faces++;
    status = face_normals(f, f->items[i], &at, out, err);
  }
  return status;
}

// --- Edges of faces ---

// Whether a curve that is an edge of a face is shown: see view_lines.h.
static CagStatus edge_is_shown(const Faces *f, const CagCurve *c, bool *out, CagError *err) {
  bool upright = true;
  CagStatus status = CAG_OK;
  *out = false;
  for (int i = 0; !status && !*out && i < LOOK_COUNT; i++) {
    CagVec3 p;
    Normals n;
    status = cag_curve_point(c, c->start + LOOKS[i] * (c->end - c->start), &p, err);
    if (!status) status = normals_at(f, p, &n, err);
    if (status) break;
    *out = n.sharp || (n.faces < 2 && !f->closed);
    upright = upright && n.upright;
  }
  *out = *out || upright;
  return status;
}

// Whether a curve has a corner at its break t.
static CagStatus has_corner(const CagCurve *c, double t, bool *out, CagError *err) {
  CagVec3 left[2], right[2];
  CagStatus status = cag_curve_eval(c, t, 1, CAG_SIDE_LEFT, left, err);
  if (!status) status = cag_curve_eval(c, t, 1, CAG_SIDE_RIGHT, right, err);
  if (!status) *out = cag_norm(cag_sub(cag_unit(left[1]), cag_unit(right[1]))) > SMOOTH;
  return status;
}

// Whether the breaks of a curve are those between its pieces: composite curves, and polylines.
static bool has_pieces(const CagCurve *c) {
  const CagVec3 *vertices;
  double a, b, rate;
  size_t n;
  bool closed;
  return cag_curve_vertices(c, &vertices, &n, &closed) ||
         cag_curve_composite_piece(c, c->start, c->start, &a, &b, &rate);
}

// The arc of a curve whose parameter is the angle of a circle or ellipse: C + C'' is its center.
// Returns false for other curves.
static bool as_arc(const CagCurve *c, CagCurve **out) {
  CagVec3 d[3], center = {0, 0, 0}, x = {0, 0, 0}, y = {0, 0, 0};
  CagError none;
  if (!c->angular) return false;
  for (int i = 0; i < ARC_LOOKS; i++) {
    const double t = c->start + (c->end - c->start) * i / (ARC_LOOKS - 1);
    if (cag_curve_eval(c, t, 2, i + 1 < ARC_LOOKS ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT, d, &none))
      return false;
    const CagVec3 middle = cag_add(d[0], d[2]), away = cag_sub(d[0], middle);
    const double same = ARC_SAME * (cag_norm(away) + cag_norm(d[1]));
    if (i > 0 && cag_norm(cag_sub(middle, center)) > same + ARC_SAME * cag_norm(center))
      return false;
    center = middle;
    x = cag_sub(cag_scaled(away, cos(t)), cag_scaled(d[1], sin(t)));
    y = cag_add(cag_scaled(away, sin(t)), cag_scaled(d[1], cos(t)));
  }
  const CagVec3 z = cag_unit(cag_cross(x, y)), columns[4] = {x, y, z, center};
  CagTransform frame = cag_transform_identity();
  for (int j = 0; j < 4; j++) {
    frame.m[0][j] = columns[j].x;
    frame.m[1][j] = columns[j].y;
    frame.m[2][j] = columns[j].z;
  }
  frame.planar = false;
  return cag_norm(z) > 0 && !cag_curve_arc(1, 1, c->start, c->end, &frame, out, &none);
}

// Replaces a curve of a surface by one of a simpler kind with the same points, if there is one.
static void simplify(CagCurve **c) {
  CagCurve *simple = NULL;
  CagNurbsView view;
  CagError none;
  double a, b;
  CagTransform frame;
  if (cag_curve_arc_view(*c, &a, &b, &frame) || cag_curve_nurbs_view(*c, &view)) return;
  if (!as_arc(*c, &simple) && cag_curve_to_nurbs(*c, &simple, &none)) return;
  cag_curve_release(*c);
  *c = simple;
}

static CagStatus add_edge(Faces *f, CagCurve *c, const CagSurface *unused, CagError *err) {
  bool shown;
  (void)unused;
  CagStatus status = edge_is_shown(f, c, &shown, err);
  if (!status && shown) {
    simplify(&c);
    return cag_view_lines_add(f->lines, c, NULL, f->body, err);
  }
  cag_curve_release(c);
  return status;
}

// Takes over a piece of a line.
typedef CagStatus AddPiece(Faces *f, CagCurve *c, const CagSurface *fold, CagError *err);

// Adds the parts of a curve between its corners, or its pieces.
static CagStatus add_pieces(Faces *f, const CagCurve *c, bool pieces, const CagSurface *fold,
                            AddPiece *add, CagError *err) {
  double *cuts;
  size_t n;
  CagStatus status = cag_curve_cuts(c, &cuts, &n, err);
  if (status) return status;
  double from = c->start;
  for (size_t i = 1; !status && i < n; i++) {
    CagCurve *piece = NULL;
    bool ends = true;
    if (i + 1 < n && !pieces) status = has_corner(c, cuts[i], &ends, err);
    if (status || !ends) continue;
    if (from == c->start && i + 1 == n) piece = cag_curve_retain(c);
    else status = cag_curve_trim(c, from, cuts[i], &piece, err);
    if (!status) status = add(f, piece, fold, err);
    from = cuts[i];
  }
  cag_free(cuts);
  return status ? status : cag_stop_check(err);
}

static CagStatus add_edges(Faces *f, CagError *err) {
  CagCurveList edges = {0};
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < f->count; i++)
    status = cag_surface_lines(f->items[i], &edges, err);
  for (size_t i = 0; !status && i < edges.count; i++)
    status = add_pieces(f, edges.items[i], has_pieces(edges.items[i]), NULL, add_edge, err);
  cag_curve_list_free(&edges);
  return status;
}

// --- Contours ---

static CagStatus add_contour(Faces *f, CagCurve *c, const CagSurface *fold, CagError *err) {
  return cag_view_lines_add(f->lines, c, fold, f->body, err);
}

static CagStatus add_contours(Faces *f, CagError *err) {
  const CagVec3 none = {0, 0, 0};
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < f->count; i++) {
    CagCurveList list = {0};
    const CagSurface *s = f->items[i];
    if (cag_surface_planar_view(s, NULL, NULL)) continue;
    status = cag_surface_contour(s, f->lines->direction, none, false, CONTOUR * f->lines->size,
                                 &list, err);
    for (size_t k = 0; !status && k < list.count; k++)
      status = add_pieces(f, list.items[k], false, f->closed ? s : NULL, add_contour, err);
    cag_curve_list_free(&list);
    if (!status) status = cag_stop_check(err);
  }
  return status;
}

// --- Exact solids ---

// Whether the faces of a smooth edge are parallel to the direction all along it.
static CagStatus is_outline(const CagViewLines *l, const CagSurface *face, const CagCurve *c,
                            bool *out, CagError *err) {
  CagStatus status = CAG_OK;
  *out = true;
  for (int i = 0; !status && *out && i < LOOK_COUNT; i++) {
    CagVec3 p, normal;
    CagSurfaceNearest at;
    status = cag_curve_point(c, c->start + LOOKS[i] * (c->end - c->start), &p, err);
    if (!status) status = cag_surface_closest(face, p, &at, err);
    if (!status) status = cag_surface_normal(face, at.u, at.v, &normal, err);
    if (!status) *out = fabs(cag_dot(normal, l->direction)) <= UPRIGHT;
  }
  return status;
}

// Adds the edges of a part, whose faces are given as surfaces.
static CagStatus add_part(CagViewLines *l, const CagBoundary *part, CagSurface *const *faces,
                          size_t body, CagError *err) {
  CagFeatures features;
  CagStatus status = cag_boundary_features(part, &features, err);
  if (status) return status;
  for (size_t i = 0; !status && i < features.edge_count; i++) {
    const CagEdgeFeature *e = &features.edges[i];
    const CagCurve *c = part->edges[e->edge].curve;
    bool shown = e->bend != CAG_EDGE_SMOOTH;
    if (!shown && e->count > 0)
      status = is_outline(l, faces[features.edge_faces[e->first]], c, &shown, err);
    if (!status && shown) status = cag_view_lines_add(l, cag_curve_retain(c), NULL, body, err);
    if (!status) status = cag_stop_check(err);
  }
  cag_features_free(&features);
  return status;
}

static CagStatus add_exact(CagViewLines *l, const CagSolid *s, size_t body, CagError *err) {
  size_t n = 0, face = 0;
  const CagBoundary *own = cag_solid_boundaries(s, &n);
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < n; i++) {
    CagBoundary part;
    status = cag_boundary_moved(&own[i], &s->placement, &part, err);
    if (status) break;
    status = add_part(l, &part, s->faces + face, body, err);
    face += part.face_count;
    cag_boundary_free(&part);
  }
  return status;
}

// --- Bodies ---

static CagStatus add_faces(CagViewLines *l, CagSurface *const *faces, size_t n, size_t body,
                           const CagSolid *solid, CagError *err) {
  Faces f;
  double scale;
  CagStatus status = faces_open(l, faces, n, body, solid, &f, err);
  if (status) return status;
  if (solid && solid->kind == CAG_SOLID_EXACT &&
      cag_transform_is_similarity(&solid->placement, &scale))
    status = add_exact(l, solid, body, err);
  else status = add_edges(&f, err);
  if (!status) status = add_contours(&f, err);
  cag_free(f.boxes);
  return status;
}

CagStatus cag_view_lines_of(CagViewLines *l, const CagViewBody *body, size_t index, CagError *err) {
  const CagSolid *s = body->solid;
  CagCurve *space = NULL;
  if (s && s->face_count > 0) return add_faces(l, s->faces, s->face_count, index, s, err);
  if (s && s->kind == CAG_SOLID_MESH) {
    CagMesh *moved = NULL;
    CagStatus status = cag_mesh_transform(s->core->mesh, &s->placement, &moved, err);
    if (!status) status = cag_view_lines_of_mesh(l, moved, index, err);
    cag_mesh_release(moved);
    return status;
  }
  if (body->surface) {
    CagSurface *const faces[] = {(CagSurface *)body->surface};
    return add_faces(l, faces, 1, index, NULL, err);
  }
  if (body->mesh) return cag_view_lines_of_mesh(l, body->mesh, index, err);
  if (!body->curve) return CAG_OK;
  CagStatus status = cag_curve_to_space(body->curve, &space, err);
  return status ? status : cag_view_lines_add(l, space, NULL, index, err);
}
