// Boundaries of a solid in the world, with the faces at their edges and corners, for rolling.h.

#ifndef CAG_GEOM_SOLID_ROLL_PARTS_H
#define CAG_GEOM_SOLID_ROLL_PARTS_H

#include "geom/boundary/boundary.h"
#include "geom/solid/roll_section.h"
#include "geom/solid/solid.h"

#define CAG_ROLL_NONE SIZE_MAX

typedef enum CagRollBend { CAG_ROLL_SMOOTH, CAG_ROLL_CONVEX, CAG_ROLL_CONCAVE } CagRollBend;

typedef struct CagRollPart {
  const CagBoundary *b;
  CagBoundary moved;  // what b points to if the solid was moved
  size_t *face_of;    // by uses
  size_t *use_of;     // 2 e: the use along edge e, 2 e + 1: against it, or CAG_ROLL_NONE
  CagRollBend *bends; // by edges; seams and degenerate edges are smooth
} CagRollPart;

// Fails with "no-boundary" if the solid has none, or if its placement is not a similarity.
CagStatus cag_roll_parts(const CagSolid *s, CagRollPart **out, size_t *n, CagError *err);
void cag_roll_parts_free(CagRollPart *parts, size_t n);

// The two sides of an edge that is not smooth; the sizes are not set.
CagStatus cag_roll_edge(const CagRollPart *p, size_t edge, CagRollEdge *out, CagError *err);

// A face at a corner, with the parameters of the corner.
typedef struct CagRollMeeting {
  CagRollSide side;
  double uv[2];
} CagRollMeeting;

// The faces at a corner, each once: writes up to `capacity`, *n is their number.
CagStatus cag_roll_meetings(const CagRollPart *p, size_t corner, CagRollMeeting *out,
                            size_t capacity, size_t *n, CagError *err);

#endif
