// Joins traced runs end to end, and computes tangents at their points.

#ifndef CAG_GEOM_MEET_SECTION_JOIN_H
#define CAG_GEOM_MEET_SECTION_JOIN_H

#include "geom/meet/section.h"

// cos 40 degrees: a run has a corner where its chords turn by more.
#define CAG_TRACE_CORNER 0.766

// Options for joining runs. Points closer than `same` are identified. Tangents decide whether a run
// continues smoothly; where they are unknown chords decide, unless `sided`, which drops tiny runs
// instead.
typedef struct CagTraceJoint {
  double same, size, tolerance;
  bool sided;
} CagTraceJoint;

void cag_trace_free(CagTrace *t);
// False: out of memory.
bool cag_traces_join(CagTraces *t, const CagTraceJoint *how);

#endif
