// Rims: the faces that round or bevel the end of an extrusion along a plane curve.
//
// The curve C has the material on its left; N is its unit normal to the left. A rim starts on the
// side of the extrusion, at the height `foot`, and moves inward by d(v) and on by e(v): along a
// quarter of a circle, d = r (1 - cos) and e = r sin of the angle v pi / 2, or along a straight
// line, d = e = r v. A point is C(t) + d N(t) at the height foot + sense e.
//
// At a convex corner, two rims end in a common edge, the miter: at each v, the parameters at which
// the two curves, moved inward by d, meet.

#ifndef CAG_GEOM_SURFACE_RIM_H
#define CAG_GEOM_SURFACE_RIM_H

#include "geom/surface/surface.h"

typedef struct CagRimProfile {
  double reach;       // r > 0
  bool round;         // a quarter of a circle
  double foot, sense; // sense: 1 upward, -1 downward
} CagRimProfile;

// The miter between the end of one curve and the start of another one: their parameters at equal
// steps of v.
#define CAG_RIM_STEPS 32
typedef struct CagRimMiter {
  CagCurve *curves[2]; // NULL: no miter; the rim ends at the end of its curve
  double at[CAG_RIM_STEPS + 1][2];
} CagRimMiter;

// Follows the miter from the corner. *fits is false, and there is nothing to free, if one of the
// curves is used up before.
CagStatus cag_rim_miter(const CagCurve *before, const CagCurve *after, const CagRimProfile *p,
                        bool *fits, CagRimMiter *out, CagError *err);
void cag_rim_miter_free(CagRimMiter *m);

// Kind "rim": u in 0..1 from the start to the end of the curve (backwards if `p->sense` is -1), v
// in 0..1, with the normal away from the material. start, end: NULL if the rim ends with its curve.
CagStatus cag_surface_rim(const CagCurve *c, const CagRimProfile *p, const CagRimMiter *start,
                          const CagRimMiter *end, CagSurface **out, CagError *err);

#endif
