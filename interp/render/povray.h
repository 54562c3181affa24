// Pictures by POV-Ray 3.7, run as a process of its own.
//
// Each run has a temporary folder (beneath TMPDIR) that holds the scene, the files that it uses, a
// configuration, and the picture; the folder is removed at the end, however that comes. No
// configuration of the user is needed or read.
//
// The scene may use files of that folder and of POV-Ray's own library only. Three things see to it,
// because the first alone is not kept by POV-Ray 3.7.0 (it reads `restricted` in its configuration
// and does not act on it): a povray.conf with the restrictions, a check of the file names in the
// scene before the start, and, where the kernel has Landlock, a process that cannot open other
// files.
//
// POV-Ray's EXR is linear light in half floats whatever its gamma settings are, and is not clipped,
// so it is taken as it is.

#ifndef CAG_INTERP_RENDER_POVRAY_H
#define CAG_INTERP_RENDER_POVRAY_H

#include <signal.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

typedef enum {
  CAG_POVRAY_DRAFT,  // no antialiasing, no media and radiosity
  CAG_POVRAY_NORMAL, // everything, adaptive antialiasing
  CAG_POVRAY_FINAL,  // everything, fine antialiasing
} CagPovrayQuality;

// A file that the scene uses: copied into the folder under a plain name, which the scene calls it
// by.
typedef struct CagPovrayFile {
  const char *name;
  const char *source;
} CagPovrayFile;

// Told how far the run is: percent 0..100 of the phase, which is "parsing", "photons", "radiosity"
// or "rendering". While parsing, the percentage is unknown and 0.
typedef void (*CagPovrayProgress)(void *user, double percent, const char *phase);

typedef struct CagPovrayJob {
  const char *scene; // text of the .pov file
  size_t scene_size;
  const CagPovrayFile *file; // or NULL
  int width, height;         // pixels, 1 to CAG_IMAGE_SIDE_MAX
  // Only this part is rendered, the rest of the picture stays black; a width of 0: all of it.
  int region_x, region_y, region_width, region_height;
  CagPovrayQuality quality;
  bool lens;         // samples of a lens smooth the edges as well: no further antialiasing
  bool alpha;        // write a channel A: the background is transparent
  int threads;       // 0: one for each processor
  double time_limit; // seconds, 0 for none
  const volatile sig_atomic_t *interrupted; // the run ends when it becomes nonzero; may be NULL
  CagPovrayProgress progress;               // may be NULL
  void *progress_user;
} CagPovrayJob;

typedef struct CagPovrayResult {
  unsigned char *exr; // the picture, as cag_exr_rewrite and cag_exr_read_memory take it
  size_t exr_size;
  double seconds;
  char version[64]; // such as "3.7.0.10.unofficial"
} CagPovrayResult;

// Renders. Release the result with cag_povray_result_free. Errors, by exit status:
//   CAG_E_RENDERER     POV-Ray is missing, refuses the scene (with the line of the scene),
//   fails, dies of a signal (with its last
//                         lines), or the scene wants a file that it may not have
//   CAG_E_LIMIT        the time limit
//   CAG_E_CALLBACK  the flag
//   CAG_E_USAGE        a size that cannot be
//   CAG_E_FILE         a file of the job that cannot be read, no temporary folder
bool cag_povray_render(const CagPovrayJob *job, CagPovrayResult *out, CagError *err);

void cag_povray_result_free(CagPovrayResult *result);

// Finds POV-Ray on PATH and asks for its version. `path` (of path_size bytes) and `version` (of 64)
// may be NULL.
bool cag_povray_find(char *path, size_t path_size, char version[64], CagError *err);

// Checks that the scene names no file outside its folder and POV-Ray's library: absolute names,
// `..`, and names that are computed are refused with the line. Part of cag_povray_render.
bool cag_povray_check_files(const char *scene, size_t size, CagError *err);

#endif
