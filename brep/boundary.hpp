// The boundary of a solid, as fields of a message.

#ifndef CAG_BREP_BOUNDARY_HPP
#define CAG_BREP_BOUNDARY_HPP

#include "brep/codec.hpp"
#include "brep/measure.hpp"

#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Solid.hxx>

namespace brep {

// The corners, edges and faces of a solid in the order of its boundary, from 1. The order depends
// on positions alone: neither on how the solid was made, nor on addresses in memory.
struct Numbering {
  TopTools_IndexedMapOfShape corners, edges, faces;
};
Numbering number_boundary(const TopoDS_Solid &solid);

// Completes what the boundary has to tell of all edges: curves in space and in the parameters of
// their faces, at the same parameters. Returns whether some were missing or wrong.
bool complete_edges(const TopoDS_Solid &solid);

void write_boundary(Writer &out, const TopoDS_Solid &solid, const Measures &measures);

} // namespace brep

#endif
