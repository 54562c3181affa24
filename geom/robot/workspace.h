// Workspaces: what the arm of a robot reaches, by formula where its structure has one.

#ifndef CAG_GEOM_ROBOT_WORKSPACE_H
#define CAG_GEOM_ROBOT_WORKSPACE_H

#include "geom/robot/robot.h"

typedef enum CagWorkspaceKind {
  CAG_WORKSPACE_CARTESIAN,   // a box of the travels of three slides
  CAG_WORKSPACE_CYLINDRICAL, // a turn, a slide along its axis, a slide away from it
  CAG_WORKSPACE_SPHERICAL,   // two turns about axes that meet, and a slide away from there
  CAG_WORKSPACE_OFFSET,      // the same with a shoulder offset (the Stanford arm)
  CAG_WORKSPACE_PLANAR,      // turns about parallel axes: a disc or ring
  CAG_WORKSPACE_SCARA,       // the same with a slide along the axes
  CAG_WORKSPACE_ARTICULATED, // waist, shoulder and elbow: a shell about the shoulder
  CAG_WORKSPACE_OTHER
} CagWorkspaceKind;

// The region of a point of the robot: of the tool's origin where the joints of the wrist turn about
// it, else of the point where the wrist's axes meet.
typedef struct CagWorkspace {
  CagWorkspaceKind kind;
  bool of_wrist;
  CagVec3 center; // of r_min, r_max: the shoulder, or a point of the first axis
  // Bounds of the distance from the center, or from the first axis where the kind is cylindrical,
  // planar or scara; the limits of the joints that decide it are asked. With a shoulder offset no
  // point is nearer to the axis than `hole`, and r is the root of |p - center|^2 - hole^2.
  double r_min, r_max, hole;
  // The region is exactly what the formulas say: its joints may turn as far as they need to.
  bool exact;
  double volume;    // of the region when exact (PLANAR: its area), else NaN
  CagBounds bounds; // CARTESIAN, OFFSET and ARTICULATED when exact, else empty
} CagWorkspace;

void cag_robot_workspace(const CagRobot *r, CagWorkspace *out);

// Joint values for sample k = 0 .. n-1 of the workspace: the limits' corners of the arm first (as
// far as they are at most half of n), then a sequence that fills the limits evenly.
void cag_robot_workspace_sample(const CagRobot *r, size_t k, size_t n, double *q);

#endif
