// Convex hulls of points in the plane and in space.

#ifndef CAG_GEOM_MESH_HULL_H
#define CAG_GEOM_MESH_HULL_H

#include "geom/mesh/mesh.h"

// Corners of the hull of points in the XY plane as indices, counter-clockwise from the lowest x;
// *out is malloc'd. Points within rounding of a side are not corners. Fails with "too-few-points",
// "coincident-points", "collinear-points".
CagStatus cag_hull_plane(const CagVec3 *points, size_t n, size_t **out, size_t *count,
                         CagError *err);
// The hull of points in space as a closed mesh with outward normals. Points within rounding of a
// face or an edge are not vertices; faces are flat to rounding. Fails also with "coplanar-points".
CagStatus cag_hull_space(const CagVec3 *points, size_t n, CagMesh **out, CagError *err);

#endif
