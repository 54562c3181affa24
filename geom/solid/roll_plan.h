// What is to be rounded: sections along chains of edges, and balls at corners, for rolling.h.
//
// Edges that continue each other smoothly form a chain, which is swept as one body. A corner at
// which all sharp edges are rounded with one radius, all convex or all concave, has a ball. The
// edges then end within the ball's corner.

#ifndef CAG_GEOM_SOLID_ROLL_PLAN_H
#define CAG_GEOM_SOLID_ROLL_PLAN_H

#include "geom/solid/roll_parts.h"
#include "geom/solid/roll_section.h"

// An edge to be rounded. Ends are numbered 0 (the start of the curve) and 1.
typedef struct CagRollPick {
  size_t part, edge, corner[2];
  CagRollEdge e;
  bool closed;       // the curve is closed and has no corner
  bool ball[2];      // whether a corner with a ball or a zone is at the end
  double station[2]; // the parameter of the section through the ball's center, or of the end
  double range[2];   // of the sections
  size_t pivot[2];   // the turn at the end, plus 1; 0: none
  bool zoned;        // zones at its ends cover the edge; it has no sections
  bool used;         // belongs to a chain, ...
  size_t chain;      // ... this one
} CagRollPick;

// One end of a chain.
typedef struct CagRollTip {
  size_t pick;
  int end;
} CagRollTip;

// Sections first to first + count - 1; their `origin` is the pick. Side 0 is on the left.
typedef struct CagRollChain {
  size_t first, count;
  bool closed;
  CagRollTip tips[2]; // unless closed
  size_t level;       // the bodies of chains of lower levels are applied before
} CagRollChain;

// At most this many edges end at a corner with a ball.
#define CAG_ROLL_VALENCE 8

typedef struct CagRollBall {
  size_t part, corner, pick; // `pick`: one of its edges
  bool convex;
  size_t count;
  double radius;
  CagVec3 point, center;
  CagVec3 contact[CAG_ROLL_VALENCE], toward[CAG_ROLL_VALENCE], at_point[CAG_ROLL_VALENCE];
  CagVec3 station[CAG_ROLL_VALENCE], before[CAG_ROLL_VALENCE], after[CAG_ROLL_VALENCE];
} CagRollBall;

// The ball turns from one edge to another, about the third edge of the corner or its fillet.
typedef struct CagRollPivot {
  CagRollTip tips[2];
  size_t third;   // the pick of the third edge, or CAG_ROLL_NONE
  int side;       // of the first edge on which the face F of both edges is
  bool flat;      // a miter of chamfers, with the contacts `contact`: on F, and on the third edge
  bool beyond[2]; // whether the turn begins or ends beyond the corner
  double radius, inner, length; // of the ball, of the fillet (0: none); of the third edge
  CagVec3 point, axis, along;   // the corner; a point of the axis, and its direction into the edge
  CagRollSide base;             // F, ...
  double uv[2];                 // ... and the parameters of the corner
  double sign;                  // 1 if the ball is on the outer side of the faces, else -1
  CagVec3 face, toward[2]; // unit normals, toward the ball, of F at the corner and of the others
  CagVec3 contact[2];
} CagRollPivot;

// What is made of corners that no single ball rounds.
typedef enum CagRollCorners {
  CAG_ROLL_ZONES,  // zones where all faces are planes, else miters
  CAG_ROLL_MITERS, // the bodies of edges run into each other
  CAG_ROLL_BALLS   // miters; balls at both ends of an edge that pass each other do not fit
} CagRollCorners;

// A ball about a corner within which all edges of one bend are rounded by opening or closing the
// solid (roll_zone.h): where no single ball touches all faces.
typedef struct CagRollZone {
  size_t part, corner, pick; // `pick`: one of its edges
  bool convex;
  double radius, reach; // of the ball that rolls, and of the zone
  double most;          // the largest change of the volume
  CagVec3 point;
} CagRollZone;

typedef struct CagRollPlan {
  const CagRollPart *parts;
  size_t part_count;
  double tolerance;
  CagRollPick *picks; // with the sizes of the caller's edges, times `factor`
  size_t pick_count;
  CagRollSection *sections;
  size_t section_count, section_room;
  CagRollChain *chains;
  size_t chain_count;
  CagRollBall *balls;
  size_t ball_count, ball_room;
  CagRollPivot *pivots;
  size_t pivot_count, pivot_room;
  CagRollZone *zones;
  size_t zone_count, zone_room;
  CagRollCorners corners;
  size_t unfit; // the pick that does not fit, or CAG_ROLL_NONE
} CagRollPlan;

// Makes the plan for the picks, which are given with part, edge, corners, and e, and taken over
// also if this fails. If a ball or section does not exist, the result is CAG_OK with `unfit` set.
// Where convex and concave edges, different radii, or faces that no ball touches meet, there are
// zones. Chamfers end there as at other corners.
CagStatus cag_roll_plan(const CagRollPart *parts, size_t part_count, double tolerance,
                        CagRollCorners corners, CagRollPick *picks, size_t n, CagRollPlan *out,
                        CagError *err);
void cag_roll_plan_free(CagRollPlan *p);

// The unit tangent that leaves the edge at an end.
CagStatus cag_roll_leaving(const CagRollPick *p, int end, CagVec3 *out, CagError *err);

#endif
