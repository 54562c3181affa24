// What several files of built-ins on curves and regions share.

#ifndef CAG_INTERP_BUILTIN_CURVES_H
#define CAG_INTERP_BUILTIN_CURVES_H

#include "geom/curve/region.h"
#include "interp/builtin/shapes.h"

// Fails with an error of geometry: a status, id, argument, index, format, and what it formats.
#define cag_fail_core(call, ...) cag_geometry_ok(call, cag_fail((call)->err, __VA_ARGS__))

// The parameter of a curve: the second argument, after the curve.
static inline bool cag_arg_at(CagCall *call, const CagCurve *c, double *t) {
  return cag_arg_parameter(call, 1, c->angular, c->start, c->end, false, t);
}

// "a curve of kind helix has no weights; ...": false, as all that fails.
bool cag_fail_no_data(CagCall *call, const CagCurve *c, const char *what);

// Degree from `degree` or, one more, from `order`; the fallback where neither is given.
bool cag_arg_degree(CagCall *call, int degree, int order, long fallback, int *out);

// The frame of a circle: z along the normal (0: none is given), x level, or X where the normal is
// along Z; planar where neither is of space.
bool cag_circle_frame(CagCall *call, CagPoint center, CagPoint normal, CagTransform *out);
// The result that the core made over the ascending range: reversed where the range runs backwards.
bool cag_ranged_curve_result(CagCall *call, CagStatus status, bool backwards, CagCurve **made,
                             CagValue *result);

// Brings loops given in space into the x, y plane of a frame, as plane curves; *in_space: it is not
// that of the world. Fails with "not-planar".
bool cag_region_loops_plane(CagCall *call, CagCurve **loops, size_t n, CagTransform *frame,
                            bool *in_space);

#endif
