// Functions of the scene's table (scene.c), by the file that holds them.

#ifndef CAG_INTERP_BUILTIN_SCENE_H
#define CAG_INTERP_BUILTIN_SCENE_H

#include "interp/builtin/shapes.h"
#include "interp/scene/scene.h"

// clang-format off
#define CAG_SCENE_FUNCTIONS(X) \
  /* scene_stage.c */ \
  X(camera) X(sun) X(point_light) X(spot_light) X(area_light) X(sky) X(background) X(ground) \
  /* scene_say.c */ \
  X(material) X(color) X(named) X(tolerance) X(hidden) X(group) X(line_style)
// clang-format on

#define X(name) bool cag_scenes_##name(CagCall *call, CagValue *result);
CAG_SCENE_FUNCTIONS(X)
#undef X

// A color from a text or [r, g, b]; `what` names it in messages. The argument is where it was
// given.
bool cag_color_read(CagCall *call, int argument, const char *what, CagValue v, CagColor *out);
CagValue cag_color_value(CagVm *vm, CagColor c);

#endif
