// Patches between given edges and corners: Coons and Hermite (Coons 1967; Faux and Pratt
// 1979, chapter 7).

#ifndef CAG_GEOM_PATCHES_H
#define CAG_GEOM_PATCHES_H

#include "geom/surface/surface.h"

// Bilinearly blended between the curves on the sides u = 0, u = 1 (each along v), v = 0, v = 1
// (each along u), every one walked by the fraction of its domain. Fails with
// "coons-corner-mismatch".
CagStatus cag_surface_coons(const CagCurve *u0, const CagCurve *u1, const CagCurve *v0,
                            const CagCurve *v1, CagSurface **out, CagError *err);

// The developable surface between two curves: as cag_surface_ruled, but its rulings join points
// whose tangents lie in one plane with them. It runs as far as both curves have such rulings; v is
// the fraction of the first one's parameter there. Fails with "no-rulings".
CagStatus cag_surface_developable(const CagCurve *first, const CagCurve *second, CagSurface **out,
                                  CagError *err);

// Corner data of a bicubic patch, [i][j] at u = i, v = j.
typedef struct CagHermiteCorners {
  CagVec3 p[2][2], pu[2][2], pv[2][2], puv[2][2];
} CagHermiteCorners;
// The bicubic patch over [u0, u1] x [v0, v1], derivatives by the true parameters; a NURBS surface.
CagStatus cag_surface_hermite(const CagHermiteCorners *c, double u0, double u1, double v0,
                              double v1, CagSurface **out, CagError *err);
// The twists of the linear Coons surface on the same edges (Adini) over the unit square.
void cag_hermite_adini(CagHermiteCorners *c);

// Composite C2 bicubic surface through (m + 1) x (n + 1) points: tangents by u along u = 0 and u =
// m (n + 1 each), by v along v = 0 and v = n (m + 1 each), twists of the corners. Lengths of the
// parameter steps, m and n of them; NULL: 1.
typedef struct CagHermiteGrid {
  size_t nu, nv; // points: m + 1, n + 1
  const CagVec3 *points;
  const CagVec3 *u_start, *u_end, *v_start, *v_end;
  CagVec3 twist[2][2];
  const double *steps_u, *steps_v;
} CagHermiteGrid;
CagStatus cag_surface_hermite_grid(const CagHermiteGrid *g, CagSurface **out, CagError *err);

// The triangular Bezier surface of degree n from (n + 1)(n + 2) / 2 points b_ijk, i + j + k = n, in
// order of falling i, then falling j, as the tensor patch S(u, v) with barycentric 1 - u, u (1 -
// v), u v: exactly the same points, with the first corner as a pole at u = 0.
CagStatus cag_surface_bezier_triangle(const CagVec3 *points, int n, CagSurface **out,
                                      CagError *err);

#endif
