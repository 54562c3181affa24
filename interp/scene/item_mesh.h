// Curves as tubes, for drawing: what cag_item_mesh and engines with tubes of their own share.

#ifndef CAG_INTERP_SCENE_ITEM_MESH_H
#define CAG_INTERP_SCENE_ITEM_MESH_H

#include "interp/scene/scene.h"

// The radius a curve is drawn with: its own, or by the size of the scene.
double cag_item_line_radius(const CagScene *s, const CagItem *item);

// A closed mesh around the curve: round at corners, flat at ends; in dashes of this length with
// gaps as long where dash > 0. The curve is followed to a part of the radius or the tolerance,
// whichever is finer.
CagStatus cag_curve_tube_mesh(const CagCurve *c, double radius, double dash,
                              const CagTessellation *how, CagMesh **out, CagError *err);

// The materials of an item and its labels as numbers in the scene: each once, ascending. *out is
// malloc'd; it is NULL after a failure.
CagStatus cag_item_materials(const CagItem *item, size_t **out, size_t *count, CagError *err);

// The triangles of an item's mesh that have a material of the scene, with the vertices that they
// need; without triangles where there are none.
CagStatus cag_item_mesh_of(const CagItem *item, const CagMesh *m, size_t material, CagMesh **out,
                           CagError *err);

#endif
