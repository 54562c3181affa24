// Conversion of robots of a script to the parts of a URDF file.

#ifndef CAG_INTERP_SESSION_URDF_ROBOT_H
#define CAG_INTERP_SESSION_URDF_ROBOT_H

#include "interp/formats/urdf.h"
#include "interp/vm/value.h"

// How shapes of links are meshed.
typedef struct CagUrdfHow {
  double tolerance, usual_tolerance; // of the scene
  CagBounds bounds;                  // of the whole scene, for lines
  size_t max_triangles;
  const volatile int *interrupt;
} CagUrdfHow;

// Finds the robots among the shown values, each once; groups made by `posed` refer to theirs.
// Returns their number, and writes the first `room` of them to `out`.
size_t cag_urdf_robots(CagVm *vm, const CagValue *shown, size_t n, const CagRobotValue **out,
                       size_t room);
// Converts a robot to the parts of a file. Returns false if an error was set (a shape that cannot
// be meshed). The result must be freed in any case.
bool cag_urdf_of_robot(CagVm *vm, const CagRobotValue *robot, const CagUrdfHow *how, CagUrdf *out);

#endif
