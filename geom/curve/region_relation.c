// Relations of regions, from their set operations and the corners that their boundaries share.

#include "geom/curve/region_relation.h"

#include "base/memory.h"
#include "geom/curve/family.h"
#include "geom/curve/region_arrange.h"
#include "geom/linalg/tolerance.h"

static CagBounds hull_of(const CagRegion *r) {
  CagBounds box = CAG_BOUNDS_EMPTY;
  for (size_t i = 0; i < r->count; i++) {
    const CagBounds one =
        r->loops[i]->kind->hull(r->loops[i], r->loops[i]->start, r->loops[i]->end);
    cag_bounds_add(&box, one.min);
    cag_bounds_add(&box, one.max);
  }
  return box;
}

// Whether boxes are farther apart than points that coincide.
static bool are_apart(const CagBounds *a, const CagBounds *b) {
  CagBounds both = *a;
  cag_bounds_add(&both, b->min);
  cag_bounds_add(&both, b->max);
  const double slack = 2 * CAG_COINCIDENT * cag_norm(cag_sub(both.max, both.min));
  return a->max.x + slack < b->min.x || b->max.x + slack < a->min.x ||
         a->max.y + slack < b->min.y || b->max.y + slack < a->min.y;
}

static CagStatus leaves(CagRegionOp op, const CagRegion *a, const CagRegion *b, bool *out,
                        CagError *err) {
  CagRegion *r = NULL;
  CagStatus status = cag_region_boolean(op, a, b, &r, err);
  *out = !status && !cag_region_is_empty(r);
  cag_region_release(r);
  return status;
}

// Whether boundaries of regions without common inner points have a common point.
static CagStatus touch(const CagRegion *a, const CagRegion *b, bool *out, CagError *err) {
  const CagRegion *const both[2] = {a, b};
  CagWalk *walks = cag_malloc(sizeof *walks * (a->count + b->count));
  if (!walks) return cag_fail_memory(err);
  size_t n = 0;
  for (int k = 0; k < 2; k++)
    for (size_t i = 0; i < both[k]->count; i++) walks[n++] = (CagWalk){both[k]->loops[i], k, 1, k};
  const CagStatus status = cag_region_arrange_share(walks, n, out, err);
  cag_free(walks);
  return status;
}

CagStatus cag_region_relation(const CagRegion *a, const CagRegion *b, CagRegionRelation *out,
                              CagError *err) {
  *out = CAG_REGION_DISJOINT;
  if (cag_region_is_empty(a) || cag_region_is_empty(b)) return CAG_OK;
  const CagBounds p = hull_of(a), q = hull_of(b);
  if (are_apart(&p, &q)) return CAG_OK;
  bool common, of_a, of_b, shared;
  CagStatus status = leaves(CAG_REGION_INTERSECTION, a, b, &common, err);
  if (!status && !common) {
    status = touch(a, b, &shared, err);
    if (!status && shared) *out = CAG_REGION_TOUCHES;
    return status;
  }
  if (!status) status = leaves(CAG_REGION_DIFFERENCE, a, b, &of_a, err);
  if (!status) status = leaves(CAG_REGION_DIFFERENCE, b, a, &of_b, err);
  if (status) return status;
  if (of_a) *out = of_b ? CAG_REGION_OVERLAPS : CAG_REGION_CONTAINS;
  else *out = of_b ? CAG_REGION_WITHIN : CAG_REGION_EQUALS;
  return CAG_OK;
}
