// Surfaces: immutable, reference counted values of several kinds with a common table of functions.
//
// A surface maps the rectangle [u0, u1] x [v0, v1] to space. Parameters are natural (knots,
// radians); `angular_u` and `angular_v` mark those that the language shows as angles. The normal is
// along S_u x S_v. The data of a kind follow the header, as for curves. Flags mark poles (an edge
// of the rectangle that maps to one point) and seams (opposite edges that coincide), so that a mesh
// shares their vertices exactly.

#ifndef CAG_GEOM_SURFACE_H
#define CAG_GEOM_SURFACE_H

#include "geom/curve/curve.h"
#include "geom/curve/region.h"

typedef struct CagSurface CagSurface;

// Partial derivatives up to total order n, n <= CAG_MAX_PARTIAL: out[CAG_PARTIAL(i, j)] is the i-th
// by u and j-th by v; row-major square of side n + 1.
#define CAG_MAX_PARTIAL 8
static inline size_t cag_partial(int n, int i, int j) {
  return (size_t)i * (size_t)(n + 1) + (size_t)j;
}

typedef struct CagSurfaceKind {
  const char *name; // "nurbs", "bezier", "revolution", "extrusion", "ruled", "quadric", "torus",
                    // "tube", "planar" ...
  // All partials of total order <= n at (u, v): out[(n + 1) * (n + 1)], as limits from the given
  // sides. Entries with i + j > n are not written.
  CagStatus (*eval)(const CagSurface *s, double u, double v, int n, CagSide side_u, CagSide side_v,
                    CagVec3 *out, CagError *err);
  // Points and, unless NULL, first partials at (us[i], vs[j]), index i * nv + j. NULL: eval is
  // called for each.
  CagStatus (*eval_grid)(const CagSurface *s, const double *us, size_t nu, const double *vs,
                         size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv, CagError *err);
  CagStatus (*to_nurbs)(const CagSurface *s, CagSurface **out, CagError *err); // exact form; NULL:
                                                                               // none
  CagStatus (*transform)(const CagSurface *s, const CagTransform *t, CagSurface **out,
                         CagError *err);
  size_t (*breaks)(const CagSurface *s, int direction, double *out,
                   size_t capacity); // interior breaks, as for curves; direction 0: u, 1: v
  void (*describe)(const CagSurface *s, char *buffer, size_t size);
  void (*destroy)(CagSurface *s);
  // Adds what the surface was made of, apart from its kind and domain.
  void (*digest)(const CagSurface *s, CagDigest *d);
} CagSurfaceKind;

struct CagSurface {
  const CagSurfaceKind *kind;
  int references;
  double u0, u1, v0, v1;
  bool angular_u, angular_v;
  bool closed_u, closed_v;                 // S(u0, v) == S(u1, v) for all v; likewise v
  bool pole_u0, pole_u1, pole_v0, pole_v1; // the edge u = u0 (etc.) is one point
  bool unrolled;                           // made by cag_surface_unroll: its edges form one outline
};

CagSurface *cag_surface_retain(const CagSurface *s);
void cag_surface_release(CagSurface *s);
// Adds everything that the surface depends on to a digest: those with equal digests are the same.
void cag_surface_digest(const CagSurface *s, CagDigest *d);
bool cag_check_surface(const CagSurface *s); // see cag_check_curve

// --- Constructors ---
// Tensor product NURBS: net[i * nv + j] = point (i by u, j by v); weights NULL: polynomial. Kind
// "bspline" or "nurbs", or "bezier" for Bezier knots over 0..1.
CagStatus cag_surface_nurbs(const CagVec3 *net, const double *weights, size_t nu, size_t nv,
                            int degree_u, int degree_v, const double *knots_u,
                            const double *knots_v, CagSurface **out, CagError *err);
// With closed directions: a closed direction has distinct points, uniform periodic knots, and the
// domain 0..count; its knots are NULL, or all count + 2 degree + 1 of them, equally spaced.
CagStatus cag_surface_nurbs_closed(const CagVec3 *net, const double *weights, size_t nu, size_t nv,
                                   int degree_u, int degree_v, const double *knots_u,
                                   const double *knots_v, bool closed_u, bool closed_v,
                                   CagSurface **out, CagError *err);
CagStatus cag_surface_bezier(const CagVec3 *net, const double *weights, size_t nu, size_t nv,
                             CagSurface **out, CagError *err);
// A curve revolved about the axis through a point over the angles [from, to]; u is the curve's
// parameter, v the angle (radians).
CagStatus cag_surface_revolve(const CagCurve *profile, CagVec3 axis, CagVec3 through, double from,
                              double to, CagSurface **out, CagError *err);
CagStatus cag_surface_bilinear(CagVec3 p00, CagVec3 p01, CagVec3 p10, CagVec3 p11, CagSurface **out,
                               CagError *err); // p01: u = 0, v = 1
// Kind "plane": origin + u x + v y for u and v in 0..1. The view returns false for another kind.
CagStatus cag_surface_parallelogram(CagVec3 origin, CagVec3 x, CagVec3 y, CagSurface **out,
                                    CagError *err);
bool cag_surface_parallelogram_view(const CagSurface *s, CagVec3 *origin, CagVec3 *x, CagVec3 *y);
// The ruled surface between two curves: u = 0 on the second, u = 1 on the first; v in 0..1 along
// both (each reparametrized to 0..1).
CagStatus cag_surface_ruled(const CagCurve *first, const CagCurve *second, CagSurface **out,
                            CagError *err);
