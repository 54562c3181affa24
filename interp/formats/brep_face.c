// Divides surfaces and regions into smooth faces with their sides.

#include <math.h>
#include <stdint.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/curve/approximate.h"
#include "geom/curve/family.h"
#include "geom/curve/nurbs_ops.h"
#include "geom/meet/quadric_arc.h"
#include "geom/surface/reshape.h"
#include "geom/surface/trimmed.h"
#include "interp/formats/brep_build.h"

// Corners of a patch count as coplanar up to this fraction of its size, which allows for rounding
// of its control points.
#define FLAT 1e-12
// The margin of a flat face's rectangle around its outline, as a fraction of its size.
#define MARGIN 1e-3

static size_t power_of_two(size_t least) {
  size_t n = 16;
  while (n < least) n *= 2;
  return n;
}

bool cag_brep_reserve(void **array, size_t count, size_t more, size_t size) {
  if (*array && count + more <= power_of_two(count)) return true;
  void *grown = cag_realloc(*array, power_of_two(count + more) * size);
  if (grown) *array = grown;
  return grown != NULL;
}

static CagStatus add_face(CagBrepWork *w, const CagBrepFace *face, size_t *index, CagError *err) {
  CagBrep *b = w->brep;
  if (!cag_brep_reserve((void **)&b->faces, b->face_count, 1, sizeof *b->faces))
    return cag_fail_memory(err);
  *index = b->face_count;
  b->faces[b->face_count++] = *face;
  return CAG_OK;
}

static CagStatus add_loop(CagBrepWork *w, size_t face, size_t *index, CagError *err) {
  CagBrep *b = w->brep;
  if (!cag_brep_reserve((void **)&b->loops, b->loop_count, 1, sizeof *b->loops))
    return cag_fail_memory(err);
  *index = b->loop_count;
  b->loops[b->loop_count++] = (CagBrepLoop){0, 0};
  b->faces[face].count++;
  return CAG_OK;
}

// Takes over the reference to the curve.
static CagStatus add_side(CagBrepWork *w, CagCurve *curve, bool reversed, size_t face, size_t loop,
                          size_t order, CagError *err) {
  if (!CAG_RESERVE(w->sides, w->side_room, w->side_count + 1)) {
    cag_curve_release(curve);
    return cag_fail_memory(err);
  }
  w->sides[w->side_count++] = (CagBrepSide){.curve = curve,
                                            .reversed = reversed,
                                            .face = face,
                                            .loop = loop,
                                            .order = order,
                                            .edge = SIZE_MAX};
  return CAG_OK;
}

// --- Flat pieces ---

static CagTransform plane_frame(CagVec3 origin, CagVec3 x, CagVec3 normal) {
  CagVec3 z = cag_unit(normal);
  x = cag_unit(cag_madd(x, -cag_dot(x, z), z));
  CagVec3 y = cag_cross(z, x);
  return (CagTransform){.m = {{x.x, y.x, z.x, origin.x},
                              {x.y, y.y, z.y, origin.y},
                              {x.z, y.z, z.z, origin.z},
                              {0, 0, 0, 1}}};
}

// Tests for a bilinear patch whose corners form a convex plane quadrilateral or triangle.
static bool is_flat_patch(const CagSurface *s, CagTransform *plane) {
  CagSurfaceNurbsView v;
  if (!cag_surface_nurbs_view(s, &v) || v.rational || v.degree_u != 1 || v.degree_v != 1 ||
      v.nu != 2 || v.nv != 2)
    return false;
  CagVec3 p[4]; // in order around the patch
  const int around[4] = {0, 2, 3, 1};
  for (int k = 0; k < 4; k++) {
    const double *h = v.homogeneous + 4 * around[k];
    p[k] = cag_vec3(h[0], h[1], h[2]);
  }
  CagVec3 a = cag_sub(p[2], p[0]), b = cag_sub(p[3], p[1]), normal = cag_cross(a, b);
  double size = fmax(cag_norm(a), cag_norm(b));
  if (!(cag_norm(normal) > FLAT * size * size)) return false;
  normal = cag_unit(normal);
  CagVec3 longest = {0, 0, 0};
  for (int k = 0; k < 4; k++) {
    CagVec3 edge = cag_sub(p[(k + 1) % 4], p[k]), next = cag_sub(p[(k + 2) % 4], p[(k + 1) % 4]);
    if (fabs(cag_dot(cag_sub(p[k], p[0]), normal)) > FLAT * size) return false;
    if (cag_dot(cag_cross(edge, next), normal) < -FLAT * size * size) return false;
    if (cag_norm(edge) > cag_norm(longest)) longest = edge;
  }
  *plane = plane_frame(p[0], longest, normal);
  return true;
}

