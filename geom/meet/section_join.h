// What is made of traced runs: joined where they go on, with a tangent at each point.

#ifndef CAG_GEOM_MEET_SECTION_JOIN_H
#define CAG_GEOM_MEET_SECTION_JOIN_H

#include "geom/meet/section.h"

// cos 40 degrees: where chords turn by more, a run has a corner.
#define CAG_TRACE_CORNER 0.766

// How runs are joined: points nearer than `same` are one. Tangents tell whether one goes on
// smoothly, and where they are unknown the chords do, unless `sided`: then specks are dropped.
typedef struct CagTraceJoint {
  double same, size, tolerance;
  bool sided;
} CagTraceJoint;

void cag_trace_free(CagTrace *t);
// False: no memory.
bool cag_traces_join(CagTraces *t, const CagTraceJoint *how);

#endif
