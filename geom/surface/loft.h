// Surfaces through curves and through grids of points: lofts, interpolation, least squares.

#ifndef CAG_GEOM_LOFT_H
#define CAG_GEOM_LOFT_H

#include "geom/surface/net.h"
#include "geom/surface/surface.h"

// The surface through curves, with curve i at v = i, as a spline in v given by its coefficients for
// unit data (`cardinal`: a row for each coefficient, a column for each curve). u in 0..1 is the
// fraction of each curve's domain.
CagStatus cag_surface_across(const CagCurve *const *curves, const CagNet *cardinal,
                             CagSurface **out, CagError *err);
// The first or last curve of such a surface, over 0..1; false: another kind.
bool cag_surface_across_end(const CagSurface *s, bool first, const CagCurve **out);

// The NURBS surface with curve i at v = i. If a curve has no exact form, returns the surface of
// cag_surface_across. Curves are made compatible in u over 0..1 and interpolated in v by a spline
// of the degree (lower if there are too few curves). Closed: v continues from the last curve to the
// first, whose copy is at v = n; the degree must then be odd.
CagStatus cag_surface_loft(const CagCurve *const *curves, size_t n, int degree, bool closed,
                           CagSurface **out, CagError *err);

// Parameters of grid data, over the usable range of the knots.
typedef enum CagGridSpacing {
  CAG_GRID_CHORD,  // fits: by chord length along each row and column separately
  CAG_GRID_MEAN,   // the mean of these over all rows, and over all columns
  CAG_GRID_UNIFORM // equally spaced
} CagGridSpacing;

// A coordinate that a fit keeps exact: the parameters of the data move until the surface matches
// it.
typedef enum CagGridHold {
  CAG_GRID_HOLD_NONE,
  CAG_GRID_HOLD_X,
  CAG_GRID_HOLD_Y,
  CAG_GRID_HOLD_Z
} CagGridHold;

// Whether lines of control points lie in planes of the held coordinate, and which lines: those of
// constant u, of constant v, or those along which the data's coordinate changes less.
typedef enum CagGridPlanes {
  CAG_GRID_PLANES_NONE,
  CAG_GRID_PLANES_U,
  CAG_GRID_PLANES_V,
  CAG_GRID_PLANES_EITHER
} CagGridPlanes;

typedef struct CagGridData {
  const CagVec3 *points; // r x s, by rows of u
  size_t r, s;
  int degree_u, degree_v;
  CagGridSpacing spacing;
  // By direction, 0: u. A closed direction has uniform periodic knots and the domain 0..count; the
  // first points are not repeated. For even degrees the spacing then starts at 0.5, the middle of a
  // span, since the points determine the surface only there.
  bool closed[2];
  const double *knots[2];      // NULL: averages of the parameters (interpolation), open uniform
                               // (fits)
  const double *parameters[2]; // of each point, r x s; NULL: from the spacing
  int corrections; // fits: maximum number of rounds in which parameters move to the nearest points
  // For fits. Without planes the edges of the net are fitted to the border of the data, and the
  // coordinate of the net is that of the first fit; with planes it is that of the planes.
  CagGridHold hold;
  double slack; // accepted deviation of the coordinate; parameters within it do not move
  CagGridPlanes lines;
  const double *planes; // NULL: from the stations of the data
  size_t plane_count;
} CagGridData;

// Parameters used by a fit or interpolation, and its quality.
typedef struct CagGridReport {
  double *u, *v; // parameters of the points, r x s, malloc'd
  double rms, largest;
  int rounds;       // number of rounds that moved parameters: to hold the coordinate, and effective
                    // corrections
  double *planes;   // of the lines of control points, malloc'd; NULL: none
  int planes_along; // 0: lines of constant u
} CagGridReport;
void cag_grid_report_free(CagGridReport *report);

// Interpolates all points; CHORD is treated as MEAN. Fails with "fit-singular", "parameter-range".
CagStatus cag_surface_interpolate(const CagGridData *data, CagSurface **out, CagError *err);
// Least squares with nu x nv control points, by Householder QR. Fails with "fit-underdetermined",
// "fit-singular", "parameter-range"; if a coordinate is held also with "fit-ends",
// "fit-no-convergence", "coordinate-turns", "plane-count", "planes-not-monotone", "planes-closed",
// "beyond-planes". `report` may be NULL.
CagStatus cag_surface_fit(const CagGridData *data, size_t nu, size_t nv, CagSurface **out,
                          CagGridReport *report, CagError *err);
// Interpolation with a report.
CagStatus cag_surface_interpolate_report(const CagGridData *data, CagSurface **out,
                                         CagGridReport *report, CagError *err);
// Parameters of the points by the spacing, over 0..end in each direction; u and v must have room
// for r x s.
void cag_grid_parameters(const CagGridData *data, const double end[2], double *u, double *v);

#endif
