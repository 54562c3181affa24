// Common points of two surfaces: where they cross, and where they touch along a curve.

#ifndef CAG_GEOM_MEET_MEET_PLACE_H
#define CAG_GEOM_MEET_MEET_PLACE_H

#include "geom/meet/meet_seed.h"

// Two points coincide if they are closer than this fraction of the size of both surfaces.
#define CAG_MARCH_SAME 1e-11
// Sine of the angle of the normals below which the surfaces touch.
#define CAG_MARCH_TOUCH 1e-6

typedef struct CagMarchTangent {
  CagVec3 p, du, dv, normal;
} CagMarchTangent;

// Evaluates the partials of side k up to the given order, like cag_surface_eval, on the node's
// patch.
bool cag_march_partials(CagMarch *m, int k, const CagMarchNode *node, int order, CagVec3 *out);
// The tangent plane of side k at the node, on the node's patch.
bool cag_march_look(CagMarch *m, int k, const CagMarchNode *node, CagMarchTangent *out);
// Moves the parameters so that the point comes to x, to first order.
void cag_march_move(CagMarch *m, int k, const CagMarchTangent *t, CagVec3 x, CagMarchNode *node);
// Whether the node lies within the outline of side k, or of both sides.
bool cag_march_belongs_to(CagMarch *m, int k, const CagMarchNode *node, bool *out);
bool cag_march_belongs(CagMarch *m, const CagMarchNode *node);

// Values for the `locate` of a march.
CagMarchFound cag_march_locate_crossing(CagMarch *m, CagVec3 q, CagVec3 n, CagVec3 along,
                                        CagMarchNode *node);
CagMarchFound cag_march_locate_touch(CagMarch *m, CagVec3 q, CagVec3 n, CagVec3 along,
                                     CagMarchNode *node);

// Nearly parallel surfaces may intersect in a small loop around an extremum of the gap between
// them. Estimates up to 4 points of such loops within the reach, and returns their number.
size_t cag_march_find_round(CagMarch *m, const CagMarchNode *seed, double reach,
                            CagMarchNode out[4]);
// Surfaces that cross at a small angle may cross again close to the node. Estimates that location
// from the curvatures. Returns false if there is none within the reach, or if the status is set.
bool cag_march_find_twin(CagMarch *m, const CagMarchNode *node, double reach, CagMarchNode *out);

#endif
