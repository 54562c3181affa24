// Contour lines of curvature: curves on a surface along which it bends alike.

#ifndef CAG_GEOM_MEET_CURVATURE_CONTOUR_H
#define CAG_GEOM_MEET_CURVATURE_CONTOUR_H

#include "geom/meet/section.h"

// Gaussian curvature, the mean of the principal ones, the larger and the smaller of them, signed by
// the normal along S_u x S_v.
typedef enum CagCurvature {
  CAG_CURVATURE_GAUSSIAN,
  CAG_CURVATURE_MEAN,
  CAG_CURVATURE_MAX,
  CAG_CURVATURE_MIN
} CagCurvature;

// The curves where the curvature has the value `level` (1/length, Gaussian 1/length^2) are added to
// the list, as exact and in as many pieces as sections (cag_surface_section).
//
// Between breaks (knots) each patch has its own curvature: where it jumps over the level from one
// to the next there is no curve, and a curve that meets the jump ends there. Towards poles and
// other places without a normal the curvature is continued from beside. Where a whole patch has
// the level there are no curves; `everywhere` tells that all of the surface has it. What merely
// touches the level need not show.
CagStatus cag_surface_curvature_contour(const CagSurface *s, CagCurvature of, double level,
                                        double tolerance, CagCurveList *out, bool *everywhere,
                                        CagError *err);

#endif
