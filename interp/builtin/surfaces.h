// Declarations shared by the built-ins on surfaces.

#ifndef CAG_INTERP_BUILTIN_SURFACES_H
#define CAG_INTERP_BUILTIN_SURFACES_H

#include "geom/meet/section.h"
#include "geom/surface/motion.h"
#include "geom/surface/quadric.h"
#include "interp/builtin/holds.h"
#include "interp/builtin/shapes.h"

// Reads a surface, or the side of a solid that a section sweeps; borrowed.
bool cag_arg_side(CagCall *call, int argument, CagSurface **out);
// Reads "right" or "left", or two of them for u and v: the side of one-sided limits.
bool cag_arg_surface_sides(CagCall *call, int argument, CagSide out[2]);
// Reads how a frame moves along a path: "rmf", "frenet", "fixed", or a direction that its y axis
// follows.
bool cag_arg_orient(CagCall *call, int argument, CagPathMotion *how);
// Reads an optional pair of edges, one of each of two surfaces (0: u0, 1: u1, 2: v0, 3: v1).
bool cag_arg_edges(CagCall *call, int argument, int out[2], bool *given);
// Reads a vector of 2 or 3 finite numbers. Returns false if v is not one.
bool cag_read_vector(CagValue v, CagVec3 *out);
// Reads rows of points of one length, the first argument; *points is held.
bool cag_arg_grid(CagCall *call, CagVec3 **points, size_t *rows, size_t *columns);
// Returns the value for u or v (0 or 1) of an argument that is one value for both, or a list of
// two.
CagValue cag_one_of_two(CagCall *call, int argument, int direction);
// Reads whether u and v are closed.
bool cag_arg_closed(CagCall *call, int argument, bool closed[2]);
// Reads the net of a triangular Bezier surface, rows of 1, 2, 3, ... points; *net is held.
#define CAG_TRIANGLE_ROWS 1000
bool cag_arg_triangle(CagCall *call, int argument, CagVec3 **net, int *degree);
// Reads the equation of the first argument: a quadric surface, the sheets of one, a sphere, or an
// argument of `quadric`.
bool cag_arg_quadric(CagCall *call, CagQuadric *q);
// Returns the control points of a surface. If there are none, fails with a message that it has no
// `what`.
bool cag_surface_net(CagCall *call, const CagSurface *s, const char *what,
                     CagSurfaceNurbsView *net);
// Reads u and v of a surface from the parameters `at` and at + 1.
bool cag_arg_uv(CagCall *call, const CagSurface *s, int at, double *u, double *v);
// Reads a surface or side, and u and v of it, from the first three parameters.
bool cag_arg_side_uv(CagCall *call, CagSurface **s, double *u, double *v);

// --- Surfaces and curves held until the built-in ends (surfaces_held.c) ---
// Surfaces created by the core. cag_hold_surfaces returns an empty array to be filled.
typedef struct CagSurfaceArray {
  CagSurface **items;
  size_t count;
} CagSurfaceArray;
CagSurfaceArray *cag_hold_surfaces(CagCall *call);
// Returns points in space as a list of rows.
CagValue cag_table_value(CagVm *vm, const CagVec3 *points, size_t rows, size_t columns);
// The record {u: u, v: v}.
CagValue cag_uv_value(CagVm *vm, CagValue u, CagValue v);
// Returns the curves as a list.
CagValue cag_curve_list_value(CagVm *vm, const CagCurveList *list);

// Revolves a region about an axis in its plane to a solid.
bool cag_region_revolved(CagCall *call, const CagRegion *region, const CagTransform *place,
                         CagVec3 axis, CagVec3 through, double from, double to, CagValue *result);

// Reads the first argument as the 10 numbers or 4 rows of a quadric (surfaces_quadric.c).
bool cag_surfaces_read_form(CagCall *call, CagQuadric *q);

#endif
