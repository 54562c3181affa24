// Places that two surfaces have in common: where they cross, and where they touch along a curve.

#ifndef CAG_GEOM_SURFACE_MEET_PLACE_H
#define CAG_GEOM_SURFACE_MEET_PLACE_H

#include "geom/surface/meet_seed.h"

// Part of the size of both surfaces below which two points are one.
#define CAG_MARCH_SAME 1e-11
// Sine of the angle of the normals below which the surfaces touch.
#define CAG_MARCH_TOUCH 1e-6

typedef struct CagMarchTangent {
  CagVec3 p, du, dv, normal;
} CagMarchTangent;

// Partials of side k up to the order, as cag_surface_eval gives them, seen from the node's patch.
bool cag_march_partials(CagMarch *m, int k, const CagMarchNode *node, int order, CagVec3 *out);
// What side k is like at the node, seen from the node's patch.
bool cag_march_look(CagMarch *m, int k, const CagMarchNode *node, CagMarchTangent *out);
// Moves the parameters so that the point comes to x, as far as the tangent plane tells.
void cag_march_move(CagMarch *m, int k, const CagMarchTangent *t, CagVec3 x, CagMarchNode *node);
// Whether the node lies within the outline of side k, and of both.
bool cag_march_belongs_to(CagMarch *m, int k, const CagMarchNode *node, bool *out);
bool cag_march_belongs(CagMarch *m, const CagMarchNode *node);

// Functions to stand in `locate` of a march.
CagMarchFound cag_march_locate_crossing(CagMarch *m, CagVec3 q, CagVec3 n, CagVec3 along,
                                        CagMarchNode *node);
CagMarchFound cag_march_locate_touch(CagMarch *m, CagVec3 q, CagVec3 n, CagVec3 along,
                                     CagMarchNode *node);

#endif
