// Cores of curves and surfaces: points and segments at a constant distance.

#ifndef CAG_GEOM_SURFACE_CORE_H
#define CAG_GEOM_SURFACE_CORE_H

#include "geom/surface/surface.h"

// A segment, or a point if both ends are equal. Every point of the curve or surface has the
// distance `radius` from the segment, up to rounding.
typedef struct CagCore {
  CagVec3 p[2];
  double radius;
} CagCore;

// Computes the core of a curve over [a, b], where it must be smooth: the center of a circle, the
// axis of a helix, or a straight piece itself with radius 0. Returns false for other curves.
bool cag_curve_core(const CagCurve *c, double a, double b, CagCore *out);

// Computes the core of a surface with u in [u_low, u_high], where it must be smooth: the center of
// a sphere, or the axis of a cylinder. Returns false for other surfaces.
bool cag_surface_core(const CagSurface *s, double u_low, double u_high, CagCore *out);

// Whether the surface with u in [u_low, u_high] is flat and has straight edges there.
bool cag_surface_is_straight(const CagSurface *s, double u_low, double u_high);

#endif
