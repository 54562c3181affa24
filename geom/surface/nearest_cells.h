// Cells of a surface with lower bounds of their distances from a point, the lowest bound first.
//
// Where the surface has an exact form, a cell is a part of one of its Bezier patches, and the bound
// is certain: the squared distance is a quotient of two polynomials in Bernstein form, and is
// nowhere less than the least quotient of their coefficients. Cells then have the parameters of
// the exact form. Of tubes, sweeps and twisted extrusions the derivatives are bounded by ranges
// (nearest_swept.h). Other surfaces are sampled: the squared distance of a cell is a biquadratic
// polynomial but for what further samples miss it by, with some safety.

#ifndef CAG_GEOM_SURFACE_NEAREST_CELLS_H
#define CAG_GEOM_SURFACE_NEAREST_CELLS_H

#include "geom/surface/surface.h"
#include "geom/surface/swept.h"

typedef struct CagDistanceCell {
  double u[2], v[2];
  double bound;       // of the squared distance
  double least;       // the least squared distance among known points of the cell
  double least_at[2]; // and its parameters
  double low_at[2];   // where the bound is attained, nearly
  CagVec3 least_point;
  bool whole;   // as the cells began, not a half of another
  bool raw;     // known by its box alone; `least` and what follows are not set
  bool across;  // to be halved by v
  size_t block; // its control points; of a raw one its place in the net
} CagDistanceCell;

// A tube, a sweep or a twisted extrusion.
typedef struct CagSwept {
  const CagCurve *section; // NULL: another surface
  const CagMotion *motion; // NULL: of the extrusion
  CagTwisted extrusion;
  CagTransform map; // of the surface that section and motion make
  bool flip;        // its v runs backwards
  bool tube;        // cells are intervals of v: the section is a circle about the path
  double radius, scale;
  CagVec3 p; // of a tube: in its own space
} CagSwept;

typedef struct CagDistanceCells {
  const CagSurface *s;
  CagSurface *exact; // owned; NULL: sampled
  bool same;         // the parameters of cells are those of s, but for an affine map
  CagVec3 p;
  double size; // of the farthest known point from p: what rounding is a part of
  CagSwept swept;
  bool certain;   // the bounds are
  double hint[2]; // parameters of the best point so far
  // Of Bezier patches: degrees, whether rational, binomial coefficients of p, q, 2 p, 2 q.
  int p_degree, q_degree;
  bool rational;
  double *binomials[4];
  double *work;
  CagDistanceCell *items; // a heap
  size_t count, capacity;
  double *blocks; // of control points less p, in homogeneous coordinates
  size_t block_size, block_count, block_capacity;
  size_t *unused;
  size_t unused_count;
} CagDistanceCells;

// All of the surface. `own_parameters`: an exact form with other parameters does not serve. Free
// it in any case.
CagStatus cag_distance_cells_make(CagDistanceCells *c, const CagSurface *s, CagVec3 p,
                                  bool own_parameters, CagError *err);
void cag_distance_cells_free(CagDistanceCells *c);
CagStatus cag_distance_cells_push(CagDistanceCells *c, const CagDistanceCell *cell, CagError *err);
// The cell with the lowest bound; false: there is none, or that bound is not below `below`.
CagStatus cag_distance_cells_next(CagDistanceCells *c, double below, CagDistanceCell *out,
                                  bool *found, CagError *err);
// Both halves of a cell that was taken; those are kept whose bound is below `below`.
CagStatus cag_distance_cells_halve(CagDistanceCells *c, const CagDistanceCell *cell, double below,
                                   CagError *err);
// Lets go of a cell that was taken and is not halved.
void cag_distance_cells_drop(CagDistanceCells *c, const CagDistanceCell *cell);

#endif
