// Simplification: fewer vertices or knots, within a distance.

#ifndef CAG_GEOM_SIMPLIFY_H
#define CAG_GEOM_SIMPLIFY_H

#include "geom/curve/region.h"

// A curve of the same kind with fewer data, within the tolerance of the curve. Polylines, and the
// straight parts of joined curves, keep some of their vertices (Douglas and Peucker 1973), NURBS
// lose knots; other curves are returned unchanged. The ends stay; a closed polyline keeps at least
// three vertices.
CagStatus cag_curve_simplify(const CagCurve *c, double tolerance, CagCurve **out, CagError *err);

// The region with fewer vertices on the straight parts of its loops. Vertices stay if loops would
// cross, touch, or change sides without them, so the loops and their nesting are the same.
CagStatus cag_region_simplify(const CagRegion *r, double tolerance, CagRegion **out, CagError *err);

#endif
