// A scene cut by a plane: what lies on the negative side of it, or the outlines of the cut.

#ifndef CAG_INTERP_SCENE_SECTION_H
#define CAG_INTERP_SCENE_SECTION_H

#include "interp/scene/scene.h"

// How far the shapes of a scene reach along the normal of a plane, measured from the origin. If low
// > high, this is unknown.
typedef struct CagSectionReach {
  double low, high;
} CagSectionReach;

// Removes what lies on the positive side of the plane. Solids and closed meshes become solids whose
// cut is a flat face, in the material of the part that it belongs to. Surfaces, regions, and open
// meshes become meshes, and meshes that show values by colors stay open, so that they keep these.
// Curves become pieces of curves. Shapes that the plane misses stay as they are, grounds as well.
// Names are kept; further pieces get a number, as for shapes of one name. Called before
// cag_scene_complete.
CagStatus cag_scene_cut(CagScene *s, const CagPlane *plane, CagSectionReach *reach, CagError *err);

// Replaces the shapes by the outlines of the cut as plane curves in z = 0, as seen from the positive
// side of the plane: x to the right, y up. Up is Z, or Y if the plane is level. Coordinates are
// measured from the point of the plane next to the origin. Curves and regions that lie in the plane
// are kept, and so are labels in it. The material of curves is that of the shape, or ink if it is
// the default.
//
// Lines and conics are exact (geom/meet/section_region.h); other curves are within a millionth of
// the size, and those of meshes are as exact as the mesh. Lights, cameras, and settings are removed.
CagStatus cag_scene_section(CagScene *s, const CagPlane *plane, CagSectionReach *reach,
                            CagError *err);

// The frame of the drawing above: x to the right, y up, z along the normal.
CagTransform cag_section_frame(const CagPlane *plane);

#endif
