// Isophotes: curves on a surface along which its normal keeps one angle to a direction.

#ifndef CAG_GEOM_MEET_ISOPHOTE_H
#define CAG_GEOM_MEET_ISOPHOTE_H

#include "geom/meet/section.h"

// The curves where the unit normal along S_u x S_v and the unit direction have this cosine are
// added to the list, as exact and in as many pieces as sections (cag_surface_section). Where a
// whole patch has that angle, a plane or a part of a cylinder, there are none.
CagStatus cag_surface_isophote(const CagSurface *s, CagVec3 direction, double cosine,
                               double tolerance, CagCurveList *out, CagError *err);

#endif