// --- Pieces of surfaces ---

// Adds the sides in the order of the loop: v0 forward, u1 forward, v1 backward, u0 backward.
static CagStatus add_piece_sides(CagBrepWork *w, const CagSurface *s, size_t face, CagError *err) {
  static const int SIDE[4] = {2, 1, 3, 0};
  const bool pole[4] = {s->pole_u0, s->pole_u1, s->pole_v0, s->pole_v1};
  size_t loop;
  CagStatus status = add_loop(w, face, &loop, err);
  for (size_t k = 0; !status && k < 4; k++) {
    if (pole[SIDE[k]]) continue;
    CagCurve *c;
    status = cag_brep_side_curve(s, SIDE[k], &c, err);
    if (!status) status = add_side(w, c, k >= 2, face, loop, k, err);
  }
  return status;
}

// --- Trimmed pieces ---

// The boundary of a trimmed surface is usually not a NURBS curve. It is approximated within this
// fraction of its size, a hundredth of the tolerance for edges that meet. It is exact only if a box
// cut a quadric.
#define TRIM_NEAR 1e-8

static CagStatus add_trim_sides(CagBrepWork *w, const CagSurface *s, const CagCurve *loop,
                                size_t face, CagError *err);

// Adds the whole surface with the loops in space. The parameters need not agree with those of the
// NURBS.
static CagStatus add_trimmed(CagBrepWork *w, const CagSurface *s, const CagSurface *inner,
                             const CagRegion *region, size_t outer, size_t source, CagError *err) {
  CagBrepFace face = {.first = w->brep->loop_count, .source = source};
  CagStatus status = cag_brep_surface(w, inner, &face.surface, err);
  size_t index = 0;
  if (!status) {
    status = add_face(w, &face, &index, err);
    if (status) cag_surface_release(face.surface);
  }
  for (size_t pass = 0; pass < 2; pass++) // the outer loop first
    for (size_t i = 0; !status && i < region->count; i++) {
      if ((i == outer) != (pass == 0) || region->outer[i] != outer) continue;
      CagCurve *loop;
      status = cag_trimmed_loop(s, i, &loop, err);
      if (status) return status;
      status = add_trim_sides(w, s, loop, index, err);
      cag_curve_release(loop);
    }
  return status;
}

// Takes over the reference to the piece.
static CagStatus add_piece(CagBrepWork *w, CagSurface *piece, size_t source, CagError *err) {
  CagBrepFace face = {
      .surface = piece, .whole = true, .first = w->brep->loop_count, .source = source};
  face.flat = is_flat_patch(piece, &face.carrier.frame);
  size_t index;
  CagStatus status = add_face(w, &face, &index, err);
  if (status) {
    cag_surface_release(piece);
    return status;
  }
  return add_piece_sides(w, piece, index, err);
}

CagStatus cag_brep_add_surface(CagBrepWork *w, const CagSurface *s, size_t source, CagError *err) {
  const CagRegion *region;
  CagTransform frame;
  if (cag_surface_planar_view(s, &region, &frame))
    return cag_brep_add_region(w, region, &frame, source, err);
  const CagSurface *inner;
  if (cag_surface_trimmed_view(s, &inner, &region)) {
    CagStatus trimmed = CAG_OK;
    for (size_t i = 0; !trimmed && i < region->count; i++)
      if (region->outer[i] == i) trimmed = add_trimmed(w, s, inner, region, i, source, err);
    return trimmed;
  }
  CagSurface *nurbs = NULL;
  double *u = NULL, *v = NULL;
  size_t nu = 0, nv = 0;
  CagStatus status = cag_brep_surface(w, s, &nurbs, err);
  if (status) return status;
  status = cag_brep_surface_creases(nurbs, 0, &u, &nu, err);
  if (!status) status = cag_brep_surface_creases(nurbs, 1, &v, &nv, err);
  for (size_t i = 0; !status && i <= nu; i++)
    for (size_t j = 0; !status && j <= nv; j++) {
      CagSurface *piece = NULL;
      if (nu + nv == 0) piece = cag_surface_retain(nurbs);
      else
        status = cag_surface_nurbs_part(nurbs, i ? u[i - 1] : nurbs->u0, i < nu ? u[i] : nurbs->u1,
                                        j ? v[j - 1] : nurbs->v0, j < nv ? v[j] : nurbs->v1, &piece,
                                        err);
      if (!status) status = add_piece(w, piece, source, err);
    }
  cag_free(u);
  cag_free(v);
  cag_surface_release(nurbs);
  return status;
}

