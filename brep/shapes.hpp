// The solids of requests.

#ifndef CAG_BREP_SHAPES_HPP
#define CAG_BREP_SHAPES_HPP

#include "brep/codec.hpp"
#include "brep/solids.hpp"

#include <Geom_Curve.hxx>
#include <TopoDS_Edge.hxx>

namespace brep {

// Reads a solid and evaluates it: zero or more separate solids.
Solids read_solids(Reader &in);
// Fails unless it is one solid.
TopoDS_Solid read_solid(Reader &in);

// Reads a curve in space and the range of its parameter, as edges. A spline is cut where its tangent
// breaks.
std::vector<TopoDS_Edge> read_space_edges(Reader &in);

// The form of a solid that a CAG_BREP_BODY holds.
std::string write_body(const TopoDS_Solid &solid);
TopoDS_Solid read_body_solid(Reader &in);

} // namespace brep

#endif
