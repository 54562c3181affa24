// The parts of a surface's fit to a grid, for the files that do it: grid_fit.c leads, grid_solve.c
// solves for the net, grid_hold.c holds a coordinate.
//
// Parameters of the data lie in the usable ranges of the axes. Where a coordinate is held, `held`
// has that of every control point, from the start of the rounds: solving changes the others alone,
// so that parameters which match the coordinate go on matching it.

#ifndef CAG_GEOM_GRID_FIT_H
#define CAG_GEOM_GRID_FIT_H

#include "geom/linalg/tolerance.h"
#include "geom/surface/loft.h"

// A diagonal element of R below this part of the largest means dependent columns.
#define CAG_GRID_RANK CAG_ROUNDING
// Basis values stand on the stack.
#define CAG_GRID_DEGREE_MOST 31

// Control points in one direction and their knots, as a spline on the line has them.
typedef struct CagGridAxis {
  int degree;
  size_t count, stored; // distinct points; with the repeated ones of a closed direction
  bool closed;
  double *knots; // stored + degree + 1
} CagGridAxis;

typedef struct CagGridFit {
  const CagGridData *g;
  CagGridAxis axis[2];
  size_t rows; // of all data
  double *parameters[2];
  CagVec3 *net;
  bool edges;       // open edges of the net are fitted to the border of the data alone
  double *held;     // nu x nv; NULL: no coordinate is held
  double *planes;   // where the control points lie, by the lines of a direction; NULL: by the data
  int planes_along; // 0: u
} CagGridFit;

static inline double *cag_grid_coordinate(const CagGridFit *f, CagVec3 *p) {
  return f->g->hold == CAG_GRID_HOLD_X ? &p->x : f->g->hold == CAG_GRID_HOLD_Y ? &p->y : &p->z;
}

static inline double cag_grid_start(const CagGridAxis *a) { return a->knots[a->degree]; }
static inline double cag_grid_end(const CagGridAxis *a) { return a->knots[a->stored]; }
// t moved by a step within its axis; a closed one goes round.
double cag_grid_moved(const CagGridAxis *a, double t, double step);
// Whether a point of the data lies on an open border, and so keeps its parameter in a direction.
bool cag_grid_on_border(const CagGridFit *f, size_t i, int direction);

// The net for the present parameters. Fails with "fit-singular", "fit-too-large", "fit-ends".
CagStatus cag_grid_solve(CagGridFit *f, CagError *err);
// The surface of the net that is solved for.
CagStatus cag_grid_surface(CagGridFit *f, CagSurface **out, CagError *err);

// Takes hold of the coordinate: planes are found or checked, and parameters moved to where the
// surface has the data's coordinate. *rounds: in how many they moved. Fails with "plane-count",
// "planes-not-monotone", "planes-closed", "beyond-planes", "coordinate-turns", "fit-no-convergence"
// and as solving does.
CagStatus cag_grid_hold(CagGridFit *f, int *rounds, CagError *err);
// One step of all data along the lines on which the held coordinate does not change, towards where
// the surface is nearest.
CagStatus cag_grid_correct_held(CagGridFit *f, const CagSurface *s, CagError *err);

#endif
