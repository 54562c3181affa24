// The POV-Ray process: started in its folder and sandbox, and watched until it ends. Part of
// povray.c.
//
// POV-Ray 3.7 sleeps for a third of a second after it has written the picture and printed its
// statistics. To avoid this wait, the picture is checked after both, and the process is killed if
// the picture is complete.

#ifndef CAG_INTERP_RENDER_POVRAY_PROCESS_H
#define CAG_INTERP_RENDER_POVRAY_PROCESS_H

#include <signal.h>

#include "interp/render/povray_log.h"

typedef struct CagPovrayProcess {
  const char *program;
  char *const *arguments;
  char *const *environment;
  const char *folder;                       // working folder of the process
  int ruleset;                              // of the sandbox
  double time_limit;                        // seconds; 0: none
  const volatile sig_atomic_t *interrupted; // may be NULL
  // The name of the picture in the folder, and a test whether the file there is complete. NULL: no
  // picture is expected.
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

// Runs the process until it ends. Its output goes to the log.
CagPovrayEnd cag_povray_process_run(const CagPovrayProcess *process, CagPovrayLog *log);

#endif
