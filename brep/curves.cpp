#include "brep/curves.hpp"

#include <Geom2dAdaptor_Curve.hxx>
#include <Geom2dConvert.hxx>
#include <Geom2dConvert_ApproxCurve.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_BezierCurve.hxx>
#include <Geom2d_Circle.hxx>
#include <Geom2d_Ellipse.hxx>
#include <Geom2d_Line.hxx>
#include <Geom2d_Parabola.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <GeomConvert.hxx>
#include <GeomConvert_ApproxCurve.hxx>
#include <GeomConvert_ApproxSurface.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_Circle.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Line.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_Parabola.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <algorithm>
#include <cmath>

namespace brep {

// Approximations are closer than this fraction of the size of what they approximate, if possible.
static const double CURVE_ERROR = 1e-11;
static const double SURFACE_ERROR = 1e-7;
static const int MOST_DEGREE = 12;
static const int MOST_SPANS = 2000;

static void write_xyz(Writer &out, const gp_Pnt &point) { out.xyz(point.XYZ()); }
static void write_xyz(Writer &out, const gp_Dir &direction) { out.xyz(direction.XYZ()); }
static void write_xyz(Writer &out, const gp_Pnt2d &point) {
  out.f64(point.X());
  out.f64(point.Y());
}
static void write_xyz(Writer &out, const gp_Dir2d &direction) {
  out.f64(direction.X());
  out.f64(direction.Y());
}

// ---- curves in both dimensions ----

struct InSpace {
  typedef Geom_Curve Curve;
  typedef Geom_Line Line;
  typedef Geom_Circle Circle;
  typedef Geom_Ellipse Ellipse;
  typedef Geom_Parabola Parabola;
  typedef Geom_BSplineCurve Spline;
  typedef Geom_BezierCurve Bezier;
  typedef Geom_TrimmedCurve Trimmed;
  typedef GeomConvert_ApproxCurve Approximation;
  typedef gp_Pnt Point;

  static gp_Pnt origin(const Ref<Geom_Line> &line) { return line->Position().Location(); }
  static gp_Dir direction(const Ref<Geom_Line> &line) { return line->Position().Direction(); }
  template <typename Conic> static gp_Dir x(const Conic &conic) {
    return conic->Position().XDirection();
  }
  template <typename Conic> static gp_Dir y(const Conic &conic) {
    return conic->Position().YDirection();
  }
  static Ref<Spline> convert(const Ref<Curve> &curve) {
    return GeomConvert::CurveToBSplineCurve(curve);
  }
};

struct InParameters {
  typedef Geom2d_Curve Curve;
  typedef Geom2d_Line Line;
  typedef Geom2d_Circle Circle;
  typedef Geom2d_Ellipse Ellipse;
  typedef Geom2d_Parabola Parabola;
  typedef Geom2d_BSplineCurve Spline;
  typedef Geom2d_BezierCurve Bezier;
  typedef Geom2d_TrimmedCurve Trimmed;
  typedef Geom2dConvert_ApproxCurve Approximation;
  typedef gp_Pnt2d Point;

