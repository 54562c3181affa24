// Meshes that fillets and chamfers remove or add, for rolling.h.
//
// They reach beyond the faces by a small distance, so that no face of theirs lies in a face of the
// solid, except where an edge ends on another face.

#ifndef CAG_GEOM_SOLID_ROLL_BODY_H
#define CAG_GEOM_SOLID_ROLL_BODY_H

#include "geom/mesh/mesh.h"
#include "geom/solid/roll_section.h"

// The number of points around a section whose arc is divided into `arc` parts.
#define CAG_ROLL_RING(arc) ((size_t)(arc) + 5)

// How many parts an arc of this angle (radians) needs so that its chords are within the tolerance.
size_t cag_roll_arc(double radius, double angle, double tolerance);
// The unit vector at the fraction t of the arc between two unit vectors.
CagVec3 cag_roll_arc_direction(CagVec3 a, CagVec3 b, double t);
// The points around a section: those of the arc, then those beyond the faces by the distance
// `lift`. The first and last chord of the arc are lengthened, so that they cross the faces.
void cag_roll_ring(const CagRollSection *s, size_t arc, double lift, CagVec3 *out);
// Whether a ring does not cross itself, seen along its normal.
CagStatus cag_roll_ring_is_simple(const CagVec3 *ring, size_t size, bool *out, CagError *err);
// The closed mesh through n >= 2 rings of `size` points (closed: the last is joined to the first,
// and n >= 3; else the first and last are filled), oriented outward.
CagStatus cag_roll_sweep(const CagVec3 *rings, size_t size, size_t n, bool closed, CagMesh **out,
                         CagError *err);

// A corner at which `count` edges with one radius end, all of them convex or all concave. Edge i is
// between the faces i and i + 1.
typedef struct CagRollCorner {
  CagVec3 point, center; // of the corner, and of the ball that touches all faces
  double radius;
  size_t count;
  const CagVec3 *contact;        // where the ball touches the faces
  const CagVec3 *toward;         // unit normals there, toward the ball
  const CagVec3 *at_point;       // those at the corner
  const CagVec3 *station;        // the points of the edges whose sections have the ball's center
  const CagVec3 *before, *after; // the unit normals at station i, of face i and of face i + 1
} CagRollCorner;

// The part near the corner that is outside of the ball: between the planes through its center
// that are perpendicular to the edges.
CagStatus cag_roll_corner_body(const CagRollCorner *c, size_t arc, double lift, CagMesh **out,
                               CagError *err);

#endif
