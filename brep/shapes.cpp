// The solids of requests.

#include "brep/shapes.hpp"

#include "brep/booleans.hpp"
#include "brep/flatten.hpp"

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBuilderAPI_GTransform.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepLib.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepTools_WireExplorer.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <BinTools.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_Circle.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Line.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Precision.hxx>
#include <Standard_Failure.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <cmath>
#include <gp_GTrsf.hxx>
#include <gp_Pln.hxx>
#include <sstream>

namespace brep {

// Solids nest at most this deep.
static const int MOST_NESTED = 4000;

// Where the coordinates of curves lie: a plane, or space.
struct Space {
  bool planar;
  gp_Pnt origin;
  gp_Dir x, y;

  gp_Pnt point(Reader &in) const {
    if (!planar) return in.point();
    const double a = in.f64(), b = in.f64();
    return gp_Pnt(origin.XYZ() + x.XYZ() * a + y.XYZ() * b);
  }
  gp_Dir direction(Reader &in) const {
    gp_XYZ value;
    if (planar) {
      const double a = in.f64(), b = in.f64();
      value = x.XYZ() * a + y.XYZ() * b;
    } else {
      value = in.point().XYZ();
    }
    if (value.Modulus() < 1e-12) throw Failure{CAG_BREP_FAIL_INPUT, "a direction has no length"};
    return gp_Dir(value);
  }
};

static const Space IN_SPACE = {false, gp_Pnt(), gp_Dir(1, 0, 0), gp_Dir(0, 1, 0)};

static gp_Ax3 read_frame(Reader &in) {
  const gp_Pnt origin = in.point();
  const gp_Dir x = IN_SPACE.direction(in);
  IN_SPACE.direction(in);
  const gp_Dir z = IN_SPACE.direction(in);
  return gp_Ax3(origin, z, x);
}

// ---- curves ----

// Knots as the kernel wants them: distinct ones, with multiplicities.
struct Knots {
  TColStd_Array1OfReal values;
  TColStd_Array1OfInteger counts;
};

static Knots read_knots(Reader &in, size_t n, size_t degree) {
  if (degree < 1 || degree > 25 || n <= degree)
    throw Failure{CAG_BREP_FAIL_INPUT, "a spline has degree " + std::to_string(degree) + " and " +
                                           std::to_string(n) + " points"};
  std::vector<double> values;
  std::vector<int> counts;
  for (size_t i = 0; i < n + degree + 1; ++i) {
    const double knot = in.f64();
    if (!values.empty() && knot < values.back())
      throw Failure{CAG_BREP_FAIL_INPUT, "the knots of a spline decrease"};
    if (!values.empty() && knot - values.back() <= 1e-14 * std::abs(values.back())) {
      ++counts.back();
    } else {
      values.push_back(knot);
      counts.push_back(1);
    }
  }
  const int size = static_cast<int>(values.size()), most = static_cast<int>(degree);
  if (size < 2 || counts.front() != most + 1 || counts.back() != most + 1)
    throw Failure{CAG_BREP_FAIL_INPUT, "a spline is not clamped"};
  for (int i = 1; i + 1 < size; ++i)
    if (counts[i] > most) throw Failure{CAG_BREP_FAIL_INPUT, "a spline is not continuous"};
  Knots knots = {TColStd_Array1OfReal(1, size), TColStd_Array1OfInteger(1, size)};
  for (int i = 0; i < size; ++i) {
    knots.values(i + 1) = values[i];
    knots.counts(i + 1) = counts[i];
  }
  return knots;
}

static double read_weight(Reader &in) {
  const double weight = in.f64();
  if (weight <= 0) throw Failure{CAG_BREP_FAIL_INPUT, "a weight of a spline is not positive"};
  return weight;
}

static Ref<Geom_BSplineCurve> read_spline(Reader &in, const Space &space) {
  const uint32_t degree = in.u32();
  const bool rational = in.u32() != 0;
  const uint32_t n = in.count(8 * (2 + !space.planar + rational));
  if (!n) throw Failure{CAG_BREP_FAIL_INPUT, "a spline has no points"};
  TColgp_Array1OfPnt points(1, static_cast<int>(n));
  TColStd_Array1OfReal weights(1, static_cast<int>(n));
  for (int i = 1; i <= points.Length(); ++i) {
    points(i) = space.point(in);
    weights(i) = rational ? read_weight(in) : 1;
  }
  const Knots knots = read_knots(in, n, degree);
  if (rational)
    return new Geom_BSplineCurve(points, weights, knots.values, knots.counts,
                                 static_cast<int>(degree));
  return new Geom_BSplineCurve(points, knots.values, knots.counts, static_cast<int>(degree));
}

// A part of a curve, in the direction of the loop: from first to last, which may be less.
struct Arc {
  Arc(const Ref<Geom_Curve> &c, double f, double l) : curve(c), first(f), last(l) {}

