// How many processes of a batch run at once, so that its processors stay busy.
//
// A renderer may sleep: POV-Ray 3.7 waits for most of half a second between its steps, however
// small the picture. One process for each processor would leave the machine idle then. So the
// number that may run is raised a little whenever a processor is seen idle, and sinks slowly while
// none is: rows that compute soon run one for each processor. Two things bound it: until a process
// has ended nobody knows what they need, and only a few for each processor are begun; after that
// there may be more, but never so many that the largest one seen would fill the memory that many
// times.

#ifndef CAG_CLI_BATCH_LOAD_H
#define CAG_CLI_BATCH_LOAD_H

#include <stddef.h>
#include <sys/types.h>

// The most processes for each processor: enough for a renderer that computes a thirtieth of its
// time.
#define CAG_LOAD_MOST 32

// Where Linux tells about processes.
#define CAG_LOAD_PROC "/proc"

typedef struct CagLoad {
  const char *proc;   // the folder with the files stat, meminfo and loadavg
  size_t workers;     // processors to be kept busy
  double limit;       // processes at once, at least `workers`
  size_t largest;     // bytes that one process had at most; 0: none has ended
  double looked;      // when idle processors were looked for
  double seen;        // when the figures below were taken
  double busy, total; // of all processors since the start, in ticks
} CagLoad;

// Keeps `proc`: CAG_LOAD_PROC, or a folder with files of the same form.
void cag_load_begin(CagLoad *l, size_t workers, const char *proc);

// Looks at the machine when it is time; gives how many may run while `running` do and `waiting` are
// to be begun. To be asked before each that is begun. At the end of a batch of sleepers all that
// wait are begun a little earlier, so that the last do not sleep while nothing else runs.
size_t cag_load_limit(CagLoad *l, size_t running, size_t waiting);

// Tells that a process has ended that had so many bytes.
void cag_load_ended(CagLoad *l, size_t memory);

// The system gave no further process while so many ran.
void cag_load_refused(CagLoad *l, size_t running);

// Bytes in memory of each process together with its children.
void cag_load_memory(const char *proc, const pid_t *processes, size_t count, size_t *bytes);

#endif
