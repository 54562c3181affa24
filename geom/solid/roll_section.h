// Cross sections of rounded and chamfered edges, for rolling.h.
//
// A ball that touches both faces of an edge has its center at the distance of its radius from both
// carriers. The section at a point E of the edge is in the plane perpendicular to the edge there:
// the center C is in this plane, the ball touches the faces at A and B, and the region between E
// and the arc from A to B is what a fillet removes (convex edges) or adds (concave edges). A
// chamfer has the line from A to B in place of the arc.

#ifndef CAG_GEOM_SOLID_ROLL_SECTION_H
#define CAG_GEOM_SOLID_ROLL_SECTION_H

#include "geom/boundary/carrier.h"

// One face at an edge.
typedef struct CagRollSide {
  size_t face;
  const CagCarrier *carrier;
  double outward; // 1 or -1: the outward normal is this times that of the carrier
  CagEdgePath path;
} CagRollSide;

// The edge of a boundary, with the faces on its left and right, seen against their outward normals
// by someone who follows its curve.
typedef struct CagRollEdge {
  const CagCurve *curve;
  CagRollSide sides[2];
  bool convex;
  bool flat; // a chamfer
  double size[2]
             [2]; // the radius, or the distances on both sides: at the start and end of the curve
} CagRollEdge;

typedef struct CagRollSection {
  CagVec3 edge, along; // E, and the unit tangent of the curve
  CagVec3 center;      // of the ball
  double radius;       // 0: a chamfer
  CagVec3 contact[2];  // A and B
  CagVec3 toward[2];   // unit normals of the faces at A and B, toward the side of the ball
  CagVec3 start[2];    // those at E
  size_t origin;       // a number that the caller sets
  bool pointed[2];     // whether a contact is on an edge, about which the ball turns: ...
  CagVec3 into;        // ... a body reaches beyond the edge along this unit vector
  double bulge;        // the largest distance between a face and the chord from E to A or B
} CagRollSection;

// The section at the parameter t of the edge's curve. Both equations of the distances, and that of
// the plane, are solved by Newton's method, in which each carrier is replaced by its tangent plane
// at the point nearest to C. Radii and distances change linearly with the parameter. *fits: false
// if there is no such ball, or point: the faces are parallel, or bend too much.
CagStatus cag_roll_section(const CagRollEdge *e, double t, CagRollSection *out, bool *fits,
                           CagError *err);

// The ball of this radius that touches three faces, on the inside (inside: true) or outside of the
// solid, near a point where the faces have these parameters. contact: three points.
CagStatus cag_roll_corner(const CagRollSide *const sides[3], const double at[3][2], double radius,
                          bool inside, CagVec3 *center, bool *fits, CagError *err);

// Moves the parameters to the point of the carrier nearest to p (one step toward it on a carrier
// without a closed form), and computes this point and the outward normal.
CagStatus cag_roll_foot(const CagRollSide *side, CagVec3 p, double uv[2], CagVec3 *foot,
                        CagVec3 *normal, CagError *err);

#endif
