// Trying out how finely a leaf is divided: what is measured on the surface itself.

#ifndef CAG_GEOM_TESSELLATE_TRIAL_H
#define CAG_GEOM_TESSELLATE_TRIAL_H

#include "geom/tessellate/tessellation.h"

// As fmax and fmin, without the calls. The first of tess_larger() is a number.
static inline double tess_larger(double a, double b) { return b > a ? b : a; }
static inline double tess_smaller(double a, double b) { return b < a || isnan(a) ? b : a; }

// A rectangle of parameters, and the counts of its grid to try. If `slope` is not 0, the rectangle
// is sheared: its coordinates are the other parameter, and the parameter of `along` less the slope
// times the distance from `from` in the other direction.
typedef struct TessTrial {
  const CagSurface *surface;
  double from[2], to[2], n[2];
  int along;
  double slope;
  bool suspect; // something thin was missed here before: cag_tess_try_scattered looks more closely
} TessTrial;

// Largest distance found from the surface to the triangles, on the middles, thirds and edges of
// some quadrilaterals. sine: of the angle between neighbors along u and v.
CagStatus cag_tess_try_distance(const TessTrial *trial, const double sine[2], double *distance,
                                CagError *err);
// The same on the middles of more quadrilaterals, for leaves too large for the former to see all;
// of those that are not, it gives 0.
CagStatus cag_tess_try_middles(const TessTrial *trial, double *distance, CagError *err);

// By how much edges of quadrilaterals exceed what is allowed: 1 where one just does not.
typedef struct TessExcess {
  double along[2], diagonal;
} TessExcess;
// angle: that the normal may turn along an edge; free: edges shorter than this may turn it more;
// longest: length of edges; either 0: none.
CagStatus cag_tess_try_edges(const TessTrial *trial, double angle, double free, double longest,
                             TessExcess *out, CagError *err);

// Formulas, and what is made of them, may do anything between two samples; what has an exact form
// is tame within its breaks.
bool cag_tess_is_known_by_points(const CagSurface *s);

// Is the surface farther from the triangles than the tolerance somewhere on a fixed set of points,
// which is the same for all leaves of a face? For surfaces of which nothing but points is known:
// what is wider than a 64th of the domain is met, and lines much thinner than that. Leaves that are
// finer than the set are not looked at.
CagStatus cag_tess_try_scattered(const TessTrial *trial, double tolerance, bool *missed,
                                 CagError *err);

#endif
