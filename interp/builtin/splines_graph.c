// Splines of graphs, hodographs, and antiderivatives.

#include "geom/curve/graph_spline.h"
#include "geom/curve/hodograph.h"
#include "interp/builtin/splines.h"
#include "interp/builtin/support.h"

static bool check_plane(CagCall *call, const CagPoints *points) {
  return cag_splines_check_points(call, 0, points) &&
         (points->dimension == 2 ||
          cag_splines_fail(call, CAG_ERR_dimension_mismatch, "points", -1,
                           "expected points [x, y], found points with 3 numbers"));
}

bool cag_splines_pchip(CagCall *call, const struct cag_splines_pchip *a, CagValue *result) {
  CagCurve *c = NULL;
  if (!check_plane(call, &a->points)) return false;
  CagStatus status = cag_curve_pchip(a->points.items, a->points.count, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}

bool cag_splines_akima(CagCall *call, const struct cag_splines_akima *a, CagValue *result) {
  CagCurve *c = NULL;
  if (!check_plane(call, &a->points)) return false;
  CagStatus status = cag_curve_akima(a->points.items, a->points.count, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}

bool cag_splines_smoothing_spline(CagCall *call, const struct cag_splines_smoothing_spline *a,
                                  CagValue *result) {
  CagCurve *c = NULL;
  const bool weight = cag_given(call, 1), deviation = cag_given(call, 2);
  if (!check_plane(call, &a->points)) return false;
  if (weight && deviation)
    return cag_fail_call(call, 2, CAG_ERR_value, "takes `weight` or `deviation`, not both");
  const CagSmoothing by = weight      ? CAG_SMOOTHING_WEIGHT
                          : deviation ? CAG_SMOOTHING_DEVIATION
                                      : CAG_SMOOTHING_AUTO;
  CagStatus status = cag_curve_smoothing(a->points.items, a->points.count, by,
                                         weight ? a->weight : a->deviation, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}

bool cag_splines_hodograph(CagCall *call, const struct cag_splines_hodograph *a, CagValue *result) {
  CagCurve *c = NULL;
  return cag_curve_result(call, cag_curve_hodograph(a->C, &c, call->err), &c, result);
}

bool cag_splines_antiderivative(CagCall *call, const struct cag_splines_antiderivative *a,
                                CagValue *result) {
  CagCurve *c = NULL;
  if (a->C->dimension == 2 && a->start.at.z != 0)
    return cag_splines_fail(call, CAG_ERR_dimension_mismatch, "start", -1,
                            "the curve is in the plane, so `start` must be [x, y]");
  CagStatus status = cag_curve_antiderivative(a->C, a->start.at, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}
