// Internals of the boundary builder.

#ifndef CAG_INTERP_FORMATS_BREP_BUILD_H
#define CAG_INTERP_FORMATS_BREP_BUILD_H

#include "interp/formats/brep.h"

// A side of a face, before equal sides are joined to edges.
typedef struct CagBrepSide {
  CagCurve *curve;
  bool reversed; // the loop runs against the curve
  size_t face, loop;
  size_t order;    // within the loop
  size_t from, to; // vertices of the curve's start and end
  size_t edge;     // SIZE_MAX: not assigned yet
} CagBrepSide;

// A shape under construction.
typedef struct CagBrepWork {
  CagBrep *brep;
  const CagScene *scene;
  const CagItem *item;
  double asked;     // the user's tolerance; 0: none
  bool approximate; // the tolerance was used
  double same;      // points closer than this are equal
  CagBrepSide *sides;
  size_t side_count, side_room;
  size_t first_face, first_loop, first_edge;
} CagBrepWork;

// Makes room for `more` elements after the first `count` of an array that grows only by this
// function, so that its length is a power of two. Returns false if memory ran out; the array is
// then unchanged.
bool cag_brep_reserve(void **array, size_t count, size_t more, size_t size);

// Adds the corners, edges, faces, and shells of a boundary (brep.c).
CagStatus cag_brep_add_boundary(CagBrep *b, const CagBoundary *from, CagError *err);

// --- Clean NURBS (brep_nurbs.c) ---
// Returns the exact form, clamped, or one within the user's tolerance.
CagStatus cag_brep_curve(CagBrepWork *w, const CagCurve *c, CagCurve **out, CagError *err);
CagStatus cag_brep_surface(CagBrepWork *w, const CagSurface *s, CagSurface **out, CagError *err);
// Makes the curve along a side (0: u0, 1: u1, 2: v0, 3: v1) of a clamped surface from its outermost
// control points.
CagStatus cag_brep_side_curve(const CagSurface *s, int side, CagCurve **out, CagError *err);
// Returns the inner knots at which the tangent is discontinuous, ascending, allocated with malloc.
// Direction 0: u.
CagStatus cag_brep_curve_corners(const CagCurve *c, double **out, size_t *n, CagError *err);
CagStatus cag_brep_surface_creases(const CagSurface *s, int direction, double **out, size_t *n,
                                   CagError *err);
bool cag_brep_is_straight(const CagCurve *c);

// --- Faces (brep_face.c) ---
// Adds the faces of a surface, with their sides.
CagStatus cag_brep_add_surface(CagBrepWork *w, const CagSurface *s, size_t source, CagError *err);
CagStatus cag_brep_add_region(CagBrepWork *w, const CagRegion *r, const CagTransform *frame,
                              size_t source, CagError *err);

// --- Edges (brep_edge.c) ---
// Makes vertices and edges from the sides, shared where they meet, and the loops of the faces.
CagStatus cag_brep_join(CagBrepWork *w, CagError *err);

#endif
