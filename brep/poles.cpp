#include "brep/poles.hpp"

#include "brep/handle.hpp"

#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <ElSLib.hxx>
#include <Geom2d_Line.hxx>
#include <GeomAdaptor_Curve.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <cmath>
#include <gp_Sphere.hxx>
#include <vector>

namespace brep {

// A trace is straight if it is this close to its line, in radians.
static const double STRAIGHT = 1e-9;
// Ends of traces that meet are this close.
static const double SAME_END = 1e-6;

// Where an end of a trace was, and where it is.
struct MovedEnd {
  gp_Pnt2d from, to;
};

// The value that differs by whole turns from an angle and is nearest to another.
static double beside(double angle, double near) {
  return angle + 2 * M_PI * std::round((near - angle) / (2 * M_PI));
}

// The trace of an edge that is an arc of a meridian, by its parameter: null for other edges. The end
// of the old trace that is farther from the poles tells the turn.
static Ref<Geom2d_Curve> meridian_trace(const gp_Sphere &sphere, const TopoDS_Edge &edge,
                                        const Ref<Geom2d_Curve> &old) {
  double first, last;
  const Ref<Geom_Curve> curve = BRep_Tool::Curve(edge, first, last);
  if (curve.IsNull() || GeomAdaptor_Curve(curve).GetType() != GeomAbs_Circle) return {};
  const double middle = (first + last) / 2, step = (last - first) / 4;
  double u[3], v[3];
  for (int i = 0; i < 3; ++i)
    ElSLib::Parameters(sphere, curve->Value(middle + (i - 1) * step), u[i], v[i]);
  const double way = v[2] > v[0] ? 1 : -1;
  for (int i = 0; i < 3; ++i) {
    u[i] = beside(u[i], u[1]);
    if (std::abs(u[i] - u[1]) * std::cos(v[i]) > STRAIGHT ||
        std::abs(v[i] - v[1] - way * (i - 1) * step) > STRAIGHT)
      return {};
  }
  const gp_Pnt2d start = old->Value(first), end = old->Value(last);
  const double near = std::abs(start.Y()) < std::abs(end.Y()) ? start.X() : end.X();
  return new Geom2d_Line(gp_Pnt2d(beside(u[1], near), v[1] - way * middle), gp_Dir2d(0, way));
}

// The new trace of a use of an edge, or null if the old one is as good. Notes its ends.
static Ref<Geom2d_Curve> straight_trace(const gp_Sphere &sphere, const TopoDS_Edge &edge,
                                        const TopoDS_Face &face, std::vector<MovedEnd> &moved) {
  double first, last;
  const Ref<Geom2d_Curve> old = BRep_Tool::CurveOnSurface(edge, face, first, last);
  if (old.IsNull()) return {};
  const Ref<Geom2d_Curve> line = meridian_trace(sphere, edge, old);
  if (line.IsNull()) return {};
  const MovedEnd ends[2] = {{old->Value(first), line->Value(first)},
                            {old->Value(last), line->Value(last)}};
  if (ends[0].from.Distance(ends[0].to) <= SAME_END &&
      ends[1].from.Distance(ends[1].to) <= SAME_END)
    return {};
  moved.insert(moved.end(), ends, ends + 2);
  return line;
}

static gp_Pnt2d moved_end(const gp_Pnt2d &end, const std::vector<MovedEnd> &moved) {
  for (const MovedEnd &one : moved)
    if (one.from.Distance(end) <= SAME_END) return one.to;
  return end;
}

// The trace of a pole between the ends of its neighbors.
static void join_pole(const TopoDS_Edge &edge, const TopoDS_Face &face,
                      const std::vector<MovedEnd> &moved) {
  double first, last;
  const Ref<Geom2d_Curve> old = BRep_Tool::CurveOnSurface(edge, face, first, last);
  if (old.IsNull()) return;
  const gp_Pnt2d start = moved_end(old->Value(first), moved),
                 end = moved_end(old->Value(last), moved);
  const double length = start.Distance(end);
  if (length <= SAME_END) return;
  BRep_Builder builder;
  builder.UpdateEdge(edge, new Geom2d_Line(start, gp_Vec2d(start, end)), face,
                     BRep_Tool::Tolerance(edge));
  builder.Range(edge, face, 0, length);
}

bool straighten_meridians(const TopoDS_Face &face) {
  const GeomAdaptor_Surface surface(BRep_Tool::Surface(face));
  if (surface.GetType() != GeomAbs_Sphere) return false;
  const gp_Sphere sphere = surface.Sphere();
  std::vector<MovedEnd> moved;
  BRep_Builder builder;
  for (TopExp_Explorer it(face, TopAbs_EDGE); it.More(); it.Next()) {
    const TopoDS_Edge edge = TopoDS::Edge(it.Current().Oriented(TopAbs_FORWARD));
    if (BRep_Tool::Degenerated(edge)) continue;
    const double tolerance = BRep_Tool::Tolerance(edge);
    const Ref<Geom2d_Curve> line = straight_trace(sphere, edge, face, moved);
    if (!BRep_Tool::IsClosed(edge, face)) {
      if (!line.IsNull()) builder.UpdateEdge(edge, line, face, tolerance);
      continue;
    }
    // A seam has two traces.
    const TopoDS_Edge back = TopoDS::Edge(edge.Reversed());
    const Ref<Geom2d_Curve> other = straight_trace(sphere, back, face, moved);
    if (line.IsNull() && other.IsNull()) continue;
    double first, last;
    builder.UpdateEdge(edge,
                       line.IsNull() ? BRep_Tool::CurveOnSurface(edge, face, first, last) : line,
                       other.IsNull() ? BRep_Tool::CurveOnSurface(back, face, first, last) : other,
                       face, tolerance);
  }
  if (moved.empty()) return false;
  for (TopExp_Explorer it(face, TopAbs_EDGE); it.More(); it.Next()) {
    const TopoDS_Edge edge = TopoDS::Edge(it.Current().Oriented(TopAbs_FORWARD));
    if (BRep_Tool::Degenerated(edge)) join_pole(edge, face, moved);
  }
  return true;
}

} // namespace brep
