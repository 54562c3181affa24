// The procedural patterns of materials: wood, marble, concrete, and clay, as the POV-Ray source has
// them (interp/formats/pov_material.c). The noise is not POV-Ray's, so the grain is another one; its
// contrast and its size are the same.

#ifndef CAG_INTERP_RENDER_PREVIEW_PATTERN_H
#define CAG_INTERP_RENDER_PREVIEW_PATTERN_H

#include "interp/scene/scene.h"

typedef struct CagPreviewPattern {
  const char *name;
  // The color of the material at a point of the pattern.
  CagColor (*color)(const CagMaterial *m, CagVec3 at);
  // The unit normal of the bumpy surface, whose mean normal is given; NULL: without bumps.
  CagVec3 (*bumps)(const CagMaterial *m, CagVec3 at, CagVec3 normal);
} CagPreviewPattern;

// The pattern of a material, or NULL.
const CagPreviewPattern *cag_preview_find_pattern(const CagMaterial *m);

#endif
