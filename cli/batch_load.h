// Controls how many processes of a batch run at once, so that all processors stay busy.
//
// A renderer may sleep: POV-Ray 3.7 waits for almost half a second between its steps, even for
// small pictures. One process per processor would then leave the machine partly idle. So the limit
// is raised slightly whenever a processor is idle, and decreases slowly otherwise; for rows that
// only compute, it soon is one process per processor. The limit has two bounds. Until a first
// process has ended, its needs are unknown, and only a few per processor are started. Afterwards,
// the limit is such that processes as large as the largest one so far would fit in memory.

#ifndef CAG_CLI_BATCH_LOAD_H
#define CAG_CLI_BATCH_LOAD_H

#include <stddef.h>
#include <sys/types.h>

// The maximum number of processes per processor. It is enough for a renderer that computes for a
// thirtieth of its time.
#define CAG_LOAD_MOST 32

// Where Linux provides information about processes.
#define CAG_LOAD_PROC "/proc"

typedef struct CagLoad {
  const char *proc;   // folder with the files stat, meminfo, and loadavg
  size_t workers;     // processors to keep busy
  double limit;       // processes at once, at least `workers`
  size_t largest;     // largest memory of a process in bytes; 0: none has ended
  double looked;      // time of the last check for idle processors
  double seen;        // time of the following measurements
  double busy, total; // ticks of all processors since the start
} CagLoad;

// Starts with `proc`, which is CAG_LOAD_PROC or a folder with files of the same form.
void cag_load_begin(CagLoad *l, size_t workers, const char *proc);

// Checks the machine if it is time. Returns the limit of processes while `running` run and
// `waiting` are waiting. To be called before each start. At the end of a batch of processes that
// sleep, all waiting ones are started slightly earlier, so that the last ones do not sleep alone.
size_t cag_load_limit(CagLoad *l, size_t running, size_t waiting);

// Records that a process with this much memory, in bytes, has ended.
void cag_load_ended(CagLoad *l, size_t memory);

// Records that the system refused another process while `running` ran.
void cag_load_refused(CagLoad *l, size_t running);

// Returns the memory, in bytes, of each process together with its children.
void cag_load_memory(const char *proc, const pid_t *processes, size_t count, size_t *bytes);

#endif
