// Surfaces swept by a section under a motion.

#ifndef CAG_GEOM_SWEPT_H
#define CAG_GEOM_SWEPT_H

#include "geom/surface/motion.h"

// u is the section's parameter, v the motion's. The section's x and y follow the motion's x and y
// axes; for a section in space z follows its z axis (not around corners: "section-not-plane").
CagStatus cag_surface_sweep(const CagCurve *section, const CagMotion *motion, CagSurface **out,
                            CagError *err);
// A circle whose radius varies along the path.
CagStatus cag_surface_tube_along(const CagCurve *path, const CagAlong *radius, CagSurface **out,
                                 CagError *err);
// The center line of a tube of constant radius without corners. A point of the tube has this
// distance from the point of the line with the same v. Returns false for another surface.
bool cag_surface_tube_view(const CagSurface *s, const CagCurve **center, double *radius);
// Section and motion of a sweep or tube; false: another kind.
bool cag_surface_swept_view(const CagSurface *s, const CagCurve **section,
                            const CagMotion **motion);
// An extrusion, with its section in space.
typedef struct CagTwisted {
  const CagCurve *section;
  CagVec3 along;
  double twist, scale; // at v = 1
} CagTwisted;
bool cag_surface_twisted_view(const CagSurface *s, CagTwisted *out); // false: another kind

#endif
