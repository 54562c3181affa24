// The point of a shape's boundary nearest to a given point.

#ifndef CAG_GEOM_RAY_NEAREST_H
#define CAG_GEOM_RAY_NEAREST_H

#include "geom/ray/caster.h"

typedef struct CagNearest {
  bool found;      // within the limit
  bool certain;    // otherwise the distance is only a lower bound, and the point is not set
  double distance; // 0 or more, also inside
  CagVec3 point;
} CagNearest;

// Finds the nearest point, if it is at most `most` away. Primitives and quadrics are solved
// directly, meshes by a hierarchy of boxes, faces by cag_surface_closest. The boundary of a set
// operation consists of parts of the boundaries of its operands: the nearest point of these decides
// if it is on the boundary of the result. If it is not, the result is not certain. Like
// cag_surface_closest, it works on the thread that owns the shapes only. `work` is as for
// cag_caster_first.
CagStatus cag_caster_closest(const CagCaster *c, CagVec3 p, double most, CagCrossings *work,
                             CagNearest *out, CagError *err);

// Finds the point nearest to p from that of a mesh, whose distance from the boundary is at most
// `reach`. It is certain if it was found.
CagStatus cag_caster_polish(const CagCaster *c, CagVec3 p, CagVec3 start, double reach,
                            CagCrossings *work, CagNearest *out, CagError *err);

// The distance of a point from a box: 0 inside.
double cag_bounds_distance(const CagBounds *b, CagVec3 p);

#endif
