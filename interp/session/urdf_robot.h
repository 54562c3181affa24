// Robots of a script as the parts of a URDF file.

#ifndef CAG_INTERP_SESSION_URDF_ROBOT_H
#define CAG_INTERP_SESSION_URDF_ROBOT_H

#include "interp/formats/urdf.h"
#include "interp/vm/value.h"

// How the shapes of links become meshes.
typedef struct CagUrdfHow {
  double tolerance;
  CagBounds bounds; // of the whole scene, for lines
  size_t max_triangles;
  const volatile int *interrupt;
} CagUrdfHow;

// The robots of the values that are shown, each once; groups made by `posed` remember theirs. Gives
// how many there are; the first `room` of them are written to `out`.
size_t cag_urdf_robots(CagVm *vm, const CagValue *shown, size_t n, const CagRobotValue **out,
                       size_t room);
// A robot as the file's parts. False: the machine's error is set (a shape that cannot be meshed).
// To be freed in either case.
bool cag_urdf_of_robot(CagVm *vm, const CagRobotValue *robot, const CagUrdfHow *how, CagUrdf *out);

#endif
