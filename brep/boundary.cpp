// The boundary of a solid, as fields of a message.
//
// The kernel orients the loops of a face as if the face had the orientation of its surface. Loops are
// therefore read from the face oriented forward, where each use has its own trace even along a seam,
// and reversed afterwards if the face is.

#include "brep/boundary.hpp"

#include "brep/curves.hpp"
#include "brep/measure.hpp"
#include "brep/poles.hpp"
#include "brep/solids.hpp"

#include <BRepClass3d.hxx>
#include <BRepLib.hxx>
#include <BRepTools.hxx>
#include <BRepTools_WireExplorer.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom2d_Curve.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>
#include <ShapeFix_Edge.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <array>
#include <cmath>

namespace brep {

// ---- numbers of corners, edges, and faces ----

// Positions are compared after rounding to this fraction of the size, so that rounding errors do not
// change the order.
static const double ORDER_GRID = 1e-7;

// Points where an edge is compared with its trace, and how much farther apart they may be between these
// points.
static const int TRACE_SAMPLES = 24;
static const double TRACE_MARGIN = 1.1;

static bool is_boundary(const TopoDS_Shape &shape) {
  return shape.Orientation() == TopAbs_FORWARD || shape.Orientation() == TopAbs_REVERSED;
}

// All parts of a type, without those inside of faces or of the solid.
static std::vector<TopoDS_Shape> boundary_parts(const TopoDS_Shape &solid, TopAbs_ShapeEnum type) {
  TopTools_IndexedMapOfShape parts;
  for (TopExp_Explorer it(solid, type); it.More(); it.Next())
    if (is_boundary(it.Current())) parts.Add(it.Current());
  std::vector<TopoDS_Shape> found;
  for (int i = 1; i <= parts.Extent(); ++i) found.push_back(parts(i));
  return found;
}

static gp_XYZ edge_middle(const TopoDS_Edge &edge) {
  double first, last;
  const Ref<Geom_Curve> curve = BRep_Tool::Curve(edge, first, last);
  if (!curve.IsNull()) return curve->Value((first + last) / 2).XYZ();
  const TopoDS_Vertex corner = TopExp::FirstVertex(edge);
  return corner.IsNull() ? gp_XYZ() : BRep_Tool::Pnt(corner).XYZ();
}

// Keys that sort parts: rounded coordinates, then numbers of parts that are sorted already.
typedef std::vector<double> SortKey;

static void add_position(SortKey &key, const gp_XYZ &position, double grid) {
  for (int i = 1; i <= 3; ++i) key.push_back(std::round(position.Coord(i) / grid));
}

static void add_sorted(TopTools_IndexedMapOfShape &map,
                       std::vector<std::pair<SortKey, TopoDS_Shape>> &parts) {
  std::stable_sort(parts.begin(), parts.end(),
                   [](const auto &a, const auto &b) { return a.first < b.first; });
  for (const auto &part : parts) map.Add(part.second);
}

Numbering number_boundary(const TopoDS_Solid &solid) {
  Numbering numbering;
  const double size = diagonal_of(solid), grid = size > 0 ? size * ORDER_GRID : 1;
  std::vector<std::pair<SortKey, TopoDS_Shape>> parts;
  for (const TopoDS_Shape &corner : boundary_parts(solid, TopAbs_VERTEX)) {
    SortKey key;
    add_position(key, BRep_Tool::Pnt(TopoDS::Vertex(corner)).XYZ(), grid);
    parts.push_back({key, corner});
  }
  add_sorted(numbering.corners, parts);
  parts.clear();
  for (const TopoDS_Shape &shape : boundary_parts(solid, TopAbs_EDGE)) {
    const TopoDS_Edge edge = TopoDS::Edge(shape);
    SortKey key;
    add_position(key, edge_middle(edge), grid);
    TopoDS_Vertex start, end;
    TopExp::Vertices(edge, start, end);
    int a = numbering.corners.FindIndex(start), b = numbering.corners.FindIndex(end);
    key.insert(key.end(),
               {static_cast<double>(std::min(a, b)), static_cast<double>(std::max(a, b))});
    key.push_back(BRep_Tool::Degenerated(edge));
    parts.push_back({key, edge});
  }
  add_sorted(numbering.edges, parts);
  parts.clear();
  for (const TopoDS_Shape &shape : boundary_parts(solid, TopAbs_FACE)) {
    const TopoDS_Face face = TopoDS::Face(shape);
    gp_XYZ sum;
    std::vector<double> uses;
    for (TopExp_Explorer it(face, TopAbs_EDGE); it.More(); it.Next()) {
      if (!is_boundary(it.Current())) continue;
      sum += edge_middle(TopoDS::Edge(it.Current()));
      uses.push_back(numbering.edges.FindIndex(it.Current()));
    }
    std::sort(uses.begin(), uses.end());
    SortKey key;
    add_position(key, uses.empty() ? sum : sum / static_cast<double>(uses.size()), grid);
    key.insert(key.end(), uses.begin(), uses.end());
    parts.push_back({key, face});
  }
  add_sorted(numbering.faces, parts);
  return numbering;
}

// ---- edges ----

// How far an edge and its trace on a face are apart, at points of the edge.
static double trace_gap(const TopoDS_Edge &edge, const TopoDS_Face &face) {
  double first, last, start, end;
  const Ref<Geom_Curve> curve = BRep_Tool::Curve(edge, first, last);
  const Ref<Geom2d_Curve> trace = BRep_Tool::CurveOnSurface(edge, face, start, end);
  if (curve.IsNull() || trace.IsNull()) return 0;
  const GeomAdaptor_Surface surface(BRep_Tool::Surface(face));
  double gap = 0;
  for (int i = 0; i <= TRACE_SAMPLES; ++i) {
    const double t = first + (last - first) * i / TRACE_SAMPLES;
    const gp_Pnt2d at = trace->Value(t);
    gap = std::max(gap, curve->Value(t).Distance(surface.Value(at.X(), at.Y())));
  }
  return gap;
}

bool complete_edges(const TopoDS_Solid &solid) {
  bool incomplete = false;
  BRepLib::BuildCurves3d(solid);
  ShapeFix_Edge fix;
  BRep_Builder builder;
  for (const TopoDS_Shape &shape : boundary_parts(solid, TopAbs_FACE)) {
    const TopoDS_Face face = TopoDS::Face(shape.Oriented(TopAbs_FORWARD));
    incomplete = straighten_meridians(face) || incomplete;
    for (TopExp_Explorer it(face, TopAbs_EDGE); it.More(); it.Next()) {
      const TopoDS_Edge edge = TopoDS::Edge(it.Current());
      double first, last;
      if (BRep_Tool::CurveOnSurface(edge, face, first, last).IsNull()) {
        fix.FixAddPCurve(edge, face, BRep_Tool::IsClosed(edge, face));
        incomplete = true;
      }
      if (BRep_Tool::Degenerated(edge)) continue;
      if (!BRep_Tool::SameParameter(edge) || !BRep_Tool::SameRange(edge)) {
        incomplete = true;
        BRepLib::SameRange(edge);
        BRepLib::SameParameter(edge);
      }
      // Files may have edges whose tolerance is too small for their traces.
      const double gap = trace_gap(edge, face);
      if (gap <= BRep_Tool::Tolerance(edge)) continue;
      builder.UpdateEdge(edge, gap * TRACE_MARGIN);
      for (TopExp_Explorer corner(edge, TopAbs_VERTEX); corner.More(); corner.Next())
        builder.UpdateVertex(TopoDS::Vertex(corner.Current()), gap * TRACE_MARGIN);
    }
  }
  return incomplete;
}

// How far the corners of an edge are from its ends.
static double corner_gap(const Ref<Geom_Curve> &curve, double first, double last,
                         const TopoDS_Vertex &start, const TopoDS_Vertex &end) {
  return std::max(curve->Value(first).Distance(BRep_Tool::Pnt(start)),
                  curve->Value(last).Distance(BRep_Tool::Pnt(end)));
}

static void write_edge(Writer &out, const TopoDS_Edge &edge, const Numbering &numbering) {
  TopoDS_Vertex start, end;
  TopExp::Vertices(TopoDS::Edge(edge.Oriented(TopAbs_FORWARD)), start, end);
  if (start.IsNull()) start = end;
  if (end.IsNull()) end = start;
  if (start.IsNull()) throw Failure{CAG_BREP_FAIL_CHECK, "an edge has no corners"};
  double first, last, tolerance = BRep_Tool::Tolerance(edge);
  const Ref<Geom_Curve> curve = BRep_Tool::Curve(edge, first, last);
  if (curve.IsNull() || BRep_Tool::Degenerated(edge)) {
    out.u32(CAG_BREP_POINT);
    BRep_Tool::Range(edge, first, last);
  } else {
    tolerance = std::max(tolerance + write_curve(out, curve, first, last, tolerance),
                         corner_gap(curve, first, last, start, end));
  }
  out.f64(first);
  out.f64(last);
  out.u32(static_cast<uint32_t>(numbering.corners.FindIndex(start) - 1));
  out.u32(static_cast<uint32_t>(numbering.corners.FindIndex(end) - 1));
  out.f64(tolerance);
}

// ---- faces ----

// One side of an edge, in the parameters of a face that is oriented forward.
struct Use {
  TopoDS_Edge edge;
  Ref<Geom2d_Curve> trace;
  double first, last;
  bool reversed;

