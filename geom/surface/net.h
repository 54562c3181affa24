// Control points of a B-spline with vector coefficients of any width: homogeneous points of a
// curve, or whole rows of a surface's net. Changes of knots and degree are implemented once for
// both.

#ifndef CAG_GEOM_NET_H
#define CAG_GEOM_NET_H

#include "geom/surface/surface.h"

typedef struct CagNet {
  int degree;
  size_t count, width;
  double *knots; // count + degree + 1
  double *data;  // count x width
} CagNet;

CagStatus cag_net_new(int degree, size_t count, size_t width, CagNet *out, CagError *err);
void cag_net_free(CagNet *net);
double cag_net_start(const CagNet *net);
double cag_net_end(const CagNet *net);
// Multiplicity of t, up to a small fraction of the range.
int cag_net_multiplicity(const CagNet *net, double t);
// Inserts t, in the usable range, once (Boehm 1980).
CagStatus cag_net_insert(CagNet *net, double t, CagError *err);
// Trims to [a, b] of the usable range, with both ends interpolated.
CagStatus cag_net_trim(CagNet *net, double a, double b, CagError *err);
// Elevates the degree by one, preserving the points and the smoothness at the knots. Clamps the
// ends.
CagStatus cag_net_raise(CagNet *net, CagError *err);
// Removes one of the inner knots t, where the net must be so smooth that this changes nothing.
CagStatus cag_net_drop(CagNet *net, double t, CagError *err);
// Inserts the inner knots of `other` that the net lacks.
CagStatus cag_net_take_knots(CagNet *net, const CagNet *other, CagError *err);
// Maps the knots affinely to [a, b]; the ends exactly.
void cag_net_rescale(CagNet *net, double a, double b);
void cag_net_reverse(CagNet *net);
// Brings all nets to one degree and one knot vector over 0..1.
CagStatus cag_nets_unify(CagNet *nets, size_t n, CagError *err);
// A curve's homogeneous points, clamped, over 0..1.
CagStatus cag_net_of_curve(const CagCurve *c, CagNet *out, CagError *err);

// The net of a NURBS surface along a direction (0: u); its points are the rows across. Surfaces of
// other kinds are converted to their exact form.
CagStatus cag_net_of_surface(const CagSurface *s, int direction, CagNet *out, CagNet *across,
                             CagError *err);
// The inverse: `across` provides degree and knots of the other direction (its data are not used).
CagStatus cag_net_to_surface(const CagNet *net, int direction, const CagNet *across,
                             CagSurface **out, CagError *err);

// Interpolation by banded elimination: data[i] is the value at parameters[i] and is replaced by the
// coefficients (count rows). Fails with "fit-singular".
CagStatus cag_net_interpolate(CagNet *net, const double *parameters, CagError *err);
// Clamped knots for interpolation at ascending parameters: averages of `degree` neighbors.
void cag_net_averaged_knots(const double *parameters, size_t n, int degree, double *knots);

#endif
