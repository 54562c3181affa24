// The light that comes along a ray.

#ifndef CAG_INTERP_RENDER_PREVIEW_SHADE_H
#define CAG_INTERP_RENDER_PREVIEW_SHADE_H

#include "interp/render/preview_world.h"

// Numbers in [0, 1) that stand for chance: those of sample `index` of a pixel are spread evenly over
// all samples of the pixel.
typedef struct CagPreviewDice {
  uint64_t pixel;
  uint32_t index;     // of the sample
  uint32_t dimension; // number of pairs that were taken
} CagPreviewDice;
// Sets two numbers, a point of the unit square.
void cag_preview_roll(CagPreviewDice *d, double out[2]);

// What a ray of the camera meets first: the light that arrives there from all sides, and the color by
// which a diffuse surface multiplies it.
typedef struct CagPreviewFirst {
  bool met;
  CagColor light, albedo;
  CagVec3 normal;
  double distance;
} CagPreviewFirst;

typedef struct CagPreviewShader {
  const CagPreviewWorld *world;
  bool sky_light; // see preview.h
  int samples;    // of a pixel
  bool sketch;    // lights are points, and light from everywhere is a constant
  CagCrossings work;
  CagPreviewDice dice;
  CagPreviewFirst first;
} CagPreviewShader;

// Finds the light that comes from where the ray points. `depth` is the number of reflections that
// led to it, 0 for a ray of the camera.
CagStatus cag_preview_light(CagPreviewShader *s, const CagRay *ray, int depth, double weight,
                            CagColor *out, CagError *err);

#endif
