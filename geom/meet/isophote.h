// Isophotes: curves on a surface along which the normal has a constant angle to a direction.

#ifndef CAG_GEOM_MEET_ISOPHOTE_H
#define CAG_GEOM_MEET_ISOPHOTE_H

#include "geom/meet/section.h"

// Adds the curves on which the unit normal along S_u x S_v and the unit direction have this cosine
// to the list, as accurate and in as many pieces as sections (cag_surface_section). A patch with
// that angle throughout, such as a plane or a part of a cylinder, has no curves.
CagStatus cag_surface_isophote(const CagSurface *s, CagVec3 direction, double cosine,
                               double tolerance, CagCurveList *out, CagError *err);

#endif
