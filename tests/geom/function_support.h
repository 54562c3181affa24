// Surfaces defined by functions of a test.

#ifndef CAG_TESTS_GEOM_FUNCTION_SUPPORT_H
#define CAG_TESTS_GEOM_FUNCTION_SUPPORT_H

#include "geom/surface/function.h"

typedef CagStatus (*PointEval)(void *context, double u, double v, int n, CagVec3 *out,
                               CagError *err);

// Implements eval_row of a CagSurfaceFunction by calling its eval.
static inline CagStatus row_by_points(PointEval eval, void *context, double u, const double *vs,
                                      size_t nv, int n, CagVec3 *out, CagError *err) {
  for (size_t j = 0; j < nv; j++) {
    CagVec3 d[3] = {{0}}, *to = out + (n ? 3 * j : j);
    const CagStatus status = eval(context, u, vs[j], n, d, err);
    if (status) return status;
    to[0] = d[0];
    if (n) to[1] = d[cag_partial(1, 1, 0)];
    if (n) to[2] = d[cag_partial(1, 0, 1)];
  }
  return CAG_OK;
}

#endif
