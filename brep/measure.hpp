// Volumes, areas, and centroids.
//
// The kernel's own quadratures are not used: that of fixed order is wrong by thousandths for splines
// with uneven parameters, and the adaptive ones can stop too early or take seconds for a sphere.

#ifndef CAG_BREP_MEASURE_HPP
#define CAG_BREP_MEASURE_HPP

#include <TopoDS_Shape.hxx>
#include <gp_Pnt.hxx>

namespace brep {

struct Measures {
  double volume, area;
  gp_Pnt centroid; // of the volume
};

// Of the faces of a shape, which close. The volume is negative if they point inward. Relative errors
// are near 1e-11 for surfaces that are smooth between their knots.
Measures measure(const TopoDS_Shape &shape);

} // namespace brep

#endif
