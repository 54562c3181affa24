// Planes that the kernel has made splines: bilinear patches whose corners are a parallelogram. The
// traces on them are mapped to the parameters of the plane; edges keep their curves.

#include "brep/flatten.hpp"

#include "brep/handle.hpp"

#include <BRepTools_Modification.hxx>
#include <BRepTools_Modifier.hxx>
#include <BRep_Tool.hxx>
#include <Geom2dConvert.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_Line.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Plane.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <gp_Ax3.hxx>

namespace brep {

// Corners are a parallelogram if they are this fraction of its size from one.
static const double FLATNESS = 1e-12;

// A plane and the map to its parameters from those of a patch.
struct FlatPatch {
  Ref<Geom_Plane> plane;
  double u0, v0;          // of the patch, at the origin of the plane
  gp_XY along_u, along_v; // in the plane, per parameter of the patch

  gp_Pnt2d map(const gp_Pnt2d &at) const {
    return gp_Pnt2d(along_u * (at.X() - u0) + along_v * (at.Y() - v0));
  }
};

static bool is_mappable(const Ref<Geom2d_Curve> &trace) {
  return !Ref<Geom2d_Line>::DownCast(trace).IsNull() ||
         !Ref<Geom2d_BSplineCurve>::DownCast(trace).IsNull();
}

static Ref<Geom2d_Curve> basis_trace(const TopoDS_Edge &edge, const TopoDS_Face &face,
                                     double &first, double &last) {
  Ref<Geom2d_Curve> trace = BRep_Tool::CurveOnSurface(edge, face, first, last);
  while (const auto trimmed = Ref<Geom2d_TrimmedCurve>::DownCast(trace))
    trace = trimmed->BasisCurve();
  return trace;
}

static bool find_patch(const TopoDS_Face &face, FlatPatch &patch) {
  const auto spline = Ref<Geom_BSplineSurface>::DownCast(BRep_Tool::Surface(face));
  if (spline.IsNull() || spline->UDegree() != 1 || spline->VDegree() != 1 ||
      spline->NbUPoles() != 2 || spline->NbVPoles() != 2 || spline->IsURational() ||
      spline->IsVRational())
    return false;
  const gp_XYZ p = spline->Pole(1, 1).XYZ(), a = spline->Pole(2, 1).XYZ() - p,
               b = spline->Pole(1, 2).XYZ() - p;
  const double size = a.Modulus() + b.Modulus();
  if ((spline->Pole(2, 2).XYZ() - p - a - b).Modulus() > FLATNESS * (size + p.Modulus()))
    return false;
  const gp_XYZ normal = a.Crossed(b);
  if (normal.Modulus() <= 1e-9 * a.Modulus() * b.Modulus()) return false;
  for (TopExp_Explorer it(face, TopAbs_EDGE); it.More(); it.Next()) {
    double first, last;
    if (!is_mappable(basis_trace(TopoDS::Edge(it.Current()), face, first, last))) return false;
  }
  double u1, v1;
  spline->Bounds(patch.u0, u1, patch.v0, v1);
  const gp_Ax3 frame{gp_Pnt(p), gp_Dir(normal), gp_Dir(a)};
  patch.plane = new Geom_Plane(frame);
  const gp_XYZ x = frame.XDirection().XYZ(), y = frame.YDirection().XYZ();
  patch.along_u = gp_XY(a.Dot(x), a.Dot(y)) / (u1 - patch.u0);
  patch.along_v = gp_XY(b.Dot(x), b.Dot(y)) / (v1 - patch.v0);
  return true;
}

class Flattening : public BRepTools_Modification {
public:
  Standard_Boolean NewSurface(const TopoDS_Face &face, Ref<Geom_Surface> &surface,
                              TopLoc_Location &location, Standard_Real &tolerance,
                              Standard_Boolean &reverse_wires,
                              Standard_Boolean &reverse_face) Standard_OVERRIDE {
    FlatPatch patch;
    if (!find_patch(face, patch)) return Standard_False;
    surface = patch.plane;
    location = TopLoc_Location();
    tolerance = BRep_Tool::Tolerance(face);
    reverse_wires = reverse_face = Standard_False;
    return Standard_True;
  }

  // All edges are made anew, so that those of changed faces are.
  Standard_Boolean NewCurve(const TopoDS_Edge &edge, Ref<Geom_Curve> &curve,
                            TopLoc_Location &location, Standard_Real &tolerance) Standard_OVERRIDE {
    double first, last;
    curve = BRep_Tool::Curve(edge, location, first, last);
    tolerance = BRep_Tool::Tolerance(edge);
    return Standard_True;
  }

  Standard_Boolean NewPoint(const TopoDS_Vertex &, gp_Pnt &, Standard_Real &) Standard_OVERRIDE {
    return Standard_False;
  }

  Standard_Boolean NewCurve2d(const TopoDS_Edge &edge, const TopoDS_Face &face, const TopoDS_Edge &,
                              const TopoDS_Face &, Ref<Geom2d_Curve> &trace,
                              Standard_Real &tolerance) Standard_OVERRIDE {
    double first, last;
    trace = basis_trace(edge, face, first, last);
    if (trace.IsNull()) return Standard_False;
    tolerance = BRep_Tool::Tolerance(edge);
    FlatPatch patch;
    if (!find_patch(face, patch)) return Standard_True;
    auto spline = Ref<Geom2d_BSplineCurve>::DownCast(trace->Copy());
    if (spline.IsNull())
      spline = Geom2dConvert::CurveToBSplineCurve(new Geom2d_TrimmedCurve(trace, first, last));
    for (int i = 1; i <= spline->NbPoles(); ++i) spline->SetPole(i, patch.map(spline->Pole(i)));
    trace = spline;
    return Standard_True;
  }

  Standard_Boolean NewParameter(const TopoDS_Vertex &corner, const TopoDS_Edge &edge,
                                Standard_Real &parameter,
                                Standard_Real &tolerance) Standard_OVERRIDE {
    if (corner.IsNull()) return Standard_False;
    parameter = BRep_Tool::Parameter(corner, edge);
    tolerance = BRep_Tool::Tolerance(corner);
    return Standard_True;
  }

  GeomAbs_Shape Continuity(const TopoDS_Edge &edge, const TopoDS_Face &a, const TopoDS_Face &b,
                           const TopoDS_Edge &, const TopoDS_Face &,
                           const TopoDS_Face &) Standard_OVERRIDE {
    return BRep_Tool::Continuity(edge, a, b);
  }
};

TopoDS_Shape flatten_faces(const TopoDS_Shape &shape) {
  BRepTools_Modifier modifier(shape, new Flattening);
  return modifier.IsDone() ? modifier.ModifiedShape(shape) : shape;
}

} // namespace brep
