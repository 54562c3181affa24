// The curves in which two surfaces meet.

#ifndef CAG_GEOM_MEET_MEET_SURFACE_H
#define CAG_GEOM_MEET_MEET_SURFACE_H

#include "geom/meet/section.h"

// The curves are added to the list, joined where they meet end to end: lines and conics where they
// are such, else cubics within the tolerance (0: a millionth of the size). Where the surfaces only
// touch at a point there is none. Loops smaller than a 50th of the smaller surface are found by a
// place within them where the surfaces are parallel; of several that lie closer together than that,
// some may be missed. Fails with "overlap" where they share a piece, "sizes-apart" where one is a
// thousand times larger.
//
//   interrupt  NULL, or: not 0 stops with CAG_E_CALLBACK
CagStatus cag_surface_intersect(const CagSurface *a, const CagSurface *b, double tolerance,
                                const volatile int *interrupt, CagCurveList *out, CagError *err);
// Finds only the curves along which the surfaces touch. Surfaces that share a piece have none
// there.
CagStatus cag_surface_touches(const CagSurface *a, const CagSurface *b, double tolerance,
                              const volatile int *interrupt, CagCurveList *out, CagError *err);

#endif
