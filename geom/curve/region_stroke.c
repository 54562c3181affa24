// Strokes: the strips on both sides of curves, their joins, and their caps.
//
// Each strip, sector of a corner, and cap is bounded by a closed counter-clockwise curve, so the
// stroke consists of the points with a positive winding number. The normals at which strips and
// sectors meet cancel.

#include "geom/curve/region_stroke.h"

#include <math.h>

#include "geom/curve/family.h"
#include "geom/curve/strip.h"
#include "geom/linalg/tolerance.h"

typedef struct Pen {
  CagWalks walks;
  const CagStroke *stroke;
  double half;
  bool near; // some of the curves are accurate only to the tolerance
} Pen;

static bool is_inside(const int winding[2], int parameter) {
  (void)parameter;
  return winding[0] > 0;
}

static CagVec3 left_of(CagVec3 v) { return cag_vec3(-v.y, v.x, 0); }

// A part of a circle whose strip towards the center folds: the sector from the center to the other
// side, and the sector beyond the center.
static CagStatus put_sectors(Pen *pen, const CagStripPart *p, CagError *err) {
  const int first = p->sense > 0 ? 0 : 1;
  const double outward = -p->sense * pen->half;
  CagStripPart outer = *p;
  outer.folds = false;
  CagStatus status =
      cag_walks_put_line(&pen->walks, p->center, cag_strip_end(p, first, outward), 1, err);
  if (!status)
    status = cag_strip_put_shifted(&pen->walks, &outer, outward, pen->stroke->tolerance, first == 1,
                                   1, &pen->near, err);
  if (!status)
    status =
        cag_walks_put_line(&pen->walks, cag_strip_end(p, 1 - first, outward), p->center, 1, err);
  return status ? status : cag_strip_put_beyond(&pen->walks, p, pen->half, 1, err);
}

static CagStatus put_strips(Pen *pen, const CagStripPart *p, CagError *err) {
  const double h = pen->half, tolerance = pen->stroke->tolerance;
  CagWalks *w = &pen->walks;
  if (p->folds && p->round) return put_sectors(pen, p, err);
  if (p->folds) return cag_strip_put_neighborhood(w, p, h, tolerance, 1, &pen->near, err);
  CagStatus status = cag_strip_put_shifted(w, p, -h, tolerance, false, 1, &pen->near, err);
  if (!status)
    status = cag_walks_put_line(w, cag_strip_end(p, 1, -h), cag_strip_end(p, 1, h), 1, err);
  if (!status) status = cag_strip_put_shifted(w, p, h, tolerance, true, 1, &pen->near, err);
  if (!status)
    status = cag_walks_put_line(w, cag_strip_end(p, 0, h), cag_strip_end(p, 0, -h), 1, err);
  return status;
}

// The sector on the outer side of a corner. The join runs counter-clockwise on the right side of a
// left turn, and clockwise on the left side of a right turn.
static CagStatus put_corner(Pen *pen, const CagStripPart *a, const CagStripPart *b, CagError *err) {
  const CagTurn turn = cag_strip_turn(a, b);
  if (turn == CAG_TURN_NONE) return CAG_OK;
  const int sign = turn == CAG_TURN_RIGHT ? -1 : 1;
  const double left = -sign * pen->half;
  CagWalks *w = &pen->walks;
  CagStatus status = cag_walks_put_line(w, a->ends[1], cag_strip_end(a, 1, left), sign, err);
  if (!status) status = cag_strip_put_join(w, a, b, left, &pen->stroke->joins, sign, err);
  return status ? status : cag_walks_put_line(w, cag_strip_end(b, 0, left), a->ends[1], sign, err);
}

