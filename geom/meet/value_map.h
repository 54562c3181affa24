// Meshes with a value at each vertex, for display by colors.

#ifndef CAG_GEOM_MEET_VALUE_MAP_H
#define CAG_GEOM_MEET_VALUE_MAP_H

#include "geom/tessellate/tessellate.h"

// X(NAME, text): the values that can be shown. Curvatures are signed by the normal along S_u x S_v;
// the slope is the angle between the tangent plane and the XY plane in degrees, 0..90.
#define CAG_SURFACE_VALUES(X)                                                                      \
  X(GAUSSIAN, "gaussian")                                                                          \
  X(MEAN, "mean")                                                                                  \
  X(PRINCIPAL_MAX, "principal_max")                                                                \
  X(PRINCIPAL_MIN, "principal_min")                                                                \
  X(SLOPE, "slope")
typedef enum CagSurfaceValue {
#define X(name, text) CAG_VALUE_##name,
  CAG_SURFACE_VALUES(X)
#undef X
} CagSurfaceValue;
// The texts, ending with NULL.
extern const char *const cag_surface_values[];

// A mesh whose uv[0] are the values, fine enough that they change little along an edge. Along a
// break across which the value jumps, vertices are duplicated, one for each side. At a pole, where
// the surface has no curvature, vertices are duplicated for each triangle, with the value next to
// the pole. `how` sets the tolerance, the triangle limit, and the stop flag.
CagStatus cag_surface_value_mesh(const CagSurface *s, CagSurfaceValue value,
                                 const CagTessellation *how, CagMesh **out, CagError *err);

// The range of values that a color scale should span: all values of the meshes, except for the
// tails of rare extremes (2 % of the area at either end) if these are far from the rest. If all
// values are equal, a range around them. Differences below `least` are rounding.
void cag_mesh_value_span(CagMesh *const *meshes, size_t n, double least, double *from, double *to);

// Replaces the values by those of zebra stripes: `across` . r, -1..1, where r = 2 (n . e) n - e is
// the direction to the eye reflected at the mesh's normal. `eye` and `across` are unit vectors,
// perpendicular to each other.
CagStatus cag_mesh_reflect(CagMesh *m, CagVec3 eye, CagVec3 across, CagError *err);

#endif
