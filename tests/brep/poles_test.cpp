// The traces of spherical faces at their poles. Prints what is wrong, or nothing.

#include "brep/poles.hpp"

#include "brep/handle.hpp"

#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_Line.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array1OfPnt2d.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <cmath>
#include <cstdio>

using brep::Ref;

static int failures = 0;

static void expect(bool is_true, const char *what) {
  if (is_true) return;
  std::printf("FAILED: %s\n", what);
  ++failures;
}

// The upper half of a sphere, from the equator to the pole.
static TopoDS_Face half_sphere() {
  TopExp_Explorer it(BRepPrimAPI_MakeSphere(5, 0, M_PI / 2).Face(), TopAbs_FACE);
  return TopoDS::Face(it.Current().Oriented(TopAbs_FORWARD));
}

static TopoDS_Edge find_edge(const TopoDS_Face &face, bool seam) {
  for (TopExp_Explorer it(face, TopAbs_EDGE); it.More(); it.Next()) {
    const TopoDS_Edge edge = TopoDS::Edge(it.Current().Oriented(TopAbs_FORWARD));
    if (seam ? BRep_Tool::IsClosed(edge, face) : BRep_Tool::Degenerated(edge)) return edge;
  }
  return TopoDS_Edge();
}

// A line with the parameter of an edge.
static Ref<Geom2d_Curve> slanted(double first, double last, const gp_Pnt2d &start,
                                 const gp_Pnt2d &end) {
  TColgp_Array1OfPnt2d points(1, 2);
  TColStd_Array1OfReal knots(1, 2);
  TColStd_Array1OfInteger counts(1, 2);
  points(1) = start;
  points(2) = end;
  knots(1) = first;
  knots(2) = last;
  counts.Init(2);
  return new Geom2d_BSplineCurve(points, knots, counts, 1);
}

static Ref<Geom2d_Curve> trace_of(const TopoDS_Edge &edge, const TopoDS_Face &face, double &first,
                                  double &last) {
  return BRep_Tool::CurveOnSurface(edge, face, first, last);
}

// The ends of both traces of a seam at the pole, moved by an angle, as those of the pole itself.
static void bend_seam(const TopoDS_Face &face, double angle) {
  const TopoDS_Edge seam = find_edge(face, true), pole = find_edge(face, false);
  BRep_Builder builder;
  Ref<Geom2d_Curve> bent[2];
  double first, last;
  for (int i = 0; i < 2; ++i) {
    const auto trace = trace_of(i ? TopoDS::Edge(seam.Reversed()) : seam, face, first, last);
    bent[i] = slanted(first, last, trace->Value(first),
                      trace->Value(last).Translated(gp_Vec2d(angle, 0)));
  }
  builder.UpdateEdge(seam, bent[0], bent[1], face, 1e-7);
  const auto trace = trace_of(pole, face, first, last);
  builder.UpdateEdge(pole,
                     slanted(first, last, trace->Value(first).Translated(gp_Vec2d(angle, 0)),
                             trace->Value(last).Translated(gp_Vec2d(angle, 0))),
                     face, 1e-7);
}

static void bent_seams_are_straightened() {
  const TopoDS_Face face = half_sphere();
  bend_seam(face, -1.25);
  expect(brep::straighten_meridians(face), "a bent seam is found");
  const TopoDS_Edge seam = find_edge(face, true), pole = find_edge(face, false);
  double first, last, sum = 0;
  for (int i = 0; i < 2; ++i) {
    const auto trace = trace_of(i ? TopoDS::Edge(seam.Reversed()) : seam, face, first, last);
    for (int k = 0; k <= 4; ++k) {
      // The meridian at y = 0, whose parameter is the latitude, up to a turn.
      const double t = first + (last - first) * k / 4;
      const gp_Pnt2d at = trace->Value(t);
      expect(std::abs(std::sin(at.X() / 2)) < 1e-9, "a seam has a constant u");
      expect(std::abs(std::remainder(at.Y() - t, 2 * M_PI)) < 1e-9 && at.Y() < M_PI / 2 + 1e-9,
             "v is the latitude");
    }
    sum += trace->Value(first).X();
  }
  expect(std::abs(sum - 2 * M_PI) < 1e-9, "the traces of a seam are a turn apart");
  const auto trace = trace_of(pole, face, first, last);
  const gp_Pnt2d ends[2] = {trace->Value(first), trace->Value(last)};
  expect(std::abs(ends[0].X() + ends[1].X() - 2 * M_PI) < 1e-9 &&
             std::abs(std::abs(ends[0].X() - ends[1].X()) - 2 * M_PI) < 1e-9,
         "the trace of the pole joins those of the seam");
}

static void straight_seams_stay() {
  const TopoDS_Face face = half_sphere();
  expect(!brep::straighten_meridians(face), "a straight seam stays");
}

int main() {
  bent_seams_are_straightened();
  straight_seams_stay();
  return failures != 0;
}
