// Cores of curves and surfaces: points and segments at a constant distance.

#ifndef CAG_GEOM_SURFACE_CORE_H
#define CAG_GEOM_SURFACE_CORE_H

#include "geom/surface/surface.h"

// A segment, or a point if both ends are equal. The distance of every point of the curve or
// surface from the segment is `radius`, but for rounding.
typedef struct CagCore {
  CagVec3 p[2];
  double radius;
} CagCore;

// Gets the core of a curve over [a, b], where it is smooth: the center of a circle, the axis of a
// helix, a straight piece itself with the radius 0. Returns false for another curve.
bool cag_curve_core(const CagCurve *c, double a, double b, CagCore *out);

// Gets the core of a surface whose u is in [u_low, u_high], where it is smooth: the center of a
// sphere, the axis of a cylinder. Returns false for another surface.
bool cag_surface_core(const CagSurface *s, double u_low, double u_high, CagCore *out);

// Returns true if the surface is flat where u is in [u_low, u_high], and its edges there are
// straight.
bool cag_surface_is_straight(const CagSurface *s, double u_low, double u_high);

#endif
