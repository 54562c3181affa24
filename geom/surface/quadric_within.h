// The part of one sheet of a quadric within half spaces.

#ifndef CAG_GEOM_QUADRIC_WITHIN_H
#define CAG_GEOM_QUADRIC_WITHIN_H

#include "geom/surface/quadric.h"

// The half space that is kept: n . X <= d, in world coordinates.
typedef struct CagQuadricSide {
  CagVec3 n;
  double d;
} CagQuadricSide;
#define CAG_QUADRIC_SIDES 6

// One sheet: the unit form over u0..u1 (angles: the full turn) and v0..v1, which may be infinite.
typedef struct CagQuadricSheet {
  CagQuadricShape shape;
  CagTransform frame; // unit form to world
  double u0, u1, v0, v1;
  double size; // approximate size of the result; outlines are accurate to 1e-11 of it
} CagQuadricSheet;

// Appends the pieces to list[*n], which has room for `most`: plain patches if a piece is a
// rectangle of parameters, else trimmed ones.
CagStatus cag_quadric_sheet_within(const CagQuadricSheet *sheet, const CagQuadricSide *sides,
                                   size_t side_count, CagSurface **list, size_t most, size_t *n,
                                   CagError *err);

// --- Internal ---

// A half space in coordinates of the unit form: a x + b y + c z <= d.
typedef struct CagQuadricCut {
  double a, b, c, d;
} CagQuadricCut;

// The end of a piece in v: a root of side number `side`, or (negative) the domain at `value`.
typedef struct CagQuadricBound {
  int side, branch;
  double value;
} CagQuadricBound;

// Between two neighboring places in u, one interval of v that lies within all half spaces.
typedef struct CagQuadricCell {
  size_t place; // its left end
  CagQuadricBound low, high;
} CagQuadricCell;

// A value of u at which the intervals change; `folds`: a bit for each side whose two roots coincide
// there.
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

// The bound at u; `folded`: the two roots coincide.
double cag_quadric_bound_at(const CagQuadricCells *c, const CagQuadricBound *b, double u,
                            bool folded);
// Whether the bound is the same v for all u.
bool cag_quadric_bound_is_straight(const CagQuadricCells *c, const CagQuadricBound *b);
CagVec3 cag_quadric_unit_point(CagQuadricShape shape, double u, double v);
// The outlines of the combined cells, as surfaces.
CagStatus cag_quadric_outline(const CagQuadricCells *c, CagSurface **list, size_t most, size_t *n,
                              CagError *err);

#endif
