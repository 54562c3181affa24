// Edits a surface by its control points (corners, single points, the rows next to an edge), and
// finds creases.

#ifndef CAG_GEOM_SURFACE_EDIT_H
#define CAG_GEOM_SURFACE_EDIT_H

#include "geom/surface/patches.h"

// Points, tangents, and twists at the four corners, as derivatives with respect to u and v.
CagStatus cag_surface_corners(const CagSurface *s, CagHermiteCorners *out, CagError *err);
// The same for a surface that is one patch of degree 3 or lower in both directions, which these
// data determine. Fails with "not-one-patch" (inner knots), "degree-too-high", "rational-patch".
CagStatus cag_surface_hermite_corners(const CagSurface *s, CagHermiteCorners *out, CagError *err);

// Sets control point [i, j] of the distinct ones to p, and its weight if not negative.
CagStatus cag_surface_set_point(const CagSurface *s, size_t i, size_t j, CagVec3 p, double weight,
                                CagSurface **out, CagError *err);

// Edit of the u tangent, the v tangent, and the twist at a corner, in this order: each is
// multiplied by its factor, or replaced by the vector.
typedef struct CagCornerEdit {
  int u, v; // which end: 0 or 1
  bool by_vector[3];
  double factor[3];
  CagVec3 vector[3];
} CagCornerEdit;
// Moves the three control points next to the corner. Fails with "not-clamped", "zero-denominator".
CagStatus cag_surface_edit_corner(const CagSurface *s, const CagCornerEdit *edit, CagSurface **out,
                                  CagError *err);

// How a neighbor B continues a surface A across an edge: B_across = ratio A_across + shear(t)
// A_along, with the shear linear along the edge. Ratio 1 without shear is C1; otherwise the tangent
// planes agree (G1).
typedef struct CagEdgeMatch {
  double ratio, shear[2];
} CagEdgeMatch;
// The first two rows of control points of a patch over 0..1 of the given degree that continues s
// across the side (0: u0, 1: u1, 2: v0, 3: v1), in the direction of the side's parameter: 2 x
// *count x 4 homogeneous numbers, malloc'd. Fails with "join-folds" (ratio not positive),
// "join-degenerate" (a line of zero length across the edge), "join-shear" (shear on an edge with
// several pieces), "negative-weight".
CagStatus cag_surface_join_lines(const CagSurface *s, int side, int degree, const CagEdgeMatch *how,
                                 double **lines, size_t *count, CagError *err);
// Moves the two rows of b next to its edge nearest to an edge of a, so that b continues a there.
// Sides: NULL, or one of each.
CagStatus cag_surface_match(const CagSurface *a, const CagSurface *b, const CagEdgeMatch *how,
                            const int sides[2], CagSurface **out, CagError *err);

// A line u = at (direction 0) or v = at across which the tangents differ by up to this angle
// (radians).
typedef struct CagCrease {
  double at, angle;
} CagCrease;
CagStatus cag_surface_creases(const CagSurface *s, int direction, CagCrease **out, size_t *n,
                              CagError *err);

#endif
