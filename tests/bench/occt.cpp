// The peer in the benchmarks of tessellation, Open CASCADE. Prints the tolerance, the number of
// triangles, and the processor seconds for each tolerance, for the surface of surfaces.c. Takes the
// best of several rounds, as there, but only one round for the finest tolerance, which needs minutes.

#include <cmath>
#include <cstdio>
#include <ctime>
#include <sstream>
#include <string>

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <Geom_BSplineSurface.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopoDS_Face.hxx>

static const int side = 20, degree = 3, rounds = 5;
static const double repeated = 1e-3; // the finest tolerance that is measured in every round
static const double angle = 0.5, sewing = 1e-7;

static double now() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static Handle(Geom_BSplineSurface) subject() {
  const int knots = side - degree + 1;
  TColgp_Array2OfPnt net(1, side, 1, side);
  TColStd_Array1OfReal at(1, knots);
  TColStd_Array1OfInteger times(1, knots);
  for (int i = 0; i < side; i++)
    for (int j = 0; j < side; j++) net(i + 1, j + 1) = gp_Pnt(i, j, sin(i * 0.7) * cos(j * 0.5));
  for (int k = 1; k <= knots; k++) {
    at(k) = k - 1;
    times(k) = k == 1 || k == knots ? degree + 1 : 1;
  }
  return new Geom_BSplineSurface(net, at, at, times, times, degree, degree);
}

// Debian lacks a header that Poly_Triangulation.hxx needs. The count is therefore read from the text
// form, where the numbers of nodes and triangles follow this title.
static int triangles_of(const TopoDS_Face &face) {
  const std::string title = "Triangulations 1\n";
  std::ostringstream text;
  BRepTools::Write(face, text);
  const std::string all = text.str();
  const size_t at = all.find(title);
  int nodes = 0, triangles = 0;
  if (at != std::string::npos)
    std::sscanf(all.c_str() + at + title.size(), "%d %d", &nodes, &triangles);
  return triangles;
}

int main() {
  Handle(Geom_BSplineSurface) surface = subject();
  for (double tolerance : {1e-2, 1e-3, 1e-4}) {
    double seconds = HUGE_VAL;
    int triangles = 0;
    for (int round = 0; round < (tolerance < repeated ? 1 : rounds); round++) {
      TopoDS_Face face = BRepBuilderAPI_MakeFace(surface, sewing);
      double begin = now();
      BRepMesh_IncrementalMesh mesh(face, tolerance, Standard_False, angle, Standard_False);
      seconds = std::fmin(seconds, now() - begin);
      triangles = triangles_of(face);
    }
    printf("%g %d %.6f\n", tolerance, triangles, seconds);
    fflush(stdout);
  }
  return 0;
}
