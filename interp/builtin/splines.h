// What several files of built-ins on splines share.

#ifndef CAG_INTERP_BUILTIN_SPLINES_H
#define CAG_INTERP_BUILTIN_SPLINES_H

#include "geom/curve/cubic.h"
#include "interp/builtin/curves.h"

// An error of geometry about an argument.
#define cag_splines_fail(call, ...) cag_fail_core(call, CAG_E_ARGUMENT, __VA_ARGS__)
// Whether points are all of one dimension ("dimension-mismatch").
bool cag_splines_check_points(CagCall *call, int argument, const CagPoints *points);
// Reads tangents, all of the dimension that the points have.
bool cag_splines_tangents(CagCall *call, int argument, int dimension, CagPoints *out);
// Whether a vector has the dimension of the points.
bool cag_splines_check_dimension(CagCall *call, int argument, CagPoint p, int dimension);
// "chord", "uniform", "centripetal"; n parameters, or the n - 1 lengths between them. *own is
// held, NULL where spacing says it.
bool cag_splines_parameters(CagCall *call, int argument, CagSpacing otherwise, size_t n,
                            CagSpacing *spacing, double **own);

#endif
