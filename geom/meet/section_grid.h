// Zero curves of a function on a surface: the grid on a patch, and the crossings of its edges.
//
// A value of 0 counts as positive. Curves along grid lines, seams, and poles therefore need no
// special case: they run on the negative side, inside the cells.

#ifndef CAG_GEOM_MEET_SECTION_GRID_H
#define CAG_GEOM_MEET_SECTION_GRID_H

#include <stdint.h>

#include "geom/meet/level_patch.h"

// Maximum number of times that the cells are halved if the function is rough.
#define CAG_TRACER_HALVINGS 3

typedef struct CagTraceNode {
  double u, v;
  CagVec3 p, t;
  bool regular;   // t is the tangent
  bool branching; // two branches cross there
  bool flat;      // the function is stationary there
} CagTraceNode;

typedef struct CagTracer {
  const CagSurface *s;
  const CagLevel *level;
  CagLevelPatch patch;     // the current patch; the whole surface if the function is not sided
  const CagRegion *region; // of a trimmed surface; NULL: the whole rectangle belongs to it
  double tolerance, size;
  double zero_beside; // magnitude of rounding errors next to a pole
  double *lines[2];
  size_t n[2];     // grid lines
  size_t cells[2]; // their number before halving
  size_t finer;
  bool torn;      // a run has a gap
  int branchings; // found between two crossings of a run
  double *values;
  // Crossings of the edges along u (first) and along v.
  size_t edge_count;
  CagTraceNode *crossings;
  int32_t (*links)[2];
  // The run being refined.
  CagTraceNode *run;
  CagVec3 *checks;
  size_t run_count, run_capacity, check_count, check_capacity;
  CagStatus status;
  CagError *err;
} CagTracer;

// The value, or 0 if it is within rounding; and the bound used for that.
double cag_tracer_settled(CagTracer *t, double u, double v);
double cag_tracer_zero(const CagTracer *t, double u, double v);
// Sets point and tangent at the node's parameters; returns the value and its gradient.
double cag_tracer_inspect(CagTracer *t, CagTraceNode *node, double gradient[2]);
// Finds a critical point of the function by Newton's method from the node, within hu and hv of it.
// The determinant of the second derivatives is negative at a saddle.
bool cag_tracer_critical(CagTracer *t, CagTraceNode *node, double hu, double hv, double *bend,
                         double *determinant);
// The zero between two points with the values f0 and f1, exactly one of which is negative.
void cag_tracer_crossing(CagTracer *t, double u0, double v0, double f0, double u1, double v1,
                         double f1, CagTraceNode *out);

// Makes the grid on the patch, refined `finer` times and further until the function is smooth from
// one line to the next. These return false if memory ran out or the status is set.
bool cag_tracer_make_grid(CagTracer *t, size_t finer);
// Evaluates the function at the grid points again.
bool cag_tracer_fill(CagTracer *t);
double cag_tracer_largest(const CagTracer *t);
// Adds lines through loops smaller than a cell, and finds and links the crossings.
bool cag_tracer_link(CagTracer *t);

#endif
