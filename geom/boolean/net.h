// Triangulations of a plane, built by inserting points and segments one by one. Internal to the
// boolean module.
//
// Cells are triangles, counter-clockwise as seen along the axis, that share whole edges. Edges that
// are part of a segment are fixed; the others are flipped towards a Delaunay triangulation of the
// rounded points, which keeps cells well shaped and searches short.

#ifndef CAG_GEOM_BOOLEAN_NET_H
#define CAG_GEOM_BOOLEAN_NET_H

#include "geom/boolean/work.h"

// Across the edge opposite v[i]: neighbor[i] is the other cell (BOOL_NONE: outside), and fixed[i]
// the number of the cut that the edge is part of (BOOL_NONE: it may be flipped).
typedef struct BoolCell {
  uint32_t v[3], neighbor[3], fixed[3];
} BoolCell;

typedef struct BoolNet {
  BoolPoints *points;
  const uint32_t *plane; // three corners of a face in the plane
  int axis;
  BoolList cells;    // of BoolCell
  BoolList cuts;     // of BoolCut
  BoolList vertices; // of uint32_t: the inserted points
  BoolList crossed;  // of BoolEdge: scratch space for segments
  BoolList doubtful; // of BoolEdge: scratch space for flips
  uint32_t *cell_of; // for each point, a cell that has it as a vertex; BOOL_NONE: not inserted
  size_t cell_of_room;
  uint32_t last; // the cell changed last
  uint32_t random;
  bool simple;  // projected points are distinct, and segments must not cross ...
  bool spoiled; // ... this was violated, and a segment was not inserted
} BoolNet;

typedef struct BoolEdge {
  uint32_t a, b;
  uint32_t cell; // a cell that had the edge
} BoolEdge;

static inline BoolCell *bool_cells(const BoolNet *n) { return n->cells.items; }

// Resets the net to a single cell that contains all points to be inserted.
bool cag_bool_net_start(BoolNet *n, const uint32_t corners[3]);
void cag_bool_net_free(BoolNet *n);
bool cag_bool_net_add_point(BoolNet *n, uint32_t point);
// Both points must be inserted already. Where the segment crosses an earlier one, their point of
// intersection is inserted.
bool cag_bool_net_add_segment(BoolNet *n, uint32_t a, uint32_t b, BoolCut cut);
bool cag_bool_net_improve(BoolNet *n);
// The next point on the way from a to b along an inserted segment, the cell to the left of this
// step, and the opposite corner of that cell. BOOL_NONE: there is no such step.
uint32_t cag_bool_net_step(const BoolNet *n, uint32_t a, uint32_t b, uint32_t *cell, int *corner);

#endif
