// Functions of the conics' table (conics.c), by the file that holds them.

#ifndef CAG_INTERP_BUILTIN_CONICS_H
#define CAG_INTERP_BUILTIN_CONICS_H

#include "geom/curve/conic.h"
#include "interp/builtin/shapes.h"

// clang-format off
#define CAG_CONIC_FUNCTIONS(X) \
  /* conics_make.c */ \
  X(parabola) X(hyperbola) X(conic) X(conic_of_curve) X(branches) X(conic_through) X(conic_by) \
  X(conic_arc) X(conic_segment) X(conic_points) \
  /* conics_ask.c */ \
  X(classify) X(coefficients) X(intersect_line) X(polar_line) X(implicit_at) X(points_at) \
  X(point_of_conic) X(slope) X(signed_curvature) X(fit_formula) X(line_through) X(meet_lines) \
  X(line_image) \
  /* conics_touch.c */ \
  X(circle_tangent) X(fillet) X(tangent_lines) X(rounded) X(rounded_region)
// clang-format on

#define X(name) bool cag_conics_##name(CagCall *call, CagValue *result);
CAG_CONIC_FUNCTIONS(X)
#undef X

// The equation of a conic from six coefficients, 3 rows of its symmetric matrix, or a curve.
bool cag_arg_conic(CagCall *call, int argument, CagConic *out);
// Given, and not none.
bool cag_conics_said(const CagCall *call, int argument);

#endif
