// Fillets and chamfers: blends of edges.
//
// The kernel continues a blend along tangent edges: these chains are its contours. If a blend fails,
// other forms of its surfaces are tried, then the solid with merged faces, then the contours one after
// the other. If nothing helps, contours are tried alone to find the one that fails, and its largest
// radius is found by bisection.

#include "brep/attempt.hpp"
#include "brep/boundary.hpp"
#include "brep/operations.hpp"
#include "brep/shapes.hpp"
#include "brep/sides.hpp"

#include <BRepFilletAPI_MakeChamfer.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRep_Tool.hxx>
#include <ChFi3d_FilletShape.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <chrono>
#include <cmath>

namespace brep {

// Edges whose faces meet at a smaller angle (radians) are smooth: there is nothing to blend.
static const double SMOOTH_ANGLE = 1e-4;
// Seconds for finding the edge and the radius that fail, and steps of the bisection.
static const double SEARCH_SECONDS = 5;
// Seconds for all other ways after the first one has failed.
static const double RETRY_SECONDS = 10;
static const int SEARCH_STEPS = 12;

// The blend of an edge.
struct Blend {
  uint32_t index; // in the boundary of the request
  TopoDS_Edge edge;
  TopoDS_Face face; // of a chamfer, which has the first distance
  double first, last;

