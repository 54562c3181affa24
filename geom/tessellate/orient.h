// Orients closed meshes so that their normals point outward, for file formats that derive the
// orientation from the order of the corners.

#ifndef CAG_GEOM_TESSELLATE_ORIENT_H
#define CAG_GEOM_TESSELLATE_ORIENT_H

#include "geom/mesh/mesh.h"
#include "geom/surface/surface.h"

// Reverses each closed part (triangles connected by edges) whose normals do not point outward.
// Nested parts alternate, so that a cavity's normals point into the cavity. Triangles of a part
// that disagree are made consistent first. Parts that are open, one-sided, or without volume are
// not changed. *out has one reference; it is m itself if nothing changed.
CagStatus cag_mesh_outward(const CagMesh *m, CagMesh **out, CagError *err);

// A closed surface, reversed if its normals mostly point inward; other surfaces unchanged. *out has
// one reference.
CagStatus cag_surface_outward(const CagSurface *s, CagSurface **out, CagError *err);

// Number of edges with a single triangle in the welded mesh, ignoring triangles that collapse to
// edges by welding.
CagStatus cag_mesh_open_edges(const CagMesh *m, size_t *out, CagError *err);

#endif
