// Extrusions with rounded or beveled ends, and rounded boxes and cylinders: without a CAD kernel.

#ifndef CAG_GEOM_SOLID_ROUNDED_H
#define CAG_GEOM_SOLID_ROUNDED_H

#include "geom/solid/solid.h"

// How an end of an extrusion meets its sides.
typedef struct CagRoundedEnd {
  double reach; // radius of the fillet, or width of the chamfer (at 45 degrees); 0: a sharp edge
  bool round;   // fillet
} CagRoundedEnd;

// The region (dimension 2, in z = 0) extruded to z = height, which may be negative. ends[0] is at
// the region, ends[1] at the other end. The sections near an end are the offsets of the region to
// its inside: convex corners of the outline stay sharp, concave ones become arcs.
//
// Fails with "rounding-too-large" if an offset loses a part of the outline, or if both ends
// together are higher than the extrusion.
CagStatus cag_solid_extrude_rounded(const CagRegion *r, double height, const CagRoundedEnd ends[2],
                                    CagSolid **out, CagError *err);

// A box with a corner at the origin, or centered, all of whose edges and corners are rounded. The
// radius is at most half of each size.
CagStatus cag_solid_rounded_box(CagVec3 size, double radius, bool centered, CagSolid **out,
                                CagError *err);

// A cylinder about Z that stands on z = 0, with rounded rims. The fillet is at most the radius, and
// half of the height.
CagStatus cag_solid_rounded_cylinder(double height, double radius, double fillet, CagSolid **out,
                                     CagError *err);

#endif
