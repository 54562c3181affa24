// Set operations of regions: which faces of their arrangement belong to the result.
//
// The sum of the winding numbers about a set of regions is the number of regions that contain a
// point. The first region is operand 0, all others are operand 1.

#include "base/memory.h"
#include "geom/curve/region_arrange.h"

static bool in_union(const int winding[2], int n) {
  (void)n;
  return winding[0] + winding[1] > 0;
}

static bool in_difference(const int winding[2], int n) {
  (void)n;
  return winding[0] > 0 && winding[1] <= 0;
}

static bool in_intersection(const int winding[2], int n) { return winding[0] + winding[1] >= n; }

static const CagFaceRule rules[] = {[CAG_REGION_UNION] = in_union,
                                    [CAG_REGION_DIFFERENCE] = in_difference,
                                    [CAG_REGION_INTERSECTION] = in_intersection};

CagStatus cag_region_combine(CagRegionOp op, const CagRegion *const *regions, size_t n,
                             CagRegion **out, CagError *err) {
  size_t count = 0;
  for (size_t i = 0; i < n; i++) count += regions[i]->count;
  CagWalk *walks = cag_malloc(sizeof *walks * (count + 1));
  if (!walks) return cag_fail_memory(err);
  count = 0;
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < regions[i]->count; k++)
      walks[count++] = (CagWalk){regions[i]->loops[k], i > 0, 1, (int)i};
  *out = NULL;
  CagStatus status = CAG_OK;
  if (count > 0) status = cag_region_arrange(walks, count, rules[op], (int)n, 0, out, err);
  cag_free(walks);
  return status || *out ? status : cag_region_empty(out, err);
}

CagStatus cag_region_boolean(CagRegionOp op, const CagRegion *a, const CagRegion *b,
                             CagRegion **out, CagError *err) {
  const CagRegion *const both[2] = {a, b};
  return cag_region_combine(op, both, 2, out, err);
}
