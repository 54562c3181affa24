// Set operations. The kernel can miss an intersection without noticing it, so results are compared
// with the operands: by volume, and at points of a low-discrepancy sequence.

#include "brep/booleans.hpp"

#include "brep/failure.hpp"

#include <BRepAlgoAPI_BooleanOperation.hxx>
#include <BRepBndLib.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>

namespace brep {

// Volumes of valid results may leave their bounds by this fraction: tolerances move faces.
static const double VOLUME_SLACK = 1e-6;
// A result whose tolerances are below this fraction of the size needs no other try.
static const double FINE_TOLERANCE = 1e-4;
// Points that are compared per operation.
static const int SAMPLES = 40;
// Points are compared only if they are farther than this fraction of the size from all faces.
static const double SAMPLE_TOLERANCE = 1e-5;

// Whether points are inside of solids.
class Membership {
public:
  explicit Membership(const Solids &solids) {
    for (const TopoDS_Solid &solid : solids) {
      parts.push_back({solid, Bnd_Box(), nullptr});
      BRepBndLib::Add(solid, parts.back().box, Standard_False);
      box.Add(parts.back().box);
    }
  }

  TopAbs_State of(const gp_Pnt &point, double tolerance) {
    for (Part &part : parts) {
      if (part.box.IsOut(point)) continue;
      // Most operands of many are far from all points.
      if (!part.classifier)
        part.classifier = std::make_unique<BRepClass3d_SolidClassifier>(part.solid);
      part.classifier->Perform(point, tolerance);
      if (part.classifier->State() != TopAbs_OUT) return part.classifier->State();
    }
    return TopAbs_OUT;
  }

