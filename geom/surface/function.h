// Surfaces by a function of the caller: S(u, v) = f(u, v), with partials that the function computes
// too.

#ifndef CAG_GEOM_SURFACE_FUNCTION_H
#define CAG_GEOM_SURFACE_FUNCTION_H

#include "geom/surface/surface.h"

typedef struct CagSurfaceFunction {
  // All partials of total order <= n at (u, v), as CagSurfaceKind.eval gives them (radians where a
  // parameter is an angle). A function that fails gives CAG_E_CALLBACK and fills err.
  CagStatus (*eval)(void *context, double u, double v, int n, CagVec3 *out, CagError *err);
  // The same for all of a row at once: n is 0 or 1, and out[j] holds 1 or 3 vectors: S, S_u, S_v.
  CagStatus (*eval_row)(void *context, double u, const double *vs, size_t nv, int n, CagVec3 *out,
                        CagError *err);
  void (*release)(void *context); // when the surface is gone
  void *context;
} CagSurfaceFunction;

// Kind "function". Closed directions and poles are found to rounding. On success the surface owns
// the context; where the call fails it stays the caller's.
CagStatus cag_surface_function(const CagSurfaceFunction *f, double u0, double u1, bool angular_u,
                               double v0, double v1, bool angular_v, CagSurface **out,
                               CagError *err);
// Whether it is of this kind, perhaps placed or trimmed.
bool cag_surface_is_formula(const CagSurface *s);
// As cag_surface_eval, for such surfaces: a formula may have derivatives all about a place and none
// there, on an edge as sqrt(v) at 0, or at a point as |(u, v)|. They are taken a little beside,
// towards the middle of the rectangle lo .. hi; the point is that of the place itself.
CagStatus cag_surface_eval_beside(const CagSurface *s, const double lo[2], const double hi[2],
                                  const double at[2], int n, CagVec3 *out, CagError *err);

#endif
