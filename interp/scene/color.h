// Names of colors, for messages that suggest the nearest one.

#ifndef CAG_INTERP_SCENE_COLOR_H
#define CAG_INTERP_SCENE_COLOR_H

#include "interp/scene/scene.h"

// The CSS names in alphabetical order.
const char *const *cag_color_names(size_t *count);

#endif
