// Faces in the parameters of their carriers: whether a point lies within the loops.

#ifndef CAG_GEOM_BOUNDARY_OUTLINE_H
#define CAG_GEOM_BOUNDARY_OUTLINE_H

#include "geom/boundary/boundary.h"

// A part of an edge, or the gap between the traces of two edges.
typedef struct CagOutlineStep {
  double from[2], to[2];
  size_t use;         // SIZE_MAX: a gap, or a trace that is a line
  double start, last; // parameters of the edge
} CagOutlineStep;

typedef struct CagFaceOutline {
  const CagBoundary *boundary; // must outlive the outline
  const CagBoundaryFace *face;
  CagOutlineStep *steps;
  size_t count, room;
  double box[4]; // u0 u1 v0 v1 of the loops
} CagFaceOutline;

CagStatus cag_face_outline(const CagBoundary *b, size_t face, CagFaceOutline *out, CagError *err);
void cag_face_outline_free(CagFaceOutline *o);
// Whether the face contains S(u, v): the parameters may differ by periods from those of the loops,
// and are changed to them if so. Even-odd rule; steps near the point are the exact edge.
CagStatus cag_face_outline_has(const CagFaceOutline *o, double uv[2], bool *out, CagError *err);

#endif
