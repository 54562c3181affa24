// Curves as tubes, for cag_item_mesh and for renderers with their own tubes.

#ifndef CAG_INTERP_SCENE_ITEM_MESH_H
#define CAG_INTERP_SCENE_ITEM_MESH_H

#include "interp/scene/fineness.h"

// Returns the radius with which a curve is drawn: its own, or one derived from the size of the
// scene.
double cag_item_line_radius(const CagScene *s, const CagItem *item);

// Makes a closed mesh around the curve, with round corners and flat ends. If dash > 0, it consists
// of dashes of this length, with gaps of the same length. The chord tolerance is a fraction of the
// radius or the tolerance, whichever is finer.
CagStatus cag_curve_tube_mesh(const CagCurve *c, double radius, double dash,
                              const CagTessellation *how, CagMesh **out, CagError *err);

// Returns the indices of the materials of an item and its labels, each once, in ascending order.
// *out is allocated with malloc; it is NULL after a failure.
CagStatus cag_item_materials(const CagItem *item, size_t **out, size_t *count, CagError *err);

// Returns the triangles of an item's mesh that have one material of the scene, with the vertices
// that they need. The mesh has no triangles if there are none.
CagStatus cag_item_mesh_of(const CagItem *item, const CagMesh *m, size_t material, CagMesh **out,
                           CagError *err);

#endif
