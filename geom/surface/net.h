// Control points of a B-spline whose coefficients are vectors of any width: homogeneous points of a
// curve, or whole rows of a surface's net. Everything that changes knots or degree is written once
// for both.

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
// How often t occurs, to a small part of the range.
int cag_net_multiplicity(const CagNet *net, double t);
// Inserts t once (Boehm 1980); t in the usable range.
CagStatus cag_net_insert(CagNet *net, double t, CagError *err);
// Only [a, b] of the usable range, both ends interpolated.
CagStatus cag_net_trim(CagNet *net, double a, double b, CagError *err);
// The degree raised by one; smoothness at the knots stays, as do the points. Clamps the ends.
CagStatus cag_net_raise(CagNet *net, CagError *err);
// Takes out one of the inner knots t, where the net is so smooth that this changes nothing.
CagStatus cag_net_drop(CagNet *net, double t, CagError *err);
// Gives the net the inner knots of `other` that it lacks.
CagStatus cag_net_take_knots(CagNet *net, const CagNet *other, CagError *err);
// Knots moved affinely to [a, b]; the ends exactly.
void cag_net_rescale(CagNet *net, double a, double b);
void cag_net_reverse(CagNet *net);
// One degree and one knot vector for all, over 0..1.
CagStatus cag_nets_unify(CagNet *nets, size_t n, CagError *err);
// A curve's homogeneous points, clamped, over 0..1.
CagStatus cag_net_of_curve(const CagCurve *c, CagNet *out, CagError *err);

// The net of a NURBS surface along a direction (0: u): its points are the rows across. Surfaces of
// other kinds are taken by their exact form.
CagStatus cag_net_of_surface(const CagSurface *s, int direction, CagNet *out, CagNet *across,
                             CagError *err);
// Back: `across` gives degree and knots of the other direction (its data are not used).
CagStatus cag_net_to_surface(const CagNet *net, int direction, const CagNet *across,
                             CagSurface **out, CagError *err);

// data[i] is the wanted value at parameters[i], becomes the coefficients (count rows): banded
// elimination; "fit-singular".
CagStatus cag_net_interpolate(CagNet *net, const double *parameters, CagError *err);
// Clamped knots for interpolation at ascending parameters: means of `degree` neighbors.
void cag_net_averaged_knots(const double *parameters, size_t n, int degree, double *knots);

#endif
