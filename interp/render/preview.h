// The built-in renderer: pictures of a scene in a fraction of a second.
//
// It shades surfaces as the POV-Ray source that the exporter writes does, so that its pictures look
// like POV-Ray's: a diffuse part, highlights of the surface and of a clear coat, mirror reflection
// by Fresnel's equations, and refraction. In a sketch, light from everywhere is a constant. With
// samples, lights have their sizes, and light from the sky is found by paths of random directions
// (Kajiya 1986).
//
// Numbers that stand for chance depend only on the pixel and the number of the sample. Pictures are
// therefore the same for any number of threads.

#ifndef CAG_INTERP_RENDER_PREVIEW_H
#define CAG_INTERP_RENDER_PREVIEW_H

#include "interp/render/image.h"
#include "interp/scene/scene.h"

typedef struct CagPreviewOptions {
  // The light from everywhere is that of the sky, and is reflected between surfaces, as in POV-Ray's
  // final pictures; else it is a constant, as it is for POV-Ray where lights are shown.
  bool sky_light;
  int samples; // of light per pixel; 0: a sketch, with smooth edges but without light from others
  int region_x, region_y, region_width, region_height; // width 0: the whole picture
  // Called after each round of the picture with the fraction that is done. May be NULL.
  void (*progress)(void *user, double percent, const char *phase);
  void *progress_user;
} CagPreviewOptions;

// Renders a picture of the camera's size, or the region of it. *out has the channels R, G, B.
// *finished is false if the work was stopped; the picture then has the rounds that were complete,
// and the status is CAG_OK if there was one at least.
CagStatus cag_preview_render(const CagScene *scene, const CagCamera *camera,
                             const CagPreviewOptions *options, CagImage *out, bool *finished,
                             CagError *err);

#endif
