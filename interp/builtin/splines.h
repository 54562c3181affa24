// Functions of the table of splines through points (splines.c), by the file that holds them.

#ifndef CAG_INTERP_BUILTIN_SPLINES_H
#define CAG_INTERP_BUILTIN_SPLINES_H

#include "geom/curve/cubic.h"
#include "interp/builtin/curves.h"

// splines_make.c: through points by cubic segments; splines_fit.c: from data; splines_ask.c: bases,
// segments, joints.
// clang-format off
#define CAG_SPLINE_FUNCTIONS(X) \
  X(hermite) X(cubic_spline) X(clamped) X(relaxed) X(cyclic) X(anticyclic) X(ends) \
  X(parabolic_blend) X(catmull_rom) X(polynomial_curve) \
  X(data_parameters) X(interpolate) X(fit) X(fit_report) \
  X(polynomials) X(basis_matrix) X(bezier_matrices) X(bernstein_maxima) X(hermite_basis) \
  X(hermite_shape) X(hermite_by_curvature) X(convert_cubic) X(bezier_join) X(continuity) \
  X(line_crossings) X(hulls_disjoint)
// clang-format on

#define X(name) bool cag_splines_##name(CagCall *call, CagValue *result);
CAG_SPLINE_FUNCTIONS(X)
#undef X

// Whether an argument was given and is not none.
bool cag_splines_set(const CagCall *call, int argument);
// `made` is read after the call that fills it: pass its address.
bool cag_splines_give(CagCall *call, CagStatus status, const CagError *err, CagCurve **made,
                      CagValue *result);
// A geometry error of the built-ins themselves.
bool cag_splines_fail(CagCall *call, CagErrorId id, const char *argument, long index,
                      const char *format, ...) __attribute__((format(printf, 5, 6)));
// Points all of one dimension ("dimension-mismatch"); malloc'd.
bool cag_splines_points(CagCall *call, int argument, CagVec3 **out, size_t *n, int *dimension);
// A vector of the dimension that the points have.
bool cag_splines_vec(CagCall *call, int argument, int dimension, CagVec3 *out);
// "chord", "uniform", "centripetal"; n parameters, or the n - 1 lengths between them. *own is
// malloc'd, NULL where spacing says it.
bool cag_splines_parameters(CagCall *call, int argument, CagSpacing otherwise, size_t n,
                            CagSpacing *spacing, double **own);

#endif
