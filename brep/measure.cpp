// By Gauss's theorem, the volume and its moments are integrals over the faces. By Green's theorem in
// the parameters, the integral of f over a face is that of F dv along its loops, where F(u, v) is the
// integral of f(., v) from a constant to u. Both are computed by Gauss-Legendre quadrature: the inner
// one between the knots of the surface, the outer one by bisection of the traces until two halves
// agree with their whole.

#include "brep/measure.hpp"

#include "brep/handle.hpp"
#include "brep/solids.hpp"

#include <BRepBndLib.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Geom2dAdaptor_Curve.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <math.hxx>
#include <math_Vector.hxx>
#include <vector>

namespace brep {

// Points per piece. Pieces of circles are shorter than an eighth of a turn, so that the error of a
// piece is near rounding.
static const int ORDER = 10;
static const double LONGEST_PIECE = M_PI / 4;
// Two halves agree with their whole if they differ by less than this fraction of what the size of the
// shape allows.
static const double AGREEMENT = 1e-12;
static const int MOST_BISECTIONS = 12;

// The volume, its three moments, and the area.
typedef std::array<double, 5> Sums;

static void add_sums(Sums &sums, const Sums &other, double factor) {
  for (size_t i = 0; i < sums.size(); ++i) sums[i] += factor * other[i];
}

struct GaussRule {
  double nodes[ORDER], weights[ORDER]; // on -1..1

  GaussRule() {
    math_Vector points(1, ORDER), factors(1, ORDER);
    math::GaussPoints(ORDER, points);
    math::GaussWeights(ORDER, factors);
    for (int i = 0; i < ORDER; ++i) {
      nodes[i] = points(i + 1);
      weights[i] = factors(i + 1);
    }
  }
};

static const GaussRule &gauss_rule() {
  static const GaussRule rule;
  return rule;
}

class FaceMeasure {
public:
  FaceMeasure(const TopoDS_Face &face, const gp_XYZ &center, double size)
      : face(face), surface(BRep_Tool::Surface(face)), center(center) {
    const int n = surface.NbUIntervals(GeomAbs_CN);
    TColStd_Array1OfReal values(1, n + 1);
    surface.UIntervals(values, GeomAbs_CN);
    for (const double value : values)
      if (std::abs(value) < 1e50) breaks.push_back(value);
    const GeomAbs_SurfaceType type = surface.GetType();
    flat = type == GeomAbs_Plane;
    ruled = type == GeomAbs_Cylinder || type == GeomAbs_Cone;
    round = type == GeomAbs_Sphere || type == GeomAbs_Torus;
    angular = type == GeomAbs_Cylinder || type == GeomAbs_Cone || type == GeomAbs_Sphere ||
              type == GeomAbs_Torus || type == GeomAbs_SurfaceOfRevolution ||
              type == GeomAbs_OtherSurface || type == GeomAbs_SurfaceOfExtrusion ||
              type == GeomAbs_OffsetSurface;
    const double area = size * size, volume = area * size, moment = volume * size;
    scales = {volume, moment, moment, moment, area};
  }

  Sums integrate() {
    Sums sums = {};
    bool any = false;
    for (TopExp_Explorer it(face, TopAbs_EDGE); it.More(); it.Next()) {
      const TopoDS_Edge edge = TopoDS::Edge(it.Current());
      if (edge.Orientation() != TopAbs_FORWARD && edge.Orientation() != TopAbs_REVERSED) continue;
      double first, last;
      const Ref<Geom2d_Curve> trace = BRep_Tool::CurveOnSurface(edge, face, first, last);
      if (trace.IsNull() || !(first < last)) continue;
      const Geom2dAdaptor_Curve curve(trace, first, last);
      if (!any) start = curve.Value(first).X();
      any = true;
      const double sign = edge.Orientation() == TopAbs_REVERSED ? -1 : 1;
      const int n = curve.NbIntervals(GeomAbs_CN);
      TColStd_Array1OfReal values(1, n + 1);
      curve.Intervals(values, GeomAbs_CN);
      for (int i = 1; i <= n; ++i) {
        const double a = values(i), b = values(i + 1);
        if (b > a) add_sums(sums, along_trace(curve, a, b), sign);
      }
    }
    return sums;
  }

private:
  // The densities at a point of the surface.
  void add_point(Sums &sums, double u, double v, double weight) {
    gp_Pnt point;
    gp_Vec du, dv;
    surface.D1(u, v, point, du, dv);
    const gp_XYZ p = point.XYZ() - center, normal = du.XYZ().Crossed(dv.XYZ());
    sums[0] += weight * p.Dot(normal) / 3;
    sums[1] += weight * p.X() * p.X() * normal.X() / 2;
    sums[2] += weight * p.Y() * p.Y() * normal.Y() / 2;
    sums[3] += weight * p.Z() * p.Z() * normal.Z() / 2;
    sums[4] += weight * normal.Modulus();
  }

