#include "brep/solids.hpp"

#include "brep/failure.hpp"
#include "brep/handle.hpp"
#include "brep/sides.hpp"

#include <BRepBndLib.hxx>
#include <BRepCheck.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepCheck_ListIteratorOfListOfStatus.hxx>
#include <BRepClass3d.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <ShapeFix_Shape.hxx>
#include <ShapeUpgrade_UnifySameDomain.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <sstream>

namespace brep {

// A closed shell of less volume than this fraction of its bounding cube has collapsed.
static const double LEAST_VOLUME = 1e-13;

// What is known of a solid, oriented forward and in place.
struct Known {
  TopoDS_Solid solid; // so that its address is not used again
  bool measured, valid;
  Measures measures;
};

static bool is_plain(const TopoDS_Shape &shape) {
  return shape.ShapeType() == TopAbs_SOLID && shape.Orientation() == TopAbs_FORWARD &&
         shape.Location().IsIdentity();
}

static Known &known_of(const TopoDS_Solid &solid) {
  static std::map<const TopoDS_TShape *, Known> known;
  return known.insert({solid.TShape().get(), {solid, false, false, {0, 0, gp_Pnt()}}})
      .first->second;
}

// Operands are compared with each result that is tried, so measures are kept.
static const Measures &measure_once(const TopoDS_Solid &solid) {
  Known &known = known_of(solid);
  if (!known.measured) known.measures = measure(solid);
  known.measured = true;
  return known.measures;
}

Measures measures_of(const TopoDS_Solid &solid) {
  return is_plain(solid) ? measure_once(solid) : measure(solid);
}

double volume_of(const TopoDS_Shape &shape) {
  return is_plain(shape) ? measure_once(TopoDS::Solid(shape)).volume : measure(shape).volume;
}

void note_measures(const TopoDS_Solid &solid, const Measures &measures) {
  if (!is_plain(solid)) return;
  Known &known = known_of(solid);
  known.measures = measures;
  known.measured = true;
}

void note_image(const TopoDS_Solid &before, const gp_Trsf &map, const TopoDS_Shape &after) {
  if (map.IsNegative() || !is_plain(before) || !is_plain(after)) return;
  const Measures from = measure_once(before);
  const double scale = map.ScaleFactor(), square = scale * scale;
  note_measures(TopoDS::Solid(after),
                {from.volume * square * scale, from.area * square, from.centroid.Transformed(map)});
}

bool is_known_valid(const TopoDS_Solid &solid) { return is_plain(solid) && known_of(solid).valid; }

void note_valid(const TopoDS_Solid &solid) {
  if (is_plain(solid)) known_of(solid).valid = true;
}

double volume_of(const Solids &solids) {
  double sum = 0;
  for (const TopoDS_Solid &solid : solids) sum += volume_of(solid);
  return sum;
}

double diagonal_of(const TopoDS_Shape &shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box, Standard_False);
  return box.IsVoid() ? 0 : std::sqrt(box.SquareExtent());
}

static const char *shape_name(TopAbs_ShapeEnum type) {
  switch (type) {
  case TopAbs_SOLID: return "solid";
  case TopAbs_SHELL: return "shell";
  case TopAbs_FACE: return "face";
  case TopAbs_WIRE: return "loop";
  case TopAbs_EDGE: return "edge";
  case TopAbs_VERTEX: return "corner";
  default: return "shape";
  }
}

// The first fault that the check of a shape finds in it or in its parts.
static std::string first_fault(const BRepCheck_Analyzer &analyzer, const TopoDS_Shape &shape) {
  for (const TopAbs_ShapeEnum type :
       {TopAbs_VERTEX, TopAbs_EDGE, TopAbs_WIRE, TopAbs_FACE, TopAbs_SHELL, TopAbs_SOLID}) {
    TopTools_IndexedMapOfShape parts;
    TopExp::MapShapes(shape, type, parts);
    for (int i = 1; i <= parts.Extent(); ++i) {
      if (analyzer.IsValid(parts(i))) continue;
      const Ref<BRepCheck_Result> &result = analyzer.Result(parts(i));
      std::ostringstream text;
      text << "a " << shape_name(type) << " is not valid";
      if (result.IsNull()) return text.str();
      for (BRepCheck_ListIteratorOfListOfStatus it(result->Status()); it.More(); it.Next())
        if (it.Value() != BRepCheck_NoError) {
          std::ostringstream status;
          BRepCheck::Print(it.Value(), status);
          std::string name = status.str();
          while (!name.empty() && std::isspace(static_cast<unsigned char>(name.back())))
            name.pop_back();
          text << " (" << name << ")";
          return text.str();
        }
      if (type == TopAbs_SOLID) return text.str();
    }
  }
  return "it is not valid";
}

