// The peer in the benchmarks of exact solids, Open CASCADE alone. Makes the plate of solids.cag,
// checks each result as the kernel can, and writes the last one as a STEP file. All holes are cut at
// once, which is faster than one after the other. Prints the seconds of the processor without
// the start of the program.
//
//     occt_solids JOB [FILE]    JOB: boolean or fillet

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
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// The result of a method, as cag accepts it.
static TopoDS_Shape valid(const TopoDS_Shape &shape) {
  if (!BRepCheck_Analyzer(shape).IsValid()) std::exit(1);
  return shape;
}

static TopoDS_Shape drilled_plate() {
  TopTools_ListOfShape arguments, tools;
  arguments.Append(BRepPrimAPI_MakeBox(200, 100, 5).Shape());
  for (int i = 0; i < 20; i++)
    for (int k = 0; k < 10; k++)
      tools.Append(
          BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(5 + 10 * i, 5 + 10 * k, -1), gp::DZ()), 3, 7)
              .Shape());
  BRepAlgoAPI_Cut cut;
  cut.SetArguments(arguments);
  cut.SetTools(tools);
  cut.Build();
  return valid(cut.Shape());
}

static bool is_rim(const TopoDS_Edge &edge) {
  double first, last;
  const auto curve = BRep_Tool::Curve(edge, first, last);
  return !curve.IsNull() && curve->IsKind(STANDARD_TYPE(Geom_Circle)) &&
         curve->Value(first).Z() > 4;
}

static TopoDS_Shape round_rims(const TopoDS_Shape &plate) {
  BRepFilletAPI_MakeFillet maker(plate);
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(plate, TopAbs_EDGE, edges);
  for (int i = 1; i <= edges.Extent(); i++)
    if (is_rim(TopoDS::Edge(edges(i)))) maker.Add(0.5, TopoDS::Edge(edges(i)));
  maker.Build();
  return valid(maker.Shape());
}

int main(int argc, char **argv) {
  if (argc < 2) return 2;
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
  const double begin = now();
  TopoDS_Shape shape = drilled_plate();
  if (std::strcmp(argv[1], "fillet") == 0) shape = round_rims(shape);
  if (argc > 2) {
    STEPControl_Writer writer;
    writer.Transfer(shape, STEPControl_AsIs);
    if (writer.Write(argv[2]) != IFSelect_RetDone) return 1;
  }
  printf("%.4f\n", now() - begin);
  return 0;
}
