// Planes that the kernel has made splines.

#ifndef CAG_BREP_FLATTEN_HPP
#define CAG_BREP_FLATTEN_HPP

#include <TopoDS_Shape.hxx>

namespace brep {

// The shape with planes in place of spline surfaces that are flat and have even parameters, such as
// those of affine maps.
TopoDS_Shape flatten_faces(const TopoDS_Shape &shape);

} // namespace brep

#endif
