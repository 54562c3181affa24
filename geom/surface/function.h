// Surfaces defined by a function of the caller: S(u, v) = f(u, v). The function computes partials,
// too.

#ifndef CAG_GEOM_SURFACE_FUNCTION_H
#define CAG_GEOM_SURFACE_FUNCTION_H

#include "geom/surface/surface.h"

typedef struct CagSurfaceFunction {
  // All partials of total order <= n at (u, v), in the layout of CagSurfaceKind.eval (radians if a
  // parameter is an angle). A function that fails returns CAG_E_CALLBACK and fills err.
  CagStatus (*eval)(void *context, double u, double v, int n, CagVec3 *out, CagError *err);
  // The same for a whole row: n is 0 or 1, and out[j] holds 1 or 3 vectors: S, S_u, S_v.
  CagStatus (*eval_row)(void *context, double u, const double *vs, size_t nv, int n, CagVec3 *out,
                        CagError *err);
  void (*release)(void *context); // called when the surface is released
  void *context;
  // Adds what the function computes to a digest. NULL: nothing can be said.
  void (*digest)(void *context, CagDigest *d);
} CagSurfaceFunction;

// Kind "function". Closed directions and poles are detected to rounding. On success the surface
// owns the context; on failure the caller keeps it.
CagStatus cag_surface_function(const CagSurfaceFunction *f, double u0, double u1, bool angular_u,
                               double v0, double v1, bool angular_v, CagSurface **out,
                               CagError *err);
// Whether the surface is of this kind, possibly placed or trimmed.
bool cag_surface_is_formula(const CagSurface *s);
// Like cag_surface_eval, for such surfaces. A formula may be differentiable around a point but not
// there: on an edge, like sqrt(v) at 0, or at a point, like |(u, v)|. Derivatives are therefore
// evaluated slightly off the point, towards the middle of the rectangle lo .. hi; the position is
// that of the point itself.
CagStatus cag_surface_eval_beside(const CagSurface *s, const double lo[2], const double hi[2],
                                  const double at[2], int n, CagVec3 *out, CagError *err);

#endif
