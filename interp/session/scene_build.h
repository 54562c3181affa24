// From the values that a script shows to a scene.

#ifndef CAG_INTERP_SESSION_SCENE_BUILD_H
#define CAG_INTERP_SESSION_SCENE_BUILD_H

#include "interp/scene/scene.h"
#include "interp/vm/vm.h"

// Takes lists and groups apart into items, cameras, lights and settings. What nobody named is named
// after the definition to which the shown expression leads (lead.h), else by its kind ("curve",
// "box" ...); names are unique. The scene has neither automatic
// camera nor studio light yet: see cag_scene_complete. False: error set (E0327 for a value that
// cannot be shown), and *out is empty.
bool cag_scene_from_values(CagVm *vm, const CagShown *shown, size_t n, CagScene *out);

#endif
