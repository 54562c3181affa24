// Shared by the files that fit a surface to a grid: grid_fit.c drives the fit, grid_solve.c solves
// for the control net, grid_hold.c keeps one coordinate exact.
//
// Parameters of the data lie in the usable ranges of the axes. If a coordinate is held, `held` has
// that coordinate of every control point from the start of the iteration. Solving changes only the
// other coordinates, so parameters that match the held one continue to match it.

#ifndef CAG_GEOM_GRID_FIT_H
#define CAG_GEOM_GRID_FIT_H

#include "geom/linalg/tolerance.h"
#include "geom/surface/loft.h"

// A diagonal entry of R below this fraction of the largest means dependent columns.
#define CAG_GRID_RANK CAG_ROUNDING
// Basis values are kept on the stack.
#define CAG_GRID_DEGREE_MOST 31

// Number of control points in one direction and their knots.
typedef struct CagGridAxis {
  int degree;
  size_t count, stored; // distinct points; including the repeated ones of a closed direction
  bool closed;
  double *knots; // stored + degree + 1
} CagGridAxis;

typedef struct CagGridFit {
  const CagGridData *g;
  CagGridAxis axis[2];
  size_t rows; // number of all data points
  double *parameters[2];
  CagVec3 *net;
  bool edges;       // open edges of the net are fitted only to the border of the data
  double *held;     // nu x nv; NULL: no coordinate is held
  double *planes;   // positions of the control points, by the lines of a direction; NULL: from the
                    // data
  int planes_along; // 0: u
} CagGridFit;

static inline double *cag_grid_coordinate(const CagGridFit *f, CagVec3 *p) {
  return f->g->hold == CAG_GRID_HOLD_X ? &p->x : f->g->hold == CAG_GRID_HOLD_Y ? &p->y : &p->z;
}

static inline double cag_grid_start(const CagGridAxis *a) { return a->knots[a->degree]; }
static inline double cag_grid_end(const CagGridAxis *a) { return a->knots[a->stored]; }
// t moved by a step within its axis; a closed axis wraps around.
double cag_grid_moved(const CagGridAxis *a, double t, double step);
// Whether a data point lies on an open border, and so keeps its parameter in a direction.
bool cag_grid_on_border(const CagGridFit *f, size_t i, int direction);

// The control net for the current parameters. Fails with "fit-singular", "fit-too-large",
// "fit-ends".
CagStatus cag_grid_solve(CagGridFit *f, CagError *err);
// The surface of the current net.
CagStatus cag_grid_surface(CagGridFit *f, CagSurface **out, CagError *err);

// Starts holding the coordinate: finds or checks the planes, and moves the parameters to where the
// surface has the data's coordinate. *rounds: number of rounds in which parameters moved. Fails
// with "plane-count", "planes-not-monotone", "planes-closed", "beyond-planes", "coordinate-turns",
// "fit-no-convergence", and like cag_grid_solve.
CagStatus cag_grid_hold(CagGridFit *f, int *rounds, CagError *err);
// One step that moves all data parameters along the lines of constant held coordinate, towards the
// nearest points of the surface.
CagStatus cag_grid_correct_held(CagGridFit *f, const CagSurface *s, CagError *err);

#endif
