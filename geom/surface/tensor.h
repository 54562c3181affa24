// The inside of tensor product NURBS surfaces: what their files share.
//
// A point is N(u) B M(v) with homogeneous control points B, divided by its weight where rational.
// The net is kept twice: as points (w x, w y, w z, w) for single evaluations and exporters, and as
// one plane per coordinate for grids, where the inner loops run along v over contiguous numbers.
//
// The span of t is the index i with knots[i] <= t < knots[i + 1] (limit from the right) or
// knots[i] < t <= knots[i + 1] (from the left), within the domain knots[degree]..knots[count]. A
// closed direction stores its first `degree` lines again at the end, over knots -degree, ..., so
// that nothing else knows of it.
//
// nurbs.c makes and changes them, nurbs_point.c evaluates at one point, nurbs_grid.c on grids.

#ifndef CAG_GEOM_SURFACE_TENSOR_H
#define CAG_GEOM_SURFACE_TENSOR_H

#include "geom/basis/wide.h"
#include "geom/surface/surface.h"

// Basis tables live on the stack; higher degrees serve nobody and lose all accuracy.
#define MAX_DEGREE 63

typedef struct Direction {
  int degree;
  size_t count, distinct;
  bool periodic;
  double *knots;
} Direction;

typedef struct Nurbs {
  CagSurface base;
  Direction u, v;
  bool rational;
  double *net;      // count_u x count_v x 4
  double *planes;   // 4 x count_u x count_v: x, y, z, w
  double noise2[2]; // squares of the lengths below which partials by u and v are rounding
} Nurbs;

size_t cag_tensor_span(const Direction *d, double t, CagSide side);

// Is it the span of t, from the right? Neighboring parameters mostly share theirs.
static inline bool tensor_in_span(const Direction *d, size_t span, double t) {
  return span < d->count && d->knots[span] <= t && t < d->knots[span + 1];
}

// Values and first derivatives of the degree + 1 basis functions on the span.
void cag_tensor_basis_first(const Direction *d, size_t span, double t, double *values,
                            double *slopes);

// The kind's functions. cag_tensor_frames gives unit normals as well; all but points may be NULL.
CagStatus cag_tensor_eval(const CagSurface *s, double u, double v, int n, CagSide su, CagSide sv,
                          CagVec3 *out, CagError *err);
CagStatus cag_tensor_grid(const CagSurface *s, const double *us, size_t nu, const double *vs,
                          size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv, CagError *err);
CagStatus cag_tensor_frames(const Nurbs *b, const double *us, size_t nu, const double *vs,
                            size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv, CagVec3 *normals,
                            CagError *err);

#endif
