// Inside of a session (include/cag.h tells what it is).
//
// A script run is a machine of its own, kept until the next run, since the diagnostics and the
// shown values refer to its sources. The interactive machine lives as long as the session.

#ifndef CAG_INTERP_SESSION_H
#define CAG_INTERP_SESSION_H

#include <stdatomic.h>

#include "base/status.h"
#include "cag.h"
#include "interp/formats/pov.h"
#include "interp/scene/scene.h"
#include "interp/vm/program.h"

struct CagSession {
  CagSessionOptions options;
  CagVm *vm;
  bool interactive;       // the machine keeps its definitions
  char **names, **values; // params from outside
  size_t define_count;
  bool define_lost; // memory ran out for a definition; no script runs until definitions are cleared
  double frame, frames;
  bool loop;
  double time_left; // seconds of max_time, of a run and what is made of its scene
  char *script;     // name of the script, for metadata
  CagDiagnostics diagnostics;
  size_t lasting; // diagnostics of the run and of building its scene: later calls keep them
  CagScene scene;
  bool has_scene;
  // Modules of the interactive session in order: their shows make its scene.
  size_t *inputs;
  size_t input_count;
  char text[256];    // for answers that are texts
  atomic_bool busy;  // inside a call that uses the machine
  bool free_pending; // a callback freed the session: the call under way does it at its end
};

// Calls that use the machine begin and end here. The beginning drops the diagnostics that an
// earlier call on the same scene added. Returns false if another call is under way: this one comes
// from a callback and is refused, and the diagnostics stay those of the call under way.
bool cag_session_begin(CagSession *s);
void cag_session_clear_diagnostics(CagSession *s);
// Gives the status back, so that it can end a return statement. May free the session.
int cag_session_end(CagSession *s, int status);

// Makes a machine when there is none. NULL: memory is out (a diagnostic says so).
CagVm *cag_session_vm(CagSession *s);
// Ends the machine with all that it made, and renews the time: what follows is another run.
void cag_session_drop_vm(CagSession *s);
// What follows has all of max_time: a run, an input of the interactive session, its commands.
void cag_session_renew_time(CagSession *s);
// Runs work(vm, context) on the big stack, with what is left of the time limit, where running out
// of memory is caught. Moves the machine's errors to the session's diagnostics. Gives the status.
int cag_session_work(CagSession *s, bool (*work)(CagVm *vm, void *context), void *context);
// The same for work that gives a status and adds its own diagnostics. Geometry may call functions
// of the script (curves by a formula) whenever it is asked, so exports and pictures are made there
// too.
int cag_session_geometry(CagSession *s, int (*work)(CagSession *s, void *context), void *context);
// Sees to it that an error of such a function that was overlooked is none that stays unknown.
CagStatus cag_session_checked(const CagSession *s, CagStatus status, CagError *err);
int cag_session_status(const CagSession *s); // by the diagnostics that the call has added
int cag_session_fail_memory(CagSession *s);  // adds the error of exhausted memory
// Adds an error of the core, or of files and renderers, and gives the status.
int cag_session_fail_geometry(CagSession *s, const CagError *err);
int cag_session_fail_io(CagSession *s, CagErrorId id, const CagError *err);
// What set operations become in POV-Ray source, where "auto" means `usual`. False, after a
// diagnostic: the option is none of its words.
bool cag_session_pov_csg(CagSession *s, CagPovCsg usual, CagPovCsg *out);
// Builds the scene and completes it with camera and light.
int cag_session_build_scene(CagSession *s);

#endif
