// The robots of a scene: which of its parts they consist of, and what was said of them.

#ifndef CAG_INTERP_SESSION_ROBOTS_H
#define CAG_INTERP_SESSION_ROBOTS_H

#include "base/hash.h"
#include "interp/session/session.h"

typedef struct CagSessionRobot {
  char *name;
  size_t last_number; // that was added to its name for other robots
  const CagRobot *chain;
  const CagPosture *posture;
  CagTransform base, back; // from the robot's world to the scene, and back
  bool flat;               // there is no way back
  size_t first, count;     // of its parts, in the list of all
} CagSessionRobot;

typedef struct CagSessionPart {
  size_t item; // of the scene
  const CagShape *shape;
} CagSessionPart;

typedef struct CagSessionRobots {
  CagSessionRobot *items;
  size_t count, capacity;
  CagHashIndex names;
  CagSessionPart *parts; // of all robots
  size_t part_count, part_capacity;
  double (*numbers)[3][4]; // of the last pose: motions, then frames
  size_t number_capacity;
  double q[CAG_ROBOT_JOINTS_MAX]; // of the last reach
} CagSessionRobots;

// Returns robot i of the scene, or NULL.
CagSessionRobot *cag_session_robot_at(CagSession *s, size_t i);

#endif
