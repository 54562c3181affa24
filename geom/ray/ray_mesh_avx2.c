// The functions of ray_mesh_casts.c for wider registers.

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#pragma GCC target("avx2,fma,bmi")
#endif

#include "geom/ray/ray_mesh.h"

#ifdef CAG_RAY_MESH_AVX2
#include "geom/ray/ray_mesh_walk.h"

const CagRayMeshCasts cag_ray_mesh_casts_avx2 = CAG_RAY_MESH_CASTS;
#endif
