// Regions: pieces of the plane bounded by closed plane curves, with holes.
//
// Invariant: outer boundaries run counter-clockwise, holes clockwise; loops do not cross; each hole
// lies in an outer loop. Reference counted.
//
// The empty region has no loops. Its area and perimeter are 0; bounds and a center of area are the
// error "empty-shape".

#ifndef CAG_GEOM_REGION_H
#define CAG_GEOM_REGION_H

#include "geom/curve/curve.h"

typedef struct CagRegion {
  int references;
  size_t count;     // loops; loop 0 is the first outer one
  CagCurve **loops; // closed, dimension 2
  size_t *outer; // for a hole: index of the outer loop around it; for an outer loop: its own index
} CagRegion;

// outer: a closed plane curve; holes likewise, within it and disjoint (checked:
// "region-not-closed", "region-crossing", "hole-outside", with the index).
CagStatus cag_region_new(const CagCurve *outer, CagCurve *const *holes, size_t hole_count,
                         CagRegion **out, CagError *err);
// The region bounded by any set of non-crossing closed loops (even-odd rule).
CagStatus cag_region_from_loops(CagCurve *const *loops, size_t n, CagRegion **out, CagError *err);
CagStatus cag_region_empty(CagRegion **out, CagError *err);
bool cag_region_is_empty(const CagRegion *r);
CagRegion *cag_region_retain(const CagRegion *r);
void cag_region_release(CagRegion *r);

CagStatus cag_region_rectangle(double w, double h, double radius, CagRegion **out,
                               CagError *err); // about the origin
CagStatus cag_region_regular_polygon(size_t n, double radius, CagRegion **out,
                                     CagError *err); // first vertex on +x
// centroid: NULL where it is not wanted.
CagStatus cag_region_area(const CagRegion *r, double *area, CagVec3 *centroid, CagError *err);
// The integrals of x x, x y and y y over the region, x and y from its center of area.
CagStatus cag_region_second_moments(const CagRegion *r, double *area, CagVec3 *center, double *xx,
                                    double *xy, double *yy, CagError *err);
CagStatus cag_region_perimeter(const CagRegion *r, double *out, CagError *err);
CagStatus cag_region_bounds(const CagRegion *r, CagBounds *out, CagError *err);
CagStatus cag_region_contains(const CagRegion *r, CagVec3 p, bool *out,
                              CagError *err); // the boundary belongs to it
// Image under a planar transform; mirrors keep the invariant.
CagStatus cag_region_transform(const CagRegion *r, const CagTransform *t, CagRegion **out,
                               CagError *err);

typedef enum CagRegionOp {
  CAG_REGION_UNION,
  CAG_REGION_DIFFERENCE, // the first less all others
  CAG_REGION_INTERSECTION
} CagRegionOp;

// The loops of the result are pieces of the given loops, cut where these cross, each of its own
// kind; loops that nothing crosses are the given ones. What is one nearer than 1e-9 of the size of
// all counts as one: slivers thinner than that are not there. Pieces that touch in a point stay
// separate loops. Where nothing is left the result is the empty region. Fails with
// "region-undecided" where the boundaries run so close to each other that rounding hides which is
// in front.
CagStatus cag_region_boolean(CagRegionOp op, const CagRegion *a, const CagRegion *b,
                             CagRegion **out, CagError *err);
// The same of n >= 1 regions at once.
CagStatus cag_region_combine(CagRegionOp op, const CagRegion *const *regions, size_t n,
                             CagRegion **out, CagError *err);

// The points at most d away from the region (d > 0), or those of it at least -d away from its
// boundary (d < 0): holes shrink and grow. Corners go round in arcs. The boundaries of lines and
// circles are exact, others within the tolerance. Where nothing is left the result is the empty
// region. Fails as the set operations do, and with "too-far".
CagStatus cag_region_offset(const CagRegion *r, double d, double tolerance, CagRegion **out,
                            CagError *err);

// --- For the files of regions ---

// A region of these loops, outer ones counter-clockwise, holes clockwise; outer[i] as in CagRegion.
// Takes the loops over, whatever it returns.
CagStatus cag_region_take(CagCurve **loops, const size_t *outer, size_t n, CagRegion **out,
                          CagError *err);

#endif