std::string faults_of(const TopoDS_Solid &solid) {
  if (is_known_valid(solid)) return "";
  int shells = 0;
  for (TopExp_Explorer it(solid, TopAbs_SHELL); it.More(); it.Next(), ++shells)
    if (!BRep_Tool::IsClosed(it.Current())) return "a shell is not closed";
  if (!shells) return "it has no faces";
  const BRepCheck_Analyzer analyzer(solid);
  if (!analyzer.IsValid()) return first_fault(analyzer, solid);
  if (!(volume_of(solid) > 0)) return "its faces do not point outward";
  note_valid(solid);
  return "";
}

bool are_valid(const Solids &solids) {
  return std::all_of(solids.begin(), solids.end(),
                     [](const TopoDS_Solid &solid) { return faults_of(solid).empty(); });
}

void sort_solids(Solids &solids) {
  if (solids.size() < 2) return;
  struct Key {
    double volume;
    gp_Pnt center;
    TopoDS_Solid solid;
  };
  std::vector<Key> keys;
  double most = 0, size = 0;
  for (const TopoDS_Solid &solid : solids) {
    const Measures measures = measures_of(solid);
    keys.push_back({measures.volume, measures.centroid, solid});
    most = std::max(most, measures.volume);
    size = std::max(size, measures.centroid.XYZ().Modulus());
  }
  size = std::max(size, std::cbrt(most));
  // Rounding makes solids that differ by rounding errors equal, so that the next key decides.
  const auto rounded = [](double value, double whole) {
    return whole > 0 ? std::round(value / whole * 1e7) : 0;
  };
  std::stable_sort(keys.begin(), keys.end(), [&](const Key &a, const Key &b) {
    const double va = rounded(a.volume, most), vb = rounded(b.volume, most);
    if (va != vb) return va > vb;
    for (int i = 1; i <= 3; ++i) {
      const double ca = rounded(a.center.Coord(i), size), cb = rounded(b.center.Coord(i), size);
      if (ca != cb) return ca < cb;
    }
    return false;
  });
  for (size_t i = 0; i < keys.size(); ++i) solids[i] = keys[i].solid;
}

static bool has_volume(const TopoDS_Shape &shape, double volume) {
  const double size = diagonal_of(shape);
  return std::abs(volume) > LEAST_VOLUME * size * size * size;
}

bool encloses_volume(const TopoDS_Shape &shape) { return has_volume(shape, volume_of(shape)); }

Solids solids_of(const TopoDS_Shape &shape) {
  Solids found;
  if (shape.IsNull()) return found;
  TopTools_IndexedMapOfShape solids;
  TopExp::MapShapes(shape, TopAbs_SOLID, solids);
  for (int i = 1; i <= solids.Extent(); ++i) {
    TopoDS_Solid solid = TopoDS::Solid(solids(i));
    const double volume = volume_of(solid);
    if (!has_volume(solid, volume)) continue;
    if (volume < 0 || solid.Orientation() != TopAbs_FORWARD) {
      // A copy whose shells have the orientation: one of the solid itself has no effect on those who
      // look at its shells.
      BRep_Builder builder;
      TopoDS_Solid copy;
      builder.MakeSolid(copy);
      for (TopExp_Explorer it(solid, TopAbs_SHELL); it.More(); it.Next())
        builder.Add(copy, volume < 0 ? it.Current().Reversed() : it.Current());
      solid = copy;
    }
    found.push_back(solid);
  }
  sort_solids(found);
  return found;
}

// The corners of a shell and the middles of its edges.
static std::vector<gp_Pnt> shell_points(const TopoDS_Shell &shell) {
  std::vector<gp_Pnt> points;
  TopTools_IndexedMapOfShape corners, edges;
  TopExp::MapShapes(shell, TopAbs_VERTEX, corners);
  TopExp::MapShapes(shell, TopAbs_EDGE, edges);
  for (int i = 1; i <= corners.Extent(); ++i)
    points.push_back(BRep_Tool::Pnt(TopoDS::Vertex(corners(i))));
  for (int i = 1; i <= edges.Extent(); ++i)
    if (!BRep_Tool::Degenerated(TopoDS::Edge(edges(i))))
      points.push_back(middle_of(TopoDS::Edge(edges(i))));
  if (points.empty()) throw Failure{CAG_BREP_FAIL_INPUT, "a shell has no corners"};
  return points;
}

