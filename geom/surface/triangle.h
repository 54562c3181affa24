// Triangular Bezier surfaces in barycentric coordinates.
//
// A net of degree n has (n + 1)(n + 2) / 2 points b_ijk, i + j + k = n, ordered by descending i,
// then descending j: rows of 1, 2, 3 ... points. Degree 0 is a point.

#ifndef CAG_GEOM_SURFACE_TRIANGLE_H
#define CAG_GEOM_SURFACE_TRIANGLE_H

#include "base/status.h"
#include "geom/linalg/vec.h"

static inline size_t cag_triangle_count(int degree) {
  return ((size_t)degree + 1) * ((size_t)degree + 2) / 2;
}

typedef struct CagTriangleJet {
  CagVec3 point;
  CagVec3 ds, dt; // derivatives along (1, 0, -1) and (0, 1, -1)
} CagTriangleJet;

// Evaluates at barycentric coordinates, which must sum to 1 and not be negative, both to 1e-9: else
// "parameter-range".
CagStatus cag_triangle_at(const CagVec3 *net, int degree, const double uvw[3], CagTriangleJet *out,
                          CagError *err);
// Elevates the degree by one; out: cag_triangle_count(degree + 1) points.
void cag_triangle_elevate(const CagVec3 *net, int degree, CagVec3 *out);
// Splits the triangle at uvw into the parts between this point and two corners: out[c] is a net of
// the same degree in which the point replaces corner c.
CagStatus cag_triangle_split(const CagVec3 *net, int degree, const double uvw[3],
                             CagVec3 *const out[3], CagError *err);

#endif
