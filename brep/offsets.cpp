// Shells and offsets.
//
// The kernel may offset faces past each other without noticing it. Results are therefore compared
// with the solid: new faces must be as far from it as the offset says.

#include "brep/attempt.hpp"
#include "brep/booleans.hpp"
#include "brep/boundary.hpp"
#include "brep/operations.hpp"
#include "brep/shapes.hpp"

#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepClass3d.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepOffsetAPI_MakeOffsetShape.hxx>
#include <BRepOffsetAPI_MakeThickSolid.hxx>
#include <BRepTools.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GeomLProp_SLProps.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shell.hxx>
#include <algorithm>
#include <cmath>

namespace brep {

// Distances of valid results may be wrong by this fraction of the offset: the kernel approximates
// offsets of splines.
static const double DISTANCE_SLACK = 1e-3;
// How far from an offset, as a fraction of it, points are that must be inside.
static const double BESIDE = 0.05;

// How the kernel joins offset faces.
struct Joining {
  GeomAbs_JoinType join;
  bool intersect; // all faces, not only neighbors
  double tolerance;
};

static std::vector<Joining> joinings(bool outward) {
  const GeomAbs_JoinType first = outward ? GeomAbs_Arc : GeomAbs_Intersection;
  const GeomAbs_JoinType second = outward ? GeomAbs_Intersection : GeomAbs_Arc;
  return {{first, false, 1e-5},
          {first, true, 1e-5},
          {second, false, 1e-5},
          {first, false, 1e-3},
          {second, true, 1e-3}};
}

// A point of a face, away from its edges, and the outward normal there.
static bool face_point(const TopoDS_Face &face, gp_Pnt &point, gp_Vec &normal) {
  double u0, u1, v0, v1;
  BRepTools::UVBounds(face, u0, u1, v0, v1);
  BRepTopAdaptor_FClass2d inside(face, 1e-9);
  // Fractions of the bounds; the first point that is inside serves.
  for (const double fu : {0.5, 0.37, 0.63, 0.21, 0.79, 0.08, 0.93})
    for (const double fv : {0.5, 0.41, 0.61, 0.17, 0.83, 0.06, 0.95}) {
      const gp_Pnt2d at(u0 + fu * (u1 - u0), v0 + fv * (v1 - v0));
      if (inside.Perform(at) != TopAbs_IN) continue;
      GeomLProp_SLProps properties(BRep_Tool::Surface(face), at.X(), at.Y(), 1, 1e-12);
      if (!properties.IsNormalDefined()) continue;
      point = properties.Value();
      normal = gp_Vec(properties.Normal());
      if (face.Orientation() == TopAbs_REVERSED) normal.Reverse();
      return true;
    }
  return false;
}

static double distance_between(const TopoDS_Shape &a, const TopoDS_Shape &b) {
  const BRepExtrema_DistShapeShape extrema(a, b);
  return extrema.IsDone() ? extrema.Value() : 0;
}

static TopoDS_Shape vertex_at(const gp_Pnt &point) {
  return BRepBuilderAPI_MakeVertex(point).Shape();
}

// Fails unless the corners and a point of each face of a solid are as far from the boundary of another
// as the offset says. Corners may be farther, where faces meet.
static void check_distance(const TopoDS_Solid &offset, const TopoDS_Solid &solid, double distance) {
  const TopoDS_Shape boundary = BRepClass3d::OuterShell(solid);
  const double least = std::abs(distance) * (1 - DISTANCE_SLACK),
               most = std::abs(distance) * (1 + DISTANCE_SLACK);
  TopTools_IndexedMapOfShape corners, faces;
  TopExp::MapShapes(offset, TopAbs_VERTEX, corners);
  TopExp::MapShapes(offset, TopAbs_FACE, faces);
  BRepClass3d_SolidClassifier side(solid);
  const auto check = [&](const gp_Pnt &point, bool exact) {
    const double found = distance_between(vertex_at(point), boundary);
    side.Perform(point, 1e-9);
    if (found < least || (exact && found > most) || (side.State() == TopAbs_IN) != (distance < 0))
      throw Failure{CAG_BREP_FAIL_CHECK, "offset faces pass through each other"};
  };
  for (int i = 1; i <= corners.Extent(); ++i)
    check(BRep_Tool::Pnt(TopoDS::Vertex(corners(i))), false);
  for (int i = 1; i <= faces.Extent(); ++i) {
    gp_Pnt point;
    gp_Vec normal;
    if (face_point(TopoDS::Face(faces(i)), point, normal)) check(point, false);
  }
}

// Fails if a part of the offset is missing: what lies beside a point of a face of the solid, as far
// from its boundary as from this point, and within the offset, must be inside of it.
static void check_complete(const Solids &offset, const TopoDS_Solid &solid, double distance) {
  const TopoDS_Shape boundary = BRepClass3d::OuterShell(solid);
  // Inward, a little deeper than the offset; outward, a little nearer.
  const double depth = std::abs(distance) * (distance < 0 ? 1 + BESIDE : 1 - BESIDE);
  BRepClass3d_SolidClassifier side(solid);
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(solid, TopAbs_FACE, faces);
  for (int i = 1; i <= faces.Extent(); ++i) {
    gp_Pnt point;
    gp_Vec normal;
    if (!face_point(TopoDS::Face(faces(i)), point, normal)) continue;
    const gp_Pnt beside = point.Translated(normal * (distance < 0 ? -depth : depth));
    side.Perform(beside, 1e-9);
    if ((side.State() == TopAbs_IN) != (distance < 0)) continue;
    if (distance_between(vertex_at(beside), boundary) < depth * (1 - DISTANCE_SLACK)) continue;
    const bool found = std::any_of(offset.begin(), offset.end(), [&](const TopoDS_Solid &part) {
      BRepClass3d_SolidClassifier within(part);
      within.Perform(beside, 1e-9);
      return within.State() == TopAbs_IN;
    });
    if (!found) throw Failure{CAG_BREP_FAIL_CHECK, "a part of the offset is missing"};
  }
}

static Solids offset_once(const TopoDS_Solid &solid, double distance, const Joining &joining) {
  BRepOffsetAPI_MakeOffsetShape maker;
  maker.PerformByJoin(solid, distance, joining.tolerance, BRepOffset_Skin, joining.intersect,
                      Standard_False, joining.join);
  if (!maker.IsDone() || maker.Shape().IsNull())
    throw Failure{CAG_BREP_FAIL_METHOD, "the faces cannot be offset"};
  Solids found = solids_of(maker.Shape());
  if (found.empty()) found = solids_of_shells(maker.Shape());
  if (found.empty()) throw Failure{CAG_BREP_FAIL_EMPTY, "nothing is left"};
  for (const TopoDS_Solid &part : found) {
    const std::string faults = faults_of(part);
    if (!faults.empty()) throw Failure{CAG_BREP_FAIL_CHECK, faults};
    check_distance(part, solid, distance);
  }
  check_complete(found, solid, distance);
  const double before = volume_of(solid), after = volume_of(found);
  if ((after > before) != (distance > 0)) throw Failure{CAG_BREP_FAIL_CHECK, "the volume is wrong"};
  return unify(found);
}

// Tries all ways to join. Fails with the first reason.
static Solids try_joinings(bool outward, const std::function<Solids(const Joining &)> &method) {
  Solids result;
  Failure first = {}, failure = {};
  for (const Joining &joining : joinings(outward)) {
    if (attempt([&] { return method(joining); }, ATTEMPT_SECONDS, result, failure)) return result;
    if (first.what.empty()) first = failure;
  }
  throw first;
}

static Solids offset_solid(const TopoDS_Solid &solid, double distance) {
  return try_joinings(
      distance > 0, [&](const Joining &joining) { return offset_once(solid, distance, joining); });
}

// ---- shells ----

// Fails unless the wall is beside all faces that stay: it is on one side of their points.
static void check_walls(const TopoDS_Solid &solid, const TopoDS_Solid &result,
                        const TopTools_ListOfShape &open, double thickness) {
  BRepClass3d_SolidClassifier classifier(result);
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(solid, TopAbs_FACE, faces);
  for (int i = 1; i <= faces.Extent(); ++i) {
    gp_Pnt point;
    gp_Vec normal;
    if (open.Contains(faces(i)) || !face_point(TopoDS::Face(faces(i)), point, normal)) continue;
    for (const double depth : {0.1, 0.9}) {
      classifier.Perform(point.Translated(normal * (-thickness * depth)), 1e-9);
      if (classifier.State() != TopAbs_IN) throw Failure{CAG_BREP_FAIL_CHECK, "a wall is missing"};
    }
  }
}

static Solids open_shell_once(const TopoDS_Solid &solid, const TopTools_ListOfShape &open,
                              double thickness, const Joining &joining) {
  BRepOffsetAPI_MakeThickSolid maker;
  maker.MakeThickSolidByJoin(solid, open, -thickness, joining.tolerance, BRepOffset_Skin,
                             joining.intersect, Standard_False, joining.join);
  if (!maker.IsDone()) throw Failure{CAG_BREP_FAIL_METHOD, "the walls cannot be built"};
  const Solids found = solids_of(maker.Shape());
  if (found.size() != 1)
    throw Failure{CAG_BREP_FAIL_CHECK, std::to_string(found.size()) + " solids are left"};
  const std::string faults = faults_of(found[0]);
  if (!faults.empty()) throw Failure{CAG_BREP_FAIL_CHECK, faults};
  if (thickness > 0 && !(volume_of(found) < volume_of(solid)))
    throw Failure{CAG_BREP_FAIL_CHECK, "the walls are thicker than the solid"};
  check_walls(solid, found[0], open, thickness);
  return found;
}

// A solid with a cavity: the space between the solid and its offset.
static Solids closed_shell(const TopoDS_Solid &solid, double thickness) {
  const Solids offsets = offset_solid(solid, -thickness);
  const Solids &outer = thickness > 0 ? Solids{solid} : offsets,
               &inner = thickness > 0 ? offsets : Solids{solid};
  if (outer.size() != 1)
    throw Failure{CAG_BREP_FAIL_CHECK, std::to_string(outer.size()) + " solids are left"};
  BRep_Builder builder;
  TopoDS_Solid result;
  builder.MakeSolid(result);
  for (TopExp_Explorer it(outer[0], TopAbs_SHELL); it.More(); it.Next())
    builder.Add(result, it.Current());
  Solids islands;
  for (const TopoDS_Solid &part : inner) {
    const TopoDS_Shell outside = BRepClass3d::OuterShell(part);
    builder.Add(result, outside.Reversed());
    // The inside of a wall around a cavity is a solid of its own.
    for (TopExp_Explorer it(part, TopAbs_SHELL); it.More(); it.Next())
      if (!it.Current().IsSame(outside))
        throw Failure{CAG_BREP_FAIL_METHOD, "a solid with a cavity has no closed shell"};
  }
  const std::string faults = faults_of(result);
  if (!faults.empty()) throw Failure{CAG_BREP_FAIL_CHECK, faults};
  return {result};
}

Solids shell(Reader &in) {
  const TopoDS_Solid solid = read_solid(in);
  const double thickness = in.f64();
  const uint32_t n = in.count(4);
  const Numbering numbering = number_boundary(solid);
  TopTools_ListOfShape open;
  for (uint32_t i = 0; i < n; ++i) {
    const uint32_t face = in.u32();
    if (face >= static_cast<uint32_t>(numbering.faces.Extent()))
      throw Failure{CAG_BREP_FAIL_INPUT, "the solid has no face " + std::to_string(face)};
    const TopoDS_Shape &opened = numbering.faces(static_cast<int>(face) + 1);
    if (!open.Contains(opened)) open.Append(opened);
  }
  in.finish();
  if (thickness == 0) throw Failure{CAG_BREP_FAIL_INPUT, "the thickness is 0"};
  if (open.Extent() == numbering.faces.Extent())
    throw Failure{CAG_BREP_FAIL_INPUT, "all faces are open"};
  if (open.IsEmpty()) return closed_shell(solid, thickness);
  return try_joinings(thickness < 0, [&](const Joining &joining) {
    return open_shell_once(solid, open, thickness, joining);
  });
}

// ---- offsets ----

Solids offset(Reader &in) {
  const Solids solids = read_solids(in);
  const double distance = in.f64();
  in.finish();
  if (distance == 0) return solids;
  std::vector<Solids> parts;
  for (const TopoDS_Solid &solid : solids) parts.push_back(offset_solid(solid, distance));
  if (parts.empty()) return {};
  // Parts that grow may meet.
  return combine(BOPAlgo_FUSE, parts);
}

} // namespace brep
