// Plane sections of solids as regions.

#ifndef CAG_GEOM_MEET_SECTION_REGION_H
#define CAG_GEOM_MEET_SECTION_REGION_H

#include "geom/curve/region.h"
#include "geom/solid/solid.h"

// The section of a solid with the plane z = 0 of a frame, in the frame's x and y. It is the outline
// of the part on the negative side of the plane, as for cag_solid_section.
//
//   frame      orthonormal
//   tolerance  of curves that are neither lines nor conics; 0: a millionth of the size
//
// The section of a set operation is the set operation of the sections of its operands, so that its
// lines and conics are exact. If an operand is unbounded, or rounding hides the order of outlines,
// the section is that of the mesh within the tolerance of `how`.
CagStatus cag_solid_section_region(const CagSolid *s, const CagTransform *frame, double tolerance,
                                   const CagTessellation *how, CagRegion **out, CagError *err);

#endif
