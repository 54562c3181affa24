// Random quadrics of all classes.

#ifndef CAG_TESTS_QUADRIC_SUPPORT_H
#define CAG_TESTS_QUADRIC_SUPPORT_H

#include "geom/surface/quadric.h"
#include "surface_support.h"

static uint64_t state_of_random = 1;

static inline double random_in(double from, double to) {
  state_of_random = state_of_random * 6364136223846793005u + 1442695040888963407u;
  return from + (to - from) * (double)(state_of_random >> 11) / 9007199254740992.0;
}

// The 17 classes in their simplest form. The last ones have no real surface.
static const double UNITS[][10] = {
    {1, 1, 1, 0, 0, 0, 0, 0, 0, -1},  {1, 1, -1, 0, 0, 0, 0, 0, 0, -1},
    {1, 1, -1, 0, 0, 0, 0, 0, 0, 1},  {1, 1, -1, 0, 0, 0, 0, 0, 0, 0},
    {1, 1, 0, 0, 0, 0, 0, 0, -1, 0},  {1, -1, 0, 0, 0, 0, 0, 0, -1, 0},
    {1, 1, 0, 0, 0, 0, 0, 0, 0, -1},  {0, 1, 0, 0, 0, 0, -4, 0, 0, 0},
    {1, -1, 0, 0, 0, 0, 0, 0, 0, -1}, {1, -1, 0, 0, 0, 0, 0, 0, 0, 0},
    {1, 0, 0, 0, 0, 0, 0, 0, 0, -1},  {1, 0, 0, 0, 0, 0, 0, 0, 0, 0},
    {1, 1, 1, 0, 0, 0, 0, 0, 0, 1},   {1, 1, 1, 0, 0, 0, 0, 0, 0, 0},
    {1, 1, 0, 0, 0, 0, 0, 0, 0, 1},   {1, 1, 0, 0, 0, 0, 0, 0, 0, 0},
    {1, 0, 0, 0, 0, 0, 0, 0, 0, 1},
};
enum { CLASSES = 17, REAL = 12 };

// Applies semi-axes, a rotation (except to a third of them), and a translation.
static inline CagQuadric random_quadric(const double unit[10], bool turned) {
  CagQuadric q, out;
  memcpy(q.c, unit, sizeof q.c);
  CagTransform t, turn;
  const CagVec3 shift = cag_vec3(random_in(-1, 1), random_in(-1, 1), random_in(-1, 1));
  t = cag_transform_identity();
  t.planar = false;
  for (int i = 0; i < 3; i++) t.m[i][i] = random_in(0.5, 2);
  MUST(cag_quadric_transform(&q, &t, &out, err));
  if (turned) {
    MUST(cag_rotate(cag_vec3(random_in(-1, 1), random_in(-1, 1), random_in(-1, 1)), random_in(0, 3),
                    cag_vec3(0, 0, 0), &turn, err));
    MUST(cag_quadric_transform(&out, &turn, &q, err));
    out = q;
  }
  t = cag_translate(shift);
  MUST(cag_quadric_transform(&out, &t, &q, err));
  return q;
}

#endif
