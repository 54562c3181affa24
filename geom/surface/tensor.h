// Internals of tensor product NURBS surfaces, shared by their files.
//
// A point is N(u) B M(v) with homogeneous control points B, divided by its weight if rational. The
// net is stored twice: as points (w x, w y, w z, w) for single evaluations and exporters, and as
// one plane per coordinate for grids, whose inner loops run along v over contiguous numbers.
//
// The span of t is the index i with knots[i] <= t < knots[i + 1] (limit from the right) or knots[i]
// < t <= knots[i + 1] (from the left), within the domain knots[degree]..knots[count]. A closed
// direction stores its first `degree` lines again at the end, over knots -degree, ..., so that no
// other code needs to handle it.
//
// nurbs.c constructs and changes the surfaces, nurbs_point.c evaluates single points, nurbs_grid.c
// grids.

#ifndef CAG_GEOM_SURFACE_TENSOR_H
#define CAG_GEOM_SURFACE_TENSOR_H

#include "geom/basis/wide.h"
#include "geom/surface/surface.h"

// Basis tables are on the stack; higher degrees are useless because they lose all accuracy.
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
  double noise2[2]; // squares of the lengths below which partials by u and v are rounding errors
} Nurbs;

size_t cag_tensor_span(const Direction *d, double t, CagSide side);

// Whether `span` is the span of t, from the right. Neighboring parameters usually share a span.
static inline bool tensor_in_span(const Direction *d, size_t span, double t) {
  return span < d->count && d->knots[span] <= t && t < d->knots[span + 1];
}

// Values and first derivatives of the degree + 1 basis functions on the span.
void cag_tensor_basis_first(const Direction *d, size_t span, double t, double *values,
                            double *slopes);

// Functions of the kind. cag_tensor_frames computes unit normals as well; all outputs except points
// may be NULL.
CagStatus cag_tensor_eval(const CagSurface *s, double u, double v, int n, CagSide su, CagSide sv,
                          CagVec3 *out, CagError *err);
CagStatus cag_tensor_grid(const CagSurface *s, const double *us, size_t nu, const double *vs,
                          size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv, CagError *err);
CagStatus cag_tensor_frames(const Nurbs *b, const double *us, size_t nu, const double *vs,
                            size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv, CagVec3 *normals,
                            CagError *err);

#endif
