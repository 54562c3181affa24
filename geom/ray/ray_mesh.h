// Rays and points against the triangles of a mesh.

#ifndef CAG_GEOM_RAY_RAY_MESH_H
#define CAG_GEOM_RAY_RAY_MESH_H

#include "geom/mesh/mesh.h"
#include "geom/ray/bvh.h"
#include "geom/ray/ray.h"

// The coordinates of the corners of a triangle, relative to the origin of the hierarchy and rounded.
// Most triangles are ruled out by these. The others are met exactly, at the positions of the mesh.
typedef struct CagRayTriangle {
  float x[3], y[3], z[3];
  uint32_t corner[3], face; // in the mesh
} CagRayTriangle;

typedef struct CagRayMeshCasts CagRayMeshCasts;

typedef struct CagRayMesh {
  CagMesh *mesh; // retained
  CagBvh bvh;
  CagRayTriangle *triangles; // in the order of the hierarchy's leaves
  const CagRayMeshCasts *casts;
  struct CagRayMeshEmbree *embree; // NULL unless Embree finds the triangles of rays
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
// The point of the mesh closest to p, if it is at most `most` away: *face is its triangle, of several the
// one with the lowest number. Returns false otherwise.
bool cag_ray_mesh_closest(const CagRayMesh *m, CagVec3 p, double most, CagVec3 *point,
                          uint32_t *face);

// The functions above, compiled for several processors. The results of all copies are the same.
struct CagRayMeshCasts {
  bool (*first)(const CagRayMesh *m, const CagRay *ray, CagCrossing *out);
  bool (*blocks)(const CagRayMesh *m, const CagRay *ray);
  CagStatus (*all)(const CagRayMesh *m, const CagRay *ray, CagCrossings *out, CagError *err);
  int (*winding)(const CagRayMesh *m, const CagRay *ray); // the sum of the signs of the crossings
};

extern const CagRayMeshCasts cag_ray_mesh_casts; // for any processor
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(CAG_ONE_COPY)
#define CAG_RAY_MESH_AVX2
extern const CagRayMeshCasts cag_ray_mesh_casts_avx2; // for processors with AVX2 and FMA
#endif

#ifdef CAG_EMBREE
// The least number of triangles of a mesh for which Embree is used.
#ifndef CAG_EMBREE_TRIANGLES
#define CAG_EMBREE_TRIANGLES 1000000
#endif
// Uses Embree for the rays of a mesh. If it fails, or the mesh is extremely large or small, the mesh
// stays as it is.
void cag_ray_mesh_use_embree(CagRayMesh *m);
void cag_ray_mesh_release_embree(CagRayMesh *m);
#endif

#endif
