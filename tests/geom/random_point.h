// Random points in a cube about the origin.

#ifndef CAG_TESTS_GEOM_RANDOM_POINT_H
#define CAG_TESTS_GEOM_RANDOM_POINT_H

#include "geom/linalg/vec.h"
#include "tests/geom/random.h"

static inline CagVec3 random_point(double size) {
  const double x = uniform(-size, size), y = uniform(-size, size), z = uniform(-size, size);
  return cag_vec3(x, y, z);
}

#endif