// --- Regions ---

// Adds the pieces between corners of a part of a loop. Takes ownership of the clamped space curve
// `rest`. *order is the index of the next side.
static CagStatus add_between_corners(CagBrepWork *w, CagCurve *rest, size_t face, size_t loop,
                                     size_t *order, CagError *err) {
  double *corners = NULL;
  size_t n = 0;
  CagStatus status = cag_brep_curve_corners(rest, &corners, &n, err);
  for (size_t i = 0; !status && i < n; i++) {
    CagCurve *parts[2];
    status = cag_curve_split(rest, corners[i], parts, err);
    if (status) break;
    cag_curve_release(rest);
    rest = parts[1];
    status = add_side(w, parts[0], false, face, loop, (*order)++, err);
  }
  if (!status) status = add_side(w, cag_curve_retain(rest), false, face, loop, (*order)++, err);
  cag_free(corners);
  cag_curve_release(rest);
  return status;
}

static CagStatus add_outline(CagBrepWork *w, const CagCurve *outline, const CagTransform *frame,
                             size_t face, CagError *err) {
  CagCurve *flat = NULL, *placed = NULL;
  CagStatus status = cag_brep_curve(w, outline, &flat, err);
  if (!status) status = cag_curve_transform(flat, frame, &placed, err);
  cag_curve_release(flat);
  size_t loop = 0, order = 0;
  if (!status) status = add_loop(w, face, &loop, err);
  if (status) {
    cag_curve_release(placed);
    return status;
  }
  return add_between_corners(w, placed, face, loop, &order, err);
}

// If all points of a stretch of a loop lie within this fraction of the size of each other, the
// stretch runs along a pole of the surface.
#define POLE 1e-12
// The sine of the smallest angle that counts as a corner of a loop.
#define TRIM_CORNER 1e-6

static CagStatus is_collapsed(const CagCurve *c, double a, double b, double slack, bool *out,
                              CagError *err) {
  CagVec3 from, p;
  CagStatus status = cag_curve_point(c, a, &from, err);
  *out = true;
  for (int k = 1; !status && *out && k <= 4; k++) {
    status = cag_curve_point(c, a + (b - a) * k / 4, &p, err);
    *out = !status && cag_norm(cag_sub(p, from)) <= slack;
  }
  return status;
}

// Adds the exact arcs of a stretch that lies on a side of the box of a quadric. *added is false if
// it does not.
static CagStatus add_exact_arcs(CagBrepWork *w, const CagSurface *s, const CagCurve *c, double a,
                                double b, size_t face, size_t loop, size_t *order, bool *added,
                                CagError *err) {
  CagCurve *arcs[CAG_QUADRIC_ARCS];
  size_t n;
  CagStatus status = cag_quadric_side_arcs(s, c, a, b, arcs, &n, err);
  *added = !status && n > 0;
  for (size_t i = 0; i < n; i++) {
    CagCurve *clamped;
    if (!status) status = cag_brep_curve(w, arcs[i], &clamped, err);
    if (!status) status = add_side(w, clamped, false, face, loop, (*order)++, err);
    cag_curve_release(arcs[i]);
  }
  return status;
}

static CagStatus add_trim_part(CagBrepWork *w, const CagSurface *s, const CagCurve *c, double a,
                               double b, double size, size_t face, size_t loop, size_t *order,
                               CagError *err) {
  bool added;
  CagStatus exact = add_exact_arcs(w, s, c, a, b, face, loop, order, &added, err);
  if (exact || added) return exact;
  CagCurve *part = NULL, *near = NULL, *clamped = NULL;
  CagStatus status = CAG_OK;
  if (a == c->start && b == c->end) part = cag_curve_retain(c);
  else status = cag_curve_trim(c, a, b, &part, err);
  if (!status) status = cag_curve_approximate(part, TRIM_NEAR * size, &near, err);
  if (!status) status = cag_brep_curve(w, near, &clamped, err);
  cag_curve_release(part);
  cag_curve_release(near);
  return status ? status : add_between_corners(w, clamped, face, loop, order, err);
}

// Tests whether the loop turns at t.
static CagStatus is_corner(const CagCurve *c, double t, bool *out, CagError *err) {
  CagVec3 before, after;
  CagStatus status = cag_curve_tangent(c, t, CAG_SIDE_LEFT, &before, err);
  if (!status) status = cag_curve_tangent(c, t, CAG_SIDE_RIGHT, &after, err);
  *out =
      !status && (cag_norm(cag_cross(before, after)) > TRIM_CORNER || cag_dot(before, after) < 0);
  return status;
}

