// Rendering with POV-Ray 3.7, which runs as a separate process.
//
// Each run has a temporary folder (below TMPDIR) with the scene, the files that it uses, a
// configuration, and the picture. The folder is always removed at the end. The user's POV-Ray
// configuration is neither needed nor read.
//
// The scene may use only files in that folder and in POV-Ray's own library. Three mechanisms
// enforce this: a povray.conf with restrictions, a check of the file names in the scene before the
// start, and, if the kernel has Landlock, a process that cannot open other files. The configuration
// alone is not enough, because POV-Ray 3.7.0 reads `restricted` but ignores it.
//
// POV-Ray's EXR output is unclipped linear light in half floats, regardless of its gamma settings,
// and is used unchanged.

#ifndef CAG_INTERP_RENDER_POVRAY_H
#define CAG_INTERP_RENDER_POVRAY_H

#include <signal.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

typedef enum {
  CAG_POVRAY_DRAFT,  // no antialiasing, media, or radiosity
  CAG_POVRAY_NORMAL, // everything, adaptive antialiasing
  CAG_POVRAY_FINAL,  // everything, fine antialiasing
} CagPovrayQuality;

// A file that the scene uses. It is copied into the folder under the plain name that the scene
// uses.
typedef struct CagPovrayFile {
  const char *name;
  const char *source;
} CagPovrayFile;

// Reports progress: percent 0..100 of the phase, which is "parsing", "photons", "radiosity", or
// "rendering". While parsing, the percentage is unknown, and 0 is passed.
typedef void (*CagPovrayProgress)(void *user, double percent, const char *phase);

typedef struct CagPovrayJob {
  const char *scene; // text of the .pov file
  size_t scene_size;
  const CagPovrayFile *file; // or NULL
  int width, height;         // pixels, 1 to CAG_IMAGE_SIDE_MAX
  // Renders only this part and leaves the rest of the picture black; a width of 0 means the whole
  // picture.
  int region_x, region_y, region_width, region_height;
  CagPovrayQuality quality;
  bool lens;         // samples of the lens also smooth edges, so no further antialiasing is used
  bool alpha;        // write a channel A: the background is transparent
  int threads;       // 0: one per processor
  double time_limit; // seconds, 0 for none
  const volatile sig_atomic_t *interrupted; // the run stops after it becomes nonzero; may be NULL
  CagPovrayProgress progress;               // may be NULL
  void *progress_user;
} CagPovrayJob;

typedef struct CagPovrayResult {
  unsigned char *exr; // the picture, as input for cag_exr_rewrite and cag_exr_read_memory
  size_t exr_size;
  double seconds;
  char version[64]; // such as "3.7.0.10.unofficial"
} CagPovrayResult;

// Renders. Release the result with cag_povray_result_free. Errors, by status:
//   CAG_E_RENDERER  POV-Ray is missing; it rejects the scene (with the line of the scene),
//                   fails, or crashes (with its last lines); or the scene uses a forbidden file
//   CAG_E_LIMIT     the time limit was exceeded
//   CAG_E_CALLBACK  `interrupted` was set
//   CAG_E_USAGE     invalid size
//   CAG_E_FILE      a file of the job cannot be read, or there is no temporary folder
bool cag_povray_render(const CagPovrayJob *job, CagPovrayResult *out, CagError *err);

void cag_povray_result_free(CagPovrayResult *result);

// Finds POV-Ray on PATH and determines its version. `path` (of path_size bytes) and `version` (of
// 64) may be NULL.
bool cag_povray_find(char *path, size_t path_size, char version[64], CagError *err);

// Checks that the scene names no file outside of its folder and POV-Ray's library. Absolute names,
// `..`, and computed names are refused, with their line. Part of cag_povray_render.
bool cag_povray_check_files(const char *scene, size_t size, CagError *err);

#endif
