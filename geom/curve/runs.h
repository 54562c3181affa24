// Curves as runs: stretches of segments, and bent curves between them.

#ifndef CAG_GEOM_RUNS_H
#define CAG_GEOM_RUNS_H

#include "geom/curve/curve.h"

// A bent curve, or else a polyline through the vertices.
typedef struct CagRun {
  CagCurve *bent;
  CagVec3 *vertices;
  bool *kept; // for each vertex; all at first
  size_t n, capacity;
  size_t first; // for the caller: where its segments begin in a list of all of them
} CagRun;

typedef struct CagRuns {
  CagRun *items;
  size_t n, capacity;
  // Closed, and all straight: one run, whose last vertex is the first one again. It starts at a
  // vertex that is far from others.
  bool ring;
} CagRuns;

CagStatus cag_runs_of(const CagCurve *c, CagRuns *out, CagError *err); // also frees after a failure
void cag_runs_free(CagRuns *runs);
// The curve through the kept vertices; `c` itself if all are kept.
CagStatus cag_runs_curve(const CagRuns *runs, const CagCurve *c, CagCurve **out, CagError *err);

// Decides whether the segment from vertex i of a run to vertex k may replace the vertices between.
typedef struct CagRunCheck {
  CagStatus (*allows)(void *context, const CagRun *run, size_t i, size_t k, bool *out,
                      CagError *err);
  void *context;
} CagRunCheck;

// Clears `kept` for vertices of a straight run within the tolerance of the segments that remain.
// check: NULL, or an additional condition.
CagStatus cag_run_reduce(CagRun *run, bool ring, double tolerance, const CagRunCheck *check,
                         CagError *err);

#endif
