// Regions of outlines that may cross: the rule that selects the faces of their arrangement.

#include "geom/curve/region_fill.h"

#include "base/memory.h"
#include "geom/curve/region_arrange.h"
#include "geom/curve/region_check.h"

static bool is_odd(const int winding[2], int parameter) {
  (void)parameter;
  return winding[0] % 2 != 0;
}

static bool is_nonzero(const int winding[2], int parameter) {
  (void)parameter;
  return winding[0] != 0;
}

static bool is_positive(const int winding[2], int parameter) {
  (void)parameter;
  return winding[0] > 0;
}

static const CagFaceRule rules[] = {[CAG_FILL_EVEN_ODD] = is_odd,
                                    [CAG_FILL_NONZERO] = is_nonzero,
                                    [CAG_FILL_POSITIVE] = is_positive};

CagStatus cag_region_fill(const CagCurve *const *loops, size_t count, CagFill fill, CagRegion **out,
                          CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < count; i++)
    status = cag_region_check_closed(loops[i], "curves", (long)i, err);
  if (status) return status;
  CagWalk *walks = cag_malloc(sizeof *walks * (count + 1));
  if (!walks) return cag_fail_memory(err);
  for (size_t i = 0; i < count; i++) walks[i] = (CagWalk){loops[i], 0, 1, -1};
  *out = NULL;
  if (count > 0) status = cag_region_arrange(walks, count, rules[fill], 0, 0, out, err);
  cag_free(walks);
  return status || *out ? status : cag_region_empty(out, err);
}
