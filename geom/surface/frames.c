// Points and unit normals of a surface on grids: the kind's own grid, and a cross product for each
// point. NURBS compute both at once.

#include "geom/surface/frames.h"

#include <float.h>

#include "base/memory.h"
#include "geom/linalg/tolerance.h"

// Rows are evaluated in blocks of up to this many points, so that their partials stay in the cache.
#define TOGETHER 4096

bool cag_normal_of_partials(const CagSurface *s, CagVec3 point, CagVec3 du, CagVec3 dv,
                            CagVec3 *out) {
  const double parallel = CAG_PARALLEL; // relative to the product of their lengths; smaller values
                                        // are rounding
  CagVec3 n = cag_cross(du, dv);
  double length2 = cag_dot(n, n), uu = cag_dot(du, du), vv = cag_dot(dv, dv);
  double u = cag_partial_noise(point, s->u1 - s->u0), v = cag_partial_noise(point, s->v1 - s->v0);
  if (!(length2 > parallel * parallel * uu * vv && length2 > DBL_MIN)) return false;
  if (!(uu > u * u && vv > v * v)) return false;
  *out = cag_scaled(n, 1 / sqrt(length2));
  return true;
}

CagStatus cag_surface_eval_frames(const CagSurface *s, const double *us, size_t nu,
                                  const double *vs, size_t nv, CagVec3 *points, CagVec3 *du,
                                  CagVec3 *dv, CagVec3 *normals, CagError *err) {
  CagStatus status = CAG_OK;
  if (nu == 0 || nv == 0) return CAG_OK;
  if (cag_surface_nurbs_frames(s, us, nu, vs, nv, points, du, dv, normals, &status, err))
    return status;
  size_t rows = nv < TOGETHER ? TOGETHER / nv : 1;
  if (rows > nu) rows = nu;
  CagVec3 *own = du && dv ? NULL : cag_malloc(2 * rows * nv * sizeof *own);
  if (!own && !(du && dv)) return cag_fail_memory(err);
  for (size_t i = 0, n; !status && i < nu; i += n) {
    n = nu - i < rows ? nu - i : rows;
    CagVec3 *a = own ? own : du + i * nv, *b = own ? own + rows * nv : dv + i * nv;
    status = cag_surface_eval_grid(s, us + i, n, vs, nv, points + i * nv, a, b, err);
    for (size_t k = 0; !status && k < n * nv; k++)
      if (!cag_normal_of_partials(s, points[i * nv + k], a[k], b[k], &normals[i * nv + k]))
        normals[i * nv + k] = cag_vec3(0, 0, 0);
  }
  cag_free(own);
  return status;
}
