// Knot vectors of B-splines: construction, validation, span search.
//
// A knot vector for degree p and n control points has n + p + 1 knots and the usable range
// knots[p]..knots[n]. `span` is the index i with knots[i] <= t < knots[i + 1], p <= i < n; the last
// usable knot belongs to the last non-empty span.

#ifndef CAG_GEOM_KNOTS_H
#define CAG_GEOM_KNOTS_H

#include <stdbool.h>

#include "base/status.h"
#include "geom/linalg/vec.h"

// 0, .., 0, 1, 2, .., m, .., m with m = n - p.
void cag_knots_open(size_t n, int p, double *knots);
// 0, 1, 2, ..
void cag_knots_periodic(size_t n, int p, double *knots);
// Clamped, with inner knots from the chord lengths of the control polygon (Hartley and Judd 1978,
// Parametrization of Bezier-type B-spline curves and surfaces).
void cag_knots_chord(const CagVec3 *points, size_t n, int p, double *knots);

// Fails with "order-range", "not-finite", "knots-not-monotone", "knot-multiplicity", "empty-range".
CagStatus cag_knots_check(const double *knots, size_t n, int p, CagError *err);
// Whether the knots are valid apart from their multiplicities: finite, nondecreasing, and with a
// nonempty domain. For CAG_ASSERT and tests.
bool cag_check_knots(const double *knots, size_t n, int p);
// Checks the degree against the number of control points: 1 <= p < n.
CagStatus cag_degree_check(size_t n, int p, CagError *err);

// Span of t within the usable range. `left` selects the span before a knot (the limit from the
// left). `hint`, usually the last result, is tried first.
size_t cag_knots_span(const double *knots, size_t n, int p, double t, bool left, size_t hint);
// Multiplicity of the knot t.
int cag_knots_multiplicity(const double *knots, size_t n, int p, double t);
// "uniform", "open-uniform", "open-nonuniform", "nonuniform" (Rogers 2001, An
// Introduction to NURBS, section 3.3).
const char *cag_knots_class(const double *knots, size_t n, int p);

#endif
