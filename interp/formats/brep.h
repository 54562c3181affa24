// The boundary representation of a scene, from which STEP and IGES files for CAD systems are
// written.
//
// A shape becomes NURBS curves and surfaces. A face is a smooth part of a surface (split where the
// tangent plane is discontinuous), bounded by loops of edge uses; the face is on the left of each
// use, seen against its normal. The faces of a set operation come from the CAD kernel: they lie on
// carriers (geom/boundary/boundary.h), and their edges may also be arcs. Adjacent faces of a shape
// share their edge, and adjacent edges share their vertex. A seam is an edge that its face uses
// twice, and a pole is a vertex without an edge. Closed meshes, and set operations with meshes among
// their operands, become solids with plane faces.
//
// Curves and surfaces are clamped, with positive weights; weights that are all equal are omitted.
// Shapes without an exact form are approximated within the user's tolerance, or cause an error if
// there is none.

#ifndef CAG_INTERP_FORMATS_BREP_H
#define CAG_INTERP_FORMATS_BREP_H

#include "geom/boundary/boundary.h"
#include "interp/kernel/kernel.h"
#include "interp/scene/scene.h"

typedef struct CagBrepEdge {
  CagCurve *curve; // of a NURBS kind, or an arc; NULL: degenerate, or straight between its vertices
  size_t from, to; // vertices; equal if the curve is closed
  bool straight;   // a line with constant speed
  bool timed;      // its parameter matters, because traces have the same one
} CagBrepEdge;

static inline bool cag_brep_is_degenerate(const CagBrepEdge *e) {
  return !e->curve && !e->straight;
}

typedef struct CagBrepUse {
  size_t edge;
  bool reversed;
  CagCurve *trace; // the edge in the parameters of the carrier, with the parameter of its curve;
                   // NULL: unknown
} CagBrepUse;

// The first loop of a face is its outer one.
typedef struct CagBrepLoop {
  size_t first, count; // uses
} CagBrepLoop;

typedef struct CagBrepFace {
  CagCarrier carrier;  // NONE: `surface` is valid, and FLAT: frame is x, y, normal, and origin
  double domain[4];    // of the carrier: u0 u1 v0 v1 of the face
  bool reversed;       // the outward normal is opposite to that of the carrier
  CagSurface *surface; // of a NURBS kind; for a flat face, a rectangle around it
  bool flat;
  bool whole;          // its loops are the four sides of the surface
  size_t first, count; // loops
  size_t source;       // index, within its shape, of the surface that it is a part of
} CagBrepFace;

// A connected set of faces.
typedef struct CagBrepShell {
  size_t first, count; // faces
  bool closed;
  size_t void_of; // the shell in which this one is a cavity; its own index: none
} CagBrepShell;

typedef enum CagBrepKind { CAG_BREP_CURVE, CAG_BREP_SHEET, CAG_BREP_SOLID } CagBrepKind;

typedef struct CagBrepShape {
  CagBrepKind kind;
  const char *name;
  const CagMaterial *material;
  CagCurve *curve;     // CURVE: of a NURBS kind
  size_t first, count; // shells
  bool approximate;    // some part is approximated
  double tolerance;    // of the approximation, or of the mesh of which the faces are
  size_t facets;       // the number of flat faces of a mesh; 0: the faces are exact
  double flatness;     // mm: of these, the largest distance from the triangles
} CagBrepShape;

typedef struct CagBrep {
  CagVec3 *vertices;
  CagBrepEdge *edges;
  CagBrepUse *uses;
  CagBrepLoop *loops;
  CagBrepFace *faces;
  CagBrepShell *shells;
  CagBrepShape *shapes;
  size_t vertex_count, edge_count, use_count, loop_count, face_count, shell_count, shape_count;
  double accuracy; // mm: the largest distance between parts that should meet
} CagBrep;

typedef enum CagBrepFormat { CAG_BREP_STEP, CAG_BREP_IGES } CagBrepFormat;

// Grounds are omitted. Release with cag_brep_free, even after a failure. Set operations need the
// kernel, which also reads them back from a file of the format; if it is NULL, memory ran out.
CagStatus cag_brep_of_scene(const CagScene *scene, CagKernel *kernel, CagBrepFormat format,
                            CagBrep *out, CagError *err);
void cag_brep_free(CagBrep *b);

#endif
