// Intersections of curves with planes and with each other: all crossings and tangencies.

#ifndef CAG_GEOM_INTERSECT_H
#define CAG_GEOM_INTERSECT_H

#include "geom/curve/curve.h"

typedef struct CagMeeting {
  double t, t2; // parameters on the first and the second curve; t2 is 0 with a plane
  CagVec3 point;
  int multiplicity; // 1: they cross; else the order of contact
} CagMeeting;

// Ascending by t, each intersection once: points within 1e-9 of the size are merged. *out is
// malloc'd (NULL if there are none). The seam of a closed curve counts once, at its start. Fails
// with "overlap" if the two share more than isolated points.
CagStatus cag_curve_intersect_plane(const CagCurve *c, const CagPlane *plane, CagMeeting **out,
                                    size_t *n, CagError *err);
CagStatus cag_curve_intersect(const CagCurve *a, const CagCurve *b, CagMeeting **out, size_t *n,
                              CagError *err);

#endif
