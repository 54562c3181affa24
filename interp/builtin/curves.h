// Declarations shared by the built-ins on curves and regions.

#ifndef CAG_INTERP_BUILTIN_CURVES_H
#define CAG_INTERP_BUILTIN_CURVES_H

#include "geom/curve/feet.h"
#include "geom/curve/region.h"
#include "interp/builtin/shapes.h"

// Fails with a geometry error. The arguments after the call are those of cag_fail after `err`.
#define cag_fail_core(call, ...) cag_geometry_ok(call, cag_fail((call)->err, __VA_ARGS__))

// The name of the kind of a foot of a perpendicular.
CagValue cag_foot_kind_value(CagVm *vm, CagFootKind kind);

// Reads the parameter of a curve, which is the second argument.
static inline bool cag_arg_at(CagCall *call, const CagCurve *c, double *t) {
  return cag_arg_parameter(call, 1, c->angular, c->start, c->end, false, t);
}

// Sets an error such as "a curve of kind helix has no weights; ...", and returns false.
bool cag_fail_no_data(CagCall *call, const CagCurve *c, const char *what);

// Reads the degree from the parameter `degree`, or from `order` minus one. Without either, it is
// the fallback.
bool cag_arg_degree(CagCall *call, int degree, int order, long fallback, int *out);

// The frame of a circle, with z along the normal (0: not given). Its x axis is horizontal, or X if
// the normal is parallel to Z. The frame is planar if neither the center nor the normal is in space.
bool cag_circle_frame(CagCall *call, CagPoint center, CagPoint normal, CagTransform *out);
// Converts a curve that the core made over the ascending range to a result. Reverses it if the
// range is descending.
bool cag_ranged_curve_result(CagCall *call, CagStatus status, bool backwards, CagCurve **made,
                             CagValue *result);

// Moves loops given in space into the x, y plane of a frame, as plane curves. *in_space is false if
// the frame is the world's. Fails with "not-planar".
bool cag_region_loops_plane(CagCall *call, CagCurve **loops, size_t n, CagTransform *frame,
                            bool *in_space);

#endif
