#include "brep/sides.hpp"

#include "brep/handle.hpp"

#include <BRepAdaptor_Curve.hxx>
#include <BRep_Tool.hxx>
#include <Extrema_ExtPC.hxx>
#include <GCPnts_AbscissaPoint.hxx>
#include <Geom2d_Curve.hxx>
#include <GeomLProp_SLProps.hxx>
#include <TopExp.hxx>
#include <TopTools_ListIteratorOfListOfShape.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <cmath>

namespace brep {

Sides::Sides(const TopoDS_Solid &solid) {
  TopExp::MapShapesAndAncestors(solid, TopAbs_EDGE, TopAbs_FACE, map);
}

std::vector<TopoDS_Face> Sides::faces(const TopoDS_Edge &edge) const {
  std::vector<TopoDS_Face> found;
  if (!map.Contains(edge)) return found;
  for (TopTools_ListIteratorOfListOfShape it(map.FindFromKey(edge)); it.More(); it.Next())
    found.push_back(TopoDS::Face(it.Value()));
  return found;
}

gp_Pnt middle_of(const TopoDS_Edge &edge) {
  const BRepAdaptor_Curve curve(edge);
  return curve.Value((curve.FirstParameter() + curve.LastParameter()) / 2);
}

double length_of(const TopoDS_Edge &edge) {
  if (BRep_Tool::Degenerated(edge)) return 0;
  return GCPnts_AbscissaPoint::Length(BRepAdaptor_Curve(edge));
}

gp_Vec normal_beside(const TopoDS_Face &face, const TopoDS_Edge &edge) {
  double first, last;
  const Ref<Geom2d_Curve> trace = BRep_Tool::CurveOnSurface(edge, face, first, last);
  if (trace.IsNull()) return gp_Vec();
  const gp_Pnt2d at = trace->Value((first + last) / 2);
  GeomLProp_SLProps properties(BRep_Tool::Surface(face), at.X(), at.Y(), 1, 1e-12);
  if (!properties.IsNormalDefined()) return gp_Vec();
  const gp_Vec normal(properties.Normal());
  return face.Orientation() == TopAbs_REVERSED ? normal.Reversed() : normal;
}

TopoDS_Edge edge_at(const TopoDS_Solid &solid, const gp_Pnt &point, double tolerance) {
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(solid, TopAbs_EDGE, edges);
  TopoDS_Edge best;
  double least = tolerance;
  for (int i = 1; i <= edges.Extent(); ++i) {
    const TopoDS_Edge edge = TopoDS::Edge(edges(i));
    if (BRep_Tool::Degenerated(edge)) continue;
    const BRepAdaptor_Curve curve(edge);
    Extrema_ExtPC extrema(point, curve);
    if (!extrema.IsDone()) continue;
    for (int k = 1; k <= extrema.NbExt(); ++k) {
      const double distance = std::sqrt(extrema.SquareDistance(k));
      if (extrema.IsMin(k) && distance < least) {
        least = distance;
        best = edge;
      }
    }
  }
  return best;
}

} // namespace brep