// Finds which stretches between cuts are poles, and which ones end in a corner. Stretches of
// quadrics within boxes are cut at corners in advance, because each lies on a different side.
static CagStatus look_at_cuts(const CagSurface *s, const CagCurve *c, const double *cuts, size_t n,
                              double slack, bool *pole, bool *corner, CagError *err) {
  CagQuadricWithin unused;
  const bool exact = cag_surface_quadric_within(s, &unused);
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i + 1 < n; i++)
    status = is_collapsed(c, cuts[i], cuts[i + 1], slack, &pole[i], err);
  for (size_t i = 0; !status && i + 1 < n; i++) {
    corner[i] = i + 2 == n || pole[i] || pole[i + 1];
    if (!corner[i] && exact) status = is_corner(c, cuts[i + 1], &corner[i], err);
  }
  return status;
}

// Adds the stretches of a loop that are not poles.
static CagStatus add_trim_sides(CagBrepWork *w, const CagSurface *s, const CagCurve *c, size_t face,
                                CagError *err) {
  CagBounds box;
  double *cuts = NULL;
  size_t n = 0, loop, order = 0;
  CagStatus status = add_loop(w, face, &loop, err);
  if (!status) status = cag_curve_bounds(c, &box, err);
  if (!status) status = cag_curve_cuts(c, &cuts, &n, err);
  const double size = status ? 0 : cag_norm(cag_sub(box.max, box.min));
  bool *pole = cag_calloc(n + 1, sizeof *pole), *corner = cag_calloc(n + 1, sizeof *corner);
  if (!status) status = pole && corner ? CAG_OK : cag_fail_memory(err);
  if (!status) status = look_at_cuts(s, c, cuts, n, POLE * size, pole, corner, err);
  for (size_t i = 0, first = 0; !status && i + 1 < n; i++) {
    if (!corner[i]) continue;
    if (!pole[i])
      status = add_trim_part(w, s, c, cuts[first], cuts[i + 1], size, face, loop, &order, err);
    first = i + 1;
  }
  cag_free(pole);
  cag_free(corner);
  cag_free(cuts);
  return status;
}

// Computes the rectangle around the outline, along the axes of the plane.
static CagStatus rectangle_about(const CagRegion *r, size_t outer, const CagTransform *frame,
                                 CagSurface **out, CagError *err) {
  CagBounds box;
  CagStatus status = cag_curve_bounds(r->loops[outer], &box, err);
  if (status) return status;
  double off = MARGIN * fmax(box.max.x - box.min.x, box.max.y - box.min.y);
  CagVec3 p[4];
  for (int k = 0; k < 4; k++)
    p[k] = cag_transform_point(frame, cag_vec3(k / 2 ? box.max.x + off : box.min.x - off,
                                               k % 2 ? box.max.y + off : box.min.y - off, 0));
  const double x[4] = {0, 0, box.max.x - box.min.x + 2 * off, box.max.x - box.min.x + 2 * off};
  const double y[4] = {0, 0, box.max.y - box.min.y + 2 * off, box.max.y - box.min.y + 2 * off};
  return cag_surface_nurbs(p, NULL, 2, 2, 1, 1, x, y, out, err);
}

static CagVec3 column(const CagTransform *t, int j) {
  return cag_vec3(t->m[0][j], t->m[1][j], t->m[2][j]);
}

static CagStatus add_part(CagBrepWork *w, const CagRegion *r, size_t outer,
                          const CagTransform *frame, size_t source, CagError *err) {
  CagBrepFace face = {.flat = true, .first = w->brep->loop_count, .source = source};
  CagVec3 x = column(frame, 0);
  face.carrier.frame = plane_frame(column(frame, 3), x, cag_cross(x, column(frame, 1)));
  CagStatus status = rectangle_about(r, outer, frame, &face.surface, err);
  if (status) return status;
  size_t index;
  status = add_face(w, &face, &index, err);
  if (status) {
    cag_surface_release(face.surface);
    return status;
  }
  status = add_outline(w, r->loops[outer], frame, index, err);
  for (size_t i = 0; !status && i < r->count; i++)
    if (i != outer && r->outer[i] == outer) status = add_outline(w, r->loops[i], frame, index, err);
  return status;
}

CagStatus cag_brep_add_region(CagBrepWork *w, const CagRegion *r, const CagTransform *frame,
                              size_t source, CagError *err) {
  CagTransform space = *frame;
  space.planar = false;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < r->count; i++)
    if (r->outer[i] == i) status = add_part(w, r, i, &space, source, err);
  return status;
}
