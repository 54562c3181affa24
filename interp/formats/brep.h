// A scene as exact boundaries, for files of other CAD systems: what STEP and IGES share.
//
// Every shape becomes NURBS curves and surfaces. A face is a piece of a surface that is smooth (cut
// where the tangent planes break), bounded by loops of edge uses, the face on the left of each as
// seen against its normal. Faces of one shape that meet share the edge between them, and edges that
// meet share the vertex; a seam is an edge that its face uses twice, a pole a vertex without an
// edge.
//
// Curves and surfaces are clamped, their weights positive, and weights that are all alike are left
// out. What has no exact form is approximated within the tolerance that the user gave, or is an
// error where there is none.

#ifndef CAG_INTERP_FORMATS_BREP_H
#define CAG_INTERP_FORMATS_BREP_H

#include "interp/scene/scene.h"

typedef struct CagBrepEdge {
  CagCurve *curve; // of a NURBS kind
  size_t from, to; // vertices; the same where the curve is closed
  bool straight;   // evenly run along a line
} CagBrepEdge;

typedef struct CagBrepUse {
  size_t edge;
  bool reversed;
} CagBrepUse;

// The first loop of a face is its outer one.
typedef struct CagBrepLoop {
  size_t first, count; // uses
} CagBrepLoop;

typedef struct CagBrepFace {
  CagSurface *surface; // of a NURBS kind; of a flat face a rectangle about it
  bool flat;
  bool whole;          // its loops are the four sides of the surface
  CagTransform plane;  // FLAT: x, y, normal and origin, orthonormal
  size_t first, count; // loops
  size_t source;       // index of the surface that it is a piece of, within its shape
} CagBrepFace;

// A connected set of faces.
typedef struct CagBrepShell {
  size_t first, count; // faces
  bool closed;
  size_t void_of; // a hollow of this shell; its own index: it is none
} CagBrepShell;

typedef enum CagBrepKind { CAG_BREP_CURVE, CAG_BREP_SHEET, CAG_BREP_SOLID } CagBrepKind;

typedef struct CagBrepShape {
  CagBrepKind kind;
  const char *name;
  const CagMaterial *material;
  CagCurve *curve;     // CURVE: of a NURBS kind
  size_t first, count; // shells
  bool approximate;    // a part of it is near, not exact
  double tolerance;    // within which it is
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
  double accuracy; // mm: no two things that are meant to meet are farther apart
} CagBrep;

// Grounds are left out. Release with cag_brep_free, after a failure too.
CagStatus cag_brep_of_scene(const CagScene *scene, CagBrep *out, CagError *err);
void cag_brep_free(CagBrep *b);

#endif
