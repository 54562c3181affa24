// What several files of built-ins on scenes share.

#ifndef CAG_INTERP_BUILTIN_SCENE_H
#define CAG_INTERP_BUILTIN_SCENE_H

#include "interp/builtin/shapes.h"
#include "interp/scene/scene.h"

// A color from a text or [r, g, b]; `what` names it in messages. The argument is where it was
// given.
bool cag_color_read(CagCall *call, int argument, const char *what, CagValue v, CagColor *out);
CagValue cag_color_value(CagVm *vm, CagColor c);

#endif
