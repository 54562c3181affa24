// What several files of built-ins on surfaces share.

#ifndef CAG_INTERP_BUILTIN_SURFACES_H
#define CAG_INTERP_BUILTIN_SURFACES_H

#include "geom/meet/section.h"
#include "geom/surface/motion.h"
#include "geom/surface/quadric.h"
#include "interp/builtin/holds.h"
#include "interp/builtin/shapes.h"

// A surface, or the side of a solid that a section sweeps; borrowed.
bool cag_arg_side(CagCall *call, int argument, CagSurface **out);
// "right" or "left", or two of them for u and v: the side from which limits are meant.
bool cag_arg_surface_sides(CagCall *call, int argument, CagSide out[2]);
// How a frame moves along a path: "rmf", "frenet", "fixed", or the direction that its y is next to.
bool cag_arg_orient(CagCall *call, int argument, CagPathMotion *how);
// A side of each of two surfaces (0: u0, 1: u1, 2: v0, 3: v1), where they are given.
bool cag_arg_edges(CagCall *call, int argument, int out[2], bool *given);
// A vector of 2 or 3 finite numbers; false: it is none.
bool cag_read_vector(CagValue v, CagVec3 *out);
// Rows of points of one length, as the first argument; *points is held.
bool cag_arg_grid(CagCall *call, CagVec3 **points, size_t *rows, size_t *columns);
// The value for u or v (0 or 1) of an argument that is one for both, or a list of two.
CagValue cag_one_of_two(CagCall *call, int argument, int direction);
// Whether u and v are closed.
bool cag_arg_closed(CagCall *call, int argument, bool closed[2]);
// Reads the net of a triangular Bezier surface, rows of 1, 2, 3 ... points; *net is held.
#define CAG_TRIANGLE_ROWS 1000
bool cag_arg_triangle(CagCall *call, int argument, CagVec3 **net, int *degree);
// The equation of the first argument: a quadric surface, the sheets of one, a sphere, or what
// `quadric` takes.
bool cag_arg_quadric(CagCall *call, CagQuadric *q);
// The control points of a surface; fails, saying that it has no `what`, where there are none.
bool cag_surface_net(CagCall *call, const CagSurface *s, const char *what,
                     CagSurfaceNurbsView *net);
// Reads u and v of a surface from the parameters `at` and the next.
bool cag_arg_uv(CagCall *call, const CagSurface *s, int at, double *u, double *v);
// Reads a surface or side, and u and v of it, from the first three parameters.
bool cag_arg_side_uv(CagCall *call, CagSurface **s, double *u, double *v);

// --- What is held until the built-in ends (surfaces_held.c) ---
// Surfaces that the core makes; cag_hold_surfaces gives an empty array to be filled.
typedef struct CagSurfaceArray {
  CagSurface **items;
  size_t count;
} CagSurfaceArray;
CagSurfaceArray *cag_hold_surfaces(CagCall *call);
// Points in space as a list of rows.
CagValue cag_table_value(CagVm *vm, const CagVec3 *points, size_t rows, size_t columns);
// {u: u, v: v}
CagValue cag_uv_value(CagVm *vm, CagValue u, CagValue v);
// The curves as a list.
CagValue cag_curve_list_value(CagVm *vm, const CagCurveList *list);

// A region turned about an axis that lies in its plane, to a solid.
bool cag_region_revolved(CagCall *call, const CagRegion *region, const CagTransform *place,
                         CagVec3 axis, CagVec3 through, double from, double to, CagValue *result);

// Reads the first argument as the 10 numbers or 4 rows of a quadric (surfaces_quadric.c).
bool cag_surfaces_read_form(CagCall *call, CagQuadric *q);

#endif
