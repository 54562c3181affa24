// The sky of a scene, as the built-in renderer sees it.

#ifndef CAG_INTERP_RENDER_PREVIEW_SKY_H
#define CAG_INTERP_RENDER_PREVIEW_SKY_H

#include "interp/render/image.h"
#include "interp/scene/scene.h"

typedef struct CagPreviewSky {
  const CagScene *scene;
  CagImage image; // a panorama, or empty
  const float *rgb[3];
  bool lights; // the sky is a source of light
} CagPreviewSky;

// Reads the panorama, if the scene has one.
CagStatus cag_preview_sky_load(const CagScene *s, CagPreviewSky *out, CagError *err);
void cag_preview_sky_free(CagPreviewSky *sky); // also of a zeroed one

// The light of the sky in a direction, or the background if the scene has no sky.
//
// A panorama shows +X at its left and right edges, +Y at a quarter of its width, and Z upward, as
// the map of POV-Ray's source does (interp/formats/pov_stage.c). Between the centers of its pixels,
// colors are interpolated linearly.
CagColor cag_preview_sky_color(const CagPreviewSky *sky, CagVec3 direction);

#endif
