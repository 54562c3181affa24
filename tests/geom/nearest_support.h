// Random numbers, and a derivative-free search for closest points of surfaces.

#ifndef NEAREST_SUPPORT_H
#define NEAREST_SUPPORT_H

#include "surface_support.h"

static uint64_t state_of_random;

// A number in 0..1 (Knuth's linear congruential generator).
static inline double random_number(void) {
  state_of_random = state_of_random * 6364136223846793005u + 1442695040888963407u;
  return (double)(state_of_random >> 11) / 9007199254740992.0;
}

static inline double between(double a, double b) { return a + random_number() * (b - a); }

static inline int whole(int from, int to) {
  return from + (int)(random_number() * (to + 1 - from));
}

static inline CagVec3 anywhere(double size) {
  const double x = between(0, size), y = between(0, size);
  return cag_vec3(x, y, between(0, size));
}

// --- Derivative-free search ---

typedef struct Dense {
  const CagSurface *s;
  CagVec3 p;
} Dense;

static inline double distance_at(const Dense *d, double u, double v) {
  return cag_norm(cag_sub(surface_at(d->s, u, v), d->p));
}

// Moves to the closest neighbor, and shortens the steps when none is closer.
static inline double descend(const Dense *d, double u, double v, double du, double dv) {
  const CagSurface *s = d->s;
  double best = distance_at(d, u, v);
  for (int round = 0; round < 90; round++) {
    const double a = u, b = v;
    for (int k = 0; k < 9; k++) {
      const double x = fmin(fmax(a + (k / 3 - 1) * du, s->u0), s->u1);
      const double y = fmin(fmax(b + (k % 3 - 1) * dv, s->v0), s->v1);
      const double found = distance_at(d, x, y);
      if (!(found < best)) continue;
      best = found;
      u = x;
      v = y;
    }
    if (u != a || v != b) continue;
    du /= 2;
    dv /= 2;
  }
  return best;
}

#define MOST_GRID 160
// Starts from the lowest points of a grid with the given numbers of intervals.
static inline double dense_distance(const CagSurface *s, CagVec3 p, int nu, int nv) {
  static double at[MOST_GRID + 1][MOST_GRID + 1];
  const Dense d = {s, p};
  const double du = (s->u1 - s->u0) / nu, dv = (s->v1 - s->v0) / nv;
  double best = INFINITY;
  for (int i = 0; i <= nu; i++)
    for (int j = 0; j <= nv; j++) at[i][j] = distance_at(&d, s->u0 + i * du, s->v0 + j * dv);
  for (int i = 0; i <= nu; i++)
    for (int j = 0; j <= nv; j++) {
      bool lowest = true;
      for (int k = 0; lowest && k < 9; k++) {
        const int x = i + k / 3 - 1, y = j + k % 3 - 1;
        lowest = x < 0 || y < 0 || x > nu || y > nv || at[i][j] <= at[x][y];
      }
      if (lowest) best = fmin(best, descend(&d, s->u0 + i * du, s->v0 + j * dv, du / 2, dv / 2));
    }
  return best;
}

static inline CagVec3 beside(const CagSurface *s) {
  CagBounds box;
  MUST(cag_surface_bounds(s, &box, err));
  const CagVec3 size = cag_sub(box.max, box.min);
  const double x = between(-0.3, 1.3), y = between(-0.3, 1.3), z = between(-0.3, 1.3);
  return cag_vec3(box.min.x + x * size.x, box.min.y + y * size.y, box.min.z + z * size.z);
}

#endif