  Ref<Geom_Curve> curve;
  double first, last;
};

// A spline of degree 1 as lines, others between the knots where the tangent may break: faces that
// are swept along such knots would have folds, which the kernel does not support.
static void split_spline(const Ref<Geom_BSplineCurve> &spline, double first, double last,
                         std::vector<Arc> &arcs) {
  const bool reversed = last < first;
  const double low = std::max(std::min(first, last), spline->FirstParameter());
  const double high = std::min(std::max(first, last), spline->LastParameter());
  const double gap = 1e-12 * (spline->LastParameter() - spline->FirstParameter());
  std::vector<double> cuts = {low};
  for (int i = spline->FirstUKnotIndex() + 1; i < spline->LastUKnotIndex(); ++i) {
    const double knot = spline->Knot(i);
    if (spline->Multiplicity(i) >= spline->Degree() && knot > low + gap && knot < high - gap)
      cuts.push_back(knot);
  }
  cuts.push_back(high);
  std::vector<Arc> parts;
  for (size_t i = 0; i + 1 < cuts.size(); ++i) {
    if (spline->Degree() == 1) {
      const gp_Pnt from = spline->Value(cuts[i]), to = spline->Value(cuts[i + 1]);
      const double length = from.Distance(to);
      if (length <= Precision::Confusion()) continue;
      parts.emplace_back(new Geom_Line(from, gp_Vec(from, to)), 0, length);
    } else if (cuts.size() == 2) {
      parts.emplace_back(spline, low, high);
    } else {
      const Ref<Geom_BSplineCurve> part = Ref<Geom_BSplineCurve>::DownCast(spline->Copy());
      part->Segment(cuts[i], cuts[i + 1]);
      parts.emplace_back(part, part->FirstParameter(), part->LastParameter());
    }
  }
  if (!reversed) arcs.insert(arcs.end(), parts.begin(), parts.end());
  else
    for (size_t i = parts.size(); i-- > 0;)
      arcs.emplace_back(parts[i].curve, parts[i].last, parts[i].first);
}

static double read_radius(Reader &in) {
  const double radius = in.f64();
  if (radius <= 0) throw Failure{CAG_BREP_FAIL_INPUT, "a radius is not positive"};
  return radius;
}

static bool is_whole_turn(const Ref<Geom_Curve> &curve, double first, double last) {
  return curve->IsPeriodic() && Ref<Geom_BSplineCurve>::DownCast(curve).IsNull() &&
         std::abs(std::abs(last - first) - 2 * M_PI) <= 1e-12;
}

static void read_arcs(Reader &in, const Space &space, std::vector<Arc> &arcs) {
  const uint32_t kind = in.u32();
  Ref<Geom_Curve> curve;
  double shift = 0;
  switch (kind) {
  case CAG_BREP_LINE: {
    const gp_Pnt origin = space.point(in);
    curve = new Geom_Line(origin, space.direction(in));
    break;
  }
  case CAG_BREP_CIRCLE:
  case CAG_BREP_ELLIPSE: {
    const gp_Pnt center = space.point(in);
    gp_Dir x = space.direction(in), y = space.direction(in);
    if (std::abs(x.Dot(y)) > 1e-6)
      throw Failure{CAG_BREP_FAIL_INPUT, "the axes of a circle or ellipse are not perpendicular"};
    double a = read_radius(in), b = kind == CAG_BREP_CIRCLE ? a : read_radius(in);
    if (kind == CAG_BREP_CIRCLE) {
      curve = new Geom_Circle(gp_Ax2(center, x.Crossed(y), x), a);
      break;
    }
    if (a < b) {
      // The kernel wants the longer axis first: b cos(t - 90 deg) y + a sin(t - 90 deg) (-x).
      const gp_Dir shorter = x.Reversed();
      x = y;
      y = shorter;
      std::swap(a, b);
      shift = -M_PI / 2;
    }
    curve = new Geom_Ellipse(gp_Ax2(center, x.Crossed(y), x), a, b);
    break;
  }
  case CAG_BREP_SPLINE_CURVE: curve = read_spline(in, space); break;
  default: throw Failure{CAG_BREP_FAIL_INPUT, "unknown kind of curve " + std::to_string(kind)};
  }
  double first = in.f64() + shift, last = in.f64() + shift;
  if (!(std::abs(last - first) > 1e-15))
    throw Failure{CAG_BREP_FAIL_INPUT, "a curve has no length"};
  if (is_whole_turn(curve, first, last)) {
    // The kernel cuts surfaces along whole ellipses wrongly if their seams are elsewhere.
    last = last > first ? 2 * M_PI : -2 * M_PI;
    first = 0;
  }
  const Ref<Geom_BSplineCurve> spline = Ref<Geom_BSplineCurve>::DownCast(curve);
  if (spline.IsNull()) arcs.emplace_back(curve, first, last);
  else split_spline(spline, first, last, arcs);
}

static TopoDS_Vertex make_corner(const gp_Pnt &point, double tolerance) {
  TopoDS_Vertex corner;
  BRep_Builder().MakeVertex(corner, point, std::max(tolerance, Precision::Confusion()));
  return corner;
}

static TopoDS_Edge make_edge(const Arc &arc, const TopoDS_Vertex &start, const TopoDS_Vertex &end) {
  const bool reversed = arc.last < arc.first;
  BRep_Builder builder;
  TopoDS_Edge edge;
  builder.MakeEdge(edge, arc.curve, Precision::Confusion());
  builder.Add(edge, (reversed ? end : start).Oriented(TopAbs_FORWARD));
  builder.Add(edge, (reversed ? start : end).Oriented(TopAbs_REVERSED));
  builder.Range(edge, std::min(arc.first, arc.last), std::max(arc.first, arc.last));
  if (reversed) edge.Reverse();
  return edge;
}

// Ends that should meet may be this fraction of the size apart.
static const double LOOP_GAP = 1e-4;

static TopoDS_Wire make_loop(const std::vector<Arc> &arcs) {
  const size_t n = arcs.size();
  std::vector<TopoDS_Vertex> corners;
  double size = 0;
  for (const Arc &arc : arcs) {
    const gp_Pnt from = arc.curve->Value(arc.first);
    size = std::max({size, from.Distance(arc.curve->Value(arc.last)),
                     from.Distance(arc.curve->Value((arc.first + arc.last) / 2))});
  }
  for (size_t i = 0; i < n; ++i) {
    const Arc &before = arcs[(i + n - 1) % n];
    const gp_Pnt end = before.curve->Value(before.last),
                 start = arcs[i].curve->Value(arcs[i].first);
    const double gap = end.Distance(start);
    if (gap > LOOP_GAP * size)
      throw Failure{CAG_BREP_FAIL_INPUT,
                    "the curves of a loop do not join: a gap is " + std::to_string(gap)};
    corners.push_back(make_corner(gp_Pnt((end.XYZ() + start.XYZ()) / 2), gap));
  }
  BRep_Builder builder;
  TopoDS_Wire wire;
  builder.MakeWire(wire);
  for (size_t i = 0; i < n; ++i)
    builder.Add(wire, make_edge(arcs[i], corners[i], corners[(i + 1) % n]));
  wire.Closed(Standard_True);
  return wire;
}

// Twice the area that a loop encloses, as seen against the normal of the plane: by chords, which
// suffice for its sign.
static double loop_area(const std::vector<Arc> &arcs, const gp_Dir &normal) {
  const int chords = 64;
  gp_XYZ sum;
  const gp_XYZ origin = arcs[0].curve->Value(arcs[0].first).XYZ();
  for (const Arc &arc : arcs)
    for (int i = 0; i < chords; ++i) {
      const double step = (arc.last - arc.first) / chords;
      const gp_XYZ a = arc.curve->Value(arc.first + i * step).XYZ() - origin;
      sum += a.Crossed(arc.curve->Value(arc.first + (i + 1) * step).XYZ() - origin);
    }
  return sum.Dot(normal.XYZ());
}

// A face of a plane: the first loop counterclockwise, the others clockwise.
static TopoDS_Face read_region(Reader &in, const Space &space) {
  const gp_Dir normal = space.x.Crossed(space.y);
  const uint32_t loops = in.count(4);
  if (!loops) throw Failure{CAG_BREP_FAIL_INPUT, "a region has no loops"};
  BRepBuilderAPI_MakeFace maker(gp_Pln(gp_Ax3(space.origin, normal, space.x)));
  TopoDS_Face face = maker.Face();
  for (uint32_t i = 0; i < loops; ++i) {
    const uint32_t n = in.count(20);
    std::vector<Arc> arcs;
    for (uint32_t k = 0; k < n; ++k) read_arcs(in, space, arcs);
    if (arcs.empty()) throw Failure{CAG_BREP_FAIL_INPUT, "a loop has no curves"};
    TopoDS_Wire wire = make_loop(arcs);
    if ((loop_area(arcs, normal) > 0) != (i == 0)) wire.Reverse();
    BRep_Builder().Add(face, wire);
  }
  BRepLib::UpdateTolerances(face);
  return face;
}

std::vector<TopoDS_Edge> read_space_edges(Reader &in) {
  std::vector<Arc> arcs;
  read_arcs(in, IN_SPACE, arcs);
  std::vector<TopoDS_Edge> edges;
  for (const Arc &arc : arcs) {
    const gp_Pnt from = arc.curve->Value(arc.first), to = arc.curve->Value(arc.last);
    const TopoDS_Vertex start = make_corner(from, 0);
    const bool closed = from.Distance(to) <= Precision::Confusion();
    edges.push_back(make_edge(arc, start, closed ? start : make_corner(to, 0)));
  }
  return edges;
}

// ---- faces that close ----

static Ref<Geom_BSplineSurface> read_spline_surface(Reader &in) {
  const uint32_t p = in.u32(), q = in.u32();
  const bool rational = in.u32() != 0;
  const uint32_t nu = in.count(8), nv = in.count(8);
  if (!nu || !nv || nu > 1000000 || nv > 1000000 || p > 25 || q > 25)
    throw Failure{CAG_BREP_FAIL_INPUT,
                  "a surface has " + std::to_string(nu) + " x " + std::to_string(nv) + " points"};
  // The points are read before there is an array for them, so that a wrong count takes no memory.
  std::vector<gp_Pnt> points;
  std::vector<double> weights;
  for (size_t i = 0; i < static_cast<size_t>(nu) * nv; ++i) {
    points.push_back(in.point());
    weights.push_back(rational ? read_weight(in) : 1);
  }
  TColgp_Array2OfPnt net(1, static_cast<int>(nu), 1, static_cast<int>(nv));
  TColStd_Array2OfReal net_weights(1, static_cast<int>(nu), 1, static_cast<int>(nv));
  for (int i = 1; i <= static_cast<int>(nu); ++i)
    for (int j = 1; j <= static_cast<int>(nv); ++j) {
      const size_t k = static_cast<size_t>(i - 1) * nv + static_cast<size_t>(j - 1);
      net(i, j) = points[k];
      net_weights(i, j) = weights[k];
    }
  const Knots ku = read_knots(in, nu, p), kv = read_knots(in, nv, q);
  if (rational)
    return new Geom_BSplineSurface(net, net_weights, ku.values, kv.values, ku.counts, kv.counts,
                                   static_cast<int>(p), static_cast<int>(q));
  return new Geom_BSplineSurface(net, ku.values, kv.values, ku.counts, kv.counts,
                                 static_cast<int>(p), static_cast<int>(q));
}

// Where a spline surface may have folds, with both ends.
static std::vector<double> fold_knots(const Ref<Geom_BSplineSurface> &surface, bool along_u) {
  std::vector<double> knots;
  const int n = along_u ? surface->NbUKnots() : surface->NbVKnots();
  const int degree = along_u ? surface->UDegree() : surface->VDegree();
  for (int i = 1; i <= n; ++i) {
    const int count = along_u ? surface->UMultiplicity(i) : surface->VMultiplicity(i);
    if (i == 1 || i == n || count >= degree)
      knots.push_back(along_u ? surface->UKnot(i) : surface->VKnot(i));
  }
  return knots;
}

static void add_surface_faces(const Ref<Geom_BSplineSurface> &surface,
                              BRepBuilderAPI_Sewing &sewing) {
  const std::vector<double> us = fold_knots(surface, true), vs = fold_knots(surface, false);
  for (size_t i = 0; i + 1 < us.size(); ++i)
    for (size_t j = 0; j + 1 < vs.size(); ++j) {
      Ref<Geom_BSplineSurface> part = surface;
      if (us.size() + vs.size() > 4) {
        part = Ref<Geom_BSplineSurface>::DownCast(surface->Copy());
        part->Segment(us[i], us[i + 1], vs[j], vs[j + 1]);
      }
      BRepBuilderAPI_MakeFace face(part, Precision::Confusion());
      if (!face.IsDone()) throw Failure{CAG_BREP_FAIL_INPUT, "a surface has no face"};
      sewing.Add(face.Face());
    }
}

static Ref<Geom_Surface> read_round_surface(Reader &in, uint32_t kind) {
  const gp_Ax3 frame = read_frame(in);
  switch (kind) {
  case CAG_BREP_CYLINDRICAL: return new Geom_CylindricalSurface(frame, read_radius(in));
  case CAG_BREP_SPHERICAL: return new Geom_SphericalSurface(frame, read_radius(in));
  case CAG_BREP_CONICAL: {
    const double radius = in.f64(), angle = in.f64();
    if (radius < 0 || !(std::abs(angle) > 1e-9 && std::abs(angle) < M_PI / 2 - 1e-9))
      throw Failure{CAG_BREP_FAIL_INPUT, "a cone has no shape"};
    return new Geom_ConicalSurface(frame, angle, radius);
  }
  default: throw Failure{CAG_BREP_FAIL_INPUT, "unknown kind of surface " + std::to_string(kind)};
  }
}

// A rectangle of the parameters.
static TopoDS_Face read_round_face(Reader &in, uint32_t kind) {
  const Ref<Geom_Surface> surface = read_round_surface(in, kind);
  double bounds[4];
  for (double &bound : bounds) bound = in.f64();
  if (!(bounds[0] < bounds[1] && bounds[2] < bounds[3]))
    throw Failure{CAG_BREP_FAIL_INPUT, "a face has no area"};
  BRepBuilderAPI_MakeFace face(surface, bounds[0], bounds[1], bounds[2], bounds[3],
                               Precision::Confusion());
  if (!face.IsDone()) throw Failure{CAG_BREP_FAIL_INPUT, "a surface has no face"};
  return face.Face();
}

static void read_face(Reader &in, BRepBuilderAPI_Sewing &sewing) {
  const uint32_t form = in.u32();
  if (form == 1) {
    const gp_Ax3 frame = read_frame(in);
    sewing.Add(read_region(in, {true, frame.Location(), frame.XDirection(), frame.YDirection()}));
    return;
  }
  const uint32_t kind = in.u32();
  if (form == 2) sewing.Add(read_round_face(in, kind));
  else if (form == 0 && kind == CAG_BREP_SPLINE) add_surface_faces(read_spline_surface(in), sewing);
  else throw Failure{CAG_BREP_FAIL_INPUT, "unknown kind of face " + std::to_string(kind)};
}

static Solids read_faces(Reader &in) {
  const uint32_t n = in.count(8);
  BRepBuilderAPI_Sewing sewing;
  for (uint32_t i = 0; i < n; ++i) read_face(in, sewing);
  const double tolerance = in.f64();
  if (!n) return {};
  sewing.SetTolerance(std::max(tolerance, Precision::Confusion()));
  sewing.Perform();
  if (sewing.NbFreeEdges())
    throw Failure{CAG_BREP_FAIL_INPUT,
                  "the faces do not close: " + std::to_string(sewing.NbFreeEdges()) +
                      " edges have one face"};
  if (sewing.NbMultipleEdges())
    throw Failure{CAG_BREP_FAIL_INPUT,
                  std::to_string(sewing.NbMultipleEdges()) + " edges have more than two faces"};
  TopoDS_Shape sewed = sewing.SewedShape();
  if (!sewed.IsNull() && sewed.ShapeType() == TopAbs_FACE) {
    BRep_Builder builder;
    TopoDS_Shell shell;
    builder.MakeShell(shell);
    builder.Add(shell, sewed);
    shell.Closed(BRep_Tool::IsClosed(shell));
    sewed = shell;
  }
  if (sewed.IsNull()) throw Failure{CAG_BREP_FAIL_INPUT, "the faces do not close"};
  return unify(solids_of_shells(sewed));
}

// ---- bodies ----

// A body starts with this and a checksum of the rest, because the kernel does not survive bytes that
// it has not written.
static const char BODY_MAGIC[] = "cag-brep1";
static const size_t BODY_HEAD = sizeof BODY_MAGIC - 1 + 8;

// FNV-1a (Fowler, Noll, Vo).
static uint64_t checksum(const char *bytes, size_t size) {
  uint64_t hash = 0xcbf29ce484222325u;
  for (size_t i = 0; i < size; ++i)
    hash = (hash ^ static_cast<unsigned char>(bytes[i])) * 0x100000001b3u;
  return hash;
}

static std::string checksum_bytes(const char *bytes, size_t size) {
  const uint64_t sum = checksum(bytes, size);
  return std::string(reinterpret_cast<const char *>(&sum), sizeof sum);
}

std::string write_body(const TopoDS_Solid &solid) {
  std::ostringstream stream(std::ios::binary);
  BinTools::Write(solid, stream, Standard_False, Standard_False, BinTools_FormatVersion_CURRENT);
  const std::string shape = stream.str();
  return BODY_MAGIC + checksum_bytes(shape.data(), shape.size()) + shape;
}

TopoDS_Solid read_body_solid(Reader &in) {
  const std::string body = in.text();
  const size_t magic = sizeof BODY_MAGIC - 1;
  if (body.size() < BODY_HEAD || body.compare(0, magic, BODY_MAGIC) != 0)
    throw Failure{CAG_BREP_FAIL_INPUT, "the body is not one of cag-brep"};
  if (body.compare(magic, 8, checksum_bytes(body.data() + BODY_HEAD, body.size() - BODY_HEAD)) != 0)
    throw Failure{CAG_BREP_FAIL_INPUT, "the body is damaged"};
  std::istringstream stream(body.substr(BODY_HEAD), std::ios::binary);
  TopoDS_Shape shape;
  BinTools::Read(shape, stream);
  if (shape.IsNull() || shape.ShapeType() != TopAbs_SOLID)
    throw Failure{CAG_BREP_FAIL_INPUT, "the body is not a solid"};
  return TopoDS::Solid(shape);
}

// ---- primitives ----

static Solids make_box(Reader &in) {
  const gp_Pnt size = in.point();
  if (size.X() <= 0 || size.Y() <= 0 || size.Z() <= 0)
    throw Failure{CAG_BREP_FAIL_INPUT, "a box has no volume"};
  return solids_of(BRepPrimAPI_MakeBox(size.X(), size.Y(), size.Z()).Shape());
}

static Solids make_cylinder(Reader &in) {
  const double height = in.f64(), bottom = in.f64(), top = in.f64();
  if (height <= 0 || bottom < 0 || top < 0 || bottom + top <= 0)
    throw Failure{CAG_BREP_FAIL_INPUT, "a cylinder has no volume"};
  if (std::abs(bottom - top) <= 1e-12 * (bottom + top)) {
    // Parts have many equal cylinders, which need no integrals.
    const TopoDS_Solid solid = BRepPrimAPI_MakeCylinder(bottom, height).Solid();
    note_measures(solid, {M_PI * bottom * bottom * height, 2 * M_PI * bottom * (bottom + height),
                          gp_Pnt(0, 0, height / 2)});
    return solids_of(solid);
  }
  return solids_of(BRepPrimAPI_MakeCone(bottom, top, height).Shape());
}

static Solids make_torus(Reader &in) {
  const double major = read_radius(in), minor = read_radius(in);
  if (minor >= major) throw Failure{CAG_BREP_FAIL_INPUT, "a torus passes through itself"};
  return solids_of(BRepPrimAPI_MakeTorus(major, minor).Shape());
}

static Solids make_prism(Reader &in) {
  const TopoDS_Face face = read_region(in, {true, gp_Pnt(), gp_Dir(1, 0, 0), gp_Dir(0, 1, 0)});
  const gp_Vec along = in.vector();
  if (std::abs(along.Z()) <= 1e-12 * along.Magnitude())
    throw Failure{CAG_BREP_FAIL_INPUT, "a prism has no height"};
  return solids_of(BRepPrimAPI_MakePrism(face, along).Shape());
}

static Solids make_revolution(Reader &in) {
  const TopoDS_Face face = read_region(in, {true, gp_Pnt(), gp_Dir(1, 0, 0), gp_Dir(0, 0, 1)});
  const double from = in.f64(), to = in.f64(), angle = to - from;
  if (std::abs(angle) <= 1e-12) throw Failure{CAG_BREP_FAIL_INPUT, "a revolution has no angle"};
  const gp_Ax1 axis(gp_Pnt(), gp_Dir(0, 0, 1));
  TopoDS_Shape start = face;
  if (from != 0) {
    gp_Trsf turn;
    turn.SetRotation(axis, from);
    start = BRepBuilderAPI_Transform(face, turn, Standard_True).Shape();
  }
  if (std::abs(angle) >= 2 * M_PI - 1e-12)
    return solids_of(BRepPrimAPI_MakeRevol(start, axis).Shape());
  return solids_of(BRepPrimAPI_MakeRevol(start, axis, angle).Shape());
}

static Solids make_half_space(Reader &in) {
  const double size = read_radius(in);
  return solids_of(BRepPrimAPI_MakeBox(gp_Pnt(-size, -size, -size), gp_Pnt(size, size, 0)).Shape());
}

// ---- placement ----

struct Placement {
  double rows[3][4];
};

static Placement read_placement(Reader &in) {
  Placement placement;
  for (double(&row)[4] : placement.rows)
    for (double &value : row) value = in.f64();
  return placement;
}

static bool is_polyhedron(const TopoDS_Solid &solid) {
  for (TopExp_Explorer it(solid, TopAbs_FACE); it.More(); it.Next())
    if (BRepAdaptor_Surface(TopoDS::Face(it.Current())).GetType() != GeomAbs_Plane) return false;
  for (TopExp_Explorer it(solid, TopAbs_EDGE); it.More(); it.Next())
    if (BRepAdaptor_Curve(TopoDS::Edge(it.Current())).GetType() != GeomAbs_Line) return false;
  return true;
}

// The image of a polyhedron, by its corners: the kernel would make its faces splines.
static TopoDS_Shape transform_polyhedron(const TopoDS_Solid &solid, const gp_GTrsf &map) {
  const auto image = [&](const gp_Pnt &point) {
    gp_XYZ xyz = point.XYZ();
    map.Transforms(xyz);
    return gp_Pnt(xyz);
  };
  BRepBuilderAPI_Sewing sewing(1e-9 * diagonal_of(solid) *
                               std::cbrt(std::abs(map.VectorialPart().Determinant())));
  for (TopExp_Explorer face(solid, TopAbs_FACE); face.More(); face.Next()) {
    const gp_Ax3 frame = BRepAdaptor_Surface(TopoDS::Face(face.Current())).Plane().Position();
    gp_XYZ x = frame.XDirection().XYZ(), y = frame.YDirection().XYZ();
    const gp_Mat linear = map.VectorialPart();
    x.Multiply(linear);
    y.Multiply(linear);
    BRepBuilderAPI_MakeFace maker(gp_Pln(image(frame.Location()), gp_Dir(x.Crossed(y))));
    TopoDS_Face flat = maker.Face();
    const TopoDS_Face forward = TopoDS::Face(face.Current().Oriented(TopAbs_FORWARD));
    for (TopoDS_Iterator wire(forward); wire.More(); wire.Next()) {
      BRepBuilderAPI_MakePolygon polygon;
      for (BRepTools_WireExplorer it(TopoDS::Wire(wire.Value()), forward); it.More(); it.Next())
        polygon.Add(image(BRep_Tool::Pnt(it.CurrentVertex())));
      polygon.Close();
      BRep_Builder().Add(flat, polygon.Wire());
    }
    sewing.Add(flat.Oriented(face.Current().Orientation()));
  }
  sewing.Perform();
  return compound_of(solids_of_shells(sewing.SewedShape()));
}

static TopoDS_Shape transform_affine(const TopoDS_Solid &solid, const gp_GTrsf &map) {
  if (is_polyhedron(solid)) {
    try {
      const TopoDS_Shape shape = transform_polyhedron(solid, map);
      const Solids found = solids_of(shape);
      if (found.size() == 1 && are_valid(found)) return shape;
    } catch (const Failure &) {
    } catch (const Standard_Failure &) {}
  }
  const TopoDS_Shape image = BRepBuilderAPI_GTransform(solid, map, Standard_True).Shape();
  try {
    const TopoDS_Shape flat = flatten_faces(image);
    const Solids before = solids_of(image), after = solids_of(flat);
    if (are_valid(after) && after.size() == before.size() &&
        std::abs(volume_of(after) - volume_of(before)) <= 1e-9 * volume_of(before))
      return flat;
  } catch (const Standard_Failure &) {
    // The image has splines in place of planes.
  }
  return image;
}

static Solids place(const Solids &solids, const Placement &placement) {
  const double(&m)[3][4] = placement.rows;
  gp_Mat linear(m[0][0], m[0][1], m[0][2], m[1][0], m[1][1], m[1][2], m[2][0], m[2][1], m[2][2]);
  const gp_XYZ moved(m[0][3], m[1][3], m[2][3]);
  bool identity = moved.Modulus() == 0;
  for (int i = 1; i <= 3; ++i)
    for (int k = 1; k <= 3; ++k) identity = identity && linear.Value(i, k) == (i == k);
  if (identity || solids.empty()) return solids;

  const double determinant = linear.Determinant(), scale = std::cbrt(std::abs(determinant));
  double most = 0, skew = 0;
  for (int i = 1; i <= 3; ++i)
    for (int k = 1; k <= 3; ++k) {
      most = std::max(most, std::abs(linear.Value(i, k)));
      const double product = linear.Column(i).Dot(linear.Column(k));
      skew = std::max(skew, std::abs(product - (i == k ? scale * scale : 0)));
    }
  if (std::abs(determinant) <= 1e-12 * most * most * most)
    throw Failure{CAG_BREP_FAIL_INPUT, "a placement flattens the solid"};

  Solids placed;
  for (const TopoDS_Solid &solid : solids) {
    TopoDS_Shape shape;
    if (skew <= 1e-12 * scale * scale) {
      gp_Trsf map;
      map.SetValues(m[0][0], m[0][1], m[0][2], m[0][3], m[1][0], m[1][1], m[1][2], m[1][3], m[2][0],
                    m[2][1], m[2][2], m[2][3]);
      shape = BRepBuilderAPI_Transform(solid, map, Standard_True).Shape();
      note_image(solid, map, shape);
    } else {
      shape = transform_affine(solid, gp_GTrsf(linear, moved));
    }
    for (const TopoDS_Solid &part : solids_of(shape)) placed.push_back(part);
  }
  sort_solids(placed);
  return placed;
}

// ---- solids ----

static Solids read_nested(Reader &in, int depth);

static Solids read_operation(Reader &in, BOPAlgo_Operation operation, int depth) {
  const uint32_t n = in.count(100);
  std::vector<Solids> operands;
  for (uint32_t i = 0; i < n; ++i) operands.push_back(read_nested(in, depth + 1));
  return combine(operation, operands);
}

static Solids read_nested(Reader &in, int depth) {
  if (depth > MOST_NESTED) throw Failure{CAG_BREP_FAIL_INPUT, "solids are nested too deep"};
  const uint32_t kind = in.u32();
  Solids solids;
  switch (kind) {
  case CAG_BREP_BOX: solids = make_box(in); break;
  case CAG_BREP_SPHERE: solids = solids_of(BRepPrimAPI_MakeSphere(read_radius(in)).Shape()); break;
  case CAG_BREP_CYLINDER: solids = make_cylinder(in); break;
  case CAG_BREP_TORUS: solids = make_torus(in); break;
  case CAG_BREP_PRISM: solids = make_prism(in); break;
  case CAG_BREP_REVOLUTION: solids = make_revolution(in); break;
  case CAG_BREP_HALF_SPACE: solids = make_half_space(in); break;
  case CAG_BREP_FACES: solids = read_faces(in); break;
  case CAG_BREP_BODY: solids = {read_body_solid(in)}; break;
  case CAG_BREP_UNION: solids = read_operation(in, BOPAlgo_FUSE, depth); break;
  case CAG_BREP_DIFFERENCE: solids = read_operation(in, BOPAlgo_CUT, depth); break;
  case CAG_BREP_INTERSECTION: solids = read_operation(in, BOPAlgo_COMMON, depth); break;
  default: throw Failure{CAG_BREP_FAIL_INPUT, "unknown kind of solid " + std::to_string(kind)};
  }
  return place(solids, read_placement(in));
}

Solids read_solids(Reader &in) { return read_nested(in, 0); }

TopoDS_Solid read_solid(Reader &in) {
  const Solids solids = read_solids(in);
  if (solids.empty()) throw Failure{CAG_BREP_FAIL_EMPTY, "the solid is empty"};
  if (solids.size() > 1)
    throw Failure{CAG_BREP_FAIL_INPUT,
                  "expected one solid, found " + std::to_string(solids.size()) + " separate parts"};
  return solids[0];
}

} // namespace brep
