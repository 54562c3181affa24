// A function of a surface on a rectangle of its parameters, without breaks inside where it minds
// them.

#ifndef CAG_GEOM_MEET_LEVEL_PATCH_H
#define CAG_GEOM_MEET_LEVEL_PATCH_H

#include "geom/meet/section.h"

typedef struct CagLevelPatch {
  const CagSurface *s;
  const CagLevel *level;
  double lo[2], hi[2];
  bool collapsed[2][2]; // by direction, lower and upper edge: no normal anywhere on it
  bool formula;         // partials are taken beside the place
} CagLevelPatch;

CagStatus cag_patch_open(const CagSurface *s, const CagLevel *level, const double lo[2],
                         const double hi[2], CagLevelPatch *out, CagError *err);
// The value and, where they are not NULL, the gradient and the partials of order 1 (as
// cag_surface_eval gives them). Values of sided functions are always finite.
CagStatus cag_patch_value(const CagLevelPatch *p, double u, double v, double *f, double *gradient,
                          CagVec3 *partials, CagError *err);
// Whether the place lies on a collapsed edge.
bool cag_patch_is_collapsed(const CagLevelPatch *p, double u, double v);
// Whether it is so near to one that values may be rounding as beside it.
bool cag_patch_is_beside(const CagLevelPatch *p, double u, double v);
// How large values are that are nothing but rounding: what the function jumps over steps too short
// for it to change. `inner`: away from the edges; `most`: anywhere, beside collapsed edges too.
CagStatus cag_patch_rounding(const CagLevelPatch *p, double *inner, double *most, CagError *err);

#endif
