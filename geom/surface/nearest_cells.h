// Cells of a surface with lower bounds of their distances from a point, in a priority queue by
// bound.
//
// If the surface has an exact form, a cell is a part of one of its Bezier patches, and the bound is
// rigorous: the squared distance is a quotient of two polynomials in Bernstein form, and is nowhere
// less than the smallest quotient of their coefficients. Cells then have the parameters of the
// exact form. For tubes, sweeps, and twisted extrusions the derivatives are bounded by intervals
// (nearest_swept.h). Other surfaces are sampled: the squared distance on a cell is approximated by
// a biquadratic polynomial, minus the error at further samples with a safety factor.

#ifndef CAG_GEOM_SURFACE_NEAREST_CELLS_H
#define CAG_GEOM_SURFACE_NEAREST_CELLS_H

#include "geom/surface/surface.h"
#include "geom/surface/swept.h"

typedef struct CagDistanceCell {
  double u[2], v[2];
  double bound;       // lower bound of the squared distance
  double least;       // the smallest squared distance at known points of the cell
  double least_at[2]; // its parameters
  double low_at[2];   // where the bound is nearly attained
  CagVec3 least_point;
  bool whole;   // an initial cell, not a half of another
  bool raw;     // known only by its box; `least` and the following members are not set
  bool across;  // to be halved in v
  size_t block; // index of its control points; for a raw cell its index in the net
} CagDistanceCell;

// A tube, a sweep, or a twisted extrusion.
typedef struct CagSwept {
  const CagCurve *section; // NULL for other surfaces
  const CagMotion *motion; // NULL for an extrusion
  CagTwisted extrusion;
  CagTransform map; // of the surface made from section and motion
  bool flip;        // its v is reversed
  bool tube;        // cells are intervals of v: the section is a circle about the path
  double radius, scale;
  CagVec3 p; // for a tube: in its local coordinates
} CagSwept;

typedef struct CagDistanceCells {
  const CagSurface *s;
  CagSurface *exact; // owned; NULL: sampled
  bool same;         // the parameters of cells are those of s, up to an affine map
  CagVec3 p;
  double size; // distance of the farthest known point from p, to which rounding is relative
  CagSwept swept;
  bool certain;   // whether the bounds are rigorous
  double hint[2]; // parameters of the best point found so far
  // For Bezier patches: degrees, whether rational, and binomial coefficients of p, q, 2 p, 2 q.
  int p_degree, q_degree;
  bool rational;
  double *binomials[4];
  double *work;
  CagDistanceCell *items; // a heap
  size_t count, capacity;
  double *blocks; // of control points minus p, in homogeneous coordinates
  size_t block_size, block_count, block_capacity;
  size_t *unused;
  size_t unused_count;
} CagDistanceCells;

// Covers the whole surface. `own_parameters`: do not use an exact form with different parameters.
// Must be freed even on failure.
CagStatus cag_distance_cells_make(CagDistanceCells *c, const CagSurface *s, CagVec3 p,
                                  bool own_parameters, CagError *err);
void cag_distance_cells_free(CagDistanceCells *c);
CagStatus cag_distance_cells_push(CagDistanceCells *c, const CagDistanceCell *cell, CagError *err);
// Removes the cell with the lowest bound. *found is false if there is none, or if its bound is not
// below `below`.
CagStatus cag_distance_cells_next(CagDistanceCells *c, double below, CagDistanceCell *out,
                                  bool *found, CagError *err);
// Adds both halves of a removed cell whose bound is below `below`.
CagStatus cag_distance_cells_halve(CagDistanceCells *c, const CagDistanceCell *cell, double below,
                                   CagError *err);
// Releases a removed cell that is not halved.
void cag_distance_cells_drop(CagDistanceCells *c, const CagDistanceCell *cell);

#endif
