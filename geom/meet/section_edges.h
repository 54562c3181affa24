// The parts of a plane section that are not found by tracing crossings.

#ifndef CAG_GEOM_MEET_SECTION_EDGES_H
#define CAG_GEOM_MEET_SECTION_EDGES_H

#include "geom/meet/section.h"

// Adds the whole edges of the surface and its creases.
CagStatus cag_surface_lines(const CagSurface *s, CagCurveList *out, CagError *err);
// Adds the pieces of the edges and creases that lie in the plane.
CagStatus cag_section_edges(const CagSurface *s, const CagPlane *plane, double size,
                            CagCurveList *out, CagError *err);
// Adds the curves along which the plane touches the surface. `box` is the bounding box of the
// surface.
CagStatus cag_section_touches(const CagSurface *s, const CagPlane *plane, const CagBounds *box,
                              double tolerance, CagCurveList *out, CagError *err);
// Adds the circles in which a bitangent plane cuts a torus (Villarceau circles), or ellipses for a
// stretched torus. The surface may be a whole torus or a part of one, in any form. *is is set if
// the plane is of this kind.
CagStatus cag_section_villarceau(const CagSurface *s, const CagPlane *plane, double size,
                                 CagCurveList *out, bool *is, CagError *err);
// Drops curves with index `first` or higher that run along another curve within `near`. Of two such
// curves, the later one is dropped.
CagStatus cag_curve_list_drop_covered(CagCurveList *list, size_t first, double near, CagError *err);

#endif
