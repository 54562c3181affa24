// Curves as the renderers draw them: rods, which are cylinders, with balls at their joints.

#ifndef CAG_INTERP_SCENE_CURVE_RODS_H
#define CAG_INTERP_SCENE_CURVE_RODS_H

#include "geom/ray/ray_rods.h"
#include "interp/scene/scene.h"

// A curve with a radius. A straight one is a single rod with flat ends. A full circle is a torus,
// and has no rods. Dashes are rods with flat ends. Others have balls at their joints and ends.
typedef struct CagCurveRods {
  double radius;
  bool straight; // a single rod
  bool circle;   // a torus about the z axis of the frame
  double circle_radius;
  CagTransform frame; // a rotation and a translation
  CagRod *rods;
  size_t count;
} CagCurveRods;

CagStatus cag_curve_rods(const CagScene *s, const CagItem *item, CagCurveRods *out, CagError *err);
void cag_curve_rods_free(CagCurveRods *rods); // also of a zeroed one

#endif
