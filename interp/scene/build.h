// From the values that a script shows to a scene.

#ifndef CAG_INTERP_SCENE_BUILD_H
#define CAG_INTERP_SCENE_BUILD_H

#include "base/source.h"
#include "interp/scene/scene.h"
#include "interp/vm/value.h"
#include "lang/ast.h"

// One value of a `show` statement, in the order of the file.
typedef struct CagShown {
  CagValue value;
  const CagExpr *expr; // NULL: not of a script
  const CagSource *source;
  CagSpan span;
} CagShown;

// Takes lists and groups apart into items, cameras, lights and settings. What nobody named is named
// after the definition to which the shown expression leads (lead.h), else by its kind ("curve",
// "box" ...); names are unique. The scene has neither automatic
// camera nor studio light yet: see cag_scene_complete. False: error set (E0327 for a value that
// cannot be shown), and *out is empty.
bool cag_scene_from_values(CagVm *vm, const CagShown *shown, size_t n, CagScene *out);

// A value that can be shown: a shape, camera, light, setting, robot, or a list of these.
bool cag_value_is_shown(CagVm *vm, CagValue v);

#endif
