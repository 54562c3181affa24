// Declarations shared by the built-ins on scenes.

#ifndef CAG_INTERP_BUILTIN_SCENE_H
#define CAG_INTERP_BUILTIN_SCENE_H

#include "interp/builtin/shapes.h"
#include "interp/scene/scene.h"

// Reads a color from a text or [r, g, b]. Messages call it `what` and name the argument.
bool cag_color_read(CagCall *call, int argument, const char *what, CagValue v, CagColor *out);
CagValue cag_color_value(CagVm *vm, CagColor c);

#endif
