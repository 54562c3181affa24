// The faces beside the edges of a solid.

#ifndef CAG_BREP_SIDES_HPP
#define CAG_BREP_SIDES_HPP

#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Solid.hxx>
#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>
#include <vector>

namespace brep {

class Sides {
public:
  explicit Sides(const TopoDS_Solid &solid);
  // Two faces, or one twice along its seam.
  std::vector<TopoDS_Face> faces(const TopoDS_Edge &edge) const;

private:
  TopTools_IndexedDataMapOfShapeListOfShape map;
};

// The middle of an edge by its parameter.
gp_Pnt middle_of(const TopoDS_Edge &edge);
double length_of(const TopoDS_Edge &edge);
// The outward unit normal of a face at a point of one of its edges, or no vector where the surface has
// none.
gp_Vec normal_beside(const TopoDS_Face &face, const TopoDS_Edge &edge);

// The edge that a point lies on; null if none is within the tolerance.
TopoDS_Edge edge_at(const TopoDS_Solid &solid, const gp_Pnt &point, double tolerance);

} // namespace brep

#endif
