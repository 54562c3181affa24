// Shared by the built-ins of geometry: parameters that may be angles, points of plane or space,
// results as records, and reading of shapes.

#ifndef CAG_INTERP_BUILTIN_SHAPES_H
#define CAG_INTERP_BUILTIN_SHAPES_H

#include "interp/vm/apply.h"
#include "interp/vm/builtin.h"

// The functions of the rows, made by tools/rows.awk.
#include "builtin_functions.h"

// Loops over shapes ask so often whether the run must stop.
#define CAG_LOOK_UP 64

#define CAG_RADIANS_PER_DEGREE 0.017453292519943295

// True when the core succeeded; else what it wrote to call->err becomes the machine's error.
static inline bool cag_geometry_ok(CagCall *call, CagStatus status) {
  return !status || cag_fail_geometry(call, call->err);
}

// The result of a call of the core that makes a shape: its value, or the machine's error. They take
// the address of what was made because the call that fills it in is an argument before it. The
// `changed` ones keep what was said about the first argument: material, name, and so on.
// clang-format off
#define CAG_SHAPE_RESULTS(X) \
  X(CagCurve, curve) X(CagRegion, region) X(CagSurface, surface) X(CagSolid, solid) X(CagMesh, mesh)
// clang-format on
#define X(Type, name)                                                                              \
  bool cag_##name##_result(CagCall *call, CagStatus status, Type **made, CagValue *result);        \
                                                                                                   \
  bool cag_changed_##name##_result(CagCall *call, CagStatus status, Type **made, CagValue *result);
CAG_SHAPE_RESULTS(X)
#undef X

// The degrees that a person would write for these radians: the shortest decimal whose radians are
// the same double (or its neighbor), so that a full circle is 360deg and not
// 360.00000000000006deg.
double cag_degrees_shown(double radians);
// A curve's or surface's parameter as the language has it.
CagValue cag_parameter_value(bool angular, double t);
CagValue cag_domain_value(CagVm *vm, bool angular, double start, double end);
// Reads a parameter: an angle where `angular`, else a number; `unit`: 0..1 of [start, end].
bool cag_arg_parameter(CagCall *call, int argument, bool angular, double start, double end,
                       bool unit, double *out);
// Reads a range of the parameter.
bool cag_arg_parameter_range(CagCall *call, int argument, bool angular, double *from, double *to);

CagValue cag_bounds_value(CagVm *vm, const CagBounds *b, int dimension);
CagValue cag_numbers_value(CagVm *vm, const double *x, size_t n);
// Points as a list of vectors of 2 or 3 numbers.
CagValue cag_points_value(CagVm *vm, const CagVec3 *points, size_t n, int dimension);

// Sets in `to` what was said about `from`: all attributes.
void cag_shape_say_alike(CagValue to, CagValue from);
// What holds of a material said near and one said further out; see scene_say.c. Either may be NULL.
CagRecord *cag_material_combine(CagVm *vm, CagRecord *inner, CagRecord *outer);
// All arguments, or the elements of the only one: `join_curves(a, b)` and `join_curves([a, b])`.
bool cag_arg_several(CagCall *call, CagValue **items, size_t *n);
// A flat list of all shapes in a shape, a group or a list (groups taken apart, attributes
// inherited). False: error set.
bool cag_shapes_collect(CagCall *call, CagValue v, CagBuilder *into);
// The unit vector and plane-ness of a direction that must not be zero.
bool cag_arg_direction(CagCall *call, int argument, CagVec3 fallback, CagVec3 *out, int *dimension);
bool cag_arg_plane(CagCall *call, int argument, CagPlane *out);
// A region from a region, closed plane curve or list of points; *out has one reference of its own.
bool cag_arg_region(CagCall *call, int argument, CagRegion **out, CagTransform *placement);
// Whether nothing is left of a shape other than a group.
bool cag_value_is_empty(CagCall *call, CagValue v, bool *out);
// Bounds of a shape, group or list, of what is not empty in it; `dimension` is 2 when everything is
// of the plane. Fails with "empty-shape" where nothing is left.
bool cag_value_bounds(CagCall *call, CagValue v, CagBounds *out, int *dimension);

#endif
