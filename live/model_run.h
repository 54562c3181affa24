// One run of a page's script, and what it publishes: the state, the messages, and the scene.

#ifndef CAG_LIVE_MODEL_RUN_H
#define CAG_LIVE_MODEL_RUN_H

#include <stdio.h>

#include "cag.h"
#include "live/request.h"
#include "live/scene_json.h"

// The model, and those who hear of its runs.
typedef struct CagModel {
  CagSessionOptions session; // limits and module path
  bool has_file;             // false: the script is empty until a request has a text
  const char *folder;        // of the script
  const char *name;          // of the script below the folder
  CagLiveMeshes meshes;      // of its scenes
  // Gets the events "state", "messages", and "scene".
  void (*publish)(void *context, const char *event, const char *json);
  // Called before the meshes of a scene are made, and after each run, to note which files it read.
  // May be NULL.
  void (*begin_scene)(void *context);
  void (*ran)(void *context, CagSession *s);
  void *context;
} CagModel;

// The last good run: its session, and what that has printed. Initialize with {0}.
typedef struct CagModelRun {
  CagSession *session; // NULL: there is none
  struct CagModelPrints *prints;
  double tolerance; // the default one of its meshes
} CagModelRun;

// Runs the script, and publishes the result. If it succeeds, it takes the place of `last`.
void cag_model_run(const CagModel *model, const CagLiveRequest *request, int number,
                   const volatile int *interrupt, CagModelRun *last);
void cag_model_run_free(CagModelRun *run);
// Makes a session as runs do, and runs the request. Returns NULL if memory ran out.
CagSession *cag_model_session(const CagModel *model, const CagLiveRequest *request,
                              const volatile int *interrupt, FILE *out, int *status);

#endif
