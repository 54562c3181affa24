// Surfaces through curves and through grids of points: lofts, interpolation, least squares.

#ifndef CAG_GEOM_LOFT_H
#define CAG_GEOM_LOFT_H

#include "geom/surface/surface.h"

// The NURBS surface with v = i on curve i. Curves are made compatible in u over 0..1; in v a spline
// of the degree (lower where there are too few curves) passes them. Closed: v runs on from the last
// curve to the first, whose copy is v = n; the degree is then odd.
CagStatus cag_surface_loft(const CagCurve *const *curves, size_t n, int degree, bool closed,
                           CagSurface **out, CagError *err);

// Parameters of grid data, over the usable range of the knots.
typedef enum CagGridSpacing {
  CAG_GRID_CHORD,  // of fits: by chord length along every row and column on its own (06b, 4)
  CAG_GRID_MEAN,   // the mean of these over all rows, and over all columns
  CAG_GRID_UNIFORM // even
} CagGridSpacing;

typedef struct CagGridData {
  const CagVec3 *points; // r x s, by rows of u
  size_t r, s;
  int degree_u, degree_v;
  CagGridSpacing spacing;
} CagGridData;

// Through all points; knots are means of neighbouring parameters, and CHORD is taken as MEAN.
CagStatus cag_surface_interpolate(const CagGridData *data, CagSurface **out, CagError *err);
// Least squares with nu x nv control points on open uniform knots, by Householder QR. rms and
// largest (may be NULL): of the distances from the data. Fails with "fit-underdetermined",
// "fit-singular".
CagStatus cag_surface_fit(const CagGridData *data, size_t nu, size_t nv, CagSurface **out,
                          double *rms, double *largest, CagError *err);

#endif
