// Where a curve meets a surface: all places, crossings and touches.

#ifndef CAG_GEOM_MEET_MEET_CURVE_H
#define CAG_GEOM_MEET_MEET_CURVE_H

#include "geom/surface/surface.h"

typedef struct CagSurfaceMeeting {
  double t, u, v;
  CagVec3 point;
  int multiplicity; // 1: it crosses; the order of contact where it touches
} CagSurfaceMeeting;

// Ascending by t; *out is malloc'd (NULL where there are none). Seams and joints count once. Fails
// with "overlap" where the curve runs within the surface.
CagStatus cag_surface_intersect_curve(const CagSurface *s, const CagCurve *c,
                                      CagSurfaceMeeting **out, size_t *n, CagError *err);

#endif
