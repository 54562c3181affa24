// Changes of representation of a surface (parts, refinement, degree elevation, joins), and surfaces
// derived from another by its parameters or its normal.

#ifndef CAG_GEOM_RESHAPE_H
#define CAG_GEOM_RESHAPE_H

#include "geom/surface/surface.h"

// --- On control points; other kinds are converted to their exact form ("no-exact-form") ---
// Inserts t `times` times in the direction (0: u). Fails with "parameter-range",
// "knot-multiplicity".
CagStatus cag_surface_insert_knot(const CagSurface *s, int direction, double t, int times,
                                  CagSurface **out, CagError *err);
// Inserts the midpoint of every knot interval, in the selected directions.
CagStatus cag_surface_refine(const CagSurface *s, bool u, bool v, CagSurface **out, CagError *err);
// The same with a choice for each direction: no refinement, midpoints, or a whole knot vector that
// contains the old one and has the same ends. Fails with "knots-not-superset",
// "knots-not-monotone", "knot-multiplicity".
typedef struct CagRefinement {
  enum { CAG_REFINE_NOT, CAG_REFINE_MIDPOINTS, CAG_REFINE_KNOTS } how;
  const double *knots;
  size_t count;
} CagRefinement;
CagStatus cag_surface_refine_by(const CagSurface *s, const CagRefinement by[2], CagSurface **out,
                                CagError *err);
CagStatus cag_surface_elevate(const CagSurface *s, int u, int v, CagSurface **out, CagError *err);
// Removes the inner knot t `times` times, and lowers the degree by one in a direction. A closed
// direction becomes open. *deviation (may be NULL) bounds the distance of new and old points at
// equal parameters. Fail with "tolerance-exceeded", "no-such-knot", "order-range".
CagStatus cag_surface_remove_knot(const CagSurface *s, int direction, double t, int times,
                                  double tolerance, CagSurface **out, double *deviation,
                                  CagError *err);
CagStatus cag_surface_reduce_degree(const CagSurface *s, int direction, double tolerance,
                                    CagSurface **out, double *deviation, CagError *err);
// The Bezier pieces over 0..1, by rows of u: *nu x *nv of them; the array is malloc'd.
CagStatus cag_surface_to_bezier(const CagSurface *s, CagSurface ***out, size_t *nu, size_t *nv,
                                CagError *err);
// Joins two surfaces across their common edge: u runs over the first, then over the second. Fails
// with "edges-do-not-match", whose message has the smallest gap.
CagStatus cag_surface_join(const CagSurface *a, const CagSurface *b, double tolerance,
                           CagSurface **out, CagError *err);

// The part of a NURBS surface over a rectangle of parameters, as a NURBS surface.
CagStatus cag_surface_nurbs_part(const CagSurface *s, double u0, double u1, double v0, double v1,
                                 CagSurface **out, CagError *err);

// --- For any kind ---
// The part over a rectangle of parameters, which are not changed.
CagStatus cag_surface_part(const CagSurface *s, double u0, double u1, double v0, double v1,
                           CagSurface **out, CagError *err);
// S'(u, v) = S(v, u).
CagStatus cag_surface_transpose(const CagSurface *s, CagSurface **out, CagError *err);
// S'(u, v) = S(u0 + u1 - u, v), or the same in v, which is cag_surface_flip.
CagStatus cag_surface_reverse(const CagSurface *s, int direction, CagSurface **out, CagError *err);
// S + d n; partials up to order CAG_MAX_PARTIAL - 1.
CagStatus cag_surface_offset(const CagSurface *s, double d, CagSurface **out, CagError *err);
// The base surface and the distance of an offset. Returns false for another surface.
bool cag_surface_offset_view(const CagSurface *s, const CagSurface **inner, double *d);

// Unrolls a developable surface into z = 0, preserving parameters and lengths. It must be straight
// along u or v; the ruling at the start lies along x. Fails with "not-developable".
CagStatus cag_surface_unroll(const CagSurface *s, CagSurface **out, CagError *err);

// The continuity of two surfaces across their common edge.
typedef struct CagSeam {
  int side[2]; // for each surface: 0: u0, 1: u1, 2: v0, 3: v1
  bool reversed;
  double gap;       // largest distance of points
  double angle;     // largest angle between the tangent planes, radians
  double first;     // largest |difference of the derivatives across the edge|
  double curvature; // largest difference of the normal curvatures across the edge
  bool c0, g1, c1, g2;
} CagSeam;
CagStatus cag_surface_seam(const CagSurface *a, const CagSurface *b, double tolerance, CagSeam *out,
                           CagError *err);
// The same for one given side of each surface; NULL: the nearest two.
CagStatus cag_surface_seam_on(const CagSurface *a, const CagSurface *b, const int sides[2],
                              double tolerance, CagSeam *out, CagError *err);

#endif
