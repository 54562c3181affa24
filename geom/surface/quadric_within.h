// The part of one sheet of a quadric between planes.

#ifndef CAG_GEOM_QUADRIC_WITHIN_H
#define CAG_GEOM_QUADRIC_WITHIN_H

#include "geom/surface/quadric.h"

// What is kept: n . X <= d, of points of the world.
typedef struct CagQuadricSide {
  CagVec3 n;
  double d;
} CagQuadricSide;
#define CAG_QUADRIC_SIDES 6

// One sheet: the unit form's piece over u0..u1 (angles: the whole turn) and v0..v1, which may be
// infinite.
typedef struct CagQuadricSheet {
  CagQuadricShape shape;
  CagTransform frame; // unit form -> world
  double u0, u1, v0, v1;
  double size; // of the result, about: outlines keep to 1e-11 of it
} CagQuadricSheet;

// Adds the pieces to list[*n], of at most `most`: patches where the piece is a rectangle of
// parameters, else trimmed ones.
CagStatus cag_quadric_sheet_within(const CagQuadricSheet *sheet, const CagQuadricSide *sides,
                                   size_t side_count, CagSurface **list, size_t most, size_t *n,
                                   CagError *err);

// --- Among the two files that make it ---

// A side in coordinates of the unit form: a x + b y + c z <= d.
typedef struct CagQuadricCut {
  double a, b, c, d;
} CagQuadricCut;

// What ends a piece in v: a root of side number `side`, or (negative) the domain at `value`.
typedef struct CagQuadricBound {
  int side, branch;
  double value;
} CagQuadricBound;

// Between two neighboring places of u, one interval of v that lies within all sides.
typedef struct CagQuadricCell {
  size_t place; // its left end
  CagQuadricBound low, high;
} CagQuadricCell;

// A place in u where the intervals change; `folds`: the sides whose two roots are one there, by
// bits.
typedef struct CagQuadricPlace {
  double u;
  unsigned folds;
} CagQuadricPlace;

typedef struct CagQuadricCells {
  const CagQuadricSheet *sheet;
  CagQuadricCut cuts[CAG_QUADRIC_SIDES];
  size_t cut_count;
  CagQuadricPlace *places;
  size_t place_count;
  CagQuadricCell *cells;
  size_t cell_count;
} CagQuadricCells;

// The bound at u; `folded`: where its two roots are one.
double cag_quadric_bound_at(const CagQuadricCells *c, const CagQuadricBound *b, double u,
                            bool folded);
// Whether it is the same v at all u.
bool cag_quadric_bound_is_straight(const CagQuadricCells *c, const CagQuadricBound *b);
CagVec3 cag_quadric_unit_point(CagQuadricShape shape, double u, double v);
// The outlines of the cells together, as surfaces.
CagStatus cag_quadric_outline(const CagQuadricCells *c, CagSurface **list, size_t most, size_t *n,
                              CagError *err);

#endif
