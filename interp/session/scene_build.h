// Conversion of the values that a script shows to a scene.

#ifndef CAG_INTERP_SESSION_SCENE_BUILD_H
#define CAG_INTERP_SESSION_SCENE_BUILD_H

#include "interp/scene/scene.h"
#include "interp/vm/vm.h"

// Where an item comes from. The shape lives as long as the machine's values do.
typedef struct CagItemSource {
  const CagShape *shape; // NULL: a ground
  size_t shown;          // index of the shown value that contains it
} CagItemSource;
// By the numbers of items.
typedef struct CagItemSources {
  CagItemSource *items;
  size_t count, capacity;
} CagItemSources;

// Splits lists and groups into items, cameras, lights, and settings. An unnamed item is named after
// the definition in its shown expression (lead.h), or else by its kind ("curve", "box" ...). Names
// are unique. Default camera and lights are added later (see cag_scene_complete). Returns false,
// with the error set (E0327 for a value that cannot be shown) and *out empty, on failure. `sources`,
// unless NULL, receives where items come from; free its items.
bool cag_scene_from_values(CagVm *vm, const CagShown *shown, size_t n, CagScene *out,
                           CagItemSources *sources);

#endif
