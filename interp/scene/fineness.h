// How fine the meshes of items are.
//
// The tolerance of an item is its own, or that of the scene. If neither is set, that of a picture
// is a quarter of a pixel at the part of the item that is nearest to the camera. Otherwise it
// follows the size of all that is shown. Both are rounded down to a power of two, so that meshes
// remain the same while a param, a film, or a camera changes the size slightly. Small items are
// meshed finely enough to keep their shape.

#ifndef CAG_INTERP_SCENE_FINENESS_H
#define CAG_INTERP_SCENE_FINENESS_H

#include "interp/scene/scene.h"

// Returns the default tolerance of a scene with these bounds, in mm; 0: they are empty or a point.
double cag_usual_tolerance(const CagBounds *bounds);
// Bounds that contain all items but grounds and unbounded solids, cheap to compute.
CagBounds cag_scene_reach(const CagScene *s);
// Returns the tolerance of the item's mesh; 0: by the size of the item. Notes it for the host.
double cag_item_tolerance(const CagScene *s, const CagItem *item);
// Returns the tolerance and the limits of the item's mesh.
CagTessellation cag_item_fineness(const CagScene *s, const CagItem *item);

#endif
