// Regions: parts of the plane bounded by closed plane curves, with holes.
//
// Invariant: outer boundaries are counter-clockwise, holes clockwise; loops do not cross; each hole
// lies in an outer loop. Reference counted.
//
// The empty region has no loops. Its area and perimeter are 0; its bounds and centroid fail with
// "empty-shape".

#ifndef CAG_GEOM_REGION_H
#define CAG_GEOM_REGION_H

#include "geom/curve/curve.h"
#include "geom/curve/joins.h"

typedef struct CagRegion {
  int references;
  size_t count;     // loops; loop 0 is the first outer one
  CagCurve **loops; // closed, dimension 2
  size_t *outer; // for a hole: index of the outer loop around it; for an outer loop: its own index
} CagRegion;

// outer: a closed plane curve. holes: closed plane curves inside it, pairwise disjoint. Both are
// checked: "region-not-closed", "region-crossing", "hole-outside", with the index.
CagStatus cag_region_new(const CagCurve *outer, CagCurve *const *holes, size_t hole_count,
                         CagRegion **out, CagError *err);
// The region bounded by any set of non-crossing closed loops (even-odd rule).
CagStatus cag_region_from_loops(CagCurve *const *loops, size_t n, CagRegion **out, CagError *err);
CagStatus cag_region_empty(CagRegion **out, CagError *err);
bool cag_region_is_empty(const CagRegion *r);
CagRegion *cag_region_retain(const CagRegion *r);
// Adds the loops of the region to a digest.
void cag_region_digest(const CagRegion *r, CagDigest *d);
void cag_region_release(CagRegion *r);

CagStatus cag_region_rectangle(double w, double h, double radius, CagRegion **out,
                               CagError *err); // centered at the origin
CagStatus cag_region_regular_polygon(size_t n, double radius, CagRegion **out,
                                     CagError *err); // first vertex on +x
// centroid may be NULL.
CagStatus cag_region_area(const CagRegion *r, double *area, CagVec3 *centroid, CagError *err);
// The integrals of x x, x y, and y y over the region, with x and y relative to the centroid.
CagStatus cag_region_second_moments(const CagRegion *r, double *area, CagVec3 *center, double *xx,
                                    double *xy, double *yy, CagError *err);
CagStatus cag_region_perimeter(const CagRegion *r, double *out, CagError *err);
CagStatus cag_region_bounds(const CagRegion *r, CagBounds *out, CagError *err);
CagStatus cag_region_contains(const CagRegion *r, CagVec3 p, bool *out,
                              CagError *err); // boundary points are inside
// The image under a planar transform; reflections preserve the invariant.
CagStatus cag_region_transform(const CagRegion *r, const CagTransform *t, CagRegion **out,
                               CagError *err);

typedef enum CagRegionOp {
  CAG_REGION_UNION,
  CAG_REGION_DIFFERENCE, // the first minus all others
  CAG_REGION_INTERSECTION
} CagRegionOp;

// The loops of the result consist of pieces of the given loops, cut where these cross, each keeping
// its kind of curve; loops without crossings are reused. Points closer than 1e-9 of the total size
// are identified, so slivers thinner than that vanish. Pieces that touch in a point stay separate
// loops. The result may be the empty region. Fails with "region-undecided" if boundaries run so
// close to each other that rounding hides their order.
CagStatus cag_region_boolean(CagRegionOp op, const CagRegion *a, const CagRegion *b,
                             CagRegion **out, CagError *err);
// The same for n >= 1 regions at once.
CagStatus cag_region_combine(CagRegionOp op, const CagRegion *const *regions, size_t n,
                             CagRegion **out, CagError *err);

// The points at distance at most d from the region (d > 0), or the points of the region at distance
// at least -d from its boundary (d < 0): holes shrink or grow accordingly. Corners are rounded by
// arcs. Offsets of lines and circles are exact, others within the tolerance. The result may be the
// empty region. Fails like the set operations, and with "too-far".
CagStatus cag_region_offset(const CagRegion *r, double d, double tolerance, CagRegion **out,
                            CagError *err);
// The same with other corners.
CagStatus cag_region_offset_joined(const CagRegion *r, double d, double tolerance,
                                   const CagJoins *joins, CagRegion **out, CagError *err);

// --- Internal ---

// A region of these loops, outer ones counter-clockwise, holes clockwise; outer[i] as in CagRegion.
// Takes ownership of the loops even if it fails.
CagStatus cag_region_take(CagCurve **loops, const size_t *outer, size_t n, CagRegion **out,
                          CagError *err);

#endif
