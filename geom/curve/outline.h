// Loops as sides and bends, ordered by the directions in which they run: what Minkowski sums are
// made of.

#ifndef CAG_GEOM_OUTLINE_H
#define CAG_GEOM_OUTLINE_H

#include "geom/curve/curve.h"

// An arc of a circle, or a corner, on which the direction of the loop turns by at most a quarter
// turn.
typedef struct CagBend {
  CagVec3 center;
  double radius; // negative if the loop turns right; 0: a corner
  int sense;     // 1: the loop turns left, from `low` to `high`; -1: right, from `high` to `low`
  CagVec3 low, high; // directions, not of unit length; `high` is counter-clockwise from `low`
} CagBend;

typedef struct CagSideLine {
  CagVec3 from, to, along; // along: to - from
} CagSideLine;

typedef struct CagOutline {
  CagBend *bends;
  CagSideLine *sides;
  size_t bend_count, side_count, bend_capacity, side_capacity;
} CagOutline;

// *near is set if curves other than segments and circles were replaced by arcs within the
// tolerance.
CagStatus cag_outline_of(const CagCurve *loop, double tolerance, CagOutline *out, bool *near,
                         CagError *err);
void cag_outline_free(CagOutline *o);

// 1 if b is counter-clockwise from a by less than half a turn, -1 if clockwise, 0 if they are
// parallel. Exact, so directions have a consistent order.
int cag_direction_turn(CagVec3 a, CagVec3 b);
// The bend's point where the loop runs in the direction.
CagVec3 cag_bend_point(const CagBend *b, CagVec3 direction);

#endif
