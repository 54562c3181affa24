// Contour lines of curvature: curves on a surface with constant curvature.

#ifndef CAG_GEOM_MEET_CURVATURE_CONTOUR_H
#define CAG_GEOM_MEET_CURVATURE_CONTOUR_H

#include "geom/meet/section.h"

// The Gaussian curvature, the mean of the principal curvatures, the larger and the smaller of them,
// signed by the normal along S_u x S_v.
typedef enum CagCurvature {
  CAG_CURVATURE_GAUSSIAN,
  CAG_CURVATURE_MEAN,
  CAG_CURVATURE_MAX,
  CAG_CURVATURE_MIN
} CagCurvature;

// Adds the curves on which the curvature has the value `level` (1/length, Gaussian 1/length^2) to
// the list, as accurate and in as many pieces as sections (cag_surface_section).
//
// Between breaks (knots) each patch has its own curvature. If it jumps across the level from one
// patch to the next, the break itself is not a curve, and a curve that reaches the break ends
// there. At poles and other points without a normal the curvature is extrapolated from nearby
// points. A patch with the constant value `level` has no curves; `everywhere` is set if the whole
// surface has it. Points at which the curvature only touches the level may be missed.
CagStatus cag_surface_curvature_contour(const CagSurface *s, CagCurvature of, double level,
                                        double tolerance, CagCurveList *out, bool *everywhere,
                                        CagError *err);

#endif
