// Measures of items: bounds, length, area, volume, and what their meshes are.

#ifndef CAG_INTERP_SCENE_ITEM_MEASURE_H
#define CAG_INTERP_SCENE_ITEM_MEASURE_H

#include "interp/scene/scene.h"

// Lengths are in mm, areas in mm2, volumes in mm3. What does not apply to an item is NaN, or unknown.
typedef struct CagItemMeasures {
  CagBounds bounds;
  double length;    // of a curve; of a region, that of all its loops
  double area;      // of a solid or closed mesh, that of its boundary
  double volume;    // of solids, and closed surfaces and meshes
  CagVec3 centroid; // of the volume if there is one, else of the area; NaN: undefined
  bool closed;      // a curve that returns to its start; a shape without boundary edges
  bool exact;       // from formulas and integrals over exact faces, not from a mesh
  bool has_faces;   // the number of faces is known
  size_t faces;     // of a solid; 1 for a surface or region; of a mesh, its triangles
  size_t triangles; // of its mesh within the tolerance; of a curve, 0
} CagItemMeasures;

// Measures an item that is not a ground. Set operations are measured by their mesh within the
// tolerance of the item or scene, or else to 2e-3. An empty shape fails with "empty-shape".
CagStatus cag_item_measure(const CagScene *s, const CagItem *item, CagItemMeasures *out,
                           CagError *err);

// "solid", "mesh", "surface", "region", "curve", or "ground".
const char *cag_item_type(const CagItem *item);
// How it was made: "sphere", "revolution"; of others, the type.
const char *cag_item_kind(const CagItem *item);

#endif
