// Orients closed meshes so that their normals point outward, for file formats that take the
// orientation from the order of the corners.

#ifndef CAG_GEOM_TESSELLATE_ORIENT_H
#define CAG_GEOM_TESSELLATE_ORIENT_H

#include "geom/mesh/mesh.h"
#include "geom/surface/surface.h"

// Turns each closed part (triangles connected over edges) so that its normals point outward; parts
// nested in others alternate, so that a cavity's normals point into the cavity. Triangles of a part
// that disagree are made to agree first. Parts that are open, one-sided or without volume keep
// their triangles as they are. *out has one reference; it is m itself where nothing turns.
CagStatus cag_mesh_outward(const CagMesh *m, CagMesh **out, CagError *err);

// A closed surface, turned over if its normals point inward on the whole; any other as it is. *out
// has one reference.
CagStatus cag_surface_outward(const CagSurface *s, CagSurface **out, CagError *err);

// Edges of one triangle, of the welded mesh without the triangles that welding makes edges.
CagStatus cag_mesh_open_edges(const CagMesh *m, size_t *out, CagError *err);

#endif
