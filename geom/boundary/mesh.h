// Meshes of boundaries.

#ifndef CAG_GEOM_BOUNDARY_MESH_H
#define CAG_GEOM_BOUNDARY_MESH_H

#include "geom/boundary/boundary.h"
#include "geom/tessellate/tessellate.h"

// The mesh of all faces, within the tolerance, which must be positive. Each edge is divided once,
// for all faces that use it, so that the mesh is watertight; `weld` unites the vertices of edges
// and corners. If the outline of a face crosses itself because chords cut corners, all edges are
// divided more finely. Fails with "no-boundary" if that does not help, or if the mesh is not
// watertight.
//
//   labeled  the label of each triangle is the number of its face, counting from 1
CagStatus cag_boundary_mesh(const CagBoundary *b, const CagTessellation *how, bool labeled,
                            CagMesh **out, CagError *err);

#endif
