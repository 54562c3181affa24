// Fillets and chamfers of solids as meshes, by a ball that rolls along the edges.
//
// A ball of the radius touches both faces of an edge. What it does not reach between them and the
// edge is removed from the solid at a convex edge, and added at a concave one. The ball is placed
// at sections of the edge, perpendicular to it, and the body between neighboring sections is
// bounded by lines. The bodies are taken from the mesh of the solid, or united with it. The method
// is that of rolling-ball blends (Rossignac and Requicha 1984, Constant-radius blending in solid
// modelling), with meshes in place of canal surfaces. If the radius changes along an edge, the
// section is the same circle, whereas the ball's envelope would have slightly inclined ones.

#ifndef CAG_GEOM_SOLID_ROLLING_H
#define CAG_GEOM_SOLID_ROLLING_H

#include "geom/solid/solid.h"

// An edge of a solid of the kind EXACT: its part and its number in the boundary of this part.
typedef struct CagRolledEdge {
  size_t part, edge;
  // Fillets: the radius at the start and at the end of the edge's curve, linear in between. Chamfers:
  // the distances, in the plane perpendicular to the edge, of the ends of the section from the edge on
  // its left and right faces, seen against their normals by someone who follows the curve.
  double size[2];
} CagRolledEdge;

// What is known about an edge that cannot be rounded.
typedef struct CagRollLimit {
  size_t index;  // of the caller's edges; SIZE_MAX: not known
  double factor; // the largest multiple of all sizes that was found to fit, below 1; 0: none
} CagRollLimit;

// Rounds edges of a solid with boundaries. Edges that are smooth must not be given, none twice. At
// a corner all of whose sharp edges are rounded with one radius, all of them convex or all concave,
// the result has the ball's surface. Where convex and concave edges or different radii meet at a
// corner of planes, the solid near it is opened or closed by the ball (roll_zone.h). Elsewhere, or if
// that fails, the bodies of edges end in their faces or beyond the solid, and run into each other.
//
//   tolerance  mm, positive: the distance of the result from the rounded solid. Where the ball
//              touches a curved face, the line of contact may be off by sqrt(2 radius tolerance)
//              along the face. Corners that are opened or closed are not as fine.
//   limit      set if the error is "rounding-too-large"; NULL: the largest factor is not sought, which
//              takes several times as long as rounding
//   within     set to the distance of the result: the tolerance, or more if corners were opened or
//              closed; may be NULL
//
// The result has the kind MESH. It is watertight, its volume differs from that of the solid by at
// most the volumes of the bodies, and it passes through the arc of each edge at its middle, or at a
// quarter of it. Fails with "rounding-too-large" if the sizes do not fit on the faces, and with
// "no-boundary" if the solid has no boundary, or if the result fails this test.
CagStatus cag_solid_roll(const CagSolid *s, const CagRolledEdge *edges, size_t n, double tolerance,
                         CagRollLimit *limit, double *within, CagSolid **out, CagError *err);
// The same for chamfers, whose sections are straight. Corners have no face of their own.
CagStatus cag_solid_bevel(const CagSolid *s, const CagRolledEdge *edges, size_t n, double tolerance,
                          CagRollLimit *limit, double *within, CagSolid **out, CagError *err);

#endif