  void add_span(Sums &sums, double a, double b, double v) {
    const GaussRule &rule = gauss_rule();
    const int pieces =
        angular ? std::max(1, static_cast<int>(std::ceil(std::abs(b - a) / LONGEST_PIECE - 1e-9)))
                : 1;
    for (int i = 0; i < pieces; ++i) {
      const double low = a + (b - a) * i / pieces, high = a + (b - a) * (i + 1) / pieces;
      const double middle = (low + high) / 2, half = (high - low) / 2;
      for (int k = 0; k < ORDER; ++k)
        add_point(sums, middle + half * rule.nodes[k], v, half * rule.weights[k]);
    }
  }

  // F(u, v).
  Sums inner(double u, double v) {
    Sums sums = {};
    if (u == start) return sums;
    if (flat) {
      // Quadratic in u: two points are exact.
      const double middle = (start + u) / 2, half = (u - start) / 2, node = std::sqrt(1.0 / 3);
      add_point(sums, middle - half * node, v, half);
      add_point(sums, middle + half * node, v, half);
      return sums;
    }
    const double low = std::min(start, u), high = std::max(start, u);
    double at = low;
    for (const double value : breaks) {
      if (value <= at || value >= high) continue;
      add_span(sums, at, value, v);
      at = value;
    }
    add_span(sums, at, high, v);
    if (u < start)
      for (double &sum : sums) sum = -sum;
    return sums;
  }

  Sums piece(const Geom2dAdaptor_Curve &curve, double a, double b) {
    const GaussRule &rule = gauss_rule();
    Sums sums = {};
    const double middle = (a + b) / 2, half = (b - a) / 2;
    for (int k = 0; k < ORDER; ++k) {
      gp_Pnt2d point;
      gp_Vec2d derivative;
      curve.D1(middle + half * rule.nodes[k], point, derivative);
      const double weight = half * rule.weights[k] * derivative.Y();
      if (weight != 0) add_sums(sums, inner(point.X(), point.Y()), weight);
    }
    return sums;
  }

  // The angle by which the integrand turns along a trace, if it is a polynomial of low degree in
  // lengths, sines, and cosines; negative for others.
  double turn_along(const Geom2dAdaptor_Curve &curve, double a, double b) const {
    const GeomAbs_CurveType type = curve.GetType();
    if (flat && type == GeomAbs_Circle) return b - a;
    if (type != GeomAbs_Line || !(flat || ruled || round)) return -1;
    const gp_Dir2d way = curve.Line().Direction();
    return (flat ? 0 : std::abs(way.X()) + (round ? std::abs(way.Y()) : 0)) * (b - a);
  }

  Sums along_trace(const Geom2dAdaptor_Curve &curve, double a, double b) {
    const double turn = turn_along(curve, a, b);
    if (turn < 0) return along(curve, a, b, piece(curve, a, b), MOST_BISECTIONS);
    // Pieces that need no comparison with their halves. If v is constant, there is nothing to add.
    Sums sums = {};
    if (curve.GetType() == GeomAbs_Line && curve.Line().Direction().Y() == 0) return sums;
    const int pieces = std::max(1, static_cast<int>(std::ceil(turn / LONGEST_PIECE - 1e-9)));
    for (int i = 0; i < pieces; ++i)
      add_sums(sums, piece(curve, a + (b - a) * i / pieces, a + (b - a) * (i + 1) / pieces), 1);
    return sums;
  }

  Sums along(const Geom2dAdaptor_Curve &curve, double a, double b, const Sums &whole, int depth) {
    const double middle = (a + b) / 2;
    const Sums first = piece(curve, a, middle), second = piece(curve, middle, b);
    Sums halves = first;
    add_sums(halves, second, 1);
    bool equal = true;
    for (size_t i = 0; i < halves.size(); ++i)
      equal = equal && std::abs(halves[i] - whole[i]) <= AGREEMENT * scales[i];
    if (equal || depth == 0) return halves;
    halves = along(curve, a, middle, first, depth - 1);
    add_sums(halves, along(curve, middle, b, second, depth - 1), 1);
    return halves;
  }

  const TopoDS_Face face; // oriented forward
  GeomAdaptor_Surface surface;
  gp_XYZ center;
  std::vector<double> breaks; // of the surface in u
  bool flat, ruled, round, angular;
  double start = 0; // where inner integrals start
  Sums scales;
};

Measures measure(const TopoDS_Shape &shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box, Standard_False);
  if (box.IsVoid()) return {0, 0, gp_Pnt()};
  const gp_XYZ center = (box.CornerMin().XYZ() + box.CornerMax().XYZ()) / 2;
  const double size = std::sqrt(box.SquareExtent());
  Sums total = {};
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    const TopAbs_Orientation orientation = it.Current().Orientation();
    if (orientation != TopAbs_FORWARD && orientation != TopAbs_REVERSED) continue;
    Sums sums =
        FaceMeasure(TopoDS::Face(it.Current().Oriented(TopAbs_FORWARD)), center, size).integrate();
    if (orientation == TopAbs_REVERSED)
      for (size_t i = 0; i < 4; ++i) sums[i] = -sums[i];
    add_sums(total, sums, 1);
  }
  if (total[0] == 0) return {0, total[4], gp_Pnt(center)};
  return {total[0], total[4], gp_Pnt(center + gp_XYZ(total[1], total[2], total[3]) / total[0])};
}

} // namespace brep
