// Triangulations of a plane with points and segments put in one after the other. Not for users of
// the mesh module.
//
// Cells are triangles that run counter-clockwise as seen along the axis, and share whole edges.
// Edges that are part of a segment are fixed; the others are flipped towards a Delaunay
// triangulation of the rounded points, which keeps cells round and searches short.

#ifndef CAG_GEOM_BOOLEAN_NET_H
#define CAG_GEOM_BOOLEAN_NET_H

#include "geom/boolean/work.h"

// neighbor[i], fixed[i]: across the edge opposite to v[i], the other cell (BOOL_NONE: outside) and
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
  BoolList vertices; // of uint32_t: the points that are in
  BoolList crossed;  // of BoolEdge: work of a segment
  BoolList doubtful; // of BoolEdge: work of flips
  uint32_t *cell_of; // of each point a cell that has it; BOOL_NONE: it is not in
  size_t cell_of_room;
  uint32_t last; // cell that was changed last
  uint32_t random;
  bool simple;  // points are apart as seen, and no segment may cross another ...
  bool spoiled; // ... one was not so, and was not put in
} BoolNet;

typedef struct BoolEdge {
  uint32_t a, b;
  uint32_t cell; // which had the edge
} BoolEdge;

static inline BoolCell *bool_cells(const BoolNet *n) { return n->cells.items; }

// Empties the net, then makes it of one cell, which has all the points that will be put in.
bool cag_bool_net_start(BoolNet *n, const uint32_t corners[3]);
void cag_bool_net_free(BoolNet *n);
bool cag_bool_net_add_point(BoolNet *n, uint32_t point);
// Points that are in; where the segment crosses one put in before, the point of both is put in.
bool cag_bool_net_add_segment(BoolNet *n, uint32_t a, uint32_t b, BoolCut cut);
bool cag_bool_net_improve(BoolNet *n);
// The next point on the way from a to b, along a segment that was put in; the cell to the left of
// this step, and its corner opposite. BOOL_NONE: there is no such step.
uint32_t cag_bool_net_step(const BoolNet *n, uint32_t a, uint32_t b, uint32_t *cell, int *corner);

#endif
