// Arrangements of plane curves: the curves are cut where they meet, and winding numbers select the
// faces that form a region.
//
// Set operations and offsets of regions both use this; they differ in the curves and in the rule.

#ifndef CAG_GEOM_REGION_ARRANGE_H
#define CAG_GEOM_REGION_ARRANGE_H

#include "geom/curve/region.h"

// A curve of the arrangement. The curves of one operand form closed loops, in any order.
typedef struct CagWalk {
  const CagCurve *curve; // not owned
  int operand;           // 0 or 1: the operand whose winding number it contributes to
  int sign;              // 1, or -1: counts as if reversed
  int group;             // curves of one group (0 or more) are known not to cross each other; -1:
                         // none
} CagWalk;

// Whether a face belongs to the region, given its winding numbers with respect to both operands.
typedef bool (*CagFaceRule)(const int winding[2], int parameter);

// *out is NULL if no face is selected. Loops around faces thinner than `thin` are dropped, since
// nearly coincident curves may leave such faces between them; with 0, those thinner than rounding.
// Fails with "region-undecided".
CagStatus cag_region_arrange(const CagWalk *walks, size_t n, CagFaceRule rule, int parameter,
                             double thin, CagRegion **out, CagError *err);

// Whether walks of both operands have a common point.
CagStatus cag_region_arrange_share(const CagWalk *walks, size_t n, bool *out, CagError *err);

// --- Pieces: parts of the walks that are monotone in x and in y (region_pieces.c) ---

typedef struct CagRegionPiece {
  size_t walk;
  size_t source;   // number of the piece of the walk that this is part of
  int count[2];    // net number of times it is run (forwards minus backwards), by operand
  double a, b;     // range of the parameter on the walk's curve
  CagVec3 p, q;    // end points
  size_t from, to; // the corners at the ends, once pieces have been cut
  bool straight;   // a segment from p to q
  bool round;      // part of a circle: center, radius
  CagVec3 center;
  double radius;
  CagCurve *part; // the piece as a curve, created on demand
} CagRegionPiece;

typedef struct CagRegionPieces {
  const CagWalk *walks;
  CagRegionPiece *items;
  size_t n, capacity;
  double tolerance; // points closer than this are identified
  double thin;      // loops around faces thinner than this are dropped
} CagRegionPieces;

CagStatus cag_region_pieces_add(CagRegionPieces *s, size_t walk, CagError *err);
void cag_region_pieces_free(CagRegionPieces *s);
CagStatus cag_region_piece_point(const CagRegionPieces *s, const CagRegionPiece *piece, double t,
                                 CagVec3 *out, CagError *err);
// The parameter in [a, b] at which the piece's coordinate (0: x, 1: y) has this value; the nearer
// end if it has the value nowhere.
CagStatus cag_region_piece_at(const CagRegionPieces *s, const CagRegionPiece *piece, double a,
                              double b, int axis, double value, double *t, CagVec3 *point,
                              CagError *err);
// The parameter in [a, b] at the given distance from the point at `a` (from_end: at `b`).
CagStatus cag_region_piece_at_distance(const CagRegionPieces *s, const CagRegionPiece *piece,
                                       double a, double b, bool from_end, double distance,
                                       CagVec3 *point, CagError *err);

// --- Intersections (region_meet.c) ---

// A parameter at which a piece is to be cut; both pieces of an intersection have the same point.
typedef struct CagRegionCut {
  size_t piece;
  double t;
  CagVec3 point;
} CagRegionCut;

// Cuts of all pieces, sorted by piece and t; *out is malloc'd. `again`: the pieces have been cut
// before and their ends were merged; only new intersections caused by that are returned.
CagStatus cag_region_pieces_meet(CagRegionPieces *s, bool again, CagRegionCut **out, size_t *n,
                                 CagError *err);

#endif