static bool box_contains(const Bnd_Box &outer, const Bnd_Box &inner) {
  return !inner.IsVoid() && !outer.IsVoid() && !outer.IsOut(inner.CornerMin()) &&
         !outer.IsOut(inner.CornerMax());
}

Solids solids_of_shells(const TopoDS_Shape &shape) {
  struct Shell {
    TopoDS_Shell shell; // its faces point out of what it encloses
    TopoDS_Solid solid;
    double volume;
    Bnd_Box box;
    std::vector<gp_Pnt> points; // on it
    std::vector<size_t> around; // shells that enclose it
  };
  std::vector<Shell> shells;
  BRep_Builder builder;
  for (TopExp_Explorer it(shape, TopAbs_SHELL); it.More(); it.Next()) {
    TopoDS_Shell shell = TopoDS::Shell(it.Current());
    if (!BRep_Tool::IsClosed(shell)) throw Failure{CAG_BREP_FAIL_INPUT, "the faces do not close"};
    TopoDS_Solid solid;
    builder.MakeSolid(solid);
    builder.Add(solid, shell);
    double volume = volume_of(solid);
    if (!has_volume(solid, volume))
      throw Failure{CAG_BREP_FAIL_INPUT, "the faces enclose no volume"};
    if (volume < 0) {
      shell.Reverse();
      builder.MakeSolid(solid);
      builder.Add(solid, shell);
      volume = -volume;
    }
    Bnd_Box box;
    BRepBndLib::Add(shell, box, Standard_False);
    shells.push_back({shell, solid, volume, box, shell_points(shell), {}});
  }
  for (size_t i = 0; i < shells.size() && shells.size() > 1; ++i) {
    std::unique_ptr<BRepClass3d_SolidClassifier> classifier;
    for (size_t j = 0; j < shells.size(); ++j) {
      if (i == j || shells[j].volume > shells[i].volume ||
          !box_contains(shells[i].box, shells[j].box))
        continue;
      if (!classifier) classifier = std::make_unique<BRepClass3d_SolidClassifier>(shells[i].solid);
      const auto inside = [&](const gp_Pnt &point) {
        classifier->Perform(point, 1e-7);
        return classifier->State() == TopAbs_IN;
      };
      // Shells that pass through each other are separate solids.
      const std::vector<gp_Pnt> &points = shells[j].points;
      if (std::all_of(points.begin(), points.end(), inside)) shells[j].around.push_back(i);
    }
  }
  // An even number of shells around one makes it the outside of a solid, an odd number a cavity of
  // the smallest solid around it.
  Solids solids;
  for (size_t i = 0; i < shells.size(); ++i) {
    if (shells[i].around.size() % 2) continue;
    TopoDS_Solid solid;
    builder.MakeSolid(solid);
    builder.Add(solid, shells[i].shell);
    for (const Shell &cavity : shells) {
      const std::vector<size_t> &around = cavity.around;
      if (around.size() == shells[i].around.size() + 1 &&
          std::find(around.begin(), around.end(), i) != around.end())
        builder.Add(solid, cavity.shell.Reversed());
    }
    solids.push_back(solid);
  }
  sort_solids(solids);
  return solids;
}

TopoDS_Shape compound_of(const Solids &solids) {
  if (solids.size() == 1) return solids[0];
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (const TopoDS_Solid &solid : solids) builder.Add(compound, solid);
  return compound;
}

Solids unify(const Solids &solids) {
  Solids result;
  for (const TopoDS_Solid &solid : solids) {
    try {
      ShapeUpgrade_UnifySameDomain unifier(solid, Standard_True, Standard_True, Standard_False);
      unifier.SetSafeInputMode(Standard_True);
      unifier.Build();
      const Solids unified = solids_of(unifier.Shape());
      const double before = volume_of(solid);
      if (unified.size() == 1 && faults_of(unified[0]).empty() &&
          std::abs(volume_of(unified[0]) - before) <= 1e-7 * before) {
        result.push_back(unified[0]);
        continue;
      }
    } catch (const Standard_Failure &) {
      // The solid stays as it is.
    }
    result.push_back(solid);
  }
  return result;
}

Solids repair(const Solids &solids) {
  Solids result;
  for (const TopoDS_Solid &solid : solids) {
    ShapeFix_Shape fix(solid);
    fix.Perform();
    for (const TopoDS_Solid &fixed : solids_of(fix.Shape())) result.push_back(fixed);
  }
  sort_solids(result);
  return result;
}

} // namespace brep
