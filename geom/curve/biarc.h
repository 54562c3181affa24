// Curves as sequences of circular arcs with continuous tangents.

#ifndef CAG_GEOM_BIARC_H
#define CAG_GEOM_BIARC_H

#include "geom/curve/curve.h"

typedef struct CagArcStep {
  CagVec3 from, to;
  CagVec3 direction; // of the arc at `from`, of unit length
  double radius;     // positive to the left; infinite: a segment
  double turn;       // of the arc, positive
} CagArcStep;

typedef CagStatus (*CagArcSink)(void *context, const CagArcStep *step, CagError *err);

// Passes arcs and segments within the tolerance of a plane curve to the sink, in order. They are
// tangent to each other, except at corners of the curve and near cusps.
CagStatus cag_curve_arcs(const CagCurve *c, double tolerance, CagArcSink sink, void *context,
                         CagError *err);
// The step as a curve: a line or an arc.
CagStatus cag_arc_step_curve(const CagArcStep *step, CagCurve **out, CagError *err);

#endif
