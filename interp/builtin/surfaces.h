// Functions of the surfaces' table (surfaces.c), by the file that holds them.

#ifndef CAG_INTERP_BUILTIN_SURFACES_H
#define CAG_INTERP_BUILTIN_SURFACES_H

#include "geom/meet/section.h"
#include "geom/surface/quadric.h"
#include "interp/builtin/holds.h"
#include "interp/builtin/shapes.h"

// clang-format off
#define CAG_SURFACE_FUNCTIONS(X) \
  /* surfaces_ask.c: at one place, and data */ \
  X(at) X(partial) X(normal) X(tangent_plane) X(domain) X(degree) X(knots) X(points) \
  X(weights) X(is_closed) X(closed_in) \
  /* surfaces_curvature.c */ \
  X(first_form) X(second_form) X(gaussian_curvature) X(mean_curvature) X(normal_curvature) \
  X(principal_curvatures) X(curvature_class) \
  /* surfaces_change.c: of the whole, and what is made of it */ \
  X(area) X(volume) X(centroid) X(sample) X(to_nurbs) X(flip) X(isocurve) X(boundary) \
  /* surfaces_make.c: of curves */ \
  X(revolve) X(extrude) X(ruled) X(bilinear) X(translational) X(sphere_surface) \
  X(torus_surface) \
  /* surfaces_sweep.c */ \
  X(sweep) X(sweep_by) X(tube) X(loft) \
  /* surfaces_reshape.c */ \
  X(trim) X(split) X(insert_knot) X(refine) X(elevate) X(to_bezier) X(transpose_uv) \
  X(join_surfaces) X(continuity) X(offset) X(thicken) \
  /* surfaces_fit.c */ \
  X(interpolate_surface) X(fit_surface) X(fit_surface_report) X(grid_parameters) X(is_developable) X(unroll) \
  /* surfaces_map.c */ \
  X(map_onto) X(remap) \
  /* surfaces_patch.c */ \
  X(developable) X(coons) X(coons_bicubic) X(hermite_patch) X(hermite_surface) \
  X(bezier_triangle) \
  /* surfaces_net.c: of nets of points */ \
  X(bezier_surface) X(bspline_surface) X(nurbs_surface) \
  /* surfaces_quadric.c */ \
  X(quadric) X(ellipsoid) X(hyperboloid) X(paraboloid) X(hyperbolic_paraboloid) \
  X(elliptic_cone) X(elliptic_cylinder) X(parabolic_cylinder) X(hyperbolic_cylinder) \
  X(classify)
// clang-format on

#define X(name) bool cag_surfaces_##name(CagCall *call, CagValue *result);
CAG_SURFACE_FUNCTIONS(X)
#undef X

// A surface, or the side of a solid that a section sweeps; borrowed.
bool cag_arg_side(CagCall *call, int argument, CagSurface **out);
// "right" or "left", or two of them for u and v: the side from which limits are meant.
bool cag_arg_surface_sides(CagCall *call, int argument, CagSide out[2]);
// A side of each of two surfaces (0: u0, 1: u1, 2: v0, 3: v1), where they are given.
bool cag_arg_edges(CagCall *call, int argument, int out[2], bool *given);
// Reads the net of a triangular Bezier surface, rows of 1, 2, 3 ... points; *net is malloc'd.
#define CAG_TRIANGLE_ROWS 1000
bool cag_arg_triangle(CagCall *call, int argument, CagVec3 **net, int *degree);
// The equation of the first argument: a quadric surface, the sheets of one, a sphere, or what
// `quadric` takes.
bool cag_arg_quadric(CagCall *call, CagQuadric *q);
// "net-not-rectangular": row 0 of the first argument has `wanted` points, this row another number.
bool cag_fail_rows(CagCall *call, size_t wanted, size_t row, size_t found);
// Reads u and v of a surface from the parameters `at` and the next.
bool cag_arg_uv(CagCall *call, const CagSurface *s, int at, double *u, double *v);

// --- What is held until the built-in ends (surfaces_held.c) ---
// Surfaces that the core makes; cag_hold_surfaces gives an empty array to be filled.
typedef struct CagSurfaceArray {
  CagSurface **items;
  size_t count;
} CagSurfaceArray;
CagSurfaceArray *cag_hold_surfaces(CagCall *call);
// The curves as a list.
CagValue cag_curve_list_value(CagVm *vm, const CagCurveList *list);

// A region turned about an axis that lies in its plane, to a solid.
bool cag_region_revolved(CagCall *call, const CagRegion *region, const CagTransform *place,
                         CagVec3 axis, CagVec3 through, double from, double to, CagValue *result);

// Reads the first argument as the 10 numbers or 4 rows of a quadric (surfaces_quadric.c).
bool cag_surfaces_read_form(CagCall *call, CagQuadric *q);

#endif
