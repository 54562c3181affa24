// Carriers of faces, recognized from points and normals, for recognized.h.

#ifndef CAG_GEOM_SOLID_RECOGNIZED_FIT_H
#define CAG_GEOM_SOLID_RECOGNIZED_FIT_H

#include "geom/boundary/boundary.h"

// The plane, cylinder, cone, sphere, or torus through n points, with unit normals that may be those
// of facets between the points. The kind of *out is NONE if there is none within `most` of all
// points. The axis of a surface of revolution is that which all normals meet, in the sense of least
// squares of linear line complexes (Pottmann and Randrup 1998).
CagStatus cag_recognized_fit(const CagVec3 *points, const CagVec3 *normals, size_t n, double most,
                             CagCarrier *out, CagError *err);

// A right-handed frame at the origin with the given z axis, a unit vector.
CagTransform cag_recognized_frame(CagVec3 origin, CagVec3 z);

// Whether two analytic carriers are one surface, to within `most` (mm) over a region of this size.
bool cag_recognized_same(const CagCarrier *a, const CagCarrier *b, double size, double most);

#endif
