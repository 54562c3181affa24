// Solids as unions of convex bodies and tori.

#ifndef CAG_GEOM_SOLID_CONVEX_LIST_H
#define CAG_GEOM_SOLID_CONVEX_LIST_H

#include "geom/distance/convex.h"
#include "geom/solid/solid.h"

typedef struct CagConvexList {
  CagConvex *items;
  CagBounds *bounds; // of each
  size_t n, capacity, bounds_capacity;
  CagVec3 **points; // owned: those of the hulls
  size_t point_lists, list_capacity;
} CagConvexList;

// Adds the exact bodies that a solid is the union of, if it is a primitive, an extrusion of a
// polygon without twist and scale, or a union of such solids. Otherwise *known is false, and
// nothing is added. Primitives under projective maps are not known, nor are tori under maps that
// are not similarities.
CagStatus cag_solid_add_convex(const CagSolid *s, CagConvexList *list, bool *known, CagError *err);
void cag_convex_list_free(CagConvexList *list);

// Computes the distance of the unions of two lists, which are not empty, as cag_convex_distance
// does, and its points (NULL: not wanted). *certain is false if one of the distances could not be
// determined.
CagStatus cag_convex_list_distance(const CagConvexList *a, const CagConvexList *b, double *out,
                                   CagVec3 points[2], bool *certain, CagError *err);

#endif