// The cap at a point, which points along the unit vector.
static CagStatus put_cap(Pen *pen, CagVec3 at, CagVec3 along, CagError *err) {
  const CagVec3 left = cag_madd(at, pen->half, left_of(along)),
                right = cag_madd(at, -pen->half, left_of(along));
  CagWalks *w = &pen->walks;
  if (pen->stroke->cap == CAG_CAP_BUTT) return CAG_OK;
  CagStatus status = cag_walks_put_line(w, left, right, 1, err);
  if (status) return status;
  if (pen->stroke->cap == CAG_CAP_ROUND)
    return cag_walks_put_arc(w, at, right, left, false, 1, err);
  const CagVec3 p = cag_madd(right, pen->half, along), q = cag_madd(left, pen->half, along);
  status = cag_walks_put_line(w, right, p, 1, err);
  if (!status) status = cag_walks_put_line(w, p, q, 1, err);
  return status ? status : cag_walks_put_line(w, q, left, 1, err);
}

static CagStatus put_point(Pen *pen, const CagCurve *c, CagError *err) {
  CagVec3 at;
  CagStatus status = cag_curve_point(c, c->start, &at, err);
  if (!status) status = put_cap(pen, at, cag_vec3(1, 0, 0), err);
  return status ? status : put_cap(pen, at, cag_vec3(-1, 0, 0), err);
}

// The parts of a curve; each folds to one side, or to none.
static CagStatus find_parts(const Pen *pen, const CagCurve *c, CagStripParts *out, CagError *err) {
  CagStripParts parts = {0};
  CagStatus status = cag_strip_parts_add(&parts, c, pen->half, err);
  for (size_t i = 0; !status && i < parts.n; i++)
    status = parts.items[i].folds ? cag_strip_parts_copy(out, &parts.items[i], err)
                                  : cag_strip_parts_add(out, parts.items[i].curve, -pen->half, err);
  cag_strip_parts_free(&parts);
  return status;
}

static bool is_point(const CagCurve *c) {
  const CagBounds box = c->kind->hull(c, c->start, c->end);
  return box.min.x == box.max.x && box.min.y == box.max.y;
}

static CagStatus put_curve(Pen *pen, const CagCurve *c, CagError *err) {
  CagStripParts parts = {0};
  if (is_point(c)) return put_point(pen, c, err);
  const CagStroke *stroke = pen->stroke;
  CagStatus status = find_parts(pen, c, &parts, err);
  if (!status && (stroke->cap != CAG_CAP_ROUND || stroke->joins.join != CAG_JOIN_ROUND))
    status = cag_strip_parts_unfold(&parts, pen->half, true, stroke->tolerance, &pen->near, err);
  for (size_t i = 0; !status && i < parts.n; i++) {
    const CagStripPart *p = &parts.items[i], *before = &parts.items[(i + parts.n - 1) % parts.n];
    status = put_strips(pen, p, err);
    if (!status && (i > 0 || c->closed)) status = put_corner(pen, before, p, err);
  }
  if (!status && parts.n > 0 && !c->closed) {
    const CagStripPart *first = &parts.items[0], *last = &parts.items[parts.n - 1];
    status = put_cap(pen, first->ends[0], cag_scaled(first->tangents[0], -1), err);
    if (!status) status = put_cap(pen, last->ends[1], last->tangents[1], err);
  }
  cag_strip_parts_free(&parts);
  return status;
}

CagStatus cag_region_stroke(const CagCurve *const *curves, size_t count, const CagStroke *stroke,
                            CagRegion **out, CagError *err) {
  Pen pen = {.stroke = stroke, .half = stroke->width / 2};
  CagStatus status = CAG_OK;
  *out = NULL;
  for (size_t i = 0; !status && i < count; i++) {
    if (curves[i]->dimension != 2)
      status = cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_not_planar, "C", count > 1 ? (long)i : -1,
                        "only plane curves, of points [x, y], have a stroke");
    else status = put_curve(&pen, curves[i], err);
  }
  if (!status && pen.walks.n > 0)
    status = cag_region_arrange(pen.walks.items, pen.walks.n, is_inside, 0,
                                pen.near ? stroke->tolerance : 0, out, err);
  cag_walks_free(&pen.walks);
  return status || *out ? status : cag_region_empty(out, err);
}
