// Extrusions and revolutions by what they are made of, for programs and files that have such forms.

#ifndef CAG_GEOM_SOLID_FORM_H
#define CAG_GEOM_SOLID_FORM_H

#include "geom/curve/region.h"
#include "geom/solid/solid.h"

// The frame of a flat face made orthonormal and right-handed, and the map of its region into it.
// Fails if the frame is singular.
CagStatus cag_flat_frame(const CagTransform *t, CagTransform *frame, CagTransform *map,
                         CagError *err);
// The region of an extrusion that is neither twisted nor scaled, the frame of its plane, and the
// way that it moves, in world coordinates; false: another solid.
bool cag_prism_of(const CagSolid *s, const CagRegion **region, CagTransform *frame, CagVec3 *along);

// What the sides of a revolution have in common.
typedef struct CagTurnedForm {
  CagTransform frame; // z along the axis, x towards the profile
  double from, to;    // radians
} CagTurnedForm;

// Whether a face is turned about an axis, and how. The profile is in world coordinates.
bool cag_turn_of_face(const CagSurface *face, const CagCurve **profile, CagTurnedForm *out);
// Whether all faces of a solid that are not flat are turned in the same way; their number.
bool cag_turn_of_solid(const CagSolid *s, CagTurnedForm *turn, size_t *sides);
// The profile as a plane curve: its x over the axis, its y along the axis.
CagStatus cag_turn_profile(const CagCurve *profile, const CagTurnedForm *turn, CagCurve **out,
                           CagError *err);

#endif
