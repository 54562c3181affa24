// POV-Ray as a process: started in its folder and its sandbox, followed to its end. Part of
// povray.c.
//
// Its end is not waited for: POV-Ray 3.7 sleeps for a third of a second after it has written the
// picture and told its statistics. So when both have come, the picture is looked at, and when it is
// whole the process is ended.

#ifndef CAG_INTERP_RENDER_POVRAY_PROCESS_H
#define CAG_INTERP_RENDER_POVRAY_PROCESS_H

#include <signal.h>

#include "interp/render/povray_log.h"

typedef struct CagPovrayProcess {
  const char *program;
  char *const *arguments;
  char *const *environment;
  const char *folder;                       // it starts there
  int ruleset;                              // of the sandbox
  double time_limit;                        // seconds; 0: none
  const volatile sig_atomic_t *interrupted; // may be NULL
  // The name that its picture has in the folder, and whether what stands there is all of it. NULL:
  // there is no picture to be waited for.
  const char *picture;
  bool (*is_whole)(void *user);
  void *user;
} CagPovrayProcess;

typedef enum CagPovrayEndKind {
  CAG_POVRAY_EXITED,
  CAG_POVRAY_SIGNALED,
  CAG_POVRAY_INTERRUPTED,
  CAG_POVRAY_TIME,
  CAG_POVRAY_NO_START
} CagPovrayEndKind;

typedef struct CagPovrayEnd {
  CagPovrayEndKind kind;
  int code; // exit status, signal, or errno
} CagPovrayEnd;

// Exit status of a process whose program could not be run.
#define CAG_POVRAY_EXEC_FAILED 127

// Runs it to its end; what it says goes to the log.
CagPovrayEnd cag_povray_process_run(const CagPovrayProcess *process, CagPovrayLog *log);

#endif
