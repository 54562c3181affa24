// The internals of a motion, for the files that evaluate and bound it.

#ifndef CAG_GEOM_MOTION_PARTS_H
#define CAG_GEOM_MOTION_PARTS_H

#include "geom/basis/interval.h"
#include "geom/surface/motion.h"

// Number of nodes that sample phi' on a segment, and so the degree of phi.
#define CAG_MOTION_NODES 8

typedef struct CagMotionSegment {
  double v0, v1;
  CagVec3 a;
  double phi[CAG_MOTION_NODES + 1]; // coefficients of powers of s, which is -1..1 over the segment
  size_t piece;
} CagMotionSegment;

// A smooth piece of the path with its miters: the shift of the circle along the tangent at either
// end, as factors of cos u and sin u.
typedef struct CagMotionPiece {
  double v0, v1;
  double start[2], end[2];
} CagMotionPiece;

struct CagMotion {
  int references;
  CagCurve *path; // NULL for an affine map
  CagPathMotion how;
  CagChebyshev *rows;
  double start, end;
  bool angular, corner;
  CagVec3 fixed[3]; // x, y, z for CAG_ORIENT_FIXED
  CagMotionSegment *segments;
  size_t count, room;
  CagMotionPiece *pieces;
  size_t piece_count;
};

// The segment that contains a parameter.
const CagMotionSegment *cag_motion_segment(const CagMotion *m, double v, CagSide side);
bool cag_along_is_constant(const CagAlong *a, double value);

// The ends of the intervals on which the motion is analytic, ascending: *n + 1 values, malloc'd.
CagStatus cag_motion_joints(const CagMotion *m, double **out, size_t *n, CagError *err);

typedef struct CagMotionRanges {
  CagInterval3 origin[CAG_MOTION_ORDER], x[CAG_MOTION_ORDER], y[CAG_MOTION_ORDER],
      z[CAG_MOTION_ORDER];
} CagMotionRanges;
// Ranges of the Taylor coefficients 0..n about every t of [a, b], which must lie between two
// joints. Returns false if they are unknown, because the path is known only by points or the
// interval is too long.
bool cag_motion_ranges(const CagMotion *m, double a, double b, int n, CagMotionRanges *out);

#endif
