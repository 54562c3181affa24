// The curvature of what a picture shows: that of the exact surfaces where there are any.

#ifndef CAG_INTERP_RENDER_PREVIEW_CURVATURE_H
#define CAG_INTERP_RENDER_PREVIEW_CURVATURE_H

#include "geom/ray/ray_curvature.h"
#include "interp/render/preview_world.h"

typedef struct CagPreviewCurvature {
  const CagPreviewWorld *world;
  CagCaster **exact; // by part: of solids that rays meet as meshes; else NULL
} CagPreviewCurvature;

CagStatus cag_preview_curvature_new(const CagPreviewWorld *w, CagPreviewCurvature *out,
                                    CagError *err);
void cag_preview_curvature_free(CagPreviewCurvature *c); // also of a zeroed one

// The curvature where a ray of the camera meets something, relative to the normal of the hit: that
// of the surface, of the rods of a curve, or, for meshes, of the smooth surface that has the normals
// of the corners. NaN where a surface has none.
CagStatus cag_preview_curvature_at(const CagPreviewCurvature *c, const CagRay *ray,
                                   const CagPreviewHit *hit, CagCrossings *work, CagBend *out,
                                   CagError *err);

#endif
