// What a plane section of a surface has besides the curves that are traced.

#ifndef CAG_GEOM_SURFACE_SECTION_EDGES_H
#define CAG_GEOM_SURFACE_SECTION_EDGES_H

#include "geom/surface/section.h"

// Adds the edges of the surface and its creases, whole.
CagStatus cag_surface_lines(const CagSurface *s, CagCurveList *out, CagError *err);
// Adds the pieces of the edges and creases that lie in the plane.
CagStatus cag_section_edges(const CagSurface *s, const CagPlane *plane, double size,
                            CagCurveList *out, CagError *err);
// Adds the curves along which the plane touches the surface. `box`: the surface's bounds.
CagStatus cag_section_touches(const CagSurface *s, const CagPlane *plane, const CagBounds *box,
                              double tolerance, CagCurveList *out, CagError *err);
// Adds the circles, or of a stretched torus the ellipses, in which a plane cuts a torus or a part
// of one that it touches twice, in whatever form the surface is given. *is: it is such a plane.
CagStatus cag_section_villarceau(const CagSurface *s, const CagPlane *plane, double size,
                                 CagCurveList *out, bool *is, CagError *err);
// Drops curves from number `first` on that run along another one, to `near`: of two that run along
// each other the later one.
CagStatus cag_curve_list_drop_covered(CagCurveList *list, size_t first, double near, CagError *err);

#endif
