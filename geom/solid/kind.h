// The kinds of solids: a table of their differences.

#ifndef CAG_GEOM_SOLID_KIND_H
#define CAG_GEOM_SOLID_KIND_H

#include "geom/solid/solid.h"

// A body in its own coordinates.
typedef struct CagSolidBody {
  double volume, moment[6]; // second moments xx yy zz xy yz zx about the centroid
  CagVec3 centroid;
  double area;
  CagVec3 area_centroid;
} CagSolidBody;

// The scales k along a solid's own axes that preserve its kind, and change only its sizes.
typedef enum CagSolidScaling {
  CAG_SCALES_NOT,       // none
  CAG_SCALES_EACH_AXIS, // positive ones
  CAG_SCALES_UPRIGHT,   // k[0] = k[1]
  CAG_SCALES_EVENLY,    // k[0] = k[1] = k[2]
  CAG_SCALES_MIRRORED   // equal except for signs
} CagSolidScaling;

typedef struct CagSolidKindRow {
  const char *name; // "box"
  CagSolidScaling scaling;
  int size_axes[3];   // the axes along which the sizes a, b, and c are measured
  bool turns_about_z; // a rotation about its own z axis does not change it
  // Whether reflections in the planes of its own axes do not change it.
  bool (*is_symmetric)(const CagSolid *s); // NULL: no
  // Writes its description with the sizes a, b, and c: "sphere, radius 10".
  void (*describe)(const CagSolid *s, const double size[3], char *buffer, size_t n);
  // The measures of a primitive in its own coordinates.
  CagSolidBody (*body)(const CagSolid *s); // NULL: integrals over its faces
  // The distance of a point from a primitive in its own coordinates; negative inside.
  double (*beyond)(const CagSolid *s, CagVec3 p); // NULL: its mesh is used
  // Bounds in the world.
  CagStatus (*bounds)(const CagSolid *s, CagBounds *out, CagError *err); // NULL: of its faces
} CagSolidKindRow;

// The description of a half space, which has no size: its plane after all transforms (describe.c).
void cag_describe_half_space(const CagSolid *s, const double size[3], char *buffer, size_t n);

extern const CagSolidKindRow cag_solid_kinds[]; // by CagSolidKind

#endif
