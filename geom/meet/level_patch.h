// A function on a surface, restricted to a rectangle of parameters without breaks that matter to
// it.

#ifndef CAG_GEOM_MEET_LEVEL_PATCH_H
#define CAG_GEOM_MEET_LEVEL_PATCH_H

#include "geom/meet/section.h"

typedef struct CagLevelPatch {
  const CagSurface *s;
  const CagLevel *level;
  double lo[2], hi[2];
  bool collapsed[2][2]; // by direction, lower and upper edge: no normal anywhere on the edge
  bool formula;         // partials are taken next to the point
} CagLevelPatch;

CagStatus cag_patch_open(const CagSurface *s, const CagLevel *level, const double lo[2],
                         const double hi[2], CagLevelPatch *out, CagError *err);
// The value and, unless NULL, the gradient and the partials of order 1 (as from cag_surface_eval).
// Values of sided functions are always finite.
CagStatus cag_patch_value(const CagLevelPatch *p, double u, double v, double *f, double *gradient,
                          CagVec3 *partials, CagError *err);
// Whether the point lies on a collapsed edge.
bool cag_patch_is_collapsed(const CagLevelPatch *p, double u, double v);
// Whether the point is so close to a collapsed edge that values are as noisy as next to it.
bool cag_patch_is_beside(const CagLevelPatch *p, double u, double v);
// Magnitude of the rounding errors of values, estimated by the jumps of the function over steps too
// short for it to change. `inner`: away from the edges; `most`: anywhere, including next to
// collapsed edges.
CagStatus cag_patch_rounding(const CagLevelPatch *p, double *inner, double *most, CagError *err);

#endif
