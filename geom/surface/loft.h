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
  // By direction, 0: u. A closed one has uniform periodic knots and the domain 0..count; the first
  // points are not repeated. Of even degrees the spacing then begins at 0.5, in the middle of a
  // span, where alone the points determine the surface.
  bool closed[2];
  const double *knots[2];      // NULL: means of parameters (interpolation), open uniform (fits)
  const double *parameters[2]; // of each point, r x s; NULL: by the spacing
  int corrections; // of a fit: most rounds in which parameters move to the nearest points
} CagGridData;

// What a fit or interpolation went by, and how well it did.
typedef struct CagGridReport {
  double *u, *v; // parameters of the points, r x s, malloc'd
  double rms, largest;
  int rounds; // corrections that were of use
} CagGridReport;
void cag_grid_report_free(CagGridReport *report);

// Through all points; CHORD is taken as MEAN. Fails with "fit-singular", "parameter-range".
CagStatus cag_surface_interpolate(const CagGridData *data, CagSurface **out, CagError *err);
// Least squares with nu x nv control points, by Householder QR. Fails with "fit-underdetermined",
// "fit-singular", "parameter-range". `report` may be NULL.
CagStatus cag_surface_fit(const CagGridData *data, size_t nu, size_t nv, CagSurface **out,
                          CagGridReport *report, CagError *err);
// Interpolation with a report.
CagStatus cag_surface_interpolate_report(const CagGridData *data, CagSurface **out,
                                         CagGridReport *report, CagError *err);
// Parameters of the points by the spacing, over 0..end of each direction: u and v have room for
// r x s.
void cag_grid_parameters(const CagGridData *data, const double end[2], double *u, double *v);

#endif
