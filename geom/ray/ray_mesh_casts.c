// Rays at meshes, for any processor.

#include "geom/ray/ray_mesh_walk.h"

const CagRayMeshCasts cag_ray_mesh_casts = CAG_RAY_MESH_CASTS;
