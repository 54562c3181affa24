// Minkowski sums by convolution.
//
// The convolution of two loops consists of the sums of those of their points where both run in the
// same direction (Guibas, Ramshaw, and Stolfi 1983). Its winding number about a point p is the
// Euler characteristic of the common part of the first region and the second one turned by half a
// turn about p / 2. If both regions are simply connected, this is the number of pieces of the
// common part, so the sum consists of the points with a positive winding number. Regions with holes
// are cut into simply connected parts first.
//
// Sides of the two loops are never parallel: those of the second loop count as turned
// counter-clockwise by an infinitesimal angle.

#include "geom/curve/minkowski.h"

#include <math.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/family.h"
#include "geom/curve/outline.h"
#include "geom/curve/region_walks.h"
#include "geom/linalg/tolerance.h"

// --- Simply connected parts ---

typedef struct Parts {
  CagRegion **items;
  size_t n, capacity;
} Parts;

static void parts_free(Parts *p) {
  for (size_t i = 0; i < p->n; i++) cag_region_release(p->items[i]);
  cag_free(p->items);
}

// Takes ownership of the region, even if it fails.
static CagStatus push(Parts *p, CagRegion *r, CagError *err) {
  if (!CAG_RESERVE(p->items, p->capacity, p->n + 1)) {
    cag_region_release(r);
    return cag_fail_memory(err);
  }
  p->items[p->n++] = r;
  return CAG_OK;
}

static CagStatus box_between(double x0, double y0, double x1, double y1, CagRegion **out,
                             CagError *err) {
  const CagVec3 p[4] = {{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}};
  CagCurve *c;
  CagStatus status = cag_curve_polyline(p, 4, true, 2, &c, err);
  if (status) return status;
  status = cag_region_new(c, NULL, 0, out, err);
  cag_curve_release(c);
  return status;
}

// Pushes the parts of the region to the left and to the right of the middle of the hole.
static CagStatus cut_through(Parts *p, const CagRegion *r, size_t hole, CagError *err) {
  CagBounds box, inner;
  CagStatus status = cag_region_bounds(r, &box, err);
  if (!status) status = cag_curve_bounds(r->loops[hole], &inner, err);
  if (status) return status;
  const double margin = cag_norm(cag_sub(box.max, box.min)),
               x = inner.min.x + (inner.max.x - inner.min.x) / 2;
  const double ends[3] = {box.min.x - margin, x, box.max.x + margin};
  for (int i = 0; !status && i < 2; i++) {
    CagRegion *half, *part;
    status = box_between(ends[i], box.min.y - margin, ends[i + 1], box.max.y + margin, &half, err);
    if (status) break;
    status = cag_region_boolean(CAG_REGION_INTERSECTION, r, half, &part, err);
    cag_region_release(half);
    if (!status) status = push(p, part, err);
  }
  return status;
}

// Replaces regions with holes by their parts, until there are none.
static CagStatus simple_parts(const CagRegion *r, Parts *out, CagError *err) {
  CagStatus status = push(out, cag_region_retain(r), err);
  for (size_t i = 0; !status && i < out->n; i++) {
    CagRegion *one = out->items[i];
    size_t hole = 0;
    while (hole < one->count && one->outer[hole] == hole) hole++;
    if (hole == one->count) continue;
    status = cut_through(out, one, hole, err);
    if (status) break;
    cag_region_release(one);
    out->items[i--] = out->items[--out->n];
  }
  return status;
}

typedef struct Outlines {
  CagOutline *items;
  size_t n;
  bool near;
} Outlines;

static void outlines_free(Outlines *o) {
  for (size_t i = 0; i < o->n; i++) cag_outline_free(&o->items[i]);
  cag_free(o->items);
}

static CagStatus outlines_of(const CagRegion *r, double tolerance, Outlines *out, CagError *err) {
  Parts parts = {0};
  size_t capacity = 0;
  CagStatus status = simple_parts(r, &parts, err);
  for (size_t i = 0; !status && i < parts.n; i++)
    for (size_t k = 0; !status && k < parts.items[i]->count; k++) {
      if (!CAG_RESERVE(out->items, capacity, out->n + 1)) status = cag_fail_memory(err);
      else
        status = cag_outline_of(parts.items[i]->loops[k], tolerance, &out->items[out->n],
                                &out->near, err);
      out->n += !status;
    }
  parts_free(&parts);
  return status;
}

