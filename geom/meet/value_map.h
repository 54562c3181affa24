// Meshes that carry a value of the surface at each vertex, to be shown by colors.

#ifndef CAG_GEOM_MEET_VALUE_MAP_H
#define CAG_GEOM_MEET_VALUE_MAP_H

#include "geom/tessellate/tessellate.h"

// X(NAME, text): what is shown. Curvatures are signed by the normal along S_u x S_v; the slope is
// the angle between the tangent plane and the XY plane in degrees, 0..90.
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
// Their words, ending with NULL.
extern const char *const cag_surface_values[];

// A mesh whose uv[0] are the values, fine enough that they change little along an edge. Along a
// break where the value jumps, the vertices stand once for each side; at a pole, where the surface
// has no curvature of its own, once for each triangle with the value beside it. `how` sets the
// tolerance, the limit of triangles, and what stops it.
CagStatus cag_surface_value_mesh(const CagSurface *s, CagSurfaceValue value,
                                 const CagTessellation *how, CagMesh **out, CagError *err);

// What of the values of some meshes a scale should span: all, but for the tails of rare extremes
// (both 2 % of the area) where these are far from the rest. Values that are all one get a span
// around them. `least`: differences below are rounding.
void cag_mesh_value_span(CagMesh *const *meshes, size_t n, double least, double *from, double *to);

// The values of zebra stripes: `across` . r, -1..1, where r is the direction to the eye mirrored
// at the normal, r = 2 (n . e) n - e. Both are unit vectors, perpendicular to each other. In place,
// by the mesh's normals.
CagStatus cag_mesh_reflect(CagMesh *m, CagVec3 eye, CagVec3 across, CagError *err);

#endif