  static gp_Pnt2d origin(const Ref<Geom2d_Line> &line) { return line->Location(); }
  static gp_Dir2d direction(const Ref<Geom2d_Line> &line) { return line->Direction(); }
  template <typename Conic> static gp_Dir2d x(const Conic &conic) {
    return conic->Position().XDirection();
  }
  template <typename Conic> static gp_Dir2d y(const Conic &conic) {
    return conic->Position().YDirection();
  }
  static Ref<Spline> convert(const Ref<Curve> &curve) {
    return Geom2dConvert::CurveToBSplineCurve(curve);
  }
};

// The spline, no longer periodic, of a periodic one that covers a period from `first` on, with the
// same parameter.
template <typename Spline> static Ref<Spline> unroll(const Ref<Spline> &periodic, double first) {
  const Ref<Spline> spline = Ref<Spline>::DownCast(periodic->Copy());
  const double start = spline->FirstParameter(), period = spline->LastParameter() - start;
  const double near = 1e-10 * period;
  const double turns = std::floor((first - start) / period + 1e-10);
  // The knot where the spline is cut open.
  const double cut = std::max(first - turns * period, start);
  int origin = 0;
  for (int pass = 0; pass < 2 && !origin; ++pass) {
    for (int i = 1; i < spline->NbKnots(); ++i)
      if (std::abs(spline->Knot(i) - cut) <= near) origin = i;
    if (!origin) spline->InsertKnot(cut, 1, near / 10);
  }
  if (origin > 1) spline->SetOrigin(origin);
  spline->SetNotPeriodic();
  const double shift = cut + turns * period - spline->FirstParameter();
  TColStd_Array1OfReal knots(1, spline->NbKnots());
  spline->Knots(knots);
  for (double &knot : knots) knot += shift;
  spline->SetKnots(knots);
  return spline;
}

template <typename Spline> static Ref<Spline> clamp(const Ref<Spline> &given, double first) {
  Ref<Spline> spline = given;
  if (spline->IsPeriodic()) spline = unroll<Spline>(spline, first);
  const int degree = spline->Degree();
  if (spline->Multiplicity(1) == degree + 1 &&
      spline->Multiplicity(spline->NbKnots()) == degree + 1)
    return spline;
  spline = Ref<Spline>::DownCast(spline->Copy());
  spline->Segment(spline->FirstParameter(), spline->LastParameter());
  return spline;
}

template <typename Spline> static void write_knots(Writer &out, const Ref<Spline> &spline) {
  for (int i = 1; i <= spline->NbKnots(); ++i)
    for (int k = 0; k < spline->Multiplicity(i); ++k) out.f64(spline->Knot(i));
}

template <typename Spline> static void write_spline(Writer &out, const Ref<Spline> &spline) {
  const bool rational = spline->IsRational();
  out.u32(CAG_BREP_SPLINE_CURVE);
  out.u32(static_cast<uint32_t>(spline->Degree()));
  out.u32(rational);
  out.u32(static_cast<uint32_t>(spline->NbPoles()));
  for (int i = 1; i <= spline->NbPoles(); ++i) {
    write_xyz(out, spline->Pole(i));
    if (rational) out.f64(spline->Weight(i));
  }
  write_knots(out, spline);
}

// The size of the part of a curve, for tolerances.
template <typename Kind>
static double part_size(const Ref<typename Kind::Curve> &curve, double first, double last) {
  const typename Kind::Point start = curve->Value(first);
  double size = 0;
  for (int i = 1; i <= 8; ++i)
    size = std::max(size, start.Distance(curve->Value(first + (last - first) * i / 8)));
  return size;
}

template <typename Kind>
static double write_any(Writer &out, Ref<typename Kind::Curve> curve, double first, double last,
                        double tolerance) {
  while (const auto trimmed = Ref<typename Kind::Trimmed>::DownCast(curve))
    curve = trimmed->BasisCurve();
  if (const auto line = Ref<typename Kind::Line>::DownCast(curve)) {
    out.u32(CAG_BREP_LINE);
    write_xyz(out, Kind::origin(line));
    write_xyz(out, Kind::direction(line));
    return 0;
  }
  if (const auto circle = Ref<typename Kind::Circle>::DownCast(curve)) {
    out.u32(CAG_BREP_CIRCLE);
    write_xyz(out, circle->Location());
    write_xyz(out, Kind::x(circle));
    write_xyz(out, Kind::y(circle));
    out.f64(circle->Radius());
    return 0;
  }
  if (const auto ellipse = Ref<typename Kind::Ellipse>::DownCast(curve)) {
    out.u32(CAG_BREP_ELLIPSE);
    write_xyz(out, ellipse->Location());
    write_xyz(out, Kind::x(ellipse));
    write_xyz(out, Kind::y(ellipse));
    out.f64(ellipse->MajorRadius());
    out.f64(ellipse->MinorRadius());
    return 0;
  }
  if (const auto spline = Ref<typename Kind::Spline>::DownCast(curve)) {
    write_spline(out, clamp<typename Kind::Spline>(spline, first));
    return 0;
  }
  const auto bezier = Ref<typename Kind::Bezier>::DownCast(curve);
  if (bezier || Ref<typename Kind::Parabola>::DownCast(curve)) {
    const Ref<typename Kind::Curve> part =
        bezier ? curve : new typename Kind::Trimmed(curve, first, last);
    write_spline(out, Kind::convert(part));
    return 0;
  }
  // Exact splines of others, such as hyperbolas, would have other parameters.
  const Ref<typename Kind::Curve> part = new typename Kind::Trimmed(curve, first, last);
  const double least = std::max(CURVE_ERROR * part_size<Kind>(curve, first, last), 1e-13);
  for (double error = std::min(least, tolerance); error <= tolerance * 10 || error <= least;
       error *= 10) {
    typename Kind::Approximation fit(part, error, GeomAbs_C1, MOST_SPANS, MOST_DEGREE);
    if (!fit.HasResult() || (!fit.IsDone() && error * 10 <= tolerance)) continue;
    write_spline(out, fit.Curve());
    return fit.MaxError();
  }
  throw Failure{CAG_BREP_FAIL_METHOD, "a curve cannot be written as a spline"};
}

double write_curve(Writer &out, const Ref<Geom_Curve> &curve, double first, double last,
                   double tolerance) {
  return write_any<InSpace>(out, curve, first, last, tolerance);
}

void write_trace(Writer &out, const Ref<Geom2d_Curve> &trace, double first, double last,
                 const WrittenSurface &on) {
  Ref<Geom2d_Curve> written = trace;
  if (on.mirrored || on.shift != 0) {
    gp_Trsf2d map;
    if (on.mirrored) map.SetMirror(gp_Ax2d(gp_Pnt2d(), gp_Dir2d(0, 1)));
    map.SetTranslationPart(gp_Vec2d(0, on.shift));
    written = Ref<Geom2d_Curve>::DownCast(trace->Transformed(map));
  }
  write_any<InParameters>(out, written, first, last, 1e-9);
}

// ---- surfaces ----

// As `unroll`, of a surface in u.
static Ref<Geom_BSplineSurface> unroll_u(const Ref<Geom_BSplineSurface> &periodic, double first) {
  const Ref<Geom_BSplineSurface> surface = Ref<Geom_BSplineSurface>::DownCast(periodic->Copy());
  double u0, u1, v0, v1;
  surface->Bounds(u0, u1, v0, v1);
  const double period = u1 - u0, near = 1e-10 * period;
  const double turns = std::floor((first - u0) / period + 1e-10);
  const double cut = std::max(first - turns * period, u0);
  int origin = 0;
  for (int pass = 0; pass < 2 && !origin; ++pass) {
    for (int i = 1; i < surface->NbUKnots(); ++i)
      if (std::abs(surface->UKnot(i) - cut) <= near) origin = i;
    if (!origin) surface->InsertUKnot(cut, 1, near / 10, Standard_False);
  }
  if (origin > 1) surface->SetUOrigin(origin);
  surface->SetUNotPeriodic();
  const double moved = cut + turns * period;
  surface->Bounds(u0, u1, v0, v1);
  TColStd_Array1OfReal knots(1, surface->NbUKnots());
  surface->UKnots(knots);
  for (double &knot : knots) knot += moved - u0;
  surface->SetUKnots(knots);
  return surface;
}

static Ref<Geom_BSplineSurface> clamp_surface(const Ref<Geom_BSplineSurface> &given,
                                              const Bounds &bounds) {
  Ref<Geom_BSplineSurface> surface = given;
  if (surface->IsUPeriodic()) surface = unroll_u(surface, bounds.u0);
  if (surface->IsVPeriodic()) {
    surface = Ref<Geom_BSplineSurface>::DownCast(surface->Copy());
    surface->ExchangeUV();
    surface = unroll_u(surface, bounds.v0);
    surface->ExchangeUV();
  }
  const int p = surface->UDegree(), q = surface->VDegree();
  if (surface->UMultiplicity(1) == p + 1 && surface->UMultiplicity(surface->NbUKnots()) == p + 1 &&
      surface->VMultiplicity(1) == q + 1 && surface->VMultiplicity(surface->NbVKnots()) == q + 1)
    return surface;
  surface = Ref<Geom_BSplineSurface>::DownCast(surface->Copy());
  double u0, u1, v0, v1;
  surface->Bounds(u0, u1, v0, v1);
  surface->Segment(u0, u1, v0, v1);
  return surface;
}

static void write_spline_surface(Writer &out, const Ref<Geom_BSplineSurface> &surface) {
  const bool rational = surface->IsURational() || surface->IsVRational();
  out.u32(CAG_BREP_SPLINE);
  out.u32(static_cast<uint32_t>(surface->UDegree()));
  out.u32(static_cast<uint32_t>(surface->VDegree()));
  out.u32(rational);
  out.u32(static_cast<uint32_t>(surface->NbUPoles()));
  out.u32(static_cast<uint32_t>(surface->NbVPoles()));
  for (int i = 1; i <= surface->NbUPoles(); ++i)
    for (int k = 1; k <= surface->NbVPoles(); ++k) {
      out.xyz(surface->Pole(i, k).XYZ());
      if (rational) out.f64(surface->Weight(i, k));
    }
  for (int i = 1; i <= surface->NbUKnots(); ++i)
    for (int k = 0; k < surface->UMultiplicity(i); ++k) out.f64(surface->UKnot(i));
  for (int i = 1; i <= surface->NbVKnots(); ++i)
    for (int k = 0; k < surface->VMultiplicity(i); ++k) out.f64(surface->VKnot(i));
}

// Writes the kind and a right-handed frame. Returns whether u must be mirrored: of a left-handed
// frame, y is turned round.
static bool write_frame(Writer &out, uint32_t kind, const gp_Ax3 &frame) {
  const bool mirrored = !frame.Direct();
  const gp_XYZ x = frame.XDirection().XYZ(), z = frame.Direction().XYZ();
  out.u32(kind);
  out.xyz(frame.Location().XYZ());
  out.xyz(x);
  out.xyz(z.Crossed(x));
  out.xyz(z);
  return mirrored;
}

static WrittenSurface approximate_surface(Writer &out, const Ref<Geom_Surface> &surface,
                                          const Bounds &bounds, double tolerance) {
  double s0, s1, t0, t1;
  surface->Bounds(s0, s1, t0, t1);
  const double u0 = surface->IsUPeriodic() ? bounds.u0 : std::max(bounds.u0, s0);
  const double u1 = surface->IsUPeriodic() ? bounds.u1 : std::min(bounds.u1, s1);
  const double v0 = surface->IsVPeriodic() ? bounds.v0 : std::max(bounds.v0, t0);
  const double v1 = surface->IsVPeriodic() ? bounds.v1 : std::min(bounds.v1, t1);
  const Ref<Geom_Surface> part = new Geom_RectangularTrimmedSurface(surface, u0, u1, v0, v1);
  const double size = part->Value(u0, v0).Distance(part->Value(u1, v1)) +
                      part->Value(u0, v1).Distance(part->Value(u1, v0));
  for (double error = SURFACE_ERROR * std::max(size, 1e-3); error <= 1e-3 * size; error *= 10) {
    GeomConvert_ApproxSurface fit(part, error, GeomAbs_C1, GeomAbs_C1, 10, 10, 60, 0);
    if (!fit.HasResult() || (!fit.IsDone() && error < tolerance)) continue;
    write_spline_surface(out, fit.Surface());
    return {false, fit.MaxError()};
  }
  throw Failure{CAG_BREP_FAIL_METHOD, "a surface cannot be written as a spline"};
}

// The curve of a revolution or an extrusion, over the bounds of the face.
static double write_profile(Writer &out, const Ref<Geom_Curve> &curve, double first, double last,
                            double tolerance) {
  if (!curve->IsPeriodic()) {
    first = std::max(first, curve->FirstParameter());
    last = std::min(last, curve->LastParameter());
  }
  const double error = write_any<InSpace>(out, curve, first, last, tolerance);
  out.f64(first);
  out.f64(last);
  return error;
}

// The frame turned by half a turn about its z axis, so that radii change their signs.
static gp_Ax3 turned_frame(gp_Ax3 frame) {
  frame.XReverse();
  frame.YReverse();
  return frame;
}

// Radii are positive. On the far side of the apex, where those of the given cone are negative, v is
// measured from the middle of the face.
static WrittenSurface write_cone(Writer &out, const Ref<Geom_ConicalSurface> &cone,
                                 const Bounds &bounds) {
  gp_Ax3 frame = cone->Position();
  double radius = cone->RefRadius(), angle = cone->SemiAngle();
  const double middle = (bounds.v0 + bounds.v1) / 2, at_middle = radius + middle * std::sin(angle);
  const bool far = at_middle < 0;
  if (far) {
    frame = turned_frame(frame);
    frame.SetLocation(
        frame.Location().Translated(gp_Vec(frame.Direction()) * middle * std::cos(angle)));
    radius = -at_middle;
    angle = -angle;
  }
  const bool mirrored = write_frame(out, CAG_BREP_CONICAL, frame);
  out.f64(radius);
  out.f64(angle);
  return {mirrored, 0, far ? -middle : 0};
}

// The part of a torus within itself, where distances from the axis are negative, is a revolved arc.
static WrittenSurface write_torus(Writer &out, const Ref<Geom_ToroidalSurface> &torus,
                                  const Bounds &bounds, double tolerance) {
  const gp_Ax3 frame = torus->Position();
  const double major = torus->MajorRadius(), minor = torus->MinorRadius();
  if (major + minor * std::cos((bounds.v0 + bounds.v1) / 2) >= 0) {
    const bool mirrored = write_frame(out, CAG_BREP_TOROIDAL, frame);
    out.f64(major);
    out.f64(minor);
    return {mirrored, 0};
  }
  const gp_Dir x = frame.XDirection(), z = frame.Direction();
  const Ref<Geom_Curve> arc = new Geom_Circle(
      gp_Ax2(frame.Location().Translated(gp_Vec(x) * major), x.Crossed(z), x), minor);
  out.u32(CAG_BREP_REVOLVED);
  out.xyz(frame.Location().XYZ());
  out.xyz(x.Crossed(frame.YDirection()).XYZ());
  return {false, write_profile(out, arc, bounds.v0, bounds.v1, tolerance)};
}

WrittenSurface write_surface(Writer &out, const Ref<Geom_Surface> &given, const Bounds &bounds,
                             double tolerance) {
  Ref<Geom_Surface> surface = given;
  while (const auto trimmed = Ref<Geom_RectangularTrimmedSurface>::DownCast(surface))
    surface = trimmed->BasisSurface();
  if (const auto offset = Ref<Geom_OffsetSurface>::DownCast(surface)) {
    const Ref<Geom_Surface> equal = offset->Surface();
    if (!equal.IsNull()) surface = equal;
  }
  if (const auto plane = Ref<Geom_Plane>::DownCast(surface)) {
    const gp_Ax3 frame = plane->Position();
    out.u32(CAG_BREP_PLANE);
    out.xyz(frame.Location().XYZ());
    out.xyz(frame.XDirection().XYZ());
    out.xyz(frame.YDirection().XYZ());
    out.xyz(frame.XDirection().XYZ().Crossed(frame.YDirection().XYZ()));
    return {false, 0};
  }
  if (const auto cylinder = Ref<Geom_CylindricalSurface>::DownCast(surface)) {
    const bool mirrored = write_frame(out, CAG_BREP_CYLINDRICAL, cylinder->Position());
    out.f64(cylinder->Radius());
    return {mirrored, 0};
  }
  if (const auto cone = Ref<Geom_ConicalSurface>::DownCast(surface))
    return write_cone(out, cone, bounds);
  if (const auto sphere = Ref<Geom_SphericalSurface>::DownCast(surface)) {
    const bool mirrored = write_frame(out, CAG_BREP_SPHERICAL, sphere->Position());
    out.f64(sphere->Radius());
    return {mirrored, 0};
  }
  if (const auto torus = Ref<Geom_ToroidalSurface>::DownCast(surface))
    return write_torus(out, torus, bounds, tolerance);
  if (const auto spline = Ref<Geom_BSplineSurface>::DownCast(surface)) {
    write_spline_surface(out, clamp_surface(spline, bounds));
    return {false, 0};
  }
  if (!Ref<Geom_BezierSurface>::DownCast(surface).IsNull()) {
    write_spline_surface(out, GeomConvert::SurfaceToBSplineSurface(surface));
    return {false, 0};
  }
  if (const auto revolved = Ref<Geom_SurfaceOfRevolution>::DownCast(surface)) {
    out.u32(CAG_BREP_REVOLVED);
    out.xyz(revolved->Axis().Location().XYZ());
    out.xyz(revolved->Axis().Direction().XYZ());
    return {false, write_profile(out, revolved->BasisCurve(), bounds.v0, bounds.v1, tolerance)};
  }
  if (const auto extruded = Ref<Geom_SurfaceOfLinearExtrusion>::DownCast(surface)) {
    out.u32(CAG_BREP_EXTRUDED);
    out.xyz(extruded->Direction().XYZ());
    return {false, write_profile(out, extruded->BasisCurve(), bounds.u0, bounds.u1, tolerance)};
  }
  return approximate_surface(out, surface, bounds, tolerance);
}

} // namespace brep
