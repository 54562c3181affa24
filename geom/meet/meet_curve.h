// Intersections of a curve with a surface: all crossings and tangencies.

#ifndef CAG_GEOM_MEET_MEET_CURVE_H
#define CAG_GEOM_MEET_MEET_CURVE_H

#include "geom/surface/surface.h"

typedef struct CagSurfaceMeeting {
  double t, u, v;
  CagVec3 point;
  int multiplicity; // 1: it crosses; else the order of contact
} CagSurfaceMeeting;

// Ascending by t; *out is malloc'd (NULL if there are none). Seams and joints count once. Fails
// with "overlap" if a part of the curve lies in the surface.
CagStatus cag_surface_intersect_curve(const CagSurface *s, const CagCurve *c,
                                      CagSurfaceMeeting **out, size_t *n, CagError *err);

#endif
