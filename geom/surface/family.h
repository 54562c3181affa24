// Shared by the implementations of the kinds of surfaces; not for users of surfaces.

#ifndef CAG_GEOM_SURFACE_FAMILY_H
#define CAG_GEOM_SURFACE_FAMILY_H

#include "geom/surface/surface.h"

// Points closer than this fraction of the size of the data are identical: the rounding of a few
// evaluations, far below any tolerance of a user.
#define CAG_SURFACE_SAME 1e-11

// Zeroed block of `size` bytes (a struct that starts with CagSurface) with one reference.
CagStatus cag_surface_block(size_t size, const CagSurfaceKind *kind, double u0, double u1,
                            double v0, double v1, CagSurface **out, CagError *err);
// Determines closed_u, closed_v, and the poles by evaluation along the edges.
void cag_surface_judge(CagSurface *s);

// The image of a surface under an affine map, with v reversed if `flip`. Evaluates exactly; it has
// no exact form beyond that of `inner`.
CagStatus cag_surface_placed(const CagSurface *inner, const CagTransform *t, bool flip,
                             CagSurface **out, CagError *err);
// Whether the surface is a placed one with v reversed.
bool cag_surface_is_flipped(const CagSurface *s);
// For kinds without a transform of their own: affine maps return a placed surface, projective ones
// require the exact NURBS form.
CagStatus cag_surface_transform_placed(const CagSurface *s, const CagTransform *t, CagSurface **out,
                                       CagError *err);

// A curve as a space curve; retained unchanged if it already is one.
CagStatus cag_surface_space_curve(const CagCurve *c, CagCurve **out, CagError *err);

// NURBS surface from homogeneous points (w x, w y, w z, w), nu x nv x 4.
CagStatus cag_surface_from_homogeneous(const double *net, size_t nu, size_t nv, int degree_u,
                                       int degree_v, const double *knots_u, const double *knots_v,
                                       CagSurface **out, CagError *err);
// The NURBS surface with exchanged parameters: S'(u, v) = S(v, u).
CagStatus cag_surface_nurbs_swapped(const CagSurface *s, CagSurface **out, CagError *err);

// A piece of a conic or polynomial as a NURBS curve in homogeneous coordinates (x, y, w): the
// building block of exact forms.
typedef enum CagConicArc {
  CAG_ARC_CIRCLE,    // cos t, sin t
  CAG_ARC_HYPERBOLA, // cosh t, sinh t
  CAG_ARC_PARABOLA,  // t^2, t
  CAG_ARC_LINE       // 1, t
} CagConicArc;
#define CAG_CONIC_ARC_POINTS 19 // a circle covered twice, in pieces of at most 90 degrees
#define CAG_CONIC_ARC_KNOTS (CAG_CONIC_ARC_POINTS + 3)
typedef struct CagConicNurbs {
  int degree;
  size_t count;
  double points[CAG_CONIC_ARC_POINTS][3];
  double knots[CAG_CONIC_ARC_KNOTS]; // circle: 0, 1, .. per piece; else the parameter itself
} CagConicNurbs;
void cag_conic_nurbs(CagConicArc arc, double from, double to, CagConicNurbs *out);

// The breaks of an underlying surface within the range of a surface based on it, which stores them.
// Free `at`.
typedef struct CagKeptBreaks {
  double *at;
  size_t n;
} CagKeptBreaks;
CagStatus cag_surface_keep_breaks(const CagSurface *inner, int direction, double lo, double hi,
                                  CagKeptBreaks *out, CagError *err);
size_t cag_surface_kept_breaks(const CagKeptBreaks *kept, double *out, size_t capacity);
// Sorts the values of a within (lo, hi) and removes duplicates, up to rounding; returns their
// number.
size_t cag_surface_tidy_breaks(double *a, size_t n, double lo, double hi);

// The radii of a surface of kind "torus". Returns false for another kind.
bool cag_surface_torus_view(const CagSurface *s, double *major, double *minor);

#endif
