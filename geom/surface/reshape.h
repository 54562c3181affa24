// Other forms of a surface: parts, finer nets, higher degrees, joins; and surfaces derived from
// another by its parameters or its normal.

#ifndef CAG_GEOM_RESHAPE_H
#define CAG_GEOM_RESHAPE_H

#include "geom/surface/surface.h"

// --- On control points; other kinds go by their exact form ("no-exact-form") ---
// Inserts t so many times into the direction (0: u); "parameter-range", "knot-multiplicity".
CagStatus cag_surface_insert_knot(const CagSurface *s, int direction, double t, int times,
                                  CagSurface **out, CagError *err);
// The middle of every knot interval, in the directions asked for.
CagStatus cag_surface_refine(const CagSurface *s, bool u, bool v, CagSurface **out, CagError *err);
// The same in each direction as said: not at all, in the middles, or to a whole knot vector that
// holds the old one, with the same ends. Fails with "knots-not-superset", "knots-not-monotone",
// "knot-multiplicity".
typedef struct CagRefinement {
  enum { CAG_REFINE_NOT, CAG_REFINE_MIDPOINTS, CAG_REFINE_KNOTS } how;
  const double *knots;
  size_t count;
} CagRefinement;
CagStatus cag_surface_refine_by(const CagSurface *s, const CagRefinement by[2], CagSurface **out,
                                CagError *err);
CagStatus cag_surface_elevate(const CagSurface *s, int u, int v, CagSurface **out, CagError *err);
// Its Bezier pieces over 0..1, by rows of u: *nu x *nv of them, the array malloc'd.
CagStatus cag_surface_to_bezier(const CagSurface *s, CagSurface ***out, size_t *nu, size_t *nv,
                                CagError *err);
// Two surfaces as one across the edge that they share: u runs over the first, then over the second.
// Fails with "edges-do-not-match", which tells the smallest gap.
CagStatus cag_surface_join(const CagSurface *a, const CagSurface *b, double tolerance,
                           CagSurface **out, CagError *err);

// The part over a rectangle of parameters of a NURBS surface, as one.
CagStatus cag_surface_nurbs_part(const CagSurface *s, double u0, double u1, double v0, double v1,
                                 CagSurface **out, CagError *err);

// --- Of any kind ---
// The part over a rectangle of parameters, which stay as they are.
CagStatus cag_surface_part(const CagSurface *s, double u0, double u1, double v0, double v1,
                           CagSurface **out, CagError *err);
// S'(u, v) = S(v, u).
CagStatus cag_surface_transpose(const CagSurface *s, CagSurface **out, CagError *err);
// S + d n; partials up to order CAG_MAX_PARTIAL - 1.
CagStatus cag_surface_offset(const CagSurface *s, double d, CagSurface **out, CagError *err);
// Gets the base surface and the distance of an offset. Returns false for another surface.
bool cag_surface_offset_view(const CagSurface *s, const CagSurface **inner, double *d);

// A developable surface laid flat into z = 0 with its parameters, lengths kept; it is straight
// along u or v. The ruling at the start lies along x. Fails with "not-developable".
CagStatus cag_surface_unroll(const CagSurface *s, CagSurface **out, CagError *err);

// How two surfaces meet along the edge that they share.
typedef struct CagSeam {
  int side[2]; // of each: 0: u0, 1: u1, 2: v0, 3: v1
  bool reversed;
  double gap;       // largest distance of points
  double angle;     // largest angle between the tangent planes, radians
  double first;     // largest |difference of the derivatives across|
  double curvature; // largest difference of the normal curvatures across the edge
  bool c0, g1, c1, g2;
} CagSeam;
CagStatus cag_surface_seam(const CagSurface *a, const CagSurface *b, double tolerance, CagSeam *out,
                           CagError *err);
// The same for one side of each; NULL: the nearest two.
CagStatus cag_surface_seam_on(const CagSurface *a, const CagSurface *b, const int sides[2],
                              double tolerance, CagSeam *out, CagError *err);

#endif
