// Normals of meshes where a surface has different ones on its sides.

#ifndef CAG_GEOM_TESSELLATE_SIDES_H
#define CAG_GEOM_TESSELLATE_SIDES_H

#include "geom/mesh/mesh.h"
#include "geom/surface/surface.h"

// At creases, cuspidal edges and tips, the normal of a surface has several limits, and a vertex has
// one of them. Among the triangles from..to-1 of a mesh with normals and parameters of the surface,
// corners that lean by more than `angle` get vertices of their own where the limit from within the
// triangle is another one, or where the triangle spans a place at which the normal is reversed.
// Triangles whose height is at most `noise` are rounding.
CagStatus cag_mesh_split_sides(CagMesh *m, size_t from, size_t to, const CagSurface *s,
                               double angle, double noise, CagError *err);

#endif
