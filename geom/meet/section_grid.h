// Curves on which a function of a surface is 0: the grid on a patch, and where it is crossed.
//
// A value of 0 counts as positive, so that curves along the grid, seams and poles need no care:
// they run along the side of the cells that are negative.

#ifndef CAG_GEOM_MEET_SECTION_GRID_H
#define CAG_GEOM_MEET_SECTION_GRID_H

#include <stdint.h>

#include "geom/meet/level_patch.h"

// As often as the cells may be halved where the function is rough.
#define CAG_TRACER_HALVINGS 3

typedef struct CagTraceNode {
  double u, v;
  CagVec3 p, t;
  bool regular;   // t is the tangent
  bool branching; // two branches cross there
  bool flat;      // the function does not change there
} CagTraceNode;

typedef struct CagTracer {
  const CagSurface *s;
  const CagLevel *level;
  CagLevelPatch patch;     // what is traced now: all of the surface where the function is not sided
  const CagRegion *region; // of a trimmed surface; NULL: all of the rectangle belongs to it
  double tolerance, size;
  double zero_beside; // what is rounding beside a pole
  double *lines[2];
  size_t n[2];     // grid lines
  size_t cells[2]; // as many as there were before they were halved
  size_t finer;
  bool torn;      // a run has a gap
  int branchings; // found between two crossings
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

// The value, 0 where it is rounding; and what is rounding there.
double cag_tracer_settled(CagTracer *t, double u, double v);
double cag_tracer_zero(const CagTracer *t, double u, double v);
// Point and tangent at the node's parameters; gives the value and its gradient.
double cag_tracer_inspect(CagTracer *t, CagTraceNode *node, double gradient[2]);
// Goes from the node by Newton's method, within hu and hv of it, to where the gradient vanishes.
// The determinant of the second derivatives is negative at a saddle.
bool cag_tracer_critical(CagTracer *t, CagTraceNode *node, double hu, double hv, double *bend,
                         double *determinant);
// The zero between two places with the values f0 and f1, of which one is negative.
void cag_tracer_crossing(CagTracer *t, double u0, double v0, double f0, double u1, double v1,
                         double f1, CagTraceNode *out);

// The grid over the patch, twice as fine (from `finer` times) until the function is smooth from one
// line to the next. These give false when out of memory or with a status.
bool cag_tracer_make_grid(CagTracer *t, size_t finer);
// The values at the crossings of its lines, again.
bool cag_tracer_fill(CagTracer *t);
double cag_tracer_largest(const CagTracer *t);
// Adds lines through loops that are smaller than a cell, and finds and links the crossings.
bool cag_tracer_link(CagTracer *t);

#endif