// A curve extruded along the vector: u is the curve's parameter, v in 0..1; twist (radians) and
// scale about the z axis are reached at v = 1.
CagStatus cag_surface_extrude(const CagCurve *c, CagVec3 v, double twist, double scale,
                              CagSurface **out, CagError *err);
CagStatus cag_surface_translational(const CagCurve *a, const CagCurve *b, CagSurface **out,
                                    CagError *err); // a(u) + b(v) - b(start)
// A circle carried along the path in rotation-minimizing frames (double reflection, Wang et al.
// 2008): u is the angle around, v the path's parameter.
CagStatus cag_surface_tube(const CagCurve *path, double radius, CagSurface **out, CagError *err);
// A superellipsoid of positive size about the origin with exponents e around Z and n along it, both
// in 0.01..2. u is the longitude, v the latitude; normals point outward.
CagStatus cag_surface_superellipsoid(CagVec3 size, double e, double n, CagSurface **out,
                                     CagError *err);
CagStatus cag_surface_torus(double major, double minor, CagSurface **out, CagError *err);
// The part of the XY plane within a region (trimmed), placed by `frame`; u, v are x, y of the
// region.
CagStatus cag_surface_planar(const CagRegion *region, const CagTransform *frame, CagSurface **out,
                             CagError *err);
bool cag_surface_planar_view(const CagSurface *s, const CagRegion **region, CagTransform *frame);

typedef struct CagSurfaceNurbsView {
  int degree_u, degree_v;
  size_t nu, nv; // as stored
  size_t distinct_u, distinct_v;
  bool periodic_u, periodic_v, rational;
  const double *knots_u, *knots_v;
  const double *homogeneous; // nu x nv x 4
} CagSurfaceNurbsView;
bool cag_surface_nurbs_view(const CagSurface *s, CagSurfaceNurbsView *out);
// Profile, axis, and angles of a revolution, for exporters with native lathes.
bool cag_surface_revolution_view(const CagSurface *s, const CagCurve **profile, CagVec3 *axis,
                                 CagVec3 *through, double *from, double *to);
// Of a surface of revolution whose profile is in a plane with the axis: a unit direction from the axis
// in this plane, and whether the profile is on this side of the axis only. False for others.
bool cag_surface_meridian_view(const CagSurface *s, CagVec3 *radial, bool *one_sided);
// Section and direction of an extrusion without twist or scale; false: another surface.
bool cag_surface_extrusion_view(const CagSurface *s, const CagCurve **section, CagVec3 *along);
// The parts of a placed surface: S(u, v) is the image of `inner` under `map`, with v reversed if it
// was flipped. Returns false for surfaces that are not placed.
bool cag_surface_placed_view(const CagSurface *s, const CagSurface **inner, CagTransform *map);

// --- Queries ---
CagStatus cag_surface_eval(const CagSurface *s, double u, double v, int n, CagSide su, CagSide sv,
                           CagVec3 *out, CagError *err);
CagStatus cag_surface_point(const CagSurface *s, double u, double v, CagVec3 *out, CagError *err);
CagStatus cag_surface_eval_grid(const CagSurface *s, const double *us, size_t nu, const double *vs,
                                size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv,
                                CagError *err);
CagStatus cag_surface_normal(const CagSurface *s, double u, double v, CagVec3 *out,
                             CagError *err); // the limit at poles if there is one
CagStatus cag_surface_bounds(const CagSurface *s, CagBounds *out, CagError *err);
// The ends of the smooth intervals along a direction, ascending: *n + 1 values, malloc'd.
CagStatus cag_surface_cuts(const CagSurface *s, int direction, double **out, size_t *n,
                           CagError *err);
// End number k of the intervals when each is divided into `parts` equal ones.
double cag_cut_part(const double *cuts, size_t k, size_t parts);
// Integrals over the exact surface (adaptive tensor product Gauss-Kronrod, 1e-8 relative); volume
// by the divergence theorem, first moments for the centroid.
typedef struct CagMassProperties {
  double area, volume;
  CagVec3 area_centroid, volume_centroid;
  double inertia[3][3]; // about the volume centroid, density 1
} CagMassProperties;
CagStatus cag_surface_area(const CagSurface *s, double *area, CagVec3 *centroid, CagError *err);
// Contribution of the surface to the volume integrals (signed by its normal), added to `terms`. The
// sum over the faces of a closed shell gives its volume.
CagStatus
cag_surface_volume_terms(const CagSurface *s, double terms[10],
                         CagError *err); // V, Mx My Mz, Ixx Iyy Izz Ixy Iyz Izx about the origin
CagStatus cag_surface_to_nurbs(const CagSurface *s, CagSurface **out, CagError *err);
CagStatus cag_surface_transform(const CagSurface *s, const CagTransform *t, CagSurface **out,
                                CagError *err);
CagStatus cag_surface_flip(const CagSurface *s, CagSurface **out,
                           CagError *err); // reverses the normal: v is reversed
CagStatus cag_surface_isocurve(const CagSurface *s, int direction, double at, CagCurve **out,
                               CagError *err);   // direction 0: u fixed
bool cag_surface_is_closed(const CagSurface *s); // has no boundary

#endif
