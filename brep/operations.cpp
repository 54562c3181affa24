// Drafts and imprints.

#include "brep/operations.hpp"

#include "brep/attempt.hpp"
#include "brep/boundary.hpp"
#include "brep/shapes.hpp"
#include "brep/sides.hpp"

#include <BRepAlgoAPI_Splitter.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepOffsetAPI_DraftAngle.hxx>
#include <BRepOffsetAPI_NormalProjection.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <cmath>
#include <gp_Pln.hxx>
#include <sstream>

namespace brep {

static Solids check_valid(const Solids &solids) {
  for (const TopoDS_Solid &solid : solids) {
    const std::string faults = faults_of(solid);
    if (!faults.empty()) throw Failure{CAG_BREP_FAIL_CHECK, faults};
  }
  return solids;
}

static Solids attempt_or_fail(const std::function<Solids()> &method) {
  Solids result;
  Failure failure = {};
  if (!attempt(method, ATTEMPT_SECONDS, result, failure)) throw failure;
  return result;
}

// ---- drafts ----

static const char *draft_problem(Draft_ErrorStatus status) {
  switch (status) {
  case Draft_FaceRecomputation: return "a face cannot be inclined";
  case Draft_EdgeRecomputation: return "an edge of an inclined face cannot be found";
  case Draft_VertexRecomputation: return "a corner of an inclined face cannot be found";
  default: return "the faces cannot be inclined";
  }
}

static Solids draft_once(const TopoDS_Solid &solid, const std::vector<TopoDS_Face> &faces,
                         const gp_Dir &pull, double angle, const gp_Pln &neutral) {
  BRepOffsetAPI_DraftAngle maker(solid);
  for (const TopoDS_Face &face : faces) {
    maker.Add(face, pull, angle, neutral);
    if (!maker.AddDone()) throw Failure{CAG_BREP_FAIL_METHOD, draft_problem(maker.Status())};
  }
  maker.Build();
  if (!maker.IsDone()) throw Failure{CAG_BREP_FAIL_METHOD, draft_problem(maker.Status())};
  const Solids found = check_valid(solids_of(maker.Shape()));
  if (found.size() != 1)
    throw Failure{CAG_BREP_FAIL_CHECK, std::to_string(found.size()) + " solids are left"};
  return found;
}

// A positive angle makes the solid narrower in the direction of the pull.
Solids draft(Reader &in) {
  const TopoDS_Solid solid = read_solid(in);
  const double angle = in.f64();
  const gp_Vec pull = in.vector();
  const gp_Pnt point = in.point();
  const uint32_t n = in.count(4);
  const Numbering numbering = number_boundary(solid);
  std::vector<TopoDS_Face> faces;
  for (uint32_t i = 0; i < n; ++i) {
    const uint32_t face = in.u32();
    if (face >= static_cast<uint32_t>(numbering.faces.Extent()))
      throw Failure{CAG_BREP_FAIL_INPUT, "the solid has no face " + std::to_string(face)};
    faces.push_back(TopoDS::Face(numbering.faces(static_cast<int>(face) + 1)));
  }
  in.finish();
  if (pull.Magnitude() < 1e-12) throw Failure{CAG_BREP_FAIL_INPUT, "the pull has no length"};
  if (!(std::abs(angle) < M_PI / 2))
    throw Failure{CAG_BREP_FAIL_INPUT, "the angle is not between -90 and 90 degrees"};
  if (faces.empty() || angle == 0) return {solid};
  return attempt_or_fail(
      [&] { return draft_once(solid, faces, gp_Dir(pull), angle, gp_Pln(point, gp_Dir(pull))); });
}

// ---- imprints ----

// Fails unless the edges divide a face.
static Solids imprint_once(const TopoDS_Solid &solid, const TopTools_ListOfShape &edges,
                           double fuzzy) {
  if (edges.IsEmpty()) throw Failure{CAG_BREP_FAIL_METHOD, "the curves are not near a face"};
  TopTools_ListOfShape arguments;
  arguments.Append(solid);
  BRepAlgoAPI_Splitter splitter;
  splitter.SetArguments(arguments);
  splitter.SetTools(edges);
  splitter.SetRunParallel(Standard_False);
  splitter.SetNonDestructive(Standard_True);
  if (fuzzy > 0) splitter.SetFuzzyValue(fuzzy);
  splitter.Build();
  if (splitter.HasErrors()) {
    std::ostringstream text;
    splitter.DumpErrors(text);
    throw Failure{CAG_BREP_FAIL_METHOD, text.str()};
  }
  const Solids found = check_valid(solids_of(splitter.Shape()));
  if (found.size() != 1 || std::abs(volume_of(found) - volume_of(solid)) > 1e-6 * volume_of(solid))
    throw Failure{CAG_BREP_FAIL_CHECK, "the volume changes"};
  if (number_boundary(found[0]).faces.Extent() == number_boundary(solid).faces.Extent())
    throw Failure{CAG_BREP_FAIL_METHOD, "the curves do not divide a face"};
  return found;
}

// Projections that are farther from the curve than this, times the nearest one, are on other sides of
// the solid.
static const double FARTHEST_PROJECTION = 2;

// The curves along the normals of the faces that are near.
static TopTools_ListOfShape project_edges(const TopoDS_Solid &solid,
                                          const TopTools_ListOfShape &edges) {
  TopTools_ListOfShape projected;
  for (const TopoDS_Shape &edge : edges) {
    BRepOffsetAPI_NormalProjection projection(solid);
    projection.SetLimit(Standard_True);
    projection.SetParams(1e-6, 1e-4, GeomAbs_C2, 14, 16);
    projection.Add(edge);
    projection.Build();
    if (!projection.IsDone()) continue;
    std::vector<std::pair<double, TopoDS_Shape>> found;
    double least = INFINITY;
    for (TopExp_Explorer it(projection.Projection(), TopAbs_EDGE); it.More(); it.Next()) {
      const TopoDS_Shape middle =
          BRepBuilderAPI_MakeVertex(middle_of(TopoDS::Edge(it.Current()))).Shape();
      const BRepExtrema_DistShapeShape distance(middle, edge);
      if (!distance.IsDone()) continue;
      found.push_back({distance.Value(), it.Current()});
      least = std::min(least, distance.Value());
    }
    for (const auto &candidate : found)
      if (candidate.first <= FARTHEST_PROJECTION * least + 1e-6) projected.Append(candidate.second);
  }
  return projected;
}

Solids imprint(Reader &in) {
  const TopoDS_Solid solid = read_solid(in);
  const uint32_t n = in.count(20);
  TopTools_ListOfShape edges;
  for (uint32_t i = 0; i < n; ++i)
    for (const TopoDS_Edge &edge : read_space_edges(in)) edges.Append(edge);
  in.finish();
  if (edges.IsEmpty()) return {solid};
  Solids result;
  Failure failure = {}, ignored = {};
  if (attempt([&] { return imprint_once(solid, edges, 0); }, ATTEMPT_SECONDS, result, failure))
    return result;
  // Ends of projected curves may miss each other by fractions of the size.
  const double size = diagonal_of(solid);
  for (const double fuzzy : {0.0, 1e-6, 1e-5, 1e-4})
    if (attempt([&] { return imprint_once(solid, project_edges(solid, edges), fuzzy * size); },
                ATTEMPT_SECONDS, result, ignored))
      return result;
  throw failure;
}

} // namespace brep
