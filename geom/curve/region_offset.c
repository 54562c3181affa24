// Offsets of regions: the points within a distance of a region, or of its inside.
//
// A strip of the width |d| lies along each smooth part of the boundary, on the side to which it
// moves (strip.h), and a sector at each corner that bends away from that side. The curve around
// region and strips (grown), or around the region without the strips (shrunk), runs along the
// shifted parts, along the joins of such corners, and through all other corners. The winding number
// of the curve about a point is that of the region plus (minus) the number of strips and sectors
// that contain the point. The result consists of the points with a positive winding number, so
// crossings need no separate treatment.
//
// Strips are oriented: where a part bends towards its strip with a radius below |d|, the strip
// folds over, and the area beyond the fold would count negatively. On a circle, the curve runs
// through the center instead, and the sector beyond it is added (removed) on its own. Other such
// parts are replaced by arcs, or, if joins are round, not moved; instead the whole neighborhood of
// the part is added (removed). Such a part extends a little beyond the point where the strip begins to fold, so that its ends are not cusps
// of the shifted curve.

#include <math.h>

#include "geom/curve/family.h"
#include "geom/curve/region_shrink.h"
#include "geom/curve/strip.h"
#include "geom/linalg/tolerance.h"

// The moved boundary.
typedef struct Border {
  CagWalks walks;
  double left, tolerance; // distance by which the boundary moves to its left
  const CagJoins *joins;
  bool near; // some of the curves are accurate only to the tolerance
} Border;

// Whether the strips of two segments at an inner corner both cover the triangle of the corner and
// the strips' ends. Counted once less, it is still covered, and the detour to the corner is
// unnecessary.
static bool overlaps(const CagStripPart *a, const CagStripPart *b, double left) {
  if (!a->straight || !b->straight) return false;
  const double reach = fabs(left * cag_cross(a->tangents[1], b->tangents[0]).z);
  return cag_dot(a->tangents[1], b->tangents[0]) > 0 &&
         reach <= cag_norm(cag_sub(a->ends[1], a->ends[0])) &&
         reach <= cag_norm(cag_sub(b->ends[1], b->ends[0]));
}

// Parts that fold are left in place, except for circles. They have round joins only.
static bool stays(const CagStripPart *p) { return p->folds && !p->round; }

// From the end of one part's strip to the start of the next one's.
static CagStatus put_corner(Border *o, const CagStripPart *a, const CagStripPart *b,
                            CagError *err) {
  const CagVec3 corner = b->ends[0], from = cag_strip_end(a, 1, o->left),
                to = cag_strip_end(b, 0, o->left);
  const CagTurn turn = cag_strip_turn(a, b);
  const bool outer =
      turn == CAG_TURN_BACK || turn == (o->left > 0 ? CAG_TURN_RIGHT : CAG_TURN_LEFT);
  const bool still = stays(a) || stays(b);
  // The neighborhoods of parts that stay have round ends.
  if (outer && !still) return cag_strip_put_join(&o->walks, a, b, o->left, o->joins, 1, err);
  if (!still && (turn == CAG_TURN_NONE || overlaps(a, b, o->left)))
    return cag_walks_put_line(&o->walks, from, to, 1, err);
  CagStatus status = CAG_OK;
  if (!stays(a)) status = cag_walks_put_line(&o->walks, from, corner, 1, err);
  if (!status && !stays(b)) status = cag_walks_put_line(&o->walks, corner, to, 1, err);
  return status;
}

static CagStatus put_part(Border *o, const CagStripPart *p, CagError *err) {
  const double d = fabs(o->left);
  const int sign = o->left < 0 ? 1 : -1; // grown or shrunk
  CagWalks *w = &o->walks;
  if (!p->folds) return cag_strip_put_shifted(w, p, o->left, o->tolerance, false, 1, &o->near, err);
  CagStatus status;
  if (!p->round) {
    status = cag_walks_put(w, cag_curve_retain(p->curve), 1, err);
    return status ? status : cag_strip_put_neighborhood(w, p, d, o->tolerance, sign, &o->near, err);
  }
  status = cag_walks_put_line(w, cag_strip_end(p, 0, o->left), p->center, 1, err);
  if (!status) status = cag_walks_put_line(w, p->center, cag_strip_end(p, 1, o->left), 1, err);
  return status ? status : cag_strip_put_beyond(w, p, d, sign, err);
}