  gp_Pnt2d start() const { return trace->Value(reversed ? last : first); }
  gp_Pnt2d end() const { return trace->Value(reversed ? first : last); }
};

static Use make_use(const TopoDS_Edge &edge, const TopoDS_Face &face) {
  Use use = {edge, {}, 0, 0, edge.Orientation() == TopAbs_REVERSED};
  use.trace = BRep_Tool::CurveOnSurface(edge, face, use.first, use.last);
  if (use.trace.IsNull()) throw Failure{CAG_BREP_FAIL_CHECK, "an edge has no curve on its face"};
  return use;
}

// The uses of a loop, each after the one at whose end it starts: of several that share the corner,
// the one that is nearest in the parameters.
static std::vector<Use> order_uses(std::vector<Use> uses) {
  for (size_t i = 1; i < uses.size(); ++i) {
    const gp_Pnt2d end = uses[i - 1].end();
    const TopoDS_Vertex corner = TopExp::LastVertex(uses[i - 1].edge, Standard_True);
    size_t best = i;
    double least = INFINITY;
    for (size_t k = i; k < uses.size(); ++k) {
      double distance = end.Distance(uses[k].start());
      if (!corner.IsSame(TopExp::FirstVertex(uses[k].edge, Standard_True))) distance += 1e100;
      if (distance < least) {
        least = distance;
        best = k;
      }
    }
    std::rotate(uses.begin() + static_cast<std::ptrdiff_t>(i),
                uses.begin() + static_cast<std::ptrdiff_t>(best),
                uses.begin() + static_cast<std::ptrdiff_t>(best) + 1);
  }
  return uses;
}

static std::vector<Use> loop_uses(const TopoDS_Wire &wire, const TopoDS_Face &face) {
  std::vector<Use> all, walked;
  for (TopoDS_Iterator it(wire); it.More(); it.Next())
    if (is_boundary(it.Value())) all.push_back(make_use(TopoDS::Edge(it.Value()), face));
  for (BRepTools_WireExplorer it(wire, face); it.More() && walked.size() <= all.size(); it.Next())
    if (is_boundary(it.Current())) walked.push_back(make_use(it.Current(), face));
  return walked.size() == all.size() ? walked : order_uses(all);
}

// The loops of a face, the outer one first.
static std::vector<TopoDS_Wire> face_loops(const TopoDS_Face &face) {
  std::vector<TopoDS_Wire> wires;
  const TopoDS_Wire outer = BRepTools::OuterWire(face);
  for (TopoDS_Iterator it(face); it.More(); it.Next()) {
    if (it.Value().ShapeType() != TopAbs_WIRE || !is_boundary(it.Value())) continue;
    wires.push_back(TopoDS::Wire(it.Value()));
    if (wires.back().IsSame(outer)) std::swap(wires.front(), wires.back());
  }
  return wires;
}

static void write_face(Writer &out, const TopoDS_Face &oriented, const Numbering &numbering) {
  const TopoDS_Face face = TopoDS::Face(oriented.Oriented(TopAbs_FORWARD));
  const bool reversed = oriented.Orientation() == TopAbs_REVERSED;
  Bounds bounds;
  BRepTools::UVBounds(face, bounds.u0, bounds.u1, bounds.v0, bounds.v1);
  const WrittenSurface written =
      write_surface(out, BRep_Tool::Surface(face), bounds, BRep_Tool::Tolerance(face));
  out.u32(reversed != written.mirrored);
  out.f64(written.mirrored ? -bounds.u1 : bounds.u0);
  out.f64(written.mirrored ? -bounds.u0 : bounds.u1);
  out.f64(bounds.v0 + written.shift);
  out.f64(bounds.v1 + written.shift);
  out.f64(BRep_Tool::Tolerance(face) + written.error);
  std::vector<std::vector<Use>> loops;
  for (const TopoDS_Wire &wire : face_loops(face)) {
    // A wire may have no edges but some inside of the face.
    const std::vector<Use> uses = loop_uses(wire, face);
    if (!uses.empty()) loops.push_back(uses);
  }
  if (loops.empty()) throw Failure{CAG_BREP_FAIL_CHECK, "a face has no loops"};
  out.u32(static_cast<uint32_t>(loops.size()));
  for (std::vector<Use> &uses : loops) {
    if (reversed) std::reverse(uses.begin(), uses.end());
    out.u32(static_cast<uint32_t>(uses.size()));
    for (const Use &use : uses) {
      out.u32(static_cast<uint32_t>(numbering.edges.FindIndex(use.edge) - 1));
      out.u32(use.reversed != reversed);
      write_trace(out, use.trace, use.first, use.last, written);
    }
  }
}

static void write_shells(Writer &out, const TopoDS_Solid &solid, const Numbering &numbering) {
  const TopoDS_Shell outer = BRepClass3d::OuterShell(solid);
  std::vector<TopoDS_Shape> shells;
  for (TopoDS_Iterator it(solid); it.More(); it.Next()) {
    if (it.Value().ShapeType() != TopAbs_SHELL) continue;
    shells.push_back(it.Value());
    if (shells.back().IsSame(outer)) std::swap(shells.front(), shells.back());
  }
  std::vector<std::vector<uint32_t>> lists;
  for (const TopoDS_Shape &shell : shells) {
    std::vector<uint32_t> faces;
    for (TopoDS_Iterator it(shell); it.More(); it.Next())
      if (is_boundary(it.Value()))
        faces.push_back(static_cast<uint32_t>(numbering.faces.FindIndex(it.Value()) - 1));
    std::sort(faces.begin(), faces.end());
    lists.push_back(faces);
  }
  if (!lists.empty()) std::sort(lists.begin() + 1, lists.end());
  out.u32(static_cast<uint32_t>(lists.size()));
  for (const std::vector<uint32_t> &faces : lists) {
    out.u32(static_cast<uint32_t>(faces.size()));
    for (const uint32_t face : faces) out.u32(face);
  }
}

void write_boundary(Writer &out, const TopoDS_Solid &solid, const Measures &measures) {
  const Numbering numbering = number_boundary(solid);
  out.f64(measures.volume);
  out.f64(measures.area);
  out.xyz(measures.centroid.XYZ());
  out.u32(static_cast<uint32_t>(numbering.corners.Extent()));
  for (int i = 1; i <= numbering.corners.Extent(); ++i)
    out.xyz(BRep_Tool::Pnt(TopoDS::Vertex(numbering.corners(i))).XYZ());
  out.u32(static_cast<uint32_t>(numbering.edges.Extent()));
  for (int i = 1; i <= numbering.edges.Extent(); ++i)
    write_edge(out, TopoDS::Edge(numbering.edges(i)), numbering);
  out.u32(static_cast<uint32_t>(numbering.faces.Extent()));
  for (int i = 1; i <= numbering.faces.Extent(); ++i)
    write_face(out, TopoDS::Face(numbering.faces(i)), numbering);
  write_shells(out, solid, numbering);
}

} // namespace brep
