// The peer in the benchmarks of exact solids, Open CASCADE alone. Makes the solids of solids.cag,
// checks each result as the kernel can, and writes the last one as a STEP file. All holes are cut at
// once, which is faster than one after the other. Prints the seconds without the start of the
// program.
//
//     occt_solids JOB [FILE]    JOB: boolean, fillet, or rounded

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRep_Tool.hxx>
#include <Geom_Circle.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPControl_Writer.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <gp_Ax2.hxx>

static double now() {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// The result of a method, as cag accepts it.
static TopoDS_Shape valid(const TopoDS_Shape &shape) {
  if (!BRepCheck_Analyzer(shape).IsValid()) std::exit(1);
  return shape;
}

// A grid of holes through a plate.
struct Holes {
  int columns, rows;
  double origin, step[2], height;
};

static TopoDS_Shape drill(const TopoDS_Shape &plate, const Holes &holes) {
  TopTools_ListOfShape arguments, tools;
  arguments.Append(plate);
  for (int i = 0; i < holes.columns; i++)
    for (int k = 0; k < holes.rows; k++) {
      const gp_Pnt foot(holes.origin + holes.step[0] * i, holes.origin + holes.step[1] * k, -1);
      tools.Append(BRepPrimAPI_MakeCylinder(gp_Ax2(foot, gp::DZ()), 3, holes.height + 2).Shape());
    }
  BRepAlgoAPI_Cut cut;
  cut.SetArguments(arguments);
  cut.SetTools(tools);
  cut.Build();
  return valid(cut.Shape());
}

template <typename Choice>
static TopoDS_Shape round_edges(const TopoDS_Shape &shape, double radius, Choice is_chosen) {
  BRepFilletAPI_MakeFillet maker(shape);
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(shape, TopAbs_EDGE, edges);
  for (int i = 1; i <= edges.Extent(); i++)
    if (is_chosen(TopoDS::Edge(edges(i)))) maker.Add(radius, TopoDS::Edge(edges(i)));
  maker.Build();
  return valid(maker.Shape());
}

static bool is_rim(const TopoDS_Edge &edge) {
  double first, last;
  const auto curve = BRep_Tool::Curve(edge, first, last);
  return !curve.IsNull() && curve->IsKind(STANDARD_TYPE(Geom_Circle)) &&
         curve->Value(first).Z() > 4;
}

static TopoDS_Shape make(const char *job) {
  if (std::strcmp(job, "rounded") == 0) {
    const TopoDS_Shape box = BRepPrimAPI_MakeBox(100, 60, 10).Shape();
    const auto all = [](const TopoDS_Edge &) { return true; };
    return drill(round_edges(box, 2, all), {5, 4, 12, {19, 12}, 10});
  }
  const TopoDS_Shape plate =
      drill(BRepPrimAPI_MakeBox(200, 100, 5).Shape(), {20, 10, 5, {10, 10}, 5});
  return std::strcmp(job, "fillet") == 0 ? round_edges(plate, 0.5, is_rim) : plate;
}

int main(int argc, char **argv) {
  if (argc < 2) return 2;
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
  const double begin = now();
  const TopoDS_Shape shape = make(argv[1]);
  if (argc > 2) {
    STEPControl_Writer writer;
    writer.Transfer(shape, STEPControl_AsIs);
    if (writer.Write(argv[2]) != IFSelect_RetDone) return 1;
  }
  printf("%.4f\n", now() - begin);
  return 0;
}
