// Curves of the plane cut at all places where they meet, and the region that winding numbers choose
// from the faces between them.
//
// Set operations and offsets of regions are both this: they differ in the curves, and in the rule.

#ifndef CAG_GEOM_REGION_ARRANGE_H
#define CAG_GEOM_REGION_ARRANGE_H

#include "geom/curve/region.h"

// A curve that takes part. Those of one operand form closed loops, in whatever pieces they come.
typedef struct CagWalk {
  const CagCurve *curve; // borrowed
  int operand;           // 0 or 1: which winding number it counts for
  int sign;              // 1, or -1: counts as if run backwards
  int group;             // curves of one group (0 or more) are known not to cross; -1: none
} CagWalk;

// Whether a face belongs to the region, by its winding numbers about the loops of both operands.
typedef bool (*CagFaceRule)(const int winding[2], int parameter);

// *out is NULL where no face belongs to it. Loops about faces thinner than `thin` are dropped: what
// curves that are near others only may leave between them; 0: those thinner than rounding. Fails
// with "region-undecided".
CagStatus cag_region_arrange(const CagWalk *walks, size_t n, CagFaceRule rule, int parameter,
                             double thin, CagRegion **out, CagError *err);

// --- Pieces: parts of the walks that run one way in x and in y (region_pieces.c) ---

typedef struct CagRegionPiece {
  size_t walk;
  size_t source;   // number of the piece of the walk that it is part of
  int count[2];    // how often it is run, forwards less backwards, by operand
  double a, b;     // over the walk's curve
  CagVec3 p, q;    // its ends
  size_t from, to; // the corners there, once pieces have been cut
  bool straight;   // a segment from p to q
  bool round;      // part of a circle: center, radius
  CagVec3 center;
  double radius;
  CagCurve *part; // the piece as a curve, made when first asked for
} CagRegionPiece;

typedef struct CagRegionPieces {
  const CagWalk *walks;
  CagRegionPiece *items;
  size_t n, capacity;
  double tolerance; // two points nearer than this are one
  double thin;      // loops about less than this are dropped
} CagRegionPieces;

CagStatus cag_region_pieces_add(CagRegionPieces *s, size_t walk, CagError *err);
void cag_region_pieces_free(CagRegionPieces *s);
CagStatus cag_region_piece_point(const CagRegionPieces *s, const CagRegionPiece *piece, double t,
                                 CagVec3 *out, CagError *err);
// The parameter within [a, b] of the piece at which the coordinate (0: x, 1: y) has this value; the
// nearer end where it has it nowhere.
CagStatus cag_region_piece_at(const CagRegionPieces *s, const CagRegionPiece *piece, double a,
                              double b, int axis, double value, double *t, CagVec3 *point,
                              CagError *err);
// The parameter within [a, b] at the distance from the point at `a` (from_end: at `b`).
CagStatus cag_region_piece_at_distance(const CagRegionPieces *s, const CagRegionPiece *piece,
                                       double a, double b, bool from_end, double distance,
                                       CagVec3 *point, CagError *err);

// --- Where they meet (region_meet.c) ---

// A place at which a piece is to be cut; the two pieces of a meeting have the same point.
typedef struct CagRegionCut {
  size_t piece;
  double t;
  CagVec3 point;
} CagRegionCut;

// Cuts of all pieces, by piece and t; *out is malloc'd. `again`: the pieces were cut before, and
// their ends moved together; what that may have made meet is looked for, and their ends are no
// cuts.
CagStatus cag_region_pieces_meet(CagRegionPieces *s, bool again, CagRegionCut **out, size_t *n,
                                 CagError *err);

#endif
