// Strips along plane curves: the points on the normals of a curve up to a distance from it.
//
// A strip is bounded by the part, its normals at both ends, and the shifted part. It folds if the
// part bends towards it with a radius below the distance: the shifted part then runs backwards.
// Distances are positive to the left of the curve.

#ifndef CAG_GEOM_STRIP_H
#define CAG_GEOM_STRIP_H

#include "geom/curve/joins.h"
#include "geom/curve/region_walks.h"

// A smooth part of a curve.
typedef struct CagStripPart {
  CagCurve *curve;
  bool folds;    // the strip does, somewhere
  bool straight; // a segment
  bool round;    // part of a circle: center, radius, and 1 (counter-clockwise) or -1
  CagVec3 center;
  double radius, sense;
  CagVec3 ends[2], tangents[2];
} CagStripPart;

typedef struct CagStripParts {
  CagStripPart *items;
  size_t n, capacity;
} CagStripParts;

void cag_strip_parts_free(CagStripParts *parts);
// Adds the parts of a curve, cut at its corners, between pieces of different kinds, and where the
// strip of the width begins or ends to fold. Parts without length are left out.
CagStatus cag_strip_parts_add(CagStripParts *parts, const CagCurve *c, double left, CagError *err);
CagStatus cag_strip_parts_copy(CagStripParts *parts, const CagStripPart *p, CagError *err);
// Replaces parts that fold, other than circles, by arcs within the tolerance; *near is set if there
// are any. The strips of arcs have straight ends, so corners and ends are as for circles. both: the
// strips on both sides count, not only the one of the width.
CagStatus cag_strip_parts_unfold(CagStripParts *parts, double left, bool both, double tolerance,
                                 bool *near, CagError *err);

// The end of the strip of the width at an end (0 or 1) of the part.
CagVec3 cag_strip_end(const CagStripPart *p, int end, double left);
// Puts the part shifted to its left; *near is set if that is accurate only to the tolerance.
CagStatus cag_strip_put_shifted(CagWalks *w, const CagStripPart *p, double left, double tolerance,
                                bool backwards, int sign, bool *near, CagError *err);
// Puts the counter-clockwise curve around all points within the distance d > 0 of the part. It runs
// around each point as often as the part has intervals within the distance of the point.
CagStatus cag_strip_put_neighborhood(CagWalks *w, const CagStripPart *p, double d, double tolerance,
                                     int sign, bool *near, CagError *err);
// For a part of a circle whose strip folds: puts the counter-clockwise sector about the center that
// lies beyond it on the normals.
CagStatus cag_strip_put_beyond(CagWalks *w, const CagStripPart *p, double d, int sign,
                               CagError *err);

// --- Corners between parts ---

typedef enum CagTurn { CAG_TURN_NONE, CAG_TURN_LEFT, CAG_TURN_RIGHT, CAG_TURN_BACK } CagTurn;

// The turn from the end of one part to the start of the next one.
CagTurn cag_strip_turn(const CagStripPart *a, const CagStripPart *b);
// Puts the join from the end of one part's strip to the start of the next one's, on the outer side
// of the corner.
CagStatus cag_strip_put_join(CagWalks *w, const CagStripPart *a, const CagStripPart *b, double left,
                             const CagJoins *joins, int sign, CagError *err);

#endif