static CagStatus put_loop(Border *o, const CagCurve *loop, CagError *err) {
  CagStripParts parts = {0};
  CagStatus status = cag_strip_parts_add(&parts, loop, o->left, err);
  if (!status && o->joins->join != CAG_JOIN_ROUND)
    status = cag_strip_parts_unfold(&parts, o->left, false, o->tolerance, &o->near, err);
  for (size_t i = 0; !status && i < parts.n; i++) {
    const CagStripPart *p = &parts.items[i], *before = &parts.items[(i + parts.n - 1) % parts.n];
    // A smooth closed curve moves to a closed curve.
    if (parts.n > 1 || !p->curve->closed || cag_strip_turn(p, p) != CAG_TURN_NONE)
      status = put_corner(o, before, p, err);
    if (!status) status = put_part(o, p, err);
  }
  cag_strip_parts_free(&parts);
  return status;
}

static bool is_inside(const int winding[2], int parameter) {
  (void)parameter;
  return winding[0] > 0;
}

// The largest disc in the region has at most the region's area, and fits into its box.
static CagStatus largest_disc(const CagRegion *r, double *out, CagError *err) {
  double area;
  CagBounds box;
  CagStatus status = cag_region_area(r, &area, NULL, err);
  if (!status) status = cag_region_bounds(r, &box, err);
  if (status) return status;
  *out = fmin(fmin(box.max.x - box.min.x, box.max.y - box.min.y) / 2, sqrt(area / M_PI));
  return CAG_OK;
}

// Relative to the region's size: a distance below the first is rounding; for one above the second
// the region itself is below rounding.
#define NO_DISTANCE CAG_ROUNDING
#define FAR 1e9

CagStatus cag_region_offset_joined(const CagRegion *r, double d, double tolerance,
                                   const CagJoins *joins, CagRegion **out, CagError *err) {
  CagStatus status = cag_curve_check_number(d, "d", err);
  CagBounds box;
  double disc = 0;
  if (!status && cag_region_is_empty(r)) return cag_region_empty(out, err);
  if (!status) status = cag_region_bounds(r, &box, err);
  if (!status && d < 0) status = largest_disc(r, &disc, err);
  if (status) return status;
  const double size = cag_norm(cag_sub(box.max, box.min)), slack = 1e-6;
  char text[32];
  if (d < 0 && -d > disc * (1 + slack)) return cag_region_empty(out, err);
  if (d > FAR * size)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_too_far, "d", -1,
                    "`d` must be at most 1e9 times the size of the region, found %s",
                    cag_number_text(d, text));
  if (fabs(d) <= NO_DISTANCE * size) {
    *out = cag_region_retain(r);
    return CAG_OK;
  }
  bool convex = false;
  if (d < 0) status = cag_region_shrink_convex(r, -d, size, &convex, out, err);
  if (status || convex) return status || *out ? status : cag_region_empty(out, err);
  Border b = {.left = -d, .tolerance = tolerance, .joins = joins};
  for (size_t i = 0; !status && i < r->count; i++) status = put_loop(&b, r->loops[i], err);
  if (!status)
    status = cag_region_arrange(b.walks.items, b.walks.n, is_inside, 0, b.near ? tolerance : 0, out,
                                err);
  cag_walks_free(&b.walks);
  return status || *out ? status : cag_region_empty(out, err);
}

CagStatus cag_region_offset(const CagRegion *r, double d, double tolerance, CagRegion **out,
                            CagError *err) {
  const CagJoins round = {CAG_JOIN_ROUND, 0};
  return cag_region_offset_joined(r, d, tolerance, &round, out, err);
}
