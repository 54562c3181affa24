// Declarations shared by the built-ins on splines.

#ifndef CAG_INTERP_BUILTIN_SPLINES_H
#define CAG_INTERP_BUILTIN_SPLINES_H

#include "geom/curve/cubic.h"
#include "interp/builtin/curves.h"

// Fails with a geometry error about an argument.
#define cag_splines_fail(call, ...) cag_fail_core(call, CAG_E_ARGUMENT, __VA_ARGS__)
// Checks that all points have the same dimension ("dimension-mismatch").
bool cag_splines_check_points(CagCall *call, int argument, const CagPoints *points);
// Reads tangents, which must have the dimension of the points.
bool cag_splines_tangents(CagCall *call, int argument, int dimension, CagPoints *out);
// Checks that a vector has the dimension of the points.
bool cag_splines_check_dimension(CagCall *call, int argument, CagPoint p, int dimension);
// Reads "chord", "uniform", or "centripetal", or n parameters, or the n - 1 lengths between them.
// *own is held, and is NULL if `spacing` is used.
bool cag_splines_parameters(CagCall *call, int argument, CagSpacing otherwise, size_t n,
                            CagSpacing *spacing, double **own);

#endif
