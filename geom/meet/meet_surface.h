// The intersection curves of two surfaces.

#ifndef CAG_GEOM_MEET_MEET_SURFACE_H
#define CAG_GEOM_MEET_MEET_SURFACE_H

#include "geom/meet/section.h"

// Adds the intersection curves to the list, joined end to end: exact lines and conics if possible,
// and cubics within the tolerance otherwise (0: a millionth of the size). Isolated points of
// contact are not curves. Loops smaller than a 50th of the smaller surface are found from a point
// inside them at which the surfaces are parallel. If several loops are closer together than that,
// some may be missed. Fails with "overlap" if the surfaces coincide in some part, and with
// "sizes-apart" if one is a thousand times larger.
//
//   interrupt  nonzero stops with CAG_E_CALLBACK; may be NULL
CagStatus cag_surface_intersect(const CagSurface *a, const CagSurface *b, double tolerance,
                                const volatile int *interrupt, CagCurveList *out, CagError *err);
// Finds only the curves along which the surfaces touch, except where surfaces coincide.
CagStatus cag_surface_touches(const CagSurface *a, const CagSurface *b, double tolerance,
                              const volatile int *interrupt, CagCurveList *out, CagError *err);

#endif
