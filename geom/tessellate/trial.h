// Measures on the surface how finely a leaf must be divided.

#ifndef CAG_GEOM_TESSELLATE_TRIAL_H
#define CAG_GEOM_TESSELLATE_TRIAL_H

#include "geom/tessellate/tessellation.h"

// fmax and fmin without the calls. The first argument of tess_larger() must not be NaN.
static inline double tess_larger(double a, double b) { return b > a ? b : a; }
static inline double tess_smaller(double a, double b) { return b < a || isnan(a) ? b : a; }

// A rectangle of parameters, and the grid counts to try. If `slope` is nonzero, the rectangle is
// sheared: its coordinates are the other parameter, and the parameter of `along` minus the slope
// times the distance from `from` in the other direction.
typedef struct TessTrial {
  const CagSurface *surface;
  double from[2], to[2], n[2];
  int along;
  double slope;
  bool suspect; // a thin feature was missed here before: cag_tess_try_scattered samples more
                // densely
} TessTrial;

// Largest distance found from the surface to the triangles, at midpoints, thirds, and edges of some
// quadrilaterals. sine: of the angle between neighbors along u and v.
CagStatus cag_tess_try_distance(const TessTrial *trial, const double sine[2], double *distance,
                                CagError *err);
// The same at the midpoints of more quadrilaterals, for leaves too large to be covered by the
// former; 0 for other leaves.
CagStatus cag_tess_try_middles(const TessTrial *trial, double *distance, CagError *err);

// By what factor edges of quadrilaterals exceed the limits; 1: just within.
typedef struct TessExcess {
  double along[2], diagonal;
} TessExcess;
// angle: maximum turn of the normal along an edge; free: shorter edges are exempt from it; longest:
// maximum length of edges. 0 in the first or last: no limit.
CagStatus cag_tess_try_edges(const TessTrial *trial, double angle, double free, double longest,
                             TessExcess *out, CagError *err);

// Whether the surface is known only by samples. Functions, and surfaces made from them, may have
// any values between two samples, but surfaces with an exact form are well behaved between breaks.
bool cag_tess_is_known_by_points(const CagSurface *s);

// Whether the surface is farther from the triangles than the tolerance at some point of a fixed
// set, which is the same for all leaves of a face. For surfaces that are known only by samples:
// features wider than a 64th of the domain are found, and lines much thinner than that. Leaves
// finer than the set are skipped.
CagStatus cag_tess_try_scattered(const TessTrial *trial, double tolerance, bool *missed,
                                 CagError *err);

#endif
