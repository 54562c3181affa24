// The lines of shapes that a drawing shows: edges, and contours seen along a direction.

#ifndef CAG_GEOM_VIEW_VIEW_LINES_H
#define CAG_GEOM_VIEW_VIEW_LINES_H

#include "geom/mesh/mesh.h"
#include "geom/solid/solid.h"

// What is drawn: one of these is set. A solid of the kind of set operations needs faces of its own.
typedef struct CagViewBody {
  const CagSolid *solid;
  const CagSurface *surface;
  const CagMesh *mesh;
  const CagCurve *curve;
} CagViewBody;

typedef struct CagViewLine {
  CagCurve *curve;        // in space; one reference
  const CagSurface *fold; // the face of a solid whose contour it is; NULL: an edge
  size_t body;            // its index
} CagViewLine;

typedef struct CagViewLines {
  CagViewLine *items;
  size_t count, capacity;
  CagVec3 direction; // a unit vector to the eye
  double size;       // of all bodies: the diagonal of their bounds
} CagViewLines;

void cag_view_lines_free(CagViewLines *l);
// Takes over the curve, also if it fails.
CagStatus cag_view_lines_add(CagViewLines *l, CagCurve *c, const CagSurface *fold, size_t body,
                             CagError *err);

// Adds the lines of a body. `direction` and `size` of the list must be set.
//
// Of an exact solid, the edges are those of its boundary, and of other solids and surfaces they are
// the edges and creases of the faces. An edge at which the faces meet smoothly (the normals differ
// by less than 1e-3) is left out, unless it is part of the outline: the faces are then parallel to
// the direction along it. The contours of curved faces are lines, circles, and other conics where
// they are such, else cubics within 2e-7 of the size. The edges of a mesh are those at which it ends,
// those at which it bends by more than 30 degrees, and those between triangles in front and at the
// back.
CagStatus cag_view_lines_of(CagViewLines *l, const CagViewBody *body, size_t index, CagError *err);
// The same for meshes (view_mesh.c).
CagStatus cag_view_lines_of_mesh(CagViewLines *l, const CagMesh *m, size_t index, CagError *err);

#endif