// --- Convolution ---

// Whether the direction is in the bend, without one of its ends.
static bool turns_through(const CagBend *b, CagVec3 direction, bool with_low) {
  const int low = cag_direction_turn(b->low, direction),
            high = cag_direction_turn(direction, b->high);
  return with_low ? low >= 0 && high > 0 : low > 0 && high >= 0;
}

// The side moved to the bend's point with its direction.
static CagStatus put_side_at(CagWalks *w, const CagSideLine *side, const CagBend *b,
                             CagError *err) {
  const CagVec3 at = cag_bend_point(b, side->along);
  return cag_walks_put_line(w, cag_add(side->from, at), cag_add(side->to, at), b->sense, err);
}

// The sum of two bends, over the directions that both turn through.
static CagStatus put_sum(CagWalks *w, const CagBend *a, const CagBend *b, CagError *err) {
  const double radius = a->radius + b->radius;
  if (fabs(radius) <= CAG_ROUNDING * (fabs(a->radius) + fabs(b->radius))) return CAG_OK;
  CagVec3 low;
  if (turns_through(a, b->low, true)) low = b->low;
  else if (turns_through(b, a->low, true)) low = a->low;
  else return CAG_OK;
  const CagVec3 high = cag_direction_turn(a->high, b->high) >= 0 ? a->high : b->high;
  const CagBend sum = {cag_add(a->center, b->center), radius, a->sense * b->sense, low, high};
  const CagVec3 from = cag_bend_point(&sum, low), to = cag_bend_point(&sum, high);
  // The sagitta of a shorter arc is below the rounding of its ends, whose order may be lost.
  if (fabs(cag_cross(low, high).z) <= CAG_COINCIDENT * cag_norm(low) * cag_norm(high))
    return cag_walks_put_line(w, from, to, sum.sense, err);
  return cag_walks_put_arc(w, sum.center, from, to, false, sum.sense, err);
}

static CagStatus convolve(CagWalks *w, const CagOutline *a, const CagOutline *b, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < a->bend_count; i++) {
    const CagBend *bend = &a->bends[i];
    status = cag_stop_check(err);
    for (size_t k = 0; !status && k < b->side_count; k++)
      if (turns_through(bend, b->sides[k].along, true))
        status = put_side_at(w, &b->sides[k], bend, err);
    for (size_t k = 0; !status && k < b->bend_count; k++)
      status = put_sum(w, bend, &b->bends[k], err);
  }
  for (size_t i = 0; !status && i < b->bend_count; i++) {
    status = cag_stop_check(err);
    for (size_t k = 0; !status && k < a->side_count; k++)
      if (turns_through(&b->bends[i], a->sides[k].along, false))
        status = put_side_at(w, &a->sides[k], &b->bends[i], err);
  }
  return status;
}

static bool is_inside(const int winding[2], int parameter) {
  (void)parameter;
  return winding[0] > 0;
}

CagStatus cag_region_minkowski(const CagRegion *a, const CagRegion *b, double tolerance,
                               CagRegion **out, CagError *err) {
  Outlines first = {0}, second = {0};
  CagWalks walks = {0};
  *out = NULL;
  if (cag_region_is_empty(a) || cag_region_is_empty(b)) return cag_region_empty(out, err);
  CagStatus status = outlines_of(a, tolerance / 2, &first, err);
  if (!status) status = outlines_of(b, tolerance / 2, &second, err);
  for (size_t i = 0; !status && i < first.n; i++)
    for (size_t k = 0; !status && k < second.n; k++)
      status = convolve(&walks, &first.items[i], &second.items[k], err);
  if (!status)
    status = cag_region_arrange(walks.items, walks.n, is_inside, 0,
                                first.near || second.near ? tolerance : 0, out, err);
  cag_walks_free(&walks);
  outlines_free(&first);
  outlines_free(&second);
  return status || *out ? status : cag_region_empty(out, err);
}
