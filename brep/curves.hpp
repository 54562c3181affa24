// Curves and surfaces of the kernel, as fields of a message.

#ifndef CAG_BREP_CURVES_HPP
#define CAG_BREP_CURVES_HPP

#include "brep/codec.hpp"

#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>

namespace brep {

struct Bounds {
  double u0, u1, v0, v1;
};

// Writes a curve in space. Curves of other kinds than those of the protocol become splines with the
// same parameter over first..last. Returns how far the spline is from the curve: by rounding alone if
// it can be exact, else below a fraction of the tolerance.
double write_curve(Writer &out, const Ref<Geom_Curve> &curve, double first, double last,
                   double tolerance);

// A surface that was written, and its parameters from those of the one that was given.
struct WrittenSurface {
  bool mirrored;    // its u is -u
  double error;     // how far apart the surfaces are
  double shift = 0; // its v is v + shift
};
WrittenSurface write_surface(Writer &out, const Ref<Geom_Surface> &surface, const Bounds &bounds,
                             double tolerance);

// Writes a curve in the parameters of a surface, as one in those of the surface that was written.
void write_trace(Writer &out, const Ref<Geom2d_Curve> &trace, double first, double last,
                 const WrittenSurface &on);

} // namespace brep

#endif
