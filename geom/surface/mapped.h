// Maps meshes onto a surface: x and y of a point become u and v, and z becomes the height along the
// normal.

#ifndef CAG_GEOM_SURFACE_MAPPED_H
#define CAG_GEOM_SURFACE_MAPPED_H

#include "geom/mesh/mesh.h"
#include "geom/surface/surface.h"

// The image of a mesh. Triangles are divided until the midpoint of each edge is within the
// tolerance of its image (<= 0: a thousandth of the image's size) and no edge is longer than a
// fraction of the surface's domain. A closed mesh stays closed. `sheet`: the mesh lies in z = 0,
// and the image has the surface's normals. Fails with "parameter-range" if a point lies outside of
// the domain.
CagStatus cag_mesh_onto_surface(const CagMesh *m, const CagSurface *s, double tolerance, bool sheet,
                                size_t max_triangles, CagMesh **out, CagError *err);

#endif
