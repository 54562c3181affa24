// Functions of the B-splines' table (bsplines.c), by the file that holds them.

#ifndef CAG_INTERP_BUILTIN_BSPLINES_H
#define CAG_INTERP_BUILTIN_BSPLINES_H

#include "interp/builtin/curves.h"

// clang-format off
#define CAG_BSPLINE_FUNCTIONS(X) \
  /* bsplines_basis.c: knots and bases as data */ \
  X(uniform_knots) X(classify_knots) X(basis) X(basis_triangle) X(basis_pieces) \
  X(basis_dependency) X(oslo) X(phantom_points) \
  /* bsplines_ask.c: spans and control points of a curve */ \
  X(spans) X(support) X(acting_points) X(straight_spans) X(denominator) X(nurbs_circle) X(nurbs_arc) \
  X(control_net) X(curvature_comb) \
  /* curves_change.c: another form of a curve */ \
  X(to_bezier) X(elevate) X(reduce_degree) X(insert_knot) X(remove_knot) X(refine) \
  X(clamp_ends) X(deviation) X(approximate) X(offset) \
  /* curves_meet.c */ \
  X(intersect)
// clang-format on

#define X(name) bool cag_bsplines_##name(CagCall *call, CagValue *result);
CAG_BSPLINE_FUNCTIONS(X)
#undef X

#endif
