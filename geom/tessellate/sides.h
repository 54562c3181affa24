// Separate vertex normals on the two sides of creases.

#ifndef CAG_GEOM_TESSELLATE_SIDES_H
#define CAG_GEOM_TESSELLATE_SIDES_H

#include "geom/mesh/mesh.h"
#include "geom/surface/surface.h"

// At creases, cuspidal edges, and tips the normal of a surface has several limits, but a vertex has
// only one normal. Considers the triangles from..to-1 of a mesh with normals and parameters of the
// surface. Corners whose normal leans by more than `angle` get their own vertex if the limit from
// within the triangle is different, or if the triangle spans a point at which the normal reverses.
// Triangles with a height up to `noise` are ignored as rounding.
CagStatus cag_mesh_split_sides(CagMesh *m, size_t from, size_t to, const CagSurface *s,
                               double angle, double noise, CagError *err);

#endif
