// The boundary of a solid: faces on surfaces, bounded by loops of edges that neighboring faces
// share.
//
// A face is a part of its carrier, the surface on which it lies. Its loops run so that the face is
// on their left, seen against its outward normal. A seam is an edge that its face uses twice, and a
// degenerate edge is a pole of the carrier: it has no curve.

#ifndef CAG_GEOM_BOUNDARY_BOUNDARY_H
#define CAG_GEOM_BOUNDARY_BOUNDARY_H

#include "geom/curve/curve.h"
#include "geom/mesh/mesh.h"
#include "geom/surface/surface.h"

// The kinds of carriers, with the parameters of ISO 10303-42, except for v of cones, which is the
// length along the side. The frame's columns x, y, z and origin are orthonormal and right-handed.
typedef enum CagCarrierKind {
  CAG_CARRIER_NONE,
  CAG_CARRIER_PLANE,    // O + u x + v y
  CAG_CARRIER_CYLINDER, // O + a (cos u x + sin u y) + v z
  CAG_CARRIER_CONE,     // O + (a + v sin b) (cos u x + sin u y) + v cos b z; b: half the angle
  CAG_CARRIER_SPHERE,   // O + a cos v (cos u x + sin u y) + a sin v z
  CAG_CARRIER_TORUS,    // O + (a + b cos v) (cos u x + sin u y) + b sin v z
  CAG_CARRIER_SPLINE,   // `spline`
  CAG_CARRIER_REVOLVED, // `profile`, its parameter v, turned by u about z of the frame
  CAG_CARRIER_EXTRUDED  // `profile`, its parameter u, moved by v along z of the frame
} CagCarrierKind;

typedef struct CagCarrier {
  CagCarrierKind kind;
  CagTransform frame;
  double a, b;        // radii and the cone's angle
  CagSurface *spline; // a NURBS kind
  CagCurve *profile;  // a line of degree 1, an arc, or a NURBS kind, as the curves of edges
} CagCarrier;

typedef struct CagBoundaryEdge {
  CagCurve *curve; // a line of degree 1, an arc, or a NURBS kind; NULL: degenerate
  size_t from, to; // corners; equal if the curve is closed
  double gap;      // mm: the largest distance between the curve, the faces, and the corners
} CagBoundaryEdge;

typedef struct CagBoundaryUse {
  size_t edge;
  bool reversed;   // against the edge's curve
  CagCurve *trace; // the edge in the carrier's parameters, with the parameter of its curve
} CagBoundaryUse;

typedef struct CagBoundaryLoop {
  size_t first, count; // uses
} CagBoundaryLoop;

typedef struct CagBoundaryFace {
  CagCarrier carrier;
  bool reversed;       // the outward normal is opposite to S_u x S_v
  double domain[4];    // u0 u1 v0 v1 of the face
  size_t first, count; // loops, the outer one first
} CagBoundaryFace;

typedef struct CagBoundaryShell {
  size_t first, count; // of `order`
} CagBoundaryShell;

typedef struct CagBoundary {
  CagVec3 *corners;
  CagBoundaryEdge *edges;
  CagBoundaryUse *uses;
  CagBoundaryLoop *loops;
  CagBoundaryFace *faces;
  CagBoundaryShell *shells; // the outer one first, then cavities
  size_t *order;            // faces by shells
  size_t corner_count, edge_count, use_count, loop_count, face_count, shell_count, order_count;
  size_t use_room, loop_room, order_room;
  double volume, area; // as the kernel finds them
  CagVec3 centroid;
  char *name;
  bool has_color;
  double color[3];     // linear red, green, blue
  unsigned char *body; // the kernel's own form of the solid, by which it is asked for again
  size_t body_length;
  CagMesh *mesh; // of a boundary that was found from a mesh: this one, its labels are the faces + 1
                 // (0: none). The boundary is measured and meshed by it. Else NULL
} CagBoundary;

void cag_boundary_free(CagBoundary *b);

#endif
