// Nets of control points whose rows and columns can be exchanged or reversed.

#ifndef CAG_TESTS_GEOM_NET_SUPPORT_H
#define CAG_TESTS_GEOM_NET_SUPPORT_H

#include "geom/surface/surface.h"
#include "tests/geom/support.h"

enum { NET = 4 };

typedef struct Net {
  CagVec3 p[NET][NET];
  size_t n[2];
} Net;

// Bits of `turn`: 1 exchanges rows and columns, 2 and 4 reverse u and v.
static inline CagSurface *surface_of(const Net *net, int turn) {
  CagVec3 flat[NET * NET];
  CagSurface *s;
  const bool swap = turn & 1, back_u = turn & 2, back_v = turn & 4;
  const size_t rows = net->n[swap], columns = net->n[!swap];
  for (size_t i = 0; i < rows; i++)
    for (size_t k = 0; k < columns; k++) {
      const size_t a = swap ? k : i, b = swap ? i : k;
      flat[i * columns + k] =
          net->p[back_u ? net->n[0] - 1 - a : a][back_v ? net->n[1] - 1 - b : b];
    }
  OK(cag_surface_bezier(flat, NULL, rows, columns, &s, &err));
  return s;
}

#endif
