// The thread that runs the script of a page, and does what needs the result of the last run.
//
// At most one run is under way. A newer request interrupts it, and takes the place of one that
// waits. Tasks (exports, measures) use the session of the last run that succeeded.

#ifndef CAG_LIVE_RUNNER_H
#define CAG_LIVE_RUNNER_H

#include "cag.h"
#include "live/meshes.h"
#include "live/request.h"
#include "live/scene_json.h"
#include "live/server.h"

// Called on the runner's thread with the session of the last run; NULL: there is none.
typedef void CagLiveTask(CagSession *s, void *context);

typedef struct CagRunner CagRunner;
typedef struct CagRunnerOptions {
  CagSessionOptions session; // limits and module path
  bool has_file;             // false: the script is empty until a request has a text
  const char *folder;        // of the script
  const char *name;          // of the script below the folder
  CagServer *const *server;  // gets the events
  CagMeshes *meshes;
  // Called on the runner's thread after each run, to note which files it read. May be NULL.
  void (*ran)(void *context, CagSession *s);
  void *context;
} CagRunnerOptions;

CagRunner *cag_runner_start(const CagRunnerOptions *options);
void cag_runner_stop(CagRunner *r);
// Takes over the contents of the request. Returns the number of the run.
int cag_runner_run(CagRunner *r, CagLiveRequest *request);
// From now on, the file on the disk counts when the last request is run again, and not the unsaved
// text that it had. `path` is below the folder.
void cag_runner_forget_text(CagRunner *r, const char *path);
// Runs the last request again, with the files as they are now.
void cag_runner_again(CagRunner *r);
// Does something with the last session as soon as the runner is free. Returns false if memory ran
// out.
bool cag_runner_do(CagRunner *r, CagLiveTask *task, void *context);
// Where the meshes of scenes are kept.
CagLiveMeshes cag_runner_meshes(const CagRunner *r);
// A copy of the last request, for another session with the same params. False: memory ran out.
bool cag_runner_last(CagRunner *r, CagLiveRequest *out);
// Makes a session as runs do, and runs the request. Returns NULL if memory ran out.
CagSession *cag_runner_session(const CagRunner *r, const CagLiveRequest *request,
                               const volatile int *interrupt, FILE *out, int *status);

#endif
