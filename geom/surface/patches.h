// Patches between given edges and corners: Coons and Hermite (Coons 1967; Faux and Pratt 1979,
// chapter 7).

#ifndef CAG_GEOM_PATCHES_H
#define CAG_GEOM_PATCHES_H

#include "geom/surface/surface.h"

// The bilinearly blended Coons patch between the curves on the sides u = 0, u = 1 (each along v), v
// = 0, v = 1 (each along u), each parametrized by the fraction of its domain. Fails with
// "coons-corner-mismatch".
CagStatus cag_surface_coons(const CagCurve *u0, const CagCurve *u1, const CagCurve *v0,
                            const CagCurve *v1, CagSurface **out, CagError *err);

// The developable surface between two curves: like cag_surface_ruled, but its rulings join points
// whose tangents are coplanar with the ruling. It extends as far as both curves have such rulings;
// v is the fraction of the first curve's parameter in that range. Fails with "no-rulings".
CagStatus cag_surface_developable(const CagCurve *first, const CagCurve *second, CagSurface **out,
                                  CagError *err);

// Corner data of a bicubic patch, [i][j] at u = i, v = j.
typedef struct CagHermiteCorners {
  CagVec3 p[2][2], pu[2][2], pv[2][2], puv[2][2];
} CagHermiteCorners;
// The bicubic patch over [u0, u1] x [v0, v1], with derivatives with respect to u and v; a NURBS
// surface.
CagStatus cag_surface_hermite(const CagHermiteCorners *c, double u0, double u1, double v0,
                              double v1, CagSurface **out, CagError *err);
// Sets the twists to those of the bilinearly blended Coons surface with the same edges (Adini) over
// the unit square.
void cag_hermite_adini(CagHermiteCorners *c);

// Composite C2 bicubic surface through (m + 1) x (n + 1) points, with u tangents along u = 0 and u
// = m (n + 1 each), v tangents along v = 0 and v = n (m + 1 each), and corner twists. steps_u,
// steps_v: the m and n parameter steps; NULL: 1.
typedef struct CagHermiteGrid {
  size_t nu, nv; // points: m + 1, n + 1
  const CagVec3 *points;
  const CagVec3 *u_start, *u_end, *v_start, *v_end;
  CagVec3 twist[2][2];
  const double *steps_u, *steps_v;
} CagHermiteGrid;
CagStatus cag_surface_hermite_grid(const CagHermiteGrid *g, CagSurface **out, CagError *err);

// The triangular Bezier surface of degree n from (n + 1)(n + 2) / 2 points b_ijk, i + j + k = n,
// ordered by descending i, then descending j, as the tensor product patch S(u, v) with barycentric
// coordinates 1 - u, u (1 - v), u v: exactly the same points, with the first corner as a pole at u
// = 0.
CagStatus cag_surface_bezier_triangle(const CagVec3 *points, int n, CagSurface **out,
                                      CagError *err);

#endif
