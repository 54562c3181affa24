// Triangulation of a single polygon in space, for faces of meshes.

#ifndef CAG_GEOM_MESH_POLYGON_H
#define CAG_GEOM_MESH_POLYGON_H

#include "geom/mesh/mesh.h"

// Writes count - 2 triangles of the polygon with corners vertices[face[k]], oriented like the face.
// `number` is the face's index for messages: "face-degenerate" (no area), "face-self-intersection".
CagStatus cag_polygon_triangulate(const CagVec3 *vertices, const uint32_t *face, size_t count,
                                  size_t number, uint32_t *triangles, CagError *err);

#endif
