// How many processes of a batch run at once, so that its processors stay busy.
//
// A renderer may sleep: POV-Ray 3.7 waits for most of a second between its steps, however small the
// picture. One process for each processor would leave the machine idle then; so while the
// processors are not busy and there is memory, further processes are begun, and none where rows do
// compute.

#ifndef CAG_INTERP_TOOL_BATCH_LOAD_H
#define CAG_INTERP_TOOL_BATCH_LOAD_H

#include <stddef.h>
#include <sys/types.h>

// The most processes for each processor: enough for a renderer that computes a thirtieth of its
// time.
#define CAG_LOAD_MOST 32

typedef struct CagLoad {
  size_t workers;     // processors to be kept busy
  double limit;       // processes at once, at least `workers`
  double seen;        // when the figures below were taken
  double busy, total; // of all processors since the start, in ticks
} CagLoad;

void cag_load_begin(CagLoad *l, size_t workers);
// Looks at the machine now and then; gives how many may run while `running` do.
size_t cag_load_limit(CagLoad *l, size_t running);

// Bytes in memory of each process together with its children.
void cag_load_memory(const pid_t *processes, size_t count, size_t *bytes);

#endif
