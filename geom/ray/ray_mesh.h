// Rays and points against the triangles of a mesh.

#ifndef CAG_GEOM_RAY_RAY_MESH_H
#define CAG_GEOM_RAY_RAY_MESH_H

#include "geom/mesh/mesh.h"
#include "geom/ray/bvh.h"
#include "geom/ray/ray.h"

// The corners of a triangle, in the order of the hierarchy's leaves.
typedef struct CagRayTriangle {
  CagVec3 p[3];
} CagRayTriangle;

typedef struct CagRayMesh {
  CagMesh *mesh; // retained
  CagBvh bvh;
  CagRayTriangle *triangles;
} CagRayMesh;

CagStatus cag_ray_mesh_new(const CagMesh *m, CagRayMesh **out, CagError *err);
void cag_ray_mesh_free(CagRayMesh *m); // m may be NULL

// The first crossing. Whether a ray meets a triangle is decided exactly, by a rule for edges and
// corners that assigns each to one of its triangles, so a ray cannot slip through a closed mesh, and
// crosses it an even number of times. Returns false if it meets none.
bool cag_ray_mesh_first(const CagRayMesh *m, const CagRay *ray, CagCrossing *out);
// Whether there is any crossing.
bool cag_ray_mesh_blocks(const CagRayMesh *m, const CagRay *ray);
// Adds all crossings, in any order.
CagStatus cag_ray_mesh_all(const CagRayMesh *m, const CagRay *ray, CagCrossings *out,
                           CagError *err);
// Whether the point is inside of the closed mesh, or on it to within `slack`.
bool cag_ray_mesh_contains(const CagRayMesh *m, CagVec3 p, double slack);
// The point of the mesh closest to p, if it is closer than `most`: *face is its triangle. Returns
// false otherwise.
bool cag_ray_mesh_closest(const CagRayMesh *m, CagVec3 p, double most, CagVec3 *point,
                          uint32_t *face);

#endif