  Bnd_Box box; // of all

private:
  struct Part {
    TopoDS_Solid solid;
    Bnd_Box box;
    std::unique_ptr<BRepClass3d_SolidClassifier> classifier;
  };
  std::vector<Part> parts;
};

static double radical_inverse(int n, int base) {
  double value = 0, digit = 1;
  for (; n; n /= base) value += n % base * (digit /= base);
  return value;
}

// Whether the result has the points that it should have. Half of the points are where two operands
// may meet.
static bool agrees_at_points(BOPAlgo_Operation operation, const std::vector<Solids> &operands,
                             const Solids &result) {
  std::vector<Membership> members;
  Bnd_Box all;
  for (const Solids &operand : operands) {
    members.emplace_back(operand);
    if (operation == BOPAlgo_FUSE || members.size() == 1) all.Add(members.back().box);
  }
  if (all.IsVoid()) return true;
  Membership found(result);
  const double tolerance = SAMPLE_TOLERANCE * std::sqrt(all.SquareExtent());
  for (int i = 0; i < SAMPLES; ++i) {
    const size_t other =
        operands.size() > 1 ? 1 + static_cast<size_t>(i / 2) % (operands.size() - 1) : 0;
    Bnd_Box box = all;
    const Bnd_Box &near = members[other].box;
    if (i % 2 && !near.IsVoid() && !near.IsOut(all)) box = near;
    const gp_Pnt low = box.CornerMin(), high = box.CornerMax();
    gp_Pnt point;
    const int bases[3] = {2, 3, 5};
    for (int k = 1; k <= 3; ++k)
      point.SetCoord(k, low.Coord(k) +
                            (high.Coord(k) - low.Coord(k)) * radical_inverse(i + 1, bases[k - 1]));
    bool expected = operation != BOPAlgo_FUSE, clear = true;
    for (size_t k = 0; k < members.size() && clear; ++k) {
      const TopAbs_State state = members[k].of(point, tolerance);
      clear = state == TopAbs_IN || state == TopAbs_OUT;
      const bool inside = state == TopAbs_IN;
      if (operation == BOPAlgo_FUSE) expected = expected || inside;
      else if (operation == BOPAlgo_CUT && k > 0) expected = expected && !inside;
      else expected = expected && inside;
    }
    if (!clear) continue;
    const TopAbs_State state = found.of(point, tolerance);
    if ((state == TopAbs_IN || state == TopAbs_OUT) && (state == TopAbs_IN) != expected)
      return false;
  }
  return true;
}

// Boole's inequalities.
static bool agrees_in_volume(BOPAlgo_Operation operation, const std::vector<Solids> &operands,
                             const Solids &result) {
  const double volume = volume_of(result), first = volume_of(operands[0]);
  double sum = 0, most = 0, least = INFINITY;
  for (const Solids &operand : operands) {
    const double v = volume_of(operand);
    sum += v;
    most = std::max(most, v);
    least = std::min(least, v);
  }
  const double slack = VOLUME_SLACK * most;
  switch (operation) {
  case BOPAlgo_FUSE: return volume >= most - slack && volume <= sum + slack;
  case BOPAlgo_CUT: return volume <= first + slack && volume >= first - (sum - first) - slack;
  default: return volume <= least + slack;
  }
}

// One run of the kernel. Returns false and why if it fails.
static bool run_kernel(BOPAlgo_Operation operation, const std::vector<Solids> &operands,
                       double fuzzy, Solids &result, std::string &why) {
  TopTools_ListOfShape arguments, tools;
  for (size_t i = 0; i < operands.size(); ++i)
    for (const TopoDS_Solid &solid : operands[i]) (i ? tools : arguments).Append(solid);
  try {
    BRepAlgoAPI_BooleanOperation builder;
    builder.SetArguments(arguments);
    builder.SetTools(tools);
    builder.SetOperation(operation);
    builder.SetRunParallel(Standard_False);
    builder.SetNonDestructive(Standard_True);
    builder.SetCheckInverted(Standard_False); // all operands are oriented outward
    if (fuzzy > 0) builder.SetFuzzyValue(fuzzy);
    builder.Build();
    if (!builder.IsDone() || builder.HasErrors()) {
      std::ostringstream text;
      builder.DumpErrors(text);
      why = text.str().empty() ? "the operation failed" : text.str();
      return false;
    }
    result = unify(solids_of(builder.Shape()));
  } catch (const Standard_Failure &failure) {
    why = failure.GetMessageString();
    return false;
  }
  for (const TopoDS_Solid &solid : result) {
    why = faults_of(solid);
    if (!why.empty()) return false;
  }
  if (!agrees_in_volume(operation, operands, result)) why = "the volume of the result is wrong";
  else if (!agrees_at_points(operation, operands, result))
    why = "the result lacks or has points that it should not";
  return why.empty();
}

static double largest_tolerance(const Solids &solids) {
  double most = 0;
  for (const TopoDS_Solid &solid : solids) {
    for (TopExp_Explorer it(solid, TopAbs_VERTEX); it.More(); it.Next())
      most = std::max(most, BRep_Tool::Tolerance(TopoDS::Vertex(it.Current())));
    for (TopExp_Explorer it(solid, TopAbs_EDGE); it.More(); it.Next())
      most = std::max(most, BRep_Tool::Tolerance(TopoDS::Edge(it.Current())));
  }
  return most;
}

static const char *operation_name(BOPAlgo_Operation operation) {
  return operation == BOPAlgo_FUSE  ? "union"
         : operation == BOPAlgo_CUT ? "difference"
                                    : "intersection";
}

static Solids run(BOPAlgo_Operation operation, const std::vector<Solids> &operands) {
  double size = 0;
  for (const Solids &operand : operands) size = std::max(size, diagonal_of(compound_of(operand)));
  std::string first;
  Solids best;
  double least = INFINITY;
  for (const bool repaired : {false, true}) {
    std::vector<Solids> tried = operands;
    if (repaired)
      for (Solids &operand : tried) operand = repair(operand);
    // As fractions of the size.
    for (const double fuzzy : {0.0, 1e-7, 1e-6, 1e-5}) {
      Solids result;
      std::string why;
      if (!run_kernel(operation, tried, fuzzy * size, result, why)) {
        if (first.empty()) first = why;
        continue;
      }
      // A valid result may be one only because of its tolerances: others may be better.
      const double tolerance = largest_tolerance(result);
      if (tolerance <= FINE_TOLERANCE * size) return result;
      if (tolerance < least) {
        least = tolerance;
        best = result;
      }
    }
  }
  if (least < INFINITY) return best;
  throw Failure{CAG_BREP_FAIL_METHOD, std::string(operation_name(operation)) + ": " + first};
}

Solids combine(BOPAlgo_Operation operation, const std::vector<Solids> &operands) {
  std::vector<Solids> kept;
  for (size_t i = 0; i < operands.size(); ++i) {
    if (!operands[i].empty()) kept.push_back(operands[i]);
    else if (operation == BOPAlgo_COMMON || (operation == BOPAlgo_CUT && i == 0)) return {};
  }
  if (kept.size() < 2) return kept.empty() ? Solids() : kept[0];
  if (operation != BOPAlgo_COMMON) return run(operation, kept);
  // The kernel intersects the union of the arguments with that of the tools.
  Solids result = kept[0];
  for (size_t i = 1; i < kept.size() && !result.empty(); ++i)
    result = run(operation, {result, kept[i]});
  return result;
}

} // namespace brep
