// Internals of a session (see include/cag.h).
//
// Each run of a script has its own machine, which is kept until the next run, because diagnostics
// and shown values refer to its sources. The machine of an interactive session lives as long as the
// session.

#ifndef CAG_INTERP_SESSION_H
#define CAG_INTERP_SESSION_H

#include <stdatomic.h>

#include "base/status.h"
#include "cag.h"
#include "interp/formats/pov.h"
#include "interp/scene/scene.h"
#include "interp/session/scene_build.h"
#include "interp/vm/program.h"

// What the scene has of the shapes: all of them, what a section leaves, or the outlines of its cut.
typedef enum CagSceneForm { CAG_SCENE_WHOLE, CAG_SCENE_CUT, CAG_SCENE_OUTLINES } CagSceneForm;

struct CagSession {
  CagSessionOptions options;
  CagVm *vm;
  bool interactive;       // the machine keeps its definitions
  char **names, **values; // params set from outside
  size_t define_count;
  bool define_lost; // memory ran out for a definition; no script runs until definitions are cleared
  double frame, frames;
  bool loop;
  double time_left; // seconds left of max_time, for a run and all output of its scene
  char *script;     // name of the script, for metadata
  CagDiagnostics diagnostics;
  size_t run_count; // number of diagnostics of the run
  size_t lasting;   // number of diagnostics of the run and of building its scene, which later calls
                    // keep
  CagScene scene;
  bool has_scene;
  CagItemSources sources;                   // of the scene's items
  struct CagSessionParams *params;          // of the main script; NULL: not listed yet
  struct CagSessionMesh *mesh;              // the one that was made last; may be NULL
  struct CagSessionSources *part_sources;   // of the part that was asked about last; may be NULL
  struct CagSessionLabelPaths *label_paths; // of the label that was asked about last; may be NULL
  struct CagSessionRobots *robots;          // of the scene; NULL: not looked for yet
  struct CagSessionPoints *points;          // those that were found last; may be NULL
  struct CagKernel *kernel;                 // of exact boundaries; NULL: not needed yet
  double usual_tolerance; // replaces the default tolerance of scenes; 0: it follows their size
  CagTolerances used;     // of the meshes of the last export or picture
  CagSceneForm form;      // of the scene
  bool has_section;
  CagPlane section; // what lies on its positive side is cut off
  size_t main;      // the module of the script; CAG_NO_MODULE: it was not loaded
  char *only;       // the definition that is shown alone; NULL: what the script shows
  // Modules of the interactive session in order; their shows form its scene.
  size_t *inputs;
  size_t input_count;
  char text[256];    // buffer for returned texts
  atomic_bool busy;  // a call that uses the machine is under way
  bool free_pending; // a callback freed the session, which takes effect at the end of the call
                     // under way
  char *together;    // the lowest address of the stack of cag_session_together; NULL: not within it
};

// Returns the kernel, which is made if there is none, or NULL if memory ran out.
struct CagKernel *cag_session_kernel(CagSession *s);

// Every call that uses the machine starts and ends with these functions. cag_session_begin drops
// the diagnostics that an earlier call on the same scene added. It returns false if another call is
// under way, because this one then comes from a callback and is refused. The diagnostics remain
// those of the call under way.
bool cag_session_begin(CagSession *s);
void cag_session_clear_diagnostics(CagSession *s);
// Returns `status`, for use in a return statement. May free the session.
int cag_session_end(CagSession *s, int status);

// Returns the machine, which is made if there is none, or NULL, with a diagnostic, if memory ran
// out.
CagVm *cag_session_vm(CagSession *s);
// Frees the machine with all its values, and restarts the time limit for another run.
void cag_session_drop_vm(CagSession *s);
// Restarts the time limit, for a run, an input of the interactive session, or one of its commands.
void cag_session_renew_time(CagSession *s);
// Runs work(vm, context) on the large stack, with the rest of the time limit, in a guard against
// exhausted memory. Moves the machine's errors to the session's diagnostics. Returns the status.
int cag_session_work(CagSession *s, bool (*work)(CagVm *vm, void *context), void *context);
// The same for work that returns a status and adds its own diagnostics. Exports and pictures are
// made this way, too, because geometry may call functions of the script (curves by a formula).
int cag_session_geometry(CagSession *s, int (*work)(CagSession *s, void *context), void *context);
// Returns `status`, or the error of such a function if geometry ignored it.
CagStatus cag_session_checked(const CagSession *s, CagStatus status, CagError *err);
int cag_session_status(const CagSession *s); // by the diagnostics that the call has added
int cag_session_fail_memory(CagSession *s);  // adds the error for exhausted memory
// Adds an error of the core, of files, or of renderers, and returns its status.
int cag_session_fail_geometry(CagSession *s, const CagError *err);
int cag_session_fail_io(CagSession *s, CagErrorId id, const CagError *err);
// Reads the option that states how set operations are written in POV-Ray source; "auto" means
// `usual`. Returns false, after a diagnostic, if its value is invalid.
bool cag_session_pov_csg(CagSession *s, CagPovCsg usual, CagPovCsg *out);
// Meshes that are made between these calls are for a picture of a camera (NULL: for any use). Notes
// their tolerances for cag_session_tolerance.
void cag_session_begin_meshes(CagSession *s, const CagCamera *picture);
void cag_session_end_meshes(CagSession *s);
// Runs the statements `show` of an interactive session again. Of others, it does nothing.
int cag_session_refresh(CagSession *s);
// Whether the script shows an image, in a list or by itself.
bool cag_session_shows_image(const CagSession *s);
// Writes the image of `options` (NULL: the only one) that is shown to a .png or .exr file.
int cag_session_write_image(CagSession *s, const char *path, bool png,
                            const CagImageOptions *options);
void cag_session_drop_params(CagSession *s);
// Lists the params of the main script, if that was not done since the run. Returns false if it
// cannot be done. Starts work of the session, so it cannot be part of such work.
bool cag_session_list_params(CagSession *s);
// Returns whether param i, which must have been listed, has a range.
bool cag_session_param_range(const CagSession *s, size_t i, double *low, double *high);
void cag_session_drop_points(CagSession *s);
// A location for the host. No source: none.
CagPlaceView cag_session_place(const CagSource *source, CagSpan span);
void cag_session_drop_mesh(CagSession *s);
void cag_session_drop_robots(CagSession *s);
void cag_session_drop_sources(CagSession *s);
void cag_session_drop_label_paths(CagSession *s);
// Whether a call in the library has a caller that the call after it does not have.
bool cag_origin_other_caller(const CagOriginStep *step, const CagOriginStep *later);
// Returns the value of a definition of the script, for work of the session. Fails with
// "unknown-name".
bool cag_session_find_definition(CagSession *s, const char *name, CagValue *out);
// Builds the scene and adds default camera and lights. If there is a section, the scene is cut by
// it.
int cag_session_build_scene(CagSession *s);
// The same, but with the outlines of the cut as plane curves in z = 0.
int cag_session_build_drawing(CagSession *s);

#endif
