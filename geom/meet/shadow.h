// Shadows: the images of shapes under a parallel projection, as plane regions.

#ifndef CAG_GEOM_MEET_SHADOW_H
#define CAG_GEOM_MEET_SHADOW_H

#include "geom/curve/region.h"
#include "geom/solid/solid.h"

// The image of a shape in the plane z = 0 of a frame, along the frame's z axis, in the frame's x
// and y.
//
//   frame      orthonormal
//   tolerance  of contours that are neither lines nor conics; 0: a millionth of the size
//
// A face is divided by its contour into parts that are seen from the front and from the back. The
// outlines of the parts in front run around each point of the shadow as many times as the line of
// sight enters the shape there, so the shadow is what they run around at all. Lines and conics stay
// exact.
CagStatus cag_surface_shadow(const CagSurface *s, const CagTransform *frame, double tolerance,
                             CagRegion **out, CagError *err);
// The shadow of a union is the union of the shadows. Other set operations, and bodies with contours
// so close to each other that rounding hides their order, have the shadow of their mesh within the
// tolerance of `how`.
CagStatus cag_solid_shadow(const CagSolid *s, const CagTransform *frame, double tolerance,
                           const CagTessellation *how, CagRegion **out, CagError *err);
CagStatus cag_mesh_shadow(const CagMesh *m, const CagTransform *frame, CagRegion **out,
                          CagError *err);

#endif
