// The procedural patterns of materials: wood, marble, concrete, and clay, as the POV-Ray source has
// them (interp/formats/pov_material.c). The noise is not POV-Ray's, so the grain is another one.

#ifndef CAG_INTERP_RENDER_PREVIEW_PATTERN_H
#define CAG_INTERP_RENDER_PREVIEW_PATTERN_H

#include "interp/scene/scene.h"

// The color of a material at a point of the world.
CagColor cag_preview_pattern(const CagMaterial *m, CagVec3 at);

#endif