  double size() const { return std::max(first, last); }
};

typedef std::vector<Blend> Blends;

struct Blending {
  bool chamfer;
  ChFi3d_FilletShape form;
};

// The area that a blend may change per length of its edge, at most.
static double section_bound(const Sides &sides, const Blend &blend, bool chamfer) {
  if (chamfer) return blend.first * blend.last;
  const std::vector<TopoDS_Face> faces = sides.faces(blend.edge);
  double spread = 1;
  if (faces.size() == 2) {
    const gp_Vec a = normal_beside(faces[0], blend.edge), b = normal_beside(faces[1], blend.edge);
    if (a.Magnitude() > 0 && b.Magnitude() > 0)
      spread = std::max(spread, std::tan(std::min(a.Angle(b), 3.1) / 2));
  }
  return blend.size() * blend.size() * spread;
}

// Fails unless the result is one valid solid whose volume is plausible.
static Solids check_blend(const TopoDS_Shape &shape, const TopoDS_Solid &before, double bound) {
  const Solids solids = solids_of(shape);
  if (solids.size() != 1)
    throw Failure{CAG_BREP_FAIL_CHECK, std::to_string(solids.size()) + " solids are left"};
  const std::string faults = faults_of(solids[0]);
  if (!faults.empty()) throw Failure{CAG_BREP_FAIL_CHECK, faults};
  const double old = volume_of(before), change = std::abs(volume_of(solids[0]) - old);
  // Rounding of volumes, and fillets that are longer than their edges.
  if (change > 1.5 * bound + 1e-9 * old)
    throw Failure{CAG_BREP_FAIL_CHECK, "the volume changes too much"};
  return solids;
}

// The radius changes evenly along an edge, by its own direction.
static void add_fillet(BRepFilletAPI_MakeFillet &maker, const Blend &blend) {
  if (blend.first == blend.last) {
    maker.Add(blend.first, blend.edge);
    return;
  }
  maker.Add(blend.edge);
  const int contour = maker.Contour(blend.edge);
  if (!contour) return;
  TopoDS_Vertex start, end;
  TopExp::Vertices(TopoDS::Edge(blend.edge.Oriented(TopAbs_FORWARD)), start, end);
  const bool turned = maker.Abscissa(contour, start) > maker.Abscissa(contour, end);
  for (int i = 1; i <= maker.NbEdges(contour); ++i)
    if (maker.Edge(contour, i).IsSame(blend.edge))
      maker.SetRadius(turned ? blend.last : blend.first, turned ? blend.first : blend.last, contour,
                      i);
}

template <typename Maker>
static Solids build_blend(Maker &maker, const TopoDS_Solid &solid, const Blends &blends,
                          bool chamfer) {
  const Sides sides(solid);
  double bound = 0;
  for (const Blend &blend : blends) {
    const int contour = maker.Contour(blend.edge);
    if (!contour) throw Failure{CAG_BREP_FAIL_METHOD, "the edge cannot be blended", blend.index};
    bound += section_bound(sides, blend, chamfer) *
             std::max(maker.Length(contour), length_of(blend.edge));
  }
  maker.Build();
  if (!maker.IsDone())
    throw Failure{CAG_BREP_FAIL_METHOD, "the faces of the blend cannot be built"};
  return check_blend(maker.Shape(), solid, bound);
}

static Solids blend_once(const TopoDS_Solid &solid, const Blends &blends, const Blending &how) {
  if (how.chamfer) {
    BRepFilletAPI_MakeChamfer maker(solid);
    for (const Blend &blend : blends) maker.Add(blend.first, blend.last, blend.edge, blend.face);
    return build_blend(maker, solid, blends, true);
  }
  BRepFilletAPI_MakeFillet maker(solid, how.form);
  for (const Blend &blend : blends) add_fillet(maker, blend);
  return build_blend(maker, solid, blends, false);
}

static bool try_blend(const TopoDS_Solid &solid, const Blends &blends, const Blending &how,
                      double seconds, Solids &result, Failure &failure) {
  return attempt([&] { return blend_once(solid, blends, how); }, seconds, result, failure);
}

// ---- the same edges in a changed solid ----

// Blends as the geometry that finds their edges in another solid.
struct BlendPlace {
  Blend blend;
  gp_Pnt middle;
  gp_Vec normal; // of the face of a chamfer
};

static std::vector<BlendPlace> blend_places(const Blends &blends) {
  std::vector<BlendPlace> places;
  for (const Blend &blend : blends) {
    const gp_Vec normal = blend.face.IsNull() ? gp_Vec() : normal_beside(blend.face, blend.edge);
    places.push_back({blend, middle_of(blend.edge), normal});
  }
  return places;
}

static Blends find_blends(const TopoDS_Solid &solid, const std::vector<BlendPlace> &places) {
  const Sides sides(solid);
  const double tolerance = 1e-6 * diagonal_of(solid);
  Blends blends;
  for (const BlendPlace &place : places) {
    Blend blend = place.blend;
    blend.edge = edge_at(solid, place.middle, tolerance);
    if (blend.edge.IsNull())
      throw Failure{CAG_BREP_FAIL_METHOD, "the edge is gone after the blends of others",
                    blend.index};
    // Edges that were merged need one blend.
    if (std::any_of(blends.begin(), blends.end(),
                    [&](const Blend &other) { return other.edge.IsSame(blend.edge); }))
      continue;
    if (!blend.face.IsNull()) {
      double most = -2;
      for (const TopoDS_Face &face : sides.faces(blend.edge)) {
        const double similar = normal_beside(face, blend.edge).Dot(place.normal);
        if (similar > most) {
          most = similar;
          blend.face = face;
        }
      }
    }
    blends.push_back(blend);
  }
  return blends;
}

// ---- contours ----

// The blends by contour, in the order of their first edges.
static std::vector<Blends> blend_contours(const TopoDS_Solid &solid, const Blends &blends) {
  BRepFilletAPI_MakeFillet maker(solid);
  for (const Blend &blend : blends) maker.Add(blend.edge);
  std::vector<Blends> contours;
  std::vector<int> numbers;
  for (const Blend &blend : blends) {
    const int number = maker.Contour(blend.edge);
    const auto found = std::find(numbers.begin(), numbers.end(), number);
    if (number && found != numbers.end()) {
      contours[static_cast<size_t>(found - numbers.begin())].push_back(blend);
    } else {
      numbers.push_back(number);
      contours.push_back({blend});
    }
  }
  return contours;
}

static std::vector<Blending> blend_forms(bool chamfer) {
  if (chamfer) return {{true, ChFi3d_Rational}};
  return {{false, ChFi3d_Rational}, {false, ChFi3d_QuasiAngular}, {false, ChFi3d_Polynomial}};
}

static double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

static bool blend_in_turn(const TopoDS_Solid &solid, const std::vector<Blends> &contours,
                          bool chamfer, double deadline, Solids &result, Failure &failure) {
  std::vector<std::vector<BlendPlace>> groups;
  for (const Blends &contour : contours) groups.push_back(blend_places(contour));
  TopoDS_Solid current = solid;
  for (const std::vector<BlendPlace> &group : groups) {
    bool done = false;
    for (const Blending &how : blend_forms(chamfer)) {
      done = now() < deadline &&
             attempt([&] { return blend_once(current, find_blends(current, group), how); },
                     deadline - now(), result, failure);
      if (done) break;
    }
    if (!done) return false;
    current = result[0];
  }
  return true;
}

// ---- what fails ----

static Blends scaled(const Blends &blends, double factor) {
  Blends result = blends;
  for (Blend &blend : result) {
    blend.first *= factor;
    blend.last *= factor;
  }
  return result;
}

static const Blend &largest(const Blends &blends) {
  return *std::max_element(blends.begin(), blends.end(),
                           [](const Blend &a, const Blend &b) { return a.size() < b.size(); });
}

// The largest factor of the blends that works, with others that stay as they are; 0 if none is found.
static double largest_factor(const TopoDS_Solid &solid, const Blends &blends, const Blends &others,
                             bool chamfer, double deadline) {
  double works = 0, fails = 1;
  for (int step = 0; step < SEARCH_STEPS; ++step) {
    const double left = deadline - now();
    if (left <= 0) break;
    const double factor = (works + fails) / 2;
    Blends tried = scaled(blends, factor);
    tried.insert(tried.end(), others.begin(), others.end());
    Solids result;
    Failure failure = {};
    (try_blend(solid, tried, {chamfer, ChFi3d_Rational}, left, result, failure) ? works : fails) =
        factor;
  }
  return works;
}

static Failure explain_failure(const TopoDS_Solid &solid, const Blends &blends,
                               const std::vector<Blends> &contours, bool chamfer,
                               const Failure &failure) {
  const double deadline = now() + SEARCH_SECONDS;
  const Blending how = {chamfer, ChFi3d_Rational};
  const char *what = chamfer ? "the chamfer" : "the fillet";
  Solids result;
  Failure ignored = {};
  // A contour that fails alone.
  const Blends *culprit = nullptr;
  for (const Blends &contour : contours) {
    if (contours.size() == 1 || now() > deadline - SEARCH_SECONDS / 2) break;
    if (!try_blend(solid, contour, how, SEARCH_SECONDS / 4, result, ignored)) {
      culprit = &contour;
      break;
    }
  }
  if (contours.size() == 1) culprit = &contours[0];
  Failure explained = {CAG_BREP_FAIL_METHOD, ""};
  if (culprit) {
    const Blend &worst = largest(*culprit);
    explained.edge = worst.index;
    explained.limit = worst.size() * largest_factor(solid, *culprit, {}, chamfer, deadline);
    explained.what =
        std::string(what) + " of edge " + std::to_string(worst.index) + " fails: " + failure.what;
    return explained;
  }
  // Each fits alone, but not all: the contour that fails together with those before it.
  Blends together;
  for (const Blends &contour : contours) {
    together.insert(together.end(), contour.begin(), contour.end());
    culprit = &contour;
    if (now() > deadline - SEARCH_SECONDS / 2) break;
    if (together.size() > contour.size() &&
        !try_blend(solid, together, how, SEARCH_SECONDS / 4, result, ignored))
      break;
  }
  const Blend &worst = largest(*culprit);
  const bool equal = std::all_of(blends.begin(), blends.end(),
                                 [&](const Blend &blend) { return blend.size() == worst.size(); });
  Blends others;
  if (!equal)
    for (const Blends &contour : contours)
      if (&contour != culprit) others.insert(others.end(), contour.begin(), contour.end());
  explained.edge = worst.index;
  explained.limit =
      worst.size() * largest_factor(solid, equal ? blends : *culprit, others, chamfer, deadline);
  explained.what = std::string(what) + " of edge " + std::to_string(worst.index) +
                   " does not fit together with those of other edges: " + failure.what;
  return explained;
}

// The kernel's first way has ATTEMPT_SECONDS, the others RETRY_SECONDS together: they rarely succeed
// where it took long to fail, and cag has another method (geom/solid/rolling.h).
static Solids blend(const TopoDS_Solid &solid, const Blends &blends, bool chamfer) {
  Solids result;
  Failure first = {}, failure = {};
  double deadline = now() + ATTEMPT_SECONDS;
  for (const Blending &how : blend_forms(chamfer)) {
    if (now() >= deadline) break;
    if (try_blend(solid, blends, how, deadline - now(), result, failure)) return result;
    if (!first.what.empty()) continue;
    first = failure;
    deadline = now() + RETRY_SECONDS;
  }
  const std::vector<BlendPlace> places = blend_places(blends);
  const auto unified = [&] {
    const TopoDS_Solid merged = unify({solid})[0];
    return blend_once(merged, find_blends(merged, places), {chamfer, ChFi3d_Rational});
  };
  if (now() < deadline && attempt(unified, deadline - now(), result, failure)) return result;
  const std::vector<Blends> contours = blend_contours(solid, blends);
  if (contours.size() > 1 && blend_in_turn(solid, contours, chamfer, deadline, result, failure))
    return result;
  throw explain_failure(solid, blends, contours, chamfer, first);
}

// ---- requests ----

// Whether the edge of a solid has an angle that can be blended: seams, smooth edges and poles have none.
static bool is_sharp(const Sides &sides, const TopoDS_Edge &edge) {
  if (BRep_Tool::Degenerated(edge)) return false;
  const std::vector<TopoDS_Face> faces = sides.faces(edge);
  if (faces.size() != 2 || faces[0].IsSame(faces[1])) return false;
  const gp_Vec a = normal_beside(faces[0], edge), b = normal_beside(faces[1], edge);
  return a.Magnitude() == 0 || b.Magnitude() == 0 || a.Angle(b) > SMOOTH_ANGLE;
}

static Solids read_blends(Reader &in, bool chamfer) {
  const TopoDS_Solid solid = read_solid(in);
  const Numbering numbering = number_boundary(solid);
  const Sides sides(solid);
  const uint32_t n = in.count(chamfer ? 24 : 20);
  Blends blends;
  uint32_t smooth = CAG_BREP_NONE;
  for (uint32_t i = 0; i < n; ++i) {
    Blend blend = {in.u32(), {}, {}, 0, 0};
    if (blend.index >= static_cast<uint32_t>(numbering.edges.Extent()))
      throw Failure{CAG_BREP_FAIL_INPUT, "the solid has no edge " + std::to_string(blend.index)};
    blend.edge = TopoDS::Edge(numbering.edges(static_cast<int>(blend.index) + 1));
    if (chamfer) {
      const uint32_t face = in.u32();
      for (const TopoDS_Face &side : sides.faces(blend.edge))
        if (numbering.faces.FindIndex(side) == static_cast<int>(face) + 1) blend.face = side;
      if (blend.face.IsNull())
        throw Failure{CAG_BREP_FAIL_INPUT,
                      "face " + std::to_string(face) + " is not beside edge " +
                          std::to_string(blend.index),
                      blend.index};
    }
    blend.first = in.f64();
    blend.last = in.f64();
    if (!(blend.first > 0) || !(blend.last > 0))
      throw Failure{CAG_BREP_FAIL_INPUT,
                    chamfer ? "a distance is not positive" : "a radius is not positive",
                    blend.index};
    if (is_sharp(sides, blend.edge)) blends.push_back(blend);
    else smooth = blend.index;
  }
  in.finish();
  if (!blends.empty()) return blend(solid, blends, chamfer);
  if (smooth != CAG_BREP_NONE)
    throw Failure{CAG_BREP_FAIL_INPUT, "edge " + std::to_string(smooth) + " is smooth", smooth};
  return {solid};
}

Solids fillet(Reader &in) { return read_blends(in, false); }

Solids chamfer(Reader &in) { return read_blends(in, true); }

} // namespace brep
